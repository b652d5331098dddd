//! Diagnostics with severity, code, place, message, label and help, in which overlong echoes of the deck are cut. The
//! module also has the collection of the diagnostics of one deck, with counts by severity, strictness, and order by
//! place.

use super::code::Code;
use std::collections::{BinaryHeap, HashMap, HashSet};

/// Longest word of a message, in characters: a name has at most 80, a path often more.
const LONGEST_WORD: usize = 200;

/// Longest message, in characters.
const LONGEST_TEXT: usize = 1000;

/// Severity of a diagnostic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// An error: the deck is rejected.
    Error,
    /// A warning: the deck is read, but perhaps not as its author intends.
    Warning,
    /// Worth knowing.
    Note,
}

/// One message about one place of a deck.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// Severity of the diagnostic.
    pub severity: Severity,
    /// Subject of the diagnostic.
    pub code: Code,
    /// Place in the deck; `None` if the diagnostic has no place.
    pub span: Option<Span>,
    /// Text that says what was found and what was expected.
    pub message: String,
    /// Text next to the caret.
    pub label: Option<String>,
    /// Word that was probably meant at the caret.
    pub suggestion: Option<String>,
    /// Advice on what to do about the diagnostic.
    pub help: Option<String>,
    /// Another card that the diagnostic is about, and its place.
    pub other: Option<(String, Span)>,
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

    fn new(severity: Severity, code: Code, span: Option<Span>, message: String) -> Diagnostic {
        Diagnostic {
            severity,
            code,
            span,
            message: shortened(message),
            label: None,
            suggestion: None,
            help: None,
            other: None,
        }
    }

    /// The same diagnostic with text next to the caret.
    pub fn label(mut self, label: impl Into<String>) -> Diagnostic {
        self.label = Some(shortened(label.into()));
        self
    }

    /// The same diagnostic with advice.
    pub fn help(mut self, help: impl Into<String>) -> Diagnostic {
        self.help = Some(shortened(help.into()));
        self
    }

    /// The same diagnostic with "did you mean ...?" next to the caret, if there is a suggestion.
    pub fn suggest(self, suggestion: Option<impl AsRef<str>>) -> Diagnostic {
        match suggestion {
            Some(word) => Diagnostic {
                suggestion: Some(word.as_ref().to_owned()),
                ..self.label(format!("did you mean {}?", word.as_ref()))
            },
            None => self,
        }
    }
}

/// A diagnostic that has been added, or `None` if the same diagnostic was added before.
pub struct Added<'d>(Option<&'d mut Diagnostic>);

impl Added<'_> {
    /// Puts text next to the caret of the diagnostic.
    pub fn label(self, label: impl Into<String>) -> Self {
        self.with(|added| added.label = Some(shortened(label.into())))
    }

    /// Puts "did you mean ...?" next to the caret, if there is a suggestion.
    pub fn suggest(self, suggestion: Option<impl AsRef<str>>) -> Self {
        self.with(|added| *added = added.clone().suggest(suggestion))
    }

    /// Gives advice.
    pub fn help(self, help: impl Into<String>) -> Self {
        self.with(|added| added.help = Some(shortened(help.into())))
    }

    /// Names another card that the diagnostic is about, with its place.
    pub fn other(self, what: impl Into<String>, span: Span) -> Self {
        self.with(|added| added.other = Some((shortened(what.into()), span)))
    }

    fn with(mut self, change: impl FnOnce(&mut Diagnostic)) -> Self {
        self.0.as_deref_mut().map(change);
        self
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

/// The beginning of a text, followed by three dots if the text is longer.
fn cut(text: &str, length: usize) -> String {
    match text.char_indices().nth(length) {
        Some((end, _)) => format!("{}...", text.get(..end).unwrap_or_default()),
        None => text.to_owned(),
    }
}

/// Largest number of diagnostics of one severity that are shown.
pub(super) const SHOWN: usize = 20;

/// Treatment of unknown keywords and of warnings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Strictness {
    /// Unknown keywords and parameters are errors.
    #[default]
    Normal,
    /// Unknown keywords and parameters are left out with a warning.
    Lenient,
    /// Every warning is an error.
    Strict,
}

