//! Files that are written completely or not at all: each file is created under an unused name and gets its own name
//! when it is complete. Links are not followed under either name.

use std::fs::{self, File};
use std::hash::{BuildHasher, RandomState};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Treatment of an existing file with the name of a new one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existing {
    /// The existing file stays, and the new file is not written.
    Stays,
    /// The new file replaces the existing one.
    Replaced,
}

/// A file that has another name until it is complete. The file is removed if the draft is dropped before it is
/// complete.
#[derive(Debug)]
pub struct Draft {
    file: File,
    name: PartName,
}

/// The name of a draft; dropping it removes the file.
#[derive(Debug)]
struct PartName(PathBuf);

impl Draft {
    /// The draft of a file of a claimed job, `FILE.part`. A draft that a killed run has left is removed.
    ///
    /// # Errors
    /// The file system refuses the file, or something else creates a file with this name at the same time.
    pub(super) fn claimed(path: &Path) -> io::Result<Self> {
        let part = part(path);
        remove(&part)?;
        Ok(Draft {
            file: File::create_new(&part)?,
            name: PartName(part),
        })
    }

    /// The draft of a file that nobody has claimed, under a name that nobody can guess.
    ///
    /// # Errors
    /// The file system refuses the file.
    fn unclaimed(path: &Path) -> io::Result<Self> {
        loop {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let any = RandomState::new().hash_one(&name);
            let part = path.with_file_name(format!(".{name}.{any:016x}.part"));
            match File::create_new(&part) {
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                file => {
                    return Ok(Draft {
                        file: file?,
                        name: PartName(part),
                    });
                }
            }
        }
    }

    /// The open file.
    pub(super) fn file(&mut self) -> &mut File {
        &mut self.file
    }

    /// Gives the complete file its name in one operation.
    ///
    /// # Errors
    /// Something that may not be replaced has the name, or the file system refuses the name.
    pub(super) fn publish(self, path: &Path, existing: Existing) -> io::Result<File> {
        rename(&self.name.0, path, existing)?;
        Ok(self.file)
    }
}

impl Drop for PartName {
    fn drop(&mut self) {
        // there is none where the file has got its own name
        let _ = fs::remove_file(&self.0);
    }
}

/// Writes a file that nobody has claimed.
///
/// # Errors
/// Something that may not be replaced has the name, or the file system refuses the file.
pub fn write_whole(path: &Path, text: &str, existing: Existing) -> io::Result<()> {
    let mut draft = Draft::unclaimed(path)?;
    draft.file.write_all(text.as_bytes())?;
    draft.publish(path, existing).map(drop)
}

/// `FILE.part`, the name of a claimed file until it is complete.
pub(super) fn part(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    path.with_file_name(name)
}

/// Gives a complete file its name in one operation.
pub(super) fn rename(part: &Path, path: &Path, existing: Existing) -> io::Result<()> {
    if existing == Existing::Replaced {
        return fs::rename(part, path);
    }
    match fs::hard_link(part, path) {
        Ok(()) => remove(part),
        // a file system without hard links
        Err(error) if error.kind() != ErrorKind::AlreadyExists => match path.symlink_metadata() {
            Ok(_) => Err(ErrorKind::AlreadyExists.into()),
            Err(_) => fs::rename(part, path),
        },
        exists => exists,
    }
}

/// Gives a file a second name, in place of a file with this name.
pub(super) fn link(path: &Path, second: &Path) -> io::Result<()> {
    let part = PartName(part(second));
    remove(&part.0)?;
    fs::hard_link(path, &part.0)?;
    fs::rename(&part.0, second)
}

/// Removes a file or a link, if it exists.
pub(super) fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_created_exclusively_or_replaced_whole() {
        let folder = tempfile::TempDir::new().expect("folder");
        let path = |name: &str| folder.path().join(name);
        let text = |name: &str| fs::read_to_string(path(name)).expect(name);
        fs::write(path("precious"), "precious").expect("file");
        for name in ["out", "out.part", "job", "job.part"] {
            std::os::unix::fs::symlink(path("precious"), path(name)).expect(name);
        }
        let stays = write_whole(&path("out"), "new", Existing::Stays).expect_err("a link");
        assert_eq!(stays.kind(), ErrorKind::AlreadyExists);
        write_whole(&path("out"), "new", Existing::Replaced).expect("written");
        write_whole(&path("other"), "new", Existing::Stays).expect("written");
        let mut draft = Draft::claimed(&path("job")).expect("draft");
        draft.file().write_all(b"half").expect("written");
        drop(draft);
        let mut draft = Draft::claimed(&path("job")).expect("draft");
        draft.file().write_all(b"whole").expect("written");
        draft
            .publish(&path("job"), Existing::Replaced)
            .expect("named");
        link(&path("job"), &path("precious.link")).expect("linked");
        link(&path("other"), &path("precious.link")).expect("linked");
        let names = ["out", "other", "job", "precious.link", "precious"];
        assert_eq!(
            names.map(text),
            ["new", "new", "whole", "new", "precious"].map(str::to_owned)
        );
        // out.part was no draft of what nobody has claimed
        assert_eq!(text("out.part"), "precious");
        assert_eq!(fs::read_dir(folder.path()).expect("folder").count(), 6);
    }
}
