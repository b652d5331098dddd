//! Patch test: a distorted patch whose boundary is displaced affinely deforms affinely.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};
use stickslip::elements::{Elements, Motion, TangentPart};
use stickslip::model::{Element, ElementType, Formulation, Model, Shape};

use crate::blocks::model;

/// All shapes, reduced integration and mean dilatation.
const TYPES: [ElementType; 6] = [
    ElementType::CPE4,
    ElementType::CPE3,
    ElementType::CPE6,
    ElementType::CPE8,
    ElementType::CPE8R,
    ElementType {
        formulation: Formulation::MeanDilatation,
        ..ElementType::CPE4
    },
];

/// Five quadrilaterals, or ten triangles, over [0, 2.4] x [0, 1.2] (MacNeal & Harder 1985, scaled):
///
/// ```text
/// 3 ------------- 2
/// | \           / |
/// |  7 ------- 6  |
/// |  |         |  |
/// |  4 ------- 5  |
/// | /           \ |
/// 0 ------------- 1
/// ```
///
/// Nodes between the corners follow, those within the patch so that its sides are curved.
fn patch(element_type: ElementType) -> Model {
    let mut model = model(1000.0, 0.3, 1.0);
    model.mesh.coordinates = vec![
        [0.0, 0.0],
        [2.4, 0.0],
        [2.4, 1.2],
        [0.0, 1.2],
        [0.4, 0.2],
        [1.8, 0.3],
        [1.6, 0.8],
        [0.8, 0.8],
    ];
    let quads = [
        [0, 1, 5, 4],
        [1, 2, 6, 5],
        [2, 3, 7, 6],
        [3, 0, 4, 7],
        [4, 5, 6, 7],
    ];
    let nodes: Vec<Vec<usize>> = match element_type.shape {
        Shape::Quad4 | Shape::Quad8 => quads.map(Vec::from).into(),
        Shape::Tri3 | Shape::Tri6 => quads
            .into_iter()
            .flat_map(|[a, b, c, d]| [vec![a, b, c], vec![a, c, d]])
            .collect(),
    };
    let coordinates = &mut model.mesh.coordinates;
    let mut between = HashMap::new();
    let nodes = nodes.into_iter().map(|mut nodes| {
        let corners = nodes.clone();
        for (i, &a) in corners
            .iter()
            .enumerate()
            .filter(|_| element_type.is_quadratic())
        {
            let b = corners[(i + 1) % corners.len()];
            nodes.push(*between.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                let bow = if a.max(b) < 4 { 0.0 } else { 0.03 };
                let [p, q] = [coordinates[a], coordinates[b]];
                coordinates.push([(p[0] + q[0]) / 2.0 + bow, (p[1] + q[1]) / 2.0 - bow]);
                coordinates.len() - 1
            }));
        }
        nodes
    });
    let nodes: Vec<Vec<usize>> = nodes.collect();
    let element = |(i, nodes)| Element {
        label: i as u64,
        element_type,
        nodes: Vec::into(nodes),
        section: 0,
    };
    model.mesh.elements = nodes.into_iter().enumerate().map(element).collect();
    model
}

/// F = [[1.2, 0.3], [0.1, 0.9]]: u = (F - I) X.
fn affine(model: &Model) -> Vec<f64> {
    let u = |x: &[f64; 2]| [0.2 * x[0] + 0.3 * x[1], 0.1 * x[0] - 0.1 * x[1]];
    model.mesh.coordinates.iter().flat_map(u).collect()
}

/// Dofs of the nodes within the patch.
fn inner(model: &Model) -> Vec<usize> {
    let within = |[x, y]: [f64; 2]| x > 0.0 && x < 2.4 && y > 0.0 && y < 1.2;
    let nodes = 0..model.mesh.node_count();
    let nodes = nodes.filter(|&n| within(model.mesh.coordinates[n]));
    nodes.flat_map(|n| [2 * n, 2 * n + 1]).collect()
}

/// Static displacements of the inner nodes for given boundary displacements, by Newton.
fn solve_inner(body: &Elements, inner: &[usize], mut u: Vec<f64>) -> Vec<f64> {
    for _ in 0..12 {
        let mut k = DMatrix::zeros(u.len(), u.len());
        body.for_each_tangent(
            Motion::at(&u, &[]),
            TangentPart::Whole,
            |_| true,
            |element, matrix| {
                let dofs: Vec<usize> = body
                    .nodes(element)
                    .iter()
                    .flat_map(|n| [2 * n, 2 * n + 1])
                    .collect();
                for (j, &column) in dofs.iter().enumerate() {
                    for (i, &row) in dofs.iter().enumerate() {
                        k[(row, column)] += matrix[j * dofs.len() + i];
                    }
                }
            },
        );
        let f = body
            .internal_force(Motion::at(&u, &[]))
            .expect("no element is inverted");
        let residual = DVector::from_iterator(inner.len(), inner.iter().map(|&dof| f[dof]));
        let k = k.select_rows(inner).select_columns(inner);
        let du = k.lu().solve(&residual).expect("the patch is stable");
        for (&dof, du) in inner.iter().zip(du.iter()) {
            u[dof] -= du;
        }
    }
    u
}

#[test]
fn an_affine_boundary_deforms_a_distorted_patch_affinely() {
    for element_type in TYPES {
        let model = patch(element_type);
        let body = Elements::new(&model);
        let exact = affine(&model);
        let mut start = exact.clone();
        let inner = inner(&model);
        inner.iter().for_each(|&dof| start[dof] *= 0.9);
        let u = solve_inner(&body, &inner, start);
        for (dof, (u, exact)) in u.iter().zip(&exact).enumerate() {
            assert!(
                (u - exact).abs() < 1e-12,
                "dof {dof}: {u} instead of {exact}"
            );
        }
        // Green-Lagrange strain (F^T F - I)/2 in every element
        let elements = body.evaluate(Motion::at(&u, &[]));
        for means in &*elements {
            for (value, exact) in means.strain.iter().zip([0.225, -0.05, 0.225]) {
                assert!((value - exact).abs() < 1e-12);
            }
        }
        let volume = 2.4 * 1.2;
        assert!((elements.iter().map(|e| e.energy).sum::<f64>() / volume - 68.209135).abs() < 1e-6);
    }
}

#[test]
fn the_mass_adds_up_to_that_of_the_patch() {
    for element_type in TYPES {
        let body = Elements::new(&patch(element_type));
        let total: f64 = (0..body.len())
            .map(|e| body.mass(e).iter().sum::<f64>())
            .sum();
        assert!((total - 2.88).abs() < 1e-14);
    }
}
