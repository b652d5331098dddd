"""Writes the deck of the folding wedges as a preprocessor would: `generate.py [-o FOLDER]`."""

import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "python"))

from stickslip.decks import write_to_folder  # noqa: E402

YOUNG, POISSON, DENSITY = 210000.0, 0.3, 7.85e-9
LENGTH, THIN, SLOPE = 100.0, 8.0, 0.1
NX, NY = 40, 5
FRICTION, PRESSURE = 0.2, 10.0
OFFSET, TRAVEL = 30.0, 20.0
RAMP, DRIVE, REST = 1e-3, 10e-3, 1e-3
DT = 2e-5


def node(i: int, j: int) -> int:
    """Number of a node in the part."""
    return 1 + i + j * (NX + 1)


def element(i: int, j: int) -> int:
    """Number of an element in the part."""
    return 1 + i + j * NX


def real(x: float) -> str:
    """A number in a column, with its point."""
    text = f"{x:.9g}"
    return f"{text if '.' in text else text + '.':>13}"


def nodes() -> Iterator[str]:
    """Lines of the nodes: a flat base, and above it the slope."""
    for j in range(NY + 1):
        for i in range(NX + 1):
            x = LENGTH * i / NX
            y = (THIN + SLOPE * x) * j / NY
            yield f"{node(i, j):7d}, {real(x)}, {real(y)}"


def elements() -> Iterator[str]:
    """Lines of the elements."""
    for j in range(NY):
        for i in range(NX):
            corners = (node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1))
            yield f"{element(i, j)}, " + ", ".join(f"{n:3d}" for n in corners)


def card(head: str, *rows: str) -> str:
    """Text of a card."""
    return "\n".join((f"*{head}", *rows)) + "\n"


def title(*words: str) -> str:
    """A comment as preprocessors set them above a group of cards."""
    return "".join(["**\n", *(f"** {line}".strip() + "\n" for line in words), "**\n"])


def span(numbers: Iterable[int]) -> str:
    """The line of a generated set: first, last, increment."""
    first, second, *others = numbers
    return f"{first:4d}, {[second, *others][-1]:4d}, {second - first:3d}"


def part() -> str:
    """The wedge: mesh, sets and section."""
    return "".join(
        [
            card("Part, name=Wedge"),
            card("Node", *nodes()),
            card("Element, type=CPE4", *elements()),
            card("Nset, nset=All, generate", span(range(1, node(NX, NY) + 1))),
            card("Elset, elset=All, generate", span(range(1, element(NX - 1, NY - 1) + 1))),
            "** Section: Section-1\n",
            card("Solid Section, elset=All, material=Steel", ","),
            card("End Part"),
        ]
    )


def surface(name: str, instance: str, side: str, members: Iterable[int]) -> str:
    """A surface of the assembly with the set of its elements."""
    internal = f"_{name}_{side}"
    return "".join(
        [
            card(
                f"Elset, elset={internal}, internal, instance={instance}, generate", span(members)
            ),
            card(f"Surface, type=ELEMENT, name={name}", f"{internal}, {side}"),
        ]
    )


def assembly() -> str:
    """The lower wedge where it is, the upper one turned by 180 degrees onto its slope."""
    right = LENGTH - OFFSET
    top = 2 * THIN + SLOPE * right
    shift = [right, top, 0.0]
    turn = [*shift, right, top, 1.0, 180.0]
    lowest = [element(i, 0) for i in range(NX)]
    highest = [element(i, NY - 1) for i in range(NX)]
    return "".join(
        [
            card("Assembly, name=Assembly"),
            "**\n",
            card("Instance, name=Wedge-1, part=Wedge"),
            card("End Instance"),
            "**\n",
            card(
                "Instance, name=Wedge-2, part=Wedge",
                ", ".join(map(real, shift)),
                ", ".join(map(real, turn)),
            ),
            card("End Instance"),
            "**\n",
            card(
                "Nset, nset=Bottom, instance=Wedge-1, generate",
                span(node(i, 0) for i in range(NX + 1)),
            ),
            card(
                "Nset, nset=Push, instance=Wedge-2, generate",
                span(node(NX, j) for j in range(NY + 1)),
            ),
            card("Nset, nset=Corner, instance=Wedge-2", f"{node(0, 0)},"),
            surface("Lower", "Wedge-1", "S3", highest),
            surface("Upper", "Wedge-2", "S3", highest),
            surface("Top", "Wedge-2", "S1", lowest),
            card("End Assembly"),
        ]
    )


def properties() -> str:
    """Amplitudes, material, contact and support."""
    pair = "Contact Pair, interaction=IntProp-1, type=NODE TO SURFACE"
    return "".join(
        [
            card("Amplitude, name=Clamp, definition=SMOOTH STEP", f"0., 0., {RAMP}, 1."),
            card("Amplitude, name=Drive, definition=SMOOTH STEP", f"0., 0., {DRIVE}, 1."),
            title("MATERIALS"),
            card("Material, name=Steel"),
            card("Density", f" {DENSITY},"),
            card("Elastic", f"{YOUNG}, {POISSON}"),
            title("INTERACTION PROPERTIES"),
            card("Surface Interaction, name=IntProp-1", "1.,"),
            card("Friction, lagrange", f" {FRICTION},"),
            card("Surface Behavior, pressure-overclosure=HARD"),
            title("BOUNDARY CONDITIONS", "", "Name: BC-1 Type: Symmetry/Antisymmetry/Encastre"),
            card("Boundary", "Bottom, ENCASTRE"),
            title("INTERACTIONS"),
            "** Interaction: Int-1\n",
            card(pair, "Upper, Lower"),
            "** Interaction: Int-2\n",
            card(pair, "Lower, Upper"),
        ]
    )


def step(name: str, duration: float, *cards: str) -> str:
    """A step with its cards and output requests."""
    return "".join(
        [
            "** " + 64 * "-" + "\n",
            title(f"STEP: {name}"),
            card(f"Step, name={name}, nlgeom=YES, inc=100000"),
            card("Dynamic,direct", f"{DT},{duration},"),
            *cards,
            title("OUTPUT REQUESTS"),
            card("Restart, write, frequency=0"),
            card("Monitor, dof=1, node=Corner, frequency=1"),
            card("Output, field, variable=PRESELECT, number interval=20"),
            card("Output, history"),
            card("Node Output, nset=Push", "RF1, RF2, U1, U2"),
            card("Node Output, nset=Corner", "U1, U2"),
            card("End Step"),
        ]
    )


def deck() -> str:
    """The whole deck."""
    held = "** Name: BC-2 Type: Displacement/Rotation\n"
    drive = card("Boundary, amplitude=Drive", f"Push, 1, 1, {TRAVEL}")
    return "".join(
        [
            card("Heading"),
            "** Job name: folding_wedges Model name: Model-1\n",
            card("Preprint, echo=NO, model=NO, history=NO, contact=NO"),
            title("PARTS"),
            part(),
            title("ASSEMBLY"),
            assembly(),
            properties(),
            step(
                "Clamp",
                RAMP,
                held,
                card("Boundary", "Push, 1, 1"),
                "** Name: Load-1 Type: Pressure\n",
                card("Dsload, amplitude=Clamp", f"Top, P, {PRESSURE}"),
            ),
            step("Drive", DRIVE, held, drive),
            step("Release", REST, card("Boundary, op=NEW", "Bottom, ENCASTRE")),
        ]
    )


def write(folder: Path) -> None:
    """Writes the deck into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "folding_wedges.inp").write_text(deck())


if __name__ == "__main__":
    write_to_folder(__doc__, HERE, write)
