//! Parts whose instances are moved and turned, with every keyword that a part may have, beside the flat deck of what they
//! become: the same histories.

use std::collections::BTreeSet;

use crate::reading::read;
use crate::statics::run_deck;
use serde_json::Value;
use stickslip::deck::{Level, Status, keywords};
use stickslip::dynamics::IncrementReport;
use stickslip::flat_deck::{difference, flat_deck};

/// An instance of a part, or what becomes of it in a flat deck.
struct Own {
    name: &'static str,
    /// Its translation (length), and centre (length) and angle in degrees of the rotation after it.
    motion: ([f64; 2], [f64; 2], f64),
    /// Number before those of its nodes and elements in a flat deck; none in a part.
    first: Option<usize>,
}

impl Own {
    /// Cosine and sine of its angle.
    fn cos_sin(&self) -> [f64; 2] {
        let (sin, cos) = self.motion.2.to_radians().sin_cos();
        [cos, sin]
    }

    /// A direction of the part.
    fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [cos, sin] = self.cos_sin();
        match self.first {
            Some(_) => [cos * x - sin * y, sin * x + cos * y],
            None => [x, y],
        }
    }

    /// A point of the part as coordinates of a row.
    fn at(&self, [x, y]: [f64; 2]) -> String {
        let (shift, centre, _) = self.motion;
        let [x, y] = match self.first {
            Some(_) => {
                let [a, b] = self.turned([x + shift[0] - centre[0], y + shift[1] - centre[1]]);
                [centre[0] + a, centre[1] + b]
            }
            None => [x, y],
        };
        format!("{x:?}, {y:?}")
    }

    /// Numbers of nodes and elements.
    fn numbers<const N: usize>(&self, numbers: [usize; N]) -> String {
        let all = numbers.map(|n| (n + self.first.unwrap_or(0)).to_string());
        all.join(", ")
    }

    /// The name of something of the part.
    fn name(&self, name: &str) -> String {
        match self.first {
            Some(_) => format!("{}.{name}", self.name),
            None => name.to_owned(),
        }
    }

    /// Rows of `*NODE`.
    fn nodes(&self, nodes: &[(usize, [f64; 2])]) -> String {
        let row = |&(number, at): &(usize, [f64; 2])| {
            format!("{}, {}\n", self.numbers([number]), self.at(at))
        };
        nodes.iter().map(row).collect()
    }

    /// An equation between terms of node set, direction and coefficient.
    fn equation(&self, terms: &[(&str, usize, f64)]) -> String {
        let mut rows = Vec::new();
        for &(set, direction, coefficient) in terms {
            let set = self.name(set);
            let mut along = [0.0; 2];
            along[direction - 1] = coefficient;
            let [x, y] = self.turned(along);
            let both = [(1, x), (2, y)].into_iter().filter(|(_, c)| *c != 0.0);
            rows.extend(both.map(|(k, c)| format!("{set}, {k}, {c:?}")));
        }
        let count = rows.len();
        let lines: Vec<String> = rows.chunks(4).map(|row| row.join(", ")).collect();
        format!("*EQUATION\n{count}\n{}\n", lines.join("\n"))
    }

    /// Equations that give a node the displacement of another one along direction 1, and twice that along direction 2; in a flat
    /// deck as a matrix.
    fn doubled(&self, node: &str, other: &str) -> String {
        match self.first {
            Some(_) => {
                let [c, s] = self.cos_sin();
                let rows = [[c * c + 2.0 * s * s, -c * s], [-c * s, s * s + 2.0 * c * c]];
                let [node, other] = [node, other].map(|set| self.name(set));
                let equation = |(k, [a, b]): (usize, [f64; 2])| {
                    format!(
                        "*EQUATION\n3\n{node}, {k}, 1., {other}, 1, {:?}, {other}, 2, {:?}\n",
                        -a, -b
                    )
                };
                (1..).zip(rows).map(equation).collect()
            }
            None => {
                self.equation(&[(node, 1, 1.0), (other, 1, -1.0)])
                    + &self.equation(&[(node, 2, 1.0), (other, 2, -2.0)])
            }
        }
    }

    /// `*INSTANCE` with the cards of the instance itself; they alone in a flat deck.
    fn instance(&self, part: &str, cards: &str) -> String {
        let (shift, c, angle) = self.motion;
        match self.first {
            Some(_) => String::new(),
            None => format!(
                "*INSTANCE, NAME={}, PART={part}\n{:?}, {:?}, 0.\n{:?}, {:?}, 0., {:?}, {:?}, 1., {angle:?}\n\
                 {cards}*END INSTANCE\n",
                self.name, shift[0], shift[1], c[0], c[1], c[0], c[1]
            ),
        }
    }
}

