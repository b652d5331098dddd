//! Motion at one time, with what materials and contacts remember.

use crate::contact::ClosedPairs;

/// Motion at one time, `2 N` entries each, what the materials remember, and the pairs in contact.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct State {
    /// Displacement (length).
    pub u: Vec<f64>,
    /// Velocity (length/time).
    pub v: Vec<f64>,
    /// Acceleration (length/time^2).
    pub a: Vec<f64>,
    /// Internal variables of the materials at all integration points, element by element: accepted or
    /// dropped with the rest of the state.
    pub internal: Vec<f64>,
    /// Temperature of every node of the mesh; none where the deck gives none.
    pub temperature: Vec<f64>,
    /// The pairs that carry a force.
    pub contact: ClosedPairs,
}
