//! The files that the server knows: files that are open in the editor, and files on the disk that include these or are
//! included by them.

use super::document::Document;
use crate::deck::open_regular;
use crate::diagnostics::whole_path;
use lsp_types::Url;
use ropey::Rope;
use std::collections::{BTreeMap, HashMap};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Largest number of files of a folder that are searched for a deck that includes a file.
const MOST_NEIGHBOURS: usize = 200;

/// Largest number of bytes that are read to find a deck that includes a file.
const MOST_BYTES: u64 = 1 << 28;

/// Number of folders above a file that are searched for a deck that includes the file.
const FOLDERS_ABOVE: usize = 2;

/// A file.
#[derive(Debug)]
pub(super) struct File {
    /// Text of the file.
    pub document: Document,
    /// Address (URI) of the file in the editor, if the file is open there.
    pub open: Option<Url>,
    /// A number that increases with every change of the file.
    pub revision: u64,
    /// Time and length that the file had when it was read from the disk.
    stamp: Option<(SystemTime, u64)>,
}

/// All files by their whole paths.
#[derive(Debug, Default)]
pub(super) struct Files {
    all: HashMap<PathBuf, File>,
    /// Number of changes so far.
    changes: u64,
}

impl Files {
    /// A file, if the server knows it.
    pub fn get(&self, path: &Path) -> Option<&File> {
        self.all.get(path)
    }

    /// A file, which is read from the disk if the server does not know it; `None` if the file cannot be read.
    pub fn load(&mut self, path: &Path) -> Option<&File> {
        if !self.all.contains_key(path) {
            let (text, stamp) = read(path)?;
            self.put(path, &text, None, stamp);
        }
        self.get(path)
    }

    fn put(
        &mut self,
        path: &Path,
        text: &str,
        open: Option<Url>,
        stamp: Option<(SystemTime, u64)>,
    ) {
        self.changes += 1;
        let file = File {
            document: Document::new(text),
            open,
            revision: self.changes,
            stamp,
        };
        self.all.insert(path.to_owned(), file);
    }

    /// Stores the text of a file that the editor has opened, and returns the path of the file.
    pub fn open(&mut self, uri: &Url, text: &str) -> PathBuf {
        let path = path_of(uri);
        self.put(&path, text, Some(uri.clone()), None);
        path
    }

    /// Forgets a file that the editor has closed; afterwards the text on the disk is used.
    pub fn close(&mut self, path: &Path) {
        self.all.remove(path);
    }

    /// The document of an open file, for a change; the revision of the file increases.
    pub fn changing(&mut self, path: &Path) -> Option<&mut Document> {
        let file = self.all.get_mut(path).filter(|file| file.open.is_some())?;
        self.changes += 1;
        file.revision = self.changes;
        Some(&mut file.document)
    }

    /// Forgets files that were read from the disk and have changed there.
    pub fn forget_changed(&mut self) {
        self.all
            .retain(|path, file| file.open.is_some() || file.stamp == stamp(path));
    }

    /// Paths of the open files, in order.
    pub fn open_paths(&self) -> Vec<PathBuf> {
        let open = self.all.iter().filter(|(_, file)| file.open.is_some());
        let mut paths: Vec<PathBuf> = open.map(|(path, _)| path.clone()).collect();
        paths.sort();
        paths
    }

    /// Texts of the open files.
    pub fn unsaved(&self) -> BTreeMap<PathBuf, Rope> {
        let open = self.all.iter().filter(|(_, file)| file.open.is_some());
        open.map(|(path, file)| (path.clone(), file.document.rope()))
            .collect()
    }

    /// Address (URI) of a file.
    pub fn uri(&self, path: &Path) -> Option<Url> {
        let open = self.get(path).and_then(|file| file.open.clone());
        open.or_else(|| Url::from_file_path(path).ok())
    }
}

/// The whole path of a file of the editor; a file that is not on the disk has its address as path.
pub(super) fn path_of(uri: &Url) -> PathBuf {
    match uri.to_file_path() {
        Ok(path) => whole_path(&path),
        Err(()) => PathBuf::from(uri.as_str()),
    }
}

fn stamp(path: &Path) -> Option<(SystemTime, u64)> {
    let data = path.metadata().ok()?;
    Some((data.modified().ok()?, data.len()))
}

/// Text and stamp of a file of the disk.
fn read(path: &Path) -> Option<(String, Option<(SystemTime, u64)>)> {
    let stamp = stamp(path);
    let mut bytes = Vec::new();
    open_regular(path).ok()?.read_to_end(&mut bytes).ok()?;
    let text = String::from_utf8(bytes)
        .unwrap_or_else(|bytes| String::from_utf8_lossy(bytes.as_bytes()).into_owned());
    Some((text, stamp))
}

/// Decks near a file whose text contains the name of the file, so that such a deck may include the file.
pub(super) fn neighbours(path: &Path) -> Vec<PathBuf> {
    let Some(name) = path.file_name().and_then(|name| name.to_str()) else {
        return Vec::new();
    };
    let mut bytes = MOST_BYTES;
    let mut found = Vec::new();
    for folder in path.ancestors().skip(1).take(1 + FOLDERS_ABOVE) {
        let Ok(entries) = folder.read_dir() else {
            continue;
        };
        let decks = entries.filter_map(|entry| Some(entry.ok()?.path()));
        let is_deck = |other: &PathBuf| {
            let extension = other.extension().unwrap_or_default();
            extension.eq_ignore_ascii_case("inp") && other != path
        };
        let mut decks: Vec<PathBuf> = decks.take(MOST_NEIGHBOURS).filter(is_deck).collect();
        decks.sort();
        for deck in decks {
            let length = deck.metadata().map_or(u64::MAX, |data| data.len());
            let Some(rest) = bytes.checked_sub(length) else {
                continue;
            };
            bytes = rest;
            if read(&deck).is_some_and(|(text, _)| text.contains(name)) {
                found.push(deck);
            }
        }
    }
    found
}
