//! The problem as plain data: indices resolved, no text.
