//! Places in the files of a deck.

/// Index of a file among the sources of a deck.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct FileId(pub u32);

/// A range of characters in one line of a deck file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Span {
    /// File.
    pub file: FileId,
    /// Line, from 1.
    pub line: u32,
    /// Column of the first character, from 1.
    pub column: u32,
    /// Number of characters.
    pub length: u32,
    /// Instance of a part whose copy of the line is meant, from 1; 0 for the line itself.
    pub instance: u32,
}
