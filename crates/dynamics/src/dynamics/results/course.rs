//! How the passes of an attempt went that did not converge, as the report of its failure tells it.

/// The passes of an attempt that did not converge, from where they last began with the predictor.
#[derive(Debug, Clone, PartialEq)]
pub enum Course {
    /// Corrections grew.
    Growing {
        /// Number of the first pass that they grew after.
        from: usize,
    },
    /// Pairs went to and fro between two states, one of every slave node that did.
    Alternating(Vec<Alternation>),
    /// Corrections became smaller, but slowly.
    Slow {
        /// Correction over the one before, mean of the last passes.
        rate: f64,
        /// Further passes that would have been needed at this rate.
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
    /// Its pair with a segment closed and opened: slave, segment ends a and b.
    Closing([usize; 3]),
    /// It was on one segment and on another.
    Changing {
        /// Slave node.
        slave: usize,
        /// Ends a and b of both.
        segments: [[usize; 2]; 2],
    },
    /// Its pair stuck and slid, or slid one way and the other: slave, segment ends a and b.
    Sliding([usize; 3]),
}
