//! Rigid bodies: positions of their nodes and rows of T in an iterate, from two translations and a
//! finite rotation. See docs/theory/bodies.md, Rigid bodies that turn.

use crate::elements::Elements;
use crate::linear::Transformation;
use crate::model::{Model, RigidBody};
use crate::vectors::{cross, difference, distance, dot};

/// A rigid body, which turns if its angle is not held. The unknowns of a rigid body are the displacement of its pole
/// and s = L c. Here c = 2 tan(dtheta/2) is the body's rotation in the increment, and L is a length of the body, by
/// which s is a displacement and its work-conjugate a force.
pub struct TurningBody {
    /// The node of the centre of mass.
    pub centre: usize,
    /// Reference node.
    pub reference: usize,
    /// Dof of the angle: the displacement there is L theta, the velocity L omega, the increment s =
    /// L c.
    pub spin: usize,
    /// Length L of the body: the largest arm from the reference node.
    pub length: f64,
    /// Mass.
    pub mass: f64,
    /// Moment of inertia about the centre of mass.
    pub inertia: f64,
    /// Nodes of the body, including the reference node and the centre, with their arms from the reference node in the
    /// reference configuration.
    arms: Vec<(usize, [f64; 2])>,
    /// Nodes that carry mass of deformable elements, increasing.
    loaded: Vec<usize>,
    /// Arm of the centre of mass from the reference node.
    to_centre: [f64; 2],
}

/// The vector J r: r turned by a right angle to the left.
fn turned([x, y]: [f64; 2]) -> [f64; 2] {
    [-y, x]
}

/// The vector R r: r rotated by an angle, which is given by its sine and cosine.
fn rotated((sin, cos): (f64, f64), [x, y]: [f64; 2]) -> [f64; 2] {
    [cos * x - sin * y, sin * x + cos * y]
}

/// Mean arm r_m = (r_0 + r_1)/2 in an increment, for an arm that is r_0 at the start, with r_1 -
/// r_0 = c J r_m:
///
/// ```text
/// r_m = (r_0 + (c/2) J r_0)/(1 + c²/4)      eq. (11.2)
/// ```
fn mean_arm(r0: [f64; 2], c: f64) -> [f64; 2] {
    let j = turned(r0);
    [0, 1].map(|i| (r0[i] + c / 2.0 * j[i]) / (1.0 + c * c / 4.0))
}

impl TurningBody {
    /// A rigid body of a model; `deforming` marks the nodes of deformable elements.
    fn new(model: &Model, elements: &Elements, deforming: &[bool], rigid: &RigidBody) -> Self {
        let x = &model.mesh.coordinates;
        // mass, its moments and int rho (X - X_ref)² dOmega from the consistent mass
        let arm = |node: usize| difference(x[rigid.reference], x[node]);
        let (mut mass, mut moment, mut square) = (0.0, [0.0; 2], 0.0);
        for &element in &rigid.elements {
            let (nodes, m) = (elements.nodes(element), elements.mass(element));
            for (j, &b) in nodes.iter().enumerate() {
                for (i, &a) in nodes.iter().enumerate() {
                    let m = m[j * nodes.len() + i];
                    mass += m;
                    (0..2).for_each(|k| moment[k] += m * arm(a)[k]);
                    square += m * dot(arm(a), arm(b));
                }
            }
        }
        for &(node, m) in &rigid.masses {
            mass += m;
            (0..2).for_each(|k| moment[k] += m * arm(node)[k]);
            square += m * dot(arm(node), arm(node));
        }
        let to_centre = match mass > 0.0 {
            true => moment.map(|sum| sum / mass),
            false => [0.0; 2],
        };
        let centre = model.centre_of(rigid);
        let ends = [(rigid.reference, [0.0; 2]), (centre, to_centre)];
        let others = rigid.nodes.iter().map(|&node| (node, arm(node)));
        let arms: Vec<_> = others.chain(ends).collect();
        let inertia = rigid.rotary_inertia + square - mass * dot(to_centre, to_centre);
        let longest = arms.iter().map(|(_, r)| distance([0.0; 2], *r));
        let length = match longest.fold(0.0, f64::max) {
            0.0 if mass > 0.0 && inertia > 0.0 => (inertia / mass).sqrt(),
            0.0 => 1.0,
            length => length,
        };
        let own = arms.iter().map(|arm| arm.0);
        let mut loaded: Vec<usize> = own
            .filter(|&node| deforming.get(node) == Some(&true))
            .collect();
        loaded.sort_unstable();
        TurningBody {
            loaded,
            centre,
            reference: rigid.reference,
            spin: model.angle_of(rigid),
            length,
            mass,
            inertia,
            arms,
            to_centre,
        }
    }

