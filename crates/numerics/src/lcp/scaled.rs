//! The dimensionless form of the frictional problem that the methods solve, without the tangential unknowns of
//! frictionless contacts. Scale factors are powers of two: multiplication by them is exact. See docs/theory/complementarity.md.

use std::ops::Range;

use bumpalo::Bump;
use nalgebra::{DMatrix, DMatrixView};

use super::dense::{List, add_product, copy, extend_scaled, filled, list};
use super::problems::{ContactState, FreeUnknowns, FrictionalLcp, LcpError, expect_finite};

/// States, forces (Pn, Pt) and free unknowns in the units of a problem.
pub(crate) type Found<'s, 'a> = (&'s [ContactState], [List<'a, f64>; 2], List<'a, f64>);

/// v = Q p + b with p = (Pn of all n contacts, Pt of the m contacts with mu > 0, the f free unknowns x); the last rows
/// of v are the residual of the balance of the free unknowns, (S + E) x - L^T P - h.
///
/// The weight w_i of contact i is the square root of Qnn_ii over the mean of these values. The unit of length of
/// contact i is w_i times the deepest penetration, each measured over its weight; the unit of force is this length over
/// Qnn_ii. All units are rounded to powers of two. Normal and tangent of a contact have the same weight, so the
/// friction law does not change. Units follow the penetration, because it drives the forces: a much larger gap or slip
/// must not make a closed contact inaccurate. Free unknowns have the unit of length; a displacement by forces without
/// contact counts as a penetration.
#[derive(Clone)]
pub(crate) struct Scaled<'a> {
    /// Arena in which the lists of the problem and of its solution lie.
    pub arena: &'a Bump,
    /// Number of contacts n.
    pub contacts: usize,
    /// Contact (index) of each tangential unknown (length m).
    pub owners: List<'a, usize>,
    /// Position in p of the tangential unknown of each contact; `None` without friction (length n).
    pub tangents: List<'a, Option<usize>>,
    /// Number of free unknowns f.
    pub free: usize,
    /// Q, (n + m + f) x (n + m + f), column by column.
    entries: List<'a, f64>,
    /// Gaps and slips without forces, and the residual of the balance of the free unknowns without forces (length n + m
    /// + f).
    pub b: List<'a, f64>,
    /// Friction coefficients (length n).
    pub mu: List<'a, f64>,
    /// Weights of the contacts (length n).
    pub weights: List<'a, f64>,
    /// Unit of the compliances.
    pub compliance: f64,
    /// Unit of the forces of each contact (length n).
    units: List<'a, f64>,
    /// Unit of length.
    length: f64,
}

