//! The program's exit codes and what it prints, with the real binary.

use crate::writers::write_run;
use assert_cmd::Command;
use tempfile::TempDir;

/// HDF5's switch of file locks: a process that another test starts may inherit a file that is
/// being written here, and with it the lock.
const NO_LOCKS: (&str, &str) = ("HDF5_USE_FILE_LOCKING", "FALSE");

/// Exit code, standard output and standard error of the program.
pub fn stickslip(arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("stickslip").expect("binary");
    command.env(NO_LOCKS.0, NO_LOCKS.1);
    let output = command.args(arguments).output().expect("started");
    let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
    let code = output.status.code().expect("ended by itself");
    (code, text(&output.stdout), text(&output.stderr))
}

#[test]
fn help_and_version_are_no_errors() {
    let (code, out, _) = stickslip(&["--help"]);
    assert_eq!(code, 0);
    assert!(out.contains("check") && out.contains("Exit codes"), "{out}");
    let (code, out, _) = stickslip(&["-V"]);
    assert_eq!(code, 0);
    assert!(out.starts_with(concat!("stickslip ", env!("CARGO_PKG_VERSION"), " (")));
    let (code, out, _) = stickslip(&["--version"]);
    assert_eq!(code, 0);
    assert!(
        out.contains("sprs-ldl") && out.contains("LGPL-2.1"),
        "{out}"
    );
    assert!(out.contains("HDF5") && !out.contains('?'), "{out}");
}

#[test]
fn a_wrong_command_line_is_3() {
    for arguments in [
        &[] as &[&str],
        &["run"],
        &["walk", "x.inp"],
        &["run", "x.inp", "--frames", "0"],
        &["run", "x.inp", "--frames", "3", "--every", "0.1"],
        &["run", "x.inp", "--every", "-1"],
        &["run", "x.inp", "--every", "nan"],
        &["run", "x.inp", "--solver", "cholmod"],
        &["run", "x.inp", "--threads", "0"],
        &["run", "x.inp", "-q", "-v"],
    ] {
        let (code, out, err) = stickslip(arguments);
        assert_eq!((code, out.as_str()), (3, ""), "{arguments:?}");
        assert!(!err.is_empty());
    }
}

#[test]
fn a_missing_file_is_4() {
    for command in ["run", "check", "flatten", "info"] {
        let (code, out, err) = stickslip(&[command, "no/such/file"]);
        assert_eq!((code, out.as_str()), (4, ""), "{command}: {err}");
        assert!(err.starts_with("error: cannot read"), "{err}");
        assert!(err.contains("no/such/file"), "{err}");
    }
}

#[test]
fn check_echoes_the_model_and_draws_it() {
    let folder = TempDir::new().expect("folder");
    let picture = folder.path().join("model.svg").display().to_string();
    let window: &[&str] = &["--overwrite", "--window", "-1,0.5,0,1e1"];
    for more in [&[][..], &["--overwrite"], window] {
        let check = ["check", "tests/decks/shared.inp", "--picture", &picture];
        let (code, out, _) = stickslip(&[&check[..], more].concat());
        assert_eq!(code, 0);
        for text in [
            "10 nodes   3 elements (CPE4)   20 dofs, 6 fixed   mass 4.68e-08",
            "extents [0,4] x [0,2.1]   shortest edge 1   wave speed 6.02e+06",
            "guide    dt 1.7e-07 for waves and impacts:",
            "the model in 7.5e-07",
            "for slow motion as long as the motion allows",
        ] {
            assert!(out.contains(text), "{text}:\n{out}");
        }
    }
    let drawn = std::fs::read_to_string(&picture).expect("a picture");
    assert!(drawn.starts_with("<svg") && drawn.ends_with("</svg>\n"));
    let deck = ["check", "tests/decks/shared.inp", "--picture", "shared.inp"];
    assert_eq!(stickslip(&deck).0, 3, "not the name of a picture");
    let nowhere = [
        "check",
        "tests/decks/shared.inp",
        "--picture",
        "no/such/a.svg",
    ];
    let (code, _, err) = stickslip(&nowhere);
    assert_eq!(code, 4);
    assert!(err.contains("cannot write no/such/a.svg"), "{err}");
}

