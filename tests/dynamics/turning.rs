//! Rigid bodies that turn: by a prescribed angle, and freely, in contact.

use stickslip::dynamics::IncrementReport;

use crate::blocks::run_to_end;
use crate::energies::{energy, largest, unbalanced};
use crate::reading::read;
use crate::statics::run_deck;

/// A square of one element with the side 2a about a point, its material, and its skin.
fn square(first: usize, [x, y]: [f64; 2], a: f64, name: &str) -> String {
    let corners = [[-a, -a], [a, -a], [a, a], [-a, a]];
    let nodes = corners
        .iter()
        .enumerate()
        .map(|(i, corner)| format!("{}, {}, {}\n", first + i, x + corner[0], y + corner[1]));
    let sides: String = (1..=4).map(|side| format!("{name}, S{side}\n")).collect();
    format!(
        "*NODE\n{}*ELEMENT, TYPE=CPS4, ELSET={name}\n{first}, {first}, {}, {}, {}\n\
         *SOLID SECTION, ELSET={name}, MATERIAL=M\n1.\n*SURFACE, NAME=S{name}\n{sides}",
        nodes.collect::<String>(),
        first + 1,
        first + 2,
        first + 3,
    )
}

const MATERIAL: &str = "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n";

/// A rigid bar turns about its middle by 1.5 within the step and throws a free block.
#[test]
fn a_driven_polygon_throws_a_block() {
    let profile = "*NODE\n100, 0., 0.\n*SURFACE, NAME=BAR, TYPE=SEGMENTS\nSTART, -2., -0.1\n\
                   LINE, -2., 0.1\nLINE, 2., 0.1\nLINE, 2., -0.1\nLINE, -2., -0.1\n\
                   *RIGID BODY, ANALYTICAL SURFACE=BAR, REF NODE=100\n";
    let text = format!(
        "{}{MATERIAL}{profile}*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.3\n\
         *CONTACT PAIR, INTERACTION=I\nSE, BAR\n\
         *AMPLITUDE, NAME=A, DEFINITION=SMOOTH STEP\n0., 0., 1., 1.\n*STEP, NLGEOM\n\
         *DYNAMIC, DIRECT\n0.01, 1.\n*BOUNDARY\n100, 1, 2\n*BOUNDARY, AMPLITUDE=A\n\
         100, 6, 6, 1.5\n*END STEP\n",
        square(1, [1.4, 0.5], 0.2, "E"),
    );
    let model = read(&text);
    let (keep, _) = run_to_end(&model);
    let reports = &keep.reports;
    // node 5 is the reference node, those of the bar follow it
    let corners = [[-2.0, -0.1], [-2.0, 0.1], [2.0, 0.1], [2.0, -0.1]];
    let nodes = model.mesh.node_count();
    let last = reports.last().expect("increments");
    let (sin, cos) = 1.5_f64.sin_cos();
    for (k, [x, y]) in corners.into_iter().enumerate() {
        let node = (0..nodes).find(|&n| model.mesh.coordinates[n] == [x, y]);
        let node = node.unwrap_or_else(|| panic!("corner {k}"));
        let expected = [cos * x - sin * y - x, sin * x + cos * y - y];
        for (u, expected) in last.state.u[2 * node..].iter().zip(expected) {
            assert!((u - expected).abs() < 1e-14);
        }
    }
    assert_eq!(last.state.u.len(), 2 * nodes);
    assert!(reports.iter().any(|r| r.contacts[0].closed > 0));
    assert!(unbalanced(reports) < 1e-12, "{:e}", unbalanced(reports));
    // the moment that drives the bar is that of the contact force on it
    let moment = largest(reports, |r| r.rigid[0].moment.abs());
    assert!(moment > 1.0);
    for report in reports {
        let [rigid, contact] = [report.rigid[0].moment, report.contacts[0].reference_moment];
        assert!(
            (rigid - contact).abs() < 1e-10 * moment,
            "{rigid} {contact}"
        );
    }
    assert!(last.energy.kinetic > 1.0);
}

