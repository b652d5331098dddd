//! Group `/model`: data of the equations of the run. With this data, forces, energies and the contact law can be
//! recomputed from the fields without reading elements, materials, contacts and steps from the deck. See
//! docs/theory/elements.md, docs/theory/contact.md and docs/theory/time.md.

use std::collections::BTreeMap;

use hdf5::Group;

use super::column::{Meaning, constant, group};
use super::model_group::contact_names;
use crate::contact::{Bulge, ContactSurfaces};
use crate::model::{
    Disc, ElementType, FrictionLaw, Heat, Material, Model, Procedure, Scheme, Segment, Step,
    Surface, SurfaceKind, Variation,
};

/// Writes the datasets and groups into `/model`.
pub(super) fn write(at: &Group, model: &Model, surfaces: &[ContactSurfaces]) -> hdf5::Result<()> {
    write_elements(at, model)?;
    write_materials(&group(at, "materials")?, model)?;
    write_contacts(&group(at, "contacts")?, model, surfaces)?;
    write_steps(&group(at, "steps")?, &model.steps)?;
    indices(at, "supported_nodes", supported(model), SUPPORTED)?;
    indices(at, "constrained_nodes", constrained(model), CONSTRAINED)?;
    indices(at, "loaded_nodes", loaded_nodes(model), LOADED_NODES)?;
    let groups = load_groups(model);
    constant(at, "load_groups", &[groups.len()], &groups, LOAD_GROUPS)
}

/// Type, material and thickness of every element.
fn write_elements(at: &Group, model: &Model) -> hdf5::Result<()> {
    let elements = &model.mesh.elements;
    let types: Vec<u8> = elements.iter().map(|e| e.element_type.number()).collect();
    constant(at, "element_types", &[types.len()], &types, ELEMENT_TYPES)?;
    let section = |e: usize| model.sections.get(elements[e].section);
    let material = |e: usize| section(e).map_or(-1, |section| section.material as i64);
    let thickness = |e: usize| match (section(e), elements[e].element_type.is_ring()) {
        (Some(section), false) => section.thickness,
        _ => f64::NAN,
    };
    let materials: Vec<i64> = (0..elements.len()).map(material).collect();
    constant(
        at,
        "element_materials",
        &[materials.len()],
        &materials,
        MATERIAL,
    )?;
    let values: Vec<f64> = (0..elements.len()).map(thickness).collect();
    constant(at, "thickness", &[values.len()], &values, THICKNESS)
}

/// Laws and constants of the materials.
fn write_materials(at: &Group, model: &Model) -> hdf5::Result<()> {
    let all = &model.materials;
    let laws: Vec<u8> = all.iter().map(|material| material.law.number()).collect();
    constant(at, "law", &[laws.len()], &laws, LAW)?;
    let (mut shapes, mut volumes) = (vec![], vec![]);
    let (mut ogden_mu, mut ogden_alpha) = (vec![], vec![]);
    for material in all {
        let constants = material.law.constants();
        shapes.extend(constants.invariants);
        volumes.extend(constants.compressibility);
        ogden_mu.extend(constants.powers.map(|[mu, _]| mu));
        ogden_alpha.extend(constants.powers.map(|[_, alpha]| alpha));
    }
    constant(at, "shape", &[all.len(), 4], &shapes, SHAPE)?;
    let shape = [all.len(), 3];
    constant(at, "compressibility", &shape, &volumes, COMPRESSIBILITY)?;
    constant(at, "ogden_mu", &shape, &ogden_mu, OGDEN_MU)?;
    constant(at, "ogden_alpha", &shape, &ogden_alpha, OGDEN_ALPHA)?;
    let column = |name, meaning, of: fn(&Material) -> f64| {
        let values: Vec<f64> = all.iter().map(of).collect();
        constant(at, name, &[values.len()], &values, meaning)
    };
    column("young", YOUNG, |m| m.law.small_strain().young)?;
    column("poisson", POISSON, |m| m.law.small_strain().poisson)?;
    column("density", DENSITY, |m| m.density)?;
    column("alpha", ALPHA, |m| m.damping.alpha)?;
    column("beta", BETA, |m| m.damping.beta)?;
    if all.iter().all(|material| material.expansion.is_none()) {
        return Ok(());
    }
    column("expansion_zero", EXPANSION_ZERO, |m| {
        m.expansion.as_ref().map_or(f64::NAN, |own| own.zero)
    })?;
    let rows = all.iter().enumerate().flat_map(|(index, material)| {
        let table = material.expansion.iter().flat_map(|own| &own.table);
        table.flat_map(move |&[temperature, alpha]| [index as f64, temperature, alpha])
    });
    let rows: Vec<f64> = rows.collect();
    constant(at, "expansion", &[rows.len() / 3, 3], &rows, EXPANSION)
}

