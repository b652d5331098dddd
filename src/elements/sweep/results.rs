//! Strain energy, stress and strain of the elements of a block: what [`crate::elements::recovery`] has for
//! one element. Section 2 of docs/theory.md.

use std::array::from_fn;

use super::block::{
    Block, BlockMotion, Deformation, deformation_gradient, determinant, green_lagrange,
    times_symmetric, times_transposed,
};
use super::shape::Shape;
use crate::elements::kinematics::smaller;
use crate::elements::recovery::ElementResult;
use crate::materials::LawInLanes;
use crate::materials::lanes::{LANES, Lanes, Positive, SymmetricLanes};

/// Sums over the integration points, each times its weight.
#[derive(Clone, Copy)]
struct Sums {
    energy: Lanes,
    stress: SymmetricLanes,
    across: Lanes,
    strain: SymmetricLanes,
    volume: Lanes,
    /// Largest absolute principal strain so far.
    principal: [f64; LANES],
}

impl<const N: usize, const P: usize> Block<N, P> {
    /// Results of the elements at displacements.
    #[inline(always)]
    pub fn evaluate<S: Shape<N, P>>(
        &self,
        law: &impl LawInLanes,
        motion: &BlockMotion<N>,
    ) -> [ElementResult; LANES] {
        let u = motion.derivatives::<S, P>();
        let mut sums = Sums {
            energy: Lanes::ZERO,
            stress: [Lanes::ZERO; 3],
            across: Lanes::ZERO,
            strain: [Lanes::ZERO; 3],
            volume: Lanes::ZERO,
            principal: [0.0; LANES],
        };
        for p in 0..P {
            let deformation = self.deformation(p, &u, &mut Positive::default());
            sums.add(law, &deformation, self.volume[p]);
        }
        from_fn(|lane| sums.result(lane))
    }
}

impl Sums {
    /// Adds a point: sigma = F S F^T/J, eq. (2.8), with J = det F F_zz, and sigma_zz = F_zz S_zz F_zz/J.
    #[inline(always)]
    fn add(&mut self, law: &impl LawInLanes, deformation: &Deformation, weight: Lanes) {
        let (h, e) = (deformation.h(), green_lagrange(deformation.h()));
        let (f, det) = (deformation_gradient(h), determinant(h));
        let [stretch, stress] = law.across(&e);
        let sigma = times_transposed(&times_symmetric(&f, &law.stress(&e)), &f);
        let over_j = weight / (det * stretch);
        self.energy += law.stored_energy(&e) * weight;
        self.stress[0] += sigma[0][0] * over_j;
        self.stress[1] += sigma[1][1] * over_j;
        self.stress[2] += sigma[0][1] * over_j;
        self.across += stress * stretch / det * weight;
        for (sum, e) in self.strain.iter_mut().zip(&e) {
            *sum += *e * weight;
        }
        self.volume += weight;
        self.take_principal(&e);
    }

    /// Takes in the largest absolute principal strain of a point.
    ///
    /// ```text
    /// E_1,2 = (E_xx + E_yy)/2 +- sqrt((E_xx - E_yy)²/4 + E_xy²)
    /// ```
    #[inline(always)]
    fn take_principal(&mut self, &[xx, yy, xy]: &SymmetricLanes) {
        let (mean, half) = ((xx + yy) * 0.5, (xx - yy) * 0.5);
        let shear = (half * half + xy * xy).sqrt();
        for (lane, most) in self.principal.iter_mut().enumerate() {
            let strain = mean.0[lane].abs() + shear.0[lane];
            *most = -smaller(-*most, -strain);
        }
    }

    /// The means of one element.
    #[inline(always)]
    fn result(&self, lane: usize) -> ElementResult {
        let volume = self.volume.0[lane];
        let means = |sums: &SymmetricLanes| {
            [
                sums[0].0[lane] / volume,
                sums[1].0[lane] / volume,
                sums[2].0[lane] / volume,
            ]
        };
        ElementResult {
            energy: self.energy.0[lane],
            stress: means(&self.stress),
            across: self.across.0[lane] / volume,
            strain: means(&self.strain),
            principal_strain: self.principal[lane],
        }
    }
}
