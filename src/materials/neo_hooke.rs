//! Compressible neo-Hookean material with the energy split into isochoric and volumetric part
//! (Holzapfel, Nonlinear Solid Mechanics, sections 6.4 and 6.5; Bonet & Wood, Nonlinear Continuum
//! Mechanics for Finite Element Analysis, section 6.5). Section 2 of docs/theory.md.

use nalgebra::{Matrix2, Matrix3};

use super::lanes::{
    LawInLanes, StrainChange, SymmetricLanes, points_side_by_side, tangent_of, tensor_of, tensors,
};
use super::{Across, Hyperelastic, LawCard, SmallStrainModuli, Strains};

/// Neo-Hookean material in plane strain, `*HYPERELASTIC, NEO HOOKE`.
///
/// With C = I + 2 E (C_zz = 1), I1 = tr C, J = det F, Ibar1 = J^(-2/3) I1:
///
/// ```text
/// energy   W = C10 (Ibar1 - 3) + (J - 1)²/D1
/// stress   S = 2 C10 J^(-2/3) (I - I1/3 C^-1) + p J C^-1,     p = 2 (J - 1)/D1
/// tangent  C = 4 C10/3 J^(-2/3) [ I1 C^-1 o C^-1 + I1/3 C^-1 x C^-1 - I x C^-1 - C^-1 x I ]
///              + (p + 2 J/D1) J C^-1 x C^-1 - 2 p J C^-1 o C^-1
/// domain   J > 0; the pressure stays below 2/D1 in compression
/// moduli   mu = 2 C10,  K = 2/D1
/// ```
///
/// (A o A)_ijkl = (A_ik A_jl + A_il A_jk)/2. Terms are arranged so that small strains keep their
/// digits: with t = 2 tr E, q = 4 det E, J² = 1 + t + q, a = J^(2/3), b = a - 1,
///
/// ```text
/// Ibar1 - 3 = (b² (b + 3) - q)/a,     I - I1/3 C^-1 = [(2 t/3 + q) I - (1 + t/3) 2 cof E]/J²
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NeoHooke {
    /// Shear constant C10 (force/length^2, > 0).
    pub c10: f64,
    /// Compressibility D1 (length^2/force, > 0).
    pub d1: f64,
}

impl NeoHooke {
    /// The material with Young's modulus (force/length^2) and Poisson's ratio at small strains: C10 = mu/2, D1 = 2/K,
    /// mu = E/(2 (1 + nu)), K = E/(3 (1 - 2 nu)).
    pub fn of_small_strain(SmallStrainModuli { young, poisson }: SmallStrainModuli) -> Self {
        NeoHooke {
            c10: young / (4.0 * (1.0 + poisson)),
            d1: 6.0 * (1.0 - 2.0 * poisson) / young,
        }
    }

    /// `*HYPERELASTIC, NEO HOOKE`
    pub fn cards(&self) -> Vec<LawCard> {
        vec![LawCard {
            keyword: "HYPERELASTIC",
            parameter: Some("NEO HOOKE"),
            rows: vec![vec![self.c10, self.d1]],
        }]
    }

    /// mu = 2 C10 and K = 2/D1, E = 9 K mu/(3 K + mu), nu = (3 K - 2 mu)/(2 (3 K + mu)).
    pub fn small_strain(&self) -> SmallStrainModuli {
        let (mu, k) = (2.0 * self.c10, 2.0 / self.d1);
        SmallStrainModuli {
            young: 9.0 * k * mu / (3.0 * k + mu),
            poisson: (3.0 * k - 2.0 * mu) / (2.0 * (3.0 * k + mu)),
        }
    }
}

/// All by the formulas of elements side by side: one number in all lanes costs what one number costs.
impl Hyperelastic for NeoHooke {
    fn stored_energy(&self, e: &Matrix2<f64>) -> f64 {
        LawInLanes::stored_energy(self, &alone(e)).0[0]
    }

