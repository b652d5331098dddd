//! Bodies under pressure: K* is indefinite where contact alone holds them.
//!
//! ```text
//!   |+---------------------------+<- pushed in by 5 % of its length
//!   |+---------------------------+   a slender bar under its weight, far beyond its Euler load
//!    +---------------------------+
//!    |/////// held ground ///////|
//! ```

use nalgebra::DMatrix;
use stickslip::elements::{Elements, Motion, TangentPart};
use stickslip::materials::{Law, NeoHooke};
use stickslip::model::{ElementType, Formulation, Model, Support, SupportMotion};

use crate::blocks::{
    Block, SCHEMES, add_block, add_contact, fixed, gravity, model, run_to_end, settings, step,
};

const NEO_HOOKE: Law = Law::NeoHooke(NeoHooke {
    c10: 200.0,
    d1: 2e-3,
});

const TYPES: [ElementType; 2] = [
    ElementType::CPE4,
    ElementType {
        formulation: Formulation::MeanDilatation,
        ..ElementType::CPE4
    },
];

/// A bar of 20 x 2 Q4 with supports at its ends, of which the right one moves in by 5 %.
fn pushed_bar() -> (Model, Block, Vec<Support>) {
    let mut model = model(2e4, 0.3, 0.01);
    let bar = add_block(&mut model, [0.0, 0.0], [8.0, 0.4], (20, 2), 0.0);
    let weight = (0..40).map(|element| gravity(element, 1e3));
    let weight = weight.collect();
    let ends = |i: usize| (0..=2).map(move |j| (i, j));
    let mut supports: Vec<Support> = ends(0).map(|(i, j)| fixed(2 * bar.node(i, j))).collect();
    supports.extend(ends(20).map(|(i, j)| Support {
        dof: 2 * bar.node(i, j),
        motion: SupportMotion::Ramp { to: -0.4 },
    }));
    model.steps = vec![step(0.1, 10, settings(SCHEMES[0]), Vec::new())];
    model.steps[0].body_forces = weight;
    (model, bar, supports)
}

/// Displacements at the end of the bar, and cutbacks.
fn end(mut model: Model, bar: &Block, mut supports: Vec<Support>) -> (Vec<f64>, usize) {
    supports.sort_by_key(|support| support.dof);
    model.steps[0].supports = supports;
    let (keep, summary) = run_to_end(&model);
    let u = &keep.reports[keep.reports.len() - 1].state.u;
    let dofs = bar.nodes().flat_map(|node| [2 * node, 2 * node + 1]);
    (dofs.map(|dof| u[dof]).collect(), summary.cutbacks)
}

/// The ground does what supports below the bar do: no increment is cut, and the answer is the same.
#[test]
fn a_bar_far_beyond_its_euler_load_that_the_ground_holds() {
    for scheme in SCHEMES {
        let (mut held, bar, mut supports) = pushed_bar();
        held.steps[0].settings = settings(scheme);
        supports.extend((0..=20).map(|i| fixed(2 * bar.node(i, 0) + 1)));
        let (expected, _) = end(held, &bar, supports);

        let (mut free, bar, mut supports) = pushed_bar();
        free.steps[0].settings = settings(scheme);
        let ground = add_block(&mut free, [-1.0, -1.0], [10.0, 1.0], (1, 1), 0.0);
        supports.extend(
            ground
                .nodes()
                .flat_map(|n| [fixed(2 * n), fixed(2 * n + 1)]),
        );
        add_contact(&mut free, bar.faces(0), ground.faces(2), 0.0);
        let (found, cutbacks) = end(free, &bar, supports);
        assert_eq!(cutbacks, 0, "{scheme:?}");
        for (found, expected) in found.iter().zip(&expected) {
            assert!(
                (found - expected).abs() < 1e-9,
                "{scheme:?} {found} {expected}"
            );
        }
    }
}

