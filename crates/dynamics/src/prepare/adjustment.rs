//! Adjustment of the mesh before the start: strain-free moves of slave nodes onto the master
//! surface (`ADJUST=` of `*CONTACT PAIR`, `*CLEARANCE`, `*CONTACT INITIALIZATION DATA` of general contact), with a check
//! of the elements that change shape. See docs/theory/geometry.md, Initial gaps.

use super::initial_gaps::{InitialGap, gaps};
use crate::contact::tolerances::{ADJUSTMENT_REACH, COORDINATE_ROUND_OFF};
use crate::contact::{ContactSurfaces, project};
use crate::diagnostics::{Code, Diagnostic, Diagnostics};
use crate::model::{Adjust, Contact, Element, Model, Reach};
use crate::vectors::distance;
use std::collections::{HashMap, HashSet};

/// Largest number of sweeps over the nodes of a surface that touches itself.
const SWEEPS: usize = 20;

/// Nodes moved for a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adjusted {
    /// Index of the contact.
    pub contact: usize,
    /// Number of nodes moved.
    pub count: usize,
    /// Index of the node with the largest move.
    pub node: usize,
    /// Length of the largest move.
    pub largest: f64,
    /// An element that the moves turned inside out or flattened, if any.
    pub spoiled: Option<usize>,
}

/// Moves slave nodes onto the master surfaces as the contacts of a model require, one contact after
/// the other. The reference coordinates change, so the moves cause no strain.
pub(super) fn adjust(model: &mut Model, surfaces: &[ContactSurfaces]) -> Vec<Adjusted> {
    if model
        .contacts
        .iter()
        .all(|contact| contact.adjust.is_none())
    {
        return Vec::new();
    }
    let bodies = model.mesh.bodies();
    let mut adjusted = Vec::new();
    for (i, surfaces) in surfaces.iter().enumerate() {
        let Some(wanted) = model.contacts[i].adjust else {
            continue;
        };
        let before = model.mesh.coordinates.clone();
        let clearance = wanted.clearance();
        let meant = |model: &Model| {
            let shrinks = model.contacts[i].is_interference_fit;
            let mut meant = gaps(surfaces, &model.mesh.coordinates, &bodies, shrinks);
            meant.retain(|gap| {
                let off = (gap.gap - clearance).abs();
                off > COORDINATE_ROUND_OFF * gap.edge && is_meant(model, wanted, gap)
            });
            meant
        };
        let mut wanted_moves = meant(model);
        if model.contacts[i].is_self_contact() {
            for _ in 0..SWEEPS {
                move_nodes(model, &independent(wanted_moves), clearance);
                wanted_moves = meant(model);
                wanted_moves.retain(|gap| gap.gap < clearance.min(0.0));
                if wanted_moves.is_empty() {
                    break;
                }
            }
        } else {
            move_nodes(model, &wanted_moves, clearance);
        }
        adjusted.extend(adjusted_of(model, i, &surfaces.slaves, &before));
    }
    adjusted
}

/// Chooses the nodes that move in a sweep: of a node and the segment that it faces, either the node or the segment
/// moves. The deepest nodes come first. Of nodes with the same depth (up to round-off), the nodes that face the longest
/// segments come first, since nodes of a fine mesh follow the shape of a coarse mesh. Nodes of equal depth that face
/// equally long segments come in the order of the model.
fn independent(mut gaps: Vec<InitialGap>) -> Vec<InitialGap> {
    let depths = ranks(&gaps, |gap| gap.gap);
    let lengths = ranks(&gaps, |gap| -gap.length);
    gaps.sort_by_key(|gap| (depths[&gap.slave], lengths[&gap.slave], gap.slave));
    let (mut moved, mut faced) = (HashSet::new(), HashSet::new());
    gaps.retain(|gap| {
        let is_free = !faced.contains(&gap.slave);
        let is_at_rest = gap.segment.iter().all(|node| !moved.contains(node));
        if is_free && is_at_rest {
            moved.insert(gap.slave);
            faced.extend(gap.segment);
        }
        is_free && is_at_rest
    });
    gaps
}