/// Two blocks, one tied to the other, with springs, dashpots, an equation and couplings.
fn body(own: &Own) -> String {
    let nodes = [
        (1, [0.0, 0.0]),
        (2, [1.0, 0.0]),
        (3, [2.0, 0.0]),
        (4, [0.0, 1.0]),
        (5, [1.0, 1.0]),
        (6, [2.0, 1.0]),
        (7, [3.0, 0.0]),
        (8, [3.0, 1.0]),
        (11, [0.25, 1.0]),
        (12, [1.75, 1.0]),
        (13, [1.75, 2.0]),
        (14, [0.25, 2.0]),
        (21, [3.5, 0.75]),
        (22, [-0.5, 1.5]),
        (23, [-0.5, 0.5]),
        (24, [-1.5, 1.5]),
        (25, [-1.5, 0.5]),
    ];
    let n = |name: &str| own.name(name);
    let set = |name: &str, number: usize| {
        let (name, number) = (n(name), own.numbers([number]));
        format!("*NSET, NSET={name}\n{number}\n")
    };
    let elements = [
        format!(
            "{}\n{}\n",
            own.numbers([1, 1, 2, 5, 4]),
            own.numbers([2, 2, 3, 6, 5])
        ),
        format!("{}\n", own.numbers([3, 11, 12, 13, 14])),
        format!("{}\n", own.numbers([41, 4])),
        format!("{}\n", own.numbers([42, 6, 13])),
        format!("{}\n", own.numbers([43, 14])),
        format!("{}\n", own.numbers([44, 14, 6])),
        format!("{}\n", own.numbers([45, 21])),
        format!("{}\n", own.numbers([46, 21])),
        format!("{}\n", own.numbers([4, 3, 7, 8, 6])),
    ];
    let side = format!("*NSET, NSET={}\n{}\n", n("SIDE"), own.numbers([7, 8]));
    let points = [[1.0, 1.5], [-1.0, 1.0], [0.0, 0.5]].map(|p| own.at(p));
    // what stands without *ORIENTATION in the part is along the axes of the part
    let (axes, along) = match own.first {
        Some(_) => {
            let [[a, b], [c, d]] = [[1.0, 0.0], [0.0, 1.0]].map(|e| own.turned(e));
            let name = n("AXES");
            let card = format!("*ORIENTATION, NAME={name}\n{a:?}, {b:?}, 0., {c:?}, {d:?}, 0.\n");
            (card, format!(", ORIENTATION={name}"))
        }
        None => (String::new(), String::new()),
    };
    format!(
        "*NODE\n{}*ELEMENT, TYPE=CPE4, ELSET={LOWER}\n{}*ELEMENT, TYPE=CPE4, ELSET={UPPER}\n{}*ELEMENT, TYPE=CPE4, ELSET={TAIL}\n{}\
         *ELSET, ELSET={ALL}\n{LOWER}, {UPPER}, {TAIL}\n*SOLID SECTION, ELSET={ALL}, MATERIAL=M\n1.\n\
         *NSET, NSET={BASE}\n{}\n{}{}{}{}{}{}{}{}\
         *SURFACE, NAME={TOP}\n{LOWER}, S3\n*SURFACE, NAME={SOLE}\n{UPPER}, S1\n*SURFACE, NAME={ROOF}\n{UPPER}, S3\n\
         *SURFACE, NAME={FACE}, TYPE=NODE\n{CORNER}\n\
         *TIE, NAME={BOND}\n{SOLE}, {TOP}\n\
         *ELEMENT, TYPE=SPRING1, ELSET={S1}\n{}*ELEMENT, TYPE=SPRING2, ELSET={S2}\n{}\
         *ELEMENT, TYPE=DASHPOT1, ELSET={D1}\n{}*ELEMENT, TYPE=SPRINGA, ELSET={SA}\n{}\
         {axes}*ORIENTATION, NAME={SLOPE}\n{}, 0., {}, 0., {}, 0.\n3, 20.\n\
         *SPRING, ELSET={S1}, NONLINEAR{along}\n1\n-3., -1.\n0., 0.\n40., 0.5\n\
         *SPRING, ELSET={S2}, ORIENTATION={SLOPE}\n1, 2\n25.\n*DASHPOT, ELSET={D1}{along}\n2\n0.7\n\
         *SPRING, ELSET={SA}\n\n12.\n\
         *ELEMENT, TYPE=MASS, ELSET={PM}\n{}*MASS, ELSET={PM}\n0.4\n\
         *ELEMENT, TYPE=ROTARYI, ELSET={PI}\n{}*ROTARY INERTIA, ELSET={PI}\n, , 0.02\n\
         *KINEMATIC COUPLING, REF NODE={RP}, NAME={GRIP}\n{SIDE}\n\
         *COUPLING, CONSTRAINT NAME={PULL}, REF NODE={MEAN}, SURFACE={FACE}\n*DISTRIBUTING\n\
         *MPC\nTIE, {LONE}, {CORNER}\n{}{}",
        own.nodes(&nodes),
        elements[0],
        elements[1],
        elements[8],
        own.numbers([1, 2, 3]),
        side,
        set("RP", 21),
        set("MEAN", 22),
        set("CORNER", 14),
        set("LONE", 23),
        set("OTHER", 13),
        set("SLIDER", 24),
        set("SKEW", 25),
        elements[2],
        elements[3],
        elements[4],
        elements[5],
        points[0],
        points[1],
        points[2],
        elements[6],
        elements[7],
        own.equation(&[("SLIDER", 1, 1.0), ("OTHER", 1, -2.0), ("OTHER", 2, 0.5)]),
        own.doubled("SKEW", "CORNER"),
        LOWER = n("LOWER"),
        UPPER = n("UPPER"),
        TAIL = n("TAIL"),
        ALL = n("ALL"),
        BASE = n("BASE"),
        TOP = n("TOP"),
        SOLE = n("SOLE"),
        ROOF = n("ROOF"),
        FACE = n("FACE"),
        CORNER = n("CORNER"),
        BOND = n("BOND"),
        S1 = n("S1"),
        S2 = n("S2"),
        D1 = n("D1"),
        SA = n("SA"),
        SLOPE = n("SLOPE"),
        PM = n("PM"),
        PI = n("PI"),
        RP = n("RP"),
        GRIP = n("GRIP"),
        SIDE = n("SIDE"),
        PULL = n("PULL"),
        MEAN = n("MEAN"),
        LONE = n("LONE"),
    )
}

