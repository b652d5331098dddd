//! Bodies as wholes: how they are held, and their angles.

mod body_angles;
mod hold;

pub(crate) use body_angles::BodyAngles;
pub(crate) use hold::{Hold, holds};
