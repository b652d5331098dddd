"""Flat decks that describe the same motion otherwise: moved, turned, mirrored, boosted.

Every function takes a deck as `stickslip flatten` writes it, with numbers in place of the names of
sets wherever something acts, and returns a new one.
"""

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import count

import numpy as np
from stickslip.arrays import Array
from stickslip.deck import PROCEDURES, Card, Deck
from stickslip.errors import Fault

ANGLE = "6"
"""The direction of angles and moments."""

GROUNDED = {"SPRING1", "DASHPOT1"}
ALONG_AXES = {"SPRING2", "DASHPOT2"}


class Unchangeable(Fault):
    """A deck that cannot be written in the other frame; says why."""


# Mesh


def with_points(deck: Deck, place: Callable[[Array], Array]) -> Deck:
    """The deck with other coordinates of all nodes, points of rigid surfaces and axes of centrifugal loads."""

    def change(card: Card) -> Card:
        if card.keyword == "DLOAD":
            rows = [_about(row, place) if row[1] == "CENTRIF" else row for row in card.rows]
            return _with_rows(card, rows)
        if card.keyword != "NODE" and not _is_profile(card):
            return card
        points = [place(_numbers(row[1:3])) for row in card.rows]
        if _is_profile(card) and card.rows[0][1:3] == card.rows[-1][1:3]:
            points[-1] = points[0]  # a closed profile stays closed
        rows = []
        for row, at in zip(card.rows, points):
            centre = _written(place(_numbers(row[3:5]))) if row[0] == "CIRCL" else []
            rows.append([row[0], *_written(at), *centre])
        return _with_rows(card, rows)

    return _each(deck, change)


def _about(row: list[str], place: Callable[[Array], Array]) -> list[str]:
    """The row of a centrifugal load with its axis elsewhere."""
    return [*row[:3], *_written(place(_numbers(row[3:5]))), *row[5:]]


def size(deck: Deck) -> float:
    """The largest extent of the nodes that belong to elements."""
    used = {label for card in deck.find("ELEMENT") for row in card.rows for label in row[1:]}
    rows = [row for card in deck.find("NODE") for row in card.rows if row[0] in used]
    points = np.array([_numbers(row[1:3]) for row in rows])
    return float((points.max(axis=0) - points.min(axis=0)).max())


def moved(deck: Deck, shift: Array) -> Deck:
    """The deck elsewhere."""
    return with_points(deck, lambda point: point + shift)


def noisy(deck: Deck, largest: Array | float) -> Deck:
    """The deck with random numbers up to `largest` added to all coordinates: of all directions, or of each.

    A negative number gives the same ones with the other sign: what is decided by a tie is decided
    otherwise by one of both.
    """
    random = np.random.default_rng(0)
    return with_points(deck, lambda point: point + largest * random.uniform(-1.0, 1.0, 2))


def turned(deck: Deck, matrix: Array) -> Deck:
    """The deck turned about the origin by an orthogonal matrix; mirrored if its determinant is -1.

    Where supports do not follow the axes after the turn, a node without element takes them over in
    the axes of before, and equations tie the supported node to it.
    """
    _refuse_fixed_directions(deck)
    new = with_points(deck, lambda point: matrix @ point)
    if np.linalg.det(matrix) < 0.0:
        new = _mirrored(new)
    new = _each(new, lambda card: _turned_card(card, matrix))
    return _turned_supports(new, matrix)


def _mirrored(deck: Deck) -> Deck:
    """Elements counter-clockwise again, the outsides of rigid surfaces on the left again."""
    faces: dict[str, dict[str, str]] = {}

    def change(card: Card) -> Card:
        if card.keyword == "ELEMENT":
            rows = []
            for label, *nodes in card.rows:
                corners, between = _corners(card, nodes)
                # face 1-2 stays, the others are met in the other order
                back = [*between[:1], *reversed(between[1:])]
                rows.append([label, *corners[1::-1], *reversed(corners[2:]), *back])
                others = [str(face) for face in range(2, len(corners) + 1)]
                faces[label] = {"1": "1"} | dict(zip(others, reversed(others)))
            return _with_rows(card, rows)
        if _is_profile(card):
            # a line or an arc leads back to where it came from, about the same centre
            back = list(zip(card.rows[1:], card.rows))[::-1]
            rows = [[row[0], *before[1:3], *row[3:5]] for row, before in back]
            return _with_rows(card, [["START", *card.rows[-1][1:3]], *rows])
        return _with_faces(card, faces)

    return _each(deck, change)


