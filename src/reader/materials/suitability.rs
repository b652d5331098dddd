//! Whether elements suit their materials: plane strain laws, locking.

use super::section::Properties;
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::materials::Plane;
use crate::model::Formulation;
use crate::reader::context::Context;
use crate::reader::mesh::MeshIndex;

/// Poisson's ratio at small strains from which on fully integrated elements lock in plane strain:
/// lambda / mu = 2 nu / (1 - 2 nu) is 9 there.
const LOCKING: f64 = 0.45;

impl Properties {
    /// Reports materials in plane stress elements that are for plane strain only.
    pub(super) fn report_plane_stress(&self, mesh_index: &MeshIndex, cx: &mut Context) {
        let types = self.element_types.iter().enumerate();
        for (index, _) in types.filter(|(_, of)| of.plane == Plane::Stress) {
            let section = self.section_of(index).and_then(|s| self.sections.get(s));
            let material = section.and_then(|s| self.materials.get(s.material));
            if let Some(material) = material
                && !material.law.has_plane_stress()
            {
                let message = format!(
                    "element {} is in plane stress, material {} is for plane strain only",
                    mesh_index.element_name(index),
                    material.name
                );
                let span = mesh_index.places.get(index);
                let error = Diagnostic::error(Code::PlaneStrainOnly, span, message);
                cx.d.push(error.help("take CPE elements, or *ELASTIC"));
                return;
            }
        }
    }

    /// Warns about nearly incompressible materials in plane strain, at their Poisson's ratios; in
    /// plane stress the thickness gives way and nothing locks.
    pub(super) fn report_locking(&self, poisson_spans: &[Span], cx: &mut Context) {
        let mut locks = vec![false; self.materials.len()];
        for (index, element_type) in self.element_types.iter().enumerate() {
            let section = self.section_of(index).and_then(|s| self.sections.get(s));
            let locks = section.and_then(|s| locks.get_mut(s.material));
            if let (Plane::Strain, Formulation::Displacement, Some(locks)) =
                (element_type.plane, element_type.formulation, locks)
            {
                *locks = true;
            }
        }
        let materials = self.materials.iter().zip(poisson_spans).zip(locks);
        for ((material, &span), _) in materials.filter(|(_, locks)| *locks) {
            let poisson = material.law.small_strain().poisson;
            if poisson >= LOCKING {
                let message = format!(
                    "material {} with nu = {} makes plane strain elements lock",
                    material.name,
                    (poisson * 1e6).round() / 1e6
                );
                let warning = Diagnostic::warning(Code::Locking, span, message);
                cx.d.push(warning.help(
                    "CPE3 and CPE4 are integrated fully: from nu = 0.45 on they are too stiff, the \
                     more so the closer nu is to 0.5; CPE4 is not with FORMULATION=MEAN DILATATION \
                     on its *SOLID SECTION",
                ));
            }
        }
    }
}
