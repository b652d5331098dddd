//! The rows of the keyword table for files, nodes, elements, sets and surfaces, and for parts,
//! instances and the assembly.

use super::common::{CAE, HARMLESS, INPUT, NAME};
use super::types::{Data, Keyword, Parameter as P, Scope, Unread, Value as V, row};

const OF_INSTANCE: &str = "in the assembly: the rows are numbers and sets of this instance";
const SMOOTHING: &str = "contact is enforced on the surface as meshed";
const NODES: &str = "Give all nodes with *NODE.";
const NODE_CARD: &str = "*NODE, NSET=NBLOCK\n\
         11, 1., 1.1\n\
         12, 3., 1.1\n\
         13, 3., 2.1\n\
         14, 1., 2.1";
const ELEMENTS: &str = "Give all elements with *ELEMENT.";
const ELEMENT_CARD: &str = "*ELEMENT, TYPE=CPE4, ELSET=EBASE\n\
         1, 1, 2, 5, 4\n\
         2, 2, 3, 6, 5";
const RIGID: &str = "Define it with *SURFACE, TYPE=SEGMENTS and *RIGID BODY.";
const RIGID_FLOOR: &str = "*NODE, NSET=NREF\n\
         100, 0., -5.\n\
         *SURFACE, NAME=FLOOR, TYPE=SEGMENTS\n\
         START, -4., -1.\n\
         LINE, 8., -1.\n\
         *RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=NREF\n\
         *BOUNDARY\n\
         NREF, 1, 2";

