//! Work of friction, wear and heat at the slave nodes against the ledger and closed forms.

use stickslip::dynamics::IncrementReport;
use stickslip::model::{ContactMass, Heat, LandingRule, Model, Wear};

use crate::blocks::{Block, SCHEMES, run_to_end, throw};
use crate::friction::block_on_base;
use crate::statics::run_deck;

const MU: f64 = 0.3;
const RATE: f64 = 2e-4;
const PART: f64 = 0.45;

/// A block that slides on a base and wears.
fn sliding(scheme: stickslip::model::Scheme, by_friction: bool) -> (Model, Block) {
    let (mut model, block) = block_on_base(MU, [0.0, -1.0], scheme);
    let interaction = &mut model.contacts[0].interaction;
    interaction.wear = Some(Wear {
        rate: RATE,
        by_friction,
    });
    interaction.heat = Some(Heat {
        part: 0.9,
        to_slave: PART / 0.9,
    });
    throw(&mut model, &block, [1.0, 0.0], 0.0, [0.0, 0.0]);
    (model, block)
}

/// Values at the slave nodes, the bottom of the block.
fn at_bottom(values: &[f64], block: &Block) -> Vec<f64> {
    (0..=block.nx).map(|i| values[block.node(i, 0)]).collect()
}

/// The heat of all nodes is that of the ledger, and wear goes with work.
fn agrees_with_the_ledger(last: &IncrementReport, by_friction: bool, what: &str) {
    let heat: f64 = last
        .nodal
        .friction
        .heat
        .iter()
        .filter(|heat| !heat.is_nan())
        .sum();
    let dissipated = last.energy.friction_dissipation;
    let error = (heat - PART * dissipated).abs();
    println!("{what}: heat {heat:.6}, error {error:.1e}");
    assert!(dissipated > 0.05, "{what}: {dissipated}");
    assert!(error < 1e-12 * dissipated, "{what}: {heat} {dissipated}");
    assert!(last.surface_work_difference < 1e-12, "{what}");
    let factor = if by_friction { RATE } else { RATE / MU };
    let friction = &last.nodal.friction;
    for (work, wear) in friction.work.iter().zip(&friction.wear) {
        assert!(work.is_nan() == wear.is_nan());
        assert!(work.is_nan() || (wear - factor * work).abs() <= 1e-12 * factor * work.abs());
    }
}

#[test]
fn wear_and_heat_are_those_of_the_booked_work() {
    for scheme in SCHEMES {
        for by_friction in [false, true] {
            let (model, block) = sliding(scheme, by_friction);
            let (keep, _) = run_to_end(&model);
            let last = keep.reports.last().expect("reports");
            agrees_with_the_ledger(last, by_friction, &format!("{scheme:?} {by_friction}"));
            let wear = at_bottom(&last.nodal.friction.wear, &block);
            assert!(wear.iter().all(|wear| *wear > 0.0));
            let inner = &wear[1..block.nx];
            let mean =
                (inner.iter().sum::<f64>() + (wear[0] + wear[block.nx]) / 2.0) / block.nx as f64;
            // mu p s is the kinetic energy 1 over the area 4 but for what impacts take
            let per_area = (1.0 - last.energy.impact_loss) / 4.0;
            let expected = RATE * per_area / if by_friction { 1.0 } else { MU };
            println!("{scheme:?}: depth {mean:.6e} of {expected:.6e}");
            assert!((mean / expected - 1.0).abs() < 0.01, "{mean} {expected}");
        }
    }
}

#[test]
fn landings_that_give_back_take_their_wear_back() {
    for mass in [ContactMass::Consistent, ContactMass::Redistributed] {
        let (mut model, block) = sliding(SCHEMES[0], false);
        throw(&mut model, &block, [1.0, -0.5], 0.0, [0.0, 0.0]);
        model.steps[0].settings.landing = LandingRule::Return;
        model.steps[0].settings.contact_mass = mass;
        let (keep, _) = run_to_end(&model);
        let last = keep.reports.last().expect("reports");
        agrees_with_the_ledger(last, false, &format!("{mass:?}"));
    }
}

/// A block that has slid on a rigid floor is lifted off in one static increment, on its way back: friction does no work as
/// the pairs open, and nothing wears.
#[test]
fn a_pair_that_opens_wears_as_its_friction_works() {
    let (keep, failure) = run_deck(
        "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 2., 0.\n4, 0., 1.\n5, 1., 1.\n6, 2., 1.\n9, 1., -1.\n\
         *ELEMENT, TYPE=CPE4, ELSET=E\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n\
         *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n*SURFACE, NAME=SB\nE, S1\n*NSET, NSET=TOP\n4, 5, 6\n\
         *SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, -5., 0.\nLINE, 5., 0.\n\
         *RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=9\n*BOUNDARY\n9, 1, 2\n\
         *SURFACE INTERACTION, NAME=I\n*FRICTION\n0.1\n*WEAR SURFACE PROPERTIES\n1.E-4\n*GAP HEAT GENERATION\n0.9, 0.4\n\
         *CONTACT PAIR, INTERACTION=I\nSB, FLOOR\n\
         *STEP, NLGEOM\n*STATIC, DIRECT\n0.25, 1.\n*BOUNDARY\nTOP, 1, 1, 0.02\nTOP, 2, 2, -0.01\n*END STEP\n\
         *STEP, NLGEOM\n*STATIC, DIRECT\n1., 1.\n*BOUNDARY\nTOP, 1, 1, 0.\nTOP, 2, 2, 0.01\n*END STEP\n",
    );
    assert_eq!(failure, None);
    for report in &keep.reports {
        let friction = &report.nodal.friction;
        for (work, wear) in friction.work.iter().zip(&friction.wear) {
            let expected = 1e-4 / 0.1 * work;
            assert!(
                work.is_nan() || (wear - expected).abs() <= 1e-12 * expected.abs(),
                "{wear} {work}"
            );
        }
    }
    let last = keep.reports.last().expect("reports");
    assert!(last.contacts[0].closed == 0 && last.energy.friction_dissipation > 0.0);
}
