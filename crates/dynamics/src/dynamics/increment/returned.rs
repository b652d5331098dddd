//! Energy that is given back after a converged increment. See docs/theory/impacts.md, Landing
//! return.

use crate::contact::{Constraint, ConstraintKey};

/// Energy given back after an increment, and the energy that nodes without mass lost before the return.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Returned {
    /// Energy and impulses given back to each pair.
    pub pairs: Vec<PairReturn>,
    /// Work of the supports that keep their velocity during the return (energy).
    pub support_work: f64,
    /// Energy that nodes without mass lost as they came to rest.
    pub release: Release,
}

/// Energy that nodes without mass lose as they come to rest at the end of an increment in which pairs open.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Release {
    /// Loss R: decrease of the strain energy less the potential of the loads, W - R.u, while the
    /// nodes come to rest (energy).
    pub loss: f64,
    /// Work of the loads while the nodes come to rest (energy).
    pub load_work: f64,
    /// The opened pairs at the end of the increment, with the forces that they had before.
    pub opened: Vec<(Constraint, [f64; 2])>,
}

/// Energy and impulses that a landing or release return gives to a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PairReturn {
    /// The pair.
    pub key: ConstraintKey,
    /// Energy D.
    pub energy: f64,
    /// Energy that friction had dissipated and that comes back as its force is taken back.
    pub friction: f64,
    /// Normal impulse (dt²/2) y of the return, with its share y (force time).
    pub normal: f64,
    /// Tangential impulse of the return (force time).
    pub tangential: f64,
    /// Impulse of the return on the slave node (force time).
    pub vector: [f64; 2],
}

impl Release {
    /// The opened pairs, each with its part of the loss, in proportion to its earlier normal force.
    pub fn losses(&self) -> impl Iterator<Item = (ConstraintKey, f64)> + '_ {
        let whole: f64 = self.opened.iter().map(|(_, [pn, _])| pn).sum();
        let opened = self.opened.iter().filter(|(_, [pn, _])| *pn > 0.0);
        opened.map(move |(constraint, [pn, _])| (constraint.key, self.loss * pn / whole))
    }
}

impl Returned {
    /// Energy given back at all pairs.
    pub fn energy(&self) -> f64 {
        self.pairs.iter().map(|pair| pair.energy).sum()
    }

    /// Energy that friction gives back at all pairs.
    pub fn friction(&self) -> f64 {
        self.pairs.iter().map(|pair| pair.friction).sum()
    }
}
