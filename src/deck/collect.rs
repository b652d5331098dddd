//! Files of a deck: reading them with the files that they include, cutting them into logical lines,
//! and collecting these into cards. Cards with a reported error are left out.

use super::card::{Card, Instance, Rows};
use super::content::{Content, LONGEST_USUAL_LINE};
use super::keywords::{Data, Keyword, Status};
use super::lines::{Fields, Kind, Line, Lines, assignment};
use super::resolve;
use super::resolve::Piece;
use super::text::Text;
use crate::diagnostics::{Code, Diagnostic, Diagnostics, FileId, Severity, Source, Sources, Span};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// All cards of a deck.
#[derive(Debug, Clone, Default)]
pub struct Deck {
    /// Cards whose keyword is known, in order, included files in their place.
    pub cards: Vec<Card>,
    /// Whether a file is missing, which is reported: it might define any name.
    pub incomplete: bool,
    /// Whether a card is left out because of a reported error.
    pub dropped: bool,
    /// Keys of the names that the cards left out may define.
    pub suspects: HashSet<String>,
    /// Instances of parts; spans number them from 1.
    pub instances: Vec<Instance>,
}

impl Deck {
    /// The instance that a span belongs to.
    pub fn instance_of(&self, span: Span) -> Option<&Instance> {
        let index = (span.instance as usize).checked_sub(1)?;
        self.instances.get(index)
    }

    /// Number of the instance with this name.
    pub fn instance(&self, key: &str) -> Option<u32> {
        let mut all = self.instances.iter().zip(1..);
        let found = all.find(|(instance, _)| instance.name.key == key);
        found.map(|(_, number)| number)
    }
}

/// A file named on a keyword line.
pub(crate) struct Inclusion {
    /// Path as typed.
    pub path: String,
    /// Place of the path.
    pub span: Span,
    /// Whether it may hold data lines only.
    pub rows_only: bool,
}

/// The text of a file.
#[derive(Clone, Copy)]
pub(crate) struct FileText<'a> {
    /// The whole text.
    pub source: &'a Arc<String>,
    /// Whether it is [plain](crate::deck::lines::Content::is_plain).
    pub is_plain: bool,
}

/// What happens to data lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RowRule {
    /// No keyword yet.
    Stray,
    /// They belong to the last card.
    Keep,
    /// They are left out.
    Skip,
    /// The last card takes none.
    Refuse,
}

/// Collects the lines of a deck into cards.
pub(crate) struct Collector {
    /// The cards so far.
    pub deck: Deck,
    rows: RowRule,
}

impl Collector {
    /// No cards yet.
    pub fn new() -> Collector {
        Collector {
            deck: Deck::default(),
            rows: RowRule::Stray,
        }
    }

    /// Adds data lines of a file to the last card.
    pub fn data(&mut self, lines: Lines, file: FileText, d: &mut Diagnostics) {
        match (self.rows, self.deck.cards.last_mut()) {
            (RowRule::Skip, _) => {}
            (RowRule::Keep, Some(card)) => {
                let may_hold_quotes = !file.is_plain && card.keyword.data != Data::Text;
                if may_hold_quotes && lines.text().contains('"') {
                    lines.data().for_each(|line| line.check_quotes(d));
                }
                let is_ascii = file.is_plain || lines.text().is_ascii();
                card.rows.add(lines, file.source, is_ascii);
            }
            (RowRule::Refuse, Some(card)) => {
                let message = format!("{} takes no data lines", card.title());
                self.refuse(lines, message, d);
            }
            (_, _) => self.refuse(lines, "a data line before the first keyword".into(), d),
        }
    }

    /// Whether the next data line is free text or left out.
    pub fn in_free_text(&self) -> bool {
        let text = self
            .deck
            .cards
            .last()
            .is_some_and(|c| c.keyword.data == Data::Text);
        self.rows == RowRule::Skip || (self.rows == RowRule::Keep && text)
    }

    /// Reports the first of the lines.
    fn refuse(&mut self, lines: Lines, message: String, d: &mut Diagnostics) {
        if let Some(line) = lines.data().next() {
            let span = line.visible_span();
            d.push(Diagnostic::error(Code::StrayData, span, message));
        }
        self.rows = RowRule::Skip;
    }

