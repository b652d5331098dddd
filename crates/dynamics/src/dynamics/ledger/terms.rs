//! Terms of the energy ledger: one function for each term, with its equation. See docs/theory/impacts.md, Ledger; for
//! static increments docs/theory/bodies.md, Static steps.

use std::borrow::Cow;

use super::pair_work::PairWork;
use crate::dynamics::increment::{Release, Returned, Solved};
use crate::dynamics::results::Energy;
use crate::dynamics::step::{StepProblem, dot};

/// Displacements and velocities of an increment after its impulses.
#[derive(Clone, Copy)]
pub(super) struct Kinematics<'m> {
    /// Displacement increment d = U1 - U0 (length).
    pub d: &'m [f64],
    /// Velocities V0+ and V1 (length/time).
    pub v0p: &'m [f64],
    pub v1: &'m [f64],
    /// Length of the increment (time).
    pub dt: f64,
}

impl Kinematics<'_> {
    /// Mean velocity V_mid = (V0+ + V1)/2 of a dof.
    fn v_mid(&self, dof: usize) -> f64 {
        (self.v0p[dof] + self.v1[dof]) / 2.0
    }
}

/// Forces of an increment over all dofs (force). Forces on dofs that follow other dofs, and on nodes of rigid bodies,
/// have been handed over to the dofs that hold or drive these dofs.
pub(super) struct HandedOver<'f> {
    load: Cow<'f, [f64]>,
    internal: Cow<'f, [f64]>,
    contact: Cow<'f, [f64]>,
    inertia: Cow<'f, [f64]>,
}

impl<'f> HandedOver<'f> {
    /// Forces of a converged increment with the contact force B^T P.
    pub fn new(problem: &'f StepProblem, solved: &'f Solved, contact: &'f [f64]) -> Self {
        let turning = &problem.unknowns.turning;
        let handed_over = |force, keeps_driven| {
            let mut force: Cow<[f64]> = problem.unknowns.passed_on(force);
            if !turning.is_empty() {
                let at_end = [&solved.end.u[..], &solved.d];
                turning.hand_over(at_end, keeps_driven, force.to_mut());
            }
            force
        };
        HandedOver {
            load: handed_over(&solved.equilibrium.load, false),
            internal: handed_over(&solved.equilibrium.internal, false),
            contact: handed_over(contact, false),
            inertia: handed_over(&solved.equilibrium.inertia, true),
        }
    }

    /// Work of the support of a dof p in an increment (energy):
    ///
    /// ```text
    /// dt V_mid,p (M A)_p + d_p (F - R - B^T P)_p      eq. (9.1)
    /// ```
    pub fn support_work(&self, k: &Kinematics, p: usize) -> f64 {
        k.dt * k.v_mid(p) * self.inertia[p]
            + k.d[p] * (self.internal[p] - self.load[p] - self.contact[p])
    }

    /// Energy that the backward Euler scheme removes from the free motion beyond the change of the kinetic energy: the
    /// sum over all dofs, computed from the inertia, less the sum over the dofs of supports.
    ///
    /// ```text
    /// (d - dt V_mid).M A      eq. (4.27)
    /// ```
    pub fn euler_dissipation(
        &self,
        k: &Kinematics,
        inertia: &[f64],
        supports: impl Iterator<Item = usize>,
    ) -> f64 {
        let beyond = |dof: usize| k.d[dof] - k.dt * k.v_mid(dof);
        let dofs = 0..k.d.len();
        let all: f64 = dofs.map(|dof| beyond(dof) * inertia[dof]).sum();
        let of_supports: f64 = supports.map(|p| beyond(p) * self.inertia[p]).sum();
        all - of_supports
    }
}

