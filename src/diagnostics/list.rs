//! The collection of diagnostics of one deck: counts by severity, strictness, order by place.

use super::{Code, Diagnostic, Severity, Span};
use std::collections::{BinaryHeap, HashMap, HashSet};

/// Most diagnostics of one severity that are shown.
pub(super) const SHOWN: usize = 20;

/// Treatment of unknown keywords and of warnings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Strictness {
    /// Unknown keywords and parameters are errors.
    #[default]
    Normal,
    /// Unknown keywords and parameters are left out with a warning.
    Lenient,
    /// Warnings are errors.
    Strict,
}

/// All diagnostics of one deck.
#[derive(Debug, Clone, Default)]
pub struct Diagnostics {
    strictness: Strictness,
    items: Vec<Diagnostic>,
    counts: [usize; 3],
    /// Places of the first diagnostics of each severity, as many as are shown.
    first: [BinaryHeap<Option<Span>>; 3],
    said: HashMap<Code, HashSet<String>>,
    /// Instance in which a line of a part was reported, by code and place.
    in_parts: HashMap<(Code, Span), u32>,
    /// Errors found, those of the same line of a part in further instances included.
    errors: usize,
}

impl Diagnostics {
    /// No diagnostics yet, normal strictness.
    pub fn new() -> Diagnostics {
        Diagnostics::default()
    }

    /// No diagnostics yet, with the rules of `strictness`.
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

    /// Adds a diagnostic; that of a line of a part once, however many instances the part has.
    pub fn push(&mut self, mut diagnostic: Diagnostic) {
        diagnostic.severity = self.judge(&diagnostic);
        self.errors += usize::from(diagnostic.severity == Severity::Error);
        if self.is_of_another_instance(&diagnostic) {
            return;
        }
        self.counts[diagnostic.severity as usize] += 1;
        let first = &mut self.first[diagnostic.severity as usize];
        first.push(diagnostic.span);
        if first.len() > SHOWN {
            first.pop();
        }
        self.items.push(diagnostic);
    }

    /// Whether the same line of the part has this diagnostic in another instance already.
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

    /// Number of errors found, more than are counted where a part has several instances.
    pub fn errors_found(&self) -> usize {
        self.errors
    }

    /// Whether a diagnostic would be shown if it were the last one. Suggestions that take time are
    /// made for such diagnostics only; further diagnostics never bring others back.
    pub fn may_show(&self, diagnostic: &Diagnostic) -> bool {
        let first = &self.first[self.judge(diagnostic) as usize];
        first.len() < SHOWN || first.peek().is_some_and(|last| diagnostic.span < *last)
    }

    /// Adds a diagnostic unless one with the same code and message was added this way before.
    pub fn push_once(&mut self, diagnostic: Diagnostic) {
        let said = self.said.entry(diagnostic.code).or_default();
        if said.insert(diagnostic.message.clone()) {
            self.push(diagnostic);
        }
    }

    /// Whether this code and message was added by [`Self::push_once`].
    pub fn has_said(&self, code: Code, message: &str) -> bool {
        let said = self.said.get(&code);
        said.is_some_and(|said| said.contains(message))
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

    /// All diagnostics but those of one code.
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

    /// All diagnostics by their place: file, line, column; those without a place first.
    pub fn sorted(&self) -> Vec<&Diagnostic> {
        let mut sorted: Vec<&Diagnostic> = self.items.iter().collect();
        sorted.sort_by_key(|item| (item.span, item.severity));
        sorted
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
