//! `*NODE` and `*ELEMENT`.
//!
//! A line element, such as mesh generators write for boundary curves, names the side of a plane element with the same
//! nodes. A line element has no stiffness and no section.

use super::collapsed::Collapsed;
use super::context::Context;
use super::label::{LabelList, LabelMap};
use super::mesh_index;
use super::mesh_index::{
    ConnectorElement, ConnectorKind, Group, MeshIndex, PointElement, PointKind, RigidLine,
};
use super::names::Labelled;
use super::outline::Outline;
use crate::deck::{Card, Line, Text};
use crate::diagnostics::{Code, Span, closest};
use crate::model::{Element, ElementType, Face, Mesh, NO_SECTION, Nodes, Plane};
use crate::vectors::extents;
use smallvec::SmallVec;
use std::collections::{BTreeSet, HashMap};

/// Reads nodes and elements; leaves out nodes that belong to no element, spring, rigid surface or equation.
pub(crate) fn read<'a>(outline: &Outline<'a>, cx: &mut Context<'a>) -> MeshIndex {
    let errors = cx.errors();
    let mut reading = MeshReading::default();
    let MeshIndex {
        nodes, elements, ..
    } = &mut reading.mesh_index;
    nodes.incomplete = outline.blocks("NODE").next().is_none();
    elements.incomplete = outline.blocks("ELEMENT").next().is_none();
    for card in outline.model_cards("NODE") {
        reading.node_card(card, cx);
    }
    for card in outline.model_cards("ELEMENT") {
        reading.element_card(card, cx);
    }
    if cx.errors() == errors && !cx.may_lack_cards() {
        reading.report_empty(outline, cx);
    }
    reading.report_not_planar(outline, cx);
    let groups = reading.mesh_index.node_groups.iter();
    let groups: Vec<_> = groups
        .map(|group| (group.name.key.as_str(), &group.labels))
        .collect();
    let references = labels_needed(outline, &groups, cx);
    reading.finish(&references, outline, cx)
}

#[derive(Default)]
struct MeshReading {
    /// The mesh so far, with all nodes and without line elements.
    mesh_index: MeshIndex,
    /// Third coordinates (length) of the nodes up to the last one off the plane z = 0.
    heights: Vec<f64>,
    /// Numbers of the lines that define the nodes.
    node_lines: Vec<u32>,
    /// Number of the last line that defines a line element, or defines a plane element again.
    other_lines: LabelMap<u32>,
    lines: Vec<LineElement>,
    points: Vec<(PointKind, LineElement)>,
}

impl MeshReading {
    fn node_card(&mut self, card: &Card, cx: &mut Context) {
        let count = card.rows.line_count();
        let mut labels = LabelList::default();
        self.mesh_index.reserve_nodes(count);
        self.node_lines.reserve(count);
        for row in card.rows.iter() {
            cx.go_on();
            match self.plain_node(row, cx).or_else(|| self.node(row, cx)) {
                Some(label) => labels.push(label),
                None => self.mesh_index.nodes.incomplete = true,
            }
        }
        let group = Group::named_by(card, "NSET", labels, cx);
        self.mesh_index.node_groups.extend(group);
    }

    /// Adds the new node of a row of plain numbers; returns its number.
    fn plain_node(&mut self, row: Line, cx: &Context) -> Option<u64> {
        let (number, [x, y, z]) = row.plain_point()?;
        let nodes = &self.mesh_index.nodes;
        let label = nodes.plain_label(number, row.instance)?;
        if nodes.get(label).is_some() {
            return None;
        }
        self.add_node(label, cx.placed([x, y], row), z, row);
        Some(label)
    }

