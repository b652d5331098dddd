//! `*EQUATION`: linear equations between displacements, sum a_k u_k = 0, solved for their first
//! terms. See docs/theory/contact.md.

use super::boundary::{Direction, Supports, Targets, direction};
use super::context::Context;
use super::couplings::Link;
use super::outline::Outline;
use super::owners::{Constraints, Owner};
use super::rigid_bodies::Rigid;
use crate::deck::{Card, Line, Text};
use crate::diagnostics::{Code, Span};
use crate::model::{Equation, Step, Support};
use std::collections::{BTreeMap, BTreeSet};

/// Number of terms on a data line; each term has three fields.
const TERMS_PER_LINE: usize = 4;

/// Largest ratio of two displacements of an equation, and inverse of the smallest ratio. Stiffness and mass are
/// multiplied by the square of a ratio, and these products must not overflow.
const LARGEST_RATIO: f64 = 1e50;

/// A term of an equation of one node, or of the equations of all nodes of a set.
struct Term {
    /// Nodes of the term; the nodes of a set are in the order of their numbers.
    nodes: Vec<usize>,
    /// Coefficients of the displacements along x and y: one coefficient is zero unless the instance of the row is
    /// turned.
    coefficients: [f64; 2],
    span: Span,
}

impl Term {
    /// Dofs and coefficients of the term in equation number `i`, one for each node of the first term.
    fn at(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let node = self.nodes[if self.nodes.len() == 1 { 0 } else { i }];
        let both = [2 * node, 2 * node + 1].into_iter();
        both.zip(self.coefficients).filter(|(_, c)| *c != 0.0)
    }
}

/// An equation between single dofs, u_dof = sum c_k u_k.
struct SolvedEquation<'a> {
    terms: Vec<(usize, f64)>,
    owner: Owner<'a>,
}

/// Equations by the dofs that they eliminate; each equation has one owner.
type ByDof<'a> = BTreeMap<usize, SolvedEquation<'a>>;

/// Reads all equations with the cards that define them; eliminated dofs in an equation are replaced by their own
/// equations.
pub(crate) fn read<'a>(
    outline: &Outline,
    targets: Targets<'a>,
    (constraints, (supports, steps)): (Constraints<'a>, (&Supports, &[Step])),
    cx: &mut Context,
) -> Vec<(Equation, Owner<'a>)> {
    let mut solved = ByDof::new();
    of_ties(constraints, &mut solved, targets, (supports, steps), cx);
    of_links(constraints.links, &mut solved, targets, steps, cx);
    for cut in constraints.cuts {
        for Equation { dof, terms } in cut.equations() {
            let owner = Owner::Section(cut);
            claim(
                dof,
                SolvedEquation { terms, owner },
                &mut solved,
                targets,
                cx,
            );
        }
    }
    for card in outline.model_cards("EQUATION") {
        let mut rows = card.rows.iter();
        while let Some(row) = rows.next() {
            let Some(terms) = terms(card, row, &mut rows, targets, cx) else {
                break;
            };
            let terms: Option<Vec<Term>> = terms.into_iter().collect();
            if let Some(terms) = terms {
                solve(&terms, &mut solved, targets, cx);
            }
        }
    }
    report_prescribed(&solved, (supports, steps), targets, cx);
    substituted(solved, targets, cx)
}

/// The terms of one equation without the faulty terms; the line `head` holds the number of terms. `None` when it is
/// unclear where the next equation begins.
fn terms<'r>(
    card: &Card,
    head: Line,
    rows: &mut impl Iterator<Item = Line<'r>>,
    targets: Targets,
    cx: &mut Context,
) -> Option<Vec<Option<Term>>> {
    let count = number_of_terms(head, cx)?;
    let (mut terms, mut read) = (Vec::new(), 0);
    while read < count {
        let Some(row) = rows.next() else {
            if !card.faulty && !cx.deck.incomplete {
                let message = format!("an equation of {count} terms ends after {read}");
                cx.error(Code::MissingData, head.span(), message);
            }
            return None;
        };
        let most = TERMS_PER_LINE.min(count - read);
        let on_line = row.fields().count().div_ceil(3).clamp(1, most);
        row.at_most(3 * most, cx.d);
        for k in 0..on_line {
            terms.push(term(row, 3 * k, targets, cx));
        }
        read += on_line;
    }
    Some(terms)
}

