//! Matrices over the nodes that are the same for both directions of displacement, stored for products with vectors over
//! all dofs. See docs/theory/elements.md.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::symmetric::SymmetricMatrix;

/// Number of rows that are stored together.
const ROWS: usize = 2;

/// Number of nodes of a run: in a mesh with numbered rows of nodes, quadrilaterals connect two neighbouring nodes to
/// four nodes in each row.
const RUN: usize = 4;

/// Number of nodes whose part of a product is one task for a thread.
const NODES: usize = 8192;

/// Values of two rows of the matrix at consecutive nodes.
struct ConsecutiveNodes {
    first: u32,
    values: [[f64; ROWS]; RUN],
}

/// A symmetric matrix over the nodes, stored in pairs of rows, each as runs of consecutive nodes.
pub struct NodalMatrix {
    /// Start of every pair of rows in `runs`, and the end of the last one.
    starts: Vec<usize>,
    runs: Vec<ConsecutiveNodes>,
}

impl NodalMatrix {
    /// A nodal matrix with the values of a symmetric matrix.
    pub fn new(matrix: &SymmetricMatrix) -> Self {
        let (mut starts, mut runs) = (vec![0], Vec::<ConsecutiveNodes>::new());
        let mut entries = Vec::new();
        for first_row in (0..matrix.size()).step_by(ROWS) {
            entries.clear();
            for row in first_row..(first_row + ROWS).min(matrix.size()) {
                let of_row = matrix.column(row);
                entries.extend(of_row.map(|(node, value)| (node, row - first_row, value)));
            }
            entries.retain(|entry| entry.2 != 0.0);
            entries.sort_unstable_by_key(|entry| entry.0);
            let start = runs.len();
            for &(node, row, value) in &entries {
                let covers = |run: &ConsecutiveNodes| node < run.first as usize + RUN;
                if !runs[start..].last().is_some_and(covers) {
                    runs.push(ConsecutiveNodes {
                        first: node as u32,
                        values: [[0.0; ROWS]; RUN],
                    });
                }
                if let Some(ConsecutiveNodes { first, values }) = runs.last_mut() {
                    values[node - *first as usize][row] = value;
                }
            }
            starts.push(runs.len());
        }
        NodalMatrix { starts, runs }
    }

    /// Writes the product with a vector over all dofs.
    pub fn write_product(&self, v: &[f64], product: &mut [f64]) {
        let (v, product) = (v.as_chunks::<2>().0, product.as_chunks_mut::<2>().0);
        let write = |(k, part): (usize, &mut [[f64; 2]])| {
            Arch::new().dispatch(Product {
                matrix: self,
                v,
                first: k * NODES,
                part,
            });
        };
        match product.len() > NODES && rayon::current_num_threads() > 1 {
            true => product.par_chunks_mut(NODES).enumerate().for_each(write),
            false => write((0, product)),
        }
    }
}

/// Writes the product of the matrix with v; `part` holds the values of the product from node `first` on.
struct Product<'a> {
    matrix: &'a NodalMatrix,
    v: &'a [[f64; 2]],
    first: usize,
    part: &'a mut [[f64; 2]],
}

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let NodalMatrix { starts, runs } = self.matrix;
        let ends = starts[self.first / ROWS..].windows(2);
        for (part, ends) in self.part.chunks_mut(ROWS).zip(ends) {
            let mut sums = [[0.0; 2]; ROWS];
            for ConsecutiveNodes { first, values } in &runs[ends[0]..ends[1]] {
                let v = &self.v[*first as usize..];
                match v.first_chunk::<RUN>() {
                    Some(v) => add_run(values, v, &mut sums),
                    None => add_run(values, v, &mut sums),
                }
            }
            part.copy_from_slice(&sums[..part.len()]);
        }
    }
}

/// Adds the products of a run with a vector at its nodes.
#[inline(always)]
fn add_run(values: &[[f64; ROWS]; RUN], v: &[[f64; 2]], sums: &mut [[f64; 2]; ROWS]) {
    for (of_rows, [x, y]) in values.iter().zip(v) {
        for (sum, value) in sums.iter_mut().zip(of_rows) {
            *sum = [sum[0] + value * x, sum[1] + value * y];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::{Assembled, Transformation};

    /// A matrix of random elements over `n` nodes, with random values.
    fn matrix(n: usize, elements: &[Vec<usize>]) -> Assembled {
        let mut matrix = Assembled::new(&Transformation::identity(n), elements);
        for (element, nodes) in elements.iter().enumerate() {
            let m = nodes.len();
            let value = |entry: usize| 1.0 + ((entry % m) * (entry / m) + element) as f64;
            let values: Vec<f64> = (0..m * m).map(value).collect();
            matrix.add(element, &values, 0.1);
        }
        matrix
    }

    #[test]
    fn a_product_is_that_of_both_directions_with_the_same_bits() {
        let n = 2 * NODES + 5;
        // neighbours, nodes far apart, the last nodes, and nodes without an element
        let mut elements = vec![
            vec![7, 1, 0, 4000],
            vec![n - 1, n - 2, 3],
            vec![n - 4, 5, n - 1],
        ];
        elements.extend((10..n - 8).step_by(2).map(|i| vec![i, i + 2, i + 3]));
        let (matrix, v) = (matrix(n, &elements), |dof: usize| (0.3 * dof as f64).sin());
        let mut expected = vec![0.0; 2 * n];
        for column in 0..n {
            for i in 0..2 {
                let terms = matrix.matrix().column(column);
                let terms = terms.map(|(row, m)| m * v(2 * row + i));
                expected[2 * column + i] = terms.fold(0.0, |sum, term| sum + term);
            }
        }
        let (nodal, v) = (NodalMatrix::new(matrix.matrix()), (0..2 * n).map(v));
        let v: Vec<f64> = v.collect();
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let mut product = vec![f64::NAN; 2 * n];
            pool.expect("threads")
                .install(|| nodal.write_product(&v, &mut product));
            assert_eq!(product, expected, "{threads} threads");
        }
    }

    #[test]
    fn nodes_that_nothing_couples_have_a_product_of_zero() {
        for n in 0..6 {
            let nodal = NodalMatrix::new(matrix(n, &[]).matrix());
            let mut product = vec![1.0; 2 * n];
            nodal.write_product(&vec![2.0; 2 * n], &mut product);
            assert!(product.iter().all(|&p| p == 0.0));
        }
    }
}