def _corners(card: Card, nodes: list[str]) -> tuple[list[str], list[str]]:
    """Corners of an element, and its nodes between them: none in most."""
    is_quadratic = card.parameters["TYPE"].startswith("C") and len(nodes) > 4
    corners = len(nodes) // 2 if is_quadratic else len(nodes)
    return nodes[:corners], nodes[corners:]


def _with_faces(card: Card, faces: dict[str, dict[str, str]]) -> Card:
    """The card with other numbers of element faces."""
    if card.keyword == "SURFACE" and not _is_profile(card):
        return _with_rows(card, [_face_changed(row, faces, ("S",)) for row in card.rows])
    if card.keyword == "DLOAD":
        return _with_rows(card, [_face_changed(row, faces, ("P", "TRVEC")) for row in card.rows])
    return card


def _face_changed(
    row: list[str], faces: dict[str, dict[str, str]], kinds: tuple[str, ...]
) -> list[str]:
    if len(row) < 2 or row[1][:-1] not in kinds:
        return row
    return [row[0], row[1][:-1] + faces[row[0]][row[1][-1]], *row[2:]]


# Vectors


def _turned_card(card: Card, matrix: Array) -> Card:
    """Velocities, loads and equations in the turned axes."""
    is_velocity = card.keyword == "INITIALCONDITIONS" and card.parameters.get("TYPE") == "VELOCITY"
    if is_velocity or card.keyword == "CLOAD":
        return _with_rows(card, _turned_components(card.rows, matrix))
    if card.keyword == "DLOAD":
        return _with_rows(card, _turned_loads(card.rows, matrix))
    if card.keyword == "EQUATION":
        return _with_rows(card, _turned_equations(card.rows, matrix))
    return card


def _turned_equations(rows: list[list[str]], matrix: Array) -> list[list[str]]:
    """Rows of `*EQUATION` where axes map onto axes."""
    if not _follows_axes(matrix):
        raise Unchangeable("has equations")
    new = []
    for row in rows:
        terms = []
        for node, direction, value in zip(row[::3], row[1::3], row[2::3]):
            axis = _axis(matrix, int(direction))
            coefficient = float(value) * float(matrix[axis, int(direction) - 1])
            terms += [node, str(axis + 1), repr(coefficient)]
        new.append(terms or row)
    return new


def _follows_axes(matrix: Array) -> bool:
    """Whether axes map onto axes."""
    return bool(np.isin(np.abs(matrix), (0.0, 1.0)).all())


def _axis(matrix: Array, direction: int) -> int:
    """The axis from 0 onto which a direction, from 1, maps."""
    return int(np.flatnonzero(matrix[:, direction - 1])[0])


def _turned_components(rows: list[list[str]], matrix: Array) -> list[list[str]]:
    """Rows of node, direction, value."""
    vectors: dict[str, Array] = {}
    given: dict[str, Array] = {}
    angles: list[list[str]] = []
    for node, direction, value in rows:
        if direction == ANGLE:
            angles.append([node, direction, repr(float(value) * _hand(matrix))])
        else:
            vectors.setdefault(node, np.zeros(2))[int(direction) - 1] += float(value)
            given.setdefault(node, np.zeros(2))[int(direction) - 1] = 1.0
    return [
        [node, str(direction + 1), repr(float(value))]
        for node, vector in vectors.items()
        for direction, value in enumerate(matrix @ vector)
        if (np.abs(matrix) @ given[node])[direction] > 0.0
    ] + angles


def _hand(matrix: Array) -> float:
    """-1 where angles change their sign."""
    return float(np.sign(np.linalg.det(matrix)))


