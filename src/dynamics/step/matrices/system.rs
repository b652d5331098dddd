//! A system matrix of a step, K* or M, whose work is measured: solves, in one go or in parts, and its
//! complementarity problems. Sections 4 and 5 of docs/theory.md.

use super::effective_stiffness::{FactoredMatrix, ResponseVectors, SolveVectors};
use crate::contact::{Constraint, Scope, frictional_lcp};
use crate::dynamics::step::meter::Meter;
use crate::lcp::{
    BlockIteration, ContactName, ContactState, Counters, FrictionalLcp, FrictionalSolution,
    KeptFactors, LcpError, LcpMethod, solve_similar,
};
use crate::linear::{LinearError, Rotation, Transformation};

/// K* or M of a step with the meter of the work that is done with it.
pub(crate) struct System<'a> {
    matrix: &'a mut FactoredMatrix,
    meter: &'a mut Meter,
}

impl<'a> System<'a> {
    /// A matrix whose work is measured by `meter`.
    pub fn new(matrix: &'a mut FactoredMatrix, meter: &'a mut Meter) -> Self {
        System { matrix, meter }
    }

    /// Whether the factors are those of the current matrix.
    pub fn is_factorized(&self) -> bool {
        self.matrix.solver.is_factorized()
    }

    /// Factorises the matrix.
    pub fn factorize(&mut self) -> Result<(), LinearError> {
        let Self { matrix, meter } = self;
        meter.time(|t| &mut t.factorization, || matrix.factorize())
    }

    /// The solution for the right-hand side `b`, over the unknowns.
    pub fn solve(&mut self, b: &[f64]) -> Result<Vec<f64>, LinearError> {
        let Self { matrix, meter } = self;
        meter.time(|t| &mut t.solve, || matrix.solver.solve(b))
    }

    /// R T A^-1 T^T R^T f for the forces `f` over all dofs, A being the matrix and R the rotation of its
    /// bodies, eq. (4.20).
    pub fn respond(&mut self, map: &Transformation, f: &[f64]) -> Result<Vec<f64>, LinearError> {
        self.begin(map, f)?;
        let mut response = Vec::new();
        self.end(map, &vec![0.0; f.len()], &mut response)?;
        self.check()?;
        Ok(response)
    }

    /// Begins the response to the forces `f`, in parts.
    pub fn begin(&mut self, map: &Transformation, f: &[f64]) -> Result<(), LinearError> {
        let Self { matrix, meter } = self;
        let FactoredMatrix {
            solver,
            compliance,
            vectors,
            ..
        } = &mut **matrix;
        let SolveVectors { forces, .. } = vectors;
        let rotation = compliance.rotation();
        let write = |b: &mut Vec<f64>| {
            if rotation.is_identity() {
                map.write_restricted(f, b);
            } else {
                forces.clear();
                forces.extend_from_slice(f);
                rotation.turn_back(forces);
                map.write_restricted(forces, b);
            }
        };
        meter.time(|t| &mut t.solve, || solver.begin(write))
    }

    /// Writes A^-1 b for the right-hand side so far, at some unknowns, to `values`.
    pub fn partial(&mut self, unknowns: &[usize], values: &mut Vec<f64>) {
        let Self { matrix, meter } = self;
        meter.time(|t| &mut t.solve, || matrix.solver.partial(unknowns, values));
    }

    /// Adds to the right-hand side at unknowns of the last part (unknown, value).
    pub fn add(&mut self, b: &[(usize, f64)]) {
        let Self { matrix, meter } = self;
        meter.time(|t| &mut t.solve, || matrix.solver.add(b));
    }

    /// Ends the response and writes it, over all dofs, with `start` added to it; [`Self::check`] checks the
    /// solution.
    pub fn end(
        &mut self,
        map: &Transformation,
        start: &[f64],
        response: &mut Vec<f64>,
    ) -> Result<(), LinearError> {
        let Self { matrix, meter } = self;
        let FactoredMatrix {
            solver, compliance, ..
        } = &mut **matrix;
        let rotation = compliance.rotation();
        let write = |q: &[f64]| {
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

    /// Memory for the response at some nodes, which [`Self::give_back`] gives back.
    pub fn take_vectors(&mut self) -> ResponseVectors {
        std::mem::take(&mut self.matrix.vectors.response)
    }

    /// Gives memory back.
    pub fn give_back(&mut self, response: ResponseVectors) {
        self.matrix.vectors.response = response;
    }

    /// Checks the residual of the last solution.
    pub fn check(&mut self) -> Result<(), LinearError> {
        let Self { matrix, meter } = self;
        meter.time(|t| &mut t.solve, || matrix.solver.check())
    }

    /// R of the bodies since the matrix was factorised.
    pub fn rotation(&self) -> &Rotation {
        self.matrix.compliance.rotation()
    }

    /// The bodies that a constraint acts on.
    pub fn scope_of(&self, constraint: &Constraint) -> Scope {
        self.matrix.compliance.scope_of(constraint)
    }

    /// The complementarity problem of constraints of a scope with the given gaps and slips without forces.
    pub fn frictional_lcp(
        &mut self,
        scope: &Scope,
        constraints: &[&Constraint],
        constant_terms: &[[f64; 2]],
    ) -> Result<FrictionalLcp, LinearError> {
        let Self { matrix, meter } = self;
        meter.time(|t| &mut t.solve, || matrix.prepare(scope, constraints))?;
        let FactoredMatrix {
            compliance, space, ..
        } = &mut **matrix;
        let pose = || frictional_lcp(constraints, (compliance, scope), constant_terms, space);
        Ok(meter.time(|t| &mut t.contact, pose))
    }

    /// Solves a complementarity problem, starting from the states `warm`.
    pub fn solve_lcp(
        &mut self,
        problem: &FrictionalLcp,
        warm: &[ContactState],
        method: LcpMethod,
    ) -> Result<FrictionalSolution, LcpError> {
        let Self { matrix, meter } = self;
        let kept = matrix.kept.entry(Scope::All).or_default();
        let solve = || solve_similar(problem, Some(warm), method, kept);
        let solution = meter.time(|t| &mut t.lcp, solve)?;
        self.meter.count_lcp(warm.len(), solution.counters);
        Ok(solution)
    }

    /// Takes the memory of a complementarity problem that is not needed any more.
    pub fn take_back(&mut self, problem: FrictionalLcp) {
        self.matrix.space.take(problem);
    }

    /// Takes the memory of a solution that is not needed any more.
    pub fn take_back_solution(&mut self, solution: FrictionalSolution) {
        let kept = self.matrix.kept.entry(Scope::All).or_default();
        kept.take(solution);
    }

    /// Solves the blocks of an iteration: the forces of all its contacts.
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

    /// Names the constraints of the next complementarity problem, each differently.
    pub fn name_contacts(&mut self, names: impl Iterator<Item = ContactName>) {
        let kept = self.matrix.kept.entry(Scope::All).or_default();
        kept.name_contacts(names);
    }

    /// Takes the factors of the last complementarity problem of a scope.
    pub fn take_kept(&mut self, scope: &Scope) -> KeptFactors {
        self.matrix.kept.remove(scope).unwrap_or_default()
    }

    /// Keeps the factors of the last complementarity problem of a scope.
    pub fn keep(&mut self, scope: Scope, kept: KeptFactors) {
        self.matrix.kept.insert(scope, kept);
    }
}
