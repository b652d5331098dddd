//! Lines, fields, numbers and names: one small deck for each rule of the deck language, and the
//! faults that other codes accept.

use stickslip::deck::{self, Card, Deck};
use stickslip::diagnostics::{Code, Diagnostics, Severity, Sources, Span, Strictness};
use stickslip::model::{Curve, Model};
use stickslip::reader;

const SQUARE: &str = include_str!("../decks/square.inp");
const SHARED: &str = include_str!("../decks/shared.inp");

/// Cards and messages of a text.
fn parse(text: &str) -> (Deck, Diagnostics) {
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let deck = deck::parse_str("deck.inp", text, &mut sources, &mut d);
    (deck, d)
}

/// Codes of the messages, in the order they were found.
fn codes(d: &Diagnostics) -> Vec<Code> {
    d.iter().map(|item| item.code).collect()
}

/// Cards as text: keyword, parameters, rows of fields.
fn shape(deck: &Deck) -> Vec<String> {
    let one = |card: &Card| {
        let rows: Vec<String> = card
            .rows
            .iter()
            .map(|row| {
                let fields: Vec<&str> = row.fields().map(|field| field.text).collect();
                format!("[{}]", fields.join("|"))
            })
            .collect();
        format!("{}{}", card.title(), rows.join(""))
    };
    deck.cards.iter().map(one).collect()
}

/// The model and the messages of the square with `old` replaced by `new`.
fn square(old: &str, new: &str) -> (Option<Model>, Diagnostics) {
    assert!(SQUARE.contains(old), "{old}");
    build(&SQUARE.replacen(old, new, 1))
}

fn build(text: &str) -> (Option<Model>, Diagnostics) {
    let (deck, mut d) = parse(text);
    let model = reader::build(&deck, &mut d);
    (model, d)
}

/// Codes of the errors and warnings of the square with a change.
fn faults(old: &str, new: &str) -> Vec<Code> {
    let (_, d) = square(old, new);
    let serious = d.iter().filter(|item| item.severity != Severity::Note);
    serious.map(|item| item.code).collect()
}

/// The change must have no effect on the model or the messages.
fn same(old: &str, new: &str) {
    let (model, d) = square(old, new);
    assert_eq!(codes(&d), [], "{new}");
    assert_eq!(model, build(SQUARE).0, "{new}");
}

#[test]
fn comments_and_blank_lines_are_skipped() {
    same(
        "1, 0., 0.\n",
        "** one\n   ** two\n***NODE\n****** N O D E S ****\n\n  \n1, 0., 0.\n",
    );
}

#[test]
fn keyword_lines_may_be_indented() {
    let (deck, d) = parse("  *NODE , NSET = ALL \n 1 , 2. , 3. \n");
    assert_eq!(
        (shape(&deck), codes(&d)),
        (vec!["*NODE[1|2.|3.]".to_string()], vec![])
    );
    assert_eq!(deck.cards[0].value("NSET").map(|v| v.text), Some("ALL"));
}

#[test]
fn blanks_and_case_in_words_do_not_matter() {
    same("*END STEP", "*endstep");
    same("*SOLID SECTION", "*Solid Section");
    same("*NODE PRINT, NSET=FOOT", "*NodePrint, n set = foot");
    same("*ELEMENT, TYPE=CPS4", "*ELEMENT, TYPE = cps4");
}

#[test]
fn quoted_names_keep_case_and_blanks() {
    let quoted = SQUARE.replace("RUBBER", "\"Soft, red\"");
    let (model, d) = build(&quoted);
    assert_eq!(codes(&d), []);
    assert_eq!(
        model.map(|m| m.materials[0].name.clone()),
        Some("Soft, red".to_string())
    );
    assert_eq!(
        faults("MATERIAL=RUBBER", "MATERIAL=\"rubber\""),
        [Code::UndefinedName]
    );
    same("MATERIAL=RUBBER", "MATERIAL=\"RUBBER\"");
}

#[test]
fn long_lines_are_read_with_a_warning() {
    let long = format!("1, 0.{}, 0.\n", " ".repeat(300));
    let (model, d) = square("1, 0., 0.\n", &long);
    assert_eq!(codes(&d), [Code::LongLine]);
    assert!(model.is_some());
}

#[test]
fn keyword_lines_continue_after_a_comma() {
    same(
        "*ELEMENT, TYPE=CPS4, ELSET=BODY",
        "*ELEMENT,\n** comment\n TYPE=CPS4,\n ELSET=BODY",
    );
    same("*STEP, NLGEOM\n", "*STEP, NLGEOM,\n");
}

