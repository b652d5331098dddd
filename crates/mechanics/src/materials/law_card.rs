//! Cards by which a law is written back to a deck.

/// A card of a deck with constants of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct LawCard {
    /// Keyword, without the asterisk.
    pub keyword: &'static str,
    /// Parameter after the keyword, if any.
    pub parameter: Option<&'static str>,
    /// Numbers of the data lines.
    pub rows: Vec<Vec<f64>>,
}
