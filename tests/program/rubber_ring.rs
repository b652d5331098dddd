//! The rubber ring of `input/rubber_ring` through the real binary: energy at large strains, with a
//! rigid floor and friction, and in free flight.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use hdf5::File;
use tempfile::TempDir;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/input/rubber_ring");

fn read(name: &str) -> String {
    fs::read_to_string(Path::new(FOLDER).join(name)).expect(name)
}

/// `old` replaced by `new`; it must be there.
fn change(text: &str, old: &str, new: &str) -> String {
    assert!(text.contains(old), "{old}");
    text.replace(old, new)
}

/// The deck with friction, of fewer increments, with this include file.
fn run(include: &str, increments: u32) -> File {
    let folder = TempDir::new().expect("folder");
    let deck = read("rubber_ring_mu05.inp");
    let deck = change(&deck, "INC=400", &format!("INC={increments}"));
    let time = f64::from(increments) * 0.002;
    let deck = change(&deck, "0.002, 0.8", &format!("0.002, {time}"));
    let deck = change(&deck, "NUMBER INTERVAL=100", "NUMBER INTERVAL=1");
    fs::write(folder.path().join("ring.inp"), deck).expect("deck");
    fs::write(folder.path().join("rubber_ring.inc"), include).expect("include");
    let mut command = Command::cargo_bin("stickslip").expect("binary");
    let command = command.args(["run", "ring.inp", "-q"]);
    let output = command.current_dir(folder.path()).output().expect("run");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{text}");
    let log = fs::read_to_string(folder.path().join("ring.log")).expect("log");
    assert!(!log.contains("Kirchhoff"), "{log}");
    File::open(folder.path().join("ring.vtkhdf")).expect("result")
}

fn history(file: &File, name: &str) -> Vec<f64> {
    let path = format!("history/{name}");
    file.dataset(&path).expect(name).read_raw().expect(name)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, v| most.max(v.abs()))
}

/// Kinetic and strain energy of every increment.
fn energy(file: &File) -> Vec<f64> {
    let [kinetic, strain] = ["kinetic", "strain"].map(|n| history(file, &format!("energy/{n}")));
    kinetic.iter().zip(&strain).map(|(t, w)| t + w).collect()
}

#[test]
fn a_ring_on_the_floor_keeps_the_energy_balance_at_large_strains() {
    let file = run(&read("rubber_ring.inc"), 120);
    let energy = energy(&file);
    let start = energy[0];
    assert_eq!(energy.len(), 121, "no cutbacks");
    assert!(largest(&history(&file, "energy/balance")) < 1e-11 * start);
    let rises = energy.windows(2).map(|pair| pair[1] - pair[0]);
    assert!(rises.fold(0.0, f64::max) < 1e-11 * start);
    assert!(largest(&history(&file, "strain/largest_principal")) > 0.8);
    assert_eq!(
        largest(&history(&file, "strain/largest_principal_elastic")),
        0.0
    );
    assert!(largest(&history(&file, "energy/strain")) > 0.4 * start);
    let [friction, loss, scheme] = [
        "friction_dissipation",
        "impact_loss",
        "numerical_dissipation",
    ]
    .map(|name| history(&file, &format!("energy/{name}"))[120] / start);
    assert!(friction > 0.01 && loss > 0.0, "{friction} {loss}");
    assert!(scheme.abs() < 1e-11, "{scheme}");
}

/// Rows of initial velocities: the ring is stretched along x, shortened along y, and turns.
fn stretching(include: &str) -> String {
    let nodes = include.split("*ELEMENT").next().expect("nodes");
    let rows = nodes.lines().filter(|line| !line.starts_with('*'));
    let row = |line: &str| {
        let fields: Vec<f64> = line
            .split(',')
            .map(|f| f.trim().parse().expect(line))
            .collect();
        let [label, x, y] = fields[..] else {
            panic!("{line}");
        };
        let (vx, vy) = (6.0 * x - 2.0 * (y - 1.1), 2.0 * x - 4.0 * (y - 1.1));
        format!("{label}, 1, {vx}\n{label}, 2, {vy}\n")
    };
    rows.map(row).collect()
}

#[test]
fn a_ring_in_free_flight_keeps_energy_and_momenta() {
    let include = read("rubber_ring.inc");
    let velocities = stretching(&include);
    let include = change(
        &include,
        "START, -4.0, 0.0\nLINE, 8.0, 0.0",
        "START, -4., -9.\nLINE, 8., -9.",
    );
    let include = change(&include, "RING, 1, 2.0\nRING, 2, -5.0\n", &velocities);
    let file = run(&include, 100);
    let energy = energy(&file);
    let drift = energy
        .iter()
        .map(|e| (e - energy[0]).abs())
        .fold(0.0, f64::max);
    assert!(drift < 1e-10 * energy[0], "{drift}");
    let angular = history(&file, "momentum/angular");
    let change = angular.iter().map(|l| (l - angular[0]).abs());
    assert!(change.fold(0.0, f64::max) < 1e-10 * angular[0].abs());
    assert!(largest(&history(&file, "energy/strain")) > 0.3 * energy[0]);
    assert!(largest(&history(&file, "strain/largest_principal")) > 0.4);
}
