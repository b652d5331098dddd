//! Forces and displacements of a pass, and its residual relative to its scales. See
//! docs/theory/time.md, Convergence.

use std::ops::Range;

use smallvec::smallvec;

use super::contact_forces::ContactForces;
use super::convergence::{Errors, Lengths, Scales};
use crate::dynamics::results::Cause;
use crate::dynamics::step::{Equilibrium, PerBody, StepProblem, Workspace, check_finite};
use crate::linear::larger;

/// Forces and displacements of a pass, over all dofs.
pub(crate) struct Pass<'a> {
    /// Load, internal force and inertia of the iterate.
    pub equilibrium: &'a Equilibrium,
    /// Force of the prescribed motion of the supports.
    pub support_force: &'a Vec<f64>,
    /// Constraints of the pass, and their contact forces.
    pub contact: &'a ContactForces,
    /// Displacement U of the iterate, increment d = U - U0 and correction dU.
    pub displacements: [&'a Vec<f64>; 3],
}

impl Pass<'_> {
    /// Checks that all forces and the correction are finite.
    ///
    /// # Errors
    /// Returns [`Cause::NotFinite`] with the first quantity that is not finite.
    pub fn check_finite(&self, contact_force: &Vec<f64>) -> Result<(), Cause> {
        check_finite(&[
            ("the load", &self.equilibrium.load),
            ("the internal force", &self.equilibrium.internal),
            ("the inertia force", &self.equilibrium.inertia),
            ("the contact force", contact_force),
            ("the force of the supports", self.support_force),
            ("the displacement correction", self.displacements[2]),
        ])
    }

    /// Residual and correction of the pass, and their scales; writes the residual.
    ///
    /// # Errors
    /// Returns [`Cause::NotFinite`] with the first quantity that is not finite.
    pub fn measure<'m>(
        &self,
        problem: &StepProblem<'m>,
        workspace: &Workspace,
        residual: &mut Residual,
    ) -> Result<(Scales<'m>, Errors), Cause> {
        let [u, _, du] = self.displacements;
        let Residual {
            contact_force: contact,
            values,
            ..
        } = residual;
        contact.write(self.contact, u.len());
        let scales = self.scales(problem, workspace, &contact.values);
        // r - theta2 K d_p + Bn^T Pn + Bt^T Pt, eq. (4.7)
        let sum = |dofs: Range<usize>, to: &mut Vec<f64>| {
            let r = &self.equilibrium.out_of_balance[dofs.clone()];
            let forces = [&self.support_force[..], &contact.values].map(|all| &all[dofs.clone()]);
            let all = r.iter().zip(forces[0]).zip(forces[1]);
            to.extend(all.map(|((r, s), c)| r - s + c));
        };
        let map = workspace.stiffness.k.map();
        map.write_restricted_by(sum, values);
        let errors = Errors {
            residual: (problem.parts).largest_of_unknowns(&problem.parts_of_unknowns, values),
            correction: problem.parts.largest_of_bodies(du),
        };
        if !scales.are_finite(&errors) {
            self.check_finite(&residual.contact_force.values)?;
        }
        Ok((scales, errors))
    }

    /// Scales of residual and correction of the pass.
    pub fn scales<'m>(
        &self,
        problem: &StepProblem<'m>,
        Workspace {
            stiffness, seen, ..
        }: &Workspace,
        contact_force: &[f64],
    ) -> Scales<'m> {
        let parts = problem.parts;
        let Equilibrium {
            load,
            internal,
            inertia,
            ..
        } = self.equilibrium;
        let forces = [load, internal, inertia, contact_force, self.support_force];
        let [u, d, du] = self.displacements.map(|u| parts.largest_of_bodies(u));
        let lengths = Lengths {
            displacement: seen.displacements(u),
            increment: d.into_iter().zip(du).map(|(d, du)| larger(d, du)).collect(),
            position: self.contact_positions(problem),
        };
        let diagonals = (stiffness.stiffness.as_slice(), stiffness.inertia.as_slice());
        let forces = forces.map(|force| problem.unknowns.magnitudes(force));
        let force = parts.largest_of_all(forces.iter().map(|force| force.as_ref()));
        let (before, tolerance) = (seen.forces(), problem.settings.tolerance);
        Scales::new(parts, [&force, before], diagonals, lengths, tolerance)
    }

    /// For every body the largest coordinate of the nodes of the closed constraints and hinges that act on the body.
    fn contact_positions(&self, problem: &StepProblem) -> PerBody {
        let [u, ..] = self.displacements;
        let mut positions: PerBody = smallvec![0.0; problem.parts.bodies()];
        for (constraint, _) in self.contact.acting() {
            let of_node = |node: usize| problem.position(u, node);
            let coordinates = constraint.nodes().flat_map(of_node).map(f64::abs);
            let most = coordinates.fold(0.0, larger);
            for node in constraint.nodes() {
                let position = &mut positions[problem.parts.of_nodes()[node]];
                *position = larger(*position, most);
            }
        }
        for node in problem.hinges.nodes().flatten() {
            let position = &mut positions[problem.parts.of_nodes()[node]];
            let at = problem.position(u, node).map(f64::abs);
            *position = at.into_iter().fold(*position, larger);
        }
        positions
    }
}

