//! Frictional problems with known answers, by both methods.

use crate::block::block_delassus;
use crate::problems::{drawn, duplicated, in_units, planted, states, without_self_stress};
use crate::random::Random;
use nalgebra::{DMatrix, DVector};
use stickslip::lcp::ContactState::{Open, SlipMinus, SlipPlus, Stick};
use stickslip::lcp::{
    FreeUnknowns, FrictionalLcp, FrictionalSolution, LcpError, LcpMethod, LemkeSettings, Method,
    covering_vector, lemke, residual, solve_frictional,
};

const METHODS: [LcpMethod; 2] = [LcpMethod::Lemke, LcpMethod::Hybrid];

/// The solution, its conditions checked here once more.
fn solve(problem: &FrictionalLcp, method: LcpMethod) -> FrictionalSolution {
    let s = solve_frictional(problem, None, method).unwrap();
    assert!(s.residual < 1e-9, "{:e}", s.residual);
    for i in 0..problem.len() {
        let limit = problem.mu[i] * s.pn[i];
        assert!(s.pn[i] >= 0.0 && s.pt[i].abs() <= limit);
        match s.state[i] {
            Open => assert_eq!((s.pn[i], s.pt[i]), (0.0, 0.0)),
            Stick => {}
            SlipPlus => assert_eq!(s.pt[i], -limit),
            SlipMinus => assert_eq!(s.pt[i], limit),
        }
    }
    s
}

fn solve_both(problem: &FrictionalLcp) {
    for method in METHODS {
        solve(problem, method);
    }
}

fn one(gap: f64, slip: f64, mu: f64) -> FrictionalLcp {
    FrictionalLcp {
        q: DMatrix::from_row_slice(2, 2, &[2.0, 0.0, 0.0, 1.0]),
        gap: DVector::from_element(1, gap),
        slip: DVector::from_element(1, slip),
        mu: DVector::from_element(1, mu),
        free: FreeUnknowns::default(),
    }
}

#[test]
fn one_contact_in_each_state() {
    let cases = [
        (one(0.5, 0.3, 0.5), Open, 0.0, 0.0, 0.3),
        (one(-1.0, 0.1, 0.5), Stick, 0.5, -0.1, 0.0),
        (one(-1.0, 0.75, 0.5), SlipPlus, 0.5, -0.25, 0.5),
        (one(-1.0, -0.75, 0.5), SlipMinus, 0.5, 0.25, -0.5),
        (one(-1.0, -0.75, 0.0), SlipMinus, 0.5, 0.0, -0.75),
    ];
    for (problem, state, pn, pt, slip) in cases {
        for method in METHODS {
            let s = solve(&problem, method);
            assert_eq!(
                (s.state[0], s.pn[0], s.pt[0], s.slip[0]),
                (state, pn, pt, slip)
            );
        }
    }
}

#[test]
fn nothing_to_do() {
    for method in METHODS {
        let empty = FrictionalLcp {
            q: DMatrix::zeros(0, 0),
            gap: DVector::zeros(0),
            slip: DVector::zeros(0),
            mu: DVector::zeros(0),
            free: FreeUnknowns::default(),
        };
        assert_eq!(solve(&empty, method).method, Method::Trivial);
        let flat = solve(&one(0.0, 0.0, 0.3), method);
        assert_eq!((flat.pn[0], flat.pt[0], flat.gap[0]), (0.0, 0.0, 0.0));
    }
}

/// All open, all sliding along: no force, whatever the slips.
#[test]
fn open_contacts_with_slip_are_trivial() {
    let mut random = Random(20);
    let mut problem = drawn(&mut random, block_delassus(64, 4, 1.0), 1.0);
    problem.gap.apply(|g| *g = g.abs());
    for method in METHODS {
        let s = solve(&problem, method);
        assert_eq!(
            (s.method, s.pn.amax(), &s.slip),
            (Method::Trivial, 0.0, &problem.slip)
        );
    }
}

