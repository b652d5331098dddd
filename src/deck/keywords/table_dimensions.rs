//! The table of dimensions: what the numbers of each keyword measure.
//!
//! An amplitude multiplies the magnitude of the card that names it, so that its values are pure
//! numbers.

use super::dimensions::{Dimensions, Quantity, RowForm};
use Quantity::{OfOr, OrName, Plain, Unknown};

const LENGTH: Quantity = Quantity::Of("length");
const TIME: Quantity = Quantity::Of("time");
const FREQUENCY: Quantity = Quantity::Of("1/time");
const VELOCITY: Quantity = Quantity::Of("length/time");
const ACCELERATION: Quantity = Quantity::Of("length/time^2");
const DENSITY: Quantity = Quantity::Of("mass/length^3");
const FORCE: Quantity = Quantity::Of("force");
const STRESS: Quantity = Quantity::Of("force/length^2");
const COMPRESSIBILITY: Quantity = Quantity::Of("length^2/force");
const BODY_FORCE: Quantity = Quantity::Of("force/length^3");

type Row = &'static [Quantity];

/// A keyword with its kinds of data lines, and its parameters that take names and pure numbers, or
/// numbers with a dimension.
const fn keyword(
    keyword: &'static str,
    rows: &'static [RowForm],
    plain: &'static [&'static str],
    measured: &'static [(&'static str, Quantity)],
) -> Dimensions {
    Dimensions {
        keyword,
        rows,
        plain,
        measured,
        anything: false,
    }
}

/// A keyword of other programs without effect on the results.
const fn harmless(keyword: &'static str) -> Dimensions {
    Dimensions {
        keyword,
        rows: &[],
        plain: &[],
        measured: &[],
        anything: true,
    }
}

/// Data lines with these fields.
const fn row(fields: Row) -> RowForm {
    RowForm {
        parameter: None,
        word: None,
        fields,
        repeats: false,
    }
}

/// Data lines that repeat these fields.
const fn repeated(fields: Row) -> RowForm {
    RowForm {
        repeats: true,
        ..row(fields)
    }
}

/// Data lines whose second field is one of these words.
const fn load(words: &'static [&'static str], fields: Row) -> RowForm {
    RowForm {
        word: Some((1, words)),
        ..row(fields)
    }
}

/// Data lines of a rigid profile that begin with one of these words.
const fn profile(words: &'static [&'static str], fields: Row) -> RowForm {
    RowForm {
        parameter: Some(("TYPE", "SEGMENTS")),
        word: Some((0, words)),
        ..row(fields)
    }
}

/// Data lines under this value of a parameter.
const fn under(parameter: &'static str, value: &'static str, fields: Row) -> RowForm {
    RowForm {
        parameter: Some((parameter, value)),
        ..row(fields)
    }
}

/// Any number of names or labels.
const NAMES: &[RowForm] = &[repeated(&[Plain])];

