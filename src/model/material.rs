//! Material and thickness of the elements (docs/theory.md, sections 1 and 2).

use crate::materials::Law;

/// A material: its law with the constants of the deck, and its density.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name in the deck.
    pub name: String,
    /// Law of the stress.
    pub law: Law,
    /// Density rho of the reference configuration (mass/length^3).
    pub density: f64,
}

/// Material and thickness of a group of elements.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Index into `Model::materials`.
    pub material: usize,
    /// Thickness t (length).
    pub thickness: f64,
}
