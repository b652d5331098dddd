//! The model written back as a flat deck reads as the identical model, and is written the same again.

use std::path::{Path, PathBuf};

use stickslip::diagnostics::{Diagnostics, Sources, Span};
use stickslip::flat_deck::{difference, flat_deck};
use stickslip::model::{Frames, Model, SurfaceKind, Variation};
use stickslip::reader;

use crate::errors;
use crate::reading::read;

/// A model without the places of its contacts in the deck, the reasons of pairs, and the instances of parts.
fn flat(mut model: Model) -> Model {
    model.sets.instances.clear();
    for contact in &mut model.contacts {
        contact.span = Span::default();
        contact.interaction.name.clear();
        if !contact.is_self_contact() {
            contact.lying_faces = None;
        }
    }
    model
}

/// Writes a model, reads it and writes it again; returns the text.
#[track_caller]
pub fn round_trip(model: Model) -> String {
    let text = flat_deck(&model);
    let again = read(&text);
    assert_eq!(flat_deck(&again), text);
    assert_eq!(difference(&text, &model), None);
    assert_eq!(flat(again), flat(model), "{text}");
    text
}

/// All decks under a folder.
fn decks(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    let found = paths.into_iter().flat_map(|path| match path.is_dir() {
        true => decks(&path),
        false => vec![path],
    });
    found
        .filter(|path| path.extension().is_some_and(|e| e == "inp"))
        .collect()
}

#[test]
fn every_deck_of_the_repository() {
    let mut count = 0;
    for folder in ["input", "verification", "tests/decks"] {
        for path in decks(Path::new(folder)) {
            let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
            let Some(model) = reader::read_model(&path, &mut sources, &mut d) else {
                continue;
            };
            println!("{}", path.display());
            round_trip(model);
            count += 1;
        }
    }
    assert!(count >= 40, "{count} decks");
}

const SQUARE: &str = include_str!("../decks/square.inp");
const SHARED: &str = include_str!("../decks/shared.inp");

/// The square with further model cards and step cards.
fn square(model: &str, step: &str) -> String {
    let text = SQUARE.replacen("*STEP", &format!("{model}*STEP"), 1);
    text.replacen("*END STEP", &format!("{step}*END STEP"), 1)
}

#[test]
fn a_deck_by_hand() {
    insta::assert_snapshot!(round_trip(read(SHARED)));
}

#[test]
fn friction_that_follows_an_amplitude() {
    let deck = include_str!("../decks/friction.inp");
    for (time, carried) in [("STEP TIME", None), ("TOTAL TIME", Some(0))] {
        let curve = format!("*AMPLITUDE, NAME=A, TIME={time}\n0., 0., 0.1, 1.\n");
        let card = "*CHANGE FRICTION, INTERACTION=";
        let text = deck
            .replacen("*STEP", &format!("{curve}*STEP"), 1)
            .replacen(
                &format!("{card}SLIDES"),
                &format!("{card}SLIDES, AMPLITUDE=A"),
                1,
            );
        let model = read(&text);
        let amplitude = |step: usize| {
            let change = &model.steps[step].contacts.friction[0];
            change.from.as_ref().and_then(|from| from.amplitude)
        };
        assert_eq!([2, 3].map(amplitude), [Some(0), carried], "{time}");
        let written = round_trip(model);
        let is_card =
            |line: &&str| line.starts_with("*CHANGE FRICTION") && line.ends_with(", AMPLITUDE=A");
        assert_eq!(written.lines().filter(is_card).count(), 1, "{written}");
    }
}

#[test]
fn titles_of_any_length() {
    let long = "a title  of many words, *one with a star ".repeat(9);
    for title in [
        long.trim(),
        "x",
        &"y".repeat(300),
        &"two  blanks".repeat(20),
    ] {
        round_trip(read(&SQUARE.replacen("one square", title, 1)));
    }
    round_trip(read(&SQUARE.replacen("*HEADING\none square\n", "", 1)));
}

#[test]
fn names_with_blanks_and_signs() {
    for name in [
        "\"a,b\"",
        "\"12\"",
        "My Foot",
        "\" x\"",
        "_Foot-1.2",
        "\"1e5\"",
    ] {
        let text = square("", "*BOUNDARY\nFOOT, 1\n").replace("FOOT", name);
        let model = round_trip(read(&text));
        assert!(model.contains(name), "{model}");
    }
}

