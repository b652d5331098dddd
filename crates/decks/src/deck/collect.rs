//! Reads the files of a deck with the files that they include, cuts them into logical lines, and collects the lines
//! into cards. Cards with a reported error are left out.

use super::card::{Card, DataLines, Instance};
use super::content::Content;
use super::keywords::{Data, Keyword, Status};
use super::lines::{Line, LineKind, Lines, overlong};
use super::parameters::Parameters;
use super::resolve::{self, Piece};
use super::text::Text;
use crate::diagnostics::{
    Code, Diagnostics, EarlierDeck, FileId, Interrupt, Severity, Source, Sources, Span, whole_path,
};
use memchr::memchr;
use std::collections::HashSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// All cards of a deck.
#[derive(Debug, Clone, Default)]
pub struct Deck {
    /// Cards with a known keyword in the order of the deck; the cards of an included file stand in its place.
    pub cards: Vec<Card>,
    /// Whether a file is missing (which has been reported), so that it might define any name.
    pub incomplete: bool,
    /// Whether a card is left out because of a reported error.
    pub dropped: bool,
    /// Keys of names that may be defined by cards that are left out.
    pub suspects: HashSet<String>,
    /// Instances of parts; a span refers to an instance by its number, from 1.
    pub instances: Vec<Instance>,
    /// Object that tells whether the reading has been cancelled.
    pub interrupt: Interrupt,
}

impl Deck {
    /// The instance that a span belongs to.
    pub fn instance_of(&self, span: Span) -> Option<&Instance> {
        let index = (span.instance as usize).checked_sub(1)?;
        self.instances.get(index)
    }

    /// All cards of a keyword.
    pub fn cards_of(&self, keyword: &str) -> impl Iterator<Item = &Card> {
        let cards = self.cards.iter();
        cards.filter(move |card| card.keyword.name == keyword)
    }

    /// Number of the instance with a given name.
    pub fn instance(&self, key: &str) -> Option<u32> {
        let mut all = self.instances.iter().zip(1..);
        let found = all.find(|(instance, _)| instance.name.key == key);
        found.map(|(_, number)| number)
    }
}

/// Deepest nesting of included files.
const DEEPEST: usize = 20;

/// Largest number of files of one deck.
const MOST_FILES: usize = 1000;

/// Cards of the model that may stand in the deck of a job that continues an earlier job.
const ADDED: [&str; 8] = [
    "HEADING",
    "AMPLITUDE",
    "NSET",
    "ELSET",
    "SURFACE",
    "TIME POINTS",
    "NO ANALYSIS",
    "RESTART",
];

/// Length of the longest line that other codes read.
const LONGEST_USUAL_LINE: usize = 256;

/// Reads a deck and the files it includes.
pub(super) fn read(path: &Path, sources: &mut Sources, d: &mut Diagnostics) -> Deck {
    let name = path.display().to_string();
    match content_of(path, sources) {
        Ok(content) => collect(&name, content, vec![OpenFile::new(path)], sources, d),
        Err(why) => {
            d.error_without_place(Code::FileUnreadable, format!("cannot read {name}: {why}"));
            Deck {
                incomplete: true,
                ..Deck::default()
            }
        }
    }
}

/// Reads a deck from text, which cannot include files.
pub(super) fn parse_str(
    name: &str,
    text: &str,
    sources: &mut Sources,
    d: &mut Diagnostics,
) -> Deck {
    collect(name, Content::new(text), Vec::new(), sources, d)
}

fn collect(
    name: &str,
    content: Content,
    open: Vec<OpenFile>,
    sources: &mut Sources,
    d: &mut Diagnostics,
) -> Deck {
    let parameters = Parameters::new(sources.settings(), d);
    let file = sources.next_id();
    let mut collector = Collector {
        sources,
        d,
        deck: Deck::default(),
        rows: RowRule::Stray,
        open,
        parameters,
        earlier: None,
        earlier_files: Vec::new(),
        earlier_steps: None,
    };
    let earlier = collector.sources.earlier().cloned();
    collector.earlier = earlier.map(Box::new);
    collector.content(name, content, None, false);
    collector.put_steps_behind();
    if let (Some(_), false) = (&collector.earlier, collector.deck.incomplete) {
        let message =
            "the command line names a job to go on from, and the deck has no *RESTART, READ";
        collector.d.error_without_place(Code::EarlierJob, message);
    }
    if !collector.deck.incomplete && !collector.deck.dropped {
        collector.parameters.finish(collector.d);
    }
    let mut deck = collector.deck;
    deck.interrupt = sources.interrupt().clone();
    if deck.cards.is_empty() && !d.has_errors() {
        let start = Span::start_of(file);
        d.error(Code::EmptyDeck, start, format!("{name} holds no keyword"))
            .help("a keyword line begins with one star, such as *NODE");
    }
    deck
}

