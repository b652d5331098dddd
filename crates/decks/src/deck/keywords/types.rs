//! Types of the keyword table: keywords with their place, data lines, sentence and example; their
//! parameters and values; the fields of data lines, and what numbers measure.

use crate::deck::text::{Match, find_known, fold};

/// A level of a deck. Parts, instances and the assembly are levels of decks that have them; in a flat deck their cards
/// stand at the level of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// A part.
    Part,
    /// An instance.
    Instance,
    /// The assembly, outside its instances.
    Assembly,
    /// Outside parts, the assembly and steps.
    Model,
    /// The first step.
    FirstStep,
    /// A step behind the first.
    LaterStep,
}

impl Level {
    /// All levels.
    pub const ALL: [Level; 6] = [
        Level::Part,
        Level::Instance,
        Level::Assembly,
        Level::Model,
        Level::FirstStep,
        Level::LaterStep,
    ];
}

/// Levels at which a card may stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Levels(u8);

impl Levels {
    /// These levels.
    pub fn of(levels: &[Level]) -> Levels {
        let bits = levels.iter().map(|level| 1 << (*level as u8));
        Levels(bits.fold(0, |all, bit| all | bit))
    }

    /// The levels of both.
    pub fn and(self, other: Levels) -> Levels {
        Levels(self.0 | other.0)
    }

    /// Whether a level is among them.
    pub fn has(self, level: Level) -> bool {
        self.0 & Levels::of(&[level]).0 != 0
    }

    /// Whether cards belong to the mesh and what joins it: they define something that steps refer to.
    pub fn are_of_mesh(self) -> bool {
        self.has(Level::Part) || self.has(Level::Assembly)
    }

    /// Whether cards may stand outside steps in a deck without parts.
    pub fn are_of_model(self) -> bool {
        self.are_of_mesh() || self.has(Level::Model)
    }

    /// Whether what a card in a step says holds from the start: it belongs to the model.
    pub fn hold_from_the_start(self) -> bool {
        self.are_of_mesh() || !self.has(Level::LaterStep)
    }
}

/// Where a keyword may stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// By itself at these levels.
    At(Levels),
    /// In the block of the keyword of this name.
    Block(&'static str),
    /// In the block of the first, a model keyword, or right after the second, a keyword of steps.
    BlockOrAfter(&'static str, &'static str),
    /// In such a block, or by itself at the level of the model.
    BlockOrModel(&'static str),
    /// Around parts, instances and the assembly.
    Structure,
}

/// Data lines of a keyword.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Data {
    /// It takes none.
    None,
    /// Any number of rows; the first form that fits a row holds.
    Rows(&'static [DataLineForm]),
    /// At least one row.
    Required(&'static [DataLineForm]),
    /// Free text.
    Text,
    /// Words that are not looked at.
    Words,
    /// Anything, which is not looked at.
    Skipped,
}

impl Data {
    /// The kinds of data lines.
    pub fn forms(self) -> &'static [DataLineForm] {
        match self {
            Data::Rows(forms) | Data::Required(forms) => forms,
            Data::None | Data::Text | Data::Words | Data::Skipped => &[],
        }
    }
}

/// A kind of things that have names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// Nodes.
    NodeSet,
    /// Elements.
    ElementSet,
    /// Faces or nodes for contact.
    Surface,
    /// A material.
    Material,
    /// Friction and other laws of contact.
    SurfaceInteraction,
    /// A function of time.
    Amplitude,
    /// Times for frames.
    TimePoints,
    /// A step.
    Step,
    /// A part.
    Part,
    /// A copy of a part.
    Instance,
    /// Axes.
    Orientation,
    /// Circles on which faces lie.
    SurfaceSmoothing,
    /// How nodes of general contact are moved at the start.
    ContactInitialization,
    /// A tie between surfaces.
    Tie,
    /// A coupling of nodes to a reference node.
    Coupling,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Kind; 15] = [
        Kind::NodeSet,
        Kind::ElementSet,
        Kind::Surface,
        Kind::Material,
        Kind::SurfaceInteraction,
        Kind::Amplitude,
        Kind::TimePoints,
        Kind::Step,
        Kind::Part,
        Kind::Instance,
        Kind::Orientation,
        Kind::SurfaceSmoothing,
        Kind::ContactInitialization,
        Kind::Tie,
        Kind::Coupling,
    ];

    /// What the table and messages call a thing of this kind.
    pub fn name(self) -> &'static str {
        match self {
            Kind::NodeSet => "node set",
            Kind::ElementSet => "element set",
            Kind::Surface => "surface",
            Kind::Material => "material",
            Kind::SurfaceInteraction => "surface interaction",
            Kind::Amplitude => "amplitude",
            Kind::TimePoints => "list of time points",
            Kind::Step => "step",
            Kind::Part => "part",
            Kind::Instance => "instance",
            Kind::Orientation => "orientation",
            Kind::SurfaceSmoothing => "surface smoothing",
            Kind::ContactInitialization => "contact initialization",
            Kind::Tie => "tie",
            Kind::Coupling => "coupling",
        }
    }

    /// The kind with this name.
    fn named(name: &str) -> Option<Kind> {
        Kind::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// The kind that a text names alone, or behind ` or `.
    fn at_end_of(text: &str) -> Option<Kind> {
        let last = text.rsplit_once(" or ").map_or(text, |(_, last)| last);
        Kind::named(last)
    }
}

