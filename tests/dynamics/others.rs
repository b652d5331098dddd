//! Decks as Abaqus/CAE, CalculiX, PrePoMax and Gmsh users write them (tests/decks/others), with their right values.

use crate::reading::{read, try_read};
use crate::statics::run_deck;
use stickslip::dynamics::IncrementReport;
use stickslip::model::Model;

/// Model and reports of a deck that runs to its end.
fn finished(text: &str) -> (Model, Vec<IncrementReport>) {
    let (keep, failure) = run_deck(text);
    assert_eq!(failure, None);
    (read(text), keep.reports)
}

/// Displacement at the end of the one node of a set.
fn at_end((model, reports): &(Model, Vec<IncrementReport>), set: &str) -> [f64; 2] {
    let found = model.sets.nodes.iter().find(|known| known.name == set);
    let node = found.unwrap_or_else(|| panic!("{set}")).members[0];
    let u = &reports.last().expect("reports").state.u;
    [u[2 * node], u[2 * node + 1]]
}

/// Stretch of a bar of St. Venant-Kirchhoff material with nu = 0 under a nominal stress: P = E (s^3 - s)/2.
fn stretch(stress: f64, young: f64) -> f64 {
    let mut s = 1.0;
    for _ in 0..50 {
        let rest = young * (s * s * s - s) / 2.0 - stress;
        s -= rest / (young * (3.0 * s * s - 1.0) / 2.0);
    }
    s
}

#[test]
fn what_joins_instances_stands_in_the_assembly() {
    // a column of two squares under the force 10
    let way = 2.0 * (stretch(-10.0, 1000.0) - 1.0);
    for deck in [
        include_str!("../decks/others/tie_coupling_in_assembly.inp"),
        include_str!("../decks/others/mpc_in_assembly.inp"),
        include_str!("../decks/others/mass_in_assembly.inp"),
    ] {
        let [x, y] = at_end(&finished(deck), "m_RP");
        assert!((y - way).abs() < 1e-10, "{y} {way}");
        assert!(x.abs() < 1e-10, "{x}");
    }
}

/// The column with a spring, in an assembly and as a flat deck.
#[test]
fn equations_and_springs_of_the_assembly_are_those_of_a_flat_deck() {
    let deck = include_str!("../decks/others/spring_in_assembly.inp");
    let flat = "*NODE\n1,0.,0.\n2,1.,0.\n3,1.,1.\n4,0.,1.\n11,0.,1.\n12,1.,1.\n13,1.,2.\n14,0.,2.\n\
        *NODE, NSET=RP\n21, 0.5, 2.5\n*ELEMENT, TYPE=CPE4, ELSET=A\n1,1,2,3,4\n*ELEMENT, TYPE=CPE4, ELSET=B\n2,11,12,13,14\n\
        *ELSET, ELSET=ALL\nA, B\n*SURFACE, NAME=TOP\nA, S3\n*SURFACE, NAME=BOTS\nB, S1\n\
        *SOLID SECTION, ELSET=ALL, MATERIAL=M\n,\n*TIE, NAME=T1\nBOTS, TOP\n\
        *EQUATION\n2\n14, 2, 1., 21, 2, -1.\n2\n13, 2, 1., 21, 2, -1.\n\
        *ELEMENT, TYPE=SPRINGA, ELSET=SP\n3, 1, 13\n*SPRING, ELSET=SP\n\n5.\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n\
        *BOUNDARY\n1, 1, 2\n2, 1, 2\n*STEP, NLGEOM\n*STATIC\n0.1, 1., 1e-05, 0.1\n*CLOAD\n21, 2, -10.\n*END STEP\n";
    let [own, flat] = [deck, flat].map(|text| finished(text).1);
    assert_eq!(own.len(), flat.len());
    for (own, flat) in own.iter().zip(&flat) {
        let both = own.state.u.iter().zip(&flat.state.u);
        assert!(both.clone().count() == 18 && both.clone().all(|(a, b)| (a - b).abs() < 1e-12));
    }
    let way = at_end(&finished(deck), "m_RP")[1];
    assert!((way + 0.02).abs() < 1e-3, "{way}");
}

