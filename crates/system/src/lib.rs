//! Functions that only some operating systems have, with a portable fallback, in the module `system`.

#![deny(missing_docs)]

pub mod system;
