//! What only some operating systems have, with a portable fallback: the module `system`.

#![deny(missing_docs)]

pub mod system;
