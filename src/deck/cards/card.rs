//! Cards with their parameters and data lines, and typed access to both; a wrong or missing value
//! is reported with its place.

use super::rows::Rows;
use crate::deck::keywords::Keyword;
use crate::deck::lines::Text;
use crate::diagnostics::{Code, Diagnostic, Diagnostics, Span};
use std::cell::Cell;

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
