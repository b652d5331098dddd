//! Levels of keywords: at every level each keyword is taken or refused as Abaqus' manual says, but for what is told here.

use stickslip::deck::{self, Keyword, Scope, Status, keywords};
use stickslip::diagnostics::{Code, Diagnostics, Sources, Span};
use stickslip::reader;

use crate::reading::try_read;

/// Levels of the deck below: in a part, an instance, the assembly, behind it, in the first step and in a later one.
const LEVELS: [char; 6] = ['P', 'I', 'A', 'M', 'S', 'L'];

/// Keywords, the levels that the Abaqus Keywords Reference gives them (those of the program itself and of CalculiX: of their
/// like), and the levels at which they are taken. Beyond the manual, sets and surfaces may stand behind the assembly and
/// in steps, and what joins parts behind the assembly. Contacts in a step behind the first are refused: they hold from the
/// start.
const MANUAL: [(&str, &str, &str); 71] = [
    ("HEADING", "M", "M"),
    ("NODE", "PIA", "PIA"),
    ("ELEMENT", "PIA", "PIA"),
    ("NSET", "PIA", "PIAMSL"),
    ("ELSET", "PIA", "PIAMSL"),
    ("SURFACE", "PIA", "PIAMSL"),
    ("SOLID SECTION", "PI", "PI"),
    ("RIGID BODY", "PIA", "PIAM"),
    ("MASS", "PIA", "PIAM"),
    ("ROTARY INERTIA", "PIA", "PIAM"),
    ("SPRING", "PIA", "PIAM"),
    ("DASHPOT", "PIA", "PIAM"),
    ("ORIENTATION", "PIA", "PIAM"),
    ("EQUATION", "PIA", "PIAM"),
    ("MPC", "PIA", "PIAM"),
    ("TIE", "PIA", "PIAM"),
    ("COUPLING", "PIA", "PIAM"),
    ("KINEMATIC", "PIA", "PIAM"),
    ("DISTRIBUTING", "PIA", "PIAM"),
    ("KINEMATIC COUPLING", "PIA", "PIAM"),
    ("PRE-TENSION SECTION", "PIA", "PIAM"),
    ("MATERIAL", "M", "M"),
    ("ELASTIC", "M", "M"),
    ("HYPERELASTIC", "M", "M"),
    ("PLASTIC", "M", "M"),
    ("DENSITY", "M", "M"),
    ("EXPANSION", "M", "M"),
    ("DAMPING", "M", "M"),
    ("INITIAL CONDITIONS", "M", "M"),
    ("SURFACE SMOOTHING", "M", "M"),
    ("CONTACT INITIALIZATION DATA", "M", "M"),
    ("AMPLITUDE", "MSL", "MSL"),
    ("BOUNDARY", "MSL", "MSL"),
    ("TIME POINTS", "MSL", "MSL"),
    ("RESTART", "MSL", "MSL"),
    ("NO ANALYSIS", "MSL", "MSL"),
    ("FRICTION", "MSL", "MSL"),
    ("SURFACE INTERACTION", "MSL", "MS"),
    ("SURFACE BEHAVIOR", "MSL", "MS"),
    ("CONTACT PAIR", "MSL", "MS"),
    ("CONTACT", "MSL", "MS"),
    ("CONTACT INCLUSIONS", "MSL", "MS"),
    ("CONTACT PROPERTY ASSIGNMENT", "MSL", "MS"),
    ("CONTACT FORMULATION", "MSL", "MS"),
    ("SURFACE PROPERTY ASSIGNMENT", "MSL", "MS"),
    ("CLEARANCE", "MSL", "MS"),
    ("CONTACT INITIALIZATION ASSIGNMENT", "M", "MS"),
    ("WEAR SURFACE PROPERTIES", "M", "MS"),
    ("GAP HEAT GENERATION", "M", "MS"),
    ("STATIC", "SL", "SL"),
    ("DYNAMIC", "SL", "SL"),
    ("CLOAD", "SL", "SL"),
    ("DLOAD", "SL", "SL"),
    ("DSLOAD", "SL", "SL"),
    ("CONTACT INTERFERENCE", "SL", "SL"),
    ("TEMPERATURE", "SL", "SL"),
    ("CHANGE FRICTION", "SL", "SL"),
    ("MODEL CHANGE", "SL", "SL"),
    ("OUTPUT", "SL", "SL"),
    ("NODE OUTPUT", "SL", "SL"),
    ("ELEMENT OUTPUT", "SL", "SL"),
    ("CONTACT OUTPUT", "SL", "SL"),
    ("ENERGY OUTPUT", "SL", "SL"),
    ("NODE FILE", "SL", "SL"),
    ("EL FILE", "SL", "SL"),
    ("CONTACT FILE", "SL", "SL"),
    ("NODE PRINT", "SL", "SL"),
    ("EL PRINT", "SL", "SL"),
    ("CONTACT PRINT", "SL", "SL"),
    ("MONITOR", "SL", "SL"),
    ("STICKSLIP", "SL", "SL"),
];

