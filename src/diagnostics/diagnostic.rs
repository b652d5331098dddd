//! A single diagnostic: severity, code, place, message, label and help; overlong echoes of the deck
//! are cut.

use super::{Code, Span};

/// Longest word of a message, in characters: a name has 80 at most, a path is often longer.
const LONGEST_WORD: usize = 200;

/// Longest message, in characters.
const LONGEST_TEXT: usize = 1000;

/// How serious a diagnostic is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// The deck is rejected.
    Error,
    /// The deck is read, but differently from what it says.
    Warning,
    /// Worth knowing.
    Note,
}

/// One message about one place of a deck.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// How serious it is.
    pub severity: Severity,
    /// What it is about.
    pub code: Code,
    /// Where; `None` without a place in the deck.
    pub span: Option<Span>,
    /// What was found and what was expected.
    pub message: String,
    /// Text beside the caret.
    pub label: Option<String>,
    /// What to do about it.
    pub help: Option<String>,
}

impl Diagnostic {
    /// An error at `span`.
    pub fn error(code: Code, span: Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(Severity::Error, code, Some(span), message.into())
    }

    /// A warning at `span`.
    pub fn warning(code: Code, span: Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(Severity::Warning, code, Some(span), message.into())
    }

    /// A note at `span`.
    pub fn note(code: Code, span: Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(Severity::Note, code, Some(span), message.into())
    }

    /// An error about a deck that cannot be opened: there is no line to show.
    pub fn error_without_place(code: Code, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(Severity::Error, code, None, message.into())
    }

    fn new(severity: Severity, code: Code, span: Option<Span>, message: String) -> Diagnostic {
        Diagnostic {
            severity,
            code,
            span,
            message: shortened(message),
            label: None,
            help: None,
        }
    }

    /// The same with text beside the caret.
    pub fn label(mut self, label: impl Into<String>) -> Diagnostic {
        self.label = Some(shortened(label.into()));
        self
    }

    /// The same with advice.
    pub fn help(mut self, help: impl Into<String>) -> Diagnostic {
        self.help = Some(shortened(help.into()));
        self
    }

    /// The same with "did you mean ...?" beside the caret, if there is a suggestion.
    pub fn suggest(self, suggestion: Option<impl AsRef<str>>) -> Diagnostic {
        match suggestion {
            Some(word) => self.label(format!("did you mean {}?", word.as_ref())),
            None => self,
        }
    }
}

/// A message with overlong words of the deck cut to readable length.
fn shortened(text: String) -> String {
    if text.len() <= LONGEST_WORD {
        return text;
    }
    let words = text.split(' ').map(|word| cut(word, LONGEST_WORD));
    cut(&words.collect::<Vec<_>>().join(" "), LONGEST_TEXT)
}

/// The beginning of a text, with three dots if it goes on.
fn cut(text: &str, length: usize) -> String {
    match text.char_indices().nth(length) {
        Some((end, _)) => format!("{}...", text.get(..end).unwrap_or_default()),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_echoed_is_cut() {
        let message = |text: &str| {
            let message = format!("unknown keyword *{text}, really");
            Diagnostic::error_without_place(Code::UnknownKeyword, message).message
        };
        assert_eq!(message("NODE"), "unknown keyword *NODE, really");
        let long = message(&"Ä".repeat(100_000));
        assert!(long.starts_with("unknown keyword *ÄÄ") && long.ends_with("Ä... really"));
        assert_eq!(long.chars().count(), 16 + LONGEST_WORD + 10);
        let many = message(&"A ".repeat(100_000));
        assert_eq!(many.chars().count(), LONGEST_TEXT + 3);
    }
}
