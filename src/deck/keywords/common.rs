//! Sentences that rows of the table share.

pub(super) const OTHER_SOLVER: &str = "a number for another solver";
pub(super) const OTHER_NUMBERS: &str = "Its numbers belong to another solver.";