    /// The rigid bodies of a model.
    pub fn all(model: &Model, elements: &Elements) -> Vec<Self> {
        let deforms = |element: &usize| !elements.is_rigid(*element);
        let mut deforming = vec![false; model.mesh.node_count()];
        for element in (0..elements.len()).filter(deforms) {
            let nodes = elements.nodes(element).iter();
            nodes.for_each(|&node| deforming[node] = true);
        }
        let bodies = model.rigid_bodies.iter();
        bodies
            .map(|body| Self::new(model, elements, &deforming, body))
            .collect()
    }

    /// Adds those nodes of the body that carry mass of deformable elements for nodes without mass.
    pub fn load(&mut self, carriers: &[usize]) {
        let nodes: Vec<usize> = self.nodes().collect();
        let own = carriers.iter().filter(|node| nodes.contains(node));
        self.loaded.extend(own);
        self.loaded.sort_unstable();
        self.loaded.dedup();
    }

    /// Reference position of the centre of mass if the reference node is at `x`.
    pub fn centre_from(&self, x: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| x[i] + self.to_centre[i])
    }

    /// Nodes of the body, including the reference node and the centre.
    pub fn nodes(&self) -> impl Iterator<Item = usize> + '_ {
        self.arms.iter().map(|arm| arm.0)
    }

    /// Angle of the body at displacements `u` (rad).
    fn angle(&self, u: &[f64]) -> f64 {
        u[self.spin] / self.length
    }

    /// All nodes of the body except its pole, with their arms from the pole, at an angle.
    fn arms_from(
        &self,
        pole: usize,
        theta: f64,
    ) -> impl Iterator<Item = (usize, [f64; 2])> + use<'_> {
        let from = match pole == self.reference {
            true => [0.0; 2],
            false => self.to_centre,
        };
        let turn = theta.sin_cos();
        let arms = self.arms.iter().filter(move |(node, _)| *node != pole);
        arms.map(move |&(node, r)| (node, rotated(turn, difference(from, r))))
    }
}

/// Mass and moment of inertia about the centre of mass of every rigid body of a model.
pub fn rigid_inertia(model: &Model) -> Vec<[f64; 2]> {
    if model.rigid_bodies.is_empty() {
        return Vec::new();
    }
    let all = TurningBody::all(model, &Elements::new(model));
    all.iter().map(|body| [body.mass, body.inertia]).collect()
}

/// The rigid bodies in a step.
pub(crate) struct Turning<'m> {
    pub bodies: &'m [TurningBody],
    /// The pole of every body: its reference node if this node is held, else its centre of mass.
    poles: Vec<usize>,
    /// Whether both translations and the angle of a body are prescribed.
    driven: Vec<bool>,
    /// For every node the rigid body that moves the node, if any.
    body_of: Vec<Option<usize>>,
    /// Whether forces act at the end of an increment, as in a static step.
    acts_at_end: bool,
}

impl<'m> Turning<'m> {
    /// The rigid bodies in a step with some prescribed dofs.
    pub fn new(
        bodies: &'m [TurningBody],
        acts_at_end: bool,
        is_prescribed: impl Fn(usize) -> bool,
    ) -> Self {
        let held = |body: &TurningBody| [0, 1].map(|i| is_prescribed(2 * body.reference + i));
        let pole = |body: &TurningBody| match body.mass > 0.0 && held(body) == [false; 2] {
            true => body.centre,
            false => body.reference,
        };
        let is_driven = |body: &TurningBody| held(body) == [true; 2] && is_prescribed(body.spin);
        let last = bodies.iter().flat_map(TurningBody::nodes).max();
        let mut body_of = vec![None; last.map_or(0, |last| last + 1)];
        for (number, body) in bodies.iter().enumerate() {
            body.nodes().for_each(|node| body_of[node] = Some(number));
        }
        Turning {
            poles: bodies.iter().map(pole).collect(),
            driven: bodies.iter().map(is_driven).collect(),
            bodies,
            body_of,
            acts_at_end,
        }
    }

