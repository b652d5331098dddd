//! Elastic materials: their stored energy is all there is. Its energy-momentum stress is the discrete gradient of
//! Gonzalez (Comput. Methods Appl. Mech. Engrg. 190, 2000) in the Green-Lagrange strain. Sections 2 and 4 of
//! docs/theory.md.
//!
//! # Derivation
//!
//! The force int B_L(U_m)^T S dOmega at the mid configuration U_m does the work d.F = int S:dE dOmega
//! with any S, because B_L(U_m) d = E1 - E0 = dE exactly (E is quadratic in U); S symmetric keeps the
//! angular momentum. The energy is kept if S:dE = W1 - W0. Of all stresses that satisfy this, the
//! nearest to S(E_m), E_m = (E0 + E1)/2, is S(E_m) + lambda dE:
//!
//! ```text
//! S = S(E_m) + f/(dE:dE) dE,     f = W1 - W0 - S(E_m):dE
//! ```
//!
//! f is of third order in dE, so that the scheme stays of second order. Where W is quadratic f is
//! zero and S the mean (S0 + S1)/2 of Simo & Tarnow (1992). C_m = I + 2 E_m is positive definite with
//! C0 and C1.

use nalgebra::{Matrix2, Matrix3, Vector3};

use super::{Across, ConstitutiveLaw, Strains};

/// Norm of dE up to which f is dropped. It changes the energy by a part of about |dE| of itself or
/// less, which is round-off here.
pub const NO_CHANGE: f64 = f64::EPSILON;

/// Norm of dE up to which the tangent is that of S(E_m): the rest is a part of about |dE| of it, and
/// would carry a round-off of about eps/|dE|.
pub const NO_CHANGE_OF_TANGENT: f64 = 1.5e-8;

/// An elastic material in the plane: its stored energy is a function of the strain, and all there is.
pub trait Hyperelastic {
    /// Stored energy W(E) (force/length^2).
    fn stored_energy(&self, e: &Matrix2<f64>) -> f64;

    /// W(E1) - W(E0), with a round-off that is relative to E1 - E0: it may not be formed as the
    /// difference of two energies, which keeps no digits where E1 is near E0.
    fn energy_change(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>) -> f64;

    /// Second Piola-Kirchhoff stress S = dW/dE, eq. (2.3) (force/length^2).
    fn stress(&self, e: &Matrix2<f64>) -> Matrix2<f64>;

    /// Tangent C = dS/dE, eq. (2.3), in Voigt order (force/length^2).
    fn tangent(&self, e: &Matrix2<f64>) -> Matrix3<f64>;

    /// Stretch and stress across the thickness.
    fn across(&self, e: &Matrix2<f64>) -> Across;

    /// Energy-momentum stress between two strains, eq. (4.8): S:(E1 - E0) = W(E1) - W(E0).
    #[inline]
    fn mean_stress(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>) -> Matrix2<f64> {
        energy_momentum_stress(self, e0, e1)
    }

    /// Symmetric part of 2 dS/dE1 of [`Self::mean_stress`], in Voigt order (force/length^2).
    #[inline]
    fn mean_tangent(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>) -> Matrix3<f64> {
        energy_momentum_tangent(self, e0, e1)
    }

    /// Stresses of several points, all of one kind of strains (force/length^2).
    fn stresses(&self, strains: &[Strains], s: &mut [Matrix2<f64>]) {
        for (strains, s) in strains.iter().zip(s) {
            *s = match strains {
                Strains::At(e) => self.stress(e),
                Strains::Between(e0, e1) => self.mean_stress(e0, e1),
            };
        }
    }

    /// Tangents of several points, all of one kind of strains (force/length^2).
    fn tangents(&self, strains: &[Strains], c: &mut [Matrix3<f64>]) {
        for (strains, c) in strains.iter().zip(c) {
            *c = match strains {
                Strains::At(e) => self.tangent(e),
                Strains::Between(e0, e1) => self.mean_tangent(e0, e1),
            };
        }
    }
}

