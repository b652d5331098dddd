//! The lines of a deck file: their kind, their fields, the assignments of keyword lines, and blocks
//! of data lines among them.

use super::content::lines_fit;
use crate::diagnostics::{Code, Diagnostic, Diagnostics, FileId, Span};
use memchr::{memchr, memchr_iter, memrchr};
use nom::bytes::complete::{tag, take_till};
use nom::combinator::opt;
use nom::sequence::preceded;
use nom::{IResult, Parser};
use nom_locate::LocatedSpan;
use std::ops::Range;

/// One line of a file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line<'a> {
    /// File it stands in.
    pub file: FileId,
    /// Its number, from 1.
    pub number: u32,
    /// Byte of the file at which it starts.
    pub start: usize,
    /// Its text without the line end.
    pub text: &'a str,
}

/// What a line is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Nothing but blanks.
    Blank,
    /// Begins with two stars.
    Comment,
    /// Begins with one star.
    Keyword,
    /// Anything else.
    Data,
}

impl<'a> Line<'a> {
    /// What it is.
    pub fn kind(&self) -> Kind {
        kind_of(self.text)
    }

    /// Whether its last visible character is a comma.
    pub fn ends_with_comma(&self) -> bool {
        self.text.trim_end().ends_with(',')
    }

    /// Place of the bytes from `start` to `end`.
    pub fn span(&self, start: usize, end: usize) -> Span {
        span_in(self.text, self.file, self.number, start, end)
    }

    /// Place of its visible text.
    pub fn visible_span(&self) -> Span {
        let start = self.text.len() - self.text.trim_start().len();
        self.span(start, self.text.trim_end().len())
    }

    /// Reports a quotation mark that is not closed.
    pub fn check_quotes(&self, d: &mut Diagnostics) {
        let mut marks = self.text.match_indices('"');
        if let (Some((at, _)), 1) = (marks.next_back(), (marks.count() + 1) % 2) {
            let message = "this quotation mark is not closed on its line";
            d.push(Diagnostic::error(
                Code::OpenQuote,
                self.span(at, at + 1),
                message,
            ));
        }
    }
}

/// What a line with this text is.
pub(super) fn kind_of(line: &str) -> Kind {
    // the first character of most lines
    if let Some(b'0'..=b'9') = line.as_bytes().first() {
        return Kind::Data;
    }
    let text = line.trim_start();
    match text {
        "" => Kind::Blank,
        _ if text.starts_with("**") => Kind::Comment,
        _ if text.starts_with('*') => Kind::Keyword,
        _ => Kind::Data,
    }
}

/// Byte ranges of the fields between the commas of a line, without blanks around them; an empty
/// last field is dropped. Commas between quotation marks do not count.
pub(crate) struct Fields<'a> {
    text: &'a str,
    /// Where the next field starts; behind the text after the last one.
    start: usize,
}

impl<'a> Fields<'a> {
    /// The fields of a line.
    pub fn new(text: &'a str) -> Fields<'a> {
        Fields { text, start: 0 }
    }

    /// End of the field at `start`: its comma, or the end of the text.
    fn end(&self, start: usize) -> usize {
        let mut quoted = false;
        for (at, &byte) in self.text.as_bytes().iter().enumerate().skip(start) {
            match byte {
                b'"' => quoted = !quoted,
                b',' if !quoted => return at,
                _ => {}
            }
        }
        self.text.len()
    }
}

impl Iterator for Fields<'_> {
    type Item = (usize, usize);

    fn next(&mut self) -> Option<(usize, usize)> {
        let start = self.start;
        if start > self.text.len() {
            return None;
        }
        let end = self.end(start);
        self.start = end + 1;
        let field = trimmed(self.text, start, end);
        (end < self.text.len() || field.0 < field.1).then_some(field)
    }
}

/// Place of the bytes from `start` to `end` of line `number`.
pub(crate) fn span_in(text: &str, file: FileId, number: u32, start: usize, end: usize) -> Span {
    let is_ascii = text.is_ascii();
    let characters = |range: std::ops::Range<usize>| match is_ascii {
        true => range.len() as u32,
        false => text.get(range).unwrap_or("").chars().count() as u32,
    };
    Span {
        file,
        line: number,
        column: characters(0..start) + 1,
        length: characters(start..end).max(1),
        instance: 0,
    }
}

