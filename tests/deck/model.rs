//! Valid decks and the model they describe.

use std::path::Path;
use stickslip::contact::contact_surfaces;
use stickslip::diagnostics::{Diagnostics, Sources};
use stickslip::model::*;
use stickslip::output::contact_names;
use stickslip::prepare::PreparedModel;
use stickslip::reader;

use crate::reading::try_read;

/// The model of a deck, which must have no errors, and the text of its warnings.
fn read(text: &str) -> (Model, String) {
    let (model, _, messages) = try_read(text);
    (model.unwrap_or_else(|| panic!("{messages}")), messages)
}

#[test]
fn shared_deck_reads_with_its_warnings() {
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let path = Path::new("tests/decks/shared.inp");
    let model = reader::read_model(path, &mut sources, &mut d);
    insta::assert_snapshot!(d.render(&sources, false));
    insta::assert_debug_snapshot!(model.expect("no errors"));
}

const SQUARE: &str = include_str!("../decks/square.inp");

/// The model of the square with `old` replaced by `new`.
fn square(old: &str, new: &str) -> (Model, String) {
    assert!(SQUARE.contains(old), "{old}");
    read(&SQUARE.replacen(old, new, 1))
}

/// The model of the square with further model cards and one more step.
fn with(model: &str, step: &str) -> Model {
    let text = SQUARE.replacen("*STEP", &format!("{model}\n*STEP"), 1);
    read(&text.replacen("*END STEP", &format!("{step}\n*END STEP"), 1)).0
}

/// The model of the square with a second step made of these cards.
fn second_step(head: &str, first: &str, second: &str) -> Model {
    let text = SQUARE.replacen("*END STEP", &format!("{first}\n*END STEP"), 1);
    read(&format!(
        "{text}{head}\n*DYNAMIC\n0.1, 1.\n{second}\n*END STEP\n"
    ))
    .0
}

#[test]
fn square_reads_without_messages() {
    let (model, messages) = read(SQUARE);
    assert_eq!(messages, "");
    assert_eq!(model.title, "one square");
    assert_eq!(model.mesh.node_labels, [1, 2, 3, 4]);
    assert_eq!(model.mesh.elements[0].label, 7);
    assert_eq!(model.mesh.elements[0].element_type, ElementType::CPS4);
    assert_eq!(model.sections[0].thickness, 0.5);
    assert_eq!(model.materials[0].law.small_strain().young, 1000.0);
    assert_eq!(model.sets.nodes[1].name, "FOOT");
    assert_eq!(model.sets.history, [history(1, true)]);
    let step = &model.steps[0];
    let dofs: Vec<usize> = step.supports.iter().map(|s| s.dof).collect();
    assert_eq!(dofs, [0, 1, 2, 3]);
    assert_eq!(step.increments.dt, 0.1);
    assert_eq!(step.frames, Frames::Default);
    let load = Load {
        at: PointLoad { dof: 5 },
        magnitude: 4.0,
        variation: Variation::Constant,
    };
    assert_eq!(step.point_loads, [load]);
}

const PAIR: &str = "*CONTACT PAIR, INTERACTION=DRY, TYPE=NODE TO SURFACE\nSBOT, STOP\n";

/// The model of the block on its base with other contacts.
fn contacts(cards: &str) -> Model {
    let deck = include_str!("../decks/shared.inp");
    assert!(deck.contains(PAIR));
    read(&deck.replacen(PAIR, cards, 1)).0
}

#[test]
fn one_surface_on_a_pair_touches_itself() {
    let model = contacts(&PAIR.replace("SBOT, STOP", "STOP"));
    let contact = &model.contacts[0];
    assert!(contact.is_self_contact());
    assert_eq!(model.surfaces[contact.master].name, "STOP");
    assert_eq!(contact_names(&model), ["STOP_STOP"]);
}

#[test]
fn general_contact_is_that_of_all_exterior_faces() {
    let general = "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n";
    let model = contacts(general);
    assert_eq!(model.contacts[0].interaction.friction.at_rest(0.0), 0.0);
    let assigned = format!("{general}*CONTACT PROPERTY ASSIGNMENT\n ,  , DRY\n");
    let model = contacts(&assigned);
    let [contact] = &model.contacts[..] else {
        panic!("{:?}", model.contacts);
    };
    assert!(contact.is_self_contact());
    assert_eq!(contact.interaction.friction.at_rest(0.0), 0.3);
    assert_eq!(contact_names(&model), [ALL_EXTERIOR]);
    let labels = |[a, b]: [usize; 2]| [a, b].map(|node| model.mesh.node_labels[node]);
    let surface = &model.surfaces[contact.slave];
    let segments: Vec<[u64; 2]> = surface
        .segments(&model.mesh)
        .into_iter()
        .map(labels)
        .collect();
    let base = [[1, 2], [2, 3], [3, 6], [6, 5], [5, 4], [4, 1]];
    let block = [[11, 12], [12, 13], [13, 14], [14, 11]];
    assert_eq!(segments, [&base[..], &block].concat());
}

#[test]
fn a_deck_that_uses_everything() {
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let model = reader::read_model(Path::new("tests/decks/steps.inp"), &mut sources, &mut d);
    insta::assert_snapshot!(d.render(&sources, false));
    insta::assert_debug_snapshot!(model.expect("no errors"));
}

#[test]
fn forces_on_a_node_add_up_in_a_step_and_are_replaced_in_the_next() {
    let model = second_step("*STEP", "*CLOAD\n3, 2, 1.", "*CLOAD\n3, 2, 7.");
    let sum = |i: usize| -> f64 { model.steps[i].point_loads.iter().map(|l| l.magnitude).sum() };
    assert_eq!((sum(0), sum(1)), (5.0, 7.0));
}

#[test]
fn loads_and_supports_are_kept_until_op_new() {
    let model = second_step("*STEP", "", "*CLOAD\n4, 1, 1.");
    assert_eq!(model.steps[1].point_loads.len(), 2);
    assert_eq!(model.steps[1].supports.len(), 4);
    let model = second_step("*STEP", "", "*CLOAD, OP=NEW\n4, 1, 1.\n*BOUNDARY, OP=NEW");
    assert_eq!(model.steps[1].point_loads.len(), 1);
    assert_eq!(model.steps[1].supports, []);
    assert_eq!(model.steps[0].supports.len(), 4);
}

#[test]
fn ramps_start_where_the_step_before_ended() {
    let model = second_step("*STEP, AMPLITUDE=RAMP", "", "*CLOAD\n3, 2, 7.\n4, 1, 1.");
    let loads = &model.steps[1].point_loads;
    let ramp = |dof, from, magnitude| Load {
        at: PointLoad { dof },
        magnitude,
        variation: Variation::Ramp { from },
    };
    assert_eq!(loads[..], [ramp(5, 4.0, 7.0), ramp(6, 0.0, 1.0)]);
    let model = second_step("*STEP, AMPLITUDE=RAMP", "", "*CLOAD, OP=NEW");
    assert_eq!(model.steps[1].point_loads, [ramp(5, 4.0, 0.0)]);
}

#[test]
fn a_load_on_step_time_stays_at_its_last_value() {
    let amplitude = "*AMPLITUDE, NAME=A\n0., 0., 4., 8.";
    let model = second_step(
        "*STEP",
        &format!("{amplitude}\n*CLOAD, AMPLITUDE=A\n4, 1, 3."),
        "",
    );
    let (first, second) = (
        &model.steps[0].point_loads[1],
        &model.steps[1].point_loads[1],
    );
    assert_eq!(first.variation, Variation::Amplitude(0));
    assert_eq!(
        (second.variation, second.magnitude),
        (Variation::Constant, 6.0)
    );
}

