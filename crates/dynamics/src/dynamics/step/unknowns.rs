//! Unknowns q of a step and the displacements that depend on them, u = T q + g(t): free dofs,
//! supports, and dofs that follow others by equations. See docs/theory/contact.md.
//!
//! Prescribed motion of a step: displacements from ramps and amplitudes, and integrated velocities
//! and accelerations. See docs/theory/time.md.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::loads::TimePoint;
use super::turning::{Turning, TurningBody};
use crate::contact::tolerances::TIED_ROW;
use crate::contact::{Constraint, PerDof};
use crate::elements::Elements;
use crate::linear::Transformation;
use crate::model::{Equation, Model, Procedure, Rate, Step, SupportMotion};

/// The unknowns q of a step, U = T q + g(t), eq. (3.7): the displacements of the free dofs.
///
/// In T a free dof has a row of the identity, a support an empty row and its prescribed motion in g. A dof of an
/// equation has the sum of the rows, and of the g, of the dofs that it follows. A node of a body that turns follows the
/// pole and the angle of the body, by rows that change with the iterate.
pub(crate) struct Unknowns<'m> {
    /// T; its rows of bodies that turn are those at the start of the analysis.
    pub map: Transformation,
    /// Bodies that turn.
    pub turning: Turning<'m>,
    /// Dof of every unknown.
    pub dof: Vec<usize>,
    supports: Supports<'m>,
    equations: &'m [Equation],
    /// Supports, dofs of equations and nodes of bodies that turn, on which forces of constraints act; increasing.
    constrained: Vec<usize>,
}

impl<'m> Unknowns<'m> {
    /// Unknowns of a step with the displacements `u` and velocities `v` at its start.
    pub fn new(
        model: &'m Model,
        (elements, bodies): (&Elements, &'m [TurningBody]),
        step: &'m Step,
        [u, v]: [&[f64]; 2],
    ) -> Self {
        let equations = model.equations.as_slice();
        let is_static = step.procedure == Procedure::Static;
        let turning = Turning::new(bodies, is_static, |dof| step.motion_of(dof).is_some());
        let free = free_dofs(elements, equations, &turning, step, u.len());
        let dof: Vec<usize> = (0..u.len()).filter(|&dof| free[dof]).collect();
        let of_supports = step.supports.iter().map(|support| support.dof);
        let mut constrained: Vec<usize> = of_supports
            .chain(equations.iter().flat_map(Equation::dofs))
            .chain(turning.followers().map(|[dof, ..]| dof))
            .collect();
        constrained.sort_unstable();
        constrained.dedup();
        Unknowns {
            map: transformation(&dof, equations, &turning, u.len()),
            turning,
            dof,
            supports: Supports::new(model, bodies, step, [u, v]),
            equations,
            constrained,
        }
    }

    /// Whether any of the nodes depends on an unknown.
    pub fn moves(&self, nodes: &[usize]) -> bool {
        let mut dofs = nodes.iter().flat_map(|node| [2 * node, 2 * node + 1]);
        dofs.any(|dof| self.depends(dof))
    }

    /// Whether a dof depends on an unknown.
    pub fn depends(&self, dof: usize) -> bool {
        !self.map.row(dof).is_empty()
    }

    /// Whether the gap of a constraint can change. The gap cannot change if equations tie the node
    /// to the segment: then Gn T is zero but for round-off.
    pub fn opens(&self, constraint: &Constraint) -> bool {
        if !self.turning.is_empty() {
            let nodes: PerDof<usize> = constraint.nodes().collect();
            if self.turning.are_of_one_body(&nodes) {
                return false;
            }
        }
        if self.equations.is_empty() {
            return true;
        }
        let mut row = BTreeMap::new();
        let gradient = &constraint.derivative_rows().normal;
        for (&dof, b) in constraint.dofs.iter().zip(gradient) {
            for &(unknown, c) in self.map.row(dof) {
                *row.entry(unknown).or_insert(0.0) += c * b;
            }
        }
        row.values().any(|entry: &f64| entry.abs() > TIED_ROW)
    }

    /// Prescribed dofs.
    pub fn prescribed(&self) -> impl Iterator<Item = usize> + '_ {
        self.supports.dofs()
    }

    /// Whether a dof is prescribed.
    pub fn is_prescribed(&self, dof: usize) -> bool {
        self.supports.step.motion_of(dof).is_some()
    }

    /// Whether a dof is prescribed to stay where it is.
    pub fn is_held(&self, dof: usize) -> bool {
        let motion = self.supports.step.motion_of(dof);
        motion.is_some_and(SupportMotion::is_still)
    }

