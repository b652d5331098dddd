//! Pins of static steps: stiffness at a few dofs that holds the rigid motions left free by supports. See
//! docs/theory/bodies.md, Pins.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::bodies::{Hold, holds};
use super::normals::{Normal, Normals, Vertices};
use super::parts::Parts;
use super::step_problem::StepProblem;
use crate::contact::{ClosedPair, Constraint};
use crate::dynamics::results::{Cause, Unbalanced};
use crate::linear::{Transformation, larger, largest};
use crate::model::Equation;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Largest motion of a node in a rigid motion of a body within a pass, relative to the reach of the search; also the
/// largest angle of this motion (rad).
const LARGEST_TRAVEL: f64 = 0.8;
const LARGEST_ANGLE: f64 = 0.2;
/// Eigenvalue of a rigid motion, relative to the largest possible eigenvalue, up to which the motion is free.
const FREE: f64 = 1e-10;
/// Sum of the terms of an equation in a rigid motion, relative to the size of the terms, up to which the equation
/// allows the motion.
const AGREES: f64 = 1e-9;
/// Least stiffness of the pins of a rigid body, relative to the largest force divided by the body's size, so that pins
/// move little compared with the size of the body.
const STIFF: f64 = 1e3;
/// Round-off of the resultant of many nodal forces, relative to the round-off of one nodal force.
const RESULTANT: f64 = 10.0;

/// The pins of a step.
#[derive(Default)]
pub(crate) struct Pins {
    bodies: Vec<PinnedBody>,
    vertices: Vertices,
}

/// A body with rigid motions that no support holds, or a part of a body that is joined to other parts by equations but
/// can still move freely.
struct PinnedBody {
    /// Number of the body to which the nodes belong.
    body: usize,
    /// Nodes of the body, and the centres of mass of the rigid bodies in it that turn, increasing.
    nodes: Vec<usize>,
    /// Dofs of the angles of the rigid bodies that turn, with the lengths of these bodies.
    spins: Vec<Spin>,
    /// Whether the body is rigid, without elements that deform.
    is_rigid: bool,
    /// Whether the body has no support, or is pinned at a node.
    hold: Hold,
    /// Free motions in terms of the two translations and the rotation about the pole, in units of the body's size,
    /// column by column.
    free: DMatrix<f64>,
    /// Size of the body (length).
    size: f64,
    /// Dofs that are pinned, one for each free motion.
    dofs: Vec<usize>,
}

/// The motions Z_p of the pins of a body in its free rigid motions, and the inverse.
pub(super) struct PinMotions {
    seen: DMatrix<f64>,
    inverse: DMatrix<f64>,
}

impl PinMotions {
    /// Motions Z_p z of the pins in a free motion z.
    pub fn motions(&self, z: &DVector<f64>) -> DVector<f64> {
        &self.seen * z
    }

    /// Forces Z_p^-T f at the pins, with the resultant f along the free motions.
    pub fn forces(&self, f: &DVector<f64>) -> DVector<f64> {
        self.inverse.tr_mul(f)
    }
}

/// Dof L theta of an angle theta, and its length L.
type Spin = (usize, f64);

/// The rigid motions in one configuration: two translations, and the rotation about a pole in units of a size of the
/// body.
struct PinFrame<'a> {
    pole: [f64; 2],
    size: f64,
    spins: &'a [Spin],
    x: &'a dyn Fn(usize) -> [f64; 2],
}

impl PinFrame<'_> {
    /// Motion of a dof in both translations and in the rotation that moves points by 1 whose distance from the pole is
    /// the size.
    fn row(&self, dof: usize) -> Vector3<f64> {
        if let Some((_, length)) = self.spins.iter().find(|spin| spin.0 == dof) {
            return Vector3::new(0.0, 0.0, length / self.size);
        }
        let [px, py] = (self.x)(dof / 2);
        match dof % 2 {
            0 => Vector3::new(1.0, 0.0, -(py - self.pole[1]) / self.size),
            _ => Vector3::new(0.0, 1.0, (px - self.pole[0]) / self.size),
        }
    }
}

