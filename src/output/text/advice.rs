//! What happened in a failed attempt at an increment, and what to change: one sentence each.

use super::format::{counted, general, scientific};
use super::strain::is_for_small_strains;
use crate::dynamics::{Alternation, Cause, Course, Failure};
use crate::lcp::LcpError;
use crate::model::{Model, Step};

/// Halvings of an increment after which none is left.
const NO_MORE_HALVINGS: u32 = 10;
/// Correction, in tolerances, up to which one that becomes no smaller may be round-off.
const NEAR_ROUND_OFF: f64 = 1e4;

/// How the passes went, where they did not converge.
pub(super) fn course_text(course: &Course, model: &Model) -> String {
    match course {
        Course::Growing { from } => format!("the corrections grew from pass {from} on"),
        Course::Alternating(alternations) => alternation_text(alternations, model),
        Course::Slow { rate, left } => format!(
            "about {} needed: each correction is {} of the last",
            match left {
                1 => "1 more pass was".to_owned(),
                _ => format!("{left} more passes were"),
            },
            general(*rate, 2),
        ),
        Course::Stagnant { correction } => format!(
            "the corrections became no smaller than {}",
            scientific(*correction, 1)
        ),
    }
}

/// The first slave node that went to and fro, and the number of others.
fn alternation_text(alternations: &[Alternation], model: &Model) -> String {
    let label = |node: usize| model.node_name(node);
    let segment = |[a, b]: [usize; 2]| format!("{}-{}", label(a), label(b));
    let first = alternations.first().map(|alternation| match *alternation {
        Alternation::Closing([slave, a, b]) => format!(
            "node {} opened and closed on segment {}",
            label(slave),
            segment([a, b])
        ),
        Alternation::Changing {
            slave,
            segments: [p, q],
        } => format!(
            "node {} went to and fro between segments {} and {}",
            label(slave),
            segment(p),
            segment(q)
        ),
        Alternation::Sliding([slave, a, b]) => format!(
            "node {} stuck and slid on segment {}",
            label(slave),
            segment([a, b])
        ),
    });
    let others = match alternations.len() {
        0 | 1 => String::new(),
        count => format!(", as did {}", counted(count - 1, "other node")),
    };
    first.unwrap_or_default() + " from pass to pass" + &others
}

/// What to change; none where the cause has its own lines or says it all.
pub(super) fn advice(failure: &Failure, model: &Model) -> Option<String> {
    let step = model.steps.get(failure.step.wrapping_sub(1))?;
    let text = match (&failure.cause, failure.course.as_deref()) {
        (_, Some(Course::Slow { left, .. })) => {
            let passes = step.settings.max_passes.saturating_add(*left);
            format!("raise MAX PASSES of *STICKSLIP to {passes} or more")
        }
        (_, Some(Course::Stagnant { correction }))
            if *correction <= NEAR_ROUND_OFF * step.settings.tolerance =>
        {
            format!(
                "raise TOLERANCE of *STICKSLIP above {} if that is round-off",
                scientific(*correction, 0)
            )
        }
        (_, Some(Course::Alternating(all))) => alternation_advice(all)?.to_owned(),
        (cause, _) => cause_advice(cause, model)?.to_owned(),
    };
    Some(match has_halvings_left(failure, step) {
        true => text + "; or let it be halved further, by a smaller least increment of *DYNAMIC",
        false => text,
    })
}

/// Whether only the deck's least increment kept a stopped run from halving its increment again.
fn has_halvings_left(failure: &Failure, step: &Step) -> bool {
    !failure.cause.stays()
        && failure.halvings < NO_MORE_HALVINGS
        && failure.dt / 2.0 < step.increments.dt_min
}

fn alternation_advice(alternations: &[Alternation]) -> Option<&'static str> {
    alternations.first().map(|alternation| match alternation {
        Alternation::Closing(_) => {
            "take smaller increments; where each surface is the slave of the other, leave out one of \
             the two contacts"
        }
        Alternation::Changing { .. } => {
            "take smaller increments, or a finer mesh where the surface bends there"
        }
        Alternation::Sliding(_) => "take smaller increments, or a smaller friction coefficient",
    })
}

fn cause_advice(cause: &Cause, model: &Model) -> Option<&'static str> {
    Some(match cause {
        Cause::NotConverged | Cause::Diverged => {
            "take smaller increments, a smaller load, or bring the load on more slowly (*AMPLITUDE)"
        }
        Cause::Indefinite { node } => match is_for_small_strains_at(*node, model) {
            true => {
                "take smaller increments, in which inertia holds the body, or a smaller load; for \
                 large compression *HYPERELASTIC, NEO HOOKE in plane strain"
            }
            false => "take smaller increments, in which inertia holds the body, or a smaller load",
        },
        Cause::Collapsed { .. } => "take a smaller load, or a coarser mesh there",
        Cause::Crossed {
            prescribed: false, ..
        } => "take smaller increments, or a finer mesh where the node went in",
        Cause::GainedEnergy { .. } => "take smaller increments",
        Cause::Unbalanced { is_round_off, .. } => match is_round_off {
            true => {
                "a body is so stiff that the round-off of its positions makes forces like those on it: \
                 see whether stiffness, loads, lengths and times are in consistent units"
            }
            false => "lower the TOLERANCE of *STICKSLIP, or take smaller increments",
        },
        Cause::Lcp(failed) => match failed.error {
            LcpError::Ray { .. } => {
                "let supports and rigid surfaces not drive the bodies into each other there"
            }
            LcpError::NotFinite => "see whether loads, materials and times are in consistent units",
            _ if failed.problem.mu.iter().any(|mu| *mu > 0.0) => {
                "take smaller increments, or a smaller friction coefficient"
            }
            _ => "take smaller increments",
        },
        Cause::NotFinite { .. } => "see whether loads, materials and times are in consistent units",
        Cause::Inverted { .. } | Cause::Crossed { .. } | Cause::LinearSolver(_) => return None,
    })
}

