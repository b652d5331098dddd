//! Constraints of rigid discs at segments, vertices and arcs of the master; the slave node of a disc is its centre. See
//! docs/theory/geometry.md, Discs.
//!
//! A disc is a node with a radius and a rotation. The gap of a disc is the gap of its centre less the radius. The slip
//! of a disc is the slip of the touching point of its circle.

use nalgebra::{DMatrix, Matrix2, SMatrix, SVector, Vector2};
use smallvec::SmallVec;

use super::arcs::{MasterArc, SurfaceArc};
use super::bulge::Bulge;
use super::constraint::{Configurations, Constraint, RowForm, RowPair};
use super::geometry::ContactSurfaces;
use super::keys::ConstraintKey;
use super::node_to_segment::{SegmentRows, rows_between};
use super::positions::Positions;
use super::projection::{position_round_off, rise};
use super::search::{Candidate, ListedSlave};
use super::stiffness::changes_between;
use super::target::{DiscContact, MasterFeature, Pair, PairTarget, Target};
use super::tolerances::{END_OF_FEATURE, SLIDING_SINE};
use crate::vectors::{angle, difference};

/// Adds the targets of a disc: the segments, arcs and convex vertices over which its centre lies in the iterate, and in
/// front of which it lay at the start.
pub(super) fn find_targets(
    listed: &ListedSlave,
    positions: [Positions; 2],
    pairs: &mut Vec<PairTarget>,
) {
    let Some(disc) = listed.surfaces.disc else {
        return;
    };
    let (centre, allowed) = (listed.node(), listed.allowed());
    let finder = Finder {
        surfaces: listed.surfaces,
        centre,
        positions,
    };
    let now = finder.over(listed.candidates(), 1, allowed);
    let start = finder.over(listed.candidates(), 0, allowed);
    let at_start =
        |feature: &MasterFeature| feature.gap(positions[0].of(centre), |n| positions[0].of(n));
    let nearest = (start.iter()).min_by(|f, g| at_start(&f.2).total_cmp(&at_start(&g.2)));
    for (key, segment, feature) in now {
        if at_start(&feature) <= 0.0 {
            continue;
        }
        let pair = Pair {
            key: ConstraintKey {
                slave: listed.key,
                segment: key,
            },
            slave: centre,
            allowed,
            is_of_master: false,
        };
        let target = Target::Disc(DiscContact {
            radius: disc.radius,
            arm: disc.arm,
            segment,
            feature,
            from: nearest.filter(|from| from.0 != key).map(|from| from.2),
        });
        pairs.push(PairTarget { pair, target });
    }
}

/// The centre of a disc next to the master.
struct Finder<'a> {
    surfaces: &'a ContactSurfaces,
    centre: usize,
    positions: [Positions<'a>; 2],
}

/// Features of the master in the order of their constraints' numbers, each with the number and a segment of the
/// feature.
type Over = SmallVec<[(usize, usize, MasterFeature); 4]>;

