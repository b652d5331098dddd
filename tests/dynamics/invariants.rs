//! Energy and momentum of free bodies, with and without contact.

use crate::blocks::{Keep, add_block, add_contact, model, run_to_end, step, stretch, throw};
use crate::energies::energy;
use stickslip::model::{Model, Scheme, Settings};

/// Largest change of energy and of the momenta, relative to their scales.
pub fn drift(keep: &Keep) -> [f64; 3] {
    let first = &keep.reports[0];
    let speed = (2.0 * energy(first)).sqrt();
    keep.reports.iter().fold([0.0; 3], |worst, r| {
        let linear = (0..2)
            .map(|i| (r.momentum.linear[i] - first.momentum.linear[i]).abs())
            .fold(0.0, f64::max);
        let angular = (r.momentum.angular - first.momentum.angular).abs();
        let now = [
            (energy(r) - energy(first)).abs() / energy(first),
            linear / speed,
            angular / speed,
        ];
        std::array::from_fn(|i| worst[i].max(now[i]))
    })
}

/// A spinning, flying bar, stretched at the start so that it vibrates.
fn spinning_bar(settings: Settings) -> Model {
    let mut model = model(1e4, 0.3, 1.0);
    let bar = add_block(&mut model, [0.0, 0.0], [10.0, 1.0], (20, 2), 0.0);
    throw(&mut model, &bar, [1.0, 2.0], 1.0, [5.0, 0.5]);
    stretch(&mut model, &bar, 0.5, 5.0);
    model.steps = vec![step(0.02, 300, settings, Vec::new())];
    model
}

#[test]
fn a_free_spinning_bar_keeps_energy_and_both_momenta() {
    let (keep, summary) = run_to_end(&spinning_bar(Settings::default()));
    let [energy, linear, angular] = drift(&keep);
    println!("energy {energy:.1e} linear {linear:.1e} angular {angular:.1e} {summary:?}");
    assert!(energy < 1e-10 && linear < 1e-10 && angular < 1e-10);
    let first = &keep.reports[0].momentum;
    assert!((first.linear[0] - 10.0).abs() < 1e-12 && (first.linear[1] - 20.0).abs() < 1e-12);
}

#[test]
fn the_plain_mid_point_rule_does_not_keep_energy() {
    let scheme = Scheme::Ss22 {
        theta1: 0.5,
        theta2: 0.5,
    };
    let (keep, _) = run_to_end(&spinning_bar(Settings {
        scheme,
        ..Settings::default()
    }));
    let [energy, linear, _] = drift(&keep);
    println!("energy {energy:.1e}");
    assert!(energy > 1e-5 && linear < 1e-10);
    let balance = keep
        .reports
        .iter()
        .map(|r| r.energy.balance.abs())
        .fold(0.0, f64::max);
    assert!(balance < 1e-8 * keep.reports[0].energy.kinetic);
}

/// Two elastic beams thrown at each other obliquely.
pub fn oblique_impact(friction: f64, scheme: Scheme) -> Model {
    let mut model = model(1e3, 0.3, 1.0);
    let lower = add_block(&mut model, [0.0, 0.0], [4.0, 0.8], (16, 3), 0.0);
    let upper = add_block(&mut model, [0.7, 1.0], [3.0, 0.8], (10, 3), 0.1);
    throw(&mut model, &lower, [0.3, 0.5], 0.05, [2.0, 0.4]);
    throw(&mut model, &upper, [-0.8, -1.5], -0.2, [2.2, 1.5]);
    add_contact(&mut model, upper.faces(0), lower.faces(2), friction);
    let settings = Settings {
        scheme,
        ..Settings::default()
    };
    model.steps = vec![step(0.005, 300, settings, Vec::new())];
    model
}

#[test]
pub fn oblique_impact_keeps_both_momenta() {
    for friction in [0.0, 0.3] {
        let (keep, summary) = run_to_end(&oblique_impact(friction, Scheme::EnergyMomentum));
        let [_, linear, angular] = drift(&keep);
        let touched = keep
            .reports
            .iter()
            .map(|r| r.contacts[0].closed)
            .max()
            .unwrap();
        let start = keep.reports[0].energy.kinetic;
        let last = keep.reports.last().unwrap();
        println!(
            "mu {friction}: linear {linear:.1e} angular {angular:.1e} closed {touched} {:?} {summary:?}",
            last.energy
        );
        assert!(touched > 2, "they touch");
        assert!(linear < 1e-10 && angular < 1e-10);
        for pair in keep.reports.windows(2) {
            let [before, after] = [0, 1].map(|i| pair[i].energy.kinetic + pair[i].energy.strain);
            assert!(
                after - before < 1e-9 * start,
                "t {}: {:e}",
                pair[1].time,
                after - before
            );
        }
        assert!(last.energy.friction_dissipation >= 0.0);
        assert!(last.energy.balance.abs() < 1e-8 * start);
    }
}

/// Positions at which the contact forces of an increment act: half way with energy-momentum
/// contact, at the end with SS22.
fn acting(model: &Model, scheme: Scheme, [before, after]: [&[f64]; 2], node: usize) -> [f64; 2] {
    let x = model.mesh.coordinates[node];
    let u = |i: usize| match scheme {
        Scheme::EnergyMomentum => (before[2 * node + i] + after[2 * node + i]) / 2.0,
        Scheme::Ss22 { .. } => after[2 * node + i],
    };
    [x[0] + u(0), x[1] + u(1)]
}

#[test]
fn forces_of_opposite_sides_balance_in_force_and_moment() {
    let paper = Scheme::Ss22 {
        theta1: 1.0,
        theta2: 1.0,
    };
    for scheme in [Scheme::EnergyMomentum, paper] {
        let model = oblique_impact(0.3, scheme);
        let (keep, _) = run_to_end(&model);
        let (mut force_worst, mut moment_worst, mut touching) = (0.0_f64, 0.0_f64, 0);
        for pair in keep.reports.windows(2) {
            let (mut sum, mut size, mut moment, mut arm) = ([0.0; 2], 0.0, 0.0, 0.0);
            let force = &pair[1].nodal.contact_force;
            for node in 0..model.mesh.node_count() {
                let [fx, fy] = [force[2 * node], force[2 * node + 1]];
                let u = [0, 1].map(|i| pair[i].state.u.as_slice());
                let [x, y] = acting(&model, scheme, u, node);
                sum = [sum[0] + fx, sum[1] + fy];
                size += fx.hypot(fy);
                moment += x * fy - y * fx;
                arm += fx.hypot(fy) * x.hypot(y);
            }
            if size > 0.0 {
                touching += 1;
                force_worst = force_worst.max(sum[0].hypot(sum[1]) / size);
                moment_worst = moment_worst.max(moment.abs() / arm);
            }
        }
        println!("{scheme:?}: force {force_worst:.1e} moment {moment_worst:.1e} in {touching}");
        assert!(touching > 10 && force_worst < 1e-14 && moment_worst < 1e-12);
    }
}
