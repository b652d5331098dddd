//! The model in one picture, as SVG: bodies by material, supports, motions, loads, velocities,
//! surfaces with their normals, contacts, and a legend.

mod bodies;
mod canvas;
mod conditions;
mod frame;
mod legend;
mod surfaces;

use crate::model::Model;
use canvas::Canvas;
use legend::Legend;

/// Draws a model as text of an SVG file.
pub fn picture(model: &Model) -> String {
    let mut canvas = Canvas::new(&model.mesh.coordinates);
    let mut legend = Legend::default();
    bodies::draw(model, &mut canvas, &mut legend);
    surfaces::draw(model, &mut canvas, &mut legend);
    conditions::draw(model, &mut canvas, &mut legend);
    surfaces::names(model, &mut canvas);
    frame::draw(model, &mut canvas);
    legend.draw(&mut canvas);
    canvas.text()
}