    /// Reads the node of a row in any form; returns its number.
    fn node(&mut self, row: Line, cx: &mut Context) -> Option<u64> {
        let fields: SmallVec<[Text; 4]> = row.fields().collect();
        // a normal of shells may follow an empty z; after a z, a fifth field is a decimal comma
        let has_empty_z = fields.get(3).is_some_and(|z| z.is_empty());
        row.at_most(if has_empty_z { 7 } else { 4 }, cx.d);
        if has_empty_z {
            let help = "the normals of plane bodies are those of their faces";
            row.without_effect(4, "this normal has no effect", help, cx.d);
        }
        let number = row.required(0, "the node number", cx.d)?;
        let label = self.mesh_index.nodes.label(number, cx)?;
        let known = self.mesh_index.nodes.get(label);
        let at = [1, 2, 3].map(|i| match fields.get(i) {
            Some(field) if !field.is_empty() => field.real(cx.d),
            _ => Some(0.0),
        });
        let [Some(x), Some(y), Some(z)] = at else {
            if known.is_none() {
                self.mesh_index.nodes.insert(label, Labelled::LEFT_OUT);
            }
            return Some(label);
        };
        let at = cx.placed([x, y], row);
        let Some(known) = known else {
            self.add_node(label, at, z, row);
            return Some(label);
        };
        let mesh = &self.mesh_index.mesh;
        let differs = |&i: &usize| mesh.coordinates[i] != at || self.height(i) != z;
        if let Some(first) = known.index().filter(differs) {
            let (name, line) = (cx.named(label), self.node_lines[first]);
            let message = format!("node {name} has other coordinates on line {line}");
            cx.error(Code::RepeatedNode, row.span(), message);
        }
        Some(label)
    }

    fn add_node(&mut self, label: u64, at: [f64; 2], height: f64, row: Line) {
        self.node_lines.push(row.number);
        let MeshIndex { mesh, nodes, .. } = &mut self.mesh_index;
        let index = mesh.node_count();
        nodes.insert(label, Labelled::new(index));
        mesh.node_labels.push(label);
        mesh.coordinates.push(at);
        if height != 0.0 {
            self.heights.resize(index, 0.0);
            self.heights.push(height);
        }
    }

    fn height(&self, node: usize) -> f64 {
        self.heights.get(node).copied().unwrap_or(0.0)
    }

    fn element_card(&mut self, card: &Card, cx: &mut Context) {
        let kind = card
            .required("TYPE", cx.d)
            .and_then(|name| element_kind(name, cx));
        let mut labels = LabelList::default();
        if let Some(kind) = kind {
            self.mesh_index.reserve_elements(card.rows.line_count());
            let mut rows = card.rows.iter();
            while let Some(row) = rows.next() {
                cx.go_on();
                let label = self.plain_element(row, kind).or_else(|| {
                    let fields = element_fields(row, &mut rows, kind.nodes() + 1);
                    self.element(row.span(), &fields, kind, cx)
                });
                match label {
                    Some(label) => labels.push(label),
                    None => self.mesh_index.elements.incomplete = true,
                }
            }
        } else {
            self.mesh_index.elements.incomplete = true;
        }
        let group = Group::named_by(card, "ELSET", labels, cx);
        self.mesh_index.element_groups.extend(group);
    }

    /// Adds the new element of a row of plain numbers, whose nodes exist and differ; returns its
    /// number.
    fn plain_element(&mut self, row: Line, kind: ElementKind) -> Option<u64> {
        let numbers = row.plain_integers()?;
        let (&number, corners) = numbers.split_first()?;
        let MeshIndex {
            nodes, elements, ..
        } = &self.mesh_index;
        let label = elements.plain_label(number, row.instance)?;
        let mut indices = Nodes::new();
        for &node in corners {
            let node = nodes.plain_label(node, row.instance)?;
            let index = nodes.get(node)?.index();
            indices.push(index.filter(|index| !indices.contains(index))?);
        }
        if indices.len() != kind.nodes() || self.line_of(label).is_some() {
            return None;
        }
        self.add_element(label, indices, kind, row.span());
        Some(label)
    }

