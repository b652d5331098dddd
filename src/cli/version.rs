//! Identity of the build: version, commit, profile and libraries, recorded by `build.rs`, and the
//! licences of the libraries.

use std::sync::LazyLock;

/// Version of the program.
pub(super) const NUMBER: &str = env!("CARGO_PKG_VERSION");

/// Commit it was built from.
pub(super) const COMMIT: &str = env!("STICKSLIP_COMMIT");

/// Profile it was built with.
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

/// Licences of the libraries whose versions the build recorded.
const LICENCES: [(&str, &str); 7] = [
    ("clap", "MIT OR Apache-2.0"),
    ("faer", "MIT"),
    ("hdf5-metno", "MIT OR Apache-2.0"),
    ("nalgebra", "Apache-2.0"),
    ("rayon", "MIT OR Apache-2.0"),
    ("sprs", "MIT OR Apache-2.0"),
    ("sprs-ldl", "LGPL-2.1"),
];

/// [`VERSION`] and the libraries with versions and licences.
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
