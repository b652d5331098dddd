//! Rigid motions of static steps that only the facets of the mesh resist; the bodies are held in place along these
//! motions. See docs/theory/bodies.md, Neutral motions.

use nalgebra::{DMatrix, DVector};

use super::pins::{PinMotions, Pins};
use super::step_problem::StepProblem;
use crate::contact::{ClosedPair, Constraint};
use crate::dynamics::results::Unbalanced;
use crate::linear::{larger, largest};

/// Size of the part of a held motion along free motions from which on the held motion counts as free.
const ALONG: f64 = 0.7;

/// Held motions of every body.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct HeldMotions(Vec<HeldBody>);

#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
struct HeldBody {
    /// Number of the body among the bodies with pins.
    body: usize,
    directions: Vec<HeldDirection>,
    /// Resultant of the forces that hold a body, along the free rigid motions of the body.
    force: DVector<f64>,
}

/// A rigid motion that is held; the held motions of a body are orthogonal and of size 1.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
struct HeldDirection {
    /// Components D of the held motion in the free rigid motions of the body.
    rigid: DVector<f64>,
    /// Motions Z_p D of the pins in the held motion.
    motion: DVector<f64>,
    /// Forces Z_p^-T D at the pins, whose resultant is D.
    force: DVector<f64>,
}

/// Component of a vector along orthogonal motions.
fn along(directions: &[DVector<f64>], vector: &DVector<f64>) -> DVector<f64> {
    let zero = DVector::zeros(vector.len());
    let parts = directions.iter().map(|m| m * m.dot(vector));
    parts.fold(zero, |sum, part| sum + part)
}

impl HeldBody {
    /// A body that is held along orthogonal rigid motions; the holding force is the component of
    /// `force` along them.
    fn new(body: usize, pins: &PinMotions, rigid: Vec<DVector<f64>>, force: &DVector<f64>) -> Self {
        let force = along(&rigid, force);
        let seen = |rigid: DVector<f64>| HeldDirection {
            motion: pins.motions(&rigid),
            force: pins.forces(&rigid),
            rigid,
        };
        HeldBody {
            body,
            directions: rigid.into_iter().map(seen).collect(),
            force,
        }
    }

    fn rigid(&self) -> Vec<DVector<f64>> {
        let all = self.directions.iter();
        all.map(|direction| direction.rigid.clone()).collect()
    }
}

impl HeldMotions {
    /// Whether no motion is held.
    pub fn are_none(&self) -> bool {
        self.0.is_empty()
    }

    /// The projection P of eq. (12.11), over all pins, of their motions on the held part.
    pub fn projection(&self, pins: &Pins) -> DMatrix<f64> {
        let of_bodies = pins.of_bodies();
        let m = of_bodies.last().map_or(0, |own| own.end);
        let mut all = DMatrix::zeros(m, m);
        for held in &self.0 {
            let own = of_bodies[held.body].clone();
            let size = (own.len(), own.len());
            let mut block = all.view_mut((own.start, own.start), size);
            for HeldDirection { motion, force, .. } in &held.directions {
                block += motion * force.transpose();
            }
        }
        all
    }

    /// Forces at all pins that hold the motions.
    pub fn forces(&self, pins: &Pins) -> Vec<f64> {
        let of_bodies = pins.of_bodies();
        let mut forces = DVector::zeros(of_bodies.last().map_or(0, |range| range.end));
        for held in &self.0 {
            let own = of_bodies[held.body].clone();
            let mut of_body = forces.rows_mut(own.start, own.len());
            for HeldDirection { rigid, force, .. } in &held.directions {
                of_body += force * rigid.dot(&held.force);
            }
        }
        forces.as_slice().to_vec()
    }

    /// Adds forces at all pins to the forces that hold the motions.
    pub fn add_forces(&mut self, pins: &Pins, forces: &[f64]) {
        let of_bodies = pins.of_bodies();
        for held in &mut self.0 {
            let own = DVector::from_column_slice(&forces[of_bodies[held.body].clone()]);
            for HeldDirection { rigid, motion, .. } in &held.directions {
                held.force += rigid * motion.dot(&own);
            }
        }
    }

