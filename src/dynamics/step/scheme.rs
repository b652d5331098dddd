//! Weights and configurations of the time integration schemes: SS22 of Zienkiewicz, Wood & Hine
//! (1984) and the energy-momentum form of Simo & Tarnow (1992). Section 4 of docs/theory.md.

use crate::contact::RowForm;
use crate::dynamics::results::State;
use crate::elements::Motion;
use crate::model::Scheme;

/// The single-step scheme SS22 with its weights, or the energy-momentum form of its mid-point rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Weights {
    pub theta1: f64,
    pub theta2: f64,
    pub energy_momentum: bool,
}

impl Weights {
    pub fn new(scheme: Scheme) -> Self {
        match scheme {
            Scheme::EnergyMomentum => Weights {
                theta1: 0.5,
                theta2: 0.5,
                energy_momentum: true,
            },
            Scheme::Ss22 { theta1, theta2 } => Weights {
                theta1,
                theta2,
                energy_momentum: false,
            },
        }
    }

    /// How contact rows are made.
    pub fn row_form(&self) -> RowForm {
        if self.energy_momentum {
            RowForm::DiscreteGradient
        } else {
            RowForm::End
        }
    }

    /// Rows of the impulses: at the start in the energy-momentum form, else those of the end.
    pub fn impulses_at_start(&self) -> bool {
        self.energy_momentum
    }

    /// Whether U_theta depends on V0+.
    pub fn lags(&self) -> bool {
        self.theta1 != self.theta2
    }

    /// U_theta = U0 + theta2 d + (theta1 - theta2) dt V0+, d = U - U0, eq. (4.3).
    pub fn write_displacement(&self, [u0, d, v0p]: [&[f64]; 3], dt: f64, u_theta: &mut [f64]) {
        let lag = (self.theta1 - self.theta2) * dt;
        for (u_theta, ((u0, d), v0p)) in u_theta.iter_mut().zip(u0.iter().zip(d).zip(v0p)) {
            *u_theta = u0 + self.theta2 * d + lag * v0p;
        }
    }

    /// The motion at which internal force and tangent are evaluated: U_theta, in the energy-momentum form
    /// from U0 to U1.
    pub fn motion<'a>(&self, start: &'a State, u1: &'a [f64], u_theta: &'a [f64]) -> Motion<'a> {
        let increment = Some([start.u.as_slice(), u1]);
        match self.energy_momentum {
            true => Motion {
                start: Some(&start.u),
                increment,
                ..Motion::at(u1, &start.internal)
            },
            false => Motion {
                increment,
                ..Motion::at(u_theta, &start.internal)
            },
        }
    }
}
