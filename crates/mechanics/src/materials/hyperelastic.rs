//! Elastic materials, whose stress is the derivative of a stored energy. The energy-momentum stress is the discrete
//! gradient of Gonzalez (2000) in the Green-Lagrange strain. See docs/theory/materials.md and docs/theory/time.md.
//!
//! # Derivation
//!
//! The force int B_L(U_m)^T S dOmega at the mid configuration U_m does the work d.F = int S:dE dOmega with any stress
//! S, because B_L(U_m) d = E1 - E0 = dE holds exactly (E is quadratic in U). A symmetric stress S conserves the angular
//! momentum. The energy is conserved if the stress S satisfies S:dE = W1 - W0. Of all stresses with S:dE = W1 - W0, the
//! stress nearest to S(E_m), with E_m = (E0 + E1)/2, is S(E_m) + lambda dE:
//!
//! ```text
//! S = S(E_m) + f/(dE:dE) dE,     f = W1 - W0 - S(E_m):dE
//! ```
//!
//! The scalar f is of third order in dE, so the scheme keeps its second order. If the stored energy W is quadratic, the
//! correction f is zero and S is the mean (S0 + S1)/2 of Simo & Tarnow (1992). The tensor C_m = I + 2 E_m is positive
//! definite because C0 and C1 are positive definite.

use super::number::Number;
use super::strains::{Across, StrainChange, StrainMeasure, Strains};
use super::symmetric::{Symmetric, Tangent};

/// Norm of dE up to which the correction f is neglected. The correction f changes the energy by a
/// relative amount of about |dE| or less, which is round-off if |dE| is below the bound.
pub const NO_CHANGE: f64 = f64::EPSILON;

/// Norm of dE up to which the tangent of S(E_m) is used: the omitted part of the tangent is relatively about |dE|, and
/// would have a round-off of about eps/|dE|.
pub const NO_CHANGE_OF_TANGENT: f64 = 1.5e-8;

/// A stored energy W(E) of the strain, for numbers T. Without `HOOP` the strain component 33 is zero, or depends on the
/// strains in the plane.
pub trait Hyperelastic<T = f64, const HOOP: bool = true> {
    /// W(E) (force/length^2).
    fn energy(&self, e: &Symmetric<T>) -> T;

    /// Change of the stored energy, W(E1) - W(E0), with a round-off that is relative to E1 - E0 (force/length^2). The
    /// change must not be computed as a difference of two energies, which would have no correct digits if E1 is near
    /// E0.
    fn energy_change(&self, change: &StrainChange<T>) -> T;

    /// Second Piola-Kirchhoff stress S = dW/dE, eq. (2.3) (force/length^2).
    fn stress(&self, e: &Symmetric<T>) -> Symmetric<T>;

    /// Tangent C = dS/dE, eq. (2.3), which acts on strains (11, 22, 33, 2*12) (force/length^2).
    fn tangent(&self, e: &Symmetric<T>) -> Tangent<T>;

    /// The strain component 33.
    #[inline(always)]
    fn strain_across(&self, e: &Symmetric<T>) -> T
    where
        T: Number,
    {
        e.z
    }

    /// Stretch and stress across the plane, with F_33² = 1 + 2 E_33.
    #[inline(always)]
    fn across(&self, e: &Symmetric<T>) -> Across<T>
    where
        T: Number,
    {
        Across {
            stretch: (self.strain_across(e) * 2.0 + 1.0).sqrt(),
            stress: self.stress(e).z,
        }
    }

    /// The measure of strain in which the energy is convex; the measure is logarithmic if the law fulfils Hill's
    /// inequality.
    fn convex_in(&self) -> StrainMeasure {
        StrainMeasure::Logarithmic
    }

    /// Energy-momentum stress, eq. (4.8): S:(E1 - E0) = W(E1) - W(E0) (force/length^2).
    #[inline(always)]
    fn mean_stress(&self, change: &StrainChange<T>) -> Symmetric<T>
    where
        T: Number,
    {
        let (s, n) = (self.stress(&change.mean), change.change());
        let f = self.energy_change(change) - s.contract::<HOOP>(&n);
        corrected_stress::<T, HOOP>(&s, &n, f)
    }

