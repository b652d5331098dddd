//! Families of general problems with known answers.

use crate::random::Random;
use nalgebra::{DMatrix, DVector};
use stickslip::lcp::{Lcp, LcpError, LcpSolution, LemkeSettings, covering_vector, lemke, residual};

fn solve(m: DMatrix<f64>, q: DVector<f64>) -> Result<LcpSolution, LcpError> {
    let lcp = Lcp { m, q };
    let d = covering_vector(&lcp);
    cover(&lcp, &d)
}

fn cover(lcp: &Lcp, d: &DVector<f64>) -> Result<LcpSolution, LcpError> {
    let settings = LemkeSettings {
        max_pivots: Some(20_000),
        ..LemkeSettings::default()
    };
    let solution = lemke(lcp, d, &settings)?;
    assert_eq!(solution.residual, residual(lcp, &solution.z));
    assert!(solution.residual < 1e-9);
    Ok(solution)
}

/// Lower triangular, 1 on the diagonal, 2 below.
fn murty(n: usize) -> DMatrix<f64> {
    DMatrix::from_fn(n, n, |i, j| f64::from(u8::from(i >= j) + u8::from(i > j)))
}

/// K. G. Murty, "Computational complexity of complementary pivot methods" (1978): 2^n pivots.
#[test]
fn murty_takes_all_vertices() {
    for n in 1..=12 {
        // q_i = -(2^n + ... + 2^(n+1-i))
        let q = DVector::from_fn(n, |i, _| {
            -(0..=i).map(|k| 2f64.powi((n - k) as i32)).sum::<f64>()
        });
        let solution = cover(&Lcp { m: murty(n), q }, &DVector::from_element(n, 1.0)).unwrap();
        assert_eq!(solution.pivots, 1 << n, "n = {n}");
        let mut z = DVector::zeros(n);
        z[0] = 2f64.powi(n as i32);
        assert_eq!(solution.z, z);
    }
}

/// Y. Fathi, "Computational complexity of LCPs associated with positive definite symmetric
/// matrices" (1979): M = L L^T with Murty's L, q = -1, solution (1, 0, ..., 0).
#[test]
fn fathi_is_solved() {
    for n in 1..=12 {
        let l = murty(n);
        let solution = solve(&l * l.transpose(), DVector::from_element(n, -1.0)).unwrap();
        let mut z = DVector::zeros(n);
        z[0] = 1.0;
        assert!((solution.z - z).amax() < 1e-12, "n = {n}");
    }
}

/// A problem whose solution (z, w) is drawn first; `degenerate` of the pairs are zero in both.
fn plant(random: &mut Random, m: &DMatrix<f64>, degenerate: f64) -> (DVector<f64>, DVector<f64>) {
    let n = m.nrows();
    let (mut z, mut w) = (DVector::zeros(n), DVector::zeros(n));
    for i in 0..n {
        let value = random.range(0.1, 1.0);
        if random.unit() < degenerate {
            continue;
        }
        if random.unit() < 0.5 {
            z[i] = value
        } else {
            w[i] = value
        }
    }
    let q = w - m * &z;
    (z, q)
}

/// P-matrices that are not positive definite: A^-1 B with A and B strictly diagonally dominant
/// by columns with positive diagonals.
#[test]
fn p_matrices_have_the_planted_solution() {
    let mut random = Random(10);
    for case in 0..300 {
        let n = 2 + case % 30;
        let mut dominant = || {
            let a = random.matrix(n, n);
            let sums = DVector::from_fn(n, |i, _| a.column(i).abs().sum() + 0.1);
            a + DMatrix::from_diagonal(&sums)
        };
        let m = dominant().try_inverse().unwrap() * dominant();
        let (z, q) = plant(&mut random, &m, 0.2);
        assert!((solve(m, q).unwrap().z - z).amax() < 1e-9);
    }
}

