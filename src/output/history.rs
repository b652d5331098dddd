//! Group `/history`. Energies, solver, nodes, elements, bodies, contacts and rigid surfaces have one row per increment;
//! row 0 is the start. Impacts, returns and touches have one row per event.

use std::rc::Rc;
use std::sync::Arc;

use hdf5::Group;

use super::column::{
    GrowingColumns, Layout, Meaning, Mostly, ROWS, constant, group, text_attribute,
};
use super::fields::{ENERGY_DENSITY, PLASTIC_STRAIN};
use super::local::Local;
use super::model_group::contact_names;
use super::strain::SmallStrainElements;
use crate::dynamics::{
    BodyResult, ContactOnBody, ContactResultant, Energy, IncrementReport, Landing, Momentum,
    ReturnedImpulse, RigidReaction, SolverCounts, Touch, rigid_inertia,
};
use crate::elements::{
    ConnectorState, ElementInertia, ElementResult, Elements, LocalResult, MeanGradient,
    logarithmic_of,
};
use crate::model::{
    Bodies, ConnectorDirection, Contact, HistorySet, Incrementation, LandingRule, Model, RigidBody,
    Set, Step,
};
use crate::vectors::cross;

/// Value of a dataset in a record `Q`.
enum DatasetContent<Q> {
    Real(fn(&Q) -> f64),
    Vector(fn(&Q) -> [f64; 2]),
    Tensor(fn(&Q) -> [f64; 3]),
    Count(fn(&Q) -> usize),
    Flag(fn(&Q) -> bool),
    /// A node, given by its index; the dataset holds its number in the deck.
    Node(fn(&Q) -> usize),
    Segment(fn(&Q) -> [usize; 2]),
    /// Two bodies; -1 means no body.
    Bodies(fn(&Q) -> [Option<usize>; 2]),
}

use DatasetContent::{Count, Flag, Node, Real, Segment, Tensor, Vector};

/// A dataset of the records `Q`: name, dimension, description, and value.
type DatasetEntry<Q> = (&'static str, &'static str, &'static str, DatasetContent<Q>);

/// The datasets of the history while they are created.
pub(crate) struct History<'m> {
    model: &'m Model,
    columns: GrowingColumns<'m, IncrementReport>,
}

