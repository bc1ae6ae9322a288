"""What the tape readings at the splice toes say, and the tension while they were read.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.phases.standstill import Standstills
from reduction.record import Floats, SpliceMarks

MarkReading = Literal["start", "end"]

# the tape is read in about this long, or in a third of a shorter hold
_READING_TIME = 10.0
# a tape and a scaled crosshead agree on a length within this; holds lie much farther apart
_POSITION_TOLERANCE = 0.05
# difference of two free lengths has twice the standard uncertainty of one reading (four readings)
_CONTRADICTION = 4 * 2
# a hundredth of a foot: a tape is not read better than this on a stretched tether
_TAPE_UNCERTAINTY = 0.003


def check_marks(marks: SpliceMarks, *, tests: Collection[str] | None = None) -> None:
    """Refuse marks of one test that contradict each other.

    Parameters
    ----------
    marks : SpliceMarks
        Tape readings of one specimen, any number of tests.
    tests : collection of str, optional
        Tests whose rows are looked at; None: all.

    Raises
    ------
    DataError
        If in one test the free length falls while the position grows, or two rows
        at one position differ in free length, by more than four standard
        uncertainties; names test and holds.

    Notes
    -----
    The same position at another tension has another free length (the splices
    are shorter when the rubber has relaxed).  Rows are taken to come from the
    set-up of a test, where each position is visited once; readings after
    cycling belong to a test of their own in the marks file.

    Examples
    --------
    A misread toe, 14.48 for 19.48 m:

    >>> marks = SpliceMarks("new", ("T-1", "T-1"), ("min", "centre"),
    ...     np.array([2.4, 2.5]), np.array([17.2, 14.48]), np.array([19.4, 21.7]))
    >>> check_marks(marks)  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    reduction.errors.DataError: marks of 'new' in test T-1 contradict each other: holds ...
    """
    allowance = _CONTRADICTION * max(marks.reading_uncertainty, _TAPE_UNCERTAINTY)
    test = np.array(marks.test)
    for name in dict.fromkeys(marks.test) if tests is None else tests:
        rows = np.flatnonzero(test == name)
        rows = rows[np.argsort(marks.far_thimble[rows], kind="stable")]
        growth = np.diff(marks.free_length[rows])
        stroke = np.diff(marks.far_thimble[rows])
        # the free length takes up no more than the stroke, and never falls
        bad = (growth < -allowance) | (growth > stroke + allowance)
        if bad.any():
            low, high = rows[np.flatnonzero(bad)[0] :][:2]
            raise DataError(
                f"marks of '{marks.specimen}' in test {name} contradict each other: holds "
                f"{marks.hold[low]} and {marks.hold[high]}",
                found=f"free lengths {marks.free_length[low]:.3f} and "
                f"{marks.free_length[high]:.3f} m at positions {marks.far_thimble[low]:.3f} and "
                f"{marks.far_thimble[high]:.3f} m",
                needed="a free length that grows with position, by no more than position does, "
                f"within {allowance:.3f} m",
                hint="Correct the row in the marks file.",
            )


def _windows(standstills: Standstills, reading: MarkReading) -> list[slice]:
    """Samples of each standstill in which the tape is taken to be read."""
    duration = standstills.end_time - standstills.start_time
    samples = standstills.last - standstills.first + 1
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.fmin(np.divide(_READING_TIME, duration), 1 / 3)
    length = np.maximum(np.round(share * samples).astype(np.int64), 1)
    first = standstills.first if reading == "start" else standstills.last + 1 - length
    return [slice(int(a), int(a + n)) for a, n in zip(first, length, strict=True)]


def _finite_mean(values: Floats) -> float:
    kept = values[np.isfinite(values)]
    return float(kept.mean()) if kept.size else float("nan")


def measure_mark_tension(
    marks: SpliceMarks,
    *,
    test_id: str,
    standstills: Standstills,
    tension: ArrayLike,
    reading: MarkReading = "end",
) -> Floats:
    """Tension of one specimen while each mark of a test was read.

    Parameters
    ----------
    marks : SpliceMarks
        Tape readings of the specimen over the campaign.
    test_id : str
        The test whose log this is; rows of other tests are left out.
    standstills : Standstills
        Of the same log.
    tension : array_like, shape (n_samples,)
        Of this specimen. [N]
    reading : {"end", "start"}
        When in the hold the tape was read.

    Returns
    -------
    tension : ndarray, shape (n_marks_of_the_test,)
        In the order of the rows; NaN where no hold lies at the mark's position. A
        slack row has the tension of the first rest, or 0 where there is none. [N]

    Raises
    ------
    DataError
        If marks of the test contradict each other.

    Notes
    -----
    A mark belongs to the earliest hold at its position, within 50 mm: the report
    marks while the machine is set up and cycles afterwards, and the crosshead may
    stand there again, at another tension ([1]_, sec. 4.1).

    The rubber relaxes while a hold lasts, by 12 % in the longest one of a test at
    275 %, so it matters when the tape was read; the report does not say.  The
    default is the last 10 s (the last third of a hold under 30 s): the crosshead
    moves on once the readings are written down.  ``start`` is the other bound.
    NaN samples are left out.

    Examples
    --------
    One hold at 6 m, 100 samples at 10 Hz, relaxing from 400 to 300 N:

    >>> hold = Standstills(
    ...     first=np.array([0]), last=np.array([99]), start_time=np.array([0.0]),
    ...     end_time=np.array([9.9]), mean_position=np.array([6.0]),
    ...     mean_tension=np.array([[350.0]]), is_rest=np.array([False]),
    ...     position_tolerance=0.01, slack_tension=5.0)
    >>> marks = SpliceMarks("new", ("T-1",), ("min",), np.array([0.7]), np.array([5.3]),
    ...                     np.array([6.01]))
    >>> print(measure_mark_tension(
    ...     marks, test_id="T-1", standstills=hold, tension=np.linspace(400, 300, 100)))
    [316.16]
    """
    check_marks(marks, tests=[test_id])
    log = np.asarray(tension, dtype=np.float64)
    during = [_finite_mean(log[window]) for window in _windows(standstills, reading)]
    rests = np.flatnonzero(standstills.is_rest)
    slack = during[rests[0]] if rests.size else 0.0
    measured = []
    for test, is_slack, position in zip(marks.test, marks.is_slack, marks.far_thimble, strict=True):
        if test != test_id:
            continue
        distance = np.where(
            standstills.is_rest, np.inf, np.abs(standstills.mean_position - position)
        )
        nearest = float(distance.min(initial=np.inf))
        if is_slack:
            measured.append(slack)
        elif nearest > _POSITION_TOLERANCE:
            measured.append(float("nan"))
        else:
            same = distance <= nearest + standstills.position_tolerance
            measured.append(during[int(np.flatnonzero(same)[0])])
    return np.array(measured)
