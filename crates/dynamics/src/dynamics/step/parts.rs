//! Bodies, and parts of bodies with one kind of section: convergence is measured for each body and part
//! (docs/theory/time.md, Convergence).

use std::collections::HashMap;
use std::ops::Range;

use smallvec::{SmallVec, smallvec};

use crate::linear::{Assembled, larger, largest};
use crate::model::{Equation, Model};

/// The bodies of a model and their parts, both numbered from 0.
///
/// A body consists of all that elements and equations connect. Nodes of a body are in one part if the elements around
/// these nodes, and around the nodes of their equations, have the same sections. A light part next to a stiff or heavy
/// part is therefore solved to its own scale, like a light body next to a heavy body.
pub(crate) struct Parts {
    /// Body of every node.
    body: Vec<usize>,
    /// Part of every node.
    part: Vec<usize>,
    /// Body of every part.
    body_of: Vec<usize>,
    bodies: usize,
    /// Runs of the dofs of each body, and of each part.
    runs_of_bodies: Vec<DofRun>,
    runs_of_parts: Vec<DofRun>,
}

/// One value for every body, or every part; up to eight values are stored in place.
pub(crate) type PerBody = SmallVec<[f64; 8]>;

/// Consecutive dofs or unknowns of a body or part.
pub(crate) struct DofRun {
    group: usize,
    places: Range<usize>,
}

impl DofRun {
    /// The runs of all nodes or unknowns with `values` values each; `groups` gives the group of each node or unknown.
    fn all(groups: &[usize], values: usize) -> Vec<DofRun> {
        let mut end = 0;
        let run = |of_group: &[usize]| {
            let start = end;
            end += values * of_group.len();
            DofRun {
                group: of_group[0],
                places: start..end,
            }
        };
        groups.chunk_by(|a, b| a == b).map(run).collect()
    }
}

impl Parts {
    /// Bodies and parts of a model.
    pub fn new(model: &Model) -> Self {
        let sections = sections(model);
        let (mut bodies, mut parts) = (HashMap::new(), HashMap::new());
        let (mut body, mut part, mut body_of) = (Vec::new(), Vec::new(), Vec::new());
        let connected = united(bodies_of(model), &model.equations);
        for (first, sections) in connected.into_iter().zip(sections) {
            let count = bodies.len();
            let number = *bodies.entry(first).or_insert(count);
            body.push(number);
            let count = parts.len();
            let at = *parts.entry((number, sections)).or_insert(count);
            part.push(at);
            if at == count {
                body_of.push(number);
            }
        }
        Parts {
            runs_of_bodies: DofRun::all(&body, 2),
            runs_of_parts: DofRun::all(&part, 2),
            body,
            part,
            body_of,
            bodies: bodies.len(),
        }
    }

    /// Number of bodies.
    pub fn bodies(&self) -> usize {
        self.bodies
    }

    /// Body of every node.
    pub fn of_nodes(&self) -> &[usize] {
        &self.body
    }

    /// Body of every part.
    pub fn of_parts(&self) -> &[usize] {
        &self.body_of
    }

    /// Part of a dof.
    pub fn part(&self, dof: usize) -> usize {
        self.part[dof / 2]
    }

    /// Runs of the unknowns of each part; `dof_of` are their dofs.
    pub fn of_unknowns(&self, dof_of: &[usize]) -> Vec<DofRun> {
        let parts: Vec<usize> = dof_of.iter().map(|&dof| self.part(dof)).collect();
        DofRun::all(&parts, 1)
    }

    /// Largest absolute value in every part; `values` are over the unknowns, and `runs` are the runs of the unknowns.
    pub fn largest_of_unknowns(&self, runs: &[DofRun], values: &[f64]) -> PerBody {
        largest_of(runs, self.body_of.len(), values)
    }

