//! From text to cards: files, logical lines, keyword lines and data fields.
