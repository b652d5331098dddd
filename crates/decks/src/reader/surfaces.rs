//! `*SURFACE`, and the profiles of rigid surfaces.

use super::context::Context;
use super::mesh_index::MeshIndex;
use super::names::Names;
use super::outline::Outline;
use super::sets::Sets;
use crate::deck::{Card, Deck, Line, Text};
use crate::diagnostics::{Code, Diagnostic, Diagnostics, Span, closest, shown};
use crate::model::{CircleArc, ElementsAtNodes, Face, Mesh, RigidProfile, Surface, SurfaceKind};
use crate::vectors::{angle, cross, difference};
use std::collections::{BTreeMap, BTreeSet, HashSet};

/// All surfaces.
pub(crate) struct Surfaces {
    /// Names of the surfaces.
    pub names: Names,
    /// Surfaces in the order of their names.
    pub all: Vec<Surface>,
    /// Rigid surfaces and their places.
    pub rigid: Vec<(usize, Span)>,
    /// Rigid surfaces (indices) that are made of rigid lines, with the indices of the lines.
    pub of_lines: Vec<(usize, Vec<usize>)>,
    /// Points of the rigid surfaces, which become nodes behind the nodes of the mesh.
    pub rigid_points: Vec<[f64; 2]>,
}

impl Surfaces {
    /// The surface that a field names.
    pub fn find(&self, field: Text, cx: &mut Context) -> Option<Found<'_>> {
        let index = self.names.find(field, cx)?;
        Some((index, self.all.get(index)?, field.span))
    }
}

/// Reads all surfaces.
pub(crate) fn read(
    outline: &Outline,
    mesh_index: &MeshIndex,
    sets: &Sets,
    at_nodes: &ElementsAtNodes,
    cx: &mut Context,
) -> Surfaces {
    let mut surfaces = Surfaces {
        names: Names::of_parts("surface"),
        all: Vec::new(),
        rigid: Vec::new(),
        of_lines: Vec::new(),
        rigid_points: Vec::new(),
    };
    for card in outline.model_cards("SURFACE") {
        let Some(name) = surfaces.names.new_name(card, cx) else {
            continue;
        };
        let errors = cx.errors();
        let lines = rigid_lines(card, mesh_index, sets, cx);
        let kind = match card.choice("TYPE") {
            Some("ELEMENT") | None if !lines.is_empty() => {
                let first = mesh_index.mesh.node_count() + surfaces.rigid_points.len();
                let profile = Profile::of_lines(&lines, card, mesh_index, cx);
                surfaces.rigid_points.extend(&profile.points);
                let lines = lines.iter().map(|(line, _)| *line).collect();
                surfaces.of_lines.push((surfaces.all.len(), lines));
                SurfaceKind::Rigid(profile.in_mesh(first))
            }
            Some("NODE") => SurfaceKind::Nodes(nodes(card, mesh_index, sets, cx)),
            Some("SEGMENTS") => {
                let first = mesh_index.mesh.node_count() + surfaces.rigid_points.len();
                let profile = Profile::read(card, cx);
                surfaces.rigid_points.extend(&profile.points);
                surfaces.rigid_points.extend(profile.centre());
                SurfaceKind::Rigid(profile.in_mesh(first))
            }
            _ => SurfaceKind::Faces(faces(card, mesh_index, sets, at_nodes, cx)),
        };
        if card.faulty || cx.errors() > errors {
            surfaces.names.spoil(&name);
            continue;
        }
        report_empty(&kind, card, cx);
        let typed = name.typed.clone();
        if let SurfaceKind::Rigid(_) = kind {
            surfaces
                .rigid
                .push((surfaces.all.len(), card.span_of("NAME")));
        }
        surfaces.names.define(name);
        surfaces.all.push(Surface { name: typed, kind });
    }
    surfaces
}

