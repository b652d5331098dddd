//! A small model and invented results for it.
//!
//! ```text
//!  40 ---- 50 ---- 60
//!   |  1   |   2   | \  3         one triangle beside two squares of side 1;
//!  10 ---- 20 ---- 30 -- 70       contact BOTTOM -> TOP twice
//! ```

#![allow(dead_code)] // Each test uses its part.

use std::f64::consts::TAU;
use std::path::Path;

use stickslip::dynamics::{
    BodyResult, ContactImpulse, ContactResultant, Energy, FrictionResults, IncrementReport,
    Landing, Momentum, NodalResults, NodeStatus, Observer, Outcome, PassReport, RunSummary,
    SolverCounts, State, Timings,
};
use stickslip::elements::{ElementResult, Strained};
use stickslip::materials::Law;
use stickslip::model::{
    Contact, Damping, Element, ElementType, Face, Frames, Friction, HistorySet, Increments,
    Interaction, Material, Mesh, Model, NamedSets, NodalVariable, RequestedFields, Section, Set,
    Step, Support, SupportMotion, Surface, SurfaceKind,
};
use stickslip::output::{Claim, Earlier, JobFiles, ResultWriter, RunRecord, Verbosity};

/// Increments of the made-up run.
pub const INCREMENTS: usize = 10;

/// Text of the made-up deck: longer than an HDF5 attribute may be when stored in place.
pub fn deck_text() -> String {
    "*HEADING\nblöcke\n".to_owned() + &"** a comment line of the deck\n".repeat(4000)
}

/// The model.
pub fn model() -> Model {
    Model {
        title: "two squares and a triangle".into(),
        point_masses: Vec::new(),
        restarts: Vec::new(),
        connectors: Vec::new(),
        mesh: mesh(),
        sets: NamedSets {
            nodes: vec![set("ALL", 0..7), set("TIP", [6]), set("NOTHING", [])],
            elements: vec![set("SQUARES", 0..2)],
            history: vec![asked(1, true), asked(2, true), asked(0, false)],
            element_history: vec![asked(0, true)],
            fields: RequestedFields {
                concentrated_load: true,
                energy_density: true,
                logarithmic_strain: true,
                principal_stress: true,
                pressure: true,
                plastic_strain: true,
                at_nodes: [NodalVariable::Stress, NodalVariable::LogarithmicStrain].into(),
            },
            monitored: vec![12, 1],
            instances: Vec::new(),
        },
        surfaces: vec![
            surface("BOTTOM", SurfaceKind::Nodes(vec![0, 1, 2, 6])),
            surface("TOP", SurfaceKind::Faces(vec![face(0, 2), face(1, 2)])),
        ],
        materials: vec![Material {
            name: "M".into(),
            law: Law::elastic(1000.0, 0.0),
            density: 2.0,
            damping: Damping::default(),
            expansion: None,
        }],
        sections: vec![Section {
            material: 0,
            thickness: 0.5,
        }],
        contacts: vec![contact(), contact()],
        amplitudes: vec![],
        ties: vec![],
        hinges: vec![],
        equations: vec![],
        initial_velocity: vec![0.0; 14],
        initial_temperature: Vec::new(),
        steps: vec![step()],
        rigid_bodies: vec![],
    }
}

fn mesh() -> Mesh {
    let element = |label, element_type, nodes: &[usize]| Element {
        label,
        element_type,
        nodes: nodes.into(),
        section: 0,
    };
    Mesh {
        node_labels: vec![10, 20, 30, 40, 50, 60, 70],
        coordinates: vec![
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [0.0, 1.0],
            [1.0, 1.0],
            [2.0, 1.0],
            [3.0, 0.0],
        ],
        elements: vec![
            element(1, ElementType::CPE4, &[0, 1, 4, 3]),
            element(2, ElementType::CPE4, &[1, 2, 5, 4]),
            element(3, ElementType::CPE3, &[2, 6, 5]),
        ],
    }
}

fn set(name: &str, members: impl IntoIterator<Item = usize>) -> Set {
    Set {
        name: name.into(),
        members: members.into_iter().collect(),
    }
}

fn asked(set: usize, each_member: bool) -> HistorySet {
    HistorySet {
        set,
        each_member,
        at_points: each_member,
        at_nodes: each_member,
    }
}

fn surface(name: &str, kind: SurfaceKind) -> Surface {
    let name = name.into();
    Surface { name, kind }
}

fn face(element: usize, side: usize) -> Face {
    Face { element, side }
}

fn contact() -> Contact {
    let dry = Interaction {
        name: "DRY".into(),
        friction: Friction::constant(0.3),
        ..Interaction::default()
    };
    Contact::new([0, 1], dry)
}

fn step() -> Step {
    let to = SupportMotion::Ramp { to: 0.0 };
    Step {
        supports: vec![
            Support { dof: 0, motion: to },
            Support { dof: 1, motion: to },
        ],
        frames: Frames::Count(5),
        ..Step::new(Increments::fixed(0.1, 1.0))
    }
}

