//! Disk space reserved for a growing result file, and the end of the file that its superblock notes.
//! Source: HDF5 File Format Specification 3.0, section II.A (superblock, version 0).

use std::fs::File;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::Path;

use crate::system::{free_space, largest_file, reserve};

/// Number of bytes for the attributes that complete the record of the run.
const CLOSING: u64 = 1 << 16;

/// First bytes of an HDF5 file, up to the version of its superblock.
const SUPERBLOCK_0: [u8; 9] = *b"\x89HDF\r\n\x1a\n\0";

/// Place at which a superblock of version 0 notes the end of the file.
const END_OF_FILE: u64 = 40;

/// End of the file in its superblock, before the library writes and while it writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct End {
    before: u64,
    ahead: u64,
}

/// Reserves disk space for the rows to be written next, and fails beforehand when there is none.
pub(crate) struct Space {
    file: File,
    /// End of the reserved part of the file.
    kept: u64,
}

impl Space {
    /// The reserved space of a result file that has no rows yet.
    pub fn new(path: &Path) -> io::Result<Self> {
        Ok(Space {
            file: File::options().read(true).write(true).open(path)?,
            kept: 0,
        })
    }

    /// Brings the file to the disk.
    pub fn sync(&self) -> io::Result<()> {
        self.file.sync_data()
    }

    /// Reserves the space for a file that may grow by `growth` bytes, and by the record, until everything is written to
    /// the disk.
    ///
    /// # Errors
    /// The disk is full, or the file would become larger than it may.
    pub fn ensure(&mut self, growth: u64) -> io::Result<()> {
        let size = self.file.metadata()?.len();
        let room = growth + CLOSING;
        let end = size + room;
        if end <= self.kept {
            return Ok(());
        }
        if largest_file().is_some_and(|limit| end > limit) {
            return Err(ErrorKind::FileTooLarge.into());
        }
        use ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
        match reserve(&self.file, size, room).map_err(|error| (error.kind(), error)) {
            Err((StorageFull | QuotaExceeded | FileTooLarge, full)) => return Err(full),
            Err(_) => self.ask(room)?,
            Ok(()) => {}
        }
        self.kept = end;
        Ok(())
    }

    /// Checks that enough space is free at present, for a file system that cannot reserve space.
    fn ask(&self, room: u64) -> io::Result<()> {
        match free_space(&self.file) {
            Some(free) if free < room => Err(ErrorKind::StorageFull.into()),
            _ => Ok(()),
        }
    }

    /// Moves the noted end of the file to the end of the reserved space, behind everything that the library may write
    /// in one step. The result is `None` if the superblock is not of version 0.
    pub fn move_end_ahead(&self) -> io::Result<Option<End>> {
        let mut first = [0; SUPERBLOCK_0.len()];
        self.read_at(0, &mut first)?;
        if first != SUPERBLOCK_0 {
            return Ok(None);
        }
        let end = End {
            before: self.end()?,
            ahead: self.file.metadata()?.len().max(self.kept),
        };
        self.file.set_len(end.ahead)?;
        self.note_end(end.ahead)?;
        Ok(Some(end))
    }

    /// Cuts the file at the end that the library has noted; if the library noted nothing, the end is the same as
    /// before.
    pub fn settle_end(&self, end: Option<End>) -> io::Result<()> {
        let Some(End { before, ahead }) = end else {
            return Ok(());
        };
        if self.end()? == ahead {
            self.note_end(before)?;
        }
        self.file.set_len(self.end()?)
    }

    fn end(&self) -> io::Result<u64> {
        let mut bytes = [0; 8];
        self.read_at(END_OF_FILE, &mut bytes)?;
        Ok(u64::from_le_bytes(bytes))
    }

    /// Reads bytes from a place in the file.
    fn read_at(&self, place: u64, bytes: &mut [u8]) -> io::Result<()> {
        let mut file = &self.file;
        file.seek(SeekFrom::Start(place))?;
        file.read_exact(bytes)
    }

    fn note_end(&self, end: u64) -> io::Result<()> {
        let mut file = &self.file;
        file.seek(SeekFrom::Start(END_OF_FILE))?;
        file.write_all(&end.to_le_bytes())
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
