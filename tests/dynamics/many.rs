//! Many bodies: nine blocks in a box, 144 contacts, no node inside another body.

use crate::blocks::{Block, Keep, add_block, add_contact, fixed, model, run_to_end, step, throw};
use stickslip::dynamics::{Cause, Cutback};
use stickslip::model::{Face, Model, Scheme, Settings};

const BLOCKS: usize = 9;
/// Length of an element of the blocks.
const SIZE: f64 = 0.8 / 3.0;

/// Numbers in [0, 1).
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut bits = seed;
    move || {
        bits = bits
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (bits >> 33) as f64 / (1_u64 << 31) as f64
    }
}

fn around(block: &Block) -> Vec<Face> {
    (0..4).flat_map(|side| block.faces(side)).collect()
}

fn scene(scheme: Scheme, seed: u64) -> Model {
    let mut random = numbers(seed);
    let mut model = model(2e3, 0.3, 1.0);
    // the blocks, then the four walls
    let mut bodies = Vec::new();
    for i in 0..BLOCKS {
        let origin = [i % 3, i / 3].map(|k| 1.6 * k as f64 + 0.4);
        let angle = 0.5 * random();
        bodies.push(add_block(&mut model, origin, [0.8; 2], (3, 3), angle));
    }
    let walls = [
        ([-1.0, -1.0], [7.0, 0.8], (9, 1)),
        ([-1.0, 5.6], [7.0, 0.8], (9, 1)),
        ([-1.0, -0.1], [0.8, 5.6], (1, 7)),
        ([5.4, -0.1], [0.8, 5.6], (1, 7)),
    ];
    for (origin, size, cells) in walls {
        bodies.push(add_block(&mut model, origin, size, cells, 0.0));
    }
    for block in &bodies[..BLOCKS] {
        let centre = model.mesh.coordinates[block.first_node];
        let v = [(); 2].map(|()| 6.0 * (random() - 0.5));
        throw(&mut model, block, v, 2.0 * (random() - 0.5), centre);
    }
    for (i, block) in bodies[..BLOCKS].iter().enumerate() {
        for (j, other) in bodies.iter().enumerate() {
            if i != j {
                add_contact(&mut model, around(block), around(other), 0.2);
            }
            if j >= BLOCKS {
                add_contact(&mut model, around(other), around(block), 0.2);
            }
        }
    }
    let walls = bodies[BLOCKS..].iter().flat_map(Block::nodes);
    let supports = walls.flat_map(|n| [2 * n, 2 * n + 1]).map(fixed).collect();
    let settings = Settings {
        scheme,
        ..Settings::default()
    };
    model.steps = vec![step(0.05, 80, settings, supports)];
    model
}

/// Depth of a point in the polygon of some segments with the body on their left; 0 outside.
fn depth(s: [f64; 2], segments: &[[[f64; 2]; 2]]) -> f64 {
    let mut turns = 0;
    let mut nearest = f64::INFINITY;
    for [a, b] in segments {
        let (r, e) = ([s[0] - a[0], s[1] - a[1]], [b[0] - a[0], b[1] - a[1]]);
        let is_left = e[0] * r[1] - e[1] * r[0] > 0.0;
        turns += i32::from(a[1] <= s[1] && s[1] < b[1] && is_left);
        turns -= i32::from(b[1] <= s[1] && s[1] < a[1] && !is_left);
        let xi = (r[0] * e[0] + r[1] * e[1]) / (e[0] * e[0] + e[1] * e[1]);
        let xi = xi.clamp(0.0, 1.0);
        nearest = nearest.min((r[0] - xi * e[0]).hypot(r[1] - xi * e[1]));
    }
    if turns == 0 { 0.0 } else { nearest }
}

/// Depth of the deepest node of any body in any other, over all reports.
fn deepest(model: &Model, keep: &Keep) -> f64 {
    let mut deepest: f64 = 0.0;
    for report in &keep.reports {
        let at = |n: usize| {
            let (x, u) = (model.mesh.coordinates[n], &report.state.u);
            [x[0] + u[2 * n], x[1] + u[2 * n + 1]]
        };
        for contact in &model.contacts {
            let segments = model.surfaces[contact.master].segments(&model.mesh);
            let segments: Vec<_> = segments.iter().map(|ends| ends.map(at)).collect();
            for slave in model.surfaces[contact.slave].nodes(&model.mesh) {
                deepest = deepest.max(depth(at(slave), &segments));
            }
        }
    }
    deepest
}

#[test]
fn no_block_in_a_box_goes_into_another() {
    let paper = Scheme::Ss22 {
        theta1: 1.0,
        theta2: 1.0,
    };
    for (scheme, seed) in [(paper, 2), (Scheme::EnergyMomentum, 1)] {
        let model = scene(scheme, seed);
        let (keep, summary) = run_to_end(&model);
        let deepest = deepest(&model, &keep);
        let crossed = |c: &&Cutback| matches!(c.failure.cause, Cause::Crossed { .. });
        println!(
            "{scheme:?}: deepest {:.1e} elements, {} cutbacks, {} for crossings",
            deepest / SIZE,
            summary.cutbacks,
            keep.cutbacks.iter().filter(crossed).count(),
        );
        let closed = |r: &stickslip::dynamics::IncrementReport| {
            r.contacts.iter().filter(|c| c.closed > 0).count()
        };
        assert!(keep.reports.iter().map(closed).sum::<usize>() > 20);
        assert!(deepest < 1e-9 * SIZE, "{deepest:e}");
    }
}
