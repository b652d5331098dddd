//! Redistribution of the mass of contact surfaces: nodes without mass, and the nodes that carry their mass; velocities
//! satisfy V = P V. See docs/theory/elements.md, Redistributed mass.
//!
//! With `LANDING=RETURN` a bar of 50 elements that hits a wall keeps 1.0000 of its energy if its mass is redistributed,
//! and 0.994 if the mass stays at the surface (docs/impact.md).

use std::collections::{BTreeSet, HashMap};
use std::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3};

use crate::contact::ContactSurfaces;
use crate::model::{ElementsAtNodes, Face, Mesh, Model};
use crate::vectors::{angle, difference, length, polygon_area};

/// Numbers of rings of elements round a node in which its donors are sought: the larger number is used if the smaller
/// number is not sufficient.
const RINGS: [usize; 2] = [2, 3];

/// A node with its weight in the velocity of another node.
type Donor = (usize, f64);

/// The redistribution P of the mass of contact surfaces: nodes without mass, whose velocities in the kinetic energy
/// follow from the velocities of their donors, v_i = sum w_ij v_j, eq. (2.17). The redistribution is empty with
/// `CONTACT MASS=CONSISTENT`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Redistribution {
    /// Nodes without mass, increasing, with their donors, which have mass.
    massless: Vec<(usize, Vec<Donor>)>,
    /// Nodes of contact surfaces that keep their mass, increasing.
    kept: Vec<usize>,
}

impl Redistribution {
    /// The redistribution of the mass at the given contacts of a model.
    ///
    /// Donors are nodes that cannot be without mass. Nodes without suitable weights keep their mass and become donors,
    /// until all other nodes have weights; the result does not depend on the order of the nodes.
    pub fn new(model: &Model, contacts: &[ContactSurfaces]) -> Self {
        let around = Neighbours::new(&model.mesh);
        let nodes = contact_nodes(model, contacts);
        let may_be = |&(node, may): &(usize, bool)| may.then_some(node);
        let mut massless: Vec<usize> = nodes.iter().filter_map(may_be).collect();
        loop {
            let find = |&node: &usize| Some((node, around.donors(node, &massless)?));
            let found: Vec<(usize, Vec<Donor>)> = massless.iter().filter_map(find).collect();
            if found.len() == massless.len() {
                let has_mass = |node: &usize| massless.binary_search(node).is_err();
                return Redistribution {
                    kept: nodes.iter().map(|n| n.0).filter(has_mass).collect(),
                    massless: found,
                };
            }
            massless = found.iter().map(|found| found.0).collect();
        }
    }

    /// Nodes without mass, increasing.
    pub fn massless(&self) -> impl ExactSizeIterator<Item = usize> + '_ {
        self.massless.iter().map(|(node, _)| *node)
    }

    /// Nodes of contact surfaces that keep their mass, increasing.
    pub fn kept(&self) -> &[usize] {
        &self.kept
    }

    /// Whether every node keeps its mass.
    pub fn is_empty(&self) -> bool {
        self.massless.is_empty()
    }

    /// Whether a node is without mass.
    pub fn is_massless(&self, node: usize) -> bool {
        self.donors(node).is_some()
    }

    /// The donors of a node without mass, with their weights.
    pub fn donors(&self, node: usize) -> Option<&[Donor]> {
        let place = self.massless.binary_search_by_key(&node, |(node, _)| *node);
        place.ok().map(|place| self.massless[place].1.as_slice())
    }

    /// Replaces velocities v over all dofs by P v, at those dofs for which `moves` is true.
    pub fn follow(&self, v: &mut [f64], moves: impl Fn(usize) -> bool) {
        for (node, donors) in &self.massless {
            for i in 0..2 {
                let dof = 2 * node + i;
                if moves(dof) {
                    v[dof] = donors.iter().map(|(j, w)| w * v[2 * j + i]).sum();
                }
            }
        }
    }

    /// Calls `add(dof, force)` with the parts of a force that acts on the mass of a node.
    pub fn hand_out(&self, node: usize, force: [f64; 2], mut add: impl FnMut(usize, f64)) {
        let own = [(node, 1.0)];
        for (j, w) in self.donors(node).unwrap_or(&own) {
            add(2 * j, w * force[0]);
            add(2 * j + 1, w * force[1]);
        }
    }

    /// Replaces forces f over all dofs by P^T f.
    pub fn hand_on(&self, f: &mut [f64]) {
        for (node, donors) in &self.massless {
            for i in 0..2 {
                let force = std::mem::take(&mut f[2 * node + i]);
                for (j, w) in donors {
                    f[2 * j + i] += w * force;
                }
            }
        }
    }
}