/// All diagnostics of one deck.
#[derive(Debug, Clone, Default)]
pub struct Diagnostics {
    strictness: Strictness,
    items: Vec<Diagnostic>,
    counts: [usize; 3],
    /// Places in the list of the diagnostics that are shown: the first diagnostics of each severity.
    first: [BinaryHeap<Option<Span>>; 3],
    said: HashMap<Code, HashSet<String>>,
    /// Instance in which a line of a part was reported, by code and place.
    in_parts: HashMap<(Code, Span), u32>,
    /// Number of errors found, including repetitions at the same line of a part in further
    /// instances.
    errors: usize,
}

impl Diagnostics {
    /// An empty collection with normal strictness.
    pub fn new() -> Diagnostics {
        Diagnostics::default()
    }

    /// An empty collection with the rules of `strictness`.
    pub fn with_strictness(strictness: Strictness) -> Diagnostics {
        Diagnostics {
            strictness,
            ..Diagnostics::default()
        }
    }

    /// Whether unknown keywords and parameters are left out with a warning.
    pub fn is_lenient(&self) -> bool {
        self.strictness == Strictness::Lenient
    }

    /// Adds an error at `span`.
    pub fn error(&mut self, code: Code, span: Span, message: impl Into<String>) -> Added<'_> {
        self.push(Diagnostic::error(code, span, message))
    }

    /// Adds an error about a deck that cannot be opened, so the message shows no line.
    pub fn error_without_place(&mut self, code: Code, message: impl Into<String>) -> Added<'_> {
        self.push(Diagnostic::new(Severity::Error, code, None, message.into()))
    }

    /// Adds a warning at `span`.
    pub fn warning(&mut self, code: Code, span: Span, message: impl Into<String>) -> Added<'_> {
        self.push(Diagnostic::warning(code, span, message))
    }

    /// Adds a note at `span`.
    pub fn note(&mut self, code: Code, span: Span, message: impl Into<String>) -> Added<'_> {
        self.push(Diagnostic::note(code, span, message))
    }

    /// Adds a warning at `span` unless a warning with the same code and message was added by this function before.
    pub fn warning_once(&mut self, code: Code, span: Span, message: impl AsRef<str>) -> Added<'_> {
        self.once(code, message.as_ref(), |message| {
            Diagnostic::warning(code, span, message)
        })
    }

    /// Adds a note at `span` unless a note with the same code and message was added by this function before.
    pub fn note_once(&mut self, code: Code, span: Span, message: impl AsRef<str>) -> Added<'_> {
        self.once(code, message.as_ref(), |message| {
            Diagnostic::note(code, span, message)
        })
    }

    fn once(
        &mut self,
        code: Code,
        message: &str,
        make: impl FnOnce(String) -> Diagnostic,
    ) -> Added<'_> {
        let said = self.said.entry(code).or_default();
        if said.contains(message) {
            return Added(None);
        }
        said.insert(message.to_owned());
        self.push(make(message.to_owned()))
    }

    /// Adds a diagnostic; a diagnostic at a line of a part is added once, however many instances the part has.
    pub fn push(&mut self, mut diagnostic: Diagnostic) -> Added<'_> {
        diagnostic.severity = self.judge(&diagnostic);
        self.errors += usize::from(diagnostic.severity == Severity::Error);
        if self.is_of_another_instance(&diagnostic) {
            return Added(None);
        }
        self.counts[diagnostic.severity as usize] += 1;
        let first = &mut self.first[diagnostic.severity as usize];
        first.push(diagnostic.span);
        if first.len() > SHOWN {
            first.pop();
        }
        self.items.push(diagnostic);
        Added(self.items.last_mut())
    }

    /// Whether a diagnostic was already added for the same line of the part in another instance.
    fn is_of_another_instance(&mut self, diagnostic: &Diagnostic) -> bool {
        let Some(span) = diagnostic.span.filter(|span| span.instance > 0) else {
            return false;
        };
        let line = Span {
            instance: 0,
            ..span
        };
        let first = self.in_parts.entry((diagnostic.code, line));
        *first.or_insert(span.instance) != span.instance
    }

    /// Number of errors found, including repetitions in further instances of a part, which [`Self::count`] leaves out.
    pub fn errors_found(&self) -> usize {
        self.errors
    }

    /// Whether a diagnostic would be shown if it were added as the last one. Suggestions that need time are made only
    /// for diagnostics that would be shown; later diagnostics never make hidden diagnostics visible.
    pub fn may_show(&self, diagnostic: &Diagnostic) -> bool {
        let first = &self.first[self.judge(diagnostic) as usize];
        first.len() < SHOWN || first.peek().is_some_and(|last| diagnostic.span < *last)
    }

    fn judge(&self, diagnostic: &Diagnostic) -> Severity {
        let unknown = matches!(
            diagnostic.code,
            Code::UnknownKeyword | Code::UnknownParameter
        );
        match (self.strictness, diagnostic.severity) {
            (Strictness::Strict, Severity::Warning) => Severity::Error,
            (Strictness::Lenient, Severity::Error) if unknown => Severity::Warning,
            (_, severity) => severity,
        }
    }

    /// Whether the deck is rejected.
    pub fn has_errors(&self) -> bool {
        self.count(Severity::Error) > 0
    }

    /// Number of diagnostics of a severity.
    pub fn count(&self, severity: Severity) -> usize {
        self.counts[severity as usize]
    }

    /// All diagnostics except the diagnostics with one code.
    pub fn without(&self, code: Code) -> Diagnostics {
        let mut rest = Diagnostics::with_strictness(self.strictness);
        for item in self.items.iter().filter(|item| item.code != code) {
            rest.counts[item.severity as usize] += 1;
            rest.items.push(item.clone());
        }
        rest
    }

    /// All diagnostics in the order they were found.
    pub fn iter(&self) -> impl Iterator<Item = &Diagnostic> {
        self.items.iter()
    }

    /// All diagnostics in the order of their places (file, line, column); diagnostics without a place come first.
    pub fn sorted(&self) -> Vec<&Diagnostic> {
        let mut sorted: Vec<&Diagnostic> = self.items.iter().collect();
        sorted.sort_by_key(|item| (item.span, item.severity));
        sorted
    }
}