/// Reads a row `number of terms`.
fn number_of_terms(row: Line, cx: &mut Context) -> Option<usize> {
    row.at_most(1, cx.d);
    let field = row.required(0, "the number of terms", cx.d)?;
    let count = field.integer(cx.d)?;
    if count < 2 {
        let message = format!("an equation has two terms at least, found {count}");
        cx.error(Code::BadEquation, field.span, message)
            .help("a displacement that is zero is prescribed with *BOUNDARY");
        return None;
    }
    usize::try_from(count).ok()
}

/// Reads a term `node or set, direction, coefficient` from field `first` on.
fn term(row: Line, first: usize, targets: Targets, cx: &mut Context) -> Option<Term> {
    let target = row.required(first, "a node or node set", cx.d);
    let nodes = target.and_then(|field| nodes(field, targets, cx));
    let field = row.required(first + 1, "the direction", cx.d);
    let axis = field.and_then(|field| match direction(field, cx)? {
        Direction::Plane(axis) => Some(axis),
        Direction::Rotation | Direction::OutOfPlane => {
            let message = "only directions 1 and 2 lie in the plane";
            cx.error(Code::BadDof, field.span, message);
            None
        }
    });
    let coefficient = row.real(first + 2, "the coefficient", cx.d);
    let mut direction = [0.0; 2];
    direction[axis?] = coefficient?;
    Some(Term {
        nodes: nodes?,
        coefficients: cx.turned(direction, row),
        span: target?.span,
    })
}

/// The node that a field names, or the nodes of the named set in the order of their numbers.
fn nodes(field: Text, targets: Targets, cx: &mut Context) -> Option<Vec<usize>> {
    let errors = cx.errors();
    let mut nodes = targets.sets.nodes_of(field, targets.mesh_index, cx);
    let labels = &targets.mesh_index.mesh.node_labels;
    nodes.sort_by_key(|&node| labels.get(node));
    if nodes.len() > 1 && targets.sets.is_unsorted(field, cx) {
        let message = format!("the set {} is UNSORTED: its order is not kept", field.text);
        cx.error(Code::BadEquation, field.span, message)
            .help("number its nodes in their order, or write an equation for each");
        return None;
    }
    if nodes.is_empty() && cx.errors() == errors && !cx.may_lack_cards() {
        let message = format!("{} holds no node of an element", field.text);
        cx.error(Code::BadEquation, field.span, message);
    }
    (!nodes.is_empty()).then_some(nodes)
}

/// Adds the equation u_1 = -sum a_k/a_1 u_k for every node of the first term.
fn solve(terms: &[Term], solved: &mut ByDof, targets: Targets, cx: &mut Context) {
    let [first, others @ ..] = terms else { return };
    let count = first.nodes.len();
    if let Some(other) = (others.iter()).find(|term| ![1, count].contains(&term.nodes.len())) {
        let message = format!(
            "the set has {} nodes, that of the first term {count}",
            other.nodes.len()
        );
        cx.error(Code::BadEquation, other.span, message)
            .help("sets of an equation have as many nodes as the first, or are one node");
        return;
    }
    if first.coefficients == [0.0; 2] {
        let message = "the first coefficient is zero";
        cx.error(Code::BadEquation, first.span, message)
            .help("the first term is eliminated: put one with a coefficient first");
        return;
    }
    for i in 0..count {
        let own: Vec<(usize, f64)> = first.at(i).collect();
        let others = others.iter().flat_map(|term| term.at(i));
        let solution = match own[..] {
            [first] => solved_for(first, others.collect()),
            _ => solved_at_node(&own, others, solved),
        };
        let owner = Owner::Equation(first.span);
        match solution {
            Ok((dof, terms)) => claim(dof, SolvedEquation { terms, owner }, solved, targets, cx),
            Err(dof) => {
                let message = format!("{} stands in it again", name(dof, targets));
                cx.error(Code::BadEquation, first.span, message)
                    .help("the first term is eliminated: it stands in the equation once");
            }
        }
    }
}

/// The dependent dof with its terms in other dofs. `Err` holds a dof for which the equation cannot be solved, because
/// this dof stands among the other terms or its terms cancel.
type Solution = Result<(usize, Vec<(usize, f64)>), usize>;

/// Solves an equation for its first dof, which must not stand among the other terms.
fn solved_for((dof, first): (usize, f64), mut others: Vec<(usize, f64)>) -> Solution {
    if others.iter().any(|&(other, _)| other == dof) {
        return Err(dof);
    }
    others.iter_mut().for_each(|term| term.1 /= -first);
    Ok((dof, others))
}

