"""Tensions and shares of the break strength at which slow pulls are laid out.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4.3.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.errors import DataError
from reduction.line.product import SlowPull
from reduction.record import Floats

BREAK_SHARES = (0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5)
"""Shares of the rated break strength at which the strain of a pull is given. [1]"""
_GRID_STEPS = 40


def tension_grid(pulls: Sequence[SlowPull | None]) -> Floats:
    """One grid of tension for the slow pulls of a test.

    Parameters
    ----------
    pulls : sequence of SlowPull or None
        None for a specimen without one. [SI]

    Returns
    -------
    tension : ndarray, shape (41,)
        From the lowest to the highest tension of use of any. [N]

    Raises
    ------
    DataError
        If there is no pull.

    Notes
    -----
    [1]_ draws each pull over its own range; one grid makes pulls of a test comparable.

    Examples
    --------
    >>> from reduction.line.pull import fit_pull
    >>> load = np.linspace(0, 2000.0, 400)
    >>> pull = fit_pull(np.arange(400.0), load / 4e4, load)
    >>> grid = tension_grid([pull, None])
    >>> print(grid.size, grid[0] == pull.tension_low, grid[-1] == pull.tension_high)
    41 True True
    """
    given = [one for one in pulls if one is not None]
    if not given:
        raise DataError("there is no slow pull to lay out", found="none", needed="one or more")
    low, high = min(one.tension_low for one in given), max(one.tension_high for one in given)
    return np.linspace(low, high, _GRID_STEPS + 1)
