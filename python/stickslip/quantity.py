"""Histories by name: `energy/kinetic`, `contact/A_B/force:1`, `nodes/TIP[3]/U:2`.

A name is the path of a dataset below /history (see docs/output.md). The component of a vector stands after a colon and
counts from 1. The number of one node may follow the name of a node set in brackets; without this number, displacements
and velocities are means over the set, and reactions are sums. Element sets work in the same way,
`elements/BLOCK[7]/S:1`; without a number, stresses and strains are means, and energies are sums. The names without a
number also work if a result has only sums and means of a set (`TOTALS=ONLY`). Values at integration points,
`elements/BLOCK/points[7.2]/S:1`, have the element and the number of the point in brackets; springs and dashpots,
`connectors[9]/force`, have their element, and hinges, `hinges[3-4]/force:1`, their two nodes. In histories of bodies,
`bodies/velocity[0]:1`, the number in brackets is the number of the body. Names of Abaqus are also allowed:
`nodes/TIP/U2` and `elements/BLOCK/S11` (see `fields`).
"""

import re
from dataclasses import dataclass

import numpy as np

from stickslip.arrays import Array
from stickslip.errors import Fault
from stickslip.fields import directions, known
from stickslip.result_file import ResultFile

NAME = re.compile(r"(?P<path>[^:]*)(?::(?P<component>\d+))?")
OF_MEMBER = re.compile(r"(?P<place>.+)\[(?P<member>[-\d.]+)\]/(?P<field>\w+)")
PLACES = re.compile(
    r"nodes/(?P<nodes>[^/]+)|elements/(?P<elements>[^/]+?)(?:/(?P<within>points|at_nodes))?"
    r"|(?:rotary_)?connectors|(?P<hinges>hinges)"
)
"""Groups whose histories have one column for each member, of which their `labels` tell."""
SUMS = ("RF", "ELSE", "ELKE", "ELHE")
"""Histories of the members of a set that are added up."""
FORCES = ("force", "RF", "CF")
"""Histories of rigid surfaces and node sets that are forces on them."""
LEAST_WORK = 1e-3
"""A force that does less than this part of the largest work does not move what it acts on."""
BODIES = re.compile(r"(?P<path>.+)\[(?P<body>\d+)\]")

PER_BODY = re.compile(r"bodies/\w+|contact/.+/body_\w+")
"""Histories with one column for each body."""

@dataclass(frozen=True)
class Quantity:
    """A history with its name, description and components."""

    quantity: str
    """What it is and of what; the title of its axis."""
    parts: dict[str, Array]
    """Values [I] by the name of the component; one without a name for a scalar."""

    @property
    def title(self) -> str:
        """Title of an axis; the title includes the name of a single component."""
        component = next(iter(self.parts)) if self.alone else ""
        return f"{self.quantity}, {component}" if component else self.quantity

    @property
    def alone(self) -> bool:
        """Whether the history has only one component."""
        return len(self.parts) == 1


def find(result: ResultFile, name: str) -> Quantity:
    """The history with a given name; if no history has this name, a Fault lists the names that exist."""
    place, slash, field = name.rpartition("/")
    matched = NAME.fullmatch(place + slash + known(field, {path.rpartition("/")[2] for path in result.histories}))
    if matched is None:
        raise Fault(f"{name} is no name of a history: such are energy/kinetic, nodes/TIP/U:2")
    path, component = matched["path"], matched["component"]
    data, quantity = _selected(result, path)
    if data.ndim == 1:
        if component is not None:
            raise Fault(f"{path} has no components: leave out the :{component}")
        return Quantity(quantity, {"": data})
    each = Members.of(result, path)
    if data.ndim != 2:
        raise Fault(f"{name}: say of which, as in {each.paths[0]}")
    columns = [] if each.is_set else [f"{each.kind} {one}" for one in each.names]
    names = columns or directions(data.shape[1], result.is_axisymmetric)
    parts = dict(zip(names, data.T))
    if component is None:
        return Quantity(quantity, parts)
    if not 1 <= int(component) <= len(parts):
        raise Fault(f"{path} has the components 1 to {len(parts)}, not {component}")
    chosen = names[int(component) - 1]
    return Quantity(quantity, {chosen: parts[chosen]})


def force_against_displacement(result: ResultFile) -> list[tuple[str, str]]:
    """Names of the displacements of rigid surfaces and node sets that a force moves, and of the forces in the same
    directions.

    The displacement whose force does the largest work comes first.
    """
    places = {re.sub(r"(/mean|/sum)?/[^/]*$", "", path) for path in result.histories}
    works: dict[tuple[str, str], float] = {}
    for place in sorted(place for place in places if re.fullmatch("(rigid|nodes)/[^/]+", place)):
        for field in FORCES:
            moved, force = (_stored(result, place, name) for name in ("U", field))
            if moved is None or force is None or moved.shape != force.shape:
                continue
            # of every node, since those of a set that are held do not move
            work = np.abs(np.nan_to_num(force[1:])) * np.abs(np.diff(np.nan_to_num(moved), axis=0))
            sums = work.reshape(-1, work.shape[-1]).sum(axis=0)
            works |= {(f"{place}/U:{k}", f"{place}/{field}:{k}"): float(sums[k - 1]) for k in (1, 2)}
    largest = max(works.values(), default=0.0)
    found = [pair for pair, work in works.items() if work > LEAST_WORK * largest]
    return sorted(found, key=lambda pair: -works[pair])


def _stored(result: ResultFile, place: str, field: str) -> Array | None:
    """A history of a rigid surface or of the nodes of a set [I, ..., 2], or its mean or sum over the set."""
    for path in (f"{place}/{field}", f"{place}/mean/{field}", f"{place}/sum/{field}"):
        if path in result.histories:
            return result.complete_rows(f"history/{path}")
    return None


