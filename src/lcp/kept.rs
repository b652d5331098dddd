//! Factors of a system of some contact states, kept for similar ones: the same with Q a little different, with other
//! states of some contacts, or with some contacts more or less, which add a border. docs/numerics.md, Kept factors of
//! a complementarity problem.

use bumpalo::Bump;

use super::dense::{Factors, List, copy, dot, filled, list, max_abs};
use super::problems::{ContactState, FrictionalSolution, Spare};
use super::scaled::Scaled;
use crate::archive::{Archive, ArchiveError};

/// Unknowns of the kept factors for one of the border: with fewer, new factors are not dearer.
const UNKNOWNS_PER_BORDER: usize = 8;

/// Contacts are too nearly one for a border where it has compliances, or forces, in such a ratio: its round-off would
/// decide which of them carry force.
const LARGEST: f64 = 1e3;

/// Solves of a system by factors of another, A, and a border:
///
/// ```text
/// [ A  B ] [ x ]   [ r ]      x = A^-1 (r - B y)
/// [ C  D ] [ y ] = [ s ],     (D - C A^-1 B) y = s - C A^-1 r
/// ```
///
/// A contact that closes, or begins to stick, brings its force as a y with its row of Q; one that opens, or
/// begins to slide, brings what its row is then let off as a y, with Pn = 0 or Pt = -+mu Pn as its row.
pub(super) struct Similar<'a> {
    arena: &'a Bump,
    factors: &'a Factors,
    /// Factors of rows and columns that bring A to the units of the system.
    units: [List<'a, f64>; 2],
    /// For every row of A, and every row of the border, the unknown of the system whose row it is.
    rows: [List<'a, Option<usize>>; 2],
    /// Every unknown of the system as a sum of (place among x and y, factor).
    sums: List<'a, Sum>,
    /// A^-1 B, column by column.
    inverse_of_columns: List<'a, f64>,
    /// C, row by row.
    border_rows: List<'a, f64>,
    /// Factors of D - C A^-1 B, if there is a border.
    complement: Option<Factors>,
}

/// A sum of (place, factor), of one term where the second factor is zero.
type Sum = [(usize, f64); 2];

/// No term.
const NONE: (usize, f64) = (0, 0.0);

/// One row and column of a border.
struct Border {
    column: Column,
    row: Row,
}

/// Column of a border.
enum Column {
    /// Q e_k + factor Q e_t.
    Force(usize, Option<(usize, f64)>),
    /// e_u, u being an unknown of A.
    Release(usize),
}

/// Row of a border.
enum Row {
    /// Row k of Q.
    Motion(usize),
    /// x_u - factor x_n = 0, of unknowns of A.
    Tie(usize, Option<(usize, f64)>),
    /// y - factor x_n = 0.
    Slide(usize, f64),
}

/// How the unknowns of a system follow from those of the kept one.
struct Change<'a> {
    kept: &'a Kept,
    scaled: &'a Scaled<'a>,
    /// Contact in the system of every contact of the kept one.
    places: List<'a, Option<usize>>,
    /// Unknowns of A that are Pn and Pt of every contact of the system.
    unknowns: List<'a, [Option<usize>; 2]>,
    /// Pt = slide Pn within A, of every contact of the system.
    slides: List<'a, f64>,
    borders: List<'a, Border>,
    /// For every force of the system its sum.
    sums: List<'a, Sum>,
}

