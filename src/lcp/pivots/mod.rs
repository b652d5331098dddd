//! Lemke's method: basis, ratio test and path, for general and for frictional problems.

mod basis;
mod factors;
mod frictional_lemke;
mod lemke;
mod pivoting;
mod ratio;
mod settings;

pub(crate) use factors::Factors;
pub(crate) use frictional_lemke::lemke_forces;
pub use lemke::{covering_vector, lemke};
pub(crate) use ratio::perturbation;
pub use settings::LemkeSettings;
