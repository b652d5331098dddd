//! Initial velocities and steps.

use super::lines::{Lines, named, number, set};
use super::loads::Loads;
use super::mesh::first_of_rigid;
use crate::model::{
    Amplitude, ContactMass, Factorization, Frames, HistorySet, Impact, ImpactTime, Increments,
    LandingRule, LcpChoice, Model, NamedSets, Procedure, Rate, Scheme, Settings, SolverChoice,
    Step, Support, SupportMotion,
};

/// Times on a data line.
const TIMES: usize = 8;

/// Writes initial velocities and all steps.
pub(super) fn write(model: &Model, lines: &mut Lines) {
    initial_velocity(model, lines);
    for (index, step) in model.steps.iter().enumerate() {
        time_points(index, step, lines);
    }
    let mut supports = Vec::new();
    let mut loads = Loads::default();
    for (index, step) in model.steps.iter().enumerate() {
        let now = Loads::of(step, model);
        head(step, &now, lines);
        settings(&step.settings, lines);
        let held = own_supports(step, model);
        write_supports(&held, &supports, model, lines);
        now.write(&loads, model, lines);
        requests(index, step, model, lines);
        lines.card("END STEP", []);
        supports = carried(&held, step, &model.amplitudes);
        loads = now.carried(step.increments.period, &model.amplitudes);
    }
}

fn initial_velocity(model: &Model, lines: &mut Lines) {
    let velocity = model.initial_velocity.iter().enumerate();
    let moving: Vec<(usize, &f64)> = velocity.filter(|(_, v)| **v != 0.0).collect();
    if !moving.is_empty() {
        lines.card("INITIAL CONDITIONS", [set("TYPE", "VELOCITY")]);
    }
    for (dof, &value) in moving {
        lines.row(dof_fields(dof, model).into_iter().chain([number(value)]));
    }
}

fn dof_fields(dof: usize, model: &Model) -> [String; 2] {
    let label = model.mesh.node_labels[dof / 2];
    [label.to_string(), (dof % 2 + 1).to_string()]
}

/// `*STEP` and its procedure.
fn head(step: &Step, loads: &Loads, lines: &mut Lines) {
    let mut parameters = vec!["NLGEOM".to_owned()];
    parameters.extend(step.name.as_ref().map(|name| named("NAME", name)));
    parameters.extend(loads.ramp().then(|| set("AMPLITUDE", "RAMP")));
    lines.card_of("STEP", &parameters);
    let Increments {
        dt,
        period,
        dt_min,
        direct,
    } = step.increments;
    let Procedure::Dynamic = step.procedure;
    match direct {
        true => {
            lines.card("DYNAMIC", ["DIRECT".to_owned()]);
            lines.row([dt, period, dt_min].map(number));
        }
        // the largest increment says that they do not grow
        false => {
            lines.card("DYNAMIC", []);
            lines.row([dt, period, dt_min, dt].map(number));
        }
    }
}

fn settings(settings: &Settings, lines: &mut Lines) {
    let Settings {
        scheme,
        impact,
        impact_time,
        landing,
        is_check_only,
        ..
    } = *settings;
    if is_check_only {
        lines.card("NO ANALYSIS", []);
    }
    let mut parameters = match scheme {
        Scheme::EnergyMomentum => vec![set("SCHEME", "ENERGY-MOMENTUM")],
        Scheme::Ss22 { theta1, theta2 } => vec![
            set("SCHEME", "SS22"),
            set("THETA1", number(theta1)),
            set("THETA2", number(theta2)),
        ],
    };
    let impact = match impact {
        Impact::Impulse => "IMPULSE",
        Impact::None => "NONE",
    };
    let impact_time = match impact_time {
        ImpactTime::Increment => "INCREMENT",
        ImpactTime::Event => "EVENT",
    };
    let landing = match landing {
        LandingRule::Plastic => "PLASTIC",
        LandingRule::Return => "RETURN",
    };
    parameters.extend([
        set("IMPACT", impact),
        set("IMPACT TIME", impact_time),
        set("LANDING", landing),
    ]);
    parameters.extend(solver_settings(settings));
    lines.card_of("STICKSLIP", &parameters);
}

fn solver_settings(settings: &Settings) -> [String; 6] {
    let Settings {
        scheme: _,
        impact: _,
        impact_time: _,
        landing: _,
        contact_mass,
        lcp,
        factorization,
        solver,
        tolerance,
        max_passes,
        is_check_only: _,
    } = *settings;
    let contact_mass = match contact_mass {
        ContactMass::Consistent => "CONSISTENT",
        ContactMass::Redistributed => "REDISTRIBUTED",
    };
    let lcp = match lcp {
        LcpChoice::Hybrid => "HYBRID",
        LcpChoice::Lemke => "LEMKE",
    };
    let factorization = match factorization {
        Factorization::Keep => "KEEP",
        Factorization::EveryPass => "EVERY PASS",
    };
    let solver = match solver {
        SolverChoice::Faer => "FAER",
        SolverChoice::Sprs => "SPRS",
    };
    [
        set("CONTACT MASS", contact_mass),
        set("LCP", lcp),
        set("FACTORIZATION", factorization),
        set("SOLVER", solver),
        set("TOLERANCE", number(tolerance)),
        set("MAX PASSES", max_passes),
    ]
}

/// Supports but those of the nodes of rigid surfaces, which follow their reference nodes.
fn own_supports(step: &Step, model: &Model) -> Vec<Support> {
    let first = first_of_rigid(model);
    let own = step
        .supports
        .iter()
        .filter(|support| support.dof / 2 < first);
    own.copied().collect()
}

