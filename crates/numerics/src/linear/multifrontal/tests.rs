//! Tests of the multifrontal solver against a dense solution: random patterns, singular and indefinite matrices, parts
//! of the inverse, and several threads.

use nalgebra::DVector;
use proptest::prelude::*;
use sprs::TriMat;

use super::MultifrontalLdl;
use crate::linear::{LinearError, LinearSolver, Pattern, SymmetricMatrix};

/// An edge between two unknowns with its stiffness.
type Edge = (usize, usize, f64);

/// The matrix sum w (e_i - e_j)(e_i - e_j)^T + diag, with both triangles.
fn matrix(edges: &[Edge], diagonal: &[f64]) -> SymmetricMatrix {
    let mut entries = TriMat::new((diagonal.len(), diagonal.len()));
    for (i, &d) in diagonal.iter().enumerate() {
        entries.add_triplet(i, i, d);
    }
    for &(i, j, w) in edges.iter().filter(|(i, j, _)| i != j) {
        entries.add_triplet(i, i, w);
        entries.add_triplet(j, j, w);
        entries.add_triplet(i, j, -w);
        entries.add_triplet(j, i, -w);
    }
    let (starts, rows, values) = entries.to_csc::<usize>().into_raw_storage();
    let indices = |all: Vec<usize>| all.into_iter().map(|index| index as u32).collect();
    SymmetricMatrix {
        pattern: Pattern::new(indices(starts), indices(rows)),
        values,
    }
}

/// Reproducible numbers between -1 and 1.
fn numbers(n: usize, seed: usize) -> Vec<f64> {
    (0..n).map(|i| ((i * 37 + seed) as f64).sin()).collect()
}

fn solved(solver: &mut MultifrontalLdl, b: &[f64]) -> DVector<f64> {
    let mut x = b.to_vec();
    solver.solve(&mut x);
    x.into()
}

/// Positive definite matrices with various patterns: without edges, with several components, and dense.
fn positive_definite() -> impl Strategy<Value = SymmetricMatrix> {
    (1..70_usize, 0..4_usize).prop_flat_map(|(n, per_unknown)| {
        let edge = (0..n, 0..n, 0.01..100.0);
        let edges = prop::collection::vec(edge, n * per_unknown);
        let diagonal = prop::collection::vec(0.1..10.0, n);
        (edges, diagonal).prop_map(|(edges, diagonal)| matrix(&edges, &diagonal))
    })
}

