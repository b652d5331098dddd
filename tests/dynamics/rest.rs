//! Bodies that come to rest stay at rest: what is left of a motion is nothing, and is no scale of anything.

use crate::blocks::{Keep, run_to_end};
use crate::reading::read;

/// A block of `nx` x `ny` Q4 with its corner at the origin given, its nodes and elements numbered from the numbers
/// given.
fn block(
    [x, y]: [f64; 2],
    [width, height]: [f64; 2],
    (nx, ny): (usize, usize),
    (node, element): (usize, usize),
) -> (String, String) {
    let (mut nodes, mut elements) = (String::new(), String::new());
    for (j, i) in (0..=ny).flat_map(|j| (0..=nx).map(move |i| (j, i))) {
        let at = [
            x + width * i as f64 / nx as f64,
            y + height * j as f64 / ny as f64,
        ];
        let [x, y] = at;
        nodes += &format!("{}, {x:.4}, {y:.4}\n", node + j * (nx + 1) + i);
    }
    for (j, i) in (0..ny).flat_map(|j| (0..nx).map(move |i| (j, i))) {
        let n = node + j * (nx + 1) + i;
        elements += &format!(
            "{}, {n}, {}, {}, {}\n",
            element + j * nx + i,
            n + 1,
            n + nx + 2,
            n + nx + 1
        );
    }
    (nodes, elements)
}

/// What is special about a block on a floor.
struct Case {
    element: &'static str,
    material: &'static str,
    settings: &'static str,
    friction: f64,
    contact: &'static str,
    is_held: bool,
}

const ELASTIC: &str = "*ELASTIC\n1.e6, .3";
const RUBBER: &str = "*HYPERELASTIC, NEO HOOKE\n192307.69, 2.4e-6";
const PAIR: &str = "*CONTACT PAIR, INTERACTION=D\nFOOT, TOP\n";
const TWO_PASSES: &str =
    "*CONTACT PAIR, INTERACTION=D\nFOOT, TOP\n*CONTACT PAIR, INTERACTION=D\nTOP, FOOT\n";
const GENERAL: &str =
    "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT PROPERTY ASSIGNMENT\n, , D\n";

const CASE: Case = Case {
    element: "CPS4",
    material: ELASTIC,
    settings: "",
    friction: 0.2,
    contact: PAIR,
    is_held: true,
};

/// A block that slides on a long floor with the speed 4; both are damped.
fn sliding_block(case: &Case, damping: &str, increments: usize) -> Keep {
    let (floor, of_floor) = block([-1.0, -0.3], [12.0, 0.3], (60, 1), (1, 1));
    let (body, of_body) = block([0.0, 0.0], [0.6, 0.2], (4, 2), (123, 61));
    let Case {
        element,
        material,
        settings,
        friction,
        contact,
        is_held,
    } = case;
    let held = if *is_held {
        "*BOUNDARY\nHELD, 1, 2\n"
    } else {
        ""
    };
    let gravity = if *is_held {
        "*DLOAD\nUP, GRAV, 10., 0., -1.\n"
    } else {
        ""
    };
    let period = 0.002 * increments as f64;
    let settings = match settings.is_empty() {
        true => String::new(),
        false => format!("*STICKSLIP, {settings}\n"),
    };
    let keep = run_to_end(&read(&format!(
        "*NODE\n{floor}*NODE, NSET=BODY\n{body}*NSET, NSET=HELD, GENERATE\n1, 122, 1\n\
         *ELEMENT, TYPE={element}, ELSET=LOW\n{of_floor}*ELEMENT, TYPE={element}, ELSET=UP\n{of_body}\
         *SURFACE, NAME=TOP\nLOW, S3\n*SURFACE, NAME=FOOT\n61, S1\n62, S1\n63, S1\n64, S1\n\
         *MATERIAL, NAME=M\n{material}\n*DENSITY\n1.\n*DAMPING, {damping}\n\
         *SOLID SECTION, ELSET=LOW, MATERIAL=M\n*SOLID SECTION, ELSET=UP, MATERIAL=M\n\
         *SURFACE INTERACTION, NAME=D\n*FRICTION\n{friction}\n{contact}{held}\
         *INITIAL CONDITIONS, TYPE=VELOCITY\nBODY, 1, 4.\n\
         *STEP, NLGEOM, INC=50000\n*DYNAMIC, DIRECT\n.002, {period}\n{settings}{gravity}*END STEP\n"
    )))
    .0;
    assert_eq!(keep.cutbacks.len(), 0);
    keep
}

