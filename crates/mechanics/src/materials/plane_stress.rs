//! Plane stress for any law: the stretch across the plane minimises the energy. See docs/theory/materials.md.

use super::hyperelastic::Hyperelastic;
use super::number::Number;
use super::strains::StrainChange;
use super::symmetric::{Symmetric, Tangent};

/// A stored energy without stress across the plane.
///
/// The stretch across the plane, F_33 = exp(l), minimises the energy W, so S_33 C_33 = 0. The energy then depends only
/// on the strains in the plane, eq. (2.25), and the tangent has no row across the plane: C_ab - C_a3 C_3b/C_33. Only
/// the square of an error of the strain across the plane enters the energy W. In the strains given by a caller the
/// component 33 is zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneStress<L> {
    /// The law with all components.
    pub law: L,
    /// Poisson's ratio at small strains.
    pub poisson: f64,
}

/// Largest number of steps of Newton's method for the stretch across the plane.
const MOST_STEPS: usize = 60;
/// Change of the exponent l, relative to l and the strains, up to which the change is round-off.
const ROUND_OFF: f64 = 2.0 * f64::EPSILON;

impl<L: Hyperelastic> PlaneStress<L> {
    /// Strain E_33 = (exp(2 l) - 1)/2, found by Newton's method in l, with the derivatives of the energy W
    ///
    /// ```text
    /// W' = S_33 C_33,   W'' = C_3333 C_33² + 2 S_33 C_33
    /// ```
    ///
    /// A step that does not lower the derivative |W'| is halved. The iteration starts at the stretch of linear
    /// elasticity in ln det F.
    fn across(&self, e: &Symmetric) -> f64 {
        let slopes = |l: f64| {
            let strain = with_across(e, (2.0 * l).exp_m1() / 2.0);
            let (s33, c3333) = (
                self.law.stress(&strain).z,
                self.law.tangent(&strain).0[2][2],
            );
            let c33 = (2.0 * l).exp();
            [s33 * c33, (c3333 * c33 + 2.0 * s33) * c33]
        };
        let grown = 2.0 * (e.x + e.y) + 4.0 * (e.x * e.y - e.w * e.w);
        let mut l = -self.poisson / (1.0 - self.poisson) * grown.ln_1p() / 2.0;
        let size = e.norm();
        let [mut w1, mut w2] = slopes(l);
        for _ in 0..MOST_STEPS {
            let mut step = -w1 / w2.abs();
            let mut next = slopes(l + step);
            while next[0].abs() > w1.abs() && step.abs() > ROUND_OFF * (l.abs() + size) {
                step /= 2.0;
                next = slopes(l + step);
            }
            l += step;
            [w1, w2] = next;
            // NaN does not count as far, so it ends the iteration
            let is_far = step.abs() > ROUND_OFF * (l.abs() + size);
            if !is_far {
                break;
            }
        }
        (2.0 * l).exp_m1() / 2.0
    }

    /// The strain with its component across the plane.
    fn complete<T: Number>(&self, e: &Symmetric<T>) -> Symmetric<T> {
        Symmetric {
            z: T::of_lanes(|lane| self.across(&e.lane(lane))),
            ..*e
        }
    }
}

fn with_across(e: &Symmetric, z: f64) -> Symmetric {
    Symmetric { z, ..*e }
}

/// A change of strains, with the given components 33 at start and end.
pub(super) fn completed<T: Number>(
    change: &StrainChange<T>,
    [start, end]: [T; 2],
) -> StrainChange<T> {
    let with = |e: &Symmetric<T>, z: T| Symmetric { z, ..*e };
    StrainChange {
        start: with(&change.start, start),
        end: with(&change.end, end),
        mean: with(&change.mean, (start + end) * 0.5),
        half: with(&change.half, (end - start) * 0.5),
    }
}

/// Stress S_ab - C_ab33/C_3333 S_33, from a stress and a tangent at the strain across the plane; the round-off of a
/// large pressure cancels in this difference.
pub(super) fn condensed_stress<T: Number>(s: &Symmetric<T>, c: &Tangent<T>) -> Symmetric<T> {
    let part = s.z / c.0[2][2];
    let along = |i: usize| c.0[i][2] * part;
    Symmetric::new(s.x - along(0), s.y - along(1), T::default(), s.w - along(3))
}

/// Tangent C_ab - C_a3 C_3b/C_33, without the row across the plane.
pub(super) fn condensed_tangent<T: Number>(c: &Tangent<T>) -> Tangent<T> {
    let over = T::all(1.0) / c.0[2][2];
    Tangent::of(|i, j| match i == 2 || j == 2 {
        true => T::default(),
        false => c.0[i][j] - c.0[i][2] * c.0[2][j] * over,
    })
}

impl<T: Number, const HOOP: bool, L: Hyperelastic<T> + Hyperelastic> Hyperelastic<T, HOOP>
    for PlaneStress<L>
{
    fn energy(&self, e: &Symmetric<T>) -> T {
        self.law.energy(&self.complete(e))
    }

    fn energy_change(&self, change: &StrainChange<T>) -> T {
        let across = [change.start, change.end].map(|e| self.complete(&e).z);
        self.law.energy_change(&completed(change, across))
    }

    fn stress(&self, e: &Symmetric<T>) -> Symmetric<T> {
        let e = self.complete(e);
        condensed_stress(&self.law.stress(&e), &self.law.tangent(&e))
    }

    fn tangent(&self, e: &Symmetric<T>) -> Tangent<T> {
        condensed_tangent(&self.law.tangent(&self.complete(e)))
    }

    fn strain_across(&self, e: &Symmetric<T>) -> T {
        self.complete(e).z
    }
}