impl<'m> History<'m> {
    /// Creates the group without rows.
    pub fn create(
        root: &Group,
        model: &'m Model,
        local: &Arc<Elements>,
    ) -> hdf5::Result<GrowingColumns<'m, IncrementReport>> {
        let at = group(root, "history")?;
        let mut history = History {
            model,
            columns: GrowingColumns::new(),
        };
        history.columns.count(&at, ROWS, |_| 1)?;
        history.table(&at, &[], &INCREMENT, |r, each| each(r))?;
        let decides =
            |step: &Step| matches!(step.increments.incrementation, Incrementation::Error { .. });
        if model.steps.iter().any(decides) {
            let meaning = (
                "1",
                "truncation error beside the largest displacement of the step so far",
            );
            history.add(&at, "truncation_error", &[], meaning, |r, values| {
                values.push(r.truncation_error.unwrap_or(f64::NAN));
            })?;
        }
        let energy = group(&at, "energy")?;
        history.table(&energy, &[], &ENERGY, |r, each| each(&r.energy))?;
        if model.has_hourglass_modes() {
            let meaning = ("energy", "the part of the strain energy in hourglass modes");
            history.add(&energy, "hourglass", &[], meaning, |r, v| {
                v.push(r.energy.hourglass);
            })?;
        }
        history.create_momentum(&group(&at, "momentum")?)?;
        let bodies = [Bodies::new(&model.mesh).count];
        history.table(&group(&at, "bodies")?, &bodies, &BODY, |r, each| {
            r.bodies.iter().for_each(each);
        })?;
        history.create_strain(&group(&at, "strain")?)?;
        let contacts = group(&at, "contact")?;
        for (k, (contact, name)) in model.contacts.iter().zip(contact_names(model)).enumerate() {
            history.create_contact(&group(&contacts, &name)?, k, contact, &bodies)?;
        }
        history.create_connectors(&at)?;
        history.create_ties(&at)?;
        history.create_hinges(&at)?;
        history.create_events(&at)?;
        let surfaces = group(&at, "rigid")?;
        let inertia = rigid_inertia(model);
        for (k, (body, [mass, _])) in model.rigid_bodies.iter().zip(inertia).enumerate() {
            let moves = body.turns || mass > 0.0;
            history.create_rigid(&group(&surfaces, &body.name)?, k, (body, moves))?;
        }
        let nodes = group(&at, "nodes")?;
        for (asked, set) in requested(&model.sets.history, &model.sets.nodes) {
            history.create_nodes(&group(&nodes, &set.name)?, &set.members, asked.each_member)?;
        }
        let elements = group(&at, "elements")?;
        for (asked, set) in requested(&model.sets.element_history, &model.sets.elements) {
            let at = group(&elements, &set.name)?;
            history.create_elements(&at, &set.members, asked.each_member)?;
            if asked.at_points {
                history.create_points(&group(&at, "points")?, &set.members, local)?;
            }
            if asked.at_nodes {
                history.create_element_nodes(&group(&at, "at_nodes")?, &set.members, local)?;
            }
        }
        history.table(&group(&at, "solver")?, &[], &SOLVER, |r, each| {
            each(&r.solver)
        })?;
        Ok(history.columns)
    }

    /// Writes the numbers of nodes (indices) in the deck.
    fn labels(&self, at: &Group, nodes: &[usize], text: &'static str) -> hdf5::Result<()> {
        let label = |&node: &usize| self.model.mesh.node_labels[node] as i64;
        let labels: Vec<i64> = nodes.iter().map(label).collect();
        constant(at, "labels", &[labels.len()], &labels, ("1", text))
    }

    /// Creates a dataset of reals; `values` appends the row of a report.
    fn add(
        &mut self,
        at: &Group,
        name: &str,
        row: &[usize],
        meaning: Meaning,
        values: impl FnMut(&IncrementReport, &mut Vec<f64>) + 'm,
    ) -> hdf5::Result<()> {
        let layout = Layout::one_by_one::<f64>(row, Mostly::Varied);
        self.columns.add(at, name, layout, meaning, values)
    }

    /// Creates the datasets of vectors over the dofs, of which `values` appends a row.
    fn vectors(
        &mut self,
        at: &Group,
        row: &[usize],
        entries: &[VectorEntry],
        values: impl Fn(&[f64], &mut Vec<f64>) + Copy + 'm,
    ) -> hdf5::Result<()> {
        for &(name, dimension, text, vector) in entries {
            self.add(at, name, row, (dimension, text), move |r, v| {
                values(vector(r), v);
            })?;
        }
        Ok(())
    }

    /// Creates the datasets of a table, with a row per increment; `records` is the shape of the records in a row, and
    /// `each` visits these records one after the other.
    fn table<Q: 'm>(
        &mut self,
        at: &Group,
        records: &[usize],
        entries: &[DatasetEntry<Q>],
        each: impl Fn(&IncrementReport, &mut dyn FnMut(&Q)) + Clone + 'm,
    ) -> hdf5::Result<()> {
        self.rows_of(at, records, Mostly::Varied, entries, each)
    }

    /// Creates the datasets of a table, with a row per event.
    fn events<Q: 'm>(
        &mut self,
        at: &Group,
        entries: &[DatasetEntry<Q>],
        each: impl Fn(&IncrementReport, &mut dyn FnMut(&Q)) + Clone + 'm,
    ) -> hdf5::Result<()> {
        self.rows_of(at, &[], Mostly::Late, entries, each)
    }

    fn rows_of<Q: 'm>(
        &mut self,
        at: &Group,
        records: &[usize],
        mostly: Mostly,
        entries: &[DatasetEntry<Q>],
        each: impl Fn(&IncrementReport, &mut dyn FnMut(&Q)) + Clone + 'm,
    ) -> hdf5::Result<()> {
        let label = |node: usize| self.model.mesh.node_labels[node] as i64;
        let number = |body: Option<usize>| body.map_or(-1, |body| body as i64);
        let all = &mut self.columns;
        for &(name, dimension, text, ref value) in entries {
            let (about, each) = ((dimension, text), each.clone());
            let reals = |row: &[usize]| Layout::one_by_one::<f64>(&[records, row].concat(), mostly);
            let counts =
                |row: &[usize]| Layout::one_by_one::<i64>(&[records, row].concat(), mostly);
            match *value {
                Real(of) => all.add(at, name, reals(&[]), about, move |r, v| {
                    each(r, &mut |q| v.push(of(q)));
                }),
                Vector(of) => all.add(at, name, reals(&[2]), about, move |r, v| {
                    each(r, &mut |q| v.extend(of(q)));
                }),
                Tensor(of) => all.add(at, name, reals(&[3]), about, move |r, v| {
                    each(r, &mut |q| v.extend(of(q)));
                }),
                Count(of) => all.add(at, name, counts(&[]), about, move |r, v| {
                    each(r, &mut |q| v.push(of(q) as i64));
                }),
                Node(of) => all.add(at, name, counts(&[]), about, move |r, v| {
                    each(r, &mut |q| v.push(label(of(q))));
                }),
                Segment(of) => all.add(at, name, counts(&[2]), about, move |r, v| {
                    each(r, &mut |q| v.extend(of(q).map(label)));
                }),
                DatasetContent::Bodies(of) => {
                    all.add(at, name, counts(&[2]), about, move |r, v| {
                        each(r, &mut |q| v.extend(of(q).map(number)));
                    })
                }
                Flag(of) => {
                    let flags = Layout::one_by_one::<u8>(records, mostly);
                    all.add(at, name, flags, about, move |r, v: &mut Vec<u8>| {
                        each(r, &mut |q| v.push(of(q).into()));
                    })
                }
            }?;
        }
        Ok(())
    }

    /// `/history/momentum`; if the mass is redistributed, it is the momentum of the consistent mass.
    fn create_momentum(&mut self, at: &Group) -> hdf5::Result<()> {
        self.table(at, &[], &MOMENTUM, |r, each| each(&r.momentum))?;
        if self.model.redistributes_mass() {
            self.table(at, &[], &CONSISTENT, |r, each| each(&r.momentum))?;
        }
        Ok(())
    }

    /// `/history/strain`: largest principal strain of all elements, and of the elements with a law for small strains.
    fn create_strain(&mut self, at: &Group) -> hdf5::Result<()> {
        self.table(at, &[], &LARGEST_STRAIN, |r, each| each(r))?;
        let limited = SmallStrainElements::new(self.model);
        let name = "largest_principal_elastic";
        self.add(at, name, &[], LARGEST_ELASTIC, move |r, v| {
            v.push(limited.most_strained(r).strain);
        })
    }

    /// `/history/contact/<SLAVE>_<MASTER>`.
    fn create_contact(
        &mut self,
        at: &Group,
        k: usize,
        contact: &Contact,
        bodies: &[usize],
    ) -> hdf5::Result<()> {
        let own = move |r: &IncrementReport, each: &mut dyn FnMut(&ContactResultant)| {
            r.contacts.get(k).into_iter().for_each(each);
        };
        text_attribute(at, "formulation", contact.formulation.name())?;
        self.table(at, &[], &CONTACT, own)?;
        let mut rigid = self.model.rigid_bodies.iter();
        if rigid.any(|body| body.has_surface(contact.master)) {
            self.table(at, &[], &REFERENCE_MOMENT, own)?;
        }
        if contact.is_self_contact() {
            self.table(at, bodies, &CONTACT_ON_BODY, move |r, each| {
                own(r, &mut |contact| contact.bodies.iter().for_each(&mut *each));
            })?;
        }
        Ok(())
    }

    /// `/history/connectors`: springs and dashpots between displacements, and `/history/rotary_connectors`: those
    /// between angles; a group without members is absent.
    fn create_connectors(&mut self, at: &Group) -> hdf5::Result<()> {
        let connectors = &self.model.connectors;
        for (name, is_rotary, entries) in [
            ("connectors", false, CONNECTOR),
            ("rotary_connectors", true, ROTARY_CONNECTOR),
        ] {
            let all = connectors.iter().enumerate();
            let own = all.filter(|(_, c)| (c.direction == ConnectorDirection::Angle) == is_rotary);
            let (places, labels): (Vec<usize>, Vec<i64>) =
                own.map(|(place, c)| (place, c.label as i64)).unzip();
            let places: Rc<[usize]> = places.into();
            if places.is_empty() {
                continue;
            }
            let (at, count) = (group(at, name)?, [places.len()]);
            let text = (
                "1",
                "element numbers of the springs and dashpots in the deck",
            );
            constant(&at, "labels", &count, &labels, text)?;
            self.table(&at, &count, &entries, move |r, each| {
                places.iter().for_each(|&at| each(&r.connectors[at]));
            })?;
        }
        Ok(())
    }

    /// `/history/ties/<NAME>`: the force of every tie.
    fn create_ties(&mut self, at: &Group) -> hdf5::Result<()> {
        if self.model.ties.is_empty() {
            return Ok(());
        }
        let ties = group(at, "ties")?;
        for tie in &self.model.ties {
            let at = group(&ties, &tie.name)?;
            let nodes: Vec<usize> = tie.nodes.iter().map(|tied| tied.node).collect();
            self.labels(&at, &nodes, "node numbers of the tied nodes")?;
            let text = ("force", "force of the tie on its slave nodes");
            let members = nodes.clone();
            self.add(&at, "force", &[2], text, move |r, v| {
                v.extend(sum(&members, &r.nodal.tie_force));
            })?;
            let x = &self.model.mesh.coordinates;
            let text = ("force*length", "moment of the force about the origin");
            self.add(&at, "moment", &[], text, move |r, v| {
                let moment = |&node: &usize| {
                    let [at, force] = [&r.state.u, &r.nodal.tie_force]
                        .map(|all| [all[2 * node], all[2 * node + 1]]);
                    cross([0, 1].map(|i| x[node][i] + at[i]), force)
                };
                v.push(nodes.iter().map(moment).sum());
            })?;
        }
        Ok(())
    }

    /// `/history/hinges`: the forces of the hinges, and their positions.
    fn create_hinges(&mut self, at: &Group) -> hdf5::Result<()> {
        let Model { hinges, mesh, .. } = self.model;
        if hinges.is_empty() {
            return Ok(());
        }
        let (at, count) = (group(at, "hinges")?, hinges.len());
        let labels = hinges.iter().flat_map(|hinge| hinge.nodes);
        let labels: Vec<i64> = labels.map(|node| mesh.node_labels[node] as i64).collect();
        let text = ("1", "node numbers of the two nodes of every hinge");
        constant(&at, "labels", &[count, 2], &labels, text)?;
        let text = (
            "force",
            "force of the hinge on its first node; that on its second is its opposite",
        );
        self.add(&at, "force", &[count, 2], text, |r, v| {
            v.extend(r.nodal.hinge_force.iter().flatten());
        })?;
        let text = ("length", "position of the first node");
        let x = &mesh.coordinates;
        self.add(&at, "position", &[count, 2], text, move |r, v| {
            for [node, _] in hinges.iter().map(|hinge| hinge.nodes) {
                v.extend((0..2).map(|i| x[node][i] + r.state.u[2 * node + i]));
            }
        })
    }

    /// `/history/impacts`: one row per landing; `/history/returns`: one row for each pair and increment in which energy
    /// is given back to the pair; `/history/touches`: one row per contact of two bodies that has ended.
    fn create_events(&mut self, at: &Group) -> hdf5::Result<()> {
        let impacts = group(at, "impacts")?;
        self.columns.count(&impacts, ROWS, |r| r.landings.len())?;
        self.events(&impacts, &IMPACT, |r, each| {
            (r.landings.iter()).for_each(|landing| each(&(r.increment, *landing)));
        })?;
        let gives_back = |step: &Step| step.settings.landing == LandingRule::Return;
        if self.model.steps.iter().any(gives_back) {
            let returns = group(at, "returns")?;
            self.columns.count(&returns, ROWS, |r| r.returns.len())?;
            self.events(&returns, &RETURN, |r, each| {
                (r.returns.iter()).for_each(|returned| each(&(r.increment, *returned)));
            })?;
        }
        let touches = group(at, "touches")?;
        self.columns.count(&touches, ROWS, |r| r.touches.len())?;
        self.events(&touches, &TOUCH, |r, each| {
            r.touches.iter().for_each(each);
        })
    }

    /// `/history/rigid/<SURFACE>`: motion of a rigid body at its reference node; its angle if it turns, and its energy
    /// if it turns or has mass.
    fn create_rigid(
        &mut self,
        at: &Group,
        k: usize,
        (body, moves): (&RigidBody, bool),
    ) -> hdf5::Result<()> {
        let node = body.reference;
        let label = self.model.mesh.node_labels[node] as i64;
        let text = ("1", "node number of the reference node");
        constant(at, "node", &[1], &[label], text)?;
        let x = self.model.mesh.coordinates[node];
        let text = ("length", "position of the reference node");
        self.add(at, "position", &[2], text, move |r, v| {
            v.extend((0..2).map(|i| x[i] + r.state.u[2 * node + i]));
        })?;
        self.vectors(at, &[2], &REFERENCE_NODE, move |all, v| {
            v.extend_from_slice(&all[2 * node..2 * node + 2]);
        })?;
        let own = move |r: &IncrementReport, each: &mut dyn FnMut(&RigidReaction)| {
            r.rigid.get(k).into_iter().for_each(each);
        };
        if moves {
            self.table(at, &[], &TURNING, own)?;
        }
        self.table(at, &[], &REACTION, own)
    }

    /// `/history/nodes/<NSET>`: sums and means, and values of every node if they are asked for.
    fn create_nodes(
        &mut self,
        at: &Group,
        nodes: &'m [usize],
        each_member: bool,
    ) -> hdf5::Result<()> {
        self.labels(at, nodes, "node numbers of the deck")?;
        if each_member {
            self.vectors(at, &[nodes.len(), 2], &OF_NODE, |all, v| {
                v.extend(pick(nodes, all).flatten());
            })?;
        }
        self.vectors(&group(at, "sum")?, &[2], &SUMS_OF_NODES, |all, v| {
            v.extend(sum(nodes, all));
        })?;
        let count = nodes.len() as f64;
        self.vectors(&group(at, "mean")?, &[2], &MEANS_OF_NODES, move |all, v| {
            v.extend(sum(nodes, all).map(|sum| sum / count));
        })
    }

    /// `/history/elements/<ELSET>/points`: values at the integration points of all elements, element after element.
    fn create_points(
        &mut self,
        at: &Group,
        elements: &'m [usize],
        local: &Arc<Elements>,
    ) -> hdf5::Result<()> {
        let (mut labels, mut numbers) = (Vec::new(), Vec::new());
        for &e in elements {
            for number in 1..=local.points(e) {
                labels.push(self.model.mesh.elements[e].label as i64);
                numbers.push(number as i64);
            }
        }
        let text = ("1", "element number of the deck of every point");
        constant(at, "labels", &[labels.len()], &labels, text)?;
        let text = ("1", "number of the point in its element, from 1");
        constant(at, "numbers", &[numbers.len()], &numbers, text)?;
        self.create_local(at, labels.len(), Local::at_points(local, elements))
    }

    /// `/history/elements/<ELSET>/at_nodes`: values at the nodes of the elements; at a node, the plain mean over all
    /// elements of the set.
    fn create_element_nodes(
        &mut self,
        at: &Group,
        elements: &'m [usize],
        local: &Arc<Elements>,
    ) -> hdf5::Result<()> {
        let local = Local::at_nodes(local, elements);
        let nodes = local.nodes();
        self.labels(at, &nodes, "node numbers of the deck")?;
        self.create_local(at, nodes.len(), local)
    }

    /// The datasets of values at `count` places.
    fn create_local(&mut self, at: &Group, count: usize, local: Local) -> hdf5::Result<()> {
        let local = Rc::new(local);
        self.table(at, &[count], &LOCAL, move |r, each| {
            local.of(r.increment, &r.state).iter().for_each(each);
        })
    }

    /// `/history/elements/<ELSET>`: sums, and values of every element if they are asked for.
    fn create_elements(
        &mut self,
        at: &Group,
        elements: &'m [usize],
        each_member: bool,
    ) -> hdf5::Result<()> {
        let mesh = &self.model.mesh;
        let labels = elements.iter().map(|&e| mesh.elements[e].label as i64);
        let (labels, count): (Vec<i64>, _) = (labels.collect(), [elements.len()]);
        let text = ("1", "element numbers of the deck");
        constant(at, "labels", &count, &labels, text)?;
        let inertia = || elements.iter().map(|&e| ElementInertia::new(self.model, e));
        let volumes: Vec<f64> = inertia().map(|own| own.volume).collect();
        let text = ("length^3", "volume of the undeformed element");
        constant(at, "EVOL", &count, &volumes, text)?;
        let (own, of_each): (Vec<_>, Vec<_>) = (inertia().collect(), inertia().collect());
        let sums = group(at, "sum")?;
        let text = ("energy", "strain energy of the set");
        self.add(&sums, "ELSE", &[], text, |r, v| {
            v.push(elements.iter().map(|&e| r.elements[e].energy).sum());
        })?;
        let text = ("energy", "kinetic energy of the set");
        self.add(&sums, "ELKE", &[], text, move |r, v| {
            v.push(own.iter().map(|own| own.kinetic_energy(&r.state.v)).sum());
        })?;
        if !each_member {
            return Ok(());
        }
        self.table(at, &count, &ELEMENT, |r, each| {
            elements.iter().for_each(|&e| each(&r.elements[e]));
        })?;
        if self.model.mesh.is_axisymmetric() {
            self.add(at, "E33", &count, STRAIN_AROUND, |r, v| {
                v.extend(elements.iter().map(|&e| r.elements[e].strain_across));
            })?;
            self.add(at, "LE33", &count, LOGARITHMIC_AROUND, |r, v| {
                let around = elements.iter().map(|&e| r.elements[e].strain_across);
                v.extend(around.map(logarithmic_of));
            })?;
        }
        if self.model.writes_plastic_strain() {
            self.add(at, "PEEQ", &count, PLASTIC_STRAIN, |r, v| {
                v.extend(elements.iter().map(|&e| r.elements[e].plastic_strain));
            })?;
        }
        let gradients = elements
            .iter()
            .map(|&e| MeanGradient::new(mesh, &mesh.elements[e]));
        let gradients: Vec<MeanGradient> = gradients.collect();
        let row = [elements.len(), 3];
        self.add(at, "LE", &row, LOGARITHMIC_STRAIN, move |r, v| {
            let strain = gradients
                .iter()
                .map(|mean| mean.logarithmic_strain(&r.state.u));
            v.extend(strain.flatten());
        })?;
        self.add(at, "ENER", &count, ENERGY_DENSITY, move |r, v| {
            let each = elements.iter().zip(&volumes);
            v.extend(each.map(|(&e, volume)| r.elements[e].energy / volume));
        })?;
        let text = (
            "energy",
            "kinetic energy of the element with its consistent mass",
        );
        self.add(at, "ELKE", &count, text, move |r, v| {
            v.extend(of_each.iter().map(|own| own.kinetic_energy(&r.state.v)));
        })
    }
}

