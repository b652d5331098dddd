//! What takes memory from the system: no sweep over the elements after the first, and no pass after the first
//! increment but for the factors of contacts that have changed their states.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::io;

use stickslip::dynamics::{Cutback, IncrementReport, Observer};
use stickslip::elements::{Elements, Motion, TangentPart};
use stickslip::linear::{Assembled, Transformation};
use stickslip::materials::{Law, NeoHooke};
use stickslip::model::{
    ContactFormulation, Element, ElementType, Formulation, Model, Scheme, Settings, Support,
    SupportMotion,
};

// shared with tests/dynamics, which use all of it
#[allow(dead_code)]
#[path = "dynamics/blocks.rs"]
mod blocks;

/// Most allocations of a pass: the factors of the complementarity problem, or of its border, in four parts, with the
/// matrix and what is solved with it.
const OF_A_PASS: f64 = 8.0;
/// Least bytes of an allocation that is counted as large: fewer than those of a vector over all dofs of the blocks.
const LARGE: usize = 16_000;

/// The allocator of the system, which counts what each thread asks of it.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
    static LARGE_ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

/// Counts an allocation of so many bytes.
fn count(bytes: usize) {
    ALLOCATIONS.set(ALLOCATIONS.get() + 1);
    LARGE_ALLOCATIONS.set(LARGE_ALLOCATIONS.get() + usize::from(bytes >= LARGE));
}

// SAFETY: all is passed on to the allocator of the system.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size);
        unsafe { System.realloc(memory, layout, size) }
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
    for law in [Law::elastic(100.0, 0.3), rubber] {
        model.add_section(law, 1.0, 1.0);
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
    let before = ALLOCATIONS.get();
    work();
    ALLOCATIONS.get() - before
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
    one_thread().install(|| [(); 2].map(|()| allocations(&mut sweep)))
}

fn one_thread() -> rayon::ThreadPool {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.expect("a thread")
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

/// Two blocks, the lower one held below, the upper one pressed on it and then sheared, with friction.
fn pressed_and_sheared(formulation: ContactFormulation, tolerance: f64) -> Model {
    let mut model = blocks::model(1e3, 0.3, 1.0);
    let lower = blocks::add_block(&mut model, [0.0, 0.0], [2.0, 0.5], (16, 32), 0.0);
    let upper = blocks::add_block(&mut model, [0.23, 0.5001], [1.5, 0.5], (13, 32), 0.0);
    blocks::add_contact(&mut model, upper.faces(0), lower.faces(2), 0.3);
    model.contacts[0].formulation = formulation;
    let held = (0..=lower.nx).flat_map(|i| [0, 1].map(|k| (2 * lower.node(i, 0) + k, 0.0)));
    let top = (0..=upper.nx).map(|i| upper.node(i, upper.ny));
    let moved = top.flat_map(|node| [(2 * node, 0.02), (2 * node + 1, -0.01)]);
    let support = |(dof, to)| Support {
        dof,
        motion: SupportMotion::Ramp { to },
    };
    let settings = Settings {
        tolerance,
        scheme: Scheme::EnergyMomentum,
        ..Settings::default()
    };
    let supports = held.chain(moved).map(support).collect();
    model.steps = vec![blocks::step(0.01, 20, settings, supports)];
    model
}

/// Counts at the end of an increment.
#[derive(Clone, Copy)]
struct Count {
    allocations: [usize; 2],
    passes: usize,
    factorizations: usize,
}

/// Counts at the end of all increments.
struct Counts(Vec<Count>);

impl Observer for Counts {
    fn increment(&mut self, report: &IncrementReport) -> io::Result<()> {
        self.0.push(Count {
            allocations: [ALLOCATIONS.get(), LARGE_ALLOCATIONS.get()],
            passes: report.solver.passes,
            factorizations: report.solver.factorizations,
        });
        Ok(())
    }

    fn cutback(&mut self, _: &Cutback) -> io::Result<()> {
        Err(io::Error::other("an increment was cut back"))
    }
}

/// All allocations and large ones of every increment but the first, with its passes and factorisations.
fn of_increments(formulation: ContactFormulation, tolerance: f64) -> Vec<Count> {
    let model = pressed_and_sheared(formulation, tolerance);
    assert!(8 * model.mesh.dof_count() > LARGE);
    one_thread().install(|| {
        let mut counts = Counts(Vec::with_capacity(100));
        let _ = blocks::run(&model, &mut counts).expect("runs");
        let of_one = |both: &[Count]| Count {
            allocations: [0, 1].map(|i| both[1].allocations[i] - both[0].allocations[i]),
            ..both[1]
        };
        counts.0[1..].windows(2).map(of_one).collect()
    })
}

/// Checks what passes take that a smaller tolerance asks for, after so many of the increments that are counted: lists of
/// points grow for as long as there are more of them than before.
fn check_passes(formulation: ContactFormulation, growing: usize) {
    let [few, many] = [1e-6, 1e-12].map(|tolerance| of_increments(formulation, tolerance));
    let (mut compared, mut without) = (0, 0);
    for (few, many) in few.into_iter().zip(many).skip(growing) {
        // factors of K* are others whenever they are made anew
        if many.passes == few.passes || [few, many].iter().any(|c| c.factorizations > 0) {
            continue;
        }
        let passes = (many.passes - few.passes) as f64;
        let of_pass =
            [0, 1].map(|i| (many.allocations[i] as f64 - few.allocations[i] as f64) / passes);
        println!("{of_pass:?} allocations per pass");
        assert!(of_pass[0] <= OF_A_PASS, "{of_pass:?}");
        assert_eq!(of_pass[1], 0.0, "large ones");
        compared += 1;
        without += usize::from(of_pass[0] <= 0.0);
    }
    assert!(compared >= 10, "{compared} increments");
    assert!(
        without >= 5,
        "{without} increments whose passes take nothing"
    );
}

#[test]
fn passes_take_memory_for_factors_of_contacts_only_after_the_first_increment() {
    check_passes(ContactFormulation::NodeToSegment, 0);
}

#[test]
fn passes_from_surface_to_surface_take_no_more() {
    check_passes(ContactFormulation::SurfaceToSurface, 1);
}