def _turned_loads(rows: list[list[str]], matrix: Array) -> list[list[str]]:
    """Rows of `*DLOAD`: gravity, body forces, pressures, tractions."""
    forces: dict[str, Array] = {}
    given: dict[str, Array] = {}
    new: list[list[str]] = []
    for row in rows:
        if row[1] in ("BX", "BY"):
            axis = "XY".index(row[1][1])
            forces.setdefault(row[0], np.zeros(2))[axis] += float(row[2])
            given.setdefault(row[0], np.zeros(2))[axis] = 1.0
        elif row[1] == "GRAV" or row[1].startswith("TRVEC"):
            new.append([*row[:3], *_written(matrix @ _numbers(row[3:5]))])
        else:
            new.append(row)
    for target, force in forces.items():
        # a load of zero takes that of an earlier step away
        for axis, value in enumerate(matrix @ force):
            if (np.abs(matrix) @ given[target])[axis] > 0.0:
                new.append([target, "B" + "XY"[axis], repr(float(value))])
    return new


# Supports


@dataclass(frozen=True)
class Support:
    """What a step prescribes of a displacement."""

    parameters: str = ""
    """Those of the card but for OP: type and amplitude."""
    value: float = 0.0


Supports = dict[tuple[str, int], Support]
"""By node and direction, 1, 2 or 6."""


@dataclass(frozen=True)
class Held:
    """The supports of a step."""

    now: Supports
    start: float
    """Time of the start of the step."""
    period: float


def supports(deck: Deck) -> list[Held]:
    """All supports that hold in each step, also those that earlier steps have left."""
    amplitudes = {card.parameters["NAME"]: card for card in deck.find("AMPLITUDE")}
    steps: list[Held] = []
    now: Supports = {}
    time = 0.0
    for cards in _steps(deck):
        rows = next(card for card in cards if card.keyword in PROCEDURES).rows
        period = float(rows[0][1]) if rows and len(rows[0]) > 1 else 1.0
        for card in cards:
            if card.keyword == "BOUNDARY":
                now = {} if card.parameters.get("OP") == "NEW" else now
                now = now | dict(_support_rows(card))
        steps.append(Held(now, time, period))
        now = {place: _left(support, period, amplitudes) for place, support in now.items()}
        time += period
    return steps


def _support_rows(card: Card) -> Iterator[tuple[tuple[str, int], Support]]:
    parameters = {name: value for name, value in card.parameters.items() if name != "OP"}
    text = "".join(f", {name}={value}" for name, value in parameters.items())
    for node, first, *rest in card.rows:
        last, value = (*rest, *("", "")[len(rest) :])
        for direction in range(int(first), int(last or first) + 1):
            yield (node, direction), Support(text, float(value or 0.0))


def _left(support: Support, period: float, amplitudes: dict[str, Card]) -> Support:
    """The support that a step leaves to the next: a displacement, or velocity, keeps what it has reached."""
    if "AMPLITUDE=" in support.parameters:
        kept = "".join(
            f", {part.strip()}" for part in support.parameters.split(",") if "TYPE=" in part
        )
        return Support(kept, support.value * _value_at(period, amplitudes[_amplitude(support)]))
    return support


def _value_at(period: float, amplitude: Card) -> float:
    """What an amplitude has reached at the end of a step."""
    parameters = amplitude.parameters
    if parameters["DEFINITION"] == "SMOOTH STEP" and parameters["TIME"] == "STEP TIME":
        time, value = _pairs(amplitude)[-1]
        if time <= period:
            return float(value)
    return float(np.interp(period, *_points(amplitude).T))


def with_supports(deck: Deck, steps: list[Supports]) -> Deck:
    """The deck with these supports: cards of each step name them all."""
    cards: list[Card] = []
    remaining = iter(enumerate(steps))
    for card in deck.cards:
        if card.keyword == "BOUNDARY":
            continue
        cards.append(card)
        if card.keyword in PROCEDURES:
            step, now = next(remaining)
            cards += _support_cards(now, is_first=step == 0)
    return Deck(cards)


def _support_cards(now: Supports, is_first: bool) -> list[Card]:
    cards: dict[str, Card] = {}
    for (node, direction), support in now.items():
        operation = "" if is_first or cards else ", OP=NEW"
        card = Card("BOUNDARY", f"*BOUNDARY{operation}{support.parameters}")
        rows = cards.setdefault(support.parameters, card).rows
        rows.append([node, str(direction), str(direction), repr(support.value)])
    if not now and not is_first:
        return [Card("BOUNDARY", "*BOUNDARY, OP=NEW")]
    return list(cards.values())