#[test]
fn amplitudes_of_every_kind() {
    let cards = "*AMPLITUDE, NAME=A, DEFINITION=SMOOTH STEP, TIME=TOTAL TIME\n0., 0., 0.1, 1.\n\
                 *AMPLITUDE, NAME=B, DEFINITION=EQUALLY SPACED, FIXED INTERVAL=0.1\n0., 1., 0.3\n\
                 *AMPLITUDE, NAME=C, DEFINITION=PERIODIC\n2, 3., 0.1, 0.2\n0.3, 0.4, 0.5, 0.6\n\
                 *AMPLITUDE, NAME=D, DEFINITION=DECAY\n0.1, 0.2, 0.3, 0.4\n\
                 *AMPLITUDE, NAME=E, DEFINITION=MODULATED, SCALEX=3., SHIFTY=0.1\n\
                 0.1, 0.2, 0.3, 0.4, 0.5\n";
    let step = "*BOUNDARY, AMPLITUDE=A\n4, 1, 1, 0.1\n*BOUNDARY, AMPLITUDE=C\n3, 1, 1, 0.1\n\
                *CLOAD, AMPLITUDE=D\n4, 2, 3.\n*DLOAD, AMPLITUDE=E\nBODY, GRAV, 1., 3., -4.\n";
    round_trip(read(&square(cards, step)));
}

/// Three steps whose heads have these parameters, with these loads and supports each.
fn steps(parts: [[&str; 2]; 3]) -> Model {
    let amplitudes = "*AMPLITUDE, NAME=T, TIME=TOTAL TIME\n0., 0., 9., 1.\n*AMPLITUDE, NAME=S\n\
                      0., 0., 1., 0.7\n";
    let head = SQUARE.split("*STEP").next().expect("a model").to_owned() + amplitudes;
    let steps = parts.map(|[parameters, cards]| {
        format!("*STEP, NLGEOM{parameters}\n*DYNAMIC, DIRECT\n0.1, 1.\n{cards}*END STEP\n")
    });
    read(&(head + &steps.concat()))
}

#[test]
fn loads_from_step_to_step() {
    let loads = "*CLOAD\n3, 2, 4.\n3, 2, 2.\n4, 1, 1.\n*CLOAD, AMPLITUDE=S\n4, 2, 1.\n\
                 *DLOAD\nBODY, GRAV, 9.81, 3., -4.\nBODY, BX, 2.\nBODY, P3, 3.\n\
                 BODY, CENTRIF, 4., 1., -2., 0., 0., 0., 1.\n\
                 *DSLOAD\nTOP, P, 5.\n*DSLOAD, FOLLOWER=NO\nTOP, TRVEC, 2., 1., 1.\n\
                 *DLOAD, FOLLOWER=NO\nBODY, TRVEC2, 2., 1., 0.\n";
    let follow = "*CLOAD, AMPLITUDE=T\n3, 1, 1.\n*DLOAD, AMPLITUDE=T\nBODY, BY, 1.\n";
    for more in [
        "",
        "*CLOAD, OP=NEW\n",
        "*CLOAD, OP=NEW\n4, 1, 7.\n",
        "*DLOAD, OP=NEW\n",
        follow,
    ] {
        round_trip(steps([["", loads], ["", more], ["", "*DSLOAD, OP=NEW\n"]]));
        round_trip(steps([["", follow], ["", more], ["", loads]]));
    }
}

#[test]
fn tractions_on_faces_of_elements_are_those_on_surfaces() {
    let model = |card: &str| read(&square("", card));
    let on_surface = model("*DSLOAD, FOLLOWER=NO\nTOP, TRVEC, 2., 3., 4.\n");
    let on_faces = model("*DLOAD, FOLLOWER=NO\nBODY, TRVEC3, 2., 3., 4.\n");
    assert_eq!(on_surface, on_faces);
    assert_eq!(on_faces.steps[0].tractions[0].at.direction, [0.6, 0.8]);
}

