//! All elements of a model in chunks, and sweeps over them in parallel: internal force, tangents, strain
//! energies and strains, damping, and products of tangents and damping matrices with a vector.
//! See docs/theory/elements.md and docs/theory/time.md.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use rayon::prelude::*;

use super::chunk::{Chunk, MAX_CHUNK, TangentSweep};
use super::connector::{ConnectorState, PlacedConnector};
use super::damping::{MassDamping, between};
use super::element::{ChunkParts, Geometry, new_chunk, points};
use super::motion::{Increment, Motion, TangentPart, dofs};
use super::results::ElementResult;
use super::{MAX_DOFS, MAX_NODES};
use crate::model::{Element, ElementType, Model, Shape, Thickness};

/// Data that the elements of one section and type share.
struct ElementGroup {
    element_type: ElementType,
    density: f64,
    thickness: Thickness,
}

/// Place of the data of an element.
#[derive(Clone, Copy)]
enum ElementPlace {
    /// In a chunk (index), at a place among the elements of the chunk.
    Chunk(u32, u32),
    /// In a rigid body that turns, which no sweep visits.
    Rigid,
}

/// All elements of a model, ready for integration. Displacements are vectors of 2 N entries.
///
/// Sweeps over the elements run in parallel. The results of a sweep are added up in the order of
/// chunks and elements, so they do not depend on the number of threads.
pub struct Elements {
    /// Nodes of the elements, one after the other.
    nodes: Vec<usize>,
    /// Start of every element in `nodes`, and the end of the last element.
    starts: Vec<usize>,
    kinds: Vec<ElementGroup>,
    /// Index of the kind of every element, and its place.
    places: Vec<(u32, ElementPlace)>,
    chunks: Vec<Box<dyn Chunk>>,
    /// Number of internal variables of all elements.
    variables: usize,
    /// Mass-proportional damping of elements, in the order of the elements.
    mass_damping: Vec<MassDamping>,
    /// Springs and dashpots; in lists they follow the elements.
    connectors: Vec<PlacedConnector>,
    /// Masses at nodes that do not belong to a rigid body (index, mass).
    point_masses: Vec<(usize, f64)>,
    /// Reference positions of all nodes (length).
    coordinates: Vec<[f64; 2]>,
    dofs: usize,
    /// Memory of the sweeps over tangents, kept from sweep to sweep and locked during a sweep.
    space: Mutex<Vec<f64>>,
}

impl Elements {
    /// Masses at nodes that do not belong to a rigid body (index, mass).
    pub fn point_masses(&self) -> &[(usize, f64)] {
        &self.point_masses
    }

    /// Elements of a model.
    pub fn new(model: &Model) -> Self {
        let elements = &model.mesh.elements;
        let mut all = Elements {
            nodes: Vec::with_capacity(4 * elements.len()),
            starts: vec![0],
            kinds: Vec::new(),
            places: vec![(0, ElementPlace::Rigid); elements.len()],
            chunks: Vec::new(),
            variables: 0,
            mass_damping: Vec::new(),
            connectors: Vec::new(),
            point_masses: model.point_masses.clone(),
            coordinates: model.mesh.coordinates.clone(),
            dofs: model.dof_count(),
            space: Mutex::default(),
        };
        for element in elements {
            all.nodes.extend(&element.nodes);
            all.starts.push(all.nodes.len());
        }
        let mut is_rigid = vec![false; elements.len()];
        for &element in model.rigid_bodies.iter().flat_map(|body| &body.elements) {
            is_rigid[element] = true;
        }
        let body = model.mesh.bodies();
        let body = |&element: &usize| body[elements[element].nodes[0]];
        for ((section, element_type), mut of_kind) in by_kind(elements) {
            let section = &model.sections[section];
            let material = &model.materials[section.material];
            let number = all.kinds.len() as u32;
            for &element in &of_kind {
                all.places[element].0 = number;
            }
            of_kind.retain(|&element| !is_rigid[element]);
            of_kind.sort_by_key(body);
            // each body has its own chunks, so a body at rest costs nothing
            let bodies = of_kind.chunk_by(|a, b| body(a) == body(b));
            for elements in bodies.flat_map(|of_body| of_body.chunks(MAX_CHUNK)) {
                let law = material.law.in_plane(element_type.plane);
                all.enter_chunk(ChunkParts {
                    model,
                    elements,
                    law,
                    first_variable: all.variables,
                });
            }
            all.kinds.push(ElementGroup {
                element_type,
                density: material.density,
                thickness: Thickness::new(element_type, section.thickness),
            });
        }
        for (index, element) in elements.iter().enumerate().filter(|(e, _)| !is_rigid[*e]) {
            let material = &model.materials[model.sections[element.section].material];
            let alpha = material.damping.alpha;
            if alpha > 0.0 {
                all.mass_damping.push(MassDamping {
                    element: index,
                    mass: all.geometry(index).mass(alpha * material.density),
                });
            }
        }
        let placed = |connector| PlacedConnector::new(connector, model);
        all.connectors = model.connectors.iter().map(placed).collect();
        all
    }

