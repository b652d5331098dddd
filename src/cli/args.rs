//! Subcommands and options of the command line (parsed by clap), and their translation into
//! settings of the other layers.

use std::ffi::OsString;
use std::num::NonZero;
use std::path::PathBuf;
use std::sync::LazyLock;
use std::thread;
use std::time::Duration;

use clap::{ArgAction, Args as ClapArgs, Parser, Subcommand, ValueEnum, ValueHint};
use clap_complete::Shell;
use serde::{Deserialize, Serialize};

use crate::diagnostics::Strictness;
use crate::model::{Frames, SolverChoice};
use crate::output::{Verbosity, Window};

/// Large-displacement dynamics of plane deformable bodies with exact contact and Coulomb friction.
#[derive(Debug, Parser)]
#[command(
    name = "stickslip",
    version = VERSION,
    long_version = LONG_VERSION.as_str(),
    after_help = "Exit codes: 0 finished, 1 stopped in the solve (results so far are valid), \
                  2 deck rejected, 3 command line, 4 file system; 129, 130, 143 stopped by the \
                  signals HUP, INT, TERM (results so far are valid).\n\
                  The documents docs/NAME.md that messages name are in share/doc/stickslip of the installation."
)]
pub(super) struct Args {
    /// Subcommand.
    #[command(subcommand)]
    pub command: Command,
}

/// Subcommands.
#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Solve a deck and write JOB.vtkhdf, JOB.sta and JOB.log, where JOB is the name of the deck without .inp
    Run(RunArgs),
    /// Read a deck, report every error in it and describe the model, without solving
    Check(CheckArgs),
    /// Explain a keyword of decks, or the code of a message such as D103
    Explain(ExplainArgs),
    /// Write a deck with its includes and assembly as one flat deck that reads as the same model
    Flatten(FlattenArgs),
    /// Describe a result file
    Info(InfoArgs),
    /// Serve an editor with diagnostics while typing, completion, explanations and names of decks (docs/editor.md)
    ///
    /// The server speaks the Language Server Protocol on standard input and output.
    Lsp(LspArgs),
    /// Solve a complementarity problem, such as one that a stopped run has left behind
    ///
    /// The file holds {"M": [[..]], "q": [..], "mu": number or list, "n_contacts": number}; the answer is JSON, too.
    /// The exit code is 0 if the problem is solved, 1 otherwise.
    Lcp(LcpArgs),
    /// A command of the Python package.
    #[command(flatten)]
    Package(PackageCommand),
    /// Print a script with which a shell completes the words of this program
    ///
    /// In bash, this command enables the completion for the current shell: source <(stickslip completion bash)
    Completion(CompletionArgs),
    /// Print the manual page (to read it: stickslip manual | man -l -)
    Manual,
}

/// Commands of the Python package, which get their arguments unchanged.
#[derive(Debug, Subcommand)]
pub(super) enum PackageCommand {
    /// Write the report page of a result: one HTML file that works offline
    #[command(disable_help_flag = true)]
    Report(Words),
    /// Draw results
    #[command(subcommand)]
    Plot(PlotCommand),
    /// Check the claims of a result, from its file alone
    #[command(disable_help_flag = true)]
    Certify(Words),
    /// Run a deck at many values of its parameters
    #[command(disable_help_flag = true)]
    Sweep(Words),
    /// Write a result in the format of other programs
    #[command(disable_help_flag = true)]
    Export(Words),
    /// Look for nodes inside bodies and for edges that cross, in every frame
    #[command(disable_help_flag = true)]
    Penetration(Words),
}

/// Commands that draw pictures of results.
#[derive(Debug, Subcommand)]
pub(super) enum PlotCommand {
    /// Draw deformed shapes at some times, or an animation
    #[command(disable_help_flag = true)]
    Motion(Words),
    /// Draw histories: energies, momenta, forces, displacements
    #[command(disable_help_flag = true)]
    History(Words),
    /// Draw a field along a line of nodes
    #[command(disable_help_flag = true)]
    Along(Words),
}