#[test]
fn a_gravity_that_turns_fades_out_and_in() {
    let model = second_step(
        "*STEP, AMPLITUDE=RAMP",
        "*DLOAD\nBODY, GRAV, 9.81, 0., -1.",
        "*DLOAD\nBODY, GRAV, 9.81, 1., 0.",
    );
    let loads: Vec<_> = model.steps[1]
        .body_forces
        .iter()
        .map(|l| (l.at.direction, l.magnitude, l.variation))
        .collect();
    let ramp = |from| Variation::Ramp { from };
    assert_eq!(
        loads,
        [
            ([0.0, -1.0], 0.0, ramp(9.81)),
            ([1.0, 0.0], 9.81, ramp(0.0))
        ]
    );
}

#[test]
fn prescribed_displacements_ramp_or_follow_an_amplitude() {
    let model = with(
        "*AMPLITUDE, NAME=A\n0., 0., 1., 1.",
        "*BOUNDARY\n3, 1, 1, 0.2\n*BOUNDARY, AMPLITUDE=A\n3, 2, 2, 0.3",
    );
    let motions: Vec<_> = model.steps[0]
        .supports
        .iter()
        .filter(|s| s.dof > 3)
        .map(|s| s.motion)
        .collect();
    let follow = SupportMotion::Amplitude {
        value: 0.3,
        amplitude: 0,
    };
    assert_eq!(motions, [SupportMotion::Ramp { to: 0.2 }, follow]);
}

#[test]
fn prescribed_velocities_go_on_from_step_to_step() {
    let motions = |first: &str, second: &str| {
        let model = second_step("*STEP", first, second);
        let ends: Vec<_> = model.steps.iter().flat_map(|s| s.supports.last()).collect();
        ends.iter().map(|s| (s.dof, s.motion)).collect::<Vec<_>>()
    };
    let at = |rate, value, amplitude| {
        let motion = SupportMotion::Rate {
            rate,
            value,
            amplitude,
        };
        (7, motion)
    };
    let constant = |value| at(Rate::Velocity, value, None);
    let velocity = "*BOUNDARY, TYPE=VELOCITY\n4, 2, 2, 0.25";
    assert_eq!(motions(velocity, ""), [constant(0.25), constant(0.25)]);
    let back = "*BOUNDARY, OP=NEW, TYPE=VELOCITY\n4, 2, 2, -0.5";
    assert_eq!(motions(velocity, back), [constant(0.25), constant(-0.5)]);
    let curve = |time: &str| format!("*AMPLITUDE, NAME=A{time}\n0., 0., 4., 8.\n");
    let pushed = "*BOUNDARY, TYPE=ACCELERATION, AMPLITUDE=A\n4, 2, 2, 3.";
    let acceleration = |value, amplitude| at(Rate::Acceleration, value, amplitude);
    // the first step lasts 1: the acceleration at its end goes on
    let follow = motions(&(curve("") + pushed), "");
    assert_eq!(
        follow,
        [acceleration(3.0, Some(0)), acceleration(6.0, None)]
    );
    let follow = motions(&(curve(", TIME=TOTAL TIME") + pushed), "");
    assert_eq!(follow, [acceleration(3.0, Some(0)); 2]);
    let kept = motions(velocity, "*BOUNDARY, FIXED\n4, 2, 2");
    assert_eq!(kept, [constant(0.25), constant(0.0)]);
}

#[test]
fn friction_may_decay_with_the_slip_rate() {
    let deck = include_str!("../decks/shared.inp");
    let start = deck.find("*FRICTION").expect("friction");
    let end = start + deck[start..].find("*CONTACT PAIR").expect("a pair");
    let decay = "*FRICTION, EXPONENTIAL DECAY\n0.3, 0.2, 1.D-3\n";
    let (model, messages) = read(&deck.replacen(&deck[start..end], decay, 1));
    let friction = Friction::from(FrictionLaw::Decay {
        at_rest: 0.3,
        sliding: 0.2,
        decay: 1e-3,
    });
    assert_eq!(model.contacts[0].interaction.friction, friction);
    assert!(!messages.contains("FRICTION"), "{messages}");
    let at = |rate| friction.at(rate, 0.0);
    assert_eq!([0.0, 1e6].map(at), [0.3, 0.2]);
    assert_eq!(at(-1e3), 0.2 + (0.3 - 0.2) * (-1_f64).exp());
}

#[test]
fn friction_may_follow_a_table_and_have_a_limit() {
    let deck = include_str!("../decks/friction.inp");
    let (model, messages) = read(deck);
    assert!(!messages.contains("FRICTION"), "{messages}");
    let curve = |pressure, points: [[f64; 2]; 2]| FrictionCurve {
        pressure,
        points: points.to_vec(),
    };
    let curves = vec![
        curve(5.0, [[0.0, 0.4], [1.0, 0.2]]),
        curve(20.0, [[0.0, 0.3], [1.0, 0.1]]),
    ];
    let [table, rough] = [0, 1].map(|i| model.contacts[i].interaction.friction.clone());
    assert_eq!(
        (table.law, table.shear_limit),
        (FrictionLaw::Table(curves), 4.0)
    );
    assert_eq!(
        (rough.law, rough.shear_limit),
        (FrictionLaw::Rough, f64::INFINITY)
    );
    let wear = [0, 1].map(|i| model.contacts[i].interaction.wear);
    let expected = [(1e-4 / 2e3, false), (5e-8, true)];
    let expected = expected.map(|(rate, by_friction)| Some(Wear { rate, by_friction }));
    assert_eq!(wear, expected);
    let heat = [0, 1].map(|i| model.contacts[i].interaction.heat);
    let (part, to_slave) = (0.9, 0.5);
    assert_eq!(heat, [Some(Heat { part, to_slave }), None]);
    let without = deck.replacen("TAUMAX=4.", "TAUMAX=0", 1);
    assert!(
        !read(&without).0.contacts[0]
            .interaction
            .friction
            .has_limit()
    );
    let one = deck.replacen("0.4, 0., 5.\n0.2, 1., 5.\n0.3, 0., 20.\n", "", 1);
    let (model, messages) = read(&one);
    assert_eq!(model.contacts[0].interaction.friction.at_rest(0.0), 0.1);
    assert!(
        messages.contains("only the coefficient of friction"),
        "{messages}"
    );
}

#[test]
fn contacts_change_from_step_to_step() {
    let (model, messages) = read(include_str!("../decks/friction.inp"));
    assert_eq!(messages, "");
    let own = [0, 1].map(|i| model.contacts[i].interaction.friction.clone());
    let of_step = |number: usize| {
        let changes = &model.steps[number - 1].contacts;
        let friction = (changes.friction.iter())
            .map(|change| {
                let from = change.from.clone();
                let from = from.map(|from| (from.friction, from.amplitude));
                (change.contact, change.friction.clone(), from)
            })
            .collect::<Vec<_>>();
        (friction, changes.removed.clone())
    };
    assert_eq!([1, 2].map(of_step), [(vec![], vec![]), (vec![], vec![])]);
    let falling = FrictionLaw::Decay {
        at_rest: 0.5,
        sliding: 0.3,
        decay: 2.0,
    };
    // what never slips ramps to nothing
    let slippery = Friction::constant(0.1);
    let ramped = (0, slippery.clone(), Some((own[0].clone(), None)));
    assert_eq!(
        of_step(3),
        (vec![ramped, (1, falling.into(), None)], vec![])
    );
    assert_eq!(of_step(4), (vec![(0, slippery, None)], vec![0]));
    assert_eq!(model.friction_range(0), [0.4, 0.0]);
}