/// Rigid lines that the rows of a card name, with their ends. The rigid body lies on the right of the direction from
/// end to end, which for SPOS runs from the first node to the second. The function reports rows of the card that name
/// other elements.
fn rigid_lines(
    card: &Card,
    mesh_index: &MeshIndex,
    sets: &Sets,
    cx: &mut Context,
) -> Vec<(usize, [usize; 2])> {
    if mesh_index.rigid_lines.is_empty() || matches!(card.choice("TYPE"), Some("NODE" | "SEGMENTS"))
    {
        return Vec::new();
    }
    let mut lines = Vec::new();
    for row in card.rows.iter() {
        let Some(field) = row.get(0) else { continue };
        let own = sets.rigid_lines_of(field, mesh_index, cx);
        let face = row.get(1).map(|face| face.name_key());
        let is_back = match face.as_deref() {
            _ if own.is_empty() && lines.is_empty() => continue,
            Some("SPOS") if !own.is_empty() => false,
            Some("SNEG") if !own.is_empty() => true,
            _ => {
                let message = "this row names no side SPOS or SNEG of rigid lines";
                fault(
                    row.span(),
                    message,
                    "the rows of one surface name rigid lines, or faces of other elements",
                    cx,
                );
                continue;
            }
        };
        lines.extend(own.into_iter().map(|line| {
            let [a, b] = mesh_index.rigid_lines[line].nodes;
            (line, if is_back { [b, a] } else { [a, b] })
        }));
    }
    lines
}

fn report_empty(kind: &SurfaceKind, card: &Card, cx: &mut Context) {
    let empty = match kind {
        SurfaceKind::Faces(faces) => faces.is_empty(),
        SurfaceKind::Nodes(nodes) => nodes.is_empty(),
        SurfaceKind::Rigid(profile) => profile.segments.is_empty(),
    };
    if empty && !card.rows.is_empty() && !cx.d.has_errors() && !cx.deck.incomplete {
        cx.error(
            Code::EmptySurface,
            card.span_of("NAME"),
            "this surface has no members",
        );
    }
}

/// Reads rows `node or node set[, area]`.
fn nodes(card: &Card, mesh_index: &MeshIndex, sets: &Sets, cx: &mut Context) -> Vec<usize> {
    let mut nodes = Vec::new();
    let mut seen = HashSet::new();
    for row in card.rows.iter() {
        row.at_most(2, cx.d);
        let Some(field) = row.required(0, "a node or node set", cx.d) else {
            continue;
        };
        let area = row.real_or(1, 1.0, cx.d);
        if area.is_some_and(|area| area != 1.0) {
            let help = "contact forces of nodes need no area";
            row.without_effect(1, "this area has no effect", help, cx.d);
        }
        let found = sets.nodes_of(field, mesh_index, cx);
        nodes.extend(found.into_iter().filter(|&node| seen.insert(node)));
    }
    nodes
}

/// Reads rows `element or element set[, face]`.
fn faces(
    card: &Card,
    mesh_index: &MeshIndex,
    sets: &Sets,
    at_nodes: &ElementsAtNodes,
    cx: &mut Context,
) -> Vec<Face> {
    let mut faces = Vec::new();
    let mut seen = BTreeSet::new();
    for row in card.rows.iter() {
        row.at_most(2, cx.d);
        let Some(field) = row.required(0, "an element or element set", cx.d) else {
            continue;
        };
        let found = match row.get(1) {
            Some(face) => {
                let elements = sets.elements_of(field, mesh_index, cx);
                named_faces(&elements, face, mesh_index, cx)
            }
            None => unnamed_faces(field, (mesh_index, sets), at_nodes, cx),
        };
        report_interior(&found, at_nodes, row, mesh_index, cx);
        let before = faces.len();
        faces.extend(found.iter().copied().filter(|&face| seen.insert(face)));
        if faces.len() - before < found.len() {
            let message = "faces of this row are in the surface already";
            cx.warning(Code::RepeatedFace, row.span(), message);
        }
    }
    faces
}

/// Faces of elements that a card `*SURFACE` names; faults of the card are reported by another function.
pub(super) fn named_faces_of(
    card: &Card,
    mesh_index: &MeshIndex,
    sets: &Sets,
    at_nodes: &ElementsAtNodes,
    deck: &Deck,
) -> Vec<Face> {
    if matches!(card.choice("TYPE"), Some("NODE" | "SEGMENTS")) {
        return Vec::new();
    }
    let mut unheard = Diagnostics::default();
    let cx = &mut Context::new(deck, &mut unheard);
    faces(card, mesh_index, sets, at_nodes, cx)
}