/// Arguments of a command of the Python package.
#[derive(Debug, ClapArgs)]
pub(super) struct Words {
    /// Arguments of the command; its --help lists them
    #[arg(value_name = "ARGUMENTS", trailing_var_arg = true, allow_hyphen_values = true,
          value_hint = ValueHint::AnyPath)]
    pub words: Vec<OsString>,
}

impl PackageCommand {
    /// Name of the command, and its arguments.
    pub fn words(&self) -> (&'static str, &[OsString]) {
        let (name, words) = match self {
            PackageCommand::Report(words) => ("report", words),
            PackageCommand::Plot(PlotCommand::Motion(words)) => ("plot motion", words),
            PackageCommand::Plot(PlotCommand::History(words)) => ("plot history", words),
            PackageCommand::Plot(PlotCommand::Along(words)) => ("plot along", words),
            PackageCommand::Certify(words) => ("certify", words),
            PackageCommand::Sweep(words) => ("sweep", words),
            PackageCommand::Export(words) => ("export", words),
            PackageCommand::Penetration(words) => ("penetration", words),
        };
        (name, &words.words)
    }
}

/// Arguments of `completion`.
#[derive(Debug, ClapArgs)]
pub(super) struct CompletionArgs {
    /// The shell
    #[arg(value_name = "SHELL")]
    pub shell: Shell,
}

/// A deck and how to read it.
#[derive(Debug, Clone, ClapArgs)]
pub(super) struct DeckArgs {
    /// The deck
    #[arg(value_name = "DECK.inp")]
    pub path: PathBuf,
    /// Count warnings as errors
    #[arg(long, conflicts_with = "lenient")]
    pub strict: bool,
    /// Leave out unknown keywords and parameters with a warning
    #[arg(long)]
    pub lenient: bool,
    /// The earlier job that *RESTART, READ of the deck continues, as path of JOB.restart (with or without .restart) or
    /// of JOB.restart-STEP-INC
    #[arg(long, value_name = "JOB")]
    pub oldjob: Option<PathBuf>,
    /// Give a parameter of the deck (*PARAMETER) this value; the option may be repeated
    #[arg(long = "set", value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub settings: Vec<String>,
}

impl DeckArgs {
    /// Strictness with which the reader treats doubtful decks.
    pub fn strictness(&self) -> Strictness {
        match (self.strict, self.lenient) {
            (true, _) => Strictness::Strict,
            (_, true) => Strictness::Lenient,
            _ => Strictness::Normal,
        }
    }
}

/// Arguments of `run`.
#[derive(Debug, Clone, ClapArgs)]
pub(super) struct RunArgs {
    /// The deck
    #[command(flatten)]
    pub deck: DeckArgs,
    /// Folder for the results, which is created if it is missing
    #[arg(short, long, value_name = "DIR", default_value = ".")]
    pub output: PathBuf,
    /// Write this many field frames per step, evenly spaced (default: the frames that the deck requests, or 100)
    #[arg(long, value_name = "N", conflicts_with = "every", value_parser = positive_count)]
    pub frames: Option<usize>,
    /// Write a field frame after every DT of simulated time
    #[arg(long, value_name = "DT", value_parser = positive_time)]
    pub every: Option<f64>,
    /// Replace the results of an earlier run
    #[arg(long)]
    pub overwrite: bool,
    /// Write a checkpoint JOB.restart after every SECONDS of wall-clock time, and at the end
    ///
    /// A checkpoint is also written if the deck has *RESTART, WRITE, and when a signal stops the run.
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub checkpoint: Option<Duration>,
    /// Continue from the last checkpoint of the job, in the same files and with the same options
    ///
    /// The results are the same to the last bit as without the stop. A run whose deck has changed is refused.
    #[arg(long, conflicts_with_all = ["overwrite", "frames", "every", "solver", "strict", "lenient", "settings", "oldjob"])]
    pub resume: bool,
    /// Continue for a time T beyond the end of the last step
    #[arg(long, value_name = "T", value_parser = positive_time, requires = "resume")]
    pub extend: Option<f64>,
    /// Sparse factorisation (default: the one that the deck chooses, or faer)
    #[arg(long, value_name = "NAME")]
    pub solver: Option<Solver>,
    /// Number of threads, at most 4 for each processor (default: the number of processors)
    #[arg(long, value_name = "N", value_parser = thread_count)]
    pub threads: Option<usize>,
    /// Print errors only
    #[arg(short, long, action = ArgAction::SetTrue, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Also log the convergence of every increment
    #[arg(short, long, action = ArgAction::SetTrue)]
    pub verbose: bool,
}

