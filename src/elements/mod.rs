//! Plane total-Lagrangian elements: mass, internal force and tangent as pure functions.
//!
//! Displacements and forces of an element with N nodes are 2 x N matrices, column a belonging to
//! node a. Element matrices have D = 2 N rows, row 2 a + i belonging to direction i of node a.

mod body;
mod kinematics;
mod quad4;
mod recovery;
mod reference;
mod solid;
mod tri3;
mod voigt;

pub use body::{Elements, Inverted, Strained};
pub use kinematics::{Configuration, PointState};
pub use quad4::quad4;
pub use recovery::{ElementMeans, element_means};
pub use reference::{Point, Reference};
pub use solid::{internal_force, largest_strain, mass, strain_energy, tangent};
pub use tri3::tri3;
pub use voigt::{Elasticity, elasticity};