#[test]
fn elements_move_rigidly_with_a_reference_node() {
    let step = "*BOUNDARY\n90, 1\n90, 6\n*BOUNDARY, TYPE=VELOCITY\n90, 2, 2, 0.5";
    let card = "*NODE\n90, 5., 5.\n*RIGID BODY, ELSET=BODY, REF NODE=90";
    let text = SQUARE.replacen("*BOUNDARY\nFOOT, 1, 2\n", "", 1);
    assert_ne!(text, SQUARE);
    let text = text.replacen("*STEP", &format!("{card}\n*STEP"), 1);
    let (model, _) = read(&text.replacen("*END STEP", &format!("{step}\n*END STEP"), 1));
    let motion = |dof: usize| {
        let supports = &model.steps[0].supports;
        supports.iter().find(|s| s.dof == dof).map(|s| s.motion)
    };
    let up = SupportMotion::Rate {
        rate: Rate::Velocity,
        value: 0.5,
        amplitude: None,
    };
    // of the reference node and of the angle: the body moves its nodes
    assert_eq!(model.steps[0].supports.len(), 3);
    assert_eq!(
        [8, 9].map(motion),
        [Some(SupportMotion::Ramp { to: 0.0 }), Some(up)]
    );
    let [body] = &model.rigid_bodies[..] else {
        panic!("one rigid body");
    };
    assert_eq!((body.reference, body.turns), (4, false));
}

#[test]
fn named_supports_fix_their_directions() {
    for (name, dofs) in [
        ("XSYMM", vec![6]),
        ("YSYMM", vec![7]),
        ("ZSYMM", vec![]),
        ("XASYMM", vec![7]),
        ("YASYMM", vec![6]),
        ("ZASYMM", vec![6, 7]),
        ("PINNED", vec![6, 7]),
        ("ENCASTRE", vec![6, 7]),
    ] {
        let model = with(&format!("*BOUNDARY\n4, {name}"), "");
        let found: Vec<usize> = model.steps[0]
            .supports
            .iter()
            .map(|s| s.dof)
            .filter(|&d| d > 3)
            .collect();
        assert_eq!(found, dofs, "{name}");
    }
    let model = with("*BOUNDARY\n4, 1, 6", "");
    assert_eq!(model.steps[0].supports.len(), 6);
}

#[test]
fn increments_follow_their_error_unless_direct() {
    let times = |row: &str, direct: bool| {
        let head = if direct {
            "*DYNAMIC, DIRECT\n"
        } else {
            "*DYNAMIC\n"
        };
        let model = square("*DYNAMIC, DIRECT\n0.1, 1.", &format!("{head}{row}")).0;
        let i = model.steps[0].increments;
        (i.dt, i.dt_min, i.dt_max, i.incrementation)
    };
    let by_error = |tolerance| Incrementation::Error { tolerance };
    let fixed = Incrementation::Fixed;
    assert_eq!(
        times("0.1, 1., 1e-3, 0.05", false),
        (0.05, 1e-3, 0.05, by_error(1e-4))
    );
    assert_eq!(times("0.05, 1.", false), (0.05, 1e-5, 0.1, by_error(1e-4)));
    assert_eq!(
        times("0.001, 1.", false),
        (0.001, 0.001 / 1024.0, 0.1, by_error(1e-4))
    );
    assert_eq!(times("0.1, 1., , 0.05", true), (0.1, 0.0, 0.1, fixed));
    for application in ["", ", APPLICATION=TRANSIENT FIDELITY"] {
        let head = format!("*DYNAMIC, HALFINC SCALE FACTOR=500.{application}");
        let model = square("*DYNAMIC, DIRECT", &head).0;
        let found = model.steps[0].increments.incrementation;
        assert_eq!(found, by_error(500.0 * (1e-4 / 1e3)), "{application}");
    }
}

#[test]
fn settings_are_read_and_kept() {
    let card = "*STICKSLIP, SCHEME=SS22, THETA1=0.5, THETA2=0.6, IMPACT=NONE, IMPACT TIME=EVENT, \
                LCP=LEMKE, FACTORIZATION=EVERY PASS, SOLVER=SPRS, TOLERANCE=1e-9, MAX PASSES=9";
    let next = "*STICKSLIP, SCHEME=energy-momentum, LANDING=RETURN";
    let model = second_step("*STEP", card, next);
    let settings = Settings {
        scheme: Scheme::Ss22 {
            theta1: 0.5,
            theta2: 0.6,
        },
        impact: Impact::None,
        impact_time: ImpactTime::Event,
        landing: LandingRule::Plastic,
        contact_mass: ContactMass::Consistent,
        lcp: LcpMethod::Lemke,
        factorization: Factorization::EveryPass,
        solver: SolverChoice::Sprs,
        tolerance: 1e-9,
        max_passes: 9,
        is_check_only: false,
    };
    assert_eq!(model.steps[0].settings, settings);
    let second = Settings {
        scheme: Scheme::EnergyMomentum,
        landing: LandingRule::Return,
        ..settings
    };
    assert_eq!(model.steps[1].settings, second);
    assert_eq!(read(SQUARE).0.steps[0].settings, Settings::default());
}

#[test]
fn weights_default_to_the_published_scheme() {
    let model = with("", "*STICKSLIP, SCHEME=SS22");
    let scheme = Scheme::Ss22 {
        theta1: 1.0,
        theta2: 1.0,
    };
    assert_eq!(model.steps[0].settings.scheme, scheme);
}

#[test]
fn frames_as_each_request_says() {
    for (card, frames) in [
        ("*OUTPUT, FIELD, NUMBER INTERVAL=7", Frames::Count(7)),
        ("*OUTPUT, FIELD, TIME INTERVAL=0.25", Frames::Every(0.25)),
        (
            "*OUTPUT, FIELD, FREQUENCY=3\n*NODE OUTPUT\nU",
            Frames::Increments(3),
        ),
        ("*OUTPUT, FIELD, FREQUENCY=0", Frames::Count(1)),
        ("*OUTPUT, FIELD", Frames::Default),
        ("*OUTPUT, HISTORY, FREQUENCY=3", Frames::Default),
        (
            "*NODE FILE, FREQUENCY=2\nU\n*EL FILE, FREQUENCY=4\nS",
            Frames::Increments(4),
        ),
        ("*CONTACT FILE, FREQUENCY=5\nCDIS", Frames::Increments(5)),
        ("*NODE FILE\nU", Frames::Default),
        (
            "*OUTPUT, FIELD, TIME POINTS=P",
            Frames::Times(vec![0.5, 1.0]),
        ),
    ] {
        let model = with("*TIME POINTS, NAME=P\n0.5, 0., 3.\n1.", card);
        assert_eq!(model.steps[0].frames, frames, "{card}");
    }
}

#[test]
fn history_sets_of_both_families() {
    let model = with(
        "",
        "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU\n*NODE PRINT, NSET=ALL\nV",
    );
    assert_eq!(model.sets.history, [history(1, true), history(0, true)]);
}

