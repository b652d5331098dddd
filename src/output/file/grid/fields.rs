//! Fields of nodes and cells.

use hdf5::Group;
use hdf5::types::FixedAscii;

use super::mesh::{write_bodies, write_mesh};
use super::place::{IN_SPACE, OFFSETS, Offsets, PLANE_TENSOR, Place, SCALAR};
use super::requested::RequestedFields;
use super::steps::Steps;
use crate::dynamics::{NodalResults, State};
use crate::elements::ElementResult;
use crate::model::{ContactMass, Model, Step};
use crate::output::file::column::{Column, Columns, Growing, Mostly};
use crate::output::file::dataset::{Meaning, group, meaning, set_attribute};
use crate::output::frame::Frame;
use crate::output::frames::expected_frames;

/// Writes the field frames.
pub(crate) struct Fields {
    steps: Steps,
    points: PointFields,
    cells: CellFields,
    /// Bytes of a frame.
    frame_bytes: usize,
    /// Frames that wait in memory at most.
    most_pending: usize,
    pending: usize,
}

/// Fields of the nodes, group `PointData`.
struct PointFields {
    offsets: Offsets,
    displacement: Column<f64>,
    velocity: Column<f64>,
    acceleration: Column<f64>,
    reaction: Column<f64>,
    contact_force: Column<f64>,
    gap: Column<f64>,
    status: Column<u8>,
    pressure: Column<f64>,
    slip: Column<f64>,
    /// On request only.
    concentrated: Option<Column<f64>>,
    /// With redistributed mass only.
    mass: Option<Column<u8>>,
}

/// Fields of the cells, group `CellData`: elements, then the segments of rigid surfaces.
struct CellFields {
    offsets: Offsets,
    stress: Column<f64>,
    across: Column<f64>,
    von_mises: Column<f64>,
    strain: Column<f64>,
    requested: RequestedFields,
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
        let frames = expected_frames(model);
        let groups = [&grid, steps.group()];
        let points = Place::new(groups, "Point", model.mesh.node_count(), frames)?;
        let cells = model.mesh.elements.len() + lines.len();
        let cells = Place::new(groups, "Cell", cells, frames)?;
        write_bodies(&cells.data, model, lines.len())?;
        let mut fields = Fields {
            steps,
            points: PointFields::create(points, model)?,
            cells: CellFields::create(cells, model, lines.len())?,
            frame_bytes: 0,
            most_pending: 1,
            pending: 0,
        };
        let bytes = |columns: Columns| columns.iter().map(|c| c.row_bytes()).sum::<usize>();
        let points = fields.points.offsets.rows * bytes(fields.points.columns());
        fields.frame_bytes = points + fields.cells.offsets.rows * bytes(fields.cells.columns());
        Ok(fields)
    }

    /// Lets frames of up to `bytes` bytes wait in memory, or one.
    pub fn let_wait(&mut self, bytes: usize) {
        self.most_pending = (bytes / self.frame_bytes.max(1)).max(1);
    }

    /// Appends a frame, which waits in memory.
    pub fn push(&mut self, frame: &Frame) {
        self.points.push(&frame.state, &frame.nodal);
        self.cells.push(&frame.elements, &frame.state.u);
        self.steps.push(frame.time);
        self.pending += 1;
    }

    /// Frames that wait in memory.
    pub fn pending(&self) -> usize {
        self.pending
    }

    /// Whether no further frame may wait.
    pub fn is_full(&self) -> bool {
        self.pending >= self.most_pending
    }

    /// Writes the frames that wait, but not their number.
    pub fn flush(&mut self) -> hdf5::Result<()> {
        let Fields { points, cells, .. } = self;
        for column in points.columns().into_iter().chain(cells.columns()) {
            column.flush()?;
        }
        points.offsets.flush()?;
        cells.offsets.flush()?;
        cells.body_offsets.flush()?;
        self.steps.flush()?;
        self.pending = 0;
        Ok(())
    }

    /// Writes the number of frames.
    pub fn note_count(&self) -> hdf5::Result<()> {
        self.steps.note_count()
    }

    /// Bytes by which the file may grow until the frames are written.
    pub fn growth(&mut self) -> u64 {
        let frames = self.most_pending;
        let of = |columns: Columns, rows: usize| -> u64 {
            columns
                .iter()
                .map(|column| column.growth(frames * rows))
                .sum()
        };
        let [nodes, elements] = [self.points.offsets.rows, self.cells.offsets.rows];
        let points = of(self.points.columns(), nodes);
        let cells = of(self.cells.columns(), elements);
        let offsets = 3 * self.cells.body_offsets.growth(frames);
        points + cells + offsets + self.steps.growth(frames)
    }

    /// Frames appended.
    pub fn count(&self) -> usize {
        self.steps.count()
    }
}