/// Elements round every node.
struct Neighbours<'m> {
    mesh: &'m Mesh,
    elements: ElementsAtNodes,
}

impl<'m> Neighbours<'m> {
    fn new(mesh: &'m Mesh) -> Self {
        let elements = ElementsAtNodes::new(mesh);
        Neighbours { mesh, elements }
    }

    /// Donors of a node, with their weights, among the nodes that are not in `massless`
    /// (increasing).
    fn donors(&self, node: usize, massless: &[usize]) -> Option<Vec<Donor>> {
        let x = &self.mesh.coordinates;
        RINGS.iter().find_map(|&rings| {
            let has_mass = |node: &usize| massless.binary_search(node).is_err();
            let near: Vec<usize> = self
                .within(node, rings)
                .into_iter()
                .filter(has_mass)
                .collect();
            let at: Vec<[f64; 2]> = near.iter().map(|&donor| x[donor]).collect();
            let weights = weights(x[node], &at)?;
            Some(near.into_iter().zip(weights).collect())
        })
    }

    /// Nodes within some rings of elements round a node, increasing.
    fn within(&self, node: usize, rings: usize) -> Vec<usize> {
        let mut nodes = vec![node];
        for _ in 0..rings {
            let elements = nodes.iter().flat_map(|&node| self.elements.of(node));
            let of_element = |element: usize| &self.mesh.elements[element].nodes;
            nodes = elements.flat_map(of_element).copied().collect();
            nodes.sort_unstable();
            nodes.dedup();
        }
        nodes
    }
}

/// Nodes of the contact surfaces of deformable bodies, increasing; each is marked if it may be without mass. Nodes at
/// the edge of a hole may not be without mass, nor may nodes in equations, springs, dashpots or rigid bodies.
pub(super) fn contact_nodes(model: &Model, contacts: &[ContactSurfaces]) -> Vec<(usize, bool)> {
    let mesh = &model.mesh;
    let mut may = outer_nodes(mesh);
    let equations = model.equations.iter().flat_map(|equation| equation.dofs());
    let connectors = model
        .connectors
        .iter()
        .flat_map(|connector| &connector.nodes);
    for node in equations.map(|dof| dof / 2).chain(connectors.copied()) {
        if let Some(may) = &mut may[node] {
            *may = false;
        }
    }
    // nodes that turn with a rigid body keep the mass of the elements that deform, which is their only mass
    let mut deforms = vec![false; mesh.node_count()];
    let rigid: BTreeSet<usize> = (model.rigid_bodies.iter())
        .flat_map(|body| body.elements.iter().copied())
        .collect();
    let elements = mesh.elements.iter().enumerate();
    for (_, element) in elements.filter(|(index, _)| !rigid.contains(index)) {
        element.nodes.iter().for_each(|&node| deforms[node] = true);
    }
    for body in &model.rigid_bodies {
        for &node in body.nodes.iter().chain([&body.reference]) {
            may[node] = may[node].filter(|_| deforms[node]).map(|_| false);
        }
    }
    let of_contact = |contact: &ContactSurfaces| {
        let masters = contact.segments.as_flattened().to_vec();
        contact
            .slaves
            .iter()
            .copied()
            .chain(masters)
            .collect::<Vec<_>>()
    };
    let mut nodes: Vec<usize> = contacts.iter().flat_map(of_contact).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let on_body = |node: usize| Some((node, may[node]?));
    nodes.into_iter().filter_map(on_body).collect()
}

/// For every node of an exterior face, whether the node lies only on outer edges of bodies; `None` for nodes inside a
/// body and for nodes without elements.
fn outer_nodes(mesh: &Mesh) -> Vec<Option<bool>> {
    let mut outer = vec![None; mesh.node_count()];
    for edge in edges(mesh) {
        let x = |node: usize| mesh.coordinates[node];
        // the area within a closed edge, negative round a hole: the body is on the left
        let area = polygon_area(edge.iter().map(|&[a, _]| x(a)));
        for &[a, _] in &edge {
            outer[a] = Some(area > 0.0 && outer[a] != Some(false));
        }
    }
    outer
}

