//! Result file, status file, log and screen.
//!
//! [`ResultWriter`] observes a run and writes the files of a job ([`JobFiles`]), which only one run at a time can claim
//! ([`Claim`]): `JOB.vtkhdf` (`result_file`: `fields`, `model_group`, `history`, `run_record`, `space`), `JOB.sta`
//! (`status`), `JOB.log` and the screen (`console`). `docs/output.md` describes them. [`picture`] draws a model for
//! `check`.

mod balance;
mod canvas;
mod checks;
mod column;
mod console;
mod draft;
mod echo;
mod error;
mod failure;
mod fields;
mod format;
mod frames;
mod history;
mod job;
mod local;
mod memory;
mod model_data;
mod model_group;
mod monitor;
mod picture;
mod restart;
mod result_file;
mod result_summary;
mod run_record;
mod space;
mod status;
mod strain;
mod warnings;
mod writer;

pub use canvas::Window;
pub use console::Verbosity;
pub use draft::{Existing, write_whole};
pub use echo::{ModelEcho, deck_line, frames, program_lines, solver};
pub use error::{FileError, NameError, OutputError, reason};
pub use format::scientific;
pub use frames::{DEFAULT_FRAMES, FrameSchedule};
pub use job::{Claim, Earlier, JobFiles, is_checkpoint};
pub use memory::{MemoryError, check_memory, memory_need};
pub use model_group::{check_names, contact_names};
pub use picture::picture;
pub use restart::{Checkpoint, CheckpointError, RestartOrigin};
pub use result_summary::{ResultSummary, SummaryError};
pub use run_record::{RunRecord, UNFINISHED, new_run_id};
pub use writer::{Checkpoints, Interrupt, ResultWriter};
