//! All elements of a model in chunks and parts. Section 2 of docs/theory.md.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Mutex;

use crate::elements::damping::ElementDamping;
use crate::elements::element::{AnyChunk, AnyElement};
use crate::elements::solid::{ElementMatrix, ElementVector, MAX_NODES, Motion, TangentPart};
use crate::elements::sweep::{BlockTangents, MAX_CHUNK};
use crate::materials::{Committed, ConstitutiveLaw, PlaneLaw};
use crate::model::{Element, ElementType, Mesh, Model};

/// What the elements of one section and type have in common.
struct Kind {
    law: PlaneLaw,
    density: f64,
    thickness: f64,
}

/// An element that is swept on its own: in another formulation than that of the displacements, or with
/// internal variables.
pub(super) struct Part {
    pub(super) index: usize,
    pub(super) element: AnyElement,
    law: PlaneLaw,
    /// Place of the internal variables of its points among those of all elements.
    pub(super) variables: Range<usize>,
}

/// Where the data of an element are.
#[derive(Clone, Copy)]
enum Place {
    /// In a chunk (index), at a place of it.
    Chunk(u32, u32),
    /// Among the parts (index).
    Part(u32),
}

/// All elements of a model, ready for integration. Displacements are vectors of 2 N entries.
///
/// Sweeps over the elements run in parallel; their results are added up in the order of chunks and
/// elements, so that they do not depend on the number of threads.
pub struct Elements {
    /// Nodes of the elements, one after the other.
    nodes: Vec<usize>,
    /// Start of every element in `nodes`, and their end.
    starts: Vec<usize>,
    kinds: Vec<Kind>,
    /// Kind (index) and place of every element.
    places: Vec<(u32, Place)>,
    pub(super) chunks: Vec<AnyChunk>,
    pub(super) parts: Vec<Part>,
    /// Elements with damping, increasing.
    pub(super) damped: Vec<(usize, ElementDamping)>,
    pub(super) dofs: usize,
    pub(super) space: Mutex<Space>,
}

/// Memory of the sweeps, kept between them and locked while one needs it.
#[derive(Default)]
pub(super) struct Space {
    pub(super) forces: Vec<(ElementVector, f64)>,
    pub(super) tangents: Vec<ElementMatrix>,
    pub(super) block_tangents: Vec<BlockTangents>,
}

impl Part {
    /// The material with its committed variables among those of all elements.
    pub(super) fn material<'a>(&'a self, committed: &'a [f64]) -> Committed<'a> {
        Committed::new(&self.law, &committed[self.variables.clone()])
    }

    pub(super) fn force(&self, motion: Motion) -> (ElementVector, f64) {
        self.element.force(&self.material(motion.committed), motion)
    }

    pub(super) fn tangent(&self, motion: Motion, part: TangentPart) -> ElementMatrix {
        self.element
            .tangent(&self.material(motion.committed), motion, part)
    }
}

impl Elements {
    /// Elements of a model.
    pub fn new(model: &Model) -> Self {
        let elements = &model.mesh.elements;
        let mut all = Elements {
            nodes: Vec::with_capacity(4 * elements.len()),
            starts: vec![0],
            kinds: Vec::new(),
            places: vec![(0, Place::Part(0)); elements.len()],
            chunks: Vec::new(),
            parts: Vec::new(),
            damped: Vec::new(),
            dofs: model.mesh.dof_count(),
            space: Mutex::default(),
        };
        for element in elements {
            all.nodes.extend(&element.nodes);
            all.starts.push(all.nodes.len());
        }
        let body = model.mesh.bodies();
        let body = |&element: &usize| body[elements[element].nodes[0]];
        for ((section, element_type), mut of_kind) in by_kind(elements) {
            let section = &model.sections[section];
            let material = &model.materials[section.material];
            let kind = Kind {
                law: material.law.in_plane(element_type.plane),
                density: material.density,
                thickness: section.thickness,
            };
            of_kind.sort_by_key(body);
            let bodies = of_kind.chunk_by(|a, b| body(a) == body(b));
            let chunks = bodies.flat_map(|of_body| of_body.chunks(MAX_CHUNK));
            if AnyChunk::has(&element_type, &kind.law) {
                chunks.for_each(|chunk| all.enter_chunk(model, &kind, chunk));
            } else {
                of_kind
                    .iter()
                    .for_each(|&element| all.enter_part(model, &kind, element));
            }
            all.kinds.push(kind);
        }
        for (index, element) in elements.iter().enumerate() {
            let material = &model.materials[model.sections[element.section].material];
            let plane = element.element_type.plane;
            let damping = ElementDamping::new(|| all.element(index), material, plane);
            all.damped.extend(damping.map(|damping| (index, damping)));
        }
        all
    }

