//! The rows of the keyword table for steps and their settings.

use super::common::{OTHER_NUMBERS, OTHER_SOLVER};
use super::types::{Data, Keyword, Parameter as P, Scope, Unread, Value as V, row};

const TRUNCATION: &str = "no effect (warning): increments follow their truncation error";
const UNSCALED: &str = "Masses are not scaled: remove it, implicit increments do not need it.";
const INTEGRATOR: &str = "the time integration is that of *STICKSLIP, SCHEME=";
const PROCEDURE: &str = "Steps are static or dynamic: use *STATIC or *DYNAMIC.";
const NO_STABILIZE: &str = "there is no artificial damping: bodies held by contact alone need none";
const DYNAMIC: &str = "*DYNAMIC, DIRECT\n\
         1.E-7, 1.E-4";

pub(super) static STEPS: &[Keyword] = &[
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
                    V::read("STEP", "at once (default of dynamic steps)"),
                    V::read("RAMP", "linearly over the step (default of static steps)"),
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
        "*STEP, NLGEOM, INC=100000\n\
         *DYNAMIC, DIRECT\n\
         1.E-7, 1.E-4\n\
         *END STEP",
    ),
    Keyword::read(
        "END STEP",
        Scope::Step,
        Data::None,
        &[],
        "Ends a step.",
        "*STEP, NLGEOM\n\
         *DYNAMIC, DIRECT\n\
         1.E-7, 1.E-4\n\
         *END STEP",
    ),
    Keyword::read(
        "STATIC",
        Scope::Step,
        Data::Rows(&[row(
            "first increment [time], duration [time], smallest increment [time], \
                    largest increment [time]",
        )]),
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
            P::flag(
                "RIKS",
                "where a load has its largest value, go on with *DYNAMIC",
            )
            .refused(),
            P::optional("STABILIZE", NO_STABILIZE).warned(),
            P::value("FACTOR", NO_STABILIZE).warned(),
            P::value("ALLSDTOL", NO_STABILIZE).warned(),
            P::value("CONTINUE", NO_STABILIZE).warned(),
            P::flag("ADIABATIC", "there are no temperatures").refused(),
            P::value("SOLVER", "use *STICKSLIP, SOLVER=").warned(),
            P::flag("TIME RESET", "times go on from step to step").refused(),
            P::value("TOTAL TIME AT START", "times go on from step to step").refused(),
            P::flag("LONG TERM", "there is no creep").refused(),
            P::flag("FULLY PLASTIC", "there is no plasticity").refused(),
        ],
        "A static step finds equilibrium without inertia, damping and impacts. Contact and friction are exact at \
         the end of every increment. The row holds the first increment (the duration by default), the duration (1 \
         by default), the smallest increment (1e-5 of the duration by default) and the largest one. Increments \
         that fail are cut to a \
         quarter; after two increments of at most five passes they grow by half. With DIRECT they keep their size, \
         and those that fail are halved. Loads without amplitude grow linearly over the step.",
        "*STEP, NLGEOM\n\
         *STATIC\n\
         0.1, 1.\n\
         *END STEP",
    ),
    Keyword::read(
        "DYNAMIC",
        Scope::Step,
        Data::Rows(&[row(
            "first increment [time], duration [time], smallest increment [time], \
                    largest increment [time]",
        )]),
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
                    V::read(
                        "QUASI-STATIC",
                        "backward Euler rule, which takes the energy of vibrations; loads grow linearly over the step, and \
                         increments follow their passes as in a static step",
                    ),
                ],
                "kind of problem",
            ),
            P::optional("EXPLICIT", "the time integration is implicit").warned(),
            P::value("ALPHA", INTEGRATOR).warned(),
            P::value("BETA", INTEGRATOR).warned(),
            P::value("GAMMA", INTEGRATOR).warned(),
            P::value("TIME INTEGRATOR", INTEGRATOR).warned(),
            P::value("HAFTOL", TRUNCATION).measuring("force"),
            P::value(
                "HALFINC SCALE FACTOR",
                "scales the tolerance of the truncation error (warning): 10000 with contacts, 1000 without, and with \
                 TRANSIENT FIDELITY, stand for 1e-4",
            ),
            P::flag("NOHAF", TRUNCATION),
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
        "A dynamic step: first increment, duration, smallest increment (by default a thousandth of the first, or 1e-5 \
         of the duration if that is less), largest increment (by default a tenth of the duration). Their length \
         follows from their truncation error, which stays below 1e-4 of the largest displacement of the step so far: \
         at most two repetitions in a row, growth by at most half after two increments. Increments that fail are halved. With \
         DIRECT increments keep their size, and the largest increment has no effect (warning).",
        "*STEP, NLGEOM\n\
         *DYNAMIC\n\
         1.E-7, 1.E-4, , 1.E-6\n\
         *END STEP",
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
                    V::read(
                        "CONSISTENT",
                        "every node has its part of the mass of its elements (default)",
                    ),
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
                    V::read("FAER", "multifrontal LDL^T (default)"),
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
        "*STICKSLIP, IMPACT TIME=EVENT, LANDING=RETURN, TOLERANCE=1.E-10",
    ),
    Keyword::read(
        "NO ANALYSIS",
        Scope::Anywhere,
        Data::None,
        &[],
        "The deck is read and checked only, as by the command check: no step of it is solved.",
        "*NO ANALYSIS",
    ),
    Keyword::read(
        "RESTART",
        Scope::Anywhere,
        Data::None,
        &[
            P::flag("WRITE", "write checkpoints, in JOB.restart"),
            P::flag(
                "READ",
                "a run goes on with `run --resume` and `--extend`: give all steps in one deck",
            )
            .refused(),
            P::value(
                "FREQUENCY",
                "increments of a step from one checkpoint to the next (default 1); the last increment has one too; 0: none",
            ),
            P::value(
                "NUMBER INTERVAL",
                "checkpoints are counted by increments (FREQUENCY), else at the end of each step",
            )
            .warned(),
            P::value("STEP", "belongs to READ").ignored(),
            P::value("INC", "belongs to READ").ignored(),
            P::flag("OVERLAY", "keep the last checkpoint of a step only"),
        ],
        "Checkpoints, from which `run --resume` goes on (docs/restart.md). In a step it holds for later steps too.",
        "*RESTART, WRITE, FREQUENCY=100, OVERLAY",
    ),
];

