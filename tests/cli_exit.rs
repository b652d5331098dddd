//! The program's exit codes and what it prints, with the real binary.

mod output_support;

use std::sync::{Mutex, MutexGuard, PoisonError};

use assert_cmd::Command;
use output_support::write_run;
use tempfile::TempDir;

/// One test at a time: a child process started while another test has a result file open would
/// inherit it, and with it HDF5's lock.
fn alone() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

fn stickslip(arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("stickslip").expect("binary");
    let output = command.args(arguments).output().expect("started");
    let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
    let code = output.status.code().expect("ended by itself");
    (code, text(&output.stdout), text(&output.stderr))
}

#[test]
fn help_and_version_are_no_errors() {
    let _alone = alone();
    let (code, out, _) = stickslip(&["--help"]);
    assert_eq!(code, 0);
    assert!(out.contains("check") && out.contains("Exit codes"), "{out}");
    let (code, out, _) = stickslip(&["-V"]);
    assert_eq!(code, 0);
    assert!(out.starts_with(concat!("stickslip ", env!("CARGO_PKG_VERSION"), " (")));
    let (code, out, _) = stickslip(&["--version"]);
    assert_eq!(code, 0);
    assert!(
        out.contains("sprs-ldl") && out.contains("LGPL-2.1"),
        "{out}"
    );
    assert!(out.contains("HDF5") && !out.contains('?'), "{out}");
}

#[test]
fn a_wrong_command_line_is_3() {
    let _alone = alone();
    for arguments in [
        &[] as &[&str],
        &["run"],
        &["walk", "x.inp"],
        &["run", "x.inp", "--frames", "0"],
        &["run", "x.inp", "--frames", "3", "--every", "0.1"],
        &["run", "x.inp", "--every", "-1"],
        &["run", "x.inp", "--every", "nan"],
        &["run", "x.inp", "--solver", "cholmod"],
        &["run", "x.inp", "--threads", "0"],
        &["run", "x.inp", "-q", "-v"],
    ] {
        let (code, out, err) = stickslip(arguments);
        assert_eq!((code, out.as_str()), (3, ""), "{arguments:?}");
        assert!(!err.is_empty());
    }
}

#[test]
fn a_missing_file_is_4() {
    let _alone = alone();
    for command in ["run", "check", "info"] {
        let (code, out, err) = stickslip(&[command, "no/such/file"]);
        assert_eq!((code, out.as_str()), (4, ""), "{command}: {err}");
        assert!(err.starts_with("error: cannot read"), "{err}");
        assert!(err.contains("no/such/file"), "{err}");
    }
}

#[test]
fn info_describes_a_result_file() {
    let _alone = alone();
    let folder = TempDir::new().expect("folder");
    let files = write_run(folder.path());
    let (code, out, _) = stickslip(&["info", &files.result.to_string_lossy()]);
    assert_eq!(code, 0);
    for text in [
        "7 nodes   3 elements",
        "1 step   10 increments   time 1   6 frames from 0 to 1",
        "exit status 0",
        "BOTTOM_TOP_2, largest normal force 20",
        "balance 1.0e-12 of the largest energy",
    ] {
        assert!(out.contains(text), "{text}\n{out}");
    }
    let (code, _, err) = stickslip(&["info", &files.log.to_string_lossy()]);
    assert_eq!(code, 4);
    assert!(err.contains("is not a result file"), "{err}");
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_is_no_panic() {
    let _alone = alone();
    let folder = TempDir::new().expect("folder");
    let files = write_run(folder.path());
    let script = format!(
        "'{}' info '{}' | true; exit ${{PIPESTATUS[0]}}",
        env!("CARGO_BIN_EXE_stickslip"),
        files.result.display()
    );
    let output = Command::new("bash")
        .args(["-c", &script])
        .output()
        .expect("bash");
    assert!(output.stderr.is_empty(), "{output:?}");
    assert_eq!(output.status.code(), Some(0));
}
