//! The St. Venant-Kirchhoff law in Voigt notation, for plane stress and plane strain. Section 2 of
//! docs/theory.md.

use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::model::{Material, Plane};

/// Elasticity matrix C in Voigt order xx, yy, xy with engineering shear 2 E_xy (force/length^2).
pub type Elasticity = Matrix3<f64>;

/// Elasticity of a St. Venant-Kirchhoff material, S = C E (Bathe, Finite Element Procedures,
/// table 4.3).
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
pub fn elasticity(material: &Material, plane: Plane) -> Elasticity {
    let (e, nu) = (material.young, material.poisson);
    match plane {
        Plane::Stress => {
            let c = e / (1.0 - nu * nu);
            Matrix3::new(
                c,
                c * nu,
                0.0,
                c * nu,
                c,
                0.0,
                0.0,
                0.0,
                c * (1.0 - nu) / 2.0,
            )
        }
        Plane::Strain => {
            let c = e / ((1.0 + nu) * (1.0 - 2.0 * nu));
            let (a, b) = (c * (1.0 - nu), c * nu);
            Matrix3::new(a, b, 0.0, b, a, 0.0, 0.0, 0.0, c * (1.0 - 2.0 * nu) / 2.0)
        }
    }
}

/// Second Piola-Kirchhoff stress S = C E, eq. (2.3), as a symmetric matrix (force/length^2).
pub fn stress(c: &Elasticity, strain: &Matrix2<f64>) -> Matrix2<f64> {
    let s = c * Vector3::new(strain.m11, strain.m22, 2.0 * strain.m12);
    Matrix2::new(s.x, s.z, s.z, s.y)
}

/// A material under the assumption that its element makes across the thickness: strain energy,
/// stress and tangent as functions of the Green-Lagrange strain E in the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneMaterial {
    c: Elasticity,
    /// E_zz = -contraction (E_xx + E_yy).
    contraction: f64,
    /// S_zz = across (S_xx + S_yy).
    across: f64,
}

/// What happens across the thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thickness {
    /// Stretch F_zz.
    pub stretch: f64,
    /// Second Piola-Kirchhoff stress S_zz (force/length^2).
    pub stress: f64,
}

impl PlaneMaterial {
    /// A material in plane stress or plane strain.
    ///
    /// In plane strain S_zz = lambda (E_xx + E_yy) and S_xx + S_yy = 2 (lambda + mu) (E_xx + E_yy),
    /// so that S_zz = nu (S_xx + S_yy), nu = lambda/(2 (lambda + mu)).
    pub fn new(material: &Material, plane: Plane) -> Self {
        let (contraction, across) = match plane {
            Plane::Stress => (material.poisson / (1.0 - material.poisson), 0.0),
            Plane::Strain => (0.0, material.poisson),
        };
        PlaneMaterial {
            c: elasticity(material, plane),
            contraction,
            across,
        }
    }

    /// Strain energy per reference volume, W = E : C : E/2, eq. (2.4) (force/length^2).
    pub fn energy(&self, strain: &Matrix2<f64>) -> f64 {
        self.stress(strain).dot(strain) / 2.0
    }

    /// Second Piola-Kirchhoff stress S = dW/dE (force/length^2).
    pub fn stress(&self, strain: &Matrix2<f64>) -> Matrix2<f64> {
        stress(&self.c, strain)
    }

    /// Stress with S : (E1 - E0) = W(E1) - W(E0): of a quadratic energy the mean stress,
    /// S_m = (S(U0) + S(U1))/2 = C (E(U0) + E(U1))/2, eq. (4.8).
    pub fn stress_between(&self, start: &Matrix2<f64>, end: &Matrix2<f64>) -> Matrix2<f64> {
        self.stress(&((start + end) / 2.0))
    }

    /// Tangent dS/dE, in Voigt order xx, yy, xy with engineering shear (force/length^2).
    pub fn tangent(&self, _strain: &Matrix2<f64>) -> Elasticity {
        self.c
    }

    /// Stretch and stress across the thickness. Plane strain: F_zz = 1; plane stress: S_zz = 0 and
    /// F_zz^2 = 1 + 2 E_zz.
    pub fn thickness(&self, strain: &Matrix2<f64>) -> Thickness {
        Thickness {
            stretch: (1.0 - 2.0 * self.contraction * strain.trace()).sqrt(),
            stress: self.across * self.stress(strain).trace(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn material(young: f64, poisson: f64) -> Material {
        Material {
            name: "M".into(),
            young,
            poisson,
            density: 1.0,
        }
    }

    #[test]
    fn plane_stress_and_plane_strain_by_hand() {
        // E = 960, nu = 1/4: E/(1-nu²) = 1024; E/((1+nu)(1-2nu)) = 1536; G = 384.
        let c = elasticity(&material(960.0, 0.25), Plane::Stress);
        assert_eq!(
            c,
            Matrix3::new(1024.0, 256.0, 0.0, 256.0, 1024.0, 0.0, 0.0, 0.0, 384.0)
        );
        let c = elasticity(&material(960.0, 0.25), Plane::Strain);
        assert_eq!(
            c,
            Matrix3::new(1152.0, 384.0, 0.0, 384.0, 1152.0, 0.0, 0.0, 0.0, 384.0)
        );
    }

    #[test]
    fn uniaxial_stress_in_plane_stress_gives_young() {
        // E_yy = -nu E_xx leaves S_yy = 0 and S_xx = E E_xx.
        let c = elasticity(&material(200.0, 0.3), Plane::Stress);
        let s = stress(&c, &Matrix2::new(1e-3, 0.0, 0.0, -3e-4));
        assert!((s.m11 - 0.2).abs() < 1e-15 && s.m22.abs() < 1e-16 && s.m12 == 0.0);
    }

    #[test]
    fn without_lateral_contraction_both_planes_agree() {
        let m = material(7.0, 0.0);
        assert_eq!(elasticity(&m, Plane::Stress), elasticity(&m, Plane::Strain));
    }

    #[test]
    fn shear_strain_counts_once() {
        // S_xy = 2 G E_xy, G = E/(2(1+nu)) = 4.
        let c = elasticity(&material(10.0, 0.25), Plane::Strain);
        let s = stress(&c, &Matrix2::new(0.0, 0.5, 0.5, 0.0));
        assert_eq!(s, Matrix2::new(0.0, 4.0, 4.0, 0.0));
    }
}
