//! Energy balance of a run, accumulated increment by increment. See docs/theory/impacts.md, Ledger.

use std::sync::Arc;

use super::pair_work::{EndForces, PairWork, fit_impulse_work, steady_works};
use super::terms::{
    HandedOver, Kinematics, balance, enter_pair_works, enter_returned, impulse_support_work,
    impulse_work, load_work, scheme_dissipation, static_support_work, strain_before_rest,
    work_within,
};
use crate::archive::{Archive, ArchiveError, transfer_fields};
use crate::dynamics::increment::Solved;
use crate::dynamics::results::{Cause, Energy, State};
use crate::dynamics::step::{Equilibrium, ROUND_OFF, StepProblem, Workspace, difference, dot, sum};
use crate::elements::{ElementResult, TangentPart};
use crate::linear::{larger, largest};

/// Normal work of contact in an increment up to which this work is round-off, relative to the largest energy so far.
/// Forces and displacements are converged to 1e-11 (`TOLERANCE`), and the errors of pairs add up.
pub(super) const CONTACT_WORK_ROUND_OFF: f64 = 1e-10;

/// Energy stored by elements, whose results are given, and by springs in a state (force length).
fn strain_energy(problem: &StepProblem, state: &State, elements: &[ElementResult]) -> f64 {
    let of_elements: f64 = elements.iter().map(|element| element.energy).sum();
    of_elements + problem.elements.spring_energy(&state.u)
}

/// Energy ledger: every term is computed on its own, so the balance shows errors.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Ledger {
    pub energy: Energy,
    /// Largest kinetic or strain energy of every body so far.
    pub largest: Vec<f64>,
    /// Momentum M V of the state that the ledger has reached.
    pub momentum: Vec<f64>,
    /// Strain energy, stress and strain of every element.
    pub elements: Arc<[ElementResult]>,
    /// Energy that contact added in the last increment, if any.
    pub contact_energy: Option<f64>,
    /// Work of the pairs in the last increment.
    pub works: Vec<PairWork>,
    /// Forces at the end of the last increment, in a static or quasi-static step.
    pub end: Option<EndForces>,
    /// Kinetic plus strain energy, T + W, at the start of the analysis.
    start: f64,
    /// Work of the loads and work of the supports in static steps.
    sources: [f64; 2],
    /// Largest diagonal entry K_ii of an element or spring in every part at the start (force/length).
    stiffness: Vec<f64>,
}

/// Largest diagonal entry K_ii of an element or spring in every part of the model.
fn stiffness_of_elements(problem: &StepProblem, start: &State) -> Vec<f64> {
    let StepProblem {
        elements, parts, ..
    } = problem;
    let nodes: Vec<&[usize]> = elements.connected().collect();
    let mut most = vec![0.0; parts.of_parts().len()];
    let motion = start.motion();
    elements.for_each_tangent(
        motion,
        TangentPart::Whole,
        |_| true,
        |place, k| {
            let dofs = 2 * nodes[place].len();
            for (i, &node) in (0..dofs).zip(nodes[place].iter().flat_map(|node| [node, node])) {
                let most = &mut most[parts.part(2 * node)];
                *most = larger(*most, k[i * (dofs + 1)]);
            }
        },
    );
    most
}

/// Forces at the end of an increment of a slow motion, from which a static step goes on; the inertia of the slow motion
/// counts as load.
fn end_of_slow_motion(problem: &StepProblem, solved: &Solved) -> EndForces {
    let Equilibrium {
        load,
        internal,
        inertia,
        ..
    } = &solved.equilibrium;
    let load = difference(load, inertia);
    let mut last = EndForces::new(load, internal.clone(), &solved.contact.forces);
    last.reactions = last.of_supports(problem, [&solved.end.u, &solved.d]);
    last
}

impl Ledger {
    /// Opens the ledger at the start of the analysis.
    pub fn new(problem: &StepProblem, start: &State) -> Self {
        let momentum = problem.mass.times(&start.v);
        let kinetic = dot(&start.v, &momentum) / 2.0;
        let elements = problem.elements.evaluate(start.motion());
        let strain = strain_energy(problem, start, &elements);
        let energy = Energy {
            kinetic,
            strain,
            scale: larger(kinetic, strain),
            ..Energy::default()
        };
        let mut ledger = Ledger {
            energy,
            largest: vec![0.0; problem.parts.bodies()],
            momentum,
            stiffness: stiffness_of_elements(problem, start),
            start: kinetic + strain,
            ..Ledger::default()
        };
        ledger.enter_bodies(problem, start, &elements);
        ledger.elements = elements;
        ledger
    }