@dataclass(frozen=True)
class Members:
    """The objects that have a column of a history each: bodies, or members of a group."""

    kind: str
    """Such as `body`, `node`, `element`; empty where a history has no members."""
    axis: str
    """`body`, or the path of the group."""
    names: list[str]
    """Numbers of the members as they stand in brackets."""
    paths: list[str]
    """Names of the histories of single members."""
    is_set: bool = False
    """Whether they are those of a set, so that the name without brackets is the mean or the sum."""

    @classmethod
    def of(cls, result: ResultFile, path: str) -> "Members":
        """The members of a history; empty if the history has no members."""
        if path not in result.histories:
            return cls("", "", [], [])
        if PER_BODY.fullmatch(path):
            names = [str(body) for body in range(result.histories[path].shape[1])]
            return cls("body", "body", names, [f"{path}[{name}]" for name in names])
        place, _, field = path.rpartition("/")
        matched = PLACES.fullmatch(place)
        if matched is None:
            return cls("", "", [], [])
        labels = result.read(f"history/{place}/labels")
        kind = "node" if matched["nodes"] or matched["within"] == "at_nodes" else "element"
        names = [str(label) for label in labels]
        if matched["hinges"]:
            kind, names = "hinge", ["-".join(map(str, pair)) for pair in labels]
        elif matched["within"] == "points":
            numbers = result.read(f"history/{place}/numbers")
            kind, names = "point", [f"{label}.{number}" for label, number in zip(labels, numbers)]
        paths = [f"{place}[{name}]/{field}" for name in names]
        return cls(kind, place, names, paths, bool(matched["nodes"] or matched["elements"]))


def listed(result: ResultFile) -> list[str]:
    """All names of histories, with their components."""
    names = []
    for path, data in result.histories.items():
        each = Members.of(result, path)
        plain = data.ndim == (2 if each.names else 1)
        if each.names and not each.is_set:
            path = each.paths[0].replace(f"[{each.names[0]}]", f"[{each.kind.upper()}]")
        names.append(path if plain else f"{path}:1 to :{data.shape[-1]}")
    return sorted(names)


def _selected(result: ResultFile, path: str) -> tuple[Array, str]:
    """Values [I] or [I, components] of a path with its brackets, and their description."""
    if path not in result.histories:
        plain = re.sub(r"\[[-\d.]+\]", "", path)
        for pattern, select in ((OF_MEMBER, _of_member), (BODIES, _of_body)):
            matched = pattern.fullmatch(path)
            if matched and plain in result.histories:
                return select(result, plain, matched)
        for kind in ("mean", "sum"):
            place, _, field = path.rpartition("/")
            if f"{place}/{kind}/{field}" in result.histories:
                return _selected(result, f"{place}/{kind}/{field}")
        raise Fault(f"{result.path} has no history {path}: {_alternatives(result, plain)}")
    data = result.complete_rows(f"history/{path}")
    if Members.of(result, path).is_set:
        return _of_set(data, _description(result, path), path)
    place = path.rpartition("/")[0].partition("/")[2]
    return data, ", ".join(filter(None, (_description(result, path), place)))


def _of_set(data: Array, what: str, path: str) -> tuple[Array, str]:
    """Mean over a set, or the sum for forces and energies."""
    place, _, field = path.rpartition("/")
    name = place.partition("/")[2]
    if data.shape[1] == 1:
        return data[:, 0], f"{what} of {name}"
    if field in SUMS:
        return data.sum(axis=1), f"{what}, sum over {name}"
    return data.mean(axis=1), f"{what}, mean over {name}"


def _of_member(result: ResultFile, path: str, matched: re.Match[str]) -> tuple[Array, str]:
    """History of one node, one element or another member of a group."""
    member, each = matched["member"], Members.of(result, path)
    if member not in each.names:
        place = matched["place"].rpartition("/")[2]
        raise Fault(f"{each.kind or 'member'} {member} is not in {place}: {_few(each.names)}")
    at = each.names.index(member)
    return result.complete_rows(f"history/{path}")[:, at], f"{_description(result, path)} of {each.kind} {member}"


def _of_body(result: ResultFile, path: str, matched: re.Match[str]) -> tuple[Array, str]:
    """Column of one body in a history that has one column for each body."""
    data, body = result.complete_rows(f"history/{path}"), int(matched["body"])
    if data.ndim < 2 or body >= data.shape[1]:
        count = data.shape[1] if data.ndim > 1 else 0
        raise Fault(f"{path} has {count} bodies, counted from 0: there is no [{body}]")
    return data[:, body], f"{_description(result, path)}, body {body}"


def _description(result: ResultFile, path: str) -> str:
    """Description of a dataset, without the explanation after its colon."""
    if path == "time":
        return path
    text = result.histories[path].attrs.get("description", path)
    return str(text).partition(":")[0]


def _alternatives(result: ResultFile, path: str) -> str:
    """Names that exist at the point where a path leads to nothing."""
    there = ""
    for part in path.split("/"):
        deeper = f"{there}{part}/"
        if not any(name.startswith(deeper) for name in result.histories):
            break
        there = deeper
    below = [name[len(there) :] for name in result.histories if name.startswith(there)]
    names = ", ".join(sorted({name.partition("/")[0] for name in below}))
    return f"{there.rstrip('/')} has {names}" if there else f"there are {names}"


def _few(names: list[str]) -> str:
    """The first members of a group."""
    more = f" and {len(names) - 12} more" if len(names) > 12 else ""
    return f"there are {', '.join(names[:12])}{more}"
