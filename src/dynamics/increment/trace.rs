//! Progress of an attempt at an increment, which it leaves behind when it fails.

use crate::dynamics::results::{Cause, PassReport, Worst};
use crate::linear::largest;

/// Why an attempt failed, and how far it came.
pub(crate) struct Failed {
    pub cause: Cause,
    pub worst: Option<Worst>,
    pub passes: Vec<PassReport>,
}

/// What an attempt leaves behind even when it fails.
#[derive(Default)]
pub(super) struct Trace {
    pub passes: Vec<PassReport>,
    pub worst: Option<Worst>,
    /// Largest force that the passes were to balance, of the first pass and of the last.
    unbalanced: Option<[f64; 2]>,
}

impl Trace {
    /// Takes in the force that a pass is to balance.
    pub fn balance(&mut self, force: &[f64]) {
        let force = largest(force);
        let [first, _] = self.unbalanced.unwrap_or([force; 2]);
        self.unbalanced = Some([first, force]);
    }

    /// Relative correction of the last pass.
    pub fn correction(&self) -> f64 {
        self.passes
            .last()
            .map_or(f64::INFINITY, |pass| pass.correction)
    }

    /// The iterate of the last pass is solved to the given residual.
    pub fn solved(&mut self, residual: f64) {
        if let Some(pass) = self.passes.last_mut() {
            pass.residual = residual;
        }
    }

    /// The failure of the attempt.
    pub fn failed(self, cause: Cause) -> Failed {
        Failed {
            cause: self.explain(cause),
            worst: self.worst,
            passes: self.passes,
        }
    }

    /// The cause as it is, or that passes with ever larger forces have made numbers overflow.
    fn explain(&self, cause: Cause) -> Cause {
        let has_grown = |[first, last]: [f64; 2]| last > first || last.is_nan();
        // where an element is wrecked, there are no forces to compare
        let is_wrecked = matches!(cause, Cause::Inverted { .. }) && !self.passes.is_empty();
        let diverged = is_wrecked || self.unbalanced.is_some_and(has_grown);
        match cause.is_overflow() && diverged {
            true => Cause::Diverged,
            false => cause,
        }
    }
}