/// A file being read.
struct OpenFile {
    /// Canonical path of the file, which is the same for all paths to the file.
    identity: PathBuf,
    /// Folder of the file.
    folder: PathBuf,
}

impl OpenFile {
    fn new(path: &Path) -> OpenFile {
        OpenFile {
            identity: whole_path(path),
            folder: path.parent().unwrap_or(Path::new("")).to_path_buf(),
        }
    }
}

/// Treatment of the data lines that come next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RowRule {
    /// No keyword stands before the data lines.
    Stray,
    /// The data lines belong to the last card.
    Keep,
    /// The data lines define parameters.
    Define,
    /// The data lines are left out.
    Skip,
    /// The last card cannot have data lines, so data lines are an error.
    Refuse,
}

/// Collects the lines of a deck into cards.
struct Collector<'a> {
    sources: &'a mut Sources,
    d: &'a mut Diagnostics,
    /// The cards so far.
    deck: Deck,
    rows: RowRule,
    /// The files being read, outermost first.
    open: Vec<OpenFile>,
    parameters: Parameters,
    /// The deck of the earlier job that the deck being read continues.
    earlier: Option<Box<EarlierDeck>>,
    /// Texts of the files of the earlier deck that is being read, by their names.
    earlier_files: Vec<(String, String)>,
    /// Range of the cards of the steps of the earlier deck; the range ends where the cards of the earlier deck end.
    earlier_steps: Option<Range<usize>>,
}

