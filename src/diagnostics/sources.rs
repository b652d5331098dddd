//! Texts of the main deck and its included files: access by line, and the chain of includes.

use super::{FileId, Span};
use memchr::memchr_iter;
use std::sync::{Arc, OnceLock};

/// Lines between those whose place is kept.
const STRIDE: usize = 256;

/// One file of a deck.
#[derive(Debug, Clone)]
pub struct Source {
    name: String,
    text: Arc<String>,
    included_at: Option<Span>,
    /// Bytes at which every [`STRIDE`]th line starts, found for the first message.
    line_starts: OnceLock<Vec<usize>>,
}

impl Source {
    /// Name as given on the command line, or its path from the folder of the including file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Text without byte order mark.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The same text, shared.
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

    fn line_starts(&self) -> &[usize] {
        self.line_starts.get_or_init(|| {
            let ends = memchr_iter(b'\n', self.text.as_bytes());
            let starts = ends.skip(STRIDE - 1).step_by(STRIDE).map(|at| at + 1);
            std::iter::once(0).chain(starts).collect()
        })
    }

    /// Line `number`, from 1, without its end.
    pub fn line(&self, number: u32) -> Option<&str> {
        let index = (number as usize).checked_sub(1)?;
        let start = *self.line_starts().get(index / STRIDE)?;
        let lines = self.text.get(start..).filter(|text| !text.is_empty())?;
        let line = lines.split_terminator('\n').nth(index % STRIDE)?;
        Some(line.strip_suffix('\r').unwrap_or(line))
    }
}

/// The texts of a deck and of the files it includes.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    files: Vec<Source>,
    /// Names of the instances of parts, and where each is placed.
    instances: Vec<(String, Span)>,
}

impl Sources {
    /// No files yet.
    pub fn new() -> Sources {
        Sources::default()
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
            line_starts: OnceLock::new(),
        });
        id
    }

    /// The id of the file that is added next.
    pub fn next_id(&self) -> FileId {
        FileId(self.files.len() as u32)
    }

    /// Adds an instance of a part that is placed at `place`; its number is that of spans.
    pub fn add_instance(&mut self, name: &str, place: Span) -> u32 {
        self.instances.push((name.to_string(), place));
        self.instances.len() as u32
    }

    /// Name and place of the instance that a span belongs to.
    pub fn instance_of(&self, span: Span) -> Option<(&str, Span)> {
        let index = (span.instance as usize).checked_sub(1)?;
        let (name, place) = self.instances.get(index)?;
        Some((name, *place))
    }

    /// The file of an id.
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

    /// The texts of all files, each but the first headed by a comment line with its name.
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

    /// Where the file of `span` is included, where that file is included, and so on.
    pub fn include_chain(&self, span: Span) -> Vec<Span> {
        let parent = |span: &Span| self.get(span.file).and_then(Source::included_at);
        std::iter::successors(parent(&span), parent).collect()
    }
}
