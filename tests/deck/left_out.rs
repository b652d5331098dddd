//! Nothing that is read is left out in silence. For the cards of the examples of all keywords and of the decks of this
//! folder: a further row, a further field, the card once more with other numbers, every parameter, and every parameter
//! beside every other one is refused, is warned of, or changes the model.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use stickslip::deck::{self, Data, Keyword, Parameter, Status, Takes, find_keyword, keywords};
use stickslip::diagnostics::{Diagnostics, Sources, Span};
use stickslip::model::Model;
use stickslip::reader;

use crate::reference::{deck_with, scope_of};

/// A word that is no number, name, direction or kind of load.
const STRANGE: &str = "STRANGE";

/// Values one of which most parameters can have in the shared deck.
const VALUES: [&str; 11] = [
    "1", "0.5", "NFIX", "NBLOCK", "EBLOCK", "STOP", "SBOT", "DRY", "STEEL", "SHOTS", "13",
];

/// Parameters that need not change the model of their example, and why.
const ALLOWED: [(&str, &str, &str); 13] = [
    ("NSET", "UNSORTED", "only *EQUATION asks for an order"),
    ("BOUNDARY", "OP=NEW", "nothing was given before"),
    ("CLOAD", "OP=NEW", "nothing was given before"),
    ("DSLOAD", "OP=NEW", "nothing was given before"),
    ("CONTACT INTERFERENCE", "OP=NEW", "nothing was given before"),
    ("TEMPERATURE", "OP=NEW", "nothing was given before"),
    ("DSLOAD", "FOLLOWER=YES", "a pressure follows in any case"),
    (
        "TIME POINTS",
        "TIME=TOTAL TIME",
        "no request asks for the times",
    ),
    (
        "WEAR SURFACE PROPERTIES",
        "FRIC COEF DEPENDENT=YES",
        "no contact has the interaction",
    ),
    ("DLOAD", "OP=NEW", "nothing was given before"),
    (
        "SOLID SECTION",
        "FORMULATION=DISPLACEMENT",
        "what CPE4 has in any case",
    ),
    ("STEP", "AMPLITUDE=STEP", "the default of dynamic steps"),
    (
        "STEP",
        "AMPLITUDE=RAMP",
        "the example has no load of its own",
    ),
];

/// Keywords that say that what they give replaces what another card has given.
const REPLACING: [&str; 2] = ["INITIAL CONDITIONS", "TEMPERATURE"];

/// What a deck is read as: its messages, and the model unless it is refused.
#[derive(PartialEq)]
struct Outcome {
    messages: Vec<String>,
    model: Option<Model>,
}

/// Reads decks in a folder, which has the files that they include.
struct Folder(PathBuf);

impl Folder {
    /// The folder of a test.
    fn new(test: &str) -> Folder {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
        std::fs::create_dir_all(folder.join("parts")).expect("a folder");
        for file in std::fs::read_dir("tests/decks/parts").expect("a folder") {
            let file = file.expect("a file");
            std::fs::copy(file.path(), folder.join("parts").join(file.file_name()))
                .expect("a file");
        }
        Folder(folder)
    }

    fn outcome(&self, text: &str) -> Outcome {
        let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
        let path = self.0.join("deck.inp");
        std::fs::write(&path, text).expect("the deck can be written");
        let deck = deck::read(&path, &mut sources, &mut d);
        let mut model = reader::build(&deck, &mut d);
        for contact in model.iter_mut().flat_map(|model| &mut model.contacts) {
            contact.span = Span::default();
        }
        let messages = d
            .iter()
            .map(|item| format!("{:?}: {}", item.code, item.message));
        Outcome {
            messages: messages.collect(),
            model,
        }
    }
}

/// A deck with the place of a card in it.
struct Place {
    keyword: &'static Keyword,
    before: String,
    head: String,
    rows: Vec<String>,
    after: String,
}

impl Place {
    /// The card at line `at` of a deck; none where it goes on in the next line.
    fn new(deck: &str, at: usize) -> Option<Place> {
        let lines: Vec<&str> = deck.lines().collect();
        let head = lines.get(at)?;
        let name = head.strip_prefix('*')?.split(',').next()?.trim();
        let rows = lines[at + 1..].iter();
        let rows: Vec<String> = rows
            .take_while(|line| !line.starts_with('*'))
            .map(|line| (*line).to_owned())
            .collect();
        let join = |lines: &[&str]| lines.iter().map(|line| format!("{line}\n")).collect();
        let keyword = find_keyword(name)?;
        (keyword.status == Status::Read && !head.ends_with(',')).then(|| Place {
            keyword,
            before: join(&lines[..at]),
            head: (*head).to_owned(),
            after: join(&lines[at + 1 + rows.len()..]),
            rows,
        })
    }

