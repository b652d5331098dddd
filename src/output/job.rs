use std::path::{Path, PathBuf};

/// The files of a job.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JobFiles {
    /// The deck's file name without `.inp`.
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
        let name = file.strip_suffix(".inp").unwrap_or(&file).to_owned();
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

    /// The result, status and log files that exist.
    pub fn existing(&self) -> Vec<&Path> {
        [&self.result, &self.status, &self.log]
            .into_iter()
            .map(PathBuf::as_path)
            .filter(|path| path.symlink_metadata().is_ok())
            .collect()
    }
}