    /// Supports, dofs of equations and nodes of bodies that turn, on which forces of constraints act; increasing.
    pub fn constrained(&self) -> &[usize] {
        &self.constrained
    }

    /// Rest g(t) - u of the prescribed displacement of the supports in the iterate `u` of an increment from `u0`; zero
    /// at free dofs.
    pub fn prescribed_increment(&self, [u0, u]: [&[f64]; 2], end: TimePoint) -> Vec<f64> {
        let mut d = vec![0.0; u.len()];
        for (dof, prescribed, _) in self.supports.motion(end) {
            d[dof] = prescribed - u[dof];
        }
        self.turning.rotations(&mut d);
        self.turning.follow(u, &mut d);
        self.turning.go_on([u0, u], &mut d);
        self.follow(&mut d);
        d
    }

    /// Sets displacement and velocity of the supports, and of the dofs of equations that follow
    /// them.
    pub fn prescribe(&self, at: TimePoint, u: &mut [f64], v: &mut [f64]) {
        for (dof, u1, v1) in self.supports.motion(at) {
            (u[dof], v[dof]) = (u1, v1);
        }
        self.turning.place(u);
        self.move_bodies(u, v);
        self.follow(u);
        self.follow(v);
    }

    /// Sets the velocities of the nodes of bodies that turn to those of their bodies at
    /// displacements `u`.
    pub fn move_bodies(&self, u: &[f64], v: &mut [f64]) {
        self.turning.move_with(u, v, |dof| self.is_prescribed(dof));
    }

    /// Sets the velocities of all nodes of bodies that turn to those of their poles at displacements `u`, and then
    /// those of the dofs of equations.
    pub fn move_with_poles(&self, u: &[f64], v: &mut [f64]) {
        self.turning.move_with_poles(u, v);
        self.follow(v);
    }

    /// Sets the velocity of the supports at the start of the analysis, and then those of bodies that turn and of the
    /// dofs of equations.
    pub fn prescribe_velocity(&self, at: TimePoint, u: &[f64], v: &mut [f64]) {
        for (dof, _, v1) in self.supports.motion(at) {
            v[dof] = v1;
        }
        self.turning.start(u, v);
        self.follow(v);
    }

    /// Sets the acceleration of the supports to (V1 - V0)/dt.
    pub fn prescribe_acceleration(&self, at: TimePoint, v0: &[f64], dt: f64, a: &mut [f64]) {
        for (dof, _, v1) in self.supports.motion(at) {
            a[dof] = (v1 - v0[dof]) / dt;
        }
    }

    /// Makes a vector of displacements, velocities or accelerations satisfy the equations, eq. (3.8).
    pub fn follow(&self, v: &mut [f64]) {
        for equation in self.equations {
            v[equation.dof] = equation.terms.iter().map(|&(dof, c)| c * v[dof]).sum();
        }
    }

    /// Forces on all dofs, with those on dofs of equations passed on to the dofs, free or prescribed, that they follow.
    /// On the free dofs the result is T^T v.
    pub fn passed_on<'v>(&self, v: &'v [f64]) -> Cow<'v, [f64]> {
        self.pass_on(v, |force| force)
    }

    /// Upper bounds of forces on all dofs after they are passed on: sums of absolute values.
    pub fn magnitudes<'v>(&self, v: &'v [f64]) -> Cow<'v, [f64]> {
        self.pass_on(v, f64::abs)
    }

    fn pass_on<'v>(&self, v: &'v [f64], part: fn(f64) -> f64) -> Cow<'v, [f64]> {
        if self.equations.is_empty() {
            return Cow::Borrowed(v);
        }
        let mut all: Vec<f64> = v.iter().map(|&force| part(force)).collect();
        for Equation { dof, terms } in self.equations {
            for &(to, c) in terms {
                all[to] += part(c * v[*dof]);
            }
        }
        Cow::Owned(all)
    }
}

