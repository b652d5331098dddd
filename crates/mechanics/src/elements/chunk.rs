//! Chunks: elements of one type and material in blocks, with their common nodes. The data that a chunk reads and
//! changes fit into the first caches of a processor. Any number of threads sweeps over the chunks.

// Loops over points, nodes and directions: indices are those of the formulas.
#![allow(clippy::needless_range_loop)]

use std::array::from_fn;
use std::marker::PhantomData;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use nalgebra::SMatrix;
use rayon::prelude::*;
use smallvec::SmallVec;

use super::block::{BlockMotion, ElementBlock, MatrixLanes, MovedBlock, NodalLanes};
use super::formulation::{Formulation, PlacedBlock};
use super::motion::{Motion, TangentPart, take_positive_part};
use super::results::{ElementResult, PointResult, ResultPoint, Sums};
use super::shapes::IntegratedShape;
use crate::materials::number::{LANES, Positive};
use crate::materials::{
    AnyLaw, Elastic, Expansion, Lanes, LawInLanes, Number, Plane, PlaneLaw, StressAtPoints,
    Viscosity,
};
use crate::model::Thickness;

/// Largest number of elements of a chunk.
pub const MAX_CHUNK: usize = 1024;

/// Number of blocks up to which tangents are not worth a second thread.
const PARALLEL_BLOCKS: usize = 64;

/// A sweep over tangents.
#[derive(Clone, Copy)]
pub struct TangentSweep<'a> {
    pub motion: Motion<'a>,
    pub part: TangentPart,
    /// Whether the viscous stress (`*DAMPING`) is differentiated instead of the stress of the
    /// material.
    pub viscous: bool,
    /// Whether the tangent of an element is needed.
    pub wanted: &'a (dyn Fn(usize) -> bool + Sync),
}

/// Elements that are swept together. A place is the number of an element among the elements that are swept together;
/// otherwise elements are named by their indices.
pub trait Chunk: Send + Sync {
    /// Elements (indices).
    fn elements(&self) -> &[usize];

    /// Range of the internal variables of the elements among the variables of all elements.
    fn variables(&self) -> Range<usize>;

    /// Adds the internal forces of the elements at the end of a motion, or their energy-momentum form, to the sums. The
    /// result is false if an element is turned inside out.
    fn sum_forces(&self, motion: Motion) -> bool;

    /// Whether the material has viscosity.
    fn is_viscous(&self) -> bool;

    /// Adds the viscous impulses in a motion (viscous forces times the length of the increment) to the sums, eq.
    /// (4.16).
    fn sum_viscous(&self, motion: Motion);

    /// Viscous work in a motion, times the length of the increment, eq. (4.18) (force length time).
    fn viscous_work(&self, motion: Motion) -> f64;

    /// Adds the sums to a vector over all dofs and resets them to zero.
    fn add_sums(&self, total: &mut [f64]);

    /// Resets the sums to zero.
    fn clear_sums(&self);

    /// Smallest determinant of the deformation gradient of every element, in the mid configuration and at the end of a
    /// motion; NaN if an element has no force.
    fn determinants(&self, motion: Motion) -> Vec<f64>;

    /// Strain energy, stress and strain of every element at the end of a motion.
    fn evaluate(&self, motion: Motion) -> Vec<ElementResult>;

    /// Results of the points of an element at the end of a motion.
    fn at_points(&self, place: usize, motion: Motion) -> SmallVec<[PointResult; 9]>;

    /// Whether the material expands with its temperature.
    fn expands(&self) -> bool;

    /// Writes the internal variables of the elements at the end of a motion into the variables of all elements, and
    /// returns the energy dissipated in the motion (force length).
    fn update(&self, motion: Motion, updated: &mut [f64]) -> f64;

    /// Tangent of an element in a motion, D x D column by column.
    fn tangent(&self, place: usize, motion: Motion) -> Vec<f64>;