#[test]
fn a_rigid_part_stands_in_its_instance() {
    let deck = include_str!("../decks/others/rigid_body_in_instance.inp");
    let (_, reports) = finished(deck);
    // the tool, moved by 0.1 with its instance, presses the square to 0.9 of its height
    let force = 1000.0 * (0.9_f64.powi(3) - 0.9) / 2.0;
    let last = reports.last().expect("reports");
    let [_, y] = last.contacts[0].force;
    assert!((y.abs() + force).abs() < 1e-9 * force.abs(), "{y} {force}");
    let card = "*Rigid Body, ref node=TOOL-1-RefPt_, analytical surface=RigidSurface_\n";
    let behind = "*End Assembly\n*Rigid Body, ref node=TOOL-1.TOOL-1-RefPt_, analytical surface=TOOL-1.RigidSurface_\n";
    let (_, others) = finished(&deck.replace(card, "").replace("*End Assembly\n", behind));
    assert_eq!(last.state.u, others.last().expect("reports").state.u);
}

#[test]
fn a_profile_moves_with_its_instance() {
    let (_, reports) = finished(include_str!(
        "../decks/others/segments_in_moved_instance.inp"
    ));
    let last = reports.last().expect("reports");
    assert_eq!(last.contacts[0].force, [0.0; 2]);
}

#[test]
fn a_step_defines_a_node_set() {
    let deck = include_str!("../decks/others/nset_in_step.inp");
    let set = "*NSET, NSET=NF\n3\n";
    let before = deck
        .replace(set, "")
        .replace("*STEP", &format!("{set}*STEP"));
    let [own, before] = [deck, &before].map(|text| at_end(&finished(text), "N3"));
    assert_eq!(own, before);
    assert!(own[0] > 0.0);
}

#[test]
fn an_explicit_step_has_an_increment_of_its_own() {
    let deck = include_str!("../decks/others/explicit_blank_first_field.inp");
    let (model, own) = finished(deck);
    // the sides of the mesh are 1 and 0.995 long; a pressure wave in plane strain has M = E (1 - nu)/((1 + nu)(1 - 2 nu))
    let speed = (2e5 * 0.7 / (1.3 * 0.4) / 7.8e-9_f64).sqrt();
    assert!(
        (own[1].dt * speed - 0.995).abs() < 1e-12,
        "{}",
        own[1].dt * speed
    );
    assert_eq!(model.steps[0].increments.dt, own[1].dt);
    let direct = deck.replace(
        "*DYNAMIC, EXPLICIT\n, 1.E-4",
        "*DYNAMIC, DIRECT\n2.5E-8, 1.E-4",
    );
    let (_, fine) = finished(&direct);
    let punch = model.sets.nodes.iter().find(|set| set.name == "NRP");
    let node = punch.expect("NRP").members[0];
    let deepest = |reports: &[IncrementReport]| {
        let depths = reports.iter().map(|report| report.state.u[2 * node + 1]);
        depths.fold(0.0, f64::min)
    };
    let [a, b] = [&own, &fine].map(|reports| deepest(reports));
    assert!((a - b).abs() < 0.02 * b.abs(), "{a} {b}");
}

/// Forces of a load on the right side of a square of side 1 whose nodes are held: at the nodes of the side, at the end of a
/// quarter turn, or of nothing.
fn side_forces(load: &str, element: &str, turns: bool) -> [f64; 2] {
    let moved = |[x, y]: [f64; 2]| if turns { [-y - x, x - y] } else { [0.0; 2] };
    let nodes = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let middle = [[0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]];
    let all = nodes.iter().chain(if element.ends_with('8') {
        &middle[..]
    } else {
        &[]
    });
    let rows: String = (1..)
        .zip(all.clone())
        .map(|(n, [x, y])| format!("{n}, {x:?}, {y:?}\n"))
        .collect();
    let held: String = (1..)
        .zip(all.clone())
        .flat_map(|(n, &at)| {
            let [x, y] = moved(at);
            [format!("{n}, 1, 1, {x:?}\n"), format!("{n}, 2, 2, {y:?}\n")]
        })
        .collect();
    let numbers: Vec<String> = (1..=all.count()).map(|n| n.to_string()).collect();
    let text = format!(
        "*NODE\n{rows}*ELEMENT, TYPE={element}, ELSET=E\n1, {}\n*SURFACE, NAME=R\nE, S2\n\
         *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*DENSITY\n1.\n*SOLID SECTION, ELSET=E, MATERIAL=M\n2.\n\
         *STEP, NLGEOM\n*STATIC\n1., 1.\n*BOUNDARY\n{held}{load}*END STEP\n",
        numbers.join(", ")
    );
    let (model, reports) = finished(&text);
    let reaction = &reports.last().expect("reports").nodal.reaction;
    // a rigid turn has no internal forces: the supports hold the load
    let sum = |i: usize| {
        -(0..model.mesh.node_count())
            .map(|n| reaction[2 * n + i])
            .sum::<f64>()
    };
    [sum(0), sum(1)]
}

