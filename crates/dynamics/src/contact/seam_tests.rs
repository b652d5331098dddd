//! Tests with a made-up kind of constraint next to a node at a segment: it has 14 dofs, and
//! derivative rows that differ from its force rows.

use nalgebra::{DMatrix, DVector};

use super::compliance::{Compliance, ConstraintGroup};
use super::constraint::{Constraint, Rows};
use super::delassus::{DelassusSpace, frictional_lcp};
use super::testing;
use crate::linear::{Assembled, CheckedSolver, Transformation, linear_solver};
use crate::model::SolverChoice;

/// Number of dofs of the made-up constraint.
const DOFS: usize = 14;

/// Normal and tangential row as functions of the dof.
type RowsByDof = [fn(usize) -> f64; 2];

/// A constraint over the first `count` dofs with the given rows B and G.
fn made_up(count: usize, rows: [RowsByDof; 2]) -> Constraint {
    let [force, derivative] = rows.map(|row| {
        let [normal, tangential] = row.map(|entry| (0..count).map(entry).collect::<Vec<_>>());
        Rows::new(&normal, &tangential)
    });
    let dofs: Vec<usize> = (0..count).collect();
    Constraint {
        key: testing::key(count, 0),
        slave_dofs: 6,
        other_derivative_rows: (force != derivative).then_some(derivative),
        gap: -7.0,
        slip: 0.5,
        ..testing::made_up(&dofs, force)
    }
}

/// A tridiagonal positive definite matrix over the dofs; every dof is an unknown.
fn matrix() -> CheckedSolver {
    let map = Transformation::identity(DOFS);
    let pairs: Vec<Vec<usize>> = (0..DOFS).map(|i| vec![i, (i + 1) % DOFS]).collect();
    let mut matrix = Assembled::new(&map, &pairs);
    for element in 0..DOFS {
        let stiff = 2.0 + element as f64;
        matrix.add(element, &[stiff, -1.0, -1.0, stiff], 1.0);
    }
    CheckedSolver::new(linear_solver(SolverChoice::Faer), matrix)
}

/// Two constraints of different size; the wide one has its own derivative rows.
fn narrow_and_wide() -> [Constraint; 2] {
    let alternating = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let wide = made_up(
        DOFS,
        [
            [|k| 1.0 + k as f64, alternating],
            [|k| 0.5 - k as f64, |k| (k as f64).sin()],
        ],
    );
    let narrow_rows: RowsByDof = [|k| (k as f64).cos(), |k| 0.1 * k as f64];
    let narrow = made_up(6, [narrow_rows; 2]);
    assert!(narrow.other_derivative_rows.is_none());
    [narrow, wide]
}

/// The compliance of constraints in the matrix.
fn compliance_of(constraints: &[&Constraint], solver: &mut CheckedSolver) -> Compliance {
    solver.factorize().expect("positive definite");
    let map = Transformation::identity(DOFS);
    let mut compliance = Compliance::new(map, vec![0; DOFS]);
    let prepared = compliance.prepare(&ConstraintGroup::All, constraints, solver);
    prepared.expect("solved");
    compliance
}

#[test]
fn delassus_entries_of_many_constraints_are_those_of_a_few_with_the_same_bits_on_any_number_of_threads()
 {
    let [narrow, wide] = narrow_and_wide();
    let few = [&narrow, &wide];
    let many: Vec<&Constraint> = (0..300).map(|k| few[k % 2]).collect();
    let compliance = compliance_of(&few, &mut matrix());
    let q = |constraints: &[&Constraint], threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let terms = vec![[0.0; 2]; constraints.len()];
        let of = (&compliance, &ConstraintGroup::All);
        let mut space = DelassusSpace::default();
        pool.expect("threads")
            .install(|| frictional_lcp(constraints, of, &terms, &mut space).q)
    };
    let (of_few, of_many) = (q(&few, 1), q(&many, 1));
    for (i, j) in (0..600).flat_map(|i| (0..600).map(move |j| (i, j))) {
        let place = |k: usize| k / 300 * 2 + k % 2;
        assert!((of_many[(i, j)] - of_few[(place(i), place(j))]).abs() < 1e-12);
    }
    assert!(q(&many, 2) == of_many && q(&many, 3) == of_many);
}

#[test]
fn delassus_entries_are_derivative_rows_times_compliance_times_force_rows() {
    let [narrow, wide] = narrow_and_wide();
    let constraints = [&narrow, &wide];
    let mut solver = matrix();
    let compliance = compliance_of(&constraints, &mut solver);
    let problem = frictional_lcp(
        &constraints,
        (&compliance, &ConstraintGroup::All),
        &[[0.0; 2]; 2],
        &mut DelassusSpace::default(),
    );

    // all rows over all dofs, normal before tangential
    let stacked = |rows: fn(&Constraint) -> &Rows| {
        let of = |k: usize| rows(constraints[k % 2]);
        DMatrix::from_fn(4, DOFS, |k, dof| {
            let row = if k < 2 {
                &of(k).normal
            } else {
                &of(k).tangential
            };
            row.get(dof).copied().unwrap_or(0.0)
        })
    };
    let b = stacked(|constraint| &constraint.force_rows);
    let g = stacked(Constraint::derivative_rows);
    for j in 0..4 {
        let column: Vec<f64> = b.row(j).iter().copied().collect();
        let response = DVector::from_vec(solver.solve(&column).expect("solved"));
        for i in 0..4 {
            let expected = (g.row(i) * &response)[0];
            let entry = problem.q[(i, j)];
            assert!(
                (entry - expected).abs() < 1e-13,
                "{i} {j}: {entry} {expected}"
            );
        }
    }
    assert!((problem.q[(1, 3)] - problem.q[(3, 1)]).abs() > 1e-3);
}

#[test]
fn slave_forces_are_those_of_the_leading_dofs() {
    let rows: RowsByDof = [|k| k as f64, |k| 10.0 * k as f64];
    let constraint = made_up(DOFS, [rows; 2]);
    let forces: Vec<_> = constraint.slave_forces([1.0, 2.0]).collect();
    assert_eq!(
        forces,
        [(0, [0.0, 21.0]), (1, [42.0, 63.0]), (2, [84.0, 105.0])]
    );
    assert_eq!(constraint.nodal_forces([1.0, 2.0]).count(), DOFS / 2);
}
