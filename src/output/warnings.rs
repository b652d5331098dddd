//! Losses of energy of a run, and warnings about a whole run. Losses and warnings are printed at the end of the run,
//! and by `info` from the result file.

use super::format::{counted, general, scientific, wrap, wrap_words};
use super::model_group::BodyTimes;
use super::strain::LARGE;
use crate::dynamics::{Energy, Touch};
use crate::model::ALL_EXTERIOR;

/// Energy balance, relative to the largest energy, above which there is a warning.
pub(crate) const BALANCE: f64 = 1e-8;
/// Number of increments in the transit time of the shortest edge above which the errors of the mesh dominate.
const MANY: f64 = 100.0;
/// Number of increments in the longest period that resolve it well.
const ENOUGH: f64 = 20.0;

/// Energy of hourglass modes, as a part of the strain energy, above which there is a warning.
const HOURGLASS: f64 = 0.05;
/// Part of the largest energy of a run below which its strain energy does not matter.
const SMALL: f64 = 1e-3;

/// Largest energy of hourglass modes as a part of the largest strain energy (with the energy that materials
/// have dissipated); 0 if this energy is small compared with the largest energy of the run.
pub(super) fn hourglass_part([hourglass, internal]: [f64; 2], largest: f64) -> f64 {
    match internal > SMALL * largest {
        true => hourglass / internal,
        false => 0.0,
    }
}

/// Numbers of a whole run from which the warnings are made.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Findings {
    /// Largest energy balance as a part of the largest energy.
    pub balance: f64,
    /// Losses of energy.
    pub losses: Losses,
    /// Largest principal strain in a material for small strains, if it is known.
    pub strain: Option<f64>,
    /// Largest energy of hourglass modes as a part of the largest strain energy; 0 if this energy does not matter.
    pub hourglass: f64,
    /// Names of the contacts that never closed, sorted.
    pub open: Vec<String>,
    /// The touches that matter for the warnings.
    pub touches: Touches,
    /// Largest force that holds a motion which only facets resist, relative to the normal forces at its body.
    pub held: f64,
    /// Length of the longest increment at whose end something moves; 0 if there is none, as in static steps.
    pub dt: f64,
    /// Last time.
    pub time: f64,
    /// Transit times of waves in the bodies, if they are known.
    pub bodies: Vec<BodyTimes>,
}