    /// Reads one element at the place `span`; returns its number.
    fn element(
        &mut self,
        span: Span,
        fields: &[Text],
        kind: ElementKind,
        cx: &mut Context,
    ) -> Option<u64> {
        let corners = kind.nodes();
        let (first, rest) = fields.split_first()?;
        let label = self.mesh_index.elements.label(*first, cx)?;
        if rest.len() < corners && rest.iter().all(|field| field.integer(cx.d).is_some()) {
            let (name, found) = (cx.named(label), rest.len());
            let message = format!("element {name} needs {corners} nodes, found {found}");
            cx.error(Code::MissingField, span, message);
            return None;
        }
        if let Some(extra) = rest.get(corners) {
            let name = cx.named(label);
            let message = format!("element {name} has {corners} nodes, this is one more");
            cx.error(Code::ExtraField, extra.span, message);
        }
        let fields = rest.get(..corners)?;
        let collapsed = self.collapsed(kind, fields, cx);
        if let Some((triangle, of_triangle)) = collapsed {
            let nodes = self.element_nodes(label, &of_triangle, cx)?;
            let message = format!(
                "quadrilaterals with two corners at one node are triangles: {} is read as {}",
                kind.name(),
                triangle.element_type.name()
            );
            cx.d.note_once(Code::BadShape, span, message)
                .help("sides keep the numbers that they have in the quadrilateral");
            if self.is_new(label, (first, span), cx) {
                let index = self.mesh_index.mesh.elements.len();
                self.mesh_index.collapsed.insert(index, triangle.side);
                self.add_element(
                    label,
                    nodes,
                    ElementKind::Plane(triangle.element_type),
                    span,
                );
            }
            return Some(label);
        }
        let nodes = self.element_nodes(label, fields, cx)?;
        if self.is_new(label, (first, span), cx) {
            self.add_element(label, nodes, kind, span);
        }
        Some(label)
    }

    /// Whether no element has the given label yet; a second element with the label is reported.
    fn is_new(&mut self, label: u64, (first, span): (&Text, Span), cx: &mut Context) -> bool {
        let Some(line) = self.line_of(label) else {
            return true;
        };
        self.other_lines.insert(label, span.line);
        let name = cx.named(label);
        let message = format!("element {name} is defined on line {line} too");
        cx.error(Code::RepeatedElement, first.span, message);
        false
    }

