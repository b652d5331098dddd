//! The largest principal strain of a run, compared with the range of the material law.

use super::format::scientific;
use crate::dynamics::IncrementReport;
use crate::elements::Strained;
use crate::model::{Element, Model};

/// Principal strain above which a St. Venant-Kirchhoff material is inaccurate.
pub(crate) const LARGE: f64 = 0.2;

/// Why an element may turn inside out.
pub(crate) const LIMIT: [&str; 2] = [
    "material St. Venant-Kirchhoff gives way at 58 % of its length (strain -1/3):",
    "         beyond that shorter increments do not help, smaller loads do",
];

/// Follows the largest principal strain.
#[derive(Debug, Clone, Default)]
pub(crate) struct StrainWatch {
    /// Whether the law of an element is meant for small strains.
    is_limited: Vec<bool>,
    most: Strained,
    /// Number of its increment.
    increment: usize,
    warned: bool,
}

impl StrainWatch {
    /// Follows the elements of `model`.
    pub fn new(model: &Model) -> Self {
        let law =
            |element: &Element| &model.materials[model.sections[element.section].material].law;
        let elements = model.mesh.elements.iter();
        StrainWatch {
            is_limited: elements
                .map(|element| law(element).is_for_small_strains())
                .collect(),
            ..StrainWatch::default()
        }
    }

    /// Enters an increment; returns its most strained element if it is the first beyond the
    /// material's range.
    pub fn add(&mut self, report: &IncrementReport) -> Option<Strained> {
        let now = report.strain;
        if now.strain > self.most.strain {
            (self.most, self.increment) = (now, report.increment);
        }
        let is_first =
            now.strain > LARGE && self.is_limited.get(now.element) == Some(&true) && !self.warned;
        self.warned |= is_first;
        is_first.then_some(now)
    }

    /// The largest strain of the run as text.
    pub fn line(&self, model: &Model) -> String {
        let strain = scientific(self.most.strain, 2);
        match self.increment {
            0 => format!("strain   largest principal {strain}"),
            increment => format!(
                "strain   largest principal {strain} in element {} in increment {increment}",
                model.mesh.elements[self.most.element].label
            ),
        }
    }
}

/// The warning at the first increment beyond the range of the material.
pub(crate) fn warning_lines(
    Strained { element, strain }: Strained,
    report: &IncrementReport,
    model: &Model,
) -> [String; 4] {
    [
        format!(
            "warning  principal strain {strain:.3} in element {} in increment {}",
            model.mesh.elements[element].label, report.increment
        ),
        "         above 0.2 a St. Venant-Kirchhoff material is too stiff in tension and".to_owned(),
        "         too soft in compression: take its forces for a guess,".to_owned(),
        "         or use smaller loads".to_owned(),
    ]
}