#[test]
fn numbers_that_a_comma_draws_into_a_keyword_line_are_one_error() {
    let card = "*ELEMENT, TYPE=CPS4, ELSET=BODY";
    assert_eq!(faults(card, &format!("{card},")), [Code::UnknownParameter]);
}

#[test]
fn element_lines_continue_until_complete() {
    same("7, 1, 2, 3, 4", "7, 1,\n2, 3,\n4");
    same("7, 1, 2, 3, 4", "7, 1\n2, 3\n4");
    assert_eq!(faults("7, 1, 2, 3, 4", "7, 1, 2, 3"), [Code::MissingField]);
    let (_, d) = square("7, 1, 2, 3, 4", "6, 1, 2, 3\n7, 1, 2, 3, 4");
    assert_eq!(codes(&d), [Code::MissingField]);
}

#[test]
fn trailing_commas_are_no_field() {
    same("1000., 0.3\n", "1000., 0.3,\n");
    same("FOOT, 1, 2\n", "FOOT, 1, 2,\n");
    same("1, 2\n", "1, 2, \n");
}

#[test]
fn a_lone_comma_is_a_row_of_defaults_and_an_empty_line_is_none() {
    let (deck, _) = parse("*SOLID SECTION, ELSET=A, MATERIAL=B\n,\n\n*NODE\n1,,2.\n");
    assert_eq!(shape(&deck), ["*SOLID SECTION[]", "*NODE[1||2.]"]);
    assert_eq!(deck.cards[0].rows.iter().count(), 1);
    let (model, d) = square("0.5\n", ",\n");
    assert_eq!(
        (model.map(|m| m.sections[0].thickness), codes(&d)),
        (Some(1.0), vec![])
    );
}

#[test]
fn empty_fields_have_defaults_unless_required() {
    same("1, 0., 0.\n", "1\n");
    same("2, 1., 0.\n", "2, 1.,\n");
    assert_eq!(faults("2, 1., 0.", ", 1., 0."), [Code::MissingField]);
}

#[test]
fn line_ends_byte_order_mark_and_tabs() {
    for text in [
        SQUARE.replace('\n', "\r\n"),
        format!("\u{feff}{SQUARE}"),
        SQUARE.replace(", ", ",\t"),
        SQUARE.trim_end().to_string(),
        SQUARE.replace("*NODE, NSET", "\t*NODE, NSET"),
    ] {
        let (model, d) = build(&text);
        assert_eq!(codes(&d), []);
        assert_eq!(model, build(SQUARE).0);
    }
}

#[test]
fn other_letters_pass_in_comments_and_headings() {
    let text = SQUARE
        .replace("one square", "ein Würfel")
        .replace("*NODE,", "** Länge\n*NODE,");
    let (model, d) = build(&text);
    assert_eq!(codes(&d), []);
    assert_eq!(model.map(|m| m.title), Some("ein Würfel".to_string()));
}

#[test]
fn a_missing_end_of_step_is_mentioned() {
    let (model, d) = square("*END STEP\n", "");
    assert_eq!(codes(&d), [Code::MissingEndStep]);
    assert_eq!(model, build(SQUARE).0);
}

#[test]
fn unique_beginnings_are_read_with_a_warning() {
    assert_eq!(faults("*BOUNDARY", "*BOUN"), [Code::Abbreviation]);
    assert_eq!(
        faults("*ELEMENT, TYPE=CPS4, ELSET", "*ELEMENT, TYPE=CPS4, ELSE"),
        [Code::Abbreviation]
    );
    assert_eq!(faults("*BOUNDARY", "*BOU"), [Code::UnknownKeyword]);
    // FREQUENCYF begins with FREQUENCY
    let request = |name: &str| format!("*NODE FILE, {name}=2\nU\n*END STEP");
    assert_eq!(faults("*END STEP", &request("FREQ")), [Code::Abbreviation]);
}

#[test]
fn names_may_have_the_characters_of_other_programs() {
    let text = SQUARE
        .replace("NSET=ALL", "NSET=_PICKED;2_#1")
        .replace("\nALL,", "\n_PICKED;2_#1,");
    assert_eq!(codes(&build(&text).1), []);
}

#[test]
fn words_with_a_tail_are_unknown() {
    assert_eq!(faults("*BOUNDARY", "*BOUNDARYXYZ"), [Code::UnknownKeyword]);
    assert_eq!(
        faults("*NODE PRINT", "*NODE PRINTXYZ"),
        [Code::UnknownKeyword]
    );
}