/// Rank of each slave node by a length, with the least length first; lengths that differ by no more than the round-off
/// of coordinates have the same rank.
fn ranks(gaps: &[InitialGap], length: impl Fn(&InitialGap) -> f64) -> HashMap<usize, usize> {
    let mut ordered: Vec<&InitialGap> = gaps.iter().collect();
    ordered.sort_by(|a, b| length(a).total_cmp(&length(b)));
    let mut rank = 0;
    let mut last = f64::NEG_INFINITY;
    let mut ranks = HashMap::new();
    for gap in ordered {
        rank += usize::from(length(gap) - last > COORDINATE_ROUND_OFF * gap.edge);
        last = length(gap);
        ranks.insert(gap.slave, rank);
    }
    ranks
}

/// Whether a node is to be moved.
fn is_meant(model: &Model, wanted: Adjust, gap: &InitialGap) -> bool {
    match wanted {
        Adjust::Within(Reach { above, below, .. }) => (-below..=above).contains(&gap.gap),
        Adjust::Clearance(_) => gap.gap <= ADJUSTMENT_REACH * gap.length,
        Adjust::Nodes(set) => {
            let members = &model.sets.nodes[set].members;
            members.binary_search(&gap.slave).is_ok() && gap.gap <= ADJUSTMENT_REACH * gap.length
        }
    }
}

/// Moves nodes to the feet of their projections on the master surface, or to a clearance above these feet.
fn move_nodes(model: &mut Model, moved: &[InitialGap], clearance: f64) {
    let before = model.mesh.coordinates.clone();
    for gap in moved {
        let [a, b] = gap.segment.map(|node| before[node]);
        let xi = gap.xi.clamp(0.0, 1.0);
        let foot = [0, 1].map(|i| a[i] + xi * (b[i] - a[i]));
        let normal = project(a, a, b).normal;
        let above = clearance + gap.rise;
        model.mesh.coordinates[gap.slave] = match above {
            0.0 => foot,
            _ => [0, 1].map(|i| foot[i] + above * normal[i]),
        };
    }
}

/// Moves of the slave nodes of a contact from the positions `before`; `None` if no node has moved.
fn adjusted_of(
    model: &Model,
    contact: usize,
    slaves: &[usize],
    before: &[[f64; 2]],
) -> Option<Adjusted> {
    let after = &model.mesh.coordinates;
    let ways = slaves
        .iter()
        .map(|&node| (distance(before[node], after[node]), node));
    let moved: Vec<(f64, usize)> = ways.filter(|(travel, _)| *travel > 0.0).collect();
    let &(largest, node) = (moved.iter()).max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))?;
    let is_spoiled = |element: &Element| element.is_spoiled(before, after);
    Some(Adjusted {
        contact,
        count: moved.len(),
        node,
        largest,
        spoiled: model.mesh.elements.iter().position(is_spoiled),
    })
}

/// Reports the moved nodes; a spoiled element is an error.
pub(super) fn report_adjusted(model: &Model, adjusted: &[Adjusted], d: &mut Diagnostics) {
    for moved in adjusted {
        let contact = &model.contacts[moved.contact];
        d.push(match moved.spoiled {
            None => note(model, contact, moved),
            Some(element) => {
                let label = model.element_name(element);
                let slave = &model.surfaces[contact.slave].name;
                let message = format!(
                    "moving the nodes of {slave} onto the master spoils the shape of element {label}"
                );
                Diagnostic::error(Code::Adjusted, contact.span, message)
                    .help("mend the mesh or adjust fewer nodes")
            }
        });
    }
}

