//! Constants of a material on data lines.

use crate::deck::{Card, Row};
use crate::diagnostics::Code;
use crate::reader::context::Context;

/// A constant of a material.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Constant<T> {
    Missing,
    Wrong,
    Given(T),
}

impl<T> Constant<T> {
    /// The constant, if there is one without an error.
    pub fn given(self) -> Option<T> {
        match self {
            Constant::Given(value) => Some(value),
            Constant::Missing | Constant::Wrong => None,
        }
    }
}

/// The constant that all rows of a card agree on.
pub(super) fn constant<T: PartialEq + Copy>(
    cards: &[&Card],
    read: fn(Row, &mut Context) -> Option<T>,
    cx: &mut Context,
) -> Constant<T> {
    let Some(card) = cards.first() else {
        return Constant::Missing;
    };
    let mut found = Constant::Wrong;
    for row in card.rows.iter() {
        match (read(row, cx), found) {
            (None, _) => return Constant::Wrong,
            (Some(value), Constant::Given(first)) if value != first => {
                let message = "constants that depend on temperature cannot be used";
                cx.error(Code::UnsupportedParameter, row.span(), message);
            }
            (Some(value), _) => found = Constant::Given(value),
        }
    }
    found
}

/// A temperature in field `index`, which may be any: the rows of all temperatures are alike.
pub(super) fn temperature(row: Row, index: usize, cx: &mut Context) -> Option<()> {
    row.real_or(index, 0.0, cx.d).map(|_| ())
}

/// Reports the number in a field, if it is there.
pub(super) fn out_of_range(rule: &str, row: Row, index: usize, cx: &mut Context) {
    if let Some(field) = row.get(index) {
        let message = format!("{rule}, found {}", field.text);
        cx.error(Code::MaterialRange, field.span, message);
    }
}
