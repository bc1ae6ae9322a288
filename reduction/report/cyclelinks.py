"""When each cycle of a test was, for figures in which a reader chooses one.

A cycle chosen in one figure is shown in the others of its test.  What a figure can show of it
stands in the figure: ``layout.meta`` names the axis that a cycle has a place on (``cycles`` is
``"time"`` or ``"number"``), and ``meta`` of a trace the cycle that it is drawn of.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.record import Floats
from reduction.report.figure import plain_numbers, script_json
from reduction.report.view import TestView

MOST = 4000
"""Most cycles of a test that a reader can choose from; a page has to stay small."""
_DIGITS = 9


@dataclass(frozen=True)
class CycleLinks:
    """Cycles of a test that can be chosen: their numbers, and from when to when each was.

    Parameters
    ----------
    count : int
        Number of cycles of the test.
    number, start, end : ndarray, shape (n_listed,)
        Rising numbers; elapsed time at start and end, NaN where it is not known. [1], [s]
    """

    count: int
    number: Floats
    start: Floats
    end: Floats

    def json(self) -> str:
        """The same for a script element; numbers are left out where all cycles are listed."""
        document: dict[str, object] = {
            "count": self.count,
            "start": plain_numbers(self.start, _DIGITS),
            "end": plain_numbers(self.end, _DIGITS),
        }
        if self.number.size < self.count:
            document["number"] = [int(one) for one in self.number]
        return script_json(document)


def cycle_links(view: TestView) -> CycleLinks | None:
    """Return the cycles of a test that a reader can choose; None where there are not two.

    Of a test with more than `MOST` cycles some are listed: evenly spaced ones, and those of
    which a loop or a curve is drawn.

    Examples
    --------
    >>> import xarray as xr
    >>> data = xr.Dataset(
    ...     {
    ...         "cycle_start_time": ("cycle", [10.0, 12.0]),
    ...         "frequency": ("cycle", [0.5, 0.4]),
    ...     },
    ...     coords={"cycle": [1, 2]},
    ... )
    >>> cycle_links(TestView("test-0", data)).json()
    '{"count":2,"start":[10.0,12.0],"end":[12.0,14.5]}'
    """
    cycle, start = view.array("cycle"), view.array("cycle_start_time")
    if cycle is None or start is None or cycle.size < 2:
        return None
    end = start + 1.0 / view.array_like("frequency", start)
    places = _listed(view, cycle)
    # one clock for all specimens, but of one that broke early the later cycles are not known
    start, end = (
        _first_known(values.reshape(-1, cycle.size)[:, places]) for values in (start, end)
    )
    return CycleLinks(cycle.size, cycle[places], start, end)


def _listed(view: TestView, cycle: Floats) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Return the places of the cycles to list, rising."""
    if cycle.size <= MOST:
        return np.arange(cycle.size)
    drawn = view.array_like("selected_cycle", np.zeros(0))
    loops = view.stored_near(np.array([1.0, (cycle.size + 1) // 2, cycle.size]))
    wanted = np.searchsorted(cycle, np.concatenate([drawn[np.isfinite(drawn)], loops]))
    even = np.linspace(0, cycle.size - 1, MOST).round().astype(np.intp)
    return np.unique(np.concatenate([even, np.minimum(wanted, cycle.size - 1)]))


def _first_known(values: Floats) -> Floats:
    """Return of each column the first finite value; NaN where there is none."""
    row = np.argmax(np.isfinite(values), axis=0)
    return np.asarray(values[row, np.arange(values.shape[1])])
