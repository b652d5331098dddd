//! Thickness of the two sides of a contact.

use crate::diagnostics::{Code, Diagnostic};
use crate::model::{Contact, SurfaceKind};
use crate::reader::context::Context;
use crate::reader::materials::Properties;
use crate::reader::mesh::Surfaces;

/// Warns where the two sides of a contact differ in thickness.
pub(crate) fn thickness(
    contacts: &[Contact],
    surfaces: &Surfaces,
    properties: &Properties,
    cx: &mut Context,
) {
    for contact in contacts {
        let sides = [contact.slave, contact.master];
        let [slave, master] = sides.map(|s| range_of_thickness(s, surfaces, properties));
        if let (Some(slave), Some(master)) = (slave, master)
            && (slave != master || slave.0 < slave.1 && contact.is_self_contact())
        {
            let message = "the two sides of this contact differ in thickness";
            let warning = Diagnostic::warning(Code::ThicknessMismatch, contact.span, message);
            cx.d.push(warning.help("the bodies touch over the whole thickness of each"));
        }
    }
}

fn range_of_thickness(
    surface: usize,
    surfaces: &Surfaces,
    properties: &Properties,
) -> Option<(f64, f64)> {
    let SurfaceKind::Faces(faces) = &surfaces.all.get(surface)?.kind else {
        return None;
    };
    let all = faces.iter().filter_map(|face| {
        properties
            .sections
            .get(properties.section_of(face.element)?)
    });
    let all: Vec<f64> = all.map(|section| section.thickness).collect();
    let low = all.iter().copied().reduce(f64::min)?;
    Some((low, all.iter().copied().fold(low, f64::max)))
}
