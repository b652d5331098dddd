//! Groups `/history/contact`, `/history/impacts`, `/history/returns` and `/history/touches`.

use hdf5::{Attribute, Group};

use crate::dynamics::{ContactImpulse, ContactResultant, Landing, ReturnedImpulse, Touch};
use crate::model::{Bodies, Contact, Model};
use crate::output::file::{
    Column, Columns, Growing, Meaning, ROWS, Scalar, Series, contact_names, counter, group,
    meaning, scalar,
};

const RESULTANTS: [Scalar<ContactResultant, f64>; 11] = [
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
    scalar(
        "impulse_cone_violation",
        "the same of the total impulses of the pairs in the increment, with impacts and what is given back",
        "1",
        |c| c.impulse_cone_violation,
    ),
    scalar(
        "normal_work",
        "work of the normal contact forces since the start",
        "energy",
        |c| c.normal_work,
    ),
    scalar(
        "handover_work",
        "the part of it of nodes that landed where others of the same bodies had opened",
        "energy",
        |c| c.handover_work,
    ),
    scalar(
        "friction_dissipation",
        "energy dissipated by friction since the start",
        "energy",
        |c| c.friction_dissipation,
    ),
    scalar(
        "landing_return",
        "kinetic energy given back after its landings and releases since the start",
        "energy",
        |c| c.landing_return,
    ),
    scalar(
        "release_loss",
        "energy that nodes without mass lost after its releases since the start",
        "energy",
        |c| c.release_loss,
    ),
];

const REFERENCE_MOMENT: [Scalar<ContactResultant, f64>; 1] = [scalar(
    "reference_moment",
    "moment of the force about the reference node of the master",
    "force*length",
    |c| c.reference_moment,
)];

const IMPULSE: Meaning = meaning(
    "impulse on the slave surface in the increment",
    "force*time",
);
const IMPULSES: [Scalar<ContactImpulse, f64>; 5] = [
    scalar(
        "normal_impulse",
        "sum of dt Pn + Phi and of return impulses in the increment",
        "force*time",
        |i| i.normal,
    ),
    scalar(
        "tangential_impulse",
        "sum of dt Pt + Psi and of return impulses in the increment",
        "force*time",
        |i| i.tangential,
    ),
    scalar(
        "impact_normal_impulse",
        "sum of Phi in the increment",
        "force*time",
        |i| i.impact_normal,
    ),
    scalar(
        "impact_tangential_impulse",
        "sum of Psi in the increment",
        "force*time",
        |i| i.impact_tangential,
    ),
    scalar(
        "return_impulse",
        "sum of the normal impulses of landing returns in the increment",
        "force*time",
        |i| i.landing_return,
    ),
];

const IMPULSE_SUM: Meaning = meaning("impulse on the slave surface since the start", "force*time");
const IMPULSE_SUMS: [Scalar<ContactImpulse, f64>; 5] = [
    scalar(
        "normal_impulse_sum",
        "sum of dt Pn + Phi and of return impulses since the start",
        "force*time",
        |i| i.normal,
    ),
    scalar(
        "tangential_impulse_sum",
        "sum of dt Pt + Psi since the start",
        "force*time",
        |i| i.tangential,
    ),
    scalar(
        "impact_normal_impulse_sum",
        "sum of Phi since the start",
        "force*time",
        |i| i.impact_normal,
    ),
    scalar(
        "impact_tangential_impulse_sum",
        "sum of Psi since the start",
        "force*time",
        |i| i.impact_tangential,
    ),
    scalar(
        "return_impulse_sum",
        "sum of the normal impulses of landing returns since the start",
        "force*time",
        |i| i.landing_return,
    ),
];

const PAIRS: [Scalar<ContactResultant, i64>; 2] = [
    scalar("closed", "pairs with Pn > 0", "1", |c| c.closed as i64),
    scalar("sticking", "closed pairs that do not slip", "1", |c| {
        c.sticking as i64
    }),
];

/// `/history/contact/<SLAVE>_<MASTER>`.
pub(crate) struct ContactHistory {
    force: Column<f64>,
    resultants: Series<ContactResultant, f64>,
    pairs: Series<ContactResultant, i64>,
    impulse: ImpulseHistory,
    impulse_sum: ImpulseHistory,
    /// Of a rigid master.
    reference_moment: Option<Series<ContactResultant, f64>>,
    /// Force and moment on each body, of a surface that touches itself.
    bodies: Option<[Column<f64>; 2]>,
}

impl ContactHistory {
    fn create(at: &Group, model: &Model, contact: &Contact) -> hdf5::Result<Self> {
        let mut rigid = model.rigid_bodies.iter();
        let is_rigid = rigid.any(|body| body.surface == contact.master);
        let moment = || Series::create(at, &REFERENCE_MOMENT);
        let text = meaning("contact force on the slave surface", "force");
        Ok(ContactHistory {
            force: Column::series(at, "force", &[2], text)?,
            resultants: Series::create(at, &RESULTANTS)?,
            pairs: Series::create(at, &PAIRS)?,
            impulse: ImpulseHistory::create(at, "impulse", IMPULSE, &IMPULSES)?,
            impulse_sum: ImpulseHistory::create(at, "impulse_sum", IMPULSE_SUM, &IMPULSE_SUMS)?,
            reference_moment: is_rigid.then(moment).transpose()?,
            bodies: match contact.is_self_contact() {
                true => Some(create_bodies(at, model)?),
                false => None,
            },
        })
    }

