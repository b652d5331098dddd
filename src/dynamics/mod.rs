//! Time integration with contact and impact.
