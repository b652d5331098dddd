//! Thin bodies in self-contact and in contact with others: no contact with the far side.
//!
//! ```text
//!    |=====|=====|=====|=====|     the second, shifted, on the first or into it
//!  |=====|=====|=====|=====|       a foil of 4 elements, ends fixed
//! ```

use stickslip::model::{
    Contact, ElementType, Face, Interaction, Model, Settings, Surface, SurfaceKind,
};
use stickslip::prepare::PreparedModel;

use crate::blocks::{Block, add_block, fixed, gravity, model, run_to_end, step, throw};

const LENGTH: f64 = 10.0;

/// Foils with elements that are `ratio` times as long as the foil is thick, each above the one
/// before by `lifts` thicknesses, in one surface that touches itself.
fn foils(ratio: f64, layers: usize, triangles: bool, lifts: &[f64]) -> (Model, Vec<Block>) {
    let mut model = model(1e3, 0.3, 1.0);
    let (size, mut y) = (LENGTH / 4.0, 0.0);
    let mut foils = Vec::new();
    for (k, lift) in lifts.iter().enumerate() {
        y += lift * size / ratio;
        let corner = [0.3 * size * k as f64, y];
        let thickness = [LENGTH, size / ratio];
        foils.push(add_block(&mut model, corner, thickness, (4, layers), 0.0));
    }
    let mut faces: Vec<Face> = Vec::new();
    for foil in &foils {
        faces.extend((0..4).flat_map(|side| foil.faces(side)));
    }
    if triangles {
        faces = split(&mut model, &faces);
    }
    model.surfaces.push(Surface {
        name: "SKIN".into(),
        kind: SurfaceKind::Faces(faces),
    });
    model
        .contacts
        .push(Contact::new([0, 0], Interaction::default()));
    (model, foils)
}

/// Cuts every quadrilateral into two triangles; the faces in their new places.
fn split(model: &mut Model, faces: &[Face]) -> Vec<Face> {
    let elements = std::mem::take(&mut model.mesh.elements);
    for element in &elements {
        let &[a, b, c, d] = element.nodes.as_slice() else {
            panic!("a quadrilateral");
        };
        for nodes in [[a, b, c], [a, c, d]] {
            let label = model.mesh.elements.len() as u64 + 1;
            model.mesh.elements.push(stickslip::model::Element {
                label,
                element_type: ElementType::CPS3,
                nodes: nodes[..].into(),
                ..element.clone()
            });
        }
    }
    let place = |face: &Face| match face.side {
        side @ 0..=1 => Face {
            element: 2 * face.element,
            side,
        },
        side => Face {
            element: 2 * face.element + 1,
            side: side - 1,
        },
    };
    faces.iter().map(place).collect()
}

/// Every combination of slenderness, layers and shape.
fn each(mut visit: impl FnMut(f64, usize, bool)) {
    for ratio in [1e2, 1e3, 1e4] {
        for layers in [1, 2] {
            for triangles in [false, true] {
                visit(ratio, layers, triangles);
            }
        }
    }
}

#[test]
fn a_foil_is_not_inside_itself() {
    each(|ratio, layers, triangles| {
        for lifts in [&[0.0][..], &[0.0, 1.0], &[0.0, 1.5], &[0.0, 1.0, 1.0]] {
            let (model, _) = foils(ratio, layers, triangles, lifts);
            let deepest = PreparedModel::new(model).gaps[0]
                .iter()
                .map(|gap| -gap.gap / gap.edge)
                .fold(0.0, f64::max);
            assert!(deepest < 1e-12, "{ratio} {layers} {triangles}: {deepest:e}");
        }
    });
}

#[test]
fn a_foil_pressed_into_another_is_told() {
    each(|ratio, layers, triangles| {
        for part in [0.1, 0.4, 0.7] {
            let (model, foils) = foils(ratio, layers, triangles, &[0.0, 1.0 - part]);
            let thickness = LENGTH / 4.0 / ratio;
            // the lower side of the second from both sides of the first, whichever is nearer
            let expected = thickness * f64::min(part, 1.0 - part);
            let prepared = PreparedModel::new(model);
            let found = &prepared.gaps[0];
            let node = foils[1].node(1, 0);
            let gap = found.iter().find(|gap| gap.slave == node).expect("a gap");
            let error = (-gap.gap - expected).abs();
            assert!(error < 1e-9 * thickness, "{ratio} {part}: {}", gap.gap);
        }
    });
}

#[test]
fn foils_sag_on_each_other() {
    each(|ratio, layers, triangles| {
        let (mut model, foils) = foils(ratio, layers, triangles, &[0.0, 1.0]);
        let ends = |foil: &Block| -> Vec<usize> {
            let rows = 0..=layers;
            rows.flat_map(|j| [foil.node(0, j), foil.node(4, j)])
                .collect()
        };
        let held = ends(&foils[0]).into_iter();
        let supports = held.flat_map(|n| [2 * n, 2 * n + 1]).map(fixed).collect();
        let mut sag = step(0.002, 10, Settings::default(), supports);
        let pull = |element| gravity(element, 9.81);
        sag.body_forces = (0..model.mesh.elements.len()).map(pull).collect();
        model.steps = vec![sag];
        let (keep, summary) = run_to_end(&model);
        let last = keep.reports.last().expect("reports");
        let contact = &last.contacts[0];
        let thickness = LENGTH / 4.0 / ratio;
        let what = format!("{ratio} {layers} {triangles}: gap {:e}", contact.min_gap);
        assert!(summary.cutbacks == 0 && contact.closed > 0, "{what}");
        assert!(contact.min_gap > -1e-9 * thickness, "{what}");
        assert!(last.energy.kinetic > 0.0);
        let balance = last.energy.balance.abs();
        assert!(balance < 1e-10 * last.energy.external_work, "{what}");
    });
}

#[test]
fn a_foil_turns_about_itself_without_touching() {
    // each increment takes its ends farther than it is thick, by a long way
    each(|ratio, layers, triangles| {
        let (mut model, foils) = foils(ratio, layers, triangles, &[0.0]);
        let centre = [LENGTH / 2.0, 0.0];
        throw(&mut model, &foils[0], [0.0; 2], 0.05, centre);
        model.steps = vec![step(0.1, 6, Settings::default(), Vec::new())];
        let (keep, summary) = run_to_end(&model);
        assert_eq!(summary.cutbacks, 0, "{ratio} {layers} {triangles}");
        assert!(keep.reports.iter().all(|r| r.contacts[0].closed == 0));
    });
}
