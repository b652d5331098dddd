//! Kinds of contact constraints: every property of a constraint that depends on the kind of its target. Each property
//! is one method with one `match` over the kinds. See docs/theory/contact.md.

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

    /// Derivative of the contact force with respect to the iterate, d(Bn^T Pn + Bt^T Pt)/dU at constant Pn and Pt, over
    /// the dofs of the constraint (force/length). With friction the matrix is not symmetric.
    pub fn change(&self, force: [f64; 2], at: &Configurations) -> DMatrix<f64> {
        match &self.source.target {
            Target::Segment(segment) => segment.change(self, force, at),
            Target::Corner(corner) => corner.change(&self.source.pair, force, at),
            Target::Mean(mean) => mean.change(self, force, at),
            Target::Disc(disc) => disc.change(&self.source.pair, force, at),
        }
    }

    /// Gap of the constraint between other configurations, and the length to which this gap is relative.
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

    /// The same constraint between other configurations, with the same target of its node at their start.
    pub fn untilted(&self, at: &Configurations) -> Self {
        let PairTarget { pair, target } = self.source.clone();
        let target = target.untilted();
        self.made_of(PairTarget { pair, target }, at)
    }

    /// The same constraint at the start, with the target of its node at the start.
    pub fn at_start(&self, start: &Configurations) -> Self {
        Constraint {
            shrinkage: self.shrinkage,
            ..self.made_of(self.source.clone().at_start(), start)
        }
    }

    /// The constraint of another pair and target, with the coefficient of friction of this
    /// constraint.
    fn made_of(&self, source: PairTarget, at: &Configurations) -> Self {
        Constraint {
            mu: self.mu,
            mu_varies: self.mu_varies,
            ..Constraint::new(source, at)
        }
    }

    /// Whether the gap is a mean gap over points of slave faces, not the gap of one node.
    pub fn is_mean(&self) -> bool {
        self.source.target.mean().is_some()
    }

    /// Lift of the slave node over its segment at the start of the increment; `None` for a mean gap (surface to
    /// surface).
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

    /// The slave node and its segment, which messages name; at a corner the segment before the
    /// corner.
    pub fn pair(&self) -> NodeAtSegment {
        self.source.named()
    }

    /// The slave node and its segment; at a corner the segment whose normal has the larger weight.
    pub fn nearer_pair(&self) -> NodeAtSegment {
        match &self.source.target {
            Target::Corner(corner) => self.source.at_ends(corner.nearer().ends),
            Target::Segment(_) | Target::Mean(_) | Target::Disc(_) => self.pair(),
        }
    }

    /// Keys of the slave node at each of its segments; at a corner there are two keys.
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

    /// The slave node whose state the constraint tells: for a mean gap the node that names the constraint, for a disc
    /// its centre.
    pub fn named_slave(&self) -> usize {
        self.source.pair.slave
    }

    /// The master nodes of a mean gap (surface to surface), each with its part |Bn| of the normal force. Other kinds of
    /// constraints return no master nodes.
    pub fn shares_of_masters(&self) -> impl Iterator<Item = (usize, f64)> {
        let normal = &self.force_rows.normal;
        let first = match &self.source.target {
            Target::Mean(_) => self.slave_dofs,
            Target::Segment(_) | Target::Corner(_) | Target::Disc(_) => self.dofs.len(),
        };
        let places = (first..self.dofs.len()).step_by(2);
        places.map(|k| (self.dofs[k] / 2, normal[k].hypot(normal[k + 1])))
    }

    /// Whether the constraint keeps `node` out of a body; the node is its slave node, or the corner that this node
    /// meets. A constraint of a mean gap keeps no single node out.
    pub fn keeps_out(&self, node: usize) -> bool {
        let slave = self.source.pair.slave;
        match &self.source.target {
            Target::Segment(_) | Target::Disc(_) => node == slave,
            Target::Corner(corner) => node == slave || node == corner.tip(),
            Target::Mean(_) => false,
        }
    }

    /// Whether the slave node of a pair is beyond the ends of its segment in the iterate; at a corner the result is
    /// false.
    pub fn is_beyond_ends(&self, at: &Configurations) -> bool {
        let [s, a, b] = at.iterate(self.pair().nodes);
        let is_beyond = || !(0.0..=1.0).contains(&project(s, a, b).xi);
        match &self.source.target {
            Target::Segment(_) | Target::Mean(_) | Target::Disc(_) => is_beyond(),
            Target::Corner(_) => false,
        }
    }

    /// Whether the slave node projects between the ends of its segment at the given positions, and on neither end. For
    /// a constraint of a mean gap the result is always true.
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
