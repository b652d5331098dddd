//! Convergence criterion of the passes: relative residual and relative correction, with local
//! scales and a round-off floor. See docs/theory/time.md, Convergence.

use smallvec::{SmallVec, smallvec};

use super::contact_forces::ContactForces;
use crate::contact::tolerances::{SETTLED_OVERLAP, SETTLED_SLIP, SOLVED_GAP};
use crate::contact::{ClosedPair, Constraint};
use crate::dynamics::results::{PassReport, Worst};
use crate::dynamics::step::{Hinges, Parts, PerBody, ROUND_OFF};
use crate::linear::larger;

/// Factor on the tolerance within which an iterate must be in balance to be the solution, unless its corrections have
/// fallen to round-off. A pass whose residual and correction are below the tolerance ends with an iterate whose error
/// is smaller by the rate of the passes.
const BALANCED: f64 = 0.1;
/// Round-off of the residual once corrections hardly decrease, in units of eq. (4.10). In a row of K the other entries
/// together have about as much round-off as the diagonal entry.
const STAGNANT_NOISE: f64 = 4.0;

/// Scales of residual and correction of a pass. The scales are computed, so the answer does not depend on the system of
/// units. Every part and body has its own scales, so that a light body next to a heavy body is solved as accurately as
/// the heavy body.
pub(crate) struct Scales<'a> {
    parts: &'a Parts,
    /// Largest force in equilibrium of every part.
    force: PerBody,
    /// Round-off of the residual of every part.
    noise: PerBody,
    /// Largest displacement increment of every body.
    increment: PerBody,
    /// Round-off of the displacements of every body.
    resolution: PerBody,
    tolerance: f64,
}

/// Length scales of every body.
pub(crate) struct Lengths {
    /// Largest displacement U so far.
    pub displacement: PerBody,
    /// Largest displacement increment d.
    pub increment: PerBody,
    /// Largest coordinate of a pair in contact.
    pub position: PerBody,
}

/// Round-off of the forces of a part, with the displacement increment and the stiffness with which the forces are
/// compared.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PartNoise {
    /// Round-off n of the residual, eq. (4.10) (force).
    pub force: f64,
    /// Largest displacement increment of the body (length).
    pub travel: f64,
    /// Largest diagonal entry K_ii + (2/dt²) M_ii (force/length).
    pub stiffness: f64,
}

/// Residual of every part and correction of every body in a pass (force; length).
pub(crate) struct Errors {
    pub residual: PerBody,
    pub correction: PerBody,
}

impl<'a> Scales<'a> {
    /// Scales of a pass. `force` and `before` are the largest force in equilibrium of every part, in this pass and so
    /// far. `stiffness` and `inertia` are the largest diagonal entries of theta2 K and (2/dt²) M of every part.
    ///
    /// A force from displacements U has the round-off of K U, and the inertia force has the round-off of (2/dt²) M d. A
    /// force that closes a gap between positions x has the round-off of K* x. A residual cannot be measured more finely
    /// than the round-off of the forces in it. Displacements that close a gap between positions x have the round-off of
    /// x.
    pub fn new(
        parts: &'a Parts,
        [force, before]: [&PerBody; 2],
        (stiffness, inertia): (&[f64], &[f64]),
        lengths: Lengths,
        tolerance: f64,
    ) -> Self {
        let Lengths {
            displacement,
            increment,
            position,
        } = lengths;
        // 4 eps (max K_ii |U| + max (2/dt²) M_ii |d|), at least 4 eps |F|, eq. (4.10)
        let noise = |(part, &body): (usize, &usize)| {
            let of_motion = stiffness[part] * larger(displacement[body], position[body])
                + inertia[part] * larger(increment[body], position[body]);
            ROUND_OFF * larger(of_motion, before[part])
        };
        // 4 eps |U|, eq. (4.11)
        let bodies = displacement.iter().zip(&position);
        Scales {
            parts,
            force: force.clone(),
            noise: parts.of_parts().iter().enumerate().map(noise).collect(),
            resolution: bodies.map(|(u, x)| ROUND_OFF * larger(*u, *x)).collect(),
            increment,
            tolerance,
        }
    }

    /// Whether all forces and all corrections are finite.
    pub fn are_finite(&self, errors: &Errors) -> bool {
        let mut values = self.force.iter().chain(&errors.correction);
        values.all(|value| value.is_finite())
    }

    /// Stricter scales: a part of the tolerance, and no allowance for the round-off of residuals. The stricter scales
    /// apply as long as corrections decrease, since decreasing corrections show that round-off has not been reached.
    pub fn strict(mut self) -> Self {
        self.noise.fill(0.0);
        self.tolerance *= BALANCED;
        self
    }

