//! Types of the keyword table: keywords with place, data lines, sentence and example; parameters and values; fields of
//! data lines, and dimensions of numbers.

use crate::deck::text::{Match, find_known, fold};

/// A level of a deck. In a flat deck, without parts and assembly, the cards of the levels part, instance and assembly
/// stand at the level of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// A part.
    Part,
    /// An instance.
    Instance,
    /// The assembly outside its instances.
    Assembly,
    /// The model: outside parts, the assembly and steps.
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

    /// The union of two sets of levels.
    pub fn and(self, other: Levels) -> Levels {
        Levels(self.0 | other.0)
    }

    /// Whether a level is among these levels.
    pub fn has(self, level: Level) -> bool {
        self.0 & Levels::of(&[level]).0 != 0
    }

    /// Whether cards of some levels belong to the mesh or join its parts: such cards define objects to which steps
    /// refer.
    pub fn are_of_mesh(self) -> bool {
        self.has(Level::Part) || self.has(Level::Assembly)
    }

    /// Whether cards may stand outside steps in a deck without parts.
    pub fn are_of_model(self) -> bool {
        self.are_of_mesh() || self.has(Level::Model)
    }

    /// Whether a card that stands in a step belongs to the model, with effect from the start.
    pub fn hold_from_the_start(self) -> bool {
        self.are_of_mesh() || !self.has(Level::LaterStep)
    }
}

/// Where a keyword may stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// The keyword stands by itself, at the given levels.
    At(Levels),
    /// The keyword stands in the block of the named keyword.
    Block(&'static str),
    /// The keyword stands in the block of the first named keyword (at the model level), or right after the second named
    /// keyword (in a step).
    BlockOrAfter(&'static str, &'static str),
    /// The keyword stands in the block of the named keyword, or by itself at the level of the model.
    BlockOrModel(&'static str),
    /// The keyword begins or ends a part, an instance or the assembly.
    Structure,
}

/// Data lines that a keyword may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Data {
    /// The keyword has no data lines.
    None,
    /// Any number of rows is allowed; a row has the first of the forms that fits.
    Rows(&'static [DataLineForm]),
    /// The keyword needs at least one row; a row has the first of the forms that fits.
    Required(&'static [DataLineForm]),
    /// Free text.
    Text,
    /// The data lines are words that the program does not read.
    Words,
    /// The data lines may hold anything; the program does not read these lines.
    Skipped,
}

impl Data {
    /// Forms of the data lines.
    pub fn forms(self) -> &'static [DataLineForm] {
        match self {
            Data::Rows(forms) | Data::Required(forms) => forms,
            Data::None | Data::Text | Data::Words | Data::Skipped => &[],
        }
    }
}

/// A kind of object with a name.
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
    /// Circles on which faces of a surface lie.
    SurfaceSmoothing,
    /// A rule by which nodes of general contact are moved at the start.
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

    /// Name of the kind in the table and in messages.
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

    /// The kind with a given name.
    fn named(name: &str) -> Option<Kind> {
        Kind::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// The kind of object that a text names, alone or behind ` or `.
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
    /// Treatment of the keyword by the program.
    pub status: Status,
    /// Where the keyword may stand.
    pub scope: Scope,
    /// The levels at which the keyword may stand; a keyword of a block has the levels of the block.
    pub levels: Levels,
    /// Data lines of the keyword.
    pub data: Data,
    /// Parameters of the keyword.
    pub parameters: &'static [Parameter],
    /// Sentences that say what the keyword does.
    pub text: &'static str,
    /// Lines of a deck that use the keyword, or that replace a keyword that is not read; empty if there are no such
    /// lines.
    pub example: &'static str,
    /// Whether the keyword asks for output: unknown parts of such a card are left out, because these parts do not
    /// change the results.
    pub is_output: bool,
    /// Task of the keyword: the title of its family.
    pub task: &'static str,
}

impl Keyword {
    /// Names of all parameters of the keyword, second names included.
    pub fn parameter_names(&self) -> impl Iterator<Item = &'static str> + Clone + use<> {
        let both = self.parameters.iter().flat_map(|p| [p.name, p.other]);
        both.filter(|name| !name.is_empty())
    }

    /// The parameter with a given name; blanks and case do not matter.
    pub fn parameter(&self, name: &str) -> Option<&'static Parameter> {
        let folded = fold(name);
        let is_meant = |p: &&Parameter| [p.name, p.other].map(fold).contains(&folded);
        self.parameters.iter().find(is_meant)
    }

    /// The parameter that a typed word means: the word is its name or an abbreviation of it.
    pub fn parameter_read_as(&self, typed: &str) -> Option<&'static Parameter> {
        match find_known(typed, self.parameter_names()) {
            Match::Exact(name) | Match::Abbreviation(name) => {
                let is_meant = |p: &&Parameter| [p.name, p.other].contains(&name);
                self.parameters.iter().find(is_meant)
            }
            Match::Unknown(_) => None,
        }
    }

    /// Kind of the object that a card of the keyword defines or extends, and the parameter that names the object.
    pub fn definition(&self) -> Option<(&'static Parameter, Kind)> {
        let mut parameters = self.parameters.iter();
        parameters.find_map(|parameter| match parameter.holds {
            Quantity::New(kind) => Some((parameter, kind)),
            _ => None,
        })
    }
}

