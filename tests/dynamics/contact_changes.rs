//! Friction and contacts that change from step to step, against closed forms.

use stickslip::dynamics::{Cause, Outcome};
use stickslip::model::{
    Amplitude, ContactChanges, Curve, FormerFriction, Friction, FrictionChange, FrictionLaw, Model,
    Procedure, Scheme, Step, TimeBase, Variation,
};

use crate::blocks::{Block, Keep, SCHEMES, run, run_to_end};
use crate::friction::block_on_base;
use crate::statics::run_deck;

const GRAVITY: f64 = 10.0;

fn slope() -> (f64, [f64; 2]) {
    let slope = 20.0_f64.to_radians();
    (slope, [slope.sin(), -slope.cos()])
}

/// The block of [`block_on_base`] on a slope, at rest for a step; the second step of `count` increments has these
/// changes.
fn two_steps(scheme: Scheme, count: usize, changes: ContactChanges) -> (Model, Block) {
    let (mut model, block) = block_on_base(0.5, slope().1, scheme);
    let mut next: Step = model.steps[0].clone();
    for load in &mut next.body_forces {
        load.variation = Variation::Constant;
    }
    next.increments.period = 0.002 * count as f64;
    next.contacts = changes;
    model.steps.push(next);
    (model, block)
}

fn friction(friction: Friction, from: Option<Friction>) -> ContactChanges {
    ContactChanges {
        removed: Vec::new(),
        friction: vec![FrictionChange {
            contact: 0,
            friction,
            from: from.map(|friction| FormerFriction {
                friction,
                amplitude: None,
            }),
        }],
    }
}

fn removed() -> ContactChanges {
    ContactChanges {
        removed: vec![0],
        friction: Vec::new(),
    }
}

#[test]
fn a_block_slides_off_when_the_friction_is_changed() {
    let (slope, _) = slope();
    let [drive, press] = [GRAVITY * slope.sin(), GRAVITY * slope.cos()];
    // at once, and along a ramp from 0.5 to 0.1 over 0.4, on which it begins to slide at mu = tan(slope)
    let start = 0.4 * (0.5 - slope.tan()) / 0.4;
    let ramped = |t: f64| {
        let s = (t - start).max(0.0);
        s * s / 2.0 * press
    };
    let jumped = |t: f64| (drive - 0.1 * press) * t;
    let cases: [(_, &dyn Fn(f64) -> f64); 2] =
        [(None, &jumped), (Some(Friction::constant(0.5)), &ramped)];
    for scheme in SCHEMES {
        for (from, expected) in &cases {
            let changes = friction(Friction::constant(0.1), from.clone());
            let (model, _) = two_steps(scheme, 200, changes);
            let (keep, _) = run_to_end(&model);
            let mut largest = 0.0_f64;
            for report in &keep.reports {
                let v = match report.step {
                    1 => 0.0,
                    _ => expected(report.step_time),
                };
                largest = largest.max((report.momentum.linear[0] / 2.0 - v).abs());
                let mu = report.contacts[0].friction_coefficient;
                let wanted = match (report.step, from) {
                    (1, _) => 0.5,
                    (_, None) => 0.1,
                    (_, Some(_)) => 0.5 - 0.4 * report.step_time / 0.4,
                };
                assert!(mu.is_nan() || (mu - wanted).abs() < 1e-12, "{mu} {wanted}");
            }
            let last = keep.reports.last().expect("reports");
            println!("{scheme:?} {from:?}: largest error of the speed {largest:.2e}");
            assert!(largest < 0.015, "{scheme:?} {from:?}: {largest}");
            assert!(last.energy.balance.abs() < 1e-9);
        }
    }
}