/// The requested sets in the order of the model; an empty set has no history.
fn requested<'m>(
    asked: &'m [HistorySet],
    sets: &'m [Set],
) -> impl Iterator<Item = (&'m HistorySet, &'m Set)> {
    let mut asked: Vec<&HistorySet> = asked.iter().collect();
    asked.sort_unstable_by_key(|asked| asked.set);
    let sets = asked.into_iter().map(|asked| (asked, &sets[asked.set]));
    sets.filter(|(_, set)| !set.members.is_empty())
}

/// Both components of `values` at each of the `nodes`.
fn pick<'a>(nodes: &'a [usize], values: &'a [f64]) -> impl Iterator<Item = [f64; 2]> + 'a {
    (nodes.iter()).map(|&node| [values[2 * node], values[2 * node + 1]])
}

/// Sum of `values` over the `nodes`.
fn sum(nodes: &[usize], values: &[f64]) -> [f64; 2] {
    pick(nodes, values).fold([0.0; 2], |[x, y], v| [x + v[0], y + v[1]])
}

#[rustfmt::skip]
const INCREMENT: [DatasetEntry<IncrementReport>; 3] = [
    ("time", "time", "time at the end of the increment", Real(|r| r.time)),
    ("dt", "time", "length of the increment", Real(|r| r.dt)),
    ("step", "1", "number of the step, from 1", Count(|r| r.step)),
];

