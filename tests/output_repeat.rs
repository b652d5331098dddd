//! Two runs write the same file. On its own: a program started here would keep the locks of files
//! that other tests have open.

mod output_support;

use std::process::Command;

use output_support::write_run;
use tempfile::TempDir;

#[test]
fn two_runs_differ_in_the_record_only() {
    let folders = [(); 2].map(|()| TempDir::new().expect("folder"));
    let [a, b] = folders
        .each_ref()
        .map(|folder| write_run(folder.path()).result);
    let Ok(output) = Command::new("h5diff")
        .args(["--exclude-path", "/run"])
        .args([&a, &b])
        .output()
    else {
        eprintln!("h5diff is not installed: not compared");
        return;
    };
    assert!(output.status.success(), "{output:?}");
}
