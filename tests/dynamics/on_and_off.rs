//! Loads, motions and contacts that are put on and taken off: what is left is round-off, and no scale of anything.
//! See docs/theory/time.md, Convergence.

use stickslip::dynamics::{Energy, IncrementReport, RunSummary};

use crate::blocks::{Keep, run_to_end};
use crate::reading::read;

fn largest(report: &IncrementReport) -> f64 {
    let sizes = report.state.u.iter().map(|u| u.abs());
    sizes.fold(0.0, f64::max)
}

/// Largest displacement at the end beside the largest of the run.
fn left(keep: &Keep) -> f64 {
    let all = keep.reports.iter().map(largest).fold(0.0, f64::max);
    assert!(all > 0.0);
    largest(&keep.reports[keep.reports.len() - 1]) / all
}

/// A bar of two elements that its left end holds, with a node that its right end rides on.
fn cantilever(element: &str) -> String {
    format!(
        "*NODE\n1, 0., 0.\n2, 10., 0.\n3, 20., 0.\n4, 0., 1.\n5, 10., 1.\n6, 20., 1.\n9, 21., .4\n\
         *ELEMENT, TYPE={element}, ELSET=E\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n\
         *MATERIAL, NAME=M\n*ELASTIC\n210000., 0.3\n*DENSITY\n1.E-9\n\
         *SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n*SURFACE, NAME=RIGHT\n2, S2\n*BOUNDARY\n1, 1, 2\n4, 1, 2\n"
    )
}

const GRIP: &str = "*COUPLING, CONSTRAINT NAME=GRIP, REF NODE=9, SURFACE=RIGHT\n*KINEMATIC\n";

#[test]
fn static_loads_that_go_back_to_zero_leave_nothing() {
    let loads = [
        ("", "*CLOAD\n6, 2, ", [100.0, 0.0, 0.0]),
        (GRIP, "*CLOAD\n9, 6, ", [300.0, 0.0, 0.0]),
        ("", "*BOUNDARY\n6, 2, 2, ", [1.5, 0.0, 0.0]),
        (GRIP, "*BOUNDARY\n9, 6, 6, ", [0.1, -0.1, 0.0]),
    ];
    for element in ["CPE4", "CPE4I", "CPS4I", "CPE4H", "CPE4R"] {
        for (joint, load, values) in &loads {
            for dt in [1.0, 0.25, 0.05] {
                let step = |value: &f64| {
                    format!("*STEP, NLGEOM\n*STATIC\n{dt}, 1., , {dt}\n{load}{value}\n*END STEP\n")
                };
                let steps: String = values.iter().map(step).collect();
                let (keep, _) = run_to_end(&read(&(cantilever(element) + joint + &steps)));
                let left = left(&keep);
                assert!(left < 1e-12, "{element} {load} {dt}: {left:e}");
            }
        }
    }
}

/// A load of 1e-6 of the one before is no round-off of it.
#[test]
fn a_small_load_after_a_large_one_is_solved() {
    let step = |value: f64| format!("*STEP\n*STATIC\n1., 1.\n*CLOAD\n6, 2, {value:e}\n*END STEP\n");
    let end = |loads: &[f64]| {
        let steps: String = loads.iter().map(|value| step(*value)).collect();
        let (keep, _) = run_to_end(&read(&(cantilever("CPE4I") + &steps)));
        largest(&keep.reports[keep.reports.len() - 1])
    };
    let (alone, after) = (end(&[1e-4]), end(&[100.0, 1e-4]));
    assert!((after / alone - 1.0).abs() < 1e-8, "{after:e} {alone:e}");
}

#[test]
fn a_motion_that_decays_until_it_underflows_ends() {
    let (keep, summary) = run_to_end(&read(
        "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 2., 0.\n4, 2., 1.\n5, 1., 1.\n6, 0., 1.\n\
         *ELEMENT, TYPE=CPE4, ELSET=E\n1, 1, 2, 5, 6\n2, 2, 3, 4, 5\n\
         *MATERIAL, NAME=M\n*ELASTIC, TYPE=NEO HOOKE\n2.75, 0.374\n*DENSITY\n1.E-9\n\
         *SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n*BOUNDARY\n1, 1, 2\n6, 1, 2\n\
         *STEP, NLGEOM\n*STATIC\n1., 1.\n*BOUNDARY\n3, 1, 1, .2\n4, 1, 1, .2\n*END STEP\n\
         *STEP, NLGEOM, INC=1000\n*DYNAMIC, APPLICATION=QUASI-STATIC\n1.E-3, 60., 1.E-10, 1.\n\
         *BOUNDARY, OP=NEW\n1, 1, 2\n6, 1, 2\n*END STEP\n\
         *STEP, NLGEOM, INC=1000\n*DYNAMIC, APPLICATION=QUASI-STATIC\n1.E-3, 60., 1.E-10, 1.\n*END STEP\n",
    ));
    assert_eq!(summary.cutbacks, 0);
    assert!(left(&keep) < 1e-100, "{:e}", left(&keep));
}

