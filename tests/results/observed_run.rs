//! Results of a real run: two blocks that collide.
//!
//! ```text
//!        +-----+
//!        |     | v
//!        +-----+        gap 0.01, friction 0.2, both bodies free
//!    +-------------+
//!    |             |
//!    +-------------+
//! ```

use std::path::Path;

use crate::blocks::{add_block, add_contact, model, run, step, throw};
use hdf5::File;
use stickslip::model::{Frames, Model, Settings};
use stickslip::output::{
    Claim, Earlier, JobFiles, ResultSummary, ResultWriter, RunRecord, Verbosity,
};
use tempfile::TempDir;

fn two_blocks() -> Model {
    let mut model = model(1000.0, 0.3, 1.0);
    let lower = add_block(&mut model, [0.0, 0.0], [2.0, 1.0], (4, 2), 0.0);
    let upper = add_block(&mut model, [0.5, 1.01], [1.0, 1.0], (3, 3), 0.0);
    throw(&mut model, &upper, [0.2, -0.5], 0.0, [1.0, 1.5]);
    add_contact(&mut model, upper.faces(0), lower.faces(2), 0.2);
    let mut step = step(2e-3, 60, Settings::default(), vec![]);
    step.frames = Frames::Count(12);
    model.steps = vec![step];
    model
}

fn solve(model: &Model, folder: &Path) -> JobFiles {
    let files = JobFiles::new("blocks.inp".as_ref(), folder);
    let record = RunRecord::default();
    let claim = Claim::take(&files, Earlier::Replaced).expect("claim");
    let writer = ResultWriter::create((model, &[]), claim, &record, Verbosity::Quiet);
    let mut writer = writer.expect("writer");
    let summary = run(model, &mut writer).expect("run");
    writer.finish(&summary).expect("finish");
    files
}

fn values(file: &File, path: &str) -> Vec<f64> {
    file.dataset(path).expect(path).read_raw().expect(path)
}

#[test]
fn the_file_shows_the_collision() {
    let folder = TempDir::new().expect("folder");
    let model = two_blocks();
    let files = solve(&model, folder.path());
    let summary = ResultSummary::read(&files.result).expect("summary");
    assert_eq!((summary.increments, summary.frames.len()), (60, 13));
    assert_eq!(summary.exit_status, 0);
    assert!(summary.landings >= 4, "{summary:?}");
    let check = |name| summary.check(name).expect("a check");
    let law = ["overlap", "gap", "slip"].map(check);
    assert!(
        law.iter().all(|&most| most < 1e-9) && law[1] > 0.0,
        "{law:?}"
    );
    assert!(check("balance") < 1e-8 && check("residual") > 0.0 && check("residual") < 1e-10);
    assert!(
        summary
            .lines()
            .iter()
            .any(|line| line.starts_with("checks   all hold   residual"))
    );
    let file = File::open(&files.result).expect("file");
    let stress = values(&file, "VTKHDF/CellData/S");
    assert_eq!(stress.len(), 13 * model.mesh.elements.len() * 6);
    assert!(stress.iter().all(|s| s.is_finite()));
    let step: Vec<i64> = (file.dataset("history/step").expect("step"))
        .read_raw()
        .expect("step");
    assert!(step.iter().all(|&step| step == 1));
    let closed: Vec<i64> = (file
        .dataset("history/contact/S0_S1/closed")
        .expect("closed"))
    .read_raw()
    .expect("closed");
    let normal = values(&file, "history/contact/S0_S1/normal");
    assert!(
        closed
            .iter()
            .zip(&normal)
            .all(|(&n, &p)| (n > 0) == (p > 0.0))
    );
    let linear = values(&file, "history/momentum/linear");
    let scale = linear[1].abs();
    for row in linear.chunks(2) {
        assert!((row[1] - linear[1]).abs() < 1e-10 * scale, "{row:?}");
    }
}

#[test]
fn two_runs_write_the_same_bits() {
    let folders = [
        TempDir::new().expect("folder"),
        TempDir::new().expect("folder"),
    ];
    let model = two_blocks();
    let [a, b] = folders
        .each_ref()
        .map(|folder| File::open(solve(&model, folder.path()).result).expect("file"));
    for path in [
        "VTKHDF/PointData/A",
        "VTKHDF/CellData/S",
        "history/energy/balance",
        "history/contact/S0_S1/force",
    ] {
        let bits = |file| values(file, path).into_iter().map(f64::to_bits);
        assert!(bits(&a).eq(bits(&b)), "{path}");
    }
}