    /// Symmetric part of 2 dS/dE1 of [`Self::mean_stress`] (force/length^2): `corrected_tangent` with C = C(E_m) and
    /// g = S(E1) - S(E_m) - C(E_m):dE/2.
    #[inline(always)]
    fn mean_tangent(&self, change: &StrainChange<T>) -> Tangent<T>
    where
        T: Number,
    {
        let (c, n) = (self.tangent(&change.mean), change.change());
        let s = self.stress(&change.mean);
        let f = self.energy_change(change) - s.contract::<HOOP>(&n);
        let g = self.stress(&change.end) - s - c.times::<HOOP>(&change.half);
        corrected_tangent::<T, HOOP>(&c, &n, (f, &g))
    }

    /// Stress at a strain or between two strains.
    #[inline(always)]
    fn stress_of(&self, strains: &Strains<T>) -> Symmetric<T>
    where
        T: Number,
    {
        match strains {
            Strains::At(e) => self.stress(e),
            Strains::Between(change) => self.mean_stress(change),
        }
    }

    /// Tangent at a strain or between two strains.
    #[inline(always)]
    fn tangent_of(&self, strains: &Strains<T>) -> Tangent<T>
    where
        T: Number,
    {
        match strains {
            Strains::At(e) => self.tangent(e),
            Strains::Between(change) => self.mean_tangent(change),
        }
    }
}

/// Stress S + f/(n:n) n of eq. (4.8), with n = E1 - E0 (force/length^2).
#[inline(always)]
pub fn corrected_stress<T: Number, const HOOP: bool>(
    s: &Symmetric<T>,
    n: &Symmetric<T>,
    f: T,
) -> Symmetric<T> {
    let factor = over(f, n.contract::<HOOP>(n), NO_CHANGE);
    *s + n.times(factor)
}

/// Symmetric part of the derivative of twice [`corrected_stress`] with respect to E1, with C = 2 dS/dE1 and g = df/dE1
/// (force/length^2):
///
/// ```text
/// C + 2 f/(n:n) (1 - 2 n n/(n:n)) + (n g + g n)/(n:n)
/// ```
#[inline(always)]
pub fn corrected_tangent<T: Number, const HOOP: bool>(
    c: &Tangent<T>,
    n: &Symmetric<T>,
    (f, g): (T, &Symmetric<T>),
) -> Tangent<T> {
    let of_mixed = over(T::all(1.0), n.contract::<HOOP>(n), NO_CHANGE_OF_TANGENT);
    let of_unit = f * of_mixed * 2.0;
    let of_square = of_unit * of_mixed * -2.0;
    let (n, g) = (n.components(), g.components());
    // a product of tensor components n acts on strains with twice the shear: n:E
    let unit = [1.0, 1.0, 1.0, 0.5];
    Tangent::of(|i, j| {
        let mixed = (n[i] * g[j] + g[i] * n[j]) * of_mixed;
        let own = c.0[i][j] + n[i] * n[j] * of_square + mixed;
        match i == j {
            true => own + of_unit * unit[i],
            false => own,
        }
    })
}

