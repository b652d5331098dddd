//! Strains at which a law is evaluated: one, or those of the start and of the end of an increment. The measure in which they
//! are added, and what happens across the plane. See docs/theory/materials.md and docs/theory/time.md.

use super::number::Number;
use super::symmetric::Symmetric;

/// Measures of strain in which energies are convex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StrainMeasure {
    /// E of Green and Lagrange.
    Green,
    /// Logarithms of stretches.
    Logarithmic,
}

/// What happens across the plane.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Across<T = f64> {
    /// Stretch F_33.
    pub stretch: T,
    /// Second Piola-Kirchhoff stress S_33 (force/length^2).
    pub stress: T,
}

/// Green-Lagrange strains at which a material is evaluated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Strains<T = f64> {
    /// One strain.
    At(Symmetric<T>),
    /// Those of start and end of an increment, in the energy-momentum form.
    Between(StrainChange<T>),
}

/// The strains of start and end of an increment, their mean, and half their change, whose digits are its own.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StrainChange<T = f64> {
    /// E0
    pub start: Symmetric<T>,
    /// E1
    pub end: Symmetric<T>,
    /// (E0 + E1)/2
    pub mean: Symmetric<T>,
    /// (E1 - E0)/2
    pub half: Symmetric<T>,
}

impl<T: Number> StrainChange<T> {
    /// That from a strain to another.
    #[inline(always)]
    pub fn between(e0: &Symmetric<T>, e1: &Symmetric<T>) -> Self {
        StrainChange {
            start: *e0,
            end: *e1,
            mean: e0.with(e1, |a, b| (a + b) * 0.5),
            half: e0.with(e1, |a, b| (b - a) * 0.5),
        }
    }

    /// That of a mean and half of the change.
    #[inline(always)]
    pub fn about(mean: Symmetric<T>, half: Symmetric<T>) -> Self {
        StrainChange {
            start: mean - half,
            end: mean + half,
            mean,
            half,
        }
    }

    /// E1 - E0
    #[inline(always)]
    pub fn change(&self) -> Symmetric<T> {
        self.half.map(|half| half * 2.0)
    }

    /// That of one element.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> StrainChange {
        StrainChange {
            start: self.start.lane(lane),
            end: self.end.lane(lane),
            mean: self.mean.lane(lane),
            half: self.half.lane(lane),
        }
    }
}

impl<T: Number> Strains<T> {
    /// From the strain of the start of an increment to that of its end.
    #[inline(always)]
    pub fn between(e0: &Symmetric<T>, e1: &Symmetric<T>) -> Self {
        Strains::Between(StrainChange::between(e0, e1))
    }

    /// Those of all elements, which are of the kind of the first.
    #[inline(always)]
    pub fn of_lanes(of: impl Fn(usize) -> Strains) -> Self {
        let end = Symmetric::of_lanes(|lane| of(lane).end());
        let start = |lane: usize| match of(lane) {
            Strains::At(e) => e,
            Strains::Between(change) => change.start,
        };
        match of(0) {
            Strains::At(_) => Strains::At(end),
            Strains::Between(_) => Strains::between(&Symmetric::of_lanes(start), &end),
        }
    }

    /// The strain at the end.
    #[inline(always)]
    pub fn end(&self) -> Symmetric<T> {
        match self {
            Strains::At(e) => *e,
            Strains::Between(change) => change.end,
        }
    }

    /// Those of one element.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Strains {
        match self {
            Strains::At(e) => Strains::At(e.lane(lane)),
            Strains::Between(change) => Strains::Between(change.lane(lane)),
        }
    }
}