impl PointFields {
    fn create(mut at: Place, model: &Model) -> hdf5::Result<Self> {
        let is_redistributed =
            |step: &Step| step.settings.contact_mass == ContactMass::Redistributed;
        let has_mass = model.steps.iter().any(is_redistributed);
        let mut vector = |name, mostly, text| at.field(name, IN_SPACE, mostly, text);
        let displacement = vector("U", Mostly::Varied, meaning("displacement", "length"))?;
        let velocity = vector("V", Mostly::Varied, meaning("velocity", "length/time"))?;
        let acceleration = vector(
            "A",
            Mostly::Varied,
            meaning("acceleration", "length/time^2"),
        )?;
        let reaction = vector("RF", Mostly::Zero, meaning("support reaction", "force"))?;
        let contact_force = vector("CONTACT_FORCE", Mostly::Zero, CONTACT_FORCE)?;
        let is_asked = model.sets.fields.concentrated_load;
        let concentrated = is_asked.then(|| vector("CF", Mostly::Zero, CONCENTRATED));
        Ok(PointFields {
            displacement,
            velocity,
            acceleration,
            reaction,
            contact_force,
            concentrated: concentrated.transpose()?,
            gap: at.field("GAP", SCALAR, Mostly::Nan, GAP)?,
            status: at.field("CONTACT_STATUS", SCALAR, Mostly::Zero, STATUS)?,
            pressure: at.field("CONTACT_PRESSURE", SCALAR, Mostly::Nan, PRESSURE)?,
            slip: at.field("SLIP", SCALAR, Mostly::Nan, SLIP)?,
            mass: match has_mass {
                true => Some(at.field("CONTACT_MASS", SCALAR, Mostly::Zero, MASS)?),
                false => None,
            },
            offsets: at.offsets,
        })
    }

    fn push(&mut self, state: &State, nodal: &NodalResults) {
        self.displacement.push_slice(&state.u);
        self.velocity.push_slice(&state.v);
        self.acceleration.push_slice(&state.a);
        self.reaction.push_slice(&nodal.reaction);
        self.contact_force.push_slice(&nodal.contact_force);
        self.gap.push_slice(&nodal.gap);
        self.status.push(nodal.status.iter().map(|&s| s as u8));
        self.pressure.push_slice(&nodal.pressure);
        self.slip.push_slice(&nodal.slip);
        if let Some(concentrated) = &mut self.concentrated {
            concentrated.push_slice(&nodal.concentrated);
        }
        if let Some(mass) = &mut self.mass {
            mass.push(nodal.mass.iter().map(|&m| m as u8));
        }
        self.offsets.push();
    }

    /// The datasets with a row per node.
    fn columns(&mut self) -> Columns<'_> {
        let mut all: Columns = vec![
            &mut self.displacement,
            &mut self.velocity,
            &mut self.acceleration,
            &mut self.reaction,
            &mut self.contact_force,
            &mut self.gap,
            &mut self.status,
            &mut self.pressure,
            &mut self.slip,
        ];
        all.extend(
            self.concentrated
                .iter_mut()
                .map(|loads| -> &mut dyn Growing { loads }),
        );
        all.extend(
            self.mass
                .iter_mut()
                .map(|mass| -> &mut dyn Growing { mass }),
        );
        all
    }
}

impl CellFields {
    fn create(mut at: Place, model: &Model, lines: usize) -> hdf5::Result<Self> {
        Ok(CellFields {
            stress: at.field("S", PLANE_TENSOR, Mostly::Varied, STRESS)?,
            across: at.field("S33", SCALAR, Mostly::Varied, ACROSS)?,
            von_mises: at.field("MISES", SCALAR, Mostly::Varied, VON_MISES)?,
            strain: at.field("E", PLANE_TENSOR, Mostly::Varied, STRAIN)?,
            requested: RequestedFields::create(&mut at, model, lines)?,
            body_offsets: Column::series(&at.offsets.group, "BODY", &[], OFFSETS)?,
            offsets: at.offsets,
            lines,
        })
    }

    /// Appends a frame; rigid segments have NaN for stress and strain.
    fn push(&mut self, elements: &[ElementResult], u: &[f64]) {
        let of_lines = |components| std::iter::repeat_n(f64::NAN, components * self.lines);
        let stress = elements.iter().flat_map(|element| element.stress);
        self.stress.push(stress.chain(of_lines(3)));
        let across = elements.iter().map(|element| element.across);
        self.across.push(across.chain(of_lines(1)));
        let von_mises = elements.iter().map(ElementResult::von_mises);
        self.von_mises.push(von_mises.chain(of_lines(1)));
        let strain = elements.iter().flat_map(|element| element.strain);
        self.strain.push(strain.chain(of_lines(3)));
        self.requested.push(elements, u);
        self.body_offsets.push([0]);
        self.offsets.push();
    }

    /// The datasets with a row per cell.
    fn columns(&mut self) -> Columns<'_> {
        let mut all: Columns = vec![
            &mut self.stress,
            &mut self.across,
            &mut self.von_mises,
            &mut self.strain,
        ];
        all.extend(self.requested.columns());
        all
    }
}

const CONCENTRATED: Meaning = meaning("concentrated loads on the node", "force");
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

/// Attributes by which readers know the group.
fn write_type(grid: &Group) -> hdf5::Result<()> {
    let version = grid.new_attr::<i64>().shape([2]).create("Version")?;
    version.write_raw(&[2i64, 3])?;
    let name = FixedAscii::<16>::from_ascii("UnstructuredGrid")
        .map_err(|error| hdf5::Error::from(error.to_string()))?;
    set_attribute(grid, "Type", name)
}
