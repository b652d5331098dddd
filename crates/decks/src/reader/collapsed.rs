//! Quadrilaterals of the deck with two neighbouring corners at one node become triangles. The sides of a triangle made
//! from a quadrilateral keep their numbers in the quadrilateral.

use smallvec::SmallVec;

use crate::model::{ElementType, Formulation, Shape};

/// A quadrilateral with a side of no length.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Collapsed {
    /// Type of the triangle.
    pub element_type: ElementType,
    /// Positions of the nodes of the triangle among the nodes of the quadrilateral.
    pub nodes: SmallVec<[usize; 6]>,
    /// The side of no length, counted from 0.
    pub side: usize,
}

impl Collapsed {
    /// The triangle that an element with nodes of given labels becomes; `None` if the element is no quadrilateral with
    /// exactly one side of no length, or if there is no such triangle.
    pub fn new(element_type: ElementType, labels: &[u64]) -> Option<Collapsed> {
        let (shape, is_plain) = match (element_type.shape, element_type.formulation) {
            (
                Shape::Quad4,
                Formulation::Displacement | Formulation::Enhanced | Formulation::Reduced,
            ) => (Shape::Tri3, true),
            (Shape::Quad8, Formulation::Displacement | Formulation::Reduced) => (Shape::Tri6, true),
            (shape, _) => (shape, false),
        };
        let corners = labels.get(..4).filter(|_| is_plain)?;
        let is_short = |side: &usize| corners[*side] == corners[(side + 1) % 4];
        let mut short = (0..4).filter(is_short);
        let (side, None) = (short.next()?, short.next()) else {
            return None;
        };
        // the middle of the side is there too
        if labels
            .get(4 + side)
            .is_some_and(|&middle| middle != corners[side])
        {
            return None;
        }
        let following = |k: usize| (side + 1 + k) % 4;
        let middles = (0..3).map(|k| 4 + following(k));
        let nodes = (0..3).map(following).chain(middles);
        let element_type = ElementType {
            shape,
            formulation: Formulation::Displacement,
            plane: element_type.plane,
        };
        Some(Collapsed {
            element_type,
            nodes: nodes.take(element_type.topology().nodes).collect(),
            side,
        })
    }
}

/// The side of the triangle that is side `side` of a quadrilateral whose side `short` has no length; `None` if `side`
/// and `short` are the same side.
pub(super) fn side_of_triangle(side: usize, short: usize) -> Option<usize> {
    let side = (side + 3 - short) % 4;
    (side < 3).then_some(side)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_keep_their_numbers() {
        for (labels, nodes, side) in [
            ([1, 2, 3, 3], [3, 0, 1], 2),
            ([1, 1, 2, 3], [1, 2, 3], 0),
            ([1, 2, 3, 1], [0, 1, 2], 3),
        ] {
            let triangle = Collapsed::new(ElementType::CPE4R, &labels).expect("a triangle");
            assert_eq!(triangle.element_type, ElementType::CPE3);
            assert_eq!((&triangle.nodes[..], triangle.side), (&nodes[..], side));
            for of_quadrilateral in 0..4 {
                let ends = [of_quadrilateral, (of_quadrilateral + 1) % 4].map(|k| labels[k]);
                match side_of_triangle(of_quadrilateral, side) {
                    Some(own) => {
                        let own = [own, (own + 1) % 3].map(|k| labels[nodes[k]]);
                        assert_eq!(own, ends);
                    }
                    None => assert_eq!(ends[0], ends[1]),
                }
            }
        }
        let eight =
            Collapsed::new(ElementType::CAX8, &[1, 2, 3, 3, 4, 5, 3, 6]).expect("a triangle");
        assert_eq!(eight.element_type, ElementType::CAX6);
        assert_eq!(&eight.nodes[..], [3, 0, 1, 7, 4, 5]);
        for labels in [[1, 2, 3, 4], [1, 1, 2, 2], [1, 2, 1, 3]] {
            assert_eq!(Collapsed::new(ElementType::CPE4, &labels), None);
        }
        assert_eq!(Collapsed::new(ElementType::CPE4H, &[1, 2, 3, 3]), None);
    }
}