#[test]
fn repeated_and_unknown_parameters() {
    assert_eq!(
        faults("NSET=ALL", "NSET=ALL, NSET=B"),
        [Code::RepeatedParameter]
    );
    assert_eq!(
        faults("NSET=ALL", "NSET=ALL, COLOUR=RED"),
        [Code::UnknownParameter]
    );
}

#[test]
fn lenient_reading_leaves_out_what_is_unknown() {
    let (mut sources, mut d) = (
        Sources::new(),
        Diagnostics::with_strictness(Strictness::Lenient),
    );
    let text = SQUARE
        .replace("*BOUNDARY", "*BONDARY")
        .replace("NSET=ALL", "NSET=ALL, COLOUR=RED");
    let deck = deck::parse_str("deck.inp", &text, &mut sources, &mut d);
    let model = reader::build(&deck, &mut d);
    assert_eq!(codes(&d), [Code::UnknownParameter, Code::UnknownKeyword]);
    assert_eq!(model.map(|m| m.steps[0].supports.len()), Some(0));
}

#[test]
fn strict_reading_stops_at_warnings() {
    let (mut sources, mut d) = (
        Sources::new(),
        Diagnostics::with_strictness(Strictness::Strict),
    );
    let text = SQUARE.replace("*BOUNDARY", "*BOUN");
    let deck = deck::parse_str("deck.inp", &text, &mut sources, &mut d);
    assert_eq!(reader::build(&deck, &mut d), None);
}

#[test]
fn real_numbers_in_every_form() {
    for form in [
        "1000",
        "1.D3",
        "1E3",
        "1.e+03",
        "+.1d4",
        "0.10000000000000000000E+04",
    ] {
        let (model, _) = square("1000., 0.3", &format!("{form}, 0.3"));
        assert_eq!(
            model.map(|m| m.materials[0].law.small_strain().young),
            Some(1000.0),
            "{form}"
        );
    }
    assert_eq!(faults("1000., 0.3", "1.+3, 0.3"), [Code::FortranNumber]);
    for form in ["nan", "inf", "0x1", "1_000", "1e", "1e999", "1 000"] {
        assert_eq!(
            faults("1000., 0.3", &format!("{form}, 0.3")),
            [Code::BadNumber],
            "{form}"
        );
    }
}

#[test]
fn integers_are_not_reals() {
    assert_eq!(faults("7, 1, 2, 3, 4", "7, 1., 2, 3, 4"), [Code::BadNumber]);
    assert_eq!(faults("FOOT, 1, 2", "FOOT, 1., 2"), [Code::BadNumber]);
    assert_eq!(faults("7, 1, 2", "-7, 1, 2"), [Code::BadNumber]);
}

#[test]
fn names_have_limits_and_name_spaces() {
    let long = "N".repeat(81);
    assert_eq!(faults("NSET=ALL", &format!("NSET={long}")), [Code::BadName]);
    assert_eq!(faults("NSET=ALL", "NSET=12"), [Code::BadName]);
    assert_eq!(faults("NSET=ALL", "NSET=0\"ALL\""), [Code::BadName]);
    let cae = SQUARE
        .replace("TOP", "_Surf-1_S3")
        .replace("ELSET=BODY", "ELSET=FOOT")
        .replace("BODY, S3", "FOOT, S3");
    let (model, d) = build(&cae);
    assert_eq!(codes(&d), []);
    assert!(model.is_some());
}

#[test]
fn cards_in_any_order() {
    let (head, step) = SQUARE.split_at(SQUARE.find("*STEP").unwrap_or(0));
    let (mesh, rest) = head.split_at(head.find("*SURFACE").unwrap_or(0));
    let (model, d) = build(&format!("{rest}{mesh}{step}"));
    assert_eq!(codes(&d), []);
    assert_eq!(model, build(SQUARE).0);
}

#[test]
fn a_missing_increment_comes_with_a_guide_wherever_the_mesh_lies() {
    let (old, new) = (
        "*DYNAMIC, DIRECT\n0.1, 1.",
        "*DYNAMIC, DIRECT, EXPLICIT\n, 1.",
    );
    let nodes = "1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n";
    let moved = "1, 5., -3.\n2, 6., -3.\n3, 6., -2.\n4, 5., -2.\n";
    for text in [SQUARE.to_owned(), SQUARE.replace(nodes, moved)] {
        let (_, d) = build(&text.replace(old, new));
        assert_eq!(codes(&d), [Code::IgnoredParameter, Code::MissingField]);
        let help = d.iter().filter_map(|item| item.help.as_deref()).last();
        assert_eq!(
            help,
            Some("a wave crosses the shortest element side in 3.02e-2")
        );
    }
    assert!(SQUARE.contains(nodes));
}

