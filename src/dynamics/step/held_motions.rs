//! Rigid motions of static steps that only the facets of the mesh resist: held where they are. Section 12 of
//! docs/theory.md, Neutral motions.

use nalgebra::{DMatrix, DVector};

use super::pins::Pins;
use super::step_problem::StepProblem;
use crate::contact::{ClosedPair, Constraint};
use crate::dynamics::results::Unbalanced;
use crate::linear::{larger, largest};

/// Part of a motion along free ones from which on it is one of them.
const ALONG: f64 = 0.7;

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