/// Closed edges of the bodies, each as its faces in order. If elements meet in only a node, the edge continues along
/// the element along which it came to the node.
fn edges(mesh: &Mesh) -> Vec<Vec<[usize; 2]>> {
    let segments = |face: &Face| face.segments(mesh);
    let faces: Vec<[usize; 2]> = mesh.outline().iter().flat_map(segments).collect();
    let mut starting: HashMap<usize, Vec<usize>> = HashMap::new();
    for (face, &[a, _]) in faces.iter().enumerate() {
        starting.entry(a).or_default().push(face);
    }
    let mut is_left = vec![true; faces.len()];
    let mut edges = Vec::new();
    for first in 0..faces.len() {
        let mut edge = Vec::new();
        let mut next = Some(first).filter(|&face| is_left[face]);
        while let Some(face) = next {
            is_left[face] = false;
            let [a, b] = faces[face];
            edge.push([a, b]);
            // the edge goes on along the face from b that comes first clockwise from the face back
            // to a
            let arm = |node: usize| difference(mesh.coordinates[b], mesh.coordinates[node]);
            let clockwise = |&face: &usize| match angle(arm(faces[face][1]), arm(a)) {
                turn if turn > 0.0 => turn,
                turn => turn + TAU,
            };
            let going_on = starting.get(&b).into_iter().flatten().copied();
            let nearest = going_on.min_by(|p, q| clockwise(p).total_cmp(&clockwise(q)));
            next = nearest.filter(|&face| is_left[face]);
        }
        if !edge.is_empty() {
            edges.push(edge);
        }
    }
    edges
}

/// Least number of donors: three points determine an affine function.
const LEAST_DONORS: usize = 3;
/// Largest sum of |w|; a node whose weights have a larger sum is not extrapolated from its donors. Weights of regular
/// meshes are ratios of small integers with sums up to 6; sums slightly above 6 do not occur in such meshes.
const MOST_WEIGHT: f64 = 6.0 + 1e-6;
/// Least width of the donors, relative to their length: narrower donors lie on a line up to the digits of their
/// coordinates.
const LEAST_WIDTH: f64 = 1e-3;

/// Weights of donors at the positions `donors` for a node at `x`; the weights reproduce affine functions, and are
/// larger for nearer donors:
///
/// ```text
/// p_j = (1, (X_j - X)/h),  phi_j = (h/r_j)²,  r_j = |X_j - X|,  h = min r_j
/// w_j = phi_j p_j.G^-1 e1,  G = sum phi_j p_j p_j^T                           eq. (2.18)
/// ```
///
/// The weights w_j of donors at X_j for a node at X satisfy sum w_j = 1 and sum w_j X_j = X. `None` if the donors are
/// too few, lie nearly on a line, or lie only on one side far away. Neither a rigid motion of all points nor their
/// order changes the weights.
pub(super) fn weights(x: [f64; 2], donors: &[[f64; 2]]) -> Option<Vec<f64>> {
    if donors.len() < LEAST_DONORS {
        return None;
    }
    let arms: Vec<[f64; 2]> = donors.iter().map(|&donor| difference(x, donor)).collect();
    let h = arms
        .iter()
        .map(|&r| length(r))
        .fold(f64::INFINITY, f64::min);
    let p = |r: &[f64; 2]| Vector3::new(1.0, r[0] / h, r[1] / h);
    let phi = |r: &[f64; 2]| (h / length(*r)).powi(2);
    let g: Matrix3<f64> = arms.iter().map(|r| phi(r) * p(r) * p(r).transpose()).sum();
    if width(&g) < LEAST_WIDTH {
        return None;
    }
    let cholesky = g.cholesky()?;
    let mut w = vec![0.0; arms.len()];
    // the second solve corrects the round-off in sum w p = e1
    for _ in 0..2 {
        let sum: Vector3<f64> = arms.iter().zip(&w).map(|(r, w)| *w * p(r)).sum();
        let solution = cholesky.solve(&(Vector3::x() - sum));
        for (w, r) in w.iter_mut().zip(&arms) {
            *w += phi(r) * p(r).dot(&solution);
        }
    }
    let size: f64 = w.iter().map(|w| w.abs()).sum();
    (size <= MOST_WEIGHT).then_some(w)
}

/// Width of the donors relative to their length. The scatter of the arms about their mean is the Schur complement of
/// G_11,
///
/// ```text
/// S = G_rr - G_r1 G_1r/G_11,  (width/length)² = det S/(tr S)²                 eq. (2.19)
/// ```
///
/// The width of the donors is NaN if all donors are in one place.
fn width(g: &Matrix3<f64>) -> f64 {
    let scatter = |i: usize, k: usize| g[(i, k)] - g[(i, 0)] * g[(0, k)] / g[(0, 0)];
    let [xx, xy, yy] = [scatter(1, 1), scatter(1, 2), scatter(2, 2)];
    let (trace, determinant) = (xx + yy, xx * yy - xy * xy);
    (determinant / (trace * trace)).max(0.0).sqrt()
}

