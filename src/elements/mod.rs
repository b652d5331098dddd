//! Plane total-Lagrangian elements: mass, internal force and tangent as pure functions.
