use crate::diagnostics::Span;

/// Contact law between two surfaces: hard normal contact and Coulomb friction.
#[derive(Debug, Clone, PartialEq)]
pub struct Interaction {
    /// Name in the deck.
    pub name: String,
    /// Coefficient of friction mu >= 0.
    pub friction: f64,
}

/// A slave surface whose nodes may not enter the body behind the master surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// Index of the slave surface.
    pub slave: usize,
    /// Index of the master surface (made of faces).
    pub master: usize,
    /// Index of the interaction.
    pub interaction: usize,
    /// Where the deck says so, for messages.
    pub span: Span,
}
