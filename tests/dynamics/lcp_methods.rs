//! The hybrid and Lemke's method at every pass give the same motion.

use stickslip::model::{LcpMethod, Model, Settings};

use crate::blocks::{Block, Keep, add_block, add_contact, fixed, model, run_to_end, step, throw};
use crate::invariants::oblique_impact;

#[test]
fn hybrid_and_lemke_give_the_same_histories() {
    let run = |lcp| {
        let mut model = oblique_impact(0.3, Settings::default().scheme);
        model.steps[0].settings.lcp = lcp;
        run_to_end(&model)
    };
    let (hybrid, counts) = run(LcpMethod::Hybrid);
    let (lemke, lemke_counts) = run(LcpMethod::Lemke);
    assert!(lemke_counts.solver.lemke_calls > counts.solver.lemke_calls);
    assert_same_motion(&hybrid, &lemke);
}

/// The same states of pairs, and displacements that differ by 1e-9 of the largest.
fn assert_same_motion(run: &Keep, other: &Keep) {
    for (a, b) in run.reports.iter().zip(&other.reports) {
        assert_eq!(
            (a.contacts[0].closed, a.contacts[0].sticking),
            (b.contacts[0].closed, b.contacts[0].sticking)
        );
        let size = a.state.u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        for (u, w) in a.state.u.iter().zip(&b.state.u) {
            assert!((u - w).abs() <= 1e-9 * size, "t {}: {u} and {w}", a.time);
        }
    }
}

/// Fourteen blocks in a row that land on a base, each with nine nodes and another velocity along it. All nodes of
/// a rigid base are fixed, else those at its bottom.
fn row_of_blocks(is_rigid: bool, lcp: LcpMethod) -> Model {
    const COUNT: usize = 14;
    let mut model = model(1e3, 0.3, 1.0);
    let length = 1.2 * COUNT as f64;
    let base = add_block(&mut model, [0.0, -0.3], [length, 0.3], (12 * COUNT, 3), 0.0);
    let origin = |k: usize| [1.2 * k as f64 + 0.25, 1e-3];
    let add = |k| add_block(&mut model, origin(k), [0.8, 0.3], (8, 3), 0.0);
    let blocks: Vec<Block> = (0..COUNT).map(add).collect();
    for (k, block) in blocks.iter().enumerate() {
        let along = 0.1 * (k as f64 - 6.0);
        throw(&mut model, block, [along, -1.0], 0.0, origin(k));
    }
    let soles = blocks.iter().flat_map(|block| block.faces(0)).collect();
    add_contact(&mut model, soles, base.faces(2), 0.2);
    let bottom = (0..=base.nx).map(|i| base.node(i, 0));
    let held: Vec<usize> = match is_rigid {
        true => base.nodes().collect(),
        false => bottom.collect(),
    };
    let supports = held.into_iter().flat_map(|n| [2 * n, 2 * n + 1]);
    let settings = Settings {
        lcp,
        ..Settings::default()
    };
    model.steps = vec![step(0.02, 4, settings, supports.map(fixed).collect())];
    model
}

#[test]
fn many_pairs_of_many_bodies_are_solved_by_blocks() {
    for is_rigid in [true, false] {
        let (blocks, counts) = run_to_end(&row_of_blocks(is_rigid, LcpMethod::Hybrid));
        let (lemke, _) = run_to_end(&row_of_blocks(is_rigid, LcpMethod::Lemke));
        let solver = counts.solver;
        assert!(solver.lcp_size > 100, "{solver:?}");
        assert_eq!(solver.lemke_calls, 0);
        assert!(
            solver.active_set_iterations >= 14 * solver.lcps / 2,
            "the problems have blocks: {solver:?}"
        );
        assert_same_motion(&blocks, &lemke);
    }
}

#[test]
fn many_pairs_of_two_bodies_are_solved_in_parts_along_the_surfaces() {
    let long_block = |lcp| {
        let mut model = model(1e3, 0.3, 1.0);
        let base = add_block(&mut model, [0.0, -0.2], [31.0, 0.2], (310, 2), 0.0);
        let origin = [0.45, 1e-3];
        let block = add_block(&mut model, origin, [30.0, 0.2], (300, 2), 0.0);
        throw(&mut model, &block, [0.5, -1.0], 0.0, origin);
        add_contact(&mut model, block.faces(0), base.faces(2), 0.2);
        let bottom = (0..=base.nx).map(|i| base.node(i, 0));
        let supports = bottom.flat_map(|n| [2 * n, 2 * n + 1]).map(fixed);
        let settings = Settings {
            lcp,
            ..Settings::default()
        };
        model.steps = vec![step(0.002, 2, settings, supports.collect())];
        run_to_end(&model)
    };
    let (parts, counts) = long_block(LcpMethod::Hybrid);
    let (lemke, _) = long_block(LcpMethod::Lemke);
    let solver = counts.solver;
    assert!(solver.lcp_size > 240, "{solver:?}");
    assert!(
        solver.active_set_iterations >= 5 * solver.lcps / 2,
        "the problems have parts: {solver:?}"
    );
    assert_same_motion(&parts, &lemke);
}
