//! `*STEP`, `*STATIC`, `*DYNAMIC` and `*STICKSLIP`; the state of supports, loads and settings from step to step.

use super::actions::Actions;
use super::boundary::{Supports, Targets};
use super::contact_changes::ContactHistory;
use super::context::Context;
use super::interference::{Interferences, Pairs};
use super::loads::{LoadHistories, Operation, StepContext};
use super::outline::{Outline, StepCards};
use super::output::{Histories, Requests};
use super::surfaces::Surfaces;
use super::temperatures::TemperatureHistory;
use crate::deck::{Card, Line};
use crate::diagnostics::{Code, shown};
use crate::model::{
    Contact, ContactMass, Factorization, Impact, ImpactTime, Incrementation, Increments,
    LandingRule, LcpMethod, Procedure, RestartOutput, Scheme, Settings, SolverChoice, Step,
    Support,
};

/// Largest number of increments of a step: so many increments would last eleven days at a microsecond each.
const MOST_INCREMENTS: f64 = 1e12;

/// Everything that the steps of a deck define.
pub(crate) struct Steps {
    /// Steps in order.
    pub all: Vec<Step>,
    /// Requests for histories and the status file.
    pub histories: Histories,
    /// Requests for checkpoints.
    pub restarts: Vec<RestartOutput>,
    /// Supports of the first step.
    pub at_start: Vec<Support>,
    /// Supports after the last step.
    pub supports: Supports,
    /// Forces on nodes without element.
    pub forces: Actions,
}

/// Reads all steps; `guide` is a sensible increment; `None` if no such increment is known.
pub(crate) fn read(
    outline: &Outline,
    targets: Targets,
    (surfaces, contacts, temperatures): (&Surfaces, &[Contact], &[f64]),
    guide: Option<f64>,
    cx: &mut Context,
) -> Steps {
    let mut reading = StepReader {
        targets,
        surfaces,
        contacts,
        guide,
        has_contacts: ["CONTACT PAIR", "CONTACT"]
            .iter()
            .any(|keyword| !outline.model_cards(keyword).is_empty()),
        changes: ContactHistory::new(contacts, targets.amplitudes),
        settings: Settings::default(),
        supports: Supports::default(),
        support_operation: Operation::default(),
        loads: LoadHistories::default(),
        interferences: Interferences::default(),
        temperatures: TemperatureHistory::new(temperatures.to_vec()),
        requests: Requests::new(cx),
        nonlinear: false,
        start: 0.0,
        last: outline.steps.len(),
    };
    for card in outline.model_cards("BOUNDARY") {
        if card.choice("OP") == Some("NEW") {
            reading.supports.clear();
        }
        reading.supports.card(card, 0, targets, cx);
    }
    reading.settings.is_check_only = !outline.model_cards("NO ANALYSIS").is_empty();
    for card in outline.model_cards("RESTART") {
        reading.requests.restart(card, cx);
    }
    reading.interferences.first_step(contacts);
    let mut steps = Vec::new();
    let mut at_start = None;
    for (index, cards) in outline.steps.iter().enumerate() {
        steps.extend(reading.step(index + 1, cards, &mut at_start, cx));
    }
    Steps {
        all: steps,
        histories: reading.requests.histories,
        restarts: reading.requests.restarts,
        at_start: at_start.unwrap_or_default(),
        supports: reading.supports,
        forces: reading.loads.actions,
    }
}

/// State of the model between the steps of the deck.
struct StepReader<'a> {
    targets: Targets<'a>,
    surfaces: &'a Surfaces,
    contacts: &'a [Contact],
    guide: Option<f64>,
    has_contacts: bool,
    changes: ContactHistory<'a>,
    settings: Settings,
    supports: Supports,
    support_operation: Operation,
    loads: LoadHistories,
    interferences: Interferences,
    temperatures: TemperatureHistory,
    requests: Requests,
    nonlinear: bool,
    start: f64,
    /// Number of the last step.
    last: usize,
}

