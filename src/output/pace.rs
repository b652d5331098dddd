//! When to write what has gathered in memory.

use std::time::{Duration, Instant};

/// Longest time for which results wait in memory while a run goes on.
const LONGEST: Duration = Duration::from_secs(1);

/// Pause between two writes, as a multiple of the time that one takes: writing takes at most about
/// this part of the run's time.
const MULTIPLE: u32 = 25;

/// Decides when to write: after a pause that is long against the time a write takes. Increments that
/// take long find it over and are written at once.
pub(super) struct Pace {
    /// End of the last write.
    last: Option<Instant>,
    pause: Duration,
}

impl Pace {
    /// The first write is due at once.
    pub fn new() -> Self {
        Pace {
            last: None,
            pause: Duration::ZERO,
        }
    }

    /// Whether the pause is over.
    pub fn is_due(&self) -> bool {
        self.last.is_none_or(|last| last.elapsed() >= self.pause)
    }

    /// Notes a write that began at `start` and has just ended.
    pub fn written(&mut self, start: Instant) {
        let end = Instant::now();
        self.pause = (MULTIPLE * (end - start)).min(LONGEST);
        self.last = Some(end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pause_grows_with_the_time_of_a_write_up_to_a_limit() {
        let mut pace = Pace::new();
        assert!(pace.is_due(), "the first");
        let before = |time| Instant::now().checked_sub(Duration::from_millis(time));
        pace.written(before(5).expect("some time ago"));
        assert!(!pace.is_due() && pace.pause >= 5 * MULTIPLE * Duration::from_millis(1));
        pace.written(before(2000).expect("some time ago"));
        assert_eq!(pace.pause, LONGEST);
        pace.last = before(1001);
        assert!(pace.is_due());
    }
}
