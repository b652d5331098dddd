//! Result file, status file, log and screen.
//!
//! [`ResultWriter`] observes a run and writes the files of a job ([`JobFiles`]), which are claimed by
//! one run at a time ([`Claim`]): `JOB.vtkhdf` (`result_file`: `grid`, `model`, `history`,
//! `record`, `space`), `JOB.sta` (`status`), `JOB.log` (`log`) and the screen (`screen`,
//! `progress`). `docs/output.md` describes them. [`picture`] draws a model that is not run.

mod error;
mod file;
mod frame;
mod frames;
mod history;
mod interrupt;
mod job;
mod memory;
mod pace;
mod picture;
mod result_file;
mod summary;
mod text;
mod writer;

pub use error::{NameError, OutputError, reason};
pub use file::{Claim, RunRecord, UNFINISHED, check_names, contact_names, regular_file};
pub use frames::{DEFAULT_FRAMES, FrameSchedule};
pub use interrupt::Interrupt;
pub use job::JobFiles;
pub use memory::{MemoryError, check_memory, memory_need};
pub use picture::{Window, picture};
pub use summary::{ResultSummary, SummaryError, deck_line, program_lines};
pub use text::{ModelEcho, Verbosity, frames, solver};
pub use writer::ResultWriter;