pub(super) static MESH: &[Keyword] = &[
    Keyword::read(
        "HEADING",
        Scope::Model,
        Data::Text,
        &[],
        "The title: free text until the next keyword.",
        "*HEADING\n\
         block on a fixed base, friction 0.3",
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
        "*INCLUDE, INPUT=parts/brass.inc",
    ),
    Keyword::read(
        "NODE",
        Scope::Model,
        Data::Rows(&[row("node, x [length], y [length], z [length]")]),
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
        "*NODE, NSET=NBLOCK\n\
         11, 1., 1.1\n\
         12, 3., 1.1\n\
         13, 3., 2.1\n\
         14, 1., 2.1",
    ),
    Keyword::read(
        "ELEMENT",
        Scope::Model,
        Data::Rows(&[row("element, node").repeating(1)]),
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
        "*ELEMENT, TYPE=CPE4, ELSET=EBASE\n\
         1, 1, 2, 5, 4\n\
         2, 2, 3, 6, 5",
    ),
    Keyword::read(
        "NSET",
        Scope::Model,
        Data::Rows(&[
            row("first, last, increment").under("GENERATE", ""),
            row("node or node set").repeating(1),
        ]),
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
        "*NSET, NSET=NFIX, GENERATE\n\
         1, 3, 1",
    ),
    Keyword::read(
        "ELSET",
        Scope::Model,
        Data::Rows(&[
            row("first, last, increment").under("GENERATE", ""),
            row("element or element set").repeating(1),
        ]),
        &[
            P::value("ELSET", "name; required; a name used again adds to the set"),
            P::flag("GENERATE", "rows are first, last, increment"),
            INPUT,
            P::flag("INTERNAL", CAE).ignored(),
            P::flag("UNSORTED", "sets have no order").ignored(),
            P::value("INSTANCE", OF_INSTANCE),
        ],
        "An element set: elements and element sets, whole or as ranges.",
        "*ELSET, ELSET=EALL\n\
         EBASE, EBLOCK",
    ),
    Keyword::read(
        "SURFACE",
        Scope::Model,
        Data::Required(&[
            row("START or LINE, x [length], y [length]")
                .saying(0, &["START", "LINE"])
                .under("TYPE", "SEGMENTS"),
            row("CIRCL, x [length], y [length], xc [length], yc [length]")
                .saying(0, &["CIRCL"])
                .under("TYPE", "SEGMENTS"),
            row("node or node set, area [length^2]").under("TYPE", "NODE"),
            row("element or element set, face"),
        ]),
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
        "A surface, made of faces of elements or of a rigid profile. The faces are S1 = side 1-2, \
         S2 = 2-3, S3 = 3-4 (triangle: 3-1) and S4 = 4-1. An element set without a face stands \
         for its free sides, and for the sides that its line elements name. The obstacle of a \
         rigid profile lies on the right of the way from START, the outside on the left. An arc \
         is less than 180 degrees. It is cut into equal chords of at most 1 degree, which are off \
         the arc by at most 3.8e-5 of its radius.",
        "*SURFACE, NAME=STOP\n\
         EBASE, S3",
    ),
    Keyword::read(
        "RIGID BODY",
        Scope::Model,
        Data::None,
        &[
            P::value(
                "ANALYTICAL SURFACE",
                "surface of TYPE=SEGMENTS; this or ELSET is required",
            ),
            P::value("REF NODE", "node, or node set of one node; required"),
            P::value("ELSET", "plane elements, whose nodes all move alike"),
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
        "Moves a rigid surface, or elements, with a reference node. Directions 1 and 2 of this \
         node are prescribed in every step, and the body does not turn. Points of a rigid surface \
         become nodes without element; their numbers follow the largest node number of the deck.",
        "*NODE, NSET=NREF\n\
         100, 0., -5.\n\
         *SURFACE, NAME=FLOOR, TYPE=SEGMENTS\n\
         START, -4., -1.\n\
         LINE, 8., -1.\n\
         *RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=NREF\n\
         *BOUNDARY\n\
         NREF, 1, 2",
    ),
];

const EXTERNAL: &str = "instances are made of the parts of the deck";
const PART: &str = "*PART, NAME=BLOCK\n\
     *NODE\n\
     1, 0., 0.\n\
     2, 2., 0.\n\
     3, 2., 1.\n\
     4, 0., 1.\n\
     *ELEMENT, TYPE=CPE4, ELSET=ALL\n\
     1, 1, 2, 3, 4\n\
     *SOLID SECTION, ELSET=ALL, MATERIAL=STEEL\n\
     1.\n\
     *END PART";
const ASSEMBLY_OF_TWO: &str = "*ASSEMBLY, NAME=BOTH\n\
     *INSTANCE, NAME=LOWER, PART=BLOCK\n\
     *END INSTANCE\n\
     *INSTANCE, NAME=UPPER, PART=BLOCK\n\
     1.5, 1.01, 0.\n\
     1.5, 1.01, 0., 1.5, 1.01, 1., 90.\n\
     *END INSTANCE\n\
     *NSET, NSET=NFIX, INSTANCE=LOWER\n\
     1, 2\n\
     *SURFACE, NAME=STOP\n\
     LOWER.ALL, S3\n\
     *SURFACE, NAME=SBOT\n\
     UPPER.ALL, S4\n\
     *END ASSEMBLY";
const INSTANCE: &str = "*INSTANCE, NAME=UPPER, PART=BLOCK\n\
     1.5, 1.01, 0.\n\
     1.5, 1.01, 0., 1.5, 1.01, 1., 90.\n\
     *END INSTANCE";

pub(super) static ASSEMBLY: &[Keyword] = &[
    Keyword::read(
        "PART",
        Scope::Assembly,
        Data::None,
        &[P::value("NAME", "name; required")],
        "Begins a part: nodes, elements, sets, surfaces and sections that instances copy. Without \
         instance it is left out with a warning.",
        PART,
    ),
    Keyword::read(
        "END PART",
        Scope::Assembly,
        Data::None,
        &[],
        "Ends a part.",
        PART,
    ),
    Keyword::read(
        "ASSEMBLY",
        Scope::Assembly,
        Data::None,
        &[P::value("NAME", "name; without effect")],
        "Begins the assembly: instances, and sets and surfaces of their nodes and elements.",
        ASSEMBLY_OF_TWO,
    ),
    Keyword::read(
        "END ASSEMBLY",
        Scope::Assembly,
        Data::None,
        &[],
        "Ends the assembly.",
        ASSEMBLY_OF_TWO,
    ),
    Keyword::read(
        "INSTANCE",
        Scope::Assembly,
        Data::Rows(&[
            row("x [length], y [length], z [length]").first(),
            row(
                "x1 [length], y1 [length], z1 [length], x2 [length], y2 [length], \
                    z2 [length], degrees",
            ),
        ]),
        &[
            P::value("NAME", "name; required"),
            P::value("PART", "the part that is copied; required"),
            P::value("INSTANCE", EXTERNAL).refused(),
            P::value("LIBRARY", EXTERNAL).refused(),
        ],
        "A copy of a part. The first row is a translation, the second a rotation after it: two \
         points of its axis, which is normal to the plane, and the angle in degrees. Outside the \
         part its nodes, elements, sets and surfaces are called `Instance.name`, such as \
         `Block-1.12`.",
        INSTANCE,
    ),
    Keyword::read(
        "END INSTANCE",
        Scope::Assembly,
        Data::None,
        &[],
        "Ends an instance.",
        INSTANCE,
    ),
];

/// Keywords that are not read.
pub(super) static UNREAD_MESH: &[Unread] = &[
    Unread::refused("TRANSFORM", "Directions are those of the axes x and y."),
    Unread::refused("SYSTEM", "Give coordinates in the axes x and y."),
    Unread::refused("NGEN, NFILL, NCOPY, NMAP", NODES).example(NODE_CARD),
    Unread::refused("ELGEN, ELCOPY", ELEMENTS).example(ELEMENT_CARD),
    Unread::refused(
        "REFINE MESH",
        "Write the finer mesh with *NODE and *ELEMENT.",
    ),
    Unread::refused("PARAMETER", "Write numbers, not parameters."),
    Unread::refused("RIGID SURFACE", RIGID).example(RIGID_FLOOR),
    Unread::refused(
        "IMPERFECTION",
        "Write the imperfect coordinates with *NODE.",
    ),
    Unread::refused("USER ELEMENT", "User elements are not supported."),
    Unread::refused("MATRIX INPUT", "Matrices are those of the elements."),
    Unread::refused("SUPERELEMENT", "Substructures are not supported."),
    Unread::refused("SUBMODEL", "Submodels are not supported."),
    Unread::refused("CYCLIC SYMMETRY MODEL", "Mesh the whole body."),
    Unread::ignored("DISPLAY BODY", HARMLESS),
    Unread::ignored("PREPRINT", HARMLESS).of_words(),
    Unread::ignored("PHYSICAL CONSTANTS", HARMLESS),
    Unread::ignored("NORMAL", "Normals are those of the faces."),
];