/// Fields of the times of a step that are empty or zero have their defaults.
#[test]
fn empty_and_zero_times_have_defaults() {
    let increments = |card: &str, row: &str| {
        let text = SQUARE.replace("*DYNAMIC, DIRECT\n0.1, 1.\n", &format!("{card}\n{row}"));
        let (model, d) = build(&text);
        let model = model.unwrap_or_else(|| panic!("{card} {row}: {:?}", codes(&d)));
        let times = model.steps[0].increments;
        [times.dt, times.period, times.dt_min, times.dt_max]
    };
    let whole = [1.0, 1.0, 1e-5, 1.0];
    for row in [
        "",
        ",\n",
        ", 1.\n",
        "0., 0., 0., 0.\n",
        "1., , ,\n",
        ", , , \n",
    ] {
        assert_eq!(increments("*STATIC", row), whole, "{row}");
    }
    assert_eq!(increments("*STATIC", ", 4.\n"), [4.0, 4.0, 4e-5, 4.0]);
    assert_eq!(
        increments("*STATIC", "0.5, , , 0.25\n"),
        [0.25, 1.0, 1e-5, 0.25]
    );
    assert_eq!(
        increments("*DYNAMIC", "1E-3, 1., 0., 0.\n"),
        increments("*DYNAMIC", "1E-3, 1.\n")
    );
    // the side 1 over the speed of waves, but between 1e-5 and 0.1 of the duration
    let [own, ..] = increments("*DYNAMIC", ", 1.\n");
    assert!((own - 0.030_166).abs() < 1e-5, "{own}");
    assert_eq!(increments("*DYNAMIC", "0., 0.1\n")[0], 0.1 * 0.1);
    assert_eq!(increments("*DYNAMIC, EXPLICIT", ", 1E5\n")[0], 1e-5 * 1e5);
    assert_eq!(
        increments("*DYNAMIC, APPLICATION=QUASI-STATIC", ", 2.\n")[0],
        0.2
    );
}

/// Soft laws of contact and its damping are left out with a warning; the model is that of hard contact.
#[test]
fn soft_contact_is_taken_as_hard() {
    let hard = SHARED.replace(
        "PRESSURE-OVERCLOSURE=LINEAR\n2.1E7, 0.1, 1.E-3",
        "PRESSURE-OVERCLOSURE=HARD",
    );
    // without the places of the contacts
    let model = |text: &str| {
        let (model, d) = build(text);
        let mut model = model.expect("no errors");
        model
            .contacts
            .iter_mut()
            .for_each(|contact| contact.span = Span::default());
        (model, codes(&d).len())
    };
    let (hard_model, before) = model(&hard);
    for law in [
        "EXPONENTIAL\n1.E-4, 50.",
        "TABULAR\n0., 0.\n10., 1.E-4\n50., 2.E-4",
        "SCALE FACTOR\n0.1, 2.",
        "LINEAR\n1.E5",
    ] {
        let (soft, count) = model(&hard.replace("OVERCLOSURE=HARD", &format!("OVERCLOSURE={law}")));
        assert_eq!(count, before + 1, "{law}");
        assert_eq!(soft, hard_model, "{law}");
    }
    let damping = "*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT\n1., 0.1\n*FRICTION";
    let damped = model(&hard.replacen("*FRICTION", damping, 1));
    assert_eq!(damped, (hard_model, before + 1));
}

