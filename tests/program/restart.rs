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
        .filter(|path| path.to_string_lossy().contains(".restart-1-"))
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
    // every file that is missing, cut or of another run: refused, and nothing is touched
    let others = folder(BEAM);
    assert_done(&run(others.path(), &["--checkpoint", "1000"]));
    let all = || -> BTreeMap<_, _> {
        let entries = fs::read_dir(stopped.path()).expect("folder");
        let paths = entries.map(|entry| entry.expect("entry").path());
        paths
            .map(|path| (path.clone(), fs::read(&path).ok()))
            .collect()
    };
    for (name, text) in [
        ("job.vtkhdf", "not the result of the run"),
        ("job.sta", "not the status file of the run"),
    ] {
        let (path, other) = (stopped.path().join(name), others.path().join(name));
        let own = fs::read(&path).expect("own");
        let other = match name {
            // the same lines: of a run with one that differs
            "job.sta" => status(others.path()).replacen("1.0", "1.1", 1).into_bytes(),
            _ => fs::read(other).expect("other"),
        };
        let spoiled = [
            (None, "No such file"),
            (Some(&own[..own.len() / 2]), name),
            (Some(&other[..]), text),
        ];
        for (bytes, text) in spoiled {
            match bytes {
                Some(bytes) => fs::write(&path, bytes).expect("spoiled"),
                None => fs::remove_file(&path).expect("removed"),
            }
            let before = all();
            refused(&["--resume"], 4, text);
            assert!(all() == before, "{name}: {text}");
        }
        fs::write(&path, own).expect("put back");
    }
    assert_done(&run(stopped.path(), &["--resume"]));
    // a new run asks before it removes checkpoints
    for name in ["job.vtkhdf", "job.sta", "job.log"] {
        fs::remove_file(stopped.path().join(name)).expect(name);
    }
    refused(&[], 4, "job.restart exists already");
}

#[test]
fn two_jobs_leave_each_other_alone_and_links_are_not_followed() {
    let place = TempDir::new().expect("folder");
    let path = |name: &str| place.path().join(name);
    let short = BEAM.replacen("0.002, 0.6", "0.002, 0.02", 1);
    let keeps = with("*RESTART, WRITE, FREQUENCY=5").replacen("0.002, 0.6", "0.002, 0.02", 1);
    let job =
        |words: &[&str]| assert_done(&program(place.path(), &[&["run", "-q"], words].concat()));
    fs::write(path("case-1-5.inp"), &short).expect("deck");
    fs::write(path("case.inp"), keeps).expect("deck");
    job(&["case-1-5.inp", "--checkpoint", "1000"]);
    let other = fs::read(path("case-1-5.restart")).expect("checkpoint");
    fs::write(path("precious"), "precious").expect("file");
    let links = [
        "case.restart",
        "case.restart.part",
        "case.restart-1-5",
        "case.sta.part",
    ];
    for link in links {
        std::os::unix::fs::symlink(path("precious"), path(link)).expect(link);
    }
    // a result that has a second name keeps its text there
    fs::write(path("case.log"), "old").expect("log");
    fs::hard_link(path("case.log"), path("log")).expect("second name");
    job(&["case.inp", "--overwrite"]);
    job(&["case.inp", "--overwrite"]);
    assert_eq!(
        fs::read(path("case-1-5.restart")).expect("checkpoint"),
        other
    );
    assert_eq!(
        fs::read_to_string(path("precious")).expect("file"),
        "precious"
    );
    assert_eq!(fs::read_to_string(path("log")).expect("log"), "old");
    assert!(path("case.restart-1-5").is_file() && !path("case.restart-1-5").is_symlink());
    // flatten and check write to a name that nothing has
    for part in ["flat.inp.part", "case.svg.part"] {
        std::os::unix::fs::symlink(path("precious"), path(part)).expect(part);
    }
    assert_done(&program(
        place.path(),
        &["flatten", "case.inp", "-o", "flat.inp"],
    ));
    let words = ["check", "case.inp", "--picture", "case.svg"];
    assert_done(&program(place.path(), &words));
    assert_eq!(
        fs::read_to_string(path("precious")).expect("file"),
        "precious"
    );
    assert!(path("flat.inp").exists() && path("case.svg").exists());
}

