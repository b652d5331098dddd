//! Work of friction, depth of wear and heat at the nodes of slave surfaces since the start. See docs/theory/impacts.md,
//! Wear and heat.

use super::contact_ledger::ContactLedger;
use super::pair_work::{PairWork, given_back};
use crate::archive::{Archive, ArchiveError, transfer_fields};
use crate::contact::SurfaceParts;
use crate::dynamics::increment::Solved;
use crate::dynamics::results::FrictionResults;
use crate::dynamics::step::{SlaveFaces, StepProblem};
use crate::linear::{larger, largest};
use crate::model::{Contact, Model};

/// Sums over the run, if the deck asks for wear or heat.
pub(crate) struct SurfaceWork {
    fields: FrictionResults,
    /// Sums over the run of all that was added to the nodes (work, volume of wear, heat), and the sums of the absolute
    /// values.
    added: [Sums; 2],
    /// For each contact the wear and heat of its surfaces, if any.
    contacts: Vec<Option<Surfaces>>,
}

/// Work of friction (energy), volume of wear (length^3) and heat (energy).
type Sums = [f64; 3];

/// Wear and heat that the work of friction causes on the surfaces of a contact.
#[derive(Debug, Clone, Copy)]
struct Surfaces {
    /// Whether both surfaces are slaves, for example because a surface touches itself.
    both: bool,
    /// Depth of wear per unit of the measure of wear (length^2/force), and whether this measure is the work of
    /// friction.
    wear: Option<(f64, bool)>,
    /// Part of the work of friction that heats each slave surface.
    heat: f64,
    /// Whether all slave nodes have faces; the centres of discs have no faces.
    has_faces: bool,
}

impl Surfaces {
    /// The surfaces of a contact; `None` if the contact has neither wear nor heat.
    fn new(model: &Model, contact: &Contact, faces: &SlaveFaces) -> Option<Self> {
        let interaction = &contact.interaction;
        let both = contact.is_self_contact();
        // in self-contact neither side is the slave for which the part is given
        let of_each = |to_slave: f64| if both { 0.5 } else { to_slave };
        let own = Surfaces {
            both,
            wear: interaction.wear.map(|wear| (wear.rate, wear.by_friction)),
            heat: (interaction.heat).map_or(0.0, |heat| heat.part * of_each(heat.to_slave)),
            has_faces: (model.slave_nodes(contact).into_iter()).all(|node| faces.has_faces(node)),
        };
        (interaction.wear.is_some() || interaction.heat.is_some()).then_some(own)
    }

    /// Work, volume of wear and heat of all surfaces of the contact, from the work of friction and from normal force
    /// times sliding path.
    fn sums(&self, friction: f64, sliding: f64) -> Sums {
        let count = if self.both { 2.0 } else { 1.0 };
        let on_faces = if self.has_faces { count } else { 0.0 };
        let worn = self.wear.map_or(0.0, |(rate, by_friction)| {
            rate * if by_friction { friction } else { sliding }
        });
        [
            on_faces * friction,
            on_faces * worn,
            count * self.heat * friction,
        ]
    }
}

impl SurfaceWork {
    /// The sums at the start of a run. The sums are 0 at the nodes of slave surfaces with wear or heat and NaN
    /// elsewhere; work and wear are also NaN at nodes without faces.
    pub fn new(model: &Model, faces: &SlaveFaces) -> Self {
        let of_contact = |contact: &Contact| Surfaces::new(model, contact, faces);
        let contacts: Vec<Option<Surfaces>> = model.contacts.iter().map(of_contact).collect();
        let [mut start, mut on_faces] = [(); 2].map(|()| vec![f64::NAN; model.mesh.node_count()]);
        let with_own = model.contacts.iter().zip(&contacts);
        for (contact, _) in with_own.filter(|(_, own)| own.is_some()) {
            let nodes = match model.disc(contact) {
                Some(disc) => vec![disc.centre],
                None => model.surfaces[contact.slave].nodes(&model.mesh),
            };
            for node in nodes {
                start[node] = 0.0;
                if faces.has_faces(node) {
                    on_faces[node] = 0.0;
                }
            }
        }
        let where_asked = |is_asked: bool, start: &[f64]| match is_asked {
            true => start.to_vec(),
            false => Vec::new(),
        };
        let interactions = || model.contacts.iter().map(|contact| &contact.interaction);
        let has_wear = interactions().any(|own| own.wear.is_some());
        let has_heat = interactions().any(|own| own.heat.is_some());
        SurfaceWork {
            fields: FrictionResults {
                coefficient: Vec::new(),
                work: where_asked(has_wear || has_heat, &on_faces),
                wear: where_asked(has_wear, &on_faces),
                heat: where_asked(has_heat, &start),
            },
            added: [[0.0; 3]; 2],
            contacts,
        }
    }