#[test]
fn friction_follows_an_amplitude() {
    // from 0.5 to 0.1 in the first half of 0.4, and back again to 0.5 in the rest
    let slope = slope().1;
    let mu = |t: f64| 0.1 + 0.4 * (t / 0.2 - 1.0).abs();
    for scheme in SCHEMES {
        let changes = friction(Friction::constant(0.1), Some(Friction::constant(0.5)));
        let (mut model, _) = two_steps(scheme, 200, changes);
        for change in &mut model.steps[1].contacts.friction {
            change.from.as_mut().expect("it ramps").amplitude = Some(model.amplitudes.len());
        }
        model.amplitudes.push(Amplitude {
            name: "TO AND FRO".into(),
            time: TimeBase::Step,
            curve: Curve::Linear(vec![(0.0, 0.0), (0.2, 1.0), (0.4, 0.0)]),
        });
        let (keep, _) = run_to_end(&model);
        // m v' = m g (sin - mu cos) while it slides
        let (mut v, mut largest, mut dissipated) = (0.0_f64, 0.0_f64, 0.0);
        for report in &keep.reports {
            if report.step == 2 {
                let t = report.step_time;
                let found = report.contacts[0].friction_coefficient;
                assert!(found.is_nan() || (found - mu(t)).abs() < 1e-12, "{found}");
                // the middle of the increment of 0.002
                let a = GRAVITY * (slope[0] + slope[1] * mu(t - 0.001));
                v = (v + 0.002 * a).max(0.0);
            }
            largest = largest.max((report.momentum.linear[0] / 2.0 - v).abs());
            let energy = &report.energy;
            assert!(energy.balance.abs() < 1e-9);
            assert!(
                energy.friction_dissipation >= dissipated - 1e-12,
                "{scheme:?}"
            );
            dissipated = energy.friction_dissipation;
        }
        println!("{scheme:?}: largest error of the speed {largest:.2e} beside {v:.2e}");
        assert!(v > 0.05 && largest < 0.015, "{scheme:?}: {largest} {v}");
    }
}

#[test]
fn surfaces_that_a_step_makes_rough_hold() {
    for scheme in SCHEMES {
        let (mut model, _) = block_on_base(0.2, slope().1, scheme);
        model.steps[0].contacts = friction(FrictionLaw::Rough.into(), None);
        let (keep, _) = run_to_end(&model);
        let slip = keep.reports.iter().map(|report| {
            let slips = report.nodal.slip.iter().filter(|slip| !slip.is_nan());
            slips.fold(0.0_f64, |most, slip| most.max(*slip))
        });
        let slip = slip.fold(0.0, f64::max);
        assert!(slip < 1e-12, "{scheme:?}: {slip:e}");
    }
}

#[test]
fn a_body_falls_freely_from_a_contact_that_is_removed() {
    for scheme in SCHEMES {
        let (model, _) = two_steps(scheme, 50, removed());
        let (keep, _) = run_to_end(&model);
        let at_rest = keep.reports.iter().rfind(|report| report.step == 1);
        let [x0, y0] = at_rest.expect("a step").momentum.linear.map(|p| p / 2.0);
        let (_, down) = slope();
        for report in keep.reports.iter().filter(|report| report.step == 2) {
            let [x, y] = report.momentum.linear.map(|p| p / 2.0);
            let t = report.step_time;
            let [ax, ay] = down.map(|e| GRAVITY * e * t);
            assert!(
                (x - x0 - ax).abs() < 1e-9 && (y - y0 - ay).abs() < 1e-9,
                "{scheme:?} {t}"
            );
            assert_eq!(report.contacts[0].closed, 0);
            assert!(report.energy.balance.abs() < 1e-9);
        }
        let last = keep.reports.last().expect("reports");
        assert!(last.bodies[1].center[1] < 0.21, "it has gone into the base");
    }
}

#[test]
fn a_contact_is_not_added_where_its_bodies_overlap() {
    let (mut model, _) = two_steps(SCHEMES[0], 50, removed());
    let mut third = model.steps[1].clone();
    third.contacts = ContactChanges::default();
    model.steps.push(third);
    let mut keep = Keep::default();
    let summary = run(&model, &mut keep).expect("the observer never fails");
    let Outcome::Stopped(failure) = summary.outcome else {
        panic!("{:?}", summary.outcome);
    };
    assert_eq!(failure.step, 3);
    let Cause::Overlaps { depth, .. } = failure.cause else {
        panic!("{:?}", failure.cause);
    };
    let (_, down) = slope();
    // down for 0.1 with g
    let expected = -down[1] * GRAVITY * 0.01 / 2.0;
    assert!((depth - expected).abs() < 2e-3, "{depth} {expected}");
}

