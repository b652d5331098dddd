//! The table of keywords that describe steps, with their loads and output.

use super::keyword::{Data, Keyword, Parameter as P, Scope, Value as V};

const NAME: P = P::value("NAME", "name");
const TIME_DELAY: P = P::value("TIME DELAY", "delayed amplitudes are not supported").refused();
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
    "name of the *TIME POINTS that give the frames",
);
const OUTPUT_2D: P = P::value("OUTPUT", "the model is plane").ignored();
const GLOBAL: P = P::optional("GLOBAL", "there is one system of axes").ignored();
const FREQUENCY_F: P = P::value("FREQUENCYF", "contact elements are not written").ignored();
const EVERYWHERE: P = P::value("NSET", "fields are written on the whole mesh").ignored();
const ALL_ELEMENTS: P = P::value("ELSET", "fields are written on the whole mesh").ignored();
const ALL_VARIABLES: P = P::value("VARIABLE", "all variables are written").ignored();
const POSITION: P = P::value("POSITION", "stresses are written at element centres").ignored();
const YES_NO: &[V] = &[V::read("YES", ""), V::read("NO", "")];
const DIRECTIONS: P = P::choice(
    "DIRECTIONS",
    YES_NO,
    "stresses are those in the axes x and y",
)
.ignored();
const SUMMARY: P = P::choice("SUMMARY", YES_NO, "histories have no tables to sum up").ignored();
const CONTACT_ELEMENTS: P =
    P::flag("CONTACT ELEMENTS", "contact elements are not written").ignored();
const LAST_ITERATIONS: P =
    P::flag("LAST ITERATIONS", "frames hold accepted increments only").ignored();
const HISTORY_TIMES: P = P::value("TIME POINTS", "histories hold every increment").ignored();
const SLAVE: P = P::value("SLAVE", "all contacts are written").ignored();
const MASTER: P = P::value("MASTER", "all contacts are written").ignored();
const HISTORY_EVERY: P = P::value("FREQUENCY", "histories hold every increment").ignored();
const FOLLOWER: P = P::choice(
    "FOLLOWER",
    &[
        V::read("NO", "the direction stays; needed for TRVEC"),
        V::read("YES", "the direction follows the face; not for TRVEC"),
    ],
    "whether a traction turns with its face",
);
const TOTALS: P = P::choice(
    "TOTALS",
    &[
        V::read("NO", "motion and reactions of every node too (default)"),
        V::read("YES", "the same"),
        V::read(
            "ONLY",
            "sums and means only, unless another card asks for all",
        ),
    ],
    "sums over the set are always in the history",
);
const CONTACT_TOTALS: P = P::value("TOTALS", "sums are always written").ignored();
const ENERGY_TOTALS: P = P::value(
    "TOTALS",
    "energies of the model and of every body are always written",
)
.ignored();
const INTEGRATOR: &str = "the time integration is that of *STICKSLIP, SCHEME=";
const OTHER_SOLVER: &str = "a number for another solver";
const ALWAYS_WHOLE: &str = "always written for the whole model";

