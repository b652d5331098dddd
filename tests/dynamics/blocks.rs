//! Models made of rectangular blocks, and an observer that keeps all reports.

use std::io;

use stickslip::dynamics::{
    self, Cutback, IncrementReport, Observer, Outcome, RunError, RunSummary,
};
use stickslip::materials::Law;
use stickslip::model::{
    BodyForce, Contact, Element, ElementType, Face, Friction, Increments, Interaction, Load, Model,
    Scheme, Settings, Step, Support, SupportMotion, Surface, SurfaceKind, Variation,
};
use stickslip::prepare::PreparedModel;

/// The paper's scheme.
pub const PAPER: Scheme = Scheme::Ss22 {
    theta1: 1.0,
    theta2: 1.0,
};

/// The default scheme and that of the paper.
pub const SCHEMES: [Scheme; 2] = [Scheme::EnergyMomentum, PAPER];

/// A rectangular block of nx x ny Q4.
pub struct Block {
    pub first_node: usize,
    pub first_element: usize,
    pub nx: usize,
    pub ny: usize,
}

impl Block {
    pub fn node(&self, i: usize, j: usize) -> usize {
        self.first_node + j * (self.nx + 1) + i
    }

    pub fn nodes(&self) -> std::ops::Range<usize> {
        self.first_node..self.first_node + (self.nx + 1) * (self.ny + 1)
    }

    /// Faces of side 0 (bottom), 1 (right), 2 (top), 3 (left).
    pub fn faces(&self, side: usize) -> Vec<Face> {
        let along = if side.is_multiple_of(2) {
            self.nx
        } else {
            self.ny
        };
        let element = |k: usize| match side {
            0 => k,
            1 => k * self.nx + self.nx - 1,
            2 => (self.ny - 1) * self.nx + k,
            _ => k * self.nx,
        };
        (0..along)
            .map(|k| Face {
                element: self.first_element + element(k),
                side,
            })
            .collect()
    }
}

/// A model without steps; one plane-stress material E, nu, rho and thickness 1.
pub fn model(young: f64, poisson: f64, density: f64) -> Model {
    let mut model = Model::default();
    model.add_section(Law::elastic(young, poisson), density, 1.0);
    model
}

/// Adds a block with its corner at `origin`, turned by `angle` about it.
pub fn add_block(
    model: &mut Model,
    origin: [f64; 2],
    size: [f64; 2],
    (nx, ny): (usize, usize),
    angle: f64,
) -> Block {
    let mesh = &mut model.mesh;
    let first_node = mesh.coordinates.len();
    let first_element = mesh.elements.len();
    let block = Block {
        first_node,
        first_element,
        nx,
        ny,
    };
    let (sin, cos) = angle.sin_cos();
    for j in 0..=ny {
        for i in 0..=nx {
            let [x, y] = [
                size[0] * i as f64 / nx as f64,
                size[1] * j as f64 / ny as f64,
            ];
            mesh.coordinates
                .push([origin[0] + cos * x - sin * y, origin[1] + sin * x + cos * y]);
            mesh.node_labels.push(mesh.coordinates.len() as u64);
        }
    }
    for j in 0..ny {
        for i in 0..nx {
            let nodes = [
                block.node(i, j),
                block.node(i + 1, j),
                block.node(i + 1, j + 1),
                block.node(i, j + 1),
            ];
            let label = mesh.elements.len() as u64 + 1;
            mesh.elements.push(Element {
                label,
                element_type: ElementType::CPS4,
                nodes: nodes.into(),
                section: 0,
            });
        }
    }
    model.initial_velocity = vec![0.0; model.mesh.dof_count()];
    block
}

/// Gives a block the velocity v + omega x (X - centre).
pub fn throw(model: &mut Model, block: &Block, v: [f64; 2], omega: f64, centre: [f64; 2]) {
    for node in block.nodes() {
        let x = model.mesh.coordinates[node];
        model.initial_velocity[2 * node] = v[0] - omega * (x[1] - centre[1]);
        model.initial_velocity[2 * node + 1] = v[1] + omega * (x[0] - centre[0]);
    }
}

/// Adds a velocity along x that grows by this rate from the line at x = `middle`.
pub fn stretch(model: &mut Model, block: &Block, rate: f64, middle: f64) {
    for node in block.nodes() {
        model.initial_velocity[2 * node] += rate * (model.mesh.coordinates[node][0] - middle);
    }
}

/// Adds a contact between faces.
pub fn add_contact(model: &mut Model, slave: Vec<Face>, master: Vec<Face>, friction: f64) {
    for faces in [slave, master] {
        let name = format!("S{}", model.surfaces.len());
        model.surfaces.push(Surface {
            name,
            kind: SurfaceKind::Faces(faces),
        });
    }
    let master = model.surfaces.len() - 1;
    let dry = Interaction {
        name: "DRY".into(),
        friction: Friction::constant(friction),
        ..Interaction::default()
    };
    let contact = Contact::new([master - 1, master], dry);
    model.contacts.push(contact);
}

/// A support at rest.
pub fn fixed(dof: usize) -> Support {
    Support {
        dof,
        motion: SupportMotion::Ramp { to: 0.0 },
    }
}

/// Settings with this scheme.
pub fn settings(scheme: Scheme) -> Settings {
    Settings {
        scheme,
        ..Settings::default()
    }
}

/// Constant downward gravity on an element.
pub fn gravity(element: usize, magnitude: f64) -> Load<BodyForce> {
    Load {
        at: BodyForce {
            element,
            direction: [0.0, -1.0],
            per_mass: true,
        },
        magnitude,
        variation: Variation::Constant,
    }
}

/// A step of `count` increments.
pub fn step(dt: f64, count: usize, settings: Settings, mut supports: Vec<Support>) -> Step {
    supports.sort_by_key(|support| support.dof);
    Step {
        settings,
        supports,
        ..Step::new(Increments::fixed(dt, dt * count as f64))
    }
}

/// Keeps all reports.
#[derive(Default)]
pub struct Keep {
    pub reports: Vec<IncrementReport>,
    pub cutbacks: Vec<Cutback>,
}

impl Observer for Keep {
    fn increment(&mut self, report: &IncrementReport) -> io::Result<()> {
        self.reports.push(report.clone());
        Ok(())
    }

    fn cutback(&mut self, cutback: &Cutback) -> io::Result<()> {
        self.cutbacks.push(cutback.clone());
        Ok(())
    }
}

/// Prepares and runs a model.
pub fn run(model: &Model, observer: &mut dyn Observer) -> Result<RunSummary, RunError> {
    dynamics::run(&PreparedModel::new(model.clone()), observer)
}

/// Runs a model to its end.
pub fn run_to_end(model: &Model) -> (Keep, RunSummary) {
    let mut keep = Keep::default();
    let summary = run(model, &mut keep).expect("the observer never fails");
    assert_eq!(summary.outcome, Outcome::Finished);
    (keep, summary)
}
