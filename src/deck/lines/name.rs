//! User-defined names (of sets, surfaces, materials, ...) and the rule by which they are compared.

use crate::deck::lines::word;

/// A name in a deck: shown as typed, compared without case unless it was quoted.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Name {
    /// As typed, without quotation marks.
    pub typed: String,
    /// As compared: upper case without blanks, or as typed if quoted.
    pub key: String,
}

impl Name {
    /// A name without quotation marks.
    pub fn plain(typed: &str) -> Name {
        Name {
            typed: typed.to_string(),
            key: word::fold(typed),
        }
    }

    /// A name between quotation marks.
    pub fn quoted(typed: &str) -> Name {
        Name {
            typed: typed.to_string(),
            key: typed.to_string(),
        }
    }
}

impl std::fmt::Display for Name {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.typed)
    }
}
