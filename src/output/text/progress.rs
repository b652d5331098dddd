//! The progress bar on a terminal: part of the nominal increments that the run has covered.

use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

use super::format::scientific;
use super::screen::closed;
use crate::dynamics::IncrementReport;
use crate::model::Model;

/// Resolution of the bar.
const TICKS: u64 = 10_000;

/// Part of a run from which on the time that is left is told: before, it is a guess.
const TOLD: f64 = 0.01;

/// The live line below the table; nothing when the output is not a terminal.
pub(crate) struct Progress {
    bar: Option<ProgressBar>,
    course: Course,
}

/// The nominal increments of a run and when it began.
struct Course {
    /// Period and nominal increments of every step.
    steps: Vec<(f64, f64)>,
    started: Instant,
}

impl Progress {
    /// A live line, or none.
    pub fn new(model: &Model, live: bool) -> Self {
        let steps = model.steps.iter().map(|step| step.increments);
        let course = Course {
            steps: steps
                .map(|i| (i.period, (i.period / i.dt).ceil()))
                .collect(),
            started: Instant::now(),
        };
        let bar = live.then(|| {
            let bar = ProgressBar::new(TICKS);
            bar.set_style(style());
            bar
        });
        Progress { bar, course }
    }

    /// Shows an increment.
    pub fn show(&self, report: &IncrementReport) {
        let Some(bar) = &self.bar else { return };
        let course = &self.course;
        let part = course.part(report.step, report.step_time);
        bar.set_message(course.text(report, part, course.started.elapsed()));
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

impl Course {
    /// Part of the nominal increments that are done at a time of a step, counted from 1.
    fn part(&self, step: usize, step_time: f64) -> f64 {
        let before = self.steps.iter().take(step.saturating_sub(1));
        let mut done: f64 = before.map(|(_, count)| count).sum();
        if let Some((period, count)) = self.steps.get(step.wrapping_sub(1)) {
            done += step_time / period * count;
        }
        let all: f64 = self.steps.iter().map(|(_, count)| count).sum();
        (done / all).clamp(0.0, 1.0)
    }

    /// Step, increment, time, contacts and, after a while, the time that is left.
    fn text(&self, report: &IncrementReport, part: f64, elapsed: Duration) -> String {
        let mut text = format!(
            "step {}/{}  incr {}  time {}  active {}",
            report.step,
            self.steps.len(),
            report.increment,
            scientific(report.time, 3),
            closed(report),
        );
        let left = elapsed.as_secs_f64() * (1.0 / part - 1.0);
        if let (true, Ok(left)) = (part >= TOLD, Duration::try_from_secs_f64(left)) {
            text.push_str(&format!("  {:#} left", HumanDuration(left)));
        }
        text
    }
}

/// A bar that is full at the end only: what is not done is dots.
fn style() -> ProgressStyle {
    ProgressStyle::with_template("{percent:>3} % [{bar:12}] {msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .progress_chars("=.")
}

#[cfg(test)]
mod tests {
    use std::io;
    use std::sync::{Arc, Mutex};

    use indicatif::{ProgressDrawTarget, TermLike};

    use super::*;

    /// The line of a run of two steps, 100 and 300 increments, at a time of a step.
    fn line(step: usize, step_time: f64, seconds: u64) -> (String, f64) {
        let course = Course {
            steps: vec![(1.0, 100.0), (0.5, 300.0)],
            started: Instant::now(),
        };
        let report = IncrementReport {
            increment: 12_345,
            step,
            step_time,
            ..IncrementReport::default()
        };
        let part = course.part(step, step_time);
        (
            course.text(&report, part, Duration::from_secs(seconds)),
            part,
        )
    }

    #[test]
    fn the_line_tells_the_step_and_what_is_left() {
        let (text, part) = line(1, 0.0, 5);
        assert_eq!((part, text.contains("left")), (0.0, false), "{text}");
        let (text, part) = line(1, 1.0, 60);
        assert_eq!(part, 0.25);
        assert!(
            text.starts_with("step 1/2  incr 12345  time ") && text.ends_with("  3m left"),
            "{text}"
        );
        let (text, part) = line(2, 0.5, 60);
        assert_eq!(part, 1.0);
        assert!(text.ends_with("  0s left"), "{text}");
        assert!("100 % [............] ".len() + text.len() < 80, "{text}");
    }

    /// A terminal that keeps the last line drawn.
    #[derive(Debug, Clone, Default)]
    struct Screen(Arc<Mutex<String>>);

    impl TermLike for Screen {
        fn width(&self) -> u16 {
            80
        }
        fn move_cursor_up(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_down(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_right(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_left(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn write_line(&self, _: &str) -> io::Result<()> {
            Ok(())
        }
        fn write_str(&self, text: &str) -> io::Result<()> {
            if text.contains('[') {
                text.clone_into(&mut self.0.lock().expect("one thread"));
            }
            Ok(())
        }
        fn clear_line(&self) -> io::Result<()> {
            Ok(())
        }
        fn flush(&self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn the_bar_is_full_at_the_end_only() {
        for (part, is_full) in [(0.0, false), (0.94, false), (0.999, false), (1.0, true)] {
            let screen = Screen::default();
            let target = ProgressDrawTarget::term_like(Box::new(screen.clone()));
            let bar = ProgressBar::with_draw_target(Some(TICKS), target).with_style(style());
            bar.set_position((part * TICKS as f64) as u64);
            bar.abandon();
            let line = screen.0.lock().expect("one thread").clone();
            assert_eq!(line.contains("============"), is_full, "{part}: {line}");
            assert_eq!(line.contains(".]"), !is_full, "{part}: {line}");
        }
    }
}