fn note(model: &Model, contact: &Contact, moved: &Adjusted) -> Diagnostic {
    let message = format!(
        "{} {} of {} moved onto {}, node {} by {:.3e}{}",
        moved.count,
        if moved.count == 1 { "node" } else { "nodes" },
        model.surfaces[contact.slave].name,
        match contact.is_self_contact() {
            true => "the surfaces that they face",
            false => &model.surfaces[contact.master].name,
        },
        model.node_name(moved.node),
        moved.largest,
        if moved.count == 1 {
            ""
        } else {
            ", the largest move"
        },
    );
    Diagnostic::note(Code::Adjusted, contact.span, message)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::contact_surfaces;
    use crate::model::{ElementType, Face, Interaction, Surface, SurfaceKind};

    /// Whether moving the upper corners of a slightly sheared square spoils the element; `unit` scales all lengths.
    fn is_spoiled_by(upper: [[f64; 2]; 2], unit: f64) -> bool {
        let square = [[0.0, 0.0], [1.0, 0.03], [1.02, 1.01], [0.01, 0.98]];
        let moved = [square[0], square[1], upper[0], upper[1]];
        let [before, after] = [square, moved].map(|x| x.map(|p| p.map(|x| unit * x)));
        let element = Element {
            label: 1,
            element_type: ElementType::CPS4,
            nodes: vec![0, 1, 2, 3].into(),
            section: 0,
        };
        element.is_spoiled(&before, &after)
    }

    #[test]
    fn elements_of_any_size_are_spoiled_by_the_same_moves() {
        let (right, left) = ([1.02, 1.01], [0.01, 0.98]);
        for unit in [1e-6, 1e-2, 1.0, 1e3] {
            let is_spoiled_by = |right, left| is_spoiled_by([right, left], unit);
            assert!(!is_spoiled_by([1.02, 1.02], left), "a small move, {unit:e}");
            assert!(!is_spoiled_by([0.7, 0.7], left), "convex, {unit:e}");
            assert!(is_spoiled_by([0.5, 0.5], left), "not convex, {unit:e}");
            assert!(is_spoiled_by(right, [0.6, 0.4]), "not convex, {unit:e}");
            assert!(!is_spoiled_by([1.02, 0.6], [0.01, 0.6]), "low, {unit:e}");
            assert!(is_spoiled_by([1.02, 0.4], [0.01, 0.4]), "flat, {unit:e}");
        }
    }

    #[test]
    fn round_off_does_not_choose_between_nodes_that_face_each_other() {
        let gap = |slave: usize, segment: [usize; 2], gap: f64, length: f64| InitialGap {
            slave,
            segment,
            xi: 0.5,
            gap,
            rise: 0.0,
            length,
            edge: 1.0,
        };
        let moved = |noise: [f64; 3], lengths: [f64; 3]| -> Vec<usize> {
            let gaps = vec![
                gap(7, [1, 2], -0.1 + noise[0], lengths[0]),
                gap(1, [7, 8], -0.1 + noise[1], lengths[1]),
                gap(9, [3, 4], -0.2 + noise[2], lengths[2]),
            ];
            independent(gaps).iter().map(|gap| gap.slave).collect()
        };
        for noise in [[0.0; 3], [-1e-16, 1e-16, 0.0], [1e-16, -1e-16, 1e-16]] {
            let noisy = noise.map(|noise| 1.0 + noise);
            assert_eq!(moved(noise, noisy), [9, 1], "{noise:?}");
            assert_eq!(moved(noise, [1.5, 1.0, 1.0]), [9, 7], "{noise:?}");
        }
        assert_eq!(moved([-1e-3, 0.0, 0.0], [1.0; 3]), [9, 7]);
    }

    /// Number of moved nodes of a square above another; the gap is `part` times the length of an edge.
    fn moved_from(part: f64, edge: f64) -> usize {
        let mut model = Model::default();
        for (first, height) in [(0, 0.0), (4, 1.0 + part)] {
            let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
            let above = corners.map(|[x, y]| [edge * x, edge * (y + height)]);
            model.mesh.coordinates.extend(above);
            model.mesh.elements.push(Element {
                label: 1,
                element_type: ElementType::CPS4,
                nodes: (first..first + 4).collect(),
                section: 0,
            });
        }
        for (name, element, side) in [("UPPER", 1, 0), ("LOWER", 0, 2)] {
            model.surfaces.push(Surface {
                name: name.into(),
                kind: SurfaceKind::Faces(vec![Face { element, side }]),
            });
        }
        model.contacts.push(Contact {
            adjust: Some(Adjust::Within(Reach {
                above: 0.1 * edge,
                below: f64::INFINITY,
                clearance: 0.0,
            })),
            ..Contact::new([0, 1], Interaction::default())
        });
        let surfaces = contact_surfaces(&model, &model.mesh.bodies());
        let adjusted = adjust(&mut model, &surfaces);
        adjusted.iter().map(|moved| moved.count).sum()
    }

    #[test]
    fn nodes_that_are_on_the_surface_but_for_round_off_stay() {
        for edge in [1e-4, 1e-2, 1.0, 1e2, 1e4] {
            assert_eq!(moved_from(2e-10, edge), 0, "{edge:e}");
            assert_eq!(moved_from(5e-9, edge), 2, "{edge:e}");
            assert_eq!(moved_from(-5e-9, edge), 2, "{edge:e}");
            assert_eq!(moved_from(0.2, edge), 0, "too far, {edge:e}");
        }
    }
}
