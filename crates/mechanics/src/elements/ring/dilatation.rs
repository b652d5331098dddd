//! Volume ratios of the element in place of those of its points (CAX4H, CPE8H, CPE8RH, CAX8H, CAX8RH; Simo, Taylor &
//! Pister 1985), for nearly incompressible materials. Section 2 of docs/theory.md, Pressures of the element.
//!
//! # Derivation
//!
//! With theta = sum psi_k int psi_k J dOmega, psi_k orthonormal in the volume of the element, L = ln(theta/J) and
//! r = exp(2 L/3), the material has the strain of Fbar = (theta/J)^(1/3) F:
//!
//! ```text
//! Ebar = r E + (r - 1)/2 I,   dEbar = r dE + C/2 dr,   dr = 2/3 r (dtheta/theta - dJ/J),   dJ = J P:dE,  P = C^-1
//! ```
//!
//! so that with a = r Sbar:C/3 and p = sum psi_k int psi_k a/theta dOmega the stress on dE is r Sbar + (p - a/J) J P.

use nalgebra::{Matrix4, Vector4};

use super::points::{OfPoints, RingPoint, as_strain};
use super::stresses::{Compatible, StrainRows, Stresses, add_products, energy_change, size};
use crate::elements::formulation::smaller;
use crate::elements::solid::MAX_DOFS;
use crate::materials::symmetric::{IDENTITY, cofactor, dyad, product};
use crate::materials::{Strains, StressAtPoints, Symmetric, Tangent, contract};

/// Most functions of the volume ratio.
const FUNCTIONS: usize = 3;

/// The functions 1, or 1, x and y, of the volume ratio of an element.
#[derive(Debug, Clone)]
pub(super) struct RingDilatation {
    /// psi_k at every point, orthonormal: int psi_k psi_l dOmega = delta_kl; zero beyond their number (length^-3/2).
    functions: OfPoints<[f64; FUNCTIONS]>,
}

/// A configuration of a point.
struct Dilated {
    /// C, its inverse P and the volume ratio J of the displacements.
    c: Symmetric,
    inverse: Symmetric,
    j: f64,
    /// Volume ratio of the element.
    theta: f64,
    /// r = (theta/J)^(2/3)
    ratio: f64,
    /// Strain of the material.
    strain: Symmetric,
}

impl RingDilatation {
    /// The first `count` functions, by the method of Gram and Schmidt from 1, x and y about the centre.
    pub fn new(points: &[RingPoint], count: usize) -> Self {
        let volume: f64 = points.iter().map(|p| p.volume).sum();
        let sums = points.iter().map(|p| p.place * p.volume);
        let centre = sums.fold(nalgebra::Vector2::zeros(), |sum, x| sum + x) / volume;
        let of_point = |point: &RingPoint| {
            let arm = point.place - centre;
            [1.0, arm.x, arm.y]
        };
        let mut functions: OfPoints<[f64; FUNCTIONS]> = points.iter().map(of_point).collect();
        let product = |functions: &[[f64; FUNCTIONS]], k: usize, l: usize| {
            let all = points.iter().zip(functions);
            all.map(|(point, psi)| point.volume * psi[k] * psi[l])
                .sum::<f64>()
        };
        for k in 0..FUNCTIONS {
            for l in 0..k {
                let part = product(&functions, k, l);
                functions.iter_mut().for_each(|psi| psi[k] -= part * psi[l]);
            }
            let length = product(&functions, k, k).sqrt();
            let factor = if k < count { 1.0 / length } else { 0.0 };
            functions.iter_mut().for_each(|psi| psi[k] *= factor);
        }
        RingDilatation { functions }
    }

    /// sum psi_k int psi_k f dOmega of values f at the points, at every point.
    fn project(&self, points: &[RingPoint], values: impl Iterator<Item = f64>) -> OfPoints<f64> {
        let mut sums = [0.0; FUNCTIONS];
        for ((point, psi), value) in points.iter().zip(&self.functions).zip(values) {
            for (sum, psi) in sums.iter_mut().zip(psi) {
                *sum += point.volume * psi * value;
            }
        }
        let at = |psi: &[f64; FUNCTIONS]| psi.iter().zip(&sums).map(|(psi, sum)| psi * sum).sum();
        self.functions.iter().map(at).collect()
    }

