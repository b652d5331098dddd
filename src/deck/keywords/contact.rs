//! The rows of the keyword table for contact.

use super::common::{NAME, OTHER_NUMBERS};
use super::types::{Data, Keyword, Parameter as P, Scope, Unread, Value as V, row};

const SMOOTHING: &str = "contact is enforced on the surface as meshed";
const THERMAL: &str = "There are no temperatures.";
const GENERAL: &str = "General contact is that of all exterior faces alike.";
const GENERAL_CONTACT: &str = "*CONTACT\n\
         *CONTACT INCLUSIONS, ALL EXTERIOR\n\
         *CONTACT PROPERTY ASSIGNMENT\n\
         , , DRY";
const INITIALIZATION: &str = "*CONTACT INITIALIZATION DATA, NAME=FIT\n\
         *CONTACT\n\
         *CONTACT INCLUSIONS, ALL EXTERIOR\n\
         *CONTACT INITIALIZATION ASSIGNMENT\n\
         , , FIT";
const CONTACT_CHANGE: &str = "Contacts hold for all steps.";
const PAIR: &str = "*CONTACT PAIR, INTERACTION=DRY, TYPE=NODE TO SURFACE\n\
         SBOT, STOP";

pub(super) static CONTACT: &[Keyword] = &[
    Keyword::read(
        "SURFACE INTERACTION",
        Scope::Model,
        Data::Rows(&[row("thickness [length]")]),
        &[
            NAME,
            P::optional("TRACKING THICKNESS", SMOOTHING)
                .measuring("length")
                .warned(),
            P::optional("PAD THICKNESS", "surfaces have no pads").refused(),
            P::flag("USER", "user interactions are not supported").refused(),
        ],
        "Begins an interaction; its laws follow. The out-of-plane thickness on a data line has no \
         effect (warning unless 1).",
        "*SURFACE INTERACTION, NAME=DRY\n\
         *FRICTION\n\
         0.3",
    ),
    Keyword::read(
        "SURFACE BEHAVIOR",
        Scope::Block("SURFACE INTERACTION"),
        Data::Rows(&[
            row("k [force/length^3], tension [force/length^2], clearance [length]")
                .under("PRESSURE-OVERCLOSURE", "LINEAR"),
            row("number [?]").repeating(1),
        ]),
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
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD",
    ),
    Keyword::read(
        "FRICTION",
        Scope::Block("SURFACE INTERACTION"),
        Data::Rows(&[
            row("mu at rest, mu of fast slip, decay [time/length]").under("EXPONENTIAL DECAY", ""),
            row("mu, number [?]").repeating(1),
        ]),
        &[
            P::flag("LAGRANGE", "sticking is exact").ignored(),
            P::value("ELASTIC SLIP", "sticking is exact")
                .measuring("length")
                .warned(),
            P::value("SLIP TOLERANCE", "sticking is exact").warned(),
            P::flag("ROUGH", "give a large coefficient of friction").refused(),
            P::value("TAUMAX", "shear stress has no limit but Coulomb's").refused(),
            P::flag(
                "EXPONENTIAL DECAY",
                "mu = mu_k + (mu_s - mu_k) exp(-d_c |slip rate|): the row is mu_s, mu_k, d_c",
            ),
            P::flag("TEST DATA", "give mu_s, mu_k and d_c").refused(),
            P::flag("ANISOTROPIC", "friction is isotropic").refused(),
            P::flag("USER", "user friction is not supported").refused(),
        ],
        "Coulomb's coefficient of friction mu; further fields, a slip rate for Abaqus and a stick \
         slope for CalculiX, are left out because sticking is exact (warning).",
        "*FRICTION\n\
         0.3",
    ),
    Keyword::read(
        "CONTACT PAIR",
        Scope::Model,
        Data::Required(&[row("slave, master")]),
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
                "slave nodes that are moved onto the master before the start, free of strain: \
                 those of a node set, or those within a largest clearance and those inside the \
                 master",
            )
            .measuring("length or name"),
            P::flag("TIED", "surfaces cannot be tied yet").refused(),
            P::value("EXTENSION ZONE", SMOOTHING).warned(),
            P::value("SMOOTH", SMOOTHING).warned(),
            P::value("HCRIT", SMOOTHING).measuring("length").warned(),
            P::flag("NO THICKNESS", SMOOTHING).warned(),
            P::value("TRACKING", SMOOTHING).warned(),
            P::value("MINIMUM DISTANCE", SMOOTHING).warned(),
            P::value("GEOMETRIC CORRECTION", SMOOTHING).warned(),
            P::value("SLIDING TRANSITION", SMOOTHING).warned(),
            P::value("SUPPLEMENTARY CONSTRAINTS", SMOOTHING).warned(),
            P::value("MECHANICAL CONSTRAINT", "contact is enforced exactly").warned(),
            P::value("CPSET", "there are no contact controls").warned(),
            P::value("WEIGHT", "the slave's nodes meet the master's segments").warned(),
            P::flag("LINEAR", SMOOTHING).warned(),
            P::value("OP", "contact pairs hold for all steps").refused(),
        ],
        "Slave surface, master surface; one contact per row. The master consists of faces. Both \
         orders of two surfaces may be given. One surface alone touches itself. It is an error if \
         a node starts inside the master body by more than 0.001 of the shorter of both sides' \
         edges, unless ADJUST= moves it. It is a warning if no node of a pair faces the master at \
         the start.",
        "*CONTACT PAIR, INTERACTION=DRY, TYPE=NODE TO SURFACE\n\
         SBOT, STOP",
    ),
    Keyword::read(
        "CONTACT",
        Scope::Model,
        Data::None,
        &[P::value("OP", "contacts hold for all steps").refused()],
        "Begins general contact: every exterior face against every other, of its own body too, and \
         every exterior node against the rigid surfaces.",
        GENERAL_CONTACT,
    ),
    Keyword::read(
        "CONTACT INCLUSIONS",
        Scope::Block("CONTACT"),
        Data::Rows(&[row("surface, surface")]),
        &[P::flag(
            "ALL EXTERIOR",
            "all faces that belong to one element only; required",
        )],
        "What takes part in general contact: a surface ALL_EXTERIOR is made, which touches itself \
         and every rigid surface. Where a *CONTACT PAIR joins nodes to a rigid surface, they obey \
         the pair with its interaction, and general contact leaves them out with that surface. \
         Rigid surfaces do not touch each other.",
        GENERAL_CONTACT,
    ),
    Keyword::read(
        "CONTACT PROPERTY ASSIGNMENT",
        Scope::Block("CONTACT"),
        Data::Required(&[row("surface, surface, interaction")]),
        &[],
        "Interaction of general contact: a row of two empty fields, which stand for all surfaces, \
         and its name. Without it there is no friction.",
        GENERAL_CONTACT,
    ),
    Keyword::read(
        "CONTACT INITIALIZATION DATA",
        Scope::BlockOrModel("CONTACT"),
        Data::None,
        &[
            NAME,
            P::value(
                "SEARCH ABOVE",
                "largest clearance of the nodes that are moved (default 0)",
            )
            .measuring("length"),
            P::value(
                "SEARCH BELOW",
                "largest depth of the nodes that are moved (default: any)",
            )
            .measuring("length"),
            P::value(
                "INITIAL CLEARANCE",
                "clearance that the moved nodes get (default 0)",
            )
            .measuring("length"),
            P::choice(
                "ADJUST",
                &[
                    V::read("YES", "nodes are moved free of strain (default)"),
                    V::refused("NO", "overlaps cannot be pressed out in a step"),
                ],
                "whether nodes are moved",
            ),
            P::optional(
                "INTERFERENCE FIT",
                "overlaps cannot be pressed out in a step",
            )
            .refused(),
            P::value("SEARCH NSET", "all nodes are searched").refused(),
        ],
        "Moves nodes of general contact that start inside another body onto its surface, free of \
         strain. With SEARCH ABOVE= nodes above the surface are moved too. Where two surfaces \
         mesh into each other, the deepest nodes are moved first, and the others only if they are \
         still inside. The card acts where *CONTACT INITIALIZATION ASSIGNMENT names it.",
        INITIALIZATION,
    ),
    Keyword::read(
        "CONTACT INITIALIZATION ASSIGNMENT",
        Scope::Block("CONTACT"),
        Data::Required(&[row("surface, surface, initialization")]),
        &[],
        "Which nodes of general contact are moved before the start: a row of two empty fields, which \
         stand for all surfaces, and the name of the *CONTACT INITIALIZATION DATA.",
        INITIALIZATION,
    ),
];

