//! Redistributed mass at contact surfaces: free flight, impacts, gravity, supports, equations.

use crate::blocks::{
    Keep, add_block, add_contact, fixed, gravity, model, run_to_end, step, stretch, throw,
};
use crate::invariants::drift;
use crate::reading::try_read;
use crate::statics::run_deck;
use stickslip::dynamics::IncrementReport;
use stickslip::model::{
    Amplitude, ContactMass, Curve, Equation, ImpactTime, LandingRule, Load, Model, PointLoad,
    Settings, Support, SupportMotion, TimeBase, Variation,
};
use stickslip::prepare::PreparedModel;

fn redistributed() -> Settings {
    Settings {
        contact_mass: ContactMass::Redistributed,
        ..Settings::default()
    }
}

/// Nodes without mass.
fn massless(model: &Model) -> Vec<usize> {
    let prepared = PreparedModel::new(model.clone());
    prepared.redistribution.massless().collect()
}

/// No increment ends with an overlap, gains energy, or opens the balance; no node loses its velocity.
fn assert_sound(keep: &Keep) {
    let energy = |k: usize| keep.reports[k].energy.kinetic + keep.reports[k].energy.strain;
    let largest = (0..keep.reports.len()).map(energy).fold(0.0, f64::max);
    for (k, report) in keep.reports.iter().enumerate() {
        let violation = &report.solver.violation;
        assert!(violation.overlap <= 1e-11, "{}: {violation:?}", report.time);
        assert!(
            report.energy.balance.abs() < 1e-11 * largest,
            "{}",
            report.time
        );
        assert_eq!(report.energy.impact_loss, 0.0);
        let work = report.energy.external_work;
        let before = k
            .checked_sub(1)
            .map_or(0.0, |k| keep.reports[k].energy.external_work);
        let gain = energy(k) - energy(k.saturating_sub(1)) - (work - before);
        assert!(gain < 1e-11 * largest, "{}: {gain:e}", report.time);
    }
}

/// A beam, stretched at the start, that flies, spins and vibrates.
#[test]
fn free_flight_keeps_energy_and_both_momenta() {
    let mut model = model(1e4, 0.3, 1.0);
    let bar = add_block(&mut model, [0.0, 0.0], [10.0, 1.0], (20, 4), 0.0);
    throw(&mut model, &bar, [1.0, 2.0], 1.0, [5.0, 0.5]);
    stretch(&mut model, &bar, 0.5, 5.0);
    let skin = model.mesh.exterior_faces();
    add_contact(&mut model, skin.clone(), skin, 0.0);
    model.steps = vec![step(0.02, 200, redistributed(), Vec::new())];
    assert_eq!(massless(&model).len(), 48);
    let (keep, _) = run_to_end(&model);
    let [energy, linear, angular] = drift(&keep);
    println!("energy {energy:.1e} linear {linear:.1e} angular {angular:.1e}");
    assert!(energy < 1e-11 && linear < 1e-12 && angular < 1e-12);
    // the angular momentum of the consistent mass is another one, and not constant
    let difference = |r: &IncrementReport| {
        let consistent = r.momentum.consistent_angular.expect("both are given");
        (consistent / r.momentum.angular - 1.0).abs()
    };
    let most = keep.reports.iter().map(difference).fold(0.0, f64::max);
    assert!(most > 1e-8 && most < 1e-2, "{most:e}");
    let first = &keep.reports[0].momentum;
    assert!((first.linear[0] - 10.0).abs() < 1e-12 && (first.linear[1] - 20.0).abs() < 1e-12);
    assert_sound(&keep);
}

/// Two beams thrown at each other obliquely, in two steps.
fn oblique_impact(friction: f64, settings: Settings) -> Model {
    let mut model = model(1e3, 0.3, 1.0);
    let lower = add_block(&mut model, [0.0, 0.0], [4.0, 0.8], (16, 4), 0.0);
    let upper = add_block(&mut model, [0.7, 1.0], [3.0, 0.8], (10, 4), 0.1);
    throw(&mut model, &lower, [0.3, 0.5], 0.05, [2.0, 0.4]);
    throw(&mut model, &upper, [-0.8, -1.5], -0.2, [2.2, 1.5]);
    add_contact(&mut model, upper.faces(0), lower.faces(2), friction);
    let half = || step(0.005, 150, settings, Vec::new());
    model.steps = vec![half(), half()];
    model
}

#[test]
fn impacts_keep_both_momenta_and_stop_no_node() {
    let (increment, event) = (ImpactTime::Increment, ImpactTime::Event);
    for (impact_time, friction) in [
        (increment, 0.0),
        (increment, 0.3),
        (event, 0.0),
        (event, 0.3),
    ] {
        let settings = Settings {
            impact_time,
            ..redistributed()
        };
        let (keep, _) = run_to_end(&oblique_impact(friction, settings));
        let [_, linear, angular] = drift(&keep);
        let last = &keep.reports.last().expect("reports").energy;
        println!("{impact_time:?} {friction}: {linear:.1e} {angular:.1e} {last:?}");
        assert!(keep.reports.iter().any(|r| r.contacts[0].closed > 2));
        assert!(linear < 1e-12 && angular < 1e-12);
        assert!(last.release_loss > 0.0);
        assert_sound(&keep);
    }
}