    /// All points at strains of the displacements, eq. (2.45). Small strains keep their digits: J - 1 = s/(J + 1) with s = J² - 1.
    fn dilated(&self, points: &[RingPoint], strains: &[Symmetric]) -> OfPoints<Dilated> {
        let grown = |e: &Symmetric| {
            let g = e * 2.0;
            let minor = g.x * g.y - g.w * g.w;
            let s = (g.x + g.y + g.z) + (minor + g.z * (g.x + g.y)) + g.z * minor;
            s / ((1.0 + s).sqrt() + 1.0)
        };
        let own: OfPoints<f64> = strains.iter().map(grown).collect();
        let of_element = self.project(points, own.iter().copied());
        let all = strains.iter().zip(own.iter().zip(&of_element));
        let of_point = |(e, (own, of_element)): (&Symmetric, (&f64, &f64))| {
            let (c, j) = (IDENTITY + e * 2.0, 1.0 + own);
            // r - 1
            let excess = (((of_element - own) / j).ln_1p() * 2.0 / 3.0).exp_m1();
            Dilated {
                inverse: cofactor(&c) / (j * j),
                c,
                j,
                theta: 1.0 + of_element,
                ratio: 1.0 + excess,
                strain: *e + c * (excess / 2.0),
            }
        };
        all.map(of_point).collect()
    }

    /// Changes of the strains of the material at every point from those of the displacements, with a round-off that is
    /// relative to these, C_m being the mean of C0 and C1:
    ///
    /// ```text
    /// dEbar = (r0 + r1)/2 dE + C_m/2 dr,  dr = r0 (exp(2/3 dL) - 1),  dL = ln(1 + dtheta/theta0) - ln(1 + dJ/J0),
    /// dJ = (cof C_m : 2 dE + det(2 dE)/4)/(J0 + J1),  dtheta = sum psi_k int psi_k dJ dOmega
    /// ```
    fn changes(
        &self,
        points: &[RingPoint],
        [start, end]: [&[Dilated]; 2],
        changes: &[Symmetric],
    ) -> OfPoints<Symmetric> {
        let grown = |((at0, at1), de): ((&Dilated, &Dilated), &Symmetric)| {
            let (c, d) = ((at0.c + at1.c) / 2.0, de * 2.0);
            let determinant = (d.x * d.y - d.w * d.w) * d.z;
            (contract(&cofactor(&c), &d) + determinant / 4.0) / (at0.j + at1.j)
        };
        let all = || start.iter().zip(end).zip(changes);
        let dj: OfPoints<f64> = all().map(grown).collect();
        let dtheta = self.project(points, dj.iter().copied());
        let of_point = |(((at0, at1), de), (dj, dtheta)): (_, (&f64, &f64))| {
            let (at0, at1): (&Dilated, &Dilated) = (at0, at1);
            let dl = (dtheta / at0.theta).ln_1p() - (dj / at0.j).ln_1p();
            let dr = at0.ratio * (2.0 / 3.0 * dl).exp_m1();
            de * ((at0.ratio + at1.ratio) / 2.0) + (at0.c + at1.c) * (dr / 4.0)
        };
        all().zip(dj.iter().zip(&dtheta)).map(of_point).collect()
    }

    /// p - a/J at every point, from stresses Sbar of the material (force/length^2).
    fn pressures(
        &self,
        points: &[RingPoint],
        dilated: &[Dilated],
        s: &[Symmetric],
    ) -> OfPoints<f64> {
        let a = |(at, s): (&Dilated, &Symmetric)| at.ratio * contract(s, &at.c) / 3.0;
        let a: OfPoints<f64> = dilated.iter().zip(s).map(a).collect();
        let ratios = a.iter().zip(dilated).map(|(a, at)| a / at.theta);
        let p = self.project(points, ratios);
        let all = p.iter().zip(a.iter().zip(dilated));
        all.map(|(p, (a, at))| p - a / at.j).collect()
    }

    /// r Sbar + (p - a/J) J P at E_m, eq. (2.46), with the part that keeps the energy, eq. (2.29).
    pub fn stresses(
        &self,
        points: &[RingPoint],
        material: &impl StressAtPoints,
        compatible: &Compatible,
    ) -> Stresses {
        let end = self.dilated(points, &compatible.end);
        let mut determinant = end.iter().map(|at| at.theta).fold(f64::INFINITY, smaller);
        let start = match compatible.is_increment {
            true => self.dilated(points, &compatible.start),
            false => OfPoints::new(),
        };
        let strains: OfPoints<Strains> = if compatible.is_increment {
            let ends = start.iter().zip(&end);
            ends.map(|(e0, e1)| Strains::between(&e0.strain, &e1.strain))
                .collect()
        } else {
            end.iter().map(|at| Strains::At(at.strain)).collect()
        };
        let changes = compatible
            .is_increment
            .then(|| self.changes(points, [&start, &end], &compatible.changes()));
        let middle = match compatible.is_increment {
            true => self.dilated(points, &compatible.halfway()),
            false => end,
        };
        let thetas = middle.iter().map(|at| at.theta);
        determinant = thetas.fold(determinant, smaller);
        let tangent_at: OfPoints<Strains> = match material.is_viscous() {
            true => strains.clone(),
            false => middle.iter().map(|at| Strains::At(at.strain)).collect(),
        };
        let own = tangent_at.iter().enumerate();
        let own: OfPoints<Symmetric> = own.map(|(p, e)| material.stress_at(p, e)).collect();
        let pressures = self.pressures(points, &middle, &own);
        let all = middle.iter().zip(&own).zip(&pressures);
        let mut s: OfPoints<Symmetric> = all
            .map(|((at, own), pressure)| own * at.ratio + at.inverse * (pressure * at.j))
            .collect();
        if let Some(changes) = changes {
            let work = energy_change(points, material, strains.iter().cloned(), &changes);
            compatible.do_work(work, points, &mut s);
        }
        Stresses {
            strains,
            tangent_at,
            s,
            of_material: None,
            determinant,
        }
    }

