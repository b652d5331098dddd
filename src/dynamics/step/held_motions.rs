//! Rigid motions of static steps that only the facets of the mesh resist: held where they are. Section 12 of
//! docs/theory.md, Neutral motions.

use nalgebra::{DMatrix, DVector};

use std::collections::HashMap;

use super::pins::Pins;
use super::step_problem::StepProblem;
use crate::contact::{ClosedPair, Constraint};
use crate::dynamics::results::Unbalanced;
use crate::linear::{larger, largest};
use crate::model::Model;
use crate::vectors::{cross, difference, dot, length};

/// Largest mean slope of the normals of pairs against a motion that they let free.
const SLOPE: f64 = 0.25;
/// Part of a motion along free ones from which on it is one of them.
const ALONG: f64 = 0.7;
/// Cosine of the angle from which on a vertex is a corner of a body.
const CORNER: f64 = 0.866;

/// Motions that are held, of every body its own, in the space of its pins.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct HeldMotions(Vec<HeldBody>);

#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
struct HeldBody {
    /// Its number among those with pins.
    body: usize,
    /// Orthogonal motions of its pins, each of size 1.
    directions: Vec<DVector<f64>>,
    /// Forces at its pins.
    force: DVector<f64>,
}

/// The pairs of a body as its pins see them.
pub(super) struct Normals(pub Vec<Normal>);

/// Normal of a pair.
pub(super) struct Normal {
    /// Gn and Gt of the rigid motions that move one pin by 1 and the others not.
    pub row: DVector<f64>,
    pub tangent: DVector<f64>,
    /// Largest sine of the angle between neighbouring segments at its nodes.
    pub kink: f64,
    /// Pn
    pub force: f64,
    /// Length of the segment.
    pub scale: f64,
    pub has_friction: bool,
}

impl Normals {
    /// Orthogonal motions that pairs without friction let free.
    ///
    /// ```text
    /// sum_j (Gn_j z)² <= (1/4)² sum_j |Gn_j Z|²      eq. (12.9)
    /// ```
    fn free(&self) -> Vec<DVector<f64>> {
        let Some(first) = self.0.first() else {
            return Vec::new();
        };
        if self.0.iter().any(|normal| normal.has_friction) {
            return Vec::new();
        }
        let m = first.row.len();
        let mut all = DMatrix::zeros(m, m);
        for normal in &self.0 {
            all += &normal.row * normal.row.transpose();
        }
        let most = SLOPE * SLOPE * all.trace();
        let eigen = all.symmetric_eigen();
        let is_free = |k: &usize| eigen.eigenvalues[*k] <= most;
        let columns = (0..m).filter(is_free);
        columns
            .map(|k| eigen.eigenvectors.column(k).into_owned())
            .collect()
    }

    /// Force along a motion that facets may make, since their normals differ from those of a smooth surface by up to half
    /// the angle between neighbours.
    ///
    /// ```text
    /// f_e = sum_j Pn_j |Gt_j z| sin(beta_j)/2      eq. (12.11)
    /// ```
    fn resolution(&self, m: &DVector<f64>) -> f64 {
        let of_pair =
            |normal: &Normal| normal.force * normal.tangent.dot(m).abs() * normal.kink / 2.0;
        self.0.iter().map(of_pair).sum()
    }

    /// Stiffness against a motion that facets may make, whose normals change by the angle between neighbours in a length.
    ///
    /// ```text
    /// k_e = sum_j Pn_j (Gt_j z)² sin(beta_j)/l_j      eq. (12.12)
    /// ```
    fn stiffness(&self, m: &DVector<f64>) -> f64 {
        let of_pair = |normal: &Normal| {
            normal.force * normal.kink * normal.tangent.dot(m).powi(2) / normal.scale
        };
        self.0.iter().map(of_pair).sum()
    }
}

/// The nodes before and after every node of the contact surfaces, where these are smooth.
#[derive(Default)]
pub(super) struct Vertices(HashMap<usize, [Option<usize>; 2]>);

