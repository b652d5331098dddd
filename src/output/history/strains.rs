//! `/history/strain`: largest principal strains.

use hdf5::Group;

use crate::dynamics::IncrementReport;
use crate::model::Model;
use crate::output::file::{Columns, Scalar, Series, scalar};
use crate::output::text::SmallStrainElements;

/// Largest principal strain of all elements, and of those with a law for small strains.
struct LargestStrains {
    all: f64,
    elastic: f64,
}

const STRAIN: [Scalar<LargestStrains, f64>; 2] = [
    scalar(
        "largest_principal",
        "largest absolute principal value of the Green-Lagrange strain in the plane, of all integration \
         points",
        "1",
        |s| s.all,
    ),
    scalar(
        "largest_principal_elastic",
        "the same of elements with a St. Venant-Kirchhoff material (*ELASTIC); 0 without any",
        "1",
        |s| s.elastic,
    ),
];

/// `/history/strain`.
pub(super) struct StrainHistory {
    series: Series<LargestStrains, f64>,
    limited: SmallStrainElements,
}

impl StrainHistory {
    /// Creates the datasets without rows.
    pub fn create(at: &Group, model: &Model) -> hdf5::Result<Self> {
        Ok(StrainHistory {
            series: Series::create(at, &STRAIN)?,
            limited: SmallStrainElements::new(model),
        })
    }

    /// Appends the row of an increment.
    pub fn push(&mut self, report: &IncrementReport) {
        self.series.push(&LargestStrains {
            all: report.strain.strain,
            elastic: self.limited.most_strained(report).strain,
        });
    }

    /// Its datasets.
    pub fn columns<'a>(&'a mut self, all: &mut Columns<'a>) {
        self.series.columns(all);
    }
}
