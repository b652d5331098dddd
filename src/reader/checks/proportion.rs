//! Increment and duration of the steps against the time that waves take.

use crate::diagnostics::{Code, Diagnostic};
use crate::model::{Element, Mesh, Plane, Step};
use crate::reader::context::Context;
use crate::reader::materials::Properties;
use crate::reader::mesh::StepCards;

/// Sides that waves cross in one increment, above which the increment cannot be meant: implicit
/// increments of slow motions reach some thousands.
const MOST_SIDES: f64 = 1e6;

/// The shortest side of an element, and the shortest time in which a wave crosses a side.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shortest {
    /// Length; infinite without elements.
    pub side: f64,
    /// Time; none without a material.
    pub time: Option<f64>,
}

/// The shortest side, and the shortest time in which a wave crosses one.
pub(crate) fn shortest(mesh: &Mesh, properties: &Properties) -> Shortest {
    // elements of a section in plane stress and in plane strain; at last those without section
    let planes = [Plane::Stress, Plane::Strain];
    let last = planes.len() * properties.sections.len();
    let group = |index: usize, element: &Element| {
        let section = properties.section_of(index);
        section
            .map_or(last, |s| {
                planes.len() * s + element.element_type.plane as usize
            })
            .min(last)
    };
    let sides = mesh.shortest_sides(last + 1, group);
    let speeds = properties.sections.iter().flat_map(|section| {
        let material = properties.materials.get(section.material);
        planes.map(|plane| material.map(|material| material.wave_speed(plane)))
    });
    let times = sides.iter().zip(speeds);
    let times = times.filter_map(|(side, speed)| Some(side / speed?));
    let time = times.reduce(f64::min);
    Shortest {
        side: sides.iter().copied().fold(f64::INFINITY, f64::min),
        time: time.filter(|time| time.is_finite() && *time > 0.0),
    }
}

/// Warns about steps that end before a wave has crossed the shortest side of an element, and about
/// increments in which it crosses more than a million of them; `guide` is the [`shortest`] time.
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
