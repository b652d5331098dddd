//! Group `/VTKHDF`: the field frames, as a temporal unstructured grid with a fixed mesh.

use std::iter::repeat_n;
use std::rc::Rc;
use std::sync::Arc;

use hdf5::Group;
use hdf5::types::FixedAscii;

use super::column::{
    GrowingColumns, Layout, Meaning, Mostly, Number, constant, group, new_attribute,
};
use super::frames::{Frame, expected_frames};
use super::local::Local;
use super::model_group::{body_numbers, connectivity};
use crate::elements::{ElementResult, Elements, LocalResult, MeanGradient, logarithmic_of};
use crate::model::{Bodies, Interaction, Mesh, Model, NodalVariable};

/// VTK cell type of a rigid segment.
const VTK_LINE: u8 = 3;

/// Largest number of frames of a chunk; a chunk has many frames because each chunk costs a system call.
const CHUNK_FRAMES: usize = 32;

/// Creates the group with the reference mesh and no frame; returns the datasets that grow with the frames.
pub(crate) fn create<'m>(
    root: &Group,
    model: &Model,
    local: &Arc<Elements>,
) -> hdf5::Result<GrowingColumns<'m, Frame>> {
    let grid = group(root, "VTKHDF")?;
    write_type(&grid)?;
    let lines = model.rigid_segments();
    write_mesh(&grid, &model.mesh, &lines)?;
    let at = group(&grid, "Steps")?;
    let mut steps = GrowingColumns::new();
    steps.count(&at, "NSteps", |_| 1)?;
    per_frame(&mut steps, &at, "Values", &[], TIME, |frame| frame.time)?;
    for (name, row, text, value) in STEPS {
        per_frame(&mut steps, &at, name, row, ("1", text), move |_| value)?;
    }
    let chunk = even_part(expected_frames(model), CHUNK_FRAMES);
    let fields_of = |kind: &str, rows: usize, columns| -> hdf5::Result<FieldGroup> {
        Ok(FieldGroup {
            data: group(&grid, &format!("{kind}Data"))?,
            offsets: group(&at, &format!("{kind}DataOffsets"))?,
            first_field: None,
            columns,
            rows,
            chunk,
        })
    };
    let mut points = fields_of("Point", model.mesh.node_count(), steps)?;
    points.create_points(model)?;
    points.create_at_nodes(model, local)?;
    let cells = model.mesh.elements.len() + lines.len();
    let mut cells = fields_of("Cell", cells, points.columns)?;
    cells.create_cells(model, lines.len())?;
    Ok(cells.columns)
}

/// Creates a dataset with a value of every frame, in a row of the given shape.
fn per_frame<'m, T: Number + 'm>(
    all: &mut GrowingColumns<'m, Frame>,
    at: &Group,
    name: &str,
    row: &[usize],
    meaning: Meaning,
    mut value: impl FnMut(&Frame) -> T + 'm,
) -> hdf5::Result<()> {
    let layout = Layout::one_by_one::<T>(row, Mostly::Varied);
    all.add(at, name, layout, meaning, move |frame, values| {
        values.push(value(frame));
    })
}

/// Fields of the nodes (`PointData`), or of the cells (`CellData`), which are first elements, then segments of rigid
/// surfaces.
struct FieldGroup<'m> {
    data: Group,
    /// Group with the first rows of the frames; it has one dataset, which is linked under the name of every field.
    offsets: Group,
    first_field: Option<&'static str>,
    /// All datasets of a frame: the datasets of the fields, and the datasets that were created before.
    columns: GrowingColumns<'m, Frame>,
    /// Number of rows of a frame.
    rows: usize,
    /// Largest number of frames in a chunk of the fields.
    chunk: usize,
}

/// The shape of a row of a field, and the shape of its first entries that are written; all others are zero.
type RowShape = (&'static [usize], &'static [usize]);

const SCALAR: RowShape = (&[], &[]);
/// A symmetric tensor xx yy zz xy yz xz, as VTK orders and ParaView names six components; the last two are zero.
const TENSOR: RowShape = (&[6], &[4]);
/// A vector in the plane, whose third component is zero.
const IN_SPACE: RowShape = (&[3], &[2]);

