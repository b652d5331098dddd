//! Time of an impact: the length tau of a subincrement at whose end the gap of an inactive pair is zero, eq. (6.4); the
//! length is bracketed and interpolated. See docs/theory/impacts.md, Impacts as events, item 3.

use crate::contact::{Constraint, ConstraintKey};

/// A converged subincrement from the common start of all trials.
#[derive(Clone)]
pub(crate) struct EventTrial {
    /// Length tau of the trial.
    length: f64,
    /// Displacements at the end of the trial.
    pub u: Vec<f64>,
    /// Mean gaps (surface to surface) at the end of the trial, with increasing keys, and the lengths to which they are
    /// relative.
    means: Vec<(ConstraintKey, [f64; 2])>,
}

impl EventTrial {
    /// Trial of the given length; `u` and `constraints` are the displacements and constraints at
    /// its end.
    pub fn new(length: f64, u: &[f64], constraints: &[Constraint]) -> Self {
        let means = constraints.iter().filter(|c| c.is_mean());
        let mut means: Vec<_> = means.map(|c| (c.key, [c.gap, c.scale])).collect();
        means.sort_unstable_by_key(|(key, _)| *key);
        EventTrial {
            length,
            u: u.to_vec(),
            means,
        }
    }

    /// The mean gap of a constraint and the length to which this gap is relative; NaN if the trial does not have this
    /// mean gap.
    pub fn mean(&self, key: ConstraintKey) -> [f64; 2] {
        let place = self.means.binary_search_by_key(&key, |(key, _)| *key);
        place.map_or([f64::NAN; 2], |place| self.means[place].1)
    }
}

/// Search for the length of a subincrement that ends at the first impact.
pub(crate) struct ImpactSearch {
    /// The longest trial that ends before an impact; at first the start.
    before: EventTrial,
    /// The shortest trial that ends after an impact.
    after: Option<EventTrial>,
    /// The trial before or after an impact that the last trial has replaced.
    old: Option<EventTrial>,
    /// The last two changes of the trial length.
    steps: [f64; 2],
}

impl ImpactSearch {
    /// A search whose first trial is the start of the subincrement, with length zero.
    pub fn new(start: EventTrial) -> Self {
        ImpactSearch {
            before: start,
            after: None,
            old: None,
            steps: [f64::INFINITY; 2],
        }
    }

    /// Records a trial, which ends before or after an impact.
    pub fn record(&mut self, trial: EventTrial, is_before: bool) {
        self.old = match is_before {
            true => Some(std::mem::replace(&mut self.before, trial)),
            false => self.after.replace(trial),
        };
    }

    /// Length at which the gap of a pair is zero: by inverse quadratic interpolation of three trials, else by linear
    /// interpolation of two. `None` if the gap has no change of sign.
    pub fn root(&self, gap: impl Fn(&EventTrial) -> f64) -> Option<f64> {
        let (low, high) = (&self.before, self.after.as_ref()?);
        let (g, h) = (gap(low), gap(high));
        if !(g >= 0.0 && h < 0.0) {
            return None;
        }
        let linear = low.length + (high.length - low.length) * (g / (g - h));
        let is_inside = |t: &f64| *t > low.length && *t < high.length;
        let quadratic = self.old.as_ref().map(|old| {
            let points = [(low.length, g), (high.length, h), (old.length, gap(old))];
            let term = |i: usize| {
                let [(t, g), (_, p), (_, q)] = [0, 1, 2].map(|k| points[(i + k) % 3]);
                t * (p / (g - p)) * (q / (g - q))
            };
            term(0) + term(1) + term(2)
        });
        Some(quadratic.filter(is_inside).unwrap_or(linear))
    }

    /// The length to try after the last length `tau`: the expected length `root` of the impact. If `root` is not
    /// between the trials before and after the impact, or the steps hardly decrease, the result is halfway between
    /// these trials.
    pub fn next(&mut self, tau: f64, root: Option<f64>) -> f64 {
        let (low, high) = (
            self.before.length,
            self.after.as_ref().map_or(tau, |t| t.length),
        );
        let middle = low + (high - low) / 2.0;
        let is_fast = |t: &f64| (t - tau).abs() < self.steps[0] / 2.0;
        let root = root.filter(|t| *t > low && *t < high);
        let next = root.filter(is_fast).unwrap_or(middle);
        self.steps = [self.steps[1], (next - tau).abs()];
        next
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of trials until the root of a gap is found to 1e-10; the first trial has the length 1.
    fn trials(gap: impl Fn(f64) -> f64, root: f64) -> Option<usize> {
        let trial = |tau: f64| EventTrial::new(tau, &[gap(tau)], &[]);
        let (mut search, mut tau) = (ImpactSearch::new(trial(0.0)), 1.0);
        (1..40).find(|_| {
            search.record(trial(tau), gap(tau) >= 0.0);
            let expected = search.root(|trial| trial.u[0]);
            let is_found = (tau - root).abs() < 1e-10;
            tau = search.next(tau, expected);
            is_found
        })
    }

    #[test]
    fn the_time_of_an_impact_is_found() {
        assert_eq!(trials(|t| 0.3 - t, 0.3), Some(2), "free motion");
        let falls = |t: f64| 0.3 - 0.5 * t - t * t / 2.0;
        let found = trials(falls, (0.25_f64 + 0.6).sqrt() - 0.5);
        assert!(found.unwrap() <= 6, "{found:?}");
        // the surface swings, so the gap is a curved function of the length
        let swings = |t: f64| 0.02 - 0.5 * t - 0.05 * (20.0 * t).sin();
        let root = (0..60).fold([0.0, 0.05], |[low, high], _| {
            let middle = (low + high) / 2.0;
            if swings(middle) > 0.0 {
                [middle, high]
            } else {
                [low, middle]
            }
        });
        let found = trials(swings, root[0]);
        assert!(found.unwrap() <= 9, "{found:?}");
    }

    #[test]
    fn a_gap_that_jumps_is_bracketed() {
        let (mut search, mut tau) = (ImpactSearch::new(EventTrial::new(0.0, &[1.0], &[])), 1.0);
        for _ in 0..12 {
            let gap = if tau < 0.4 { 1.0 } else { -1e-6 };
            search.record(EventTrial::new(tau, &[gap], &[]), gap > 0.0);
            let root = search.root(|trial| trial.u[0]);
            tau = search.next(tau, root);
        }
        let (low, high) = (search.before.length, search.after.expect("after").length);
        assert!(low < 0.4 && high >= 0.4 && high - low < 0.2, "{low} {high}");
    }
}
