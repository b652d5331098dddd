//! Checks of the model: decks that trigger each, and decks close to them that do not.

use super::{Code, GENERAL, SQUARE, Source, change, messages, shared, square};
use std::fmt::Write;
use stickslip::diagnostics::{Diagnostics, Severity, Sources};
use stickslip::prepare::{PreparedModel, prepare};
use stickslip::{deck, reader};

/// Codes of the messages about a deck.
fn codes(source: &Source) -> Vec<Code> {
    messages(source).0.iter().map(|item| item.code).collect()
}

#[test]
fn coincident_nodes_may_be_joined_by_contact_or_an_equation() {
    let squares = |more: &str| {
        let deck = SQUARE.replacen(
            "7, 1, 2, 3, 4",
            "7, 1, 2, 3, 4\n8, 5, 6, 7, 8\n*NODE\n5, 1., 0.\n6, 2., 0.\n7, 2., 1.\n8, 1., 1.",
            1,
        );
        let deck = change(&deck, "*BOUNDARY", &format!("{more}*BOUNDARY"));
        codes(&deck).contains(&Code::CoincidentNodes)
    };
    assert!(squares(""));
    let contact = "*SURFACE, NAME=L\n7, S2\n*SURFACE, NAME=R\n8, S4\n\
                   *SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nL, R\n";
    assert!(!squares(contact));
    assert!(!squares(GENERAL));
    let equation = |a, b| format!("*EQUATION\n2\n{a}, 1, 1., {b}, 1, -1.\n");
    assert!(squares(&equation(5, 2)), "3 and 8 part");
    assert!(!squares(&(equation(5, 2) + &equation(8, 3))));
}

#[test]
fn few_slave_nodes_may_be_fixed() {
    let fixed = |nodes: &str| {
        let rows = format!("STOP, SBOT\n*BOUNDARY\n{nodes}");
        codes(&shared("SBOT, STOP", &rows)).contains(&Code::FixedSlave)
    };
    assert!(!fixed("4, 1, 2") && !fixed("4, 1\n5, 1\n6, 1"));
    assert!(fixed("4, 1, 2\n5, 1, 2"));
}

#[test]
fn increments_suit_the_waves_of_the_material() {
    let found = |row: &str| codes(&square("0.1, 1.", row)).contains(&Code::OutOfProportion);
    // a wave crosses the side in 0.030
    assert!(!found("1.e-3, 0.04") && !found("2.e4, 1.e5"));
    assert!(found("1.e-3, 0.02") && found("4.e4, 1.e5"));
}

#[test]
fn a_normal_may_follow_an_empty_z() {
    let codes = |row: &str| codes(&square("3, 1., 1.", row));
    assert!(!codes("3, 1., 1., , 0.").contains(&Code::ExtraField));
    assert!(!codes("3, 1., 1., , 0., 0., 1.").contains(&Code::ExtraField));
    assert!(codes("3, 1., 1., , 0., 0., 1., 0.").contains(&Code::ExtraField));
    assert!(codes("3, 1., 1., 0., 1.").contains(&Code::ExtraField));
}

#[test]
fn static_steps_without_weight_need_no_density() {
    let bare = SQUARE.replace("*DENSITY\n1.\n", "");
    let is_static = bare.replace("*DYNAMIC", "*STATIC");
    let found = |deck: &str| codes(&Source::Text(deck.to_owned()));
    assert!(found(&bare).contains(&Code::IncompleteMaterial));
    assert!(found(&is_static).contains(&Code::NoDensity));
    assert!(!found(&is_static).contains(&Code::IncompleteMaterial));
    let weighed = is_static.replace("*END STEP", "*DLOAD\nBODY, GRAV, 9.81, 0., -1.\n*END STEP");
    assert!(found(&weighed).contains(&Code::IncompleteMaterial));
    let moved = format!("{is_static}*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.1, 1.\n*END STEP\n");
    assert!(found(&moved).contains(&Code::IncompleteMaterial));
}

