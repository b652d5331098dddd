//! J2 plasticity at finite strain: multiplicative, with Hencky's elasticity, isotropic hardening from a table and
//! linear kinematic hardening. The flow of an increment is computed within a potential of the strain, whose discrete
//! gradient is the stress (Simo 1992; Ortiz & Stainier 1999). See docs/theory/materials.md, Plasticity.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use nalgebra::Matrix2;

use super::hyperelastic::Hyperelastic;
use super::plane_stress::{PlaneStress, completed, condensed_stress, condensed_tangent};
use super::spectrum::{Spectrum, between, log_change, root};
use super::strains::{StrainChange, Strains};
use super::symmetric::{IDENTITY, Symmetric, Tangent, contract};
use super::{
    Across, BentTangent, Flow, LawCard, MetalLaw, Plane, SaintVenantKirchhoff, SmallStrainModuli,
    yield_curve,
};

/// A metal, `*PLASTIC`.
///
/// ```text
/// state    G = C_p^-1, the back strain A, the accumulated plastic strain a
/// trial    X = V C V,  V = G^(1/2),  E_h = ln(X)/2
/// energy   psi = K/2 (tr E_e)² + mu dev E_e : dev E_e + H_k/3 A:A,   E_e = E_h - dE_p
/// yield    q = sqrt(3/2) |2 mu dev E_e - 2/3 H_k A| <= sigma_y(a)
/// flow     dE_p = da 3/2 xi/q,  xi = 2 mu dev E_h - 2/3 H_k A
/// ```
///
/// The yield stress sigma_y limits the Kirchhoff stress.
#[derive(Debug, Clone, PartialEq)]
pub struct Plastic {
    /// Moduli of the elastic strains.
    pub moduli: SmallStrainModuli,
    /// Accumulated plastic strain and yield stress (force/length^2), with strains increasing from 0; beyond the last
    /// strain the yield stress is constant.
    pub hardening: Arc<[[f64; 2]]>,
    /// Modulus H_k of the kinematic hardening (force/length^2).
    pub kinematic: f64,
}

/// Number of components of the tensor G - I and of the back strain.
const COMPONENTS: usize = 4;

impl Plastic {
    /// Moduli at small strains.
    pub fn small_strain(&self) -> SmallStrainModuli {
        self.moduli
    }

    /// `*ELASTIC` and `*PLASTIC`; linear kinematic hardening has a row at the plastic strains 0 and 1.
    pub fn cards(&self) -> Vec<LawCard> {
        let SmallStrainModuli { young, poisson } = self.moduli;
        let (hardening, table) = match self.has_back_strain() {
            true => {
                let first = self.hardening[0][1];
                let second = [1.0, first + self.kinematic];
                ("HARDENING=KINEMATIC", vec![[0.0, first], second])
            }
            false => ("HARDENING=ISOTROPIC", self.hardening.to_vec()),
        };
        let rows = table.iter().map(|[strain, stress]| vec![*stress, *strain]);
        let plastic = LawCard {
            keyword: "PLASTIC",
            parameter: Some(hardening),
            rows: rows.collect(),
        };
        let mut cards = SaintVenantKirchhoff { young, poisson }.cards();
        cards.push(plastic);
        cards
    }

    /// The law in the plane.
    pub fn in_plane(&self, plane: Plane) -> PlanePlastic {
        PlanePlastic {
            law: self.clone(),
            plane,
        }
    }

    fn shear(&self) -> f64 {
        self.moduli.shear()
    }

    fn has_back_strain(&self) -> bool {
        self.kinematic > 0.0
    }

    /// Number of internal variables: the tensor G - I, the back strain A and the accumulated plastic strain a.
    fn variables(&self) -> usize {
        COMPONENTS * (1 + usize::from(self.has_back_strain())) + 1
    }

    fn state(&self, z: &[f64]) -> PlasticState {
        let tensor = |from: usize| Symmetric::new(z[from], z[from + 1], z[from + 2], z[from + 3]);
        PlasticState {
            g: tensor(0),
            back: match self.has_back_strain() {
                true => tensor(COMPONENTS),
                false => Symmetric::zeros(),
            },
            slip: z[self.variables() - 1],
        }
    }

    /// Segment of the table with the given index: its start, the yield stress at the start, slope, and end.
    fn segment(&self, index: usize) -> (f64, f64, f64, f64) {
        let [start, stress] = self.hardening[index];
        match self.hardening.get(index + 1) {
            Some([end, next]) => (start, stress, (next - stress) / (end - start), *end),
            None => (start, stress, 0.0, f64::INFINITY),
        }
    }

    fn segment_at(&self, slip: f64) -> usize {
        let behind = self
            .hardening
            .partition_point(|[strain, _]| *strain <= slip);
        behind.saturating_sub(1)
    }

    fn yield_stress(&self, slip: f64) -> f64 {
        let (start, stress, slope, _) = self.segment(self.segment_at(slip));
        stress + slope * (slip - start)
    }

    /// Integral int sigma_y da from the accumulated plastic strain `from`, over the length `by`, which may be negative
    /// (force/length^2).
    fn hardening_work(&self, from: f64, by: f64) -> f64 {
        if by < 0.0 {
            return -self.hardening_work(from + by, -by);
        }
        let (mut at, mut left, mut work) = (from, by, 0.0);
        for index in self.segment_at(from)..self.hardening.len() {
            let (start, stress, slope, end) = self.segment(index);
            let part = left.min(end - at);
            work += part * (stress + slope * (at - start + part / 2.0));
            (at, left) = (at + part, left - part);
            if left <= 0.0 {
                break;
            }
        }
        work
    }

