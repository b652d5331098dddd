//! Strains at which a law is evaluated: one strain, or the strains at the start and at the end of an increment. Also
//! the measure in which strains of an element are added, and the state across the plane. See docs/theory/materials.md
//! and docs/theory/time.md.

use super::number::Number;
use super::symmetric::Symmetric;

/// Measures of strain in which energies are convex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StrainMeasure {
    /// Green-Lagrange strain E.
    Green,
    /// Logarithmic strain.
    Logarithmic,
}

/// Stretch and stress across the plane.
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
    /// Strains at the start and at the end of an increment, in the energy-momentum form.
    Between(StrainChange<T>),
}

/// The strains at the start and at the end of an increment, their mean, and half their change, which has its own digits
/// and is not a difference.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StrainChange<T = f64> {
    /// E0
    pub start: Symmetric<T>,
    /// E1
    pub end: Symmetric<T>,
    /// Mean strain (E0 + E1)/2.
    pub mean: Symmetric<T>,
    /// Half of the change, (E1 - E0)/2.
    pub half: Symmetric<T>,
}

impl<T: Number> StrainChange<T> {
    /// Change from one strain to another.
    #[inline(always)]
    pub fn between(e0: &Symmetric<T>, e1: &Symmetric<T>) -> Self {
        StrainChange {
            start: *e0,
            end: *e1,
            mean: e0.with(e1, |a, b| (a + b) * 0.5),
            half: e0.with(e1, |a, b| (b - a) * 0.5),
        }
    }

    /// Change with the given mean and half difference.
    #[inline(always)]
    pub fn about(mean: Symmetric<T>, half: Symmetric<T>) -> Self {
        StrainChange {
            start: mean - half,
            end: mean + half,
            mean,
            half,
        }
    }

    /// Change E1 - E0.
    #[inline(always)]
    pub fn change(&self) -> Symmetric<T> {
        self.half.map(|half| half * 2.0)
    }

    /// The change of the strains in one element.
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
    /// Strains from the start of an increment to its end.
    #[inline(always)]
    pub fn between(e0: &Symmetric<T>, e1: &Symmetric<T>) -> Self {
        Strains::Between(StrainChange::between(e0, e1))
    }

    /// Strains of all elements: all single strains or all changes, like the strains of the first element.
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

    /// The strains of one element.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Strains {
        match self {
            Strains::At(e) => Strains::At(e.lane(lane)),
            Strains::Between(change) => Strains::Between(change.lane(lane)),
        }
    }
}
