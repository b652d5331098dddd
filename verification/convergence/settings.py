"""Settings that the decks have in common."""

from math import cos, pi

from stickslip.decks import card

SCHEMES = {"default": "", "ss22": ", SCHEME=SS22, THETA1=1., THETA2=1."}
"""The energy-momentum scheme, and the paper's."""


def settings(scheme: str, tolerance: float | None = None) -> str:
    """Card STICKSLIP with a scheme and a tolerance; nothing where both are the defaults."""
    text = SCHEMES[scheme] + (f", TOLERANCE={tolerance!r}" if tolerance else "")
    return card(f"STICKSLIP{text}") if text else ""


def ramp(name: str, start: float, end: float) -> str:
    """Card AMPLITUDE that rises from 0 to 1 as half a cosine."""
    points = 20
    parts = [k / points for k in range(points + 1)]
    rising = [(start + part * (end - start), 0.5 - 0.5 * cos(pi * part)) for part in parts]
    held = (end + 1e3 * (end - start), 1.0)
    before = [(0.0, 0.0)] if start > 0.0 else []
    return card(f"AMPLITUDE, NAME={name}", *before, *rising, held)