    fn energy_change(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>) -> f64 {
        self.energy_change_in_lanes(&StrainChange::between(&alone(e0), &alone(e1)))
            .0[0]
    }

    fn stress(&self, e: &Matrix2<f64>) -> Matrix2<f64> {
        tensor_of(0, &LawInLanes::stress(self, &alone(e)))
    }

    fn tangent(&self, e: &Matrix2<f64>) -> Matrix3<f64> {
        tangent_of(0, &LawInLanes::tangent(self, &alone(e)))
    }

    fn across(&self, e: &Matrix2<f64>) -> Across {
        let [stretch, stress] = LawInLanes::across(self, &alone(e)).map(|value| value.0[0]);
        Across { stretch, stress }
    }

    fn mean_stress(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>) -> Matrix2<f64> {
        let change = StrainChange::between(&alone(e0), &alone(e1));
        tensor_of(0, &LawInLanes::mean_stress(self, &change))
    }

    fn mean_tangent(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>) -> Matrix3<f64> {
        let change = StrainChange::between(&alone(e0), &alone(e1));
        tangent_of(0, &LawInLanes::mean_tangent(self, &change))
    }

    fn stresses(&self, strains: &[Strains], s: &mut [Matrix2<f64>]) {
        points_side_by_side(
            strains,
            s,
            |e| LawInLanes::stress(self, e),
            |change| LawInLanes::mean_stress(self, change),
            tensor_of,
        );
    }

    fn tangents(&self, strains: &[Strains], c: &mut [Matrix3<f64>]) {
        points_side_by_side(
            strains,
            c,
            |e| LawInLanes::tangent(self, e),
            |change| LawInLanes::mean_tangent(self, change),
            tangent_of,
        );
    }
}

