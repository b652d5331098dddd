//! St. Venant-Kirchhoff material: second Piola-Kirchhoff stress linear in the Green-Lagrange strain
//! (Holzapfel, Nonlinear Solid Mechanics, section 6.5; Bonet & Wood, Nonlinear Continuum Mechanics for
//! Finite Element Analysis, section 6.4). See docs/theory/materials.md.

use super::hyperelastic::Hyperelastic;
use super::number::Number;
use super::strains::StrainChange;
use super::symmetric::{Symmetric, Tangent};
use super::{LawCard, Plane, SmallStrainModuli, StrainMeasure};

/// St. Venant-Kirchhoff material.
///
/// ```text
/// energy   W = lambda/2 (tr E)² + mu E:E = E:C:E/2
/// stress   S = lambda tr(E) I + 2 mu E = C:E
/// tangent  C = lambda I x I + 2 mu 1                                constant
/// domain   J > 0; softens in compression: the uniaxial force is largest at a stretch of 1/sqrt(3)
/// moduli   lambda = E nu/((1 + nu)(1 - 2 nu)),  mu = E/(2 (1 + nu))
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SaintVenantKirchhoff {
    /// Young's modulus E (force/length^2).
    pub young: f64,
    /// Poisson's ratio nu.
    pub poisson: f64,
}

impl SaintVenantKirchhoff {
    /// Moduli at small strains, which are the moduli at all strains.
    pub fn small_strain(&self) -> SmallStrainModuli {
        SmallStrainModuli {
            young: self.young,
            poisson: self.poisson,
        }
    }

    /// `*ELASTIC`; empty for a material without constants.
    pub fn cards(&self) -> Vec<LawCard> {
        let card = LawCard {
            keyword: "ELASTIC",
            parameter: None,
            rows: vec![vec![self.young, self.poisson]],
        };
        if self.young > 0.0 {
            vec![card]
        } else {
            Vec::new()
        }
    }

    /// The law in the plane. Plane stress only changes the constants of the formulas; without the stress S_33 they are
    ///
    /// ```text
    /// E_33 = -nu/(1 - nu) (E_11 + E_22),   lambda' = 2 lambda mu/(lambda + 2 mu) = E nu/(1 - nu²)
    /// ```
    pub fn in_plane(&self, plane: Plane) -> PlaneSaintVenantKirchhoff {
        let (e, nu) = (self.young, self.poisson);
        match plane {
            Plane::Stress => {
                let c = e / (1.0 - nu * nu);
                PlaneSaintVenantKirchhoff {
                    diagonal: c,
                    mixed: c * nu,
                    shear: c * (1.0 - nu) / 2.0,
                    contraction: nu / (1.0 - nu),
                    across: 0.0,
                    is_plane_stress: true,
                }
            }
            Plane::Strain | Plane::Revolution => {
                let c = e / ((1.0 + nu) * (1.0 - 2.0 * nu));
                PlaneSaintVenantKirchhoff {
                    diagonal: c * (1.0 - nu),
                    mixed: c * nu,
                    shear: c * (1.0 - 2.0 * nu) / 2.0,
                    contraction: 0.0,
                    across: nu,
                    is_plane_stress: false,
                }
            }
        }
    }
}

/// St. Venant-Kirchhoff material in plane stress, in plane strain or in a body of revolution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneSaintVenantKirchhoff {
    /// Modulus lambda + 2 mu = C_1111 (force/length^2).
    diagonal: f64,
    /// Modulus lambda = C_1122 (force/length^2).
    mixed: f64,
    /// Modulus mu = C_1212 (force/length^2).
    shear: f64,
    /// Factor in E_33 = -contraction (E_11 + E_22), for plane stress.
    contraction: f64,
    /// Factor in S_33 = across (S_11 + S_22), for strains without E_33.
    across: f64,
    is_plane_stress: bool,
}

impl PlaneSaintVenantKirchhoff {
    /// Moduli lambda and mu at small strains (force/length^2).
    pub(super) fn lame(&self) -> (f64, f64) {
        (self.mixed, self.shear)
    }
}

impl<T: Number, const HOOP: bool> Hyperelastic<T, HOOP> for PlaneSaintVenantKirchhoff {
    /// Stored energy W = E:C:E/2 = S:E/2, eq. (2.13).
    #[inline(always)]
    fn energy(&self, e: &Symmetric<T>) -> T {
        let s = Hyperelastic::<T, HOOP>::stress(self, e);
        let of_plane = (s.x * e.x + s.y * e.y) * 0.5 + s.w * e.w;
        match HOOP {
            true => of_plane + s.z * e.z * 0.5,
            false => of_plane,
        }
    }

