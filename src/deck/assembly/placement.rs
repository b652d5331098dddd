//! The data lines of `*INSTANCE`: translation and rotation.

use crate::deck::cards::{Card, Placement, Row};
use crate::diagnostics::{Code, Diagnostic, Diagnostics, Span};

/// Largest deviation of the axis of a rotation from the normal of the plane, as a part of its
/// length: numbers of a deck have six digits or more.
const TILT: f64 = 1e-6;

/// Reads where an instance is; reports what leads out of the plane.
pub(super) fn read(card: &Card, d: &mut Diagnostics) -> Placement {
    let mut rows = card.rows.iter();
    let translation = rows.next().map(|row| translation(row, d));
    let rotation = rows.next().and_then(|row| rotation(row, d));
    if let Some(extra) = rows.next() {
        let message = "an instance has a translation and a rotation only";
        d.push(Diagnostic::error(Code::StrayData, extra.span(), message));
    }
    Placement {
        translation: translation.unwrap_or_default(),
        rotation,
    }
}

/// `tx, ty, tz`
fn translation(row: Row, d: &mut Diagnostics) -> [f64; 2] {
    row.at_most(3, d);
    let [x, y, z] = [0, 1, 2].map(|i| row.real_or(i, 0.0, d).unwrap_or(0.0));
    if z != 0.0 {
        let span = row.get(2).map_or(row.span(), |field| field.span);
        out_of_plane(span, "this translation leads out of the plane", d);
    }
    [x, y]
}

/// `x1, y1, z1, x2, y2, z2, angle`: centre, and cosine and sine of the angle.
fn rotation(row: Row, d: &mut Diagnostics) -> Option<([f64; 2], [f64; 2])> {
    row.at_most(7, d);
    let point = |first: usize, d: &mut Diagnostics| {
        [0, 1, 2].map(|i| row.real_or(first + i, 0.0, d).unwrap_or(0.0))
    };
    let (a, b) = (point(0, d), point(3, d));
    let angle = row.real(6, "the angle in degrees", d)?;
    let [x, y, z] = [0, 1, 2].map(|i| b[i] - a[i]);
    if angle == 0.0 {
        return None;
    }
    if x.abs().max(y.abs()) > TILT * z.abs() || z == 0.0 {
        let message = "the axis of this rotation is not normal to the plane";
        out_of_plane(row.span(), message, d);
    }
    Some(([a[0], a[1]], cosine_and_sine(angle * z.signum())))
}

/// Cosine and sine of an angle in degrees, exact for quarter turns.
fn cosine_and_sine(degrees: f64) -> [f64; 2] {
    match degrees.rem_euclid(360.0) {
        0.0 => [1.0, 0.0],
        90.0 => [0.0, 1.0],
        180.0 => [-1.0, 0.0],
        270.0 => [0.0, -1.0],
        other => [other.to_radians().cos(), other.to_radians().sin()],
    }
}

fn out_of_plane(span: Span, message: &str, d: &mut Diagnostics) {
    let error = Diagnostic::error(Code::Placement, span, message);
    d.push(error.help("the program is plane: instances move in x and y and turn about z"));
}
