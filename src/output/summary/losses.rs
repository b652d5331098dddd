//! Where the energy of a run has gone, and what takes less of it.

use crate::dynamics::Energy;
use crate::output::text::{general, scientific, wrap};

/// Part of the largest energy that is too small to be told.
const ROUND_OFF: f64 = 1e-10;
/// Part of the largest energy that is warned about.
const MUCH: f64 = 0.01;

/// Energies that have left the bodies since the start, as parts of the largest energy or external work;
/// negative ones were put in.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Losses {
    /// Taken by the normal contact forces: nodes that land within increments.
    pub clipping: f64,
    /// The part of the clipping of nodes that land where others of the same bodies have opened.
    pub handover: f64,
    /// Taken by the impact impulses: the mass of the nodes that land.
    pub node_mass: f64,
    /// Taken from nodes without mass as they come to rest after a release.
    pub release: f64,
    /// Given back after landings and releases, as a negative loss.
    pub returned: f64,
    /// Taken by the damping of the materials.
    pub damping: f64,
    /// Taken by friction.
    pub friction: f64,
    /// Taken by the materials.
    pub materials: f64,
    /// Taken by the scheme of the time integration.
    pub scheme: f64,
}

impl Losses {
    /// The losses of a ledger beside the largest energy or external work, with the normal work of nodes that take the
    /// place of others.
    pub fn new(energy: &Energy, handover_work: f64, largest: f64) -> Self {
        Losses {
            clipping: part(-energy.normal_contact_work, largest),
            handover: part(-handover_work, largest),
            node_mass: part(energy.impact_loss, largest),
            release: part(energy.release_loss, largest),
            returned: part(-energy.landing_return, largest),
            damping: part(energy.damping, largest),
            friction: part(energy.friction_dissipation, largest),
            materials: part(energy.material_dissipation, largest),
            scheme: part(energy.numerical_dissipation, largest),
        }
    }

    /// The losses that count, in percent, in lines of the screen; none where nothing is lost.
    pub fn lines(&self) -> Vec<String> {
        let all = [
            ("clipping", self.clipping),
            ("node mass", self.node_mass),
            ("release", self.release),
            ("returned", self.returned),
            ("damping", self.damping),
            ("friction", self.friction),
            ("materials", self.materials),
            ("scheme", self.scheme),
        ];
        let counts = |&(_, part): &(&str, f64)| part.is_nan() || part.abs() > ROUND_OFF;
        let percent = |(name, part): (&str, f64)| format!("{name} {} %", general(100.0 * part, 2));
        let told: Vec<String> = all.into_iter().filter(counts).map(percent).collect();
        match told.is_empty() {
            true => Vec::new(),
            false => wrap("lost", &told),
        }
    }

    /// What takes less, and its price, for each loss that is more than a hundredth.
    pub fn advice(&self) -> Vec<String> {
        let landings = self.clipping + self.release + self.returned;
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
                self.node_mass,
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

    /// Whether most of what landings take is that of nodes that take each other's place.
    fn is_handover(&self) -> bool {
        self.handover > self.clipping / 2.0
    }
}

/// `value / whole`; 0 where `value` is 0, whatever the whole.
pub(crate) fn part(value: f64, whole: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value / whole }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ledger that lost 2 of 10 to landings and half a unit to the mass of nodes.
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
        assert_eq!(lines, ["lost     clipping 20 %   node mass 5 %"]);
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
}
