//! No text makes the reader panic, and every model reads as the same from its flat deck: mutations of
//! valid decks and plain noise.

use proptest::prelude::*;
use stickslip::diagnostics::{Diagnostics, Sources, Strictness};
use stickslip::flat_deck::{difference, flat_deck};
use stickslip::model::{Curve, Increments, Model, Set, Step, Variation};
use stickslip::{deck, reader};

const SQUARE: &str = include_str!("../decks/square.inp");
const SHARED: &str = include_str!("../decks/shared.inp");
const EXPORTED: &str = include_str!("../decks/exported.inp");
const BLOCKS: &str = include_str!("../decks/cae_blocks.inp");
const STEPS: &str = include_str!("../decks/steps.inp");

/// One way to spoil a deck; numbers are taken modulo its size.
#[derive(Debug, Clone)]
enum Mutation {
    Delete(usize, usize),
    Insert(usize, String),
    Replace(usize, char),
    SwapLines(usize, usize),
    RepeatLine(usize, usize),
    DeleteLine(usize),
    Truncate(usize),
}

fn mutation() -> impl Strategy<Value = Mutation> {
    use Mutation::*;
    let at = || any::<usize>();
    prop_oneof![
        (at(), 1..12usize).prop_map(|(a, n)| Delete(a, n)),
        (at(), "[*,=\" 0-9.eD+-]{1,6}|\\PC{1,4}").prop_map(|(a, text)| Insert(a, text)),
        (at(), any::<char>()).prop_map(|(a, c)| Replace(a, c)),
        (at(), at()).prop_map(|(a, b)| SwapLines(a, b)),
        (at(), at()).prop_map(|(a, b)| RepeatLine(a, b)),
        at().prop_map(DeleteLine),
        at().prop_map(Truncate),
    ]
}

fn apply(text: &str, mutation: &Mutation) -> String {
    let mut characters: Vec<char> = text.chars().collect();
    let mut lines: Vec<&str> = text.split('\n').collect();
    let (c, l) = (characters.len().max(1), lines.len());
    match mutation {
        Mutation::Delete(at, count) => {
            let start = (at % c).min(characters.len());
            let end = (start + count).min(characters.len());
            characters.drain(start..end);
        }
        Mutation::Insert(at, more) => {
            let at = (at % c).min(characters.len());
            characters.splice(at..at, more.chars());
        }
        Mutation::Replace(at, with) => {
            if let Some(place) = characters.get_mut(at % c) {
                *place = *with;
            }
        }
        Mutation::Truncate(at) => characters.truncate(at % c),
        Mutation::SwapLines(a, b) => lines.swap(a % l, b % l),
        Mutation::RepeatLine(a, b) => lines.insert(a % l, lines[b % l]),
        Mutation::DeleteLine(a) => drop(lines.remove(a % l)),
    }
    match mutation {
        Mutation::SwapLines(..) | Mutation::RepeatLine(..) | Mutation::DeleteLine(..) => {
            lines.join("\n")
        }
        _ => characters.into_iter().collect(),
    }
}

/// Reads a text and renders all messages; a model must be whole.
fn survive(text: &str) {
    for strictness in [Strictness::Normal, Strictness::Lenient] {
        let (mut sources, mut d) = (Sources::new(), Diagnostics::with_strictness(strictness));
        let deck = deck::parse_str("deck.inp", text, &mut sources, &mut d);
        let model = reader::build(&deck, &mut d);
        let messages = d.render(&sources, false);
        assert_eq!(model.is_some(), !d.has_errors(), "{messages}");
        if let Some(model) = model {
            check(&model);
            let flat = flat_deck(&model);
            assert!(
                ramps(&model) || difference(&flat, &model).is_none(),
                "not the same model:\n{flat}"
            );
        }
    }
}

