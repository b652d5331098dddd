//! Linear map T from unknowns q to degrees of freedom u, sparse by rows. Section 3 of
//! docs/theory.md (u = T q + g).

use std::ops::Range;

use super::{larger, largest};

/// The matrix T of u = T q + g: every dof is a sum of terms c q_k.
///
/// A free dof has a row of the identity, a prescribed one an empty row, one that follows others by
/// an equation a row with their coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct Transformation {
    unknowns: usize,
    /// Start of each row in `terms`.
    starts: Vec<usize>,
    /// Unknown and coefficient of every term, row by row.
    terms: Vec<(usize, f64)>,
    /// Dofs of the unknowns one after the other, where all rows are empty or of the identity.
    selected: Option<Vec<Range<usize>>>,
}

impl Transformation {
    /// The map with the given rows (unknown, coefficient) of all dofs.
    pub fn new(unknowns: usize, rows: impl IntoIterator<Item = Vec<(usize, f64)>>) -> Self {
        let (mut starts, mut terms) = (vec![0], Vec::new());
        for row in rows {
            terms.extend(row);
            starts.push(terms.len());
        }
        let mut map = Transformation {
            unknowns,
            starts,
            terms,
            selected: None,
        };
        map.selected = map.selection();
        map
    }

    /// Dofs of the unknowns in ranges, if each unknown is that of one dof, in their order.
    fn selection(&self) -> Option<Vec<Range<usize>>> {
        let (mut selected, mut count) = (Vec::<Range<usize>>::new(), 0);
        for (dof, row) in self.rows().enumerate() {
            match row {
                [] => continue,
                [(unknown, c)] if *unknown == count && *c == 1.0 => count += 1,
                _ => return None,
            }
            match selected.last_mut() {
                Some(range) if range.end == dof => range.end += 1,
                _ => selected.push(dof..dof + 1),
            }
        }
        (count == self.unknowns).then_some(selected)
    }

