//! The solver as a library: problems with known answers.

mod accounts;
mod blocks;
mod collapse;
mod compressed;
mod contact_energy;
mod damping;
mod elastic_bar;
mod equations;
mod events;
mod fast;
mod finite;
mod friction;
mod halving;
mod invariants;
mod landing_return;
mod lcp_methods;
mod loads;
mod many;
mod mean_dilatation;
mod neo_hooke;
mod patch;
mod redistributed_mass;
mod rigid;
mod scales;
mod subincrements;
mod thin;
