//! Static steps of rigid bodies that move freely: pressed by contact, on hinges and springs, without equilibrium.

use crate::statics::run_deck;
use stickslip::dynamics::{Cause, IncrementReport};

const MATERIAL: &str = "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n";

/// A square of one element with the side 1 over a point, which turns with the node `first + 4` at another point.
fn square(first: usize, [x, y]: [f64; 2], reference: [f64; 2], name: &str) -> String {
    let corners = [[-0.5, 0.0], [0.5, 0.0], [0.5, 1.0], [-0.5, 1.0]];
    let nodes: String = (corners.iter().enumerate())
        .map(|(i, c)| format!("{}, {:?}, {:?}\n", first + i, x + c[0], y + c[1]))
        .collect();
    let [rx, ry] = reference;
    format!(
        "*NODE\n{nodes}{}, {rx:?}, {ry:?}\n*ELEMENT, TYPE=CPE4, ELSET={name}\n\
         {first}, {first}, {}, {}, {}\n*SOLID SECTION, ELSET={name}, MATERIAL=M\n1.\n\
         *SURFACE, NAME=S{name}\n{name},\n*RIGID BODY, ELSET={name}, REF NODE={}\n",
        first + 4,
        first + 1,
        first + 2,
        first + 3,
        first + 4,
    )
}

/// A fixed rigid floor, and its contact with the skin of a body.
fn on_rigid_floor(body: &str, friction: f64) -> String {
    format!(
        "*NODE\n900, 0., -1.\n*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, -9., 0.\nLINE, 9., 0.\n\
         *RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=900\n*BOUNDARY\n900, 1, 2\n\
         *SURFACE INTERACTION, NAME=I\n*FRICTION\n{friction:?}\n*CONTACT PAIR, INTERACTION=I\nS{body}, FLOOR\n"
    )
}

/// A mesh of 8 x 2 elements from (-2, -1) to (2, 0), held below, and its contact with the skin of a body.
fn on_elastic_floor(body: &str, friction: f64, young: &str) -> String {
    let nodes: String = (0..27)
        .map(|n| {
            format!(
                "{}, {:?}, {:?}\n",
                801 + n,
                -2.0 + 0.5 * (n % 9) as f64,
                -1.0 + 0.5 * (n / 9) as f64
            )
        })
        .collect();
    let elements: String = (0..16)
        .map(|e| {
            let a = 801 + e % 8 + 9 * (e / 8);
            format!("{}, {a}, {}, {}, {}\n", 801 + e, a + 1, a + 10, a + 9)
        })
        .collect();
    format!(
        "*NODE\n{nodes}*ELEMENT, TYPE=CPE4, ELSET=F\n{elements}*MATERIAL, NAME=MF\n*ELASTIC\n{young}, 0.3\n\
         *DENSITY\n1.\n*SOLID SECTION, ELSET=F, MATERIAL=MF\n1.\n*SURFACE, NAME=SF\nF,\n\
         *NSET, NSET=GROUND, GENERATE\n801, 809\n*BOUNDARY\nGROUND, 1, 2\n\
         *SURFACE INTERACTION, NAME=I\n*FRICTION\n{friction:?}\n*CONTACT PAIR, INTERACTION=I, \
         TYPE=NODE TO SURFACE\nS{body}, SF\nSF, S{body}\n"
    )
}

fn statics(dt: f64, cards: &str) -> String {
    format!("*STEP, NLGEOM\n*STATIC\n{dt:?}, 1.\n{cards}*END STEP\n")
}

/// Reports of a deck that runs to its end with a closed ledger.
fn run(text: &str) -> Vec<IncrementReport> {
    let (keep, failure) = run_deck(text);
    assert_eq!(failure, None);
    for report in &keep.reports {
        let e = &report.energy;
        let scale = e.strain.max(e.external_work.abs());
        assert!(
            e.balance.abs() <= 1e-12 * scale,
            "{:e} {scale:e}",
            e.balance
        );
    }
    keep.reports
}

fn last(reports: &[IncrementReport]) -> &IncrementReport {
    reports.last().expect("reports")
}

/// Force along a direction on the body whose skin is the slave of the first contact and the master of the second.
fn contact_force(report: &IncrementReport, direction: usize) -> f64 {
    let [first, second] = [0, 1].map(|contact| report.contacts[contact].force[direction]);
    first - second
}

