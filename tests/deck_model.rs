//! Valid decks and the model they describe.

use std::path::Path;
use stickslip::diagnostics::{Diagnostics, Sources};
use stickslip::model::Model;
use stickslip::{deck, reader};

/// The model of a deck, which must have no errors, and the text of its warnings.
fn read(text: &str) -> (Model, String) {
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let deck = deck::parse_str("deck.inp", text, &mut sources, &mut d);
    let model = reader::build(&deck, &mut d);
    let messages = d.render(&sources, false);
    (model.unwrap_or_else(|| panic!("{messages}")), messages)
}

#[test]
fn shared_deck_reads_with_its_warnings() {
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let path = Path::new("tests/decks/shared.inp");
    let model = reader::read_model(path, &mut sources, &mut d);
    insta::assert_snapshot!(d.render(&sources, false));
    insta::assert_debug_snapshot!(model.expect("no errors"));
}

const SQUARE: &str = "\
*NODE, NSET=ALL
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
*ELEMENT, TYPE=CPS4, ELSET=BODY
7, 1, 2, 3, 4
*MATERIAL, NAME=RUBBER
*ELASTIC
1000., 0.3
*DENSITY
1.
*SOLID SECTION, ELSET=BODY, MATERIAL=RUBBER
0.5
";

/// The model of a square with further cards.
fn square(more: &str) -> (Model, String) {
    read(&format!("{SQUARE}{more}"))
}

#[test]
fn one_square_without_messages() {
    let (model, messages) = square(
        "*STEP, NLGEOM, NAME=push\n*DYNAMIC, DIRECT\n0.1, 1.\n\
         *STICKSLIP, SCHEME=SS22, THETA1=1., THETA2=1.\n*CLOAD\nALL, 2, 4.\n*END STEP\n",
    );
    assert_eq!(messages, "");
    assert_eq!(model.mesh.elements[0].label, 7);
    assert_eq!(model.sections[0].thickness, 0.5);
    assert_eq!(model.steps[0].point_loads.len(), 4);
    assert_eq!(model.steps[0].name.as_deref(), Some("push"));
}