/// Positive semidefinite, not symmetric, of low rank, with many pairs zero in both.
#[test]
fn semidefinite_degenerate_problems_are_solved() {
    let mut random = Random(11);
    for case in 0..300 {
        let n = 2 + case % 40;
        let skew = random.matrix(n, n) * f64::from(u8::from(case % 2 == 0));
        let m = random.gram(n, n.div_ceil(3), 0.0) + &skew - skew.transpose();
        let (_, q) = plant(&mut random, &m, 0.5);
        solve(m, q).unwrap();
    }
}

/// Copositive plus: a matrix of positive entries plus a semidefinite one. Solvable for every q.
#[test]
fn copositive_plus_problems_are_solved() {
    let mut random = Random(12);
    for case in 0..300 {
        let n = 2 + case % 30;
        let positive = DMatrix::from_fn(n, n, |_, _| random.range(0.01, 1.0));
        let m = positive + random.gram(n, n.div_ceil(4), 0.0);
        let q = random.vector(n, -1.0, 0.3);
        solve(m, q).unwrap();
    }
}

/// M semidefinite with v^T M = 0, v >= 0 and v.q < 0: no z >= 0 has w >= 0.
#[test]
fn unsolvable_problems_end_on_a_ray() {
    let mut random = Random(13);
    for case in 0..300 {
        let n = 3 + case % 20;
        let v = random.vector(n, 0.1, 1.0);
        let project = DMatrix::identity(n, n) - &v * v.transpose() / v.norm_squared();
        let m = &project * random.gram(n, n, 0.1) * &project;
        let mut q = random.vector(n, -1.0, 1.0);
        q -= &v * ((q.dot(&v) + random.range(0.1, 1.0)) / v.norm_squared());
        let answer = solve(m, q);
        assert!(
            matches!(answer, Err(LcpError::Ray { .. })),
            "case {case}: {answer:?}"
        );
    }
    let nothing_helps = solve(DMatrix::zeros(1, 1), DVector::from_element(1, -1.0));
    assert!(matches!(nothing_helps, Err(LcpError::Ray { .. })));
}

/// Linear programs min c.x, A x >= b, x >= 0 as LCP [0 -A^T; A 0], (c, -b).
fn linear_program(a: &DMatrix<f64>, b: &[f64], c: &[f64]) -> DVector<f64> {
    let (rows, columns) = a.shape();
    let mut m = DMatrix::zeros(rows + columns, rows + columns);
    m.view_mut((0, columns), (columns, rows))
        .copy_from(&-a.transpose());
    m.view_mut((columns, 0), (rows, columns)).copy_from(a);
    let q = c.iter().copied().chain(b.iter().map(|b| -b));
    let q = DVector::from_iterator(rows + columns, q);
    solve(m, q).unwrap().z.rows(0, columns).into_owned()
}

/// Beale (1955): the simplex method with the usual rule cycles; minimum -1/20.
#[test]
fn beale_does_not_cycle() {
    let c = [-0.75, 150.0, -0.02, 6.0];
    let a = DMatrix::from_row_slice(
        3,
        4,
        &[
            -0.25, 60.0, 0.04, -9.0, -0.5, 90.0, 0.02, -3.0, 0.0, 0.0, -1.0, 0.0,
        ],
    );
    let x = linear_program(&a, &[0.0, 0.0, -1.0], &c);
    assert!((x.dot(&DVector::from_row_slice(&c)) + 0.05).abs() < 1e-12);
}

/// Marshall and Suurballe (1969): cycles in six steps; minimum -1.
#[test]
fn marshall_and_suurballe_do_not_cycle() {
    let c = [-10.0, 57.0, 9.0, 24.0];
    let a = DMatrix::from_row_slice(
        3,
        4,
        &[
            -0.5, 5.5, 2.5, -9.0, -0.5, 1.5, 0.5, -1.0, -1.0, 0.0, 0.0, 0.0,
        ],
    );
    let x = linear_program(&a, &[0.0, 0.0, -1.0], &c);
    assert!((x.dot(&DVector::from_row_slice(&c)) + 1.0).abs() < 1e-12);
}

