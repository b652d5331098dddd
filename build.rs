//! Tells the program what it was built from: commit, profile and library versions.

use std::fs;
use std::process::Command;

/// Libraries named by `--version`.
const LIBRARIES: [&str; 7] = [
    "clap",
    "faer",
    "hdf5-metno",
    "nalgebra",
    "rayon",
    "sprs",
    "sprs-ldl",
];

fn main() {
    let profile = std::env::var("PROFILE").unwrap_or_default();
    println!("cargo:rustc-env=STICKSLIP_PROFILE={profile}");
    println!("cargo:rustc-env=STICKSLIP_COMMIT={}", commit());
    println!("cargo:rustc-env=STICKSLIP_LIBRARIES={}", libraries());
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=Cargo.lock");
    watch_commit();
}

/// The commit of the source, or `unknown` where there is no repository.
fn commit() -> String {
    git(&["rev-parse", "--short=7", "HEAD"]).unwrap_or_else(|| "unknown".into())
}

/// Builds anew when another commit is checked out.
fn watch_commit() {
    for name in ["HEAD", "logs/HEAD"] {
        if let Some(path) = git(&["rev-parse", "--git-path", name])
            && fs::exists(&path).unwrap_or(false)
        {
            println!("cargo:rerun-if-changed={path}");
        }
    }
}

fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    (output.status.success() && !text.trim().is_empty()).then(|| text.trim().to_owned())
}

/// `name version` of each library, from the lock file.
fn libraries() -> String {
    let lock = fs::read_to_string("Cargo.lock").unwrap_or_default();
    let found = LIBRARIES.map(|name| {
        let entry = format!("name = \"{name}\"\nversion = \"");
        let version = (lock.split(&entry).nth(1)).and_then(|rest| rest.split('"').next());
        format!("{name} {}", version.unwrap_or("?"))
    });
    found.join(";")
}