impl Collector<'_> {
    /// Reads the lines of a file, which may hold data lines only; reports a file that is not the text of a deck.
    fn content(
        &mut self,
        name: &str,
        content: Content,
        included_at: Option<Span>,
        rows_only: bool,
    ) {
        let complaint = content.complaint(self.sources.next_id());
        let file = self.sources.add(name, content.text, included_at);
        if let Some(complaint) = complaint {
            self.deck.incomplete = true;
            self.d.push(complaint);
        } else if let Some(source) = self.sources.get(file).map(Source::shared_text) {
            self.lines(file, &source, rows_only);
        }
    }

    fn lines(&mut self, file: FileId, source: &Arc<String>, rows_only: bool) {
        let mut rest = Lines::new(file, source);
        loop {
            let here = rest;
            let Some(line) = rest.next() else { return };
            self.sources.interrupt().end_if_asked();
            match line.kind() {
                LineKind::Blank | LineKind::Comment => {}
                LineKind::Data => {
                    rest = here;
                    self.data(rest.take_block(), source);
                }
                LineKind::Keyword if rows_only => {
                    let message = "a keyword in a file that holds data lines only";
                    self.d
                        .error(Code::WrongPlace, line.span(), message)
                        .help("use *INCLUDE to read a file with keywords");
                    return;
                }
                LineKind::Keyword => self.keyword_line(line, &mut rest),
            }
        }
    }

    /// Adds data lines to the last card.
    fn data(&mut self, lines: Lines, source: &Arc<String>) {
        let text = lines.rest();
        if !text.is_ascii() || overlong(text.as_bytes(), LONGEST_USUAL_LINE).is_some() {
            lines.data().for_each(|line| self.remark_on_form(line));
        }
        match (self.rows, self.deck.cards.last_mut()) {
            (RowRule::Skip, _) => {}
            (RowRule::Define, _) => {
                lines
                    .data()
                    .for_each(|line| self.parameters.define(line, self.d));
            }
            (RowRule::Keep, Some(card)) => {
                if card.keyword.data != Data::Text && text.contains('"') {
                    lines.data().for_each(|line| line.check_quotes(self.d));
                }
                let has_names = memchr(b'<', text.as_bytes()).is_some();
                match has_names && card.keyword.data != Data::Text {
                    true => {
                        let replaced = self.parameters.replaced(lines, self.sources, self.d);
                        card.rows.add(Lines::at(lines, &replaced), &replaced);
                        if self.parameters.take_failure() {
                            self.deck.cards.pop();
                            self.deck.dropped = true;
                            self.rows = RowRule::Skip;
                        }
                    }
                    false => card.rows.add(lines, source),
                }
            }
            (RowRule::Refuse, Some(card)) => {
                let message = format!("{} takes no data lines", card.title());
                self.refuse(lines, message);
            }
            (_, _) => self.refuse(lines, "a data line before the first keyword".into()),
        }
    }

    /// Reports an error at the first of some lines.
    fn refuse(&mut self, lines: Lines, message: String) {
        if let Some(line) = lines.data().next() {
            self.d.error(Code::StrayData, line.span(), message);
        }
        self.rows = RowRule::Skip;
    }

    /// Reports parts of a line that other codes may not read.
    fn remark_on_form(&mut self, line: Line) {
        if line.text.chars().count() > LONGEST_USUAL_LINE {
            let message = "a line of more than 256 characters";
            self.d
                .warning_once(Code::LongLine, line.span_of(0..1), message)
                .help("all of it is read here; Abaqus will refuse it");
        }
        let last = self.deck.cards.last();
        let in_text = last.is_some_and(|card| card.keyword.data == Data::Text);
        let are_free = matches!(self.rows, RowRule::Skip | RowRule::Define);
        let is_free = are_free || (self.rows == RowRule::Keep && in_text);
        let strange = line.text.char_indices().find(|(_, c)| !c.is_ascii());
        if let (false, Some((at, c))) = (is_free, strange) {
            let span = line.span_of(at..at + c.len_utf8());
            let message = "a character outside ASCII, which other codes may not read";
            self.d.warning_once(Code::NonAscii, span, message);
        }
    }

    /// Adds a keyword line with its continuation lines from `rest`, and reads the file that it names.
    fn keyword_line<'l>(&mut self, line: Line<'l>, rest: &mut Lines<'l>) {
        let mut pieces = Vec::new();
        let lines = continued(line, rest);
        let replace = |line: &Line| self.parameters.replace(*line, self.sources, self.d);
        let replaced: Vec<Option<String>> = lines.iter().map(replace).collect();
        for (index, (line, replaced)) in lines.iter().zip(&replaced).enumerate() {
            let line = Line {
                text: replaced.as_deref().unwrap_or(line.text),
                ..*line
            };
            line.check_quotes(self.d);
            self.remark_on_form(line);
            pieces.extend(line.fields().map(|text| Piece {
                text,
                continued: index > 0,
            }));
        }
        let Some((first, rest)) = pieces.split_first() else {
            return;
        };
        if self.parameters.take_failure() {
            self.drop_card(rest);
            self.rows = RowRule::Skip;
            return;
        }
        let span = first.text.span;
        let errors = self.d.count(Severity::Error);
        let Some(keyword) = resolve::keyword(first.text, self.d) else {
            if self.d.count(Severity::Error) > errors {
                self.drop_card(rest);
            }
            self.rows = RowRule::Skip;
            return;
        };
        if keyword.status != Status::Read {
            if keyword.status == Status::Refused {
                self.drop_card(rest);
            }
            self.start(keyword, span, RowRule::Skip);
            return;
        }
        // the lines of an included file continue the card before it
        let is_inclusion = keyword.name == "INCLUDE";
        let defines = keyword.name == "PARAMETER";
        let rows = match keyword.data {
            _ if is_inclusion => self.rows,
            _ if defines => RowRule::Define,
            Data::None => RowRule::Refuse,
            Data::Rows(_) | Data::Required(_) | Data::Text => RowRule::Keep,
            Data::Words | Data::Skipped => RowRule::Skip,
        };
        self.start(keyword, span, rows);
        self.parameters(rest);
        let path = match self.deck.cards.last() {
            Some(card) if is_inclusion => card.required("INPUT", self.d),
            Some(card) => card.value("INPUT"),
            None => None,
        };
        let path = path.map(|path| (path.text.trim_matches('"').to_string(), path.span));
        if keyword.name == "RESTART" && self.deck.cards.last().is_some_and(|card| card.has("READ"))
        {
            self.go_on_from_earlier();
            return;
        }
        if is_inclusion || defines {
            self.deck.cards.pop();
            self.deck.incomplete |= is_inclusion && path.is_none();
        }
        if let Some((path, span)) = path {
            self.include(&path, span, !is_inclusion);
        }
    }

    fn start(&mut self, keyword: &'static Keyword, span: Span, rows: RowRule) {
        self.rows = rows;
        self.deck.cards.push(Card {
            keyword,
            span,
            faulty: false,
            added: false,
            rows: DataLines::default(),
            params: Vec::new(),
        });
    }

    /// Leaves out a card with a reported error; records the names that the card defines.
    fn drop_card(&mut self, pieces: &[Piece]) {
        self.deck.dropped = true;
        pieces.iter().for_each(|piece| self.suspect(piece));
    }

    /// Records the name that a part of the deck with a reported error may define.
    fn suspect(&mut self, piece: &Piece) {
        let (_, value) = piece.text.assignment();
        self.deck
            .suspects
            .extend(value.map(|value| value.name_key()));
    }

    fn parameters(&mut self, pieces: &[Piece]) {
        for piece in pieces.iter().filter(|piece| !piece.text.is_empty()) {
            let Some(card) = self.deck.cards.last_mut() else {
                return;
            };
            let errors = self.d.count(Severity::Error);
            let param = resolve::parameter(card, piece, self.d);
            let faulty = self.d.count(Severity::Error) > errors;
            card.faulty |= faulty;
            match param {
                Some(param) => card.params.push(param),
                None if faulty => self.suspect(piece),
                None => {}
            }
            // numbers of a data line that a comma has drawn in: one message is enough
            if faulty && piece.continued && begins_as_a_number(piece.text) {
                return;
            }
        }
    }

    /// Reads the deck of the earlier job in the place of the last card, `*RESTART, READ`, up to the step of the
    /// checkpoint.
    fn go_on_from_earlier(&mut self) {
        self.rows = RowRule::Refuse;
        let Some(card) = self.deck.cards.pop() else {
            return;
        };
        let is_first = (self.deck.cards.iter()).all(|card| card.keyword.name == "HEADING");
        let Some(earlier) = self.earlier.take().filter(|_| is_first) else {
            self.deck.incomplete = true;
            match is_first {
                true => self
                    .d
                    .error(
                        Code::EarlierJob,
                        card.span,
                        "which job does this deck go on from?",
                    )
                    .help(
                        "--oldjob JOB on the command line names it: its checkpoint is JOB.restart",
                    ),
                false => self.d.error(
                    Code::WrongPlace,
                    card.span,
                    "*RESTART, READ stands before all other cards but *HEADING",
                ),
            };
            return;
        };
        self.check_place(&card, &earlier);
        let EarlierDeck {
            files,
            settings,
            place: [steps, _],
            ends_step: _,
            before,
        } = *earlier;
        let Some((name, text)) = files.first().cloned() else {
            return;
        };
        let parameters = Parameters::new(&settings, self.d);
        let parameters = std::mem::replace(&mut self.parameters, parameters);
        let open = std::mem::replace(&mut self.open, vec![OpenFile::new(Path::new(&name))]);
        let files = std::mem::replace(&mut self.earlier_files, files);
        self.earlier = before;
        let first = self.deck.cards.len();
        self.content(&name, Content::new(&text), Some(card.span), false);
        self.put_steps_behind();
        (self.parameters, self.open, self.earlier_files) = (parameters, open, files);
        let mut begins = (first..self.deck.cards.len())
            .filter(|&index| self.deck.cards[index].keyword.name == "STEP");
        let first_step = begins.next().unwrap_or(self.deck.cards.len());
        if let Some(after) = steps.checked_sub(1).and_then(|others| begins.nth(others)) {
            self.deck.cards.truncate(after);
        }
        self.earlier_steps = Some(first_step..self.deck.cards.len());
        if card.has("WRITE") {
            self.deck.cards.push(card);
        }
        self.rows = RowRule::Refuse;
    }

    /// Checks that `*RESTART, READ` names the step and increment of the checkpoint.
    fn check_place(&mut self, card: &Card, earlier: &EarlierDeck) {
        let [step, increment] = earlier.place;
        let asked = |name, d: &mut Diagnostics| card.integer(name, d).map(|number| number as usize);
        let (asked_step, asked_increment) = (asked("STEP", self.d), asked("INC", self.d));
        let ends_there =
            card.has("END STEP") || (asked_step.is_some() && asked_increment.is_none());
        let message = if asked_step.is_some_and(|asked| asked != step)
            || asked_increment.is_some_and(|asked| asked != increment)
        {
            format!("the checkpoint is of increment {increment} of step {step}")
        } else if ends_there && !earlier.ends_step {
            format!(
                "the checkpoint is of increment {increment} of step {step}, which is not the end of the step"
            )
        } else {
            return;
        };
        self.d.error(Code::EarlierJob, card.span, message).help(
            "a checkpoint JOB.restart-STEP-INC that *RESTART, WRITE has kept is taken with --oldjob JOB.restart-STEP-INC",
        );
    }

    /// Moves the cards that a deck adds to the model of the earlier job in front of the steps of that job.
    fn put_steps_behind(&mut self) {
        let Some(Range { start, end }) = self.earlier_steps.take() else {
            return;
        };
        let cards = &mut self.deck.cards;
        let added = cards[end..].iter();
        let added = added.take_while(|card| card.keyword.name != "STEP").count();
        for card in &mut cards[..end] {
            card.added = false;
        }
        for card in &mut cards[end..end + added] {
            card.added = true;
            if card.keyword.status == Status::Read && !ADDED.contains(&card.keyword.name) {
                let message = format!("{} would change the model of the earlier job", card.title());
                self.d.error(Code::WrongPlace, card.span, message).help(
                    "before its steps this deck may have amplitudes, sets, surfaces, time points and *RESTART",
                );
            }
        }
        cards[start..end + added].rotate_left(end - start);
    }

    /// Reads a file that is named at `span`; the file may be restricted to data lines.
    fn include(&mut self, typed: &str, span: Span, rows_only: bool) {
        match self.open_included(typed) {
            Ok((path, content)) => {
                self.open.push(OpenFile::new(&path));
                let name = path.display().to_string();
                self.content(&name, content, Some(span), rows_only);
                self.open.pop();
            }
            Err((code, why)) => {
                self.deck.incomplete = true;
                let message = format!("cannot include `{typed}`: {why}");
                self.d.error(code, span, message);
            }
        }
    }

    /// Path and content of an included file.
    fn open_included(&self, path: &str) -> Result<(PathBuf, Content), (Code, String)> {
        let unreadable = |why| (Code::FileUnreadable, why);
        let path = self.find(path).map_err(unreadable)?;
        let identity = OpenFile::new(&path).identity;
        if self.open.iter().any(|open| open.identity == identity) {
            return Err((Code::IncludeCycle, "the file includes itself".to_string()));
        }
        if self.open.len() > DEEPEST || self.sources.files().len() > MOST_FILES {
            let why = format!("more than {DEEPEST} levels or {MOST_FILES} files");
            return Err((Code::IncludeCycle, why));
        }
        let name = path.display().to_string();
        let kept = self.earlier_files.iter().find(|(kept, _)| *kept == name);
        let content = match kept {
            Some((_, text)) => Content::new(text),
            None => content_of(&path, self.sources).map_err(unreadable)?,
        };
        Ok((path, content))
    }

    /// Path of a file, relative to the including file or, if there is no such file, to the main deck.
    fn find(&self, path: &str) -> Result<PathBuf, String> {
        let (Some(first), Some(last)) = (self.open.first(), self.open.last()) else {
            return Err("this deck was not read from a file".to_string());
        };
        let [near, far] = [last, first].map(|open| open.folder.join(path));
        let exists = |path: &Path| {
            let name = path.display().to_string();
            let is_open = self.sources.unsaved(path).is_some();
            is_open || path.exists() || self.earlier_files.iter().any(|(kept, _)| *kept == name)
        };
        match (exists(&near), exists(&far)) {
            (true, _) => Ok(near),
            (false, true) => Ok(far),
            (false, false) => Err(format!("no such file ({})", near.display())),
        }
    }
}

