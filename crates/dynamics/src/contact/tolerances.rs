//! Tolerances of contact, each a part of a computed scale, so that no result depends on the system
//! of units. Lengths are relative to the length of the segment concerned unless said otherwise. See
//! docs/theory/geometry.md.

// Geometry of surfaces and bodies.

/// Cosine of the turn beyond which a convex corner of the reference configuration is sharp (an
/// angle below 120 degrees). If the legs of a corner fold onto each other, a corner that is sharp in the reference
/// configuration stays convex; any other is a closed concave corner.
pub(crate) const SHARP_TURN_COSINE: f64 = 0.5;
/// Cosine of 30 degrees: beyond this turn in the reference configuration a surface has a corner.
pub(crate) const CORNER_COSINE: f64 = 0.866;
/// Sine of the turn in the reference configuration up to which a surface counts as straight. The same number bounds
/// four times the rise of a mid-side node (side lengths) up to which a side counts as straight.
pub(crate) const LEAST_TURN: f64 = 1e-4;
/// Ratio of the turns at both ends of a segment beyond which the segment, a chord of a fine flank that meets a coarse
/// fillet, does not belong to the curve at the end with the larger turn.
pub(crate) const UNLIKE_TURNS: f64 = 4.0;
/// Relative difference of the slopes at both ends of a curved face up to which the slopes count as equal.
pub(crate) const EQUAL_SLOPES: f64 = 1e-9;
/// Length of a segment, in lengths of a neighbour, beyond which it is straight: it is a side that ends in a fillet.
pub(crate) const LONGEST_BENT: f64 = 3.0;
/// Sine of the turn at a corner below which its two segments count as one straight face: a smooth,
/// finely meshed surface turns so little.
pub(crate) const STRAIGHT_SINE: f64 = 1e-3;
/// Sine of the angle between the legs of a corner below which they lie on each other; a sharp
/// corner and a closed concave corner then have the same tangents.
pub(crate) const FOLDED_CORNER_SINE: f64 = 0.3;
/// Distance (in side lengths of the element) by which a line may pass outside an element and still
/// count as inside: round-off of coordinates.
pub(crate) const INSIDE_ROUND_OFF: f64 = 1e-9;
/// Length of the line from a penetrating node through the body, relative to the depth of the node. If the line leaves
/// the body within this length, the node is nearer to the far side of the body.
pub(crate) const NEARER_HALF: f64 = 2.0;
/// Entry of Bn over the unknowns below which equations keep a node on its segment, so the entry is round-off of weights
/// and directions. The largest entry of Bn is of the order of 1.
pub(crate) const TIED_ROW: f64 = 1e-9;
/// Part of its reference length below which a segment has collapsed to a point and has no normal.
pub(crate) const COLLAPSED_LENGTH: f64 = 1e-9;

// Projection and search.

/// Overrun of a projection beyond the ends of a segment at which the projection still counts as on the segment. The
/// overrun covers round-off, and the sum of the tolerances of many increments for a node that sticks at the end of a
/// surface.
pub(crate) const PROJECTION_BEYOND_ENDS: f64 = 1e-6;
/// Distance up to which a node at rest pairs with a segment at rest, in mean segment lengths of the
/// contact.
pub(crate) const PAIRING_REACH: f64 = 0.5;
/// Pairing distance at rest in steps without velocities, in mean segment lengths of the contact.
pub(crate) const PAIRING_REACH_WITHOUT_VELOCITIES: f64 = 2.0;
/// Part of the pairing distance within which a node may meet a segment after the next correction.
pub(crate) const NEAR_REACH: f64 = 0.25;
/// Further distance within which a node may meet a segment after the next correction, in
/// displacements of node and segment per increment.
pub(crate) const NEAR_PER_MOTION: f64 = 2.0;
/// Growth of the circle of an entity at rest, in mean segment lengths of the contact: the entity may move this far
/// before its candidates are searched anew.
pub(crate) const SEARCH_MARGIN: f64 = 0.5;
/// Further growth of the circle of a moving entity, in displacements per increment: lists then last
/// about two increments at constant velocity.
pub(crate) const SEARCH_MARGIN_PER_MOTION: f64 = 2.0;

