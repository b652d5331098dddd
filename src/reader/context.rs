use crate::deck::{Card, Deck, Text};
use crate::diagnostics::{Code, Diagnostic, Diagnostics, Severity, Span, closest};

/// What every reader function needs: the deck as a whole and a place for messages.
pub(super) struct Context<'a> {
    /// All cards.
    pub deck: &'a Deck,
    /// Messages so far.
    pub d: &'a mut Diagnostics,
}

impl Context<'_> {
    /// Adds an error.
    pub fn error(&mut self, code: Code, span: Span, message: impl Into<String>) {
        self.d.push(Diagnostic::error(code, span, message));
    }

    /// Adds a warning.
    pub fn warning(&mut self, code: Code, span: Span, message: impl Into<String>) {
        self.d.push(Diagnostic::warning(code, span, message));
    }

    /// Whether something may be missing because of a reported error.
    pub fn may_lack_cards(&self) -> bool {
        self.deck.incomplete || self.deck.dropped
    }

    /// Number of errors so far.
    pub fn errors(&self) -> usize {
        self.d.count(Severity::Error)
    }

    /// Reports a name that is not defined, unless the cause may be reported already.
    pub fn undefined<'n>(
        &mut self,
        what: &str,
        name: Text,
        known: impl IntoIterator<Item = &'n str>,
    ) {
        if self.deck.incomplete || self.deck.suspects.contains(&name.name_key()) {
            return;
        }
        let message = format!("{what} {} is not defined", name.text);
        let error = Diagnostic::error(Code::UndefinedName, name.span, message);
        let is_shown = self.d.may_show(&error);
        let meant = is_shown.then(|| closest(name.text, known)).flatten();
        self.d.push(error.suggest(meant));
    }

    /// Reports a second card of a kind that may appear once.
    pub fn only_once(&mut self, cards: &[&Card]) {
        for card in cards.iter().skip(1) {
            let message = format!("{} appears a second time here", card.title());
            self.error(Code::RepeatedCard, card.span, message);
        }
    }
}