impl Findings {
    /// The warnings, each a sentence that says what to do, in lines of the screen.
    pub fn lines(&self) -> Vec<String> {
        let mut texts: Vec<String> = self.balance_text().into_iter().collect();
        if self.dt > 0.0 {
            texts.extend(self.losses.advice());
        }
        let others = [
            self.held_text(),
            self.touches.brief_text(),
            self.touches.narrow_text(),
            self.strain_text(),
            self.hourglass_text(),
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

    fn hourglass_text(&self) -> Option<String> {
        (self.hourglass > HOURGLASS).then(|| {
            format!(
                "hourglass modes of CPE4R, CPS4R or CAX4R hold up to {} % of the strain energy, above {} %, so that their \
                 stresses show only a part of the bending: choose several elements across what bends, or CPE4I, \
                 CPS4I, CAX4I, CPE8R, CPS8R or CAX8R",
                general(100.0 * self.hourglass, 2),
                general(100.0 * HOURGLASS, 1),
            )
        })
    }

    fn held_text(&self) -> Option<String> {
        (self.held > 0.0).then(|| {
            format!(
                "a body that slides without friction was held where it was, with up to {} of its normal forces: not more \
                 than the facets of its surfaces make of them (RF has it at nodes of the body). A support that \
                 holds it puts an end to it; contact from surface to surface and a finer mesh make it less",
                scientific(self.held, 1),
            )
        })
    }

    fn strain_text(&self) -> Option<String> {
        let strain = self.strain.filter(|&strain| strain > LARGE)?;
        Some(format!(
            "the largest principal strain is {}, above {}, where a St. Venant-Kirchhoff material \
             (*ELASTIC) is too stiff in tension and too soft in compression: trust no forces there; \
             choose a material for large strains with the same constants (*ELASTIC, TYPE=HENCKY, near \
             Abaqus' law, or *ELASTIC, TYPE=NEO HOOKE for rubber) or lower the loads",
            general(strain, 4),
            general(LARGE, 1),
        ))
    }

    /// Warns about an increment that is longer than the longest period 2 L/c of longitudinal vibration, so the
    /// vibration of no body is resolved.
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

    /// Warns about an increment in which a wave covers only a small part of the shortest edge, so errors of the mesh
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

/// Sorted names of the contacts that never closed, from the names of all contacts and whether each has closed. Two
/// contacts with slave and master exchanged count as closed if one of them has closed, and so do all contacts of
/// general contact.
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

/// Part of the largest energy below which a loss is not shown.
const NEGLIGIBLE: f64 = 1e-10;
/// Part of the largest energy above which there is a warning about a loss.
const MUCH: f64 = 0.01;

/// Energies that have left the bodies since the start, as parts of the largest energy or external work; negative values
/// were put in.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Losses {
    /// Landing forces: energy lost to normal contact forces, because nodes land within increments.
    pub landing_forces: f64,
    /// The part of these losses at nodes that land where others of the same bodies have opened.
    pub handover: f64,
    /// Node impacts: energy that impulses remove from the mass of landing nodes.
    pub node_impacts: f64,
    /// Energy lost by nodes without mass that come to rest after a release.
    pub release: f64,
    /// Energy given back after landings and releases, as a negative loss.
    pub returned: f64,
    /// Energy lost to the damping of the materials.
    pub damping: f64,
    /// Energy lost to friction.
    pub friction: f64,
    /// Energy that the materials have dissipated.
    pub materials: f64,
    /// Energy lost to the scheme of time integration.
    pub scheme: f64,
}

impl Losses {
    /// The losses of a ledger as parts of the largest energy or work, with the normal work at nodes that replace other
    /// closed nodes; zero where they may be round-off.
    pub fn new(energy: &Energy, handover_work: f64, largest: f64) -> Self {
        let part = |loss: f64, largest: f64| match loss.abs() <= energy.round_off {
            true => 0.0,
            false => part(loss, largest),
        };
        Losses {
            landing_forces: part(-energy.normal_contact_work, largest),
            handover: part(-handover_work, largest),
            node_impacts: part(energy.impact_loss, largest),
            release: part(energy.release_loss, largest),
            returned: part(-energy.landing_return, largest),
            damping: part(energy.damping, largest),
            friction: part(energy.friction_dissipation, largest),
            materials: part(energy.material_dissipation, largest),
            scheme: part(energy.numerical_dissipation, largest),
        }
    }

    /// The losses that count, in per cent, in lines of the screen; empty if nothing is lost.
    pub fn lines(&self) -> Vec<String> {
        let all = [
            ("landing forces", self.landing_forces),
            ("node impacts", self.node_impacts),
            ("release", self.release),
            ("returned", self.returned),
            ("damping", self.damping),
            ("friction", self.friction),
            ("materials", self.materials),
            ("scheme", self.scheme),
        ];
        let counts = |&(_, part): &(&str, f64)| part.is_nan() || part.abs() > NEGLIGIBLE;
        let percent = |(name, part): (&str, f64)| format!("{name} {} %", general(100.0 * part, 2));
        let told: Vec<String> = all.into_iter().filter(counts).map(percent).collect();
        match told.is_empty() {
            true => Vec::new(),
            false => wrap("lost", &told),
        }
    }

    /// Advice, with its price, on how to reduce each loss above a hundredth of the largest energy.
    pub fn advice(&self) -> Vec<String> {
        let landings = self.landing_forces + self.release + self.returned;
        let landed = match self.is_handover() {
            true => (
                "nodes that take each other's place in lasting contact, as in rolling and sliding, took",
                "choose smaller increments or smaller elements at the surface; LANDING=RETURN would \
                 turn the loss into vibrations of the mesh",
            ),
            false => (
                "nodes that land within increments took",
                "choose LANDING=RETURN of *STICKSLIP (a solve for each landing; bodies go on \
                 bouncing and ringing), IMPACT TIME=EVENT (more increments) or smaller increments",
            ),
        };
        let rings = match self.is_handover() && self.returned < 0.0 {
            true => self.handover,
            false => 0.0,
        };
        let texts = [
            (landings, landed.0, landed.1),
            (
                rings,
                "LANDING=RETURN makes forces ring: to nodes that take each other's place in lasting contact, \
                 as in rolling and sliding, it gave back",
                "choose LANDING=PLASTIC with smaller increments or smaller elements at the surface",
            ),
            (
                -landings,
                "the normal contact forces put in",
                "choose smaller increments, or SCHEME=ENERGY-MOMENTUM",
            ),
            (
                self.node_impacts,
                "impulses that stop the mass of landing nodes took",
                "choose CONTACT MASS=REDISTRIBUTED with LANDING=RETURN (shifts the highest \
                 frequencies; bodies go on bouncing and ringing; layers of one or two elements keep \
                 their mass) or a finer mesh at the surface",
            ),
            (
                self.scheme.abs(),
                "the time integration scheme changed the energy by",
                "choose SCHEME=ENERGY-MOMENTUM, which keeps it (vibrations stay too), or smaller \
                 increments",
            ),
        ];
        let text = |(part, what, choice): (f64, &str, &str)| {
            let is_small = part <= MUCH;
            (!is_small).then(|| {
                let part = scientific(part, 1);
                let limit = general(MUCH, 1);
                format!("{what} {part} of the largest energy, above {limit}: {choice}")
            })
        };
        texts.into_iter().filter_map(text).collect()
    }

    /// Whether most of the losses at landings occur at nodes that replace each other.
    fn is_handover(&self) -> bool {
        self.handover > self.landing_forces / 2.0
    }
}

/// The ratio `value / whole`; 0 if `value` is 0, for any `whole`.
pub(crate) fn part(value: f64, whole: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value / whole }
}

/// Smallest energy of the approach of two bodies that matters, as a part of the largest energy.
const MATTERS: f64 = 0.01;
/// Smallest number of increments of a touch, from landing to rebound, that resolves its course; also the largest number
/// between two touches of the same bodies that count as one.
const ENOUGH_INCREMENTS: usize = 10;
/// Number of increments of a touch that is recommended.
const GOOD_INCREMENTS: f64 = 20.0;
/// Smallest number of nodes of a touch, where no corner bounds it, that resolves the shape of its pressure.
const ENOUGH_NODES: usize = 4;

/// The touches of a run that matter and are not resolved.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Touches {
    /// Number of touches that matter.
    all: usize,
    /// Touches with too few increments: their number, and the touch with the fewest.
    brief: WorstTouch,
    /// Touches with too few nodes.
    narrow: WorstTouch,
}