    /// Takes in elements of the next kind and of one body, so that a body that rests costs nothing.
    fn enter_chunk(&mut self, model: &Model, kind: &Kind, elements: &[usize]) {
        let (number, chunk) = (self.kinds.len() as u32, self.chunks.len() as u32);
        for (place, &element) in elements.iter().enumerate() {
            self.places[element] = (number, Place::Chunk(chunk, place as u32));
        }
        let chunk = AnyChunk::new(model, elements, kind.thickness, kind.law);
        self.chunks.push(chunk);
    }

    /// Takes in an element of the next kind that is swept on its own.
    fn enter_part(&mut self, model: &Model, kind: &Kind, index: usize) {
        let Mesh {
            coordinates,
            elements,
            ..
        } = &model.mesh;
        let (number, part) = (self.kinds.len() as u32, self.parts.len() as u32);
        self.places[index] = (number, Place::Part(part));
        let element = AnyElement::new(&elements[index], coordinates, kind.thickness);
        let first = self.variable_count();
        self.parts.push(Part {
            index,
            element,
            law: kind.law,
            variables: first..first + element.points() * kind.law.variables(),
        });
    }

    /// Number of internal variables of all points.
    pub(super) fn variable_count(&self) -> usize {
        self.parts.last().map_or(0, |part| part.variables.end)
    }

    fn kind(&self, element: usize) -> &Kind {
        &self.kinds[self.places[element].0 as usize]
    }

    /// One element, which in a chunk is made anew.
    pub(super) fn element(&self, element: usize) -> AnyElement {
        match self.places[element].1 {
            Place::Chunk(chunk, place) => {
                self.chunks[chunk as usize].element(place as usize, self.nodes(element))
            }
            Place::Part(part) => self.parts[part as usize].element,
        }
    }

    /// The material of one element with its internal variables among those of all elements.
    pub(super) fn material<'a>(&'a self, element: usize, variables: &'a [f64]) -> Committed<'a> {
        match self.places[element].1 {
            Place::Chunk(..) => Committed::new(&self.kind(element).law, &[]),
            Place::Part(part) => self.parts[part as usize].material(variables),
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

    /// Density of an element (mass/length^3).
    pub fn density(&self, element: usize) -> f64 {
        self.kind(element).density
    }

    /// Thickness of an element (length).
    pub fn thickness(&self, element: usize) -> f64 {
        self.kind(element).thickness
    }

    /// Share of each node of an element in a uniform force per volume (length^3); entries beyond its
    /// nodes are 0.
    pub fn nodal_volumes(&self, element: usize) -> [f64; MAX_NODES] {
        self.element(element).nodal_volumes()
    }

    /// Consistent mass of an element per direction, n x n column by column (mass).
    pub fn mass(&self, element: usize) -> Vec<f64> {
        self.element(element).mass(self.density(element))
    }

    /// Internal variables of all points before the first increment, element by element: zero.
    pub fn initial_variables(&self) -> Vec<f64> {
        vec![0.0; self.variable_count()]
    }
}

/// Elements (indices, increasing) of every section (index) and type, in the order of their first
/// elements.
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
