//! Compares a deck with the deck of a checkpoint, letter by letter and row by row, and finds the first field that
//! differs. Fields are compared as text, because their meaning depends on the keyword: `1E1` and `10.` are one number,
//! but two names.

use super::lines::{Line, LineKind, Lines};
use super::text::Text;
use crate::diagnostics::{Code, Diagnostic, FileId, Sources, Span};

/// A field of a deck with the keyword line of its card.
struct CardField<'a> {
    card: &'a str,
    field: Text<'a>,
    /// Whether the field is the first field of its row.
    begins: bool,
}

impl CardField<'_> {
    fn is_same(&self, other: &CardField) -> bool {
        self.field.text == other.field.text && self.begins == other.begins
    }
}

/// The fields of a text in their order, without comments and without the cards that may change (`*RESTART`).
fn entries(file: FileId, text: &str) -> impl Iterator<Item = CardField<'_>> {
    let is_said = |line: &Line| !matches!(line.kind(), LineKind::Blank | LineKind::Comment);
    let lines = Lines::new(file, text).filter(is_said);
    let with_cards = lines.scan("", |card, line| {
        if line.kind() == LineKind::Keyword {
            *card = line.fields().next().map_or("", |field| field.text);
        }
        Some((*card, line))
    });
    let counts = |(card, _): &(&str, Line)| {
        let name = card.trim_start_matches('*').trim();
        !name.eq_ignore_ascii_case("RESTART")
    };
    let fields = with_cards.filter(counts);
    fields.flat_map(|(card, line)| {
        let numbered = line.fields().enumerate();
        numbered.map(move |(index, field)| CardField {
            card,
            field,
            begins: index == 0,
        })
    })
}

/// The first difference between a deck and its earlier texts, which are given with their names, file by file.
pub fn first_change(earlier: &[(String, String)], sources: &Sources) -> Option<Diagnostic> {
    for (index, file) in sources.files().iter().enumerate() {
        let id = FileId(index as u32);
        let start = Span::start_of(id);
        let Some((name, before)) = earlier.get(index) else {
            let message = format!(
                "the deck has changed since the checkpoint: it has another file, {}",
                file.name()
            );
            return Some(changed(start, message));
        };
        if before == file.text() {
            continue;
        }
        let mut old = entries(id, before);
        let mut last = start;
        for now in entries(id, file.text()) {
            last = now.field.span;
            let was = match old.next() {
                Some(was) if was.is_same(&now) => continue,
                Some(was) if was.field.text == now.field.text => match now.begins {
                    true => "stood in the row above".to_owned(),
                    false => "began a row".to_owned(),
                },
                Some(was) => format!("was `{}` of {}", was.field.text, was.card),
                None => "is new".to_owned(),
            };
            let what = format!("`{}` of {} {was}", now.field.text, now.card);
            return Some(changed(
                now.field.span,
                format!("the deck has changed since the checkpoint: {what}"),
            ));
        }
        if let Some(CardField { card, field, .. }) = old.next() {
            let message = format!(
                "the deck has changed since the checkpoint: {name} had `{}` of {card} after this",
                field.text
            );
            return Some(changed(last, message));
        }
    }
    let (name, _) = earlier.get(sources.files().len())?;
    let message = format!("the deck has changed since the checkpoint: it had another file, {name}");
    Some(changed(Span::start_of(FileId(0)), message))
}

fn changed(span: Span, message: String) -> Diagnostic {
    Diagnostic::error(Code::ChangedDeck, span, message).help(
        "a run goes on with the deck that it began with, but for comments and *RESTART: put it back, or run it \
         anew with --overwrite",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn change(before: &str, now: &str) -> Option<(String, u32, u32)> {
        let mut sources = Sources::new();
        sources.add("deck.inp", now, None);
        let found = first_change(&[("deck.inp".into(), before.into())], &sources)?;
        let span = found.span.expect("a place");
        let (_, what) = found.message.split_once(": ")?;
        Some((what.to_owned(), span.line, span.column))
    }

    #[test]
    fn the_first_card_or_number_that_differs_is_told() {
        let deck = "*NODE\n1, 0., 2.5\n*ELASTIC\n100., 0.3\n*RESTART, WRITE\n";
        let told = |now: &str| change(deck, now);
        assert_eq!(told(deck), None);
        assert_eq!(
            told("** comment\n*NODE\n 1,0., 2.5\n\n*ELASTIC\n100.,   0.3\n"),
            None
        );
        let number = told("*NODE\n1, 0., 2.5\n*ELASTIC\n100., 0.31\n");
        assert_eq!(
            number,
            Some(("`0.31` of *ELASTIC was `0.3` of *ELASTIC".into(), 4, 7))
        );
        let card = told("*NODE\n1, 0., 2.5\n*PLASTIC\n100., 0.3\n");
        assert_eq!(
            card,
            Some((
                "`*PLASTIC` of *PLASTIC was `*ELASTIC` of *ELASTIC".into(),
                3,
                1
            ))
        );
        let more = told("*NODE\n1, 0., 2.5\n*ELASTIC\n100., 0.3, 1\n");
        assert_eq!(more, Some(("`1` of *ELASTIC is new".into(), 4, 12)));
        let less = told("*NODE\n1, 0., 2.5\n*ELASTIC\n100.\n");
        assert_eq!(
            less,
            Some(("deck.inp had `0.3` of *ELASTIC after this".into(), 4, 1))
        );
        // a name that is a number too is still a name; rows are not fields one after the other
        let name = change("*CLOAD\n1E1, 1, 2.\n", "*CLOAD\n10.0, 1, 2.\n");
        assert_eq!(
            name,
            Some(("`10.0` of *CLOAD was `1E1` of *CLOAD".into(), 2, 1))
        );
        let joined = change("*BOUNDARY\n22, 1\n1, 2\n", "*BOUNDARY\n22, 1, 1, 2\n");
        assert_eq!(joined, Some(("`1` of *BOUNDARY began a row".into(), 2, 8)));
        let parted = change("*BOUNDARY\n22, 1, 1, 2\n", "*BOUNDARY\n22, 1\n1, 2\n");
        assert_eq!(
            parted,
            Some(("`1` of *BOUNDARY stood in the row above".into(), 3, 1))
        );
        let file = change("*NODE", "*NODE").or_else(|| {
            let mut sources = Sources::new();
            sources.add("deck.inp", "*NODE", None);
            sources.add("more.inp", "1, 0., 0.", None);
            let found = first_change(&[("deck.inp".into(), "*NODE".into())], &sources)?;
            Some((found.message, 0, 0))
        });
        assert!(file.is_some_and(|(message, ..)| message.ends_with("another file, more.inp")));
    }
}
