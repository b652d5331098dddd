//! Every pair of what may meet at one node: rigid bodies, couplings, ties, `*MPC`, equations, springs, sections, supports,
//! loads, velocities and masses. A pair works, and then both hold, or it is an error that names both cards.

use std::collections::BTreeMap;

use stickslip::diagnostics::Severity;
use stickslip::dynamics::{IncrementReport, Outcome};
use stickslip::model::{Equation, Model};

use crate::blocks::{Keep, run, run_to_end};
use crate::reading::{read, try_read};

/// A block of two elements on a support, and a block on it that nothing joins to it; node 90 belongs to neither.
const BASE: &str = "*NODE\n1, 0., 0.\n2, 1., 0.\n5, 1., .5\n6, 0., .5\n3, 1., 1.\n4, 0., 1.\n11, 0., 1.\n12, 1., 1.\n\
    13, 1., 2.\n14, 0., 2.\n80, .5, 2.5\n81, .5, 2.6\n82, .5, 2.7\n83, .5, 1.5\n90, 1., 1.\n\
    *ELEMENT, TYPE=CPE4, ELSET=A\n1, 1, 2, 5, 6\n3, 6, 5, 3, 4\n*ELEMENT, TYPE=CPE4, ELSET=B\n2, 11, 12, 13, 14\n\
    *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n*SOLID SECTION, ELSET=A, MATERIAL=M\n\
    *SOLID SECTION, ELSET=B, MATERIAL=M\n*SURFACE, NAME=BB\n2, S1\n*SURFACE, NAME=AT\n3, S3\n*SURFACE, NAME=CUT\n1, S3\n\
    *NSET, NSET=TOP\n13, 14\n*BOUNDARY\n1, 1, 2\n2, 1, 2\n";

/// What may meet at node N: its name, model cards, cards in the step.
const FEATURES: [(&str, &str, &str); 24] = [
    (
        "rider",
        "*NSET, NSET=R\nN, 13, 14\n*RIGID BODY, TIE NSET=R, REF NODE=80\n",
        "",
    ),
    ("reference", "*RIGID BODY, NSET=TOP, REF NODE=N\n", ""),
    (
        "kinematic rider",
        "*KINEMATIC COUPLING, REF NODE=81, NAME=KR\nN, 1, 2\n13, 1, 2\n14, 1, 2\n",
        "",
    ),
    (
        "kinematic reference",
        "*KINEMATIC COUPLING, REF NODE=N, NAME=KC\n13, 1, 2\n14, 1, 2\n",
        "",
    ),
    (
        "distributing member",
        "*SURFACE, NAME=DM, TYPE=NODE\nN,\n14,\n*COUPLING, CONSTRAINT NAME=DMC, REF NODE=82, SURFACE=DM\n*DISTRIBUTING\n",
        "",
    ),
    (
        "distributing reference",
        "*SURFACE, NAME=DR, TYPE=NODE\n13,\n14,\n*COUPLING, CONSTRAINT NAME=DRC, REF NODE=N, SURFACE=DR\n*DISTRIBUTING\n",
        "",
    ),
    (
        "tie slave",
        "*SURFACE, NAME=TS, TYPE=NODE\nN,\n*TIE, NAME=TIS, POSITION TOLERANCE=.1, ADJUST=NO\nTS, BB\n",
        "",
    ),
    (
        "tie master",
        "*SURFACE, NAME=TM, TYPE=NODE\n12,\n*TIE, NAME=TIM, POSITION TOLERANCE=.1\nTM, AT\n",
        "",
    ),
    ("beam rider", "*MPC\nBEAM, N, 83\nBEAM, 14, 83\n", ""),
    ("beam reference", "*MPC\nBEAM, 14, N\nBEAM, 13, N\n", ""),
    ("pin first", "*MPC\nPIN, N, 12\n", ""),
    ("pin second", "*MPC\nPIN, 12, N\n", ""),
    ("equation first", "*EQUATION\n2\nN, 1, 1., 13, 1, -1.\n", ""),
    (
        "equation second",
        "*EQUATION\n2\n14, 1, 1., N, 1, -1.\n",
        "",
    ),
    (
        "spring",
        "*ELEMENT, TYPE=SPRING1, ELSET=SP\n50, N\n*SPRING, ELSET=SP\n1\n5.\n",
        "",
    ),
    ("section", "*PRE-TENSION SECTION, NODE=N, SURFACE=CUT\n", ""),
    ("support", "", "*BOUNDARY\nN, 1\n"),
    ("motion", "", "*BOUNDARY\nN, 1, 1, 0.001\n"),
    ("rotation", "", "*BOUNDARY\nN, 6, 6, 0.001\n"),
    ("force", "", "*CLOAD\nN, 1, 1.\n"),
    ("moment", "", "*CLOAD\nN, 6, .1\n"),
    (
        "velocity",
        "*INITIAL CONDITIONS, TYPE=VELOCITY\nN, 1, .1\n",
        "",
    ),
    (
        "mass",
        "*ELEMENT, TYPE=MASS, ELSET=EM\n60, N\n*MASS, ELSET=EM\n1.\n",
        "",
    ),
    (
        "rotary inertia",
        "*ELEMENT, TYPE=ROTARYI, ELSET=ER\n61, N\n*ROTARY INERTIA, ELSET=ER\n, , 1.\n",
        "",
    ),
];