/// Keywords of steps.
pub(crate) static STEPS: &[Keyword] = &[
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
                    V::read(
                        "VELOCITY",
                        "constant, without AMPLITUDE; it goes on in later steps",
                    ),
                    V::refused("ACCELERATION", "prescribe the displacement"),
                ],
                "what is prescribed",
            ),
            P::flag("FIXED", "prescribe the displacement").refused(),
            TIME_DELAY,
            P::value("REGION TYPE", "not supported").refused(),
            P::flag("USER", "not supported").refused(),
        ],
        "Prescribed displacements or velocities: node or node set, first direction, last direction, \
         value; or a node set with XSYMM, YSYMM, ZSYMM, XASYMM, YASYMM, ZASYMM, PINNED or ENCASTRE. \
         Without amplitude a displacement grows linearly over the step. Directions 3 to 6 may be \
         given with value zero.",
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
        &[OP, AMPLITUDE, TIME_DELAY, FOLLOWER],
        "Loads on elements (empty first field: on all): GRAV, acceleration, dx, dy; BX or BY, \
         force per reference volume; P1 to P4, pressure into the body that follows the face; TRVEC1 \
         to TRVEC4, traction on the face, dx, dy, which keeps its direction (with FOLLOWER=NO).",
    ),
    Keyword::read(
        "DSLOAD",
        Scope::Step,
        Data::Rows,
        &[
            OP,
            AMPLITUDE,
            TIME_DELAY,
            FOLLOWER,
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
                "what happens at impacts; *STICKSLIP, IMPACT= goes first",
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
            P::value("SOLVER", "use *STICKSLIP, SOLVER=").warned(),
            P::flag("RELATIVE TO ABSOLUTE", OTHER_SOLVER).warned(),
        ],
        "A dynamic step: increment, duration, smallest increment, largest increment. Increments that \
         fail are halved; none grows beyond the first, with DIRECT or without (a warning without). The \
         largest increment bounds the first one, and has no effect with DIRECT (warning).",
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
                    V::read(
                        "EVENT",
                        "increments are cut at impacts, where the impulses act",
                    ),
                ],
                "when nodes land",
            ),
            P::choice(
                "LANDING",
                &[
                    V::read("PLASTIC", "what landings take is lost (default)"),
                    V::read(
                        "RETURN",
                        "it is given back as kinetic energy (not with SS22)",
                    ),
                ],
                "energy that contact takes at landings",
            ),
            P::choice(
                "CONTACT MASS",
                &[
                    V::read("CONSISTENT", "that of the elements (default)"),
                    V::read(
                        "REDISTRIBUTED",
                        "carried by the nodes behind the surface: no node lands with mass",
                    ),
                ],
                "mass of the nodes of contact surfaces, the same in all steps",
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
        "Begins output requests; the last request of frames holds, for later steps too. Histories hold \
         every increment, whatever the times asked for.",
    ),
    Keyword::read(
        "NODE OUTPUT",
        Scope::Step,
        Data::Rows,
        &[
            P::value(
                "NSET",
                "under *OUTPUT, HISTORY: node set of the history; else without effect, fields are \
                 written on the whole mesh",
            ),
            FREQUENCY,
            TIME_POINTS,
            OUTPUT_2D,
            GLOBAL,
            FREQUENCY_F,
            ALL_VARIABLES,
            CONTACT_ELEMENTS,
            LAST_ITERATIONS,
        ],
        "Under *OUTPUT, HISTORY the history of a node set; else the same as *NODE FILE.",
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
            CONTACT_ELEMENTS,
            LAST_ITERATIONS,
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
            DIRECTIONS,
            CONTACT_ELEMENTS,
            LAST_ITERATIONS,
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
            DIRECTIONS,
            CONTACT_ELEMENTS,
            LAST_ITERATIONS,
        ],
        "The same as *ELEMENT OUTPUT.",
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
            CONTACT_ELEMENTS,
            LAST_ITERATIONS,
        ],
        "Contact fields in frames; all are always written.",
    ),
    Keyword::read(
        "CONTACT FILE",
        Scope::Step,
        Data::Rows,
        &[
            FREQUENCY,
            TIME_POINTS,
            SLAVE,
            MASTER,
            EVERYWHERE,
            CONTACT_ELEMENTS,
            LAST_ITERATIONS,
        ],
        "The same as *CONTACT OUTPUT.",
    ),
    Keyword::read(
        "NODE PRINT",
        Scope::Step,
        Data::Rows,
        &[
            P::value("NSET", "node set of the history; required"),
            HISTORY_EVERY,
            HISTORY_TIMES,
            TOTALS,
            GLOBAL,
            SUMMARY,
        ],
        "The history of a node set: sums of forces, mean motion, and every node.",
    ),
    Keyword::read(
        "EL PRINT",
        Scope::Step,
        Data::Rows,
        &[
            ALL_ELEMENTS,
            HISTORY_EVERY,
            HISTORY_TIMES,
            ENERGY_TOTALS,
            GLOBAL,
            POSITION,
            SUMMARY,
        ],
        "Energies of the model and of every body are always in the history; stresses are in the frames.",
    ),
    Keyword::read(
        "CONTACT PRINT",
        Scope::Step,
        Data::Rows,
        &[
            SLAVE,
            MASTER,
            HISTORY_EVERY,
            HISTORY_TIMES,
            CONTACT_TOTALS,
            SUMMARY,
        ],
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
        "Times for frames; those outside a step are left out in it.",
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
