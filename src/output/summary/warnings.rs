//! Warnings about a whole run: printed at its end, and by `info` from the result file.

use super::balance::Balance;
use super::losses::Losses;
use super::touches::Touches;
use crate::dynamics::{IncrementReport, Touch};
use crate::linear::larger;
use crate::model::{ALL_EXTERIOR, Bodies, Model};
use crate::output::file::{BodyTimes, body_times, contact_names};
use crate::output::text::{LARGE, general, scientific, wrap_words};

/// Energy balance, relative to the largest energy, above which a run is warned about.
const BALANCE: f64 = 1e-8;
/// Number of increments in the transit time of the shortest edge beyond which the errors of the mesh
/// dominate.
const MANY: f64 = 100.0;
/// Number of increments that resolve the longest period well.
const ENOUGH: f64 = 20.0;

/// Figures of a whole run that warnings are made from.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Findings {
    /// Largest energy balance as a part of the largest energy.
    pub balance: f64,
    /// Where the energy has gone.
    pub losses: Losses,
    /// Largest principal strain in a material for small strains, where it is known.
    pub strain: Option<f64>,
    /// Names of the contacts that never closed, sorted.
    pub open: Vec<String>,
    /// The touches that matter.
    pub touches: Touches,
    /// Length of the longest increment; 0 without any.
    pub dt: f64,
    /// Last time.
    pub time: f64,
    /// Transit times of waves in the bodies, where they are known.
    pub bodies: Vec<BodyTimes>,
}

impl Findings {
    /// The warnings, each a sentence that says what to do, in lines of the screen.
    pub fn lines(&self) -> Vec<String> {
        let mut texts: Vec<String> = self.balance_text().into_iter().collect();
        texts.extend(self.losses.advice());
        let others = [
            self.touches.brief_text(),
            self.touches.narrow_text(),
            self.strain_text(),
            self.long_text(),
            self.short_text(),
        ];
        texts.extend(others.into_iter().flatten());
        texts.extend(self.open.iter().map(|name| self.open_text(name)));
        texts
            .iter()
            .flat_map(|text| wrap_words("warning", text))
            .collect()
    }

    fn balance_text(&self) -> Option<String> {
        let is_small = self.balance <= BALANCE;
        (!is_small).then(|| {
            format!(
                "the energy balance is off by {} of the largest energy, above {}: lower the \
                 TOLERANCE of *STICKSLIP or the increment",
                scientific(self.balance, 1),
                scientific(BALANCE, 0),
            )
        })
    }

    fn strain_text(&self) -> Option<String> {
        let strain = self.strain.filter(|&strain| strain > LARGE)?;
        Some(format!(
            "the largest principal strain is {}, above {}, where a St. Venant-Kirchhoff material \
             (*ELASTIC) is too stiff in tension and too soft in compression: trust no forces there; \
             choose a material for large strains (*HYPERELASTIC, NEO HOOKE) or lower the loads",
            general(strain, 4),
            general(LARGE, 1),
        ))
    }

    /// An increment longer than the longest period 2 L/c of longitudinal vibration: the vibration of
    /// no body is resolved.
    fn long_text(&self) -> Option<String> {
        let longest = self.bodies.iter().map(|times| 2.0 * times.body);
        let period = longest.reduce(f64::max)?;
        (self.dt > period).then(|| {
            format!(
                "increments of {} are longer than a wave takes to and fro through the slowest body \
                 ({}), so that no vibration is resolved: choose about {} if it matters",
                general(self.dt, 2),
                general(period, 2),
                general(period / ENOUGH, 1),
            )
        })
    }

    /// An increment in which a wave covers a small part of the shortest edge: errors of the mesh
    /// dominate.
    fn short_text(&self) -> Option<String> {
        let shortest = self.bodies.iter().map(|times| times.edge);
        let edge = shortest.reduce(f64::min)?;
        (self.dt > 0.0 && self.dt * MANY < edge).then(|| {
            format!(
                "even the longest increment ({}) is less than a {}th of the time a wave takes along \
                 the shortest edge ({}), which makes nothing more accurate: choose up to {}",
                general(self.dt, 2),
                general(MANY, 1),
                general(edge, 2),
                general(edge, 1),
            )
        })
    }

    fn open_text(&self, name: &str) -> String {
        format!(
            "contact {name} never closed up to time {}: if its surfaces should have met, see that \
             the faces of each look at the other",
            general(self.time, 4),
        )
    }
}

/// Follows a run.
#[derive(Debug, Clone, Default)]
pub(crate) struct Watch {
    /// Whether each contact has closed, or been struck.
    closed: Vec<bool>,
    touches: Vec<Touch>,
    dt: f64,
    time: f64,
}

impl Watch {
    /// Enters an increment.
    pub fn add(&mut self, report: &IncrementReport) {
        self.closed.resize(report.contacts.len(), false);
        for (closed, contact) in self.closed.iter_mut().zip(&report.contacts) {
            *closed |= contact.closed > 0 || contact.impulse.impact_normal > 0.0;
        }
        self.touches.extend(&report.touches);
        self.dt = larger(self.dt, report.dt);
        self.time = report.time;
    }