/// Quadrilaterals with two corners at one node are the triangles of these nodes, with the sides of the quadrilaterals.
#[test]
fn collapsed_quadrilaterals_are_triangles() {
    let element = "*ELEMENT, TYPE=CPS4, ELSET=BODY\n7, 1, 2, 3, 4\n";
    let load = "*END STEP";
    assert!(SQUARE.contains(element) && SQUARE.contains("BODY, S3"));
    let of = |kind: &str, rows: &str, top: &str, left: &str| {
        let elements = format!("*ELEMENT, TYPE={kind}, ELSET=BODY\n{rows}");
        let text = SQUARE
            .replacen(element, &elements, 1)
            .replacen("BODY, S3", top, 1)
            .replacen(load, &format!("*DLOAD\n8, {left}, 2.\n{load}"), 1);
        let (model, d) = build(&text);
        (model, codes(&d))
    };
    let (triangles, _) = of("CPS3", "7, 3, 1, 2\n8, 4, 1, 3\n", "8, S3", "P1");
    assert!(triangles.is_some());
    for kind in ["CPS4", "CPS4R", "CPS4I"] {
        let (collapsed, codes) = of(kind, "7, 1, 2, 3, 3\n8, 1, 3, 4, 4\n", "8, S2", "P4");
        assert_eq!(collapsed, triangles, "{kind}");
        assert!(codes.contains(&Code::BadShape), "{codes:?}");
    }
    // the side of no length, corners across each other, and triangles that are none
    for (kind, rows, top) in [
        ("CPS4", "7, 1, 2, 3, 3\n8, 1, 3, 4, 4\n", "8, S3"),
        ("CPS4", "7, 1, 2, 3, 3\n8, 1, 3, 1, 4\n", "8, S2"),
        ("CPE4H", "7, 1, 2, 3, 3\n8, 1, 3, 4, 4\n", "8, S2"),
    ] {
        assert!(of(kind, rows, top, "P4").0.is_none(), "{kind} {rows}");
    }
}

/// Words of Abaqus from 2022 on.
#[test]
fn secondary_and_main_are_slave_and_master() {
    let clearance = |words: &str| {
        let card = format!("*CLEARANCE, {words}, VALUE=0.05\n*BOUNDARY");
        build(&SHARED.replacen("*BOUNDARY", &card, 1)).0
    };
    let old = clearance("SLAVE=SBOT, MASTER=STOP");
    assert!(old.is_some());
    assert_eq!(clearance("SECONDARY=SBOT, MAIN=STOP"), old);
    assert_eq!(clearance("main=stop, Slave=sbot"), old);
    assert!(clearance("SLAVE=SBOT, SECONDARY=SBOT, MAIN=STOP").is_none());
}

/// Requests of output that are not known are left out: the model is the same.
#[test]
fn output_that_is_not_known_never_stops_a_deck() {
    let (plain, _) = build(SQUARE);
    assert!(plain.is_some());
    let unknown = [
        ("*CONTACT PRINT, SET=ALL\nCDIS", Code::UnknownParameter),
        ("*CONTACT PRINT, TOTALS\nCDIS", Code::IgnoredVariable),
        ("*ELEMENT PRINT, ELSET=BODY\nS", Code::UnknownKeyword),
        ("*Node Field Output\nU", Code::UnknownKeyword),
        ("*OUTPUT, FIELD, TIME MARX=NO", Code::UnknownParameter),
        (
            "*ENERGY OUTPUT, PER SET=BODY\nALLSE",
            Code::UnknownParameter,
        ),
        ("*NODE FILE, OUTPUT\nU", Code::IgnoredParameter),
        ("*EL FILE, POSITION=SOMEWHERE\nS", Code::BadValue),
        ("*EL FILE, POSITION\nS", Code::BadValue),
        (
            "*SECTION PRINT, SURFACE=TOP, NAME=P\nSOF",
            Code::IgnoredKeyword,
        ),
    ];
    for (request, code) in unknown {
        let text = SQUARE.replacen("*END STEP", &format!("{request}\n*END STEP"), 1);
        let (model, d) = build(&text);
        assert_eq!(model, plain, "{request}");
        assert!(
            codes(&d).iter().all(|known| *known == code),
            "{request}: {:?}",
            codes(&d)
        );
    }
    // what names the keyword of a physical card, or a keyword of one word, is an error as ever
    for request in [
        "*CLAOD\n4, 1, 1.",
        "*FILES\nU",
        "*CLOAD, FRQUENCY=1\n4, 1, 1.",
    ] {
        let text = SQUARE.replacen("*END STEP", &format!("{request}\n*END STEP"), 1);
        assert!(build(&text).0.is_none(), "{request}");
    }
}

