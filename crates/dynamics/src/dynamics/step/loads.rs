//! External loads at a point in time and their consistent nodal forces: concentrated loads, body
//! forces, tractions and follower pressures. See docs/theory/time.md (R_theta).
//!
//! Times of a step within the analysis.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use crate::elements::Elements;
use crate::model::{CentrifugalForce, Load, Model, Pressure, Step, Thickness, TimeBase, Variation};
use crate::prepare::Redistribution;
use crate::vectors::difference;

/// A point in time: times since the start of the step and of the analysis, and the step's duration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TimePoint {
    pub step: f64,
    pub total: f64,
    pub period: f64,
}

impl TimePoint {
    /// Value of an amplitude.
    pub fn amplitude(&self, model: &Model, index: usize) -> f64 {
        let amplitude = &model.amplitudes[index];
        amplitude.at(self.of(amplitude.time))
    }

    /// Rate of an amplitude. Where the rate jumps, the result is the rate before the jump; at the start of a step it is
    /// the rate after the jump.
    pub fn amplitude_rate(&self, model: &Model, index: usize) -> f64 {
        let amplitude = &model.amplitudes[index];
        let t = self.of(amplitude.time);
        match self.step == 0.0 {
            true => amplitude.rate_after(t),
            false => amplitude.rate(t),
        }
    }

    /// Value of an amplitude, or 1, with its first and second integral since the start of the step
    /// (time, time^2).
    pub fn integrals(&self, model: &Model, index: Option<usize>) -> [f64; 3] {
        let Some(amplitude) = index.map(|index| &model.amplitudes[index]) else {
            return [1.0, self.step, self.step * self.step / 2.0];
        };
        let end = self.of(amplitude.time);
        let start = end - self.step;
        let [from, to] = [start, end].map(|t| amplitude.integrals(t));
        let second = to[1] - from[1] - from[0] * self.step;
        [amplitude.at(end), to[0] - from[0], second]
    }

    /// Ramp over the step: the part of the step's duration that has passed, at most 1.
    pub fn ramped(&self) -> f64 {
        (self.step / self.period).min(1.0)
    }

    fn of(&self, base: TimeBase) -> f64 {
        match base {
            TimeBase::Step => self.step,
            TimeBase::Total => self.total,
        }
    }

    /// Magnitude of a load.
    pub fn magnitude<T>(&self, model: &Model, load: &Load<T>) -> f64 {
        match load.variation {
            Variation::Constant => load.magnitude,
            Variation::Ramp { from } => from + (load.magnitude - from) * self.ramped(),
            Variation::Amplitude(index) => load.magnitude * self.amplitude(model, index),
        }
    }
}

/// Start and end of an increment as points in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Interval {
    pub start: TimePoint,
    pub end: TimePoint,
    pub dt: f64,
}

/// Derivative of the forces at some dofs with respect to their displacements; rows are forces, columns displacements
/// (force/length).
#[derive(Debug, Clone)]
pub(crate) struct ForceChange {
    pub dofs: Vec<usize>,
    pub matrix: DMatrix<f64>,
}

impl ForceChange {
    /// Symmetric part of the matrix.
    pub fn symmetric(&self) -> DMatrix<f64> {
        (&self.matrix + self.matrix.transpose()) / 2.0
    }

    /// Skew part of the matrix.
    pub fn skew(&self) -> DMatrix<f64> {
        (&self.matrix - self.matrix.transpose()) / 2.0
    }
}

/// Dead loads of one magnitude: body forces, and tractions over the reference faces.
struct DeadLoad {
    load: Load<()>,
    /// Nodal forces for a magnitude of 1 (dof, force), in the order of the dofs.
    forces: Vec<(usize, f64)>,
}

/// Centrifugal forces of an element with its consistent mass per direction, n x n (mass).
struct SpinningMass {
    load: Load<CentrifugalForce>,
    mass: Vec<f64>,
}

