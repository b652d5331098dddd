//! `docs/keywords.md` says what the reader's table says. To write it anew after a change of the
//! table, run this test with the environment variable `BLESS` set.

use stickslip::deck::{Status, keyword_reference, keywords};

#[test]
fn keyword_reference_is_up_to_date() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/keywords.md");
    let wanted = keyword_reference();
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(path, &wanted).expect("docs/keywords.md can be written");
    }
    let found = std::fs::read_to_string(path).unwrap_or_default();
    assert!(
        found == wanted,
        "docs/keywords.md is out of date: run this test with BLESS=1"
    );
}

#[test]
fn every_keyword_is_described() {
    for keyword in keywords() {
        assert!(!keyword.text.is_empty(), "{}", keyword.name);
        let refused = keyword
            .parameters
            .iter()
            .filter(|p| p.status != Status::Read);
        assert!(
            refused.clone().all(|p| !p.text.is_empty()),
            "{}",
            keyword.name
        );
    }
}

#[test]
fn names_are_unique() {
    let fold = |name: &str| name.replace(' ', "");
    let mut names: Vec<String> = keywords().map(|keyword| fold(keyword.name)).collect();
    names.sort();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
}
