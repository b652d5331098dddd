"""Numbers out of results, by the expressions of `case.toml`."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from form import Form, Run
from stickslip.arrays import Array
from stickslip.result import Result

FUNCTIONS: dict[str, Any] = {
    name: getattr(np, name)
    for name in ("sin", "cos", "tan", "arcsin", "arccos", "arctan2", "sinh", "cosh", "arccosh", "exp", "log", "sqrt")
    + ("hypot", "abs", "sign", "minimum", "maximum", "where", "diff", "interp", "argmax", "argsort", "nan_to_num")
} | {
    "pi": math.pi, "np": np, "max": np.max, "min": np.min, "sum": np.sum, "len": len, "range": range, "float": float,
    "str": str, "round": round,
}
"""What expressions know."""


class Values:
    """Evaluates expressions over a run of a case and its result.

    Besides FUNCTIONS they know the constants of the case and the parameters of the run by their
    names, `time`, `result`, `history(NAME)`, `last(NAME)`, `at(NAME, t)`, `mean(NAME, t0, t1)`,
    `field(NAME, SET)` (rows of the last frame), `place(SET)` (reference coordinates) and `reference(NAME)`.
    Names of histories are those of the plots.
    """

    def __init__(self, form: Form, run: Run, result: Result | None) -> None:
        self.form, self.run = form, run
        names: dict[str, Any] = dict(FUNCTIONS)
        names |= {key: value for key, value in run.parameters.items()}
        for key, text in form.constants.items():
            if key not in run.parameters:
                names[key] = evaluate(text, names) if isinstance(text, str) else text
        names["reference"] = self.reference
        if result is not None:
            names |= readers(result)
        self.names = names

    def __call__(self, text: str) -> Any:
        """Value of an expression."""
        return evaluate(text, self.names)

    def named(self, name: str) -> str:
        """The name of a reference with `{run}` and parameters filled in."""
        return name.format(run=self.run.name, **self.run.parameters)

    def reference(self, name: str) -> float:
        """The number of a row of `reference.csv`."""
        (value,) = self.form.references[self.named(name)].value
        return float(value)


def evaluate(text: str, names: Mapping[str, Any]) -> Any:
    """Value of an expression; names stand for themselves in comprehensions too."""
    return eval(text, {"__builtins__": {}} | dict(names))  # noqa: S307


def readers(result: Result) -> dict[str, Any]:
    """Functions that read a result."""

    def history(name: str) -> Array:
        return result.quantity(name)

    def last(name: str) -> float:
        return result.quantity(name)[-1]

    def at(name: str, t: float) -> float:
        return float(np.interp(t, result.history.time, result.quantity(name)))

    def mean(name: str, start: float, end: float) -> float:
        """Mean over increments that end in an interval, weighted by their lengths."""
        time, dt = result.history.time, result.history.dt
        within = (time > start * (1 + 1e-12)) & (time <= end * (1 + 1e-12))
        return float((result.quantity(name) * dt)[within].sum() / dt[within].sum())

    def members(name: str, nodes: str) -> Any:
        if f"model/node_sets/{nodes}" in result.file and len(result.frames[-1][name]) == len(result.coordinates):
            return result.node_set(nodes)
        return result.element_set(nodes)

    def field(name: str, nodes: str) -> Array:
        return np.asarray(result.frames[-1][name])[members(name, nodes)]

    def place(nodes: str) -> Array:
        return result.coordinates[result.node_set(nodes)]

    def centre(elements: str) -> Array:
        """Middles of the undeformed elements of a set."""
        return np.array([result.coordinates[result.cells[k]].mean(axis=0) for k in result.element_set(elements)])

    functions = (history, last, at, mean, field, place, centre)
    return {one.__name__: one for one in functions} | {"time": result.history.time, "result": result}
