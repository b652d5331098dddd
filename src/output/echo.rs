//! The first lines of the screen: program, deck, and the model in a few lines, as `check` prints it too.

use std::collections::HashSet;
use std::path::Path;

use super::format::{counted, general, grouped, label, scientific, wrap, wrap_words};
use super::frames::{DEFAULT_FRAMES, are_dense};
use super::model_group::contact_names;
use super::run_record::{RunRecord, utc_now};
use super::status::monitored;
use crate::contact::ContactSurfaces;
use crate::diagnostics::Sources;
use crate::diagnostics::shown;
use crate::dynamics::rigid_inertia;
use crate::model::{
    Connector, ConnectorLaw, Contact, ContactChanges, EdgeScales, Element, ElementType, Frames,
    Impact, ImpactTime, Incrementation, Interference, LandingRule, Load, Model, Procedure, Scheme,
    Settings, SolverChoice, Step, SurfaceKind,
};
use crate::prepare::{InitialGap, PreparedModel};
use crate::vectors::extents;

/// Largest number of nodes that are named.
const MOST_NAMES: usize = 12;

/// Numbers that describe a model.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelEcho {
    /// Mass of all bodies.
    pub mass: f64,
    /// Smallest coordinates (length).
    pub lower: [f64; 2],
    /// Largest coordinates (length).
    pub upper: [f64; 2],
    /// Lengths and transit times of the edges of the elements; the time of a wave along an edge is a guide for the
    /// increment.
    pub edges: EdgeScales,
    /// Number of dofs prescribed in any step.
    pub prescribed: usize,
}

impl ModelEcho {
    /// Computes the numbers of a model.
    pub fn new(model: &Model) -> Self {
        let [lower, upper] = extents(model.mesh.coordinates.iter().copied());
        let elements = model.mesh.elements.iter();
        let of_bodies = model.rigid_bodies.iter().flat_map(|body| &body.masses);
        let points = of_bodies.chain(&model.point_masses);
        let points: f64 = points.map(|(_, mass)| mass).sum();
        ModelEcho {
            mass: elements.fold(0.0, |mass, element| mass + model.element_mass(element)) + points,
            lower,
            upper,
            edges: EdgeScales::new(&model.mesh, &model.sections, &model.materials),
            prescribed: prescribed(model),
        }
    }

    /// The lines of the echo.
    pub fn lines(&self, prepared: &PreparedModel) -> Vec<String> {
        let model = &prepared.model;
        let mut lines = self.model_lines(model);
        if model.contacts.is_empty() {
            lines.push(label("contact", "none"));
        }
        let surfaces = model.contacts.iter().zip(&prepared.surfaces);
        for ((contact, surfaces), gaps) in surfaces.zip(&prepared.gaps) {
            lines.extend(contact_lines(model, contact, surfaces, gaps));
        }
        lines.extend(mass_lines(prepared));
        lines.extend(monitor_lines(model));
        for (i, step) in model.steps.iter().enumerate() {
            lines.extend(self.step_lines(i, step));
            lines.extend(fit_lines(prepared, step));
            lines.extend(contact_changes(model, &step.contacts));
        }
        lines
    }

    /// Advice on the increment: the increment that resolves waves, the time in which waves cross the model, and that
    /// slow motions allow longer increments.
    pub fn guide(&self) -> Vec<String> {
        let size = [0, 1].map(|i| self.upper[i] - self.lower[i]);
        let crossing = size[0].hypot(size[1]) / self.edges.wave_speed;
        let pieces = [
            format!("dt {} for waves and impacts:", general(self.edges.time, 2)),
            "one crosses the shortest edge in it,".to_owned(),
            format!("the model in {}", general(crossing, 2)),
            "for slow motion as long as the motion allows".to_owned(),
        ];
        wrap("guide", &pieces)
    }

