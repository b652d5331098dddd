//! Problems whose matrix has half the rank of its pairs, as over-determined contact has them: all must be solved.

use crate::block::block_delassus;
use crate::problems::{drawn, duplicated, planted, states};
use crate::random::Random;
use nalgebra::{DMatrix, DVector};
use stickslip::lcp::{ContactState, FrictionalLcp, LcpMethod, solve_frictional};

/// Largest residual of problems whose rows agree.
const ROUND_OFF: f64 = 1e-12;
/// The same where rows contradict each other: pairs that contradict by less than their forces times the shift of a
/// singular matrix, 1e-10 of its diagonal, are both closed.
const CONTRADICTION: f64 = 1e-9;

/// Solves a problem by both methods, without states and from wrong ones.
fn solve(problem: &FrictionalLcp, guess: &[ContactState], largest: f64) {
    let hybrid = LcpMethod::Hybrid;
    for (warm, method) in [
        (None, hybrid),
        (Some(guess), hybrid),
        (None, LcpMethod::Lemke),
    ] {
        let solution = solve_frictional(problem, warm, method).unwrap();
        let (n, mu, residual) = (problem.len(), problem.mu[0], solution.residual);
        assert!(
            residual <= largest,
            "{method:?}, {n} pairs, mu {mu}: {residual:e}"
        );
    }
}

/// Number of pairs, mu and wrong states of a case.
fn case(number: usize, random: &mut Random) -> (usize, f64, Vec<ContactState>) {
    let n = 4 + 2 * (number % 49);
    (n, random.range(0.0, 3.0), states(random, n, 0.3, 0.4))
}

/// The first degree of freedom sees the sum of all Pn and no Pt: no forces balance each other.
#[test]
fn without_self_stress() {
    let mut random = Random(91);
    for number in 0..400 {
        let (n, mu, guess) = case(number, &mut random);
        let mut b = random.matrix(2 * n, n);
        for i in 0..n {
            (b[(i, 0)], b[(n + i, 0)]) = (1.0, 0.0);
        }
        let q = &b * random.gram(n, n, 0.1) * b.transpose();
        let problem = drawn(&mut random, 0.5 * (&q + q.transpose()), mu);
        solve(&problem, &guess, ROUND_OFF);
    }
}

/// Every pair of an elastic block twice, with the same gaps and with gaps that differ a little, as those of an unfinished
/// pass do.
#[test]
fn every_pair_twice() {
    let mut random = Random(92);
    for number in 0..400 {
        let (n, mu, guess) = case(number, &mut random);
        let q: DMatrix<f64> = block_delassus(n / 2, 3, [1.0, 10.0, 100.0][number % 3]);
        let mut problem = duplicated(&drawn(&mut random, q, mu));
        solve(&problem, &guess, ROUND_OFF);
        let differ = 1e-8 * problem.q.amax();
        for free in [&mut problem.gap, &mut problem.slip] {
            free.apply(|value| *value += differ * random.range(-1.0, 1.0));
        }
        solve(&problem, &guess, CONTRADICTION);
    }
}

/// Forces may balance each other, which wedges bodies; a solution is known to exist.
#[test]
fn with_self_stress() {
    let mut random = Random(93);
    for number in 0..200 {
        let (n, mu, guess) = case(number, &mut random);
        let (b, mu) = (random.matrix(2 * n, n), DVector::from_element(n, 0.2 * mu));
        let solved = states(&mut random, n, 0.3, 0.4);
        let (problem, _) = planted(&mut random, &b * b.transpose(), mu, &solved);
        solve(&problem, &guess, ROUND_OFF);
    }
}
