//! `*TIE, TYPE=SURFACE TO SURFACE`: the nodes of the master that the sides of a slave surface follow, with their
//! weights. See docs/theory/contact.md, Ties from surface to surface.

use super::nearest::NearestLines;
use crate::model::{Follows, Mesh, SideNodes, Surface, SurfaceKind, TiedLine, TiedSide, beside};
use crate::vectors::{difference, distance, dot};
use smallvec::SmallVec;

/// Gauss points of a cell, -1 <= r <= 1; each has the weight 1. The Gauss points integrate products of two linear
/// functions and the radius exactly.
const GAUSS: [f64; 2] = [-0.577_350_269_189_625_8, 0.577_350_269_189_625_8];

/// Distance of two ends of cells, relative to the length of the line, below which the two ends count as one.
const ROUND_OFF: f64 = 1e-9;

/// Cosine of the largest angle between a slave line and the line of the master that it follows: 45 degrees.
const FACING_COSINE: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// A vertex of the straight lines that a surface is made of: a node, or the point of eq. (3.21) that replaces the node
/// between the corners of a side.
#[derive(Clone)]
struct Vertex {
    place: [f64; 2],
    /// Nodes that determine the vertex, and their weights in its position.
    nodes: SmallVec<[(usize, f64); 3]>,
}

impl Vertex {
    fn new(nodes: &[(usize, f64)], x: &[[f64; 2]]) -> Self {
        let of_axis = |i: usize| nodes.iter().map(|&(node, part)| part * x[node][i]).sum();
        Vertex {
            place: [0, 1].map(of_axis),
            nodes: nodes.into(),
        }
    }
}

/// The vertices of a side from corner to corner.
fn vertices_of(nodes: &[usize], x: &[[f64; 2]]) -> SmallVec<[Vertex; 3]> {
    let corner = |node: usize| Vertex::new(&[(node, 1.0)], x);
    match *nodes {
        // x_v = 4/3 x_m - (x_a + x_b)/6    eq. (3.21)
        [a, middle, b] => {
            let parts = [(middle, 4.0 / 3.0), (a, -1.0 / 6.0), (b, -1.0 / 6.0)];
            SmallVec::from([corner(a), Vertex::new(&parts, x), corner(b)])
        }
        _ => nodes.iter().map(|&node| corner(node)).collect(),
    }
}

/// The lines of a master surface.
struct Master {
    lines: Vec<[Vertex; 2]>,
    nearest: NearestLines,
}

impl Master {
    fn new(surface: &Surface, mesh: &Mesh) -> Self {
        let sides: Vec<SideNodes> = match &surface.kind {
            SurfaceKind::Faces(faces) => faces.iter().map(|face| face.nodes(mesh)).collect(),
            SurfaceKind::Rigid(profile) => {
                let segments = profile.segments.iter();
                segments
                    .map(|segment| SideNodes::from_slice(segment))
                    .collect()
            }
            SurfaceKind::Nodes(_) => Vec::new(),
        };
        let mut lines = Vec::new();
        for nodes in sides {
            let vertices = vertices_of(&nodes, &mesh.coordinates);
            let pairs = vertices.windows(2);
            lines.extend(pairs.map(|pair| [pair[0].clone(), pair[1].clone()]));
        }
        let places = lines.iter().map(places).collect();
        Master {
            lines,
            nearest: NearestLines::new(places),
        }
    }

    /// Ends of the cells of a slave line (as parts of its length): 0, the projections of the vertices of the master,
    /// and 1.
    fn cuts(&self, [p, q]: [[f64; 2]; 2]) -> Vec<f64> {
        let e = difference(p, q);
        let middle = [0, 1].map(|i| p[i] + e[i] / 2.0);
        let ends = [p, q].into_iter().filter_map(|end| self.nearest.of(end));
        // no point of the line has its nearest line farther away
        let most = ends.fold(0.0, |most: f64, (_, off)| most.max(off));
        let near = self.nearest.around(middle, most + distance(p, q));
        let vertices = near.iter().flat_map(|&k| &self.lines[k]);
        let projected = vertices.map(|vertex| dot(difference(p, vertex.place), e) / dot(e, e));
        let within = projected.filter(|eta| (ROUND_OFF..=1.0 - ROUND_OFF).contains(eta));
        let mut cuts: Vec<f64> = within.chain([0.0, 1.0]).collect();
        cuts.sort_unstable_by(f64::total_cmp);
        cuts.dedup_by(|next, last| *next - *last < ROUND_OFF);
        cuts
    }
}

fn places(line: &[Vertex; 2]) -> [[f64; 2]; 2] {
    [line[0].place, line[1].place]
}

