//! Types of the table of dimensions: what the fields and parameters of a keyword measure.

use super::keyword::{Parameter, Takes};

/// What a field or a parameter's value holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// A word, a label, or a number that is the same in all units.
    Plain,
    /// A number of this dimension, written as in the result file: `mass/length^3`.
    Of(&'static str),
    /// A number of the given dimension, and its default.
    OfOr(&'static str, &'static str),
    /// A number of this dimension or a name.
    OrName(&'static str),
    /// A number whose dimension is not known: other codes disagree on it.
    Unknown,
}

/// The fields of a kind of data line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RowForm {
    /// Parameter and value of the keyword line that these lines belong to.
    pub parameter: Option<(&'static str, &'static str)>,
    /// Number of a field, from 0, and the words that it says on these lines.
    pub word: Option<(usize, &'static [&'static str])>,
    /// What the fields hold.
    pub fields: &'static [Quantity],
    /// Whether the fields repeat along the line.
    pub repeats: bool,
}

/// What the numbers of a keyword measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dimensions {
    /// The keyword.
    pub keyword: &'static str,
    /// Kinds of data lines; the first that fits holds.
    pub rows: &'static [RowForm],
    /// Parameters that take names or numbers that are the same in all units.
    pub plain: &'static [&'static str],
    /// Parameters that take numbers with a dimension.
    pub measured: &'static [(&'static str, Quantity)],
    /// Whether the keyword takes any parameters and data, all without dimension.
    pub anything: bool,
}

impl Dimensions {
    /// What the value of a parameter measures; choices of words and flags measure nothing.
    pub(super) fn of(&self, parameter: &Parameter) -> Option<Quantity> {
        match parameter.takes {
            Takes::Nothing | Takes::Choice(_) | Takes::OptionalChoice(_) => Some(Quantity::Plain),
            Takes::Value | Takes::Optional if self.plain.contains(&parameter.name) => {
                Some(Quantity::Plain)
            }
            Takes::Value | Takes::Optional => {
                let mut measured = self.measured.iter();
                let found = measured.find(|(name, _)| *name == parameter.name);
                found.map(|&(_, quantity)| quantity)
            }
        }
    }
}