    /// Increment da and the slope of sigma_y, from q - (3 mu + H_k) da - n² sigma_y(a + da) = 0, an equation that is
    /// linear on each segment; `square` is n².
    fn slip(&self, q: f64, from: f64, square: f64) -> (f64, f64) {
        let stiffness = 3.0 * self.shear() + self.kinematic;
        let mut found = (0.0, 0.0);
        for index in self.segment_at(from)..self.hardening.len() {
            let (start, stress, slope, end) = self.segment(index);
            let at_start = stress + slope * (from - start);
            let slip = (q - square * at_start) / (stiffness + square * slope);
            found = (slip, slope);
            if from + slip <= end {
                break;
            }
        }
        found
    }

    /// Trial state of the metal at a strain, eq. (2.37).
    fn trial(&self, e: &Symmetric, state: &PlasticState) -> Trial {
        let v = IDENTITY + root(&state.g);
        let y = state.g + between(&v, e) * 2.0;
        let spectrum = Spectrum::new(&y);
        let strain = spectrum.logarithmic_strain();
        Trial {
            v,
            y,
            spectrum,
            strain,
        }
    }

    /// Stress xi = 2 mu dev E_h - 2/3 H_k A, relative to the back stress (force/length^2).
    fn relative_stress(&self, strain: &Symmetric, state: &PlasticState) -> Symmetric {
        deviator(strain) * (2.0 * self.shear()) - state.back * (2.0 / 3.0 * self.kinematic)
    }

    /// Flow from a trial strain with hourglass modes of a square m. The flow minimises the potentials of eq. (2.38) and
    /// eq. (2.48): the trial stresses (Q, H) return to the nearest point sigma_y (w, z) of the yield curve.
    fn flow(&self, strain: &Symmetric, state: &PlasticState, modes: f64) -> PlasticFlow {
        let xi = self.relative_stress(strain, state);
        let size = contract(&xi, &xi).sqrt();
        let trial = [1.5_f64.sqrt() * size, modes.sqrt()];
        let elastic = PlasticFlow {
            xi,
            q: trial[0],
            ..PlasticFlow::default()
        };
        if yield_curve::contains(trial, self.yield_stress(state.slip)) {
            return elastic;
        }
        let angle = match trial[1] > 0.0 {
            true => self.yield_angle(trial, state.slip),
            false => 0.0,
        };
        let at = Return::new(self, trial, state.slip, angle);
        let (shear, stiffness) = (3.0 * self.shear(), 3.0 * self.shear() + self.kinematic);
        let [by_strain, mixed, by_modes] = at.derivatives(stiffness);
        // if the strain or the modes are negligible, the ratio is replaced by its derivative
        let [has_strain, has_modes] = trial.map(|size| size > SMALL_SHARE * (trial[0] + trial[1]));
        let own = match (has_strain, angle > 0.0) {
            (false, _) => 0.0,
            (true, false) => at.slip,
            (true, true) => at.beyond()[0] / stiffness,
        };
        let left = [
            match has_strain {
                true => 1.0 - stiffness * own / trial[0],
                false => by_strain,
            },
            match has_modes {
                true => at.stress * at.point[1] / trial[1],
                false => by_modes,
            },
        ];
        let factor = shear / stiffness;
        let part = match has_strain {
            true => shear * own / trial[0],
            false => factor * (1.0 - left[0]),
        };
        let over = |value: f64, by: f64, is_there: bool| match is_there {
            true => factor * value / by,
            false => 0.0,
        };
        let flown = factor * (1.0 - left[1]);
        PlasticFlow {
            slip: at.point[0] * own + at.point[1] * flown * trial[1] / shear,
            own,
            strain: match has_strain {
                true => xi / size * (1.5_f64.sqrt() * own),
                false => xi * (part / (2.0 * self.shear())),
            },
            parts: [part, flown],
            slopes: [
                over(left[0] - by_strain, trial[0] * trial[0], has_strain),
                over(-mixed, trial[0] * trial[1], has_strain && has_modes),
                over(left[1] - by_modes, trial[1] * trial[1], has_modes),
            ],
            ..elastic
        }
    }

    /// Angle of the point on the yield curve to which a trial state returns, found by Newton's method between bounds.
    fn yield_angle(&self, trial: [f64; 2], from: f64) -> f64 {
        let (mut low, mut high) = (0.0, FRAC_PI_2);
        let stiffness = 3.0 * self.shear() + self.kinematic;
        let mut angle = trial[1].atan2(trial[0]);
        for _ in 0..MOST_STEPS {
            let at = Return::new(self, trial, from, angle);
            let [rest, slope] = at.rest(stiffness);
            match rest > 0.0 {
                true => low = angle,
                false => high = angle,
            }
            let newton = angle - rest / slope;
            let next = match newton > low && newton < high {
                true => newton,
                false => (low + high) / 2.0,
            };
            let is_found = (next - angle).abs() <= ROUND_OFF * angle;
            angle = next;
            if is_found {
                break;
            }
        }
        angle
    }