    /// The card in the example of its keyword.
    fn of_example(keyword: &'static Keyword) -> Place {
        let deck = deck_with(keyword.example, scope_of(keyword.example));
        let is_own = |line: &&str| line.split(',').next() == Some(&format!("*{}", keyword.name));
        let own = keyword.example.lines().position(|line| is_own(&line));
        let before = deck
            .find(keyword.example)
            .map(|at| deck[..at].lines().count());
        let at = before.zip(own).map(|(before, own)| before + own);
        let place = at.and_then(|at| Place::new(&deck, at));
        place.unwrap_or_else(|| panic!("the card in the example of {}", keyword.name))
    }

    fn with(&self, head: &str, rows: &[String]) -> String {
        let rows: String = rows.iter().map(|row| format!("{row}\n")).collect();
        format!("{}{head}\n{rows}{}", self.before, self.after)
    }

    fn takes_rows(&self) -> bool {
        matches!(self.keyword.data, Data::Rows(_) | Data::Required(_))
    }

    /// The keyword with its parameters, without the names and numbers that these have.
    fn kind(&self) -> String {
        let parts = self.head.split(',').map(|part| match part.split_once('=') {
            Some((name, value)) => {
                let known = self.keyword.parameter(name.trim());
                let words = known.map_or(&[][..], Parameter::values);
                let is_word = words.iter().any(|word| word.name == value.trim());
                format!("{name}={}", if is_word { value } else { "" })
            }
            None => part.to_owned(),
        });
        parts.collect()
    }

    /// Whether the keyword line has a parameter.
    fn has(&self, parameter: &Parameter) -> bool {
        let fold = |text: &str| text.to_uppercase().replace(' ', "");
        fold(&self.head).contains(&format!(",{}", fold(parameter.name)))
    }
}

/// Rows in which one field more stands behind the others, or behind empty ones, of one of the first two or of the last;
/// what that is.
fn with_fields(place: &Place) -> Vec<(String, Vec<String>)> {
    let forms = place.keyword.data.forms().iter();
    let most = forms.map(|form| form.fields().count()).max().unwrap_or(1);
    let mut all = Vec::new();
    let is_tried = |(index, _): &(usize, &String)| *index < 2 || index + 1 == place.rows.len();
    for (index, row) in place.rows.iter().enumerate().filter(is_tried) {
        let fields: Vec<&str> = row.trim_end_matches(',').split(',').collect();
        for at in fields.len()..=fields.len().max(most) {
            let mut fields = fields.clone();
            fields.resize(at, "");
            fields.push(STRANGE);
            let mut rows = place.rows.clone();
            rows[index] = fields.join(",");
            all.push((format!("field {} of row {}", at + 1, index + 1), rows));
        }
    }
    all
}

#[test]
fn rows_and_fields() {
    let folder = Folder::new("rows_and_fields");
    let mut places: Vec<Place> = (keywords().filter(|keyword| keyword.status == Status::Read))
        .map(Place::of_example)
        .collect();
    for path in std::fs::read_dir("tests/decks").expect("a folder") {
        let path = path.expect("an entry").path();
        let deck = match path.extension().is_some_and(|extension| extension == "inp") {
            true => std::fs::read_to_string(&path).expect("a deck"),
            false => continue,
        };
        if folder.outcome(&deck).model.is_some() {
            places.extend((0..deck.lines().count()).filter_map(|at| Place::new(&deck, at)));
        }
    }
    // one of each kind, with one row and with more
    let mut seen = BTreeSet::new();
    places.retain(|place| seen.insert((place.kind(), place.rows.len().min(2))));
    let mut left_out = Vec::new();
    for place in places.iter().filter(|place| place.takes_rows()) {
        let base = folder.outcome(&place.with(&place.head, &place.rows));
        let more = place.rows.iter().cloned().chain([STRANGE.to_owned()]);
        let row = ("row".to_owned(), more.collect());
        for (what, rows) in with_fields(place).into_iter().chain([row]) {
            if folder.outcome(&place.with(&place.head, &rows)) == base {
                left_out.push(format!("{}: {what}", place.head));
            }
        }
    }
    assert_eq!(left_out, Vec::<String>::new());
}

