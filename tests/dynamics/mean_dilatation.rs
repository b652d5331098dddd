//! CPE4 with mean dilatation: nearly incompressible bodies bend as they should, and free ones keep
//! energy and momenta.

use nalgebra::{DMatrix, DVector};
use stickslip::elements::{Elements, Motion, TangentPart};
use stickslip::model::{ElementType, Formulation, Model, Settings};

use crate::blocks::{Block, add_block, model, run_to_end, step, throw};
use crate::invariants::drift;

const MEAN_DILATATION: ElementType = ElementType {
    formulation: Formulation::MeanDilatation,
    ..ElementType::CPE4
};

fn set_type(model: &mut Model, element_type: ElementType) {
    for element in &mut model.mesh.elements {
        element.element_type = element_type;
    }
}

/// Displacements from one Newton step from rest: the linear solution under nodal forces, some dofs
/// held.
fn linear_solution(model: &Model, forces: &[(usize, f64)], held: &[usize]) -> DVector<f64> {
    let elements = Elements::new(model);
    let count = model.mesh.dof_count();
    let mut k = DMatrix::<f64>::zeros(count, count);
    elements.for_each_tangent(
        Motion::at(&vec![0.0; count], &[]),
        TangentPart::Whole,
        |_| true,
        |element, matrix| {
            let nodes = elements.nodes(element).iter();
            let dofs: Vec<usize> = nodes.flat_map(|n| [2 * n, 2 * n + 1]).collect();
            for (j, &column) in dofs.iter().enumerate() {
                for (i, &row) in dofs.iter().enumerate() {
                    k[(row, column)] += matrix[j * dofs.len() + i];
                }
            }
        },
    );
    let mut f = DVector::zeros(count);
    for &(dof, force) in forces {
        f[dof] += force;
    }
    for &dof in held {
        k.row_mut(dof).fill(0.0);
        k.column_mut(dof).fill(0.0);
        k[(dof, dof)] = 1.0;
        f[dof] = 0.0;
    }
    k.lu().solve(&f).expect("the body is held")
}

/// Displacements of a block that is held at its left end under a vertical force, spread over its right end.
fn sheared(model: &Model, block: &Block, force: f64) -> DVector<f64> {
    let (nx, ny) = (block.nx, block.ny);
    let held: Vec<usize> = (0..=ny)
        .flat_map(|j| [2 * block.node(0, j), 2 * block.node(0, j) + 1])
        .collect();
    let share = |j: usize| if j == 0 || j == ny { 0.5 } else { 1.0 };
    let forces: Vec<(usize, f64)> = (0..=ny)
        .map(|j| (2 * block.node(nx, j) + 1, force * share(j) / ny as f64))
        .collect();
    linear_solution(model, &forces, &held)
}

/// Tip deflection of a cantilever 10 x 1 of 10 n x n elements over that of beam theory with shear,
/// in plane strain.
fn cantilever(element_type: ElementType, nu: f64, n: usize) -> f64 {
    let mut model = model(1000.0, nu, 1.0);
    let block: Block = add_block(&mut model, [0.0, 0.0], [10.0, 1.0], (10 * n, n), 0.0);
    set_type(&mut model, element_type);
    let u = sheared(&model, &block, 1.0);
    // P L³/(3 E' I) + P L/(5/6 G h), E' = E/(1 - nu²), I = h³/12
    let bending = 12.0 * 1000.0 / 3.0 * (1.0 - nu * nu) / 1000.0;
    let shear = 10.0 / (5.0 / 6.0 * 1000.0 / (2.0 * (1.0 + nu)));
    u[2 * block.node(10 * n, n / 2) + 1] / (bending + shear)
}

#[test]
fn a_nearly_incompressible_cantilever_does_not_lock() {
    for nu in [0.3, 0.49, 0.499, 0.4999] {
        let standard = cantilever(ElementType::CPE4, nu, 2);
        let [coarse, fine] = [2, 4].map(|n| cantilever(MEAN_DILATATION, nu, n));
        println!("nu {nu}: standard {standard:.3}, mean dilatation {coarse:.3}, finer {fine:.3}");
        assert!((coarse - 1.0).abs() < 0.16, "{nu}: {coarse}");
        assert!((fine - 1.0).abs() < 0.05, "{nu}: {fine}");
        assert!(standard < coarse);
    }
    let locked = cantilever(ElementType::CPE4, 0.499, 2);
    assert!(locked < 0.1, "the standard element locks: {locked}");
}

/// Vertical displacement of the upper corner of Cook's membrane (Cook 1974), nearly
/// incompressible under a shear force of 100 at its right end, with n x n elements.
fn cook(element_type: ElementType, n: usize) -> f64 {
    let mut model = model(250.0, 0.4999, 1.0);
    let block = add_block(&mut model, [0.0, 0.0], [1.0, 1.0], (n, n), 0.0);
    for x in &mut model.mesh.coordinates {
        let [s, t] = *x;
        *x = [48.0 * s, 44.0 * s + t * (44.0 - 28.0 * s)];
    }
    set_type(&mut model, element_type);
    sheared(&model, &block, 100.0)[2 * block.node(n, n) + 1]
}

#[test]
fn cooks_membrane_converges() {
    let [coarse, middle, fine] = [4, 8, 16].map(|n| cook(MEAN_DILATATION, n));
    let standard = cook(ElementType::CPE4, 16);
    println!("mean dilatation {coarse:.3} {middle:.3} {fine:.3}, standard {standard:.3}");
    assert!(coarse < middle && middle < fine);
    assert!((fine - middle) < 0.6 * (middle - coarse));
    assert!(standard < 0.7 * fine);
}

#[test]
fn a_free_spinning_bar_keeps_energy_and_both_momenta() {
    let mut model = model(1e3, 0.499, 1.0);
    let bar = add_block(&mut model, [0.0, 0.0], [10.0, 1.0], (20, 2), 0.0);
    set_type(&mut model, MEAN_DILATATION);
    throw(&mut model, &bar, [1.0, 2.0], 1.0, [5.0, 0.5]);
    for node in bar.nodes() {
        let [x, y] = model.mesh.coordinates[node];
        model.initial_velocity[2 * node] += 0.3 * (x - 5.0);
        model.initial_velocity[2 * node + 1] -= 0.3 * (y - 0.5);
    }
    model.steps = vec![step(0.01, 400, Settings::default(), Vec::new())];
    let (keep, summary) = run_to_end(&model);
    let [energy, linear, angular] = drift(&keep);
    println!("energy {energy:.1e} linear {linear:.1e} angular {angular:.1e} {summary:?}");
    assert!(energy < 1e-10 && linear < 1e-10 && angular < 1e-10);
    assert_eq!(summary.cutbacks, 0);
    let strain = keep
        .reports
        .iter()
        .map(|r| r.energy.strain)
        .fold(0.0, f64::max);
    assert!(
        strain > 0.01 * keep.reports[0].energy.kinetic,
        "it vibrates"
    );
}
