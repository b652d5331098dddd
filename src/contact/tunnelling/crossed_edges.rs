//! Edges of slave surfaces that cross segments, as they may at corners though no slave node is inside.
//! Section 10 of docs/theory.md, Penetration check.

use crate::contact::geometry::{position, project};
use crate::contact::search::Search;
use crate::linear::larger;

/// How far an edge of a slave surface and a segment have crossed in the displacements `u`, the most of all
/// pairs that the search lists, 0 where none cross:
///
/// ```text
/// min(|h_p|, |h_q|)/|b - a|, min(|h_a|, |h_b|)/|q - p|   the smaller    eq. (10.6)
/// ```
///
/// h being the distances of the ends p and q of the edge from the line of the segment from a to b, and the other
/// way round. Edges with a common node do not count.
pub fn crossed_edges(search: &Search, u: &[f64]) -> f64 {
    let at = |node: usize| position(search.coordinates(), u, node);
    let mut most = 0.0;
    for listed in search.slaves() {
        let slave = listed.node();
        let Some(adjacent) = listed.surfaces.adjacent[listed.slave] else {
            continue;
        };
        for candidate in listed.candidates() {
            let segment = listed.surfaces.segments[candidate.segment];
            for other in adjacent.iter().filter(|other| !segment.contains(other)) {
                let depth = crossed_by([slave, *other].map(at), segment.map(at));
                most = larger(most, depth.unwrap_or(0.0));
            }
        }
    }
    most
}

/// The same for one edge and one segment; none if they do not cross.
fn crossed_by(edge: [[f64; 2]; 2], segment: [[f64; 2]; 2]) -> Option<f64> {
    let depth = |[p, q]: [[f64; 2]; 2], [a, b]: [[f64; 2]; 2]| {
        let [p, q] = [project(p, a, b), project(q, a, b)];
        (p.gap * q.gap < 0.0).then(|| p.gap.abs().min(q.gap.abs()) / p.length)
    };
    Some(depth(edge, segment)?.min(depth(segment, edge)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::ContactSurfaces;
    use crate::model::Friction;

    #[test]
    fn edges_cross_by_the_nearest_end() {
        let segment = [[0.0, 0.0], [4.0, 0.0]];
        let by = |p, q| crossed_by([p, q], segment);
        assert_eq!(by([1.0, 2.0], [1.0, -0.4]), Some(0.1));
        assert_eq!(by([1.0, -0.4], [1.0, 2.0]), Some(0.1));
        assert_eq!(by([1.0, 2.0], [1.0, 0.4]), None, "above");
        assert_eq!(by([5.0, 2.0], [5.0, -2.0]), None, "beside");
        // the end of the segment is nearer to the edge than the ends of the edge to the segment
        assert_eq!(by([3.75, 2.0], [3.75, -2.0]), Some(0.0625));
        assert_eq!(by([1.0, 0.0], [1.0, -2.0]), None, "an end on the segment");
    }

    #[test]
    fn a_corner_that_an_edge_cuts_is_seen_though_no_node_is_inside() {
        // a roof over (0, 0), and a beam of two nodes that lies across its ridge, both ends outside
        let x = [
            [2.0, -2.0],
            [0.0, 0.0],
            [-2.0, -2.0],
            [1.0, -0.5],
            [-1.0, -0.5],
        ];
        let sides = vec![[0, 1], [1, 2]];
        let beam = [[3, 4], [4, 3]];
        let surfaces = ContactSurfaces::new(vec![3, 4], &beam, sides, Friction::default());
        let contacts = [surfaces];
        let mut search = Search::new(&contacts, &x);
        let mut depth = |height: f64| {
            let mut u = [0.0; 10];
            (u[7], u[9]) = (height, height);
            search.cover(&u);
            crossed_edges(&search, &u)
        };
        assert_eq!(depth(0.6), 0.0);
        // the ridge is 0.25 above the beam of length 2
        assert!((depth(0.25) - 0.125).abs() < 1e-15, "{}", depth(0.25));
    }
}
