//! Fields and parameter values with their places, read as numbers, names or words.
//!
//! Values that are not numbers or names are reported; values that Abaqus or CalculiX read differently are also
//! reported. Case and blanks of words do not matter, a word may be shortened to a unique beginning of at least four
//! letters, and a likely typing error gets a suggestion.

use super::number::{self, LONGEST_NUMBER, NotANumber};
use crate::diagnostics::{Code, Diagnostic, Diagnostics, Span, closest};

/// Number of characters of the longest name that other codes read.
const LONGEST_NAME: usize = 80;

/// A field or a parameter's value: its text and its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Text<'a> {
    /// The text as typed, without blanks at both ends.
    pub text: &'a str,
    /// Place of the text.
    pub span: Span,
}

impl<'a> Text<'a> {
    /// Whether the text is empty.
    pub fn is_empty(&self) -> bool {
        self.text.is_empty()
    }

    /// The value as an integer; a text that is no integer is reported.
    pub fn integer(&self, d: &mut Diagnostics) -> Option<i64> {
        let parsed = number::integer(self.text);
        parsed
            .map_err(|why| d.push(self.not_a("an integer", why)))
            .ok()
    }

    /// The value as an integer, or `None` without a report.
    pub fn as_integer(&self) -> Option<i64> {
        number::integer(self.text).ok()
    }

    /// The value as a real number, or `None` without a report.
    pub fn as_real(&self) -> Option<f64> {
        number::real(self.text).ok().map(|real| real.value)
    }

    /// The value as a real number; a text that is no number is reported.
    pub fn real(&self, d: &mut Diagnostics) -> Option<f64> {
        match number::real(self.text) {
            Err(why) => {
                d.push(self.not_a("a number", why));
                None
            }
            Ok(real) => {
                self.remark_on_form(real.letterless, d);
                Some(real.value)
            }
        }
    }

    /// The value as a real number for which `is_fine` is true. A number that breaks the `rule`, or a text that is no
    /// number, is reported.
    pub fn real_that(
        &self,
        is_fine: impl Fn(f64) -> bool,
        rule: &str,
        code: Code,
        d: &mut Diagnostics,
    ) -> Option<f64> {
        let value = self.real(d)?;
        if !is_fine(value) {
            d.error(code, self.span, format!("{rule}, found {}", self.text));
        }
        is_fine(value).then_some(value)
    }

    /// Warns about forms of numbers that other codes read differently; each form is named once in a deck.
    fn remark_on_form(&self, letterless: bool, d: &mut Diagnostics) {
        if letterless {
            d.warning_once(
                Code::FortranNumber,
                self.span,
                "an exponent without its letter E",
            )
            .label("read as a power of ten");
        }
        if self.text.len() > LONGEST_NUMBER {
            d.note_once(
                Code::LongNumber,
                self.span,
                "a number of more than 20 characters",
            )
            .help("all of it is read here; CalculiX reads the first 20 characters only");
        }
    }

    fn not_a(&self, wanted: &str, why: NotANumber) -> Diagnostic {
        let message = match self.is_empty() {
            true => format!("expected {wanted}, found nothing"),
            false => format!("expected {wanted}, found `{}`", self.text),
        };
        if let Some(gap) = self.gap_between_numbers() {
            let diagnostic = Diagnostic::error(Code::BadNumber, gap, message);
            return diagnostic.label("is a comma missing here?");
        }
        let diagnostic = Diagnostic::error(Code::BadNumber, self.span, message);
        match why {
            NotANumber::Unexpected(c) if c.is_whitespace() => {
                diagnostic.label("a blank inside a number")
            }
            NotANumber::Unexpected(c) => diagnostic.label(format!("`{c}` does not belong here")),
            NotANumber::Incomplete => diagnostic,
            NotANumber::BareExponent => diagnostic
                .label("an exponent without its number")
                .help("a comma ends a field: a number has a decimal point, not a decimal comma"),
            NotANumber::TooLarge => diagnostic.label("too large"),
        }
    }

