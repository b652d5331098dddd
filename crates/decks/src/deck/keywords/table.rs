//! The keyword table from its texts, `mesh.txt` and further files in the folder of this module, one for each family of
//! keywords:
//!
//! ```text
//! *AMPLITUDE @ model step, required           its levels, and its data lines
//! | under DEFINITION=DECAY | first | A0, A    a kind of data line: which lines, and their fields
//! - TIME=: which time                         a parameter with a value; TIME alone takes none, TIME[=] may
//!   = STEP TIME: since the start of the step  a word that its value may be
//! - SMOOTH= [length] warned: they stay sharp  what its value measures, and that it is not read
//! - NAME= [new amplitude]: name                 the name that the card defines
//! - NSET= [node set]: nodes                     a name that another card defines; `[file]` is a path
//! - INPUT as *NODE                            the parameter of a keyword before
//! - SLAVE or SECONDARY=: a surface              a parameter with two names
//! A function of time.                         what the keyword says
//! > *AMPLITUDE, NAME=PUSH                     lines of a deck that use it
//!
//! *FILTER, *PRINT @ warned                    keywords that are not read
//! ```
//!
//! The levels are `part` (which includes instances), `assembly`, `model`, `step` and `first-step`; `anywhere` means all
//! levels. In decks without parts, cards of parts and the assembly stand at the level of the model. A card of the level
//! `part` that stands in a step belongs to the model, and so does a card of the level `model` in the first step. `under
//! *X` means the block of another keyword; `structure` is the place of the keywords that begin and end parts, instances
//! and the assembly.
//!
//! A field whose own name is a kind of object, alone or behind `or`, holds the name of such an object: `surface`, `node
//! or node set`. A field with another name has the kind of its object in brackets, as parameters have: `slave
//! [surface]`.
//!
//! A line that begins with four blanks continues the line before; a line that begins with two stars is a comment.

use std::collections::HashMap;

use super::types::{
    Data, DataLineForm, Field, Keyword, Level, Levels, Parameter, Quantity, Scope, Status, Takes,
    Value,
};

/// Adds the keywords of a text, in its order, to the keywords of earlier texts, whose parameters the text may name.
pub(super) fn read(text: &'static str, all: &mut Vec<Keyword>) {
    for entry in lines(text).chunk_by(|_, line| !line.starts_with('*')) {
        let (head, of_entry) = entry.split_first().unwrap_or((&"", &[]));
        let (names, what) = head.split_once(" @ ").unwrap_or((head, ""));
        let (status, scope, data) = treatment(what);
        let with = |mark: &'static str| {
            of_entry
                .iter()
                .filter_map(move |line| line.strip_prefix(mark))
        };
        let forms = with("| ").map(form).collect::<Vec<_>>().leak();
        let is_sentence = |line: &&&str| !line.starts_with(['|', '-', ' ', '>']);
        let keyword = Keyword {
            name: "",
            status,
            scope,
            levels: Levels::default(),
            data: match data {
                "rows" => Data::Rows(forms),
                "required" => Data::Required(forms),
                "text" => Data::Text,
                "words" => Data::Words,
                "skipped" => Data::Skipped,
                _ => Data::None,
            },
            parameters: parameters(of_entry, all),
            text: of_entry.iter().find(is_sentence).unwrap_or(&""),
            example: with("> ").collect::<Vec<_>>().join("\n").leak(),
            is_output: false,
            task: "",
        };
        all.extend(names.split(", ").map(|name| Keyword {
            name: name.trim_start_matches('*'),
            ..keyword
        }));
    }
}

/// The keywords with their levels; a keyword within a block has the levels of the keyword that begins the block.
pub(super) fn with_levels(mut all: Vec<Keyword>) -> Vec<Keyword> {
    let scopes: HashMap<&str, Scope> = all.iter().map(|k| (k.name, k.scope)).collect();
    let of = |name: &str| match scopes.get(name) {
        Some(Scope::At(levels)) => *levels,
        _ => Levels::default(),
    };
    for keyword in &mut all {
        keyword.levels = match keyword.scope {
            Scope::At(levels) => levels,
            Scope::Block(head) => of(head),
            Scope::BlockOrAfter(head, other) => of(head).and(of(other)),
            Scope::BlockOrModel(head) => of(head).and(Levels::of(&[Level::Model])),
            Scope::Structure => Levels::default(),
        };
    }
    all
}

