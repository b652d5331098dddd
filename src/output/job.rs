//! Names of the files of a job, derived from the name of its deck.

use std::path::{Path, PathBuf};

/// The files of a job.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JobFiles {
    /// The deck's file name without `.inp`, in capitals or not.
    pub name: String,
    /// `JOB.vtkhdf`.
    pub result: PathBuf,
    /// `JOB.sta`.
    pub status: PathBuf,
    /// `JOB.log`.
    pub log: PathBuf,
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
            name,
        }
    }

    /// `JOB-lcp-INCREMENT.json`, for a complementarity problem that was not solved.
    pub fn failed_lcp(&self, increment: usize) -> PathBuf {
        let name = format!("{}-lcp-{increment}.json", self.name);
        self.log.with_file_name(name)
    }

    /// `JOB.vtkhdf.part`, the result until its first frame is complete.
    pub(super) fn draft(&self) -> PathBuf {
        self.result
            .with_file_name(format!("{}.vtkhdf.part", self.name))
    }

    /// The existing files with results of a run; the empty log of a run killed before its first
    /// frame does not count.
    pub(super) fn results(&self) -> Vec<PathBuf> {
        let is_empty = |path: &Path| {
            let data = path.symlink_metadata();
            path == self.log && data.is_ok_and(|data| data.is_file() && data.len() == 0)
        };
        let existing = self.existing().into_iter();
        let told = existing.filter(|path| !is_empty(path));
        told.map(Path::to_owned).collect()
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

/// A deck's file name without `.inp`.
fn without_extension(file: &str) -> &str {
    match file.split_at_checked(file.len().saturating_sub(4)) {
        Some((name, extension)) if extension.eq_ignore_ascii_case(".inp") => name,
        _ => file,
    }
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
}
