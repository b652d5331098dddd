//! Advice in messages: likely meaning of unknown names, input without effect, later failures.

use super::{LINE, SHARED, SQUARE, Source, change, messages, model, rigid, shared, square, step};
use stickslip::diagnostics::{Code, Severity};

/// Messages of decks, each of which must have one, of this code.
fn texts_of(code: Code, decks: &[Source]) -> String {
    let texts = decks.iter().map(|deck| {
        let (d, text) = messages(deck);
        let codes: Vec<Code> = d.iter().map(|item| item.code).collect();
        assert_eq!(codes, [code], "{text}");
        text
    });
    texts.collect::<Vec<_>>().join("\n")
}

#[test]
fn numbers_that_are_none() {
    insta::assert_snapshot!(texts_of(
        Code::BadNumber,
        &[
            square("1000., 0.3", "1.e6 0.3"),
            square("1000., 0.3", "\t1.e6,\t0.3  1."),
            square("7, 1, 2, 3, 4", "7, 1, 2  3, 4"),
            square("1000., 0.3", "1,e6"),
            square("1000., 0.3", "1, E+6"),
            square("1000., 0.3", "1.e 6, 0.3"),
            square("4, 0., 1.", "1000000000, 0., 1."),
            square("4, 0., 1.", "9223372036854775807, 0., 1."),
            square("7, 1, 2", "1000000000, 1, 2"),
        ],
    ));
}

/// Messages of the square in plane strain with these cards in place of its law: one error each.
fn texts_of_laws<const N: usize>(cards: [&str; N]) -> String {
    let texts = cards.map(|cards| {
        let deck = SQUARE.replace("CPS4", "CPE4");
        let (d, text) = messages(&change(&deck, "*ELASTIC\n1000., 0.3", cards));
        assert_eq!(d.count(Severity::Error), 1, "{text}");
        text
    });
    texts.join("\n")
}

#[test]
fn forms_of_hyperelasticity() {
    let texts = texts_of_laws([
        "*HYPERELASTIC\n200., 2.E-3",
        "*HYPERELASTIC, YEOH, MOONEY-RIVLIN\n200., 2.E-3",
        "*HYPERELASTIC, YEOH\n200., 0., 0., 2.E-3, -1.",
        "*HYPERELASTIC, YEOH\n-200., 0., 0., 2.E-3",
        "*HYPERELASTIC, YEOH\n200., 0., 0.",
        "*HYPERELASTIC, MOONEY-RIVLIN\n200., -200., 2.E-3",
        "*HYPERELASTIC, MOONEY-RIVLIN\n200., , 2.E-3",
        "*HYPERELASTIC, POLYNOMIAL, NEO HOOKE\n200., 10., 2.E-3",
        "*HYPERELASTIC, OGDEN\n200., 2.E-3",
        "*HYPERELASTIC, OGDEN\n200., 0., 2.E-3",
        "*HYPERELASTIC, OGDEN, N=2\n200., 2., -300., -2., 2.E-3, 0.",
        "*HYPERELASTIC, OGDEN, N=2\n200., 2., 20., -2., 2.E-3, -1.",
        "*HYPERELASTIC, OGDEN, N=3\n200., 2., 20., -2., 1., 5., 2.E-3, 0.\n0., 20.\n100., 2., 20., -2., 1., 5., 2.E-3, 0.\n0., 40.",
        "*HYPERELASTIC, OGDEN, N=4\n200., 2., 2.E-3",
        "*HYPERELASTIC, NEO HOOKE, N=2\n200., 2.E-3",
        "*ELASTIC, TYPE=NEO HOOKE\n1000., 0.5",
        "*HYPERELASTIC, POLYNOMIAL, N=2\n200., 2.E-3",
        "*HYPERELASTIC, NEO HOOKE, TEST DATA INPUT\n200., 2.E-3",
        "*HYPERELASTIC, NEO HOOKE, POISSON=0.45\n200.",
        "*HYPERELASTIC, NEO HOOKE, MODULI=LONG TERM\n200., 2.E-3",
    ]);
    insta::assert_snapshot!(texts);
}

