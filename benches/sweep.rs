//! Time of the sweeps over the elements.
//!
//! `cargo bench --bench sweep` measures a grid of n x n quadrilaterals under some displacements: the
//! internal force at one configuration and in the energy-momentum form, the tangents, the refill of a
//! matrix from tangents that are known, and the evaluation of stress and energy. Threads are those of
//! `RAYON_NUM_THREADS`.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput};
use stickslip::elements::{Elements, Motion, TangentPart};
use stickslip::linear::{Assembled, Transformation};
use stickslip::materials::Law;
use stickslip::model::{Damping, Element, ElementType, Material, Model, Section};

/// A unit square of n x n quadrilaterals.
fn grid(n: usize) -> Model {
    let mut model = Model::default();
    model.materials.push(Material {
        name: "M".into(),
        law: Law::elastic(1e4, 0.3),
        density: 1.0,
        damping: Damping::default(),
    });
    model.sections.push(Section {
        material: 0,
        thickness: 1.0,
    });
    let at = |i: usize| i as f64 / n as f64;
    let nodes = (0..(n + 1) * (n + 1)).map(|k| [at(k % (n + 1)), at(k / (n + 1))]);
    model.mesh.coordinates = nodes.collect();
    for element in 0..n * n {
        let first = element / n * (n + 1) + element % n;
        model.mesh.elements.push(Element {
            label: element as u64 + 1,
            element_type: ElementType::CPE4,
            nodes: vec![first, first + 1, first + n + 2, first + n + 1].into(),
            section: 0,
        });
    }
    model
}

/// Displacements of the nodes of a grid, small against its elements.
fn wave(n: usize, k: f64) -> Vec<f64> {
    let scale = 0.1 / n as f64;
    let dofs = 2 * (n + 1) * (n + 1);
    (0..dofs).map(|i| scale * (k * i as f64).sin()).collect()
}

/// K of a grid, zero, and the tangent of its first element.
fn stiffness(elements: &Elements, dofs: usize) -> (Assembled, Vec<f64>) {
    let of_node = |&node: &usize| [2 * node, 2 * node + 1];
    let of_element = |element: usize| elements.nodes(element).iter().flat_map(of_node).collect();
    let lists: Vec<Vec<usize>> = (0..elements.len()).map(of_element).collect();
    let matrix = Assembled::new(&Transformation::identity(dofs), &lists);
    let rest = vec![0.0; dofs];
    (matrix, elements.tangent(0, Motion::at(&rest, &[])))
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("sweep");
    group
        .sample_size(10)
        .measurement_time(Duration::from_secs(2));
    for n in [64, 256] {
        let elements = Elements::new(&grid(n));
        let (u0, u1) = (wave(n, 1.3), wave(n, 2.9));
        let at = Motion::at(&u1, &[]);
        let between = Motion {
            start: Some(&u0),
            ..at
        };
        let mut force = vec![0.0; u1.len()];
        let (mut matrix, tangent) = stiffness(&elements, u1.len());
        group.throughput(Throughput::Elements(elements.len() as u64));
        for (name, motion) in [("force", at), ("force, energy-momentum", between)] {
            group.bench_function(BenchmarkId::new(name, n), |bencher| {
                bencher.iter(|| elements.write_internal_force(black_box(motion), &mut force));
            });
        }
        group.bench_function(BenchmarkId::new("tangents", n), |bencher| {
            bencher.iter(|| {
                let add = |_: usize, k: &[f64]| {
                    black_box(k);
                };
                elements.for_each_tangent(black_box(between), TangentPart::Whole, |_| true, add);
            });
        });
        group.bench_function(BenchmarkId::new("refill", n), |bencher| {
            bencher.iter(|| {
                matrix.clear();
                (0..elements.len()).for_each(|element| matrix.add(element, &tangent, 0.5));
            });
        });
        group.bench_function(BenchmarkId::new("evaluate", n), |bencher| {
            bencher.iter(|| elements.evaluate(black_box(&u1), &[]));
        });
    }
    group.finish();
    criterion.final_summary();
}