impl<L: Hyperelastic> ConstitutiveLaw for L {
    #[inline]
    fn stress(&self, strains: &Strains, _z0: &[f64], _z1: &mut [f64]) -> Matrix2<f64> {
        match strains {
            Strains::At(e) => Hyperelastic::stress(self, e),
            Strains::Between(e0, e1) => self.mean_stress(e0, e1),
        }
    }

    #[inline]
    fn tangent(&self, strains: &Strains, _z0: &[f64]) -> Matrix3<f64> {
        match strains {
            Strains::At(e) => Hyperelastic::tangent(self, e),
            Strains::Between(e0, e1) => self.mean_tangent(e0, e1),
        }
    }

    fn stresses(&self, strains: &[Strains], _z0: &[f64], s: &mut [Matrix2<f64>]) {
        Hyperelastic::stresses(self, strains, s);
    }

    fn tangents(&self, strains: &[Strains], _z0: &[f64], c: &mut [Matrix3<f64>]) {
        Hyperelastic::tangents(self, strains, c);
    }

    fn stored_energy(&self, e: &Matrix2<f64>, _z: &[f64]) -> f64 {
        Hyperelastic::stored_energy(self, e)
    }

    fn across(&self, e: &Matrix2<f64>, _z: &[f64]) -> Across {
        Hyperelastic::across(self, e)
    }
}

/// S = S(E_m) + f/(dE:dE) dE, eq. (4.8) (force/length^2).
fn energy_momentum_stress<L: Hyperelastic + ?Sized>(
    law: &L,
    e0: &Matrix2<f64>,
    e1: &Matrix2<f64>,
) -> Matrix2<f64> {
    let (mean, de) = ((e0 + e1) / 2.0, e1 - e0);
    let s = law.stress(&mean);
    corrected_stress(s, &de, || law.energy_change(e0, e1) - s.dot(&de))
}

/// Symmetric part of 2 dS/dE1 of [`energy_momentum_stress`] (force/length^2): [`corrected_tangent`] with C = C(E_m) and
/// g = S(E1) - S(E_m) - C(E_m):dE/2.
fn energy_momentum_tangent<L: Hyperelastic + ?Sized>(
    law: &L,
    e0: &Matrix2<f64>,
    e1: &Matrix2<f64>,
) -> Matrix3<f64> {
    let (mean, de) = ((e0 + e1) / 2.0, e1 - e0);
    let c = law.tangent(&mean);
    corrected_tangent(c, &de, || {
        let s = law.stress(&mean);
        let f = law.energy_change(e0, e1) - s.dot(&de);
        let change = law.stress(e1) - s;
        let half = c * Vector3::new(de.m11, de.m22, 2.0 * de.m12) / 2.0;
        let g = Vector3::new(change.m11, change.m22, change.m12) - half;
        (f, g)
    })
}

/// S + f/(dE:dE) dE, eq. (4.8), with the work f that S lacks (force/length^2).
#[inline]
pub fn corrected_stress(
    s: Matrix2<f64>,
    de: &Matrix2<f64>,
    f: impl FnOnce() -> f64,
) -> Matrix2<f64> {
    let squared = de.dot(de);
    if squared.sqrt() <= NO_CHANGE {
        return s;
    }
    s + de * (f() / squared)
}

