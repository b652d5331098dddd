//! System matrices of a step with their factors and compliances at the contacts: the effective
//! stiffness K* of the passes and the mass of the impulses. Sections 4 and 6 of docs/theory.md.

use super::mass::unknown_mass;
use super::step_problem::StepProblem;
use super::unknowns::Unknowns;
use crate::contact::{Compliance, Constraint};
use crate::elements::{Elements, Motion, TangentPart};
use crate::linear::{Assembled, CheckedSolver, LinearError, linear_solver};
use crate::model::SolverChoice;

/// A symmetric matrix over the unknowns, factorised, with its compliance at the contacts.
pub(crate) struct FactoredMatrix {
    pub solver: CheckedSolver,
    pub compliance: Compliance,
}

impl FactoredMatrix {
    pub fn new(choice: SolverChoice, matrix: Assembled, compliance: Compliance) -> Self {
        FactoredMatrix {
            solver: CheckedSolver::new(linear_solver(choice), matrix),
            compliance,
        }
    }

    /// Factorises the matrix again.
    pub fn factorize(&mut self) -> Result<(), LinearError> {
        self.compliance.clear();
        self.solver.factorize()
    }

    /// Solves for the columns of the compliance that `constraints` need.
    pub fn prepare(&mut self, constraints: &[&Constraint]) -> Result<(), LinearError> {
        self.compliance.prepare(constraints, &mut self.solver)
    }
}

/// The effective matrix K* = theta2 K + (2/dt²) M, eq. (4.6), kept until it is assembled again, and
/// the mass matrix, both over the unknowns of a step: T^T K* T and T^T M T.
pub(crate) struct EffectiveStiffness {
    /// K*.
    pub k: FactoredMatrix,
    /// M, factorised when an impulse first needs it.
    pub m: FactoredMatrix,
    /// Length of the increments of K* (time).
    dt: f64,
    /// Largest diagonal entry of theta2 K in every part (force/length).
    pub stiffness: Vec<f64>,
    /// Largest diagonal entry of (2/dt²) M in every part (force/length).
    pub inertia: Vec<f64>,
}

impl EffectiveStiffness {
    /// Both matrices for the unknowns of a step.
    pub fn new(elements: &Elements, unknowns: &Unknowns, choice: SolverChoice) -> Self {
        let mass = unknown_mass(elements, unknowns);
        let groups = mass.groups();
        let compliance = || Compliance::new(unknowns.map.clone(), groups.clone());
        EffectiveStiffness {
            k: FactoredMatrix::new(choice, mass.zeros(), compliance()),
            m: FactoredMatrix::new(choice, mass, compliance()),
            dt: f64::NAN,
            stiffness: Vec::new(),
            inertia: Vec::new(),
        }
    }

    /// Whether K* is factorised for increments of length `dt`, or of a length that differs from it
    /// by at most the relative difference `near`.
    pub fn fits(&self, dt: f64, near: f64) -> bool {
        self.k.solver.is_factorized() && (self.dt - dt).abs() <= near * dt
    }

    /// Assembles K* in the given configuration from the tangents of the elements or their positive
    /// parts, to be factorised next.
    pub fn assemble(&mut self, problem: &StepProblem, dt: f64, motion: Motion, part: TangentPart) {
        let StepProblem {
            elements,
            weights,
            unknowns,
            parts,
            ..
        } = problem;
        // K* = theta2 K + (2/dt²) M, eq. (4.6)
        let mass = self.m.solver.matrix();
        let k = self.k.solver.matrix_mut();
        k.clear();
        elements.for_each_tangent(motion, part, |element, tangent| {
            k.add(element, tangent, weights.theta2)
        });
        self.stiffness = parts.largest_diagonal(k, &unknowns.dof);
        let c = 2.0 / (dt * dt);
        let inertia = parts.largest_diagonal(mass, &unknowns.dof);
        self.inertia = inertia.into_iter().map(|m| c * m).collect();
        k.add_matrix(mass, c);
        self.dt = dt;
    }
}
