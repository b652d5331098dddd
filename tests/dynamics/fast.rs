//! Fast bodies and thin ones: no tunnelling.
//!
//! ```text
//!          +---+
//!          |   |  2 x 2 Q4 of 0.25
//!          +---+
//!            |  many elements per increment
//!            v
//!   |==================| plate, 6 long, 24 x 1 Q4, ends fixed
//! ```

use crate::blocks::{
    Block, Keep, PAPER, add_block, add_contact, fixed, gravity, model, run_to_end, step, throw,
};
use stickslip::dynamics::{Cause, Cutback};
use stickslip::model::{Model, Scheme, Settings, SupportMotion};

/// Length of an element.
const SIZE: f64 = 0.25;

/// A block, turned by `angle`, above a plate of the given thickness.
struct Bodies {
    model: Model,
    plate: Block,
    block: Block,
}

impl Bodies {
    fn new(thickness: f64, height: f64, angle: f64) -> Self {
        let mut model = model(4e5, 0.2, 1.0);
        let plate = add_block(&mut model, [0.0, 0.0], [6.0, thickness], (24, 1), 0.0);
        let corner = [2.7, thickness + height];
        let block = add_block(&mut model, corner, [0.5, 0.5], (2, 2), angle);
        let around = |of: &Block| -> Vec<_> { (0..4).flat_map(|side| of.faces(side)).collect() };
        let (on_block, on_plate) = (around(&block), around(&plate));
        // each node is kept out of the other body
        add_contact(&mut model, on_block.clone(), on_plate.clone(), 0.1);
        add_contact(&mut model, on_plate, on_block, 0.1);
        Bodies {
            model,
            plate,
            block,
        }
    }

    fn step(&mut self, scheme: Scheme, dt: f64, count: usize) {
        let ends = [0, 24].map(|i| [self.plate.node(i, 0), self.plate.node(i, 1)]);
        let dofs = ends.concat().into_iter().flat_map(|n| [2 * n, 2 * n + 1]);
        let settings = Settings {
            scheme,
            ..Settings::default()
        };
        self.model.steps = vec![step(dt, count, settings, dofs.map(fixed).collect())];
    }

    /// Runs to the end: the bodies touch, and no node of the block goes through the plate.
    fn land(&self, what: &str) {
        let (keep, summary) = run_to_end(&self.model);
        let depth = self.depth(&keep);
        println!(
            "{what}: depth {:.1e} elements, {} increments, {} cutbacks, {} of them for crossings",
            depth / SIZE,
            summary.increments,
            summary.cutbacks,
            crossings(&keep),
        );
        assert!(touch(&keep) && depth < 1e-9 * SIZE, "{depth:e}");
    }

    /// Depth of the deepest node of the block below the upper side of the plate.
    fn depth(&self, keep: &Keep) -> f64 {
        let in_report = |u: &[f64]| {
            let at = |n: usize| {
                let x = self.model.mesh.coordinates[n];
                [x[0] + u[2 * n], x[1] + u[2 * n + 1]]
            };
            let below = |node: usize| {
                let s = at(node);
                let on_face = |i: usize| {
                    let [p, q] = [i, i + 1].map(|i| at(self.plate.node(i, 1)));
                    let part = (s[0] - p[0]) / (q[0] - p[0]);
                    let is_above = (0.0..=1.0).contains(&part);
                    is_above.then(|| p[1] + part * (q[1] - p[1]) - s[1])
                };
                // a node beside the plate is not below it
                (0..24).find_map(on_face).unwrap_or(f64::NEG_INFINITY)
            };
            self.block.nodes().map(below).fold(0.0, f64::max)
        };
        let reports = keep.reports.iter().map(|r| in_report(&r.state.u));
        reports.fold(0.0, f64::max)
    }
}

fn crossings(keep: &Keep) -> usize {
    let crossed = |c: &&Cutback| matches!(c.failure.cause, Cause::Crossed { .. });
    keep.cutbacks.iter().filter(crossed).count()
}

fn touch(keep: &Keep) -> bool {
    let closed = |c: &stickslip::dynamics::ContactResultant| c.closed > 0;
    keep.reports.iter().any(|r| r.contacts.iter().any(closed))
}