/// The bytes from `start` to `end` without blanks around them.
pub(crate) fn trimmed(text: &str, start: usize, end: usize) -> (usize, usize) {
    let bytes = text.as_bytes().get(start..end).unwrap_or_default();
    let blanks = bytes.iter().take_while(|&&byte| byte == b' ').count();
    let visible = bytes.get(blanks..).unwrap_or_default();
    let is_visible = |byte: Option<&u8>| byte.is_some_and(u8::is_ascii_graphic);
    if is_visible(visible.first()) && is_visible(visible.last()) {
        return (start + blanks, end);
    }
    let piece = text.get(start..end).unwrap_or("");
    let first = start + piece.len() - piece.trim_start().len();
    (first, first + piece.trim().len())
}

/// Name and value of a parameter, `NAME` or `NAME=value`, with their offsets in bytes.
pub(crate) struct Assignment<'a> {
    /// The name and where it starts.
    pub name: (&'a str, usize),
    /// The value and where it starts.
    pub value: Option<(&'a str, usize)>,
}

/// Splits a parameter at its equals sign.
pub(crate) fn assignment(text: &str) -> Assignment<'_> {
    let input = LocatedSpan::new(text);
    let parsed: IResult<_, _> = (
        take_till(|c| c == '='),
        opt(preceded(tag("="), take_till(|_| false))),
    )
        .parse(input);
    let piece = |span: LocatedSpan<&'_ str>| -> (usize, usize) {
        let start = span.location_offset();
        trimmed(text, start, start + span.fragment().len())
    };
    let cut = |(first, last): (usize, usize)| (text.get(first..last).unwrap_or(""), first);
    match parsed {
        Ok((_, (name, value))) => Assignment {
            name: cut(piece(name)),
            value: value.map(|value| cut(piece(value))),
        },
        Err(_) => Assignment {
            name: (text, 0),
            value: None,
        },
    }
}

/// The lines of a text, which end with LF or CRLF.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lines<'a> {
    file: FileId,
    /// The text up to the end of the last line.
    text: &'a str,
    /// Byte at which the next line starts.
    start: usize,
    /// Number of the line before it.
    number: u32,
    /// Number of the last line, where it is known.
    last: Option<u32>,
}

impl<'a> Lines<'a> {
    /// All lines of a text.
    pub fn new(file: FileId, text: &'a str) -> Lines<'a> {
        Lines {
            file,
            text,
            start: 0,
            number: 0,
            last: None,
        }
    }

    /// The lines in some bytes of a text, the numbers of which are those from `numbers.start` on.
    pub fn between(
        file: FileId,
        text: &'a str,
        bytes: Range<usize>,
        numbers: Range<u32>,
    ) -> Lines<'a> {
        Lines {
            file,
            text: text.get(..bytes.end).unwrap_or(text),
            start: bytes.start,
            number: numbers.start.saturating_sub(1),
            last: Some(numbers.end.saturating_sub(1)),
        }
    }

    /// Their file.
    pub fn file(&self) -> FileId {
        self.file
    }

    /// Their bytes.
    pub fn bytes(&self) -> Range<usize> {
        self.start..self.text.len()
    }

    /// Their numbers.
    pub fn numbers(&self) -> Range<u32> {
        let last = self.last.unwrap_or_else(|| {
            let ends = memchr_iter(b'\n', self.text().as_bytes()).count();
            let is_open = !self.text.is_empty() && !self.text.ends_with('\n');
            self.number + ends as u32 + u32::from(is_open)
        });
        self.number + 1..last + 1
    }

