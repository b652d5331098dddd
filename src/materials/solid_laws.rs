//! The materials in all components of the strain of a ring, and the viscosity. Section 2 of docs/theory.md, Bodies of
//! revolution.

use nalgebra::{Matrix4, Vector4};

use super::symmetric::{IDENTITY, Symmetric, contract};
#[cfg(test)]
use super::yielding::Yielding;
use super::{
    NeoHooke, PlaneSaintVenantKirchhoff, Polynomial, RingStressAtPoints, SolidHyperelastic,
    Strains, Viscosity,
};

/// In a body of revolution.
impl SolidHyperelastic for PlaneSaintVenantKirchhoff {
    /// W = E:C:E/2 = S:E/2, eq. (2.13)
    fn energy(&self, e: &Symmetric) -> f64 {
        contract(&SolidHyperelastic::stress(self, e), e) / 2.0
    }

    /// W1 - W0 = S(E_m):(E1 - E0)
    fn energy_change(&self, e0: &Symmetric, e1: &Symmetric) -> f64 {
        let mean = SolidHyperelastic::stress(self, &((e0 + e1) / 2.0));
        contract(&mean, &(e1 - e0))
    }

    /// S = lambda tr(E) I + 2 mu E, eq. (2.13)
    fn stress(&self, e: &Symmetric) -> Symmetric {
        let (lambda, mu) = self.lame();
        IDENTITY * (lambda * (e.x + e.y + e.z)) + e * (2.0 * mu)
    }

    fn tangent(&self, _e: &Symmetric) -> Matrix4<f64> {
        let (lambda, mu) = self.lame();
        IDENTITY * IDENTITY.transpose() * lambda
            + Matrix4::from_diagonal(&Vector4::new(2.0, 2.0, 2.0, 1.0)) * mu
    }
}

/// In a body of revolution: the polynomial with C10 and D1 alone.
impl SolidHyperelastic for NeoHooke {
    fn energy(&self, e: &Symmetric) -> f64 {
        Polynomial::from(*self).energy(e)
    }

    fn energy_change(&self, e0: &Symmetric, e1: &Symmetric) -> f64 {
        Polynomial::from(*self).energy_change(e0, e1)
    }

    fn stress(&self, e: &Symmetric) -> Symmetric {
        SolidHyperelastic::stress(&Polynomial::from(*self), e)
    }

    fn tangent(&self, e: &Symmetric) -> Matrix4<f64> {
        SolidHyperelastic::tangent(&Polynomial::from(*self), e)
    }
}

/// Rings stay elastic.
#[cfg(test)]
impl SolidHyperelastic for Yielding {
    fn energy(&self, e: &Symmetric) -> f64 {
        self.g / 2.0 * contract(e, e)
    }

    fn energy_change(&self, e0: &Symmetric, e1: &Symmetric) -> f64 {
        self.g / 2.0 * contract(&(e0 + e1), &(e1 - e0))
    }

    fn stress(&self, e: &Symmetric) -> Symmetric {
        e * self.g
    }

    fn tangent(&self, _e: &Symmetric) -> Matrix4<f64> {
        Matrix4::from_diagonal(&Symmetric::new(1.0, 1.0, 1.0, 0.5)) * self.g
    }
}

/// Stresses are taken over the length of the increment (force time/length^2).
impl RingStressAtPoints for Viscosity {
    fn ring_stress(&self, _point: usize, strains: &Strains<Symmetric>) -> Symmetric {
        match strains {
            Strains::At(_) => Symmetric::zeros(),
            Strains::Between(e0, e1) => self.stress_of_ring(e0, e1),
        }
    }

    fn ring_tangent(&self, _point: usize, strains: &Strains<Symmetric>) -> Matrix4<f64> {
        match strains {
            Strains::At(_) => Matrix4::zeros(),
            Strains::Between(e0, e1) => self.tangent_of_ring(e0, e1),
        }
    }

