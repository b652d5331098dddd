//! Fields of cells that a deck has to ask for: `ENER` and `LE`.

use super::place::{PLANE_TENSOR, Place, SCALAR};
use crate::elements::{ElementResult, MeanGradient};
use crate::model::Model;
use crate::output::file::column::{Column, Columns, Growing, Mostly};
use crate::output::file::dataset::{Meaning, meaning};

pub(crate) const ENERGY_DENSITY: Meaning = meaning(
    "strain energy over the volume of the undeformed element",
    "energy/length^3",
);
pub(crate) const LOGARITHMIC_STRAIN: Meaning = meaning(
    "logarithmic strain xx yy xy (xy: tensor component) of the element's mean deformation gradient",
    "1",
);

/// The fields that are asked for.
pub(super) struct RequestedFields {
    /// With the volumes of the undeformed elements (length^3).
    energy_density: Option<(Column<f64>, Vec<f64>)>,
    logarithmic_strain: Option<(Column<f64>, Vec<MeanGradient>)>,
    /// Number of segments of rigid surfaces.
    lines: usize,
}

impl RequestedFields {
    pub fn create(at: &mut Place, model: &Model, lines: usize) -> hdf5::Result<Self> {
        let asked = model.sets.fields;
        let elements = &model.mesh.elements;
        let gradients = || elements.iter().map(|e| MeanGradient::new(&model.mesh, e));
        let thickness = elements.iter().map(|e| model.sections[e.section].thickness);
        let volumes = || gradients().zip(thickness).map(|(mean, t)| mean.area * t);
        let energy_density = match asked.energy_density {
            true => {
                let column = at.field("ENER", SCALAR, Mostly::Varied, ENERGY_DENSITY)?;
                Some((column, volumes().collect()))
            }
            false => None,
        };
        let logarithmic_strain = match asked.logarithmic_strain {
            true => {
                let column = at.field("LE", PLANE_TENSOR, Mostly::Varied, LOGARITHMIC_STRAIN)?;
                Some((column, gradients().collect()))
            }
            false => None,
        };
        Ok(RequestedFields {
            energy_density,
            logarithmic_strain,
            lines,
        })
    }

    /// Appends a frame at displacements `u`; rigid segments have NaN.
    pub fn push(&mut self, elements: &[ElementResult], u: &[f64]) {
        let of_lines = |components| std::iter::repeat_n(f64::NAN, components * self.lines);
        if let Some((column, volumes)) = &mut self.energy_density {
            let density = elements
                .iter()
                .zip(volumes)
                .map(|(e, volume)| e.energy / *volume);
            column.push(density.chain(of_lines(1)));
        }
        if let Some((column, gradients)) = &mut self.logarithmic_strain {
            let strain = gradients.iter().flat_map(|mean| mean.logarithmic_strain(u));
            column.push(strain.chain(of_lines(3)));
        }
    }

    /// Their datasets.
    pub fn columns(&mut self) -> Columns<'_> {
        let energy =
            (self.energy_density.iter_mut()).map(|(column, _)| -> &mut dyn Growing { column });
        let strain =
            (self.logarithmic_strain.iter_mut()).map(|(column, _)| -> &mut dyn Growing { column });
        energy.chain(strain).collect()
    }
}
