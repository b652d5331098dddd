//! The picture of a model (`check --picture`).

use stickslip::output::{Window, picture};

use crate::reading::read;

const SHARED: &str = include_str!("../decks/shared.inp");
const SQUARE: &str = include_str!("../decks/square.inp");
const STEPS: &str = include_str!("../decks/steps.inp");

#[test]
fn a_block_above_its_base() {
    insta::assert_snapshot!(picture(&read(SHARED), None));
}

/// Number of tags that hold a text.
fn count(picture: &str, what: &str) -> usize {
    picture.lines().filter(|line| line.contains(what)).count()
}

#[test]
fn everything_that_a_deck_says_is_in_the_legend() {
    let drawn = picture(&read(STEPS), None);
    for text in [
        "two steps that use everything",
        "material Stiff Rubber",
        "master surface",
        "slave surface and nodes",
        "surface without contact",
        "contact CORNERS on TOP, mu 0",
        "fixed in x and y",
        "prescribed motion",
        "force",
        "pressure or traction",
        "body force",
        "initial velocity",
    ] {
        assert!(drawn.contains(&format!(">{text}")), "{text}");
    }
    let still = picture(
        &read(&SHARED.replace("NBLOCK, 2, -1000.", "NBLOCK, 2, 0.")),
        None,
    );
    assert!(!still.contains("initial velocity"));
}

#[test]
fn models_of_any_size_fill_the_sheet() {
    let drawn = picture(&read(SHARED), None);
    for (scale, unit) in [(1e-9, "e-9"), (1e9, "e9")] {
        let of_unit = |line: &str| -> String {
            let fields = line.split(", ").map(|field| match field.strip_suffix('.') {
                Some(_) => format!("{field}{unit}"),
                None if field.contains('.') => format!("{field}{unit}"),
                None => field.to_owned(),
            });
            fields.collect::<Vec<_>>().join(", ")
        };
        let (nodes, rest) = SHARED.split_once("*ELEMENT").expect("elements");
        let nodes: Vec<String> = nodes.lines().map(of_unit).collect();
        let model = read(&format!("{}\n*ELEMENT{rest}", nodes.join("\n")));
        assert!((model.mesh.coordinates[1][0] / scale - 2.0).abs() < 1e-9);
        let other = picture(&model, None);
        assert!(!other.contains("NaN") && !other.contains("inf"));
        let paths = |text: &str| -> Vec<String> {
            text.lines()
                .filter(|l| l.starts_with("<path"))
                .map(str::to_owned)
                .collect()
        };
        assert_eq!(paths(&other), paths(&drawn));
    }
}

/// A unit block on a rigid floor that reaches far to both sides.
fn on_a_floor(reach: f64) -> String {
    let (nodes, rest) = SQUARE.split_once("*ELEMENT").expect("elements");
    let floor = format!(
        "*NODE, NSET=REF\n9, 0., 0.\n*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, -{reach}, 0.\n\
         LINE, {reach}, 0.\n*RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=REF\n*BOUNDARY\nREF, 1, 2\n"
    );
    format!(
        "{nodes}*ELEMENT{}",
        rest.replace("*BOUNDARY\n", &format!("{floor}*BOUNDARY\n"))
    )
}

/// The number behind a word of a text.
fn number_behind(text: &str, word: &str) -> f64 {
    let rest = &text[text.find(word).expect(word) + word.len()..];
    let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.');
    rest[..end.unwrap_or(rest.len())].parse().expect("a number")
}

#[test]
fn the_picture_shows_the_deformable_bodies_however_long_a_floor_is() {
    for reach in [500.0, 1e6, 1e12] {
        let drawn = picture(&read(&on_a_floor(reach)), None);
        let body = drawn
            .lines()
            .find(|line| line.contains("fill-rule"))
            .expect("the block");
        let width = number_behind(body, "L") - number_behind(body, "M");
        assert!(width.abs() > 250.0, "{width}: {body}");
        assert!(drawn.contains(">rigid surface<") && drawn.contains(">FLOOR<"));
        assert!(drawn.len() < 20_000, "{} characters", drawn.len());
    }
}

#[test]
fn a_window_shows_a_part() {
    let window = |text: [[f64; 2]; 2]| picture(&read(&on_a_floor(500.0)), Some(Window(text)));
    let corner = window([[0.9, 0.9], [1.1, 1.0]]);
    assert!(
        corner.contains(">0.9<") && corner.contains(">1.1<"),
        "{corner}"
    );
    assert!(corner.contains("clip-path=\"url(#area)\""));
    assert!(!corner.contains(">FLOOR<"), "the floor is outside");
    assert!(window([[-600.0, -1.0], [600.0, 2.0]]).contains(">-600<"));
}

#[test]
fn many_marks_are_thinned_out() {
    let squares: usize = 400;
    let row = |i: usize| format!("{}, {i}., 0.\n{}, {i}., 1.\n", 2 * i + 1, 2 * i + 2);
    let nodes: String = (0..=squares).map(row).collect();
    let element = |i: usize| {
        let n = 2 * i;
        format!("{}, {}, {}, {}, {}\n", i + 1, n + 1, n + 3, n + 4, n + 2)
    };
    let elements: String = (0..squares).map(element).collect();
    let rest = SHARED.split("*MATERIAL").nth(1).expect("a material");
    let rest = rest.split("*SOLID").next().expect("a material");
    let model = read(&format!(
        "*NODE, NSET=ALL\n{nodes}*ELEMENT, TYPE=CPE4, ELSET=E\n{elements}*MATERIAL{rest}\
         *SOLID SECTION, ELSET=E, MATERIAL=STEEL\n*BOUNDARY\nALL, 1, 2\n*STEP, NLGEOM\n*DYNAMIC\n\
         1.e-9, 1.e-6\n*DLOAD\nE, P3, 1.\n*END STEP\n"
    ));
    let drawn = picture(&model, None);
    let marks = count(&drawn, "<polygon");
    assert!((100..400).contains(&marks), "{marks}");
}
