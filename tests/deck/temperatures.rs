//! `*EXPANSION` and `*TEMPERATURE`: what steps carry on, and what is said of temperatures.

use stickslip::model::{Load, Model, NodeTemperature, Variation};

use crate::flat::round_trip;
use crate::reading::{read, try_read};

const SQUARE: &str = include_str!("../decks/square.inp");

/// The square of a material that expands, with cards of the model and of steps in place of its step.
fn deck(material: &str, model: &str, steps: &str) -> String {
    let (head, _) = SQUARE.split_once("*STEP").expect("a step");
    let head = head.replacen("*DENSITY", &format!("{material}*DENSITY"), 1);
    format!("{head}{model}{steps}")
}

const EXPANSION: &str = "*EXPANSION, ZERO=20.\n1.E-5, 20.\n2.E-5, 120.\n";
const START: &str = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\n1, 20.\n2, 30.\n";

fn step(head: &str, procedure: &str, cards: &str) -> String {
    format!("*STEP, NLGEOM{head}\n*{procedure}\n0.1, 1.\n{cards}*END STEP\n")
}

/// Node, magnitude and variation of the temperatures of a step.
fn temperatures(model: &Model, step: usize) -> Vec<(usize, f64, Variation)> {
    let all = model.steps[step].temperatures.iter();
    let of = |load: &Load<NodeTemperature>| (load.at.node, load.magnitude, load.variation);
    all.map(of).collect()
}

#[test]
fn temperatures_ramp_from_those_of_the_step_before_and_return_to_the_start() {
    let steps = [
        step("", "STATIC", "*TEMPERATURE\n1, 70.\n3, 50.\n"),
        step("", "STATIC", "*TEMPERATURE\n1, 90.\n"),
        step("", "STATIC", "*TEMPERATURE, OP=NEW\n3, 10.\n"),
        step("", "DYNAMIC, DIRECT", "*TEMPERATURE, OP=NEW\n2, 5.\n"),
    ];
    let model = read(&deck(EXPANSION, START, &steps.concat()));
    let from = |from: f64| Variation::Ramp { from };
    assert_eq!(model.initial_temperature[..3], [20.0, 30.0, 0.0]);
    let expected = [
        vec![(0, 70.0, from(20.0)), (2, 50.0, from(0.0))],
        vec![(0, 90.0, from(70.0)), (2, 50.0, Variation::Constant)],
        vec![(0, 20.0, from(90.0)), (2, 10.0, from(50.0))],
        vec![(1, 5.0, Variation::Constant)],
    ];
    for (k, expected) in expected.iter().enumerate() {
        assert_eq!(temperatures(&model, k), *expected, "step {}", k + 1);
    }
    round_trip(model);
}

#[test]
fn an_amplitude_multiplies_a_temperature() {
    let amplitude = "*AMPLITUDE, NAME=A\n0., 0.5, 1., 2.\n";
    let steps = [
        step("", "STATIC", "*TEMPERATURE, AMPLITUDE=A\n1, 40.\n"),
        step("", "STATIC", ""),
    ];
    let model = read(&deck(
        EXPANSION,
        &format!("{START}{amplitude}"),
        &steps.concat(),
    ));
    assert_eq!(
        temperatures(&model, 0),
        [(0, 40.0, Variation::Amplitude(0))]
    );
    // the value at the end of the step stays
    assert_eq!(temperatures(&model, 1), [(0, 80.0, Variation::Constant)]);
    round_trip(model);
}

#[test]
fn what_is_wrong_of_temperatures_is_said() {
    let heat = step("", "STATIC", "*TEMPERATURE\n1, 70.\n");
    let cold = step("", "STATIC", "*TEMPERATURE\n1, -200000.\n");
    let shells = step("", "STATIC", "*TEMPERATURE\n1, 70., 3.\n");
    for (material, steps, said) in [
        ("", &heat, "no material in use has *EXPANSION"),
        (
            "*EXPANSION\n1.E-5, 20.\n2.E-5, 20.\n",
            &heat,
            "temperatures must grow from row to row",
        ),
        (
            "*EXPANSION\n1.E-5\n",
            &cold,
            "has a thermal strain of -2.000",
        ),
        (
            "*EXPANSION, TYPE=ORTHO\n1.E-5\n",
            &heat,
            "only isotropic expansion is supported",
        ),
        (
            "*EXPANSION\n1.E-5\n",
            &shells,
            "without gradients across them",
        ),
    ] {
        let (_, _, text) = try_read(&deck(material, START, steps));
        assert!(text.contains(said), "{said}: {text}");
    }
}