    /// Scales that allow residuals all their round-off, for passes that can reduce the residual no further.
    pub fn stagnant(mut self) -> Self {
        let noise = self.noise.iter_mut();
        noise.for_each(|noise| *noise *= STAGNANT_NOISE);
        self
    }

    /// Round-off of the forces of every part; `stiffness` gives the largest K_ii + (2/dt²) M_ii of each part
    /// (force/length).
    pub fn noise(&self, stiffness: impl Iterator<Item = f64>) -> Vec<PartNoise> {
        let parts = self.noise.iter().zip(self.parts.of_parts()).zip(stiffness);
        let of_part = |((force, &body), stiffness): ((&f64, &usize), f64)| PartNoise {
            force: *force,
            travel: self.increment[body],
            stiffness,
        };
        parts.map(of_part).collect()
    }

    /// Largest relative residual and correction of a pass.
    pub fn report(&self, errors: &Errors, forces: &ContactForces) -> PassReport {
        let residuals = (0..self.force.len()).map(|part| self.residual(errors, part));
        let corrections = (0..self.increment.len()).map(|body| {
            self.relative(
                errors.correction[body],
                self.increment[body],
                self.resolution[body],
            )
        });
        PassReport {
            residual: residuals.fold(0.0, larger),
            correction: corrections.fold(0.0, larger),
            active: forces.closed.len(),
            stick: forces.closed.sticking(),
            lcp_size: forces.problem_size,
            pivots: forces.pivots,
        }
    }

    /// Whether residual and correction of every part and body are below the tolerance, or round-off. If a residual is
    /// only round-off, the correction that follows from this residual is also only round-off.
    pub fn converged(&self, errors: &Errors) -> bool {
        let mut is_noise: SmallVec<[bool; 8]> = smallvec![true; self.increment.len()];
        for (part, &body) in self.parts.of_parts().iter().enumerate() {
            let residual = errors.residual[part];
            let most = larger(self.tolerance * self.force[part], self.noise[part]);
            if residual.is_nan() || residual > most || most == f64::INFINITY {
                return false;
            }
            is_noise[body] &= residual <= self.noise[part];
        }
        (0..self.increment.len()).all(|body| {
            let most = larger(self.tolerance * self.increment[body], self.resolution[body]);
            is_noise[body] || errors.correction[body] <= most
        })
    }

    /// Whether gaps and slips of the constraints obey the contact law to the tolerance. Closed gaps are zero, and open
    /// gaps are not negative. A pair that has not slipped in the last solution has no slip, and a pair that slips has
    /// no slip in the direction of its friction.
    pub fn obeys_contact_law(&self, contact: &ContactForces, settled: bool) -> bool {
        let overlap = if settled { SETTLED_OVERLAP } else { 0.0 };
        contact.iter().all(|(constraint, pair)| {
            let most = self.closed_gap(constraint);
            match pair {
                None => constraint.gap >= -larger(most, overlap * constraint.scale),
                Some(pair) => {
                    let slips_along = match pair.slips {
                        false => constraint.slip.abs(),
                        true => -pair.state.slip_sign() * constraint.slip,
                    };
                    constraint.gap.abs() <= most
                        && (constraint.mu == 0.0 || slips_along <= most)
                        && self.has_own_friction(constraint, pair)
                }
            }
        })
    }

    /// Whether the forces of a pair obey the coefficient of friction at the slip rate of the pair, if the coefficient
    /// depends on the slip rate.
    fn has_own_friction(&self, constraint: &Constraint, pair: &ClosedPair) -> bool {
        let most = self.tolerance * constraint.friction() * pair.force[0];
        !constraint.mu_varies || pair.out_of_cone(constraint.friction()) <= most
    }

    /// Whether a pass with the correction dU closes the gaps of its closed pairs by its rows, as far as open pairs may
    /// overlap. The gaps do not close if pairs contradict each other: the equal-force rule then lets these forces grow
    /// in balance, while the gaps stay open. The gaps do not close if supports push a body along another under the same
    /// forces: the residual is all round-off, but slave nodes come to other segments.
    pub fn closes_gaps(&self, contact: &ContactForces, du: &[f64]) -> bool {
        contact.acting().all(|(constraint, _)| {
            let most = |part: f64| larger(self.closed_gap(constraint), part * constraint.scale);
            let gap = constraint.gap + constraint.gap_change(du);
            gap.abs() <= most(SETTLED_OVERLAP)
                && constraint.slip_change(du).abs() <= most(SETTLED_SLIP)
        })
    }

