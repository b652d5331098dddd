//! The elements of all bodies of a model, and what is asked of them together.

mod damped;
mod elements;
mod inertia;
mod mean_gradient;
mod sweeps;

pub use elements::Elements;
pub use inertia::ElementInertia;
pub use mean_gradient::MeanGradient;
pub use sweeps::{Inverted, Updated};