/// Supports that a step leaves to the next one.
fn carried(supports: &[Support], step: &Step, amplitudes: &[Amplitude]) -> Vec<Support> {
    let period = step.increments.period;
    let kept = supports.iter().map(|&Support { dof, motion }| Support {
        dof,
        motion: motion.after_step(period, amplitudes),
    });
    kept.collect()
}

/// What a card of supports says on its keyword line: the derivative that it prescribes, and the
/// amplitude.
fn kind_of(support: &Support) -> (Option<Rate>, Option<usize>) {
    match support.motion {
        SupportMotion::Ramp { .. } => (None, None),
        SupportMotion::Amplitude { amplitude, .. } => (None, Some(amplitude)),
        SupportMotion::Rate {
            rate, amplitude, ..
        } => (Some(rate), amplitude),
    }
}

/// Writes the supports of a step, all of them where they are not those of the step before.
fn write_supports(now: &[Support], carried: &[Support], model: &Model, lines: &mut Lines) {
    if now == carried {
        return;
    }
    let amplitudes = || std::iter::once(None).chain((0..model.amplitudes.len()).map(Some));
    let rates = [None, Some(Rate::Velocity), Some(Rate::Acceleration)];
    let kinds = rates
        .iter()
        .flat_map(|&rate| amplitudes().map(move |a| (rate, a)));
    let mut operation = (!carried.is_empty()).then(|| set("OP", "NEW"));
    if now.is_empty() {
        lines.card_of("BOUNDARY", operation.as_slice());
    }
    for (rate, amplitude) in kinds {
        let is_own = |s: &&Support| kind_of(s) == (rate, amplitude);
        let of_card: Vec<&Support> = now.iter().filter(is_own).collect();
        if of_card.is_empty() {
            continue;
        }
        let rate = rate.map(|rate| match rate {
            Rate::Velocity => set("TYPE", "VELOCITY"),
            Rate::Acceleration => set("TYPE", "ACCELERATION"),
        });
        let name = amplitude.map(|index| named("AMPLITUDE", &model.amplitudes[index].name));
        let parameters: Vec<String> = operation
            .take()
            .into_iter()
            .chain(rate)
            .chain(name)
            .collect();
        lines.card_of("BOUNDARY", &parameters);
        let alike = |a: &&Support, b: &&Support| a.dof / 2 == b.dof / 2 && a.motion == b.motion;
        for supports in of_card.chunk_by(alike) {
            support_row(supports, model, lines);
        }
    }
}

/// Supports of one or both directions of a node that move alike.
fn support_row(supports: &[&Support], model: &Model, lines: &mut Lines) {
    let (Some(first), Some(last)) = (supports.first(), supports.last()) else {
        return;
    };
    let (SupportMotion::Ramp { to: value }
    | SupportMotion::Amplitude { value, .. }
    | SupportMotion::Rate { value, .. }) = first.motion;
    let [label, direction] = dof_fields(first.dof, model);
    let [_, to] = dof_fields(last.dof, model);
    lines.row([label, direction, to, number(value)]);
}

/// Name of the times at which a step writes its frames.
fn times_name(index: usize) -> String {
    format!("TIMES-{}", index + 1)
}

fn time_points(index: usize, step: &Step, lines: &mut Lines) {
    let Frames::Times(times) = &step.frames else {
        return;
    };
    lines.card("TIME POINTS", [set("NAME", times_name(index))]);
    // frames are written after the start only: this time stands for an empty list
    let times = if times.is_empty() { &[0.0][..] } else { times };
    for times in times.chunks(TIMES) {
        lines.row(times.iter().copied().map(number));
    }
}

/// When frames are written; in the first step fields on request, sets of the history and dofs in the status
/// file.
fn requests(index: usize, step: &Step, model: &Model, lines: &mut Lines) {
    let when = match &step.frames {
        Frames::Default => None,
        Frames::Count(count) => Some(set("NUMBER INTERVAL", count)),
        Frames::Every(interval) => Some(set("TIME INTERVAL", number(*interval))),
        Frames::Increments(count) => Some(set("FREQUENCY", count)),
        Frames::Times(_) => Some(set("TIME POINTS", times_name(index))),
    };
    if let Some(when) = when {
        lines.card("OUTPUT", ["FIELD".to_owned(), when]);
    }
    if index == 0 {
        histories(&model.sets, lines);
        for &dof in &model.sets.monitored {
            let [node, direction] = dof_fields(dof, model);
            lines.card("MONITOR", [set("NODE", node), set("DOF", direction)]);
        }
    }
}

fn histories(sets: &NamedSets, lines: &mut Lines) {
    let asked = sets.fields;
    if asked.concentrated_load {
        lines.card("NODE FILE", []);
        lines.row(["CF".to_owned()]);
    }
    let of_elements = [
        (asked.energy_density, "ENER"),
        (asked.logarithmic_strain, "LE"),
    ];
    let of_elements = of_elements.iter().filter(|(is_asked, _)| *is_asked);
    let names: Vec<String> = of_elements.map(|(_, name)| (*name).to_owned()).collect();
    if !names.is_empty() {
        lines.card("EL FILE", []);
        lines.row(names);
    }
    let totals = |asked: &HistorySet| set("TOTALS", if asked.each_member { "YES" } else { "ONLY" });
    for asked in &sets.history {
        let name = named("NSET", &sets.nodes[asked.set].name);
        lines.card("NODE PRINT", [name, totals(asked)]);
        lines.row(["U", "V", "RF"].map(str::to_owned));
    }
    for asked in &sets.element_history {
        let name = named("ELSET", &sets.elements[asked.set].name);
        lines.card("EL PRINT", [name, totals(asked)]);
        lines.row(["S", "E", "ENER", "ELSE", "ELKE", "EVOL"].map(str::to_owned));
    }
}
