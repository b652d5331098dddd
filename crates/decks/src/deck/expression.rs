//! Expressions of `*PARAMETER`: numbers, names, functions and operators with Python's precedence. The quotient of two
//! whole numbers is real.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = factor { ("*" | "/") factor }
//! factor  = ("+" | "-") factor | power
//! power   = atom [ "**" factor ]
//! atom    = number | name | name "(" sum { "," sum } ")" | "(" sum ")" | 'text'
//! ```

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::ops::Range;

use nom::branch::alt;
use nom::bytes::complete::{tag, take_while, take_while1};
use nom::character::complete::{char, multispace0};
use nom::combinator::{cut, opt};
use nom::multi::{many0, separated_list0};
use nom::sequence::{delimited, pair, preceded, terminated};
use nom::{IResult, Parser};

/// Value of a parameter. The result of +, -, * and ** of whole numbers is whole; so is the result of some functions.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum ParameterValue {
    Whole(i64),
    Real(f64),
    Text(String),
}

impl ParameterValue {
    /// The value as text of a deck: a real number has all its digits, and a decimal point or an exponent.
    pub fn written(&self) -> String {
        match self {
            ParameterValue::Whole(value) => value.to_string(),
            ParameterValue::Real(value) => format!("{value:?}"),
            ParameterValue::Text(text) => text.clone(),
        }
    }
}

/// Fault of an expression, for a message.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fault {
    /// Bytes of the expression that are at fault.
    pub at: Range<usize>,
    pub message: String,
    /// The name without a value, if such a name is the fault.
    pub unknown: Option<String>,
}

/// Deepest nesting of parentheses, powers and signs in an expression.
const DEEPEST: usize = 50;
const MOST_OPERATORS: usize = 1000;

/// Length of the longest text of an expression: the longest line that other codes read.
const LONGEST_TEXT: usize = 256;

/// The value of an expression, and the names that it uses.
pub(super) fn evaluate(
    text: &str,
    values: &BTreeMap<String, ParameterValue>,
) -> Result<(ParameterValue, Vec<String>), Fault> {
    let operators = text.bytes().filter(|byte| b"(-+*/".contains(byte)).count();
    if operators > MOST_OPERATORS || nesting(text) > DEEPEST {
        return Err(fault(0..text.len(), "the expression is too long"));
    }
    let parsed = terminated(sum, multispace0).parse(text);
    let (rest, tree) = parsed.map_err(|error| match error {
        nom::Err::Error(Expected { left, what }) | nom::Err::Failure(Expected { left, what }) => {
            let at = text.len() - left;
            let found = text.get(at..).and_then(|rest| rest.chars().next());
            let end = at + found.map_or(0, char_len);
            let found = found.map_or("its end".to_owned(), |c| format!("`{c}`"));
            fault(at..end, &format!("expected {what}, found {found}"))
        }
        nom::Err::Incomplete(_) => fault(0..text.len(), "expected an expression"),
    })?;
    if let Some(c) = rest.chars().next() {
        let at = text.len() - rest.len();
        let message = format!("expected an operator or the end, found `{c}`");
        return Err(fault(at..at + char_len(c), &message));
    }
    let mut used = Vec::new();
    let scope = Evaluator {
        length: text.len(),
        values,
    };
    let value = scope.value(&tree, &mut used)?;
    if matches!(&value, ParameterValue::Text(text) if text.len() > LONGEST_TEXT) {
        let message = format!("a text of more than {LONGEST_TEXT} bytes");
        return Err(fault(0..text.len(), &message));
    }
    Ok((value, used))
}

fn char_len(c: char) -> usize {
    c.len_utf8()
}

fn fault(at: Range<usize>, message: &str) -> Fault {
    Fault {
        at,
        message: message.to_owned(),
        unknown: None,
    }
}