#[test]
fn damping_outside_materials_is_that_of_all_that_have_none() {
    let card = "*DAMPING, ALPHA=0.5, BETA=1.E-4\n";
    let betas = |text: &str| {
        let (model, messages) = read(text);
        assert_eq!(messages, "");
        let materials = model.materials.iter();
        materials
            .map(|material| material.damping.beta)
            .collect::<Vec<_>>()
    };
    let first = SQUARE.replacen("*NODE,", &format!("{card}*NODE,"), 1);
    assert_eq!(betas(&first), [1e-4]);
    let last = SQUARE.replacen("*STEP", &format!("{card}*STEP"), 1);
    let own = last.replacen("*DENSITY", "*DAMPING, BETA=2.E-4\n*DENSITY", 1);
    let own = own.replacen(
        "*BOUNDARY",
        "*MATERIAL, NAME=OTHER\n*DENSITY\n1.\n*BOUNDARY",
        1,
    );
    assert_eq!((betas(&last), betas(&own)), (vec![1e-4], vec![2e-4, 1e-4]));
}

#[test]
fn monitored_displacements_are_columns_of_the_status_file() {
    let cards = |text: &str| {
        let (model, messages) = square("*END STEP", &format!("{text}*END STEP"));
        (model.sets.monitored, messages)
    };
    let (dofs, messages) =
        cards("*MONITOR, NODE=4, DOF=2\n*MONITOR, NODE=1, DOF=1\n*MONITOR, NODE=4, DOF=2\n");
    assert_eq!((dofs, messages.as_str()), (vec![7, 0], ""));
    let (dofs, messages) = cards("*MONITOR, NODE=4, DOF=6\n");
    assert!(
        dofs.is_empty() && messages.contains("warning[D515]"),
        "{messages}"
    );
}

fn history(set: usize, each_member: bool) -> HistorySet {
    HistorySet {
        set,
        each_member,
        at_points: false,
        at_nodes: false,
    }
}

#[test]
fn totals_only_leaves_out_the_nodes_unless_another_card_wants_them() {
    let asked = |text| with("", text).sets.history;
    let only = "*NODE PRINT, NSET=ALL, TOTALS=ONLY\nRF";
    assert_eq!(asked(only), [history(1, true), history(0, false)]);
    let yes = "*NODE PRINT, NSET=ALL, TOTALS=YES\nRF";
    assert_eq!(asked(yes), [history(1, true), history(0, true)]);
    let both = format!("{only}\n*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=ALL\nU");
    assert_eq!(asked(&both), [history(1, true), history(0, true)]);
}

#[test]
fn fields_at_nodes_are_those_named_with_the_position() {
    let asked = |text| with("", text).sets.fields;
    assert!(asked("*EL FILE\nS, LE").at_nodes.is_empty());
    let fields =
        asked("*OUTPUT, FIELD\n*ELEMENT OUTPUT, POSITION=AVERAGED AT NODES\nS11, LE, PEEQ, ELSE");
    let named = [
        NodalVariable::Stress,
        NodalVariable::LogarithmicStrain,
        NodalVariable::PlasticStrain,
    ];
    assert!(fields.at_nodes.iter().eq(&named) && fields.logarithmic_strain);
}

#[test]
fn element_histories_of_sets() {
    let asked = |text| with("", text).sets.element_history;
    assert_eq!(asked("*OUTPUT, FIELD\n*ELEMENT OUTPUT, ELSET=BODY\nS"), []);
    assert_eq!(
        asked("*OUTPUT, HISTORY\n*ELEMENT OUTPUT, ELSET=BODY\nS"),
        [history(0, true)]
    );
    assert_eq!(
        asked("*EL PRINT, ELSET=BODY, TOTALS=ONLY\nELSE"),
        [history(0, false)]
    );
    let points = HistorySet {
        at_points: true,
        ..history(0, true)
    };
    assert_eq!(
        asked("*EL PRINT, ELSET=BODY, POSITION=INTEGRATION POINTS\nS"),
        [points]
    );
    assert_eq!(
        asked(
            "*EL PRINT, ELSET=BODY, POSITION=INTEGRATION POINTS\nS\n*EL PRINT, ELSET=BODY, POSITION=NODES\nS"
        ),
        [HistorySet {
            at_nodes: true,
            ..points
        }]
    );
    assert_eq!(asked("*EL PRINT, ELSET=BODY, FREQUENCY=0\n"), []);
    assert_eq!(asked("*EL PRINT, FREQUENCY=0\n"), []);
}

#[test]
fn element_histories_where_sets_of_line_elements_come_first() {
    let lines = "*ELEMENT, TYPE=T3D2, ELSET=EDGE\n50, 1, 2\n*ELSET, ELSET=LAST\n7\n";
    let asked = "*EL PRINT, ELSET=LAST\nS\n*EL PRINT, ELSET=EDGE\nS";
    let sets = with(lines, asked).sets;
    let [HistorySet { set, .. }] = sets.element_history[..] else {
        panic!("{:?}", sets.element_history)
    };
    assert_eq!(sets.elements[set].name, "LAST");
}

#[test]
fn tractions_have_unit_directions() {
    let model = with(
        "",
        "*DSLOAD, FOLLOWER=NO\nTOP, TRVEC, 10., 3., -4.\n*DSLOAD\nTOP, P, 2.",
    );
    let traction = &model.steps[0].tractions[0];
    assert_eq!(
        (traction.magnitude, traction.at.direction),
        (10.0, [0.6, -0.8])
    );
    assert_eq!(
        traction.at.face,
        Face {
            element: 0,
            side: 2
        }
    );
    assert_eq!(model.steps[0].pressures[0].magnitude, 2.0);
}

#[test]
fn loads_without_a_set_act_on_all_elements() {
    let model = with(
        "",
        "*DLOAD\n, GRAV, 981., 0., -1., 0.\n, BY, -2500.\n7, P4, 3.",
    );
    let forces = &model.steps[0].body_forces;
    let what: Vec<_> = forces
        .iter()
        .map(|l| (l.at.per_mass, l.at.direction, l.magnitude))
        .collect();
    assert_eq!(
        what,
        [(true, [0.0, -1.0], 981.0), (false, [0.0, 1.0], -2500.0)]
    );
    assert_eq!(model.steps[0].pressures[0].at.face.side, 3);
}

#[test]
fn amplitudes_are_scaled_and_shifted() {
    let model = with(
        "*AMPLITUDE, NAME=A, SCALEX=2., SHIFTX=1., SCALEY=3., SHIFTY=-1., VALUE=ABSOLUTE\n0., 0., 1., 1.",
        "",
    );
    let points = vec![(1.0, -1.0), (3.0, 2.0)];
    assert_eq!(model.amplitudes[0].curve, Curve::Linear(points));
}

/// The curve of an amplitude with this definition and these rows.
fn curve(definition: &str) -> Curve {
    let card = format!("*AMPLITUDE, NAME=A, DEFINITION={definition}");
    with(&card, "").amplitudes[0].curve.clone()
}

fn signal(start: f64, base: f64, signal: Signal) -> Curve {
    Curve::Signal {
        start,
        base,
        signal,
    }
}

