//! The rows of the keyword table for parts, instances and the assembly.

use crate::deck::keywords::fields::{LENGTH, of, plain, row};
use crate::deck::keywords::keyword::{Data, Keyword, Scope};
use crate::deck::keywords::parameter::Parameter as P;

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
            row(&[of("x", LENGTH), of("y", LENGTH), of("z", LENGTH)]).first(),
            row(&[
                of("x1", LENGTH),
                of("y1", LENGTH),
                of("z1", LENGTH),
                of("x2", LENGTH),
                of("y2", LENGTH),
                of("z2", LENGTH),
                plain("degrees"),
            ]),
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
