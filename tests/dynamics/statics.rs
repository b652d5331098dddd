//! Static steps: bodies that contact alone holds, loads that have no equilibrium, steps in any order.

use std::fmt::Write;

use crate::blocks::Keep;
use crate::reading::read;
use stickslip::dynamics::{Cause, Failure, Outcome, run};
use stickslip::prepare::PreparedModel;

/// A run of a deck: what it has reported, and why it stopped.
pub(crate) fn run_deck(text: &str) -> (Keep, Option<Failure>) {
    let mut keep = Keep::default();
    let summary =
        run(&PreparedModel::new(read(text)), &mut keep).expect("the observer never fails");
    let failure = match summary.outcome {
        Outcome::Stopped(failure) => Some(*failure),
        _ => None,
    };
    (keep, failure)
}

/// A square that nothing but contact holds on a fixed one, and its steps.
fn on_floor(height: f64, friction: f64, steps: &str) -> String {
    let [low, high] = [height, height + 1.0];
    format!(
        "*NODE\n1, -2., -1.\n2, 4., -1.\n3, 4., 0.\n4, -2., 0.\n\
         5, 0., {low:?}\n6, 1., {low:?}\n7, 1., {high:?}\n8, 0., {high:?}\n\
         *ELEMENT, TYPE=CPE4, ELSET=FLOOR\n1, 1, 2, 3, 4\n*ELEMENT, TYPE=CPE4, ELSET=BODY\n2, 5, 6, 7, 8\n\
         *NSET, NSET=ROOF\n7, 8\n*NSET, NSET=GROUND\n1, 2, 3, 4\n\
         *SURFACE, NAME=TOP\nFLOOR, S3\n*SURFACE, NAME=SOLE\nBODY, S1\n\
         *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n\
         *SOLID SECTION, ELSET=FLOOR, MATERIAL=M\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n\
         *SURFACE INTERACTION, NAME=DRY\n*FRICTION\n{friction:?}\n*CONTACT PAIR, INTERACTION=DRY\nSOLE, TOP\n\
         *BOUNDARY\nGROUND, 1, 2\n{steps}"
    )
}

const WEIGHT: &str = "*STEP, NLGEOM\n*STATIC\n1., 1.\n*DLOAD\nBODY, GRAV, 1., 0., -1.\n*END STEP\n";

/// Gravity at the angle of a slope of 20 degrees.
fn slope() -> String {
    let (sin, cos) = 20.0_f64.to_radians().sin_cos();
    format!(
        "*STEP, NLGEOM\n*STATIC\n1., 1.\n*DLOAD\nBODY, GRAV, 1., {sin:?}, {:?}\n*END STEP\n",
        -cos
    )
}

#[test]
fn a_block_slides_on_a_slope_where_friction_ends() {
    let tangent = 20.0_f64.to_radians().tan();
    let (keep, failure) = run_deck(&on_floor(0.0, tangent + 1e-5, &slope()));
    assert_eq!(failure, None);
    let last = keep.reports.last().expect("reports");
    assert!(last.solver.passes <= 5, "{}", last.solver.passes);
    let weight = last.contacts[0].force[0].hypot(last.contacts[0].force[1]);
    assert!((weight - 1.0).abs() < 1e-9, "{weight}");
    let (_, failure) = run_deck(&on_floor(0.0, tangent - 1e-5, &slope()));
    let failure = failure.expect("there is no equilibrium");
    assert_eq!(failure.passes.len(), 0, "it is seen in the first pass");
    let Cause::Unbalanceable(unbalanced) = failure.cause else {
        panic!("{:?}", failure.cause);
    };
    assert!(
        unbalanced.force[0] > 0.0 && unbalanced.motion[0] > 0.0,
        "down the slope"
    );
}

#[test]
fn a_weak_spring_takes_over_from_friction() {
    let spring = "*ELEMENT, TYPE=SPRING1, ELSET=SPRING\n3, 5\n*SPRING, ELSET=SPRING\n1\n0.1\n*NSET, NSET=ROOF";
    let pushed = "*STEP, NLGEOM\n*STATIC\n0.05, 1.\n*DLOAD\nBODY, GRAV, 1., 0., -1.\nBODY, BX, 0.5\n*END STEP\n";
    let deck = on_floor(0.0, 0.3, &[WEIGHT, pushed].concat());
    let stiff = deck.replace("1000., 0.3", "1e7, 0.3");
    let (keep, failure) = run_deck(&stiff.replace("*NSET, NSET=ROOF", spring));
    assert_eq!(failure, None);
    assert!(keep.cutbacks.is_empty());
    // the push less friction
    let way = keep.reports.last().expect("reports").state.u[8];
    assert!((way - (0.5 - 0.3) / 0.1).abs() < 1e-6, "{way}");
}

