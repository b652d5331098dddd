//! The text of a file that is being edited. The time of a change depends only on the number of lines that the change
//! touches. Pieces of the text remember which of their lines are keyword lines or hold words, and only changed pieces
//! are examined again.

use crate::deck::{Line, LineKind};
use crate::diagnostics::FileId;
use lsp_types::{Position, Range};
use ropey::Rope;
use std::borrow::Cow;

/// Largest number of lines of a piece.
const PIECE: usize = 256;

/// A text in pieces.
#[derive(Debug, Clone)]
pub(super) struct Document {
    rope: Rope,
    pieces: Vec<Piece>,
}

/// A piece of the text: consecutive lines.
#[derive(Debug, Clone, PartialEq)]
struct Piece {
    /// Number of lines of the piece.
    lines: usize,
    /// The marked lines of the piece, counted from 0, in order.
    marked: Vec<(u32, Mark)>,
}

/// Kinds of lines that are marked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mark {
    /// A keyword line.
    Keyword,
    /// A data line that holds something other than numbers.
    Words,
}

/// A range of characters of a line, counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Spot {
    /// Number of the line, from 0.
    pub line: usize,
    /// First character.
    pub start: usize,
    /// The character behind the last character of the range.
    pub end: usize,
}

impl Document {
    /// A document with a given text.
    pub fn new(text: &str) -> Document {
        let rope = Rope::from_str(text);
        let lines = text.split('\n').map(Cow::from);
        Document {
            pieces: pieces(lines),
            rope,
        }
    }

    /// A copy of the text, which shares its memory with the document.
    pub fn rope(&self) -> Rope {
        self.rope.clone()
    }

    /// Number of lines; the last line may be empty.
    pub fn line_count(&self) -> usize {
        self.rope.len_lines()
    }

    /// A line without its line end; empty if there is no such line.
    pub fn line(&self, line: usize) -> Cow<'_, str> {
        self.rope
            .get_line(line)
            .map_or(Cow::from(""), |line| without_end(line.into()))
    }

    /// Kind of a line, as the reader of decks sees it.
    pub fn kind(&self, line: usize) -> LineKind {
        as_line(&self.line(line)).kind()
    }

    /// The marked lines, in order.
    pub fn marks(&self) -> impl Iterator<Item = (usize, Mark)> {
        let starts = self.pieces.iter().scan(0, |before, piece| {
            let start = *before;
            *before += piece.lines;
            Some((start, piece))
        });
        starts.flat_map(|(start, piece)| {
            let marked = piece.marked.iter();
            marked.map(move |&(line, mark)| (start + line as usize, mark))
        })
    }

    /// Replaces a range of the text, or the whole text.
    pub fn change(&mut self, range: Option<Range>, text: &str) {
        let Some(range) = range else {
            *self = Document::new(text);
            return;
        };
        let ends = [range.start, range.end].map(|position| self.character(position));
        let (start, end) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let [first, last] = [start, end].map(|at| self.rope.char_to_line(at));
        self.rope.remove(start..end);
        self.rope.insert(start, text);
        let new_last = first + text.matches('\n').count();
        self.renew(first, last, new_last);
    }

    /// Renews the pieces of the lines from `first` to `last` after a change by which the line `last` becomes the line
    /// `new_last`.
    fn renew(&mut self, first: usize, last: usize, new_last: usize) {
        let mut start = 0;
        let mut from = 0;
        while let Some(piece) = self.pieces.get(from)
            && start + piece.lines <= first
        {
            start += piece.lines;
            from += 1;
        }
        let (mut to, mut lines) = (from, 0);
        while let Some(piece) = self.pieces.get(to)
            && (start + lines <= last || lines < PIECE / 4)
        {
            lines += piece.lines;
            to += 1;
        }
        let lines = (lines + new_last).saturating_sub(last);
        let anew = self.rope.lines_at(start).take(lines);
        let anew = pieces(anew.map(|line| without_end(line.into())));
        self.pieces.splice(from..to, anew);
    }

    /// Number of the character at a position; a position beyond the end of its line or of the text counts as this end.
    fn character(&self, position: Position) -> usize {
        let line = position.line as usize;
        if line >= self.rope.len_lines() {
            return self.rope.len_chars();
        }
        self.rope.line_to_char(line) + self.column(position)
    }

    /// Number of the character within its line at a position, from 0.
    pub fn column(&self, position: Position) -> usize {
        let text = self.line(position.line as usize);
        let mut units = position.character as usize;
        let is_before = |c: &char| {
            let fits = units >= c.len_utf16();
            units = units.saturating_sub(c.len_utf16());
            fits
        };
        text.chars().take_while(is_before).count()
    }

    /// The position of a character of a line, in UTF-16 units.
    pub fn position(&self, line: usize, column: usize) -> Position {
        position(&self.line(line), line, column)
    }

    /// The range of the characters of a spot, in UTF-16 units.
    pub fn range(&self, spot: Spot) -> Range {
        let [start, end] = [spot.start, spot.end].map(|at| self.position(spot.line, at));
        Range { start, end }
    }
}