/// Dimensions by keyword.
pub(crate) static DIMENSIONS: &[Dimensions] = &[
    keyword("HEADING", &[], &[], &[]),
    keyword("INCLUDE", &[], &["INPUT"], &[]),
    keyword("PART", &[], &["NAME"], &[]),
    keyword("END PART", &[], &[], &[]),
    keyword("ASSEMBLY", &[], &["NAME"], &[]),
    keyword("END ASSEMBLY", &[], &[], &[]),
    keyword(
        "INSTANCE",
        &[row(&[
            LENGTH, LENGTH, LENGTH, LENGTH, LENGTH, LENGTH, Plain,
        ])],
        &["NAME", "PART"],
        &[],
    ),
    keyword("END INSTANCE", &[], &[], &[]),
    keyword(
        "NODE",
        &[row(&[Plain, LENGTH, LENGTH, LENGTH])],
        &["NSET", "INPUT"],
        &[],
    ),
    keyword("ELEMENT", NAMES, &["TYPE", "ELSET", "INPUT"], &[]),
    keyword("NSET", NAMES, &["NSET", "ELSET", "INPUT", "INSTANCE"], &[]),
    keyword("ELSET", NAMES, &["ELSET", "INPUT", "INSTANCE"], &[]),
    keyword(
        "SURFACE",
        &[
            profile(&["START", "LINE"], &[Plain, LENGTH, LENGTH]),
            profile(&["CIRCL"], &[Plain, LENGTH, LENGTH, LENGTH, LENGTH]),
            under("TYPE", "NODE", &[Plain, Quantity::Of("length^2")]),
            row(&[Plain, Plain]),
        ],
        &["NAME", "TRIM", "MAX RATIO"],
        &[],
    ),
    keyword(
        "RIGID BODY",
        &[],
        &["ANALYTICAL SURFACE", "REF NODE", "POSITION", "ISOTHERMAL"],
        &[],
    ),
    keyword(
        "MATERIAL",
        &[],
        &["NAME", "RTOL", "SRATE FACTOR"],
        &[("STRAIN RATE REGULARIZATION", Unknown)],
    ),
    keyword("ELASTIC", &[row(&[STRESS, Plain, Plain])], &[], &[]),
    keyword(
        "HYPERELASTIC",
        &[row(&[STRESS, COMPRESSIBILITY, Plain])],
        &["N", "POISSON"],
        &[],
    ),
    keyword("DENSITY", &[row(&[DENSITY, Plain])], &[], &[]),
    keyword(
        "DAMPING",
        &[],
        &[],
        &[("ALPHA", Quantity::Of("1/time")), ("BETA", TIME)],
    ),
    keyword(
        "SOLID SECTION",
        &[row(&[OfOr("length", "1")])],
        &["ELSET", "MATERIAL", "CONTROLS"],
        &[],
    ),
    keyword(
        "SURFACE INTERACTION",
        &[row(&[LENGTH])],
        &["NAME"],
        &[("TRACKING THICKNESS", LENGTH)],
    ),
    keyword(
        "SURFACE BEHAVIOR",
        &[
            under(
                "PRESSURE-OVERCLOSURE",
                "LINEAR",
                &[Quantity::Of("force/length^3"), STRESS, LENGTH],
            ),
            row(&[Unknown, Unknown, Unknown, Unknown]),
        ],
        &["PENALTY"],
        &[],
    ),
    keyword(
        "FRICTION",
        &[row(&[Plain, Unknown, Unknown, Unknown])],
        &["SLIP TOLERANCE"],
        &[("ELASTIC SLIP", LENGTH)],
    ),
    keyword(
        "CONTACT PAIR",
        &[row(&[Plain, Plain])],
        &[
            "INTERACTION",
            "EXTENSION ZONE",
            "SMOOTH",
            "TRACKING",
            "MINIMUM DISTANCE",
            "GEOMETRIC CORRECTION",
            "MECHANICAL CONSTRAINT",
            "CPSET",
            "WEIGHT",
        ],
        &[("ADJUST", OrName("length")), ("HCRIT", LENGTH)],
    ),
    keyword("CONTACT", &[], &[], &[]),
    keyword("CONTACT INCLUSIONS", &[row(&[Plain, Plain])], &[], &[]),
    keyword(
        "CONTACT PROPERTY ASSIGNMENT",
        &[row(&[Plain, Plain, Plain])],
        &[],
        &[],
    ),
    keyword(
        "AMPLITUDE",
        &[
            RowForm {
                repeats: true,
                ..under("DEFINITION", "EQUALLY SPACED", &[Plain])
            },
            // The first line differs from the others.
            under(
                "DEFINITION",
                "PERIODIC",
                &[Unknown, Unknown, Unknown, Unknown],
            ),
            under("DEFINITION", "DECAY", &[Plain, Plain, TIME, TIME]),
            under(
                "DEFINITION",
                "MODULATED",
                &[Plain, Plain, TIME, FREQUENCY, FREQUENCY],
            ),
            repeated(&[TIME, Plain]),
        ],
        &["NAME", "INPUT", "SHIFTY", "SCALEX", "SCALEY", "SMOOTH"],
        &[("SHIFTX", TIME), ("FIXED INTERVAL", TIME), ("BEGIN", TIME)],
    ),
    keyword("EQUATION", NAMES, &["INPUT"], &[]),
    keyword(
        "INITIAL CONDITIONS",
        &[under("TYPE", "VELOCITY", &[Plain, Plain, VELOCITY])],
        &["INPUT"],
        &[],
    ),
    keyword(
        "BOUNDARY",
        &[
            under("TYPE", "VELOCITY", &[Plain, Plain, Plain, VELOCITY]),
            row(&[Plain, Plain, Plain, LENGTH]),
        ],
        &["AMPLITUDE"],
        &[],
    ),
    keyword("CLOAD", &[row(&[Plain, Plain, FORCE])], &["AMPLITUDE"], &[]),
    keyword(
        "DLOAD",
        &[
            load(
                &["GRAV"],
                &[Plain, Plain, ACCELERATION, Plain, Plain, Plain],
            ),
            load(&["BX", "BY"], &[Plain, Plain, BODY_FORCE]),
            load(&["P1", "P2", "P3", "P4"], &[Plain, Plain, STRESS]),
            load(
                &["TRVEC1", "TRVEC2", "TRVEC3", "TRVEC4"],
                &[Plain, Plain, STRESS, Plain, Plain, Plain],
            ),
        ],
        &["AMPLITUDE"],
        &[],
    ),
    keyword(
        "DSLOAD",
        &[
            load(&["P"], &[Plain, Plain, STRESS]),
            load(&["TRVEC"], &[Plain, Plain, STRESS, Plain, Plain, Plain]),
        ],
        &["AMPLITUDE"],
        &[],
    ),
    keyword(
        "STEP",
        &[],
        &[
            "INC",
            "NAME",
            "UNSYMM",
            "EXTRAPOLATION",
            "CONVERT SDI",
            "SOLVER",
        ],
        &[],
    ),
    keyword("END STEP", &[], &[], &[]),
    keyword(
        "DYNAMIC",
        &[row(&[TIME, TIME, TIME, TIME])],
        &[
            "EXPLICIT",
            "ALPHA",
            "BETA",
            "GAMMA",
            "TIME INTEGRATOR",
            "HALFINC SCALE FACTOR",
            "INITIAL",
            "INCREMENTATION",
            "SINGULAR MASS",
            "SCALE FACTOR",
            "SOLVER",
        ],
        &[("HAFTOL", FORCE)],
    ),
    keyword(
        "STICKSLIP",
        &[],
        &["THETA1", "THETA2", "TOLERANCE", "MAX PASSES"],
        &[],
    ),
    keyword(
        "OUTPUT",
        NAMES,
        &[
            "DIAGNOSTICS",
            "FREQUENCY",
            "NUMBER INTERVAL",
            "TIME POINTS",
            "TIME MARKS",
            "OP",
            "VARIABLE",
            "NAME",
        ],
        &[("TIME INTERVAL", TIME)],
    ),
    keyword(
        "NODE OUTPUT",
        NAMES,
        &[
            "NSET",
            "FREQUENCY",
            "TIME POINTS",
            "OUTPUT",
            "GLOBAL",
            "FREQUENCYF",
            "VARIABLE",
        ],
        &[],
    ),
    keyword(
        "NODE FILE",
        NAMES,
        &[
            "FREQUENCY",
            "TIME POINTS",
            "NSET",
            "OUTPUT",
            "GLOBAL",
            "FREQUENCYF",
        ],
        &[],
    ),
    keyword(
        "ELEMENT OUTPUT",
        NAMES,
        &[
            "FREQUENCY",
            "TIME POINTS",
            "ELSET",
            "POSITION",
            "OUTPUT",
            "GLOBAL",
            "VARIABLE",
        ],
        &[],
    ),
    keyword(
        "EL FILE",
        NAMES,
        &[
            "FREQUENCY",
            "TIME POINTS",
            "ELSET",
            "NSET",
            "POSITION",
            "OUTPUT",
            "GLOBAL",
        ],
        &[],
    ),
    keyword(
        "CONTACT OUTPUT",
        NAMES,
        &[
            "FREQUENCY",
            "TIME POINTS",
            "SLAVE",
            "MASTER",
            "NSET",
            "VARIABLE",
        ],
        &[],
    ),
    keyword(
        "CONTACT FILE",
        NAMES,
        &["FREQUENCY", "TIME POINTS", "SLAVE", "MASTER", "NSET"],
        &[],
    ),
    keyword(
        "NODE PRINT",
        NAMES,
        &["NSET", "FREQUENCY", "TIME POINTS", "TOTALS", "GLOBAL"],
        &[],
    ),
    keyword(
        "EL PRINT",
        NAMES,
        &[
            "ELSET",
            "FREQUENCY",
            "TIME POINTS",
            "TOTALS",
            "GLOBAL",
            "POSITION",
        ],
        &[],
    ),
    keyword(
        "CONTACT PRINT",
        NAMES,
        &["SLAVE", "MASTER", "FREQUENCY", "TIME POINTS", "TOTALS"],
        &[],
    ),
    keyword("ENERGY OUTPUT", NAMES, &["ELSET", "VARIABLE"], &[]),
    keyword("TIME POINTS", &[repeated(&[TIME])], &["NAME"], &[]),
    keyword(
        "RESTART",
        &[],
        &["FREQUENCY", "NUMBER INTERVAL", "STEP", "INC"],
        &[],
    ),
    harmless("PREPRINT"),
    harmless("FILE FORMAT"),
    harmless("PRINT"),
    harmless("NO ANALYSIS"),
];
