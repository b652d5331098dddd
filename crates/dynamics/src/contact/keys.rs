//! Keys that identify constraints and slave nodes through passes and increments.

/// Key of a slave node among the slave nodes of all contacts; a node may be a slave in several
/// contacts.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
)]
pub struct SlaveKey {
    /// Number of the contact of the model.
    pub(super) contact: usize,
    /// Number of the slave node in its contact; the corners of contact from surface to surface
    /// follow the slave nodes.
    pub(super) slave: usize,
}

impl SlaveKey {
    /// Number of the contact of the model.
    pub fn contact(self) -> usize {
        self.contact
    }

    /// Key of the slave node whose number in the contact is larger by `count`.
    pub(super) fn plus(self, count: usize) -> Self {
        SlaveKey {
            slave: self.slave + count,
            ..self
        }
    }
}

/// Key of a constraint through passes and increments. The rest of the program compares keys and asks for their common
/// parts, without knowledge of what a key is made of.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
)]
pub struct ConstraintKey {
    pub(super) slave: SlaveKey,
    /// Number of the segment in its contact; at a corner, of the segment before the corner. With surface to surface
    /// this is the number of the run of segments, which is larger on the second side of a corner.
    pub(super) segment: usize,
}

impl ConstraintKey {
    /// Number of the contact of the model.
    pub fn contact(self) -> usize {
        self.slave.contact
    }

    /// Key of the slave node, which its other constraints share.
    pub fn slave(self) -> SlaveKey {
        self.slave
    }
}

/// A slave node and a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NodeAtSegment {
    /// Key of the constraint of the slave node at the segment.
    pub key: ConstraintKey,
    /// The slave node and the ends of the segment.
    pub nodes: [usize; 3],
}
