//! A light body is solved to its own scale, whatever is beside it (docs/theory/time.md, convergence).
//!
//! ```text
//!      +---+
//!      |   |  2 x 2 Q4, light, thrown down
//!      +---+
//!        v
//!    +-------+
//!    |       |  4 x 2 Q4, stiffer, heavier or thicker by many orders
//!    +-------+  its foot held
//! ```

use crate::blocks::{
    Block, Keep, PAPER, add_block, add_contact, fixed, gravity, model, run_to_end, step, throw,
};
use stickslip::materials::Law;
use stickslip::model::{Material, Model, Section, Settings};

/// How much the base exceeds the light body, or that it is held altogether.
#[derive(Clone, Copy)]
enum Base {
    Held,
    Stiff(f64),
    Thick(f64),
}

/// Gives elements a section of their own.
fn make_heavy(model: &mut Model, elements: std::ops::Range<usize>, base: Base) {
    let (factor, thickness) = match base {
        Base::Held => (1.0, 1.0),
        Base::Stiff(factor) => (factor, 1.0),
        Base::Thick(thickness) => (1.0, thickness),
    };
    let light = model.materials[0].clone();
    let moduli = light.law.small_strain();
    model.materials.push(Material {
        law: Law::elastic(factor * moduli.young, moduli.poisson),
        density: factor * light.density,
        ..light
    });
    model.sections.push(Section {
        material: 1,
        thickness,
    });
    for element in &mut model.mesh.elements[elements] {
        element.section = 1;
    }
}

/// Displacements of a block at the end.
fn displacements(keep: &Keep, nodes: impl Iterator<Item = usize>) -> Vec<f64> {
    let u = &keep.reports.last().expect("reports").state.u;
    nodes.flat_map(|n| [u[2 * n], u[2 * n + 1]]).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// Worst energy balance as a part of the largest energy.
fn balance(keep: &Keep) -> f64 {
    let energies = keep.reports.iter().map(|r| r.energy);
    let most =
        |f: fn(stickslip::dynamics::Energy) -> f64| energies.clone().map(f).fold(0.0, f64::max);
    most(|e| e.balance.abs()) / most(|e| e.kinetic.max(e.strain).max(e.external_work.abs()))
}

/// Displacements of a light block thrown on a base, and the worst balance.
fn thrown_on(base: Base) -> (Vec<f64>, f64) {
    let mut model = model(1e3, 0.3, 1.0);
    let ground = add_block(&mut model, [0.0, 0.0], [2.0, 1.0], (4, 2), 0.0);
    let block = add_block(&mut model, [0.5, 1.01], [1.0, 1.0], (2, 2), 0.0);
    throw(&mut model, &block, [0.5, -0.5], 0.0, [0.0; 2]);
    add_contact(&mut model, block.faces(0), ground.faces(2), 0.3);
    let held: Vec<usize> = match base {
        Base::Held => ground.nodes().collect(),
        _ => (0..5).map(|i| ground.node(i, 0)).collect(),
    };
    make_heavy(&mut model, 0..8, base);
    let supports = held.into_iter().flat_map(|n| [2 * n, 2 * n + 1]).map(fixed);
    model.steps = vec![step(0.002, 30, Settings::default(), supports.collect())];
    let (keep, _) = run_to_end(&model);
    (displacements(&keep, block.nodes()), balance(&keep))
}

#[test]
fn a_light_body_beside_a_heavy_one() {
    let (expected, _) = thrown_on(Base::Held);
    for base in [Base::Stiff(1e6), Base::Stiff(1e12), Base::Thick(1e26)] {
        let (found, balance) = thrown_on(base);
        let pairs = found.iter().zip(&expected);
        let difference: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
        let error = largest(&difference) / largest(&expected);
        println!("error {error:.1e}, balance {balance:.1e}");
        // a base that is stiffer by 1e6 gives by a part of 1e-6
        let most = match base {
            Base::Stiff(1e6) => 1e-5,
            _ => 1e-8,
        };
        assert!(error < most && balance < 1e-12, "{error:e} {balance:e}");
    }
}

/// The same for the upper half of a column whose lower half is stiff and heavy.
fn column(base: Base) -> (Vec<f64>, f64) {
    let mut model = model(1e3, 0.3, 1.0);
    let column = add_block(&mut model, [0.0, 0.0], [1.0, 4.0], (2, 8), 0.0);
    throw(&mut model, &column, [0.3, -0.2], 0.5, [0.0, 4.0]);
    let rows = |from: usize, to: usize| (from..=to).flat_map(|j| (0..3).map(move |i| (i, j)));
    let nodes = |from, to| rows(from, to).map(|(i, j)| column.node(i, j));
    for node in nodes(0, 4) {
        model.initial_velocity[2 * node] = 0.0;
        model.initial_velocity[2 * node + 1] = 0.0;
    }
    let held = match base {
        Base::Held => nodes(0, 4),
        _ => nodes(0, 0),
    };
    let supports = held.flat_map(|n| [2 * n, 2 * n + 1]).map(fixed).collect();
    make_heavy(&mut model, 0..8, base);
    model.steps = vec![step(0.01, 30, Settings::default(), supports)];
    let (keep, _) = run_to_end(&model);
    (displacements(&keep, nodes(5, 8)), balance(&keep))
}

#[test]
fn a_light_part_of_a_heavy_body() {
    let (expected, _) = column(Base::Held);
    let (found, balance) = column(Base::Stiff(1e12));
    let pairs = found.iter().zip(&expected);
    let difference: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
    let error = largest(&difference) / largest(&expected);
    println!("error {error:.1e}, balance {balance:.1e}");
    assert!(error < 1e-8 && balance < 1e-12, "{error:e} {balance:e}");
}

/// Failed attempts and passes until a block has come to rest on a plate, and where it rests.
fn come_to_rest(tolerance: f64) -> (usize, usize, Vec<f64>) {
    let mut model = model(1e3, 0.3, 1.0);
    let plate = add_block(&mut model, [0.0, -1.0], [3.0, 1.0], (3, 1), 0.0);
    let block: Block = add_block(&mut model, [0.6, 0.0], [2.0, 1.0], (3, 2), 0.0);
    add_contact(&mut model, block.faces(0), plate.faces(2), 0.3);
    let supports = plate.nodes().flat_map(|n| [2 * n, 2 * n + 1]).map(fixed);
    let settings = Settings {
        tolerance,
        scheme: PAPER,
        ..Settings::default()
    };
    let mut sinks = step(0.1, 60, settings, supports.collect());
    let weight = |element| gravity(element, 9.81);
    sinks.body_forces = (3..9).map(weight).collect();
    model.steps = vec![sinks];
    let (keep, summary) = run_to_end(&model);
    let u = displacements(&keep, block.nodes());
    (summary.cutbacks, summary.solver.passes, u)
}

#[test]
fn a_looser_tolerance_is_never_harder_to_reach() {
    let tolerances = [1e-11, 1e-9, 1e-7, 1e-5];
    let runs = tolerances.map(come_to_rest);
    for ((cutbacks, passes, u), tolerance) in runs.iter().zip(tolerances) {
        println!("{tolerance:e}: {cutbacks} cutbacks, {passes} passes");
        let pairs = u.iter().zip(&runs[0].2);
        let difference: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
        assert!(largest(&difference) < 10.0 * tolerance * largest(&runs[0].2));
    }
    assert_eq!(runs[0].0, 0, "at rest the round-off of positions counts");
    for pair in runs.windows(2) {
        assert!(pair[1].0 <= pair[0].0 && pair[1].1 <= pair[0].1);
    }
}
