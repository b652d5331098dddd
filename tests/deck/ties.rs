//! Ties: which nodes follow which others, as nodes on segments and from surface to surface.

use std::collections::BTreeSet;
use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;

use stickslip::diagnostics::Code;
use stickslip::model::{ContactFormulation, Equation, Model};

use crate::reading::{read, try_read};

/// A row of elements between two curves, numbered from a first number on; nodes between the corners with `CPE8`.
fn row(
    name: &str,
    (first, count): (usize, usize),
    element_type: &str,
    place: impl Fn(f64, f64) -> [f64; 2],
) -> String {
    let columns = 2 * count + 1;
    let label = |i: usize, j: usize| first + j * columns + i;
    let is_quadratic = element_type.ends_with('8');
    let mut text = format!("*NODE, NSET=N{name}\n");
    for (i, j) in (0..3).flat_map(|j| (0..columns).map(move |i| (i, j))) {
        let between = i % 2 + j % 2;
        if between == 0 || is_quadratic && between == 1 {
            let [x, y] = place(i as f64 / (2 * count) as f64, j as f64 / 2.0);
            writeln!(text, "{}, {x:?}, {y:?}", label(i, j)).expect("a string");
        }
    }
    writeln!(text, "*ELEMENT, TYPE={element_type}, ELSET=E{name}").expect("a string");
    let corners = [(0, 0), (2, 0), (2, 2), (0, 2)];
    let middles = [(1, 0), (2, 1), (1, 2), (0, 1)];
    for k in 0..count {
        let own = match is_quadratic {
            true => [corners, middles].concat(),
            false => corners.to_vec(),
        };
        let nodes = own
            .iter()
            .map(|(i, j)| label(2 * k + i, *j).to_string())
            .collect::<Vec<_>>();
        writeln!(text, "{}, {}", first + k, nodes.join(", ")).expect("a string");
    }
    text + &format!(
        "*SURFACE, NAME={name}BOTTOM\nE{name}, S1\n*SURFACE, NAME={name}TOP\nE{name}, S3\n\
         *SOLID SECTION, ELSET=E{name}, MATERIAL=M\n1.\n"
    )
}

const MATERIAL: &str = "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n";
const STEP: &str = "*STEP, NLGEOM\n*STATIC\n1., 1.\n";

/// Number of the first node of the slave.
const SLAVE: usize = 1001;

/// A slave below a master, or around it, tied by a card with these parameters.
fn tied(rows: [String; 2], parameters: &str, boundary: &str) -> String {
    format!(
        "{}{}{MATERIAL}*TIE, NAME=BOND{parameters}\nSBOTTOM, MTOP\n{STEP}{boundary}*END STEP\n",
        rows[0], rows[1]
    )
}

/// Straight blocks that meet at y = 0.
fn blocks(counts: [usize; 2], kinds: [&str; 2], parameters: &str, boundary: &str) -> String {
    let rows = [
        row("M", (1, counts[0]), kinds[0], |x, y| [x, y - 1.0]),
        row("S", (SLAVE, counts[1]), kinds[1], |x, y| [x, y]),
    ];
    tied(rows, parameters, boundary)
}

/// Quarters of rings that meet along a circle.
fn quarters(counts: [usize; 2], kinds: [&str; 2], parameters: &str) -> String {
    let polar = |x: f64, radius: f64| {
        let (sin, cos) = (FRAC_PI_2 * (1.0 - x)).sin_cos();
        [radius * cos, radius * sin]
    };
    let rows = [
        row("M", (1, counts[0]), kinds[0], |x, y| {
            polar(x, 1.0 + 0.5 * y)
        }),
        row("S", (SLAVE, counts[1]), kinds[1], |x, y| {
            polar(x, 1.5 + 0.5 * y)
        }),
    ];
    tied(rows, parameters, "")
}

/// Largest error of the equations of a model for a displacement of all nodes that depends on the place.
fn violation(model: &Model, displacement: impl Fn([f64; 2]) -> [f64; 2]) -> f64 {
    let x = &model.mesh.coordinates;
    let u: Vec<f64> = x.iter().flat_map(|&x| displacement(x)).collect();
    let of = |Equation { dof, terms }: &Equation| {
        let sum: f64 = terms.iter().map(|&(to, c)| c * u[to]).sum();
        (u[*dof] - sum).abs()
    };
    model.equations.iter().map(of).fold(0.0, f64::max)
}

