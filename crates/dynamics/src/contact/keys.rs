//! What identifies constraints and slave nodes through passes and increments.

/// What identifies a slave node among those of all contacts: a node may be slave in several.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
)]
pub struct SlaveKey {
    /// Contact of the model.
    pub(super) contact: usize,
    /// Number of the slave node in its contact; those of corners from surface to surface follow.
    pub(super) slave: usize,
}

impl SlaveKey {
    /// Number of the contact of the model.
    pub fn contact(self) -> usize {
        self.contact
    }

    /// The slave node whose number in the contact is larger.
    pub(super) fn plus(self, count: usize) -> Self {
        SlaveKey {
            slave: self.slave + count,
            ..self
        }
    }
}

/// What identifies a constraint through passes and increments. The rest of the program compares keys and asks
/// them for what they share with others; it does not know what they are made of.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
)]
pub struct ConstraintKey {
    pub(super) slave: SlaveKey,
    /// Segment in its contact, at a corner that before it. From surface to surface the run of segments, and more on the
    /// second side of a corner.
    pub(super) segment: usize,
}

impl ConstraintKey {
    /// Number of the contact of the model.
    pub fn contact(self) -> usize {
        self.slave.contact
    }

    /// What it shares with the other constraints of its slave node.
    pub fn slave(self) -> SlaveKey {
        self.slave
    }
}

/// A slave node and a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NodeAtSegment {
    /// Key of their constraint.
    pub key: ConstraintKey,
    /// The slave node and the ends of the segment.
    pub nodes: [usize; 3],
}
