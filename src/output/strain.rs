//! The largest principal strain of a run, compared with the range of the material law.

use super::format::{general, scientific};
use crate::archive::{Archive, ArchiveError, transfer_fields};
use crate::dynamics::IncrementReport;
use crate::elements::Strained;
use crate::materials::NeoHooke;

use crate::model::Model;

/// Principal strain above which a St. Venant-Kirchhoff material is inaccurate.
pub(crate) const LARGE: f64 = 0.2;

/// Text on why an element of a material for large strains may turn inside out.
const CRUSHED: [&str; 2] = [
    "         the element was crushed or distorted too far: use smaller loads, or",
    "         a mesh whose elements keep a better shape there",
];

/// Likely reasons for an element that turned inside out.
pub(crate) fn inversion_hint(element: usize, model: &Model) -> Vec<String> {
    if !model.is_for_small_strains(element) {
        return CRUSHED.map(str::to_owned).into();
    }
    let material = &model.materials[model.sections[model.mesh.elements[element].section].material];
    let NeoHooke { c10, d1 } = NeoHooke::of_small_strain(material.law.small_strain());
    let (c10, d1) = (general(c10, 4), general(d1, 4));
    vec![
        "material St. Venant-Kirchhoff gives way at 58 % of its length (strain -1/3):".to_owned(),
        "         beyond that shorter increments do not help; use smaller loads, or a".to_owned(),
        "         material for large strains with the same constants: *ELASTIC,".to_owned(),
        "         TYPE=HENCKY (near Abaqus' law) or *ELASTIC, TYPE=NEO HOOKE (rubber),".to_owned(),
        format!("         which is *HYPERELASTIC, NEO HOOKE with {c10}, {d1}"),
    ]
}

/// The elements whose law is meant for small strains.
#[derive(Debug, Clone, Default)]
pub(crate) struct SmallStrainElements(Vec<usize>);

impl SmallStrainElements {
    /// The elements of a model whose law is meant for small strains.
    pub fn new(model: &Model) -> Self {
        let all = 0..model.mesh.elements.len();
        let is_limited = |&element: &usize| model.is_for_small_strains(element);
        SmallStrainElements(all.filter(is_limited).collect())
    }

    /// The first of these elements with the largest principal strain; strain 0 if there are no such elements.
    pub fn most_strained(&self, report: &IncrementReport) -> Strained {
        let mut most = Strained::default();
        for &element in &self.0 {
            let strain = (report.elements.get(element)).map_or(0.0, |found| found.principal_strain);
            if strain > most.strain {
                most = Strained { element, strain };
            }
        }
        most
    }
}

/// Follows the largest principal strain.
#[derive(Debug, Clone, Default)]
pub(crate) struct StrainWatch {
    limited: SmallStrainElements,
    most: Strained,
    /// Number of the increment with the largest strain.
    increment: usize,
    warned: bool,
}

impl StrainWatch {
    /// Transfers the largest strain so far.
    pub fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        transfer_fields!(archive, self => StrainWatch { most, increment, warned; limited })
    }

    /// Follows the elements of `model`.
    pub fn new(model: &Model) -> Self {
        StrainWatch {
            limited: SmallStrainElements::new(model),
            ..StrainWatch::default()
        }
    }

    /// Enters an increment; returns its most strained element with a law for small strains if it is the
    /// first beyond the range of that law.
    pub fn add(&mut self, report: &IncrementReport) -> Option<Strained> {
        let now = report.strain;
        if now.strain > self.most.strain {
            (self.most, self.increment) = (now, report.increment);
        }
        if self.warned || now.strain <= LARGE {
            return None;
        }
        let limited = self.limited.most_strained(report);
        self.warned = limited.strain > LARGE;
        self.warned.then_some(limited)
    }

    /// The largest strain of the run as text.
    pub fn line(&self, model: &Model) -> String {
        let strain = scientific(self.most.strain, 2);
        match self.increment {
            0 => format!("strain   largest principal {strain}"),
            increment => format!(
                "strain   largest principal {strain} in element {} in increment {increment}",
                model.element_name(self.most.element)
            ),
        }
    }
}

