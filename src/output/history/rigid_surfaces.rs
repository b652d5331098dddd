//! Group `/history/rigid`: rigid surfaces at their reference nodes.

use hdf5::Group;

use crate::dynamics::{RigidReaction, State};
use crate::model::{Model, RigidBody};
use crate::output::file::{Column, Columns, Scalar, Series, constant, group, meaning, scalar};

const MOMENT: [Scalar<RigidReaction, f64>; 1] = [scalar(
    "moment",
    "moment of the reaction about the reference node",
    "force*length",
    |r| r.moment,
)];

/// `/history/rigid/<SURFACE>`.
pub(crate) struct RigidHistory {
    reference: usize,
    position: Column<f64>,
    displacement: Column<f64>,
    velocity: Column<f64>,
    force: Column<f64>,
    moment: Series<RigidReaction, f64>,
}

impl RigidHistory {
    fn create(at: &Group, model: &Model, body: &RigidBody) -> hdf5::Result<Self> {
        let label = model.mesh.node_labels[body.reference] as i64;
        let text = meaning("node number of the reference node", "1");
        constant(at, "node", &[1], &[label], text)?;
        let column =
            |name, text, dimension| Column::series(at, name, &[2], meaning(text, dimension));
        Ok(RigidHistory {
            reference: body.reference,
            position: column("position", "position of the reference node", "length")?,
            displacement: column("U", "displacement of the reference node", "length")?,
            velocity: column("V", "velocity of the reference node", "length/time")?,
            force: column(
                "force",
                "reaction: the force that holds the surface",
                "force",
            )?,
            moment: Series::create(at, &MOMENT)?,
        })
    }

    /// Appends a row to each dataset.
    pub fn push(&mut self, model: &Model, state: &State, reaction: &RigidReaction) {
        let at = |v: &[f64]| [v[2 * self.reference], v[2 * self.reference + 1]];
        let (x, u) = (model.mesh.coordinates[self.reference], at(&state.u));
        let v = at(&state.v);
        self.position.push([x[0] + u[0], x[1] + u[1]]);
        self.displacement.push(u);
        self.velocity.push(v);
        self.force.push(reaction.force);
        self.moment.push(reaction);
    }

    /// Its datasets.
    pub fn columns<'a>(&'a mut self, all: &mut Columns<'a>) {
        all.push(&mut self.position);
        all.push(&mut self.displacement);
        all.push(&mut self.velocity);
        all.push(&mut self.force);
        self.moment.columns(all);
    }
}

/// One history per rigid surface with a reference node.
pub(crate) fn create_rigid(at: &Group, model: &Model) -> hdf5::Result<Vec<RigidHistory>> {
    let create = |body: &RigidBody| {
        let name = &model.surfaces[body.surface].name;
        RigidHistory::create(&group(at, name)?, model, body)
    };
    model.rigid_bodies.iter().map(create).collect()
}