/// Whether loads ramp: a flat deck cannot tell apart several at one place, one of which fades.
fn ramps(model: &Model) -> bool {
    let ramps = |variation: &Variation| matches!(variation, Variation::Ramp { .. });
    model.steps.iter().any(|step| {
        let points = step.point_loads.iter().map(|load| &load.variation);
        let bodies = step.body_forces.iter().map(|load| &load.variation);
        let pressures = step.pressures.iter().map(|load| &load.variation);
        let tractions = step.tractions.iter().map(|load| &load.variation);
        let mut all = points.chain(bodies).chain(pressures).chain(tractions);
        all.any(ramps)
    })
}

/// Every index of a model must exist, every number be in its range.
fn check(model: &Model) {
    let (nodes, elements) = (model.mesh.node_count(), model.mesh.elements.len());
    assert!(nodes > 0 && elements > 0 && !model.steps.is_empty());
    assert_eq!(model.mesh.node_labels.len(), nodes);
    assert_eq!(model.initial_velocity.len(), 2 * nodes);
    for element in &model.mesh.elements {
        assert!(element.nodes.iter().all(|&n| n < nodes));
        let section = &model.sections[element.section];
        let material = &model.materials[section.material];
        assert!(section.thickness > 0.0 && material.density > 0.0);
        assert!(material.law.small_strain().young > 0.0);
    }
    let whole = |sets: &[Set], count| sets.iter().all(|s| s.members.iter().all(|&m| m < count));
    assert!(whole(&model.sets.nodes, nodes) && whole(&model.sets.elements, elements));
    assert!(
        model
            .sets
            .history
            .iter()
            .all(|asked| asked.set < model.sets.nodes.len())
    );
    for surface in &model.surfaces {
        assert!(surface.nodes(&model.mesh).iter().all(|&n| n < nodes));
    }
    for contact in &model.contacts {
        assert!(
            !model.surfaces[contact.master]
                .segments(&model.mesh)
                .is_empty()
        );
        assert!(!model.surfaces[contact.slave].nodes(&model.mesh).is_empty());
        assert!(contact.interaction.friction.at_rest(0.0) >= 0.0);
    }
    for amplitude in &model.amplitudes {
        if let Curve::Linear(points) | Curve::SmoothStep(points) = &amplitude.curve {
            assert!(!points.is_empty());
            assert!(points.windows(2).all(|pair| pair[0].0 < pair[1].0));
        }
    }
    model.steps.iter().for_each(|step| check_step(step, model));
}

fn check_step(step: &Step, model: &Model) {
    let dofs = model.mesh.dof_count();
    let Increments { dt, period, .. } = step.increments;
    assert!(dt > 0.0 && dt <= period && period.is_finite());
    assert!(
        step.supports
            .windows(2)
            .all(|pair| pair[0].dof < pair[1].dof)
    );
    assert!(step.supports.iter().all(|support| support.dof < dofs));
    assert!(step.point_loads.iter().all(|load| load.at.dof < dofs));
    for body in &step.body_forces {
        assert!(body.at.element < model.mesh.elements.len());
        assert!((body.at.direction[0].hypot(body.at.direction[1]) - 1.0).abs() < 1e-12);
        if let Variation::Amplitude(index) = body.variation {
            assert!(index < model.amplitudes.len());
        }
    }
    for pressure in &step.pressures {
        pressure.at.face.nodes(&model.mesh);
    }
}

#[test]
fn a_deck_of_which_nothing_is_left_is_an_error() {
    survive("*NONSENSE\n1, 2\n");
    survive("*Nonsense\n*Part, name=Block\n*Node\n1, 0., 0.\n*End Part\n");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn spoiled_decks(
        deck in prop_oneof![Just(SQUARE), Just(SHARED), Just(STEPS), Just(EXPORTED), Just(BLOCKS)],
        mutations in prop::collection::vec(mutation(), 1..12),
    ) {
        let spoiled = mutations.iter().fold(deck.to_string(), |text, m| apply(&text, m));
        survive(&spoiled);
    }

    #[test]
    fn noise(text in "(\\*?[A-Z, =*\"0-9.\\n\t]{0,20}|\\PC{0,10}|\r\n|\\*NODE\n|\\*ELEMENT, TYPE=CPS3\n|\\*STEP\n){0,30}") {
        survive(&text);
    }
}
