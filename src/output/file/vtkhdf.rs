//! Group `/VTKHDF`: the field frames, as a temporal unstructured grid with a fixed mesh.

use hdf5::types::FixedAscii;
use hdf5::{Group, H5Type};

use super::dataset::{Column, Meaning, group, meaning, set_attribute};
use super::mesh::{write_bodies, write_mesh};
use crate::dynamics::{NodalResults, State};
use crate::elements::ElementResult;
use crate::model::{ContactMass, Model, Step};
use crate::output::frame::Frame;

/// A field with `3` components (or one) per node or element.
struct Field<T>(Column<T>);

impl<T: H5Type + Copy> Field<T> {
    fn push(&mut self, values: impl IntoIterator<Item = T>) -> hdf5::Result<()> {
        self.0.push(values)?;
        self.0.flush()
    }
}

/// The steps of the grid: their times and where their geometry starts (always at 0).
struct Steps {
    group: Group,
    values: Column<f64>,
    parts: Column<i64>,
    zeros: Vec<Column<i64>>,
}

/// Writes the field frames.
pub(crate) struct Fields {
    steps: Steps,
    points: PointFields,
    cells: CellFields,
}

/// Fields of the nodes, group `PointData`.
struct PointFields {
    offsets: Offsets,
    displacement: Field<f64>,
    velocity: Field<f64>,
    acceleration: Field<f64>,
    reaction: Field<f64>,
    contact_force: Field<f64>,
    gap: Field<f64>,
    status: Field<u8>,
    pressure: Field<f64>,
    slip: Field<f64>,
    /// With redistributed mass only.
    mass: Option<Field<u8>>,
}

/// Fields of the cells, group `CellData`: elements, then the segments of rigid surfaces.
struct CellFields {
    offsets: Offsets,
    stress: Field<f64>,
    across: Field<f64>,
    von_mises: Field<f64>,
    strain: Field<f64>,
    /// First row of `BODY`, which is the same in all frames.
    body_offsets: Column<i64>,
    /// Number of segments of rigid surfaces.
    lines: usize,
}

impl Fields {
    /// Creates the group with the reference mesh and no frame.
    pub fn create(root: &Group, model: &Model) -> hdf5::Result<Self> {
        let grid = group(root, "VTKHDF")?;
        write_type(&grid)?;
        let lines = model.rigid_segments();
        write_mesh(&grid, &model.mesh, &lines)?;
        let steps = Steps::create(&grid)?;
        let points = Place::new(&grid, &steps.group, "Point", model.mesh.node_count())?;
        let cells = model.mesh.elements.len() + lines.len();
        let cells = Place::new(&grid, &steps.group, "Cell", cells)?;
        write_bodies(&cells.data, model, lines.len())?;
        Ok(Fields {
            steps,
            points: PointFields::create(points, model)?,
            cells: CellFields::create(cells, lines.len())?,
        })
    }

    /// Appends a frame.
    pub fn write(&mut self, frame: &Frame) -> hdf5::Result<()> {
        self.points.write(&frame.state, &frame.nodal)?;
        self.cells.write(&frame.elements)?;
        self.steps.push(frame.time)
    }

    /// Frames written.
    pub fn count(&self) -> usize {
        self.steps.values.rows()
    }
}

impl PointFields {
    fn create(mut at: Place, model: &Model) -> hdf5::Result<Self> {
        let is_redistributed =
            |step: &Step| step.settings.contact_mass == ContactMass::Redistributed;
        let has_mass = model.steps.iter().any(is_redistributed);
        Ok(PointFields {
            displacement: at.field("U", &[3], meaning("displacement", "length"))?,
            velocity: at.field("V", &[3], meaning("velocity", "length/time"))?,
            acceleration: at.field("A", &[3], meaning("acceleration", "length/time^2"))?,
            reaction: at.field("RF", &[3], meaning("support reaction", "force"))?,
            contact_force: at.field("CONTACT_FORCE", &[3], CONTACT_FORCE)?,
            gap: at.field("GAP", &[], GAP)?,
            status: at.field("CONTACT_STATUS", &[], STATUS)?,
            pressure: at.field("CONTACT_PRESSURE", &[], PRESSURE)?,
            slip: at.field("SLIP", &[], SLIP)?,
            mass: match has_mass {
                true => Some(at.field("CONTACT_MASS", &[], MASS)?),
                false => None,
            },
            offsets: at.offsets,
        })
    }