/// Two free rigid squares collide off their centres and slide along each other.
#[test]
fn free_bodies_keep_their_momenta() {
    let text = format!(
        "{}{}{MATERIAL}*NODE\n100, 0., 0.\n200, 3., 0.8\n*RIGID BODY, ELSET=A, REF NODE=100\n\
         *RIGID BODY, ELSET=B, REF NODE=200\n*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.3\n\
         *CONTACT PAIR, INTERACTION=I\nSA, SB\nSB, SA\n\
         *INITIAL CONDITIONS, TYPE=VELOCITY\n100, 1, 2.\n100, 6, 0.7\n200, 1, -1.\n200, 6, -1.1\n\
         *STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.02, 2.\n*END STEP\n",
        square(1, [0.0, 0.0], 0.5, "A"),
        square(11, [3.0, 0.8], 0.6, "B"),
    );
    let (keep, _) = run_to_end(&read(&text));
    let reports = &keep.reports;
    assert!(
        reports
            .iter()
            .any(|r| r.contacts.iter().any(|c| c.closed > 0))
    );
    let start = &reports[0].momentum;
    assert!((start.linear[0] - (2.0 - 1.44)).abs() < 1e-14);
    let energy = |r: &IncrementReport| r.energy.kinetic;
    for pair in reports.windows(2) {
        let now = &pair[1].momentum;
        (0..2).for_each(|i| assert!((now.linear[i] - start.linear[i]).abs() < 1e-12));
        assert!(
            (now.angular - start.angular).abs() < 1e-12,
            "{}",
            now.angular - start.angular
        );
        assert!(energy(&pair[1]) <= energy(&pair[0]) * (1.0 + 1e-13));
    }
    assert!(unbalanced(reports) < 1e-12, "{:e}", unbalanced(reports));
}

/// A free square with its reference node off its centre under a dead moment M: omega = M t/I, and M does the work of
/// the angle.
#[test]
fn a_moment_turns_a_body_about_its_centre_of_mass() {
    let text = format!(
        "{}{MATERIAL}*NODE\n100, 0.3, -0.4\n*RIGID BODY, ELSET=A, REF NODE=100\n\
         *STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.005, 0.5\n*CLOAD\n100, 6, 3.\n*END STEP\n",
        square(1, [0.0, 0.0], 0.5, "A"),
    );
    let (keep, _) = run_to_end(&read(&text));
    let last = keep.reports.last().expect("increments");
    let body = &last.rigid[0];
    // I = 1/6 of the unit square with the density 1
    assert!(
        (body.angular_velocity - 9.0).abs() < 1e-3,
        "{}",
        body.angular_velocity
    );
    assert!((body.kinetic - 3.0 * body.angle).abs() < 1e-11 * body.kinetic);
    assert!((last.energy.external_work - 3.0 * body.angle).abs() < 1e-11 * body.kinetic);
    for (center, velocity) in body.center.iter().zip(last.bodies[0].velocity) {
        assert!(center.abs() < 1e-14 && velocity.abs() < 1e-14);
    }
    assert!((last.bodies[0].angular_velocity - body.angular_velocity).abs() < 1e-12);
    assert!(unbalanced(&keep.reports) < 1e-11);
}

/// Point masses have their weight: two on a rod without elements that turns, one of them of two elements, and one that is
/// coupled to a block fall with it. OP=NEW takes the weights off.
#[test]
fn point_masses_fall() {
    let text = format!(
        "{}{MATERIAL}*NODE\n100, 3., 0.\n101, 4., 0.\n200, 0., 1.\n*NSET, NSET=ROD\n100, 101\n\
         *NSET, NSET=LID\n3, 4\n*RIGID BODY, NSET=ROD, REF NODE=100\n\
         *KINEMATIC COUPLING, REF NODE=200\nLID, 1, 6\n\
         *ELEMENT, TYPE=MASS, ELSET=EM\n901, 100\n902, 101\n903, 101\n*MASS, ELSET=EM\n2.\n\
         *ELEMENT, TYPE=MASS, ELSET=EC\n904, 200\n*MASS, ELSET=EC\n0.7\n\
         *INITIAL CONDITIONS, TYPE=VELOCITY\n100, 6, 3.\n\
         *STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 0.5\n*DLOAD\n, GRAV, 9., 0., -1.\n*END STEP\n\
         *STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 0.1\n*DLOAD, OP=NEW\n*END STEP\n",
        square(1, [0.0, 0.0], 0.5, "A"),
    );
    let (keep, _) = run_to_end(&read(&text));
    let reports = &keep.reports;
    assert!(unbalanced(reports) < 1e-12, "{:e}", unbalanced(reports));
    for report in reports {
        let speed = -9.0 * report.time.min(0.5);
        // the elements of the block, and the reference node of its coupling
        for node in [0, 1, 2, 3, 6] {
            let v = [0, 1].map(|i| report.state.v[2 * node + i]);
            assert!(v[0].abs() < 1e-11 && (v[1] - speed).abs() < 1e-11, "{v:?}");
        }
        // the masses 2 and 4 turn about the point two thirds along the rod, which starts with the velocity 2
        let (t, rod) = (report.time.min(0.5), &report.rigid[0]);
        let height = 2.0 * t - 4.5 * t * t + (2.0 + speed) * (report.time - t);
        assert!((rod.center[0] - 11.0 / 3.0).abs() < 1e-11);
        assert!((rod.center[1] - height).abs() < 1e-11, "{}", rod.center[1]);
        assert!((rod.angular_velocity - 3.0).abs() < 1e-11);
    }
}

