//! Viscosity of a material (`*DAMPING, BETA=`): a stress beside that of the law that follows the rate
//! of the strain. Section 4 of docs/theory.md, Damping.

use nalgebra::{Matrix2, Matrix3, Vector3};

use super::{ConstitutiveLaw, Plane, SaintVenantKirchhoff, SmallStrainModuli, StressAtPoints};

/// Stiffness-proportional viscosity of a material in the plane.
///
/// ```text
/// S_d dt = beta C0 dE,  dE = E1 - E0                            the stress, over the increment
/// S_d:dE = (beta/dt) dE:C0:dE >= 0                              what it dissipates
/// ```
///
/// C0 is the elasticity of the law at small strains, which is positive definite and constant, whatever
/// the law: with the tangent of the state in its place the dissipation of a law that softens could be
/// negative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viscosity {
    /// beta C0 in Voigt order (force time/length^2).
    c: Matrix3<f64>,
}

impl Viscosity {
    /// Viscosity of `beta` (time) of a material with these moduli at small strains.
    pub fn new(beta: f64, moduli: SmallStrainModuli, plane: Plane) -> Self {
        let SmallStrainModuli { young, poisson } = moduli;
        let linear = SaintVenantKirchhoff { young, poisson }.in_plane(plane);
        Viscosity {
            c: linear.tangent(&Matrix2::zeros(), &[]) * beta,
        }
    }
}

/// Stresses are taken over the length of the increment (force time/length^2).
impl StressAtPoints for Viscosity {
    /// None at a strain that does not change.
    fn stress(&self, _point: usize, _e: &Matrix2<f64>) -> Matrix2<f64> {
        Matrix2::zeros()
    }

    /// S_d dt = beta C0 dE, eq. (4.22)
    fn mean_stress(&self, _point: usize, [e0, e1]: [&Matrix2<f64>; 2]) -> Matrix2<f64> {
        let de = e1 - e0;
        let s = self.c * Vector3::new(de.m11, de.m22, 2.0 * de.m12);
        Matrix2::new(s.x, s.z, s.z, s.y)
    }

    fn tangent(&self, _point: usize, _e: &Matrix2<f64>) -> Matrix3<f64> {
        Matrix3::zeros()
    }

    fn mean_tangent(&self, _point: usize, _strains: [&Matrix2<f64>; 2]) -> Matrix3<f64> {
        self.c * 2.0
    }
}
