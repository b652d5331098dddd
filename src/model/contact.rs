//! Contacts of a model and their interactions: hard contact with Coulomb friction (docs/theory.md,
//! section 3).

use crate::diagnostics::Span;

/// Contact law between two surfaces: hard normal contact and Coulomb friction.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Interaction {
    /// Coefficient of friction mu >= 0.
    pub friction: f64,
}

/// A slave surface whose nodes may not enter the body behind the master surface; self-contact if
/// both are the same surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// Index of the slave surface.
    pub slave: usize,
    /// Index of the master surface (made of faces or rigid).
    pub master: usize,
    /// The contact law.
    pub interaction: Interaction,
    /// Slave nodes that are moved onto the master surface before the start.
    pub adjust: Option<Adjust>,
    /// Slave nodes that take no part (indices, increasing).
    pub left_out: Vec<usize>,
    /// Place in the deck, for messages.
    pub span: Span,
}

/// Which slave nodes are moved onto the master surface before the start, free of strain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Adjust {
    /// Those inside the master body and those with at most this clearance (length).
    Within(f64),
    /// Those of the node set with this index.
    Nodes(usize),
}

impl Contact {
    /// Whether slave and master are the same surface.
    pub fn is_self_contact(&self) -> bool {
        self.slave == self.master
    }
}