def _types(deck: Deck) -> set[str]:
    """Types of the elements."""
    return {card.parameters.get("TYPE", "").upper() for card in deck.find("ELEMENT")}


def _refuse_fixed_directions(deck: Deck) -> None:
    """Springs along axes and angles in equations are not turned here."""
    if (GROUNDED | ALONG_AXES) & _types(deck):
        raise Unchangeable("springs and dashpots act along the axes")
    if any(ANGLE in row[1::3] for card in deck.find("EQUATION") for row in card.rows):
        raise Unchangeable("an equation has an angle")


def _turned_supports(deck: Deck, matrix: Array) -> Deck:
    """Supports in turned axes."""
    before = supports(deck)
    follows_axes = _follows_axes(matrix)
    kinds = ("RIGIDBODY", "COUPLING", "KINEMATICCOUPLING")
    references = {card.parameters["REFNODE"] for kind in kinds for card in deck.find(kind)}
    nodes = {node for held in before for node, _ in held.now}
    indirect = {
        node
        for node in nodes
        if not follows_axes and any(_turned_pair(node, held.now, matrix) is None for held in before)
    }
    if indirect & references:
        raise Unchangeable("a reference node has supports that do not move alike")
    masses = {card.parameters.get("CONTACTMASS") for card in deck.find("STICKSLIP")}
    if indirect and "REDISTRIBUTED" in masses:
        raise Unchangeable("nodes of equations keep their mass")
    stand_in = dict(zip(sorted(indirect, key=int), map(str, count(_largest_label(deck) + 1))))
    after: list[Supports] = []
    for held in before:
        now: Supports = {}
        for node in dict.fromkeys(node for node, _ in held.now):
            if node in indirect:
                for direction in (1, 2):
                    now[stand_in[node], direction] = held.now.get((node, direction), Support())
            elif follows_axes:
                now |= _by_axes(node, held.now, matrix)
            else:
                now |= _turned_pair(node, held.now, matrix) or {}
            angle = held.now.get((node, int(ANGLE)))
            if angle:
                value = angle.value * _hand(matrix) + 0.0
                now[node, int(ANGLE)] = replace(angle, value=value)
        after.append(now)
    _refuse_changing(indirect, before)
    deck = with_supports(deck, after)
    return _tied(deck, stand_in, _directions(before), matrix)


def _by_axes(node: str, now: Supports, matrix: Array) -> Supports:
    """Supports of a node where axes map onto axes."""
    new: Supports = {}
    for old in (1, 2):
        if (node, old) in now:
            support = now[node, old]
            axis = _axis(matrix, old)
            # + 0.0: no negative zeros
            value = support.value * matrix[axis, old - 1] + 0.0
            new[node, axis + 1] = replace(support, value=float(value))
    return new


def _turned_pair(node: str, now: Supports, matrix: Array) -> Supports | None:
    """Supports of both directions of a node in turned axes; None if they do not move alike."""
    pair = [now.get((node, direction)) for direction in (1, 2)]
    if pair == [None, None]:
        return {}
    if pair[0] is None or pair[1] is None:
        return None
    moving = {support.parameters for support in pair if support and support.value != 0.0}
    if len(moving) > 1:
        return None
    parameters = moving.pop() if moving else ""
    vector = matrix @ np.array([pair[0].value, pair[1].value])
    return {(node, i): Support(parameters, float(value)) for i, value in enumerate(vector, 1)}


def _directions(steps: list[Held]) -> dict[str, list[int]]:
    """Supported directions of each node, in the first step that supports it."""
    found: dict[str, list[int]] = {}
    for held in steps:
        nodes = {node for node, _ in held.now} - set(found)
        found |= {node: [i for i in (1, 2) if (node, i) in held.now] for node in nodes}
    return found


