//! The subcommand `run`: claim of the files of a job, and the files left after a failure.

use std::{cell, io};

use super::run::{Bench, code, numerics, report, summary};
use crate::cli::connect::Numerics;
use crate::cli::exit::Exit;
use crate::dynamics::{Observer, Outcome, RunError, RunSummary};
use crate::output::Interrupt;
use crate::prepare::PreparedModel;

fn to_an_error_at_the_start(
    _: &PreparedModel,
    _: &mut dyn Observer,
) -> Result<RunSummary, RunError> {
    Err(RunError::Observer(io::ErrorKind::StorageFull.into()))
}

thread_local! {
    /// The signal that arrives while [`until_told`] solves.
    static INTERRUPT: (Interrupt, cell::Cell<i32>) = (Interrupt::default(), cell::Cell::new(0));
}

fn until_told(_: &PreparedModel, observer: &mut dyn Observer) -> Result<RunSummary, RunError> {
    for k in 0..=10 {
        if k == 3 {
            INTERRUPT.with(|(interrupt, signal)| interrupt.request(signal.get()));
        }
        if observer.wants_stop() {
            return Ok(summary(Outcome::Interrupted, k - 1));
        }
        observer.increment(&report(k)).map_err(RunError::Observer)?;
    }
    Ok(summary(Outcome::Finished, 10))
}

#[test]
fn earlier_results_stay_until_the_first_frame() {
    let bench = Bench::new();
    assert_eq!(code(&bench.run(&["-q"], &numerics())), Exit::Finished);
    let read = |name: &str| std::fs::read(bench.path(name)).expect(name);
    let names = ["out/job.vtkhdf", "out/job.sta", "out/job.log"];
    let before = names.map(read);
    let solve = to_an_error_at_the_start;
    let fails = Numerics {
        solve,
        ..numerics()
    };
    let exit = bench.run(&["-q", "--overwrite"], &fails);
    assert_eq!(code(&exit), Exit::FileSystem);
    assert!(names.map(read) == before);
    assert!(!bench.path("out/job.vtkhdf.part").exists());
    // Without earlier results nothing is left at all.
    let bench = Bench::new();
    assert_eq!(code(&bench.run(&["-q"], &fails)), Exit::FileSystem);
    let left = std::fs::read_dir(bench.path("out")).expect("folder");
    assert_eq!(left.count(), 0);
}

#[test]
fn what_a_killed_start_leaves_is_in_nobodys_way() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("out")).expect("folder");
    for name in ["out/job.log", "out/job.vtkhdf.part"] {
        std::fs::write(bench.path(name), "").expect(name);
    }
    assert_eq!(code(&bench.run(&["-q"], &numerics())), Exit::Finished);
    assert_eq!(bench.summary().frames, [0.0, 1.0]);
    assert!(!bench.path("out/job.vtkhdf.part").exists());
}

#[cfg(unix)]
#[test]
fn links_are_replaced_and_what_they_point_to_stays() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("out")).expect("folder");
    std::fs::write(bench.path("precious"), "precious").expect("file");
    for name in [
        "out/job.log",
        "out/job.sta",
        "out/job.vtkhdf",
        "out/job.vtkhdf.part",
    ] {
        std::os::unix::fs::symlink(bench.path("precious"), bench.path(name)).expect(name);
    }
    assert_eq!(code(&bench.run(&["-q"], &numerics())), Exit::FileSystem);
    assert_eq!(
        code(&bench.run(&["-q", "--overwrite"], &numerics())),
        Exit::Finished
    );
    let kept = std::fs::read_to_string(bench.path("precious")).expect("file");
    assert_eq!(
        (kept.as_str(), bench.summary().increments),
        ("precious", 10)
    );
}

#[test]
fn an_interrupt_ends_the_run_with_a_frame_and_its_exit_code() {
    for (signal, wanted) in [
        (2, Exit::Interrupted),
        (15, Exit::Terminated),
        (1, Exit::HungUp),
    ] {
        let mut bench = Bench::new();
        bench.interrupt = INTERRUPT.with(|(interrupt, number)| {
            number.set(signal);
            interrupt.request(0);
            interrupt.clone()
        });
        let told = Numerics {
            solve: until_told,
            ..numerics()
        };
        assert_eq!(code(&bench.run(&["-q"], &told)), wanted);
        let summary = bench.summary();
        assert_eq!(summary.exit_status, wanted as i64);
        assert_eq!(summary.frames, [0.0, report(2).time]);
        let text = "asked for the end   increment 2 is the last";
        assert!(bench.log().contains(text), "{}", bench.log());
        // One that comes while the deck is read leaves nothing behind.
        let bench = Bench::new();
        bench.interrupt.request(signal);
        assert_eq!(code(&bench.run(&["-q"], &numerics())), wanted);
        assert!(!bench.touched());
    }
}

#[test]
fn results_are_replaced_only_when_wanted() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("out")).expect("folder");
    std::fs::write(bench.path("out/job.sta"), "old").expect("old result");
    let exit = bench.run(&["-q"], &numerics());
    assert_eq!(code(&exit), Exit::FileSystem);
    assert!(exit.is_err_and(|error| error.to_string().contains("--overwrite")));
    let kept = std::fs::read_to_string(bench.path("out/job.sta")).expect("old result");
    assert_eq!(kept, "old");
    let exit = bench.run(&["-q", "--overwrite"], &numerics());
    assert_eq!(code(&exit), Exit::Finished);
    let exit = bench.run(&["-q", "--overwrite"], &numerics());
    assert_eq!(code(&exit), Exit::Finished);
}