#[test]
fn output_requests_of_both_families_are_silent() {
    for request in [
        "*Output, field, variable=PRESELECT, time marks=NO\n*Element Output, directions=YES\nE, S11",
        "*Output, history, variable=PRESELECT\n*Energy Output\nALLKE,",
        "*Output, field\n*Contact Output, slave=TOP, master=TOP\nCSTRESS,",
        "*EL FILE, DIRECTIONS=NO, POSITION=CENTROIDAL\nS",
        "*NODE FILE, OUTPUT=2D, GLOBAL=YES, CONTACT ELEMENTS, LAST ITERATIONS\nU, RF",
        "*CONTACT FILE, LAST ITERATIONS\nCDIS, CSTR",
        "*NODE PRINT, NSET=FOOT, SUMMARY=NO, GLOBAL=NO\nRF",
        "*EL PRINT, FREQUENCY=0",
        "*NODE PRINT, FREQUENCY=0",
        "*CONTACT PRINT, TOTALS=YES\nCF",
    ] {
        same("*END STEP", &format!("{request}\n*END STEP"));
    }
    let history = "*EL PRINT, ELSET=BODY, TOTALS=ONLY, SUMMARY=YES, POSITION=CENTROIDAL\nELSE\n";
    assert_eq!(faults("*END STEP", &format!("{history}*END STEP")), []);
}

#[test]
fn numbers_beyond_the_eighth_of_a_line_are_read_with_a_warning() {
    let line = |card: &str, count: usize| {
        let numbers: Vec<String> = (0..count).map(|i| format!("{i}.")).collect();
        let card = format!("{card}\n{}\n*STEP", numbers.join(", "));
        let (model, d) = square("*STEP", &card);
        let amplitude = model.and_then(|model| model.amplitudes.first().cloned());
        (codes(&d), amplitude.map(|amplitude| amplitude.curve))
    };
    let spaced = "*AMPLITUDE, NAME=A, DEFINITION=EQUALLY SPACED, FIXED INTERVAL=1.";
    for card in ["*AMPLITUDE, NAME=A", spaced, "*TIME POINTS, NAME=A"] {
        assert_eq!(line(card, 8).0, [], "{card}");
        assert_eq!(line(card, 10).0, [Code::LongLine], "{card}");
    }
    let five = (0..5).map(|i| f64::from(2 * i)).map(|t| (t, t + 1.0));
    assert_eq!(
        line("*AMPLITUDE, NAME=A", 10).1,
        Some(Curve::Linear(five.collect()))
    );
}

#[test]
fn fields_on_request() {
    let fields = |request: &str| {
        let (model, d) = square("*END STEP", &format!("{request}\n*END STEP"));
        assert_eq!(codes(&d), [], "{request}");
        let asked = model.map(|model| model.sets.fields);
        asked.map(|asked| {
            [
                asked.concentrated_load,
                asked.energy_density,
                asked.logarithmic_strain,
                asked.principal_stress,
                asked.pressure,
            ]
        })
    };
    let elements = "*OUTPUT, FIELD\n*ELEMENT OUTPUT\nS, ENER, LE\n";
    assert_eq!(fields(elements), Some([false, true, true, false, false]));
    let principal = "*EL FILE\nSP2, PRESS\n";
    assert_eq!(fields(principal), Some([false, false, false, true, true]));
    let loads = Some([true, false, false, false, false]);
    assert_eq!(fields("*NODE FILE\nU, CF"), loads);
    assert_eq!(fields("*CONTACT FILE\nCF"), Some([false; 5]));
    let history = "*OUTPUT, HISTORY\n*ELEMENT OUTPUT, ELSET=BODY\nLE";
    assert_eq!(fields(history), Some([false; 5]));
    for unwritten in ["*CONTACT FILE\nCSHEAR1", "*CONTACT PRINT\nCAREA"] {
        let found = faults("*END STEP", &format!("{unwritten}\n*END STEP"));
        assert_eq!(found, [Code::IgnoredVariable]);
    }
}

#[test]
fn histories_of_everything_are_not_written() {
    for request in ["*EL PRINT\nELSE", "*NODE PRINT\nU"] {
        let found = faults("*END STEP", &format!("{request}\n*END STEP"));
        assert_eq!(found, [Code::IgnoredVariable], "{request}");
    }
}

#[test]
fn parameters_without_effect_are_mentioned() {
    let card = "*STICKSLIP, THETA1=0.7\n*CLOAD";
    assert_eq!(faults("*CLOAD", card), [Code::IgnoredParameter]);
    let card = "*DSLOAD, FOLLOWER=NO\nTOP, P, 1.\n*CLOAD";
    assert_eq!(faults("*CLOAD", card), [Code::IgnoredParameter]);
}

#[test]
fn a_contact_given_twice_is_refused() {
    let text = include_str!("../decks/shared.inp").replace("SBOT, STOP", "SBOT, STOP\nSTOP, SBOT");
    assert!(build(&text).0.is_some());
    let (_, d) = build(&text.replace("STOP, SBOT", "SBOT, STOP"));
    assert!(codes(&d).contains(&Code::SurfaceUse));
}