// Selection of targets.

/// Absolute value of a gap below which a node counts as closed at the start of an increment: a closed gap is zero to
/// the tolerance of the passes.
pub(crate) const CLOSED_GAP: f64 = 1e-9;
/// Depth of a node at the start of the analysis up to which contact pushes it out; a deeper node
/// belongs to another side of the body.
pub(crate) const INITIAL_DEPTH: f64 = 2e-3;
/// Distance from a corner, in addition to the displacement of the node, within which both segments
/// of a concave corner constrain it.
pub(crate) const CORNER_ZONE: f64 = 0.1;
/// Sine of the angle by which the surface of a node may lean away from a segment that it faces.
pub(crate) const FACING_SINE: f64 = 0.5;
/// Angle (rad) by which two normal cones may miss each other and still have a common normal: the
/// accuracy of meshed faces that are flush.
pub(crate) const CONE_MISS: f64 = 0.1;
/// Sine of the turn at a concave corner up to which one of its segments is enough to constrain a
/// node.
pub(crate) const GENTLE_SINE: f64 = 0.02;
/// Sine of the largest turn at corners across which a node slides within an increment, and tangent of the largest tilt
/// of the force on it.
pub(crate) const SLIDING_SINE: f64 = 0.5;
/// Distance beyond the end of a segment or arc, in lengths of this feature, up to which a disc still counts as over the
/// feature.
pub(crate) const END_OF_FEATURE: f64 = 1e-9;
/// Distance beyond the end of a segment from which on a node counts as having slid on to the next
/// segment.
pub(crate) const SLID: f64 = 1e-7;
/// Distance along the faces from a convex corner, within which a node meets the corner itself.
pub(crate) const CORNER_TIP: f64 = 1e-5;
/// Overrun beyond the ends of a segment up to which a node keeps the segment, if the node has left it within an
/// increment and found no other segment. The end of the increment decides whether the node has slid off.
pub(crate) const KEPT_BEYOND_ENDS: f64 = 0.1;
/// Overrun up to which a node keeps its segment once the passes have settled, even if another segment would constrain
/// it. While passes go to and fro between two targets, `KEPT_BEYOND_ENDS` applies.
pub(crate) const KEPT_WHEN_SETTLED: f64 = 1e-3;
/// Overlap below which an open pair stays open once the passes have settled. Without the bound on the overlap of open
/// pairs a force could alternate between two nodes that face each other.
pub(crate) const SETTLED_OVERLAP: f64 = 1e-10;
/// Slip of a correction along a segment, in lengths of the segment, up to which rows and targets stay: the square of
/// this number is round-off.
pub(crate) const SETTLED_SLIP: f64 = 1e-8;
/// Gap of a closed pair, or slip of a sticking pair, that is round-off of positions and solves.
pub(crate) const SOLVED_GAP: f64 = 1e-12;
/// Slip of a pair at its friction limit that is round-off, relative to gap and slip without contact forces, eq. (3.25):
/// a solution of a complementarity problem leaves about as much.
pub(crate) const LIMIT_SLIP: f64 = 1e-10;
/// Gap, slip or motion that counts as zero: the round-off of a quantity that is itself round-off of a length. Without
/// the bound for zero the remains of a motion that has died away would underflow.
pub(crate) const NOTHING: f64 = f64::EPSILON * f64::EPSILON;

/// Round-off of a gap, relative to the coordinates of its nodes.
pub(crate) const POSITION_ROUND_OFF: f64 = 4.0 * f64::EPSILON;

// Crossing and penetration.

