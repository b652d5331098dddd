//! A rigid surface, read from a deck, as a master.

use stickslip::dynamics::IncrementReport;
use stickslip::model::{Model, SurfaceKind};

use crate::blocks::run_to_end;
use crate::reading::read;

/// Between impacts a square of mass 1 falls freely onto a floor that slides away below it with the
/// velocity 0.5; the ledger closes with the work of the floor, and no node passes through it.
#[test]
fn a_square_on_a_sliding_floor() {
    let model = read(include_str!("../decks/rigid_floor.inp"));
    let master = &model.surfaces[model.contacts[0].master];
    assert!(matches!(master.kind, SurfaceKind::Rigid(_)));
    let floor = master.nodes(&model.mesh);
    let (kept, _) = run_to_end(&model);
    let reports = kept.reports;
    for report in &reports {
        let (t, u) = (report.time, &report.state.u);
        for &node in &floor {
            assert!((u[2 * node] - 0.5 * t).abs() < 1e-14 && u[2 * node + 1] == 0.0);
        }
        for node in 0..4 {
            let height = model.mesh.coordinates[node][1] + u[2 * node + 1];
            assert!(height > -1e-9, "node {node} at {t}");
        }
        check_reaction(&model, report, &floor);
        let largest = report.energy.kinetic + report.energy.strain + 1.0;
        assert!(report.energy.balance.abs() < 1e-10 * largest);
    }
    let landed = reports.iter().any(|report| report.contacts[0].closed > 0);
    assert!(landed);
}

/// The reaction is at the reference node only: it balances the contact forces on the floor, with
/// their moment about that node, and agrees with the forces on the slave nodes.
fn check_reaction(model: &Model, report: &IncrementReport, floor: &[usize]) {
    let reference = model.rigid_bodies[0].reference;
    let (nodal, reaction) = (&report.nodal, &report.rigid[0]);
    let arm = |node: usize| {
        let [x, c] = [node, reference].map(|node| model.mesh.coordinates[node]);
        [x[0] - c[0], x[1] - c[1]]
    };
    let (mut force, mut moment) = ([0.0; 2], 0.0);
    for &node in floor {
        assert_eq!(nodal.reaction[2 * node..2 * node + 2], [0.0; 2]);
        let [fx, fy] = [2 * node, 2 * node + 1].map(|p| -nodal.contact_force[p]);
        let [x, y] = arm(node);
        force = [force[0] + fx, force[1] + fy];
        moment += x * fy - y * fx;
    }
    let contact = &report.contacts[0];
    let scale = 1e-12 * (1.0 + contact.normal.abs());
    assert_eq!(reaction.force, force);
    assert_eq!(nodal.reaction[2 * reference..2 * reference + 2], force);
    for (reaction, force) in reaction.force.iter().zip(contact.force) {
        assert!((reaction - force).abs() < scale);
    }
    assert!((reaction.moment - moment).abs() < 10.0 * scale);
    assert!((reaction.moment - contact.reference_moment).abs() < 10.0 * scale);
}

/// The model of the square above its floor with other contact cards.
fn with_contact(cards: &str) -> Model {
    let text = include_str!("../decks/rigid_floor.inp");
    let pair = "*CONTACT PAIR, INTERACTION=DRY\nBOT, FLOOR\n";
    assert!(text.contains(pair));
    read(&text.replacen(pair, cards, 1))
}

/// General contact holds the rigid floor away from all exterior faces, with the assigned friction,
/// as the pair does; both together do so once.
#[test]
fn a_rigid_surface_takes_part_in_general_contact() {
    let pair = "*CONTACT PAIR, INTERACTION=DRY\nBOT, FLOOR\n";
    let general = "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n\
                   *CONTACT PROPERTY ASSIGNMENT\n, , DRY\n";
    let decks = [
        pair.to_owned(),
        general.to_owned(),
        format!("{pair}{general}"),
    ];
    let histories = decks.map(|cards| {
        let model = with_contact(&cards);
        let (kept, summary) = run_to_end(&model);
        let on_floor = |r: &IncrementReport| r.contacts.iter().map(|c| c.normal).sum::<f64>();
        let normal: Vec<f64> = kept.reports.iter().map(on_floor).collect();
        let last = kept.reports.last().expect("reports");
        assert!(normal.iter().any(|&n| n > 0.0) && summary.increments >= 100);
        (normal, last.state.clone(), last.energy.friction_dissipation)
    });
    for (normal, state, friction) in &histories[1..] {
        let near = |a: &[f64], b: &[f64]| {
            let scale = a.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
            a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9 * scale)
        };
        assert!(near(&histories[0].0, normal) && near(&histories[0].1.u, &state.u));
        assert!((friction - histories[0].2).abs() < 1e-9 * friction);
    }
    assert!(histories[0].2 > 0.0);
}

/// A rigid box of mass 1 with a point mass of 2 that a support accelerates: the reaction is that of the whole mass, whether
/// a later step frees the box or not.
#[test]
fn a_held_rigid_body_has_its_point_masses() {
    let deck = |more: &str| {
        format!(
            "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n9, 0.5, 0.5\n*ELEMENT, TYPE=CPE4, ELSET=BOX\n1, 1, 2, 3, 4\n\
             *SOLID SECTION, ELSET=BOX, MATERIAL=M\n1.,\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n\
             *ELEMENT, TYPE=MASS, ELSET=EM\n2, 9\n*MASS, ELSET=EM\n2.\n*RIGID BODY, ELSET=BOX, REF NODE=9\n\
             *STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 0.05\n*BOUNDARY\n9, 6, 6\n*BOUNDARY, TYPE=ACCELERATION\n9, 1, 1, 5.\n\
             9, 2, 2, 0.\n*DLOAD\n, GRAV, 10., 0., -1.\n*END STEP\n{more}"
        )
    };
    let freed =
        "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 0.05\n*BOUNDARY, OP=NEW\n9, 6, 6\n*END STEP\n";
    let [held, freed] = ["", freed].map(|more| run_to_end(&read(&deck(more))).0.reports);
    for (a, b) in held.iter().zip(&freed).skip(1) {
        for (force, right) in a.rigid[0].force.into_iter().zip([15.0, 30.0]) {
            assert!((force - right).abs() < 1e-12, "{force} at {}", a.time);
        }
        assert_eq!(a.rigid[0], b.rigid[0]);
        assert_eq!(a.state, b.state);
        // (1 + 2) (5 t)²/2, and the work of the support, which gravity has no part in
        let speed = 5.0 * a.time;
        assert!((a.energy.kinetic - 1.5 * speed * speed).abs() < 1e-13);
        assert!((a.energy.external_work - a.energy.kinetic).abs() < 1e-13);
    }
}
