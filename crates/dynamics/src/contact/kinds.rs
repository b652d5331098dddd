//! Kinds of contact constraints: every question to a constraint whose answer depends on the kind of its target. A
//! question is one method with one match. See docs/theory/contact.md.

use nalgebra::DMatrix;

use super::bulge::{Bulge, Lift};
use super::constraint::{Configurations, Constraint};
use super::keys::{ConstraintKey, NodeAtSegment};
use super::positions::Positions;
use super::projection::project;
use super::target::{PairTarget, Target};
use super::tolerances::PROJECTION_BEYOND_ENDS;

impl Constraint {
    /// The constraint of a slave node at its target.
    pub fn new(PairTarget { pair, target }: PairTarget, at: &Configurations) -> Self {
        match target {
            Target::Segment(segment) => segment.constraint(pair, at),
            Target::Corner(corner) => corner.constraint(pair, at),
            Target::Mean(mean) => mean.constraint(pair, at),
            Target::Disc(disc) => disc.constraint(pair, at),
        }
    }

    /// Contact stiffness Kc of the contact force, eq. (4.12), over the dofs of the constraint (force/length).
    pub fn stiffness(&self, force: [f64; 2], at: &Configurations) -> DMatrix<f64> {
        let change = self.change(force, at);
        (&change + change.transpose()) / 2.0
    }

    /// Change of its contact force with the iterate, d(Bn^T Pn + Bt^T Pt)/dU at constant Pn and Pt, over its dofs
    /// (force/length): not symmetric under friction.
    pub fn change(&self, force: [f64; 2], at: &Configurations) -> DMatrix<f64> {
        match &self.source.target {
            Target::Segment(segment) => segment.change(self, force, at),
            Target::Corner(corner) => corner.change(&self.source.pair, force, at),
            Target::Mean(mean) => mean.change(self, force, at),
            Target::Disc(disc) => disc.change(&self.source.pair, force, at),
        }
    }

    /// Its gap between other configurations, and the length that it is relative to there.
    pub fn gap_and_scale(&self, at: &Configurations) -> (f64, f64) {
        match &self.source.target {
            Target::Segment(segment) => segment.gap_and_scale(&self.source.pair, at),
            Target::Corner(_) | Target::Mean(_) | Target::Disc(_) => {
                let other = self.relinearized(at);
                (other.gap, other.scale)
            }
        }
    }

    /// The same constraint between other configurations.
    pub fn relinearized(&self, at: &Configurations) -> Self {
        self.made_of(self.source.clone(), at)
    }

    /// The same constraint between other configurations, at whose start the same target holds the node.
    pub fn untilted(&self, at: &Configurations) -> Self {
        let PairTarget { pair, target } = self.source.clone();
        let target = target.untilted();
        self.made_of(PairTarget { pair, target }, at)
    }

    /// The same constraint at the start, with the target that holds the node there.
    pub fn at_start(&self, start: &Configurations) -> Self {
        Constraint {
            shrinkage: self.shrinkage,
            ..self.made_of(self.source.clone().at_start(), start)
        }
    }

    /// The constraint of another source, with the coefficient of friction of this one.
    fn made_of(&self, source: PairTarget, at: &Configurations) -> Self {
        Constraint {
            mu: self.mu,
            mu_varies: self.mu_varies,
            ..Constraint::new(source, at)
        }
    }

    /// Whether its gap is a mean over points of slave faces, not the gap of one node.
    pub fn is_mean(&self) -> bool {
        self.source.target.mean().is_some()
    }

    /// What the gap of its node to the chord of its segment counts more by at the start of the increment; none of a mean,
    /// which is not the gap of one node.
    pub fn lift_at_start(&self) -> Option<Lift> {
        let bulge = match &self.source.target {
            Target::Segment(contact) => contact.segment.bulge,
            Target::Corner(corner) => corner.before.bulge,
            Target::Mean(_) => return None,
            Target::Disc(_) => Bulge::FLAT,
        };
        let [allowed, _] = self.source.pair.allowed;
        Some(Lift { allowed, bulge })
    }

    /// A slave node and the segment that it meets, at a corner that before it: what messages name.
    pub fn pair(&self) -> NodeAtSegment {
        self.source.named()
    }

    /// The same; at a corner, with the segment whose normal has the larger weight.
    pub fn nearer_pair(&self) -> NodeAtSegment {
        match &self.source.target {
            Target::Corner(corner) => self.source.at_ends(corner.nearer().ends),
            Target::Segment(_) | Target::Mean(_) | Target::Disc(_) => self.pair(),
        }
    }

    /// The keys that its slave node has at each of its segments: at a corner, two.
    pub fn segments(&self) -> impl Iterator<Item = ConstraintKey> {
        let behind = match &self.source.target {
            Target::Corner(corner) => Some(ConstraintKey {
                segment: corner.behind.number,
                ..self.key
            }),
            Target::Segment(_) | Target::Mean(_) | Target::Disc(_) => None,
        };
        [Some(self.key), behind].into_iter().flatten()
    }

    /// The slave node whose state it says: of a mean the one that it is named by, of a disc its centre.
    pub fn named_slave(&self) -> usize {
        self.source.pair.slave
    }

    /// The master nodes of a mean, each with |Bn| there: the part of the normal force that it takes. The other kinds say
    /// nothing of master nodes.
    pub fn shares_of_masters(&self) -> impl Iterator<Item = (usize, f64)> {
        let normal = &self.force_rows.normal;
        let first = match &self.source.target {
            Target::Mean(_) => self.slave_dofs,
            Target::Segment(_) | Target::Corner(_) | Target::Disc(_) => self.dofs.len(),
        };
        let places = (first..self.dofs.len()).step_by(2);
        places.map(|k| (self.dofs[k] / 2, normal[k].hypot(normal[k + 1])))
    }

    /// Whether it keeps a node out of a body: its slave node, or the corner that this meets. A mean keeps out no single
    /// node.
    pub fn keeps_out(&self, node: usize) -> bool {
        let slave = self.source.pair.slave;
        match &self.source.target {
            Target::Segment(_) | Target::Disc(_) => node == slave,
            Target::Corner(corner) => node == slave || node == corner.tip(),
            Target::Mean(_) => false,
        }
    }

    /// Whether the slave node of a pair is beyond the ends of its segment in the iterate; at a corner it is not.
    pub fn is_beyond_ends(&self, at: &Configurations) -> bool {
        let [s, a, b] = at.iterate(self.pair().nodes);
        let is_beyond = || !(0.0..=1.0).contains(&project(s, a, b).xi);
        match &self.source.target {
            Target::Segment(_) | Target::Mean(_) | Target::Disc(_) => is_beyond(),
            Target::Corner(_) => false,
        }
    }

    /// Whether its slave node projects between the ends of its segment in some positions, and on neither of them. A point
    /// of a mean always does.
    pub fn is_over(&self, at: Positions) -> bool {
        let is_over = || {
            let xi = at.place(self.pair().nodes).xi;
            xi.min(1.0 - xi) > PROJECTION_BEYOND_ENDS
        };
        match &self.source.target {
            Target::Segment(_) | Target::Corner(_) | Target::Disc(_) => is_over(),
            Target::Mean(_) => true,
        }
    }
}
