//! Bulges of curved faces: distance of a face outwards from the chord of a segment, and gaps to the face. See
//! docs/theory/geometry.md, Curved faces.

use super::projection::Projection;
use super::tolerances::EQUAL_SLOPES;
use crate::vectors::length;

/// Bulge of a segment: distance b of its curved face from its chord, outwards from the body, constant in a run
/// (length):
///
/// ```text
/// b(xi) = c0 + c1 xi + c2 xi² + c3 xi³    eq. (3.26)
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Bulge {
    /// The coefficients c0 to c3 of b(xi).
    coefficients: [f64; 4],
    /// Whether the face goes on as a straight line beyond the ends of the segment. For nodes the face goes straight on
    /// beyond the ends of the segment: a node comes over an end before it changes its segment. For points of faces the
    /// cubic goes on beyond the ends of the segment: a point changes its segment at the bisector, and integration over
    /// points needs one cubic.
    goes_straight_on: bool,
}

impl Bulge {
    /// The bulge of a straight face.
    pub const FLAT: Bulge = Bulge {
        coefficients: [0.0; 4],
        goes_straight_on: false,
    };

    /// Bulge from the slopes of the true face against its chord, outwards from the `start` and from the `end` of the
    /// segment:
    ///
    /// ```text
    /// b = l (tau_a xi (1 - xi)² + tau_b xi² (1 - xi)),  tau = t - t³/5 + 3 t⁵/35
    /// ```
    ///
    /// With tau = t the cubic would have the slopes t of the face, and its mean distance from an arc would be 8/15 of
    /// its greatest distance. With the given tau the area between chord and arc is right to the seventh order, tau = 3
    /// ((1 + t²) atan t - t)/(2 t²). The greatest distance from the arc is a fifth of that with tau = t, and the slopes
    /// are right to the third order.
    pub(super) fn of_slopes(length: f64, slopes: [f64; 2]) -> Self {
        let [start, end] = slopes.map(|t| {
            let square = t * t;
            t * (1.0 - square / 5.0 + 3.0 * square * square / 35.0)
        });
        // on a circle the cubic is a parabola, for which two Gauss points are enough
        let end = match (start - end).abs() <= EQUAL_SLOPES * start.abs() {
            true => start,
            false => end,
        };
        let c = [0.0, start, end - 2.0 * start, start - end];
        Bulge {
            coefficients: c.map(|c| length * c),
            goes_straight_on: true,
        }
    }

    /// A steep cubic bulge, for tests.
    #[cfg(test)]
    pub(super) fn steep(length: f64) -> Self {
        Bulge::of_slopes(length, [0.3, 0.15])
    }

    /// Bulge of one half of a side with a mid-side node: the parabola over the chord from a corner to this node, which
    /// lies `rise` outside the line between the corners (length).
    pub(super) fn of_side(rise: f64) -> Self {
        Bulge {
            coefficients: [0.0, rise, -rise, 0.0],
            goes_straight_on: true,
        }
    }

    /// Bulge of a chord of an arc with the given radius, negative where the body is outside the circle: t = tan(phi/2),
    /// sin(phi/2) = l/(2 R).
    pub(super) fn of_arc(length: f64, radius: f64) -> Self {
        let sine = length / (2.0 * radius);
        let cosine = (1.0 - sine * sine).max(0.0).sqrt();
        match cosine > 0.0 {
            true => Bulge::of_slopes(length, [sine / cosine; 2]),
            false => Bulge::FLAT,
        }
    }

    /// The same bulge for points of faces: its cubic goes on beyond the ends of the segment. An end that is a mid-side
    /// node (`is_between`) is replaced by the vertex x_v of eq. (3.21).
    pub(super) fn of_points(self, is_between: [bool; 2]) -> Self {
        let [_, rise, ..] = self.coefficients;
        let coefficients = match is_between {
            [false, true] => [0.0, 2.0 / 3.0, -1.0, 0.0].map(|c| rise * c),
            [true, false] => [-1.0 / 3.0, 4.0 / 3.0, -1.0, 0.0].map(|c| rise * c),
            _ => self.coefficients,
        };
        Bulge {
            coefficients,
            goes_straight_on: false,
        }
    }

    /// Whether the face is straight.
    #[inline]
    pub fn is_flat(&self) -> bool {
        self.coefficients == [0.0; 4]
    }

    /// The coefficients c0 to c3 of the bulge (length).
    pub fn coefficients(&self) -> [f64; 4] {
        self.coefficients
    }

    /// Whether the third derivative of the bulge is not zero.
    pub(super) fn is_cubic(&self) -> bool {
        self.coefficients[3] != 0.0
    }

    /// The end (0 or 1) of the segment beyond which xi lies, from where the face goes straight on; between the ends xi
    /// itself.
    #[inline]
    fn end_before(&self, xi: f64) -> f64 {
        match self.goes_straight_on {
            true => xi.clamp(0.0, 1.0),
            false => xi,
        }
    }

    /// b(xi) (length).
    #[inline]
    pub fn at(&self, xi: f64) -> f64 {
        let [c0, c1, c2, c3] = self.coefficients;
        let end = self.end_before(xi);
        let within = c0 + end * (c1 + end * (c2 + end * c3));
        match xi == end {
            true => within,
            false => within + self.slope(end) * (xi - end),
        }
    }

