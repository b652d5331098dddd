//! Decks through the real binary: exit codes, files, messages.

#[path = "files.rs"]
mod files;

use std::fs;
use std::path::PathBuf;

use assert_cmd::Command;
use stickslip::output::ResultSummary;
use tempfile::TempDir;

/// A square that lands on a base: 50 increments, a frame every 10.
const DROP: &str = include_str!("../decks/drop.inp");

/// A folder with decks in which the program runs.
struct Bench {
    folder: TempDir,
}

impl Bench {
    fn new(deck: &str) -> Self {
        let folder = TempDir::new().expect("folder");
        fs::write(folder.path().join("drop.inp"), deck).expect("deck");
        Bench { folder }
    }

    /// Exit code, standard output and standard error.
    fn stickslip(&self, arguments: &[&str]) -> (i32, String, String) {
        let mut command = Command::cargo_bin("stickslip").expect("binary");
        let command = command.args(arguments).current_dir(self.folder.path());
        let output = command.output().expect("started");
        let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
        let code = output.status.code().expect("ended by itself");
        (code, text(&output.stdout), text(&output.stderr))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).expect(name)
    }

    fn summary(&self, name: &str) -> ResultSummary {
        ResultSummary::read(&self.path(name)).expect(name)
    }
}

#[test]
fn a_run_from_deck_to_results() {
    let bench = Bench::new(DROP);
    let (code, out, err) = bench.stickslip(&["run", "drop.inp"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    let summary = bench.summary("drop.vtkhdf");
    assert_eq!((summary.increments, summary.frames.len()), (50, 6));
    assert_eq!(summary.command, "stickslip run drop.inp");
    assert_eq!(bench.read("drop.sta").lines().count(), 52);
    for text in [
        "deck     drop.inp, 49 lines: 0 errors, 0 warnings",
        "model    8 nodes   2 elements (CPS4)   16 dofs, 4 fixed   mass 3",
        "contact  FOOT (2 nodes) -> TOP (1 edge)   node to surface   mu 0.2",
        "smallest gap 1.0e-02",
        "wrote drop.vtkhdf (6 frames,",
    ] {
        assert!(out.contains(text), "{text}\n{out}");
    }
    assert_eq!(bench.read("drop.log"), out);
    assert!(out.lines().all(|line| line.len() <= 80), "{out}");
}

#[test]
fn earlier_results_are_kept_unless_told() {
    let bench = Bench::new(DROP);
    let first = bench.stickslip(&["run", "drop.inp", "-o", "a/b", "-q"]);
    assert_eq!(first, (0, String::new(), String::new()));
    let (code, _, err) = bench.stickslip(&["run", "drop.inp", "-o", "a/b", "-q"]);
    assert_eq!(code, 4);
    assert!(err.contains("--overwrite"), "{err}");
    let again = [
        "run",
        "drop.inp",
        "-o",
        "a/b",
        "-q",
        "--overwrite",
        "--every",
        "0.05",
    ];
    assert_eq!(bench.stickslip(&again).0, 0);
    assert_eq!(bench.summary("a/b/drop.vtkhdf").frames.len(), 3);
}

#[test]
fn the_command_line_wins_over_the_deck() {
    let bench = Bench::new(DROP);
    let options = ["--frames", "2", "--solver", "sprs", "--threads", "1", "-v"];
    let arguments = [&["run", "drop.inp"], &options[..]].concat();
    let (code, out, _) = bench.stickslip(&arguments);
    assert_eq!(code, 0);
    assert_eq!(bench.summary("drop.vtkhdf").frames.len(), 3);
    let log = bench.read("drop.log");
    for text in [
        "output 2 frames as the command line says, not output every 10 increments",
        "solver sprs as the command line says, not faer",
        "1 thread",
    ] {
        assert!(out.contains(text) && log.contains(text), "{text}\n{out}");
    }
    assert!(log.contains("increment 50 of step 1: time 1.000000e-01, dt 2.000e-03"));
    assert!(log.contains("     pass  residual correction"));
}

#[test]
fn a_deck_with_errors_touches_no_result() {
    let deck = DROP
        .replace("*BOUNDARY", "*BONDARY")
        .replace("\n1000., ", "\n1.x, ");
    let bench = Bench::new(&deck);
    fs::write(bench.path("drop.vtkhdf"), "precious").expect("old result");
    for arguments in [
        &["run", "drop.inp", "--overwrite"][..],
        &["check", "drop.inp"],
    ] {
        let (code, _, err) = bench.stickslip(arguments);
        assert_eq!(code, 2, "{err}");
        assert!(
            err.contains("*BONDARY") && err.contains("^^^^^^^^"),
            "{err}"
        );
        assert!(
            err.contains("drop.inp:37:1") && err.contains("1.x"),
            "{err}"
        );
    }
    assert_eq!(bench.read("drop.vtkhdf"), "precious");
    assert!(!bench.path("drop.log").exists());
}

#[test]
fn a_deck_without_analysis_is_checked_only() {
    let step = DROP.replacen("*END STEP", "*NO ANALYSIS\n*END STEP", 1);
    for deck in [step, DROP.replacen("*STEP", "*NO ANALYSIS\n*STEP", 1)] {
        let bench = Bench::new(&deck);
        let (code, out, err) = bench.stickslip(&["run", "drop.inp"]);
        assert_eq!((code, err.as_str()), (0, ""), "{out}");
        assert!(out.contains("0 errors") && out.contains("extents"), "{out}");
        let last = out.lines().last().expect("a line");
        assert!(last.ends_with("the deck has *NO ANALYSIS"), "{out}");
        let (code, out, err) = bench.stickslip(&["run", "-q", "drop.inp"]);
        assert_eq!((code, out.as_str(), err.as_str()), (0, "", ""));
        assert!(!bench.path("drop.vtkhdf").exists() && !bench.path("drop.log").exists());
        let faulty = Bench::new(&deck.replacen("*END STEP", "*BONDARY\n*END STEP", 1));
        assert_eq!(faulty.stickslip(&["run", "drop.inp"]).0, 2);
    }
}

#[test]
fn check_describes_the_model_and_solves_nothing() {
    let bench = Bench::new(DROP);
    let (code, out, _) = bench.stickslip(&["check", "drop.inp"]);
    assert_eq!(code, 0);
    assert!(out.contains("extents [0,2] x [0,2.01]"), "{out}");
    assert!(!bench.path("drop.vtkhdf").exists());
    let sunk = Bench::new(&DROP.replace("1.01\n", "0.9\n"));
    let (code, _, err) = sunk.stickslip(&["check", "drop.inp"]);
    assert_eq!(code, 2);
    assert!(
        err.contains("2 nodes of FOOT inside the body of TOP"),
        "{err}"
    );
}

#[test]
fn a_crash_stops_with_the_last_good_state() {
    let bench = Bench::new(&DROP.replace("2, -0.5", "2, -5000."));
    let (code, out, _) = bench.stickslip(&["run", "drop.inp"]);
    assert_eq!(code, 1, "{out}");
    for text in [
        "cutback ",
        "stopped ",
        "tried ",
        "is valid up to its last frame",
    ] {
        assert!(out.contains(text), "{text}\n{out}");
    }
    let summary = bench.summary("drop.vtkhdf");
    assert_eq!(summary.exit_status, 1);
    assert_eq!(summary.frames.last(), Some(&summary.time));
}

/// The text between the labels of a cutback and of the next table, words one blank apart.
fn told(change: [&str; 2]) -> String {
    let bench = Bench::new(&DROP.replace(change[0], change[1]));
    let (_, out, _) = bench.stickslip(&["run", "drop.inp"]);
    assert!(out.lines().all(|line| line.len() <= 80), "{out}");
    let lines = out.lines().skip_while(|line| !line.starts_with("cutback"));
    let words: Vec<&str> = lines.flat_map(str::split_whitespace).collect();
    words.join(" ")
}

#[test]
fn a_cutback_tells_how_the_passes_went_and_what_to_change() {
    let settings = "0.002, 0.1\n*STICKSLIP, MAX PASSES=2";
    let few = told(["0.002, 0.1", settings]);
    assert!(
        few.contains("the passes did not converge about 2 more passes were needed"),
        "{few}"
    );
    let advice = "advice raise MAX PASSES of *STICKSLIP to 4 or more";
    assert_eq!(few.matches("advice").count(), 1, "said once: {few}");
    assert!(few.contains(advice), "{few}");
    // enough passes, as advised
    let enough = told(["0.002, 0.1", &settings.replace("=2", "=4")]);
    assert_eq!(enough, "", "no cutback");
    let crushed = told(["2, -0.5", "2, -5000."]);
    assert!(
        crushed.contains("turned inside out") && crushed.contains("NEO HOOKE"),
        "{crushed}"
    );
}

#[test]
fn the_errors_of_the_answer_are_those_of_the_result_file() {
    let bench = Bench::new(DROP);
    let (_, out, _) = bench.stickslip(&["run", "drop.inp"]);
    let (_, info, _) = bench.stickslip(&["info", "drop.vtkhdf"]);
    let errors = |text: &str| -> Vec<String> {
        let mut lines = text
            .lines()
            .skip_while(|line| !line.starts_with("checks   "));
        let wraps = |line: &str| line.starts_with("         ");
        let first = lines.next().into_iter();
        first
            .chain(lines.take_while(|line| wraps(line)))
            .map(str::to_owned)
            .collect()
    };
    assert!(
        errors(&out)[0].starts_with("checks   all hold   residual"),
        "{out}"
    );
    assert!(errors(&out).concat().contains("energy balance"), "{out}");
    assert_eq!(errors(&out), errors(&info));
}

#[test]
fn a_quiet_crash_is_told_on_the_standard_error() {
    let bench = Bench::new(&DROP.replace("2, -0.5", "2, -5000."));
    let (code, out, err) = bench.stickslip(&["run", "drop.inp", "-q"]);
    assert_eq!((code, out.as_str()), (1, ""));
    assert!(
        err.starts_with("stopped ") && err.contains("worst "),
        "{err}"
    );
}

#[test]
fn strict_and_lenient_reading() {
    let bench = Bench::new(&DROP.replace("*BOUNDARY\n", "*BONDARY\n1, 1\n*BOUNDARY\n"));
    let (code, _, err) = bench.stickslip(&["check", "drop.inp"]);
    assert_eq!(code, 2, "{err}");
    let (code, out, err) = bench.stickslip(&["check", "drop.inp", "--lenient"]);
    assert_eq!(code, 0, "{err}");
    assert!(
        err.starts_with("warning") && out.contains("1 warning"),
        "{err}{out}"
    );
    let both = ["check", "drop.inp", "--lenient", "--strict"];
    assert_eq!(bench.stickslip(&both).0, 3);
}

#[test]
fn what_is_doubtful_before_the_run_is_on_the_screen_and_in_the_log() {
    let wrong_side = DROP
        .replace("BASE, S3", "BASE, S1")
        .replace("DYNAMIC, DIRECT", "DYNAMIC, HALFINC SCALE FACTOR=5000.");
    let bench = Bench::new(&wrong_side.replace("2.01", "3.01").replace("1.01", "2.01"));
    let told = |text: &str| ["D418", "D516"].map(|code| text.contains(code)) == [true, true];
    let (code, out, err) = bench.stickslip(&["check", "drop.inp"]);
    assert_eq!(code, 0, "{err}");
    assert!(told(&err) && out.contains("2 warnings"), "{err}{out}");
    let (code, out, err) = bench.stickslip(&["run", "drop.inp"]);
    assert_eq!(code, 0, "{err}");
    assert!(told(&err) && told(&bench.read("drop.log")), "{err}{out}");
    let strict = bench.stickslip(&["check", "drop.inp", "--strict"]);
    assert_eq!(strict.0, 2, "{}", strict.2);
}

/// [`DROP`] with n x n elements in the square and in the base, for three increments.
fn fine_drop(n: usize) -> String {
    let mut deck = String::from("*HEADING\nsquares\n");
    let row = |body: usize, j: usize| body * (n + 1) * (n + 1) + j * (n + 1) + 1;
    for (body, name) in ["BASE", "SQUARE"].into_iter().enumerate() {
        deck += &format!("*NODE, NSET={name}\n");
        for (i, j) in (0..(n + 1) * (n + 1)).map(|k| (k % (n + 1), k / (n + 1))) {
            let [x, y] = [i, j].map(|k| k as f64 / n as f64);
            deck += &format!("{}, {x}, {}\n", row(body, j) + i, y + 1.001 * body as f64);
        }
        deck += &format!("*ELEMENT, TYPE=CPS4, ELSET={name}\n");
        for (i, j) in (0..n * n).map(|k| (k % n, k / n)) {
            let (a, b) = (row(body, j) + i, row(body, j + 1) + i);
            let element = body * n * n + j * n + i + 1;
            deck += &format!("{element}, {a}, {}, {}, {b}\n", a + 1, b + 1);
        }
    }
    let sets = [
        ("*ELSET, ELSET=HIGHEST", [n * n - n + 1, n * n]),
        ("*ELSET, ELSET=LOWEST", [n * n + 1, n * n + n]),
        ("*NSET, NSET=FIXED", [1, n + 1]),
    ];
    for (set, [first, last]) in sets {
        deck += &format!("{set}, GENERATE\n{first}, {last}\n");
    }
    let rest = &DROP[DROP.find("*MATERIAL").unwrap()..];
    let rest = rest
        .replace("SQUARE, S1", "LOWEST, S1")
        .replace("BASE, S3", "HIGHEST, S3");
    deck + &rest.replace("0.002, 0.1\n", "0.002, 0.006\n")
}

#[test]
fn threads_do_not_change_the_results() {
    for deck in [DROP.into(), fine_drop(50)] {
        let bench = Bench::new(&deck);
        for threads in ["1", "2", "4"] {
            let folder = format!("t{threads}");
            let arguments = ["run", "drop.inp", "-q", "-o", &folder, "--threads", threads];
            assert_eq!(bench.stickslip(&arguments).0, 0);
        }
        for threads in ["2", "4"] {
            let [one, more] = ["1", threads].map(|threads| format!("t{threads}/drop"));
            let status = [&one, &more].map(|file| bench.read(&format!("{file}.sta")));
            assert_eq!(status[0], status[1]);
            let mut diff = std::process::Command::new("h5diff");
            diff.args(["--exclude-path", "/run"]);
            diff.args([one, more].map(|file| format!("{file}.vtkhdf")));
            match diff.current_dir(bench.folder.path()).output() {
                Ok(output) => assert!(output.status.success(), "{output:?}"),
                Err(_) => eprintln!("h5diff is not installed: not compared"),
            }
        }
    }
}

#[test]
fn frames_at_no_interval_are_all_increments() {
    let asked = [
        "*OUTPUT, FIELD, FREQUENCY=10",
        "*OUTPUT, FIELD, TIME INTERVAL=1e-300",
    ];
    let bench = Bench::new(&DROP.replace(asked[0], asked[1]));
    for (options, output) in [
        (&[][..], "a"),
        (&["--every", "1e-21"], "b"),
        (&["--frames", "18446744073709551615"], "c"),
    ] {
        let arguments = [&["run", "drop.inp", "-o", output], options].concat();
        let (code, out, err) = bench.stickslip(&arguments);
        assert_eq!((code, err.as_str()), (0, ""));
        assert!(
            out.contains("note     frames are asked for at shorter"),
            "{out}"
        );
        let result = bench.summary(&format!("{output}/drop.vtkhdf"));
        assert_eq!(result.frames.len(), 51);
    }
}

#[test]
fn the_name_of_a_job_has_no_extension_in_capitals_either() {
    let bench = Bench::new(DROP);
    fs::rename(bench.path("drop.inp"), bench.path("B.INP")).expect("renamed");
    assert_eq!(bench.stickslip(&["run", "B.INP", "-q"]).0, 0);
    assert!(bench.path("B.log").exists() && bench.path("B.vtkhdf").exists());
}

/// The warnings of the log, which are those that `info` finds in the file alone.
fn warnings(change: [&str; 2]) -> String {
    assert!(DROP.contains(change[0]), "{}", change[0]);
    let bench = Bench::new(&DROP.replacen(change[0], change[1], 1));
    let (code, out, err) = bench.stickslip(&["run", "drop.inp"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    let (_, info, _) = bench.stickslip(&["info", "drop.vtkhdf"]);
    let found = |text: &str| -> String {
        let lines = text.lines().skip_while(|line| !line.starts_with("warning"));
        let lines = lines.take_while(|line| !line.starts_with("wrote"));
        lines.collect::<Vec<_>>().join("\n")
    };
    assert_eq!(found(&bench.read("drop.log")), found(&info));
    found(&out)
}

#[test]
fn runs_are_warned_about_when_they_shall_be_looked_at_again() {
    let plain = warnings(["*HEADING", "*HEADING"]);
    let mass = "warning  impulses that stop the mass of landing nodes took 1.8e-01";
    assert!(plain.starts_with(mass), "its elements are large: {plain}");
    assert_eq!(plain.matches("warning").count(), 1, "{plain}");
    for (change, words) in [
        (
            ["SQUARE, 2, -0.5", "SQUARE, 2, 0.5"],
            "contact FOOT_TOP never closed",
        ),
        (
            ["0.002, 0.1", "0.05, 0.1"],
            "nodes that land within increments took",
        ),
        (
            ["0.002, 0.1", "0.2, 0.4"],
            "increments of 0.2 are longer than a wave",
        ),
        (
            ["0.002, 0.1", "2e-4, 0.032"],
            "less than a 100th of the time a",
        ),
        (
            ["0.002, 0.1", "0.002, 0.1\n*STICKSLIP, TOLERANCE=1e-2"],
            "the energy balance is off by",
        ),
    ] {
        let text = warnings(change);
        assert!(text.contains(words), "{words}: {text}");
        assert!(text.lines().all(|line| line.len() <= 80), "{text}");
    }
}

#[test]
fn equations_of_a_deck_are_echoed_and_kept() {
    let tie = "*EQUATION\n2\n7, 2, 1., 8, 2, -1.\n*STEP";
    let bench = Bench::new(&DROP.replacen("*STEP", tie, 1));
    let (code, out, err) = bench.stickslip(&["run", "drop.inp"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert!(out.contains("1 equation between displacements"), "{out}");
}

#[test]
fn a_number_of_a_turning_body_that_is_not_finite_is_that_of_its_reference_node() {
    let ties = include_str!("../decks/ties.inp");
    let fast = ties.replacen("ALL, 2.5,", "ALL, 1e300,", 1);
    assert_ne!(fast, ties);
    let (code, out, err) = Bench::new(&fast).stickslip(&["run", "drop.inp"]);
    assert_eq!(code, 1, "{out}{err}");
    assert!(out.contains("node     9"), "{out}{err}");
}
