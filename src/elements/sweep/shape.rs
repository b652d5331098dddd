//! Shapes of elements: what differs between triangles and quadrilaterals in a block.

use crate::elements::integration_point::ShapeFunctions;
use crate::materials::lanes::Lanes;

/// Shape functions of N nodes at P integration points, and the two sums over the nodes that a sweep
/// needs, each with as few operations as the shape allows.
pub trait Shape<const N: usize, const P: usize> {
    /// The shape functions.
    const FUNCTIONS: ShapeFunctions<N, P>;

    /// Natural derivatives dv/dr_i = sum_a v_a dh_a/dr_i of a field at every point.
    fn derivatives(v: &[Lanes; N]) -> [[Lanes; 2]; P];

    /// sum_p q_pi dh_a/dr_i at every node a: the transpose of [`Self::derivatives`].
    fn nodal_sums(q: &[[Lanes; 2]; P]) -> [Lanes; N];
}
