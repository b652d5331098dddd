"""Support of notebooks: a test whether Python runs in a notebook, display of results, and a bar that shows the progress
of a run.

The module uses IPython if it is installed.
"""

import html
import sys
from collections.abc import Callable
from typing import Any, ClassVar

from stickslip.errors import Fault


def runs_here() -> bool:
    """Whether Python runs in a notebook."""
    shell = sys.modules.get("IPython")
    return shell is not None and hasattr(shell.get_ipython(), "kernel")


class Shown:
    """An object that displays itself at the end of a cell."""

    summaries: ClassVar[dict[type, Callable[[Any], str]]] = {}
    """Makes the HTML of an object, by its class; `summary` knows how."""

    def _repr_html_(self) -> str | None:
        make = self.summaries.get(type(self))
        return make(self) if make else None


class Paged(Shown):
    """An object that displays itself and also has a report page."""

    pages: ClassVar[dict[type, Callable[[Any, int], str]]] = {}
    """Makes the page of an object in a frame of a height in pixels, by its class; `summary` knows how."""

    def show(self, height: int = 780) -> None:
        """Shows the report page below the cell of a notebook."""
        if not runs_here():
            raise Fault("show() is for notebooks: the command stickslip report writes the page")
        from IPython.display import HTML, display

        display(HTML(self.pages[type(self)](self, height)))


class Bar:
    """A bar below the cell that shows the progress of a run; a call with a `Progress` moves the bar."""

    def __init__(self) -> None:
        from IPython.display import HTML, display

        self._html: Any = HTML
        self._shown: Any = display(HTML(""), display_id=True)

    def __call__(self, progress: Any) -> None:
        part: float | None = progress.part
        value = "" if part is None else f' value="{min(part, 1.0):.4f}"'
        self._shown.update(self._html(f"<progress{value} style='width:40%'></progress> {html.escape(str(progress))}"))