    /// Largest absolute value of some quantities, each given over all dofs, in every part.
    pub fn largest_of_all<'a>(&self, quantities: impl Iterator<Item = &'a [f64]>) -> PerBody {
        let mut most: PerBody = smallvec![0.0; self.body_of.len()];
        quantities.for_each(|values| enlarge(&mut most, &self.runs_of_parts, values));
        most
    }

    /// Largest absolute value of every body; `values` are over all dofs.
    pub fn largest_of_bodies(&self, values: &[f64]) -> PerBody {
        largest_of(&self.runs_of_bodies, self.bodies, values)
    }

    /// Values over all dofs, relative to the largest value of the increment `d` in the body of the dof; zero where this
    /// largest value is zero.
    pub fn beside_increments(&self, d: &[f64], values: &[f64]) -> Vec<f64> {
        let units = self.largest_of_bodies(d);
        let beside = |(dof, value): (usize, &f64)| match units[self.body[dof / 2]] {
            0.0 => 0.0,
            unit => value / unit,
        };
        values.iter().enumerate().map(beside).collect()
    }

    /// Largest diagonal entry of every part; the matrix is over unknowns, with the dofs `dof_of`.
    pub fn largest_diagonal(&self, matrix: &Assembled, dof_of: &[usize]) -> Vec<f64> {
        let mut most = vec![0.0; self.body_of.len()];
        for (&dof, entry) in dof_of.iter().zip(matrix.diagonal()) {
            let most = &mut most[self.part(dof)];
            *most = larger(*most, entry);
        }
        most
    }

    /// The largest of the values of the bodies to which some nodes belong.
    pub fn most(&self, of_bodies: &[f64], nodes: impl Iterator<Item = usize>) -> f64 {
        let of_node = |node: usize| of_bodies[self.body[node]].abs();
        nodes.map(of_node).fold(0.0, larger)
    }
}

/// First node of the body of every node; rigid bodies are included.
fn bodies_of(model: &Model) -> Vec<usize> {
    let mut first = model.mesh.bodies();
    first.extend(first.len()..model.dof_count() / 2);
    for group in rigid_groups(model) {
        unite(&mut first, &group);
    }
    (0..first.len()).map(|node| root(&first, node)).collect()
}

/// The nodes of every rigid body, with its reference node, its centre of mass and its angle.
fn rigid_groups(model: &Model) -> impl Iterator<Item = Vec<usize>> + '_ {
    model.rigid_bodies.iter().map(|body| {
        let centre = model.centre_of(body);
        let others = body.nodes.iter().copied();
        others.chain([body.reference, centre, centre + 1]).collect()
    })
}

/// Numbers of the sections of the elements around every node and around the nodes of its equations, increasing.
fn sections(model: &Model) -> Vec<Vec<usize>> {
    let nodes = model.dof_count() / 2;
    let mut cluster: Vec<usize> = (0..nodes).collect();
    rigid_groups(model).for_each(|group| unite(&mut cluster, &group));
    let cluster = united(cluster, &model.equations);
    let mut sections = vec![Vec::new(); nodes];
    for element in &model.mesh.elements {
        for &node in &element.nodes {
            let sections: &mut Vec<usize> = &mut sections[cluster[node]];
            if let Err(at) = sections.binary_search(&element.section) {
                sections.insert(at, element.section);
            }
        }
    }
    let of_node = |&first: &usize| sections[first].clone();
    cluster.iter().map(of_node).collect()
}

/// First node of the group of every node after equations have united groups; `first` gives the first node of the group
/// before the union.
fn united(mut first: Vec<usize>, equations: &[Equation]) -> Vec<usize> {
    for equation in equations {
        for &(dof, _) in &equation.terms {
            unite(&mut first, &[equation.dof / 2, dof / 2]);
        }
    }
    (0..first.len()).map(|node| root(&first, node)).collect()
}

/// First node of the group of a node.
fn root(first: &[usize], mut node: usize) -> usize {
    while first[node] != node {
        node = first[node];
    }
    node
}

/// Unites the groups of some nodes.
fn unite(first: &mut [usize], nodes: &[usize]) {
    for pair in nodes.windows(2) {
        let [a, b] = [pair[0], pair[1]].map(|node| root(first, node));
        first[a.max(b)] = a.min(b);
    }
}

/// Largest absolute value of every group, given by its runs; `values` are over all dofs.
fn largest_of(runs: &[DofRun], count: usize, values: &[f64]) -> PerBody {
    let mut most = smallvec![0.0; count];
    enlarge(&mut most, runs, values);
    most
}

/// Raises the value of every group to the largest absolute value of the group in `values`, if this value is larger.
fn enlarge(most: &mut [f64], runs: &[DofRun], values: &[f64]) {
    for DofRun { group, places } in runs {
        most[*group] = larger(most[*group], largest(&values[places.clone()]));
    }
}
