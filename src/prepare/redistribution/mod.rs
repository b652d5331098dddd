//! Redistribution of the mass of contact surfaces: which nodes are without mass, and the nodes that
//! carry it for them. Section 2 of docs/theory.md, Redistributed mass.

mod contact_nodes;
mod massless_nodes;
#[cfg(test)]
pub(crate) mod tests;
mod weights;

pub use massless_nodes::Redistribution;
