//! Increment and duration of the steps against the time that waves take.

use crate::diagnostics::{Code, Diagnostic};
use crate::model::{Element, Mesh, Step};
use crate::reader::context::Context;
use crate::reader::materials::Properties;
use crate::reader::mesh::StepCards;

/// Sides that waves cross in one increment, above which the increment cannot be meant: implicit
/// increments of slow motions reach some thousands.
const MOST_SIDES: f64 = 1e6;

/// Shortest time in which a wave crosses a side of an element.
pub(crate) fn crossing_time(mesh: &Mesh, properties: &Properties) -> Option<f64> {
    let of_element = |(element, section): (&Element, &Option<usize>)| {
        let material = properties.sections.get((*section)?)?.material;
        let material = properties.materials.get(material)?;
        Some(mesh.shortest_side(element) / material.wave_speed(element.element_type.plane))
    };
    let times = mesh.elements.iter().zip(&properties.section_of);
    let shortest = times.filter_map(of_element).reduce(f64::min)?;
    Some(shortest).filter(|time| time.is_finite() && *time > 0.0)
}

/// Warns about steps that end before a wave has crossed the shortest side of an element, and about
/// increments in which it crosses more than a million of them; `guide` is its [`crossing_time`].
pub(crate) fn proportion(
    steps: &[Step],
    cards: &[StepCards],
    guide: Option<f64>,
    cx: &mut Context,
) {
    let Some(guide) = guide.filter(|_| !cx.d.has_errors()) else {
        return;
    };
    for (step, cards) in steps.iter().zip(cards) {
        let mut procedures = cards.cards.iter();
        let card = procedures.find(|card| card.keyword.name == "DYNAMIC");
        let row = card.and_then(|card| card.rows.first());
        let span = |index: usize| {
            let field = row.and_then(|row| row.get(index));
            field.map_or(cards.head.span, |field| field.span)
        };
        let (dt, period) = (step.increments.dt, step.increments.period);
        let (span, message) = if period < guide {
            let sides = period / guide;
            (
                span(1),
                format!("in this step a wave crosses {sides:.1e} of the shortest element side"),
            )
        } else if dt > MOST_SIDES * guide {
            let sides = dt / guide;
            (
                span(0),
                format!(
                    "in one increment a wave crosses {sides:.1e} times the shortest element side"
                ),
            )
        } else {
            continue;
        };
        let warning = Diagnostic::warning(Code::OutOfProportion, span, message);
        cx.d.push(warning.help(format!(
            "it takes {guide:.2e} for one side: are times, lengths and material in one system of \
             units?"
        )));
    }
}