/// Options of `run` that change the computation or the results.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Options {
    strict: bool,
    lenient: bool,
    settings: Vec<String>,
    frames: Option<usize>,
    every: Option<f64>,
    solver: Option<Solver>,
}

impl RunArgs {
    /// The options of `run` that change the computation or the results, as text.
    pub fn options(&self) -> String {
        let options = Options {
            strict: self.deck.strict,
            lenient: self.deck.lenient,
            settings: self.deck.settings.clone(),
            frames: self.frames,
            every: self.every,
            solver: self.solver,
        };
        // numbers and words are text
        serde_json::to_string(&options).unwrap_or_default()
    }

    /// Sets the options of `run` from a text made by [`Self::options`].
    pub fn take_options(&mut self, text: &str) {
        let options: Options = serde_json::from_str(text).unwrap_or_default();
        (self.deck.strict, self.deck.lenient) = (options.strict, options.lenient);
        self.deck.settings = options.settings;
        (self.frames, self.every) = (options.frames, options.every);
        self.solver = options.solver;
    }

    /// Amount of text that the run prints.
    pub fn verbosity(&self) -> Verbosity {
        match (self.quiet, self.verbose) {
            (true, _) => Verbosity::Quiet,
            (_, true) => Verbosity::Verbose,
            _ => Verbosity::Normal,
        }
    }

    /// Frames asked for on the command line.
    pub fn frames(&self) -> Option<Frames> {
        (self.frames.map(Frames::Count)).or(self.every.map(Frames::Every))
    }
}

/// Arguments of `check`.
#[derive(Debug, ClapArgs)]
pub(super) struct CheckArgs {
    /// The deck
    #[command(flatten)]
    pub deck: DeckArgs,
    /// Format of errors, warnings and notes: text, or JSON without any other output
    #[arg(
        long,
        value_name = "FORMAT",
        default_value = "text",
        conflicts_with = "picture"
    )]
    pub format: Format,
    /// Draw the model with bodies, supports, loads, velocities, surfaces with normals, and contacts
    #[arg(long, value_name = "FILE.svg", value_parser = svg_file)]
    pub picture: Option<PathBuf>,
    /// Draw this part of the plane only (default: the deformable bodies and their surroundings)
    #[arg(long, value_name = "X0,X1,Y0,Y1", value_parser = window, requires = "picture",
          allow_hyphen_values = true)]
    pub window: Option<Window>,
    /// Replace an earlier picture
    #[arg(long, requires = "picture")]
    pub overwrite: bool,
}

/// Arguments of `explain`.
#[derive(Debug, ClapArgs)]
pub(super) struct ExplainArgs {
    /// Keywords (with or without their stars), codes of messages, and words such as bolt or gravity
    #[arg(value_name = "WORD", required = true)]
    pub words: Vec<String>,
}

/// Arguments of `flatten`.
#[derive(Debug, ClapArgs)]
pub(super) struct FlattenArgs {
    /// The deck
    #[command(flatten)]
    pub deck: DeckArgs,
    /// File for the flat deck (default: the screen)
    #[arg(short, long, value_name = "FILE.inp")]
    pub output: Option<PathBuf>,
    /// Replace an earlier file
    #[arg(long, requires = "output")]
    pub overwrite: bool,
}

/// Arguments of `info`.
#[derive(Debug, ClapArgs)]
pub(super) struct InfoArgs {
    /// The result file
    #[arg(value_name = "RESULT.vtkhdf")]
    pub result: PathBuf,
}

/// Arguments of `lsp`.
#[derive(Debug, ClapArgs)]
pub(super) struct LspArgs {
    /// Use standard input and output, as the server always does; many editors give this option
    #[arg(long)]
    pub stdio: bool,
}

/// Arguments of `lcp`.
#[derive(Debug, ClapArgs)]
pub(super) struct LcpArgs {
    /// The problem
    #[arg(value_name = "FILE.json")]
    pub problem: PathBuf,
}