impl Finder<'_> {
    /// Features over which the centre lies, among those near it, at the start (`k` = 0) or in the iterate (`k` = 1). A
    /// centre lies over a segment or an arc between its ends; it lies over a vertex between two of these, or at an end
    /// of the surface.
    fn over(
        &self,
        candidates: impl Iterator<Item = Candidate>,
        k: usize,
        allowed: [f64; 2],
    ) -> Over {
        let surfaces = self.surfaces;
        let (count, mut over) = (surfaces.segments.len(), Over::new());
        for Candidate { segment: i, reach } in candidates {
            let arc = surfaces.arc_of(i);
            let mut add = |number: usize, feature: MasterFeature| {
                let s = self.positions[k].of(self.centre);
                let gap = feature.gap(s, |node| self.positions[k].of(node)) + allowed[k];
                if gap.abs() <= reach && over.iter().all(|(n, ..)| *n != number) {
                    over.push((number, i, feature));
                }
            };
            let xi = self.xi(i, k);
            if (-END_OF_FEATURE..=1.0 + END_OF_FEATURE).contains(&xi) {
                let number = arc.map_or(i, |arc| arc.circle);
                add(number, self.feature(i));
            }
            let vertex = |node: usize, other: usize| MasterFeature {
                nodes: [node, other],
                arc: Some(MasterArc::VERTEX),
            };
            let [a, b] = surfaces.segments[i];
            let next = surfaces.next[i];
            let is_inside = arc.is_some_and(|arc| next.is_some_and(|j| arc.segments.contains(&j)));
            let is_before_next = || next.is_none_or(|j| self.xi(j, k) < -END_OF_FEATURE);
            if !is_inside && xi > 1.0 + END_OF_FEATURE && is_before_next() {
                add(count + i, vertex(b, a));
            }
            if surfaces.previous[i].is_none() && xi < -END_OF_FEATURE {
                add(2 * count + i, vertex(a, b));
            }
        }
        over.sort_by_key(|(number, ..)| *number);
        over
    }

    /// The arc of which a segment is a chord, or the segment itself.
    fn feature(&self, segment: usize) -> MasterFeature {
        match self.surfaces.arc_of(segment) {
            Some(arc) => MasterFeature {
                nodes: arc.nodes,
                arc: Some(arc.arc),
            },
            None => MasterFeature {
                nodes: self.surfaces.segments[segment],
                arc: None,
            },
        }
    }

    /// Coordinate of the centre along a segment, or along the arc of which the segment is a chord: 0 at its start, 1 at
    /// its end.
    fn xi(&self, segment: usize, k: usize) -> f64 {
        let at = |node: usize| self.positions[k].of(node);
        let Some(SurfaceArc { nodes, arc, .. }) = self.surfaces.arc_of(segment) else {
            let [a, b] = self.surfaces.segments[segment];
            return self.positions[k].place([self.centre, a, b]).xi;
        };
        let ends = nodes.map(at);
        let arm = |x: [f64; 2]| difference(arc.centre(ends), x);
        let [p, q, s] = [ends[0], ends[1], at(self.centre)].map(arm);
        angle(p, s) / angle(p, q)
    }
}

type Map = SMatrix<f64, 2, 8>;
type DiscRow = SVector<f64, 8>;

/// The rotation J by a right angle to the left.
const J: Matrix2<f64> = Matrix2::new(0.0, -1.0, 1.0, 0.0);

/// Positions of the nodes of a disc constraint at the start and at the end: the centre s, the node that turns with the
/// disc, and the master nodes a and b. The entries of a row follow the order s, turning node, a, b.
struct NodePositions {
    form: RowForm,
    nodes: [[[f64; 2]; 4]; 2],
}

impl NodePositions {
    fn new(nodes: [usize; 4], at: &Configurations) -> Self {
        NodePositions {
            form: at.form,
            nodes: [at.start(nodes), at.iterate(nodes)],
        }
    }

    /// The vectors that a linear map of the node positions gives at the start and at the end.
    fn vectors(&self, map: &Map) -> [Vector2<f64>; 2] {
        self.nodes
            .map(|x| map * DiscRow::from_iterator(x.into_iter().flatten()))
    }

    /// Positions of the nodes s, a and b at start and end.
    fn of_segment(&self) -> [[[f64; 2]; 3]; 2] {
        self.nodes.map(|[s, _, a, b]| [s, a, b])
    }

    /// Part w of the increment at which directions are evaluated, with z_m = z_0 + w (z_1 - z_0): 1/2 for the middle, 1
    /// for the end.
    fn part(&self) -> f64 {
        match self.form {
            RowForm::End => 1.0,
            RowForm::DiscreteGradient => 0.5,
        }
    }
}

/// The maps for x_b - x_a, and for the vector from the centre of the disc to the node that turns with the disc.
fn arms() -> [Map; 2] {
    let (mut e, mut arm) = (Map::zeros(), Map::zeros());
    for i in 0..2 {
        (e[(i, 4 + i)], e[(i, 6 + i)]) = (-1.0, 1.0);
        (arm[(i, i)], arm[(i, 2 + i)]) = (-1.0, 1.0);
    }
    [e, arm]
}

