//! Plane bodies as data: the model, its materials and its elements.

#![deny(missing_docs)]

pub mod diagnostics;
pub mod elements;
pub mod materials;
pub mod model;
pub mod vectors;

use stickslip_numerics::{lcp, linear};
