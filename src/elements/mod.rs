//! Plane total-Lagrangian elements: mass, internal force and tangent as pure functions.
//!
//! Displacements and forces of an element with N nodes are 2 x N matrices, column a belonging to
//! node a. Element matrices have D = 2 N rows, row 2 a + i belonging to direction i of node a.

mod all;
mod damping;
mod displacement;
mod element;
mod formulation;
mod integration_point;
mod kinematics;
mod mean_dilatation;
mod quad4;
mod recovery;
mod solid;
mod sweep;
mod tri3;

pub use all::{ElementInertia, Elements, Inverted, MeanGradient, Updated};
pub use recovery::{ElementResult, Strained, most_strained};
pub use solid::{Increment, Motion, TangentPart};