    /// Calls `add(element, k)` with the tangent (D x D, column by column) of every element in a block with at least one
    /// wanted element. The tangents are made in `space`; with several threads the tangents of the whole chunk are made
    /// in parallel.
    fn for_each_tangent(
        &self,
        sweep: TangentSweep,
        space: &mut Vec<f64>,
        add: &mut dyn FnMut(usize, &[f64]),
    );
}

/// Numbers of internal variables of one element: first the number for its points, one after the other, then the number
/// for the element itself.
#[derive(Clone, Copy)]
struct VariableLayout {
    of_points: usize,
    own: usize,
}

impl VariableLayout {
    fn count(&self) -> usize {
        self.of_points + self.own
    }
}

/// Thermal expansion of the elements of a chunk.
struct Heating<const P: usize> {
    expansion: Expansion,
    plane: Plane,
    /// Temperatures at the start of the analysis at the points of every block.
    initial: Vec<[Lanes; P]>,
}

/// Material of the elements of a chunk.
pub struct ChunkMaterial<'a> {
    pub law: PlaneLaw,
    pub viscosity: Option<Viscosity>,
    /// Thermal expansion, and the temperature of every node at the start of the analysis; the list is empty if all
    /// these temperatures are zero.
    pub expansion: Option<(Expansion, &'a [f64])>,
    pub plane: Plane,
}

/// Elements of one shape, formulation and material.
pub struct ShapeChunk<const N: usize, const P: usize, const HOOP: bool, S, F>
where
    F: Formulation<N, P, HOOP>,
{
    /// Indices of the elements, lane after lane and block after block.
    elements: Vec<usize>,
    /// Node indices, increasing; blocks refer to places in the list. After the increasing indices come the nodes for
    /// the places of the last block that no element fills; they repeat the last element.
    nodes: Vec<usize>,
    /// Number of the increasing node indices.
    node_count: usize,
    blocks: Vec<ElementBlock<N, P>>,
    /// Inverse radii 1/R at the points of every block (1/length); in the plane one entry of zeros serves for all
    /// blocks.
    over_radius: Vec<[Lanes; P]>,
    /// Reference data of the formulation, except the data of the points, of every block.
    references: Vec<F::Reference>,
    law: PlaneLaw,
    viscosity: Option<Viscosity>,
    heating: Option<Heating<P>>,
    layout: VariableLayout,
    /// Start of the internal variables of the first element.
    first_variable: usize,
    /// Sums of the last sweep over the nodes, zero after a thread has read them; the thread that computes or reads the
    /// sums locks them.
    sums: Mutex<Vec<[f64; 2]>>,
    kind: PhantomData<S>,
}

