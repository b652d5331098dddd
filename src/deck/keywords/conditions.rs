//! The rows of the keyword table for amplitudes, constraints, initial conditions, supports and loads.

use super::common::{INPUT, NAME};
use super::types::{
    ACCELERATION, Data, FORCE, FORCE_PER_VOLUME, Keyword, LENGTH, PER_TIME, Parameter as P, STRESS,
    Scope, TIME, VELOCITY, Value as V, of, plain, row,
};

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
const FOLLOWER: P = P::choice(
    "FOLLOWER",
    &[
        V::read("NO", "the direction stays; needed for TRVEC"),
        V::read("YES", "the direction follows the face; not for TRVEC"),
    ],
    "whether a traction turns with its face",
);
const CONSTRAINT: &str = "Constraints between nodes are linear equations: use *EQUATION.";
const LINEAR: &str = "*EQUATION\n\
         2\n\
         13, 2, 1., 14, 2, -1.";
const DISCRETE: &str = "Springs, dashpots, masses and connectors are not supported yet.";
const THERMAL: &str = "There are no temperatures.";
const FIELD_LOAD: &str = "Only mechanical loads are supported.";
const FORCES: &str = "*CLOAD\n\
         13, 1, -50.\n\
         14, 2, 20.";
const SUPPORT: &str = "*BOUNDARY\n\
         NFIX, 1, 2";

