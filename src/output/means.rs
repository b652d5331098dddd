use crate::model::Model;

/// Means over the elements: Cauchy stress (force/length^2) and Green-Lagrange strain, each xx yy xy.
pub(super) struct Means {
    /// Stress, one entry per element.
    pub stress: Vec<[f64; 3]>,
    /// Strain, one entry per element.
    pub strain: Vec<[f64; 3]>,
}

/// Element means at the displacement `u` (`2 N` entries).
// CONNECT: replace the body by a call of `elements::element_means(model, u)`.
pub(super) fn means(model: &Model, _u: &[f64]) -> Means {
    let unknown = vec![[f64::NAN; 3]; model.mesh.elements.len()];
    Means {
        stress: unknown.clone(),
        strain: unknown,
    }
}
