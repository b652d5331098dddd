//! Contact targets of a slave node: the segments and corners that it may not go through.

mod corner;
mod pairing;
mod slave_node;
mod target_selection;

pub use corner::{Vertex, common_normal};
pub use pairing::{PairSite, Pairing, find_pairs};
pub use slave_node::Look;
pub(crate) use slave_node::{PENETRATING, TOUCHING};
pub(crate) use target_selection::ROUND_OFF;
pub use target_selection::Site;