impl Pins {
    /// The pins of a static step; a dynamic step has no pins, since inertia holds all bodies.
    pub fn new(problem: &StepProblem) -> Self {
        if problem.integration.has_rates {
            return Pins::default();
        }
        let (parts, unknowns) = (problem.parts, &problem.unknowns);
        let holds = holds(problem);
        let mut nodes = vec![Vec::new(); parts.bodies()];
        let mut has_unknowns = vec![false; parts.bodies()];
        let turning = &unknowns.turning;
        let mut spins: Vec<Vec<Spin>> = vec![Vec::new(); parts.bodies()];
        for body in turning.bodies {
            spins[parts.of_nodes()[body.centre]].push((body.spin, body.length));
        }
        // the pairs of dofs of angles have no position
        let mut is_angle = vec![false; parts.of_nodes().len()];
        (turning.bodies.iter()).for_each(|body| is_angle[body.spin / 2] = true);
        let placed = parts.of_nodes().iter().enumerate();
        for (node, &body) in placed.filter(|(node, _)| !is_angle[*node]) {
            nodes[body].push(node);
        }
        for &dof in &unknowns.dof {
            has_unknowns[parts.of_nodes()[dof / 2]] = true;
        }
        let mut has_elements = vec![false; problem.coordinates.len()];
        for &node in problem.elements.connected().flatten() {
            has_elements[node] = true;
        }
        let components = problem.model.mesh.bodies();
        let pinned = |(body, (nodes, spins)): (usize, (Vec<usize>, Vec<Spin>))| {
            if !has_unknowns[body] || nodes.len() <= 1 {
                return Vec::new();
            }
            let of_body = (body, holds[body], has_elements.as_slice());
            let parts = match spins.is_empty() {
                true => components_of(&nodes, &components, &has_elements),
                false => Vec::new(),
            };
            if let Some(whole) = PinnedBody::new(problem, of_body, (nodes, spins)) {
                return vec![whole];
            }
            // parts that equations join may have motions that the equations allow
            let part = |nodes| PinnedBody::new(problem, of_body, (nodes, Vec::new()));
            parts.into_iter().filter_map(part).collect()
        };
        let all = nodes.into_iter().zip(spins).enumerate();
        Pins {
            bodies: all.flat_map(pinned).collect(),
            vertices: Vertices::new(problem.model),
        }
    }

    /// Whether the step has no pins.
    pub fn are_none(&self) -> bool {
        self.bodies.is_empty()
    }

    /// Whether a node belongs to a body that is pinned.
    pub fn hold(&self, node: usize) -> bool {
        self.bodies
            .iter()
            .any(|body| body.nodes.binary_search(&node).is_ok())
    }

