"""Modules of Python import one way: no circle, not even through imports within functions or for annotations."""

import ast
from collections import deque
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from conftest import ROOT

Imports = Mapping[str, Mapping[str, str]]
"""Modules that each module imports, with the place of the import."""


def modules(root: Path) -> dict[str, Path]:
    """The files below a folder of the search path, by the names under which they are imported."""
    found = {}
    for path in sorted(root.rglob("*.py")):
        parts = path.relative_to(root).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imports(root: Path) -> dict[str, dict[str, str]]:
    """All imports among the modules below a folder, wherever they stand in a file."""
    files = modules(root)
    found: dict[str, dict[str, str]] = {}
    for name, path in files.items():
        package = name if path.name == "__init__.py" else name.rpartition(".")[0]
        found[name] = {}
        for node in ast.walk(ast.parse(path.read_text())):
            for target in imported(node, package, files):
                if target in files and target != name:
                    found[name].setdefault(target, f"{path.relative_to(root)}:{node.lineno}")
    return found


def imported(node: ast.AST, package: str, files: Mapping[str, Path]) -> Iterator[str]:
    """The modules that a statement imports: `from a import b` the module `a.b`, or else `a`."""
    if isinstance(node, ast.Import):
        yield from (one.name for one in node.names)
    elif isinstance(node, ast.ImportFrom):
        above = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
        base = ".".join([*above, *([node.module] if node.module else [])])
        for one in node.names:
            inner = f"{base}.{one.name}"
            yield inner if inner in files else base


def circle(start: str, found: Imports) -> list[str]:
    """A shortest circle of imports through a module; empty if there is none."""
    before: dict[str, str] = {}
    queue = deque([start])
    while queue and start not in before:
        name = queue.popleft()
        for target in found[name]:
            if target not in before:
                before[target] = name
                queue.append(target)
    if start not in before:
        return []
    backwards = [start, before[start]]
    while backwards[-1] != start:
        backwards.append(before[backwards[-1]])
    return backwards[::-1]


def described(found: Imports) -> list[str]:
    """The circles in words, each with the lines that import."""
    texts = []
    for name in found:
        path = circle(name, found)
        lines = [f"    {found[a][b]} imports {b}" for a, b in zip(path, path[1:])]
        texts += ["\n".join([" -> ".join(path), *lines])] if path else []
    return texts


def between_folders(found: Imports, package: str) -> dict[str, dict[str, str]]:
    """The imports among what lies directly in a package: its folders as wholes, and its modules."""

    def part(name: str) -> str:
        return ".".join(name.split(".")[:2])

    parts: dict[str, dict[str, str]] = {}
    for name, targets in found.items():
        if name.startswith(f"{package}."):
            inner = parts.setdefault(part(name), {})
            for target, place in targets.items():
                if target.startswith(f"{package}.") and part(target) != part(name):
                    inner.setdefault(part(target), place)
    return parts


@pytest.mark.parametrize("folder", ["python", "scripts", "tests", "tests/python", "verification"])
def test_modules_import_one_way(folder: str) -> None:
    """No circle among the modules that are imported from a folder."""
    found = imports(ROOT / folder)
    assert any(found.values())
    assert not (circles := described(found)), "\n".join(circles)


def test_folders_of_the_package_import_one_way() -> None:
    """No circle among the folders of the package, each taken as a whole."""
    parts = between_folders(imports(ROOT / "python"), "stickslip")
    assert {"stickslip.certificate", "stickslip.report", "stickslip.result"} <= parts.keys()
    assert not (circles := described(parts)), "\n".join(circles)


def test_array_names_have_one_definition() -> None:
    """The names of arrays are imported from where they are defined, not through other modules."""
    names, home = {"Array", "Integers", "Flags"}, "stickslip.arrays"
    for folder in ("python", "scripts", "tests", "verification"):
        for path in sorted((ROOT / folder).rglob("*.py")):
            for node in ast.walk(ast.parse(path.read_text())):
                if isinstance(node, ast.ImportFrom) and node.module != home:
                    through = names & {one.name for one in node.names}
                    assert not through, f"{path}:{node.lineno} imports {through} not from {home}"


@pytest.mark.parametrize(
    "line",
    [
        "from package.a import value",
        "from package import a",
        "import package.a",
        "from . import a",
        "from .a import value",
        "def late():\n    from package.a import value",
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from package.a import value",
    ],
)
def test_a_circle_is_found(line: str, tmp_path: Path) -> None:
    """A circle of three modules is told with its lines, however the last import is written."""
    package = tmp_path / "package"
    package.mkdir()
    (package / "__init__.py").write_text("")
    (package / "a.py").write_text("from package import b\nvalue = 1\n")
    (package / "b.py").write_text("import package.c\n")
    (package / "c.py").write_text(f"{line}\n")
    (package / "d.py").write_text("from package import a\n")  # not on the circle
    texts = described(imports(tmp_path))
    assert len(texts) == 3
    assert texts[0].splitlines()[:3] == [
        "package.a -> package.b -> package.c -> package.a",
        "    package/a.py:1 imports package.b",
        "    package/b.py:1 imports package.c",
    ]
    (package / "c.py").write_text("value = 2\n")
    assert described(imports(tmp_path)) == []
