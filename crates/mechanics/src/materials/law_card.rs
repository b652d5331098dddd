//! What a law says of itself to a deck that is written back.

/// A card of a deck with constants of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct LawCard {
    /// Keyword, without the asterisk.
    pub keyword: &'static str,
    /// What stands behind the keyword, if anything.
    pub parameter: Option<&'static str>,
    /// Numbers of the data lines.
    pub rows: Vec<Vec<f64>>,
}
