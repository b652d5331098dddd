//! Energies of the reports of a run.

use stickslip::dynamics::IncrementReport;

/// Kinetic and strain energy.
pub fn energy(report: &IncrementReport) -> f64 {
    report.energy.kinetic + report.energy.strain
}

/// Largest of some values over all reports.
pub fn largest(reports: &[IncrementReport], value: impl Fn(&IncrementReport) -> f64) -> f64 {
    reports.iter().map(value).fold(0.0, f64::max)
}

/// Largest energy balance as a part of the largest energy or external work.
pub fn unbalanced(reports: &[IncrementReport]) -> f64 {
    let scale = largest(reports, |r| energy(r).max(r.energy.external_work.abs()));
    largest(reports, |r| r.energy.balance.abs()) / scale
}