impl<'m> FieldGroup<'m> {
    /// Creates a field with the first rows of its frames; `values` appends whole rows of a frame.
    fn add<T: Number + 'm>(
        &mut self,
        name: &'static str,
        (row, given): RowShape,
        mostly: Mostly,
        meaning: Meaning,
        values: impl FnMut(&Frame, &mut Vec<T>) + 'm,
    ) -> hdf5::Result<()> {
        match self.first_field {
            Some(first) => self.offsets.link_hard(first, name)?,
            None => {
                let (at, rows) = (&self.offsets, self.rows);
                per_frame(&mut self.columns, at, name, &[], FIRST_ROW, move |frame| {
                    (frame.index * rows) as i64
                })?;
                self.first_field = Some(name);
            }
        }
        let layout = Layout::in_frames::<T>(row, given, mostly, [self.rows, self.chunk]);
        self.columns.add(&self.data, name, layout, meaning, values)
    }

    fn create_points(&mut self, model: &Model) -> hdf5::Result<()> {
        let [nodal, concentrated] = [&NODAL[..], &CONCENTRATED];
        let is_asked = model.sets.fields.concentrated_load;
        let of_contacts = |has: fn(&Interaction) -> bool| {
            (model.contacts.iter()).any(|contact| has(&contact.interaction))
        };
        let has = [
            model.has_varying_friction(),
            of_contacts(|own| own.wear.is_some() || own.heat.is_some()),
            of_contacts(|own| own.wear.is_some()),
            of_contacts(|own| own.heat.is_some()),
        ];
        let friction: Vec<NodalField> = (FRICTION.into_iter().zip(has))
            .filter_map(|(field, has)| has.then_some(field))
            .collect();
        let concentrated = if is_asked { concentrated } else { &[] };
        let temperature: &[NodalField] = match model.has_temperatures() {
            true => &TEMPERATURE,
            false => &[],
        };
        let tables = [nodal, concentrated, temperature, &friction].into_iter();
        for &(name, row, mostly, dimension, text, of) in tables.flatten() {
            self.add(name, row, mostly, (dimension, text), move |frame, v| {
                v.extend_from_slice(of(frame));
            })?;
        }
        self.add(
            "CONTACT_STATUS",
            SCALAR,
            Mostly::Zero,
            STATUS,
            |frame, v| {
                v.extend(frame.nodal.status.iter().map(|&status| status as u8));
            },
        )?;
        if model.redistributes_mass() {
            self.add("CONTACT_MASS", SCALAR, Mostly::Zero, MASS, |frame, v| {
                v.extend(frame.nodal.mass.iter().map(|&mass| mass as u8));
            })?;
        }
        Ok(())
    }

    /// A field at nodes of elements, with W values at each node; it is NaN at other nodes.
    fn add_at_nodes<const W: usize>(
        &mut self,
        name: &'static str,
        shape: RowShape,
        meaning: Meaning,
        (local, nodes): (&Rc<Local>, &Rc<[usize]>),
        of: impl Fn(&LocalResult) -> [f64; W] + 'm,
    ) -> hdf5::Result<()> {
        let (local, nodes, count) = (local.clone(), nodes.clone(), self.rows);
        self.add(name, shape, Mostly::Varied, meaning, move |frame, v| {
            let first = v.len();
            v.resize(first + W * count, f64::NAN);
            let own = local.of(frame.index, &frame.state);
            for (&node, result) in nodes.iter().zip(own.iter()) {
                v[first + W * node..][..W].copy_from_slice(&of(result));
            }
        })
    }

    /// Creates the fields of elements at nodes; nodes without elements have NaN.
    fn create_at_nodes(&mut self, model: &Model, elements: &Arc<Elements>) -> hdf5::Result<()> {
        let asked = &model.sets.fields.at_nodes;
        if asked.is_empty() {
            return Ok(());
        }
        let members: Vec<usize> = (0..model.mesh.elements.len()).collect();
        let local = Rc::new(Local::at_nodes(elements, &members));
        let nodes: Rc<[usize]> = local.nodes().into();
        let own = (&local, &nodes);
        let tensors = AT_NODES.iter().filter(|field| asked.contains(&field.0));
        for &(_, name, meaning, of) in tensors {
            self.add_at_nodes(name, TENSOR, meaning, own, of)?;
        }
        let scalars = SCALARS_AT_NODES
            .iter()
            .filter(|field| asked.contains(&field.0));
        for &(_, name, meaning, of) in scalars {
            self.add_at_nodes(name, SCALAR, meaning, own, move |e| [of(e)])?;
        }
        Ok(())
    }

    /// Creates the fields of cells; the last `lines` cells are rigid segments and have NaN.
    fn create_cells(&mut self, model: &Model, lines: usize) -> hdf5::Result<()> {
        let bodies = Bodies::new(&model.mesh).of_element.into_iter().map(Some);
        let bodies = body_numbers(bodies.chain(repeat_n(None, lines)));
        constant(&self.data, "BODY", &[bodies.len()], &bodies, BODY)?;
        let at = &self.offsets;
        // the same in all frames
        per_frame(&mut self.columns, at, "BODY", &[], FIRST_ROW, |_| 0_i64)?;
        for (name, meaning, of) in TENSORS {
            self.add_to_elements(name, TENSOR, meaning, move |frame, v| {
                v.extend(frame.elements.iter().flat_map(of));
            })?;
        }
        let asked = &model.sets.fields;
        for (is_there, fields) in [
            (true, &SCALARS[..]),
            (asked.principal_stress, &PRINCIPAL),
            (asked.pressure, &PRESSURE),
            (model.writes_plastic_strain(), &PLASTIC),
            (model.has_hourglass_modes(), &HOURGLASS),
        ] {
            for &(name, meaning, of) in fields.iter().filter(|_| is_there) {
                self.add_to_elements(name, SCALAR, meaning, move |frame, v| {
                    v.extend(frame.elements.iter().map(of));
                })?;
            }
        }
        let elements = &model.mesh.elements;
        if asked.energy_density {
            let volume = |e| model.mesh.volume(e, model.sections[e.section].thickness);
            let volumes: Vec<f64> = elements.iter().map(volume).collect();
            self.add_to_elements("ENER", SCALAR, ENERGY_DENSITY, move |frame, v| {
                let elements = frame.elements.iter().zip(&volumes);
                v.extend(elements.map(|(e, volume)| e.energy / *volume));
            })?;
        }
        if asked.logarithmic_strain {
            let gradients = elements.iter().map(|e| MeanGradient::new(&model.mesh, e));
            let gradients: Vec<MeanGradient> = gradients.collect();
            self.add_to_elements("LE", TENSOR, LOGARITHMIC_STRAIN, move |frame, v| {
                let elements = gradients.iter().zip(frame.elements.iter());
                v.extend(elements.flat_map(|(mean, e)| {
                    let in_plane = mean.logarithmic_strain(&frame.state.u);
                    with_across(in_plane, logarithmic_of(e.strain_across))
                }));
            })?;
        }
        Ok(())
    }

    /// A field of the elements, which is NaN on rigid segments.
    fn add_to_elements(
        &mut self,
        name: &'static str,
        shape: RowShape,
        meaning: Meaning,
        mut values: impl FnMut(&Frame, &mut Vec<f64>) + 'm,
    ) -> hdf5::Result<()> {
        let size = self.rows * shape.1.iter().product::<usize>();
        self.add(name, shape, Mostly::Varied, meaning, move |frame, v| {
            let first = v.len();
            values(frame, v);
            v.resize(first + size, f64::NAN);
        })
    }
}

