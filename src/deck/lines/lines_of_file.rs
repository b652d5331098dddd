//! The lines of a file one after the other, and blocks of data lines among them.

use super::content::lines_fit;
use super::lexer::{Kind, Line, kind_of};
use crate::diagnostics::FileId;
use memchr::{memchr, memchr_iter, memrchr};
use std::ops::Range;

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
