//! Coefficients of friction of the pairs in the increments of a step. Section 3 of docs/theory.md, Friction that
//! depends on slip rate and pressure.

use super::loads::{Interval, TimePoint};
use super::slave_faces::SlaveFaces;
use crate::contact::{ClosedPairs, Constraint, position};
use crate::lcp::ContactState;
use crate::model::{FormerFriction, Friction, Model, Step};

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
        let normal = self.faces.as_ref().map(|faces| {
            let mut force = vec![0.0; 2 * x.len()];
            for constraint in constraints.iter() {
                let [pn, _] = closed.force(constraint.key);
                constraint.add_force([pn, 0.0], &mut force);
            }
            (faces, force)
        });
        let pressure = |node: usize| {
            let (faces, force) = normal.as_ref()?;
            let own = [force[2 * node], force[2 * node + 1]];
            let area = faces.area(node, own, |node| position(x, u0, node));
            Some(own[0].hypot(own[1]) / area).filter(|pressure| !pressure.is_nan())
        };
        for constraint in constraints {
            let friction = &self.of_contacts[constraint.key.contact()];
            constraint.mu_varies = !friction.is_constant();
            let slave = constraint.nodes().next();
            let pressure = slave
                .filter(|_| friction.depends_on_pressure())
                .and_then(pressure)
                .unwrap_or(0.0);
            let slides =
                constraint.mu_varies && closed.state(constraint.key) != ContactState::Stick;
            let rate = slides.then(|| constraint.slip / interval.dt);
            constraint.mu = friction.at(rate, pressure, (interval.end, self.model));
        }
    }
}
