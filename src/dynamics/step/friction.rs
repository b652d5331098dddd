//! Coefficients of friction of the pairs in the increments of a step. Section 3 of docs/theory.md, Friction that
//! depends on slip rate and pressure.

use super::loads::Interval;
use super::slave_faces::SlaveFaces;
use crate::contact::{ClosedPairs, Constraint, position};
use crate::lcp::ContactState;
use crate::model::{Friction, Model};

/// Friction of the contacts in a step.
pub(crate) struct Frictions<'m> {
    of_contacts: Vec<&'m Friction>,
    /// Where the pressure counts.
    faces: Option<SlaveFaces>,
}

impl<'m> Frictions<'m> {
    /// That of a model.
    pub fn new(model: &'m Model) -> Self {
        let of_contacts = model.contacts.iter();
        let of_contacts: Vec<&Friction> = of_contacts.map(|c| &c.interaction.friction).collect();
        let counts = of_contacts.iter().any(|f| f.depends_on_pressure());
        Frictions {
            faces: counts.then(|| SlaveFaces::new(model)),
            of_contacts,
        }
    }

    /// Gives the constraints of an iterate their coefficients: at rest where a pair sticks, else at the slip rate
    /// |Dt|/dt of the increment; both under the pressure that the forces at hand exert on the slave node,
    ///
    /// ```text
    /// p = sum Pn/A    eq. (3.13)
    /// ```
    ///
    /// the sum being that of the pairs of the node, A its area against the normal in the configuration of the start,
    /// which the displacements `u0` lead to.
    pub fn give(
        &self,
        x: &[[f64; 2]],
        (u0, interval, closed): (&[f64], Interval, &ClosedPairs),
        constraints: &mut [Constraint],
    ) {
        for constraint in constraints {
            let friction = self.of_contacts[constraint.key.contact()];
            constraint.mu_varies = !friction.is_constant();
            let pressure = match &self.faces {
                Some(faces) if friction.depends_on_pressure() => {
                    pressure(constraint, closed, |node, normal| {
                        faces.area(node, normal, |node| position(x, u0, node))
                    })
                }
                _ => 0.0,
            };
            constraint.mu = match constraint.mu_varies {
                true if closed.state(constraint.key) != ContactState::Stick => {
                    friction.at(constraint.slip / interval.dt, pressure)
                }
                _ => friction.at_rest(pressure),
            };
        }
    }
}

/// Pressure of the closed pairs of the slave node of a constraint, on its area against a normal.
fn pressure(
    constraint: &Constraint,
    closed: &ClosedPairs,
    area: impl Fn(usize, [f64; 2]) -> f64,
) -> f64 {
    let pairs = closed.of_slave(constraint.key.slave());
    let normal: f64 = pairs.iter().map(|pair| pair.force[0]).sum();
    let of_slave = constraint.slave_forces([1.0, 0.0]).next();
    match of_slave {
        Some((node, direction)) if normal > 0.0 => normal / area(node, direction),
        _ => 0.0,
    }
}
