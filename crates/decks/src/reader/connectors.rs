//! `*SPRING` and `*DASHPOT` define the forces of elements of the types SPRINGA, SPRING1, DASHPOT2 ... follows. See
//! docs/theory/elements.md.

use super::boundary::{self, Targets};
use super::context::Context;
use super::label::{instance_of, number_of};
use super::mesh_index::{ConnectorElement, ConnectorKind, MeshIndex};
use super::orientations::{Axes, Orientations};
use super::outline::Outline;
use crate::deck::{Card, Line};
use crate::diagnostics::Code;
use crate::model::{
    Connector, ConnectorDirection, ConnectorLaw, Equation, ForceCurve, Model, Procedure,
};

fn keyword(law: ConnectorLaw) -> &'static str {
    match law {
        ConnectorLaw::Spring => "SPRING",
        ConnectorLaw::Dashpot => "DASHPOT",
    }
}

/// Reads the forces of all springs and dashpots, in the order of the elements.
pub(super) fn read(outline: &Outline, targets: Targets, cx: &mut Context) -> Vec<Connector> {
    let mesh_index = targets.mesh_index;
    let mut all: Vec<Option<Connector>> = vec![None; mesh_index.connectors.len()];
    let errors = cx.errors();
    let orientations = Orientations::new(outline, cx);
    for law in [ConnectorLaw::Spring, ConnectorLaw::Dashpot] {
        for card in outline.model_cards(keyword(law)) {
            card_of((card, law), &orientations, targets, &mut all, cx);
        }
    }
    orientations.report_unused(cx);
    let elements = || mesh_index.connectors.iter().zip(&all);
    if let Some((element, _)) = elements().find(|(_, connector)| connector.is_none())
        && cx.errors() == errors
        && !cx.may_lack_cards()
    {
        let (keyword, name) = (keyword(element.kind.law), cx.named(element.label));
        let message = format!("element {name} has no *{keyword}");
        cx.error(Code::NoSection, element.span, message)
            .help(format!("give its force with *{keyword}, ELSET="));
    }
    report_short(mesh_index, &all, cx);
    let mut all: Vec<Connector> = all.into_iter().flatten().collect();
    number_instances(mesh_index, &mut all);
    all
}

/// Reports nodes of springs and dashpots without mass in a dynamic step: nodes that belong to no element, rigid body or
/// equation and are not held in both directions.
pub(super) fn check(model: &Model, elements: &[ConnectorElement], cx: &mut Context) {
    let mut has_mass = vec![false; model.mesh.dof_count()];
    let of_elements = model
        .mesh
        .elements
        .iter()
        .flat_map(|element| &element.nodes);
    let bodies = model.rigid_bodies.iter();
    let bodies = bodies.flat_map(|body| body.nodes.iter().copied().chain([body.reference]));
    let points = model.point_masses.iter().map(|&(node, _)| node);
    for node in of_elements.copied().chain(bodies).chain(points) {
        has_mass[2 * node..2 * node + 2].fill(true);
    }
    // what a displacement with mass follows has its mass, and what follows one
    for Equation { dof, terms } in &model.equations {
        if has_mass[*dof] {
            terms.iter().for_each(|term| has_mass[term.0] = true);
        }
    }
    for Equation { dof, terms } in &model.equations {
        has_mass[*dof] |= terms.iter().any(|term| has_mass[term.0]);
    }
    let is_held = |dof: usize| {
        let mut dynamic = model
            .steps
            .iter()
            .filter(|step| step.procedure != Procedure::Static);
        dynamic.all(|step| step.motion_of(dof).is_some())
    };
    let is_light =
        |node: usize| (2 * node..2 * node + 2).any(|dof| !has_mass[dof] && !is_held(dof));
    for (connector, element) in model.connectors.iter().zip(elements) {
        let mut nodes = connector.nodes.iter();
        if let Some(&node) = nodes.find(|&&node| is_light(node)) {
            let (name, label) = (model.node_name(node), connector.label);
            let message =
                format!("node {name} of element {label} has no mass: nothing else is there");
            cx.error(Code::UnusedNode, element.span, message)
                .help("hold it with *BOUNDARY in directions 1 and 2, or take a node of a body");
            return;
        }
    }
}

/// Numbers springs and dashpots of instances; these numbers lie above all other numbers.
fn number_instances(mesh_index: &MeshIndex, all: &mut [Connector]) {
    let elements = mesh_index.mesh.elements.iter().map(|element| element.label);
    let connectors = all.iter().map(|connector| connector.label);
    let mut last = elements.chain(connectors).max().unwrap_or(0);
    for (connector, element) in all.iter_mut().zip(&mesh_index.connectors) {
        if instance_of(element.label) > 0 {
            last += 1;
            connector.label = last;
        }
    }
}

