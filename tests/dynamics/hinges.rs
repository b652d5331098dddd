//! Hinges between bodies: linkages with their energy, momenta and equations of motion.

use std::path::Path;

use stickslip::dynamics::IncrementReport;
use stickslip::model::Model;

use crate::blocks::run_to_end;
use crate::energies::{energy, largest, unbalanced};
use crate::reading::{read, try_read};

/// Messages of a deck with errors.
fn errors(text: &str) -> String {
    let (model, _, messages) = try_read(text);
    assert!(model.is_none());
    messages
}

/// A bar of length 1 and mass 1 from a point, at an angle: its nodes are `first` and `first + 1`, its other end.
fn bar(first: usize, [x, y]: [f64; 2], angle: f64, reference: &str) -> String {
    let (sin, cos) = angle.sin_cos();
    let at = |s: f64, t: f64| format!("{:?}, {:?}", x + s * cos - t * sin, y + s * sin + t * cos);
    let name = format!("B{first}");
    format!(
        "*NODE\n{first}, {}\n{}, {}\n{}, {}\n{}, {}\n{}, {reference}\n\
         *ELEMENT, TYPE=CPE4, ELSET={name}\n{first}, {first}, {}, {}, {}\n\
         *SOLID SECTION, ELSET={name}, MATERIAL=M\n1.\n*RIGID BODY, ELSET={name}, REF NODE={}\n",
        at(0.0, 0.0),
        first + 1,
        at(1.0, 0.0),
        first + 2,
        at(1.0, 0.1),
        first + 3,
        at(0.0, 0.1),
        first + 4,
        first + 1,
        first + 2,
        first + 3,
        first + 4,
    )
}

const MATERIAL: &str = "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n10.\n";

/// Two bars on a hinge; the first hangs on the origin.
fn pendulum(dt: f64, settings: &str) -> Model {
    let (sin, cos) = 0.3_f64.sin_cos();
    read(&format!(
        "{}{}{MATERIAL}*MPC\nPIN, 12, 21\n*BOUNDARY\n15, 1, 2\n*STEP, NLGEOM, INC=1000\n\
         *DYNAMIC, DIRECT\n{dt}, 0.8\n{settings}*DLOAD\nB11, GRAV, 9.81, 0., -1.\n\
         B21, GRAV, 9.81, 0., -1.\n*END STEP\n",
        bar(11, [0.0, 0.0], 0.3, "0., 0."),
        bar(21, [cos, sin], -0.4, &format!("{cos}, {sin}")),
    ))
}

/// Largest energy balance, and the largest gap of the hinges.
fn faults(model: &Model, reports: &[IncrementReport]) -> [f64; 2] {
    let gap = |r: &IncrementReport| {
        let of_hinge = |[a, b]: [usize; 2]| {
            let gap = |i: usize| (r.state.u[2 * a + i] - r.state.u[2 * b + i]).abs();
            gap(0).max(gap(1))
        };
        let all = model.hinges.iter().map(|hinge| of_hinge(hinge.nodes));
        all.fold(0.0, f64::max)
    };
    [unbalanced(reports), largest(reports, gap)]
}

#[test]
fn a_double_pendulum_keeps_its_energy_with_both_schemes() {
    for settings in ["", "*STICKSLIP, SCHEME=SS22\n"] {
        let model = pendulum(0.01, settings);
        let (keep, _) = run_to_end(&model);
        let [balance, gap] = faults(&model, &keep.reports);
        assert!(balance < 1e-12, "{balance:e}");
        assert!(gap < 1e-13, "{gap:e}");
        let change = |r: &IncrementReport| {
            let e = &r.energy;
            (e.kinetic - e.external_work).abs()
        };
        let scale = largest(&keep.reports, |r| r.energy.kinetic);
        assert!(largest(&keep.reports, change) < 1e-12 * scale);
        assert!(largest(&keep.reports, |r| r.nodal.hinge_force.len() as f64) == 1.0);
    }
}

