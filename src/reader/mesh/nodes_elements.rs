//! `*NODE` and `*ELEMENT`.

use super::element_type::{self, Kind};
use super::instances;
use super::line_elements::{self, RawLine};
use super::mesh_index::{Group, MeshIndex, RawElement, RawNode};
use super::outline::Outline;
use super::references;
use crate::deck::{Card, Row, Text};
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::model::Mesh;
use crate::reader::context::Context;
use crate::reader::label::LabelMap;
use crate::reader::names::{Labelled, Labels};
use smallvec::SmallVec;
use std::collections::BTreeSet;

/// Reads nodes and elements; leaves out nodes of neither an element, a rigid surface nor an
/// equation.
pub(crate) fn read<'a>(outline: &Outline<'a>, cx: &mut Context<'a>) -> MeshIndex {
    let errors = cx.errors();
    let mut reading = Reading {
        nodes_incomplete: outline.blocks("NODE").next().is_none(),
        elements_incomplete: outline.blocks("ELEMENT").next().is_none(),
        ..Reading::default()
    };
    for card in outline.model_cards("NODE") {
        reading.node_card(card, cx);
    }
    for card in outline.model_cards("ELEMENT") {
        reading.element_card(card, cx);
    }
    if cx.errors() == errors && !cx.may_lack_cards() {
        reading.report_empty(outline, cx);
    }
    reading.report_not_planar(cx);
    let groups = reading.node_groups.iter();
    let groups: Vec<_> = groups
        .map(|group| (group.name.key.as_str(), group.labels.as_slice()))
        .collect();
    let references = references::labels(outline, &groups, cx);
    reading.mesh_index(&references, cx)
}

#[derive(Default)]
struct Reading<'a> {
    nodes: Vec<RawNode<'a>>,
    node_index: LabelMap<Option<usize>>,
    elements: Vec<RawElement>,
    lines: Vec<RawLine>,
    element_index: LabelMap<Span>,
    node_groups: Vec<Group>,
    element_groups: Vec<Group>,
    nodes_incomplete: bool,
    elements_incomplete: bool,
}

impl<'a> Reading<'a> {
    fn node_card(&mut self, card: &'a Card, cx: &mut Context) {
        let mut labels = Vec::new();
        for row in &card.rows {
            let fields: SmallVec<[Text; 4]> = row.fields().collect();
            if fields.len() > 4 {
                row.at_most(4, cx.d);
            }
            let numbers = Labels::new("node", Code::UndefinedNode);
            let field = match fields.first() {
                Some(field) if !field.is_empty() => Some(*field),
                _ => row.required(0, "the node number", cx.d),
            };
            match field.and_then(|field| numbers.label(field, cx)) {
                Some(label) => {
                    labels.push(label);
                    self.node(label, row, &fields, cx);
                }
                None => self.nodes_incomplete = true,
            }
        }
        self.node_groups.extend(group(card, "NSET", labels, cx));
    }

    fn node(&mut self, label: u64, row: &'a Row, fields: &[Text], cx: &mut Context) {
        let known = self.node_index.get(label).copied();
        let at = [1, 2, 3].map(|i| match fields.get(i) {
            Some(field) if !field.is_empty() => field.real(cx.d),
            _ => Some(0.0),
        });
        let [Some(x), Some(y), Some(z)] = at else {
            if known.is_none() {
                self.node_index.insert(label, None);
            }
            return;
        };
        let [x, y] = cx.placed([x, y], row);
        let at = [x, y, z];
        let Some(known) = known else {
            self.node_index.insert(label, Some(self.nodes.len()));
            self.nodes.push(RawNode { label, at, row });
            return;
        };
        let first = known.and_then(|index| self.nodes.get(index));
        if let Some(first) = first.filter(|first| first.at != at) {
            let (name, line) = (cx.named(label), first.row.span().line);
            let message = format!("node {name} has other coordinates on line {line}");
            cx.error(Code::RepeatedNode, row.span(), message);
        }
    }