/// Makes springs or dashpots from the elements of a card, with the force of this card.
fn card_of(
    (card, law): (&Card, ConnectorLaw),
    orientations: &Orientations,
    targets: Targets,
    all: &mut [Option<Connector>],
    cx: &mut Context,
) {
    let Targets {
        mesh_index, sets, ..
    } = targets;
    let Some(name) = card.required("ELSET", cx.d) else {
        return;
    };
    let Some(set) = sets.element_names.find(name, cx) else {
        return;
    };
    let others = sets.others.get(set);
    let members = others.map_or(&[][..], |others| &others.connectors);
    let elements = || {
        let all = members.iter().filter_map(|&k| mesh_index.connectors.get(k));
        all.filter(|element| element.kind.law == law)
    };
    let Some(first) = elements().next() else {
        if !cx.may_lack_cards() && !mesh_index.elements.incomplete {
            let family = keyword(law);
            let message = format!("{} holds no {family} elements", name.text);
            cx.error(Code::ElementType, name.span, message)
                .help(format!(
                    "name a set of elements of TYPE={family}A, {family}1 or {family}2"
                ));
        }
        return;
    };
    let kind = first.kind;
    if let Some(other) = elements().find(|element| element.kind != kind) {
        let message = format!(
            "the elements of {} must be of one type: element {} is another than element {}",
            name.text,
            cx.named(other.label),
            cx.named(first.label)
        );
        cx.error(Code::ElementType, name.span, message)
            .help("give springs and dashpots of each type a set and a card of their own");
        return;
    }
    let all_elements: Vec<&ConnectorElement> = elements().collect();
    let Ok(axes) = axes(card, kind, orientations, cx) else {
        return;
    };
    let Some((direction, curve)) = force(card, (kind, &all_elements), (axes, targets), cx) else {
        return;
    };
    for &k in members {
        let (Some(element), Some(connector)) = (mesh_index.connectors.get(k), all.get_mut(k))
        else {
            continue;
        };
        if connector.is_some() {
            let name = cx.named(element.label);
            let message = format!("element {name} has a *{} already", keyword(kind.law));
            cx.error(Code::TwoSections, card.span_of("ELSET"), message);
            return;
        }
        *connector = Some(Connector {
            label: number_of(element.label),
            nodes: element.nodes.iter().copied().collect(),
            direction,
            law,
            curve: curve.clone(),
        });
    }
}

/// The axes of the orientation that a card names; `Err` after a reported error.
fn axes(
    card: &Card,
    kind: ConnectorKind,
    orientations: &Orientations,
    cx: &mut Context,
) -> Result<Option<Axes>, ()> {
    if kind.form == 'A' {
        return Ok(None);
    }
    match card.value("ORIENTATION") {
        Some(field) => orientations.find(field, cx).map(Some).ok_or(()),
        None => Ok(None),
    }
}

/// Direction and force that the rows of a card give. The first row holds the directions of the nodes, except for types
/// of springs and dashpots that act along a line.
fn force(
    card: &Card,
    (kind, elements): (ConnectorKind, &[&ConnectorElement]),
    (axes, targets): (Option<Axes>, Targets),
    cx: &mut Context,
) -> Option<(ConnectorDirection, ForceCurve)> {
    let mut rows = card.rows.iter().peekable();
    let is_blank = |row: &Line| row.fields().all(|field| field.is_empty());
    let direction = match kind.form {
        'A' => {
            rows.next_if(is_blank);
            Some(ConnectorDirection::Line)
        }
        _ => (rows.next()).and_then(|row| directions(row, (kind, elements), (axes, targets), cx)),
    };
    let Some(first) = rows.next() else {
        if !card.faulty {
            let message = match kind.form {
                'A' => format!("*{} needs a row with its force", keyword(kind.law)),
                _ => format!(
                    "*{} needs two rows: the direction at each node, and the force",
                    keyword(kind.law)
                ),
            };
            cx.error(Code::MissingData, card.span, message);
        }
        return None;
    };
    let curve = match card.has("NONLINEAR") {
        true => table(first, rows, cx),
        false => linear(first, rows.next(), kind, cx),
    };
    Some((direction?, curve?))
}

