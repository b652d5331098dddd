//! Coefficients of friction of the pairs in the increments of a step. See docs/theory/contact.md, Friction that
//! depends on slip rate and pressure.

use super::loads::{Interval, TimePoint};
use super::slave_faces::SlaveFaces;
use crate::contact::{ClosedPair, ClosedPairs, Constraint, position};
use crate::linear::larger;
use crate::model::{FormerFriction, Friction, Model, Step};

/// Relative error of a slip that the passes leave.
const SOLVED_SLIP: f64 = 1e-9;

/// Slip rate at the start of an increment, relative to the largest speed at the pair, up to which the pair is at rest.
const RESTING: f64 = 1e-9;

/// Data, besides the constraints, on which the coefficients of an iterate depend.
#[derive(Clone, Copy)]
pub(crate) struct BeforeIterate<'a> {
    /// Displacements U0 of the start.
    pub u0: &'a [f64],
    /// The increment.
    pub interval: Interval,
    /// The pairs closed in the last solution.
    pub closed: &'a ClosedPairs,
    /// Velocity V0 of the start, if the step has velocities and the iterate is the first of the passes.
    pub v0: Option<&'a [f64]>,
}

impl BeforeIterate<'_> {
    /// Slip rate at which the coefficient of a constraint is evaluated; `None` at rest.
    ///
    /// ```text
    /// |Dt|/dt,   of the iterate that passes begin with |Bt V0|    eq. (3.10)
    /// ```
    fn slip_rate(&self, constraint: &Constraint) -> Option<f64> {
        match (self.closed.last_of(constraint.key), self.v0) {
            (Some(pair), _) if !pair.slips => None,
            (_, None) => Some(constraint.slip / self.interval.dt),
            (_, Some(v0)) => {
                let fastest = constraint.dofs.iter().map(|&dof| v0[dof].abs());
                let rate = constraint.tangential_motion(v0);
                (rate.abs() > RESTING * fastest.fold(0.0, larger)).then_some(rate)
            }
        }
    }

    /// Normal force of every constraint in the last solution. If a slave node has left all its targets, its first
    /// constraint gets the forces that the node had at these targets.
    fn normal_forces(&self, constraints: &[Constraint]) -> Vec<f64> {
        let mut forces: Vec<f64> = (constraints.iter())
            .map(|constraint| self.closed.force(constraint.key)[0])
            .collect();
        let mut first = 0;
        for own in constraints.chunk_by(|a, b| a.key.slave() == b.key.slave()) {
            if !own.iter().any(|c| self.closed.closes(c.key)) {
                let before = self.closed.of_slave(own[0].key.slave());
                forces[first] = before.iter().map(|pair| pair.force[0]).sum();
            }
            first += own.len();
        }
        forces
    }
}

/// Friction of the contacts in a step.
pub(crate) struct Frictions<'m> {
    model: &'m Model,
    of_contacts: Vec<FrictionOfContact<'m>>,
    /// Faces of slave nodes, if any friction depends on the pressure.
    faces: Option<SlaveFaces>,
}

/// Friction of a contact in a step.
struct FrictionOfContact<'m> {
    friction: &'m Friction,
    /// The former friction, which is replaced gradually in the step.
    from: Option<&'m FormerFriction>,
}

impl FrictionOfContact<'_> {
    fn all(&self) -> impl Iterator<Item = &Friction> {
        let from = self.from.map(|from| &from.friction);
        [Some(self.friction), from].into_iter().flatten()
    }

    fn is_constant(&self) -> bool {
        self.all().all(Friction::is_constant)
    }

    fn depends_on_pressure(&self) -> bool {
        self.all().any(Friction::depends_on_pressure)
    }

    /// Coefficient of friction at a slip rate (`None` at rest), under a pressure, at a time.
    fn at(&self, rate: Option<f64>, pressure: f64, (time, model): (TimePoint, &Model)) -> f64 {
        match (self.from, rate) {
            (Some(from), _) => {
                let part = match from.amplitude {
                    Some(index) => time.amplitude(model, index),
                    None => time.ramped(),
                };
                (self.friction).on_the_way((&from.friction, part), rate, pressure)
            }
            (None, None) => self.friction.at_rest(pressure),
            (None, Some(rate)) => self.friction.at(rate, pressure),
        }
    }
}

impl<'m> Frictions<'m> {
    /// Friction of the contacts of a model in a step.
    pub fn new(model: &'m Model, step: &'m Step) -> Self {
        let own = model.contacts.iter().map(|contact| FrictionOfContact {
            friction: &contact.interaction.friction,
            from: None,
        });
        let mut of_contacts: Vec<FrictionOfContact> = own.collect();
        for change in &step.contacts.friction {
            of_contacts[change.contact] = FrictionOfContact {
                friction: &change.friction,
                from: change.from.as_ref(),
            };
        }
        let counts = of_contacts
            .iter()
            .any(FrictionOfContact::depends_on_pressure);
        Frictions {
            model,
            faces: counts.then(|| SlaveFaces::new(model)),
            of_contacts,
        }
    }

