"""Bodies on bodies under their weight, with general contact: a stack, an arch, a card house."""

from math import cos, pi, sin

from lab.bench_dense import wall
from stickslip.decks import Grid, card, dry, elastic, step

GRAVITY = 9.81


def stack(blocks: int = 10, friction: float = 0.0, increments: int = 500) -> str:
    """Unit blocks on each other on a fixed base."""
    bodies = [Grid("BASE", 6, 1, lambda i, j: (0.5 * i - 1.0, 0.5 * j - 0.5))]
    for level in range(blocks):
        labels = bodies[-1].next_node, bodies[-1].next_element

        def place(i: int, j: int, level: int = level) -> tuple[float, float]:
            return 0.5 * i, level + 0.5 * j

        bodies.append(Grid(f"BLOCK{level + 1}", 2, 2, place, *labels))
    about = f"{blocks} blocks on each other; friction {friction}"
    return masonry(about, bodies, ["BASE"], 1e5, friction, 0.005, increments)


def arch(stones: int = 9, friction: float = 0.7, increments: int = 300) -> str:
    """Stones of a half ring, radii 4 and 5, between two fixed abutments."""
    bodies: list[Grid] = []
    labels = 1, 1
    for stone in range(stones):

        def place(i: int, j: int, stone: int = stone) -> tuple[float, float]:
            angle = pi * (stone + j / 3) / stones
            return (4.0 + 0.5 * i) * cos(angle), (4.0 + 0.5 * i) * sin(angle)

        bodies.append(Grid(f"STONE{stone + 1}", 2, 3, place, *labels))
        labels = bodies[-1].next_node, bodies[-1].next_element
    for name, left in (("RIGHT", 3.5), ("LEFT", -5.5)):
        at = bodies[-1].next_node, bodies[-1].next_element
        bodies.append(Grid(name, 4, 1, lambda i, j, x=left: (x + 0.5 * i, 0.5 * j - 0.5), *at))
    about = f"an arch of {stones} stones; friction {friction}"
    return masonry(about, bodies, ["RIGHT", "LEFT"], 1e6, friction, 0.002, increments)


def card_house(friction: float = 0.0, increments: int = 400) -> str:
    """Two cards 1 x 0.04 that lean against each other on a fixed floor; without friction they slide
    apart."""
    lean, depth = pi / 9.0, 0.04
    floor = Grid("FLOOR", 12, 1, lambda i, j: (0.5 * i - 3.0, 0.5 * j - 0.5))

    def left(i: int, j: int) -> tuple[float, float]:
        up, out = i / 10, depth * j
        return (up - 1.0) * sin(lean) - out * cos(lean), up * cos(lean) + out * sin(lean)

    def right(i: int, j: int) -> tuple[float, float]:
        x, y = left(i, 1 - j)
        return -x, y

    one = Grid("CARD1", 10, 1, left, floor.next_node, floor.next_element)
    two = Grid("CARD2", 10, 1, right, one.next_node, one.next_element)
    about = f"two cards that lean against each other; friction {friction}"
    return masonry(about, [floor, one, two], ["FLOOR"], 1e6, friction, 0.001, increments)


def shaken_wall(courses: int = 5, shaking: float = 4.0, increments: int = 200) -> str:
    """As many bricks in a course as there are courses, in running bond on ground that shakes with this acceleration;
    the wall weighs 10."""
    return wall(courses, courses, 2, increments, shaking)


def masonry(
    about: str,
    bodies: list[Grid],
    fixed: list[str],
    young: float,
    friction: float,
    dt: float,
    increments: int,
) -> str:
    """A deck of bodies in general contact, some of them fixed, under gravity."""
    return "".join(
        [
            card("HEADING", (about,)),
            *(body.mesh("CPS4") for body in bodies),
            elastic(young, 0.3, 1.0, *(body.name for body in bodies)),
            dry(friction),
            card("CONTACT"),
            card("CONTACT INCLUSIONS, ALL EXTERIOR"),
            card("CONTACT PROPERTY ASSIGNMENT", ("", "", "DRY")),
            card("BOUNDARY", *((name, 1, 2) for name in fixed)),
            step(dt, increments, card("DLOAD", ("", "GRAV", GRAVITY, 0.0, -1.0))),
        ]
    )
