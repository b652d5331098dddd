"""Writes LICENSE-THIRD-PARTY: the libraries that the program of a wheel contains, with the texts of their licences.

scripts/venv scripts/licences.py
"""

import json
import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
FILE = ROOT / "LICENSE-THIRD-PARTY"

PREFERRED = ("MIT", "Apache-2.0")
"""Of several licences that a library offers, the first of these applies."""

BUNDLED = {
    "HDF5": ("hdf5-metno-src", "ext/hdf5/LICENSE"),
    "zlib": ("libz-sys", "src/zlib/LICENSE"),
}
"""Libraries in C inside of packages: the package, and the file with the licence."""

HEAD = """\
The program of a wheel of stickslip contains the libraries below, which have other authors and licences. Their sources are
in the public registry of Rust. Of several licences that a library offers, MIT applies, or else Apache-2.0.

sprs-ldl is under the LGPL 2.1: you may change it and build the program with what you have changed (docs/install.md).
"""

COPYRIGHT = re.compile(r"\W*(copyright\W*(\(c\)|©|\d{4})|\(c\) *\d{4}).*", flags=re.IGNORECASE)
"""A line that names who has the rights."""


def linked(*options: str) -> list[dict[str, Any]]:
    """Packages that the program is linked from, but those of this project, as cargo describes them."""
    command = ["cargo", "metadata", "--format-version", "1", "--locked", *options]
    command += ["--filter-platform", "x86_64-unknown-linux-gnu"]
    done = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)
    found = json.loads(done.stdout)
    nodes = {node["id"]: node for node in found["resolve"]["nodes"]}
    waiting, reached = [found["resolve"]["root"]], set()
    while waiting:
        package = waiting.pop()
        if package not in reached:
            reached.add(package)
            needs = nodes[package]["deps"]
            waiting += [d["pkg"] for d in needs if any(k["kind"] is None for k in d["dep_kinds"])]
    packages = [p for p in found["packages"] if p["id"] in reached and p["source"]]
    return sorted(packages, key=lambda package: (package["name"], package["version"]))


def licence_of(package: dict[str, Any]) -> str:
    """The licence that applies."""
    offered = package["license"] or "MIT OR Apache-2.0"  # hdf5-metno-src leaves out that of its workspace
    for name in PREFERRED:
        if name in re.split(r" OR |/", offered):
            return name
    return offered


def texts_of(package: dict[str, Any], licence: str) -> list[str]:
    """The texts of the licence in a package: those of the files named after it, else of all."""
    folder = Path(package["manifest_path"]).parent
    files = sorted(path for path in folder.iterdir() if re.match("LICEN[CS]E|COPYING|NOTICE", path.name, re.I))
    files = [path for path in files if path.is_file()]
    short = licence.partition("-")[0].upper()
    named = [path for path in files if short in path.name.upper()]
    return [path.read_text(encoding="utf-8", errors="replace") for path in named or files]


def key(text: str) -> str:
    """What is equal in texts of one licence: words without the lines of its holders."""
    lines = [line for line in text.splitlines() if not COPYRIGHT.fullmatch(line)]
    return " ".join(re.sub(r"\W+", " ", " ".join(lines)).lower().split())


def document() -> str:
    """The whole file."""
    packages = linked("--features", "static-hdf5")
    rows = [f"{p['name']} {p['version']}: {licence_of(p)}" for p in packages]
    parts = [HEAD, "\n".join(rows) + "\n"]
    by_name = {package["name"]: Path(package["manifest_path"]).parent for package in packages}
    for name, (package, file) in BUNDLED.items():
        parts.append(f"{name}\n\n{(by_name[package] / file).read_text()}")
    texts: dict[str, str] = {}
    holders: dict[str, list[str]] = defaultdict(list)
    for package in packages:
        for text in texts_of(package, licence_of(package)):
            same = key(text)
            texts.setdefault(same, text)
            lines = [line.strip() for line in text.splitlines() if COPYRIGHT.fullmatch(line)]
            holders[same].append("; ".join([package["name"], *dict.fromkeys(lines)]))
    for same, text in texts.items():
        body = [line.rstrip() for line in text.splitlines() if not COPYRIGHT.fullmatch(line)]
        parts.append("\n".join(dict.fromkeys(holders[same])) + "\n\n" + "\n".join(body).strip("\n") + "\n")
    rule = "\n" + 80 * "=" + "\n\n"
    return rule.join(parts)


def main() -> None:
    """Writes the file."""
    FILE.write_text(document(), encoding="utf-8")
    print(f"wrote {FILE.relative_to(ROOT)}", file=sys.stderr)


if __name__ == "__main__":
    main()
