//! Time of an impact: the root of T(tau) - tau, eq. (6.4), by the secant method, safeguarded by bisection.
//! Section 6 of docs/theory.md, Impacts as events, item 3.

use crate::dynamics::increment::Solved;

/// Reduction of the error by a trial from which on the time is bracketed by halving.
const SLOW: f64 = 0.5;

/// Looks for the length of a subincrement that ends at the impact.
pub(crate) struct ImpactTime {
    /// What is left of the increment.
    rest: f64,
    /// The longest subincrement tried that ends before an impact.
    pub before: Option<(f64, Solved)>,
    /// The shortest one that ends after it.
    after: Option<f64>,
    /// The last one, with T(tau) - tau.
    last: Option<(f64, f64)>,
}

impl ImpactTime {
    /// Starts with what is left of the increment.
    pub fn new(rest: f64) -> Self {
        ImpactTime {
            rest,
            before: None,
            after: None,
            last: None,
        }
    }

    /// The length to try next after `tau`, in whose motion the impact is at `met`: by the secant
    /// through the last two, or else at `met`; halfway where these do not help.
    pub fn next(&mut self, tau: f64, met: f64, solved: Solved) -> f64 {
        let f = met - tau;
        if f < 0.0 {
            self.before.take_if(|(before, _)| *before > tau);
            self.after = Some(tau);
        } else {
            self.after.take_if(|after| *after < tau);
            self.before = Some((tau, solved));
        }
        let (low, high) = (
            self.before.as_ref().map_or(0.0, |(tau, _)| *tau),
            self.after.unwrap_or(self.rest),
        );
        let last = self.last.replace((tau, f));
        let is_slow = last.is_some_and(|(_, f_old)| f.abs() > SLOW * f_old.abs());
        if is_slow && self.after.is_some() {
            return low + (high - low) / 2.0;
        }
        let secant = last.map(|(old, f_old)| tau - f * (tau - old) / (f - f_old));
        match secant.filter(|t| *t > low).unwrap_or(met) {
            t if t > low && t < high => t,
            _ if self.after.is_none() => self.rest,
            _ => low + (high - low) / 2.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of trials until the root of met(tau) = tau is found, or none.
    fn trials(met: impl Fn(f64) -> f64, rest: f64, first: f64, root: f64) -> Option<usize> {
        let (mut search, mut tau) = (ImpactTime::new(rest), first);
        (0..60).find(|_| {
            let is_found = (tau - root).abs() < 1e-12;
            tau = search.next(tau, met(tau), Solved::default());
            is_found
        })
    }

    #[test]
    fn the_time_of_an_impact_is_found() {
        assert_eq!(trials(|_| 0.3, 1.0, 1.0, 0.3), Some(1), "free motion");
        let elastic = |tau: f64| 0.3 + 0.2 * (tau - 0.3) + 0.1 * (tau - 0.3) * (tau - 0.3);
        assert!(trials(elastic, 1.0, 0.35, 0.3).unwrap() < 12);
        // the subincrement as a whole seems free, its first part does not
        let jump = |tau: f64| if tau < 0.4 { 1.0 } else { 0.2 };
        assert!(trials(jump, 1.0, 1.0, 0.4).is_some(), "bracketed");
        assert_eq!(trials(|_| 1.0, 1.0, 0.5, 1.0), Some(1), "no impact");
    }

    #[test]
    fn secants_that_hardly_come_nearer_are_followed_by_halving() {
        // a subincrement that ends after the impact at 0.4 tells of one only a little before its end
        let met = |tau: f64| {
            if tau < 0.4 {
                1.0
            } else {
                tau - 0.02 * (1.0 + tau)
            }
        };
        for rest in [1.0, 1e-6, 1e6] {
            let (mut search, mut tau) = (ImpactTime::new(rest), rest);
            for _ in 0..12 {
                tau = search.next(tau, rest * met(tau / rest), Solved::default());
            }
            let before = search.before.map_or(0.0, |(tau, _)| tau / rest);
            assert!(before <= 0.4 && 0.4 - before < 1e-2, "{before}, {rest:e}");
        }
    }
}
