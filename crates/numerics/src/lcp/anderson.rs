//! Acceleration of an iteration x <- f(x) by its last steps (Anderson 1965), in the form of generalised conjugate
//! residuals.

use super::dense::axpy;

/// A step of an iteration x <- f(x).
#[derive(Debug, Clone)]
pub struct IterationStep<const N: usize> {
    /// The residual f(x) - x, with a suitable unit for every entry.
    pub residual: Vec<f64>,
    /// The image f(x), and vectors that depend linearly on it.
    pub images: [Vec<f64>; N],
}

impl<const N: usize> IterationStep<N> {
    /// Adds `a` times another step.
    fn add(&mut self, a: f64, other: &Self) {
        axpy(a, &other.residual, &mut self.residual);
        for (image, other) in self.images.iter_mut().zip(&other.images) {
            axpy(a, other, image);
        }
    }

    fn divide(&mut self, by: f64) {
        let vectors = self.images.iter_mut().chain([&mut self.residual]);
        vectors.flatten().for_each(|value| *value /= by);
    }
}

/// Differences of the last steps of an iteration, from which a better next step follows.
#[derive(Debug)]
pub struct Acceleration<const N: usize> {
    memory: usize,
    dependent: f64,
    last: Option<IterationStep<N>>,
    /// Changes from step to step; their residuals are orthonormal.
    changes: Vec<IterationStep<N>>,
}

impl<const N: usize> Acceleration<N> {
    /// An acceleration without steps, which will remember `memory` changes. A change of the residual counts as
    /// round-off if its part orthogonal to earlier changes is less than `dependent` times the change.
    pub fn new(memory: usize, dependent: f64) -> Self {
        Acceleration {
            memory,
            dependent,
            last: None,
            changes: Vec::new(),
        }
    }

    /// Forgets all earlier steps.
    pub fn clear(&mut self) {
        self.last = None;
        self.changes.clear();
    }

    /// Images from which the next step is made. The images are those of the combination of this step and earlier ones,
    /// with weights that add up to 1, that has the smallest residual:
    ///
    /// ```text
    /// f - sum (e_j.r) f_j,   e_j = r_j the orthonormal changes of the residual, f_j those of f
    /// ```
    pub fn next(&mut self, step: IterationStep<N>) -> [Vec<f64>; N] {
        if let Some(mut change) = self.last.replace(step.clone()) {
            change.add(-1.0, &step);
            self.remember(change);
        }
        let mut next = step;
        for change in &self.changes {
            let part = dot(&change.residual, &next.residual);
            next.add(-part, change);
        }
        next.images
    }

    /// Makes the residual of a change orthonormal to those of earlier changes, and remembers the change.
    fn remember(&mut self, mut change: IterationStep<N>) {
        if self.changes.len() == self.memory {
            self.changes.remove(0);
        }
        let whole = norm(&change.residual);
        for other in &self.changes {
            let part = dot(&other.residual, &change.residual);
            change.add(-part, other);
        }
        let rest = norm(&change.residual);
        if rest > self.dependent * whole {
            change.divide(rest);
            self.changes.push(change);
        }
    }
}

fn norm(vector: &[f64]) -> f64 {
    dot(vector, vector).sqrt()
}

/// Sum of a_i b_i, in the order of the entries.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The iteration x <- A x + c of three unknowns, where A has eigenvalues of 0.9, -0.5 and 1.5, is solved by four
    /// accelerated steps.
    #[test]
    fn a_linear_iteration_ends_after_as_many_steps_as_unknowns() {
        let rates = [0.9, -0.5, 1.5];
        let image = |x: &[f64]| -> Vec<f64> {
            let of = x.iter().zip(rates);
            of.map(|(x, rate)| rate * x + 1.0).collect()
        };
        let (mut acceleration, mut x) = (Acceleration::new(5, 1e-6), vec![0.0; 3]);
        for _ in 0..4 {
            let image = image(&x);
            let residual = image.iter().zip(&x).map(|(f, x)| f - x).collect();
            let twice = image.iter().map(|f| 2.0 * f).collect();
            let images = [image, twice];
            let [next, twice] = acceleration.next(IterationStep { residual, images });
            x = next;
            for (x, twice) in x.iter().zip(twice) {
                assert!((twice - 2.0 * x).abs() < 1e-12 * (1.0 + twice.abs()));
            }
        }
        for (x, rate) in x.iter().zip(rates) {
            assert!((x - 1.0 / (1.0 - rate)).abs() < 1e-11, "{x} {rate}");
        }
    }

    #[test]
    fn dependent_changes_are_left_out() {
        let mut acceleration = Acceleration::new(5, 1e-6);
        for x in [0.0, 1.0, 3.0] {
            let vector = |value: f64| vec![value, 0.0];
            let next = acceleration.next(IterationStep {
                residual: vector(2.0 - x),
                images: [vector(2.0)],
            });
            assert_eq!(next, [vector(2.0)]);
        }
        assert_eq!(acceleration.changes.len(), 1);
    }
}
