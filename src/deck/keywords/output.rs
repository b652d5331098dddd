//! The rows of the keyword table for output requests.

use super::common::{HARMLESS, NAME};
use super::types::{Data, Keyword, Parameter as P, Scope, Unread, Value as V, row};

const YES_NO: &[V] = &[V::read("YES", ""), V::read("NO", "")];
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
const POSITION: P = P::value("POSITION", "stresses are means over elements").ignored();
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
const HISTORY_TIMES: P = P::value("TIME POINTS", "histories hold every increment");
const SLAVE: P = P::value("SLAVE", "all contacts are written").ignored();
const MASTER: P = P::value("MASTER", "all contacts are written").ignored();
const HISTORY_EVERY: P = P::value(
    "FREQUENCY",
    "0: no history; else without effect, histories hold every increment",
);
const CONTACT_EVERY: P = P::value("FREQUENCY", "histories hold every increment");
const TOTALS: P = P::choice(
    "TOTALS",
    &[
        V::read("NO", "the values of every node or element too (default)"),
        V::read("YES", "the same"),
        V::read(
            "ONLY",
            "sums (and means over nodes) only, unless another card asks for all",
        ),
    ],
    "sums over the set are always in the history",
);
const CONTACT_TOTALS: P = P::value("TOTALS", "sums are always written").ignored();
const ALWAYS_WHOLE: &str = "always written for the whole model";
const UNWRITTEN: &str = "The result file holds everything this program writes.";