#[test]
fn a_fast_bullet_does_not_go_through_a_thin_plate() {
    let speed = 12.0;
    for scheme in [PAPER, Scheme::EnergyMomentum] {
        for elements in [0.5, 3.3, 7.0, 11.3] {
            for angle in [0.0, 0.3, 0.8] {
                let mut bodies = Bodies::new(0.25, 2.85, angle);
                let Bodies { model, block, .. } = &mut bodies;
                throw(model, block, [0.0, -speed], 0.0, [0.0; 2]);
                let dt = elements * SIZE / speed;
                bodies.step(scheme, dt, (8.0 / (speed * dt)).ceil() as usize);
                bodies.land(&format!("{scheme:?} {elements} {angle}"));
            }
        }
    }
}

#[test]
fn a_body_that_gathers_speed_in_an_increment_does_not_go_through_a_thin_plate() {
    let (thickness, dt) = (0.05, 0.25);
    for scheme in [PAPER, Scheme::EnergyMomentum] {
        for elements in [12.0, 20.0] {
            // at rest 9 elements above the plate, it goes g dt²/2 in the first increment
            let mut bodies = Bodies::new(thickness, 9.0 * SIZE, 0.3);
            bodies.step(scheme, dt, 2);
            let first = bodies.block.first_element;
            let pull = |element| gravity(element, 2.0 * elements * SIZE / (dt * dt));
            bodies.model.steps[0].body_forces = (first..first + 4).map(pull).collect();
            bodies.land(&format!("{scheme:?} {elements}"));
        }
    }
}

#[test]
fn a_body_whose_nodes_are_far_in_the_passes_lands_in_its_first_increment() {
    let dt = 0.01;
    for scheme in [PAPER, Scheme::EnergyMomentum] {
        // at rest 0.3 elements above the plate, it would go 0.4 elements in the first increment
        let mut bodies = Bodies::new(0.25, 0.3 * SIZE, 0.0);
        bodies.step(scheme, dt, 1);
        let first = bodies.block.first_element;
        let pull = |element| gravity(element, 2.0 * 0.4 * SIZE / (dt * dt));
        bodies.model.steps[0].body_forces = (first..first + 4).map(pull).collect();
        let (keep, summary) = run_to_end(&bodies.model);
        let depth = bodies.depth(&keep);
        assert!(touch(&keep) && depth < 1e-9 * SIZE, "{scheme:?} {depth:e}");
        assert_eq!(summary.cutbacks, 0, "{scheme:?}");
    }
}

#[test]
fn a_bullet_meets_the_same_forces_in_every_frame() {
    let (dt, count) = (0.02, 12);
    for scheme in [PAPER, Scheme::EnergyMomentum] {
        // forces in every increment, seen from a frame that moves with -w
        let seen = |w: [f64; 2]| -> Vec<[f64; 2]> {
            let mut bodies = Bodies::new(0.25, 0.4, 0.3);
            let Bodies {
                model,
                plate,
                block,
            } = &mut bodies;
            throw(model, plate, w, 0.0, [0.0; 2]);
            throw(model, block, [w[0], w[1] - 40.0], 0.0, [0.0; 2]);
            bodies.step(scheme, dt, count);
            for support in &mut bodies.model.steps[0].supports {
                let to = w[support.dof % 2] * dt * count as f64;
                support.motion = SupportMotion::Ramp { to };
            }
            let (keep, _) = run_to_end(&bodies.model);
            keep.reports.iter().map(|r| r.contacts[0].force).collect()
        };
        let at_rest = seen([0.0; 2]);
        let largest = (at_rest.iter()).fold(0.0, |all: f64, f| all.max(f[0].hypot(f[1])));
        assert!(largest > 0.0, "it hits the plate");
        for w in (1..=20).map(|i| [0.6 * f64::from(i), -0.8 * f64::from(i)]) {
            for (force, own) in at_rest.iter().zip(seen(w)) {
                let difference = (force[0] - own[0]).hypot(force[1] - own[1]);
                let is_same = difference < 1e-7 * largest;
                assert!(is_same, "{scheme:?} {w:?}: {own:?} in place of {force:?}");
            }
        }
    }
}