    /// The triangle that a quadrilateral with a side of no length becomes, with the fields of its nodes.
    fn collapsed<'t>(
        &self,
        kind: ElementKind,
        fields: &[Text<'t>],
        cx: &Context,
    ) -> Option<(Collapsed, SmallVec<[Text<'t>; 6]>)> {
        let ElementKind::Plane(element_type) = kind else {
            return None;
        };
        let labels: Option<SmallVec<[u64; 8]>> =
            fields.iter().map(|field| cx.as_label(*field)).collect();
        let triangle = Collapsed::new(element_type, &labels?)?;
        let nodes = triangle.nodes.iter().map(|&k| fields[k]).collect();
        Some((triangle, nodes))
    }

    /// Number of the last line that defines an element.
    fn line_of(&self, element: u64) -> Option<u32> {
        self.other_lines.get(element).copied().or_else(|| {
            let index = self.mesh_index.elements.get(element)?.index()?;
            Some(self.mesh_index.places[index].line)
        })
    }

    fn add_element(&mut self, label: u64, nodes: Nodes, kind: ElementKind, span: Span) {
        let MeshIndex {
            mesh,
            elements,
            places,
            ..
        } = &mut self.mesh_index;
        match kind {
            ElementKind::Plane(element_type) => {
                elements.insert(label, Labelled::new(mesh.elements.len()));
                places.push(span);
                mesh.elements.push(Element {
                    label,
                    element_type,
                    nodes,
                    section: NO_SECTION,
                });
            }
            ElementKind::Line(_) => {
                self.other_lines.insert(label, span.line);
                self.lines.push(LineElement { label, nodes, span });
            }
            ElementKind::PointElement(kind) => {
                self.other_lines.insert(label, span.line);
                self.points.push((kind, LineElement { label, nodes, span }));
            }
            ElementKind::RigidLine => {
                self.other_lines.insert(label, span.line);
                let [from, to] = [nodes[0], nodes[1]];
                let line = RigidLine {
                    label,
                    nodes: [from, to],
                    span,
                };
                self.mesh_index.rigid_lines.push(line);
            }
            ElementKind::Connector(kind) => {
                self.other_lines.insert(label, span.line);
                self.mesh_index.connectors.push(ConnectorElement {
                    label,
                    kind,
                    nodes: nodes.to_vec(),
                    span,
                });
            }
        }
    }

    /// Indices of an element's nodes, which must exist and differ.
    fn element_nodes(&self, element: u64, fields: &[Text], cx: &mut Context) -> Option<Nodes> {
        let mut labels: SmallVec<[u64; 4]> = SmallVec::new();
        let mut nodes = Nodes::new();
        for field in fields {
            let Some(node) = self.mesh_index.nodes.label(*field, cx) else {
                continue;
            };
            let differs = !labels.contains(&node);
            if !differs {
                let [element, node] = [element, node].map(|label| cx.named(label));
                let message = format!("element {element} has node {node} twice");
                cx.error(Code::BadShape, field.span, message);
            }
            match self.mesh_index.nodes.get(node) {
                Some(known) => nodes.extend(known.index().filter(|_| differs)),
                None => self.undefined_node(node, field.span, cx),
            }
            labels.push(node);
        }
        (nodes.len() == fields.len()).then_some(nodes)
    }

    fn undefined_node(&self, node: u64, span: Span, cx: &mut Context) {
        if !self.mesh_index.nodes.incomplete && !cx.deck.incomplete {
            let message = format!("node {} is not defined", cx.named(node));
            cx.error(Code::UndefinedNode, span, message);
        }
    }

    /// Reports a mesh without nodes or elements. The message stands at the card of nodes or elements; without such a
    /// card it stands at the last nodes or at the first keyword of the deck.
    fn report_empty(&self, outline: &Outline, cx: &mut Context) {
        let mesh = &self.mesh_index.mesh;
        // rigid bodies of mass elements need no others
        let has_others = !self.points.is_empty() || !self.mesh_index.rigid_lines.is_empty();
        let has_none = mesh.elements.is_empty() && !has_others;
        let (keyword, before) = match (mesh.node_count() == 0, has_none) {
            (true, _) => ("NODE", None),
            (false, true) => ("ELEMENT", outline.model_cards("NODE").pop()),
            (false, false) => return,
        };
        let cards = outline.model_cards(keyword);
        let is_left_out = |card: &&Card| card.faulty && card.rows.first().is_none();
        let said = cards.iter().any(is_left_out);
        let first = cards.first().copied().or(before);
        if let Some(card) = first.or(cx.deck.cards.first()).filter(|_| !said) {
            let (message, help) = match self.lines.is_empty() || keyword == "NODE" {
                true => (
                    format!("the deck has no {}s", keyword.to_lowercase()),
                    format!("give them with *{keyword}"),
                ),
                false => (
                    "the deck has line elements only".to_owned(),
                    NO_TRUSSES.to_owned(),
                ),
            };
            cx.error(Code::EmptyMesh, card.span, message).help(help);
        }
    }

    /// Reports nodes whose z differ by more than 1e-9 of the size of the model.
    fn report_not_planar(&self, outline: &Outline, cx: &mut Context) {
        if self.heights.is_empty() {
            return;
        }
        let mesh = &self.mesh_index.mesh;
        let [low, high] = extents(mesh.coordinates.iter().copied());
        let size = (high[0] - low[0]).max(high[1] - low[1]);
        let heights = (0..mesh.node_count()).map(|node| [self.height(node); 2]);
        let [[low, _], [high, _]] = extents(heights);
        if high - low > 1e-9 * size {
            let is_off = |&node: &usize| self.height(node) != self.height(0);
            let off = (0..mesh.node_count()).find(is_off).unwrap_or(0);
            let message = format!("the mesh is not plane: z runs from {low} to {high}");
            if let Some(row) = row_of(mesh.node_labels[off], outline, cx) {
                cx.error(Code::NotPlanar, row.span(), message);
            }
        }
    }

    /// The mesh without unused nodes and with line elements; the nodes in `references` count as used.
    fn finish(self, references: &BTreeSet<u64>, outline: &Outline, cx: &mut Context) -> MeshIndex {
        let MeshIndex { mesh, nodes, .. } = &self.mesh_index;
        let mut used = vec![false; mesh.node_count()];
        for &node in mesh.elements.iter().flat_map(|element| &element.nodes) {
            used[node] = true;
        }
        let connectors = self.mesh_index.connectors.iter();
        for &node in connectors.flat_map(|connector| &connector.nodes) {
            used[node] = true;
        }
        for line in &self.mesh_index.rigid_lines {
            line.nodes.iter().for_each(|&node| used[node] = true);
        }
        let index = |label: &u64| nodes.get(*label).and_then(Labelled::index);
        for node in references.iter().filter_map(index) {
            used[node] = true;
        }
        for &node in self.points.iter().flat_map(|(_, point)| &point.nodes) {
            used[node] = true;
        }
        if used.contains(&false) {
            self.report_unused(&used, outline, cx);
        }
        let mut mesh_index = self.mesh_index;
        add_lines(&self.lines, &used, &mut mesh_index, cx);
        for (kind, point) in self.points {
            let number = mesh_index.mesh.elements.len() + mesh_index.lines.len();
            let labelled = Labelled::new(number + mesh_index.points.len());
            mesh_index.elements.insert(point.label, labelled);
            mesh_index
                .points
                .extend(point.nodes.first().map(|&node| PointElement {
                    kind,
                    node,
                    span: point.span,
                }));
        }
        mesh_index.number_connectors();
        if used.contains(&false) {
            mesh_index.keep_nodes(&used);
        }
        let (mesh, connectors) = (&mut mesh_index.mesh, &mesh_index.connectors);
        mesh_index.instances = mesh_index::number_instances(mesh, connectors, cx);
        mesh_index
    }

    /// Warns about nodes that belong to no element.
    fn report_unused(&self, used: &[bool], outline: &Outline, cx: &mut Context) {
        let MeshIndex { mesh, elements, .. } = &self.mesh_index;
        if elements.incomplete || mesh.elements.is_empty() || cx.deck.incomplete {
            return;
        }
        let labels = mesh.node_labels.iter().zip(used);
        let mut unused = labels.filter(|(_, used)| !**used).map(|(label, _)| *label);
        let Some(first) = unused.next() else { return };
        let name = cx.named(first);
        let message = match 1 + unused.count() {
            1 => format!("node {name} belongs to no element"),
            n => format!("{n} nodes belong to no element, the first is node {name}"),
        };
        if let Some(row) = row_of(first, outline, cx) {
            cx.warning(Code::UnusedNode, row.span(), message)
                .help("left out, together with what the deck says about them");
        }
    }
}

/// The row that defines a node, searched for a message.
fn row_of<'a>(label: u64, outline: &Outline<'a>, cx: &Context) -> Option<Line<'a>> {
    let cards = outline.model_cards("NODE").into_iter();
    let mut rows = cards.flat_map(|card| card.rows.iter());
    rows.find(|row| row.get(0).and_then(|field| cx.as_label(field)) == Some(label))
}