impl<const N: usize, const P: usize, const HOOP: bool, S, F> ShapeChunk<N, P, HOOP, S, F>
where
    S: IntegratedShape<N, P> + Send + Sync,
    F: Formulation<N, P, HOOP>,
{
    /// A chunk of elements (indices) with the nodes `of` each element, node coordinates `x` and the given thickness.
    /// The internal variables of the chunk begin at `first_variable`.
    pub fn new(
        elements: Vec<usize>,
        of: &[[usize; N]],
        x: &[[f64; 2]],
        thickness: Thickness,
        material: ChunkMaterial,
        first_variable: usize,
    ) -> Self {
        let ChunkMaterial {
            law,
            viscosity,
            expansion,
            plane,
        } = material;
        let mut nodes: Vec<usize> = of.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let node_count = nodes.len();
        let last = of.len() - 1;
        nodes.extend(of[last]);
        let block = |first: usize| {
            let at = |lane: usize| (first + lane).min(last);
            let places = from_fn(|lane| match first + lane <= last {
                true => of[at(lane)].map(|node| place(&nodes[..node_count], node)),
                false => from_fn(|a| (node_count + a) as u16),
            });
            let maps = from_fn(|lane| {
                let x = SMatrix::from_fn(|i, a| x[of[at(lane)][a]][i]);
                S::FUNCTIONS.jacobians(&x, thickness)
            });
            ElementBlock::new(places, &maps)
        };
        let firsts = || (0..of.len()).step_by(LANES);
        let blocks: Vec<ElementBlock<N, P>> = firsts().map(block).collect();
        let places = |first: usize| -> [[Lanes; 2]; P] {
            let nodal: NodalLanes<N> = from_fn(|i| {
                from_fn(|a| Lanes(from_fn(|lane| x[of[(first + lane).min(last)][a]][i])))
            });
            from_fn(|p| [S::value(p, &nodal[0]), S::value(p, &nodal[1])])
        };
        let over_radius = |places: &[[Lanes; 2]; P]| match thickness {
            Thickness::Around => places.map(|[r, _]| Lanes::all(1.0) / r),
            Thickness::Of(_) => [Lanes::ZERO; P],
        };
        let tangent = law.initial_tangent();
        let viscous_tangent = viscosity.as_ref().map(Viscosity::initial_tangent);
        let reference = |(first, block): (usize, &ElementBlock<N, P>)| {
            let places = places(first);
            F::reference::<S>(&PlacedBlock {
                block,
                over_radius: &over_radius(&places),
                places: &places,
                tangent: &tangent,
                viscous_tangent: viscous_tangent.as_ref(),
            })
        };
        let heating = expansion.map(|(expansion, initial)| Heating {
            expansion,
            plane,
            initial: firsts()
                .map(|first| {
                    temperatures::<S, N, P>(|a, lane| {
                        let node = of[(first + lane).min(last)][a];
                        initial.get(node).copied().unwrap_or_default()
                    })
                })
                .collect(),
        });
        ShapeChunk {
            heating,
            references: firsts().zip(&blocks).map(reference).collect(),
            over_radius: match HOOP {
                true => firsts().map(|first| over_radius(&places(first))).collect(),
                false => vec![[Lanes::ZERO; P]],
            },
            blocks,
            sums: Mutex::new(vec![[0.0; 2]; nodes.len()]),
            elements,
            nodes,
            node_count,
            layout: VariableLayout {
                of_points: F::POINTS * law.variables(),
                own: F::own_variables(law.as_metal().is_some()),
            },
            first_variable,
            law,
            viscosity,
            kind: PhantomData,
        }
    }

    /// Places of the variables of the elements of a block among the variables of all elements; empty if the elements
    /// have no variables. Places that no element fills have the variables of the last element.
    #[inline(always)]
    fn variables_of<'a>(&self, all: &'a [f64], block: usize) -> [&'a [f64]; LANES] {
        let count = self.layout.count();
        from_fn(|lane| {
            let element = (LANES * block + lane).min(self.elements.len() - 1);
            let first = self.first_variable + element * count;
            all.get(first..first + count).unwrap_or_default()
        })
    }

    /// Variables of the points of a block.
    #[inline(always)]
    fn of_points<'a>(&self, all: &'a [f64], block: usize) -> [&'a [f64]; LANES] {
        let all = self.variables_of(all, block);
        all.map(|all| all.get(..self.layout.of_points).unwrap_or_default())
    }

    /// A block in a motion.
    #[inline(always)]
    fn moved<'a>(
        &'a self,
        number: usize,
        motion: Motion<'a>,
    ) -> MovedBlock<'a, N, P, F::Reference> {
        match motion.start {
            None => self.at(number, motion),
            Some(start) => self.between(number, start, motion),
        }
    }

    /// A block at the end of a motion.
    #[inline(always)]
    fn at<'a>(&'a self, number: usize, motion: Motion<'a>) -> MovedBlock<'a, N, P, F::Reference> {
        let end = self.gather(&self.blocks[number], motion.end);
        self.with(number, BlockMotion::At(end), motion.committed)
    }

    /// A block between the displacements at the start and at the end of a motion.
    #[inline(always)]
    fn between<'a>(
        &'a self,
        number: usize,
        start: &[f64],
        motion: Motion<'a>,
    ) -> MovedBlock<'a, N, P, F::Reference> {
        let block = &self.blocks[number];
        let (start, end) = (self.gather(block, start), self.gather(block, motion.end));
        self.with(number, BlockMotion::between(&start, &end), motion.committed)
    }

    #[inline(always)]
    fn with<'a>(
        &'a self,
        number: usize,
        motion: BlockMotion<N>,
        committed: &'a [f64],
    ) -> MovedBlock<'a, N, P, F::Reference> {
        MovedBlock {
            block: &self.blocks[number],
            over_radius: &self.over_radius[if HOOP { number } else { 0 }],
            reference: &self.references[number],
            motion,
            own_variables: match self.layout.own {
                0 => [&[]; LANES],
                _ => self
                    .variables_of(committed, number)
                    .map(|all| all.get(self.layout.of_points..).unwrap_or_default()),
            },
        }
    }

    /// Adds the forces of all blocks to the sums: the forces of the material or of its viscosity.
    fn sweep(&self, motion: Motion, viscosity: Option<&Viscosity>) -> Positive {
        let mut sums = self.sums.lock().unwrap_or_else(PoisonError::into_inner);
        if !self.is_strained(motion) {
            return Positive::default();
        }
        let is_for_each_law = F::FOR_EACH_LAW && !self.is_heated(motion);
        match (&self.law, viscosity) {
            (PlaneLaw::SaintVenantKirchhoff(law), None) if is_for_each_law => {
                self.add_elastic(motion, &Elastic(law), &mut sums)
            }
            (PlaneLaw::NeoHooke(law), None) if is_for_each_law => {
                self.add_elastic(motion, &Elastic(law), &mut sums)
            }
            _ => {
                let mut positive = Positive::default();
                for number in 0..self.blocks.len() {
                    let at = self.moved(number, motion);
                    let law = self.law_of(number, motion);
                    let of_block = match viscosity {
                        Some(viscosity) => Self::force(&at, viscosity),
                        None => Self::force(&at, law.any()),
                    };
                    positive = positive.both(add_force(&at, &of_block, &mut sums));
                }
                positive
            }
        }
    }

    /// Adds the forces of all blocks, by a law without internal variables, to the sums.
    fn add_elastic(
        &self,
        motion: Motion,
        law: &impl StressAtPoints<Lanes, HOOP>,
        sums: &mut [[f64; 2]],
    ) -> Positive {
        let mut positive = Positive::default();
        for number in 0..self.blocks.len() {
            let at = self.moved(number, motion);
            let of_block = F::force::<S>(&at, law);
            positive = positive.both(add_force(&at, &of_block, sums));
        }
        positive
    }

    /// The force by any law, and whether det F is positive; the function is compiled only once.
    #[inline(never)]
    fn force(at: &MovedBlock<N, P, F::Reference>, law: &AnyLaw<HOOP>) -> (NodalLanes<N>, Positive) {
        F::force::<S>(at, law)
    }

    /// The results of points by any law; the function is compiled only once.
    #[inline(never)]
    fn results(at: &MovedBlock<N, P, F::Reference>, law: &AnyLaw<HOOP>) -> [ResultPoint; P] {
        F::results::<S>(at, law)
    }

    /// The law of a block in a motion, with the variables of its points, which are a part of the variables of all
    /// elements.
    fn law_of<'a>(&'a self, block: usize, motion: Motion<'a>) -> LawInLanes<'a> {
        self.law_with(block, motion, self.of_points(motion.committed, block))
    }

    /// The law of a block at the temperatures of a motion, with the variables of its points.
    fn law_with<'a>(
        &'a self,
        block: usize,
        motion: Motion,
        variables: [&'a [f64]; LANES],
    ) -> LawInLanes<'a> {
        match &self.heating {
            Some(heating) if !motion.temperature.is_empty() => {
                let strains = self.thermal_strains(heating, block, motion.temperature);
                self.law.expanded(variables, heating.plane, &strains)
            }
            _ => self.law.in_lanes(variables),
        }
    }

    /// Thermal strains at the points of a block.
    fn thermal_strains(
        &self,
        heating: &Heating<P>,
        block: usize,
        temperature: &[f64],
    ) -> [Lanes; P] {
        let nodes = &self.blocks[block].nodes;
        let at_points =
            temperatures::<S, N, P>(|a, lane| temperature[self.nodes[usize::from(nodes[a][lane])]]);
        let initial = &heating.initial[block];
        from_fn(|p| {
            Lanes::of_lanes(|lane| {
                heating
                    .expansion
                    .strain(initial[p].lane(lane), at_points[p].lane(lane))
            })
        })
    }

    /// Whether the elements expand in a motion.
    fn is_heated(&self, motion: Motion) -> bool {
        self.heating.is_some() && !motion.temperature.is_empty()
    }

    /// Whether an element may be strained: its nodes have different displacements or move along the radius, or the
    /// material is heated or has internal variables. For example, no element of a fixed body is strained.
    fn is_strained(&self, motion: Motion) -> bool {
        let differs = |u: &[f64]| {
            let u = u.as_chunks::<2>().0;
            let first = u[self.nodes[0]];
            let mut others = self.nodes.iter().map(|&node| u[node]);
            let is_wider = HOOP && first[0] != 0.0;
            is_wider || others.any(|u| u[0] - first[0] != 0.0 || u[1] - first[1] != 0.0)
        };
        self.layout.of_points > 0
            || self.is_heated(motion)
            || differs(motion.end)
            || motion.start.is_some_and(differs)
    }

    /// Entries of a vector over all dofs at the nodes of a block.
    #[inline(always)]
    fn gather(&self, block: &ElementBlock<N, P>, u: &[f64]) -> NodalLanes<N> {
        let u = u.as_chunks::<2>().0;
        let mut values = [[Lanes::ZERO; N]; 2];
        for (a, places) in block.nodes.iter().enumerate() {
            let u = places.map(|place| u[self.nodes[usize::from(place)]]);
            values[0][a] = Lanes(u.map(|[x, _]| x));
            values[1][a] = Lanes(u.map(|[_, y]| y));
        }
        values
    }

    /// Indices of the elements of a block.
    fn elements_of(&self, block: usize) -> &[usize] {
        let first = LANES * block;
        &self.elements[first..(first + LANES).min(self.elements.len())]
    }

    /// Writes the tangents of the elements of a block.
    fn write_tangents(&self, number: usize, sweep: &TangentSweep, tangents: &mut [f64]) {
        let law = self.law_of(number, sweep.motion);
        let law: &AnyLaw<HOOP> = match &self.viscosity {
            Some(viscosity) if sweep.viscous => viscosity,
            _ => law.any(),
        };
        let mut k = [[[[Lanes::ZERO; 2]; 2]; N]; N];
        F::add_tangent::<S>(&self.moved(number, sweep.motion), law, &mut k);
        for (lane, matrix) in tangents.chunks_exact_mut(4 * N * N).enumerate() {
            write_matrix(lane, &k, matrix);
        }
        if sweep.part == TangentPart::Positive {
            for matrix in tangents.chunks_exact_mut(4 * N * N) {
                take_positive_part(matrix, 2 * N);
            }
        }
    }
}

