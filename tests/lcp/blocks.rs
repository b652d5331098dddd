//! Frictional problems of coupled blocks: the block iteration finds the answer of Lemke's method, or says that
//! it does not converge.

use crate::problems::{drawn, in_units, states, unique};
use crate::random::Random;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stickslip::lcp::{
    BlockIteration, BlockSolution, BlockStart, FreeUnknowns, FrictionalLcp, KeptFactors, LcpBlock,
    LcpMethod, Progress, solve_frictional,
};

#[derive(Debug, Clone)]
struct Case {
    /// Contacts of every block.
    sizes: Vec<usize>,
    /// Size of what couples the blocks, relative to what couples the contacts of one.
    coupling: f64,
    mu: f64,
    /// Decimal exponents of the units of length and force.
    units: (i32, i32),
    seed: u64,
}

fn cases() -> impl Strategy<Value = Case> {
    let coupling = prop::sample::select(vec![0.0, 1e-12, 1e-6, 1e-3, 0.03, 0.3, 1.0]);
    let mu = prop::sample::select(vec![0.0, 0.1, 0.3, 0.6]);
    let sizes = prop::collection::vec(1..6usize, 2..6);
    let units = (-12..=12, -12..=12);
    (sizes, coupling, mu, units, any::<u64>()).prop_map(|(sizes, coupling, mu, units, seed)| Case {
        sizes,
        coupling,
        mu,
        units,
        seed,
    })
}

/// The blocks that the contacts belong to, dealt at random.
fn dealt(random: &mut Random, sizes: &[usize]) -> Vec<Vec<usize>> {
    let mut contacts: Vec<usize> = (0..sizes.iter().sum()).collect();
    for k in (1..contacts.len()).rev() {
        contacts.swap(k, random.below(k + 1));
    }
    let mut rest = contacts.as_slice();
    let deal = |&size: &usize| {
        let (own, others) = rest.split_at(size);
        rest = others;
        own.to_vec()
    };
    sizes.iter().map(deal).collect()
}

/// Positions of normal and tangential rows of some contacts.
fn rows(contacts: &[usize], n: usize) -> Vec<usize> {
    let tangential = contacts.iter().map(|contact| contact + n);
    contacts.iter().copied().chain(tangential).collect()
}

/// A positive definite Q whose blocks are coupled by `case.coupling`.
fn coupled(random: &mut Random, case: &Case, blocks: &[Vec<usize>]) -> FrictionalLcp {
    let n: usize = case.sizes.iter().sum();
    let mut q = random.gram(2 * n, 2 * n, 0.0) * (case.coupling / n as f64);
    for contacts in blocks {
        let at = rows(contacts, n);
        let own = random.gram(at.len(), at.len(), 1.0) / contacts.len() as f64;
        for (i, &row) in at.iter().enumerate() {
            for (j, &column) in at.iter().enumerate() {
                q[(row, column)] += own[(i, j)];
            }
        }
    }
    let units = [case.units.0, case.units.1].map(|exponent| 10f64.powi(exponent));
    in_units(drawn(random, q, case.mu), units)
}

fn block(problem: &FrictionalLcp, contacts: &[usize]) -> LcpBlock {
    let at = rows(contacts, problem.len());
    let size = contacts.len();
    LcpBlock {
        contacts: contacts.to_vec(),
        problem: FrictionalLcp {
            q: DMatrix::from_fn(2 * size, 2 * size, |i, j| problem.q[(at[i], at[j])]),
            gap: DVector::zeros(size),
            slip: DVector::zeros(size),
            mu: DVector::from_fn(size, |k, _| problem.mu[contacts[k]]),
            free: FreeUnknowns::default(),
        },
        kept: KeptFactors::default(),
    }
}

/// Gaps and slips under some forces.
fn motion(problem: &FrictionalLcp, forces: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let of = |i: usize| DVector::from_iterator(forces.len(), forces.iter().map(|f| f[i]));
    let (gap, slip) = problem.motion(&of(0), &of(1));
    gap.iter().zip(&slip).map(|(g, s)| [*g, *s]).collect()
}

/// The answer by blocks and the iterations it took, if it was found; it starts with random forces.
fn solved_by_blocks(
    problem: &FrictionalLcp,
    blocks: &[Vec<usize>],
    random: &mut Random,
) -> Option<(BlockSolution, usize)> {
    let n = problem.len();
    let size = problem.gap.amax() / problem.q.amax();
    let forces: Vec<[f64; 2]> = (0..n).map(|_| [size * random.unit(), 0.0]).collect();
    let start = BlockStart {
        states: states(random, n, 0.3, 0.4),
        motion: motion(problem, &forces),
        forces,
        free: motion(problem, &vec![[0.0; 2]; n]),
    };
    let blocks = blocks.iter().map(|contacts| block(problem, contacts));
    let mut iteration = BlockIteration::new(blocks.collect(), start, LcpMethod::Hybrid);
    for iterations in 1.. {
        let forces = iteration.forces().ok()?.to_vec();
        match iteration.take_in(&motion(problem, &forces)) {
            Progress::GoesOn => {}
            Progress::Solved => return Some((iteration.end().0, iterations)),
            Progress::Fails => return None,
        }
    }
    None
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 4000,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn blocks_find_the_answer_of_lemkes_method(case in cases()) {
        let mut random = Random(case.seed);
        let blocks = dealt(&mut random, &case.sizes);
        let problem = coupled(&mut random, &case, &blocks);
        let lemke = solve_frictional(&problem, None, LcpMethod::Lemke).unwrap();
        let Some((solution, iterations)) = solved_by_blocks(&problem, &blocks, &mut random) else {
            prop_assert!(case.coupling > 0.05, "weakly coupled blocks do not converge");
            return Ok(());
        };
        prop_assert!(solution.residual <= 1e-9);
        if case.coupling == 0.0 {
            prop_assert!(iterations <= 2, "{iterations}");
        }
        if unique(&problem) {
            let scale = lemke.pn.amax();
            for (k, [pn, pt]) in solution.forces.iter().enumerate() {
                prop_assert!((pn - lemke.pn[k]).abs() <= 1e-7 * scale, "{pn} {}", lemke.pn[k]);
                prop_assert!((pt - lemke.pt[k]).abs() <= 1e-7 * scale, "{pt} {}", lemke.pt[k]);
            }
        }
    }
}

/// Without the acceleration, blocks that are coupled as strongly as their own contacts would diverge.
#[test]
fn most_strongly_coupled_blocks_are_solved() {
    let mut random = Random(3);
    let case = Case {
        sizes: vec![5; 6],
        coupling: 1.0,
        mu: 0.3,
        units: (0, 0),
        seed: 0,
    };
    let is_solved = |_: &usize| {
        let blocks = dealt(&mut random, &case.sizes);
        let problem = coupled(&mut random, &case, &blocks);
        solved_by_blocks(&problem, &blocks, &mut random).is_some()
    };
    let solved = (0..100).filter(is_solved).count();
    assert!(solved >= 90, "{solved}");
}
