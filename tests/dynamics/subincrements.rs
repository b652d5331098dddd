//! Subincrements: the shortest length at impacts, and motions without an impact.

use std::f64::consts::FRAC_PI_4;

use crate::blocks::{Keep, SCHEMES, add_block, add_contact, fixed, model, run_to_end, step, throw};
use stickslip::dynamics::RunSummary;
use stickslip::model::{ImpactTime, Scheme, Settings, Support, SupportMotion};

fn settings(scheme: Scheme) -> Settings {
    Settings {
        scheme,
        impact_time: ImpactTime::Event,
        ..Settings::default()
    }
}

/// A block that falls flat on a plate after the given part of an increment of 1; two increments.
fn fall(scheme: Scheme, part: f64) -> (Keep, RunSummary) {
    let mut model = model(10.0, 0.2, 1.0);
    let plate = add_block(&mut model, [-1.0, -0.5], [3.0, 0.5], (3, 1), 0.0);
    let block = add_block(&mut model, [0.0, 0.1], [1.0, 1.0], (2, 2), 0.0);
    throw(&mut model, &block, [0.0, -0.1 / part], 0.0, [0.0; 2]);
    add_contact(&mut model, block.faces(0), plate.faces(2), 0.0);
    let supports = plate.nodes().flat_map(|n| [2 * n, 2 * n + 1]).map(fixed);
    model.steps = vec![step(1.0, 2, settings(scheme), supports.collect())];
    run_to_end(&model)
}

/// Impacts within a thousandth of an increment before its end are taken in it: no subincrement is
/// shorter.
#[test]
fn an_impact_at_the_very_end_of_an_increment_does_not_cut_it() {
    for scheme in SCHEMES {
        for (part, count) in [(0.9, 2), (0.998, 2), (0.9995, 1), (1.0 - 1e-6, 1)] {
            let (keep, summary) = fall(scheme, part);
            let first = keep.reports[1..].iter().filter(|r| r.time <= 1.0).count();
            let shortest = keep.reports[1..].iter().map(|r| r.dt).fold(1.0, f64::min);
            assert_eq!((first, summary.cutbacks), (count, 0), "{scheme:?} {part}");
            assert!(shortest >= 1e-3, "{shortest:e}");
        }
    }
}

/// A block on its corner that slides across the bend of a plate from one segment to the next,
/// `depth` below the first, in one increment of 0.1, while the plate is bent from one angle to the
/// other.
fn slide(
    settings: Settings,
    [bend, bent]: [f64; 2],
    depth: f64,
    velocity: [f64; 2],
) -> (Keep, RunSummary) {
    let mut model = model(1e4, 0.2, 1.0);
    let plate = add_block(&mut model, [0.0, 0.0], [2.0, 0.5], (2, 1), 0.0);
    let corner = plate.node(1, 1);
    model.mesh.coordinates[corner][1] -= bend / 2.0;
    let start = [0.95, 0.5 - 0.95 * bend / 2.0 - depth];
    let block = add_block(&mut model, start, [0.5, 0.5], (1, 1), FRAC_PI_4);
    throw(&mut model, &block, velocity, 0.0, [0.0; 2]);
    let lower = [block.faces(3), block.faces(0)].concat();
    add_contact(&mut model, lower, plate.faces(2), 0.0);
    let dofs = plate.nodes().flat_map(|n| [2 * n, 2 * n + 1]);
    let support = |dof: usize| match dof == 2 * corner + 1 {
        true => Support {
            dof,
            motion: SupportMotion::Ramp {
                to: (bend - bent) / 2.0,
            },
        },
        false => fixed(dof),
    };
    let supports = dofs.map(support);
    model.steps = vec![step(0.1, 1, settings, supports.collect())];
    run_to_end(&model)
}

/// A bend by less than a degree is no wall.
#[test]
fn a_node_that_slides_into_a_shallow_valley_meets_nothing() {
    for scheme in SCHEMES {
        for (bend, events) in [(0.0, 0), (0.008, 0), (0.05, 1)] {
            let velocity = [0.7, -0.7 * bend / 2.0];
            let (_, summary) = slide(settings(scheme), [bend; 2], 0.0, velocity);
            assert_eq!((summary.events, summary.cutbacks), (events, 0), "{bend}");
        }
    }
}

/// A node that lies in the surface by a part of 5e-10 of a segment, and slides on to the next.
#[test]
fn round_off_of_a_sliding_node_is_no_gain_of_energy() {
    for velocity in [[0.7, 0.0], [0.7, -0.1]] {
        let (keep, summary) = slide(Settings::default(), [0.0; 2], 5e-10, velocity);
        println!("{velocity:?} {:?}", keep.reports[1].energy);
        assert!(keep.reports[1].contacts[0].closed > 0);
        assert_eq!((summary.cutbacks, summary.increments), (0, 1));
    }
}

/// A node that was behind the line of the segment it comes to, and does not touch it.
#[test]
fn a_node_above_a_corner_that_turns_concave_gets_no_energy() {
    let (keep, summary) = slide(Settings::default(), [-0.01, 0.01], -1e-4, [0.7, 0.0]);
    let contact = &keep.reports[1].contacts[0];
    assert!(contact.closed == 0 && contact.min_gap > 0.0);
    assert_eq!((summary.cutbacks, summary.increments), (0, 1));
}
