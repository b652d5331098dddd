//! Disk space reserved for a growing result file.

use std::fs::File;
use std::io::{self, ErrorKind};
use std::path::Path;

use rustix::fs::{FallocateFlags, fallocate, fstatvfs};
use rustix::io::Errno;
use rustix::process::{Resource, getrlimit};

/// Bytes for the attributes that complete the record of the run.
const CLOSING: u64 = 1 << 16;

/// Reserves disk space for the rows to be written next, and fails beforehand when there is none.
pub(crate) struct Space {
    file: File,
    /// Bytes by which the file may grow until what waits in memory and the record are written.
    room: u64,
    /// End of the reserved part of the file.
    kept: u64,
}

impl Space {
    /// For a result file without rows that may grow by `growth` bytes until it is written through.
    pub fn new(path: &Path, growth: u64) -> io::Result<Self> {
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