    fn enter_chunk(&mut self, parts: ChunkParts) {
        let (number, chunk) = (self.chunks.len() as u32, new_chunk(parts));
        for (place, &element) in (0..).zip(chunk.elements()) {
            self.places[element].1 = ElementPlace::Chunk(number, place);
        }
        self.variables = chunk.variables().end;
        self.chunks.push(chunk);
    }

    /// Whether an element belongs to a rigid body that turns.
    pub fn is_rigid(&self, element: usize) -> bool {
        matches!(self.places[element].1, ElementPlace::Rigid)
    }

    fn kind(&self, element: usize) -> &ElementGroup {
        &self.kinds[self.places[element].0 as usize]
    }

    /// The chunk of an element, and its place among the elements there; `None` for an element of a rigid body that
    /// turns.
    pub(super) fn chunk_of(&self, element: usize) -> Option<(&dyn Chunk, usize)> {
        match self.places[element].1 {
            ElementPlace::Chunk(chunk, place) => {
                Some((&*self.chunks[chunk as usize], place as usize))
            }
            ElementPlace::Rigid => None,
        }
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether there are no elements.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Node indices of an element.
    pub fn nodes(&self, element: usize) -> &[usize] {
        &self.nodes[self.starts[element]..self.starts[element + 1]]
    }

    /// Nodes of every element, then of every spring and dashpot.
    pub fn connected(&self) -> impl Iterator<Item = &[usize]> {
        let elements = (0..self.len()).map(|element| self.nodes(element));
        elements.chain(self.connectors.iter().map(PlacedConnector::nodes))
    }

    /// Sets the lengths L of bodies that turn; each length comes with the pair of dofs of the body's angle.
    pub fn measure_angles(&mut self, lengths: impl Iterator<Item = (usize, f64)>) {
        for (pair, length) in lengths {
            let connectors = self.connectors.iter_mut();
            connectors.for_each(|connector| connector.measure_angle(pair, length));
        }
    }

    /// All springs and dashpots at displacements `u` and velocities `v`.
    pub fn connector_states(&self, u: &[f64], v: &[f64]) -> Vec<ConnectorState> {
        let all = self.connectors.iter();
        all.map(|connector| connector.state(u, v)).collect()
    }

    /// Energy that all springs store at displacements `u` (force length).
    pub fn spring_energy(&self, u: &[f64]) -> f64 {
        self.connectors.iter().map(|spring| spring.energy(u)).sum()
    }

    /// Number of integration points of an element.
    pub fn points(&self, element: usize) -> usize {
        points(self.kind(element).element_type)
    }

    /// Shape of an element.
    pub(super) fn shape(&self, element: usize) -> Shape {
        self.kind(element).element_type.shape
    }

    /// Density of an element (mass/length^3).
    pub fn density(&self, element: usize) -> f64 {
        self.kind(element).density
    }

    /// Thickness of an element.
    pub fn thickness(&self, element: usize) -> Thickness {
        self.kind(element).thickness
    }

    /// Share of each node of an element in a uniform force per volume (length^3); entries after its nodes are 0.
    pub fn nodal_volumes(&self, element: usize) -> [f64; MAX_NODES] {
        self.geometry(element).nodal_volumes()
    }

    /// Consistent mass of an element per direction, n x n column by column (mass).
    pub fn mass(&self, element: usize) -> Vec<f64> {
        self.geometry(element).mass(self.density(element))
    }

    /// Shape and nodes of an element in the reference configuration.
    fn geometry(&self, element: usize) -> Geometry<'_> {
        let kind = self.kind(element);
        Geometry {
            shape: kind.element_type.shape,
            nodes: self.nodes(element),
            coordinates: &self.coordinates,
            thickness: kind.thickness,
        }
    }

