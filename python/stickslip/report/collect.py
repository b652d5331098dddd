"""Data of a result that a page shows: mesh, fields of the frames, surfaces, histories, and the record of the run."""

import itertools
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from stickslip.arrays import Array, Integers
from stickslip.certificate.certify import certify
from stickslip.certificate.own import own_checks
from stickslip.errors import Fault
from stickslip.fields import INVARIANTS, VECTORS, also, directions, words
from stickslip.quantity import Members, find, force_against_displacement
from stickslip.report.pack import Packed
from stickslip.result import Result

EDGE_PARTS = 2000.0
"""Displacements are accurate to a part of the mesh's shortest usual edge."""

WAY_PARTS = 20000.0
"""Displacements are accurate to a part of the largest displacement."""

MOST_ROWS = 20000
"""Longer histories show the smallest and the largest value of equal parts of the increments."""

CERTIFIED = 4_000_000
"""Results with more elements times frames than this are not certified in a page: it would take minutes."""


@dataclass(frozen=True)
class Choice:
    """Choice of the data of a result that the page contains."""

    fields: tuple[str, ...] | None = None
    """Names of the fields of the frames; None for all."""
    frames: int | None = None
    """At most so many frames, evenly chosen; None for all."""


def _field_values(result: Result, name: str, frames: Integers) -> Array:
    """A field [frames, nodes or cells, ...] of the chosen frames."""
    return np.stack([result.frames[int(frame)].full(name) for frame in frames])


def collect(path: Path, packed: Packed, choice: Choice) -> dict[str, Any]:
    """All data of a result."""
    with Result(path) as result:
        frames = _chosen(len(result.frames), choice.frames)
        surfaces = _surfaces(result)
        fields = _fields(result, frames, choice.fields, packed)
        return {
            **_record(result, frames),
            "mesh": _pack_mesh(result, packed),
            "recovery": _recovery(result, packed),
            "motion": _motion(result, frames, None, packed),
            "fields": fields,
            "surfaces": surfaces,
            "histories": _histories(result, packed),
            "pairs": _pairs(result, packed),
            "checks": _checks(result),
            "certificate": _certificate(result),
            "deck": result.deck,
        }


def collect_outline(path: Path, packed: Packed, choice: Choice) -> dict[str, Any]:
    """Data of a result that is laid over another result: outlines in motion, pressure along surfaces, histories."""
    with Result(path) as result:
        frames = _chosen(len(result.frames), choice.frames)
        drawing = result.drawing
        drawn = np.unique(np.concatenate([result.boundary.ravel(), result.rigid.ravel()]))
        place = np.full(len(result.coordinates), -1)
        place[drawn] = np.arange(len(drawn))
        # vertices of the outline behind the nodes, which have vertices of the outline around them
        behind = np.unique(drawing.outline[drawing.outline >= drawing.nodes])
        vertex = np.concatenate([place, np.full(len(drawing.after), -1)])
        vertex[behind] = len(drawn) + np.arange(len(behind))
        after = vertex[drawing.after[behind - drawing.nodes]]
        fields = _fields(result, frames, ("CONTACT_PRESSURE",), packed)
        for each in fields:
            each["only"] = packed.whole(place[_contact_nodes(result)])
        surfaces = _surfaces(result)
        for surface in surfaces:
            surface["nodes"] = [int(place[node]) for node in surface["nodes"]]
        return {
            **_record(result, frames),
            "mesh": {
                "nodes": len(drawn),
                "coordinates": packed.bits(result.coordinates[drawn] - _middle(result)),
                "middle": _middle(result).tolist(),
                "after": packed.whole(after),
                "outline": packed.whole(vertex[drawing.outline]),
                "rigid": packed.whole(place[result.rigid]),
            },
            "motion": _motion(result, frames, drawn, packed),
            "fields": fields,
            "surfaces": surfaces,
            "histories": _histories(result, packed),
            "pairs": _pairs(result, packed),
        }


# The run.