/// Number of touches that are not resolved, and the worst touch.
type WorstTouch = Option<(usize, Touch)>;

impl Touches {
    /// The touches of a run that matter compared with its largest energy.
    pub fn new(all: &[Touch], largest: f64) -> Self {
        let mut touches: Vec<Touch> = Vec::new();
        for touch in all {
            let same = |before: &&mut Touch| before.bodies == touch.bodies;
            match touches.iter_mut().rev().find(same) {
                Some(before) if touch.first - before.last <= ENOUGH_INCREMENTS => {
                    join(before, touch);
                }
                _ => touches.push(*touch),
            }
        }
        touches.retain(|touch| touch.energy > MATTERS * largest);
        let brief = |touch: &&Touch| increments(touch) < ENOUGH_INCREMENTS;
        let narrow = |touch: &&Touch| touch.nodes < ENOUGH_NODES && !touch.is_at_corner;
        Touches {
            all: touches.len(),
            brief: worst(touches.iter().filter(brief), increments),
            narrow: worst(touches.iter().filter(narrow), |touch| touch.nodes),
        }
    }

    /// Warns about touches whose landing and rebound take only a few increments.
    pub fn brief_text(&self) -> Option<String> {
        let (count, touch) = self.brief?;
        let increments = counted(increments(&touch), "increment");
        let dt = (touch.end - touch.start) / GOOD_INCREMENTS;
        Some(format!(
            "{count} of {} from landing to rebound took less than {ENOUGH_INCREMENTS} increments (one \
             {increments}, from time {}), so that forces and rebounds are not resolved, whatever energy is \
             kept: choose increments of about {}",
            counted(self.all, "contact"),
            general(touch.start, 4),
            general(dt, 1),
        ))
    }

