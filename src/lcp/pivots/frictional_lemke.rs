//! Lemke's method on the frictional problem, with the blocks of its matrix instead of the matrix
//! itself. Section 8 of docs/theory.md.

use nalgebra::DMatrix;

use super::basis::PivotMatrix;
use super::pivoting::follow_path;
use super::settings::LemkeSettings;
use crate::lcp::problems::{ContactState, LcpError, Scaled, axpy};

/// What Lemke's method found.
pub(crate) struct LemkeForces {
    /// Forces p of the scaled problem.
    pub p: Vec<f64>,
    /// Contact states of the final basis.
    pub states: Vec<ContactState>,
    /// Basis exchanges.
    pub pivots: usize,
}

/// M of the frictional problem, z = (Pn, T+, Dt-), without being formed.
///
/// The tangent of a contact that would slip in the negative direction is reversed (`signs`), so
/// that q is negative at penetrations only and open contacts need no pivots.
struct FrictionalMatrix<'a> {
    scaled: &'a Scaled<'a>,
    /// 1 or -1 for each tangential unknown.
    signs: Vec<f64>,
    /// Transposed Q: its rows one after the other.
    rows: DMatrix<f64>,
}

/// Solves a scaled problem by Lemke's method with covering vector d = (1, 1/(1 + mu), 0), both
/// entries of a contact times its entry of `covering` > 0.
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

    /// p = (Pn, Pt) of z: Pt = sign (2 T+ - mu Pn).
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

    /// State of contact i by its basic variables; with T+ and T- both zero it has no force.
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

#[cfg(test)]
mod tests {
    use bumpalo::Bump;

    use super::*;
    use crate::lcp::problems::FrictionalLcp;

    /// Three contacts with a Q that is not symmetric, the second without friction, the third slipping
    /// backwards.
    #[test]
    fn entries_are_those_of_the_product() {
        let factor = DMatrix::from_fn(6, 6, |i, j| ((7 * i + 3 * j) % 5) as f64 - 1.5);
        let problem = FrictionalLcp {
            q: &factor * factor.transpose() + &factor,
            gap: vec![-1.0, -0.5, -2.0].into(),
            slip: vec![0.25, 0.5, -0.75].into(),
            mu: vec![0.5, 0.0, 0.25].into(),
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