    /// Turns the held motions with the surfaces at which the bodies lie, and releases motions that are not free any
    /// more. Returns whether any motion is released.
    pub fn follow(
        &mut self,
        pins: &Pins,
        at: &dyn Fn(usize) -> [f64; 2],
        acting: &[(&Constraint, &ClosedPair)],
    ) -> bool {
        let mut lets_go = false;
        let mut all = Vec::new();
        for held in std::mem::take(&mut self.0) {
            let free = pins.normals(held.body, at, acting).free();
            let mut rigid: Vec<DVector<f64>> = Vec::new();
            for direction in held.rigid() {
                let mut own = along(&free, &direction);
                own -= along(&rigid, &own);
                if own.norm() >= ALONG {
                    rigid.push(own.normalize());
                }
            }
            lets_go |= rigid.len() < held.directions.len();
            if !rigid.is_empty()
                && let Some(motions) = pins.motions(held.body, at)
            {
                all.push(HeldBody::new(held.body, &motions, rigid, &held.force));
            }
        }
        self.0 = all;
        lets_go
    }

    /// Holds all free motions of bodies with forces above `least` at their pins; returns whether a motion is new.
    pub fn hold(
        &mut self,
        pins: &Pins,
        at: &dyn Fn(usize) -> [f64; 2],
        acting: &[(&Constraint, &ClosedPair)],
        (force, least): (&[f64], f64),
    ) -> bool {
        let mut is_new = false;
        for (body, own) in pins.of_bodies().into_iter().enumerate() {
            let rigid = pins.normals(body, at, acting).free();
            if largest(&force[own.clone()]) <= least || rigid.is_empty() {
                continue;
            }
            let Some(motions) = pins.motions(body, at) else {
                continue;
            };
            let place = self.0.iter().position(|held| held.body == body);
            let before = place.map(|place| self.0.swap_remove(place));
            let (known, force) = match before {
                Some(held) => (held.directions.len(), held.force),
                None => (0, DVector::zeros(own.len())),
            };
            is_new |= rigid.len() > known;
            self.0.push(HeldBody::new(body, &motions, rigid, &force));
        }
        is_new
    }

    /// Largest ratio, over the held bodies, of the force of the pins to the force that facets and errors can explain.
    /// The errors are `tolerance` times the normal forces, plus the force `noise`.
    pub fn beside_facets(
        &self,
        pins: &Pins,
        at: &dyn Fn(usize) -> [f64; 2],
        acting: &[(&Constraint, &ClosedPair)],
        [tolerance, noise]: [f64; 2],
    ) -> f64 {
        let part = |held: &HeldBody| {
            let force = held.force.norm();
            let normals = pins.normals(held.body, at, acting);
            let motion = match force > 0.0 {
                true => &held.force / force,
                false => return 0.0,
            };
            force / (normals.resolution(&motion) + tolerance * normals.force() + noise)
        };
        self.0.iter().map(part).fold(0.0, f64::max)
    }

    /// Largest force that holds a body, relative to the normal forces on the body.
    pub fn part(
        &self,
        pins: &Pins,
        at: &dyn Fn(usize) -> [f64; 2],
        acting: &[(&Constraint, &ClosedPair)],
    ) -> f64 {
        let part =
            |held: &HeldBody| held.force.norm() / pins.normals(held.body, at, acting).force();
        self.0.iter().map(part).fold(0.0, larger)
    }

    /// The body with the largest holding force, with this force and the motion that the body would make without this
    /// force.
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

    /// Stiffness against motions whose stability is not demanded, over the dofs of their pins: the stiffness `a` of the
    /// pins against held motions, and the stiffness that facets may have against free motions.
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
            let mut add = |force: &DVector<f64>, k: f64| {
                all.push((own.to_vec(), k * force * force.transpose()));
            };
            let held = self.0.iter().filter(|held| held.body == body);
            let directions = held.flat_map(|held| &held.directions);
            directions.for_each(|direction| add(&direction.force, a));
            let Some(motions) = pins.motions(body, at) else {
                continue;
            };
            let normals = pins.normals(body, at, acting);
            for motion in normals.free() {
                add(&motions.forces(&motion), normals.stiffness(&motion));
            }
        }
        all
    }
}