/// The map for r = x_s - x_c, the vector from the centre x_c of an arc.
fn from_centre(arc: &MasterArc) -> Map {
    let [alpha, beta] = arc.place;
    let mut r = Map::zeros();
    r.fixed_view_mut::<2, 2>(0, 0)
        .copy_from(&Matrix2::identity());
    let at_p = Matrix2::identity() * (1.0 - alpha) - J * beta;
    let at_q = Matrix2::identity() * alpha + J * beta;
    r.fixed_view_mut::<2, 2>(0, 4).copy_from(&-at_p);
    r.fixed_view_mut::<2, 2>(0, 6).copy_from(&-at_q);
    r
}

/// Rotation of a vector within the increment, the rows of this rotation, and the derivative of its force row with
/// respect to the end.
///
/// ```text
/// T = (e_0 x e_1)/|e_m|² = (J e_m).d/|e_m|²,   d = e_1 - e_0    eq. (3.22)
/// ```
struct Turn {
    value: f64,
    force: Vector2<f64>,
    derivative: Vector2<f64>,
    change: Matrix2<f64>,
}

impl Turn {
    fn new([start, end]: [Vector2<f64>; 2], part: f64) -> Self {
        let middle = start + (end - start) * part;
        let square = middle.norm_squared();
        let crossed = start.perp(&end);
        let force = J * middle / square;
        Turn {
            value: crossed / square,
            force,
            derivative: J * start / square - middle * (2.0 * part * crossed / (square * square)),
            change: (J - force * middle.transpose() * 2.0) * (part / square),
        }
    }
}

/// Rows of a disc, the gap of its centre without allowed overlap, the length to which the gap is relative, and the tilt
/// of the force.
struct DiscRows {
    force: RowPair<8>,
    derivative: RowPair<8>,
    gap: f64,
    scale: f64,
    kappa: f64,
    /// Force row and derivative row of the path of the centre along the master; the path does not depend on the
    /// rotation of the disc.
    of_centre: [DiscRow; 2],
}

impl DiscContact {
    /// The centre s, the node that turns with the disc, and the nodes a and b of the master, in the order of the rows.
    fn nodes(&self, pair: &Pair) -> [usize; 4] {
        let [a, b] = self.feature.nodes;
        [pair.slave, self.arm, a, b]
    }

    /// The constraint of the centre s of a disc at the segment from a to b, or at an arc.
    pub(super) fn constraint(self, pair: Pair, at: &Configurations) -> Constraint {
        let rows = self.rows(&pair, at);
        let gap = (rows.gap, rows.scale, pair.allowed);
        let target = Target::Disc(self);
        let source = PairTarget { pair, target };
        let both = [rows.force, rows.derivative];
        Constraint {
            slave_dofs: 4,
            ..Constraint::of_nodes(source, &self.nodes(&pair), both, gap, at)
        }
    }

    fn rows(&self, pair: &Pair, at: &Configurations) -> DiscRows {
        let places = NodePositions::new(self.nodes(pair), at);
        let mut rows = match &self.feature.arc {
            None => at_segment(&places, self.radius, -pair.allowed[1]),
            Some(arc) => at_arc(&places, self.radius, arc),
        };
        if let Some(from) = self.from.filter(|_| at.form == RowForm::DiscreteGradient) {
            rows.kappa = self.tilt(pair, &from, &rows, at);
            let tilted = row(&rows.force.normal) + rows.of_centre[0] * rows.kappa;
            rows.force.normal = tilted.into();
        }
        rows
    }

    /// Displacements of the nodes since the start, in the order of the rows.
    fn displacements(&self, pair: &Pair, at: &Configurations) -> DiscRow {
        let dofs = self.nodes(pair).map(|node| [2 * node, 2 * node + 1]);
        let dofs = dofs.as_flattened().iter();
        DiscRow::from_iterator(dofs.map(|&dof| at.u[dof] - at.u0[dof]))
    }

