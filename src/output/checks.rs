//! Checks that a run makes in every increment, each with its bound: the table `/history/certificate`, and the line on
//! the screen with the largest values of all increments. See docs/theory/time.md, docs/theory/complementarity.md and
//! docs/theory/impacts.md.

use hdf5::Group;

use super::balance::Balance;
use super::column::{GrowingColumns, Layout, Mostly, group, new_attribute};
use super::format::{scientific, wrap};
use super::warnings::BALANCE;
use crate::dynamics::{ContactResultant, IncrementReport};
use crate::linear::larger;
use crate::model::Model;

/// A quantity that is zero up to round-off and the residuals of the passes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Check {
    /// Name of the dataset of the check.
    pub name: &'static str,
    text: &'static str,
    /// Largest value that counts as zero; NaN for a quantity without a bound.
    bound: f64,
    of: Of,
}

/// Models for which a check is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Of {
    All,
    WithContact,
    /// Models with wear or heat.
    WithSurfaceWork,
    /// Models without external forces.
    Free,
}

/// Largest residual, overlap, gap and slip of increments that have converged: a thousand times the values at which
/// passes end.
const LAW: f64 = 1e-8;
/// Largest force outside the cone that counts as round-off.
const CONE: f64 = 1e-9;
/// Largest difference between sums over nodes and sums over pairs that counts as round-off.
const SURFACE_WORK: f64 = 1e-10;
/// Largest change of the momentum that counts as round-off.
const MOMENTUM: f64 = 1e-9;
/// Smallest penetration that is reported: smaller ones are round-off of positions.
const SHOWN_PENETRATION: f64 = 1e-9;

#[rustfmt::skip]
pub(crate) const CHECKS: [Check; 10] = [
    Check { name: "residual", bound: LAW, of: Of::All,
        text: "force residual of the last pass, part of the largest force" },
    Check { name: "overlap", bound: LAW, of: Of::WithContact,
        text: "largest overlap of an open pair at the end, in lengths of its segment" },
    Check { name: "gap", bound: LAW, of: Of::WithContact,
        text: "largest gap of a closed pair at the end, in lengths of its segment" },
    Check { name: "slip", bound: LAW, of: Of::WithContact,
        text: "largest slip of a sticking pair in the increment, in lengths of its segment" },
    Check { name: PENETRATION, bound: f64::NAN, of: Of::WithContact,
        text: "largest penetration at the end, of an open pair, of edges that cross or of a node between means, in lengths of the edge" },
    Check { name: "cone", bound: CONE, of: Of::WithContact,
        text: "force of a pair outside of Coulomb's cone, part of the largest normal force of its contact" },
    Check { name: "impulse_cone", bound: CONE, of: Of::WithContact,
        text: "the same of the total impulses of the pairs in the increment" },
    Check { name: "balance", bound: BALANCE, of: Of::All,
        text: "energy balance, part of the largest energy so far" },
    Check { name: "surface_work", bound: SURFACE_WORK, of: Of::WithSurfaceWork,
        text: "work of friction, volume of wear and heat of the nodes less those of the contacts, part of all that was added" },
    Check { name: "momentum", bound: MOMENTUM, of: Of::Free,
        text: "change of the linear momentum since the start, part of the largest so far; without forces from outside" },
];

const PENETRATION: &str = "penetration";

/// Values of [`CHECKS`]; checks that the model does not need are zero.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Checks([f64; CHECKS.len()]);

impl Checks {
    /// Values of an increment, after `balance` has entered its energies.
    pub fn new(report: &IncrementReport, balance: &Balance) -> Self {
        let most =
            |of: fn(&ContactResultant) -> f64| report.contacts.iter().map(of).fold(0.0, larger);
        let violation = report.solver.violation;
        Checks([
            report.solver.residual,
            violation.overlap,
            violation.gap,
            violation.slip,
            violation.penetration,
            most(|contact| contact.cone_violation),
            most(|contact| contact.impulse_cone_violation),
            balance.relative(report.energy.balance.abs()),
            report.surface_work_difference,
            balance.momentum_drift().unwrap_or(0.0),
        ])
    }

    /// Enters the values of another increment.
    pub fn enter(&mut self, others: Checks) {
        for (most, value) in self.0.iter_mut().zip(others.0) {
            *most = larger(*most, value);
        }
    }

