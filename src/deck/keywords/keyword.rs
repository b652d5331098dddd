//! Types of the keyword table: keywords, parameters and values with what the program does with
//! each.

use crate::deck::lines::word;

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
    /// Structure of assembly decks.
    Assembly,
}

/// Data lines of a keyword.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Data {
    /// None.
    None,
    /// Any number of rows.
    Rows,
    /// At least one row.
    Required,
    /// Free text.
    Text,
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
    /// What the program does with it.
    pub status: Status,
    /// One sentence.
    pub text: &'static str,
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
    /// One sentence.
    pub text: &'static str,
}

impl Keyword {
    /// The parameter with this name, blanks and case aside.
    pub fn parameter(&self, name: &str) -> Option<&'static Parameter> {
        let folded = word::fold(name);
        self.parameters
            .iter()
            .find(|p| word::fold(p.name) == folded)
    }

    pub(crate) const fn read(
        name: &'static str,
        scope: Scope,
        data: Data,
        parameters: &'static [Parameter],
        text: &'static str,
    ) -> Keyword {
        Keyword {
            name,
            status: Status::Read,
            scope,
            data,
            parameters,
            text,
        }
    }

    pub(crate) const fn other(name: &'static str, status: Status, text: &'static str) -> Keyword {
        Keyword {
            name,
            status,
            scope: Scope::Anywhere,
            data: Data::Rows,
            parameters: &[],
            text,
        }
    }
}

impl Parameter {
    const fn new(name: &'static str, takes: Takes, text: &'static str) -> Parameter {
        Parameter {
            name,
            takes,
            status: Status::Read,
            text,
        }
    }

    pub(crate) const fn flag(name: &'static str, text: &'static str) -> Parameter {
        Parameter::new(name, Takes::Nothing, text)
    }

    pub(crate) const fn value(name: &'static str, text: &'static str) -> Parameter {
        Parameter::new(name, Takes::Value, text)
    }

    pub(crate) const fn optional(name: &'static str, text: &'static str) -> Parameter {
        Parameter::new(name, Takes::Optional, text)
    }

    pub(crate) const fn choice(
        name: &'static str,
        values: &'static [Value],
        text: &'static str,
    ) -> Parameter {
        Parameter::new(name, Takes::Choice(values), text)
    }

    pub(crate) const fn optional_choice(
        name: &'static str,
        values: &'static [Value],
        text: &'static str,
    ) -> Parameter {
        Parameter::new(name, Takes::OptionalChoice(values), text)
    }

    pub(crate) const fn ignored(self) -> Parameter {
        self.with(Status::Ignored)
    }

    pub(crate) const fn warned(self) -> Parameter {
        self.with(Status::Warned)
    }

    pub(crate) const fn refused(self) -> Parameter {
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
    pub(crate) const fn read(name: &'static str, text: &'static str) -> Value {
        Value::new(name, Status::Read, text)
    }

    pub(crate) const fn warned(name: &'static str, text: &'static str) -> Value {
        Value::new(name, Status::Warned, text)
    }

    pub(crate) const fn refused(name: &'static str, text: &'static str) -> Value {
        Value::new(name, Status::Refused, text)
    }

    const fn new(name: &'static str, status: Status, text: &'static str) -> Value {
        Value { name, status, text }
    }
}
