"""Whether runs went where the plan sent them.

References
----------
.. [1] CG-D-39-80, sec. 4.3 and App. A: levels of the plan, to which a hydraulic machine comes
   within a few per cent.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape

ON_PLAN = 0.3
"""Coded distance from the plan of a run that a machine with poor control still meets. [1]."""


def levels_off_plan(
    coded: ArrayLike,
    plan: ArrayLike,
    *,
    beyond: float,
    run_names: Sequence[str],
    factor_names: Sequence[str],
) -> tuple[str, ...]:
    """Runs whose levels are not those of the plan, in words, farthest first.

    Parameters
    ----------
    coded : array_like, shape (n_runs, n_factors)
        As reached; NaN where a run was not done. [1]
    plan : array_like, shape (n_runs, n_factors)
        As planned. [1]
    beyond : float
        Coded distance up to which a level is that of the plan; the range of a factor is 2. [1]
    run_names : sequence of str, length n_runs
        In the order of the rows.
    factor_names : sequence of str, length n_factors
        In the order of the columns.

    Returns
    -------
    words : tuple of str
        One entry a run and factor.

    Raises
    ------
    DataError
        If reached and planned levels do not pair up.

    Notes
    -----
    Two runs swapped in a plan differ by 1 or 2; machines that feed back the stroke may miss
    a load by some tenths.  A surface is fitted to the levels reached and needs no plan; effects
    of two levels rest on the plan alone.

    Examples
    --------
    >>> levels_off_plan([[-0.98], [0.97]], [[-1], [-1]], beyond=0.1, run_names=["A", "B"],
    ...     factor_names=["frequency"])
    ('B frequency +0.97, planned -1.00',)
    """
    reached, planned = as_same_shape(coded=coded, plan=plan)
    away = np.nan_to_num(np.abs(reached - planned))
    order = np.argsort(-away, axis=None, kind="stable")[: int((away > beyond).sum())]
    rows, columns = np.unravel_index(order, away.shape)
    return tuple(
        f"{run_names[row]} {factor_names[column]} {reached[row, column]:+.2f}, "
        f"planned {planned[row, column]:+.2f}"
        for row, column in zip(rows.tolist(), columns.tolist(), strict=True)
    )