    /// The pinned dofs.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        self.bodies
            .iter()
            .flat_map(|body| body.dofs.iter().copied())
    }

    /// Stiffness a of every pin in K*, whose diagonal is given: the mean K_ii over the unknowns of the body, eq.
    /// (12.2). Only springs give a rigid body stiffness of its own. Its pins have at least the mean over all unknowns
    /// if pairs touch the body, and always at least 1e3 times `force` divided by the size of the body.
    pub fn stiffnesses(
        &self,
        diagonal: &[f64],
        (map, parts): (&Transformation, &Parts),
        acting: &[(&Constraint, &ClosedPair)],
        force: f64,
    ) -> Vec<f64> {
        let mean = |of: &mut dyn Iterator<Item = f64>| {
            let (sum, count) = of.fold((0.0, 0.0), |(sum, n), k| (sum + k.abs(), n + 1.0));
            if count > 0.0 { sum / count } else { 0.0 }
        };
        let of_all = mean(&mut diagonal.iter().copied());
        let of_body = |body: &PinnedBody| {
            let is_own = |node: usize| parts.of_nodes()[node] == body.body;
            let unknowns = (map.rows().enumerate())
                .filter(|(dof, row)| is_own(dof / 2) && row.len() == 1)
                .map(|(_, row)| diagonal[row[0].0]);
            let touches = || acting.iter().any(|(c, _)| c.nodes().any(is_own));
            let own = mean(&mut unknowns.into_iter());
            let a = match own > 0.0 && (!body.is_rigid || !touches()) {
                true => own,
                false => larger(own, of_all),
            };
            let a = match body.is_rigid {
                true => larger(a, STIFF * force / body.size),
                false => a,
            };
            // without stiffness and forces any positive value serves, since nothing moves
            if a > 0.0 { a } else { 1.0 }
        };
        let all = self.bodies.iter();
        all.flat_map(|body| vec![of_body(body); body.dofs.len()])
            .collect()
    }

    /// Raises the stiffness of the unknowns of rigid bodies to the stiffness `a` of their pins, if `a` is larger.
    pub fn stiffen_rigid(&self, (map, parts): (&Transformation, &Parts), a: &[f64], k: &mut [f64]) {
        let all = self.bodies.iter().zip(self.of_bodies());
        for (body, pins) in all.filter(|(body, _)| body.is_rigid) {
            let of_body = a[pins.start];
            for (dof, row) in map.rows().enumerate() {
                if let &[(unknown, _)] = row
                    && parts.of_nodes()[dof / 2] == body.body
                {
                    k[unknown] = larger(k[unknown], of_body);
                }
            }
        }
    }

    /// Largest round-off of the forces at the pins of deformable bodies. The round-off at a pin is ten times the
    /// round-off 4 eps a |x| of one nodal force, where a is the stiffness of the pin in K* and x the size of the body.
    pub fn round_off(&self, a: &[f64]) -> f64 {
        let all = self.bodies.iter().zip(self.of_bodies());
        all.filter(|(body, _)| !body.is_rigid)
            .map(|(body, pins)| RESULTANT * 4.0 * f64::EPSILON * a[pins.start] * body.size)
            .fold(0.0, larger)
    }

    /// Range of the pins of every body among all pins.
    pub fn of_bodies(&self) -> Vec<Range<usize>> {
        let mut end = 0;
        let places = self.bodies.iter().map(|body| {
            let first = end;
            end += body.dofs.len();
            first..end
        });
        places.collect()
    }

    /// Mean square of the free motions over the nodes of every body at the positions `at`, as a quadratic form of the
    /// motions of its pins.
    ///
    /// ```text
    /// E = Z_p^-T (sum_i Z_i^T Z_i/n) Z_p^-1      eq. (12.5)
    /// ```
    pub fn mean_square(&self, at: &dyn Fn(usize) -> [f64; 2]) -> DMatrix<f64> {
        let of_bodies = self.of_bodies();
        let m = of_bodies.last().map_or(0, |own| own.end);
        let mut all = DMatrix::identity(m, m);
        for (body, own) in self.bodies.iter().zip(of_bodies) {
            if let Some(block) = body.mean_square(at) {
                let size = (own.len(), own.len());
                all.view_mut((own.start, own.start), size).copy_from(&block);
            }
        }
        all
    }

    /// Stiffness against rotations from the forces (given over all dofs) that the iterate does not balance yet, if
    /// these forces pull a body apart. The matrix is over the motions of the pins at the positions `at`:
    ///
    /// ```text
    /// Z_p^-T e max(sum_i x_i.r_i, 0) e^T Z_p^-1,   e the turn      eq. (12.14)
    /// ```
    pub fn turning_stiffness(&self, force: &[f64], at: &dyn Fn(usize) -> [f64; 2]) -> DMatrix<f64> {
        let of_bodies = self.of_bodies();
        let m = of_bodies.last().map_or(0, |own| own.end);
        let mut all = DMatrix::zeros(m, m);
        for (body, own) in self.bodies.iter().zip(of_bodies) {
            if let Some(turn) = body.turn(at) {
                let size = (own.len(), own.len());
                let virial = larger(body.virial(force, at), 0.0);
                all.view_mut((own.start, own.start), size)
                    .copy_from(&(virial * &turn * turn.transpose()));
            }
        }
        all
    }

    /// The failure of bodies that are not in balance: it names the body with the largest of the forces `f` left at the
    /// pins. The forces at the pins cause the correction `du` at the displacements `u`.
    pub fn unbalanceable(&self, problem: &StepProblem, u: &[f64], du: &[f64], f: &[f64]) -> Cause {
        match self.most_unbalanced(problem, u, du, f) {
            Some(unbalanced) => Cause::Unbalanceable(unbalanced),
            None => Cause::NotConverged,
        }
    }

    /// The body with the largest of the forces `f` at the pins, and its motion in the correction `du`.
    pub fn most_unbalanced(
        &self,
        problem: &StepProblem,
        u: &[f64],
        du: &[f64],
        f: &[f64],
    ) -> Option<Box<Unbalanced>> {
        let at = |node: usize| problem.position(u, node);
        let all = self.bodies.iter().zip(self.of_bodies());
        let size = |pins: &Range<usize>| largest(&f[pins.clone()]);
        let most = all.max_by(|p, q| size(&p.1).total_cmp(&size(&q.1)));
        most.map(|(body, pins)| Box::new(body.unbalanced(&at, du, &f[pins])))
    }

    /// Motions of the pins in the free motions at the positions `at`, for the body number `body` among the bodies with
    /// pins; `None` if the pins do not determine all free motions.
    pub(super) fn motions(
        &self,
        body: usize,
        at: &dyn Fn(usize) -> [f64; 2],
    ) -> Option<PinMotions> {
        let body = &self.bodies[body];
        let frame = body.frame(pole(body.hold, &body.nodes, at), at);
        body.motions_of_pins(&frame)
    }

    /// Sum of the normal forces on every body with pins.
    pub fn normal_forces(&self, acting: &[(&Constraint, &ClosedPair)]) -> Vec<f64> {
        let of_body = |body: &PinnedBody| {
            let is_own = |node: usize| body.nodes.binary_search(&node).is_ok();
            let own = acting.iter().filter(|(c, _)| c.nodes().any(is_own));
            own.map(|(_, pair)| pair.force[0]).sum()
        };
        self.bodies.iter().map(of_body).collect()
    }

    /// The pairs of the body number `body` among the bodies with pins, along its free motions at the positions `at`.
    pub(super) fn normals(
        &self,
        body: usize,
        at: &dyn Fn(usize) -> [f64; 2],
        acting: &[(&Constraint, &ClosedPair)],
    ) -> Normals {
        self.bodies[body].normals(&self.vertices, at, acting)
    }

    /// Force that facets may cause along a motion Z n of all dofs, and the stiffness of facets against this motion,
    /// over the pairs without friction.
    ///
    /// ```text
    /// f_e = sum_j Pn_j |Gt_j Z n| sin(beta_j)/2,   k_e = sum_j Pn_j (Gt_j Z n)² sin(beta_j)/l_j      eq. (12.12), eq. (12.13)
    /// ```
    pub fn facets(
        &self,
        acting: &[(&Constraint, &ClosedPair)],
        at: &dyn Fn(usize) -> [f64; 2],
        motion: &[f64],
    ) -> [f64; 2] {
        let (mut force, mut stiffness) = (0.0, 0.0);
        for (constraint, pair) in acting.iter().filter(|(c, _)| c.mu == 0.0) {
            let kinks = constraint.nodes().map(|node| self.vertices.kink(node, at));
            let kink = kinks.fold(0.0, larger);
            let slip = constraint.tangential_motion(motion);
            force += pair.force[0] * slip.abs() * kink / 2.0;
            stiffness += pair.force[0] * slip * slip * kink / constraint.scale;
        }
        [force, stiffness]
    }

    /// Turns the rigid part of a correction into a finite motion of bodies that turn, and limits it to the reach of the
    /// contact search; returns whether the motion has been limited. `at` are the positions of the iterate.
    pub fn make_finite(&self, at: &dyn Fn(usize) -> [f64; 2], reach: f64, du: &mut [f64]) -> bool {
        let mut is_limited = false;
        for body in &self.bodies {
            is_limited |= body.make_finite(at, reach, du);
        }
        is_limited
    }
}

