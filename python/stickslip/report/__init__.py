"""The report page of a result: one HTML file that works offline (docs/report.md).

`stickslip report RESULT.vtkhdf` writes the report page of a result.
"""

from stickslip.report.collect import Choice
from stickslip.report.page import page_of

__all__ = ["Choice", "page_of"]
