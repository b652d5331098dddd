//! Runs whose answer is that of another problem do not finish: energy balances that are off, contact that puts
//! energy in, and contacts that contradict each other.

use crate::blocks::{Keep, add_block, fixed, model, run, step};
use crate::reading::read;
use stickslip::dynamics::{Cause, Failure, Outcome};
use stickslip::model::{Model, Settings};

fn stopped(model: &Model) -> (Keep, Box<Failure>) {
    let mut keep = Keep::default();
    let summary = run(model, &mut keep).expect("the observer never fails");
    let Outcome::Stopped(failure) = summary.outcome else {
        panic!("{:?}", summary.outcome);
    };
    (keep, failure)
}

/// A square falls, so stiff that the round-off of its positions makes forces beyond its weight: no increment is
/// balanced, and halves of it would not be.
#[test]
fn round_off_of_stiff_bodies_stops_a_run() {
    let (_, failure) = stopped(&read(
        "*NODE\n1, 0., 0.5\n2, 1., 0.5\n3, 1., 1.5\n4, 0., 1.5\n*ELEMENT, TYPE=CPS4, ELSET=BODY\n1, 1, 2, 3, 4\n\
         *MATERIAL, NAME=M\n*ELASTIC\n9223372036854775808, 0.3\n*DENSITY\n1.\n\
         *SOLID SECTION, ELSET=BODY, MATERIAL=M\n*STEP, NLGEOM\n*DYNAMIC\n0.05, 0.8\n\
         *DLOAD\nBODY, GRAV, 9.81, 0., -1.\n*END STEP\n",
    ));
    let Cause::Unbalanced { part, is_round_off } = failure.cause else {
        panic!("{}", failure.cause);
    };
    assert!(part > 1e-3 && is_round_off, "{part:e}");
}

/// A bar that is thrown and vibrates, with passes that end at a residual of a half.
#[test]
fn loose_tolerances_do_not_pass_for_answers() {
    let mut model = model(1e3, 0.3, 1.0);
    let bar = add_block(&mut model, [0.0, 0.0], [4.0, 1.0], (4, 1), 0.0);
    model.initial_velocity[2 * bar.node(4, 0)] = 3.0;
    let settings = Settings {
        tolerance: 0.5,
        ..Settings::default()
    };
    let held = (0..2).flat_map(|j| [2 * bar.node(0, j), 2 * bar.node(0, j) + 1]);
    model.steps = vec![step(0.05, 100, settings, held.map(fixed).collect())];
    let (keep, failure) = stopped(&model);
    assert!(
        matches!(
            failure.cause,
            Cause::Unbalanced {
                is_round_off: false,
                ..
            }
        ),
        "{}",
        failure.cause
    );
    assert_eq!(failure.halvings, 10, "halves may be better");
    for report in &keep.reports {
        let energy = report.energy;
        let most = energy.kinetic.max(energy.strain).max(energy.external_work);
        assert!(energy.balance.abs() <= 1e-3 * most.max(keep.reports[0].energy.kinetic));
    }
}

/// A square lies deep in a base that moves away: the corner of the base turns past its nodes. (A deck like this is
/// refused, as it starts inside.)
#[test]
fn contact_that_would_put_energy_in_is_halved() {
    let model = read(
        "*NODE\n1, 0., 0.\n2, 2., 0.\n3, 2., 1.\n4, 0., 1d5\n5, 0.5, 1.01\n6, 1.5, 1.01\n7, 1.5, 2.01\n8, 0.5, 2.01\n\
         *ELEMENT, TYPE=CPS4, ELSET=BASE\n1, 1, 2, 3, 4\n*ELEMENT, TYPE=CPS4, ELSET=SQUARE\n2, 5, 6, 7, 8\n\
         *MATERIAL, NAME=RUBBER\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n\
         *SOLID SECTION, ELSET=BASE, MATERIAL=RUBBER\n*SOLID SECTION, ELSET=SQUARE, MATERIAL=RUBBER\n\
         *SURFACE, NAME=FOOT\nSQUARE, S1\n*SURFACE, NAME=TOP\nBASE, S3\n*SURFACE INTERACTION, NAME=DRY\n*FRICTION\n0.2\n\
         *CONTACT PAIR, INTERACTION=DRY\nFOOT, TOP\n*BOUNDARY\n1, 1, 2\n2, 1, 2\n\
         *INITIAL CONDITIONS, TYPE=VELOCITY\n5, 2, -0.5\n6, 2, -0.5\n7, 2, -0.5\n8, 2, -0.5\n\
         *STEP, NLGEOM, INC=10000\n*DYNAMIC, DIRECT\n0.01, 0.1\n*END STEP\n",
    );
    let mut keep = Keep::default();
    run(&model, &mut keep).expect("the observer never fails");
    let gains: Vec<_> = (keep.cutbacks.iter())
        .filter_map(|cutback| match cutback.failure.cause {
            Cause::GainedEnergy { part, pair } => Some((part, pair)),
            _ => None,
        })
        .collect();
    assert!(gains.iter().any(|(part, _)| *part > 1e-2), "{gains:?}");
    // node 5 or 6 on the segment from node 3 to node 4
    let is_of_foot =
        |pair: &Option<[usize; 3]>| matches!(pair, Some([4 | 5, 2, 3] | [4 | 5, 3, 2]));
    assert!(gains.iter().all(|(_, pair)| is_of_foot(pair)), "{gains:?}");
}
