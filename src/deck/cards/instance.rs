//! Instances of parts: a name for each copy of a part, and where its nodes are.

use crate::deck::lines::Name;

/// An instance of a part.
#[derive(Debug, Clone, PartialEq)]
pub struct Instance {
    /// Its name.
    pub name: Name,
    /// Where its nodes are.
    pub placement: Placement,
}

/// A translation and, after it, a rotation about a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Placement {
    /// The translation (length).
    pub translation: [f64; 2],
    /// Centre (length), and cosine and sine of the angle of the rotation.
    pub rotation: Option<([f64; 2], [f64; 2])>,
}

impl Placement {
    /// Where a point of the part is (length): `c + R (x + t - c)`.
    pub fn of(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [x, y] = [x + self.translation[0], y + self.translation[1]];
        let Some(([a, b], [cosine, sine])) = self.rotation else {
            return [x, y];
        };
        let [x, y] = [x - a, y - b];
        [a + cosine * x - sine * y, b + sine * x + cosine * y]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_moved_and_then_turned() {
        let moved = Placement {
            translation: [2.0, 1.0],
            rotation: None,
        };
        assert_eq!(moved.of([1.0, 0.0]), [3.0, 1.0]);
        let turned = Placement {
            rotation: Some(([1.0, 1.0], [0.0, 1.0])),
            ..moved
        };
        assert_eq!(turned.of([1.0, 0.0]), [1.0, 3.0]);
    }
}