    /// Changes of the plastic strain increment dE_p and of da between two flows from one state, for a change of the
    /// trial strain. The changes keep their digits if both trial strains flow: with p = r Q/(3 mu),
    ///
    /// ```text
    /// dQ = 3/2 (xi0 + xi1):dxi/(Q0 + Q1),   dr = 3 mu (dp (Q0 + Q1)/2 - (p0 + p1)/2 dQ)/(Q0 Q1)
    /// d(dE_p) = ((r0 + r1) dxi + dr (xi0 + xi1))/(4 mu)
    /// ```
    fn flow_change(&self, change: &Symmetric, [start, end]: [&PlasticFlow; 2]) -> (Symmetric, f64) {
        let (slip, own) = (end.slip - start.slip, end.own - start.own);
        if start.own == 0.0 || end.own == 0.0 {
            return (end.strain - start.strain, slip);
        }
        let (xi, sum) = (deviator(change) * (2.0 * self.shear()), start.xi + end.xi);
        let both = start.q + end.q;
        let size = 1.5 * contract(&sum, &xi) / both;
        let part = own * both / 2.0 - (start.own + end.own) / 2.0 * size;
        let part = 3.0 * self.shear() * part / (start.q * end.q);
        let flown = xi * (start.parts[0] + end.parts[0]) + sum * part;
        (flown / (4.0 * self.shear()), slip)
    }

    /// Change of the stress T after the flow for a change of the trial strain (force/length^2):
    ///
    /// ```text
    /// dT = K tr dE I + 2 mu dev dE - r dxi - dr/dQ/Q (3/2 xi:dxi) xi,   dxi = 2 mu dev dE
    /// ```
    fn stress_change(&self, change: &Symmetric, flow: &PlasticFlow) -> Symmetric {
        let elastic = self.moduli.stress(change);
        if flow.slip == 0.0 {
            return elastic;
        }
        let xi = deviator(change) * (2.0 * self.shear());
        let size = 1.5 * contract(&flow.xi, &xi);
        elastic - xi * flow.parts[0] - flow.xi * (flow.slopes[0] * size)
    }

    /// Stored energy psi(E, z) (force/length^2).
    fn stored(&self, e: &Symmetric, state: &PlasticState) -> f64 {
        let strain = self.trial(e, state).strain;
        contract(&self.moduli.stress(&strain), &strain) / 2.0
            + self.kinematic / 3.0 * contract(&state.back, &state.back)
    }

    /// Difference psi(E) - Phi(E), which is zero unless the strain would flow at once with modes of a square m
    /// (force/length^2):
    ///
    /// ```text
    /// (T_h + T)/2 : dE_p - H_k/3 (2 A + dE_p):dE_p + (r_h - (1 + k) r_h²/2) m/(3 mu) - int sigma_y da,
    /// T_h = T without the flow,   k = H_k/(3 mu)
    /// ```
    fn released(&self, e: &Symmetric, state: &PlasticState, modes: f64) -> f64 {
        let strain = self.trial(e, state).strain;
        let flow = self.flow(&strain, state, modes);
        let stress = self.moduli.stress(&(strain * 2.0 - flow.strain)) / 2.0;
        let back = (state.back * 2.0 + flow.strain) * (self.kinematic / 3.0);
        let shear = 3.0 * self.shear();
        let part = flow.parts[1];
        let kept = 1.0 - (1.0 + self.kinematic / shear) * part / 2.0;
        contract(&(stress - back), &flow.strain) + part * kept * modes / shear
            - self.hardening_work(state.slip, flow.slip)
    }

    /// The state after the flow at a strain, eq. (2.41), in the frame V of the new tensor G; the trial strain in this
    /// frame is E_e rotated:
    ///
    /// ```text
    /// K = V X^(-1/2) exp(E_e),  G = K K^T,  R = G^(-1/2) K,  A <- R (A + dE_p) R^T
    /// ```
    fn updated(&self, e: &Symmetric, state: &PlasticState, modes: f64) -> PlasticState {
        let trial = self.trial(e, state);
        let flow = self.flow(&trial.strain, state, modes);
        if flow.slip == 0.0 {
            return *state;
        }
        let elastic = Spectrum::new(&(trial.strain - flow.strain)).map(f64::exp);
        let back = trial.spectrum.map(|y| 1.0 / (1.0 + y).sqrt());
        let k = trial.v.in_plane() * back.in_plane() * elastic.in_plane();
        let around = trial.v.z * back.z * elastic.z;
        let g = k * k.transpose();
        // the root of a matrix in the plane: (G + d I)/sqrt(tr G + 2 d), d = sqrt(det G)
        let d = g.determinant().sqrt();
        let v = (g + Matrix2::identity() * d) / (g.trace() + 2.0 * d).sqrt();
        let moved = state.back + flow.strain;
        let turned = match v.try_inverse() {
            Some(inverse) => {
                let r = inverse * k;
                r * moved.in_plane() * r.transpose()
            }
            None => moved.in_plane(),
        };
        let whole =
            |a: &Matrix2<f64>, z: f64| Symmetric::new(a.m11, a.m22, z, (a.m12 + a.m21) / 2.0);
        PlasticState {
            g: whole(&(g - Matrix2::identity()), around * around - 1.0),
            back: whole(&turned, moved.z),
            slip: state.slip + flow.slip,
        }
    }
}

/// The internal variables of a point.
#[derive(Debug, Clone, Copy, Default)]
struct PlasticState {
    /// Tensor G - I.
    g: Symmetric,
    /// Back strain A.
    back: Symmetric,
    /// Accumulated plastic strain a.
    slip: f64,
}