/// Reads `direction of node 1, direction of node 2`, along the axes of an orientation or of the instance of the row.
fn directions(
    row: Line,
    (kind, elements): (ConnectorKind, &[&ConnectorElement]),
    (axes, targets): (Option<Axes>, Targets),
    cx: &mut Context,
) -> Option<ConnectorDirection> {
    row.at_most(kind.nodes(), cx.d);
    let axes = axes.unwrap_or_else(|| [[1.0, 0.0], [0.0, 1.0]].map(|axis| cx.turned(axis, row)));
    let mut both = [axes[0]; 2];
    let mut angles = 0;
    for (k, along) in both.iter_mut().take(kind.nodes()).enumerate() {
        let field = row.required(k, "the direction, 1, 2 or 6", cx.d)?;
        match boundary::direction(field, cx)? {
            boundary::Direction::Plane(axis) => *along = axes[axis],
            boundary::Direction::Rotation => {
                angles += 1;
                let mut nodes = elements.iter().filter_map(|element| element.nodes.get(k));
                if let Some(&node) = nodes.find(|&&node| targets.angle_at(node).is_none()) {
                    let message = format!(
                        "node {} has no direction 6: it is no reference node of a rigid body that turns",
                        targets.mesh_index.node_name(node)
                    );
                    cx.error(Code::BadDof, field.span, message);
                    return None;
                }
            }
            boundary::Direction::OutOfPlane => {
                let message = "only directions 1 and 2 lie in the plane, and direction 6 at the reference node \
                               of a rigid body";
                cx.error(Code::BadDof, field.span, message);
                return None;
            }
        }
    }
    if kind.nodes() == 1 {
        both[1] = both[0];
    }
    match angles {
        0 => Some(ConnectorDirection::Fixed(both)),
        _ if angles == kind.nodes() => Some(ConnectorDirection::Angle),
        _ => {
            let message = "an angle and a displacement have no difference";
            cx.error(Code::BadDof, row.span(), message)
                .help("write 6, 6 for a moment between two bodies");
            None
        }
    }
}

/// Reads `k`: the stiffness of springs, the coefficient of dashpots.
fn linear(
    row: Line,
    more: Option<Line>,
    kind: ConnectorKind,
    cx: &mut Context,
) -> Option<ForceCurve> {
    let what = match kind.law {
        ConnectorLaw::Spring => "the stiffness",
        ConnectorLaw::Dashpot => "the coefficient",
    };
    let factor = row.real(0, what, cx.d)?;
    row.at_most(1, cx.d);
    if let Some(more) = more {
        let message = format!("{what} is one number: it depends on nothing");
        cx.error(Code::StrayData, more.span(), message)
            .help("with NONLINEAR rows are force, elongation");
    }
    if factor < 0.0 {
        let message = format!("{what} must not be negative, found {factor}");
        cx.error(Code::MaterialRange, row.span_at(0), message);
        return None;
    }
    Some(ForceCurve::Linear(factor))
}

/// The curve of the rows `force, elongation` or `force, rate of elongation`; the second field increases from row to row.
fn table<'a>(
    first: Line<'a>,
    rest: impl Iterator<Item = Line<'a>>,
    cx: &mut Context,
) -> Option<ForceCurve> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut complete = true;
    for row in std::iter::once(first).chain(rest) {
        row.at_most(2, cx.d);
        let force = row.real(0, "the force", cx.d);
        let at = row.real(1, "the elongation or its rate", cx.d);
        let (Some(force), Some(at)) = (force, at) else {
            complete = false;
            continue;
        };
        if points.last().is_some_and(|[last, _]| at <= *last) {
            let message = "the second field must increase from row to row";
            cx.error(Code::BadNumber, row.span_at(1), message)
                .help("rows are force, elongation: the force comes first");
            return None;
        }
        points.push([at, force]);
    }
    if points.len() == 1 {
        let message = "a table has two rows at least";
        cx.error(Code::MissingData, first.span(), message)
            .help("without NONLINEAR one row gives a factor");
        return None;
    }
    complete.then_some(ForceCurve::Table(points))
}

/// Reports springs and dashpots along a line whose nodes are at one place, because they have no direction.
fn report_short(mesh_index: &MeshIndex, all: &[Option<Connector>], cx: &mut Context) {
    let coordinates = &mesh_index.mesh.coordinates;
    for (element, connector) in mesh_index.connectors.iter().zip(all) {
        if let Some(Connector {
            direction: ConnectorDirection::Line,
            nodes,
            ..
        }) = connector
            && let [a, b] = nodes[..]
            && coordinates[a] == coordinates[b]
        {
            let name = cx.named(element.label);
            let message =
                format!("the nodes of element {name} are at one place: it has no direction");
            cx.error(Code::BadShape, element.span, message)
                .help("a type that ends in 2 acts in a fixed direction");
        }
    }
}