    /// Whether there are no rigid bodies.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// Whether supports prescribe the motion of all rigid bodies.
    pub fn are_driven(&self) -> bool {
        self.driven.iter().all(|driven| *driven)
    }

    /// Length L of the body whose angle is the given dof; the force on the dof is a moment divided by L.
    pub fn length_of(&self, dof: usize) -> Option<f64> {
        let body = self.bodies.iter().find(|body| body.spin == dof);
        body.map(|body| body.length)
    }

    /// Whether some nodes all belong to one body.
    pub fn are_of_one_body(&self, nodes: &[usize]) -> bool {
        let body = |node: &usize| self.body_of.get(*node).copied().flatten();
        let first = nodes.first().and_then(body);
        first.is_some() && nodes.iter().all(|node| body(node) == first)
    }

    /// Whether the mass matrix over the unknowns changes as bodies turn. The mass matrix changes if a centre of mass
    /// follows a reference node, or if nodes with mass of deformable elements follow a pole.
    pub fn turn_mass(&self) -> bool {
        let mut all = self.with_poles().zip(&self.driven);
        all.any(|((body, pole), driven)| {
            let follows = body.mass > 0.0 && pole != body.centre;
            !driven && (follows || !body.loaded.is_empty())
        })
    }

    /// Whether nodes of a body that is not driven carry mass of deformable elements: their velocities would not follow
    /// the rigid motion.
    pub fn carry_elements(&self) -> bool {
        let mut all = self.bodies.iter().zip(&self.driven);
        all.any(|(body, driven)| !driven && !body.loaded.is_empty())
    }

    /// Whether a node belongs to a body that is not driven.
    pub fn moves(&self, node: usize) -> bool {
        let body = self.body_of.get(node).copied().flatten();
        body.is_some_and(|body| !self.driven[body])
    }

    /// The bodies, each with its pole.
    fn with_poles(&self) -> impl Iterator<Item = (&'m TurningBody, usize)> + '_ {
        self.bodies.iter().zip(self.poles.iter().copied())
    }

    /// The bodies that are driven.
    fn driven(&self) -> impl Iterator<Item = &'m TurningBody> + '_ {
        let all = self.bodies.iter().zip(&self.driven);
        all.filter(|(_, driven)| **driven).map(|(body, _)| body)
    }

    /// Dofs that follow the pole and the angle of their body: the dof itself, the dof of the pole, and the dof of the
    /// angle.
    pub fn followers(&self) -> impl Iterator<Item = [usize; 3]> + '_ {
        self.with_poles().flat_map(|(body, pole)| {
            let nodes = body.nodes().filter(move |&node| node != pole);
            nodes.flat_map(move |node| [0, 1].map(|i| [2 * node + i, 2 * pole + i, body.spin]))
        })
    }

