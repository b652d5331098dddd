//! System matrices of a step with their factors and compliances at the contacts: the effective
//! stiffness K* of the passes and the mass of the impulses. See docs/theory/time.md and docs/theory/impacts.md.
//!
//! A system matrix of a step, K* or M, whose work is measured: its solves, in one go or in parts, and its
//! complementarity problems. See docs/theory/time.md and docs/theory/complementarity.md.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use super::bodies::BodyAngles;
use super::free_motions::FreeMotions;
use super::held_motions::HeldMotions;
use super::hinges::Hinges;
use super::loads::ForceChange;
use super::mass::{Masses, unknown_mass};
use super::meter::Meter;
use super::pins::Pins;
use super::rank_update::RankUpdate;
use super::step_problem::StepProblem;
use crate::archive::{Archive, ArchiveError, transfer_fields};
use crate::contact::{
    ClosedPair, Compliance, Configurations, Constraint, ConstraintGroup, DelassusSpace,
    frictional_lcp,
};
use crate::elements::{Motion, TangentPart};
use crate::lcp::{
    BlockIteration, ContactState, Counters, FrictionalLcp, FrictionalSolution, KeptFactors, Known,
    LcpError, LcpMethod, solve_similar,
};
use crate::linear::{
    AddedBlocks, Assembled, CheckedSolver, LinearError, LinearSolver, Rotation, Transformation,
    larger, two_linear_solvers,
};

/// A symmetric matrix over the unknowns, factorised, with its compliance at the contacts.
pub(crate) struct FactoredMatrix {
    pub solver: CheckedSolver,
    pub compliance: Compliance,
    /// Factors from the last complementarity problems, one set for each scope.
    pub kept: BTreeMap<ConstraintGroup, KeptFactors>,
    /// Memory of the Delassus operators of the matrix.
    pub space: DelassusSpace,
    /// Memory of the solves with the matrix.
    pub vectors: SolveVectors,
    /// Difference between the inverse that keeps hinges closed and the inverse from the factors; `None` without hinges.
    update: Option<RankUpdate>,
    /// Hinges that solutions keep closed.
    hinges: Hinges,
    /// Motions of pins that are unknowns of the complementarity problems.
    free: Option<FreeMotions>,
    /// Solver of the complementarity problems.
    method: LcpMethod,
}

/// Vectors of a solve in parts, which the next solve uses again.
#[derive(Default)]
pub(crate) struct SolveVectors {
    /// Forces turned back, over all dofs.
    pub forces: Vec<f64>,
    /// Vectors of the response at the nodes of constraints.
    pub response: ResponseVectors,
}

/// Vectors of the response at the nodes of some constraints.
#[derive(Default)]
pub(crate) struct ResponseVectors {
    /// The nodes at which the response is computed, increasing.
    pub nodes: Vec<usize>,
    /// Unknowns on which the dofs of the nodes depend, increasing.
    pub unknowns: Vec<usize>,
    /// Forces of the constraints in the right-hand side (unknown, force).
    pub forces: Vec<(usize, f64)>,
    /// Values of the response at the unknowns.
    pub values: Vec<f64>,
    /// The response at the nodes, over all dofs; other entries have no meaning.
    pub at_nodes: Vec<f64>,
}

impl FactoredMatrix {
    /// A matrix over the unknowns of a map, without factors, and the solvers of its linear and complementarity problems.
    pub fn new(
        (solver, method): (Box<dyn LinearSolver>, LcpMethod),
        matrix: Assembled,
        map: &Transformation,
    ) -> Self {
        let solver = CheckedSolver::new(solver, matrix);
        let compliance = Compliance::new(map.clone(), solver.groups());
        FactoredMatrix {
            solver,
            compliance,
            kept: BTreeMap::new(),
            space: DelassusSpace::default(),
            vectors: SolveVectors::default(),
            update: None,
            hinges: Hinges::default(),
            free: None,
            method,
        }
    }