#[test]
fn amplitudes_of_every_definition() {
    let points = vec![(0.0, 0.0), (2.0, 3.0)];
    assert_eq!(
        curve("SMOOTH STEP\n0., 0., 2., 3."),
        Curve::SmoothStep(points)
    );
    let points = vec![(0.5, 0.0), (0.75, 1.0), (1.0, 0.0), (1.25, 4.0)];
    assert_eq!(
        curve("EQUALLY SPACED, FIXED INTERVAL=0.25, BEGIN=0.5\n0., 1.,, 4."),
        Curve::Linear(points)
    );
    let wanted = Signal::Decay {
        size: 2.0,
        time: 0.5,
    };
    assert_eq!(curve("DECAY\n1., 2., 0.25, 0.5"), signal(0.25, 1.0, wanted));
    let wanted = Signal::Modulated {
        size: 2.0,
        frequencies: [3.0, 4.0],
    };
    assert_eq!(
        curve("MODULATED\n1., 2., , 3., 4."),
        signal(0.0, 1.0, wanted)
    );
    let wanted = Signal::Periodic {
        frequency: 3.0,
        harmonics: vec![(0.0, 1.0), (2.0, 0.0)],
    };
    assert_eq!(
        curve("PERIODIC\n2, 3., 0.25, 1.\n0., 1., 2."),
        signal(0.25, 1.0, wanted)
    );
}

#[test]
fn signals_are_scaled_and_shifted() {
    let wanted = Signal::Periodic {
        frequency: 1.5,
        harmonics: vec![(15.0, 20.0)],
    };
    assert_eq!(
        curve("PERIODIC, SCALEX=2., SHIFTX=1., SCALEY=5., SHIFTY=-1.\n1, 3., 0.25, 1.\n3., 4."),
        signal(1.5, 4.0, wanted)
    );
}

#[test]
fn unused_nodes_are_left_out() {
    let (model, messages) = square("4, 0., 1.", "4, 0., 1.\n3000, 5., 5.");
    assert!(messages.contains("D310"), "{messages}");
    assert_eq!(model.mesh.node_count(), 4);
    assert_eq!(model.sets.nodes[0].members, [0, 1, 2, 3]);
}

#[test]
fn sets_in_sets_in_any_order() {
    let model = with(
        "*NSET, NSET=OUTER\nINNER, 4\n*NSET, NSET=INNER\n1\n*NSET, NSET=INNER\n2\n*NSET, NSET=WHOLE, ELSET=BODY",
        "",
    );
    let members = |name: &str| {
        let found = model.sets.nodes.iter().find(|set| set.name == name);
        found.map(|set| set.members.clone()).unwrap_or_default()
    };
    assert_eq!(members("OUTER"), [0, 1, 3]);
    assert_eq!(members("INNER"), [0, 1]);
    assert_eq!(members("WHOLE"), [0, 1, 2, 3]);
}

#[test]
fn a_surface_without_faces_takes_the_free_sides() {
    let model = with("*SURFACE, NAME=SKIN\nBODY", "");
    let SurfaceKind::Faces(faces) = &model.surfaces[1].kind else {
        panic!("no faces")
    };
    assert_eq!(faces.len(), 4);
}

#[test]
fn a_mesh_in_a_subfolder() {
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let model = reader::read_model(Path::new("tests/decks/folder.inp"), &mut sources, &mut d);
    assert_eq!(d.render(&sources, false), "");
    assert_eq!(model.expect("no errors").mesh.elements[0].label, 7);
    let names: Vec<&str> = sources.files().iter().map(|file| file.name()).collect();
    let parts = ["mesh.inp", "nodes.txt", "elements.txt"].map(|n| format!("tests/decks/parts/{n}"));
    assert_eq!(names[0], "tests/decks/folder.inp");
    assert_eq!(names[1..], parts);
    assert_eq!(sources.line_count(), 15 + 3 + 4 + 2);
    assert!(
        sources
            .full_text()
            .contains("** ---- file tests/decks/parts/nodes.txt ----\n1, 0., 0.\n")
    );
}

#[test]
fn a_deck_as_a_preprocessor_writes_it() {
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let model = reader::read_model(Path::new("tests/decks/exported.inp"), &mut sources, &mut d);
    insta::assert_snapshot!(d.render(&sources, false));
    let model = model.expect("no errors");
    assert_eq!(model.contacts.len(), 1);
    assert_eq!(model.steps[0].increments.dt, 1e-3);
}

/// Heights of the nodes 11 and 12 of the block, which are 0.1 above and 0.05 inside its base, after
/// they are adjusted.
fn adjusted(adjust: &str) -> ([f64; 2], usize) {
    adjusted_by(&PAIR.replace("TYPE", &format!("ADJUST={adjust}, TYPE")))
}

/// The same with any cards of contact.
fn adjusted_by(contact: &str) -> ([f64; 2], usize) {
    let deck = include_str!("../decks/shared.inp")
        .replacen("12, 3., 1.1", "12, 3., 0.95", 1)
        .replacen(PAIR, contact, 1);
    let prepared = PreparedModel::new(read(&deck).0);
    let (model, moved) = (&prepared.model, &prepared.adjusted);
    let height = |label: u64| {
        let found = model.mesh.node_labels.iter().position(|&l| l == label);
        model.mesh.coordinates[found.expect("node")][1]
    };
    assert_eq!(moved.iter().filter_map(|m| m.spoiled).count(), 0);
    (
        [height(11), height(12)],
        moved.iter().map(|m| m.count).sum(),
    )
}

#[test]
fn adjusted_nodes_are_moved_onto_the_master() {
    assert_eq!(adjusted("0.2"), ([1.0, 1.0], 2));
    assert_eq!(adjusted("0.0"), ([1.1, 1.0], 1));
    assert_eq!(adjusted("NBLOCK"), ([1.0, 1.0], 2));
    assert_eq!(adjusted("NFIX"), ([1.1, 0.95], 0));
}

#[test]
fn slave_nodes_get_the_clearance_of_their_pair() {
    let adjusted = |value: &str| {
        let card = format!("*CLEARANCE, SLAVE=SBOT, MASTER=STOP, VALUE={value}\n");
        adjusted_by(&format!("{PAIR}{card}"))
    };
    assert_eq!(adjusted("0.125"), ([1.125, 1.125], 2));
    assert_eq!(adjusted("0."), ([1.0, 1.0], 2));
}

#[test]
fn nodes_of_general_contact_are_moved_onto_the_surfaces() {
    let adjusted = |parameters: &str| {
        adjusted_by(&format!(
            "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n\
             *CONTACT INITIALIZATION DATA, NAME=FIT{parameters}\n\
             *CONTACT INITIALIZATION ASSIGNMENT\n, ALL EXTERIOR, FIT\n"
        ))
    };
    assert_eq!(adjusted(""), ([1.1, 1.0], 1));
    assert_eq!(adjusted(", ADJUST=YES, SEARCH ABOVE=0.2"), ([1.0, 1.0], 2));
    assert_eq!(adjusted(", SEARCH BELOW=0.01"), ([1.1, 0.95], 0));
    assert_eq!(adjusted(", INITIAL CLEARANCE=0.125"), ([1.1, 1.125], 1));
}

/// The model of the block above a rigid floor with these rows, moved as the step says.
fn on_floor(rows: &str, step: &str) -> Model {
    on_floor_with(rows, step, "")
}

