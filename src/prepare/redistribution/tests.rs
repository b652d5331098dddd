//! Which nodes of meshes without regularity are without mass.

use super::Redistribution;
use crate::contact::contact_surfaces;
use crate::diagnostics::Span;
use crate::materials::Law;
use crate::model::{
    Contact, Damping, Element, ElementType, Equation, Interaction, Material, Model, Section,
    Surface, SurfaceKind,
};

/// A bent block of cells of two sizes, each a quadrilateral or two triangles, in contact with itself
/// all round; `has` says which cells there are.
pub(crate) fn block(
    [columns, rows]: [usize; 2],
    is_triangular: fn(usize, usize) -> bool,
    has: fn(usize, usize) -> bool,
) -> Model {
    let mut model = Model::default();
    let place = |k: usize| ((k % (columns + 1)) as f64, (k / (columns + 1)) as f64);
    let bent = |(i, j): (f64, f64)| {
        let (a, b) = (3.7 * i + 1.9 * j, 2.3 * i - 4.1 * j);
        [
            i + 0.12 * a.sin() + 0.05 * j * j,
            0.7 * j + 0.1 * b.cos() - 0.02 * i * i,
        ]
    };
    let nodes = (columns + 1) * (rows + 1);
    model.mesh.coordinates = (0..nodes).map(|k| bent(place(k))).collect();
    model.mesh.node_labels = (1..=nodes as u64).collect();
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
        let a = j * (columns + 1) + i;
        let [b, c, d] = [a + 1, a + columns + 2, a + columns + 1];
        let cell = match is_triangular(i, j) {
            true => vec![vec![a, b, c], vec![a, c, d]],
            false => vec![vec![a, b, c, d]],
        };
        let cells = cell.into_iter().filter(|_| has(i, j));
        model.mesh.elements.extend(cells.map(|nodes| Element {
            label: 1,
            element_type: match nodes.len() {
                3 => ElementType::CPE3,
                _ => ElementType::CPE4,
            },
            nodes: nodes.into(),
            section: 0,
        }));
    }
    model.materials.push(Material {
        name: "M".into(),
        law: Law::elastic(100.0, 0.3),
        density: 1.3,
        damping: Damping::default(),
    });
    model.sections.push(Section {
        material: 0,
        thickness: 2.0,
    });
    model.surfaces.push(Surface {
        name: "SKIN".into(),
        kind: SurfaceKind::Faces(model.mesh.exterior_faces()),
    });
    model.contacts.push(Contact {
        slave: 0,
        master: 0,
        interaction: Interaction::default(),
        adjust: None,
        left_out: Vec::new(),
        span: Span::default(),
    });
    model
}

/// Redistribution of a model.
pub(crate) fn redistribution(model: &Model) -> Redistribution {
    Redistribution::new(model, &contact_surfaces(model, &model.mesh.bodies()))
}

fn massless(model: &Model) -> Vec<usize> {
    redistribution(model).massless().collect()
}

const MIXED: fn(usize, usize) -> bool = |i, j| (i + j) % 3 == 0;
const ALL: fn(usize, usize) -> bool = |_, _| true;

#[test]
fn the_skin_of_a_thick_block_is_without_mass() {
    for is_triangular in [|_, _| false, |_, _| true, MIXED] {
        let found = massless(&block([7, 6], is_triangular, ALL));
        let skin = |k: usize| [0, 7].contains(&(k % 8)) || !(8..48).contains(&k);
        assert_eq!(found, (0..56).filter(|&k| skin(k)).collect::<Vec<_>>());
    }
}

#[test]
fn weights_are_affine_and_donors_have_mass() {
    let model = block([7, 6], MIXED, ALL);
    let redistribution = redistribution(&model);
    let x = &model.mesh.coordinates;
    for node in redistribution.massless() {
        let donors = redistribution.donors(node).expect("donors");
        assert!(
            donors
                .iter()
                .all(|(donor, _)| !redistribution.is_massless(*donor))
        );
        for (i, own) in x[node].iter().enumerate() {
            let sum: f64 = donors.iter().map(|(donor, w)| w * x[*donor][i]).sum();
            assert!((sum - own).abs() < 1e-14, "{node}: {sum}");
        }
    }
}