/// Solves an equation for one of the two displacements of a node. Earlier equations are substituted into the equation,
/// and the displacement with the larger coefficient is eliminated. If the other displacement depends on the eliminated
/// one, the result is also substituted in its equation.
fn solved_at_node(
    own: &[(usize, f64)],
    others: impl Iterator<Item = (usize, f64)>,
    solved: &mut ByDof,
) -> Solution {
    let mut row: BTreeMap<usize, f64> = BTreeMap::new();
    for (dof, c) in own.iter().copied().chain(others) {
        *row.entry(dof).or_insert(0.0) += c;
    }
    let is_known = |dof: &usize| solved.contains_key(dof);
    if !own.iter().all(|(dof, _)| is_known(dof)) {
        for &(dof, _) in own {
            if let Some(known) = solved.get(&dof)
                && let Some(c) = row.remove(&dof)
            {
                for &(to, ck) in &known.terms {
                    *row.entry(to).or_insert(0.0) += c * ck;
                }
            }
        }
    }
    let size = |dof: usize| row.get(&dof).map_or(0.0, |c| c.abs());
    let dofs = own.iter().map(|&(dof, _)| dof);
    let pivot = dofs.fold(own[0].0, |best, dof| match size(dof) > size(best) {
        true => dof,
        false => best,
    });
    let Some(first) = row.remove(&pivot).filter(|c| *c != 0.0) else {
        return Err(pivot);
    };
    let terms: Vec<(usize, f64)> = row.into_iter().map(|(to, c)| (to, -c / first)).collect();
    for &(dof, _) in own {
        let Some(known) = solved.get_mut(&dof).filter(|_| dof != pivot) else {
            continue;
        };
        if let Some(at) = known.terms.iter().position(|term| term.0 == pivot) {
            let (_, c) = known.terms.swap_remove(at);
            known
                .terms
                .extend(terms.iter().map(|&(to, ck)| (to, c * ck)));
        }
    }
    Ok((pivot, terms))
}

/// Enters an equation; reports a dof that the equation of another card also eliminates.
fn claim<'a>(
    dof: usize,
    equation: SolvedEquation<'a>,
    solved: &mut ByDof<'a>,
    targets: Targets,
    cx: &mut Context,
) {
    let own = equation.owner;
    let Some(SolvedEquation { owner: other, .. }) = solved.insert(dof, equation) else {
        return;
    };
    let (dof, first, second) = (name(dof, targets), other.title(), own.title());
    let message = format!("{dof} follows other nodes twice: by {first} and by {second}");
    own.contradicts(other, message, cx).help(match own {
        Owner::Equation(_) => "put another term first",
        _ => "a displacement follows by one card: take the node out of one of the two",
    });
}

/// Adds the equations of the tied nodes.
fn of_ties<'a>(
    of: Constraints<'a>,
    solved: &mut ByDof<'a>,
    targets: Targets,
    (supports, steps): (&Supports, &[Step]),
    cx: &mut Context,
) {
    for (tie, &span) in of.ties.all.iter().zip(&of.ties.spans) {
        let owner = Owner::Tie(tie, span);
        let mut held = Vec::new();
        // a support, the master itself or an earlier tie decides where the other nodes of its sides go
        let mut follow = [BTreeSet::new(), BTreeSet::new()];
        for (tied, direction) in tie.nodes.iter().flat_map(|tied| [(tied, 0), (tied, 1)]) {
            let Equation { dof, terms } = tied.equation(direction);
            match tied_and_prescribed(dof, &terms, steps) {
                PrescribedDof::Not => {
                    follow[direction].insert(tied.node);
                }
                PrescribedDof::Alike => {}
                PrescribedDof::Otherwise => held.push(dof),
            }
        }
        for (direction, follow) in follow.iter().enumerate() {
            for Equation { dof, terms } in tie.equations(direction, |node| !follow.contains(&node))
            {
                if follow.contains(&(dof / 2)) {
                    claim(dof, SolvedEquation { terms, owner }, solved, targets, cx);
                }
            }
        }
        if let Some(&dof) = held.first() {
            let message = format!(
                "{} follows the master of {} and is prescribed",
                name(dof, targets),
                tie.name
            );
            let others = match held.len() - 1 {
                0 => String::new(),
                others => format!("so are {others} more directions of tied nodes; "),
            };
            let mut error = cx.error(Code::Tie, span, message);
            if let Some(other) = holder(dof, supports, targets) {
                error = error.other(other.title(), other.span());
            }
            error.help(format!(
                "{others}prescribe the nodes of the master there alike, exchange slave and master, or leave the node \
                 out with TIED NSET="
            ));
        }
    }
}

