//! Layout of the lines on the screen and in the log: width, labels in the first columns, wrapping.

/// Width of the screen in columns.
pub(crate) const WIDTH: usize = 80;

/// One line with its label in front.
pub(crate) fn label(label: &str, text: &str) -> String {
    format!("{label:<9}{text}")
}

/// The items three blanks apart, wrapped into lines.
pub(crate) fn wrap(first: &str, items: &[String]) -> Vec<String> {
    let mut lines = vec![];
    let mut line = label(first, "");
    let mut empty = true;
    for piece in pieces {
        if !empty && line.len() + 3 + piece.len() > WIDTH {
            lines.push(std::mem::replace(&mut line, label("", "")));
            empty = true;
        }
        if !empty {
            line.push_str("   ");
        }
        line.push_str(piece);
        empty = false;
    }
    lines.push(line);
    lines
}
