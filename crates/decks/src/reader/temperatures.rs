//! `*TEMPERATURE` and `*INITIAL CONDITIONS, TYPE=TEMPERATURE`: temperatures of nodes, as they are carried from step to step.

use std::collections::BTreeMap;

use super::boundary::Targets;
use super::context::Context;
use super::loads::{CarriedLoad, Operation, StepContext};
use super::materials::MaterialPlaces;
use super::outline::Outline;
use crate::deck::{Card, Line};
use crate::diagnostics::Code;
use crate::model::{Amplitude, Load, Material, Model, NodeTemperature, Variation};

/// Reads initial temperatures, one for every node; empty if the deck gives no initial temperatures.
pub(super) fn initial(outline: &Outline, targets: Targets, cx: &mut Context) -> Vec<f64> {
    let mut all = Vec::new();
    for card in outline.model_cards("INITIAL CONDITIONS") {
        if card.choice("TYPE") != Some("TEMPERATURE") {
            continue;
        }
        all.resize(targets.mesh_index.mesh.node_count(), 0.0);
        for row in card.rows.iter() {
            let Some((nodes, value)) = row_of_nodes(row, targets, cx) else {
                continue;
            };
            for node in nodes {
                all[node] = value;
            }
        }
    }
    all
}

/// Number of gradients that may follow the temperature in a row of shells and beams.
const GRADIENTS: usize = 4;

/// Reads a row `node or node set, temperature`; further fields, which are gradients of shells and beams, must be zero.
fn row_of_nodes(row: Line, targets: Targets, cx: &mut Context) -> Option<(Vec<usize>, f64)> {
    let Targets {
        mesh_index, sets, ..
    } = targets;
    let target = row.required(0, "a node or node set", cx.d);
    let nodes = target.map(|field| sets.nodes_of(field, mesh_index, cx));
    let value = row.real(1, "the temperature", cx.d);
    row.at_most(2 + GRADIENTS, cx.d);
    for index in 2..2 + GRADIENTS {
        if row.real_or(index, 0.0, cx.d)? != 0.0 {
            let message = "plane elements have one temperature, without gradients across them";
            cx.error(Code::StrayData, row.span_at(index), message);
            return None;
        }
    }
    Some((nodes?, value?))
}

/// Temperatures that differ from the initial temperatures, by node.
#[derive(Default)]
pub(super) struct TemperatureHistory {
    initial: Vec<f64>,
    all: BTreeMap<usize, CarriedLoad<NodeTemperature>>,
    operation: Operation,
}

impl TemperatureHistory {
    /// The temperatures at the start of the analysis.
    pub fn new(initial: Vec<f64>) -> Self {
        TemperatureHistory {
            initial,
            ..TemperatureHistory::default()
        }
    }

    fn initial_of(&self, node: usize) -> f64 {
        self.initial.get(node).copied().unwrap_or_default()
    }

    /// Reads `*TEMPERATURE`.
    pub fn card(&mut self, card: &Card, context: StepContext, targets: Targets, cx: &mut Context) {
        if self.operation.starts_anew(card, context.step, cx) {
            self.clear(context);
        }
        let Ok(amplitude) = targets.amplitudes.of(card, cx) else {
            return;
        };
        for row in card.rows.iter() {
            let Some((nodes, value)) = row_of_nodes(row, targets, cx) else {
                continue;
            };
            for node in nodes {
                let from = match self.all.get(&node) {
                    Some(before) => before.reached(context),
                    None => self.initial_of(node),
                };
                let at = NodeTemperature { node };
                let load = CarriedLoad::new(at, value, amplitude, context);
                self.all.insert(node, load.rising_from(from));
            }
        }
    }

    /// Lets all nodes return to their initial temperatures: over the step if temperatures ramp, else at once.
    fn clear(&mut self, context: StepContext) {
        if !context.ramp {
            return self.all.clear();
        }
        let initial = std::mem::take(&mut self.initial);
        for (&node, load) in &mut self.all {
            let to = initial.get(node).copied().unwrap_or_default();
            let from = load.reached(context);
            let returning = CarriedLoad::new(NodeTemperature { node }, to, None, context);
            *load = returning.rising_from(from);
        }
        self.initial = initial;
    }

