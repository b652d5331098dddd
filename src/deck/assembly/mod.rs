//! Decks with parts and an assembly made flat: every instance gets the cards of its part, whose
//! spans name the instance. What a name or a number means in an instance is left to the reader.

mod copies;
mod placement;
mod places;
mod structure;

pub(super) use copies::flatten;