impl PinnedBody {
    fn new(
        problem: &StepProblem,
        (body, hold, has_elements): (usize, Hold, &[bool]),
        (nodes, spins): (Vec<usize>, Vec<Spin>),
    ) -> Option<Self> {
        let (model, unknowns) = (problem.model, &problem.unknowns);
        let x = |node: usize| problem.coordinates[node];
        let pole = pole(hold, &nodes, &x);
        let arms = nodes.iter().map(|&node| distance(pole, x(node)));
        let lengths = spins.iter().map(|spin| spin.1);
        let size = match arms.fold(0.0, larger) {
            0.0 => lengths.fold(0.0, larger),
            size => size,
        };
        let frame = PinFrame {
            pole,
            size,
            spins: &spins,
            x: &x,
        };
        let row = |dof: usize| frame.row(dof);
        // conditions of supports and equations on a rigid motion
        let mut gram = Matrix3::zeros();
        let of_nodes = |dof: usize| nodes.binary_search(&(dof / 2)).is_ok();
        let of_angles = |dof: usize| spins.iter().any(|spin| spin.0 == dof);
        let own = |dof: usize| of_nodes(dof) || of_angles(dof);
        let tightening = tightening(&model.equations, has_elements, own, row);
        let moves_parts = |dof: usize| tightening.contains(&dof);
        for dof in unknowns
            .prescribed()
            .filter(|&dof| own(dof) && !moves_parts(dof))
        {
            gram += row(dof) * row(dof).transpose();
        }
        // nodes of other bodies in its equations are taken to be at rest
        let own_row = |dof: usize| if own(dof) { row(dof) } else { Vector3::zeros() };
        let is_rigid = |e: &&Equation| !e.terms.iter().any(|term| moves_parts(term.0));
        for Equation { dof, terms } in model.equations.iter().filter(is_rigid) {
            let of_terms: Vector3<f64> = terms.iter().map(|&(to, c)| c * own_row(to)).sum();
            let asked = own_row(*dof) - of_terms;
            gram += asked * asked.transpose();
        }
        if model.mesh.is_axisymmetric() {
            // across the axis, and about it, there is no rigid motion
            gram[(0, 0)] += 1.0;
            gram[(2, 2)] += 1.0;
        }
        let eigen = gram.symmetric_eigen();
        let least = FREE * nodes.len() as f64;
        let free: Vec<_> = (0..3)
            .filter(|&k| eigen.eigenvalues[k] <= least)
            .map(|k| eigen.eigenvectors.column(k).into_owned())
            .collect();
        if free.is_empty() {
            return None;
        }
        let free = DMatrix::from_fn(3, free.len(), |i, k| free[k][i]);
        let is_meant = |&dof: &usize| own(dof) && !moves_parts(dof);
        let candidates: Vec<usize> = unknowns.dof.iter().copied().filter(is_meant).collect();
        let leads = |dof: &usize| unknowns.turning.leading().any(|leading| leading == *dof);
        let is_rigid = candidates.iter().all(leads);
        let dofs = independent_dofs(candidates, &free, row)?;
        Some(PinnedBody {
            body,
            nodes,
            spins,
            is_rigid,
            hold,
            free,
            size,
            dofs,
        })
    }