    /// The findings of the run; large strains are reported at their increment.
    pub fn findings(&self, model: &Model, balance: &Balance) -> Findings {
        let closed = self.closed.iter().copied();
        let contacts: Vec<(String, bool)> = contact_names(model).into_iter().zip(closed).collect();
        Findings {
            balance: balance.worst(),
            losses: balance.losses(),
            strain: None,
            open: match self.dt > 0.0 {
                true => never_closed(&contacts),
                false => Vec::new(),
            },
            touches: Touches::new(&self.touches, balance.largest()),
            dt: self.dt,
            time: self.time,
            bodies: body_times(model, &Bodies::new(&model.mesh)),
        }
    }
}

/// Names of the contacts that never closed, sorted, from the names of all and whether they did.
/// Of two contacts between the same surfaces with slave and master exchanged, one that closed is
/// enough; so is any contact of general contact.
pub(crate) fn never_closed(contacts: &[(String, bool)]) -> Vec<String> {
    let has_closed = |wanted: &str| {
        contacts
            .iter()
            .any(|(name, closed)| *closed && name == wanted)
    };
    let other_way_round = |name: &str| {
        let mut cuts = name.match_indices('_');
        cuts.any(|(i, _)| has_closed(&format!("{}_{}", &name[i + 1..], &name[..i])))
    };
    let is_general = |name: &str| name.starts_with(ALL_EXTERIOR);
    let mut general = contacts.iter().filter(|(name, _)| is_general(name));
    let has_met = general.any(|(_, closed)| *closed);
    let is_met = |name: &str| other_way_round(name) || (has_met && is_general(name));
    let open = contacts
        .iter()
        .filter(|(_, closed)| !closed)
        .map(|(name, _)| name);
    let mut open: Vec<String> = open.filter(|name| !is_met(name)).cloned().collect();
    open.sort();
    open
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run without warnings: 20 increments in the longest period of the slowest body.
    fn sound() -> Findings {
        Findings {
            balance: 1e-10,
            losses: Losses {
                clipping: 0.001,
                ..Losses::default()
            },
            strain: Some(0.1),
            open: vec![],
            touches: Touches::default(),
            dt: 0.1,
            time: 1.0,
            bodies: vec![
                BodyTimes {
                    edge: 0.05,
                    body: 0.2,
                },
                BodyTimes {
                    edge: 0.1,
                    body: 1.0,
                },
            ],
        }
    }

    fn text(findings: &Findings) -> String {
        let lines = findings.lines();
        assert!(lines.iter().all(|line| line.len() <= 80), "{lines:?}");
        let words: Vec<&str> = lines
            .iter()
            .flat_map(|line| line.split_whitespace())
            .collect();
        words.join(" ")
    }

    #[test]
    fn a_sound_run_is_not_warned_about() {
        assert_eq!(text(&sound()), "");
        let old = Findings {
            strain: None,
            bodies: vec![],
            ..sound()
        };
        assert_eq!(text(&old), "", "of a file without these datasets");
    }

    #[test]
    fn a_contact_that_closed_the_other_way_round_has_met() {
        let contacts = |closed: [bool; 3]| -> Vec<(String, bool)> {
            let names = ["UP_X_LOW", "LOW_UP_X", "A_B"].map(str::to_owned);
            names.into_iter().zip(closed).collect()
        };
        assert_eq!(never_closed(&contacts([false, true, true])), [""; 0]);
        assert_eq!(never_closed(&contacts([false, true, false])), ["A_B"]);
        let general = [("ALL_EXTERIOR", false), ("ALL_EXTERIOR_FLOOR", true)];
        let general = general.map(|(name, closed)| (name.to_owned(), closed));
        assert_eq!(never_closed(&general), [""; 0]);
        assert_eq!(
            never_closed(&contacts([false; 3])),
            ["A_B", "LOW_UP_X", "UP_X_LOW"]
        );
    }

    #[test]
    fn each_warning_stands_alone() {
        let warns = |change: fn(&mut Findings), words: &str| {
            let mut findings = sound();
            change(&mut findings);
            let text = text(&findings);
            assert!(text.contains(words), "{text}");
            assert_eq!(text.matches("warning").count(), 1, "{text}");
        };
        warns(|f| f.balance = 2e-8, "off by 2.0e-08 of the largest");
        warns(|f| f.balance = f64::NAN, "off by nan");
        warns(
            |f| f.losses.clipping = 0.45,
            "4.5e-01 of the largest energy",
        );
        warns(|f| f.strain = Some(0.35), "strain is 0.35, above 0.2");
        warns(|f| f.dt = 2.1, "(2), so that no vibration");
        warns(|f| f.dt = 4e-4, "longest increment (0.0004) is less");
        warns(|f| f.open = vec!["A_B".into()], "contact A_B never closed");
    }
}