#[test]
fn holes_thin_layers_and_tied_nodes_keep_their_mass() {
    // the edge of the hole of cells 3 to 5 in both directions
    let model = block([9, 9], MIXED, |i, j| {
        !((3..6).contains(&i) && (3..6).contains(&j))
    });
    let hole = |k: &usize| (3..=6).contains(&(k % 10)) && (3..=6).contains(&(k / 10));
    let found = redistribution(&model);
    let kept: Vec<usize> = (0..100)
        .filter(hole)
        .filter(|k| ![44, 45, 54, 55].contains(k))
        .collect();
    assert_eq!(found.kept(), kept);
    assert_eq!(found.massless().len(), 36);
    // one layer has no donors, two have donors on a line
    for rows in [1, 2] {
        let mut model = block([12, rows], |_, _| false, ALL);
        for (k, x) in model.mesh.coordinates.iter_mut().enumerate() {
            *x = [(k % 13) as f64, (k / 13) as f64];
        }
        let found = redistribution(&model);
        assert_eq!(found.massless().len(), 0, "{rows}");
        assert_eq!(found.kept().len(), if rows == 1 { 26 } else { 28 });
    }
    let mut tied = block([7, 6], MIXED, ALL);
    tied.equations.push(Equation {
        dof: 2 * 3,
        terms: vec![(2 * 50, 1.0)],
    });
    assert_eq!(redistribution(&tied).kept(), [3, 50]);
}

/// A flat block whose nodes are moved.
fn flat(
    cells: [usize; 2],
    has: fn(usize, usize) -> bool,
    moved: impl Fn([f64; 2]) -> [f64; 2],
) -> Model {
    let mut model = block(cells, |_, _| false, has);
    let columns = cells[0] + 1;
    for (k, x) in model.mesh.coordinates.iter_mut().enumerate() {
        *x = moved([0.6 * (k % columns) as f64, 0.5 * (k / columns) as f64 - 1.0]);
    }
    model
}

/// Two layers have their donors on a line, some nodes on that line themselves; three layers have not.
#[test]
fn round_off_turns_and_places_do_not_decide_over_mass() {
    for (rows, count) in [(2, 0), (3, 16)] {
        let as_it_is = massless(&flat([5, rows], ALL, |x| x));
        assert_eq!(as_it_is.len(), count, "{rows}");
        let noise = |[x, y]: [f64; 2]| [x, y + 1e-16 * (37.0 * x + 11.0 * y).sin()];
        assert_eq!(massless(&flat([5, rows], ALL, noise)), as_it_is, "noise");
        for k in 0..24 {
            let angle = f64::from(k) * std::f64::consts::PI / 12.0;
            let (sin, cos) = angle.sin_cos();
            for far in [0.0, 1e3] {
                let turned = |[x, y]: [f64; 2]| [cos * x - sin * y + far, sin * x + cos * y - far];
                assert_eq!(
                    massless(&flat([5, rows], ALL, turned)),
                    as_it_is,
                    "{angle} {far}"
                );
            }
        }
    }
}

/// A notch and a hole that meet in a node, between two elements that meet there only: one edge goes round both.
#[test]
fn the_order_of_elements_does_not_decide_over_mass() {
    let has = |i, j| (i, j) != (3, 0) && (i, j) != (4, 1);
    let mut model = flat([8, 6], has, |x| x);
    let found = massless(&model);
    model.mesh.elements.reverse();
    model.surfaces[0].kind = SurfaceKind::Faces(model.mesh.exterior_faces());
    assert_eq!(massless(&model), found);
    let edges = [3, 4, 12, 13, 14, 22, 23];
    assert!(edges.iter().all(|node| found.contains(node)), "{found:?}");
}
