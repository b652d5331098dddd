//! The lines of a deck file, blocks of data lines, and the fields of a line with typed access. A wrong or missing field
//! is reported with its place.

use super::number::{self, LONGEST_NUMBER};
use super::text::Text;
use crate::diagnostics::{Code, Diagnostics, FileId, Span};
use memchr::{memchr, memchr_iter, memrchr};
use smallvec::SmallVec;
use std::ops::Range;

/// One line of a file.
#[derive(Debug, Clone, Copy)]
pub struct Line<'a> {
    /// File of the line.
    pub file: FileId,
    /// Number of the line in the file, from 1.
    pub number: u32,
    /// Number of the instance that the names and numbers of the line belong to, from 1; 0 for no instance.
    pub instance: u32,
    /// Text of the line without the line end.
    pub text: &'a str,
}

/// Kinds of lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineKind {
    /// The line has nothing but blanks.
    Blank,
    /// The line begins with two stars.
    Comment,
    /// The line begins with one star.
    Keyword,
    /// The line begins with anything but a blank or a star.
    Data,
}

impl<'a> Line<'a> {
    /// Kind of the line.
    pub fn kind(self) -> LineKind {
        // the first character of most lines
        if let Some(b'0'..=b'9') = self.text.as_bytes().first() {
            return LineKind::Data;
        }
        match self.text.trim_start() {
            "" => LineKind::Blank,
            text if text.starts_with("**") => LineKind::Comment,
            text if text.starts_with('*') => LineKind::Keyword,
            _ => LineKind::Data,
        }
    }

    /// Whether the last visible character of the line is a comma.
    pub fn ends_with_comma(self) -> bool {
        self.text.trim_end().ends_with(',')
    }

    /// Place of the visible text of the line.
    pub fn span(self) -> Span {
        let (start, end) = trimmed(self.text, 0, self.text.len());
        self.span_of(start..end)
    }

    /// Place of a range of bytes of the line.
    pub(super) fn span_of(self, bytes: Range<usize>) -> Span {
        let is_ascii = self.text.is_ascii();
        let characters = |bytes: Range<usize>| match is_ascii {
            true => bytes.len() as u32,
            false => self.text.get(bytes).unwrap_or("").chars().count() as u32,
        };
        Span {
            file: self.file,
            line: self.number,
            column: characters(0..bytes.start) + 1,
            length: characters(bytes).max(1),
            instance: self.instance,
        }
    }

    /// Reports a quotation mark that is not closed.
    pub(super) fn check_quotes(self, d: &mut Diagnostics) {
        let mut marks = self.text.match_indices('"');
        if let (Some((at, _)), 1) = (marks.next_back(), (marks.count() + 1) % 2) {
            let message = "this quotation mark is not closed on its line";
            d.error(Code::OpenQuote, self.span_of(at..at + 1), message);
        }
    }

    /// All fields in order, including empty fields.
    pub fn fields(self) -> impl Iterator<Item = Text<'a>> {
        Fields::new(self.text).map(move |(start, end)| Text {
            text: self.text.get(start..end).unwrap_or(""),
            span: self.span_of(start..end),
        })
    }

    /// Field `index`, from 0; `None` if the field is blank.
    pub fn get(self, index: usize) -> Option<Text<'a>> {
        self.fields().nth(index).filter(|field| !field.is_empty())
    }

    /// Place of field `index`, or of the whole line if this field is blank.
    pub fn span_at(self, index: usize) -> Span {
        self.get(index).map_or(self.span(), |field| field.span)
    }

    /// Field `index`; a blank field is reported as missing, under the name `what`.
    pub fn required(self, index: usize, what: &str, d: &mut Diagnostics) -> Option<Text<'a>> {
        let field = self.get(index);
        if field.is_none() {
            let empty = self.fields().nth(index).map(|field| field.span);
            let message = format!("field {} is missing: {what}", index + 1);
            d.error(Code::MissingField, empty.unwrap_or(self.span()), message);
        }
        field
    }

    /// The number in field `index`; a blank field is reported as missing, under the name `what`.
    pub fn real(self, index: usize, what: &str, d: &mut Diagnostics) -> Option<f64> {
        self.required(index, what, d)?.real(d)
    }

    /// The number in field `index`, or `default` if the field is blank.
    pub fn real_or(self, index: usize, default: f64, d: &mut Diagnostics) -> Option<f64> {
        match self.get(index) {
            Some(field) => field.real(d),
            None => Some(default),
        }
    }

    /// The fields of a line without quotation marks; only an empty field at the end of the line is dropped.
    fn plain_fields(self) -> impl Iterator<Item = &'a str> {
        let text = self.text.trim_ascii();
        let fields = text.strip_suffix(',').unwrap_or(text).split(',');
        fields.map(str::trim_ascii)
    }

    /// The integers without sign that the line consists of; `None` if the line holds anything else.
    pub fn plain_integers(self) -> Option<SmallVec<[u64; 5]>> {
        self.plain_fields()
            .map(|field| field.parse().ok())
            .collect()
    }

    /// The label (an integer without sign) and the coordinates of a line, with 0 for missing coordinates. `None` if the
    /// line has other fields, or numbers that other codes read differently.
    pub fn plain_point(self) -> Option<(u64, [f64; 3])> {
        let mut fields = self.plain_fields();
        let label = fields.next()?.parse().ok()?;
        let mut at = [0.0; 3];
        for (index, field) in fields.enumerate() {
            let value = number::plain_real(field).filter(|_| field.len() <= LONGEST_NUMBER)?;
            *at.get_mut(index)? = value;
        }
        Some((label, at))
    }

    /// The first field from `count` on that is not blank.
    fn field_behind(self, count: usize) -> Option<Text<'a>> {
        self.fields().skip(count).find(|field| !field.is_empty())
    }

    /// Reports fields beyond the first `count`.
    pub fn at_most(self, count: usize, d: &mut Diagnostics) {
        if let Some(extra) = self.field_behind(count) {
            let fields = if count == 1 { "field is" } else { "fields are" };
            let message = format!("only {count} {fields} read on this line");
            let error = d.error(Code::ExtraField, extra.span, message);
            if self.has_decimal_comma() {
                error.help(
                    "a comma ends a field: write a decimal point where a decimal comma is meant",
                );
            }
        }
    }

    /// Whether the line may have a decimal comma: two neighbouring fields of digits only, such as `0,25`, behind the
    /// first field.
    fn has_decimal_comma(self) -> bool {
        let fields: Vec<Text> = self.fields().skip(1).collect();
        let mut pairs = fields.windows(2);
        pairs.any(|pair| pair.iter().all(Text::is_digits))
    }

    /// Warns that the first field from `count` on that is not blank has no effect.
    pub fn without_effect(self, count: usize, message: &str, help: &str, d: &mut Diagnostics) {
        if let Some(field) = self.field_behind(count) {
            d.warning_once(Code::IgnoredParameter, field.span, message)
                .help(help);
        }
    }
}

