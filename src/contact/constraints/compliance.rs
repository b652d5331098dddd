//! Compliance at the contacts: the entries of an inverse W that the Delassus operator
//! Q = G T W T^T B^T needs, W being K*^-1 in a pass and M^-1 for impulses. Sections 5 and 6 of
//! docs/theory.md.

use super::constraint::{Constraint, Rows};
use crate::linear::{CheckedSolver, LinearError, Rotation, Transformation};

/// The inverse of a factorised matrix at the unknowns that constraints act on, a block for each connected
/// group of unknowns: it is zero between them.
///
/// It is computed when constraints first need it and kept until the matrix changes, so that a Delassus
/// matrix for any normals costs no further solves.
#[derive(Debug)]
pub struct Compliance {
    /// T: what unknowns the dofs depend on.
    map: Transformation,
    /// R of the bodies since the matrix was factorised.
    rotation: Rotation,
    /// Connected group of every unknown.
    groups: Vec<usize>,
    /// Row of every unknown in the block of its group, where it has been computed.
    place: Vec<Option<usize>>,
    /// Blocks of the groups; empty ones where no constraint has acted.
    blocks: Vec<Block>,
}

/// The inverse at some unknowns of a group.
#[derive(Debug, Clone, Default)]
struct Block {
    /// Unknowns of the rows, increasing.
    unknowns: Vec<usize>,
    /// Column by column.
    inverse: Vec<f64>,
}

/// The rows of a constraint at one unknown.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnknownEntry {
    /// Row of the inverse, in the block of the group.
    place: usize,
    /// Its group.
    pub group: usize,
    /// Entries of Bn T and Bt T.
    force: [f64; 2],
    /// Entries of Gn T and Gt T.
    derivative: [f64; 2],
}

/// The rows of some constraints at the unknowns of one group.
#[derive(Default)]
pub(super) struct GroupRows {
    /// The constraints, increasing, each with the end of its entries.
    pub members: Vec<(usize, usize)>,
    entries: Vec<UnknownEntry>,
}

impl GroupRows {
    /// Adds an entry of a constraint, which is the last one or comes after it.
    pub fn push(&mut self, constraint: usize, entry: UnknownEntry) {
        self.entries.push(entry);
        let end = self.entries.len();
        match self.members.last_mut() {
            Some((last, at)) if *last == constraint => *at = end,
            _ => self.members.push((constraint, end)),
        }
    }

    /// Entries of the constraints with their numbers, one constraint after the other.
    #[inline(always)]
    pub fn iter(&self) -> impl Iterator<Item = (usize, &[UnknownEntry])> {
        let mut start = 0;
        self.members.iter().map(move |&(constraint, end)| {
            let entries = &self.entries[start..end];
            start = end;
            (constraint, entries)
        })
    }
}

impl Compliance {
    /// Compliance for the unknowns that all dofs depend on, and the connected groups of the
    /// unknowns.
    pub fn new(map: Transformation, groups: Vec<usize>) -> Self {
        let mut compliance = Compliance {
            map,
            rotation: Rotation::default(),
            groups: Vec::new(),
            place: Vec::new(),
            blocks: Vec::new(),
        };
        compliance.renew(groups);
        compliance
    }

    /// Forgets the inverse: the matrix has changed, and with it, perhaps, the connected groups.
    pub fn renew(&mut self, groups: Vec<usize>) {
        let count = groups.iter().max().map_or(0, |last| last + 1);
        self.groups = groups;
        self.rotation = Rotation::default();
        self.place.clear();
        self.place.resize(self.map.unknowns(), None);
        self.blocks.clear();
        self.blocks.resize(count, Block::default());
    }

    /// Turns W with the bodies, to R W R^T, since the matrix was factorised.
    pub fn turn(&mut self, rotation: Rotation) {
        self.rotation = rotation;
    }

    /// R of the bodies since the matrix was factorised.
    pub fn rotation(&self) -> &Rotation {
        &self.rotation
    }

