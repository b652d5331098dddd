//! Joints: contacts between the same bodies, which say nearly the same, change their states together.

use nalgebra::{DMatrix, DVector};
use stickslip::lcp::{
    ContactState, Counters, FreeUnknowns, FrictionalLcp, KeptFactors, Known, LcpMethod,
    solve_similar,
};

use crate::random::Random;

/// Joints of 2 to 6 contacts, each of rank two or so: the contacts of a joint are mixtures of two of its dofs, whose
/// compliances are coupled to those of the other joints. Every second matrix is not symmetric.
fn problem(random: &mut Random) -> (FrictionalLcp, Vec<usize>) {
    let joints: Vec<usize> = (0..3 + random.below(4))
        .map(|_| 2 + random.below(5))
        .collect();
    let numbers: Vec<usize> = (joints.iter().enumerate())
        .flat_map(|(joint, &count)| vec![joint; count])
        .collect();
    let (n, dofs) = (numbers.len(), 4 * joints.len());
    let compliance = random.gram(dofs, dofs, 1.0);
    // rows n, then t: each over the dofs of two points of its joint
    let mut rows = DMatrix::zeros(2 * n, dofs);
    for (k, &joint) in numbers.iter().enumerate() {
        let part = random.unit();
        for (direction, row) in [k, n + k].into_iter().enumerate() {
            rows[(row, 4 * joint + direction)] = 1.0 - part;
            rows[(row, 4 * joint + 2 + direction)] = part;
        }
    }
    let mut derivatives = rows.clone();
    if random.below(2) == 1 {
        derivatives += random.matrix(2 * n, dofs).component_mul(&rows) * 0.05;
    }
    let q = &derivatives * compliance * rows.transpose() + DMatrix::identity(2 * n, 2 * n) * 1e-3;
    let mu = random.range(0.0, 0.6);
    let problem = FrictionalLcp {
        q,
        gap: random.vector(n, -1.0, 0.3),
        slip: random.vector(n, -1.0, 1.0),
        mu: DVector::from_element(n, mu),
        free: FreeUnknowns::default(),
    };
    (problem, numbers)
}

#[test]
fn states_of_joints_change_together_to_the_answers_of_single_contacts() {
    let mut random = Random(7);
    let mut work = [Counters::default(); 2];
    for case in 0..1000 {
        let (problem, numbers) = problem(&mut random);
        let n = problem.len();
        let states = [ContactState::Open, ContactState::Stick];
        let states: Vec<ContactState> = (0..n).map(|_| states[random.below(2)]).collect();
        let none = || Vec::new();
        let own = || numbers.clone();
        let joints: [&dyn Fn() -> Vec<usize>; 2] = [&none, &own];
        let found = joints.map(|joints| {
            let known = Known {
                states: &states,
                joints,
            };
            let mut kept = KeptFactors::default();
            solve_similar(&problem, Some(known), LcpMethod::Hybrid, &mut kept).expect("solved")
        });
        for (work, found) in work.iter_mut().zip(&found) {
            assert!(found.residual < 1e-9, "{case}");
            *work += found.counters;
        }
        let [single, together] = &found;
        // shared forces differ, the motion does not
        let difference = (&single.gap - &together.gap).amax();
        assert!(difference < 1e-6 * single.gap.amax(), "{case} {difference}");
    }
    let [single, together] = work;
    assert!(together.active_set_iterations < single.active_set_iterations);
    // what cycles with single contacts ends with joints
    assert!(single.gauss_seidel_sweeps > 100);
    assert_eq!(together.gauss_seidel_sweeps, 0);
}