#[rustfmt::skip]
const CONNECTOR: [DatasetEntry<ConnectorState>; 3] = [
    ("elongation", "length", "elongation", Real(|c| c.elongation)),
    ("rate", "length/time", "rate of the elongation", Real(|c| c.rate)),
    ("force", "force", "force, positive where it pulls the nodes together", Real(|c| c.force)),
];

#[rustfmt::skip]
const ROTARY_CONNECTOR: [DatasetEntry<ConnectorState>; 3] = [
    ("angle", "1", "angle (rad), or the difference of two", Real(|c| c.elongation)),
    ("rate", "1/time", "rate of the angle", Real(|c| c.rate)),
    ("moment", "force*length", "moment, positive where it turns the angle back", Real(|c| c.force)),
];

#[rustfmt::skip]
const ENERGY: [DatasetEntry<Energy>; 15] = [
    ("kinetic", "energy", "kinetic energy", Real(|e| e.kinetic)),
    ("strain", "energy", "strain energy, with that of springs", Real(|e| e.strain)),
    ("external_work", "energy",
     "work of the loads and of the supports' prescribed motion since the start", Real(|e| e.external_work)),
    ("thermal_work", "energy",
     "work of the temperature on the materials that expand since the start", Real(|e| e.thermal_work)),
    ("normal_contact_work", "energy",
     "work of the normal contact forces since the start", Real(|e| e.normal_contact_work)),
    ("friction_dissipation", "energy",
     "energy dissipated by friction since the start", Real(|e| e.friction_dissipation)),
    ("impact_loss", "energy",
     "kinetic energy taken by the impact impulses since the start", Real(|e| e.impact_loss)),
    ("landing_return", "energy",
     "kinetic energy given back after landings since the start", Real(|e| e.landing_return)),
    ("release_loss", "energy",
     "strain energy lost by nodes without mass after releases since the start", Real(|e| e.release_loss)),
    ("damping", "energy",
     "energy dissipated by the damping of the materials and by dashpots since the start", Real(|e| e.damping)),
    ("material_dissipation", "energy",
     "energy dissipated by the materials since the start", Real(|e| e.material_dissipation)),
    ("numerical_dissipation", "energy",
     "energy dissipated by the integration scheme since the start", Real(|e| e.numerical_dissipation)),
    ("balance", "energy",
     "what is left of the energy balance: only the unconverged residual", Real(|e| e.balance)),
    ("scale", "energy",
     "largest kinetic or strain energy or external work so far; in static steps also of loads or supports alone",
     Real(|e| e.scale)),
    ("round_off", "energy",
     "work that the round-off of the forces may have done in static steps", Real(|e| e.round_off)),
];

