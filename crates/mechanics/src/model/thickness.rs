//! Extent of an element across the plane. See docs/theory/elements.md, Bodies of revolution.

use std::f64::consts::TAU;

use super::ElementType;

/// Extent of an element across the plane, by which an area in the plane becomes a volume and a length becomes an area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Thickness {
    /// The same thickness everywhere (length).
    Of(f64),
    /// The full circle around the axis x = 0.
    Around,
}

impl Thickness {
    /// Extent of elements of a type in a section whose thickness (length) applies only in the plane.
    pub fn new(element_type: ElementType, thickness: f64) -> Self {
        match element_type.is_ring() {
            true => Thickness::Around,
            false => Thickness::Of(thickness),
        }
    }

    /// Factors of the extent: the constant thickness or 1, and in a ring the distance of a place
    /// from the axis.
    pub(super) fn parts(self, radius: f64) -> (f64, Option<f64>) {
        match self {
            Thickness::Of(thickness) => (thickness, None),
            Thickness::Around => (1.0, Some(radius)),
        }
    }

    /// Extent at a distance from the axis: t, or 2 pi R (length).
    pub fn at(self, radius: f64) -> f64 {
        match self {
            Thickness::Of(thickness) => thickness,
            Thickness::Around => TAU * radius,
        }
    }
}