impl StepReader<'_> {
    fn step(
        &mut self,
        number: usize,
        cards: &StepCards,
        at_start: &mut Option<Vec<Support>>,
        cx: &mut Context,
    ) -> Option<Step> {
        self.check_nonlinear(cards.head, cx);
        let (procedure, increments) = self.procedure(cards, cx);
        let ramp = match cards.head.choice("AMPLITUDE") {
            Some(amplitude) => amplitude == "RAMP",
            None => procedure != Procedure::Dynamic,
        };
        let context = StepContext { step: number, ramp };
        let period = increments.map_or(0.0, |increments| increments.period);
        self.own_settings(cards, number, cx);
        self.conditions(cards, context, cx);
        let contacts = (self.changes).step(&cards.cards, context, self.surfaces, cx);
        self.requests.step = number;
        self.requests.cards(&cards.cards, self.targets, cx);
        let supports = self.supports.list();
        at_start.get_or_insert_with(|| supports.clone());
        let name = cards.head.value("NAME").and_then(|name| name.name(cx.d));
        let step = increments.map(|increments| Step {
            supports,
            contacts,
            ..self.build(
                name.map(|n| n.typed),
                procedure,
                increments,
                number == self.last,
            )
        });
        if let Some(step) = &step {
            check_fit(step, cards, cx);
        }
        if number < self.last {
            self.end(period);
        }
        step
    }

    fn build(
        &mut self,
        name: Option<String>,
        procedure: Procedure,
        increments: Increments,
        is_last: bool,
    ) -> Step {
        let mut step = Step {
            name,
            procedure,
            settings: self.settings,
            interferences: self.interferences.list(is_last),
            temperatures: self.temperatures.list(),
            frames: self.requests.frames(self.start, increments.period),
            ..Step::new(increments)
        };
        self.loads.fill(&mut step, is_last);
        step
    }

    fn end(&mut self, period: f64) {
        self.start += period;
        self.changes.end_step(period);
        let all = &self.targets.amplitudes.named.all;
        self.supports.end_step(period, all);
        self.loads.end_step(period, self.start, all);
        self.interferences.end_step(period, self.start, all);
        self.temperatures.end_step(period, self.start, all);
    }

    fn check_nonlinear(&mut self, head: &Card, cx: &mut Context) {
        let said_no = head.choice("NLGEOM") == Some("NO");
        self.nonlinear |= head.has("NLGEOM") && !said_no;
        if !self.nonlinear && !said_no {
            let message = "this step runs with NLGEOM: displacements are large in any case";
            cx.d.warning_once(Code::NonlinearStep, head.span, message);
        }
    }

    /// Reads the procedure of a step; a missing or second procedure is reported.
    fn procedure(
        &mut self,
        cards: &StepCards,
        cx: &mut Context,
    ) -> (Procedure, Option<Increments>) {
        let is_procedure = |card: &&Card| ["STATIC", "DYNAMIC"].contains(&card.keyword.name);
        let found: Vec<&Card> = cards.cards.iter().copied().filter(is_procedure).collect();
        cx.only_once(&found);
        let Some(card) = found.first() else {
            if !cx.may_lack_cards() {
                let message = "this step has no procedure";
                cx.error(Code::StepStructure, cards.head.span, message)
                    .help("add *STATIC or *DYNAMIC with the increment and the duration");
            }
            return (Procedure::Dynamic, None);
        };
        if card.keyword.name == "STATIC" {
            return (Procedure::Static, static_increments(card, cx));
        }
        match card.choice("IMPACT") {
            Some("NO") => self.settings.impact = Impact::None,
            Some(_) => self.settings.impact = Impact::Impulse,
            None => {}
        }
        let procedure = match card.choice("APPLICATION") {
            Some("QUASI-STATIC") => Procedure::QuasiStatic,
            _ => Procedure::Dynamic,
        };
        let contacts = self.has_contacts;
        (
            procedure,
            increments(card, procedure, (self.guide, contacts), cx),
        )
    }

    fn own_settings(&mut self, cards: &StepCards, number: usize, cx: &mut Context) {
        let found = named(cards, "STICKSLIP");
        cx.only_once(&found);
        for card in found {
            let before = self.settings.contact_mass;
            apply_settings(card, &mut self.settings, cx);
            let now = self.settings.contact_mass;
            check_contact_mass(card, [before, now], number, cx);
        }
        self.settings.is_check_only |= !named(cards, "NO ANALYSIS").is_empty();
    }

    fn conditions(&mut self, cards: &StepCards, context: StepContext, cx: &mut Context) {
        for card in &cards.cards {
            match card.keyword.name {
                "BOUNDARY" => {
                    if self.support_operation.starts_anew(card, context.step, cx) {
                        self.supports.clear();
                    }
                    self.supports.card(card, context.step, self.targets, cx);
                }
                "CLOAD" | "DLOAD" | "DSLOAD" => {
                    self.loads
                        .card(card, context, self.targets, self.surfaces, cx);
                }
                "TEMPERATURE" => self.temperatures.card(card, context, self.targets, cx),
                "CONTACT INTERFERENCE" => {
                    let pairs = Pairs {
                        surfaces: self.surfaces,
                        contacts: self.contacts,
                        targets: self.targets,
                        start: self.start,
                    };
                    self.interferences.card(card, context.step, pairs, cx);
                }
                _ => {}
            }
        }
    }
}

