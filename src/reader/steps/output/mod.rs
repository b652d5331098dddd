//! Output requests: times of frames, histories of sets, dofs in the status file.

mod histories;
mod monitor;
mod requests;
mod time_points;

pub(crate) use histories::Histories;
pub(super) use requests::{Requests, restart};
