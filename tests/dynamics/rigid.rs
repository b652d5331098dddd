//! A rigid surface, read from a deck, as a master.

use std::path::Path;
use stickslip::diagnostics::{Diagnostics, Sources};
use stickslip::model::SurfaceKind;
use stickslip::reader;

use crate::blocks::run_to_end;

/// Between impacts a square of mass 1 falls freely onto a floor that slides away below it with the
/// velocity 0.5; the ledger closes with the work of the floor, and nothing gets through it.
#[test]
fn a_square_on_a_sliding_floor() {
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let path = Path::new("tests/decks/rigid_floor.inp");
    let model = reader::read_model(path, &mut sources, &mut d).expect("a valid deck");
    let master = &model.surfaces[model.contacts[0].master];
    assert!(matches!(master.kind, SurfaceKind::Rigid(_)));
    let floor = master.nodes(&model.mesh);
    let (kept, _) = run_to_end(&model);
    let reports = kept.reports;
    for report in &reports {
        let (t, u) = (report.time, &report.state.u);
        for &node in &floor {
            assert!((u[2 * node] - 0.5 * t).abs() < 1e-14 && u[2 * node + 1] == 0.0);
        }
        for node in 0..4 {
            let height = model.mesh.coordinates[node][1] + u[2 * node + 1];
            assert!(height > -1e-9, "node {node} at {t}");
        }
        let largest = report.energy.kinetic + report.energy.strain + 1.0;
        assert!(report.energy.balance.abs() < 1e-10 * largest);
    }
    let landed = reports.iter().any(|report| report.contacts[0].closed > 0);
    assert!(landed);
}
