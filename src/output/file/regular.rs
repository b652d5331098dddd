//! The check that a file to be read is a regular file.

use std::path::Path;
use std::{fs, io};

/// What the system says about a file that can be read; one that is no regular file is not opened,
/// for a fifo would wait for its writer.
///
/// # Errors
/// The file is not there, may not be read, or is no regular file.
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