/// Trial strain of a point.
struct Trial {
    v: Symmetric,
    /// Tensor Y = X - I, with which small strains keep their digits.
    y: Symmetric,
    spectrum: Spectrum,
    /// E_h.
    strain: Symmetric,
}

/// Flow of an increment.
#[derive(Default)]
struct PlasticFlow {
    /// Increment da = w p + z p_h of the accumulated plastic strain, eq. (2.49), with p_h = r_h H/(3 mu). Computed as
    /// the sum of the parts that flow, da has a round-off that does no work.
    slip: f64,
    /// Value p = r Q/(3 mu), which is da for an element without modes; zero without a strain.
    own: f64,
    /// Increment of the plastic strain, dE_p = r xi/(2 mu).
    strain: Symmetric,
    /// Stress xi of the trial strain (force/length^2).
    xi: Symmetric,
    /// Equivalent stress Q of the trial strain (force/length^2).
    q: f64,
    /// Parts r of the trial strain, and r_h of the amplitudes of the modes, that flow.
    parts: [f64; 2],
    /// Derivatives dr/dQ/Q, dr/dH/H = dr_h/dQ/Q and dr_h/dH/H of the parts that flow (length^4/force^2).
    slopes: [f64; 3],
}

/// Share of Q or H in their sum below which Q or H counts as zero; the error of a ratio is the square of the share.
const SMALL_SHARE: f64 = 1e-8;

/// A point of the yield curve and the flow that leads to it, eq. (2.49), with its place c = (w, z), derivatives with
/// respect to the angle, and the trial stresses (Q, H):
///
/// ```text
/// (Q, H).c - (3 mu + H_k) da - c.c sigma_y(a + da) = 0,   nearest: c'.((Q, H) - sigma_y c) = 0
/// ```
///
/// The first equation is the work of the flow, sigma_y da.
struct Return {
    trial: [f64; 2],
    /// Place c = (w, z) on the yield curve and its derivatives c' and c'' with respect to the
    /// angle.
    point: [f64; 2],
    first: [f64; 2],
    second: [f64; 2],
    /// Increment da, and at its end the yield stress sigma_y (force/length^2) and the slope of sigma_y.
    slip: f64,
    stress: f64,
    slope: f64,
}

impl Return {
    fn new(law: &Plastic, trial: [f64; 2], from: f64, angle: f64) -> Self {
        let [point, first, second] = yield_curve::at(angle);
        let (slip, slope) = law.slip(dot(trial, point), from, dot(point, point));
        Return {
            trial,
            point,
            first,
            second,
            slip,
            stress: law.yield_stress(from + slip),
            slope,
        }
    }

    /// The excess (Q, H) - sigma_y c of the trial stresses over the yield curve.
    fn beyond(&self) -> [f64; 2] {
        [0, 1].map(|k| self.trial[k] - self.stress * self.point[k])
    }

    /// Derivatives with respect to the angle: of the second equation at constant sigma_y, and of
    /// c.c/2.
    fn curvature(&self) -> [f64; 2] {
        let turn = dot(self.second, self.beyond()) - self.stress * dot(self.first, self.first);
        [turn, dot(self.point, self.first)]
    }

    /// Left side of the second equation, and its derivative with respect to the angle under the
    /// first equation.
    fn rest(&self, stiffness: f64) -> [f64; 2] {
        let [turn, half] = self.curvature();
        let hardened = stiffness + self.slope * dot(self.point, self.point);
        let along = dot(self.first, self.trial) - 2.0 * self.stress * half;
        [
            dot(self.first, self.beyond()),
            turn - self.slope * half * along / hardened,
        ]
    }

    /// Derivatives of q = sigma_y w with respect to Q and H, and of h = sigma_y z with respect to
    /// H.
    fn derivatives(&self, stiffness: f64) -> [f64; 3] {
        let [turn, half] = self.curvature();
        let hardened = stiffness + self.slope * dot(self.point, self.point);
        let determinant = turn + self.slope * self.stress * half * half / hardened;
        // derivatives of the angle and of da with respect to Q and H
        let changes = [0, 1].map(|k| {
            let angle =
                (-self.first[k] + self.slope * half * self.point[k] / hardened) / determinant;
            (
                angle,
                (self.point[k] - self.stress * half * angle) / hardened,
            )
        });
        let of = |i: usize, (angle, slip): (f64, f64)| {
            self.stress * self.first[i] * angle + self.slope * self.point[i] * slip
        };
        [of(0, changes[0]), of(0, changes[1]), of(1, changes[1])]
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn deviator(a: &Symmetric) -> Symmetric {
    *a - IDENTITY * ((a.x + a.y + a.z) / 3.0)
}

/// The potential Phi(E; z0) of an increment: stored energy plus work of hardening after the flow. With hourglass modes
/// eq. (2.48) gives the potential, without the elastic energy of the modes.
#[derive(Clone, Copy)]
struct Potential<'a> {
    law: &'a Plastic,
    state: PlasticState,
    /// Square m: the part of the modes in q² (force^2/length^4).
    modes: f64,
}

impl<'a> Potential<'a> {
    fn new(law: &'a Plastic, state: PlasticState) -> Self {
        Potential {
            law,
            state,
            modes: 0.0,
        }
    }

    fn flow(&self, trial: &Trial) -> PlasticFlow {
        self.law.flow(&trial.strain, &self.state, self.modes)
    }

