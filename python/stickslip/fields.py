"""Names of fields: names that users write, descriptions in words, and numbers that are made of their components.

A name is the name in the result file, a name of Abaqus, or a word: `CONTACT_PRESSURE`, `CPRESS` and `contact-pressure`
name the same field, and `S:1`, `S:xx` and `S11` the same component. A component stands after a colon, or a number made
of several components: `U:magnitude`, `S:max`. Capitals in names do not matter.
"""

from collections.abc import Callable, Container, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stickslip.arrays import Array
from stickslip.errors import Missing

WORDS = {
    "U": "displacement",
    "V": "velocity",
    "A": "acceleration",
    "RF": "reaction",
    "CONTACT_FORCE": "contact force",
    "CF": "concentrated load",
    "GAP": "gap",
    "CONTACT_STATUS": "contact status",
    "CONTACT_PRESSURE": "contact pressure",
    "SLIP": "accumulated slip",
    "CONTACT_MASS": "mass of contact nodes",
    "S": "stress",
    "S33": "stress across the thickness",
    "MISES": "von Mises stress",
    "SP1": "smallest principal stress",
    "SP2": "middle principal stress",
    "SP3": "largest principal stress",
    "PRESS": "pressure",
    "E": "Green-Lagrange strain",
    "E33": "Green-Lagrange strain across the thickness",
    "LE": "logarithmic strain",
    "LE33": "logarithmic strain across the thickness",
    "PEEQ": "accumulated plastic strain",
    "ENER": "strain energy density",
    "TEMPERATURE": "temperature",
}
"""Fields in words; those of others are their names in small letters."""

AROUND = {
    "S33": "stress around the axis",
    "E33": "Green-Lagrange strain around the axis",
    "LE33": "logarithmic strain around the axis",
}
"""Words that differ in bodies of revolution."""

AT_NODES = "_AT_NODES"
"""End of the names of fields of elements at nodes that the program has written, `S_AT_NODES` and others."""

TENSOR = 6
"""Columns of a tensor in the result file: xx yy zz xy yz xz."""

Columns = list[int] | int | None
"""Columns of a field in its dataset, None for all."""

VECTORS = ("U", "V", "A", "RF", "CONTACT_FORCE", "CF")
"""Fields whose third component is 0."""

ABAQUS = {
    **{f"{name}{i}": f"{name}:{i}" for name in ("U", "V", "A", "RF", "CF") for i in (1, 2)},
    **{f"{name}{ij}": f"{name}:{k}" for name in ("S", "E", "LE") for k, ij in ((1, 11), (2, 22), (3, 12))},
    "CPRESS": "CONTACT_PRESSURE",
    "CFORCE": "CONTACT_FORCE",
    "COPEN": "GAP",
    "CSLIP": "SLIP",
    "CSTATUS": "CONTACT_STATUS",
    "NT": "TEMPERATURE",
    "NT11": "TEMPERATURE",
}
"""Names of Abaqus for fields and their components. Of shear strains the component of the tensor is meant, which is half of
Abaqus' number."""

ALIASES = ABAQUS | {"VON_MISES": "MISES", "MEAN_STRESS": "S:mean", "SPEED": "V", "DISPLACEMENT": "U"}
"""All names besides those of the result file."""

DIRECTIONS = {2: ("x", "y"), 3: ("xx", "yy", "xy")}
"""Names of the components of vectors and of tensors in the plane."""

IN_BODIES_OF_REVOLUTION = {2: ("r", "z"), 3: ("rr", "zz", "rz")}
"""The same in the half plane of bodies of revolution."""

IN_SPACE = ("XX", "YY", "ZZ", "XY", "YZ", "XZ")
"""Names that ParaView gives to the components of a symmetric tensor, in the order of the result file."""

Made = Callable[[Array], Array]
"""A number made of the components [..., k]."""


def _principal(sign: float) -> Made:
    """Largest or smallest principal value in the plane."""

    def of(v: Array) -> Array:
        half = 0.5 * (v[..., 0] + v[..., 1])
        return half + sign * np.hypot(0.5 * (v[..., 0] - v[..., 1]), v[..., 2])

    return of


MADE: dict[int, dict[str, tuple[str, Made]]] = {
    2: {"magnitude": ("magnitude", lambda v: np.hypot(v[..., 0], v[..., 1]))},
    3: {
        "max": ("largest principal in the plane", _principal(1.0)),
        "min": ("smallest principal in the plane", _principal(-1.0)),
        "mean": ("mean in the plane", lambda v: 0.5 * (v[..., 0] + v[..., 1])),
    },
}
"""What is made of vectors and of tensors in the plane: words, function."""