def _refuse_changing(nodes: set[str], steps: list[Held]) -> None:
    """Equations hold in all steps: so must the supports that they stand for."""
    for node in nodes:
        kinds = {tuple(i for i in (1, 2) if (node, i) in held.now) for held in steps}
        if len(kinds) > 1:
            raise Unchangeable("supports of one direction change between steps")


def _tied(
    deck: Deck, stand_in: dict[str, str], directions: dict[str, list[int]], matrix: Array
) -> Deck:
    """The deck with nodes that take supports over, and the equations that tie others to them."""
    if not stand_in:
        return deck
    places = {row[0]: row[1:] for card in deck.find("NODE") for row in card.rows}
    rows = [[new, *places[old]] for old, new in stand_in.items()]
    equations: list[list[str]] = []
    for old, new in stand_in.items():
        if directions[old] == [1, 2]:
            for i in (0, 1):
                terms = [(old, i, 1.0), (new, 0, -matrix[i, 0]), (new, 1, -matrix[i, 1])]
                equations += _equation(terms)
        else:
            [given] = directions[old]
            normal = matrix[:, given - 1]
            first = int(np.argmax(np.abs(normal)))
            terms = [(old, first, normal[first]), (old, 1 - first, normal[1 - first])]
            equations += _equation([*terms, (new, given - 1, -1.0)])
    return _with_model_cards(
        deck, Card("NODE", "*NODE", rows), Card("EQUATION", "*EQUATION", equations)
    )


def _equation(terms: list[tuple[str, int, float]]) -> list[list[str]]:
    """Rows of an equation; terms are node, axis from 0, coefficient."""
    fields = [[node, str(axis + 1), repr(float(value))] for node, axis, value in terms if value]
    return [[str(len(fields))], [text for term in fields for text in term]]


def _with_model_cards(deck: Deck, *cards: Card) -> Deck:
    """The deck with further cards of the model."""
    place = next(i for i, card in enumerate(deck.cards) if card.keyword == "STEP")
    return Deck([*deck.cards[:place], *cards, *deck.cards[place:]])


# Boost


def boosted(deck: Deck, velocity: Array) -> Deck:
    """The deck seen by someone who moves with minus `velocity`."""
    if any(float(card.parameters.get("ALPHA", "0")) > 0.0 for card in deck.find("DAMPING")):
        raise Unchangeable("ALPHA damps the velocity itself")
    if deck.find("EQUATION"):
        raise Unchangeable("has equations")
    if GROUNDED & _types(deck):
        raise Unchangeable("springs and dashpots to the ground stay where they are")
    if deck.find("STATIC"):
        raise Unchangeable("static steps begin at rest")
    if any("DIRECT" not in card.parameters for card in deck.find("DYNAMIC")):
        raise Unchangeable("automatic increments depend on the displacements")
    if deck.find("KINEMATIC COUPLING"):
        raise Unchangeable("has couplings")
    new = _with_initial_velocity(deck, velocity)
    amplitudes = {card.parameters["NAME"]: card for card in deck.find("AMPLITUDE")}
    added: dict[str, Card] = {}
    steps: list[Supports] = []
    for number, held in enumerate(supports(deck)):
        now: Supports = {}
        for (node, direction), support in held.now.items():
            speed = float(velocity[direction - 1]) if direction < 3 else 0.0
            now[node, direction] = _boosted(support, speed, held, number, amplitudes, added)
        steps.append(now)
    new = with_supports(new, steps)
    return _with_model_cards(new, *added.values())


def _with_initial_velocity(deck: Deck, velocity: Array) -> Deck:
    """The deck with a velocity added to that of every node of an element without support.

    Rigid bodies have that of their reference nodes.
    """
    used = {label for card in deck.find("ELEMENT") for row in card.rows for label in row[1:]}
    for body in deck.find("RIGID BODY"):
        used = used - _carried(deck, body) | {body.parameters["REFNODE"]}
    start = {
        (node, direction): float(speed)
        for node in sorted(used, key=int)
        for direction, speed in enumerate(velocity, 1)
    }
    for card in deck.find("INITIAL CONDITIONS"):
        for node, direction, value in card.rows:
            if node in used:
                place = node, int(direction)
                start[place] = start.get(place, 0.0) + float(value)
    held = supports(deck)[0].now
    rows = [
        [node, str(direction), repr(value)]
        for (node, direction), value in start.items()
        if (node, direction) not in held
    ]
    kept = Deck([card for card in deck.cards if card.keyword != "INITIALCONDITIONS"])
    if not rows:
        return kept
    card = Card("INITIALCONDITIONS", "*INITIAL CONDITIONS, TYPE=VELOCITY", rows)
    return _with_model_cards(kept, card)