#[test]
fn amplitudes_that_cannot_be() {
    let amplitude = |text: &str| model(&format!("*AMPLITUDE, NAME=A, DEFINITION={text}"));
    insta::assert_snapshot!(texts_of(
        Code::AmplitudeTable,
        &[
            amplitude("SMOOTH STEP\n0., 0., 0., 1."),
            amplitude("EQUALLY SPACED, FIXED INTERVAL=0.\n0., 1."),
            amplitude("EQUALLY SPACED, FIXED INTERVAL=1.E-20, BEGIN=1.\n0., 1."),
            amplitude("PERIODIC\n2, 3.\n1., 0."),
            amplitude("PERIODIC, SCALEX=-1.\n0, 3."),
            amplitude("DECAY\n0., 1., 0., -2."),
            amplitude("MODULATED, SCALEY=1.E300\n1.E300, 1., 0., 1., 1."),
            amplitude("MODULATED\n0., 1., 0., 1.E308, 1."),
            amplitude("TABULAR\n-1.E308, 0., 1.E308, 1."),
            amplitude("TABULAR\n0., 0., 1., -1.E101"),
        ],
    ));
}

#[test]
fn line_elements_in_place_of_plane_ones() {
    let curve = "*ELEMENT, TYPE=T3D2, ELSET=RIM\n8, 1, 2\n";
    let section = model(&format!(
        "{curve}*SOLID SECTION, ELSET=RIM, MATERIAL=RUBBER"
    ));
    let face = model(&format!("{curve}*SURFACE, NAME=S\nRIM, S1"));
    let load = "*STEP, NLGEOM\n*DYNAMIC\n0.1, 1.\n*DLOAD\n8, P1, 1.\n*END STEP\n*STEP";
    let load = square("*STEP", &format!("{curve}{load}"));
    let texts = [section, face, load].map(|deck| {
        let (d, text) = messages(&deck);
        assert_eq!(d.count(Severity::Error), 1, "{text}");
        text
    });
    insta::assert_snapshot!(texts.join("\n"));
}

#[test]
fn names_that_are_no_supports() {
    let text = texts_of(Code::BadDof, &[square("FOOT, 1, 2", "FOOT, ENCASTER")]);
    assert!(text.contains("did you mean ENCASTRE?"), "{text}");
    assert!(text.contains("deck.inp:22:7"), "{text}");
}

#[test]
fn friction_that_cannot_be() {
    let shared = include_str!("../decks/shared.inp");
    let friction = "*FRICTION\n0.3, 2.1E5\n";
    assert!(shared.contains(friction));
    let texts = [
        "*FRICTION, EXPONENTIAL DECAY\n0.3, 0.2",
        "*FRICTION, EXPONENTIAL DECAY\n0.3, 0.2, -1.",
        "*FRICTION, EXPONENTIAL DECAY\n0.3, 0.2, 1., 4.",
        "*FRICTION, EXPONENTIAL DECAY, TEST DATA\n0.3, 0.2, 1.",
        "*FRICTION, EXPONENTIAL DECAY\n0.3, 0.2, 1.\n0.2, 0.1, 1.",
        "*FRICTION\n0.3, 1.\n0.2, 1.",
        "*FRICTION\n0.3, 0., 2.\n0.2, 1., 2.\n0.1, 0., 1.",
        "*FRICTION\n0.3, 0.\n0.2, -1.",
        "*FRICTION\n0.3, 0., 0., 20.\n0.2, 1., 0., 30.",
        "*FRICTION, TAUMAX=-10.\n0.3",
        "*FRICTION, TAUMAX=10., ROUGH",
        "*FRICTION, ROUGH\n0.3",
        "*FRICTION",
    ];
    let messages: Vec<String> = texts
        .iter()
        .map(|text| {
            let deck = shared.replacen(friction, &format!("{text}\n"), 1);
            let (_, messages) = messages(&Source::Text(deck));
            let errors = messages
                .split_inclusive("\n\n")
                .filter(|text| text.starts_with("error"));
            format!("--- {text}\n{}", errors.collect::<String>())
        })
        .collect();
    insta::assert_snapshot!(messages.concat());
}

