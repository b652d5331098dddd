//! Contact targets of a slave node: the segments and corners that it may not go through.

mod corner;
mod pairing;
mod slave_node;
mod target_selection;

pub use corner::{Corner, common_normal};
pub use pairing::{PairTarget, find_targets};
pub use slave_node::SlaveNode;
pub use target_selection::ContactTarget;
pub(super) use target_selection::{position_round_off, rise};