/// A known keyword.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Keyword {
    /// The keyword without its star, with blanks.
    pub name: &'static str,
    /// What the program does with it.
    pub status: Status,
    /// Where it may stand.
    pub scope: Scope,
    /// The levels at which it may stand, with the block that it belongs to.
    pub levels: Levels,
    /// Its data lines.
    pub data: Data,
    /// Its parameters.
    pub parameters: &'static [Parameter],
    /// What it says.
    pub text: &'static str,
    /// Lines of a deck that use it, or what is read in its place; empty if there is nothing.
    pub example: &'static str,
    /// Whether it asks for output: what is not known of it is left out, as the answer does not depend on it.
    pub is_output: bool,
    /// What it is for: the title of its family.
    pub task: &'static str,
}

impl Keyword {
    /// The words for its parameters.
    pub fn parameter_names(&self) -> impl Iterator<Item = &'static str> + Clone + use<> {
        let both = self.parameters.iter().flat_map(|p| [p.name, p.other]);
        both.filter(|name| !name.is_empty())
    }

    /// The parameter with this name, blanks and case aside.
    pub fn parameter(&self, name: &str) -> Option<&'static Parameter> {
        let folded = fold(name);
        let is_meant = |p: &&Parameter| [p.name, p.other].map(fold).contains(&folded);
        self.parameters.iter().find(is_meant)
    }

    /// The parameter that a typed word is read as: its name or a beginning of it.
    pub fn parameter_read_as(&self, typed: &str) -> Option<&'static Parameter> {
        match find_known(typed, self.parameter_names()) {
            Match::Exact(name) | Match::Abbreviation(name) => {
                let is_meant = |p: &&Parameter| [p.name, p.other].contains(&name);
                self.parameters.iter().find(is_meant)
            }
            Match::Unknown(_) => None,
        }
    }

    /// Kind of the thing that a card of this keyword defines or adds to, and the parameter with its name.
    pub fn definition(&self) -> Option<(&'static Parameter, Kind)> {
        let mut parameters = self.parameters.iter();
        parameters.find_map(|parameter| match parameter.holds {
            Quantity::New(kind) => Some((parameter, kind)),
            _ => None,
        })
    }
}

/// What the program does with a keyword, a parameter or a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Read and honoured.
    Read,
    /// Left out silently: it does not affect the results.
    Ignored,
    /// Left out or replaced with a warning.
    Warned,
    /// Stops with an error: leaving it out would change the results.
    Refused,
}

/// Values of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Takes {
    /// It takes no value.
    Nothing,
    /// A name, number or path.
    Value,
    /// A value that may be left out.
    Optional,
    /// One of these words.
    Choice(&'static [Value]),
    /// One of these words, or nothing.
    OptionalChoice(&'static [Value]),
}

/// A word that a parameter can take as its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Value {
    /// The word, with blanks.
    pub name: &'static str,
    /// What the program does with it.
    pub status: Status,
    /// One sentence; empty where the word explains itself.
    pub text: &'static str,
}

impl Value {
    /// Whether it is the default, or another word for it.
    pub fn is_default(&self) -> bool {
        self.text.ends_with("(default)") || self.text.starts_with("the same")
    }
}

/// A parameter of a keyword.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Parameter {
    /// The word before the equals sign, with blanks.
    pub name: &'static str,
    /// Another word for it; empty if there is none.
    pub other: &'static str,
    /// Its values.
    pub takes: Takes,
    /// What a value holds.
    pub holds: Quantity,
    /// What the program does with it.
    pub status: Status,
    /// One sentence.
    pub text: &'static str,
}

impl Parameter {
    /// The words this parameter can take; empty if it takes anything.
    pub fn values(&self) -> &'static [Value] {
        match self.takes {
            Takes::Choice(values) | Takes::OptionalChoice(values) => values,
            Takes::Nothing | Takes::Value | Takes::Optional => &[],
        }
    }

    /// The word of its list that a typed value is read as.
    pub fn value_read_as(&self, typed: &str) -> Option<&'static str> {
        match find_known(typed, self.values().iter().map(|value| value.name)) {
            Match::Exact(name) | Match::Abbreviation(name) => Some(name),
            Match::Unknown(_) => None,
        }
    }
}