fn is_for_small_strains_at(node: usize, model: &Model) -> bool {
    let elements = model.mesh.elements.iter().enumerate();
    let mut own = elements.filter(|(_, element)| element.nodes.contains(&node));
    own.any(|(index, _)| is_for_small_strains(index, model))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::FailedLcp;
    use crate::lcp::FrictionalLcp;
    use crate::model::{Increments, Mesh, Procedure, Settings};
    use nalgebra::DMatrix;

    /// Nodes 10, 20, ... and a step of at least 0.01 an increment, 25 passes at most.
    fn model() -> Model {
        let mesh = Mesh {
            node_labels: (1..=6).map(|k| 10 * k).collect(),
            coordinates: vec![[0.0; 2]; 6],
            elements: vec![],
        };
        let step = Step {
            name: None,
            procedure: Procedure::Dynamic,
            increments: Increments {
                dt: 1.0,
                period: 1.0,
                dt_min: 0.01,
                direct: false,
            },
            settings: Settings::default(),
            supports: vec![],
            point_loads: vec![],
            body_forces: vec![],
            pressures: vec![],
            tractions: vec![],
            frames: crate::model::Frames::Default,
        };
        Model {
            mesh,
            steps: vec![step],
            ..Model::default()
        }
    }

    fn failure(cause: Cause, course: Option<Course>, dt: f64) -> Failure {
        Failure {
            increment: 4,
            step: 1,
            time: 0.3,
            dt,
            cause,
            course: course.map(Box::new),
            worst: None,
            passes: vec![],
            halvings: 1,
        }
    }

    #[test]
    fn every_course_is_told_with_what_to_change() {
        let nodes = [0, 1, 2];
        let changing = Alternation::Changing {
            slave: 0,
            segments: [[1, 2], [2, 3]],
        };
        for (course, told, advised) in [
            (
                Course::Growing { from: 5 },
                "grew from pass 5 on",
                "*AMPLITUDE",
            ),
            (
                Course::Slow {
                    rate: 0.614,
                    left: 12,
                },
                "about 12 more passes were needed: each correction is 0.61 of the last",
                "MAX PASSES of *STICKSLIP to 62 or more",
            ),
            (
                Course::Slow { rate: 0.1, left: 1 },
                "about 1 more pass was needed",
                "to 51 or more",
            ),
            (
                Course::Stagnant { correction: 3e-9 },
                "no smaller than 3.0e-09",
                "TOLERANCE of *STICKSLIP above 3e-09",
            ),
            (
                Course::Stagnant { correction: 3e-3 },
                "no smaller than 3.0e-03",
                "a smaller load",
            ),
            (
                Course::Alternating(vec![changing]),
                "node 10 went to and fro between segments 20-30 and 30-40 from pass to pass",
                "a finer mesh",
            ),
            (
                Course::Alternating(vec![Alternation::Closing(nodes), changing, changing]),
                "node 10 opened and closed on segment 20-30 from pass to pass, as did 2 other nodes",
                "leave out one",
            ),
            (
                Course::Alternating(vec![Alternation::Sliding(nodes)]),
                "node 10 stuck and slid on segment 20-30",
                "friction coefficient",
            ),
        ] {
            let text = course_text(&course, &model());
            assert!(text.contains(told), "{text}");
            let failure = failure(Cause::NotConverged, Some(course), 0.5);
            let text = advice(&failure, &model()).expect("advice");
            assert!(text.contains(advised) && !text.contains("halved"), "{text}");
        }
    }

    #[test]
    fn a_least_increment_that_ends_the_halving_is_told() {
        let advice = |dt| {
            advice(
                &failure(Cause::Collapsed { segment: [0, 1] }, None, dt),
                &model(),
            )
        };
        let [halved, least] = [0.02, 0.015].map(|dt| advice(dt).expect("advice"));
        assert!(!halved.contains("least increment"), "{halved}");
        assert!(least.starts_with("take a smaller load") && least.contains("least increment"));
    }

    #[test]
    fn friction_is_advised_on_where_there_is_some() {
        let of = |mu: f64, error: LcpError| {
            let problem = FrictionalLcp {
                q: DMatrix::identity(2, 2),
                gap: vec![-1.0].into(),
                slip: vec![0.0].into(),
                mu: vec![mu].into(),
            };
            let pairs = vec![[0, 1, 2]];
            let failed = FailedLcp {
                error,
                problem,
                pairs,
            };
            let text = advice(&failure(Cause::Lcp(Box::new(failed)), None, 0.5), &model());
            text.expect("advice").contains("friction")
        };
        let unsolved = || LcpError::PivotLimit { pivots: 9 };
        assert!(of(0.3, unsolved()) && !of(0.0, unsolved()));
        assert!(!of(0.3, LcpError::NotFinite));
    }

    #[test]
    fn what_puts_a_balance_off_is_told() {
        let text = |is_round_off| {
            let cause = Cause::Unbalanced {
                part: 0.1,
                is_round_off,
            };
            advice(&failure(cause, None, 0.015), &model()).expect("advice")
        };
        assert!(text(true).contains("consistent units") && !text(true).contains("halved"));
        assert!(text(false).contains("TOLERANCE") && text(false).contains("halved"));
    }

    #[test]
    fn causes_with_lines_of_their_own_need_no_advice() {
        let inverted = Cause::Inverted {
            element: 0,
            determinant: -1.0,
        };
        assert_eq!(advice(&failure(inverted, None, 0.5), &model()), None);
    }
}