    fn write(&mut self, state: &State, nodal: &NodalResults) -> hdf5::Result<()> {
        self.displacement.push(in_space(&state.u))?;
        self.velocity.push(in_space(&state.v))?;
        self.acceleration.push(in_space(&state.a))?;
        self.reaction.push(in_space(&nodal.reaction))?;
        self.contact_force.push(in_space(&nodal.contact_force))?;
        self.gap.push(nodal.gap.iter().copied())?;
        self.status.push(nodal.status.iter().map(|&s| s as u8))?;
        self.pressure.push(nodal.pressure.iter().copied())?;
        self.slip.push(nodal.slip.iter().copied())?;
        if let Some(mass) = &mut self.mass {
            mass.push(nodal.mass.iter().map(|&m| m as u8))?;
        }
        self.offsets.push()
    }
}

impl CellFields {
    fn create(mut at: Place, lines: usize) -> hdf5::Result<Self> {
        Ok(CellFields {
            stress: at.field("S", &[3], STRESS)?,
            across: at.field("S33", &[], ACROSS)?,
            von_mises: at.field("MISES", &[], VON_MISES)?,
            strain: at.field("E", &[3], STRAIN)?,
            body_offsets: Column::series(&at.offsets.group, "BODY", &[], OFFSETS)?,
            offsets: at.offsets,
            lines,
        })
    }

    /// Appends a frame; rigid segments have NaN for stress and strain.
    fn write(&mut self, elements: &[ElementResult]) -> hdf5::Result<()> {
        let of_lines = |components| std::iter::repeat_n(f64::NAN, components * self.lines);
        let stress = elements.iter().flat_map(|element| element.stress);
        self.stress.push(stress.chain(of_lines(3)))?;
        let across = elements.iter().map(|element| element.across);
        self.across.push(across.chain(of_lines(1)))?;
        let von_mises = elements.iter().map(ElementResult::von_mises);
        self.von_mises.push(von_mises.chain(of_lines(1)))?;
        let strain = elements.iter().flat_map(|element| element.strain);
        self.strain.push(strain.chain(of_lines(3)))?;
        self.body_offsets.push([0])?;
        self.body_offsets.flush()?;
        self.offsets.push()
    }
}

const CONTACT_FORCE: Meaning = meaning("contact force on the node", "force");
const GAP: Meaning = meaning(
    "gap of the slave node to its segment, NaN without candidate",
    "length",
);
const STATUS: Meaning = meaning(
    "contact status as slave: 0 none, 1 open, 2 stick, 3 slip",
    "1",
);
const PRESSURE: Meaning = meaning(
    "contact pressure at slave nodes, NaN at others",
    "force/length^2",
);
const SLIP: Meaning = meaning(
    "slip accumulated since the start at slave nodes, NaN at others",
    "length",
);
const MASS: Meaning = meaning(
    "mass: 0 own, 1 own at a contact surface, 2 carried by other nodes",
    "1",
);
const ACROSS: Meaning = meaning(
    "Cauchy stress across the thickness, mean over the element",
    "force/length^2",
);
const VON_MISES: Meaning = meaning("von Mises stress of S and S33", "force/length^2");
const STRESS: Meaning = meaning(
    "Cauchy stress xx yy xy, mean over the element",
    "force/length^2",
);
const STRAIN: Meaning = meaning(
    "Green-Lagrange strain xx yy xy (xy: tensor component), mean over the element",
    "1",
);

