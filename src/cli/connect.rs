//! All calls of the commands into the reader and the solver, replaceable in tests.

use std::path::Path;

use crate::diagnostics::{Code, Diagnostics, Severity, Sources, Strictness};
use crate::dynamics::{Observer, RunError, RunSummary};
use crate::prepare::{PreparedModel, prepare};
use crate::{dynamics, reader};

/// A deck as read.
#[derive(Debug, Clone, Default)]
pub(super) struct Loaded {
    /// The model, ready to run, when the deck has no errors.
    pub model: Option<PreparedModel>,
    /// Errors, warnings and notes for the screen of `check`.
    pub all_messages: String,
    /// The same for the screen of `run`, without those about differences from other codes.
    pub messages: String,
    /// The same without colour, for the log.
    pub plain_messages: String,
    /// Number of errors.
    pub errors: usize,
    /// Number of warnings.
    pub warnings: usize,
    /// The deck and the files it includes.
    pub sources: Sources,
}

/// Reads a deck; messages coloured or not.
type Load = fn(&Path, Strictness, bool) -> Loaded;
/// Solves all steps of a model.
type Solve = fn(&PreparedModel, &mut dyn Observer) -> Result<RunSummary, RunError>;

/// Reader and solver, as the commands call them.
pub(super) struct Numerics {
    pub load: Load,
    pub solve: Solve,
}

impl Numerics {
    /// The reader and the solver of this program.
    pub fn connected() -> Self {
        Numerics {
            load,
            solve: dynamics::run,
        }
    }
}

fn load(path: &Path, strictness: Strictness, colour: bool) -> Loaded {
    let mut sources = Sources::new();
    let mut d = Diagnostics::with_strictness(strictness);
    let model = reader::read_model(path, &mut sources, &mut d);
    let model = model.and_then(|model| prepare(model, &mut d));
    let ours = d.without(Code::LongNumber);
    Loaded {
        model,
        all_messages: d.render(&sources, colour),
        messages: ours.render(&sources, colour),
        plain_messages: ours.render(&sources, false),
        errors: d.count(Severity::Error),
        warnings: d.count(Severity::Warning),
        sources,
    }
}
