//! No text makes the reader panic: mutations of valid decks and plain noise.

use proptest::prelude::*;
use stickslip::diagnostics::{Diagnostics, Sources};
use stickslip::{deck, reader};

const SQUARE: &str = include_str!("decks/square.inp");
const SHARED: &str = include_str!("decks/shared.inp");
const STEPS: &str = include_str!("decks/steps.inp");

/// One way to spoil a deck; numbers are taken modulo its size.
#[derive(Debug, Clone)]
enum Mutation {
    Delete(usize, usize),
    Insert(usize, String),
    Replace(usize, char),
    SwapLines(usize, usize),
    RepeatLine(usize, usize),
    DeleteLine(usize),
    Truncate(usize),
}

fn mutation() -> impl Strategy<Value = Mutation> {
    use Mutation::*;
    let at = || any::<usize>();
    prop_oneof![
        (at(), 1..12usize).prop_map(|(a, n)| Delete(a, n)),
        (at(), "[*,=\" 0-9.eD+-]{1,6}|\\PC{1,4}").prop_map(|(a, text)| Insert(a, text)),
        (at(), any::<char>()).prop_map(|(a, c)| Replace(a, c)),
        (at(), at()).prop_map(|(a, b)| SwapLines(a, b)),
        (at(), at()).prop_map(|(a, b)| RepeatLine(a, b)),
        at().prop_map(DeleteLine),
        at().prop_map(Truncate),
    ]
}

fn apply(text: &str, mutation: &Mutation) -> String {
    let mut characters: Vec<char> = text.chars().collect();
    let mut lines: Vec<&str> = text.split('\n').collect();
    let (c, l) = (characters.len().max(1), lines.len());
    match mutation {
        Mutation::Delete(at, count) => {
            let start = (at % c).min(characters.len());
            let end = (start + count).min(characters.len());
            characters.drain(start..end);
        }
        Mutation::Insert(at, more) => {
            let at = (at % c).min(characters.len());
            characters.splice(at..at, more.chars());
        }
        Mutation::Replace(at, with) => {
            if let Some(place) = characters.get_mut(at % c) {
                *place = *with;
            }
        }
        Mutation::Truncate(at) => characters.truncate(at % c),
        Mutation::SwapLines(a, b) => lines.swap(a % l, b % l),
        Mutation::RepeatLine(a, b) => lines.insert(a % l, lines[b % l]),
        Mutation::DeleteLine(a) => drop(lines.remove(a % l)),
    }
    match mutation {
        Mutation::SwapLines(..) | Mutation::RepeatLine(..) | Mutation::DeleteLine(..) => {
            lines.join("\n")
        }
        _ => characters.into_iter().collect(),
    }
}

/// Reads a text and renders all messages.
fn survive(text: &str) {
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let deck = deck::parse_str("deck.inp", text, &mut sources, &mut d);
    let model = reader::build(&deck, &mut d);
    let messages = d.render(&sources, false);
    assert_eq!(model.is_some(), !d.has_errors(), "{messages}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn spoiled_decks(
        deck in prop_oneof![Just(SQUARE), Just(SHARED), Just(STEPS)],
        mutations in prop::collection::vec(mutation(), 1..12),
    ) {
        let spoiled = mutations.iter().fold(deck.to_string(), |text, m| apply(&text, m));
        survive(&spoiled);
    }

    #[test]
    fn noise(text in "(\\*?[A-Z, =*\"0-9.\\n\t]{0,20}|\\PC{0,10}|\r\n|\\*NODE\n|\\*ELEMENT, TYPE=CPS3\n|\\*STEP\n){0,30}") {
        survive(&text);
    }
}