#[test]
fn tractions_turn_with_their_faces_where_they_follow() {
    // thickness 2, length 1
    let on = |card: &str, row: &str| format!("*{card}\n{row}\n");
    for element in ["CPS4", "CPS8"] {
        for (load, still, turned) in [
            (
                on("DSLOAD", "R, TRSHR, 10., 3., 4."),
                [0.0, 20.0],
                [-20.0, 0.0],
            ),
            (
                on("DSLOAD", "R, TRSHR, 10., 1., -0.1"),
                [0.0, -20.0],
                [20.0, 0.0],
            ),
            (
                on("DLOAD", "E, TRSHR2, 10., 0., 1."),
                [0.0, 20.0],
                [-20.0, 0.0],
            ),
            (
                on("DSLOAD", "R, TRVEC, 10., 3., 4."),
                [12.0, 16.0],
                [-16.0, 12.0],
            ),
            (
                on("DSLOAD, FOLLOWER=YES", "R, TRVEC, 10., -1., 0."),
                [-20.0, 0.0],
                [0.0, -20.0],
            ),
            (
                on("DLOAD", "1, TRVEC2, 10., 3., 4."),
                [12.0, 16.0],
                [-16.0, 12.0],
            ),
            (
                on("DSLOAD, FOLLOWER=NO", "R, TRVEC, 10., 3., 4."),
                [12.0, 16.0],
                [12.0, 16.0],
            ),
            (on("DSLOAD", "R, P, 10."), [-20.0, 0.0], [0.0, -20.0]),
        ] {
            for (turns, wanted) in [(false, still), (true, turned)] {
                let found = side_forces(&load, element, turns);
                let error = (found[0] - wanted[0]).hypot(found[1] - wanted[1]);
                assert!(
                    error < 1e-10,
                    "{load}{element} {turns}: {found:?} {wanted:?}"
                );
            }
        }
    }
}

#[test]
fn a_shear_acts_as_the_forces_of_its_nodes() {
    let deck = include_str!("../decks/others/traction_TRSHR.inp").replace("1000.,0.", "1E9,0.");
    let forces = deck.replace(
        "*DSLOAD\nR, TRSHR, 10., 1., 0., 0.",
        "*CLOAD\n4, 1, 5.\n3, 1, 5.",
    );
    assert_ne!(deck, forces);
    // small displacements: the face has not turned
    let [a, b] = [&deck, &forces].map(|text| at_end(&finished(text), "N3"));
    assert!(
        b[0] > 1e-9 && (a[0] - b[0]).abs() < 1e-7 * b[0],
        "{a:?} {b:?}"
    );
    let across = deck.replace("TRSHR, 10., 1., 0.", "TRSHR, 10., 0., 1.");
    let (model, _, messages) = try_read(&across);
    assert!(
        model.is_none() && messages.contains("points across the face"),
        "{messages}"
    );
}

