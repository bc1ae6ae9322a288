r"""Designs as published: Box-Behnken for 3 to 7 factors, Plackett-Burman of 12, 20 and 24 runs.

A row is a run, a column a factor, coded -1, 0, +1.

References
----------
.. [1] G. E. P. Box and D. W. Behnken, "Some new three level designs for the study of
   quantitative variables," Technometrics 2(4), 1960, Table 1.
.. [2] R. L. Plackett and J. P. Burman, "The design of optimum multifactorial
   experiments," Biometrika 33(4), 1946.
.. [3] CG-D-39-80 (three factors, sec. 4.3; screening in twelve runs, Appendix A).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, product
from typing import Literal

import numpy as np

from reduction.errors import SettingsError
from reduction.record import Floats, read_only_arrays

DesignKind = Literal["box-behnken", "plackett-burman"]

# Factors (from 1) that move together while the others stay at the centre.
TRIPLES = {
    6: ((1, 2, 4), (2, 3, 5), (3, 4, 6), (1, 4, 5), (2, 5, 6), (1, 3, 6)),
    7: ((4, 5, 6), (1, 6, 7), (2, 5, 7), (1, 2, 4), (3, 4, 7), (1, 3, 5), (2, 3, 6)),
}
PUBLISHED_CENTRES = {3: 3, 4: 3, 5: 6, 6: 6, 7: 6}
FIRST_ROWS = {
    12: "++-+++---+-",
    20: "++--++++-+-+----++-",
    24: "+++++-+-++--++--+-+----",
}


@dataclass(frozen=True)
@read_only_arrays
class Design:
    """Runs of an experiment in coded units, in standard order.

    Parameters
    ----------
    kind : str
        ``box-behnken`` or ``plackett-burman``.
    coded : ndarray, shape (n_runs, n_factors)
        Coded level of each factor: -1, 0 or +1. [1]
    dummy : ndarray, shape (n_runs, n_dummy)
        Columns of a Plackett-Burman design that no factor uses: what they show is
        error. [1]
    """

    kind: DesignKind
    coded: Floats
    dummy: Floats

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return int(self.coded.shape[0])

    @property
    def n_factors(self) -> int:
        """Number of factors."""
        return int(self.coded.shape[1])


def box_behnken(n_factors: int, *, n_centre: int | None = None) -> Design:
    """Box-Behnken design: three levels of each factor, no corner of the cube.

    Parameters
    ----------
    n_factors : int
        3 to 7.
    n_centre : int, optional
        Centre runs; None: as published (3, 3, 6, 6, 6 for 3 to 7 factors).

    Returns
    -------
    design : Design
        Edge runs, factors of the lower number varying fastest, then the centres:
        15, 27, 46, 54 or 62 runs.

    Raises
    ------
    SettingsError
        If no design is published for the number of factors, or a count is negative.

    Notes
    -----
    Up to five factors move in pairs; six and seven in the triples of [1]_, which takes
    48 and 56 edge runs where all pairs would take 60 and 84.  The published blocks
    (three of nine runs for four factors, two for five and more) are not laid out.
    The design is not rotatable but for four and seven factors: the variance of the
    fitted response depends on the direction from the centre, see
    `reduction.surface.precision`.

    Examples
    --------
    The fifteen runs of [3]_.

    >>> box_behnken(3).n_runs
    15
    >>> box_behnken(3).coded[:4].astype(int).tolist()
    [[-1, -1, 0], [1, -1, 0], [-1, 1, 0], [1, 1, 0]]
    """
    if n_factors not in PUBLISHED_CENTRES:
        raise SettingsError(
            "no Box-Behnken design for this number of factors",
            found=str(n_factors),
            needed="3 to 7 factors",
            hint="Screen first and keep the factors that matter."
            if n_factors > 7
            else "Add a factor, or take a factorial design.",
        )
    centres = PUBLISHED_CENTRES[n_factors] if n_centre is None else n_centre
    if centres < 0:
        raise SettingsError(
            "the number of centre runs is negative", found=str(centres), needed="0 or more"
        )
    factors = range(1, n_factors + 1)
    groups = TRIPLES.get(n_factors, tuple(combinations(factors, 2)))
    # product varies its last place fastest, the standard order its first
    signs = np.array(list(product((-1.0, 1.0), repeat=len(groups[0]))))[:, ::-1]
    edges = np.zeros((len(groups), signs.shape[0], n_factors))
    for block, group in zip(edges, groups, strict=True):
        block[:, np.array(group) - 1] = signs
    coded = np.vstack([edges.reshape(-1, n_factors), np.zeros((centres, n_factors))])
    return Design("box-behnken", coded, np.empty((coded.shape[0], 0)))


def plackett_burman(n_factors: int, *, n_runs: int | None = None) -> Design:
    """Plackett-Burman design: two levels, main effects free of each other.

    Parameters
    ----------
    n_factors : int
        Factors to screen; they take the first columns.
    n_runs : int, optional
        12, 20 or 24; None: the fewest that leave at least one dummy column, or all
        columns of 24 runs.

    Returns
    -------
    design : Design
        The published first row moved one place to the right a run, then a run with
        every factor low; the columns left over are ``dummy``.

    Raises
    ------
    SettingsError
        If the number of runs is not one of the three, or has no room for the factors.

    Notes
    -----
    Every column is orthogonal to every other and half high, half low.  Two-factor
    interactions fall on the main effects in part (`confounding.alias_matrix`).

    Examples
    --------
    Five factors in twelve runs leave six dummies, as in Appendix A of [3]_.

    >>> design = plackett_burman(5)
    >>> design.coded.shape, design.dummy.shape
    ((12, 5), (12, 6))
    """
    if n_factors < 1:
        raise SettingsError(
            "a screening design needs factors", found=str(n_factors), needed="1 to 23 factors"
        )
    enough = [runs for runs in FIRST_ROWS if n_factors < runs - 1]
    runs = (enough[0] if enough else max(FIRST_ROWS)) if n_runs is None else n_runs
    if runs not in FIRST_ROWS:
        raise SettingsError(
            "no Plackett-Burman design of this number of runs is built in",
            found=str(runs),
            needed="12, 20 or 24 runs",
        )
    if n_factors > runs - 1:
        raise SettingsError(
            f"{runs} runs have no room for the factors",
            found=f"{n_factors} factors",
            needed=f"at most {runs - 1}",
            hint="Take 24 runs for up to 23 factors." if n_factors <= 23 else "",
        )
    first = np.array([1.0 if sign == "+" else -1.0 for sign in FIRST_ROWS[runs]])
    place = np.arange(runs - 1)
    cyclic = first[(place[None, :] - place[:, None]) % (runs - 1)]
    columns = np.vstack([cyclic, -np.ones(runs - 1)])
    return Design("plackett-burman", columns[:, :n_factors], columns[:, n_factors:])
