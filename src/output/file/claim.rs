//! The right to write the files of a job.
//!
//! `JOB.log` stands for the job: who creates it, or locks it, has the job. The system lifts the
//! lock when the program ends, however it ends, so that a killed run is in nobody's way. Until the
//! first frame is complete nothing of an earlier run is touched: the result grows in
//! `JOB.vtkhdf.part`.

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
    /// Results exist and may not be overwritten, another run holds the job, or a name is taken by
    /// something that is no regular file.
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
        // Whoever had the job before may have finished in the meantime.
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

    /// A name for the result before its first frame is in it; what a killed run left there is
    /// removed.
    pub(crate) fn draft(&self) -> Result<PathBuf, OutputError> {
        let draft = self.files.draft();
        match fs::remove_file(&draft) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                Err(OutputError::at(&draft)(error))
            }
            _ => Ok(draft),
        }
    }

    /// Gives the result its name, at once and as a whole.
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
        // What cannot be removed here is removed by the next run of the job.
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

/// Removes links that stand for old results, so that what they point to is not written; refuses
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

/// The log with its lock. An old one keeps its text for the time being.
fn locked_log(path: &Path, overwrite: bool) -> Result<File, OutputError> {
    loop {
        let mut how = OpenOptions::new();
        how.read(true).write(true);
        let (log, is_new) = match how.clone().create_new(true).open(path) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => match how.open(path) {
                // Removed between the two: once more.
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
            // On a file system without locks only a new file tells who comes first.
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

/// Whether a program writes the result file: HDF5 locks it, whatever became of the log.
fn is_held(result: &Path) -> bool {
    let file = File::open(result);
    file.is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

fn exists(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}