/// The components of a tensor that are written, made from those in the plane and the one across it.
fn with_across([xx, yy, xy]: [f64; 3], zz: f64) -> [f64; 4] {
    [xx, yy, zz, xy]
}

/// Size of each part when `count` is divided evenly into as few parts as possible, of at most `most` each.
fn even_part(count: usize, most: usize) -> usize {
    let parts = count.div_ceil(most).max(1);
    count.div_ceil(parts).max(1)
}

/// Writes the attributes by which readers recognise the group.
fn write_type(grid: &Group) -> hdf5::Result<()> {
    let version = grid.new_attr::<i64>().shape([2]).create("Version")?;
    version.write_raw(&[2i64, 3])?;
    let name = FixedAscii::<16>::from_ascii("UnstructuredGrid")
        .map_err(|error| hdf5::Error::from(error.to_string()))?;
    new_attribute(grid, "Type", name)
}

/// Writes the reference mesh, with lines between its nodes as the last cells.
fn write_mesh(grid: &Group, mesh: &Mesh, lines: &[[usize; 2]]) -> hdf5::Result<()> {
    let mut connectivity = connectivity(mesh);
    connectivity.extend(lines.as_flattened().iter().map(|&node| node as i64));
    let topologies = || mesh.elements.iter().map(|e| e.element_type.topology());
    let sizes = mesh.elements.iter().map(|element| element.nodes.len());
    let mut offsets = vec![0];
    for size in sizes.chain(repeat_n(2, lines.len())) {
        offsets.push(offsets[offsets.len() - 1] + size as i64);
    }
    let types: Vec<u8> = topologies().map(|topology| topology.vtk_cell).collect();
    let types = [types, vec![VTK_LINE; lines.len()]].concat();
    let points = mesh.coordinates.iter().flat_map(|x| [x[0], x[1], 0.0]);
    let points: Vec<f64> = points.collect();
    for (name, count, text) in [
        ("NumberOfPoints", mesh.node_count(), "number of nodes N"),
        (
            "NumberOfCells",
            types.len(),
            "number of elements and rigid segments",
        ),
        (
            "NumberOfConnectivityIds",
            connectivity.len(),
            "length of the connectivity",
        ),
    ] {
        constant(grid, name, &[1], &[count as i64], ("1", text))?;
    }
    let text = ("length", "reference coordinates");
    constant(grid, "Points", &[mesh.node_count(), 3], &points, text)?;
    let text = ("1", "node indices of all cells, one cell after the other");
    constant(
        grid,
        "Connectivity",
        &[connectivity.len()],
        &connectivity,
        text,
    )?;
    let text = ("1", "where each cell's nodes start in the connectivity");
    constant(grid, "Offsets", &[offsets.len()], &offsets, text)?;
    let text = (
        "1",
        "cell type: 3 rigid segment, 5 triangle, 9 quadrilateral",
    );
    constant(grid, "Types", &[types.len()], &types, text)
}

