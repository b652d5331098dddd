//! What a step removes: in a static or quasi-static step its forces fall linearly to zero, in another dynamic one they are
//! gone at its start. One table of all kinds: supports wherever connections take them, loads, contacts and friction.

use crate::blocks::Keep;
use crate::statics::run_deck;

/// Something that the first step gives, and the second one takes away.
struct Removed {
    what: &'static str,
    /// Cards of the model.
    model: &'static str,
    /// Cards of the first step.
    given: &'static str,
    /// Cards of the second step.
    taken: &'static str,
}

const SUPPORTS: &str = "*BOUNDARY, OP=NEW\nHELD, 1, 2\n";
const COUPLED: &str = "*COUPLING, CONSTRAINT NAME=C, REF NODE=20, SURFACE=TOP\n*KINEMATIC\n";
const RIGID: &str = "*RIGID BODY, ELSET=UPPER, REF NODE=20\n";
/// A block that stands on the other one.
const STOP: &str = "*NODE\n31, -1., 1.\n32, 2., 1.\n33, 2., 2.\n34, -1., 2.\n*ELEMENT, TYPE=CPE4, ELSET=S\n9, 31, 32, 33, 34\n\
                    *SOLID SECTION, ELSET=S, MATERIAL=M\n1.\n*NSET, NSET=STOP\n31, 32, 33, 34\n*SURFACE, NAME=SOLE\nS, S1\n\
                    *SURFACE INTERACTION, NAME=I\n*FRICTION\n0.01\n*CONTACT PAIR, INTERACTION=I\nTOP, SOLE\n";
const PRESSED: &str = "*BOUNDARY\nSTOP, 1, 1, 0.004\nSTOP, 2, 2, -0.001\n";

/// A support of a node that nothing else takes part in, and so on.
const ALL: &[Removed] = &[
    Removed {
        what: "support of a free node",
        model: "",
        given: "*BOUNDARY\n9, 1, 2, 0.001\n",
        taken: SUPPORTS,
    },
    Removed {
        what: "support of one direction, the other one stays",
        model: "",
        given: "*BOUNDARY\n9, 1, 2, 0.001\n",
        taken: "*BOUNDARY, OP=NEW\nHELD, 1, 2\n9, 2, 2, 0.001\n",
    },
    Removed {
        what: "support of a node that an *EQUATION follows",
        model: "*EQUATION\n2\n9, 1, 1., 8, 1, -0.5\n",
        given: "*BOUNDARY\n8, 1, 2, 0.001\n",
        taken: SUPPORTS,
    },
    Removed {
        what: "support of a node that *MPC, TIE follows",
        model: "*MPC\nTIE, 7, 9\n",
        given: "*BOUNDARY\n9, 1, 2, 0.001\n",
        taken: SUPPORTS,
    },
    Removed {
        what: "support of a node that *TIE follows",
        model: "*NODE\n31, 0.2, 1.\n32, 0.8, 1.\n33, 0.8, 2.\n34, 0.2, 2.\n*ELEMENT, TYPE=CPE4, ELSET=S\n\
                9, 31, 32, 33, 34\n*SOLID SECTION, ELSET=S, MATERIAL=M\n1.\n*SURFACE, NAME=SOLE\nS, S1\n\
                *TIE, NAME=T\nSOLE, TOP\n",
        given: "*BOUNDARY\n8, 1, 2, 0.001\n",
        taken: SUPPORTS,
    },
    Removed {
        what: "support of a distributing coupling",
        model: "*COUPLING, CONSTRAINT NAME=C, REF NODE=20, SURFACE=TOP\n*DISTRIBUTING\n",
        given: "*BOUNDARY\n20, 1, 2, 0.001\n",
        taken: SUPPORTS,
    },
    Removed {
        what: "support of a kinematic coupling",
        model: COUPLED,
        given: "*BOUNDARY\n20, 1, 2, 0.001\n",
        taken: SUPPORTS,
    },
    Removed {
        what: "direction 6 of a kinematic coupling",
        model: COUPLED,
        given: "*BOUNDARY\n20, 6, 6, 0.001\n",
        taken: SUPPORTS,
    },
    Removed {
        what: "direction 6 of a coupling whose other directions stay",
        model: COUPLED,
        given: "*BOUNDARY\n20, 1, 2\n20, 6, 6, 0.001\n",
        taken: "*BOUNDARY, OP=NEW\nHELD, 1, 2\n20, 1, 2\n",
    },
    Removed {
        what: "all supports of a rigid part",
        model: RIGID,
        given: "*BOUNDARY\n20, 1, 2, 0.0007\n20, 6, 6, 0.001\n",
        taken: SUPPORTS,
    },
    Removed {
        what: "one support of a rigid part",
        model: RIGID,
        given: "*BOUNDARY\n20, 1, 1, 0.001\n",
        taken: SUPPORTS,
    },
    Removed {
        what: "lock of a pre-tension section",
        model: "*PRE-TENSION SECTION, NODE=20, SURFACE=CUT\n",
        given: "*BOUNDARY\n20, 1, 1, 0.001\n7, 1, 2\n9, 1, 2\n",
        taken: "*BOUNDARY, OP=NEW\nHELD, 1, 2\n7, 1, 2\n9, 1, 2\n",
    },
    Removed {
        what: "force",
        model: "",
        given: "*CLOAD\n9, 1, 0.5\n9, 2, 0.2\n",
        taken: "*CLOAD, OP=NEW\n",
    },
    Removed {
        what: "force on a distributing coupling",
        model: "*COUPLING, CONSTRAINT NAME=C, REF NODE=20, SURFACE=TOP\n*DISTRIBUTING\n",
        given: "*CLOAD\n20, 1, 0.5\n",
        taken: "*CLOAD, OP=NEW\n",
    },
    Removed {
        what: "moment",
        model: COUPLED,
        given: "*CLOAD\n20, 6, 0.3\n",
        taken: "*CLOAD, OP=NEW\n",
    },
    Removed {
        what: "pressure",
        model: "",
        given: "*DLOAD\nUPPER, P2, 1.\n",
        taken: "*DLOAD, OP=NEW\n",
    },
    Removed {
        what: "gravity",
        model: "",
        given: "*DLOAD\nE, GRAV, 1., 0.6, -0.8\n",
        taken: "*DLOAD, OP=NEW\n",
    },
    Removed {
        what: "contact pair",
        model: STOP,
        given: PRESSED,
        taken: "*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nTOP, SOLE\n",
    },
    Removed {
        what: "friction of a pair that slides",
        model: STOP,
        given: PRESSED,
        taken: "*CHANGE FRICTION, INTERACTION=I\n*FRICTION\n0.\n",
    },
];