#[test]
fn contact_changes_wear_and_heat_that_cannot_be() {
    let shared = include_str!("../decks/shared.inp");
    let in_step = |text: &str| shared.replacen("*END STEP", &format!("{text}\n*END STEP"), 1);
    let friction = "*FRICTION\n0.3, 2.1E5\n";
    let in_model = |text: &str| shared.replacen(friction, &format!("{friction}{text}\n"), 1);
    let remove = "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nSBOT, STOP";
    let repeated = format!("{remove}\n{remove}");
    let [steps, model] = [
        &[
            "*CHANGE FRICTION, INTERACTION=WET\n*FRICTION\n0.1",
            "*CHANGE FRICTION, INTERACTION=DRY",
            "*CHANGE FRICTION, INTERACTION=DRY, RESET\n*FRICTION\n0.1",
            "*CHANGE FRICTION, INTERACTION=DRY\n*FRICTION\n-0.1",
            "*AMPLITUDE, NAME=A\n0., 0., 1., 1.5\n*CHANGE FRICTION, INTERACTION=DRY, AMPLITUDE=A\n*FRICTION\n0.1",
            "*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n*CHANGE FRICTION, INTERACTION=DRY, AMPLITUDE=A\n*FRICTION, ROUGH",
            "*AMPLITUDE, NAME=A\n0., 0., 99., 1.\n*CHANGE FRICTION, INTERACTION=DRY, AMPLITUDE=A\n*FRICTION\n0.1\n*END STEP\n*STEP\n*STATIC\n",
            "*FRICTION\n0.1",
            "*MODEL CHANGE, TYPE=CONTACT PAIR\nSBOT, STOP",
            "*MODEL CHANGE, REMOVE\nSBOT, STOP",
            "*MODEL CHANGE, TYPE=ELEMENT, REMOVE\nSBOT",
            "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nSBOT",
            "*MODEL CHANGE, TYPE=CONTACT PAIR, ADD\nSBOT, STOP",
            &repeated,
        ][..],
        &[
            "*WEAR SURFACE PROPERTIES\n-1.",
            "*WEAR SURFACE PROPERTIES\n1., 2.",
            "*WEAR SURFACE PROPERTIES\n1.\n2.",
            "*WEAR SURFACE PROPERTIES, UNITLESS WEAR COEF=YES\n1.",
            "*WEAR SURFACE PROPERTIES, UNITLESS WEAR COEF=YES, REFERENCE STRESS=0.\n1.",
            "*WEAR SURFACE PROPERTIES, REFERENCE STRESS=2.\n1.",
            "*GAP HEAT GENERATION\n1.5",
            "*GAP HEAT GENERATION\n1., 0.5, 3.",
        ][..],
    ];
    let decks = (steps.iter().map(|text| (*text, in_step(text))))
        .chain(model.iter().map(|text| (*text, in_model(text))));
    let all = decks.map(|(text, deck)| {
        let (_, messages) = messages(&Source::Text(deck));
        let own = messages
            .split_inclusive("\n\n")
            .filter(|text| !text.contains("stick slope"));
        format!("--- {text}\n{}", own.collect::<String>())
    });
    insta::assert_snapshot!(all.collect::<String>());
}