/// With the landing return nothing takes energy where there is no friction.
#[test]
fn with_the_landing_return_the_energy_is_kept() {
    for impact_time in [ImpactTime::Increment, ImpactTime::Event] {
        let settings = Settings {
            impact_time,
            landing: LandingRule::Return,
            ..redistributed()
        };
        let (keep, _) = run_to_end(&oblique_impact(0.0, settings));
        let [energy, linear, angular] = drift(&keep);
        let last = &keep.reports.last().expect("reports").energy;
        println!("{impact_time:?}: {energy:.1e} {linear:.1e} {angular:.1e} {last:?}");
        assert!(energy < 1e-11 && linear < 1e-12 && angular < 1e-12);
        let taken = last.release_loss - last.normal_contact_work;
        assert!((last.landing_return - taken).abs() < 1e-11 * last.kinetic);
        assert!(last.release_loss > 0.0);
        assert_sound(&keep);
    }
}

/// Weights act where the mass is, so that a body falls without strain, and supports whose nodes are
/// without mass move as prescribed.
#[test]
fn a_block_falls_and_lands_on_a_moving_table() {
    let mut model = model(1e3, 0.3, 1.0);
    let table = add_block(&mut model, [-1.0, -1.0], [4.0, 1.0], (8, 4), 0.0);
    let block = add_block(&mut model, [0.0, 0.05], [2.0, 1.0], (6, 5), 0.0);
    add_contact(&mut model, block.faces(0), table.faces(2), 0.3);
    model.amplitudes = vec![Amplitude {
        name: "RISE".into(),
        time: TimeBase::Step,
        curve: Curve::Linear(vec![(0.0, 0.0), (1.0, 0.1)]),
    }];
    let held = table
        .nodes()
        .flat_map(|n| [2 * n, 2 * n + 1])
        .map(|dof| match dof % 2 {
            0 => fixed(dof),
            _ => Support {
                dof,
                motion: SupportMotion::Amplitude {
                    value: 1.0,
                    amplitude: 0,
                },
            },
        });
    let mut fall = step(0.005, 60, redistributed(), held.collect());
    let elements = block.first_element..block.first_element + 30;
    fall.body_forces = elements.map(|e| gravity(e, 2.0)).collect();
    model.steps = vec![fall];
    assert_eq!(massless(&model).len(), 7 + 9);
    let (keep, _) = run_to_end(&model);
    for node in block.nodes() {
        assert!(
            (keep.reports[0].state.a[2 * node + 1] + 2.0).abs() < 1e-12,
            "{node}"
        );
    }
    let landed = keep
        .reports
        .iter()
        .position(|r| r.contacts[0].closed > 0)
        .expect("landed");
    assert!(landed > 10);
    assert!(keep.reports[landed - 1].energy.strain < 1e-24);
    for report in &keep.reports {
        for node in table.nodes() {
            assert!((report.state.u[2 * node + 1] - 0.1 * report.time).abs() < 1e-14);
            assert!((report.state.v[2 * node + 1] - 0.1).abs() < 1e-14);
        }
    }
    assert_sound(&keep);
}

/// Forces at nodes without mass, which press them on a table and then pull, do work as these nodes come to
/// rest after they are released, eq. (6.15): without it the balance would not close.
#[test]
fn loads_do_work_on_the_way_to_rest() {
    let mut model = model(1e3, 0.3, 1.0);
    let table = add_block(&mut model, [-1.0, -1.0], [4.0, 1.0], (8, 4), 0.0);
    let block = add_block(&mut model, [0.0, 0.0], [2.0, 1.0], (6, 5), 0.0);
    add_contact(&mut model, block.faces(0), table.faces(2), 0.3);
    model.amplitudes = vec![Amplitude {
        name: "PULL".into(),
        time: TimeBase::Step,
        curve: Curve::Linear(vec![(0.0, -1.0), (0.05, -1.0), (0.1, 1.0)]),
    }];
    let held = table.nodes().flat_map(|n| [fixed(2 * n), fixed(2 * n + 1)]);
    let mut pull = step(0.005, 20, redistributed(), held.collect());
    let load = |i: usize| Load {
        at: PointLoad {
            dof: 2 * block.node(i, 0) + 1,
        },
        magnitude: 2.0 + i as f64,
        variation: Variation::Amplitude(0),
    };
    pull.point_loads = (0..=6).map(load).collect();
    model.steps = vec![pull];
    let massless = massless(&model);
    assert!((0..=6).all(|i| massless.contains(&block.node(i, 0))));
    let (keep, _) = run_to_end(&model);
    let last = keep.reports.last().expect("reports");
    // the work is more than what the rest takes
    assert!(last.energy.release_loss > 1e-7 * last.energy.external_work);
    assert_eq!(last.contacts[0].closed, 0);
    assert_sound(&keep);
}