/// Byte ranges of the fields between the commas of a line, without blanks around the fields; an empty last field is
/// dropped. Commas between quotation marks do not count.
pub(super) struct Fields<'a> {
    text: &'a str,
    /// Byte where the next field starts; behind the last field this byte lies beyond the text.
    start: usize,
}

impl<'a> Fields<'a> {
    /// The fields of a line.
    pub fn new(text: &'a str) -> Fields<'a> {
        Fields { text, start: 0 }
    }

    /// End of the field that begins at `start`: the next comma, or the end of the text.
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

/// The bytes from `start` to `end` without blanks at both ends.
fn trimmed(text: &str, start: usize, end: usize) -> (usize, usize) {
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

/// The lines of a text, which end with LF or CRLF.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lines<'a> {
    /// File of the lines.
    pub file: FileId,
    /// The text up to the end of the last line.
    pub text: &'a str,
    /// Byte at which the next line starts.
    pub start: usize,
    /// Number of the line before the byte at which the next line starts.
    pub before: u32,
    /// Number of the instance that the names and numbers of the lines belong to, from 1; 0 for no instance.
    pub instance: u32,
}

impl<'a> Lines<'a> {
    /// All lines of a text.
    pub fn new(file: FileId, text: &'a str) -> Lines<'a> {
        Lines {
            file,
            text,
            start: 0,
            before: 0,
            instance: 0,
        }
    }

    /// The same lines with another text; the numbers of the lines stay the same.
    pub fn at<'t>(self, text: &'t str) -> Lines<'t> {
        Lines {
            file: self.file,
            text,
            start: 0,
            before: self.before,
            instance: self.instance,
        }
    }

    /// The text of the lines that have not been read.
    pub fn rest(&self) -> &'a str {
        self.text.get(self.start..).unwrap_or("")
    }

    /// The number of lines that have not been read.
    pub fn count_lines(&self) -> u32 {
        let text = self.rest();
        let is_open = !text.is_empty() && !text.ends_with('\n');
        memchr_iter(b'\n', text.as_bytes()).count() as u32 + u32::from(is_open)
    }

    /// The data lines among the lines that have not been read.
    pub fn data(self) -> impl Iterator<Item = Line<'a>> + Clone {
        self.filter(|line| line.kind() == LineKind::Data)
    }

    /// Splits off the unread lines before the next keyword line.
    pub fn take_block(&mut self) -> Lines<'a> {
        let end = self.start + before_keyword(self.rest());
        let block = Lines {
            text: self.text.get(..end).unwrap_or(self.text),
            ..*self
        };
        self.start = end;
        self.before += block.count_lines();
        block
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        let rest = self.rest();
        if rest.is_empty() {
            return None;
        }
        let end = memchr(b'\n', rest.as_bytes());
        let line = rest.get(..end.unwrap_or(rest.len())).unwrap_or(rest);
        self.start += line.len() + usize::from(end.is_some());
        self.before += 1;
        Some(Line {
            file: self.file,
            number: self.before,
            instance: self.instance,
            text: line.strip_suffix('\r').unwrap_or(line),
        })
    }
}

