//! The subcommand `run`: from the deck to the finished result files, however the run ends.

use std::error::Error;

use super::check::{complain_of, deck_line_of, describe, load};
use super::overrides;
use crate::cli::args::{RunArgs, processors};
use crate::cli::connect::{Loaded, Numerics};
use crate::cli::error::CliError;
use crate::cli::exit::Exit;
use crate::cli::signals;
use crate::cli::terminal::print;
use crate::cli::version::{COMMIT, NUMBER, PROFILE};
use crate::dynamics::{Outcome, RunError};
use crate::output::{
    Claim, Interrupt, JobFiles, ModelEcho, ResultWriter, RunRecord, Verbosity, check_memory,
    check_names, program_lines,
};
use crate::prepare::{MemoryNeed, PreparedModel};

/// Solves a deck; `command` is the command as typed. The run ends early when `interrupt` requests
/// it.
pub(in crate::cli) fn run(
    args: &RunArgs,
    command: &str,
    numerics: &Numerics,
    interrupt: &Interrupt,
) -> Result<Exit, CliError> {
    let mut loaded = load(&args.deck, numerics)?;
    let Some(mut model) = loaded.model.take() else {
        complain_of(&loaded.messages);
        return Ok(Exit::Rejected);
    };
    if args.verbosity() != Verbosity::Quiet {
        complain_of(&loaded.messages);
    }
    if model.model().is_check_only() {
        return check_only(args, &loaded, &model);
    }
    check_names(model.model())?;
    if interrupt.signal().is_some() {
        return Ok(signals::exit(interrupt));
    }
    let need = MemoryNeed::new(&model);
    check_memory(need)?;
    let files = JobFiles::new(&args.deck.path, &args.output);
    let claim = Claim::take(&files, args.overwrite)?;
    let record = RunRecord {
        memory_need: need.total(),
        ..record(command, &loaded, start_threads(args.threads)?)
    };
    let notes = overrides::apply(args, model.steps_mut());
    let mut writer = ResultWriter::create(model.model(), claim, &record, args.verbosity())?;
    writer.heed(interrupt);
    for line in header(args, &files, &loaded, &record, &model) {
        writer.line(&line)?;
    }
    for note in &notes {
        writer.line(note)?;
    }
    if !loaded.plain_messages.is_empty() {
        writer.detail(loaded.plain_messages.trim_end())?;
    }
    writer.line("")?;
    let exit = solve(&model, &mut writer, numerics, interrupt)?;
    match writer.lost_screen() {
        Some(error) if exit == Exit::Finished => Err(CliError::Screen(error)),
        _ => Ok(exit),
    }
}

/// Describes the model of a deck that shall not be solved; no file is touched.
fn check_only(args: &RunArgs, loaded: &Loaded, model: &PreparedModel) -> Result<Exit, CliError> {
    if args.verbosity() == Verbosity::Quiet {
        check_names(model.model())?;
        return Ok(Exit::Finished);
    }
    describe(&args.deck, loaded, model)?;
    let line = "run      nothing was solved and no file written: the deck has *NO ANALYSIS";
    print(&[line.to_owned()])?;
    Ok(Exit::Finished)
}

/// Solves the model and completes the results.
fn solve(
    model: &PreparedModel,
    writer: &mut ResultWriter,
    numerics: &Numerics,
    interrupt: &Interrupt,
) -> Result<Exit, CliError> {
    let solved = (numerics.solve)(model, writer);
    let solved = solved.map_err(|RunError::Observer(error)| error);
    let finished = solved.and_then(|summary| writer.finish(&summary).map(|()| summary.outcome));
    match finished {
        Ok(Outcome::Finished) => Ok(Exit::Finished),
        Ok(Outcome::Stopped(_)) => Ok(Exit::Stopped),
        Ok(Outcome::Interrupted) => Ok(signals::exit(interrupt)),
        Err(source) => {
            let kept = writer.kept();
            let error = CliError::Broken { source, kept };
            // The first error is reported below; completing the files may fail as well.
            let _ = writer.detail(&format!("error: {error}"));
            let _ = writer.abandon(error.exit() as u8);
            Err(error)
        }
    }
}

/// Starts the threads of the program, this one being the first, and returns their number.
fn start_threads(wanted: Option<usize>) -> Result<usize, CliError> {
    let threads = wanted.unwrap_or_else(processors);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    if let Err(error) = pool.use_current_thread().build_global() {
        // Where none are asked for, those that run already will do.
        let run_already = error.source().is_none();
        if wanted.is_some() || !run_already {
            let reason = error.to_string();
            return Err(CliError::Threads { threads, reason });
        }
    }
    Ok(rayon::current_num_threads())
}

fn record(command: &str, loaded: &Loaded, threads: usize) -> RunRecord {
    RunRecord {
        version: NUMBER.into(),
        commit: COMMIT.into(),
        deck: loaded.sources.full_text(),
        command: command.into(),
        threads,
        memory_need: 0,
    }
}

/// The lines above the table of increments.
fn header(
    args: &RunArgs,
    files: &JobFiles,
    loaded: &Loaded,
    record: &RunRecord,
    model: &PreparedModel,
) -> Vec<String> {
    let mut lines = program_lines(record, PROFILE, &files.name, &model.model().title);
    lines.push(deck_line_of(&args.deck.path, loaded, Some(&files.log)));
    lines.extend(ModelEcho::new(model.model()).lines(model));
    lines
}
