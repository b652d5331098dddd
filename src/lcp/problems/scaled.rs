//! The dimensionless form of the frictional problem that the methods solve, without the tangential
//! unknowns of frictionless contacts. Section 8 of docs/theory.md.

use nalgebra::DMatrix;

use super::dense::{add_product, extend_scaled};
use super::frictional::FrictionalLcp;
use super::general::{LcpError, expect_finite};
use super::scaling::power_of_two;

/// v = Q p + b with p = (Pn of all n contacts, Pt of the m contacts with mu > 0).
///
/// With the weights w_i = root of Qnn_ii over its mean, the unit of length of contact i is
/// w_i times the deepest penetration (over its weight), the unit of force is that length over
/// Qnn_ii; both are rounded to powers of two. One weight for normal and tangent keeps the friction
/// law. The penetration drives the forces: a gap or a slip many orders larger must not make a
/// closed contact inaccurate.
pub(crate) struct Scaled {
    /// Number of contacts n.
    pub contacts: usize,
    /// Contact of each tangential unknown (length m).
    pub owners: Vec<usize>,
    /// Position in p of the tangential unknown of each contact, None without friction (length n).
    pub tangents: Vec<Option<usize>>,
    /// Q, (n + m) x (n + m).
    pub q: DMatrix<f64>,
    /// Gaps and slips without forces (length n + m).
    pub b: Vec<f64>,
    /// Friction coefficients (length n).
    pub mu: Vec<f64>,
    /// Weights of the contacts (length n).
    pub weights: Vec<f64>,
    /// Unit of the compliances.
    pub compliance: f64,
    /// Unit of the forces of each contact (length n).
    units: Vec<f64>,
}

impl Scaled {
    /// Scales a problem with at least one penetration.
    pub fn new(problem: &FrictionalLcp) -> Result<Self, LcpError> {
        let n = problem.len();
        let owners: Vec<usize> = (0..n).filter(|i| problem.mu[*i] > 0.0).collect();
        let mut tangents = vec![None; n];
        for (f, i) in owners.iter().enumerate() {
            tangents[*i] = Some(n + f);
        }
        let compliance = power_of_two((0..n).map(|i| problem.q[(i, i)]).sum::<f64>() / n as f64);
        let weight = |i: usize| power_of_two((problem.q[(i, i)] / compliance).max(0.0).sqrt());
        let weights: Vec<f64> = (0..n).map(weight).collect();
        let penetrations = problem.gap.iter().zip(&weights).map(|(g, w)| -g / w);
        let length = power_of_two(penetrations.fold(0.0, f64::max));
        // Reciprocals of powers of two are exact.
        let inverses: Vec<f64> = weights.iter().map(|w| 1.0 / w).collect();
        let gather = |column: &[f64], unit: f64, out: &mut Vec<f64>| {
            let factor = 1.0 / unit;
            let (normal, tangential) = column.split_at(n);
            extend_scaled(out, normal, &inverses, factor);
            match owners.len() == n {
                true => extend_scaled(out, tangential, &inverses, factor),
                false => out.extend(
                    owners
                        .iter()
                        .map(|&i| tangential[i] * (inverses[i] * factor)),
                ),
            }
        };
        let size = n + owners.len();
        let mut q = Vec::with_capacity(size * size);
        for k in (0..n).chain(owners.iter().map(|i| n + i)) {
            let column = &problem.q.as_slice()[2 * n * k..2 * n * (k + 1)];
            gather(column, compliance * weights[k % n], &mut q);
        }
        let motion: Vec<f64> = problem.gap.iter().chain(&problem.slip).copied().collect();
        let mut b = Vec::with_capacity(size);
        gather(&motion, length, &mut b);

        let units: Vec<f64> = weights.iter().map(|w| length / compliance / w).collect();
        for values in [q.as_slice(), b.as_slice(), units.as_slice()] {
            expect_finite(values)?;
        }
        let mu = problem.mu.iter().copied().collect();
        let q = DMatrix::from_vec(size, size, q);
        Ok(Self {
            contacts: n,
            owners,
            tangents,
            q,
            b,
            mu,
            weights,
            compliance,
            units,
        })
    }

    /// Length of p.
    pub fn size(&self) -> usize {
        self.b.len()
    }

    /// Column k of Q.
    pub fn column(&self, k: usize) -> &[f64] {
        let size = self.size();
        &self.q.as_slice()[k * size..(k + 1) * size]
    }

    /// Q p + b.
    pub fn motion(&self, p: &[f64]) -> Vec<f64> {
        let mut v = self.b.clone();
        add_product(self.q.as_slice(), p, &mut v);
        v
    }

    /// (Pn, Pt) of all contacts in the units of the problem.
    pub fn forces(&self, p: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let pn = p.iter().zip(&self.units).map(|(p, unit)| p * unit);
        let pt = self.tangents.iter().zip(&self.units);
        (
            pn.collect(),
            pt.map(|(t, unit)| t.map_or(0.0, |t| p[t] * unit)).collect(),
        )
    }
}
