//! Touches of a run that increments or elements are too long for: what is left of the energy tells nothing of
//! their forces and rebounds.

use crate::dynamics::Touch;
use crate::output::text::{counted, general};

/// Part of the largest energy from which on the approach of two bodies matters.
const MATTERS: f64 = 0.01;
/// Increments of a touch, landing to rebound, from which on its course is resolved; also the most between two
/// touches of the same bodies that count as one.
const ENOUGH_INCREMENTS: usize = 10;
/// Increments of a touch that suit it.
const GOOD_INCREMENTS: f64 = 20.0;
/// Nodes of a touch, where no corner bounds it, from which on its pressure has a shape.
const ENOUGH_NODES: usize = 4;

/// The touches of a run that matter and are not resolved.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Touches {
    /// Number of touches that matter.
    all: usize,
    /// Those of too few increments: their number and the one with the fewest.
    brief: Worst,
    /// Those of too few nodes.
    narrow: Worst,
}

/// Number of touches that are not resolved, and the worst.
type Worst = Option<(usize, Touch)>;

impl Touches {
    /// Of all touches of a run those that matter beside its largest energy.
    pub fn new(all: &[Touch], largest: f64) -> Self {
        let mut touches: Vec<Touch> = Vec::new();
        for touch in all {
            let same = |before: &&mut Touch| before.bodies == touch.bodies;
            match touches.iter_mut().rev().find(same) {
                Some(before) if touch.first - before.last <= ENOUGH_INCREMENTS => {
                    join(before, touch);
                }
                _ => touches.push(*touch),
            }
        }
        touches.retain(|touch| touch.energy > MATTERS * largest);
        let brief = |touch: &&Touch| increments(touch) < ENOUGH_INCREMENTS;
        let narrow = |touch: &&Touch| touch.nodes < ENOUGH_NODES && !touch.is_at_corner;
        Touches {
            all: touches.len(),
            brief: worst(touches.iter().filter(brief), increments),
            narrow: worst(touches.iter().filter(narrow), |touch| touch.nodes),
        }
    }

    /// Increments as long as a landing and its rebound.
    pub fn brief_text(&self) -> Option<String> {
        let (count, touch) = self.brief?;
        let increments = counted(increments(&touch), "increment");
        let dt = (touch.end - touch.start) / GOOD_INCREMENTS;
        Some(format!(
            "{count} of {} from landing to rebound took less than {ENOUGH_INCREMENTS} increments (one \
             {increments}, from time {}), so that forces and rebounds are not resolved, whatever energy is \
             kept: choose increments of about {}",
            counted(self.all, "contact"),
            general(touch.start, 4),
            general(dt, 1),
        ))
    }

    /// Contacts of round surfaces narrower than a few elements.
    pub fn narrow_text(&self) -> Option<String> {
        let (count, touch) = self.narrow?;
        Some(format!(
            "{count} of {} from landing to rebound had less than {ENOUGH_NODES} nodes in contact at a \
             time (one {}, from time {}), so that stiffness and duration of the contact are those of the \
             mesh: choose a finer mesh at the surface",
            counted(self.all, "contact"),
            touch.nodes,
            general(touch.start, 4),
        ))
    }
}

/// Increments from the landing to the rebound.
fn increments(touch: &Touch) -> usize {
    touch.last + 1 - touch.first
}

/// Makes one touch of two of the same bodies.
fn join(touch: &mut Touch, next: &Touch) {
    touch.last = next.last;
    touch.end = next.end;
    touch.nodes = touch.nodes.max(next.nodes);
    touch.is_at_corner |= next.is_at_corner;
    touch.impulse += next.impulse;
    // the energies go with the squares of the impulses
    touch.energy = (touch.energy.sqrt() + next.energy.sqrt()).powi(2);
}

fn worst<'t>(touches: impl Iterator<Item = &'t Touch> + Clone, of: fn(&Touch) -> usize) -> Worst {
    let worst = touches.clone().min_by_key(|touch| of(touch))?;
    Some((touches.count(), *worst))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A touch of 20 increments with five nodes.
    fn touch() -> Touch {
        Touch {
            bodies: [Some(0), Some(1)],
            node: 3,
            start: 0.5,
            end: 0.7,
            first: 51,
            last: 70,
            nodes: 5,
            impulse: 1.0,
            energy: 1.0,
            ..Touch::default()
        }
    }

    #[test]
    fn touches_that_matter_are_told_where_they_are_not_resolved() {
        let texts = |change: fn(&mut Touch)| {
            let mut changed = touch();
            change(&mut changed);
            let touches = Touches::new(&[touch(), changed], 2.0);
            [touches.brief_text(), touches.narrow_text()].map(Option::unwrap_or_default)
        };
        let later = |t: &mut Touch| (t.first, t.last) = (100, 104);
        let [brief, narrow] = texts(later);
        assert!(brief.starts_with("1 of 2 contacts") && brief.contains("one 5 increments"));
        assert!(brief.contains("increments of about 0.01"), "{brief}");
        assert_eq!(narrow, "");
        let [brief, narrow] = texts(|t| (t.bodies, t.nodes) = ([None, Some(1)], 3));
        assert!(narrow.contains("(one 3, from time 0.5)"), "{narrow}");
        assert_eq!(brief, "");
        for harmless in [
            |t: &mut Touch| (t.first, t.last) = (75, 76),
            |t: &mut Touch| (t.first, t.last, t.energy) = (100, 101, 0.01),
            |t: &mut Touch| (t.bodies, t.nodes, t.is_at_corner) = ([None; 2], 2, true),
        ] {
            assert_eq!(texts(harmless), [""; 2], "resolved, weak or at a corner");
        }
    }
}