#[rustfmt::skip]
const MOMENTUM: [DatasetEntry<Momentum>; 4] = [
    ("linear", "mass*length/time", "linear momentum", Vector(|m| m.linear)),
    ("damped_linear", "mass*length/time",
     "linear momentum taken by mass-proportional damping since the start", Vector(|m| m.damped_linear)),
    ("angular", "mass*length^2/time", "angular momentum about the origin", Real(|m| m.angular)),
    ("damped_angular", "mass*length^2/time",
     "angular momentum taken by mass-proportional damping since the start", Real(|m| m.damped_angular)),
];

/// Models with redistributed mass have this dataset, too; if no node gives up its mass, it equals `angular`.
#[rustfmt::skip]
const CONSISTENT: [DatasetEntry<Momentum>; 1] = [
    ("consistent_angular", "mass*length^2/time", "angular momentum about the origin of the consistent mass",
     Real(|m| m.consistent_angular.unwrap_or(m.angular))),
];

#[rustfmt::skip]
const BODY: [DatasetEntry<BodyResult>; 7] = [
    ("center", "length", "centre of mass", Vector(|b| b.center)),
    ("velocity", "length/time", "velocity of the centre of mass", Vector(|b| b.velocity)),
    ("contact_force", "force", "force of all contacts on the body", Vector(|b| b.contact_force)),
    ("angular_velocity", "1/time",
     "angular momentum about the centre of mass over the moment of inertia", Real(|b| b.angular_velocity)),
    ("kinetic", "energy", "kinetic energy", Real(|b| b.kinetic)),
    ("strain", "energy", "strain energy", Real(|b| b.strain)),
    ("contact_moment", "force*length",
     "moment of the contact force about the centre of mass", Real(|b| b.contact_moment)),
];