    /// Change of the potential between two strains with their squares m of the modes; `by` is the difference of m. Here
    /// dp is the change of the plastic strain increment dE_p, and k = H_k/(3 mu):
    ///
    /// ```text
    /// (T0 + T1)/2 : (dE_h - dp) + H_k/3 (2 A + dE_p0 + dE_p1):dp + int sigma_y da from a + da0 to a + da1
    ///     - d((r_h - (1 + k) r_h²/2) m)/(3 mu)
    /// ```
    fn change(&self, strains: &StrainChange, at_start: f64, by: f64) -> f64 {
        let Potential { law, state, .. } = self;
        let (start, end) = (
            law.trial(&strains.start, state),
            law.trial(&strains.end, state),
        );
        let flow0 = law.flow(&start.strain, state, at_start);
        let flow1 = self.flow(&end);
        let dy = between(&start.v, &strains.change()) * 2.0;
        let change = log_change(&start.y, &end.y, &dy);
        let (flow, slip) = law.flow_change(&change, [&flow0, &flow1]);
        let stress = law.moduli.stress(&(start.strain - flow0.strain))
            + law.moduli.stress(&(end.strain - flow1.strain));
        let back = state.back * 2.0 + flow0.strain + flow1.strain;
        let shear = 3.0 * law.shear();
        let kept = 1.0 + law.kinematic / shear;
        let [part0, part1] = [&flow0, &flow1].map(|flow| flow.parts[1]);
        let of = |part: f64| part * (1.0 - kept * part / 2.0);
        let of_modes = (of(part0) + of(part1)) / 2.0 * by
            + (part1 - part0) * (1.0 - kept * (part0 + part1) / 2.0) * (at_start + self.modes)
                / 2.0;
        contract(&stress, &(change - flow)) / 2.0
            + law.kinematic / 3.0 * contract(&back, &flow)
            + law.hardening_work(state.slip + flow0.slip, slip)
            - of_modes / shear
    }

    /// First and second derivative of the potential with respect to m, and the derivative of S, at
    /// a strain with all components.
    ///
    /// ```text
    /// dW/dm = -r_h/(6 mu),   d²W/dm² = -dr_h/dH/H/(12 mu),   dT/dm = -dr/dH/H xi/2
    /// ```
    fn by_modes(&self, e: &Symmetric) -> ([f64; 2], Symmetric) {
        let trial = self.law.trial(e, &self.state);
        let flow = self.flow(&trial);
        if flow.slip == 0.0 {
            return ([0.0; 2], Symmetric::zeros());
        }
        let shear = 6.0 * self.law.shear();
        let stress = flow.xi * (-flow.slopes[1] / 2.0);
        let s = between(&trial.v, &trial.spectrum.log_derivative(&stress));
        ([-flow.parts[1] / shear, -flow.slopes[2] / (2.0 * shear)], s)
    }
}

impl Hyperelastic for Potential<'_> {
    fn energy(&self, e: &Symmetric) -> f64 {
        let zero = Symmetric::zeros();
        let change = StrainChange::between(&zero, e);
        self.law.stored(&zero, &self.state) + self.energy_change(&change)
    }

    /// Change of the potential, Phi(E1) - Phi(E0), eq. (2.40).
    fn energy_change(&self, change: &StrainChange) -> f64 {
        self.change(change, self.modes, 0.0)
    }

    /// Stress S = V (D ln(X) : T) V, eq. (2.39) (force/length^2).
    fn stress(&self, e: &Symmetric) -> Symmetric {
        let trial = self.law.trial(e, &self.state);
        let flow = self.flow(&trial);
        let stress = self.law.moduli.stress(&(trial.strain - flow.strain));
        between(&trial.v, &trial.spectrum.log_derivative(&stress))
    }

    /// Tangent V (D ln : (dT/dE_h) : D ln + 2 D² ln : T) V, column by column (force/length^2).
    fn tangent(&self, e: &Symmetric) -> Tangent {
        let trial = self.law.trial(e, &self.state);
        let flow = self.flow(&trial);
        let stress = self.law.moduli.stress(&(trial.strain - flow.strain));
        Tangent::of_columns(|unit| {
            let direction = between(&trial.v, unit);
            // dE_h = D ln : dX/2, dX = 2 V dE V
            let strain = trial.spectrum.log_derivative(&direction);
            let change = self.law.stress_change(&strain, &flow);
            let column = trial.spectrum.log_derivative(&change)
                + trial.spectrum.second_derivative(&stress, &direction) * 2.0;
            between(&trial.v, &column)
        })
    }
}

/// A metal in plane strain, in plane stress or in a body of revolution.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanePlastic {
    law: Plastic,
    plane: Plane,
}

/// Largest number of steps of Newton's method for the angle of a return.
const MOST_STEPS: usize = 60;
/// Relative change of the angle up to which the change is round-off.
const ROUND_OFF: f64 = 2.0 * f64::EPSILON;

