//! Balance equation of an increment, by the procedure of its step. The balance has the weights and configurations of
//! the scheme SS22 of Zienkiewicz, Wood & Hine (1984), of the energy-momentum form of Simo & Tarnow (1992), or of the
//! backward Euler rule. The scheme also tells whether anything depends on rates. See docs/theory/time.md.

use crate::contact::RowForm;
use crate::dynamics::results::State;
use crate::elements::Motion;
use crate::model::{Procedure, Scheme, Step};

/// The single-step scheme SS22 with its weights, or the energy-momentum form of the mid-point rule of SS22. A static
/// step is SS22 with both weights 1 and without rates; a quasi-static step adds the inertia of the backward Euler rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Integration {
    pub theta1: f64,
    pub theta2: f64,
    pub energy_momentum: bool,
    /// Whether inertia and damping take part.
    pub has_rates: bool,
    /// Whether V1 = d/dt, the backward Euler rule. The backward Euler rule needs no impulses, since a node that lands
    /// is at rest in the next increment.
    pub backward_euler: bool,
}

impl Integration {
    /// The integration scheme of a step.
    pub fn new(step: &Step) -> Self {
        match (step.procedure, step.settings.scheme) {
            (Procedure::Static, _) => Integration {
                theta1: 1.0,
                theta2: 1.0,
                energy_momentum: false,
                has_rates: false,
                backward_euler: false,
            },
            (Procedure::QuasiStatic, _) => Integration {
                theta1: 1.0,
                theta2: 1.0,
                energy_momentum: false,
                has_rates: true,
                backward_euler: true,
            },
            (Procedure::Dynamic, Scheme::EnergyMomentum) => Integration {
                theta1: 0.5,
                theta2: 0.5,
                energy_momentum: true,
                has_rates: true,
                backward_euler: false,
            },
            (Procedure::Dynamic, Scheme::Ss22 { theta1, theta2 }) => Integration {
                theta1,
                theta2,
                energy_momentum: false,
                has_rates: true,
                backward_euler: false,
            },
        }
    }

    /// Form of the contact rows.
    pub fn row_form(&self) -> RowForm {
        if self.energy_momentum {
            RowForm::DiscreteGradient
        } else {
            RowForm::End
        }
    }

    /// Whether velocities tell how far nodes move in an increment.
    pub fn velocities_tell(&self) -> bool {
        self.has_rates && !self.backward_euler
    }

    /// Whether the forces of supports and contacts that a step removes fade over the step.
    pub fn fades(&self) -> bool {
        !self.has_rates || self.backward_euler
    }

    /// Whether impulses have the contact rows of the start, as in the energy-momentum form; otherwise they have the
    /// rows of the end.
    pub fn impulses_at_start(&self) -> bool {
        self.energy_momentum
    }

    /// Whether U_theta depends on V0+.
    pub fn lags(&self) -> bool {
        self.theta1 != self.theta2
    }

    /// Factor of M in K* for increments of length `dt`: 2/dt², eq. (4.6), or 1/dt², eq. (4.26); 0 in a static step (1/time^2).
    pub fn mass_factor(&self, dt: f64) -> f64 {
        match (self.has_rates, self.backward_euler) {
            (false, _) => 0.0,
            (true, false) => 2.0 / (dt * dt),
            (true, true) => 1.0 / (dt * dt),
        }
    }

    /// Writes the velocity at the end of an increment of length `dt`: V1 = (2/dt) d - V0+, eq. (4.2), or
    /// V1 = d/dt, eq. (4.25); zero in a static step.
    pub fn end_velocity(&self, d: &[f64], v0p: &[f64], dt: f64) -> Vec<f64> {
        if !self.has_rates {
            return vec![0.0; d.len()];
        }
        let rate = 2.0 / dt;
        let both = d.iter().zip(v0p);
        match self.backward_euler {
            false => both.map(|(d, v0p)| rate * d - v0p).collect(),
            true => d.iter().map(|d| d / dt).collect(),
        }
    }

    /// Displacements U_theta = U0 + theta2 d + (theta1 - theta2) dt V0+ with d = U - U0, eq. (4.3).
    pub fn write_displacement(&self, [u0, d, v0p]: [&[f64]; 3], dt: f64, u_theta: &mut [f64]) {
        let lag = (self.theta1 - self.theta2) * dt;
        for (u_theta, ((u0, d), v0p)) in u_theta.iter_mut().zip(u0.iter().zip(d).zip(v0p)) {
            *u_theta = u0 + self.theta2 * d + lag * v0p;
        }
    }

    /// The motion at which internal force and tangent are evaluated: at U_theta, or in the energy-momentum form from U0
    /// to U1; temperatures are interpolated between start and end.
    pub fn motion<'a>(
        &self,
        start: &'a State,
        u1: &'a [f64],
        [u_theta, temperature]: [&'a [f64]; 2],
    ) -> Motion<'a> {
        let increment = (self.has_rates).then_some([start.u.as_slice(), u1]);
        match self.energy_momentum {
            true => Motion {
                start: Some(&start.u),
                increment,
                ..Motion::at(u1, &start.internal).heated(temperature)
            },
            false => Motion {
                increment,
                ..Motion::at(u_theta, &start.internal).heated(temperature)
            },
        }
    }
}