#[test]
fn centrifugal_forces_tell_that_they_leave_out_masses_at_nodes() {
    let found = |load: &str| {
        let mass = "*NODE\n100, 5., 0.\n101, 6., 0.\n*NSET, NSET=ROD\n100, 101\n\
                    *RIGID BODY, NSET=ROD, REF NODE=100\n\
                    *ELEMENT, TYPE=MASS, ELSET=EM\n9, 100\n10, 101\n*MASS, ELSET=EM\n1.\n*STEP";
        let deck = SQUARE.replacen("*STEP", mass, 1);
        let load = format!("*DLOAD\n{load}\n*NODE PRINT");
        codes(&change(&deck, "*NODE PRINT", &load)).contains(&Code::IgnoredParameter)
    };
    assert!(found(", CENTRIF, 4.") && found("EM, CENTRIF, 4."));
    assert!(!found("BODY, CENTRIF, 4.") && !found(", GRAV, 9.81, 0., -1."));
}

/// The square without its load.
fn unloaded() -> String {
    SQUARE.replacen("3, 2, 4.", "3, 2, 0.", 1)
}

#[test]
fn anything_that_moves_is_something_to_do() {
    let still = |more: &str| {
        let deck = change(&unloaded(), "*NODE PRINT", &format!("{more}*NODE PRINT"));
        codes(&deck).contains(&Code::NothingToDo)
    };
    assert!(still("") && still("*BOUNDARY\n4, 1, 2, 0.\n"));
    assert!(!still("*BOUNDARY\n4, 1, 1, 0.1\n"));
    assert!(!still("*DLOAD\nBODY, GRAV, 9.81, 0., -1.\n"));
    assert!(!still("*DLOAD\nBODY, P3, 1.\n"));
    assert!(!still("*DSLOAD, FOLLOWER=NO\nTOP, TRVEC, 1., 1., 0.\n"));
    let velocity = "*INITIAL CONDITIONS, TYPE=VELOCITY\n3, 1, 1.\n*STEP";
    assert!(!codes(&change(&unloaded(), "*STEP", velocity)).contains(&Code::NothingToDo));
}

/// The square with an amplitude, which its load or a card of its step follows; its increment is 0.1.
fn with_amplitude(amplitude: &str, card: Option<&str>) -> Source {
    let model = format!("*AMPLITUDE, NAME=A{amplitude}\n*STEP");
    let load = "*CLOAD, AMPLITUDE=A\n3, 2, 4.";
    let deck = SQUARE.replacen("*STEP", &model, 1);
    change(&deck, "*CLOAD\n3, 2, 4.", card.unwrap_or(load))
}