#[test]
fn flatten_writes_a_deck_that_is_written_the_same_again() {
    let folder = TempDir::new().expect("folder");
    let flat = folder.path().join("flat.inp").display().to_string();
    let (code, text, err) = stickslip(&["flatten", "tests/decks/folder.inp"]);
    assert_eq!((code, err.as_str()), (0, ""));
    assert!(!text.contains("INCLUDE"), "{text}");
    let write = ["flatten", "tests/decks/folder.inp", "-o", &flat];
    assert_eq!(stickslip(&write), (0, String::new(), String::new()));
    assert_eq!(std::fs::read_to_string(&flat).expect("a deck"), text);
    assert_eq!(stickslip(&["flatten", &flat]).1, text);
    let overwrite = [&write[..], &["--overwrite"]].concat();
    assert_eq!(stickslip(&overwrite), (0, String::new(), String::new()));
    assert_eq!(std::fs::read_to_string(&flat).expect("a deck"), text);
    let (code, out, err) = stickslip(&["flatten", "tests/decks/missing_include.inp"]);
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(err.contains("D101"), "{err}");
}

#[test]
fn what_exists_is_replaced_only_where_it_is_asked_for() {
    let folder = TempDir::new().expect("folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (deck, drawn, flat) = ("tests/decks/shared.inp", path("a.svg"), path("a.inp"));
    for (file, command) in [
        (&drawn, ["check", deck, "--picture", &drawn]),
        (&flat, ["flatten", deck, "-o", &flat]),
    ] {
        std::fs::write(file, "precious").expect("an earlier file");
        let (code, _, err) = stickslip(&command);
        let told = format!("error: {file} exists already; --overwrite replaces it\n");
        assert!(code == 4 && err.ends_with(&told), "{code}: {err}");
        assert_eq!(std::fs::read(file).expect("the file"), b"precious");
        let overwrite = [&command[..], &["--overwrite"]].concat();
        assert_eq!(stickslip(&overwrite).0, 0);
        assert_ne!(std::fs::read(file).expect("the file"), b"precious");
        std::fs::remove_file(file).expect("a file");
        std::fs::create_dir(file).expect("a folder");
        let (code, _, err) = stickslip(&overwrite);
        assert_eq!(code, 4);
        assert!(err.contains("it is not a regular file"), "{err}");
    }
    assert_eq!(
        std::fs::read_dir(folder.path()).expect("a folder").count(),
        2,
        "no drafts"
    );
}

#[test]
fn all_commands_refuse_the_same_decks() {
    let folder = TempDir::new().expect("folder");
    let deck = folder.path().join("a.inp").display().to_string();
    let square = include_str!("../decks/square.inp");
    let shared = include_str!("../decks/shared.inp");
    for (text, told) in [
        (
            square.replace("FOOT", "\"A/B\""),
            "'A/B' cannot stand in the result file",
        ),
        (shared.replace("11, 1., 1.1", "11, 1., 0.99"), "D410"),
    ] {
        std::fs::write(&deck, text).expect("a deck");
        for command in ["check", "flatten", "run"] {
            let output = folder.path().display().to_string();
            let options = ["-o", output.as_str()];
            let options = if command == "run" { &options[..] } else { &[] };
            let (code, _, err) = stickslip(&[&[command, deck.as_str()][..], options].concat());
            assert_eq!(code, 2, "{command}: {err}");
            assert!(err.contains(told), "{command}: {err}");
        }
    }
}

#[test]
fn threads_are_bounded_by_the_processors() {
    let (code, out, err) = stickslip(&["run", "tests/decks/drop.inp", "--threads", "20000"]);
    assert_eq!((code, out.as_str()), (3, ""));
    assert!(
        err.contains("at most") && err.contains("4 for each"),
        "{err}"
    );
    let processors = std::thread::available_parallelism().map_or(1, |n| n.get());
    let folder = TempDir::new().expect("folder");
    let (output, most) = (
        folder.path().display().to_string(),
        (4 * processors).to_string(),
    );
    let run = [
        "run",
        "tests/decks/drop.inp",
        "-q",
        "-o",
        &output,
        "--threads",
        &most,
    ];
    assert_eq!(stickslip(&run), (0, String::new(), String::new()));
    let mut command = Command::cargo_bin("stickslip").expect("binary");
    let command = command.args([
        "run",
        "tests/decks/drop.inp",
        "-q",
        "--overwrite",
        "-o",
        &output,
    ]);
    command
        .env("RAYON_NUM_THREADS", "20000")
        .env(NO_LOCKS.0, NO_LOCKS.1)
        .assert()
        .success();
}

#[test]
fn info_describes_a_result_file() {
    let folder = TempDir::new().expect("folder");
    let files = write_run(folder.path());
    let (code, out, _) = stickslip(&["info", &files.result.to_string_lossy()]);
    assert_eq!(code, 0);
    for text in [
        "7 nodes   3 elements",
        "1 step   10 increments   time 1   6 frames from 0 to 1",
        "exit status 0",
        "BOTTOM_TOP_2, largest normal force 20",
        "energy balance 1.0e-12",
    ] {
        assert!(out.contains(text), "{text}\n{out}");
    }
    let (code, _, err) = stickslip(&["info", &files.log.to_string_lossy()]);
    assert_eq!(code, 4);
    assert!(err.contains("is not a result file"), "{err}");
}

/// A fifo would wait for its writer, and a device never ends.
#[cfg(unix)]
#[test]
fn what_is_no_regular_file_is_4() {
    let folder = TempDir::new().expect("folder");
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let made = Command::new("mkfifo")
        .args([path("fifo"), path("out.log")])
        .ok();
    made.expect("fifo");
    // files like the last one, which the system makes up, may wait for an event
    let inputs = [
        path("fifo"),
        "/dev/null".into(),
        path("."),
        "/proc/version".into(),
    ];
    for (input, command) in inputs
        .iter()
        .flat_map(|i| ["run", "check", "info", "lcp"].map(|c| (i, c)))
    {
        let (code, out, err) = stickslip(&[command, input]);
        assert_eq!((code, out.as_str()), (4, ""), "{command} {input}: {err}");
        let told = err.contains("not a regular file") || err.contains("directory");
        assert!(
            told && err.contains(input.as_str()),
            "{command} {input}: {err}"
        );
    }
    for included in [path("fifo"), "/proc/version".into()] {
        let deck = format!("*HEADING\n*INCLUDE, INPUT={included}\n");
        std::fs::write(path("deck.inp"), deck).expect("deck");
        let (code, _, err) = stickslip(&["check", &path("deck.inp")]);
        assert_eq!(code, 2);
        assert!(
            err.contains("deck.inp:2:") && err.contains("not a regular file"),
            "{err}"
        );
    }
    std::fs::copy("tests/decks/drop.inp", path("out.inp")).expect("deck");
    let (code, _, err) = stickslip(&["run", &path("out.inp"), "-o", &path("."), "--overwrite"]);
    assert_eq!(code, 4);
    assert!(err.contains("out.log: it is not a regular file"), "{err}");
    std::fs::remove_file(path("out.log")).expect("fifo");
    for name in ["out.sta", "out.vtkhdf"] {
        std::fs::create_dir(path(name)).expect("folder");
        let arguments = ["run", &path("out.inp"), "-o", &path("."), "--overwrite"];
        let (code, _, err) = stickslip(&arguments);
        assert_eq!(code, 4);
        assert!(
            err.contains(name) && err.contains("not a regular file"),
            "{err}"
        );
        assert!(!folder.path().join("out.log").exists());
        std::fs::remove_dir(path(name)).expect("folder");
    }
}

#[test]
fn a_file_without_lines_is_an_error_at_once() {
    let folder = TempDir::new().expect("folder");
    let path = folder
        .path()
        .join("deck.inp")
        .to_string_lossy()
        .into_owned();
    let file = std::fs::File::create(&path).expect("deck");
    // A sparse terabyte of zeros.
    file.set_len(1 << 40).expect("sparse");
    let (code, _, err) = stickslip(&["check", &path]);
    assert_eq!(code, 2);
    assert!(
        err.contains("D121") && err.contains("deck.inp:1:1"),
        "{err}"
    );
    let mut text = b"*HEADING\n*NODE, NSET=".to_vec();
    text.resize(1 << 22, b'A');
    std::fs::write(&path, text).expect("deck");
    let (code, _, err) = stickslip(&["check", &path]);
    assert_eq!(code, 2);
    assert!(
        err.contains("D122") && err.contains("deck.inp:2:65537"),
        "{err}"
    );
    assert!(err.len() < 2000, "{}", err.len());
    let text = format!("*HEADING\n*{}\n", "A".repeat(65_000));
    std::fs::write(&path, text).expect("deck");
    let (code, _, err) = stickslip(&["check", &path]);
    assert_eq!(code, 2);
    assert!(err.contains("D103") && err.len() < 4000, "{}", err.len());
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_is_no_panic() {
    let folder = TempDir::new().expect("folder");
    let files = write_run(folder.path());
    let script = format!(
        "'{}' info '{}' | true; exit ${{PIPESTATUS[0]}}",
        env!("CARGO_BIN_EXE_stickslip"),
        files.result.display()
    );
    let output = Command::new("bash")
        .env(NO_LOCKS.0, NO_LOCKS.1)
        .args(["-c", &script])
        .output()
        .expect("bash");
    assert!(output.stderr.is_empty(), "{output:?}");
    assert_eq!(output.status.code(), Some(0));
}