    /// Adds a keyword line; returns the file that it names.
    pub fn keyword(&mut self, pieces: &[Piece], d: &mut Diagnostics) -> Option<Inclusion> {
        let (first, rest) = pieces.split_first()?;
        let Some(keyword) = resolve::keyword(first.text, d) else {
            if !d.is_lenient() {
                self.drop_card(rest);
            }
            self.rows = RowRule::Skip;
            return None;
        };
        if keyword.status != Status::Read {
            if keyword.status == Status::Refused {
                self.drop_card(rest);
            }
            self.start(keyword, first.text.span, RowRule::Skip);
            return None;
        }
        if keyword.name == "INCLUDE" {
            return self.inclusion(keyword, first, rest, d);
        }
        let rows = match keyword.data {
            Data::None => RowRule::Refuse,
            Data::Rows(_) | Data::Required(_) | Data::Text => RowRule::Keep,
            Data::Words | Data::Skipped => RowRule::Skip,
        };
        self.start(keyword, first.text.span, rows);
        self.parameters(rest, d);
        self.input()
    }

    fn start(&mut self, keyword: &'static Keyword, span: Span, rows: RowRule) {
        self.rows = rows;
        self.deck.cards.push(Card {
            keyword,
            span,
            faulty: false,
            rows: Rows::default(),
            params: Vec::new(),
        });
    }

    /// The file of `*INCLUDE`, whose lines continue the card before it.
    fn inclusion(
        &mut self,
        keyword: &'static Keyword,
        first: &Piece,
        rest: &[Piece],
        d: &mut Diagnostics,
    ) -> Option<Inclusion> {
        let rows = self.rows;
        self.start(keyword, first.text.span, rows);
        self.parameters(rest, d);
        let card = self.deck.cards.pop()?;
        let path = card.required("INPUT", d);
        self.deck.incomplete |= path.is_none();
        path.map(|path| inclusion(path, false))
    }

    /// The file that the last card takes its data lines from.
    fn input(&self) -> Option<Inclusion> {
        let path = self.deck.cards.last()?.value("INPUT")?;
        Some(inclusion(path, true))
    }

    /// Leaves out a card with a reported error, and the names that it defines.
    fn drop_card(&mut self, pieces: &[Piece]) {
        self.deck.dropped = true;
        self.suspect(pieces);
    }

    /// Records the names that a card with a reported error may define.
    fn suspect(&mut self, pieces: &[Piece]) {
        for piece in pieces {
            if let Some((value, _)) = assignment(piece.text.text).value {
                let text = Text {
                    text: value,
                    span: piece.text.span,
                };
                self.deck.suspects.insert(text.name_key());
            }
        }
    }

    fn parameters(&mut self, pieces: &[Piece], d: &mut Diagnostics) {
        for piece in pieces.iter().filter(|piece| !piece.text.is_empty()) {
            let Some(card) = self.deck.cards.last_mut() else {
                return;
            };
            let errors = d.count(Severity::Error);
            let param = resolve::parameter(card, piece, d);
            let faulty = d.count(Severity::Error) > errors;
            card.faulty |= faulty;
            match param {
                Some(param) => card.params.push(param),
                None if faulty => self.suspect(std::slice::from_ref(piece)),
                None => {}
            }
            // numbers of a data line that a comma has drawn in: one message is enough
            if faulty && piece.continued && begins_as_a_number(piece.text) {
                return;
            }
        }
    }
}

fn inclusion(path: Text, rows_only: bool) -> Inclusion {
    Inclusion {
        path: path.text.trim_matches('"').to_string(),
        span: path.span,
        rows_only,
    }
}

fn begins_as_a_number(text: Text) -> bool {
    let first = text.text.trim_start().chars().next();
    first.is_some_and(|c| c.is_ascii_digit() || "+-.".contains(c))
}

/// Deepest nesting of included files.
const DEEPEST: usize = 20;

/// Most files of one deck.
const MOST_FILES: usize = 1000;

/// Reads a deck and the files it includes.
pub fn read(path: &Path, sources: &mut Sources, d: &mut Diagnostics) -> Deck {
    let name = path.display().to_string();
    match content_of(path) {
        Ok(content) => {
            let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
            let open = vec![(identity(path), folder)];
            collect(&name, content, open, sources, d)
        }
        Err(why) => {
            let message = format!("cannot read {name}: {why}");
            d.push(Diagnostic::error_without_place(
                Code::FileUnreadable,
                message,
            ));
            Deck {
                incomplete: true,
                ..Deck::default()
            }
        }
    }
}

