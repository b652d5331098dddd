"""Histories by name: `energy/kinetic`, `contact/A_B/force:1`, `nodes/TIP[3]/U:2`.

A name is the path of a dataset below /history (see docs/output.md). After a colon stands the
component of a vector, from 1. After the name of a node set may stand the number of one of its
nodes in brackets; without it displacements and velocities are means over the set, reactions sums.
The same holds of element sets, `elements/BLOCK[7]/S:1`: means of stresses and strains, sums of energies.
These names hold too where a result has only the sums and means of a set (`TOTALS=ONLY`).
Of the histories of bodies, `bodies/velocity[0]:1`, the number in brackets is that of the body.
"""

import re
from dataclasses import dataclass

import numpy as np

from stickslip.errors import Fault
from stickslip.result import Array, Result

NAME = re.compile(r"(?P<path>[^:]*)(?::(?P<component>\d+))?")
SETS = re.compile(
    r"(?P<kind>node|element)s/(?P<set>[^/]+?)(?:\[(?P<member>-?\d+)\])?/(?P<field>\w+)"
)
SUMS = ("RF", "ELSE", "ELKE")
"""Histories of the members of a set that are added up."""
BODIES = re.compile(r"(?P<path>.+)\[(?P<body>\d+)\]")

PER_BODY = re.compile(r"bodies/\w+|contact/.+/body_\w+")
"""Histories with one column for each body."""

MEMBERS = re.compile(r"(nodes|elements)/[^/]+/\w+")
"""Histories with one column for each member of a set."""

DIRECTIONS = ("x", "y")
"""Names of the components of a vector in the plane."""


@dataclass(frozen=True)
class Quantity:
    """A named history: what it is, and its components."""

    quantity: str
    """What it is and of what; the title of its axis."""
    parts: dict[str, Array]
    """Values [I] by the name of the component; one without a name for a scalar."""

    @property
    def title(self) -> str:
        """Title of an axis; a single component is part of it."""
        component = next(iter(self.parts)) if self.alone else ""
        return f"{self.quantity}, {component}" if component else self.quantity

    @property
    def alone(self) -> bool:
        """Whether there is one component only."""
        return len(self.parts) == 1


def find(result: Result, name: str) -> Quantity:
    """The history of this name; a Fault says which there are when there is none."""
    matched = NAME.fullmatch(name)
    if matched is None:
        raise Fault(f"{name} is no name of a history: such are energy/kinetic, nodes/TIP/U:2")
    data, quantity = _selected(result, matched["path"])
    component = matched["component"]
    if data.ndim == 1:
        if component is not None:
            raise Fault(f"{matched['path']} has no components: leave out the :{component}")
        return Quantity(quantity, {"": data})
    if data.ndim != 2:
        raise Fault(f"{name}: say of which, as in {matched['path']}[0]")
    bodies = PER_BODY.fullmatch(matched["path"]) is not None
    names = [f"body {i}" if bodies else str(i + 1) for i in range(data.shape[1])]
    if len(names) == len(DIRECTIONS) and not bodies:
        names = list(DIRECTIONS)
    parts = dict(zip(names, data.T))
    if component is None:
        return Quantity(quantity, parts)
    if not 1 <= int(component) <= len(parts):
        raise Fault(f"{matched['path']} has the components 1 to {len(parts)}, not {component}")
    chosen = names[int(component) - 1]
    return Quantity(quantity, {chosen: parts[chosen]})


def listed(result: Result) -> list[str]:
    """All names of histories, with their components."""
    names = []
    for path, data in result.histories.items():
        each = "[BODY]" if PER_BODY.fullmatch(path) else ""
        columns = each or path.startswith("elements/") and MEMBERS.fullmatch(path)
        plain = data.ndim == (2 if columns else 1)
        names.append(f"{path}{each}" if plain else f"{path}{each}:1 to :{data.shape[-1]}")
    return sorted(names)


def _selected(result: Result, path: str) -> tuple[Array, str]:
    """Values [I] or [I, components] of a path with its brackets, and what they are."""
    if path not in result.histories:
        plain = re.sub(r"\[-?\d+\]", "", path)
        for pattern, select in ((SETS, _of_member), (BODIES, _of_body)):
            matched = pattern.fullmatch(path)
            if matched and plain in result.histories:
                return select(result, plain, matched)
        for kind in ("mean", "sum"):
            place, _, field = path.rpartition("/")
            if f"{place}/{kind}/{field}" in result.histories:
                return _selected(result, f"{place}/{kind}/{field}")
        raise Fault(f"{result.path} has no history {path}: {_alternatives(result, plain)}")
    matched, data = SETS.fullmatch(path), result.history[path]
    if matched and data.ndim > 1:
        return _of_set(data, _description(result, path), matched)
    place = path.rpartition("/")[0].partition("/")[2]
    return data, ", ".join(filter(None, (_description(result, path), place)))


def _of_set(data: Array, what: str, matched: re.Match[str]) -> tuple[Array, str]:
    """Mean of a set, or the sum for forces and energies."""
    name = matched["set"]
    if data.shape[1] == 1:
        return data[:, 0], f"{what} of {name}"
    if matched["field"] in SUMS:
        return data.sum(axis=1), f"{what}, sum over {name}"
    return data.mean(axis=1), f"{what}, mean over {name}"


def _of_member(result: Result, path: str, matched: re.Match[str]) -> tuple[Array, str]:
    """One node or element of a set."""
    kind, member = matched["kind"], matched["member"]
    labels = result.read(f"history/{kind}s/{matched['set']}/labels")
    at = np.flatnonzero(labels == int(member))
    if len(at) == 0:
        raise Fault(f"{kind} {member} is not in {matched['set']}: {_few(labels)}")
    what = _description(result, path)
    return result.history[path][:, at[0]], f"{what} of {kind} {member}"


def _of_body(result: Result, path: str, matched: re.Match[str]) -> tuple[Array, str]:
    """One body of a history that has one column for each."""
    data, body = result.history[path], int(matched["body"])
    if data.ndim < 2 or body >= data.shape[1]:
        count = data.shape[1] if data.ndim > 1 else 0
        raise Fault(f"{path} has {count} bodies, counted from 0: there is no [{body}]")
    return data[:, body], f"{_description(result, path)}, body {body}"


def _description(result: Result, path: str) -> str:
    """What a dataset says it is, without the explanation after a colon."""
    if path == "time":
        return path
    text = result.histories[path].attrs.get("description", path)
    return str(text).partition(":")[0]


def _alternatives(result: Result, path: str) -> str:
    """What there is where the path leaves what exists."""
    there = ""
    for part in path.split("/"):
        deeper = f"{there}{part}/"
        if not any(name.startswith(deeper) for name in result.histories):
            break
        there = deeper
    below = [name[len(there) :] for name in result.histories if name.startswith(there)]
    names = ", ".join(sorted({name.partition("/")[0] for name in below}))
    return f"{there.rstrip('/')} has {names}" if there else f"there are {names}"


def _few(labels: np.ndarray) -> str:
    """The first numbers of a set."""
    more = f" and {len(labels) - 12} more" if len(labels) > 12 else ""
    return f"there are {', '.join(map(str, labels[:12]))}{more}"
