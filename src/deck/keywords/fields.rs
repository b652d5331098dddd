//! Types of the keyword table: the fields of data lines, and what numbers measure.

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

impl Quantity {
    /// The dimension, if it has a known one.
    pub fn dimension(self) -> Option<&'static str> {
        match self {
            Quantity::Plain | Quantity::Unknown => None,
            Quantity::Of(dimension)
            | Quantity::OfOr(dimension, _)
            | Quantity::OrName(dimension) => Some(dimension),
        }
    }
}

/// A field of a data line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// What it is called in the reference.
    pub name: &'static str,
    /// What it holds.
    pub holds: Quantity,
}

/// A field of words, labels or numbers that are the same in all units.
pub(super) const fn plain(name: &'static str) -> Field {
    of(name, Quantity::Plain)
}

/// A field that measures something.
pub(super) const fn of(name: &'static str, holds: Quantity) -> Field {
    Field { name, holds }
}

/// The fields of a kind of data line; the conditions say which lines are of this kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RowForm {
    /// Parameter and value of the keyword line that these lines belong to; an empty value stands
    /// for a parameter without value.
    pub parameter: Option<(&'static str, &'static str)>,
    /// Number of a field, from 0, and the words that it says on these lines.
    pub word: Option<(usize, &'static [&'static str])>,
    /// Whether it is the first data line only.
    pub first: bool,
    /// What the fields hold.
    pub fields: &'static [Field],
    /// Number of the last fields that repeat along the line.
    pub repeating: usize,
}

/// Data lines with these fields.
pub(super) const fn row(fields: &'static [Field]) -> RowForm {
    RowForm {
        parameter: None,
        word: None,
        first: false,
        fields,
        repeating: 0,
    }
}

impl RowForm {
    /// The same with the last so many fields repeated along the line.
    pub(super) const fn repeating(self, repeating: usize) -> RowForm {
        RowForm { repeating, ..self }
    }

    /// The same for lines under this value of a parameter.
    pub(super) const fn under(self, parameter: &'static str, value: &'static str) -> RowForm {
        RowForm {
            parameter: Some((parameter, value)),
            ..self
        }
    }

    /// The same for lines that say one of these words in a field, which counts from 0.
    pub(super) const fn saying(self, field: usize, words: &'static [&'static str]) -> RowForm {
        RowForm {
            word: Some((field, words)),
            ..self
        }
    }

    /// The same for the first data line only.
    pub(super) const fn first(self) -> RowForm {
        RowForm {
            first: true,
            ..self
        }
    }
}

pub(super) const LENGTH: Quantity = Quantity::Of("length");
pub(super) const AREA: Quantity = Quantity::Of("length^2");
pub(super) const TIME: Quantity = Quantity::Of("time");
pub(super) const PER_TIME: Quantity = Quantity::Of("1/time");
pub(super) const VELOCITY: Quantity = Quantity::Of("length/time");
pub(super) const ACCELERATION: Quantity = Quantity::Of("length/time^2");
pub(super) const DENSITY: Quantity = Quantity::Of("mass/length^3");
pub(super) const FORCE: Quantity = Quantity::Of("force");
pub(super) const STRESS: Quantity = Quantity::Of("force/length^2");
pub(super) const COMPRESSIBILITY: Quantity = Quantity::Of("length^2/force");
pub(super) const FORCE_PER_VOLUME: Quantity = Quantity::Of("force/length^3");
