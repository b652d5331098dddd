//! Neo-Hookean bodies at large strains: energy and momenta in free flight and in contact.

use crate::blocks::{
    Keep, add_block, add_contact, model, run, run_to_end, settings, step, stretch, throw,
};
use crate::energies::{energy, largest};
use stickslip::materials::{Law, NeoHooke};
use stickslip::model::{ElementType, Model, Scheme, Settings};

/// A model of neo-Hookean material with mu = 2, K = 10 and density 1 (waves run at 3.6).
fn rubber() -> Model {
    let mut model = model(1.0, 0.0, 1.0);
    model.materials[0].law = Law::NeoHooke(NeoHooke { c10: 1.0, d1: 0.2 });
    model
}

fn make_plane_strain(model: &mut Model) {
    for element in &mut model.mesh.elements {
        element.element_type = ElementType::CPE4;
    }
}

/// A block that flies, spins and is stretched along one side at a third of its wave speed.
fn flying_block(scheme: Scheme) -> Model {
    let mut model = rubber();
    let block = add_block(&mut model, [0.0, 0.0], [2.0, 1.0], (6, 3), 0.0);
    throw(&mut model, &block, [0.4, -0.3], 1.5, [1.0, 0.5]);
    stretch(&mut model, &block, 1.2, 1.0);
    make_plane_strain(&mut model);
    model.steps = vec![step(0.04, 300, settings(scheme), Vec::new())];
    model
}

#[test]
fn a_flying_block_keeps_energy_and_both_momenta_at_large_strains() {
    let (keep, summary) = run_to_end(&flying_block(Scheme::EnergyMomentum));
    let first = &keep.reports[0];
    let drift = largest(&keep.reports, |r| (energy(r) - energy(first)).abs()) / energy(first);
    let linear = largest(&keep.reports, |r| {
        let [now, start] = [r, first].map(|r| r.momentum.linear);
        (now[0] - start[0]).abs().max((now[1] - start[1]).abs())
    });
    let angular = largest(&keep.reports, |r| {
        (r.momentum.angular - first.momentum.angular).abs()
    });
    let strain = largest(&keep.reports, |r| r.strain.strain);
    println!("energy {drift:.1e} linear {linear:.1e} angular {angular:.1e} strain {strain:.2}");
    println!("{summary:?}");
    assert!(keep.reports.len() > 300 && keep.cutbacks.is_empty());
    assert!(strain > 0.4 && largest(&keep.reports, |r| r.energy.strain) > 0.2 * energy(first));
    assert!(drift < 1e-10);
    assert!(linear < 1e-10 * first.momentum.linear[0].abs());
    assert!(angular < 1e-10 * first.momentum.angular.abs());
    assert_eq!(
        largest(&keep.reports, |r| r.energy.material_dissipation.abs()),
        0.0
    );
}

#[test]
fn what_the_dissipative_scheme_takes_is_booked() {
    let scheme = Scheme::Ss22 {
        theta1: 1.0,
        theta2: 1.0,
    };
    let (keep, _) = run_to_end(&flying_block(scheme));
    let (first, last) = (&keep.reports[0], &keep.reports[keep.reports.len() - 1]);
    let lost = energy(first) - energy(last);
    println!("lost {:.2} of the energy", lost / energy(first));
    assert!(lost > 0.05 * energy(first));
    assert!((last.energy.numerical_dissipation - lost).abs() < 1e-9 * energy(first));
    assert!(largest(&keep.reports, |r| r.energy.balance.abs()) < 1e-9 * energy(first));
}

#[test]
fn two_blocks_in_contact_never_gain_energy() {
    for friction in [0.0, 0.4] {
        let mut model = rubber();
        let lower = add_block(&mut model, [0.0, 0.0], [2.0, 1.0], (6, 3), 0.0);
        let upper = add_block(&mut model, [0.35, 1.05], [1.2, 1.0], (5, 4), 0.1);
        throw(&mut model, &upper, [0.3, -1.2], 0.2, [0.9, 1.5]);
        add_contact(&mut model, upper.faces(0), lower.faces(2), friction);
        make_plane_strain(&mut model);
        let settings = settings(Scheme::EnergyMomentum);
        model.steps = vec![step(0.02, 200, settings, Vec::new())];
        let (keep, _) = run_to_end(&model);
        let start = energy(&keep.reports[0]);
        let pairs = keep.reports.windows(2);
        let gain = pairs.map(|pair| energy(&pair[1]) - energy(&pair[0]));
        let gain = gain.fold(0.0, f64::max) / start;
        let strain = largest(&keep.reports, |r| r.strain.strain);
        let closed = largest(&keep.reports, |r| r.energy.strain) / start;
        println!("mu {friction}: gain {gain:.1e} strain {strain:.2} strain energy {closed:.2}");
        assert!(gain < 1e-10, "friction {friction}");
        assert!(strain > 0.2 && closed > 0.1, "the blocks meet");
        let last = &keep.reports[keep.reports.len() - 1];
        assert!(last.energy.balance.abs() < 1e-9 * start);
        assert_eq!(last.energy.friction_dissipation > 0.0, friction > 0.0);
    }
}

#[test]
fn a_block_crushed_in_one_increment_is_cut_back_or_inverted() {
    // 30 times the wave speed: the first increment turns elements inside out
    let mut model = rubber();
    let block = add_block(&mut model, [0.0, 0.0], [1.0, 1.0], (3, 3), 0.0);
    stretch(&mut model, &block, -60.0, 0.5);
    make_plane_strain(&mut model);
    model.steps = vec![step(0.1, 1, Settings::default(), Vec::new())];
    let mut keep = Keep::default();
    run(&model, &mut keep).expect("the observer never fails");
    let causes: Vec<String> = keep.cutbacks.iter().map(|c| format!("{:?}", c)).collect();
    assert!(
        causes.iter().any(|cause| cause.contains("Inverted")),
        "{causes:?}"
    );
}
