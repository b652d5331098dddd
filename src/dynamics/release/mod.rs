//! Nodes without mass after a release: they come to rest. Section 6 of docs/theory.md, Releases.

mod free_nodes;
mod rest;

pub(crate) use rest::{ReleaseStart, bring_to_rest};