    /// Appends a row.
    pub fn push(&mut self, resultant: &ContactResultant) {
        self.force.push(resultant.force);
        self.resultants.push(resultant);
        self.pairs.push(resultant);
        self.impulse.push(&resultant.impulse);
        self.impulse_sum.push(&resultant.impulse_sum);
        if let Some(moment) = &mut self.reference_moment {
            moment.push(resultant);
        }
        if let Some([force, moment]) = &mut self.bodies {
            force.push(resultant.bodies.iter().flat_map(|body| body.force));
            moment.push(resultant.bodies.iter().map(|body| body.moment));
        }
    }

    /// Its datasets.
    pub fn columns<'a>(&'a mut self, all: &mut Columns<'a>) {
        all.push(&mut self.force);
        self.resultants.columns(all);
        self.pairs.columns(all);
        self.impulse.columns(all);
        self.impulse_sum.columns(all);
        if let Some(moment) = &mut self.reference_moment {
            moment.columns(all);
        }
        let bodies = self.bodies.iter_mut().flatten();
        all.extend(bodies.map(|column| -> &mut dyn Growing { column }));
    }
}

fn create_bodies(at: &Group, model: &Model) -> hdf5::Result<[Column<f64>; 2]> {
    let count = Bodies::new(&model.mesh).count;
    let force = meaning("force of this contact on each body", "force");
    let moment = meaning("moment of that force about the origin", "force*length");
    Ok([
        Column::series(at, "body_force", &[count, 2], force)?,
        Column::series(at, "body_moment", &[count], moment)?,
    ])
}

/// Impulses of a contact, of an increment or since the start.
struct ImpulseHistory {
    vector: Column<f64>,
    scalars: Series<ContactImpulse, f64>,
}

impl ImpulseHistory {
    fn create(
        at: &Group,
        name: &str,
        vector: Meaning,
        scalars: &[Scalar<ContactImpulse, f64>],
    ) -> hdf5::Result<Self> {
        Ok(ImpulseHistory {
            vector: Column::series(at, name, &[2], vector)?,
            scalars: Series::create(at, scalars)?,
        })
    }

    fn push(&mut self, impulse: &ContactImpulse) {
        self.vector.push(impulse.vector);
        self.scalars.push(impulse);
    }

    fn columns<'a>(&'a mut self, all: &mut Columns<'a>) {
        all.push(&mut self.vector);
        self.scalars.columns(all);
    }
}

/// One history per contact of the model.
pub(crate) fn create_contacts(at: &Group, model: &Model) -> hdf5::Result<Vec<ContactHistory>> {
    let names = contact_names(model);
    (model.contacts.iter().zip(&names))
        .map(|(contact, name)| ContactHistory::create(&group(at, name)?, model, contact))
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
pub(crate) struct Impacts {
    count: Attribute,
    landings: Series<Landing, f64>,
    increment: Column<i64>,
    slave: Column<i64>,
    segment: Column<i64>,
}

impl Impacts {
    /// Creates the datasets.
    pub fn create(at: &Group) -> hdf5::Result<Self> {
        let column =
            |name, row: &[usize], text| Column::<i64>::events(at, name, row, meaning(text, "1"));
        Ok(Impacts {
            count: counter(at, ROWS)?,
            landings: Series::of_events(at, &LANDINGS)?,
            increment: column("increment", &[], "increment of the landing")?,
            slave: column("slave", &[], "node number of the slave node")?,
            segment: column("segment", &[2], "node numbers of the segment's ends")?,
        })
    }

    /// Appends a row.
    pub fn push(&mut self, model: &Model, increment: usize, landing: &Landing) {
        let label = |node: usize| model.mesh.node_labels[node] as i64;
        self.landings.push(landing);
        self.increment.push([increment as i64]);
        self.slave.push([label(landing.slave)]);
        self.segment.push(landing.segment.map(label));
    }

    /// Writes the number of rows.
    pub fn note_count(&self) -> hdf5::Result<()> {
        self.count.write_scalar(&(self.increment.rows() as i64))
    }

    /// Its datasets.
    pub fn columns<'a>(&'a mut self, all: &mut Columns<'a>) {
        self.landings.columns(all);
        all.push(&mut self.increment);
        all.push(&mut self.slave);
        all.push(&mut self.segment);
    }
}