    /// The map T at the iterate.
    pub fn map(&self) -> &Transformation {
        self.compliance.map()
    }

    /// Motions of pins that are free unknowns of the complementarity problems.
    pub fn free(&self) -> Option<&FreeMotions> {
        self.free.as_ref()
    }

    /// Factorises the matrix again.
    pub fn factorize(&mut self) -> Result<(), LinearError> {
        self.update = None;
        self.free = None;
        self.compliance.renew(self.solver.groups());
        self.solver.factorize()
    }

    /// Transfers the matrix and the known part of its inverse to or from an archive.
    fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        let Self {
            solver,
            compliance,
            kept,
            update,
            free: _,
            space: _,
            vectors: _,
            hinges: _,
            method: _,
        } = self;
        solver.transfer(archive)?;
        compliance.transfer(archive, solver)?;
        let mut scopes: Vec<ConstraintGroup> = kept.keys().cloned().collect();
        archive.transfer(&mut scopes)?;
        if archive.is_reading() {
            kept.clear();
        }
        for scope in scopes {
            kept.entry(scope).or_default().transfer(archive)?;
        }
        archive.transfer(update)
    }

    /// Mutable rows of T of bodies that turn.
    fn map_mut(&mut self) -> &mut Transformation {
        self.update = None;
        self.compliance.map_mut()
    }

    /// Solves for the columns of the compliance that `constraints` need.
    pub fn prepare(
        &mut self,
        scope: &ConstraintGroup,
        constraints: &[&Constraint],
    ) -> Result<(), LinearError> {
        let Self {
            solver, compliance, ..
        } = self;
        compliance.prepare(scope, constraints, solver)
    }
}

/// Stiffness of closed constraints, relative to the largest K*_ii, in the check of stability.
const AS_RIGID: f64 = 1e3;
const NEUTRAL: f64 = 1e-10;

/// Largest number of iterations for the product N Z.
const MOST_CHANGES: usize = 20;
const SMALL_CHANGE: f64 = 1e-14;

/// Parts of K* other than inertia.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(crate) enum StiffnessForm {
    /// Tangents of the elements and contact stiffness.
    Tangent,
    /// Tangents of the elements, stiffened by the closed constraints; in a static step also contact stiffness.
    Stiffened,
    /// Positive parts of the tangents, stiffened by the closed constraints.
    Positive,
    /// Tangents of the elements and contact stiffness, stiffened almost rigidly by the closed constraints: the sum is
    /// definite if a static equilibrium is stable.
    Stability,
}

impl StiffnessForm {
    /// The forms to be tried, from the form with the fastest passes to the form that is never indefinite. With
    /// `pairs_stiffen` only the forms that closed constraints stiffen are tried.
    pub fn forms(pairs_stiffen: bool) -> &'static [Self] {
        match pairs_stiffen {
            false => &[Self::Tangent, Self::Stiffened, Self::Positive],
            true => &[Self::Stiffened, Self::Positive],
        }
    }

    /// Part of the tangents of the elements in a form of the stiffness.
    fn part(self) -> TangentPart {
        match self {
            Self::Tangent | Self::Stiffened | Self::Stability => TangentPart::Whole,
            Self::Positive => TangentPart::Positive,
        }
    }
}

/// Closed constraints of an iterate with their forces.
pub(crate) struct ClosedConstraints<'a> {
    pub acting: Vec<(&'a Constraint, &'a ClosedPair)>,
    /// Configurations between which the closed constraints are linearised.
    pub at: Configurations<'a>,
    /// Whether the constraints stiffen K* even if K* is definite without these constraints.
    pub pairs_stiffen: bool,
    /// Derivatives of the loads that follow the iterate, in a static step.
    pub followers: &'a [ForceChange],
    /// Load less internal force, over all dofs, in a static step.
    pub out_of_balance: &'a [f64],
    /// Motions that are held, for the check of stability.
    pub held: &'a HeldMotions,
}

