//! Any text is read into a model or into messages: no panic, no hang, no memory without bound.

#![no_main]

use libfuzzer_sys::fuzz_target;
use stickslip::diagnostics::{Diagnostics, Sources, Strictness};
use stickslip::prepare::prepare;
use stickslip::{deck, reader};

fuzz_target!(|bytes: &[u8]| {
    let text = String::from_utf8_lossy(bytes);
    for strictness in [Strictness::Normal, Strictness::Lenient] {
        check(&text, strictness);
    }
});

/// Reads and prepares a deck as `stickslip check` does, and makes the text of all messages.
fn check(text: &str, strictness: Strictness) {
    let (mut sources, mut d) = (Sources::new(), Diagnostics::with_strictness(strictness));
    let deck = deck::parse_str("deck.inp", text, &mut sources, &mut d);
    let model = reader::build(&deck, &mut d);
    assert_eq!(model.is_some(), !d.has_errors());
    let prepared = model.and_then(|model| prepare(model, &mut d));
    assert_eq!(prepared.is_some(), !d.has_errors());
    let messages = d.render(&sources, false);
    assert_eq!(messages.is_empty(), d.iter().next().is_none());
}
