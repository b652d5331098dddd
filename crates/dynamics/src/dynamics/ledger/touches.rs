//! Touches: contacts of two bodies from the landing of a first node until no node is closed. The module also finds
//! landings of nodes that take over from nodes that have opened. See docs/theory/impacts.md, Touches.

use std::collections::{BTreeMap, BTreeSet};

use crate::archive::{Archive, ArchiveError, transfer_fields};
use crate::contact::tolerances::CLOSED_GAP;
use crate::contact::{ClosedPair, Constraint, SlaveKey};
use crate::dynamics::increment::Solved;
use crate::dynamics::results::{ContactResultant, Touch};
use crate::dynamics::step::{Hold, Interval, StepProblem, holds};
use crate::model::{Bodies, Mesh};
use crate::vectors::{angle, difference};

/// Angle (rad) from which on a surface has a corner, where a contact area ends, whatever its size.
const CORNER: f64 = 1.0;

/// One side of a touch: a body, or the rigid surface of a contact.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
enum Partner {
    Body(usize),
    Surface(usize),
}

/// The touches of a run.
pub(crate) struct Touches {
    /// For every node whether it is at a corner of its body.
    corners: Vec<bool>,
    /// Number of increments so far.
    increments: usize,
    under_way: BTreeMap<[Partner; 2], TouchUnderWay>,
}

/// A touch that has not ended.
#[derive(Default, serde::Serialize, serde::Deserialize)]
struct TouchUnderWay {
    touch: Touch,
    /// Impulse on the first partner of the touch.
    impulse: [f64; 2],
    /// Slave nodes closed at the end of the last increment.
    closed: BTreeSet<SlaveKey>,
    /// Number of nodes that have opened without another node landing in their place.
    opened: usize,
}

impl Touches {
    /// The list of touches at the start of a run, which is empty.
    pub fn new(mesh: &Mesh) -> Self {
        Touches {
            corners: corners(mesh),
            increments: 0,
            under_way: BTreeMap::new(),
        }
    }

    /// Transfers the touches under way to or from an archive.
    pub fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        transfer_fields!(archive, self => Self { increments, under_way; corners })
    }

    /// Enters a converged increment. Adds the work of nodes that take over from other nodes to the contacts, and
    /// returns the touches that have ended.
    pub fn enter(
        &mut self,
        problem: &StepProblem,
        bodies: &Bodies,
        solved: &Solved,
        interval: Interval,
        contacts: &mut [ContactResultant],
    ) -> Vec<Touch> {
        self.increments += 1;
        let mut pairs: BTreeMap<[Partner; 2], Vec<(&Constraint, &ClosedPair)>> = BTreeMap::new();
        for (constraint, pair) in solved.contact.forces.acting() {
            let of_both = pairs.entry(partners(bodies, constraint).0).or_default();
            of_both.push((constraint, pair));
        }
        for (both, pairs) in &pairs {
            let under_way = (self.under_way.entry(*both))
                .or_insert_with(|| TouchUnderWay::begin(*both, pairs, interval, self.increments));
            under_way.touch.last = self.increments;
            under_way.measure(bodies, pairs, &self.corners);
            for (slave, work) in under_way.hand_over(pairs, &solved.d) {
                contacts[slave.contact()].handover_work += work;
            }
        }
        self.add_impulses(bodies, solved, interval.dt);
        let has_ended = |under_way: &TouchUnderWay| under_way.touch.last < self.increments;
        let ended: Vec<[Partner; 2]> = (self.under_way.iter())
            .filter(|(_, under_way)| has_ended(under_way))
            .map(|(both, _)| *both)
            .collect();
        let masses = FreeMasses::new(problem, bodies);
        let end = |both| {
            let under_way = self.under_way.remove(&both)?;
            Some(under_way.end(interval.start.total, masses.reduced(both)))
        };
        ended.into_iter().filter_map(end).collect()
    }

    /// Adds the impulses of an increment of length `dt`: dt P + (Phi, Psi) plus the returns.
    fn add_impulses(&mut self, bodies: &Bodies, solved: &Solved, dt: f64) {
        let forces =
            (solved.contact.forces.acting()).map(|(c, pair)| (c, pair.force.map(|p| dt * p)));
        let impulses = solved
            .contact
            .impulses
            .acting()
            .map(|(c, pair)| (c, pair.force));
        for (constraint, impulse) in forces.chain(impulses) {
            let (both, sign) = sides(bodies, constraint);
            if let Some(under_way) = self.under_way.get_mut(&both) {
                let vectors = constraint.forces_on_slave_surface(impulse);
                vectors.for_each(|(_, vector)| under_way.add(sign, vector));
            }
        }
        let opened = solved.returned.release.opened.iter().map(|(c, _)| c);
        let constraints = (solved.contact.forces.acting().map(|(c, _)| c)).chain(opened);
        let of_keys: BTreeMap<_, _> = constraints.map(|c| (c.key, sides(bodies, c))).collect();
        for pair in &solved.returned.pairs {
            if let Some((both, sign)) = of_keys.get(&pair.key)
                && let Some(under_way) = self.under_way.get_mut(both)
            {
                under_way.add(*sign, pair.vector);
            }
        }
    }
}

/// The two partners of a constraint in increasing order, and 1 if the slave is the first partner, else -1.
fn partners(bodies: &Bodies, constraint: &Constraint) -> ([Partner; 2], f64) {
    let [s, a, _] = constraint.pair().nodes;
    let side = |node: usize| match bodies.of_node[node] {
        Some(body) => Partner::Body(body),
        None => Partner::Surface(constraint.key.contact()),
    };
    match [side(s), side(a)] {
        [p, q] if p <= q => ([p, q], 1.0),
        [p, q] => ([q, p], -1.0),
    }
}