impl<const N: usize, const P: usize, const HOOP: bool, S, F> Chunk for ShapeChunk<N, P, HOOP, S, F>
where
    S: IntegratedShape<N, P> + Send + Sync,
    F: Formulation<N, P, HOOP>,
{
    fn elements(&self) -> &[usize] {
        &self.elements
    }

    fn variables(&self) -> Range<usize> {
        let count = self.elements.len() * self.layout.count();
        self.first_variable..self.first_variable + count
    }

    fn sum_forces(&self, motion: Motion) -> bool {
        self.sweep(motion, None).everywhere()
    }

    fn is_viscous(&self) -> bool {
        self.viscosity.is_some()
    }

    fn sum_viscous(&self, motion: Motion) {
        if self.is_viscous() {
            self.sweep(motion, self.viscosity.as_ref());
        }
    }

    fn viscous_work(&self, motion: Motion) -> f64 {
        let Some(viscosity) = &self.viscosity else {
            return 0.0;
        };
        let mut work = 0.0;
        for number in 0..self.blocks.len() {
            let of_block = F::work::<S>(&self.moved(number, motion), viscosity);
            work += of_block.0[..self.elements_of(number).len()]
                .iter()
                .sum::<f64>();
        }
        work
    }

    fn add_sums(&self, total: &mut [f64]) {
        let mut sums = self.sums.lock().unwrap_or_else(PoisonError::into_inner);
        let (sums, unused) = sums.split_at_mut(self.node_count);
        let total = total.as_chunks_mut::<2>().0;
        for (&node, sum) in self.nodes.iter().zip(sums) {
            let [x, y] = std::mem::take(sum);
            total[node][0] += x;
            total[node][1] += y;
        }
        unused.fill([0.0; 2]);
    }

    fn clear_sums(&self) {
        let mut sums = self.sums.lock().unwrap_or_else(PoisonError::into_inner);
        sums.fill([0.0; 2]);
    }

    fn determinants(&self, motion: Motion) -> Vec<f64> {
        let mut all = Vec::with_capacity(self.elements.len());
        for number in 0..self.blocks.len() {
            let at = self.moved(number, motion);
            let least = at.least_determinant::<S, HOOP>();
            let law = self.law_of(number, motion);
            let positive = Self::force(&at, law.any()).1;
            for lane in 0..self.elements_of(number).len() {
                all.push(match positive.at(lane) {
                    false if least[lane] > 0.0 => f64::NAN,
                    _ => least[lane],
                });
            }
        }
        all
    }

    fn expands(&self) -> bool {
        self.heating.is_some()
    }

    fn evaluate(&self, motion: Motion) -> Vec<ElementResult> {
        let mut results = Vec::with_capacity(self.elements.len());
        for number in 0..self.blocks.len() {
            let (at, law) = (self.moved(number, motion), self.law_of(number, motion));
            let (points, mut sums) = (Self::results(&at, law.any()), Sums::new());
            for (p, point) in points[..F::POINTS].iter().enumerate() {
                sums.add::<HOOP>(p, law.any(), point, point.weight);
            }
            let of_modes = F::hourglass_energy::<S>(&at, law.any());
            for lane in 0..self.elements_of(number).len() {
                let mut result = sums.result(lane);
                result.hourglass_energy = of_modes.0[lane];
                result.energy += result.hourglass_energy;
                results.push(result);
            }
        }
        results
    }

    fn at_points(&self, place: usize, motion: Motion) -> SmallVec<[PointResult; 9]> {
        let (number, lane) = (place / LANES, place % LANES);
        let (at, law) = (self.moved(number, motion), self.law_of(number, motion));
        let points = Self::results(&at, law.any());
        let of = |p: usize| {
            let mut sums = Sums::new();
            sums.add::<HOOP>(p, law.any(), &points[p], Lanes::all(1.0));
            PointResult {
                result: sums.result(lane),
                gradient: points[p].gradient.h.map(|row| row.map(|h| h.0[lane])),
            }
        };
        (0..F::POINTS).map(of).collect()
    }

    fn update(&self, motion: Motion, updated: &mut [f64]) -> f64 {
        if self.layout.count() == 0 {
            return 0.0;
        }
        let (count, mut dissipated) = (self.layout.count(), 0.0);
        for number in 0..self.blocks.len() {
            let at = self.moved(number, motion);
            let z0 = self.of_points(motion.committed, number);
            let mut z1 = z0.map(<[f64]>::to_vec);
            let mut own = at.own_variables.map(<[f64]>::to_vec);
            let with = |z| self.law_with(number, motion, z);
            let law = self.law_with(number, motion, z0);
            let of_block = F::update::<S>(&at, law.any(), with, (&mut z1, &mut own));
            for (lane, _) in self.elements_of(number).iter().enumerate() {
                let first = self.first_variable + (LANES * number + lane) * count;
                let (points, rest) = updated[first..first + count].split_at_mut(z1[lane].len());
                points.copy_from_slice(&z1[lane]);
                rest.copy_from_slice(&own[lane]);
                dissipated += of_block.0[lane];
            }
        }
        dissipated
    }

    fn tangent(&self, place: usize, motion: Motion) -> Vec<f64> {
        let sweep = TangentSweep {
            motion,
            part: TangentPart::Whole,
            viscous: false,
            wanted: &|_| true,
        };
        let mut all = vec![0.0; LANES * 4 * N * N];
        self.write_tangents(place / LANES, &sweep, &mut all);
        all[place % LANES * 4 * N * N..][..4 * N * N].to_vec()
    }

    fn for_each_tangent(
        &self,
        sweep: TangentSweep,
        space: &mut Vec<f64>,
        add: &mut dyn FnMut(usize, &[f64]),
    ) {
        let wanted = |number: &usize| self.elements_of(*number).iter().any(|&e| (sweep.wanted)(e));
        let of_block = LANES * 4 * N * N;
        let mut add_block = |number: usize, tangents: &[f64]| {
            for (&element, k) in self
                .elements_of(number)
                .iter()
                .zip(tangents.chunks_exact(4 * N * N))
            {
                add(element, k);
            }
        };
        let all = 0..self.blocks.len();
        if rayon::current_num_threads() > 1 {
            space.resize(self.blocks.len() * of_block, 0.0);
            let blocks = space.par_chunks_exact_mut(of_block);
            let pairs = all.clone().into_par_iter().zip(blocks);
            let pairs = pairs.with_min_len(PARALLEL_BLOCKS);
            pairs
                .filter(|(number, _)| wanted(number))
                .for_each(|(number, k)| self.write_tangents(number, &sweep, k));
            all.filter(wanted)
                .for_each(|number| add_block(number, &space[number * of_block..][..of_block]));
        } else {
            space.resize(of_block, 0.0);
            for number in all.filter(wanted) {
                self.write_tangents(number, &sweep, space);
                add_block(number, space);
            }
        }
    }
}

