//! Random frictional problems of many kinds: all must be solved.

use crate::block::block_delassus;
use crate::problems::{drawn, duplicated, in_units, states, unique, without_self_stress};
use crate::random::Random;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stickslip::lcp::{FrictionalLcp, LcpMethod, solve_frictional};

/// Kinds of Q.
#[derive(Debug, Clone, Copy)]
enum Kind {
    /// Full random matrix.
    Gram,
    /// Elastic block of that Courant number.
    Block(f64),
    /// Every contact of a block twice: singular.
    Twice(f64),
    /// B W B^T with few degrees of freedom, without self-stress: singular.
    FewDofs,
}

#[derive(Debug, Clone)]
struct Case {
    kind: Kind,
    n: usize,
    seed: u64,
    /// Up to this mu, per contact one of 0, half of it and all of it.
    mu: f64,
    /// Part of the gaps and slips that are zero.
    zeros: f64,
    /// Decimal exponents of the units of length and force.
    units: (i32, i32),
    /// Decimal exponent up to which gaps and slips differ in size.
    spread: f64,
}

fn cases() -> impl Strategy<Value = Case> {
    let courant = || prop::sample::select(vec![0.3, 1.0, 10.0, 100.0]);
    let kind = prop_oneof![
        Just(Kind::Gram),
        courant().prop_map(Kind::Block),
        courant().prop_map(Kind::Twice),
        Just(Kind::FewDofs),
    ];
    let mu = prop::sample::select(vec![0.0, 0.1, 0.3, 0.7, 1.0, 2.0, 3.0]);
    let zeros = prop::sample::select(vec![0.0, 0.0, 0.3, 0.9]);
    let spread = prop::sample::select(vec![0.0, 0.0, 3.0, 6.0]);
    (
        kind,
        2..20usize,
        any::<u64>(),
        mu,
        zeros,
        (-12..=12, -12..=12),
        spread,
    )
        .prop_map(|(kind, n, seed, mu, zeros, units, spread)| Case {
            kind,
            n,
            seed,
            mu,
            zeros,
            units,
            spread,
        })
}

fn matrix(random: &mut Random, kind: Kind, n: usize) -> DMatrix<f64> {
    match kind {
        Kind::Gram => random.gram(2 * n, 2 * n, 0.01),
        Kind::Block(courant) | Kind::Twice(courant) => block_delassus(n, 3, courant),
        Kind::FewDofs => without_self_stress(random, n, n.div_ceil(2) + 1),
    }
}

fn problem(case: &Case, random: &mut Random) -> FrictionalLcp {
    let q = matrix(random, case.kind, case.n);
    let mut problem = drawn(random, q, case.mu);
    let mut vary = |value: &mut f64| {
        let size = 10f64.powf(random.range(-case.spread, case.spread));
        *value *= if random.unit() < case.zeros {
            0.0
        } else {
            size
        };
    };
    problem.gap.apply(&mut vary);
    problem.slip.apply(&mut vary);
    problem
        .mu
        .apply(|mu| *mu *= [0.0, 0.5, 1.0, 1.0][random.below(4)]);
    if matches!(case.kind, Kind::Twice(_)) {
        problem = duplicated(&problem);
    }
    let units = [case.units.0, case.units.1].map(|exponent| 10f64.powi(exponent));
    in_units(problem, units)
}

fn close(a: &DVector<f64>, b: &DVector<f64>, scale: f64) -> bool {
    (a - b).amax() <= 1e-6 * scale
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 40_000,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn every_frictional_problem_is_solved(case in cases()) {
        let mut random = Random(case.seed);
        let problem = problem(&case, &mut random);
        let lemke = solve_frictional(&problem, None, LcpMethod::Lemke).unwrap();
        let cold = solve_frictional(&problem, None, LcpMethod::Hybrid).unwrap();
        let guess = states(&mut random, problem.len(), 0.3, 0.4);
        let warm = solve_frictional(&problem, Some(&guess), LcpMethod::Hybrid).unwrap();
        for solution in [&lemke, &cold, &warm] {
            prop_assert!(solution.residual < 1e-9);
        }
        if unique(&problem) {
            let scale = lemke.pn.amax();
            for other in [&cold, &warm] {
                prop_assert!(close(&other.pn, &lemke.pn, scale));
                prop_assert!(close(&other.pt, &lemke.pt, scale));
            }
        }
    }
}
