//! `stickslip lcp`, and the problem that a stopped run leaves behind.

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::exit::stickslip;

/// Solves a problem given as text.
fn solve(folder: &Path, problem: &str) -> (i32, Value) {
    let file = folder.join("problem.json");
    fs::write(&file, problem).expect("written");
    let (code, out, _) = stickslip(&["lcp", &file.to_string_lossy()]);
    (
        code,
        serde_json::from_str(&out).expect("the answer is JSON"),
    )
}

#[test]
fn solved_problems_exit_with_0_and_all_others_with_1() {
    let folder = TempDir::new().expect("folder");
    let (code, answer) = solve(folder.path(), r#"{"M": [[2, 1], [1, 2]], "q": [-5, -6]}"#);
    assert_eq!((code, answer["status"].as_str()), (0, Some("solved")));
    let z: Vec<f64> = serde_json::from_value(answer["z"].clone()).expect("numbers");
    assert!((z[0] - 4.0 / 3.0).abs() < 1e-14 && (z[1] - 7.0 / 3.0).abs() < 1e-14);
    // One sliding contact: Pn = 1, Pt = -mu Pn, in the block order Pn, T+, Dt-.
    let sliding = r#"{"M": [[1, 0, 0], [-0.5, 2, 1], [0.5, -1, 0]], "q": [-1, 3, 0], "mu": 0.5}"#;
    let (code, answer) = solve(folder.path(), sliding);
    assert_eq!(
        (code, answer["z"][0].as_f64(), answer["z"][1].as_f64()),
        (0, Some(1.0), Some(0.0))
    );
    for (problem, status) in [
        (r#"{"M": [[-1]], "q": [-1]}"#, "ray"),
        (r#"{"M": [[1]], "q": [1, 2]}"#, "invalid"),
        (r#"{"M": [["NaN"]], "q": [1]}"#, "invalid"),
        ("no JSON", "invalid"),
    ] {
        let (code, answer) = solve(folder.path(), problem);
        assert_eq!(
            (code, answer["status"].as_str()),
            (1, Some(status)),
            "{problem}"
        );
    }
}

#[test]
fn a_missing_file_is_4() {
    let (code, _, err) = stickslip(&["lcp", "missing.json"]);
    assert_eq!(code, 4);
    assert!(err.contains("missing.json"));
}

/// A free node between two plates that close:
///
/// ```text
///   [ upper plate ]  moves down by 0.3
///    . node 3 of a small element
///   [ lower plate ]  fixed
/// ```
const VICE: &str = "\
*NODE
1, 0., 0.4
2, -1., 0.1
3, 0., 0.1
11, -2., -1.
12, 2., -1.
13, 2., 0.
14, -2., 0.
21, -2., 0.2
22, 2., 0.2
23, 2., 1.2
24, -2., 1.2
*ELEMENT, TYPE=CPS3, ELSET=FREE
1, 1, 2, 3
*ELEMENT, TYPE=CPS4, ELSET=LOWER
2, 11, 12, 13, 14
*ELEMENT, TYPE=CPS4, ELSET=UPPER
3, 21, 22, 23, 24
*NSET, NSET=FIXED
11, 12, 13, 14
*NSET, NSET=MOVED
21, 22, 23, 24
*SURFACE, NAME=NODE, TYPE=NODE
3
*SURFACE, NAME=BELOW
LOWER, S3
*SURFACE, NAME=ABOVE
UPPER, S1
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*DENSITY
1.
*SOLID SECTION, ELSET=FREE, MATERIAL=M
1.
*SOLID SECTION, ELSET=LOWER, MATERIAL=M
1.
*SOLID SECTION, ELSET=UPPER, MATERIAL=M
1.
*SURFACE INTERACTION, NAME=DRY
*FRICTION
0.2
*CONTACT PAIR, INTERACTION=DRY
NODE, BELOW
*CONTACT PAIR, INTERACTION=DRY
NODE, ABOVE
*BOUNDARY
FIXED, 1, 2
*STEP, NLGEOM
*DYNAMIC, DIRECT
0.01, 1.
*BOUNDARY
MOVED, 1, 1
MOVED, 2, 2, -0.3
*END STEP
";

#[test]
fn a_run_that_stops_on_a_ray_names_the_pairs_and_leaves_the_problem() {
    let folder = TempDir::new().expect("folder");
    let deck = folder.path().join("vice.inp");
    fs::write(&deck, VICE).expect("written");
    let output = folder.path().to_string_lossy();
    let (code, _, err) = stickslip(&["run", &deck.to_string_lossy(), "-o", &output, "-q"]);
    assert_eq!(code, 1, "{err}");
    // The plates meet after 0.2 of 0.3, at time 2/3.
    assert!(err.contains("ray") && err.contains("6.6666"), "{err}");
    assert!(
        err.contains("node 3 on segment 13-14, node 3 on segment 21-22"),
        "{err}"
    );
    let left = fs::read_dir(folder.path())
        .expect("folder")
        .filter_map(Result::ok);
    let problem = left
        .map(|entry| entry.path())
        .find(|path| path.to_string_lossy().contains("vice-lcp-"))
        .expect("the problem is written");
    let (code, out, _) = stickslip(&["lcp", &problem.to_string_lossy()]);
    let answer: Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!((code, answer["status"].as_str()), (1, Some("ray")));
    assert!(
        folder.path().join("vice.vtkhdf").exists(),
        "results so far are kept"
    );
}
