//! A law with internal variables in whole runs: the variables are committed with an accepted increment and dropped with
//! a failed attempt. See docs/theory/elements.md.

use std::io;

use super::run;
use crate::dynamics::{Cutback, IncrementReport, Observer, Outcome};
use crate::elements::{Elements, Motion};
use crate::materials::Law;
use crate::materials::yielding::Yielding;
use crate::model::{Element, ElementType, Increments, Model, Step};
use crate::prepare::PreparedModel;

const YIELDING: Yielding = Yielding {
    g: 50.0,
    y: 0.02,
    r: 0.3,
    c: 0.05,
};
/// Number of nodes along a side of the block.
const SIDE: usize = 4;

/// A free square of side 1 that is stretched along x at the given rate and turns.
fn block(rate: f64) -> Model {
    let mut model = Model::default();
    model.add_section(Law::Yielding(YIELDING), 1.0, 1.0);
    let at = |i: usize| i as f64 / (SIDE - 1) as f64 - 0.5;
    for (j, i) in (0..SIDE * SIDE).map(|node| (node / SIDE, node % SIDE)) {
        let node = j * SIDE + i;
        model.mesh.node_labels.push(node as u64 + 1);
        model.mesh.coordinates.push([at(i), at(j)]);
        let velocity = [rate * at(i) - at(j), at(i)];
        model.initial_velocity.extend(velocity);
        if i + 1 < SIDE && j + 1 < SIDE {
            model.mesh.elements.push(Element {
                label: node as u64 + 1,
                element_type: ElementType::CPE4,
                nodes: vec![node, node + 1, node + 1 + SIDE, node + SIDE].into(),
                section: 0,
            });
        }
    }
    model
}

fn step(dt: f64, count: usize) -> Step {
    Step::new(Increments::fixed(dt, dt * count as f64))
}

#[derive(Default)]
struct Keep {
    reports: Vec<IncrementReport>,
    /// Number of accepted increments before each cutback.
    cutbacks: Vec<usize>,
}

impl Observer for Keep {
    fn increment(&mut self, report: &IncrementReport) -> io::Result<()> {
        self.reports.push(report.clone());
        Ok(())
    }

    fn cutback(&mut self, _: &Cutback) -> io::Result<()> {
        self.cutbacks.push(self.reports.len());
        Ok(())
    }
}

/// All reports of a complete run; in each increment their common properties are checked.
fn checked_run(mut model: Model, step: Step) -> Keep {
    model.steps = vec![step];
    let prepared = PreparedModel::new(model);
    let mut keep = Keep::default();
    let summary = run(&prepared, &mut keep).expect("the observer never fails");
    assert_eq!(summary.outcome, Outcome::Finished);
    let elements = Elements::new(&prepared.model);
    let start = keep.reports[0].energy.kinetic;
    for pair in keep.reports.windows(2) {
        let [before, after] = [&pair[0], &pair[1]];
        // each increment starts from the variables of the last accepted one, whatever attempts came
        // in between
        let updated = elements.update(Motion {
            start: Some(&before.state.u),
            ..Motion::at(&after.state.u, &before.state.internal)
        });
        assert_eq!(after.state.internal, updated.variables);
        let [d0, d1] = [before, after].map(|report| report.energy.material_dissipation);
        assert!(updated.dissipated >= 0.0 && (d1 - d0 - updated.dissipated).abs() < 1e-13 * start);
        assert!(after.energy.balance.abs() < 1e-10 * start);
    }
    keep
}

#[test]
fn a_yielding_block_dissipates_what_its_energy_loses() {
    let keep = checked_run(block(4.0), step(0.01, 100));
    let [first, last] = [&keep.reports[0], &keep.reports[keep.reports.len() - 1]];
    let energy = |report: &IncrementReport| report.energy.kinetic + report.energy.strain;
    let lost = energy(first) - energy(last);
    assert!(first.state.internal.iter().all(|&z| z == 0.0));
    assert!(last.state.internal.iter().any(|z| z.abs() > 0.05));
    assert!(last.energy.material_dissipation > 0.3 * energy(first));
    assert!((last.energy.material_dissipation - lost).abs() < 1e-9 * energy(first));
    assert!((last.momentum.angular - first.momentum.angular).abs() < 1e-10);
}

#[test]
fn a_failed_attempt_leaves_no_internal_variables_behind() {
    // increments so long that some of them do not converge within the passes, and are halved
    let mut step = step(0.1, 10);
    step.settings.max_passes = 6;
    let keep = checked_run(block(4.0), step);
    let is_on_committed = |&&count: &&usize| {
        let state = &keep.reports[count - 1].state;
        state.internal.iter().any(|&z| z != 0.0)
    };
    let failed = keep.cutbacks.iter().filter(is_on_committed).count();
    assert!(
        failed > 2,
        "{failed} attempts fail on top of committed variables"
    );
}
