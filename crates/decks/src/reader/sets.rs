//! `*NSET` and `*ELSET`.

use super::context::Context;
use super::mesh_index::{Group, MeshIndex};
use super::names::{Labelled, Labels, Names};
use super::outline::Outline;
use crate::deck::{Card, Line, Text};
use crate::diagnostics::{Code, Span};
use crate::model::{Face, Set};
use std::borrow::Cow;
use std::collections::BTreeSet;

/// All node sets and element sets.
pub(crate) struct Sets {
    /// Names of the node sets.
    pub node_names: Names,
    /// Node sets in the order of their names.
    pub nodes: Vec<Set>,
    /// Names of node sets with UNSORTED; the given order of their members is lost.
    unsorted: BTreeSet<String>,
    /// Names of the element sets.
    pub element_names: Names,
    /// Plane elements of the element sets, in the order of the names.
    pub elements: Vec<Set>,
    /// Other elements of the element sets, in the order of the names.
    pub others: Vec<OtherElements>,
}

impl Sets {
    /// Whether an element set holds line or point elements, springs or dashpots, and no plane elements.
    pub fn holds_others_only(&self, set: usize) -> bool {
        let others = self.others.get(set);
        let elements = self.elements.get(set).map(|set| &set.members);
        others.is_some_and(|all| !all.is_empty()) && elements.is_some_and(Vec::is_empty)
    }

    /// Whether the node set that a field names has UNSORTED.
    pub fn is_unsorted(&self, field: Text, cx: &Context) -> bool {
        let set = self.node_names.full_name(field, cx);
        self.unsorted.contains(&set)
    }

    /// The node that a field names, or the nodes of the set that the field names.
    pub fn nodes_of(&self, field: Text, mesh_index: &MeshIndex, cx: &mut Context) -> Vec<usize> {
        match cx.is_number(field) {
            true => mesh_index.nodes.find(field, cx).into_iter().collect(),
            false => members(&self.nodes, self.node_names.find(field, cx)).to_vec(),
        }
    }

    /// The node that a field names, or the only node of the set; a set with no node or several nodes is reported with
    /// `code` and `help`. `None` if the node is left out.
    pub fn single_node(
        &self,
        field: Text,
        mesh_index: &MeshIndex,
        (code, help): (Code, &str),
        cx: &mut Context,
    ) -> Option<usize> {
        let errors = cx.errors();
        match self.nodes_of(field, mesh_index, cx)[..] {
            [node] => Some(node),
            _ if cx.errors() > errors || cx.may_lack_cards() || mesh_index.nodes.incomplete => None,
            [] if cx.is_number(field) => None,
            ref nodes => {
                let message = format!("{} holds {} nodes", field.text, nodes.len());
                cx.error(code, field.span, message).help(help);
                None
            }
        }
    }

    /// The plane element that a field names, or the plane elements of the set; a set of line elements only is reported.
    pub fn elements_of(
        &self,
        field: Text,
        mesh_index: &MeshIndex,
        cx: &mut Context,
    ) -> Cow<'_, [usize]> {
        let (elements, lines) = self.elements_and_lines_of(field, mesh_index, cx);
        if elements.is_empty() && !lines.is_empty() {
            report_lines(field, cx);
        }
        elements
    }

    /// The point elements that a field names.
    pub fn points_of(&self, field: Text, mesh_index: &MeshIndex, cx: &mut Context) -> Vec<usize> {
        self.members_of(field, mesh_index, cx).1.points.clone()
    }

    /// The rigid lines that a field names.
    pub fn rigid_lines_of(
        &self,
        field: Text,
        mesh_index: &MeshIndex,
        cx: &mut Context,
    ) -> Vec<usize> {
        if mesh_index.rigid_lines.is_empty() {
            return Vec::new();
        }
        (self.members_of(field, mesh_index, cx).1)
            .rigid_lines
            .clone()
    }

    /// The plane elements that a field names, and the faces that its line elements name; a set of springs and dashpots
    /// only is reported.
    pub fn elements_and_lines_of(
        &self,
        field: Text,
        mesh_index: &MeshIndex,
        cx: &mut Context,
    ) -> (Cow<'_, [usize]>, Vec<Face>) {
        let (elements, others) = self.members_of(field, mesh_index, cx);
        if elements.is_empty() && others.lines.is_empty() && !others.connectors.is_empty() {
            report_connectors(field, cx);
        }
        (elements, others.lines.clone())
    }

    /// The plane elements that a field names, and the other elements.
    fn members_of(
        &self,
        field: Text,
        mesh_index: &MeshIndex,
        cx: &mut Context,
    ) -> (Cow<'_, [usize]>, Cow<'_, OtherElements>) {
        if cx.is_number(field) {
            let found = mesh_index.elements.find(field, cx);
            let (elements, others) = split(found.into_iter().collect(), mesh_index);
            return (Cow::Owned(elements), Cow::Owned(others));
        }
        let set = self.element_names.find(field, cx);
        let others = set.and_then(|index| self.others.get(index));
        let others = others.map_or_else(|| Cow::Owned(OtherElements::default()), Cow::Borrowed);
        (Cow::Borrowed(members(&self.elements, set)), others)
    }
}