impl<'a> Change<'a> {
    /// From the kept system to another one; None where A has slides that are no part of it.
    fn new(kept: &'a Kept, system: &System, scaled: &'a Scaled<'a>) -> Option<Self> {
        let arena = scaled.arena;
        let places = kept.of().places_in(system, arena);
        let mut unknowns = filled(arena, [None; 2], scaled.contacts);
        let mut slides = filled(arena, 0.0, scaled.contacts);
        for (j, place) in places.iter().enumerate() {
            if let Some(i) = *place {
                slides[i] = kept.of().slides[j];
                if slides[i] != 0.0 && scaled.tangents[i].is_none() {
                    return None;
                }
            }
        }
        for (u, (j, is_tangential)) in kept.unknowns.iter().enumerate() {
            if let Some(i) = places[*j] {
                unknowns[i][usize::from(*is_tangential)] = Some(u);
            }
        }
        let mut change = Change {
            kept,
            scaled,
            places,
            unknowns,
            slides,
            borders: List::new_in(arena),
            sums: filled(arena, [NONE; 2], scaled.size()),
        };
        for (u, (j, _)) in kept.unknowns.iter().enumerate() {
            if change.places[*j].is_none() {
                change.remove(u);
            }
        }
        for i in 0..scaled.contacts {
            change.enter(i, system.states[i], system.slides[i]);
        }
        Some(change)
    }

    /// Makes an unknown of A zero.
    fn remove(&mut self, u: usize) {
        self.borders.push(Border {
            column: Column::Release(u),
            row: Row::Tie(u, None),
        });
    }

    /// Adds a border with the column, and returns the place of its y.
    fn add(&mut self, column: Column, row: Row) -> usize {
        self.borders.push(Border { column, row });
        self.kept.unknowns.len() + self.borders.len() - 1
    }

    /// Contact i with its state and slide.
    fn enter(&mut self, i: usize, state: ContactState, slide: f64) {
        let [normal, tangential] = self.unknowns[i];
        let tangent = self.scaled.tangents[i];
        let sticks = tangent.filter(|_| state == ContactState::Stick);
        match (normal, state.is_closed()) {
            (None, false) => {}
            (_, false) => [normal, tangential]
                .into_iter()
                .flatten()
                .for_each(|u| self.remove(u)),
            (None, true) => {
                let with_friction = tangent.filter(|_| slide != 0.0).map(|t| (t, slide));
                let y = self.add(Column::Force(i, with_friction), Row::Motion(i));
                self.sums[i] = [(y, 1.0), NONE];
                if let Some(t) = sticks {
                    let y = self.add(Column::Force(t, None), Row::Motion(t));
                    self.sums[t] = [(y, 1.0), NONE];
                }
            }
            (Some(normal), true) => {
                self.sums[i] = [(normal, 1.0), NONE];
                self.go_on(i, normal, (sticks, slide));
            }
        }
    }

    /// The tangential force of contact i, which was closed with the given unknown and is so still.
    fn go_on(&mut self, i: usize, normal: usize, (sticks, slide): (Option<usize>, f64)) {
        let before = self.slides[i];
        match (self.unknowns[i][1], sticks, self.scaled.tangents[i]) {
            (Some(u), Some(t), _) => self.sums[t] = [(u, 1.0), NONE],
            (Some(u), None, _) => {
                let tie = (slide != 0.0).then_some((normal, slide));
                self.add(Column::Release(u), Row::Tie(u, tie));
            }
            (None, Some(t), _) => {
                let y = self.add(Column::Force(t, None), Row::Motion(t));
                self.sums[t] = [(y, 1.0), (normal, before)];
            }
            (None, None, Some(t)) if slide != before => {
                self.add(Column::Force(t, None), Row::Slide(normal, slide - before));
            }
            _ => {}
        }
    }

    /// Place in p of an unknown of A, if the system has it.
    fn position(&self, u: usize) -> Option<usize> {
        let (j, is_tangential) = self.kept.unknowns[u];
        let i = self.places[j]?;
        match is_tangential {
            true => self.scaled.tangents[i],
            false => Some(i),
        }
    }