    /// Internal variables of all points before the first increment, element by element; all of these are zero.
    pub fn initial_variables(&self) -> Vec<f64> {
        vec![0.0; self.variables]
    }
}

/// Indices of the elements, increasing, of every section (index) and type, in the order of their
/// first elements.
fn by_kind(elements: &[Element]) -> Vec<((usize, ElementType), Vec<usize>)> {
    let (mut kinds, mut number) = (Vec::new(), HashMap::new());
    for (index, element) in elements.iter().enumerate() {
        let kind = (element.section, element.element_type);
        let at = *number.entry(kind).or_insert(kinds.len());
        if at == kinds.len() {
            kinds.push((kind, Vec::new()));
        }
        kinds[at].1.push(index);
    }
    kinds
}

/// Number of elements below which a sweep is not worth a second thread.
const PARALLEL_CHUNK: usize = 1024;

/// An element whose deformation gradient has a determinant that is not positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inverted {
    /// Element (index).
    pub element: usize,
    /// Determinant.
    pub determinant: f64,
}

/// Internal variables of all elements at the end of an increment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Updated {
    /// Internal variables of all points, element by element.
    pub variables: Vec<f64>,
    /// Energy dissipated since the start of the increment (force length).
    pub dissipated: f64,
}

impl Elements {
    /// Internal variables at the end of a motion, and the energy dissipated within the motion. The variables in
    /// `motion` do not change: the caller commits or drops the returned variables.
    pub fn update(&self, motion: Motion) -> Updated {
        let mut updated = Updated {
            variables: motion.committed.to_vec(),
            dissipated: 0.0,
        };
        for chunk in &self.chunks {
            updated.dissipated += chunk.update(motion, &mut updated.variables);
        }
        updated
    }

    /// Strain energy, mean stress and mean strain of every element at the end of a motion, with the internal variables
    /// at this end.
    pub fn evaluate(&self, motion: Motion) -> Arc<[ElementResult]> {
        let mut results: Arc<[_]> = vec![ElementResult::default(); self.len()].into();
        let all = Arc::make_mut(&mut results);
        let mut write = |chunk: &dyn Chunk, of_chunk: Vec<ElementResult>| {
            for (&element, result) in chunk.elements().iter().zip(of_chunk) {
                all[element] = result;
            }
        };
        let evaluate = |chunk: &dyn Chunk| chunk.evaluate(motion);
        if self.is_worth_threads() {
            let all_chunks = self.chunks.par_iter();
            let of_chunks: Vec<_> = all_chunks.map(|chunk| evaluate(&**chunk)).collect();
            let both = self.chunks.iter().zip(of_chunks);
            both.for_each(|(chunk, of_chunk)| write(&**chunk, of_chunk));
        } else {
            self.chunks
                .iter()
                .for_each(|chunk| write(&**chunk, evaluate(&**chunk)));
        }
        results
    }

    /// Whether any material expands with its temperature.
    pub fn expand(&self) -> bool {
        self.chunks.iter().any(|chunk| chunk.expands())
    }

    /// Potential, at the end of a motion, of the elements that expand, eq. (2.55) (force length): the energy that these
    /// elements store there, and the energy dissipated within the motion. At a constant temperature, the work of the
    /// internal force is the change of the potential.
    ///
    /// ```text
    /// Phi(U; T) = min over z of W(U, z; T) + D(z)
    /// ```
    pub fn potential(&self, motion: Motion) -> f64 {
        let mut variables = motion.committed.to_vec();
        let mut potential = 0.0;
        for chunk in self.chunks.iter().filter(|chunk| chunk.expands()) {
            potential += chunk.update(motion, &mut variables);
            let updated = Motion {
                committed: &variables,
                ..motion
            };
            let energies = chunk.evaluate(updated).into_iter();
            potential += energies.map(|result| result.energy).sum::<f64>();
        }
        potential
    }

