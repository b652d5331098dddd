//! Texts of the main deck and its included files: access by line, and the chain of includes.

use super::{FileId, Span};
use memchr::memchr_iter;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

/// Number of bytes in a piece of a text whose lines are counted together.
const PIECE: usize = 1 << 12;

/// One file of a deck.
#[derive(Debug, Clone)]
pub struct Source {
    name: String,
    text: Arc<String>,
    included_at: Option<Span>,
    /// Number of lines that end before every piece of the text; the lines are counted when the first message needs
    /// them.
    ends_before: OnceLock<Vec<usize>>,
}

impl Source {
    /// Name as given on the command line, or path from the folder of the including file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Text of the file without byte order mark.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Text of the file, shared.
    pub fn shared_text(&self) -> Arc<String> {
        Arc::clone(&self.text)
    }

    /// The card that included the file; `None` for the main deck.
    pub fn included_at(&self) -> Option<Span> {
        self.included_at
    }

    /// Number of lines.
    pub fn line_count(&self) -> usize {
        let ends = memchr_iter(b'\n', self.text.as_bytes()).count();
        let is_open = !self.text.is_empty() && !self.text.ends_with('\n');
        ends + usize::from(is_open)
    }

    fn ends_before(&self) -> &[usize] {
        self.ends_before.get_or_init(|| {
            let pieces = self.text.as_bytes().chunks(PIECE);
            let counts = pieces.map(|piece| memchr_iter(b'\n', piece).count());
            let mut ends = 0;
            let before = counts.map(|count| {
                ends += count;
                ends - count
            });
            before.collect()
        })
    }

    /// Byte at which the line with `before` lines before it starts.
    fn start(&self, before: usize) -> Option<usize> {
        if before == 0 {
            return Some(0);
        }
        // the piece of the text in which the line before this one ends
        let ends = self.ends_before();
        let piece = ends.partition_point(|&ends| ends < before).checked_sub(1)?;
        let text = self.text.as_bytes().get(piece * PIECE..)?;
        let end = memchr_iter(b'\n', text).nth(before - 1 - ends.get(piece)?)?;
        Some(piece * PIECE + end + 1)
    }

    /// Line `number`, from 1, without its end.
    pub fn line(&self, number: u32) -> Option<&str> {
        let start = self.start((number as usize).checked_sub(1)?)?;
        let rest = self.text.get(start..).filter(|rest| !rest.is_empty())?;
        let line = rest.split('\n').next()?;
        Some(line.strip_suffix('\r').unwrap_or(line))
    }
}

/// The deck of an earlier job that another deck continues (`*RESTART, READ`).
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct EarlierDeck {
    /// Names and texts of the files of the deck; the deck itself is first.
    pub files: Vec<(String, String)>,
    /// Parameters `name=expression` that replaced values in the deck (`--set`).
    pub settings: Vec<String>,
    /// Step and increment of the step from which the job continues.
    pub place: [usize; 2],
    /// Whether the increment from which the job continues is the last increment of its step.
    pub ends_step: bool,
    /// The deck that the earlier deck continues.
    pub before: Option<Box<EarlierDeck>>,
}

/// The texts of a deck and of the files it includes.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    files: Vec<Source>,
    /// Names of the instances of parts, and the place where each is defined.
    instances: Vec<(String, Span)>,
    /// Values, for example of parameters, that the reader of the deck sees in place of text in a line.
    replaced: BTreeMap<(u32, u32), Vec<Replaced>>,
    /// Values of parameters that replace the values in the deck.
    settings: Vec<String>,
    /// The deck that the main deck continues.
    earlier: Option<EarlierDeck>,
    /// Texts of an editor that are read in place of files, by the full paths of these files.
    unsaved: BTreeMap<PathBuf, String>,
    /// Request to stop reading the deck because the result is not needed any more.
    interrupt: Interrupt,
}

/// Request to stop reading a deck because the result is not needed any more.
#[derive(Debug, Clone, Default)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Requests the end of reading the deck.
    pub fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the end of reading has been requested.
    pub fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// If the end of reading has been requested, unwinds to the caller that requested the end, which catches the panic.
    /// The panic prints nothing.
    pub fn end_if_asked(&self) {
        if self.is_asked() {
            std::panic::resume_unwind(Box::new(self.clone()));
        }
    }
}

/// A value that the reader of the deck sees in a line, and the text that was typed in its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Replaced {
    /// First column of the value in the line that the reader sees, from 1.
    pub column: u32,
    /// Length of the value in characters.
    pub length: u32,
    /// Place of the typed text.
    pub typed: Span,
}

/// The canonical path of a file, which is the same for all paths to the file; the given path if the file does not
/// exist.
pub fn whole_path(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_path_buf())
}

impl Sources {
    /// Sources without files.
    pub fn new() -> Sources {
        Sources::default()
    }

    /// Sources without files; `settings` are values `name=expression` of parameters in place of the values in the deck,
    /// and `earlier` is the deck that the main deck continues.
    pub fn with_settings(settings: &[String], earlier: Option<EarlierDeck>) -> Sources {
        Sources {
            settings: settings.to_vec(),
            earlier,
            ..Sources::default()
        }
    }

