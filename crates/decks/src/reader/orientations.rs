//! `*ORIENTATION`: axes for the directions of springs and dashpots.

use super::context::Context;
use super::names::Names;
use super::outline::Outline;
use crate::deck::{Card, Line, Text};
use crate::diagnostics::{Code, Span};
use crate::vectors::cross;
use std::cell::Cell;

/// Two unit vectors, normal to each other.
pub(super) type Axes = [[f64; 2]; 2];

/// Help for messages about an orientation whose axes cannot be used.
const HELP: &str =
    "springs and dashpots take the points a, b and c of SYSTEM=RECTANGULAR in the plane";

/// Largest difference from 1 of the length of a unit vector.
const ROUND_OFF: f64 = 1e-14;

/// The orientations of a deck.
pub(super) struct Orientations<'a> {
    names: Names,
    cards: Vec<(&'a Card, Cell<bool>)>,
}

impl<'a> Orientations<'a> {
    /// The orientations of a deck; their data lines are read when a spring or dashpot uses the orientation.
    pub fn new(outline: &Outline<'a>, cx: &mut Context) -> Self {
        let mut all = Orientations {
            names: Names::of_parts("orientation"),
            cards: Vec::new(),
        };
        for card in outline.model_cards("ORIENTATION") {
            if let Some(name) = all.names.new_name(card, cx) {
                all.names.define(name);
                all.cards.push((card, Cell::new(false)));
            }
        }
        all
    }

    /// The axes of the orientation that a parameter names.
    pub fn find(&self, field: Text, cx: &mut Context) -> Option<Axes> {
        let (card, is_used) = self.cards.get(self.names.find(field, cx)?)?;
        is_used.set(true);
        axes(card, field.span, cx)
    }

    /// Warns about an orientation that no spring and no dashpot uses.
    pub fn report_unused(&self, cx: &mut Context) {
        for (card, is_used) in &self.cards {
            card.leave_out();
            if !is_used.get() {
                cx.d.warning_once(
                    Code::IgnoredKeyword,
                    card.span,
                    "*ORIENTATION is left out",
                )
                .help("materials are isotropic: stresses and strains in the results are along x and y");
            }
        }
    }
}

/// The axes of a card; `user` is the place in the deck where these axes are used.
fn axes(card: &Card, user: Span, cx: &mut Context) -> Option<Axes> {
    let system = card.choice("SYSTEM").unwrap_or("RECTANGULAR");
    let definition = card.choice("DEFINITION").unwrap_or("COORDINATES");
    if system != "RECTANGULAR" || definition != "COORDINATES" {
        let message = format!(
            "an orientation with SYSTEM={system}, DEFINITION={definition} cannot be used here"
        );
        cx.error(Code::UnsupportedParameter, user, message)
            .help(HELP);
        return None;
    }
    let mut rows = card.rows.iter();
    let row = rows.next()?;
    let [x, y] = of_points(row, cx)?;
    let angle = match rows.next() {
        Some(row) => turn(row, cx)?,
        None => 0.0,
    };
    if let Some(extra) = rows.next() {
        let message = "an orientation has two data lines at most";
        cx.error(Code::StrayData, extra.span(), message);
    }
    let (sin, cos) = angle.to_radians().sin_cos();
    let turned = |a: [f64; 2], b: [f64; 2], sin: f64| [0, 1].map(|i| cos * a[i] + sin * b[i]);
    Some(match angle == 0.0 {
        true => [x, y],
        false => [turned(x, y, sin), turned(y, x, -sin)],
    })
}

/// Reads `ax, ay, az, bx, by, bz[, cx, cy, cz]`: the first axis points from c to a; the second axis points to the side
/// of b.
fn of_points(row: Line, cx: &mut Context) -> Option<Axes> {
    row.at_most(9, cx.d);
    let mut point = |first: usize| -> Option<[f64; 3]> {
        let [x, y, z] = [0, 1, 2].map(|i| row.real_or(first + i, 0.0, cx.d));
        Some([x?, y?, z?])
    };
    let (a, b, c) = (point(0)?, point(3)?, point(6)?);
    let [a, b] = [a, b].map(|p| [p[0] - c[0], p[1] - c[1], p[2] - c[2]]);
    let length = a[0].hypot(a[1]);
    let side = cross([a[0], a[1]], [b[0], b[1]]);
    if a[2] != 0.0 || b[2] != 0.0 || side == 0.0 || !side.is_finite() {
        let message = "the axes of this orientation do not lie in the plane";
        cx.error(Code::BadDirection, row.span(), message).help(HELP);
        return None;
    }
    // what is of length 1 but for round-off stays as it is written
    let unit = |x: f64| match (length - 1.0).abs() < ROUND_OFF {
        true => x,
        false => x / length,
    };
    let [x, y] = cx.turned([unit(a[0]), unit(a[1])], row);
    let normal = match side > 0.0 {
        true => [-y, x],
        false => [y, -x],
    };
    Some([[x, y], normal])
}

/// Reads `axis, angle in degrees`.
fn turn(row: Line, cx: &mut Context) -> Option<f64> {
    row.at_most(2, cx.d);
    let axis = row.get(0).map_or(Some(1), |field| field.integer(cx.d))?;
    let angle = row.real_or(1, 0.0, cx.d)?;
    if axis != 3 && angle != 0.0 {
        let message = "a rotation about this axis leads out of the plane";
        cx.error(Code::BadDirection, row.span(), message)
            .help("the axis normal to the plane is 3");
        return None;
    }
    Some(angle)
}