#[test]
fn a_contact_is_added_that_was_removed_from_the_start() {
    for scheme in SCHEMES {
        let (mut model, _) = two_steps(scheme, 200, ContactChanges::default());
        model.steps[0].contacts = removed();
        for load in &mut model.steps[0].body_forces {
            load.magnitude = 0.0;
        }
        let (keep, _) = run_to_end(&model);
        let last = keep.reports.last().expect("reports");
        // without weight it stays where it is, and with it the base holds it
        let [_, y] = last.bodies[1].center;
        assert!((y - 0.25).abs() < 1e-3, "{scheme:?}: {y}");
        let closed = keep.reports.iter().map(|report| report.contacts[0].closed);
        assert_eq!(closed.max(), Some(9), "{scheme:?}");
    }
}

#[test]
fn in_a_static_step_the_forces_of_a_removed_contact_fade() {
    // The block lies on the base, and hangs on one side as the contact is taken away.
    let (mut model, block) = two_steps(SCHEMES[0], 200, removed());
    let hangs = |step: &mut Step| {
        for j in 0..=1 {
            for dof in [0, 1] {
                step.supports
                    .push(crate::blocks::fixed(2 * block.node(0, j) + dof));
            }
        }
        step.supports.sort_by_key(|support| support.dof);
        step.procedure = Procedure::Static;
        step.increments.dt = step.increments.period / 4.0;
    };
    model.steps.iter_mut().for_each(hangs);
    let (keep, _) = run_to_end(&model);
    let end_of = |step: usize| keep.reports.iter().rfind(|report| report.step == step);
    let (first, last) = (end_of(1).expect("a step"), end_of(2).expect("a step"));
    let pressed = first.contacts[0].normal;
    assert!(pressed > 10.0 && last.contacts[0].normal == 0.0);
    // the reaction takes over what the base carried, in proportion to the time of the step
    let held = |nodal: &stickslip::dynamics::NodalResults| {
        let nodes = (0..=1).map(|j| block.node(0, j));
        nodes.map(|node| nodal.reaction[2 * node + 1]).sum::<f64>()
    };
    let total = held(&last.nodal) - held(&first.nodal);
    assert!((total / pressed - 1.0).abs() < 1e-3, "{total} {pressed}");
    for report in keep.reports.iter().filter(|report| report.step == 2) {
        let part = report.step_time / model.steps[1].increments.period;
        let taken = held(&report.nodal) - held(&first.nodal);
        assert!((taken / total - part).abs() < 1e-3, "{taken} {part}");
        assert!(report.energy.balance.abs() < 1e-9);
    }
}

/// A body on springs goes as far as they let it where the pair that could touch it is removed: the reach of a search that
/// has nothing to look for is no limit.
#[test]
fn a_body_on_springs_moves_where_its_pair_is_removed() {
    let (keep, failure) = run_deck(
        "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n5, 0., -1.\n6, 1., -1.\n7, 1., 0.\n8, 0., 0.\n\
         11, -6., 1.\n12, 7., 1.\n13, 0., 7.\n14, 1., 7.\n*ELEMENT, TYPE=CPE4, ELSET=B\n1, 1, 2, 3, 4\n\
         *ELEMENT, TYPE=CPE4, ELSET=A\n2, 5, 6, 7, 8\n\
         *ELEMENT, TYPE=SPRINGA, ELSET=K\n11, 11, 4\n12, 12, 3\n13, 13, 4\n14, 14, 3\n*SPRING, ELSET=K\n\n5.\n\
         *NSET, NSET=HELD\n5, 6, 11, 12, 13, 14\n*BOUNDARY\nHELD, 1, 2\n\
         *SOLID SECTION, ELSET=B, MATERIAL=M\n1.\n*SOLID SECTION, ELSET=A, MATERIAL=M\n1.\n\
         *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SURFACE, NAME=SB\nB, S1\n*SURFACE, NAME=SA\nA, S3\n\
         *SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nSB, SA\n\
         *STEP, NLGEOM\n*STATIC\n0.25, 1.\n*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nSB, SA\n\
         *DLOAD\n1, P3, -0.3\n*END STEP\n",
    );
    assert_eq!(failure, None);
    // a force of 0.3 against two springs of 5 each
    let u = &keep.reports.last().expect("reports").state.u;
    for node in [2, 3] {
        let v = u[2 * node + 1];
        assert!((v - 0.03).abs() < 1e-4, "{v}");
    }
}