    /// Energy that the elements that expand store at the end of a motion, with the internal variables at this end
    /// (force length).
    pub fn stored_by_expanding(&self, motion: Motion) -> f64 {
        let expanding = self.chunks.iter().filter(|chunk| chunk.expands());
        let results = expanding.flat_map(|chunk| chunk.evaluate(motion));
        results.map(|result| result.energy).sum()
    }

    /// Internal force F of elements and springs at the end of a motion, or the energy-momentum form of F from start to
    /// end, 2 N entries.
    ///
    /// # Errors
    /// Returns the first element that is turned inside out, as an error.
    pub fn internal_force(&self, motion: Motion) -> Result<Vec<f64>, Inverted> {
        let mut force = vec![0.0; self.dofs];
        self.write_internal_force(motion, &mut force)?;
        Ok(force)
    }

    /// Writes [`Self::internal_force`] to `total`, 2 N entries.
    ///
    /// # Errors
    /// Returns the first element that is turned inside out, as an error.
    pub fn write_internal_force(&self, motion: Motion, total: &mut [f64]) -> Result<(), Inverted> {
        if !self.sum_chunks(|chunk| chunk.sum_forces(motion)) {
            self.chunks.iter().for_each(|chunk| chunk.clear_sums());
            return Err(self.inverted(motion));
        }
        total.fill(0.0);
        self.chunks.iter().for_each(|chunk| chunk.add_sums(total));
        for spring in &self.connectors {
            add_vector(spring.nodes(), &spring.force(motion), total);
        }
        Ok(())
    }

    /// Whether there are several threads, and enough elements for them.
    fn is_worth_threads(&self) -> bool {
        rayon::current_num_threads() > 1 && self.len() >= 2 * PARALLEL_CHUNK
    }

    /// Adds up forces of the elements, chunk by chunk. The result is false if an element is turned inside out.
    fn sum_chunks(&self, sum: impl Fn(&dyn Chunk) -> bool + Sync + Send) -> bool {
        if self.is_worth_threads() {
            let sums = self.chunks.par_iter().map(|chunk| sum(&**chunk));
            sums.reduce(|| true, |all, chunk| all && chunk)
        } else {
            self.chunks.iter().all(|chunk| sum(&**chunk))
        }
    }

    /// Returns the first element that is turned inside out.
    fn inverted(&self, motion: Motion) -> Inverted {
        let all = self.chunks.iter().flat_map(|chunk| {
            let elements = chunk.elements().iter().copied();
            elements.zip(chunk.determinants(motion))
        });
        let none = Inverted {
            element: 0,
            determinant: f64::INFINITY,
        };
        let is_turned = |determinant: f64| determinant.is_nan() || determinant <= 0.0;
        all.fold(none, |found, (element, determinant)| {
            let is_first = match [found.determinant, determinant].map(is_turned) {
                [true, true] => element < found.element,
                [false, false] => determinant < found.determinant,
                [of_found, _] => !of_found,
            };
            match is_first {
                true => Inverted {
                    element,
                    determinant,
                },
                false => found,
            }
        })
    }

    /// Memory of the sweeps; only one sweep runs at a time.
    fn space(&self) -> MutexGuard<'_, Vec<f64>> {
        self.space.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Calls `add(place, k)` with the tangent, or its positive part, of every element and spring that is `wanted`, and
    /// possibly of further elements. The matrix k is D x D, column by column, in the configuration of
    /// [`Self::internal_force`]. The places of the elements are their places in [`Self::connected`].
    pub fn for_each_tangent(
        &self,
        motion: Motion,
        part: TangentPart,
        wanted: impl Fn(usize) -> bool + Sync,
        mut add: impl FnMut(usize, &[f64]),
    ) {
        self.sweep_tangents(motion, part, &wanted, &mut add);
    }

