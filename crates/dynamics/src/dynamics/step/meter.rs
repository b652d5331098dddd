//! Wall-clock times of the phases and counters of the solvers.

use std::time::{Duration, Instant};

use crate::dynamics::results::{ContactViolation, SolverCounts, Timings};
use crate::lcp::Counters;
use crate::linear::larger;

/// Time and work of each phase.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Meter {
    pub timings: Timings,
    pub counts: SolverCounts,
}

impl Meter {
    /// Runs `work` and adds its time to a phase.
    pub fn time<T>(
        &mut self,
        phase: fn(&mut Timings) -> &mut Duration,
        work: impl FnOnce() -> T,
    ) -> T {
        let started = Instant::now();
        let result = work();
        *phase(&mut self.timings) += started.elapsed();
        result
    }

    /// Counts a pass with its residual.
    pub fn count_pass(&mut self, residual: f64) {
        self.counts.passes += 1;
        self.counts.residual = residual;
    }

    /// Counts a complementarity problem of `size` pairs with its work.
    pub fn count_lcp(&mut self, size: usize, work: Counters) {
        let counts = &mut self.counts;
        counts.lcps += 1;
        counts.lcp_size = counts.lcp_size.max(size);
        counts.pivots += work.pivots;
        counts.active_set_iterations += work.active_set_iterations;
        counts.gauss_seidel_sweeps += work.gauss_seidel_sweeps;
        counts.lemke_calls += work.lemke_calls;
    }
}

impl Timings {
    /// Adds the times of a step to the times of a run.
    pub(crate) fn add(&mut self, other: &Timings) {
        self.assembly += other.assembly;
        self.factorization += other.factorization;
        self.solve += other.solve;
        self.search += other.search;
        self.contact += other.contact;
        self.lcp += other.lcp;
    }
}

impl SolverCounts {
    /// Counts at the start of a run: no work, and convergence.
    pub(crate) fn at_start() -> Self {
        SolverCounts {
            converged: true,
            ..SolverCounts::default()
        }
    }

    /// Adds the counts of one increment to the totals of a run.
    pub(crate) fn add(&mut self, other: &SolverCounts) {
        self.passes += other.passes;
        self.lcps += other.lcps;
        self.lcp_size = self.lcp_size.max(other.lcp_size);
        self.pivots += other.pivots;
        self.active_set_iterations += other.active_set_iterations;
        self.gauss_seidel_sweeps += other.gauss_seidel_sweeps;
        self.lemke_calls += other.lemke_calls;
        self.factorizations += other.factorizations;
        self.residual = larger(self.residual, other.residual);
        self.violation = self.violation.larger(other.violation);
        self.held = larger(self.held, other.held);
        self.converged = self.converged && other.converged;
    }
}

impl ContactViolation {
    /// The larger value of two violations, for each kind.
    pub(crate) fn larger(self, other: Self) -> Self {
        ContactViolation {
            overlap: larger(self.overlap, other.overlap),
            gap: larger(self.gap, other.gap),
            slip: larger(self.slip, other.slip),
            penetration: larger(self.penetration, other.penetration),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn totals_are_sums_but_for_the_largest_problem_and_the_largest_errors() {
        let increment = |k: usize| SolverCounts {
            passes: 2 * k,
            lcps: 3 * k,
            lcp_size: 4 * k,
            pivots: 5 * k,
            active_set_iterations: 6 * k,
            gauss_seidel_sweeps: 7 * k,
            lemke_calls: 8 * k,
            factorizations: 9 * k,
            residual: k as f64,
            violation: ContactViolation {
                overlap: 10.0 / k as f64,
                gap: 11.0 * k as f64,
                slip: 12.0 * k as f64,
                penetration: 13.0 * k as f64,
            },
            held: 14.0 * k as f64,
            converged: true,
        };
        let mut totals = SolverCounts {
            converged: true,
            ..SolverCounts::default()
        };
        for k in [2, 5, 3] {
            totals.add(&increment(k));
        }
        let expected = SolverCounts {
            lcp_size: 4 * 5,
            residual: 5.0,
            violation: ContactViolation {
                overlap: 5.0,
                ..increment(5).violation
            },
            held: increment(5).held,
            ..increment(2 + 5 + 3)
        };
        assert_eq!(totals, expected);
        totals.add(&SolverCounts::default());
        assert!(!totals.converged, "one that has not converged");
    }
}
