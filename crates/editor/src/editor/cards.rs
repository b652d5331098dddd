//! The cards of a deck as they stand in its files, with or without errors: keyword lines with their pieces, data lines
//! that hold words, and the part or instance of each card.

use super::document::{Document, Mark, Spot, as_line};
use super::files::Files;
use crate::deck::{
    Data, Field, Keyword, LineKind, Name, Parameter, Quantity, Takes, Text, keyword_read_as,
};
use crate::diagnostics::{Span, whole_path};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Deepest nesting of included files, and largest number of files of a deck.
const MOST: (usize, usize) = (20, 1000);

/// The part, the instance or the deck to which the names of a card belong.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Scope {
    /// The whole deck.
    Deck,
    /// The part whose name has the given key.
    Part(Arc<str>),
    /// The instance whose name has the given key.
    Instance(Arc<str>),
}

/// A piece of a keyword line: `NAME` or `NAME=value`.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    /// Place of the whole piece.
    pub spot: Spot,
    /// The parameter that the piece means.
    pub parameter: Option<&'static Parameter>,
    /// The value of the parameter, and its place.
    pub value: Option<(String, Spot)>,
}

/// A keyword line with its continuation lines.
#[derive(Debug, Clone)]
pub(super) struct Head {
    /// Place of the keyword with its star.
    pub spot: Spot,
    /// The keyword that the line means.
    pub keyword: Option<&'static Keyword>,
    /// The pieces behind the keyword.
    pub pieces: Vec<Piece>,
    /// Last line.
    pub last: usize,
}

impl Head {
    /// The keyword line that begins at a line of a document.
    pub fn new(document: &Document, line: usize) -> Head {
        let mut head = Head {
            spot: Spot {
                line,
                start: 0,
                end: 0,
            },
            keyword: None,
            pieces: Vec::new(),
            last: line,
        };
        loop {
            let text = document.line(head.last);
            let all = as_line(&text);
            let mut fields = all.fields();
            if head.last == line
                && let Some(field) = fields.next()
            {
                head.spot = spot(line, field);
                head.keyword = keyword_read_as(field.text.trim_start_matches('*').trim());
            }
            for field in fields.filter(|field| !field.is_empty()) {
                head.pieces.push(Piece::new(head.keyword, field, head.last));
            }
            let next = all
                .ends_with_comma()
                .then(|| next_said(document, head.last));
            match next.flatten() {
                Some(next) if document.kind(next) == LineKind::Data => head.last = next,
                _ => return head,
            }
        }
    }

    /// The value of a parameter; empty for a parameter without value.
    pub fn value(&self, name: &str) -> Option<&str> {
        let piece = self.piece(name)?;
        Some(piece.value.as_ref().map_or("", |(value, _)| value))
    }

    /// The piece of a parameter.
    pub fn piece(&self, name: &str) -> Option<&Piece> {
        let is_meant = |piece: &&Piece| piece.parameter.is_some_and(|p| p.name == name);
        self.pieces.iter().find(is_meant)
    }

    /// Name of the keyword; empty if the keyword is unknown.
    pub fn name(&self) -> &'static str {
        self.keyword.map_or("", |keyword| keyword.name)
    }

    /// Kind of data lines of the keyword; data lines of an unknown keyword are skipped.
    pub fn data(&self) -> Data {
        self.keyword.map_or(Data::Skipped, |keyword| keyword.data)
    }

    /// The piece with the name that the card defines.
    pub fn defined(&self) -> Option<&Piece> {
        let (parameter, _) = self.keyword?.definition()?;
        self.piece(parameter.name)
    }
}

impl Piece {
    fn new(keyword: Option<&Keyword>, field: Text, line: usize) -> Piece {
        let (typed, value) = field.assignment();
        Piece {
            spot: spot(line, field),
            parameter: keyword.and_then(|keyword| keyword.parameter_read_as(typed)),
            value: value.map(|value| (value.text.to_owned(), spot(line, value))),
        }
    }
}

/// Place of a text, which is a part of a line.
pub(super) fn spot(line: usize, text: Text) -> Spot {
    let start = text.span.column as usize - 1;
    Spot {
        line,
        start,
        end: start + text.text.chars().count(),
    }
}

/// The next line that is neither blank nor a comment.
fn next_said(document: &Document, line: usize) -> Option<usize> {
    let mut after = line + 1..document.line_count();
    after.find(|&line| !matches!(document.kind(line), LineKind::Blank | LineKind::Comment))
}

