//! Errors and warnings with their place in the deck.
