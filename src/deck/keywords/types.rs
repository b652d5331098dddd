//! Types of the keyword table: keywords with their place, data lines, sentence and example; their
//! parameters and values; the fields of data lines, and what numbers measure.

use crate::deck::text::fold;

/// Where a keyword may stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// Before the first step.
    Model,
    /// Between `*STEP` and `*END STEP`.
    Step,
    /// Before the first step or in a step.
    Anywhere,
    /// In the block of the model keyword of this name.
    Block(&'static str),
    /// There, or by itself before the first step.
    BlockOrModel(&'static str),
    /// Structure of assembly decks.
    Assembly,
}

/// Data lines of a keyword.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Data {
    /// None.
    None,
    /// Any number of rows; the first form that fits a row holds.
    Rows(&'static [RowForm]),
    /// At least one row.
    Required(&'static [RowForm]),
    /// Free text.
    Text,
    /// Words that are not looked at.
    Words,
    /// Anything, which is not looked at.
    Skipped,
}

impl Data {
    /// The kinds of data lines.
    pub fn forms(self) -> &'static [RowForm] {
        match self {
            Data::Rows(forms) | Data::Required(forms) => forms,
            Data::None | Data::Text | Data::Words | Data::Skipped => &[],
        }
    }
}

/// A known keyword.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Keyword {
    /// The keyword without its star, with blanks.
    pub name: &'static str,
    /// What the program does with it.
    pub status: Status,
    /// Where it may stand.
    pub scope: Scope,
    /// Its data lines.
    pub data: Data,
    /// Its parameters.
    pub parameters: &'static [Parameter],
    /// What it says.
    pub text: &'static str,
    /// Lines of a deck that use it, or what is read in its place; empty if there is nothing.
    pub example: &'static str,
}

impl Keyword {
    /// The parameter with this name, blanks and case aside.
    pub fn parameter(&self, name: &str) -> Option<&'static Parameter> {
        let folded = fold(name);
        self.parameters.iter().find(|p| fold(p.name) == folded)
    }

    /// A keyword that is read.
    pub(super) const fn read(
        name: &'static str,
        scope: Scope,
        data: Data,
        parameters: &'static [Parameter],
        text: &'static str,
        example: &'static str,
    ) -> Keyword {
        Keyword {
            name,
            status: Status::Read,
            scope,
            data,
            parameters,
            text,
            example,
        }
    }

    /// A keyword that is left out silently.
    pub(super) const fn ignored(name: &'static str, text: &'static str) -> Keyword {
        Keyword::unread(name, Status::Ignored, text)
    }

    /// A keyword that is left out with a warning.
    pub(super) const fn warned(name: &'static str, text: &'static str) -> Keyword {
        Keyword::unread(name, Status::Warned, text)
    }

    /// A keyword that stops with an error.
    pub(super) const fn refused(name: &'static str, text: &'static str) -> Keyword {
        Keyword::unread(name, Status::Refused, text)
    }

    const fn unread(name: &'static str, status: Status, text: &'static str) -> Keyword {
        Keyword {
            status,
            ..Keyword::read(name, Scope::Anywhere, Data::Skipped, &[], text, "")
        }
    }

    /// The same with lines of a deck that say in another way what it says.
    pub(super) const fn example(self, example: &'static str) -> Keyword {
        Keyword { example, ..self }
    }

    /// The same with words only in its parameters and data lines.
    pub(super) const fn of_words(self) -> Keyword {
        Keyword {
            data: Data::Words,
            ..self
        }
    }
}

/// What the program does with a keyword, a parameter or a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Read and honoured.
    Read,
    /// Left out silently: it does not affect the results.
    Ignored,
    /// Left out or replaced with a warning.
    Warned,
    /// Stops with an error: leaving it out would change the results.
    Refused,
}

/// Values of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Takes {
    /// None.
    Nothing,
    /// A name, number or path.
    Value,
    /// A value that may be left out.
    Optional,
    /// One of these words.
    Choice(&'static [Value]),
    /// One of these words, or nothing.
    OptionalChoice(&'static [Value]),
}

/// A word that a parameter can take as its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Value {
    /// The word, with blanks.
    pub name: &'static str,
    /// What the program does with it.
    pub status: Status,
    /// One sentence; empty where the word explains itself.
    pub text: &'static str,
}

/// A parameter of a keyword.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Parameter {
    /// The word before the equals sign, with blanks.
    pub name: &'static str,
    /// Its values.
    pub takes: Takes,
    /// What a value measures.
    pub holds: Quantity,
    /// What the program does with it.
    pub status: Status,
    /// One sentence.
    pub text: &'static str,
}

impl Parameter {
    const fn new(name: &'static str, takes: Takes, text: &'static str) -> Parameter {
        Parameter {
            name,
            takes,
            holds: Quantity::Plain,
            status: Status::Read,
            text,
        }
    }

    /// A parameter without value.
    pub(super) const fn flag(name: &'static str, text: &'static str) -> Parameter {
        Parameter::new(name, Takes::Nothing, text)
    }

    /// A name, a path, or a number that is the same in all units.
    pub(super) const fn value(name: &'static str, text: &'static str) -> Parameter {
        Parameter::new(name, Takes::Value, text)
    }

    /// A name or a number that is the same in all units; it may be left out.
    pub(super) const fn optional(name: &'static str, text: &'static str) -> Parameter {
        Parameter::new(name, Takes::Optional, text)
    }

    pub(super) const fn choice(
        name: &'static str,
        values: &'static [Value],
        text: &'static str,
    ) -> Parameter {
        Parameter::new(name, Takes::Choice(values), text)
    }

    pub(super) const fn optional_choice(
        name: &'static str,
        values: &'static [Value],
        text: &'static str,
    ) -> Parameter {
        Parameter::new(name, Takes::OptionalChoice(values), text)
    }

    /// The same for a number that measures something.
    pub(super) const fn measuring(self, holds: Quantity) -> Parameter {
        Parameter { holds, ..self }
    }

    pub(super) const fn ignored(self) -> Parameter {
        self.with(Status::Ignored)
    }

    pub(super) const fn warned(self) -> Parameter {
        self.with(Status::Warned)
    }

    pub(super) const fn refused(self) -> Parameter {
        self.with(Status::Refused)
    }

    const fn with(self, status: Status) -> Parameter {
        Parameter { status, ..self }
    }

    /// The words this parameter can take; empty if it takes anything.
    pub fn values(&self) -> &'static [Value] {
        match self.takes {
            Takes::Choice(values) | Takes::OptionalChoice(values) => values,
            Takes::Nothing | Takes::Value | Takes::Optional => &[],
        }
    }
}

impl Value {
    pub(super) const fn read(name: &'static str, text: &'static str) -> Value {
        Value::new(name, Status::Read, text)
    }

    pub(super) const fn warned(name: &'static str, text: &'static str) -> Value {
        Value::new(name, Status::Warned, text)
    }

    pub(super) const fn refused(name: &'static str, text: &'static str) -> Value {
        Value::new(name, Status::Refused, text)
    }

    const fn new(name: &'static str, status: Status, text: &'static str) -> Value {
        Value { name, status, text }
    }
}

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
