//! Time of the sweeps over the elements.
//!
//! `cargo bench --bench sweep` measures a grid of n x n quadrilaterals under some displacements: the
//! internal force at one configuration and in the energy-momentum form, the tangents, the refill of a
//! matrix from tangents that are known, and the evaluation of stress and energy. Force and tangents in the
//! energy-momentum form are measured for every element type and material too. Threads are those of
//! `RAYON_NUM_THREADS`.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput};
use stickslip::elements::{Elements, Motion, TangentPart};
use stickslip::linear::{Assembled, Transformation};
use stickslip::materials::{Law, NeoHooke, Plastic, Polynomial};
use stickslip::model::{Damping, Element, ElementType, Formulation, Material, Model, Section};

/// A unit square of n x n quadrilaterals, or twice as many triangles.
fn grid(n: usize, element_type: ElementType, law: Law) -> Model {
    let mut model = Model::default();
    model.materials.push(Material {
        name: "M".into(),
        law,
        density: 1.0,
        damping: Damping::default(),
        expansion: None,
    });
    model.sections.push(Section {
        material: 0,
        thickness: 1.0,
    });
    let count = element_type.topology().nodes;
    let is_triangle = element_type.topology().sides.len() == 3;
    // a quadratic element covers two steps of the grid of the nodes
    let step = if matches!(count, 3 | 4) { 1 } else { 2 };
    let side = step * n + 1;
    let mut used = vec![usize::MAX; side * side];
    for cell in 0..n * n {
        let [x, y] = [cell % n, cell / n].map(|k| k * step);
        let corners = [[0, 0], [step, 0], [step, step], [0, step]];
        let of_triangles = [vec![0, 1, 2], vec![0, 2, 3]];
        let all = if is_triangle {
            of_triangles.to_vec()
        } else {
            vec![vec![0, 1, 2, 3]]
        };
        for corners in all.iter().map(|of| of.iter().map(|&k: &usize| corners[k])) {
            let corners: Vec<[usize; 2]> = corners.collect();
            let next = corners.iter().cycle().skip(1);
            let middles = corners
                .iter()
                .zip(next)
                .map(|(a, b)| [0, 1].map(|i| (a[i] + b[i]) / 2));
            let places: Vec<[usize; 2]> =
                corners.iter().copied().chain(middles).take(count).collect();
            let nodes = places.iter().map(|place| {
                let [i, j] = [x + place[0], y + place[1]];
                let node = &mut used[j * side + i];
                if *node == usize::MAX {
                    *node = model.mesh.coordinates.len();
                    let at = |k: usize| k as f64 / (side - 1) as f64;
                    model.mesh.coordinates.push([at(i), at(j)]);
                }
                *node
            });
            let nodes = nodes.collect();
            model.mesh.elements.push(Element {
                label: model.mesh.elements.len() as u64 + 1,
                element_type,
                nodes,
                section: 0,
            });
        }
    }
    model
}

/// Displacements of the nodes of a grid of n x n elements, small against its elements.
fn wave(n: usize, nodes: usize, k: f64) -> Vec<f64> {
    let scale = 0.05 / n as f64;
    (0..2 * nodes)
        .map(|i| scale * (k * i as f64).sin())
        .collect()
}

/// Laws of the same moduli at small strains.
fn laws() -> [(&'static str, Law); 5] {
    let neo_hooke = NeoHooke::of_small_strain(Law::elastic(1e4, 0.3).small_strain());
    let NeoHooke { c10, d1 } = neo_hooke;
    let polynomial = |shape: [f64; 3], c01| {
        Law::Polynomial(Polynomial {
            shape,
            c01,
            d: [d1, 0.0, 0.0],
        })
    };
    [
        ("St. Venant-Kirchhoff", Law::elastic(1e4, 0.3)),
        ("neo-Hooke", Law::NeoHooke(neo_hooke)),
        (
            "Mooney-Rivlin",
            polynomial([0.75 * c10, 0.0, 0.0], 0.25 * c10),
        ),
        ("Yeoh", polynomial([c10, -0.1 * c10, 0.1 * c10], 0.0)),
        (
            "metal",
            Law::Plastic(Plastic {
                moduli: Law::elastic(1e4, 0.3).small_strain(),
                hardening: [[0.0, 50.0], [1.0, 100.0]].into(),
                kinematic: 0.0,
            }),
        ),
    ]
}

/// Force and tangents of every type and law in the energy-momentum form.
fn types_and_laws(criterion: &mut Criterion) {
    const MEAN_DILATATION: ElementType = ElementType {
        formulation: Formulation::MeanDilatation,
        ..ElementType::CPE4
    };
    const TYPES: [ElementType; 17] = [
        ElementType::CPE3,
        ElementType::CPE4,
        MEAN_DILATATION,
        ElementType::CPE6,
        ElementType::CPE8,
        ElementType::CPE8R,
        ElementType::CPS4,
        ElementType::CPS8,
        ElementType::CPS8R,
        ElementType::CPE4I,
        ElementType::CPE4R,
        ElementType::CPE8RH,
        ElementType::CAX4,
        ElementType::CAX4H,
        ElementType::CAX4I,
        ElementType::CAX4R,
        ElementType::CAX8R,
    ];
    let n = 32;
    let mut group = criterion.benchmark_group("types and laws");
    group
        .sample_size(10)
        .measurement_time(Duration::from_millis(500));
    group.warm_up_time(Duration::from_millis(200));
    for (element_type, (law_name, law)) in
        TYPES.into_iter().flat_map(|t| laws().map(|law| (t, law)))
    {
        let model = grid(n, element_type, law);
        let elements = Elements::new(&model);
        let [u0, u1] = [1.3, 2.9].map(|k| wave(n, model.mesh.node_count(), k));
        let committed = elements.initial_variables();
        let between = Motion {
            start: Some(&u0),
            ..Motion::at(&u1, &committed)
        };
        let mut force = vec![0.0; u1.len()];
        group.throughput(Throughput::Elements(elements.len() as u64));
        let mean = if element_type == MEAN_DILATATION {
            " mean"
        } else {
            ""
        };
        let name = format!("{}{mean}, {law_name}", element_type.name());
        group.bench_function(BenchmarkId::new("force", &name), |bencher| {
            bencher.iter(|| elements.write_internal_force(black_box(between), &mut force));
        });
        group.bench_function(BenchmarkId::new("tangents", &name), |bencher| {
            bencher.iter(|| {
                let add = |_: usize, k: &[f64]| {
                    black_box(k);
                };
                elements.for_each_tangent(black_box(between), TangentPart::Whole, |_| true, add);
            });
        });
    }
    group.finish();
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
        let model = grid(n, ElementType::CPE4, Law::elastic(1e4, 0.3));
        let elements = Elements::new(&model);
        let [u0, u1] = [1.3, 2.9].map(|k| wave(n, model.mesh.node_count(), k));
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
            bencher.iter(|| elements.evaluate(black_box(Motion::at(&u1, &[]))));
        });
    }
    group.finish();
    types_and_laws(&mut criterion);
    criterion.final_summary();
}