/// Exterior sides of the elements that a field names, and the faces that its line elements name.
fn unnamed_faces(
    field: Text,
    (mesh_index, sets): (&MeshIndex, &Sets),
    at_nodes: &ElementsAtNodes,
    cx: &mut Context,
) -> Vec<Face> {
    let (elements, lines) = sets.elements_and_lines_of(field, mesh_index, cx);
    let mut faces = exterior_faces(&elements, at_nodes, &mesh_index.mesh);
    faces.retain(|face| !mesh_index.cut_faces.contains(face));
    let known: HashSet<Face> = faces.iter().copied().collect();
    faces.extend(lines.into_iter().filter(|face| !known.contains(face)));
    faces
}

/// Side `face` of each element.
fn named_faces(
    elements: &[usize],
    face: Text,
    mesh_index: &MeshIndex,
    cx: &mut Context,
) -> Vec<Face> {
    let Some(side) = side_number(face, cx) else {
        return Vec::new();
    };
    let mut faces = Vec::new();
    for &element in elements {
        match mesh_index.side(element, side) {
            Some(side) => faces.push(Face { element, side }),
            None => return no_such_face(element, face, mesh_index, cx),
        }
    }
    faces
}

fn no_such_face(element: usize, face: Text, mesh_index: &MeshIndex, cx: &mut Context) -> Vec<Face> {
    let label = mesh_index.element_name(element);
    let sides = side_count(&mesh_index.mesh, element);
    let message = match mesh_index.collapsed.get(&element) {
        Some(short) => format!("face S{} of element {label} has no length", short + 1),
        None => format!(
            "element {label} has faces S1 to S{sides}, not {}",
            face.text
        ),
    };
    cx.error(Code::NoSuchFace, face.span, message);
    Vec::new()
}

/// Names of the sides of an element.
const SIDES: [&str; 4] = ["S1", "S2", "S3", "S4"];

/// Number of the side, from 0, that a face name S1 to S4 means.
fn side_number(face: Text, cx: &mut Context) -> Option<usize> {
    let key = face.name_key();
    let side = SIDES.iter().position(|side| *side == key);
    if side.is_none() {
        let message = format!("unknown face {}", face.text);
        let error = Diagnostic::error(Code::NoSuchFace, face.span, message);
        let meant = closest(&key, SIDES);
        let help = "the faces of plane elements are S1, S2, S3 and S4";
        cx.d.push(error.suggest(meant).help(help));
    }
    side
}

/// Number of sides of an element.
pub(crate) fn side_count(mesh: &Mesh, element: usize) -> usize {
    mesh.elements.get(element).map_or(0, |e| e.side_count())
}

/// Exterior sides of given elements, in order; the list leaves out sides on the axis of bodies of revolution.
fn exterior_faces(elements: &[usize], at_nodes: &ElementsAtNodes, mesh: &Mesh) -> Vec<Face> {
    let sides =
        |&element: &usize| (0..side_count(mesh, element)).map(move |side| Face { element, side });
    let all = elements.iter().flat_map(sides);
    all.filter(|&face| !at_nodes.share(face, mesh) && !mesh.is_on_axis(face))
        .collect()
}

/// Warns about faces between two elements.
fn report_interior(
    faces: &[Face],
    at_nodes: &ElementsAtNodes,
    row: Line,
    mesh_index: &MeshIndex,
    cx: &mut Context,
) {
    let mesh = &mesh_index.mesh;
    let interior = || faces.iter().filter(|&&face| at_nodes.share(face, mesh));
    let Some(first) = interior().next().filter(|_| !cx.d.has_errors()) else {
        return;
    };
    let label = mesh_index.element_name(first.element);
    let side = first.side + 1;
    let message = match interior().count() {
        1 => format!("face S{side} of element {label} lies between two elements"),
        n => {
            format!("{n} of these faces lie between two elements, the first is S{side} of {label}")
        }
    };
    cx.warning(Code::InteriorFace, row.span(), message);
}

/// A surface with its index and the place of its name.
pub(crate) type Found<'a> = (usize, &'a Surface, Span);

/// Largest angle that a chord of an arc subtends.
const CHORD: f64 = std::f64::consts::PI / 180.0;
/// Largest relative difference of the radii of an arc at its two ends; also the smallest difference of the angle of an
/// arc from 180 degrees (rad).
const ARC_ROUND_OFF: f64 = 1e-4;

