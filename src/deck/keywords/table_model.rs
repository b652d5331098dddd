//! The table of keywords that describe the model.

use super::keyword::{Data, Keyword, Parameter as P, Scope, Value as V};

const INPUT: P = P::value("INPUT", "file that holds the data lines");
const NAME: P = P::value("NAME", "name");
const OF_INSTANCE: &str = "in the assembly: the rows are numbers and sets of this instance";
const CAE: &str = "written by Abaqus/CAE for its own use";
const OTHER_SOLVER: &str = "a number for another solver";
const ONLY_NEO_HOOKE: &str =
    "only NEO HOOKE is supported: C10, D1 with C10 = mu/2, D1 = 2/K of small strains";
const SMOOTHING: &str = "contact is enforced on the surface as meshed";

/// Keywords of the model.
pub(crate) static MODEL: &[Keyword] = &[
    // --- structure -------------------------------------------------------------------------
    Keyword::read(
        "HEADING",
        Scope::Model,
        Data::Text,
        &[],
        "The title: free text until the next keyword.",
    ),
    Keyword::read(
        "INCLUDE",
        Scope::Anywhere,
        Data::None,
        &[P::value(
            "INPUT",
            "path, seen from the including file or else from the main deck",
        )],
        "The lines of another file in this place.",
    ),
    // --- mesh and sets ---------------------------------------------------------------------
    Keyword::read(
        "NODE",
        Scope::Model,
        Data::Rows,
        &[
            P::value("NSET", "node set that takes the nodes"),
            INPUT,
            P::choice(
                "SYSTEM",
                &[
                    V::read("R", "rectangular (default)"),
                    V::refused("C", "cylindrical coordinates are not supported"),
                    V::refused("S", "spherical coordinates are not supported"),
                ],
                "coordinate system",
            ),
        ],
        "Nodes: number (1 to 999 999 999), x, y and a z that is the same for all.",
    ),
    Keyword::read(
        "ELEMENT",
        Scope::Model,
        Data::Rows,
        &[
            P::value(
                "TYPE",
                "CPE3, CPS3, CPE4 or CPS4; T3D2, T2D2, B21 or B31 for line elements; required",
            ),
            P::value("ELSET", "element set that takes the elements"),
            INPUT,
        ],
        "Elements: number (1 to 999 999 999) and nodes, counter-clockwise; a row may run over several \
         lines. A line element, as Gmsh writes for boundary curves, has two nodes and names the side \
         of a plane element between them: sets of them make surfaces and node sets.",
    ),
    Keyword::read(
        "NSET",
        Scope::Model,
        Data::Rows,
        &[
            P::value("NSET", "name; required; a name used again adds to the set"),
            P::flag("GENERATE", "rows are first, last, increment"),
            P::value("ELSET", "element set whose nodes are taken"),
            INPUT,
            P::flag("INTERNAL", CAE).ignored(),
            P::flag(
                "UNSORTED",
                "sets have no order: *EQUATION refuses an unsorted one",
            ),
            P::value("INSTANCE", OF_INSTANCE),
        ],
        "A node set: nodes and node sets, whole or as ranges.",
    ),
    Keyword::read(
        "ELSET",
        Scope::Model,
        Data::Rows,
        &[
            P::value("ELSET", "name; required; a name used again adds to the set"),
            P::flag("GENERATE", "rows are first, last, increment"),
            INPUT,
            P::flag("INTERNAL", CAE).ignored(),
            P::flag("UNSORTED", "sets have no order").ignored(),
            P::value("INSTANCE", OF_INSTANCE),
        ],
        "An element set: elements and element sets, whole or as ranges.",
    ),
    Keyword::read(
        "SURFACE",
        Scope::Model,
        Data::Required,
        &[
            NAME,
            P::choice(
                "TYPE",
                &[
                    V::read("ELEMENT", "rows are element or element set, face (default)"),
                    V::read(
                        "NODE",
                        "rows are node or node set, and an area that has no effect (warning unless 1)",
                    ),
                    V::read(
                        "SEGMENTS",
                        "a rigid profile; rows are START, x, y; LINE, x, y; CIRCL, x, y, xc, yc",
                    ),
                    V::refused("CYLINDER", "surfaces of solids are not plane"),
                    V::refused("REVOLUTION", "surfaces of solids are not plane"),
                    V::refused("CUTTING SURFACE", "list the faces"),
                    V::refused("USER", "user surfaces are not supported"),
                ],
                "what the surface is made of",
            ),
            P::flag("INTERNAL", CAE).ignored(),
            P::value("TRIM", SMOOTHING).warned(),
            P::value("MAX RATIO", SMOOTHING).warned(),
            P::flag("NO THICK", SMOOTHING).warned(),
            P::flag("NO OFFSET", SMOOTHING).warned(),
            P::value("FILLET RADIUS", "give the arcs with CIRCL").refused(),
            P::value("COMBINE", "list the faces in one surface").refused(),
            P::flag("CROP", "list the faces in one surface").refused(),
        ],
        "A surface: faces S1 = side 1-2, S2 = 2-3, S3 = 3-4 (triangle: 3-1), S4 = 4-1; without a \
         face the free sides, and those that line elements name. The outside of a rigid profile lies on the left of the way from START, \
         the obstacle on the right; an arc (less than 180 degrees) is cut into equal chords of at \
         most 1 degree, 3.8e-5 of its radius off the arc at most.",
    ),
    Keyword::read(
        "RIGID BODY",
        Scope::Model,
        Data::None,
        &[
            P::value("ANALYTICAL SURFACE", "surface of TYPE=SEGMENTS; required"),
            P::value("REF NODE", "node, or node set of one node; required"),
            P::value("ELSET", "fix or prescribe all nodes of the elements").refused(),
            P::value("NSET", "fix or prescribe all nodes").refused(),
            P::value("PIN NSET", "fix or prescribe all nodes").refused(),
            P::value("TIE NSET", "fix or prescribe all nodes").refused(),
            P::value("ROT NODE", "rotation is not supported").refused(),
            P::value(
                "POSITION",
                "without rotation the place of the node does not matter",
            )
            .ignored(),
            P::optional("ISOTHERMAL", "there are no temperatures").ignored(),
        ],
        "Moves a rigid surface with its reference node, whose directions 1 and 2 are prescribed in \
         every step; it does not turn. Its points become nodes without element, numbered from the \
         largest node number of the deck on.",
    ),
    // --- materials and sections ------------------------------------------------------------
    Keyword::read(
        "MATERIAL",
        Scope::Model,
        Data::None,
        &[
            NAME,
            P::optional("RTOL", OTHER_SOLVER).warned(),
            P::value("STRAIN RATE REGULARIZATION", OTHER_SOLVER).warned(),
            P::optional("SRATE FACTOR", OTHER_SOLVER).warned(),
        ],
        "Begins a material; its constants follow.",
    ),
    Keyword::read(
        "ELASTIC",
        Scope::Block("MATERIAL"),
        Data::Required,
        &[P::choice(
            "TYPE",
            &[
                V::read("ISO", "(default)"),
                V::read("ISOTROPIC", "the same"),
                V::refused("ORTHO", "only isotropic elasticity is supported"),
                V::refused("ORTHOTROPIC", "only isotropic elasticity is supported"),
                V::refused(
                    "ENGINEERING CONSTANTS",
                    "only isotropic elasticity is supported",
                ),
                V::refused("LAMINA", "only isotropic elasticity is supported"),
                V::refused("ANISO", "only isotropic elasticity is supported"),
                V::refused("ANISOTROPIC", "only isotropic elasticity is supported"),
                V::refused("TRACTION", "only isotropic elasticity is supported"),
                V::refused("SHEAR", "only isotropic elasticity is supported"),
            ],
            "symmetry",
        )],
        "E, nu of a St. Venant-Kirchhoff material: second Piola-Kirchhoff stress linear in the \
         Green-Lagrange strain, as in CalculiX; Abaqus' law agrees for small strains. In plane strain \
         elements lock from nu = 0.45 on (warning). A temperature in the third field has no effect \
         (warning).",
    ),
    Keyword::read(
        "HYPERELASTIC",
        Scope::Block("MATERIAL"),
        Data::Required,
        &[
            P::flag("NEO HOOKE", "the form of the energy; required"),
            P::flag("MOONEY-RIVLIN", ONLY_NEO_HOOKE).refused(),
            P::flag("YEOH", ONLY_NEO_HOOKE).refused(),
            P::flag("OGDEN", ONLY_NEO_HOOKE).refused(),
            P::flag("ARRUDA-BOYCE", ONLY_NEO_HOOKE).refused(),
            P::flag("POLYNOMIAL", ONLY_NEO_HOOKE).refused(),
            P::flag("REDUCED POLYNOMIAL", ONLY_NEO_HOOKE).refused(),
            P::flag("MARLOW", ONLY_NEO_HOOKE).refused(),
            P::flag("VAN DER WAALS", ONLY_NEO_HOOKE).refused(),
            P::flag("USER", ONLY_NEO_HOOKE).refused(),
            P::value("N", "order of other forms"),
            P::flag("TEST DATA INPUT", "give C10 and D1 on the data line").refused(),
            P::value(
                "POISSON",
                "give D1 = 3 (1 - 2 nu)/(2 C10 (1 + nu)) on the data line",
            )
            .refused(),
            P::choice(
                "MODULI",
                &[
                    V::read("INSTANTANEOUS", "(default)"),
                    V::refused("LONG TERM", "materials have no memory"),
                ],
                "moduli that the data line gives",
            ),
        ],
        "C10, D1 of a neo-Hookean material, for large strains in plane strain: U = C10 (Ibar1 - 3) + \
         (J - 1)^2/D1; at small strains the shear modulus is mu = 2 C10, the bulk modulus K = 2/D1. D1 is \
         required and positive: an incompressible material (D1 = 0) and plane stress are errors. A \
         material has *ELASTIC or *HYPERELASTIC. Where (3 K - 2 mu)/(6 K + 2 mu), Poisson's ratio at small \
         strains, is 0.45 or more, elements lock unless their section has FORMULATION=MEAN DILATATION \
         (warning). A temperature in the third field has no effect (warning).",
    ),
    Keyword::read(
        "DENSITY",
        Scope::Block("MATERIAL"),
        Data::Required,
        &[],
        "Mass per volume; a temperature in the second field has no effect (warning).",
    ),
    Keyword::read(
        "DAMPING",
        Scope::Block("MATERIAL"),
        Data::None,
        &[
            P::value(
                "ALPHA",
                "damping in proportion to the mass: ratio ALPHA/(2 omega) of a mode; also brakes the \
                 free flight of bodies without support (warning)",
            ),
            P::value(
                "BETA",
                "damping in proportion to the elasticity at small strains: ratio BETA omega/2 of a \
                 mode; none in rigid motion, momenta are kept",
            ),
            P::value(
                "COMPOSITE",
                "there are no modes to damp: give ALPHA and BETA",
            )
            .refused(),
            P::value(
                "STRUCTURAL",
                "give BETA, which damps in proportion to the rate",
            )
            .refused(),
        ],
        "Damping of a material (Rayleigh): at least one of ALPHA (1/time) and BETA (time), not \
         negative. What it dissipates is a term of the energy balance.",
    ),
    Keyword::read(
        "SOLID SECTION",
        Scope::Model,
        Data::Rows,
        &[
            P::value("ELSET", "elements; required"),
            P::value("MATERIAL", "material; required"),
            P::choice(
                "FORMULATION",
                &[
                    V::read("DISPLACEMENT", "strains of the displacements (default)"),
                    V::read(
                        "MEAN DILATATION",
                        "one volume strain per element, for nearly incompressible materials; CPE4 only",
                    ),
                ],
                "how strains follow from the displacements",
            ),
            P::value("CONTROLS", OTHER_SOLVER).warned(),
            P::value("ORIENTATION", "materials are isotropic").refused(),
            P::flag("NODAL THICKNESS", "the thickness is constant").refused(),
            P::flag("COMPOSITE", "an element has one material").refused(),
        ],
        "Material and thickness (default 1) of elements.",
    ),
    // --- contact ---------------------------------------------------------------------------
    Keyword::read(
        "SURFACE INTERACTION",
        Scope::Model,
        Data::Rows,
        &[
            NAME,
            P::optional("TRACKING THICKNESS", SMOOTHING).warned(),
            P::optional("PAD THICKNESS", "surfaces have no pads").refused(),
            P::flag("USER", "user interactions are not supported").refused(),
        ],
        "Begins an interaction; its laws follow. The out-of-plane thickness on a data line has no \
         effect (warning unless 1).",
    ),
    Keyword::read(
        "SURFACE BEHAVIOR",
        Scope::Block("SURFACE INTERACTION"),
        Data::Rows,
        &[
            P::choice(
                "PRESSURE-OVERCLOSURE",
                &[
                    V::read("HARD", "no penetration (default)"),
                    V::warned("LINEAR", "taken as HARD: contact is enforced exactly"),
                    V::refused("EXPONENTIAL", "soft contact is not supported"),
                    V::refused("TABULAR", "soft contact is not supported"),
                    V::refused("SCALE FACTOR", "soft contact is not supported"),
                    V::refused("TIED", "surfaces cannot be tied yet"),
                ],
                "law between pressure and penetration",
            ),
            P::flag("DIRECT", "contact is enforced exactly").ignored(),
            P::optional("PENALTY", "contact is enforced exactly").warned(),
            P::flag("AUGMENTED LAGRANGE", "contact is enforced exactly").warned(),
            P::flag("NO SEPARATION", "surfaces always separate").refused(),
        ],
        "Normal contact: exact, without penetration; numbers on a data line have no effect (warning).",
    ),
    Keyword::read(
        "FRICTION",
        Scope::Block("SURFACE INTERACTION"),
        Data::Rows,
        &[
            P::flag("LAGRANGE", "sticking is exact").ignored(),
            P::value("ELASTIC SLIP", "sticking is exact").warned(),
            P::value("SLIP TOLERANCE", "sticking is exact").warned(),
            P::flag("ROUGH", "give a large coefficient of friction").refused(),
            P::value("TAUMAX", "shear stress has no limit but Coulomb's").refused(),
            P::optional("EXPONENTIAL DECAY", "friction does not depend on slip rate").refused(),
            P::flag("ANISOTROPIC", "friction is isotropic").refused(),
            P::flag("USER", "user friction is not supported").refused(),
        ],
        "Coulomb's coefficient of friction mu; further fields, a slip rate for Abaqus and a stick \
         slope for CalculiX, are left out because sticking is exact (warning).",
    ),
    Keyword::read(
        "CONTACT PAIR",
        Scope::Model,
        Data::Required,
        &[
            P::value("INTERACTION", "name of the interaction; required"),
            P::choice(
                "TYPE",
                &[
                    V::read(
                        "NODE TO SURFACE",
                        "slave nodes against master segments (default)",
                    ),
                    V::warned("SURFACE TO SURFACE", "taken as NODE TO SURFACE"),
                    V::warned("MORTAR", "taken as NODE TO SURFACE"),
                    V::warned("MASSLESS", "taken as NODE TO SURFACE"),
                ],
                "discretisation",
            ),
            P::flag("SMALL SLIDING", "sliding is finite").warned(),
            P::value(
                "ADJUST",
                "largest clearance, or node set, of the slave nodes that are moved onto the master \
                 before the start, free of strain; with a clearance those inside the master too",
            ),
            P::flag("TIED", "surfaces cannot be tied yet").refused(),
            P::value("EXTENSION ZONE", SMOOTHING).warned(),
            P::value("SMOOTH", SMOOTHING).warned(),
            P::value("HCRIT", SMOOTHING).warned(),
            P::flag("NO THICKNESS", SMOOTHING).warned(),
            P::value("TRACKING", SMOOTHING).warned(),
            P::value("MINIMUM DISTANCE", SMOOTHING).warned(),
            P::value("GEOMETRIC CORRECTION", SMOOTHING).warned(),
            P::value("MECHANICAL CONSTRAINT", "contact is enforced exactly").warned(),
            P::value("CPSET", "there are no contact controls").warned(),
            P::value("WEIGHT", "the slave's nodes meet the master's segments").warned(),
            P::flag("LINEAR", SMOOTHING).warned(),
            P::value("OP", "contact pairs hold for all steps").refused(),
        ],
        "Slave surface, master surface; one contact per row. The master consists of faces; both \
         orders of two surfaces may be given. One surface alone touches itself. Nodes that start \
         inside the master body by more than 0.001 of a segment are an error unless ADJUST= moves \
         them; a pair of which no node faces the master at the start is a warning.",
    ),
    Keyword::read(
        "CONTACT",
        Scope::Model,
        Data::None,
        &[P::value("OP", "contacts hold for all steps").refused()],
        "Begins general contact: every exterior face against every other, of its own body too, and \
         every exterior node against the rigid surfaces.",
    ),
    Keyword::read(
        "CONTACT INCLUSIONS",
        Scope::Block("CONTACT"),
        Data::Rows,
        &[P::flag(
            "ALL EXTERIOR",
            "all faces that belong to one element only; required",
        )],
        "What takes part in general contact: a surface ALL_EXTERIOR is made, which touches itself and \
         every rigid surface. The nodes of a *CONTACT PAIR with a rigid surface are held by the pair, \
         with its interaction, and left out of general contact with that surface; rigid surfaces do not \
         touch each other.",
    ),
    Keyword::read(
        "CONTACT PROPERTY ASSIGNMENT",
        Scope::Block("CONTACT"),
        Data::Required,
        &[],
        "Interaction of general contact: a row of two empty fields, which stand for all surfaces, \
         and its name. Without it there is no friction.",
    ),
    // --- amplitudes, initial and boundary conditions, loads --------------------------------
    Keyword::read(
        "AMPLITUDE",
        Scope::Anywhere,
        Data::Required,
        &[
            NAME,
            INPUT,
            P::choice(
                "DEFINITION",
                &[
                    V::read(
                        "TABULAR",
                        "linear between points, constant outside (default)",
                    ),
                    V::read(
                        "SMOOTH STEP",
                        "x^3 (10 - 15 x + 6 x^2) of the way between points, constant outside",
                    ),
                    V::read(
                        "EQUALLY SPACED",
                        "value, value, ... at equal intervals of time, linear between them",
                    ),
                    V::read(
                        "PERIODIC",
                        "N, w, t0, A0 on the first line, then A1, B1, A2, B2, ...: A0 + sum of \
                         An cos n w (t - t0) + Bn sin n w (t - t0) from t0 on, A0 before",
                    ),
                    V::read(
                        "DECAY",
                        "A0, A, t0, td: A0 + A exp(-(t - t0) / td) from t0 on, A0 before",
                    ),
                    V::read(
                        "MODULATED",
                        "A0, A, t0, w1, w2: A0 + A sin w1 (t - t0) sin w2 (t - t0) from t0 on, \
                         A0 before",
                    ),
                    V::refused("USER", "not supported"),
                    V::refused("BUBBLE", "not supported"),
                    V::refused("SOLUTION DEPENDENT", "not supported"),
                    V::refused("ACTUATOR", "not supported"),
                ],
                "kind of curve",
            ),
            P::choice(
                "TIME",
                &[
                    V::read("STEP TIME", "since the start of the step (default)"),
                    V::read("TOTAL TIME", "since the start of the analysis"),
                ],
                "which time",
            ),
            P::choice(
                "VALUE",
                &[
                    V::read("RELATIVE", "factor of the magnitude (default)"),
                    V::read("ABSOLUTE", "the same: the magnitude is multiplied"),
                ],
                "meaning of the values",
            ),
            P::value("FIXED INTERVAL", "time between equally spaced values"),
            P::value(
                "BEGIN",
                "time of the first equally spaced value (default 0)",
            ),
            P::value("SHIFTX", "added to the times"),
            P::value("SHIFTY", "added to the values"),
            P::value("SCALEX", "factor of the times"),
            P::value("SCALEY", "factor of the values"),
            P::value("SMOOTH", "corners are not smoothed").warned(),
        ],
        "A function of time: time, value, time, value, ..., or as DEFINITION says. CalculiX reads \
         tables only.",
    ),
    Keyword::read(
        "EQUATION",
        Scope::Model,
        Data::Required,
        &[INPUT],
        "Linear equations between displacements, a1 u1 + a2 u2 + ... = 0 at all times: the number of \
         terms on a line, then node or node set, direction, coefficient of each, four terms on a line; \
         any number of equations. Sets give an equation for every node, in the order of the numbers; \
         those after the first have as many nodes, or one. The first term is eliminated: no *BOUNDARY \
         may prescribe it and no other equation eliminate it; the others may be prescribed, or \
         eliminated by other equations. A node without element moves as its equations say. The \
         forces of the equations are in RF; their first terms start with the velocities that follow \
         from those of the others.",
    ),
    Keyword::read(
        "INITIAL CONDITIONS",
        Scope::Model,
        Data::Required,
        &[
            P::choice(
                "TYPE",
                &[
                    V::read("VELOCITY", "node or node set, direction, velocity"),
                    V::refused("STRESS", "bodies start without stress"),
                    V::refused("TEMPERATURE", "there are no temperatures"),
                    V::refused("DISPLACEMENT", "bodies start as meshed"),
                    V::refused("PLASTIC STRAIN", "materials are elastic"),
                ],
                "what is given; required",
            ),
            INPUT,
        ],
        "Initial velocities; a later row replaces an earlier one.",
    ),
];
