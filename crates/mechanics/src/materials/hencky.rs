//! Hencky's material: Kirchhoff stress linear in the logarithmic strain (Hencky 1928; Anand 1979). See
//! docs/theory/materials.md.

use super::hyperelastic::Hyperelastic;
use super::spectrum::{Spectrum, log_change};
use super::strains::StrainChange;
use super::symmetric::{Symmetric, Tangent, contract};
use super::{LawCard, SmallStrainModuli};

/// Hencky's material, `*ELASTIC, TYPE=HENCKY`: the elasticity of metals without plastic flow.
///
/// The logarithmic strain E_h has the values ln l_i for the principal stretches l_i, and ln J = tr E_h:
///
/// ```text
/// energy   W = mu sum_i (ln l_i)² + lambda/2 (ln J)²
/// stress   S = (D ln C) : T,  T = lambda tr(E_h) I + 2 mu E_h
/// tangent  dT/dE_h = lambda I x I + 2 mu 1                      constant
/// domain   J > 0; the uniaxial force is largest at a stretch of e = 2.718, and the shear stress at a shear of 3.02
/// moduli   lambda = K - 2/3 mu,  mu = E/(2 (1 + nu)),  K = E/(3 (1 - 2 nu))
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hencky {
    /// Young's modulus E and Poisson's ratio nu.
    pub moduli: SmallStrainModuli,
}

impl Hencky {
    /// `*ELASTIC, TYPE=HENCKY`
    pub fn cards(&self) -> Vec<LawCard> {
        vec![LawCard {
            keyword: "ELASTIC",
            parameter: Some("TYPE=HENCKY"),
            rows: vec![vec![self.moduli.young, self.moduli.poisson]],
        }]
    }
}

impl Hyperelastic for Hencky {
    /// Stored energy W = T : E_h/2, eq. (2.51).
    fn energy(&self, e: &Symmetric) -> f64 {
        let strain = Spectrum::of_strain(e).logarithmic_strain();
        contract(&self.moduli.stress(&strain), &strain) / 2.0
    }

    /// Change of the stored energy, W(E1) - W(E0) = T(E_h0 + dE_h/2) : dE_h.
    fn energy_change(&self, change: &StrainChange) -> f64 {
        let StrainChange {
            start, end, half, ..
        } = change;
        let by = log_change(&(start * 2.0), &(end * 2.0), &(half * 4.0));
        let mean = Spectrum::of_strain(start).logarithmic_strain() + by / 2.0;
        contract(&self.moduli.stress(&mean), &by)
    }

    /// Stress S = (D ln C) : T, eq. (2.51).
    fn stress(&self, e: &Symmetric) -> Symmetric {
        let spectrum = Spectrum::of_strain(e);
        spectrum.log_derivative(&self.moduli.stress(&spectrum.logarithmic_strain()))
    }

