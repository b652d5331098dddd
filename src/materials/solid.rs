//! Laws in all components of the strain of a ring: an element of a body of revolution, whose strain around the axis
//! follows from its radial displacement. Elastic materials give the discrete gradient of their stored energy as they do
//! in the plane. Sections 2 and 4 of docs/theory.md.

use nalgebra::{Matrix4, Vector4};

use super::hyperelastic::{NO_CHANGE, NO_CHANGE_OF_TANGENT};
use super::symmetric::{Symmetric, contract};
use super::{Metal, StrainMeasure, Strains};

/// A material with the internal variables z0 that the last accepted increment has committed, as
/// [`super::ConstitutiveLaw`] in the components 11 (radial), 22 (axial), 33 (around the axis) and 12.
pub trait RingLaw {
    /// Second Piola-Kirchhoff stress, or energy-momentum stress (force/length^2), and the internal variables at the end
    /// of the strains, which are written to `z1`.
    fn stress(&self, strains: &Strains<Symmetric>, z0: &[f64], z1: &mut [f64]) -> Symmetric;

    /// Tangent of [`Self::stress`] on strains (11, 22, 33, 2*12), or the symmetric part of twice its derivative by E1
    /// (force/length^2).
    fn tangent(&self, strains: &Strains<Symmetric>, z0: &[f64]) -> Matrix4<f64>;

    /// Stored energy W(E, z) (force/length^2).
    fn stored_energy(&self, e: &Symmetric, z: &[f64]) -> f64;

    /// Energy D >= 0 dissipated on the way to the internal variables at the end of the strains (force/length^2).
    fn dissipation(&self, _strains: &Strains<Symmetric>, _z0: &[f64]) -> f64 {
        0.0
    }
}

/// A stress that follows from the strains at the integration points of one ring: that of its material, or that of its
/// viscosity.
pub trait RingStressAtPoints {
    /// Second Piola-Kirchhoff stress at a point (force/length^2).
    fn ring_stress(&self, point: usize, strains: &Strains<Symmetric>) -> Symmetric;

    /// Tangent of [`Self::ring_stress`] at a point, as [`RingLaw::tangent`] (force/length^2).
    fn ring_tangent(&self, point: usize, strains: &Strains<Symmetric>) -> Matrix4<f64>;

    /// Whether the stress is that of a change of the strains, without a stored energy.
    fn ring_is_viscous(&self) -> bool {
        false
    }

    /// As [`super::StressAtPoints::initial_tangent`] (force/length^2).
    fn ring_initial_tangent(&self) -> Matrix4<f64> {
        let zero = Symmetric::zeros();
        self.ring_tangent(0, &Strains::Between(zero, zero))
    }

    /// As [`super::StressAtPoints::convex_in`].
    fn ring_convex_in(&self) -> StrainMeasure {
        StrainMeasure::Green
    }

    /// As [`super::StressAtPoints::beyond`].
    fn ring_beyond(&self, _points: usize) -> &[f64] {
        &[]
    }

    /// As [`super::StressAtPoints::metal`].
    fn ring_metal(&self, _points: usize) -> Option<Metal<'_>> {
        None
    }
}

/// An elastic material in all components: its stored energy is a function of the strain, and all there is.
pub trait SolidHyperelastic {
    /// Stored energy W(E) (force/length^2).
    fn energy(&self, e: &Symmetric) -> f64;

    /// W(E1) - W(E0), with a round-off that is relative to E1 - E0 (force/length^2).
    fn energy_change(&self, e0: &Symmetric, e1: &Symmetric) -> f64;

    /// Second Piola-Kirchhoff stress S = dW/dE, eq. (2.3) (force/length^2).
    fn stress(&self, e: &Symmetric) -> Symmetric;

    /// Tangent C = dS/dE, eq. (2.3), on strains (11, 22, 33, 2*12) (force/length^2).
    fn tangent(&self, e: &Symmetric) -> Matrix4<f64>;
}

impl<L: SolidHyperelastic> RingLaw for L {
    /// S(E), or S(E_m) + f/(dE:dE) dE with f = W1 - W0 - S(E_m):dE, eq. (4.8).
    fn stress(&self, strains: &Strains<Symmetric>, _z0: &[f64], _z1: &mut [f64]) -> Symmetric {
        let (e0, e1) = match strains {
            Strains::At(e) => return SolidHyperelastic::stress(self, e),
            Strains::Between(e0, e1) => (e0, e1),
        };
        let de = e1 - e0;
        let s = SolidHyperelastic::stress(self, &((e0 + e1) / 2.0));
        let squared = contract(&de, &de);
        if squared.sqrt() <= NO_CHANGE {
            return s;
        }
        s + de * ((self.energy_change(e0, e1) - contract(&s, &de)) / squared)
    }

    /// C(E), or the symmetric part of twice the derivative of eq. (4.8) by E1, with C = C(E_m), n = dE and
    /// g = S(E1) - S(E_m) - C:dE/2:
    ///
    /// ```text
    /// C + 2 f/(n:n) (I - 2 n n/(n:n)) + (n g + g n)/(n:n)
    /// ```
    fn tangent(&self, strains: &Strains<Symmetric>, _z0: &[f64]) -> Matrix4<f64> {
        let (e0, e1) = match strains {
            Strains::At(e) => return SolidHyperelastic::tangent(self, e),
            Strains::Between(e0, e1) => (e0, e1),
        };
        let (mean, n) = ((e0 + e1) / 2.0, e1 - e0);
        let c = SolidHyperelastic::tangent(self, &mean);
        let squared = contract(&n, &n);
        if squared.sqrt() <= NO_CHANGE_OF_TANGENT {
            return c;
        }
        let s = SolidHyperelastic::stress(self, &mean);
        let f = self.energy_change(e0, e1) - contract(&s, &n);
        let half = c * Vector4::new(n.x, n.y, n.z, 2.0 * n.w) / 2.0;
        let g = SolidHyperelastic::stress(self, e1) - s - half;
        // a product of tensor components n acts on strains with twice the shear: n:E
        let identity = Matrix4::from_diagonal(&Vector4::new(1.0, 1.0, 1.0, 0.5));
        let mixed = n * g.transpose();
        c + (identity - n * n.transpose() * (2.0 / squared)) * (2.0 * f / squared)
            + (mixed + mixed.transpose()) / squared
    }

    fn stored_energy(&self, e: &Symmetric, _z: &[f64]) -> f64 {
        self.energy(e)
    }
}
