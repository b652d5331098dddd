//! Elastic bar on a fixed wall: wall force rho c v0 over the contact time 2L/c.
//!
//! ```text
//!        |                 v0 = 0.03
//!   wall | g = 0.0015  [=================] 10 x 1, 50 Q4, E = 1000, nu = 0, rho = 1
//!        |               y fixed
//! ```

use crate::blocks::{PAPER, add_block, add_contact, fixed, model, run_to_end, step, throw};
use stickslip::dynamics::IncrementReport;
use stickslip::model::{Impact, Model, Scheme, Settings};

const SPEED: f64 = 0.03;
const GAP: f64 = 0.0015;

fn wave_speed() -> f64 {
    1000.0_f64.sqrt()
}

fn bar(scheme: Scheme, impact: Impact) -> Model {
    let mut model = model(1000.0, 0.0, 1.0);
    let wall = add_block(&mut model, [-0.2, -0.5], [0.2, 2.0], (1, 1), 0.0);
    let bar = add_block(&mut model, [GAP, 0.0], [10.0, 1.0], (50, 1), 0.0);
    throw(&mut model, &bar, [-SPEED, 0.0], 0.0, [0.0, 0.0]);
    add_contact(&mut model, bar.faces(3), wall.faces(1), 0.0);
    let mut supports: Vec<_> = wall
        .nodes()
        .flat_map(|n| [fixed(2 * n), fixed(2 * n + 1)])
        .collect();
    supports.extend(bar.nodes().map(|n| fixed(2 * n + 1)));
    let settings = Settings {
        scheme,
        impact,
        ..Settings::default()
    };
    let dt = 0.2 / wave_speed();
    model.steps = vec![step(dt, 140, settings, supports)];
    model
}

/// Wall force over the middle 30 to 70 % of the contact time: mean and standard deviation, relative
/// to rho c v0; and the contact time relative to 2L/c in increments.
fn figures(reports: &[IncrementReport]) -> (f64, f64, f64) {
    let expected = wave_speed() * SPEED;
    let duration = 20.0 / wave_speed();
    let start = GAP / SPEED;
    let middle: Vec<f64> = reports
        .iter()
        .filter(|r| (0.3..=0.7).contains(&((r.time - start) / duration)))
        .map(|r| r.contacts[0].normal / expected)
        .collect();
    let mean = middle.iter().sum::<f64>() / middle.len() as f64;
    let variance = middle.iter().map(|f| (f - mean).powi(2)).sum::<f64>() / middle.len() as f64;
    let dt = reports[1].dt;
    let closed: Vec<f64> = reports
        .iter()
        .filter(|r| r.contacts[0].closed > 0)
        .map(|r| r.time)
        .collect();
    let time = closed.last().unwrap() - closed[0] + dt;
    (mean, variance.sqrt() / mean, (time - duration) / dt)
}

#[test]
fn the_wall_force_is_rho_c_v0() {
    for scheme in [PAPER, Scheme::EnergyMomentum] {
        let (keep, summary) = run_to_end(&bar(scheme, Impact::Impulse));
        let (mean, deviation, time) = figures(&keep.reports);
        let last = keep.reports.last().unwrap();
        let start = keep.reports[0].energy.kinetic;
        println!(
            "{scheme:?}: mean {mean:.5} deviation {deviation:.2e} time {time:+.2} increments, \
             rebound {:.4} {summary:?}",
            last.momentum.linear[0] / -keep.reports[0].momentum.linear[0]
        );
        assert!((mean - 1.0).abs() < 0.01 && deviation < 0.01);
        assert!(
            time.abs() <= 4.0,
            "two increments and two element transit times"
        );
        assert!(last.energy.balance.abs() < 1e-8 * start);
        let gap = keep
            .reports
            .iter()
            .map(|r| r.contacts[0].min_gap)
            .fold(f64::INFINITY, f64::min);
        assert!(gap >= -1e-9 * 0.2, "{gap:e}");
    }
}

#[test]
fn without_impulses_the_wall_force_alternates() {
    for scheme in [PAPER, Scheme::EnergyMomentum] {
        let (keep, _) = run_to_end(&bar(scheme, Impact::None));
        let (mean, deviation, _) = figures(&keep.reports);
        println!("{scheme:?}: mean {mean:.3} deviation {deviation:.2}");
        assert!(deviation > 0.3);
    }
}

/// A node that closes the gap g0 in an increment starts it with the velocity V0+ = -(2/dt) g0 after
/// the impulse, so that it ends it at rest on the wall, V1 = (2/dt) d - V0+ = 0 with d = -g0. When
/// it lands in the second half it is not fast enough for an impulse: V0+ = -v0.
#[test]
fn a_node_is_at_rest_at_the_end_of_the_increment_it_lands_in() {
    let paper = Scheme::Ss22 {
        theta1: 1.0,
        theta2: 1.0,
    };
    for scheme in [paper, Scheme::EnergyMomentum] {
        for part in [0.1, 0.4, 0.9] {
            let mut model = bar(scheme, Impact::Impulse);
            // rest of the displacement in the increment of the landing
            let way = SPEED * model.steps[0].increments.dt;
            let first = model.mesh.node_count() - 2 * 51;
            for x in &mut model.mesh.coordinates[first..] {
                x[0] += 3.0 * way + part * way - GAP;
            }
            model.steps[0] = step(model.steps[0].increments.dt, 5, model.steps[0].settings, {
                std::mem::take(&mut model.steps[0].supports)
            });
            let (keep, _) = run_to_end(&model);
            let at = |k: usize| &keep.reports[k];
            assert_eq!((at(3).contacts[0].closed, at(4).contacts[0].closed), (0, 2));
            for node in [first, first + 51] {
                let [before, after] = [3, 4].map(|k| at(k).state.v[2 * node]);
                println!("{scheme:?} {part}: {before:e} -> {after:e}");
                assert!((before + SPEED).abs() < 1e-9 * SPEED);
                let expected = -SPEED * f64::max(2.0 * part - 1.0, 0.0);
                assert!((after - expected).abs() < 1e-9 * SPEED, "{after:e}");
            }
        }
    }
}
