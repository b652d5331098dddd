//! Quasi-static steps: `*DYNAMIC, APPLICATION=QUASI-STATIC`.

use stickslip::dynamics::IncrementReport;
use stickslip::model::{
    Incrementation, Increments, Load, Model, PointLoad, Procedure, Settings, Variation,
};

use crate::blocks::{Keep, add_block, add_contact, fixed, gravity, model, run_to_end, step};

/// A cantilever of E = 1000, length 10 and height 1 with a force at its tip, `count` increments of `dt`.
fn cantilever(procedure: Procedure, dt: f64, count: usize, variation: Variation) -> Model {
    let mut model = model(1000.0, 0.0, 1.0);
    let beam = add_block(&mut model, [0.0; 2], [10.0, 1.0], (20, 2), 0.0);
    let held = (0..=2).flat_map(|j| [0, 1].map(|i| fixed(2 * beam.node(0, j) + i)));
    let mut step = step(dt, count, Settings::default(), held.collect());
    step.procedure = procedure;
    step.point_loads = vec![Load {
        at: PointLoad {
            dof: 2 * beam.node(20, 1) + 1,
        },
        magnitude: -1.0,
        variation,
    }];
    model.steps = vec![step];
    model
}

fn last(keep: &Keep) -> &IncrementReport {
    keep.reports.last().expect("reports")
}

/// The ledger is closed, and what the scheme takes never falls.
fn check(keep: &Keep) {
    let scale = (keep.reports.iter())
        .map(|r| {
            r.energy
                .kinetic
                .max(r.energy.strain)
                .max(r.energy.external_work.abs())
        })
        .fold(0.0, f64::max);
    for pair in keep.reports.windows(2) {
        let [before, after] = [&pair[0].energy, &pair[1].energy];
        assert!(after.balance.abs() < 1e-9 * scale, "{:e}", after.balance);
        let taken = after.numerical_dissipation - before.numerical_dissipation;
        assert!(taken > -1e-9 * scale, "{taken:e}");
        let friction = after.friction_dissipation - before.friction_dissipation;
        assert!(friction > -1e-9 * scale, "{friction:e}");
    }
}

/// A load that comes on slowly, in increments as long as several periods, leaves the beam in its static equilibrium;
/// one that comes at once ends there too, as vibrations lose their energy.
#[test]
fn a_beam_comes_to_its_static_equilibrium() {
    let at_tip = |keep: &Keep| {
        let u = &last(keep).state.u;
        u[u.len() - 1]
    };
    let ramp = Variation::Ramp { from: 0.0 };
    let (keep, _) = run_to_end(&cantilever(Procedure::Static, 1.0, 1, ramp));
    let expected = at_tip(&keep);
    for (variation, tolerance) in [(ramp, 3e-3), (Variation::Constant, 1e-6)] {
        let model = cantilever(Procedure::QuasiStatic, 20.0, 40, variation);
        let (keep, _) = run_to_end(&model);
        check(&keep);
        let error = (at_tip(&keep) / expected - 1.0).abs();
        println!("{variation:?}: {error:e}");
        assert!(error < tolerance, "{variation:?}: {error:e}");
        let energy = &last(&keep).energy;
        assert!(energy.kinetic < 1e-4 * energy.strain);
    }
}

/// In increments far shorter than a period the beam vibrates about the equilibrium as in a dynamic step.
#[test]
fn short_increments_vibrate() {
    let most = |procedure| {
        let (keep, _) = run_to_end(&cantilever(procedure, 0.02, 1200, Variation::Constant));
        let tip = |r: &IncrementReport| r.state.u[r.state.u.len() - 1].abs();
        keep.reports.iter().map(tip).fold(0.0, f64::max)
    };
    let [dynamic, quasi] = [Procedure::Dynamic, Procedure::QuasiStatic].map(most);
    println!("{dynamic} {quasi}");
    assert!(
        quasi < dynamic && quasi > 0.9 * dynamic,
        "{quasi} {dynamic}"
    );
}

/// A block that falls on a rough plate comes to rest there in long increments, without a bounce, and weighs on it.
#[test]
fn a_block_lands_and_rests() {
    for incrementation in [Incrementation::Fixed, Incrementation::Passes] {
        let mut model = model(1e4, 0.3, 1.0);
        let plate = add_block(&mut model, [-1.0, -0.5], [3.0, 0.5], (3, 1), 0.0);
        let block = add_block(&mut model, [0.0, 0.1], [1.0, 1.0], (4, 4), 0.0);
        add_contact(&mut model, block.faces(0), plate.faces(2), 0.3);
        let held = plate.nodes().flat_map(|n| [fixed(2 * n), fixed(2 * n + 1)]);
        let mut step = step(0.05, 40, Settings::default(), held.collect());
        step.procedure = Procedure::QuasiStatic;
        step.increments = Increments {
            dt_max: 0.5,
            incrementation,
            ..step.increments
        };
        step.body_forces = (0..16)
            .map(|k| gravity(block.first_element + k, 10.0))
            .collect();
        model.steps = vec![step];
        let (keep, summary) = run_to_end(&model);
        check(&keep);
        let end = last(&keep);
        let force = end.contacts[0].force[1];
        println!(
            "{incrementation:?}: {} increments, force {force}",
            summary.increments
        );
        assert!((force - 10.0).abs() < 1e-3, "{force}");
        assert!(end.energy.kinetic < 1e-6 * end.energy.external_work);
        let touching = keep
            .reports
            .iter()
            .skip_while(|r| r.contacts[0].closed == 0);
        assert!(
            touching.clone().count() > 3 && touching.into_iter().all(|r| r.contacts[0].closed > 0)
        );
    }
}
