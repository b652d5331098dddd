//! Acceleration of slowly converging passes from the changes of the last passes (Anderson 1965).
//! See docs/theory/time.md, Acceleration.

use super::equal_forces::ROUND_OFF;
use crate::dynamics::step::Parts;
use crate::lcp::{Acceleration, IterationStep};

/// Ratio of successive corrections above which passes are slow.
const SLOW: f64 = 0.1;
/// Ratio of successive corrections above which the last passes do not help to predict the next pass.
const JUMP: f64 = 2.0;
/// Number of changes from pass to pass that are remembered.
const MEMORY: usize = 5;
/// Size of the new part of a change of the correction, relative to the part along the earlier changes, below which the
/// new part is round-off.
const DEPENDENT: f64 = 1e-6;

/// Decrease of the corrections of the passes.
#[derive(Debug, Clone, Copy)]
pub(super) struct CorrectionProgress {
    /// Largest correction relative to the increment.
    pub correction: f64,
    /// Largest correction relative to the largest correction of the last pass.
    pub rate: f64,
    /// Correction at which the passes end.
    pub tolerance: f64,
    /// Whether the pass and the pass before it may have closed the same pairs.
    pub same_pairs: bool,
}

/// Acceleration from the last passes with the same closed pairs.
#[derive(Debug)]
pub(super) struct PassAcceleration(Acceleration<1>);

impl PassAcceleration {
    /// The acceleration before the first pass, when no steps are remembered.
    pub fn new() -> Self {
        PassAcceleration(Acceleration::new(MEMORY, DEPENDENT))
    }

    /// Replaces the correction dU of a pass from the iterate d if passes are slow, eq. (4.15). The pass leads to f(d) =
    /// d + dU, and the part of dU in every body is measured relative to the increment of the body.
    pub fn improve(
        &mut self,
        parts: &Parts,
        d: &[f64],
        progress: CorrectionProgress,
        du: &mut [f64],
    ) {
        let CorrectionProgress {
            correction,
            rate,
            tolerance,
            same_pairs,
        } = progress;
        if !same_pairs || rate.is_nan() || rate > JUMP {
            self.0.clear();
        }
        if rate > SLOW && correction > ROUND_OFF * tolerance {
            let [next] = self.0.next(IterationStep {
                residual: parts.beside_increments(d, du),
                images: [d.iter().zip(&*du).map(|(d, du)| d + du).collect()],
            });
            (du.iter_mut().zip(next.iter().zip(d))).for_each(|(du, (next, d))| *du = next - d);
        }
    }
}