/// A rigid wall of lines is the drawn one, whatever the order and direction of the lines.
#[test]
fn rigid_lines_are_a_profile() {
    let deck = include_str!("../decks/others/discrete_rigid_R2D2.inp");
    let elements = "*ELEMENT,TYPE=R2D2,ELSET=ER\n11,12,11\n*RIGID BODY,ELSET=ER,REF NODE=13\n";
    let drawn = deck.replace(elements, "").replace(
        "*SURFACE,NAME=WALL\nER,SPOS\n",
        "*SURFACE,NAME=WALL,TYPE=SEGMENTS\nSTART, 2., 1.\nLINE, -1., 1.\n\
         *RIGID BODY,ANALYTICAL SURFACE=WALL,REF NODE=13\n",
    );
    assert!(drawn.contains("START") && drawn.contains("ANALYTICAL"));
    let result = |text: &str| {
        let (model, reports) = finished(text);
        assert!(model.surfaces.iter().any(|surface| surface.name == "WALL"));
        let last = reports.last().expect("reports");
        (last.state.u[..8].to_vec(), last.contacts[0].force)
    };
    let wanted = result(&drawn);
    // nu = 0: the stress of a height of 0.9
    let force = 1000.0 * (0.9_f64.powi(3) - 0.9) / 2.0;
    assert!((wanted.1[1].abs() + force).abs() < 1e-9 * force.abs());
    let other = |elements: &str, side: &str| {
        let rows = format!("*NODE\n14, 0.6, 1.\n*ELEMENT,TYPE=RAX2,ELSET=ER\n{elements}*RIGID");
        deck.replace("*ELEMENT,TYPE=R2D2,ELSET=ER\n11,12,11\n*RIGID", &rows)
            .replace("ER,SPOS", side)
    };
    for text in [
        deck.to_owned(),
        other("11, 11, 12\n", "ER, SNEG"),
        other("11, 14, 11\n12, 12, 14\n", "ER, SPOS"),
        other("11, 14, 11\n12, 14, 12\n", "11, SPOS\n12, SNEG"),
    ] {
        let (u, f) = result(&text);
        let near = u.iter().zip(&wanted.0).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(near && (f[1] - wanted.1[1]).abs() < 1e-10, "{text}");
    }
    for (text, said) in [
        (
            other("11, 14, 11\n12, 14, 12\n", "ER, SPOS"),
            "meet at node 14",
        ),
        (
            other("11, 11, 12\n", "ER, SNEG\nE, S3"),
            "no side SPOS or SNEG",
        ),
        (other("11, 11, 12\n", "ER"), "no side SPOS or SNEG"),
        (
            deck.replace("*RIGID BODY,ELSET=ER", "*RIGID BODY,NSET=N"),
            "N is not defined",
        ),
        (
            deck.replace("*SURFACE,NAME=WALL\nER,SPOS\n", "")
                .replace("TOP,WALL", "TOP"),
            "make no surface",
        ),
    ] {
        let (model, _, messages) = try_read(&text);
        assert!(
            model.is_none() && messages.contains(said),
            "{said}\n{messages}"
        );
    }
}

/// Largest imbalance of the ledger in energies of their scale.
fn imbalance(reports: &[IncrementReport]) -> f64 {
    let parts = reports
        .iter()
        .map(|report| report.energy.balance.abs() / report.energy.scale);
    parts.filter(|part| part.is_finite()).fold(0.0, f64::max)
}

/// A mass on a node of a block does nothing in statics, and has its weight.
#[test]
fn a_mass_on_a_node_of_a_block_has_its_weight() {
    let deck = include_str!("../decks/others/mass_on_node.inp");
    let without = deck.replace("*ELEMENT,TYPE=MASS,ELSET=PM\n9,3\n*MASS,ELSET=PM\n2.\n", "");
    assert_ne!(deck, without);
    let [with, without] = [deck, &without].map(|text| at_end(&finished(text), "N3"));
    assert_eq!(with, without);
    // weight 2 x 5 along x
    let weight = deck.replace("*CLOAD\n3,1,10.", "*DLOAD\nPM, GRAV, 5., 1., 0.");
    let weight = at_end(&finished(&weight), "N3");
    assert!((weight[0] - with[0]).hypot(weight[1] - with[1]) < 1e-12);
}