/// A strip of two elements that is cut between them, its normal given.
fn strip(own: &Own) -> String {
    let nodes = [
        (1, [0.0, 0.0]),
        (2, [1.0, 0.0]),
        (3, [2.0, 0.0]),
        (4, [0.0, 0.5]),
        (5, [1.0, 0.5]),
        (6, [2.0, 0.5]),
        (9, [1.0, -1.0]),
    ];
    let n = |name: &str| own.name(name);
    let [nx, ny] = own.turned([0.8, 0.6]);
    format!(
        "*NODE\n{}*ELEMENT, TYPE=CPE4, ELSET={ALL}\n{}\n{}\n*SOLID SECTION, ELSET={ALL}, MATERIAL=M\n1.\n\
         *NSET, NSET={END}\n{}\n*NSET, NSET={LOCK}\n{}\n*SURFACE, NAME={CUT}\n{}, S2\n\
         *PRE-TENSION SECTION, NODE={LOCK}, SURFACE={CUT}\n{nx:?}, {ny:?}, 0.\n",
        own.nodes(&nodes),
        own.numbers([1, 1, 2, 5, 4]),
        own.numbers([2, 2, 3, 6, 5]),
        own.numbers([1, 4]),
        own.numbers([9]),
        own.numbers([1]),
        ALL = n("ALL"),
        END = n("END"),
        LOCK = n("LOCK"),
        CUT = n("CUT"),
    )
}