/// What a field or a parameter's value holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// A word, a label, or a number that is the same in all units.
    Plain,
    /// A number of this dimension, written as in the result file: `mass/length^3`.
    Of(&'static str),
    /// A number of the given dimension, and its default.
    OfOr(&'static str, &'static str),
    /// A number of this dimension, or the name of a thing of this kind.
    OrName(&'static str, Kind),
    /// The name of a thing of this kind, where a word or a label does not stand in its place.
    Name(Kind),
    /// The name of a thing of this kind that the card defines or adds to.
    New(Kind),
    /// The path of a file that is read in this place.
    File,
    /// A number whose dimension is not known: other codes disagree on it.
    Unknown,
}

impl Quantity {
    /// The quantity that the table writes as `length`, `length = 1` with its default, `length or node set`,
    /// `node set`, `new node set`, `file`, or `?`.
    pub(super) fn written(text: &'static str) -> Quantity {
        if text == "?" {
            Quantity::Unknown
        } else if text == "file" {
            Quantity::File
        } else if let Some(kind) = Kind::named(text) {
            Quantity::Name(kind)
        } else if let Some(kind) = text.strip_prefix("new ").and_then(Kind::named) {
            Quantity::New(kind)
        } else if let Some((dimension, default)) = text.split_once(" = ") {
            Quantity::OfOr(dimension, default)
        } else if let Some((dimension, kind)) = text.split_once(" or ")
            && let Some(kind) = Kind::named(kind)
        {
            Quantity::OrName(dimension, kind)
        } else {
            Quantity::Of(text)
        }
    }

    /// The dimension, if it has a known one.
    pub fn dimension(self) -> Option<&'static str> {
        match self {
            Quantity::Of(dimension)
            | Quantity::OfOr(dimension, _)
            | Quantity::OrName(dimension, _) => Some(dimension),
            _ => None,
        }
    }

    /// The kind of the thing whose name it is or may be.
    pub fn kind(self) -> Option<Kind> {
        match self {
            Quantity::Name(kind) | Quantity::New(kind) | Quantity::OrName(_, kind) => Some(kind),
            _ => None,
        }
    }
}

/// A field of a data line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// What it is called in the reference.
    pub name: &'static str,
    /// What it holds.
    pub holds: Quantity,
}

impl Field {
    /// The field that the table writes as `node` or `x [length]`.
    pub(super) fn written(text: &'static str) -> Field {
        let measured = text.strip_suffix(']');
        let (name, holds) = match measured {
            Some(text) => {
                let (name, quantity) = text.split_once(" [").unwrap_or((text, "?"));
                (name, Quantity::written(quantity))
            }
            None => {
                let kind = Kind::at_end_of(text);
                (text, kind.map_or(Quantity::Plain, Quantity::Name))
            }
        };
        Field { name, holds }
    }
}

/// The fields of a kind of data line; the conditions say which lines are of this kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DataLineForm {
    /// Parameter and value of the keyword line that these lines belong to; an empty value stands
    /// for a parameter without value.
    pub parameter: Option<(&'static str, &'static str)>,
    /// Number of a field, from 0, and the words that it says on these lines.
    pub word: Option<(usize, &'static [&'static str])>,
    /// Whether it is the first data line only.
    pub first: bool,
    /// The fields between commas.
    pub fields: &'static [Field],
    /// Number of the last fields that repeat along the line.
    pub repeating: usize,
}

impl DataLineForm {
    /// The fields.
    pub fn fields(&self) -> impl Iterator<Item = Field> {
        self.fields.iter().copied()
    }

    /// Field `index` of a line, from 0.
    pub fn field(&self, index: usize) -> Option<Field> {
        let once = self.fields.len().saturating_sub(self.repeating);
        let index = match self.repeating {
            0 => index,
            _ if index < once => index,
            repeating => once + (index - once) % repeating,
        };
        self.fields.get(index).copied()
    }

    /// Whether a line is of this kind: the words of its fields, whether it is the first of its card, and the word that a
    /// parameter of the card has as its value, empty where it has none and the parameter is given.
    pub fn fits<'w>(
        &self,
        fields: &[&str],
        is_first: bool,
        given: impl Fn(&str) -> Option<&'w str>,
    ) -> bool {
        let has_parameter = match self.parameter {
            Some((name, "")) => given(name).is_some(),
            Some((name, word)) => given(name) == Some(word),
            None => true,
        };
        let says = |(index, words): (usize, &[&str])| {
            let typed = fold(fields.get(index).unwrap_or(&""));
            words.iter().any(|word| fold(word) == typed)
        };
        has_parameter && (is_first || !self.first) && self.word.is_none_or(says)
    }
}