/// Reads a deck from text; it cannot include files.
pub fn parse_str(name: &str, text: &str, sources: &mut Sources, d: &mut Diagnostics) -> Deck {
    collect(name, Content::new(text), Vec::new(), sources, d)
}

fn collect(
    name: &str,
    content: Content,
    open: Vec<(PathBuf, PathBuf)>,
    sources: &mut Sources,
    d: &mut Diagnostics,
) -> Deck {
    let added = add(sources, name, content, None);
    let file = added.file;
    let mut reading = Reading {
        sources,
        d,
        collector: Collector::new(),
        open,
    };
    reading.content(added, false);
    let deck = reading.collector.deck;
    if deck.cards.is_empty() && !d.has_errors() {
        let start = Span {
            file,
            line: 1,
            column: 1,
            length: 1,
            instance: 0,
        };
        let message = format!("{name} holds no keyword");
        let error = Diagnostic::error(Code::EmptyDeck, start, message);
        d.push(error.help("a keyword line begins with one star, such as *NODE"));
    }
    deck
}

/// A file that is added to the sources.
struct Added {
    file: FileId,
    /// What is wrong with its content.
    complaint: Option<Diagnostic>,
    /// Whether its content is plain.
    is_plain: bool,
}

/// Adds a file with its content.
fn add(sources: &mut Sources, name: &str, content: Content, included_at: Option<Span>) -> Added {
    Added {
        complaint: content.complaint(sources.next_id()),
        is_plain: content.is_plain,
        file: sources.add(name, content.text, included_at),
    }
}

/// A deck being read.
struct Reading<'a> {
    sources: &'a mut Sources,
    d: &'a mut Diagnostics,
    collector: Collector,
    /// The files being read, outermost first: canonical path and folder of each.
    open: Vec<(PathBuf, PathBuf)>,
}

impl Reading<'_> {
    /// Reads the lines of a file; reports content that is not text of a deck.
    fn content(&mut self, added: Added, rows_only: bool) {
        let source = self.sources.get(added.file).map(Source::shared_text);
        match (added.complaint, source) {
            (Some(complaint), _) => {
                self.collector.deck.incomplete = true;
                self.d.push(complaint);
            }
            (None, Some(source)) => {
                let text = FileText {
                    source: &source,
                    is_plain: added.is_plain,
                };
                self.lines(added.file, text, rows_only);
            }
            (None, None) => {}
        }
    }

    /// Feeds the lines of a file to the collector.
    fn lines(&mut self, file: FileId, text: FileText, rows_only: bool) {
        let mut rest = Lines::new(file, text.source);
        while let Some(line) = rest.next() {
            match line.kind() {
                Kind::Blank | Kind::Comment => {}
                Kind::Data => {
                    let block = rest.take_block(&line);
                    if !text.is_plain {
                        self.remark_on_block(block);
                    }
                    self.collector.data(block, text, self.d);
                }
                Kind::Keyword if rows_only => return self.keyword_among_rows(&line),
                Kind::Keyword => self.keyword(&line, &mut rest),
            }
        }
    }

    /// A keyword line with its continuation lines, which are taken from `rest`.
    fn keyword(&mut self, line: &Line, rest: &mut Lines) {
        let more = continuation(line, rest);
        let mut pieces = pieces(line, false, self.d);
        self.remark_on_form(line);
        for line in &more {
            self.remark_on_form(line);
            pieces.extend(self::pieces(line, true, self.d));
        }
        if let Some(inclusion) = self.collector.keyword(&pieces, self.d) {
            self.include(&inclusion);
        }
    }

    fn keyword_among_rows(&mut self, line: &Line) {
        let message = "a keyword in a file that holds data lines only";
        let help = "use *INCLUDE to read a file with keywords";
        let span = line.visible_span();
        self.d
            .push(Diagnostic::error(Code::WrongPlace, span, message).help(help));
    }

    fn remark_on_block(&mut self, block: Lines) {
        if !block.text().is_ascii() || !block.fit(LONGEST_USUAL_LINE) {
            block.data().for_each(|line| self.remark_on_form(&line));
        }
    }

    fn remark_on_form(&mut self, line: &Line) {
        let is_ascii = line.text.is_ascii();
        if is_ascii && line.text.len() <= LONGEST_USUAL_LINE {
            return;
        }
        if line.text.chars().count() > LONGEST_USUAL_LINE {
            let message = "a line of more than 256 characters";
            self.d.push_once(
                Diagnostic::warning(Code::LongLine, line.span(0, 1), message)
                    .help("all of it is read here; Abaqus will refuse it"),
            );
        }
        let strange = line.text.char_indices().find(|(_, c)| !c.is_ascii());
        if let (false, Some((at, c))) = (self.collector.in_free_text(), strange) {
            let span = line.span(at, at + c.len_utf8());
            let message = "a character outside ASCII, which other codes may not read";
            self.d
                .push_once(Diagnostic::warning(Code::NonAscii, span, message));
        }
    }

    /// Reads an included file in the place where it is named.
    fn include(&mut self, inclusion: &Inclusion) {
        match self.open_included(inclusion) {
            Ok((name, path, content)) => {
                let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
                let span = Some(inclusion.span);
                let added = add(self.sources, &name, content, span);
                self.open.push((identity(&path), folder));
                self.content(added, inclusion.rows_only);
                self.open.pop();
            }
            Err((code, why)) => {
                self.collector.deck.incomplete = true;
                let message = format!("cannot include `{}`: {why}", inclusion.path);
                self.d
                    .push(Diagnostic::error(code, inclusion.span, message));
            }
        }
    }

    /// Name, path and content of an included file.
    fn open_included(
        &self,
        inclusion: &Inclusion,
    ) -> Result<(String, PathBuf, Content), (Code, String)> {
        let path = self
            .find(&inclusion.path)
            .map_err(|why| (Code::FileUnreadable, why))?;
        let identity = identity(&path);
        if self.open.iter().any(|(open, _)| *open == identity) {
            return Err((Code::IncludeCycle, "the file includes itself".to_string()));
        }
        if self.open.len() > DEEPEST || self.sources.files().len() > MOST_FILES {
            let why = format!("more than {DEEPEST} levels or {MOST_FILES} files");
            return Err((Code::IncludeCycle, why));
        }
        let content = content_of(&path).map_err(|why| (Code::FileUnreadable, why))?;
        Ok((path.display().to_string(), path, content))
    }

    /// Path of a file relative to the including file, or else to the main deck.
    fn find(&self, path: &str) -> Result<PathBuf, String> {
        let (Some(first), Some(last)) = (self.open.first(), self.open.last()) else {
            return Err("this deck was not read from a file".to_string());
        };
        let near = last.1.join(path);
        let far = first.1.join(path);
        match (near.exists(), far.exists()) {
            (true, _) => Ok(near),
            (false, true) => Ok(far),
            (false, false) => Err(format!("no such file ({})", near.display())),
        }
    }
}

