//! The plane: assumption of elements across the thickness, and moduli of a law near its reference state. See
//! docs/theory/materials.md.

use super::symmetric::{IDENTITY, Symmetric};

/// Kinematic assumption across the thickness.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Plane {
    /// No stress across the thickness (CPS elements).
    Stress,
    /// No strain across the thickness (CPE elements).
    Strain,
    /// A body of revolution around the axis x = 0, which moves without torsion (CAX elements).
    Revolution,
}

/// Moduli of the linear elastic material with which a law agrees near its reference state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmallStrainModuli {
    /// Young's modulus E (force/length^2).
    pub young: f64,
    /// Poisson's ratio nu.
    pub poisson: f64,
}

impl SmallStrainModuli {
    /// Shear modulus mu = E/(2 (1 + nu)) (force/length^2).
    pub(super) fn shear(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }

    /// Bulk modulus K = E/(3 (1 - 2 nu)) (force/length^2).
    pub(super) fn bulk(&self) -> f64 {
        self.young / (3.0 * (1.0 - 2.0 * self.poisson))
    }

    /// Stress (K - 2/3 mu) tr(A) I + 2 mu A for a strain A (force/length^2).
    pub(super) fn stress(&self, strain: &Symmetric) -> Symmetric {
        let trace = strain.x + strain.y + strain.z;
        let lambda = self.bulk() - 2.0 / 3.0 * self.shear();
        IDENTITY * (lambda * trace) + *strain * (2.0 * self.shear())
    }

    /// Moduli from a shear modulus mu and a bulk modulus K (force/length^2):
    ///
    /// ```text
    /// E = 9 K mu/(3 K + mu),   nu = (3 K - 2 mu)/(2 (3 K + mu))
    /// ```
    pub fn of_shear_and_bulk(mu: f64, k: f64) -> Self {
        SmallStrainModuli {
            young: 9.0 * k * mu / (3.0 * k + mu),
            poisson: (3.0 * k - 2.0 * mu) / (2.0 * (3.0 * k + mu)),
        }
    }
}