#[test]
fn features_of_amplitudes_are_as_long_as_the_increment() {
    let found =
        |amplitude: &str| codes(&with_amplitude(amplitude, None)).contains(&Code::ShortFeature);
    let short = [
        "\n0., 0., 0.51, 0., 0.55, 1., 0.59, 0., 1., 0.",
        // with its top at the end of an increment
        "\n0., 0., 0.46, 0., 0.5, -1., 0.54, 0., 1., 0.",
        "\n0., 1., 0.51, 1., 0.5101, 0., 0.56, 0., 0.5601, 1.",
        ", DEFINITION=SMOOTH STEP\n0., 0., 0.51, 0., 0.55, 1., 0.59, 0., 1., 0.",
        ", DEFINITION=EQUALLY SPACED, FIXED INTERVAL=0.05\n0., 1., 0., 1., 0., 1., 0.",
        ", TIME=TOTAL TIME\n0., 0., 0.51, 0., 0.55, 1., 0.59, 0., 1., 0.",
        // a load that is there at the start only
        "\n0., 1., 1.E-3, 0.",
        ", DEFINITION=PERIODIC\n1, 62.83185307, 0., 1.\n-1., 0.",
        ", DEFINITION=PERIODIC\n2, 20., 0., 0.\n0., 1., 0., 1.",
        ", DEFINITION=DECAY\n0., 1., 0.5, 0.1",
        ", DEFINITION=MODULATED\n0., 1., 0., 20., 15.",
    ];
    for amplitude in short {
        assert!(found(amplitude), "{amplitude}");
    }
    let long = [
        "\n0., 1., 1., 1.",
        "\n0., 0., 1.E-6, 1.",
        "\n0., 0., 0.5, 0., 0.5001, 1.",
        "\n0., 0., 0.3, 1., 0.6, 0.",
        // noise of two per cent
        "\n0., 0., 0.3, 1., 0.31, 0.98, 0.32, 1., 0.6, 0.",
        // after the step
        "\n0., 0., 5.51, 0., 5.55, 1., 5.59, 0.",
        ", DEFINITION=PERIODIC\n1, 20., 0., 1.\n-1., 0.",
        ", DEFINITION=PERIODIC\n2, 20., 0., 0.\n0., 1., 0., 0.",
        ", DEFINITION=PERIODIC\n1, 62.83185307, 3., 1.\n-1., 0.",
        ", DEFINITION=DECAY\n0., 1., 0.5, 0.2",
        ", DEFINITION=MODULATED\n0., 1., 0., 20., 10.",
    ];
    for amplitude in long {
        assert!(!found(amplitude), "{amplitude}");
    }
    // rates are integrated, so that no increment misses what they do; a load of zero does nothing
    let spike = short[0];
    let codes_of = |card: &str| codes(&with_amplitude(spike, Some(card)));
    let velocity = "*BOUNDARY, TYPE=VELOCITY, AMPLITUDE=A\n3, 2, 2, 4.";
    assert!(!codes_of(velocity).contains(&Code::ShortFeature));
    assert!(!codes_of("*CLOAD, AMPLITUDE=A\n3, 2, 0.").contains(&Code::ShortFeature));
    let displacement = "*BOUNDARY, AMPLITUDE=A\n3, 2, 2, 0.1";
    assert!(codes_of(displacement).contains(&Code::ShortFeature));
    for load in [
        "*DLOAD, AMPLITUDE=A\nBODY, P3, 1.",
        "*DLOAD, AMPLITUDE=A\nBODY, GRAV, 1., 0., -1.",
    ] {
        assert!(codes_of(load).contains(&Code::ShortFeature), "{load}");
    }
}

#[test]
fn prescribed_displacements_go_on_from_where_the_node_is() {
    let jumps = |amplitude: &str, cards: &str| {
        let deck = with_amplitude(amplitude, Some(&format!("*BOUNDARY, AMPLITUDE=A\n{cards}")));
        let found = codes(&deck).into_iter();
        found.filter(|code| *code == Code::StartJump).count()
    };
    assert_eq!(jumps("\n0., 1., 1., 1.", "3, 2, 2, 0.1\n4, 2, 2, 0.1"), 1);
    assert_eq!(jumps("\n0., 0., 1., 1.", "3, 2, 2, 0.1"), 0);
    assert_eq!(jumps("\n0., 1., 1., 1.", "3, 2, 2, 0."), 0);
    let cosine = ", DEFINITION=PERIODIC\n1, 3., 0., 0.\n1., 0.";
    assert_eq!(jumps(cosine, "3, 2, 2, 0.1"), 1);
    assert_eq!(
        jumps(&cosine.replace("0.\n1.", "-1.\n1."), "3, 2, 2, 0.1"),
        0
    );
    // a second step that goes on with the end of the first, and one that does not
    let next = |value: f64| {
        format!(
            "3, 2, 2, 0.1\n*END STEP\n*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.1, 1.\n\
             *BOUNDARY, AMPLITUDE=A\n3, 2, 2, {value}"
        )
    };
    let [back, total] = [
        "\n0., 0., 1., 1.",
        ", TIME=TOTAL TIME\n0., 0., 1., 1., 2., 0.",
    ];
    assert_eq!(jumps(back, &next(0.1)), 1);
    assert_eq!(jumps(total, &next(0.1)), 0);
    assert_eq!(jumps(total, &next(0.2)), 1);
    // where the end is not known there is nothing to compare with
    let free = "3, 2, 2, 0.1\n*END STEP\n*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.1, 1.\n\
                *BOUNDARY, AMPLITUDE=A\n4, 2, 2, 0.1";
    assert_eq!(jumps(total, free), 0);
}

