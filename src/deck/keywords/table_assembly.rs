//! The table of keywords that make a deck of parts and an assembly.

use super::keyword::{Data, Keyword, Parameter as P, Scope};

const EXTERNAL: &str = "instances are made of the parts of the deck";

/// Keywords of decks with an assembly.
pub(crate) static ASSEMBLY: &[Keyword] = &[
    Keyword::read(
        "PART",
        Scope::Assembly,
        Data::None,
        &[P::value("NAME", "name; required")],
        "Begins a part: nodes, elements, sets, surfaces and sections that instances copy. Without \
         instance it is left out with a warning.",
    ),
    Keyword::read("END PART", Scope::Assembly, Data::None, &[], "Ends a part."),
    Keyword::read(
        "ASSEMBLY",
        Scope::Assembly,
        Data::None,
        &[P::value("NAME", "name; without effect")],
        "Begins the assembly: instances, and sets and surfaces of their nodes and elements.",
    ),
    Keyword::read(
        "END ASSEMBLY",
        Scope::Assembly,
        Data::None,
        &[],
        "Ends the assembly.",
    ),
    Keyword::read(
        "INSTANCE",
        Scope::Assembly,
        Data::Rows,
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
    ),
    Keyword::read(
        "END INSTANCE",
        Scope::Assembly,
        Data::None,
        &[],
        "Ends an instance.",
    ),
];