/// Deepest nesting: the number of parentheses open at a time plus the number of signs in a row, or the number of powers
/// if this number is larger.
fn nesting(text: &str) -> usize {
    let (mut open, mut row, mut most) = (0_usize, 0_usize, 0_usize);
    for byte in text.bytes().filter(|byte| !byte.is_ascii_whitespace()) {
        match byte {
            b'(' => open += 1,
            b')' => open = open.saturating_sub(1),
            _ => {}
        }
        row = if b"+-".contains(&byte) { row + 1 } else { 0 };
        most = most.max(open + row);
    }
    most.max(text.matches("**").count())
}

/// Kind of word that was expected at a place; the place is given by the number of bytes behind it.
#[derive(Debug)]
struct Expected {
    left: usize,
    what: &'static str,
}

impl nom::error::ParseError<&str> for Expected {
    fn from_error_kind(input: &str, _: nom::error::ErrorKind) -> Self {
        Expected {
            left: input.len(),
            what: "a number, a name or `(`",
        }
    }

    fn append(_: &str, _: nom::error::ErrorKind, other: Self) -> Self {
        other
    }

    fn or(self, other: Self) -> Self {
        // the alternative that came further
        if self.left < other.left { self } else { other }
    }
}

/// A node of an expression.
#[derive(Debug)]
enum Tree<'a> {
    Number(WordPlace<'a>),
    Text(&'a str),
    Name(WordPlace<'a>),
    Call(WordPlace<'a>, Vec<Tree<'a>>),
    Minus(WordPlace<'a>, Box<Tree<'a>>),
    Binary(WordPlace<'a>, Box<[Tree<'a>; 2]>),
}

/// A word of an expression, with the number of bytes from its beginning to the end of the text.
type WordPlace<'a> = (usize, &'a str);

type Parsed<'a, T> = IResult<&'a str, T, Expected>;

/// A word with its place; blanks in front of the word are skipped.
fn placed<'a>(
    mut word: impl Parser<&'a str, Output = &'a str, Error = Expected>,
) -> impl FnMut(&'a str) -> Parsed<'a, WordPlace<'a>> {
    move |input| {
        let input = input.trim_start();
        let (rest, word) = word.parse(input)?;
        Ok((rest, (input.len(), word)))
    }
}

/// Operands with operators between them, grouped from left to right.
fn chain<'a>(
    operator: fn(&'a str) -> Parsed<'a, WordPlace<'a>>,
    operand: fn(&'a str) -> Parsed<'a, Tree<'a>>,
    input: &'a str,
) -> Parsed<'a, Tree<'a>> {
    let (rest, first) = operand(input)?;
    let (rest, others) = many0(pair(operator, cut(operand))).parse(rest)?;
    let join = |left, (place, right)| Tree::Binary(place, Box::new([left, right]));
    Ok((rest, others.into_iter().fold(first, join)))
}

fn sum(input: &str) -> Parsed<'_, Tree<'_>> {
    fn operator(input: &str) -> Parsed<'_, WordPlace<'_>> {
        placed(alt((tag("+"), tag("-")))).parse(input)
    }
    chain(operator, product, input)
}

fn product(input: &str) -> Parsed<'_, Tree<'_>> {
    fn operator(input: &str) -> Parsed<'_, WordPlace<'_>> {
        placed(alt((tag("*"), tag("/")))).parse(input)
    }
    chain(operator, factor, input)
}

fn factor(input: &str) -> Parsed<'_, Tree<'_>> {
    match placed(alt((tag("-"), tag("+")))).parse(input) {
        Ok((rest, place)) => {
            let (rest, operand) = cut(factor).parse(rest)?;
            match place.1 {
                "-" => Ok((rest, Tree::Minus(place, Box::new(operand)))),
                _ => Ok((rest, operand)),
            }
        }
        Err(_) => power(input),
    }
}

fn power(input: &str) -> Parsed<'_, Tree<'_>> {
    let (rest, base) = atom(input)?;
    let (rest, exponent) = opt(pair(placed(tag("**")), cut(factor))).parse(rest)?;
    Ok(match exponent {
        Some((place, exponent)) => (rest, Tree::Binary(place, Box::new([base, exponent]))),
        None => (rest, base),
    })
}

fn atom(input: &str) -> Parsed<'_, Tree<'_>> {
    let input = input.trim_start();
    match input.chars().next() {
        Some('(') => delimited(char('('), cut(sum), cut(closing)).parse(input),
        Some(quote @ ('\'' | '"')) => {
            let inside = take_while(move |c| c != quote);
            let text = delimited(char(quote), inside, char(quote)).parse(input);
            text.map(|(rest, text)| (rest, Tree::Text(text)))
        }
        Some(c) if c.is_ascii_alphabetic() || c == '_' => {
            let word = take_while1(|c: char| c.is_ascii_alphanumeric() || c == '_');
            let (rest, name) = placed(word).parse(input)?;
            let arguments = |input| {
                let all = separated_list0(preceded(multispace0, char(',')), sum);
                delimited(char('('), all, cut(closing)).parse(input)
            };
            match rest.trim_start().starts_with('(') {
                true => {
                    arguments(rest.trim_start()).map(|(rest, all)| (rest, Tree::Call(name, all)))
                }
                false => Ok((rest, Tree::Name(name))),
            }
        }
        _ => number(input),
    }
}

fn closing(input: &str) -> Parsed<'_, char> {
    let input = input.trim_start();
    let closed: Parsed<char> = char(')').parse(input);
    closed.map_err(|_| {
        nom::Err::Error(Expected {
            left: input.len(),
            what: "an operator or `)`",
        })
    })
}