/// Model or errors with the titles of the other cards that they name, of features at a node.
fn meet(features: &[usize], node: &str) -> Result<Model, Vec<(String, Option<String>)>> {
    let own = |cards: &str| {
        let fields = cards.split_inclusive(['\n', ' ', ',', '=']);
        let mut text = String::new();
        for field in fields {
            let word = field.trim_end_matches(['\n', ' ', ',', '=']);
            match word {
                "N" => text.push_str(&field.replacen('N', node, 1)),
                _ => text.push_str(field),
            }
        }
        text
    };
    let model: String = features.iter().map(|&f| own(FEATURES[f].1)).collect();
    let step: String = features.iter().map(|&f| own(FEATURES[f].2)).collect();
    let text = format!(
        "{BASE}{model}*STEP, NLGEOM\n*DYNAMIC, DIRECT\n.002, .006\n{step}*DLOAD\nB, GRAV, 1., 0., -1.\n*END STEP\n"
    );
    let (model, d, _) = try_read(&text);
    model.ok_or_else(|| {
        let errors = d.iter().filter(|item| item.severity == Severity::Error);
        let other = errors.map(|item| {
            let other = item.other.as_ref().map(|(what, _)| what.clone());
            (item.message.clone(), other)
        });
        other.collect()
    })
}

/// Largest violation of what holds at the nodes of a model: rigid bodies keep their distances, equations hold.
fn violation(model: &Model, last: &IncrementReport) -> f64 {
    let at =
        |node: usize| [0, 1].map(|i| model.mesh.coordinates[node][i] + last.state.u[2 * node + i]);
    let distance = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
    let of_bodies = model.rigid_bodies.iter().flat_map(|body| {
        let [from, x] = [at(body.reference), model.mesh.coordinates[body.reference]];
        let change = move |&node: &usize| {
            distance(at(node), from) - distance(model.mesh.coordinates[node], x)
        };
        body.nodes.iter().map(change)
    });
    let of_equations = model.equations.iter().map(|Equation { dof, terms }| {
        let sum: f64 = terms.iter().map(|(to, c)| c * last.state.u[*to]).sum();
        last.state.u[*dof] - sum
    });
    of_bodies
        .chain(of_equations)
        .fold(0.0, |most, v| most.max(v.abs()))
}

