//! The estimate of a run's memory against what the run used.

use std::fs;

use assert_cmd::Command;
use hdf5::File;
use tempfile::TempDir;

/// Largest ratio of estimate and use, or of use and estimate.
const WITHIN: f64 = 1.5;

/// Nodes and elements of a unit square of n x n quadrilaterals whose lower side is at `y`.
fn square(name: &str, n: usize, y: f64, first: usize) -> String {
    let mut text = format!("*NODE, NSET={name}\n");
    let node = |i: usize, j: usize| first + i + j * (n + 1);
    for j in 0..=n {
        for i in 0..=n {
            let (x, y) = (i as f64 / n as f64, y + j as f64 / n as f64);
            text.push_str(&format!("{}, {x}, {y}\n", node(i, j)));
        }
    }
    text.push_str(&format!("*ELEMENT, TYPE=CPE4, ELSET={name}\n"));
    for j in 0..n {
        for i in 0..n {
            let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
            let [a, b, c, d] = corners.map(|[i, j]| node(i, j));
            text.push_str(&format!("{}, {a}, {b}, {c}, {d}\n", first + i + j * n));
        }
    }
    text
}

/// One square, or two on each other, of n x n elements that fall onto a held side.
fn deck(n: usize, squares: usize) -> String {
    let nodes = (n + 1) * (n + 1);
    let mut text = square("LOWER", n, 0.0, 1);
    text.push_str(&format!("*NSET, NSET=BASE, GENERATE\n1, {}, 1\n", n + 1));
    text.push_str("*MATERIAL, NAME=M\n*ELASTIC\n1e4, 0.3\n*DENSITY\n1.\n");
    text.push_str("*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n1.\n");
    if squares == 2 {
        text.push_str(&square("UPPER", n, 1.0, nodes + 1));
        text.push_str("*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n1.\n");
        text.push_str("*SURFACE, NAME=UPPER\nUPPER\n*SURFACE, NAME=LOWER\nLOWER\n");
        text.push_str("*SURFACE INTERACTION, NAME=DRY\n*FRICTION\n0.3\n");
        text.push_str("*CONTACT PAIR, INTERACTION=DRY\nUPPER, LOWER\n");
    }
    text.push_str("*BOUNDARY\nBASE, 1, 2\n*STEP, NLGEOM, INC=2\n*DYNAMIC, DIRECT\n0.01, 0.02\n");
    text.push_str("*DLOAD\n, GRAV, 10., 0., -1.\n*END STEP\n");
    text
}

/// Estimated and used bytes of a run.
fn run(n: usize, squares: usize) -> [i64; 2] {
    let folder = TempDir::new().expect("folder");
    fs::write(folder.path().join("block.inp"), deck(n, squares)).expect("deck");
    let mut command = Command::cargo_bin("stickslip").expect("binary");
    let command = command.args(["run", "block.inp", "-q", "--threads", "1"]);
    command.current_dir(folder.path()).assert().success();
    let file = File::open(folder.path().join("block.vtkhdf")).expect("result");
    let record = file.group("run").expect("record");
    ["memory_need", "peak_memory"].map(|name| {
        let attribute = record.attr(name).expect(name);
        attribute.read_scalar().expect(name)
    })
}

/// Exit code and standard error of a run with so many kilobytes of addresses.
#[cfg(target_os = "linux")]
fn limited(n: usize, kilobytes: usize) -> (Option<i32>, String) {
    let folder = TempDir::new().expect("folder");
    fs::write(folder.path().join("block.inp"), deck(n, 1)).expect("deck");
    let mut command = std::process::Command::new("bash");
    command.args(["-c", &format!("ulimit -v {kilobytes}; exec \"$@\""), "bash"]);
    command
        .arg(env!("CARGO_BIN_EXE_stickslip"))
        .args(["run", "block.inp", "-q", "--threads", "1"]);
    let done = command
        .current_dir(folder.path())
        .output()
        .expect("started");
    (
        done.status.code(),
        String::from_utf8_lossy(&done.stderr).into_owned(),
    )
}

#[cfg(target_os = "linux")]
#[test]
fn a_limit_of_the_process_ends_the_run_with_a_message() {
    let (code, err) = limited(200, 200_000);
    assert_eq!(code, Some(4), "{err}");
    assert!(err.starts_with("error: the run needs about "), "{err}");
    assert!(err.contains(" are free: "), "{err}");
    let (code, err) = limited(300, 60_000);
    assert_eq!(code, Some(4), "{err}");
    assert!(err.starts_with("error: out of memory: "), "{err}");
    assert_eq!(err.lines().count(), 1, "{err}");
    // between what the estimate lets pass and what is enough
    let (code, err) = limited(200, 320_000);
    assert_eq!(code, Some(4), "{err}");
    assert!(err.contains("the run needs about "), "{err}");
}

#[cfg(target_os = "linux")]
#[test]
fn the_estimate_is_near_the_use() {
    for (n, squares) in [(4, 2), (60, 2), (150, 1)] {
        let [need, used] = run(n, squares);
        let ratio = need as f64 / used as f64;
        assert!(
            (1.0 / WITHIN..WITHIN).contains(&ratio),
            "{squares} x {n}: estimated {need}, used {used}"
        );
    }
}
