//! Groups `/history/contact` and `/history/impacts`.

use hdf5::Group;

use super::dataset::{Column, group, meaning};
use super::names::contact_names;
use super::series::{Scalar, Series, scalar};
use crate::dynamics::{ContactResultant, Landing};
use crate::model::Model;

const RESULTANTS: [Scalar<ContactResultant, f64>; 5] = [
    scalar(
        "moment",
        "moment of the force about the origin",
        "force*length",
        |c| c.moment,
    ),
    scalar("normal", "sum of the normal forces Pn", "force", |c| {
        c.normal
    }),
    scalar(
        "tangential",
        "sum of the tangential forces Pt",
        "force",
        |c| c.tangential,
    ),
    scalar(
        "min_gap",
        "smallest gap of the candidate pairs, NaN without",
        "length",
        |c| c.min_gap,
    ),
    scalar(
        "cone_violation",
        "max(|Pt| - mu Pn, 0) / max(Pn)",
        "1",
        |c| c.cone_violation,
    ),
];

const PAIRS: [Scalar<ContactResultant, i64>; 2] = [
    scalar("closed", "pairs with Pn > 0", "1", |c| c.closed as i64),
    scalar("sticking", "closed pairs that do not slip", "1", |c| {
        c.sticking as i64
    }),
];

/// `/history/contact/<SLAVE>_<MASTER>`.
pub(super) struct ContactHistory {
    force: Column<f64>,
    resultants: Series<ContactResultant, f64>,
    pairs: Series<ContactResultant, i64>,
}

impl ContactHistory {
    /// Creates the datasets.
    pub fn create(at: &Group) -> hdf5::Result<Self> {
        let text = meaning("contact force on the slave surface", "force");
        Ok(ContactHistory {
            force: Column::series(at, "force", &[2], text)?,
            resultants: Series::create(at, &RESULTANTS)?,
            pairs: Series::create(at, &PAIRS)?,
        })
    }

    /// Appends a row.
    pub fn push(&mut self, resultant: &ContactResultant) -> hdf5::Result<()> {
        self.force.push(resultant.force)?;
        self.resultants.push(resultant)?;
        self.pairs.push(resultant)
    }

    /// Writes the buffered rows.
    pub fn flush(&mut self) -> hdf5::Result<()> {
        self.force.flush()?;
        self.resultants.flush()?;
        self.pairs.flush()
    }
}

/// One history per contact of the model.
pub(super) fn create_contacts(at: &Group, model: &Model) -> hdf5::Result<Vec<ContactHistory>> {
    (contact_names(model).iter())
        .map(|name| ContactHistory::create(&group(at, name)?))
        .collect()
}

const LANDINGS: [Scalar<Landing, f64>; 3] = [
    scalar("time", "time of the landing", "time", |l| l.time),
    scalar(
        "xi",
        "place on the segment: 0 at its first node, 1 at its second",
        "1",
        |l| l.xi,
    ),
    scalar(
        "approach_speed",
        "-dg/dt just before the landing",
        "length/time",
        |l| l.approach_speed,
    ),
];

/// `/history/impacts`: one row per landing.
pub(super) struct Impacts {
    landings: Series<Landing, f64>,
    increment: Column<i64>,
    slave: Column<i64>,
    segment: Column<i64>,
}

impl Impacts {
    /// Creates the datasets.
    pub fn create(at: &Group) -> hdf5::Result<Self> {
        let column =
            |name, row: &[usize], text| Column::<i64>::series(at, name, row, meaning(text, "1"));
        Ok(Impacts {
            landings: Series::create(at, &LANDINGS)?,
            increment: column("increment", &[], "increment of the landing")?,
            slave: column("slave", &[], "node number of the slave node")?,
            segment: column("segment", &[2], "node numbers of the segment's ends")?,
        })
    }

    /// Appends a row.
    pub fn push(&mut self, model: &Model, increment: usize, landing: &Landing) -> hdf5::Result<()> {
        let label = |node: usize| model.mesh.node_labels[node] as i64;
        self.landings.push(landing)?;
        self.increment.push([increment as i64])?;
        self.slave.push([label(landing.slave)])?;
        self.segment.push(landing.segment.map(label))
    }

    /// Writes the buffered rows.
    pub fn flush(&mut self) -> hdf5::Result<()> {
        self.landings.flush()?;
        self.increment.flush()?;
        self.slave.flush()?;
        self.segment.flush()
    }
}