#[cfg(test)]
mod tests_of_weights {
    use super::*;

    /// Points of a bent grid, multiplied by `scale`.
    fn grid(scale: f64) -> Vec<[f64; 2]> {
        let at = |k: u32| (f64::from(k % 5), f64::from(k / 5));
        let bent =
            |(i, j): (f64, f64)| [i + 0.2 * (1.3 * j).sin(), 1.0 + j + 0.3 * (0.9 * i).cos()];
        let points = (0..15).map(|k| bent(at(k)));
        points.map(|p| p.map(|x| scale * x)).collect()
    }

    #[test]
    fn affine_functions_are_exact() {
        for scale in [1e-3, 1.0, 1e5] {
            let (x, donors) = ([2.1 * scale, 0.2 * scale], grid(scale));
            let w = weights(x, &donors).expect("weights");
            let sum: f64 = w.iter().sum();
            assert!((sum - 1.0).abs() < 1e-15, "{sum}");
            for (i, own) in x.iter().enumerate() {
                let sum: f64 = w.iter().zip(&donors).map(|(w, x)| w * x[i]).sum();
                assert!((sum - own).abs() < 4e-15 * scale, "{sum} {own}");
            }
        }
    }

    #[test]
    fn by_hand_between_three_nodes() {
        // three points have one affine function: a node at the middle of two takes half of each
        let w = weights([0.5, 0.0], &[[0.0, 0.0], [1.0, 0.0], [0.3, 1.0]]).expect("weights");
        for (w, expected) in w.iter().zip([0.5, 0.5, 0.0]) {
            assert!((w - expected).abs() < 1e-15, "{w}");
        }
    }

    #[test]
    fn too_few_donors_a_line_and_far_extrapolation_give_none() {
        let line: Vec<[f64; 2]> = (0..6).map(|k| [f64::from(k), 0.5]).collect();
        assert_eq!(weights([2.0, 0.0], &line[..2]), None);
        assert_eq!(weights([2.0, 0.0], &line), None);
        let thin: Vec<[f64; 2]> = (0..6)
            .map(|k| [f64::from(k), 0.5 + 0.1 * f64::from(k % 2)])
            .collect();
        assert_eq!(weights([2.0, 0.0], &thin), None);
        assert!(weights([2.0, 0.4], &thin).is_some());
    }

    /// Points turned by an angle, mirrored if `mirror` is -1, and moved.
    fn moved(points: &[[f64; 2]], angle: f64, mirror: f64, to: [f64; 2]) -> Vec<[f64; 2]> {
        let (sin, cos) = angle.sin_cos();
        let turn = |[x, y]: [f64; 2]| [cos * x - sin * y, mirror * (sin * x + cos * y)];
        let points = points.iter().map(|&point| turn(point));
        points
            .map(|[x, y]| [x + to[0], mirror * y + to[1]])
            .collect()
    }

    proptest::proptest! {
        /// A node on or near the line of its donors keeps its mass, wherever the line lies and whatever the last digits
        /// of the coordinates are. If the layer of elements has a usable thickness, the node gives its mass up.
        #[test]
        fn donors_nearly_on_a_line_give_none_in_any_frame(
            angle in -4.0..4.0_f64,
            mirrored in proptest::bool::ANY,
            to in [-1e3..1e3_f64, -1e3..1e3_f64],
            beside in -1e-5..1e-5_f64,
            noise in proptest::collection::vec(-1e-5..1e-5_f64, 7),
        ) {
            let at = |k: usize, y: f64| [0.6 * k as f64, y];
            let line = noise.iter().enumerate().map(|(k, &y)| at(k, y));
            let mut points: Vec<[f64; 2]> = line.collect();
            points.push([-0.6, beside]);
            let mirror = if mirrored { -1.0 } else { 1.0 };
            let points = moved(&points, angle, mirror, to);
            proptest::prop_assert_eq!(weights(points[7], &points[..7]), None);
            proptest::prop_assert_eq!(weights(points[6], &points[..6]), None);

            // two rows of elements 50 times as long as high
            let rows: Vec<[f64; 2]> = (0..10).map(|k| at(k / 2, 0.012 * (1 + k % 2) as f64)).collect();
            let mut points = rows.clone();
            points.push([1.2, 0.0]);
            let points = moved(&points, angle, mirror, to);
            let expected = weights([1.2, 0.0], &rows).expect("weights");
            let found = weights(points[10], &points[..10]).expect("weights");
            for (found, expected) in found.iter().zip(expected) {
                proptest::prop_assert!((found - expected).abs() < 1e-6, "{found} {expected}");
            }
        }
    }