/// A drawn tool with a mass, as Abaqus/CAE writes it: between `*INSTANCE` and `*END INSTANCE`.
fn tool(own: &Own) -> String {
    let n = |name: &str| own.name(name);
    let points = [[-1.0, 0.75], [0.0, 0.0], [1.25, 1.25], [0.0, 1.25]].map(|p| own.at(p));
    format!(
        "*NODE\n{}*NSET, NSET={REF}\n{}\n*SURFACE, NAME={SKIN}, TYPE=SEGMENTS\nSTART, {}\nLINE, {}\nCIRCL, {}, {}\n\
         *RIGID BODY, REF NODE={REF}, ANALYTICAL SURFACE={SKIN}\n\
         *ELEMENT, TYPE=MASS, ELSET={PM}\n{}\n*MASS, ELSET={PM}\n2.\n\
         *ELEMENT, TYPE=ROTARYI, ELSET={PI}\n{}\n*ROTARY INERTIA, ELSET={PI}\n, , 0.3\n",
        own.nodes(&[(1, [0.25, 1.0])]),
        own.numbers([1]),
        points[2],
        points[1],
        points[0],
        own.at([0.25, 1.375]),
        own.numbers([1, 1]),
        own.numbers([2, 1]),
        REF = n("REF"),
        SKIN = n("SKIN"),
        PM = n("PM"),
        PI = n("PI"),
    )
}

/// The deck of all parts, or the flat one that they become.
fn deck(is_flat: bool) -> String {
    let own = |name, motion, first| Own {
        name,
        motion,
        first: is_flat.then_some(first),
    };
    let body_own = own("B", ([0.3, -0.2], [1.0, 1.0], 30.0), 100);
    let strip_own = own("P", ([6.0, 0.0], [6.0, 0.0], 90.0), 200);
    let tool_own = own("T", ([1.3, 1.85], [1.0, 1.0], 30.0), 300);
    let (body, strip, tool) = (body(&body_own), strip(&strip_own), tool(&tool_own));
    let parts = match is_flat {
        true => format!("{body}{strip}{tool}"),
        false => format!(
            "*PART, NAME=BODY\n{body}*END PART\n*PART, NAME=STRIP\n{strip}*END PART\n*PART, NAME=TOOL\n*END PART\n\
             *ASSEMBLY, NAME=A\n{}{}{}*END ASSEMBLY\n",
            body_own.instance("BODY", ""),
            strip_own.instance("STRIP", ""),
            tool_own.instance("TOOL", &tool),
        ),
    };
    format!(
        "{parts}*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n\
         *SURFACE INTERACTION, NAME=DRY\n*FRICTION\n0.2\n*CONTACT PAIR, INTERACTION=DRY\nB.ROOF, T.SKIN\n\
         *BOUNDARY\nB.BASE, 1, 2\nP.END, 1, 2\n\
         *INITIAL CONDITIONS, TYPE=VELOCITY\nT.REF, 1, 0.6\nT.REF, 2, -1.2\nT.REF, 6, 0.1\nB.UPPERNODES, 1, -0.3\n\
         *NSET, NSET=B.UPPERNODES\nB.CORNER, B.OTHER\n\
         *STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 0.5\n*DLOAD\n, GRAV, 1., 0.6, -0.8\n\
         *CLOAD\nP.LOCK, 1, 2.\nB.MEAN, 2, -0.5\nB.SKEW, 1, 0.1\n*END STEP\n"
    )
}