def _record(result: Result, frames: Integers) -> dict[str, Any]:
    """Name, times of the frames and record of the run."""
    record = {name: _plain(value) for name, value in result.run.items() if name != "deck"}
    return {
        "job": result.job,
        "heading": _heading(result.deck),
        "run": record,
        "bytes": result.path.stat().st_size,
        "elements": len(result.element_labels),
        "nodes": len(result.coordinates),
        "bodies": len(result.read("model/bodies/mass")),
        "displacement": {"words": words("U"), "also": also("U", 2)},
        "axes": directions(2, result.is_axisymmetric),
        "tensor": directions(3, result.is_axisymmetric),
        "increments": result.rows - 1,
        "landings": len(result.complete_rows("history/impacts/time")),
        "steps": int(result.history["step"].max(initial=1)),
        "end": float(result.history["time"][-1]),
        "framesInFile": len(result.frames),
        "times": result.frames.times[frames].tolist(),
    }


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _heading(deck: str) -> str:
    """The lines under *HEADING in the deck."""
    lines = deck.splitlines()
    for number, line in enumerate(lines):
        if line.strip().upper().replace(" ", "").startswith("*HEADING"):
            text = []
            for each in lines[number + 1 :]:
                if each.lstrip().startswith("*"):
                    break
                text.append(each.strip())
            return " ".join(text)
    return ""


def _chosen(frames: int, most: int | None) -> Integers:
    """Indices of at most `most` frames, evenly chosen; these include the first and the last frame."""
    if most is None or frames <= most:
        return np.arange(frames)
    return np.unique(np.rint(np.linspace(0, frames - 1, max(most, 2))).astype(np.int64))


# The mesh.


def _middle(result: Result) -> Array:
    """Origin of the coordinates of the page, chosen so that float32 is accurate enough for them."""
    coordinates = result.coordinates
    return 0.5 * (coordinates.min(axis=0) + coordinates.max(axis=0))


def _pack_mesh(result: Result, packed: Packed) -> dict[str, Any]:
    """The mesh with its drawing: `connectivity` and `offsets` are the vertices around the elements."""
    coordinates, drawing = result.coordinates, result.drawing
    connectivity = np.concatenate([*drawing.rings, np.empty(0, np.int64)])
    offsets = np.concatenate([[0], np.cumsum([len(ring) for ring in drawing.rings], dtype=np.int64)])
    middle = _middle(result)
    return {
        "nodes": len(result.coordinates),
        "elements": len(result.element_labels),
        "coordinates": packed.bits(coordinates - middle),
        "middle": middle.tolist(),
        "nodeLabels": packed.whole(result.node_labels[:, None]),
        "elementLabels": packed.whole(result.element_labels[:, None]),
        "body": packed.whole(result.read("model/bodies/element")[:, None]),
        "nodeBody": packed.whole(result.read("model/bodies/node")[:, None]),
        "after": packed.whole(drawing.after),
        "connectivity": packed.whole(connectivity[:, None]),
        "offsets": packed.whole(offsets[:, None]),
        "outline": packed.whole(drawing.outline),
        "inner": packed.whole(drawing.inner),
        "rigid": packed.whole(result.rigid),
    }


def _recovery(result: Result, packed: Packed) -> dict[str, Any]:
    """The weights that give values at nodes from values of elements."""
    recovery = result.recovery
    return {
        "places": recovery.places,
        "twins": packed.whole(recovery.twins[:, None]),
        "place": packed.whole(recovery.place[:, None]),
        "element": packed.whole(recovery.element[:, None]),
        "weight": packed.linear(recovery.weight[:, None], 1e-6),
        "middles": packed.whole(recovery.middles),
    }


def _motion(
    result: Result, frames: Integers, only: Integers | None, packed: Packed
) -> dict[str, Any]:
    """Displacements [frames, 2 nodes] of all nodes or of some nodes."""
    displacement = _field_values(result, "U", frames)[:, :, :2]
    drawing = result.drawing
    ends = drawing.positions(result.coordinates)[np.concatenate([drawing.outline, drawing.inner, result.rigid])]
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    edge = float(np.quantile(length, 0.02)) if len(length) else 0.0
    usable = np.nan_to_num(displacement, nan=0.0, posinf=0.0, neginf=0.0)
    largest = float(np.abs(usable).max(initial=0.0))
    steps = [part for part in (edge / EDGE_PARTS, largest / WAY_PARTS) if part > 0.0]
    if only is not None:
        usable = usable[:, only]
    return packed.linear(usable.reshape(len(frames), -1), min(steps, default=1.0))


# Fields.