/// Reports springs and dashpots where plane elements are needed.
fn report_connectors(field: Text, cx: &mut Context) {
    let message = format!("{} stands for springs and dashpots only", field.text);
    cx.error(Code::ElementType, field.span, message)
        .help("they have neither a section nor sides: name plane elements");
}

/// Reports line elements where plane elements are needed.
fn report_lines(field: Text, cx: &mut Context) {
    let message = format!("{} stands for line elements only", field.text);
    cx.error(Code::LineElement, field.span, message)
        .help("they name sides of plane elements, in rows of *SURFACE without a face");
}

/// Members of an element set that are not plane elements.
#[derive(Debug, Clone, Default)]
pub(crate) struct OtherElements {
    /// Faces that line elements name.
    pub lines: Vec<Face>,
    /// Point elements (indices).
    points: Vec<usize>,
    /// Springs and dashpots (indices).
    pub connectors: Vec<usize>,
    /// Rigid lines (indices).
    pub rigid_lines: Vec<usize>,
}

impl OtherElements {
    fn is_empty(&self) -> bool {
        let are_empty = [&self.points, &self.connectors, &self.rigid_lines].map(Vec::is_empty);
        self.lines.is_empty() && are_empty == [true; 3]
    }
}

/// Splits members of a set into plane elements (indices) and other elements; indices count one kind of element after
/// the other.
fn split(members: Vec<usize>, mesh_index: &MeshIndex) -> (Vec<usize>, OtherElements) {
    let (count, lines) = (mesh_index.mesh.elements.len(), &mesh_index.lines);
    let of_points = count + lines.len();
    let of_connectors = of_points + mesh_index.points.len();
    let of_rigid = of_connectors + mesh_index.connectors.len();
    let mut split = OtherElements::default();
    if of_rigid + mesh_index.rigid_lines.len() == count {
        return (members, split);
    }
    let (elements, others): (Vec<_>, Vec<_>) = (members.into_iter()).partition(|&m| m < count);
    for member in others {
        if let Some(line) = member.checked_sub(of_rigid) {
            split.rigid_lines.push(line);
        } else if let Some(connector) = member.checked_sub(of_connectors) {
            split.connectors.push(connector);
        } else if let Some(point) = member.checked_sub(of_points) {
            split.points.push(point);
        } else {
            split.lines.extend(lines.get(member - count).copied());
        }
    }
    (elements, split)
}

fn members(sets: &[Set], index: Option<usize>) -> &[usize] {
    let set = index.and_then(|index| sets.get(index));
    set.map(|set| set.members.as_slice()).unwrap_or_default()
}

/// Reads all sets; a set may list sets that are defined later.
pub(crate) fn read(outline: &Outline, mesh_index: &MeshIndex, cx: &mut Context) -> Sets {
    let mut elements = SetFamily::new("element set", &mesh_index.elements);
    elements.add_groups(&mesh_index.element_groups);
    elements.define(outline, "ELSET", cx);
    elements.fill(cx);
    let element_names = elements.names;
    let element_sets = resolve(&element_names, elements.drafts, cx);
    let (mut element_sets, mut others) = (element_sets, Vec::new());
    for set in &mut element_sets {
        let (elements, own) = split(std::mem::take(&mut set.members), mesh_index);
        set.members = elements;
        others.push(own);
    }

    let mut nodes = SetFamily::new("node set", &mesh_index.nodes);
    nodes.add_groups(&mesh_index.node_groups);
    nodes.define(outline, "NSET", cx);
    nodes.fill(cx);
    let mut sets = Sets {
        node_names: nodes.names,
        nodes: Vec::new(),
        unsorted: nodes.unsorted,
        element_names,
        elements: element_sets,
        others,
    };
    let mut drafts = nodes.drafts;
    for (index, source) in nodes.from_elements {
        let found = sets.element_names.find(source, cx);
        if let (Some(draft), Some(set)) = (drafts.get_mut(index), found) {
            let members = sets.elements.get(set).map_or(&[][..], |set| &set.members);
            let cells = members
                .iter()
                .filter_map(|&e| mesh_index.mesh.elements.get(e));
            draft
                .members
                .extend(cells.flat_map(|element| &element.nodes));
            let Some(others) = sets.others.get(set) else {
                continue;
            };
            let ends = others
                .lines
                .iter()
                .flat_map(|face| face.nodes(&mesh_index.mesh));
            draft.members.extend(ends);
            let rigid = others.rigid_lines.iter();
            let rigid = rigid.filter_map(|&k| mesh_index.rigid_lines.get(k));
            draft.members.extend(rigid.flat_map(|line| line.nodes));
            let connectors = others.connectors.iter();
            let connectors = connectors.filter_map(|&k| mesh_index.connectors.get(k));
            draft
                .members
                .extend(connectors.flat_map(|element| &element.nodes));
        }
    }
    sets.nodes = resolve(&sets.node_names, drafts, cx);
    sets
}

