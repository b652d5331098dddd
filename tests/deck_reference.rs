//! `docs/keywords.md` and `scripts/dimensions.json` say what the reader's tables say. To write them
//! anew after a change of the tables, run these tests with the environment variable `BLESS` set.

use stickslip::deck::{Status, dimension_faults, dimensions_json, keyword_reference, keywords};

/// The file holds this text; with `BLESS` it is made to.
fn check(path: &str, wanted: &str) {
    let whole = format!("{}/{path}", env!("CARGO_MANIFEST_DIR"));
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&whole, wanted).expect("the file can be written");
    }
    let found = std::fs::read_to_string(&whole).unwrap_or_default();
    assert!(
        found == wanted,
        "{path} is out of date: run this test with BLESS=1"
    );
}

#[test]
fn keyword_reference_is_up_to_date() {
    check("docs/keywords.md", &keyword_reference());
}

#[test]
fn dimensions_of_the_scripts_are_up_to_date() {
    check("scripts/dimensions.json", &dimensions_json());
}

#[test]
fn all_that_is_read_has_a_dimension_or_is_known_to_have_none() {
    assert_eq!(dimension_faults(), Vec::<String>::new());
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
