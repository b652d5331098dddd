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
fn curved_surfaces_that_mesh_into_each_other_start_with_an_initialization() {
    for clearance in [0.0, 0.01] {
        let (model, d) = pin_in_a_hole(clearance, GENERAL);
        let error = d.iter().find(|item| item.severity == Severity::Error);
        assert!(model.is_none() && error.is_some_and(|e| e.code == Code::InitialPenetration));
        let help = error
            .and_then(|error| error.help.clone())
            .unwrap_or_default();
        assert!(help.contains("*CONTACT INITIALIZATION DATA"), "{help}");
        let fit = format!(
            "*CONTACT INITIALIZATION DATA, NAME=FIT\n{GENERAL}\
             *CONTACT INITIALIZATION ASSIGNMENT\n, , FIT\n"
        );
        let (model, d) = pin_in_a_hole(clearance, &fit);
        let model = model.expect("no errors");
        assert!(!d.has_errors() && d.iter().any(|item| item.code == Code::Adjusted));
        let moved = model.adjusted()[0];
        assert!(moved.largest < 0.014 && moved.count <= 64, "{moved:?}");
        let gaps = model.initial_gaps()[0].iter();
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