    fn ring_is_viscous(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::RingLaw;
    use crate::materials::{Plane, SaintVenantKirchhoff, SmallStrainModuli};

    const MODULI: SmallStrainModuli = SmallStrainModuli {
        young: 1000.0,
        poisson: 0.3,
    };

    fn laws() -> [Box<dyn RingLaw>; 3] {
        let linear = SaintVenantKirchhoff {
            young: 1000.0,
            poisson: 0.3,
        };
        let polynomial = Polynomial {
            shape: [150.0, 10.0, 2.0],
            c01: 40.0,
            d: [2e-3, 0.0, 0.0],
        };
        [
            Box::new(linear.in_plane(Plane::Revolution)),
            Box::new(NeoHooke::of_small_strain(MODULI)),
            Box::new(polynomial),
        ]
    }

    const E0: Symmetric = Vector4::new(0.2, -0.1, 0.3, 0.15);
    const WAY: Symmetric = Vector4::new(-0.4, 0.3, 0.5, 0.2);

    #[test]
    fn the_work_of_the_stress_is_the_change_of_energy() {
        for law in laws() {
            for size in [0.5, 1e-3, 1e-6, 1e-9] {
                let (de, e1) = (WAY * size, E0 + WAY * size);
                let s = law.stress(&Strains::Between(E0, e1), &[], &mut []);
                let change = law.stored_energy(&e1, &[]) - law.stored_energy(&E0, &[]);
                let digits = 1e-14 * law.stored_energy(&E0, &[]);
                assert!((contract(&s, &(e1 - E0)) - change).abs() < digits, "{de}");
            }
        }
    }

    #[test]
    fn tangents_are_derivatives_of_the_stress() {
        let h = 1e-6;
        for law in laws() {
            let e1 = E0 + WAY * 0.4;
            let at = |e: Symmetric| law.stress(&Strains::At(e), &[], &mut []);
            let between = |e: Symmetric| law.stress(&Strains::Between(E0, e), &[], &mut []);
            let c = law.tangent(&Strains::At(e1), &[]);
            let mut whole = Matrix4::zeros();
            for k in 0..4 {
                // half of the shear of a strain in each of 12 and 21
                let mut unit = Symmetric::zeros();
                unit[k] = if k == 3 { 0.5 } else { 1.0 };
                let slope = (at(e1 + unit * h) - at(e1 - unit * h)) / (2.0 * h);
                assert!((slope - c.column(k)).norm() < 1e-7 * c.norm());
                let slope = (between(e1 + unit * h) - between(e1 - unit * h)) / h;
                whole.set_column(k, &slope);
            }
            let symmetric = (whole + whole.transpose()) / 2.0;
            let found = law.tangent(&Strains::Between(E0, e1), &[]);
            assert!((found - symmetric).norm() < 1e-7 * c.norm());
        }
    }

    #[test]
    fn without_strain_around_the_axis_laws_are_those_of_plane_strain() {
        use crate::materials::{Hyperelastic, PlanePolynomial};
        use nalgebra::Matrix2;
        let neo_hooke = NeoHooke::of_small_strain(MODULI);
        let e = Matrix2::new(0.2, 0.15, 0.15, -0.1);
        let solid = Vector4::new(0.2, -0.1, 0.0, 0.15);
        let plane = PlanePolynomial {
            law: neo_hooke.into(),
            plane: Plane::Strain,
        };
        let (found, exact) = (
            RingLaw::stress(&neo_hooke, &Strains::At(solid), &[], &mut []),
            plane.stress(&e),
        );
        let exact = [exact.m11, exact.m22, plane.across(&e).stress, exact.m12];
        assert!((found - Vector4::from(exact)).norm() < 1e-12 * found.norm());
    }

    #[test]
    fn viscosity_takes_energy_and_has_the_spatial_law_in_a_short_increment() {
        let beta = 0.3;
        let v = Viscosity::new(beta, MODULI, Plane::Revolution);
        for size in [0.5, -0.3, 1e-3] {
            let s = v.stress_of_ring(&E0, &(E0 + WAY * size));
            assert!(contract(&s, &(WAY * size)) > 0.0);
        }
        // near E = 0 it is beta C dE
        let linear = SaintVenantKirchhoff {
            young: 1000.0,
            poisson: 0.3,
        }
        .in_plane(Plane::Revolution);
        let de = WAY * 1e-8;
        let found = v.stress_of_ring(&(de * -0.5), &(de * 0.5));
        let exact = SolidHyperelastic::stress(&linear, &de) * beta;
        assert!((found - exact).norm() < 1e-12 * exact.norm());
        // a change of volume alone has no part of the shear modulus: C1 = s^2 C0
        let grown = E0 * 1.44 + super::super::symmetric::IDENTITY * 0.22;
        let bulk = 1000.0 / (3.0 * 0.4);
        let stiffer = Viscosity::new(
            beta,
            NeoHooke {
                c10: 900.0,
                d1: 2.0 / bulk,
            }
            .small_strain(),
            Plane::Revolution,
        );
        let [one, other] = [v, stiffer].map(|v| v.stress_of_ring(&E0, &grown));
        assert!((one - other).norm() < 1e-12 * one.norm());
    }
}