#[test]
fn friction_and_loads_that_follow_leave_passes_quadratic() {
    // pressed by a pressure and sheared, on two supports; 9 and 10 passes without their part of the tangent
    for deck in ["path_1", "supports"] {
        let path = format!(
            "{}/verification/static/{deck}.inp",
            env!("CARGO_MANIFEST_DIR")
        );
        let (keep, failure) = run_deck(&std::fs::read_to_string(path).expect("a deck"));
        assert_eq!(failure, None);
        for report in &keep.reports {
            assert!(
                report.solver.passes <= 5,
                "{deck}: {}",
                report.solver.passes
            );
        }
    }
}

#[test]
fn centrifugal_forces_leave_passes_quadratic() {
    // 10 passes without the change of the forces
    let nodes: String = (0..=10)
        .map(|i| format!("{}, 0.{i}, 0.\n{}, 0.{i}, 0.1\n", i + 1, i + 21))
        .collect();
    let elements: String = (1..=10)
        .map(|i| format!("{i}, {i}, {}, {}, {}\n", i + 1, i + 21, i + 20))
        .collect();
    let deck = format!(
        "*NODE\n{}*ELEMENT, TYPE=CPS4, ELSET=BAR\n{elements}\
         *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*DENSITY\n1.\n*SOLID SECTION, ELSET=BAR, MATERIAL=M\n\
         *NSET, NSET=AXIS\n1, 21\n*NSET, NSET=LOW, GENERATE\n1, 11\n*BOUNDARY\nAXIS, 1\nLOW, 2\n\
         *STEP, NLGEOM\n*STATIC, DIRECT\n1., 1.\n*DLOAD\nBAR, CENTRIF, 250., 0., 0., 0., 0., 0., 1.\n*END STEP\n",
        nodes.replace("0.10,", "1.0,")
    );
    let (keep, failure) = run_deck(&deck);
    assert_eq!(failure, None);
    let last = keep.reports.last().expect("reports");
    assert!(last.solver.passes <= 5, "{}", last.solver.passes);
}

#[test]
fn a_block_falls_to_the_floor_that_is_near() {
    let (keep, failure) = run_deck(&on_floor(0.3, 0.3, WEIGHT));
    assert_eq!(failure, None);
    let last = keep.reports.last().expect("reports");
    assert!((last.contacts[0].force[1] - 1.0).abs() < 1e-9);
    assert!(last.state.v.iter().all(|&v| v == 0.0));
    assert!(last.energy.balance.abs() < 1e-10);
}

#[test]
fn no_load_leaves_a_free_body_where_it_is() {
    let (keep, failure) = run_deck(&on_floor(0.0, 0.3, "*STEP, NLGEOM\n*STATIC\n*END STEP\n"));
    assert_eq!(failure, None);
    let last = keep.reports.last().expect("reports");
    assert!(last.state.u.iter().all(|&u| u == 0.0));
}

#[test]
fn a_dynamic_step_goes_on_from_an_equilibrium_without_a_kick() {
    let steps = format!(
        "{WEIGHT}*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 0.2\n*END STEP\n*STEP, NLGEOM\n*STATIC\n0.5, 1.\n\
         *BOUNDARY\nROOF, 2, 2, -0.05\n*END STEP\n"
    );
    let (keep, failure) = run_deck(&on_floor(0.0, 0.3, &steps));
    assert_eq!(failure, None);
    let energy = keep.reports[1].energy.strain;
    for report in keep.reports.iter().filter(|report| report.step == 2) {
        assert!(
            report.energy.kinetic < 1e-18 * energy,
            "{:e}",
            report.energy.kinetic
        );
    }
    let last = keep.reports.last().expect("reports");
    assert!(last.contacts[0].force[1] > 10.0);
    assert!(last.energy.balance.abs() < 1e-10 * last.energy.strain);
}