/// Diagonal entries for nodes without mass, equal to the largest diagonal entry of the mass: no impulse acts at these
/// nodes, and the entries make M positive definite.
fn diagonal_of_massless(problem: &StepProblem, mass: &Assembled) -> AddedBlocks {
    let most = mass.diagonal().fold(0.0, larger);
    let mut blocks = AddedBlocks::default();
    for node in problem.redistribution.massless() {
        let diagonal = DMatrix::identity(2, 2) * most;
        blocks.add(&problem.unknowns.map, &[2 * node, 2 * node + 1], &diagonal);
    }
    blocks
}

/// Masses of the elements and bodies of a step.
fn masses(problem: &StepProblem) -> Masses {
    let bodies = problem.unknowns.turning.bodies;
    Masses::new((problem.elements, bodies), problem.redistribution)
}

/// The effective matrix K* = theta2 K + (2/dt²) M, eq. (4.6), which is kept until it is assembled again, and the mass
/// matrix. Both matrices are over the unknowns of a step: T^T K* T and T^T M T.
pub(crate) struct EffectiveStiffness {
    /// K*.
    pub k: FactoredMatrix,
    /// The mass matrix M with a diagonal at nodes without mass. The mass matrix is factorised once: for the acceleration
    /// at the start, or when an impulse first needs it.
    pub m: FactoredMatrix,
    /// Angles of the bodies in the configuration of K*.
    angles: BodyAngles,
    /// Form of the stiffness in K*.
    pub form: StiffnessForm,
    /// Stiffness of every pin in K* (force/length).
    pub pins: Vec<f64>,
    /// Length of the increments for which K* is made (time).
    dt: f64,
    /// Largest diagonal entry of theta2 K, with damping, in every part (force/length).
    pub stiffness: Vec<f64>,
    /// Largest diagonal entry of (2/dt²) M in every part (force/length).
    pub inertia: Vec<f64>,
}

impl EffectiveStiffness {
    /// Both matrices for the unknowns of a step.
    pub fn new(problem: &StepProblem) -> Self {
        let StepProblem {
            unknowns, settings, ..
        } = problem;
        let mass = unknown_mass(&masses(problem), unknowns);
        let massless = diagonal_of_massless(problem, &mass);
        let [of_k, of_m] = two_linear_solvers(settings.solver);
        let mut k = FactoredMatrix::new((of_k, problem.method()), mass.zeros(), &unknowns.map);
        let mut m = FactoredMatrix::new((of_m, problem.method()), mass, &unknowns.map);
        k.hinges = problem.hinges.clone();
        m.hinges = problem.hinges.clone();
        m.solver.add_blocks(massless);
        EffectiveStiffness {
            k,
            m,
            angles: BodyAngles::new(problem),
            form: StiffnessForm::Tangent,
            pins: Vec::new(),
            dt: f64::NAN,
            stiffness: Vec::new(),
            inertia: Vec::new(),
        }
    }