/// Node indices of the segments of a surface.
fn write_segments(
    at: &Group,
    name: &str,
    model: &Model,
    surface: usize,
    meaning: Meaning,
) -> hdf5::Result<()> {
    let segments: Vec<Segment> = model.surfaces[surface].segments(&model.mesh);
    let nodes: Vec<i64> = segments.as_flattened().iter().map(|&n| n as i64).collect();
    constant(at, name, &[segments.len(), 2], &nodes, meaning)
}

/// Bulges of master segments and slave faces.
fn write_bulges(at: &Group, surfaces: &ContactSurfaces) -> hdf5::Result<()> {
    let write = |name, bulges: &[Bulge], meaning| {
        let coefficients: Vec<[f64; 4]> = bulges.iter().map(Bulge::coefficients).collect();
        constant(
            at,
            name,
            &[bulges.len(), 4],
            coefficients.as_flattened(),
            meaning,
        )
    };
    write("bulges", &surfaces.bulges, BULGES)?;
    write("face_bulges", &surfaces.face_bulges, FACE_BULGES)
}

/// Slave nodes, master segments and friction of every contact, under the names of `/history/contact`.
fn write_contacts(at: &Group, model: &Model, surfaces: &[ContactSurfaces]) -> hdf5::Result<()> {
    for ((index, contact), name) in (model.contacts.iter().enumerate()).zip(contact_names(model)) {
        let at = group(at, &name)?;
        indices(&at, "slaves", model.slave_nodes(contact), SLAVES)?;
        write_segments(&at, "segments", model, contact.master, SEGMENTS)?;
        write_segments(&at, "slave_faces", model, contact.slave, SLAVE_FACES)?;
        if let Some(surfaces) = surfaces.get(index).filter(|surfaces| surfaces.bends()) {
            write_bulges(&at, surfaces)?;
        }
        constant(
            &at,
            "friction",
            &[2],
            &model.friction_range(index),
            FRICTION,
        )?;
        write_friction(&at, model, index)?;
        if let Some(Heat { part, to_slave }) = contact.interaction.heat {
            // of both sides where a surface touches itself
            let told = if contact.is_self_contact() {
                part
            } else {
                part * to_slave
            };
            constant(&at, "heat", &[], &[told], HEAT)?;
        }
        let acts = |step: &Step| u8::from(!step.contacts.removed.contains(&index));
        let acts: Vec<u8> = model.steps.iter().map(acts).collect();
        constant(&at, "acts", &[acts.len()], &acts, ACTS)?;
        if let Some(disc) = model.disc(contact) {
            write_disc(&at, disc, &model.surfaces[contact.master])?;
        }
    }
    Ok(())
}

