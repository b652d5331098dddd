//! `JOB.restart`: the last checkpoint of a run, with the deck that it belongs to. A checkpoint is written completely
//! under another name, brought to the disk and then renamed, so that there is always a complete one. docs/restart.md.

use std::fs::File;
use std::io::{self, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::{error, fmt};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::draft::{Draft, Existing};
use super::error::{FileError, at};
use crate::deck::open_regular;
use crate::diagnostics::EarlierDeck;

/// First bytes of the file.
const MAGIC: &[u8] = b"stickslip restart 2\n";

/// Number of bytes of the check sum, which follows the first bytes.
const SUM: usize = 32;

/// A checkpoint, with a description of its run and its place.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// The program that wrote it: version and commit.
    pub program: String,
    /// Deck and options of the run.
    pub origin: RestartOrigin,
    /// Time at the end of the last increment.
    pub time: f64,
    /// Number of the step of this increment, and number of the increment in the step.
    pub place: [usize; 2],
    /// Whether the increment is the last one of the step.
    pub ends_step: bool,
    /// State up to which the files of the job were written.
    pub files: Vec<u8>,
    /// All data on which the rest of the run depends.
    pub solver: Vec<u8>,
}

/// Deck and options of a run, which the continued run must have as well.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct RestartOrigin {
    /// Identity of the run: the attribute `id` of `/run` in its result file. A continued run keeps it.
    pub run: String,
    /// The deck with its includes, file by file: name and text.
    pub deck: Vec<(String, String)>,
    /// Options that change what is computed or written.
    pub options: String,
    /// Values of parameters that replace those of the deck.
    pub settings: Vec<String>,
    /// Time by which the last step is longer than in the deck.
    pub extension: f64,
    /// The deck of the earlier job that this job continues.
    pub earlier: Option<EarlierDeck>,
}

/// Reason why there is no checkpoint from which the run can continue.
#[derive(Debug)]
pub enum CheckpointError {
    /// The file of the checkpoint cannot be read.
    File(FileError),
    /// The file is not a complete checkpoint.
    Content(PathBuf),
    /// The checkpoint was written by another version of the program.
    Program {
        /// The file.
        path: PathBuf,
        /// That version.
        other: String,
    },
}

impl fmt::Display for CheckpointError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            CheckpointError::File(error) if error.source.kind() == ErrorKind::NotFound => write!(
                f,
                "there is no checkpoint {}: a run writes one with *RESTART, WRITE, with --checkpoint, and when it is \
                 interrupted",
                error.path.display()
            ),
            CheckpointError::File(error) => error.fmt(f),
            CheckpointError::Content(path) => {
                write!(f, "{} is no whole checkpoint", path.display())
            }
            CheckpointError::Program { path, other } => write!(
                f,
                "{} is of stickslip {other}: only the same version goes on in the same bits",
                path.display()
            ),
        }
    }
}

impl error::Error for CheckpointError {}

impl Checkpoint {
    /// The deck with the place at which another job continues from this checkpoint.
    pub fn as_earlier_deck(&self) -> EarlierDeck {
        EarlierDeck {
            files: self.origin.deck.clone(),
            settings: self.origin.settings.clone(),
            place: self.place,
            ends_step: self.ends_step,
            before: self.origin.earlier.clone().map(Box::new),
        }
    }

    /// Reads a checkpoint that `program` has written.
    ///
    /// # Errors
    /// The file is missing, incomplete, or written by another program.
    pub fn read(path: &Path, program: &str) -> Result<Self, CheckpointError> {
        let mut bytes = Vec::new();
        open_regular(path)
            .and_then(|mut file| file.read_to_end(&mut bytes))
            .map_err(|error| CheckpointError::File(FileError::new("read", path)(error)))?;
        let content = || CheckpointError::Content(path.to_owned());
        let rest = bytes.strip_prefix(MAGIC).ok_or_else(content)?;
        let (sum, body) = rest.split_at_checked(SUM).ok_or_else(content)?;
        if sum != Sha256::digest(body).as_slice() {
            return Err(content());
        }
        // its first value is the program
        let (other, _) = postcard::take_from_bytes::<String>(body).map_err(|_| content())?;
        if other != program {
            let path = path.to_owned();
            return Err(CheckpointError::Program { path, other });
        }
        postcard::from_bytes(body).map_err(|_| content())
    }

    /// Writes the file in place of the last checkpoint; at every moment there is a complete checkpoint.
    ///
    /// # Errors
    /// The file system refuses the file.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        let body = postcard::to_stdvec(self).map_err(io::Error::other)?;
        let write = || {
            let mut draft = Draft::claimed(path)?;
            let file = draft.file();
            file.write_all(MAGIC)?;
            file.write_all(&Sha256::digest(&body))?;
            file.write_all(&body)?;
            file.sync_all()?;
            draft.publish(path, Existing::Replaced)?;
            let folder = path
                .parent()
                .filter(|folder| !folder.as_os_str().is_empty());
            File::open(folder.unwrap_or(Path::new(".")))?.sync_all()
        };
        write().map_err(at(path))
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_checkpoint_comes_back_or_says_why_not() {
        let folder = tempfile::TempDir::new().expect("folder");
        let path = folder.path().join("job.restart");
        let missing = Checkpoint::read(&path, "1").expect_err("none");
        assert!(missing.to_string().contains("there is no checkpoint"));
        let checkpoint = Checkpoint {
            program: "1".into(),
            time: 7.5,
            solver: vec![1, 2, 3],
            ..Checkpoint::default()
        };
        checkpoint.write(&path).expect("written");
        let read = Checkpoint::read(&path, "1").expect("read");
        assert_eq!(read, checkpoint);
        let other = Checkpoint::read(&path, "2").expect_err("another program");
        assert!(other.to_string().contains("only the same version"));
        let bytes = fs::read(&path).expect("bytes");
        for spoiled in [
            &bytes[..bytes.len() - 1],
            &bytes[..10],
            &[],
            b"something else",
        ] {
            fs::write(&path, spoiled).expect("spoiled");
            let error = Checkpoint::read(&path, "1").expect_err("spoiled");
            assert!(error.to_string().contains("no whole checkpoint"));
        }
        assert_eq!(fs::read_dir(folder.path()).expect("folder").count(), 1);
    }
}