impl Vertices {
    /// Those of the contacts of a model.
    pub fn new(model: &Model) -> Self {
        let mut all: HashMap<usize, [Option<usize>; 2]> = HashMap::new();
        for contact in &model.contacts {
            for surface in [contact.slave, contact.master] {
                for [a, b] in model.surfaces[surface].segments(&model.mesh) {
                    all.entry(b).or_default()[0] = Some(a);
                    all.entry(a).or_default()[1] = Some(b);
                }
            }
        }
        let x = &model.mesh.coordinates;
        all.retain(|&node, [before, after]| match (before, after) {
            (Some(before), Some(after)) => {
                let (e, f) = (
                    difference(x[*before], x[node]),
                    difference(x[node], x[*after]),
                );
                dot(e, f) > CORNER * length(e) * length(f)
            }
            _ => false,
        });
        Vertices(all)
    }

    /// Sine of the angle between the segments at a node.
    pub fn kink(&self, node: usize, at: &dyn Fn(usize) -> [f64; 2]) -> f64 {
        let Some(&[Some(before), Some(after)]) = self.0.get(&node) else {
            return 0.0;
        };
        let (e, f) = (
            difference(at(before), at(node)),
            difference(at(node), at(after)),
        );
        cross(e, f).abs() / (length(e) * length(f))
    }
}

/// Part of a vector along orthogonal motions.
fn along(directions: &[DVector<f64>], vector: &DVector<f64>) -> DVector<f64> {
    let zero = DVector::zeros(vector.len());
    let parts = directions.iter().map(|m| m * m.dot(vector));
    parts.fold(zero, |sum, part| sum + part)
}

impl HeldMotions {
    /// Whether none is held.
    pub fn are_none(&self) -> bool {
        self.0.is_empty()
    }

    /// D D^T over all pins, D being the motions that are held.
    pub fn projection(&self, pins: &Pins) -> DMatrix<f64> {
        let of_bodies = pins.of_bodies();
        let m = of_bodies.last().map_or(0, |own| own.end);
        let mut all = DMatrix::zeros(m, m);
        for held in &self.0 {
            let own = of_bodies[held.body].clone();
            let size = (own.len(), own.len());
            let mut block = all.view_mut((own.start, own.start), size);
            for motion in &held.directions {
                block += motion * motion.transpose();
            }
        }
        all
    }

    /// Part of forces or motions at the pins along what is held.
    pub fn along(&self, pins: &Pins, all: &[f64]) -> Vec<f64> {
        let mut part = vec![0.0; all.len()];
        let of_bodies = pins.of_bodies();
        for held in &self.0 {
            let own = of_bodies[held.body].clone();
            let of_body = along(
                &held.directions,
                &DVector::from_column_slice(&all[own.clone()]),
            );
            part[own].copy_from_slice(of_body.as_slice());
        }
        part
    }

    /// Forces at all pins.
    pub fn forces(&self, pins: &Pins) -> Vec<f64> {
        let of_bodies = pins.of_bodies();
        let mut forces = vec![0.0; of_bodies.last().map_or(0, |range| range.end)];
        for held in &self.0 {
            forces[of_bodies[held.body].clone()].copy_from_slice(held.force.as_slice());
        }
        forces
    }

    /// Adds forces at all pins to what holds.
    pub fn add_forces(&mut self, pins: &Pins, forces: &[f64]) {
        let of_bodies = pins.of_bodies();
        for held in &mut self.0 {
            held.force += DVector::from_column_slice(&forces[of_bodies[held.body].clone()]);
        }
    }

    /// Turns what is held with the surfaces at which bodies lie; what is not free any more is let go. Whether there is any.
    pub fn follow(
        &mut self,
        pins: &Pins,
        at: &dyn Fn(usize) -> [f64; 2],
        acting: &[(&Constraint, &ClosedPair)],
    ) -> bool {
        let mut lets_go = false;
        for held in &mut self.0 {
            let free = pins.normals(held.body, at, acting).free();
            let old = std::mem::take(&mut held.directions);
            for direction in &old {
                let mut own = along(&free, direction);
                own -= along(&held.directions, &own);
                if own.norm() >= ALONG {
                    held.directions.push(own.normalize());
                }
            }
            held.force = along(&held.directions, &held.force);
            lets_go |= held.directions.len() < old.len();
        }
        self.0.retain(|held| !held.directions.is_empty());
        lets_go
    }