/// A rigid profile: points and the sides between these points, with the rigid body on the right of each side.
#[derive(Default)]
pub(crate) struct Profile {
    /// Points in the order of the rows.
    pub points: Vec<[f64; 2]>,
    /// Chords [from, to] between the points.
    sides: Vec<[usize; 2]>,
    /// Arcs; each is a range of sides, which are its chords.
    arcs: Vec<CircleArc>,
    /// First point of the chain that is being read.
    start: usize,
    /// Last point so far.
    end: usize,
}

impl Profile {
    /// Reads the rows of a card up to the first row with an error.
    pub fn read(card: &Card, cx: &mut Context) -> Profile {
        let mut profile = Profile::default();
        for row in card.rows.iter() {
            if profile.row(row, cx).is_none() {
                return profile;
            }
        }
        profile.drop_lone_point();
        if profile.sides.is_empty() && !card.rows.is_empty() {
            fault(
                card.span,
                "this rigid surface has no segments",
                "add LINE or CIRCL rows",
                cx,
            );
        }
        profile
    }

    /// The profile of rigid lines that follow each other end to end.
    pub fn of_lines(
        lines: &[(usize, [usize; 2])],
        card: &Card,
        mesh_index: &MeshIndex,
        cx: &mut Context,
    ) -> Profile {
        let mut profile = Profile::default();
        let mut after: BTreeMap<usize, usize> = BTreeMap::new();
        let mut ends = BTreeSet::new();
        for &(_, [from, to]) in lines {
            if after.insert(from, to).is_some() || !ends.insert(to) {
                let name = mesh_index.node_name(from);
                let message =
                    format!("rigid lines of this surface meet at node {name} from unlike sides");
                let help = "the lines of a surface run one after the other, all with their numbers in one direction";
                fault(card.span, &message, help, cx);
                return profile;
            }
        }
        let x = &mesh_index.mesh.coordinates;
        while let Some((&first, _)) =
            (after.iter().find(|(from, _)| !ends.contains(from))).or(after.iter().next())
        {
            profile.start(x[first]);
            let mut from = first;
            while let Some(to) = after.remove(&from) {
                profile.side_to(x[to]);
                from = to;
            }
        }
        profile
    }

    /// The profile as segments between nodes, with node number `first` for its first point. Bodies lie on the left of
    /// segments, so the segments run from the last row to the first.
    pub fn in_mesh(self, first: usize) -> RigidProfile {
        let centre = self.centre().map(|_| first + self.points.len());
        let (sides, count) = (self.sides.iter().rev(), self.sides.len());
        let arcs = self.arcs.into_iter().rev().map(|arc| CircleArc {
            segments: count - arc.segments.end..count - arc.segments.start,
            ..arc
        });
        RigidProfile {
            centre,
            segments: sides.map(|[from, to]| [first + to, first + from]).collect(),
            arcs: arcs.collect(),
        }
    }

    /// The centre, if the profile is the outline of a disc: a closed chain of arcs about one centre with one radius,
    /// with the body inside, on the right of the sides.
    pub fn centre(&self) -> Option<[f64; 2]> {
        let first = self.arcs.first()?;
        let chords: usize = self.arcs.iter().map(|arc| arc.segments.len()).sum();
        let mut following = self.sides.iter().cycle().skip(1);
        let is_chain =
            (self.sides.iter()).all(|[_, to]| following.next().map(|side| side[0]) == Some(*to));
        let arm = |point: usize| difference(first.centre, self.points[point]);
        let is_inside = (self.sides.iter()).all(|&[from, to]| cross(arm(from), arm(to)) < 0.0);
        let is_round = chords == self.sides.len() && is_chain && is_inside;
        (is_round && self.arcs.iter().all(|arc| arc.is_of_circle(first))).then_some(first.centre)
    }

