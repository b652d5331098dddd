//! The almost complementary path of Lemke's method. Section 8 of docs/theory.md.

use super::basis::{Basis, PivotMatrix, Values, Variable};
use super::ratio::{Candidates, perturbation};
use super::settings::LemkeSettings;
use crate::lcp::problems::LcpError;

/// Exchanges between two checks of the accumulated round-off.
const CHECK_INTERVAL: usize = 50;

/// Largest error of the kernel rows, relative to the values, that a correction removes safely.
const DRIFT: f64 = 1e-9;

/// Column entries below this part of the largest one do not take part in a ratio test.
const PIVOT_TOLERANCE: f64 = 1e-9;

/// The end of a path: a complementary basis.
pub(crate) struct Vertex {
    /// Solution z.
    pub z: Vec<f64>,
    /// Whether z_i is basic.
    pub basic: Vec<bool>,
    /// Basis exchanges.
    pub pivots: usize,
}

/// Follows the almost complementary path of w = M z + q + d z0, eq. (8.4), with data scaled near 1,
/// from the ray of large z0 to z0 = 0.
pub(crate) fn follow_path<M: PivotMatrix>(
    matrix: &M,
    q: &[f64],
    d: &[f64],
    settings: &LemkeSettings,
) -> Result<Vertex, LcpError> {
    let size = q.len();
    let p = perturbation(size);
    let Some(first) = first_row(q, d, &p, settings.tie_tolerance) else {
        return Ok(Vertex {
            z: vec![0.0; size],
            basic: vec![false; size],
            pivots: 0,
        });
    };
    let mut basis = Basis::new(matrix, d, first);
    let mut pivots = 1;
    let mut entering = Variable::Z(first);
    let (mut x, mut perturbed) = (basis.solve(q), basis.solve(&p));
    loop {
        let y = basis.solve(&basis.column(entering));
        let Some(leaving) = leaving(&basis, &x, &perturbed, &y, settings.tie_tolerance) else {
            return Err(LcpError::Ray {
                pivots,
                members: growing(&basis, entering, &y),
            });
        };
        for values in [&mut x, &mut perturbed] {
            advance(&basis, values, &y, entering, leaving);
        }
        x.w.iter_mut().chain(&mut x.z).for_each(|v| *v = v.max(0.0));
        basis.exchange(entering, leaving, &y);
        pivots += 1;
        entering = match leaving {
            Variable::Z0 => break,
            Variable::W(i) => Variable::Z(i),
            Variable::Z(i) => Variable::W(i),
        };
        if pivots >= settings.pivot_limit(size) {
            return Err(LcpError::PivotLimit { pivots });
        }
        if pivots % CHECK_INTERVAL == 0 {
            x = recompute(&mut basis, q);
            perturbed = basis.solve(&p);
        }
    }
    let z = recompute(&mut basis, q).z;
    let basic = (0..size).map(|i| basis.contains(Variable::Z(i))).collect();
    Ok(Vertex {
        z: z[..size].to_vec(),
        basic,
        pivots,
    })
}

/// The row that z0 takes first: the one that needs the largest z0 for q + d z0 >= 0, and among
/// equals the first one the perturbation p selects. None when q >= 0.
fn first_row(q: &[f64], d: &[f64], p: &[f64], tolerance: f64) -> Option<usize> {
    let needy = (0..q.len())
        .filter(|i| q[*i] < 0.0)
        .map(|i| (Variable::W(i), d[i]))
        .collect();
    let mut candidates = Candidates::new(needy, tolerance);
    for values in [q, p] {
        candidates.keep_smallest(|v| match v {
            Variable::W(i) => values[i],
            _ => 0.0,
        });
    }
    match candidates.first() {
        Some(Variable::W(i)) => Some(i),
        _ => None,
    }
}

/// The basic variable that blocks the entering one, whose column is y. z0 leaves when it is among
/// the first to reach zero. None on a ray.
fn leaving<M: PivotMatrix>(
    basis: &Basis<M>,
    x: &Values,
    perturbed: &Values,
    y: &Values,
    tie_tolerance: f64,
) -> Option<Variable> {
    let largest = y.z.iter().chain(&y.w).fold(0.0_f64, |l, v| l.max(v.abs()));
    let blocks = |v: &Variable| y.get(*v) > PIVOT_TOLERANCE * largest;
    let rows = basis
        .variables()
        .filter(blocks)
        .map(|v| (v, y.get(v)))
        .collect();
    let mut candidates = Candidates::new(rows, tie_tolerance);
    candidates.keep_smallest(|v| x.get(v));
    if candidates.contains(Variable::Z0) {
        return Some(Variable::Z0);
    }
    candidates.break_ties(basis, perturbed)
}

/// Moves the basic values along the entering column until `leaving` is zero.
fn advance<M: PivotMatrix>(
    basis: &Basis<M>,
    values: &mut Values,
    y: &Values,
    entering: Variable,
    leaving: Variable,
) {
    let step = values.get(leaving) / y.get(leaving);
    for variable in basis.variables() {
        *values.at(variable) -= step * y.get(variable);
    }
    *values.at(leaving) = 0.0;
    *values.at(entering) = step;
}

/// The basic values, recomputed from the data; the kernel is inverted again when its inverse has
/// become inaccurate.
fn recompute<M: PivotMatrix>(basis: &mut Basis<M>, q: &[f64]) -> Values {
    let (mut x, before, _) = basis.solve_refined(q);
    let scale = q.iter().fold(1.0_f64, |l, v| l.max(v.abs()));
    if before > DRIFT * scale && basis.reinvert() {
        x = basis.solve_refined(q).0;
    }
    x.w.iter_mut().chain(&mut x.z).for_each(|v| *v = v.max(0.0));
    x
}

/// Positions of z that grow along the ray of the entering variable.
fn growing<M: PivotMatrix>(basis: &Basis<M>, entering: Variable, y: &Values) -> Vec<usize> {
    let size = basis.size();
    let largest = y.z[..size].iter().fold(0.0_f64, |l, v| l.max(v.abs()));
    let grows = |i: &usize| entering == Variable::Z(*i) || y.z[*i] < -PIVOT_TOLERANCE * largest;
    (0..size).filter(grows).collect()
}