/// Largest displacement in the last twenty increments: that of a block that still slid would be 0.1.
fn last_motion(keep: &Keep) -> f64 {
    let [before, end] = [keep.reports.len() - 20, keep.reports.len() - 1];
    let both = [before, end].map(|at| &keep.reports[at].state.u);
    let moved = both[0].iter().zip(both[1]).map(|(p, q)| (p - q).abs());
    moved.fold(0.0, f64::max)
}

/// The motion of the block dies away until it underflows, a node lying beside the end of a segment.
#[test]
fn a_block_that_has_slid_to_rest_stays_there() {
    let keep = sliding_block(&CASE, "BETA=1e-3", 1250);
    assert!(last_motion(&keep) < 1e-11, "{:e}", last_motion(&keep));
}

#[test]
fn every_option_lets_a_block_rest() {
    let with = |settings| Case { settings, ..CASE };
    let cases = [
        with("SCHEME=SS22"),
        with("IMPACT TIME=EVENT"),
        with("LANDING=RETURN"),
        with("CONTACT MASS=REDISTRIBUTED, LANDING=RETURN"),
        with("IMPACT TIME=EVENT, SCHEME=SS22"),
        Case {
            contact: TWO_PASSES,
            ..CASE
        },
        Case {
            contact: GENERAL,
            ..with("CONTACT MASS=REDISTRIBUTED")
        },
        Case {
            element: "CPE4",
            material: RUBBER,
            ..CASE
        },
        Case {
            friction: 0.0,
            contact: TWO_PASSES,
            ..CASE
        },
    ];
    // the mass-proportional part stops the block without friction too
    for case in &cases {
        let keep = sliding_block(case, "ALPHA=100., BETA=1e-3", 500);
        let moved = last_motion(&keep);
        println!("{}: {moved:e}", case.settings);
        assert!(moved < 1e-8, "{} {moved:e}", case.settings);
    }
}

#[test]
fn a_body_in_space_comes_to_rest_for_good() {
    for settings in ["", "SCHEME=SS22", "IMPACT TIME=EVENT"] {
        let case = Case {
            settings,
            is_held: false,
            ..CASE
        };
        let keep = sliding_block(&case, "ALPHA=500., BETA=1e-3", 900);
        assert!(last_motion(&keep) < 1e-12, "{settings}");
    }
}

/// The load on one end of two bars reaches their contact, far away, as 1e-300: an implicit increment leaves nothing
/// at rest.
#[test]
fn a_load_far_away_does_not_underflow_at_a_contact() {
    let h = 0.0125;
    for friction in [0.0, 0.3] {
        let (below, of_below) = block([0.0, 0.0], [h, 5.0], (1, 400), (1, 1));
        let (above, of_above) = block([0.0, 5.0], [h, 5.0], (1, 400), (803, 401));
        let tie = |n: usize, dof: usize| format!("2\n{}, {dof}, 1., {n}, {dof}, -1.\n", n + 1);
        let rows = (3..1604).step_by(2);
        let ties: String = rows.flat_map(|n| [tie(n, 1), tie(n, 2)]).collect();
        let keep = run_to_end(&read(&format!(
            "*NODE\n{below}{above}*ELEMENT, TYPE=CPE4, ELSET=BARS\n{of_below}{of_above}\
             *MATERIAL, NAME=M\n*ELASTIC\n10000, 0\n*DENSITY\n1\n*SOLID SECTION, ELSET=BARS, MATERIAL=M\n\
             *EQUATION\n{ties}*SURFACE, NAME=U\n400, S3\n*SURFACE, NAME=L\n401, S1\n*SURFACE, NAME=TOP\n800, S3\n\
             *SURFACE INTERACTION, NAME=D\n*FRICTION\n{friction}\n\
             *CONTACT PAIR, INTERACTION=D\nL, U\n*CONTACT PAIR, INTERACTION=D\nU, L\n\
             *BOUNDARY\n1, 1, 2\n2, 1, 2\n*AMPLITUDE, NAME=P, DEFINITION=SMOOTH STEP\n0., 0., 1.5, 1.\n\
             *STEP, NLGEOM, INC=1000\n*DYNAMIC, DIRECT\n8.83883476483184e-05, 0.0053\n\
             *DSLOAD, AMPLITUDE=P\nTOP, P, 2.\n*END STEP\n"
        )))
        .0;
        assert_eq!(keep.cutbacks.len(), 0);
    }
}

