//! Static steps: bodies that contact without friction lets free along the surface of an elastic floor.

use crate::blocks::Keep;
use crate::statics::run_deck;
use stickslip::dynamics::Cause;

/// Elastic blocks on an elastic floor.
struct Pile {
    /// Elements along the lowest block, and how far it is off the middle of the floor (parts of a unit).
    along: usize,
    off: f64,
    blocks: usize,
    from_surface: bool,
    friction: f64,
    /// Slope of the floor (rad).
    slope: f64,
    /// Units of length and stress.
    units: [f64; 2],
}

const PILE: Pile = Pile {
    along: 4,
    off: 0.1,
    blocks: 1,
    from_surface: false,
    friction: 0.0,
    slope: 0.0,
    units: [1.0; 2],
};

/// A block of a grid of elements whose numbers begin after those given: its cards, and the numbers after it.
fn grid(
    name: &str,
    [nx, ny]: [usize; 2],
    [x, y, width, height]: [f64; 4],
    [node, element]: [usize; 2],
) -> (String, [usize; 2]) {
    let number = |i: usize, j: usize| node + 1 + j * (nx + 1) + i;
    let mut text = format!("*NODE, NSET={name}\n");
    for (j, i) in (0..=ny).flat_map(|j| (0..=nx).map(move |i| (j, i))) {
        let [x, y] = [
            x + width * i as f64 / nx as f64,
            y + height * j as f64 / ny as f64,
        ];
        text += &format!("{}, {x:?}, {y:?}\n", number(i, j));
    }
    text += &format!("*ELEMENT, TYPE=CPE4, ELSET={name}\n");
    for (j, i) in (0..ny).flat_map(|j| (0..nx).map(move |i| (j, i))) {
        let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| number(i, j));
        let [a, b, c, d] = corners;
        text += &format!("{}, {a}, {b}, {c}, {d}\n", element + 1 + j * nx + i);
    }
    let faces = |row: usize, face: &str| -> String {
        let own = (0..nx).map(|i| format!("{}, {face}\n", element + 1 + row * nx + i));
        own.collect()
    };
    text += &format!("*SURFACE, NAME={name}_FOOT\n{}", faces(0, "S1"));
    text += &format!("*SURFACE, NAME={name}_TOP\n{}", faces(ny - 1, "S3"));
    let after = [node + (nx + 1) * (ny + 1), element + nx * ny];
    (text, after)
}

impl Pile {
    fn run(&self) -> (Keep, Option<stickslip::dynamics::Failure>) {
        let [l, s] = self.units;
        let (mut text, mut after) = grid("B0", [10, 2], [0.0, 0.0, 5.0 * l, l], [0, 0]);
        for k in 1..=self.blocks {
            let (of_block, far) = (self.along + 1 - k, k as f64);
            let x = 1.2 + 0.3 * far + self.off * far;
            let place = [x, far, 2.6 - 0.6 * far, 1.0].map(|v| v * l);
            let (block, next) = grid(&format!("B{k}"), [of_block, 2], place, after);
            text += &block;
            after = next;
        }
        let ground: Vec<String> = (1..=11).map(|node| node.to_string()).collect();
        text += &format!("*NSET, NSET=GROUND\n{}\n", ground.join(", "));
        text += &format!(
            "*MATERIAL, NAME=M\n*ELASTIC\n{:?}, 0.3\n*DENSITY\n{:?}\n",
            1e3 * s,
            s / l
        );
        text += &format!(
            "*SURFACE INTERACTION, NAME=DRY\n*FRICTION\n{:?}\n",
            self.friction
        );
        let form = if self.from_surface {
            ", TYPE=SURFACE TO SURFACE"
        } else {
            ""
        };
        for k in 0..=self.blocks {
            text += &format!("*SOLID SECTION, ELSET=B{k}, MATERIAL=M\n");
        }
        for k in 1..=self.blocks {
            text += &format!(
                "*CONTACT PAIR, INTERACTION=DRY{form}\nB{k}_FOOT, B{}_TOP\n",
                k - 1
            );
        }
        text += "*BOUNDARY\nGROUND, 1, 2\n*STEP, NLGEOM\n*STATIC\n1., 1.\n*DLOAD\n";
        let (sin, cos) = self.slope.sin_cos();
        for k in 0..=self.blocks {
            text += &format!("B{k}, GRAV, 9.81, {sin:?}, {:?}\n", -cos);
        }
        run_deck(&(text + "*END STEP\n"))
    }