#[test]
fn displacements_of_an_equation_have_ratios_that_can_be_computed_with() {
    let found = |a: &str, b: &str| {
        let card = format!("*EQUATION\n2\n4, 1, {a}, 3, 1, {b}\n*STEP");
        codes(&square("*STEP", &card)).contains(&Code::BadEquation)
    };
    assert!(found("1.", "1.E-300") && found("1.E-300", "1.") && found("1.", "-1.E51"));
    assert!(!found("1.E-300", "1.E-300") && !found("1.", "1.E-49") && !found("1.", "0."));
}

#[test]
fn a_surface_that_looks_away_is_no_penetration() {
    let found = codes(&shared("EBASE, S3", "EBASE, S1"));
    assert!(found.contains(&Code::FacingAway) && !found.contains(&Code::InitialPenetration));
    // the face is farther away than it is long
    let Source::Text(low) = shared("EBASE, S3", "EBASE, S1") else {
        unreachable!("a text")
    };
    let far = low.replace("1.1\n", "4.1\n").replace("2.1\n", "5.1\n");
    let found = codes(&Source::Text(far));
    assert!(found.contains(&Code::FacingAway) && !found.contains(&Code::NothingFaced));
    let inside = codes(&shared("11, 1., 1.1", "11, 1., 0.99"));
    assert!(!inside.contains(&Code::FacingAway) && inside.contains(&Code::InitialPenetration));
}

/// Nodes and elements of a ring of so many elements between two radii.
fn ring(text: &mut String, name: &str, first: usize, count: usize, radii: [f64; 2]) {
    writeln!(text, "*NODE").expect("a text");
    for i in 0..count {
        let angle = std::f64::consts::TAU * i as f64 / count as f64;
        for (j, radius) in radii.into_iter().enumerate() {
            let [x, y] = [radius * angle.cos(), radius * angle.sin()];
            writeln!(text, "{}, {x:.12}, {y:.12}", first + 2 * i + j).expect("a text");
        }
    }
    writeln!(text, "*ELEMENT, TYPE=CPS4, ELSET={name}").expect("a text");
    for i in 0..count {
        let [a, b] = [i, (i + 1) % count].map(|i| first + 2 * i);
        writeln!(text, "{}, {a}, {}, {}, {b}", first + i, a + 1, b + 1).expect("a text");
    }
    writeln!(text, "*SOLID SECTION, ELSET={name}, MATERIAL=RUBBER").expect("a text");
}

/// A pin in a hole in general contact: elements of about 1 on radii of about 10, whose sagitta is more than
/// the clearance. The prepared model, if there is no error, and the messages.
fn pin_in_a_hole(clearance: f64, contact: &str) -> (Option<PreparedModel>, Diagnostics) {
    let mut text = String::new();
    ring(&mut text, "PIN", 1, 64, [7.0, 10.0]);
    ring(&mut text, "EYE", 1001, 61, [10.0 + clearance, 14.0]);
    text.push_str("*MATERIAL, NAME=RUBBER\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n");
    text.push_str(contact);
    text.push_str("*BOUNDARY\n1, 1, 2\n*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.1, 1.\n*DLOAD\n, GRAV, 1., 0., -1.\n*END STEP\n");
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let deck = deck::parse_str("pin.inp", &text, &mut sources, &mut d);
    let model = reader::build(&deck, &mut d);
    (model.and_then(|model| prepare(model, &mut d)), d)
}

#[test]
fn curved_faces_with_a_clearance_smaller_than_their_sagitta_start_apart() {
    let (model, d) = pin_in_a_hole(0.01, GENERAL);
    let model = model.expect("no errors");
    assert!(!d.has_errors() && model.adjusted.iter().all(|moved| moved.count == 0));
    let gaps = model.gaps.iter().flatten();
    let least = gaps.fold(f64::INFINITY, |least, gap| least.min(gap.gap));
    assert!((least - 0.01).abs() < 1e-5, "{least}");
}

