//! Types of the keyword table: parameters and their values.

use super::fields::Quantity;

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