#[rustfmt::skip]
const LARGEST_STRAIN: [DatasetEntry<IncrementReport>; 1] = [
    ("largest_principal", "1",
     "largest absolute principal value of the Green-Lagrange strain in the plane, of all integration points",
     Real(|r| r.strain.strain)),
];
const LARGEST_ELASTIC: Meaning = (
    "1",
    "the same of elements with a St. Venant-Kirchhoff material (*ELASTIC); 0 without any",
);

#[rustfmt::skip]
const CONTACT: [DatasetEntry<ContactResultant>; 27] = [
    ("force", "force", "contact force on the slave surface", Vector(|c| c.force)),
    ("moment", "force*length", "moment of the force about the origin", Real(|c| c.moment)),
    ("normal", "force", "sum of the normal forces Pn", Real(|c| c.normal)),
    ("tangential", "force", "sum of the tangential forces Pt", Real(|c| c.tangential)),
    ("min_gap", "length", "smallest gap of the candidate pairs, NaN without", Real(|c| c.min_gap)),
    ("friction_coefficient", "1",
     "coefficient of friction of the closed pairs, mean by Pn, NaN without", Real(|c| c.friction_coefficient)),
    ("cone_violation", "1", "max(|Pt| - mu Pn, 0) / max(Pn), where a pair slips ||Pt| - mu Pn| / max(Pn), mu that of the law", Real(|c| c.cone_violation)),
    ("impulse_cone_violation", "1",
     "the same of the total impulses of the pairs in the increment, with impacts and what is given back",
     Real(|c| c.impulse_cone_violation)),
    ("normal_work", "energy",
     "work of the normal contact forces since the start", Real(|c| c.normal_work)),
    ("handover_work", "energy",
     "the part of it of nodes that landed where others of the same bodies had opened", Real(|c| c.handover_work)),
    ("friction_dissipation", "energy",
     "energy dissipated by friction since the start", Real(|c| c.friction_dissipation)),
    ("landing_return", "energy",
     "kinetic energy given back after its landings and releases since the start", Real(|c| c.landing_return)),
    ("release_loss", "energy",
     "energy that nodes without mass lost after its releases since the start", Real(|c| c.release_loss)),
    ("closed", "1", "pairs with Pn > 0", Count(|c| c.closed)),
    ("sticking", "1", "closed pairs that do not slip; a pair whose force is at its limit sticks unless it has moved", Count(|c| c.sticking)),
    ("impulse", "force*time", "impulse on the slave surface in the increment", Vector(|c| c.impulse.vector)),
    ("normal_impulse", "force*time",
     "sum of dt Pn + Phi and of return impulses in the increment", Real(|c| c.impulse.normal)),
    ("tangential_impulse", "force*time",
     "sum of dt Pt + Psi and of return impulses in the increment", Real(|c| c.impulse.tangential)),
    ("impact_normal_impulse", "force*time",
     "sum of Phi in the increment", Real(|c| c.impulse.impact_normal)),
    ("impact_tangential_impulse", "force*time",
     "sum of Psi in the increment", Real(|c| c.impulse.impact_tangential)),
    ("return_impulse", "force*time",
     "sum of the normal impulses of landing returns in the increment", Real(|c| c.impulse.landing_return)),
    ("impulse_sum", "force*time",
     "impulse on the slave surface since the start", Vector(|c| c.impulse_sum.vector)),
    ("normal_impulse_sum", "force*time",
     "sum of dt Pn + Phi and of return impulses since the start", Real(|c| c.impulse_sum.normal)),
    ("tangential_impulse_sum", "force*time",
     "sum of dt Pt + Psi since the start", Real(|c| c.impulse_sum.tangential)),
    ("impact_normal_impulse_sum", "force*time",
     "sum of Phi since the start", Real(|c| c.impulse_sum.impact_normal)),
    ("impact_tangential_impulse_sum", "force*time",
     "sum of Psi since the start", Real(|c| c.impulse_sum.impact_tangential)),
    ("return_impulse_sum", "force*time",
     "sum of the normal impulses of landing returns since the start", Real(|c| c.impulse_sum.landing_return)),
];