#[test]
fn damping_that_cannot_be() {
    let texts = [
        "*DAMPING",
        "*DAMPING, ALPHA=-0.5",
        "*DAMPING, BETA=-1.E-5",
        "*DAMPING, BETA=1.E-5, STRUCTURAL=0.1",
        "*DAMPING, ALPHA=1., COMPOSITE=0.02",
        "*DAMPING, BETA=1.E-5\n*DAMPING, ALPHA=1.",
    ]
    .map(|card| {
        let deck = square("*DENSITY", &format!("{card}\n*DENSITY"));
        let (d, text) = messages(&deck);
        assert_eq!(d.count(Severity::Error), 1, "{text}");
        text
    });
    insta::assert_snapshot!(texts.join("\n"));
    let card = "*DAMPING, BETA=1.E-5";
    let (d, text) = messages(&model(&format!("{card}\n{card}")));
    assert_eq!(
        d.iter().map(|item| item.code).collect::<Vec<_>>(),
        [Code::RepeatedCard],
        "{text}"
    );
    let (d, text) = messages(&step(card));
    assert_eq!(
        d.iter().map(|item| item.code).collect::<Vec<_>>(),
        [Code::WrongPlace],
        "{text}"
    );
}

#[test]
fn constants_of_a_neo_hookean_material() {
    let texts = texts_of_laws([
        "*HYPERELASTIC, NEO HOOKE",
        "*HYPERELASTIC, NEO HOOKE\n200.",
        "*HYPERELASTIC, NEO HOOKE\n200.,",
        "*HYPERELASTIC, NEO HOOKE\n, 2.E-3",
        "*HYPERELASTIC, NEO HOOKE\n0., 2.E-3",
        "*HYPERELASTIC, NEO HOOKE\n-200., 2.E-3",
        "*HYPERELASTIC, NEO HOOKE\n200., -2.E-3",
        "*HYPERELASTIC, NEO HOOKE\n200., x",
        "*HYPERELASTIC, NEO HOOKE\n200., 2.E-3, , 4.",
        "*HYPERELASTIC, NEO HOOKE\n200., 2.E-3, 20.\n210., 2.E-3, 40.",
    ]);
    insta::assert_snapshot!(texts);
}

#[test]
fn laws_that_are_none_of_metals() {
    let texts = texts_of_laws([
        "*ELASTIC, TYPE=NEO HOOKE\n1000., 0.3\n*PLASTIC\n5., 0.",
        "*HYPERELASTIC, NEO HOOKE\n200., 2.E-3\n*PLASTIC\n5., 0.",
        "*ELASTIC, TYPE=HENCKY\n1000., 0.5",
    ]);
    insta::assert_snapshot!(texts);
}

#[test]
fn two_laws_in_one_material() {
    // nearly incompressible, yet without the warning that belongs to a law
    let texts = texts_of_laws([
        "*ELASTIC\n1000., 0.3\n*HYPERELASTIC, NEO HOOKE\n200., 1.E-4",
        "*HYPERELASTIC, NEO HOOKE\n200., 1.E-4\n*ELASTIC\n1000., 0.3",
        "*HYPERELASTIC, NEO HOOKE\n200., 1.E-4\n*HYPERELASTIC, NEO HOOKE\n200., 1.E-4",
        "*ELASTIC\n1000., 0.49\n*ELASTIC\n1000., 0.3",
    ]);
    insta::assert_snapshot!(texts);
}

#[test]
fn a_decimal_comma_makes_one_field_more() {
    insta::assert_snapshot!(texts_of(
        Code::ExtraField,
        &[
            square("2, 1., 0.", "2, 1,0, 0,0"),
            square("FOOT, 1, 2", "FOOT, 1, 2, 0,5"),
        ],
    ));
}

#[test]
fn a_comment_with_one_star() {
    insta::assert_snapshot!(texts_of(
        Code::UnknownKeyword,
        &[
            square("*NODE, NSET", "* my set\n*NODE, NSET"),
            square("*NODE, NSET", "*the nodes of the square\n*NODE, NSET"),
            square("*NODE, NSET", "*XYZZY\n*NODE, NSET"),
        ],
    ));
}

