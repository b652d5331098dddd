//! The linear map T from unknowns q to degrees of freedom u, sparse by rows (docs/theory/contact.md, u = T q + g),
//! and rotations of bodies as block diagonal matrices over the dofs (docs/numerics.md, Turned factors).

use std::ops::Range;
use std::sync::Arc;

use smallvec::SmallVec;

use super::{larger, largest};
use crate::archive::{Archive, ArchiveError};

/// The matrix T of u = T q + g: every dof is a sum of terms c q_k.
///
/// In T the row of a free dof is a row of the identity matrix, and the row of a prescribed dof is empty. The row of a
/// dof that follows other dofs by an equation holds the coefficients of their unknowns. A dof of a body that turns also
/// follows the angle of the body, by two coefficients that change with the iterate. Forces act by the first coefficient
/// of an angle, which represents the difference between start and iterate exactly. The second coefficient of an angle
/// is the derivative of the dof at the iterate (docs/theory/bodies.md).
#[derive(Debug, Clone, PartialEq)]
pub struct Transformation {
    unknowns: usize,
    /// Start of each row in `terms`; copies share this list.
    starts: Arc<[usize]>,
    /// Unknown and coefficient of every term, row by row; copies share them until they change.
    terms: Arc<[(usize, f64)]>,
    /// Coefficients of the derivatives, if they differ from the coefficients of the terms.
    derivatives: Option<Vec<f64>>,
    /// Ranges of the dofs of the unknowns, if every row is empty or a row of the identity matrix.
    selected: Option<Vec<Range<usize>>>,
}

impl Transformation {
    /// Motion T q of all dofs, with the coefficients of the derivatives.
    pub fn motion(&self, q: &[f64]) -> Vec<f64> {
        let mut motion = vec![0.0; self.starts.len() - 1];
        self.add(q, &mut motion);
        motion
    }

    /// Motion T q on which forces at all dofs do work, with the coefficients by which forces act.
    pub fn work(&self, q: &[f64]) -> Vec<f64> {
        let of_row = |row: &[(usize, f64)]| row.iter().map(|&(at, c)| c * q[at]).sum();
        self.rows().map(of_row).collect()
    }

    /// The map with the given rows (unknown, coefficient) of all dofs.
    pub fn new(unknowns: usize, rows: impl IntoIterator<Item = Vec<(usize, f64)>>) -> Self {
        let (mut starts, mut terms) = (vec![0], Vec::new());
        for row in rows {
            terms.extend(row);
            starts.push(terms.len());
        }
        let mut map = Transformation {
            unknowns,
            starts: starts.into(),
            terms: terms.into(),
            derivatives: None,
            selected: None,
        };
        map.selected = map.selection();
        map
    }

    /// Ranges of the dofs of the unknowns, if each unknown belongs to one dof, in the same order.
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

    /// Terms (unknown, coefficient) of the row of a dof.
    pub fn row(&self, dof: usize) -> &[(usize, f64)] {
        &self.terms[self.starts[dof]..self.starts[dof + 1]]
    }

    /// Terms (unknown, coefficient of the derivative) of the row of a dof.
    pub fn derivative_row(&self, dof: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.derivatives_in(self.starts[dof]..self.starts[dof + 1])
    }

    /// Whether the coefficients by which forces act differ from the derivatives; then T W T^T is not symmetric.
    pub fn has_own_derivatives(&self) -> bool {
        self.derivatives.is_some()
    }