/// A deck with an assembly and two steps, with cards at one of the levels.
fn deck_with(cards: &str, level: char) -> String {
    let [part, instance, assembly, model, first, later] =
        LEVELS.map(|at| if at == level { cards } else { "" });
    format!(
        "*PART, NAME=P\n*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n*ELEMENT, TYPE=CPE4, ELSET=E\n1, 1, 2, 3, 4\n\
         *SOLID SECTION, ELSET=E, MATERIAL=M\n{part}*END PART\n\
         *ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n{instance}*END INSTANCE\n{assembly}*END ASSEMBLY\n\
         *MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n{model}\
         *STEP\n*STATIC\n1., 1.\n{first}*END STEP\n*STEP\n*STATIC\n1., 1.\n{later}*END STEP\n"
    )
}

/// The card of a keyword from its example, below the one whose block it belongs to.
fn card(keyword: &Keyword, level: char) -> String {
    let lines: Vec<&str> = keyword.example.lines().collect();
    let is_head = |line: &&str| line.starts_with('*');
    let is_own = |line: &&str| line.split(',').next() == Some(&format!("*{}", keyword.name));
    let start = lines
        .iter()
        .position(is_own)
        .expect("an example has its keyword");
    let rows = lines[start + 1..].iter().take_while(|line| !is_head(line));
    let own: String = [lines[start]]
        .iter()
        .chain(rows)
        .map(|line| format!("{line}\n"))
        .collect();
    let head = match (keyword.scope, level) {
        (Scope::BlockOrAfter(..), 'L') => "*CHANGE FRICTION, INTERACTION=NEW\n",
        (Scope::BlockOrAfter(..) | Scope::Block("SURFACE INTERACTION"), _) => {
            "*SURFACE INTERACTION, NAME=NEW\n"
        }
        (Scope::Block("MATERIAL") | Scope::BlockOrModel("MATERIAL"), _) => "*MATERIAL, NAME=NEW\n",
        (Scope::Block("COUPLING"), _) => {
            "*COUPLING, CONSTRAINT NAME=NEW, REF NODE=1, SURFACE=NEW\n"
        }
        (Scope::Block("CONTACT"), _) => "*CONTACT\n",
        _ => "",
    };
    format!("{head}{own}")
}

/// Whether cards at a level of the deck are in their place.
fn is_taken(cards: &str, level: char) -> bool {
    let text = deck_with(cards, level);
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let deck = deck::parse_str("deck.inp", &text, &mut sources, &mut d);
    reader::build(&deck, &mut d);
    !d.iter().any(|item| item.code == Code::WrongPlace)
}

#[test]
fn every_keyword_at_every_level() {
    let general = ["INCLUDE", "PARAMETER", "STEP", "END STEP"];
    let read = keywords().filter(|keyword| {
        keyword.status == Status::Read
            && keyword.scope != Scope::Structure
            && !general.contains(&keyword.name)
    });
    let mut count = 0;
    for keyword in read {
        let row = MANUAL.iter().find(|(name, ..)| *name == keyword.name);
        let &(name, manual, here) = row.unwrap_or_else(|| panic!("*{} has no row", keyword.name));
        let taken = LEVELS
            .iter()
            .filter(|&&level| is_taken(&card(keyword, level), level));
        assert_eq!(taken.collect::<String>(), here, "*{name}");
        let is_contact = manual == "MSL" && here == "MS";
        let refused = manual.chars().filter(|level| !here.contains(*level));
        assert_eq!(
            refused.collect::<String>(),
            if is_contact { "L" } else { "" },
            "*{name}"
        );
        count += 1;
    }
    assert_eq!(count, MANUAL.len());
}

/// From within an instance, its own sets come before those of the assembly, and those of the assembly are seen.
#[test]
fn names_are_looked_up_from_the_level_of_the_card_outwards() {
    let sets = "*NODE, NSET=REF\n1, 5., 5.\n*NSET, NSET=TOP, INSTANCE=I\n3\n";
    let body = |set: &str| {
        let own = format!("*NSET, NSET=TOP\n1, 2\n*RIGID BODY, REF NODE=REF, TIE NSET={set}\n");
        let text =
            deck_with(&own, 'I').replacen("*END ASSEMBLY", &format!("{sets}*END ASSEMBLY"), 1);
        let (model, _, messages) = try_read(&text);
        let model = model.unwrap_or_else(|| panic!("{messages}"));
        let body = &model.rigid_bodies[0];
        (body.name.clone(), body.nodes.clone(), body.reference)
    };
    assert_eq!(body("TOP"), ("I.TOP".to_owned(), vec![0, 1], 4));
    assert_eq!(body("I.TOP"), ("I.TOP".to_owned(), vec![0, 1], 4));
    // a set of a step is seen there and behind
    let step = "*NSET, NSET=LOADED\nI.3\n*CLOAD\nLOADED, 1, 1.\n*BOUNDARY\nI.E1, 1, 2\n";
    let text = deck_with(step, 'S').replacen("*END PART", "*NSET, NSET=E1\n1, 2\n*END PART", 1);
    let (model, _, messages) = try_read(&text);
    let model = model.unwrap_or_else(|| panic!("{messages}"));
    assert!(
        model
            .sets
            .nodes
            .iter()
            .any(|set| set.name == "LOADED" && set.members == [2])
    );
    // no set of the model grows in a step
    let grows = text.replacen("NSET=LOADED", "NSET=I.E1", 1);
    let (model, _, messages) = try_read(&grows);
    assert!(
        model.is_none() && messages.contains("a set cannot get members in a step"),
        "{messages}"
    );
}

