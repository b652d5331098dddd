//! Tolerances of contact, each a part of a computed scale, so that no result depends on the system
//! of units. A length is counted in lengths of the segment concerned unless said otherwise.
//! See docs/theory/geometry.md.

// Geometry of surfaces and bodies.

/// Cosine of the turn beyond which a convex corner of the reference configuration is sharp (an
/// angle below 120 degrees): folded legs there are the corner itself, elsewhere a closed concave
/// corner.
pub(crate) const SHARP_TURN_COSINE: f64 = 0.5;
/// Cosine of 30 degrees: the turn of a surface in the reference configuration beyond which it has a corner.
pub(crate) const CORNER_COSINE: f64 = 0.866;
/// Sine of the turn of a surface in the reference configuration up to which it is straight there; and four times the rise of the
/// node between the corners of a side, in lengths of the side.
pub(crate) const LEAST_TURN: f64 = 1e-4;
/// Turn at an end of a segment, in turns at its other end, beyond which it is no part of the curve there: a chord of a fine
/// flank that meets a coarse fillet.
pub(crate) const UNLIKE_TURNS: f64 = 4.0;
/// Part of the slope of a curved face by which that at its other end may differ and is the same but for round-off.
pub(crate) const EQUAL_SLOPES: f64 = 1e-9;
/// Length of a segment, in lengths of a neighbour, beyond which it is straight: a side that ends in a fillet.
pub(crate) const LONGEST_BENT: f64 = 3.0;
/// Sine of the turn at a corner below which its two segments count as one straight face: the turn
/// of a smooth, finely meshed surface.
pub(crate) const STRAIGHT_SINE: f64 = 1e-3;
/// Sine of the angle between the legs of a corner below which they lie on each other: a sharp
/// corner and a closed concave corner have the same tangents there.
pub(crate) const FOLDED_CORNER_SINE: f64 = 0.3;
/// Distance (in side lengths of the element) by which a line may pass outside an element and still
/// go through it: round-off of coordinates.
pub(crate) const INSIDE_ROUND_OFF: f64 = 1e-9;
/// Length of the line followed into the body behind a node, in depths of the node: where it leaves
/// the body, the node is nearer to the far side.
pub(crate) const NEARER_HALF: f64 = 2.0;
/// Entry of Bn over the unknowns (whose largest is of the order of 1) below which equations keep a
/// node on its segment: round-off of weights and directions.
pub(crate) const TIED_ROW: f64 = 1e-9;
/// Part of its reference length below which a segment has collapsed to a point and has no normal.
pub(crate) const COLLAPSED_LENGTH: f64 = 1e-9;

// Projection and search.

/// Overrun of a projection beyond the ends of a segment that still counts as on it: round-off, and
/// what the tolerance of many increments adds for a node that sticks at the end of a surface.
pub(crate) const PROJECTION_BEYOND_ENDS: f64 = 1e-6;
/// Distance up to which a node at rest pairs with a segment at rest, in mean segment lengths of the
/// contact.
pub(crate) const PAIRING_REACH: f64 = 0.5;
/// The same in steps without velocities.
pub(crate) const PAIRING_REACH_WITHOUT_VELOCITIES: f64 = 2.0;
/// Part of that distance within which a node may meet a segment after the next correction.
pub(crate) const NEAR_REACH: f64 = 0.25;
/// The same in displacements per increment of both, which the distance above is besides.
pub(crate) const NEAR_PER_MOTION: f64 = 2.0;
/// Growth of the circle of an entity at rest, in mean segment lengths of the contact: it may move
/// this far before its candidates are searched anew.
pub(crate) const SEARCH_MARGIN: f64 = 0.5;
/// Further growth of the circle of a moving entity, in displacements per increment: lists then last
/// about two increments at constant velocity.
pub(crate) const SEARCH_MARGIN_PER_MOTION: f64 = 2.0;

// Selection of targets.

/// Gap, in absolute value, below which a node counts as closed at the start of an increment: a
/// closed gap is zero to the tolerance of the passes.
pub(crate) const CLOSED_GAP: f64 = 1e-9;
/// Depth of a node at the start of the analysis up to which contact pushes it out; deeper nodes
/// belong to another side of the body.
pub(crate) const INITIAL_DEPTH: f64 = 2e-3;
/// Distance from a corner, besides the displacement of the node, within which both segments of a
/// concave corner constrain it.
pub(crate) const CORNER_ZONE: f64 = 0.1;
/// Sine of the angle by which the surface of a node may lean away from a segment that it faces.
pub(crate) const FACING_SINE: f64 = 0.5;
/// Angle (rad) by which two normal cones may miss each other and still have a common normal: meshed
/// faces that are flush to that accuracy.
pub(crate) const CONE_MISS: f64 = 0.1;
/// Sine of the turn at a concave corner up to which one of its segments is enough for a node.
pub(crate) const GENTLE_SINE: f64 = 0.02;
/// Sine of the turn at corners that a node slides across within an increment, and tangent of the tilt
/// of the force on it.
pub(crate) const SLIDING_SINE: f64 = 0.5;
/// Distance beyond the end of a segment or arc, in its length, up to which a disc is over it.
pub(crate) const END_OF_FEATURE: f64 = 1e-9;
/// Distance beyond the end of a segment from which on a node has slid on to the next.
pub(crate) const SLID: f64 = 1e-7;
/// Distance from a convex corner, along the faces, within which a node meets the corner itself.
pub(crate) const CORNER_TIP: f64 = 1e-5;
/// Overrun beyond the ends of a segment up to which a node that has left it within an increment for
/// no other keeps it: whether it has slid off is decided by the end of the increment.
pub(crate) const KEPT_BEYOND_ENDS: f64 = 0.1;
/// The same once the passes have settled, even if another holds the node now. Where passes go to and fro between two
/// targets all the same, it is the number above.
pub(crate) const KEPT_WHEN_SETTLED: f64 = 1e-3;
/// Overlap below which an open pair stays open once the passes have settled, so that a force does
/// not alternate between two nodes that face each other.
pub(crate) const SETTLED_OVERLAP: f64 = 1e-10;
/// Slip of a correction along a segment, in units of its length, in which rows and targets stay: the square of it is
/// round-off.
pub(crate) const SETTLED_SLIP: f64 = 1e-8;
/// Gap of a closed pair, and slip of a sticking one, that is round-off: what positions and solves leave
/// of it.
pub(crate) const SOLVED_GAP: f64 = 1e-12;
/// Slip of a pair at its limit that is round-off: what the solution of a complementarity problem leaves of the gap and the
/// slip without contact forces, eq. (3.25).
pub(crate) const LIMIT_SLIP: f64 = 1e-10;
/// Gap, slip or motion that is none: round-off of what is itself round-off of a length. What a motion has died
/// away to would underflow otherwise.
pub(crate) const NOTHING: f64 = f64::EPSILON * f64::EPSILON;

