//! Shape of faces in contact (straight, curved or circular): `GEOMETRIC CORRECTION` of pairs and general contact, and
//! `*SURFACE SMOOTHING`.

use super::context::Context;
use super::names::Named;
use super::outline::{CardBlock, Outline};
use super::surfaces::Surfaces;
use crate::deck::{Card, Line};
use crate::diagnostics::Code;
use crate::model::{Circle, Smoothing};

/// The circles of every `*SURFACE SMOOTHING` of a deck.
pub(super) fn read(outline: &Outline, surfaces: &Surfaces, cx: &mut Context) -> Named<Vec<Circle>> {
    let mut all = Named::new("surface smoothing");
    for card in outline.model_cards("SURFACE SMOOTHING") {
        all.add(card, cx, |_, cx| {
            let rows = card.rows.iter();
            let circles: Option<Vec<_>> = rows.map(|row| circles(row, surfaces, cx)).collect();
            circles.map(|circles| circles.concat())
        });
    }
    all
}

/// Reads a row `slave, master, CIRCUMFERENTIAL, x, y`; returns the circles of the named surfaces.
fn circles(row: Line, surfaces: &Surfaces, cx: &mut Context) -> Option<Vec<Circle>> {
    row.at_most(5, cx.d);
    let named = (0..2).filter_map(|i| row.get(i));
    let found: Option<Vec<usize>> = named.map(|name| Some(surfaces.find(name, cx)?.0)).collect();
    let found = found?;
    if found.is_empty() {
        row.required(0, "the slave or the master surface", cx.d)?;
    }
    let centre = centre(row, 2, cx)?;
    let circle = |surface| Circle { surface, centre };
    Some(found.into_iter().map(circle).collect())
}

/// Reads `CIRCUMFERENTIAL, x, y` from field `method` on.
fn centre(row: Line, method: usize, cx: &mut Context) -> Option<[f64; 2]> {
    let name = row.required(method, "how the surface is smoothed", cx.d)?;
    if name.name_key() != "CIRCUMFERENTIAL" {
        let message =
            "the faces of plane bodies and bodies of revolution are smoothed as circles only";
        cx.error(Code::BadValue, name.span, message)
            .help("write CIRCUMFERENTIAL and the coordinates of the centre");
        return None;
    }
    let x = row.real(method + 1, "the centre, its first coordinate", cx.d);
    let y = row.real(method + 2, "the centre, its second coordinate", cx.d);
    Some([x?, y?])
}

/// Shape of the faces of a `*CONTACT PAIR`.
pub(super) fn of_pair(
    card: &Card,
    all: &Named<Vec<Circle>>,
    cx: &mut Context,
) -> Option<Smoothing> {
    match card.value("GEOMETRIC CORRECTION") {
        None => Some(Smoothing::default()),
        Some(name) if name.name_key() == "NONE" => Some(Smoothing::Straight),
        Some(name) if name.name_key() == "CURVED" => Some(Smoothing::Curved(Vec::new())),
        Some(name) => all.find(name, cx).cloned().map(Smoothing::Curved),
    }
}

/// Shape of the faces of general contact, from the rows `surface, CIRCUMFERENTIAL, x, y`, `, CURVED` and `, NONE` of
/// `*SURFACE PROPERTY ASSIGNMENT`; `Err` after a reported error.
pub(super) fn of_general(
    block: &CardBlock,
    surfaces: &Surfaces,
    cx: &mut Context,
) -> Result<Smoothing, ()> {
    let mut smoothing = Ok(Smoothing::default());
    for card in block.parts_of("SURFACE PROPERTY ASSIGNMENT") {
        for row in card.rows.iter() {
            let said = of_row(row, surfaces, cx).ok_or(());
            smoothing = match (smoothing, said) {
                (Ok(Smoothing::Curved(mut before)), Ok(Smoothing::Curved(more))) => {
                    before.extend(more);
                    Ok(Smoothing::Curved(before))
                }
                (Ok(_), said) => said,
                (fault, _) => fault,
            };
        }
    }
    smoothing
}

fn of_row(row: Line, surfaces: &Surfaces, cx: &mut Context) -> Option<Smoothing> {
    let method = row.required(1, "how the surface is smoothed", cx.d)?;
    let shape = match method.name_key().as_str() {
        "NONE" => Some(Smoothing::Straight),
        "CURVED" => Some(Smoothing::Curved(Vec::new())),
        _ => None,
    };
    let Some(shape) = shape else {
        row.at_most(4, cx.d);
        let name = row.required(0, "the surface that is smoothed", cx.d)?;
        let surface = surfaces.find(name, cx)?.0;
        let centre = centre(row, 1, cx)?;
        return Some(Smoothing::Curved(vec![Circle { surface, centre }]));
    };
    row.at_most(2, cx.d);
    if let Some(name) = row.get(0) {
        let message = "NONE and CURVED hold for the faces of all surfaces together";
        cx.error(Code::GeneralContact, name.span, message)
            .help("leave the first field empty");
        return None;
    }
    Some(shape)
}