#[test]
fn names_of_other_kinds() {
    let set = "*NODE PRINT, NSET";
    insta::assert_snapshot!(texts_of(
        Code::UndefinedName,
        &[
            // an element set, a surface, a material where a node set is asked for
            square("FOOT, 1, 2", "BODY, 1, 2"),
            square("FOOT, 1, 2", "TOP, 1, 2"),
            square("FOOT, 1, 2", "Rubber, 1, 2"),
            // a node set, a surface where an element set is asked for
            square("ELSET=BODY, MAT", "ELSET=FOOT, MAT"),
            square("ELSET=BODY, MAT", "ELSET=TOP, MAT"),
            // sets where a surface is asked for, and the other way round
            step("*DSLOAD\nBODY, P, 1."),
            step("*DSLOAD\nFOOT, P, 1."),
            model("*SURFACE, NAME=S\nTOP"),
            model("*NSET, NSET=N\nTOP"),
            // misspelt names of other kinds
            square("FOOT, 1, 2", "RUBER, 1, 2"),
            step("*DSLOAD\nBDOY, P, 1."),
            // names that nothing has, and a comma that is missing
            square(&format!("{set}=FOOT"), &format!("{set}=WHEEL")),
            square("FOOT, 1, 2", "FOOT 1, 2"),
            step("*BOUNDARY, AMPLITUDE=A\n4, 1"),
        ],
    ));
}

#[test]
fn numbers_of_other_kinds() {
    let texts = [
        // an element where a node is meant
        (Code::UndefinedNode, square("3, 2, 4.", "7, 2, 4.")),
        (Code::UndefinedNode, square("1, 2\n", "1, 7\n")),
        // a node where an element is meant
        (Code::UndefinedElement, step("*DLOAD\n3, P1, 1.")),
        (Code::UndefinedElement, model("*SURFACE, NAME=S\n4")),
        (
            Code::UndefinedElement,
            model("*ELSET, ELSET=E, GENERATE\n1, 3"),
        ),
        // neither
        (Code::UndefinedNode, square("3, 2, 4.", "8, 2, 4.")),
    ];
    let texts = texts.map(|(code, deck)| texts_of(code, &[deck]));
    insta::assert_snapshot!(texts.join("\n"));
}

#[test]
fn sets_of_several_nodes_where_one_is_meant() {
    insta::assert_snapshot!(texts_of(
        Code::BadValue,
        &[step("*MONITOR, NODE=FOOT, DOF=2")]
    ));
}

#[test]
fn model_cards_after_a_step() {
    let after = |more: &str| square("*END STEP\n", &format!("*END STEP\n{more}\n"));
    for cards in [
        "*MATERIAL, NAME=STEEL\n*ELASTIC\n1., 0.3",
        "*DENSITY\n1.",
        "*HEADING\nanother",
        "*NSET, NSET=MORE\n1",
        "*BOUNDARY\n4, 1",
        "*AMPLITUDE, NAME=A\n0., 0., 1., 1.",
        "*TIME POINTS, NAME=A\n0.5",
        "*RESTART, WRITE, FREQUENCY=0",
        "*SURFACE INTERACTION, NAME=I",
        "*NSET, NSET=MORE\n1\n*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.1, 1.\n*END STEP",
    ] {
        let (d, text) = messages(&after(cards));
        let errors: Vec<Code> = d.iter().map(|item| item.code).collect();
        assert_eq!(errors, [Code::WrongPlace], "{cards}:\n{text}");
        assert!(
            text.contains("first *STEP") || cards.starts_with("*DENSITY"),
            "{text}"
        );
    }
    // a part of the model's last block, in the step
    let section = "*SOLID SECTION, ELSET=BODY, MATERIAL=RUBBER\n0.5\n";
    let last = SQUARE
        .replace(section, "")
        .replace("*MATERIAL", &format!("{section}*MATERIAL"));
    let last = last.replacen("*BOUNDARY\nFOOT, 1, 2\n", "", 1);
    let (d, text) = messages(&change(&last, "*CLOAD", "*DENSITY\n2.\n*CLOAD"));
    assert_eq!(
        d.iter().map(|item| item.code).collect::<Vec<_>>(),
        [Code::WrongPlace],
        "{text}"
    );
}

