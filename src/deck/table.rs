//! The table of keywords that are read.

use super::keyword::{Data, Keyword, Parameter as P, Scope, Value as V};

const INPUT: P = P::value("INPUT", "file that holds the data lines");
const NAME: P = P::value("NAME", "name");
const TIME_DELAY: P = P::value("TIME DELAY", "delayed amplitudes are not supported").refused();
const CAE: &str = "written by Abaqus/CAE for its own use";

const OP: P = P::choice(
    "OP",
    &[
        V::read(
            "MOD",
            "what was given before is kept unless given again (default)",
        ),
        V::read("NEW", "what was given before is removed"),
    ],
    "what happens to what earlier steps gave; the first card of its kind in a step decides",
);

const AMPLITUDE: P = P::value(
    "AMPLITUDE",
    "name of the amplitude that the magnitude follows",
);

const FREQUENCY: P = P::value("FREQUENCY", "frames every so many increments; 0: ends only");
const TIME_POINTS: P = P::value(
    "TIME POINTS",
    "name of the `*TIME POINTS` that give the frames",
);
const OUTPUT_2D: P = P::value("OUTPUT", "the model is plane").ignored();
const GLOBAL: P = P::optional("GLOBAL", "there is one system of axes").ignored();
const FREQUENCY_F: P = P::value("FREQUENCYF", "contact elements are not written").ignored();
const EVERYWHERE: P = P::value("NSET", "fields are written on the whole mesh").ignored();
const ALL_ELEMENTS: P = P::value("ELSET", "fields are written on the whole mesh").ignored();
const ALL_VARIABLES: P = P::value("VARIABLE", "all variables are written").ignored();
const POSITION: P = P::value("POSITION", "stresses are written at element centres").ignored();
const SLAVE: P = P::value("SLAVE", "all contacts are written").ignored();
const MASTER: P = P::value("MASTER", "all contacts are written").ignored();
const HISTORY_EVERY: P = P::value("FREQUENCY", "histories hold every increment").ignored();
const TOTALS: P = P::value("TOTALS", "sums are always written").ignored();
const INTEGRATOR: &str = "the time integration is that of `*STICKSLIP, SCHEME=`";
const OTHER_SOLVER: &str = "a number for another solver";
const SMOOTHING: &str = "contact is enforced on the surface as meshed";
const ALWAYS_WHOLE: &str = "always written for the whole model";

