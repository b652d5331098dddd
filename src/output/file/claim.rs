//! The right to write the files of a job.
//!
//! The run that creates or locks `JOB.log` has the job. The system releases the lock when the program
//! ends, however it ends, so that a killed run blocks no other. Until the first frame is complete the
//! files of an earlier run stay unchanged: the result is written to `JOB.vtkhdf.part`.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use crate::output::error::{OutputError, at};
use crate::output::job::JobFiles;

/// Holds a job until it is dropped; then files that never got a frame are removed.
#[derive(Debug)]
pub struct Claim {
    files: JobFiles,
    /// `JOB.log`, locked.
    log: File,
    /// Whether older results may be replaced.
    overwrite: bool,
}

impl Claim {
    /// Claims a job; makes its folder where it is missing.
    ///
    /// # Errors
    /// Results exist and may not be overwritten, another run holds the job, or a name belongs to
    /// something other than a regular file.
    pub fn take(files: &JobFiles, overwrite: bool) -> Result<Self, OutputError> {
        if !overwrite {
            refuse(files.results())?;
        }
        create_folder(&files.log)?;
        clear(files)?;
        let log = locked_log(&files.log, overwrite)?;
        let claim = Claim {
            files: files.clone(),
            log,
            overwrite,
        };
        // A run that had the job before may have finished in the meantime.
        if !overwrite {
            refuse(files.results())?;
        } else if is_held(&files.result) {
            let path = files.result.clone();
            return Err(OutputError::Held { path });
        }
        Ok(claim)
    }

    /// The files of the job.
    pub fn files(&self) -> &JobFiles {
        &self.files
    }

    /// The log, which keeps its lock as long as any handle of it lives.
    pub(crate) fn log(&self) -> io::Result<File> {
        self.log.try_clone().map_err(at(&self.files.log))
    }

    /// Path of the result until its first frame is complete; the draft of a killed run is removed.
    pub(crate) fn draft(&self) -> Result<PathBuf, OutputError> {
        let draft = self.files.draft();
        match fs::remove_file(&draft) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                Err(OutputError::at(&draft)(error))
            }
            _ => Ok(draft),
        }
    }

    /// Gives the result its final name in one operation.
    pub(crate) fn publish(&self) -> io::Result<()> {
        let result = &self.files.result;
        if !self.overwrite && exists(result) {
            return Err(at(result)(ErrorKind::AlreadyExists.into()));
        }
        fs::rename(self.files.draft(), result).map_err(at(result))
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        // The next run of the job removes a draft that cannot be removed here.
        let _ = fs::remove_file(self.files.draft());
        if self.log.metadata().is_ok_and(|data| data.len() == 0) {
            let _ = fs::remove_file(&self.files.log);
        }
    }
}

/// Files of an earlier run that may not be replaced.
fn refuse(files: Vec<PathBuf>) -> Result<(), OutputError> {
    match files.is_empty() {
        true => Ok(()),
        false => Err(OutputError::Exists { files }),
    }
}

fn create_folder(file: &Path) -> Result<(), OutputError> {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => {
            fs::create_dir_all(folder).map_err(OutputError::at(folder))
        }
        _ => Ok(()),
    }
}

/// Removes symbolic links in place of old results, so that their targets are not written; refuses
/// fifos, devices and folders.
fn clear(files: &JobFiles) -> Result<(), OutputError> {
    for path in files.existing() {
        match fs::symlink_metadata(path) {
            Ok(data) if data.is_symlink() => {
                fs::remove_file(path).map_err(OutputError::at(path))?;
            }
            Ok(data) if !data.is_file() => {
                let path = path.to_owned();
                return Err(OutputError::NotRegular { path });
            }
            _ => {}
        }
    }
    Ok(())
}

/// The log with its lock; an old log keeps its text until the new one begins.
fn locked_log(path: &Path, overwrite: bool) -> Result<File, OutputError> {
    loop {
        let mut how = OpenOptions::new();
        how.read(true).write(true);
        let (log, is_new) = match how.clone().create_new(true).open(path) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => match how.open(path) {
                // The file was removed in between: try again.
                Err(error) if error.kind() == ErrorKind::NotFound => continue,
                old => (old.map_err(OutputError::at(path))?, false),
            },
            new => (new.map_err(OutputError::at(path))?, true),
        };
        match log.try_lock() {
            Err(TryLockError::WouldBlock) => {
                let path = path.to_owned();
                return Err(OutputError::Held { path });
            }
            // On a file system without locks only the creation of the file decides.
            Err(TryLockError::Error(_)) if !is_new && !overwrite => refuse(vec![path.to_owned()])?,
            _ => {}
        }
        if is_at(&log, path) {
            return Ok(log);
        }
    }
}

/// Whether the file still has that name.
fn is_at(file: &File, path: &Path) -> bool {
    let id = |data: fs::Metadata| (data.dev(), data.ino());
    match (file.metadata(), fs::symlink_metadata(path)) {
        (Ok(open), Ok(named)) => id(open) == id(named),
        _ => false,
    }
}

/// Whether a program has the result file open: HDF5 locks it even where the log is gone.
fn is_held(result: &Path) -> bool {
    let file = File::open(result);
    file.is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

fn exists(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}
