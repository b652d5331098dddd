//! Straight lines by their places.

use crate::model::nearest_of;
use crate::vectors::{Circle, CircleTree, distance};

/// Straight lines in a tree, for finding the lines near a place.
pub(super) struct NearestLines {
    lines: Vec<[[f64; 2]; 2]>,
    tree: CircleTree,
}

impl NearestLines {
    pub fn new(lines: Vec<[[f64; 2]; 2]>) -> Self {
        let circle = |&[a, b]: &[[f64; 2]; 2]| Circle {
            centre: [0, 1].map(|i| a[i] + (b[i] - a[i]) / 2.0),
            radius: distance(a, b) / 2.0,
        };
        let tree = CircleTree::new(lines.iter().map(circle));
        NearestLines { lines, tree }
    }

    /// Number and distance of the line nearest to a point; of equally near lines, the first line.
    pub fn of(&self, point: [f64; 2]) -> Option<(usize, f64)> {
        let mut best: Option<(f64, usize)> = None;
        self.tree.visit_near(
            point,
            |_, _| true,
            |k| {
                let found = (nearest_of(point, self.lines[k]).1, k);
                if best.is_none_or(|best| found < best) {
                    best = Some(found);
                }
                best.map_or(f64::INFINITY, |best| best.0)
            },
        );
        best.map(|(off, k)| (k, off))
    }

    /// Numbers of the lines that have a point within `reach` of a place; the list may contain some lines farther away.
    pub fn around(&self, place: [f64; 2], reach: f64) -> Vec<usize> {
        let mut found = Vec::new();
        self.tree.visit_near(
            place,
            |_, _| true,
            |k| {
                found.push(k);
                reach
            },
        );
        found
    }
}
