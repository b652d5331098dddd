# What the scripts share; sourced by them. Sets ROOT, FIRST_WORD and FEATURES.

ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
VENV="$ROOT/.venv"
# The first word behind the name of the script that sources this.
FIRST_WORD="${1:-}"
export PYTHONPATH="$ROOT/python${PYTHONPATH:+:$PYTHONPATH}"
FEATURES=()
# The program that `need_program` has built.
PROGRAM=""

fail() {
    echo "error: $*" >&2
    exit 1
}

say() {
    echo "-- $*" >&2
}

# Installs Debian packages if we may; false if we may not or if it fails.
debian_install() {
    [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null || return 1
    say "installing $*"
    local log
    log="$(mktemp)"
    if { apt-get update && DEBIAN_FRONTEND=noninteractive \
        apt-get install -y --no-install-recommends "$@"; } >"$log" 2>&1 </dev/null; then
        rm -f "$log"
    else
        tail -n 20 "$log" >&2
        rm -f "$log"
        return 1
    fi
}

need_rust() {
    command -v cargo >/dev/null ||
        fail "cargo is not found: install a Rust toolchain (https://rustup.rs) first"
    command -v cc >/dev/null || debian_install gcc libc6-dev ||
        fail "no C compiler (cc) is found: install one (Debian: gcc libc6-dev)"
}

have_hdf5() {
    [ -n "${HDF5_DIR:-}" ] && return
    [ -e /usr/include/hdf5/serial/hdf5.h ] || [ -e /usr/include/hdf5.h ] ||
        { command -v pkg-config >/dev/null && pkg-config --exists hdf5; }
}

# The HDF5 library: the system's; else installed; else built from source and linked in.
need_hdf5() {
    if ! have_hdf5 && ! debian_install libhdf5-dev; then
        say "no HDF5 library and no way to install it: building it from source (a few minutes)"
        FEATURES=(--features static-hdf5)
        need_cmake
    fi
}

need_cmake() {
    local version=0
    if command -v cmake >/dev/null; then
        version="$(cmake --version | sed -n 's/^cmake version //p')"
    fi
    if [ "$(printf '%s\n' 3.26 "$version" | sort -V | head -n 1)" != 3.26 ]; then
        need_venv "$ROOT/scripts/requirements-build.txt"
        PATH="$VENV/bin:$PATH"
    fi
}

# A virtual environment in .venv with the packages of the given list.
need_venv() {
    local list="$1" python="${PYTHON:-python3}" stamp
    stamp="$VENV/$(basename "$list").installed"
    cmp -s "$list" "$stamp" && return
    if ! "$python" -c 'import ensurepip, venv' 2>/dev/null; then
        debian_install python3 python3-venv ||
            fail "Python's venv module is missing: ask for the package python3-venv," \
                "or set PYTHON to an interpreter that has it"
    fi
    "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' ||
        fail "Python 3.11 or newer is needed ($("$python" --version) found);" \
            "set PYTHON to one"
    say "installing the packages of $(basename "$list") into .venv; this happens once and takes" \
        "about a minute"
    [ -x "$VENV/bin/python" ] || "$python" -m venv "$VENV" </dev/null ||
        fail "the virtual environment $VENV could not be made"
    local quiet=(--quiet)
    [ ! -t 2 ] || quiet=()
    "$VENV/bin/python" -m pip install "${quiet[@]}" --disable-pip-version-check \
        --requirement "$list" </dev/null >&2 ||
        fail "pip could not install the packages of $list"
    cp "$list" "$stamp"
}

# The libraries that the Python package gmsh loads, which a machine without a screen lacks.
need_gmsh() {
    "$VENV/bin/python" -c 'import gmsh' 2>/dev/null ||
        debian_install libglu1-mesa libgl1 libgomp1 libfontconfig1 libxcursor1 libxext6 \
            libxfixes3 libxft2 libxinerama1 libxrender1 ||
        fail "the Python package gmsh cannot be loaded: install its libraries" \
            "(Debian: libglu1-mesa libxcursor1 libxft2 libxinerama1)"
}

# The browser in which the report page is tested; without it these tests say that they are skipped.
need_browser() {
    command -v chromium >/dev/null || command -v google-chrome >/dev/null || debian_install chromium ||
        say "no Chromium: the tests of the report page in a browser are skipped"
}

# Builds the program, with cargo's progress on a terminal; sets PROGRAM to its path.
need_program() {
    PROGRAM="${CARGO_TARGET_DIR:-$ROOT/target}/release/stickslip"
    # the help of a script is told before anything is built
    case "$FIRST_WORD" in -h | --help) return ;; esac
    need_rust
    need_hdf5
    local quiet=(--quiet)
    [ ! -t 2 ] || quiet=()
    if [ -x "$PROGRAM" ]; then
        say "building (release) what has changed"
    else
        say "building (release); the first time this takes about six minutes of processor time," \
            "shared by $(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1) processors"
    fi
    (cd "$ROOT" && cargo build --release "${quiet[@]}" --locked "${FEATURES[@]}" </dev/null) ||
        fail "the build failed"
}

# Runs Python in .venv, with the program if the script has asked for it.
start() {
    need_venv "$ROOT/scripts/requirements.txt"
    export MPLBACKEND=Agg
    [ -z "${PROGRAM:-}" ] || export STICKSLIP="$PROGRAM"
    exec "$VENV/bin/python" "$@"
}