/// A keyword line and its continuation: while a line ends with a comma, the next line continues the keyword line.
fn continued<'l>(first: Line<'l>, rest: &mut Lines<'l>) -> Vec<Line<'l>> {
    let mut all = vec![first];
    while all.last().is_some_and(|line| line.ends_with_comma()) {
        let is_silent = |line: &Line| matches!(line.kind(), LineKind::Blank | LineKind::Comment);
        let mut after = *rest;
        match after.find(|line| !is_silent(line)) {
            Some(line) if line.kind() == LineKind::Data => {
                all.push(line);
                *rest = after;
            }
            _ => break,
        }
    }
    all
}

fn begins_as_a_number(text: Text) -> bool {
    let first = text.text.chars().next();
    first.is_some_and(|c| c.is_ascii_digit() || "+-.".contains(c))
}

/// Text of a file; a file that is open in an editor has the text of the editor.
fn content_of(path: &Path, sources: &Sources) -> Result<Content, String> {
    if let Some(text) = sources.unsaved(path) {
        return Ok(Content::new(text));
    }
    Content::of(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::IsADirectory => "it is a folder".to_string(),
        std::io::ErrorKind::NotFound => "no such file".to_string(),
        std::io::ErrorKind::PermissionDenied => "permission denied".to_string(),
        _ => error.to_string(),
    })
}
