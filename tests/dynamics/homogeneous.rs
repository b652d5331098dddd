//! Static steps of every element type with every law: homogeneous states stay homogeneous, and loads that stay change nothing.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write;

use stickslip::model::{ElementType, Plane, Shape};

use crate::statics::run_deck;

const RUBBER: &str = "*HYPERELASTIC, MOONEY-RIVLIN\n0.4, 0.25, 0.2\n";
const NEO_HOOKE: &str = "*HYPERELASTIC, NEO HOOKE\n0.5, 0.02\n";
const OGDEN: &str = "*HYPERELASTIC, OGDEN, N=3\n1., 1.3, 0.02, 5., 0.1, -2., 0.1, 0.\n0.5\n";
const HENCKY: &str = "*ELASTIC, TYPE=HENCKY\n2., 0.3\n";
const LINEAR: &str = "*ELASTIC\n100., 0.3\n";
const METAL: &str =
    "*ELASTIC\n120., 0.33\n*PLASTIC\n1., 0.\n1.3, 0.013\n1.6, 0.05\n2.2, 0.2\n2.6, 0.4\n4., 2.\n";

/// Two times two distorted quadrilaterals, or twice as many triangles, over the unit square, with straight sides.
pub fn patch(element_type: ElementType, material: &str) -> (String, Vec<[f64; 2]>) {
    let middle = |i: usize, j: usize| match (i, j) {
        (1, 1) => [0.63, 0.409],
        _ => [i as f64 / 2.0, j as f64 / 2.0],
    };
    let mut x: Vec<[f64; 2]> = (0..9).map(|n| middle(n % 3, n / 3)).collect();
    let quads = [0, 1, 3, 4].map(|a| vec![a, a + 1, a + 4, a + 3]);
    let elements: Vec<Vec<usize>> = match element_type.shape {
        Shape::Quad4 | Shape::Quad8 => quads.into(),
        Shape::Tri3 | Shape::Tri6 => (quads.iter())
            .flat_map(|q| [vec![q[0], q[1], q[2]], vec![q[0], q[2], q[3]]])
            .collect(),
    };
    let mut between = BTreeMap::new();
    let mut text = String::new();
    for (e, mut nodes) in elements.into_iter().enumerate() {
        let corners = nodes.clone();
        for (i, &a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            if element_type.is_quadratic() {
                nodes.push(*between.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                    x.push([(x[a][0] + x[b][0]) / 2.0, (x[a][1] + x[b][1]) / 2.0]);
                    x.len() - 1
                }));
            }
        }
        let nodes: Vec<String> = nodes.iter().map(|n| (n + 1).to_string()).collect();
        writeln!(text, "{}, {}", e + 1, nodes.join(", ")).expect("text");
    }
    let mut deck = String::from("*NODE\n");
    for (n, [x, y]) in x.iter().enumerate() {
        writeln!(deck, "{}, {x:?}, {y:?}", n + 1).expect("text");
    }
    for (name, i, value) in [("L", 0, 0.0), ("R", 0, 1.0), ("B", 1, 0.0), ("T", 1, 1.0)] {
        let side = (0..x.len()).filter(|&n| x[n][i] == value);
        let side: Vec<String> = side.map(|n| (n + 1).to_string()).collect();
        writeln!(deck, "*NSET, NSET={name}\n{}", side.join(", ")).expect("text");
    }
    let name = element_type.name();
    write!(
        deck,
        "*ELEMENT, TYPE={name}, ELSET=E\n{text}*MATERIAL, NAME=M\n{material}\
         *SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n"
    )
    .expect("text");
    (deck, x)
}

/// Displacements at the end of a deck that runs to its end.
fn end(deck: &str, what: &str) -> Vec<f64> {
    let (keep, failure) = run_deck(deck);
    assert_eq!(failure, None, "{what}");
    keep.reports.last().expect("reports").state.u.clone()
}