    /// b'(xi) (length).
    pub fn slope(&self, xi: f64) -> f64 {
        let [_, c1, c2, c3] = self.coefficients;
        let end = self.end_before(xi);
        c1 + end * (2.0 * c2 + end * 3.0 * c3)
    }

    /// b''(xi) (length).
    pub(super) fn second_derivative(&self, xi: f64) -> f64 {
        let [_, _, c2, c3] = self.coefficients;
        match xi == self.end_before(xi) {
            true => 2.0 * c2 + 6.0 * c3 * xi,
            false => 0.0,
        }
    }

    /// Secant D = (b(y) - b(x))/(y - x) without cancellation, and its derivative with respect to y (both length):
    ///
    /// ```text
    /// D = c1 + c2 (x + y) + c3 (x² + x y + y²),  dD/dy = c2 + c3 (x + 2 y)    eq. (3.29)
    /// ```
    pub(super) fn secant(&self, x: f64, y: f64) -> [f64; 2] {
        let [_, c1, c2, c3] = self.coefficients;
        let [p, q] = [x, y].map(|xi| self.end_before(xi));
        let within = c1 + c2 * (p + q) + c3 * (p * p + p * q + q * q);
        if [p, q] == [x, y] {
            return [within, c2 + c3 * (p + 2.0 * q)];
        }
        if p == q {
            return [self.slope(p), 0.0];
        }
        // straight parts before and after
        let sum = within * (q - p) + self.slope(q) * (y - q) - self.slope(p) * (x - p);
        let secant = sum / (y - x);
        [secant, (self.slope(y) - secant) / (y - x)]
    }

    /// A projection on the chord with the gap to the curved face, G = g - b(xi), eq. (3.27).
    #[inline]
    pub fn below(&self, p: Projection) -> Projection {
        match self.is_flat() {
            true => p,
            false => Projection {
                gap: p.gap - self.at(p.xi),
                ..p
            },
        }
    }

    /// Unit tangent of the face at an end of the segment (0 or 1), p being a projection on its chord.
    pub(super) fn tangent(&self, p: &Projection, end: f64) -> [f64; 2] {
        if self.is_flat() {
            return p.tangent;
        }
        // the chord changes its length with the deformation, the height of the bulge does not
        let slope = self.slope(end) / p.length;
        let t = [0, 1].map(|i| p.tangent[i] + slope * p.normal[i]);
        let length = length(t);
        t.map(|t| t / length)
    }
}

/// Lift: the amount by which the gap of a node counts more than its gap to the chord of the segment. The lift is the
/// overlap that a fit allows, less the bulge of the face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lift {
    /// The overlap that a fit allows (length).
    pub allowed: f64,
    /// The bulge.
    pub bulge: Bulge,
}

impl Lift {
    /// Whether the lift is zero, so gaps are relative to the chord.
    pub fn is_none(&self) -> bool {
        self.allowed == 0.0 && self.bulge.is_flat()
    }

    /// Lift at a place xi of the segment (length).
    pub fn at(&self, xi: f64) -> f64 {
        match self.bulge.is_flat() {
            true => self.allowed,
            false => self.allowed - self.bulge.at(xi),
        }
    }

    /// A projection on the chord with the lift added to its gap.
    pub fn of(&self, p: Projection) -> Projection {
        p.raised(self.at(p.xi))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn secants_are_those_of_the_cubic_and_of_its_straight_ends() {
        let bulge = Bulge::steep(1.0);
        for (from, to) in [
            (0.2, 0.7),
            (-0.3, 0.4),
            (0.9, 1.4),
            (-0.2, 1.3),
            (1.2, 1.5),
            (0.3, 0.3),
        ] {
            let [secant, change] = bulge.secant(from, to);
            let expected = match from == to {
                true => bulge.slope(from),
                false => (bulge.at(to) - bulge.at(from)) / (to - from),
            };
            assert!((secant - expected).abs() < 1e-14, "{from} {to}");
            let quotient =
                (bulge.secant(from, to + 1e-6)[0] - bulge.secant(from, to - 1e-6)[0]) / 2e-6;
            assert!(
                (change - quotient).abs() < 1e-8,
                "{from} {to} {change} {quotient}"
            );
        }
    }

    #[test]
    fn the_area_between_chord_and_arc_is_right() {
        let radius = 2.0;
        for angle in [1e-3, 0.1, 0.4, -0.3_f64] {
            let length = 2.0 * radius * (angle.abs() / 2.0).sin();
            let bulge = Bulge::of_arc(length, radius.copysign(angle));
            let [c0, c1, c2, c3] = bulge.coefficients();
            let area = length * (c0 + c1 / 2.0 + c2 / 3.0 + c3 / 4.0);
            let arc = radius * radius / 2.0 * (angle - angle.sin());
            let left = (angle / 2.0).tan().powi(6) / 20.0;
            assert!(
                (area / arc - 1.0).abs() < left + 1e-9,
                "{angle} {area} {arc}"
            );
        }
    }
}
