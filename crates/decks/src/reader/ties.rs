//! `*TIE`: slave nodes are moved onto the segments of the master surface that they face, or keep their place beside
//! these segments. Tied nodes follow the segments that they face, or the master below the slave faces, at all times.
//! See docs/theory/contact.md, Ties.

use super::context::Context;
use super::mesh_index::MeshIndex;
use super::names::Names;
use super::nearest::NearestLines;
use super::outline::Outline;
use super::sets::Sets;
use super::surfaces::{Found, Surfaces};
use super::tied_sides;
use crate::deck::{Card, Line, Name};
use crate::diagnostics::{Code, Span, shown};
use crate::model::{
    Contact, ContactFormulation, Element, Mesh, NEAR, Segment, Surface, SurfaceKind, Tie, TieReach,
    TiedNode, TiedSide, nearest_of,
};
use crate::vectors::distance;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// Largest number of nodes that a message names.
const MOST_NAMES: usize = 10;

/// The ties of a deck.
pub(crate) struct Ties {
    /// All ties of the deck.
    pub all: Vec<Tie>,
    /// Places of the ties.
    pub spans: Vec<Span>,
    /// Nodes of both surfaces, each with the segments to which the node is tied or at which it lies; contact between
    /// such a node and segment is left out.
    bonds: Vec<(usize, Segment)>,
}

/// A row of `*TIE` with the parameters of its card.
struct TieRow {
    name: String,
    slave: usize,
    master: usize,
    reach: TieReach,
    /// Nodes of the set that `reach` names, in increasing order.
    members: Vec<usize>,
    formulation: ContactFormulation,
    adjusts: bool,
    span: Span,
}

/// Reads all ties and moves their slave nodes, in the order of the deck; after all moves the nodes are tied at their
/// new places.
pub(super) fn read(
    outline: &Outline,
    mesh_index: &mut MeshIndex,
    sets: &Sets,
    surfaces: &Surfaces,
    cx: &mut Context,
) -> Ties {
    let mut names = Names::of_parts("tie");
    let mut rows = Vec::new();
    for card in outline.model_cards("TIE") {
        rows.extend(rows_of(card, &mut names, (mesh_index, sets, surfaces), cx));
    }
    let mut ties = Ties {
        all: Vec::new(),
        spans: rows.iter().map(|row| row.span).collect(),
        bonds: Vec::new(),
    };
    for row in rows.iter().filter(|row| row.adjusts) {
        let near = Faced::new(row, &surfaces.all, mesh_index);
        adjust(row, &near, mesh_index, cx);
    }
    let mut owner: BTreeMap<usize, usize> = BTreeMap::new();
    for (index, row) in rows.iter().enumerate() {
        let faced = Faced::new(row, &surfaces.all, mesh_index);
        let (mut own, mut elsewhere) = (Vec::new(), Vec::new());
        for (node, segment) in &faced.near {
            match owner.get(node) {
                Some(_) => elsewhere.push(*node),
                None => own.push((*node, *segment)),
            }
        }
        owner.extend(own.iter().map(|(node, _)| (*node, index)));
        report(row, &own, (&faced.far, &elsewhere), mesh_index, cx);
        let x = &mesh_index.mesh.coordinates;
        let tied = |&(node, segment): &(usize, Segment)| TiedNode::new(node, segment, x);
        ties.bonds.extend(&own);
        ties.bonds
            .extend(covered(row, &own, &surfaces.all, mesh_index));
        ties.all.push(Tie {
            name: row.name.clone(),
            slave: row.slave,
            master: row.master,
            reach: row.reach,
            formulation: row.formulation,
            nodes: own.iter().map(tied).collect(),
            sides: sides(row, &faced, &surfaces.all, mesh_index),
        });
    }
    ties
}

/// The rows of a card `*TIE`.
fn rows_of(
    card: &Card,
    names: &mut Names,
    (mesh_index, sets, surfaces): (&MeshIndex, &Sets, &Surfaces),
    cx: &mut Context,
) -> Vec<TieRow> {
    let name = match card.has("NAME") {
        true => names.new_name(card, cx),
        false => Some(Name::plain(&format!("TIE-{}", names.typed().count() + 1))),
    };
    let Some(name) = name else { return Vec::new() };
    let reach = reach(card, sets, cx);
    let members = card.value("TIED NSET").filter(|_| reach.is_some());
    let members = members.map(|field| sets.nodes_of(field, mesh_index, cx));
    let mut members = members.unwrap_or_default();
    members.sort_unstable();
    let adjusts = card.choice("ADJUST") != Some("NO");
    let count = card.rows.iter().count();
    let mut rows = Vec::new();
    for (number, row) in card.rows.iter().enumerate() {
        let Some(reach) = reach else { break };
        let Some((slave, master)) = pair(row, surfaces, cx) else {
            continue;
        };
        rows.push(TieRow {
            name: match count {
                1 => name.typed.clone(),
                _ => format!("{}-{}", name.typed, number + 1),
            },
            slave,
            master,
            reach,
            members: members.clone(),
            formulation: formulation(card, [slave, master].map(|s| &surfaces.all[s]), cx),
            adjusts,
            span: row.span(),
        });
    }
    names.define(name);
    rows
}