/// Reports overlaps that a step with IMPACT TIME=EVENT is to remove: events are found only for surfaces without an
/// allowed overlap.
fn check_fit(step: &Step, cards: &StepCards, cx: &mut Context) {
    let has_events =
        step.procedure == Procedure::Dynamic && step.settings.impact_time == ImpactTime::Event;
    if has_events && !step.interferences.is_empty() {
        let message = "a fit cannot be pressed together in a step with IMPACT TIME=EVENT";
        cx.error(Code::Interference, cards.head.span, message)
            .help("press it together in a step before, or leave out IMPACT TIME=EVENT in this one");
    }
}

fn named<'a>(cards: &StepCards<'a>, keyword: &str) -> Vec<&'a Card> {
    let all = cards.cards.iter().copied();
    all.filter(|card| card.keyword.name == keyword).collect()
}

/// Largest truncation error of an increment, relative to the displacements of the step so far.
pub(crate) const TRUNCATION_ERROR: f64 = 1e-4;

/// Default bounds of the increments of a dynamic step without DIRECT. The smallest increment is [`LEAST_PART`] times
/// the first increment, or [`LEAST_DYNAMIC`] times the duration if this is less. The largest increment is the first
/// increment, or [`LARGEST_DYNAMIC`] times the duration if this is longer.
const LEAST_PART: f64 = 1.0 / 1024.0;
const LEAST_DYNAMIC: f64 = 1e-5;
const LARGEST_DYNAMIC: f64 = 0.1;

/// Tolerance of the truncation error for HALFINC SCALE FACTOR=1. The default of the factor (10000 with contacts, 1000
/// without contacts) corresponds to [`TRUNCATION_ERROR`].
pub(crate) fn tolerance_of_factor(has_contacts: bool) -> f64 {
    TRUNCATION_ERROR / if has_contacts { 1e4 } else { 1e3 }
}

