//! Cards with their parameters and data lines, and typed access to the parameters; a wrong or missing value is reported
//! with its place. Instances of parts: the cards of a part are copied to its instances.

use super::keywords::{Data, Keyword};
use super::lines::{Line, Lines};
use super::text::{Name, Text};
use crate::diagnostics::{Code, Diagnostics, FileId, Span};
use std::cell::Cell;
use std::ops::Range;
use std::sync::Arc;

/// A keyword line and its data lines.
#[derive(Debug, Clone)]
pub struct Card {
    /// The keyword.
    pub keyword: &'static Keyword,
    /// Place of the keyword in the text.
    pub span: Span,
    /// Whether an error of the keyword line has been reported.
    pub faulty: bool,
    /// Whether the deck of a later job adds the card to the model of the earlier job.
    pub added: bool,
    /// Data lines of the card.
    pub rows: DataLines,
    pub(crate) params: Vec<Param>,
}

/// A parameter of a keyword line.
#[derive(Debug, Clone)]
pub struct Param {
    /// Name of the parameter in full.
    pub name: &'static str,
    /// Place of the whole parameter in the text.
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

    /// The same card, with its names and numbers read as names and numbers of an instance of a part.
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

    /// The same card, with the names and numbers in its rows read as names and numbers of an instance of a part.
    pub(crate) fn with_rows_in(mut self, instance: u32) -> Card {
        self.rows.instance = instance;
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

    /// The value of a parameter, if the parameter is given and the value can be read.
    pub fn value(&self, name: &str) -> Option<Text<'_>> {
        let param = self.param(name).filter(|param| !param.faulty)?;
        let (text, span) = param.value.as_ref()?;
        Some(Text { text, span: *span })
    }

    /// The value of a parameter that must be given.
    pub fn required(&self, name: &str, d: &mut Diagnostics) -> Option<Text<'_>> {
        if self.param(name).is_none() && !self.faulty {
            let message = format!("{} needs the parameter {name}", self.title());
            d.error(Code::MissingParameter, self.span, message);
        }
        self.value(name)
    }

    /// Value of a parameter that is chosen from a list of words, as the full word.
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

    /// Marks all parameters and data lines as read, because another message says that the card is left out.
    pub fn leave_out(&self) {
        self.params.iter().for_each(|param| param.used.set(true));
        self.rows.read.set(ALL_ROWS);
    }

    /// Warns about parameters that the reader has not used, and reports the first row that the reader has not read.
    pub fn report_unused(&self, d: &mut Diagnostics) {
        let read = self.rows.read.get();
        let may_be_left = read != ALL_ROWS && self.keyword.data != Data::Text;
        let mut rows = self.rows.lines().flat_map(Lines::data);
        if let Some(row) = may_be_left.then(|| rows.nth(read)).flatten() {
            let lines = match read {
                0 => "no data line is".to_owned(),
                1 => "only 1 data line is".to_owned(),
                more => format!("only {more} data lines are"),
            };
            let message = format!("{lines} read under this {}", self.title());
            d.error(Code::StrayData, row.span(), message);
        }
        let unused = |p: &&Param| !p.used.get() && !p.faulty && !self.holds_anyway(p);
        for param in self.params.iter().filter(unused) {
            let message = format!("{} of {} has no effect here", param.name, self.title());
            d.warning(Code::IgnoredParameter, param.span, message);
        }
    }

    /// Whether the value of a parameter is its default, so that leaving the parameter out changes nothing.
    fn holds_anyway(&self, param: &Param) -> bool {
        let known = self.keyword.parameter(param.name);
        let mut words = known.map_or(&[][..], |known| known.values()).iter();
        words.any(|word| Some(word.name) == param.choice && word.is_default())
    }
}

/// Data lines of a card: blocks of the texts of its files, cut into lines and fields on demand. The rows that the
/// reader has asked for are counted.
#[derive(Debug, Clone, Default)]
pub struct DataLines {
    blocks: Vec<LineBlock>,
    instance: u32,
    /// Number of rows up to the last row that the reader has asked for; [`ALL_ROWS`] for all rows.
    read: Cell<usize>,
}

/// Number of read rows that stands for all rows: no card has as many rows.
const ALL_ROWS: usize = usize::MAX;

/// A block of consecutive lines of a file without a keyword line among them.
#[derive(Debug, Clone)]
struct LineBlock {
    file: FileId,
    /// Text of the whole file.
    source: Arc<String>,
    /// Range of the bytes of the lines.
    bytes: Range<usize>,
    /// Number of the line before the block.
    before: u32,
}

impl DataLines {
    /// Adds lines of the file with the text `source`.
    pub(super) fn add(&mut self, lines: Lines, source: &Arc<String>) {
        self.blocks.push(LineBlock {
            file: lines.file,
            source: Arc::clone(source),
            bytes: lines.start..lines.text.len(),
            before: lines.before,
        });
    }

    /// The lines block by block.
    fn lines(&self) -> impl Iterator<Item = Lines<'_>> + Clone {
        self.blocks.iter().map(|block| Lines {
            file: block.file,
            text: block.source.get(..block.bytes.end).unwrap_or(""),
            start: block.bytes.start,
            before: block.before,
            instance: self.instance,
        })
    }

    /// Whether the card has no data lines.
    pub fn is_empty(&self) -> bool {
        self.lines().flat_map(Lines::data).next().is_none()
    }

    /// The first row.
    pub fn first(&self) -> Option<Line<'_>> {
        self.iter().next()
    }

    /// Row `index`, from 0.
    pub fn get(&self, index: usize) -> Option<Line<'_>> {
        self.iter().nth(index)
    }

    /// All rows of the card in order.
    pub fn iter(&self) -> impl Iterator<Item = Line<'_>> + Clone {
        let rows = self.lines().flat_map(Lines::data).zip(1..);
        let rows = rows.map(|(row, number)| {
            self.read.set(self.read.get().max(number));
            row
        });
        let end = std::iter::once(()).filter_map(|()| {
            self.read.set(ALL_ROWS);
            None
        });
        rows.chain(end)
    }

    /// Number of lines; blank lines and comments among them hold no row.
    pub fn line_count(&self) -> usize {
        self.lines().map(|lines| lines.count_lines() as usize).sum()
    }
}

/// An instance of a part.
#[derive(Debug, Clone, PartialEq)]
pub struct Instance {
    /// Name of the instance.
    pub name: Name,
    /// Placement of the nodes of the instance.
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
    /// Place of a point of the part in the instance (length): `c + R (x + t - c)`.
    pub fn of(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [x, y] = [x + self.translation[0], y + self.translation[1]];
        let Some(([a, b], [cosine, sine])) = self.rotation else {
            return [x, y];
        };
        let [x, y] = [x - a, y - b];
        [a + cosine * x - sine * y, b + sine * x + cosine * y]
    }

    /// Direction of the part in the instance: `R n`.
    pub fn turn(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        match self.rotation {
            Some((_, [cosine, sine])) => [cosine * x - sine * y, sine * x + cosine * y],
            None => [x, y],
        }
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
        assert_eq!(moved.turn([1.0, 0.0]), [1.0, 0.0]);
        assert_eq!(turned.turn([1.0, 0.0]), [0.0, 1.0]);
    }
}
