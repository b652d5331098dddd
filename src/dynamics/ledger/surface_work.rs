//! Work of friction, depth of wear and heat at the slave nodes since the start. Section 9 of docs/theory.md, Wear and
//! heat.

use std::collections::BTreeMap;

use super::pair_work::{PairWork, on_slave_surface};
use crate::archive::{Archive, ArchiveError};
use crate::contact::{Constraint, ConstraintKey};
use crate::dynamics::increment::Solved;
use crate::dynamics::results::FrictionResults;
use crate::dynamics::step::{SlaveFaces, StepProblem};
use crate::model::Model;

/// Sums over the run, where the deck asks for wear or heat.
pub(crate) struct SurfaceWork {
    sums: FrictionResults,
}

impl SurfaceWork {
    /// Nothing yet; `start` is 0 at slave nodes, NaN at others.
    pub fn new(model: &Model, start: &[f64]) -> Self {
        let interactions = || model.contacts.iter().map(|contact| &contact.interaction);
        let where_asked = |is_asked: bool| if is_asked { start.to_vec() } else { Vec::new() };
        let has_wear = interactions().any(|own| own.wear.is_some());
        let has_heat = interactions().any(|own| own.heat.is_some());
        SurfaceWork {
            sums: FrictionResults {
                coefficient: Vec::new(),
                work: where_asked(has_wear || has_heat),
                wear: where_asked(has_wear),
                heat: where_asked(has_heat),
            },
        }
    }

    /// Carries the sums.
    pub fn carry(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        let FrictionResults {
            coefficient: _,
            work,
            wear,
            heat,
        } = &mut self.sums;
        archive.carry_values(work)?;
        archive.carry_values(wear)?;
        archive.carry_values(heat)
    }

    /// Work, wear and heat so far.
    pub fn results(&self) -> FrictionResults {
        self.sums.clone()
    }

    /// Enters the works of the pairs in a converged increment. With D the work of friction of a pair and A the area of
    /// its slave node against the normal,
    ///
    /// ```text
    /// w += D/A,  h += k/H Pn |Bt d|/A  or  k/H D/A,  q += eta f D    eq. (9.15)
    /// ```
    pub fn enter(
        &mut self,
        problem: &StepProblem,
        faces: &SlaveFaces,
        solved: &Solved,
        works: &[PairWork],
    ) {
        if self.sums.work.is_empty() {
            return;
        }
        let acting = solved.contact.forces.acting();
        let constraints: BTreeMap<ConstraintKey, &Constraint> = acting
            .map(|(constraint, _)| (constraint.key, constraint))
            .collect();
        let u = &solved.equilibrium.u_theta;
        let given_back = solved.returned.pairs.iter().filter_map(|pair| {
            let constraint = constraints.get(&pair.key)?;
            let sliding = match constraint.mu > 0.0 {
                true => pair.friction / constraint.mu,
                false => 0.0,
            };
            Some((
                pair.key,
                -pair.friction,
                -sliding,
                on_slave_surface(constraint),
            ))
        });
        let works = works
            .iter()
            .map(|work| (work.key, work.friction, work.sliding, work.slaves.clone()));
        for (key, friction, sliding, slaves) in works.chain(given_back) {
            let interaction = &problem.model.contacts[key.contact()].interaction;
            if interaction.wear.is_none() && interaction.heat.is_none() {
                continue;
            }
            for (node, normal) in slaves {
                let area = faces.area(node, normal, |node| problem.position(u, node));
                if area > 0.0 {
                    self.sums.work[node] += friction / area;
                }
                if let Some(wear) = interaction.wear.filter(|_| area > 0.0) {
                    let by = if wear.by_friction { friction } else { sliding };
                    self.sums.wear[node] += wear.rate * by / area;
                }
                if let Some(part) = interaction.heat {
                    self.sums.heat[node] += part * friction;
                }
            }
        }
    }
}
