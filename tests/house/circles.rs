//! Circles among the parts of a folder that import from each other.

use crate::imports::Imports;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// The circles among parts: for each part on one, a shortest circle through it.
pub fn circles(imports: &Imports) -> BTreeSet<Vec<String>> {
    let parts: BTreeSet<&String> = imports.keys().map(|(from, _)| from).collect();
    let through = parts.into_iter().filter_map(|part| circle(part, imports));
    through.collect()
}

/// A shortest circle through a part, from its first name in the order of the alphabet on.
fn circle(start: &String, imports: &Imports) -> Option<Vec<String>> {
    let mut before: BTreeMap<&String, &String> = BTreeMap::new();
    let mut queue = VecDeque::from([start]);
    while let Some(part) = queue.pop_front() {
        for (_, to) in imports.keys().filter(|(from, _)| from == part) {
            if !before.contains_key(to) {
                before.insert(to, part);
                queue.push_back(to);
            }
        }
    }
    let mut circle = vec![*before.get(start)?];
    while circle[circle.len() - 1] != start {
        circle.push(before[circle[circle.len() - 1]]);
    }
    circle.reverse();
    let first = (0..circle.len()).min_by_key(|i| circle[*i])?;
    circle.rotate_left(first);
    Some(circle.into_iter().cloned().collect())
}

/// The circles within a folder in words, with the lines that import.
pub fn describe_circles(folder: &[String], imports: &Imports) -> Vec<String> {
    let describe = |circle: Vec<String>| {
        let mut text = format!("{}: {}", folder.join("/"), circle.join(" -> "));
        text.push_str(&format!(" -> {}", circle[0]));
        for (i, from) in circle.iter().enumerate() {
            let to = &circle[(i + 1) % circle.len()];
            for line in &imports[&(from.clone(), to.clone())] {
                text.push_str(&format!("\n    {from} -> {to}  {line}"));
            }
        }
        text
    };
    circles(imports).into_iter().map(describe).collect()
}
