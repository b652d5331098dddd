//! Group `/history/elements`: the element sets that the deck requests.

use hdf5::Group;

use crate::dynamics::IncrementReport;
use crate::elements::{ElementInertia, ElementResult, MeanGradient};
use crate::model::{HistorySet, Model};
use crate::output::file::{
    Column, Columns, ENERGY_DENSITY, LOGARITHMIC_STRAIN, constant, group, growing, meaning,
};

/// A tensor or a scalar of an element.
type Tensor = fn(&ElementResult) -> [f64; 3];
type Scalar = fn(&ElementResult) -> f64;

const TENSORS: [(&str, &str, &str, Tensor); 2] = [
    (
        "S",
        "Cauchy stress xx yy xy, mean over the element",
        "force/length^2",
        |e| e.stress,
    ),
    (
        "E",
        "Green-Lagrange strain xx yy xy (xy: tensor component), mean over the element",
        "1",
        |e| e.strain,
    ),
];

const SCALARS: [(&str, &str, &str, Scalar); 3] = [
    (
        "S33",
        "Cauchy stress across the thickness, mean over the element",
        "force/length^2",
        |e| e.across,
    ),
    (
        "MISES",
        "von Mises stress of the mean stresses",
        "force/length^2",
        ElementResult::von_mises,
    ),
    ("ELSE", "strain energy of the element", "energy", |e| {
        e.energy
    }),
];

/// `/history/elements/<ELSET>`.
pub(crate) struct ElementHistory {
    elements: Vec<usize>,
    inertia: Vec<ElementInertia>,
    /// Values of every element; none where only sums are asked for.
    each: Option<EachElement>,
    strain_energy: Column<f64>,
    kinetic_energy: Column<f64>,
}

/// Values of every element of a set.
struct EachElement {
    tensors: Vec<(Column<f64>, Tensor)>,
    scalars: Vec<(Column<f64>, Scalar)>,
    logarithmic_strain: Column<f64>,
    energy_density: Column<f64>,
    kinetic_energy: Column<f64>,
    gradients: Vec<MeanGradient>,
}

impl ElementHistory {
    fn create(at: &Group, model: &Model, asked: &HistorySet) -> hdf5::Result<Self> {
        let elements = model.sets.elements[asked.set].members.clone();
        let inertia = (elements.iter()).map(|&element| ElementInertia::new(model, element));
        let inertia: Vec<_> = inertia.collect();
        write_constants(at, model, &elements, &inertia)?;
        let sum = group(at, "sum")?;
        let energy = |name, text| Column::series(&sum, name, &[], meaning(text, "energy"));
        let each = (asked.each_member).then(|| EachElement::create(at, model, &elements));
        Ok(ElementHistory {
            each: each.transpose()?,
            strain_energy: energy("ELSE", "strain energy of the set")?,
            kinetic_energy: energy("ELKE", "kinetic energy of the set")?,
            elements,
            inertia,
        })
    }

    /// Appends a row to each dataset.
    pub fn push(&mut self, report: &IncrementReport) {
        let result = |&element: &usize| report.elements[element];
        let results: Vec<ElementResult> = self.elements.iter().map(result).collect();
        let kinetic = (self.inertia.iter()).map(|own| own.kinetic_energy(&report.state.v));
        let kinetic: Vec<f64> = kinetic.collect();
        self.strain_energy
            .push([results.iter().map(|e| e.energy).sum()]);
        self.kinetic_energy.push([kinetic.iter().sum()]);
        if let Some(each) = &mut self.each {
            each.push(&results, &self.inertia, kinetic);
            let strain = each.gradients.iter();
            let strain = strain.flat_map(|mean| mean.logarithmic_strain(&report.state.u));
            each.logarithmic_strain.push(strain);
        }
    }

    /// Its datasets.
    pub fn columns<'a>(&'a mut self, all: &mut Columns<'a>) {
        all.push(&mut self.strain_energy);
        all.push(&mut self.kinetic_energy);
        if let Some(each) = &mut self.each {
            all.extend(growing(&mut each.tensors));
            all.extend(growing(&mut each.scalars));
            all.push(&mut each.logarithmic_strain);
            all.push(&mut each.energy_density);
            all.push(&mut each.kinetic_energy);
        }
    }
}

impl EachElement {
    fn create(at: &Group, model: &Model, elements: &[usize]) -> hdf5::Result<Self> {
        let count = elements.len();
        let column = |name, row: &[usize], text, dimension| {
            Column::series(at, name, row, meaning(text, dimension))
        };
        let tensor = |&(name, text, dimension, value): &(_, _, _, Tensor)| {
            Ok((column(name, &[count, 3], text, dimension)?, value))
        };
        let scalar = |&(name, text, dimension, value): &(_, _, _, Scalar)| {
            Ok((column(name, &[count], text, dimension)?, value))
        };
        let kinetic = "kinetic energy of the element with its consistent mass";
        let mesh = &model.mesh;
        let gradient = |&element: &usize| MeanGradient::new(mesh, &mesh.elements[element]);
        Ok(EachElement {
            tensors: TENSORS.iter().map(tensor).collect::<hdf5::Result<_>>()?,
            scalars: SCALARS.iter().map(scalar).collect::<hdf5::Result<_>>()?,
            logarithmic_strain: Column::series(at, "LE", &[count, 3], LOGARITHMIC_STRAIN)?,
            energy_density: Column::series(at, "ENER", &[count], ENERGY_DENSITY)?,
            kinetic_energy: column("ELKE", &[count], kinetic, "energy")?,
            gradients: elements.iter().map(gradient).collect(),
        })
    }

    fn push(&mut self, results: &[ElementResult], inertia: &[ElementInertia], kinetic: Vec<f64>) {
        for (column, value) in &mut self.tensors {
            column.push(results.iter().flat_map(&*value));
        }
        for (column, value) in &mut self.scalars {
            column.push(results.iter().map(&*value));
        }
        let density = results
            .iter()
            .zip(inertia)
            .map(|(e, own)| e.energy / own.volume);
        self.energy_density.push(density);
        self.kinetic_energy.push(kinetic);
    }
}

/// Numbers and volumes of the elements of a set.
fn write_constants(
    at: &Group,
    model: &Model,
    elements: &[usize],
    inertia: &[ElementInertia],
) -> hdf5::Result<()> {
    let label = |&element: &usize| model.mesh.elements[element].label as i64;
    let labels: Vec<i64> = elements.iter().map(label).collect();
    let text = meaning("element numbers of the deck", "1");
    constant(at, "labels", &[labels.len()], &labels, text)?;
    let volumes: Vec<f64> = inertia.iter().map(|own| own.volume).collect();
    let text = meaning("volume of the undeformed element", "length^3");
    constant(at, "EVOL", &[volumes.len()], &volumes, text)
}

/// The histories of the requested sets; an empty set has none.
pub(crate) fn create_elements(at: &Group, model: &Model) -> hdf5::Result<Vec<ElementHistory>> {
    let mut requested: Vec<&HistorySet> = model.sets.element_history.iter().collect();
    requested.sort_unstable_by_key(|asked| asked.set);
    (requested.iter())
        .map(|asked| (asked, &model.sets.elements[asked.set]))
        .filter(|(_, set)| !set.members.is_empty())
        .map(|(asked, set)| ElementHistory::create(&group(at, &set.name)?, model, asked))
        .collect()
}