const TIME: Meaning = ("time", "time of the frame");
const FIRST_ROW: Meaning = ("1", "first row of the frame");
const STATUS: Meaning = (
    "1",
    "contact status, as slave, or as master of means: 0 none, 1 open, 2 stick, 3 slip",
);
const MASS: Meaning = (
    "1",
    "mass: 0 own, 1 own at a contact surface, 2 carried by other nodes",
);
const BODY: Meaning = ("1", "body of the cell, -1 for rigid segments");
const STRESS: Meaning = (
    "force/length^2",
    "Cauchy stress xx yy zz xy yz xz, mean over the element",
);
const VON_MISES: Meaning = ("force/length^2", "von Mises stress of S");
const STRAIN: Meaning = (
    "1",
    "Green-Lagrange strain xx yy zz xy yz xz (tensor components), mean over the element",
);
pub(crate) const ENERGY_DENSITY: Meaning = (
    "energy/length^3",
    "strain energy over the volume of the undeformed element",
);
const LOGARITHMIC_STRAIN: Meaning = (
    "1",
    "logarithmic strain xx yy zz xy yz xz (tensor components) of the element's mean deformation gradient",
);

/// Datasets of `Steps` whose number is the same in all frames, given by name, shape of a row, meaning, and number.
#[rustfmt::skip]
const STEPS: [(&str, &[usize], &str, i64); 5] = [
    ("NumberOfParts", &[], "grids of the frame", 1),
    ("PartOffsets", &[], "first grid of the frame", 0),
    ("PointOffsets", &[], "first node of the frame's grid", 0),
    ("CellOffsets", &[1], "first cell of the frame's grid", 0),
    ("ConnectivityIdOffsets", &[1], "first entry of the frame's connectivity", 0),
];