#[test]
fn a_support_that_goes_gives_its_force_back_over_the_step() {
    let steps = "*STEP, NLGEOM\n*STATIC\n0.5, 1.\n*BOUNDARY\nROOF, 2, 2, -0.05\nROOF, 1, 1\n*END STEP\n\
                 *STEP, NLGEOM\n*STATIC, DIRECT\n0.5, 1.\n*BOUNDARY, OP=NEW\nGROUND, 1, 2\n*DLOAD\nBODY, GRAV, 1., 0., -1.\n\
                 *END STEP\n";
    let (keep, failure) = run_deck(&on_floor(0.0, 0.3, steps));
    assert_eq!(failure, None);
    let forces: Vec<f64> = keep
        .reports
        .iter()
        .map(|r| r.contacts[0].force[1])
        .collect();
    let [.., pressed, half, last] = forces[..] else {
        panic!("increments");
    };
    assert!(
        (half - (pressed / 2.0 + 0.5)).abs() < 1e-9 * pressed,
        "{half} {pressed}"
    );
    assert!((last - 1.0).abs() < 1e-9 * pressed);
    let energy = keep.reports.last().expect("reports").energy;
    assert!(energy.balance.abs() < 1e-10 * pressed);
}

/// A block that friction alone holds on the crown of a shallow arch: the arch does not snap through unnoticed.
#[test]
fn an_arch_under_a_block_that_contact_alone_holds_does_not_jump() {
    let (columns, half) = (16, 5.0_f64);
    let mut nodes = String::new();
    for k in 0..3 * (columns + 1) {
        let (i, j) = (k % (columns + 1), k / (columns + 1));
        let x = half * (2.0 * i as f64 / columns as f64 - 1.0);
        let y = 0.5 * (1.0 - (x / half).powi(2)) + 0.1 * (j as f64 - 2.0);
        nodes += &format!("{}, {x:?}, {y:?}\n", k + 1);
    }
    let mut elements = String::new();
    for e in 0..2 * columns {
        let a = 1 + e % columns + (columns + 1) * (e / columns);
        elements += &format!(
            "{}, {a}, {}, {}, {}\n",
            e + 1,
            a + 1,
            a + columns + 2,
            a + columns + 1
        );
    }
    let ends = "1, 17, 18, 34, 35, 51";
    let text = format!(
        "*NODE\n{nodes}101, -0.5, 0.5\n102, 0.5, 0.5\n103, 0.5, 1.\n104, -0.5, 1.\n\
         *ELEMENT, TYPE=CPE4I, ELSET=A\n{elements}*ELEMENT, TYPE=CPE4, ELSET=B\n101, 101, 102, 103, 104\n\
         *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n*SOLID SECTION, ELSET=A, MATERIAL=M\n1.\n\
         *SOLID SECTION, ELSET=B, MATERIAL=M\n1.\n*SURFACE, NAME=SA\nA,\n*SURFACE, NAME=SB\nB,\n\
         *NSET, NSET=ENDS\n{ends}\n*SURFACE INTERACTION, NAME=DRY\n*FRICTION\n0.5\n\
         *CONTACT PAIR, INTERACTION=DRY\nSA, SB\nSB, SA\n*BOUNDARY\nENDS, 1, 2\n\
         *STEP, NLGEOM\n*STATIC\n0.05, 1., 1e-4, 0.1\n*DLOAD\nB, GRAV, 4., 0., -1.\n*END STEP\n"
    );
    let (keep, failure) = run_deck(&text);
    assert!(failure.is_some(), "the block is too heavy");
    let last = keep.reports.last().expect("reports");
    // node 43 is the crown
    assert!(
        last.time > 0.01 && last.state.u[85] > -0.5,
        "{} {}",
        last.time,
        last.state.u[85]
    );
}