    fn model_lines(&self, model: &Model) -> Vec<String> {
        let mesh = &model.mesh;
        let range = |i: usize| {
            let [lower, upper] = [self.lower[i], self.upper[i]].map(|x| general(x, 4));
            format!("[{lower},{upper}]")
        };
        let kinds = kinds(&mesh.elements);
        let size = [
            counted(mesh.node_count(), "node"),
            format!("{} ({kinds})", counted(mesh.elements.len(), "element")),
            format!(
                "{} dofs, {} fixed",
                grouped(mesh.dof_count()),
                grouped(self.prescribed)
            ),
            format!("mass {}", general(self.mass, 4)),
        ];
        let shape = [
            format!("extents {} x {}", range(0), range(1)),
            format!("shortest edge {}", general(self.edges.shortest, 3)),
            format!("wave speed {}", general(self.edges.wave_speed, 3)),
        ];
        let mut lines = wrap("model", &size);
        lines.extend(wrap("", &shape));
        if !model.connectors.is_empty() {
            let is_spring = |c: &&Connector| c.law == ConnectorLaw::Spring;
            let springs = model.connectors.iter().filter(is_spring).count();
            let counts = [
                (springs, "spring"),
                (model.connectors.len() - springs, "dashpot"),
            ];
            let counts = counts.into_iter().filter(|(count, _)| *count > 0);
            let counts: Vec<String> = counts.map(|(count, what)| counted(count, what)).collect();
            lines.push(label("", &counts.join("  ")));
        }
        lines.extend(rigid_lines(model));
        for hinge in &model.hinges {
            let [a, b] = hinge.nodes.map(|node| model.node_name(node));
            lines.push(label("hinge", &format!("nodes {a} and {b}")));
        }
        for tie in &model.ties {
            let [slave, master] = [tie.slave, tie.master].map(|k| &model.surfaces[k].name);
            let count = counted(tie.nodes.len(), "node");
            let tied = format!("{}: {count} of {slave} tied to {master}", tie.name);
            lines.extend(wrap_words("tie", &tied));
        }
        let of_ties: HashSet<usize> = (model.ties.iter())
            .flat_map(|tie| tie.nodes.iter().map(|tied| tied.node))
            .collect();
        let own = (model.equations.iter()).filter(|e| !of_ties.contains(&(e.dof / 2)));
        let equations = own.count();
        if equations > 0 {
            let count = counted(equations, "equation");
            lines.push(label("", &format!("{count} between displacements")));
        }
        lines
    }

    fn step_lines(&self, index: usize, step: &Step) -> Vec<String> {
        let increments = &step.increments;
        let decided = match increments.incrementation {
            Incrementation::Fixed => " fixed".to_owned(),
            Incrementation::Passes => " automatic".to_owned(),
            Incrementation::Error { tolerance } => {
                let largest = general(increments.dt_max, 4);
                format!(
                    " at first, at most {largest}, truncation error {}",
                    general(tolerance, 2)
                )
            }
        };
        let name = step.name.as_deref().unwrap_or_default();
        let times = [
            format!("{name} 0 .. {}", general(increments.period, 4))
                .trim_start()
                .to_owned(),
            format!("dt {}{decided}", general(increments.dt, 4)),
            format!("edge/wave speed {}", general(self.edges.time, 2)),
            frames(&step.frames),
        ];
        let settings = &step.settings;
        let own = match step.procedure {
            Procedure::Static => vec!["static".to_owned()],
            Procedure::QuasiStatic => vec!["quasi-static: backward Euler".to_owned()],
            Procedure::Dynamic => vec![scheme(settings.scheme), impact(settings)],
        };
        let solver = format!("solver {}", solver(settings.solver));
        let numerics: Vec<String> = own.into_iter().chain([solver]).collect();
        let mut lines = wrap(&format!("step {}", index + 1), &times);
        lines.extend(wrap("", &numerics));
        if are_dense(step) {
            lines.push(label(
                "note",
                "frames are asked for at shorter intervals than dt: every increment is one",
            ));
        }
        lines
    }
}

/// Changes of the contacts in a step.
fn contact_changes(
    model: &Model,
    ContactChanges { removed, friction }: &ContactChanges,
) -> Vec<String> {
    let names = contact_names(model);
    let removed = removed
        .iter()
        .map(|&contact| format!("{} removed", names[contact]));
    let friction = friction.iter().map(|change| {
        let when = match change.from.as_ref().map(|from| from.amplitude) {
            None => String::new(),
            Some(None) => " at the end".to_owned(),
            Some(Some(index)) => format!(" as {} says", model.amplitudes[index].name),
        };
        format!("{} {}{when}", names[change.contact], change.friction)
    });
    let changes: Vec<String> = removed.chain(friction).collect();
    match changes.is_empty() {
        true => changes,
        false => wrap("", &changes),
    }
}

/// Name of a linear solver as typed on the command line.
pub fn solver(choice: SolverChoice) -> &'static str {
    match choice {
        SolverChoice::Faer => "faer",
        SolverChoice::Sprs => "sprs",
    }
}

/// The times of the frames as text.
pub fn frames(frames: &Frames) -> String {
    match frames {
        Frames::Default => format!("output {}", counted(DEFAULT_FRAMES, "frame")),
        Frames::Count(count) => format!("output {}", counted(*count, "frame")),
        Frames::Every(interval) => format!("output every {}", general(*interval, 4)),
        Frames::Increments(count) => format!("output every {}", counted(*count, "increment")),
        Frames::Times(times) => format!("output at {}", counted(times.len(), "time")),
    }
}

fn scheme(scheme: Scheme) -> String {
    match scheme {
        Scheme::EnergyMomentum => "scheme energy-momentum".into(),
        Scheme::Ss22 { theta1, theta2 } => format!(
            "scheme SS22 theta1 {} theta2 {}",
            general(theta1, 4),
            general(theta2, 4)
        ),
    }
}