impl Steps {
    fn create(grid: &Group) -> hdf5::Result<Self> {
        let steps = group(grid, "Steps")?;
        set_attribute(&steps, "NSteps", 0i64)?;
        let column = |name, row: &[usize], text| {
            Column::<i64>::series(&steps, name, row, meaning(text, "1"))
        };
        Ok(Steps {
            values: Column::series(&steps, "Values", &[], meaning("time of the frame", "time"))?,
            parts: column("NumberOfParts", &[], "grids of the frame")?,
            zeros: vec![
                column("PartOffsets", &[], "first grid of the frame")?,
                column("PointOffsets", &[], "first node of the frame's grid")?,
                column("CellOffsets", &[1], "first cell of the frame's grid")?,
                column(
                    "ConnectivityIdOffsets",
                    &[1],
                    "first entry of the frame's connectivity",
                )?,
            ],
            group: steps,
        })
    }

    /// Appends a frame; the number of steps is written last.
    fn push(&mut self, time: f64) -> hdf5::Result<()> {
        for column in &mut self.zeros {
            column.push([0])?;
            column.flush()?;
        }
        self.parts.push([1])?;
        self.parts.flush()?;
        self.values.push([time])?;
        self.values.flush()?;
        set_attribute(&self.group, "NSteps", self.values.rows() as i64)
    }
}

/// The groups of one kind of fields: `PointData` or `CellData`.
struct Place {
    data: Group,
    offsets: Offsets,
    /// Rows of a frame.
    rows: usize,
}

/// First rows of the frames: one dataset, linked under the name of every field of one kind.
struct Offsets {
    group: Group,
    /// The first name, and the dataset.
    column: Option<(String, Column<i64>)>,
    /// Rows of a frame.
    rows: usize,
}

impl Offsets {
    /// Gives the dataset the name of a further field.
    fn add(&mut self, name: &str) -> hdf5::Result<()> {
        match &self.column {
            Some((first, _)) => self.group.link_hard(first, name),
            None => {
                let column = Column::series(&self.group, name, &[], OFFSETS)?;
                self.column = Some((name.to_owned(), column));
                Ok(())
            }
        }
    }

    /// Appends a frame.
    fn push(&mut self) -> hdf5::Result<()> {
        let rows = self.rows;
        self.column.iter_mut().try_for_each(|(_, column)| {
            column.push([(column.rows() * rows) as i64])?;
            column.flush()
        })
    }
}

impl Place {
    fn new(grid: &Group, steps: &Group, kind: &str, rows: usize) -> hdf5::Result<Self> {
        Ok(Place {
            data: group(grid, &format!("{kind}Data"))?,
            offsets: Offsets {
                group: group(steps, &format!("{kind}DataOffsets"))?,
                column: None,
                rows,
            },
            rows,
        })
    }

    fn field<T: H5Type + Copy>(
        &mut self,
        name: &str,
        row: &[usize],
        text: Meaning,
    ) -> hdf5::Result<Field<T>> {
        self.offsets.add(name)?;
        let column = Column::frames(&self.data, name, row, self.rows, text)?;
        Ok(Field(column))
    }
}

const OFFSETS: Meaning = meaning("first row of the frame", "1");

/// Attributes by which readers know the group.
fn write_type(grid: &Group) -> hdf5::Result<()> {
    let version = grid.new_attr::<i64>().shape([2]).create("Version")?;
    version.write_raw(&[2i64, 3])?;
    let name = FixedAscii::<16>::from_ascii("UnstructuredGrid")
        .map_err(|error| hdf5::Error::from(error.to_string()))?;
    set_attribute(grid, "Type", name)
}

/// The vectors of a plane field with a zero third component.
fn in_space(plane: &[f64]) -> impl Iterator<Item = f64> {
    plane.chunks_exact(2).flat_map(|v| [v[0], v[1], 0.0])
}