/// Symmetric part of the derivative of twice [`corrected_stress`] by E1, with C = 2 dS/dE1, n = dE and g = df/dE1
/// (force/length^2):
///
/// ```text
/// C + 2 f/(n:n) (I - 2 n n/(n:n)) + (n g + g n)/(n:n)
/// ```
#[inline]
pub fn corrected_tangent(
    c: Matrix3<f64>,
    de: &Matrix2<f64>,
    f_and_g: impl FnOnce() -> (f64, Vector3<f64>),
) -> Matrix3<f64> {
    let squared = de.dot(de);
    if squared.sqrt() <= NO_CHANGE_OF_TANGENT {
        return c;
    }
    let (f, g) = f_and_g();
    let n = Vector3::new(de.m11, de.m22, de.m12);
    // a product of tensor components n acts on engineering strains: n:E = n.(E_xx, E_yy, 2 E_xy)
    let identity = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.5));
    let mixed = n * g.transpose();
    c + (identity - n * n.transpose() * (2.0 / squared)) * (2.0 * f / squared)
        + (mixed + mixed.transpose()) / squared
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::{NeoHooke, Plane, SaintVenantKirchhoff};

    fn strain(xx: f64, yy: f64, xy: f64) -> Matrix2<f64> {
        Matrix2::new(xx, xy, xy, yy)
    }

    fn laws() -> [Box<dyn Hyperelastic>; 2] {
        let linear = SaintVenantKirchhoff {
            young: 1000.0,
            poisson: 0.3,
        };
        let neo_hooke = NeoHooke {
            c10: 200.0,
            d1: 2e-3,
        };
        [
            Box::new(linear.in_plane(Plane::Strain)),
            Box::new(neo_hooke),
        ]
    }

    #[test]
    fn the_work_of_the_stress_is_the_change_of_energy() {
        for law in laws() {
            for size in [0.3, 1e-3, 1e-6, 1e-9, 1e-12] {
                let e0 = strain(0.2, -0.1, 0.15);
                let e1 = e0 + strain(-0.7, 0.5, 0.4) * size;
                let de = e1 - e0;
                let s = energy_momentum_stress(&*law, &e0, &e1);
                let change = law.energy_change(&e0, &e1);
                let error = (s.dot(&de) - change).abs();
                assert!(error <= 8.0 * f64::EPSILON * s.norm() * de.norm(), "{size}");
            }
        }
    }

    #[test]
    fn of_a_quadratic_energy_it_is_the_mean_stress() {
        let [law, _] = laws();
        let (e0, e1) = (strain(0.2, -0.1, 0.15), strain(-0.1, 0.3, 0.05));
        let mean = (law.stress(&e0) + law.stress(&e1)) / 2.0;
        assert!((energy_momentum_stress(&*law, &e0, &e1) - mean).norm() < 1e-15 * mean.norm());
        assert!((law.mean_stress(&e0, &e1) - mean).norm() < 1e-15 * mean.norm());
        let c = law.tangent(&e0);
        assert!((energy_momentum_tangent(&*law, &e0, &e1) - c).norm() < 1e-13 * c.norm());
    }

    #[test]
    fn the_stress_has_no_noise_where_the_strain_hardly_changes() {
        // S - S(E_m) is of second order in dE
        let [_, law] = laws();
        let e0 = strain(0.2, -0.1, 0.15);
        for size in [1e-8, 1e-10, 1e-13, 1e-15, 0.0] {
            let e1 = e0 + strain(-0.7, 0.5, 0.4) * size;
            let s = law.stress(&((e0 + e1) / 2.0));
            let difference = (energy_momentum_stress(&*law, &e0, &e1) - s).norm();
            assert!(difference < 1e-14 * s.norm(), "{size}: {difference}");
        }
    }

    #[test]
    fn the_tangent_is_the_symmetric_part_of_the_derivative() {
        let h = 1e-6;
        for law in laws() {
            let (e0, e1) = (strain(0.2, -0.1, 0.15), strain(-0.1, 0.3, 0.05));
            let units = [
                strain(1.0, 0.0, 0.0),
                strain(0.0, 1.0, 0.0),
                strain(0.0, 0.0, 0.5),
            ];
            let columns = units.map(|unit| {
                let at = |h: f64| energy_momentum_stress(&*law, &e0, &(e1 + unit * h));
                let d = (at(h) - at(-h)) / h; // 2 dS/dE1
                Vector3::new(d.m11, d.m22, d.m12)
            });
            let exact = Matrix3::from_columns(&columns);
            let symmetric = (exact + exact.transpose()) / 2.0;
            let found = energy_momentum_tangent(&*law, &e0, &e1);
            assert!((found - symmetric).norm() < 1e-8 * exact.norm());
            let far = (energy_momentum_tangent(&*law, &e0, &(e0 + units[0] * 1e-7))
                - energy_momentum_tangent(&*law, &e0, &e0))
            .norm();
            assert!(far < 1e-5 * exact.norm(), "continuous at dE = 0: {far}");
        }
    }
}