/// Index of a file among the sources of a deck.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct FileId(pub u32);

/// A range of characters in one line of a deck file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Span {
    /// File.
    pub file: FileId,
    /// Line, from 1.
    pub line: u32,
    /// Column of the first character, from 1.
    pub column: u32,
    /// Number of characters.
    pub length: u32,
    /// Number, from 1, of the instance of a part whose copy of the line is meant; 0 for the line
    /// itself.
    pub instance: u32,
}

impl Span {
    /// The first character of a file.
    pub fn start_of(file: FileId) -> Self {
        Span {
            file,
            line: 1,
            column: 1,
            length: 1,
            instance: 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_echoed_is_cut() {
        let message = |text: &str| {
            let message = format!("unknown keyword *{text}, really");
            Diagnostic::error(Code::UnknownKeyword, Span::default(), message).message
        };
        assert_eq!(message("NODE"), "unknown keyword *NODE, really");
        let long = message(&"Ä".repeat(100_000));
        assert!(long.starts_with("unknown keyword *ÄÄ") && long.ends_with("Ä... really"));
        assert_eq!(long.chars().count(), 16 + LONGEST_WORD + 10);
        let many = message(&"A ".repeat(100_000));
        assert_eq!(many.chars().count(), LONGEST_TEXT + 3);
    }

    #[test]
    fn what_may_be_shown_is_among_the_first_by_place() {
        let at = |line| {
            let span = Span {
                line,
                ..Span::default()
            };
            Diagnostic::error(Code::UndefinedName, span, "")
        };
        let mut d = Diagnostics::new();
        for line in 0..SHOWN as u32 {
            assert!(d.may_show(&at(100 + line)));
            d.push(at(100 + line));
        }
        assert!(d.may_show(&at(118)) && !d.may_show(&at(119)) && !d.may_show(&at(500)));
        d.push(at(3));
        assert!(d.may_show(&at(117)) && !d.may_show(&at(118)));
        let warning = Diagnostic {
            severity: Severity::Warning,
            ..at(500)
        };
        assert!(d.may_show(&warning));
    }
}