    /// Transfers both matrices and the configuration of K* to or from an archive.
    pub fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        transfer_fields!(archive, self => Self {
            [k, m, angles] form, pins, dt, stiffness, inertia
        })
    }

    /// Sets the rows of T in K* for bodies that turn to the rows of the increment `d` from `u0`.
    pub fn write_rows(&mut self, problem: &StepProblem, increment: [&[f64]; 2]) {
        let turning = &problem.unknowns.turning;
        turning.write_rows(increment, self.k.map_mut());
    }

    /// Sets the rows of T in M for bodies that turn to the rows at the start of an increment, and updates M where it
    /// depends on these rows.
    pub fn start(&mut self, problem: &StepProblem, u0: &[f64]) {
        let turning = &problem.unknowns.turning;
        if turning.are_driven() {
            return;
        }
        let map = self.m.map_mut();
        turning.write_rows([u0, &vec![0.0; u0.len()]], map);
        if turning.turn_mass() {
            let mass = self.m.solver.matrix_mut();
            mass.set_coefficients(self.m.compliance.map());
            mass.clear();
            masses(problem).add_to(mass);
            self.m
                .solver
                .add_blocks(diagonal_of_massless(problem, self.m.solver.matrix()));
        }
    }

    /// Length of the increments for which K* was assembled (time).
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Whether K* is factorised for increments of length `dt`, up to the relative difference `near` of the lengths.
    pub fn fits(&self, dt: f64, near: f64) -> bool {
        self.k.solver.is_factorized() && (self.dt - dt).abs() <= near * dt
    }

    /// Assembles K* in the given configuration from the tangents of the elements, or from their
    /// positive parts, without contact.
    pub fn assemble(
        &mut self,
        problem: &StepProblem,
        dt: f64,
        motion: Motion,
        form: StiffnessForm,
    ) {
        let StepProblem {
            elements,
            integration,
            unknowns,
            parts,
            ..
        } = problem;
        // K* = theta2 K + (2/dt²) M, eq. (4.6)
        let mass = self.m.solver.matrix();
        let k = self.k.solver.matrix_mut();
        k.set_coefficients(self.k.compliance.map());
        k.clear();
        let free = |element: usize| mass.depends_on(element);
        elements.for_each_tangent(motion, form.part(), free, |element, tangent| {
            k.add(element, tangent, integration.theta2)
        });
        // K* <- K* + Cd/dt, eq. (4.19)
        if let Some(increment) = motion.increment {
            elements.for_each_damping((increment, dt), form.part(), |element, damping| {
                k.add(element, damping, 1.0 / dt)
            });
        }
        self.stiffness = parts.largest_diagonal(k, &unknowns.dof);
        let c = integration.mass_factor(dt);
        let inertia = parts.largest_diagonal(mass, &unknowns.dof);
        self.inertia = inertia.into_iter().map(|m| c * m).collect();
        if c != 0.0 {
            k.add_matrix(mass, c);
        }
        self.angles.assemble(problem, motion);
        self.dt = dt;
    }

    /// Turns the factors of K* with the bodies, to the configuration of a motion (docs/numerics.md, Turned factors).
    pub fn turn(&mut self, problem: &StepProblem, motion: Motion) {
        let angles = self.angles.since_assembly(problem, motion);
        self.k.update = None;
        (self.k.compliance).turn(&angles, problem.parts.of_nodes());
    }

    /// Adds the stiffness of the closed constraints, and of pins at rigid motions, to K* before it is factorised.
    pub fn add_contact(
        &mut self,
        problem: &StepProblem,
        contact: &ClosedConstraints,
        form: StiffnessForm,
        pins: &Pins,
    ) {
        self.form = form;
        let FactoredMatrix {
            solver, compliance, ..
        } = &mut self.k;
        let mut diagonal: Vec<f64> = solver.matrix().diagonal().collect();
        let map = compliance.map();
        let mut blocks = AddedBlocks::default();
        if !pins.are_none() {
            let force = map.largest_restricted(contact.out_of_balance);
            let both = (map, problem.parts);
            self.pins = pins.stiffnesses(&diagonal, both, &contact.acting, force);
            pins.stiffen_rigid(both, &self.pins, &mut diagonal);
        }
        for (constraint, pair) in &contact.acting {
            let k = match form {
                // K* <- K* - Kc, eq. (4.12)
                StiffnessForm::Tangent => -constraint.stiffness(pair.force, &contact.at),
                // K* <- K* + gamma (Gn^T Gn + Gt^T Gt), gamma the largest K*_ii, eq. (4.13)
                StiffnessForm::Stiffened | StiffnessForm::Positive | StiffnessForm::Stability => {
                    let unknowns = constraint.dofs.iter().flat_map(|&dof| map.row(dof));
                    let gamma = unknowns.map(|term| diagonal[term.0]).fold(0.0, larger);
                    let rigid = match form {
                        StiffnessForm::Stability => AS_RIGID,
                        _ => 1.0,
                    };
                    // a pair that slides in one direction resists motion in the other
                    let sticks = pair.state == ContactState::Stick
                        || (form == StiffnessForm::Stability && constraint.mu > 0.0);
                    let stiffening = constraint.stiffening(sticks) * (rigid * gamma);
                    match form != StiffnessForm::Positive && !problem.integration.has_rates {
                        true => stiffening - constraint.stiffness(pair.force, &contact.at),
                        false => stiffening,
                    }
                }
            };
            blocks.add(map, &constraint.dofs, &k);
        }
        if !problem.integration.has_rates && !problem.unknowns.turning.are_driven() {
            let mut force = contact.out_of_balance.to_vec();
            for (constraint, pair) in &contact.acting {
                constraint.add_force(pair.force, &mut force);
            }
            let of_angles = (problem.unknowns.turning)
                .geometric_stiffness([contact.at.u0, contact.at.u], &force);
            for (spin, k) in of_angles {
                if form != StiffnessForm::Positive || k > 0.0 {
                    blocks.add(map, &[spin], &DMatrix::from_element(1, 1, k));
                }
            }
        }
        // K* <- K* - (C + C^T)/2, docs/theory/bodies.md, Static steps, of loads
        if form != StiffnessForm::Positive {
            for follower in contact.followers {
                blocks.add(map, &follower.dofs, &-follower.symmetric());
            }
        }
        // K* <- K* + S a S^T, a the mean K*_ii, eq. (12.2)
        if !pins.are_none() {
            let part = match form {
                StiffnessForm::Stability => NEUTRAL,
                _ => 1.0,
            };
            for (dof, a) in pins.dofs().zip(&self.pins) {
                blocks.add(map, &[dof], &DMatrix::from_element(1, 1, part * a));
            }
            if form == StiffnessForm::Stability {
                let at = |node: usize| problem.position(contact.at.u, node);
                let stiffness = (contact.held).stiffness(pins, &self.pins, &at, &contact.acting);
                for (dofs, k) in stiffness {
                    blocks.add(map, &dofs, &k);
                }
            }
        }
        solver.add_blocks(blocks);
    }
}

