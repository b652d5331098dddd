//! Contact puts no energy in where a node slides over a corner that turns concave: its force is tilted,
//! and the increment need not be halved.
//!
//! ```text
//!          /\
//!         /  \        1 Q4, its lower corner left of the roof's top; it goes to
//!         \  /        the right and down
//!     ____.\/-.____
//!     |     |     |   2 Q4, all nodes held; the top of the roof goes down and
//!     +-----+-----+   makes the corner concave
//! ```

use std::f64::consts::FRAC_PI_4;

use crate::blocks::{add_block, add_contact, fixed, model, run_to_end, step, throw};
use stickslip::dynamics::{Cause, Cutback};
use stickslip::model::{Settings, Support, SupportMotion};

#[test]
fn a_corner_that_turns_concave_under_a_node() {
    for passing_speed in [0.0, 1e9] {
        slide_over_the_roof(passing_speed);
    }
}

/// The block on the roof, and far away another that passes with some speed, whose energy must not
/// count.
fn slide_over_the_roof(passing_speed: f64) {
    let (rise, dt) = (0.005, 0.1);
    let mut model = model(1e4, 0.2, 1.0);
    let roof = add_block(&mut model, [0.0, 0.0], [2.0, 0.5], (2, 1), 0.0);
    let top = roof.node(1, 1);
    model.mesh.coordinates[top][1] += rise;
    // from the left slope, touching it, beyond the ground of the valley
    let start = [0.95, 0.5 + 0.95 * rise];
    let block = add_block(&mut model, start, [0.5, 0.5], (1, 1), FRAC_PI_4);
    let passing = add_block(&mut model, [0.0, 1e3], [0.5, 0.5], (1, 1), 0.0);
    throw(&mut model, &passing, [passing_speed, 0.0], 0.0, [0.0; 2]);
    throw(
        &mut model,
        &block,
        [0.07 / dt, -2.5 * rise / dt],
        0.0,
        [0.0; 2],
    );
    let lower = [block.faces(3), block.faces(0)].concat();
    add_contact(&mut model, lower, roof.faces(2), 0.0);
    let down = 2 * top + 1;
    let held = roof.nodes().flat_map(|n| [2 * n, 2 * n + 1]);
    let mut supports: Vec<Support> = held.filter(|&dof| dof != down).map(fixed).collect();
    let motion = SupportMotion::Ramp { to: -2.0 * rise };
    supports.push(Support { dof: down, motion });
    model.steps = vec![step(dt, 1, Settings::default(), supports)];

    let (keep, _) = run_to_end(&model);
    let adds_energy = |c: &&Cutback| matches!(c.failure.cause, Cause::GainedEnergy { .. });
    let halved = keep.cutbacks.iter().filter(adds_energy).count();
    let energies: Vec<_> = keep.reports.iter().map(|report| report.energy).collect();
    let most = energies
        .windows(2)
        .map(|e| e[1].normal_contact_work - e[0].normal_contact_work)
        .fold(f64::NEG_INFINITY, f64::max);
    let slow = block.nodes().flat_map(|n| [2 * n, 2 * n + 1]);
    let speed = slow
        .map(|dof| model.initial_velocity[dof].abs())
        .fold(0.0, f64::max);
    let part = most / (0.25 * speed * speed / 2.0);
    println!("halved {halved} times; most work in an increment {part:.1e}");
    assert!(halved == 0 && part < 1e-10, "{halved} {part:e}");
}
