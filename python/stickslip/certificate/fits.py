"""Steps in which overlaps of fits change: in such steps the result file does not state the overlap that is left."""

from stickslip.frame import Frame
from stickslip.result import Result

REASON = "the deck changes overlaps in some steps"


class Fits:
    """The steps of a run in which the deck changes overlaps."""

    def __init__(self, result: Result) -> None:
        self._time = result.history["time"]
        self._step = result.history["step"]
        self.steps, self.last = _steps(result.deck)

    def changes(self, frame: Frame) -> bool:
        """Whether overlaps change in the step of a frame, or may have changed in earlier steps."""
        step = self.step(frame)
        return step in self.steps or step >= self.last

    def step(self, frame: Frame) -> int:
        """Number of the step of a frame, from 1; 0 if no increment ends at its time."""
        rows = (self._time == frame.time).nonzero()[0]
        return int(self._step[rows[-1]]) if len(rows) else 0


def _steps(deck: str) -> tuple[set[int], float]:
    """Steps whose changes of overlaps end with the step, and the first step whose changes may persist."""
    step, steps, last = 0, set(), float("inf")
    goes_on = False
    for line in deck.upper().splitlines():
        card = line.replace(" ", "")
        if card.startswith("*STEP"):
            step += 1
        elif card.startswith("*RESTART") and ",READ" in card:
            goes_on = True
        elif card.startswith("*CONTACTINTERFERENCE"):
            steps.add(step)
            if "AMPLITUDE=" in card:
                last = min(last, step)
        elif card.startswith("*CONTACTINITIALIZATIONDATA") and "INTERFERENCEFIT" in card:
            steps.add(1)
    # the text of an earlier job stands behind the deck, so that its steps are not counted here
    return steps, 0 if goes_on and (steps or last < float("inf")) else last