    fn element_card(&mut self, card: &Card, cx: &mut Context) {
        let kind = card
            .required("TYPE", cx.d)
            .and_then(|name| element_type::read(name, cx));
        let Some(kind) = kind else {
            self.elements_incomplete = true;
            self.element_groups
                .extend(group(card, "ELSET", Vec::new(), cx));
            return;
        };
        let mut labels = Vec::new();
        for rows in element_rows(&card.rows, kind.nodes() + 1) {
            match self.element(rows, kind, cx) {
                Some(label) => labels.push(label),
                None => self.elements_incomplete = true,
            }
        }
        self.element_groups.extend(group(card, "ELSET", labels, cx));
    }

    /// Reads one element; returns its number.
    fn element(&mut self, rows: &[Row], kind: Kind, cx: &mut Context) -> Option<u64> {
        let corners = kind.nodes();
        let span = rows.first()?.span();
        let numbers = Labels::new("element", Code::UndefinedElement);
        let fields: SmallVec<[Text; 10]> = rows.iter().flat_map(Row::fields).collect();
        let (first, rest) = fields.split_first()?;
        let label = numbers.label(*first, cx)?;
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
        let nodes = self.element_nodes(label, rest.get(..corners)?, cx)?;
        if let Some(earlier) = self.element_index.insert(label, span) {
            let (name, line) = (cx.named(label), earlier.line);
            let message = format!("element {name} is defined on line {line} too");
            cx.error(Code::RepeatedElement, first.span, message);
            return Some(label);
        }
        match kind {
            Kind::Plane(element_type) => self.elements.push(RawElement {
                label,
                nodes,
                element_type,
                span,
            }),
            Kind::Line => self.lines.push(RawLine { label, nodes, span }),
        }
        Some(label)
    }

    /// Numbers of an element's nodes, which must exist and differ.
    fn element_nodes(
        &self,
        label: u64,
        fields: &[Text],
        cx: &mut Context,
    ) -> Option<SmallVec<[u64; 4]>> {
        let mut nodes = SmallVec::new();
        let mut good = true;
        for field in fields {
            let numbers = Labels::new("node", Code::UndefinedNode);
            let Some(node) = numbers.label(*field, cx) else {
                good = false;
                continue;
            };
            if nodes.contains(&node) {
                let [element, node] = [label, node].map(|label| cx.named(label));
                let message = format!("element {element} has node {node} twice");
                cx.error(Code::BadShape, field.span, message);
                good = false;
            }
            if !matches!(self.node_index.get(node), Some(Some(_))) {
                good = false;
                self.undefined_node(node, field.span, cx);
            }
            nodes.push(node);
        }
        good.then_some(nodes)
    }

    fn undefined_node(&self, node: u64, span: Span, cx: &mut Context) {
        let known = self.node_index.get(node).is_some();
        if !known && !self.nodes_incomplete && !cx.deck.incomplete {
            let message = format!("node {} is not defined", cx.named(node));
            cx.error(Code::UndefinedNode, span, message);
        }
    }

    /// Reports a mesh without nodes or elements at their card, or else where it should stand:
    /// elements after the last nodes, nodes at the first keyword of the deck.
    fn report_empty(&self, outline: &Outline, cx: &mut Context) {
        let (keyword, before) = match (self.nodes.is_empty(), self.elements.is_empty()) {
            (true, _) => ("NODE", None),
            (false, true) => ("ELEMENT", outline.model_cards("NODE").pop()),
            (false, false) => return,
        };
        let card = outline.model_cards(keyword).first().copied();
        if let Some(card) = card.or(before).or(cx.deck.cards.first()) {
            let message = format!("the deck has no {}s", keyword.to_lowercase());
            let error = Diagnostic::error(Code::EmptyMesh, card.span, message);
            cx.d.push(error.help(format!("give them with *{keyword}")));
        }
    }