/// The lines without comments, each joined with its continuation lines.
pub(super) fn lines(text: &'static str) -> Vec<&'static str> {
    let mut lines: Vec<String> = Vec::new();
    let is_said = |line: &&str| !line.is_empty() && !line.starts_with("**");
    for line in text.lines().filter(is_said) {
        match (line.strip_prefix("    "), lines.last_mut()) {
            (Some(more), Some(last)) => last.extend([" ", more]),
            _ => lines.push(line.to_owned()),
        }
    }
    lines.into_iter().map(|line| &*line.leak()).collect()
}

/// Treatment of a keyword, the place where it may stand, and its data lines.
fn treatment(what: &'static str) -> (Status, Scope, &'static str) {
    let (place, data) = what.split_once(", ").unwrap_or((what, "skipped"));
    if let ("", status @ (Status::Ignored | Status::Warned | Status::Refused)) = with_status(place)
    {
        return (status, Scope::At(Levels::of(&Level::ALL)), data);
    }
    let scope = match place.strip_prefix("under *") {
        Some(block) => match block.strip_suffix(" or model") {
            Some(block) => Scope::BlockOrModel(block),
            None => match block.split_once(" or *") {
                Some((block, of_step)) => Scope::BlockOrAfter(block, of_step),
                None => Scope::Block(block),
            },
        },
        None if place == "structure" => Scope::Structure,
        None => Scope::At(levels(place)),
    };
    (Status::Read, scope, data)
}

/// The levels that words of the table mean.
fn levels(words: &str) -> Levels {
    let of_word = |word: &str| match word {
        "part" => Levels::of(&[Level::Part, Level::Instance]),
        "assembly" => Levels::of(&[Level::Assembly]),
        "model" => Levels::of(&[Level::Model]),
        "step" => Levels::of(&[Level::FirstStep, Level::LaterStep]),
        "first-step" => Levels::of(&[Level::FirstStep]),
        "anywhere" => Levels::of(&Level::ALL),
        _ => Levels::default(),
    };
    words
        .split(' ')
        .map(of_word)
        .fold(Levels::default(), Levels::and)
}

/// Splits a text into its beginning and the status at its end.
fn with_status(text: &'static str) -> (&'static str, Status) {
    let all = [
        ("ignored", Status::Ignored),
        ("warned", Status::Warned),
        ("refused", Status::Refused),
    ];
    let found = all.into_iter().find_map(|(word, status)| {
        let before = text.strip_suffix(word)?;
        (before.is_empty() || before.ends_with(' ')).then_some((before.trim_end(), status))
    });
    found.unwrap_or((text, Status::Read))
}

/// The parameters of an entry; `known` are the keywords of the entries before this entry.
fn parameters(lines: &[&'static str], known: &[Keyword]) -> &'static [Parameter] {
    let mut all: Vec<Parameter> = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        let Some(line) = line.strip_prefix("- ") else {
            continue;
        };
        if let Some((name, keyword)) = line.split_once(" as *") {
            let keyword = known.iter().find(|known| known.name == keyword);
            all.extend(keyword.and_then(|keyword| keyword.parameter(name)));
            continue;
        }
        let (head, text) = line.split_once(": ").unwrap_or((line, ""));
        let (head, status) = with_status(head);
        let (head, holds) = match head
            .strip_suffix(']')
            .and_then(|head| head.split_once(" ["))
        {
            Some((head, quantity)) => (head, Quantity::written(quantity)),
            None => (head, Quantity::Plain),
        };
        let words = lines
            .iter()
            .skip(index + 1)
            .map_while(|line| line.strip_prefix("  = "));
        let values: Vec<Value> = words.map(value).collect();
        let (name, takes) = if let Some(name) = head.strip_suffix("[=]") {
            (
                name,
                match values.is_empty() {
                    true => Takes::Optional,
                    false => Takes::OptionalChoice(values.leak()),
                },
            )
        } else if let Some(name) = head.strip_suffix('=') {
            (
                name,
                match values.is_empty() {
                    true => Takes::Value,
                    false => Takes::Choice(values.leak()),
                },
            )
        } else {
            (head, Takes::Nothing)
        };
        let (name, other) = name.split_once(" or ").unwrap_or((name, ""));
        all.push(Parameter {
            name,
            other,
            takes,
            holds,
            status,
            text,
        });
    }
    all.leak()
}

/// A value of a parameter, written `WORD status: text`.
fn value(line: &'static str) -> Value {
    let (head, text) = line.split_once(": ").unwrap_or((line, ""));
    let (name, status) = with_status(head);
    Value { name, status, text }
}

/// A kind of data line, written `condition | condition | fields`.
fn form(line: &'static str) -> DataLineForm {
    let (conditions, fields) = line.rsplit_once(" | ").unwrap_or(("", line));
    let mut form = DataLineForm {
        parameter: None,
        word: None,
        first: false,
        fields: fields
            .split(", ")
            .map(Field::written)
            .collect::<Vec<_>>()
            .leak(),
        repeating: 0,
    };
    for condition in conditions.split(" | ") {
        match condition.split_once(' ') {
            Some(("under", which)) => {
                form.parameter = Some(which.split_once('=').unwrap_or((which, "")));
            }
            Some(("word", which)) => {
                let (field, words) = which.split_once(' ').unwrap_or((which, ""));
                let words: Vec<&str> = words.split(' ').collect();
                form.word = Some((field.parse().unwrap_or(0), words.leak()));
            }
            Some(("repeat", count)) => form.repeating = count.parse().unwrap_or(0),
            _ => form.first |= condition == "first",
        }
    }
    form
}
