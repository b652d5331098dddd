//! Linear complementarity problems, general and frictional. Knows no mechanics.