/// The sides of a slave surface that face the master and whose nodes are all tied or belong also to the master.
pub(super) fn read(
    [slave, master]: [&Surface; 2],
    mesh: &Mesh,
    is_tied: impl Fn(usize) -> bool,
) -> Vec<TiedSide> {
    let SurfaceKind::Faces(faces) = &slave.kind else {
        return Vec::new();
    };
    let master = Master::new(master, mesh);
    let tied = |nodes: SideNodes| {
        if !nodes.iter().all(|&node| is_tied(node)) {
            return None;
        }
        let vertices = vertices_of(&nodes, &mesh.coordinates);
        let lines = vertices.windows(2).map(|ends| {
            let ends = [ends[0].place, ends[1].place];
            tied_line(ends, &master, mesh.is_axisymmetric())
        });
        let lines = lines.collect::<Option<SmallVec<[TiedLine; 2]>>>()?;
        Some(TiedSide { nodes, lines })
    };
    let sides = faces.iter().map(|face| face.nodes(mesh));
    sides.filter_map(tied).collect()
}

/// The nodes that the ends of a slave line follow; `None` for a line that does not face the master or has no area.
fn tied_line([p, q]: [[f64; 2]; 2], master: &Master, is_ring: bool) -> Option<TiedLine> {
    let e = difference(p, q);
    let mut sums = Sums::default();
    for cell in master.cuts([p, q]).windows(2) {
        let (middle, half) = ((cell[0] + cell[1]) / 2.0, (cell[1] - cell[0]) / 2.0);
        let at = |eta: f64| [0, 1].map(|i| (1.0 - eta) * p[i] + eta * q[i]);
        let (k, _) = master.nearest.of(at(middle))?;
        let line = &master.lines[k];
        let along = difference(line[0].place, line[1].place);
        if dot(e, along).abs() < FACING_COSINE * (dot(e, e) * dot(along, along)).sqrt() {
            return None;
        }
        for eta in GAUSS.map(|r| middle + half * r) {
            let point = at(eta);
            let radius = if is_ring { point[0] } else { 1.0 };
            let weight = half * distance(p, q) * radius;
            sums.add(weight, [1.0 - eta, eta], line, beside(point, places(line)));
        }
    }
    sums.dual()
}

/// Sums over the points q of a slave line, for the ends j and k of the line.
#[derive(Default)]
struct Sums {
    /// Mass matrix of the hat functions N, M_jk = sum_q w_q N_j N_k.
    m: [[f64; 2]; 2],
    /// Weights of the ends, D_j = sum_q w_q N_j.
    d: [f64; 2],
    /// Nodes of the master with the coefficients sum_q w_q N_j (alpha_l I + beta_l J).
    hats: [Follows; 2],
}

impl Sums {
    /// Adds a point that lies at xi and eta beside a line of the master.
    fn add(&mut self, weight: f64, n: [f64; 2], line: &[Vertex; 2], [xi, eta]: [f64; 2]) {
        // ((1 - xi) I - eta J) u_a + (xi I + eta J) u_b    eq. (3.11)
        let of_ends = [[1.0 - xi, -eta], [xi, eta]];
        for j in 0..2 {
            let w = weight * n[j];
            self.d[j] += w;
            self.m[j] = [0, 1].map(|k| self.m[j][k] + w * n[k]);
            for (vertex, of_end) in line.iter().zip(of_ends) {
                for &(node, part) in &vertex.nodes {
                    add_to(&mut self.hats[j], node, w * part, of_end);
                }
            }
        }
    }

    /// Replaces the hat functions N by the dual functions psi, for which sum_q w_q psi_j N_k = delta_jk D_j:
    ///
    /// ```text
    /// psi = D M^-1 N      eq. (3.33)
    /// ```
    fn dual(self) -> Option<TiedLine> {
        let Sums { m, d, hats } = self;
        let determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
        if !(determinant.is_finite() && determinant > 0.0 && d.iter().all(|d| *d > 0.0)) {
            return None;
        }
        let adjugate = [[m[1][1], -m[0][1]], [-m[1][0], m[0][0]]];
        let follows = [0, 1].map(|j| {
            let mut sums = Follows::new();
            for (hat, of_hat) in hats.iter().zip(adjugate[j]) {
                for (&node, &of_node) in hat {
                    add_to(&mut sums, node, d[j] * of_hat / determinant, of_node);
                }
            }
            sums
        });
        Some(TiedLine {
            weights: d,
            follows,
        })
    }
}

fn add_to(sums: &mut Follows, node: usize, factor: f64, of_node: [f64; 2]) {
    let sum = sums.entry(node).or_default();
    *sum = [0, 1].map(|i| sum[i] + factor * of_node[i]);
}
