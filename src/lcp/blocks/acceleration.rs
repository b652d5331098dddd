//! Acceleration of a fixed-point iteration by its last steps (Anderson 1965), in the form of generalised
//! conjugate residuals. Section 8 of docs/theory.md, Blocks.

use crate::lcp::problems::{axpy, dot};

/// Steps that are remembered.
const MEMORY: usize = 20;

/// Part of a change of the residual, beside what is along those before, below which it is round-off.
const DEPENDENT: f64 = 1e-8;

/// A point of the iteration x <- f(x), whose motion depends linearly on the forces f.
#[derive(Debug, Clone, Default)]
pub(super) struct Step {
    /// f(x) - x
    pub residual: Vec<f64>,
    /// f(x)
    pub forces: Vec<f64>,
    /// Motion under f(x).
    pub motion: Vec<f64>,
}

impl Step {
    /// Adds a times another.
    fn add(&mut self, a: f64, other: &Step) {
        axpy(a, &other.residual, &mut self.residual);
        axpy(a, &other.forces, &mut self.forces);
        axpy(a, &other.motion, &mut self.motion);
    }
}

/// What the last steps say about the answer.
#[derive(Debug, Default)]
pub(super) struct Acceleration {
    last: Option<Step>,
    /// Differences of steps, their residuals orthonormal.
    directions: Vec<Step>,
}

impl Acceleration {
    /// Forgets the steps before.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Of all combinations of this step and those before, weights adding up to 1, the one with the least
    /// residual:
    ///
    /// ```text
    /// f - sum (e_j.r) f_j,   e_j = r_j the orthonormal changes of the residual, f_j those of f
    /// ```
    pub fn next(&mut self, step: Step) -> Step {
        if let Some(mut change) = self.last.replace(step.clone()) {
            change.add(-1.0, &step);
            self.take_in(change);
        }
        let mut next = step;
        for direction in &self.directions {
            let part = dot(&direction.residual, &next.residual);
            next.add(-part, direction);
        }
        next
    }

    /// Makes a change orthonormal to those before and remembers it.
    fn take_in(&mut self, mut change: Step) {
        if self.directions.len() == MEMORY {
            self.directions.remove(0);
        }
        let whole = norm(&change.residual);
        for direction in &self.directions {
            let part = dot(&direction.residual, &change.residual);
            change.add(-part, direction);
        }
        let rest = norm(&change.residual);
        if rest > DEPENDENT * whole {
            let vectors = [&mut change.residual, &mut change.forces, &mut change.motion];
            vectors
                .into_iter()
                .flatten()
                .for_each(|value| *value /= rest);
            self.directions.push(change);
        }
    }
}

fn norm(vector: &[f64]) -> f64 {
    dot(vector, vector).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x <- A x + c of three unknowns, A with eigenvalues up to 0.9 and one beyond 1, is solved by four
    /// accelerated steps.
    #[test]
    fn a_linear_iteration_ends_after_as_many_steps_as_unknowns() {
        let rates = [0.9, -0.5, 1.5];
        let image = |x: &[f64]| -> Vec<f64> {
            let of = x.iter().zip(rates);
            of.map(|(x, rate)| rate * x + 1.0).collect()
        };
        let (mut acceleration, mut x) = (Acceleration::default(), vec![0.0; 3]);
        for _ in 0..4 {
            let forces = image(&x);
            let residual = forces.iter().zip(&x).map(|(f, x)| f - x).collect();
            let motion = forces.iter().map(|f| 2.0 * f).collect();
            let next = acceleration.next(Step {
                residual,
                forces,
                motion,
            });
            x = next.forces;
            for (x, motion) in x.iter().zip(next.motion) {
                assert!((motion - 2.0 * x).abs() < 1e-12 * (1.0 + motion.abs()));
            }
        }
        for (x, rate) in x.iter().zip(rates) {
            assert!((x - 1.0 / (1.0 - rate)).abs() < 1e-11, "{x} {rate}");
        }
    }
}