#[test]
fn a_rigid_block_rests_on_an_elastic_one_before_and_after_a_dynamic_step() {
    for young in ["1000.", "2e11"] {
        // it falls on to the floor from a small height
        let weight = statics(0.5, "*DLOAD\nB, GRAV, 10., 0., -1.\n");
        let dynamic = "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 0.05\n*END STEP\n";
        let pull = statics(0.5, "*CLOAD\n5, 1, 1.\n5, 6, 0.4\n");
        let text = format!(
            "{}{MATERIAL}{}{weight}{dynamic}{pull}",
            square(1, [0.1, 0.02], [0.1, 0.3], "B"),
            on_elastic_floor("B", 0.3, young)
        );
        let reports = run(&text);
        let rests = reports.iter().rfind(|r| r.step == 1).expect("increments");
        assert!(rests.solver.passes <= 5, "{}", rests.solver.passes);
        for report in reports.iter().filter(|r| r.step < 3 && r.time > 0.9) {
            assert!((contact_force(report, 1) - 10.0).abs() < 1e-9);
            let e = &report.energy;
            // places to 4 eps in an increment of 0.01, of the mass 1
            let round_off = (4.0 * f64::EPSILON / 0.01).powi(2) / 2.0;
            let most = 1e-18 * e.strain + round_off;
            assert!(e.kinetic <= most, "{:e} {most:e}", e.kinetic);
        }
        let end = last(&reports);
        assert!((contact_force(end, 1) - 10.0).abs() < 1e-9);
        assert!((contact_force(end, 0) + 1.0).abs() < 1e-9);
    }
}

/// A rigid block is pressed into an elastic floor and turned by an angle whose rate changes: it ends where contact has
/// held it, though its increments begin with the motion of the one before.
#[test]
fn a_prescribed_angle_changes_its_rate() {
    let motion = "*BOUNDARY\n5, 1, 1\n5, 2, 2, -0.02\n*BOUNDARY, AMPLITUDE=A\n5, 6, 6, 0.05\n";
    let text = format!(
        "{}{MATERIAL}{}*AMPLITUDE, NAME=A\n0., 0., 0.5, 1., 1., 0.7\n\
         *STEP, NLGEOM\n*STATIC, DIRECT\n0.25, 1.\n{motion}*END STEP\n",
        square(1, [0.1, 0.0], [0.1, 0.3], "B"),
        on_elastic_floor("B", 0.0, "1000.")
    );
    let reports = run(&text);
    assert!(contact_force(last(&reports), 1) > 1.0);
    for report in &reports {
        let gap = report.solver.violation.gap;
        assert!(gap < 1e-12, "{gap:e} at {}", report.time);
    }
}

/// A lever on a fixed point: the moments of a dead force and of a spring about it vanish in the end.
#[test]
fn a_lever_turns_until_its_spring_holds_it() {
    let text = format!(
        "{MATERIAL}*NODE\n1, 0., 0.\n2, 2., 0.\n3, 2., 0.1\n4, 0., 0.1\n7, 2., -1.\n\
         *ELEMENT, TYPE=CPE4, ELSET=L\n1, 1, 2, 3, 4\n*SOLID SECTION, ELSET=L, MATERIAL=M\n1.\n\
         *RIGID BODY, ELSET=L, REF NODE=1\n*ELEMENT, TYPE=SPRINGA, ELSET=ES\n9, 2, 7\n\
         *SPRING, ELSET=ES\n\n50.\n*BOUNDARY\n1, 1, 2\n7, 1, 2\n{}",
        statics(0.25, "*CLOAD\n3, 2, 20.\n")
    );
    let reports = run(&text);
    let u = &last(&reports).state.u;
    let at = |node: usize, x: [f64; 2]| [0, 1].map(|i| x[i] + u[2 * node + i]);
    let (end, load) = (at(1, [2.0, 0.0]), at(2, [2.0, 0.1]));
    let to = [2.0 - end[0], -1.0 - end[1]];
    let length = to[0].hypot(to[1]);
    let pull = to.map(|t| 50.0 * (length - 1.0) * t / length);
    let moment = load[0] * 20.0 + end[0] * pull[1] - end[1] * pull[0];
    assert!(moment.abs() < 1e-9, "{moment:e}");
    assert!(end[1] > 0.3, "it has turned: {}", end[1]);
}