/// Pairs of 24 features at a node of an element (3) and at one of none (90).
#[test]
fn every_pair_at_one_node_works_or_is_an_error_that_names_both() {
    let mut faults = Vec::new();
    let mut works = BTreeMap::new();
    let alone: Vec<_> = (0..FEATURES.len())
        .map(|f| {
            let of_both = ["3", "90"].into_iter();
            let errors = of_both.filter_map(|node| meet(&[f], node).err());
            errors.flatten().collect::<Vec<_>>()
        })
        .collect();
    for node in ["3", "90"] {
        for (a, first) in FEATURES.iter().enumerate() {
            for (b, second) in FEATURES.iter().enumerate().skip(a + 1) {
                let names = format!("{} and {} at {node}", first.0, second.0);
                let model = match meet(&[a, b], node) {
                    Ok(model) => model,
                    Err(errors) => {
                        let known = |(message, _): &(String, Option<String>)| {
                            let mut own = [a, b].into_iter().flat_map(|f| &alone[f]);
                            own.any(|(known, _)| known == message)
                        };
                        // an error of one alone, or one that names the other card
                        if !errors.iter().all(|error| known(error) || error.1.is_some()) {
                            faults.push(format!("{names}: {errors:?}"));
                        }
                        continue;
                    }
                };
                let mut keep = Keep::default();
                let summary = run(&model, &mut keep).expect("the observer never fails");
                let Some(last) = keep
                    .reports
                    .last()
                    .filter(|_| summary.outcome == Outcome::Finished)
                else {
                    faults.push(format!("{names}: the run stops"));
                    continue;
                };
                *works.entry(node).or_insert(0) += 1;
                let energy = |r: &IncrementReport| {
                    r.energy.kinetic + r.energy.strain + r.energy.external_work.abs()
                };
                let largest = keep
                    .reports
                    .iter()
                    .map(energy)
                    .fold(f64::MIN_POSITIVE, f64::max);
                let balance = last.energy.balance.abs() / largest;
                let violation = violation(&model, last);
                if !(violation < 1e-13 && balance < 1e-9) {
                    faults.push(format!(
                        "{names}: violation {violation:e}, balance {balance:e}"
                    ));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}\n{works:?}", faults.join("\n"));
    assert!(works["3"] > 100 && works["90"] > 80, "{works:?}");
}

/// Displacement of a node with this number at the end of a run.
fn displacement(model: &Model, keep: &Keep, label: u64) -> [f64; 2] {
    let labels = &model.mesh.node_labels;
    let node = labels.iter().position(|&l| l == label).expect("a node");
    let last = keep.reports.last().expect("increments");
    [0, 1].map(|i| last.state.u[2 * node + i])
}

/// Two profiles and a block with one reference node turn together.
#[test]
fn cards_with_one_reference_node_make_one_body() {
    let text = format!(
        "{BASE}*SURFACE, NAME=F1, TYPE=SEGMENTS\nSTART, -1., -1.\nLINE, 3., -1.\n*SURFACE, NAME=F2, TYPE=SEGMENTS\n\
         START, 4., -1.\nLINE, 6., -1.\n*RIGID BODY, ANALYTICAL SURFACE=F1, REF NODE=90\n\
         *RIGID BODY, ELSET=B, ANALYTICAL SURFACE=F2, REF NODE=90\n*STEP, NLGEOM\n*DYNAMIC, DIRECT\n.002, .02\n\
         *BOUNDARY\n90, 1, 2\n90, 6, 6, .1\n*END STEP\n"
    );
    let model = read(&text);
    assert_eq!(model.rigid_bodies.len(), 1);
    let (keep, _) = run_to_end(&model);
    let (sin, cos) = 0.1_f64.sin_cos();
    let x = &model.mesh.coordinates;
    let last = keep.reports.last().expect("increments");
    let body = &model.rigid_bodies[0];
    assert_eq!(body.nodes.len(), 8);
    for &node in &body.nodes {
        let [rx, ry] = [x[node][0] - 1.0, x[node][1] - 1.0];
        let expected = [cos * rx - sin * ry - rx, sin * rx + cos * ry - ry];
        for (i, expected) in expected.into_iter().enumerate() {
            assert!((last.state.u[2 * node + i] - expected).abs() < 1e-14);
        }
    }
}

/// Elements, and nodes of another block that TIE NSET names, move with one node; RF of the reference node is what holds all.
#[test]
fn all_that_a_card_of_a_rigid_body_names_moves_with_it() {
    let text = format!(
        "{BASE}*NSET, NSET=JOIN\n3, 4\n*RIGID BODY, ELSET=B, TIE NSET=JOIN, REF NODE=90\n*STEP, NLGEOM\n*STATIC\n1., 1.\n\
         *BOUNDARY\n90, 1, 1\n90, 6, 6\n90, 2, 2, .01\n*END STEP\n"
    );
    let model = read(&text);
    let (keep, _) = run_to_end(&model);
    for label in [3, 4, 11, 14] {
        let [ux, uy] = displacement(&model, &keep, label);
        assert!(
            ux.abs() < 1e-15 && (uy - 0.01).abs() < 1e-15,
            "{label}: {ux} {uy}"
        );
    }
    let last = keep.reports.last().expect("increments");
    // E (1 - nu)/((1 + nu) (1 - 2 nu)) of a block that is held sideways at its ends, 1 high
    let node = |label: u64| {
        model
            .mesh
            .node_labels
            .iter()
            .position(|&l| l == label)
            .expect("a node")
    };
    let held = last.nodal.reaction[2 * node(90) + 1];
    let base: f64 = [1, 2]
        .map(|label| last.nodal.reaction[2 * node(label) + 1])
        .iter()
        .sum();
    assert!(
        (held + base).abs() < 1e-9 * held && held > 10.0,
        "{held} {base}"
    );
}

/// A punch without mass, and nodes of a block, under a force in a static step.
#[test]
fn static_steps_need_no_mass() {
    let step = "*STEP, NLGEOM\n*STATIC\n1., 1.\n*CLOAD\n90, 2, -10.\n*END STEP\n";
    let by = |cards: &str| {
        let model = read(&format!("{BASE}*BOUNDARY\n11, 1, 2\n12, 2\n{cards}{step}"));
        let (keep, _) = run_to_end(&model);
        displacement(&model, &keep, 90)
    };
    let tied = by("*RIGID BODY, TIE NSET=TOP, REF NODE=90\n*BOUNDARY\n90, 1\n90, 6\n");
    let coupled =
        by("*KINEMATIC COUPLING, REF NODE=90\n13, 1, 2\n14, 1, 2\n*BOUNDARY\n90, 1\n90, 6\n");
    assert_eq!(tied, coupled);
    let punch = "*SURFACE, NAME=BT\n2, S3\n*SURFACE, NAME=TOOL, TYPE=SEGMENTS\nSTART, 2., 2.\nLINE, -1., 2.\n\
                 *RIGID BODY, ANALYTICAL SURFACE=TOOL, REF NODE=90\n*SURFACE INTERACTION, NAME=I\n\
                 *CONTACT PAIR, INTERACTION=I\nBT, TOOL\n*BOUNDARY\n90, 1\n90, 6\n";
    let massive = format!("{punch}*ELEMENT, TYPE=MASS, ELSET=EM\n60, 90\n*MASS, ELSET=EM\n7.\n");
    let [light, heavy] = [by(punch), by(&massive)];
    assert!(
        (light[1] - heavy[1]).abs() < 1e-12 * light[1].abs(),
        "{light:?} {heavy:?}"
    );
    assert!(light[1] < -0.008 && light[1] > -0.012, "{light:?}");
}

/// Rings under a force on a rigid punch with mass, and on coupled nodes: the base carries all of it.
#[test]
fn rigid_bodies_around_an_axis_move_along_it() {
    let block = "*NODE\n1, 1., 0.\n2, 2., 0.\n3, 2., 1.\n4, 1., 1.\n9, 0., 1.5\n*ELEMENT, TYPE=CAX4, ELSET=E\n1, 1, 2, 3, 4\n\
                 *SOLID SECTION, ELSET=E, MATERIAL=M\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SURFACE, NAME=TOP\n1, S3\n";
    let punch = "*SURFACE, NAME=TOOL, TYPE=SEGMENTS\nSTART, 3., 1.\nLINE, 0., 1.\n\
                 *RIGID BODY, ANALYTICAL SURFACE=TOOL, REF NODE=9\n*ELEMENT, TYPE=MASS, ELSET=EM\n60, 9\n*MASS, ELSET=EM\n7.\n\
                 *SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nTOP, TOOL\n";
    let coupling = "*COUPLING, CONSTRAINT NAME=C, REF NODE=9, SURFACE=TOP\n*KINEMATIC\n";
    for cards in [punch, coupling] {
        let model = read(&format!(
            "{block}{cards}*BOUNDARY\n1, 1, 2\n2, 1, 2\n9, 1\n9, 6\n*STEP, NLGEOM\n*STATIC\n1., 1.\n*CLOAD\n9, 2, -10.\n\
             *END STEP\n"
        ));
        let (keep, _) = run_to_end(&model);
        let last = keep.reports.last().expect("increments");
        let base = last.nodal.reaction[1] + last.nodal.reaction[3];
        assert!((base - 10.0).abs() < 1e-8, "{base}");
    }
}

/// A rigid hammer that supports keep from turning lands on a block: the return gives back what landings take.
#[test]
fn landings_of_a_body_whose_rotation_is_held_are_returned() {
    let text = |landing: &str| {
        format!(
            "{BASE}*RIGID BODY, ELSET=B, REF NODE=80\n*SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nBB, AT\n\
             *INITIAL CONDITIONS, TYPE=VELOCITY\n80, 2, -1.\n*BOUNDARY\n80, 1\n80, 6\n*STEP, NLGEOM\n\
             *DYNAMIC, DIRECT\n.002, .2\n*STICKSLIP, LANDING={landing}\n*END STEP\n"
        )
    };
    // it lands within an increment
    let raised = |text: &str| {
        let text = text.replacen("11, 0., 1.", "11, 0., 1.0213", 1);
        text.replacen("12, 1., 1.", "12, 1., 1.0213", 1)
    };
    let returned = |landing: &str| {
        let (keep, _) = run_to_end(&read(&raised(&text(landing))));
        keep.reports
            .last()
            .expect("increments")
            .energy
            .landing_return
            .abs()
    };
    assert_eq!(returned("PLASTIC"), 0.0);
    // a tenth of the energy of the fall at least
    let returned = returned("RETURN");
    assert!(returned > 0.05, "{returned}");
}

/// The force of a bolt is a tension, whichever way the normal of its section points; RF and load make it together.
#[test]
fn the_normal_of_a_section_may_point_either_way() {
    let stress = |normal: &str, second: &str| {
        let model = read(&format!(
            "{BASE}*PRE-TENSION SECTION, NODE=90, SURFACE=CUT\n{normal}*BOUNDARY\n3, 1, 2\n4, 1, 2\n*STEP, NLGEOM\n*STATIC\n\
             1., 1.\n*CLOAD\n90, 1, 5.\n*END STEP\n{second}"
        ));
        let (keep, _) = run_to_end(&model);
        let node = model
            .mesh
            .node_labels
            .iter()
            .position(|&l| l == 90)
            .expect("a node");
        let last = keep.reports.last().expect("increments");
        let base: f64 = [0, 1]
            .map(|node| last.nodal.reaction[2 * node + 1])
            .iter()
            .sum();
        [base, last.nodal.reaction[2 * node]]
    };
    let mean = stress("", "");
    for normal in ["0., 1.\n", "0., -1.\n"] {
        assert_eq!(stress(normal, ""), mean);
    }
    // the support pulls the base down
    assert!((mean[0] + 5.0).abs() < 1e-9, "{mean:?}");
    let locked =
        |op: &str| format!("*STEP\n*STATIC\n1., 1.\n*BOUNDARY, FIXED\n90, 1\n{op}*END STEP\n");
    let kept = stress("", &locked(""));
    let removed = stress("", &locked("*CLOAD, OP=NEW\n"));
    assert!(
        (kept[0] + 5.0).abs() < 1e-9 && kept[1].abs() < 1e-9,
        "{kept:?}"
    );
    assert!(
        (removed[0] + 5.0).abs() < 1e-9 && (removed[1] - 5.0).abs() < 1e-9,
        "{removed:?}"
    );
}