impl PlanePlastic {
    /// The potential with hourglass modes of a square m.
    fn potential(&self, z0: &[f64], modes: f64) -> Potential<'_> {
        Potential {
            modes,
            ..Potential::new(&self.law, self.law.state(z0))
        }
    }

    /// Evaluates a function of a potential in the plane of the law.
    fn in_plane<V>(&self, potential: Potential, of: impl Fn(&dyn Hyperelastic) -> V) -> V {
        match self.plane {
            Plane::Stress => of(&PlaneStress {
                law: potential,
                poisson: self.law.moduli.poisson,
            }),
            Plane::Strain | Plane::Revolution => of(&potential),
        }
    }

    /// A strain with its component across the plane.
    fn complete(&self, potential: Potential, e: &Symmetric) -> Symmetric {
        let z = self.in_plane(potential, |law| law.strain_across(e));
        Symmetric { z, ..*e }
    }

    /// Strains with their components across the plane, for modes of the given squares m.
    fn complete_change(&self, change: &StrainChange, z0: &[f64], modes: [f64; 2]) -> StrainChange {
        let ends = [(modes[0], change.start), (modes[1], change.end)];
        let across = ends.map(|(modes, e)| self.complete(self.potential(z0, modes), &e).z);
        completed(change, across)
    }

    /// Energy D dissipated in an increment that ends at a strain (in the energy-momentum form: that leads from one
    /// strain to another), with modes of the given squares m.
    fn dissipated(&self, strains: &Strains, z0: &[f64], modes: [f64; 2]) -> f64 {
        let state = self.law.state(z0);
        let released = match strains {
            Strains::At(_) => 0.0,
            Strains::Between(change) => {
                let start = self.complete(self.potential(z0, modes[0]), &change.start);
                self.law.released(&start, &state, modes[0])
            }
        };
        let end = self.complete(self.potential(z0, modes[1]), &strains.end());
        let end = self.law.trial(&end, &state).strain;
        let slip = self.law.flow(&end, &state, modes[1]).slip;
        released + self.law.hardening_work(state.slip, slip)
    }

    /// Writes the state at the end of the strains, with modes of a square m, and returns the strain at this end with
    /// all components.
    fn write_updated(
        &self,
        strains: &Strains,
        z0: &[f64],
        modes: f64,
        z1: &mut [f64],
    ) -> Symmetric {
        let potential = self.potential(z0, modes);
        let end = self.complete(potential, &strains.end());
        let state = self.law.updated(&end, &potential.state, modes);
        z1[..COMPONENTS].copy_from_slice(&state.g.components());
        if self.law.has_back_strain() {
            z1[COMPONENTS..2 * COMPONENTS].copy_from_slice(&state.back.components());
        }
        if let Some(slip) = z1.last_mut() {
            *slip = state.slip;
        }
        end
    }
}

impl Flow for PlanePlastic {
    fn variables(&self) -> usize {
        self.law.variables()
    }

    fn stress(&self, strains: &Strains, z0: &[f64]) -> Symmetric {
        self.in_plane(self.potential(z0, 0.0), |law| law.stress_of(strains))
    }

    fn update(&self, strains: &Strains, z0: &[f64], z1: &mut [f64]) {
        self.write_updated(strains, z0, 0.0, z1);
    }

    fn tangent(&self, strains: &Strains, z0: &[f64]) -> Tangent {
        self.in_plane(self.potential(z0, 0.0), |law| law.tangent_of(strains))
    }

    fn stored_energy(&self, e: &Symmetric, z: &[f64]) -> f64 {
        let potential = self.potential(z, 0.0);
        self.law
            .stored(&self.complete(potential, e), &potential.state)
    }

    fn dissipation(&self, strains: &Strains, z0: &[f64]) -> f64 {
        self.dissipated(strains, z0, [0.0; 2])
    }

    fn across(&self, e: &Symmetric, z: &[f64]) -> Across {
        self.in_plane(self.potential(z, 0.0), |law| law.across(e))
    }

    fn plastic_strain(&self, z: &[f64]) -> f64 {
        self.law.state(z).slip
    }

    fn as_metal(&self) -> Option<&dyn MetalLaw> {
        Some(self)
    }
}

/// In plane stress S_33 = 0 determines the strain across the plane, which therefore depends on m. With S_m = dS/dm at
/// constant strain across the plane, the strain across the plane adds -S_m33²/C_33 to d²W/dm² and -C_i3 S_m33/C_33 to
/// dS/dm.
impl MetalLaw for PlanePlastic {
    fn moduli(&self) -> [f64; 2] {
        [3.0 * self.law.shear(), self.law.kinematic]
    }

    fn update(&self, strains: &Strains, z0: &[f64], modes: [f64; 2], z1: &mut [f64]) -> [f64; 2] {
        let end = self.write_updated(strains, z0, modes[1], z1);
        let potential = self.potential(z0, modes[1]);
        let flow = potential.flow(&self.law.trial(&end, &potential.state));
        [self.dissipated(strains, z0, modes), flow.parts[1]]
    }

    fn change(&self, z0: &[f64], strains: &StrainChange, modes: [f64; 2], by: f64) -> f64 {
        let strains = self.complete_change(strains, z0, modes);
        self.potential(z0, modes[1]).change(&strains, modes[0], by)
    }

    fn bent_stress(&self, z0: &[f64], e: &Symmetric, modes: f64) -> (Symmetric, f64) {
        let potential = self.potential(z0, modes);
        let e = self.complete(potential, e);
        let s = potential.stress(&e);
        let s = match self.plane {
            Plane::Stress => condensed_stress(&s, &potential.tangent(&e)),
            Plane::Strain | Plane::Revolution => s,
        };
        (s, potential.by_modes(&e).0[0])
    }