    fn row(&mut self, row: Line, cx: &mut Context) -> Option<()> {
        let word = row.required(0, "START, LINE or CIRCL", cx.d)?;
        let kind = word.name_key();
        match kind.as_str() {
            "START" => self.start(point(row, 1, 3, cx)?),
            "LINE" | "CIRCL" if self.points.is_empty() => {
                let help = "begin with START, x, y";
                return fault(word.span, "the profile has no starting point", help, cx);
            }
            "LINE" => {
                let to = point(row, 1, 3, cx)?;
                if self.points.get(self.end) == Some(&to) {
                    return fault(row.span(), "this line has no length", "leave it out", cx);
                }
                self.side_to(to);
            }
            "CIRCL" => {
                let (to, centre) = (point(row, 1, 5, cx)?, point(row, 3, 5, cx)?);
                self.arc(to, centre, row, cx)?;
            }
            "PARAB" => {
                let help = "give it with LINE or CIRCL";
                return fault(word.span, "parabolas are not supported", help, cx);
            }
            _ => {
                let message = format!("expected START, LINE or CIRCL, found `{}`", word.text);
                return fault(
                    word.span,
                    &message,
                    "a profile is START, x, y; LINE, x, y; CIRCL, x, y, xc, yc",
                    cx,
                );
            }
        }
        Some(())
    }

    fn start(&mut self, at: [f64; 2]) {
        self.drop_lone_point();
        self.start = self.points.len();
        self.end = self.start;
        self.points.push(at);
    }

    /// Drops the last point if no side begins or ends at this point, for example after a START without a LINE or CIRCL.
    fn drop_lone_point(&mut self) {
        let is_last = |end: &usize| end + 1 == self.points.len();
        if !self.sides.iter().rev().take(1).flatten().any(is_last) {
            self.points.pop();
        }
    }

    /// Adds a chord to a point, which is a new point or the first point of the chain.
    fn side_to(&mut self, to: [f64; 2]) {
        let closes = self.points.get(self.start) == Some(&to);
        let next = if closes {
            self.start
        } else {
            self.points.len()
        };
        if !closes {
            self.points.push(to);
        }
        self.sides.push([self.end, next]);
        self.end = next;
    }

    /// Adds equal chords of at most [`CHORD`] on the shorter arc about a centre.
    fn arc(&mut self, to: [f64; 2], centre: [f64; 2], row: Line, cx: &mut Context) -> Option<()> {
        let from = *self.points.get(self.end)?;
        let [p, q] = [from, to].map(|x| difference(centre, x));
        let [r, s] = [p, q].map(|[x, y]| x.hypot(y));
        let angle = angle(p, q);
        let help = "an arc of less than 180 degrees from the point before to x, y about xc, yc";
        if (r - s).abs() > ARC_ROUND_OFF * r.max(s) {
            let message = format!(
                "the ends of this arc are {} and {} away from its centre",
                shown(r),
                shown(s)
            );
            return fault(row.span(), &message, help, cx);
        }
        if angle == 0.0 || angle.abs() > std::f64::consts::PI - ARC_ROUND_OFF {
            let message = format!("this arc has {} degrees", shown(angle.abs().to_degrees()));
            return fault(row.span(), &message, help, cx);
        }
        // round-off must not add a chord to angles such as 90 degrees
        let count = (angle.abs() / CHORD * (1.0 - 1e-9)).ceil();
        let first = self.sides.len();
        for k in 1..count as usize {
            let part = k as f64 / count;
            let (sin, cos) = (part * angle).sin_cos();
            let scale = 1.0 + part * (s / r - 1.0);
            self.side_to([
                centre[0] + scale * (cos * p[0] - sin * p[1]),
                centre[1] + scale * (sin * p[0] + cos * p[1]),
            ]);
        }
        self.side_to(to);
        self.arcs.push(CircleArc {
            segments: first..self.sides.len(),
            centre,
            radius: f64::midpoint(r, s),
        });
        Some(())
    }
}

/// Reads the point in the fields `index` and `index + 1` of a row with at most `count` fields, and places the point
/// with the instance of the row.
fn point(row: Line, index: usize, count: usize, cx: &mut Context) -> Option<[f64; 2]> {
    if index == 1 {
        row.at_most(count, cx.d);
    }
    let x = row.real(index, "a coordinate", cx.d);
    let y = row.real(index + 1, "a coordinate", cx.d);
    Some(cx.placed([x?, y?], row))
}

fn fault(span: Span, message: &str, help: &str, cx: &mut Context) -> Option<()> {
    cx.error(Code::RigidSurface, span, message).help(help);
    None
}
