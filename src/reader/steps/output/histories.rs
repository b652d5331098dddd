//! Sets of the histories, fields on request, and dofs in the status file.

use super::monitor::monitored;
use crate::deck::{Card, Row, Text};
use crate::diagnostics::{Code, Diagnostic};
use crate::model::{HistorySet, RequestedFields};
use crate::reader::context::Context;
use crate::reader::mesh::Sets;
use crate::reader::steps::boundary::Targets;

/// What the deck has asked for so far.
#[derive(Default)]
pub(crate) struct Histories {
    /// Node sets.
    pub nodes: Vec<HistorySet>,
    /// Element sets.
    pub elements: Vec<HistorySet>,
    /// Fields on request.
    pub fields: RequestedFields,
    /// Dofs in the status file.
    pub monitored: Vec<usize>,
}

/// What a set holds.
#[derive(Clone, Copy)]
pub(super) enum Family {
    Nodes,
    Elements,
}

impl Family {
    fn parameter(self) -> &'static str {
        match self {
            Family::Nodes => "NSET",
            Family::Elements => "ELSET",
        }
    }

    /// Warns that a history without a set is not written.
    fn report_all(self, card: &Card, cx: &mut Context) {
        let (members, help) = match self {
            Family::Nodes => ("nodes", "name a node set with NSET="),
            Family::Elements => ("elements", "name an element set with ELSET="),
        };
        let message = format!("the history of all {members} is not written");
        let warning = Diagnostic::warning(Code::IgnoredVariable, card.span, message);
        cx.d.push(warning.help(help));
    }
}

impl Histories {
    /// Adds the set of a card; `FREQUENCY=0` asks for nothing.
    pub(super) fn card(&mut self, card: &Card, family: Family, sets: &Sets, cx: &mut Context) {
        let name = card.value(family.parameter());
        let is_off = card
            .value("FREQUENCY")
            .is_some_and(|n| n.text.trim() == "0");
        let each_member = card.choice("TOTALS") != Some("ONLY");
        match name {
            Some(name) => {
                if let Some(set) = family.set(name, sets, cx).filter(|_| !is_off) {
                    self.add(family, HistorySet { set, each_member });
                }
            }
            None if is_off || card.has(family.parameter()) => {}
            None => family.report_all(card, cx),
        }
    }

    fn add(&mut self, family: Family, asked: HistorySet) {
        let known = match family {
            Family::Nodes => &mut self.nodes,
            Family::Elements => &mut self.elements,
        };
        match known.iter_mut().find(|known| known.set == asked.set) {
            Some(known) => known.each_member |= asked.each_member,
            None => known.push(asked),
        }
    }

    /// Adds the fields of nodes or elements that a card names and that are written on request only.
    pub(super) fn fields(&mut self, card: &Card) {
        if card.keyword.name.starts_with("CONTACT") {
            return;
        }
        for field in card.rows.iter().flat_map(Row::fields) {
            match field.name_key().as_str() {
                "CF" => self.fields.concentrated_load = true,
                "ENER" => self.fields.energy_density = true,
                "LE" => self.fields.logarithmic_strain = true,
                _ => {}
            }
        }
    }

    /// Adds the dof of `*MONITOR`.
    pub(super) fn monitor(&mut self, card: &Card, targets: Targets, cx: &mut Context) {
        let new = monitored(card, targets, cx).filter(|dof| !self.monitored.contains(dof));
        self.monitored.extend(new);
    }
}

impl Family {
    /// The set of a name; none that holds line elements only, with a warning.
    fn set(self, name: Text, sets: &Sets, cx: &mut Context) -> Option<usize> {
        let set = match self {
            Family::Nodes => return sets.node_names.find(name, cx),
            Family::Elements => sets.element_names.find(name, cx)?,
        };
        if sets.holds_lines_only(set) {
            let message = format!("{} holds line elements only: it has no history", name.text);
            let warning = Diagnostic::warning(Code::IgnoredVariable, name.span, message);
            cx.d.push(warning.help("line elements name faces, they carry no stress"));
            return None;
        }
        Some(set)
    }
}
