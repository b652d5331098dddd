//! The check that a file to be read is a regular file.

use std::path::Path;
use std::{fs, io};

/// Metadata of a regular, readable file. Other files are not opened: a fifo would wait for its
/// writer.
///
/// # Errors
/// The file does not exist, may not be read, or is not a regular file.
pub fn regular_file(path: &Path) -> io::Result<fs::Metadata> {
    let data = fs::metadata(path)?;
    if data.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if !data.is_file() {
        return Err(io::Error::other("it is not a regular file"));
    }
    fs::File::open(path)?.metadata()
}