/// A strain in all lanes.
fn alone(e: &Matrix2<f64>) -> SymmetricLanes {
    tensors(|_| *e)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::{Plane, SaintVenantKirchhoff};
    use nalgebra::Vector3;

    const MATERIAL: NeoHooke = NeoHooke {
        c10: 200.0,
        d1: 2e-3,
    };

    fn strain(f: &Matrix2<f64>) -> Matrix2<f64> {
        (f.transpose() * f - Matrix2::identity()) / 2.0
    }

    /// Cauchy stress F S F^T/J.
    fn cauchy(f: &Matrix2<f64>) -> Matrix2<f64> {
        f * Hyperelastic::stress(&MATERIAL, &strain(f)) * f.transpose() / f.determinant()
    }

    #[test]
    fn simple_shear_in_closed_form() {
        // F = I + g e_x e_y: J = 1, sigma = 2 C10 dev(F F^T): xy: mu g, xx: mu g² 2/3, yy = zz: -mu g²/3
        let (mu, g) = (2.0 * MATERIAL.c10, 0.7);
        let f = Matrix2::new(1.0, g, 0.0, 1.0);
        let sigma = cauchy(&f);
        let expected = Matrix2::new(2.0 * g / 3.0, 1.0, 1.0, -g / 3.0) * (mu * g);
        assert!((sigma - expected).norm() < 1e-13 * mu);
        let across = Hyperelastic::across(&MATERIAL, &strain(&f));
        assert!((across.stress + mu * g * g / 3.0).abs() < 1e-13 * mu);
        let energy = Hyperelastic::stored_energy(&MATERIAL, &strain(&f));
        assert!((energy - MATERIAL.c10 * g * g).abs() < 1e-13 * mu);
    }

    #[test]
    fn uniaxial_strain_in_closed_form() {
        // F = diag(l, 1, 1): J = l, b = diag(l², 1, 1),
        // sigma_xx = 2 C10 l^(-5/3) 2/3 (l² - 1) + 2 (l - 1)/D1, the others -1/2 of the first part
        for l in [0.4_f64, 0.9, 1.0, 1.5, 3.0] {
            let f = Matrix2::new(l, 0.0, 0.0, 1.0);
            let shape = 2.0 * MATERIAL.c10 * l.powf(-5.0 / 3.0) * (l * l - 1.0) * 2.0 / 3.0;
            let p = 2.0 * (l - 1.0) / MATERIAL.d1;
            let expected = Matrix2::new(shape + p, 0.0, 0.0, p - shape / 2.0);
            assert!((cauchy(&f) - expected).norm() < 1e-12 * (1.0 + expected.norm()));
            let across = Hyperelastic::across(&MATERIAL, &strain(&f));
            assert!((across.stress / l - expected.m22).abs() < 1e-12 * (1.0 + expected.norm()));
        }
    }

    #[test]
    fn stress_and_tangent_are_derivatives() {
        let h = 1e-6;
        for f in [
            Matrix2::new(1.0, 0.0, 0.0, 1.0),
            Matrix2::new(1.4, 0.3, -0.5, 0.8),
            Matrix2::new(0.5, 0.4, 0.1, 0.9),
        ] {
            let e = strain(&f);
            let (s, c) = (
                Hyperelastic::stress(&MATERIAL, &e),
                Hyperelastic::tangent(&MATERIAL, &e),
            );
            let units = [
                Matrix2::new(1.0, 0.0, 0.0, 0.0),
                Matrix2::new(0.0, 0.0, 0.0, 1.0),
                Matrix2::new(0.0, 0.5, 0.5, 0.0),
            ];
            for (k, unit) in units.iter().enumerate() {
                let energy = |h: f64| Hyperelastic::stored_energy(&MATERIAL, &(e + unit * h));
                let slope = (energy(h) - energy(-h)) / (2.0 * h);
                assert!((slope - s.dot(unit)).abs() < 1e-8 * c.norm());
                let stress = |h: f64| Hyperelastic::stress(&MATERIAL, &(e + unit * h));
                let d = (stress(h) - stress(-h)) / (2.0 * h);
                let column = Vector3::new(d.m11, d.m22, d.m12);
                assert!((column - c.column(k)).norm() < 1e-8 * c.norm());
            }
            assert_eq!(c, c.transpose());
        }
    }

    #[test]
    fn small_strains_are_those_of_linear_elasticity_with_all_digits() {
        let moduli = MATERIAL.small_strain();
        assert!((moduli.young - 9.0 * 1000.0 * 400.0 / 3400.0).abs() < 1e-12 * moduli.young);
        let linear = SaintVenantKirchhoff {
            young: moduli.young,
            poisson: moduli.poisson,
        };
        let linear = linear.in_plane(Plane::Strain);
        let c = Hyperelastic::tangent(&linear, &Matrix2::zeros());
        assert!(
            (Hyperelastic::tangent(&MATERIAL, &Matrix2::zeros()) - c).norm() < 1e-14 * c.norm()
        );
        let e = Matrix2::new(3.0, -1.0, -1.0, 2.0) * 1e-14;
        let (s, expected) = (
            Hyperelastic::stress(&MATERIAL, &e),
            Hyperelastic::stress(&linear, &e),
        );
        assert!((s - expected).norm() < 1e-12 * expected.norm());
        let (w, expected) = (
            Hyperelastic::stored_energy(&MATERIAL, &e),
            Hyperelastic::stored_energy(&linear, &e),
        );
        assert!((w - expected).abs() < 1e-12 * expected);
        let change = Hyperelastic::energy_change(&MATERIAL, &e, &(e * 3.0));
        assert!((change - 8.0 * expected).abs() < 1e-11 * expected);
    }

    #[test]
    fn the_energy_change_is_the_difference_of_energies() {
        let e0 = strain(&Matrix2::new(1.4, 0.3, -0.5, 0.8));
        let e1 = strain(&Matrix2::new(0.5, 0.4, 0.1, 0.9));
        let [w0, w1] = [e0, e1].map(|e| Hyperelastic::stored_energy(&MATERIAL, &e));
        let change = Hyperelastic::energy_change(&MATERIAL, &e0, &e1);
        assert!((change - (w1 - w0)).abs() < 1e-14 * (w0 + w1));
    }
}