/// A field of the nodes: name, shape of a row, value of most rows, dimension, meaning and values.
type NodalField = (
    &'static str,
    RowShape,
    Mostly,
    &'static str,
    &'static str,
    fn(&Frame) -> &[f64],
);

#[rustfmt::skip]
const NODAL: [NodalField; 8] = [
    ("U", IN_SPACE, Mostly::Varied, "length", "displacement", |f| &f.state.u),
    ("V", IN_SPACE, Mostly::Varied, "length/time", "velocity", |f| &f.state.v),
    ("A", IN_SPACE, Mostly::Varied, "length/time^2", "acceleration", |f| &f.state.a),
    ("RF", IN_SPACE, Mostly::Zero, "force", "support reaction", |f| &f.nodal.reaction),
    ("CONTACT_FORCE", IN_SPACE, Mostly::Zero, "force", "contact force on the node", |f| &f.nodal.contact_force),
    ("GAP", SCALAR, Mostly::Nan, "length",
     "gap of the slave node to its segment, or mean gap, NaN without candidate", |f| &f.nodal.gap),
    ("CONTACT_PRESSURE", SCALAR, Mostly::Nan, "force/length^2",
     "contact pressure at slave nodes, and at masters of means, NaN at others", |f| &f.nodal.pressure),
    ("SLIP", SCALAR, Mostly::Nan, "length",
     "slip accumulated since the start at slave nodes, and at masters of means, NaN at others", |f| &f.nodal.slip),
];

/// The concentrated loads, a field that is written only on request of the deck.
#[rustfmt::skip]
const CONCENTRATED: [NodalField; 1] = [
    ("CF", IN_SPACE, Mostly::Zero, "force", "concentrated loads on the node", |f| &f.nodal.concentrated),
];

/// A field of models with temperatures.
#[rustfmt::skip]
const TEMPERATURE: [NodalField; 1] = [
    ("TEMPERATURE", SCALAR, Mostly::Varied, "temperature", "temperature of the node", |f| &f.state.temperature),
];

/// Fields of models in which the coefficient of friction of a contact varies, and of models with wear or heat.
#[rustfmt::skip]
const FRICTION: [NodalField; 4] = [
    ("FRICTION_COEFFICIENT", SCALAR, Mostly::Nan, "1",
     "coefficient of friction of the slave node's pairs, mean by Pn, NaN without contact",
     |f| &f.nodal.friction.coefficient),
    ("FRICTION_WORK", SCALAR, Mostly::Nan, "energy/length^2",
     "work of friction since the start over the area of the slave node, NaN at others", |f| &f.nodal.friction.work),
    ("WEAR", SCALAR, Mostly::Nan, "length",
     "depth of wear since the start at slave nodes, NaN at others", |f| &f.nodal.friction.wear),
    ("FRICTION_HEAT", SCALAR, Mostly::Nan, "energy",
     "heat of friction since the start into the surface at slave nodes, NaN at others", |f| &f.nodal.friction.heat),
];

