use std::io;
use std::path::PathBuf;

use thiserror::Error;

use super::names::NameError;

/// Why the files of a job could not be created.
#[derive(Debug, Error)]
pub enum OutputError {
    /// A name of the deck cannot stand in the result file.
    #[error(transparent)]
    Name(#[from] NameError),
    /// A file or folder could not be created.
    #[error("cannot create {}: {source}", path.display())]
    Create {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

impl OutputError {
    /// The result of creating `path`.
    pub(super) fn at(path: &std::path::Path) -> impl Fn(io::Error) -> Self + '_ {
        move |source| OutputError::Create {
            path: path.to_owned(),
            source,
        }
    }
}

/// An error of the HDF5 library as an error of input and output.
pub(super) fn io_error(error: hdf5::Error) -> io::Error {
    io::Error::other(format!("result file: {error}"))
}