    /// Place of the first blanks, if the field is a list of numbers with blanks between the numbers.
    fn gap_between_numbers(&self) -> Option<Span> {
        let start = self.text.find(char::is_whitespace)?;
        let (before, after) = self.text.split_at(start);
        let blanks = after.chars().take_while(|c| c.is_whitespace()).count();
        let mut parts = self.text.split_whitespace();
        let numbers = parts.all(|part| number::real(part).is_ok());
        numbers.then(|| Span {
            column: self.span.column + before.chars().count() as u32,
            length: blanks as u32,
            ..self.span
        })
    }

    /// Whether the text consists of digits only, without point, sign or exponent.
    pub(crate) fn is_digits(&self) -> bool {
        !self.is_empty() && self.text.bytes().all(|byte| byte.is_ascii_digit())
    }

    /// The value as a name; an invalid name is reported.
    pub fn name(&self, d: &mut Diagnostics) -> Option<Name> {
        if let Some((prefix, last)) = self.parts() {
            let (prefix, last) = (prefix.name(d)?, last.name(d)?);
            return Some(prefix.joined(&last));
        }
        let fault = match self.quoted_content() {
            Some(content) if fits(content) => return Some(Name::quoted(content)),
            Some(_) => Some("a name has 1 to 80 characters".to_string()),
            // An open quotation mark is reported already.
            None if self.text.matches('"').count() % 2 == 1 => return None,
            None => self.fault_of_plain_name(),
        };
        match fault {
            None => Some(Name::plain(self.text)),
            Some(fault) => {
                let message = format!("`{}` cannot be a name", self.text);
                d.error(Code::BadName, self.span, message).label(fault);
                None
            }
        }
    }

    /// Splits a parameter, `NAME` or `NAME=value`, into its name and its value.
    pub fn assignment(&self) -> (&'a str, Option<Text<'a>>) {
        let Some((name, value)) = self.text.split_once('=') else {
            return (self.text, None);
        };
        let characters = |text: &str| text.chars().count() as u32;
        let value = value.trim_start();
        let before = characters(self.text) - characters(value);
        let span = Span {
            column: self.span.column + before,
            length: characters(value).max(1),
            ..self.span
        };
        (name.trim_end(), Some(Text { text: value, span }))
    }

    /// Key by which the text is compared as a name, whether or not the name is valid.
    pub fn name_key(&self) -> String {
        if let Some((prefix, last)) = self.parts() {
            return format!("{}.{}", prefix.name_key(), last.name_key());
        }
        let quoted = self.quoted_content();
        quoted.map_or_else(|| fold(self.text), str::to_string)
    }

    /// The names before and behind a dot, if one of the two names is between quotation marks: `"Part 1".Top`.
    fn parts(&self) -> Option<(Text<'a>, Text<'a>)> {
        let mut is_quoted = false;
        let is_outside = |(at, c): (usize, char)| {
            is_quoted ^= c == '"';
            (c == '.' && !is_quoted).then_some(at)
        };
        let has_quotes = self.text.contains('"');
        let dot = has_quotes.then(|| self.text.char_indices().find_map(is_outside))??;
        let part = |text: &'a str| Text {
            text,
            span: self.span,
        };
        Some((part(&self.text[..dot]), part(&self.text[dot + 1..])))
    }

    fn quoted_content(&self) -> Option<&'a str> {
        let content = self.text.strip_prefix('"')?.strip_suffix('"')?;
        (!content.contains('"')).then_some(content)
    }

    fn fault_of_plain_name(&self) -> Option<String> {
        let allowed = |c: &char| !("\"'=*<>".contains(*c) || c.is_control() && *c != '\t');
        if !fits(self.text) {
            Some("a name has 1 to 80 characters".to_string())
        } else if self.as_integer().is_some() {
            Some("a number, not a name".to_string())
        } else {
            let stranger = self.text.chars().find(|c| !allowed(c))?;
            Some(format!(
                "`{stranger}` needs quotation marks around the name"
            ))
        }
    }
}

fn fits(name: &str) -> bool {
    (1..=LONGEST_NAME).contains(&name.chars().count())
}