fn impact(settings: &Settings) -> String {
    let impulses = match (settings.impact, settings.impact_time) {
        (Impact::None, _) => "no impact impulses",
        (Impact::Impulse, ImpactTime::Increment) => "impact impulses",
        (Impact::Impulse, ImpactTime::Event) => "impact impulses at the times of impacts",
    };
    match settings.landing {
        LandingRule::Plastic => impulses.to_owned(),
        LandingRule::Return => format!("{impulses}, landing return"),
    }
}

fn contact_lines(
    model: &Model,
    contact: &Contact,
    surfaces: &ContactSurfaces,
    gaps: &[InitialGap],
) -> Vec<String> {
    let (slave, master) = (
        &model.surfaces[contact.slave],
        &model.surfaces[contact.master],
    );
    let edge = match master.kind {
        SurfaceKind::Rigid(_) => "rigid edge",
        SurfaceKind::Faces(_) | SurfaceKind::Nodes(_) => "edge",
    };
    let nodes = match model.disc(contact) {
        Some(disc) => format!("disc of radius {}", shown(disc.radius)),
        None => counted(slave.nodes(&model.mesh).len(), "node"),
    };
    let edges = counted(master.segments(&model.mesh).len(), edge);
    let sides = match contact.is_self_contact() {
        true => format!("{} ({nodes}, {edges}) with itself", slave.name),
        false => format!("{} ({nodes}) -> {} ({edges})", slave.name, master.name),
    };
    let mut pieces = vec![
        sides,
        formulation(contact),
        contact.interaction.friction.to_string(),
        smallest_gap(gaps),
    ];
    if let (bent @ 1.., angle) = surfaces.bent(&model.mesh.coordinates) {
        let angle = general(angle.to_degrees(), 2);
        let faces = counted(bent, "face");
        pieces.push(format!(
            "{faces} curved, by up to {angle} degrees at a node"
        ));
    }
    wrap("contact", &pieces)
}

/// Formulation of a contact, with the reason if the program has chosen it.
fn formulation(contact: &Contact) -> String {
    let name = contact.formulation.name().to_lowercase();
    let lying = match contact.lying_faces {
        None => return name,
        Some(0) => "no face lies".to_owned(),
        Some(1) => "1 face lies".to_owned(),
        Some(count) => format!("{} lie", counted(count, "face")),
    };
    format!("{name} as {lying} on other bodies")
}

/// The overlaps that contacts allow in a step.
fn fit_lines(prepared: &PreparedModel, step: &Step) -> Vec<String> {
    let model = &prepared.model;
    let line = |load: &Load<Interference>| {
        let contact = &model.contacts[load.at.contact];
        let slave = &model.surfaces[contact.slave].name;
        let overlaps = prepared.overlaps[load.at.contact].iter();
        let largest = overlaps.fold(0.0, |most: f64, o| most.max(*o));
        let overlap = match (load.at.is_shrink, load.ends()) {
            (true, _) => format!("up to {} shrinks to nothing", scientific(largest, 1)),
            (false, Some([from, to])) => {
                format!("from {} to {}", scientific(from, 1), scientific(to, 1))
            }
            (false, None) => format!("{} times an amplitude", scientific(load.magnitude, 1)),
        };
        label("", &format!("{slave} may overlap: {overlap}"))
    };
    step.interferences.iter().map(line).collect()
}

/// Bodies that turn, with their mass and the directions in which they move freely.
fn rigid_lines(model: &Model) -> Vec<String> {
    let mut lines = Vec::new();
    let all = model.rigid_bodies.iter().zip(rigid_inertia(model));
    for (body, [mass, inertia]) in all.filter(|(body, _)| body.turns) {
        let reference = model.node_name(body.reference);
        let nodes = counted(body.nodes.len(), "node");
        let what = match body.is_coupling {
            true => format!("{}: {nodes} ride on node {reference}", body.name),
            false => format!("{}: {nodes} turn with node {reference}", body.name),
        };
        let mut pieces = vec![what];
        if mass > 0.0 {
            let [mass, inertia] = [mass, inertia].map(|value| general(value, 4));
            pieces.push(format!("mass {mass}, inertia {inertia}"));
        }
        let x = 2 * body.reference;
        let dofs = [(x, 1), (x + 1, 2), (model.angle_of(body), 6)];
        let free = |step: &Step| {
            let is_free = |dof: usize| step.motion_of(dof).is_none();
            let free = dofs.iter().filter(|(dof, _)| is_free(*dof));
            let names: Vec<String> = free.map(|(_, name)| name.to_string()).collect();
            match names.is_empty() {
                true => "driven".to_owned(),
                false => format!("free in {}", names.join(", ")),
            }
        };
        let of_steps: Vec<String> = model.steps.iter().map(free).collect();
        match of_steps.iter().all(|own| Some(own) == of_steps.first()) {
            true => pieces.extend(of_steps.into_iter().take(1)),
            false => {
                let numbered = of_steps.iter().enumerate();
                pieces.extend(numbered.map(|(k, own)| format!("step {}: {own}", k + 1)));
            }
        }
        lines.extend(wrap("rigid", &pieces));
    }
    lines
}