impl<'a> Scaled<'a> {
    /// Scales a problem that has at least one penetration or free unknowns.
    pub fn new(problem: &FrictionalLcp, arena: &'a Bump) -> Result<Self, LcpError> {
        let n = problem.len();
        let owners = list(arena, (0..n).filter(|i| problem.mu[*i] > 0.0));
        let mut tangents = filled(arena, None, n);
        for (f, i) in owners.iter().enumerate() {
            tangents[*i] = Some(n + f);
        }
        let compliance = power_of_two(problem.compliance());
        let weight = |i: usize| match problem.free.is_empty() {
            true => power_of_two((problem.q[(i, i)] / compliance).max(0.0).sqrt()),
            // what is held where free unknowns count from says nothing of a contact
            false => 1.0,
        };
        let weights = list(arena, (0..n).map(weight));
        let penetrations = problem.gap.iter().zip(&weights).map(|(g, w)| -g / w);
        let free = &problem.free;
        let of_forces = free.force.iter().map(|h| compliance * h.abs());
        let length = power_of_two(penetrations.chain(of_forces).fold(0.0, f64::max));
        // Reciprocals of powers of two are exact.
        let inverses = list(arena, weights.iter().map(|w| 1.0 / w));
        let gather = |column: &[f64], unit: f64, out: &mut List<f64>| {
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
        let size = n + owners.len() + free.len();
        let mut entries = List::with_capacity_in(size * size, arena);
        for k in (0..n).chain(owners.iter().map(|i| n + i)) {
            let column = &problem.q.as_slice()[2 * n * k..2 * n * (k + 1)];
            gather(column, compliance * weights[k % n], &mut entries);
            let works = (0..free.len()).map(|x| -free.works[(k, x)]);
            entries.extend(works.map(|work| work * inverses[k % n]));
        }
        for x in 0..free.len() {
            gather(free.motions.column(x).as_slice(), 1.0, &mut entries);
            let own = |i| free.stiffness[(i, x)] + free.regular[(i, x)];
            entries.extend((0..free.len()).map(|i| compliance * own(i)));
        }
        let motion = list(arena, problem.gap.iter().chain(&problem.slip).copied());
        let mut b = List::with_capacity_in(size, arena);
        gather(&motion, length, &mut b);
        b.extend(free.force.iter().map(|h| -compliance * h / length));

        let units = list(arena, weights.iter().map(|w| length / compliance / w));
        for values in [&entries, &b, &units] {
            expect_finite(values)?;
        }
        let mu = copy(arena, problem.mu.as_slice());
        Ok(Self {
            arena,
            contacts: n,
            owners,
            tangents,
            free: free.len(),
            entries,
            b,
            mu,
            weights,
            compliance,
            units,
            length,
        })
    }

    /// Makes this problem the problem `of` with a proximal term, whose `weight` eps holds p near the forces p0:
    ///
    /// ```text
    /// v = Q p + b + eps diag(Q) (p - p0)
    /// ```
    pub fn set_near(&mut self, of: &Scaled, weight: f64, p0: &[f64]) {
        let size = self.size();
        for (k, force) in p0.iter().enumerate() {
            let diagonal = k * (size + 1);
            let part = weight * of.entries[diagonal];
            self.entries[diagonal] = of.entries[diagonal] + part;
            self.b[k] = of.b[k] - part * force;
        }
    }

    /// Length of p.
    pub fn size(&self) -> usize {
        self.b.len()
    }

    /// Column k of Q.
    pub fn column(&self, k: usize) -> &[f64] {
        let size = self.size();
        &self.entries[k * size..(k + 1) * size]
    }

    /// Q.
    pub fn q(&self) -> DMatrixView<'_, f64> {
        DMatrixView::from_slice(&self.entries, self.size(), self.size())
    }

    /// Q p + b.
    pub fn motion(&self, p: &[f64]) -> List<'a, f64> {
        let mut v = copy(self.arena, &self.b);
        add_product(&self.entries, p, &mut v);
        v
    }

    /// The problem of some contacts alone, in the same units, with the forces p of all other contacts held. v = Q p + b
    /// is the motion under all forces, and v_c - Q_cc P_c the motion without the forces of these contacts.
    pub fn alone(&self, contacts: &[usize], [p, v]: [&[f64]; 2]) -> FrictionalLcp {
        let n = contacts.len();
        let normal = contacts.iter().map(|&i| Some(i));
        let tangential = contacts.iter().map(|&i| self.tangents[i]);
        // position in p of every row; without friction there is no tangential one
        let places: Vec<Option<usize>> = normal.chain(tangential).collect();
        let mut q = DMatrix::identity(2 * n, 2 * n);
        let motion = places.iter().map(|place| place.map_or(0.0, |k| v[k]));
        let mut motion: Vec<f64> = motion.collect();
        for (j, place) in places.iter().enumerate() {
            let Some(k) = *place else { continue };
            let column = self.column(k);
            for (i, place) in places.iter().enumerate() {
                let entry = place.map_or(0.0, |row| column[row]);
                q[(i, j)] = entry;
                motion[i] -= entry * p[k];
            }
        }
        let (gap, slip) = motion.split_at(n);
        let mu: Vec<f64> = contacts.iter().map(|&i| self.mu[i]).collect();
        FrictionalLcp {
            q,
            gap: gap.to_vec().into(),
            slip: slip.to_vec().into(),
            mu: mu.into(),
            free: FreeUnknowns::default(),
        }
    }

    /// Positions in p of the free unknowns.
    pub fn free_places(&self) -> Range<usize> {
        self.size() - self.free..self.size()
    }

    /// x in the units of the problem.
    pub fn free_of(&self, p: &[f64]) -> List<'a, f64> {
        let of_p = p[self.free_places()].iter();
        list(self.arena, of_p.map(|x| x * self.length))
    }

    /// The states of contacts with the forces and free unknowns of p, in the units of the problem.
    pub fn found<'s>(&self, states: &'s [ContactState], p: &[f64]) -> Found<'s, 'a> {
        (states, self.forces(p), self.free_of(p))
    }

    /// (Pn, Pt) of all contacts in the units of the problem.
    pub fn forces(&self, p: &[f64]) -> [List<'a, f64>; 2] {
        let pn = p.iter().zip(&self.units).map(|(p, unit)| p * unit);
        let pt = self.tangents.iter().zip(&self.units);
        let pt = pt.map(|(t, unit)| t.map_or(0.0, |t| p[t] * unit));
        [list(self.arena, pn), list(self.arena, pt)]
    }
}