/// The matrix K* or M of a step, with the meter that measures its work.
pub(crate) struct System<'a> {
    matrix: &'a mut FactoredMatrix,
    meter: &'a mut Meter,
}

impl<'a> System<'a> {
    /// A matrix whose work is measured by `meter`.
    pub fn new(matrix: &'a mut FactoredMatrix, meter: &'a mut Meter) -> Self {
        System { matrix, meter }
    }

    /// Whether the factors belong to the current matrix.
    pub fn is_factorized(&self) -> bool {
        self.matrix.solver.is_factorized()
    }

    /// Factorises the matrix.
    pub fn factorize(&mut self) -> Result<(), LinearError> {
        let Self { matrix, meter } = self;
        meter.time(|t| &mut t.factorization, || matrix.factorize())
    }

    /// Makes the motions of pins with the stiffness `a` free unknowns of the complementarity problems; a part of these
    /// motions is `held`. The bodies are at the positions `at`, where the forces `unbalanced` act. `skew` gives N x
    /// over all dofs: the changes of forces, for a motion x, that the matrix omits. `reach` is the largest distance
    /// that nodes may move.
    ///
    /// ```text
    /// Z = W (S a + N Z),   works W S a      eq. (12.3)
    /// ```
    pub fn free_pins(
        &mut self,
        (pins, a, held): (&Pins, &[f64], DMatrix<f64>),
        (at, unbalanced): (&dyn Fn(usize) -> [f64; 2], &[f64]),
        skew: &dyn Fn(&[f64]) -> Vec<f64>,
        reach: f64,
    ) -> Result<(), LinearError> {
        self.matrix.free = None;
        self.hold()?;
        let map = self.matrix.map().clone();
        let (mut motions, mut works, mut loads) = (Vec::new(), Vec::new(), Vec::new());
        for (dof, &a) in pins.dofs().zip(a) {
            let mut load = vec![0.0; map.rows().count()];
            load[dof] = a;
            works.push(self.respond_transposed(&load)?);
            let mut motion = self.respond(&load)?;
            for _ in 0..MOST_CHANGES {
                let change = skew(&motion);
                let least = SMALL_CHANGE * a;
                let is_small = |(k, change): (usize, &f64)| {
                    let own = if k == dof { a } else { 0.0 };
                    (own + change - load[k]).abs() <= least
                };
                if change.iter().enumerate().all(is_small) {
                    break;
                }
                load = change;
                load[dof] += a;
                motion = self.respond(&load)?;
            }
            motions.push(motion);
            loads.push(load);
        }
        let of_pins = (pins.dofs().collect(), a.to_vec());
        let columns = [motions, works, loads];
        let turning = pins.turning_stiffness(unbalanced, at);
        let bodies = (pins.mean_square(at), turning, held);
        let free = FreeMotions::new(of_pins, columns, bodies, (pins.round_off(a), reach));
        self.matrix.free = Some(free);
        Ok(())
    }

