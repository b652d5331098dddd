//! The subcommand `run`: from the deck to the finished result files, for every way in which a run may end.

use std::error::Error;
use std::time::Duration;

use super::args::{COMMIT, NUMBER, PROFILE, RunArgs, VERSION, processors};
use super::commands::{Loaded, Numerics, describe, load, old_job};
use super::error::{CliError, Exit};
use super::signals;
use super::terminal::{coloured, complain, print};
use crate::deck::first_change;
use crate::diagnostics::{Diagnostics, Sources};
use crate::dynamics::{Outcome, RunError, resume};
use crate::model::{Frames, SolverChoice, Step};
use crate::output::{
    Checkpoint, Checkpoints, Claim, Earlier, Interrupt, JobFiles, ModelEcho, RestartOrigin,
    ResultWriter, RunRecord, Verbosity, check_memory, check_names, frames, new_run_id,
    program_lines, scientific, solver,
};
use crate::prepare::{MemoryNeed, PreparedModel};

/// Solves a deck; `command` is the command as typed. The run ends early if `interrupt` requests it.
pub(super) fn run(
    args: &RunArgs,
    command: &str,
    numerics: &Numerics,
    interrupt: &Interrupt,
) -> Result<Exit, CliError> {
    let files = JobFiles::new(&args.deck.path, &args.output);
    let earlier = match args.resume {
        true => Some(Checkpoint::read(&files.restart, VERSION)?),
        false => None,
    };
    let mut args = args.clone();
    if let Some(earlier) = &earlier {
        args.take_options(&earlier.origin.options);
    }
    let args = &args;
    let old_job = old_job(&args.deck)?;
    let earlier_deck = match &earlier {
        Some(earlier) => earlier.origin.earlier.clone(),
        None => old_job.as_ref().map(Checkpoint::as_earlier_deck),
    };
    let mut loaded = load(&args.deck, earlier_deck.clone(), numerics)?;
    let run = earlier.as_ref().map(|earlier| earlier.origin.run.clone());
    let origin = RestartOrigin {
        run: run.unwrap_or_else(new_run_id),
        deck: texts(&loaded.sources),
        options: args.options(),
        settings: args.deck.settings.clone(),
        earlier: earlier_deck,
        extension: earlier
            .as_ref()
            .map_or(0.0, |earlier| earlier.origin.extension)
            + args.extend.unwrap_or(0.0),
    };
    let extension = origin.extension;
    if let Some(earlier) = &earlier
        && let Some(changed) = first_change(&earlier.origin.deck, &loaded.sources)
    {
        let mut d = Diagnostics::new();
        d.push(changed);
        complain(&d.render(&loaded.sources, coloured()));
        return Ok(Exit::Rejected);
    }
    let Some(mut model) = loaded.model.take() else {
        complain(&loaded.messages);
        return Ok(Exit::Rejected);
    };
    if args.verbosity() != Verbosity::Quiet {
        complain(&loaded.messages);
    }
    if model.model.is_check_only() {
        return check_only(args, &loaded, &model);
    }
    check_names(&model.model)?;
    if interrupt.signal().is_some() {
        return Ok(signals::exit(interrupt));
    }
    let need = MemoryNeed::new(&model);
    check_memory(need)?;
    let results = match (args.resume, args.overwrite) {
        (true, _) => Earlier::Continued,
        (false, true) => Earlier::Replaced,
        (false, false) => Earlier::Stays,
    };
    let claim = Claim::take(&files, results)?;
    let record = RunRecord {
        id: origin.run.clone(),
        version: NUMBER.into(),
        commit: COMMIT.into(),
        deck: loaded.sources.full_text(),
        command: command.into(),
        threads: start_threads(args.threads)?,
        memory_need: need.total(),
    };
    let notes = override_steps(args, &mut model.model.steps);
    let parts = (&model.model, &model.surfaces[..]);
    let mut writer = ResultWriter::create(parts, claim, &record, args.verbosity())?;
    writer.heed(interrupt);
    writer.keep_checkpoints(Checkpoints {
        program: VERSION.into(),
        origin,
        // an extended run may be extended again
        every: args.checkpoint.or(args.extend.map(|_| Duration::MAX)),
    });
    for line in header(args, &files, &loaded, &record, &model) {
        writer.line(&line)?;
    }
    // texts of the deck, which the run does not need
    drop(record);
    let plain_messages = std::mem::take(&mut loaded.plain_messages);
    drop(loaded);
    for note in &notes {
        writer.line(note)?;
    }
    if let Some(earlier) = &earlier {
        let time = scientific(earlier.time, 6);
        writer.line(&format!("resumed  from the checkpoint at time {time}"))?;
        writer.go_on(earlier).map_err(CliError::GoOn)?;
    }
    if let Some(old_job) = &old_job {
        let time = scientific(old_job.time, 6);
        writer.line(&format!(
            "goes on  from the checkpoint at time {time} of the earlier job"
        ))?;
        writer.begin_at(old_job)?;
    }
    if !plain_messages.is_empty() {
        writer.detail(plain_messages.trim_end())?;
    }
    writer.line("")?;
    let exit = solve(
        &model,
        &mut writer,
        numerics,
        (
            interrupt,
            (earlier.as_ref().or(old_job.as_ref())).map(|earlier| (earlier, extension)),
        ),
    )?;
    match writer.lost_screen() {
        Some(error) if exit == Exit::Finished => Err(CliError::Screen(error)),
        _ => Ok(exit),
    }
}

