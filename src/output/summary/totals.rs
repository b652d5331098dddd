//! Closing lines of a run: time by phases, largest errors, counts of the complementarity problems.

use crate::dynamics::{ContactViolation, Outcome, RunSummary, SolverCounts};
use crate::output::file::phases;
use crate::output::memory::peak_memory;
use crate::output::text::{bytes, counted, general, scientific, wrap};

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
    pieces.extend(peak_memory().map(|peak| format!("memory {}", bytes(peak))));
    let done = match summary.outcome {
        Outcome::Finished => "done",
        Outcome::Stopped(_) | Outcome::Interrupted => "stopped",
    };
    wrap(done, &pieces)
}

/// Penetration, in lengths of an edge, that is shown: less is round-off of positions.
const SHOWN_PENETRATION: f64 = 1e-9;

/// The largest errors of the increments: relative force residual and, with contacts, how far their pairs
/// are from the contact law.
pub(crate) fn error_line(residual: f64, violation: Option<ContactViolation>) -> String {
    let mut line = format!("error    residual {}", scientific(residual, 1));
    if let Some(violation) = violation {
        let ContactViolation {
            overlap,
            gap,
            slip,
            penetration,
        } = violation;
        let deepest = scientific(penetration, 1);
        let [overlap, gap, slip] = [overlap, gap, slip].map(|part| scientific(part, 0));
        line.push_str(&format!(
            "; overlap {overlap}, gap {gap}, slip {slip} of a segment"
        ));
        if penetration > SHOWN_PENETRATION {
            line.push_str(&format!("; edges cross by {deepest} of an edge"));
        }
    }
    line
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_contact_are_shown_where_there_is_any() {
        assert_eq!(error_line(8.1e-12, None), "error    residual 8.1e-12");
        let violation = ContactViolation {
            overlap: 0.0,
            gap: 3e-13,
            slip: f64::NAN,
            penetration: 1e-10,
        };
        let line = error_line(8.1e-12, Some(violation));
        let expected = "error    residual 8.1e-12; overlap 0e+00, gap 3e-13, slip nan of a segment";
        assert_eq!(line, expected);
        let penetration = 3.71e-5;
        let crossed = ContactViolation {
            penetration,
            ..violation
        };
        let line = error_line(8.1e-12, Some(crossed));
        assert_eq!(
            line,
            format!("{expected}; edges cross by 3.7e-05 of an edge")
        );
    }
}