/// Every state is planted with its forces; Q positive definite and mu moderate make them unique.
fn find_planted(n: usize, courant: f64, mus: &[f64], seed: u64) {
    let mut random = Random(seed);
    let q = block_delassus(n, 8, courant);
    for mu in mus {
        let truth = states(&mut random, n, 0.3, 0.4);
        let mu = DVector::from_element(n, *mu);
        let (problem, p) = planted(&mut random, q.clone(), mu, &truth);
        let warm: Vec<_> = truth
            .iter()
            .map(|s| if random.unit() < 0.03 { Stick } else { *s })
            .collect();
        let solutions = METHODS.map(|method| solve(&problem, method)).into_iter();
        let warm = solve_frictional(&problem, Some(&warm), LcpMethod::Hybrid).unwrap();
        for s in solutions.chain([warm]) {
            let error = (s.pn - p.rows(0, n))
                .amax()
                .max((s.pt - p.rows(n, n)).amax());
            assert!(
                error < 1e-9,
                "n {n} C {courant} mu {}: {error:e}",
                problem.mu[0]
            );
            let closed = (0..n).filter(|i| truth[*i].is_closed());
            let gaps = closed.fold(0.0_f64, |l, i| l.max(s.gap[i].abs()));
            assert!(
                gaps < 1e-13 * problem.gap.amax(),
                "gaps of closed contacts: {gaps:e}"
            );
        }
    }
}

#[test]
fn planted_states_of_small_blocks_are_found() {
    for (seed, n) in [4, 8, 16, 32, 64, 128, 256].into_iter().enumerate() {
        for courant in [0.3, 1.0, 10.0, 100.0] {
            find_planted(n, courant, &[0.0, 0.1, 0.3, 1.0], seed as u64);
        }
    }
}

#[test]
fn planted_states_of_a_large_block_are_found() {
    find_planted(1024, 1.0, &[0.3], 30);
    find_planted(512, 100.0, &[0.3], 31);
}

/// Random gaps and slips up to large mu, where solutions need not be unique.
#[test]
fn drawn_problems_on_blocks_are_solved() {
    let mut random = Random(21);
    for n in [4, 8, 16, 32, 64, 128] {
        for courant in [0.3, 1.0, 10.0, 100.0, 1000.0] {
            let q = block_delassus(n, 6, courant);
            for mu in [0.0, 0.1, 0.3, 0.7, 1.0, 2.0, 3.0] {
                let problem = drawn(&mut random, q.clone(), mu);
                solve_both(&problem);
            }
        }
    }
}

/// Two nodes at the same place: Q is singular, the forces are not unique, their sums are.
#[test]
fn duplicate_contacts_share_the_force() {
    let mut random = Random(22);
    for n in [2, 8, 32, 64] {
        for mu in [0.0, 0.1, 0.3] {
            let truth = states(&mut random, n, 0.3, 0.4);
            let mu = DVector::from_element(n, mu);
            let (single, p) = planted(&mut random, block_delassus(n, 6, 1.0), mu, &truth);
            let double = duplicated(&single);
            for method in METHODS {
                let s = solve(&double, method);
                let sum = |v: &DVector<f64>| v.rows(0, n) + v.rows(n, n);
                assert!((sum(&s.pn) - p.rows(0, n)).amax() < 1e-9);
                assert!((sum(&s.pt) - p.rows(n, n)).amax() < 1e-9);
            }
        }
    }
}

/// Duplicates with another friction coefficient, and with gaps that differ by round-off or more.
#[test]
fn unequal_duplicates_are_solved() {
    let mut random = Random(23);
    for case in 0..200 {
        let q = block_delassus(2 + case % 20, 4, [1.0, 100.0][case % 2]);
        let mut problem = duplicated(&drawn(&mut random, q, 0.5));
        let n = problem.len() / 2;
        for i in n..2 * n {
            problem.mu[i] = [0.5, 0.2, 1.0, 0.0][random.below(4)];
            problem.gap[i] *= 1.0 + [0.0, 1e-16, 1e-12, 0.1][random.below(4)];
            problem.slip[i] *= 1.0 + [0.0, 1e-16, 1e-12][random.below(3)];
        }
        solve_both(&problem);
    }
}

/// Flat surfaces: all gaps equal, or zero but for one penetration.
#[test]
fn degenerate_gaps_are_solved() {
    let mut random = Random(24);
    for case in 0..200 {
        let n = 2 + case % 24;
        let mut problem = drawn(
            &mut random,
            block_delassus(n, 4, [1.0, 100.0][case % 2]),
            0.3,
        );
        let size = problem.q[(0, 0)];
        problem.gap.fill(if case % 3 == 0 { -size } else { 0.0 });
        problem.gap[random.below(n)] = -size;
        if case % 4 < 2 {
            problem.slip.fill(f64::from(u8::from(case % 4 == 1)) * size);
        }
        solve_both(&problem);
    }
}

