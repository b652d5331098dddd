//! Lemke's method: the almost complementary path, for the general problem after equilibration by powers of two, and for
//! the frictional problem with the blocks of its matrix instead of the matrix itself. See
//! docs/theory/complementarity.md.

use nalgebra::{DMatrix, DVector};

use super::basis::{Basis, Candidates, PivotMatrix, Values, Variable, perturbation};
use super::dense::{axpy, max_abs};
use super::problems::{
    ContactState, Lcp, LcpError, LcpSolution, expect_finite, expect_non_negative, expect_size,
};
use super::residual::{TOLERANCE, residual};
use super::scaled::{Equilibration, Scaled, power_of_two};

impl PivotMatrix for DMatrix<f64> {
    fn size(&self) -> usize {
        self.nrows()
    }

    fn add_product(&self, z: &[(usize, f64)], out: &mut [f64]) {
        let rows = self.nrows();
        for (j, value) in z {
            axpy(*value, &self.as_slice()[j * rows..(j + 1) * rows], out);
        }
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        self[(i, j)]
    }
}

/// A covering vector for any problem: it has entries of 1 after the rows of M have been scaled to entries near 1.
pub fn covering_vector(lcp: &Lcp) -> DVector<f64> {
    let rows = Equilibration::of(&lcp.m).rows;
    DVector::from_iterator(rows.len(), rows.iter().map(|r| 1.0 / r))
}

/// Solves an [`Lcp`] by Lemke's method with covering vector `d` >= 0 (positive where q is
/// negative), after scaling rows and columns of M, q and d by powers of two.
pub fn lemke(
    lcp: &Lcp,
    d: &DVector<f64>,
    settings: &LemkeSettings,
) -> Result<LcpSolution, LcpError> {
    lcp.check()?;
    expect_size("covering vector", lcp.q.len(), d.len())?;
    expect_finite(d.as_slice())?;
    expect_non_negative("covering vector", d.as_slice())?;
    if let Some(index) = (0..d.len()).find(|i| d[*i] == 0.0 && lcp.q[*i] < 0.0) {
        return Err(LcpError::Range {
            what: "covering vector where q < 0",
            index,
            value: 0.0,
        });
    }
    let factors = Equilibration::of(&lcp.m);
    let m = factors.apply(&lcp.m);
    // Row i times r_i, z_j = c_j z'_j unit; unit and the scale of d bring q' and d' near 1.
    let scaled = |v: &DVector<f64>| -> (Vec<f64>, f64) {
        let rows: Vec<f64> = v.iter().zip(&factors.rows).map(|(v, r)| v * r).collect();
        let unit = power_of_two(max_abs(&rows));
        (rows.iter().map(|v| v / unit).collect(), unit)
    };
    let (q, unit) = scaled(&lcp.q);
    let d = scaled(d).0;
    for values in [m.as_slice(), &q, &d] {
        expect_finite(values)?;
    }
    let vertex = follow_path(&m, &q, &d, settings)?;
    let z = vertex
        .z
        .iter()
        .zip(&factors.columns)
        .map(|(z, c)| z * c * unit);
    let z = DVector::from_iterator(q.len(), z);
    let value = residual(lcp, &z);
    if value > settings.residual_tolerance {
        return Err(LcpError::Residual {
            value,
            tolerance: settings.residual_tolerance,
        });
    }
    Ok(LcpSolution {
        w: lcp.w(&z),
        z,
        residual: value,
        pivots: vertex.pivots,
    })
}

/// Number of exchanges between two checks of the accumulated round-off.
const CHECK_INTERVAL: usize = 50;

/// Largest error of the kernel rows, relative to the values, that a correction removes safely.
const DRIFT: f64 = 1e-9;

/// Size of column entries, relative to the largest one, below which they do not take part in a ratio test.
const PIVOT_TOLERANCE: f64 = 1e-9;

/// The end of a path: a complementary basis.
pub(crate) struct LemkeVertex {
    /// Solution z.
    pub z: Vec<f64>,
    /// Whether z_i is basic.
    pub basic: Vec<bool>,
    /// Number of basis exchanges.
    pub pivots: usize,
}