#[test]
fn a_motion_that_ends_with_a_static_step_gives_the_next_step_no_velocity() {
    let (nodes, elements) = block([0.0, 0.0], [1.0, 1.0], (2, 2), (1, 1));
    let motions = [
        "*BOUNDARY, AMPLITUDE=A\nTOP, 2, 2, -0.01\n",
        "*BOUNDARY, AMPLITUDE=A\n20, 2, 2, -0.01\n",
    ];
    let rigid = "*NODE\n20, .5, 1.\n*RIGID BODY, TIE NSET=TOP, REF NODE=20\n";
    for definition in ["TABULAR", "SMOOTH STEP"] {
        for (body, motion) in ["", rigid].into_iter().zip(motions) {
            let held = if body.is_empty() {
                ""
            } else {
                "20, 1, 1\n20, 6, 6\n"
            };
            let text = format!(
                "*NODE\n{nodes}*NSET, NSET=FOOT\n1, 2, 3\n*NSET, NSET=TOP\n7, 8, 9\n\
                 *ELEMENT, TYPE=CPE4, ELSET=E\n{elements}*SOLID SECTION, ELSET=E, MATERIAL=M\n\
                 *MATERIAL, NAME=M\n{ELASTIC}\n*DENSITY\n1.e3\n{body}\
                 *AMPLITUDE, NAME=A, TIME=TOTAL TIME, DEFINITION={definition}\n0., 0., .6, .3, 1., 1.\n\
                 *BOUNDARY\nFOOT, 1, 2\n{held}\
                 *STEP, NLGEOM\n*STATIC\n0.5, 1.\n{motion}*END STEP\n\
                 *STEP, NLGEOM\n*DYNAMIC, DIRECT\n1.e-3, 2.e-2\n*END STEP\n"
            );
            let (keep, _) = run_to_end(&read(&text));
            for report in &keep.reports {
                let energy = &report.energy;
                let is_at_rest = energy.kinetic <= 1e-20 * energy.strain;
                assert!(is_at_rest, "{definition} {body}: {:e}", energy.kinetic);
            }
        }
    }
}

/// Elements with one integration point flow in a static step, strain and hourglass modes, and then rest on their yield curve.
#[test]
fn reduced_metals_that_have_flowed_rest_in_whole_increments() {
    let (nodes, elements) = block([1.0, 0.0], [1.0, 1.0], (2, 2), (1, 1));
    for (family, thickness) in [("CPE4R", "1.\n"), ("CPS4R", "1.\n"), ("CAX4R", "")] {
        // a back strain leaves the stress of an increment in the frame of its start
        for (hardening, left) in [("ISOTROPIC", 1e-20), ("KINEMATIC", 1e-15)] {
            let text = format!(
                "*NODE\n{nodes}*NSET, NSET=FOOT\n1, 2, 3\n*NSET, NSET=TOP\n7, 8, 9\n\
                 *ELEMENT, TYPE={family}, ELSET=E\n{elements}*SOLID SECTION, ELSET=E, MATERIAL=M\n{thickness}\
                 *MATERIAL, NAME=M\n*ELASTIC\n1000., .3\n*PLASTIC, HARDENING={hardening}\n2., 0.\n12., .2\n\
                 *DENSITY\n1.\n*BOUNDARY\nFOOT, 1, 2\n\
                 *STEP, NLGEOM\n*STATIC\n.25, 1.\n*BOUNDARY\nTOP, 1, 1, .03\n*END STEP\n\
                 *STEP, NLGEOM\n*DYNAMIC, DIRECT\n.01, .1\n*END STEP\n"
            );
            let (keep, _) = run_to_end(&read(&text));
            let rest: Vec<_> = (keep.reports.iter().filter(|report| report.time > 1.0)).collect();
            assert_eq!(rest.len(), 10, "{family} {hardening}");
            for report in rest {
                let energy = &report.energy;
                assert!(energy.material_dissipation > 0.0);
                assert!(
                    energy.kinetic <= left * energy.strain,
                    "{family} {hardening} {:e}",
                    energy.kinetic
                );
            }
        }
    }
}