/// Fields of the element that starts in row `first`: rows are added until there are `count` fields, or the next row
/// would give too many fields.
fn element_fields<'a>(
    first: Line<'a>,
    rest: &mut (impl Iterator<Item = Line<'a>> + Clone),
    count: usize,
) -> SmallVec<[Text<'a>; 5]> {
    let mut fields: SmallVec<[Text; 5]> = first.fields().collect();
    while fields.len() < count {
        let (missing, mut after) = (count - fields.len(), rest.clone());
        match after.next() {
            Some(row) if row.fields().count() <= missing => fields.extend(row.fields()),
            _ => break,
        }
        *rest = after;
    }
    fields
}

/// Kind of an element of the deck.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ElementKind {
    /// A plane element.
    Plane(ElementType),
    /// A line element of two nodes, which name a side of a plane element, or of three nodes, the third of which is in
    /// the middle of the side.
    Line(usize),
    /// A node with mass or inertia.
    PointElement(PointKind),
    /// A spring or dashpot.
    Connector(ConnectorKind),
    /// A rigid line of two nodes.
    RigidLine,
}

impl ElementKind {
    /// Name of the type of a plane element; empty for other kinds.
    fn name(self) -> &'static str {
        match self {
            ElementKind::Plane(element_type) => element_type.name(),
            _ => "",
        }
    }

    /// Number of nodes of an element of the kind.
    pub fn nodes(self) -> usize {
        match self {
            ElementKind::Plane(element_type) => element_type.topology().nodes,
            ElementKind::Line(nodes) => nodes,
            ElementKind::PointElement(_) => 1,
            ElementKind::Connector(kind) => kind.nodes(),
            ElementKind::RigidLine => 2,
        }
    }
}

