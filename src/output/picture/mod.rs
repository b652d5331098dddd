//! The model in one picture, as SVG: bodies by material, supports, motions, loads, velocities,
//! surfaces with their normals, contacts, and a legend.

mod bodies;
mod canvas;
mod conditions;
mod frame;
mod legend;
mod surfaces;
mod view;

use crate::model::Model;
use canvas::Canvas;
use legend::Legend;
pub use view::Window;

/// Draws a model as text of an SVG file: a part of the plane, or the deformable bodies and what is near
/// them.
pub fn picture(model: &Model, window: Option<Window>) -> String {
    let window = window.unwrap_or_else(|| Window::about_bodies(model));
    let mut canvas = Canvas::new(window);
    let mut legend = Legend::default();
    bodies::draw(model, &mut canvas, &mut legend);
    surfaces::draw(model, &mut canvas, &mut legend);
    conditions::draw(model, &mut canvas, &mut legend);
    surfaces::names(model, &mut canvas);
    frame::draw(model, &mut canvas);
    legend.draw(&mut canvas);
    canvas.text()
}