    /// Adds the second derivative of the energy but for S : D²E, with b = Sbar:C/2:
    ///
    /// ```text
    /// sum v [Bbar^T C Bbar + Sbar:B Dr + Dr Sbar:B + 4/9 b r DL DL + a (DJ DJ/J² - Dtheta Dtheta/theta²)
    ///        + (p - a/J) (DJ DJ/J - 2 J B^T (P o P) B)]
    /// Bbar = r B + C/2 Dr,  DJ = J P:B,  Dtheta = sum psi_k int psi_k DJ dOmega,  DL = Dtheta/theta - DJ/J,  Dr = 2/3 r DL
    /// ```
    pub fn add_tangent(
        &self,
        points: &[RingPoint],
        material: &impl StressAtPoints,
        (compatible, stresses): (&Compatible, &Stresses),
        rows: &[StrainRows],
        k: &mut [f64],
    ) {
        let d = size(k);
        let at = match compatible.is_increment {
            true => self.dilated(points, &compatible.halfway()),
            false => self.dilated(points, &compatible.end),
        };
        let own = stresses.tangent_at.iter().enumerate();
        let own: OfPoints<Symmetric> = own.map(|(p, e)| material.stress_at(p, e)).collect();
        let pressures = self.pressures(points, &at, &own);
        let of_row = |(at, rows): (&Dilated, &StrainRows)| {
            rows.map(|row| at.j * at.inverse.vector().dot(&row))
        };
        let dj: OfPoints<[f64; MAX_DOFS]> = at.iter().zip(rows).map(of_row).collect();
        let mut sums = [[0.0; MAX_DOFS]; FUNCTIONS];
        for ((point, psi), dj) in points.iter().zip(&self.functions).zip(&dj) {
            for (sums, psi) in sums.iter_mut().zip(psi) {
                for (sum, dj) in sums.iter_mut().zip(dj) {
                    *sum += point.volume * psi * dj;
                }
            }
        }
        for (p, point) in points.iter().enumerate() {
            let (at, dj, v) = (&at[p], &dj[p], point.volume);
            let dtheta: [f64; MAX_DOFS] = std::array::from_fn(|i| {
                let terms = self.functions[p].iter().zip(&sums);
                terms.map(|(psi, sums)| psi * sums[i]).sum()
            });
            let dl: [f64; MAX_DOFS] = std::array::from_fn(|i| dtheta[i] / at.theta - dj[i] / at.j);
            let half_c: Vector4<f64> = as_strain(&at.c) / 2.0;
            let bar: StrainRows = std::array::from_fn(|i| {
                rows[p][i] * at.ratio + half_c * (2.0 / 3.0 * at.ratio * dl[i])
            });
            let c: Matrix4<f64> = material.tangent_at(p, &stresses.tangent_at[p]).matrix();
            add_products(&bar, &(c * v), k);
            let around = Tangent(product(&at.inverse)).matrix() * (-2.0 * pressures[p] * at.j);
            let volume = Tangent(dyad(&at.inverse, &at.inverse)).matrix() * (pressures[p] * at.j);
            add_products(&rows[p], &((around + volume) * v), k);
            let b = contract(&own[p], &at.c) / 2.0;
            let a = 2.0 / 3.0 * b * at.ratio;
            let work = rows[p].map(|row| own[p].vector().dot(&row) * (2.0 / 3.0 * at.ratio));
            for i in 0..d {
                for j in 0..d {
                    let mixed = work[i] * dl[j] + dl[i] * work[j];
                    let squares = 4.0 / 9.0 * b * at.ratio * dl[i] * dl[j]
                        + a * (dj[i] * dj[j] / (at.j * at.j)
                            - dtheta[i] * dtheta[j] / (at.theta * at.theta));
                    k[i * d + j] += v * (mixed + squares);
                }
            }
        }
    }
}