    fn bent_tangent(&self, z0: &[f64], e: &Symmetric, modes: f64) -> BentTangent {
        let potential = self.potential(z0, modes);
        let e = self.complete(potential, e);
        let ([slope, mut second], mut stress_by_modes) = potential.by_modes(&e);
        let mut tangent = potential.tangent(&e);
        if self.plane == Plane::Stress {
            second -= stress_by_modes.z * stress_by_modes.z / tangent.0[2][2];
            stress_by_modes = condensed_stress(&stress_by_modes, &tangent);
            tangent = condensed_tangent(&tangent);
        }
        BentTangent {
            tangent,
            by_modes: [slope, second],
            stress_by_modes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector4;

    fn metal(kinematic: f64) -> Plastic {
        Plastic {
            moduli: SmallStrainModuli {
                young: 1000.0,
                poisson: 0.3,
            },
            hardening: [[0.0, 2.0], [0.05, 3.0], [0.2, 4.0]].into(),
            kinematic,
        }
    }

    const DIRECTION: Symmetric = Symmetric {
        x: 0.03,
        y: -0.02,
        z: 0.008,
        w: 0.015,
    };

    fn states(law: &Plastic) -> Vec<PlasticState> {
        // states after flow along two different paths
        let first = law.updated(&(DIRECTION * 3.0), &PlasticState::default(), 0.0);
        let turned = Symmetric::new(-0.02, 0.04, 0.01, -0.05);
        vec![
            PlasticState::default(),
            first,
            law.updated(&turned, &first, 0.0),
        ]
    }

    #[test]
    fn the_change_of_the_potential_is_that_of_its_values_wherever_the_flow_starts() {
        // changes from within the yield surface and from beyond it, as they occur while the strains of an element are
        // found, and back
        let across = Symmetric::new(-0.3, 0.2, 0.1, 0.25);
        for law in &[0.0, 50.0].map(metal) {
            for state in states(law) {
                let potential = Potential::new(law, state);
                let strains = [0.0, 0.03, 0.7, 1.5]
                    .map(|part| DIRECTION * part + across * (0.1 * part * part));
                for (e0, e1) in strains
                    .iter()
                    .flat_map(|a| strains.iter().map(move |b| (a, b)))
                {
                    let found = potential.energy_change(&StrainChange::between(e0, e1));
                    let exact = potential.energy(e1) - potential.energy(e0);
                    let scale = potential.energy(e0).abs() + potential.energy(e1).abs();
                    assert!(
                        (found - exact).abs() <= 1e-13 * scale,
                        "{found:?} {exact:?}"
                    );
                }
                // a small change between two states that flow keeps its digits: it is S(E_m):dE
                for size in [1e-4, 1e-7, 1e-10] {
                    let (e0, e1) = (DIRECTION * 2.0, DIRECTION * 2.0 + across * size);
                    let change = StrainChange::between(&e0, &e1);
                    let middle = potential.stress(&change.mean);
                    let work = contract(&middle, &change.change());
                    let found = potential.energy_change(&change);
                    let bound = (1e-13 + 1e6 * size * size) * work.abs();
                    assert!((found - work).abs() < bound, "{size}: {found} {work}");
                }
            }
        }
    }

    #[test]
    fn stress_and_tangent_are_derivatives_of_the_potential() {
        let h = 1e-6;
        for law in [metal(0.0), metal(30.0)] {
            for state in states(&law) {
                for size in [1e-3, 0.4, 3.5] {
                    let (e, potential) = (DIRECTION * size, Potential::new(&law, state));
                    let (s, c) = (potential.stress(&e), potential.tangent(&e).matrix());
                    let units = [
                        Symmetric::new(1.0, 0.0, 0.0, 0.0),
                        Symmetric::new(0.0, 1.0, 0.0, 0.0),
                        Symmetric::new(0.0, 0.0, 1.0, 0.0),
                        Symmetric::new(0.0, 0.0, 0.0, 0.5),
                    ];
                    for (k, unit) in units.into_iter().enumerate() {
                        let (ahead, behind) = (e + unit * h, e - unit * h);
                        let slope = potential
                            .energy_change(&StrainChange::between(&behind, &ahead))
                            / (2.0 * h);
                        // if the start of a change flows, the change of energy is not that of the
                        // potential
                        if potential.flow(&law.trial(&e, &state)).slip == 0.0 {
                            let work = contract(&s, &unit);
                            assert!((slope - work).abs() < 1e-7 * c.norm(), "{slope} {work}");
                        } else {
                            let zero = Symmetric::zeros();
                            let at = |e: &Symmetric| {
                                potential.energy_change(&StrainChange::between(&zero, e))
                            };
                            let slope = (at(&ahead) - at(&behind)) / (2.0 * h);
                            let work = contract(&s, &unit);
                            assert!((slope - work).abs() < 1e-6 * s.norm(), "{slope} {work}");
                        }
                        let at = |e: &Symmetric| potential.stress(e);
                        let slope = (at(&ahead) - at(&behind)) / (2.0 * h);
                        let column = Vector4::from(slope.components());
                        let error = (column - c.column(k)).norm();
                        assert!(error < 1e-6 * c.norm(), "{size} {k}: {slope:?} {c}");
                    }
                    assert!((c - c.transpose()).norm() < 1e-12 * c.norm());
                }
            }
        }
    }

    #[test]
    fn work_is_stored_and_dissipated() {
        for law in [metal(0.0), metal(30.0)] {
            let metal = law.in_plane(Plane::Revolution);
            for state in states(&law) {
                let mut z0 = vec![0.0; law.variables()];
                z0[..4].copy_from_slice(&state.g.components());
                if law.kinematic > 0.0 {
                    z0[4..8].copy_from_slice(&state.back.components());
                }
                *z0.last_mut().expect("a variable") = state.slip;
                // a strain without stress but for the back stress: C = G^-1
                let c = (IDENTITY + state.g)
                    .in_plane()
                    .try_inverse()
                    .expect("an inverse");
                let e0 = Symmetric::new(
                    c.m11 - 1.0,
                    c.m22 - 1.0,
                    -state.g.z / (1.0 + state.g.z),
                    c.m12,
                ) / 2.0;
                for size in [1e-9, 1e-4, 0.05, 1.0, 3.0] {
                    let e1 = e0 + DIRECTION * size;
                    let (mut z1, strains) = (z0.clone(), Strains::between(&e0, &e1));
                    let s = Flow::stress(&metal, &strains, &z0);
                    Flow::update(&metal, &strains, &z0, &mut z1);
                    let dissipated = Flow::dissipation(&metal, &strains, &z0);
                    let stored = |e: &Symmetric, z: &[f64]| Flow::stored_energy(&metal, e, z);
                    let work = contract(&s, &(e1 - e0));
                    let change = stored(&e1, &z1) - stored(&e0, &z0) + dissipated;
                    assert!(dissipated >= 0.0);
                    let digits = 1e-14 * (1.0 + stored(&e1, &z1));
                    assert!((work - change).abs() < digits, "{size}: {work} {change}");
                    // the end does not flow any more, and its stress is that of the return
                    let after = law.flow(
                        &law.trial(&e1, &law.state(&z1)).strain,
                        &law.state(&z1),
                        0.0,
                    );
                    assert!(after.slip < 1e-14, "{}", after.slip);
                    let back = Flow::stress(&metal, &Strains::At(e1), &z1);
                    let returned = metal.potential(&z0, 0.0).stress(&e1);
                    // with a back stress of another direction the frame turns in the increment
                    if law.kinematic == 0.0 {
                        assert!((back - returned).norm() < 1e-12 * (1.0 + returned.norm()));
                    }
                    // flow keeps the volume
                    let g = IDENTITY + law.state(&z1).g;
                    let det = g.in_plane().determinant() * g.z;
                    assert!((det - 1.0).abs() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn plane_stress_has_no_stress_across() {
        for law in [metal(0.0), metal(30.0)] {
            let metal = law.in_plane(Plane::Stress);
            let z0 = vec![0.0; law.variables()];
            for size in [1e-4, 0.3, 2.0] {
                let e = Symmetric::new(0.03, -0.01, 0.0, 0.01) * size;
                let potential = metal.potential(&z0, 0.0);
                let s = potential.stress(&metal.complete(potential, &e));
                assert!(s.z.abs() < 1e-12 * s.norm());
                let h = 1e-6;
                let c = Flow::tangent(&metal, &Strains::At(e), &z0).0;
                let unit = Symmetric::new(1.0, 0.0, 0.0, 0.0);
                let at = |e: Symmetric| Flow::stress(&metal, &Strains::At(e), &z0);
                let slope = (at(e + unit * h) - at(e - unit * h)) / (2.0 * h);
                assert!((slope.x - c[0][0]).abs() < 1e-6 * c[0][0]);
                assert!((slope.y - c[1][0]).abs() < 1e-6 * c[0][0]);
            }
        }
    }

    #[test]
    fn simple_shear_of_perfect_plasticity_stays_at_the_yield_stress() {
        // tau = sigma_y/sqrt 3 at any shear
        let law = Plastic {
            hardening: [[0.0, 2.0]].into(),
            ..metal(0.0)
        };
        let (metal, mut z) = (law.in_plane(Plane::Strain), vec![0.0; law.variables()]);
        for k in 1..=400 {
            let f = Matrix2::new(1.0, 0.025 * f64::from(k), 0.0, 1.0);
            let e = (f.transpose() * f - Matrix2::identity()) / 2.0;
            let e = Symmetric::of_plane(&e, 0.0);
            let mut z1 = z.clone();
            let s = Flow::stress(&metal, &Strains::At(e), &z).in_plane();
            Flow::update(&metal, &Strains::At(e), &z, &mut z1);
            z = z1;
            if [40, 200, 400].contains(&k) {
                let tau = (f * s * f.transpose()).m12;
                assert!(
                    (tau * 3.0_f64.sqrt() / 2.0 - 1.0).abs() < 2e-3,
                    "{k}: {tau}"
                );
            }
        }
    }

    #[test]
    fn the_table_is_followed() {
        let law = metal(0.0);
        assert_eq!(law.yield_stress(0.1), 3.0 + 0.05 / 0.15);
        assert_eq!(law.yield_stress(0.5), 4.0);
        let work = law.hardening_work(0.02, 0.38);
        let exact = 0.03 * (2.4 + 3.0) / 2.0 + 0.15 * 3.5 + 0.2 * 4.0;
        assert!((work - exact).abs() < 1e-14);
        // q beyond two segments
        let (slip, _) = law.slip(300.0, 0.02, 1.0);
        let rest = 300.0 - 3.0 * law.shear() * slip - law.yield_stress(0.02 + slip);
        assert!(rest.abs() < 1e-11);
    }
}