/// A number: `digits[.digits][e[+-]digits]`, or `.digits`.
fn number(input: &str) -> Parsed<'_, Tree<'_>> {
    let input = input.trim_start();
    let bytes = input.as_bytes();
    let is = |at: usize, set: &[u8]| bytes.get(at).is_some_and(|byte| set.contains(byte));
    let after_digits = |from: usize| {
        let rest = bytes.iter().skip(from);
        from + rest.take_while(|byte| byte.is_ascii_digit()).count()
    };
    let mut end = after_digits(0);
    if is(end, b".") {
        let fraction = after_digits(end + 1);
        if fraction > 1 {
            end = fraction;
        }
    }
    if end == 0 {
        let what = "a number, a name or `(`";
        let left = input.len();
        return Err(nom::Err::Error(Expected { left, what }));
    }
    if is(end, b"eE") {
        let first = end + 1 + usize::from(is(end + 1, b"+-"));
        let exponent = after_digits(first);
        if exponent > first {
            end = exponent;
        }
    }
    let (number, rest) = input.split_at(end);
    Ok((rest, Tree::Number((input.len(), number))))
}

/// Evaluates the nodes of an expression.
struct Evaluator<'v> {
    /// Number of bytes of the expression.
    length: usize,
    values: &'v BTreeMap<String, ParameterValue>,
}