/// A profile with the mass and the inertia of point elements rolls over a block that rests on a base, as master.
#[test]
fn a_profile_with_mass_falls_on_to_a_block() {
    let text = format!(
        "{}{MATERIAL}*NODE\n100, 0.1, 1.3\n*SURFACE, NAME=WEDGE, TYPE=SEGMENTS\nSTART, 1.1, 1.8\n\
         LINE, 0.1, 0.8\nLINE, -0.9, 1.8\nLINE, 1.1, 1.8\n\
         *RIGID BODY, ANALYTICAL SURFACE=WEDGE, REF NODE=100\n\
         *ELEMENT, TYPE=MASS, ELSET=EM\n901, 100\n*MASS, ELSET=EM\n2.\n\
         *ELEMENT, TYPE=ROTARYI, ELSET=ER\n902, 100\n*ROTARY INERTIA, ELSET=ER\n, , 0.4\n\
         *SURFACE INTERACTION, NAME=I\n*FRICTION\n0.3\n*CONTACT PAIR, INTERACTION=I\nSE, WEDGE\n\
         *BOUNDARY\n1, 1, 2\n2, 1, 2\n\
         *STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.005, 1.\n*CLOAD\n100, 2, -20.\n*END STEP\n",
        square(1, [0.0, 0.0], 0.5, "E"),
    );
    let (keep, _) = run_to_end(&read(&text));
    let reports = &keep.reports;
    assert!(unbalanced(reports) < 1e-10, "{:e}", unbalanced(reports));
    assert!(reports.iter().all(|r| r.rigid[0].force == [0.0; 2]));
    assert!(largest(reports, |r| r.rigid[0].kinetic) > 1.0);
}

/// A square that is pushed along a floor and let go comes to rest for good: the last slip leaves no velocity.
#[test]
fn a_slip_that_ends_leaves_no_velocity() {
    let text = format!(
        "{}{MATERIAL}*NODE\n100, 0., 0.5\n200, 0., -1.\n\
         *SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, -9., 0.\nLINE, 9., 0.\n\
         *RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=200\n*RIGID BODY, ELSET=A, REF NODE=100\n\
         *SURFACE INTERACTION, NAME=I\n*FRICTION\n0.3\n*CONTACT PAIR, INTERACTION=I\nSA, FLOOR\n\
         *BOUNDARY\n200, 1, 2\n*INITIAL CONDITIONS, TYPE=VELOCITY\n100, 1, 1.\n\
         *STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 1.\n*DLOAD\nA, GRAV, 9.81, 0., -1.\n*END STEP\n",
        square(1, [0.0, 0.5], 0.5, "A"),
    );
    let (keep, _) = run_to_end(&read(&text));
    let reports = &keep.reports;
    assert!(unbalanced(reports) < 1e-11, "{:e}", unbalanced(reports));
    // it stops after v0/(mu g) = 0.34
    let resting = reports.iter().filter(|r| r.time > 0.36);
    for report in resting {
        let fastest = report
            .state
            .v
            .iter()
            .fold(0.0_f64, |most, v| most.max(v.abs()));
        assert!(fastest < 1e-12, "{} {fastest:e}", report.time);
    }
}

/// A square pinned at a corner swings under gravity: a rigid body whose centre of mass follows its
/// reference node.
#[test]
fn a_pinned_body_swings() {
    let text = format!(
        "{}{MATERIAL}*RIGID BODY, ELSET=A, REF NODE=1\n*BOUNDARY\n1, 1, 2\n\
         *STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 3.\n*DLOAD\nA, GRAV, 9.81, 0., -1.\n*END STEP\n",
        square(1, [0.5, 0.5], 0.5, "A"),
    );
    let (keep, _) = run_to_end(&read(&text));
    let reports = &keep.reports;
    // its passes leave a residual, which is the balance
    assert!(unbalanced(reports) < 1e-10, "{:e}", unbalanced(reports));
    for report in reports {
        let u = &report.state.u;
        let corner = |n: usize, x: [f64; 2]| [x[0] + u[2 * n], x[1] + u[2 * n + 1]];
        assert_eq!(corner(0, [0.0; 2]), [0.0; 2]);
        let [x, y] = corner(2, [1.0, 1.0]);
        assert!((x.hypot(y) - 2.0_f64.sqrt()).abs() < 1e-13);
    }
    // it swings through: the centre comes lower than the pin
    assert!(reports.iter().any(|r| r.bodies[0].center[1] < -0.7));
}