    /// Transfers all fields of the ledger to or from an archive.
    pub fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        let mut of_elements = self.elements.to_vec();
        archive.transfer(&mut of_elements)?;
        self.elements = of_elements.into();
        transfer_fields!(archive, self => Self {
            energy, largest, momentum, contact_energy, works, end, start, sources, stiffness; elements
        })
    }

    /// Changes the ledger to a step of another procedure at a state with the velocities of the new step. Kinetic energy
    /// that bodies lose as they come to rest counts as numerical dissipation; energy that supports give as they begin
    /// to move counts as work of the supports.
    pub fn change_procedure(&mut self, problem: &StepProblem, state: &State) {
        problem.mass.write_product(&state.v, &mut self.momentum);
        let kinetic = dot(&state.v, &self.momentum) / 2.0;
        let e = &mut self.energy;
        let change = kinetic - e.kinetic;
        e.kinetic = kinetic;
        match problem.integration.has_rates {
            true => e.external_work += change,
            false => {
                e.numerical_dissipation -= change;
                self.end = None;
            }
        }
    }

    /// Enters the kinetic energy of every body and the strain energy of every element in a state.
    fn enter_bodies(&mut self, problem: &StepProblem, state: &State, elements: &[ElementResult]) {
        let parts = problem.parts;
        let mut kinetic = vec![0.0; parts.bodies()];
        for (node, &body) in parts.of_nodes().iter().enumerate() {
            for i in [2 * node, 2 * node + 1] {
                kinetic[body] += state.v[i] * self.momentum[i] / 2.0;
            }
        }
        let mut strains = vec![0.0; parts.bodies()];
        for (element, result) in elements.iter().enumerate() {
            let [node, ..] = problem.elements.nodes(element) else {
                continue;
            };
            strains[parts.of_nodes()[*node]] += result.energy;
        }
        for (most, (kinetic, strain)) in self.largest.iter_mut().zip(kinetic.iter().zip(strains)) {
            *most = largest(&[*most, *kinetic, strain]);
        }
    }

    /// The ledger after a converged increment of length `dt`, which began at `start`, and after the energy given back.
    ///
    /// # Errors
    /// Returns an error if an energy is not finite.
    pub fn entered(
        mut self,
        problem: &StepProblem,
        workspace: &Workspace,
        start: &State,
        solved: &Solved,
        dt: f64,
    ) -> Result<Self, Cause> {
        let (strain0, contact_work0) = (self.energy.strain, self.energy.normal_contact_work);
        self.enter_impulses(problem, start, solved);
        self.enter_state(problem, &solved.end);
        if problem.integration.has_rates {
            self.enter_motion(problem, start, solved, dt, strain0);
        } else {
            self.enter_equilibrium(problem, start, solved, strain0)?;
            self.energy.round_off += self.round_off_work(problem, workspace, solved);
        }
        let work = self.close(&solved.end, contact_work0)?;
        self.contact_energy = work.filter(|_| problem.integration.has_rates);
        Ok(self)
    }

    /// Enters the impulses at the start of an increment: the energy that the impulses remove, and the work of supports,
    /// which keep their velocity.
    fn enter_impulses(&mut self, problem: &StepProblem, start: &State, solved: &Solved) {
        if solved.v0p == start.v {
            return;
        }
        let impulses = &solved.contact.impulses;
        let (impulse, seen) = (impulses.resultant(), impulses.seen(&start.v));
        let change = difference(&solved.v0p, &start.v);
        // -(Phi.Bn + Psi.Bt) (V0 + V0+)/2, eq. (9.4)
        self.energy.impact_loss -= impulse_work(seen, &change, impulse);
        // M (V0+ - V0) - J, with what equations and bodies that turn hand over
        let unknowns = &problem.unknowns;
        let reaction = difference(&problem.mass.times(&change), impulse);
        let mut reaction = unknowns.passed_on(&reaction).into_owned();
        let nothing = vec![0.0; solved.d.len()];
        (unknowns.turning).hand_over([&start.u, &nothing], false, &mut reaction);
        // V0.(M (V0+ - V0) - J) at supports, eq. (9.1)
        self.energy.external_work +=
            impulse_support_work(unknowns.prescribed(), &start.v, &reaction);
    }

    /// Enters the energies and the momentum of the state at the end of an increment.
    fn enter_state(&mut self, problem: &StepProblem, end: &State) {
        let elements = problem.elements.evaluate(end.motion());
        problem.mass.write_product(&end.v, &mut self.momentum);
        self.enter_bodies(problem, end, &elements);
        self.elements = elements;
        let e = &mut self.energy;
        e.strain = strain_energy(problem, end, &self.elements);
        e.hourglass = self.elements.iter().map(|e| e.hourglass_energy).sum();
        e.kinetic = dot(&end.v, &self.momentum) / 2.0;
    }

    /// Enters the work and the losses, term by term, of a dynamic increment that began at `start` with the strain
    /// energy `strain0`, eq. (9.1) to eq. (9.5).
    fn enter_motion(
        &mut self,
        problem: &StepProblem,
        start: &State,
        solved: &Solved,
        dt: f64,
        strain0: f64,
    ) {
        let Solved {
            d,
            v0p,
            end,
            equilibrium,
            returned,
            ..
        } = solved;
        let turning = &problem.unknowns.turning;
        let kinematics = Kinematics {
            d,
            v0p,
            v1: &end.v,
            dt,
        };
        let contact = solved.contact.forces.resultant(d.len());
        let forces = HandedOver::new(problem, solved, &contact);
        let supports = || problem.unknowns.prescribed().chain(turning.driven_dofs());
        let e = &mut self.energy;
        // d.R, and at supports dt V_mid,p (M A)_p + d_p (F - R - B^T P)_p, eq. (9.1)
        let gaps = problem.hinges.gaps(d);
        e.external_work += load_work(d, &equilibrium.load, &equilibrium.hinges, &gaps);
        for p in supports() {
            e.external_work += forces.support_work(&kinematics, p);
        }
        // Pn.(Bn d) and -Pt.(Bt d), eq. (9.2) and eq. (9.3)
        self.works = steady_works(solved);
        enter_pair_works(e, &self.works);
        // Phi (a0 - a1)/dt and Pn (a0 - a1), eq. (9.14)
        let of_impulses = fit_impulse_work(solved, dt);
        e.external_work += of_impulses;
        e.impact_loss += of_impulses;
        for work in &self.works {
            e.external_work += work.fit;
        }
        // y s, y c, D and R, eq. (6.5), eq. (6.10), eq. (6.13) and eq. (6.15)
        enter_returned(e, returned);
        // d.F_d, eq. (4.18), and int D dOmega
        let damping = match problem.has_damping() {
            true => {
                let mut u1 = sum(&start.u, d);
                turning.turn([&start.u, d], &mut u1);
                (problem.elements).damping_dissipation([&start.u, &u1], d, dt)
            }
            false => 0.0,
        };
        e.damping += damping;
        e.material_dissipation += solved.material_dissipation;
        e.enter_thermal_work(solved.thermal_work);
        // (d - dt V_mid).M A, eq. (4.27)
        if problem.integration.backward_euler {
            let dissipation =
                forces.euler_dissipation(&kinematics, &equilibrium.inertia, supports());
            e.numerical_dissipation += dissipation;
        }
        // d.F + H - (W1 - W0) - d.F_d - int D dOmega, eq. (9.5), H being the work of the temperature
        e.numerical_dissipation += scheme_dissipation(
            dot(d, &equilibrium.internal) + solved.thermal_work[0],
            [strain0, strain_before_rest(e.strain, &returned.release)],
            damping,
            solved.material_dissipation,
        );
        self.end = (problem.integration.fades()).then(|| end_of_slow_motion(problem, solved));
    }

    /// Enters the work of a static increment that began at `start` with the strain energy `strain0`. Between two
    /// equilibria, loads, internal force and normal contact forces act with the mean of their values at start and end,
    /// eq. (12.7) and eq. (12.8).
    fn enter_equilibrium(
        &mut self,
        problem: &StepProblem,
        start: &State,
        solved: &Solved,
        strain0: f64,
    ) -> Result<(), Cause> {
        let Solved { d, equilibrium, .. } = solved;
        let before = match self.end.take() {
            Some(before) => before,
            None => EndForces::at(problem, start)?,
        };
        let mut end = EndForces::new(
            equilibrium.load.clone(),
            equilibrium.internal.clone(),
            &solved.contact.forces,
        );
        end.reactions = end.of_supports(problem, [&solved.end.u, d]);
        let at_start = before.of_supports(problem, [&start.u, d]);
        let turning = &problem.unknowns.turning;
        let travel = turning.travel(d);
        let e = &mut self.energy;
        // d.(R0 + R1)/2, and at supports d_p (f0 + f1)_p/2, f = F - R - B^T P, eq. (12.7); what is left is the work of the
        // forces within rigid bodies on the chords of their nodes
        let of_loads = EndForces::trapezoid(&travel, [&before.load, &end.load]);
        let mut of_supports = static_support_work(&travel, [&at_start, &end.reactions]);
        if !turning.is_empty() {
            for (forces, reactions) in [(&before, &at_start), (&end, &end.reactions)] {
                let within = work_within(&travel, &forces.missing(d.len()), reactions);
                e.numerical_dissipation -= within / 2.0;
            }
        }
        // the pairs, eq. (12.8)
        let (works, kept) = before.works(solved, &end);
        enter_pair_works(e, &works);
        for work in &works {
            of_supports += work.fit;
        }
        self.works = works;
        e.external_work += of_loads + of_supports;
        for (all, work) in self.sources.iter_mut().zip([of_loads, of_supports]) {
            *all += work;
            e.scale = larger(e.scale, all.abs());
        }
        // d.(F0 + F1)/2 + H - (W1 - W0) - D, and the difference between a pair's work with its mean force and with the
        // force during its slip
        let dissipated = solved.material_dissipation;
        e.material_dissipation += dissipated;
        e.enter_thermal_work(solved.thermal_work);
        e.numerical_dissipation += EndForces::trapezoid(&travel, [&before.internal, &end.internal])
            + solved.thermal_work[0]
            - (e.strain - strain0)
            - dissipated
            - kept;
        self.end = Some(end);
        Ok(())
    }

    /// Bound of the work that the round-off of forces may do in a static increment. No pass can balance the round-off
    /// of forces. The bound includes the forces of elements without unknowns.
    ///
    /// ```text
    /// max n |d|,   n >= 4 eps K_ii |U|      eq. (9.17)
    /// ```
    fn round_off_work(&self, problem: &StepProblem, workspace: &Workspace, solved: &Solved) -> f64 {
        let parts = problem.parts;
        let u = (workspace.seen).displacements(parts.largest_of_bodies(&solved.end.u));
        let noise = solved.noise(problem, workspace);
        let of_parts = parts.of_parts().iter().zip(&self.stiffness).zip(noise);
        let work = of_parts
            .map(|((&body, k), noise)| larger(noise.force, ROUND_OFF * k * u[body]) * noise.travel);
        work.fold(0.0, larger)
    }

    /// Completes an increment that ends in the state `end`: computes the balance and the largest energy. Returns the
    /// work that the normal contact forces have done since `contact_work0`, if this work is positive beyond round-off.
    ///
    /// # Errors
    /// Returns an error if an energy is not finite.
    fn close(&mut self, end: &State, contact_work0: f64) -> Result<Option<f64>, Cause> {
        let e = &mut self.energy;
        e.balance = balance(e, self.start);
        for energy in [e.kinetic, e.strain, e.external_work, e.thermal_work] {
            e.scale = larger(e.scale, energy.abs());
        }
        let work = e.normal_contact_work - contact_work0;
        let is_positive = work > CONTACT_WORK_ROUND_OFF * e.scale;
        self.check(end)?;
        Ok(is_positive.then_some(work))
    }

    /// Checks that all energies are finite.
    ///
    /// # Errors
    /// If not, returns [`Cause::NotFinite`] with the node that moves most, or is the fastest, in `state`.
    pub fn check(&self, state: &State) -> Result<(), Cause> {
        let e = &self.energy;
        let energies = [
            ("the strain energy", e.strain, &state.u),
            ("the kinetic energy", e.kinetic, &state.v),
            ("the external work", e.external_work, &state.v),
            ("the work of the temperature", e.thermal_work, &state.u),
            (
                "the work of the contact forces",
                e.normal_contact_work,
                &state.v,
            ),
            ("the friction dissipation", e.friction_dissipation, &state.v),
            ("the impact loss", e.impact_loss, &state.v),
            ("the landing return", e.landing_return, &state.v),
            ("the release loss", e.release_loss, &state.u),
            ("the energy taken by damping", e.damping, &state.v),
            (
                "the dissipation of the materials",
                e.material_dissipation,
                &state.u,
            ),
            (
                "the numerical dissipation",
                e.numerical_dissipation,
                &state.u,
            ),
            ("the energy balance", e.balance, &state.v),
        ];
        let wrong = energies.iter().find(|(_, energy, _)| !energy.is_finite());
        wrong.map_or(Ok(()), |&(what, _, motion)| {
            let larger = |i: &usize, j: &usize| motion[*i].abs().total_cmp(&motion[*j].abs());
            let dof = (0..motion.len()).max_by(larger).unwrap_or(0);
            Err(Cause::NotFinite {
                what,
                node: dof / 2,
            })
        })
    }
}