    /// The transposed response T_m A^-T T_1^T f to the forces `f` over all dofs. The bodies of the matrix must not have
    /// turned since it was factorised.
    fn respond_transposed(&mut self, f: &[f64]) -> Result<Vec<f64>, LinearError> {
        let map = self.matrix.map().clone();
        let b = map.restrict_derivatives(f);
        let solution = self.solve(&b)?;
        Ok(match &self.matrix.update {
            Some(update) => map.work(&update.transposed(&b, &solution)),
            None => map.work(&solution),
        })
    }

    /// Motions of pins that are free unknowns of the complementarity problems.
    pub fn free(&self) -> Option<&FreeMotions> {
        self.matrix.free.as_ref()
    }

    /// Mutable motions of pins that are free unknowns.
    pub fn free_mut(&mut self) -> &mut Option<FreeMotions> {
        &mut self.matrix.free
    }

    /// Makes solutions keep the hinges closed, with the map T at the iterate.
    fn hold(&mut self) -> Result<(), LinearError> {
        let Self { matrix, meter } = self;
        let FactoredMatrix {
            solver,
            compliance,
            update,
            hinges,
            ..
        } = &mut **matrix;
        if hinges.are_none() || update.is_some() {
            return Ok(());
        }
        let at = (compliance.map(), compliance.rotation());
        let dofs = at.0.rows().count();
        let columns = || hinges.hold(at, dofs, |b| solver.solve(b));
        *update = Some(meter.time(|t| &mut t.solve, columns)?);
        Ok(())
    }

    /// Whether bodies act on each other without a pair between them.
    pub fn couples_bodies(&self) -> bool {
        !self.matrix.hinges.are_none()
    }

    /// Forces of the hinges that close their `gaps`, and the motion that these forces cause, over all dofs.
    pub fn close(&mut self, gaps: &[f64]) -> Result<(Vec<f64>, Vec<f64>), LinearError> {
        self.hold()?;
        let update = self.matrix.update.as_ref();
        Ok(update.map_or((Vec::new(), Vec::new()), |update| update.answer(gaps)))
    }

    /// Forces of the hinges in the last solve.
    pub fn hinge_forces(&self) -> Vec<f64> {
        let update = self.matrix.update.as_ref();
        let parts = update.map_or(Vec::new(), RankUpdate::parts);
        parts.into_iter().map(|part| -part).collect()
    }

    /// The solution for the right-hand side `b`, over the unknowns.
    pub fn solve(&mut self, b: &[f64]) -> Result<Vec<f64>, LinearError> {
        let Self { matrix, meter } = self;
        meter.time(|t| &mut t.solve, || matrix.solver.solve(b))
    }

    /// The response R T A^-1 T^T R^T f to the forces `f` over all dofs, where A is the matrix and R the rotation of its
    /// bodies (docs/numerics.md, Turned factors).
    pub fn respond(&mut self, f: &[f64]) -> Result<Vec<f64>, LinearError> {
        self.respond_from(&vec![0.0; f.len()], f)
    }

