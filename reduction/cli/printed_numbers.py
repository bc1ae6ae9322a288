"""Formats numbers for commands: null if unknown, short text for tables."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from rich.markup import escape
from rich.table import Table

from reduction.quantities.digits import fixed_number, places_within, plain_number

_LARGE, _HUGE = 1e5, 1e7


def plain(values: ArrayLike) -> Any:
    """Numbers for JSON in the same nesting; None if not finite."""
    array = np.asarray(values)
    if array.ndim:
        return [plain(entry) for entry in array]
    number = array.item()
    return None if isinstance(number, float) and not math.isfinite(number) else number


def short(value: float, digits: int = 5) -> str:
    """A number for a table; a dash if there is none."""
    return plain_number(value, digits) if math.isfinite(value) else "-"


def as_given(value: float) -> str:
    """A level for a table, with all digits before the point."""
    return f"{value:.0f}" if _LARGE <= abs(value) < _HUGE else short(value)


def within(value: float, *halves: float) -> str:
    """A number with the precision of its interval half-widths: two digits of the narrowest.

    Examples
    --------
    >>> within(280991.3, 2100.0), within(280991.3, float("nan"))
    ('281000', '280990')
    """
    places = places_within(value, *halves) if math.isfinite(value) else None
    return short(value) if places is None else fixed_number(value, places, mark="")


def table_of(*headings: str, texts: int = 1, title: str | None = None) -> Table:
    """An empty table whose first columns are text and the others numbers."""
    table = Table(box=None, pad_edge=False, title=title, title_justify="left", title_style="bold")
    for number, heading in enumerate(headings):
        # on narrow screens names are broken, but never numbers
        if number < texts:
            table.add_column(escape(heading), overflow="fold")
        else:
            table.add_column(escape(heading), justify="right", no_wrap=True)
    return table