/// Forms of messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// for people
    Text,
    /// for programs (docs/output.md)
    Json,
}

/// Names of the sparse factorisations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
pub(super) enum Solver {
    /// multifrontal LDL^T in faer's order
    Faer,
    /// sprs-ldl with an AMD permutation
    Sprs,
}

impl From<Solver> for SolverChoice {
    fn from(solver: Solver) -> Self {
        match solver {
            Solver::Faer => SolverChoice::Faer,
            Solver::Sprs => SolverChoice::Sprs,
        }
    }
}

fn svg_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("svg") => Ok(path),
        _ => Err("expected the name of a file that ends in .svg".into()),
    }
}

fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| *seconds >= 0.0);
    let duration = seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    duration.ok_or_else(|| "expected a number of seconds".into())
}

fn positive_count(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count) if count > 0 => Ok(count),
        _ => Err("expected a whole number greater than 0".into()),
    }
}

/// Largest number of threads for each processor: further threads would only wait for each other.
const THREADS_PER_PROCESSOR: usize = 4;

fn thread_count(text: &str) -> Result<usize, String> {
    let count = positive_count(text)?;
    let processors = processors();
    let most = THREADS_PER_PROCESSOR.saturating_mul(processors);
    match count <= most {
        true => Ok(count),
        false => Err(format!(
            "expected at most {most}, which is {THREADS_PER_PROCESSOR} for each of the processors \
             that the program may use ({processors})"
        )),
    }
}

/// Number of processors that the program may use; 1 if the system does not report it.
pub(super) fn processors() -> usize {
    thread::available_parallelism().map_or(1, NonZero::get)
}

fn window(text: &str) -> Result<Window, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|x| x.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[x0, x1, y0, y1]) if x0 < x1 && y0 < y1 && (x1 - x0 + (y1 - y0)).is_finite() => {
            Ok(Window([[x0, y0], [x1, y1]]))
        }
        _ => Err("expected four numbers X0,X1,Y0,Y1 with X0 < X1 and Y0 < Y1".into()),
    }
}

fn positive_time(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(time) if time > 0.0 && f64::is_finite(time) => Ok(time),
        _ => Err("expected a time greater than 0".into()),
    }
}

/// Version of the program.
pub(super) const NUMBER: &str = env!("CARGO_PKG_VERSION");

/// Commit that the program was built from.
pub(super) const COMMIT: &str = env!("STICKSLIP_COMMIT");

/// Build profile of the program.
pub(super) const PROFILE: &str = env!("STICKSLIP_PROFILE");

/// Version, commit and profile.
pub(super) const VERSION: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    " (",
    env!("STICKSLIP_COMMIT"),
    ", ",
    env!("STICKSLIP_PROFILE"),
    ")"
);

/// Licences of the libraries of the build, with their versions.
const LICENCES: [(&str, &str); 7] = [
    ("clap", "MIT OR Apache-2.0"),
    ("faer", "MIT"),
    ("hdf5-metno", "MIT OR Apache-2.0"),
    ("nalgebra", "Apache-2.0"),
    ("rayon", "MIT OR Apache-2.0"),
    ("sprs", "MIT OR Apache-2.0"),
    ("sprs-ldl", "LGPL-2.1"),
];

/// [`VERSION`], and the libraries with versions and licences.
pub(super) static LONG_VERSION: LazyLock<String> = LazyLock::new(|| {
    let (major, minor, micro) = hdf5::library_version();
    let mut lines = vec![
        VERSION.to_owned(),
        "licence MIT OR Apache-2.0".to_owned(),
        "libraries:".to_owned(),
        format!("  HDF5 {major}.{minor}.{micro} (BSD-3-Clause)"),
    ];
    for library in env!("STICKSLIP_LIBRARIES").split(';') {
        let name = library.split(' ').next().unwrap_or_default();
        let licence = LICENCES.iter().find(|(known, _)| *known == name);
        let licence = licence.map_or("see its source", |(_, licence)| licence);
        lines.push(format!("  {library} ({licence})"));
    }
    lines.join("\n")
});