pub(super) static OUTPUT: &[Keyword] = &[
    Keyword::read(
        "OUTPUT",
        Scope::Step,
        Data::Rows(&[row("variable").repeating(1)]),
        &[
            P::flag("FIELD", "the cards below ask for fields in frames"),
            P::flag("HISTORY", "the cards below ask for histories"),
            P::optional("DIAGNOSTICS", "diagnostics are always written").ignored(),
            FREQUENCY,
            P::value("NUMBER INTERVAL", "this many frames, evenly spaced"),
            P::value("TIME INTERVAL", "frames at multiples of this time").measuring("time"),
            TIME_POINTS,
            P::value("TIME MARKS", "increments are not cut for output").ignored(),
            P::value("OP", "one request of frames holds").ignored(),
            ALL_VARIABLES,
            P::value("NAME", "requests have no names").ignored(),
        ],
        "Begins output requests; the last request of frames holds, for later steps too. Histories hold \
         every increment, whatever the times asked for.",
        "*OUTPUT, FIELD, TIME INTERVAL=1.E-6\n\
         *NODE OUTPUT\n\
         U, V",
    ),
    Keyword::read(
        "NODE OUTPUT",
        Scope::Step,
        Data::Rows(&[row("variable").repeating(1)]),
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
        "*OUTPUT, HISTORY\n\
         *NODE OUTPUT, NSET=NBLOCK\n\
         U, RF",
    ),
    Keyword::read(
        "NODE FILE",
        Scope::Step,
        Data::Rows(&[row("variable").repeating(1)]),
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
        "Fields on nodes in frames, on the whole mesh: CF where it is named, all others always.",
        "*NODE FILE, FREQUENCY=10\n\
         U, V, RF",
    ),
    Keyword::read(
        "ELEMENT OUTPUT",
        Scope::Step,
        Data::Rows(&[row("variable").repeating(1)]),
        &[
            FREQUENCY,
            TIME_POINTS,
            P::value(
                "ELSET",
                "under *OUTPUT, HISTORY: element set of the history; else without effect, fields are \
                 written on the whole mesh",
            ),
            POSITION,
            OUTPUT_2D,
            GLOBAL,
            ALL_VARIABLES,
            DIRECTIONS,
            CONTACT_ELEMENTS,
            LAST_ITERATIONS,
        ],
        "Under *OUTPUT, HISTORY the history of an element set; else the same as *EL FILE. Both hold means over \
         elements.",
        "*OUTPUT, HISTORY\n\
         *ELEMENT OUTPUT, ELSET=EBLOCK\n\
         S, ENER",
    ),
    Keyword::read(
        "EL FILE",
        Scope::Step,
        Data::Rows(&[row("variable").repeating(1)]),
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
        "Fields on elements in frames, on the whole mesh: ENER and LE where they are named, all others always.",
        "*EL FILE, FREQUENCY=10\n\
         S",
    ),
    Keyword::read(
        "CONTACT OUTPUT",
        Scope::Step,
        Data::Rows(&[row("variable").repeating(1)]),
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
        "*OUTPUT, FIELD, FREQUENCY=10\n\
         *CONTACT OUTPUT\n\
         CSTRESS, CDISP",
    ),
    Keyword::read(
        "CONTACT FILE",
        Scope::Step,
        Data::Rows(&[row("variable").repeating(1)]),
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
        "*CONTACT FILE, FREQUENCY=10\n\
         CDIS, CSTR",
    ),
    Keyword::read(
        "NODE PRINT",
        Scope::Step,
        Data::Rows(&[row("variable").repeating(1)]),
        &[
            P::value("NSET", "node set of the history"),
            HISTORY_EVERY,
            HISTORY_TIMES,
            TOTALS,
            GLOBAL,
            SUMMARY,
        ],
        "The history of a node set: sums of forces, mean motion, and every node.",
        "*NODE PRINT, NSET=NFIX, TOTALS=ONLY\n\
         RF",
    ),
    Keyword::read(
        "EL PRINT",
        Scope::Step,
        Data::Rows(&[row("variable").repeating(1)]),
        &[
            P::value("ELSET", "element set of the history"),
            HISTORY_EVERY,
            HISTORY_TIMES,
            TOTALS,
            GLOBAL,
            POSITION,
            SUMMARY,
        ],
        "The history of an element set: sums of energies, and every element with its mean stresses and \
         strains, energies and volume. Energies of the model and of every body are always in the history.",
        "*EL PRINT, ELSET=EBLOCK, TOTALS=ONLY\n\
         ELSE, ELKE",
    ),
    Keyword::read(
        "CONTACT PRINT",
        Scope::Step,
        Data::Rows(&[row("variable").repeating(1)]),
        &[
            SLAVE,
            MASTER,
            CONTACT_EVERY,
            HISTORY_TIMES,
            CONTACT_TOTALS,
            SUMMARY,
        ],
        "Contact forces of each contact are always in the history.",
        "*CONTACT PRINT, SLAVE=SBOT, MASTER=STOP\n\
         CF",
    ),
    Keyword::read(
        "ENERGY OUTPUT",
        Scope::Step,
        Data::Rows(&[row("variable").repeating(1)]),
        &[P::value("ELSET", ALWAYS_WHOLE).ignored(), ALL_VARIABLES],
        "Energies are always in the history.",
        "*OUTPUT, HISTORY\n\
         *ENERGY OUTPUT\n\
         ALLKE, ALLSE, ETOTAL",
    ),
    Keyword::read(
        "TIME POINTS",
        Scope::Anywhere,
        Data::Required(&[
            row("first [time], last [time], increment [time]").under("GENERATE", ""),
            row("time [time]").repeating(1),
        ]),
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
        "*TIME POINTS, NAME=SHOTS, GENERATE\n\
         0., 1.E-4, 1.E-5",
    ),
    Keyword::read(
        "MONITOR",
        Scope::Step,
        Data::None,
        &[
            P::value("NODE", "node, or node set of one node; required"),
            P::value("DOF", "direction, 1 or 2; required"),
            P::value("FREQUENCY", "the status file holds every increment").ignored(),
        ],
        "The displacement of a node as a column of the status file, JOB.sta, in all steps; several \
         cards give several columns.",
        "*MONITOR, NODE=13, DOF=2",
    ),
];

/// Keywords that are not read.
pub(super) static UNREAD_OUTPUT: &[Unread] = &[
    Unread::ignored("FILE FORMAT, PRINT", HARMLESS).of_words(),
    Unread::warned(
        "FILTER, SECTION PRINT, SECTION FILE, INTEGRATED OUTPUT, \
         INTEGRATED OUTPUT SECTION, INCREMENTATION OUTPUT, MODAL OUTPUT, MODAL PRINT, \
         MODAL FILE, RADIATION OUTPUT, SURFACE OUTPUT, SUBSTRUCTURE MATRIX OUTPUT, \
         ENERGY PRINT, ENERGY FILE, ELEMENT MATRIX OUTPUT, TRACER PARTICLE, VIEWFACTOR",
        UNWRITTEN,
    ),
];
