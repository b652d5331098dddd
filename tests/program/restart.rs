//! A run that goes on from a checkpoint writes the same file as one that was never stopped.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use hdf5::Group;
use tempfile::TempDir;

const BEAM: &str = include_str!("../decks/beam_lands_with_events.inp");

fn program(folder: &Path, words: &[&str]) -> Output {
    let mut command = Command::cargo_bin("stickslip").expect("the program");
    let output = command.current_dir(folder).args(words).output();
    output.expect("started")
}

fn run(folder: &Path, words: &[&str]) -> Output {
    program(folder, &[&["run", "job.inp", "-q"], words].concat())
}

/// A folder with a deck.
fn folder(deck: &str) -> TempDir {
    let folder = TempDir::new().expect("folder");
    fs::write(folder.path().join("job.inp"), deck).expect("deck");
    folder
}

/// The deck with more cards above its step.
fn with(cards: &str) -> String {
    BEAM.replacen("*STEP", &format!("{cards}\n*STEP"), 1)
}

/// All datasets outside /run, bit by bit, by their names.
fn datasets(group: &Group, found: &mut BTreeMap<String, (Vec<usize>, Vec<u64>)>) {
    for name in group.member_names().expect("names") {
        if let Ok(inner) = group.group(&name) {
            if inner.name() != "/run" {
                datasets(&inner, found);
            }
        } else if let Ok(dataset) = group.dataset(&name) {
            let bits = dataset.read_raw::<f64>().unwrap_or_default();
            let bits = bits.iter().map(|value| value.to_bits()).collect();
            found.insert(dataset.name(), (dataset.shape(), bits));
        }
    }
}

fn contents(folder: &Path) -> BTreeMap<String, (Vec<usize>, Vec<u64>)> {
    let file = hdf5::File::open(folder.join("job.vtkhdf")).expect("a result");
    let mut found = BTreeMap::new();
    datasets(&file, &mut found);
    assert!(found.len() > 40, "{}", found.len());
    found
}

fn status(folder: &Path) -> String {
    fs::read_to_string(folder.join("job.sta")).expect("status file")
}

/// That two runs have the same results.
fn assert_same(one: &Path, other: &Path) {
    let (a, b) = (contents(one), contents(other));
    let differing: Vec<&String> = a
        .keys()
        .filter(|name| a.get(*name) != b.get(*name))
        .collect();
    assert!(differing.is_empty() && a.len() == b.len(), "{differing:?}");
    assert_eq!(status(one), status(other));
}

fn assert_done(output: &Output) {
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn a_run_goes_on_from_every_checkpoint_in_the_same_bits() {
    let (whole, stopped) = (folder(BEAM), folder(&with("*RESTART, WRITE, FREQUENCY=70")));
    assert_done(&run(whole.path(), &["--threads", "1"]));
    assert_done(&run(stopped.path(), &["--threads", "2"]));
    assert_same(whole.path(), stopped.path());
    let mut kept: Vec<_> = fs::read_dir(stopped.path())
        .expect("folder")
        .map(|entry| entry.expect("entry").path())
        .filter(|path| path.to_string_lossy().contains("-1-"))
        .collect();
    kept.sort();
    assert!(kept.len() > 3, "{kept:?}");
    for checkpoint in &kept {
        let restart = stopped.path().join("job.restart");
        fs::remove_file(&restart).expect("removed");
        fs::copy(checkpoint, &restart).expect("copied");
        assert_done(&run(stopped.path(), &["--resume", "--threads", "1"]));
        assert_same(whole.path(), stopped.path());
    }
    // a new run forgets them
    assert_done(&run(stopped.path(), &["--overwrite"]));
    fs::write(stopped.path().join("job.inp"), BEAM).expect("deck");
    assert_done(&run(stopped.path(), &["--overwrite"]));
    assert!(!kept[0].exists() && !stopped.path().join("job.restart").exists());
}

#[test]
fn a_run_goes_on_beyond_its_end() {
    let long = BEAM.replacen("0.002, 0.6", "0.002, 0.7", 1);
    assert_ne!(long, BEAM);
    let (whole, extended) = (folder(&long), folder(BEAM));
    assert_done(&run(whole.path(), &["--every", "0.05"]));
    assert_done(&run(
        extended.path(),
        &["--every", "0.05", "--checkpoint", "1000"],
    ));
    assert_done(&run(extended.path(), &["--resume", "--extend", "0.05"]));
    assert_done(&run(extended.path(), &["--resume", "--extend", "0.05"]));
    let [a, b] = [whole.path(), extended.path()].map(contents);
    // the last increments before 0.6 and 0.65 end there, and not at multiples of 0.002, which differ in round-off
    for name in [
        "/history/time",
        "/history/energy/kinetic",
        "/VTKHDF/Steps/Values",
    ] {
        let [(_, a), (_, b)] = [&a[name], &b[name]];
        assert_eq!(a.len(), b.len(), "{name}");
        let near = |(a, b): (&u64, &u64)| {
            let [a, b] = [a, b].map(|bits| f64::from_bits(*bits));
            assert!((a - b).abs() <= 1e-6 * (a.abs() + 1e-3), "{name} {a} {b}");
        };
        a.iter().zip(b).for_each(near);
    }
}

#[test]
fn what_cannot_go_on_says_why() {
    let stopped = folder(BEAM);
    let refused = |words: &[&str], code: i32, text: &str| {
        let output = run(stopped.path(), words);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{message}");
        assert!(message.contains(text), "{message}");
    };
    refused(&["--resume"], 4, "there is no checkpoint");
    assert_done(&run(stopped.path(), &["--checkpoint", "0"]));
    let before = status(stopped.path());
    refused(&["--resume", "--overwrite"], 3, "cannot be used with");
    refused(&["--resume", "--frames", "3"], 3, "cannot be used with");
    refused(&["--extend", "1"], 3, "--resume");
    refused(&["--checkpoint", "soon"], 3, "a number of seconds");
    let path = stopped.path().join("job.inp");
    fs::write(&path, BEAM.replacen("0.002, 0.6", "0.002, 0.65", 1)).expect("deck");
    refused(&["--resume"], 2, "error[D211]");
    refused(&["--resume"], 2, "`0.65` of *DYNAMIC was `0.6` of *DYNAMIC");
    fs::write(&path, BEAM).expect("deck");
    let restart = stopped.path().join("job.restart");
    let bytes = fs::read(&restart).expect("bytes");
    fs::write(&restart, &bytes[..bytes.len() / 2]).expect("cut");
    refused(&["--resume"], 4, "no whole checkpoint");
    fs::write(&restart, &bytes).expect("whole");
    assert_eq!(before, status(stopped.path()));
    // it has ended: nothing is left to do
    assert_done(&run(stopped.path(), &["--resume"]));
    assert_eq!(before, status(stopped.path()));
    fs::remove_file(stopped.path().join("job.vtkhdf")).expect("removed");
    refused(&["--resume"], 4, "job.vtkhdf");
}
