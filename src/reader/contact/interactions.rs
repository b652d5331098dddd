//! `*SURFACE INTERACTION` with its laws `*SURFACE BEHAVIOR` and `*FRICTION`.

use crate::deck::{Card, Row, Text};
use crate::diagnostics::{Code, Diagnostic};
use crate::model::{Friction, Interaction};
use crate::reader::context::Context;
use crate::reader::mesh::{Block, Outline};
use crate::reader::names::Names;

/// The interactions of the deck by their names.
pub(crate) struct Interactions {
    names: Names,
    /// In the order of their names.
    all: Vec<Interaction>,
}

impl Interactions {
    /// Reads all interactions.
    pub fn read(outline: &Outline, cx: &mut Context) -> Self {
        let mut names = Names::new("surface interaction");
        let mut all = Vec::new();
        for block in outline.blocks("SURFACE INTERACTION") {
            let Some(name) = names.new_name(block.head, cx) else {
                continue;
            };
            if let Some(friction) = friction(block, cx) {
                all.push(Interaction { friction });
                names.define(name);
            } else {
                names.spoil(&name);
            }
        }
        Interactions { names, all }
    }

    /// The interaction of a name; reports an undefined one.
    pub fn find(&self, name: Text, cx: &mut Context) -> Option<Interaction> {
        let index = self.names.find(name, cx)?;
        self.all.get(index).copied()
    }
}

/// Friction of an interaction; `None` after a reported error.
fn friction(block: &Block, cx: &mut Context) -> Option<Friction> {
    let behaviors = block.parts_of("SURFACE BEHAVIOR");
    cx.only_once(&behaviors);
    behaviors
        .iter()
        .for_each(|card| warn_of_behavior_data(card, cx));
    out_of_plane_thickness(block.head, cx);
    let cards = block.parts_of("FRICTION");
    cx.only_once(&cards);
    match cards.first() {
        None => Some(Friction::default()),
        Some(card) if card.faulty => None,
        Some(card) => law(card, cx),
    }
}

/// Warns that the data of a pressure-overclosure law have no effect, as contact is exact; LINEAR
/// has a warning of its own.
fn warn_of_behavior_data(card: &Card, cx: &mut Context) {
    if let (Some(row), None | Some("HARD")) =
        (card.rows.first(), card.choice("PRESSURE-OVERCLOSURE"))
    {
        let message = "this data line has no effect";
        let warning = Diagnostic::warning(Code::IgnoredParameter, row.span(), message);
        cx.d.push_once(warning.help("contact is enforced exactly: it needs no numbers"));
    }
}

/// `[thickness]` under `*SURFACE INTERACTION`; 1 is the default of other codes.
fn out_of_plane_thickness(head: &Card, cx: &mut Context) {
    let Some(row) = head.rows.first() else { return };
    row.at_most(1, cx.d);
    let thickness = row.real_or(0, 1.0, cx.d);
    if thickness.is_some_and(|thickness| thickness != 1.0) {
        let help = "the bodies touch over the thickness of their sections";
        row.without_effect(0, "this thickness has no effect", help, cx.d);
    }
    if let Some(extra) = head.rows.get(1) {
        let message = "*SURFACE INTERACTION takes one data line at most";
        cx.error(Code::StrayData, extra.span(), message);
    }
}

/// `mu[, ...]`, or with EXPONENTIAL DECAY `mu at rest, mu sliding, decay`.
fn law(card: &Card, cx: &mut Context) -> Option<Friction> {
    let Some(row) = card.rows.first() else {
        cx.error(
            Code::MissingData,
            card.span,
            "*FRICTION needs the coefficient of friction",
        );
        return None;
    };
    if let Some(second) = card.rows.get(1) {
        let message = "friction that depends on slip rate, pressure or temperature cannot be used";
        cx.error(Code::UnsupportedParameter, second.span(), message);
    }
    if card.has("EXPONENTIAL DECAY") {
        row.at_most(3, cx.d);
        let at_rest = not_negative(row, 0, "the coefficient of friction at rest", cx);
        let sliding = not_negative(row, 1, "the coefficient of sliding friction", cx);
        let decay = not_negative(row, 2, "the decay of friction", cx);
        return Some(Friction {
            at_rest: at_rest?,
            sliding: sliding?,
            decay: decay?,
        });
    }
    let friction = not_negative(row, 0, "the coefficient of friction", cx)?;
    let message = "only the coefficient of friction is read here";
    let help = "sticking is exact: it needs no stick slope or slip rate";
    row.without_effect(1, message, help, cx.d);
    Some(Friction::constant(friction))
}

/// A field that is not negative; `what` it is.
fn not_negative(row: Row, index: usize, what: &str, cx: &mut Context) -> Option<f64> {
    let field = row.required(index, what, cx.d)?;
    let value = field.real(cx.d)?;
    if value < 0.0 {
        let message = format!("{what} must not be negative, found {}", field.text);
        cx.error(Code::FrictionRange, field.span, message);
        return None;
    }
    Some(value)
}