/// A block of two by two elements upon the nodes of a bed of four by two, or `deep` behind them; `side` -1 mirrors both
/// about the axis y.
fn on_matching_nodes(
    side: f64,
    [e, nu, mu]: [f64; 3],
    (deep, pairs): (f64, &str),
    steps: &str,
) -> String {
    let nodes = |first: usize, (columns, from): (usize, [f64; 2])| -> String {
        let node = |k: usize| {
            let (i, j) = (k % columns, k / columns);
            let x = side * (from[0] + 0.5 * i as f64);
            format!("{}, {x:?}, {:?}\n", first + k, from[1] + 0.5 * j as f64)
        };
        (0..3 * columns).map(node).collect()
    };
    let elements = |first: usize, (node, columns): (usize, usize)| -> String {
        let element = |k: usize| {
            let (i, j) = (k % (columns - 1), k / (columns - 1));
            let a = node + i + columns * j;
            let [a, b, c, d] = match side > 0.0 {
                true => [a, a + 1, a + columns + 1, a + columns],
                false => [a + 1, a, a + columns, a + columns + 1],
            };
            format!("{}, {a}, {b}, {c}, {d}\n", first + k)
        };
        (0..2 * (columns - 1)).map(element).collect()
    };
    format!(
        "*NODE\n{}{}*ELEMENT, TYPE=CPS4, ELSET=BED\n{}*ELEMENT, TYPE=CPS4, ELSET=BLOCK\n{}\
         *NSET, NSET=GROUND\n1, 2, 3, 4, 5\n*NSET, NSET=ROOF\n27, 28, 29\n\
         *SURFACE, NAME=TOP\n5, S3\n6, S3\n7, S3\n8, S3\n*SURFACE, NAME=SOLE\n11, S1\n12, S1\n\
         *MATERIAL, NAME=M\n*ELASTIC\n{e:?}, {nu:?}\n*DENSITY\n1.\n\
         *SOLID SECTION, ELSET=BED, MATERIAL=M\n*SOLID SECTION, ELSET=BLOCK, MATERIAL=M\n\
         *SURFACE INTERACTION, NAME=DRY\n*FRICTION\n{mu:?}\n*CONTACT PAIR, INTERACTION=DRY\n{pairs}\
         *BOUNDARY\nGROUND, 1, 2\n{steps}",
        nodes(1, (5, [0.0, 0.0])),
        nodes(21, (3, [0.5, 1.0 - deep])),
        elements(1, (1, 5)),
        elements(11, (21, 3)),
    )
}

/// Asserts that a deck and its mirror image end alike, but for a part of the largest displacement.
fn assert_mirrored(decks: [String; 2], most: f64, what: &str) {
    let [right, left] = decks.map(|deck| {
        let (keep, failure) = run_deck(&deck);
        assert_eq!(failure, None, "{what}");
        keep.reports.last().expect("reports").state.u.clone()
    });
    let largest = right.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
    for (dof, (right, left)) in right.iter().zip(&left).enumerate() {
        let mirrored = if dof % 2 == 0 { -left } else { *left };
        let error = (right - mirrored).abs() / largest;
        assert!(error < most, "{what} {dof}: {right} {mirrored}");
    }
}

/// A node at a vertex of a face that hardly turns is on both of its segments: the normal of either one would lean to its
/// side, and round-off would choose it in every pass.
#[test]
fn a_block_on_matching_nodes_is_pushed_alike_from_both_sides() {
    let cases = [
        [1e3, 0.3, 0.3],
        [1e3, 0.1, 0.3],
        [1e3, 0.2, 0.3],
        [300.0, 0.3, 0.3],
        [1e3, 0.3, 0.2],
        [1e3, 0.3, 0.4],
    ];
    for case in cases {
        let decks = [1.0, -1.0].map(|side| {
            let steps = format!(
                "*STEP, NLGEOM\n*STATIC\n0.25, 1.\n*DLOAD\nBLOCK, GRAV, 9.81, 0., -1.\n*END STEP\n\
                 *STEP, NLGEOM\n*STATIC\n0.25, 1.\n*CLOAD\nROOF, 1, {:?}\n*END STEP\n",
                0.1 * side
            );
            on_matching_nodes(side, case, (0.0, "SOLE, TOP\n"), &steps)
        });
        assert_mirrored(decks, 1e-9, &format!("{case:?}"));
    }
}