/// Adds the internal forces of a block to sums over the nodes of a chunk, and returns whether det F is positive.
#[inline(always)]
fn add_force<const N: usize, const P: usize, R>(
    at: &MovedBlock<N, P, R>,
    (force, positive): &(NodalLanes<N>, Positive),
    sums: &mut [[f64; 2]],
) -> Positive {
    for (a, places) in at.block.nodes.iter().enumerate() {
        for (lane, &place) in places.iter().enumerate() {
            let [x, y] = sums[usize::from(place)];
            sums[usize::from(place)] = [x + force[0][a].0[lane], y + force[1][a].0[lane]];
        }
    }
    *positive
}

/// Temperatures at the points, from the temperatures of the nodes of every element. For linear elements the temperature
/// is the mean over the nodes; for quadratic elements it is the linear or bilinear field between the corners. The
/// strains of the displacements have the same degrees.
fn temperatures<S: IntegratedShape<N, P>, const N: usize, const P: usize>(
    of: impl Fn(usize, usize) -> f64,
) -> [Lanes; P] {
    let mut nodal: [Lanes; N] = from_fn(|a| Lanes::of_lanes(|lane| of(a, lane)));
    let corners = if N > 4 { N / 2 } else { N };
    if N == corners {
        let sum = nodal.iter().fold(Lanes::ZERO, |sum, value| sum + *value);
        return [sum * (1.0 / N as f64); P];
    }
    for side in 0..corners {
        nodal[corners + side] = (nodal[side] + nodal[(side + 1) % corners]) * 0.5;
    }
    from_fn(|p| S::value(p, &nodal))
}

/// Place of a node in the list of a chunk, which has at most [`MAX_CHUNK`] elements.
fn place(nodes: &[usize], node: usize) -> u16 {
    nodes.partition_point(|&other| other < node) as u16
}

/// Writes the symmetric matrix of one element; the lanes contain only the entries [a][b] with a <= b.
fn write_matrix<const N: usize>(lane: usize, k: &MatrixLanes<N>, matrix: &mut [f64]) {
    for b in 0..N {
        for a in 0..b + 1 {
            for i in 0..2 {
                for j in 0..2 {
                    let (row, column) = (2 * a + i, 2 * b + j);
                    let entry = k[a][b][i][j].0[lane];
                    matrix[column * 2 * N + row] = entry;
                    matrix[row * 2 * N + column] = entry;
                }
            }
        }
    }
}