/// Writes the law of friction of a contact in every step.
fn write_friction(at: &Group, model: &Model, contact: usize) -> hdf5::Result<()> {
    let own = &model.contacts[contact].interaction.friction;
    let (mut coefficients, mut decays, mut rows) = (vec![], vec![], vec![]);
    let (mut limits, mut ramps) = (vec![], vec![]);
    for (number, step) in model.steps.iter().enumerate() {
        let mut changes = step.contacts.friction.iter();
        let change = changes.find(|change| change.contact == contact);
        let friction = change.map_or(own, |change| &change.friction);
        let (of_step, decay) = match &friction.law {
            FrictionLaw::Decay {
                at_rest,
                sliding,
                decay,
            } => ([*at_rest, *sliding], *decay),
            FrictionLaw::Rough => ([friction.at_rest(0.0); 2], 0.0),
            FrictionLaw::Table(curves) => {
                for curve in curves {
                    let of_point =
                        |&[rate, mu]: &[f64; 2]| (number as i64 + 1, [curve.pressure, rate, mu]);
                    rows.extend(curve.points.iter().map(of_point));
                }
                ([f64::NAN; 2], f64::NAN)
            }
        };
        coefficients.push(of_step);
        decays.push(decay);
        limits.push(friction.shear_limit);
        ramps.push(u8::from(change.is_some_and(|change| change.from.is_some())));
    }
    let steps = model.steps.len();
    constant(
        at,
        "friction_coefficients",
        &[steps, 2],
        coefficients.as_flattened(),
        FRICTION_COEFFICIENTS,
    )?;
    constant(at, "friction_decay", &[steps], &decays, FRICTION_DECAY)?;
    let (of_step, points): (Vec<i64>, Vec<[f64; 3]>) = rows.into_iter().unzip();
    constant(at, "table_steps", &[of_step.len()], &of_step, TABLE_STEPS)?;
    for (column, (name, meaning)) in TABLE.into_iter().enumerate() {
        let values: Vec<f64> = points.iter().map(|point| point[column]).collect();
        constant(at, name, &[values.len()], &values, meaning)?;
    }
    constant(at, "shear_limit", &[steps], &limits, SHEAR_LIMIT)?;
    constant(at, "friction_ramps", &[steps], &ramps, FRICTION_RAMPS)
}

/// Writes the radius of a disc that is slave, and the arcs of its master.
fn write_disc(at: &Group, disc: Disc, master: &Surface) -> hdf5::Result<()> {
    constant(at, "disc_radius", &[], &[disc.radius], DISC_RADIUS)?;
    constant(at, "disc_arm", &[], &[disc.arm as i64], DISC_ARM)?;
    let arcs = match &master.kind {
        SurfaceKind::Rigid(profile) => profile.arcs.as_slice(),
        _ => &[],
    };
    let places: Vec<[i64; 2]> = (arcs.iter().map(|arc| &arc.segments))
        .map(|segments| [segments.start, segments.end].map(|i| i as i64))
        .collect();
    let centres: Vec<[f64; 2]> = arcs.iter().map(|arc| arc.centre).collect();
    constant(at, "arcs", &[arcs.len(), 2], places.as_flattened(), ARCS)?;
    constant(
        at,
        "arc_centres",
        &[arcs.len(), 2],
        centres.as_flattened(),
        ARC_CENTRES,
    )
}

/// Procedure and scheme of every step.
fn write_steps(at: &Group, steps: &[Step]) -> hdf5::Result<()> {
    let scheme = |step: &Step| match (step.procedure, step.settings.scheme) {
        (Procedure::Static, _) => (0, [1.0, 1.0]),
        (Procedure::QuasiStatic, _) => (3, [1.0, 1.0]),
        (Procedure::Dynamic, Scheme::EnergyMomentum) => (1, [0.5, 0.5]),
        (Procedure::Dynamic, Scheme::Ss22 { theta1, theta2 }) => (2, [theta1, theta2]),
    };
    let (codes, theta): (Vec<u8>, Vec<[f64; 2]>) = steps.iter().map(scheme).unzip();
    constant(at, "scheme", &[codes.len()], &codes, SCHEME)?;
    constant(at, "theta", &[codes.len(), 2], theta.as_flattened(), THETA)
}

/// Nodes with a support in any step, and nodes of rigid bodies that no step frees.
fn supported(model: &Model) -> Vec<usize> {
    let supports = model.steps.iter().flat_map(|step| &step.supports);
    let nodes = supports.map(|support| support.dof / 2);
    let held = model.rigid_bodies.iter().filter(|body| !body.turns);
    let nodes = nodes.chain(held.flat_map(|body| body.nodes.iter().copied()));
    nodes.filter(|&n| n < model.mesh.node_count()).collect()
}

/// Nodes with a force that is neither an internal force, an inertia force, a contact force, a reaction of a support nor
/// a load.
fn constrained(model: &Model) -> Vec<usize> {
    let equations = model.equations.iter().flat_map(|equation| equation.dofs());
    let connectors = model
        .connectors
        .iter()
        .flat_map(|c| c.nodes.iter().copied());
    let bodies = model.rigid_bodies.iter();
    let rigid = bodies.flat_map(|body| body.nodes.iter().copied().chain([body.reference]));
    let ties = model.ties.iter().flat_map(|tie| &tie.nodes);
    let tied = ties.flat_map(|tied| [tied.node, tied.segment[0], tied.segment[1]]);
    let nodes = (equations.map(|dof| dof / 2))
        .chain(connectors)
        .chain(rigid)
        .chain(tied);
    nodes.filter(|&n| n < model.mesh.node_count()).collect()
}