impl Evaluator<'_> {
    fn fault(&self, (left, word): WordPlace, message: &str) -> Fault {
        let at = self.length - left;
        fault(at..at + word.len(), message)
    }

    fn value(&self, tree: &Tree, used: &mut Vec<String>) -> Result<ParameterValue, Fault> {
        match tree {
            Tree::Text(text) => Ok(ParameterValue::Text((*text).to_owned())),
            Tree::Number(place) => self.number(*place),
            Tree::Name((_, "pi")) if !self.values.contains_key("pi") => {
                Ok(ParameterValue::Real(PI))
            }
            Tree::Name(place) => {
                let value = self.values.get(place.1).cloned();
                used.push(place.1.to_owned());
                value.ok_or_else(|| Fault {
                    unknown: Some(place.1.to_owned()),
                    ..self.fault(
                        *place,
                        &format!("the parameter {} is not defined before", place.1),
                    )
                })
            }
            Tree::Minus(place, operand) => match self.value(operand, used)? {
                ParameterValue::Whole(value) => Ok(ParameterValue::Whole(-value)),
                value => Ok(ParameterValue::Real(-self.real(&value, *place)?)),
            },
            Tree::Binary(place, operands) => {
                let [a, b] = operands.each_ref().map(|operand| self.value(operand, used));
                self.binary(*place, &a?, &b?)
            }
            Tree::Call(place, arguments) => {
                let values: Result<Vec<_>, _> = arguments
                    .iter()
                    .map(|tree| self.value(tree, used))
                    .collect();
                self.call(*place, &values?)
            }
        }
    }

    fn number(&self, place: WordPlace) -> Result<ParameterValue, Fault> {
        let is_whole = place.1.bytes().all(|byte| byte.is_ascii_digit());
        match (is_whole, place.1.parse()) {
            (true, Ok(value)) => Ok(ParameterValue::Whole(value)),
            _ => self.finite(place, place.1.parse().unwrap_or(f64::NAN)),
        }
    }

    fn real(&self, value: &ParameterValue, place: WordPlace) -> Result<f64, Fault> {
        match value {
            ParameterValue::Whole(value) => Ok(*value as f64),
            ParameterValue::Real(value) => Ok(*value),
            ParameterValue::Text(text) => {
                Err(self.fault(place, &format!("the text '{text}' is no number")))
            }
        }
    }

    fn finite(&self, place: WordPlace, value: f64) -> Result<ParameterValue, Fault> {
        match value.is_finite() {
            true => Ok(ParameterValue::Real(value)),
            false => Err(self.fault(place, "this has no finite value")),
        }
    }

    fn binary(
        &self,
        place: WordPlace,
        a: &ParameterValue,
        b: &ParameterValue,
    ) -> Result<ParameterValue, Fault> {
        if let (ParameterValue::Whole(a), ParameterValue::Whole(b)) = (a, b) {
            let whole = match place.1 {
                "+" => a.checked_add(*b),
                "-" => a.checked_sub(*b),
                "*" => a.checked_mul(*b),
                "**" => u32::try_from(*b).ok().and_then(|b| a.checked_pow(b)),
                _ => None,
            };
            if let Some(value) = whole {
                return Ok(ParameterValue::Whole(value));
            }
        }
        let [a, b] = [self.real(a, place)?, self.real(b, place)?];
        let value = match place.1 {
            "+" => a + b,
            "-" => a - b,
            "*" => a * b,
            "/" if b == 0.0 => return Err(self.fault(place, "a division by zero")),
            "/" => a / b,
            _ => a.powf(b),
        };
        self.finite(place, value)
    }

    fn call(
        &self,
        place: WordPlace,
        arguments: &[ParameterValue],
    ) -> Result<ParameterValue, Fault> {
        let keeps_whole = matches!(place.1, "abs" | "min" | "max");
        let wholes = || {
            arguments.iter().map(|value| match value {
                ParameterValue::Whole(value) => Some(*value),
                _ => None,
            })
        };
        if keeps_whole && !arguments.is_empty() && wholes().all(|value| value.is_some()) {
            let all = wholes().flatten();
            let value = match place.1 {
                "abs" if arguments.len() == 1 => all.map(i64::abs).next(),
                "min" => all.min(),
                "max" => all.max(),
                _ => None,
            };
            if let Some(value) = value {
                return Ok(ParameterValue::Whole(value));
            }
        }
        let x: Result<Vec<f64>, Fault> = arguments
            .iter()
            .map(|value| self.real(value, place))
            .collect();
        let value = match (place.1, &x?[..]) {
            ("sin", [x]) => x.sin(),
            ("cos", [x]) => x.cos(),
            ("tan", [x]) => x.tan(),
            ("asin", [x]) => x.asin(),
            ("acos", [x]) => x.acos(),
            ("atan", [x]) => x.atan(),
            ("atan2", [y, x]) => y.atan2(*x),
            ("sqrt", [x]) => x.sqrt(),
            ("exp", [x]) => x.exp(),
            ("log", [x]) => x.ln(),
            ("log10", [x]) => x.log10(),
            ("abs", [x]) => x.abs(),
            ("min", all @ [_, ..]) => all.iter().copied().fold(f64::INFINITY, f64::min),
            ("max", all @ [_, ..]) => all.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            (name, all) => {
                let message = match FUNCTIONS.contains(&name) {
                    true => format!("{name} does not take {} arguments", all.len()),
                    false => format!("there is no function {name}: {}", FUNCTIONS.join(", ")),
                };
                return Err(self.fault(place, &message));
            }
        };
        self.finite(place, value)
    }
}