    /// Reports nodes whose z differ by more than a small fraction of the model's size.
    fn report_not_planar(&self, cx: &mut Context) {
        let range = |i: usize| {
            let values = self.nodes.iter().map(|node| node.at[i]);
            let low = values.clone().fold(f64::INFINITY, f64::min);
            (low, values.fold(f64::NEG_INFINITY, f64::max))
        };
        let [x, y, z] = [0, 1, 2].map(range);
        let size = (x.1 - x.0).max(y.1 - y.0);
        let Some(first) = self.nodes.first() else {
            return;
        };
        if z.1 - z.0 > 1e-9 * size {
            let off = self.nodes.iter().find(|node| node.at[2] != first.at[2]);
            let message = format!("the mesh is not plane: z runs from {} to {}", z.0, z.1);
            cx.error(Code::NotPlanar, off.unwrap_or(first).row.span(), message);
        }
    }

    fn mesh_index(self, references: &BTreeSet<u64>, cx: &mut Context) -> MeshIndex {
        let mut used = vec![false; self.nodes.len()];
        let index_of = |label: &u64| self.node_index.get(*label).copied().flatten();
        for index in self
            .elements
            .iter()
            .flat_map(|e| &e.nodes)
            .chain(references)
            .filter_map(index_of)
        {
            used[index] = true;
        }
        self.report_unused(&used, cx);
        let mut mesh_index = MeshIndex {
            mesh: Mesh::default(),
            instances: Vec::new(),
            nodes: Labels::new("node", Code::UndefinedNode),
            elements: Labels::new("element", Code::UndefinedElement),
            lines: Vec::new(),
            element_spans: Vec::new(),
            node_groups: self.node_groups,
            element_groups: self.element_groups,
        };
        mesh_index.nodes.incomplete = self.nodes_incomplete;
        mesh_index.elements.incomplete = self.elements_incomplete;
        for (label, _) in self.node_index.iter() {
            mesh_index.nodes.insert(label, Labelled::LeftOut);
        }
        for (node, used) in self.nodes.iter().zip(used) {
            if used {
                mesh_index.add_node(node);
            }
        }
        for element in &self.elements {
            mesh_index.add_element(element);
        }
        line_elements::add(&self.lines, &mut mesh_index, cx);
        mesh_index.instances = instances::number(&mut mesh_index.mesh, cx);
        mesh_index
    }

    /// Warns about nodes of no element.
    fn report_unused(&self, used: &[bool], cx: &mut Context) {
        let unused = || self.nodes.iter().zip(used).filter(|(_, used)| !**used);
        let Some((first, _)) = unused().next() else {
            return;
        };
        if self.elements_incomplete || self.elements.is_empty() || cx.deck.incomplete {
            return;
        }
        let name = cx.named(first.label);
        let message = match unused().count() {
            1 => format!("node {name} belongs to no element"),
            n => format!("{n} nodes belong to no element, the first is node {name}"),
        };
        let warning = Diagnostic::warning(Code::UnusedNode, first.row.span(), message);
        cx.d.push(warning.help("left out, together with what the deck says about them"));
    }
}

/// The set that a card names.
fn group(card: &Card, parameter: &str, labels: Vec<u64>, cx: &mut Context) -> Option<Group> {
    let text = card.value(parameter)?;
    Some(Group {
        name: text
            .name(cx.d)
            .map(|name| cx.of_instance(name, text.span))?,
        span: text.span,
        labels,
    })
}

/// Groups rows by element: an element takes rows until it has `count` fields or the next row would
/// exceed them.
fn element_rows(rows: &[Row], count: usize) -> Vec<&[Row]> {
    let mut elements = Vec::new();
    let mut rest = rows;
    while !rest.is_empty() {
        let mut fields = 0;
        let fits = |row: &&Row| {
            let before = fields;
            fields += row.fields().count();
            before == 0 || (before < count && fields <= count)
        };
        let taken = rest.iter().take_while(fits).count().max(1);
        let (element, after) = rest.split_at(taken);
        elements.push(element);
        rest = after;
    }
    elements
}