    /// Q e_k + factor Q e_t over all of p.
    fn force_column(&self, k: usize, tangent: Option<(usize, f64)>) -> List<'a, f64> {
        let mut column = copy(self.scaled.arena, self.scaled.column(k));
        if let Some((t, factor)) = tangent {
            let tangent = self.scaled.column(t);
            (column.iter_mut().zip(tangent)).for_each(|(c, t)| *c += factor * t);
        }
        column
    }

    /// Row of a border over the unknowns of A.
    fn row(&self, row: &Row) -> List<'a, f64> {
        let (size, q) = (self.kept.unknowns.len(), self.scaled.q());
        let mut values = filled(self.scaled.arena, 0.0, size);
        match *row {
            Row::Motion(k) => {
                for (u, value) in values.iter_mut().enumerate() {
                    let Some(position) = self.position(u) else {
                        continue;
                    };
                    *value = q[(k, position)];
                    if position < self.scaled.contacts
                        && self.slides[position] != 0.0
                        && let Some(t) = self.scaled.tangents[position]
                    {
                        *value += self.slides[position] * q[(k, t)];
                    }
                }
            }
            Row::Tie(u, tie) => {
                values[u] = 1.0;
                if let Some((normal, factor)) = tie {
                    values[normal] = -factor;
                }
            }
            Row::Slide(normal, factor) => values[normal] = -factor,
        }
        values
    }
}

impl<'a> Similar<'a> {
    /// Solves of the system of the given states, with its unknowns, by the kept factors; None where there are none that
    /// serve, or the border is too large or singular.
    pub fn of(
        kept: &'a KeptFactors,
        scaled: &'a Scaled<'a>,
        states: &'a [ContactState],
        unknowns: &[usize],
    ) -> Option<Self> {
        let (kept, system) = kept.serving(scaled, states)?;
        let (system, arena) = (&system, scaled.arena);
        let change = Change::new(kept, system, scaled)?;
        let (size, count) = (kept.unknowns.len(), change.borders.len());
        if count * UNKNOWNS_PER_BORDER > size {
            return None;
        }
        let mut at = filled(arena, None, scaled.size());
        unknowns
            .iter()
            .zip(0..)
            .for_each(|(k, place)| at[*k] = Some(place));
        let row = |border: &Border| match border.row {
            Row::Motion(k) => at[k],
            _ => None,
        };
        let of_kept = (0..size).map(|u| change.position(u).and_then(|k| at[k]));
        let rows_of_border = list(arena, change.borders.iter().map(row));
        let mut similar = Similar {
            arena,
            factors: &kept.factors,
            units: units(kept, system, &change, arena),
            rows: [list(arena, of_kept), rows_of_border],
            sums: list(arena, unknowns.iter().map(|k| change.sums[*k])),
            inverse_of_columns: List::with_capacity_in(size * count, arena),
            border_rows: List::with_capacity_in(size * count, arena),
            complement: None,
        };
        if count > 0 {
            similar.add_border(&change)?;
        }
        Some(similar)
    }

    /// Computes A^-1 B and D - C A^-1 B.
    fn add_border(&mut self, change: &Change) -> Option<()> {
        let (size, count) = (change.kept.unknowns.len(), change.borders.len());
        let mut complement = vec![0.0; count * count];
        for (m, border) in change.borders.iter().enumerate() {
            match border.column {
                Column::Release(u) => {
                    let unit = (0..size).map(|k| f64::from(k == u));
                    self.inverse_of_columns.extend(unit);
                }
                Column::Force(k, tangent) => {
                    let column = change.force_column(k, tangent);
                    let entries = (0..size).map(|u| change.position(u).map_or(0.0, |k| column[k]));
                    self.inverse_of_columns.extend(entries);
                    for (l, of_l) in change.borders.iter().enumerate() {
                        complement[l + m * count] = match of_l.row {
                            Row::Motion(k) => column[k],
                            Row::Slide(..) if l == m => 1.0,
                            _ => 0.0,
                        };
                    }
                }
            }
            self.border_rows.extend(change.row(&border.row));
        }
        let compliance = max_abs(&complement);
        let [rows, columns] = &self.units;
        let scale = |values: &mut [f64], units: &[f64]| {
            for column in values.chunks_exact_mut(size) {
                column
                    .iter_mut()
                    .zip(units)
                    .for_each(|(v, unit)| *v *= unit);
            }
        };
        scale(&mut self.inverse_of_columns, rows);
        self.factors.solve_columns(&mut self.inverse_of_columns);
        scale(&mut self.inverse_of_columns, columns);
        for (m, column) in self.inverse_of_columns.chunks_exact(size).enumerate() {
            for (l, row) in self.border_rows.chunks_exact(size).enumerate() {
                complement[l + m * count] -= dot(row, column);
            }
        }
        // forces that others nearly determine leave little of their compliance, or take much of others' forces
        let factors = Factors::lu(complement, count)?;
        let is_clear = compliance <= LARGEST * factors.smallest_pivot()
            && max_abs(&self.inverse_of_columns) <= LARGEST;
        self.complement = is_clear.then_some(factors);
        is_clear.then_some(())
    }