/// Place where a set is first defined: whether in a deck that continues an earlier job, and in which step (`None` for
/// the model).
type Age = (bool, Option<usize>);

/// A set to which the members of listed sets have not been added yet.
struct Draft {
    span: Span,
    age: Age,
    /// Members in any order; a member may appear several times.
    members: Vec<usize>,
    children: Vec<usize>,
}

/// Node sets or element sets being read.
struct SetFamily<'a> {
    names: Names,
    labels: &'a Labels,
    drafts: Vec<Draft>,
    cards: Vec<(usize, &'a Card)>,
    from_elements: Vec<(usize, Text<'a>)>,
    unsorted: BTreeSet<String>,
}

impl<'a> SetFamily<'a> {
    fn new(what: &'static str, labels: &'a Labels) -> SetFamily<'a> {
        SetFamily {
            names: Names::of_parts(what),
            labels,
            drafts: Vec::new(),
            cards: Vec::new(),
            from_elements: Vec::new(),
            unsorted: BTreeSet::new(),
        }
    }

    fn open(&mut self, name: crate::deck::Name, span: Span, age: Age) -> usize {
        let index = self.names.define(name);
        if index == self.drafts.len() {
            self.drafts.push(Draft {
                span,
                age,
                members: Vec::new(),
                children: Vec::new(),
            });
        }
        index
    }

    fn add_groups(&mut self, groups: &[Group]) {
        for group in groups {
            let index = self.open(group.name.clone(), group.span, Age::default());
            let labels = self.labels;
            let found = group.labels.iter().filter_map(|label| labels.get(label));
            if let Some(draft) = self.drafts.get_mut(index) {
                draft.members.reserve(group.labels.len());
                draft.members.extend(found.filter_map(Labelled::index));
            }
        }
    }

    fn extend(&mut self, index: usize, members: impl IntoIterator<Item = usize>) {
        if let Some(draft) = self.drafts.get_mut(index) {
            draft.members.extend(members);
        }
    }

    /// Registers the names of all cards; reports cards that add members to a set of the earlier job, or in a later step
    /// than the definition.
    fn define(&mut self, outline: &Outline<'a>, keyword: &str, cx: &mut Context) {
        for block in outline.blocks(keyword) {
            let card = block.head;
            let text = card.required(keyword, cx.d);
            let Some((name, text)) =
                text.and_then(|text| Some((self.names.defined(text, cx)?, text)))
            else {
                self.names.spoil_unknown();
                continue;
            };
            let age = (card.added, block.step);
            let index = self.open(name, text.span, age);
            let known = self.drafts.get(index).map_or(age, |draft| draft.age);
            if known < age {
                let message = match card.added && !known.0 {
                    true => "a set of the earlier job cannot have other members",
                    false => "a set cannot get members in a step behind its definition",
                };
                cx.error(Code::RepeatedName, text.span, message)
                    .help("give the set here another name");
            }
            self.cards.push((index, card));
        }
    }

    /// Reads the rows of all cards.
    fn fill(&mut self, cx: &mut Context) {
        for (index, card) in std::mem::take(&mut self.cards) {
            let generate = card.has("GENERATE");
            if card.has("UNSORTED") {
                let name = card.value("NSET");
                self.unsorted
                    .extend(name.map(|name| self.names.full_name(name, cx)));
            }
            if card.keyword.name == "NSET"
                && let Some(source) = card.value("ELSET")
            {
                self.from_elements.push((index, source));
            }
            for row in card.rows.iter() {
                cx.go_on();
                match generate {
                    true => self.range(index, row, cx),
                    false => self.list(index, row, cx),
                }
            }
        }
    }

    fn list(&mut self, index: usize, row: Line<'a>, cx: &mut Context) {
        for field in row.fields().filter(|field| !field.is_empty()) {
            if cx.is_number(field) {
                let member = self.labels.find(field, cx);
                self.extend(index, member);
            } else if let Some(child) = self.names.find(field, cx)
                && let Some(draft) = self.drafts.get_mut(index)
            {
                draft.children.push(child);
            }
        }
    }

    /// Reads a row `first, last[, increment]`.
    fn range(&mut self, index: usize, row: Line, cx: &mut Context) {
        row.at_most(3, cx.d);
        let first = row.required(0, "the first number", cx.d);
        let first = first.and_then(|field| self.labels.label(field, cx));
        let last = row.required(1, "the last number", cx.d);
        let last = last.and_then(|field| self.labels.label(field, cx));
        let step = match row.get(2) {
            Some(field) => self.labels.number(field, cx),
            None => Some(1),
        };
        if let (Some(first), Some(last), Some(step)) = (first, last, step) {
            self.check_range(first, last, step, row, cx);
            let members = self.in_range(first, last, step, row, cx);
            self.extend(index, members);
        }
    }

    fn check_range(&self, first: u64, last: u64, step: u64, row: Line, cx: &mut Context) {
        let [start, stop] = [first, last].map(|label| cx.named(label));
        if last < first {
            let message = format!("the range from {start} to {stop} runs backwards");
            cx.error(Code::BadRange, row.span(), message);
        } else if !(last - first).is_multiple_of(step) {
            let message = format!("steps of {step} from {start} do not meet {stop}");
            let end = cx.named(last - (last - first) % step);
            cx.warning(Code::BadRange, row.span(), message)
                .help(format!("the range ends at {end}"));
        }
    }

    /// Members of a range; reports the first number that does not exist.
    fn in_range(
        &self,
        first: u64,
        last: u64,
        step: u64,
        row: Line,
        cx: &mut Context,
    ) -> Vec<usize> {
        let in_step = |label: u64| (label - first).is_multiple_of(step);
        let found = self
            .labels
            .between(first, last)
            .filter(|&(label, _)| in_step(label));
        let mut wanted = Some(first);
        let mut members = Vec::new();
        let mut missing = None;
        for (label, labelled) in found {
            if wanted != Some(label) && missing.is_none() {
                missing = wanted;
            }
            wanted = label.checked_add(step);
            members.extend(labelled.index());
        }
        let missing = missing.or(wanted.filter(|&label| label <= last));
        if let Some(label) = missing {
            self.labels.undefined(label, row.span(), cx);
        }
        members
    }
}