#[test]
fn nodes_of_equations_keep_their_mass() {
    let mut model = oblique_impact(0.3, redistributed());
    // the two ends of the lower face of the upper beam move alike
    let [first, last] = [85, 95];
    for i in 0..2 {
        model.equations.push(Equation {
            dof: 2 * first + i,
            terms: vec![(2 * last + i, 1.0)],
        });
    }
    let all = massless(&oblique_impact(0.3, redistributed()));
    let found = massless(&model);
    assert!(all.contains(&first) && all.contains(&last));
    assert_eq!(found.len(), all.len() - 2);
    let (keep, _) = run_to_end(&model);
    let last = &keep.reports.last().expect("reports").energy;
    assert!(
        last.balance.abs() < 1e-11 * keep.reports[0].energy.kinetic,
        "{last:?}"
    );
}

/// Messages about the steps of a deck.
fn messages(steps: [&str; 2]) -> String {
    let text = include_str!("../decks/rigid_floor.inp");
    let (head, rest) = text.split_once("*STEP").expect("a step");
    let (_, body) = rest.split_once('\n').expect("lines");
    let steps = steps.map(|card| format!("*STEP, NLGEOM\n{card}\n{body}"));
    try_read(&format!("{head}{}", steps.concat())).2
}

#[test]
fn redistributed_mass_is_for_energy_momentum_and_for_all_steps() {
    let on = "*STICKSLIP, CONTACT MASS=REDISTRIBUTED";
    let refused = messages(["*STICKSLIP, SCHEME=SS22, CONTACT MASS=REDISTRIBUTED", ""]);
    assert!(
        refused.contains("CONTACT MASS=REDISTRIBUTED is not for SCHEME=SS22"),
        "{refused}"
    );
    let refused = messages([on, "*STICKSLIP, SCHEME=SS22"]);
    assert!(
        refused.contains("CONTACT MASS=REDISTRIBUTED is not for SCHEME=SS22"),
        "{refused}"
    );
    let refused = messages(["", on]);
    assert!(
        refused.contains("CONTACT MASS is the same in all steps"),
        "{refused}"
    );
    assert!(!messages([on, on]).contains("error"));
    assert!(!messages([on, "*STICKSLIP, LCP=LEMKE"]).contains("error"));
}

/// Two bars whose ends lie flush on each other: the corners slide off, those of both bars come to rest, and no impulse that is
/// given back pulls.
#[test]
fn flush_bars_part_again() {
    let bar = |first: usize, x0: f64, count: usize, name: &str| {
        let node = |i: usize, j: usize| first + j * (count + 1) + i;
        let mut text = "*NODE\n".to_string();
        for (i, j) in (0..3).flat_map(|j| (0..=count).map(move |i| (i, j))) {
            let (x, y) = (x0 + 10.0 * i as f64, 10.0 * j as f64);
            text += &format!("{}, {x:?}, {y:?}\n", node(i, j));
        }
        text += &format!("*ELEMENT, TYPE=CPS4, ELSET={name}\n");
        for (i, j) in (0..2).flat_map(|j| (0..count).map(move |i| (i, j))) {
            let [a, b] = [node(i, j), node(i, j + 1)];
            text += &format!(
                "{}, {a}, {}, {}, {b}\n",
                first + j * count + i,
                a + 1,
                b + 1
            );
        }
        text
    };
    let (keep, failure) = run_deck(&format!(
        "{}*NSET, NSET=MOVING, GENERATE\n1, 12\n*SURFACE, NAME=SR\n3, S2\n6, S2\n\
         {}*SURFACE, NAME=AL\n101, S4\n107, S4\n\
         *MATERIAL, NAME=ST\n*ELASTIC\n210000., 0.\n*DENSITY\n7.85E-9\n\
         *MATERIAL, NAME=AL\n*ELASTIC\n70000., 0.\n*DENSITY\n2.7E-9\n\
         *SOLID SECTION, ELSET=S, MATERIAL=ST\n20.\n*SOLID SECTION, ELSET=A, MATERIAL=AL\n20.\n\
         *SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nSR, AL\n\
         *INITIAL CONDITIONS, TYPE=VELOCITY\nMOVING, 1, 5000.\n\
         *STEP\n*DYNAMIC, DIRECT\n1.5E-6, 6.E-5\n*STICKSLIP, CONTACT MASS=REDISTRIBUTED, LANDING=RETURN\n*END STEP\n",
        bar(1, -30.0, 3, "S"),
        bar(101, 0.0, 6, "A"),
    ));
    assert_eq!(failure, None);
    assert_sound(&keep);
    let cone = |report: &IncrementReport| report.contacts[0].impulse_cone_violation;
    let worst = keep.reports.iter().map(cone).fold(0.0, f64::max);
    assert!(worst < 1e-12, "{worst:e}");
}