/// The factor f/(n:n), or 0 if |n| is not above a bound.
#[inline(always)]
fn over<T: Number>(f: T, squared: T, bound: f64) -> T {
    (f / squared).where_kept(|lane| {
        let is_small = squared.lane(lane) <= bound * bound;
        !is_small
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::plane_stress::PlaneStress;
    use crate::materials::{
        Hencky, NeoHooke, Plane, PlaneLaw, Polynomial, SaintVenantKirchhoff, SmallStrainModuli,
    };

    const NEO_HOOKE: NeoHooke = NeoHooke {
        c10: 200.0,
        d1: 2e-3,
    };

    const HENCKY: Hencky = Hencky {
        moduli: SmallStrainModuli {
            young: 1000.0,
            poisson: 0.3,
        },
    };

    fn laws() -> Vec<(&'static str, Box<dyn Hyperelastic>)> {
        let linear = |plane| {
            SaintVenantKirchhoff {
                young: 1000.0,
                poisson: 0.3,
            }
            .in_plane(plane)
        };
        let polynomial = Polynomial {
            shape: [150.0, 10.0, 2.0],
            c01: 40.0,
            d: [2e-3, 1e-2, 0.0],
        };
        let poisson = polynomial.small_strain().poisson;
        vec![
            ("linear", Box::new(linear(Plane::Revolution))),
            ("linear in plane stress", Box::new(linear(Plane::Stress))),
            ("neo-Hooke", Box::new(NEO_HOOKE)),
            ("polynomial", Box::new(polynomial)),
            (
                "polynomial in plane stress",
                Box::new(PlaneStress {
                    law: polynomial,
                    poisson,
                }),
            ),
            ("Hencky", Box::new(HENCKY)),
            (
                "Hencky in plane stress",
                Box::new(PlaneStress {
                    law: HENCKY,
                    poisson: HENCKY.moduli.poisson,
                }),
            ),
        ]
    }

    const E0: Symmetric = Symmetric {
        x: 0.2,
        y: -0.1,
        z: 0.3,
        w: 0.15,
    };

    /// A strain and a direction of its change, in plane stress without components 33.
    fn start_and_direction(name: &str) -> (Symmetric, Symmetric) {
        let direction = Symmetric::new(-0.4, 0.3, 0.5, 0.2);
        match name.contains("stress") {
            true => (
                Symmetric { z: 0.0, ..E0 },
                Symmetric {
                    z: 0.0,
                    ..direction
                },
            ),
            false => (E0, direction),
        }
    }

    #[test]
    fn the_work_of_the_stress_is_the_change_of_energy() {
        for (name, law) in laws() {
            let (e0, direction) = start_and_direction(name);
            for size in [0.5, 1e-3, 1e-6, 1e-9, 1e-12] {
                let half = direction * (size / 2.0);
                let change = StrainChange::about(e0 + half, half);
                let (s, de) = (law.mean_stress(&change), change.change());
                let energy = law.energy_change(&change);
                let error = (s.contract::<true>(&de) - energy).abs();
                assert!(
                    error <= 16.0 * f64::EPSILON * s.norm() * de.norm(),
                    "{name} {size}"
                );
                // the change of energy keeps all digits, compared with the work of the stress at
                // the mean strain
                let mean = law.stress(&change.mean).contract::<true>(&de);
                let bound = size * size * 10.0 + 1e-13;
                assert!((energy / mean - 1.0).abs() < bound, "{name} {size}");
            }
            let [w0, w1] = [e0, e0 + direction].map(|e| law.energy(&e));
            let found = law.energy_change(&StrainChange::between(&e0, &(e0 + direction)));
            assert!((found - (w1 - w0)).abs() < 1e-13 * (w0 + w1), "{name}");
        }
    }

    #[test]
    fn stress_and_tangents_are_derivatives() {
        let h = 1e-6;
        for (name, law) in laws() {
            let (e0, direction) = start_and_direction(name);
            let e1 = e0 + direction * 0.4;
            let scale = law.tangent(&e1).matrix().norm();
            let between = |e: Symmetric| law.mean_stress(&StrainChange::between(&e0, &e));
            let slope = |of: &dyn Fn(Symmetric) -> Symmetric, unit: &Symmetric| {
                (of(e1 + *unit * h) - of(e1 - *unit * h)) / (2.0 * h)
            };
            let at = Tangent::of_columns(|unit| slope(&|e| law.stress(&e), unit)).matrix();
            let whole = Tangent::of_columns(|unit| slope(&between, unit) * 2.0).matrix();
            let symmetric = (whole + whole.transpose()) / 2.0;
            let found = law.tangent(&e1).matrix();
            let of_mean = law.mean_tangent(&StrainChange::between(&e0, &e1)).matrix();
            let rows = if name.contains("stress") {
                vec![0, 1, 3]
            } else {
                vec![0, 1, 2, 3]
            };
            for (&i, &j) in rows.iter().flat_map(|i| rows.iter().map(move |j| (i, j))) {
                assert!(
                    (found[(i, j)] - at[(i, j)]).abs() < 1e-7 * scale,
                    "{name} {i} {j}"
                );
                let error = (of_mean[(i, j)] - symmetric[(i, j)]).abs();
                assert!(error < 1e-7 * scale, "{name} {i} {j}: {error}");
                assert!((found[(i, j)] - found[(j, i)]).abs() < 1e-14 * scale);
            }
            let unit = Symmetric::new(0.3, -0.2, 0.0, 0.4);
            let energies = [h, -h].map(|h| law.energy(&(e1 + unit * h)));
            let slope = (energies[0] - energies[1]) / (2.0 * h);
            let work = law.stress(&e1).contract::<true>(&unit);
            assert!((slope - work).abs() < 1e-7 * scale, "{name}");
        }
    }

    #[test]
    fn of_a_quadratic_energy_it_is_the_mean_stress() {
        let (name, law) = &laws()[0];
        let (e0, direction) = start_and_direction(name);
        let mean = (law.stress(&e0) + law.stress(&(e0 + direction))) / 2.0;
        let found = law.mean_stress(&StrainChange::between(&e0, &(e0 + direction)));
        assert!((found - mean).norm() < 1e-15 * mean.norm());
    }

    #[test]
    fn there_is_no_noise_where_the_strain_hardly_changes() {
        // S - S(E_m) is of second order in dE
        for (name, law) in laws() {
            let (mean, direction) = start_and_direction(name);
            for size in [1e-8, 1e-10, 1e-13, 1e-15, 0.0] {
                let change = StrainChange::about(mean, direction * size);
                let s = law.stress(&mean);
                let difference = (law.mean_stress(&change) - s).norm();
                assert!(difference < 2e-14 * s.norm(), "{name} {size}: {difference}");
                let c = law.tangent(&mean).matrix();
                let far = (law.mean_tangent(&change).matrix() - c).norm();
                assert!(far < 1e-5 * c.norm(), "{name} {size}: {far}");
            }
        }
    }

    #[test]
    fn small_strains_are_those_of_linear_elasticity_with_all_digits() {
        use crate::materials::Law;
        let polynomial = Polynomial {
            shape: [150.0, 10.0, 2.0],
            c01: 40.0,
            d: [2e-3, 1e-2, 0.0],
        };
        let laws = [
            Law::NeoHooke(NEO_HOOKE),
            Law::Polynomial(polynomial),
            Law::Hencky(HENCKY),
        ];
        for (law, plane) in laws
            .iter()
            .flat_map(|law| [Plane::Strain, Plane::Stress].map(|plane| (law, plane)))
        {
            let moduli = law.small_strain();
            let linear = Law::elastic(moduli.young, moduli.poisson).in_plane(plane);
            let (own, linear) = (elastic(&law.in_plane(plane)), elastic(&linear));
            let zero = Symmetric::zeros();
            let difference = own.tangent(&zero).matrix() - linear.tangent(&zero).matrix();
            assert!(difference.norm() < 2e-14 * linear.tangent(&zero).matrix().norm());
            let e = Symmetric::new(3.0, 2.0, 0.0, -1.0) * 1e-14;
            let expected = linear.stress(&e);
            assert!((own.stress(&e) - expected).norm() < 1e-12 * expected.norm());
            let expected = linear.energy(&e);
            assert!((own.energy(&e) - expected).abs() < 1e-12 * expected);
            let change = own.energy_change(&StrainChange::between(&e, &(e * 3.0)));
            assert!((change - 8.0 * expected).abs() < 1e-11 * expected);
        }
    }

    fn elastic(law: &PlaneLaw) -> Box<dyn Hyperelastic> {
        match law {
            PlaneLaw::SaintVenantKirchhoff(law) => Box::new(*law),
            PlaneLaw::Hencky(law) => Box::new(*law),
            PlaneLaw::HenckyInPlaneStress(law) => Box::new(*law),
            PlaneLaw::NeoHooke(law) => Box::new(*law),
            PlaneLaw::Polynomial(law) => Box::new(*law),
            PlaneLaw::PolynomialInPlaneStress(law) => Box::new(*law),
            law => panic!("{law:?} has internal variables"),
        }
    }

    /// Stress and tangent of several elements in the plane are the same as the results for single elements with all
    /// components.
    #[test]
    fn in_lanes_and_without_hoop_laws_are_the_same() {
        use crate::materials::{Elastic, Lanes, OneByOne, StressAtPoints};
        fn both<L: Hyperelastic + Hyperelastic<Lanes, false>>(law: &L) {
            for (size, step) in [
                (0.2, 0.1),
                (1.0, 0.2),
                (0.1, 1e-7),
                (0.1, 1e-17),
                (0.0, 0.0),
            ] {
                let lanes = |a: [[f64; 2]; 3], by: f64| {
                    let [x, y, w] = a.map(|a| Lanes(a.map(|a| a * by)));
                    Symmetric::new(x, y, Lanes::ZERO, w)
                };
                let mean = lanes([[0.7, -0.2], [-0.2, 0.9], [0.3, 0.1]], size);
                let half = lanes([[0.1, -0.3], [0.4, 0.2], [-0.2, 0.1]], step);
                let (own, one) = (Elastic(law), OneByOne([Elastic(law), Elastic(law)]));
                for strains in [
                    Strains::At(mean),
                    Strains::Between(StrainChange::about(mean, half)),
                ] {
                    let found: Symmetric<Lanes> =
                        StressAtPoints::<Lanes, false>::stress_at(&own, 0, &strains);
                    let exact: Symmetric<Lanes> =
                        StressAtPoints::<Lanes, false>::stress_at(&one, 0, &strains);
                    let c = StressAtPoints::<Lanes, false>::tangent_at(&own, 0, &strains);
                    let expected = StressAtPoints::<Lanes, false>::tangent_at(&one, 0, &strains);
                    // the energy error that is corrected is known to a relative accuracy of about
                    // eps/|dE|
                    let lost = if step > 0.0 && step < 1e-6 { 1e6 } else { 10.0 };
                    for lane in 0..2 {
                        let (s, t) = (found.lane(lane), exact.lane(lane));
                        let in_plane = (s.in_plane() - t.in_plane()).norm();
                        assert!(in_plane <= 1e-12 * (t.norm() + 1e-290), "{size} {step}");
                        for (i, j) in [(0, 0), (1, 1), (3, 3), (0, 1), (1, 3), (0, 3)] {
                            let [a, b] = [&c, &expected].map(|c| c.0[i][j].0[lane]);
                            assert!((a - b).abs() <= 1e-9 * lost, "{size} {step} {i} {j}");
                        }
                    }
                }
                let energies = [
                    StressAtPoints::<Lanes, false>::energy_at(&own, 0, &mean),
                    StressAtPoints::<Lanes, false>::energy_at(
                        &OneByOne([Elastic(law), Elastic(law)]),
                        0,
                        &mean,
                    ),
                ];
                let [a, b] = energies.map(|energy| energy.0[1]);
                assert!((a - b).abs() <= 1e-12 * b.abs());
                let a = StressAtPoints::<Lanes, false>::across_at(&own, 0, &mean)
                    .stress
                    .0[0];
                let b = StressAtPoints::<Lanes, false>::across_at(&one, 0, &mean)
                    .stress
                    .0[0];
                assert!((a - b).abs() <= 1e-10, "{a} {b}");
            }
        }
        both(&NEO_HOOKE);
        both(&Polynomial {
            shape: [150.0, 10.0, 2.0],
            c01: 40.0,
            d: [2e-3, 1e-2, 0.0],
        });
        both(
            &SaintVenantKirchhoff {
                young: 1000.0,
                poisson: 0.3,
            }
            .in_plane(Plane::Strain),
        );
        both(
            &SaintVenantKirchhoff {
                young: 1000.0,
                poisson: 0.3,
            }
            .in_plane(Plane::Stress),
        );
    }
}