    fn unbalanced(&self, at: &dyn Fn(usize) -> [f64; 2], du: &[f64], f: &[f64]) -> Unbalanced {
        let pole = pole(self.hold, &self.nodes, at);
        let (mut force, mut moment) = ([0.0; 2], 0.0);
        let frame = self.frame(pole, at);
        for (&dof, &f) in self.dofs.iter().zip(f) {
            let row = frame.row(dof);
            (0..2).for_each(|i| force[i] += row[i] * f);
            moment += row[2] * self.size * f;
        }
        let motion = self.motion(at, pole, du).unwrap_or_default();
        Unbalanced {
            node: self.dofs[0] / 2,
            force,
            moment,
            motion: [motion[0], motion[1], motion[2] / self.size],
            size: self.size,
        }
    }

    /// Rigid motions of the body about a pole.
    fn frame<'a>(&'a self, pole: [f64; 2], x: &'a dyn Fn(usize) -> [f64; 2]) -> PinFrame<'a> {
        PinFrame {
            pole,
            size: self.size,
            spins: &self.spins,
            x,
        }
    }

    /// Motions Z_p of the pins in the free motions of the body; `None` if the pins do not determine all free motions.
    fn motions_of_pins(&self, frame: &PinFrame) -> Option<PinMotions> {
        let m = self.dofs.len();
        let seen =
            |i: usize, k: usize| (frame.row(self.dofs[i])).dot(&self.free.fixed_view::<3, 1>(0, k));
        let seen = DMatrix::from_fn(m, m, seen);
        let inverse = seen.clone().try_inverse()?;
        Some(PinMotions { seen, inverse })
    }

    /// Rotation Z_p^-T e of the body for unit motions of its pins (1/length); `None` if the pins do not determine all
    /// its motions.
    fn turn(&self, at: &dyn Fn(usize) -> [f64; 2]) -> Option<DVector<f64>> {
        let frame = self.frame(pole(self.hold, &self.nodes, at), at);
        let inverse = self.motions_of_pins(&frame)?.inverse;
        let turn = self.free.row(2).transpose() / self.size;
        Some(inverse.tr_mul(&turn))
    }

    /// The sum of x_i.r_i over the nodes of the body, with forces r_i (given over all dofs) and positions x_i relative
    /// to the pole (force length).
    fn virial(&self, force: &[f64], at: &dyn Fn(usize) -> [f64; 2]) -> f64 {
        let [px, py] = pole(self.hold, &self.nodes, at);
        let of_node = |&node: &usize| {
            let [x, y] = at(node);
            (x - px) * force[2 * node] + (y - py) * force[2 * node + 1]
        };
        self.nodes.iter().map(of_node).sum()
    }