    /// Temperatures of the current step.
    pub fn list(&self) -> Vec<Load<NodeTemperature>> {
        let simple = |load: &CarriedLoad<NodeTemperature>| load.simple();
        self.all.values().map(simple).collect()
    }

    /// Ends a step: temperatures keep their last values, unless they follow an amplitude in total time.
    pub fn end_step(&mut self, period: f64, total: f64, amplitudes: &[Amplitude]) {
        for load in self.all.values_mut() {
            load.end_step(period, total, amplitudes);
        }
        let initial = std::mem::take(&mut self.initial);
        self.all.retain(|&node, load| {
            let at_start = initial.get(node).copied().unwrap_or_default();
            load.simple().ends() != Some([at_start; 2])
        });
        self.initial = initial;
    }
}

/// The temperatures that a step hands on to the next step.
pub(crate) fn carried_temperatures(
    loads: &[Load<NodeTemperature>],
    initial: &[f64],
    period: f64,
    amplitudes: &[Amplitude],
) -> Vec<Load<NodeTemperature>> {
    let mut history = TemperatureHistory::new(initial.to_vec());
    let all = loads
        .iter()
        .map(|load| (load.at.node, CarriedLoad::of(load)));
    history.all = all.collect();
    history.end_step(period, 0.0, amplitudes);
    history.list()
}

/// Checks that thermal strains stay above -1 in every material, and that at least one material in use expands.
pub(super) fn check(model: &Model, places: &[MaterialPlaces], outline: &Outline, cx: &mut Context) {
    let first = (outline.model_cards("INITIAL CONDITIONS").iter())
        .find(|card| card.choice("TYPE") == Some("TEMPERATURE"))
        .map(|card| card.span);
    let in_steps = outline.steps.iter().flat_map(|step| &step.cards);
    let in_steps = in_steps.filter(|card| card.keyword.name == "TEMPERATURE");
    let Some(span) = in_steps.map(|card| card.span).next().or(first) else {
        return;
    };
    let used = |index: &usize| {
        model
            .sections
            .iter()
            .any(|section| section.material == *index)
    };
    let used: Vec<usize> = (0..model.materials.len()).filter(used).collect();
    let expanding = used
        .iter()
        .filter(|&&index| model.materials[index].expansion.is_some());
    if expanding.clone().next().is_none() && !used.is_empty() {
        let message = "the temperatures have no effect: no material in use has *EXPANSION";
        cx.d.warning_once(Code::IgnoredParameter, span, message)
            .help("give *EXPANSION under *MATERIAL");
        return;
    }
    for &index in expanding {
        let material = &model.materials[index];
        if let Some((strain, temperature)) = least_strain(material, model)
            && strain <= -1.0
        {
            let message = format!(
                "material {} has a thermal strain of {strain:.3} at the temperature {temperature}",
                material.name
            );
            cx.error(Code::MaterialRange, places[index].material, message)
                .help("nothing is left of a body at a strain of -1: check ALPHA and the units of the temperature");
        }
    }
}

/// Smallest thermal strain that a material may reach in a model, and the temperature of this strain.
fn least_strain(material: &Material, model: &Model) -> Option<(f64, f64)> {
    let expansion = material.expansion.as_ref()?;
    let mut least: Option<(f64, f64)> = None;
    let loads = model.steps.iter().flat_map(|step| &step.temperatures);
    for load in loads {
        let values = match load.variation {
            Variation::Constant => [load.magnitude; 2],
            Variation::Ramp { from } => [from, load.magnitude],
            Variation::Amplitude(index) => model.amplitudes[index]
                .bounds()
                .map(|value| value * load.magnitude),
        };
        let initial = model.initial_temperature_of(load.at.node);
        for temperature in values {
            let strain = expansion.strain(initial, temperature);
            if least.is_none_or(|(known, _)| strain < known) {
                least = Some((strain, temperature));
            }
        }
    }
    least
}