    /// Dofs of the poles and the angles.
    pub fn leading(&self) -> impl Iterator<Item = usize> + '_ {
        let of_body = |(body, pole): (&TurningBody, usize)| [2 * pole, 2 * pole + 1, body.spin];
        self.with_poles().flat_map(of_body)
    }

    /// Dofs of the nodes of the bodies that are driven, without their reference nodes.
    pub fn driven_dofs(&self) -> impl Iterator<Item = usize> + '_ {
        self.driven().flat_map(|body| {
            let nodes = body.nodes().filter(|&node| node != body.reference);
            nodes.flat_map(|node| [2 * node, 2 * node + 1])
        })
    }

    /// Sets the rows of T of the nodes of all bodies in the increment `d` from `u0`. Force rows are the difference
    /// quotient of the motion, derivative rows its derivative with respect to the iterate,
    ///
    /// ```text
    /// force rows  (f, r_m x f),   derivative rows  (f, (r_1 x f)/(1 + c²/4))      eq. (11.3)
    /// ```
    ///
    /// In a static step forces f act at the end, so they hand (f, r_1 x f) over to pole and angle.
    pub fn write_rows(&self, [u0, d]: [&[f64]; 2], map: &mut Transformation) {
        for (body, pole) in self.with_poles() {
            if map.row(body.spin).is_empty() {
                continue;
            }
            let (l, c) = (body.length, d[body.spin] / body.length);
            for (node, r0) in body.arms_from(pole, body.angle(u0)) {
                let j = turned(mean_arm(r0, c));
                let end = turned([0, 1].map(|i| r0[i] + c * j[i]));
                for i in 0..2 {
                    let derivative = end[i] / (1.0 + c * c / 4.0);
                    let force = if self.acts_at_end { end[i] } else { j[i] };
                    map.set_last(2 * node + i, [force / l, derivative / l]);
                }
            }
        }
    }

    /// Changes the increment `d` from `u0` into a rigid motion of every body:
    ///
    /// ```text
    /// d = d_pole + c J r_m      eq. (11.1)
    /// ```
    pub fn follow(&self, u0: &[f64], d: &mut [f64]) {
        for (body, pole) in self.with_poles() {
            let (c, of_pole) = (d[body.spin] / body.length, [d[2 * pole], d[2 * pole + 1]]);
            for (node, r0) in body.arms_from(pole, body.angle(u0)) {
                let j = turned(mean_arm(r0, c));
                (0..2).for_each(|i| d[2 * node + i] = of_pole[i] + c * j[i]);
            }
        }
    }

    /// Sets the displacements of the angles to the values after the increment `d` from `u0`: theta = theta_0 + 2
    /// atan(c/2).
    pub fn turn(&self, [u0, d]: [&[f64]; 2], u: &mut [f64]) {
        for body in self.bodies {
            let c = d[body.spin] / body.length;
            u[body.spin] = u0[body.spin] + body.length * (2.0 * (c / 2.0).atan());
        }
    }

    /// Corrects displacements `u` of the angles that contain a part of the increment s = L c, so that `u` contains this
    /// part of the difference L (theta_1 - theta_0).
    pub fn correct_angles(&self, d: &[f64], part: f64, u: &mut [f64]) {
        for body in self.bodies {
            let half = d[body.spin] / body.length / 2.0;
            u[body.spin] += part * (body.length * (2.0 * half.atan()) - d[body.spin]);
        }
    }

    /// The increment `d`, in which the angles have the differences L (theta_1 - theta_0) in place of s = L c.
    pub fn travel(&self, d: &[f64]) -> Vec<f64> {
        let mut travel = d.to_vec();
        for body in self.bodies {
            let half = d[body.spin] / body.length / 2.0;
            travel[body.spin] = body.length * (2.0 * half.atan());
        }
        travel
    }

    /// Replaces the differences L (theta_1 - theta_0) of the angles by the increments s = L c, with c = 2
    /// tan(dtheta/2).
    pub fn rotations(&self, d: &mut [f64]) {
        for body in self.bodies {
            d[body.spin] = body.length * 2.0 * (d[body.spin] / body.length / 2.0).tan();
        }
    }

    /// Changes the increments s = L c of the angles that start from the iterate `u` into increments that continue the
    /// increment from `u0` to `u` and lead to the same angles:
    ///
    /// ```text
    /// tan(a + b) - tan a = tan b (1 + tan² a)/(1 - tan a tan b)
    /// ```
    ///
    /// Here a and b are half the rotations before and after the iterate.
    pub fn go_on(&self, [u0, u]: [&[f64]; 2], d: &mut [f64]) {
        for body in self.bodies {
            let before = ((body.angle(u) - body.angle(u0)) / 2.0).tan();
            let more = d[body.spin] / body.length / 2.0;
            d[body.spin] *= (1.0 + before * before) / (1.0 - before * more);
        }
    }

    /// Sets the displacements of all nodes of the bodies to the motion of the poles and angles.
    pub fn place(&self, u: &mut [f64]) {
        for (body, pole) in self.with_poles() {
            let (of_pole, turn) = ([u[2 * pole], u[2 * pole + 1]], body.angle(u).sin_cos());
            for (node, r) in body.arms_from(pole, 0.0) {
                let end = rotated(turn, r);
                (0..2).for_each(|i| u[2 * node + i] = of_pole[i] + (end[i] - r[i]));
            }
        }
    }

    /// Sets the velocities of all nodes of the bodies to the motion of the centre of mass and the angle; `u` are the
    /// displacements. For bodies that are driven or have no mass the velocities follow from the motion of the reference
    /// node and the angle. Prescribed dofs keep their velocities, and so do nodes with mass of deformable elements in a
    /// body that is not driven.
    pub fn move_with(&self, u: &[f64], v: &mut [f64], is_prescribed: impl Fn(usize) -> bool) {
        for (body, &driven) in self.bodies.iter().zip(&self.driven) {
            let carrier = match driven || body.mass == 0.0 {
                true => body.reference,
                false => body.centre,
            };
            let (omega, own) = (
                v[body.spin] / body.length,
                [v[2 * carrier], v[2 * carrier + 1]],
            );
            for (node, r) in body.arms_from(carrier, body.angle(u)) {
                if !driven && body.loaded.binary_search(&node).is_ok() {
                    continue;
                }
                for i in (0..2).filter(|i| !is_prescribed(2 * node + i)) {
                    v[2 * node + i] = own[i] + omega * turned(r)[i];
                }
            }
        }
    }

    /// Sets the velocities of the nodes of all bodies to the motion of the pole and the angle; `u` are the
    /// displacements.
    pub fn move_with_poles(&self, u: &[f64], v: &mut [f64]) {
        for (body, pole) in self.with_poles() {
            let (omega, own) = (v[body.spin] / body.length, [v[2 * pole], v[2 * pole + 1]]);
            for (node, r) in body.arms_from(pole, body.angle(u)) {
                let j = turned(r);
                (0..2).for_each(|i| v[2 * node + i] = own[i] + omega * j[i]);
            }
        }
    }

    /// Writes the increment of free poles and angles that go on with the velocities `v`.
    pub fn predict(
        &self,
        v: &[f64],
        dt: f64,
        d: &mut [f64],
        is_prescribed: impl Fn(usize) -> bool,
    ) {
        for dof in self.leading().filter(|&dof| !is_prescribed(dof)) {
            d[dof] = dt * v[dof];
        }
    }

    /// Sets the accelerations of the nodes of driven bodies to (V1 - V0)/dt in an increment `d` from `u0`. The list `a`
    /// must already hold the accelerations of the reference nodes and angles.
    pub fn drive(&self, [u0, d]: [&[f64]; 2], v0: &[f64], dt: f64, a: &mut [f64]) {
        for body in self.driven() {
            let reference = 2 * body.reference;
            let [x, y, s] = [reference, reference + 1, body.spin].map(|dof| v0[dof] + dt * a[dof]);
            let theta = body.angle(u0) + 2.0 * (d[body.spin] / body.length / 2.0).atan();
            for (node, r) in body.arms_from(body.reference, theta) {
                let j = turned(r);
                for (i, own) in [x, y].into_iter().enumerate() {
                    let v1 = own + s / body.length * j[i];
                    a[2 * node + i] = (v1 - v0[2 * node + i]) / dt;
                }
            }
        }
    }

    /// Corrects the accelerations of the nodes of bodies that are not driven, in an increment `d` from `u0`. The
    /// correction adds the motion of the prescribed poles and angles beyond `own`, the accelerations of eq. (4.1):
    ///
    /// ```text
    /// A += A_p + (A_s/L) J r_m      eq. (11.4)
    /// ```
    pub fn carry(
        &self,
        [u0, d]: [&[f64]; 2],
        own: &[f64],
        is_prescribed: impl Fn(usize) -> bool,
        a: &mut [f64],
    ) {
        for ((body, pole), _) in self.with_poles().zip(&self.driven).filter(|(_, d)| !**d) {
            let leading = [2 * pole, 2 * pole + 1, body.spin];
            let more = leading.map(|dof| match is_prescribed(dof) {
                true => a[dof] - own[dof],
                false => 0.0,
            });
            if more == [0.0; 3] {
                continue;
            }
            let (c, spin) = (d[body.spin] / body.length, more[2] / body.length);
            for (node, r0) in body.arms_from(pole, body.angle(u0)) {
                let j = turned(mean_arm(r0, c));
                (0..2).for_each(|i| a[2 * node + i] += more[i] + spin * j[i]);
            }
        }
    }

    /// Sets the velocities of all nodes of the bodies to the motion of their reference nodes and
    /// angles.
    pub fn start(&self, u: &[f64], v: &mut [f64]) {
        for body in self.bodies {
            let own = [v[2 * body.reference], v[2 * body.reference + 1]];
            let omega = v[body.spin] / body.length;
            for (node, r) in body.arms_from(body.reference, body.angle(u)) {
                let j = turned(r);
                (0..2).for_each(|i| v[2 * node + i] = own[i] + omega * j[i]);
            }
        }
    }

    /// Hands forces at the nodes of every body over to its pole and angle, where the forces do the same work in the
    /// increment `d` to the displacements `u1`, or act at its end. The forces of driven bodies stay at the nodes if
    /// `keeps_driven`.
    pub fn hand_over(&self, [u1, d]: [&[f64]; 2], keeps_driven: bool, force: &mut [f64]) {
        let all = self.with_poles().zip(&self.driven);
        for ((body, pole), _) in all.filter(|(_, driven)| !(keeps_driven && **driven)) {
            let c = match self.acts_at_end {
                true => 0.0,
                false => d[body.spin] / body.length,
            };
            for (node, r1) in body.arms_from(pole, body.angle(u1)) {
                let f = [0, 1].map(|i| std::mem::take(&mut force[2 * node + i]));
                (0..2).for_each(|i| force[2 * pole + i] += f[i]);
                force[body.spin] += cross(mean_arm(r1, -c), f) / body.length;
            }
        }
    }

    /// Stiffness of the angles from forces over all dofs that do not turn with the bodies, from displacements `u0` to
    /// `u`, by the dof of the angle:
    ///
    /// ```text
    /// K_ss += sum f.r_1/(L² (1 + c²/4))      eq. (11.12)
    /// ```
    pub fn geometric_stiffness(
        &self,
        [u0, u]: [&[f64]; 2],
        force: &[f64],
    ) -> impl Iterator<Item = (usize, f64)> {
        self.with_poles().map(move |(body, pole)| {
            let half = (body.angle(u) - body.angle(u0)) / 2.0;
            let arms = body.arms_from(pole, body.angle(u));
            let along = |(node, r): (usize, [f64; 2])| dot([0, 1].map(|i| force[2 * node + i]), r);
            let sum: f64 = arms.map(along).sum();
            let derivative = half.cos().powi(2) / body.length;
            (body.spin, sum / body.length * derivative)
        })
    }

    /// Changes moments M on the angles into forces on s = L c that do the work M dtheta in the increment `d`: (M/L)
    /// dtheta/c, eq. (11.6); in a static step M/L.
    pub fn scale_moments(&self, d: &[f64], force: &mut [f64]) {
        for body in self.bodies {
            let half = d[body.spin] / body.length / 2.0;
            let acts_alike = half == 0.0 || self.acts_at_end;
            let part = if acts_alike { 1.0 } else { half.atan() / half };
            force[body.spin] *= part / body.length;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of dofs of three nodes and of a body, whose centre of mass is node 3.
    const DOFS: usize = 10;

    /// A rigid body of three nodes with two masses; its first node is the reference node.
    fn body() -> Vec<TurningBody> {
        let mut model = Model::default();
        model.mesh.coordinates = vec![[0.3, -0.2], [1.5, 0.4], [-0.1, 2.2]];
        model.mesh.node_labels = vec![1, 2, 3];
        model.rigid_bodies.push(RigidBody {
            name: "B".into(),
            reference: 0,
            nodes: vec![1, 2],
            masses: vec![(1, 2.0), (2, 1.0)],
            rotary_inertia: 0.7,
            ..RigidBody::default()
        });
        TurningBody::all(&model, &Elements::new(&model))
    }

    /// Matrix T of a free pole and angle.
    fn map(turning: &Turning) -> Transformation {
        let mut leading: Vec<usize> = turning.leading().collect();
        leading.sort_unstable();
        let mut rows = vec![Vec::new(); DOFS];
        for (unknown, &dof) in leading.iter().enumerate() {
            rows[dof] = vec![(unknown, 1.0)];
        }
        for [dof, pole, angle] in turning.followers() {
            rows[dof] = [&rows[pole][..], &rows[angle]].concat();
        }
        Transformation::new(3, rows)
    }

    /// Displacements in which the body has already turned by an angle.
    fn start(turning: &Turning) -> Vec<f64> {
        let mut u = vec![0.0; DOFS];
        let leading = turning.leading().zip([0.4, -0.3, 1.1]);
        leading.for_each(|(dof, value)| u[dof] = value);
        turning.place(&mut u);
        u
    }

    #[test]
    fn mass_and_inertia_are_those_of_the_masses() {
        let body = &body()[0];
        // masses 2 and 1 at a distance of |(-1.6, 1.8)|
        let between = 1.6 * 1.6 + 1.8 * 1.8;
        assert!((body.mass - 3.0).abs() < 1e-15);
        assert!((body.inertia - (0.7 + 2.0 / 3.0 * between)).abs() < 1e-14);
        let centre = body.centre_from([0.3, -0.2]);
        assert!((centre[0] - 2.9 / 3.0).abs() < 1e-15 && (centre[1] - 1.0).abs() < 1e-15);
    }

    #[test]
    fn an_increment_is_a_rigid_motion_and_forces_do_its_work() {
        let bodies = body();
        for held in [&[][..], &[0, 1]] {
            let turning = Turning::new(&bodies, false, |dof| held.contains(&dof));
            let u0 = start(&turning);
            let mut d = vec![0.0; DOFS];
            let leading = turning.leading().zip([0.2, 0.5, -2.3]);
            leading.for_each(|(dof, value)| d[dof] = value);
            turning.follow(&u0, &mut d);
            let mut u1: Vec<f64> = u0.iter().zip(&d).map(|(u, d)| u + d).collect();
            turning.turn([&u0, &d], &mut u1);
            let mut placed = u1.clone();
            turning.place(&mut placed);
            for (u, placed) in u1.iter().zip(&placed) {
                assert!((u - placed).abs() < 1e-14, "{held:?}: {u} {placed}");
            }
            // f.d with T_m^T f on the pole and the angle
            let force: Vec<f64> = (0..DOFS).map(|i| (3.0 * i as f64).sin()).collect();
            let work = |f: &[f64]| -> f64 { f.iter().zip(&d).map(|(f, d)| f * d).sum() };
            let mut rows = map(&turning);
            turning.write_rows([&u0, &d], &mut rows);
            let mut handed = force.clone();
            turning.hand_over([&u1, &d], false, &mut handed);
            assert!((work(&force) - work(&handed)).abs() < 1e-13);
            let mut leading: Vec<usize> = turning.leading().collect();
            leading.sort_unstable();
            for (unknown, dof) in rows.restrict(&force).iter().zip(leading) {
                assert!((unknown - handed[dof]).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn an_iterate_goes_on_to_the_same_angle() {
        let bodies = body();
        let turning = Turning::new(&bodies, false, |_| false);
        let (u0, spin, l) = (start(&turning), bodies[0].spin, bodies[0].length);
        let of_angle = |angle: f64| 2.0 * l * (angle / 2.0).tan();
        for (before, more) in [(0.0, 0.7), (0.4, 0.3), (0.9, -1.3), (-0.5, 0.5)] {
            let (mut u, mut d) = (u0.clone(), vec![0.0; DOFS]);
            u[spin] += l * before;
            d[spin] = of_angle(more);
            turning.go_on([&u0, &u], &mut d);
            let whole = of_angle(before) + d[spin];
            assert!(
                (whole - of_angle(before + more)).abs() < 1e-14,
                "{before} {more}"
            );
        }
    }

    #[test]
    fn derivative_rows_are_the_derivatives_of_the_positions() {
        let bodies = body();
        let turning = Turning::new(&bodies, false, |_| false);
        let u0 = start(&turning);
        let at = |s: f64| {
            let mut d = vec![0.0; DOFS];
            d[bodies[0].spin] = s;
            turning.follow(&u0, &mut d);
            d
        };
        let mut rows = map(&turning);
        turning.write_rows([&u0, &at(1.7)], &mut rows);
        let (before, after) = (at(1.7 - 1e-6), at(1.7 + 1e-6));
        let mut change = vec![0.0; DOFS];
        rows.add(&[0.0, 0.0, 1.0], &mut change);
        for dof in 0..DOFS {
            let quotient = (after[dof] - before[dof]) / 2e-6;
            assert!(
                (change[dof] - quotient).abs() < 1e-9,
                "{dof}: {} {quotient}",
                change[dof]
            );
        }
    }

    #[test]
    fn a_dead_moment_does_the_work_of_the_angle() {
        let bodies = body();
        let turning = Turning::new(&bodies, false, |_| false);
        let (mut d, mut force) = (vec![0.0; DOFS], vec![0.0; DOFS]);
        let (spin, l) = (bodies[0].spin, bodies[0].length);
        d[spin] = l * 2.0 * (1.3_f64 / 2.0).tan();
        force[spin] = 5.0;
        turning.scale_moments(&d, &mut force);
        assert!((force[spin] * d[spin] - 5.0 * 1.3).abs() < 1e-14);
    }
}