    /// Overwrites the right-hand side, over the unknowns of the system, with the solution.
    pub fn solve(&self, b: &mut [f64]) {
        let [rows, columns] = &self.units;
        let [of_kept, of_border] = &self.rows;
        let entry = |row: &Option<usize>| row.map_or(0.0, |row| b[row]);
        // x = A^-1 r
        let mut x = List::with_capacity_in(of_kept.len() + of_border.len(), self.arena);
        x.extend((of_kept.iter().zip(rows)).map(|(row, unit)| entry(row) * unit));
        self.factors.solve(&mut x);
        x.iter_mut().zip(columns).for_each(|(x, unit)| *x *= unit);
        let size = x.len();
        if let Some(complement) = &self.complement {
            // y, and x - A^-1 B y
            let of_rows = of_border.iter().zip(self.border_rows.chunks_exact(size));
            let mut y = list(self.arena, of_rows.map(|(row, c)| entry(row) - dot(c, &x)));
            complement.solve(&mut y);
            for (y, column) in y.iter().zip(self.inverse_of_columns.chunks_exact(size)) {
                x.iter_mut()
                    .zip(column)
                    .for_each(|(x, column)| *x -= y * column);
            }
            x.extend(y);
        }
        for (b, terms) in b.iter_mut().zip(&self.sums) {
            let [first, second] = terms.map(|(place, factor)| factor * x[place]);
            *b = first + second;
        }
    }
}

/// Factors of rows and columns from the units of the kept factors to those of a system, powers of two. Q_kl is in units of
/// w_k w_l, w the weights, and of the compliance.
fn units<'a>(kept: &Kept, system: &System, change: &Change, arena: &'a Bump) -> [List<'a, f64>; 2] {
    let of = kept.of();
    let weight = |(j, _): &(usize, bool)| {
        change.places[*j].map_or(1.0, |i| system.weights[i] / of.weights[*j])
    };
    let rows = list(arena, kept.unknowns.iter().map(weight));
    let compliance = system.compliance / of.compliance;
    let columns = list(arena, rows.iter().map(|weight| weight * compliance));
    [rows, columns]
}

/// What tells a contact from others through a row of similar problems.
pub type ContactName = [usize; 3];

/// Factors of the system of some states, and the memory of the solves.
#[derive(Default)]
pub struct KeptFactors {
    /// Names of the contacts of the next problem. Without names, factors serve systems of the same states only.
    names: Vec<ContactName>,
    kept: Option<Kept>,
    /// Where the lists of a solve lie.
    pub(super) arena: Bump,
    pub(super) spare: Spare,
}

/// Factors with the system that they are of.
#[derive(serde::Serialize, serde::Deserialize)]
pub(super) struct Kept {
    names: Vec<ContactName>,
    states: Vec<ContactState>,
    slides: Vec<f64>,
    weights: Vec<f64>,
    compliance: f64,
    /// Contact of every unknown, and whether it is the tangential force.
    pub unknowns: Vec<(usize, bool)>,
    pub factors: Factors,
}

impl Kept {
    /// The system that the factors are of.
    pub fn of(&self) -> System<'_> {
        System {
            names: &self.names,
            states: &self.states,
            slides: &self.slides,
            weights: &self.weights,
            compliance: self.compliance,
        }
    }
}

/// A system: its contacts with their states, and the units that its entries are in.
pub(super) struct System<'a> {
    names: &'a [ContactName],
    pub states: &'a [ContactState],
    /// Pt = slide Pn where a contact slides, else zero.
    pub slides: &'a [f64],
    pub weights: &'a [f64],
    pub compliance: f64,
}