const SECOND: &str = "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.002, 0.1\n*DLOAD, OP=NEW, AMPLITUDE=FADE\n, GRAV, 9.81, 0., -1.\n\
                      *NODE PRINT, NSET=TIP\nU\n*END STEP\n";
const THIRD: &str = "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.001, 0.05\n*END STEP\n";
const FADE: &str = "*NSET, NSET=TIP\n1\n*AMPLITUDE, NAME=FADE\n0., 1., 0.1, 0.\n";

/// The last rows of the histories of a job by the names of their datasets; the last frames.
fn last_rows(folder: &Path, job: &str, rows: usize) -> BTreeMap<String, Vec<u64>> {
    let file = hdf5::File::open(folder.join(job).with_extension("vtkhdf")).expect("a result");
    let mut found = BTreeMap::new();
    datasets(&file.group("history").expect("histories"), &mut found);
    let all = found["/history/time"].0[0];
    found.retain(|_, (shape, _)| shape[0] == all);
    let last = |(name, (shape, bits)): (String, (Vec<usize>, Vec<u64>))| {
        let width = bits.len() / shape[0];
        (name, bits[bits.len() - rows * width..].to_vec())
    };
    found.into_iter().map(last).collect()
}

/// A block that a coupling grips and a rigid box with a point mass, over a rigid floor.
const HELD_BODIES: &str = "\
*NODE
1, 0., 0.
2, 1., 0.
3, 0., 1.
4, 1., 1.
5, 0., 2.
6, 1., 2.
11, 3., 0.5
12, 4., 0.5
13, 4., 1.5
14, 3., 1.5
100, 0.5, 2.3
110, 3.5, 1.
120, 0., 0.
*ELEMENT, TYPE=CPE4, ELSET=BLOCK
1, 1, 2, 4, 3
2, 3, 4, 6, 5
*ELEMENT, TYPE=CPE4, ELSET=BOX
11, 11, 12, 13, 14
*SOLID SECTION, ELSET=BLOCK, MATERIAL=M
1.,
*SOLID SECTION, ELSET=BOX, MATERIAL=M
1.,
*MATERIAL, NAME=M
*ELASTIC
1000., 0.3
*DENSITY
1.
*ELEMENT, TYPE=MASS, ELSET=EM
901, 110
*MASS, ELSET=EM
2.
*NSET, NSET=TOP
5, 6
*RIGID BODY, ELSET=BOX, REF NODE=110
*SURFACE, NAME=TOPS
2, S3
*COUPLING, CONSTRAINT NAME=GRIP, REF NODE=100, SURFACE=TOPS
*KINEMATIC
*SURFACE, NAME=FLOOR, TYPE=SEGMENTS
START, -2., 0.
LINE, 8., 0.
*RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=120
*SURFACE, NAME=SOLES
1, S1
11, S1
*SURFACE INTERACTION, NAME=DRY
*FRICTION
0.3
*CONTACT PAIR, INTERACTION=DRY
SOLES, FLOOR
";