#[test]
fn loads_that_ramp() {
    let ramp = ", AMPLITUDE=RAMP";
    let loads =
        "*CLOAD\n3, 2, 4.\n4, 1, 1.\n3, 2, 3.\n*DLOAD\nBODY, GRAV, 9.81, 0., -1.\nBODY, P3, 1.\n";
    for more in [
        "",
        "*CLOAD, OP=NEW\n",
        "*CLOAD\n3, 2, 8.\n",
        "*CLOAD, OP=NEW\n4, 1, 7.\n",
        "*DLOAD\nBODY, GRAV, 1., 1., 0.\n",
        "*CLOAD, AMPLITUDE=T\n3, 2, 8.\n",
        "*CLOAD\n3, 2, 1.\n3, 2, 2.\n",
    ] {
        let model = steps([[ramp, loads], [ramp, more], ["", "*CLOAD\n4, 2, 1.\n"]]);
        let ramps = |v: Variation| matches!(v, Variation::Ramp { .. });
        assert!(
            model.steps[0]
                .point_loads
                .iter()
                .all(|load| ramps(load.variation))
        );
        round_trip(model);
        round_trip(steps([
            ["", loads],
            [ramp, more],
            [ramp, "*CLOAD\n4, 2, 1.\n"],
        ]));
    }
}

/// Loads on one face by *DLOAD and by *DSLOAD, two of these with directions.
const ON_A_FACE: [&str; 9] = [
    "",
    "*DLOAD\nBODY, P3, 3.\n",
    "*DLOAD, OP=NEW\n",
    "*DSLOAD\nTOP, P, 5.\n",
    "*DSLOAD, OP=NEW\n",
    "*DSLOAD\nTOP, P, 1.\n*DLOAD\nBODY, P3, 2.\n",
    "*DSLOAD, FOLLOWER=NO\nTOP, TRVEC, 2., 1., 0.\n",
    "*DLOAD, FOLLOWER=NO\nBODY, TRVEC3, 2., 1., 0.\n",
    "*DLOAD, FOLLOWER=NO\nBODY, TRVEC3, 3., 0., 1.\n",
];

#[test]
fn several_loads_on_a_face_that_fade_and_grow() {
    let heads = ["", ", AMPLITUDE=RAMP"];
    let before = ON_A_FACE.concat();
    for (first, second) in pairs(&ON_A_FACE) {
        for (head, next) in pairs(&heads) {
            round_trip(steps([[head, &before], [next, first], [heads[1], second]]));
            round_trip(steps([[head, first], [heads[1], second], [next, &before]]));
        }
    }
}

#[test]
fn loads_on_a_face_that_follow_amplitudes_while_others_fade() {
    let ramp = ", AMPLITUDE=RAMP";
    let both = "*DLOAD\nBODY, P3, 3.\n*DSLOAD, AMPLITUDE=T\nTOP, P, 2.\n";
    for more in ["", "*DSLOAD, OP=NEW\n", "*DSLOAD\nTOP, P, 1.\n"] {
        round_trip(steps([["", both], [ramp, more], ["", ""]]));
    }
    let apart = "*DLOAD, FOLLOWER=NO\nBODY, TRVEC3, 2., 1., 0.\n\
                 *DSLOAD, FOLLOWER=NO, AMPLITUDE=T\nTOP, TRVEC, 3., 0., 1.\n";
    round_trip(steps([["", apart], [ramp, "*DLOAD, OP=NEW\n"], ["", ""]]));
    // one that follows the total time, and one that fades in the same direction: no card leaves the first alone
    let model = steps([["", both], [ramp, "*DLOAD, OP=NEW\n"], ["", ""]]);
    let what = difference(&flat_deck(&model), &model);
    assert_eq!(what.as_deref(), Some("the loads of step 2"));
}

fn pairs<'a>(all: &'a [&'a str]) -> impl Iterator<Item = (&'a str, &'a str)> {
    let of = move |&first: &&'a str| all.iter().map(move |&second| (first, second));
    all.iter().flat_map(of)
}

#[test]
fn supports_from_step_to_step() {
    let moves = "*BOUNDARY, AMPLITUDE=S\n4, 1, 1, 0.1\n*BOUNDARY, AMPLITUDE=T\n3, 1, 1, 0.1\n\
                 *BOUNDARY, TYPE=VELOCITY\n4, 2, 2, 0.3\n";
    for more in [
        "",
        "*BOUNDARY, OP=NEW\n",
        "*BOUNDARY, OP=NEW\n4, 1\n",
        "*BOUNDARY\n3, 2\n",
    ] {
        round_trip(steps([["", moves], ["", more], ["", ""]]));
    }
}