/// A field of the elements: name, meaning and value.
type ElementField<T> = (&'static str, Meaning, fn(&ElementResult) -> T);

#[rustfmt::skip]
const TENSORS: [ElementField<[f64; 4]>; 2] = [
    ("S", STRESS, |e| with_across(e.stress, e.across)),
    ("E", STRAIN, |e| with_across(e.strain, e.strain_across)),
];

const SCALARS: [ElementField<f64>; 1] = [("MISES", VON_MISES, ElementResult::von_mises)];

/// Fields that are written only on request of the deck.
#[rustfmt::skip]
const PRINCIPAL: [ElementField<f64>; 3] = [
    ("SP1", ("force/length^2", "smallest principal value of S"), |e| e.principal_stresses()[0]),
    ("SP2", ("force/length^2", "middle principal value of S"), |e| e.principal_stresses()[1]),
    ("SP3", ("force/length^2", "largest principal value of S"), |e| e.principal_stresses()[2]),
];

/// A field of models with metals.
const PLASTIC: [ElementField<f64>; 1] = [("PEEQ", PLASTIC_STRAIN, |e| e.plastic_strain)];

/// A field of models with elements of constant strain and hourglass modes.
const HOURGLASS: [ElementField<f64>; 1] = [(
    "ELHE",
    ("energy", "strain energy of the element in hourglass modes"),
    |e| e.hourglass_energy,
)];

/// A field of elements at nodes: the request for it, name, meaning and value.
type FieldAtNodes<T> = (NodalVariable, &'static str, Meaning, fn(&LocalResult) -> T);

#[rustfmt::skip]
const AT_NODES: [FieldAtNodes<[f64; 4]>; 3] = [
    (NodalVariable::Stress, "S_AT_NODES",
     ("force/length^2", "Cauchy stress xx yy zz xy yz xz at nodes, mean of the elements there"),
     |e| with_across(e.result.stress, e.result.across)),
    (NodalVariable::Strain, "E_AT_NODES",
     ("1", "Green-Lagrange strain xx yy zz xy yz xz (tensor components) at nodes, mean of the elements there"),
     |e| with_across(e.result.strain, e.result.strain_across)),
    (NodalVariable::LogarithmicStrain, "LE_AT_NODES",
     ("1", "logarithmic strain xx yy zz xy yz xz (tensor components) at nodes, mean of the elements there"),
     |e| with_across(e.logarithmic_strain, e.logarithmic_across)),
];

#[rustfmt::skip]
const SCALARS_AT_NODES: [FieldAtNodes<f64>; 7] = [
    (NodalVariable::Stress, "MISES_AT_NODES",
     ("force/length^2", "von Mises stress of the stresses at nodes"), |e| e.result.von_mises()),
    (NodalVariable::PrincipalStress, "SP1_AT_NODES",
     ("force/length^2", "smallest principal value of the stresses at nodes"), |e| e.result.principal_stresses()[0]),
    (NodalVariable::PrincipalStress, "SP2_AT_NODES",
     ("force/length^2", "middle principal value of the stresses at nodes"), |e| e.result.principal_stresses()[1]),
    (NodalVariable::PrincipalStress, "SP3_AT_NODES",
     ("force/length^2", "largest principal value of the stresses at nodes"), |e| e.result.principal_stresses()[2]),
    (NodalVariable::Pressure, "PRESS_AT_NODES",
     ("force/length^2", "pressure -(xx + yy + zz)/3 of the stresses at nodes"), |e| e.result.pressure()),
    (NodalVariable::EnergyDensity, "ENER_AT_NODES",
     ("energy/length^3", "strain energy over undeformed volume at nodes, without that of hourglass modes"),
     |e| e.result.energy),
    (NodalVariable::PlasticStrain, "PEEQ_AT_NODES",
     ("1", "accumulated plastic strain at nodes, mean of the elements there"), |e| e.result.plastic_strain),
];

/// Meaning of `PEEQ`.
pub(super) const PLASTIC_STRAIN: Meaning =
    ("1", "accumulated plastic strain, mean over the element");

/// A field of elements that is written only on request of the deck.
#[rustfmt::skip]
const PRESSURE: [ElementField<f64>; 1] = [
    ("PRESS", ("force/length^2", "pressure -(xx + yy + zz)/3 of S"), ElementResult::pressure),
];

#[cfg(test)]
mod tests {
    use super::even_part;

    #[test]
    fn frames_are_divided_evenly_into_few_chunks() {
        let cases = [(0, 1), (1, 1), (32, 32), (33, 17), (101, 26), (1001, 32)];
        for (frames, expected) in cases {
            assert_eq!(even_part(frames, 32), expected, "{frames}");
        }
    }
}