/// The two partners of a constraint in increasing order, and 1 if the slave surface of the contact belongs to the first
/// partner, else -1.
fn sides(bodies: &Bodies, constraint: &Constraint) -> ([Partner; 2], f64) {
    let (both, sign) = partners(bodies, constraint);
    (
        both,
        if constraint.is_of_master() {
            -sign
        } else {
            sign
        },
    )
}

impl TouchUnderWay {
    /// A touch that begins with some pairs in the increment number `increment`.
    fn begin(
        both: [Partner; 2],
        pairs: &[(&Constraint, &ClosedPair)],
        interval: Interval,
        increment: usize,
    ) -> Self {
        TouchUnderWay {
            touch: Touch {
                bodies: both.map(Partner::body),
                node: pairs[0].0.pair().nodes[0],
                start: interval.start.total,
                first: increment,
                ..Touch::default()
            },
            ..TouchUnderWay::default()
        }
    }

    /// Nodes that land after other nodes have opened, with the work Pn (Bn d) of their landings. If more nodes land
    /// than have opened, each landing counts with the same share, since the order of the nodes is arbitrary.
    fn hand_over(
        &mut self,
        pairs: &[(&Constraint, &ClosedPair)],
        d: &[f64],
    ) -> Vec<(SlaveKey, f64)> {
        let closed: BTreeSet<SlaveKey> = pairs.iter().map(|(c, _)| c.key.slave()).collect();
        self.opened += self.closed.difference(&closed).count();
        let landing = |(constraint, pair): &(&Constraint, &ClosedPair)| {
            let (slave, travel) = (constraint.key.slave(), constraint.normal_motion(d));
            let lands = -travel > CLOSED_GAP * constraint.scale && !self.closed.contains(&slave);
            lands.then(|| (slave, pair.force[0] * travel))
        };
        let mut landings: Vec<(SlaveKey, f64)> = pairs.iter().filter_map(landing).collect();
        let handed_over = self.opened.min(landings.len());
        let share = handed_over as f64 / landings.len().max(1) as f64;
        landings.iter_mut().for_each(|(_, work)| *work *= share);
        self.opened -= handed_over;
        self.closed = closed;
        landings
    }

    /// Enters the number of closed nodes of one side, and whether the contact reaches a corner.
    fn measure(&mut self, bodies: &Bodies, pairs: &[(&Constraint, &ClosedPair)], corners: &[bool]) {
        let mut slaves = [BTreeSet::new(), BTreeSet::new()];
        for (constraint, _) in pairs {
            let is_first = partners(bodies, constraint).1 > 0.0;
            slaves[usize::from(is_first)].insert(constraint.pair().nodes[0]);
            self.touch.is_at_corner |= constraint.nodes().any(|node| corners[node]);
        }
        let most = slaves.iter().map(BTreeSet::len).fold(0, usize::max);
        self.touch.nodes = self.touch.nodes.max(most);
    }

    fn add(&mut self, sign: f64, vector: [f64; 2]) {
        for (sum, p) in self.impulse.iter_mut().zip(vector) {
            *sum += sign * p;
        }
    }

    /// The result of a touch that ends at a time; `mass` is the reduced mass of its bodies.
    fn end(self, time: f64, mass: f64) -> Touch {
        let [x, y] = self.impulse;
        let impulse = x.hypot(y);
        Touch {
            end: time,
            impulse,
            // E = J²/(8 m), eq. (9.11)
            energy: impulse * impulse / (8.0 * mass),
            ..self.touch
        }
    }
}

impl Partner {
    fn body(self) -> Option<usize> {
        match self {
            Partner::Body(body) => Some(body),
            Partner::Surface(_) => None,
        }
    }
}

/// Masses of the bodies that no support holds; other bodies and rigid surfaces have infinite mass.
struct FreeMasses(Vec<f64>);

impl FreeMasses {
    fn new(problem: &StepProblem, bodies: &Bodies) -> Self {
        let holds = holds(problem);
        let mut masses = vec![0.0; bodies.count];
        for (node, body) in bodies.of_node.iter().enumerate() {
            if let Some(body) = *body {
                masses[body] += match holds[problem.parts.of_nodes()[node]] {
                    Hold::Free => problem.mass.shares[node],
                    _ => f64::INFINITY,
                };
            }
        }
        FreeMasses(masses)
    }

    /// Reduced mass m of the partners, 1/m = 1/m_1 + 1/m_2, eq. (9.11).
    fn reduced(&self, partners: [Partner; 2]) -> f64 {
        let inverse = |partner: Partner| partner.body().map_or(0.0, |body| 1.0 / self.0[body]);
        1.0 / partners.map(inverse).iter().sum::<f64>()
    }
}

/// For every node whether the outline of its body turns at the node by more than [`CORNER`], or does not pass through
/// it exactly once.
fn corners(mesh: &Mesh) -> Vec<bool> {
    let x = |node: usize| mesh.coordinates[node];
    let mut sides: Vec<[Vec<usize>; 2]> = vec![Default::default(); mesh.node_count()];
    let faces = mesh.exterior_faces().into_iter();
    for [a, b] in faces.flat_map(|face| face.segments(mesh)) {
        sides[a][1].push(b);
        sides[b][0].push(a);
    }
    let turns = |(node, [from, to]): (usize, &[Vec<usize>; 2])| match (&from[..], &to[..]) {
        ([], []) => false,
        ([from], [to]) => {
            let along = [difference(x(*from), x(node)), difference(x(node), x(*to))];
            angle(along[0], along[1]).abs() > CORNER
        }
        _ => true,
    };
    sides.iter().enumerate().map(turns).collect()
}