/// Lengths and forces in units from 1e-12 to 1e12: the same answer in these units.
#[test]
fn units_do_not_matter() {
    let mut random = Random(25);
    for case in 0..300 {
        let n = 2 + case % 20;
        let truth = states(&mut random, n, 0.3, 0.4);
        let q = block_delassus(n, 4, [1.0, 100.0][case % 2]);
        let (problem, p) = planted(&mut random, q, DVector::from_element(n, 0.3), &truth);
        let mut unit = || 10f64.powf(random.range(-12.0, 12.0));
        let (length, force) = (unit(), unit());
        let scaled = in_units(problem, [length, force]);
        for method in METHODS {
            let s = solve(&scaled, method);
            assert!((s.pn / force - p.rows(0, n)).amax() < 1e-9);
            assert!((s.pt / force - p.rows(n, n)).amax() < 1e-9);
        }
    }
}

/// Powers of two change no digit of anything.
#[test]
fn powers_of_two_are_exact() {
    let mut random = Random(26);
    for case in 0..100 {
        let q = block_delassus(2 + case % 20, 4, 10.0);
        let problem = drawn(&mut random, q, [0.0, 0.3, 2.0][case % 3]);
        for (length, force) in [
            (2f64.powi(31), 2f64.powi(-8)),
            (2f64.powi(-40), 2f64.powi(17)),
        ] {
            let scaled = in_units(problem.clone(), [length, force]);
            for method in METHODS {
                let (one, other) = (solve(&problem, method), solve(&scaled, method));
                assert_eq!((one.pn * force, one.pt * force), (other.pn, other.pt));
                assert_eq!(
                    (one.gap * length, one.slip * length),
                    (other.gap, other.slip)
                );
                assert_eq!(
                    (one.residual, one.counters),
                    (other.residual, other.counters)
                );
            }
        }
    }
}

/// Contacts of bodies whose compliances differ by eight orders of magnitude.
#[test]
fn unequal_bodies_are_solved() {
    let mut random = Random(27);
    for case in 0..300 {
        let n = 2 + case % 14;
        let mut problem = drawn(
            &mut random,
            block_delassus(n, 4, 1.0),
            [0.0, 0.3, 3.0][case % 3],
        );
        let w = DVector::from_fn(n, |_, _| 10f64.powf(random.range(-4.0, 4.0)));
        for i in 0..n {
            problem.gap[i] *= w[i];
            problem.slip[i] *= w[i];
        }
        problem.q = DMatrix::from_fn(2 * n, 2 * n, |i, j| problem.q[(i, j)] * w[i % n] * w[j % n]);
        solve_both(&problem);
    }
}

/// One contact just above and below mu^2 (Q^-1)nn Qtt = 4, where three solutions appear, and two
/// coupled ones far above: any solution will do.
#[test]
fn non_unique_problems_have_a_valid_solution() {
    let mut random = Random(28);
    for case in 0..2000 {
        let n = 1 + case % 2;
        let q = random.gram(2 * n, 2 * n, 0.001);
        let mu = [1.9, 2.1, 5.0, 20.0][case % 4];
        let problem = drawn(&mut random, q, mu);
        for method in METHODS {
            let s = solve(&problem, method);
            // The same solution satisfies the general form: z = (Pn, T+, Dt-).
            let t = 0.5 * (problem.mu.component_mul(&s.pn) + &s.pt);
            let z =
                s.pn.iter()
                    .chain(&t)
                    .copied()
                    .chain(s.slip.iter().map(|v| (-v).max(0.0)));
            let z = DVector::from_iterator(3 * n, z);
            assert!(residual(&problem.to_lcp(), &z) < 1e-9);
        }
    }
}

/// More rows than degrees of freedom, but no self-stress: no ray, whatever gaps and mu.
#[test]
fn no_ray_without_self_stress() {
    let mut random = Random(29);
    for case in 0..1000 {
        let (n, dofs) = (4 + case % 12, 3 + case % 5);
        let mu = [0.0, 0.3, 1.0, 3.0][case % 4];
        let q = without_self_stress(&mut random, n, dofs);
        solve_both(&drawn(&mut random, q, mu));
    }
}

/// With self-stress the constraints may conflict: a solution or a ray that names contacts.
#[test]
fn self_stress_ends_in_a_solution_or_a_ray() {
    let mut random = Random(30);
    let (mut solved, mut rays) = (0, 0);
    for case in 0..1000 {
        let (n, dofs) = (3 + case % 12, 2 + case % 4);
        let b = random.matrix(2 * n, dofs);
        let problem = drawn(&mut random, &b * b.transpose(), [0.1, 0.5, 2.0][case % 3]);
        for method in METHODS {
            match solve_frictional(&problem, None, method) {
                Ok(s) => {
                    assert!(s.residual < 1e-9);
                    solved += 1;
                }
                Err(LcpError::Ray { members, .. }) => {
                    assert!(!members.is_empty() && members.iter().all(|i| *i < n));
                    rays += 1;
                }
                Err(other) => panic!("case {case}: {other}"),
            }
        }
    }
    assert!(solved > 100 && rays > 100, "{solved} solved, {rays} rays");
}