    /// Tilt of the force on a disc that has come from another feature, eq. (7.6), along the path of its centre.
    fn tilt(&self, pair: &Pair, from: &MasterFeature, rows: &DiscRows, at: &Configurations) -> f64 {
        let centre = at.start([pair.slave])[0];
        let start = |feature: &MasterFeature| {
            feature.gap(centre, |node| at.start([node])[0]) + pair.allowed[0]
        };
        let [gap, before] = [start(&self.feature), start(from)];
        let travel = rows.of_centre[0].dot(&self.displacements(pair, at));
        let rise = rise((gap, rows.scale), before, centre);
        // a force that would lean too far is not tilted: if it gains energy, the increment is cut
        // back
        match travel.abs() > position_round_off(centre) && rise.abs() <= SLIDING_SINE * travel.abs()
        {
            true => rise / travel,
            false => 0.0,
        }
    }

    /// Derivative of the contact force of a disc at constant Pn and Pt, over the dofs of the
    /// constraint.
    pub(super) fn change(
        &self,
        pair: &Pair,
        [pn, pt]: [f64; 2],
        at: &Configurations,
    ) -> DMatrix<f64> {
        let places = NodePositions::new(self.nodes(pair), at);
        let rows = self.rows(pair, at);
        // the force of a tilted row is Bn^T Pn + Bt^T Pt + kappa Pn times the row of the centre
        let leaning = rows.kappa * pn;
        let mut k = SMatrix::<f64, 8, 8>::zeros();
        match &self.feature.arc {
            None => {
                let (places_of_segment, force) = (places.of_segment(), [pn, pt + leaning]);
                let of_centre =
                    changes_between(places_of_segment, -pair.allowed[1], force, at.form);
                let of_segment = [0, 1, 4, 5, 6, 7];
                for (i, &row) in of_segment.iter().enumerate() {
                    for (j, &column) in of_segment.iter().enumerate() {
                        k[(row, column)] = of_centre[(i, j)];
                    }
                }
                for (map, sign) in arms().iter().zip([1.0, -1.0]) {
                    let turn = Turn::new(places.vectors(map), places.part());
                    k += map.transpose() * turn.change * map * (sign * self.radius * pt);
                }
            }
            Some(arc) => {
                let own = AtArc::new(&places, self.radius, arc);
                let [r0, r1] = own.r;
                let [l0, l1] = own.r.map(|r| r.norm());
                let normal = match at.form {
                    RowForm::End => Matrix2::identity() / l1 - r1 * r1.transpose() / l1.powi(3),
                    RowForm::DiscreteGradient => {
                        let sum = l0 + l1;
                        Matrix2::identity() / sum - (r0 + r1) * r1.transpose() / (l1 * sum * sum)
                    }
                };
                let dm = own.middle * (own.part / own.m);
                let along = J * own.middle / own.m;
                let change = J * (own.part / own.m) - along * dm.transpose() / own.m;
                let [r, arm, e] = own.maps;
                k += r.transpose() * (normal * pn + change * (pt + leaning)) * r * own.sign;
                let couples = [own.shares[0] * pt, own.shares[1] * pt + leaning];
                for ((map, turn), couple) in [arm, e].iter().zip(&own.turns).zip(couples) {
                    let of_turn = turn.change * own.m * map + turn.force * dm.transpose() * r;
                    k -= map.transpose() * of_turn * (own.sign * couple);
                }
            }
        }
        if rows.kappa != 0.0 {
            // dkappa is -kappa/s times the derivative of the path s
            let [force, slope] = rows.of_centre;
            let travel = force.dot(&self.displacements(pair, at));
            k -= force * slope.transpose() * (leaning / travel);
        }
        DMatrix::from_column_slice(8, 8, k.as_slice())
    }
}

fn row(row: &[f64; 8]) -> DiscRow {
    DiscRow::from_column_slice(row)
}

