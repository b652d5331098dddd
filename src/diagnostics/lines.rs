//! Text in lines of the screen's width.

/// Width of the screen in columns.
const WIDTH: usize = 80;

/// A text in lines, each but the first behind so many blanks; the first keeps its own.
pub(crate) fn wrapped(text: &str, blanks: usize) -> String {
    let own = text.len() - text.trim_start().len();
    let mut lines = " ".repeat(own);
    let mut width = own;
    for (number, word) in text.split_whitespace().enumerate() {
        if number > 0 && width + 1 + word.len() > WIDTH {
            lines.push('\n');
            lines.push_str(&" ".repeat(blanks));
            width = blanks;
        } else if number > 0 {
            lines.push(' ');
            width += 1;
        }
        lines.push_str(word);
        width += word.len();
    }
    lines + "\n"
}

#[cfg(test)]
mod tests {
    use super::wrapped;

    #[test]
    fn lines_are_short_and_behind_blanks() {
        let text = wrapped(&format!("  head {}", "word ".repeat(30)), 4);
        assert!(text.starts_with("  head word") && text.contains("\n    word word"));
        assert!(text.lines().all(|line| line.len() <= 80) && text.lines().count() == 3);
    }
}