/// A mass that hangs on a spring: rest under its weight, and its period.
#[test]
fn a_mass_on_a_spring_is_an_oscillator() {
    let deck = |procedure: &str| {
        format!(
            "*NODE, NSET=FOOT\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n*NODE, NSET=HUNG\n5, 0.5, -3.\n\
             *ELEMENT, TYPE=CPS4, ELSET=E\n1, 1, 2, 3, 4\n*ELEMENT, TYPE=SPRING1, ELSET=S\n2, 5\n\
             *SPRING, ELSET=S\n2\n8.\n*ELEMENT, TYPE=MASS, ELSET=PM\n3, 5\n*MASS, ELSET=PM\n2.\n\
             *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*DENSITY\n1.\n*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n\
             *BOUNDARY\nFOOT, 1, 2\n5, 1\n*STEP, NLGEOM\n{procedure}\n*DLOAD\nPM, GRAV, 10., 0., -1.\n*END STEP\n"
        )
    };
    // k = 8, m = 2: sag m g/k = 2.5, omega = 2
    let rest = at_end(&finished(&deck("*STATIC\n1., 1.")), "HUNG");
    assert!((rest[1] + 2.5).abs() < 1e-12, "{rest:?}");
    let (model, reports) = finished(&deck("*DYNAMIC, DIRECT\n0.002, 2."));
    let node = model
        .sets
        .nodes
        .iter()
        .find(|set| set.name == "HUNG")
        .expect("HUNG")
        .members[0];
    for report in &reports {
        let exact = -2.5 * (1.0 - (2.0 * report.time).cos());
        let off = report.state.u[2 * node + 1] - exact;
        assert!(off.abs() < 2.5 * 1e-5, "{}: {off:e}", report.time);
    }
    assert!(imbalance(&reports) < 1e-12, "{:e}", imbalance(&reports));
    let (_, _, messages) = try_read(&deck("*STATIC").replace(
        "*ELEMENT, TYPE=SPRING1, ELSET=S\n2, 5\n*SPRING, ELSET=S\n2\n8.\n",
        "",
    ));
    assert!(
        messages.contains("belongs to no element, spring or rigid body"),
        "{messages}"
    );
}

/// A free block with a mass at a corner: momentum, angular momentum and energy are kept, also where its surface hands its
/// mass on.
#[test]
fn a_block_with_a_mass_at_a_corner_flies_freely() {
    for setting in ["", "*STICKSLIP, CONTACT MASS=REDISTRIBUTED\n"] {
        let text = format!(
            "*NODE, NSET=ALL\n1, 0., 0.\n2, 1., 0.\n3, 2., 0.\n4, 0., 1.\n5, 1., 1.\n6, 2., 1.\n\
             7, 0., 2.\n8, 1., 2.\n9, 2., 2.\n\
             *NODE, NSET=REF\n20, 0., -9.\n*ELEMENT, TYPE=CPE4, ELSET=E\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n3, 4, 5, 8, 7\n4, 5, 6, 9, 8\n\
             *SURFACE, NAME=SOLE\n1, S1\n2, S1\n*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, -9., -0.5\nLINE, 9., -0.5\n\
             *RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=20\n\
             *ELEMENT, TYPE=MASS, ELSET=PM\n5, 1\n*MASS, ELSET=PM\n3.\n\
             *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n\
             *SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nSOLE, FLOOR\n*BOUNDARY\nREF, 1, 2\n\
             *INITIAL CONDITIONS, TYPE=VELOCITY\nALL, 1, 2.\nALL, 2, 1.\n9, 1, 5.\n\
             *STEP, NLGEOM\n{setting}*DYNAMIC, DIRECT\n0.01, 0.3\n*END STEP\n"
        );
        let (_, reports) = finished(&text);
        let [first, last] = [&reports[0], reports.last().expect("reports")];
        // four of the elements and three of the point, both with 2, 1, and the corner's part of its element
        assert!(
            (first.momentum.linear[1] - 7.0).abs() < 1e-12,
            "{:?}",
            first.momentum.linear
        );
        for (a, b) in first.momentum.linear.iter().zip(last.momentum.linear) {
            assert!((a - b).abs() < 1e-11, "{a} {b}");
        }
        assert!((first.momentum.angular - last.momentum.angular).abs() < 1e-10);
        assert!(imbalance(&reports) < 1e-12, "{:e}", imbalance(&reports));
        // the body has the whole mass, and its motion the whole momentum
        let body = &last.bodies[0];
        assert!((body.velocity[1] * 7.0 - last.momentum.linear[1]).abs() < 1e-11);
    }
}