/// Nodes with a concentrated load, a pressure, a traction or a centrifugal force in any step, and nodes of contacts
/// whose forces fade over a static step that removes the contact.
fn loaded_nodes(model: &Model) -> Vec<usize> {
    let mut nodes: Vec<usize> = Vec::new();
    for step in &model.steps {
        let pressures = step.pressures.iter().map(|load| load.at.face);
        let tractions = step.tractions.iter().map(|load| load.at.face);
        nodes.extend(step.point_loads.iter().map(|load| load.at.dof / 2));
        let turned = step.centrifugal_forces.iter().map(|load| load.at.element);
        nodes.extend(turned.flat_map(|element| model.mesh.elements[element].nodes.iter()));
        nodes.extend((pressures.chain(tractions)).flat_map(|face| face.nodes(&model.mesh)));
        let fading = match step.procedure {
            Procedure::Static => step.contacts.removed.as_slice(),
            _ => &[],
        };
        for contact in fading.iter().map(|&index| &model.contacts[index]) {
            let surfaces = [contact.slave, contact.master].map(|index| &model.surfaces[index]);
            nodes.extend(
                surfaces
                    .iter()
                    .flat_map(|surface| surface.nodes(&model.mesh)),
            );
        }
    }
    nodes.retain(|&node| node < model.mesh.node_count());
    nodes
}

/// The properties of a body force in which elements may differ.
type Signature = (usize, bool, [u64; 3], [u64; 2]);

/// Group number of every element: elements with the same body forces have the same number, elements without body force
/// -1.
fn load_groups(model: &Model) -> Vec<i64> {
    let mut forces: Vec<Vec<Signature>> = vec![Vec::new(); model.mesh.elements.len()];
    for (number, step) in model.steps.iter().enumerate() {
        for load in &step.body_forces {
            let [x, y] = load.at.direction;
            let variation = match load.variation {
                Variation::Constant => [0, 0],
                Variation::Ramp { from } => [1, from.to_bits()],
                Variation::Amplitude(index) => [2, index as u64],
            };
            let size = [x, y, load.magnitude].map(f64::to_bits);
            let signature = (number, load.at.per_mass, size, variation);
            forces[load.at.element].push(signature);
        }
    }
    let mut numbers: BTreeMap<Vec<Signature>, i64> = BTreeMap::new();
    let mut number = |own: Vec<Signature>| match own.is_empty() {
        true => -1,
        false => {
            let next = numbers.len() as i64;
            *numbers.entry(own).or_insert(next)
        }
    };
    forces.into_iter().map(&mut number).collect()
}

/// Writes indices in increasing order, without duplicates.
fn indices(at: &Group, name: &str, mut found: Vec<usize>, text: &'static str) -> hdf5::Result<()> {
    found.sort_unstable();
    found.dedup();
    let values: Vec<i64> = found.into_iter().map(|index| index as i64).collect();
    constant(at, name, &[values.len()], &values, ("1", text))
}