/// Two blocks of one element, the upper one over the lower one by a gap.
fn blocks(gap: f64) -> String {
    let y = 1.0 + gap;
    let top = 2.0 + gap;
    format!(
        "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n\
         11, .1, {y}\n12, .9, {y}\n13, .9, {top}\n14, .1, {top}\n99, .5, 3.\n\
         *ELEMENT, TYPE=CPE4, ELSET=LOW\n1, 1, 2, 3, 4\n*ELEMENT, TYPE=CPE4, ELSET=UP\n2, 11, 12, 13, 14\n\
         *SURFACE, NAME=FLOOR\nLOW, S3\n*SURFACE, NAME=FOOT\nUP, S1\n*SURFACE, NAME=HEAD\nUP, S3\n\
         *MATERIAL, NAME=M\n*ELASTIC\n1000., .3\n*DENSITY\n1.\n\
         *SOLID SECTION, ELSET=LOW, MATERIAL=M\n1.\n*SOLID SECTION, ELSET=UP, MATERIAL=M\n1.\n\
         *SURFACE INTERACTION, NAME=I\n*FRICTION\n.3\n*CONTACT PAIR, INTERACTION=I\nFOOT, FLOOR\n\
         *BOUNDARY\n1, 1, 2\n2, 1, 2\n"
    )
}

/// Increments of a dynamic step of so many first increments, in which nothing happens after a static one.
fn at_rest(text: &str) -> RunSummary {
    let (keep, summary) = run_to_end(&read(text));
    let [.., last] = &keep.reports[..] else {
        panic!("no increments")
    };
    let before = keep.reports.iter().rfind(|report| report.step == 1);
    let before = before.expect("a static increment");
    let moved = before.state.u.iter().zip(&last.state.u);
    let moved = moved.map(|(p, q)| (p - q).abs()).fold(0.0, f64::max);
    assert!(moved < 1e-11 * largest(before), "{moved:e}");
    summary
}

/// The error of an increment is not measured beside round-off.
#[test]
fn a_body_in_equilibrium_rests_in_long_increments() {
    let dynamic = "*STEP, NLGEOM, INC=2000\n*DYNAMIC\n.001, .04\n*END STEP\n";
    let pressed = blocks(0.0)
        + "*BOUNDARY\n13, 1\n14, 1\n*STEP, NLGEOM\n*STATIC\n.25, 1.\n*DSLOAD\nHEAD, P, 6.\n*END STEP\n"
        + dynamic;
    let bent = cantilever("CPE4I")
        + "*STEP, NLGEOM\n*STATIC\n1., 1.\n*CLOAD\n6, 2, 100.\n*END STEP\n"
        + &dynamic.replace(".001, .04", "1.E-6, 4.E-5");
    for text in [pressed, bent] {
        let summary = at_rest(&text);
        assert!(summary.increments < 100, "{}", summary.increments);
        assert_eq!(summary.rejections, 0);
    }
}

/// Whether a balance is within its bound beside the energies, or is round-off.
fn is_balanced(energy: &Energy) -> bool {
    energy.balance.abs() <= 1e-8 * energy.scale || energy.balance.abs() <= energy.round_off
}

/// Energies of a body that is only moved are round-off: they are no scale of the balance.
#[test]
fn a_body_that_approaches_another_is_in_balance() {
    let ways = [
        "*BOUNDARY\n13, 1\n14, 1\n13, 2, 2, -.05\n14, 2, 2, -.05\n",
        // its head moves as another node, friction alone holds it across
        "*BOUNDARY\n99, 1\n99, 2, 2, -.05\n",
        // a rigid body
        "*BOUNDARY\n99, 1\n99, 6\n99, 2, 2, -.05\n",
    ];
    let joints = [
        "",
        "*EQUATION\n2\n13, 2, 1., 99, 2, -1.\n2\n14, 2, 1., 99, 2, -1.\n",
        "*RIGID BODY, REF NODE=99, ELSET=UP\n",
    ];
    for (joint, way) in joints.iter().zip(ways) {
        for dt in [0.05, 0.1] {
            let text = blocks(0.0123)
                + joint
                + &format!("*STEP, NLGEOM\n*STATIC\n{dt}, 1., , {dt}\n{way}*END STEP\n");
            let (keep, _) = run_to_end(&read(&text));
            let all: Vec<&Energy> = keep.reports.iter().map(|report| &report.energy).collect();
            let off = all.iter().position(|energy| !is_balanced(energy));
            assert_eq!(off, None, "{joint} {dt}");
            let [.., last] = all[..] else {
                panic!("no increments")
            };
            assert!(last.round_off < 1e-10 * last.scale, "{joint} {last:?}");
        }
    }
}

/// Weight and support do works that cancel: what they leave is no scale of the losses.
#[test]
fn a_block_that_tips_loses_little_beside_the_work_of_its_weight() {
    let text = blocks(0.0)
        .replace("1000., .3", "1.E7, .3")
        .replace("\n.3\n*CONTACT", "\n1.\n*CONTACT")
        + "*STEP\n*STATIC\n1., 1.\n*DLOAD\nUP, GRAV, 10., 0., -1.\n*END STEP\n\
           *STEP\n*STATIC\n.05, 1., 1.E-5, .05\n*BOUNDARY\n14, 1, 1, .01\n*END STEP\n";
    let (keep, _) = run_to_end(&read(&text));
    let [.., last] = &keep.reports[..] else {
        panic!("no increments")
    };
    let energy = &last.energy;
    let part = energy.normal_contact_work.abs() / energy.scale;
    assert!(part < 0.05, "{part}");
}
