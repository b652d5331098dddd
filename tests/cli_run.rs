//! Decks through the real binary: exit codes, files, messages.

use std::fs;
use std::path::PathBuf;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use assert_cmd::Command;
use stickslip::output::ResultSummary;
use tempfile::TempDir;

/// A square that lands on a base: 50 increments, a frame every 10.
const DROP: &str = include_str!("decks/drop.inp");

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

    /// Starts the program and does not wait for it.
    fn start(&self, arguments: &[&str]) -> Child {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_stickslip"));
        let command = command.args(arguments).current_dir(self.folder.path());
        let quiet = command.stdin(Stdio::null()).stdout(Stdio::null());
        quiet.stderr(Stdio::piped()).spawn().expect("started")
    }

    /// Starts a run that would take years and waits for its first frame.
    fn start_endless(&self) -> Child {
        let deck = DROP.replace("0.002, 0.1", "0.002, 1e8");
        fs::write(self.path("drop.inp"), deck).expect("deck");
        let run = self.start(&["run", "drop.inp", "-q", "--overwrite"]);
        let start = Instant::now();
        while !self.path("drop.vtkhdf").exists() {
            assert!(start.elapsed() < Duration::from_secs(20), "no first frame");
            std::thread::sleep(Duration::from_millis(5));
        }
        fs::write(self.path("drop.inp"), DROP).expect("deck");
        run
    }

    /// Runs a line of a shell in which `$0` is the program.
    fn shell(&self, line: &str) -> (i32, String) {
        let mut command = Command::new("bash");
        let command = command.args(["-c", line, env!("CARGO_BIN_EXE_stickslip")]);
        let output = command.current_dir(self.folder.path()).output();
        let output = output.expect("bash");
        let code = output.status.code().expect("ended by itself");
        (code, String::from_utf8_lossy(&output.stderr).into_owned())
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
        "contact  FOOT (2 nodes) -> TOP (1 edge)   mu 0.2   smallest gap 1.0e-02",
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
fn threads_do_not_change_the_results() {
    let bench = Bench::new(DROP);
    for threads in ["1", "2"] {
        let folder = format!("t{threads}");
        let arguments = ["run", "drop.inp", "-q", "-o", &folder, "--threads", threads];
        assert_eq!(bench.stickslip(&arguments).0, 0);
    }
    assert_eq!(bench.read("t1/drop.sta"), bench.read("t2/drop.sta"));
    let mut diff = std::process::Command::new("h5diff");
    diff.args(["--exclude-path", "/run", "t1/drop.vtkhdf", "t2/drop.vtkhdf"]);
    match diff.current_dir(bench.folder.path()).output() {
        Ok(output) => assert!(output.status.success(), "{output:?}"),
        Err(_) => eprintln!("h5diff is not installed: not compared"),
    }
}

/// Exit code and standard error of a program that ends by itself.
fn end(run: Child) -> (i32, String) {
    let output = run.wait_with_output().expect("ended");
    let code = output.status.code().expect("ended by itself");
    (code, String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn of_two_runs_started_together_one_is_refused() {
    let deck = DROP.replace("0.002, 0.1", "0.002, 0.6");
    for round in 0..4 {
        let bench = Bench::new(&deck);
        let arguments = ["run", "drop.inp", "-q", "-o", "out"];
        let runs = [(); 2].map(|()| bench.start(&arguments)).map(end);
        let mut codes = runs.each_ref().map(|(code, _)| *code);
        codes.sort_unstable();
        assert_eq!(codes, [0, 4], "round {round}: {runs:?}");
        let summary = bench.summary("out/drop.vtkhdf");
        assert_eq!((summary.exit_status, summary.increments), (0, 300));
        assert_eq!(bench.read("out/drop.sta").lines().count(), 302);
        let log = bench.read("out/drop.log");
        assert!(log.lines().last().is_some_and(|l| l.starts_with("wrote ")));
    }
}

#[test]
fn a_run_that_goes_on_keeps_its_files_and_a_killed_one_does_not() {
    let bench = Bench::new(DROP);
    let mut run = bench.start_endless();
    let (code, _, err) = bench.stickslip(&["run", "drop.inp", "-q", "--overwrite"]);
    assert_eq!(code, 4, "{err}");
    assert_eq!(
        err,
        "error: drop.log belongs to a run that is still going on\n"
    );
    // Even without its log the job is known by its result.
    fs::remove_file(bench.path("drop.log")).expect("log");
    let (code, _, err) = bench.stickslip(&["run", "drop.inp", "-q", "--overwrite"]);
    assert_eq!(code, 4, "{err}");
    assert!(err.contains("drop.vtkhdf belongs to a run"), "{err}");
    run.kill().expect("killed");
    run.wait().expect("ended");
    assert_eq!(bench.summary("drop.vtkhdf").exit_status, -1);
    let (code, _, err) = bench.stickslip(&["run", "drop.inp", "-q", "--overwrite"]);
    assert_eq!((code, err.as_str()), (0, ""));
    assert_eq!(bench.summary("drop.vtkhdf").exit_status, 0);
}

#[test]
fn signals_end_a_run_with_its_results() {
    for (signal, status) in [("INT", 130), ("TERM", 143), ("HUP", 129)] {
        let bench = Bench::new(DROP);
        let run = bench.start_endless();
        let id = run.id();
        // As `timeout` does: twice in a row.
        bench.shell(&format!("kill -{signal} {id}; kill -{signal} {id}"));
        let (code, err) = end(run);
        assert_eq!(code, status, "{err}");
        let asked = format!("SIG{signal} asked for the end");
        assert!(
            err.contains(&asked) && bench.read("drop.log").contains(&asked),
            "{err}"
        );
        let summary = bench.summary("drop.vtkhdf");
        assert_eq!(summary.exit_status, i64::from(status));
        assert_eq!(summary.frames.last(), Some(&summary.time));
        let told = format!("exit status {status}");
        assert!(summary.lines().iter().any(|line| line.contains(&told)));
    }
}

#[test]
fn an_ignored_signal_stays_ignored() {
    let deck = DROP.replace("0.002, 0.1", "0.002, 1e8");
    let bench = Bench::new(&deck);
    let line = "trap '' INT; \"$0\" run drop.inp -q & run=$!
        while [ ! -e drop.vtkhdf ]; do sleep 0.01; done
        kill -INT $run; sleep 0.3; kill -TERM $run; wait $run";
    let (code, err) = bench.shell(line);
    assert_eq!(code, 143, "{err}");
    let log = bench.read("drop.log");
    assert!(log.contains("SIGTERM") && !log.contains("SIGINT"), "{log}");
}

#[test]
fn a_full_disk_is_told_in_one_line_and_leaves_what_is_readable() {
    let bench = Bench::new(&DROP.replace("0.1\n", "20.\n"));
    let mut with_results = 0;
    for blocks in [1, 60, 400, 1000, 1100, 1200, 1500, 2000] {
        let output = format!("d{blocks}");
        let line = format!("ulimit -f {blocks}; \"$0\" run drop.inp -q -o {output}");
        let (code, err) = bench.shell(&line);
        assert_eq!(code, 4, "{blocks}: {err}");
        let name = format!("{output}/drop.vtkhdf");
        assert_eq!(err.lines().count(), 1, "{err}");
        let told = [name.as_str(), "larger than files may become"];
        assert!(told.iter().all(|text| err.contains(text)), "{err}");
        assert!(!bench.path(&format!("{name}.part")).exists());
        if bench.path(&name).exists() {
            with_results += 1;
            let summary = bench.summary(&name);
            assert_eq!(summary.exit_status, 4);
            assert!(!summary.frames.is_empty() && err.contains("; the results up to time "));
        }
    }
    assert!(with_results >= 2, "{with_results}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_screen_on_a_full_disk_is_4_and_a_closed_pipe_is_none() {
    let bench = Bench::new(DROP);
    let told = "error: cannot write the standard output: no space left on device\n";
    for line in [
        "\"$0\" run drop.inp -o a > /dev/full",
        "\"$0\" check drop.inp > /dev/full",
        "\"$0\" info a/drop.vtkhdf > /dev/full",
        "\"$0\" --version > /dev/full",
        "\"$0\" run --help > /dev/full",
    ] {
        assert_eq!(bench.shell(line), (4, told.to_owned()), "{line}");
    }
    let summary = bench.summary("a/drop.vtkhdf");
    assert_eq!((summary.exit_status, summary.increments), (4, 50));
    let line = "\"$0\" run drop.inp -o b | head -1; exit ${PIPESTATUS[0]}";
    assert_eq!(bench.shell(line), (0, String::new()));
    assert_eq!(bench.summary("b/drop.vtkhdf").exit_status, 0);
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