/// All numbers of a report with the names that lead to them, but for those of the solver.
fn numbers(path: &str, value: &Value, all: &mut Vec<(String, f64)>) {
    match value {
        Value::Object(fields) => {
            for (name, value) in fields.iter().filter(|(name, _)| *name != "solver") {
                numbers(&format!("{path}/{name}"), value, all);
            }
        }
        Value::Array(values) => values
            .iter()
            .enumerate()
            .for_each(|(k, value)| numbers(&format!("{path}/{k}"), value, all)),
        value => all.extend(value.as_f64().map(|number| (path.to_owned(), number))),
    }
}

#[test]
fn moved_instances_run_as_the_flat_deck_of_what_they_become() {
    let [moved, flat] = [false, true].map(|is_flat| {
        let (keep, failure) = run_deck(&deck(is_flat));
        assert_eq!(failure, None);
        keep.reports
    });
    assert_eq!((moved.len(), flat.len()), (51, 51));
    let touches = |report: &IncrementReport| report.contacts[0].force != [0.0; 2];
    assert!(moved.iter().any(touches), "the tool touches the body");
    let of = |reports: &[IncrementReport]| -> Vec<Vec<(String, f64)>> {
        let each = reports.iter().map(|report| {
            let mut all = Vec::new();
            let value = serde_json::to_value(report).expect("a report is JSON");
            numbers("", &value, &mut all);
            for (name, values) in [
                ("u", &report.state.u),
                ("v", &report.state.v),
                ("reaction", &report.nodal.reaction),
            ] {
                all.extend(values.iter().map(|value| (name.to_owned(), *value)));
            }
            all
        });
        each.collect()
    };
    let [moved, flat] = [moved, flat].map(|reports| of(&reports));
    let names = |reports: &[Vec<(String, f64)>]| -> Vec<String> {
        reports[0].iter().map(|(name, _)| name.clone()).collect()
    };
    assert_eq!(names(&moved), names(&flat));
    assert!(names(&moved).len() > 100);
    for (k, name) in names(&moved).iter().enumerate() {
        let sizes = moved.iter().chain(&flat).map(|report| report[k].1.abs());
        // what vanishes is beside forces, energies and momenta of the order of 1
        let scale = sizes.fold(1.0, f64::max);
        for (i, (a, b)) in moved.iter().zip(&flat).enumerate() {
            let error = (a[k].1 - b[k].1).abs();
            assert!(
                error <= 1e-12 * scale,
                "{name}, increment {i}: {:e} {:e}",
                a[k].1,
                b[k].1
            );
        }
    }
}

#[test]
fn moved_instances_are_written_as_a_flat_deck() {
    let model = read(&deck(false));
    assert_eq!(difference(&flat_deck(&model), &model), None);
}

/// No keyword that a part may have is missing in the comparison.
#[test]
fn every_keyword_of_parts_is_moved() {
    let text = deck(false);
    let used: BTreeSet<&str> = (text.lines())
        .filter_map(|line| line.strip_prefix('*'))
        .filter_map(|line| line.split(',').next())
        .collect();
    let of_parts = keywords().filter(|keyword| {
        let is_general = ["INCLUDE", "PARAMETER"].contains(&keyword.name);
        keyword.status == Status::Read && keyword.levels.has(Level::Part) && !is_general
    });
    let missing: Vec<&str> = (of_parts.map(|keyword| keyword.name))
        .filter(|name| !used.contains(name) && *name != "KINEMATIC")
        .collect();
    assert_eq!(missing, Vec::<&str>::new());
}