/// A rotation by 40 degrees about a point beside the bodies, with a translation.
fn turned([x, y]: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = 40_f64.to_radians().sin_cos();
    [
        cos * (x - 0.3) - sin * y + 0.7 - x,
        sin * (x - 0.3) + cos * y - 0.2 - y,
    ]
}

fn stretched([x, y]: [f64; 2]) -> [f64; 2] {
    [0.3 + 0.02 * x + 0.03 * y, 0.1 - 0.01 * x + 0.05 * y]
}

const COUNTS: [[usize; 2]; 4] = [[7, 16], [16, 7], [1, 5], [5, 1]];
const KINDS: [[&str; 2]; 4] = [
    ["CPE4", "CPE4"],
    ["CPE8", "CPE4"],
    ["CPE4", "CPE8"],
    ["CPE8", "CPE8"],
];

#[test]
fn slaves_move_with_a_master_that_moves_rigidly() {
    for counts in COUNTS {
        for kinds in KINDS {
            for adjust in [
                "ADJUST=NO, POSITION TOLERANCE=0.4",
                "POSITION TOLERANCE=0.4",
            ] {
                // some of the coarse meshes are spoiled by the way on to the master
                let deck = quarters(counts, kinds, &format!(", {adjust}"));
                let (Some(model), _, _) = try_read(&deck) else {
                    assert!(!adjust.starts_with("ADJUST=NO") && counts.contains(&1));
                    continue;
                };
                assert!(!model.ties[0].sides.is_empty());
                let error = violation(&model, turned);
                assert!(error < 1e-13, "{counts:?} {kinds:?} {adjust}: {error:e}");
            }
        }
    }
}

#[test]
fn linear_displacements_go_over_to_slaves_on_the_master() {
    for counts in COUNTS {
        for kinds in KINDS {
            for kind in ["NODE TO SURFACE", "SURFACE TO SURFACE"] {
                let model = read(&blocks(counts, kinds, &format!(", TYPE={kind}"), ""));
                let error = violation(&model, stretched);
                assert!(error < 1e-13, "{counts:?} {kinds:?} {kind}: {error:e}");
            }
        }
    }
}

/// Forces of a unit traction in direction 2 on the nodes of the slave, handed over to the master by the equations, are those
/// of the traction there.
#[test]
fn uniform_tractions_go_over_to_the_master() {
    let on_nodes = |name: &str, model: &Model| {
        let surface = model.surfaces.iter().find(|s| s.name == name);
        let mut forces = vec![0.0; model.dof_count()];
        let stickslip::model::SurfaceKind::Faces(faces) = &surface.expect("a surface").kind else {
            panic!("faces");
        };
        for face in faces {
            let side = face.of(&model.mesh);
            let x = &model.mesh.coordinates;
            let first = x[side.ends()[0]];
            let from_first = |node: usize| [x[node][0] - first[0], x[node][1] - first[1]];
            for (node, [_, normal]) in side.normals(from_first) {
                forces[2 * node + 1] += normal;
            }
        }
        forces
    };
    for counts in COUNTS {
        for kinds in KINDS {
            let error = |kind: &str| {
                let model = read(&blocks(counts, kinds, &format!(", TYPE={kind}"), ""));
                let (slave, master) = (on_nodes("SBOTTOM", &model), on_nodes("MTOP", &model));
                let mut handed = slave.clone();
                for Equation { dof, terms } in &model.equations {
                    let force = std::mem::take(&mut handed[*dof]);
                    terms.iter().for_each(|&(to, c)| handed[to] += c * force);
                }
                let errors = handed.iter().zip(&master).map(|(a, b)| (a + b).abs());
                errors.fold(0.0, f64::max)
            };
            assert!(error("SURFACE TO SURFACE") < 1e-14, "{counts:?} {kinds:?}");
            let is_nested = counts.contains(&1);
            assert!(
                is_nested || error("NODE TO SURFACE") > 1e-4,
                "{counts:?} {kinds:?}"
            );
        }
    }
}

