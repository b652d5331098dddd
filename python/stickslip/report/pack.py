"""Arrays as short text for a page.

The values v of an array are mapped to whole numbers q, whose differences from row to row are small. The bytes of the
differences are sorted by significance, deflated and written in base64; `page/decode.js` reverses these three
operations. Three maps lead from values to whole numbers:

* `linear`: the value is v = step q; the error is at most step/2;
* `curved`: the value is v = small sinh(fine q); the error is about fine/2 times the value, or times `small` if `small`
  is larger;
* `bits`: q is the bit pattern of the value v as a float32.
"""

import base64
import zlib
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

FINE = 5e-4
"""Relative distance of neighbouring values of the curved map."""

LARGEST_WHOLE = 2**30
"""Whole numbers stay below this, so that their differences fit into 32 bits."""

ORDERS = (0, 1, 2)
"""Orders of the differences from row to row that are tried."""


@dataclass
class Packed:
    """The packed arrays (blobs) of a page; the description of an array names its blob."""

    blobs: list[str] = field(default_factory=list)

    def linear(self, values: NDArray[Any], step: float) -> dict[str, Any]:
        """Values [rows, columns] that need an absolute accuracy; NaN is not allowed."""
        largest = float(np.abs(values).max(initial=0.0))
        step = max(step, largest / LARGEST_WHOLE)
        whole = (
            np.rint(np.asarray(values, dtype=np.float64) / step)
            if step > 0
            else np.zeros(values.shape)
        )
        return self._add(whole.astype(np.int32), {"map": "linear", "step": step})

    def whole(self, values: NDArray[Any]) -> dict[str, Any]:
        """Whole numbers [rows, columns] below 2^30."""
        return self._add(np.asarray(values, dtype=np.int32), {"map": "linear", "step": 1})

    def curved(self, values: NDArray[Any]) -> dict[str, Any]:
        """Values [rows, columns] that need a relative accuracy; NaN and infinity become NaN."""
        values = np.asarray(values, dtype=np.float64)
        finite = np.isfinite(values)
        size = np.abs(values[finite])
        largest = float(size.max(initial=0.0))
        if largest == 0.0:
            small = 1.0
        else:
            typical = float(np.median(size[size > 0.0])) / 10.0
            small = min(max(typical, 1e-7 * largest), 1e-3 * largest)
        whole = np.zeros(values.shape)
        whole[finite] = np.rint(np.arcsinh(values[finite] / small) / FINE)
        none = int(np.abs(whole).max(initial=0.0)) + 1
        whole[~finite] = none
        return self._add(
            whole.astype(np.int32), {"map": "curved", "small": small, "fine": FINE, "none": none}
        )

    def bits(self, values: NDArray[Any]) -> dict[str, Any]:
        """Values [rows, columns] as float32."""
        return self._add(np.ascontiguousarray(values, dtype="<f4").view(np.int32), {"map": "bits"})

    def _add(self, whole: NDArray[np.int32], description: dict[str, Any]) -> dict[str, Any]:
        columns = int(np.prod(whole.shape[1:]))
        whole = whole.reshape(len(whole), columns)
        order, differences = _shortest(whole)
        # 0, -1, 1, -2, 2 .. become 0, 1, 2, 3, 4 ..
        folded = ((differences << 1) ^ (differences >> 31)).astype("<u4").ravel()
        planes = max(1, -(-int(folded.max(initial=0)).bit_length() // 8))
        sorted_bytes = folded.view(np.uint8).reshape(-1, 4).T[:planes]
        deflated = zlib.compress(np.ascontiguousarray(sorted_bytes).tobytes(), 6)
        self.blobs.append(base64.b64encode(deflated).decode("ascii"))
        shape = {"rows": whole.shape[0], "columns": columns, "planes": planes, "order": order}
        return {"blob": len(self.blobs) - 1, **shape, **description}


def _shortest(whole: NDArray[np.int32]) -> tuple[int, NDArray[np.int32]]:
    """The order of differences that needs the fewest bits, and the differences; sums of differences wrap around at
    2^32."""
    candidates = [whole]
    for _ in ORDERS[1:]:
        previous = candidates[-1]
        candidates.append(np.concatenate([previous[:1], previous[1:] - previous[:-1]]))
    bits = [
        np.log2(1.0 + np.abs(each[:: max(1, len(each) // 40)].astype(np.float64))).sum()
        for each in candidates
    ]
    order = int(np.argmin(bits))
    return order, candidates[order]
