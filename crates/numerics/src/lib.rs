//! Sparse factorisations and complementarity problems; the package knows nothing of mechanics.

#![deny(missing_docs)]

pub mod archive;
pub mod lcp;
pub mod linear;

use stickslip_system::system;
