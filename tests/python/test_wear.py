"""Work of friction, wear and heat at nodes against the contacts' work, in every formulation; forces of general contact."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, Job
from decks import parse
from oracle.checks import assert_holds
from stickslip.arrays import Array
from stickslip.deck import Deck
from stickslip.result import Result

DECKS = ROOT / "tests" / "decks"

WEAR = (DECKS / "wear.inp").read_text()
"""A block of area 1 and a friction of 3 that slides by 0.5: the work 1.5."""

PAIR = """*CONTACT PAIR, INTERACTION=I1, TYPE=NODE TO SURFACE
ST, SB
"""

GENERAL = """*CONTACT
*CONTACT INCLUSIONS, ALL EXTERIOR
*CONTACT PROPERTY ASSIGNMENT
, , I1
*CONTACT FORMULATION, TYPE={}
"""

FLOOR = """*NODE, NSET=REF
99, 0.0, -2.0
*SURFACE, NAME=FLOOR, TYPE=SEGMENTS
START, -0.5, 0.0
LINE, 2.5, 0.0
*RIGID BODY, ANALYTICAL SURFACE=FLOOR, REF NODE=REF
*BOUNDARY
REF, 1, 6
*CONTACT PAIR, INTERACTION=I1, TYPE={}
ST, FLOOR
"""

RATE = 2e-6 / 0.3

BOTH = ("NODE TO SURFACE", "SURFACE TO SURFACE")


def as_pair(text: str) -> Callable[[str], str]:
    """Puts another contact in the place of the pair."""
    return lambda deck: deck.replace(PAIR, text)


def ring(deck: str) -> str:
    """The block and its base as rings of large radius."""
    lines = []
    for line in deck.splitlines():
        values = line.split(",")
        if len(values) == 3 and all("." in value for value in values[1:]):
            values[1] = f" {float(values[1]) + 20.0}"
        lines.append(",".join(values))
    text = "\n".join(lines) + "\n"
    for old, new in (("CPE4", "CAX4"), ("MATERIAL=A\n1.0", "MATERIAL=A"), ("100000.0, 0.0", "1E5, 0.")):
        text = text.replace(old, new)
    return text


CASES: dict[str, tuple[Callable[[str], str], int, bool]] = {
    **{f"{kind} pair": (as_pair(PAIR.replace(BOTH[0], kind)), 1, True) for kind in BOTH},
    **{f"{kind} general": (as_pair(GENERAL.format(kind)), 2, False) for kind in BOTH},
    **{f"{kind} rigid": (as_pair(FLOOR.format(kind)), 1, True) for kind in BOTH},
    **{f"{kind} rings": (lambda deck, kind=kind: ring(deck.replace(BOTH[0], kind)), 1, False) for kind in BOTH},
}
"""The change of the deck, how many surfaces wear, and whether all nodes of the block wear alike."""


def on_block(result: Result, values: Array) -> Array:
    """Values at the lower nodes of the block."""
    return values[np.isin(result.node_labels, (1, 3, 5, 7, 9))]


@pytest.mark.parametrize("name", CASES)
def test_sums_over_nodes_are_those_of_the_contact(job: Job, name: str, tmp_path: Path) -> None:
    change, surfaces, is_uniform = CASES[name]
    path = job(parse(change(WEAR), tmp_path))
    with Result(path) as result:
        (contact,) = result.contact.values()
        work = contact["friction_dissipation"][-1]
        assert work > 1.0
        last = result.frames[-1]
        heat, wear, per_area = (last[field] for field in ("FRICTION_HEAT", "WEAR", "FRICTION_WORK"))
        assert np.nansum(heat) == pytest.approx(work, rel=1e-10)
        assert on_block(result, heat).sum() == pytest.approx(work / surfaces, rel=1e-10)
        assert result.history.certificate["surface_work"].max() < 1e-10
        if is_uniform:
            worn = np.isfinite(wear)
            assert np.allclose(wear[worn], RATE * per_area[worn], rtol=1e-10, atol=0.0)
            assert on_block(result, per_area) == pytest.approx(np.full(5, 1.5), rel=1e-9)
            assert on_block(result, wear) == pytest.approx(np.full(5, 1e-5), rel=1e-9)
    assert_holds(path)


def test_the_heat_of_a_disc_is_its_part_of_the_work(job: Job) -> None:
    path = job(Deck.read(DECKS / "disc_heat.inp"))
    with Result(path) as result:
        work = result.history.energy["friction_dissipation"][-1]
        heat = result.frames[-1]["FRICTION_HEAT"]
        assert work > 0.05
        assert np.nansum(heat) == pytest.approx(0.36 * work, rel=1e-10)
        # a disc has no faces over whose area work and wear could be told
        assert np.isnan(result.frames[-1]["WEAR"]).all()
        assert np.count_nonzero(np.nan_to_num(heat)) == 1
    assert_holds(path)


@pytest.mark.parametrize("kind", BOTH)
def test_self_contact_heats_both_faces(job: Job, kind: str, tmp_path: Path) -> None:
    text = (DECKS / "self_contact.inp").read_text().replace(BOTH[0], kind)
    text = text.replace("NAME=DRY\n", "NAME=DRY\n*FRICTION\n0.05\n*GAP HEAT GENERATION\n0.9, 0.4\n")
    path = job(parse(text, tmp_path))
    with Result(path) as result:
        work = result.history.energy["friction_dissipation"][-1]
        assert work > 0.0
        heat = result.frames[-1]["FRICTION_HEAT"]
        assert np.nansum(heat) == pytest.approx(0.9 * work, rel=1e-10)
        is_upper = result.coordinates[:, 1] > 0.33
        assert np.nansum(heat[is_upper]) == pytest.approx(0.45 * work, rel=1e-10)
        assert result.history.certificate["surface_work"].max() < 1e-10


@pytest.mark.parametrize("kind", BOTH)
def test_the_force_of_general_contact_is_that_on_the_first_body(
    job: Job, kind: str, tmp_path: Path
) -> None:
    with Result(job(parse(WEAR.replace(PAIR, GENERAL.format(kind)), tmp_path))) as result:
        contact = result.contact["ALL_EXTERIOR"]
        assert contact["force"][-1] == pytest.approx([-3.0, 10.0], rel=1e-9)
        assert np.allclose(contact["force"], contact["body_force"][:, 0], rtol=1e-12, atol=1e-12)
        assert np.allclose(contact["moment"], contact["body_moment"][:, 0], rtol=1e-12, atol=1e-11)
