//! Commands of the Python package: the program finds a Python that has the package and hands the command over to it.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::args::PackageCommand;
use super::error::{CliError, Exit};
use crate::system::hand_over;

/// The environment variable that names Python.
const PYTHON: &str = "STICKSLIP_PYTHON";

/// The environment variable that tells the package which program this is.
const PROGRAM: &str = "STICKSLIP";

/// Python code that ends with success if Python has the package; the option -P, with which it runs, needs Python 3.11.
const HAS_PACKAGE: &str =
    "import importlib.util, sys; sys.exit(importlib.util.find_spec('stickslip') is None)";

/// Runs a command of the package in place of this program.
pub(super) fn run(command: &PackageCommand) -> Result<Exit, CliError> {
    let (name, words) = command.words();
    let own = env::current_exe().and_then(fs::canonicalize).ok();
    let Some(python) = pythons(own.as_deref())
        .into_iter()
        .find(Python::has_package)
    else {
        return Err(CliError::NoPackage(name));
    };
    let mut command = python.command();
    command
        .args(["-m", "stickslip"])
        .args(name.split(' '))
        .args(words);
    if let Some(own) = own.filter(|_| env::var_os(PROGRAM).is_none()) {
        command.env(PROGRAM, own);
    }
    let source = hand_over(&mut command);
    Err(CliError::Python {
        path: python.path,
        source,
    })
}

/// A Python interpreter that may have the package.
struct Python {
    path: PathBuf,
    /// Folder of the package, if the package is not installed.
    package: Option<PathBuf>,
}

impl Python {
    fn new(path: impl Into<PathBuf>) -> Self {
        Python {
            path: path.into(),
            package: None,
        }
    }

    /// A command of the interpreter, which does not import modules from the current folder.
    fn command(&self) -> Command {
        let mut command = Command::new(&self.path);
        command.arg("-P");
        if let Some(package) = &self.package {
            let others = env::var_os("PYTHONPATH").filter(|path| !path.is_empty());
            let others = others.iter().flat_map(env::split_paths);
            let all = env::join_paths([package.clone()].into_iter().chain(others));
            command.env("PYTHONPATH", all.unwrap_or_else(|_| package.clone().into()));
        }
        command
    }

    fn has_package(&self) -> bool {
        let mut command = self.command();
        command
            .args(["-c", HAS_PACKAGE])
            .stdin(Stdio::null())
            .stdout(Stdio::null());
        command
            .stderr(Stdio::null())
            .status()
            .is_ok_and(|status| status.success())
    }
}

/// Interpreters that may have the package: only the interpreter named by STICKSLIP_PYTHON, if this variable is set.
/// Otherwise the interpreters of the checkout in which the program was built, next to the program, and on the search
/// path.
fn pythons(program: Option<&Path>) -> Vec<Python> {
    if let Some(named) = env::var_os(PYTHON).filter(|name| !name.is_empty()) {
        return vec![Python::new(named)];
    }
    let folder = program.and_then(Path::parent);
    let checkout = folder.and_then(|folder| folder.ancestors().nth(2));
    let package = checkout.map(|root| root.join("python"));
    let package = package.filter(|package| package.join("stickslip").is_dir());
    let names = ["python3", "python"].map(|name| format!("{name}{}", env::consts::EXE_SUFFIX));
    let mut found = Vec::new();
    if let (Some(root), Some(package)) = (checkout, package) {
        let own = ["bin", "Scripts"].map(|folder| root.join(".venv").join(folder));
        let paths = own
            .iter()
            .flat_map(|folder| names.iter().map(|name| folder.join(name)));
        let paths = paths.chain(names.iter().map(PathBuf::from));
        found.extend(paths.map(|path| Python {
            path,
            package: Some(package.clone()),
        }));
    }
    // on Windows Python is one folder above its scripts, but in environments
    let beside = folder
        .into_iter()
        .flat_map(|folder| folder.ancestors().take(2));
    found.extend(beside.flat_map(|folder| names.iter().map(|name| Python::new(folder.join(name)))));
    found.extend(names.iter().map(Python::new));
    found
}
