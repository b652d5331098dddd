//! Motions of the pins as free unknowns of the complementarity problems of a static step. See docs/theory/bodies.md,
//! Pins.

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::contact::Constraint;
use crate::lcp::{FreeUnknowns, FrictionalLcp, FrictionalSolution, Stability};
use crate::linear::{larger, largest};

/// Factor eps of eq. (12.5), relative to the mean stiffness of the pins.
const REGULAR: f64 = 1e-11;
/// Stiffness against a motion, in units of E of eq. (12.5), up to which the motion counts as not resisted.
const UNRESISTED: f64 = 10.0;
/// Force along a motion, relative to the other forces, up to which this force is round-off.
const NO_FORCE: f64 = 1e-12;

/// The places p of the far ends of the pins as unknowns. With pins of the stiffness a that end at
/// the places p,
///
/// ```text
/// dU = y + W B^T P + Z p,   f = a S^T (y + W B^T P) - S_p p,   S_p = a - a S^T Z    eq. (12.3)
/// ```
///
/// Here W is the inverse with the pins, Z = W (S a + N Z), y = d_p + W r, and f are the forces of the pins.
pub(crate) struct FreeMotions {
    /// The pinned dofs.
    pub dofs: Vec<usize>,
    /// Stiffness a of every pin (force/length).
    a: Vec<f64>,
    /// The motions Z of all dofs for unit motions of the far ends, column by column (dimensionless).
    motions: Vec<Vec<f64>>,
    /// The columns W S a as motions of all dofs on which forces do work.
    works: Vec<Vec<f64>>,
    /// Forces S a + N Z per unit motion of the far ends (dof, force/length).
    loads: Vec<Vec<(usize, f64)>>,
    /// S_p (force/length).
    stiffness: DMatrix<f64>,
    /// Mean square motion of every body, as a quadratic form of the motions of its pins.
    mean_square: DMatrix<f64>,
    /// The projection P of eq. (12.11) on the part of the motions of the pins that is held.
    held: DMatrix<f64>,
    /// Round-off of forces at the pins.
    round_off: f64,
    /// Largest distance that nodes may move in a pass (length).
    reach: f64,
    /// Motions S^T y of the pins without contact forces and with their far ends at p = 0.
    pub alone: Vec<f64>,
    /// The answer of the last complementarity problem.
    answer: Option<Answer>,
}

/// Answer of a complementarity problem.
struct Answer {
    p: DVector<f64>,
    /// Stiffness against motions p of the far ends under the closed pairs, eq. (12.6).
    under_contact: DMatrix<f64>,
    /// Factor of the mean square motion in E (force/length).
    regular: f64,
    stability: Stability,
}

/// A motion that contact hardly resists.
pub(crate) struct Loose {
    /// Motions of the pins, with a mean square of 1.
    pub pins: DVector<f64>,
    /// Force along the motion that nothing balances at the start of the pass.
    pub force: f64,
    /// Whether contact gives the motion practically no resistance.
    pub is_unresisted: bool,
}

impl FreeMotions {
    /// Free motions of pins with the stiffness `a` at some dofs, from the matrices Z, W S a and S a + N Z over all
    /// dofs. The matrices are the mean square motion of the bodies, the stiffness of forces that are not balanced yet,
    /// and the held part of the motions.
    pub fn new(
        (dofs, a): (Vec<usize>, Vec<f64>),
        [motions, works, loads]: [Vec<Vec<f64>>; 3],
        (mean_square, turning, held): (DMatrix<f64>, DMatrix<f64>, DMatrix<f64>),
        (round_off, reach): (f64, f64),
    ) -> Self {
        let m = dofs.len();
        let stiffness = DMatrix::from_fn(m, m, |i, k| {
            let own = if i == k { a[i] } else { 0.0 };
            own - a[i] * motions[k][dofs[i]]
        });
        let sparse = |load: Vec<f64>| {
            let all = load.into_iter().enumerate();
            all.filter(|(_, force)| *force != 0.0).collect()
        };
        FreeMotions {
            dofs,
            a,
            motions,
            works,
            loads: loads.into_iter().map(sparse).collect(),
            stiffness: stiffness + turning,
            mean_square,
            held,
            round_off,
            reach,
            alone: vec![0.0; m],
            answer: None,
        }
    }

    /// The free unknowns of the complementarity problem of some constraints. For held motions the balance is replaced
    /// by the condition that the far ends of the pins stay in place:
    ///
    /// ```text
    /// H f + P^T a P S^T dU = 0,   H = (1 - P)^T - P^T P    eq. (12.11)
    /// ```
    pub fn unknowns(&self, constraints: &[&Constraint]) -> FreeUnknowns {
        let (n, m) = (constraints.len(), self.dofs.len());
        let of_constraints = |of: &dyn Fn(&Constraint, usize) -> [f64; 2]| {
            DMatrix::from_fn(2 * n, m, |i, k| of(constraints[i % n], k)[i / n])
        };
        let motions = of_constraints(&|c, k| {
            let z = &self.motions[k];
            [c.gap_change(z), c.slip_change(z)]
        });
        let works = of_constraints(&|c, k| {
            let z = &self.works[k];
            [c.normal_motion(z), c.tangential_motion(z)]
        });
        let held = &self.held;
        let a = DMatrix::from_diagonal(&DVector::from_column_slice(&self.a));
        let kept = held.tr_mul(held);
        let h = DMatrix::identity(m, m) - held.transpose() - &kept;
        let alone = DVector::from_column_slice(&self.alone);
        FreeUnknowns {
            motions,
            works: works * h.transpose(),
            stiffness: &h * &self.stiffness + kept * &a,
            regular: &self.mean_square * self.regular(),
            force: h * a * alone,
        }
    }