/// Reads a row `dt, T[, smallest dt[, largest dt]]`.
fn increments(
    card: &Card,
    procedure: Procedure,
    (guide, has_contacts): (Option<f64>, bool),
    cx: &mut Context,
) -> Option<Increments> {
    let direct = is_direct(card);
    let Some(row) = card.rows.first() else {
        let message = "*DYNAMIC needs a data line: the increment and the duration";
        cx.error(Code::MissingData, card.span, message);
        return None;
    };
    row.at_most(4, cx.d);
    let tolerance = truncation_error(card, (direct, procedure), has_contacts, cx)?;
    let period = row.real(1, "the duration of the step", cx.d);
    let guide = guide.filter(|_| procedure == Procedure::Dynamic);
    let first = first_increment(row, (direct, period?), guide, cx);
    let (first, period) = (first?, period?);
    let (least, largest) = match direct {
        true => (0.0, f64::INFINITY),
        false => (
            (LEAST_PART * first).min(LEAST_DYNAMIC * period),
            match procedure {
                Procedure::Dynamic => first.max(LARGEST_DYNAMIC * period),
                _ => period,
            },
        ),
    };
    let dt_min = time_or(row, 2, least, cx)?;
    let dt_max = time_or(row, 3, largest, cx)?;
    let dt = if direct { first } else { first.min(dt_max) };
    check_times(row, dt, period, dt_min, dt_max, cx)?;
    if direct {
        let help = "with DIRECT increments keep their size but for cutbacks";
        row.without_effect(3, "this largest increment has no effect", help, cx.d);
        note_short_end(row, dt, period, cx);
    }
    Some(Increments {
        dt,
        period,
        dt_min,
        dt_max: if direct { dt } else { dt_max },
        incrementation: match (direct, procedure) {
            (true, _) => Incrementation::Fixed,
            (false, Procedure::Dynamic) => Incrementation::Error { tolerance },
            (false, _) => Incrementation::Passes,
        },
    })
}

fn is_direct(card: &Card) -> bool {
    (card.has("DIRECT") && card.choice("DIRECT") != Some("NO")) || card.has("DIRECT USER CONTROL")
}

/// Tolerance of the truncation error of a dynamic step.
fn truncation_error(
    card: &Card,
    (direct, procedure): (bool, Procedure),
    has_contacts: bool,
    cx: &mut Context,
) -> Option<f64> {
    let about = ["HAFTOL", "HALFINC SCALE FACTOR", "NOHAF"];
    if procedure == Procedure::QuasiStatic {
        let help = "increments of a quasi-static step follow their passes";
        for given in about.into_iter().filter(|name| card.has(name)) {
            let message = format!("{given} has no effect with APPLICATION=QUASI-STATIC");
            cx.d.warning(Code::IgnoredParameter, card.span_of(given), message)
                .help(help);
        }
        return Some(TRUNCATION_ERROR);
    }
    if direct {
        if card.has("NOHAF") {
            let message = "NOHAF has no effect: DIRECT keeps the size of increments";
            (cx.d).warning(Code::IgnoredParameter, card.span_of("NOHAF"), message);
        }
        let mut scaled = ["HAFTOL", "HALFINC SCALE FACTOR"].into_iter();
        let Some(given) = scaled.find(|name| card.has(name)) else {
            return Some(TRUNCATION_ERROR);
        };
        let message = format!("{given} is for automatic increments, and DIRECT keeps their size");
        cx.error(Code::BadIncrement, card.span_of(given), message)
            .help(format!("leave out {given}, or DIRECT"));
        return None;
    }
    for given in ["HAFTOL", "NOHAF"]
        .into_iter()
        .filter(|name| card.has(name))
    {
        let message = format!("{given} has no effect: increments follow their truncation error");
        (cx.d
            .warning(Code::IgnoredParameter, card.span_of(given), message))
        .help("HALFINC SCALE FACTOR scales its tolerance");
    }
    let Some(factor) = card.real("HALFINC SCALE FACTOR", cx.d) else {
        return Some(TRUNCATION_ERROR);
    };
    let span = card.span_of("HALFINC SCALE FACTOR");
    let is_fine = card.choice("APPLICATION") == Some("TRANSIENT FIDELITY");
    let tolerance = factor * tolerance_of_factor(has_contacts && !is_fine);
    if !(tolerance > 0.0 && tolerance < 1.0) {
        let message = format!(
            "the scale factor must be positive and give a tolerance below 1, found {tolerance:.1e}"
        );
        cx.error(Code::BadIncrement, span, message);
        return None;
    }
    let message = format!(
        "no half-increment residual is looked at: the truncation error stays below {tolerance:.1e} of the displacements"
    );
    cx.d.warning(Code::ScaledTolerance, span, message);
    Some(tolerance)
}