/// Number of sweeps over rows and columns when a matrix is equilibrated.
const SWEEPS: usize = 4;

/// Largest power of two <= |x|; 1 for zero.
pub(crate) fn power_of_two(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    if x == 0.0 {
        return 1.0;
    }
    f64::from_bits(x.abs().to_bits() & EXPONENT).max(f64::MIN_POSITIVE)
}

/// Row factors r and column factors c that bring the entries r_i M_ij c_j near 1.
pub(crate) struct Equilibration {
    /// Row factors.
    pub rows: Vec<f64>,
    /// Column factors.
    pub columns: Vec<f64>,
}

impl Equilibration {
    /// Factors for `m`: rows and columns are divided in turn by the root of largest times smallest
    /// entry, rounded to powers of two. Rows and columns of zeros keep the factor 1.
    pub fn of(m: &DMatrix<f64>) -> Self {
        let (mut rows, mut columns) = (vec![1.0; m.nrows()], vec![1.0; m.ncols()]);
        for _ in 0..SWEEPS {
            for (i, factor) in rows.iter_mut().enumerate() {
                *factor = inverse_mean((0..m.ncols()).map(|j| (m[(i, j)] * columns[j]).abs()));
            }
            for (j, factor) in columns.iter_mut().enumerate() {
                *factor = inverse_mean((0..m.nrows()).map(|i| (m[(i, j)] * rows[i]).abs()));
            }
        }
        Self { rows, columns }
    }

    /// The scaled matrix r_i M_ij c_j.
    pub fn apply(&self, m: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(m.nrows(), m.ncols(), |i, j| {
            m[(i, j)] * self.rows[i] * self.columns[j]
        })
    }
}

/// One over the geometric mean of the largest and the smallest non-zero entry.
fn inverse_mean(entries: impl Iterator<Item = f64>) -> f64 {
    let (mut smallest, mut largest) = (f64::INFINITY, 0.0_f64);
    for entry in entries.filter(|e| *e > 0.0) {
        smallest = smallest.min(entry);
        largest = largest.max(entry);
    }
    if largest == 0.0 {
        1.0
    } else {
        1.0 / power_of_two(smallest.sqrt() * largest.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_of_two_keeps_the_exponent() {
        assert_eq!(power_of_two(1.0), 1.0);
        assert_eq!(power_of_two(-7.9), 4.0);
        assert_eq!(power_of_two(0.3), 0.25);
        assert_eq!(power_of_two(0.0), 1.0);
        assert_eq!(power_of_two(5e-324), f64::MIN_POSITIVE);
    }

    #[test]
    fn equilibration_undoes_row_and_column_scales() {
        let m = DMatrix::from_fn(3, 3, |i, j| {
            10f64.powi(8 * i as i32 - 9 * j as i32) * (1.0 + (i + j) as f64)
        });
        let scaled = Equilibration::of(&m).apply(&m);
        assert!(scaled.iter().all(|v| (0.1..10.0).contains(v)), "{scaled}");
    }
}
