"""A parameter study: how far a block slides, over friction and speed, against the formula.

A stiff block is thrown along a fixed beam. It stops after v^2/(2 mu g). Needs the packages of
`pip install 'stickslip[sweep]'`. Run it in a checkout with `scripts/venv docs/tutorial_study.py`.
"""

import numpy as np
from stickslip import Deck
from stickslip.mesh import Mesh
from stickslip.sweep import Settings, product, sweep
from stickslip.sweep.engine import told_on_screen
from stickslip.sweep.plots import draw_all

GRAVITY = 10.0
SPEED = 1.0


def rectangle(name: str, left: float, bottom: float, size: tuple[float, float], nx: int) -> Mesh:
    """A rectangle of nx elements side by side, with its lower and its upper side."""
    x, y = np.meshgrid(left + np.linspace(0.0, size[0], nx + 1), bottom + np.array([0.0, size[1]]))
    below = np.arange(nx)
    above = below + nx + 1
    elements = np.column_stack([below, below + 1, above + 1, above])
    sides = {f"{name}_BOTTOM": elements[:, :2], f"{name}_TOP": elements[:, 2:]}
    points = np.column_stack([x.ravel(), y.ravel()])
    nodes = {f"{name}_NODES": np.arange(len(points))}
    return Mesh(points, elements, {name: np.arange(nx)}, nodes, sides)


def sliding_block() -> Deck:
    """The deck with the parameters mu, speed and time."""
    deck = Deck.titled("block that slides to rest")
    deck.add_mesh(rectangle("BEAM", 0.0, -0.1, (1.0, 0.1), 25))
    deck.add_mesh(rectangle("BLOCK", 0.1, 0.0, (0.2, 0.1), 4))
    deck.elastic("STIFF", young=1e7, poisson=0.0, density=1000.0)
    deck.section("BEAM", "STIFF").section("BLOCK", "STIFF")
    deck.contact("BLOCK_BOTTOM", "BEAM_TOP", friction="<mu>")
    deck.support("BEAM_NODES")
    deck.add("INITIAL CONDITIONS, TYPE=VELOCITY", ("BLOCK_NODES", 1, "<speed>"))
    with deck.step(dt=0.002, duration=0.6, scheme="SS22", theta1=1.0, theta2=1.0):
        deck.gravity("BLOCK", GRAVITY)
        deck.history("BLOCK_NODES")
    return deck


def main() -> None:
    """The study: 3 x 2 points, their table, its pictures, and the formula."""
    points = product({"mu": [0.2, 0.3, 0.4], "speed": [0.5, SPEED]})
    way = "nodes/BLOCK_NODES/U:1@max"
    quantities = [way, "energy/friction_dissipation@last"]
    settings = Settings(options=("--frames", "10"), tell=told_on_screen)
    table = sweep(sliding_block(), points, "results/tutorial_study", quantities, settings)
    for path in [
        *table.write("results/tutorial_study"),
        *draw_all(table, "results/tutorial_study"),
    ]:
        print(f"wrote {path}")
    for row in table.rows:
        expected = row["speed"] ** 2 / (2.0 * row["mu"] * GRAVITY)
        print(f"mu {row['mu']}, speed {row['speed']}: {row[way]:.4f}, formula {expected:.4f}")


if __name__ == "__main__":
    main()