/// Two rods hang on each other by a hinge; a force pulls the lower end aside.
#[test]
fn rods_on_a_hinge_hang_in_equilibrium() {
    let rod = |first: usize, y: f64| {
        format!(
            "*NODE\n{first}, 0., {y:?}\n{}, 0., {:?}\n{}, 0.2, {:?}\n{}, 0.2, {y:?}\n{}, 0., {y:?}\n\
             *ELEMENT, TYPE=CPE4, ELSET=R{first}\n{first}, {first}, {}, {}, {}\n\
             *SOLID SECTION, ELSET=R{first}, MATERIAL=M\n1.\n*RIGID BODY, ELSET=R{first}, REF NODE={}\n",
            first + 1,
            y - 1.0,
            first + 2,
            y - 1.0,
            first + 3,
            first + 4,
            first + 1,
            first + 2,
            first + 3,
            first + 4,
        )
    };
    let text = format!(
        "{}{}{MATERIAL}*MPC\nPIN, 2, 11\n*AMPLITUDE, NAME=ON\n0., 1., 9., 1.\n*BOUNDARY\n5, 1, 2\n{}{}",
        rod(1, 0.0),
        rod(11, -1.0),
        statics(
            1.0,
            "*DLOAD, AMPLITUDE=ON\nR1, GRAV, 10., 0., -1.\nR11, GRAV, 10., 0., -1.\n"
        ),
        statics(0.25, "*CLOAD\n12, 1, 0.7\n"),
    );
    let reports = run(&text);
    let u = &last(&reports).state.u;
    // by node 0 to 4 and 5 to 9; rods of the mass 0.2
    let at = |node: usize, x: [f64; 2]| [0, 1].map(|i| x[i] + u[2 * node + i]);
    let (hinge, other) = (at(1, [0.0, -1.0]), at(5, [0.0, -1.0]));
    assert!((hinge[0] - other[0]).hypot(hinge[1] - other[1]) < 1e-14);
    let end = at(6, [0.0, -2.0]);
    let middle = |a: [f64; 2], b: [f64; 2]| (a[0] + b[0]) / 2.0;
    let (upper, lower) = (
        middle([0.0, 0.0], at(2, [0.2, -1.0])),
        middle(hinge, at(7, [0.2, -2.0])),
    );
    let about_hinge = -2.0 * (lower - hinge[0]) - 0.7 * (end[1] - hinge[1]);
    let about_top = -2.0 * upper - 2.0 * lower - 0.7 * end[1];
    assert!(about_hinge.abs() < 1e-11, "{about_hinge:e}");
    assert!(about_top.abs() < 1e-11, "{about_top:e}");
    // gravity alone turns the rods, whose masses are beside the points that they hang on, and the force more
    assert!(end[0] > 0.2, "{}", end[0]);
    let hinge_force = last(&reports).nodal.hinge_force[0];
    assert!(
        (hinge_force[0].abs() - 0.7).abs() < 1e-11,
        "{hinge_force:?}"
    );
}

/// A roller is pressed between two blocks, rolled by the upper one, let free for a time, and rolled back.
#[test]
fn a_roller_is_pressed_and_rolled() {
    let corners = 24;
    let angle = |k: usize| std::f64::consts::TAU * (k as f64 + 0.5) / corners as f64;
    let top = (std::f64::consts::PI / corners as f64).cos();
    let rim: String = (0..corners)
        .map(|k| {
            format!(
                "{}, {:?}, {:?}\n",
                2 + k,
                angle(k).cos(),
                top + angle(k).sin()
            )
        })
        .collect();
    let elements: String = (0..corners)
        .map(|k| format!("{}, 1, {}, {}\n", k + 1, 2 + k, 2 + (k + 1) % corners))
        .collect();
    let upper = format!(
        "*NODE\n701, -2., {low:?}\n702, 2., {low:?}\n703, 2., {high:?}\n704, -2., {high:?}\n\
         *ELEMENT, TYPE=CPE4, ELSET=T\n701, 701, 702, 703, 704\n*SOLID SECTION, ELSET=T, MATERIAL=M\n1.\n\
         *SURFACE, NAME=ST\nT,\n*NSET, NSET=ROOF\n703, 704\n",
        low = 2.0 * top,
        high = 2.0 * top + 1.0
    );
    let text = format!(
        "*NODE\n1, 0., {top:?}\n{rim}*ELEMENT, TYPE=CPE3, ELSET=R\n{elements}\
         *SOLID SECTION, ELSET=R, MATERIAL=M\n1.\n*SURFACE, NAME=SR\nR,\n*RIGID BODY, ELSET=R, REF NODE=1\n\
         {upper}{MATERIAL}{}*CONTACT PAIR, INTERACTION=I\nSR, ST\n*BOUNDARY\nROOF, 1\n{}{}{}{}",
        on_elastic_floor("R", 0.3, "1000."),
        statics(0.5, "*BOUNDARY\nROOF, 2, 2, -0.05\n"),
        statics(0.1, "*BOUNDARY\nROOF, 1, 1, 0.5\nROOF, 2, 2, -0.05\n"),
        "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 0.03\n*END STEP\n",
        statics(0.25, "*BOUNDARY\nROOF, 1, 1, 0.4\n"),
    );
    let reports = run(&text);
    let centre = |r: &IncrementReport| [r.state.u[0], r.rigid[0].angle];
    let of_step = |step: usize| {
        reports
            .iter()
            .rfind(|r| r.step == step)
            .expect("increments")
    };
    let [x, turned] = centre(of_step(2));
    // nothing slips: the centre goes half as far as the roof, within the shear of both blocks
    assert!(
        (x - 0.25).abs() < 0.03 && (turned + x).abs() < 0.03,
        "{x} {turned}"
    );
    let [slid, strain] = [
        of_step(2).energy.friction_dissipation,
        of_step(2).energy.strain,
    ];
    assert!(slid < 0.02 * strain, "{slid:e} {strain:e}");
    let kinetic = |r: &IncrementReport| r.energy.kinetic;
    let moves = reports
        .iter()
        .filter(|r| r.step == 3)
        .map(kinetic)
        .fold(0.0, f64::max);
    assert!(moves < 1e-18 * of_step(2).energy.strain, "{moves:e}");
    assert!(centre(last(&reports))[0] < x);
}

