//! **stickslip**: large-displacement dynamics of plane deformable bodies with exact contact and
//! Coulomb friction.
//!
//! A keyword deck is read ([`deck`], [`reader`]) into a [`model`]. The bodies of the model are integrated in time
//! ([`dynamics`]) with total-Lagrangian elements ([`elements`]) of hyperelastic [`materials`]. Every pass solves
//! [`contact`] (node to surface or surface to surface) as a linear complementarity problem ([`lcp`]), with sparse
//! factorisations ([`linear`]). [`output`] observes the run and writes the result file.
//!
//! # Layers
//!
//! A module imports only from modules before it in this list: `system`, `archive`, `linear`, `lcp`, `vectors`,
//! `diagnostics`, `materials`, `model`, `elements`, `deck`, `reader`, `flat_deck`, `editor`, `contact`, `prepare`,
//! `dynamics`, `output`, `cli`. The sub-folders of a layer also import in one direction only.
//!
//! # Packages
//!
//! All layers except `output` and `cli` are in separate packages (`crates`), so that little has to be compiled again
//! after a change of a file: `stickslip_system`, `stickslip_numerics`, `stickslip_mechanics`, `stickslip_decks`,
//! `stickslip_editor` and `stickslip_dynamics`. This crate re-exports the modules of the packages under their names.
//!
//! # Equations
//!
//! A formula stands above the code that evaluates it. `eq. (3.2)` is an equation in docs/theory, `paper eq. 21` an
//! equation of Sung & Kwak. A test compares each formula above the code with the equation in docs/theory.
//!
//! # Vocabulary
//!
//! | word | meaning |
//! |---|---|
//! | increment | one time step of the integrator, from time t to t + dt |
//! | pass | one predictor or corrector solve within an increment |
//! | pivot | one basis exchange of Lemke's method within a pass |
//! | slave, master | the node side and the segment side of a contact pair |
//! | segment | an edge of the master surface from node a to node b, with the body on its left |
//! | candidate | a segment that the search lists for a slave node |
//! | projection, xi | foot of the perpendicular from a node to a segment; xi is 0 at a and 1 at b |
//! | contact target | a segment, or the convex corner between two segments, that a slave node must not penetrate |
//! | corner | a node between two segments of a surface: convex or concave; sharp below 120 degrees |
//! | common normal | normal of contact between a node and a corner, from the normal cones of node and corner |
//! | interior | the inside of the bodies, followed from element to element behind a segment |
//! | slave index | number of a slave node among the slave nodes of all contacts |
//! | pair | one slave node with one contact target; a CONTACT PAIR of the deck is a *contact* |
//! | constraint | the condition g >= 0 with friction for one pair, linearised at the iterate |
//! | force rows Bn, Bt | nodal forces at the dofs of a constraint for a unit force Pn or Pt |
//! | derivative rows Gn, Gt | change of gap and slip of a constraint with its dofs |
//! | closed pair | a pair that carries a force |
//! | territory | circle that an entity does not leave as long as lists of candidates are valid |
//! | gap g | distance of the slave node from its segment, positive when open |
//! | normal e_n | unit vector out of the master body; tangent e_t points from a to b |
//! | crossing | the event that a node is on the moving line of a segment: it enters, leaves or touches the body |
//! | penetration | a slave node inside a body, at the start or at the end of an increment |
//! | slip Dt | tangential motion of the slave node relative to its segment within the increment |
//! | Pn, Pt | normal (>= 0) and tangential contact force of a pair |
//! | Phi, Psi | normal and tangential impact impulse of a pair |
//! | internal force F | nodal forces of the stresses; R is the external load, M the mass matrix, K the tangent |
//! | chunk, block, lane | elements that one thread sweeps; elements of a chunk that are computed together; one element of a block |
//! | damping force F_d | force of viscosity (BETA) and of mass-proportional damping (ALPHA), with the matrix Cd |
//! | K* | effective matrix theta2 K + Cd/dt + 2/dt^2 M; Q = G K*^-1 B^T is its Delassus matrix |
//! | compliance W | K*^-1 at the dofs in contact |
//! | scope | constraints whose compliance is computed together: those between the same bodies, or all |
//! | residual, correction | the two errors of a pass: out-of-balance force and last change of displacement |
//! | acceptance | checks of a converged increment before it is entered in the ledger |
//! | ledger | energies, impulses and works summed over the run, and their balance |
//! | redistributed mass M_r | consistent mass, in which other nodes carry the mass of nodes of contact surfaces |
//! | donor | a node with mass that carries the mass of a node without own mass, with a weight w_ij of the matrix P |
//! | release | a pair opens; nodes without mass come to rest and lose the energy R |
//! | landing | a node that closes its gap within an increment |
//! | landing return | the energy D lost to landing forces is given back as kinetic energy |
//! | pattern w, share y | velocities w along which landing energy is given back, and their factors y: V1 becomes V1 + sum y w |
//! | cutback | a failed attempt at an increment, which is repeated with a shorter increment |
//! | subincrement | part of a nominal increment, from a cutback or up to an impact |
//! | frame, history | frame: all fields at one time; history: numbers of every increment (both in the result file) |
//! | event | an impact that ends a subincrement (`IMPACT TIME=EVENT`) |
//! | nominal increment | an increment of the step's fixed grid; cutbacks and events divide it |
//! | d | displacement increment U1 - U0 |
//! | suffix 0, 1 | values at the start (0) and at the end (1) of the increment; V0+ is V0 after the impulses |

#![deny(missing_docs)]

pub mod cli;
pub mod output;
pub use stickslip_decks::{deck, flat_deck, reader};
pub use stickslip_dynamics::{contact, dynamics, prepare};
pub use stickslip_editor::editor;
pub use stickslip_mechanics::{diagnostics, elements, materials, model, vectors};
pub use stickslip_numerics::{archive, lcp, linear};
pub use stickslip_system::system;
