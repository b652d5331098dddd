//! Text for people: log, status file, screen, numbers.

mod advice;
mod console;
mod echo;
mod failure;
mod format;
mod layout;
mod log;
mod progress;
mod screen;
mod status;
mod strain;

pub(crate) use console::Console;
pub use console::Verbosity;
pub use echo::{ModelEcho, frames, solver};
pub(crate) use echo::{element_mass, wave_speed};
pub(crate) use failure::failure_lines;
pub(crate) use format::{bytes, counted, general, scientific};
pub(crate) use layout::{label, wrap, wrap_words};
pub(crate) use log::{Log, cutback_advice, cutback_lines};
pub(crate) use status::StatusFile;
pub(crate) use strain::{LARGE, SmallStrainElements, StrainWatch, warning_lines};