    /// Change of the stored energy, W1 - W0 = S(E_m):(E1 - E0).
    #[inline(always)]
    fn energy_change(&self, change: &StrainChange<T>) -> T {
        let s = Hyperelastic::<T, HOOP>::stress(self, &change.mean);
        s.contract::<HOOP>(&change.change())
    }

    /// Stress S = lambda tr(E) I + 2 mu E = C:E, eq. (2.13).
    #[inline(always)]
    fn stress(&self, e: &Symmetric<T>) -> Symmetric<T> {
        let (x, y) = (
            e.x * self.diagonal + e.y * self.mixed,
            e.x * self.mixed + e.y * self.diagonal,
        );
        let w = e.w * (2.0 * self.shear);
        if !HOOP || self.is_plane_stress {
            return Symmetric::new(x, y, (x + y) * self.across, w);
        }
        let around = e.z * self.mixed;
        let z = (e.x + e.y) * self.mixed + e.z * self.diagonal;
        Symmetric::new(x + around, y + around, z, w)
    }

    #[inline(always)]
    fn tangent(&self, _e: &Symmetric<T>) -> Tangent<T> {
        Tangent::of(|i, j| {
            T::all(match (i, j) {
                (2, _) | (_, 2) if self.is_plane_stress => 0.0,
                (3, 3) => self.shear,
                (3, _) | (_, 3) => 0.0,
                _ if i == j => self.diagonal,
                _ => self.mixed,
            })
        })
    }

    #[inline(always)]
    fn strain_across(&self, e: &Symmetric<T>) -> T {
        match HOOP {
            true => e.z - (e.x + e.y) * self.contraction,
            false => (e.x + e.y) * -self.contraction,
        }
    }

    fn convex_in(&self) -> StrainMeasure {
        StrainMeasure::Green
    }

    /// Stress S(E_m) = (S0 + S1)/2, eq. (4.8) (Simo & Tarnow 1992): the discrete gradient of a quadratic energy.
    #[inline(always)]
    fn mean_stress(&self, change: &StrainChange<T>) -> Symmetric<T> {
        Hyperelastic::<T, HOOP>::stress(self, &change.mean)
    }

    #[inline(always)]
    fn mean_tangent(&self, change: &StrainChange<T>) -> Tangent<T> {
        Hyperelastic::<T, HOOP>::tangent(self, &change.mean)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn material(young: f64, poisson: f64) -> SaintVenantKirchhoff {
        SaintVenantKirchhoff { young, poisson }
    }

    fn stress(law: PlaneSaintVenantKirchhoff, e: Symmetric) -> Symmetric {
        Hyperelastic::<f64, true>::stress(&law, &e)
    }

    #[test]
    fn plane_stress_and_plane_strain_by_hand() {
        // E = 960, nu = 1/4: E/(1-nu²) = 1024; E/((1+nu)(1-2nu)) = 1536; G = 384.
        for (plane, diagonal, mixed) in [
            (Plane::Stress, 1024.0, 256.0),
            (Plane::Strain, 1152.0, 384.0),
        ] {
            let law = material(960.0, 0.25).in_plane(plane);
            let Tangent([x, y, _, w]) =
                Hyperelastic::<f64, true>::tangent(&law, &Symmetric::zeros());
            assert_eq!([x[0], x[1], x[3]], [diagonal, mixed, 0.0]);
            assert_eq!([y[0], y[1], y[3]], [mixed, diagonal, 0.0]);
            assert_eq!([w[0], w[1], w[3]], [0.0, 0.0, 384.0]);
        }
    }

    #[test]
    fn uniaxial_stress_in_plane_stress_gives_young() {
        // E_yy = -nu E_xx leaves S_yy = 0 and S_xx = E E_xx.
        let law = material(200.0, 0.3).in_plane(Plane::Stress);
        let s = stress(law, Symmetric::new(1e-3, -3e-4, 0.0, 0.0));
        assert!((s.x - 0.2).abs() < 1e-15 && s.y.abs() < 1e-16 && [s.z, s.w] == [0.0; 2]);
    }

    #[test]
    fn without_lateral_contraction_both_planes_agree() {
        let m = material(7.0, 0.0);
        let e = Symmetric::new(0.3, -0.1, 0.0, 0.2);
        let [one, other] = [Plane::Stress, Plane::Strain].map(|plane| stress(m.in_plane(plane), e));
        assert_eq!(one, other);
    }

    #[test]
    fn shear_strain_counts_once() {
        // S_xy = 2 G E_xy, G = E/(2(1+nu)) = 4.
        let law = material(10.0, 0.25).in_plane(Plane::Strain);
        let s = stress(law, Symmetric::new(0.0, 0.0, 0.0, 0.5));
        assert_eq!(s, Symmetric::new(0.0, 0.0, 0.0, 4.0));
    }
}
