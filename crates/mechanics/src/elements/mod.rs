//! Total-Lagrangian elements of the plane and of bodies of revolution: mass, internal force and tangent as pure functions.
//!
//! Displacements and forces of an element with N nodes are 2 x N matrices; column a belongs to node
//! a. Element matrices have D = 2 N rows; row 2 a + i belongs to direction i of node a.

mod all;
mod block;
mod chunk;
mod connector;
mod damping;
mod dilatation;
mod displacement;
mod element;
mod enhanced_strain;
mod formulation;
mod hourglass;
mod local_solution;
mod mean_gradient;
mod motion;
mod recovery;
mod reduced;
mod results;
mod shapes;
mod stretch;
#[cfg(test)]
mod testing;

use crate::model::ElementType;

pub use all::{Elements, Inverted, Updated};
pub use connector::{ConnectorState, PlacedConnector};
pub use element::ElementInertia;
pub use mean_gradient::{MeanGradient, logarithmic_of};
pub use motion::{Increment, Motion, TangentPart};
pub use recovery::{ElementNodes, LocalResult};
pub use results::{ElementResult, Strained, most_strained};

/// Largest number of nodes of an element.
const MAX_NODES: usize = ElementType::MOST_NODES;
/// Largest number of dofs of an element.
const MAX_DOFS: usize = 2 * MAX_NODES;
