//! Friction at its limit on rigid faces, on which only the sums of the contact forces are unique: a block must move as its
//! equation of motion says, however many nodes its face has. See docs/theory/contact.md, Pairs at their limits.
//!
//! ```text
//!   |            ____
//!   |--/\/\/\---| m  |     N = m g
//!   |     k     |____|
//!   ==================  ->  V
//! ```

use std::f64::consts::PI;
use std::fmt::Write;

use stickslip::dynamics::{IncrementReport, RunSummary};
use stickslip::model::LcpMethod;

use crate::blocks::run_to_end;
use crate::reading::read;

const FORMULATIONS: [&str; 2] = ["NODE TO SURFACE", "SURFACE TO SURFACE"];
const METHODS: [LcpMethod; 2] = [LcpMethod::Hybrid, LcpMethod::Lemke];

const MASS: f64 = 1.0;
const SPRING: f64 = 50.0;
const NORMAL: f64 = 10.0;
const BELT: f64 = 0.1;
/// Friction at rest and of slip.
const MU: [f64; 2] = [0.4, 0.25];

/// Period of stick and slip: a way of 2 a on the belt, then half a turn and more of the phase.
///
/// ```text
/// w = sqrt(k/m),  a = (mu_s - mu_k) N/k,  T = 2 a/V + (pi + 2 atan(V/(w a)))/w
/// ```
fn period() -> f64 {
    let w = (SPRING / MASS).sqrt();
    let a = (MU[0] - MU[1]) * NORMAL / SPRING;
    2.0 * a / BELT + (PI + 2.0 * (BELT / (w * a)).atan()) / w
}

/// A rigid block with `nodes` on its lower face, on a belt.
struct Block {
    nodes: usize,
    formulation: &'static str,
    friction: &'static str,
    /// Velocity of the block at the start.
    speed: f64,
    belt: f64,
    /// A force along the belt in place of the spring.
    pull: Option<f64>,
    dt: f64,
    time: f64,
}

impl Block {
    fn deck(&self) -> String {
        let mut deck = String::from("*NODE\n");
        for i in 0..self.nodes {
            let x = i as f64 / (self.nodes - 1) as f64;
            for j in 0..2 {
                let _ = writeln!(deck, "{}, {x:?}, {:?}", 2 * i + j + 1, 0.2 * j as f64);
            }
        }
        deck += "*ELEMENT, TYPE=CPS4, ELSET=BLOCK\n";
        for i in 1..self.nodes {
            let a = 2 * i - 1;
            let _ = writeln!(deck, "{i}, {a}, {}, {}, {}", a + 2, a + 3, a + 1);
        }
        let spring = match self.pull {
            None => format!(
                "*ELEMENT, TYPE=SPRING1, ELSET=SPRING\n900, 1002\n*SPRING, ELSET=SPRING\n1\n{SPRING:?}\n"
            ),
            Some(_) => String::new(),
        };
        let pull = match self.pull {
            Some(pull) => format!("*CLOAD\nBLOCK, 1, {pull:?}\n"),
            None => String::new(),
        };
        let Block {
            formulation,
            friction,
            speed,
            belt,
            dt,
            time,
            ..
        } = self;
        format!(
            "{deck}*SOLID SECTION, ELSET=BLOCK, MATERIAL=M\n1.\n*MATERIAL, NAME=M\n*ELASTIC\n1e6, 0.3\n*DENSITY\n5.\n\
             *SURFACE, NAME=FACE\nBLOCK, S1\n*NODE, NSET=BELT\n1001, 0., -1.\n*NODE, NSET=BLOCK\n1002, 0.5, 0.1\n\
             *RIGID BODY, ELSET=BLOCK, REF NODE=1002\n\
             *SURFACE, NAME=GROUND, TYPE=SEGMENTS\nSTART, -20., 0.\nLINE, -9.7, 0.\nLINE, 0.3, 0.\nLINE, 20., 0.\n\
             *RIGID BODY, ANALYTICAL SURFACE=GROUND, REF NODE=1001\n\
             *SURFACE INTERACTION, NAME=DRY\n{friction}\n*CONTACT PAIR, INTERACTION=DRY, TYPE={formulation}\nFACE, GROUND\n\
             {spring}*INITIAL CONDITIONS, TYPE=VELOCITY\n1002, 1, {speed:?}\n*BOUNDARY\n1001, 2, 2\n1002, 6, 6\n\
             *STEP, INC=100000\n*DYNAMIC, DIRECT\n{dt:?}, {time:?}\n*BOUNDARY, TYPE=VELOCITY\n1001, 1, 1, {belt:?}\n\
             *DLOAD\nBLOCK, GRAV, {NORMAL:?}, 0., -1.\n{pull}*END STEP\n"
        )
    }

    /// The dof of its reference node along the belt: nodes are numbered as in the deck.
    fn dof(&self) -> usize {
        2 * (2 * self.nodes + 1)
    }

    fn run(&self, lcp: LcpMethod) -> (Vec<IncrementReport>, RunSummary) {
        let mut model = read(&self.deck());
        model.steps[0].settings.lcp = lcp;
        let (kept, summary) = run_to_end(&model);
        (kept.reports, summary)
    }
}

/// Stick and slip on the belt.
fn stick_slip(nodes: usize, formulation: &'static str, increments: f64) -> Block {
    Block {
        nodes,
        formulation,
        friction: "*FRICTION\n0.4, 0.\n0.25, 1e-5",
        speed: BELT,
        belt: BELT,
        pull: None,
        dt: period() / increments,
        time: 5.0 * period(),
    }
}