/// Work of the loads in an increment `d` (energy). The forces lambda of hinges are part of the load R but do no work,
/// so these forces are excluded:
///
/// ```text
/// d.R - lambda.(C d)      eq. (9.1)
/// ```
///
/// `gaps` are the gaps C d of the hinges (length).
pub(super) fn load_work(d: &[f64], load: &[f64], hinges: &[f64], gaps: &[f64]) -> f64 {
    dot(d, load) - dot(hinges, gaps)
}

/// Work of the impulses J = Bn^T Phi + Bt^T Psi (force time) on the velocity V0 from which the impulses start, and on
/// its change dV (energy):
///
/// ```text
/// J.(V0 + V0+)/2 = J.V0 + J.dV/2      eq. (9.4)
/// ```
pub(super) fn impulse_work(seen: &[f64], change: &[f64], impulse: &[f64]) -> f64 {
    dot(seen, impulse) + dot(change, impulse) / 2.0
}

/// Work (energy) of the reaction impulses M (V0+ - V0) - J (force time) of supports, which keep
/// their velocity V0 through the impulses:
///
/// ```text
/// sum over supports p of V0_p (M (V0+ - V0) - J)_p      eq. (9.1)
/// ```
pub(super) fn impulse_support_work(
    supports: impl Iterator<Item = usize>,
    v0: &[f64],
    reaction: &[f64],
) -> f64 {
    supports.map(|p| v0[p] * reaction[p]).sum()
}

/// Energy that the scheme dissipates. `internal_work` is the work d.F of the internal force, with damping, plus the
/// work H of the temperature:
///
/// ```text
/// d.F + H - (W1 - W0) - d.F_d - int D dOmega      eq. (9.5)
/// ```
pub(super) fn scheme_dissipation(
    internal_work: f64,
    [strain0, strain1]: [f64; 2],
    damping: f64,
    material_dissipation: f64,
) -> f64 {
    internal_work - (strain1 - strain0) - damping - material_dissipation
}

/// Strain energy at the end of an increment before nodes without mass come to rest (energy), computed from the energy
/// at rest:
///
/// ```text
/// W1 + R - (work of the loads on the way to the rest)      eq. (6.15)
/// ```
pub(super) fn strain_before_rest(strain: f64, release: &Release) -> f64 {
    strain + release.loss - release.load_work
}

/// Enters the work of the normal forces and of friction of every pair, eq. (9.2) and eq. (9.3).
pub(super) fn enter_pair_works(energy: &mut Energy, works: &[PairWork]) {
    for work in works {
        energy.normal_contact_work += work.normal;
        energy.friction_dissipation += work.friction;
    }
}

/// Enters the returns and losses of landings and releases. The terms of landings are the energy D of eq. (6.5) with the
/// work of the supports, eq. (6.10), and the friction taken back, eq. (6.13). The terms of releases are the loss R and
/// the work of the loads while nodes come to rest, eq. (6.15).
pub(super) fn enter_returned(energy: &mut Energy, returned: &Returned) {
    let Release {
        loss, load_work, ..
    } = returned.release;
    energy.landing_return += returned.energy();
    energy.friction_dissipation -= returned.friction();
    energy.release_loss += loss;
    energy.external_work += load_work + returned.support_work;
}

/// Work of supports between two equilibria (energy), along the path d from their forces f (dof, force) at the start to
/// their forces at the end:
///
/// ```text
/// sum over supports p of d_p (f0 + f1)_p/2      eq. (12.7)
/// ```
pub(super) fn static_support_work(travel: &[f64], reactions: [&[(usize, f64)]; 2]) -> f64 {
    let all = reactions.into_iter().flatten();
    all.fold(0.0, |sum, &(p, reaction)| sum + travel[p] * reaction / 2.0)
}

/// Work along a path of the out-of-balance forces (force), less the work of the supports (energy): the part that rigid
/// bodies absorb because their nodes move on chords.
pub(super) fn work_within(travel: &[f64], missing: &[f64], reactions: &[(usize, f64)]) -> f64 {
    let of_supports = |left: f64, &(p, reaction): &(usize, f64)| left - travel[p] * reaction;
    reactions.iter().fold(dot(travel, missing), of_supports)
}