/// The same with further model cards.
fn on_floor_with(rows: &str, step: &str, more: &str) -> Model {
    let cards = format!(
        "*NODE\n100, 0., -5.\n*NSET, NSET=REF\n100\n*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\n{rows}\
         *RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=REF\n{}{more}*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n",
        PAIR.replace("STOP", "FLOOR")
    );
    let deck = include_str!("../decks/shared.inp").replacen(PAIR, &cards, 1);
    read(&deck.replacen("*DLOAD", &format!("{step}*DLOAD"), 1)).0
}

#[test]
fn a_rigid_surface_moves_with_its_reference_node() {
    let model = on_floor(
        "START, 0., 1.\nLINE, 4., 1.\nLINE, 4., 0.\n",
        "*BOUNDARY, AMPLITUDE=A\n100, 2, 2, 0.5\n*BOUNDARY\nREF, 1\n100, 6\n",
    );
    let nodes = model.mesh.node_count();
    assert_eq!(model.mesh.node_labels[nodes - 4..], [100, 101, 102, 103]);
    assert_eq!(
        model.mesh.coordinates[nodes - 3..],
        [[0.0, 1.0], [4.0, 1.0], [4.0, 0.0]]
    );
    let [a, b, c] = [nodes - 3, nodes - 2, nodes - 1];
    let surface = &model.surfaces[model.contacts[0].master];
    let SurfaceKind::Rigid(profile) = &surface.kind else {
        panic!("{:?}", surface.kind);
    };
    assert_eq!(profile.segments, [[c, b], [b, a]]);
    assert_eq!((profile.arcs.len(), profile.centre), (0, None));
    let supports = &model.steps[0].supports;
    assert!(supports.windows(2).all(|pair| pair[0].dof < pair[1].dof));
    let motion = |dof| supports.iter().find(|s| s.dof == dof).map(|s| s.motion);
    assert_eq!(
        motion(2 * (nodes - 4)),
        Some(SupportMotion::Ramp { to: 0.0 })
    );
    let moved = SupportMotion::Amplitude {
        value: 0.5,
        amplitude: 0,
    };
    assert_eq!(motion(2 * (nodes - 4) + 1), Some(moved));
    // the body moves its nodes
    assert!(supports.iter().all(|s| ![a, b, c].contains(&(s.dof / 2))));
    assert_eq!(model.initial_velocity.len(), model.dof_count());
    let body = RigidBody {
        number: 0,
        name: "FLOOR".into(),
        parts: vec![RigidPart::Surface(model.contacts[0].master)],
        reference: nodes - 4,
        nodes: vec![a, b, c],
        elements: vec![],
        is_coupling: false,
        masses: vec![],
        rotary_inertia: 0.0,
        turns: false,
    };
    assert_eq!(model.rigid_bodies, [body]);
}

#[test]
fn rigid_surfaces_take_part_in_general_contact() {
    let rows = "START, 0., 1.\nLINE, 4., 1.\n";
    let general = "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n\
                   *CONTACT PROPERTY ASSIGNMENT\n, , DRY\n";
    let support = "*BOUNDARY\nREF, 1, 2\n";
    let with_pair = on_floor_with(rows, support, general);
    let names = contact_names(&with_pair);
    assert_eq!(names, ["SBOT_FLOOR", ALL_EXTERIOR, "ALL_EXTERIOR_FLOOR"]);
    // the pair's nodes are held by the pair
    let labels = |nodes: &[usize]| -> Vec<u64> {
        nodes
            .iter()
            .map(|&n| with_pair.mesh.node_labels[n])
            .collect()
    };
    let contact = &with_pair.contacts[2];
    assert_eq!(labels(&contact.left_out), [11, 12]);
    assert!(with_pair.contacts[1].left_out.is_empty());
    assert_eq!(contact.interaction.friction.at_rest(0.0), 0.3);
    let slaves = &contact_surfaces(&with_pair, &with_pair.mesh.bodies())[2].slaves;
    assert_eq!(labels(slaves), [1, 2, 3, 6, 5, 4, 13, 14]);
}

#[test]
fn an_arc_is_cut_into_chords_of_one_degree() {
    let fixed = "*BOUNDARY\n100, 1, 2\n";
    let rows = "START, -1., 0.\nCIRCL, 0., 1., 0., 0.\nCIRCL, 1., 0., 0., 0.\nLINE, -1., 0.\n";
    let model = on_floor(rows, fixed);
    let surface = &model.surfaces[model.contacts[0].master];
    let segments = surface.segments(&model.mesh);
    assert_eq!(
        (segments.len(), surface.nodes(&model.mesh).len()),
        (181, 181)
    );
    let x = &model.mesh.coordinates;
    assert!(segments.iter().skip(1).all(|&[a, b]| {
        let middle = [0, 1].map(|i| (x[a][i] + x[b][i]) / 2.0);
        let radius = middle[0].hypot(middle[1]);
        (1.0 - 3.9e-5..1.0 - 3.7e-5).contains(&radius)
    }));
}

/// Equations of the square with these cards.
fn equations(cards: &str) -> Vec<Equation> {
    with(cards, "").equations
}

#[test]
fn equations_are_solved_for_their_first_terms() {
    // 2 u + 1 v - 0.5 w = 0, on two lines; a node set and one node
    let cards = "*NSET, NSET=UP\n4, 3\n*NSET, NSET=DOWN\n2, 1\n*EQUATION\n2\nUP, 1, 1., DOWN, 2, -1.\n\
                 5\n3, 2, 2., 1, 1, 1., 2, 1, -0.5, 2, 1, -0.5\n1, 2, 0.\n";
    let equation = |dof, terms: &[(usize, f64)]| Equation {
        dof,
        terms: terms.to_vec(),
    };
    // sets in the order of the node numbers: 3 with 1, 4 with 2
    let expected = [
        equation(4, &[(1, 1.0)]),
        equation(5, &[(0, -0.5), (2, 0.5)]),
        equation(6, &[(3, 1.0)]),
    ];
    assert_eq!(equations(cards), expected);
}

#[test]
fn equations_between_eliminated_displacements_are_substituted() {
    // u4 = 2 u3, u3 = 3 v3 - u1, given in this order
    let cards = "*EQUATION\n2\n4, 1, 1., 3, 1, -2.\n3\n3, 1, 1., 3, 2, -3., 1, 1, 1.\n";
    let found = equations(cards);
    assert_eq!(found[0].terms, [(0, -1.0), (5, 3.0)]);
    assert_eq!(found[1].terms, [(0, -2.0), (5, 6.0)]);
}

#[test]
fn a_node_of_equations_needs_no_element() {
    let cards = "*NODE\n50, 0., 9.\n60, 0., 8.\n*NSET, NSET=UP\n3, 4\n*EQUATION\n2\nUP, 2, 1., 50, 2, -1.\n";
    let model = with(cards, "");
    assert_eq!(model.mesh.node_labels, [1, 2, 3, 4, 50], "60 is left out");
    let terms: Vec<_> = model
        .equations
        .iter()
        .map(|e| (e.dof, e.terms[0].0))
        .collect();
    assert_eq!(terms, [(5, 9), (7, 9)]);
}

