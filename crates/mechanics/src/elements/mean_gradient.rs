//! Mean displacement gradient of an element, and its logarithmic strain.

use nalgebra::Matrix2;
use smallvec::SmallVec;

use crate::model::{Element, Mesh, Nodes};
use crate::vectors::difference;

/// Mean gradients of the shape functions of an element, stored in place.
type Weights = SmallVec<[[f64; 2]; 4]>;

/// Weights of the nodes of an element in its mean displacement gradient.
pub struct MeanGradient {
    nodes: Nodes,
    /// Mean gradient of the shape function of each node (1/length).
    weights: Weights,
    /// Area of the undeformed element (length^2).
    pub area: f64,
}

impl MeanGradient {
    /// Mean gradient of an element, from integrals over its sides with the outward normal n:
    ///
    /// ```text
    /// 1/A int dh_a/dX dA = 1/A int h_a n dl,  A = int X n_x dl
    /// ```
    pub fn new(mesh: &Mesh, element: &Element) -> Self {
        let x = |node: usize| mesh.coordinates[node];
        let mut weights: Weights = element.nodes.iter().map(|_| [0.0; 2]).collect();
        for side in (0..element.side_count()).map(|side| element.side(side)) {
            let first = side.nodes()[0];
            for (node, normal) in side.normals(|node| difference(x(first), x(node))) {
                let own = element.nodes.iter().zip(&mut weights);
                for (_, weight) in own.filter(|(own, _)| **own == node) {
                    *weight = [weight[0] + normal[0], weight[1] + normal[1]];
                }
            }
        }
        let terms = element.nodes.iter().zip(&weights);
        let area = terms.map(|(&node, n)| x(node)[0] * n[0]).sum::<f64>();
        MeanGradient {
            nodes: element.nodes.clone(),
            weights: weights.iter().map(|n| n.map(|n| n / area)).collect(),
            area,
        }
    }

    /// Logarithmic strain of the mean displacement gradient at displacements `u`, 2 N entries (length), with the
    /// components xx, yy, xy (tensor shear).
    pub fn logarithmic_strain(&self, u: &[f64]) -> [f64; 3] {
        let mut h = Matrix2::zeros();
        for (&node, w) in self.nodes.iter().zip(&self.weights) {
            let [x, y] = [u[2 * node], u[2 * node + 1]];
            h += Matrix2::new(x * w[0], x * w[1], y * w[0], y * w[1]);
        }
        logarithmic_strain(&h)
    }
}

/// Logarithmic strain xx, yy, xy (tensor shear) in the deformed configuration, ln V with V^2 = F F^T and the
/// deformation gradient F = I + H:
///
/// ```text
/// F F^T = B = I + G,   G = H + H^T + H H^T,   m = tr B/2,   D = B - m I,   d = sqrt(-det D)
/// ln V = 1/2 (ln det F I + artanh(d/m)/d D)
/// ```
///
/// The strain is NaN if F turns the element inside out.
pub(super) fn logarithmic_strain(h: &Matrix2<f64>) -> [f64; 3] {
    let g = h + h.transpose() + h * h.transpose();
    let m = 1.0 + g.trace() / 2.0;
    let half = (g.m11 - g.m22) / 2.0;
    let d = half.hypot(g.m12);
    let factor = if d == 0.0 {
        1.0 / m
    } else {
        (d / m).atanh() / d
    };
    let mean = (h.trace() + h.determinant()).ln_1p() / 2.0;
    [
        mean + factor * half / 2.0,
        mean - factor * half / 2.0,
        factor * g.m12 / 2.0,
    ]
}

/// Logarithmic strain ln(1 + 2 e)/2 of a principal direction whose Green-Lagrange strain is `e`.
pub fn logarithmic_of(e: f64) -> f64 {
    (2.0 * e).ln_1p() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::ElementType;

    /// Displacements of a distorted quadrilateral under the deformation gradient `f`.
    fn deformed(f: Matrix2<f64>) -> (MeanGradient, Vec<f64>) {
        let coordinates = vec![[0.0, 0.0], [2.0, 0.1], [2.3, 1.4], [-0.2, 1.0]];
        let element = Element {
            label: 1,
            element_type: ElementType::CPE4,
            nodes: vec![0, 1, 2, 3].into(),
            section: 0,
        };
        let h = f - Matrix2::identity();
        let moved = |x: &[f64; 2]| [h.m11 * x[0] + h.m12 * x[1], h.m21 * x[0] + h.m22 * x[1]];
        let u = coordinates.iter().flat_map(moved).collect();
        let mesh = Mesh {
            coordinates,
            ..Mesh::default()
        };
        (MeanGradient::new(&mesh, &element), u)
    }

    #[test]
    fn stretches_that_are_turned() {
        // V = R diag(1.5, 0.8) R^T, F = V Q
        for (turn, spin) in [(0.0, 0.0_f64), (0.4, 1.1), (1.2, -2.0)] {
            let turn = nalgebra::Rotation2::new(turn).into_inner();
            let spin = nalgebra::Rotation2::new(spin).into_inner();
            let stretch = Matrix2::new(1.5, 0.0, 0.0, 0.8);
            let (element, u) = deformed(turn * stretch * turn.transpose() * spin);
            let exact = Matrix2::new(1.5_f64.ln(), 0.0, 0.0, 0.8_f64.ln());
            let exact = turn * exact * turn.transpose();
            let found = element.logarithmic_strain(&u);
            for (a, b) in found.iter().zip([exact.m11, exact.m22, exact.m12]) {
                assert!((a - b).abs() < 1e-14, "{found:?} {exact}");
            }
        }
    }

    #[test]
    fn area_and_small_strains() {
        let (element, u) = deformed(Matrix2::new(1.0 + 1e-9, 2e-9, 0.0, 1.0));
        // shoelace by hand: 2 1.4 - 2.3 0.1 + 2.3 - (-0.2) 1.4 over 2
        assert!((element.area - (2.8 - 0.23 + 2.3 + 0.28) / 2.0).abs() < 1e-15);
        let found = element.logarithmic_strain(&u);
        for (a, b) in found.iter().zip([1e-9, 0.0, 1e-9]) {
            assert!((a - b).abs() < 1e-16, "{found:?}");
        }
        let (element, u) = deformed(Matrix2::new(1.0, 0.0, 0.0, -1.0));
        assert!(element.logarithmic_strain(&u)[0].is_nan());
    }
}
