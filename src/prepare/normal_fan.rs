//! Fans of normals: which points a group of segments may face, without a look at each of them. Section
//! 10 of docs/theory.md, Initial gaps.

use std::f64::consts::{PI, TAU};

use crate::contact::project;
use crate::vectors::{Circle, difference, length};

/// Angle (rad) that covers the round-off of directions and projections beyond the ends of a segment.
const ANGLE_ROUND_OFF: f64 = 1e-5;

/// Normals of some segments and of those that follow them: all directions within an angle of the middle
/// one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NormalFan {
    /// Direction of the middle (rad).
    middle: f64,
    /// Largest angle from it (rad); pi for all directions.
    half: f64,
    /// Length of the longest segment.
    longest: f64,
}

impl NormalFan {
    /// The fan of a segment with the ends `[a, b]` and of the corner between it and the next.
    pub fn new([a, b]: [[f64; 2]; 2], next: Option<[[f64; 2]; 2]>) -> Self {
        let of = |[a, b]: [[f64; 2]; 2]| {
            let normal = project(a, a, b).normal;
            normal[1].atan2(normal[0])
        };
        let middle = of([a, b]);
        let turn = next.map_or(0.0, |next| turn(middle, of(next)));
        // legs that lie on each other may fold either way; a segment without length has no normal
        let is_clear = middle.is_finite() && turn.abs() < PI - ANGLE_ROUND_OFF;
        NormalFan {
            middle: if is_clear { middle + turn / 2.0 } else { 0.0 },
            half: if is_clear { turn.abs() / 2.0 } else { PI },
            longest: length(difference(a, b)),
        }
    }

    /// The fan of two groups.
    pub fn join(self, other: Self) -> Self {
        let apart = turn(self.middle, other.middle);
        let low = f64::min(-self.half, apart - other.half);
        let high = f64::max(self.half, apart + other.half);
        NormalFan {
            middle: self.middle + (low + high) / 2.0,
            half: f64::min((high - low) / 2.0, PI),
            longest: self.longest.max(other.longest),
        }
    }

    /// Whether a point may face one of the segments, all of them within a circle.
    ///
    /// The point p lies along a normal of the fan from some place of the circle, in front of it, or
    /// behind it by no more than the longest segment h: the angle phi between p - c and the middle of the
    /// fan is at most alpha + beta, sin beta = r/|p - c|, or at least pi - alpha - beta with
    /// |p - c| cos(phi - alpha) + r >= -h.
    pub fn may_face(&self, point: [f64; 2], circle: &Circle) -> bool {
        let d = difference(circle.centre, point);
        let distance = length(d);
        let beta = (circle.radius / distance).asin();
        if !(circle.radius < distance && beta.is_finite()) {
            return true;
        }
        let phi = turn(self.middle, d[1].atan2(d[0])).abs();
        let reach = self.half + beta + ANGLE_ROUND_OFF;
        let nearest = (phi - self.half - ANGLE_ROUND_OFF).max(0.0);
        let is_shallow = || distance * nearest.cos() + circle.radius >= -self.longest;
        phi <= reach || (PI - phi <= reach && is_shallow())
    }
}

/// Angle from one direction to another, between -pi and pi.
fn turn(from: f64, to: f64) -> f64 {
    let turn = (to - from).rem_euclid(TAU);
    if turn > PI { turn - TAU } else { turn }
}