/// Rows of a disc at a segment: the rows of its centre, with the rotations of disc and segment added to the slip.
///
/// ```text
/// g = g(x_s) - rho,   Dt = L (xi1 - xi0) - rho (T_s - T_e)    eq. (3.23)
/// ```
fn at_segment(places: &NodePositions, radius: f64, height: f64) -> DiscRows {
    let SegmentRows {
        projection,
        force,
        derivative,
        ..
    } = rows_between(places.of_segment(), (height, &Bulge::FLAT), places.form);
    let all = |[sx, sy, ax, ay, bx, by]: [f64; 6]| {
        DiscRow::from_column_slice(&[sx, sy, 0.0, 0.0, ax, ay, bx, by])
    };
    let maps = arms();
    let [of_segment, of_disc] = maps.map(|map| Turn::new(places.vectors(&map), places.part()));
    let turns = |row: fn(&Turn) -> Vector2<f64>| {
        (maps[0].transpose() * row(&of_segment) - maps[1].transpose() * row(&of_disc)) * radius
    };
    let of_centre = [force.tangential, derivative.tangential].map(all);
    DiscRows {
        force: RowPair {
            normal: all(force.normal).into(),
            tangential: (of_centre[0] + turns(|turn| turn.force)).into(),
        },
        derivative: RowPair {
            normal: all(derivative.normal).into(),
            tangential: (of_centre[1] + turns(|turn| turn.derivative)).into(),
        },
        gap: projection.gap,
        scale: projection.length,
        kappa: 0.0,
        of_centre,
    }
}

/// Values from which the rows of a disc at an arc are made: the vector r at start, middle and end, m = |r_m|, and the
/// weights of the rotations of disc and arc.
struct AtArc {
    r: [Vector2<f64>; 2],
    middle: Vector2<f64>,
    m: f64,
    part: f64,
    sign: f64,
    /// Weights rho/(rho + R) and R/(rho + R) of the two rotations.
    shares: [f64; 2],
    /// Rotations T_s of the disc and T_e of the arc.
    turns: [Turn; 2],
    /// Maps for r, and for the arms of disc and arc.
    maps: [Map; 3],
}

impl AtArc {
    fn new(places: &NodePositions, radius: f64, arc: &MasterArc) -> Self {
        let (part, [e, arm], r_map) = (places.part(), arms(), from_centre(arc));
        let r = places.vectors(&r_map);
        let middle = r[0] + (r[1] - r[0]) * part;
        let both = radius + arc.radius;
        AtArc {
            r,
            middle,
            m: middle.norm(),
            part,
            sign: arc.sign(),
            shares: [radius / both, arc.radius / both],
            turns: [arm, e].map(|map| Turn::new(places.vectors(&map), part)),
            maps: [r_map, arm, e],
        }
    }

    /// Mean rotation T = (rho T_s + R T_e)/(rho + R).
    fn turn(&self) -> f64 {
        let [s, e] = &self.turns;
        self.shares[0] * s.value + self.shares[1] * e.value
    }
}

/// Rows at an arc of radius R about x_c, with r = x_s - x_c and m = |r_m|; in a hole other signs apply.
///
/// ```text
/// g  = |r| - R - rho,   Bn = 2 r_m/(l0 + l1), or r_1/l1 of end rows
/// Dt = (r_0 x r_1)/m - m (rho T_s + R T_e)/(rho + R)                  eq. (3.24)
/// ```
///
/// The path of the centre is (r_0 x r_1)/m - m T_e.
fn at_arc(places: &NodePositions, radius: f64, arc: &MasterArc) -> DiscRows {
    let own = AtArc::new(places, radius, arc);
    let [r0, r1] = own.r;
    let [l0, l1] = own.r.map(|r| r.norm());
    let [to_r, to_arm, to_e] = own.maps.map(|map| map.transpose());
    let normal = match places.form {
        RowForm::End => r1 / l1,
        RowForm::DiscreteGradient => (r0 + r1) / (l0 + l1),
    };
    let along = J * own.middle / own.m;
    let [s, e] = &own.turns;
    let couples = |s: Vector2<f64>, e: Vector2<f64>| {
        (to_arm * s * own.shares[0] + to_e * e * own.shares[1]) * own.m
    };
    // dm = w (r_m/m).dr_1
    let dm = own.middle * (own.part / own.m);
    let slope = J * r0 / own.m - dm * (r0.perp(&r1) / (own.m * own.m));
    let force = to_r * along - couples(s.force, e.force);
    let derivative = to_r * (slope - dm * own.turn()) - couples(s.derivative, e.derivative);
    let travel = to_r * along - to_e * e.force * own.m;
    let change_of_travel = to_r * (slope - dm * e.value) - to_e * e.derivative * own.m;
    DiscRows {
        force: RowPair {
            normal: (to_r * normal * own.sign).into(),
            tangential: (force * own.sign).into(),
        },
        derivative: RowPair {
            normal: (to_r * r1 * (own.sign / l1)).into(),
            tangential: (derivative * own.sign).into(),
        },
        gap: own.sign * l1 - arc.radius,
        scale: radius + arc.radius.abs(),
        kappa: 0.0,
        of_centre: [travel * own.sign, change_of_travel * own.sign],
    }
}

