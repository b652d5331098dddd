//! Cards with their parameters and data lines, and typed access to both; a wrong or missing value
//! is reported with its place. Data lines are blocks of the texts of their files, cut into rows and
//! fields when they are asked for.

use super::keywords::Keyword;
use super::lines::{Fields, Line, Lines, span_in, trimmed};
use super::number;
use super::number::{Integers, Point};
use super::text::{Name, Text};
use crate::diagnostics::{Code, Diagnostic, Diagnostics, FileId, Span};
use std::cell::Cell;
use std::ops::Range;
use std::sync::Arc;

/// A keyword line and its data lines.
#[derive(Debug, Clone)]
pub struct Card {
    /// The keyword.
    pub keyword: &'static Keyword,
    /// Place of the keyword.
    pub span: Span,
    /// Whether an error of the keyword line has been reported.
    pub faulty: bool,
    /// Its data lines.
    pub rows: Rows,
    pub(crate) params: Vec<Param>,
}

/// A parameter of a keyword line.
#[derive(Debug, Clone)]
pub struct Param {
    /// Its name in full.
    pub name: &'static str,
    /// Place of the whole parameter.
    pub span: Span,
    pub(crate) value: Option<(String, Span)>,
    pub(crate) choice: Option<&'static str>,
    pub(crate) faulty: bool,
    pub(crate) used: Cell<bool>,
}

impl Card {
    /// The keyword with its star.
    pub fn title(&self) -> String {
        format!("*{}", self.keyword.name)
    }

    /// The same card, its names and numbers being those of an instance of a part.
    pub(crate) fn in_instance(mut self, instance: u32) -> Card {
        self.span.instance = instance;
        for param in &mut self.params {
            param.span.instance = instance;
            if let Some((_, span)) = &mut param.value {
                span.instance = instance;
            }
        }
        self.with_rows_in(instance)
    }

    /// The same card, the names and numbers in its rows being those of an instance of a part.
    pub(crate) fn with_rows_in(mut self, instance: u32) -> Card {
        self.rows.set_instance(instance);
        self
    }

    fn param(&self, name: &str) -> Option<&Param> {
        let param = self.params.iter().find(|param| param.name == name)?;
        param.used.set(true);
        Some(param)
    }

    /// Place of a parameter, or of the keyword where the parameter is absent.
    pub fn span_of(&self, name: &str) -> Span {
        self.param(name).map_or(self.span, |param| param.span)
    }

    /// Whether a parameter is given.
    pub fn has(&self, name: &str) -> bool {
        self.param(name).is_some()
    }

    /// The value of a parameter, if it is given and can be read.
    pub fn value(&self, name: &str) -> Option<Text<'_>> {
        let param = self.param(name).filter(|param| !param.faulty)?;
        let (text, span) = param.value.as_ref()?;
        Some(Text { text, span: *span })
    }

    /// The value of a parameter that must be given.
    pub fn required(&self, name: &str, d: &mut Diagnostics) -> Option<Text<'_>> {
        if self.param(name).is_none() && !self.faulty {
            let message = format!("{} needs the parameter {name}", self.title());
            d.push(Diagnostic::error(
                Code::MissingParameter,
                self.span,
                message,
            ));
        }
        self.value(name)
    }

    /// The full word that a parameter has as its value.
    pub fn choice(&self, name: &str) -> Option<&'static str> {
        self.param(name).and_then(|param| param.choice)
    }

    /// The value of a parameter as a real number.
    pub fn real(&self, name: &str, d: &mut Diagnostics) -> Option<f64> {
        self.value(name).and_then(|value| value.real(d))
    }

    /// The value of a parameter as an integer.
    pub fn integer(&self, name: &str, d: &mut Diagnostics) -> Option<i64> {
        self.value(name).and_then(|value| value.integer(d))
    }

    /// Warns about parameters that the reader has not used; those with a choice of words are
    /// checked when the card is read.
    pub fn report_unused(&self, d: &mut Diagnostics) {
        let unused = |p: &&Param| !p.used.get() && !p.faulty && p.choice.is_none();
        for param in self.params.iter().filter(unused) {
            let message = format!("{} of {} has no effect here", param.name, self.title());
            d.push(Diagnostic::warning(
                Code::IgnoredParameter,
                param.span,
                message,
            ));
        }
    }
}

/// The data lines of a card.
#[derive(Debug, Clone, Default)]
pub struct Rows {
    blocks: Vec<Block>,
    instance: u32,
}