#[test]
fn every_error_of_a_deck_has_a_place() {
    let empty = ["", "\n\n", "** nothing\n"].map(|text| Source::Text(text.into()));
    let bare = "*HEADING\nx\n*STEP, NLGEOM\n*DYNAMIC, DIRECT\n1., 1.\n*END STEP\n";
    let meshes = [
        bare.to_string(),
        bare.replace("*STEP", "*NODE\n*STEP"),
        bare.replace("*STEP", "*NODE\n1, 0., 0.\n*STEP"),
        bare.replace("*STEP", "*NODE\n1, 0., 0.\n*ELEMENT, TYPE=CPS3\n*STEP"),
        SQUARE.split("*STEP").next().unwrap_or("").to_string(),
    ];
    let decks = empty.into_iter().chain(meshes.map(Source::Text));
    let texts = decks.map(|deck| {
        let (d, text) = messages(&deck);
        assert_eq!(d.count(Severity::Error), 1, "{text}");
        assert!(d.iter().all(|item| item.span.is_some()), "{text}");
        text
    });
    insta::assert_snapshot!(texts.collect::<Vec<_>>().join("\n"));
}

#[test]
fn fields_without_effect() {
    let law = |card: &str| model(&format!("*SURFACE INTERACTION, NAME=I\n{card}"));
    insta::assert_snapshot!(texts_of(
        Code::IgnoredParameter,
        &[
            law("*FRICTION\n0.3, 0.1"),
            law("*FRICTION\n0.3, , 5."),
            law("*FRICTION\n0.3, , , 20."),
            law("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n1.e-3, 2."),
            law("*SURFACE BEHAVIOR\n, 0.1"),
            model("*SURFACE INTERACTION, NAME=I\n0.5"),
            model("*SURFACE, NAME=S, TYPE=NODE\nFOOT, 0.5"),
            square("0.1, 1.", "0.1, 1., 1.e-3, 0.2"),
        ],
    ));
    let silent = [
        law("*FRICTION\n0.3, , ,"),
        model("*SURFACE INTERACTION, NAME=I\n1.,"),
        model("*SURFACE, NAME=S, TYPE=NODE\nFOOT, 1."),
        square("0.1, 1.", "0.1, 1., 1.e-3"),
        square("1000., 0.3", "1000., 0.3, 20.\n1000., 0.3, 100."),
        square("*DENSITY\n1.", "*DENSITY\n1., 20."),
    ];
    for deck in silent {
        assert_eq!(messages(&deck).1, "");
    }
}

#[test]
fn times_of_histories_are_read_though_histories_hold_every_increment() {
    for (when, code) in [
        ("FREQUENCY=often", Code::BadNumber),
        ("FREQUENCY=-1", Code::OutputTimes),
        ("TIME INTERVAL=-0.1", Code::OutputTimes),
        ("TIME POINTS=NEVER", Code::UndefinedName),
    ] {
        let (d, text) = messages(&step(&format!("*OUTPUT, HISTORY, {when}")));
        let codes: Vec<Code> = d.iter().map(|item| item.code).collect();
        assert_eq!(codes, [code], "{when}:\n{text}");
    }
    assert_eq!(messages(&step("*OUTPUT, HISTORY, FREQUENCY=3")).1, "");
}