/// For every dof whether it is free: dofs of nodes with elements, and dofs that those dofs follow,
/// except supports and dofs that follow others.
fn free_dofs(
    elements: &Elements,
    equations: &[Equation],
    turning: &Turning,
    step: &Step,
    dofs: usize,
) -> Vec<bool> {
    let mut free = vec![false; dofs];
    for &node in elements.connected().flatten() {
        (free[2 * node], free[2 * node + 1]) = (true, true);
    }
    turning.followers().for_each(|[dof, ..]| free[dof] = false);
    let angles = turning.bodies.iter().map(|body| body.spin);
    angles.for_each(|angle| free[angle + 1] = false);
    turning.leading().for_each(|dof| free[dof] = true);
    let has_element = free.clone();
    for equation in equations.iter().filter(|e| has_element[e.dof]) {
        for &(dof, _) in &equation.terms {
            free[dof] = true;
        }
    }
    let follow = equations.iter().map(|equation| equation.dof);
    for dof in follow.chain(step.supports.iter().map(|support| support.dof)) {
        free[dof] = false;
    }
    free
}

/// Coefficient of an angle until an iterate sets it; it must differ from the 1 in a row of the
/// identity.
const UNSET: f64 = 2.0;

/// T for unknowns with the given dofs; the last term in the row of a node of a body that turns belongs to the angle.
fn transformation(
    dof_of: &[usize],
    equations: &[Equation],
    turning: &Turning,
    dofs: usize,
) -> Transformation {
    let mut rows = vec![Vec::new(); dofs];
    for (unknown, &dof) in dof_of.iter().enumerate() {
        rows[dof] = vec![(unknown, 1.0)];
    }
    for Equation { dof, terms } in equations {
        let free = terms.iter().filter_map(|&(to, c)| {
            let &(unknown, _) = rows[to].first()?;
            Some((unknown, c))
        });
        rows[*dof] = free.collect();
    }
    for [dof, pole, angle] in turning.followers() {
        let of_angle = rows[angle].iter().map(|&(unknown, _)| (unknown, UNSET));
        rows[dof] = rows[pole].iter().copied().chain(of_angle).collect();
    }
    Transformation::new(dof_of.len(), rows)
}

/// Prescribed motion of the supports of one step.
pub(super) struct Supports<'m> {
    model: &'m Model,
    step: &'m Step,
    /// Displacement and velocity of every support at the start of the step.
    from: Vec<[f64; 2]>,
    /// Factor on the motion of every support: 1, or for an angle the length of its body.
    units: Vec<f64>,
}

impl<'m> Supports<'m> {
    /// Supports of a step with the displacements `u` and velocities `v` at its start.
    pub fn new(
        model: &'m Model,
        bodies: &[TurningBody],
        step: &'m Step,
        [u, v]: [&[f64]; 2],
    ) -> Self {
        let unit = |dof: usize| {
            let turns = bodies.iter().find(|body| body.spin == dof);
            turns.map_or(1.0, |body| body.length)
        };
        let dofs = || step.supports.iter().map(|support| support.dof);
        let units: Vec<f64> = dofs().map(unit).collect();
        let from = dofs().zip(&units);
        Supports {
            model,
            step,
            from: from
                .map(|(dof, unit)| [u[dof] / unit, v[dof] / unit])
                .collect(),
            units,
        }
    }

    /// Prescribed dofs.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        self.step.supports.iter().map(|support| support.dof)
    }

    /// Dof, displacement and velocity of every support, from the amplitude and its derivative or its integrals.
    pub fn motion(&self, at: TimePoint) -> impl Iterator<Item = (usize, f64, f64)> + '_ {
        let supports = self.step.supports.iter().zip(&self.from).zip(&self.units);
        supports.map(move |((support, &from), unit)| {
            let [u, v] = self.displacement_and_velocity(support.motion, from, at);
            (support.dof, unit * u, unit * v)
        })
    }

    /// Displacement and velocity of one support with the displacement `from` and the velocity `v0`
    /// at the start.
    fn displacement_and_velocity(
        &self,
        motion: SupportMotion,
        [from, v0]: [f64; 2],
        at: TimePoint,
    ) -> [f64; 2] {
        match motion {
            SupportMotion::Ramp { to } => {
                let u = from + (to - from) * at.ramped();
                let moves = at.step <= at.period;
                [u, if moves { (to - from) / at.period } else { 0.0 }]
            }
            SupportMotion::Amplitude { value, amplitude } => [
                value * at.amplitude(self.model, amplitude),
                value * at.amplitude_rate(self.model, amplitude),
            ],
            SupportMotion::Rate {
                rate,
                value,
                amplitude,
            } => {
                // a, and its first and second integral since the start of the step, eq. (4.20)
                let [a, first, second] = at.integrals(self.model, amplitude);
                match rate {
                    Rate::Velocity => [from + value * first, value * a],
                    Rate::Acceleration => {
                        [from + v0 * at.step + value * second, v0 + value * first]
                    }
                }
            }
        }
    }
}