/// Default of the smallest increment of a static step, relative to its duration.
const LEAST_STATIC: f64 = 1e-5;

/// Reads a row `[dt[, T[, smallest dt[, largest dt]]]]` of a static step; the default of T is 1, and the default of dt
/// is T.
fn static_increments(card: &Card, cx: &mut Context) -> Option<Increments> {
    let direct = is_direct(card);
    let incrementation = match direct {
        true => Incrementation::Fixed,
        false => Incrementation::Passes,
    };
    let Some(row) = card.rows.first() else {
        return Some(Increments {
            dt: 1.0,
            period: 1.0,
            dt_min: if direct { 0.0 } else { LEAST_STATIC },
            dt_max: 1.0,
            incrementation,
        });
    };
    row.at_most(4, cx.d);
    let period = time_or(row, 1, 1.0, cx);
    let first = time_or(row, 0, period.unwrap_or(1.0), cx);
    let (dt, period) = (first?, period?);
    let least = if direct {
        0.0
    } else {
        dt.min(LEAST_STATIC * period)
    };
    let dt_min = time_or(row, 2, least, cx)?;
    let dt_max = time_or(row, 3, period, cx)?;
    check_times(row, dt, period, dt_min, dt_max, cx)?;
    if direct {
        let help = "with DIRECT increments keep their size but for cutbacks";
        row.without_effect(3, "this largest increment has no effect", help, cx.d);
        note_short_end(row, dt, period, cx);
    }
    Some(Increments {
        dt: if direct { dt } else { dt.min(dt_max) },
        period,
        dt_min,
        dt_max: if direct { dt } else { dt_max },
        incrementation,
    })
}

/// A time of a data line, or `default` where the field is empty or zero.
fn time_or(row: Line, index: usize, default: f64, cx: &mut Context) -> Option<f64> {
    let time = row.real_or(index, default, cx.d)?;
    Some(if time == 0.0 { default } else { time })
}

/// The first increment of a dynamic step. If the deck does not give the first increment and increments are automatic,
/// the first increment is `guide`, the time of a wave through the shortest side of an element, within bounds relative
/// to the duration.
fn first_increment(
    row: Line,
    (direct, period): (bool, f64),
    guide: Option<f64>,
    cx: &mut Context,
) -> Option<f64> {
    let given = time_or(row, 0, 0.0, cx)?;
    if given != 0.0 {
        return Some(given);
    }
    if direct {
        let message = "give the time increment in the first field";
        let error = cx.error(Code::MissingField, row.span(), message);
        if let Some(dt) = guide {
            error.help(format!(
                "a wave crosses the shortest element side in {dt:.2e}"
            ));
        }
        return None;
    }
    let (least, largest) = (LEAST_DYNAMIC * period, LARGEST_DYNAMIC * period);
    let own = guide.unwrap_or(largest).max(least).min(largest);
    let message = format!("the first increment is {own:.2e}: none is given");
    cx.d.note(Code::OwnIncrement, row.span(), message)
        .help("write one into the first field of the data line to have another");
    Some(own)
}

fn check_times(
    row: Line,
    dt: f64,
    period: f64,
    dt_min: f64,
    dt_max: f64,
    cx: &mut Context,
) -> Option<()> {
    let (field, fault) = if period <= 0.0 {
        (1, "the duration must be positive")
    } else if dt <= 0.0 {
        (0, "the increment must be positive")
    } else if dt > period {
        (0, "the increment is longer than the step")
    } else if period / dt > MOST_INCREMENTS {
        (
            0,
            "the increment is out of all proportion to the duration: the step has more than 1e12 \
             of them",
        )
    } else if !(dt * dt).is_normal() {
        // K* holds 2/dt² M
        (
            0,
            "the square of the increment is beyond the range of numbers: use other units of time",
        )
    } else if dt_min < 0.0 || dt_min > dt {
        (
            2,
            "the smallest increment must lie between 0 and the increment",
        )
    } else if dt_max <= 0.0 {
        (3, "the largest increment must be positive")
    } else {
        return Some(());
    };
    let span = row.span_at(field);
    cx.error(Code::BadIncrement, span, fault);
    None
}

