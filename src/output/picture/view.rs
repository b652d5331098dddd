//! The part of the plane that a picture shows.

use crate::model::Model;

/// A rectangle: its smallest and largest coordinates (length).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window(pub [[f64; 2]; 2]);

impl Window {
    /// The extents of the deformable bodies, and of rigid surfaces as far as these reach beyond the bodies
    /// by no more than the larger side of theirs: a long floor does not make the bodies small.
    pub(super) fn about_bodies(model: &Model) -> Self {
        let x = &model.mesh.coordinates;
        let of_elements = model
            .mesh
            .elements
            .iter()
            .flat_map(|element| &element.nodes);
        let bodies = extents(of_elements.map(|&node| x[node]));
        let all = extents(x.iter().copied());
        let side = |i: usize| bodies[1][i] / 2.0 - bodies[0][i] / 2.0;
        let beyond = 2.0 * f64::max(side(0), side(1));
        Window([
            [0, 1].map(|i| all[0][i].max(bodies[0][i] - beyond)),
            [0, 1].map(|i| all[1][i].min(bodies[1][i] + beyond)),
        ])
    }

    /// The rectangle with so much more on every side (length).
    pub(super) fn widened(self, [x, y]: [f64; 2]) -> Self {
        let Window([low, high]) = self;
        Window([[low[0] - x, low[1] - y], [high[0] + x, high[1] + y]])
    }

    /// Whether a place lies in it.
    pub(super) fn holds(&self, x: [f64; 2]) -> bool {
        let Window([low, high]) = self;
        (0..2).all(|i| low[i] <= x[i] && x[i] <= high[i])
    }

    /// The part of a line from `a` to `b` that lies in it, after Liang & Barsky (1984).
    pub(super) fn part(&self, [a, b]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
        let Window([low, high]) = self;
        let (mut start, mut end) = (0.0_f64, 1.0_f64);
        for i in 0..2 {
            let along = b[i] - a[i];
            let [enter, leave] = if along >= 0.0 {
                [low[i], high[i]]
            } else {
                [high[i], low[i]]
            };
            if along == 0.0 && !(low[i]..=high[i]).contains(&a[i]) {
                return None;
            }
            if along != 0.0 {
                start = start.max((enter - a[i]) / along);
                end = end.min((leave - a[i]) / along);
            }
        }
        let at = |part: f64| match part {
            0.0 => a,
            1.0 => b,
            _ => [0, 1].map(|i| a[i] + part * (b[i] - a[i])),
        };
        (start <= end).then(|| [at(start), at(end)])
    }
}

/// Smallest and largest coordinates of some places.
fn extents(places: impl Iterator<Item = [f64; 2]>) -> [[f64; 2]; 2] {
    let nothing = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    places.fold(nothing, |[low, high], x| {
        [
            [low[0].min(x[0]), low[1].min(x[1])],
            [high[0].max(x[0]), high[1].max(x[1])],
        ]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_at_the_sides_of_a_window() {
        let window = Window([[0.0, 0.0], [2.0, 1.0]]);
        let part = |a, b| window.part([a, b]);
        assert_eq!(
            part([-8.0, 0.5], [12.0, 0.5]),
            Some([[0.0, 0.5], [2.0, 0.5]])
        );
        assert_eq!(
            part([12.0, 0.5], [-8.0, 0.5]),
            Some([[2.0, 0.5], [0.0, 0.5]])
        );
        assert_eq!(
            part([0.5, 0.5], [1.0, 0.75]),
            Some([[0.5, 0.5], [1.0, 0.75]])
        );
        assert_eq!(part([-1.0, 2.0], [3.0, 2.0]), None);
        assert_eq!(part([-2.0, 0.0], [0.0, 3.0]), None);
        assert_eq!(part([3.0, -1.0], [3.0, 2.0]), None);
    }
}