/// Angular accelerations of two rods of mass m and the arms of their centres from their hinges, with inertia I about
/// the centres: M(theta) alpha = f(theta, omega).
fn accelerations([angles, rates]: [[f64; 2]; 2]) -> [f64; 2] {
    // the bars of the deck have their centres at (1/2, 1/20) from their lower left corners
    let (arm, along, g) = (0.5_f64.hypot(0.05), 1.0, 9.81);
    let inertia = (1.0 + 0.01) / 12.0;
    let tilt = 0.05_f64.atan2(0.5);
    let centres = angles.map(|angle| angle + tilt);
    let between = angles[0] - centres[1];
    let off = along * arm * between.cos();
    let first = inertia + arm * arm + along * along;
    let second = inertia + arm * arm;
    let turn = along * arm * between.sin();
    let loads = [
        -g * (arm * centres[0].cos() + along * angles[0].cos()) - turn * rates[1] * rates[1],
        -g * arm * centres[1].cos() + turn * rates[0] * rates[0],
    ];
    let det = first * second - off * off;
    [
        (second * loads[0] - off * loads[1]) / det,
        (first * loads[1] - off * loads[0]) / det,
    ]
}

/// Angles of the double pendulum at a time, by Runge and Kutta.
fn exact(time: f64) -> [f64; 2] {
    let n = 8000;
    let h = time / n as f64;
    let rate = |[angles, rates]: [[f64; 2]; 2]| [rates, accelerations([angles, rates])];
    let step = |y: [[f64; 2]; 2], k: [[f64; 2]; 2], h: f64| {
        [0, 1].map(|i| [0, 1].map(|j| y[i][j] + h * k[i][j]))
    };
    let mut y = [[0.3, -0.4], [0.0; 2]];
    for _ in 0..n {
        let k1 = rate(y);
        let k2 = rate(step(y, k1, h / 2.0));
        let k3 = rate(step(y, k2, h / 2.0));
        let k4 = rate(step(y, k3, h));
        for k in [(k1, h / 6.0), (k2, h / 3.0), (k3, h / 3.0), (k4, h / 6.0)] {
            y = step(y, k.0, k.1);
        }
    }
    y[0]
}

#[test]
fn a_double_pendulum_follows_its_equations_with_second_order() {
    let exact = exact(0.8);
    let errors = [0.01, 0.005, 0.0025].map(|dt| {
        let (keep, _) = run_to_end(&pendulum(dt, ""));
        let last = keep.reports.last().expect("increments");
        let angles = [0.3 + last.rigid[0].angle, -0.4 + last.rigid[1].angle];
        (angles[0] - exact[0]).hypot(angles[1] - exact[1])
    });
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((3.8..4.2).contains(&ratio), "{errors:?}");
    }
    assert!(errors[2] < 1e-3, "{errors:?}");
}

/// The deck of three bodies on hinges.
fn linkage() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/decks/hinges.inp");
    std::fs::read_to_string(path).expect("the deck")
}

/// The third body deforms and rides on a node at its end; in flight its hinge keeps energy and momenta.
#[test]
fn a_hinge_may_join_an_elastic_body_by_a_coupling() {
    let deck = linkage()
        .replacen(
            "*RIGID BODY, ELSET=THIRD, REF NODE=300\n",
            "*NSET, NSET=END\n21, 24\n*KINEMATIC COUPLING, REF NODE=300\nEND, 1, 2\n",
            1,
        )
        .replacen("THIRD, FLOOR\n", "", 1)
        .replace("GRAV, 9.81", "GRAV, 0.")
        .replacen("300, 1, 2.\n", "300, 1, 2.\n300, 6, 1.\n", 1);
    let model = read(&deck);
    let (keep, _) = run_to_end(&model);
    let (reports, first) = (&keep.reports, &keep.reports[0].momentum);
    let [balance, gap] = faults(&model, reports);
    assert!(balance < 1e-12 && gap < 1e-12, "{balance:e} {gap:e}");
    assert!(largest(reports, |r| r.energy.strain) > 1e-4);
    for report in reports {
        let now = &report.momentum;
        (0..2).for_each(|i| assert!((now.linear[i] - first.linear[i]).abs() < 1e-11));
        assert!((now.angular - first.angular).abs() < 1e-11);
        let change = report.energy.kinetic + report.energy.strain - reports[0].energy.kinetic;
        assert!(
            change.abs() < 1e-12 * reports[0].energy.kinetic,
            "{change:e}"
        );
    }
}