/// A mesh of 4 x 4 elements of a square with the side 1 from a point, its skin, and its velocity along x.
fn mesh(first: usize, [x, y]: [f64; 2], name: &str) -> String {
    let nodes: String = (0..25)
        .map(|k| {
            let at = |i: usize| 0.25 * i as f64;
            format!("{}, {:?}, {:?}\n", first + k, x + at(k % 5), y + at(k / 5))
        })
        .collect();
    let elements: String = (0..16)
        .map(|e| {
            let a = first + e % 4 + 5 * (e / 4);
            format!("{}, {a}, {}, {}, {}\n", first + e, a + 1, a + 6, a + 5)
        })
        .collect();
    format!(
        "*NODE, NSET=N{name}\n{nodes}*ELEMENT, TYPE=CPS4, ELSET={name}\n{elements}\
         *SOLID SECTION, ELSET={name}, MATERIAL=M\n1.\n*SURFACE, NAME=S{name}\n{name},\n"
    )
}

/// Two elastic blocks and a rigid one collide: landing return and redistributed mass hold for the elastic ones.
#[test]
fn landing_return_and_redistributed_mass_leave_bodies_out_that_turn() {
    let run = |settings: &str| {
        let text = format!(
            "{}{}{}{MATERIAL}*NODE\n399, 0.4, 1.9\n*RIGID BODY, ELSET=C, REF NODE=399\n\
             *SURFACE INTERACTION, NAME=I\n*FRICTION\n0.3\n*CONTACT PAIR, INTERACTION=I\n\
             SA, SB\nSB, SA\nSC, SA\nSA, SC\nSC, SB\nSB, SC\n\
             *INITIAL CONDITIONS, TYPE=VELOCITY\nNA, 1, 2.\nNB, 1, -1.\n399, 2, -3.\n399, 6, 1.5\n\
             *STEP, NLGEOM, INC=1000\n*DYNAMIC, DIRECT\n0.01, 0.4\n{settings}*END STEP\n",
            mesh(1, [0.0, 0.0], "A"),
            mesh(101, [1.2, 0.2], "B"),
            square(301, [0.4, 1.9], 0.4, "C"),
        );
        let (keep, _) = run_to_end(&read(&text));
        let reports = keep.reports;
        assert!(
            unbalanced(&reports) < 1e-11,
            "{settings}: {:e}",
            unbalanced(&reports)
        );
        let start = &reports[0].momentum;
        for pair in reports.windows(2) {
            assert!(energy(&pair[1]) <= energy(&pair[0]) * (1.0 + 1e-12));
            let now = &pair[1].momentum;
            (0..2).for_each(|i| assert!((now.linear[i] - start.linear[i]).abs() < 1e-12));
            assert!((now.angular - start.angular).abs() < 1e-11);
        }
        let touch = |contact: usize| reports.iter().any(|r| r.contacts[contact].closed > 0);
        assert!(touch(0) && (touch(2) || touch(3)));
        reports.last().expect("increments").energy
    };
    let plain = run("");
    let returned = run("*STICKSLIP, LANDING=RETURN\n");
    assert!(plain.landing_return == 0.0 && returned.landing_return > 1e-4);
    let redistributed = run("*STICKSLIP, CONTACT MASS=REDISTRIBUTED\n");
    // the elastic blocks lose nothing to impulses, and the rigid one lands on surfaces without mass
    assert!(redistributed.impact_loss < 1e-3 * plain.impact_loss);
    run("*STICKSLIP, LANDING=RETURN, CONTACT MASS=REDISTRIBUTED\n");
}

