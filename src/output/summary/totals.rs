//! Closing lines of a run: time by phases, and counts of the complementarity problems.

use crate::dynamics::{Outcome, RunSummary, SolverCounts};
use crate::output::file::phases;
use crate::output::text::{counted, general, wrap};

/// Time of the run and the parts of its phases; `output` and `total` are wall-clock times in
/// seconds.
pub(crate) fn timing_lines(summary: &RunSummary, output: f64, total: f64) -> Vec<String> {
    let part = |name: &str, seconds: f64| {
        let percent = 100.0 * seconds / total.max(f64::MIN_POSITIVE);
        format!("{name} {percent:.0} %")
    };
    let mut pieces = vec![format!(
        "in {} s: {}, {}",
        general(total, 3),
        counted(summary.increments, "increment"),
        counted(summary.cutbacks, "cutback")
    )];
    if summary.events > 0 {
        pieces.push(format!("{} cut at impacts", summary.events));
    }
    let phases = phases(&summary.timings);
    pieces.extend(phases.iter().map(|&(name, seconds)| part(name, seconds)));
    pieces.push(part("output", output));
    let done = match summary.outcome {
        Outcome::Finished => "done",
        Outcome::Stopped(_) | Outcome::Interrupted => "stopped",
    };
    wrap(done, &pieces)
}

/// Work of the complementarity problems by method; empty without any.
pub(crate) fn lcp_lines(solver: &SolverCounts) -> Vec<String> {
    if solver.lcps == 0 {
        return Vec::new();
    }
    let problems = counted(solver.lcps, "problem");
    let pieces = [
        format!("{problems}, at most {}", counted(solver.lcp_size, "pair")),
        counted(solver.active_set_iterations, "active-set iteration"),
        counted(solver.gauss_seidel_sweeps, "sweep"),
        counted(solver.lemke_calls, "Lemke solve"),
    ];
    wrap("LCP", &pieces)
}
