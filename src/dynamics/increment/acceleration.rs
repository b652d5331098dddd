//! Acceleration of passes that converge slowly, by what the last ones have changed (Anderson 1965). Section 4 of
//! docs/theory.md, Acceleration.

use super::equal_forces::ROUND_OFF;
use crate::dynamics::step::Parts;

/// Rate of the corrections above which passes are slow.
const SLOW: f64 = 0.1;
/// Rate above which the last passes say nothing about the next.
const JUMP: f64 = 2.0;
/// Changes that are remembered.
const MEMORY: usize = 5;
/// Part of a change of the correction, beside what is along those before, below which it is round-off.
const DEPENDENT: f64 = 1e-6;

/// A pass from the iterate d to f(d) = d + dU.
#[derive(Debug, Clone, Default)]
struct PassStep {
    /// dU, of every body beside its increment.
    correction: Vec<f64>,
    /// f(d)
    image: Vec<f64>,
}

impl PassStep {
    /// Adds a times another.
    fn add(&mut self, a: f64, other: &PassStep) {
        axpy(a, &other.correction, &mut self.correction);
        axpy(a, &other.image, &mut self.image);
    }
}

/// What the last passes with the same closed pairs say about the solution.
#[derive(Debug, Default)]
pub(super) struct Acceleration {
    last: Option<PassStep>,
    /// Changes from pass to pass, their corrections orthonormal.
    changes: Vec<PassStep>,
}

impl Acceleration {
    /// Writes the correction dU of a pass from the iterate d anew where passes are slow. `correction` is its
    /// largest value beside the increment, `rate` that beside the one of the pass before, and
    /// both may have closed the same pairs.
    pub fn improve(
        &mut self,
        parts: &Parts,
        d: &[f64],
        same_pairs: bool,
        [correction, rate, tolerance]: [f64; 3],
        du: &mut [f64],
    ) {
        if !same_pairs || rate.is_nan() || rate > JUMP {
            self.last = None;
            self.changes.clear();
        }
        if rate > SLOW && correction > ROUND_OFF * tolerance {
            let pass = PassStep {
                correction: parts.beside_increments(d, du),
                image: d.iter().zip(&*du).map(|(d, du)| d + du).collect(),
            };
            let next = self.next(pass);
            (du.iter_mut().zip(next.iter().zip(d))).for_each(|(du, (next, d))| *du = next - d);
        }
    }

    /// The iterate that follows a pass: of all combinations of f(d) with those of the last passes, weights adding up
    /// to 1, the one with the least correction, eq. (4.15):
    ///
    /// ```text
    /// d <- f - sum (e_j.c) f_j,   e_j = c_j the orthonormal changes of the correction, f_j those of f
    /// ```
    fn next(&mut self, pass: PassStep) -> Vec<f64> {
        if let Some(mut change) = self.last.replace(pass.clone()) {
            change.add(-1.0, &pass);
            self.take_in(change);
        }
        let mut next = pass;
        for change in &self.changes {
            let part = dot(&change.correction, &next.correction);
            next.add(-part, change);
        }
        next.image
    }

    /// Makes a change orthonormal to those before and remembers it.
    fn take_in(&mut self, mut change: PassStep) {
        if self.changes.len() == MEMORY {
            self.changes.remove(0);
        }
        let whole = norm(&change.correction);
        for other in &self.changes {
            let part = dot(&other.correction, &change.correction);
            change.add(-part, other);
        }
        let rest = norm(&change.correction);
        if rest > DEPENDENT * whole {
            let vectors = [&mut change.correction, &mut change.image];
            (vectors.into_iter().flatten()).for_each(|value| *value /= rest);
            self.changes.push(change);
        }
    }
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn axpy(a: f64, x: &[f64], y: &mut [f64]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y += a * x);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The map f(d) = A d + c of three unknowns, A with eigenvalues up to 0.9 and one beyond 1.
    fn image(d: &[f64]) -> Vec<f64> {
        let rates = [0.9, -0.5, 1.5];
        (d.iter().zip(rates))
            .map(|(d, rate)| rate * d + 1.0)
            .collect()
    }

    #[test]
    fn linear_passes_end_after_as_many_as_unknowns() {
        let (mut acceleration, mut d) = (Acceleration::default(), vec![0.0; 3]);
        for _ in 0..4 {
            let image = image(&d);
            let correction = image.iter().zip(&d).map(|(f, d)| f - d).collect();
            d = acceleration.next(PassStep { correction, image });
        }
        for (d, end) in d.iter().zip([10.0, 1.0 / 1.5, -2.0]) {
            assert!((d - end).abs() < 1e-11, "{d} {end}");
        }
    }

    #[test]
    fn dependent_changes_are_left_out() {
        let mut acceleration = Acceleration::default();
        for d in [0.0, 1.0, 3.0] {
            let step = |value: f64| vec![value, 0.0];
            let next = acceleration.next(PassStep {
                correction: step(2.0 - d),
                image: step(2.0),
            });
            assert_eq!(next, step(2.0));
        }
        assert_eq!(acceleration.changes.len(), 1);
    }
}
