//! Arcs of rigid masters, which discs meet. See docs/theory/geometry.md, Discs.

use std::ops::Range;

use crate::model::{CircleArc, RigidProfile};
use crate::vectors::{cross, difference, dot};

/// An arc about a point that moves with two nodes p and q of the master: x_c = x_p + alpha e + beta J e, e = x_q - x_p.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MasterArc {
    /// The factors alpha and beta of the centre x_c.
    pub place: [f64; 2],
    /// Radius (length): negative where the body is outside the circle, 0 for a vertex.
    pub radius: f64,
}

impl MasterArc {
    /// The vertex at node p: an arc of radius 0.
    pub(super) const VERTEX: MasterArc = MasterArc {
        place: [0.0; 2],
        radius: 0.0,
    };

    /// Centre of the arc where its nodes p and q are at given places.
    pub(super) fn centre(&self, [p, q]: [[f64; 2]; 2]) -> [f64; 2] {
        let ([alpha, beta], [x, y]) = (self.place, difference(p, q));
        [p[0] + alpha * x - beta * y, p[1] + alpha * y + beta * x]
    }

    /// Distance of the point `s` from the body where p and q are at given places: |s - x_c| - R, or R - |s - x_c| in a
    /// hole.
    pub(super) fn gap(&self, s: [f64; 2], nodes: [[f64; 2]; 2]) -> f64 {
        let [x, y] = difference(self.centre(nodes), s);
        self.sign() * x.hypot(y) - self.radius
    }

    /// Sign of the radius: 1, or -1 where the body is outside the circle.
    pub(super) fn sign(&self) -> f64 {
        match self.radius < 0.0 {
            true => -1.0,
            false => 1.0,
        }
    }
}

/// An arc of a rigid master.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceArc {
    /// Its chords.
    pub segments: Range<usize>,
    /// Nodes at the ends of the arc.
    pub nodes: [usize; 2],
    /// Centre and radius of the arc.
    pub arc: MasterArc,
    /// First chord of the first arc on the same circle; it numbers the constraints of the circle.
    pub circle: usize,
}

impl SurfaceArc {
    /// An arc of a profile; `x` are the reference coordinates of the nodes.
    pub(super) fn new(profile: &RigidProfile, arc: &CircleArc, x: &[[f64; 2]]) -> Self {
        let Range { start, end } = arc.segments;
        let nodes = [profile.segments[start][0], profile.segments[end - 1][1]];
        let [p, q] = nodes.map(|node| x[node]);
        let (e, r) = (difference(p, q), difference(p, arc.centre));
        // the centre is as far from p as from q
        let (square, beta) = (dot(e, e), cross(e, r) / dot(e, e));
        let radius = (square * (0.25 + beta * beta)).sqrt();
        let mut others = profile.arcs.iter().filter(|other| other.is_of_circle(arc));
        SurfaceArc {
            circle: others.next().map_or(start, |first| first.segments.start),
            segments: arc.segments.clone(),
            nodes,
            arc: MasterArc {
                place: [0.5, beta],
                radius: radius.copysign(beta),
            },
        }
    }
}