/// Every rule of lines as a deck of about three lines, the cards it is read as, and its messages.
#[test]
fn rules_of_lines_by_their_cards() {
    use Code::{
        Abbreviation, LongLine, NonAscii, RepeatedParameter, UnknownKeyword, UnknownParameter,
    };
    let long = format!("*NODE\n1,{}2.", " ".repeat(256));
    let rules: [(&str, &str, &[&str], &[Code]); 24] = [
        ("comment", "** a\n*NODE\n1, 2.", &["*NODE[1|2.]"], &[]),
        (
            "indented comment",
            "*NODE\n  ** a\n1, 2.",
            &["*NODE[1|2.]"],
            &[],
        ),
        (
            "three stars",
            "***NODE\n*NODE\n1, 2.",
            &["*NODE[1|2.]"],
            &[],
        ),
        (
            "heading of Gmsh",
            "******* N O D E S *****\n*NODE\n1",
            &["*NODE[1]"],
            &[],
        ),
        ("indented keyword", "\t *NODE\n1, 2.", &["*NODE[1|2.]"], &[]),
        (
            "blanks in words",
            "*EN DST EP\n*E L SET, EL SET=A",
            &["*END STEP", "*ELSET"],
            &[],
        ),
        (
            "case",
            "*node\n1, 2.\n*eNdStEp",
            &["*NODE[1|2.]", "*END STEP"],
            &[],
        ),
        ("long line", &long, &["*NODE[1|2.]"], &[LongLine]),
        (
            "keyword goes on",
            "*NODE,\nNSET=A\n1, 2.",
            &["*NODE[1|2.]"],
            &[],
        ),
        (
            "after a comment",
            "*NODE,\n** a\nNSET=A\n1",
            &["*NODE[1]"],
            &[],
        ),
        (
            "not into a keyword",
            "*NODE,\n*NODE\n1",
            &["*NODE", "*NODE[1]"],
            &[],
        ),
        (
            "data goes on",
            "*ELSET, ELSET=A\n1,\n2",
            &["*ELSET[1][2]"],
            &[],
        ),
        (
            "last comma",
            "*ELSET, ELSET=A\n1, 2, \n",
            &["*ELSET[1|2]"],
            &[],
        ),
        (
            "lone comma",
            "*SOLID SECTION\n,",
            &["*SOLID SECTION[]"],
            &[],
        ),
        ("empty line", "*NODE\n\n1, 2.\n \n", &["*NODE[1|2.]"], &[]),
        ("empty field", "*NODE\n1,, 2.", &["*NODE[1||2.]"], &[]),
        ("CRLF", "*NODE\r\n1, 2.\r\n", &["*NODE[1|2.]"], &[]),
        (
            "byte order mark",
            "\u{feff}*NODE\n1, 2.",
            &["*NODE[1|2.]"],
            &[],
        ),
        ("tabs", "*NODE\n\t1,\t2.\t", &["*NODE[1|2.]"], &[]),
        (
            "letters",
            "** \u{e4}\n*NODE, NSET=\u{e4}\n1",
            &["*NODE[1]"],
            &[NonAscii],
        ),
        (
            "beginning of a word",
            "*ELAS\n1., 0.",
            &["*ELASTIC[1.|0.]"],
            &[Abbreviation],
        ),
        (
            "repeated parameter",
            "*NODE, NSET=A, NSET=B\n1",
            &["*NODE[1]"],
            &[RepeatedParameter],
        ),
        (
            "unknown parameter",
            "*NODE, SET=A\n1",
            &["*NODE[1]"],
            &[UnknownParameter],
        ),
        (
            "unknown keyword",
            "*NODDE\n1",
            &["*NODE[1]"],
            &[UnknownKeyword],
        ),
    ];
    for (rule, text, cards, messages) in rules {
        let (deck, d) = parse(text);
        assert_eq!(shape(&deck), cards, "{rule}");
        assert_eq!(codes(&d), messages, "{rule}");
    }
}