    /// Sources without files; `unsaved` are texts of an editor that are read in place of files, by the whole paths of
    /// these files.
    pub fn with_unsaved(unsaved: BTreeMap<PathBuf, String>, interrupt: Interrupt) -> Sources {
        Sources {
            unsaved,
            interrupt,
            ..Sources::default()
        }
    }

    /// The text that is read in place of a file.
    pub fn unsaved(&self, path: &Path) -> Option<&str> {
        if self.unsaved.is_empty() {
            return None;
        }
        self.unsaved.get(&whole_path(path)).map(String::as_str)
    }

    /// The object by which the end of reading can be requested.
    pub fn interrupt(&self) -> &Interrupt {
        &self.interrupt
    }

    /// The deck that the main deck continues.
    pub fn earlier(&self) -> Option<&EarlierDeck> {
        self.earlier.as_ref()
    }

    /// Values of parameters that replace the values in the deck.
    pub fn settings(&self) -> &[String] {
        &self.settings
    }

    /// Adds a file.
    pub fn add(
        &mut self,
        name: &str,
        text: impl Into<String>,
        included_at: Option<Span>,
    ) -> FileId {
        let id = self.next_id();
        let mut text = text.into();
        if text.starts_with('\u{feff}') {
            text.remove(0);
        }
        self.files.push(Source {
            name: name.to_string(),
            text: Arc::new(text),
            included_at,
            ends_before: OnceLock::new(),
        });
        id
    }

    /// The id of the next file that is added.
    pub fn next_id(&self) -> FileId {
        FileId(self.files.len() as u32)
    }

    /// Adds an instance of a part that is placed at `place`; returns the number by which spans refer to this instance.
    pub fn add_instance(&mut self, name: &str, place: Span) -> u32 {
        self.instances.push((name.to_string(), place));
        self.instances.len() as u32
    }

    /// Name and place of the instance to which a span belongs.
    pub fn instance_of(&self, span: Span) -> Option<(&str, Span)> {
        let index = (span.instance as usize).checked_sub(1)?;
        let (name, place) = self.instances.get(index)?;
        Some((name, *place))
    }

    /// Stores the values that replaced text in a line, from left to right.
    pub fn replace(&mut self, file: FileId, line: u32, replaced: Vec<Replaced>) {
        self.replaced.insert((file.0, line), replaced);
    }

    /// The place in the typed text for a place in the text that the reader sees.
    pub fn typed(&self, span: Span) -> Span {
        let Some(replaced) = self.replaced.get(&(span.file.0, span.line)) else {
            return span;
        };
        // place of a column in the typed text; within a value `side` gives its start or end
        let typed = |column: u32, side: fn(&Replaced) -> u32| {
            let before = replaced.iter().take_while(|value| value.column <= column);
            match before.last() {
                Some(value) if column < value.column + value.length => side(value),
                Some(value) => {
                    value.typed.column + value.typed.length + (column - value.column - value.length)
                }
                None => column,
            }
        };
        let first = typed(span.column, |value| value.typed.column);
        let end = |value: &Replaced| value.typed.column + value.typed.length - 1;
        let last = typed(span.column + span.length.max(1) - 1, end);
        Span {
            column: first,
            length: (last + 1).saturating_sub(first).max(1),
            ..span
        }
    }

    /// The file with the given id.
    pub fn get(&self, file: FileId) -> Option<&Source> {
        self.files.get(file.0 as usize)
    }

    /// All files; the main deck comes first.
    pub fn files(&self) -> &[Source] {
        &self.files
    }

    /// Number of lines of all files together.
    pub fn line_count(&self) -> usize {
        self.files.iter().map(Source::line_count).sum()
    }

    /// The texts of all files; each text except the first begins with a comment line that names its file.
    pub fn full_text(&self) -> String {
        let mut all = String::new();
        for source in &self.files {
            if source.included_at.is_some() {
                all.push_str(&format!("** ---- file {} ----\n", source.name));
            }
            all.push_str(&source.text);
            if !source.text.is_empty() && !source.text.ends_with('\n') {
                all.push('\n');
            }
        }
        all
    }

    /// Places at which the file of `span` is included, the including file is included, and so on.
    pub fn include_chain(&self, span: Span) -> Vec<Span> {
        let parent = |span: &Span| self.get(span.file).and_then(Source::included_at);
        std::iter::successors(parent(&span), parent).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_those_of_the_text() {
        let lines: Vec<String> = (0..3000).map(|i| "x".repeat(i % 7)).collect();
        for end in ["\n", "\r\n"] {
            let mut sources = Sources::new();
            let file = sources.add("deck.inp", lines.join(end) + end, None);
            let source = sources.get(file).expect("a file");
            for (line, number) in lines.iter().zip(1..) {
                assert_eq!(source.line(number), Some(line.as_str()));
            }
            assert_eq!((source.line(0), source.line(3001)), (None, None));
            assert_eq!(source.line_count(), lines.len());
        }
    }
}