    /// The response to the forces `f`, plus `start`.
    pub fn respond_from(&mut self, start: &[f64], f: &[f64]) -> Result<Vec<f64>, LinearError> {
        self.begin(f)?;
        let mut response = Vec::new();
        self.end(start, &mut response)?;
        self.check()?;
        Ok(response)
    }

    /// Begins the response to the forces `f`, which is computed in parts.
    pub fn begin(&mut self, f: &[f64]) -> Result<(), LinearError> {
        self.hold()?;
        let Self { matrix, meter } = self;
        let FactoredMatrix {
            solver,
            compliance,
            vectors,
            update,
            ..
        } = &mut **matrix;
        let SolveVectors { forces, .. } = vectors;
        let (map, rotation) = (compliance.map(), compliance.rotation());
        let write = |b: &mut Vec<f64>| {
            if rotation.is_identity() {
                map.write_restricted(f, b);
            } else {
                forces.clear();
                forces.extend_from_slice(f);
                rotation.turn_back(forces);
                map.write_restricted(forces, b);
            }
            update.iter_mut().for_each(|update| update.begin(b));
        };
        meter.time(|t| &mut t.solve, || solver.begin(write))
    }

    /// Writes the solution A^-1 b for the present right-hand side b, at some unknowns, to `values`.
    pub fn partial(&mut self, unknowns: &[usize], values: &mut Vec<f64>) {
        let Self { matrix, meter } = self;
        meter.time(|t| &mut t.solve, || matrix.solver.partial(unknowns, values));
        matrix
            .update
            .iter()
            .for_each(|update| update.correct(unknowns, values));
    }

    /// Adds values to the right-hand side at the unknowns of the last part (unknown, value).
    pub fn add(&mut self, b: &[(usize, f64)]) {
        let Self { matrix, meter } = self;
        meter.time(|t| &mut t.solve, || matrix.solver.add(b));
        matrix.update.iter_mut().for_each(|update| update.add(b));
    }

    /// Ends the response and writes it over all dofs, plus `start`; [`Self::check`] checks the solution.
    pub fn end(&mut self, start: &[f64], response: &mut Vec<f64>) -> Result<(), LinearError> {
        let Self { matrix, meter } = self;
        let FactoredMatrix {
            solver,
            compliance,
            update,
            ..
        } = &mut **matrix;
        let (map, rotation) = (compliance.map(), compliance.rotation());
        let write = |q: &[f64]| {
            let corrected = update.as_ref().map(|update| update.corrected(q));
            let q = corrected.as_deref().unwrap_or(q);
            if rotation.is_identity() {
                map.write_sum(start, q, response);
            } else {
                response.clear();
                response.resize(start.len(), 0.0);
                map.add(q, response);
                rotation.turn(response);
                response.iter_mut().zip(start).for_each(|(r, s)| *r += s);
            }
        };
        meter.time(|t| &mut t.solve, || solver.end().map(write))
    }

    /// Memory for the response at some nodes, to be returned with [`Self::give_back`].
    pub fn take_vectors(&mut self) -> ResponseVectors {
        std::mem::take(&mut self.matrix.vectors.response)
    }

    /// Gives the memory of a response back for the next response.
    pub fn give_back(&mut self, response: ResponseVectors) {
        self.matrix.vectors.response = response;
    }

    /// Checks the residual of the last solution.
    pub fn check(&mut self) -> Result<(), LinearError> {
        let Self { matrix, meter } = self;
        meter.time(|t| &mut t.solve, || matrix.solver.check())
    }

    /// Solver of the complementarity problems.
    pub fn method(&self) -> LcpMethod {
        self.matrix.method
    }

    /// The map T at the iterate.
    pub fn map(&self) -> &Transformation {
        self.matrix.map()
    }

    /// Rotation R of the bodies since the matrix was factorised.
    pub fn rotation(&self) -> &Rotation {
        self.matrix.compliance.rotation()
    }

