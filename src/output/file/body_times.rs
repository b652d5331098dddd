//! Transit times of longitudinal waves through the bodies, group `/model/bodies` of the result
//! file.

use crate::model::{Bodies, Model};
use crate::output::text::wave_speed;

/// Transit times of longitudinal waves in a body: the time scales for the choice of the increment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BodyTimes {
    /// Shortest time along an edge of an element.
    pub edge: f64,
    /// Time along the longer side of the body's bounding box, at the speed of its slowest element.
    pub body: f64,
}

/// The times of every body.
pub(crate) fn body_times(model: &Model, bodies: &Bodies) -> Vec<BodyTimes> {
    let mut edge = vec![f64::INFINITY; bodies.count];
    let mut slowest = vec![f64::INFINITY; bodies.count];
    let mut range = vec![[[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]]; bodies.count];
    for (element, &body) in model.mesh.elements.iter().zip(&bodies.of_element) {
        let (corners, speed) = (model.mesh.corners(element), wave_speed(model, element));
        edge[body] = edge[body].min(model.mesh.shortest_side(element) / speed);
        slowest[body] = slowest[body].min(speed);
        let [lower, upper] = &mut range[body];
        for x in corners {
            for i in 0..2 {
                (lower[i], upper[i]) = (lower[i].min(x[i]), upper[i].max(x[i]));
            }
        }
    }
    let longer = |[lower, upper]: [[f64; 2]; 2]| (upper[0] - lower[0]).max(upper[1] - lower[1]);
    (0..bodies.count)
        .map(|body| BodyTimes {
            edge: edge[body],
            body: longer(range[body]) / slowest[body],
        })
        .collect()
}