/// Follows the almost complementary path of w = M z + q + d z0, eq. (8.4), with data scaled near 1,
/// from the ray of large z0 to z0 = 0.
pub(crate) fn follow_path<M: PivotMatrix>(
    matrix: &M,
    q: &[f64],
    d: &[f64],
    settings: &LemkeSettings,
) -> Result<LemkeVertex, LcpError> {
    let size = q.len();
    let p = perturbation(size);
    let Some(first) = first_row(q, d, &p, settings.tie_tolerance) else {
        return Ok(LemkeVertex {
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
    Ok(LemkeVertex {
        z: z[..size].to_vec(),
        basic,
        pivots,
    })
}

/// The row in which z0 becomes basic first: the row that needs the largest z0 for q + d z0 >= 0, where ties are broken
/// by the perturbation p. `None` if q >= 0.
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

/// The basic variable that blocks the entering variable, whose column is y. z0 leaves if it is among the first
/// variables to reach zero. `None` on a ray.
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

/// Result of Lemke's method.
pub(crate) struct LemkeForces {
    /// Forces p of the scaled problem.
    pub p: Vec<f64>,
    /// Contact states of the final basis.
    pub states: Vec<ContactState>,
    /// Basis exchanges.
    pub pivots: usize,
}

/// Matrix M of the frictional problem, z = (Pn, T+, Dt-), which is applied without being formed.
///
/// The tangent of a contact that would slip in the negative direction is reversed (`signs`), so
/// that q is negative at penetrations only and open contacts need no pivots.
struct FrictionalMatrix<'a> {
    scaled: &'a Scaled<'a>,
    /// 1 or -1 for each tangential unknown.
    signs: Vec<f64>,
    /// Transposed Q, so that the rows of Q are contiguous.
    rows: DMatrix<f64>,
}

/// Solves a scaled problem by Lemke's method with covering vector d = (1, 1/(1 + mu), 0), where both entries of a
/// contact are multiplied by its entry of `covering` > 0.
pub(crate) fn lemke_forces(
    scaled: &Scaled,
    covering: &[f64],
    settings: &LemkeSettings,
) -> Result<LemkeForces, LcpError> {
    let (n, m) = (scaled.contacts, scaled.owners.len());
    let signs: Vec<f64> = scaled.b[n..]
        .iter()
        .map(|slip| if *slip < 0.0 { -1.0 } else { 1.0 })
        .collect();
    let mut q: Vec<f64> = scaled.b[..n].to_vec();
    q.extend(scaled.b[n..].iter().map(|slip| slip.abs()));
    q.resize(n + 2 * m, 0.0);
    let mut d = covering.to_vec();
    d.extend(
        scaled
            .owners
            .iter()
            .map(|i| covering[*i] / (1.0 + scaled.mu[*i])),
    );
    d.resize(n + 2 * m, 0.0);
    let matrix = FrictionalMatrix::new(scaled, signs);
    let vertex = follow_path(&matrix, &q, &d, settings).map_err(|error| match error {
        LcpError::Ray {
            pivots,
            mut members,
        } => {
            members.retain(|i| *i < n);
            LcpError::Ray { pivots, members }
        }
        other => other,
    })?;
    let p = matrix.forces(vertex.z.iter().copied().enumerate());
    let states = (0..n).map(|i| matrix.state(i, &vertex.basic)).collect();
    Ok(LemkeForces {
        p,
        states,
        pivots: vertex.pivots,
    })
}

impl<'a> FrictionalMatrix<'a> {
    fn new(scaled: &'a Scaled<'a>, signs: Vec<f64>) -> Self {
        let rows = scaled.q().transpose();
        FrictionalMatrix {
            scaled,
            signs,
            rows,
        }
    }

    /// Forces p = (Pn, Pt) for z, with Pt = sign (2 T+ - mu Pn).
    fn forces(&self, z: impl Iterator<Item = (usize, f64)>) -> Vec<f64> {
        let n = self.scaled.contacts;
        let mut p = vec![0.0; self.scaled.size()];
        for (j, value) in z.filter(|(j, _)| *j < self.scaled.size()) {
            if j >= n {
                p[j] += 2.0 * self.signs[j - n] * value;
                continue;
            }
            p[j] += value;
            if let Some(t) = self.scaled.tangents[j] {
                p[t] -= self.signs[t - n] * self.scaled.mu[j] * value;
            }
        }
        p
    }

    /// State of contact i from its basic variables; if T+ and T- are both zero, the contact has no force.
    fn state(&self, i: usize, basic: &[bool]) -> ContactState {
        let Some(t) = self.scaled.tangents[i] else {
            return if basic[i] {
                ContactState::SlipPlus
            } else {
                ContactState::Open
            };
        };
        let (t_plus, t_minus) = (basic[t], !basic[t + self.scaled.owners.len()]);
        let sign = self.signs[t - self.scaled.contacts];
        match (basic[i], t_plus, t_minus) {
            (false, _, _) | (_, false, false) => ContactState::Open,
            (_, true, true) => ContactState::Stick,
            (_, false, true) => ContactState::sliding(sign),
            (_, true, false) => ContactState::sliding(-sign),
        }
    }
}

impl PivotMatrix for FrictionalMatrix<'_> {
    fn size(&self) -> usize {
        self.scaled.size() + self.scaled.owners.len()
    }

    /// Rows of eq. (8.3): g = Qnn Pn + Qnt Pt;  Dt+ = sign (Qtn Pn + Qtt Pt) + Dt-;  T- = mu Pn -
    /// T+.
    fn add_product(&self, z: &[(usize, f64)], out: &mut [f64]) {
        let (n, end) = (self.scaled.contacts, self.scaled.size());
        let m = self.scaled.owners.len();
        for (j, value) in z {
            if *j >= end {
                out[*j - m] += value;
            } else if *j >= n {
                out[*j + m] -= value;
            } else if let Some(t) = self.scaled.tangents[*j] {
                out[t + m] += self.scaled.mu[*j] * value;
            }
        }
        let mut v = vec![0.0; end];
        for (k, force) in self.forces(z.iter().copied()).iter().enumerate() {
            axpy(*force, self.scaled.column(k), &mut v);
        }
        axpy(1.0, &v[..n], &mut out[..n]);
        for (k, sign) in (n..end).zip(&self.signs) {
            out[k] += sign * v[k];
        }
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        let (n, end) = (self.scaled.contacts, self.scaled.size());
        let m = self.scaled.owners.len();
        let sign = |k: usize| if k >= n { self.signs[k - n] } else { 1.0 };
        if i >= end {
            let t = i - m;
            let owner = self.scaled.owners[t - n];
            return if j == owner {
                self.scaled.mu[owner]
            } else if j == t {
                -1.0
            } else {
                0.0
            };
        }
        if j >= end {
            return if j - m == i { 1.0 } else { 0.0 };
        }
        let q = self.rows.column(i); // row i of Q
        if j >= n {
            return sign(i) * sign(j) * 2.0 * q[j];
        }
        match self.scaled.tangents[j] {
            None => sign(i) * q[j],
            Some(t) => sign(i) * (q[j] - sign(t) * self.scaled.mu[j] * q[t]),
        }
    }
}

/// Settings of Lemke's method.
#[derive(Debug, Clone, PartialEq)]
pub struct LemkeSettings {
    /// Largest number of basis exchanges; `None` means 100 + 50 per unknown.
    pub max_pivots: Option<usize>,
    /// Difference of two ratios, relative to the larger of the ratio and 1, below which they are tied.
    pub tie_tolerance: f64,
    /// Largest residual of a solution.
    pub residual_tolerance: f64,
}

impl Default for LemkeSettings {
    fn default() -> Self {
        Self {
            max_pivots: None,
            tie_tolerance: 1e-10,
            residual_tolerance: TOLERANCE,
        }
    }
}

impl LemkeSettings {
    /// Largest number of exchanges for a problem of this size.
    pub(crate) fn pivot_limit(&self, size: usize) -> usize {
        self.max_pivots.unwrap_or(100 + 50 * size)
    }
}

#[cfg(test)]
mod tests {
    use bumpalo::Bump;

    use super::*;
    use crate::lcp::{FreeUnknowns, FrictionalLcp};

    /// Three contacts with a Q that is not symmetric; the second contact has no friction, and the third slips
    /// backwards.
    #[test]
    fn entries_are_those_of_the_product() {
        let factor = DMatrix::from_fn(6, 6, |i, j| ((7 * i + 3 * j) % 5) as f64 - 1.5);
        let problem = FrictionalLcp {
            q: &factor * factor.transpose() + &factor,
            gap: vec![-1.0, -0.5, -2.0].into(),
            slip: vec![0.25, 0.5, -0.75].into(),
            mu: vec![0.5, 0.0, 0.25].into(),
            free: FreeUnknowns::default(),
        };
        let arena = Bump::new();
        let scaled = Scaled::new(&problem, &arena).expect("finite");
        let signs = vec![1.0, -1.0];
        let matrix = FrictionalMatrix::new(&scaled, signs);
        for j in 0..matrix.size() {
            let mut column = vec![0.0; matrix.size()];
            matrix.add_product(&[(j, 1.0)], &mut column);
            let entries: Vec<f64> = (0..matrix.size()).map(|i| matrix.entry(i, j)).collect();
            assert_eq!(entries, column, "column {j}");
        }
    }
}