    /// Computes the inverse at the unknowns of `constraints` too, if some are missing.
    ///
    /// # Errors
    /// What the solver says.
    pub fn prepare(
        &mut self,
        constraints: &[&Constraint],
        solver: &mut CheckedSolver,
    ) -> Result<(), LinearError> {
        let dofs = constraints.iter().flat_map(|constraint| &constraint.dofs);
        let terms = dofs.flat_map(|&dof| self.map.row(dof));
        let missing = |unknown: &usize| self.place[*unknown].is_none();
        let missing: Vec<usize> = terms.map(|term| term.0).filter(missing).collect();
        if missing.is_empty() {
            return Ok(());
        }
        let mut renewed: Vec<usize> = missing
            .iter()
            .map(|&unknown| self.groups[unknown])
            .collect();
        renewed.sort_unstable();
        renewed.dedup();
        for unknown in missing {
            self.blocks[self.groups[unknown]].unknowns.push(unknown);
        }
        for &group in &renewed {
            self.blocks[group].unknowns.sort_unstable();
            self.blocks[group].unknowns.dedup();
        }
        let unknowns: Vec<&[usize]> = renewed
            .iter()
            .map(|&g| self.blocks[g].unknowns.as_slice())
            .collect();
        let inverses = solver.inverse_at(&unknowns)?;
        for (&group, inverse) in renewed.iter().zip(inverses) {
            let block = &mut self.blocks[group];
            block.inverse = inverse;
            for (place, &unknown) in block.unknowns.iter().enumerate() {
                self.place[unknown] = Some(place);
            }
        }
        Ok(())
    }

    /// T: what unknowns the dofs depend on.
    pub fn map(&self) -> &Transformation {
        &self.map
    }

    /// Entries of the rows of a constraint, turned back with R^T, that are not all zero; it must have
    /// been prepared.
    pub(super) fn entries(&self, constraint: &Constraint) -> Vec<UnknownEntry> {
        let rows = [&constraint.force_rows, constraint.derivative_rows()];
        let rows = rows.map(|rows| self.turned_back(&constraint.dofs, rows));
        let mut entries = Vec::with_capacity(constraint.dofs.len());
        for (k, &dof) in constraint.dofs.iter().enumerate() {
            let [force, derivative] =
                (rows.each_ref()).map(|rows| [rows.normal[k], rows.tangential[k]]);
            if force == [0.0; 2] && derivative == [0.0; 2] {
                continue;
            }
            for &(unknown, c) in self.map.row(dof) {
                if let Some(place) = self.place[unknown] {
                    entries.push(UnknownEntry {
                        place,
                        group: self.groups[unknown],
                        force: force.map(|entry| c * entry),
                        derivative: derivative.map(|entry| c * entry),
                    });
                }
            }
        }
        entries
    }

    /// Rows times R, over the dofs of a constraint, eq. (4.20).
    fn turned_back(&self, dofs: &[usize], rows: &Rows) -> Rows {
        let mut turned = rows.clone();
        self.rotation.turn_row(dofs, &mut turned.normal);
        self.rotation.turn_row(dofs, &mut turned.tangential);
        turned
    }

    /// Number of groups.
    pub(super) fn groups(&self) -> usize {
        self.blocks.len()
    }

    /// W (B_q T)^T of eq. (5.1) in the rows of a group: what normal and tangential force of q do to its
    /// unknowns.
    #[inline(always)]
    pub(super) fn response<'r>(
        &self,
        group: usize,
        q: &[UnknownEntry],
        response: &'r mut Response,
    ) -> &'r [[f64; 2]] {
        let Block { unknowns, inverse } = &self.blocks[group];
        let size = unknowns.len();
        let Response { to_forces, both } = response;
        for y in to_forces.iter_mut() {
            y.clear();
            y.resize(size, 0.0);
        }
        for entry in q {
            let column = &inverse[entry.place * size..(entry.place + 1) * size];
            for (y, force) in to_forces.iter_mut().zip(entry.force) {
                y.iter_mut().zip(column).for_each(|(y, w)| *y += force * w);
            }
        }
        let [n, t] = to_forces;
        both.clear();
        both.extend(n.iter().zip(t).map(|(n, t)| [*n, *t]));
        both
    }
}

/// What a normal and a tangential force do to the unknowns of a group.
#[derive(Default)]
pub(super) struct Response {
    /// To each of the two forces.
    to_forces: [Vec<f64>; 2],
    /// The same, side by side.
    both: Vec<[f64; 2]>,
}

/// (G_p T) y of eq. (5.1) in the rows of a group: what normal (first column) and tangential force add to gap (first
/// row) and slip of p.
#[inline(always)]
pub(super) fn product(p: &[UnknownEntry], y: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let mut product = [[0.0; 2]; 2];
    for entry in p {
        let y = y[entry.place];
        for (product, g) in product.iter_mut().zip(entry.derivative) {
            product[0] += g * y[0];
            product[1] += g * y[1];
        }
    }
    product
}
