//! Types of the keyword table: keywords with their place, data lines, sentence and example.

use super::fields::RowForm;
use super::parameter::{Parameter, Status};
use crate::deck::lines::word;

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
        let folded = word::fold(name);
        self.parameters
            .iter()
            .find(|p| word::fold(p.name) == folded)
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
