//! Rigid bodies: rigid surfaces tied to a reference node (docs/theory.md, section 9, rigid
//! surfaces).

/// A rigid surface and the node that it moves with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RigidBody {
    /// Index of the rigid surface.
    pub surface: usize,
    /// Reference node (index).
    pub reference: usize,
}
