//! Checks of the model: decks that trigger each, and decks close to them that do not.

use super::{Code, GENERAL, SQUARE, Source, change, messages, shared, square};

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
