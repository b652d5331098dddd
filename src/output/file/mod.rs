//! The result file: claim of its name, groups and datasets, reserved disk space.

mod body_times;
mod claim;
mod clock;
mod dataset;
mod mesh;
pub(crate) mod model;
mod names;
mod record;
mod regular;
mod series;
mod space;
mod vtkhdf;

pub(crate) use body_times::{BodyTimes, body_times};
pub use claim::Claim;
pub(crate) use clock::utc_now;
pub(crate) use dataset::{Column, Meaning, constant, group, meaning};
pub use names::{check_names, contact_names};
pub(crate) use record::{Record, phases};
pub use record::{RunRecord, UNFINISHED};
pub use regular::regular_file;
pub(crate) use series::{Scalar, Series, scalar};
pub(crate) use space::Space;
pub(crate) use vtkhdf::Fields;
