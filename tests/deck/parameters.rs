//! Parameters: `*PARAMETER`, `<name>` in cards and rows, values from outside.

use stickslip::deck::parse_str;
use stickslip::diagnostics::{Code, Diagnostics, Sources};
use stickslip::model::Model;
use stickslip::reader;

const SQUARE: &str = include_str!("../decks/square.inp");

/// The square with some text replaced, read with values from outside.
fn read(changes: &[(&str, &str)], settings: &[&str]) -> (Option<Model>, Diagnostics, String) {
    let mut text = SQUARE.to_owned();
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_owned()).collect();
    let (mut sources, mut d) = (Sources::with_settings(&settings, None), Diagnostics::new());
    let deck = parse_str("deck.inp", &text, &mut sources, &mut d);
    let model = reader::build(&deck, &mut d);
    let text = d.render(&sources, false);
    (model, d, text)
}

const DEFINED: (&str, &str) = (
    "*NODE, NSET=ALL",
    "*PARAMETER\nYoung = 10.0**3   # of rubber\nnu=0.3\nname = 'RUBBER'\nlast = 2*2\nall = 'ALL'\n\
     *NODE, NSET=<all>",
);

const USED: [(&str, &str); 4] = [
    DEFINED,
    ("1000., 0.3", "<Young>, < nu >"),
    (
        "SECTION, ELSET=BODY, MATERIAL=RUBBER",
        "SECTION, ELSET=BODY, MATERIAL=<name>",
    ),
    ("3, 2, 4.", "3, 2, <last>"),
];

#[test]
fn values_stand_where_the_names_do() {
    let (plain, _, text) = read(&[], &[]);
    assert!(plain.is_some(), "{text}");
    let (model, _, text) = read(&USED, &[]);
    assert_eq!(model, plain, "{text}");
    let (other, _, text) = read(&USED, &["Young=2.5e3"]);
    let (wanted, _, _) = read(&[("1000., 0.3", "2500., 0.3")], &[]);
    assert_eq!(other, wanted, "{text}");
    // a value from outside is enough
    let (given, _, text) = read(&[("1000.", "<e>")], &["e = 2*500."]);
    assert_eq!(given, plain, "{text}");
}

/// Codes and text of the messages about a deck.
fn messages(changes: &[(&str, &str)], settings: &[&str]) -> (Vec<Code>, String) {
    let (model, d, text) = read(changes, settings);
    assert!(model.is_none(), "{text}");
    let mut codes: Vec<Code> = d.iter().map(|item| item.code).collect();
    codes.sort();
    (codes, text)
}

#[test]
fn messages_show_what_was_typed() {
    let mut changes = USED;
    changes[1].1 = "<Young>, < nu >, 1., <last>, 5.";
    let (codes, text) = messages(&changes, &["nu='abc'"]);
    assert!(codes.contains(&Code::BadNumber), "{text}");
    assert!(text.contains("<Young>, < nu >, 1., <last>, 5."), "{text}");
    let caret = text
        .lines()
        .find(|line| line.contains("^^^^^^"))
        .unwrap_or_default();
    let typed = text
        .lines()
        .find(|line| line.contains("< nu >"))
        .unwrap_or_default();
    assert_eq!(caret.find('^'), typed.find("< nu >"), "{text}");
    assert_eq!(caret.matches('^').count(), 6, "{text}");
    changes[1].1 = "<young>, <nu>, <Nu>";
    let (codes, text) = messages(&changes, &[]);
    assert_eq!(codes, [Code::UnknownValue, Code::UnknownValue], "{text}");
    assert!(
        text.contains("did you mean Young?") && text.contains("capitals count"),
        "{text}"
    );
}

#[test]
fn faults_of_expressions_have_their_places() {
    let (codes, text) = messages(
        &[(
            "*NODE, NSET=ALL",
            "*PARAMETER\na = 2*(3 +\nb = a\n*NODE, NSET=ALL",
        )],
        &[],
    );
    assert_eq!(codes, [Code::BadExpression], "{text}");
    assert!(text.contains("deck.inp:4:11"), "{text}");
    for (row, message) in [
        ("a", "a row of *PARAMETER is"),
        ("2a = 1", "cannot be the name"),
        ("a = 1\na = 2", "is defined already"),
        ("a = later\nlater = 1", "there is no parameter later"),
        ("a = 1/0", "a division by zero"),
    ] {
        let cards = format!("*PARAMETER\n{row}\n*NODE, NSET=ALL");
        let (_, text) = messages(&[("*NODE, NSET=ALL", &cards)], &[]);
        assert!(text.contains(message), "{row}: {text}");
    }
}

#[test]
fn values_from_outside_that_cannot_be() {
    let (codes, text) = messages(&[], &["mu=0.3"]);
    assert_eq!(codes, [Code::UnknownValue], "{text}");
    assert!(text.contains("the deck has no parameter mu"), "{text}");
    for setting in ["mu", "2=3", "mu=1+", "=3"] {
        let (codes, text) = messages(&[], &[setting]);
        assert_eq!(codes[0], Code::BadExpression, "{setting}: {text}");
    }
}

#[test]
fn values_make_no_endless_lines() {
    let define = |text: &str| format!("*PARAMETER\na = '{}'\n*NODE, NSET=ALL", text);
    let (codes, text) = messages(&[("*NODE, NSET=ALL", &define(&"1,".repeat(129)))], &[]);
    assert!(codes.contains(&Code::BadExpression), "{text}");
    assert!(text.contains("a text of more than 256 bytes"), "{text}");
    let line = format!("2, {}", "<a>".repeat(20_000));
    let changes = [
        ("*NODE, NSET=ALL", &*define(&"1,".repeat(128))),
        ("2, 1., 0.", &line),
    ];
    let (codes, text) = messages(&changes, &[]);
    assert!(codes.contains(&Code::EndlessLine), "{text}");
}