/// Adds the members of listed sets to each set, innermost sets first.
fn resolve(names: &Names, mut drafts: Vec<Draft>, cx: &mut Context) -> Vec<Set> {
    let mut parents: Vec<Vec<usize>> = vec![Vec::new(); drafts.len()];
    let mut open: Vec<usize> = drafts.iter().map(|draft| draft.children.len()).collect();
    for (index, draft) in drafts.iter().enumerate() {
        for &child in &draft.children {
            parents[child].push(index);
        }
    }
    let mut ready: Vec<usize> = (0..drafts.len()).filter(|&i| open[i] == 0).collect();
    while let Some(child) = ready.pop() {
        sort(&mut drafts[child].members);
        for &parent in &parents[child] {
            let members = drafts[child].members.clone();
            drafts[parent].members.extend(members);
            open[parent] -= 1;
            if open[parent] == 0 {
                ready.push(parent);
            }
        }
    }
    for (draft, _) in drafts.iter().zip(&open).filter(|(_, open)| **open > 0) {
        cx.error(Code::SetCycle, draft.span, "this set contains itself");
    }
    for draft in drafts.iter().filter(|draft| draft.members.is_empty()) {
        if !cx.d.has_errors() && !cx.deck.incomplete {
            cx.warning(Code::EmptySurface, draft.span, "this set has no members");
        }
    }
    let named = names.typed().zip(drafts);
    named
        .map(|(name, mut draft)| {
            sort(&mut draft.members);
            Set {
                name: name.to_string(),
                members: draft.members,
            }
        })
        .collect()
}

/// Sorts members and removes duplicates.
fn sort(members: &mut Vec<usize>) {
    if !members.is_sorted_by(|a, b| a < b) {
        members.sort_unstable();
        members.dedup();
    }
}
