//! Impacts as events that end a part of an increment.

mod impact_events;
mod impact_time;

pub(crate) use impact_events::{FailedSubincrement, Subincrement, Subincrements};