/// The data lines that continue a keyword line ending with a comma, taken from the lines after it.
fn continuation<'l>(first: &Line, rest: &mut Lines<'l>) -> Vec<Line<'l>> {
    let mut more = Vec::new();
    let mut open = first.ends_with_comma();
    while open {
        let silent = |line: &Line| matches!(line.kind(), Kind::Blank | Kind::Comment);
        let mut after = *rest;
        match after.find(|line| !silent(line)) {
            Some(line) if line.kind() == Kind::Data => {
                open = line.ends_with_comma();
                more.push(line);
                *rest = after;
            }
            _ => open = false,
        }
    }
    more
}

/// The pieces of a keyword line between commas.
fn pieces<'l>(line: &Line<'l>, continued: bool, d: &mut Diagnostics) -> Vec<Piece<'l>> {
    line.check_quotes(d);
    Fields::new(line.text)
        .map(|(start, end)| Piece {
            text: Text {
                text: line.text.get(start..end).unwrap_or(""),
                span: line.span(start, end),
            },
            continued,
        })
        .collect()
}

fn content_of(path: &Path) -> Result<Content, String> {
    if path.is_dir() {
        return Err("it is a folder".to_string());
    }
    let content = match std::fs::metadata(path) {
        Ok(data) if data.is_file() => Content::of(path),
        Ok(_) => return Err("it is not a regular file".to_string()),
        Err(error) => Err(error),
    };
    content.map_err(|error| reason(&error))
}

fn reason(error: &std::io::Error) -> String {
    match error.kind() {
        std::io::ErrorKind::NotFound => "no such file".to_string(),
        std::io::ErrorKind::PermissionDenied => "permission denied".to_string(),
        _ => error.to_string(),
    }
}

/// Canonical path of a file, the same for all paths to it.
fn identity(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_path_buf())
}