/// The kind of elements with a given type name.
pub(super) fn element_kind(name: Text, cx: &mut Context) -> Option<ElementKind> {
    let folded = name.name_key();
    match folded.as_str() {
        "T2D2" | "T3D2" | "B21" | "B31" => return Some(ElementKind::Line(2)),
        "T2D3" | "T3D3" | "B22" | "B32" => return Some(ElementKind::Line(3)),
        "MASS" => return Some(ElementKind::PointElement(PointKind::Mass)),
        "R2D2" | "RAX2" => return Some(ElementKind::RigidLine),
        "ROTARYI" => return Some(ElementKind::PointElement(PointKind::RotaryInertia)),
        _ => {}
    }
    if let Some(kind) = ConnectorKind::from_name(&folded) {
        return Some(ElementKind::Connector(kind));
    }
    let known = ElementType::from_name(&folded);
    if known.is_none() {
        report_unusable(name, &folded, cx);
    }
    known.map(ElementKind::Plane)
}

/// Reports a type that cannot be used.
fn report_unusable(name: Text, folded: &str, cx: &mut Context) {
    let message = format!("element type {} cannot be used", name.text);
    let error = cx.error(Code::ElementType, name.span, message);
    let meant = closest(folded, ElementType::NAMED.map(ElementType::name));
    match reason(folded) {
        Some(reason) => error.help(reason),
        None => error
            .suggest(meant)
            .help("use CPS3, CPE3, CPS4, CPE4, CPS4I, CPE4I, CPS4R, CPE4R, CPE4H, CPS6, CPE6, CPS8, CPE8, CPS8R, CPE8R, CPE8H or CPE8RH, or \
                 CAX3, CAX4, CAX4H, CAX4I, CAX4R, CAX6, CAX8, CAX8R, CAX8H or CAX8RH around the axis x = 0"),
    };
}

/// Reason why a type of elements of other codes cannot be used.
fn reason(folded: &str) -> Option<&'static str> {
    let starts = |prefixes: &[&str]| prefixes.iter().any(|prefix| folded.starts_with(prefix));
    if starts(&["CPE4", "CPS4", "CPE3", "CPS3"]) && folded.len() > 4 {
        Some(
            "write CPE3, CPS3, CPE4, CPE4I, CPE4R, CPE4H, CPS4, CPS4I or CPS4R: other formulations are not supported",
        )
    } else if starts(&["CPE6", "CPS6", "CPE8", "CPS8"]) && folded.len() > 4 {
        Some(
            "write CPE6, CPS6, CPE8, CPS8, CPE8R, CPS8R, CPE8H or CPE8RH: other formulations are not supported",
        )
    } else if starts(&["CAX"]) {
        Some(
            "write CAX3, CAX4, CAX4H, CAX4I, CAX4R, CAX6, CAX8, CAX8R, CAX8H or CAX8RH: other formulations are not supported",
        )
    } else if starts(&["T2D", "T3D", "B2", "B3"]) {
        Some(
            "line elements only name sides of plane elements: use T3D2 with two nodes, T3D3 with three",
        )
    } else if starts(&["C3D", "S3", "S4", "S6", "S8", "M3D", "R3D"]) {
        Some("the program is two-dimensional: use CPS, CPE and CAX elements")
    } else {
        None
    }
}

/// A line element in the form of the deck.
pub(super) struct LineElement {
    pub label: u64,
    pub nodes: Nodes,
    pub span: Span,
}

/// Numbers the line elements after the plane elements; line elements that are no sides of plane elements are left out.
/// `used` says for each node whether the mesh keeps it.
pub(super) fn add_lines(
    lines: &[LineElement],
    used: &[bool],
    mesh_index: &mut MeshIndex,
    cx: &mut Context,
) {
    if lines.is_empty() {
        return;
    }
    let faces = faces_by_nodes(&mesh_index.mesh);
    let mut strays = Vec::new();
    for line in lines {
        let mut nodes = line.nodes.clone();
        nodes.retain(|node| used[*node]);
        nodes.sort_unstable();
        let labelled = match faces.get(&nodes) {
            Some(&face) => {
                mesh_index.lines.push(face);
                Labelled::new(mesh_index.mesh.elements.len() + mesh_index.lines.len() - 1)
            }
            None => {
                strays.push(line);
                Labelled::LEFT_OUT
            }
        };
        mesh_index.elements.insert(line.label, labelled);
    }
    if !cx.d.has_errors() {
        report_strays(&strays, cx);
        report_plane_stress(mesh_index, cx);
    }
}

