//! Energies of the ledger. See docs/theory/impacts.md, Ledger.

use crate::linear::larger;

/// Energies; all except the kinetic and the strain energy are cumulative from the start of the
/// analysis.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Energy {
    /// Kinetic energy T.
    pub kinetic: f64,
    /// Strain energy W.
    pub strain: f64,
    /// Part of the strain energy in hourglass modes.
    pub hourglass: f64,
    /// Work of the loads and of the prescribed motion of supports.
    pub external_work: f64,
    /// Work of the temperature: energy that temperature changes add to materials that expand.
    pub thermal_work: f64,
    /// Work of the normal contact forces.
    pub normal_contact_work: f64,
    /// Energy dissipated by friction.
    pub friction_dissipation: f64,
    /// Kinetic energy removed by the impact impulses.
    pub impact_loss: f64,
    /// Kinetic energy given back after landings.
    pub landing_return: f64,
    /// Strain energy that nodes without mass lose as they come to rest after a release.
    pub release_loss: f64,
    /// Energy dissipated by the damping of the materials.
    pub damping: f64,
    /// Energy dissipated by the materials.
    pub material_dissipation: f64,
    /// Energy dissipated by the integration scheme.
    pub numerical_dissipation: f64,
    /// Energy balance; zero for exact solutions, so it measures the residual of the passes.
    pub balance: f64,
    /// Largest kinetic energy, strain energy or external work so far; in static steps also the largest work of the
    /// loads alone or of the supports alone.
    pub scale: f64,
    /// Work that the round-off of the forces may have done in static steps.
    pub round_off: f64,
}

impl Energy {
    /// Enters the work of the temperature in an increment, and the larger of the two parts of this work.
    pub(crate) fn enter_thermal_work(&mut self, [work, part]: [f64; 2]) {
        self.thermal_work += work;
        self.scale = larger(self.scale, part);
    }
}
