//! The table of increments on the screen, 80 columns wide.

use super::format::{scientific, signed};
use crate::dynamics::IncrementReport;
use crate::model::Model;

/// Lines after which the header is repeated.
const HEADER_EVERY: usize = 40;

/// Upper bound of the number of lines a run without cutbacks prints.
const MOST_LINES: f64 = 50.0;

const HEADER: &str =
    "step   incr      time       dt pass active stick residual  LCP pivots energy err";

/// Chooses the lines of the table.
#[derive(Debug, Clone)]
pub(crate) struct Table {
    /// Increment of each step (time).
    increments: Vec<f64>,
    /// Nominal increments from one line to the next.
    stride: f64,
    /// Increments since the last line; a subincrement counts by its length.
    since: f64,
    /// Lines so far.
    lines: usize,
}

impl Table {
    /// A table with 20 to 50 lines for the nominal increments of the model's steps.
    pub fn new(model: &Model) -> Self {
        let increments = model.steps.iter().map(|step| step.increments);
        Table {
            stride: stride(increments.clone().map(|i| (i.period / i.dt).ceil()).sum()) as f64,
            increments: increments.map(|i| i.dt).collect(),
            since: 0.0,
            lines: 0,
        }
    }

    /// Whether the increment has a line.
    pub fn shows(&mut self, report: &IncrementReport) -> bool {
        let whole = self.increments.get(report.step.wrapping_sub(1));
        self.since += whole.map_or(1.0, |dt| report.dt / dt);
        let due = self.since >= self.stride - 0.5 || report.ends_step;
        if due {
            self.since = 0.0;
        }
        due && report.increment > 0
    }

    /// The header, when one is due before the next line.
    pub fn header(&mut self) -> Option<&'static str> {
        let due = self.lines.is_multiple_of(HEADER_EVERY);
        self.lines += 1;
        due.then_some(HEADER)
    }
}

/// The line of an increment; `error` is the relative energy balance.
pub(crate) fn row(report: &IncrementReport, error: f64) -> String {
    let solver = &report.solver;
    format!(
        "{:>4}{:>7}{:>10}{:>9}{:>5}{:>7}{:>6}{:>9}{:>5}{:>7}{:>11}",
        report.step,
        report.increment,
        scientific(report.time, 3),
        scientific(report.dt, 2),
        solver.passes,
        closed(report),
        sticking(report),
        scientific(solver.residual, 1),
        solver.lcp_size,
        solver.pivots,
        signed(error, 1),
    )
}

/// Pairs in contact, over all contacts.
pub(crate) fn closed(report: &IncrementReport) -> usize {
    report.contacts.iter().map(|contact| contact.closed).sum()
}

/// Pairs that stick, over all contacts.
pub(crate) fn sticking(report: &IncrementReport) -> usize {
    report.contacts.iter().map(|contact| contact.sticking).sum()
}

/// The smallest of 1, 2, 5, 10, 20, ... that gives no more lines than allowed.
fn stride(increments: f64) -> usize {
    let mut power = 1usize;
    while increments.is_finite() && power < usize::MAX / 100 {
        for stride in [power, 2 * power, 5 * power] {
            if increments / stride as f64 <= MOST_LINES {
                return stride;
            }
        }
        power *= 10;
    }
    1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twenty_to_fifty_lines() {
        assert_eq!(stride(10.0), 1);
        assert_eq!(stride(1000.0), 20);
        assert_eq!(stride(13333.0), 500);
        assert_eq!(stride(f64::NAN), 1);
        for increments in 50..20_000 {
            let lines = increments / stride(f64::from(increments)) as i32;
            assert!((20..=50).contains(&lines), "{increments}: {lines}");
        }
    }

    #[test]
    fn cut_back_increments_count_by_their_length() {
        let mut table = Table {
            increments: vec![0.1],
            stride: 2.0,
            since: 0.0,
            lines: 0,
        };
        let mut shows = |increment, dt, ends_step| {
            table.shows(&IncrementReport {
                increment,
                step: 1,
                dt,
                ends_step,
                ..IncrementReport::default()
            })
        };
        assert!(!shows(0, 0.0, false));
        assert!(!shows(1, 0.1, false));
        assert!(shows(2, 0.1, false));
        let shown = (3..19).filter(|&k| shows(k, 0.0125, false)).count();
        assert_eq!(shown, 1);
        assert!(shows(19, 0.1, true));
    }

    #[test]
    fn lines_are_as_wide_as_the_header() {
        let report = IncrementReport {
            increment: 13_333,
            step: 1,
            ..IncrementReport::default()
        };
        assert_eq!(row(&report, -1e-12).len(), HEADER.len());
        assert_eq!(HEADER.len(), 80);
    }
}