#[test]
fn a_later_job_frees_rigid_bodies_that_all_earlier_steps_hold() {
    let held = "*BOUNDARY\n100, 1, 1, 0.003\n100, 2, 2, -0.01\n100, 6, 6, 0.002\n110, 1, 2\n110, 6, 6\n120, 1, 2\n\
                *DLOAD\n, GRAV, 9.81, 0., -1.\n";
    let free = "*BOUNDARY, OP=NEW\n120, 1, 2\n";
    let box_held = "110, 1, 2\n110, 6, 6\n";
    for (procedure, left) in [
        ("*DYNAMIC, DIRECT\n0.01, 0.1\n", free.to_owned()),
        ("*STATIC\n0.25, 1.\n", format!("{free}{box_held}")),
    ] {
        let place = TempDir::new().expect("folder");
        let step = |cards: &str| format!("*STEP, NLGEOM\n{procedure}{cards}*END STEP\n");
        let (first, second) = (step(held), step(&left));
        let decks = [
            ("whole", format!("{HELD_BODIES}{first}{second}"), vec![]),
            (
                "first",
                format!("{HELD_BODIES}*RESTART, WRITE, FREQUENCY=100\n{first}"),
                vec![],
            ),
            (
                "second",
                format!("*RESTART, READ\n{second}"),
                vec!["--oldjob", "first"],
            ),
        ];
        for (name, text, words) in decks {
            let deck = format!("{name}.inp");
            fs::write(place.path().join(&deck), text).expect("deck");
            let all = [&["run", "-q", &deck], words.as_slice()].concat();
            assert_done(&program(place.path(), &all));
        }
        let file = hdf5::File::open(place.path().join("second.vtkhdf")).expect("a result");
        let times = file.dataset("history/time").expect("times");
        let rows = times.shape()[0];
        assert!(rows > 3, "{procedure} {rows}");
        // the state that the second job begins from has no forces
        let whole = last_rows(place.path(), "whole", rows - 1);
        let second = last_rows(place.path(), "second", rows - 1);
        for name in ["/history/rigid/GRIP/angle", "/history/rigid/BOX/force"] {
            assert!(second.contains_key(name), "{name}");
        }
        for (name, bits) in &second {
            assert_eq!(whole.get(name), Some(bits), "{procedure} {name}");
        }
    }
}

#[test]
fn a_deck_goes_on_from_the_end_of_another_job_in_the_same_bits() {
    let place = TempDir::new().expect("folder");
    let path = |name: &str| place.path().join(name);
    let write = |name: &str, text: &str| fs::write(path(name), text).expect("deck");
    let (mesh, step) = BEAM.split_once("\n*STEP").expect("a step");
    write(
        "whole.inp",
        &format!("{mesh}\n{FADE}*STEP{step}\n{SECOND}{THIRD}"),
    );
    write("mesh.inp", mesh);
    write(
        "one.inp",
        &format!("*PARAMETER\nlong = 0.5\n*INCLUDE, INPUT=mesh.inp\n*RESTART, WRITE, FREQUENCY=70\n*STEP{step}\n")
            .replacen("0.002, 0.6", "0.002, <long>", 1),
    );
    write(
        "two.inp",
        &format!("*RESTART, READ, STEP=1, END STEP\n{FADE}{SECOND}"),
    );
    write(
        "three.inp",
        &format!("*HEADING\nthe end\n*RESTART, READ\n{THIRD}"),
    );
    let job = |words: &[&str]| program(place.path(), &[&["run", "-q"], words].concat());
    assert_done(&job(&["whole.inp"]));
    assert_done(&job(&["one.inp", "--set", "long=0.6"]));
    // the checkpoint has the decks
    fs::remove_file(path("mesh.inp")).expect("removed");
    fs::remove_file(path("one.inp")).expect("removed");
    assert_done(&job(&[
        "two.inp",
        "--oldjob",
        "one",
        "--checkpoint",
        "1000",
    ]));
    assert_done(&job(&[
        "three.inp",
        "--oldjob",
        "two.restart",
        "--checkpoint",
        "0",
    ]));
    assert_done(&job(&["three.inp", "--resume"]));
    let rows = |job: &str| {
        let file = hdf5::File::open(path(job)).expect("a result");
        let dataset = file.dataset("history/time").expect("times");
        dataset.shape()[0]
    };
    let (two, three) = (rows("two.vtkhdf"), rows("three.vtkhdf"));
    assert!(two >= 51 && three >= 51, "{two} {three}");
    // those of the second job, with the state that it begins from, stand before those of the third
    let whole = last_rows(place.path(), "whole", two + three - 1);
    let (a, b) = (
        last_rows(place.path(), "two", two),
        last_rows(place.path(), "three", three),
    );
    assert_eq!(
        whole.keys().collect::<Vec<_>>(),
        a.keys().collect::<Vec<_>>()
    );
    for (name, rows) in &whole {
        let width = rows.len() / (two + three - 1);
        assert_eq!(rows[..two * width], a[name][..], "{name} of the second job");
        if let Some(b) = b.get(name) {
            assert_eq!(rows[(two - 1) * width..], b[..], "{name} of the third job");
        }
    }
    let refused = |words: &[&str], code: i32, text: &str| {
        let output = job(words);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{message}");
        assert!(message.contains(text), "{message}");
    };
    refused(
        &["two.inp", "--overwrite"],
        2,
        "which job does this deck go on from?",
    );
    let early = ["two.inp", "--overwrite", "--oldjob", "one.restart-1-70"];
    refused(
        &early,
        2,
        "of increment 70 of step 1, which is not the end of the step",
    );
    let other = ["whole.inp", "--overwrite", "--oldjob", "one"];
    refused(&other, 2, "has no *RESTART, READ");
    write(
        "more.inp",
        &format!("*RESTART, READ\n*NODE\n99999, 0., 0.\n{THIRD}"),
    );
    refused(
        &["more.inp", "--oldjob", "one"],
        2,
        "*NODE would change the model of the earlier job",
    );
    write(
        "more.inp",
        &format!("*RESTART, READ\n*NSET, NSET=A_T\n1\n*ELSET, ELSET=A\n1\n{THIRD}"),
    );
    refused(
        &["more.inp", "--oldjob", "one"],
        2,
        "a set of the earlier job cannot have other members",
    );
    // in the middle of a step: the rest of it comes first
    write(
        "two.inp",
        &format!("*RESTART, READ, STEP=1, INC=70\n{FADE}{SECOND}"),
    );
    assert_done(&job(&[
        "two.inp",
        "--overwrite",
        "--oldjob",
        "one.restart-1-70",
    ]));
    let rows = rows("two.vtkhdf");
    let whole = last_rows(place.path(), "whole", two + three - 1);
    let all = last_rows(place.path(), "two", rows);
    let name = "/history/energy/kinetic";
    assert!(rows > 200 && all[name].ends_with(&whole[name][..two]));
}