impl<'a> System<'a> {
    /// The system of some states of contacts with the given names, or without.
    fn new(names: &'a [ContactName], scaled: &'a Scaled, states: &'a [ContactState]) -> Self {
        let n = scaled.contacts;
        let slides = list(scaled.arena, (0..n).map(|i| slide(scaled, states, i)));
        System {
            names: match names.len() == n {
                true => names,
                false => list(scaled.arena, (0..n).map(|i| [i, 0, 0])).into_bump_slice(),
            },
            states,
            slides: slides.into_bump_slice(),
            weights: &scaled.weights,
            compliance: scaled.compliance,
        }
    }

    /// Place of each of its contacts among those of another system, if it has them.
    pub fn places_in<'l>(&self, other: &System, arena: &'l Bump) -> List<'l, Option<usize>> {
        if self.names == other.names {
            return list(arena, (0..self.names.len()).map(Some));
        }
        let mut by_name = list(arena, other.names.iter().copied().zip(0..));
        by_name.sort_unstable();
        let place = |name: &ContactName| {
            let found = by_name.binary_search_by_key(name, |(name, _)| *name);
            found.ok().map(|at| by_name[at].1)
        };
        list(arena, self.names.iter().map(place))
    }
}

impl KeptFactors {
    /// Carries names and factors.
    ///
    /// # Errors
    /// What is read are no factors.
    pub fn carry(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        archive.carry(&mut self.names)?;
        archive.carry(&mut self.kept)
    }

    /// Names the contacts of the next problem, each differently.
    pub fn name_contacts(&mut self, names: impl Iterator<Item = ContactName>) {
        self.names.clear();
        self.names.extend(names);
    }

    /// Takes the memory of a solution that is not needed any more.
    pub fn take(&mut self, solution: FrictionalSolution) {
        self.spare.take(solution);
    }

    /// Forgets factors and names, so that other systems have factors of their own; whether there were names.
    pub(super) fn forget(&mut self) -> bool {
        self.kept = None;
        !std::mem::take(&mut self.names).is_empty()
    }

    /// The factors, if they are of a system of the same contacts with the same states in the same units.
    pub(super) fn same(&self, scaled: &Scaled, states: &[ContactState]) -> Option<&Factors> {
        let kept = self.kept.as_ref()?;
        let of = kept.of();
        let are_same = (self.names.is_empty() || of.names == self.names)
            && of.states == states
            && (*of.weights == *scaled.weights && of.compliance == scaled.compliance)
            && (0..scaled.contacts).all(|i| of.slides[i] == slide(scaled, states, i));
        are_same.then_some(&kept.factors)
    }

    /// The factors that may serve the system of the given states, which comes with them.
    pub(super) fn serving<'a>(
        &'a self,
        scaled: &'a Scaled,
        states: &'a [ContactState],
    ) -> Option<(&'a Kept, System<'a>)> {
        let kept = self.kept.as_ref()?;
        let may_serve = !self.names.is_empty() || kept.states == states;
        may_serve.then(|| (kept, System::new(&self.names, scaled, states)))
    }

    /// Keeps the factors of the system of the given states and unknowns.
    pub(super) fn keep(
        &mut self,
        scaled: &Scaled,
        states: &[ContactState],
        unknowns: &[usize],
        factors: Factors,
    ) {
        let of = |k: &usize| match k.checked_sub(scaled.contacts) {
            None => (*k, false),
            Some(tangent) => (scaled.owners[tangent], true),
        };
        let system = System::new(&self.names, scaled, states);
        self.kept = Some(Kept {
            names: system.names.to_vec(),
            states: states.to_vec(),
            slides: system.slides.to_vec(),
            weights: system.weights.to_vec(),
            compliance: system.compliance,
            unknowns: unknowns.iter().map(of).collect(),
            factors,
        });
    }
}

/// The factor in Pt = factor Pn of contact i, zero where it does not slide.
pub(super) fn slide(scaled: &Scaled, states: &[ContactState], i: usize) -> f64 {
    -states[i].slip_sign() * scaled.mu[i]
}
