//! Frictional problems built from a matrix Q.

use nalgebra::{DMatrix, DVector};
use stickslip::lcp::{ContactState, FreeUnknowns, FrictionalLcp};

use super::random::Random;

/// States drawn with the given probabilities of open and stick; the rest slides either way.
pub fn states(random: &mut Random, n: usize, open: f64, stick: f64) -> Vec<ContactState> {
    (0..n)
        .map(|_| {
            let u = random.unit();
            if u < open {
                ContactState::Open
            } else if u < open + stick {
                ContactState::Stick
            } else if random.unit() < 0.5 {
                ContactState::SlipPlus
            } else {
                ContactState::SlipMinus
            }
        })
        .collect()
}

/// A problem one solution of which has the given states, with its forces.
pub fn planted(
    random: &mut Random,
    q: DMatrix<f64>,
    mu: DVector<f64>,
    states: &[ContactState],
) -> (FrictionalLcp, DVector<f64>) {
    let n = states.len();
    let (mut p, mut motion) = (DVector::zeros(2 * n), DVector::zeros(2 * n));
    for (i, state) in states.iter().enumerate() {
        let (force, way) = (random.range(0.1, 1.0), random.range(0.1, 1.0));
        match state {
            ContactState::Open => {
                motion[i] = way;
                motion[n + i] = random.range(-1.0, 1.0);
            }
            ContactState::Stick => {
                p[i] = force;
                p[n + i] = mu[i] * force * random.range(-0.9, 0.9);
            }
            sliding => {
                p[i] = force;
                p[n + i] = -sliding.slip_sign() * mu[i] * force;
                motion[n + i] = sliding.slip_sign() * way;
            }
        }
    }
    let free = motion - &q * &p;
    let (gap, slip) = (free.rows(0, n).into_owned(), free.rows(n, n).into_owned());
    (
        FrictionalLcp {
            q,
            gap,
            slip,
            mu,
            free: FreeUnknowns::default(),
        },
        p,
    )
}

/// A random Q = B W B^T of few degrees of freedom. The first of these sees the sum of all Pn and no Pt, which excludes
/// self-stress.
pub fn without_self_stress(random: &mut Random, n: usize, dofs: usize) -> DMatrix<f64> {
    let mut b = random.matrix(2 * n, dofs);
    for i in 0..n {
        b[(i, 0)] = 1.0;
        b[(n + i, 0)] = 0.0;
    }
    let q = &b * random.gram(dofs, dofs, 0.1) * b.transpose();
    0.5 * (&q + q.transpose())
}

/// A problem in units of length and force of these sizes.
pub fn in_units(mut problem: FrictionalLcp, [length, force]: [f64; 2]) -> FrictionalLcp {
    problem.q *= length / force;
    problem.gap *= length;
    problem.slip *= length;
    problem
}

/// A problem with random gaps and slips.
pub fn drawn(random: &mut Random, q: DMatrix<f64>, mu: f64) -> FrictionalLcp {
    let n = q.nrows() / 2;
    let size = q.amax();
    FrictionalLcp {
        gap: random.vector(n, -1.0, 0.5) * size,
        slip: random.vector(n, -1.0, 1.0) * size,
        mu: DVector::from_element(n, mu),
        q,
        free: FreeUnknowns::default(),
    }
}

/// The problem with every contact twice.
pub fn duplicated(problem: &FrictionalLcp) -> FrictionalLcp {
    let n = problem.len();
    let twice = |v: &DVector<f64>| DVector::from_iterator(2 * n, v.iter().chain(v).copied());
    let of = |k: usize| if k < 2 * n { k % n } else { n + k % n };
    FrictionalLcp {
        q: DMatrix::from_fn(4 * n, 4 * n, |i, j| problem.q[(of(i), of(j))]),
        gap: twice(&problem.gap),
        slip: twice(&problem.slip),
        mu: twice(&problem.mu),
        free: FreeUnknowns::default(),
    }
}

/// mu^2 lmax((Q^-1)nn) lmax(Qtt) < 4: the forces are unique (with a margin for round-off).
pub fn unique(problem: &FrictionalLcp) -> bool {
    let n = problem.len();
    let Some(inverse) = problem.q.clone().cholesky().map(|c| c.inverse()) else {
        return false;
    };
    let largest = |m: DMatrix<f64>| m.symmetric_eigenvalues().max();
    let normal = largest(inverse.view((0, 0), (n, n)).into_owned());
    let tangential = largest(problem.q.view((n, n), (n, n)).into_owned());
    problem.mu.amax().powi(2) * normal * tangential < 3.9
}