/// M. M. Kostreva, "Cycling in linear complementarity problems" (1979): cycles with Bard's rule.
#[test]
fn kostreva_does_not_cycle() {
    let m = DMatrix::from_row_slice(3, 3, &[1.0, 2.0, 0.0, 0.0, 1.0, 2.0, 2.0, 0.0, 1.0]);
    let z = solve(m, DVector::from_element(3, -1.0)).unwrap().z;
    assert!((z - DVector::from_element(3, 1.0 / 3.0)).amax() < 1e-15);
}

/// Rows and columns scaled over 24 orders of magnitude change z and w by these scales only.
#[test]
fn scales_do_not_matter() {
    let mut random = Random(14);
    for case in 0..300 {
        let n = 2 + case % 20;
        let skew = random.matrix(n, n);
        let m = random.gram(n, n, 0.1) + &skew - skew.transpose();
        let (z, q) = plant(&mut random, &m, 0.2);
        let mut scales = || DVector::from_fn(n, |_, _| 10f64.powf(random.range(-12.0, 12.0)));
        let (rows, columns) = (scales(), scales());
        let unit = 10f64.powi(case as i32 % 25 - 12);
        let scaled = DMatrix::from_diagonal(&rows) * m * DMatrix::from_diagonal(&columns);
        let solution = solve(scaled, rows.component_mul(&q) * unit).unwrap();
        let error = solution.z.component_mul(&columns) / unit - z;
        assert!(error.amax() < 1e-9, "case {case}: {:e}", error.amax());
    }
}

/// Powers of two change no digit.
#[test]
fn powers_of_two_are_exact() {
    let mut random = Random(15);
    for _ in 0..50 {
        let m = random.gram(12, 12, 0.1) + random.matrix(12, 12);
        let q = random.vector(12, -1.0, 0.5);
        let (a, b) = (2f64.powi(37), 2f64.powi(-29));
        match (solve(m.clone(), q.clone()), solve(m * a, q * b)) {
            (Ok(one), Ok(other)) => {
                assert_eq!(one.z * (b / a), other.z);
                assert_eq!((one.w * b, one.pivots), (other.w, other.pivots));
                assert_eq!(one.residual, other.residual);
            }
            (one, other) => assert_eq!(one.is_ok(), other.is_ok()),
        }
    }
}

#[test]
fn wrong_input_is_an_error() {
    let identity = || Lcp {
        m: DMatrix::identity(2, 2),
        q: DVector::from_element(2, -1.0),
    };
    let settings = LemkeSettings::default();
    let d = |values: &[f64]| DVector::from_row_slice(values);
    let fails = |lcp: &Lcp, d: &DVector<f64>| lemke(lcp, d, &settings).unwrap_err();
    assert!(matches!(
        fails(&identity(), &d(&[1.0])),
        LcpError::Size { .. }
    ));
    assert!(matches!(
        fails(&identity(), &d(&[1.0, -1.0])),
        LcpError::Range { index: 1, .. }
    ));
    assert!(matches!(
        fails(&identity(), &d(&[0.0, 1.0])),
        LcpError::Range { index: 0, .. }
    ));
    assert_eq!(
        fails(&identity(), &d(&[1.0, f64::NAN])),
        LcpError::NotFinite
    );
    let mut lcp = identity();
    lcp.m[(0, 1)] = f64::NEG_INFINITY;
    assert_eq!(fails(&lcp, &d(&[1.0, 1.0])), LcpError::NotFinite);
    let few = LemkeSettings {
        max_pivots: Some(1),
        ..settings.clone()
    };
    let limit = lemke(&identity(), &d(&[1.0, 0.5]), &few);
    assert!(
        matches!(limit, Err(LcpError::PivotLimit { .. })),
        "{limit:?}"
    );
}