    /// Factor of the mean square motion in E (force/length).
    fn regular(&self) -> f64 {
        let mean = self.a.iter().sum::<f64>() / self.a.len() as f64;
        REGULAR * mean
    }

    /// Stores the places p that a complementarity problem has given. Motions that nothing resists and that only the
    /// round-off of other forces drives are set to zero.
    pub fn answer(&mut self, problem: &FrictionalLcp, solution: &FrictionalSolution) {
        self.answer = Some(Answer {
            p: solution.free.clone(),
            under_contact: problem.stiffness_under_contact(&solution.state),
            regular: self.regular(),
            stability: solution.stability,
        });
        let of_pairs = solution.pn.iter().copied().fold(0.0, larger);
        let none = self.none_beside(larger(self.largest_force(), of_pairs));
        let mut p = solution.free.clone();
        for loose in self.loose(&|_| 0.0) {
            if loose.is_unresisted && loose.force.abs() <= none {
                let part = loose.pins.dot(&(&self.mean_square * &p));
                p -= loose.pins * part;
            }
        }
        if let Some(answer) = &mut self.answer {
            answer.p = p;
        }
    }

    /// Places p of the last answer.
    pub fn p(&self) -> Vec<f64> {
        match &self.answer {
            Some(answer) => answer.p.as_slice().to_vec(),
            None => vec![0.0; self.dofs.len()],
        }
    }

    /// Forces (S a + N Z) p by which the far ends at the places p move the bodies (dof, force).
    pub fn forces(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let of_pins = self.p().into_iter().zip(&self.loads);
        of_pins.flat_map(|(p, load)| load.iter().map(move |&(dof, force)| (dof, p * force)))
    }

    /// Forces P^T f of the pins along held motions, with f = a (S^T dU - p) for a correction dU of all dofs.
    pub fn carried(&self, du: &[f64]) -> Vec<f64> {
        let p = self.p();
        let force = |k: usize| self.a[k] * (du[self.dofs[k]] - p[k]);
        let force = DVector::from_fn(self.dofs.len(), |k, _| force(k));
        self.held.tr_mul(&force).as_slice().to_vec()
    }

    /// Motions n with a mean square of 1 whose stiffness under the closed pairs of the last answer is at most the
    /// stiffness E or the stiffness of facets (`of_facets`). The motions n are right singular vectors of the stiffness
    /// S_e relative to the mean square motion, since a sliding pair resists, by friction, motions that do not change
    /// its gap.
    pub fn loose(&self, of_facets: &dyn Fn(&[f64]) -> f64) -> Vec<Loose> {
        let Some(Answer {
            p,
            under_contact,
            regular,
            ..
        }) = &self.answer
        else {
            return Vec::new();
        };
        let Some(root) = Cholesky::new(self.mean_square.clone()) else {
            return Vec::new();
        };
        let root = root.l();
        let Some(half) = root.solve_lower_triangular(under_contact) else {
            return Vec::new();
        };
        let Some(scaled) = root.solve_lower_triangular(&half.transpose()) else {
            return Vec::new();
        };
        let scaled = scaled.transpose();
        let Some(v_t) = scaled.svd(false, true).v_t else {
            return Vec::new();
        };
        let mut all = Vec::new();
        for direction in v_t.row_iter() {
            let Some(pins) = root.tr_solve_lower_triangular(&direction.transpose()) else {
                continue;
            };
            // |S_e n| and n^T S_e n, where n has a mean square of 1
            let resisted = root.solve_lower_triangular(&(under_contact * &pins));
            let resisted = resisted.map_or(f64::INFINITY, |force| force.norm());
            let stiffness = pins.dot(&(under_contact * &pins));
            let is_unresisted = resisted <= UNRESISTED * regular;
            let of_facets = of_facets(&self.motion(pins.as_slice()));
            if is_unresisted || resisted <= of_facets {
                let travel = pins.dot(&(&self.mean_square * p));
                all.push(Loose {
                    force: (stiffness + regular) * travel,
                    pins,
                    is_unresisted,
                });
            }
        }
        all
    }

    /// Motion Z n of all dofs for a motion n of the pins.
    pub fn motion(&self, n: &[f64]) -> Vec<f64> {
        let mut motion = vec![0.0; self.motions.first().map_or(0, Vec::len)];
        for (part, column) in n.iter().zip(&self.motions) {
            let both = motion.iter_mut().zip(column);
            both.for_each(|(m, z)| *m += part * z);
        }
        motion
    }

    /// Forces at the pins that do the given work on the motion n of the pins and no work on motions orthogonal to n.
    pub fn force_along(&self, Loose { pins, force, .. }: &Loose) -> Vec<f64> {
        let along = &self.mean_square * pins * *force;
        along.as_slice().to_vec()
    }

    /// Stability of the motions under contact in the last answer.
    pub fn stability(&self) -> Stability {
        self.answer
            .as_ref()
            .map_or(Stability::default(), |answer| answer.stability)
    }

    /// Whether the last answer moves a node farther than a pass may move nodes.
    pub fn goes_too_far(&self) -> bool {
        largest(&self.motion(&self.p())) > self.reach
    }

    /// Size up to which a force along a motion is round-off, if the other forces have the given size.
    pub fn none_beside(&self, others: f64) -> f64 {
        larger(NO_FORCE * others, self.round_off)
    }

    /// The largest force in the balance of the pins.
    fn largest_force(&self) -> f64 {
        let force = |(y, a): (&f64, &f64)| (a * y).abs();
        self.alone.iter().zip(&self.a).map(force).fold(0.0, larger)
    }
}
