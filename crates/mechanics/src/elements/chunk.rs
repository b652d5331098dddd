//! Chunks: elements of one shape and material in blocks, with the nodes that they share. What a chunk
//! reads and adds to fits the first caches, and chunks are swept on any number of threads.

// Loops over points, nodes and directions: indices are those of the formulas.
#![allow(clippy::needless_range_loop)]

use std::array::from_fn;
use std::marker::PhantomData;
use std::sync::{Mutex, PoisonError};

use nalgebra::SMatrix;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::block::{
    BlockFormulation, BlockMotion, ElementBlock, IntegratedShape, MatrixLanes, NodalLanes,
    PlacedBlock,
};
use super::formulation::ElementResult;
use super::solid::{Motion, TangentPart, take_positive_part};
use crate::materials::number::{LANES, Positive};
use crate::materials::{Lanes, PlaneLaw, StressAtPoints, Viscosity, in_lanes};
use crate::model::Thickness;

/// Elements of a chunk at most.
pub const MAX_CHUNK: usize = 1024;

/// Blocks whose tangents are not worth a second thread.
const PARALLEL_BLOCKS: usize = 64;

/// A sweep over tangents.
#[derive(Clone, Copy)]
pub struct TangentSweep<'a> {
    pub motion: Motion<'a>,
    pub part: TangentPart,
    /// Whether the stress is that of the viscosity.
    pub viscous: bool,
    /// Whether the tangent of an element is needed.
    pub wanted: &'a (dyn Fn(usize) -> bool + Sync),
}

/// Elements that are swept together.
pub trait Chunk: Send + Sync {
    /// Adds the internal forces of the elements at the end of a motion, or in its energy-momentum form, to the
    /// sums. False where an element is turned inside out.
    fn sum_forces(&self, motion: Motion) -> bool;

    /// Whether the material has viscosity.
    fn is_viscous(&self) -> bool;

    /// Adds the forces of the viscosity in a motion, over the length of the increment, to the sums, eq. (4.16).
    fn sum_viscous(&self, motion: Motion);

    /// Adds the sums to a vector over all dofs, and makes them zero.
    fn add_sums(&self, total: &mut [f64]);

    /// Makes the sums zero.
    fn clear_sums(&self);

    /// Elements (indices) with strain energy, stress and strain at displacements `u`.
    fn evaluate(&self, u: &[f64]) -> Vec<(usize, ElementResult)>;

    /// Calls `add(element, k)` with the tangent of every element that is wanted or in a block with one, D x
    /// D column by column. The tangents are made in `space`: those of the whole chunk in parallel where there are
    /// threads.
    fn for_each_tangent(
        &self,
        sweep: TangentSweep,
        space: &mut Vec<f64>,
        add: &mut dyn FnMut(usize, &[f64]),
    );
}

/// Elements of one shape, formulation and material.
pub struct ShapeChunk<const N: usize, const P: usize, const HOOP: bool, S, F> {
    /// Elements (indices), lane after lane and block after block.
    elements: Vec<usize>,
    /// Node indices, increasing; blocks have places in this list.
    nodes: Vec<usize>,
    /// Blocks; places of the last that no element fills have the last element with no volume.
    blocks: Vec<ElementBlock<N, P>>,
    /// 1/R at the points of every block; zeros for all blocks of the plane (1/length).
    over_radius: Vec<[Lanes; P]>,
    law: PlaneLaw,
    viscosity: Option<Viscosity>,
    /// Sums of the last sweep over the nodes, zero once they have been read; locked by the thread that makes or reads
    /// them.
    sums: Mutex<Vec<[f64; 2]>>,
    kind: PhantomData<(S, F)>,
}

