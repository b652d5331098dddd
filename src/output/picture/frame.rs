//! Title, and the extents of the model along two sides.

use super::canvas::{Canvas, MARGIN, Pen};
use crate::model::Model;
use crate::output::text::general;

const INK: &str = "#222222";
const GREY: &str = "#777777";

/// Draws title and extents.
pub(super) fn draw(model: &Model, canvas: &mut Canvas) {
    canvas.label([MARGIN, 24.0], "start", INK, &model.title);
    let [low, high] = canvas.extents;
    let ([left, bottom], [right, top]) = (canvas.at(low), canvas.at(high));
    let (y, x) = (canvas.size[1] + 1.6 * MARGIN, 0.45 * MARGIN);
    let pen = Pen(GREY, 1.0);
    canvas.stroke(
        &format!(
            "M{left:.1} {y:.1}H{right:.1}M{left:.1} {:.1}v8M{right:.1} {:.1}v8",
            y - 4.0,
            y - 4.0
        ),
        pen,
    );
    canvas.stroke(
        &format!(
            "M{x:.1} {bottom:.1}V{top:.1}M{:.1} {bottom:.1}h8M{:.1} {top:.1}h8",
            x - 4.0,
            x - 4.0
        ),
        pen,
    );
    let text = |value: f64| general(value, 4);
    canvas.label([left, y + 18.0], "middle", GREY, &text(low[0]));
    canvas.label([right, y + 18.0], "middle", GREY, &text(high[0]));
    canvas.label([x, bottom + 16.0], "middle", GREY, &text(low[1]));
    canvas.label([x, top - 8.0], "middle", GREY, &text(high[1]));
}