/// A card.
#[derive(Debug, Clone)]
pub(super) struct Card {
    /// Number of the file of the card in the deck.
    pub file: usize,
    /// Keyword line of the card.
    pub head: Head,
    /// Scope of the names of the card.
    pub scope: Scope,
    /// Data lines of the card that hold words: file and line of each.
    pub rows: Vec<(usize, usize)>,
    /// Line behind the last line of the card in its file.
    pub end: usize,
}

/// A file of a deck.
#[derive(Debug, Clone)]
pub(super) struct DeckFile {
    /// Whole path of the file.
    pub path: PathBuf,
    /// Revision of the file that was read.
    revision: u64,
    /// The earlier card to which the first data lines of the file belong.
    pub continues: Option<usize>,
}

/// An instance of a part.
#[derive(Debug, Clone)]
pub(super) struct Instance {
    /// Name of the instance.
    pub name: Name,
    /// Key of the name of the part.
    pub part: Arc<str>,
}

/// All cards of a deck; the cards of an included file stand in its place.
#[derive(Debug, Clone)]
pub(super) struct Cards {
    /// The main deck and the files that it includes.
    pub files: Vec<DeckFile>,
    /// The cards in order.
    pub all: Vec<Card>,
    /// Instances of parts.
    pub instances: Vec<Instance>,
    /// Files that could not be read.
    missing: Vec<PathBuf>,
    scope: Scope,
}

impl Cards {
    /// The cards of the deck at a path.
    pub fn new(root: &Path, files: &mut Files) -> Cards {
        let mut cards = Cards {
            files: Vec::new(),
            all: Vec::new(),
            instances: Vec::new(),
            missing: Vec::new(),
            scope: Scope::Deck,
        };
        cards.read(root, files, &mut Vec::new());
        cards
    }

    /// Whether the cards are up to date with the files.
    pub fn are_of(&self, files: &Files) -> bool {
        let is_same = |file: &DeckFile| {
            let known = files.get(&file.path);
            known.is_some_and(|known| known.revision == file.revision)
        };
        let is_missing = |path: &PathBuf| files.get(path).is_none() && !path.exists();
        self.files.iter().all(is_same) && self.missing.iter().all(is_missing)
    }

    /// Number of a file in the deck.
    pub fn file(&self, path: &Path) -> Option<usize> {
        self.files.iter().position(|file| file.path == path)
    }

    /// The card to which a line of a file belongs.
    pub fn at(&self, file: usize, line: usize) -> Option<&Card> {
        let of_file = |card: &&Card| card.file == file && card.head.spot.line <= line;
        let own = self.all.iter().rposition(|card| of_file(&card));
        let continued = || self.files.get(file)?.continues;
        let mut index = own.or_else(continued)?;
        // data lines behind a file that is included belong to the card before
        while let Some(card) = self.all.get(index)
            && card.head.name() == "INCLUDE"
            && (card.file != file || card.head.last < line)
        {
            index = index.checked_sub(1)?;
        }
        self.all.get(index)
    }

    /// The cards of a file, in order.
    pub fn of_file(&self, file: usize) -> impl Iterator<Item = &Card> {
        self.all.iter().filter(move |card| card.file == file)
    }

    /// Reads a file; `open` holds the main deck and the files that include this one, whose folders are searched.
    fn read(&mut self, path: &Path, files: &mut Files, open: &mut Vec<PathBuf>) {
        let whole = whole_path(path);
        let is_open = open.iter().any(|open| whole_path(open) == whole);
        if is_open || open.len() > MOST.0 || self.files.len() > MOST.1 {
            return;
        }
        let Some(file) = files.load(&whole) else {
            self.missing.push(whole);
            return;
        };
        let number = self.files.len();
        self.files.push(DeckFile {
            path: whole,
            revision: file.revision,
            continues: self.owner(),
        });
        let document = &file.document;
        let head = |(line, mark)| {
            let head = (mark == Mark::Keyword).then(|| Head::new(document, line));
            (line, head)
        };
        let marked: Vec<(usize, Option<Head>)> = document.marks().map(head).collect();
        let count = document.line_count();
        open.push(path.to_owned());
        let (mut own, mut last) = (None, None);
        for (line, head) in marked {
            if let Some(head) = head {
                last = Some(head.last);
                self.end(own, line);
                own = Some(self.all.len());
                self.add(number, head, files, open);
            } else if last.is_none_or(|last| line > last)
                && let Some(owner) = self.owner()
            {
                self.all[owner].rows.push((number, line));
            }
        }
        self.end(own, count);
        open.pop();
    }