#[test]
fn equations_that_cannot_be_used_are_told() {
    let sets = "*NSET, NSET=ONE\n3\n*NSET, NSET=TWO\n3, 4\n*NSET, NSET=MIXED, UNSORTED\n4, 3\n\
                *NSET, NSET=BOTH\n1, 2\n*EQUATION\n";
    let faults = [
        (
            "2\n4, 1, 0., 3, 1, 1.",
            "D517",
            "the first coefficient is zero",
        ),
        ("2\n4, 3, 1., 3, 1, 1.", "D501", "only directions 1 and 2"),
        ("2\n4, 7, 1., 3, 1, 1.", "D501", "no degree of freedom 7"),
        ("2\n9, 1, 1., 3, 1, 1.", "D304", "node 9 is not defined"),
        ("1\n4, 1, 1.", "D517", "two terms at least, found 1"),
        ("2\n4, 1, 1.", "D112", "an equation of 2 terms ends after 1"),
        ("2\n4, 1, 1., 3, 1, 1., 3, 2, 1.", "D110", "only 6 fields"),
        (
            "2\n1, 1, 1., 3, 1, 1.",
            "D517",
            "direction 1 of node 1 is eliminated by an equation and prescribed",
        ),
        (
            "2\n4, 1, 1., 3, 1, 1.\n2\n4, 1, 1., 2, 1, 1.",
            "D517",
            "direction 1 of node 4 follows other nodes twice",
        ),
        (
            "2\n4, 1, 1., 4, 1, 1.",
            "D517",
            "direction 1 of node 4 stands in it again",
        ),
        (
            "2\n4, 1, 1., 3, 1, 1.\n2\n3, 1, 1., 4, 1, 1.",
            "D517",
            "in a circle",
        ),
        (
            "2\nTWO, 1, 1., ALL, 2, 1.",
            "D517",
            "the set has 4 nodes, that of the first term 2",
        ),
        (
            "2\nONE, 1, 1., BOTH, 2, 1.",
            "D517",
            "the set has 2 nodes, that of the first term 1",
        ),
        ("2\nMIXED, 1, 1., BOTH, 2, 1.", "D517", "MIXED is UNSORTED"),
    ];
    for (rows, code, message) in faults {
        let text = SQUARE.replacen("*STEP", &format!("{sets}{rows}\n*STEP"), 1);
        let (model, _, found) = try_read(&text);
        assert!(model.is_none(), "{rows}");
        let is_told = found.contains(message) && found.contains(&format!("error[{code}]"));
        assert!(is_told, "{rows}\n{found}");
    }
}

#[test]
fn a_velocity_that_an_equation_changes_is_told() {
    let text = |velocity: &str| {
        let cards = format!(
            "*EQUATION\n2\n4, 2, 1., 3, 2, -2.\n*INITIAL CONDITIONS, TYPE=VELOCITY\n3, 2, 0.3\n4, 2, {velocity}"
        );
        SQUARE.replacen("*STEP", &format!("{cards}\n*STEP"), 1)
    };
    assert_eq!(read(&text("0.6")).1, "");
    let warning = "direction 2 of node 4 does not start with its velocity";
    assert!(read(&text("0.7")).1.contains(warning));
}

#[test]
fn mean_dilatation_is_an_option_of_the_section() {
    let text = |kind: &str, formulation: &str| {
        let section = format!("*SOLID SECTION, FORMULATION={formulation},");
        SQUARE
            .replace("CPS4", kind)
            .replace("*SOLID SECTION,", &section)
    };
    for (name, formulation) in [
        ("MEAN DILATATION", Formulation::MeanDilatation),
        ("DISPLACEMENT", Formulation::Displacement),
    ] {
        let (model, messages) = read(&text("CPE4", name));
        assert_eq!(messages, "");
        let expected = ElementType {
            formulation,
            ..ElementType::CPE4
        };
        assert_eq!(model.mesh.elements[0].element_type, expected);
    }
    // it is the type CPE4H
    let named = SQUARE.replace("CPS4", "CPE4H");
    for text in [
        text("CPE4", "MEAN DILATATION"),
        text("CPE4H", "MEAN DILATATION"),
        named,
    ] {
        // nothing locks with it
        let (model, messages) = read(&text.replace("0.3", "0.499"));
        assert_eq!(messages, "");
        assert_eq!(model.mesh.elements[0].element_type, ElementType::CPE4H);
    }
}

#[test]
fn a_section_and_its_element_types_agree_on_mean_dilatation() {
    for (kind, formulation, expected) in [
        (
            "CPS4",
            "MEAN DILATATION",
            "MEAN DILATATION is for CPE4 and CAX4: element 7 is CPS4",
        ),
        (
            "CPE4H",
            "DISPLACEMENT",
            "element 7 is CPE4H, which has mean dilatation",
        ),
    ] {
        let section = format!("*SOLID SECTION, FORMULATION={formulation},");
        let text = SQUARE
            .replace("CPS4", kind)
            .replace("*SOLID SECTION,", &section);
        let (model, _, found) = try_read(&text);
        assert!(model.is_none());
        assert!(found.contains(expected), "{found}");
    }
}

/// Line elements along boundary curves as a mesh generator writes them: before the plane ones, with
/// groups of both under one name.
const CURVES: &str = "*ELEMENT, TYPE=T3D2, ELSET=Line1\n101, 2, 1\n\
                      *ELEMENT, TYPE=T3D2, ELSET=Line2\n102, 3, 4\n103, 2, 3\n\
                      *ELSET, ELSET=RIM\n101, 102\n*ELSET, ELSET=BODY\n103\n";

/// The square with the boundary curves of a mesh generator and further cards.
fn with_curves(more: &str) -> (Model, String) {
    square("*ELEMENT", &format!("{CURVES}{more}*ELEMENT"))
}

