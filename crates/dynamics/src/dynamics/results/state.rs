//! Motion at one time, with the state of materials and contacts.

use crate::contact::ClosedPairs;

/// Motion at one time (`2 N` entries each), internal variables of the materials, and the pairs in
/// contact.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct State {
    /// Displacement (length).
    pub u: Vec<f64>,
    /// Velocity (length/time).
    pub v: Vec<f64>,
    /// Acceleration (length/time^2).
    pub a: Vec<f64>,
    /// Internal variables of the materials at all integration points, element by element; the variables are accepted or
    /// dropped with the rest of the state.
    pub internal: Vec<f64>,
    /// Temperature of every node of the mesh; empty if the deck gives no temperatures.
    pub temperature: Vec<f64>,
    /// The pairs that carry a force.
    pub contact: ClosedPairs,
}