/// The balance of all energies; `start` is the energy T + W at the start of the analysis:
///
/// ```text
/// balance = T + W - (T + W)_start - external_work - thermal_work - normal_contact_work
///           + friction_dissipation + impact_loss - landing_return + release_loss
///           + damping + material_dissipation + numerical_dissipation      eq. (9.6)
/// ```
pub(super) fn balance(e: &Energy, start: f64) -> f64 {
    e.kinetic + e.strain - start - e.external_work - e.thermal_work - e.normal_contact_work
        + e.friction_dissipation
        + e.impact_loss
        - e.landing_return
        + e.release_loss
        + e.damping
        + e.material_dissipation
        + e.numerical_dissipation
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::testing;
    use crate::dynamics::increment::PairReturn;

    fn near(found: f64, expected: f64) {
        let scale = expected.abs().max(1.0);
        assert!(
            (found - expected).abs() < 1e-14 * scale,
            "{found} {expected}"
        );
    }

    /// Forces of an increment in which no dof hands its force over to other dofs.
    fn forces(load: [f64; 2], internal: [f64; 2], contact: [f64; 2]) -> HandedOver<'static> {
        let own = |force: [f64; 2]| Cow::Owned(force.to_vec());
        HandedOver {
            load: own(load),
            internal: own(internal),
            contact: own(contact),
            inertia: own([0.0; 2]),
        }
    }

    /// A support accelerates a mass m on a spring k from rest with the acceleration a, against a load R and a contact
    /// force P. The support does the work m (a dt)²/2 + k d²/2 - (R + P) d.
    #[test]
    fn a_support_gives_kinetic_and_strain_energy_against_the_other_forces() {
        let (m, a, k, dt) = (3.0, 0.7, 5.0, 0.4);
        let (load, contact) = (1.1, -0.3);
        let d = a * dt * dt / 2.0;
        let kinematics = Kinematics {
            d: &[9.0, d],
            v0p: &[9.0, 0.0],
            v1: &[9.0, a * dt],
            dt,
        };
        let mut forces = forces([0.0, load], [0.0, k * d / 2.0], [0.0, contact]);
        forces.inertia = Cow::Owned(vec![0.0, m * a]);
        let expected = m * (a * dt).powi(2) / 2.0 + k * d * d / 2.0 - load * d - contact * d;
        near(forces.support_work(&kinematics, 1), expected);
    }

    /// Backward Euler has d = dt V1 and M A = M (V1 - V0)/dt. From the free mass backward Euler removes (V1 - V0).M
    /// (V1 - V0)/2 beyond the change of the kinetic energy, eq. (4.27).
    #[test]
    fn the_backward_euler_scheme_dissipates_the_square_of_the_change_of_velocity() {
        let (m, dt) = ([3.0, 7.0], 0.4);
        let (v0, v1) = ([2.0, -1.0], [0.5, 4.0]);
        let inertia = [0, 1].map(|i| m[i] * (v1[i] - v0[i]) / dt);
        let kinematics = Kinematics {
            d: &v1.map(|v| dt * v),
            v0p: &v0,
            v1: &v1,
            dt,
        };
        let mut forces = forces([0.0; 2], [0.0; 2], [0.0; 2]);
        forces.inertia = Cow::Borrowed(&inertia);
        let found = |supports: &[usize]| {
            forces.euler_dissipation(&kinematics, &inertia, supports.iter().copied())
        };
        let of = |i: usize| m[i] * (v1[i] - v0[i]).powi(2) / 2.0;
        near(found(&[]), of(0) + of(1));
        near(found(&[1]), of(0));
        near(found(&[0, 1]), 0.0);
    }

    /// The force of a hinge does no work even if the passes have left a gap: only d.R remains.
    #[test]
    fn hinges_do_no_work() {
        let (d, own, lambda) = ([0.3, 0.2999], [2.0, -5.0], 7.0);
        let load = [own[0] + lambda, own[1] - lambda];
        let gap = d[0] - d[1];
        near(
            load_work(&d, &load, &[lambda], &[gap]),
            0.3 * 2.0 - 0.2999 * 5.0,
        );
    }

    /// A mass that hits the ground at v rebounds at e v: by Poisson's law, impulses remove m v² (1 - e²)/2.
    #[test]
    fn an_impact_takes_the_kinetic_energy_of_the_rebound_less() {
        let (m, v) = (2.0, 3.0);
        for rebound in [0.0, 0.5, 1.0] {
            let change = (1.0 + rebound) * v;
            let work = impulse_work(&[0.0, -v], &[0.0, change], &[0.0, m * change]);
            near(work, -m * v * v * (1.0 - rebound * rebound) / 2.0);
        }
    }

    /// A plate with the prescribed velocity w stops a mass m with the velocity v. The work of the plate's support, less
    /// the loss m (v - w)²/2, is the change of kinetic energy m (w² - v²)/2.
    #[test]
    fn supports_keep_their_velocity_through_an_impact() {
        let (m, plate, v, w) = (2.0, 50.0, -3.0, 0.8);
        let (v0, change) = ([w, v], [0.0, w - v]);
        let impulse = [-m * (w - v), m * (w - v)];
        let reaction = [0, 1].map(|i| [plate, m][i] * change[i] - impulse[i]);
        let loss = -impulse_work(&v0, &change, &impulse);
        near(loss, m * (v - w).powi(2) / 2.0);
        let work = impulse_support_work([0].into_iter(), &v0, &reaction);
        near(work, w * m * (w - v));
        near(work - loss, m * (w * w - v * v) / 2.0);
    }

    /// A spring of energy k u⁴/4 whose force is evaluated at mid-increment, a dashpot c, and a flow that dissipates
    /// 1/2. The force of the spring at u/2 is k u³/8, so this work is less than the energy of the spring by k u⁴/8.
    #[test]
    fn the_scheme_dissipates_what_no_other_term_has() {
        let (k, u, c, dt): (f64, f64, f64, f64) = (3.0, 2.0, 0.5, 0.25);
        let strain = |u: f64| k * u.powi(4) / 4.0;
        let damping = c * u / dt * u;
        let work = u * (k * (u / 2.0).powi(3) + c * u / dt) + 0.5;
        let found = scheme_dissipation(work, [strain(0.0), strain(u)], damping, 0.5);
        near(found, -k * u.powi(4) / 8.0);
    }

    /// A load R holds a node on a spring k at u until its contact opens; then the node comes to rest at R/k. The node
    /// loses the energy k (u - R/k)²/2, by which the potential W - R.u decreases.
    #[test]
    fn the_strain_energy_before_the_rest_is_that_of_the_place_left() {
        let (k, load, u) = (4.0, 1.0, 0.75);
        let rest = load / k;
        let release = Release {
            loss: k * (u - rest) * (u - rest) / 2.0,
            load_work: load * (rest - u),
            opened: Vec::new(),
        };
        let after = k * rest * rest / 2.0;
        near(strain_before_rest(after, &release), k * u * u / 2.0);
    }

    /// Work of a pair with the given parts: normal, fit, friction.
    fn work([normal, fit, friction]: [f64; 3]) -> PairWork {
        let constraint = testing::at_face([0.0; 2]);
        PairWork {
            key: constraint.key,
            normal,
            fit,
            friction,
            sliding: 0.0,
            surfaces: constraint.surface_parts(),
        }
    }

    /// The works of two pairs are added to the works in the ledger. The work of a fit belongs to the supports of the
    /// fit and is entered there.
    #[test]
    fn pairs_add_their_normal_work_and_their_friction() {
        let mut energy = Energy {
            normal_contact_work: 1.0,
            friction_dissipation: 2.0,
            ..Energy::default()
        };
        enter_pair_works(
            &mut energy,
            &[work([0.25, 8.0, 0.5]), work([-2.0, 8.0, 4.0])],
        );
        let expected = Energy {
            normal_contact_work: -0.75,
            friction_dissipation: 6.5,
            ..Energy::default()
        };
        assert_eq!(energy, expected);
    }

    /// Returns and releases leave the balance unchanged if the kinetic energy has changed by them. The motion gains the
    /// energy D, the work of supports and the energy from friction; the strain energy loses R less the work of loads.
    #[test]
    fn what_is_given_back_keeps_the_balance() {
        let mut energy = Energy {
            strain: 10.0,
            friction_dissipation: 3.0,
            external_work: 13.0,
            ..Energy::default()
        };
        near(balance(&energy, 0.0), 0.0);
        let pair = |energy: f64, friction: f64| PairReturn {
            key: testing::at_face([0.0; 2]).key,
            energy,
            friction,
            normal: 9.0,
            tangential: 9.0,
            vector: [9.0; 2],
        };
        let returned = Returned {
            pairs: vec![pair(0.5, 0.125), pair(0.25, 0.0)],
            support_work: 2.0,
            release: Release {
                loss: 1.0,
                load_work: -0.5,
                opened: Vec::new(),
            },
        };
        enter_returned(&mut energy, &returned);
        assert_eq!(energy.landing_return, 0.75);
        assert_eq!(energy.friction_dissipation, 2.875);
        assert_eq!(energy.release_loss, 1.0);
        assert_eq!(energy.external_work, 14.5);
        energy.kinetic += 0.75 + 0.125 + 2.0;
        energy.strain += -1.0 - 0.5;
        near(balance(&energy, 0.0), 0.0);
    }

    /// Two supports at the ends of a spring k stretch the spring from u to u + d; their work is the change of k u²/2.
    #[test]
    fn static_supports_stretch_a_linear_spring() {
        let (k, u, travel): (f64, f64, [f64; 3]) = (6.0, 0.5, [-0.125, 9.0, 0.25]);
        let stretch = travel[2] - travel[0];
        let [before, after] = [k * u, k * (u + stretch)].map(|force| [(0, -force), (2, force)]);
        let expected = k * ((u + stretch).powi(2) - u * u) / 2.0;
        near(static_support_work(&travel, [&before, &after]), expected);
    }

    /// A rod turns between a support and a node that a force pulls: along the chord of the node the force does work
    /// that no support has done. If the node has a support, the support does all of the work on the chord.
    #[test]
    fn rigid_bodies_hold_work_on_the_chords_of_their_nodes() {
        let (travel, missing) = ([0.0, 0.0, 0.5, 0.25], [-4.0, 0.0, 4.0, 2.0]);
        near(work_within(&travel, &missing, &[(0, -4.0), (1, 0.0)]), 2.5);
        near(work_within(&travel, &missing, &[(2, 4.0), (3, 2.0)]), 0.0);
    }

    /// Every energy has its own sign in the balance.
    #[test]
    fn the_balance_has_every_term_with_its_sign() {
        let energy = Energy {
            kinetic: 1.0,
            strain: 2.0,
            external_work: 4.0,
            thermal_work: 4096.0,
            normal_contact_work: 8.0,
            friction_dissipation: 16.0,
            impact_loss: 32.0,
            landing_return: 64.0,
            release_loss: 128.0,
            damping: 256.0,
            material_dissipation: 512.0,
            numerical_dissipation: 1024.0,
            hourglass: 0.1,
            balance: 0.2,
            scale: 0.3,
            round_off: 0.4,
        };
        let lost = 16.0 + 32.0 - 64.0 + 128.0 + 256.0 + 512.0 + 1024.0;
        assert_eq!(
            balance(&energy, 2048.0),
            1.0 + 2.0 - 2048.0 - 4.0 - 4096.0 - 8.0 + lost
        );
    }
}
