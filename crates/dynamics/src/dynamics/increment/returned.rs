//! Energy that is given back after a converged increment. See docs/theory/impacts.md, Landing
//! return.

use crate::contact::{Constraint, ConstraintKey};

/// What is given back after an increment, and what relaxed nodes have lost for it.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Returned {
    /// What was given back to each pair.
    pub pairs: Vec<PairReturn>,
    /// Work of the supports that hold their velocity against what is given back (energy).
    pub support_work: f64,
    /// What nodes without mass lost as they came to rest.
    pub release: Release,
}

/// What nodes without mass lose as they come to rest at the end of an increment in which pairs open.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Release {
    /// R: strain energy less that of the loads, W - R.u, before the rest and after it (energy).
    pub loss: f64,
    /// Work of the loads on the way to the rest (energy).
    pub load_work: f64,
    /// The pairs that have opened, at the end, with the forces that they carried before.
    pub opened: Vec<(Constraint, [f64; 2])>,
}

/// What was given back to a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PairReturn {
    /// The pair.
    pub key: ConstraintKey,
    /// Energy D.
    pub energy: f64,
    /// What friction had dissipated and gives back with its force (energy).
    pub friction: f64,
    /// Normal impulse (dt²/2) y (force time).
    pub normal: f64,
    /// Tangential impulse (force time).
    pub tangential: f64,
    /// Impulse on the slave node (force time).
    pub vector: [f64; 2],
}

impl Release {
    /// The opened pairs, each with its part of the loss by the normal force that it carried.
    pub fn losses(&self) -> impl Iterator<Item = (ConstraintKey, f64)> + '_ {
        let whole: f64 = self.opened.iter().map(|(_, [pn, _])| pn).sum();
        let opened = self.opened.iter().filter(|(_, [pn, _])| *pn > 0.0);
        opened.map(move |(constraint, [pn, _])| (constraint.key, self.loss * pn / whole))
    }
}

impl Returned {
    /// Energy given back to all pairs.
    pub fn energy(&self) -> f64 {
        self.pairs.iter().map(|pair| pair.energy).sum()
    }

    /// What friction gives back at all pairs.
    pub fn friction(&self) -> f64 {
        self.pairs.iter().map(|pair| pair.friction).sum()
    }
}