#[test]
fn settings_and_times_of_every_kind() {
    for card in [
        "SCHEME=SS22, THETA1=0.5, THETA2=0.75",
        "IMPACT=NONE, LCP=LEMKE, FACTORIZATION=EVERY PASS",
        "IMPACT TIME=EVENT, LANDING=RETURN, SOLVER=SPRS",
        "CONTACT MASS=REDISTRIBUTED, TOLERANCE=1.e-9, MAX PASSES=40",
    ] {
        round_trip(read(&square("", &format!("*STICKSLIP, {card}\n"))));
    }
    let points = "*TIME POINTS, NAME=P, TIME=TOTAL TIME\n0.5, 1.25, 1.75\n";
    for when in [
        "FREQUENCY=7",
        "NUMBER INTERVAL=3",
        "TIME INTERVAL=0.3",
        "TIME POINTS=P",
    ] {
        let field = format!("*OUTPUT, FIELD, {when}\n");
        let cards = format!("{points}{field}");
        let model = steps([["", &cards], ["", ""], ["", ""]]);
        assert_ne!(model.steps[2].frames, Frames::Default);
        round_trip(model);
    }
    let totals =
        "*NODE PRINT, NSET=ALL, TOTALS=ONLY\nU\n*EL PRINT, ELSET=BODY, TOTALS=ONLY\nELSE\n";
    round_trip(read(&square("", totals)));
    for fields in [
        "*NODE FILE\nCF\n",
        "*EL FILE\nLE\n*NODE FILE\nU, CF\n",
        "*EL FILE\nS, ENER\n",
        "*EL FILE, POSITION=NODES\nMISES, E\n",
    ] {
        round_trip(read(&square("", fields)));
    }
    assert!(round_trip(read(&square("", "*NO ANALYSIS\n"))).contains("*NO ANALYSIS"));
    round_trip(read(
        &SQUARE.replace("DYNAMIC, DIRECT\n0.1, 1.", "DYNAMIC\n0.1, 1., 1.e-5"),
    ));
}

#[test]
fn constraints_and_contacts() {
    let equations = "*EQUATION\n2\n3, 1, 1., 4, 1, -0.3\n*EQUATION\n5\n3, 2, 2., 4, 1, 0.1, 4, 2, 0.2,\
                     1, 1, 3.\n2, 1, 4.\n";
    round_trip(read(&square(equations, "")));
    round_trip(read(&square("*EQUATION\n2\n3, 1, 1., 4, 1, 0.\n", "")));
    let pair = "*CONTACT PAIR, INTERACTION=DRY, TYPE=NODE TO SURFACE\nSBOT, STOP\n";
    let general = "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n\
                   *CONTACT PROPERTY ASSIGNMENT\n, , DRY\n";
    let initialization =
        "*CONTACT INITIALIZATION DATA, NAME=FIT, INITIAL CLEARANCE=0.01, SEARCH ABOVE=0.1\n";
    let assignment = "*CONTACT INITIALIZATION ASSIGNMENT\n, , FIT\n";
    let floor = "*NODE\n100, 0., -5.\n*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, 9., 0.\n\
                 START, 0., 0.\nLINE, 2., 0.\nCIRCL, 3., 1., 2., 1.\nSTART, 5., 0.\nLINE, 6., 0.\n\
                 LINE, 6., 1.\nLINE, 5., 0.\n*RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=100\n\
                 *BOUNDARY\n100, 1, 2\n";
    let onto_floor = pair.replace("STOP", "FLOOR");
    for contact in [
        general.to_owned(),
        format!("{general}*CONTACT FORMULATION, TYPE=SURFACE TO SURFACE\n"),
        format!("{initialization}{general}{assignment}"),
        format!(
            "{}{floor}{general}{assignment}",
            initialization.replace("0.1", "0.1, SEARCH BELOW=0.02")
        ),
        format!("{floor}{onto_floor}"),
        format!("{floor}{general}"),
        format!("{floor}{general}{onto_floor}"),
        pair.replace("TYPE", "ADJUST=0.05, TYPE"),
        pair.replace("TYPE", "ADJUST=NBLOCK, TYPE"),
        pair.replace("SBOT, STOP", "STOP"),
        format!("{pair}*CLEARANCE, SLAVE=SBOT, MASTER=STOP, VALUE=0.01\n"),
        format!(
            "{pair}*SURFACE INTERACTION, NAME=SLICK\n{}",
            pair.replace("DRY", "SLICK")
                .replace("SBOT, STOP", "STOP, SBOT")
        ),
    ] {
        round_trip(read(&SHARED.replacen(pair, &contact, 1)));
    }
}

