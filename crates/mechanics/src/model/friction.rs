//! Coulomb friction whose coefficient may depend on slip rate and contact pressure. See docs/theory/contact.md,
//! Friction that depends on slip rate and pressure.

/// Coulomb friction of an interaction.
#[derive(Debug, Clone, PartialEq)]
pub struct Friction {
    /// Its coefficient.
    pub law: FrictionLaw,
    /// Largest shear stress (force/length^2); infinite without a limit.
    pub shear_limit: f64,
}

/// Coefficient of friction mu >= 0.
#[derive(Debug, Clone, PartialEq)]
pub enum FrictionLaw {
    /// Constant, or lower in fast slip, eq. (3.10).
    Decay {
        /// Coefficient mu_s at rest.
        at_rest: f64,
        /// Coefficient mu_k in fast slip.
        sliding: f64,
        /// Decay d_c >= 0 from mu_s to mu_k (time/length).
        decay: f64,
    },
    /// Curves with increasing pressures; values are linear between the points of a curve and between curves, and
    /// constant beyond the first and last points and curves.
    Table(Vec<FrictionCurve>),
    /// Closed pairs never slip.
    Rough,
}

/// Coefficients of friction at one contact pressure.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionCurve {
    /// Contact pressure (force/length^2).
    pub pressure: f64,
    /// Slip rates (length/time), increasing, each with its coefficient.
    pub points: Vec<[f64; 2]>,
}

/// Coefficient of surfaces that never slip: a normal force is negligible if its ratio to the tangential force is below
/// the inverse of this coefficient. With a larger coefficient complementarity problems lose digits: with 1e6 some end
/// on a ray.
const ROUGH: f64 = 1e4;

impl Default for Friction {
    fn default() -> Self {
        Friction::constant(0.0)
    }
}

impl From<FrictionLaw> for Friction {
    fn from(law: FrictionLaw) -> Self {
        Friction {
            law,
            shear_limit: f64::INFINITY,
        }
    }
}

impl Friction {
    /// The same coefficient at all slip rates and pressures.
    pub fn constant(mu: f64) -> Self {
        FrictionLaw::Decay {
            at_rest: mu,
            sliding: mu,
            decay: 0.0,
        }
        .into()
    }

    /// Whether the coefficient is always the same.
    pub fn is_constant(&self) -> bool {
        let law_is = match &self.law {
            FrictionLaw::Decay {
                at_rest,
                sliding,
                decay,
            } => at_rest == sliding || *decay == 0.0,
            FrictionLaw::Table(_) => false,
            FrictionLaw::Rough => true,
        };
        law_is && !self.has_limit()
    }

    /// Whether the coefficient depends on the contact pressure.
    pub fn depends_on_pressure(&self) -> bool {
        let law_does = match &self.law {
            FrictionLaw::Table(curves) => curves.len() > 1,
            FrictionLaw::Decay { .. } | FrictionLaw::Rough => false,
        };
        law_does || self.has_limit()
    }

    /// Whether the shear stress is limited.
    pub fn has_limit(&self) -> bool {
        self.shear_limit.is_finite()
    }

    /// Whether the coefficient can ramp to the coefficient of another friction.
    pub fn ramps_to(&self, other: &Friction) -> bool {
        let is_rough = |friction: &Friction| friction.law == FrictionLaw::Rough;
        self.law != other.law && !is_rough(self) && !is_rough(other)
    }

    /// Coefficient at rest under a contact pressure (force/length^2).
    pub fn at_rest(&self, pressure: f64) -> f64 {
        self.limited(self.law.at(None, pressure), pressure)
    }

    /// Coefficient at a slip rate (length/time) and a contact pressure (force/length^2).
    pub fn at(&self, rate: f64, pressure: f64) -> f64 {
        self.limited(self.law.at(Some(rate), pressure), pressure)
    }

    /// Coefficient at a slip rate (`None` at rest) and a pressure, if the friction has changed by a given part of its
    /// difference from another friction.
    pub fn on_the_way(
        &self,
        (from, part): (&Friction, f64),
        rate: Option<f64>,
        pressure: f64,
    ) -> f64 {
        // mu = (1 - r) mu_before + r mu, eq. (3.17)
        let [before, after] = [from, self].map(|friction| friction.law.at(rate, pressure));
        self.limited(before + part * (after - before), pressure)
    }

    /// Limits a coefficient to min(mu, tau_max/p), eq. (3.14).
    fn limited(&self, mu: f64, pressure: f64) -> f64 {
        match mu * pressure > self.shear_limit {
            true => self.shear_limit / pressure,
            false => mu,
        }
    }

    /// Two coefficients of the law, equal if the coefficient is constant. The two coefficients are the coefficients at
    /// rest and in fast slip. For a table, or with a limit of the shear stress, the two are the largest and the
    /// smallest coefficient.
    pub fn range(&self) -> [f64; 2] {
        let [first, other] = match &self.law {
            FrictionLaw::Decay {
                at_rest, sliding, ..
            } => [*at_rest, *sliding],
            FrictionLaw::Table(curves) => {
                let all = || {
                    curves
                        .iter()
                        .flat_map(|curve| &curve.points)
                        .map(|point| point[1])
                };
                [
                    all().fold(0.0, f64::max),
                    all().fold(f64::INFINITY, f64::min),
                ]
            }
            FrictionLaw::Rough => [ROUGH; 2],
        };
        match self.has_limit() {
            true => [first.max(other), 0.0],
            false => [first, other],
        }
    }
}

