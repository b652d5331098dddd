//! Strains at which a law is evaluated: one, or those of the start and of the end of an increment. Section 4 of docs/theory.md.

use super::number::Number;
use super::symmetric::Symmetric;

/// Green-Lagrange strains at which a material is evaluated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Strains<T = f64> {
    /// One strain.
    At(Symmetric<T>),
    /// Those of start and end of an increment, in the energy-momentum form.
    Between(StrainChange<T>),
}

/// The strains of start and end of an increment, by their mean and by half their change, whose digits are its own.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StrainChange<T = f64> {
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
            mean: e0.with(e1, |a, b| (a + b) * 0.5),
            half: e0.with(e1, |a, b| (b - a) * 0.5),
        }
    }

    /// E0
    #[inline(always)]
    pub fn start(&self) -> Symmetric<T> {
        self.mean - self.half
    }

    /// E1
    #[inline(always)]
    pub fn end(&self) -> Symmetric<T> {
        self.mean + self.half
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

    /// The strain at the end.
    #[inline(always)]
    pub fn end(&self) -> Symmetric<T> {
        match self {
            Strains::At(e) => *e,
            Strains::Between(change) => change.end(),
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