/// Notes that the duration is not a multiple of the increment.
fn note_short_end(row: Line, dt: f64, period: f64, cx: &mut Context) {
    let count = period / dt;
    if (count - count.round()).abs() > 1e-6 * count.clamp(1.0, 1e5) {
        let span = row.span_at(1);
        let message = "the duration is no multiple of the increment: the last one is shorter";
        cx.d.note(Code::ShortIncrement, span, message);
    }
}

/// A setting of `*STICKSLIP` that a word chooses: its parameter, and the meaning of each word.
pub(crate) struct Choice<T: 'static>(&'static str, [(&'static str, T); 2]);

pub(crate) const IMPACT: Choice<Impact> = Choice(
    "IMPACT",
    [("IMPULSE", Impact::Impulse), ("NONE", Impact::None)],
);
pub(crate) const IMPACT_TIME: Choice<ImpactTime> = Choice(
    "IMPACT TIME",
    [
        ("INCREMENT", ImpactTime::Increment),
        ("EVENT", ImpactTime::Event),
    ],
);
pub(crate) const LANDING: Choice<LandingRule> = Choice(
    "LANDING",
    [
        ("PLASTIC", LandingRule::Plastic),
        ("RETURN", LandingRule::Return),
    ],
);
pub(crate) const CONTACT_MASS: Choice<ContactMass> = Choice(
    "CONTACT MASS",
    [
        ("CONSISTENT", ContactMass::Consistent),
        ("REDISTRIBUTED", ContactMass::Redistributed),
    ],
);
pub(crate) const LCP: Choice<LcpMethod> = Choice(
    "LCP",
    [("HYBRID", LcpMethod::Hybrid), ("LEMKE", LcpMethod::Lemke)],
);
pub(crate) const FACTORIZATION: Choice<Factorization> = Choice(
    "FACTORIZATION",
    [
        ("KEEP", Factorization::Keep),
        ("EVERY PASS", Factorization::EveryPass),
    ],
);
pub(crate) const SOLVER: Choice<SolverChoice> = Choice(
    "SOLVER",
    [("FAER", SolverChoice::Faer), ("SPRS", SolverChoice::Sprs)],
);

impl<T: Copy + PartialEq> Choice<T> {
    /// Changes a setting to the word on a card, if the card has the parameter of the setting.
    fn set(&self, card: &Card, setting: &mut T) {
        let typed = card.choice(self.0);
        if let Some((_, chosen)) = self.1.iter().find(|(word, _)| Some(*word) == typed) {
            *setting = *chosen;
        }
    }

    /// The parameter of `*STICKSLIP` with the word that means this setting.
    pub fn written(&self, setting: T) -> String {
        let word = self.1.iter().find(|(_, known)| *known == setting);
        format!("{}={}", self.0, word.map_or("", |(word, _)| word))
    }
}

/// Changes settings as a card `*STICKSLIP` says.
pub(crate) fn apply_settings(card: &Card, settings: &mut Settings, cx: &mut Context) {
    settings.scheme = scheme(card, settings.scheme, cx);
    IMPACT.set(card, &mut settings.impact);
    IMPACT_TIME.set(card, &mut settings.impact_time);
    LANDING.set(card, &mut settings.landing);
    CONTACT_MASS.set(card, &mut settings.contact_mass);
    LCP.set(card, &mut settings.lcp);
    FACTORIZATION.set(card, &mut settings.factorization);
    SOLVER.set(card, &mut settings.solver);
    if let Some(tolerance) = tolerance(card, cx) {
        settings.tolerance = tolerance;
    }
    if let Some(passes) = max_passes(card, cx) {
        settings.max_passes = passes;
    }
    check_scheme(card, settings, cx);
}

/// Reports LANDING=RETURN and CONTACT MASS=REDISTRIBUTED without the energy-momentum scheme. Landing return needs the
/// energy-momentum scheme because the contact force there loses exactly the energy Pn g0 at a landing. Nodes without
/// mass need the scheme because end rows and impulses do not work for such nodes.
fn check_scheme(card: &Card, settings: &Settings, cx: &mut Context) {
    if settings.scheme == Scheme::EnergyMomentum {
        return;
    }
    let returns = settings.landing == LandingRule::Return;
    let redistributes = settings.contact_mass == ContactMass::Redistributed;
    let options = [
        (returns, "LANDING", "RETURN", "PLASTIC"),
        (redistributes, "CONTACT MASS", "REDISTRIBUTED", "CONSISTENT"),
    ];
    for (_, option, value, other) in options.into_iter().filter(|option| option.0) {
        let mut given = [option, "SCHEME"].into_iter().filter(|name| card.has(name));
        let span = given.next().map_or(card.span, |name| card.span_of(name));
        let message = format!("{option}={value} is not for SCHEME=SS22");
        let help = format!("leave out SCHEME=SS22, or choose {option}={other}");
        cx.error(Code::SchemeOption, span, message).help(help);
    }
}

/// Reads the scheme, whose weights must make the scheme stable: theta2 >= theta1 >= 1/2.
fn scheme(card: &Card, before: Scheme, cx: &mut Context) -> Scheme {
    let (old1, old2) = match (card.choice("SCHEME"), before) {
        (Some("SS22"), Scheme::EnergyMomentum) => (1.0, 1.0),
        (Some("SS22") | None, Scheme::Ss22 { theta1, theta2 }) => (theta1, theta2),
        _ if card.choice("SCHEME").is_some() => return Scheme::EnergyMomentum,
        _ => return before,
    };
    let theta1 = card.real("THETA1", cx.d).unwrap_or(old1);
    let theta2 = card.real("THETA2", cx.d).unwrap_or(old2);
    if theta1 < 0.5 || theta2 < theta1 {
        let message = format!(
            "SS22 is unstable with THETA1 = {} and THETA2 = {}",
            shown(theta1),
            shown(theta2)
        );
        let span = card.span_of(if theta1 < 0.5 { "THETA1" } else { "THETA2" });
        cx.error(Code::UnstableScheme, span, message)
            .help("it is stable for THETA2 >= THETA1 >= 1/2");
    }
    Scheme::Ss22 { theta1, theta2 }
}

/// Reports a step that changes CONTACT MASS: the first step decides for all steps.
pub(crate) fn check_contact_mass(
    card: &Card,
    [before, now]: [ContactMass; 2],
    step: usize,
    cx: &mut Context,
) {
    if step > 1 && now != before {
        let message = "CONTACT MASS is the same in all steps";
        cx.error(Code::BadValue, card.span_of("CONTACT MASS"), message)
            .help("give it in the first step");
    }
}

fn tolerance(card: &Card, cx: &mut Context) -> Option<f64> {
    let tolerance = card.real("TOLERANCE", cx.d)?;
    if tolerance <= 0.0 || tolerance >= 1.0 {
        let message = format!(
            "the tolerance must lie between 0 and 1, found {}",
            shown(tolerance)
        );
        cx.error(Code::BadValue, card.span_of("TOLERANCE"), message);
        return None;
    }
    Some(tolerance)
}

fn max_passes(card: &Card, cx: &mut Context) -> Option<usize> {
    let passes = card.integer("MAX PASSES", cx.d)?;
    if passes < 1 {
        let message = format!("at least one pass is needed, found {passes}");
        cx.error(Code::BadValue, card.span_of("MAX PASSES"), message);
    }
    usize::try_from(passes).ok().filter(|&passes| passes > 0)
}
