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
