//! Cards with their parameters and data lines, and typed access to both; a wrong or missing value
//! is reported with its place.

use crate::deck::keywords::Keyword;
use crate::deck::lines::{Fields, Line, Text, span_in};
use crate::diagnostics::{Code, Diagnostic, Diagnostics, FileId, Span};
use std::cell::Cell;
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
    pub rows: Vec<Row>,
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
        let rows = self.rows.into_iter();
        self.rows = rows.map(|row| row.in_instance(instance)).collect();
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

/// A data line: a place in the text of its file, cut into fields when they are asked for.
#[derive(Debug, Clone)]
pub struct Row {
    /// Text of the whole file.
    source: Arc<str>,
    /// Byte at which the line starts.
    start: usize,
    /// Bytes of the line.
    length: u32,
    file: FileId,
    line: u32,
    instance: u32,
}

impl Row {
    /// A line of the file with the text `source`.
    pub(crate) fn new(line: &Line, source: &Arc<str>) -> Row {
        Row {
            source: Arc::clone(source),
            start: line.start,
            length: line.text.len() as u32,
            file: line.file,
            line: line.number,
            instance: 0,
        }
    }

    /// The line as typed.
    pub fn text(&self) -> &str {
        let end = self.start + self.length as usize;
        self.source.get(self.start..end).unwrap_or("")
    }

    /// Place of the visible text.
    pub fn span(&self) -> Span {
        let text = self.text();
        let start = text.len() - text.trim_start().len();
        self.span_between(start, text.trim_end().len())
    }

    fn span_between(&self, start: usize, end: usize) -> Span {
        Span {
            instance: self.instance,
            ..span_in(self.text(), self.file, self.line, start, end)
        }
    }

    /// The same row, its names and numbers being those of an instance of a part.
    pub(crate) fn in_instance(mut self, instance: u32) -> Row {
        self.instance = instance;
        self
    }

    /// All fields in order, empty ones included.
    pub fn fields(&self) -> impl Iterator<Item = Text<'_>> {
        let text = self.text();
        Fields::new(text).map(move |(start, end)| Text {
            text: text.get(start..end).unwrap_or(""),
            span: self.span_between(start, end),
        })
    }

    /// Field `index`, from 0; `None` where it is blank.
    pub fn get(&self, index: usize) -> Option<Text<'_>> {
        self.fields().nth(index).filter(|field| !field.is_empty())
    }

    /// Field `index`; reports that `what` is missing where it is blank.
    pub fn required(&self, index: usize, what: &str, d: &mut Diagnostics) -> Option<Text<'_>> {
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
    pub fn real(&self, index: usize, what: &str, d: &mut Diagnostics) -> Option<f64> {
        self.required(index, what, d)?.real(d)
    }

    /// The number in field `index`, or `default` where it is blank.
    pub fn real_or(&self, index: usize, default: f64, d: &mut Diagnostics) -> Option<f64> {
        match self.get(index) {
            Some(field) => field.real(d),
            None => Some(default),
        }
    }

    /// Reports fields beyond the first `count`.
    pub fn at_most(&self, count: usize, d: &mut Diagnostics) {
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
    fn has_decimal_comma(&self) -> bool {
        let fields: Vec<Text> = self.fields().skip(1).collect();
        fields
            .windows(2)
            .any(|pair| pair.iter().all(Text::is_digits))
    }

    /// Warns that the first field from `count` on that is not blank has no effect.
    pub fn without_effect(&self, count: usize, message: &str, help: &str, d: &mut Diagnostics) {
        if let Some(field) = self.fields().skip(count).find(|field| !field.is_empty()) {
            let warning = Diagnostic::warning(Code::IgnoredParameter, field.span, message);
            d.push_once(warning.help(help));
        }
    }
}