const RETURNS: [Scalar<ReturnedImpulse, f64>; 5] = [
    scalar("time", "time at the end of the increment", "time", |r| {
        r.time
    }),
    scalar(
        "normal",
        "total normal impulse of the pair in the increment: dt Pn + Phi and what is given back",
        "force*time",
        |r| r.normal,
    ),
    scalar(
        "tangential",
        "total tangential impulse of the pair in the increment",
        "force*time",
        |r| r.tangential,
    ),
    scalar(
        "returned_normal",
        "normal impulse that gives back",
        "force*time",
        |r| r.returned_normal,
    ),
    scalar(
        "returned_tangential",
        "tangential impulse that gives back",
        "force*time",
        |r| r.returned_tangential,
    ),
];

/// `/history/returns`: one row per pair and increment in which it is given energy back.
pub(crate) struct Returns {
    count: Attribute,
    impulses: Series<ReturnedImpulse, f64>,
    increment: Column<i64>,
    slave: Column<i64>,
    segment: Column<i64>,
}

impl Returns {
    /// Creates the datasets.
    pub fn create(at: &Group) -> hdf5::Result<Self> {
        let column =
            |name, row: &[usize], text| Column::<i64>::events(at, name, row, meaning(text, "1"));
        Ok(Returns {
            count: counter(at, ROWS)?,
            impulses: Series::of_events(at, &RETURNS)?,
            increment: column("increment", &[], "increment")?,
            slave: column("slave", &[], "node number of the slave node")?,
            segment: column("segment", &[2], "node numbers of the segment's ends")?,
        })
    }

    /// Appends a row.
    pub fn push(&mut self, model: &Model, increment: usize, returned: &ReturnedImpulse) {
        let label = |node: usize| model.mesh.node_labels[node] as i64;
        self.impulses.push(returned);
        self.increment.push([increment as i64]);
        self.slave.push([label(returned.slave)]);
        self.segment.push(returned.segment.map(label));
    }

    /// Writes the number of rows.
    pub fn note_count(&self) -> hdf5::Result<()> {
        self.count.write_scalar(&(self.increment.rows() as i64))
    }

    /// Its datasets.
    pub fn columns<'a>(&'a mut self, all: &mut Columns<'a>) {
        self.impulses.columns(all);
        all.push(&mut self.increment);
        all.push(&mut self.slave);
        all.push(&mut self.segment);
    }
}

const TIMES_OF_TOUCHES: [Scalar<Touch, f64>; 4] = [
    scalar(
        "start",
        "time at the start of its first increment",
        "time",
        |t| t.start,
    ),
    scalar(
        "end",
        "time at the end of its last increment",
        "time",
        |t| t.end,
    ),
    scalar(
        "impulse",
        "size of the impulse on each of the bodies",
        "force*time",
        |t| t.impulse,
    ),
    scalar(
        "energy",
        "kinetic energy of the approach if the bodies rebound with its speed, J^2/(8 m); 0 where both are held",
        "energy",
        |t| t.energy,
    ),
];
const COUNTS_OF_TOUCHES: [Scalar<Touch, i64>; 4] = [
    scalar("first", "its first increment", "1", |t| t.first as i64),
    scalar("last", "its last increment", "1", |t| t.last as i64),
    scalar(
        "nodes",
        "most nodes of one side in contact at a time",
        "1",
        |t| t.nodes as i64,
    ),
    scalar(
        "corner",
        "1 where it reached a corner of an outline",
        "1",
        |t| i64::from(t.is_at_corner),
    ),
];

/// `/history/touches`: one row per contact of two bodies that has ended.
pub(crate) struct Touches {
    count: Attribute,
    times: Series<Touch, f64>,
    counts: Series<Touch, i64>,
    bodies: Column<i64>,
    node: Column<i64>,
}

impl Touches {
    /// Creates the datasets.
    pub fn create(at: &Group) -> hdf5::Result<Self> {
        let bodies = meaning("its bodies; -1 for a rigid surface", "1");
        let node = meaning("number of a slave node that landed first", "1");
        Ok(Touches {
            count: counter(at, ROWS)?,
            times: Series::of_events(at, &TIMES_OF_TOUCHES)?,
            counts: Series::of_events(at, &COUNTS_OF_TOUCHES)?,
            bodies: Column::<i64>::events(at, "bodies", &[2], bodies)?,
            node: Column::<i64>::events(at, "node", &[], node)?,
        })
    }

    /// Appends a row.
    pub fn push(&mut self, model: &Model, touch: &Touch) {
        self.times.push(touch);
        self.counts.push(touch);
        let number = |body: Option<usize>| body.map_or(-1, |body| body as i64);
        self.bodies.push(touch.bodies.map(number));
        self.node.push([model.mesh.node_labels[touch.node] as i64]);
    }

    /// Writes the number of rows.
    pub fn note_count(&self) -> hdf5::Result<()> {
        self.count.write_scalar(&(self.node.rows() as i64))
    }

    /// Its datasets.
    pub fn columns<'a>(&'a mut self, all: &mut Columns<'a>) {
        self.times.columns(all);
        self.counts.columns(all);
        all.push(&mut self.bodies);
        all.push(&mut self.node);
    }
}
