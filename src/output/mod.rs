//! Result file, status file, log and screen.
//!
//! [`ResultWriter`] observes a run and writes the files of a job ([`JobFiles`]): `JOB.vtkhdf`
//! (`result_file`: `vtkhdf`, `model`, `history`, `record`), `JOB.sta` (`status`), `JOB.log` (`log`)
//! and the screen (`screen`, `progress`). `docs/output.md` describes them.

mod balance;
mod body_history;
mod body_times;
mod clock;
mod console;
mod contact_history;
mod dataset;
mod echo;
mod error;
mod failure;
mod format;
mod frames;
mod header;
mod history;
mod job;
mod log;
mod model;
mod names;
mod node_history;
mod progress;
mod record;
mod result_file;
mod rigid_history;
mod screen;
mod series;
mod status;
mod strain;
mod summary;
mod vtkhdf;
mod warnings;
mod writer;

pub use console::Verbosity;
pub use echo::{ModelEcho, frames, solver};
pub use error::OutputError;
pub use frames::{DEFAULT_FRAMES, FrameSchedule};
pub use header::{deck_line, program_lines};
pub use job::JobFiles;
pub use names::{NameError, check_names, contact_names};
pub use record::{RunRecord, UNFINISHED};
pub use summary::{ResultSummary, SummaryError};
pub use writer::ResultWriter;
