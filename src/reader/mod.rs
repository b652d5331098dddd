//! From cards to the model: what each keyword means, and the checks across them.