/// Choice of the nodes that a card ties; `None` after a reported error.
fn reach(card: &Card, sets: &Sets, cx: &mut Context) -> Option<TieReach> {
    if let Some(field) = card.value("TIED NSET") {
        if card.has("POSITION TOLERANCE") {
            let span = card.span_of("POSITION TOLERANCE");
            let message = "TIED NSET= names the tied nodes: there is no tolerance";
            cx.error(Code::Tie, span, message)
                .help("leave out one of the two");
            return None;
        }
        return sets.node_names.find(field, cx).map(TieReach::Nodes);
    }
    let Some(field) = card.value("POSITION TOLERANCE") else {
        return Some(TieReach::Near);
    };
    let rule = "the tolerance must not be negative";
    let tolerance = field.real_that(|x| x >= 0.0, rule, Code::BadValue, cx.d)?;
    Some(TieReach::Within(tolerance))
}

/// Formulation of a tie: node to surface if one of the surfaces is made of nodes or the card asks for this formulation,
/// else surface to surface.
fn formulation(card: &Card, both: [&Surface; 2], cx: &mut Context) -> ContactFormulation {
    let typed = card.choice("TYPE");
    let has_nodes = both
        .iter()
        .any(|surface| matches!(surface.kind, SurfaceKind::Nodes(_)));
    match has_nodes {
        true if typed == Some("SURFACE TO SURFACE") => {
            let message = "TYPE=SURFACE TO SURFACE is taken as NODE TO SURFACE";
            cx.d.warning_once(Code::IgnoredParameter, card.span_of("TYPE"), message)
                .help("both surfaces must be made of element faces");
            ContactFormulation::NodeToSegment
        }
        true => ContactFormulation::NodeToSegment,
        _ if typed == Some("NODE TO SURFACE") => ContactFormulation::NodeToSegment,
        _ => ContactFormulation::SurfaceToSurface,
    }
}

/// `slave, master`
fn pair(row: Line, surfaces: &Surfaces, cx: &mut Context) -> Option<(usize, usize)> {
    row.at_most(2, cx.d);
    let slave = row.required(0, "the slave surface", cx.d);
    let slave = slave.and_then(|field| surfaces.find(field, cx));
    let master = row.required(1, "the master surface", cx.d);
    let master = master.and_then(|field| surfaces.find(field, cx));
    let (slave, master): (Found, Found) = (slave?, master?);
    let (message, help, span) = if slave.0 == master.0 {
        (
            format!("surface {} is slave and master at once", slave.1.name),
            "a tie joins two surfaces",
            master.2,
        )
    } else if let SurfaceKind::Rigid(_) = slave.1.kind {
        (
            format!("the rigid surface {} cannot be slave", slave.1.name),
            "a rigid surface is a master: write the other surface first",
            slave.2,
        )
    } else {
        return Some((slave.0, master.0));
    };
    cx.error(Code::SurfaceUse, span, message).help(help);
    None
}

/// The slave nodes of a row, divided into nodes that the row ties and other nodes.
struct Faced {
    /// Slave nodes that are tied, with their nearest segments, in the order of the surface.
    near: Vec<(usize, Segment)>,
    /// Slave nodes that are not tied.
    far: Vec<usize>,
}

impl Faced {
    fn new(row: &TieRow, surfaces: &[Surface], mesh_index: &MeshIndex) -> Self {
        let mesh = &mesh_index.mesh;
        let segments = lines(&surfaces[row.master], mesh);
        let of_master: HashSet<usize> = segments.as_flattened().iter().copied().collect();
        let is_meant = |node: &usize| match row.reach {
            TieReach::Nodes(_) => row.members.binary_search(node).is_ok(),
            TieReach::Near | TieReach::Within(_) => true,
        };
        let nodes = surfaces[row.slave].nodes(mesh).into_iter();
        let nodes = nodes.filter(|node| !of_master.contains(node) && is_meant(node));
        let nearest = Nearest::new(&segments, mesh);
        let (mut near, mut far) = (Vec::new(), Vec::new());
        for node in nodes {
            match nearest.of(node).filter(|found| found.is_within(row.reach)) {
                Some(found) => near.push((node, found.segment)),
                None => far.push(node),
            }
        }
        Faced { near, far }
    }
}

