//! The files of a job: their names, derived from the name of its deck, and the right to write them.
//!
//! The run that creates or locks `JOB.log` has the job. The system releases the lock when the program
//! ends, however it ends, so that a killed run blocks no other. Until the first frame is complete the
//! files of an earlier run stay unchanged: the result is written to `JOB.vtkhdf.part`.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::{fs, io};

use super::draft::{self, Existing};
use super::error::{FileError, OutputError, at};
use crate::deck::not_regular;
use crate::system::{is_at, without_links};

/// The files of a job.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JobFiles {
    /// The file name of the deck without `.inp`, which may be in capitals.
    pub name: String,
    /// `JOB.vtkhdf`.
    pub result: PathBuf,
    /// `JOB.sta`.
    pub status: PathBuf,
    /// `JOB.log`.
    pub log: PathBuf,
    /// `JOB.restart`.
    pub restart: PathBuf,
}

impl JobFiles {
    /// The files of the job of a deck, in `folder`.
    pub fn new(deck: &Path, folder: &Path) -> Self {
        let file = deck.file_name().unwrap_or_default().to_string_lossy();
        let name = without_extension(&file).to_owned();
        let folder = match folder == Path::new(".") {
            true => Path::new(""),
            false => folder,
        };
        let path = |extension| folder.join(format!("{name}.{extension}"));
        JobFiles {
            result: path("vtkhdf"),
            status: path("sta"),
            log: path("log"),
            restart: path("restart"),
            name,
        }
    }

    /// `JOB-lcp-INCREMENT.json`, for a complementarity problem that was not solved.
    pub fn failed_lcp(&self, increment: usize) -> PathBuf {
        let name = format!("{}-lcp-{increment}.json", self.name);
        self.log.with_file_name(name)
    }

    /// `JOB.restart-STEP-INC`, for a checkpoint that is kept along with later ones. The name is unique among all jobs:
    /// the end of a name gives the kind of file, and its beginning the job.
    pub(super) fn kept_checkpoint(&self, [step, increment]: [usize; 2]) -> PathBuf {
        let name = format!("{}.restart-{step}-{increment}", self.name);
        self.restart.with_file_name(name)
    }

    /// The checkpoints of the job that exist, in the order of their names.
    fn checkpoints(&self) -> io::Result<Vec<PathBuf>> {
        let folder = self.restart.parent();
        let folder = folder.filter(|folder| !folder.as_os_str().is_empty());
        let mut found = Vec::new();
        for entry in fs::read_dir(folder.unwrap_or(Path::new(".")))? {
            let name = entry?.file_name();
            if checkpoint_of(&name.to_string_lossy()) == Some(self.name.as_str()) {
                found.push(self.restart.with_file_name(name));
            }
        }
        found.sort();
        Ok(found)
    }

    /// `JOB.vtkhdf.part`, the result until its first frame is complete.
    pub(super) fn draft(&self) -> PathBuf {
        draft::part(&self.result)
    }

    /// The existing files with results of a run and its checkpoints; the empty log of a run that was killed before its
    /// first frame does not count.
    pub(super) fn results(&self) -> Vec<PathBuf> {
        let is_empty = |path: &Path| {
            let data = path.symlink_metadata();
            path == self.log && data.is_ok_and(|data| data.is_file() && data.len() == 0)
        };
        let existing = self.existing().into_iter();
        let told = existing.filter(|path| !is_empty(path)).map(Path::to_owned);
        // there are none in a folder that cannot be read
        let checkpoints = self.checkpoints().unwrap_or_default();
        told.chain(checkpoints).collect()
    }

    /// The result, status and log files that exist.
    pub fn existing(&self) -> Vec<&Path> {
        [&self.result, &self.status, &self.log]
            .into_iter()
            .map(PathBuf::as_path)
            .filter(|path| path.symlink_metadata().is_ok())
            .collect()
    }
}

/// Whether a path has the name of a checkpoint of some job.
pub fn is_checkpoint(path: &Path) -> bool {
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    checkpoint_of(&file).is_some()
}

/// The job of which a file is a checkpoint, `JOB.restart` or `JOB.restart-STEP-INC`.
fn checkpoint_of(file: &str) -> Option<&str> {
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let (job, rest) = file.rsplit_once(".restart")?;
    let numbers = rest.strip_prefix('-').and_then(|rest| rest.split_once('-'));
    let is_kept = numbers.is_some_and(|(step, inc)| is_number(step) && is_number(inc));
    (rest.is_empty() || is_kept).then_some(job)
}

/// File name of a deck without `.inp`.
fn without_extension(file: &str) -> &str {
    match file.split_at_checked(file.len().saturating_sub(4)) {
        Some((name, extension)) if extension.eq_ignore_ascii_case(".inp") => name,
        _ => file,
    }
}

/// Treatment of the results of an earlier run of a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Earlier {
    /// The old results stay, and the new run does not begin.
    Stays,
    /// The results of the new run replace them.
    Replaced,
    /// The new run continues them.
    Continued,
}

/// A claim holds a job until it is dropped; files without a complete frame are then removed.
#[derive(Debug)]
pub struct Claim {
    files: JobFiles,
    /// `JOB.log`, locked.
    log: File,
    earlier: Earlier,
}

