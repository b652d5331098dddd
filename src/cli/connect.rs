//! The calls into the reader and the solver, all of them.

use std::io;
use std::path::Path;

use crate::dynamics::{Observer, RunSummary};
use crate::model::Model;

/// A deck as read.
#[derive(Debug, Clone, Default)]
pub(super) struct Loaded {
    /// The model, when the deck has no errors.
    pub model: Option<Model>,
    /// Errors and warnings for the screen.
    pub messages: String,
    /// The same without colour, for the log.
    pub plain_messages: String,
    /// Number of errors.
    pub errors: usize,
    /// Number of warnings.
    pub warnings: usize,
    /// Full text, includes in place.
    pub text: String,
    /// Number of lines, includes counted.
    pub lines: usize,
    /// Number of included files.
    pub includes: usize,
}

/// Why a solve gave no summary.
#[derive(Debug)]
#[cfg_attr(not(test), allow(dead_code))] // CONNECT: drop with the stubs below.
pub(super) enum SolveError {
    /// The results could not be written.
    Output(io::Error),
    /// The solver could not start.
    Setup(String),
}

/// Reads a deck; messages coloured or not.
type Load = fn(&Path, bool) -> Loaded;
/// Smallest gap of each contact at the start, infinite without candidate.
type InitialGaps = fn(&Model) -> Vec<f64>;
/// Solves all steps of a model.
type Solve = fn(&Model, &mut dyn Observer) -> Result<RunSummary, SolveError>;

/// What the commands need of the rest of the program.
pub(super) struct Numerics {
    pub load: Load,
    pub initial_gaps: InitialGaps,
    pub solve: Solve,
}

impl Numerics {
    /// The reader and the solver of this program.
    pub fn connected() -> Self {
        Numerics {
            load,
            initial_gaps,
            solve,
        }
    }
}

// CONNECT 1: deck::read and reader::build.
//     let mut sources = Sources::new();
//     let mut d = Diagnostics::new();
//     let deck = deck::read(path, &mut sources, &mut d);
//     let model = reader::build(&deck, &mut d).filter(|_| !d.has_errors());
//     Loaded {
//         model,
//         messages: d.render(&sources, colour),
//         plain_messages: d.render(&sources, false),
//         errors: d.count(Severity::Error),
//         warnings: d.count(Severity::Warning),
//         text: sources.full_text(),
//         lines: sources.line_count(),
//         includes: sources.files().len().saturating_sub(1),
//     }
fn load(_path: &Path, _colour: bool) -> Loaded {
    let message = "error: the deck reader is not connected".to_owned();
    Loaded {
        messages: message.clone(),
        plain_messages: message,
        errors: 1,
        ..Loaded::default()
    }
}

// CONNECT 2: contact::initial_gaps(model).
fn initial_gaps(model: &Model) -> Vec<f64> {
    vec![f64::INFINITY; model.contacts.len()]
}

// CONNECT 3: dynamics::run(model, observer), RunError mapped to SolveError.
fn solve(_model: &Model, _observer: &mut dyn Observer) -> Result<RunSummary, SolveError> {
    Err(SolveError::Setup("the solver is not connected".into()))
}