    /// Sets the coefficients of the constraints of an iterate: at rest if the pair has not slipped in the last
    /// solution, else at the slip rate of the increment. The coefficient depends on the pressure of the available
    /// forces on the slave node,
    ///
    /// ```text
    /// p = |N|/A,  N = sum Bn^T Pn    eq. (3.13)
    /// ```
    ///
    /// Here A is the area of the node for the normal force N, in the configuration of the start.
    pub fn give(&self, x: &[[f64; 2]], before: BeforeIterate, constraints: &mut [Constraint]) {
        let BeforeIterate { u0, interval, .. } = before;
        let normal = match self.faces {
            Some(_) => {
                let forces = before.normal_forces(constraints);
                self.normal_forces(x.len(), constraints.iter().zip(forces))
            }
            None => Vec::new(),
        };
        for constraint in constraints {
            let friction = &self.of_contacts[constraint.key.contact()];
            constraint.mu_varies = !friction.is_constant();
            let pressure = self.pressure(constraint, (x, u0), &normal);
            let rate = (constraint.mu_varies).then(|| before.slip_rate(constraint));
            let rate = rate.flatten();
            constraint.mu = friction.at(rate, pressure, (interval.end, self.model));
        }
    }

    /// The least and the largest coefficient that the law allows for every closed pair of a converged increment, under
    /// the pressure of its forces and whatever coefficients the passes had. For a pair that slips, the two coefficients
    /// enclose the coefficient at its slip rate Bt d/dt, within round-off. For a pair that does not slip, the least
    /// coefficient is 0, and the largest is at least the coefficient at rest. A slip within round-off counts as zero.
    /// The friction of the pair must lie between mu Pn for the least and mu Pn for the largest coefficient.
    pub fn bounds<'c>(
        &self,
        x: &[[f64; 2]],
        (u0, d, interval): (&[f64], &[f64], Interval),
        pairs: impl Iterator<Item = (&'c Constraint, &'c ClosedPair)> + Clone,
    ) -> Vec<[f64; 2]> {
        let forces = pairs.clone().map(|(c, pair)| (c, pair.force[0]));
        let normal = self.normal_forces(x.len(), forces);
        let of_pair = |(constraint, pair): (&Constraint, &ClosedPair)| {
            let friction = &self.of_contacts[constraint.key.contact()];
            let pressure = self.pressure(constraint, (x, u0), &normal);
            let at = |rate: Option<f64>| friction.at(rate, pressure, (interval.end, self.model));
            let slip = constraint.tangential_motion(d).abs();
            let noise = constraint.slip_round_off((x, u0)) + SOLVED_SLIP * slip;
            let [slower, faster] =
                [(slip - noise).max(0.0), slip + noise].map(|slip| at(Some(slip / interval.dt)));
            match !pair.slips || slip <= noise {
                true => [0.0, at(None).max(faster)],
                false => [slower.min(faster), slower.max(faster)],
            }
        };
        pairs.map(of_pair).collect()
    }

    /// Amount (force) by which the friction of every closed pair is above the law, or below the law if the pair slips,
    /// by [`Self::bounds`].
    pub fn outside<'c>(
        &self,
        x: &[[f64; 2]],
        increment: (&[f64], &[f64], Interval),
        pairs: impl Iterator<Item = (&'c Constraint, &'c ClosedPair)> + Clone,
    ) -> Vec<f64> {
        let bounds = self.bounds(x, increment, pairs.clone());
        let of_pair =
            |((constraint, pair), [least, most]): ((&Constraint, &ClosedPair), [f64; 2])| {
                let [pn, pt] = constraint.normal_and_tangential(pair.force);
                larger(pt.abs() - most * pn, least * pn - pt.abs())
            };
        pairs.zip(bounds).map(of_pair).collect()
    }

    /// Nodal normal forces N of eq. (3.13) over all dofs, from the forces Pn of constraints; empty if no friction
    /// depends on pressure.
    fn normal_forces<'c>(
        &self,
        nodes: usize,
        forces: impl Iterator<Item = (&'c Constraint, f64)>,
    ) -> Vec<f64> {
        if self.faces.is_none() {
            return Vec::new();
        }
        let mut normal = vec![0.0; 2 * nodes];
        forces.for_each(|(constraint, pn)| constraint.add_force([pn, 0.0], &mut normal));
        normal
    }

    /// Pressure on the slave node of a constraint from the forces N at the nodes, eq. (3.13); 0 if the friction of the
    /// constraint does not depend on pressure.
    fn pressure(
        &self,
        constraint: &Constraint,
        (x, u0): (&[[f64; 2]], &[f64]),
        normal: &[f64],
    ) -> f64 {
        let of_slave = || {
            let (faces, node) = (self.faces.as_ref()?, constraint.nodes().next()?);
            let own = [normal[2 * node], normal[2 * node + 1]];
            let area = faces.area(node, own, |node| position(x, u0, node));
            Some(own[0].hypot(own[1]) / area).filter(|pressure| !pressure.is_nan())
        };
        let depends = self.of_contacts[constraint.key.contact()].depends_on_pressure();
        depends.then(of_slave).flatten().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Configurations, RowForm, testing};
    use crate::lcp::ContactState;
    use crate::model::FrictionLaw;

    /// An increment of the given length.
    fn interval(dt: f64) -> Interval {
        let point = |total: f64| TimePoint {
            step: total,
            total,
            period: dt,
        };
        Interval {
            start: point(0.0),
            end: point(dt),
            dt,
        }
    }

    #[test]
    fn a_pair_has_the_slip_rate_of_the_start_or_of_the_iterate_unless_it_did_not_slip() {
        let constraint = testing::at_face([0.0, 0.1]);
        let v0 = [-3.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let rate = |closed: Option<bool>, v0: Option<&[f64]>| {
            let pair = closed.map(|slips| {
                let mut pair = testing::closed_pair(0, 0);
                (pair.state, pair.slips) = (ContactState::SlipPlus, slips);
                pair
            });
            let before = BeforeIterate {
                u0: &[0.0; 6],
                interval: interval(0.5),
                closed: &pair.into_iter().collect(),
                v0,
            };
            before.slip_rate(&constraint)
        };
        let near = |found: Option<f64>, expected: f64| {
            assert!(found.is_some_and(|found| (found - expected).abs() < 1e-14));
        };
        for closed in [None, Some(true)] {
            near(rate(closed, None), 0.2);
            near(rate(closed, Some(&v0)), 3.0);
            assert_eq!(rate(closed, Some(&[0.0; 6])), None, "at rest");
            let along = [1.0, 1e3, 1.0, 1e3, 1.0, 1e3];
            assert_eq!(rate(closed, Some(&along)), None, "moves with its segment");
        }
        assert_eq!(rate(Some(false), None), None);
        assert_eq!(rate(Some(false), Some(&v0)), None);
    }

    #[test]
    fn a_node_that_has_left_its_segment_keeps_its_normal_force() {
        let forces = |closed: &[(usize, usize, f64)], at: &[(usize, usize)]| {
            let pair = |&(slave, segment, pn): &(usize, usize, f64)| {
                let mut pair = testing::closed_pair(slave, segment);
                pair.force = [pn, 0.0];
                pair
            };
            let constraint = |&(slave, segment): &(usize, usize)| {
                let mut constraint = testing::at_face([0.0; 2]);
                constraint.key = testing::key(slave, segment);
                constraint
            };
            let before = BeforeIterate {
                u0: &[0.0; 6],
                interval: interval(1.0),
                closed: &closed.iter().map(pair).collect(),
                v0: None,
            };
            let constraints: Vec<Constraint> = at.iter().map(constraint).collect();
            before.normal_forces(&constraints)
        };
        let closed = [(0, 3, 2.0), (1, 3, 5.0), (1, 4, 7.0)];
        assert_eq!(forces(&closed, &[(0, 3), (1, 3), (1, 4)]), [2.0, 5.0, 7.0]);
        assert_eq!(forces(&closed, &[(0, 3), (0, 4), (1, 4)]), [2.0, 0.0, 7.0]);
        // node 0 has come to segments 4 and 5, node 1 has left both of its segments, node 2 was open
        let moved = [(0, 4), (0, 5), (1, 5), (2, 3)];
        assert_eq!(forces(&closed, &moved), [2.0, 0.0, 12.0, 0.0]);
    }

    #[test]
    fn the_bounds_are_those_of_the_law_whatever_coefficient_a_pair_had() {
        let friction = Friction::from(FrictionLaw::Decay {
            at_rest: 0.4,
            sliding: 0.2,
            decay: 3.0,
        });
        let (model, interval) = (Model::default(), interval(0.5));
        let frictions = Frictions {
            model: &model,
            of_contacts: vec![FrictionOfContact {
                friction: &friction,
                from: None,
            }],
            faces: None,
        };
        let x = [[-0.5, 0.0], [0.0, 0.0], [-2.0, 0.0]];
        let of_slip = |slip: f64, state: ContactState| {
            let (u0, u) = ([0.0; 6], [slip, 0.0, 0.0, 0.0, 0.0, 0.0]);
            let form = RowForm::End;
            let at = Configurations {
                form,
                x: &x,
                u0: &u0,
                u: &u,
            };
            let mut constraint = Constraint::new(testing::face(), &at);
            // a wrong coefficient, which the check must not use
            constraint.mu = 9.0;
            let pair = ClosedPair::new(&constraint, [1.0, 0.3], state);
            let pairs = std::iter::once((&constraint, &pair));
            frictions.bounds(&x, (&u0, &u, interval), pairs)[0]
        };
        let near = |[a, b]: [f64; 2], [c, d]: [f64; 2]| {
            assert!(
                (a - c).abs() < 1e-8 && (b - d).abs() < 1e-8,
                "{a} {b}, {c} {d}"
            );
        };
        let mu = friction.at(0.2, 0.0);
        near(of_slip(0.1, ContactState::SlipPlus), [mu, mu]);
        near(of_slip(-0.1, ContactState::SlipMinus), [mu, mu]);
        near(of_slip(0.0, ContactState::Stick), [0.0, 0.4]);
        near(of_slip(1e-16, ContactState::SlipPlus), [0.0, 0.4]);
    }
}
