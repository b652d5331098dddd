//! Problems and answers as JSON, for replaying a problem outside the program.
//!
//! ```text
//! {"M": [[..], ..], "q": [..], "mu": number or list, "n_contacts": n}     mu, n_contacts optional
//! {"status": "solved", "method": "lemke", "residual": .., "pivots": .., "z": [..], "w": [..]}
//! ```
//!
//! A problem with `mu` or `n_contacts` is frictional, in the blocks of [`FrictionalLcp::to_lcp`].
//! Numbers that are not finite are written as the strings "inf", "-inf" and "nan".

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::hybrid::{LcpMethod, solve_frictional};
use super::lemke::{LemkeSettings, covering_vector, lemke};
use super::problems::{FrictionalLcp, FrictionalSolution, Lcp, LcpError, LcpSolution, Method};

/// A number, or the text of a number that JSON cannot represent.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum PivotNumber {
    Finite(f64),
    Text(String),
}

/// One friction coefficient for all contacts, or one coefficient for each contact.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Coefficients {
    List(Vec<PivotNumber>),
    Same(PivotNumber),
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Problem {
    #[serde(rename = "M")]
    m: Vec<Vec<PivotNumber>>,
    q: Vec<PivotNumber>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    mu: Option<Coefficients>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    n_contacts: Option<usize>,
}

#[derive(Serialize)]
struct Answer {
    status: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    message: Option<String>,
    method: Option<&'static str>,
    residual: Option<f64>,
    pivots: usize,
    z: Option<Vec<f64>>,
    w: Option<Vec<f64>>,
}

/// Answer to a problem given as JSON.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JsonAnswer {
    /// The answer as JSON text.
    pub text: String,
    /// Whether the problem was solved.
    pub solved: bool,
}

/// Solves a problem given as JSON. The answer to a text that states no problem has the status `invalid`.
pub fn solve_json(text: &str) -> JsonAnswer {
    let answer = match read(text) {
        Ok((lcp, None)) => match lemke(&lcp, &covering_vector(&lcp), &LemkeSettings::default()) {
            Ok(solution) => general(solution),
            Err(error) => failed(&error),
        },
        Ok((_, Some(problem))) => match solve_frictional(&problem, None, LcpMethod::Hybrid) {
            Ok(solution) => frictional(&problem, &solution),
            Err(error) => failed(&error),
        },
        Err(message) => unsolved("invalid", message, 0),
    };
    let solved = answer.status == "solved";
    let text = serde_json::to_string(&answer).unwrap_or_default();
    JsonAnswer { text, solved }
}

impl FrictionalLcp {
    /// The problem as JSON, in the blocks of [`to_lcp`](Self::to_lcp).
    pub fn to_json(&self) -> String {
        let Lcp { m, q } = self.to_lcp();
        let row = |i| m.row(i).iter().map(|v| number(*v)).collect();
        let problem = Problem {
            m: (0..m.nrows()).map(row).collect(),
            q: q.iter().map(|v| number(*v)).collect(),
            mu: Some(Coefficients::List(
                self.mu.iter().map(|v| number(*v)).collect(),
            )),
            n_contacts: Some(self.len()),
        };
        serde_json::to_string(&problem).unwrap_or_default()
    }

    /// The frictional problem that a JSON text states, or the reason why the text states no such problem.
    pub fn from_json(text: &str) -> Result<Self, String> {
        read(text)?
            .1
            .ok_or_else(|| "the problem has neither \"mu\" nor \"n_contacts\"".into())
    }
}

/// The general problem that a text states, and its frictional form if it has one.
fn read(text: &str) -> Result<(Lcp, Option<FrictionalLcp>), String> {
    let problem: Problem = serde_json::from_str(text).map_err(|e| e.to_string())?;
    let size = problem.q.len();
    if problem.m.len() != size || problem.m.iter().any(|row| row.len() != size) {
        return Err(format!(
            "M must have {size} rows and columns, as q has entries"
        ));
    }
    let entries: Vec<f64> = problem
        .m
        .iter()
        .flatten()
        .map(value)
        .collect::<Result<_, _>>()?;
    let q: Vec<f64> = problem.q.iter().map(value).collect::<Result<_, _>>()?;
    let lcp = Lcp {
        m: DMatrix::from_row_slice(size, size, &entries),
        q: DVector::from_vec(q),
    };
    lcp.check().map_err(|e| e.to_string())?;
    if problem.mu.is_none() && problem.n_contacts.is_none() {
        return Ok((lcp, None));
    }
    let n = problem.n_contacts.unwrap_or(size / 3);
    if n.checked_mul(3) != Some(size) {
        return Err(format!(
            "{n} contacts need q of three entries each, not {size} in all"
        ));
    }
    let mu = match &problem.mu {
        None => (0..n).map(|i| lcp.m[(2 * n + i, i)]).collect(),
        Some(Coefficients::Same(mu)) => vec![value(mu)?; n],
        Some(Coefficients::List(list)) => list.iter().map(value).collect::<Result<_, _>>()?,
    };
    if mu.len() != n {
        return Err(format!("mu has {} entries for {n} contacts", mu.len()));
    }
    let frictional = FrictionalLcp::from_lcp(&lcp, &DVector::from_vec(mu)).ok_or(
        "M and q do not have the blocks of a frictional problem with these mu and n_contacts \
         (leave both out to solve it as a general problem)",
    )?;
    Ok((lcp, Some(frictional)))
}

fn value(number: &PivotNumber) -> Result<f64, String> {
    match number {
        PivotNumber::Finite(value) => Ok(*value),
        PivotNumber::Text(text) => text
            .parse()
            .map_err(|_| format!("\"{text}\" is not a number")),
    }
}