def _fields(
    result: Result, frames: Integers, names: tuple[str, ...] | None, packed: Packed
) -> list[dict[str, Any]]:
    """Fields [frames, places components]; places without any value are left out."""
    chosen = None if names is None else {result.frames.known(name).partition(":")[0] for name in names}
    if chosen is not None and chosen & INVARIANTS.keys():
        chosen |= {"S", "S33"}  # which their values at nodes are made of
    found = []
    for name, kind in result.frames.fields.items():
        if name in ("U", "BODY") or (chosen is not None and name not in chosen):
            continue
        values = _field_values(result, name, frames)
        if kind == "CellData":
            values = values[:, : len(result.element_labels)]
        count = int(np.prod(values.shape[2:]))
        values = values.reshape(*values.shape[:2], count)[:, :, : 2 if name in VECTORS else None]
        attributes = result.item(result.frames.dataset(name)).attrs
        described = _field(kind, name, attributes, values, packed)
        described["words"] = words(name, result.is_axisymmetric)
        described["also"] = also(name, described["components"])
        found.append(described)
    return found


def _field(kind: str, name: str, attributes: Any, values: Array, packed: Packed) -> dict[str, Any]:
    whole = values.dtype.kind in "iu"
    empty = 0.0 if whole or not np.isnan(values).any() else np.nan
    used = (~np.isnan(values) if np.isnan(empty) else values != 0).any(axis=(0, 2))
    places = np.flatnonzero(used)
    described: dict[str, Any] = {
        "name": name,
        "at": "nodes" if kind == "PointData" else "elements",
        "description": str(attributes.get("description", "")),
        "dimension": str(attributes.get("dimension", "1")),
        "components": values.shape[2],
        "empty": None if np.isnan(empty) else 0,
    }
    if len(places) < 0.8 * values.shape[1]:
        values = values[:, places]
        described["only"] = packed.whole(places[:, None])
    flat = values.reshape(len(values), -1)
    described["values"] = packed.whole(flat) if whole else packed.curved(flat)
    return described


# Surfaces.


def _contact_nodes(result: Result) -> Integers:
    """Nodes that carry a contact pressure in a frame."""
    known = np.zeros(len(result.coordinates), dtype=bool)
    for frame in result.frames:
        known |= np.isfinite(frame["CONTACT_PRESSURE"])
    return np.flatnonzero(known)


def _surfaces(result: Result) -> list[dict[str, Any]]:
    """Chains of edges between slave nodes: name, nodes and reference arc length.

    A closed chain of edges begins where no pressure acts, so the part under pressure is in one piece.
    """
    slave = np.zeros(len(result.coordinates), dtype=bool)
    most = np.zeros(len(result.coordinates))
    for frame in result.frames:
        slave |= ~np.isnan(frame["SLIP"])
        most = np.fmax(most, frame["CONTACT_PRESSURE"])
    sets = {name: set(result.node_set(name).tolist()) for name in result.file["model/node_sets"]}
    body = result.read("model/bodies/node")
    bodies = len(result.read("model/bodies/mass"))
    found: list[dict[str, Any]] = []
    for chain in _chains(result.boundary[slave[result.boundary].all(axis=1)]):
        if chain[0] == chain[-1]:
            chain = _opened(chain, most)
        way = np.linalg.norm(np.diff(result.coordinates[chain], axis=0), axis=1)
        holding = [name for name, nodes in sets.items() if nodes.issuperset(chain)]
        name = min(holding, key=lambda each: len(sets[each]), default="")
        if not name or len(sets[name]) > 2 * len(chain):
            name = f"body {body[chain[0]]}" if bodies > 1 else "surface"
        again = sum(each["name"].split(" (")[0] == name for each in found)
        found.append(
            {
                "name": f"{name} ({again + 1})" if again else name,
                "nodes": [int(node) for node in chain],
                "along": np.concatenate([[0.0], np.cumsum(way)]).tolist(),
                "largest": float(most[chain].max(initial=0.0)),
            }
        )
    return sorted(found, key=lambda surface: -surface["largest"])


def _chains(edges: Integers) -> list[list[int]]:
    """Chains along the edges [., 2] from start to end; a closed chain ends where it starts."""
    following: dict[int, list[int]] = {}
    for start, end in edges.tolist():
        following.setdefault(start, []).append(end)
    ends = set(edges[:, 1].tolist())
    starts = [node for node in following if node not in ends] + list(following)
    chains = []
    for start in starts:
        while following.get(start):
            chain = [start]
            while following.get(chain[-1]):
                chain.append(following[chain[-1]].pop())
            chains.append(chain)
    return chains