    /// Largest force that holds a block, beside its normal forces, and passes of the last increment.
    fn held(&self) -> (f64, usize) {
        let (keep, failure) = self.run();
        assert_eq!(failure, None);
        let last = keep.reports.last().expect("reports");
        assert_eq!(last.time, 1.0);
        // RF and the loads are in balance, the held force among the former
        let [l, s] = self.units;
        let volume: f64 = 5.0 + (1..=self.blocks).map(|k| 2.6 - 0.6 * k as f64).sum::<f64>();
        let weight = 9.81 * volume * s * l;
        let sum = |i: usize| last.nodal.reaction.iter().skip(i).step_by(2).sum::<f64>();
        assert!(sum(0).abs() < 1e-9 * weight, "{} {weight}", sum(0));
        assert!(
            (sum(1) - weight).abs() < 1e-9 * weight,
            "{} {weight}",
            sum(1)
        );
        assert!(last.energy.balance.abs() < 1e-9 * last.energy.external_work);
        assert_eq!(last.held.is_some(), last.solver.held > 0.0);
        // and no block has gone anywhere: a compression of a percent moves a node by less than this
        let most = last
            .state
            .u
            .iter()
            .step_by(2)
            .fold(0.0, |m: f64, u| m.max(u.abs()));
        assert!(most < 0.03 * l, "{most}");
        (last.solver.held, last.solver.passes)
    }
}

#[test]
fn blocks_on_an_elastic_floor_without_friction_stay_where_they_are() {
    for from_surface in [false, true] {
        for (along, off, blocks) in [
            (4, 0.0, 1),
            (4, 0.1, 1),
            (5, 0.37, 1),
            (4, 0.1, 2),
            (5, 0.0, 2),
        ] {
            let pile = Pile {
                along,
                off,
                blocks,
                from_surface,
                ..PILE
            };
            let (held, passes) = pile.held();
            assert!(
                held < 3e-3 && passes <= 6,
                "{from_surface} {along} {off} {blocks}: {held} {passes}"
            );
        }
    }
}

#[test]
fn what_holds_a_block_is_the_same_in_other_units_and_nothing_with_friction() {
    for from_surface in [false, true] {
        let pile = Pile {
            from_surface,
            ..PILE
        };
        let (held, _) = pile.held();
        assert!(held > 1e-5);
        for units in [[1e-3, 1.0], [1.0, 1e6], [1e3, 1e-6]] {
            let (other, _) = Pile { units, ..pile }.held();
            assert!(
                (other - held).abs() < 1e-6 * held,
                "{units:?}: {other} {held}"
            );
        }
        assert_eq!(
            Pile {
                friction: 0.3,
                ..pile
            }
            .held()
            .0,
            0.0
        );
    }
}

#[test]
fn a_block_slides_off_an_elastic_floor_that_slopes_ever_so_little() {
    for slope in [1e-2, 1e-5] {
        let (_, failure) = Pile { slope, ..PILE }.run();
        let failure = failure.expect("it slides");
        assert!(
            matches!(failure.cause, Cause::Unbalanceable(_)),
            "{}",
            failure.cause
        );
    }
}

/// A disc of 8 by 8 elements, turned by an angle, between two elastic plates, the upper of which is pressed down.
fn disc_between_plates(angle: f64, from_surface: bool) -> String {
    let (mut text, after) = grid("LOW", [12, 3], [-2.0, -2.0, 4.0, 1.0], [0, 0]);
    let (upper, [node, element]) = grid("UP", [10, 3], [-2.0, 1.0, 4.0, 1.0], after);
    text += &upper;
    let number = |i: usize, j: usize| node + 1 + 9 * j + i;
    let (sin, cos) = f64::sin_cos(angle);
    text += "*NODE\n";
    for (j, i) in (0..=8).flat_map(|j| (0..=8).map(move |i| (j, i))) {
        // squares become circles towards the outline
        let [u, v] = [i, j].map(|k| k as f64 / 4.0 - 1.0);
        let (square, round) = (u.abs().max(v.abs()), u.hypot(v));
        let part = if round > 0.0 {
            1.0 - square + square * square / round
        } else {
            1.0
        };
        let [x, y] = [part * (cos * u - sin * v), part * (sin * u + cos * v)];
        text += &format!("{}, {x:?}, {y:?}\n", number(i, j));
    }
    text += "*ELEMENT, TYPE=CPE4, ELSET=DISC\n";
    for (j, i) in (0..8).flat_map(|j| (0..8).map(move |i| (j, i))) {
        let [a, b, c, d] =
            [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| number(i, j));
        text += &format!("{}, {a}, {b}, {c}, {d}\n", element + 1 + 8 * j + i);
    }
    let numbers = |nodes: std::ops::Range<usize>| {
        let all: Vec<String> = nodes.map(|node| node.to_string()).collect();
        all.join(", ")
    };
    let (held, head) = (numbers(1..14), numbers(52 + 34..52 + 45));
    let form = if from_surface {
        ", TYPE=SURFACE TO SURFACE"
    } else {
        ""
    };
    text += &format!(
        "*NSET, NSET=HELD\n{held}\n*NSET, NSET=HEAD\n{head}\n*SURFACE, NAME=SKIN\nDISC\n\
         *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=DISC, MATERIAL=M\n\
         *SOLID SECTION, ELSET=LOW, MATERIAL=M\n*SOLID SECTION, ELSET=UP, MATERIAL=M\n\
         *SURFACE INTERACTION, NAME=DRY\n*FRICTION\n0.0\n*CONTACT PAIR, INTERACTION=DRY{form}\nSKIN, LOW_TOP\n\
         *CONTACT PAIR, INTERACTION=DRY{form}\nSKIN, UP_FOOT\n*BOUNDARY\nHELD, 1, 2\nHEAD, 1, 1\n\
         *STEP, NLGEOM\n*STATIC\n1., 1.\n*BOUNDARY\nHEAD, 2, 2, -0.06\n*END STEP\n"
    );
    text
}