impl<const N: usize, const P: usize, const HOOP: bool, S, F> ShapeChunk<N, P, HOOP, S, F>
where
    S: IntegratedShape<N, P> + Sync,
    F: BlockFormulation<HOOP> + Sync,
{
    /// A chunk of elements (indices) with their nodes, between nodes at the coordinates `x`, of the
    /// thickness given.
    pub fn new(
        elements: Vec<usize>,
        of: &[[usize; N]],
        x: &[[f64; 2]],
        thickness: Thickness,
        (law, viscosity): (PlaneLaw, Option<Viscosity>),
    ) -> Self {
        let mut nodes: Vec<usize> = of.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let block = |first: usize| {
            let at = |lane: usize| (first + lane).min(of.len() - 1);
            let places = from_fn(|lane| of[at(lane)].map(|node| place(&nodes, node)));
            let maps = from_fn(|lane| {
                let x = SMatrix::from_fn(|i, a| x[of[at(lane)][a]][i]);
                let is_there = f64::from(u8::from(first + lane < of.len()));
                match thickness {
                    Thickness::Of(t) => S::map(&x, t * is_there),
                    Thickness::Around => {
                        let radii = radii::<S, N, P>(&x);
                        let mut map = S::map(&x, is_there);
                        for (at, radius) in map.iter_mut().zip(radii) {
                            at.volume *= thickness.at(radius);
                        }
                        map
                    }
                }
            });
            ElementBlock::new(places, &maps)
        };
        let over_radius = |first: usize| {
            let radii: [[f64; P]; LANES] = from_fn(|lane| {
                let element = &of[(first + lane).min(of.len() - 1)];
                radii::<S, N, P>(&SMatrix::from_fn(|i, a| x[element[a]][i]))
            });
            from_fn(|p| Lanes(from_fn(|lane| 1.0 / radii[lane][p])))
        };
        ShapeChunk {
            over_radius: match HOOP {
                true => (0..of.len()).step_by(LANES).map(over_radius).collect(),
                false => vec![[Lanes::ZERO; P]],
            },
            blocks: (0..of.len()).step_by(LANES).map(block).collect(),
            sums: Mutex::new(vec![[0.0; 2]; nodes.len()]),
            elements,
            nodes,
            law,
            viscosity,
            kind: PhantomData,
        }
    }

    /// A block with the places of its points.
    #[inline(always)]
    fn placed(&self, number: usize) -> PlacedBlock<'_, N, P> {
        PlacedBlock {
            block: &self.blocks[number],
            over_radius: &self.over_radius[if HOOP { number } else { 0 }],
        }
    }

    /// Writes the tangents of the elements of a block.
    fn write_tangents(&self, number: usize, sweep: &TangentSweep, tangents: &mut [f64]) {
        match &self.viscosity {
            Some(viscosity) if sweep.viscous => {
                self.write_tangents_of(viscosity, number, sweep.motion, tangents);
            }
            _ => in_lanes!(&self.law, law => {
                self.write_tangents_of(law, number, sweep.motion, tangents)
            }),
        }
        if sweep.part == TangentPart::Positive {
            for matrix in tangents.chunks_exact_mut(4 * N * N) {
                take_positive_part(matrix, 2 * N);
            }
        }
    }

    fn write_tangents_of(
        &self,
        law: &impl StressAtPoints<Lanes, HOOP>,
        number: usize,
        motion: Motion,
        tangents: &mut [f64],
    ) {
        Arch::new().dispatch(Tangents {
            chunk: self,
            law,
            placed: self.placed(number),
            motion,
            tangents,
        });
    }

    /// Whether some nodes move otherwise than the others. If none does no element is strained, as in
    /// bodies that are fixed.
    fn is_strained(&self, motion: Motion) -> bool {
        let differs = |u: &[f64]| {
            let u = u.as_chunks::<2>().0;
            let first = u[self.nodes[0]];
            let mut others = self.nodes.iter().map(|&node| u[node]);
            others.any(|u| u[0] - first[0] != 0.0 || u[1] - first[1] != 0.0)
        };
        differs(motion.end) || motion.start.is_some_and(differs)
    }

    /// Adds the forces of all blocks, each in the motion that `motion` gives.
    #[inline(always)]
    fn sweep(
        &self,
        sums: &mut [[f64; 2]],
        law: &impl StressAtPoints<Lanes, HOOP>,
        motion: impl Fn(&ElementBlock<N, P>) -> BlockMotion<N>,
    ) -> Positive {
        let mut positive = Positive::default();
        for (number, block) in self.blocks.iter().enumerate() {
            let placed = self.placed(number);
            let (force, of_block) = F::force::<S, N, P>(&placed, law, &motion(block));
            positive = positive.both(of_block);
            for (a, places) in block.nodes.iter().enumerate() {
                for (lane, &place) in places.iter().enumerate() {
                    let [x, y] = sums[usize::from(place)];
                    sums[usize::from(place)] = [x + force[0][a].0[lane], y + force[1][a].0[lane]];
                }
            }
        }
        positive
    }

    #[inline(always)]
    fn at(&self, block: &ElementBlock<N, P>, u: &[f64]) -> BlockMotion<N> {
        BlockMotion::At(self.gather(block, u))
    }

    #[inline(always)]
    fn between(&self, block: &ElementBlock<N, P>, u: [&[f64]; 2]) -> BlockMotion<N> {
        BlockMotion::between(&self.gather(block, u[0]), &self.gather(block, u[1]))
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
}

