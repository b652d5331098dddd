//! Results at integration points, and extrapolated to nodes. See docs/theory/elements.md.

use std::collections::BTreeMap;

use nalgebra::Matrix2;
use smallvec::SmallVec;

use super::all::Elements;
use super::mean_gradient::{logarithmic_of, logarithmic_strain};
use super::motion::Motion;
use super::results::{ElementResult, PointResult};
use super::shapes::{CORNERS, DEGREE_5, GAUSS};
use crate::model::Shape;

/// Results at one place: an integration point or a node.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LocalResult {
    /// Stress, strain and energy at the place; the energy is per volume (force/length^2), without the energy of
    /// hourglass modes.
    pub result: ElementResult,
    /// Logarithmic strain xx, yy, xy (tensor shear) in the deformed configuration.
    pub logarithmic_strain: [f64; 3],
    /// Logarithmic strain across the thickness, or around the axis of a body of revolution.
    pub logarithmic_across: f64,
}

impl LocalResult {
    /// Sum of results times factors, for means and for values between points.
    pub fn weighted<'a>(terms: impl Iterator<Item = (f64, &'a LocalResult)> + Clone) -> Self {
        let own = terms.clone().map(|(factor, term)| (factor, &term.result));
        let mut sum = LocalResult {
            result: ElementResult::weighted(own),
            ..LocalResult::default()
        };
        for (factor, term) in terms {
            sum.logarithmic_across += factor * term.logarithmic_across;
            for (sum, strain) in sum
                .logarithmic_strain
                .iter_mut()
                .zip(term.logarithmic_strain)
            {
                *sum += factor * strain;
            }
        }
        sum
    }
}

/// Results of the integration points or the nodes of an element.
pub type LocalResults = SmallVec<[LocalResult; 9]>;

impl Elements {
    /// Results at the integration points of an element at the end of a motion, with the internal variables at this end;
    /// zero for elements of rigid bodies.
    pub fn at_points(&self, element: usize, motion: Motion) -> LocalResults {
        let Some((chunk, place)) = self.chunk_of(element) else {
            return SmallVec::from_elem(LocalResult::default(), self.points(element));
        };
        let points = chunk.at_points(place, motion);
        let local = |PointResult { result, gradient }: PointResult| LocalResult {
            logarithmic_strain: logarithmic_strain(&Matrix2::from(gradient).transpose()),
            logarithmic_across: logarithmic_of(result.strain_across),
            result,
        };
        points.into_iter().map(local).collect()
    }

    /// Results at the nodes of an element, from the linear or bilinear field nearest to the results of its points.
    pub fn at_nodes(&self, element: usize, motion: Motion) -> LocalResults {
        let points = self.at_points(element, motion);
        let (shape, nodes) = (self.shape(element), self.nodes(element).len());
        let at_node = |node: usize| {
            let factor = |(p, point)| (share(shape, points.len(), node, p), point);
            LocalResult::weighted(points.iter().enumerate().map(factor))
        };
        (0..nodes).map(at_node).collect()
    }
}

/// Nodes of elements, with the values of all elements at each node.
pub struct ElementNodes {
    /// Elements (indices).
    elements: Vec<usize>,
    /// Indices of the nodes, increasing, each with the places of its values among the values of all elements.
    places: BTreeMap<usize, Vec<usize>>,
}

impl ElementNodes {
    /// The nodes of the elements with the given indices.
    pub fn new(all: &Elements, elements: &[usize]) -> Self {
        let mut places: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        let nodes = elements.iter().flat_map(|&e| all.nodes(e));
        for (place, &node) in nodes.enumerate() {
            places.entry(node).or_default().push(place);
        }
        ElementNodes {
            elements: elements.to_vec(),
            places,
        }
    }

    /// Indices of the nodes, increasing.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = usize> {
        self.places.keys().copied()
    }

    /// Results at the nodes, one after the other: plain means over the elements at a node, which have positive weights
    /// for elements of any shape.
    pub fn results(&self, all: &Elements, motion: Motion) -> Vec<LocalResult> {
        let of = |&element: &usize| all.at_nodes(element, motion);
        let own: Vec<LocalResult> = self.elements.iter().flat_map(of).collect();
        let mean = |places: &Vec<usize>| {
            let part = 1.0 / places.len() as f64;
            LocalResult::weighted(places.iter().map(|&place| (part, &own[place])))
        };
        self.places.values().map(mean).collect()
    }
}

/// Share of a point in the value at a node. In quadrilaterals the share of a point in the value at a node is, with sums
/// over the points:
///
/// ```text
/// f(r, s) = sum_p f_p (1/P + r r_p/sum r² + s s_p/sum s² + r s r_p s_p/sum r² s²)
/// ```
///
/// With four points the field at the nodes interpolates the values at the points; with nine points it is the field
/// nearest to these values. In triangles with three points the share of a point is 2 L - 1/3, where L is the area
/// coordinate, at the node, of the point's corner.
fn share(shape: Shape, points: usize, node: usize, point: usize) -> f64 {
    let corners = shape.topology().sides.len();
    if points == 1 {
        return 1.0;
    }
    if corners == 3 {
        let (next, is_corner) = ((node + 1) % 3, node < 3);
        let area = match is_corner {
            true => f64::from(u8::from(point == node)),
            false => f64::from(u8::from(point == node - 3 || point == next)) / 2.0,
        };
        return 2.0 * area - 1.0 / 3.0;
    }
    let place = |p: usize| match points {
        4 => CORNERS[p].map(|x| x * GAUSS),
        _ => DEGREE_5.0[p],
    };
    let [r, s] = match node < 4 {
        true => CORNERS[node],
        false => [0, 1].map(|i| (CORNERS[node - 4][i] + CORNERS[(node - 3) % 4][i]) / 2.0),
    };
    let sum = |of: fn([f64; 2]) -> f64| (0..points).map(|p| of(place(p))).sum::<f64>();
    let [rp, sp] = place(point);
    1.0 / points as f64
        + r * rp / sum(|[r, _]| r * r)
        + s * sp / sum(|[_, s]| s * s)
        + r * s * rp * sp / sum(|[r, s]| r * r * s * s)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_that_are_linear_or_bilinear_are_found_at_the_nodes() {
        let field = |[r, s]: [f64; 2]| 3.0 - 2.0 * r + 0.5 * s;
        for (shape, points, places) in [
            (
                Shape::Tri6,
                3,
                vec![
                    [1.0 / 6.0; 2],
                    [2.0 / 3.0, 1.0 / 6.0],
                    [1.0 / 6.0, 2.0 / 3.0],
                ],
            ),
            (
                Shape::Quad4,
                4,
                CORNERS.map(|x| x.map(|x| x * GAUSS)).to_vec(),
            ),
            (Shape::Quad8, 9, DEGREE_5.0.to_vec()),
        ] {
            let corners: Vec<[f64; 2]> = match points {
                3 => vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
                _ => CORNERS.to_vec(),
            };
            let count = corners.len();
            for node in 0..shape.topology().nodes {
                let x = match node < count {
                    true => corners[node],
                    false => [0, 1].map(|i| {
                        (corners[node - count][i] + corners[(node - count + 1) % count][i]) / 2.0
                    }),
                };
                let bilinear = |x: [f64; 2]| field(x) + if points > 3 { x[0] * x[1] } else { 0.0 };
                let found: f64 = (0..points)
                    .map(|p| share(shape, points, node, p) * bilinear(places[p]))
                    .sum();
                assert!(
                    (found - bilinear(x)).abs() < 1e-13,
                    "{points} {node} {found}"
                );
            }
        }
    }
}
