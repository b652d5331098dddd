//! Kinds of contact constraints: which kind is made for which target. Section 3 of docs/theory.md.

use super::constraint::{Configurations, Constraint};
use super::targets::PairTarget;
use super::{node_to_corner, node_to_segment};

impl Constraint {
    /// The constraint of a slave node at its target.
    pub fn new(source: PairTarget, at: &Configurations) -> Self {
        match source.target.corner {
            None => node_to_segment::constraint(source, at),
            Some(corner) => node_to_corner::constraint(source, corner, at),
        }
    }

    /// The same constraint at the start, with the segment that holds the node there.
    pub fn at_start(&self, start: &Configurations) -> Self {
        let mut source = self.source.allowing(0);
        if let Some([a, b]) = source.from.take() {
            (source.nodes[1], source.nodes[2], source.nodes[3]) = (a, b, b);
        }
        Constraint {
            mu: self.mu,
            mu_varies: self.mu_varies,
            shrinkage: self.shrinkage,
            ..Constraint::new(source, start)
        }
    }

    /// The same constraint between other configurations, at whose start the same target holds the node.
    pub fn untilted(&self, at: &Configurations) -> Self {
        Constraint::new(self.source.untilted(), at)
    }

    /// The same constraint between other configurations.
    pub fn relinearized(&self, at: &Configurations) -> Self {
        Constraint {
            mu: self.mu,
            mu_varies: self.mu_varies,
            ..Constraint::new(self.source, at)
        }
    }
}