/// The residual of a pass, in memory that the next pass uses again.
#[derive(Default)]
pub(crate) struct Residual {
    contact_force: ContactForce,
    /// Sum of all forces over the unknowns.
    pub values: Vec<f64>,
    /// A vector of zeros over all dofs.
    none: Vec<f64>,
}

/// A contact force over all dofs.
#[derive(Default)]
struct ContactForce {
    values: Vec<f64>,
    /// Dofs at which the force may differ from zero.
    dofs: Vec<usize>,
}

impl ContactForce {
    /// Writes the contact force Bn^T Pn + Bt^T Pt of eq. (3.1) over `dofs` dofs, in place of the force before.
    fn write(&mut self, contact: &ContactForces, dofs: usize) {
        let Self { values, dofs: own } = self;
        own.drain(..).for_each(|dof| values[dof] = 0.0);
        values.resize(dofs, 0.0);
        for (constraint, pair) in contact.acting() {
            constraint.add_force(pair.force, values);
            own.extend_from_slice(&constraint.dofs);
        }
    }
}

/// Progress of the passes of an increment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PassStage {
    /// Whether the search for the closed pairs is over; open pairs may then overlap by `SETTLED_OVERLAP`.
    pub settled: bool,
    /// Whether corrections hardly decrease; residuals may then have all their round-off.
    pub stagnates: bool,
}

/// An iterate with the contact forces of the last pass, linearised at the iterate.
pub(crate) struct Iterate<'a> {
    pub equilibrium: &'a Equilibrium,
    /// Constraints of the iterate and the available forces.
    pub contact: &'a ContactForces,
    /// Displacement U and increment d = U - U0.
    pub displacements: [&'a Vec<f64>; 2],
}

impl<'a> Iterate<'a> {
    /// An iterate U = U0 + d.
    pub fn new(
        equilibrium: &'a Equilibrium,
        contact: &'a ContactForces,
        displacements: [&'a Vec<f64>; 2],
    ) -> Self {
        Iterate {
            equilibrium,
            contact,
            displacements,
        }
    }

    /// The pass from the iterate with the correction dU.
    pub fn pass<'p>(&'p self, support_force: &'p Vec<f64>, du: &'p Vec<f64>) -> Pass<'p> {
        let [u, d] = self.displacements;
        Pass {
            equilibrium: self.equilibrium,
            support_force,
            contact: self.contact,
            displacements: [u, d, du],
        }
    }

    /// The relative residual if the iterate is the solution, that is, if residual, gaps and slips are below the
    /// tolerance or round-off; otherwise `None`.
    pub fn residual(
        &self,
        problem: &StepProblem,
        workspace: &Workspace,
        stage: PassStage,
        residual: &mut Residual,
    ) -> Result<Option<f64>, Cause> {
        if !self.contact.all_have_constraints() {
            return Ok(None);
        }
        let mut none = std::mem::take(&mut residual.none);
        none.resize(self.displacements[0].len(), 0.0);
        let (scales, errors) = (self.pass(&none, &none)).measure(problem, workspace, residual)?;
        residual.none = none;
        let scales = match stage.stagnates {
            true => scales.stagnant(),
            false => scales.strict(),
        };
        if !scales.converged(&errors)
            || !scales.obeys_contact_law(self.contact, stage.settled)
            || !scales.closes_hinges(&problem.hinges, self.displacements[0])
        {
            return Ok(None);
        }
        Ok(Some(scales.report(&errors, self.contact).residual))
    }
}