#[test]
fn chords_that_mesh_into_each_other_start_with_an_initialization() {
    let straight =
        format!("{GENERAL}*SURFACE PROPERTY ASSIGNMENT, PROPERTY=GEOMETRIC CORRECTION\n, NONE\n");
    for clearance in [0.0, 0.01] {
        let (model, d) = pin_in_a_hole(clearance, &straight);
        let error = d.iter().find(|item| item.severity == Severity::Error);
        assert!(model.is_none() && error.is_some_and(|e| e.code == Code::InitialPenetration));
        let help = error
            .and_then(|error| error.help.clone())
            .unwrap_or_default();
        assert!(help.contains("*CONTACT INITIALIZATION DATA"), "{help}");
        let fit = format!(
            "*CONTACT INITIALIZATION DATA, NAME=FIT\n{straight}\
             *CONTACT INITIALIZATION ASSIGNMENT\n, , FIT\n"
        );
        let (model, d) = pin_in_a_hole(clearance, &fit);
        let model = model.expect("no errors");
        assert!(!d.has_errors() && d.iter().any(|item| item.code == Code::Adjusted));
        let moved = model.adjusted[0];
        assert!(moved.largest < 0.014 && moved.count <= 64, "{moved:?}");
        let gaps = model.gaps[0].iter();
        let deepest = gaps
            .map(|gap| gap.gap / gap.edge)
            .fold(f64::INFINITY, f64::min);
        assert!(deepest > -1e-9, "{deepest:e}");
    }
}

#[test]
fn bodies_that_overlap_are_told_unless_contact_moves_them() {
    let overlap = |contact: &str| {
        let (_, d) = pin_in_a_hole(-0.5, contact);
        let told = d.iter().find(|item| item.code == Code::OverlappingBodies);
        told.map(|item| item.severity)
    };
    assert_eq!(overlap(GENERAL), Some(Severity::Error));
    assert_eq!(overlap(""), Some(Severity::Warning));
    let pair = "*SURFACE, NAME=P\nPIN\n*SURFACE, NAME=E\nEYE\n*SURFACE INTERACTION, NAME=I\n\
                *CONTACT PAIR, INTERACTION=I, ADJUST=0.\nP, E\n";
    assert_eq!(overlap(pair), None, "moved before the start");
    assert_eq!(
        overlap(&pair.replace(", ADJUST=0.", "")),
        Some(Severity::Warning)
    );
}

/// A node 0.01 deep in a base of length 1000 is a thousandth of the base's edge off, but a hundredth of its own.
#[test]
fn a_start_overlap_is_measured_in_the_smaller_edge() {
    let overlaps = |slave: &str, depth: f64| {
        let (bottom, top) = (-depth, 1.0 - depth);
        let deck = format!(
            "*NODE\n1, -1000., -9.\n2, 1000., -9.\n3, 1000., 0.\n4, -1000., 0.\n\
             5, 0., {bottom}\n6, 1., {bottom}\n7, 1., {top}\n8, 0., {top}\n\
             *ELEMENT, TYPE=CPE4, ELSET=ALL\n1, 1, 2, 3, 4\n2, 5, 6, 7, 8\n\
             *MATERIAL, NAME=M\n*ELASTIC\n1e4, 0.3\n*DENSITY\n1.\n*SOLID SECTION, ELSET=ALL, MATERIAL=M\n\
             *SURFACE, NAME=TOP\n1, S3\n*SURFACE, NAME=FOOT{slave}\n\
             *SURFACE INTERACTION, NAME=I\n*CONTACT PAIR, INTERACTION=I\nFOOT, TOP\n\
             *BOUNDARY\n1, 1, 2\n2, 1, 2\n*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 0.1\n*END STEP\n"
        );
        let (found, _) = messages(&Source::Text(deck));
        let overlap = found.iter().find(|d| d.code == Code::InitialPenetration);
        overlap.map(|d| d.severity)
    };
    for slave in ["\n2, S1", ", TYPE=NODE\n5\n6"] {
        assert_eq!(overlaps(slave, 0.01), Some(Severity::Error), "{slave}");
        assert_eq!(overlaps(slave, 1e-4), Some(Severity::Warning), "{slave}");
        assert_eq!(overlaps(slave, 0.0), None, "{slave}");
    }
}