/// A contact with a rigid master has this dataset, too.
#[rustfmt::skip]
const REFERENCE_MOMENT: [DatasetEntry<ContactResultant>; 1] = [
    ("reference_moment", "force*length", "moment of the force about the reference node of the master",
     Real(|c| c.reference_moment)),
];

/// A surface that touches itself has these datasets, too.
#[rustfmt::skip]
const CONTACT_ON_BODY: [DatasetEntry<ContactOnBody>; 2] = [
    ("body_force", "force", "force of this contact on each body", Vector(|b| b.force)),
    ("body_moment", "force*length", "moment of that force about the origin", Real(|b| b.moment)),
];

/// A landing with its increment.
#[rustfmt::skip]
const IMPACT: [DatasetEntry<(usize, Landing)>; 6] = [
    ("time", "time", "time of the landing", Real(|(_, l)| l.time)),
    ("xi", "1", "place on the segment: 0 at its first node, 1 at its second", Real(|(_, l)| l.xi)),
    ("approach_speed", "length/time", "-dg/dt just before the landing", Real(|(_, l)| l.approach_speed)),
    ("increment", "1", "increment of the landing", Count(|(increment, _)| *increment)),
    ("slave", "1", "node number of the slave node", Node(|(_, l)| l.slave)),
    ("segment", "1", "node numbers of the segment's ends", Segment(|(_, l)| l.segment)),
];

/// A return with its increment.
#[rustfmt::skip]
const RETURN: [DatasetEntry<(usize, ReturnedImpulse)>; 8] = [
    ("time", "time", "time at the end of the increment", Real(|(_, r)| r.time)),
    ("normal", "force*time",
     "total normal impulse of the pair in the increment: dt Pn + Phi and what is given back",
     Real(|(_, r)| r.normal)),
    ("tangential", "force*time",
     "total tangential impulse of the pair in the increment", Real(|(_, r)| r.tangential)),
    ("returned_normal", "force*time", "normal impulse that gives back", Real(|(_, r)| r.returned_normal)),
    ("returned_tangential", "force*time",
     "tangential impulse that gives back", Real(|(_, r)| r.returned_tangential)),
    ("increment", "1", "increment", Count(|(increment, _)| *increment)),
    ("slave", "1", "node number of the slave node", Node(|(_, r)| r.slave)),
    ("segment", "1", "node numbers of the segment's ends", Segment(|(_, r)| r.segment)),
];

#[rustfmt::skip]
const TOUCH: [DatasetEntry<Touch>; 10] = [
    ("start", "time", "time at the start of its first increment", Real(|t| t.start)),
    ("end", "time", "time at the end of its last increment", Real(|t| t.end)),
    ("impulse", "force*time", "size of the impulse on each of the bodies", Real(|t| t.impulse)),
    ("energy", "energy",
     "kinetic energy of the approach if the bodies rebound with its speed, J^2/(8 m); 0 where both are held",
     Real(|t| t.energy)),
    ("first", "1", "its first increment", Count(|t| t.first)),
    ("last", "1", "its last increment", Count(|t| t.last)),
    ("nodes", "1", "most nodes of one side in contact at a time", Count(|t| t.nodes)),
    ("corner", "1", "1 where it reached a corner of an outline", Count(|t| t.is_at_corner.into())),
    ("bodies", "1", "its bodies; -1 for a rigid surface", DatasetContent::Bodies(|t| t.bodies)),
    ("node", "1", "number of a slave node that landed first", Node(|t| t.node)),
];

/// A vector over the dofs in a report, with the name, dimension and meaning of its dataset.
type VectorEntry = (
    &'static str,
    &'static str,
    &'static str,
    fn(&IncrementReport) -> &[f64],
);

#[rustfmt::skip]
const REFERENCE_NODE: [VectorEntry; 2] = [
    ("U", "length", "displacement of the reference node", |r| &r.state.u),
    ("V", "length/time", "velocity of the reference node", |r| &r.state.v),
];

#[rustfmt::skip]
const REACTION: [DatasetEntry<RigidReaction>; 2] = [
    ("force", "force", "reaction: the force that holds the body", Vector(|r| r.force)),
    ("moment", "force*length", "moment of the reaction about the reference node", Real(|r| r.moment)),
];

/// A body that turns has these datasets, too.
#[rustfmt::skip]
const TURNING: [DatasetEntry<RigidReaction>; 4] = [
    ("angle", "1", "angle since the start, in radians", Real(|r| r.angle)),
    ("angular_velocity", "1/time", "angular velocity", Real(|r| r.angular_velocity)),
    ("center", "length", "position of the centre of mass", Vector(|r| r.center)),
    ("kinetic", "energy", "kinetic energy", Real(|r| r.kinetic)),
];