/// Two blocks, one on the other, with pairs from surface to surface in both orders, which are one contact.
const BOTH_ORDERS: &str = "\
*NODE
1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n5, 0., 1.\n6, 1., 1.\n7, 1., 2.\n8, 0., 2.
*ELEMENT, TYPE=CPE4, ELSET=ALL
1, 1, 2, 3, 4\n2, 5, 6, 7, 8
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*DENSITY
1.
*SOLID SECTION, ELSET=ALL, MATERIAL=M
*SURFACE, NAME=LOW
1, S3
*SURFACE, NAME=HIGH
2, S1
*SURFACE INTERACTION, NAME=DRY
*FRICTION
.3
*CONTACT PAIR, INTERACTION=DRY, TYPE=SURFACE TO SURFACE
LOW, HIGH\nHIGH, LOW
*BOUNDARY
1, 1, 2\n2, 1, 2
*RESTART, WRITE, FREQUENCY=100
*STEP, NLGEOM
*DYNAMIC, DIRECT
0.01, 0.02
*CLOAD
7, 2, -1.\n8, 2, -1.
*END STEP
";

#[test]
fn a_later_job_changes_pairs_in_both_orders_alike_or_says_that_it_is_of_another_model() {
    let place = TempDir::new().expect("folder");
    fs::write(place.path().join("first.inp"), BOTH_ORDERS).expect("deck");
    assert_done(&program(place.path(), &["run", "-q", "first.inp"]));
    let second = |changes: &str| {
        let deck = format!(
            "*RESTART, READ\n*STEP, NLGEOM\n*DYNAMIC, DIRECT\n.01, .02\n{changes}*END STEP\n"
        );
        fs::write(place.path().join("second.inp"), deck).expect("deck");
        let words = [
            "run",
            "-q",
            "--overwrite",
            "second.inp",
            "--oldjob",
            "first",
        ];
        program(place.path(), &words)
    };
    assert_done(&second(
        "*CHANGE FRICTION, INTERACTION=DRY\n*FRICTION\n.1\n",
    ));
    let remove = "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nLOW, HIGH\n";
    assert_done(&second(&format!("{remove}HIGH, LOW\n")));
    // one of both orders goes: the model has two contacts then
    let output = second(remove);
    assert_eq!(output.status.code(), Some(4));
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(
        text.contains("cannot go on from the checkpoint: it is of another model"),
        "{text}"
    );
}
