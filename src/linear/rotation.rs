//! Rotations of bodies as block diagonal matrices over the dofs. Section 4 of docs/theory.md, Turned
//! factors.

use smallvec::SmallVec;

/// R: turns x and y of every node by the angle of its body. W is the inverse of a matrix, R W R^T
/// that of the matrix turned with the bodies.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Rotation {
    /// Cosine and sine of the angle of every node; none where no body is turned, so that it costs nothing.
    nodes: Vec<[f64; 2]>,
}

impl Rotation {
    /// The rotation of bodies by the given angles (rad); `body_of` of every node.
    pub fn new(angles: &[f64], body_of: &[usize]) -> Self {
        let mut rotation = Rotation::default();
        rotation.set(angles, body_of);
        rotation
    }

    /// Becomes another one, in the same memory.
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

    /// v <- R v, `v` over all dofs.
    pub fn turn(&self, v: &mut [f64]) {
        for (&[cos, sin], v) in self.nodes.iter().zip(v.chunks_exact_mut(2)) {
            rotate([cos, sin], v);
        }
    }

    /// v <- R^T v, `v` over all dofs.
    pub fn turn_back(&self, v: &mut [f64]) {
        for (&[cos, sin], v) in self.nodes.iter().zip(v.chunks_exact_mut(2)) {
            rotate([cos, -sin], v);
        }
    }

    /// v <- R v of one node.
    pub fn turn_node(&self, node: usize, v: &mut [f64; 2]) {
        if let Some(&[cos, sin]) = self.nodes.get(node) {
            rotate([cos, sin], v);
        }
    }

    /// v <- R^T v of one node.
    pub fn turn_node_back(&self, node: usize, v: &mut [f64; 2]) {
        if let Some(&[cos, sin]) = self.nodes.get(node) {
            rotate([cos, -sin], v);
        }
    }

    /// row <- row R, `row` over the given dofs: x and y of one node after the other.
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