/// Contacts that stand in the first step, as Abaqus/Explicit has them, hold from the start.
#[test]
fn contacts_of_the_first_step_are_those_of_the_model() {
    let shared = include_str!("../decks/shared.inp");
    let start = shared
        .find("*SURFACE INTERACTION")
        .expect("the interaction");
    let end = shared.find("*BOUNDARY").expect("the end of contact");
    let contact = &shared[start..end];
    let in_step = shared.replacen(contact, "", 1);
    let in_step = in_step.replacen("*DLOAD", &format!("{contact}*DLOAD"), 1);
    let general = "*CONTACT, OP=NEW\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT PROPERTY ASSIGNMENT\n, , DRY\n";
    let of_pair = "*CONTACT PAIR, INTERACTION=DRY, TYPE=NODE TO SURFACE\nSBOT, STOP\n";
    let model = |text: &str| {
        let (model, _, messages) = try_read(text);
        let mut model = model.unwrap_or_else(|| panic!("{messages}\n{text}"));
        model
            .contacts
            .iter_mut()
            .for_each(|contact| contact.span = Span::default());
        model
    };
    assert_eq!(model(&in_step), model(shared));
    let [in_step, before] = [&in_step, shared].map(|text| text.replacen(of_pair, general, 1));
    assert_eq!(model(&in_step), model(&before));
}

/// Names with blanks, dots and signs, in quotation marks or not, whole or in parts, in any case.
#[test]
fn names_are_found_however_they_are_quoted() {
    let quoted = deck_with("", 'M')
        .replace("NAME=P\n", "NAME=\"Plate (left)\"\n")
        .replace(
            "NAME=I, PART=P",
            "NAME=\"Plate (left) 1\", PART=\"Plate (left)\"",
        )
        .replacen(
            "*END PART",
            "*NSET, NSET=\"Top & 1.5\"\n3, 4\n*Nset, nset=Low side\n1, 2\n*END PART",
            1,
        );
    let plain = quoted
        .replace("\"Plate (left)", "Plate (left)")
        .replace("1\", PART", "1, PART");
    let plain = plain.replace("Plate (left)\"", "Plate (left)");
    let set = |text: &str, name: &str| {
        let own = format!("*NSET, NSET=OWN\n{name}\n*END ASSEMBLY");
        let (model, _, messages) = try_read(&text.replacen("*END ASSEMBLY", &own, 1));
        let model = model.unwrap_or_else(|| panic!("{name}\n{messages}"));
        let own = model.sets.nodes.iter().find(|set| set.name == "OWN");
        own.expect("the set").members.clone()
    };
    for name in [
        "\"Plate (left) 1\".\"Top & 1.5\"",
        "\"Plate (left) 1.Top & 1.5\"",
    ] {
        assert_eq!(set(&quoted, name), [2, 3]);
    }
    for name in [
        "\"Plate (left) 1\".LOW SIDE",
        "\"Plate (left) 1\".lowside",
        "\"Plate (left) 1\".\"LOWSIDE\"",
        "\"Plate (left) 1.Low side\"",
    ] {
        assert_eq!(set(&quoted, name), [0, 1]);
    }
    assert_eq!(set(&quoted, "\"Plate (left) 1\".3"), [2]);
    for name in [
        "Plate (left) 1.Low Side",
        "plate(left)1.lowside",
        "Plate (left) 1.\"LOWSIDE\"",
    ] {
        assert_eq!(set(&plain, name), [0, 1]);
    }
    assert_eq!(set(&plain, "PLATE (LEFT) 1.\"Top & 1.5\""), [2, 3]);
}

/// The words of `stickslip explain` follow from the same table.
#[test]
fn places_are_explained() {
    for (name, words) in [
        (
            "NODE",
            "before the first step; in a deck with parts in a part, an instance or the assembly",
        ),
        (
            "TIE",
            "before the first step; in a deck with parts in a part, an instance, the assembly or behind it",
        ),
        (
            "SOLID SECTION",
            "before the first step; in a deck with parts in a part or an instance",
        ),
        (
            "NSET",
            "before the first step or in a step; in a deck with parts in a part, an instance, the assembly or behind it",
        ),
        ("CONTACT PAIR", "before the first step or in it"),
        ("BOUNDARY", "before the first step or in a step"),
        ("CLOAD", "in a step"),
        ("KINEMATIC", "under *COUPLING"),
    ] {
        let keyword = deck::find_keyword(name).expect(name);
        let text = keyword
            .explanation()
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        assert!(
            text.contains(&format!("it stands {words}, with ")),
            "{text}"
        );
    }
}