def _sorted_principal(k: int) -> Callable[[Array, Array], Array]:
    """The principal stress number k of three, counted from the smallest."""

    def of(s: Array, across: Array) -> Array:
        return np.sort(np.stack([_principal(-1.0)(s), _principal(1.0)(s), across], axis=-1), axis=-1)[..., k]

    return of


def _mises(s: Array, across: Array) -> Array:
    xx, yy, xy = np.moveaxis(s, -1, 0)
    return np.sqrt(((xx - yy) ** 2 + (yy - across) ** 2 + (across - xx) ** 2) / 2.0 + 3.0 * xy**2)


INVARIANTS: dict[str, Callable[[Array, Array], Array]] = {
    "MISES": _mises,
    "PRESS": lambda s, across: -(s[..., 0] + s[..., 1] + across) / 3.0,
    **{f"SP{k + 1}": _sorted_principal(k) for k in range(3)},
}
"""Fields that are made of the stresses in the plane S [..., 3] and across it S33 [...]."""


def directions(count: int, axisymmetric: bool) -> list[str]:
    """Names of the components of a field with `count` components."""
    names = IN_BODIES_OF_REVOLUTION if axisymmetric else DIRECTIONS
    return list(names.get(count, [str(i + 1) for i in range(count)]))


def words(name: str, axisymmetric: bool = False) -> str:
    """Description of a field in words."""
    base = name.removesuffix(AT_NODES)
    text = AROUND.get(base) if axisymmetric else None
    text = text or WORDS.get(base, base.lower().replace("_", " "))
    return f"{text} at nodes, of the program" if base != name else text


def also(field: str, count: int) -> dict[str, str]:
    """The names that Abaqus gives to the components of a field, by component: `{"x": "U1", "y": "U2"}`."""
    components = DIRECTIONS.get(count, ("",))
    pairs = ((name, *target.partition(":")[::2]) for name, target in ABAQUS.items())
    return {components[int(k or 1) - 1]: name for name, of, k in pairs if of == field and bool(k) == (count > 1)}


def known(name: str, there: Container[str]) -> str:
    """A name in the spelling of the result file, with a component after its colon; `there` holds the names of the
    fields in the file."""
    path, colon, part = name.partition(":")
    if path not in there:
        folded = path.strip().upper().replace("-", "_").replace(" ", "_")
        path = folded if folded in there else ALIASES.get(folded, path)
    return path + colon + part.strip().lower()


@dataclass(frozen=True)
class Part:
    """A component of a field, or a number made of several components."""

    field: str
    """Name of the field in the result file."""
    label: str
    """What it is, in words."""
    of: Made
    """Its values [...] from those of the field [..., k] or [...]."""


def part(name: str, count: int | None, axisymmetric: bool) -> Part:
    """A number of a field, whose name has the spelling of the file, with `count` components (None for a scalar).

    If the name of a vector has no component, the number is its magnitude.
    """
    field, _, which = name.partition(":")
    text = words(field, axisymmetric)
    if count is None:
        if which:
            raise Missing(f"{field} has no components: leave out the :{which}")
        return Part(field, text, lambda values: values)
    which = which or ("magnitude" if count == 2 else "")
    made = MADE.get(count, {})
    if which in made:
        return Part(field, f"{text}, {made[which][0]}", made[which][1])
    names = directions(count, axisymmetric)
    choices = [[str(i + 1) for i in range(count)], list(DIRECTIONS.get(count, ())), names]
    at = next((each.index(which) for each in choices if which in each), None)
    if at is not None:
        return Part(field, f"{text}, {names[at]}", lambda values: values[..., at])
    wanted = ", ".join(f"{field}:{each}" for each in _unique([*choices[0], *names, *made]))
    raise Missing(f"{name}: say which part of {field}, such as {wanted}")


def _unique(names: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(names))


def tensor_columns(name: str) -> dict[str, Columns]:
    """The fields that a tensor of the file contains, with their columns: `S` in the plane (xx yy xy) and `S33` across
    the plane."""
    base = name.removesuffix(AT_NODES)
    return {name: [0, 1, 3], f"{base}33{name[len(base):]}": 2}


def without_third(name: str, rows: NDArray[np.generic]) -> NDArray[np.generic]:
    """Rows of a field of the file; vectors lose their third component, which is 0."""
    return rows[:, :2] if name in VECTORS else rows
