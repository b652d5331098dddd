//! One deck and one golden text for every diagnostic code.

#[path = "advice.rs"]
mod advice;
#[path = "checks.rs"]
mod checks;
#[path = "messages_page.rs"]
mod messages_page;

use std::path::Path;
use stickslip::diagnostics::{Code, Diagnostic, Diagnostics, Severity, Sources};
use stickslip::prepare::prepare;
use stickslip::{deck, reader};

const SQUARE: &str = include_str!("../decks/square.inp");
const SHARED: &str = include_str!("../decks/shared.inp");

const BLOCKS: &str = include_str!("../decks/cae_blocks.inp");

const GENERAL: &str = "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n";
const PAIR: &str = "*CONTACT PAIR, INTERACTION=DRY, TYPE=NODE TO SURFACE\nSBOT, STOP\n";

/// A deck to be read.
enum Source {
    Text(String),
    File(&'static str),
    /// One that a run goes on with from a checkpoint of the square.
    Resumed(String),
}

impl Source {
    /// The lines of the deck.
    fn text(&self) -> String {
        match self {
            Source::Text(text) | Source::Resumed(text) => text.clone(),
            Source::File(path) => std::fs::read_to_string(path).expect("a deck"),
        }
    }
}

/// Messages of a deck.
fn messages(source: &Source) -> (Diagnostics, String) {
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let deck = match source {
        Source::Text(text) => deck::parse_str("deck.inp", text, &mut sources, &mut d),
        Source::File(path) => deck::read(Path::new(path), &mut sources, &mut d),
        Source::Resumed(text) => {
            sources.add("deck.inp", text.clone(), None);
            let earlier = [("deck.inp".to_owned(), SQUARE.to_owned())];
            let change = deck::first_change(&earlier, &sources);
            d.push(change.expect("a change"));
            let text = d.render(&sources, false);
            return (d, text);
        }
    };
    let model = reader::build(&deck, &mut d);
    assert_eq!(model.is_some(), !d.has_errors());
    if let Some(model) = model {
        let prepared = prepare(model, &mut d);
        assert_eq!(prepared.is_some(), !d.has_errors());
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
        BadName => square("NSET=ALL", "NSET=A*B"),
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
        NotText => square("RUBBER", "RUB\0BER"),
        EndlessLine => square("one square", &"one square ".repeat(6000)),
        BadExpression => square("*MATERIAL", "*PARAMETER\nnu = 0.6*sin(30\n*MATERIAL"),
        UnknownValue => square("1000.", "<young>"),
        UnusedValue => square("*MATERIAL", "*PARAMETER\nyoung = 1e3\n*MATERIAL"),
        UnsupportedKeyword => model("*GAP, ELSET=BODY\n0.1"),
        UnsupportedParameter => model("*AMPLITUDE, NAME=A, DEFINITION=USER\n0., 0., 1., 1."),
        IgnoredKeyword => step("*CONTROLS, RESET"),
        IgnoredParameter => square("*DYNAMIC, DIRECT", "*DYNAMIC, DIRECT, ALPHA=-0.05"),
        WrongPlace => step("*MATERIAL, NAME=STEEL"),
        MissingEndStep => square("*END STEP\n", ""),
        StepStructure => square("*DYNAMIC, DIRECT\n0.1, 1.\n", ""),
        ChangedDeck => Source::Resumed(square("1000.", "1100.").text()),
        EarlierJob => square("*NODE", "*RESTART, READ, STEP=1\n*NODE"),
        RepeatedCard => square("*DENSITY", "*DENSITY\n2.\n*DENSITY"),
        AssemblyStructure => change(BLOCKS, "*End Part\n", ""),
        Placement => change(
            BLOCKS,
            "1.03125,           0.\n",
            "1.03125,           0.5\n",
        ),
        RepeatedNode => square("4, 0., 1.", "4, 0., 1.\n4, 0., 2."),
        NotPlanar => square("4, 0., 1.", "4, 0., 1., 0.5"),
        RepeatedElement => square("7, 1, 2, 3, 4", "7, 1, 2, 3, 4\n8, 2, 3, 4, 1"),
        UndefinedNode => square("1, 2\n", "1, 999\n"),
        UndefinedElement => model("*ELSET, ELSET=MORE\n7, 8"),
        UndefinedName => square("MATERIAL=RUBBER", "MATERIAL=RUBER"),
        RepeatedName => model("*SURFACE, NAME=top\nBODY, S1"),
        ElementType => square("CPS4", "CPS4RT"),
        BadShape => square("7, 1, 2, 3, 4", "7, 1, 4, 3, 2"),
        UnusedNode => square("4, 0., 1.", "4, 0., 1.\n5, 9., 9.\n6, 9., 8."),
        BadRange => model("*NSET, NSET=ODD, GENERATE\n1, 4, 2"),
        SetCycle => model("*NSET, NSET=A\nB\n*NSET, NSET=B\nA"),
        NoSuchFace => square("BODY, S3", "BODY, S5"),
        Revolution => square("CPS4", "CAX4\n9, 1, 2, 3, 4\n*ELEMENT, TYPE=CPS4"),
        AxisNode => square("CPS4", "CAX4"),
        InteriorFace => shared("EBASE, S3", "EBASE, S3\n1, S2"),
        RepeatedFace => square("BODY, S3", "BODY, S3\n7, S3"),
        EmptyMesh => Source::Text("*STEP, NLGEOM\n*DYNAMIC\n1., 1.\n*END STEP\n".to_string()),
        EmptySurface => model("*NSET, NSET=NONE\n*SURFACE, TYPE=NODE, NAME=S\nNONE"),
        LineElement => model("*ELEMENT, TYPE=T3D2, ELSET=CURVE\n8, 1, 3"),
        CoincidentNodes => square(
            "7, 1, 2, 3, 4",
            "7, 1, 2, 3, 4\n8, 5, 6, 7, 8\n*NODE\n5, 1., 0.\n6, 2., 0.\n7, 2., 1.\n8, 1., 1.",
        ),
        OverlappingElements => square(
            "7, 1, 2, 3, 4",
            "7, 1, 2, 3, 4\n*ELEMENT, TYPE=CPS3, ELSET=BODY\n8, 1, 2, 3",
        ),
        OverlappingBodies => square(
            "7, 1, 2, 3, 4",
            "7, 1, 2, 3, 4\n8, 5, 6, 7, 8\n*NODE\n5, 0.5, 0.5\n6, 2., 0.5\n7, 2., 2.\n8, 0.5, 2.",
        ),
        IncompleteMaterial => square("*DENSITY\n1.\n", ""),
        MaterialRange => square("1000., 0.3", "1000., 0.5"),
        NoDensity => Source::Text(
            SQUARE
                .replace("*DENSITY\n1.\n", "")
                .replace("*DYNAMIC", "*STATIC"),
        ),
        Incompressible => square("*ELASTIC\n1000., 0.3", "*HYPERELASTIC\n150., 50., 0."),
        NoSection => square("*SOLID SECTION, ELSET=BODY, MATERIAL=RUBBER\n0.5\n", ""),
        TwoSections => model("*SOLID SECTION, ELSET=BODY, MATERIAL=RUBBER"),
        Locking => Source::Text(SQUARE.replace("CPS4", "CPE4").replace("0.3", "0.495")),
        ThicknessMismatch => shared(
            "ELSET=EBLOCK, MATERIAL=STEEL\n1.",
            "ELSET=EBLOCK, MATERIAL=STEEL\n2.",
        ),
        SurfaceUse => shared("SBOT, STOP", "SBOT, SBOT"),
        BrakedFlight => shared("*DENSITY", "*DAMPING, ALPHA=2.\n*DENSITY"),
        FrictionRange => shared("0.3, 2.1E5", "-0.3"),
        GeneralContact => shared("*CONTACT PAIR", &format!("{GENERAL}*CONTACT PAIR")),
        InitialPenetration => shared("11, 1., 1.1", "11, 1., 0.99"),
        UnitsHint => square("1000., 0.3", "1., 0.3"),
        RigidSurface => rigid(LINE, "", ""),
        NothingFaced => shared("EBASE, S3", "2, S2"),
        Magnitude => square("*DENSITY\n1.", "*DENSITY\n1.e-310"),
        Adjusted => shared("DRY, TYPE", "DRY, ADJUST=0.2, TYPE"),
        FacingAway => shared("EBASE, S3", "EBASE, S1"),
        Tie => shared(PAIR, "*TIE, POSITION TOLERANCE=0.\nSBOT, STOP\n"),
        // the surface ends within the body
        PreTension => shared(
            "*BOUNDARY",
            "*NODE\n900, 0., 0.\n*SURFACE, NAME=CUT\n3, S3\n*PRE-TENSION SECTION, NODE=900, SURFACE=CUT\n*BOUNDARY",
        ),
        Interference => shared(
            "*DLOAD",
            "*CONTACT INTERFERENCE, SHRINK\nSTOP, STOP\n*DLOAD",
        ),
        ContactChange => shared(
            "*END STEP",
            "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nSTOP, SBOT\n*END STEP",
        ),
        Coupling => model("*MPC\nLINK, 1, 3"),
        BothOrders => {
            let nodes = "INTERACTION=DRY, TYPE=NODE TO SURFACE";
            Source::Text(on_each_other(26).replace("INTERACTION=DRY", nodes))
        }
        FixedSlave => shared("SBOT, STOP", "STOP, SBOT\n*BOUNDARY\n4, 1, 2\n5, 1, 2"),
        BadDof => square("FOOT, 1, 2", "FOOT, 1, 8"),
        ValueOutsideStep => square("FOOT, 1, 2", "FOOT, 1, 2, 0.1"),
        VelocityOnSupport => model("*INITIAL CONDITIONS, TYPE=VELOCITY\nALL, 2, -1."),
        RampedSupport => step("*BOUNDARY\n4, 1, 1, 0.1"),
        AmplitudeTable => model("*AMPLITUDE, NAME=A\n0., 0., 1., 1., 1., 0."),
        BadIncrement => square("0.1, 1.", "2., 1."),
        UnstableScheme => step("*STICKSLIP, SCHEME=SS22, THETA1=0.4"),
        SchemeOption => step("*STICKSLIP, SCHEME=SS22, LANDING=RETURN"),
        BadDirection => step("*DLOAD\nBODY, GRAV, 9.81, 0., 0."),
        NoStep => Source::Text(SQUARE.split("*STEP").next().unwrap_or("").to_string()),
        OutputTimes => step("*OUTPUT, FIELD, FREQUENCY=1, TIME INTERVAL=0.1"),
        ShortIncrement => square("0.1, 1.", "0.3, 1."),
        NonlinearStep => square("*STEP, NLGEOM", "*STEP"),
        MixedOperation => step("*CLOAD, OP=NEW\n4, 2, 1."),
        ConflictingSupport => step("*BOUNDARY\n4, 1\n*BOUNDARY\n4, 1, 1, 0.1"),
        IgnoredVariable => square("U, RF", "U, SDV1"),
        OutOfProportion => square("0.1, 1.", "1.e9, 1.e10"),
        NothingToDo => square("3, 2, 4.", "3, 2, 0."),
        ShortFeature => square(
            "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.1, 1.\n*CLOAD\n",
            "*AMPLITUDE, NAME=PULSE\n0., 0., 0.51, 0., 0.55, 1., 0.59, 0.\n\
             *STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.1, 1.\n*CLOAD, AMPLITUDE=PULSE\n",
        ),
        StartJump => square(
            "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.1, 1.\n",
            "*AMPLITUDE, NAME=SHIFT\n0., 1., 1., 1.\n\
             *STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.1, 1.\n*BOUNDARY, AMPLITUDE=SHIFT\n4, 1, 1, 0.1\n",
        ),
        BadEquation => model("*EQUATION\n2\n4, 1, 0., 3, 1, -1."),
        OwnIncrement => square("*DYNAMIC, DIRECT\n0.1, 1.", "*DYNAMIC\n, 1."),
        ScaledTolerance => square("*DYNAMIC, DIRECT", "*DYNAMIC, HALFINC SCALE FACTOR=500."),
    }
}

/// Two rows of so many elements, one on the other, with pairs in both orders.
pub fn on_each_other(elements: usize) -> String {
    let (mut nodes, mut faces) = (String::new(), [String::new(), String::new()]);
    for (row, faces) in faces.iter_mut().enumerate() {
        for i in 0..=elements {
            let (low, high) = (1000 * row + 2 * i + 1, 1000 * row + 2 * i + 2);
            nodes += &format!("{low}, {i}., {row}.\n{high}, {i}., {}.\n", row + 1);
            if i < elements {
                *faces += &format!("{low}, {low}, {}, {}, {high}\n", low + 2, high + 2);
            }
        }
    }
    let [below, above] = faces;
    format!(
        "*NODE\n{nodes}*ELEMENT, TYPE=CPE4, ELSET=BELOW\n{below}*ELEMENT, TYPE=CPE4, ELSET=ABOVE\n{above}\
         *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n\
         *SOLID SECTION, ELSET=BELOW, MATERIAL=M\n1.\n*SOLID SECTION, ELSET=ABOVE, MATERIAL=M\n1.\n\
         *SURFACE, NAME=TOP\nBELOW, S3\n*SURFACE, NAME=FOOT\nABOVE, S1\n\
         *SURFACE INTERACTION, NAME=DRY\n*FRICTION\n0.3\n*CONTACT PAIR, INTERACTION=DRY\nFOOT, TOP\nTOP, FOOT\n\
         *STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.1, 1.\n*DLOAD\nABOVE, GRAV, 10., 0., -1.\n*END STEP\n"
    )
}

#[test]
fn both_orders_of_pairs_are_told_where_they_cost_or_become_one() {
    let says = |deck: &str, what: &str| {
        let text = messages(&Source::Text(deck.to_owned())).1;
        assert_eq!(text.contains(what), text.contains("D427"), "{text}");
        text.contains(what)
    };
    let (one, two) = ("one order of each is taken", "keep one order of each pair");
    let with = |kind: &str| on_each_other(26).replace("INTERACTION=DRY", kind);
    let nodes = "INTERACTION=DRY, TYPE=NODE TO SURFACE";
    assert!(says(&on_each_other(26), one));
    assert!(says(&with(nodes), two));
    assert!(says(&with("INTERACTION=DRY, TYPE=SURFACE TO SURFACE"), one));
    assert!(says(&on_each_other(1), one));
    let few = on_each_other(20).replace("INTERACTION=DRY", nodes);
    assert!(!says(&few, two));
    assert!(!says(&with(nodes).replace("TOP, FOOT\n", ""), two));
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
fn the_catalogue_of_messages_is_up_to_date() {
    let texts = Code::ALL.iter().map(|&code| {
        let (deck, (_, message)) = (faulty(code), messages(&faulty(code)));
        messages_page::entry(code, &deck.text(), &message)
    });
    messages_page::check(&texts.collect::<String>());
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

/// General contact whose nodes are moved before the start.
fn initialized(parameters: &str, row: &str) -> String {
    format!(
        "*CONTACT INITIALIZATION DATA, NAME=FIT, {parameters}\n{GENERAL}\
         *CONTACT INITIALIZATION ASSIGNMENT\n{row}\n"
    )
}

#[test]
fn contacts_that_cannot_be() {
    let general = |more: &str| format!("{GENERAL}{more}");
    let pair = |adjust: &str, row: &str| {
        format!("*CONTACT PAIR, INTERACTION=DRY, TYPE=NODE TO SURFACE, {adjust}\n{row}\n")
    };
    let clearance =
        |pair: &str, names: &str| shared(PAIR, &format!("{pair}*CLEARANCE, SLAVE={names}\n"));
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
        shared(PAIR, &initialized("SEARCH ABOVE=-0.1", ", , FIT")),
        shared(PAIR, &initialized("ADJUST=NO", ", , FIT")),
        shared(
            PAIR,
            &initialized("INTERFERENCE FIT, INITIAL CLEARANCE=0.1", ", , FIT"),
        ),
        shared(PAIR, &initialized("ADJUST=YES", ", , FOT")),
        shared(PAIR, &initialized("ADJUST=YES", "SBOT, STOP, FIT")),
        step(&format!(
            "*END STEP\n*STEP\n*DYNAMIC, DIRECT\n0.001, 0.01\n{}",
            GENERAL.trim_end()
        )),
        clearance(PAIR, "STOP, MASTER=SBOT, VALUE=0."),
        clearance(PAIR, "SBOT, MASTER=STOP, VALUE=-0.1"),
        clearance(
            &pair("ADJUST=0.1", "SBOT, STOP"),
            "SBOT, MASTER=STOP, VALUE=0.",
        ),
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
fn magnitudes_that_overflow_together_are_errors_of_the_deck() {
    let found = |old: &str, new: &str| {
        let d = messages(&change(SHARED, old, new)).0;
        let wrong = d.iter().find(|item| item.severity == Severity::Error);
        let wrong = wrong.expect("an error");
        assert_eq!(wrong.code, Code::Magnitude);
        let what = wrong
            .message
            .split_once(" is inf")
            .expect("what is infinite");
        what.0.to_owned()
    };
    let density = "7.8E-9";
    assert_eq!(
        found(density, "1.7976931348623157e308"),
        "the mass of element 1"
    );
    let sum = "the mass of all elements up to element 3";
    assert_eq!(found(density, "3e307"), sum);
    let speed = "the wave speed of material STEEL";
    assert_eq!(found(density, "1e-308"), speed);
    let thick = "*SOLID SECTION, ELSET=EBASE, MATERIAL=STEEL\n1.";
    let thicker = "*SOLID SECTION, ELSET=EBASE, MATERIAL=STEEL\n1e304";
    assert_eq!(found(thick, thicker), "the stiffness E t of element 1");
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
        rigid(LINE, "", "*BOUNDARY\n100, 1, 2\nNFIX, 6, 6, 0.1\n"),
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
        rigid(
            LINE,
            "*RIGID BODY, ELSET=EBASE, REF NODE=100\n",
            "*BOUNDARY\n100, 1\n100, 2, 2, 0.5\n",
        ),
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

#[test]
fn a_circle_drawn_the_other_way_round_is_a_hole() {
    let circle = |points: [&str; 4]| {
        let rows = points
            .map(|point| format!("CIRCL, {point}, 0., -2.\n"))
            .concat();
        let start = points[3];
        rigid(
            &format!("START, {start}\n{rows}"),
            "",
            "*BOUNDARY\n100, 1, 6\n",
        )
        .text()
    };
    let slave = |deck: String| Source::Text(deck.replace("SBOT, FLOOR", "FLOOR, SBOT"));
    let (d, text) = messages(&slave(circle([
        "0., -1.", "1., -2.", "0., -3.", "-1., -2.",
    ])));
    assert!(!d.has_errors(), "{text}");
    let (_, text) = messages(&slave(circle([
        "0., -3.", "1., -2.", "0., -1.", "-1., -2.",
    ])));
    assert!(
        text.contains("[D407]: the rigid surface FLOOR cannot be slave: it is a hole"),
        "{text}"
    );
    assert!(text.contains("clockwise"), "{text}");
}

#[test]
fn follow_ups_of_a_reported_cause_are_not_reported() {
    for (old, new) in [
        ("*MATERIAL, NAME=RUBBER", "*MATERIAL"),
        ("*MATERIAL, NAME=RUBBER", "*MATERAIL, NAME=RUBBER"),
        ("*MATERIAL, NAME=RUBBER", "*MATERIAL, NAME=RUB&BER"),
        ("*ELASTIC", "*HYPERELASTIC"),
        ("*ELASTIC", "*ELASTIC, TYPE=LAMINA"),
        ("*ELASTIC", "*HYPERELASTIC, POLYNOMIAL, N=2"),
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
        ("*DYNAMIC, DIRECT", "*VISCO"),
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