    #[test]
    fn a_sum_of_weights_at_the_limit_is_within_it() {
        // a node at the distance 5/2 of two rows of donors has the weights 7/2 and -5/2 of a row
        let rows = |by: f64| -> Vec<[f64; 2]> {
            let row = |y: f64| [-1.0, 0.0, 1.0].map(|x| [0.1 * x, y]);
            [row(2.5 + by), row(3.5 + by)].concat()
        };
        for angle in [0.0, 0.3, 1.0, 2.0, 3.0, 4.0, 5.0] {
            for (by, expected) in [(0.0, true), (1e-3, false)] {
                let points = moved(&rows(by), angle, 1.0, [7.0, -3.0]);
                let node = moved(&[[0.0; 2]], angle, 1.0, [7.0, -3.0])[0];
                assert_eq!(weights(node, &points).is_some(), expected, "{angle} {by}");
            }
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    //! Tests which nodes of irregular meshes are without mass.

    use super::Redistribution;
    use crate::contact::contact_surfaces;
    use crate::materials::Law;
    use crate::model::{
        Contact, Element, ElementType, Equation, Interaction, Model, Surface, SurfaceKind,
    };

    /// A bent block of cells of two sizes, each a quadrilateral or two triangles, in contact with itself all round;
    /// `has` tells which cells exist.
    pub(crate) fn block(
        [columns, rows]: [usize; 2],
        is_triangular: fn(usize, usize) -> bool,
        has: fn(usize, usize) -> bool,
    ) -> Model {
        let mut model = Model::default();
        let place = |k: usize| ((k % (columns + 1)) as f64, (k / (columns + 1)) as f64);
        let bent = |(i, j): (f64, f64)| {
            let (a, b) = (3.7 * i + 1.9 * j, 2.3 * i - 4.1 * j);
            [
                i + 0.12 * a.sin() + 0.05 * j * j,
                0.7 * j + 0.1 * b.cos() - 0.02 * i * i,
            ]
        };
        let nodes = (columns + 1) * (rows + 1);
        model.mesh.coordinates = (0..nodes).map(|k| bent(place(k))).collect();
        model.mesh.node_labels = (1..=nodes as u64).collect();
        for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
            let a = j * (columns + 1) + i;
            let [b, c, d] = [a + 1, a + columns + 2, a + columns + 1];
            let cell = match is_triangular(i, j) {
                true => vec![vec![a, b, c], vec![a, c, d]],
                false => vec![vec![a, b, c, d]],
            };
            let cells = cell.into_iter().filter(|_| has(i, j));
            model.mesh.elements.extend(cells.map(|nodes| Element {
                label: 1,
                element_type: match nodes.len() {
                    3 => ElementType::CPE3,
                    _ => ElementType::CPE4,
                },
                nodes: nodes.into(),
                section: 0,
            }));
        }
        model.add_section(Law::elastic(100.0, 0.3), 1.3, 2.0);
        model.surfaces.push(Surface {
            name: "SKIN".into(),
            kind: SurfaceKind::Faces(model.mesh.exterior_faces()),
        });
        model
            .contacts
            .push(Contact::new([0, 0], Interaction::default()));
        model
    }

    /// Redistribution of the mass of a model.
    pub(crate) fn redistribution(model: &Model) -> Redistribution {
        Redistribution::new(model, &contact_surfaces(model, &model.mesh.bodies()))
    }

    fn massless(model: &Model) -> Vec<usize> {
        redistribution(model).massless().collect()
    }

    const MIXED: fn(usize, usize) -> bool = |i, j| (i + j) % 3 == 0;
    const ALL: fn(usize, usize) -> bool = |_, _| true;

    #[test]
    fn the_skin_of_a_thick_block_is_without_mass() {
        for is_triangular in [|_, _| false, |_, _| true, MIXED] {
            let found = massless(&block([7, 6], is_triangular, ALL));
            let skin = |k: usize| [0, 7].contains(&(k % 8)) || !(8..48).contains(&k);
            assert_eq!(found, (0..56).filter(|&k| skin(k)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn weights_are_affine_and_donors_have_mass() {
        let model = block([7, 6], MIXED, ALL);
        let redistribution = redistribution(&model);
        let x = &model.mesh.coordinates;
        for node in redistribution.massless() {
            let donors = redistribution.donors(node).expect("donors");
            assert!(
                donors
                    .iter()
                    .all(|(donor, _)| !redistribution.is_massless(*donor))
            );
            for (i, own) in x[node].iter().enumerate() {
                let sum: f64 = donors.iter().map(|(donor, w)| w * x[*donor][i]).sum();
                assert!((sum - own).abs() < 1e-14, "{node}: {sum}");
            }
        }
    }

    #[test]
    fn holes_thin_layers_and_tied_nodes_keep_their_mass() {
        // the edge of the hole of cells 3 to 5 in both directions
        let model = block([9, 9], MIXED, |i, j| {
            !((3..6).contains(&i) && (3..6).contains(&j))
        });
        let hole = |k: &usize| (3..=6).contains(&(k % 10)) && (3..=6).contains(&(k / 10));
        let found = redistribution(&model);
        let kept: Vec<usize> = (0..100)
            .filter(hole)
            .filter(|k| ![44, 45, 54, 55].contains(k))
            .collect();
        assert_eq!(found.kept(), kept);
        assert_eq!(found.massless().len(), 36);
        // one layer has no donors, two have donors on a line
        for rows in [1, 2] {
            let mut model = block([12, rows], |_, _| false, ALL);
            for (k, x) in model.mesh.coordinates.iter_mut().enumerate() {
                *x = [(k % 13) as f64, (k / 13) as f64];
            }
            let found = redistribution(&model);
            assert_eq!(found.massless().len(), 0, "{rows}");
            assert_eq!(found.kept().len(), if rows == 1 { 26 } else { 28 });
        }
        let mut tied = block([7, 6], MIXED, ALL);
        tied.equations.push(Equation {
            dof: 2 * 3,
            terms: vec![(2 * 50, 1.0)],
        });
        assert_eq!(redistribution(&tied).kept(), [3, 50]);
    }

    /// A flat block with moved nodes.
    fn flat(
        cells: [usize; 2],
        has: fn(usize, usize) -> bool,
        moved: impl Fn([f64; 2]) -> [f64; 2],
    ) -> Model {
        let mut model = block(cells, |_, _| false, has);
        let columns = cells[0] + 1;
        for (k, x) in model.mesh.coordinates.iter_mut().enumerate() {
            *x = moved([0.6 * (k % columns) as f64, 0.5 * (k / columns) as f64 - 1.0]);
        }
        model
    }

    /// With two layers the donors lie on a line, and some nodes also lie on this line; with three layers the donors do
    /// not lie on a line.
    #[test]
    fn round_off_turns_and_places_do_not_decide_over_mass() {
        for (rows, count) in [(2, 0), (3, 16)] {
            let as_it_is = massless(&flat([5, rows], ALL, |x| x));
            assert_eq!(as_it_is.len(), count, "{rows}");
            let noise = |[x, y]: [f64; 2]| [x, y + 1e-16 * (37.0 * x + 11.0 * y).sin()];
            assert_eq!(massless(&flat([5, rows], ALL, noise)), as_it_is, "noise");
            for k in 0..24 {
                let angle = f64::from(k) * std::f64::consts::PI / 12.0;
                let (sin, cos) = angle.sin_cos();
                for far in [0.0, 1e3] {
                    let turned =
                        |[x, y]: [f64; 2]| [cos * x - sin * y + far, sin * x + cos * y - far];
                    assert_eq!(
                        massless(&flat([5, rows], ALL, turned)),
                        as_it_is,
                        "{angle} {far}"
                    );
                }
            }
        }
    }

    /// A notch and a hole meet in a node, between two elements that meet only there: one edge goes round both.
    #[test]
    fn the_order_of_elements_does_not_decide_over_mass() {
        let has = |i, j| (i, j) != (3, 0) && (i, j) != (4, 1);
        let mut model = flat([8, 6], has, |x| x);
        let found = massless(&model);
        model.mesh.elements.reverse();
        model.surfaces[0].kind = SurfaceKind::Faces(model.mesh.exterior_faces());
        assert_eq!(massless(&model), found);
        let edges = [3, 4, 12, 13, 14, 22, 23];
        assert!(edges.iter().all(|node| found.contains(node)), "{found:?}");
    }
}