impl FrictionLaw {
    /// Coefficient at a slip rate v (length/time), `None` at rest, and a contact pressure (force/length^2).
    fn at(&self, rate: Option<f64>, pressure: f64) -> f64 {
        let rate = rate.map(f64::abs);
        match self {
            FrictionLaw::Decay {
                at_rest,
                sliding,
                decay,
            } if at_rest == sliding || *decay == 0.0 || rate.is_none() => *at_rest,
            // mu = mu_k + (mu_s - mu_k) exp(-d_c |v|), eq. (3.10)
            FrictionLaw::Decay {
                at_rest,
                sliding,
                decay,
            } => sliding + (at_rest - sliding) * (-decay * rate.unwrap_or(0.0)).exp(),
            FrictionLaw::Table(curves) => between(
                curves,
                pressure,
                |c| c.pressure,
                |c| {
                    between(
                        &c.points,
                        rate.unwrap_or(0.0),
                        |point| point[0],
                        |point| point[1],
                    )
                },
            ),
            FrictionLaw::Rough => ROUGH,
        }
    }
}

/// Value at `x` between entries with increasing places: linear between two entries, constant beyond the first and the
/// last entry, eq. (3.12).
fn between<T>(entries: &[T], x: f64, place: impl Fn(&T) -> f64, value: impl Fn(&T) -> f64) -> f64 {
    let (before, after) = entries.split_at(entries.partition_point(|entry| place(entry) <= x));
    match (before.last(), after.first()) {
        (Some(a), Some(b)) => {
            let part = (x - place(a)) / (place(b) - place(a));
            value(a) + part * (value(b) - value(a))
        }
        (Some(only), None) | (None, Some(only)) => value(only),
        (None, None) => 0.0,
    }
}

/// `mu 0.3`; `mu 0.3 at rest, 0.2 sliding, decay 0.001`; `mu 0.1 to 0.3 in 3 rows`; `rough`.
impl std::fmt::Display for Friction {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match &self.law {
            FrictionLaw::Decay {
                at_rest,
                sliding,
                decay,
            } => {
                write!(f, "mu {at_rest}")?;
                if at_rest != sliding && *decay != 0.0 {
                    write!(f, " at rest, {sliding} sliding, decay {decay}")?;
                }
            }
            FrictionLaw::Table(curves) => {
                let rows: usize = curves.iter().map(|curve| curve.points.len()).sum();
                let [most, least] = Friction::from(self.law.clone()).range();
                write!(f, "mu {least} to {most} in {rows} rows")?;
            }
            FrictionLaw::Rough => write!(f, "rough")?,
        }
        match self.has_limit() {
            true => write!(f, ", shear stress up to {}", self.shear_limit),
            false => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }

    fn curve(pressure: f64, points: &[[f64; 2]]) -> FrictionCurve {
        FrictionCurve {
            pressure,
            points: points.to_vec(),
        }
    }

    #[test]
    fn coefficients_are_linear_between_rows_and_constant_beyond() {
        let points = [[0.0, 0.3], [1.0, 0.25], [10.0, 0.2]];
        let one = Friction::from(FrictionLaw::Table(vec![curve(0.0, &points)]));
        for (rate, mu) in [
            (0.0, 0.3),
            (0.5, 0.275),
            (-0.5, 0.275),
            (1.0, 0.25),
            (5.5, 0.225),
            (99.0, 0.2),
        ] {
            near(one.at(rate, 7.0), mu);
        }
        assert!(!one.depends_on_pressure() && !one.is_constant());
        assert_eq!((one.at_rest(1.0), one.range()), (0.3, [0.3, 0.2]));
        let curves = vec![
            curve(10.0, &[[0.0, 0.4], [1.0, 0.2]]),
            curve(30.0, &[[0.0, 0.2]]),
        ];
        let two = Friction::from(FrictionLaw::Table(curves));
        for (rate, pressure, mu) in [
            (0.0, 0.0, 0.4),
            (0.0, 20.0, 0.3),
            (1.0, 20.0, 0.2),
            (0.5, 15.0, 0.275),
            (0.0, f64::INFINITY, 0.2),
        ] {
            near(two.at(rate, pressure), mu);
        }
        assert!(two.depends_on_pressure());
    }

    #[test]
    fn the_shear_stress_is_limited() {
        let limited = Friction {
            shear_limit: 3.0,
            ..Friction::constant(0.3)
        };
        near(limited.at(1.0, 9.0), 0.3);
        near(limited.at(1.0, 20.0) * 20.0, 3.0);
        near(limited.at_rest(20.0), 0.15);
        near(limited.at(0.0, f64::INFINITY), 0.0);
        near(limited.at(0.0, 0.0), 0.3);
        assert!(limited.depends_on_pressure() && !limited.is_constant());
    }

    #[test]
    fn the_coefficient_at_rest_is_that_of_the_deck() {
        let decay = FrictionLaw::Decay {
            at_rest: 0.3,
            sliding: 0.1,
            decay: 2.0,
        };
        assert_eq!(Friction::from(decay).at_rest(0.0), 0.3);
    }
}
