//! A killed run leaves a readable file.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::writers::{model, report, writer};
use stickslip::dynamics::Observer;
use stickslip::model::Frames;
use stickslip::output::{JobFiles, ResultSummary};
use tempfile::TempDir;

/// Tells the second process of this test where to write.
const FOLDER: &str = "STICKSLIP_TEST_FOLDER";

/// An increment that takes long.
const LONG_INCREMENT: usize = 30;

fn files(folder: &Path) -> JobFiles {
    JobFiles::new("killed.inp".as_ref(), folder)
}

/// Writes increments with frames until it is killed; does nothing when called as a test.
#[test]
fn endless_writer() {
    let Some(folder) = std::env::var_os(FOLDER) else {
        return;
    };
    let mut model = model();
    model.steps[0].frames = Frames::Increments(3);
    let mut writer = writer(&model, &files(&PathBuf::from(folder)));
    for k in 0.. {
        if k == LONG_INCREMENT {
            // What waits in memory is written after a second at most.
            std::thread::sleep(Duration::from_secs(1));
        }
        let mut report = report(k);
        report.ends_step = false;
        writer.increment(&report).expect("written");
        if k == LONG_INCREMENT {
            println!("ready");
            std::io::stdout().flush().expect("flushed");
        }
    }
}

/// Kills a writer some time after its first frames.
fn killed_after(delay: Duration, folder: &Path) {
    let mut child = Command::new(std::env::current_exe().expect("this program"))
        .args(["--exact", "killed::endless_writer", "--nocapture"])
        .env(FOLDER, folder)
        .stdout(Stdio::piped())
        .spawn()
        .expect("started");
    let mut output = std::io::BufReader::new(child.stdout.take().expect("piped"));
    let mut line = String::new();
    let start = Instant::now();
    while !line.contains("ready") && start.elapsed() < Duration::from_secs(30) {
        std::io::BufRead::read_line(&mut output, &mut line).expect("read");
    }
    std::thread::sleep(delay);
    child.kill().expect("killed");
    child.wait().expect("ended");
}

#[test]
fn a_killed_run_is_readable_up_to_its_last_frame() {
    for round in 0..5 {
        let folder = TempDir::new().expect("folder");
        killed_after(Duration::from_millis(7 * round), folder.path());
        let summary = ResultSummary::read(&files(folder.path()).result).expect("readable");
        assert_eq!(summary.exit_status, -1);
        assert!(summary.increments >= LONG_INCREMENT, "{summary:?}");
        assert!(summary.frames.len() >= 11);
        assert!(summary.lines().iter().any(|line| line.contains("killed")));
    }
}
