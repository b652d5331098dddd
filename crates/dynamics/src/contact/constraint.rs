//! A contact constraint, linearised at the current iterate: gap and slip, the rows of its force,
//! and the derivatives of gap and slip. The complementarity problem, contact forces, impulses,
//! convergence and ledger know of contact only its constraints. See docs/theory/contact.md and
//! docs/theory/complementarity.md.
//!
//! The configurations between which contact constraints are linearised, and the form of their
//! rows. See docs/theory/contact.md.

use std::array::from_fn;

use smallvec::SmallVec;

use super::keys::ConstraintKey;
use super::lists::PerDof;
use super::positions::position;
use super::projection::position_round_off;
use super::target::PairTarget;
use super::tolerances::{NOTHING, SOLVED_GAP};
use crate::vectors::dot;

/// A normal and a tangential row over the dofs of a constraint.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Rows {
    /// Normal row.
    pub normal: PerDof<f64>,
    /// Tangential row.
    pub tangential: PerDof<f64>,
}

impl Rows {
    /// Row pair with the values of two slices of the same length.
    #[inline]
    pub fn new(normal: &[f64], tangential: &[f64]) -> Self {
        Rows {
            normal: normal.iter().copied().collect(),
            tangential: tangential.iter().copied().collect(),
        }
    }
}

/// Normal and tangential row over N dofs, with N at most 8.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RowPair<const N: usize> {
    pub normal: [f64; N],
    pub tangential: [f64; N],
}

impl<const N: usize> RowPair<N> {
    #[inline]
    fn rows(&self) -> Rows {
        Rows {
            normal: PerDof::of(self.normal),
            tangential: PerDof::of(self.tangential),
        }
    }
}

/// row.d
pub(super) fn product(row: &[f64; 6], d: &[f64; 6]) -> f64 {
    row.iter().zip(d).map(|(b, d)| b * d).sum()
}

/// The sum p row + q other.
pub(super) fn sum_of(p: f64, row: &[f64; 6], q: f64, other: &[f64; 6]) -> [f64; 6] {
    std::array::from_fn(|k| p * row[k] + q * other[k])
}

/// A constraint g >= 0 with Coulomb friction, linearised at the current iterate.
///
/// ```text
/// nodal forces   B^T P = Bn^T Pn + Bt^T Pt          B: force rows
/// rates          dg = Gn du,  dDt = Gt du           G: derivative rows
/// increment      Bn d = g - g0,  Bt d = Dt          d = U - U0
/// ```
///
/// Force rows and derivative rows are distinct even where their numbers are equal. Force rows make
/// works and momenta right; derivative rows say how gap and slip change from the iterate on.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Constraint {
    /// Key that identifies the constraint.
    pub key: ConstraintKey,
    /// Dofs of the constraint: x and y of one node after the other, slave nodes first, every dof
    /// once.
    pub dofs: PerDof<usize>,
    /// Number of dofs of slave nodes.
    pub slave_dofs: usize,
    /// Force rows Bn and Bt (dimensionless).
    pub force_rows: Rows,
    /// Derivative rows Gn and Gt (dimensionless), where they differ from the force rows.
    pub other_derivative_rows: Option<Rows>,
    /// Gap g of the iterate (length), positive when open; in a fit the allowed overlap is added, eq. (3.15).
    pub gap: f64,
    /// Gap at the start that follows from the force rows, g - Bn d (length); in a fit the overlap allowed at the start
    /// is added.
    pub start_gap: f64,
    /// Slip Dt since the start of the increment (length).
    pub slip: f64,
    /// Coefficient of friction mu that was last set; at first 0.
    pub mu: f64,
    /// Whether the coefficient depends on slip rate or pressure.
    pub mu_varies: bool,
    /// Length s of the normal row, relative to the length for a straight face: the normal force is s Pn, eq. (3.31).
    pub stretch: f64,
    /// Decrease of the overlap that a fit allows within the increment (length), eq. (3.15).
    pub shrinkage: f64,
    /// Length to which gaps are relative: the length of the segment.
    pub scale: f64,
    /// The slave node and target from which the constraint is made.
    pub(super) source: PairTarget,
}

impl Constraint {
    /// The constraint of some nodes, slave node first, with its force rows and derivative rows over their N dofs; its
    /// slip is Bt d. The gap of the constraint contains the overlaps `allowed` at start and end.
    #[inline]
    pub(super) fn of_nodes<const N: usize>(
        source: PairTarget,
        nodes: &[usize],
        [force, derivative]: [RowPair<N>; 2],
        (gap, scale, allowed): (f64, f64, [f64; 2]),
        at: &Configurations,
    ) -> Self {
        let dofs: [usize; N] = from_fn(|k| 2 * nodes[k / 2] + k % 2);
        // g0 = g - Bn d; Dt = Bt d, eq. (3.5); d = U - U0
        let d = dofs.map(|dof| at.u[dof] - at.u0[dof]);
        let product = |row: &[f64; N]| -> f64 { row.iter().zip(&d).map(|(b, d)| b * d).sum() };
        Constraint {
            key: source.pair.key,
            dofs: PerDof::of(dofs),
            slave_dofs: 2,
            force_rows: force.rows(),
            other_derivative_rows: (derivative != force).then(|| derivative.rows()),
            gap: gap + allowed[1],
            start_gap: gap - product(&force.normal) + allowed[0],
            slip: product(&force.tangential),
            mu: 0.0,
            mu_varies: false,
            stretch: 1.0,
            shrinkage: allowed[0] - allowed[1],
            scale,
            source,
        }
    }

