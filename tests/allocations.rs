//! Sweeps over the elements take no memory after the first.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

use stickslip::elements::{Elements, Motion, TangentPart};
use stickslip::linear::{Assembled, Transformation};
use stickslip::materials::{Law, NeoHooke};
use stickslip::model::{Damping, Element, ElementType, Formulation, Material, Model, Section};

/// The allocator of the system, which counts what is asked of it.
struct Counting;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: all is passed on to the allocator of the system.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Quadrilaterals in a row, elastic, of rubber and with mean dilatation in turn, each with a triangle above.
fn row(length: usize) -> Model {
    let mut model = Model::default();
    let rubber = Law::NeoHooke(NeoHooke {
        c10: 20.0,
        d1: 0.02,
    });
    for (material, law) in [Law::elastic(100.0, 0.3), rubber].into_iter().enumerate() {
        model.materials.push(Material {
            name: "M".into(),
            law,
            density: 1.0,
            damping: Damping::default(),
        });
        model.sections.push(Section {
            material,
            thickness: 1.0,
        });
    }
    let mean = ElementType {
        formulation: Formulation::MeanDilatation,
        ..ElementType::CPE4
    };
    let mesh = &mut model.mesh;
    for i in 0..length + 1 {
        let x = i as f64;
        mesh.coordinates
            .extend([[x, 0.0], [x, 1.0], [x + 0.5, 2.0]]);
    }
    let kinds = [(ElementType::CPE4, 0), (ElementType::CPE4, 1), (mean, 1)];
    for i in 0..length {
        let [a, b] = [3 * i, 3 * i + 3];
        let (quad, section) = kinds[i % 3];
        let quad = (quad, vec![a, b, b + 1, a + 1], section);
        let tri = (ElementType::CPE3, vec![a + 1, b + 1, a + 2], section);
        for (element_type, nodes, section) in [quad, tri] {
            mesh.elements.push(Element {
                label: 1,
                element_type,
                nodes: nodes.into(),
                section,
            });
        }
    }
    model
}

/// Allocations while some work runs.
fn allocations(work: &mut dyn FnMut()) -> usize {
    let before = ALLOCATIONS.load(Ordering::Relaxed);
    work();
    ALLOCATIONS.load(Ordering::Relaxed) - before
}

/// Allocations of the first sweep of force, tangents and refill, and of the next, in one thread.
fn of_sweeps(elements: &Elements, motion: Motion, matrix: &mut Assembled) -> [usize; 2] {
    let mut force = vec![0.0; motion.end.len()];
    let mut sweep = || {
        let result = elements.write_internal_force(motion, &mut force);
        assert_eq!(result, Ok(()));
        matrix.clear();
        let add = |element: usize, k: &[f64]| matrix.add(element, k, 0.5);
        elements.for_each_tangent(motion, TangentPart::Whole, |_| true, add);
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.expect("a thread");
    pool.install(|| [(); 2].map(|()| allocations(&mut sweep)))
}

#[test]
fn a_sweep_takes_no_memory_after_the_first() {
    let model = row(3000);
    let elements = Elements::new(&model);
    let dofs = 2 * model.mesh.coordinates.len();
    let wave = |k: f64| -> Vec<f64> { (0..dofs).map(|i| 0.1 * (k * i as f64).sin()).collect() };
    let (u0, u1) = (wave(1.3), wave(2.9));
    let of_node = |&node: &usize| [2 * node, 2 * node + 1];
    let of_element = |element: usize| elements.nodes(element).iter().flat_map(of_node).collect();
    let lists: Vec<Vec<usize>> = (0..elements.len()).map(of_element).collect();
    let mut matrix = Assembled::new(&Transformation::identity(dofs), &lists);
    let at = Motion::at(&u1, &[]);
    let between = Motion {
        start: Some(&u0),
        ..at
    };
    let [first, next] = of_sweeps(&elements, between, &mut matrix);
    assert!(first > 0, "the first one makes room, or nothing is counted");
    assert_eq!(next, 0);
    assert_eq!(of_sweeps(&elements, at, &mut matrix)[1], 0);
}
