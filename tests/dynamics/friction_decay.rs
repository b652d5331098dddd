//! Friction that falls with the slip rate: a sliding block against the closed form, and Coulomb's law
//! with the coefficient of the slip rate at every node.

use stickslip::dynamics::IncrementReport;
use stickslip::model::{Friction, Interaction, Model};

use crate::blocks::{Block, SCHEMES, run_to_end, throw};
use crate::friction::block_on_base;

const GRAVITY: f64 = 10.0;
const SPEED: f64 = 1.0;
const FRICTION: Friction = Friction {
    at_rest: 0.3,
    sliding: 0.1,
    decay: 2.0,
};

/// The block of [`block_on_base`] thrown along the base.
fn thrown(scheme: stickslip::model::Scheme) -> (Model, Block) {
    let (mut model, block) = block_on_base(0.0, [0.0, -1.0], scheme);
    model.contacts[0].interaction = Interaction { friction: FRICTION };
    throw(&mut model, &block, [SPEED, 0.0], 0.0, [0.0, 0.0]);
    (model, block)
}

/// Velocity of a rigid block: dv/dt = -mu(v) g(t), g growing over 0.2, with s = int g dt/g
///
/// ```text
/// mu_k exp(d v) + mu_s - mu_k = (mu_k exp(d v0) + mu_s - mu_k) exp(-mu_k d g s)
/// ```
fn speed_at(t: f64) -> f64 {
    let Friction {
        at_rest,
        sliding,
        decay,
    } = FRICTION;
    let s = if t < 0.2 { t * t / 0.4 } else { t - 0.1 };
    let fall = at_rest - sliding;
    let start = sliding * (decay * SPEED).exp() + fall;
    let now = start * (-sliding * decay * GRAVITY * s).exp();
    ((now - fall) / sliding).max(1.0).ln() / decay
}

/// Velocity of the block's centre of mass along x: all that moves has the mass 2.
fn speed(report: &IncrementReport) -> f64 {
    report.momentum.linear[0] / 2.0
}

#[test]
fn a_block_slows_down_as_the_closed_form_says() {
    for scheme in SCHEMES {
        let (model, _) = thrown(scheme);
        let (keep, _) = run_to_end(&model);
        let error = |report: &&IncrementReport| (speed(report) - speed_at(report.time)).abs();
        let sliding = keep.reports.iter().filter(|report| report.time < 0.6);
        let largest = sliding.map(|report| error(&report)).fold(0.0, f64::max);
        println!("{scheme:?}: largest error of the speed {largest:.2e}");
        assert!(largest < 0.01 * SPEED);
        let last = keep.reports.last().expect("reports");
        assert!(last.contacts[0].sticking > 0, "it rests");
    }
}

#[test]
fn every_node_has_the_friction_of_its_own_slip_rate() {
    for scheme in SCHEMES {
        let (model, block) = thrown(scheme);
        let (keep, _) = run_to_end(&model);
        let mut checked = 0;
        for pair in keep.reports.windows(2) {
            let [before, now] = [&pair[0], &pair[1]];
            let most = (0..=block.nx).map(|i| now.nodal.contact_force[2 * block.node(i, 0) + 1]);
            let most = most.fold(0.0, f64::max);
            for node in (0..=block.nx).map(|i| block.node(i, 0)) {
                let x = 2 * node;
                let [pt, pn] = [0, 1].map(|i| now.nodal.contact_force[x + i]);
                let rate = (now.state.u[x] - before.state.u[x]) / now.dt;
                if rate.abs() < 1e-3 * SPEED || pn <= 0.0 {
                    continue;
                }
                let coulomb = -rate.signum() * FRICTION.at(rate) * pn;
                assert!(
                    (pt - coulomb).abs() < 1e-9 * most,
                    "{scheme:?} {}: {pt} {coulomb}",
                    now.time
                );
                checked += 1;
            }
        }
        assert!(checked > 1000, "{checked}");
    }
}