/// Keywords that are not read.
pub(super) static UNREAD_CONTACT: &[Unread] = &[
    Unread::warned(
        "CONTACT CONTROLS, CONTACT CONTROLS ASSIGNMENT, CONTACT STABILIZATION",
        OTHER_NUMBERS,
    ),
    Unread::warned(
        "GAP CONDUCTANCE, GAP HEAT GENERATION, GAP RADIATION",
        THERMAL,
    ),
    Unread::refused(
        "CONTACT EXCLUSIONS, CONTACT FORMULATION, SURFACE PROPERTY ASSIGNMENT",
        GENERAL,
    )
    .example(GENERAL_CONTACT),
    Unread::refused(
        "CONTACT CLEARANCE, CONTACT CLEARANCE ASSIGNMENT, CLEARANCE",
        "Clearances are those of the mesh.",
    ),
    Unread::refused("CONTACT DAMPING", "Contact has no damping."),
    Unread::refused(
        "CONTACT INTERFERENCE",
        "Nodes are moved before the start with ADJUST= of *CONTACT PAIR or *CONTACT INITIALIZATION DATA \
         only.",
    ),
    Unread::refused("COHESIVE BEHAVIOR", "Surfaces do not stick to each other."),
    Unread::refused("TIE", "Surfaces cannot be tied yet."),
    Unread::refused(
        "MODEL CHANGE, CHANGE FRICTION, CHANGE CONTACT TYPE, \
         CHANGE SURFACE BEHAVIOR",
        CONTACT_CHANGE,
    ),
    Unread::refused(
        "GAP, SLIDE LINE",
        "Contact is that of surfaces: use *CONTACT PAIR.",
    )
    .example(PAIR),
];
