//! The progress bar on a terminal: part of the total time that the run has covered.

use indicatif::{ProgressBar, ProgressStyle};

use super::format::scientific;
use super::screen::closed;
use crate::dynamics::IncrementReport;
use crate::model::Model;

/// Resolution of the bar.
const TICKS: u64 = 10_000;

/// The live line below the table; nothing when the output is not a terminal.
pub(crate) struct Progress {
    bar: Option<ProgressBar>,
    /// Time at the end of the last step.
    end: f64,
}

impl Progress {
    /// A live line, or none.
    pub fn new(model: &Model, live: bool) -> Self {
        let end = (model.steps.iter())
            .map(|step| step.increments.period)
            .sum();
        let bar = live.then(|| {
            let bar = ProgressBar::new(TICKS);
            bar.set_style(style());
            bar
        });
        Progress { bar, end }
    }

    /// Shows an increment.
    pub fn show(&self, report: &IncrementReport) {
        let Some(bar) = &self.bar else { return };
        let part = (report.time / self.end).clamp(0.0, 1.0);
        bar.set_message(format!(
            "time {}  increment {}  contacts {}",
            scientific(report.time, 3),
            report.increment,
            closed(report),
        ));
        bar.set_position((part * TICKS as f64) as u64);
    }

    /// Runs `print` with the line out of the way.
    pub fn suspend(&self, print: impl FnOnce()) {
        match &self.bar {
            Some(bar) => bar.suspend(print),
            None => print(),
        }
    }

    /// Removes the line.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

fn style() -> ProgressStyle {
    let template = "{percent:>3} % [{bar:16}] {msg}  {eta} left";
    ProgressStyle::with_template(template)
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .progress_chars("=> ")
}