/// Round-off of a gap, in units of the coordinates of its nodes.
pub(crate) const POSITION_ROUND_OFF: f64 = 4.0 * f64::EPSILON;

// Crossing and penetration.

/// Round-off of a cross product, in units of the products that make it.
pub(crate) const CROSS_ROUND_OFF: f64 = 32.0 * f64::EPSILON;
/// A cross or scalar product above this, in the same units, is positive beyond all doubt.
pub(crate) const CLEAR_PRODUCT: f64 = 1e-9;
/// Overrun beyond the ends of a moving segment at which a node still crosses it: no node slips
/// between two segments by round-off.
pub(crate) const CROSSING_BEYOND_ENDS: f64 = 1e-9;
/// Depth behind a segment that is round-off of positions.
pub(crate) const DEPTH_ROUND_OFF: f64 = 1e-9;
/// Depth of a node behind a segment that means of gaps may leave it: what is beyond has not been held.
pub(crate) const NODE_DEPTH: f64 = 0.5;
/// Depth to which a free node may clip a corner on its straight path within an increment; halving
/// the increment need not find a node inside when it is less.
pub(crate) const CORNER_CLIP_DEPTH: f64 = 0.01;
/// Distance from the end of a segment at which a crossing is at the corner itself.
pub(crate) const SEGMENT_END: f64 = 1e-6;

// Contact from surface to surface.

/// Depth of a corner that is left to the means, in lengths of the shortest face at it and of the other surface: above
/// round-off, so that no corner closes where the means are closed. A body turns by about three times as much before the
/// resultant of its face comes to the corner. With 1e-5 walls of bricks take up to a third more passes.
pub(crate) const CORNER_DEPTH: f64 = 3e-5;
/// Depth of a corner on its straight path in an increment that is no penetration, in the same lengths: of one that slides
/// over a segment whose face turns.
pub(crate) const CORNER_PATH_DEPTH: f64 = 0.05;
/// Cosine of 20 degrees: the turn at a convex vertex beyond which it meets the other surface as a corner does.
pub(crate) const VERTEX_COSINE: f64 = 0.94;
/// Part of the weight of the largest mean of a slave node, below which another may be a sliver.
pub(crate) const SLIVER: f64 = 1e-2;
/// Least cosine of the angle between a slave face and the reversed master segment at which both take part.
pub(crate) const FACING_COSINE: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Part of the depth of a face behind a segment at which it is behind another, through which it has come in.
pub(crate) const NEARER_DEPTH: f64 = 0.5;
/// Distance beyond the ends of a segment, in its length, up to which a face is beside it.
pub(crate) const SIDE_BY_SIDE: f64 = 1.0;
/// Part of a slave face that is no cell.
pub(crate) const LEAST_CELL: f64 = 1e-13;
/// Part of the weight of a slave node that must be covered.
pub(crate) const LEAST_COVER: f64 = 1e-6;
/// Tangent of the tilt of the force at a point that has changed its segment, beyond which it keeps the segment of the
/// start, unless the surface turns by half as much.
pub(crate) const POINT_TILT: f64 = 0.3;

// Preparation of a model.

/// A larger initial penetration is a fault of the mesh; a smaller one comes from the digits of the coordinates.
pub(crate) const PENETRATION_FAULT: f64 = 1e-3;
/// Gap of a node that lies on its master up to round-off of the coordinates.
pub(crate) const COORDINATE_ROUND_OFF: f64 = 1e-9;
/// Clearance up to which the nodes of a set, or those that get a clearance, are moved to the master.
pub(crate) const ADJUSTMENT_REACH: f64 = 1.0;

// Impacts as events.

/// Gap below which a node has met its target at an impact; it joins with this accuracy.
pub(crate) const IMPACT_GAP: f64 = 1e-12;
/// Cosine of the turn from a touched segment to another that a node slides on to without an impact: that of
/// [`GENTLE_SINE`], up to which one of the two is its only target.
pub(crate) const FACING_ALIKE_COSINE: f64 = 0.9998;
