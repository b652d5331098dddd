//! Group `/history/bodies`: motion, energies and contact force of every body.

use hdf5::Group;

use crate::dynamics::BodyResult;
use crate::model::{Bodies, Model};
use crate::output::file::{Column, Columns, growing, meaning};

/// A vector or a scalar of a body.
type Vector = fn(&BodyResult) -> [f64; 2];
type Scalar = fn(&BodyResult) -> f64;

const VECTORS: [(&str, &str, &str, Vector); 3] = [
    ("center", "centre of mass", "length", |b| b.center),
    (
        "velocity",
        "velocity of the centre of mass",
        "length/time",
        |b| b.velocity,
    ),
    (
        "contact_force",
        "force of all contacts on the body",
        "force",
        |b| b.contact_force,
    ),
];

const SCALARS: [(&str, &str, &str, Scalar); 4] = [
    (
        "angular_velocity",
        "angular momentum about the centre of mass over the moment of inertia",
        "1/time",
        |b| b.angular_velocity,
    ),
    ("kinetic", "kinetic energy", "energy", |b| b.kinetic),
    ("strain", "strain energy", "energy", |b| b.strain),
    (
        "contact_moment",
        "moment of the contact force about the centre of mass",
        "force*length",
        |b| b.contact_moment,
    ),
];

/// `/history/bodies`.
pub(crate) struct BodyHistory {
    vectors: Vec<(Column<f64>, Vector)>,
    scalars: Vec<(Column<f64>, Scalar)>,
}

impl BodyHistory {
    /// Creates the datasets.
    pub fn create(at: &Group, model: &Model) -> hdf5::Result<Self> {
        let count = Bodies::new(&model.mesh).count;
        let column = |name, row: &[usize], text, dimension| {
            Column::series(at, name, row, meaning(text, dimension))
        };
        let vector = |&(name, text, dimension, value): &(_, _, _, Vector)| {
            Ok((column(name, &[count, 2], text, dimension)?, value))
        };
        let scalar = |&(name, text, dimension, value): &(_, _, _, Scalar)| {
            Ok((column(name, &[count], text, dimension)?, value))
        };
        Ok(BodyHistory {
            vectors: VECTORS.iter().map(vector).collect::<hdf5::Result<_>>()?,
            scalars: SCALARS.iter().map(scalar).collect::<hdf5::Result<_>>()?,
        })
    }

    /// Appends a row to each dataset.
    pub fn push(&mut self, bodies: &[BodyResult]) {
        for (column, value) in &mut self.vectors {
            column.push(bodies.iter().flat_map(&*value));
        }
        for (column, value) in &mut self.scalars {
            column.push(bodies.iter().map(&*value));
        }
    }

    /// Its datasets.
    pub fn columns<'a>(&'a mut self, all: &mut Columns<'a>) {
        all.extend(growing(&mut self.vectors));
        all.extend(growing(&mut self.scalars));
    }
}