fn number(value: f64) -> PivotNumber {
    if value.is_finite() {
        PivotNumber::Finite(value)
    } else {
        PivotNumber::Text(value.to_string().to_lowercase())
    }
}

fn general(solution: LcpSolution) -> Answer {
    Answer {
        status: "solved",
        message: None,
        method: Some("lemke"),
        residual: Some(solution.residual),
        pivots: solution.pivots,
        z: Some(solution.z.iter().copied().collect()),
        w: Some(solution.w.iter().copied().collect()),
    }
}

/// The answer with z = (Pn, T+, Dt-) and w = (g, Dt+, T-) of a frictional solution.
fn frictional(problem: &FrictionalLcp, solution: &FrictionalSolution) -> Answer {
    let FrictionalSolution {
        pn, pt, gap, slip, ..
    } = solution;
    let tangential = |sign: f64| {
        let limits = pn.iter().zip(&problem.mu).zip(pt);
        limits.map(move |((pn, mu), pt)| 0.5 * (mu * pn + sign * pt))
    };
    let part = |sign: f64| slip.iter().map(move |s| (sign * s).max(0.0));
    Answer {
        status: "solved",
        message: None,
        method: Some(match solution.method {
            Method::Trivial => "trivial",
            Method::ActiveSet => "active_set",
            Method::Lemke => "lemke",
        }),
        residual: Some(solution.residual),
        pivots: solution.counters.pivots,
        z: Some(
            pn.iter()
                .copied()
                .chain(tangential(1.0))
                .chain(part(-1.0))
                .collect(),
        ),
        w: Some(
            gap.iter()
                .copied()
                .chain(part(1.0))
                .chain(tangential(-1.0))
                .collect(),
        ),
    }
}

fn failed(error: &LcpError) -> Answer {
    let (status, pivots) = match error {
        LcpError::Ray { pivots, .. } => ("ray", *pivots),
        LcpError::PivotLimit { pivots } => ("pivot_limit", *pivots),
        LcpError::Residual { .. } => ("residual", 0),
        LcpError::NotFinite | LcpError::Size { .. } | LcpError::Range { .. } => ("invalid", 0),
    };
    unsolved(status, error.to_string(), pivots)
}

fn unsolved(status: &'static str, message: String, pivots: usize) -> Answer {
    let message = Some(message);
    Answer {
        status,
        message,
        method: None,
        residual: None,
        pivots,
        z: None,
        w: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lcp::FreeUnknowns;

    fn answer(text: &str) -> serde_json::Value {
        serde_json::from_str(&solve_json(text).text).unwrap()
    }

    fn one_contact() -> FrictionalLcp {
        FrictionalLcp {
            q: DMatrix::from_row_slice(2, 2, &[2.0, 0.0, 0.0, 1.0]),
            gap: DVector::from_element(1, -1.0),
            slip: DVector::from_element(1, -0.75),
            mu: DVector::from_element(1, 0.5),
            free: FreeUnknowns::default(),
        }
    }

    #[test]
    fn general_problems() {
        let solved = answer(r#"{"M": [[2, 1], [1, 2]], "q": [-3, -3]}"#);
        assert_eq!(solved["z"], serde_json::json!([1.0, 1.0]));
        assert_eq!(answer(r#"{"M": [[0]], "q": [-1]}"#)["status"], "ray");
        assert_eq!(answer(r#"{"M": [[1]], "q": ["nan"]}"#)["status"], "invalid");
        assert_eq!(answer(r#"{"M": [[1, 2]], "q": [1]}"#)["status"], "invalid");
        assert_eq!(answer("{")["status"], "invalid");
        assert_eq!(answer(r#"{"M": [], "q": []}"#)["status"], "solved");
    }

    #[test]
    fn frictional_problems_round_trip() {
        let problem = one_contact();
        let text = problem.to_json();
        assert_eq!(FrictionalLcp::from_json(&text), Ok(problem));
        let solved = answer(&text);
        assert_eq!(solved["method"], "active_set");
        // Pn = 0.5, Pt = mu Pn: T+ = 0.25, slip -0.5.
        assert_eq!(solved["z"], serde_json::json!([0.5, 0.25, 0.5]));
        assert_eq!(solved["w"], serde_json::json!([0.0, 0.0, 0.0]));
    }

    #[test]
    fn coefficients_in_each_form() {
        let Lcp { m, q } = one_contact().to_lcp();
        let rows: Vec<Vec<f64>> = m.row_iter().map(|r| r.iter().copied().collect()).collect();
        let text = format!(r#""M": {rows:?}, "q": {:?}"#, q.as_slice());
        for tail in [r#""mu": 0.5"#, r#""mu": [0.5]"#, r#""n_contacts": 1"#] {
            assert_eq!(
                answer(&format!("{{{text}, {tail}}}"))["method"],
                "active_set",
                "{tail}"
            );
        }
        for tail in [
            r#""mu": 0.4"#,
            r#""mu": [0.5, 0.5]"#,
            r#""n_contacts": 2"#,
            r#""nu": 1"#,
        ] {
            assert_eq!(
                answer(&format!("{{{text}, {tail}}}"))["status"],
                "invalid",
                "{tail}"
            );
        }
        assert_eq!(answer(&format!("{{{text}}}"))["method"], "lemke");
    }

    #[test]
    fn numbers_that_are_not_finite_are_text() {
        let mut problem = one_contact();
        problem.gap[0] = f64::NEG_INFINITY;
        problem.slip[0] = f64::NAN;
        let text = problem.to_json();
        assert!(text.contains(r#""-inf","nan""#), "{text}");
        assert_eq!(answer(&text)["status"], "invalid");
    }
}