/// The equilibrium of rigid bodies on rigid ones, and its limits.
#[test]
fn a_rigid_block_on_a_slope_rests_slides_or_tips() {
    let on_slope = |angle: f64, friction: f64| {
        let (sin, cos) = angle.to_radians().sin_cos();
        let gravity = statics(
            1.0,
            &format!("*DLOAD\nB, GRAV, 9.81, {sin:?}, {:?}\n", -cos),
        );
        run_deck(&format!(
            "{}{MATERIAL}{}{gravity}",
            square(1, [0.0, 0.0], [0.1, 0.3], "B"),
            on_rigid_floor("B", friction)
        ))
    };
    let tangent = 20.0_f64.to_radians().tan();
    for friction in [tangent + 1e-5, 0.8] {
        let (keep, failure) = on_slope(20.0, friction);
        assert_eq!(failure, None);
        let force = last(&keep.reports).contacts[0].force;
        assert!((force[0].hypot(force[1]) - 9.81).abs() < 1e-12);
    }
    let free_motion = |angle: f64, friction: f64| {
        let failure = on_slope(angle, friction)
            .1
            .expect("there is no equilibrium");
        match failure.cause {
            Cause::Unbalanceable(unbalanced) => unbalanced.motion,
            other => panic!("{other:?}"),
        }
    };
    let [x, y, angle] = free_motion(20.0, tangent - 1e-5);
    assert!(x > 0.0 && y.abs() < 1e-9 * x && angle.abs() < 1e-9 * x);
    let [.., angle] = free_motion(50.0, 3.0);
    assert!(angle < 0.0, "it turns down the slope");
}

/// Without friction a weak spring alone holds a block along a floor that is 1e8 times as stiff.
#[test]
fn a_weak_spring_holds_a_block_along_a_stiff_floor() {
    let text = format!(
        "{}{MATERIAL}{}*NODE\n10, 5., 0.3\n*ELEMENT, TYPE=SPRINGA, ELSET=ES\n990, 5, 10\n\
         *SPRING, ELSET=ES\n\n1000.\n*BOUNDARY\n10, 1, 2\n{}",
        square(1, [0.0, 0.0], [0.0, 0.3], "B"),
        on_elastic_floor("B", 0.0, "2e11"),
        statics(0.5, "*DLOAD\nB, GRAV, 10., 0., -1.\n*CLOAD\n5, 1, 10.\n"),
    );
    let reports = run(&text);
    let end = last(&reports);
    assert!(end.solver.passes <= 6, "{}", end.solver.passes);
    assert!((end.state.u[8] - 0.01).abs() < 1e-9, "{}", end.state.u[8]);
}

/// Nodes of an elastic block ride on a node with mass; contact alone holds the block.
#[test]
fn a_coupling_with_mass_is_in_equilibrium() {
    let text = format!(
        "*NODE\n1, -0.5, 0.\n2, 0.5, 0.\n3, 0.5, 1.\n4, -0.5, 1.\n5, 0., 1.5\n\
         *ELEMENT, TYPE=CPE4, ELSET=B\n1, 1, 2, 3, 4\n*SOLID SECTION, ELSET=B, MATERIAL=M\n1.\n\
         *SURFACE, NAME=SB\nB,\n*ELEMENT, TYPE=MASS, ELSET=EM\n9, 5\n*MASS, ELSET=EM\n2.\n\
         *NSET, NSET=TOP\n3, 4\n*KINEMATIC COUPLING, REF NODE=5\nTOP, 1, 2\n{MATERIAL}{}{}{}",
        on_elastic_floor("B", 0.3, "1000."),
        statics(0.5, "*CLOAD\n5, 2, -10.\n5, 6, 0.5\n5, 1, 0.5\n"),
        "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 0.03\n*END STEP\n",
    );
    let reports = run(&text);
    let rests = reports.iter().rfind(|r| r.step == 1).expect("increments");
    assert!((contact_force(rests, 1) - 10.0).abs() < 1e-9);
    assert!((contact_force(rests, 0) + 0.5).abs() < 1e-9);
    assert!(rests.state.u[8] > 1e-4, "the moment and the force bend it");
    let kinetic = last(&reports).energy.kinetic;
    assert!(kinetic < 1e-16 * rests.energy.strain, "{kinetic:e}");
}
