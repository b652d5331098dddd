//! When to write what has gathered in memory.

use std::time::{Duration, Instant};

/// Longest time for which results wait in memory while a run goes on.
const LONGEST: Duration = Duration::from_secs(1);

/// Time of a run as a multiple of that which its writes may take.
const MULTIPLE: u32 = 30;

/// Decides when to write: when all writes so far and another like the last one are short against the time of the run.
/// Increments that take long are written at once.
pub(super) struct Pace {
    start: Instant,
    /// End of the last write.
    last: Option<Instant>,
    /// Time of the run from which on the next write is due.
    due: Duration,
    /// Time that all writes have taken.
    spent: Duration,
}

impl Pace {
    /// The first write is due at once.
    pub fn new() -> Self {
        Pace {
            start: Instant::now(),
            last: None,
            due: Duration::ZERO,
            spent: Duration::ZERO,
        }
    }

    /// Whether a write is due.
    pub fn is_due(&self) -> bool {
        self.start.elapsed() >= self.due
    }

    /// Whether the last write was some time ago.
    pub fn is_late(&self) -> bool {
        self.last.is_some_and(|last| last.elapsed() >= LONGEST)
    }

    /// Notes a write that began at `start` and has just ended.
    pub fn written(&mut self, start: Instant) {
        let end = Instant::now();
        let write = end - start;
        self.spent += write;
        self.due = MULTIPLE * (self.spent + write);
        self.last = Some(end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn before(milliseconds: u64) -> Instant {
        let time = Instant::now().checked_sub(Duration::from_millis(milliseconds));
        time.expect("some time ago")
    }

    #[test]
    fn writes_are_short_against_the_run_but_none_waits_for_long() {
        let mut pace = Pace::new();
        assert!(pace.is_due(), "the first");
        pace.written(before(5));
        assert!(!pace.is_due());
        pace.start = before(5 * 2 * u64::from(MULTIPLE) - 100);
        assert!(!pace.is_due(), "a second like the first");
        pace.start = before(5 * 2 * u64::from(MULTIPLE) + 100);
        assert!(pace.is_due(), "long enough a run for two");
        pace.written(before(2000));
        assert!(!pace.is_due());
        assert!(!pace.is_late());
        pace.last = Some(before(1001));
        assert!(pace.is_late(), "a second");
    }
}