/// Numbers of nodes without mass and of nodes of contact surfaces that keep their mass, if mass is redistributed.
fn mass_lines(prepared: &PreparedModel) -> Vec<String> {
    let (model, redistribution) = (&prepared.model, &prepared.redistribution);
    let kept = redistribution.kept();
    if redistribution.is_empty() && kept.is_empty() {
        return Vec::new();
    }
    let massless = redistribution.massless().len();
    let mut text = format!(
        "redistributed: {} without mass",
        counted(massless, "contact node")
    );
    if !kept.is_empty() {
        let label = |&node: &usize| model.node_name(node);
        let mut names: Vec<String> = kept.iter().take(MOST_NAMES).map(label).collect();
        if kept.len() > MOST_NAMES {
            names.push(format!("and {} more", kept.len() - MOST_NAMES));
        }
        let names = names.join(", ");
        text = format!("{text}, {} keep their mass: {names}", grouped(kept.len()));
    }
    wrap_words("mass", &text)
}

/// Displacements in the status file.
fn monitor_lines(model: &Model) -> Vec<String> {
    let names: Vec<String> = monitored(model).into_iter().map(|(name, _)| name).collect();
    match names.is_empty() {
        true => Vec::new(),
        false => wrap("monitor", &names),
    }
}

/// The smallest gap of the contacts at the start.
fn smallest_gap(gaps: &[InitialGap]) -> String {
    match gaps.iter().map(|gap| gap.gap).reduce(f64::min) {
        Some(gap) => format!("smallest gap {}", scientific(gap, 1)),
        None => "no node faces its master".into(),
    }
}

/// Names of the element types in the mesh.
fn kinds(elements: &[Element]) -> String {
    let mut types: Vec<ElementType> = Vec::new();
    for element in elements {
        if !types.contains(&element.element_type) {
            types.push(element.element_type);
        }
    }
    let mut names: Vec<String> = types.iter().map(ElementType::to_string).collect();
    names.sort();
    names.join(" ")
}

/// Number of dofs prescribed in any step.
fn prescribed(model: &Model) -> usize {
    let supports = model.steps.iter().flat_map(|step| &step.supports);
    let mut dofs: Vec<usize> = supports.map(|support| support.dof).collect();
    dofs.sort_unstable();
    dofs.dedup();
    dofs.len()
}

/// Lines with program, job, time, threads and the heading of the deck.
pub fn program_lines(record: &RunRecord, profile: &str, job: &str, title: &str) -> Vec<String> {
    let pieces = [
        format!(" {} ({}, {profile})", record.version, record.commit),
        format!("job {job}"),
        utc_now(),
        counted(record.threads, "thread"),
    ];
    let mut lines = wrap("stickslip", &pieces);
    if !title.trim().is_empty() {
        lines.push(label("title", title.trim()));
    }
    lines
}

/// The line of the deck with its size and the numbers of errors and warnings; `log` is the file that holds the
/// warnings.
pub fn deck_line(
    deck: &Path,
    sources: &Sources,
    [errors, warnings]: [usize; 2],
    log: Option<&Path>,
) -> String {
    let name = deck.file_name().unwrap_or_default().to_string_lossy();
    let included = match sources.files().len() {
        0 | 1 => String::new(),
        count => format!(" + {}", counted(count - 1, "include")),
    };
    let log = match log.and_then(Path::file_name) {
        Some(log) if warnings > 0 => format!(" (see {})", log.to_string_lossy()),
        _ => String::new(),
    };
    let text = format!(
        "{name}{included}, {}: {}, {}{log}",
        counted(sources.line_count(), "line"),
        counted(errors, "error"),
        counted(warnings, "warning"),
    );
    label("deck", &text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_line_is_no_lines() {
        let line = |included: &str, errors| {
            let mut sources = Sources::new();
            sources.add("b.inp", "*INCLUDE", None);
            sources.add("c.inp", included, None);
            deck_line(Path::new("a/b.inp"), &sources, [errors, 0], None)
        };
        assert!(line("", 1).ends_with("b.inp + 1 include, 1 line: 1 error, 0 warnings"));
        assert!(line("**", 0).ends_with("b.inp + 1 include, 2 lines: 0 errors, 0 warnings"));
    }
}
