//! Files that a command makes beside the results of runs: pictures and flat decks.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use super::error::CliError;

/// Writes a file, whole or not at all; one that exists is replaced only where the user asks for it.
/// What is not a regular file stays; in place of a link a file of its own is made.
pub(super) fn write_file(path: &Path, text: &str, overwrite: bool) -> Result<(), CliError> {
    let failed = |source| CliError::File {
        path: path.to_owned(),
        source,
    };
    match fs::symlink_metadata(path) {
        Ok(_) if !overwrite => {
            let path = path.to_owned();
            return Err(CliError::Exists { path });
        }
        Ok(data) if !data.is_file() && !data.is_symlink() => {
            return Err(failed(io::Error::other("it is not a regular file")));
        }
        Err(error) if error.kind() != ErrorKind::NotFound => return Err(failed(error)),
        _ => {}
    }
    let draft = draft(path);
    let written = fs::write(&draft, text).and_then(|()| fs::rename(&draft, path));
    if written.is_err() {
        // the first error is reported
        let _ = fs::remove_file(&draft);
    }
    written.map_err(failed)
}

/// The name of a file until it is complete.
fn draft(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    path.with_file_name(name)
}