/// The sides of a slave surface that are tied as a whole: all their nodes are tied, by this tie or by an earlier tie,
/// or belong to the master.
fn sides(
    row: &TieRow,
    faced: &Faced,
    surfaces: &[Surface],
    mesh_index: &MeshIndex,
) -> Vec<TiedSide> {
    if row.formulation == ContactFormulation::NodeToSegment {
        return Vec::new();
    }
    let mesh = &mesh_index.mesh;
    let both = [row.slave, row.master].map(|surface| &surfaces[surface]);
    let near = faced.near.iter().map(|(node, _)| *node);
    let tied: HashSet<usize> = near.chain(both[1].nodes(mesh)).collect();
    tied_sides::read(both, mesh, |node| tied.contains(&node))
}

/// The segment nearest to a node.
struct NearestSegment {
    segment: Segment,
    distance: f64,
    length: f64,
}

impl NearestSegment {
    fn is_within(&self, reach: TieReach) -> bool {
        match reach {
            TieReach::Near => self.distance <= NEAR * self.length,
            TieReach::Within(tolerance) => self.distance <= tolerance,
            TieReach::Nodes(_) => true,
        }
    }
}

/// The segments of a surface; in a surface made of nodes each node is a segment without length.
fn lines(surface: &Surface, mesh: &Mesh) -> Vec<Segment> {
    match surface.kind {
        SurfaceKind::Nodes(_) => surface
            .nodes(mesh)
            .into_iter()
            .map(|node| [node; 2])
            .collect(),
        _ => surface.segments(mesh),
    }
}

/// Shortest element side at every node that is a segment without length.
fn shortest_sides(segments: &[Segment], mesh: &Mesh) -> HashMap<usize, f64> {
    let alone = segments.iter().filter(|[a, b]| a == b);
    let mut shortest: HashMap<usize, f64> = alone.map(|[a, _]| (*a, f64::INFINITY)).collect();
    if shortest.is_empty() {
        return shortest;
    }
    for element in &mesh.elements {
        let corners = element.corners();
        let next = corners.iter().cycle().skip(1);
        for (&a, &b) in corners.iter().zip(next) {
            let length = distance(mesh.coordinates[a], mesh.coordinates[b]);
            for node in [a, b] {
                if let Some(known) = shortest.get_mut(&node) {
                    *known = known.min(length);
                }
            }
        }
    }
    shortest
}

/// Segments with a tree that finds the nearest segment.
struct Nearest<'a> {
    segments: &'a [Segment],
    x: &'a [[f64; 2]],
    lines: NearestLines,
    shortest_sides: HashMap<usize, f64>,
}

impl<'a> Nearest<'a> {
    fn new(segments: &'a [Segment], mesh: &'a Mesh) -> Self {
        let x = &mesh.coordinates[..];
        let places = segments.iter().map(|segment| segment.map(|node| x[node]));
        let lines = NearestLines::new(places.collect());
        Nearest {
            segments,
            x,
            lines,
            shortest_sides: shortest_sides(segments, mesh),
        }
    }

    /// The segment nearest to a node; of equally near segments, the first segment.
    fn of(&self, node: usize) -> Option<NearestSegment> {
        let (k, off) = self.lines.of(self.x[node])?;
        let segment = self.segments[k];
        let [a, b] = segment.map(|n| self.x[n]);
        let of_node = self.shortest_sides.get(&segment[0]);
        Some(NearestSegment {
            segment,
            distance: off,
            length: of_node
                .filter(|size| size.is_finite())
                .map_or(distance(a, b), |size| *size),
        })
    }
}

/// Moves the slave nodes of a row onto the master without straining the elements.
fn adjust(row: &TieRow, faced: &Faced, mesh_index: &mut MeshIndex, cx: &mut Context) {
    let mesh = &mut mesh_index.mesh;
    let before = mesh.coordinates.clone();
    let (mut count, mut most) = (0, (0.0, 0));
    for &(node, segment) in &faced.near {
        let (foot, travel) = nearest_of(before[node], segment.map(|node| before[node]));
        if TiedNode::new(node, segment, &before).eta != 0.0 || travel > 0.0 {
            mesh.coordinates[node] = foot;
            count += usize::from(travel > 0.0);
            most = if travel > most.0 {
                (travel, node)
            } else {
                most
            };
        }
    }
    let after = &mesh.coordinates;
    let spoiled = |element: &Element| element.is_spoiled(&before, after);
    if let Some(element) = mesh.elements.iter().position(spoiled) {
        let label = mesh_index.element_name(element);
        let message =
            format!("moving the tied nodes onto the master spoils the shape of element {label}");
        cx.error(Code::Adjusted, row.span, message)
            .help("mend the mesh, tie fewer nodes, or leave them where they are with ADJUST=NO");
    } else if count > 0 {
        let name = mesh_index.node_name(most.1);
        let nodes = if count == 1 { "node" } else { "nodes" };
        let message = format!(
            "{count} {nodes} of the tie {} moved onto the master, node {name} by {:.3e}",
            row.name, most.0
        );
        cx.d.note(Code::Adjusted, row.span, message);
    }
}

