//! `docs/keywords.md` and `scripts/dimensions.json` say what the keyword table says, and its examples
//! are read. To write the files anew after a change of the table, run these tests with the
//! environment variable `BLESS` set.

use std::path::Path;
use stickslip::deck::{
    self, Keyword, Scope, Status, Word, dimensions_json, find_keyword, find_word,
    keyword_reference, keywords, words,
};
use stickslip::diagnostics::{Code, Diagnostics, Severity, Sources};
use stickslip::reader;

/// The decks that the examples are parts of.
const SHARED: &str = include_str!("../decks/shared.inp");
const ASSEMBLY: &str = include_str!("../decks/assembly.inp");
const PAIR: &str = "*CONTACT PAIR, INTERACTION=DRY, TYPE=NODE TO SURFACE\nSBOT, STOP\n";
const LAW: &str = "*ELASTIC\n1., 0.3\n";

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
fn every_keyword_is_described() {
    for keyword in keywords() {
        let name = keyword.name;
        assert!(!keyword.text.is_empty(), "{name}");
        let has_example = !keyword.example.is_empty();
        assert!(has_example || keyword.status != Status::Read, "{name}");
        let mut left_out = keyword.parameters.iter();
        let is_described = left_out.all(|p| p.status == Status::Read || !p.text.is_empty());
        assert!(is_described, "{name}");
    }
}