    /// The text of these lines.
    pub fn text(&self) -> &'a str {
        self.text.get(self.start..).unwrap_or("")
    }

    /// Those among them that are data lines.
    pub fn data(mut self) -> impl Iterator<Item = Line<'a>> {
        std::iter::from_fn(move || self.next_data())
    }

    /// Takes the lines up to the next data line.
    pub fn next_data(&mut self) -> Option<Line<'a>> {
        self.find(|line| line.kind() == Kind::Data)
    }

    /// Takes the next line, if it is one that `read` takes: a data line of which it says what it
    /// holds, and what follows it from its end on.
    pub fn next_read<T>(
        &mut self,
        read: impl FnOnce(&[u8]) -> Option<(T, &[u8])>,
    ) -> Option<(Line<'a>, T)> {
        let text = self.text();
        let (value, after) = read(text.as_bytes())?;
        let length = text.len() - after.len();
        let end = match after {
            [b'\r', b'\n', ..] => 2,
            rest => rest.len().min(1),
        };
        let start = self.start;
        self.start += length + end;
        self.number += 1;
        let line = Line {
            file: self.file,
            number: self.number,
            start,
            text: text.get(..length)?,
        };
        Some((line, value))
    }

    /// Whether none is longer than `most` bytes; a line that ends with CRLF may be said to be.
    pub fn fit(&self, most: usize) -> bool {
        lines_fit(self.text().as_bytes(), 0, most)
    }

    /// Takes the lines before the next keyword line; `first`, the last line taken, comes before
    /// them.
    pub fn take_block(&mut self, first: &Line) -> Lines<'a> {
        let rest = self.text();
        let length = before_keyword(rest);
        let end = self.start + length;
        let taken = rest.as_bytes().get(..length).unwrap_or_default();
        let is_open = taken.last().is_some_and(|&byte| byte != b'\n');
        let count = memchr_iter(b'\n', taken).count() as u32 + u32::from(is_open);
        self.start = end;
        self.number += count;
        Lines {
            text: self.text.get(..end).unwrap_or(self.text),
            start: first.start,
            number: first.number - 1,
            last: Some(self.number),
            ..*self
        }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        let rest = self.text();
        if rest.is_empty() {
            return None;
        }
        let end = memchr(b'\n', rest.as_bytes());
        let line = rest.get(..end.unwrap_or(rest.len())).unwrap_or(rest);
        let start = self.start;
        self.start += line.len() + usize::from(end.is_some());
        self.number += 1;
        Some(Line {
            file: self.file,
            number: self.number,
            start,
            text: line.strip_suffix('\r').unwrap_or(line),
        })
    }
}

/// Bytes before the first keyword line of a text that begins with a line: a line that holds a star
/// may be one.
fn before_keyword(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut start = 0;
    while let Some(star) = bytes.get(start..).and_then(|rest| memchr(b'*', rest)) {
        let (before, after) = bytes.split_at(start + star);
        start = memrchr(b'\n', before).map_or(0, |end| end + 1);
        let end = memchr(b'\n', after).map_or(bytes.len(), |end| before.len() + end);
        if kind_of(text.get(start..end).unwrap_or("")) == Kind::Keyword {
            return start;
        }
        start = end;
    }
    bytes.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_ends_before_the_next_keyword_line() {
        let text = "1, 2\r\n\n** 3\n 4*5 \n\u{a0}*NODE\n6";
        let mut lines = Lines::new(FileId(0), text);
        let first = lines.next().expect("a line");
        let block = lines.take_block(&first);
        let found: Vec<_> = block.data().map(|line| (line.number, line.text)).collect();
        assert_eq!(found, [(1, "1, 2"), (4, " 4*5 ")]);
        assert_eq!(block.numbers(), 1..5);
        let rest: Vec<_> = lines.map(|line| (line.number, line.text)).collect();
        assert_eq!(rest, [(5, "\u{a0}*NODE"), (6, "6")]);
    }

    #[test]
    fn lines_fit_up_to_the_limit() {
        let fit = |text| Lines::new(FileId(0), text).fit(3);
        assert!(fit("") && fit("abc") && fit("abc\nabc\n") && fit("\n\n\n\n\n"));
        assert!(!fit("abcd") && !fit("abcd\n") && !fit("abc\nabcd\na"));
    }
}
