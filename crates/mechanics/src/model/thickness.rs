//! How far an element extends across the plane. See docs/theory/elements.md, Bodies of revolution.

use std::f64::consts::TAU;

use super::ElementType;

/// Extent of an element across the plane, by which areas of the plane become volumes and lengths become areas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Thickness {
    /// The same everywhere (length).
    Of(f64),
    /// Once around the axis x = 0.
    Around,
}

impl Thickness {
    /// That of elements of a type in a section of a thickness (length), which counts in the plane alone.
    pub fn new(element_type: ElementType, thickness: f64) -> Self {
        match element_type.is_ring() {
            true => Thickness::Around,
            false => Thickness::Of(thickness),
        }
    }

    /// The part that is the same everywhere, and the distance of a place from the axis where there is another.
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