/// Pairs in both orders that face each other may share a force in many ways, each of which obeys the equations
/// (docs/theory/complementarity.md). In large increments the iteration decides which:
/// for ten stiffnesses from 500 to 2000 the two sides differ by
/// 2e-14 to 7e-6 of the largest displacement in static steps, and in dynamic ones by 2e-3 at 500, 1e-8 at 800 and less above.
#[test]
fn a_fit_on_matching_nodes_is_pressed_apart_alike_on_both_sides() {
    let [dynamic, fixed] = ["*DYNAMIC, DIRECT\n0.005, 0.05", "*STATIC\n0.25, 1."];
    let [one_order, both_orders] = ["SOLE, TOP\n", "SOLE, TOP\nTOP, SOLE\n"];
    for (pairs, procedure, most) in [
        (one_order, dynamic, 1e-9),
        (one_order, fixed, 1e-9),
        (both_orders, dynamic, 1e-9),
        (both_orders, fixed, 1e-4),
    ] {
        for stiffness in [900.0, 1e3, 1100.0, 1200.0] {
            let decks = [1.0, -1.0].map(|side| {
                let steps = format!(
                    "ROOF, 2\n*STEP, NLGEOM\n{procedure}\n*CONTACT INTERFERENCE, SHRINK\nSOLE, TOP\n\
                     *CLOAD\nROOF, 1, {:?}\n*END STEP\n",
                    0.1 * side
                );
                on_matching_nodes(side, [stiffness, 0.3, 0.3], (0.01, pairs), &steps)
            });
            assert_mirrored(decks, most, &format!("{procedure} {pairs} {stiffness}"));
        }
    }
}

/// Of the nodes at a sharp corner of a punch those under it are held, however steep the surface becomes beside it, and those
/// beside it are free, however long the lines of the punch are.
#[test]
fn nodes_under_a_punch_are_held_and_nodes_beside_it_are_free() {
    // with faces that are small beside the corner, and with one that reaches far beyond it
    nodes_are_held([0.0, 0.5, 0.9375, 1.0, 1.0625, 1.125, 1.5, 2.0], 4);
    nodes_are_held([0.0, 0.2, 0.35, 0.5, 0.7, 1.25, 1.6, 2.0], 5);
}

/// Presses a punch of half the width 1 into ground with nodes at `x`, of which the first so many are under it.
fn nodes_are_held(x: [f64; 8], under: usize) {
    let mut nodes = String::from("*NODE\n");
    let mut elements = String::from("*ELEMENT, TYPE=CPE4, ELSET=E\n");
    for (j, y) in [-1.0, -0.25, -0.0625, 0.0].iter().enumerate() {
        for (i, x) in x.iter().enumerate() {
            let n = 10 * j + i + 1;
            writeln!(nodes, "{n}, {x:?}, {y:?}").expect("text");
            if i < 7 && j < 3 {
                writeln!(elements, "{n}, {n}, {}, {}, {}", n + 1, n + 11, n + 10).expect("text");
            }
        }
    }
    let pressed = |height: f64, depth: f64| {
        run_deck(&format!(
            "{nodes}{elements}*NSET, NSET=BASE, GENERATE\n1, 8\n*NSET, NSET=AXIS\n1, 11, 21, 31\n\
             *ELSET, ELSET=TOP, GENERATE\n21, 27\n*SURFACE, NAME=GROUND\nTOP, S3\n*NODE\n99, 0., 1.\n\
             *MATERIAL, NAME=M\n*ELASTIC\n1000., .3\n*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n\
             *SURFACE, NAME=PUNCH, TYPE=SEGMENTS\nSTART, 1., {height:?}\nLINE, 1., 0.\nLINE, -1., 0.\n\
             *RIGID BODY, ANALYTICAL SURFACE=PUNCH, REF NODE=99\n\
             *SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nGROUND, PUNCH\n\
             *STEP\n*STATIC\n.25, 1.\n*BOUNDARY\nBASE, 2, 2\nAXIS, 1, 1\n99, 1, 1\n99, 2, 2, -{depth:?}\n*END STEP\n"
        ))
    };
    for (height, depth) in [(0.2, 0.02), (1.0, 0.02), (50.0, 0.02), (1.0, 0.15)] {
        let (keep, failure) = pressed(height, depth);
        assert_eq!(failure, None, "{height} {depth}");
        for report in keep.reports.iter().skip(1) {
            let force = |i: usize| report.nodal.contact_force[2 * (24 + i) + 1];
            let is_closed: Vec<bool> = (0..8).map(|i| force(i) != 0.0).collect();
            let under: Vec<bool> = (0..8).map(|i| i < under).collect();
            assert_eq!(is_closed, under, "{height} {depth} {}", report.time);
        }
    }
}