    fn tangent(&self, e: &Symmetric) -> Tangent {
        let spectrum = Spectrum::of_strain(e);
        let t = self.moduli.stress(&spectrum.logarithmic_strain());
        spectrum.tangent(&t, |strain| self.moduli.stress(strain))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::{Across, Plane, PlaneStress, SaintVenantKirchhoff};
    use nalgebra::Matrix2;

    const YOUNG: f64 = 1000.0;
    const POISSON: f64 = 0.3;
    const LAW: Hencky = Hencky {
        moduli: SmallStrainModuli {
            young: YOUNG,
            poisson: POISSON,
        },
    };

    /// Green-Lagrange strain E_ii of a principal stretch.
    fn green(l: f64) -> f64 {
        (l * l - 1.0) / 2.0
    }

    #[test]
    fn uniaxial_stress_in_closed_form() {
        // l_2 = l_3 = l^-nu, T_11 = E ln l, W = E (ln l)²/2; sigma_11 = E ln l/J with J = l^(1 - 2 nu)
        let plane: &dyn Hyperelastic = &PlaneStress {
            law: LAW,
            poisson: POISSON,
        };
        for l in [0.5_f64, 0.9, 1.1, 3.0] {
            let (side, log) = (l.powf(-POISSON), l.ln());
            let e = Symmetric::new(green(l), green(side), green(side), 0.0);
            let s = LAW.stress(&e);
            let j = l * side * side;
            assert!(
                (s.x * l * l / j - YOUNG * log / l.powf(1.0 - 2.0 * POISSON)).abs() < 1e-12 * YOUNG
            );
            assert!(
                [s.y, s.z, s.w].iter().all(|s| s.abs() < 1e-11 * YOUNG),
                "{s:?}"
            );
            assert!((LAW.energy(&e) - YOUNG * log * log / 2.0).abs() < 1e-13 * YOUNG);
            // in plane stress the strain across the plane follows from the others
            let Across { stretch, stress } = plane.across(&Symmetric { z: 0.0, ..e });
            assert!(
                (stretch / side - 1.0).abs() < 1e-14 && stress == 0.0,
                "{stretch} {side}"
            );
            let own = plane.stress(&Symmetric { z: 0.0, ..e });
            assert!((own - Symmetric::new(s.x, 0.0, 0.0, 0.0)).norm() < 1e-11 * YOUNG);
        }
        // without lateral contraction the stretch 1/2 gives twice the stress of the logarithmic strain, since J is 1/2
        let free = Hencky {
            moduli: SmallStrainModuli {
                young: YOUNG,
                poisson: 0.0,
            },
        };
        let s = free.stress(&Symmetric::new(0.0, green(0.5), 0.0, 0.0));
        assert!((s.y * 0.5 + 1386.294361).abs() < 1e-6, "{s:?}");
    }

    #[test]
    fn simple_shear_in_closed_form() {
        // F = I + g e_x e_y: J = 1, ln l_1 = arsinh(g/2) = e at the angle t of V with tan 2 t = 2/g:
        // sigma = 2 mu e (cos 2 t, -cos 2 t, 0; sin 2 t), W = 2 mu e²
        let mu = YOUNG / (2.0 * (1.0 + POISSON));
        for g in [1e-6_f64, 0.3, 2.0, 3.02, 6.0] {
            let f = Matrix2::new(1.0, g, 0.0, 1.0);
            let strain = (f.transpose() * f - Matrix2::identity()) / 2.0;
            let e = Symmetric::of_plane(&strain, 0.0);
            let s = LAW.stress(&e);
            let sigma = f * s.in_plane() * f.transpose();
            let (log, root) = ((g / 2.0).asinh(), (4.0 + g * g).sqrt());
            let size = 2.0 * mu * log;
            let exact = Matrix2::new(g, 2.0, 2.0, -g) * (size / root);
            assert!(
                (sigma - exact).norm() < 1e-13 * mu * (1.0 + g * g),
                "{g} {sigma}"
            );
            assert!(s.z.abs() < 1e-13 * mu, "{g} {}", s.z);
            let exact = size * log;
            assert!(
                (LAW.energy(&e) - exact).abs() < 1e-13 * exact.max(mu * 1e-6),
                "{g}"
            );
        }
    }

    #[test]
    fn stress_and_tangent_are_derivatives() {
        let strains = [
            Symmetric::zeros(),
            Symmetric::new(0.2, -0.1, 0.3, 0.15),
            Symmetric::new(-0.3, 0.9, -0.2, 0.2),
            // equal principal values
            Symmetric::new(0.4, 0.4, 0.4, 0.0),
            Symmetric::new(1e-9, -2e-9, 3e-9, 1e-9),
        ];
        let h = 1e-6;
        for e in strains {
            let c = LAW.tangent(&e).matrix();
            let found = Tangent::of_columns(|unit| {
                let [ahead, behind] = [h, -h].map(|h| LAW.stress(&(e + *unit * h)));
                (ahead - behind) / (2.0 * h)
            });
            assert!((found.matrix() - c).norm() < 1e-8 * c.norm(), "{e:?}");
            let direction = Symmetric::new(0.3, -0.2, 0.4, 0.5);
            let change = StrainChange::about(e, direction * h);
            let slope = LAW.energy_change(&change) / (2.0 * h);
            let work = LAW.stress(&e).contract::<true>(&direction);
            assert!((slope - work).abs() < 1e-9 * c.norm(), "{slope} {work}");
        }
    }

    #[test]
    fn a_closed_cycle_does_no_work() {
        // stretches up to 2.2 and 0.45 whose axes turn, in few and in many increments of the energy-momentum stress
        let at = |time: f64| {
            let size = (std::f64::consts::PI * time).sin();
            let turn = nalgebra::Rotation2::new(4.0 * time).into_inner();
            let l = Matrix2::new((0.8 * size).exp(), 0.0, 0.0, (-0.8 * size * size).exp());
            let c = turn * (l * l) * turn.transpose();
            Symmetric::of_plane(
                &((c - Matrix2::identity()) / 2.0),
                green((0.5 * size).exp()),
            )
        };
        let plane: &dyn Hyperelastic = &PlaneStress {
            law: LAW,
            poisson: POISSON,
        };
        for (law, is_plane) in [(&LAW as &dyn Hyperelastic, false), (plane, true)] {
            for steps in [7, 100, 3000] {
                let place = |step: u32| {
                    let e = at(f64::from(step % steps) / f64::from(steps));
                    Symmetric {
                        z: if is_plane { 0.0 } else { e.z },
                        ..e
                    }
                };
                let (mut work, mut most) = (0.0, 0.0_f64);
                for step in 0..steps {
                    let change = StrainChange::between(&place(step), &place(step + 1));
                    work += contract(&law.mean_stress(&change), &change.change());
                    most = most.max(law.energy(&change.end));
                }
                assert!(
                    work.abs() < 1e-13 * most && most > 0.3 * YOUNG,
                    "{steps}: {work} {most}"
                );
            }
        }
    }

    #[test]
    fn small_strains_are_those_of_linear_elasticity_to_second_order() {
        let linear: &dyn Hyperelastic = &SaintVenantKirchhoff {
            young: YOUNG,
            poisson: POISSON,
        }
        .in_plane(Plane::Revolution);
        let direction = Symmetric::new(0.7, -0.4, 0.3, 0.5);
        let difference = |size: f64| {
            let e = direction * size;
            (LAW.stress(&e) - linear.stress(&e)).norm()
        };
        for size in [1e-2, 1e-3, 1e-4] {
            let ratio = difference(size) / difference(size / 2.0);
            assert!((ratio - 4.0).abs() < 20.0 * size, "{size} {ratio}");
        }
        // S of one direction is E (e - 5/2 e²) against E (e + e²/2)
        let part = difference(0.01) / linear.stress(&(direction * 0.01)).norm();
        assert!((0.01..0.05).contains(&part), "{part}");
    }
}
