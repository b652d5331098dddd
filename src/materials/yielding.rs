//! A law with internal variables, for tests of the state at integration points.

use nalgebra::{Matrix2, Matrix3, Vector3};

use super::{Across, ConstitutiveLaw, SmallStrainModuli, energy_momentum};

/// Elastic with W = G/2 (E - Z):(E - Z) at a plastic strain Z = (Z_xx, Z_yy, Z_xy); at the end of an
/// increment Z follows until the elastic strain is within the yield surface |E - Z| <= Y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Yielding {
    /// Modulus G (force/length^2).
    pub g: f64,
    /// Largest elastic strain Y.
    pub y: f64,
}

/// The plastic strain Z.
pub fn plastic(z: &[f64]) -> Matrix2<f64> {
    Matrix2::new(z[0], z[2], z[2], z[1])
}

impl Yielding {
    /// Moduli at small strains: lambda = 0 and mu = G/2.
    pub fn small_strain(&self) -> SmallStrainModuli {
        SmallStrainModuli {
            young: self.g,
            poisson: 0.0,
        }
    }
}

impl ConstitutiveLaw for Yielding {
    fn variables(&self) -> usize {
        3
    }

    fn stored_energy(&self, e: &Matrix2<f64>, z: &[f64]) -> f64 {
        (e - plastic(z)).norm_squared() * self.g / 2.0
    }

    fn energy_change(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>, z: &[f64]) -> f64 {
        self.stress(&((e0 + e1) / 2.0), z).dot(&(e1 - e0))
    }

    fn stress(&self, e: &Matrix2<f64>, z: &[f64]) -> Matrix2<f64> {
        (e - plastic(z)) * self.g
    }

    fn tangent(&self, _e: &Matrix2<f64>, _z: &[f64]) -> Matrix3<f64> {
        Matrix3::from_diagonal(&Vector3::new(self.g, self.g, self.g / 2.0))
    }

    fn mean_stress(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>, z: &[f64]) -> Matrix2<f64> {
        energy_momentum::stress(self, e0, e1, z)
    }

    fn mean_tangent(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>, z: &[f64]) -> Matrix3<f64> {
        energy_momentum::tangent(self, e0, e1, z)
    }

    fn across(&self, _e: &Matrix2<f64>, _z: &[f64]) -> Across {
        Across {
            stretch: 1.0,
            stress: 0.0,
        }
    }

    fn update(&self, e: &Matrix2<f64>, z: &[f64], updated: &mut [f64]) -> f64 {
        let elastic = e - plastic(z);
        let beyond = (1.0 - self.y / elastic.norm()).max(0.0);
        let flow = elastic * beyond;
        updated.copy_from_slice(&[z[0] + flow.m11, z[1] + flow.m22, z[2] + flow.m12]);
        self.stored_energy(e, z) - self.stored_energy(e, updated)
    }
}