/// Two hinges between the same bars: the second follows from the first up to the length between them.
#[test]
fn hinges_that_follow_from_others_are_refused() {
    let messages = errors(&format!(
        "{}{}{MATERIAL}*MPC\nPIN, 11, 21\nPIN, 12, 22\nPIN, 13, 23\n*STEP, NLGEOM\n\
         *DYNAMIC, DIRECT\n0.01, 0.1\n*END STEP\n",
        bar(11, [0.0, 0.0], 0.3, "0., 0."),
        bar(21, [0.0, 0.0], 0.3, "0.1, 0.1"),
    ));
    assert!(
        messages.contains("holds in step 1 what other hinges"),
        "{messages}"
    );
}

#[test]
fn linkages_that_land_on_a_floor_lose_energy_and_keep_their_hinges() {
    let deck = linkage();
    for (mu, settings) in [
        ("0.3", ""),
        ("0.", ""),
        ("2.", ""),
        ("0.3", "*STICKSLIP, SCHEME=SS22\n"),
        ("0.3", "*STICKSLIP, IMPACT TIME=EVENT\n"),
    ] {
        let deck = deck.replacen("*FRICTION\n0.3", &format!("*FRICTION\n{mu}"), 1);
        let model = read(&deck.replacen("*DLOAD", &format!("{settings}*DLOAD"), 1));
        assert_eq!(model.hinges.len(), 2);
        let (keep, _) = run_to_end(&model);
        let reports = &keep.reports;
        let [balance, gap] = faults(&model, reports);
        assert!(balance < 1e-11, "{mu} {settings} {balance:e}");
        assert!(gap < 1e-12, "{mu} {settings} {gap:e}");
        assert!(reports.iter().any(|r| r.contacts[0].closed > 0));
        let total = |r: &IncrementReport| {
            let e = &r.energy;
            e.kinetic + e.strain - e.external_work
        };
        let scale = largest(reports, energy);
        for pair in reports.windows(2) {
            let rise = total(&pair[1]) - total(&pair[0]);
            assert!(rise < 1e-11 * scale, "{mu} {settings} {rise:e}");
        }
    }
}

/// Free bars whose velocities contradict their hinge: its impulse makes them one motion, and keeps the momenta.
#[test]
fn velocities_that_contradict_a_hinge_are_made_to_agree() {
    let (sin, cos) = 0.3_f64.sin_cos();
    let model = read(&format!(
        "{}{}{MATERIAL}*MPC\nPIN, 21, 12\n*INITIAL CONDITIONS, TYPE=VELOCITY\n15, 1, 2.\n25, 6, -3.\n\
         *STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 1.\n*END STEP\n",
        bar(11, [0.0, 0.0], 0.3, "0.5, 0."),
        bar(21, [cos, sin], -0.4, &format!("{cos}, {sin}")),
    ));
    let (keep, _) = run_to_end(&model);
    let reports = &keep.reports;
    let [a, b] = model.hinges[0].nodes;
    let first = &reports[0];
    for i in 0..2 {
        let v = [a, b].map(|node| first.state.v[2 * node + i]);
        assert!((v[0] - v[1]).abs() < 1e-14, "{v:?}");
    }
    // the hinge takes nothing from the momentum of both: (2, 0) of the first, omega J r of the second
    let (sin, cos) = (-0.4_f64).sin_cos();
    let [x, y] = [0.5 * cos - 0.05 * sin, 0.5 * sin + 0.05 * cos];
    let expected = [2.0 + 3.0 * y, -3.0 * x];
    for (p, expected) in first.momentum.linear.iter().zip(expected) {
        assert!((p - expected).abs() < 1e-13, "{p} {expected}");
    }
    for report in reports {
        let (now, start) = (&report.momentum, &first.momentum);
        (0..2).for_each(|i| assert!((now.linear[i] - start.linear[i]).abs() < 1e-12));
        assert!((now.angular - start.angular).abs() < 1e-12);
    }
    let [balance, gap] = faults(&model, reports);
    assert!(balance < 1e-12 && gap < 1e-13, "{balance:e} {gap:e}");
}

