//! Layout of the lines on the screen and in the log: width, labels in the first columns, wrapping.

/// Width of the screen in columns.
pub(crate) const WIDTH: usize = 80;

/// One line with its label in front.
pub(crate) fn label(label: &str, text: &str) -> String {
    format!("{label:<9}{text}")
}

/// The items three blanks apart, wrapped into lines, the first one labelled `first`.
pub(crate) fn wrap(first: &str, items: &[String]) -> Vec<String> {
    wrap_apart(first, items.iter().map(String::as_str), "   ")
}

/// The words of a text, wrapped into lines, the first one labelled `first`.
pub(crate) fn wrap_words(first: &str, text: &str) -> Vec<String> {
    wrap_apart(first, text.split(' '), " ")
}

/// The items with `gap` between them, wrapped into lines.
fn wrap_apart<'t>(first: &str, items: impl IntoIterator<Item = &'t str>, gap: &str) -> Vec<String> {
    let mut lines = vec![];
    let mut line = label(first, "");
    let mut is_empty = true;
    for item in items {
        if !is_empty && line.len() + gap.len() + item.len() > WIDTH {
            lines.push(std::mem::replace(&mut line, label("", "")));
            is_empty = true;
        }
        if !is_empty {
            line.push_str(gap);
        }
        line.push_str(item);
        is_empty = false;
    }
    lines.push(line);
    lines
}
