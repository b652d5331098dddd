"""Cards that decks are made of."""

from collections.abc import Sequence


def card(keyword: str, *rows: Sequence[object]) -> str:
    """Text of one card: its keyword line and data lines; floats are written with repr."""
    lines = ["*" + keyword]
    lines += [
        ", ".join(repr(float(x)) if isinstance(x, float) else str(x) for x in row) for row in rows
    ]
    return "\n".join(lines) + "\n"


def material(name: str, young: float, poisson: float, density: float, **damping: float) -> str:
    """An elastic material; zero parameters of its damping are left out."""
    parameters = "".join(f", {key.upper()}={value!r}" for key, value in damping.items() if value)
    return "".join(
        [
            card(f"MATERIAL, NAME={name}"),
            card("ELASTIC", (young, poisson)),
            card("DENSITY", (density,)),
            card(f"DAMPING{parameters}") if parameters else "",
        ]
    )


def elastic(
    young: float,
    poisson: float,
    density: float,
    *sets: str,
    thickness: float = 1.0,
    **damping: float,
) -> str:
    """A material and the sections of element sets that are made of it."""
    return "".join(
        [
            material("ELASTIC", young, poisson, density, **damping),
            *(
                card(f"SOLID SECTION, ELSET={name}, MATERIAL=ELASTIC", (thickness,))
                for name in sets
            ),
        ]
    )


def dry(friction: float) -> str:
    """The interaction DRY with a coefficient of friction."""
    return card("SURFACE INTERACTION, NAME=DRY") + card("FRICTION", (friction,))


def step(dt: float, increments: int, *cards: str) -> str:
    """A step of equal increments with its cards."""
    head = card(f"STEP, NLGEOM, INC={increments}")
    return "".join([head, card("DYNAMIC, DIRECT", (dt, increments * dt)), *cards, card("END STEP")])