    /// The part to which a constraint belongs among the constraints between the same bodies; a part has `nodes` slave
    /// nodes.
    pub fn part_of(&self, constraint: &Constraint, nodes: usize) -> ConstraintGroup {
        self.matrix.compliance.part_of(constraint, nodes)
    }

    /// The bodies that a constraint acts on.
    pub fn scope_of(&self, constraint: &Constraint) -> ConstraintGroup {
        self.matrix.compliance.scope_of(constraint)
    }

    /// The complementarity problem of constraints whose compliance is computed together (a scope), with the given gaps
    /// and slips without forces.
    pub fn frictional_lcp(
        &mut self,
        scope: &ConstraintGroup,
        constraints: &[&Constraint],
        constant_terms: &[[f64; 2]],
    ) -> Result<FrictionalLcp, LinearError> {
        self.hold()?;
        let Self { matrix, meter } = self;
        meter.time(|t| &mut t.solve, || matrix.prepare(scope, constraints))?;
        let FactoredMatrix {
            compliance,
            space,
            update,
            free,
            ..
        } = &mut **matrix;
        let pose = || {
            let all = (&*compliance, scope);
            let mut problem = frictional_lcp(constraints, all, constant_terms, space);
            if let Some(update) = update {
                update.change(constraints, &mut problem.q);
            }
            if let Some(free) = free {
                problem.free = free.unknowns(constraints);
            }
            problem
        };
        Ok(meter.time(|t| &mut t.contact, pose))
    }

    /// Solves the complementarity problem of some constraints, starting from the states `warm`. Constraints between the
    /// same two bodies form a joint of the problem.
    pub fn solve_lcp(
        &mut self,
        problem: &FrictionalLcp,
        constraints: &[&Constraint],
        warm: &[ContactState],
    ) -> Result<FrictionalSolution, LcpError> {
        let Self { matrix, meter } = self;
        let FactoredMatrix {
            compliance,
            kept,
            method,
            ..
        } = &mut **matrix;
        let joints = || {
            let mut numbers = BTreeMap::new();
            let number = |constraint: &&Constraint| {
                let next = numbers.len();
                *numbers
                    .entry(compliance.scope_of(constraint))
                    .or_insert(next)
            };
            constraints.iter().map(number).collect()
        };
        let known = Known {
            states: warm,
            joints: &joints,
        };
        let kept = kept.entry(ConstraintGroup::All).or_default();
        let solve = || solve_similar(problem, Some(known), *method, kept);
        let solution = meter.time(|t| &mut t.lcp, solve)?;
        self.meter.count_lcp(warm.len(), solution.counters);
        Ok(solution)
    }

    /// Reclaims the memory of a complementarity problem that is not needed any more.
    pub fn take_back(&mut self, problem: FrictionalLcp) {
        self.matrix.space.take(problem);
    }

    /// Reclaims the memory of a solution that is not needed any more.
    pub fn take_back_solution(&mut self, solution: FrictionalSolution) {
        let kept = self.matrix.kept.entry(ConstraintGroup::All).or_default();
        kept.take(solution);
    }

    /// Solves the blocks of an iteration for the forces of all their contacts.
    pub fn solve_blocks(
        &mut self,
        iteration: &mut BlockIteration,
    ) -> Result<Vec<[f64; 2]>, LcpError> {
        let solve = || iteration.forces().map(<[_]>::to_vec);
        self.meter.time(|t| &mut t.lcp, solve)
    }

    /// Counts a complementarity problem that was solved by blocks.
    pub fn count_lcp(&mut self, size: usize, work: Counters) {
        self.meter.count_lcp(size, work);
    }

    /// Removes and returns the factors from the last complementarity problem of a scope.
    pub fn take_kept(&mut self, scope: &ConstraintGroup) -> KeptFactors {
        self.matrix.kept.remove(scope).unwrap_or_default()
    }

    /// Stores the factors from the last complementarity problem of a scope.
    pub fn keep(&mut self, scope: ConstraintGroup, kept: KeptFactors) {
        self.matrix.kept.insert(scope, kept);
    }
}