/// Nodes that move as a rigid body, with mass of elements that deform, under a force, driven by a reference node that
/// changes its velocity, and through an impact: every energy is told, and the velocities leave those of a rigid motion by
/// what falls with the increment.
#[test]
fn nodes_with_mass_of_elements_keep_the_balance() {
    let column = "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n5, 1., 2.\n6, 0., 2.\n9, 0.5, 2.2\n\
                  11, -1., -1.\n12, 2., -1.\n13, 2., -0.006\n14, -1., -0.003\n\
                  *ELEMENT, TYPE=CPE4, ELSET=E\n1, 1, 2, 3, 4\n*ELEMENT, TYPE=CPE4, ELSET=R\n2, 4, 3, 5, 6\n\
                  *ELEMENT, TYPE=CPE4, ELSET=A\n3, 11, 12, 13, 14\n*NSET, NSET=BASE\n11, 12, 13, 14\n\
                  *NSET, NSET=GROUND\n1, 2\n*BOUNDARY\nBASE, 1, 2\n\
                  *SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n*SOLID SECTION, ELSET=R, MATERIAL=M\n1.\n\
                  *SOLID SECTION, ELSET=A, MATERIAL=M\n1.\n*SURFACE, NAME=SA\nA, S3\n*SURFACE, NAME=SB\nE, S1\n\
                  *SURFACE, NAME=JOINT\nE, S3\n*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nSB, SA\n\
                  *AMPLITUDE, NAME=JUMPS\n0., 0., 0.02, 1., 0.05, 0.7, 0.1, 3.\n";
    let rigid = "*RIGID BODY, ELSET=R, REF NODE=9\n";
    let coupled = "*COUPLING, CONSTRAINT NAME=C, REF NODE=9, SURFACE=JOINT\n*KINEMATIC\n";
    let down = "*BOUNDARY, TYPE=VELOCITY\n9, 1, 1\n9, 2, 2, -0.5\n";
    let driven = "*BOUNDARY, AMPLITUDE=JUMPS\n9, 1, 1, 0.004\n9, 2, 2, -0.01\n";
    let turned = "*BOUNDARY, AMPLITUDE=JUMPS\n9, 6, 6, 0.02\n";
    // nodes of the rigid part
    let cases = [
        (
            rigid,
            &[2, 3, 4, 5, 6][..],
            "*BOUNDARY\nGROUND, 1, 2\n*CLOAD\n9, 1, 10.\n",
        ),
        (rigid, &[2, 3, 4, 5, 6], down),
        (rigid, &[2, 3, 4, 5, 6], driven),
        (rigid, &[2, 3, 4, 5, 6], turned),
        (
            coupled,
            &[2, 3, 6],
            "*BOUNDARY\nGROUND, 1, 2\n*CLOAD\n9, 1, 10.\n",
        ),
        (coupled, &[2, 3, 6], down),
        (coupled, &[2, 3, 6], driven),
        (coupled, &[2, 3, 6], turned),
    ];
    let redistributed = "*STICKSLIP, CONTACT MASS=REDISTRIBUTED\n*DYNAMIC, DIRECT";
    let run = |(part, nodes, moved): (&str, &[usize], &str), procedure: &str, dt: f64| {
        let (keep, failure) = run_deck(&format!(
            "{column}{MATERIAL}{part}*STEP, NLGEOM\n{procedure}\n{dt:?}, 0.1\n{moved}*END STEP\n"
        ));
        assert_eq!(failure, None, "{part}{moved}{procedure}");
        let off = unbalanced(&keep.reports);
        assert!(off < 1e-11, "{part}{moved}{procedure}: balance {off:e}");
        let coordinates = [[1.0, 1.0], [0.0, 1.0], [1.0, 2.0], [0.0, 2.0], [0.5, 2.2]];
        let [mut largest, mut size] = [0.0_f64; 2];
        for report in &keep.reports {
            let (u, v) = (&report.state.u, &report.state.v);
            let at = |node: usize, of: &[f64]| [of[2 * node], of[2 * node + 1]];
            let x = |node: usize| {
                let (x, u) = (coordinates[node - 2], at(node, u));
                [x[0] + u[0], x[1] + u[1]]
            };
            // v - v_0 = omega J (x - x_0)
            let relative = |node: usize| {
                let [r, w] = [[x(node), x(nodes[0])], [at(node, v), at(nodes[0], v)]]
                    .map(|[a, b]| [a[0] - b[0], a[1] - b[1]]);
                (r, w)
            };
            let (r, w) = relative(nodes[1]);
            let omega = (r[0] * w[1] - r[1] * w[0]) / (r[0] * r[0] + r[1] * r[1]);
            size = v.iter().fold(size, |size, v| size.max(v.abs()));
            for &node in &nodes[1..] {
                let (r, w) = relative(node);
                let error = (w[0] + omega * r[1]).abs().max((w[1] - omega * r[0]).abs());
                largest = largest.max(error);
            }
        }
        largest / size
    };
    for case in cases {
        for procedure in ["*DYNAMIC, APPLICATION=QUASI-STATIC", redistributed] {
            run(case, procedure, 0.005);
        }
        let [coarse, fine] = [0.005, 0.00125].map(|dt| run(case, "*DYNAMIC, DIRECT", dt));
        let is_small = fine < coarse / 2.0 || fine < 1e-6;
        assert!(is_small, "{case:?}: {coarse:e} {fine:e}");
    }
}
