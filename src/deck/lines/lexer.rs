//! Lines of a deck file: their kind, their fields, and the assignments of keyword lines.

use crate::diagnostics::{Code, Diagnostic, Diagnostics, FileId, Span};
use nom::bytes::complete::{tag, take_till};
use nom::combinator::opt;
use nom::sequence::preceded;
use nom::{IResult, Parser};
use nom_locate::LocatedSpan;

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