/// Exit code, standard output and standard error of `stickslip explain`.
fn explain(words: &[&str]) -> (Option<i32>, String, String) {
    let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_stickslip"));
    let done = program
        .arg("explain")
        .args(words)
        .output()
        .expect("the program");
    let [out, err] =
        [done.stdout, done.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    (done.status.code(), out, err)
}

#[test]
fn keywords_and_codes_are_explained() {
    let (code, text, _) = explain(&["*contact", "pair"]);
    assert_eq!(code, Some(0));
    assert!(text.starts_with("*CONTACT PAIR: read; it stands before the first step"));
    assert!(text.contains("\n  slave, master\n") && text.contains("\n  ADJUST= (read) "));
    assert!(
        text.contains("example\n  *CONTACT PAIR, INTERACTION=DRY"),
        "{text}"
    );
    assert!(text.lines().all(|line| line.len() <= 80), "{text}");
    let (_, text, _) = explain(&["VISCO"]);
    assert!(
        text.starts_with("*VISCO: stops with an error\n\nSteps are static or dynamic"),
        "{text}"
    );
    assert!(text.contains("in its place\n  *DYNAMIC"), "{text}");
    let (_, text, _) = explain(&["d410"]);
    assert!(text.contains("\n\nMove the mesh"), "{text}");
    let (said, example) = text.split_once("\nexample (").expect("an example");
    assert!(said.lines().all(|line| line.len() <= 80), "{text}");
    assert!(
        example.contains("\n  -11, 1., 1.1\n  +11, 1., 0.99\n"),
        "{text}"
    );
    assert!(
        example.contains("\n  error[D410]: 1 node of SBOT inside"),
        "{text}"
    );
    for code in Code::ALL {
        let (_, text, _) = explain(&[code.id()]);
        assert!(text.contains(&format!("[{}]: ", code.id())), "{text}");
    }
    let (_, text, _) = explain(&["d103"]);
    assert!(
        text.starts_with("D103: A keyword that no program knows"),
        "{text}"
    );
}

#[test]
fn several_words_are_explained_one_after_the_other() {
    let (code, text, _) = explain(&["D103", "contact-pair", "*solid", "section", "d410"]);
    assert_eq!(code, Some(0));
    let heads = [
        "D103: ",
        "\n\n*CONTACT PAIR: ",
        "\n\n*SOLID SECTION: ",
        "\n\nD410: ",
    ];
    let places = heads.map(|head| text.find(head).unwrap_or_else(|| panic!("{head}\n{text}")));
    assert!(places.is_sorted(), "{text}");
}

#[test]
fn what_is_neither_keyword_nor_code_gets_a_suggestion() {
    for (typed, meant) in [
        ("*BONDARY", "did you mean BOUNDARY?"),
        ("D999", "D999 is neither"),
        ("D103 NONSENSE", "error: NONSENSE is neither"),
        ("springs", "keywords about it: *SPRING"),
        (
            "D103 CONTCT PAIR",
            "CONTCT PAIR is neither a keyword nor the code of a message; did you mean CONTACT PAIR?",
        ),
    ] {
        let words: Vec<&str> = typed.split(' ').collect();
        let (code, text, error) = explain(&words);
        assert_eq!((code, text.as_str()), (Some(3), ""));
        assert!(error.contains(meant), "{error}");
    }
}

#[test]
fn words_of_other_programs_are_explained() {
    for (typed, said) in [
        ("bolts", "*PRE-TENSION SECTION"),
        ("Preload", "*PRE-TENSION SECTION"),
        ("gravity", "load GRAV of *DLOAD"),
        ("thermal", "*EXPANSION of a material"),
        ("heat flow", "Heat does not flow"),
        ("RIKS", "arc-length method"),
        ("perturbation", "Steps are nonlinear"),
        ("buckling", "imperfection"),
        ("umat", "User subroutines"),
        ("mass-scaling", "Masses are not scaled"),
        ("user material", "*USER MATERIAL: stops with an error"),
        ("frequency", "*FREQUENCY: stops with an error"),
        ("restart", "*RESTART: read"),
    ] {
        let words: Vec<&str> = typed.split(' ').collect();
        let (code, text, error) = explain(&words);
        assert_eq!((code, error.as_str()), (Some(0), ""), "{typed}");
        assert!(text.contains(said), "{text}");
    }
    let (_, text, _) = explain(&["riks", "d410"]);
    assert!(text.starts_with("riks, ") && text.contains("\n\nD410: "));
    assert!(text.contains("in its place\n  *BOUNDARY\n"), "{text}");
}

/// A word stands once and is no keyword; the keywords of its sentence and example are known, and all those of
/// its example are read.
#[test]
fn words_lead_to_keywords_that_are_read() {
    let mut names: Vec<&str> = words()
        .flat_map(|word| word.names.iter().copied())
        .collect();
    names.sort_unstable();
    assert!(names.len() > 80 && names.windows(2).all(|pair| pair[0] != pair[1]));
    for name in names {
        assert_eq!(find_keyword(name), None, "{name}");
        let found = find_word(&name.to_uppercase()).expect("a word");
        assert!(
            found.names.contains(&name) && found.text.ends_with('.'),
            "{name}"
        );
    }
    for word in words() {
        for line in word
            .example
            .lines()
            .filter_map(|line| line.strip_prefix("  *"))
        {
            let keyword = line.split(',').next().and_then(find_keyword);
            assert_eq!(
                keyword.map(|keyword| keyword.status),
                Some(Status::Read),
                "{line}"
            );
        }
        for said in word.text.split('*').skip(1) {
            let is_of_name = |c: char| c.is_ascii_uppercase() || " -".contains(c);
            let end = said.find(|c| !is_of_name(c)).unwrap_or(said.len());
            assert!(find_keyword(said[..end].trim()).is_some(), "{said}");
        }
    }
}

#[test]
fn lines_on_the_screen_are_short() {
    let long = |line: &&str| line.len() > 80;
    let texts = keywords().map(Keyword::explanation);
    let texts: Vec<String> = texts.chain(words().map(Word::explanation)).collect();
    let lines: Vec<&str> = texts
        .iter()
        .flat_map(|text| text.lines())
        .filter(long)
        .collect();
    assert_eq!(lines, Vec::<&str>::new());
}

#[test]
fn names_are_unique() {
    let fold = |name: &str| name.replace(' ', "");
    let mut names: Vec<String> = keywords().map(|keyword| fold(keyword.name)).collect();
    names.sort();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
}

/// The shared deck with these lines where cards of `scope` stand, unless it has them.
pub(crate) fn deck_with(lines: &str, scope: Scope) -> String {
    let put = |before: &str, first: &str| {
        assert!(SHARED.contains(before), "{before}");
        SHARED.replacen(before, &format!("{first}{lines}\n{before}"), 1)
    };
    match scope {
        _ if SHARED.contains(lines) => SHARED.to_owned(),
        _ if ASSEMBLY.contains(lines) => ASSEMBLY.to_owned(),
        _ if lines.ends_with("*END STEP") => format!("{SHARED}{lines}\n"),
        _ if lines.contains("*CONTACT\n") => put("*STEP", "").replacen(PAIR, "", 1),
        Scope::At(levels) if !levels.are_of_model() => put("*END STEP", ""),
        Scope::Block("MATERIAL") => {
            let law = if lines.contains("ELASTIC") { "" } else { LAW };
            put("*SOLID SECTION", &format!("*MATERIAL, NAME=NEW\n{law}"))
        }
        Scope::Block("SURFACE INTERACTION") | Scope::BlockOrAfter(..) => {
            put("*CONTACT PAIR", "*SURFACE INTERACTION, NAME=NEW\n")
        }
        _ => put("*STEP", ""),
    }
}

/// Where the first keyword of these lines may stand.
pub(crate) fn scope_of(lines: &str) -> Scope {
    let name = lines.split([',', '\n']).next().unwrap_or_default();
    let found = find_keyword(name.trim_start_matches('*'));
    found.expect("an example begins with a keyword").scope
}

/// Faults that the example of a keyword has in a deck of this folder.
fn faults(keyword: &Keyword, folder: &Path) -> Option<String> {
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let path = folder.join("deck.inp");
    let text = deck_with(keyword.example, scope_of(keyword.example));
    std::fs::write(&path, text).expect("the deck can be written");
    let deck = deck::read(&path, &mut sources, &mut d);
    reader::build(&deck, &mut d);
    let errors = d.iter().filter(|item| item.severity == Severity::Error);
    let errors: String = errors.map(|item| format!("{}\n", item.message)).collect();
    (!errors.is_empty()).then(|| format!("*{}:\n{errors}", keyword.name))
}

#[test]
fn examples_are_read() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("examples");
    let parts = folder.join("parts");
    std::fs::create_dir_all(&parts).expect("a folder");
    std::fs::copy("tests/decks/parts/brass.inc", parts.join("brass.inc")).expect("a file");
    let with_example = keywords().filter(|keyword| !keyword.example.is_empty());
    let faults: String = with_example
        .filter_map(|one| faults(one, &folder))
        .collect();
    assert!(faults.is_empty(), "{faults}");
}