    /// The mean square motion E as a quadratic form of the motions of the pins of the body; `None` if the pins do not
    /// determine all its motions.
    fn mean_square(&self, at: &dyn Fn(usize) -> [f64; 2]) -> Option<DMatrix<f64>> {
        let frame = self.frame(pole(self.hold, &self.nodes, at), at);
        let inverse = self.motions_of_pins(&frame)?.inverse;
        let mut sum = Matrix3::zeros();
        for dof in self.nodes.iter().flat_map(|&node| [2 * node, 2 * node + 1]) {
            sum += frame.row(dof) * frame.row(dof).transpose();
        }
        // the angles count too, so that a body of one node can turn
        for &(spin, length) in &self.spins {
            let turn = frame.row(spin) * (self.size / length);
            sum += turn * turn.transpose();
        }
        let free = self.free.transpose() * sum * &self.free / self.nodes.len() as f64;
        Some(inverse.transpose() * free * inverse)
    }

    /// Rigid part Z_p^-1 dU_p of a correction, from the motions dU_p of the pins.
    fn motion(
        &self,
        at: &dyn Fn(usize) -> [f64; 2],
        pole: [f64; 2],
        du: &[f64],
    ) -> Option<Vector3<f64>> {
        let moved = DVector::from_fn(self.dofs.len(), |i, _| du[self.dofs[i]]);
        let motions = self.motions_of_pins(&self.frame(pole, at))?;
        let motion = &self.free * (motions.inverse * moved);
        Some(Vector3::new(motion[0], motion[1], motion[2]))
    }

    fn normals(
        &self,
        vertices: &Vertices,
        at: &dyn Fn(usize) -> [f64; 2],
        acting: &[(&Constraint, &ClosedPair)],
    ) -> Normals {
        let frame = self.frame(pole(self.hold, &self.nodes, at), at);
        let is_own = |dof: usize| self.nodes.binary_search(&(dof / 2)).is_ok();
        let mut normals = Vec::new();
        for (constraint, pair) in acting {
            let own = constraint.dofs.iter().filter(|&&dof| is_own(dof)).count();
            if own == 0 || own == constraint.dofs.len() {
                continue;
            }
            let rigid = |row: &[f64]| -> Vector3<f64> {
                let both = constraint.dofs.iter().zip(row);
                let own = both.filter(|(dof, _)| is_own(**dof));
                own.map(|(&dof, g)| *g * frame.row(dof)).sum()
            };
            let normal = rigid(&constraint.derivative_rows().normal);
            let tangent = rigid(&constraint.force_rows.tangential);
            let kinks = constraint.nodes().map(|node| vertices.kink(node, at));
            normals.push(Normal {
                row: self.free.tr_mul(&normal),
                tangent: self.free.tr_mul(&tangent),
                size: normal.norm_squared(),
                kink: kinks.fold(0.0, larger),
                force: pair.force[0],
                scale: constraint.scale,
                has_friction: constraint.mu > 0.0,
            });
        }
        Normals(normals)
    }

    fn make_finite(&self, at: &dyn Fn(usize) -> [f64; 2], reach: f64, du: &mut [f64]) -> bool {
        let pole = pole(self.hold, &self.nodes, at);
        let Some(motion) = self.motion(at, pole, du) else {
            return false;
        };
        let [tx, ty, angle] = [motion[0], motion[1], motion[2] / self.size];
        let arm = |node: usize| [at(node)[0] - pole[0], at(node)[1] - pole[1]];
        let linear = |node: usize| {
            let [x, y] = arm(node);
            [tx - angle * y, ty + angle * x]
        };
        let travel = |node: &usize| linear(*node)[0].hypot(linear(*node)[1]);
        let most = self.nodes.iter().map(travel).fold(0.0, larger);
        let turns = self.hold != Hold::Held;
        let mut part = 1.0_f64;
        if most > LARGEST_TRAVEL * reach {
            part = LARGEST_TRAVEL * reach / most;
        }
        if angle.abs() > LARGEST_ANGLE {
            part = part.min(LARGEST_ANGLE / angle.abs());
        }
        // a rigid body whose motion is below the round-off of its positions stays at rest
        let far = |node: &usize| at(*node).map(f64::abs).into_iter().fold(0.0, larger);
        let extent = self.nodes.iter().map(far).fold(0.0, larger);
        if self.is_rigid && most <= 4.0 * f64::EPSILON * extent {
            part = 0.0;
        }
        if !part.is_finite() || (part == 1.0 && !turns) {
            return false;
        }
        let (sin, cos) = (part * angle).sin_cos();
        for &node in &self.nodes {
            let ([x, y], [lx, ly]) = (arm(node), linear(node));
            let to = match turns {
                true => [
                    part * tx + (cos - 1.0) * x - sin * y,
                    part * ty + sin * x + (cos - 1.0) * y,
                ],
                false => [part * lx, part * ly],
            };
            du[2 * node] += to[0] - lx;
            du[2 * node + 1] += to[1] - ly;
        }
        for &(spin, length) in &self.spins {
            du[spin] += (part - 1.0) * angle * length;
        }
        part < 1.0
    }
}