/// The position of a character of a line that has this text.
pub(super) fn position(text: &str, line: usize, column: usize) -> Position {
    let units = text.chars().take(column).map(char::len_utf16);
    Position::new(line as u32, units.sum::<usize>() as u32)
}

/// A text in the form of a line of a deck.
pub(super) fn as_line(text: &str) -> Line<'_> {
    Line {
        file: FileId(0),
        number: 0,
        instance: 0,
        text,
    }
}

/// Divides lines into pieces.
fn pieces<'t>(lines: impl Iterator<Item = Cow<'t, str>>) -> Vec<Piece> {
    let mut all: Vec<Piece> = Vec::new();
    for line in lines {
        let piece = match all.last_mut() {
            Some(last) if last.lines < PIECE => last,
            _ => {
                all.push(Piece {
                    lines: 0,
                    marked: Vec::new(),
                });
                match all.last_mut() {
                    Some(last) => last,
                    None => break,
                }
            }
        };
        piece
            .marked
            .extend(mark(&line).map(|mark| (piece.lines as u32, mark)));
        piece.lines += 1;
    }
    all
}

fn mark(text: &str) -> Option<Mark> {
    match as_line(text).kind() {
        LineKind::Keyword => Some(Mark::Keyword),
        LineKind::Data if has_words(text) => Some(Mark::Words),
        LineKind::Data | LineKind::Blank | LineKind::Comment => None,
    }
}

/// Whether a data line has anything but numbers; a name that is written like a number, such as `1E5`, counts as a
/// number.
fn has_words(text: &str) -> bool {
    let mut before = b' ';
    !text.bytes().all(|byte| {
        let last = std::mem::replace(&mut before, byte);
        match byte {
            b'0'..=b'9' | b',' | b'.' | b'+' | b'-' | b' ' | b'\t' | b'\r' => true,
            b'e' | b'E' | b'd' | b'D' => last.is_ascii_digit() || last == b'.',
            _ => false,
        }
    })
}

fn without_end(line: Cow<'_, str>) -> Cow<'_, str> {
    let length = line.strip_suffix('\n').unwrap_or(&line);
    let length = length.strip_suffix('\r').unwrap_or(length).len();
    match line {
        Cow::Borrowed(line) => Cow::Borrowed(line.get(..length).unwrap_or(line)),
        Cow::Owned(mut line) => {
            line.truncate(length);
            Cow::Owned(line)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn marks(document: &Document) -> Vec<(usize, Mark)> {
        document.marks().collect()
    }

    #[test]
    fn positions_count_utf_16() {
        let document = Document::new("*NODE\r\nä😀b, 1\r\n");
        assert_eq!((document.line_count(), &*document.line(1)), (3, "ä😀b, 1"));
        assert_eq!(document.position(1, 3), Position::new(1, 4));
        assert_eq!(document.column(Position::new(1, 4)), 3);
        assert_eq!(document.column(Position::new(1, 2)), 1);
        assert_eq!(document.column(Position::new(1, 99)), 6);
    }

    #[test]
    fn lines_of_numbers_do_not_matter() {
        let document = Document::new("*NSET\n1, 2.5E-3, -1.D0\nTOP, 3\n<x>, 1\n** c\n1, E1\n");
        let expected = [
            (0, Mark::Keyword),
            (2, Mark::Words),
            (3, Mark::Words),
            (5, Mark::Words),
        ];
        assert_eq!(marks(&document), expected);
    }

    fn position() -> impl Strategy<Value = Position> {
        (0..1400_u32, 0..12_u32).prop_map(|(line, at)| Position::new(line, at))
    }

    proptest! {
        #[test]
        fn changes_leave_what_a_new_document_has(
            size in 0..1200_usize,
            changes in prop::collection::vec(
                (position(), position(), "([*,AB1ä😀 \n]|\r\n|1, 2\n){0,40}", 0..9_u8), 1..12),
        ) {
            let text: String = (0..size).map(|i| match i % 7 {
                0 => "*NODE\n".to_owned(),
                1 => format!("TOP, {i}\r\n"),
                _ => format!("{i}, 1.\n"),
            }).collect();
            let mut document = Document::new(&text);
            for (start, end, text, far) in changes {
                // most changes are small
                let end = if far == 0 { end } else { Position::new(start.line + u32::from(far) / 4, end.character) };
                document.change(Some(Range { start, end }), &text);
                let fresh = Document::new(&document.rope.to_string());
                prop_assert_eq!(document.rope.len_lines(), fresh.line_count());
                prop_assert_eq!(marks(&document), marks(&fresh));
                let lines: usize = document.pieces.iter().map(|piece| piece.lines).sum();
                prop_assert_eq!(lines, document.line_count());
            }
        }
    }
}