    /// Coefficient of friction relative to Pn, mu s: |Pt| <= mu s Pn, eq. (3.31).
    pub fn friction(&self) -> f64 {
        self.mu * self.stretch
    }

    /// Normal and tangential force, s Pn and Pt, from the multipliers Pn and Pt.
    pub fn normal_and_tangential(&self, [pn, pt]: [f64; 2]) -> [f64; 2] {
        [self.stretch * pn, pt]
    }

    /// The same constraint with its force rows as derivative rows, which makes Q symmetric.
    pub fn with_force_rows(self) -> Self {
        Constraint {
            other_derivative_rows: None,
            ..self
        }
    }

    /// The same constraint with another gap and slip, and with the length `scale` to which gap and slip are relative.
    pub fn with_gap_and_slip(&self, [gap, slip]: [f64; 2], scale: f64) -> Self {
        Constraint {
            gap,
            slip,
            scale,
            ..self.clone()
        }
    }

    /// Derivative rows Gn and Gt.
    pub fn derivative_rows(&self) -> &Rows {
        let other = self.other_derivative_rows.as_ref();
        other.unwrap_or(&self.force_rows)
    }

    /// Gn v: change of the gap by a vector over all dofs.
    pub fn gap_change(&self, v: &[f64]) -> f64 {
        self.product(&self.derivative_rows().normal, |dof| v[dof])
    }

    /// Gt v: change of the slip by a vector over all dofs.
    pub fn slip_change(&self, v: &[f64]) -> f64 {
        self.product(&self.derivative_rows().tangential, |dof| v[dof])
    }

    /// A gap or slip of the pair (length), or 0 if the value is negligible against the segment length, eq. (4.21). The
    /// remains of a motion that has died away must not become the scale of a complementarity problem, whose forces would
    /// underflow.
    pub fn resolved(&self, length: f64) -> f64 {
        match length.abs() < NOTHING * self.scale {
            true => 0.0,
            false => length,
        }
    }

    /// Round-off of the slip (length): the errors of solves, and round-off of the slave node's position at the start.
    pub fn slip_round_off(&self, (x, u0): (&[[f64; 2]], &[f64])) -> f64 {
        let place = position(x, u0, self.source.pair.slave);
        SOLVED_GAP * self.scale + 4.0 * position_round_off(place)
    }

    /// Bn d: the work of a unit normal force on a displacement over all dofs (length).
    pub fn normal_motion(&self, d: &[f64]) -> f64 {
        self.product(&self.force_rows.normal, |dof| d[dof])
    }

    /// Bt d: the work of a unit tangential force on a displacement over all dofs (length).
    pub fn tangential_motion(&self, d: &[f64]) -> f64 {
        self.product(&self.force_rows.tangential, |dof| d[dof])
    }

    /// Time at which the gap closes in the motion t V + t²/2 A from the start, eq. (6.3), up to a time `end`; V and A
    /// are given over all dofs:
    ///
    /// ```text
    /// g0 + t Bn V + t²/2 Bn A = 0
    /// ```
    ///
    /// `None` if the gap does not close.
    pub fn closing_time(&self, [v, a]: [&[f64]; 2], end: f64) -> Option<f64> {
        let (gap, rate) = (self.start_gap.max(0.0), self.normal_motion(v));
        let discriminant = rate * rate - 2.0 * gap * self.normal_motion(a);
        let time = match gap == 0.0 {
            true => 0.0,
            false => 2.0 * gap / (discriminant.sqrt() - rate),
        };
        (0.0..=end).contains(&time).then_some(time)
    }

    /// Adds the contact force Bn^T Pn + Bt^T Pt to a vector over all dofs.
    pub fn add_force(&self, [pn, pt]: [f64; 2], force: &mut [f64]) {
        let Rows { normal, tangential } = &self.force_rows;
        for (&dof, (n, t)) in self.dofs.iter().zip(normal.iter().zip(tangential)) {
            force[dof] += n * pn + t * pt;
        }
    }

    /// Nodes of the constraint, slave nodes first.
    pub fn nodes(&self) -> impl Iterator<Item = usize> {
        self.dofs.chunks_exact(2).map(|dofs| dofs[0] / 2)
    }