    fn end(&mut self, card: Option<usize>, line: usize) {
        if let Some(card) = card.and_then(|card| self.all.get_mut(card)) {
            card.end = line;
        }
    }

    /// Adds a card, and the cards of the file that it names.
    fn add(&mut self, file: usize, head: Head, files: &mut Files, open: &mut Vec<PathBuf>) {
        let key = |name: &str| key(head.value(name).unwrap_or_default());
        let outside = match head.name() {
            "PART" => {
                self.scope = Scope::Part(key("NAME"));
                true
            }
            "INSTANCE" => {
                self.scope = Scope::Instance(key("NAME"));
                let typed = head.value("NAME").unwrap_or_default();
                let name = Name {
                    typed: typed.trim_matches('"').to_owned(),
                    key: key("NAME").to_string(),
                };
                let part = key("PART");
                self.instances.push(Instance { name, part });
                true
            }
            "END PART" | "ASSEMBLY" | "END INSTANCE" | "END ASSEMBLY" | "STEP" => {
                self.scope = Scope::Deck;
                true
            }
            _ => false,
        };
        let scope = match outside {
            true => Scope::Deck,
            false => self.scope.clone(),
        };
        let included = included(&head).map(str::to_owned);
        self.all.push(Card {
            file,
            head,
            scope,
            rows: Vec::new(),
            end: 0,
        });
        let Some(included) = included else { return };
        let folders = [open.last(), open.first()];
        let paths = folders.map(|path| {
            let folder = path.and_then(|path| path.parent()).unwrap_or(Path::new(""));
            folder.join(&included)
        });
        let is_there = |path: &&PathBuf| files.get(&whole_path(path)).is_some() || path.exists();
        let found = paths.iter().find(is_there).or(paths.first());
        if let Some(path) = found.cloned() {
            self.read(&path, files, open);
        }
    }

    /// The card to which data lines belong at the present point of reading.
    fn owner(&self) -> Option<usize> {
        let is_owner = |card: &Card| card.head.name() != "INCLUDE";
        self.all.iter().rposition(is_owner)
    }
}

/// The path of the file that a keyword line names.
pub(super) fn included(head: &Head) -> Option<&str> {
    let mut pieces = head.pieces.iter();
    pieces.find_map(|piece| match piece.parameter?.holds {
        Quantity::File => Some(piece.value.as_ref()?.0.trim_matches('"')),
        _ => None,
    })
}

/// The key by which a text is compared as a name.
pub(super) fn key(text: &str) -> Arc<str> {
    let span = Span::default();
    Text { text, span }.name_key().into()
}

/// The fields of a data line of a card with their places, and the content of each field where it is known.
pub(super) fn fields_of<'t>(
    card: &Card,
    text: &'t str,
    is_first: bool,
) -> Vec<(Text<'t>, Option<Field>)> {
    let fields: Vec<Text> = as_line(text).fields().collect();
    let words: Vec<&str> = fields.iter().map(|field| field.text).collect();
    let given = |name: &str| given(&card.head, name);
    let mut forms = card.head.data().forms().iter();
    let form = forms.find(|form| form.fits(&words, is_first, given));
    let with_form = fields.into_iter().enumerate();
    with_form
        .map(|(index, field)| (field, form.and_then(|form| form.field(index))))
        .collect()
}

/// The full word that a parameter of a keyword line has as its value; empty for a parameter without value.
pub(super) fn given<'h>(head: &'h Head, name: &str) -> Option<&'h str> {
    let piece = head.piece(name)?;
    let value = piece.value.as_ref().map_or("", |(value, _)| value);
    match piece.parameter?.takes {
        Takes::Choice(_) | Takes::OptionalChoice(_) => piece.parameter?.value_read_as(value),
        Takes::Nothing | Takes::Value | Takes::Optional => Some(value),
    }
}

/// Whether a line is the first data line of a card.
pub(super) fn is_first_row(document: &Document, card: &Card, line: usize) -> bool {
    let may_matter = card.head.data().forms().iter().any(|form| form.first);
    may_matter && next_said(document, card.head.last) == Some(line)
}