pub(super) static CONDITIONS: &[Keyword] = &[
    Keyword::read(
        "AMPLITUDE",
        Scope::Anywhere,
        Data::Required(&[
            row(&[plain("value")])
                .repeating(1)
                .under("DEFINITION", "EQUALLY SPACED"),
            row(&[plain("N"), of("w", PER_TIME), of("t0", TIME), plain("A0")])
                .first()
                .under("DEFINITION", "PERIODIC"),
            row(&[plain("A"), plain("B")])
                .repeating(2)
                .under("DEFINITION", "PERIODIC"),
            row(&[plain("A0"), plain("A"), of("t0", TIME), of("td", TIME)])
                .under("DEFINITION", "DECAY"),
            row(&[
                plain("A0"),
                plain("A"),
                of("t0", TIME),
                of("w1", PER_TIME),
                of("w2", PER_TIME),
            ])
            .under("DEFINITION", "MODULATED"),
            row(&[of("time", TIME), plain("value")]).repeating(2),
        ]),
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
            P::value("FIXED INTERVAL", "time between equally spaced values").measuring(TIME),
            P::value(
                "BEGIN",
                "time of the first equally spaced value (default 0)",
            )
            .measuring(TIME),
            P::value("SHIFTX", "added to the times").measuring(TIME),
            P::value("SHIFTY", "added to the values"),
            P::value("SCALEX", "factor of the times"),
            P::value("SCALEY", "factor of the values"),
            P::value("SMOOTH", "corners are not smoothed").warned(),
        ],
        "A function of time: time, value, time, value, ..., or as DEFINITION says. CalculiX reads \
         tables only: it takes the data of every other DEFINITION for a table, with a warning, and the \
         loads are wrong there.",
        "*AMPLITUDE, NAME=PUSH, DEFINITION=SMOOTH STEP\n\
         0., 0., 1.E-5, 1., 5.E-5, 0.",
    ),
    Keyword::read(
        "EQUATION",
        Scope::Model,
        Data::Required(&[row(&[
            plain("node or node set"),
            plain("direction"),
            plain("coefficient"),
        ])
        .repeating(3)]),
        &[INPUT],
        "Linear equations between displacements, a1 u1 + a2 u2 + ... = 0 at all times: the number of \
         terms on a line, then node or node set, direction, coefficient of each, four terms on a line; \
         any number of equations. Sets give an equation for every node, in the order of the numbers; \
         those after the first have as many nodes, or one. The first term is eliminated: no *BOUNDARY \
         may prescribe it and no other equation eliminate it; the others may be prescribed, or \
         eliminated by other equations. A node without element moves as its equations say. RF of a \
         prescribed term holds the force that its support exerts through the equations; at all other \
         terms RF is 0. The first terms start with the velocities that follow from those of the others. \
         The ratio of two coefficients lies between 1e-50 and 1e50.",
        "*EQUATION\n\
         2\n\
         13, 2, 1., 14, 2, -1.",
    ),
    Keyword::read(
        "INITIAL CONDITIONS",
        Scope::Model,
        Data::Required(&[row(&[
            plain("node or node set"),
            plain("direction"),
            of("velocity", VELOCITY),
        ])
        .under("TYPE", "VELOCITY")]),
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
        "*INITIAL CONDITIONS, TYPE=VELOCITY\n\
         NBLOCK, 2, -1000.",
    ),
    Keyword::read(
        "BOUNDARY",
        Scope::Anywhere,
        Data::Rows(&[
            row(&[
                plain("node or node set"),
                plain("first direction"),
                plain("last direction"),
                of("velocity", VELOCITY),
            ])
            .under("TYPE", "VELOCITY"),
            row(&[
                plain("node or node set"),
                plain("first direction"),
                plain("last direction"),
                of("acceleration", ACCELERATION),
            ])
            .under("TYPE", "ACCELERATION"),
            row(&[
                plain("node or node set"),
                plain("first direction"),
                plain("last direction"),
                of("displacement", LENGTH),
            ]),
        ]),
        &[
            OP,
            AMPLITUDE,
            P::choice(
                "TYPE",
                &[
                    V::read("DISPLACEMENT", "(default)"),
                    V::read("VELOCITY", "it goes on in later steps"),
                    V::read("ACCELERATION", "it goes on in later steps"),
                ],
                "what is prescribed",
            ),
            P::flag("FIXED", "the displacement of the start of the step is kept"),
            TIME_DELAY,
            P::value("REGION TYPE", "not supported").refused(),
            P::flag("USER", "not supported").refused(),
        ],
        "Prescribed displacements, velocities or accelerations: node or node set, first direction, \
         last direction, value; or a node set with XSYMM, YSYMM, ZSYMM, XASYMM, YASYMM, ZASYMM, PINNED or ENCASTRE. \
         Without amplitude a displacement grows linearly over the step. Directions 3 to 6 may be \
         given with value zero.",
        "*BOUNDARY\n\
         NFIX, 1, 2",
    ),
    Keyword::read(
        "CLOAD",
        Scope::Step,
        Data::Rows(&[row(&[
            plain("node or node set"),
            plain("direction"),
            of("force", FORCE),
        ])]),
        &[
            OP,
            AMPLITUDE,
            TIME_DELAY,
            P::flag("FOLLOWER", "forces keep their direction").refused(),
        ],
        "Forces: node or node set, direction, force on each node. Rows of one step add up; a \
         later step replaces.",
        "*CLOAD\n\
         13, 1, -50.\n\
         14, 2, 20.",
    ),
    Keyword::read(
        "DLOAD",
        Scope::Step,
        Data::Rows(&[
            row(&[
                plain("elements"),
                plain("GRAV"),
                of("acceleration", ACCELERATION),
                plain("dx"),
                plain("dy"),
                plain("dz"),
            ])
            .saying(1, &["GRAV"]),
            row(&[
                plain("elements"),
                plain("BX or BY"),
                of("force per volume", FORCE_PER_VOLUME),
            ])
            .saying(1, &["BX", "BY"]),
            row(&[plain("elements"), plain("P1 to P4"), of("pressure", STRESS)])
                .saying(1, &["P1", "P2", "P3", "P4"]),
            row(&[
                plain("elements"),
                plain("TRVEC1 to TRVEC4"),
                of("traction", STRESS),
                plain("dx"),
                plain("dy"),
                plain("dz"),
            ])
            .saying(1, &["TRVEC1", "TRVEC2", "TRVEC3", "TRVEC4"]),
        ]),
        &[OP, AMPLITUDE, TIME_DELAY, FOLLOWER],
        "Loads on elements (empty first field: on all): GRAV, acceleration, dx, dy; BX or BY, \
         force per reference volume; P1 to P4, pressure into the body that follows the face; TRVEC1 \
         to TRVEC4, traction on the face, dx, dy, which keeps its direction (with FOLLOWER=NO).",
        "*DLOAD\n\
         EBLOCK, GRAV, 9810., 0., -1., 0.\n\
         3, P3, 2.5",
    ),
    Keyword::read(
        "DSLOAD",
        Scope::Step,
        Data::Rows(&[
            row(&[plain("surface"), plain("P"), of("pressure", STRESS)]).saying(1, &["P"]),
            row(&[
                plain("surface"),
                plain("TRVEC"),
                of("traction", STRESS),
                plain("dx"),
                plain("dy"),
                plain("dz"),
            ])
            .saying(1, &["TRVEC"]),
        ]),
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
        "*DSLOAD\n\
         STOP, P, 2.5",
    ),
    Keyword::warned("USER SUBROUTINES", "There are no user subroutines."),
    Keyword::refused("MPC", CONSTRAINT).example(LINEAR),
    Keyword::refused("COUPLING", CONSTRAINT).example(LINEAR),
    Keyword::refused("KINEMATIC", CONSTRAINT).example(LINEAR),
    Keyword::refused("KINEMATIC COUPLING", CONSTRAINT).example(LINEAR),
    Keyword::refused("DISTRIBUTING", CONSTRAINT).example(LINEAR),
    Keyword::refused("DISTRIBUTING COUPLING", CONSTRAINT).example(LINEAR),
    Keyword::refused("EMBEDDED ELEMENT", CONSTRAINT).example(LINEAR),
    Keyword::refused("PRE-TENSION SECTION", CONSTRAINT).example(LINEAR),
    Keyword::refused("NETWORK MPC", CONSTRAINT).example(LINEAR),
    Keyword::refused("FASTENER", CONSTRAINT).example(LINEAR),
    Keyword::refused("SPRING", DISCRETE),
    Keyword::refused("DASHPOT", DISCRETE),
    Keyword::refused("MASS", DISCRETE),
    Keyword::refused("ROTARY INERTIA", DISCRETE),
    Keyword::refused("JOINT", DISCRETE),
    Keyword::refused("CONNECTOR SECTION", DISCRETE),
    Keyword::refused("CONNECTOR BEHAVIOR", DISCRETE),
    Keyword::refused("CONNECTOR ELASTICITY", DISCRETE),
    Keyword::refused("CONNECTOR DAMPING", DISCRETE),
    Keyword::refused("CONNECTOR FRICTION", DISCRETE),
    Keyword::refused("CONNECTOR STOP", DISCRETE),
    Keyword::refused("CONNECTOR LOCK", DISCRETE),
    Keyword::refused("CONNECTOR FAILURE", DISCRETE),
    Keyword::refused("CONNECTOR PLASTICITY", DISCRETE),
    Keyword::refused("CONNECTOR CONSTITUTIVE REFERENCE", DISCRETE),
    Keyword::refused("CONNECTOR MOTION", DISCRETE),
    Keyword::refused("CONNECTOR LOAD", DISCRETE),
    Keyword::refused("TEMPERATURE", THERMAL),
    Keyword::refused("FIELD", FIELD_LOAD).example(FORCES),
    Keyword::refused("CFLUX", FIELD_LOAD).example(FORCES),
    Keyword::refused("DFLUX", FIELD_LOAD).example(FORCES),
    Keyword::refused("DSFLUX", FIELD_LOAD).example(FORCES),
    Keyword::refused("FILM", FIELD_LOAD).example(FORCES),
    Keyword::refused("SFILM", FIELD_LOAD).example(FORCES),
    Keyword::refused("RADIATE", FIELD_LOAD).example(FORCES),
    Keyword::refused("SRADIATE", FIELD_LOAD).example(FORCES),
    Keyword::refused("MASS FLOW", FIELD_LOAD).example(FORCES),
    Keyword::refused("PRESSURE STRESS", FIELD_LOAD).example(FORCES),
    Keyword::refused("INCIDENT WAVE", FIELD_LOAD).example(FORCES),
    Keyword::refused("FLUID CAVITY", FIELD_LOAD).example(FORCES),
    Keyword::refused("BASE MOTION", "Prescribe displacements with *BOUNDARY.").example(SUPPORT),
    Keyword::refused("INERTIA RELIEF", "Bodies move with their inertia."),
    Keyword::refused("INITIAL STRAIN INCREASE", "Bodies start as meshed."),
    Keyword::refused("MAP SOLUTION", "A run starts from its own deck."),
    Keyword::refused("IMPORT", "A run starts from its own deck."),
];
