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
