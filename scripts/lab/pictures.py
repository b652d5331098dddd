"""Draws the pictures of docs/pictures, from results of the program.

    scripts/lab/run pictures                 all
    scripts/lab/run pictures patch vertex    these

Pictures of examples are drawn by the commands in their READMEs.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from PIL import Image
from stickslip import program
from stickslip.deck import Deck
from stickslip.mesh import Mesh
from stickslip.plot import style

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs" / "pictures"

KINDS = ("node to surface", "surface to surface")


@style.styled
def kinds(_: Path) -> Figure:
    """What both kinds of contact keep out, drawn by hand."""
    figure, axes = style.subplots(1, 2, figsize=(8.0, 2.6))
    x = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    for axis, kind, heights in zip(axes, KINDS, ([0.75, 0.0, 0.0, 0.35, 0.9], [0.75, 0.16, -0.14, 0.12, 0.9])):
        y = np.array(heights)
        axis.fill_between([-0.3, 4.3], -0.8, 0.0, color="#d8d8d8")
        axis.plot([-0.3, 2.0, 4.3], [0.0, 0.0, 0.0], "o-", color="#555555", markersize=4)
        axis.fill_between(x, y, 1.3, color="#9ec1e6")
        axis.plot(x, y, "o-", color="#0b559f", markersize=5)
        if kind == "node to surface":
            axis.plot(x[1:3], y[1:3], "o", color="#d1495b", markersize=7)
            said = "closed: gap of the node is 0"
        else:
            axis.fill_between([1.0, 2.0, 3.0], y[1:4], 0.0, color="#d1495b", alpha=0.5)
            axis.plot(2.0, y[2], "o", color="#d1495b", markersize=7)
            said = "closed: weighted mean of the gap\nover both faces at the node is 0"
        axis.annotate(said, (2.0, y[2]), (1.2, -0.68), arrowprops={"arrowstyle": "-", "color": "#d1495b"}, color="#a02030")
        axis.text(0.05, 1.07, "slave", color="#0b559f")
        axis.text(-0.25, -0.25, "master")
        axis.set(title=kind, xlim=(-0.3, 4.3), ylim=(-0.8, 1.3), aspect="equal")
        axis.axis("off")
    return figure


def blocks(kind: str, slave: str) -> Deck:
    """Two blocks with 16 and 7 elements along their common side, pressed by 1."""
    deck = Deck.titled(f"two pressed blocks, {kind}, slave {slave}")
    for name, count, low in (("LOWER", 7, -1.0), ("UPPER", 16, 0.0)):
        columns, rows = count + 1, count // 2 + 1
        place = [(2.0 * (k % columns) / count, low + (k // columns) / (rows - 1)) for k in range(columns * rows)]
        first = [row * columns + column for row in range(rows - 1) for column in range(count)]
        elements = [[a, a + 1, a + 1 + columns, a + columns] for a in first]
        bottom, top = np.arange(columns), np.arange(columns) + columns * (rows - 1)
        sides = {"B": bottom, "T": top}
        mesh = Mesh(
            place,
            elements,
            {name: np.arange(len(elements))},
            {f"{name}_{side}N": nodes for side, nodes in sides.items()},
            {f"{name}_{side}": np.stack([nodes[:-1], nodes[1:]], axis=1) for side, nodes in sides.items()},
        )
        deck.add_mesh(mesh)
        deck.elastic(f"M{name}", young=1000.0, poisson=0.0, density=1.0).section(name, f"M{name}")
    sides = ("UPPER_B", "LOWER_T") if slave == "UPPER" else ("LOWER_T", "UPPER_B")
    deck.contact(*sides, 0.0, kind)
    deck.support("LOWER_BN").support("UPPER_TN", 1)
    with deck.static_step():
        deck.pressure("UPPER_T", 1.0)
    return deck


@style.styled
def patch(folder: Path) -> Figure:
    """The stress in the elements above the face of two pressed blocks, by kind of contact and slave."""
    figure, axes = style.subplots(figsize=(7.0, 3.2))
    for kind, slave in ((KINDS[0], "UPPER"), (KINDS[0], "LOWER"), (KINDS[1], "UPPER")):
        result = program.run(blocks(kind, slave), folder, job=f"{kind.split()[0]}_{slave}")
        frame = result.frames[-1]
        place = np.array([result.coordinates[nodes].mean(axis=0) for nodes in result.cells])
        row = (place[:, 1] > 0.0) & (place[:, 1] < 0.1)
        stress = frame["S22"][row]
        name = f"{kind}, the {'finer' if slave == 'UPPER' else 'coarser'} side is the slave: {100 * np.abs(stress + 1).max():.2g} %"
        axes.plot(place[row, 0], stress, "o-", markersize=4, label=name)
    axes.set(xlabel="place along the face", ylabel="stress / pressure", ylim=(-1.3, -0.7))
    figure.legend(title="largest error of the stress", loc="outside lower center", title_fontsize=8)
    return figure


@style.styled
def vertex(folder: Path) -> Figure:
    """The lowest vertices of the rubber ring when it is pressed flat, with both kinds of contact; heights are exaggerated."""
    figure, axes = style.subplots(1, 2, figsize=(8.0, 2.2), sharey=True)
    for axis, kind in zip(axes, KINDS):
        deck = Deck.read(ROOT / "input" / "rubber_ring" / "rubber_ring_mu05.inp")
        deck.set_formulation(kind.upper())
        result = program.run(deck, folder, job=kind.replace(" ", "_"), every=0.001)
        at = int(np.argmax(result.history.certificate.penetration if kind == KINDS[1] else result.contact["RING_FLOOR"].closed))
        frame = result.frame(float(result.history.time[at]))
        outer = result.read("model/contacts/RING_FLOOR/slaves")
        place = frame.positions[outer]
        place = place[np.argsort(place[:, 0])]
        place = place[place[:, 1] < 0.06]
        axis.axhspan(-1.0, 0.0, color="#d8d8d8")
        axis.plot(place[:, 0], place[:, 1], "o-", markersize=4)
        depth = float(result.history.certificate.penetration[at])
        axis.set(title=f"{kind}: largest overlap {depth if depth > 1e-9 else 0:.2g} of a face", xlabel="x", ylim=(-0.02, 0.05))
    axes[0].set_ylabel("height over the floor")
    return figure


def slide(folder: Path) -> None:
    """Place, speed and friction of the block of docs/slide.inp, and its model as the program draws it."""
    deck = ROOT / "docs" / "slide.inp"
    program.run(deck, folder)
    words = ["--y", "nodes/ALL/U:1", "--y", "contact/FOOT_FLOOR/force"]
    call("history", folder / "slide.vtkhdf", *words, "-o", FOLDER / "slide.png", "--dpi", "80")
    picture = ("--picture", FOLDER / "slide_model.svg", "--window=-0.3,0.5,-0.15,0.25", "--overwrite")
    subprocess.run([program.binary(), "check", deck, *picture], check=True, stdout=subprocess.DEVNULL)


def along(folder: Path) -> None:
    """The contact pressure along the face of the brake pad."""
    program.run(ROOT / "input" / "brake_pad" / "brake_pad_damped.inp", folder)
    call("along", folder / "brake_pad_damped.vtkhdf", "--interval", "0.25", "-o", FOLDER / "along.png", "--dpi", "80")


def gmsh(_: Path) -> None:
    """The picture of the tutorial with Gmsh."""
    subprocess.run([sys.executable, ROOT / "docs" / "tutorial_gmsh.py"], cwd=ROOT, check=True)
    picture = Image.open(ROOT / "results" / "tutorial_gmsh.png").convert("RGB")
    picture.thumbnail((900, 900))
    picture.quantize(128).save(FOLDER / "gmsh.png", optimize=True)


def call(plot: str, *words: object) -> None:
    """Runs a command of the plots."""
    subprocess.run([sys.executable, "-m", f"stickslip.plot.{plot}", *map(str, words)], check=True)


PICTURES = {"kinds": kinds, "patch": patch, "vertex": vertex, "slide": slide, "along": along, "gmsh": gmsh}
"""Each draws a figure for its name, or writes its pictures itself."""


def main() -> None:
    """Draws the pictures that are named, or all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", choices=[*PICTURES, []], default=list(PICTURES), metavar="NAME")
    FOLDER.mkdir(exist_ok=True)
    for name in parser.parse_args().names:
        with tempfile.TemporaryDirectory() as folder:
            figure = PICTURES[name](Path(folder))
            if figure is not None:
                style.save(figure, FOLDER / f"{name}.png", 90)
        print(name)


if __name__ == "__main__":
    main()