#[test]
fn a_half_increment_residual_scales_the_tolerance_of_the_truncation_error() {
    let dynamic = |head: &str| {
        square(
            "*DYNAMIC, DIRECT\n0.1, 1.",
            &format!("*DYNAMIC{head}\n0.1, 1."),
        )
    };
    assert_eq!(messages(&dynamic("")).1, "");
    let fine = dynamic(", HALFINC SCALE FACTOR=500.");
    insta::assert_snapshot!(texts_of(Code::ScaledTolerance, &[fine]));
    for (half, direct) in [
        ("HAFTOL=3.", Code::BadIncrement),
        ("NOHAF", Code::IgnoredParameter),
    ] {
        let codes = |head: String| {
            let (d, _) = messages(&dynamic(&head));
            d.iter().map(|item| item.code).collect::<Vec<_>>()
        };
        assert_eq!(codes(format!(", {half}")), [Code::IgnoredParameter]);
        assert_eq!(codes(format!(", DIRECT, {half}")), [direct]);
    }
    let refused = [
        ", DIRECT, HALFINC SCALE FACTOR=2.",
        ", HALFINC SCALE FACTOR=0.",
        ", HALFINC SCALE FACTOR=1.E9",
    ];
    insta::assert_snapshot!(texts_of(Code::BadIncrement, &refused.map(dynamic)));
}

#[test]
fn locking_is_told_from_nu_045_on_in_plane_strain() {
    let deck = |kind: &str, nu: &str| Source::Text(SQUARE.replace("CPS4", kind).replace("0.3", nu));
    for (kind, nu, locks) in [
        ("CPE4", "0.449", false),
        ("CPE4", "0.45", true),
        ("CPE4", "0.499", true),
        ("CPS4", "0.499", false),
    ] {
        let (d, text) = messages(&deck(kind, nu));
        let place = d
            .iter()
            .find_map(|item| item.span.filter(|_| item.code == Code::Locking));
        assert_eq!(
            place.map(|span| (span.line, span.column)),
            locks.then_some((16, 8)),
            "{text}"
        );
    }
}

#[test]
fn magnitudes_that_cannot_be_computed_with() {
    let sized = |side: &str| {
        let nodes = "2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n";
        SQUARE.replace(nodes, &nodes.replace("1.", side))
    };
    let heavy = sized("100.").replace("1000.,", "1.e307,");
    let decks = [
        // the mass, the stiffness, the area, the length of a side of the element
        change(&heavy, "*DENSITY\n1.", "*DENSITY\n5.e304"),
        square("0.5\n", "1.e-320\n"),
        Source::Text(sized("1.e-200")),
        Source::Text(
            SQUARE
                .replace("4, 0., 1.\n", "4, 0., 1.7e308\n")
                .replace("1, 0., 0.\n", "1, 0., -1.e308\n"),
        ),
    ];
    insta::assert_snapshot!(texts_of(Code::Magnitude, &decks));
}

#[test]
fn starts_that_are_told_before_the_run() {
    let block = |height: &str| SHARED.replacen("11, 1., 1.1", &format!("11, 1., {height}"), 1);
    let upside_down = rigid(
        "START, 4., 1.\nLINE, 0., 1.\n",
        "",
        "*BOUNDARY\n100, 1, 2\n",
    );
    let far_below = rigid(
        "START, 0., 9.\nLINE, 4., 9.\n",
        "",
        "*BOUNDARY\n100, 1, 2\n",
    );
    let decks = [
        Source::Text(block("0.99")),
        upside_down,
        far_below,
        shared("EBASE, S3", "2, S2"),
    ];
    let texts = decks.map(|deck| {
        let text = messages(&deck).1;
        let about = |part: &&str| {
            ["[D410]", "[D414]", "[D418]"]
                .iter()
                .any(|code| part.contains(code))
        };
        text.split_inclusive("\n\n")
            .filter(about)
            .collect::<String>()
    });
    insta::assert_snapshot!(texts.join("\n"));
}

#[test]
fn one_faced_order_of_two_is_enough() {
    // the nodes of the base lie beside the block; those of the block face the base
    let both = SHARED.replacen("SBOT, STOP", "SBOT, STOP\nSTOP, SBOT", 1);
    let narrow = both
        .replace("11, 1., 1.1", "11, 2.2, 1.1")
        .replace("14, 1., 2.1", "14, 2.2, 2.1");
    let text = messages(&Source::Text(narrow.clone())).1;
    assert!(!text.contains("D414"), "{text}");
    let lone = narrow.replacen("SBOT, STOP\nSTOP, SBOT", "STOP, SBOT", 1);
    let text = messages(&Source::Text(lone)).1;
    assert!(text.contains("no node of STOP faces SBOT"), "{text}");
}

