//! Claim of the files of a job, results after signals and on full disks, and screens that cannot be
//! written.

use std::fs;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use super::{Bench, DROP};

impl Bench {
    /// Starts the program and does not wait for it.
    fn start(&self, arguments: &[&str]) -> Child {
        let mut command = Command::new(env!("CARGO_BIN_EXE_stickslip"));
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
}

/// Longest time that a run may take to end by itself.
const PATIENCE: Duration = Duration::from_secs(120);

/// Exit code and standard error of a program that ends by itself.
fn end(mut run: Child) -> (i32, String) {
    let start = Instant::now();
    while run.try_wait().expect("a state").is_none() {
        if start.elapsed() > PATIENCE {
            run.kill().expect("killed");
            panic!(
                "the run has not ended in {PATIENCE:?}: if it was sent a signal, the shell that started the \
                 tests ignores it, and so does every program below that shell"
            );
        }
        thread::sleep(Duration::from_millis(5));
    }
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
    // Even without its log the job is recognised by its result.
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

/// A blocked run: it waits for a reader of its screen, which a long title fills.
#[test]
fn a_second_signal_ends_a_run_at_once() {
    let title = "A long title. ".repeat(4000);
    let deck = DROP.replace(
        "*NODE, NSET=BASE",
        &format!("{title}\n{title}\n*NODE, NSET=BASE"),
    );
    let bench = Bench::new(&deck);
    let mut command = Command::new(env!("CARGO_BIN_EXE_stickslip"));
    let command = command
        .args(["run", "drop.inp"])
        .current_dir(bench.folder.path());
    let piped = command.stdout(Stdio::piped()).stderr(Stdio::null());
    let mut run = piped.spawn().expect("started");
    let start = Instant::now();
    while !bench.path("drop.vtkhdf.part").exists() {
        assert!(start.elapsed() < Duration::from_secs(20), "not begun");
        std::thread::sleep(Duration::from_millis(5));
    }
    let id = run.id();
    bench.shell(&format!("kill -TERM {id}; sleep 0.4"));
    assert_eq!(run.try_wait().expect("asked"), None);
    bench.shell(&format!("kill -TERM {id}"));
    assert_eq!(run.wait().expect("ended").code(), Some(143));
    assert!(!bench.path("drop.vtkhdf").exists());
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
    let bench = Bench::new(&DROP.replace("0.1\n", "40.\n"));
    let mut with_results = 0;
    for blocks in [1, 60, 400, 1000, 2000, 4000, 6000, 7000, 8000] {
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