impl<const N: usize, const P: usize, const HOOP: bool, S, F> Chunk for ShapeChunk<N, P, HOOP, S, F>
where
    S: IntegratedShape<N, P> + Send + Sync,
    F: BlockFormulation<HOOP> + Send + Sync,
{
    fn sum_forces(&self, motion: Motion) -> bool {
        let mut sums = self.sums.lock().unwrap_or_else(PoisonError::into_inner);
        if !self.is_strained(motion) {
            return true;
        }
        let positive = in_lanes!(&self.law, law => Arch::new().dispatch(ForceSweep {
            chunk: self,
            law,
            motion,
            sums: &mut sums,
        }));
        positive.everywhere()
    }

    fn is_viscous(&self) -> bool {
        self.viscosity.is_some()
    }

    fn sum_viscous(&self, motion: Motion) {
        let mut sums = self.sums.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(law) = self.viscosity.as_ref().filter(|_| self.is_strained(motion)) {
            Arch::new().dispatch(ForceSweep {
                chunk: self,
                law,
                motion,
                sums: &mut sums,
            });
        }
    }

    fn add_sums(&self, total: &mut [f64]) {
        let mut sums = self.sums.lock().unwrap_or_else(PoisonError::into_inner);
        let total = total.as_chunks_mut::<2>().0;
        for (&node, sum) in self.nodes.iter().zip(sums.iter_mut()) {
            let [x, y] = std::mem::take(sum);
            total[node][0] += x;
            total[node][1] += y;
        }
    }

    fn clear_sums(&self) {
        let mut sums = self.sums.lock().unwrap_or_else(PoisonError::into_inner);
        sums.fill([0.0; 2]);
    }

    fn evaluate(&self, u: &[f64]) -> Vec<(usize, ElementResult)> {
        in_lanes!(&self.law, law => Arch::new().dispatch(Evaluation { chunk: self, law, u }))
    }

    fn for_each_tangent(
        &self,
        sweep: TangentSweep,
        space: &mut Vec<f64>,
        add: &mut dyn FnMut(usize, &[f64]),
    ) {
        let elements = |number: usize| {
            let first = LANES * number;
            &self.elements[first..(first + LANES).min(self.elements.len())]
        };
        let wanted = |number: &usize| elements(*number).iter().any(|&e| (sweep.wanted)(e));
        let of_block = LANES * 4 * N * N;
        let mut add_block = |number: usize, tangents: &[f64]| {
            for (&element, k) in elements(number)
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

/// A sweep over internal forces with the vector instructions of the processor.
struct ForceSweep<'a, const N: usize, const P: usize, const HOOP: bool, S, F, L> {
    chunk: &'a ShapeChunk<N, P, HOOP, S, F>,
    law: &'a L,
    motion: Motion<'a>,
    sums: &'a mut [[f64; 2]],
}

impl<const N: usize, const P: usize, const HOOP: bool, S, F, L> WithSimd
    for ForceSweep<'_, N, P, HOOP, S, F, L>
where
    S: IntegratedShape<N, P> + Sync,
    F: BlockFormulation<HOOP> + Sync,
    L: StressAtPoints<Lanes, HOOP>,
{
    type Output = Positive;

    #[inline(always)]
    fn with_simd<V: Simd>(self, _: V) -> Positive {
        let Self {
            chunk, law, sums, ..
        } = self;
        let end = self.motion.end;
        match self.motion.start {
            None => chunk.sweep(sums, law, |block| chunk.at(block, end)),
            Some(start) => chunk.sweep(sums, law, |block| chunk.between(block, [start, end])),
        }
    }
}

/// Results of all elements with the vector instructions of the processor.
struct Evaluation<'a, const N: usize, const P: usize, const HOOP: bool, S, F, L> {
    chunk: &'a ShapeChunk<N, P, HOOP, S, F>,
    law: &'a L,
    u: &'a [f64],
}

impl<const N: usize, const P: usize, const HOOP: bool, S, F, L> WithSimd
    for Evaluation<'_, N, P, HOOP, S, F, L>
where
    S: IntegratedShape<N, P> + Sync,
    F: BlockFormulation<HOOP> + Sync,
    L: StressAtPoints<Lanes, HOOP>,
{
    type Output = Vec<(usize, ElementResult)>;

    #[inline(always)]
    fn with_simd<V: Simd>(self, _: V) -> Self::Output {
        let Self { chunk, law, u } = self;
        let mut results = Vec::with_capacity(chunk.elements.len());
        for (number, elements) in chunk.elements.chunks(LANES).enumerate() {
            let placed = chunk.placed(number);
            let of_block = F::evaluate::<S, N, P>(&placed, law, &chunk.at(placed.block, u));
            results.extend(elements.iter().copied().zip(of_block));
        }
        results
    }
}

/// Tangents of a block with the vector instructions of the processor.
struct Tangents<'a, const N: usize, const P: usize, const HOOP: bool, S, F, L> {
    chunk: &'a ShapeChunk<N, P, HOOP, S, F>,
    law: &'a L,
    placed: PlacedBlock<'a, N, P>,
    motion: Motion<'a>,
    /// Those of its elements, D x D column by column each.
    tangents: &'a mut [f64],
}