/// Treatment of a keyword, a parameter or a value by the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// The program reads and obeys the keyword, parameter or value.
    Read,
    /// The program leaves the keyword, parameter or value out silently, because this does not affect the results.
    Ignored,
    /// The program leaves the keyword, parameter or value out, or replaces it, with a warning.
    Warned,
    /// The program stops with an error, because leaving the keyword, parameter or value out would change the results.
    Refused,
}

/// Values of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Takes {
    /// The parameter has no value.
    Nothing,
    /// The value is a name, a number or a path.
    Value,
    /// The value may be left out.
    Optional,
    /// The value is one of the listed words.
    Choice(&'static [Value]),
    /// The value is one of the listed words, or the value is left out.
    OptionalChoice(&'static [Value]),
}

/// A word that a parameter can take as its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Value {
    /// The word, with blanks.
    pub name: &'static str,
    /// Treatment of the word by the program.
    pub status: Status,
    /// One sentence about the word; empty if the word explains itself.
    pub text: &'static str,
}

impl Value {
    /// Whether the word is the default of its parameter, or another word for the default.
    pub fn is_default(&self) -> bool {
        self.text.ends_with("(default)") || self.text.starts_with("the same")
    }
}

/// A parameter of a keyword.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Parameter {
    /// The word before the equals sign, with blanks.
    pub name: &'static str,
    /// A second name of the parameter; empty if the parameter has no second name.
    pub other: &'static str,
    /// Values of the parameter.
    pub takes: Takes,
    /// Quantity that a value of the parameter holds.
    pub holds: Quantity,
    /// Treatment of the parameter by the program.
    pub status: Status,
    /// One sentence.
    pub text: &'static str,
}

impl Parameter {
    /// The words that are allowed as the value of the parameter; empty if any value is allowed.
    pub fn values(&self) -> &'static [Value] {
        match self.takes {
            Takes::Choice(values) | Takes::OptionalChoice(values) => values,
            Takes::Nothing | Takes::Value | Takes::Optional => &[],
        }
    }

    /// The allowed value that a typed word means.
    pub fn value_read_as(&self, typed: &str) -> Option<&'static str> {
        match find_known(typed, self.values().iter().map(|value| value.name)) {
            Match::Exact(name) | Match::Abbreviation(name) => Some(name),
            Match::Unknown(_) => None,
        }
    }
}

/// Content of the value of a field or of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// A word, a label, or a number that is the same in all units.
    Plain,
    /// A number of the given dimension, written as in the result file: `mass/length^3`.
    Of(&'static str),
    /// A number of the given dimension, and its default.
    OfOr(&'static str, &'static str),
    /// A number of the given dimension, or the name of an object of the given kind.
    OrName(&'static str, Kind),
    /// The name of an object of the given kind; a word or a label may stand in its place.
    Name(Kind),
    /// The name of an object of the given kind that the card defines or extends.
    New(Kind),
    /// The path of a file; the card reads the file.
    File,
    /// A number whose dimension is not known: other codes disagree on the dimension.
    Unknown,
}

impl Quantity {
    /// Reads a quantity as it stands in the table: `length`, `length = 1` (with a default), `length or node set`, `node
    /// set`, `new node set`, `file`, or `?`.
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

    /// Dimension of the quantity, if it is a number of known dimension.
    pub fn dimension(self) -> Option<&'static str> {
        match self {
            Quantity::Of(dimension)
            | Quantity::OfOr(dimension, _)
            | Quantity::OrName(dimension, _) => Some(dimension),
            _ => None,
        }
    }

    /// Kind of the object whose name the quantity is or may be.
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
    /// Name of the field in the reference.
    pub name: &'static str,
    /// Quantity that the field holds.
    pub holds: Quantity,
}

impl Field {
    /// Reads a field as it stands in the table: `node` or `x [length]`.
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

/// The fields of one form of data line, and the conditions under which a line has this form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DataLineForm {
    /// Parameter and value of the keyword line for which lines have the form; an empty value stands for a parameter
    /// without value.
    pub parameter: Option<(&'static str, &'static str)>,
    /// Number of a field, from 0, and the words that may stand in this field in lines of the form.
    pub word: Option<(usize, &'static [&'static str])>,
    /// Whether only the first data line of a card may have the form.
    pub first: bool,
    /// The fields between commas.
    pub fields: &'static [Field],
    /// Number of fields at the end of the form that repeat along the line.
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

    /// Whether a line with the given `fields` has the form. `is_first` says whether the line is the first of its card;
    /// `given` is the value of a parameter of the card: empty for a parameter without value, `None` for an absent
    /// parameter.
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