/// Names and texts of the files of a deck.
fn texts(sources: &Sources) -> Vec<(String, String)> {
    let files = sources.files().iter();
    files
        .map(|file| (file.name().to_owned(), file.text().to_owned()))
        .collect()
}

/// Describes the model of a deck that is not to be solved; no file is touched.
fn check_only(args: &RunArgs, loaded: &Loaded, model: &PreparedModel) -> Result<Exit, CliError> {
    if args.verbosity() == Verbosity::Quiet {
        check_names(&model.model)?;
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
    (interrupt, earlier): (&Interrupt, Option<(&Checkpoint, f64)>),
) -> Result<Exit, CliError> {
    let solved = match earlier {
        Some((earlier, extension)) => resume(model, &earlier.solver, extension, writer),
        None => (numerics.solve)(model, writer),
    };
    let finished =
        solved.and_then(|summary| Ok(writer.finish(&summary).map(|()| summary.outcome)?));
    match finished {
        Ok(Outcome::Finished) => Ok(Exit::Finished),
        Ok(Outcome::Stopped(_)) => Ok(Exit::Stopped),
        Ok(Outcome::Interrupted) => Ok(signals::exit(interrupt)),
        Err(error) => {
            let kept = writer.kept();
            let error = match error {
                RunError::Observer(source) => CliError::Broken { source, kept },
                RunError::Checkpoint(source) => CliError::OfAnotherModel { source, kept },
            };
            // The first error is reported below; completing the files may fail as well.
            let _ = writer.detail(&format!("error: {error}"));
            let _ = writer.abandon(error.exit() as u8);
            Err(error)
        }
    }
}

/// Starts the threads of the program and returns their number, which includes the calling thread.
fn start_threads(wanted: Option<usize>) -> Result<usize, CliError> {
    let threads = wanted.unwrap_or_else(processors);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    if let Err(error) = pool.use_current_thread().build_global() {
        // Without --threads the threads are used that the process has started already.
        let run_already = error.source().is_none();
        if wanted.is_some() || !run_already {
            let reason = error.to_string();
            return Err(CliError::Threads { threads, reason });
        }
    }
    Ok(rayon::current_num_threads())
}

/// The lines above the table of increments.
fn header(
    args: &RunArgs,
    files: &JobFiles,
    loaded: &Loaded,
    record: &RunRecord,
    model: &PreparedModel,
) -> Vec<String> {
    let mut lines = program_lines(record, PROFILE, &files.name, &model.model.title);
    lines.push(loaded.line(&args.deck.path, Some(&files.log)));
    lines.extend(ModelEcho::new(&model.model).lines(model));
    lines
}

/// Applies the command line to the steps; returns a note for each value of the deck that the command line replaces.
fn override_steps(args: &RunArgs, steps: &mut [Step]) -> Vec<String> {
    let mut notes = vec![];
    for (step, number) in steps.iter_mut().zip(1..) {
        let mut note = |wanted: String, deck: String| {
            notes.push(format!(
                "override step {number}: {wanted} as the command line says, not {deck} as the deck does"
            ));
        };
        if let Some(wanted) = args.frames() {
            if step.frames != wanted && step.frames != Frames::Default {
                note(frames(&wanted), frames(&step.frames));
            }
            step.frames = wanted;
        }
        if let Some(wanted) = args.solver.map(SolverChoice::from) {
            let deck = std::mem::replace(&mut step.settings.solver, wanted);
            if deck != wanted {
                note(
                    format!("solver {}", solver(wanted)),
                    solver(deck).to_owned(),
                );
            }
        }
    }
    notes
}

#[cfg(test)]
mod tests {
    use std::io;

    use super::super::args::{Args, Command};
    use super::*;
    use crate::diagnostics::Sources;
    use crate::dynamics::{
        Cause, Cutback, FailedLcp, Failure, FrictionResults, IncrementReport, NodalResults,
        NodeStatus, Observer, Outcome, PassReport, RunError, RunSummary, SolverCounts, State,
        Timings, Worst,
    };
    use crate::elements::{ElementResult, Strained};
    use crate::lcp::{FreeUnknowns, FrictionalLcp, LcpError};
    use crate::materials::Law;
    use crate::model::{Element, ElementType, Increments, Mesh, Model, Set};
    use crate::output::ResultSummary;
    use clap::Parser;
    use nalgebra::{DMatrix, DVector};
    use std::cell;
    use std::path::{Path, PathBuf};
    use std::sync::Arc;
    use tempfile::TempDir;

    /// A deck with one square element and one step of ten increments, with a frame at its end.
    fn square() -> Model {
        let mut model = Model {
            mesh: Mesh {
                node_labels: vec![1, 2, 3, 4],
                coordinates: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
                elements: vec![Element {
                    label: 8,
                    element_type: ElementType::CPS4,
                    nodes: vec![0, 1, 2, 3].into(),
                    section: 0,
                }],
            },
            steps: vec![Step {
                frames: Frames::Count(1),
                ..Step::new(Increments::fixed(0.1, 1.0))
            }],
            ..Model::default()
        };
        model.add_section(Law::elastic(1.0, 0.0), 1.0, 1.0);
        model
    }

    fn loaded(model: Option<Model>) -> Loaded {
        let mut sources = Sources::new();
        sources.add("deck.inp", "*HEADING\n", None);
        Loaded {
            errors: usize::from(model.is_none()),
            model: model.map(PreparedModel::new),
            plain_messages: "warning: this is a test".into(),
            sources,
            ..Loaded::default()
        }
    }

    fn report(increment: usize) -> IncrementReport {
        IncrementReport {
            increment,
            step: 1,
            time: 0.1 * increment as f64,
            step_time: 0.1 * increment as f64,
            dt: 0.1,
            state: State {
                u: vec![1.0; 8],
                v: vec![0.0; 8],
                a: vec![0.0; 8],
                ..State::default()
            },
            nodal: NodalResults {
                reaction: vec![0.0; 8],
                contact_force: vec![0.0; 8],
                tie_force: vec![],
                hinge_force: Vec::new(),
                gap: vec![f64::NAN; 4],
                status: vec![NodeStatus::None; 4],
                concentrated: vec![0.0; 8],
                pressure: vec![0.0; 4],
                friction: FrictionResults::default(),
                slip: vec![0.0; 4],
                mass: vec![],
            },
            ends_step: increment == 10,
            strain: Strained {
                element: 0,
                strain: 0.03 * increment as f64,
            },
            elements: Arc::new([ElementResult {
                principal_strain: 0.03 * increment as f64,
                ..ElementResult::default()
            }]),
            ..IncrementReport::default()
        }
    }

    fn summary(outcome: Outcome, increments: usize) -> RunSummary {
        RunSummary {
            outcome,
            increments,
            cutbacks: 0,
            rejections: 0,
            events: 0,
            solver: SolverCounts::default(),
            timings: Timings::default(),
        }
    }

    fn failure() -> Failure {
        Failure {
            increment: 4,
            step: 1,
            time: 0.3,
            dt: 0.05,
            cause: Cause::Inverted {
                element: 0,
                determinant: -0.1,
            },
            course: None,
            worst: Some(Worst {
                node: 2,
                position: [1.5, 2.5],
                quantity: "force residual",
                value: 0.25,
            }),
            passes: vec![PassReport::default(); 2],
            halvings: 1,
        }
    }

    fn to_the_end(_: &PreparedModel, observer: &mut dyn Observer) -> Result<RunSummary, RunError> {
        for k in 0..=10 {
            observer.increment(&report(k)).map_err(RunError::Observer)?;
        }
        Ok(summary(Outcome::Finished, 10))
    }

    fn to_a_stop(_: &PreparedModel, observer: &mut dyn Observer) -> Result<RunSummary, RunError> {
        for k in 0..=3 {
            observer.increment(&report(k)).map_err(RunError::Observer)?;
        }
        let failure = failure();
        let cutback = Cutback {
            failure: failure.clone(),
            next_dt: 0.05,
        };
        observer.cutback(&cutback).map_err(RunError::Observer)?;
        Ok(summary(Outcome::Stopped(Box::new(failure)), 3))
    }

    fn to_an_unsolved_lcp(
        _: &PreparedModel,
        observer: &mut dyn Observer,
    ) -> Result<RunSummary, RunError> {
        observer.increment(&report(0)).map_err(RunError::Observer)?;
        let mut failure = failure();
        failure.cause = Cause::Lcp(Box::new(FailedLcp {
            error: LcpError::PivotLimit { pivots: 9 },
            problem: one_contact(),
            pairs: vec![[3, 0, 1]; 6],
        }));
        Ok(summary(Outcome::Stopped(Box::new(failure)), 0))
    }

    fn to_a_passage(
        _: &PreparedModel,
        observer: &mut dyn Observer,
    ) -> Result<RunSummary, RunError> {
        observer.increment(&report(0)).map_err(RunError::Observer)?;
        let mut failure = failure();
        failure.cause = Cause::Crossed {
            slave: 3,
            segment: [0, 1],
            prescribed: true,
        };
        Ok(summary(Outcome::Stopped(Box::new(failure)), 0))
    }

    fn one_contact() -> FrictionalLcp {
        FrictionalLcp {
            q: DMatrix::identity(2, 2),
            gap: DVector::from_vec(vec![-1.0]),
            slip: DVector::zeros(1),
            mu: DVector::zeros(1),
            free: FreeUnknowns::default(),
        }
    }

    fn to_a_full_disk(
        _: &PreparedModel,
        observer: &mut dyn Observer,
    ) -> Result<RunSummary, RunError> {
        observer.increment(&report(0)).map_err(RunError::Observer)?;
        let full = io::Error::from(io::ErrorKind::StorageFull);
        Err(RunError::Observer(full))
    }

    fn numerics() -> Numerics {
        Numerics {
            load: |_, _, _| loaded(Some(square())),
            solve: to_the_end,
        }
    }

    /// A new folder with a deck in it.
    struct Bench {
        folder: TempDir,
        interrupt: Interrupt,
    }

    impl Bench {
        fn new() -> Self {
            let folder = TempDir::new().expect("folder");
            std::fs::write(folder.path().join("job.inp"), "*HEADING\n").expect("deck");
            let interrupt = Interrupt::default();
            Bench { folder, interrupt }
        }

        fn path(&self, name: &str) -> PathBuf {
            self.folder.path().join(name)
        }

        fn run(&self, options: &[&str], numerics: &Numerics) -> Result<Exit, CliError> {
            let deck = self.path("job.inp");
            let out = self.path("out");
            let fixed = [
                "stickslip".as_ref(),
                "run".as_ref(),
                deck.as_os_str(),
                "-o".as_ref(),
                out.as_os_str(),
            ];
            let options = options.iter().map(|option| (*option).as_ref());
            let args = Args::try_parse_from(fixed.into_iter().chain(options)).expect("arguments");
            match args.command {
                Command::Run(args) => {
                    run(&args, "stickslip run job.inp", numerics, &self.interrupt)
                }
                other => panic!("{other:?}"),
            }
        }

        fn summary(&self) -> ResultSummary {
            ResultSummary::read(&self.path("out/job.vtkhdf")).expect("result")
        }

        fn log(&self) -> String {
            std::fs::read_to_string(self.path("out/job.log")).expect("log")
        }

        fn touched(&self) -> bool {
            Path::exists(&self.path("out"))
        }
    }

    fn code(result: &Result<Exit, CliError>) -> Exit {
        match result {
            Ok(exit) => *exit,
            Err(error) => error.exit(),
        }
    }

    #[test]
    fn a_run_to_the_end() {
        let bench = Bench::new();
        let exit = bench.run(&["-q"], &numerics());
        assert_eq!(code(&exit), Exit::Finished);
        let summary = bench.summary();
        assert_eq!((summary.exit_status, summary.increments), (0, 10));
        assert_eq!(summary.frames, [0.0, 1.0]);
        let log = bench.log();
        assert!(log.contains("warning: this is a test"), "{log}");
        assert!(log.contains("done     in"), "{log}");
        let warned = "warning  principal strain 0.210 in element 8 in increment 7\n";
        assert_eq!(log.matches("principal strain").count(), 1, "{log}");
        assert!(log.contains(warned), "{log}");
        let most = "strain   largest principal 3.00e-01 in element 8 in increment 10\n";
        assert!(log.contains(most), "{log}");
        let paths = ["wrote", "warning"];
        let mut lines = log
            .lines()
            .filter(|l| paths.iter().all(|p| !l.starts_with(p)));
        assert!(lines.all(|line| line.len() <= 80), "{log}");
    }

    #[test]
    fn the_command_line_wins_and_the_log_says_so() {
        let bench = Bench::new();
        let exit = bench.run(&["-q", "--frames", "5", "--solver", "sprs"], &numerics());
        assert_eq!(code(&exit), Exit::Finished);
        assert_eq!(bench.summary().frames.len(), 6);
        let log = bench.log();
        assert!(log.contains("output 5 frames as the command line says, not output 1 frame"));
        assert!(log.contains("solver sprs as the command line says, not faer"));
    }

    #[test]
    fn a_stop_leaves_the_last_good_state_and_says_where() {
        let bench = Bench::new();
        let solve = to_a_stop;
        let numerics = Numerics {
            solve,
            ..numerics()
        };
        let exit = bench.run(&["-q"], &numerics);
        assert_eq!(code(&exit), Exit::Stopped);
        let summary = bench.summary();
        assert_eq!((summary.exit_status, summary.increments), (1, 3));
        assert_eq!(summary.frames, [0.0, report(3).time]);
        let file = hdf5::File::open(bench.path("out/job.vtkhdf")).expect("result");
        let points = file.group("VTKHDF/PointData").expect("fields");
        for field in points.datasets().expect("fields") {
            assert_eq!(
                field.shape()[0],
                2 * 4,
                "{}: all of both frames",
                field.name()
            );
        }
        let log = bench.log();
        for text in [
            "cutback  increment 4 at 3.000e-01, dt 5.00e-02 -> 5.00e-02",
            "stopped  increment 4 of step 1 failed at time 3.000000e-01",
            "an element turned inside out",
            "worst    node 3 at (1.50000e+00, 2.50000e+00): force residual 2.50e-01",
            "element  8 with its centre at (1.50000e+00, 1.50000e+00)",
            "material St. Venant-Kirchhoff gives way at 58 % of its length",
            "tried    1 halving",
            "job.vtkhdf is valid up to its last frame",
            "time 3.000000e-01",
        ] {
            assert!(log.contains(text), "{text}\n{log}");
        }
    }

    #[test]
    fn a_stop_at_a_passage_names_the_node_and_the_segment() {
        let bench = Bench::new();
        let solve = to_a_passage;
        let numerics = Numerics {
            solve,
            ..numerics()
        };
        assert_eq!(code(&bench.run(&["-q"], &numerics)), Exit::Stopped);
        let log = bench.log();
        assert!(log.contains("a node went through a segment"), "{log}");
        let place = "node     4 at (1.00000e+00, 2.00000e+00) through the segment 1-2";
        assert!(log.contains(place), "{log}");
        let both = "both sides are prescribed: they are driven into each other";
        assert!(log.contains(both), "{log}");
    }

    #[test]
    fn an_unsolved_lcp_is_kept() {
        let bench = Bench::new();
        let solve = to_an_unsolved_lcp;
        let numerics = Numerics {
            solve,
            ..numerics()
        };
        let exit = bench.run(&["-q"], &numerics);
        assert_eq!(code(&exit), Exit::Stopped);
        let json = std::fs::read_to_string(bench.path("out/job-lcp-4.json")).expect("problem");
        assert_eq!(FrictionalLcp::from_json(&json), Ok(one_contact()));
        let log = bench.log();
        assert!(
            log.contains("pairs    node 4 on segment 1-2, node 4 on segment 1-2, "),
            "{log}"
        );
        assert!(log.contains("job-lcp-4.json holds the problem"), "{log}");
    }

    #[test]
    fn a_rejected_deck_touches_no_file() {
        let bench = Bench::new();
        let load = |_: &_, _, _| loaded(None);
        let exit = bench.run(&["-q"], &Numerics { load, ..numerics() });
        assert_eq!(code(&exit), Exit::Rejected);
        assert!(!bench.touched());
        let load = |_: &_, _, _| {
            let name = "A/B".into();
            let mut model = square();
            model.sets.elements = vec![Set {
                name,
                members: vec![0],
            }];
            loaded(Some(model))
        };
        let exit = bench.run(&["-q"], &Numerics { load, ..numerics() });
        assert_eq!(code(&exit), Exit::Rejected);
        assert!(!bench.touched());
    }

    #[test]
    fn a_full_disk_and_a_folder_that_cannot_be_made() {
        let bench = Bench::new();
        let solve = to_a_full_disk;
        let exit = bench.run(
            &["-q"],
            &Numerics {
                solve,
                ..numerics()
            },
        );
        assert_eq!(code(&exit), Exit::FileSystem);
        assert_eq!(bench.summary().exit_status, 4);
        let text = exit.expect_err("a full disk").to_string();
        let kept = "; the results up to time 0.000000e+00 are kept";
        assert!(
            text.starts_with("cannot write the results: ") && text.ends_with(kept),
            "{text}"
        );
        let bench = Bench::new();
        std::fs::write(bench.path("out"), "a file").expect("file");
        let exit = bench.run(&["-q"], &numerics());
        assert_eq!(code(&exit), Exit::FileSystem);
    }

    fn to_an_error_at_the_start(
        _: &PreparedModel,
        _: &mut dyn Observer,
    ) -> Result<RunSummary, RunError> {
        Err(RunError::Observer(io::ErrorKind::StorageFull.into()))
    }

    thread_local! {
        /// The signal that arrives while [`until_told`] solves.
        static INTERRUPT: (Interrupt, cell::Cell<i32>) = (Interrupt::default(), cell::Cell::new(0));
    }

    fn until_told(_: &PreparedModel, observer: &mut dyn Observer) -> Result<RunSummary, RunError> {
        for k in 0..=10 {
            if k == 3 {
                INTERRUPT.with(|(interrupt, signal)| interrupt.request(signal.get()));
            }
            if observer.wants_stop() {
                return Ok(summary(Outcome::Interrupted, k - 1));
            }
            observer.increment(&report(k)).map_err(RunError::Observer)?;
        }
        Ok(summary(Outcome::Finished, 10))
    }

    #[test]
    fn earlier_results_stay_until_the_first_frame() {
        let bench = Bench::new();
        assert_eq!(code(&bench.run(&["-q"], &numerics())), Exit::Finished);
        let read = |name: &str| std::fs::read(bench.path(name)).expect(name);
        let names = ["out/job.vtkhdf", "out/job.sta", "out/job.log"];
        let before = names.map(read);
        let solve = to_an_error_at_the_start;
        let fails = Numerics {
            solve,
            ..numerics()
        };
        let exit = bench.run(&["-q", "--overwrite"], &fails);
        assert_eq!(code(&exit), Exit::FileSystem);
        assert!(names.map(read) == before);
        assert!(!bench.path("out/job.vtkhdf.part").exists());
        // Without earlier results nothing is left at all.
        let bench = Bench::new();
        assert_eq!(code(&bench.run(&["-q"], &fails)), Exit::FileSystem);
        let left = std::fs::read_dir(bench.path("out")).expect("folder");
        assert_eq!(left.count(), 0);
    }

    #[test]
    fn what_a_killed_start_leaves_is_in_nobodys_way() {
        let bench = Bench::new();
        std::fs::create_dir(bench.path("out")).expect("folder");
        for name in ["out/job.log", "out/job.vtkhdf.part"] {
            std::fs::write(bench.path(name), "").expect(name);
        }
        assert_eq!(code(&bench.run(&["-q"], &numerics())), Exit::Finished);
        assert_eq!(bench.summary().frames, [0.0, 1.0]);
        assert!(!bench.path("out/job.vtkhdf.part").exists());
    }

    #[cfg(unix)]
    #[test]
    fn links_are_replaced_and_what_they_point_to_stays() {
        let bench = Bench::new();
        std::fs::create_dir(bench.path("out")).expect("folder");
        std::fs::write(bench.path("precious"), "precious").expect("file");
        for name in [
            "out/job.log",
            "out/job.sta",
            "out/job.vtkhdf",
            "out/job.vtkhdf.part",
        ] {
            std::os::unix::fs::symlink(bench.path("precious"), bench.path(name)).expect(name);
        }
        assert_eq!(code(&bench.run(&["-q"], &numerics())), Exit::FileSystem);
        assert_eq!(
            code(&bench.run(&["-q", "--overwrite"], &numerics())),
            Exit::Finished
        );
        let kept = std::fs::read_to_string(bench.path("precious")).expect("file");
        assert_eq!(
            (kept.as_str(), bench.summary().increments),
            ("precious", 10)
        );
    }

    #[test]
    fn an_interrupt_ends_the_run_with_a_frame_and_its_exit_code() {
        for (signal, wanted) in [
            (2, Exit::Interrupted),
            (15, Exit::Terminated),
            (1, Exit::HungUp),
        ] {
            let mut bench = Bench::new();
            bench.interrupt = INTERRUPT.with(|(interrupt, number)| {
                number.set(signal);
                interrupt.request(0);
                interrupt.clone()
            });
            let told = Numerics {
                solve: until_told,
                ..numerics()
            };
            assert_eq!(code(&bench.run(&["-q"], &told)), wanted);
            let summary = bench.summary();
            assert_eq!(summary.exit_status, wanted as i64);
            assert_eq!(summary.frames, [0.0, report(2).time]);
            let text = "asked for the end   increment 2 is the last";
            assert!(bench.log().contains(text), "{}", bench.log());
            // One that comes while the deck is read leaves nothing behind.
            let bench = Bench::new();
            bench.interrupt.request(signal);
            assert_eq!(code(&bench.run(&["-q"], &numerics())), wanted);
            assert!(!bench.touched());
        }
    }

    #[test]
    fn results_are_replaced_only_when_wanted() {
        let bench = Bench::new();
        std::fs::create_dir(bench.path("out")).expect("folder");
        std::fs::write(bench.path("out/job.sta"), "old").expect("old result");
        let exit = bench.run(&["-q"], &numerics());
        assert_eq!(code(&exit), Exit::FileSystem);
        assert!(exit.is_err_and(|error| error.to_string().contains("--overwrite")));
        let kept = std::fs::read_to_string(bench.path("out/job.sta")).expect("old result");
        assert_eq!(kept, "old");
        let exit = bench.run(&["-q", "--overwrite"], &numerics());
        assert_eq!(code(&exit), Exit::Finished);
        let exit = bench.run(&["-q", "--overwrite"], &numerics());
        assert_eq!(code(&exit), Exit::Finished);
    }
}