    /// Contact force Bn^T Pn + Bt^T Pt at every node of the constraint.
    pub fn nodal_forces(&self, [pn, pt]: [f64; 2]) -> impl Iterator<Item = (usize, [f64; 2])> {
        let Rows { normal, tangential } = &self.force_rows;
        let force = move |k: usize| normal[k] * pn + tangential[k] * pt;
        let numbered = self.nodes().enumerate();
        numbered.map(move |(k, node)| (node, [force(2 * k), force(2 * k + 1)]))
    }

    /// Whether the slave node of the constraint is a corner of the contact's master.
    pub fn is_of_master(&self) -> bool {
        self.source.pair.is_of_master
    }

    /// Contact force Bn^T Pn + Bt^T Pt at every node of the contact's slave surface.
    pub fn forces_on_slave_surface(
        &self,
        force: [f64; 2],
    ) -> impl Iterator<Item = (usize, [f64; 2])> {
        let slaves = self.slave_dofs / 2;
        let is_of_master = self.is_of_master();
        let numbered = self.nodal_forces(force).enumerate();
        let own = numbered.filter(move |(k, _)| (*k < slaves) != is_of_master);
        own.map(|(_, force)| force)
    }

    /// The parts of the constraint's normal force on the nodes of the contact's slave surface, and on the nodes of its
    /// master.
    pub fn surface_parts(&self) -> [SurfaceParts; 2] {
        let all: SmallVec<[(usize, [f64; 2]); 8]> = self.nodal_forces([1.0, 0.0]).collect();
        let (slaves, others) = all.split_at(self.slave_dofs / 2);
        match self.is_of_master() {
            true => [others, slaves].map(SurfaceParts::of),
            false => [slaves, others].map(SurfaceParts::of),
        }
    }

    /// Contact force Bn^T Pn + Bt^T Pt at every slave node of the constraint.
    pub fn slave_forces(&self, force: [f64; 2]) -> impl Iterator<Item = (usize, [f64; 2])> {
        self.nodal_forces(force).take(self.slave_dofs / 2)
    }

    fn product(&self, row: &[f64], v: impl Fn(usize) -> f64) -> f64 {
        row.iter().zip(&self.dofs).map(|(b, &dof)| b * v(dof)).sum()
    }
}

/// The nodes of one of the two surfaces of a constraint, with their parts of its normal force:
///
/// ```text
/// f_k = Bn_k.N/(N.N),  N = sum_k Bn_k,  sum_k f_k = 1    eq. (9.15)
/// ```
///
/// With surface to surface the parts are the weights of the mean gap; a node without normal force, such as a node that
/// only turns a disc, has no part.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct SurfaceParts {
    /// The force N on the surface under a contact normal force Pn of 1.
    pub normal: [f64; 2],
    /// Nodes of the surface with their parts f of the normal force.
    pub parts: SmallVec<[(usize, f64); 4]>,
}

impl SurfaceParts {
    /// Parts of the nodes, from the normal row Bn at each of them.
    fn of(at_nodes: &[(usize, [f64; 2])]) -> Self {
        let sum = |[x, y]: [f64; 2], (_, n): &(usize, [f64; 2])| [x + n[0], y + n[1]];
        let normal = at_nodes.iter().fold([0.0; 2], sum);
        let square = dot(normal, normal);
        let part = |&(node, n): &(usize, [f64; 2])| (node, dot(n, normal) / square);
        SurfaceParts {
            normal,
            parts: at_nodes.iter().map(part).collect(),
        }
    }
}

/// Form of the rows Bn and Bt of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowForm {
    /// Normal and tangent of the end configuration (SS22).
    End,
    /// Discrete gradients of gap and projection between start and end: exactly Bn d = g1 - g0 and
    /// Bt d = L (xi1 - xi0), and linear and angular momentum are kept (energy-momentum form).
    DiscreteGradient,
}

/// Start of the increment and iterate between which constraints are linearised.
#[derive(Debug, Clone, Copy)]
pub struct Configurations<'a> {
    /// Form of the rows.
    pub form: RowForm,
    /// Reference coordinates of the nodes (length).
    pub x: &'a [[f64; 2]],
    /// Displacement U0 of the start, over all dofs (length).
    pub u0: &'a [f64],
    /// Displacement U of the iterate, over all dofs (length).
    pub u: &'a [f64],
}

impl Configurations<'_> {
    /// Positions of nodes at the start.
    pub(super) fn start<const N: usize>(&self, nodes: [usize; N]) -> [[f64; 2]; N] {
        nodes.map(|node| position(self.x, self.u0, node))
    }

    /// Positions of nodes in the iterate.
    pub(super) fn iterate<const N: usize>(&self, nodes: [usize; N]) -> [[f64; 2]; N] {
        nodes.map(|node| position(self.x, self.u, node))
    }
}