#[test]
fn a_disc_without_friction_stays_between_the_plates_that_press_it() {
    for from_surface in [false, true] {
        for angle in [0.0, 0.1, std::f64::consts::PI / 16.0] {
            let (keep, failure) = run_deck(&disc_between_plates(angle, from_surface));
            assert_eq!(failure, None, "{angle} {from_surface}");
            let last = keep.reports.last().expect("reports");
            let [below, above] = [0, 1].map(|k| last.contacts[k].force[1].abs());
            // what holds the disc has a vertical part where plates tilt, or touch it off its middle
            let vertical = last.held.as_ref().map_or(0.0, |held| held.force[1].abs());
            let difference = (below - above).abs();
            assert!(below > 0.1 && difference < 1e-3 * below, "{below} {above}");
            assert!(
                (difference - vertical).abs() < 1e-9 * below,
                "{below} {above} {vertical}"
            );
            // the force of a plate is at most half a side off the middle
            assert!(last.solver.held < 0.12, "{}", last.solver.held);
        }
    }
}

#[test]
fn a_block_on_one_that_sinks_in_more_at_one_side_slides_off() {
    let pile = Pile {
        off: 0.37,
        blocks: 2,
        from_surface: true,
        ..PILE
    };
    let (_, failure) = pile.run();
    let failure = failure.expect("it slides");
    assert!(
        matches!(failure.cause, Cause::Unbalanceable(_)),
        "{}",
        failure.cause
    );
}

/// A block on an elastic floor, off its middle, whose top moves down with that of a post beside it by equations.
fn block_with_a_post() -> String {
    let (mut text, after) = grid("LOW", [10, 2], [0.0, 0.0, 5.0, 1.0], [0, 0]);
    let (block, next) = grid("BLOCK", [4, 2], [1.7, 1.0, 2.0, 1.0], after);
    let (post, _) = grid("POST", [2, 4], [6.0, 0.0, 1.0, 2.0], next);
    text += &block;
    text += &post;
    let set = |nodes: std::ops::RangeInclusive<usize>| {
        let all: Vec<String> = nodes.map(|node| node.to_string()).collect();
        all.join(", ")
    };
    let foot = next[0] + 1;
    for node in after[0] + 11..=after[0] + 15 {
        text += &format!("*EQUATION\n2\n{node}, 2, 1.0, {}, 2, -1.0\n", foot + 12);
    }
    text += &format!(
        "*NSET, NSET=GROUND\n{}\n*NSET, NSET=FOOT\n{}\n",
        set(1..=11),
        set(foot..=foot + 2)
    );
    text += "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n";
    for name in ["LOW", "BLOCK", "POST"] {
        text += &format!("*SOLID SECTION, ELSET={name}, MATERIAL=M\n");
    }
    text + "*SURFACE INTERACTION, NAME=DRY\n*FRICTION\n0.0\n*CONTACT PAIR, INTERACTION=DRY\nBLOCK_FOOT, LOW_TOP\n\
           *BOUNDARY\nGROUND, 1, 2\nFOOT, 1, 2\n*STEP, NLGEOM\n*STATIC\n1., 1.\n*DLOAD\n\
           BLOCK, GRAV, 9.81, 0.0, -1.0\n*END STEP\n"
}

#[test]
fn what_equations_join_to_held_parts_is_held_where_they_leave_it_free() {
    let (keep, failure) = run_deck(&block_with_a_post());
    assert_eq!(failure, None);
    let last = keep.reports.last().expect("reports");
    assert!(last.solver.passes <= 6, "{}", last.solver.passes);
    assert!(last.solver.held < 3e-3, "{}", last.solver.held);
    let sum = |i: usize| last.nodal.reaction.iter().skip(i).step_by(2).sum::<f64>();
    let weight = 9.81 * 2.0;
    assert!(sum(0).abs() < 1e-9 * weight, "{}", sum(0));
    assert!(
        (sum(1) - weight).abs() < 1e-9 * weight,
        "{} {weight}",
        sum(1)
    );
}