/// The reader takes one order, from surface to surface, because faces lie on each other. The flat deck says so.
#[test]
fn pairs_in_both_orders_that_have_become_one() {
    let deck = errors::on_each_other(20);
    let nodes = deck.replace("INTERACTION=DRY", "INTERACTION=DRY, TYPE=NODE TO SURFACE");
    for (deck, count) in [(deck, 1), (nodes, 2)] {
        let text = round_trip(read(&deck));
        assert_eq!(text.matches("*CONTACT PAIR").count(), count, "{text}");
    }
}

#[test]
fn surfaces_called_as_that_of_general_contact() {
    for deck in [
        SHARED.replace("STOP", "ALL_EXTERIOR"),
        SHARED.replace("SBOT", "ALL_EXTERIOR"),
        square("*SURFACE, NAME=ALL_EXTERIOR\nBODY\n", ""),
    ] {
        round_trip(read(&deck));
    }
}

#[test]
fn rigid_elements_with_a_reference_node_apart() {
    let cards = "*NODE\n100, 0., -5.\n*RIGID BODY, ELSET=EBASE, REF NODE=100\n*AMPLITUDE, NAME=A\n\
                 0., 0., 1., 1.\n*BOUNDARY\n100, 1, 6";
    let deck = SHARED.replacen("*BOUNDARY\nNFIX, 1, 2", cards, 1);
    round_trip(read(&deck));
    let moved = "*BOUNDARY, AMPLITUDE=A\n100, 1, 1, 0.3\n*DLOAD";
    round_trip(read(&deck.replacen("*DLOAD", moved, 1)));
}

#[test]
fn rigid_bodies_that_turn() {
    let cards = "*NODE, NSET=NREF\n100, 0., -5.\n*RIGID BODY, ELSET=EBASE, REF NODE=100\n\
                 *ELEMENT, TYPE=MASS, ELSET=EM\n901, 100\n*MASS, ELSET=EM\n2.5\n\
                 *ELEMENT, TYPE=ROTARYI, ELSET=ER\n902, 100\n*ROTARY INERTIA, ELSET=ER\n, , 0.4\n\
                 *INITIAL CONDITIONS, TYPE=ROTATING VELOCITY\nNREF, 12.5, 1., 0., 0.\n\
                 0., 0., 0., 0., 0., 1.\n*AMPLITUDE, NAME=A\n0., 0., 1., 1.";
    let deck = SHARED.replacen("*BOUNDARY\nNFIX, 1, 2", cards, 1);
    let model = read(&deck);
    let [body] = &model.rigid_bodies[..] else {
        panic!("one rigid body");
    };
    assert!(body.turns);
    assert_eq!(body.rotary_inertia, 0.4);
    assert_eq!(body.masses, [(body.reference, 2.5)]);
    let velocity = |dof: usize| model.initial_velocity[dof];
    assert_eq!(velocity(model.angle_of(body)), 12.5);
    // 1 + 12.5 x 5 and 0: the reference node is 5 below the axis
    assert_eq!(
        [0, 1].map(|i| velocity(2 * body.reference + i)),
        [63.5, 0.0]
    );
    round_trip(model);
    let driven =
        "*BOUNDARY\n100, 1, 2\n*BOUNDARY, AMPLITUDE=A\n100, 6, 6, 0.3\n*CLOAD\n100, 1, 5.\n*DLOAD";
    let still = deck.replacen(
        "*INITIAL CONDITIONS",
        "*BOUNDARY\n100, 1, 2\n*INITIAL CONDITIONS",
        1,
    );
    let still = still.replacen("NREF, 12.5, 1., 0., 0.", "NREF, 0., 0., 0., 0.", 1);
    round_trip(read(&still.replacen("*DLOAD", driven, 1)));
    let loaded = "*CLOAD\n100, 6, 5.\n*DLOAD";
    round_trip(read(&deck.replacen("*DLOAD", loaded, 1)));
    // the weight of the point mass is a force, which gravity on all elements must not add once more
    let heavy = "*DLOAD\n, GRAV, 9.81, 0., -1.\n*DLOAD";
    round_trip(read(&deck.replacen("*DLOAD", heavy, 1)));
}