/// Lines one after the other in a file, among which are no keyword lines.
#[derive(Debug, Clone)]
struct Block {
    /// Text of the whole file.
    source: Arc<String>,
    /// Bytes of the lines.
    bytes: Range<usize>,
    file: FileId,
    /// Numbers of the lines.
    numbers: Range<u32>,
    is_ascii: bool,
}

impl Rows {
    /// Adds lines of the file with the text `source`.
    pub(crate) fn add(&mut self, lines: Lines, source: &Arc<String>, is_ascii: bool) {
        self.blocks.push(Block {
            source: Arc::clone(source),
            bytes: lines.bytes(),
            file: lines.file(),
            numbers: lines.numbers(),
            is_ascii,
        });
    }

    /// Makes the names and numbers in the rows those of an instance of a part.
    pub(super) fn set_instance(&mut self, instance: u32) {
        self.instance = instance;
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.first().is_none()
    }

    /// The first row.
    pub fn first(&self) -> Option<Row<'_>> {
        self.iter().next()
    }

    /// Row `index`, from 0.
    pub fn get(&self, index: usize) -> Option<Row<'_>> {
        self.iter().nth(index)
    }

    /// All rows in order.
    pub fn iter(&self) -> RowsInOrder<'_> {
        RowsInOrder {
            blocks: self.blocks.iter(),
            open: None,
            instance: self.instance,
        }
    }

    /// Number of lines, not all of which may hold a row.
    pub fn line_count(&self) -> usize {
        self.blocks.iter().map(|block| block.numbers.len()).sum()
    }
}

/// The rows of a card one after the other.
#[derive(Debug, Clone)]
pub struct RowsInOrder<'a> {
    blocks: std::slice::Iter<'a, Block>,
    /// Lines of the block that is read, and whether they are ASCII.
    open: Option<(Lines<'a>, bool)>,
    instance: u32,
}

impl<'a> RowsInOrder<'a> {
    /// The next row and whether it holds integers without sign only: `numbers` are these then.
    pub fn next_integers(&mut self, numbers: &mut Integers) -> Option<(Row<'a>, bool)> {
        let (row, read) = self.next_read(|text| Some(((), number::integers(text, numbers)?)))?;
        Some((row, read.is_some()))
    }

    /// The next row with the label and the coordinates that it gives, if they are plain numbers;
    /// those that are missing are 0.
    pub fn next_point(&mut self) -> Option<(Row<'a>, Option<Point>)> {
        self.next_read(number::point)
    }

    /// The next row and what `read` takes from it, as [`Lines::next_read`].
    fn next_read<T>(
        &mut self,
        read: impl FnOnce(&[u8]) -> Option<(T, &[u8])>,
    ) -> Option<(Row<'a>, Option<T>)> {
        if let Some((lines, is_ascii)) = &mut self.open
            && let Some((line, value)) = lines.next_read(read)
        {
            return Some((Row::new(line, *is_ascii, self.instance), Some(value)));
        }
        self.next().map(|row| (row, None))
    }
}

impl<'a> Iterator for RowsInOrder<'a> {
    type Item = Row<'a>;

    fn next(&mut self) -> Option<Row<'a>> {
        loop {
            if let Some((lines, is_ascii)) = &mut self.open
                && let Some(line) = lines.next_data()
            {
                return Some(Row::new(line, *is_ascii, self.instance));
            }
            let block = self.blocks.next()?;
            self.open = Some((block.lines(), block.is_ascii));
        }
    }
}

impl Block {
    fn lines(&self) -> Lines<'_> {
        let (bytes, numbers) = (self.bytes.clone(), self.numbers.clone());
        Lines::between(self.file, &self.source, bytes, numbers)
    }
}

/// A data line.
#[derive(Debug, Clone, Copy)]
pub struct Row<'a> {
    text: &'a str,
    file: FileId,
    line: u32,
    instance: u32,
    is_ascii: bool,
}

impl<'a> Row<'a> {
    fn new(line: Line<'a>, is_ascii: bool, instance: u32) -> Row<'a> {
        Row {
            text: line.text,
            file: line.file,
            line: line.number,
            instance,
            is_ascii,
        }
    }

    /// The line as typed.
    pub fn text(self) -> &'a str {
        self.text
    }

    /// Number of the line in its file, from 1.
    pub fn line(self) -> u32 {
        self.line
    }

    /// Instance of a part to which its names and numbers belong, from 1; 0 for none.
    pub fn instance(self) -> u32 {
        self.instance
    }

    /// Place of the visible text.
    pub fn span(self) -> Span {
        let (start, end) = trimmed(self.text, 0, self.text.len());
        self.span_between(start, end)
    }