impl<const N: usize, const P: usize, const HOOP: bool, S, F, L> WithSimd
    for Tangents<'_, N, P, HOOP, S, F, L>
where
    S: IntegratedShape<N, P> + Sync,
    F: BlockFormulation<HOOP> + Sync,
    L: StressAtPoints<Lanes, HOOP>,
{
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, _: V) {
        let Self {
            chunk, law, placed, ..
        } = self;
        let block = placed.block;
        let (mut k, end) = ([[[[Lanes::ZERO; 2]; 2]; N]; N], self.motion.end);
        match self.motion.start {
            None => F::add_tangent::<S, N, P>(&placed, law, &chunk.at(block, end), &mut k),
            Some(start) => {
                let motion = chunk.between(block, [start, end]);
                F::add_tangent::<S, N, P>(&placed, law, &motion, &mut k);
            }
        }
        let matrices = self.tangents.chunks_exact_mut(4 * N * N);
        for (lane, matrix) in matrices.enumerate() {
            write_matrix(lane, &k, matrix);
        }
    }
}

/// Distances of the points from the axis, of an element between nodes at `x` (length).
fn radii<S: IntegratedShape<N, P>, const N: usize, const P: usize>(
    x: &SMatrix<f64, 2, N>,
) -> [f64; P] {
    S::FUNCTIONS
        .values
        .map(|h| (0..N).map(|a| h[a] * x[(0, a)]).sum())
}

/// Place of a node in the list of a chunk, which has at most [`MAX_CHUNK`] elements.
fn place(nodes: &[usize], node: usize) -> u16 {
    nodes.partition_point(|&other| other < node) as u16
}

/// Writes the symmetric matrix of one element of which the lanes have the entries [a][b] with a <= b.
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
