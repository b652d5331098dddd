//! The hybrid and Lemke's method at every pass give the same motion.

use stickslip::model::{LcpChoice, Settings};

use crate::blocks::run_to_end;
use crate::invariants::oblique_impact;

#[test]
fn hybrid_and_lemke_give_the_same_histories() {
    let run = |lcp| {
        let mut model = oblique_impact(0.3, Settings::default().scheme);
        model.steps[0].settings.lcp = lcp;
        run_to_end(&model)
    };
    let (hybrid, counts) = run(LcpChoice::Hybrid);
    let (lemke, lemke_counts) = run(LcpChoice::Lemke);
    assert!(lemke_counts.solver.lemke_calls > counts.solver.lemke_calls);
    for (a, b) in hybrid.reports.iter().zip(&lemke.reports) {
        assert_eq!(
            (a.contacts[0].closed, a.contacts[0].sticking),
            (b.contacts[0].closed, b.contacts[0].sticking)
        );
        let size = a.state.u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        for (u, w) in a.state.u.iter().zip(&b.state.u) {
            assert!((u - w).abs() <= 1e-9 * size, "t {}: {u} and {w}", a.time);
        }
    }
}