/// Adds the equations of nodes that are joined, and of reference nodes that follow the mean of other nodes.
fn of_links<'a>(
    links: &'a [Link],
    solved: &mut ByDof<'a>,
    targets: Targets,
    steps: &[Step],
    cx: &mut Context,
) {
    let is_prescribed = |dof: usize| steps.iter().any(|step| step.motion_of(dof).is_some());
    for link in links {
        for direction in 0..2 {
            let at = |node: &usize| 2 * node + direction;
            let (mut dof, mut terms) = match link {
                Link::Joined { node, to, .. } => (at(node), vec![(at(to), 1.0)]),
                Link::Mean { node, of, .. } => {
                    let weight = 1.0 / of.len() as f64;
                    let terms = of.iter().map(|other| (at(other), weight));
                    (at(node), terms.collect::<Vec<_>>())
                }
                Link::Hinge { .. } => continue,
            };
            if let PrescribedDof::Alike = tied_and_prescribed(dof, &terms, steps) {
                continue;
            }
            // a support holds the term that follows: the first that can be eliminated in its place
            let is_taken = |dof: usize| is_prescribed(dof) || solved.contains_key(&dof);
            if is_taken(dof)
                && let Some(index) = terms.iter().position(|term| !is_taken(term.0))
            {
                let (first, weight) = terms[index];
                terms.iter_mut().for_each(|term| term.1 /= -weight);
                terms[index] = (dof, 1.0 / weight);
                dof = first;
            }
            let owner = Owner::Link(link);
            claim(dof, SolvedEquation { terms, owner }, solved, targets, cx);
        }
    }
}

/// Relation of the support of a tied dof to the supports of the master.
enum PrescribedDof {
    Not,
    /// The dof is prescribed in the same way as the dofs of the master in the same direction, so that its support
    /// replaces the tie.
    Alike,
    Otherwise,
}

/// Relation of the support of a tied dof to the supports of the dofs that it follows in the same direction, compared in
/// all steps.
fn tied_and_prescribed(dof: usize, terms: &[(usize, f64)], steps: &[Step]) -> PrescribedDof {
    let same_direction = || terms.iter().filter(|(to, _)| to % 2 == dof % 2);
    if steps.iter().all(|step| step.motion_of(dof).is_none()) {
        return PrescribedDof::Not;
    }
    let alike = steps.iter().all(|step| {
        let own = step.motion_of(dof);
        own.is_some() && same_direction().all(|(to, _)| step.motion_of(*to) == own)
    });
    if alike {
        PrescribedDof::Alike
    } else {
        PrescribedDof::Otherwise
    }
}

/// Name of the dof in the words of the deck.
fn name(dof: usize, targets: Targets) -> String {
    let name = targets.mesh_index.node_name(dof / 2);
    format!("direction {} of node {name}", dof % 2 + 1)
}

/// The card that prescribes a dof: a support, or the body with which the dof moves.
fn holder<'a>(dof: usize, supports: &Supports, targets: Targets<'a>) -> Option<Owner<'a>> {
    let rides = |body: &&Rigid| body.has(dof / 2);
    match supports.place(dof) {
        Some(span) => Some(Owner::Support(span)),
        None => targets.rigid_bodies.iter().find(rides).map(Owner::Body),
    }
}

/// Reports eliminated dofs that are also prescribed.
fn report_prescribed(
    solved: &ByDof,
    (places, steps): (&Supports, &[Step]),
    targets: Targets,
    cx: &mut Context,
) {
    let supports = steps.iter().flat_map(|step| &step.supports);
    let prescribed: BTreeSet<usize> = supports.map(|support| support.dof).collect();
    for (dof, equation) in solved.iter().filter(|(dof, _)| prescribed.contains(dof)) {
        let other = holder(*dof, places, targets);
        let (dof, own) = (name(*dof, targets), equation.owner);
        let by = match own {
            Owner::Equation(_) => "an equation".to_owned(),
            own => own.title(),
        };
        let message = format!("{dof} is eliminated by {by} and prescribed");
        let help = match own {
            Owner::Equation(_) => "put a term first that is not prescribed",
            _ => "prescribe the nodes that it follows",
        };
        let error = match other {
            Some(other) => own.contradicts(other, message, cx),
            None => cx.error(own.code(), own.span(), message),
        };
        error.help(help);
    }
}