/// The face of every side by the nodes of the side, in increasing order; the face of a side between two elements
/// belongs to the first element.
fn faces_by_nodes(mesh: &Mesh) -> HashMap<Nodes, Face> {
    let mut faces = HashMap::new();
    for (element, e) in mesh.elements.iter().enumerate() {
        for side in 0..e.side_count() {
            let mut nodes = Nodes::from_slice(e.side(side).nodes());
            nodes.sort_unstable();
            faces.entry(nodes).or_insert(Face { element, side });
        }
    }
    faces
}

/// Help for line elements that are no sides of plane elements.
const NO_TRUSSES: &str = "line elements only name sides of plane elements: trusses and beams cannot be used, and other \
                          lines of a mesh generator can go";

fn report_strays(strays: &[&LineElement], cx: &mut Context) {
    let Some(first) = strays.first() else { return };
    let label = cx.named(first.label);
    let message = match strays.len() {
        1 => format!("line element {label} is no side of a plane element"),
        n => format!("{n} line elements are no sides of plane elements, the first is {label}"),
    };
    cx.error(Code::LineElement, first.span, message)
        .help(NO_TRUSSES);
}

/// Notes that a mesh generator's triangles and quadrilaterals are in plane stress.
fn report_plane_stress(mesh_index: &MeshIndex, cx: &mut Context) {
    let mut elements = mesh_index.mesh.elements.iter();
    let found = elements.position(|element| element.element_type.plane == Plane::Stress);
    if let Some(index) = found {
        let name = mesh_index.mesh.elements[index].element_type.name();
        let span = mesh_index.places[index];
        let message = format!("{name} elements are in plane stress");
        cx.d.note(Code::LineElement, span, message).help(
            "mesh generators write CPS3 and CPS4 for every mesh: write CPE3 and CPE4 for plane strain",
        );
    }
}

/// Labels that may belong to nodes of rigid bodies or of equations; `groups` holds, by key, the node sets of `*NODE`
/// with the labels of their members.
pub(super) fn labels_needed(
    outline: &Outline,
    groups: &[(&str, &LabelList)],
    cx: &Context,
) -> BTreeSet<u64> {
    let (mut labels, mut names) = (BTreeSet::new(), BTreeSet::new());
    for field in fields(outline) {
        match cx.is_number(field) {
            true => labels.extend(cx.as_label(field)),
            false => names.extend(cx.keys_of(field)),
        }
    }
    for (_, members) in groups.iter().filter(|(name, _)| names.contains(*name)) {
        labels.extend(members.iter());
    }
    let is_meant = |set: &&Card| {
        let name = set.value("NSET");
        name.is_some_and(|name| names.contains(&cx.key_of(name)))
    };
    for set in outline.model_cards("NSET").into_iter().filter(is_meant) {
        let count = if set.has("GENERATE") { 2 } else { usize::MAX };
        let numbers = set.rows.iter().flat_map(|row| row.fields().take(count));
        labels.extend(numbers.filter_map(|field| cx.as_label(field)));
    }
    labels
}

/// Fields that name a reference node or the nodes of a rigid body, or a node or node set of an equation.
fn fields<'a>(outline: &Outline<'a>) -> Vec<Text<'a>> {
    let bodies = outline.model_cards("RIGID BODY").into_iter();
    let equations = outline.model_cards("EQUATION").into_iter();
    // a line of one field is the number of terms
    let rows = equations.flat_map(|card| card.rows.iter());
    let terms = rows.filter(|row| row.get(1).is_some());
    let names = ["REF NODE", "NSET", "PIN NSET", "TIE NSET"];
    let sections = outline.model_cards("PRE-TENSION SECTION").into_iter();
    let tightened = sections.filter_map(|card| card.value("NODE"));
    let kinematic = outline.model_cards("KINEMATIC COUPLING").into_iter();
    let couplings = outline.model_cards("COUPLING").into_iter();
    let coupled = kinematic.clone().flat_map(|card| card.rows.iter());
    let coupled = coupled.filter_map(|row| row.get(0));
    let mpc = outline.model_cards("MPC").into_iter();
    let joined = mpc
        .flat_map(|card| card.rows.iter())
        .flat_map(|row| row.fields().skip(1));
    bodies
        .chain(kinematic)
        .chain(couplings)
        .flat_map(|card| names.map(|name| card.value(name)))
        .flatten()
        .chain(terms.flat_map(|row| row.fields().step_by(3)))
        .chain(tightened)
        .chain(coupled)
        .chain(joined)
        .collect()
}
