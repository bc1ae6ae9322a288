"""Free and splice length of the slack specimen, from the tape.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive, as_same_shape
from reduction.errors import DataError
from reduction.record import Floats, read_only_arrays
from reduction.strain.scatter import row_scatter

# free = far toe - near toe; splices = far thimble - far toe + near toe
_OF_READINGS = np.array([[2.0, -2.0], [-2.0, 3.0]])


@dataclass(frozen=True)
@read_only_arrays
class RelaxedLengths:
    """Mean lengths of the slack rows.

    Parameters
    ----------
    values : ndarray, shape (2,)
        Free length, and both splices together. [m]
    covariance : ndarray, shape (2, 2)
        Of these means. [m2]
    note : str
        What the rows do that the tape does not explain; empty where it does.
    """

    values: Floats
    covariance: Floats
    note: str = ""


def relaxed_lengths(
    free_length: ArrayLike, splice_length: ArrayLike, *, reading_uncertainty: float
) -> RelaxedLengths:
    """Mean free and splice length of the slack rows.

    Parameters
    ----------
    free_length : array_like, shape (n_slack,)
        Splice toe to splice toe, slack. [m]
    splice_length : array_like, shape (n_slack,)
        Both splices together, slack. [m]
    reading_uncertainty : float
        Standard uncertainty of one tape reading. [m]

    Returns
    -------
    lengths : RelaxedLengths
        With the covariance of the means; the two share both toe readings. [m], [m2]

    Raises
    ------
    DataError
        If there is no slack row, or a length is not positive.

    Notes
    -----
    The mean over tests, and not each test's own row: a reading is good to 0.01 ft
    ([1]_, Table 3), which is 0.12 % of the free length, and that would enter every
    strain and modulus of the test.  Rows that scatter more than the tape explains widen both
    lengths, as `reduction.strain.scatter.row_scatter` has it: a permanent set from test to test
    does that, and a tape that is read worse than its last digit.

    Examples
    --------
    Two slack rows read to 1 mm:

    >>> found = relaxed_lengths([2.553, 2.555], [1.180, 1.179], reading_uncertainty=1e-3)
    >>> print(found.values.round(4), (1e3 * np.sqrt(np.diag(found.covariance))).round(2))
    [2.554  1.1795] [1.   1.22]
    """
    rows = np.array(as_same_shape(free_length=free_length, splice_length=splice_length))
    if rows.shape[-1] == 0:
        raise DataError(
            "the marks have no slack row",
            needed="at least one row with hold = slack, read before the specimen is stretched",
        )
    as_positive("relaxed length", rows)
    n_slack = rows.shape[1]
    mean = rows.mean(axis=1)
    # uncorrelated: one tape made both lengths, and one scatter is judged
    apart = np.linalg.solve(np.linalg.cholesky(_OF_READINGS), rows - mean[:, None])
    scatter = row_scatter(
        reading_uncertainty**2, apart.ravel(), np.kron(np.eye(2), np.ones((1, n_slack)))
    )
    return RelaxedLengths(mean, scatter.variance * _OF_READINGS / n_slack, scatter.note)
