"""Bodies that slide smoothly go on sliding smoothly, whatever becomes of the energy of landings."""

import numpy as np
import pytest
from conftest import ROOT, Job
from decks import shortened
from stickslip.result import Result

PAD = ROOT / "input" / "brake_pad" / "brake_pad_damped.inp"

OPTIONS = [
    {"LANDING": "RETURN"},
    {"CONTACT MASS": "REDISTRIBUTED"},
    {"CONTACT MASS": "REDISTRIBUTED", "LANDING": "RETURN"},
]


@pytest.mark.parametrize("options", OPTIONS, ids=lambda options: "_".join(options.values()))
def test_a_damped_pad_slides_without_chatter(job: Job, options: dict[str, str]) -> None:
    """In steady sliding the friction is mu = 0.5 of the normal force, which hardly varies."""
    deck = shortened(PAD, 1200, "default")
    deck.set_settings(**options)
    with Result(job(deck)) as result:
        (contact,) = result.history.contact.values()
        slides = result.history.time > 0.3
        normal, tangential = (f[slides] for f in (contact.normal, contact.tangential))
        assert np.all(contact.closed[slides] > 0)
        assert abs(np.mean(tangential)) / np.mean(normal) == pytest.approx(0.5, rel=1e-6)
        assert np.std(normal) / np.mean(normal) < 0.06