#[cfg(test)]
mod tests {
    use super::super::constraint::Rows;
    use super::*;
    use crate::contact::testing;

    /// Centre of the disc, two nodes of the master, and a node that turns with the disc.
    const X: [[f64; 2]; 4] = [[0.7, 1.4], [2.0, 0.1], [-0.5, -0.2], [1.3, 2.1]];
    const U0: [f64; 8] = [0.1, -0.05, 0.02, 0.07, -0.03, 0.01, 0.04, -0.02];
    const U1: [f64; 8] = [-0.2, -0.15, 0.3, 0.2, 0.25, -0.3, -0.1, 0.3];

    /// The disc at the segment, at a vertex, at an arc whose body is inside, and in a hole; then these four constraints
    /// behind a rise.
    fn sources() -> [PairTarget; 8] {
        let arc = |beta: f64, radius: f64| MasterArc {
            place: [0.5, beta],
            radius,
        };
        let arcs = [
            None,
            Some(MasterArc::VERTEX),
            Some(arc(-0.7, 1.9)),
            Some(arc(0.4, -2.1)),
        ];
        let [a, b, c, d] = arcs.map(|arc| disc(0.8, arc));
        let [e, f, g, h] = [a, b, c, d].map(behind_a_rise);
        [a, b, c, d, e, f, g, h].map(|(pair, disc)| PairTarget {
            pair,
            target: Target::Disc(disc),
        })
    }

    /// A disc about node 0, turned by node 3, at the segment from node 1 to node 2, or at an arc that moves with these
    /// two nodes.
    fn disc(radius: f64, arc: Option<MasterArc>) -> (Pair, DiscContact) {
        let contact = DiscContact {
            radius,
            arm: 3,
            segment: 0,
            feature: MasterFeature { nodes: [1, 2], arc },
            from: None,
        };
        (testing::face().pair, contact)
    }

    /// A disc that comes from an arc behind which it was; at the start it is 0.02 in front of the feature.
    fn behind_a_rise((mut pair, mut disc): (Pair, DiscContact)) -> (Pair, DiscContact) {
        let at = between(RowForm::End, &U0, &U0);
        pair.allowed[0] = 0.02 - disc.constraint(pair, &at).gap;
        disc.from = Some(MasterFeature {
            nodes: [1, 2],
            arc: Some(MasterArc {
                place: [0.5, 0.0],
                radius: 100.0,
            }),
        });
        let at = between(RowForm::DiscreteGradient, &U0, &U1);
        let rows = disc.rows(&pair, &at);
        assert!(rows.kappa.abs() > 1e-2, "{} {disc:?}", rows.kappa);
        (pair, disc)
    }

    fn between<'a>(form: RowForm, u0: &'a [f64], u: &'a [f64]) -> Configurations<'a> {
        let x = &X;
        Configurations { form, x, u0, u }
    }

    #[test]
    fn derivative_rows_are_the_derivatives_of_gap_and_slip() {
        for source in sources() {
            for form in [RowForm::End, RowForm::DiscreteGradient] {
                let of = |u: &[f64]| Constraint::new(source.clone(), &between(form, &U0, u));
                let found = of(&U1);
                let rows = found.derivative_rows();
                for (k, &dof) in found.dofs.iter().enumerate() {
                    let [mut plus, mut minus] = [U1; 2];
                    (plus[dof], minus[dof]) = (plus[dof] + 1e-6, minus[dof] - 1e-6);
                    let (p, q) = (of(&plus), of(&minus));
                    let (gap, slip) = ((p.gap - q.gap) / 2e-6, (p.slip - q.slip) / 2e-6);
                    assert!(
                        (rows.normal[k] - gap).abs() < 1e-8,
                        "{form:?} {k} {source:?}"
                    );
                    let error = (rows.tangential[k] - slip).abs();
                    assert!(error < 1e-8, "{form:?} {k} {error} {source:?}");
                }
            }
        }
    }