/// A name in a deck: it is shown as typed, and compared without case unless it was quoted.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Name {
    /// The name as typed, without quotation marks.
    pub typed: String,
    /// Key by which names are compared: upper case without blanks, or as typed if quoted.
    pub key: String,
}

impl Name {
    /// A name without quotation marks.
    pub fn plain(typed: &str) -> Name {
        Name {
            typed: typed.to_string(),
            key: fold(typed),
        }
    }

    /// Full name of an object in the instance with this name: `Instance.name`.
    pub fn joined(&self, own: &Name) -> Name {
        Name {
            typed: format!("{}.{}", self.typed, own.typed),
            key: format!("{}.{}", self.key, own.key),
        }
    }

    /// A name between quotation marks.
    pub fn quoted(typed: &str) -> Name {
        Name {
            typed: typed.to_string(),
            key: typed.to_string(),
        }
    }
}

impl std::fmt::Display for Name {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.typed)
    }
}

/// Shortest abbreviation that is understood.
const SHORTEST: usize = 4;

/// Match of a typed word with a list of known words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Match {
    /// The word is this known word.
    Exact(&'static str),
    /// The word is the beginning of this known word. The typed word may also begin longer known words that begin with
    /// this known word: FREQ is FREQUENCY although FREQUENCYF exists.
    Abbreviation(&'static str),
    /// The word is not known; this known word is probably meant.
    Unknown(Option<&'static str>),
}

/// The text in upper case without blanks, as words and unquoted names are compared.
pub(crate) fn fold(word: &str) -> String {
    folded(word).collect()
}

fn folded(word: &str) -> impl Iterator<Item = char> {
    let visible = word.chars().filter(|c| !c.is_whitespace());
    visible.flat_map(char::to_uppercase)
}

/// Looks up a word among known words; blanks and case do not matter.
pub(crate) fn find(word: &str, known: impl Iterator<Item = &'static str> + Clone) -> Match {
    match find_known(word, known.clone()) {
        Match::Unknown(_) => Match::Unknown(suggestion(&fold(word), known)),
        found => found,
    }
}

/// Looks up a word as [`find`] does, but without a suggestion for an unknown word.
pub(crate) fn find_known(word: &str, known: impl Iterator<Item = &'static str> + Clone) -> Match {
    let short = fold(word);
    if let Some(exact) = known.clone().find(|k| folded(k).eq(short.chars())) {
        return Match::Exact(exact);
    }
    let size = short.chars().count();
    let begins = |k: &&str| folded(k).take(size).eq(short.chars());
    let longer = known.filter(begins);
    let first = longer.clone().min_by_key(|k| folded(k).count());
    let all_begin_with = |first: &str| {
        let size = folded(first).count();
        longer
            .clone()
            .all(|k| folded(k).take(size).eq(folded(first)))
    };
    match first {
        Some(first) if size >= SHORTEST && all_begin_with(first) => Match::Abbreviation(first),
        _ => Match::Unknown(None),
    }
}

/// The known word with the smallest edit distance from a word, if this distance is small.
fn suggestion(
    short: &str,
    known: impl Iterator<Item = &'static str> + Clone,
) -> Option<&'static str> {
    let pairs: Vec<(String, &'static str)> = known.map(|k| (fold(k), k)).collect();
    let best = closest(short, pairs.iter().map(|(f, _)| f.as_str()))?;
    pairs.iter().find(|(f, _)| f == best).map(|&(_, k)| k)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_match_without_blanks_and_case() {
        let known = ["NODE", "NODE FILE", "AMPLITUDE", "END STEP"].into_iter();
        assert_eq!(find("endstep", known.clone()), Match::Exact("END STEP"));
        assert_eq!(
            find("AMPL", known.clone()),
            Match::Abbreviation("AMPLITUDE")
        );
        assert_eq!(find("AMP", known.clone()), Match::Unknown(None));
        assert_eq!(find("AMPLITUDEXYZ", known.clone()), Match::Unknown(None));
        assert_eq!(find("AMPLTUDE", known), Match::Unknown(Some("AMPLITUDE")));
    }
}