/// Keywords that are not read.
pub(super) static UNREAD_STEPS: &[Unread] = &[
    Unread::warned(
        "CONTROLS, SOLVER CONTROLS, DIAGNOSTICS, BULK VISCOSITY",
        OTHER_NUMBERS,
    ),
    Unread::refused("VARIABLE MASS SCALING, FIXED MASS SCALING", UNSCALED),
    Unread::warned(
        "ADAPTIVE MESH, ADAPTIVE MESH CONTROLS",
        "The mesh stays as it is.",
    ),
    Unread::refused(
        "VISCO, FREQUENCY, COMPLEX FREQUENCY, MODAL DYNAMIC, BUCKLE, \
         STEADY STATE DYNAMICS, RESPONSE SPECTRUM, RANDOM RESPONSE, DIRECT CYCLIC, \
         HEAT TRANSFER, COUPLED TEMPERATURE-DISPLACEMENT, DYNAMIC TEMPERATURE-DISPLACEMENT, \
         UNCOUPLED TEMPERATURE-DISPLACEMENT, COUPLED THERMAL-ELECTRICAL, ELECTROMAGNETICS, \
         PIEZOELECTRIC, MASS DIFFUSION, ACOUSTIC, CFD, SUBSTRUCTURE GENERATE, GREEN, \
         SENSITIVITY, FEASIBLE DIRECTION, ROBUST DESIGN, HCF, CRACK PROPAGATION, ANNEAL, \
         GEOSTATIC, SOILS",
        PROCEDURE,
    )
    .example(DYNAMIC),
    Unread::refused(
        "DESIGN VARIABLES, DESIGN RESPONSE, OBJECTIVE, CONSTRAINT",
        "There is no optimisation.",
    ),
    Unread::refused(
        "CHANGE MATERIAL, CHANGE PLASTIC, CHANGE SOLID SECTION",
        "Materials and sections hold for all steps.",
    ),
    Unread::refused(
        "SELECT CYCLIC SYMMETRY MODES, RETAINED NODAL DOFS",
        PROCEDURE,
    )
    .example(DYNAMIC),
];