impl Claim {
    /// Claims a job; creates its folder if it is missing.
    ///
    /// # Errors
    /// Results exist and may not be overwritten, another run holds the job, or a name belongs to
    /// something other than a regular file.
    pub fn take(files: &JobFiles, earlier: Earlier) -> Result<Self, OutputError> {
        if earlier == Earlier::Stays {
            refuse(files.results())?;
        }
        create_folder(&files.log)?;
        refuse_others(files, earlier)?;
        let log = locked_log(&files.log, earlier)?;
        let claim = Claim {
            files: files.clone(),
            log,
            earlier,
        };
        // A run that had the job before may have finished in the meantime.
        if earlier == Earlier::Stays {
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

    /// The log file, which stays locked as long as any handle of it lives.
    pub(crate) fn log(&self) -> io::Result<File> {
        self.log.try_clone().map_err(at(&self.files.log))
    }

    /// Path of the result until its first frame is complete; a draft of a killed run is removed.
    pub(crate) fn draft(&self) -> Result<PathBuf, OutputError> {
        let draft = self.files.draft();
        draft::remove(&draft).map_err(FileError::new("create", &draft))?;
        Ok(draft)
    }

    /// Removes the checkpoints of an earlier run.
    pub(crate) fn forget_checkpoints(&self) -> io::Result<()> {
        let half = draft::part(&self.files.restart);
        for path in self.files.checkpoints()?.iter().chain([&half]) {
            draft::remove(path).map_err(at(path))?;
        }
        Ok(())
    }

    /// Gives the result its final name in one operation.
    pub(crate) fn publish(&self) -> io::Result<()> {
        let result = &self.files.result;
        let existing = match self.earlier {
            Earlier::Stays => Existing::Stays,
            Earlier::Replaced | Earlier::Continued => Existing::Replaced,
        };
        draft::rename(&self.files.draft(), result, existing).map_err(at(result))
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        // The next run of the job removes a draft that cannot be removed here.
        let _ = fs::remove_file(self.files.draft());
        let is_empty = self.log.metadata().is_ok_and(|data| data.len() == 0);
        if is_empty && is_at(&self.log, &self.files.log) {
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
            Ok(fs::create_dir_all(folder).map_err(FileError::new("create", folder))?)
        }
        _ => Ok(()),
    }
}

/// Refuses fifos, devices and folders in place of old results. Links to files are replaced like files, except for the
/// log, which a resumed run continues.
fn refuse_others(files: &JobFiles, earlier: Earlier) -> Result<(), OutputError> {
    for path in files.existing() {
        let is_replaced = *path != files.log || earlier != Earlier::Continued;
        let data = fs::symlink_metadata(path).map_err(FileError::new("read", path))?;
        if !(data.is_file() || data.is_symlink() && is_replaced) {
            return Err(FileError::new("write", path)(not_regular()).into());
        }
    }
    Ok(())
}

/// Opens and locks the log; an old log keeps its text until the new one begins. A link in place of the log is removed.
fn locked_log(path: &Path, earlier: Earlier) -> Result<File, OutputError> {
    loop {
        if path.is_symlink() {
            draft::remove(path).map_err(FileError::new("create", path))?;
        }
        let mut how = OpenOptions::new();
        without_links(how.read(true).write(true));
        let (log, is_new) = match how.clone().create_new(true).open(path) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => match how.open(path) {
                // The file was removed in between: try again.
                Err(error) if error.kind() == ErrorKind::NotFound => continue,
                old => (old.map_err(FileError::new("create", path))?, false),
            },
            new => (new.map_err(FileError::new("create", path))?, true),
        };
        match log.try_lock() {
            Err(TryLockError::WouldBlock) => {
                let path = path.to_owned();
                return Err(OutputError::Held { path });
            }
            // On a file system without locks only the creation of the file decides.
            Err(TryLockError::Error(_)) if !is_new && earlier == Earlier::Stays => {
                refuse(vec![path.to_owned()])?;
            }
            _ => {}
        }
        if is_at(&log, path) {
            return Ok(log);
        }
    }
}

/// Whether a program has the result file open: HDF5 locks the file, even if the log is gone.
fn is_held(result: &Path) -> bool {
    let file = File::open(result);
    file.is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_of_a_job_is_that_of_its_deck() {
        let name = |deck: &str| JobFiles::new(Path::new(deck), Path::new("out")).name;
        let names = [
            "a/b.inp",
            "B.INP",
            "b.Inp",
            "b.inp.txt",
            "b",
            ".inp",
            "größe.inp",
        ]
        .map(name);
        assert_eq!(names, ["b", "B", "b", "b.inp.txt", "b", "", "größe"]);
        let files = JobFiles::new(Path::new("B.INP"), Path::new("out"));
        assert_eq!(files.log, Path::new("out/B.log"));
        assert_eq!(files.draft(), Path::new("out/B.vtkhdf.part"));
    }

    #[test]
    fn names_of_files_of_two_jobs_never_meet() {
        let jobs = [
            "case",
            "case-1-2",
            "case-1-2-3-4",
            "case.restart",
            "case.restart-1-2",
        ];
        let mut owners = std::collections::BTreeMap::new();
        for job in jobs {
            let files = JobFiles::new(Path::new(job), Path::new("out"));
            let checkpoints = [[1, 2], [3, 4]].map(|place| files.kept_checkpoint(place));
            for path in checkpoints.iter().chain([&files.restart]) {
                let name = path.file_name().expect("name").to_string_lossy();
                assert_eq!(checkpoint_of(&name), Some(job));
            }
            let others = [
                files.failed_lcp(3),
                files.draft(),
                draft::part(&files.restart),
            ];
            let own = [files.result, files.status, files.log, files.restart];
            for path in checkpoints.into_iter().chain(others).chain(own) {
                assert_eq!(owners.insert(path.clone(), job), None, "{}", path.display());
            }
        }
        for other in [
            "case-1-2",
            "case.restart-1",
            "case.restart-a-1",
            "case.restart-1-2.part",
        ] {
            assert_eq!(checkpoint_of(other), None);
        }
    }
}