    /// Terms with the coefficients of the derivatives, for a range of the terms.
    fn derivatives_in(&self, range: Range<usize>) -> impl Iterator<Item = (usize, f64)> + '_ {
        let of = self.derivatives.as_deref();
        range.map(move |i| (self.terms[i].0, of.map_or(self.terms[i].1, |of| of[i])))
    }

    /// Sets the coefficients of the last term of a dof: the coefficient by which forces act, and the derivative.
    pub fn set_last(&mut self, dof: usize, [force, derivative]: [f64; 2]) {
        let Some(last) = self.starts[dof + 1].checked_sub(1) else {
            return;
        };
        let own = || self.terms.iter().map(|term| term.1).collect();
        self.derivatives.get_or_insert_with(own)[last] = derivative;
        Arc::make_mut(&mut self.terms)[last].1 = force;
    }

    /// Transfers the coefficients, which change when bodies turn.
    ///
    /// # Errors
    /// The archive belongs to another map.
    pub fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        archive.transfer(&mut self.derivatives)?;
        match &self.derivatives {
            Some(derivatives) if derivatives.len() != self.terms.len() => Err(ArchiveError::Size),
            Some(_) => archive.transfer_values(Arc::make_mut(&mut self.terms)),
            None => Ok(()),
        }
    }

    /// Coefficients of all terms.
    pub(super) fn coefficients(&self) -> impl Iterator<Item = f64> + '_ {
        self.terms.iter().map(|term| term.1)
    }

    /// Place of the first term of a dof among all terms.
    pub(super) fn first_term(&self, dof: usize) -> usize {
        self.starts[dof]
    }

    /// Terms of the rows of all dofs.
    pub fn rows(&self) -> impl Iterator<Item = &[(usize, f64)]> {
        let starts = self.starts.windows(2);
        starts.map(|ends| &self.terms[ends[0]..ends[1]])
    }

    /// The product T^T v over the unknowns for a vector v over all dofs.
    pub fn restrict(&self, v: &[f64]) -> Vec<f64> {
        let mut restricted = Vec::new();
        self.write_restricted(v, &mut restricted);
        restricted
    }

    /// The product T^T v over the unknowns, where T has the derivatives as coefficients.
    pub fn restrict_derivatives(&self, v: &[f64]) -> Vec<f64> {
        let mut restricted = vec![0.0; self.unknowns];
        for (dof, value) in v.iter().enumerate() {
            for (unknown, c) in self.derivative_row(dof) {
                restricted[unknown] += c * value;
            }
        }
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

    /// Writes [`Self::restrict`] of a vector that is given by the function `extend`, which appends its values at some
    /// dofs to a list.
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

    /// The largest absolute value of T^T v; NaN if one of the values is NaN.
    pub fn largest_restricted(&self, v: &[f64]) -> f64 {
        match &self.selected {
            Some(selected) => {
                let of_range = |dofs: &Range<usize>| largest(&v[dofs.clone()]);
                selected.iter().map(of_range).fold(0.0, larger)
            }
            None => largest(&self.restrict(v)),
        }
    }

    /// Writes v + T q for v over all dofs, where T has the derivatives as coefficients.
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

    /// Adds T q to a vector v over all dofs, where T has the derivatives as coefficients.
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
        for (ends, value) in self.starts.windows(2).zip(v) {
            for (unknown, c) in self.derivatives_in(ends[0]..ends[1]) {
                *value += c * q[unknown];
            }
        }
    }
}

/// Rotation R, which turns x and y of every node by the angle of its body. If W is the inverse of a matrix, R W R^T is
/// the inverse of this matrix turned with the bodies.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Rotation {
    /// Cosine and sine of the angle of every node; empty if no body is turned, which makes R cost nothing.
    nodes: Vec<[f64; 2]>,
}

impl Rotation {
    /// The rotation of bodies by the given angles (rad); `body_of` gives the body of every node.
    pub fn new(angles: &[f64], body_of: &[usize]) -> Self {
        let mut rotation = Rotation::default();
        rotation.set(angles, body_of);
        rotation
    }

    /// Sets other angles, in the same memory.
    pub fn set(&mut self, angles: &[f64], body_of: &[usize]) {
        self.nodes.clear();
        if angles.iter().all(|&angle| angle == 0.0) {
            return;
        }
        let of_bodies = angles.iter().map(|a| [a.cos(), a.sin()]);
        let of_bodies: SmallVec<[[f64; 2]; 8]> = of_bodies.collect();
        self.nodes
            .extend(body_of.iter().map(|&body| of_bodies[body]));
    }