#[test]
fn axes_of_a_section_with_an_isotropic_material_change_nothing() {
    let deck = include_str!("../decks/others/orientation_isotropic.inp");
    let plain = deck
        .replace(", ORIENTATION=O", "")
        .replace("*ORIENTATION, NAME=O\n1.,0.,0.,0.,1.,0.\n", "");
    let (model, _, messages) = try_read(deck);
    assert_eq!(model, Some(read(&plain)));
    for said in [
        "ORIENTATION of *SOLID SECTION is left out",
        "*ORIENTATION is left out",
    ] {
        assert!(messages.contains(said), "{messages}");
    }
}

#[test]
fn a_punch_without_mass_is_pressed_by_a_force_in_a_static_step() {
    let [_, y] = at_end(
        &finished(include_str!("../decks/others/force_on_rigid_static.inp")),
        "NREF",
    );
    assert!((y - (stretch(-10.0, 1000.0) - 1.0)).abs() < 1e-10, "{y}");
}

/// Springs in a direction that *ORIENTATION gives act along it.
#[test]
fn springs_act_along_their_axes() {
    let deck = |axes: &str, row: &str| {
        format!(
            "*NODE, NSET=FOOT\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n*NODE, NSET=END\n5, 3., 3.\n\
             *ELEMENT, TYPE=CPS4, ELSET=E\n1, 1, 2, 3, 4\n*ELEMENT, TYPE=SPRING1, ELSET=S\n2, 5\n\
             *ELEMENT, TYPE=SPRING1, ELSET=T\n3, 5\n*ORIENTATION, NAME=O\n{axes}\n\
             *SPRING, ELSET=S, ORIENTATION=O\n{row}\n10.\n*SPRING, ELSET=T\n1\n10.\n\
             *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n*BOUNDARY\nFOOT, 1, 2\n\
             *STEP, NLGEOM\n*STATIC\n1., 1.\n*CLOAD\n5, 1, 3.\n5, 2, 4.\n*END STEP\n"
        )
    };
    // 10 (n n^T + e e^T) u = (3, 4) along n and x
    let solution = |[a, b]: [f64; 2]| {
        let (k11, k12, k22) = (10.0 + 10.0 * a * a, 10.0 * a * b, 10.0 * b * b);
        let det = k11 * k22 - k12 * k12;
        [(k22 * 3.0 - k12 * 4.0) / det, (k11 * 4.0 - k12 * 3.0) / det]
    };
    for (axes, row, along) in [
        ("3., 4., 0., -1., 0., 0.", "1", [0.6, 0.8]),
        ("3., 4., 0., -1., 0., 0.", "2", [-0.8, 0.6]),
        ("3., 4., 0., 1., 0., 0.", "2", [0.8, -0.6]),
        ("4., 6., 0., 0., 2., 0., 1., 2., 0.", "1", [0.6, 0.8]),
        ("4., 0., 0., 0., 1., 0.\n3, 90.", "1", [0.0, 1.0]),
        (
            "0., 1., 0., 1., 0., 0.\n3, 60.",
            "1",
            [3f64.sqrt() / 2.0, 0.5],
        ),
    ] {
        let [x, y] = at_end(&finished(&deck(axes, row)), "END");
        let wanted = solution(along);
        assert!(
            (x - wanted[0]).hypot(y - wanted[1]) < 1e-11,
            "{axes}: {x} {y} {wanted:?}"
        );
    }
    for (axes, said) in [
        ("1., 0., 1., 0., 1., 0.", "do not lie in the plane"),
        ("1., 0., 0., 2., 0., 0.", "do not lie in the plane"),
        ("1., 0., 0., 0., 1., 0.\n1, 30.", "leads out of the plane"),
    ] {
        let (model, _, messages) = try_read(&deck(axes, "1"));
        assert!(model.is_none() && messages.contains(said), "{messages}");
    }
    let round =
        deck("1., 0., 0., 0., 1., 0.", "1").replace("NAME=O\n", "NAME=O, SYSTEM=CYLINDRICAL\n");
    let (model, _, messages) = try_read(&round);
    assert!(
        model.is_none() && messages.contains("SYSTEM=CYLINDRICAL"),
        "{messages}"
    );
}