/// Times at which the block turns back, by interpolation of its velocity.
fn turns(reports: &[IncrementReport], dof: usize) -> Vec<f64> {
    let at = |report: &IncrementReport| (report.time, report.state.v[dof]);
    let pairs = reports.windows(2).map(|two| (at(&two[0]), at(&two[1])));
    let turns = pairs.filter(|((_, v0), (_, v1))| *v0 > 0.0 && *v1 <= 0.0);
    turns
        .map(|((t0, v0), (t1, v1))| t0 + (t1 - t0) * v0 / (v0 - v1))
        .collect()
}

#[test]
fn stick_and_slip_have_the_period_of_the_closed_form_for_any_number_of_nodes() {
    for nodes in [2, 3, 4, 6, 20] {
        for formulation in FORMULATIONS {
            for increments in [100.0, 400.0] {
                let lcp = METHODS[nodes % 2];
                let block = stick_slip(nodes, formulation, increments);
                let (reports, summary) = block.run(lcp);
                let turns = turns(&reports, block.dof());
                let count = turns.len() - 1;
                let mean = (turns[count] - turns[0]) / count as f64;
                let error = mean / period() - 1.0;
                println!("{nodes} {formulation} {increments}: {count} periods, {error:.1e}");
                assert!(
                    error.abs() < 5e-4,
                    "{nodes} {formulation} {increments}: {error}"
                );
                // the onset of a slip is at the end of an increment
                for two in turns.windows(2) {
                    let error = (two[1] - two[0]) / period() - 1.0;
                    assert!(
                        error.abs() < 0.25 / increments,
                        "{nodes} {formulation}: {error}"
                    );
                }
                assert_eq!(summary.cutbacks, 0, "{nodes} {formulation} {increments}");
                for report in &reports {
                    let contact = &report.contacts[0];
                    assert!(contact.cone_violation < 1e-9 && contact.impulse_cone_violation < 1e-9);
                    // all of them stick, or none does
                    assert!(
                        [0, contact.closed].contains(&contact.sticking),
                        "{}",
                        report.time
                    );
                }
            }
        }
    }
}

#[test]
fn a_block_on_a_belt_is_held_up_to_friction_at_rest() {
    for nodes in [2, 6, 20] {
        for formulation in FORMULATIONS {
            for lcp in METHODS {
                for part in [0.3, 0.39, 0.41] {
                    let pull = Some(-part * NORMAL);
                    let (dt, time) = (0.003, 0.15);
                    let block = Block {
                        pull,
                        dt,
                        time,
                        ..stick_slip(nodes, formulation, 100.0)
                    };
                    let (reports, _) = block.run(lcp);
                    let what = format!("{nodes} {formulation} {lcp:?} {part}");
                    let slips = part > MU[0];
                    let mu = if slips { MU[1] } else { part };
                    for report in &reports[2..] {
                        let contact = &report.contacts[0];
                        let sticking = if slips { 0 } else { contact.closed };
                        assert_eq!(contact.sticking, sticking, "{what} {}", report.time);
                        let error = contact.force[0] / (mu * NORMAL) - 1.0;
                        assert!(error.abs() < 1e-9, "{what} {}: {error}", report.time);
                    }
                    let last = reports.last().expect("reports");
                    let speed = last.state.v[block.dof()];
                    assert_eq!(slips, (speed - BELT).abs() > 1e-9, "{what}: {speed}");
                }
            }
        }
    }
}

#[test]
fn a_block_comes_to_rest_at_the_same_place_for_any_number_of_nodes() {
    for friction in [
        "*FRICTION\n0.07",
        "*FRICTION, EXPONENTIAL DECAY\n0.1, 0.05, 20.",
    ] {
        let mut places: Vec<f64> = Vec::new();
        for nodes in [2, 3, 4, 6, 20] {
            for formulation in FORMULATIONS {
                let block = Block {
                    friction,
                    speed: 0.5,
                    belt: 0.0,
                    time: 1.5,
                    ..stick_slip(nodes, formulation, 400.0)
                };
                let (reports, _) = block.run(LcpMethod::Hybrid);
                let last = reports.last().expect("reports");
                assert!(last.state.v[block.dof()].abs() < 1e-12, "it rests");
                assert_eq!(last.contacts[0].sticking, last.contacts[0].closed);
                places.push(last.state.u[block.dof()]);
            }
        }
        println!("{friction:?}: {places:?}");
        for place in &places {
            assert!(
                (place / places[0] - 1.0).abs() < 1e-9,
                "{friction:?}: {places:?}"
            );
        }
    }
}

#[test]
fn friction_under_pressure_is_that_of_the_law_in_every_increment() {
    let deck = include_str!("../decks/drawn_block.inp");
    // p = 10 on 0.7: the limit 2 of the shear stress, or mu = 0.5 - 0.4 (10 - 2)/20
    let table = deck.replace(
        "*FRICTION, TAUMAX=2.\n0.5",
        "*FRICTION\n0.5, 0., 2.\n0.1, 0., 22.",
    );
    assert_ne!(deck, table);
    for (deck, force, mu) in [(deck, 1.4, 0.2), (&table, 2.38, 0.34)] {
        for formulation in FORMULATIONS {
            let model = read(&deck.replace(FORMULATIONS[0], formulation));
            let (kept, _) = run_to_end(&model);
            // the first step presses alone
            let drawn = kept
                .reports
                .iter()
                .filter(|report| report.time > 1.0 + 1e-9);
            let mut count = 0;
            for report in drawn {
                let contact = &report.contacts[0];
                let error = contact.tangential.abs() / force - 1.0;
                assert!(error.abs() < 1e-9, "{formulation} {}: {error}", report.time);
                assert!((contact.friction_coefficient / mu - 1.0).abs() < 1e-9);
                assert!(contact.cone_violation < 1e-9);
                count += 1;
            }
            assert!(count >= 20, "{formulation}: {count}");
        }
    }
}
