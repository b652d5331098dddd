//! Sparse matrices with a fixed pattern, and their factorisations.