    #[test]
    fn discrete_gradients_are_exact_differences() {
        for source in sources() {
            let at = between(RowForm::DiscreteGradient, &U0, &U1);
            let found = Constraint::new(source.clone(), &at);
            let rise = match source.target {
                Target::Disc(DiscContact { from: Some(_), .. }) => 0.02,
                _ => 0.0,
            };
            let start = Constraint::new(source.clone(), &between(RowForm::End, &U0, &U0));
            let counted = start.gap + source.pair.allowed[0] - rise;
            assert!((found.start_gap - counted).abs() < 1e-14);
        }
    }

    #[test]
    fn forces_of_a_closed_pair_keep_both_momenta() {
        for mut source in sources() {
            let gap = Constraint::new(source.clone(), &between(RowForm::End, &U0, &U1)).gap;
            source.pair.allowed[1] -= gap;
            for (form, part) in [(RowForm::DiscreteGradient, 0.5), (RowForm::End, 1.0)] {
                let found = Constraint::new(source.clone(), &between(form, &U0, &U1));
                assert!(found.gap.abs() < 1e-15);
                let place = |dof: usize| X[dof / 2][dof % 2] + U0[dof] + part * (U1[dof] - U0[dof]);
                let Rows { normal, tangential } = &found.force_rows;
                for row in [normal, tangential] {
                    let (mut force, mut moment) = ([0.0; 2], 0.0);
                    for (f, dofs) in row.chunks(2).zip(found.dofs.chunks(2)) {
                        force = [force[0] + f[0], force[1] + f[1]];
                        moment += place(dofs[0]) * f[1] - place(dofs[1]) * f[0];
                    }
                    assert!(force.iter().all(|f| f.abs() < 1e-14), "{form:?} {force:?}");
                    assert!(moment.abs() < 1e-13, "{form:?} {moment} {source:?}");
                }
            }
        }
    }

    #[test]
    fn the_change_of_the_force_is_its_derivative() {
        let force = [1.3, -0.4];
        for source in sources() {
            for form in [RowForm::End, RowForm::DiscreteGradient] {
                let nodal = |u: &[f64]| {
                    let mut forces = [0.0; 8];
                    let constraint = Constraint::new(source.clone(), &between(form, &U0, u));
                    constraint.add_force(force, &mut forces);
                    forces
                };
                let at = between(form, &U0, &U1);
                let found = Constraint::new(source.clone(), &at).change(force, &at);
                let quotient = |row: usize, column: usize| {
                    let [mut plus, mut minus] = [U1; 2];
                    (plus[column], minus[column]) = (plus[column] + 1e-6, minus[column] - 1e-6);
                    (nodal(&plus)[row] - nodal(&minus)[row]) / 2e-6
                };
                let dofs = Constraint::new(source.clone(), &at).dofs;
                for (i, &row) in dofs.iter().enumerate() {
                    for (j, &column) in dofs.iter().enumerate() {
                        let error = (found[(i, j)] - quotient(row, column)).abs();
                        assert!(
                            error < 1e-7 * found.amax(),
                            "{form:?} {i} {j} {error} {source:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_disc_that_rolls_does_not_slip() {
        // from (0, 1) by the angle t along the floor, which runs from right to left
        let x = [[0.0, 1.0], [5.0, 0.0], [-5.0, 0.0], [0.0, 2.0]];
        let t = 0.3_f64;
        let travel = 2.0 * (t / 2.0).tan();
        let u = [
            travel,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            travel + t.sin(),
            t.cos() - 1.0,
        ];
        let (mut pair, disc) = disc(1.0, None);
        pair.allowed = [-1.0; 2];
        let at = Configurations {
            form: RowForm::DiscreteGradient,
            x: &x,
            u0: &[0.0; 8],
            u: &u,
        };
        let found = disc.constraint(pair, &at);
        assert!(found.gap.abs() < 1e-15);
        assert!(found.slip.abs() < 1e-15, "{}", found.slip);
    }
}
