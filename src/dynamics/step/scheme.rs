//! Weights and configurations of the time integration schemes: SS22 of Zienkiewicz, Wood & Hine
//! (1984) and the energy-momentum form of Simo & Tarnow (1992). Section 4 of docs/theory.md.

use crate::contact::RowForm;
use crate::dynamics::results::State;
use crate::elements::{Elements, Inverted, Motion};
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
    pub fn displacement(&self, u0: &[f64], d: &[f64], v0p: &[f64], dt: f64) -> Vec<f64> {
        let lag = (self.theta1 - self.theta2) * dt;
        (0..u0.len())
            .map(|i| u0[i] + self.theta2 * d[i] + lag * v0p[i])
            .collect()
    }

    /// Internal force F(U_theta), in the energy-momentum form that between U0 and U1.
    pub fn internal_force(
        &self,
        elements: &Elements,
        start: &State,
        u1: &[f64],
        u_theta: &[f64],
    ) -> Result<Vec<f64>, Inverted> {
        elements.internal_force(self.motion(start, u1, u_theta))
    }

    /// The motion at which internal force and tangent are evaluated.
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
