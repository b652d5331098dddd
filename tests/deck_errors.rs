//! One deck and one golden text for every diagnostic code.

use std::path::Path;
use stickslip::contact::{adjust, report_adjusted, report_penetrations};
use stickslip::diagnostics::{Code, Diagnostic, Diagnostics, Severity, Sources};
use stickslip::{deck, reader};

const SQUARE: &str = include_str!("decks/square.inp");
const SHARED: &str = include_str!("decks/shared.inp");

const GENERAL: &str = "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n";
const PAIR: &str = "*CONTACT PAIR, INTERACTION=DRY, TYPE=NODE TO SURFACE\nSBOT, STOP\n";

/// A deck to be read.
enum Source {
    Text(String),
    File(&'static str),
}

/// Messages of a deck.
fn messages(source: &Source) -> (Diagnostics, String) {
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let deck = match source {
        Source::Text(text) => deck::parse_str("deck.inp", text, &mut sources, &mut d),
        Source::File(path) => deck::read(Path::new(path), &mut sources, &mut d),
    };
    let mut model = reader::build(&deck, &mut d);
    assert_eq!(model.is_some(), !d.has_errors());
    if let Some(model) = &mut model {
        let adjusted = adjust(model);
        report_adjusted(model, &adjusted, &mut d);
        if !d.has_errors() {
            report_penetrations(model, &mut d);
        }
    }
    let text = d.render(&sources, false);
    (d, text)
}

/// A deck with `old` replaced by `new`, once.
fn change(deck: &str, old: &str, new: &str) -> Source {
    assert!(deck.contains(old), "{old}");
    Source::Text(deck.replacen(old, new, 1))
}

/// The square with a change.
fn square(old: &str, new: &str) -> Source {
    change(SQUARE, old, new)
}

/// The square with further model cards.
fn model(more: &str) -> Source {
    square("*STEP", &format!("{more}\n*STEP"))
}

/// The square with further step cards.
fn step(more: &str) -> Source {
    square("*END STEP", &format!("{more}\n*END STEP"))
}

/// The block on its base with a change.
fn shared(old: &str, new: &str) -> Source {
    change(SHARED, old, new)
}

const LINE: &str = "START, 0., 0.\nLINE, 4., 0.\n";

/// The block above a rigid floor with these rows, further cards, and conditions in the step.
fn rigid(rows: &str, model: &str, step: &str) -> Source {
    let cards = format!(
        "*NODE, NSET=REF\n100, 0., -5.\n*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\n{rows}\
         *RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=100\n{model}{PAIR}"
    );
    let deck = SHARED.replacen(PAIR, &cards.replace("STOP", "FLOOR"), 1);
    change(&deck, "*DLOAD", &format!("{step}*DLOAD"))
}

/// A deck that has this fault.
fn faulty(code: Code) -> Source {
    use Code::*;
    match code {
        FileUnreadable => Source::File("tests/decks/missing_include.inp"),
        IncludeCycle => Source::File("tests/decks/cycle.inp"),
        UnknownKeyword => square("*BOUNDARY", "*BONDARY"),
        UnknownParameter => square("ELSET=BODY\n7", "ELST=BODY\n7"),
        RepeatedParameter => square("NSET=ALL", "NSET=ALL, NSET=ALL"),
        MissingParameter => square("*ELEMENT, TYPE=CPS4,", "*ELEMENT,"),
        BadValue => square("NLGEOM", "NLGEOM=PERHAPS"),
        BadNumber => square("2, 1., 0.", "2, 1.x, 0."),
        MissingField => square("FOOT, 1, 2", "FOOT"),
        ExtraField => square("3, 2, 4.", "3, 2, 4., 5."),
        StrayData => square("*HEADING", "one\n*HEADING"),
        MissingData => square("0.1, 1.\n", ""),
        BadName => square("NSET=ALL", "NSET=A&B"),
        EmptyDeck => Source::Text("** nothing\n\n".to_string()),
        OpenQuote => square("NSET=ALL", "NSET=\"ALL"),
        LongLine => square(
            "one square\n*NODE",
            &format!("one\n*NODE, {}", " ".repeat(260)),
        ),
        FortranNumber => square("1000.", "1.+3"),
        LongNumber => square("1000.", "0.10000000000000000000E+04"),
        Abbreviation => square("*ELASTIC", "*ELAS"),
        NonAscii => square("NAME=TOP", "NAME=TÖP"),
        UnsupportedKeyword => model("*TIE, NAME=GLUE\nTOP, TOP"),
        UnsupportedParameter => model("*AMPLITUDE, NAME=A, DEFINITION=SMOOTH STEP\n0., 0., 1., 1."),
        IgnoredKeyword => step("*CONTROLS, RESET"),
        IgnoredParameter => square("*DYNAMIC, DIRECT", "*DYNAMIC, DIRECT, ALPHA=-0.05"),
        WrongPlace => step("*MATERIAL, NAME=STEEL"),
        MissingEndStep => square("*END STEP\n", ""),
        StepStructure => square("*DYNAMIC, DIRECT\n0.1, 1.\n", ""),
        RepeatedCard => square("*DENSITY", "*DENSITY\n2.\n*DENSITY"),
        RepeatedNode => square("4, 0., 1.", "4, 0., 1.\n4, 0., 2."),
        NotPlanar => square("4, 0., 1.", "4, 0., 1., 0.5"),
        RepeatedElement => square("7, 1, 2, 3, 4", "7, 1, 2, 3, 4\n8, 2, 3, 4, 1"),
        UndefinedNode => square("1, 2\n", "1, 999\n"),
        UndefinedElement => model("*ELSET, ELSET=MORE\n7, 8"),
        UndefinedName => square("MATERIAL=RUBBER", "MATERIAL=RUBER"),
        RepeatedName => model("*SURFACE, NAME=top\nBODY, S1"),
        ElementType => square("CPS4", "CPS4R"),
        BadShape => square("7, 1, 2, 3, 4", "7, 1, 4, 3, 2"),
        UnusedNode => square("4, 0., 1.", "4, 0., 1.\n5, 9., 9.\n6, 9., 8."),
        BadRange => model("*NSET, NSET=ODD, GENERATE\n1, 4, 2"),
        SetCycle => model("*NSET, NSET=A\nB\n*NSET, NSET=B\nA"),
        NoSuchFace => square("BODY, S3", "BODY, S5"),
        InteriorFace => shared("EBASE, S3", "EBASE, S3\n1, S2"),
        RepeatedFace => square("BODY, S3", "BODY, S3\n7, S3"),
        EmptyMesh => Source::Text("*STEP, NLGEOM\n*DYNAMIC\n1., 1.\n*END STEP\n".to_string()),
        EmptySurface => model("*NSET, NSET=NONE\n*SURFACE, TYPE=NODE, NAME=S\nNONE"),
        IncompleteMaterial => square("*DENSITY\n1.\n", ""),
        MaterialRange => square("1000., 0.3", "1000., 0.5"),
        NoSection => square("*SOLID SECTION, ELSET=BODY, MATERIAL=RUBBER\n0.5\n", ""),
        TwoSections => model("*SOLID SECTION, ELSET=BODY, MATERIAL=RUBBER"),
        Locking => Source::Text(SQUARE.replace("CPS4", "CPE4").replace("0.3", "0.495")),
        ThicknessMismatch => shared(
            "ELSET=EBLOCK, MATERIAL=STEEL\n1.",
            "ELSET=EBLOCK, MATERIAL=STEEL\n2.",
        ),
        SurfaceUse => shared("SBOT, STOP", "SBOT, SBOT"),
        FrictionRange => shared("0.3, 2.1E5", "-0.3"),
        GeneralContact => shared("*CONTACT PAIR", &format!("{GENERAL}*CONTACT PAIR")),
        InitialPenetration => shared("11, 1., 1.1", "11, 1., 0.99"),
        UnitsHint => square("1000., 0.3", "1., 0.3"),
        RigidSurface => rigid(LINE, "", ""),
        NothingFaced => shared("EBASE, S3", "2, S2"),
        Magnitude => square("*DENSITY\n1.", "*DENSITY\n1.e-310"),
        Adjusted => shared("DRY, TYPE", "DRY, ADJUST=0.2, TYPE"),
        BadDof => square("FOOT, 1, 2", "FOOT, 1, 8"),
        ValueOutsideStep => square("FOOT, 1, 2", "FOOT, 1, 2, 0.1"),
        VelocityOnSupport => model("*INITIAL CONDITIONS, TYPE=VELOCITY\nALL, 2, -1."),
        RampedSupport => step("*BOUNDARY\n4, 1, 1, 0.1"),
        AmplitudeTable => model("*AMPLITUDE, NAME=A\n0., 0., 1., 1., 1., 0."),
        BadIncrement => square("0.1, 1.", "2., 1."),
        UnstableScheme => step("*STICKSLIP, SCHEME=SS22, THETA1=0.4"),
        BadDirection => step("*DLOAD\nBODY, GRAV, 9.81, 0., 0."),
        NoStep => Source::Text(SQUARE.split("*STEP").next().unwrap_or("").to_string()),
        OutputTimes => step("*OUTPUT, FIELD, FREQUENCY=1, TIME INTERVAL=0.1"),
        ShortIncrement => square("0.1, 1.", "0.3, 1."),
        NonlinearStep => square("*STEP, NLGEOM", "*STEP"),
        MixedOperation => step("*CLOAD, OP=NEW\n4, 2, 1."),
        ConflictingSupport => step("*BOUNDARY\n4, 1\n*BOUNDARY\n4, 1, 1, 0.1"),
        IgnoredVariable => square("U, RF", "U, PEEQ"),
        ConstantIncrement => square("*DYNAMIC, DIRECT\n0.1, 1.", "*DYNAMIC\n0.1, 1., 1.e-3, 0.2"),
    }
}

#[test]
fn golden_text_of_every_code() {
    for &code in Code::ALL {
        let (_, text) = messages(&faulty(code));
        assert!(text.contains(code.id()), "{} is not in:\n{text}", code.id());
        insta::assert_snapshot!(code.id(), text);
    }
}

#[test]
fn one_cause_one_message() {
    let lone = [
        Code::UnknownKeyword,
        Code::UnknownParameter,
        Code::BadNumber,
        Code::ElementType,
        Code::UndefinedNode,
        Code::UndefinedName,
        Code::MissingParameter,
        Code::FileUnreadable,
        Code::BadShape,
        Code::NoSuchFace,
        Code::StrayData,
    ];
    for code in lone {
        let (d, text) = messages(&faulty(code));
        assert_eq!(d.count(Severity::Error), 1, "{text}");
    }
}

#[test]
fn contacts_that_cannot_be() {
    let general = |more: &str| format!("{GENERAL}{more}");
    let pair = |adjust: &str, row: &str| {
        format!("*CONTACT PAIR, INTERACTION=DRY, TYPE=NODE TO SURFACE, {adjust}\n{row}\n")
    };
    let of_nodes = format!(
        "*SURFACE, NAME=S, TYPE=NODE\nNFIX\n{}",
        PAIR.replace("SBOT, STOP", "S")
    );
    let decks = [
        shared(PAIR, &of_nodes),
        shared(PAIR, &pair("ADJUST=-0.1", "SBOT, STOP")),
        shared(PAIR, &pair("ADJUST=NFOX", "SBOT, STOP")),
        shared(PAIR, &pair("ADJUST=0.1", "SBOT")),
        shared(
            PAIR,
            &pair(
                "ADJUST=1.2",
                "SALL, STOP
*SURFACE, NAME=SALL
EBLOCK",
            ),
        ),
        shared(PAIR, "*CONTACT\n"),
        shared(PAIR, "*CONTACT\n*CONTACT INCLUSIONS\n"),
        shared(PAIR, &general("SBOT, STOP\n")),
        shared(PAIR, &general("*CONTACT EXCLUSIONS\nSBOT, STOP\n")),
        shared(
            PAIR,
            &general("*CONTACT PROPERTY ASSIGNMENT\nSBOT, , DRY\n"),
        ),
        shared(PAIR, &general("*CONTACT PROPERTY ASSIGNMENT\n, , WET\n")),
        shared(PAIR, &general("*SURFACE, NAME=All_Exterior\nEBASE, S3\n")),
        shared(PAIR, &format!("*CONTACT INCLUSIONS, ALL EXTERIOR\n{PAIR}")),
        step(GENERAL.trim_end()),
    ];
    let texts = decks.map(|deck| {
        let (d, text) = messages(&deck);
        assert_eq!(d.count(Severity::Error), 1, "{text}");
        text
    });
    insta::assert_snapshot!(texts.join("\n"));
}

#[test]
fn only_nodes_in_other_bodies_penetrate_in_general_contact() {
    let general = |height: &str| {
        let deck = SHARED.replacen(PAIR, GENERAL, 1);
        let deck = deck.replacen("11, 1., 1.1", &format!("11, 1., {height}"), 1);
        messages(&change(&deck, "12, 3., 1.1", "12, 3., 1.")).0
    };
    let found = |d: &Diagnostics| {
        let about = |item: &&Diagnostic| item.code == Code::InitialPenetration;
        d.iter().find(about).map(|item| item.severity)
    };
    assert_eq!(found(&general("1.")), None, "bodies that touch");
    assert_eq!(found(&general("0.9995")), Some(Severity::Warning));
    assert_eq!(found(&general("0.99")), Some(Severity::Error));
}

#[test]
fn rigid_surfaces_that_cannot_be() {
    let fixed = "*BOUNDARY\n100, 1, 2\n";
    let profile = |rows: &str| rigid(rows, "", fixed);
    let decks = [
        profile("LINE, 4., 0.\n"),
        profile("START, 4., 0.\n"),
        profile("START, 4., 0.\nLINE, 4., 0.\n"),
        profile("START, 4., 0.\nCIRCL, 2., 1., 2., 0.\n"),
        profile("START, 4., 0.\nCIRCL, 0., 0., 2., 0.\n"),
        profile("START, 4., 0.\nPARAB, 1., 1., 2., 0.\n"),
        profile("START, 4., 0.\nLINEAR, 0., 0.\n"),
        profile("START, 4.\n"),
        profile("START, 4., 1.1\nLINE, 0., 1.1\n"),
        rigid(LINE, "", "*BOUNDARY\n100, 1\n"),
        rigid(LINE, "", "*BOUNDARY\n100, 1, 2\n100, 6, 6, 0.1\n"),
        rigid(
            LINE,
            "*RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=100\n",
            fixed,
        ),
        rigid(
            LINE,
            "*RIGID BODY, ANALYTICAL SURFACE=SBOT, REF NODE=100\n",
            fixed,
        ),
        rigid(LINE, "*RIGID BODY, ELSET=EBASE, REF NODE=100\n", fixed),
        rigid(LINE, "*CONTACT PAIR, INTERACTION=DRY\nFLOOR, SBOT\n", fixed),
        rigid(LINE, "*CONTACT PAIR, INTERACTION=DRY\nFLOOR\n", fixed),
        shared(
            PAIR,
            &format!("*SURFACE, NAME=R, TYPE=SEGMENTS\n{LINE}{PAIR}"),
        ),
        rigid(
            LINE,
            "*SURFACE, NAME=R, TYPE=SEGMENTS\nSTART, 0., 0.\nLINE, 1., 0.\n\
             *RIGID BODY, ANALYTICAL SURFACE=R, REF NODE=NFIX\n",
            fixed,
        ),
    ];
    let texts = decks.map(|deck| {
        let (d, text) = messages(&deck);
        assert_eq!(d.count(Severity::Error), 1, "{text}");
        text.split("error[").skip(1).collect::<String>()
    });
    insta::assert_snapshot!(texts.join("\n"));
}

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
            // names that nothing has, and a comma that is missing
            square(&format!("{set}=FOOT"), &format!("{set}=WHEEL")),
            square("FOOT, 1, 2", "FOOT 1, 2"),
            step("*BOUNDARY, AMPLITUDE=A\n4, 1"),
        ],
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
            square("1000., 0.3", "1000., 0.3, 20."),
            square("*DENSITY\n1.", "*DENSITY\n1., 20."),
            square("0.1, 1.", "0.1, 1., 1.e-3, 0.2"),
        ],
    ));
    let silent = [
        law("*FRICTION\n0.3, , ,"),
        model("*SURFACE INTERACTION, NAME=I\n1.,"),
        model("*SURFACE, NAME=S, TYPE=NODE\nFOOT, 1."),
        square("0.1, 1.", "0.1, 1., 1.e-3"),
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
fn increments_that_do_not_grow() {
    let dynamic = |row: &str| square("*DYNAMIC, DIRECT\n0.1, 1.", &format!("*DYNAMIC\n{row}"));
    insta::assert_snapshot!(texts_of(
        Code::ConstantIncrement,
        &[dynamic("0.1, 1., 1.e-3, 0.2"), dynamic("0.1, 1.")],
    ));
    for row in ["0.1, 1., 1.e-3, 0.1", "0.2, 1., , 0.1", "1., 1."] {
        assert_eq!(messages(&dynamic(row)).1, "");
    }
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
        let about = |part: &&str| part.contains("[D410]") || part.contains("[D414]");
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
fn follow_ups_of_a_reported_cause_are_not_reported() {
    for (old, new) in [
        ("*MATERIAL, NAME=RUBBER", "*MATERIAL"),
        ("*MATERIAL, NAME=RUBBER", "*MATERAIL, NAME=RUBBER"),
        ("*MATERIAL, NAME=RUBBER", "*MATERIAL, NAME=RUB&BER"),
        ("*ELASTIC", "*HYPERELASTIC"),
        ("*ELASTIC", "*ELASTIC, TYPE=LAMINA"),
        ("*NSET, NSET=FOOT", "*NSET, NSTE=FOOT"),
        ("*NSET, NSET=FOOT", "*NSET"),
        ("*NSET, NSET=FOOT", "*XYZZY, NSET=FOOT"),
        ("7, 1, 2, 3, 4", "7, 1, 2, x, 4"),
        ("7, 1, 2, 3, 4", "7, 1, 2, 9, 4"),
        ("7, 1, 2, 3, 4", "x, 1, 2, 3, 4"),
        ("7, 1, 2, 3, 4", "7, 4, 3, 2, 1"),
        ("TYPE=CPS4", "TYPE=CPS8"),
        ("TYPE=CPS4", "TYP=CPS4"),
        ("*ELEMENT", "*XYZZY"),
        ("*NODE, NSET=ALL", "*XYZZY, NSET=ALL"),
        ("*SURFACE, NAME=TOP", "*SURFACE, NAME=TOP, TYPE=SEGMENTS"),
        ("*SOLID SECTION", "*SHELL SECTION"),
        ("*SOLID SECTION", "*XYZZY"),
        ("*DYNAMIC, DIRECT", "*STATIC"),
        ("*DYNAMIC, DIRECT", "*XYZZY"),
        ("*STEP, NLGEOM", "*XYZZY"),
        ("*STEP, NLGEOM", "*STPE, NLGEOM"),
        ("*DENSITY\n1.", "*DENSITY\nx"),
        ("0.1, 1.", "0.1, x"),
        ("*STEP, NLGEOM\n", ""),
        (
            "*NODE, NSET=ALL\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n",
            "",
        ),
    ] {
        let (d, text) = messages(&square(old, new));
        assert_eq!(d.count(Severity::Error), 1, "{new}:\n{text}");
    }
}

#[test]
fn valid_decks_have_no_errors() {
    for deck in [SQUARE, SHARED] {
        let (d, text) = messages(&Source::Text(deck.to_string()));
        assert!(!d.has_errors(), "{text}");
    }
}

#[test]
fn all_errors_of_a_deck_in_one_run() {
    let deck = SQUARE
        .replace("2, 1., 0.", "2, 1., zero")
        .replace("1000., 0.3", "-1000., 0.3")
        .replace("FOOT, 1, 2", "FEET, 1, 2")
        .replace("3, 2, 4.", "3, 7, 4.")
        .replace("*DENSITY", "*DENISTY")
        .replace("0.1, 1.", "0.1");
    let (d, text) = messages(&Source::Text(deck));
    insta::assert_snapshot!(text);
    assert_eq!(d.count(Severity::Error), 6);
}

#[test]
fn an_included_file_is_named_with_the_line_that_includes_it() {
    let (_, text) = messages(&Source::File("tests/decks/faulty_include.inp"));
    assert!(
        text.contains("--> tests/decks/parts/faulty.inp:2:8"),
        "{text}"
    );
    assert!(
        text.contains("included from tests/decks/faulty_include.inp:3:17"),
        "{text}"
    );
}

#[test]
fn a_file_of_data_lines_holds_no_keyword() {
    let (d, text) = messages(&Source::File("tests/decks/keyword_in_rows.inp"));
    assert_eq!(
        d.iter().next().map(|item| item.code),
        Some(Code::WrongPlace),
        "{text}"
    );
    assert!(
        text.contains("--> tests/decks/parts/faulty.inp:1:1"),
        "{text}"
    );
}

#[test]
fn at_most_twenty_errors_are_shown() {
    let rows: String = (10..60).map(|node| format!("{node}, x, 0.\n")).collect();
    let (d, text) = messages(&square("1, 0., 0.\n", &format!("{rows}1, 0., 0.\n")));
    assert_eq!(d.count(Severity::Error), 50);
    assert_eq!(text.matches("error[D108]").count(), 20);
    assert!(text.contains("30 more"), "{text}");
}
