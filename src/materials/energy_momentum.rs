//! Energy-momentum stress of any stored energy: the discrete gradient of Gonzalez (Comput. Methods
//! Appl. Mech. Engrg. 190, 2000) in the Green-Lagrange strain. Section 4 of docs/theory.md.
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

use super::ConstitutiveLaw;

/// Norm of dE up to which f is dropped. It changes the energy by a part of about |dE| of itself or
/// less, which is round-off here.
const NO_CHANGE: f64 = f64::EPSILON;

/// Norm of dE up to which the tangent is that of S(E_m): the rest is a part of about |dE| of it, and
/// would carry a round-off of about eps/|dE|.
const NO_CHANGE_OF_TANGENT: f64 = 1.5e-8;

/// S = S(E_m) + f/(dE:dE) dE, eq. (4.8) (force/length^2).
pub fn stress<L: ConstitutiveLaw>(
    law: &L,
    e0: &Matrix2<f64>,
    e1: &Matrix2<f64>,
    z: &[f64],
) -> Matrix2<f64> {
    let (mean, de) = ((e0 + e1) / 2.0, e1 - e0);
    let s = law.stress(&mean, z);
    let squared = de.dot(&de);
    if squared.sqrt() <= NO_CHANGE {
        return s;
    }
    let f = law.energy_change(e0, e1, z) - s.dot(&de);
    s + de * (f / squared)
}

/// Symmetric part of 2 dS/dE1, with n = dE, g = S(E1) - S(E_m) - C(E_m):n/2 = df/dE1 (force/length^2),
/// of eq. (4.8):
///
/// ```text
/// C(E_m) + 2 f/(n:n) (I - 2 n n/(n:n)) + (n g + g n)/(n:n)
/// ```
pub fn tangent<L: ConstitutiveLaw>(
    law: &L,
    e0: &Matrix2<f64>,
    e1: &Matrix2<f64>,
    z: &[f64],
) -> Matrix3<f64> {
    let (mean, de) = ((e0 + e1) / 2.0, e1 - e0);
    let c = law.tangent(&mean, z);
    let squared = de.dot(&de);
    if squared.sqrt() <= NO_CHANGE_OF_TANGENT {
        return c;
    }
    let s = law.stress(&mean, z);
    let f = law.energy_change(e0, e1, z) - s.dot(&de);
    let n = Vector3::new(de.m11, de.m22, de.m12);
    let change = law.stress(e1, z) - s;
    let half = c * Vector3::new(n.x, n.y, 2.0 * n.z) / 2.0;
    let g = Vector3::new(change.m11, change.m22, change.m12) - half;
    // a product of tensor components n acts on engineering strains: n:E = n.(E_xx, E_yy, 2 E_xy)
    let identity = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.5));
    let mixed = n * g.transpose();
    c + (identity - n * n.transpose() * (2.0 / squared)) * (2.0 * f / squared)
        + (mixed + mixed.transpose()) / squared
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::{Law, NeoHooke, Plane, PlaneLaw, SaintVenantKirchhoff};

    fn strain(xx: f64, yy: f64, xy: f64) -> Matrix2<f64> {
        Matrix2::new(xx, xy, xy, yy)
    }

    fn laws() -> [PlaneLaw; 2] {
        let linear = SaintVenantKirchhoff {
            young: 1000.0,
            poisson: 0.3,
        };
        let neo_hooke = NeoHooke {
            c10: 200.0,
            d1: 2e-3,
        };
        [
            Law::SaintVenantKirchhoff(linear).in_plane(Plane::Strain),
            Law::NeoHooke(neo_hooke).in_plane(Plane::Strain),
        ]
    }

    #[test]
    fn the_work_of_the_stress_is_the_change_of_energy() {
        for law in laws() {
            for size in [0.3, 1e-3, 1e-6, 1e-9, 1e-12] {
                let e0 = strain(0.2, -0.1, 0.15);
                let e1 = e0 + strain(-0.7, 0.5, 0.4) * size;
                let de = e1 - e0;
                let s = stress(&law, &e0, &e1, &[]);
                let change = law.energy_change(&e0, &e1, &[]);
                let error = (s.dot(&de) - change).abs();
                assert!(error <= 8.0 * f64::EPSILON * s.norm() * de.norm(), "{size}");
            }
        }
    }

    #[test]
    fn of_a_quadratic_energy_it_is_the_mean_stress() {
        let [law, _] = laws();
        let (e0, e1) = (strain(0.2, -0.1, 0.15), strain(-0.1, 0.3, 0.05));
        let mean = (law.stress(&e0, &[]) + law.stress(&e1, &[])) / 2.0;
        assert!((stress(&law, &e0, &e1, &[]) - mean).norm() < 1e-15 * mean.norm());
        assert!((law.mean_stress(&e0, &e1, &[]) - mean).norm() < 1e-15 * mean.norm());
        let c = law.tangent(&e0, &[]);
        assert!((tangent(&law, &e0, &e1, &[]) - c).norm() < 1e-13 * c.norm());
    }

    #[test]
    fn the_stress_has_no_noise_where_the_strain_hardly_changes() {
        // S - S(E_m) is of second order in dE
        let [_, law] = laws();
        let e0 = strain(0.2, -0.1, 0.15);
        for size in [1e-8, 1e-10, 1e-13, 1e-15, 0.0] {
            let e1 = e0 + strain(-0.7, 0.5, 0.4) * size;
            let s = law.stress(&((e0 + e1) / 2.0), &[]);
            let difference = (stress(&law, &e0, &e1, &[]) - s).norm();
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
                let at = |h: f64| stress(&law, &e0, &(e1 + unit * h), &[]);
                let d = (at(h) - at(-h)) / h; // 2 dS/dE1
                Vector3::new(d.m11, d.m22, d.m12)
            });
            let exact = Matrix3::from_columns(&columns);
            let symmetric = (exact + exact.transpose()) / 2.0;
            let found = tangent(&law, &e0, &e1, &[]);
            assert!((found - symmetric).norm() < 1e-8 * exact.norm());
            let far = (tangent(&law, &e0, &(e0 + units[0] * 1e-7), &[])
                - tangent(&law, &e0, &e0, &[]))
            .norm();
            assert!(far < 1e-5 * exact.norm(), "continuous at dE = 0: {far}");
        }
    }
}
