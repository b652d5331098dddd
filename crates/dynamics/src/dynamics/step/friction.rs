//! Coefficients of friction of the pairs in the increments of a step. Section 3 of docs/theory.md, Friction that
//! depends on slip rate and pressure.

use super::loads::{Interval, TimePoint};
use super::slave_faces::SlaveFaces;
use crate::contact::{ClosedPair, ClosedPairs, Constraint, position};
use crate::lcp::ContactState;
use crate::linear::larger;
use crate::model::{FormerFriction, Friction, Model, Step};

/// Part of a slip that passes leave of it.
const SOLVED_SLIP: f64 = 1e-9;

/// Friction of the contacts in a step.
pub(crate) struct Frictions<'m> {
    model: &'m Model,
    of_contacts: Vec<FrictionOfContact<'m>>,
    /// Where the pressure counts.
    faces: Option<SlaveFaces>,
}

/// Friction of a contact.
struct FrictionOfContact<'m> {
    friction: &'m Friction,
    /// One that gives way to it.
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

    /// Coefficient at a slip rate, none at rest, under a pressure, at a time.
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
    /// That of a model in a step.
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

    /// Gives the constraints of an iterate their coefficients: at rest where a pair sticks, else at the slip rate
    /// |Dt|/dt of the increment; both under the pressure that the forces at hand exert on the slave node,
    ///
    /// ```text
    /// p = |N|/A,  N = sum Bn^T Pn    eq. (3.13)
    /// ```
    ///
    /// A being its area against N in the configuration of the start, which the displacements `u0` lead to.
    pub fn give(
        &self,
        x: &[[f64; 2]],
        (u0, interval, closed): (&[f64], Interval, &ClosedPairs),
        constraints: &mut [Constraint],
    ) {
        let forces = constraints.iter().map(|c| (c, closed.force(c.key)[0]));
        let normal = self.normal_forces(x.len(), forces);
        for constraint in constraints {
            let friction = &self.of_contacts[constraint.key.contact()];
            constraint.mu_varies = !friction.is_constant();
            let pressure = self.pressure(constraint, (x, u0), &normal);
            let slides =
                constraint.mu_varies && closed.state(constraint.key) != ContactState::Stick;
            let rate = slides.then(|| constraint.slip / interval.dt);
            constraint.mu = friction.at(rate, pressure, (interval.end, self.model));
        }
    }

    /// The least and the largest coefficient that the law allows every closed pair of a converged increment, whatever
    /// coefficients the passes had: that of its slip rate Bt d/dt, or any up to that at rest where it has not slipped, under
    /// the pressure of the forces. A slip that is round-off is none. Their friction is between mu Pn of both.
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
            match pair.state == ContactState::Stick || slip <= noise {
                true => [0.0, at(None).max(faster)],
                false => [slower.min(faster), slower.max(faster)],
            }
        };
        pairs.map(of_pair).collect()
    }

    /// Friction of every closed pair beyond that of the law, or below it where the pair slips (force), as [`Self::bounds`].
    pub fn outside<'c>(
        &self,
        x: &[[f64; 2]],
        increment: (&[f64], &[f64], Interval),
        pairs: impl Iterator<Item = (&'c Constraint, &'c ClosedPair)> + Clone,
    ) -> Vec<f64> {
        let bounds = self.bounds(x, increment, pairs.clone());
        let of_pair = |((_, pair), [least, most]): ((_, &ClosedPair), [f64; 2])| {
            let [pn, pt] = pair.force;
            larger(pt.abs() - most * pn, least * pn - pt.abs())
        };
        pairs.zip(bounds).map(of_pair).collect()
    }

    /// N of eq. (3.13) over the dofs of all nodes from the forces Pn of constraints, none where no pressure counts.
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

    /// Pressure on the slave node of a constraint from the forces N at the nodes, 0 where its friction does not depend on
    /// it, eq. (3.13).
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
    use crate::model::FrictionLaw;

    #[test]
    fn the_bounds_are_those_of_the_law_whatever_coefficient_a_pair_had() {
        let friction = Friction::from(FrictionLaw::Decay {
            at_rest: 0.4,
            sliding: 0.2,
            decay: 3.0,
        });
        let (model, dt) = (Model::default(), 0.5);
        let point = |total: f64| TimePoint {
            step: total,
            total,
            period: dt,
        };
        let interval = Interval {
            start: point(0.0),
            end: point(dt),
            dt,
        };
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
            // a wrong one, which the check must not take over
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
