//! Coulomb friction against closed forms.

use stickslip::model::{
    Amplitude, BodyForce, Curve, Load, Model, Scheme, Settings, TimeBase, Variation,
};

use crate::blocks::{
    Block, SCHEMES, add_block, add_contact, fixed, model, run_to_end, step, throw,
};

const GRAVITY: f64 = 10.0;

/// A flat block of mass 2 lying on a long, fixed base; gravity along `direction`, growing over 0.2:
/// applied at once it would let the block ring and its contact force vanish now and then.
pub fn block_on_base(friction: f64, direction: [f64; 2], scheme: Scheme) -> (Model, Block) {
    let mut model = model(1e5, 0.0, 1.0);
    let base = add_block(&mut model, [-1.0, -1.0], [8.0, 1.0], (8, 1), 0.0);
    let block = add_block(&mut model, [0.0, 0.0], [4.0, 0.5], (8, 1), 0.0);
    add_contact(&mut model, block.faces(0), base.faces(2), friction);
    let supports = base
        .nodes()
        .flat_map(|n| [fixed(2 * n), fixed(2 * n + 1)])
        .collect();
    let points = vec![(0.0, 0.0), (0.2, 1.0)];
    model.amplitudes = vec![Amplitude {
        name: "GROW".into(),
        time: TimeBase::Step,
        curve: Curve::Linear(points),
    }];
    let mut step = step(
        0.002,
        500,
        Settings {
            scheme,
            ..Settings::default()
        },
        supports,
    );
    let weight = |element| Load {
        at: BodyForce {
            element,
            direction,
            per_mass: true,
        },
        magnitude: GRAVITY,
        variation: Variation::Amplitude(0),
    };
    step.body_forces = (block.first_element..block.first_element + 8)
        .map(weight)
        .collect();
    model.steps = vec![step];
    (model, block)
}

/// Mean displacement of a block along x.
fn travel(u: &[f64], block: &Block) -> f64 {
    block.nodes().map(|n| u[2 * n]).sum::<f64>() / block.nodes().len() as f64
}

#[test]
fn a_sliding_block_stops_where_friction_has_taken_its_energy() {
    let (friction, speed) = (0.3, 2.0);
    for scheme in SCHEMES {
        let (mut model, block) = block_on_base(friction, [0.0, -1.0], scheme);
        throw(&mut model, &block, [speed, 0.0], 0.0, [0.0, 0.0]);
        let (keep, _) = run_to_end(&model);
        let last = keep.reports.last().unwrap();
        let distance = travel(&last.state.u, &block);
        // speed 2 - mu g t²/0.4 until t = 0.2, then a steady stop
        let (at_full, ramp) = (speed - friction * GRAVITY * 0.1, 0.2);
        let sliding = speed * ramp - friction * GRAVITY * ramp * ramp / 6.0;
        let expected = sliding + at_full * at_full / (2.0 * friction * GRAVITY);
        let heat = last.energy.friction_dissipation;
        let impact = last.energy.impact_loss;
        println!("{scheme:?}: {distance:.5} of {expected:.5}, heat {heat:.4}, impact {impact:.4}");
        assert!((distance / expected - 1.0).abs() < 0.01);
        // m v0²/2 = 4 goes into friction, of which the part of the impulses counts as impact loss
        assert!(((heat + impact) / 4.0 - 1.0).abs() < 0.01);
        assert!(last.contacts[0].sticking > 0, "it rests");
    }
}

#[test]
fn on_an_incline_it_sticks_if_mu_exceeds_the_slope() {
    let slope: f64 = 20.0_f64.to_radians();
    let down = [slope.sin(), -slope.cos()];
    for scheme in SCHEMES {
        let (sticking, block) = block_on_base(0.5, down, scheme);
        let (keep, _) = run_to_end(&sticking);
        let moved = travel(&keep.reports.last().unwrap().state.u, &block);
        let (sliding, block) = block_on_base(0.2, down, scheme);
        let (keep, _) = run_to_end(&sliding);
        let last = keep.reports.last().unwrap();
        // a = g (sin - mu cos): a t²/6 and a t/2 at the end of the ramp, then a t²/2
        let a = GRAVITY * (slope.sin() - 0.2 * slope.cos());
        let rest = last.time - 0.2;
        let expected = a * (0.04 / 6.0 + 0.1 * rest + rest * rest / 2.0);
        let slid = travel(&last.state.u, &block);
        println!("{scheme:?}: stuck {moved:.2e}, slid {slid:.4} of {expected:.4}");
        assert!(moved.abs() < 1e-3, "it sticks but for the settling");
        assert!((slid / expected - 1.0).abs() < 0.01);
    }
}