/// Number of bytes before the first keyword line of a text; only lines that hold a star are examined.
fn before_keyword(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut start = 0;
    while let Some(star) = bytes.get(start..).and_then(|rest| memchr(b'*', rest)) {
        let before = bytes.get(..start + star).unwrap_or_default();
        start = memrchr(b'\n', before).map_or(0, |end| end + 1);
        let Some(line) = Lines::new(FileId(0), text.get(start..).unwrap_or("")).next() else {
            break;
        };
        if line.kind() == LineKind::Keyword {
            return start;
        }
        start += line.text.len();
    }
    bytes.len()
}

/// The byte at which the first line of more than `most` bytes exceeds `most` bytes; the CR of a CRLF also counts.
pub(super) fn overlong(text: &[u8], most: usize) -> Option<usize> {
    let mut start = 0;
    while text.len() - start > most {
        let line = text.get(start..=start + most)?;
        match memrchr(b'\n', line) {
            Some(end) => start += end + 1,
            None => return Some(start + most),
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deck::number::{integer, real};
    use proptest::prelude::*;

    #[test]
    fn a_block_ends_before_the_next_keyword_line() {
        let text = "1, 2\r\n\n** 3\n 4*5 \n\u{a0}*NODE\n6";
        let mut lines = Lines::new(FileId(0), text);
        let block = lines.take_block();
        let found: Vec<_> = block.data().map(|line| (line.number, line.text)).collect();
        assert_eq!(found, [(1, "1, 2"), (4, " 4*5 ")]);
        assert_eq!(block.count_lines(), 4);
        let rest: Vec<_> = lines.map(|line| (line.number, line.text)).collect();
        assert_eq!(rest, [(5, "\u{a0}*NODE"), (6, "6")]);
    }

    #[test]
    fn lines_fit_up_to_the_limit() {
        let fit = |text: &str| overlong(text.as_bytes(), 3).is_none();
        assert!(fit("") && fit("abc") && fit("abc\nabc\n") && fit("\n\n\n\n\n"));
        assert!(!fit("abcd") && !fit("abcd\n") && !fit("abc\nabcd\na"));
    }

    /// Checks that the fast path for plain lines reads the same values as the path through fields.
    fn assert_plain_is_fields(text: &str) {
        let line = Lines::new(FileId(0), text).next().unwrap_or(Line {
            file: FileId(0),
            number: 1,
            instance: 0,
            text: "",
        });
        let fields: Vec<&str> = line.fields().map(|field| field.text).collect();
        if let Some(found) = line.plain_integers() {
            let whole = fields
                .iter()
                .map(|field| integer(field).ok()?.try_into().ok());
            assert_eq!(Some(found.to_vec()), whole.collect(), "{text}");
        }
        if let Some((label, at)) = line.plain_point() {
            assert_eq!(integer(fields[0]), Ok(label as i64), "{text}");
            let bits = |field: &&str| real(field).expect("a number").value.to_bits();
            let mut expected: Vec<u64> = fields[1..].iter().map(bits).collect();
            expected.resize(3, 0.0_f64.to_bits());
            assert_eq!(at.map(f64::to_bits).to_vec(), expected, "{text}");
        }
    }

    proptest! {
        #[test]
        fn any_plain_line_is_what_its_fields_are(text in "[0-9]{1,4}( ?[0-9., \r+eE-]{0,3}){0,12}") {
            assert_plain_is_fields(&text);
        }
    }

    #[test]
    fn lines_of_other_than_plain_numbers_are_not_plain() {
        let line = |text| Line {
            file: FileId(0),
            number: 1,
            instance: 0,
            text,
        };
        let (a, b) = ([-0.5, 2.0, 300.0], [1.0, 1e-3, 0.0]);
        assert_eq!(line("1, -.5, 2.,+3e2 ").plain_point(), Some((1, a)));
        assert_eq!(line(" 9 ,1,1e-3").plain_point(), Some((9, b)));
        let others = [
            "1,,2",
            "1, nan",
            "1, inf, 0",
            "1, 1e999",
            "1, 1.5D3",
            "1, 1, 1, 1, 1",
            "a, 1, 1",
            "-1, 0, 0",
            "1, 0.0000000000000000000001",
            "1, 1 2",
        ];
        for text in others {
            assert_eq!(line(text).plain_point(), None, "{text}");
        }
        for text in ["1, 2, 3", "1,2,3,", " 7 , 8 , ", "7,\t8", "12"] {
            assert!(line(text).plain_integers().is_some(), "{text}");
        }
        for text in [
            "1,,2", ",", "1,2,,", "-1, 2", "1 2, 3", "1, a", "1.0, 2", "\"1\", 2",
        ] {
            assert_eq!(line(text).plain_integers(), None, "{text}");
        }
    }
}
