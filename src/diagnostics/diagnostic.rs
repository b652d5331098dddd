use super::{Code, Span};

/// How serious a diagnostic is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// The deck is rejected.
    Error,
    /// The deck is read, but not quite as written.
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
    /// Where, if it has a place.
    pub span: Option<Span>,
    /// What was found and what was expected.
    pub message: String,
    /// Words beside the caret.
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
            message,
            label: None,
            help: None,
        }
    }

    /// The same with words beside the caret.
    pub fn label(mut self, label: impl Into<String>) -> Diagnostic {
        self.label = Some(label.into());
        self
    }

    /// The same with advice.
    pub fn help(mut self, help: impl Into<String>) -> Diagnostic {
        self.help = Some(help.into());
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