#[test]
fn ties() {
    let gap = "*CONTACT PAIR, INTERACTION=DRY, TYPE=NODE TO SURFACE\nSBOT, STOP";
    for (options, nodes) in [
        ("NAME=BOND", 2),
        ("ADJUST=NO, POSITION TOLERANCE=100.", 2),
        ("TIED NSET=NEAREST", 1),
        ("TYPE=NODE TO SURFACE", 2),
    ] {
        let tie = format!("*NSET, NSET=NEAREST\n11\n*TIE, {options}\nSBOT, STOP\n{gap}");
        let deck = SHARED.replacen(gap, &tie, 1).replace(", 1.1", ", 1.05");
        let model = read(&deck);
        assert_eq!(model.ties[0].nodes.len(), nodes, "{options}");
        assert_eq!(model.equations.len(), 2 * nodes);
        assert_eq!(model.contacts[0].left_out.len(), nodes);
        round_trip(model);
    }
}

#[test]
fn couplings() {
    for (cards, coupled, equations) in [
        (
            "*COUPLING, CONSTRAINT NAME=GRIP, REF NODE=99, SURFACE=SBOT\n*KINEMATIC\n1, 2",
            2,
            0,
        ),
        (
            "*COUPLING, CONSTRAINT NAME=PULL, REF NODE=99, SURFACE=SBOT\n*DISTRIBUTING",
            0,
            2,
        ),
        ("*KINEMATIC COUPLING, REF NODE=99\nNBLOCK, 1, 2", 4, 0),
        ("*MPC\nBEAM, 13, 99\nBEAM, 14, 99", 2, 0),
        ("*MPC\nPIN, 11, 4\nTIE, 12, 6", 0, 4),
        ("*MPC\nBEAM, NBLOCK, 99\nPIN, 98, 11", 5, 0),
        (
            "*MPC\nBEAM, 11, 99\nBEAM, 12, 99\nBEAM, 98, 13\nBEAM, 14, 13\nPIN, 98, 11",
            4,
            0,
        ),
    ] {
        let nodes = ["99, 2., 3.", "98, 1., 1.1"].map(|row| match cards.contains(&row[..2]) {
            true => format!("*NODE\n{row}\n"),
            false => String::new(),
        });
        let nodes = nodes.concat() + "*SURFACE, NAME=STOP";
        let deck = SHARED.replacen("*SURFACE, NAME=STOP", &nodes, 1);
        // a body starts with the velocity of its reference node
        let deck = deck.replacen("NBLOCK, 2, -1000.", "NBLOCK, 2, 0.", 1);
        let model = read(&deck.replacen("*STEP", &format!("{cards}\n*STEP"), 1));
        let bodies = model.rigid_bodies.iter().map(|body| body.nodes.len());
        assert_eq!(bodies.sum::<usize>(), coupled, "{cards}");
        assert_eq!(model.equations.len(), equations, "{cards}");
        round_trip(model);
    }
}

#[test]
fn friction_that_decays() {
    for decay in ["0.3, 0.1, 5.", "0.3, 0.3, 5.", "0.3, 0.1, 0."] {
        let card = format!("*FRICTION, EXPONENTIAL DECAY\n{decay}");
        round_trip(read(&SHARED.replacen("*FRICTION\n0.3, 2.1E5", &card, 1)));
    }
}