    /// Transfers the sums to or from an archive.
    pub fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        let FrictionResults {
            coefficient: _,
            work,
            wear,
            heat,
        } = &mut self.fields;
        archive.transfer_values(work)?;
        archive.transfer_values(wear)?;
        archive.transfer_values(heat)?;
        transfer_fields!(archive, self => Self { added; fields, contacts })
    }

    /// Work, wear and heat so far.
    pub fn results(&self) -> FrictionResults {
        self.fields.clone()
    }

    /// Enters the works of the pairs in a converged increment. With the work of friction D of a pair, the part f of a
    /// node in its normal force, and the area A of the node for this force:
    ///
    /// ```text
    /// w += f D/A,  h += k/H f Pn |Bt d|/A  or  k/H f D/A,  q += eta s f D    eq. (9.15)
    /// ```
    pub fn enter(
        &mut self,
        problem: &StepProblem,
        faces: &SlaveFaces,
        solved: &Solved,
        works: &[PairWork],
    ) {
        if self.fields.work.is_empty() {
            return;
        }
        for work in works.iter().chain(&given_back(solved)) {
            self.add(problem, faces, solved, work);
        }
    }

    /// Adds the work of a pair to the nodes of its slave surfaces.
    fn add(&mut self, problem: &StepProblem, faces: &SlaveFaces, solved: &Solved, work: &PairWork) {
        let Some(own) = self.contacts[work.key.contact()] else {
            return;
        };
        let at = |node: usize| problem.position(&solved.equilibrium.u_theta, node);
        let count = if own.both { 2 } else { 1 };
        for SurfaceParts { normal, parts } in &work.surfaces[..count] {
            for &(node, part) in parts {
                let (friction, sliding) = (part * work.friction, part * work.sliding);
                let area = match faces.area(node, *normal, at) {
                    // a node at a corner, whose faces are parallel to the normal
                    0.0 => faces.whole_area(node, at),
                    area => area,
                };
                let mut added = [0.0; 3];
                // sums over nodes are compared only if all nodes have faces
                let is_told = if own.has_faces { 1.0 } else { 0.0 };
                if area > 0.0 {
                    self.fields.work[node] += friction / area;
                    added[0] = is_told * friction;
                }
                if let Some((rate, by_friction)) = own.wear.filter(|_| area > 0.0) {
                    let by = if by_friction { friction } else { sliding };
                    self.fields.wear[node] += rate * by / area;
                    added[1] = is_told * rate * by;
                }
                if let Some(heat) = self.fields.heat.get_mut(node) {
                    *heat += own.heat * friction;
                    added[2] = own.heat * friction;
                }
                for (k, added) in added.into_iter().enumerate() {
                    self.added[0][k] += added;
                    self.added[1][k] += added.abs();
                }
            }
        }
    }

    /// Largest difference between the sums over the nodes and the sums of the contacts in the ledger, relative to the
    /// sums of absolute values.
    pub fn difference(&self, ledger: &ContactLedger) -> f64 {
        let [mut missing, sizes] = self.added;
        let mut scales = sizes;
        for (own, (friction, sliding)) in self.contacts.iter().zip(ledger.slid()) {
            let sums = own.map_or([0.0; 3], |own| own.sums(friction, sliding));
            for k in 0..3 {
                missing[k] -= sums[k];
                scales[k] = larger(scales[k], sums[k].abs());
            }
        }
        let parts = missing.iter().zip(scales);
        let parts = parts.filter(|(_, scale)| *scale > 0.0);
        largest(
            &parts
                .map(|(missing, scale)| missing / scale)
                .collect::<Vec<_>>(),
        )
    }
}
