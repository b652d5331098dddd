//! Frictional problems with known answers, by both methods.

mod lcp_support;

use lcp_support::block::block_delassus;
use lcp_support::problems::{drawn, planted, states};
use lcp_support::random::Random;
use nalgebra::{DMatrix, DVector};
use stickslip::lcp::{
    ContactState, FrictionalLcp, FrictionalSolution, LcpMethod, Method, solve_frictional,
};

const METHODS: [LcpMethod; 2] = [LcpMethod::Lemke, LcpMethod::Hybrid];

fn solve(problem: &FrictionalLcp, method: LcpMethod) -> FrictionalSolution {
    let solution = solve_frictional(problem, None, method).unwrap();
    assert!(solution.residual < 1e-9);
    solution
}

fn one(gap: f64, slip: f64, mu: f64) -> FrictionalLcp {
    FrictionalLcp {
        q: DMatrix::from_row_slice(2, 2, &[2.0, 0.0, 0.0, 1.0]),
        gap: DVector::from_element(1, gap),
        slip: DVector::from_element(1, slip),
        mu: DVector::from_element(1, mu),
    }
}

#[test]
fn one_contact_in_each_state() {
    use ContactState::{Open, SlipMinus, SlipPlus, Stick};
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
        };
        assert_eq!(solve(&empty, method).method, Method::Trivial);
        let flat = solve(&one(0.0, 0.0, 0.3), method);
        assert_eq!((flat.pn[0], flat.pt[0], flat.gap[0]), (0.0, 0.0, 0.0));
    }
}

#[test]
fn planted_states_are_found() {
    let mut random = Random(1);
    for n in [2, 4, 16, 64] {
        for courant in [1.0, 100.0] {
            let q = block_delassus(n, 8, courant);
            for mu in [0.0, 0.3, 1.0] {
                let truth = states(&mut random, n, 0.3, 0.4);
                let (problem, p) =
                    planted(&mut random, q.clone(), DVector::from_element(n, mu), &truth);
                for method in METHODS {
                    let s = solve(&problem, method);
                    let error = (s.pn - p.rows(0, n))
                        .amax()
                        .max((s.pt - p.rows(n, n)).amax());
                    assert!(error < 1e-9, "n {n} C {courant} mu {mu}: {error:e}");
                }
            }
        }
    }
}

#[test]
fn drawn_problems_are_solved() {
    let mut random = Random(2);
    for case in 0..200 {
        let n = [4, 8, 16, 32][case % 4];
        let q = block_delassus(n, 4, [0.5, 1.0, 10.0, 100.0][case % 3]);
        let problem = drawn(&mut random, q, [0.1, 0.3, 1.0, 3.0][case / 4 % 4]);
        for method in METHODS {
            solve(&problem, method);
        }
    }
}