/// Reports nodes that are not tied because they are too far from the master or tied already.
fn report(
    row: &TieRow,
    own: &[(usize, Segment)],
    (far, elsewhere): (&[usize], &[usize]),
    mesh_index: &MeshIndex,
    cx: &mut Context,
) {
    if cx.may_lack_cards() {
        return;
    }
    let names = |nodes: &[usize]| {
        let shown = nodes.iter().take(MOST_NAMES);
        let names: Vec<String> = shown.map(|&n| mesh_index.node_name(n)).collect();
        match nodes.len() - names.len() {
            0 => names.join(", "),
            more => format!("{} and {more} more", names.join(", ")),
        }
    };
    let reach = match row.reach {
        TieReach::Near => "0.05 of the segments that they face".to_owned(),
        TieReach::Within(tolerance) => shown(tolerance),
        TieReach::Nodes(_) => String::new(),
    };
    if own.is_empty() && elsewhere.is_empty() {
        let message = format!("the tie {} ties no node", row.name);
        let help = match row.reach {
            TieReach::Nodes(_) => "TIED NSET= names nodes of the slave surface",
            _ => "POSITION TOLERANCE= is the largest distance of tied nodes from the master",
        };
        cx.error(Code::Tie, row.span, message).help(help);
    } else if !far.is_empty() {
        let message = format!(
            "the tie {} leaves out {} farther from the master than {reach}: {}",
            row.name,
            match far.len() {
                1 => "1 slave node".to_owned(),
                count => format!("{count} slave nodes"),
            },
            names(far)
        );
        cx.warning(Code::Tie, row.span, message)
            .help("POSITION TOLERANCE= is the largest distance of tied nodes from the master");
    }
    if !elsewhere.is_empty() {
        let message = format!(
            "slave nodes of the tie {} follow an earlier tie: {}",
            row.name,
            names(elsewhere)
        );
        cx.warning(Code::Tie, row.span, message);
    }
}

/// Nodes of the master that lie at segments of the slave between tied nodes.
fn covered(
    row: &TieRow,
    own: &[(usize, Segment)],
    surfaces: &[Surface],
    mesh_index: &MeshIndex,
) -> Vec<(usize, Segment)> {
    let mesh = &mesh_index.mesh;
    let x = &mesh.coordinates;
    let tied: HashSet<usize> = own.iter().map(|(node, _)| *node).collect();
    let mut segments = surfaces[row.slave].segments(mesh);
    segments.retain(|segment| segment.iter().all(|node| tied.contains(node)));
    let nodes: BTreeSet<usize> = own.iter().flat_map(|(_, segment)| *segment).collect();
    let nearest = Nearest::new(&segments, mesh);
    // tied nodes beside the same place are as far away
    let off = own.iter().map(|(node, segment)| {
        let [a, b] = segment.map(|node| x[node]);
        nearest_of(x[*node], [a, b]).1.max(NEAR * distance(a, b))
    });
    let most = off.fold(0.0, f64::max);
    let found = nodes
        .into_iter()
        .filter_map(|node| Some((node, nearest.of(node)?)));
    let found = found.filter(|(_, found)| found.distance <= most);
    found.map(|(node, found)| (node, found.segment)).collect()
}

impl Ties {
    /// Leaves tied nodes out of the contacts with the segments to which they are tied.
    pub fn leave_out(
        &self,
        contacts: &mut [Contact],
        surfaces: &[Surface],
        mesh_index: &MeshIndex,
    ) {
        if self.bonds.is_empty() {
            return;
        }
        for contact in contacts {
            let segments = surfaces[contact.master].segments(&mesh_index.mesh);
            let segments: HashSet<Segment> = segments.into_iter().collect();
            let bonds = self.bonds.iter();
            let tied = bonds.filter(|(_, segment)| segments.contains(segment));
            contact.left_out.extend(tied.map(|(node, _)| *node));
            contact.left_out.sort_unstable();
            contact.left_out.dedup();
        }
    }
}