    /// Whether no body is turned.
    pub fn is_identity(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Replaces the vector `v` over all dofs by R v.
    pub fn turn(&self, v: &mut [f64]) {
        for (&[cos, sin], v) in self.nodes.iter().zip(v.chunks_exact_mut(2)) {
            rotate([cos, sin], v);
        }
    }

    /// Replaces the vector `v` over all dofs by R^T v.
    pub fn turn_back(&self, v: &mut [f64]) {
        for (&[cos, sin], v) in self.nodes.iter().zip(v.chunks_exact_mut(2)) {
            rotate([cos, -sin], v);
        }
    }

    /// Replaces the vector v of one node by R v.
    pub fn turn_node(&self, node: usize, v: &mut [f64; 2]) {
        if let Some(&[cos, sin]) = self.nodes.get(node) {
            rotate([cos, sin], v);
        }
    }

    /// Replaces the vector v of one node by R^T v.
    pub fn turn_node_back(&self, node: usize, v: &mut [f64; 2]) {
        if let Some(&[cos, sin]) = self.nodes.get(node) {
            rotate([cos, -sin], v);
        }
    }

    /// Replaces `row` by row R; the row is over the given dofs: x and y of each node after the other.
    pub fn turn_row(&self, dofs: &[usize], row: &mut [f64]) {
        for (dofs, entries) in dofs.chunks_exact(2).zip(row.chunks_exact_mut(2)) {
            if let Some(&[cos, sin]) = self.nodes.get(dofs[0] / 2) {
                rotate([cos, -sin], entries);
            }
        }
    }
}

/// Rotates x and y by the angle with the given cosine and sine.
fn rotate([cos, sin]: [f64; 2], v: &mut [f64]) {
    let [x, y] = [v[0], v[1]];
    (v[0], v[1]) = (cos * x - sin * y, sin * x + cos * y);
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
        /// The identity v.(T q) = (T^T v).q holds.
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

#[cfg(test)]
mod rotation_tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    fn assert_near(v: &[f64], expected: &[f64]) {
        let is_near = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-15;
        assert!(v.iter().zip(expected).all(is_near), "{v:?} {expected:?}");
    }

    #[test]
    fn nodes_turn_with_their_bodies() {
        let r = Rotation::new(&[0.0, FRAC_PI_2], &[1, 0, 1]);
        let mut v = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        r.turn(&mut v);
        assert_near(&v, &[-2.0, 1.0, 3.0, 4.0, -6.0, 5.0]);
        r.turn_back(&mut v);
        assert_near(&v, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    }

    #[test]
    fn a_row_turns_so_that_its_product_with_a_turned_vector_stays() {
        let r = Rotation::new(&[0.3, -1.1], &[1, 0, 1]);
        let (dofs, row) = ([4, 5, 2, 3], [0.5, -2.0, 3.0, 1.0]);
        let v = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let product = |row: &[f64], v: &[f64]| -> f64 {
            dofs.iter().zip(row).map(|(&dof, b)| b * v[dof]).sum()
        };
        let (mut turned, mut turned_row) = (v, row);
        r.turn(&mut turned);
        r.turn_row(&dofs, &mut turned_row);
        assert!((product(&row, &turned) - product(&turned_row, &v)).abs() < 1e-13);
    }

    #[test]
    fn without_turned_bodies_no_bit_changes() {
        let mut v = [-0.0, 0.1, f64::MIN_POSITIVE, 3.0];
        let bits = v.map(f64::to_bits);
        let r = Rotation::new(&[0.0, -0.0], &[1, 0]);
        r.turn(&mut v);
        r.turn_row(&[0, 1, 2, 3], &mut v);
        assert_eq!(v.map(f64::to_bits), bits);
        assert!(r.is_identity() && !Rotation::new(&[0.0, 0.1], &[1, 0]).is_identity());
    }
}