#[rustfmt::skip]
const OF_NODE: [VectorEntry; 3] = [
    ("U", "length", "displacement", |r| &r.state.u),
    ("V", "length/time", "velocity", |r| &r.state.v),
    ("RF", "force", "support reaction", |r| &r.nodal.reaction),
];

#[rustfmt::skip]
const SUMS_OF_NODES: [VectorEntry; 3] = [
    ("RF", "force", "sum of the support reactions", |r| &r.nodal.reaction),
    ("CF", "force", "sum of the concentrated loads", |r| &r.nodal.concentrated),
    ("CONTACT_FORCE", "force", "sum of the contact forces on the nodes", |r| &r.nodal.contact_force),
];

#[rustfmt::skip]
const MEANS_OF_NODES: [VectorEntry; 3] = [
    ("U", "length", "mean displacement", |r| &r.state.u),
    ("V", "length/time", "mean velocity", |r| &r.state.v),
    ("A", "length/time^2", "mean acceleration", |r| &r.state.a),
];

/// Meanings of `LE`, `E33` and `LE33` for elements.
const LOGARITHMIC_STRAIN: Meaning = (
    "1",
    "logarithmic strain xx yy xy (xy: tensor component) of the element's mean deformation gradient",
);
const STRAIN_AROUND: Meaning = (
    "1",
    "Green-Lagrange strain around the axis, mean over the element",
);
const LOGARITHMIC_AROUND: Meaning = (
    "1",
    "logarithmic strain around the axis, of the element's mean E33",
);

#[rustfmt::skip]
const ELEMENT: [DatasetEntry<ElementResult>; 10] = [
    ("S", "force/length^2", "Cauchy stress xx yy xy, mean over the element", Tensor(|e| e.stress)),
    ("E", "1", "Green-Lagrange strain xx yy xy (xy: the tensor component), mean over the element", Tensor(|e| e.strain)),
    ("S33", "force/length^2", "Cauchy stress across the plane, or around the axis, mean over the element", Real(|e| e.across)),
    ("MISES", "force/length^2", "von Mises stress of the mean stresses", Real(ElementResult::von_mises)),
    ("SP1", "force/length^2", "smallest principal value of the mean stresses", Real(|e| e.principal_stresses()[0])),
    ("SP2", "force/length^2", "middle principal value of the mean stresses", Real(|e| e.principal_stresses()[1])),
    ("SP3", "force/length^2", "largest principal value of the mean stresses", Real(|e| e.principal_stresses()[2])),
    ("PRESS", "force/length^2", "pressure -(xx + yy + zz)/3 of the mean stresses", Real(ElementResult::pressure)),
    ("ELSE", "energy", "strain energy of the element", Real(|e| e.energy)),
    ("ELHE", "energy", "the part of it in hourglass modes", Real(|e| e.hourglass_energy)),
];

#[rustfmt::skip]
const LOCAL: [DatasetEntry<LocalResult>; 13] = [
    ("S", "force/length^2", "Cauchy stress xx yy xy", Tensor(|e| e.result.stress)),
    ("E", "1", "Green-Lagrange strain xx yy xy (xy: the tensor component)", Tensor(|e| e.result.strain)),
    ("LE", "1", "logarithmic strain xx yy xy (xy: the tensor component)", Tensor(|e| e.logarithmic_strain)),
    ("S33", "force/length^2", "Cauchy stress across the plane, or around the axis", Real(|e| e.result.across)),
    ("E33", "1", "Green-Lagrange strain across the plane, or around the axis", Real(|e| e.result.strain_across)),
    ("LE33", "1", "logarithmic strain across the plane, or around the axis", Real(|e| e.logarithmic_across)),
    ("MISES", "force/length^2", "von Mises stress", Real(|e| e.result.von_mises())),
    ("SP1", "force/length^2", "smallest principal stress", Real(|e| e.result.principal_stresses()[0])),
    ("SP2", "force/length^2", "middle principal stress", Real(|e| e.result.principal_stresses()[1])),
    ("SP3", "force/length^2", "largest principal stress", Real(|e| e.result.principal_stresses()[2])),
    ("PRESS", "force/length^2", "pressure -(xx + yy + zz)/3", Real(|e| e.result.pressure())),
    ("ENER", "energy/length^3", "strain energy per volume of the undeformed body, without that of hourglass modes", Real(|e| e.result.energy)),
    ("PEEQ", "1", "accumulated plastic strain", Real(|e| e.result.plastic_strain)),
];

#[rustfmt::skip]
const SOLVER: [DatasetEntry<SolverCounts>; 10] = [
    ("passes", "1", "predictor and corrector passes", Count(|s| s.passes)),
    ("lcps", "1", "complementarity problems solved", Count(|s| s.lcps)),
    ("lcp_size", "1", "largest number of pairs in one of them", Count(|s| s.lcp_size)),
    ("pivots", "1", "pivots of Lemke's method", Count(|s| s.pivots)),
    ("active_set_iterations", "1", "iterations of the active-set method", Count(|s| s.active_set_iterations)),
    ("gauss_seidel_sweeps", "1", "sweeps of the Gauss-Seidel method", Count(|s| s.gauss_seidel_sweeps)),
    ("lemke_calls", "1", "calls of Lemke's method", Count(|s| s.lemke_calls)),
    ("factorizations", "1", "factorisations of the effective matrix", Count(|s| s.factorizations)),
    ("held", "1", "largest force that holds a motion which only facets resist, part of the normal forces at its body", Real(|s| s.held)),
    ("converged", "1", "1 when the increment converged, else 0", Flag(|s| s.converged)),
];
