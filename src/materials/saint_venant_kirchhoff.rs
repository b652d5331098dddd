//! St. Venant-Kirchhoff material: second Piola-Kirchhoff stress linear in the Green-Lagrange strain
//! (Holzapfel, Nonlinear Solid Mechanics, section 6.5; Bonet & Wood, Nonlinear Continuum Mechanics for
//! Finite Element Analysis, section 6.4). Section 2 of docs/theory.md.

use nalgebra::{Matrix2, Matrix3, Vector3};

use super::{Across, Hyperelastic, LawCard, Plane, SmallStrainModuli};

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

/// St. Venant-Kirchhoff material in plane stress, in plane strain or in a body of revolution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneSaintVenantKirchhoff {
    /// Elasticity C in Voigt order xx, yy, xy with engineering shear 2 E_xy (force/length^2).
    c: Matrix3<f64>,
    /// E_zz = -contraction (E_xx + E_yy).
    contraction: f64,
    /// S_zz = across (S_xx + S_yy).
    across: f64,
}

impl SaintVenantKirchhoff {
    /// Moduli at small strains: those of all strains.
    pub fn small_strain(&self) -> SmallStrainModuli {
        SmallStrainModuli {
            young: self.young,
            poisson: self.poisson,
        }
    }

    /// `*ELASTIC`; none of a material without constants.
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

    /// The law in the plane.
    ///
    /// In plane strain S_zz = lambda (E_xx + E_yy) and S_xx + S_yy = 2 (lambda + mu) (E_xx + E_yy), so
    /// that their quotient is nu = lambda/(2 (lambda + mu)).
    pub fn in_plane(&self, plane: Plane) -> PlaneSaintVenantKirchhoff {
        let (contraction, across) = match plane {
            Plane::Stress => (self.poisson / (1.0 - self.poisson), 0.0),
            Plane::Strain | Plane::Revolution => (0.0, self.poisson),
        };
        PlaneSaintVenantKirchhoff {
            c: self.elasticity(plane),
            contraction,
            across,
        }
    }

    /// Elasticity in Voigt order (Bathe, Finite Element Procedures, table 4.3; force/length^2).
    ///
    /// ```text
    ///                        [ 1   nu  0          ]
    /// plane stress  E/(1-nu²)[ nu  1   0          ]
    ///                        [ 0   0   (1 - nu)/2 ]
    ///
    ///                                 [ 1-nu  nu    0          ]
    /// plane strain  E/((1+nu)(1-2nu)) [ nu    1-nu  0          ]
    ///                                 [ 0     0     (1-2 nu)/2 ]
    /// ```
    fn elasticity(&self, plane: Plane) -> Matrix3<f64> {
        let (e, nu) = (self.young, self.poisson);
        let (a, b, g) = match plane {
            Plane::Stress => {
                let c = e / (1.0 - nu * nu);
                (c, c * nu, c * (1.0 - nu) / 2.0)
            }
            Plane::Strain | Plane::Revolution => {
                let c = e / ((1.0 + nu) * (1.0 - 2.0 * nu));
                (c * (1.0 - nu), c * nu, c * (1.0 - 2.0 * nu) / 2.0)
            }
        };
        Matrix3::new(a, b, 0.0, b, a, 0.0, 0.0, 0.0, g)
    }
}

impl PlaneSaintVenantKirchhoff {
    /// Elasticity C in Voigt order (force/length^2).
    #[inline(always)]
    pub fn elasticity(&self) -> &Matrix3<f64> {
        &self.c
    }

    /// lambda and mu of plane strain and of bodies of revolution (force/length^2).
    pub(super) fn lame(&self) -> (f64, f64) {
        (self.c.m12, self.c.m33)
    }

    /// -E_zz/(E_xx + E_yy) and S_zz/(S_xx + S_yy).
    #[inline(always)]
    pub fn across_ratios(&self) -> [f64; 2] {
        [self.contraction, self.across]
    }
}

impl Hyperelastic for PlaneSaintVenantKirchhoff {
    /// W = E:C:E/2 = S:E/2, eq. (2.13)
    fn stored_energy(&self, e: &Matrix2<f64>) -> f64 {
        self.stress(e).dot(e) / 2.0
    }

    /// W1 - W0 = S(E_m):(E1 - E0)
    fn energy_change(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>) -> f64 {
        self.mean_stress(e0, e1).dot(&(e1 - e0))
    }

    /// S = lambda tr(E) I + 2 mu E = C:E, eq. (2.13)
    fn stress(&self, e: &Matrix2<f64>) -> Matrix2<f64> {
        let s = self.c * Vector3::new(e.m11, e.m22, 2.0 * e.m12);
        Matrix2::new(s.x, s.z, s.z, s.y)
    }

    fn tangent(&self, _e: &Matrix2<f64>) -> Matrix3<f64> {
        self.c
    }

    /// F_zz² = 1 + 2 E_zz
    fn across(&self, e: &Matrix2<f64>) -> Across {
        Across {
            stretch: (1.0 - 2.0 * self.contraction * e.trace()).sqrt(),
            stress: self.across * self.stress(e).trace(),
        }
    }

    /// S(E_m) = (S0 + S1)/2, eq. (4.8) (Simo & Tarnow 1992): the discrete gradient of a quadratic energy.
    fn mean_stress(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>) -> Matrix2<f64> {
        self.stress(&((e0 + e1) / 2.0))
    }

    fn mean_tangent(&self, _e0: &Matrix2<f64>, _e1: &Matrix2<f64>) -> Matrix3<f64> {
        self.c
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn material(young: f64, poisson: f64) -> SaintVenantKirchhoff {
        SaintVenantKirchhoff { young, poisson }
    }

    #[test]
    fn plane_stress_and_plane_strain_by_hand() {
        // E = 960, nu = 1/4: E/(1-nu²) = 1024; E/((1+nu)(1-2nu)) = 1536; G = 384.
        let c = material(960.0, 0.25).elasticity(Plane::Stress);
        assert_eq!(
            c,
            Matrix3::new(1024.0, 256.0, 0.0, 256.0, 1024.0, 0.0, 0.0, 0.0, 384.0)
        );
        let c = material(960.0, 0.25).elasticity(Plane::Strain);
        assert_eq!(
            c,
            Matrix3::new(1152.0, 384.0, 0.0, 384.0, 1152.0, 0.0, 0.0, 0.0, 384.0)
        );
    }

    #[test]
    fn uniaxial_stress_in_plane_stress_gives_young() {
        // E_yy = -nu E_xx leaves S_yy = 0 and S_xx = E E_xx.
        let law = material(200.0, 0.3).in_plane(Plane::Stress);
        let s = law.stress(&Matrix2::new(1e-3, 0.0, 0.0, -3e-4));
        assert!((s.m11 - 0.2).abs() < 1e-15 && s.m22.abs() < 1e-16 && s.m12 == 0.0);
    }

    #[test]
    fn without_lateral_contraction_both_planes_agree() {
        let m = material(7.0, 0.0);
        assert_eq!(m.in_plane(Plane::Stress), m.in_plane(Plane::Strain));
    }

    #[test]
    fn shear_strain_counts_once() {
        // S_xy = 2 G E_xy, G = E/(2(1+nu)) = 4.
        let law = material(10.0, 0.25).in_plane(Plane::Strain);
        let s = law.stress(&Matrix2::new(0.0, 0.5, 0.5, 0.0));
        assert_eq!(s, Matrix2::new(0.0, 4.0, 4.0, 0.0));
    }
}