fn faces_of(model: &Model, surface: usize) -> Vec<usize> {
    match &model.surfaces[surface].kind {
        SurfaceKind::Faces(faces) => faces.iter().map(|face| face.side).collect(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn line_elements_name_sides_of_plane_elements() {
    let (model, messages) = with_curves(
        "*SURFACE, NAME=S\nRIM\n103,\n*SURFACE, NAME=B\nBODY\n*NSET, NSET=N, ELSET=RIM\n\
         *NSET, NSET=M, ELSET=Line1\n",
    );
    assert!(messages.starts_with("note[D318]"), "{messages}");
    assert_eq!(messages.matches("[D").count(), 1, "{messages}");
    assert_eq!(model.mesh.elements.len(), 1);
    let surfaces = ["S", "B"].map(|name| model.surfaces.iter().position(|s| s.name == name));
    let faces = surfaces.map(|surface| faces_of(&model, surface.unwrap_or(0)));
    assert_eq!(faces, [vec![0, 2, 1], vec![0, 1, 2, 3]]);
    let members = |name: &str| {
        let set = model.sets.nodes.iter().find(|set| set.name == name);
        set.map(|set| set.members.clone())
    };
    assert_eq!(members("N"), Some(vec![0, 1, 2, 3]));
    assert_eq!(members("M"), Some(vec![0, 1]));
    let sets: Vec<&str> = model
        .sets
        .elements
        .iter()
        .map(|s| s.name.as_str())
        .collect();
    assert_eq!(sets, ["BODY"]);
}

#[test]
fn line_elements_of_three_nodes_name_sides_of_quadratic_elements() {
    let quadratic = "*NODE\n12, .5, 0.\n23, 1., .5\n34, .5, 1.\n41, 0., .5\n\
                     *ELEMENT, TYPE=CPS8, ELSET=BODY\n7, 1, 2, 3, 4, 12, 23, 34, 41\n\
                     *ELEMENT, TYPE=T3D3, ELSET=SKIN\n8, 2, 23, 3\n9, 3, 4, 34\n*SURFACE, NAME=S\nSKIN";
    let (model, messages) = square("*ELEMENT, TYPE=CPS4, ELSET=BODY\n7, 1, 2, 3, 4", quadratic);
    let surface = model.surfaces.iter().position(|s| s.name == "S");
    assert_eq!(faces_of(&model, surface.expect("S")), [1, 2], "{messages}");
}

/// The outline of the outside of a ring that is not closed is in contact with a floor: that joins no nodes of the ring.
#[test]
fn contact_with_another_body_joins_no_nodes() {
    let crack = "*NODE\n5, 1., 0.\n6, 2., 0.\n7, 2., 1.\n8, 1., 1.\n*ELEMENT, TYPE=CPS4, ELSET=BODY\n8, 5, 6, 7, 8\n\
                 *SURFACE, NAME=SKIN\nBODY\n*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, -9., -1.\nLINE, 9., -1.\n\
                 *NODE, NSET=REF\n900, 0., -2.\n*RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=900\n\
                 *BOUNDARY\n900, 1, 6\n*SURFACE INTERACTION, NAME=DRY\n";
    for (pair, told) in [("SKIN, FLOOR", true), ("SKIN", false)] {
        let pair = format!("{crack}*CONTACT PAIR, INTERACTION=DRY\n{pair}\n*MATERIAL");
        let (_, messages) = square("*MATERIAL", &pair);
        assert_eq!(messages.contains("[D319]"), told, "{messages}");
    }
}

/// A deck with two strips of square elements, a gap apart, and some contact between them.
fn strips(count: usize, gap: f64, contact: &str) -> String {
    let mut text = String::from("*NODE\n");
    for (strip, first) in [(0, 1), (1, 1001)] {
        for row in 0..2 {
            for i in 0..=count {
                let label = first + row * (count + 1) + i;
                let y = row as f64 + strip as f64 * (1.0 + gap);
                text += &format!("{label}, {i}., {y}\n");
            }
        }
    }
    for (first, name) in [(1, "BELOW"), (1001, "ABOVE")] {
        text += &format!("*ELEMENT, TYPE=CPE4, ELSET={name}\n");
        for i in first..first + count {
            let [c, d] = [i + count + 2, i + count + 1];
            text += &format!("{i}, {i}, {}, {c}, {d}\n", i + 1);
        }
    }
    text += "*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n*DENSITY\n1.\n\
             *SOLID SECTION, ELSET=BELOW, MATERIAL=M\n1.\n*SOLID SECTION, ELSET=ABOVE, MATERIAL=M\n1.\n\
             *SURFACE, NAME=TOP\nBELOW, S3\n*SURFACE, NAME=FOOT\nABOVE, S1\n\
             *SURFACE INTERACTION, NAME=DRY\n*FRICTION\n0.3\n*SURFACE INTERACTION, NAME=WET\n";
    text + contact + "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.1, 1.\n*END STEP\n"
}

#[test]
fn general_contact_takes_means_where_faces_that_can_move_lie_on_others() {
    let chosen = |count: usize, gap: f64, formulation: &str| {
        let contact = format!("*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n{formulation}");
        let contact = &read(&strips(count, gap, &contact)).0.contacts[0];
        (contact.formulation, contact.lying_faces)
    };
    use ContactFormulation::{NodeToSegment, SurfaceToSurface};
    assert_eq!(chosen(1, 0.01, ""), (SurfaceToSurface, Some(2)));
    assert_eq!(chosen(25, 0.01, ""), (SurfaceToSurface, Some(50)));
    assert_eq!(chosen(25, 0.2, ""), (NodeToSegment, Some(0)));
    let card = "*CONTACT FORMULATION, TYPE=NODE TO SURFACE\n";
    assert_eq!(chosen(25, 0.01, card), (NodeToSegment, None));
    // walls of a box lie on each other and never move; one that a rigid body holds by its reference node neither
    let sets = "*NODE, NSET=REF\n2000, 0., 2.\n*NSET, NSET=LOWER, GENERATE\n1, 10\n\
                *NSET, NSET=UPPER, GENERATE\n1001, 1010\n*BOUNDARY\nLOWER, 1, 2\n";
    assert_eq!(chosen(4, 0.01, sets).1, Some(8));
    let both = format!("{sets}UPPER, 1, 2\n");
    assert_eq!(chosen(4, 0.01, &both), (NodeToSegment, Some(0)));
    let rigid = format!("{sets}REF, 1, 2\n*RIGID BODY, ELSET=ABOVE, REF NODE=2000\n");
    assert_eq!(chosen(4, 0.01, &rigid), (NodeToSegment, Some(0)));
}

#[test]
fn pairs_in_both_orders_become_one_where_faces_lie_on_each_other() {
    let contacts = |count: usize, gap: f64, cards: &str| {
        let (model, _) = read(&strips(count, gap, cards));
        let slave = |contact: &Contact| model.surfaces[contact.slave].name.clone();
        let shown = |c: &Contact| (slave(c), c.formulation, c.lying_faces);
        model.contacts.iter().map(shown).collect::<Vec<_>>()
    };
    use ContactFormulation::{NodeToSegment, SurfaceToSurface};
    let [top, foot] = ["TOP", "FOOT"].map(str::to_owned);
    let two = |formulation: ContactFormulation| {
        [&foot, &top].map(|slave| (slave.clone(), formulation, None))
    };
    let pairs =
        |kind: &str| format!("*CONTACT PAIR, INTERACTION=DRY{kind}\nFOOT, TOP\nTOP, FOOT\n");
    let open = pairs("");
    assert_eq!(
        contacts(25, 0.01, &open),
        [(foot.clone(), SurfaceToSurface, Some(50))]
    );
    assert_eq!(
        contacts(1, 0.01, &open),
        [(foot.clone(), SurfaceToSurface, Some(2))]
    );
    assert_eq!(contacts(25, 0.2, &open), two(NodeToSegment));
    let nodes = pairs(", TYPE=NODE TO SURFACE");
    assert_eq!(contacts(25, 0.01, &nodes), two(NodeToSegment));
    let means = pairs(", TYPE=SURFACE TO SURFACE");
    let one = [(foot.clone(), SurfaceToSurface, None)];
    assert_eq!(contacts(4, 0.2, &means), one);
    // what belongs to one of both sides needs its own pair
    let moved = pairs(", ADJUST=0.");
    assert_eq!(contacts(25, 0.01, &moved), two(NodeToSegment));
    let other_law = open.replace("TOP, FOOT", "*CONTACT PAIR, INTERACTION=WET\nTOP, FOOT");
    assert_eq!(contacts(25, 0.01, &other_law), two(NodeToSegment));
    let changed = |card: &str| {
        let deck = strips(25, 0.01, &open).replace("*END STEP", &format!("{card}*END STEP"));
        let model = read(&deck).0;
        let changes = model.steps[0].contacts.clone();
        (
            model.contacts.len(),
            changes.removed,
            changes.friction.len(),
        )
    };
    assert_eq!(changed(""), (1, vec![], 0));
    // what a step does to both it does to the one, and what it does to one of both needs its own pair
    let remove = "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nTOP, FOOT\n";
    assert_eq!(changed(remove).0, 2);
    assert_eq!(changed(&format!("{remove}FOOT, TOP\n")), (1, vec![0], 0));
    let friction = "*CHANGE FRICTION, INTERACTION=DRY\n*FRICTION\n.1\n";
    assert_eq!(changed(friction), (1, vec![], 1));
}