#[test]
fn a_reference_node_that_cannot_be_read_is_one_error() {
    let floor = rigid(LINE, "", "*BOUNDARY\n100, 1, 2\n");
    let Source::Text(floor) = floor else { return };
    for (old, new) in [
        ("100, 0., -5.", "1000000000, 0., -5."),
        ("100, 0., -5.", "x, 0., -5."),
    ] {
        let named = floor.replace("REF NODE=100", "REF NODE=REF");
        let named = named.replace("*BOUNDARY\n100,", "*BOUNDARY\nREF,");
        let (d, text) = messages(&change(&named, old, new));
        assert_eq!(d.count(Severity::Error), 1, "{text}");
    }
}

#[test]
fn increments_out_of_all_proportion() {
    let text = texts_of(
        Code::BadIncrement,
        &[
            square("0.1, 1.", "1e-300, 1."),
            square("0.1, 1.", "9e-13, 1."),
            square("0.1, 1.", "1e-200, 1e-199"),
        ],
    );
    let faults: Vec<&str> = text
        .lines()
        .filter(|line| line.starts_with("error"))
        .collect();
    assert_eq!(faults.len(), 3, "{text}");
    assert!(
        faults[..2]
            .iter()
            .all(|fault| fault.contains("out of all proportion")),
        "{text}"
    );
    assert!(faults[2].contains("beyond the range of numbers"), "{text}");
    assert!(text.contains("deck.inp:25:1"), "{text}");
    let (d, text) = messages(&square("0.1, 1.", "1e-12, 1."));
    assert!(!d.has_errors(), "{text}");
}

/// Where a deck has no elements at all, that is what it lacks, not each one that a set names.
#[test]
fn a_deck_without_elements_is_not_told_of_each_of_them() {
    let block = "*ELEMENT, TYPE=CPS4, ELSET=BODY\n7, 1, 2, 3, 4\n";
    let (d, text) = messages(&square(block, "*ELSET, ELSET=BODY\n7, 8\n"));
    let codes: Vec<Code> = d.iter().map(|item| item.code).collect();
    assert_eq!(codes, [Code::EmptyMesh], "{text}");
}

/// A deck of trusses alone says what becomes of line elements.
#[test]
fn a_deck_of_line_elements_is_told_that_there_are_no_trusses() {
    let block = "*ELEMENT, TYPE=CPS4, ELSET=BODY\n7, 1, 2, 3, 4\n";
    let (d, text) = messages(&square(block, "*ELEMENT, TYPE=T2D2, ELSET=BODY\n7, 1, 2\n"));
    let codes: Vec<Code> = d.iter().map(|item| item.code).collect();
    assert_eq!(codes, [Code::EmptyMesh], "{text}");
    assert!(text.contains("the deck has line elements only"), "{text}");
    assert!(text.contains("trusses and beams cannot be used"), "{text}");
}

/// Initial velocities have no effect before a static step; of other initial conditions nothing is said about velocities.
#[test]
fn only_velocities_have_no_effect_in_a_static_step() {
    let with = |kind: &str, row: &str| {
        let cards = format!("*INITIAL CONDITIONS, TYPE={kind}\n{row}\n*STEP\n*STATIC");
        messages(&square("*STEP, NLGEOM\n*DYNAMIC, DIRECT", &cards)).1
    };
    let said = "these velocities have no effect";
    let text = with("VELOCITY", "1, 1, 2.");
    assert!(text.contains(said), "{text}");
    for (kind, row, own) in [
        ("TEMPERATURE", "1, 20.", "the temperatures have no effect"),
        ("STRESS", "7, 1., 1., 0.", "cannot be used"),
    ] {
        let text = with(kind, row);
        assert!(text.contains(own) && !text.contains(said), "{text}");
    }
}
