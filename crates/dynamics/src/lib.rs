//! Contact and time integration of the model.

#![deny(missing_docs)]

pub mod contact;
pub mod dynamics;
pub mod prepare;

#[cfg(test)]
use stickslip_mechanics::materials;
use stickslip_mechanics::{diagnostics, elements, model, vectors};
use stickslip_numerics::{archive, lcp, linear};