const SUPPORTED: &str = "indices of nodes with a support in any step";
const CONSTRAINED: &str = "indices of nodes of equations, springs, dashpots and rigid bodies";
const LOADED_NODES: &str = "indices of nodes with a concentrated load, a pressure, a traction, a centrifugal force or the fading force of a contact";
const SLAVES: &str = "indices of the slave nodes";
const LOAD_GROUPS: Meaning = (
    "1",
    "elements with the same body forces have the same number, -1 without any",
);
const ELEMENT_TYPES: Meaning = ("1", ElementType::NUMBERS);
const MATERIAL: Meaning = (
    "1",
    "index of the material in /model/materials, -1 for none",
);
const THICKNESS: Meaning = (
    "length",
    "thickness of each element; NaN in bodies of revolution, which go once around the axis",
);
const LAW: Meaning = (
    "1",
    "0 St. Venant-Kirchhoff, 1 neo-Hooke, 2 another polynomial of the invariants, 3 metal with J2 plasticity, 4 Ogden, 5 Hencky",
);
const SHAPE: Meaning = (
    "force/length^2",
    "C10, C20, C30 and C01 of a hyperelastic law, else zero",
);
const COMPRESSIBILITY: Meaning = (
    "length^2/force",
    "D1, D2, D3 of a hyperelastic law, else zero; zero for no term",
);
const OGDEN_MU: Meaning = (
    "force/length^2",
    "mu1, mu2, mu3 of an Ogden material, else zero",
);
const OGDEN_ALPHA: Meaning = (
    "1",
    "alpha1, alpha2, alpha3 of an Ogden material, else zero",
);
const YOUNG: Meaning = ("force/length^2", "Young's modulus at small strains");
const POISSON: Meaning = ("1", "Poisson's ratio at small strains");
const DENSITY: Meaning = ("mass/length^3", "density of the undeformed material");
const ALPHA: Meaning = ("1/time", "damping in proportion to the mass");
const BETA: Meaning = ("time", "damping in proportion to the elasticity");
const EXPANSION_ZERO: Meaning = (
    "temperature",
    "temperature from which the coefficient of thermal expansion counts, NaN of materials that do not expand",
);
const EXPANSION: Meaning = (
    "1",
    "rows of all materials: index of the material, temperature, coefficient of thermal expansion (1/temperature)",
);
const SEGMENTS: Meaning = (
    "1",
    "node indices of the master segments, its body on the left of the way from the first to the second",
);
const SLAVE_FACES: Meaning = (
    "1",
    "node indices of the slave faces, their body on the left of the way from the first to the second; none of a surface of nodes",
);
const BULGES: Meaning = (
    "length",
    "c0 to c3 of the bulge of every master segment: how far its curved face is out of the body from the chord, a cubic of the place on it, 0 at its first node and 1 at its second",
);
const FACE_BULGES: Meaning = (
    "length",
    "the same of every slave face; of a surface of nodes, of the exterior faces at them",
);
const DISC_RADIUS: Meaning = ("length", "radius of the slave, a disc about its node");
const DISC_ARM: Meaning = ("1", "index of the node that takes the turning of the disc");
const ARCS: Meaning = (
    "1",
    "first chord of each arc of the master among its segments, and the one after the last",
);
const ARC_CENTRES: Meaning = (
    "length",
    "centres of the arcs of the master in the undeformed configuration",
);
const ACTS: Meaning = (
    "1",
    "whether the contact acts in each step: 1, or 0 where it is removed",
);
const FRICTION_COEFFICIENTS: Meaning = (
    "1",
    "of every step the coefficient of friction at rest and that of fast slip; NaN of a table",
);
const FRICTION_DECAY: Meaning = (
    "time/length",
    "of every step the decay from the coefficient at rest to that of fast slip; NaN of a table",
);
const TABLE_STEPS: Meaning = ("1", "step of every row of the tables of friction, from 1");
/// Columns of the tables of friction.
const TABLE: [(&str, Meaning); 3] = [
    (
        "table_pressures",
        (
            "force/length^2",
            "pressure of every row of the tables of friction",
        ),
    ),
    (
        "table_slip_rates",
        (
            "length/time",
            "slip rate of every row of the tables of friction",
        ),
    ),
    (
        "table_coefficients",
        (
            "1",
            "coefficient of friction of every row of the tables of friction",
        ),
    ),
];
const SHEAR_LIMIT: Meaning = (
    "force/length^2",
    "largest shear stress of friction in every step; infinite without",
);
const FRICTION_RAMPS: Meaning = (
    "1",
    "whether another friction gives way to this one in each step",
);
const HEAT: Meaning = (
    "1",
    "part of the energy dissipated by friction that is in FRICTION_HEAT",
);
const FRICTION: Meaning = (
    "1",
    "coefficient of friction at rest and of fast slip, or the largest and smallest of a table, below TAUMAX, or of all steps",
);
const SCHEME: Meaning = ("1", "0 static, 1 energy-momentum, 2 SS22, 3 backward Euler");
const THETA: Meaning = ("1", "weights theta1 and theta2 of the scheme");