/// Dofs of nodes without elements that, through equations, move parts of a body relative to each other, as the
/// tightening of a pre-tension section does. With the terms of tightening dofs an equation forbids rigid motions that
/// it allows without these terms.
fn tightening(
    equations: &[Equation],
    has_elements: &[bool],
    own: impl Fn(usize) -> bool,
    row: impl Fn(usize) -> Vector3<f64>,
) -> BTreeSet<usize> {
    let mut found = BTreeSet::new();
    for Equation { dof, terms } in equations.iter().filter(|e| own(e.dof)) {
        let alone = |&&(to, _): &&(usize, f64)| !has_elements[to / 2];
        if !terms.iter().any(|term| alone(&term)) {
            continue;
        }
        let sum = |terms: &mut dyn Iterator<Item = &(usize, f64)>| -> Vector3<f64> {
            terms.map(|&(to, c)| c * row(to)).sum()
        };
        let all = row(*dof) - sum(&mut terms.iter());
        let without = all + sum(&mut terms.iter().filter(alone));
        let size = row(*dof).norm();
        if all.norm() > AGREES * size && without.norm() <= AGREES * size {
            found.extend(terms.iter().filter(alone).map(|term| term.0));
        }
    }
    found
}

/// Groups of the nodes of a body that elements connect, if no group is the whole body; `components` are the first nodes
/// of the groups of all nodes.
fn components_of(nodes: &[usize], components: &[usize], has_elements: &[bool]) -> Vec<Vec<usize>> {
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for &node in nodes.iter().filter(|&&node| has_elements[node]) {
        if let Some(&first) = components.get(node) {
            groups.entry(first).or_default().push(node);
        }
    }
    match groups.values().any(|group| group.len() == nodes.len()) {
        true => Vec::new(),
        false => groups.into_values().collect(),
    }
}

/// Point about which a body turns: the node at which it is pinned, or the mean of its nodes.
fn pole(hold: Hold, nodes: &[usize], x: &dyn Fn(usize) -> [f64; 2]) -> [f64; 2] {
    if let Hold::Pinned(node) = hold {
        return x(node);
    }
    let mut sum = [0.0; 2];
    for &node in nodes {
        let [px, py] = x(node);
        sum = [sum[0] + px, sum[1] + py];
    }
    sum.map(|sum| sum / nodes.len() as f64)
}

/// The dofs that are pinned, one for each free motion, chosen by a pivoted QR factorisation of the rows of the dofs in
/// these motions.
fn independent_dofs(
    dofs: Vec<usize>,
    free: &DMatrix<f64>,
    row: impl Fn(usize) -> Vector3<f64>,
) -> Option<Vec<usize>> {
    let seen = |&dof: &usize| free.transpose() * row(dof);
    let mut rows: Vec<_> = dofs.iter().map(seen).collect();
    let mut chosen = Vec::new();
    for _ in 0..free.ncols() {
        let largest = |i: &usize, k: &usize| rows[*i].norm().total_cmp(&rows[*k].norm());
        let at = (0..rows.len()).max_by(largest)?;
        let direction = rows[at].clone().try_normalize(f64::EPSILON)?;
        chosen.push(dofs[at]);
        for row in &mut rows {
            let part = row.dot(&direction);
            *row -= &direction * part;
        }
    }
    Some(chosen)
}

fn distance(p: [f64; 2], q: [f64; 2]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}