/// Names of the functions.
const FUNCTIONS: [&str; 14] = [
    "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sqrt", "exp", "log", "log10", "abs",
    "min", "max",
];

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Result<ParameterValue, Fault> {
        let values = [
            ("mu", ParameterValue::Real(0.3)),
            ("n", ParameterValue::Whole(4)),
            ("name", ParameterValue::Text("STEEL".into())),
        ];
        let values = values.map(|(name, value)| (name.to_owned(), value)).into();
        evaluate(text, &values).map(|(value, _)| value)
    }

    #[test]
    fn precedence_is_that_of_python() {
        for (text, value) in [
            ("-2**2", "-4"),
            ("2**-1", "0.5"),
            ("2**3**2", "512"),
            ("7/2", "3.5"),
            ("8/2", "4.0"),
            ("1 - 2 - 3", "-4"),
            ("2 + 3*4", "14"),
            ("(2 + 3)*4", "20"),
            ("2.0*mu**2", "0.18"),
            ("--3", "3"),
            ("-mu", "-0.3"),
            ("3.0*sin(45*pi/180.0)", "2.1213203435596424"),
            ("max(1, n, 2) + min(0.5, 1)", "4.5"),
            ("abs(-n)", "4"),
            ("atan2(1, 1)", "0.7853981633974483"),
            ("log10(100) + exp(0) + sqrt(4)", "5.0"),
            ("1e-3*.5", "0.0005"),
            ("0.45", "0.45"),
            ("1.", "1.0"),
            ("2.5e-3", "0.0025"),
            ("10**10", "10000000000"),
            ("10**30", "1e30"),
            ("'STEEL'", "STEEL"),
            ("name", "STEEL"),
        ] {
            assert_eq!(
                of(text).map(|value| value.written()),
                Ok(value.to_owned()),
                "{text}"
            );
        }
    }

    #[test]
    fn faults_have_their_places() {
        for (text, at, message) in [
            (
                "2 +",
                3..3,
                "expected a number, a name or `(`, found its end",
            ),
            (
                "2 + * 3",
                4..5,
                "expected a number, a name or `(`, found `*`",
            ),
            ("(1 + 2", 6..6, "expected an operator or `)`, found its end"),
            ("1 2", 2..3, "expected an operator or the end, found `2`"),
            ("2*xi", 2..4, "the parameter xi is not defined before"),
            ("1/(2 - 2)", 1..2, "a division by zero"),
            ("3*sqrt(-1)", 2..6, "this has no finite value"),
            ("sin(1, 2)", 0..3, "sin does not take 2 arguments"),
            ("1 + name", 2..3, "the text 'STEEL' is no number"),
            ("", 0..0, "expected a number, a name or `(`, found its end"),
            ("2 + é", 4..6, "expected a number, a name or `(`, found `é`"),
        ] {
            let fault = of(text).expect_err(text);
            assert_eq!((fault.at, fault.message.as_str()), (at, message), "{text}");
        }
        let fault = of("sinus(1)").expect_err("unknown");
        assert!(
            fault
                .message
                .starts_with("there is no function sinus: sin, cos")
        );
        for deep in ["(".repeat(1000), "-".repeat(1000), "2**".repeat(1000) + "2"] {
            assert!(of(&deep).is_err());
        }
    }
}