    /// Holds all free motions of bodies with forces at the pins that are larger than `least`; whether one is new.
    pub fn hold(
        &mut self,
        pins: &Pins,
        at: &dyn Fn(usize) -> [f64; 2],
        acting: &[(&Constraint, &ClosedPair)],
        (force, least): (&[f64], f64),
    ) -> bool {
        let mut is_new = false;
        for (body, own) in pins.of_bodies().into_iter().enumerate() {
            let directions = pins.normals(body, at, acting).free();
            if largest(&force[own.clone()]) <= least || directions.is_empty() {
                continue;
            }
            let place = self.0.iter().position(|held| held.body == body);
            let before = place.map(|place| self.0.swap_remove(place));
            let (known, force) = match before {
                Some(held) => (held.directions.len(), along(&directions, &held.force)),
                None => (0, DVector::zeros(own.len())),
            };
            is_new |= directions.len() > known;
            self.0.push(HeldBody {
                body,
                directions,
                force,
            });
        }
        is_new
    }

    /// Largest force that holds a body, beside what facets resolve.
    pub fn beside_facets(
        &self,
        pins: &Pins,
        at: &dyn Fn(usize) -> [f64; 2],
        acting: &[(&Constraint, &ClosedPair)],
    ) -> f64 {
        let part = |held: &HeldBody| {
            let force = held.force.norm();
            let normals = pins.normals(held.body, at, acting);
            let motion = match force > 0.0 {
                true => &held.force / force,
                false => return 0.0,
            };
            force / normals.resolution(&motion)
        };
        self.0.iter().map(part).fold(0.0, f64::max)
    }

    /// Largest force that holds a body, as a part of the normal forces at it.
    pub fn part(
        &self,
        pins: &Pins,
        at: &dyn Fn(usize) -> [f64; 2],
        acting: &[(&Constraint, &ClosedPair)],
    ) -> f64 {
        let part = |held: &HeldBody| {
            let normals = pins.normals(held.body, at, acting).0;
            let all: f64 = normals.iter().map(|normal| normal.force).sum();
            held.force.norm() / all
        };
        self.0.iter().map(part).fold(0.0, larger)
    }

    /// The body that is held with the largest force, with the force and the motion that it would make without.
    pub fn strongest(
        &self,
        pins: &Pins,
        problem: &StepProblem,
        u: &[f64],
    ) -> Option<Box<Unbalanced>> {
        if self.are_none() {
            return None;
        }
        let left: Vec<f64> = self.forces(pins).iter().map(|f| -f).collect();
        let mut motion = vec![0.0; u.len()];
        pins.dofs().zip(&left).for_each(|(dof, f)| motion[dof] = *f);
        pins.most_unbalanced(problem, u, &motion, &left)
    }

    /// Stiffness against motions whose stability is not asked, over the dofs of their pins: `a` of each pin where they are
    /// held, and what facets may have where they are free.
    pub fn stiffness(
        &self,
        pins: &Pins,
        a: &[f64],
        at: &dyn Fn(usize) -> [f64; 2],
        acting: &[(&Constraint, &ClosedPair)],
    ) -> Vec<(Vec<usize>, DMatrix<f64>)> {
        let dofs: Vec<usize> = pins.dofs().collect();
        let mut all = Vec::new();
        for (body, own) in pins.of_bodies().into_iter().enumerate() {
            let a = a[own.start];
            let own = &dofs[own];
            let mut add = |motion: &DVector<f64>, k: f64| {
                all.push((own.to_vec(), k * motion * motion.transpose()));
            };
            let held = self.0.iter().filter(|held| held.body == body);
            let directions = held.flat_map(|held| &held.directions);
            directions.for_each(|motion| add(motion, a));
            let normals = pins.normals(body, at, acting);
            for motion in normals.free() {
                add(&motion, normals.stiffness(&motion));
            }
        }
        all
    }
}