/// A block between platens with friction, pressed by 40 %: no increment is cut, and what holds the
/// block in K* costs no passes.
#[test]
fn a_block_between_platens_that_alone_hold_it() {
    for scheme in SCHEMES {
        let mut model = model(1.0, 0.3, 1.0);
        model.materials[0].law = NEO_HOOKE;
        let block = add_block(&mut model, [0.0, 0.0], [1.0, 0.5], (12, 6), 0.0);
        let platens =
            [-1.0, 0.5].map(|y| add_block(&mut model, [-1.0, y], [3.0, 1.0], (1, 1), 0.0));
        for element in &mut model.mesh.elements {
            element.element_type = ElementType::CPE4;
        }
        add_contact(&mut model, block.faces(0), platens[0].faces(2), 0.3);
        add_contact(&mut model, block.faces(2), platens[1].faces(0), 0.3);
        let mut supports: Vec<Support> = platens
            .iter()
            .flat_map(Block::nodes)
            .collect::<Vec<_>>()
            .into_iter()
            .flat_map(|n| [fixed(2 * n), fixed(2 * n + 1)])
            .collect();
        let lid = platens[1].nodes();
        for support in &mut supports {
            if lid.contains(&(support.dof / 2)) && support.dof % 2 == 1 {
                support.motion = SupportMotion::Ramp { to: -0.2 };
            }
        }
        model.steps = vec![step(0.05, 20, settings(scheme), supports)];
        let (keep, summary) = run_to_end(&model);
        assert_eq!(summary.cutbacks, 0, "{scheme:?}");
        let most = keep.reports.iter().map(|report| report.passes.len()).max();
        assert!(most <= Some(12), "{scheme:?} {most:?}");
    }
}

/// Tangent of all elements, or its positive part, at displacements `u`.
fn tangent(elements: &Elements, u: &[f64], part: TangentPart) -> DMatrix<f64> {
    let mut k = DMatrix::zeros(u.len(), u.len());
    elements.for_each_tangent(
        Motion::at(u, &[]),
        part,
        |_| true,
        |element, matrix: &[f64]| {
            let nodes = elements.nodes(element).iter();
            let dofs: Vec<usize> = nodes.flat_map(|n| [2 * n, 2 * n + 1]).collect();
            for (k_e, (&row, &column)) in matrix
                .iter()
                .zip(dofs.iter().flat_map(|c| dofs.iter().map(move |r| (r, c))))
            {
                k[(row, column)] += k_e;
            }
        },
    );
    k
}

/// Eigenvalues of whole and positive part at a stretch of a 2 x 2 block, relative to the largest.
fn least_eigenvalues(law: Law, element_type: ElementType, stretch: f64) -> [f64; 2] {
    let mut model = model(1.0, 0.3, 1.0);
    model.materials[0].law = law;
    add_block(&mut model, [0.0, 0.0], [1.0, 1.0], (2, 2), 0.0);
    for element in &mut model.mesh.elements {
        element.element_type = element_type;
    }
    let x = &model.mesh.coordinates;
    let u: Vec<f64> = x
        .iter()
        .flat_map(|x| [0.0, (stretch - 1.0) * x[1]])
        .collect();
    let elements = Elements::new(&model);
    [TangentPart::Whole, TangentPart::Positive].map(|part| {
        let eigenvalues = tangent(&elements, &u, part).symmetric_eigenvalues();
        eigenvalues.min() / eigenvalues.max()
    })
}

#[test]
fn the_positive_part_of_the_tangent_has_no_negative_eigenvalues() {
    for law in [Law::elastic(1e3, 0.3), NEO_HOOKE] {
        for element_type in TYPES {
            // 0.5 lies beyond the largest force of the St. Venant-Kirchhoff law, at 1/sqrt(3)
            for stretch in [0.5, 0.7, 0.9] {
                let [whole, positive] = least_eigenvalues(law.clone(), element_type, stretch);
                assert!(whole < -1e-3, "{law:?} {stretch}: {whole}");
                assert!(positive > -1e-14, "{law:?} {stretch}: {positive}");
            }
            let [whole, positive] = least_eigenvalues(law.clone(), element_type, 1.2);
            assert!((whole - positive).abs() < 1e-14 && whole > -1e-14);
        }
    }
}
