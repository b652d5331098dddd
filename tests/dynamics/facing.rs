//! Nodes that lie on each other and come back to where they were: a block on a block, both symmetric about the
//! same line, without friction, with whole skins as surfaces in two passes.

use crate::blocks::{
    Block, SCHEMES, add_block, add_contact, fixed, gravity, model, run_to_end, settings, step,
};
use stickslip::model::{Face, Model, Scheme};

/// A block that falls on a wider one, which is held at its base; middle nodes of both meet at hollow and convex
/// corners of the dented faces.
fn block_on_block(scheme: Scheme) -> Model {
    let mut model = model(1e3, 0.3, 1.0);
    let below = add_block(&mut model, [0.0; 2], [2.0, 1.0], (4, 2), 0.0);
    let above = add_block(&mut model, [0.5, 1.01], [1.0; 2], (2, 2), 0.0);
    let skin = |block: &Block| -> Vec<Face> { (0..4).flat_map(|side| block.faces(side)).collect() };
    add_contact(&mut model, skin(&below), skin(&above), 0.0);
    add_contact(&mut model, skin(&above), skin(&below), 0.0);
    let base = (0..=below.nx).map(|i| below.node(i, 0));
    let supports = base.flat_map(|node| [2 * node, 2 * node + 1]).map(fixed);
    let mut step = step(0.005, 200, settings(scheme), supports.collect());
    step.body_forces = (0..model.mesh.elements.len())
        .map(|element| gravity(element, 9.81))
        .collect();
    model.steps = vec![step];
    model
}

#[test]
fn the_force_on_a_node_that_comes_back_is_not_tilted_by_round_off() {
    for scheme in SCHEMES {
        let (keep, _) = run_to_end(&block_on_block(scheme));
        assert!(keep.cutbacks.is_empty(), "{:?}", keep.cutbacks.first());
    }
}
