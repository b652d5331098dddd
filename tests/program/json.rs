//! Messages for programs: `check --format json`.

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

const SQUARE: &str = include_str!("../decks/square.inp");

/// Exit code and answer for a deck.
fn check(deck: &str, words: &[&str]) -> (Option<i32>, Value) {
    let folder = TempDir::new().expect("folder");
    std::fs::write(folder.path().join("job.inp"), deck).expect("deck");
    let mut command = Command::cargo_bin("stickslip").expect("the program");
    command.current_dir(folder.path()).arg("check");
    command.args(["job.inp", "--format", "json"]).args(words);
    let output = command.output().expect("started");
    assert!(output.stderr.is_empty(), "{output:?}");
    let answer = serde_json::from_slice(&output.stdout).expect("one JSON object");
    (output.status.code(), answer)
}

#[test]
fn messages_have_codes_and_ranges() {
    let deck = SQUARE.replacen("1000., 0.3", "<e>, 0.3x", 1);
    let (code, answer) = check(&deck, &["--set", "e=1000."]);
    assert_eq!((code, &answer["errors"]), (Some(2), &Value::from(1)));
    let found = &answer["diagnostics"][0];
    assert_eq!(
        (&found["severity"], &found["code"]),
        (&"error".into(), &"D108".into())
    );
    let place = &found["place"];
    assert_eq!(place["file"], "job.inp");
    // behind the name that was typed, not behind its value
    let line = deck
        .lines()
        .position(|line| line.starts_with("<e>"))
        .expect("a line")
        + 1;
    assert_eq!(
        place["start"],
        serde_json::json!({"line": line, "column": 6})
    );
    assert_eq!(
        place["end"],
        serde_json::json!({"line": line, "column": 10})
    );
    // a name that the result file cannot have
    let (code, answer) = check(&SQUARE.replace("FOOT", "\"a/b\""), &[]);
    assert_eq!(
        (code, &answer["diagnostics"][0]["code"]),
        (Some(2), &"D113".into())
    );
    let (code, answer) = check(SQUARE, &[]);
    assert_eq!((code, &answer["errors"]), (Some(0), &Value::from(0)));
    let (code, answer) = check(SQUARE, &["--set", "e=1"]);
    assert_eq!(
        (code, &answer["diagnostics"][0]["place"]),
        (Some(2), &Value::Null)
    );
}