/// Loads of one step.
pub(crate) struct Loads<'m> {
    model: &'m Model,
    step: &'m Step,
    elements: &'m Elements,
    redistribution: &'m Redistribution,
    dead: Vec<DeadLoad>,
    spinning: Vec<SpinningMass>,
    /// Forces of supports that the step no longer has (dof, force); they fade over the step.
    released: Vec<(usize, f64)>,
}

/// Nodal forces of a load with a magnitude of 1, by their dofs (force).
type UnitForces = BTreeMap<usize, f64>;

/// Unit forces of a load; the next loads in the deck that have the same magnitude are added to these forces.
fn unit_forces<'d, T>(
    all: &'d mut Vec<(Load<()>, UnitForces)>,
    &Load {
        magnitude,
        variation,
        ..
    }: &Load<T>,
) -> &'d mut UnitForces {
    let load = Load {
        at: (),
        magnitude,
        variation,
    };
    let place = match all.last() {
        Some((last, _)) if *last == load => all.len() - 1,
        _ => {
            all.push((load, UnitForces::new()));
            all.len() - 1
        }
    };
    &mut all[place].1
}

/// Body forces int N^T f^B dOmega on the nodes that carry the mass, with f^B uniform in the element, and tractions int
/// N^T f^S dGamma over the reference face.
fn dead_loads(
    model: &Model,
    step: &Step,
    elements: &Elements,
    redistribution: &Redistribution,
) -> Vec<DeadLoad> {
    let mut all = Vec::new();
    for load in &step.body_forces {
        let (element, forces) = (load.at.element, unit_forces(&mut all, load));
        let density = match load.at.per_mass {
            true => elements.density(element),
            false => 1.0,
        };
        let volumes = elements.nodal_volumes(element);
        for (&node, volume) in elements.nodes(element).iter().zip(volumes) {
            let force = load.at.direction.map(|e| density * volume * e);
            redistribution.hand_out(node, force, |dof, force| {
                *forces.entry(dof).or_default() += force;
            });
        }
    }
    for load in &step.tractions {
        let forces = unit_forces(&mut all, load);
        let side = load.at.face.of(&model.mesh);
        let (x, first) = (&model.mesh.coordinates, side.nodes()[0]);
        let across = (elements.thickness(load.at.face.element), x[first][0]);
        for (node, area) in side.areas(|node| difference(x[first], x[node]), across) {
            for (i, e) in load.at.direction.into_iter().enumerate() {
                *forces.entry(2 * node + i).or_default() += area * e;
            }
        }
    }
    let dead = |(load, forces): (_, UnitForces)| DeadLoad {
        load,
        forces: forces.into_iter().collect(),
    };
    all.into_iter().map(dead).collect()
}

impl<'m> Loads<'m> {
    pub fn new(
        model: &'m Model,
        step: &'m Step,
        elements: &'m Elements,
        redistribution: &'m Redistribution,
    ) -> Self {
        let spinning = |&load: &Load<CentrifugalForce>| SpinningMass {
            load,
            mass: elements.mass(load.at.element),
        };
        Loads {
            dead: dead_loads(model, step, elements, redistribution),
            spinning: step.centrifugal_forces.iter().map(spinning).collect(),
            model,
            step,
            elements,
            redistribution,
            released: Vec::new(),
        }
    }

    /// Lets the forces of supports that the step no longer has fade over the step (dof, force).
    pub fn release(&mut self, forces: Vec<(usize, f64)>) {
        self.released = forces;
    }

    /// Whether the step has no loads.
    pub fn are_none(&self) -> bool {
        self.step.point_loads.is_empty()
            && self.dead.is_empty()
            && self.spinning.is_empty()
            && self.step.pressures.is_empty()
            && self.released.is_empty()
    }

    /// External load R_theta = (1 - theta1) R(t0) + theta1 R(t1), eq. (4.4), with follower pressures in the
    /// configuration of displacements `u` (2 N entries, force).
    pub fn write_weighted(&self, theta1: f64, interval: Interval, u: &[f64], r: &mut [f64]) {
        r.fill(0.0);
        self.add(1.0 - theta1, interval.start, u, r);
        self.add(theta1, interval.end, u, r);
    }