    /// Warns about touches of round surfaces that are narrower than a few elements.
    pub fn narrow_text(&self) -> Option<String> {
        let (count, touch) = self.narrow?;
        Some(format!(
            "{count} of {} from landing to rebound had less than {ENOUGH_NODES} nodes in contact at a \
             time (one {}, from time {}), so that stiffness and duration of the contact are those of the \
             mesh: choose a finer mesh at the surface",
            counted(self.all, "contact"),
            touch.nodes,
            general(touch.start, 4),
        ))
    }
}

/// Number of increments from the landing to the rebound.
fn increments(touch: &Touch) -> usize {
    touch.last + 1 - touch.first
}

/// Joins two touches of the same bodies to one.
fn join(touch: &mut Touch, next: &Touch) {
    touch.last = next.last;
    touch.end = next.end;
    touch.nodes = touch.nodes.max(next.nodes);
    touch.is_at_corner |= next.is_at_corner;
    touch.impulse += next.impulse;
    // the energies go with the squares of the impulses
    touch.energy = (touch.energy.sqrt() + next.energy.sqrt()).powi(2);
}

fn worst<'t>(
    touches: impl Iterator<Item = &'t Touch> + Clone,
    of: fn(&Touch) -> usize,
) -> WorstTouch {
    let worst = touches.clone().min_by_key(|touch| of(touch))?;
    Some((touches.count(), *worst))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run without warnings, with 20 increments in the longest period of the slowest body.
    fn sound() -> Findings {
        Findings {
            balance: 1e-10,
            losses: Losses {
                landing_forces: 0.001,
                ..Losses::default()
            },
            strain: Some(0.1),
            hourglass: 0.04,
            open: vec![],
            touches: Touches::default(),
            held: 0.0,
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
            |f| f.losses.landing_forces = 0.45,
            "4.5e-01 of the largest energy",
        );
        warns(|f| f.strain = Some(0.35), "strain is 0.35, above 0.2");
        warns(|f| f.dt = 2.1, "(2), so that no vibration");
        warns(|f| f.dt = 4e-4, "longest increment (0.0004) is less");
        warns(|f| f.open = vec!["A_B".into()], "contact A_B never closed");
    }

    /// A ledger that has lost 2 of 10 energy units to landing forces and half a unit to node impacts.
    fn energy() -> Energy {
        Energy {
            normal_contact_work: -2.0,
            impact_loss: 0.5,
            friction_dissipation: 4e-10,
            ..Energy::default()
        }
    }

    #[test]
    fn losses_are_told_in_percent_without_round_off() {
        let lines = Losses::new(&energy(), 0.0, 10.0).lines();
        assert_eq!(lines, ["lost     landing forces 20 %   node impacts 5 %"]);
        assert!(Losses::new(&Energy::default(), 0.0, 0.0).lines().is_empty());
        let lost = Energy {
            numerical_dissipation: f64::NAN,
            ..energy()
        };
        assert!(Losses::new(&lost, 0.0, 10.0).lines()[0].ends_with("scheme nan %"));
    }

    #[test]
    fn each_loss_has_its_remedy() {
        let advice = |change: fn(&mut Energy)| {
            let mut energy = energy();
            change(&mut energy);
            Losses::new(&energy, 0.0, 10.0).advice()
        };
        let both = advice(|_| {});
        assert!(both[0].contains("2.0e-01 of the largest") && both[0].contains("LANDING=RETURN"));
        assert!(both[1].contains("5.0e-02 of the largest") && both[1].contains("finer mesh"));
        assert_eq!(both.len(), 2);
        let returned = advice(|e| (e.landing_return, e.release_loss) = (2.05, 0.06));
        assert_eq!(returned, both[1..], "what was given back is not lost");
        let put_in = advice(|e| (e.normal_contact_work, e.impact_loss) = (2.0, 0.0));
        assert!(put_in[0].contains("put in 2.0e-01"), "{put_in:?}");
        let scheme = advice(|e| {
            *e = Energy {
                numerical_dissipation: -3.0,
                ..Energy::default()
            }
        });
        assert!(
            scheme[0].contains("changed the energy by 3.0e-01"),
            "{scheme:?}"
        );
        let user = advice(|e| {
            *e = Energy {
                damping: 5.0,
                friction_dissipation: 5.0,
                ..Energy::default()
            }
        });
        assert!(user.is_empty(), "what the deck asks for");
    }

    #[test]
    fn nodes_that_take_each_others_place_ask_for_smaller_increments() {
        let mut rolling = energy();
        rolling.impact_loss = 0.0;
        let [taken] = &Losses::new(&rolling, -1.5, 10.0).advice()[..] else {
            panic!("one warning");
        };
        assert!(taken.contains("2.0e-01 of the largest energy"), "{taken}");
        assert!(taken.contains("choose smaller increments or"), "{taken}");
        rolling.landing_return = 2.0;
        let [rings] = &Losses::new(&rolling, -1.5, 10.0).advice()[..] else {
            panic!("one warning");
        };
        assert!(
            rings.contains("makes forces ring") && rings.contains("1.5e-01"),
            "{rings}"
        );
        assert!(
            Losses::new(&rolling, -0.5, 10.0).advice().is_empty(),
            "bounces"
        );
    }

    /// A touch that lasts 20 increments and has five nodes.
    fn touch() -> Touch {
        Touch {
            bodies: [Some(0), Some(1)],
            node: 3,
            start: 0.5,
            end: 0.7,
            first: 51,
            last: 70,
            nodes: 5,
            impulse: 1.0,
            energy: 1.0,
            ..Touch::default()
        }
    }

    #[test]
    fn touches_that_matter_are_told_where_they_are_not_resolved() {
        let texts = |change: fn(&mut Touch)| {
            let mut changed = touch();
            change(&mut changed);
            let touches = Touches::new(&[touch(), changed], 2.0);
            [touches.brief_text(), touches.narrow_text()].map(Option::unwrap_or_default)
        };
        let later = |t: &mut Touch| (t.first, t.last) = (100, 104);
        let [brief, narrow] = texts(later);
        assert!(brief.starts_with("1 of 2 contacts") && brief.contains("one 5 increments"));
        assert!(brief.contains("increments of about 0.01"), "{brief}");
        assert_eq!(narrow, "");
        let [brief, narrow] = texts(|t| (t.bodies, t.nodes) = ([None, Some(1)], 3));
        assert!(narrow.contains("(one 3, from time 0.5)"), "{narrow}");
        assert_eq!(brief, "");
        for harmless in [
            |t: &mut Touch| (t.first, t.last) = (75, 76),
            |t: &mut Touch| (t.first, t.last, t.energy) = (100, 101, 0.01),
            |t: &mut Touch| (t.bodies, t.nodes, t.is_at_corner) = ([None; 2], 2, true),
        ] {
            assert_eq!(texts(harmless), [""; 2], "resolved, weak or at a corner");
        }
    }
}