    /// Place of the bytes from `start` to `end`.
    fn span_between(self, start: usize, end: usize) -> Span {
        let span = match self.is_ascii {
            true => Span {
                file: self.file,
                line: self.line,
                column: start as u32 + 1,
                length: ((end - start) as u32).max(1),
                instance: 0,
            },
            false => span_in(self.text, self.file, self.line, start, end),
        };
        Span {
            instance: self.instance,
            ..span
        }
    }

    /// All fields in order, empty ones included.
    pub fn fields(self) -> impl Iterator<Item = Text<'a>> {
        Fields::new(self.text).map(move |(start, end)| Text {
            text: self.text.get(start..end).unwrap_or(""),
            span: self.span_between(start, end),
        })
    }

    /// Field `index`, from 0; `None` where it is blank.
    pub fn get(self, index: usize) -> Option<Text<'a>> {
        self.fields().nth(index).filter(|field| !field.is_empty())
    }

    /// Field `index`; reports that `what` is missing where it is blank.
    pub fn required(self, index: usize, what: &str, d: &mut Diagnostics) -> Option<Text<'a>> {
        let field = self.get(index);
        if field.is_none() {
            let empty = self.fields().nth(index).map(|field| field.span);
            let message = format!("field {} is missing: {what}", index + 1);
            let place = empty.unwrap_or(self.span());
            d.push(Diagnostic::error(Code::MissingField, place, message));
        }
        field
    }

    /// The number in field `index`; reports that `what` is missing where it is blank.
    pub fn real(self, index: usize, what: &str, d: &mut Diagnostics) -> Option<f64> {
        self.required(index, what, d)?.real(d)
    }

    /// The number in field `index`, or `default` where it is blank.
    pub fn real_or(self, index: usize, default: f64, d: &mut Diagnostics) -> Option<f64> {
        match self.get(index) {
            Some(field) => field.real(d),
            None => Some(default),
        }
    }

    /// Reports fields beyond the first `count`.
    pub fn at_most(self, count: usize, d: &mut Diagnostics) {
        if let Some(extra) = self.fields().skip(count).find(|field| !field.is_empty()) {
            let fields = if count == 1 { "field is" } else { "fields are" };
            let message = format!("only {count} {fields} read on this line");
            let error = Diagnostic::error(Code::ExtraField, extra.span, message);
            d.push(match self.has_decimal_comma() {
                true => error.help(
                    "a comma ends a field: write a decimal point where a decimal comma is meant",
                ),
                false => error,
            });
        }
    }

    /// Whether the line may have a decimal comma: two fields of digits one after the other, such as
    /// `0,25`, after the first.
    fn has_decimal_comma(self) -> bool {
        let fields: Vec<Text> = self.fields().skip(1).collect();
        fields
            .windows(2)
            .any(|pair| pair.iter().all(Text::is_digits))
    }

    /// Warns that the first field from `count` on that is not blank has no effect.
    pub fn without_effect(self, count: usize, message: &str, help: &str, d: &mut Diagnostics) {
        if let Some(field) = self.fields().skip(count).find(|field| !field.is_empty()) {
            let warning = Diagnostic::warning(Code::IgnoredParameter, field.span, message);
            d.push_once(warning.help(help));
        }
    }
}

/// An instance of a part.
#[derive(Debug, Clone, PartialEq)]
pub struct Instance {
    /// Its name.
    pub name: Name,
    /// Where its nodes are.
    pub placement: Placement,
}

/// A translation and, after it, a rotation about a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Placement {
    /// The translation (length).
    pub translation: [f64; 2],
    /// Centre (length), and cosine and sine of the angle of the rotation.
    pub rotation: Option<([f64; 2], [f64; 2])>,
}

impl Placement {
    /// Where a point of the part is (length): `c + R (x + t - c)`.
    pub fn of(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [x, y] = [x + self.translation[0], y + self.translation[1]];
        let Some(([a, b], [cosine, sine])) = self.rotation else {
            return [x, y];
        };
        let [x, y] = [x - a, y - b];
        [a + cosine * x - sine * y, b + sine * x + cosine * y]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_moved_and_then_turned() {
        let moved = Placement {
            translation: [2.0, 1.0],
            rotation: None,
        };
        assert_eq!(moved.of([1.0, 0.0]), [3.0, 1.0]);
        let turned = Placement {
            rotation: Some(([1.0, 1.0], [0.0, 1.0])),
            ..moved
        };
        assert_eq!(turned.of([1.0, 0.0]), [1.0, 3.0]);
    }
}