    /// [`Self::for_each_tangent`] without a type parameter for the caller, so that this function is compiled only once
    /// for the many kinds of elements.
    fn sweep_tangents(
        &self,
        motion: Motion,
        part: TangentPart,
        wanted: &(dyn Fn(usize) -> bool + Sync),
        add: &mut dyn FnMut(usize, &[f64]),
    ) {
        let space = &mut *self.space();
        for chunk in &self.chunks {
            let sweep = TangentSweep {
                motion,
                part,
                viscous: false,
                wanted,
            };
            chunk.for_each_tangent(sweep, space, add);
        }
        for (place, spring) in (self.len()..).zip(&self.connectors) {
            add(place, &spring.tangent(motion, part));
        }
    }

    /// Tangent of one element in the configuration of [`Self::internal_force`], D x D column by column; zero in a rigid
    /// body that turns.
    pub fn tangent(&self, element: usize, motion: Motion) -> Vec<f64> {
        let d = 2 * self.nodes(element).len();
        let chunk = self.chunk_of(element);
        chunk.map_or(vec![0.0; d * d], |(chunk, place)| {
            chunk.tangent(place, motion)
        })
    }
}

impl Elements {
    /// The product K v with the tangent K in the configuration of [`Self::internal_force`], 2 N entries. Elements at
    /// whose nodes `v` is zero are skipped.
    pub fn tangent_product(&self, motion: Motion, v: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.dofs];
        let moves = |&node: &usize| v[2 * node] != 0.0 || v[2 * node + 1] != 0.0;
        let wanted = |element: usize| self.nodes(element).iter().any(moves);
        self.for_each_tangent(motion, TangentPart::Whole, wanted, |place, k| {
            add_product(self.nodes_at(place), k, v, &mut product);
        });
        product
    }

    /// Nodes of the element, spring or dashpot at a place of [`Self::connected`].
    fn nodes_at(&self, place: usize) -> &[usize] {
        match place.checked_sub(self.len()) {
            None => self.nodes(place),
            Some(connector) => self.connectors[connector].nodes(),
        }
    }

    /// Whether any element is damped, or there is a dashpot.
    pub fn has_damping(&self) -> bool {
        !self.mass_damping.is_empty()
            || self.chunks.iter().any(|chunk| chunk.is_viscous())
            || self.dashpots().next().is_some()
    }

    /// The dashpots, each with its place in [`Self::connected`], behind the elements.
    fn dashpots(&self) -> impl Iterator<Item = (usize, &PlacedConnector)> {
        let all = (self.len()..).zip(&self.connectors);
        all.filter(|(_, connector)| connector.is_dashpot())
    }

    /// Damping force F_d in an increment of length `dt` with the displacement increment `d`, eq.
    /// (4.16), 2 N entries.
    pub fn damping_force(&self, increment: Increment, d: &[f64], dt: f64) -> Vec<f64> {
        let mut force = self.mass_damping_impulse(d);
        self.sum_chunks(|chunk| {
            chunk.sum_viscous(between(increment));
            true
        });
        self.chunks
            .iter()
            .for_each(|chunk| chunk.add_sums(&mut force));
        for (_, dashpot) in self.dashpots() {
            add_vector(dashpot.nodes(), &dashpot.impulse(increment, dt), &mut force);
        }
        force.iter_mut().for_each(|f| *f /= dt);
        force
    }

    /// Impulse alpha M d that mass-proportional damping removes in a displacement increment d, 2 N entries (force
    /// time).
    pub fn mass_damping_impulse(&self, d: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.dofs];
        for damping in &self.mass_damping {
            let nodes = self.nodes(damping.element);
            add_vector(nodes, &damping.impulse(nodes, d), &mut sum);
        }
        sum
    }

    /// Energy d.F_d that damping dissipates in an increment of length `dt` with the displacement
    /// increment `d`, eq. (4.18) (force length).
    pub fn damping_dissipation(&self, increment: Increment, d: &[f64], dt: f64) -> f64 {
        let chunks = self.chunks.iter();
        let viscous = chunks.map(|chunk| chunk.viscous_work(between(increment)));
        let of_mass = self.mass_damping.iter();
        let of_mass = of_mass.map(|damping| damping.work(self.nodes(damping.element), d));
        let dashpots = self
            .dashpots()
            .map(|(_, dashpot)| dashpot.work(increment, dt));
        (viscous.sum::<f64>() + of_mass.sum::<f64>() + dashpots.sum::<f64>()) / dt
    }

    /// Calls `add(place, c)` with the damping matrices, or their positive parts, of every damped element and dashpot in
    /// an increment of length `dt`, eq. (4.19). The matrix c is D x D, column by column (force time/length). An element
    /// may have two damping matrices: of its viscosity, and proportional to its mass.
    pub fn for_each_damping(
        &self,
        (increment, dt): (Increment, f64),
        part: TangentPart,
        mut add: impl FnMut(usize, &[f64]),
    ) {
        let space = &mut *self.space();
        let mut add_half = |element: usize, c: &[f64]| {
            let mut half = [0.0; MAX_DOFS * MAX_DOFS];
            half.iter_mut().zip(c).for_each(|(half, c)| *half = c / 2.0);
            add(element, &half[..c.len()]);
        };
        for chunk in self.chunks.iter().filter(|chunk| chunk.is_viscous()) {
            let sweep = TangentSweep {
                motion: between(increment),
                part,
                viscous: true,
                wanted: &|_| true,
            };
            chunk.for_each_tangent(sweep, space, &mut add_half);
        }
        for damping in &self.mass_damping {
            let n = self.nodes(damping.element).len();
            add(damping.element, &damping.matrix(n)[..4 * n * n]);
        }
        for (place, dashpot) in self.dashpots() {
            add(place, &dashpot.damping(increment, dt));
        }
    }

    /// The product Cd v with the damping matrix Cd in an increment of length `dt`, 2 N entries.
    pub fn damping_product(&self, increment: Increment, dt: f64, v: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.dofs];
        self.for_each_damping((increment, dt), TangentPart::Whole, |place, c| {
            add_product(self.nodes_at(place), c, v, &mut product);
        });
        product
    }
}