/// All equations with the cards that own them. Eliminated dofs among the terms are replaced by their own equations, so
/// that all remaining terms are independent.
fn substituted<'a>(
    mut solved: ByDof<'a>,
    targets: Targets,
    cx: &mut Context,
) -> Vec<(Equation, Owner<'a>)> {
    let mut equations = BTreeMap::new();
    for dof in elimination_order(&solved) {
        let Some(SolvedEquation { terms: own, owner }) = solved.remove(&dof) else {
            continue;
        };
        let mut terms = BTreeMap::new();
        for (to, c) in own {
            let direct = [(to, 1.0)];
            let of = match equations.get(&to) {
                Some((Equation { terms, .. }, _)) => terms.as_slice(),
                None => &direct,
            };
            for &(k, ck) in of {
                *terms.entry(k).or_insert(0.0) += c * ck;
            }
        }
        let terms: Vec<(usize, f64)> = terms.into_iter().filter(|(_, c)| *c != 0.0).collect();
        report_ratios(dof, &terms, owner.span(), targets, cx);
        equations.insert(dof, (Equation { dof, terms }, owner));
    }
    if let Some((&dof, equation)) = solved.first_key_value() {
        let own = equation.owner;
        let mut terms = equation.terms.iter();
        let next = terms
            .find_map(|(to, _)| solved.get(to))
            .map(|next| next.owner);
        let other = next.unwrap_or(own);
        let (dof, first, second) = (name(dof, targets), own.title(), other.title());
        let message = format!(
            "equations eliminate {dof} in a circle: {first} makes it follow what follows by {second}"
        );
        own.contradicts(other, message, cx)
            .help("put a term first that no other of these equations eliminates, or leave out what says the same");
    }
    equations.into_values().collect()
}

/// Reports a displacement that would follow another displacement in a ratio that is too large or too small to be
/// computed with.
fn report_ratios(
    dof: usize,
    terms: &[(usize, f64)],
    span: Span,
    targets: Targets,
    cx: &mut Context,
) {
    let reach = 1.0 / LARGEST_RATIO..=LARGEST_RATIO;
    if let Some((to, c)) = terms.iter().find(|(_, c)| !reach.contains(&c.abs())) {
        let (dof, to) = (name(dof, targets), name(*to, targets));
        let message = format!("{dof} follows {to} {c:e}-fold: it cannot be computed with");
        cx.error(Code::BadEquation, span, message)
            .help("leave out terms without effect; coefficients in a ratio beyond 1e50 are none");
    }
}

/// The eliminated dofs, each behind the dofs on which it depends; dofs that depend on themselves are left out.
fn elimination_order(solved: &ByDof) -> Vec<usize> {
    let mut users: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let mut open: BTreeMap<usize, usize> = BTreeMap::new();
    for (&dof, equation) in solved {
        let eliminated = equation.terms.iter().map(|term| term.0);
        let eliminated = eliminated.filter(|to| solved.contains_key(to));
        let count = open.entry(dof).or_insert(0);
        for to in eliminated {
            users.entry(to).or_default().push(dof);
            *count += 1;
        }
    }
    let is_ready = |(dof, count): (&usize, &usize)| (*count == 0).then_some(*dof);
    let mut order: Vec<usize> = open.iter().filter_map(is_ready).collect();
    let mut next = 0;
    while let Some(dof) = order.get(next) {
        for user in users.remove(dof).unwrap_or_default() {
            if let Some(count) = open.get_mut(&user) {
                *count -= 1;
                if *count == 0 {
                    order.push(user);
                }
            }
        }
        next += 1;
    }
    order
}

/// Warns where the deck gives an eliminated dof a velocity (`2 N` entries) that differs from the velocity implied by
/// its equation; `supports` prescribe velocities.
pub(crate) fn check_velocities(
    equations: &[(Equation, Owner)],
    velocity: &[f64],
    supports: &[Support],
    targets: Targets,
    cx: &mut Context,
) {
    let of = |dof: usize| velocity.get(dof).copied().unwrap_or(0.0);
    let is_prescribed = |dof: usize| supports.iter().any(|support| support.dof == dof);
    for (Equation { dof, terms }, owner) in equations.iter().filter(|(e, _)| of(e.dof) != 0.0) {
        if terms.iter().any(|term| is_prescribed(term.0)) {
            continue;
        }
        let parts = terms.iter().map(|&(to, c)| c * of(to));
        let (sum, size) = parts.fold((0.0, of(*dof).abs()), |(sum, size), part| {
            (sum + part, size + part.abs())
        });
        if (sum - of(*dof)).abs() > Equation::ROUND_OFF * size {
            let message = format!("{} does not start with its velocity", name(*dof, targets));
            cx.warning(Code::BadEquation, owner.span(), message)
                .help("it starts with what follows from the other terms");
        }
    }
}