def _carried(deck: Deck, body: Card) -> set[str]:
    """Nodes of a rigid body."""
    elements = {row[0]: row[1:] for card in deck.find("ELEMENT") for row in card.rows}
    carried: set[str] = set()
    for keyword in ("ELSET", "NSET"):
        for card in deck.find(keyword):
            if card.parameters[keyword] == body.parameters.get(keyword):
                labels = [label for row in card.rows for label in row]
                nodes = labels if keyword == "NSET" else sum(map(elements.get, labels), [])
                carried.update(nodes)
    return carried


def _boosted(
    support: Support,
    speed: float,
    held: Held,
    number: int,
    amplitudes: dict[str, Card],
    added: dict[str, Card],
) -> Support:
    """A support that moves with a speed besides; what it follows then is `added`."""
    if "ACCELERATION" in support.parameters:
        raise Unchangeable("a support has an acceleration")
    if "TYPE=" in support.parameters:
        if "AMPLITUDE=" in support.parameters:
            raise Unchangeable("the velocity of a support follows an amplitude")
        return replace(support, value=support.value + speed)
    end = held.start + held.period
    if "AMPLITUDE=" not in support.parameters:
        # a displacement without amplitude grows linearly over the step
        return Support("", support.value + speed * end)
    old = amplitudes[_amplitude(support)]
    name = f"BOOST-{number}-{_amplitude(support)}-{support.value}-{speed}"
    if name not in added:
        times, values = _points(old).T
        inner = times[(times > 0.0) & (times < held.period)]
        all_times = np.concatenate(([0.0], inner, [held.period]))
        sums = support.value * np.interp(all_times, times, values) + speed * (
            held.start + all_times
        )
        rows = [_written(pair) for pair in zip(all_times, sums)]
        added[name] = Card("AMPLITUDE", f'*AMPLITUDE, NAME="{name}"', rows)
    return Support(f', AMPLITUDE="{name}"', 1.0)


def _amplitude(support: Support) -> str:
    return support.parameters.partition("AMPLITUDE=")[2].partition(",")[0]


def _points(card: Card) -> Array:
    """Times and values [n, 2] of an amplitude that is a table over the time of the step."""
    parameters = card.parameters
    if parameters["DEFINITION"] != "TABULAR" or parameters["TIME"] != "STEP TIME":
        raise Unchangeable(
            f"a support follows {parameters['NAME']}, which is no table of step time"
        )
    return _pairs(card)


def _pairs(card: Card) -> Array:
    return _numbers([text for row in card.rows for text in row]).reshape(-1, 2)


# Numbers and order


def renumbered(deck: Deck, seed: int = 1) -> tuple[Deck, dict[str, str], dict[str, str]]:
    """The deck with the numbers of its nodes, and those of its elements, dealt out anew.

    Also returns the new numbers of nodes and elements by the old ones.
    """
    random = np.random.default_rng(seed)
    maps = []
    for keyword in ("NODE", "ELEMENT"):
        old = [row[0] for card in deck.find(keyword) for row in card.rows]
        maps.append(dict(zip(old, (old[i] for i in random.permutation(len(old))))))
    nodes, elements = maps

    def change(card: Card) -> Card:
        names, end = {
            "NODE": (nodes, 1),
            "NSET": (nodes, None),
            "MPC": (nodes, None),
            "ELSET": (elements, None),
            "CLOAD": (nodes, 1),
            "KINEMATICCOUPLING": (nodes, 1),
            "BOUNDARY": (nodes, 1),
            "INITIALCONDITIONS": (nodes, 1),
            "TEMPERATURE": (nodes, 1),
            "DLOAD": (elements, 1),
        }.get(card.keyword, ({}, 0))
        if card.keyword == "SURFACE" and not _is_profile(card):
            names, end = (nodes if card.parameters.get("TYPE") == "NODE" else elements), 1
        if card.keyword == "ELEMENT":
            rows = [[elements[row[0]], *(nodes[node] for node in row[1:])] for row in card.rows]
            return _with_rows(card, rows)
        if card.keyword == "EQUATION":
            return _with_rows(card, [_renamed_terms(row, nodes) for row in card.rows])
        head = re.sub(r"\bNODE=(\d+)", lambda found: f"NODE={nodes[found[1]]}", card.head)
        count = [len(row[:end]) for row in card.rows]
        rows = [
            [names.get(text, text) for text in row[:n]] + row[n:]
            for row, n in zip(card.rows, count)
        ]
        return Card(card.keyword, head, rows)

    return _each(deck, change), nodes, elements