/// Adds the vector of an element, given by its nodes, to a sum over all dofs.
fn add_vector(nodes: &[usize], vector: &[f64], sum: &mut [f64]) {
    for (dof, value) in dofs(nodes).zip(vector) {
        sum[dof] += value;
    }
}

/// Adds k v to a product over all dofs, where k is the matrix of an element, given by its nodes.
fn add_product(nodes: &[usize], k: &[f64], v: &[f64], product: &mut [f64]) {
    let d = 2 * nodes.len();
    for (j, column) in dofs(nodes).enumerate() {
        for (i, row) in dofs(nodes).enumerate() {
            product[row] += k[j * d + i] * v[column];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::{Law, NeoHooke};
    use crate::model::{Damping, Element, ElementType, Formulation, Material, Model, Section};

    /// A model of a law on three quadrilaterals of the type `quad` and a triangle.
    fn model(law: Law, quad: ElementType) -> Model {
        let mut model = Model::default();
        model.materials.push(Material {
            name: "M".into(),
            law,
            density: 1.0,
            damping: Damping::default(),
            expansion: None,
        });
        model.sections.push(Section {
            material: 0,
            thickness: 2.0,
        });
        let mesh = &mut model.mesh;
        mesh.coordinates = vec![
            [0.0, 0.0],
            [1.0, 0.1],
            [1.2, 1.1],
            [-0.1, 0.9],
            [0.6, 1.8],
            [2.1, 0.0],
            [2.0, 1.2],
            [3.0, 0.2],
            [3.1, 0.9],
        ];
        let tri = ElementType {
            plane: quad.plane,
            ..ElementType::CPE3
        };
        let elements = [
            (quad, vec![0, 1, 2, 3]),
            (tri, vec![3, 2, 4]),
            (quad, vec![1, 5, 6, 2]),
            (quad, vec![5, 7, 8, 6]),
        ];
        for (element_type, nodes) in elements {
            mesh.elements.push(Element {
                label: 1,
                element_type,
                nodes: nodes.into(),
                section: 0,
            });
        }
        model
    }

    fn wave(scale: f64, k: f64) -> Vec<f64> {
        (0..36).map(|i| scale * (k * f64::from(i)).sin()).collect()
    }

    /// Models of quadrilaterals with mean dilatation.
    fn with_mean_dilatation() -> [Model; 3] {
        let mean = ElementType {
            formulation: Formulation::MeanDilatation,
            ..ElementType::CPE4
        };
        models().map(|m| model(m.materials[0].law.clone(), mean))
    }

    fn models() -> [Model; 3] {
        let elastic = Law::elastic(100.0, 0.3);
        let rubber = Law::NeoHooke(NeoHooke {
            c10: 20.0,
            d1: 0.02,
        });
        [
            model(elastic.clone(), ElementType::CPS4),
            model(elastic, ElementType::CPE4),
            model(rubber, ElementType::CPE4),
        ]
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let mut model = model(Law::elastic(100.0, 0.3), ElementType::CPE4);
        let one = model.mesh.elements.clone();
        (0..1500).for_each(|_| model.mesh.elements.extend(one.clone()));
        let (elements, u) = (Elements::new(&model), wave(0.1, 1.3));
        let sweep = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("threads").install(|| {
                let motion = Motion::at(&u, &[]);
                let force = elements.internal_force(motion);
                let mut tangents: Vec<f64> = Vec::new();
                elements.for_each_tangent(
                    motion,
                    TangentPart::Whole,
                    |_| true,
                    |_, k| tangents.extend(k),
                );
                (force, tangents)
            })
        };
        let [one, two, three] = [1, 2, 3].map(sweep);
        assert!(one.0.is_ok() && one == two && one == three);
    }

    #[test]
    fn the_first_element_turned_inside_out_is_found() {
        for model in models() {
            // node 8 beyond node 5, node 4 below nodes 2 and 3
            for (node, move_by, element) in [(8, [-2.0, -2.0], 3), (4, [0.0, -2.0], 1)] {
                let mut u = vec![0.0; 18];
                u[2 * node..2 * node + 2].copy_from_slice(&move_by);
                let elements = Elements::new(&model);
                let found = elements.internal_force(Motion::at(&u, &[]));
                let inverted = found.expect_err("an element inverted");
                assert_eq!(inverted.element, element);
                assert!(inverted.determinant <= 0.0);
                u[2 * node] = f64::NAN;
                let found = elements.internal_force(Motion::at(&u, &[]));
                assert!(found.is_err_and(|inverted| inverted.determinant.is_nan()));
            }
        }
    }

    #[test]
    fn an_end_inside_out_is_found_where_halfway_nothing_is() {
        for model in models().iter().chain(&with_mean_dilatation()) {
            // heights are multiplied by -0.2 at the end and by 0.4 halfway
            let coordinates = model.mesh.coordinates.iter();
            let u: Vec<f64> = coordinates.flat_map(|x| [0.0, -1.2 * x[1]]).collect();
            let start = vec![0.0; u.len()];
            let between = Motion {
                start: Some(&start),
                ..Motion::at(&u, &[])
            };
            let elements = Elements::new(model);
            let inverted = (elements.internal_force(between)).expect_err("an element inverted");
            assert_eq!(inverted.element, 0);
            assert!((inverted.determinant + 0.2).abs() < 1e-13, "{inverted:?}");
        }
    }

    #[test]
    fn bodies_that_move_as_one_have_no_force() {
        let elements = Elements::new(&model(Law::elastic(100.0, 0.3), ElementType::CPE4));
        let u: Vec<f64> = [0.1, 0.7].repeat(9);
        let force = elements
            .internal_force(Motion::at(&u, &[]))
            .expect("no element inverted");
        assert!(force.iter().all(|&f| f == 0.0));
    }

    #[test]
    fn the_tangent_product_is_the_change_of_the_internal_force() {
        let elements = Elements::new(&model(Law::elastic(100.0, 0.3), ElementType::CPE4));
        let (u, v) = (wave(0.1, 1.3), wave(1.0, 2.1));
        let force = |t: f64| {
            let moved: Vec<f64> = u.iter().zip(&v).map(|(u, v)| u + t * v).collect();
            elements
                .internal_force(Motion::at(&moved, &[]))
                .expect("no element inverted")
        };
        let (ahead, behind) = (force(1e-5), force(-1e-5));
        let product = elements.tangent_product(Motion::at(&u, &[]), &v);
        let largest = product.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
        for (i, p) in product.iter().enumerate() {
            let quotient = (ahead[i] - behind[i]) / 2e-5;
            assert!((p - quotient).abs() < 1e-8 * largest, "{i}: {p} {quotient}");
        }
    }
}
