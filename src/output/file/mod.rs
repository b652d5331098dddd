//! The result file: claim of its name, groups and datasets, reserved disk space.

mod body_times;
mod claim;
mod clock;
mod column;
mod dataset;
mod grid;
pub(crate) mod model;
mod names;
mod record;
mod regular;
mod series;
mod space;

pub(crate) use body_times::{BodyTimes, body_times};
pub use claim::Claim;
pub(crate) use clock::utc_now;
pub(crate) use column::{Column, Columns, Growing};
pub(crate) use dataset::{Meaning, ROWS, constant, counter, group, meaning};
pub(crate) use grid::{ENERGY_DENSITY, Fields, LOGARITHMIC_STRAIN};
pub use names::{check_names, contact_names};
pub(crate) use record::{Record, phases};
pub use record::{RunRecord, UNFINISHED};
pub use regular::regular_file;
pub(crate) use series::{Scalar, Series, growing, scalar};
pub(crate) use space::Space;