/// The warning at the first increment beyond the range of the material.
pub(crate) fn warning_lines(
    Strained { element, strain }: Strained,
    report: &IncrementReport,
    model: &Model,
) -> [String; 5] {
    [
        format!(
            "warning  principal strain {strain:.3} in element {} in increment {}",
            model.element_name(element),
            report.increment
        ),
        "         above 0.2 a St. Venant-Kirchhoff material is too stiff in tension and".to_owned(),
        "         too soft in compression: take its forces for a guess, or use smaller".to_owned(),
        "         loads, or with the same constants a law for large strains: *ELASTIC,".to_owned(),
        "         TYPE=HENCKY (near Abaqus' law) or *ELASTIC, TYPE=NEO HOOKE (rubber)".to_owned(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::ElementResult;
    use crate::materials::{Law, NeoHooke};
    use crate::model::{Element, ElementType};

    /// A model with one elastic element and one of rubber.
    fn model() -> Model {
        let mut model = Model::default();
        let laws = [
            Law::elastic(1.0, 0.3),
            Law::NeoHooke(NeoHooke { c10: 1.0, d1: 0.1 }),
        ];
        for (index, law) in laws.into_iter().enumerate() {
            model.add_section(law, 1.0, 1.0);
            model.mesh.elements.push(Element {
                label: index as u64 + 1,
                element_type: ElementType::CPE4,
                nodes: vec![0, 1, 2, 3].into(),
                section: index,
            });
        }
        model
    }

    fn report(increment: usize, strains: [f64; 2]) -> IncrementReport {
        let element = usize::from(strains[1] > strains[0]);
        let result = |principal_strain| ElementResult {
            principal_strain,
            ..ElementResult::default()
        };
        IncrementReport {
            increment,
            strain: Strained {
                element,
                strain: strains[element],
            },
            elements: strains.map(result).to_vec().into(),
            ..IncrementReport::default()
        }
    }

    #[test]
    fn only_elements_of_a_law_for_small_strains_are_warned_about() {
        let mut watch = StrainWatch::new(&model());
        assert_eq!(watch.add(&report(1, [0.1, 0.9])), None);
        // the rubber is strained more, but the elastic element is beyond its range
        let found = watch.add(&report(2, [0.3, 0.8])).expect("a warning");
        assert_eq!((found.element, found.strain), (0, 0.3));
        assert_eq!(watch.add(&report(3, [0.4, 0.8])), None, "warned once");
        let line = watch.line(&model());
        assert!(
            line.contains("9.00e-01 in element 2 in increment 1"),
            "{line}"
        );
    }

    #[test]
    fn texts_name_the_law_of_the_element() {
        let of = |element| inversion_hint(element, &model()).join("\n");
        for text in ["St. Venant-Kirchhoff", "TYPE=HENCKY", "TYPE=NEO HOOKE"] {
            assert!(of(0).contains(text), "{text}");
        }
        assert!(!of(1).contains("Kirchhoff") && of(1).contains("use smaller loads"));
        let warned = warning_lines(Strained::default(), &report(1, [0.3, 0.0]), &model());
        let text = warned.join("\n");
        assert!(text.contains("TYPE=HENCKY") && text.contains("*ELASTIC, TYPE=NEO HOOKE"));
        let hints = [0, 1].map(|element| inversion_hint(element, &model()));
        let lines = warned.iter().chain(hints.iter().flatten());
        lines.for_each(|line| assert!(line.len() <= 80, "{line}"));
        // mu = 1/2.6, K = 1/1.2
        assert!(of(0).ends_with("with 0.1923, 2.4"), "{}", of(0));
    }
}