#[test]
fn homogeneous_states_stay_homogeneous_to_large_strains() {
    // stretches of the sides that are prescribed, less one; materials; those of rings have the first around the axis too
    let loads = [
        (RUBBER, Some(1.5), None),
        (RUBBER, Some(1.5), Some(1.5)),
        (RUBBER, None, Some(-0.3)),
        (RUBBER, Some(-0.3), Some(0.5)),
        (NEO_HOOKE, Some(1.5), None),
        (NEO_HOOKE, None, Some(-0.3)),
        (OGDEN, Some(1.5), None),
        (OGDEN, Some(-0.3), Some(0.5)),
        (OGDEN, None, Some(-0.3)),
        (HENCKY, Some(1.0), None),
        (HENCKY, Some(-0.4), Some(0.5)),
        (HENCKY, None, Some(-0.4)),
        (LINEAR, Some(0.3), None),
        (LINEAR, None, Some(-0.3)),
        (METAL, Some(0.2), None),
        (METAL, None, Some(-0.3)),
        (METAL, Some(-0.3), Some(0.5)),
    ];
    for element_type in ElementType::NAMED {
        for (material, along, up) in loads {
            if element_type.is_ring() && along.is_some() && up == along {
                // the same stretch in three directions
                continue;
            }
            let (mut deck, x) = patch(element_type, material);
            deck += "*STEP, NLGEOM\n*STATIC\n0.25, 1.\n*BOUNDARY\nB, 2, 2\nL, 1, 1\n";
            for (side, direction, value) in [("R", 1, along), ("T", 2, up)] {
                if let Some(value) = value {
                    writeln!(deck, "{side}, {direction}, {direction}, {value:?}").expect("text");
                }
            }
            let what = format!("{} {material} {along:?} {up:?}", element_type.name());
            let u = end(&(deck + "*END STEP\n"), &what);
            // corners of the square: node 3 at (1, 0), node 7 at (0, 1)
            let stretch = [u[2 * 2], u[2 * 6 + 1]];
            for (n, x) in x.iter().enumerate() {
                for i in 0..2 {
                    let error = u[2 * n + i] - stretch[i] * x[i];
                    assert!(error.abs() < 1e-9, "{what}: node {} {error:e}", n + 1);
                }
            }
        }
    }
}

/// dW/d ln l_i of the principal stretches of the material [`OGDEN`] (force/length^2).
fn ogden_stresses(l: [f64; 3]) -> [f64; 3] {
    let j: f64 = l.iter().product();
    let pressure = j * (2.0 * (j - 1.0) / 0.1 + 6.0 * (j - 1.0).powi(5) / 0.5);
    let mut stresses = [pressure; 3];
    for [mu, alpha] in [[1.0, 1.3], [0.02, 5.0], [0.1, -2.0]] {
        let powers = l.map(|l| (l / j.cbrt()).powf(alpha));
        let mean = powers.iter().sum::<f64>() / 3.0;
        for (stress, power) in stresses.iter_mut().zip(powers) {
            *stress += 2.0 * mu / alpha * (power - mean);
        }
    }
    stresses
}

/// The same of [`HENCKY`]: 2 mu ln l_i + lambda ln J.
fn hencky_stresses(l: [f64; 3]) -> [f64; 3] {
    let (mu, lambda) = (2.0 / 2.6, 2.0 * 0.3 / (1.3 * 0.4));
    let grown: f64 = l.iter().map(|l| l.ln()).sum();
    l.map(|l| 2.0 * mu * l.ln() + lambda * grown)
}

/// A square that is pulled to a stretch, free in the other directions but for that across of plane strain and that around of
/// rings: its width and its force are those of the principal stretches.
#[test]
fn forces_of_laws_of_principal_stretches_are_those_of_the_stretches() {
    check_forces(OGDEN, ogden_stresses, [0.8, 1.2, 2.5]);
    check_forces(HENCKY, hencky_stresses, [0.7, 1.2, 2.0]);
}