    /// Largest allowed gap of a closed pair: tolerance times the displacement increment of its bodies, or round-off.
    fn closed_gap(&self, constraint: &Constraint) -> f64 {
        let of_body =
            |body: usize| larger(self.tolerance * self.increment[body], self.resolution[body]);
        let bodies = constraint.nodes().map(|node| self.parts.of_nodes()[node]);
        let round_off = SOLVED_GAP * constraint.scale;
        bodies.map(of_body).fold(round_off, larger)
    }

    /// Whether the gaps of the hinges in an iterate are as small as the gaps of closed pairs must be.
    pub fn closes_hinges(&self, hinges: &Hinges, u: &[f64]) -> bool {
        let of_node = |node: usize| {
            let body = self.parts.of_nodes()[node];
            larger(self.tolerance * self.increment[body], self.resolution[body])
        };
        let nodes = hinges.nodes();
        nodes.zip(hinges.gaps(u).chunks(2)).all(|([a, b], gap)| {
            let most = larger(of_node(a), of_node(b));
            gap.iter().all(|gap| gap.abs() <= most)
        })
    }

    /// The node with the largest relative residual, if any; `residual` is over the unknowns, whose dofs are given, and
    /// has its largest value for every part.
    pub fn worst(
        &self,
        errors: &Errors,
        residual: &[f64],
        dof_of: &[usize],
        position: impl Fn(usize) -> [f64; 2],
    ) -> Option<Worst> {
        let of_part = |part: &usize| self.residual(errors, *part);
        let larger = |a: &usize, b: &usize| of_part(a).total_cmp(&of_part(b));
        let part = (0..self.force.len()).max_by(larger)?;
        let value = of_part(&part);
        let most = errors.residual[part];
        let is_worst = |(dof, residual): (&usize, &f64)| {
            residual.abs() == most && self.parts.part(*dof) == part
        };
        let unknown = dof_of.iter().zip(residual).position(is_worst)?;
        let node = dof_of[unknown] / 2;
        (value != 0.0).then(|| Worst {
            node,
            position: position(node),
            quantity: "force residual",
            value,
        })
    }

    fn residual(&self, errors: &Errors, part: usize) -> f64 {
        self.relative(errors.residual[part], self.force[part], self.noise[part])
    }

    /// `value` in units of its scale, or of its round-off divided by the tolerance, whichever unit is larger.
    fn relative(&self, value: f64, scale: f64, floor: f64) -> f64 {
        let scale = larger(scale, floor / self.tolerance);
        if scale == 0.0 { value } else { value / scale }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Rows, testing};
    use crate::lcp::ContactState;
    use crate::model::{Friction, FrictionLaw, Mesh, Model};
    use crate::prepare::redistribution_tests::block;

    fn falling() -> Friction {
        FrictionLaw::Decay {
            at_rest: 0.3,
            sliding: 0.1,
            decay: 2.0,
        }
        .into()
    }

    /// Whether [`testing::at_face`] may end an increment of length 1 with the given gap, slip and
    /// forces; `None` is an open pair.
    fn obeys(
        gap_and_slip: [f64; 2],
        friction: &Friction,
        closed: Option<([f64; 2], ContactState)>,
    ) -> bool {
        let mut constraint = testing::at_face(gap_and_slip);
        constraint.mu = friction.at(constraint.slip, 0.0);
        constraint.mu_varies = !friction.is_constant();
        let pair = closed.map(|(force, state)| ClosedPair::new(&constraint, force, state));
        let mut forces = ContactForces::without_constraints(&pair.into_iter().collect());
        forces.relinearize(&mut vec![constraint]);
        let parts = Parts::new(&block([1, 1], |_, _| false, |_, _| true));
        let lengths = Lengths {
            displacement: smallvec![0.0],
            increment: smallvec![1.0],
            position: smallvec![0.0],
        };
        let force = [&smallvec![1.0], &smallvec![0.0]];
        let scales = Scales::new(&parts, force, (&[0.0], &[0.0]), lengths, 1e-11);
        scales.obeys_contact_law(&forces, false)
    }

    #[test]
    fn an_increment_ends_with_the_friction_of_its_own_slip_rate() {
        let sign = |pt: f64| match pt < 0.0 {
            true => ContactState::SlipPlus,
            false => ContactState::SlipMinus,
        };
        for slip in [0.25, -0.25, 2.0, -2.0] {
            let own = falling().at(slip, 0.0);
            let with = |mu: f64| {
                let pt = -mu * slip.signum() * 5.0;
                obeys([0.0, slip], &falling(), Some(([5.0, pt], sign(pt))))
            };
            assert!(with(own) && with(own * (1.0 + 1e-12)), "{slip}");
            for other in [own * (1.0 + 1e-9), own * (1.0 - 1e-9), 0.3] {
                assert!(!with(other), "{slip} {other}");
            }
        }
        let sticks = |pt: f64| obeys([0.0; 2], &falling(), Some(([5.0, pt], ContactState::Stick)));
        assert!(sticks(0.0) && sticks(-1.5) && !sticks(1.5 * (1.0 + 1e-9)));
    }

