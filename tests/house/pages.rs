//! Pages that comments name, such as `docs/numerics.md`.

/// Paths `docs/...md` in comments of a source, with their lines.
pub fn named(source: &str) -> Vec<(usize, &str)> {
    let is_path = |c: char| c.is_ascii_alphanumeric() || "/_.-".contains(c);
    let mut found = Vec::new();
    for (k, line) in source.lines().enumerate() {
        let Some((_, comment)) = line.split_once("//") else {
            continue;
        };
        for (at, _) in comment.match_indices("docs/") {
            let rest = &comment[at..];
            let end = rest.find(|c| !is_path(c)).unwrap_or(rest.len());
            let path = rest[..end].trim_end_matches('.');
            if path.ends_with(".md") {
                found.push((k + 1, path));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_in_comments_are_found() {
        let source = "//! See docs/a.md, B, and docs/c/d.md.\nlet x = \"docs/e.md\";\nf(); // (docs/f.md)\n// docs/g\n";
        let found = [(1, "docs/a.md"), (1, "docs/c/d.md"), (3, "docs/f.md")];
        assert_eq!(named(source), found);
    }
}