    /// External load R at a time, with pressures as in [`Self::write_weighted`].
    pub fn at(&self, now: TimePoint, u: &[f64]) -> Vec<f64> {
        let mut r = vec![0.0; u.len()];
        self.add(1.0, now, u, &mut r);
        r
    }

    /// Derivatives, at a time, of the loads that follow the displacements `u`: pressures and centrifugal forces.
    pub fn changes(&self, now: TimePoint, u: &[f64]) -> Vec<ForceChange> {
        let of_pressure = |load: &Load<Pressure>| {
            let p = now.magnitude(self.model, load);
            self.change_of_pressure(load, p, u)
        };
        let of_pressures = self.step.pressures.iter().map(of_pressure);
        let of_centrifugal = self.spinning.iter().map(|SpinningMass { load, mass }| {
            let (element, factor) = (load.at.element, now.magnitude(self.model, load));
            let is_ring = self.elements.thickness(element) == Thickness::Around;
            let nodes = self.elements.nodes(element);
            let mass = DMatrix::from_column_slice(nodes.len(), nodes.len(), mass);
            let directions = if is_ring { [1.0, 0.0] } else { [1.0; 2] };
            let both = DMatrix::from_diagonal(&DVector::from_column_slice(&directions));
            ForceChange {
                dofs: nodes
                    .iter()
                    .flat_map(|node| [2 * node, 2 * node + 1])
                    .collect(),
                matrix: mass.kronecker(&both) * factor,
            }
        });
        of_pressures.chain(of_centrifugal).collect()
    }

    /// The part of the concentrated loads in R_theta, `dofs` entries (force).
    pub fn concentrated(
        &self,
        theta1: f64,
        start: TimePoint,
        end: TimePoint,
        dofs: usize,
    ) -> Vec<f64> {
        let mut r = vec![0.0; dofs];
        self.add_concentrated(1.0 - theta1, start, &mut r);
        self.add_concentrated(theta1, end, &mut r);
        r
    }

    fn add_concentrated(&self, weight: f64, at: TimePoint, r: &mut [f64]) {
        for load in &self.step.point_loads {
            r[load.at.dof] += weight * at.magnitude(self.model, load);
        }
        for &(dof, force) in &self.released {
            r[dof] += weight * force * (1.0 - at.ramped());
        }
    }

    /// Adds the dead loads.
    fn add_dead_loads(&self, weight: f64, at: TimePoint, r: &mut [f64]) {
        for DeadLoad { load, forces } in &self.dead {
            let f = weight * at.magnitude(self.model, load);
            forces.iter().for_each(|(dof, force)| r[*dof] += f * force);
        }
    }

    /// Adds omega² int rho N^T N (x - x_axis) dOmega, with the arm in the configuration of displacements `u`, at the
    /// nodes that carry the mass, eq. (4.28).
    fn add_centrifugal_forces(&self, weight: f64, at: TimePoint, u: &[f64], r: &mut [f64]) {
        for SpinningMass { load, mass } in &self.spinning {
            let (element, axis) = (load.at.element, load.at.axis);
            let factor = weight * at.magnitude(self.model, load);
            let is_ring = self.elements.thickness(element) == Thickness::Around;
            let nodes = self.elements.nodes(element);
            for (&node, masses) in nodes.iter().zip(mass.chunks(nodes.len())) {
                let mut force = [0.0; 2];
                for (&other, m) in nodes.iter().zip(masses) {
                    let x = self.model.mesh.coordinates[other];
                    force[0] += factor * m * (x[0] + u[2 * other] - axis[0]);
                    if !is_ring {
                        force[1] += factor * m * (x[1] + u[2 * other + 1] - axis[1]);
                    }
                }
                self.redistribution
                    .hand_out(node, force, |dof, force| r[dof] += force);
            }
        }
    }

