//! The rows of the keyword table for amplitudes, constraints, initial conditions, supports and loads.

use super::common::{INPUT, NAME};
use super::types::{Data, Keyword, Parameter as P, Scope, Unread, Value as V, row};

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
            row("value")
                .repeating(1)
                .under("DEFINITION", "EQUALLY SPACED"),
            row("N, w [1/time], t0 [time], A0")
                .first()
                .under("DEFINITION", "PERIODIC"),
            row("A, B").repeating(2).under("DEFINITION", "PERIODIC"),
            row("A0, A, t0 [time], td [time]").under("DEFINITION", "DECAY"),
            row("A0, A, t0 [time], w1 [1/time], w2 [1/time]").under("DEFINITION", "MODULATED"),
            row("time [time], value").repeating(2),
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
            P::value("FIXED INTERVAL", "time between equally spaced values").measuring("time"),
            P::value(
                "BEGIN",
                "time of the first equally spaced value (default 0)",
            )
            .measuring("time"),
            P::value("SHIFTX", "added to the times").measuring("time"),
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
        Data::Required(&[row("node or node set, direction, coefficient").repeating(3)]),
        &[INPUT],
        "Linear equations between displacements: a1 u1 + a2 u2 + ... = 0 at all times. An \
         equation begins with the number of its terms on a line. Then follow node or node set, \
         direction and coefficient of each term, four terms on a line. A card may hold any number \
         of equations. Sets give an equation for every node, in the order of the numbers; a later \
         set of the equation has as many nodes as the first one, or one node. The first term is \
         eliminated: no *BOUNDARY may prescribe it, and no other equation may eliminate it. The \
         other terms may be prescribed, or eliminated by other equations. A node without element \
         moves as its equations say. RF of a prescribed term holds the force that its support \
         exerts through the equations; RF is 0 at all other terms. At the start the velocity of a \
         first term follows from the velocities of the others. The ratio of two coefficients lies \
         between 1e-50 and 1e50.",
        "*EQUATION\n\
         2\n\
         13, 2, 1., 14, 2, -1.",
    ),
    Keyword::read(
        "INITIAL CONDITIONS",
        Scope::Model,
        Data::Required(&[
            row("node or node set, direction, velocity [length/time]").under("TYPE", "VELOCITY")
        ]),
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
            row("node or node set, first direction, last direction, \
                    velocity [length/time]")
            .under("TYPE", "VELOCITY"),
            row("node or node set, first direction, last direction, \
                    acceleration [length/time^2]")
            .under("TYPE", "ACCELERATION"),
            row("node or node set, first direction, last direction, displacement [length]"),
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
        "Prescribed displacements, velocities or accelerations: node or node set, first \
         direction, last direction, value. A node set may also have XSYMM, YSYMM, ZSYMM, XASYMM, \
         YASYMM, ZASYMM, PINNED or ENCASTRE in place of directions and value. Without amplitude a \
         displacement grows linearly over the step. Directions 3 to 6 may be given with value \
         zero.",
        "*BOUNDARY\n\
         NFIX, 1, 2",
    ),
    Keyword::read(
        "CLOAD",
        Scope::Step,
        Data::Rows(&[row("node or node set, direction, force [force]")]),
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
            row("elements, GRAV, acceleration [length/time^2], dx, dy, dz").saying(1, &["GRAV"]),
            row("elements, BX or BY, force per volume [force/length^3]").saying(1, &["BX", "BY"]),
            row("elements, P1 to P4, pressure [force/length^2]")
                .saying(1, &["P1", "P2", "P3", "P4"]),
            row("elements, TRVEC1 to TRVEC4, traction [force/length^2], dx, dy, dz")
                .saying(1, &["TRVEC1", "TRVEC2", "TRVEC3", "TRVEC4"]),
        ]),
        &[OP, AMPLITUDE, TIME_DELAY, FOLLOWER],
        "Loads on elements; an empty first field stands for all elements. GRAV has the \
         acceleration and its direction dx, dy. BX and BY are forces per reference volume. P1 to \
         P4 are pressures into the body, which follow the face. TRVEC1 to TRVEC4 are tractions on \
         the face in the direction dx, dy, which stays as it is (with FOLLOWER=NO).",
        "*DLOAD\n\
         EBLOCK, GRAV, 9810., 0., -1., 0.\n\
         3, P3, 2.5",
    ),
    Keyword::read(
        "DSLOAD",
        Scope::Step,
        Data::Rows(&[
            row("surface, P, pressure [force/length^2]").saying(1, &["P"]),
            row("surface, TRVEC, traction [force/length^2], dx, dy, dz").saying(1, &["TRVEC"]),
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
        "Loads on surfaces. P is a pressure into the body, which follows the face. TRVEC is a \
         traction per reference area in the direction dx, dy, which stays as it is (with \
         FOLLOWER=NO).",
        "*DSLOAD\n\
         STOP, P, 2.5",
    ),
];

/// Keywords that are not read.
pub(super) static UNREAD_CONDITIONS: &[Unread] = &[
    Unread::warned("USER SUBROUTINES", "There are no user subroutines."),
    Unread::refused(
        "MPC, COUPLING, KINEMATIC, KINEMATIC COUPLING, DISTRIBUTING, \
         DISTRIBUTING COUPLING, EMBEDDED ELEMENT, PRE-TENSION SECTION, NETWORK MPC, FASTENER",
        CONSTRAINT,
    )
    .example(LINEAR),
    Unread::refused(
        "SPRING, DASHPOT, MASS, ROTARY INERTIA, JOINT, CONNECTOR SECTION, \
         CONNECTOR BEHAVIOR, CONNECTOR ELASTICITY, CONNECTOR DAMPING, CONNECTOR FRICTION, \
         CONNECTOR STOP, CONNECTOR LOCK, CONNECTOR FAILURE, CONNECTOR PLASTICITY, \
         CONNECTOR CONSTITUTIVE REFERENCE, CONNECTOR MOTION, CONNECTOR LOAD",
        DISCRETE,
    ),
    Unread::refused("TEMPERATURE", THERMAL),
    Unread::refused(
        "FIELD, CFLUX, DFLUX, DSFLUX, FILM, SFILM, RADIATE, SRADIATE, \
         MASS FLOW, PRESSURE STRESS, INCIDENT WAVE, FLUID CAVITY",
        FIELD_LOAD,
    )
    .example(FORCES),
    Unread::refused("BASE MOTION", "Prescribe displacements with *BOUNDARY.").example(SUPPORT),
    Unread::refused("INERTIA RELIEF", "Bodies move with their inertia."),
    Unread::refused("INITIAL STRAIN INCREASE", "Bodies start as meshed."),
    Unread::refused("MAP SOLUTION, IMPORT", "A run starts from its own deck."),
];