#[test]
fn materials_of_every_kind() {
    let more = "*MATERIAL, NAME=EMPTY\n*MATERIAL, NAME=HARD\n*ELASTIC\n1.e5, 0.3\n*DENSITY\n2.\n\
                *DAMPING, ALPHA=0.1, BETA=1.e-7\n*ELSET, ELSET=NONE\n*NSET, NSET=NO\n";
    round_trip(read(&square(more, "")));
    let rubber = SQUARE.replace(
        "*ELASTIC\n1000., 0.3",
        "*HYPERELASTIC, NEO HOOKE\n200., 2.E-3",
    );
    round_trip(read(&rubber));
    for law in [
        "*HYPERELASTIC, MOONEY-RIVLIN\n150., 50., 3.E-3",
        "*HYPERELASTIC, YEOH\n150., -7., 0.3, 3.E-3, 0., 7.E-3",
        "*ELASTIC, TYPE=NEO HOOKE\n1000., 0.3",
        "*ELASTIC, TYPE=HENCKY\n1000., 0.3",
    ] {
        round_trip(read(&SQUARE.replace("*ELASTIC\n1000., 0.3", law)));
    }
    // the elastic strains of metals are Hencky's, whether the deck says so or not
    let [metal, of_hencky] = ["", ", TYPE=HENCKY"].map(|kind| {
        let law = format!("*ELASTIC{kind}\n1000., 0.3\n*PLASTIC\n5., 0.\n7., 0.1");
        read(&SQUARE.replace("*ELASTIC\n1000., 0.3", &law))
    });
    assert_eq!(metal.materials, of_hencky.materials);
    round_trip(metal);
    let mean = rubber.replace("CPS4", "CPE4");
    round_trip(read(&mean.replace(
        "MATERIAL=RUBBER\n",
        "MATERIAL=RUBBER, FORMULATION=MEAN DILATATION\n",
    )));
    round_trip(read(&mean));
    round_trip(read(&rubber.replace("CPS4", "CPE4H")));
}

#[test]
fn nodes_that_ride_on_rigid_bodies() {
    let more = "*NODE\n21, 1., 1.\n22, 2., 1.\n23, 2., 2.\n24, 1., 2.\n900, 0.5, 0.5\n\
                *ELEMENT, TYPE=CPS4, ELSET=NEXT\n8, 21, 22, 23, 24\n\
                *SOLID SECTION, ELSET=NEXT, MATERIAL=RUBBER\n0.5\n*RIGID BODY, ELSET=BODY, REF NODE=900\n";
    let supports = "*BOUNDARY\n900, 1, 6\n";
    for riders in [
        "*MPC\nPIN, 21, 3\n",
        "*KINEMATIC COUPLING, REF NODE=900\n21\n24\n",
    ] {
        let text = SQUARE.replacen("FOOT, 1, 2", "900, 1, 2", 1);
        let text = text.replacen("*STEP", &format!("{more}{riders}*STEP"), 1);
        round_trip(read(&text.replacen(
            "*END STEP",
            &format!("{supports}*END STEP"),
            1,
        )));
    }
}

#[test]
fn rings_have_no_thickness() {
    let text = SQUARE
        .replacen("CPS4", "CAX4", 1)
        .replacen("FOOT, 1, 2", "ALL, 1\nFOOT, 2", 1);
    let model = read(&text);
    assert_eq!(model.sections[0].thickness, 1.0);
    round_trip(model);
}

/// General contact leaves out the faces of a section, which equations join: a flat deck has the equations alone.
#[test]
fn general_contact_and_a_section_with_pretension() {
    let general =
        "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT PROPERTY ASSIGNMENT\n, , DRY\n";
    let bolt = include_str!("../decks/bolt.inp");
    let pair = "*CONTACT PAIR, INTERACTION=DRY\nFOOT, SEAT\n";
    assert!(bolt.contains(pair));
    let model = read(&bolt.replacen(pair, general, 1));
    let count = |faces: &SurfaceKind| match faces {
        SurfaceKind::Faces(faces) => faces.len(),
        _ => 0,
    };
    let exterior = model.surfaces.last().map(|surface| count(&surface.kind));
    // the section has as many faces on each side as the surface that it is cut along
    let cut = model.surfaces.iter().find(|surface| surface.name == "CUT");
    let cut = cut.map(|surface| count(&surface.kind)).expect("CUT");
    let free = model.mesh.exterior_faces().len();
    assert_eq!(exterior, Some(free - 2 * cut));
    round_trip(model);
}