#[test]
fn forms_of_numbers() {
    let forms = [
        ("1.5D-5", 1.5e-5),
        ("1.5d-5", 1.5e-5),
        ("+.5e+3", 500.0),
        (".5", 0.5),
        ("1.", 1.0),
        ("-.5e3", -500.0),
        ("7", 7.0),
        ("0.1234567890123456789E-05", 0.123_456_789_012_345_68e-5),
        ("1.5-5", 1.5e-5),
        ("1.5+5", 1.5e5),
    ];
    for (form, value) in forms {
        let (deck, mut d) = parse(&format!("*NODE\n1, {form}"));
        let row = deck.cards[0].rows.first().expect("a row");
        let field = row.get(1).expect("a field");
        assert_eq!(field.real(&mut d), Some(value), "{form}");
        let letterless = form.contains("5-") || form.contains("5+");
        let expected: &[Code] = match (letterless, form.len() > 20) {
            (true, _) => &[Code::FortranNumber],
            (_, true) => &[Code::LongNumber],
            _ => &[],
        };
        assert_eq!(codes(&d), expected, "{form}");
    }
}

/// Small faults that a solver was seen to pass over or to report elsewhere.
mod faults_that_pass_elsewhere {
    use super::*;

    #[test]
    fn typing_errors_stop() {
        assert_eq!(faults("*BOUNDARY", "*BONDARY"), [Code::UnknownKeyword]);
        assert_eq!(
            faults("ELSET=BODY\n7", "ELST=BODY\n7"),
            [Code::UnknownParameter]
        );
        assert_eq!(faults("*BOUNDARY", "*AMPLITUDEXYZ"), [Code::UnknownKeyword]);
    }

    #[test]
    fn sets_from_element_sets_are_read() {
        let (model, d) = square("*NSET, NSET=FOOT\n1, 2", "*NSET, NSET=FOOT, ELSET=BODY");
        assert_eq!(codes(&d), []);
        assert_eq!(model.map(|m| m.sets.nodes[1].members.len()), Some(4));
    }

    #[test]
    fn named_supports_are_read() {
        same("FOOT, 1, 2", "FOOT, ENCASTRE");
        same("FOOT, 1, 2", "FOOT, PINNED");
        same("FOOT, 1, 2", "FOOT, 1, 3");
    }

    #[test]
    fn a_smooth_curve_is_read() {
        let curve = "*AMPLITUDE, NAME=A, DEFINITION=SMOOTH STEP\n0., 0., 1., 1.\n*BOUNDARY";
        let (model, d) = square("*BOUNDARY", curve);
        assert_eq!(codes(&d), []);
        let curve = model.map(|m| m.amplitudes[0].at(0.25));
        assert_eq!(curve, Some(0.103515625));
    }

    #[test]
    fn a_thickness_under_the_interaction_is_read() {
        same("*BOUNDARY\n", "*BOUNDARY\n");
        let (model, d) = square("*BOUNDARY", "*SURFACE INTERACTION, NAME=I\n1.,\n*BOUNDARY");
        assert_eq!(codes(&d), []);
        assert!(model.is_some());
    }

    #[test]
    fn undefined_members_stop() {
        assert_eq!(faults("1, 2\n", "1, 999\n"), [Code::UndefinedNode]);
        let generate = "*NSET, NSET=FOOT, GENERATE\n1, 6";
        assert_eq!(
            faults("*NSET, NSET=FOOT\n1, 2", generate),
            [Code::UndefinedNode]
        );
    }

    #[test]
    fn a_bad_coordinate_is_one_error() {
        assert_eq!(faults("2, 1., 0.", "2, abc, 0."), [Code::BadNumber]);
        assert_eq!(faults("2, 1., 0.", "abc, 1., 0."), [Code::BadNumber]);
    }

    #[test]
    fn misshapen_elements_stop_at_their_line() {
        for nodes in ["1, 4, 3, 2", "1, 3, 2, 4", "1, 2, 3, 3"] {
            let (_, d) = square("7, 1, 2, 3, 4", &format!("7, {nodes}"));
            assert_eq!(codes(&d)[0], Code::BadShape, "{nodes}");
            assert_eq!(
                d.iter().next().and_then(|item| item.span).map(|s| s.line),
                Some(9)
            );
        }
        assert_eq!(faults("3, 1., 1.", "3, 0.2, 0.2"), [Code::BadShape]);
        assert_eq!(faults("3, 1., 1.", "3, 0.5, 0.5"), [Code::BadShape]);
    }

    #[test]
    fn an_undefined_material_is_one_error() {
        assert_eq!(
            faults("MATERIAL=RUBBER", "MATERIAL=STONE"),
            [Code::UndefinedName]
        );
    }

    #[test]
    fn empty_files_stop() {
        assert_eq!(codes(&parse("").1), [Code::EmptyDeck]);
        assert_eq!(codes(&parse("\n\n** only a comment").1), [Code::EmptyDeck]);
    }
}