impl Removed {
    /// Its run with two steps of these procedures, with a pressure at the side that stays.
    fn run(&self, [first, second]: [&str; 2]) -> Keep {
        let Removed {
            what,
            model,
            given,
            taken,
        } = self;
        let nodes: String = (0..9)
            .map(|n| {
                format!(
                    "{}, {:?}, {:?}\n",
                    n + 1,
                    0.5 * (n % 3) as f64,
                    0.5 * (n / 3) as f64
                )
            })
            .collect();
        let (keep, failure) = run_deck(&format!(
            "*NODE\n{nodes}20, 0.5, 1.2\n*ELEMENT, TYPE=CPE4, ELSET=E\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n3, 4, 5, 8, 7\n\
             4, 5, 6, 9, 8\n*ELSET, ELSET=UPPER\n3, 4\n*ELSET, ELSET=LOWER\n1, 2\n*NSET, NSET=HELD\n1, 2, 3\n\
             *SURFACE, NAME=TOP\nUPPER, S3\n*SURFACE, NAME=SIDE\n1, S4\n3, S4\n*SURFACE, NAME=CUT\nLOWER, S3\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n\
             *DENSITY\n1.\n*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n{model}*BOUNDARY\nHELD, 1, 2\n\
             *STEP, NLGEOM\n{first}\n*DSLOAD\nSIDE, P, 0.2\n{given}*END STEP\n\
             *STEP, NLGEOM\n{second}\n{taken}*END STEP\n"
        ));
        assert_eq!(failure, None, "{what}, {second}");
        let energy = &keep.reports.last().expect("reports").energy;
        let scale = energy.strain + energy.kinetic + energy.external_work.abs();
        assert!(energy.balance.abs() < 1e-9 * scale, "{what}: {energy:?}");
        keep
    }
}

/// Ways of the nodes from the end of the first step to the ends of the increments of the second one, with their times.
fn ways(keep: &Keep) -> Vec<(f64, Vec<f64>)> {
    let first = keep.reports.iter().rfind(|r| r.step == 1).expect("step 1");
    let way = |u: &[f64]| u.iter().zip(&first.state.u).map(|(u, u0)| u - u0).collect();
    let second = keep.reports.iter().filter(|report| report.step == 2);
    second.map(|r| (r.step_time, way(&r.state.u))).collect()
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).fold(0.0, f64::max)
}

const STATIC: &str = "*STATIC, DIRECT\n0.25, 1.";
/// A step of some hundred times the slowest vibration.
const SLOW: &str = "*DYNAMIC, APPLICATION=QUASI-STATIC, DIRECT\n25., 100.";

/// Asserts that all nodes go linearly through the second step, to a part of the largest way.
fn assert_linear(procedures: [&str; 2], tolerance: f64) {
    for removed in ALL {
        let ways = ways(&removed.run(procedures));
        let (end, whole) = ways.last().expect("increments");
        let size = largest(whole.iter().copied());
        assert!(size > 1e-5, "{}: {size}", removed.what);
        for (t, way) in &ways {
            let linear = whole.iter().map(|whole| t / end * whole);
            let off = largest(way.iter().zip(linear).map(|(way, linear)| way - linear)) / size;
            assert!(
                off < tolerance,
                "{}, {procedures:?}, {t}: {off}",
                removed.what
            );
        }
    }
}

#[test]
fn what_a_static_step_removes_fades_linearly_over_it() {
    assert_linear([STATIC, STATIC], 2e-3);
}

#[test]
fn what_a_quasi_static_step_removes_fades_linearly_over_it() {
    assert_linear([STATIC, SLOW], 5e-3);
    assert_linear([SLOW, SLOW], 5e-3);
    assert_linear([SLOW, STATIC], 5e-3);
}

#[test]
fn what_a_dynamic_step_removes_is_gone_at_its_start() {
    for removed in ALL {
        // a force that acts from the start makes four times the way in twice the time, one that grows six times
        let ways = ways(&removed.run([STATIC, "*DYNAMIC, DIRECT\n1.e-4, 2.e-4"]));
        let [one, two] = [0, 1].map(|i| largest(ways[i].1.iter().copied()));
        let what = removed.what;
        assert!(
            one > 0.0 && (two / one - 4.0).abs() < 0.05,
            "{what}: {}",
            two / one
        );
    }
}
