//! All results of an increment, as the output receives them.

use std::sync::Arc;

use super::bodies::{BodyResult, Momentum, RigidReaction};
use super::contacts::{ContactResultant, ContactViolation, Landing, ReturnedImpulse, Touch};
use super::energy::Energy;
use super::failure::Unbalanced;
use super::nodal::NodalResults;
use super::pass_report::PassReport;
use super::state::State;
use crate::elements::{ConnectorState, ElementResult, Strained};

/// Work of the solver in an increment or in a whole run, and the errors of its solution.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct SolverCounts {
    /// Number of predictor and corrector passes.
    pub passes: usize,
    /// Number of complementarity problems solved (passes and impulses).
    pub lcps: usize,
    /// Largest number of pairs in a complementarity problem.
    pub lcp_size: usize,
    /// Number of pivots of Lemke's method.
    pub pivots: usize,
    /// Number of iterations of the active-set method.
    pub active_set_iterations: usize,
    /// Number of sweeps of the Gauss-Seidel method.
    pub gauss_seidel_sweeps: usize,
    /// Number of calls of Lemke's method.
    pub lemke_calls: usize,
    /// Number of factorisations of the effective matrix.
    pub factorizations: usize,
    /// Relative force residual of the last pass.
    pub residual: f64,
    /// Errors of the pairs against the contact law at the end of the increment.
    pub violation: ContactViolation,
    /// Largest force on a held motion, which only the facets of a contact surface resist, relative to the normal forces
    /// on the body.
    pub held: f64,
    /// Whether the increment converged.
    pub converged: bool,
}

/// Everything about one finished increment; number 0 is the start. A checkpoint keeps the numbers of the last report
/// ([`IncrementReport::numbers`]).
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct IncrementReport {
    /// Number of the increment over all steps.
    pub increment: usize,
    /// Number of the step, from 1.
    pub step: usize,
    /// Time since the start of the analysis, at the end of the increment.
    pub time: f64,
    /// Time since the start of the step, at the end of the increment.
    pub step_time: f64,
    /// Length of the increment; 0 at the start.
    pub dt: f64,
    /// Whether the increment is the last one of its step.
    pub ends_step: bool,
    /// Truncation error relative to the displacements, in a step in which this error decides the length of the
    /// increments.
    pub truncation_error: Option<f64>,
    /// Motion and state at the end of the increment.
    #[serde(skip)]
    pub state: State,
    /// Results at nodes.
    #[serde(skip)]
    pub nodal: NodalResults,
    /// Strain energy, mean stress and mean strain of every element.
    #[serde(skip)]
    pub elements: Arc<[ElementResult]>,
    /// Energy ledger.
    pub energy: Energy,
    /// Energy that contact added, if its normal work was positive beyond round-off.
    pub contact_energy: Option<f64>,
    /// Momentum.
    pub momentum: Momentum,
    /// Results of every body, in the order of [`crate::model::Bodies`].
    pub bodies: Vec<BodyResult>,
    /// Reactions, one for each rigid surface with a reference node.
    pub rigid: Vec<RigidReaction>,
    /// States of springs and dashpots, in the order of the model.
    pub connectors: Vec<ConnectorState>,
    /// Largest principal strain.
    pub strain: Strained,
    /// Resultants, one for each contact of the model.
    pub contacts: Vec<ContactResultant>,
    /// Difference between the sums of friction work, wear and heat over the nodes and over the contacts, relative to
    /// the sum of absolute values since the start.
    pub surface_work_difference: f64,
    /// Landings in the increment.
    #[serde(skip)]
    pub landings: Vec<Landing>,
    /// Total impulses of the pairs to which energy was given back.
    #[serde(skip)]
    pub returns: Vec<ReturnedImpulse>,
    /// Touches that ended in the increment.
    #[serde(skip)]
    pub touches: Vec<Touch>,
    /// The body with the largest force that holds a motion which only facets resist.
    #[serde(skip)]
    pub held: Option<Box<Unbalanced>>,
    /// Counters of the solver in the increment.
    pub solver: SolverCounts,
    /// Its passes.
    #[serde(skip)]
    pub passes: Vec<PassReport>,
}

impl IncrementReport {
    /// The numbers of the report, without fields and events (for example landings).
    pub fn numbers(&self) -> IncrementReport {
        IncrementReport {
            increment: self.increment,
            step: self.step,
            time: self.time,
            step_time: self.step_time,
            dt: self.dt,
            ends_step: self.ends_step,
            truncation_error: self.truncation_error,
            energy: self.energy,
            contact_energy: self.contact_energy,
            momentum: self.momentum,
            bodies: self.bodies.clone(),
            rigid: self.rigid.clone(),
            connectors: self.connectors.clone(),
            strain: self.strain,
            contacts: self.contacts.clone(),
            solver: self.solver,
            ..IncrementReport::default()
        }
    }

    /// Shortens vectors over all dofs to the dofs of the first `nodes` nodes.
    pub fn keep_nodes(&mut self, nodes: usize) {
        let (state, nodal) = (&mut self.state, &mut self.nodal);
        for vector in [
            &mut state.u,
            &mut state.v,
            &mut state.a,
            &mut nodal.reaction,
            &mut nodal.concentrated,
            &mut nodal.contact_force,
            &mut nodal.tie_force,
        ] {
            vector.truncate(2 * nodes);
        }
        nodal.gap.truncate(nodes);
        nodal.status.truncate(nodes);
    }
}