/// A node wedged between two fixed walls that both reach into it: the walls conflict.
#[test]
fn a_ray_names_the_conflicting_contacts() {
    let b = DMatrix::from_row_slice(
        6,
        3,
        &[
            1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0, 0.0, // normals
            0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, // tangents
        ],
    );
    let problem = FrictionalLcp {
        q: &b * b.transpose(),
        gap: DVector::from_row_slice(&[-1.0, -1.0, -1.0]),
        slip: DVector::zeros(3),
        mu: DVector::from_element(3, 0.3),
        free: FreeUnknowns::default(),
    };
    for method in METHODS {
        match solve_frictional(&problem, None, method) {
            Err(LcpError::Ray { members, .. }) => assert_eq!(members, [0, 1]),
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn warm_states_are_only_a_guess() {
    let mut random = Random(31);
    for case in 0..200 {
        let n = 2 + case % 30;
        let problem = drawn(
            &mut random,
            block_delassus(n, 4, [1.0, 100.0][case % 2]),
            0.3,
        );
        let cold = solve(&problem, LcpMethod::Hybrid);
        let wrong = states(&mut random, n, 0.25, 0.25);
        let warm = solve_frictional(&problem, Some(&wrong), LcpMethod::Hybrid).unwrap();
        assert!((warm.pn - &cold.pn).amax() < 1e-9 * (1.0 + cold.pn.amax()));
        let again = solve_frictional(&problem, Some(&cold.state), LcpMethod::Hybrid).unwrap();
        assert_eq!(again.pn, cold.pn);
        assert!(again.counters.active_set_iterations <= 1);
    }
    let size = solve_frictional(&one(-1.0, 0.0, 0.0), Some(&[]), LcpMethod::Hybrid);
    assert!(matches!(
        size,
        Err(LcpError::Size {
            what: "warm states",
            ..
        })
    ));
}

/// Invalid data: an error or a checked answer, never a panic.
#[test]
fn extreme_numbers_never_panic() {
    let mut random = Random(32);
    let extremes = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        1e308,
        -1e308,
        5e-324,
        -1e-300,
        1e-16,
        f64::MAX,
    ];
    for case in 0..3000 {
        let n = 1 + case % 4;
        let mut draw = || extremes[random.below(extremes.len())];
        let mut problem = FrictionalLcp {
            q: DMatrix::from_fn(2 * n, 2 * n, |_, _| draw()),
            gap: DVector::from_fn(n, |_, _| draw()),
            slip: DVector::from_fn(n, |_, _| draw()),
            mu: DVector::from_fn(n, |_, _| draw().abs()),
            free: FreeUnknowns::default(),
        };
        if case % 2 == 0 {
            problem.q.fill_lower_triangle_with_upper_triangle();
        }
        if case % 50 == 0 {
            problem.q.fill(0.0);
        }
        for method in METHODS {
            if let Ok(s) = solve_frictional(&problem, None, method) {
                assert!(s.residual < 1e-9);
            }
        }
        let general = problem.to_lcp();
        if let Ok(s) = lemke(
            &general,
            &covering_vector(&general),
            &LemkeSettings::default(),
        ) {
            assert!(s.residual < 1e-9);
        }
    }
}

/// What penetrates so little that the force against it vanishes, or has lost digits, does not penetrate.
#[test]
fn penetrations_that_underflow_are_none() {
    for mu in [0.0, 0.3] {
        for (gap, slip) in [(-1.11794e-318, -1.6e-299), (-1e-305, 1.0), (-5e-324, 0.0)] {
            let problem = FrictionalLcp {
                q: DMatrix::from_row_slice(2, 2, &[44340.5, 0.0, 0.0, 44340.5]),
                ..one(gap, slip, mu)
            };
            for method in METHODS {
                let s = solve(&problem, method);
                assert_eq!((s.state[0], s.pn[0]), (Open, 0.0), "{gap:e}");
            }
            let lcp = problem.to_lcp();
            let solved = lemke(&lcp, &covering_vector(&lcp), &LemkeSettings::default());
            assert!(solved.unwrap().z.amax() < 1e-290);
        }
    }
    // a little more has its force
    let s = solve(&one(-1e-280, 0.0, 0.3), LcpMethod::Hybrid);
    assert!((s.pn[0] / 5e-281 - 1.0).abs() < 1e-12);
}