/// Keywords that are read.
pub(super) static READ: &[Keyword] = &[
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
        "Nodes: number, x, y and a z that is the same for all.",
    ),
    Keyword::read(
        "ELEMENT",
        Scope::Model,
        Data::Rows,
        &[
            P::value("TYPE", "CPE3, CPS3, CPE4 or CPS4; required"),
            P::value("ELSET", "element set that takes the elements"),
            INPUT,
        ],
        "Elements: number and nodes, counter-clockwise; a row may run over several lines.",
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
            P::flag("UNSORTED", "sets have no order").ignored(),
            P::value("INSTANCE", "assembly decks are not read yet").refused(),
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
            P::value("INSTANCE", "assembly decks are not read yet").refused(),
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
                    V::read("NODE", "rows are node or node set"),
                    V::refused("SEGMENTS", "mesh the obstacle and fix it"),
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
            P::value("COMBINE", "list the faces in one surface").refused(),
            P::flag("CROP", "list the faces in one surface").refused(),
        ],
        "A surface: faces S1 = side 1-2, S2 = 2-3, S3 = 3-4 (triangle: 3-1), S4 = 4-1; without a \
         face the free sides.",
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
         Green-Lagrange strain, as in CalculiX; Abaqus' law agrees for small strains.",
    ),
    Keyword::read(
        "DENSITY",
        Scope::Block("MATERIAL"),
        Data::Required,
        &[],
        "Mass per volume.",
    ),
    Keyword::read(
        "SOLID SECTION",
        Scope::Model,
        Data::Rows,
        &[
            P::value("ELSET", "elements; required"),
            P::value("MATERIAL", "material; required"),
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
        "Begins an interaction; its laws follow. A data line (out-of-plane thickness) is ignored.",
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
        "Normal contact: exact, without penetration.",
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
         slope for CalculiX, are left out because sticking is exact.",
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
            P::value("ADJUST", "nodes are not moved before the start").refused(),
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
         orders of two surfaces may be given.",
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
                    V::refused("SMOOTH STEP", "not supported yet: give a table"),
                    V::refused("EQUALLY SPACED", "not supported yet: give a table"),
                    V::refused("PERIODIC", "not supported yet: give a table"),
                    V::refused("DECAY", "not supported yet: give a table"),
                    V::refused("MODULATED", "not supported yet: give a table"),
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
            P::value("SHIFTX", "added to the times"),
            P::value("SHIFTY", "added to the values"),
            P::value("SCALEX", "factor of the times"),
            P::value("SCALEY", "factor of the values"),
            P::value("SMOOTH", "corners are not smoothed").warned(),
        ],
        "A function of time: time, value, time, value, ...",
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
    Keyword::read(
        "BOUNDARY",
        Scope::Anywhere,
        Data::Rows,
        &[
            OP,
            AMPLITUDE,
            P::choice(
                "TYPE",
                &[
                    V::read("DISPLACEMENT", "(default)"),
                    V::refused("VELOCITY", "prescribe the displacement"),
                    V::refused("ACCELERATION", "prescribe the displacement"),
                ],
                "what is prescribed",
            ),
            P::flag("FIXED", "prescribe the displacement").refused(),
            TIME_DELAY,
            P::value("REGION TYPE", "not supported").refused(),
            P::flag("USER", "not supported").refused(),
        ],
        "Prescribed displacements: node or node set, first direction, last direction, value; or \
         a node set with XSYMM, YSYMM, ZSYMM, PINNED or ENCASTRE. Without amplitude a value grows \
         linearly over the step. Directions 3 to 6 may be given with value zero.",
    ),
    Keyword::read(
        "CLOAD",
        Scope::Step,
        Data::Rows,
        &[
            OP,
            AMPLITUDE,
            TIME_DELAY,
            P::flag("FOLLOWER", "forces keep their direction").refused(),
        ],
        "Forces: node or node set, direction, force on each node. Rows of one step add up; a \
         later step replaces.",
    ),
    Keyword::read(
        "DLOAD",
        Scope::Step,
        Data::Rows,
        &[OP, AMPLITUDE, TIME_DELAY],
        "Loads on elements (empty first field: on all): GRAV, acceleration, dx, dy; BX or BY, \
         force per reference volume; P1 to P4, pressure into the body that follows the face.",
    ),
    Keyword::read(
        "DSLOAD",
        Scope::Step,
        Data::Rows,
        &[
            OP,
            AMPLITUDE,
            TIME_DELAY,
            P::choice(
                "FOLLOWER",
                &[
                    V::read("NO", "the direction stays; needed for TRVEC"),
                    V::read("YES", "the direction follows the face; not for TRVEC"),
                ],
                "whether a traction turns with its face",
            ),
            P::choice(
                "CONSTANT RESULTANT",
                &[
                    V::read("NO", "(default)"),
                    V::refused("YES", "tractions are per reference area"),
                ],
                "whether the resultant is kept",
            ),
        ],
        "Loads on surfaces: P, pressure into the body that follows the face; TRVEC, traction per \
         reference area, dx, dy with FOLLOWER=NO.",
    ),
    // --- steps -----------------------------------------------------------------------------
    Keyword::read(
        "STEP",
        Scope::Model,
        Data::Text,
        &[
            P::optional_choice(
                "NLGEOM",
                &[
                    V::read("YES", "(default)"),
                    V::warned("NO", "displacements are large in any case"),
                ],
                "large displacements; always on",
            ),
            P::value("INC", "the number of increments has no limit").ignored(),
            P::value("NAME", "name of the step"),
            P::choice(
                "AMPLITUDE",
                &[
                    V::read("STEP", "at once (default)"),
                    V::read("RAMP", "linearly over the step"),
                ],
                "how loads without amplitude reach their magnitude",
            ),
            P::value("UNSYMM", OTHER_SOLVER).warned(),
            P::value("EXTRAPOLATION", OTHER_SOLVER).warned(),
            P::value("CONVERT SDI", OTHER_SOLVER).warned(),
            P::value("SOLVER", OTHER_SOLVER).warned(),
            P::flag("PERTURBATION", "linear perturbations are not supported").refused(),
        ],
        "Begins a step; free text may follow.",
    ),
    Keyword::read("END STEP", Scope::Step, Data::None, &[], "Ends a step."),
    Keyword::read(
        "DYNAMIC",
        Scope::Step,
        Data::Rows,
        &[
            P::optional_choice(
                "DIRECT",
                &[
                    V::read("YES", "(default)"),
                    V::read("NO", "the same as no DIRECT"),
                    V::refused(
                        "NO STOP",
                        "an increment that does not converge is not accepted",
                    ),
                ],
                "increments of fixed size",
            ),
            P::choice(
                "IMPACT",
                &[
                    V::read("NO", "no impact impulses"),
                    V::read("AVERAGE TIME", "impact impulses"),
                    V::read("CURRENT TIME", "impact impulses"),
                ],
                "what happens at impacts; `*STICKSLIP, IMPACT=` goes first",
            ),
            P::choice(
                "APPLICATION",
                &[
                    V::warned("TRANSIENT FIDELITY", INTEGRATOR),
                    V::warned("MODERATE DISSIPATION", INTEGRATOR),
                    V::refused("QUASI-STATIC", "steps are dynamic"),
                ],
                "kind of problem",
            ),
            P::optional("EXPLICIT", "the time integration is implicit").warned(),
            P::value("ALPHA", INTEGRATOR).warned(),
            P::value("BETA", INTEGRATOR).warned(),
            P::value("GAMMA", INTEGRATOR).warned(),
            P::value("TIME INTEGRATOR", INTEGRATOR).warned(),
            P::value("HAFTOL", OTHER_SOLVER).warned(),
            P::value("HALFINC SCALE FACTOR", OTHER_SOLVER).warned(),
            P::flag("NOHAF", OTHER_SOLVER).warned(),
            P::value("INITIAL", OTHER_SOLVER).warned(),
            P::value("INCREMENTATION", OTHER_SOLVER).warned(),
            P::value("SINGULAR MASS", OTHER_SOLVER).warned(),
            P::value("SCALE FACTOR", OTHER_SOLVER).warned(),
            P::flag("ELEMENT BY ELEMENT", OTHER_SOLVER).warned(),
            P::flag("FIXED TIME INCREMENTATION", OTHER_SOLVER).warned(),
            P::flag("DIRECT USER CONTROL", "use DIRECT").refused(),
            P::value("SOLVER", "use `*STICKSLIP, SOLVER=`").warned(),
            P::flag("RELATIVE TO ABSOLUTE", OTHER_SOLVER).warned(),
        ],
        "A dynamic step: increment, duration, smallest increment, largest increment.",
    ),
    Keyword::read(
        "STICKSLIP",
        Scope::Step,
        Data::None,
        &[
            P::choice(
                "SCHEME",
                &[
                    V::read(
                        "ENERGY-MOMENTUM",
                        "implicit mid-point, averaged stress (default)",
                    ),
                    V::read("SS22", "single-step SS22 with THETA1 and THETA2"),
                ],
                "time integration",
            ),
            P::value("THETA1", "weight of SS22 on velocity and load (default 1)"),
            P::value("THETA2", "weight of SS22 on acceleration (default 1)"),
            P::choice(
                "IMPACT",
                &[
                    V::read("IMPULSE", "impulses stop landing nodes (default)"),
                    V::read("NONE", "no impulses"),
                ],
                "what happens at impacts",
            ),
            P::choice(
                "IMPACT TIME",
                &[
                    V::read("INCREMENT", "nodes land within the increment (default)"),
                    V::refused("EVENT", "not available yet"),
                ],
                "when nodes land",
            ),
            P::choice(
                "LCP",
                &[
                    V::read(
                        "HYBRID",
                        "active set, with Lemke's method behind it (default)",
                    ),
                    V::read("LEMKE", "Lemke's method at every pass"),
                ],
                "solver of the complementarity problem",
            ),
            P::choice(
                "FACTORIZATION",
                &[
                    V::read("KEEP", "kept while passes converge quickly (default)"),
                    V::read("EVERY PASS", "anew at every pass"),
                ],
                "when the effective matrix is factored",
            ),
            P::choice(
                "SOLVER",
                &[
                    V::read("FAER", "supernodal LDL^T (default)"),
                    V::read("SPRS", "sprs-ldl with an AMD permutation"),
                ],
                "sparse factorisation",
            ),
            P::value(
                "TOLERANCE",
                "relative tolerance of an increment's convergence",
            ),
            P::value("MAX PASSES", "most passes of an increment"),
        ],
        "Settings of this program; they hold for the later steps too. Other codes do not know it.",
    ),
    // --- output ----------------------------------------------------------------------------
    Keyword::read(
        "OUTPUT",
        Scope::Step,
        Data::Rows,
        &[
            P::flag("FIELD", "the cards below ask for fields in frames"),
            P::flag("HISTORY", "the cards below ask for histories"),
            P::optional("DIAGNOSTICS", "diagnostics are always written").ignored(),
            FREQUENCY,
            P::value("NUMBER INTERVAL", "this many frames, evenly spaced"),
            P::value("TIME INTERVAL", "frames at multiples of this time"),
            TIME_POINTS,
            P::value("TIME MARKS", "increments are not cut for output").ignored(),
            P::value("OP", "one request of frames holds").ignored(),
            ALL_VARIABLES,
            P::value("NAME", "requests have no names").ignored(),
        ],
        "Begins output requests; the last request of frames holds, for later steps too.",
    ),
    Keyword::read(
        "NODE OUTPUT",
        Scope::Step,
        Data::Rows,
        &[
            P::value("NSET", "under `*OUTPUT, HISTORY`: node set of the history"),
            FREQUENCY,
            TIME_POINTS,
            OUTPUT_2D,
            GLOBAL,
            FREQUENCY_F,
            ALL_VARIABLES,
        ],
        "Under `*OUTPUT, HISTORY` the history of a node set; else the same as `*NODE FILE`.",
    ),
    Keyword::read(
        "NODE FILE",
        Scope::Step,
        Data::Rows,
        &[
            FREQUENCY,
            TIME_POINTS,
            EVERYWHERE,
            OUTPUT_2D,
            GLOBAL,
            FREQUENCY_F,
        ],
        "Fields on nodes in frames; all are always written on the whole mesh.",
    ),
    Keyword::read(
        "ELEMENT OUTPUT",
        Scope::Step,
        Data::Rows,
        &[
            FREQUENCY,
            TIME_POINTS,
            ALL_ELEMENTS,
            POSITION,
            OUTPUT_2D,
            GLOBAL,
            ALL_VARIABLES,
        ],
        "Fields on elements in frames; all are always written on the whole mesh.",
    ),
    Keyword::read(
        "EL FILE",
        Scope::Step,
        Data::Rows,
        &[
            FREQUENCY,
            TIME_POINTS,
            ALL_ELEMENTS,
            EVERYWHERE,
            POSITION,
            OUTPUT_2D,
            GLOBAL,
        ],
        "The same as `*ELEMENT OUTPUT`.",
    ),
    Keyword::read(
        "CONTACT OUTPUT",
        Scope::Step,
        Data::Rows,
        &[
            FREQUENCY,
            TIME_POINTS,
            SLAVE,
            MASTER,
            EVERYWHERE,
            ALL_VARIABLES,
        ],
        "Contact fields in frames; all are always written.",
    ),
    Keyword::read(
        "CONTACT FILE",
        Scope::Step,
        Data::Rows,
        &[FREQUENCY, TIME_POINTS, SLAVE, MASTER, EVERYWHERE],
        "The same as `*CONTACT OUTPUT`.",
    ),
    Keyword::read(
        "NODE PRINT",
        Scope::Step,
        Data::Rows,
        &[
            P::value("NSET", "node set of the history; required"),
            HISTORY_EVERY,
            P::value("TIME POINTS", "histories hold every increment").ignored(),
            TOTALS,
            GLOBAL,
        ],
        "The history of a node set.",
    ),
    Keyword::read(
        "EL PRINT",
        Scope::Step,
        Data::Rows,
        &[
            ALL_ELEMENTS,
            HISTORY_EVERY,
            P::value("TIME POINTS", "histories hold every increment").ignored(),
            TOTALS,
            GLOBAL,
        ],
        "Energies of the whole model are always in the history; stresses are in the frames.",
    ),
    Keyword::read(
        "CONTACT PRINT",
        Scope::Step,
        Data::Rows,
        &[SLAVE, MASTER, HISTORY_EVERY, TOTALS],
        "Contact forces of each contact are always in the history.",
    ),
    Keyword::read(
        "ENERGY OUTPUT",
        Scope::Step,
        Data::Rows,
        &[P::value("ELSET", ALWAYS_WHOLE).ignored(), ALL_VARIABLES],
        "Energies are always in the history.",
    ),
    Keyword::read(
        "TIME POINTS",
        Scope::Anywhere,
        Data::Required,
        &[
            NAME,
            P::choice(
                "TIME",
                &[
                    V::read("STEP TIME", "since the start of the step (default)"),
                    V::read("TOTAL TIME", "since the start of the analysis"),
                ],
                "which time",
            ),
            P::flag("GENERATE", "rows are first, last, increment"),
        ],
        "Times for frames.",
    ),
    Keyword::read(
        "RESTART",
        Scope::Anywhere,
        Data::None,
        &[
            P::flag("WRITE", "not available yet: left out with a warning"),
            P::flag("READ", "a run cannot be continued yet").refused(),
            P::value("FREQUENCY", "0 switches restart files off"),
            P::value("NUMBER INTERVAL", "restart frames are not written yet").ignored(),
            P::value("STEP", "a run cannot be continued yet").ignored(),
            P::value("INC", "a run cannot be continued yet").ignored(),
            P::flag("OVERLAY", "restart frames are not written yet").ignored(),
        ],
        "Restart frames, which are not written yet; FREQUENCY=0 is accepted silently.",
    ),
];
