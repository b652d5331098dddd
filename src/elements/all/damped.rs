//! Damping of all elements, and products of their matrices with a vector. Sections 2 and 4 of
//! docs/theory.md.

use rayon::prelude::*;

use super::elements::Elements;
use super::sweeps::PARALLEL_CHUNK;
use crate::elements::damping::ElementDamping;
use crate::elements::element::AnyElement;
use crate::elements::solid::{ElementMatrix, ElementVector, Increment, Motion, TangentPart};

impl Elements {
    /// K v with the tangent in the configuration of [`Self::internal_force`], 2 N entries. Elements
    /// at whose nodes `v` is zero cost nothing.
    pub fn tangent_product(&self, motion: Motion, v: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.dofs];
        for element in 0..self.len() {
            let moves = |&node: &usize| v[2 * node] != 0.0 || v[2 * node + 1] != 0.0;
            if self.nodes(element).iter().any(moves) {
                let k = self.whole_tangent(element, motion);
                add_product(self.nodes(element), &k, v, &mut product);
            }
        }
        product
    }

    /// Whether any element is damped.
    pub fn has_damping(&self) -> bool {
        !self.damped.is_empty()
    }

    /// Force of damping F_d in an increment of length `dt` with the displacement increment `d`, eq.
    /// (4.22), 2 N entries.
    pub fn damping_force(&self, increment: Increment, d: &[f64], dt: f64) -> Vec<f64> {
        let impulses = self.of_damped(|element, damping| damping.impulse(element, increment, d));
        let mut force = self.sum_of_damped(&impulses);
        force.iter_mut().for_each(|f| *f /= dt);
        force
    }

    /// Impulse that mass-proportional damping takes in a displacement increment, alpha M d, 2 N entries
    /// (force time).
    pub fn mass_damping_impulse(&self, d: &[f64]) -> Vec<f64> {
        self.sum_of_damped(&self.of_damped(|element, damping| damping.mass_impulse(element, d)))
    }

    /// Energy d.F_d that damping dissipates in an increment of length `dt` with the displacement
    /// increment `d`, eq. (4.24) (force length).
    pub fn damping_dissipation(&self, increment: Increment, d: &[f64], dt: f64) -> f64 {
        let work = |element: &_, damping: &ElementDamping| damping.work(element, increment, d);
        self.of_damped(work).iter().sum::<f64>() / dt
    }

    /// Calls `add(element, c)` with the damping matrix of every damped element in order, eq. (4.25), or
    /// its positive part, c being D x D column by column (force time/length).
    pub fn for_each_damping(
        &self,
        increment: Increment,
        part: TangentPart,
        mut add: impl FnMut(usize, &[f64]),
    ) {
        let of = |element: &_, damping: &ElementDamping| damping.matrix(element, increment, part);
        for ((element, _), c) in self.damped.iter().zip(self.of_damped(of)) {
            let d = 2 * self.nodes(*element).len();
            add(*element, &c[..d * d]);
        }
    }

    /// Cd v with the damping matrix, 2 N entries.
    pub fn damping_product(&self, increment: Increment, v: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.dofs];
        for (element, damping) in &self.damped {
            let c = damping.matrix(&self.element(*element), increment, TangentPart::Whole);
            add_product(self.nodes(*element), &c, v, &mut product);
        }
        product
    }

    /// A quantity of all damped elements.
    fn of_damped<T: Send>(&self, of: impl Fn(&AnyElement, &ElementDamping) -> T + Sync) -> Vec<T> {
        let damped = self.damped.par_iter().with_min_len(PARALLEL_CHUNK);
        let all = damped.map(|(element, damping)| of(&self.element(*element), damping));
        all.collect()
    }

    /// Sum of vectors of the damped elements, 2 N entries.
    fn sum_of_damped(&self, vectors: &[ElementVector]) -> Vec<f64> {
        let mut sum = vec![0.0; self.dofs];
        for ((element, _), vector) in self.damped.iter().zip(vectors) {
            for (dof, value) in dofs(self.nodes(*element)).zip(vector) {
                sum[dof] += value;
            }
        }
        sum
    }
}

/// Dofs of the nodes of an element, in the order of element vectors.
pub(super) fn dofs(nodes: &[usize]) -> impl Iterator<Item = usize> + '_ {
    nodes.iter().flat_map(|n| [2 * n, 2 * n + 1])
}

/// Adds k v to a product over all dofs, k being a matrix of an element with these nodes.
fn add_product(nodes: &[usize], k: &ElementMatrix, v: &[f64], product: &mut [f64]) {
    let d = 2 * nodes.len();
    for (j, column) in dofs(nodes).enumerate() {
        for (i, row) in dofs(nodes).enumerate() {
            product[row] += k[j * d + i] * v[column];
        }
    }
}