fn check_forces(material: &str, stresses: fn([f64; 3]) -> [f64; 3], stretches: [f64; 3]) {
    for element_type in ElementType::NAMED {
        for along in stretches {
            let (deck, x) = patch(element_type, material);
            let deck = format!(
                "{deck}*STEP, NLGEOM\n*STATIC\n0.25, 1.\n*BOUNDARY\nB, 2, 2\nL, 1, 1\nR, 1, 1, {:?}\n\
                 *END STEP\n",
                along - 1.0
            );
            let what = format!("{} {material} {along}", element_type.name());
            let (keep, failure) = run_deck(&deck);
            assert_eq!(failure, None, "{what}");
            let report = keep.reports.last().expect("reports");
            let stretches = |side: f64| match element_type.plane {
                Plane::Stress => [along, side, side],
                Plane::Strain => [along, side, 1.0],
                Plane::Revolution => [along, side, along],
            };
            let (mut low, mut high) = (0.05, 5.0);
            for _ in 0..200 {
                let middle = (low + high) / 2.0;
                match stresses(stretches(middle))[1] < 0.0 {
                    true => low = middle,
                    false => high = middle,
                }
            }
            let width = report.state.u[2 * 6 + 1] + 1.0;
            assert!((width / low - 1.0).abs() < 1e-9, "{what}: {width} {low}");
            // nominal stress over the side that it acts on
            let area = if element_type.is_ring() { TAU } else { 1.0 };
            let exact = stresses(stretches(low))[0] / along * area;
            let side = (0..x.len()).filter(|&n| x[n][0] == 1.0);
            let force: f64 = side.map(|n| report.nodal.reaction[2 * n]).sum();
            assert!(
                (force / exact - 1.0).abs() < 1e-9,
                "{what}: {force} {exact}"
            );
        }
    }
}

/// In a square that its base holds, with forces at its right side beyond the strength of the metal, a step without anything
/// new leaves displacements and reactions as they are. Kinematic hardening is no part of the table, where the stress changes in
/// the second order of an increment's flow as that is committed, eq. (2.41).
#[test]
fn loads_that_stay_change_nothing() {
    // laws, and the forces at each node of the side
    let laws = [
        (LINEAR, [0.2, -0.5]),
        (NEO_HOOKE, [0.01, -0.03]),
        (RUBBER, [0.01, -0.03]),
        (OGDEN, [0.01, -0.03]),
        (HENCKY, [0.004, -0.01]),
        (METAL, [0.03, -0.08]),
    ];
    for element_type in ElementType::NAMED {
        for (material, [across, up]) in laws {
            let (mut deck, _) = patch(element_type, material);
            let load = format!("*CLOAD\nR, 1, {across:?}\nR, 2, {up:?}\n");
            let axis = if element_type.is_ring() {
                "L, 1, 1\n"
            } else {
                ""
            };
            write!(deck, "*BOUNDARY\nB, 1, 2\n{axis}").expect("text");
            for load in [&load, ""] {
                write!(deck, "*STEP, NLGEOM\n*STATIC\n0.25, 1.\n{load}*END STEP\n").expect("text");
            }
            let what = format!("{} {material}", element_type.name());
            let (keep, failure) = run_deck(&deck);
            assert_eq!(failure, None, "{what}");
            let start = keep.reports.iter().rposition(|report| report.step == 1);
            let [start, held @ ..] = &keep.reports[start.expect("a load")..] else {
                panic!("{what}")
            };
            assert!(!held.is_empty(), "{what}");
            for report in held {
                let both = [
                    [&start.state.u, &report.state.u],
                    [&start.nodal.reaction, &report.nodal.reaction],
                ];
                for [before, after] in both {
                    let size = before.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
                    let changes = before.iter().zip(after).map(|(x, y)| (x - y).abs());
                    let change = changes.fold(0.0, f64::max);
                    assert!(change < 1e-9 * size, "{what}: {change:e} of {size:e}");
                }
            }
        }
    }
}