    /// The identity of size `n`.
    pub fn identity(n: usize) -> Self {
        Transformation::new(n, (0..n).map(|i| vec![(i, 1.0)]))
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// Terms (unknown, coefficient) of a dof.
    pub fn row(&self, dof: usize) -> &[(usize, f64)] {
        &self.terms[self.starts[dof]..self.starts[dof + 1]]
    }

    /// Terms of all dofs.
    pub fn rows(&self) -> impl Iterator<Item = &[(usize, f64)]> {
        let starts = self.starts.windows(2);
        starts.map(|ends| &self.terms[ends[0]..ends[1]])
    }

    /// T^T v over the unknowns for a vector v over all dofs.
    pub fn restrict(&self, v: &[f64]) -> Vec<f64> {
        let mut restricted = Vec::new();
        self.write_restricted(v, &mut restricted);
        restricted
    }

    /// Writes [`Self::restrict`].
    pub fn write_restricted(&self, v: &[f64], restricted: &mut Vec<f64>) {
        restricted.clear();
        restricted.reserve(self.unknowns);
        if let Some(selected) = &self.selected {
            for dofs in selected {
                restricted.extend_from_slice(&v[dofs.clone()]);
            }
            return;
        }
        // adding to -0.0 keeps every value, the sign of a zero included
        restricted.resize(self.unknowns, -0.0);
        for (row, value) in self.rows().zip(v) {
            for &(unknown, c) in row {
                restricted[unknown] += c * value;
            }
        }
    }

    /// Writes [`Self::restrict`] of the vector whose values at some dofs `extend` adds to a list.
    pub fn write_restricted_by(
        &self,
        extend: impl Fn(Range<usize>, &mut Vec<f64>),
        restricted: &mut Vec<f64>,
    ) {
        if let Some(selected) = &self.selected {
            restricted.clear();
            restricted.reserve(self.unknowns);
            let ranges = selected.iter().cloned();
            ranges.for_each(|dofs| extend(dofs, restricted));
            return;
        }
        let mut all = Vec::new();
        extend(0..self.starts.len() - 1, &mut all);
        self.write_restricted(&all, restricted);
    }

    /// The largest absolute value of T^T v, NaN where one is.
    pub fn largest_restricted(&self, v: &[f64]) -> f64 {
        match &self.selected {
            Some(selected) => {
                let of_range = |dofs: &Range<usize>| largest(&v[dofs.clone()]);
                selected.iter().map(of_range).fold(0.0, larger)
            }
            None => largest(&self.restrict(v)),
        }
    }

    /// Writes v + T q, v over all dofs.
    pub fn write_sum(&self, v: &[f64], q: &[f64], sum: &mut Vec<f64>) {
        sum.clear();
        let Some(selected) = &self.selected else {
            sum.extend_from_slice(v);
            self.add(q, sum);
            return;
        };
        sum.reserve(v.len());
        let mut rest = q;
        for dofs in selected {
            let (q, after) = rest.split_at(dofs.len());
            sum.extend_from_slice(&v[sum.len()..dofs.start]);
            sum.extend(v[dofs.clone()].iter().zip(q).map(|(v, q)| v + q));
            rest = after;
        }
        sum.extend_from_slice(&v[sum.len()..]);
    }

    /// Adds T q to a vector v over all dofs.
    pub fn add(&self, q: &[f64], v: &mut [f64]) {
        if let Some(selected) = &self.selected {
            let mut rest = q;
            for dofs in selected {
                let (q, after) = rest.split_at(dofs.len());
                v[dofs.clone()].iter_mut().zip(q).for_each(|(v, q)| *v += q);
                rest = after;
            }
            return;
        }
        for (row, value) in self.rows().zip(v) {
            for &(unknown, c) in row {
                *value += c * q[unknown];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn rows(unknowns: usize) -> impl Strategy<Value = Vec<Vec<(usize, f64)>>> {
        let term = (0..unknowns, -9.0..9.0_f64);
        proptest::collection::vec(proptest::collection::vec(term, 0..4), 1..30)
    }

    proptest! {
        /// v.(T q) = (T^T v).q
        #[test]
        fn restriction_is_the_adjoint_of_expansion(rows in rows(7), seed in 1_u32..1000) {
            let value = |i: usize| ((i * 37 + seed as usize) % 19) as f64 - 9.0;
            let v: Vec<f64> = (0..rows.len()).map(value).collect();
            let q: Vec<f64> = (0..7).map(|k| value(100 + k)).collect();
            let t = Transformation::new(7, rows);
            let mut u = vec![0.0; v.len()];
            t.add(&q, &mut u);
            let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
            prop_assert!((dot(&v, &u) - dot(&t.restrict(&v), &q)).abs() < 1e-9);
        }
    }

    #[test]
    fn prescribed_dofs_are_left_out_and_stay() {
        let row = |dof: usize, unknown: usize| match dof % 5 {
            0 | 3 => vec![],
            _ => vec![(unknown, 1.0)],
        };
        let mut unknowns = 0;
        let next = |dof: usize| {
            let row = row(dof, unknowns);
            unknowns += row.len();
            row
        };
        let rows: Vec<_> = (0..14).map(next).collect();
        let t = Transformation::new(unknowns, rows);
        let v: Vec<f64> = (0..14).map(f64::from).collect();
        let free = [1.0, 2.0, 4.0, 6.0, 7.0, 9.0, 11.0, 12.0];
        assert_eq!(t.restrict(&v), free);
        assert_eq!(t.largest_restricted(&v), 12.0);
        let mut restricted = Vec::new();
        let of_range = |dofs: Range<usize>, to: &mut Vec<f64>| to.extend_from_slice(&v[dofs]);
        t.write_restricted_by(of_range, &mut restricted);
        assert_eq!(restricted, free);
        let mut sum = Vec::new();
        t.write_sum(&v, &free, &mut sum);
        let mut u = v.clone();
        t.add(&free, &mut u);
        let of_dof = |(dof, u): (usize, &f64)| {
            *u == v[dof]
                * if [0, 3].contains(&(dof % 5)) {
                    1.0
                } else {
                    2.0
                }
        };
        assert!(u.iter().enumerate().all(of_dof), "{u:?}");
        assert_eq!(sum, u);
    }

    #[test]
    fn rows_of_the_identity_change_no_bit() {
        let t = Transformation::identity(3);
        let v = [-0.0, 0.1, f64::MIN_POSITIVE];
        let bits = |v: &[f64]| -> Vec<u64> { v.iter().map(|v| v.to_bits()).collect() };
        assert_eq!(bits(&t.restrict(&v)), bits(&v));
    }
}
