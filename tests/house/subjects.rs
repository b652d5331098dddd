//! Subjects of a page that texts name, such as `docs/theory/time.md, Damping`: its headings, and the bold beginnings of its
//! paragraphs.

/// Citations `PAGE, Subject` in comments of a source, or in a document, of subjects that the page does not have.
pub fn unknown(text: &str, is_source: bool, (name, page): (&str, &str)) -> Vec<String> {
    let lines = text.lines().map(|line| match line.trim_start() {
        line if !is_source => line,
        line if line.starts_with("//") => line.trim_start_matches(['/', '!']).trim(),
        _ => "",
    });
    let text = lines.collect::<Vec<_>>().join(" ");
    let subjects: Vec<&str> = page.lines().filter_map(subject).collect();
    let start = format!("{name}, ");
    let cited = text.split(&start).skip(1);
    let cited = cited.filter(|rest| rest.starts_with(|c: char| c.is_ascii_uppercase()));
    let is_known = |rest: &&str| subjects.iter().any(|subject| begins_with(rest, subject));
    let unknown = cited.filter(|rest| !is_known(rest));
    unknown
        .map(|rest| rest.chars().take(40).collect())
        .collect()
}

/// What a line of a page begins with: a heading without its number and the names of its modules, or bold words.
fn subject(line: &str) -> Option<&str> {
    if let Some(bold) = line.strip_prefix("**") {
        return bold
            .split("**")
            .next()
            .map(|name| name.trim_end_matches('.'));
    }
    let heading = line.strip_prefix('#')?.trim_start_matches('#').trim();
    let title = heading.split(" (`").next()?;
    let number = title.split_once(". ");
    let number = number.filter(|(number, _)| number.bytes().all(|b| b.is_ascii_digit()));
    Some(number.map_or(title, |(_, rest)| rest))
}

fn begins_with(text: &str, subject: &str) -> bool {
    let rest = text.strip_prefix(subject);
    rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_alphanumeric()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "# Page\n\n## 4. Time (`step`)\n\n**Damping.** Text **bold**\n";

    #[test]
    fn subjects_are_headings_and_bold_beginnings() {
        let subjects: Vec<&str> = PAGE.lines().filter_map(subject).collect();
        assert_eq!(subjects, ["Page", "Time", "Damping"]);
    }

    #[test]
    fn citations_of_other_subjects_are_found() {
        let unknown = |text: &str| unknown(text, true, ("p.md", PAGE));
        let right =
            "//! Section 4 of p.md,\n//! Damping.\nf(); // p.md, Time, and p.md, section 3\n";
        assert!(unknown(right).is_empty());
        assert!(unknown("\"p.md, Wrong\"").is_empty());
        for wrong in ["// p.md, Bold", "/// p.md,\n/// Timely", "// p.md, Text"] {
            assert_eq!(unknown(wrong).len(), 1, "{wrong}");
        }
    }
}