/// Results of increment `k`; entry i of a vector over the dofs is k + i/100 times a factor.
pub fn report(k: usize) -> IncrementReport {
    let ramp = |factor: f64| -> Vec<f64> {
        let value = |i| factor * (k as f64 + i as f64 / 100.0);
        (0..14).map(value).collect()
    };
    let time = 0.1 * k as f64;
    let (sine, cosine) = (TAU * time).sin_cos();
    IncrementReport {
        increment: k,
        held: None,
        step: 1,
        time,
        step_time: time,
        dt: if k == 0 { 0.0 } else { 0.1 },
        truncation_error: None,
        ends_step: k == INCREMENTS,
        state: State {
            u: ramp(1.0),
            v: ramp(2.0),
            a: ramp(3.0),
            ..State::default()
        },
        nodal: nodal(k, ramp(4.0), ramp(5.0)),
        elements: vec![ElementResult::default(); 3].into(),
        contact_energy: None,
        surface_work_difference: 0.0,
        energy: Energy {
            kinetic: cosine * cosine,
            strain: sine * sine,
            balance: 1e-13 * k as f64,
            ..Energy::default()
        },
        momentum: Momentum {
            linear: [k as f64, -1.0],
            angular: 0.5,
            consistent_angular: None,
            damped_linear: [0.25, 0.0],
            damped_angular: -0.5,
        },
        strain: Strained {
            element: 1,
            strain: 0.05 * k as f64,
        },
        contacts: vec![resultant(k, 1.0), resultant(k, 2.0)],
        rigid: vec![],
        bodies: vec![BodyResult {
            center: [k as f64, 0.5],
            kinetic: 3.0,
            ..BodyResult::default()
        }],
        landings: if k == 4 { vec![landing()] } else { vec![] },
        returns: vec![],
        connectors: vec![],
        touches: vec![],
        solver: SolverCounts {
            passes: 2,
            lcps: 3,
            lcp_size: k,
            residual: 1e-12,
            converged: true,
            ..SolverCounts::default()
        },
        passes: vec![PassReport::default(); 2],
    }
}

fn nodal(k: usize, reaction: Vec<f64>, contact_force: Vec<f64>) -> NodalResults {
    let mut gap = vec![f64::NAN; 7];
    gap[0] = k as f64;
    let mut status = vec![NodeStatus::None; 7];
    status[0] = NodeStatus::Slip;
    NodalResults {
        reaction,
        concentrated: contact_force.iter().map(|f| 2.0 * f).collect(),
        contact_force,
        tie_force: vec![],
        hinge_force: vec![],
        gap,
        status,
        pressure: vec![0.25 * k as f64; 7],
        friction: FrictionResults::default(),
        slip: vec![0.5 * k as f64; 7],
        mass: vec![],
    }
}

fn resultant(k: usize, factor: f64) -> ContactResultant {
    ContactResultant {
        force: [0.0, factor * k as f64],
        normal: factor * k as f64,
        closed: k,
        sticking: k / 2,
        min_gap: f64::NAN,
        impulse_sum: ContactImpulse {
            normal: 7.0 * factor,
            ..ContactImpulse::default()
        },
        ..ContactResultant::default()
    }
}

fn landing() -> Landing {
    Landing {
        time: 0.35,
        slave: 6,
        segment: [4, 3],
        xi: 0.25,
        approach_speed: 1.5,
    }
}

/// The run record.
pub fn record() -> RunRecord {
    RunRecord {
        id: "run".into(),
        version: "0.0.0".into(),
        commit: "abcdef0".into(),
        deck: deck_text(),
        command: "stickslip run 'a b.inp'".into(),
        threads: 2,
        memory_need: 1 << 20,
    }
}

/// Totals of a run that did `increments` and ended so.
pub fn summary(outcome: Outcome, increments: usize) -> RunSummary {
    RunSummary {
        outcome,
        increments,
        rejections: 0,
        cutbacks: 0,
        events: 0,
        solver: SolverCounts::default(),
        timings: Timings::default(),
    }
}

/// Writes the results of a whole run and says where they are.
pub fn write_run(folder: &Path) -> JobFiles {
    let model = model();
    let files = JobFiles::new(Path::new("decks/small.inp"), folder);
    let mut writer = writer(&model, &files);
    for k in 0..=INCREMENTS {
        writer.increment(&report(k)).expect("increment");
    }
    let summary = summary(Outcome::Finished, INCREMENTS);
    writer.finish(&summary).expect("finish");
    files
}

/// A writer without screen.
pub fn writer<'a>(model: &'a Model, files: &JobFiles) -> ResultWriter<'a> {
    let claim = Claim::take(files, Earlier::Replaced).expect("claim");
    ResultWriter::create((model, &[]), claim, &record(), Verbosity::Quiet).expect("writer")
}