    #[test]
    fn an_increment_ends_with_gaps_and_slips_of_the_contact_law() {
        let (mu, none) = (&Friction::constant(0.5), &Friction::constant(0.0));
        let [stick, plus] = [ContactState::Stick, ContactState::SlipPlus];
        let closed = |gap, slip, mu, state| obeys([gap, slip], mu, Some(([1.0, 0.0], state)));
        assert!(obeys([1e-3, 0.1], mu, None) && obeys([-1e-12, 0.1], mu, None));
        assert!(!obeys([-1e-9, 0.1], mu, None), "overlap");
        assert!(closed(1e-12, 1e-12, mu, stick));
        assert!(!closed(1e-9, 0.0, mu, stick) && !closed(-1e-9, 0.0, mu, stick));
        assert!(!closed(0.0, 1e-9, mu, stick) && !closed(0.0, -1e-9, mu, stick));
        assert!(closed(0.0, 0.1, none, stick));
        assert!(closed(0.0, 0.1, mu, plus), "slides against its friction");
        assert!(!closed(0.0, -1e-9, mu, plus), "slides along its friction");
    }

    /// A node over ground with the given gap, at dofs 0 and 1.
    fn over_ground(gap: f64) -> Constraint {
        let mut constraint = testing::made_up(&[0, 1], Rows::new(&[0.0, 1.0], &[1.0, 0.0]));
        (constraint.gap, constraint.start_gap) = (gap, gap);
        constraint
    }

    /// A pair that is open, or closed in a given state.
    fn contact(gap: f64, state: Option<ContactState>) -> ContactForces {
        let constraint = over_ground(gap);
        let pair = state.map(|state| ClosedPair::new(&constraint, [1.0, 0.0], state));
        let mut contact = ContactForces::default();
        contact.closed.set(pair.into_iter());
        contact.constraints.push(constraint);
        contact
    }

    fn parts() -> Parts {
        Parts::new(&Model {
            mesh: Mesh {
                node_labels: vec![1],
                coordinates: vec![[0.0; 2]],
                ..Mesh::default()
            },
            ..Model::default()
        })
    }

    /// Scales of one node: forces up to 10, increments up to 0.1, round-off 4 eps 1e3 = 9e-13 of forces, and the
    /// tolerance 1e-9.
    fn scales(parts: &Parts) -> Scales<'_> {
        let lengths = Lengths {
            displacement: smallvec![1.0],
            increment: smallvec![0.1],
            position: smallvec![0.0],
        };
        Scales::new(
            parts,
            [&smallvec![10.0], &smallvec![0.0]],
            (&[1e3][..], &[0.0][..]),
            lengths,
            1e-9,
        )
    }

    #[test]
    fn residual_and_correction_must_both_be_small() {
        let parts = parts();
        let ends = |residual: f64, correction: f64| {
            let errors = Errors {
                residual: smallvec![residual],
                correction: smallvec![correction],
            };
            [scales(&parts), scales(&parts).strict()].map(|scales| scales.converged(&errors))
        };
        assert_eq!(
            ends(0.9e-9, 0.9e-11),
            [true, true],
            "a tenth of the tolerance"
        );
        assert_eq!(ends(5e-9, 0.9e-11), [true, false]);
        assert_eq!(ends(2e-8, 0.0), [false, false]);
        assert_eq!(ends(0.9e-9, 5e-11), [true, false]);
        assert_eq!(ends(0.9e-9, 2e-10), [false, false]);
        // if residuals are round-off, so are corrections, unless they still decrease
        assert_eq!(ends(5e-13, 1.0), [true, false]);
        assert_eq!(ends(f64::NAN, 0.0), [false, false]);
    }

    #[test]
    fn a_pass_must_close_its_gaps() {
        let parts = parts();
        let closes =
            |gap: f64, du: f64, state| scales(&parts).closes_gaps(&contact(gap, state), &[0.0, du]);
        let stick = Some(ContactState::Stick);
        for sign in [1.0, -1.0] {
            assert!(closes(sign * 0.3, -sign * 0.3 + 0.9e-10, stick));
            assert!(!closes(sign * 0.3, -sign * 0.3 + 1.2e-10, stick));
            assert!(!closes(sign * 1e-3, 0.0, stick));
        }
        assert!(closes(0.3, 0.0, None), "an open pair");
    }
}