def _renamed_terms(row: list[str], nodes: dict[str, str]) -> list[str]:
    """A row of an equation: the number of terms, or node, direction, coefficient of each."""
    return (
        row
        if len(row) == 1
        else [nodes[text] if i % 3 == 0 else text for i, text in enumerate(row)]
    )


def reordered(deck: Deck, seed: int = 2) -> Deck:
    """The deck with nodes, elements, faces of surfaces and cards of elements in another order.

    Elements begin with another of their nodes too; springs pull from the same one.
    """
    random = np.random.default_rng(seed)
    faces: dict[str, dict[str, str]] = {}

    def change(card: Card) -> Card:
        if (
            card.keyword in ("NODE", "ELEMENT")
            or card.keyword == "SURFACE"
            and not _is_profile(card)
        ):
            rows = [card.rows[i] for i in random.permutation(len(card.rows))]
            card = _with_rows(card, rows)
        if card.keyword == "ELEMENT":
            rows = []
            for label, *nodes in card.rows:
                corners, between = _corners(card, nodes)
                n = len(corners)
                by = int(random.integers(n)) if card.parameters["TYPE"].startswith("C") else 0
                turned_on = (*corners[by:], *corners[:by], *between[by:], *between[:by])
                rows.append([label, *turned_on])
                faces[label] = {str(old + 1): str((old - by) % n + 1) for old in range(n)}
            return _with_rows(card, rows)
        return _with_faces(card, faces)

    new = _each(deck, change)
    places = [i for i, card in enumerate(new.cards) if card.keyword == "ELEMENT"]
    cards = list(new.cards)
    for place, other in zip(places, reversed(places)):
        cards[place] = new.cards[other]
    return Deck(cards)


def exchanged(deck: Deck) -> Deck:
    """The deck with slave and master exchanged in all contacts of two passes."""
    pairs = [tuple(row) for card in deck.find("CONTACT PAIR") for row in card.rows]
    if not any(pair[::-1] in pairs for pair in pairs if len(pair) == 2 and pair[0] != pair[1]):
        raise Unchangeable("no contact of two passes")
    places = [i for i, card in enumerate(deck.cards) if card.keyword == "CONTACTPAIR"]
    cards = list(deck.cards)
    for place, other in zip(places, reversed(places)):
        cards[place] = deck.cards[other]
    return Deck(cards)


# Cards


def _each(deck: Deck, change: Callable[[Card], Card]) -> Deck:
    return Deck([change(card) for card in deck.cards])


def _steps(deck: Deck) -> Iterator[list[Card]]:
    """The cards of each step."""
    cards: list[Card] | None = None
    for card in deck.cards:
        if card.keyword == "STEP":
            cards = []
        elif card.keyword == "ENDSTEP":
            yield cards or []
            cards = None
        elif cards is not None:
            cards.append(card)


def _with_rows(card: Card, rows: list[list[str]]) -> Card:
    return Card(card.keyword, card.head, rows)


def _is_profile(card: Card) -> bool:
    return card.keyword == "SURFACE" and card.parameters.get("TYPE") == "SEGMENTS"


def _largest_label(deck: Deck) -> int:
    return max(int(row[0]) for card in deck.find("NODE") for row in card.rows)


def _numbers(texts: list[str]) -> Array:
    return np.array([float(text) for text in texts])


def _written(numbers: Array) -> list[str]:
    return [repr(float(number)) for number in numbers]