proptest! {
    #[test]
    fn solutions_are_those_of_a_dense_matrix(a in positive_definite(), seed in 0..1000_usize) {
        let (n, mut solver) = (a.size(), MultifrontalLdl::default());
        solver.factorize(&a).unwrap();
        let b = numbers(n, seed);
        let x = solved(&mut solver, &b);
        let cholesky = a.to_dense().cholesky().expect("a positive definite matrix");
        let exact = cholesky.solve(&DVector::from(b));
        prop_assert!((&x - &exact).norm() <= 1e-10 * exact.norm());
    }

    #[test]
    fn the_partial_inverse_is_that_of_a_dense_matrix(
        a in positive_definite(),
        picked in prop::collection::vec(0..1000_usize, 1..12),
    ) {
        let (n, mut solver) = (a.size(), MultifrontalLdl::default());
        solver.factorize(&a).unwrap();
        let mut list: Vec<usize> = picked.iter().map(|k| k % n).collect();
        list.sort_unstable();
        list.dedup();
        let reversed: Vec<usize> = list.iter().rev().copied().collect();
        let exact = a.to_dense().cholesky().expect("a positive definite matrix").inverse();
        for (list, found) in [&list, &reversed].into_iter().zip(solver.inverse_at(&[&list, &reversed], n)) {
            for (column, values) in list.iter().zip(found.chunks_exact(list.len())) {
                for (row, value) in list.iter().zip(values) {
                    let scale = exact[(*row, *row)].max(exact[(*column, *column)]);
                    prop_assert!((value - exact[(*row, *column)]).abs() <= 1e-10 * scale);
                }
            }
        }
    }

    #[test]
    fn a_solve_in_parts_is_the_solve_of_the_sum(
        a in positive_definite(),
        picked in prop::collection::vec(0..1000_usize, 1..6),
    ) {
        let (n, mut solver) = (a.size(), MultifrontalLdl::default());
        solver.factorize(&a).unwrap();
        let mut watched: Vec<usize> = picked.iter().map(|k| k % n).collect();
        watched.sort_unstable();
        watched.dedup();
        let (mut b, mut values, mut x) = (numbers(n, 3), Vec::new(), vec![0.0; n]);
        let before = solved(&mut solver, &b);
        solver.watch(&watched);
        solver.begin(&b);
        solver.watched(&mut values);
        for (&unknown, value) in watched.iter().zip(&values) {
            prop_assert!((value - before[unknown]).abs() <= 1e-12 * before.amax());
        }
        let added: Vec<(usize, f64)> = watched.iter().map(|&u| (u, 0.5 + u as f64)).collect();
        solver.add(&added);
        solver.end(&mut x);
        added.iter().for_each(|&(unknown, value)| b[unknown] += value);
        let exact = a.to_dense().cholesky().expect("a positive definite matrix").solve(&DVector::from(b));
        prop_assert!((DVector::from(x) - &exact).norm() <= 1e-10 * exact.norm());
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_is_told_and_the_next_one_solved(
        a in positive_definite(),
        at in 0..1000_usize,
        push in 1.0..10.0,
    ) {
        let (n, mut solver) = (a.size(), MultifrontalLdl::default());
        // a - (1 + push) (least that makes it singular) e e^T
        let inverse = a.to_dense().cholesky().expect("a positive definite matrix").inverse();
        let unknown = at % n;
        let mut indefinite = a.clone();
        let entry = indefinite.pattern.position(unknown, unknown);
        indefinite.values[entry] -= (1.0 + push) / inverse[(unknown, unknown)];
        let found = solver.factorize(&indefinite);
        let is_told = matches!(found, Err(LinearError::NotPositiveDefinite { pivot, .. }) if pivot <= 0.0);
        prop_assert!(is_told, "{found:?}");
        solver.factorize(&a).unwrap();
        let x = solved(&mut solver, &numbers(n, 1));
        prop_assert!((&inverse * DVector::from(numbers(n, 1)) - &x).norm() <= 1e-10 * x.norm());
    }
}

#[test]
fn singular_matrices_are_told_where_their_pivot_is_exact() {
    // springs of stiffness 1 that hang free: all operations are exact
    for n in [1, 2, 5, 40] {
        let edges: Vec<Edge> = (1..n).map(|i| (i - 1, i, 1.0)).collect();
        let found = MultifrontalLdl::default().factorize(&matrix(&edges, &vec![0.0; n]));
        assert!(
            matches!(found, Err(LinearError::NotPositiveDefinite { pivot, .. }) if pivot == 0.0)
        );
    }
    let nan = matrix(&[(0, 1, f64::NAN)], &[1.0; 3]);
    let found = MultifrontalLdl::default().factorize(&nan);
    assert!(matches!(found, Err(LinearError::NotPositiveDefinite { pivot, .. }) if pivot.is_nan()));
}

/// A grid of n x n unknowns with springs of different stiffness, some of which connect distant unknowns.
fn grid(n: usize) -> SymmetricMatrix {
    let springs = numbers(3 * n * n, 5);
    let mut edges = Vec::new();
    for k in 0..n * n {
        let (right, up) = (
            (k % n + 1 < n).then_some(k + 1),
            (k + n < n * n).then_some(k + n),
        );
        let far = (k % (20 * n) == 0).then_some((k * 7 + n) % (n * n));
        let ends = [right, up, far].into_iter().enumerate();
        edges.extend(ends.filter_map(|(i, end)| Some((k, end?, 1.5 + springs[3 * k + i]))));
    }
    matrix(&edges, &vec![0.01; n * n])
}

#[test]
fn any_number_of_threads_gives_the_same_factors_and_inverses() {
    // large enough for branches of the elimination forest side by side
    let a = grid(150);
    let n = a.size();
    let lists: Vec<Vec<usize>> = (0..6)
        .map(|i| (0..9).map(|k| (i * 3001 + k * 151) % n).collect())
        .collect();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(|| {
            let mut solver = MultifrontalLdl::default();
            solver.factorize(&a).unwrap();
            let x = solved(&mut solver, &numbers(n, 2));
            let lists: Vec<&[usize]> = lists.iter().map(Vec::as_slice).collect();
            (x, solver.inverse_at(&lists, n))
        })
    };
    let (x, inverses) = run(1);
    assert!(
        [2, 3]
            .map(run)
            .iter()
            .all(|other| other.0 == x && other.1 == inverses)
    );
    // the residual, and columns of the inverse as solutions of unit right-hand sides
    let mut product = DVector::zeros(n);
    for k in 0..n {
        a.column(k)
            .for_each(|(row, value)| product[row] += value * x[k]);
    }
    assert!((product - DVector::from(numbers(n, 2))).amax() < 1e-11 * x.amax());
    let mut solver = MultifrontalLdl::default();
    solver.factorize(&a).unwrap();
    for (list, inverse) in lists.iter().zip(&inverses) {
        let mut unit = vec![0.0; n];
        unit[list[0]] = 1.0;
        let column = solved(&mut solver, &unit);
        for (row, value) in list.iter().zip(inverse) {
            assert!((column[*row] - value).abs() < 1e-11 * column.amax());
        }
    }
}

#[test]
fn one_of_two_solvers_takes_the_analysis_of_the_other() {
    for n in [12, 13] {
        let [mut first, mut second] = MultifrontalLdl::two();
        let (a, mut twice) = (grid(12), grid(n));
        twice.values.iter_mut().for_each(|value| *value *= 2.0);
        second.factorize(&a).unwrap();
        let x = solved(&mut second, &numbers(a.size(), 4));
        second.give_up_factors();
        first.factorize(&twice).unwrap();
        second.factorize(&a).unwrap();
        assert_eq!(x, solved(&mut second, &numbers(a.size(), 4)));
        if n == 12 {
            assert_eq!(x, solved(&mut first, &numbers(a.size(), 4)) * 2.0);
        }
    }
}