    fn add(&self, weight: f64, at: TimePoint, u: &[f64], r: &mut [f64]) {
        if weight == 0.0 {
            return;
        }
        self.add_concentrated(weight, at, r);
        self.add_dead_loads(weight, at, r);
        self.add_centrifugal_forces(weight, at, u, r);
        for load in &self.step.pressures {
            self.add_pressure(load, weight * at.magnitude(self.model, load), u, r);
        }
    }

    /// Adds the pressure p on the current face, -p int N^T n t dl, where n is the outward normal and t the thickness or
    /// 2 pi r. A shear p along the face adds p int N^T e t dl, where e is the unit vector along the face.
    fn add_pressure(&self, load: &Load<Pressure>, p: f64, u: &[f64], r: &mut [f64]) {
        let side = load.at.face.of(&self.model.mesh);
        let (x, a) = (&self.model.mesh.coordinates, side.nodes()[0]);
        let from_first = |b: usize| [0, 1].map(|i| x[b][i] + u[2 * b + i] - x[a][i] - u[2 * a + i]);
        let thickness = self.elements.thickness(load.at.face.element);
        let across = (thickness, x[a][0] + u[2 * a]);
        for (node, thrust) in side.thrusts(from_first, across) {
            let [x, y] = load.at.force(thrust);
            r[2 * node] += p * x;
            r[2 * node + 1] += p * y;
        }
    }

    /// Position of a node at displacements `u`.
    fn position(&self, u: &[f64], node: usize) -> [f64; 2] {
        [0, 1].map(|i| self.model.mesh.coordinates[node][i] + u[2 * node + i])
    }

    /// Derivative of the forces of the pressure p on a face. The forces of the pressure are polynomials of degree 2 at
    /// most in the positions, so central differences with any step length are exact; the step length here is the length
    /// of the face.
    fn change_of_pressure(&self, load: &Load<Pressure>, p: f64, u: &[f64]) -> ForceChange {
        let side = load.at.face.of(&self.model.mesh);
        let thickness = self.elements.thickness(load.at.face.element);
        let [a, b] = side.ends().map(|node| self.position(u, node));
        let step = difference(a, b)
            .map(f64::abs)
            .into_iter()
            .fold(0.0, f64::max);
        let dofs: Vec<usize> = (side.nodes().iter())
            .flat_map(|n| [2 * n, 2 * n + 1])
            .collect();
        let forces = |moved: usize, by: f64| {
            let at = |node: usize| {
                let mut x = self.position(u, node);
                if moved / 2 == node {
                    x[moved % 2] += by;
                }
                x
            };
            let first = at(dofs[0] / 2);
            let thrusts = side.thrusts(|node| difference(first, at(node)), (thickness, first[0]));
            let forces = thrusts.flat_map(|(_, thrust)| load.at.force(thrust).map(|f| p * f));
            DVector::from_iterator(dofs.len(), forces)
        };
        let column = |&dof: &usize| (forces(dof, step) - forces(dof, -step)) / (2.0 * step);
        let columns: Vec<DVector<f64>> = dofs.iter().map(column).collect();
        let matrix = DMatrix::from_columns(&columns);
        ForceChange { dofs, matrix }
    }
}

/// Number, start and duration of a step.
#[derive(Clone, Copy)]
pub(crate) struct StepPlace {
    /// Number of the step, from 1.
    pub number: usize,
    /// Time of the analysis at which the step starts.
    pub start: f64,
    /// Duration of the step in the deck (time).
    pub period: f64,
    /// Time by which a run goes on beyond the step; ramped loads keep their values at the end of the step.
    pub extension: f64,
}

impl StepPlace {
    /// Step time at which the step ends.
    pub fn end(&self) -> f64 {
        self.period + self.extension
    }

    /// The point in time when the time `step` has passed since the start of the step.
    pub fn time_point(&self, step: f64) -> TimePoint {
        TimePoint {
            step,
            total: self.start + step,
            period: self.period,
        }
    }
}