def _opened(chain: list[int], pressure: Array) -> list[int]:
    """A closed chain that begins in the middle of its longest part without pressure."""
    ring = np.array(chain[:-1])
    free = pressure[ring] <= 0.0
    best, start = 0, int(np.argmin(pressure[ring]))
    run = 0
    for place in range(2 * len(ring)):
        run = min(run + 1, len(ring)) if free[place % len(ring)] else 0
        if run > best:
            best, start = run, (place - run // 2) % len(ring)
    turned = np.roll(ring, -start)
    return [*turned.tolist(), int(turned[0])]


# Histories.


def _histories(result: Result, packed: Packed) -> dict[str, Any]:
    """All histories with one row per increment, by their paths below /history."""
    found: list[dict[str, Any]] = []
    rows = result.rows
    parts = None
    if rows > MOST_ROWS:
        parts = np.linspace(0, rows, MOST_ROWS // 2 + 1).astype(np.int64)
    for name, item in result.histories.items():
        if name == "time":
            continue
        values = item[:rows].reshape(rows, -1).astype(np.float64)
        described: dict[str, Any] = {
            "name": name,
            "dimension": str(item.attrs.get("dimension", "1")),
            "columns": _columns(Members.of(result, name), item.shape[1:], result.is_axisymmetric),
            "zero": not values.any(),
        }
        if not described["zero"]:
            described["values"] = packed.bits(_thinned(values, parts))
        found.append(described)
    time = result.history["time"]
    if parts is not None:
        time = np.stack([time[parts[:-1]], time[parts[1:] - 1]], axis=1).ravel()
    return {"time": packed.bits(time[:, None]), "thinned": parts is not None, "all": found}


def _pairs(result: Result, packed: Packed) -> list[dict[str, Any]]:
    """Forces against displacements: for each the object that moves, the titles, and time, displacement and force [rows,
    3]."""
    rows = np.unique(np.linspace(0, result.rows - 1, min(result.rows, MOST_ROWS)).astype(np.int64))
    pairs = []
    for names in force_against_displacement(result):
        found = [find(result, name) for name in names]
        columns = [result.history["time"], *(part for each in found for part in each.parts.values())]
        pairs.append(
            {
                "name": f"{names[0].split('/')[1]}, {next(iter(found[0].parts))}",
                "titles": [each.title for each in found],
                "values": packed.bits(np.column_stack(columns)[rows]),
            }
        )
    return pairs


def _columns(each: Members, shape: tuple[int, ...], axisymmetric: bool) -> list[str]:
    """Words for the columns of a history: `node 12, x`."""
    of = [f"{each.kind} {name}" for name in each.names] or [""]
    sizes = shape[1:] if each.names else shape
    of_each = directions(sizes[0], axisymmetric) if sizes else [""]
    return [", ".join(filter(None, pair)) for pair in itertools.product(of, of_each)]


def _thinned(values: Array, parts: Integers | None) -> Array:
    """The smallest and the largest value of each section of the rows, whichever comes first in the section standing
    first."""
    if parts is None:
        return values
    rows = []
    for start, end in zip(parts[:-1], parts[1:]):
        part = np.nan_to_num(values[start:end])
        low, high = part.argmin(axis=0), part.argmax(axis=0)
        first, second = np.minimum(low, high), np.maximum(low, high)
        rows += [
            np.take_along_axis(values[start:end], each[None], axis=0)[0] for each in (first, second)
        ]
    return np.array(rows)


def _checks(result: Result) -> list[dict[str, Any]]:
    """The largest value of every check of the increments, and the increment in which this value occurs."""
    time = result.history["time"]
    found = []
    for check in own_checks(result):
        if len(check.values) == 0 or np.isnan(check.values).all():
            continue
        row = int(np.nanargmax(np.abs(check.values)))
        found.append(
            {
                "name": check.name,
                "text": check.text,
                "largest": float(abs(check.values[row])),
                "bound": None if np.isnan(check.bound) else check.bound,
                "increment": row,
                "time": float(time[row]),
            }
        )
    return found


def _certificate(result: Result) -> str:
    """The line of the certificate, or the reason why there is no certificate."""
    if len(result.cells) * len(result.frames) > CERTIFIED:
        return "not made for a page of this size: stickslip certify makes it"
    try:
        return certify(result).line
    except Fault as fault:
        return str(fault)