/// A support that holds a slave as the master takes the place of its equation, in its direction; the neighbour makes up for it.
#[test]
fn slaves_may_be_held_as_the_master() {
    let (corner, slave) = (1 + 2 * 33, SLAVE);
    for kinds in KINDS {
        for given in ["", ", 0.01"] {
            let boundary = format!("*BOUNDARY\n{corner}, 1, 1{given}\n{slave}, 1, 1{given}\n");
            let model = read(&blocks([16, 7], kinds, "", &boundary));
            let labels = &model.mesh.node_labels;
            let node = labels.iter().position(|&l| l == SLAVE as u64).expect("it");
            let eliminated: BTreeSet<usize> = model.equations.iter().map(|e| e.dof).collect();
            assert!(!eliminated.contains(&(2 * node)) && eliminated.contains(&(2 * node + 1)));
            let follow = |dof: &&Equation| dof.terms.iter().any(|(to, _)| *to == 2 * node);
            let count = model.equations.iter().filter(follow).count();
            // the next node; of a side with one between the corners that one
            assert_eq!(count, 1, "{kinds:?}");
            assert!(violation(&model, stretched) < 1e-13);
            assert!(violation(&model, turned) < 1e-13);
        }
    }
    let otherwise = format!("*BOUNDARY\n{slave}, 1, 1\n");
    let (model, d, _) = try_read(&blocks([16, 7], KINDS[0], "", &otherwise));
    assert!(model.is_none() && d.iter().any(|item| item.code == Code::Tie));
}

/// A node of both surfaces belongs to the master; its neighbours follow with it.
#[test]
fn surfaces_may_share_a_node() {
    let deck = blocks([7, 3], ["CPE4", "CPE4"], "", "");
    // the first node of the slave is the corner of the master
    let corner = 1 + 2 * 15;
    let element = format!("{SLAVE}, {SLAVE}, ");
    let shared = deck.replacen(&element, &format!("{SLAVE}, {corner}, "), 1);
    let model = read(&shared);
    assert_eq!(model.ties[0].nodes.len(), 3);
    assert_eq!(model.ties[0].sides.len(), 3);
    assert!(violation(&model, stretched) < 1e-13);
    assert!(violation(&model, turned) < 1e-13);
}

#[test]
fn a_slave_past_the_end_of_the_master_follows_with_its_whole_faces() {
    let rows = [
        row("M", (1, 7), "CPE4", |x, y| [x, y - 1.0]),
        row("S", (SLAVE, 5), "CPE4", |x, y| [0.45 + x, y]),
    ];
    let (model, _, messages) = try_read(&tied(rows, "", ""));
    let model = model.expect("a model");
    assert!(messages.contains("leaves out 3 slave nodes"), "{messages}");
    let tie = &model.ties[0];
    assert_eq!((tie.nodes.len(), tie.sides.len()), (3, 2));
    assert!(violation(&model, stretched) < 1e-13);
}

#[test]
fn a_slave_of_nodes_follows_from_node_to_surface() {
    for (kind, told) in [
        ("", 0),
        (", TYPE=NODE TO SURFACE", 0),
        (", TYPE=SURFACE TO SURFACE", 1),
    ] {
        let deck = blocks([7, 16], KINDS[0], kind, "");
        let nodes = format!("*SURFACE, NAME=SNODES, TYPE=NODE\nNS\n{MATERIAL}");
        let deck = deck.replacen(MATERIAL, &nodes, 1);
        let deck = deck.replacen("SBOTTOM, MTOP", "SNODES, MTOP", 1);
        let (model, d, messages) = try_read(&deck);
        let tie = &model.expect("a model").ties[0];
        assert_eq!(tie.formulation, ContactFormulation::NodeToSegment);
        assert!(tie.sides.is_empty() && tie.nodes.len() == 17);
        let count = d.iter().filter(|i| i.code == Code::IgnoredParameter);
        assert_eq!(count.count(), told, "{messages}");
    }
}

#[test]
fn a_master_of_nodes_carries_each_slave_node_with_the_nearest_one() {
    let rows = [
        row("S", (SLAVE, 3), "CPE4", |x, y| [3.0 * x, 1.0 + y]),
        row("M", (1, 3), "CPE4", |x, y| [3.0 * x + 0.01, y]),
    ];
    let text = tied(rows, "", "");
    let text = text.replace(
        "SBOTTOM, MTOP",
        "SBOTTOM, MNODES\n*SURFACE, NAME=MNODES, TYPE=NODE\nNM",
    );
    let model = read(&text);
    let label = |dof: usize| (model.mesh.node_labels[dof / 2], dof % 2);
    let follows = |equation: &Equation| {
        let [(to, factor)] = equation.terms[..] else {
            panic!("{equation:?}");
        };
        assert_eq!(factor, 1.0);
        (label(equation.dof), label(to))
    };
    let found: Vec<_> = model.equations.iter().map(follows).collect();
    // nodes 1001, 1003, ... at the bottom of the slave, 15, 17, ... at the top of the master
    let expected: Vec<_> = (0..4)
        .flat_map(|k| [0, 1].map(|i| ((1001 + 2 * k, i), (15 + 2 * k, i))))
        .collect();
    assert_eq!(found, expected);
}