/// Round-off of a cross product, relative to the products of which the cross product is the sum.
pub(crate) const CROSS_ROUND_OFF: f64 = 32.0 * f64::EPSILON;
/// Value of a cross or scalar product, relative to the products that are added up, above which the value is certainly
/// positive.
pub(crate) const CLEAR_PRODUCT: f64 = 1e-9;
/// Overrun beyond the ends of a moving segment at which a node still crosses the segment, so that no node slips between
/// two segments by round-off.
pub(crate) const CROSSING_BEYOND_ENDS: f64 = 1e-9;
/// Depth behind a segment that counts as round-off of positions.
pub(crate) const DEPTH_ROUND_OFF: f64 = 1e-9;
/// Depth of a node behind a segment that a closed mean gap may leave (surface to surface); a deeper node has not been
/// kept out at all.
pub(crate) const NODE_DEPTH: f64 = 0.5;
/// Depth to which a free node may clip a corner on its straight path within an increment. If an increment is halved, a
/// node that clips a corner to this depth need not be inside.
pub(crate) const CORNER_CLIP_DEPTH: f64 = 0.01;
/// Distance from the end of a segment within which a crossing is at the corner itself.
pub(crate) const SEGMENT_END: f64 = 1e-6;

// Contact from surface to surface.

/// Depth of a corner up to which only mean gaps keep the corner out (surface to surface), in lengths of the shortest
/// face at the corner and on the other surface. The depth is above round-off, so no corner closes where the mean gaps
/// are closed. A body must turn by about three times the number `CORNER_DEPTH` before the resultant on its face reaches
/// the corner. With the depth 1e-5, walls of bricks need up to a third more passes.
pub(crate) const CORNER_DEPTH: f64 = 3e-5;
/// Depth of a corner on its straight path in an increment that does not count as penetration, in the unit of
/// `CORNER_DEPTH`. A corner that slides over a segment whose face turns may reach a depth of this size.
pub(crate) const CORNER_PATH_DEPTH: f64 = 0.05;
/// Cosine of 20 degrees: a convex vertex that turns by more meets the other surface as a corner.
pub(crate) const VERTEX_COSINE: f64 = 0.94;
/// Weight, relative to the largest weight of a mean gap of a slave node, below which another mean gap may be a sliver.
pub(crate) const SLIVER: f64 = 1e-2;
/// Least cosine of the angle between a slave face and the reversed master segment at which face and segment may be in
/// contact.
pub(crate) const FACING_COSINE: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Depth relative to another segment, as a part of the depth of a face behind its segment, up to which the face counts
/// as having entered through that other segment.
pub(crate) const NEARER_DEPTH: f64 = 0.5;
/// Distance beyond the ends of a segment, in lengths of the segment, up to which a face counts as beside the segment.
pub(crate) const SIDE_BY_SIDE: f64 = 1.0;
/// Smallest part of a slave face that is a cell.
pub(crate) const LEAST_CELL: f64 = 1e-13;
/// Least part of the weight of a slave node that a mean gap must cover.
pub(crate) const LEAST_COVER: f64 = 1e-6;
/// Largest tangent of the tilt of the force at a point that has changed its segment. Beyond the largest tilt a point
/// keeps the segment of the start, unless the surface turns by half as much.
pub(crate) const POINT_TILT: f64 = 0.3;

// Preparation of a model.

/// Initial penetration above which the mesh is at fault; a smaller one comes from the digits of the coordinates.
pub(crate) const PENETRATION_FAULT: f64 = 1e-3;
/// Gap up to which a node lies on its master within the round-off of coordinates.
pub(crate) const COORDINATE_ROUND_OFF: f64 = 1e-9;
/// Clearance up to which nodes of a set, or nodes that are given a clearance, are moved to the master.
pub(crate) const ADJUSTMENT_REACH: f64 = 1.0;

// Impacts as events.

/// Gap below which a node has met its target at an impact; this gap is the accuracy with which nodes join the active
/// pairs.
pub(crate) const IMPACT_GAP: f64 = 1e-12;
/// Cosine of the turn between a touched segment and another on to which the node slides without an impact. The angle
/// corresponds to [`GENTLE_SINE`], up to which one of the two segments is the node's only target.
pub(crate) const FACING_ALIKE_COSINE: f64 = 0.9998;