/// Two rings of mass m and 2 m, held across their axis and in turning as bodies of revolution must be: of a force of 6
/// on the first their hinge passes on 2/3, and all of it where the second is held along the axis too.
#[test]
fn a_hinge_acts_along_what_supports_leave_free() {
    let ring = |first: usize, density: f64| {
        let [a, b, c, d, reference] = [0, 1, 2, 3, 4].map(|k| first + k);
        format!(
            "*NODE\n{a}, 1., 0.\n{b}, 2., 0.\n{c}, 2., 1.\n{d}, 1., 1.\n{reference}, 1., 0.\n\
             *ELEMENT, TYPE=CAX4, ELSET=E{first}\n{first}, {a}, {b}, {c}, {d}\n\
             *MATERIAL, NAME=M{first}\n*ELASTIC\n1000., 0.3\n*DENSITY\n{density:?}\n\
             *SOLID SECTION, ELSET=E{first}, MATERIAL=M{first}\n*RIGID BODY, ELSET=E{first}, REF NODE={reference}\n"
        )
    };
    let rings = [ring(11, 1.0), ring(21, 2.0)].concat();
    let cases = [
        ("*DYNAMIC, DIRECT\n0.01, 0.1", "", 4.0, 1e-13),
        // pins of motions that supports leave free have their round-off
        ("*STATIC\n1., 1.", "25, 2\n", 6.0, 1e-9),
    ];
    for (procedure, held, passed_on, open) in cases {
        let model = read(&format!(
            "{rings}*MPC\nPIN, 12, 22\n*BOUNDARY\n15, 1\n15, 6\n25, 1\n25, 6\n{held}\
             *STEP, NLGEOM\n{procedure}\n*CLOAD\n15, 2, 6.\n*END STEP\n"
        ));
        let (keep, _) = run_to_end(&model);
        for report in keep.reports.iter().skip(1) {
            let [across, along] = report.nodal.hinge_force[0];
            assert_eq!(across, 0.0, "{procedure}");
            assert!((along + passed_on).abs() < 1e-9, "{procedure} {along}");
        }
        let gap = faults(&model, &keep.reports)[1];
        assert!(gap < open, "{procedure} {gap:e}");
    }
    let static_step =
        |held: &str| format!("*STEP, NLGEOM\n*STATIC\n1., 1.\n*BOUNDARY\n{held}*END STEP\n");
    let pinned = "*MPC\nPIN, 12, 21\n";
    let moved_apart = static_step("15, 1, 1, 0.1\n15, 6\n25, 1\n25, 6\n");
    let bars = [
        bar(11, [0.0, 0.0], 0.0, "0., 0."),
        bar(21, [1.0, 0.0], 0.0, "1., 0."),
    ]
    .concat();
    let held_after_a_turn = [
        static_step("15, 1, 2\n"),
        static_step("15, 6\n25, 1, 2\n25, 6\n"),
    ]
    .concat();
    for (deck, step) in [
        (format!("{rings}*MPC\nPIN, 12, 22\n{moved_apart}"), 1),
        (format!("{bars}{MATERIAL}{pinned}{held_after_a_turn}"), 2),
    ] {
        let message = errors(&deck);
        let told = format!("holds in step {step} what other hinges or supports hold already");
        assert!(message.contains(&told), "{message}");
    }
}

#[test]
fn hinges_that_cannot_be_are_told() {
    let bars = format!(
        "{}{}{MATERIAL}",
        bar(11, [0.0, 0.0], 0.3, "0., 0."),
        bar(21, [0.0, 0.0], 0.3, "0.1, 0.1"),
    );
    let step = "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 0.1\n*END STEP\n";
    let again = format!("{bars}*MPC\nPIN, 11, 21\nPIN, 21, 11\n{step}");
    assert!(errors(&again).contains("joined by a hinge already"));
    let own = format!("{bars}*MPC\nPIN, 11, 12\n{step}");
    assert!(errors(&own).contains("both nodes belong to B11"));
    let apart = format!("{bars}*MPC\nPIN, 11, 22\n{step}");
    assert!(errors(&apart).contains("at the place of the other node"));
    let tied = format!("{bars}*MPC\nTIE, 11, 21\n{step}");
    assert!(errors(&tied).contains("a tie would make one"));
}