    /// The checks that are made for a model, with their values.
    pub fn of(&self, model: &Model) -> Vec<(&'static Check, f64)> {
        let made = CHECKS.iter().zip(self.0);
        made.filter(|(check, _)| check.is_made_of(model)).collect()
    }
}

impl Check {
    fn is_made_of(&self, model: &Model) -> bool {
        match self.of {
            Of::All => true,
            Of::WithContact => !model.contacts.is_empty(),
            Of::WithSurfaceWork => {
                let mut laws = model.contacts.iter().map(|contact| &contact.interaction);
                laws.any(|law| law.wear.is_some() || law.heat.is_some())
            }
            Of::Free => Balance::new(model).is_free(),
        }
    }

    fn fails(&self, value: f64) -> bool {
        !self.bound.is_nan() && (value.is_nan() || value > self.bound)
    }

    fn words(&self) -> String {
        match self.name {
            "balance" => "energy balance".to_owned(),
            name => name.replace('_', " "),
        }
    }

    /// Text of a check in the line; `None` for a penetration that is round-off.
    fn told(&self, value: f64) -> Option<String> {
        let shown = scientific(value, 1);
        match (self.name, self.fails(value)) {
            (PENETRATION, _) if value <= SHOWN_PENETRATION => None,
            (PENETRATION, _) => Some(format!("penetration {shown} of an edge")),
            (_, true) => Some(format!(
                "{} {shown} above {}",
                self.words(),
                scientific(self.bound, 0)
            )),
            (_, false) => Some(format!("{} {shown}", self.words())),
        }
    }
}

/// Creates `/history/certificate`; the attribute `bound` of each dataset is its bound.
pub(crate) fn create<'m>(
    history: &Group,
    model: &Model,
) -> hdf5::Result<GrowingColumns<'m, Checks>> {
    let at = group(history, "certificate")?;
    let mut columns = GrowingColumns::new();
    for (k, check) in CHECKS
        .iter()
        .enumerate()
        .filter(|(_, check)| check.is_made_of(model))
    {
        let layout = Layout::one_by_one::<f64>(&[], Mostly::Varied);
        columns.add(
            &at,
            check.name,
            layout,
            ("1", check.text),
            move |checks: &Checks, values| {
                values.push(checks.0[k]);
            },
        )?;
        let dataset = at.dataset(check.name)?;
        new_attribute(&dataset, "bound", check.bound)?;
    }
    Ok(columns)
}

/// The line about a run, given the largest values of its checks.
pub(crate) fn line(checks: &[(&Check, f64)]) -> Vec<String> {
    let failed = checks
        .iter()
        .filter(|(check, value)| check.fails(*value))
        .count();
    let verdict = match failed {
        0 => "all hold".to_owned(),
        failed => format!("{failed} of {} fail", checks.len()),
    };
    let told = checks
        .iter()
        .filter_map(|(check, value)| check.told(*value));
    wrap(
        "checks",
        &[verdict].into_iter().chain(told).collect::<Vec<_>>(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The line of checks with one value.
    fn with(name: &str, value: f64) -> String {
        let of = |check: &'static Check| (check, if check.name == name { value } else { 0.0 });
        line(&CHECKS.iter().map(of).collect::<Vec<_>>()).join("\n")
    }

    #[test]
    fn what_is_above_its_bound_fails() {
        assert!(with("gap", 9e-9).starts_with("checks   all hold   residual 0.0e+00   overlap"));
        assert!(with("gap", 9e-9).contains("gap 9.0e-09\n"));
        assert!(with("gap", 1.1e-8).starts_with("checks   1 of 10 fail"));
        assert!(with("gap", 1.1e-8).contains("gap 1.1e-08 above 1e-08"));
        assert!(with("balance", f64::NAN).contains("energy balance nan above 1e-08"));
    }

    #[test]
    fn edges_that_cross_are_told_but_nothing_holds_them_down() {
        assert!(!with("penetration", 1e-10).contains("penetration"));
        let told = with("penetration", 3.71e-5);
        assert!(told.starts_with("checks   all hold"));
        assert!(told.contains("penetration 3.7e-05 of an edge"));
    }
}
