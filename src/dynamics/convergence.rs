use super::contact_forces::ContactForces;
use super::mass::largest;
use super::{PassReport, Worst};

/// Round-off of a sum of some terms, in units of its largest term.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

/// What residual and correction of a pass are measured against: computed scales, so that the
/// answer does not depend on the system of units.
pub(super) struct Scales {
    /// Largest of the forces in equilibrium.
    force: f64,
    /// Round-off of the residual.
    noise: f64,
    /// Largest displacement increment.
    increment: f64,
    /// Round-off of the displacements.
    resolution: f64,
    tolerance: f64,
}

impl Scales {
    /// `force`: largest force in equilibrium; `stiffness`, `inertia`: largest diagonal entries of
    /// theta2 K and (2/dt²) M; `displacement`, `increment`: largest U and d; `position`: largest
    /// coordinate of a pair in contact.
    ///
    /// A force from displacements U carries the round-off of K U, the inertia force that of
    /// (2/dt²) M d, and a force that closes a gap between positions x that of K* x: a residual is
    /// not measured finer than that.
    pub fn new(
        force: f64,
        (stiffness, inertia): (f64, f64),
        (displacement, increment, position): (f64, f64, f64),
        tolerance: f64,
    ) -> Self {
        Scales {
            force,
            noise: ROUND_OFF
                * (stiffness * displacement.max(position) + inertia * increment.max(position)),
            increment,
            resolution: ROUND_OFF * displacement,
            tolerance,
        }
    }

    /// Relative residual and correction of a pass.
    pub fn report(
        &self,
        residual: &[f64],
        du: &[f64],
        forces: &ContactForces,
        pivots: usize,
    ) -> PassReport {
        let relative = |value: f64, scale: f64, floor: f64| {
            let scale = scale.max(floor / self.tolerance);
            if scale == 0.0 { value } else { value / scale }
        };
        let (active, stick) = forces.count();
        PassReport {
            residual: relative(largest(residual), self.force, self.noise),
            correction: relative(largest(du), self.increment, self.resolution),
            active,
            stick,
            lcp_size: forces.problem_size,
            pivots,
        }
    }

    /// Whether residual and correction are both below the tolerance. A residual that is all
    /// round-off says the same of the correction that follows from it.
    pub fn converged(&self, report: &PassReport) -> bool {
        let all_noise = self.noise > self.tolerance * self.force;
        report.residual <= self.tolerance && (report.correction <= self.tolerance || all_noise)
    }
}

/// The node with the largest residual; `residual` over the unknowns, whose dofs are given.
pub(super) fn worst(
    residual: &[f64],
    dof_of: &[usize],
    position: impl Fn(usize) -> [f64; 2],
    value: f64,
) -> Option<Worst> {
    let larger = |a: &usize, b: &usize| residual[*a].abs().total_cmp(&residual[*b].abs());
    let node = dof_of[(0..residual.len()).max_by(larger)?] / 2;
    Some(Worst {
        node,
        position: position(node),
        quantity: "force residual",
        value,
    })
}
