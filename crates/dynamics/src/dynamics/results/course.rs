//! Course of the passes of an attempt that did not converge, for the report of its failure.

/// Course of the passes of an attempt that did not converge, from their last start with the
/// predictor.
#[derive(Debug, Clone, PartialEq)]
pub enum Course {
    /// Corrections grew.
    Growing {
        /// The corrections grew after the pass with the given number.
        from: usize,
    },
    /// Pairs went to and fro between two states; the list has one entry for each slave node.
    Alternating(Vec<Alternation>),
    /// Corrections became smaller, but slowly.
    Slow {
        /// Mean ratio of successive corrections in the last passes.
        rate: f64,
        /// Number of further passes needed at the mean ratio.
        left: usize,
    },
    /// Corrections became no smaller.
    Stagnant {
        /// The smallest relative correction of the last passes.
        correction: f64,
    },
}

/// A slave node whose contact left a state and came back to it; all numbers are indices of nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Alternation {
    /// The pair of the node with a segment closed and opened: slave, segment ends a and b.
    Closing([usize; 3]),
    /// The node changed between two segments.
    Changing {
        /// Slave node.
        slave: usize,
        /// Ends a and b of the two segments between which the node changed.
        segments: [[usize; 2]; 2],
    },
    /// The pair of the node changed between sticking and sliding, or between sliding one way and the other: slave,
    /// segment ends a and b.
    Sliding([usize; 3]),
}
