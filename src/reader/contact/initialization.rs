//! `*CONTACT INITIALIZATION DATA` and its assignment: nodes of general contact that are moved onto the
//! surfaces before the start, free of strain.

use super::assignment::of_all_surfaces;
use crate::deck::Card;
use crate::diagnostics::Code;
use crate::model::{Adjust, Reach};
use crate::reader::context::Context;
use crate::reader::mesh::{Block, Outline};
use crate::reader::names::Names;

/// What the last assignment in the block of `*CONTACT` asks for; an error is reported.
pub(super) fn read(
    outline: &Outline,
    block: &Block,
    cx: &mut Context,
) -> Result<Option<Adjust>, ()> {
    let (names, all) = data(outline, block, cx);
    let mut assigned = Ok(None);
    for card in block.parts_of("CONTACT INITIALIZATION ASSIGNMENT") {
        for row in card.rows.iter() {
            let name = of_all_surfaces(row, "the contact initialization", cx);
            let index = name.and_then(|name| names.find(name, cx));
            let reach = index.and_then(|index| all.get(index).copied());
            assigned = reach.map(|reach| Some(Adjust::Within(reach))).ok_or(());
        }
    }
    assigned
}

/// All data of initialization by their names, which may stand in the block or outside.
fn data(outline: &Outline, block: &Block, cx: &mut Context) -> (Names, Vec<Reach>) {
    const KEYWORD: &str = "CONTACT INITIALIZATION DATA";
    let (mut names, mut all) = (Names::new("contact initialization"), Vec::new());
    for card in [outline.model_cards(KEYWORD), block.parts_of(KEYWORD)].concat() {
        let Some(name) = names.new_name(card, cx) else {
            continue;
        };
        match reach(card, cx) {
            Some(reach) => {
                all.push(reach);
                names.define(name);
            }
            None => names.spoil(&name),
        }
    }
    (names, all)
}

/// Which nodes are moved and where to: those inside, unless the card says more.
fn reach(card: &Card, cx: &mut Context) -> Option<Reach> {
    let mut or = |name: &str, default: f64| match card.has(name) {
        true => length(card, name, cx),
        false => Some(default),
    };
    let (above, below) = (or("SEARCH ABOVE", 0.0), or("SEARCH BELOW", f64::INFINITY));
    let clearance = or("INITIAL CLEARANCE", 0.0);
    (!card.faulty).then_some(())?;
    Some(Reach {
        above: above?,
        below: below?,
        clearance: clearance?,
    })
}

/// A parameter that is not negative.
fn length(card: &Card, name: &str, cx: &mut Context) -> Option<f64> {
    let text = card.value(name)?;
    let value = text.real(cx.d)?;
    if value < 0.0 {
        let message = format!("{name} must not be negative, found {}", text.text);
        cx.error(Code::BadValue, text.span, message);
        return None;
    }
    Some(value)
}
