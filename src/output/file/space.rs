//! Disk space reserved for a growing result file.

use crate::output::error::io_error;
use std::fs::File;
use std::io::{self, ErrorKind};
use std::path::Path;

use hdf5::Group;
use rustix::fs::{FallocateFlags, fallocate, fstatvfs};
use rustix::io::Errno;
use rustix::process::{Resource, getrlimit};

/// Bytes by which the index of a dataset may grow when rows are appended: a node of the library's
/// tree of chunks and one for each of the levels above it (3.1 kB each with three dimensions).
const INDEX: u64 = 3 * 3200;
/// Bytes for the attributes that complete the record of the run.
const CLOSING: u64 = 1 << 16;
/// Chunks that the rows of a series may take up to the next frame: two for the frame itself and two
/// for the increments until then.
const SERIES_CHUNKS: u64 = 4;

/// Reserves disk space for the rows to be written next, and fails beforehand when there is none.
pub(crate) struct Space {
    file: File,
    /// Bytes by which the file may grow until its next frame and the record are complete.
    room: u64,
    /// End of the reserved part of the file.
    kept: u64,
}

impl Space {
    /// For a result file as created, without rows.
    pub fn new(path: &Path, root: &Group) -> io::Result<Self> {
        let growth = growth(root, SERIES_CHUNKS).map_err(io_error)?;
        Ok(Space {
            file: File::options().read(true).write(true).open(path)?,
            room: growth + CLOSING,
            kept: 0,
        })
    }

    /// Reserves the space.
    ///
    /// # Errors
    /// The disk is full, or the file would become larger than it may.
    pub fn ensure(&mut self) -> io::Result<()> {
        let size = self.file.metadata()?.len();
        let end = size + self.room;
        if end <= self.kept {
            return Ok(());
        }
        if getrlimit(Resource::Fsize)
            .current
            .is_some_and(|limit| end > limit)
        {
            return Err(ErrorKind::FileTooLarge.into());
        }
        match fallocate(&self.file, FallocateFlags::KEEP_SIZE, size, self.room) {
            Err(full @ (Errno::NOSPC | Errno::DQUOT | Errno::FBIG)) => return Err(full.into()),
            Err(_) => self.ask()?,
            Ok(()) => {}
        }
        self.kept = end;
        Ok(())
    }

    /// Where the file system cannot reserve space: checks that enough is free now.
    fn ask(&self) -> io::Result<()> {
        match fstatvfs(&self.file) {
            Ok(disk) if disk.f_bavail.saturating_mul(disk.f_frsize) < self.room => {
                Err(ErrorKind::StorageFull.into())
            }
            _ => Ok(()),
        }
    }

    /// Notes that the library has written, which may have released reserved space.
    pub fn written(&mut self) {
        self.kept = 0;
    }

    /// Releases the space reserved beyond the end of the file.
    pub fn release(&mut self) {
        self.kept = 0;
        // After a failure the space stays reserved until the file is removed; the results are complete.
        let _ = self
            .file
            .metadata()
            .and_then(|data| self.file.set_len(data.len()));
    }
}

/// Bytes by which the growing datasets of a group may grow: `chunks` of each series, one chunk of
/// each field. A dataset with several names counts once.
fn growth(group: &Group, chunks: u64) -> hdf5::Result<u64> {
    let (mut bytes, mut seen) = (0, Vec::new());
    for dataset in group.datasets()? {
        let token = dataset.loc_info()?.token;
        if seen.contains(&token) {
            continue;
        }
        seen.push(token);
        if let Some(chunk) = dataset.chunk() {
            let values: usize = chunk.iter().product();
            bytes += chunks * (values * dataset.dtype()?.size()) as u64 + INDEX;
        }
    }
    for inner in group.groups()? {
        let is_fields = inner.name().ends_with("Data");
        bytes += growth(&inner, if is_fields { 1 } else { SERIES_CHUNKS })?;
    }
    Ok(bytes)
}
