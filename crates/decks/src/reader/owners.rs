//! A table of all cards that make nodes and displacements follow others; the table tells which card decides the motion
//! of a node. If two cards decide the same displacement, or if a load, support or velocity acts on a displacement that
//! does not exist, an error names both cards.

use super::actions::{Action, Actions};
use super::boundary::Targets;
use super::context::Context;
use super::couplings::Link;
use super::mesh_index::{ConnectorElement, MeshIndex, PointElement, PointKind};
use super::pretension::Cut;
use super::rigid_bodies::Rigid;
use super::ties::Ties;
use crate::diagnostics::{Added, Code, Span};
use crate::model::{Connector, ConnectorDirection, ConnectorLaw, Equation, Tie};
use std::collections::{BTreeMap, BTreeSet};

/// Constraints that make nodes follow other nodes, except the equations of `*EQUATION`.
#[derive(Clone, Copy)]
pub(crate) struct Constraints<'a> {
    pub ties: &'a Ties,
    pub links: &'a [Link],
    pub cuts: &'a [Cut],
}

/// A card that decides the motion of nodes, by its kind.
#[derive(Clone, Copy)]
pub(crate) enum Owner<'a> {
    /// The node of a pre-tension section, whose only displacement has direction 1.
    Section(&'a Cut),
    /// A rigid body or coupling, whose nodes move with a reference node.
    Body(&'a Rigid),
    /// A tie, whose slave nodes follow a master.
    Tie(&'a Tie, Span),
    /// A link, whose nodes are joined or follow the mean of other nodes.
    Link(&'a Link),
    /// A spring or dashpot, with its ends.
    Connector(&'a ConnectorElement),
    /// A point element, which has a node with mass.
    Point(&'a PointElement),
    /// A card `*EQUATION`, by the first term of an equation.
    Equation(Span),
    /// A card that prescribes a motion.
    Support(Span),
}

impl Owner<'_> {
    /// Name of the card in messages, as in `the rigid body TOP`.
    pub fn title(self) -> String {
        match self {
            Owner::Section(_) => "the *PRE-TENSION SECTION".to_owned(),
            Owner::Body(body) => body.title(),
            Owner::Tie(tie, _) => format!("the tie {}", tie.name),
            Owner::Link(link) => link.title(),
            Owner::Connector(element) => match element.kind.law {
                ConnectorLaw::Spring => "a spring".to_owned(),
                ConnectorLaw::Dashpot => "a dashpot".to_owned(),
            },
            Owner::Point(point) => match point.kind {
                PointKind::Mass => "an element of TYPE=MASS".to_owned(),
                PointKind::RotaryInertia => "an element of TYPE=ROTARYI".to_owned(),
            },
            Owner::Equation(_) => "an *EQUATION".to_owned(),
            Owner::Support(_) => "a *BOUNDARY".to_owned(),
        }
    }

    /// Place of the card.
    pub fn span(self) -> Span {
        match self {
            Owner::Section(cut) => cut.span,
            Owner::Body(body) => body.span(),
            Owner::Link(link) => link.span(),
            Owner::Connector(element) => element.span,
            Owner::Point(point) => point.span,
            Owner::Tie(_, span) | Owner::Equation(span) | Owner::Support(span) => span,
        }
    }

    /// Code of messages about errors that concern the card.
    pub fn code(self) -> Code {
        match self {
            Owner::Section(_) => Code::PreTension,
            Owner::Body(body) if body.is_coupling() => Code::Coupling,
            Owner::Body(_) | Owner::Point(_) => Code::RigidSurface,
            Owner::Tie(..) => Code::Tie,
            Owner::Link(_) => Code::Coupling,
            Owner::Connector(_) => Code::UnusedNode,
            Owner::Equation(_) => Code::BadEquation,
            Owner::Support(_) => Code::ConflictingSupport,
        }
    }

    /// Reports, at the place of an owner, that this owner contradicts the owner `other`.
    pub fn contradicts<'d>(self, other: Owner, message: String, cx: &'d mut Context) -> Added<'d> {
        cx.error(self.code(), self.span(), message)
            .other(other.title(), other.span())
    }
}

/// Reports nodes that two cards move: a node may move with one body only, and the node of a pre-tension section may
/// belong to nothing else.
pub(crate) fn check_nodes(
    rigid_bodies: &[Rigid],
    of: Constraints,
    mesh_index: &MeshIndex,
    cx: &mut Context,
) {
    let mut sections: BTreeMap<usize, Owner> = BTreeMap::new();
    for cut in of.cuts {
        if let Some(other) = sections.insert(cut.node, Owner::Section(cut)) {
            report_shared(cut.node, [other, Owner::Section(cut)], mesh_index, cx);
        }
    }
    let mut riders = sections.clone();
    for body in rigid_bodies {
        let own = Owner::Body(body);
        let entered = body.nodes().map(|node| (node, riders.insert(node, own)));
        let shared: Option<(usize, Owner)> = (entered
            .filter_map(|(node, other)| Some((node, other?))))
        .collect::<Vec<_>>()
        .first()
        .copied();
        if let Some((node, other)) = shared {
            report_shared(node, [other, own], mesh_index, cx);
        }
    }
    let ties = of.ties.all.iter().zip(&of.ties.spans);
    let slaves = |tie: &Tie| {
        tie.nodes
            .iter()
            .map(|tied| tied.node)
            .collect::<Vec<usize>>()
    };
    let tied = ties.map(|(tie, &span)| (slaves(tie), Owner::Tie(tie, span)));
    let linked = of
        .links
        .iter()
        .map(|link| (link.nodes(), Owner::Link(link)));
    let connectors = mesh_index.connectors.iter();
    let sprung = connectors.map(|own| (own.nodes.to_vec(), Owner::Connector(own)));
    let points = mesh_index.points.iter();
    let massive = points.map(|point| (vec![point.node], Owner::Point(point)));
    for (nodes, owner) in tied.chain(linked).chain(sprung).chain(massive) {
        let of_section = nodes
            .iter()
            .find_map(|node| Some((*node, *sections.get(node)?)));
        if let Some((node, section)) = of_section {
            report_shared(node, [section, owner], mesh_index, cx);
        }
    }
}

/// Reports two bodies, or two ties, whose results would have the same name in the group `rigid` or `ties` of the
/// histories.
pub(crate) fn check_names(rigid_bodies: &[Rigid], ties: &Ties, cx: &mut Context) {
    let bodies = rigid_bodies.iter();
    let bodies = bodies.map(|body| ("rigid", body.name(), Owner::Body(body)));
    let tied = ties.all.iter().zip(&ties.spans);
    let tied = tied.map(|(tie, &span)| ("ties", tie.name.as_str(), Owner::Tie(tie, span)));
    let mut known: BTreeMap<(&str, &str), Owner> = BTreeMap::new();
    for (group, name, own) in bodies.chain(tied) {
        if let Some(other) = known.insert((group, name), own) {
            let message = format!(
                "{} has the name of {}: the results of both would be {group}/{name}",
                own.title(),
                other.title()
            );
            cx.error(Code::RepeatedName, own.span(), message)
                .other(other.title(), other.span())
                .help("rename one of the two: NAME= and CONSTRAINT NAME= name couplings, NAME= ties, sets and surfaces rigid bodies");
        }
    }
}

/// Reports a node that belongs to two cards.
fn report_shared(node: usize, [other, own]: [Owner; 2], mesh_index: &MeshIndex, cx: &mut Context) {
    let name = mesh_index.node_name(node);
    let (first, second) = (other.title(), own.title());
    let message = format!("node {name} belongs to {first} and to {second}");
    let help = match (other, own) {
        (Owner::Section(_), _) | (_, Owner::Section(_)) => {
            "take a node of its own for the section: its displacement in direction 1 is the tightening"
        }
        _ => {
            "a node rides on one body: couple the second to the reference node of the first, give both one reference \
             node, or join two nodes at one place by *MPC of the type PIN"
        }
    };
    own.contradicts(other, message, cx).help(help);
}

/// Reports actions on displacements that do not exist because no element, body, spring, dashpot or equation has these
/// displacements.
pub(crate) fn check_actions(
    actions: [&Actions; 3],
    targets: Targets,
    (connectors, equations, cuts): (&[Connector], &[(Equation, Owner)], &[Cut]),
    cx: &mut Context,
) {
    let all = || actions.into_iter().flat_map(|actions| &actions.all);
    // what a faulty card should have given may be missing
    if cx.d.has_errors() || all().next().is_none() {
        return;
    }
    let mesh = &targets.mesh_index.mesh;
    let bodies = targets.rigid_bodies.iter().flat_map(Rigid::nodes);
    let of_bodies: BTreeSet<usize> = bodies.flat_map(|node| [2 * node, 2 * node + 1]).collect();
    let of_connectors = connectors.iter().flat_map(|connector| {
        let directions = match connector.direction {
            ConnectorDirection::Fixed(both) => both,
            ConnectorDirection::Line => [[1.0; 2]; 2],
            ConnectorDirection::Angle => return Vec::new(),
        };
        let nodes = connector.nodes.iter().zip(directions);
        let dofs = nodes.flat_map(|(node, [x, y])| [(2 * node, x), (2 * node + 1, y)]);
        dofs.filter_map(|(dof, along)| (along != 0.0).then_some(dof))
            .collect::<Vec<_>>()
    });
    let mut exist: BTreeSet<usize> = of_bodies.into_iter().chain(of_connectors).collect();
    let has_element = |dof: &usize| targets.has_element.get(dof / 2) == Some(&true);
    let equations = || equations.iter().map(|(equation, _)| equation);
    for equation in equations() {
        if has_element(&equation.dof) || exist.contains(&equation.dof) {
            exist.extend(equation.terms.iter().map(|term| term.0));
        }
    }
    for equation in equations() {
        let mut terms = equation.terms.iter().map(|term| term.0);
        if terms.any(|dof| has_element(&dof) || exist.contains(&dof)) {
            exist.insert(equation.dof);
        }
    }
    let mut said = BTreeSet::new();
    for &(dof, action, span) in all() {
        if dof >= mesh.dof_count() || exist.contains(&dof) || !said.insert((dof, span)) {
            continue;
        }
        let (name, direction) = (targets.mesh_index.node_name(dof / 2), dof % 2 + 1);
        let what = match action {
            Action::Load => "this force acts",
            Action::Motion => "this motion is prescribed",
            Action::Velocity => "this velocity is given",
        };
        let message =
            format!("{what} in direction {direction} of node {name}, which the node does not have");
        match cuts.iter().find(|cut| cut.node == dof / 2) {
            Some(cut) => {
                let section = Owner::Section(cut);
                cx.error(Code::BadDof, span, message)
                    .other(section.title(), section.span())
                    .help("the node of a section has direction 1, the tightening");
            }
            None => {
                cx.error(Code::BadDof, span, message)
                    .help("no element, body, spring or equation has it: name another node, or write the equation for it");
            }
        }
    }
}