/// A line with other numbers.
fn changed(line: &str) -> String {
    let fields = line
        .split(',')
        .map(|field| match field.trim().parse::<f64>() {
            Ok(value) if field.contains('.') && value != 0.0 => (1.25 * value).to_string(),
            _ => field.to_owned(),
        });
    fields.collect::<Vec<_>>().join(",")
}

#[test]
fn cards_given_twice() {
    let folder = Folder::new("cards_given_twice");
    let mut left_out = Vec::new();
    for keyword in keywords().filter(|keyword| keyword.status == Status::Read) {
        let place = Place::of_example(keyword);
        let other: Vec<String> = place.rows.iter().map(|row| changed(row)).collect();
        if other == place.rows {
            continue;
        }
        let first = folder.outcome(&place.with(&place.head, &place.rows));
        let second = folder.outcome(&place.with(&place.head, &other));
        let both: Vec<String> = (place.rows.iter().cloned())
            .chain([place.head.clone()])
            .chain(other)
            .collect();
        let both = folder.outcome(&place.with(&place.head, &both));
        let replaces = both == second && !REPLACING.contains(&keyword.name);
        if second.model.is_some() && (both == first || replaces) {
            left_out.push(keyword.name);
        }
    }
    assert_eq!(left_out, Vec::<&str>::new());
}

/// A parameter as a keyword line may have it: with each word that is read and no default, or with a value that the
/// deck takes.
fn valid(parameter: &Parameter, place: &Place, folder: &Folder) -> Vec<String> {
    let name = parameter.name;
    match parameter.takes {
        Takes::Nothing | Takes::Optional => vec![name.to_owned()],
        Takes::Choice(words) | Takes::OptionalChoice(words) => {
            let read = words.iter().filter(|word| word.status == Status::Read);
            let own = read.filter(|word| !word.is_default());
            own.map(|word| format!("{name}={}", word.name)).collect()
        }
        Takes::Value => {
            let mut all = VALUES.iter().map(|value| format!("{name}={value}"));
            let is_taken = |written: &String| {
                let head = format!("{}, {written}", place.head);
                folder
                    .outcome(&place.with(&head, &place.rows))
                    .model
                    .is_some()
            };
            all.find(is_taken).into_iter().collect()
        }
    }
}

/// A parameter as nothing that reads it can take it, or which changes something.
fn strange(parameter: &Parameter, valid: &[String]) -> Vec<String> {
    match parameter.takes {
        Takes::Value | Takes::Optional => vec![format!("{}={STRANGE}", parameter.name)],
        Takes::Nothing | Takes::Choice(_) | Takes::OptionalChoice(_) => valid.to_vec(),
    }
}

#[test]
fn parameters_alone_and_beside_each_other() {
    let folder = Folder::new("parameters_alone_and_beside_each_other");
    let mut left_out = Vec::new();
    for keyword in keywords().filter(|keyword| keyword.status == Status::Read) {
        let place = Place::of_example(keyword);
        let parameters = keyword.parameters.iter();
        let free: Vec<(&Parameter, Vec<String>)> = parameters
            .filter(|parameter| parameter.status == Status::Read && !place.has(parameter))
            .map(|parameter| (parameter, valid(parameter, &place, &folder)))
            .collect();
        let mut check = |name: &str, beside: &str| {
            let head = format!("{}{beside}", place.head);
            let base = folder.outcome(&place.with(&head, &place.rows));
            if base.model.is_none() {
                return;
            }
            for (parameter, valid) in free.iter().filter(|(known, _)| known.name != name) {
                for written in strange(parameter, valid) {
                    let head = format!("{head}, {written}");
                    let is_allowed = ALLOWED
                        .iter()
                        .any(|allowed| (allowed.0, allowed.1) == (keyword.name, &written));
                    if !is_allowed && folder.outcome(&place.with(&head, &place.rows)) == base {
                        left_out.push(format!("{}: {written} behind {head}", keyword.name));
                    }
                }
            }
        };
        check("", "");
        for (parameter, valid) in &free {
            valid
                .iter()
                .for_each(|written| check(parameter.name, &format!(", {written}")));
        }
    }
    assert_eq!(left_out, Vec::<String>::new());
}
