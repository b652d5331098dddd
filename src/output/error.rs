//! Errors in writing the files of a job, and the system error behind a failure of the HDF5 library.

use std::io;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Reason why the files of a job could not be created.
#[derive(Debug, Error)]
pub enum OutputError {
    /// A name of the deck is not possible in the result file.
    #[error(transparent)]
    Name(#[from] NameError),
    /// Files of an earlier run exist.
    #[error(
        "{} exists already; --overwrite replaces the results of an earlier run",
        list(files)
    )]
    Exists {
        /// The files that exist.
        files: Vec<PathBuf>,
    },
    /// Another run of the job is in progress.
    #[error("{} belongs to a run that is still going on", path.display())]
    Held {
        /// The file that the other run has locked.
        path: PathBuf,
    },
    /// A file or folder could not be created, or something else has the name.
    #[error(transparent)]
    File(#[from] FileError),
    /// A file could not be written; the error names the file.
    #[error("cannot write the results: {0}")]
    Write(#[from] io::Error),
}

/// A file or folder that cannot be used.
#[derive(Debug, Error)]
#[error("cannot {what} {}: {}", path.display(), reason(source))]
pub struct FileError {
    /// Action that failed, such as "read".
    pub what: &'static str,
    /// The file or folder.
    pub path: PathBuf,
    /// Reason that the system gives.
    pub source: io::Error,
}

impl FileError {
    /// Makes the error of an action on `path`.
    pub fn new(what: &'static str, path: &Path) -> impl Fn(io::Error) -> Self {
        move |source| FileError {
            what,
            path: path.to_owned(),
            source,
        }
    }
}

/// A name that is not possible in the result file.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "the {what} name '{name}' cannot stand in the result file: a name there may not be empty, '.', \
     nor hold a '/' or a NUL; rename it in the deck"
)]
pub struct NameError {
    /// Kind of the object with the name, such as "node set".
    pub what: &'static str,
    /// The name in the deck.
    pub name: String,
}

/// Files that a message names.
const LISTED: usize = 4;

fn list(files: &[PathBuf]) -> String {
    let names = files.iter().map(|f| f.display().to_string());
    let mut names: Vec<String> = names.take(LISTED).collect();
    if files.len() > LISTED {
        names.push(format!("{} more", files.len() - LISTED));
    }
    names.join(", ")
}

/// The same error with the file in front of its reason.
pub(super) fn at(path: &Path) -> impl Fn(io::Error) -> io::Error + '_ {
    move |error| {
        let text = format!("{}: {}", path.display(), reason(&error));
        io::Error::new(error.kind(), text)
    }
}

/// Reason of an error, in the same words on all systems for the frequent errors.
pub fn reason(error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::StorageFull => "no space left on device".to_owned(),
        ErrorKind::QuotaExceeded => "the disk quota is used up".to_owned(),
        ErrorKind::FileTooLarge => "larger than files may become here (ulimit -f)".to_owned(),
        _ => error.to_string(),
    }
}

/// An error of the HDF5 library as an input/output error; it is the system error if the library names one.
pub(super) fn io_error(error: hdf5::Error) -> io::Error {
    let stack = error.stack();
    let frames = stack.iter().flat_map(|stack| stack.iter());
    let number = frames.filter_map(|frame| errno(frame.desc())).next();
    number.map_or_else(
        || io::Error::other(format!("the HDF5 library fails: {error}")),
        io::Error::from_raw_os_error,
    )
}

/// The number behind `errno = ` in a message of the HDF5 library.
fn errno(text: &str) -> Option<i32> {
    let (_, rest) = text.split_once("errno = ")?;
    let end = rest.find(|c: char| !c.is_ascii_digit());
    rest.get(..end.unwrap_or(rest.len()))?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_the_system_is_found_in_a_message() {
        let text = "file write failed: file descriptor = 3, errno = 28, error message = 'No space'";
        assert_eq!(errno(text), Some(28));
        assert_eq!(errno("errno = "), None);
        assert_eq!(errno("unable to flush file"), None);
    }
}
