//! Total-Lagrangian elements of the plane and of bodies of revolution: mass, internal force and tangent as pure functions.
//!
//! Displacements and forces of an element with N nodes are 2 x N matrices, column a belonging to
//! node a. Element matrices have D = 2 N rows, row 2 a + i belonging to direction i of node a.

mod all;
mod block;
mod chunk;
mod connector;
mod damping;
mod displacement;
mod element;
mod enhanced_strain;
mod formulation;
mod hourglass;
mod local_solution;
mod mean_dilatation;
mod mean_dilatation_lanes;
mod mean_gradient;
mod recovery;
mod reduced;
mod ring;
mod shapes;
mod solid;
mod stretch;
#[cfg(test)]
mod testing;

pub use all::{Elements, Inverted, Updated};
pub use connector::{ConnectorState, PlacedConnector};
pub use element::ElementInertia;
pub use formulation::{ElementResult, Strained, most_strained};
pub use mean_gradient::{MeanGradient, logarithmic_of};
pub use recovery::{ElementNodes, LocalResult};
pub use solid::{Increment, Motion, TangentPart};
