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
        let text = self.text.trim_start();
        match text {
            "" => Kind::Blank,
            _ if text.starts_with("**") => Kind::Comment,
            _ if text.starts_with('*') => Kind::Keyword,
            _ => Kind::Data,
        }
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

    /// Byte ranges of the fields between its commas, without blanks around them; an empty last
    /// field is dropped. Commas between quotation marks do not count.
    pub fn fields(&self, d: &mut Diagnostics) -> Vec<(u32, u32)> {
        let mut fields = Vec::new();
        let mut start = 0;
        let mut quote = None;
        for (at, byte) in self.text.bytes().enumerate() {
            match (byte, quote) {
                (b'"', None) => quote = Some(at),
                (b'"', Some(_)) => quote = None,
                (b',', None) => {
                    fields.push(trimmed(self.text, start, at));
                    start = at + 1;
                }
                _ => {}
            }
        }
        let last = trimmed(self.text, start, self.text.len());
        if last.0 < last.1 {
            fields.push(last);
        }
        if let Some(at) = quote {
            let message = "this quotation mark is not closed on its line";
            d.push(Diagnostic::error(
                Code::OpenQuote,
                self.span(at, at + 1),
                message,
            ));
        }
        fields
    }
}

/// Place of the bytes from `start` to `end` of line `number`.
pub(crate) fn span_in(text: &str, file: FileId, number: u32, start: usize, end: usize) -> Span {
    let characters = |range: std::ops::Range<usize>| {
        let piece = text.get(range).unwrap_or("");
        piece.chars().count() as u32
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
fn trimmed(text: &str, start: usize, end: usize) -> (u32, u32) {
    let piece = text.get(start..end).unwrap_or("");
    let first = start + piece.len() - piece.trim_start().len();
    let last = first + piece.trim().len();
    (first as u32, last as u32)
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
        let (first, last) = trimmed(text, start, start + span.fragment().len());
        (first as usize, last as usize)
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
