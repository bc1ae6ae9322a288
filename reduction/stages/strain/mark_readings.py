"""Tape readings at the splice toes: their scatter, the relaxed lengths, and the tension of each.

A row of marks is three tape readings (near toe, far toe, far thimble) of one standard uncertainty.
The relaxed lengths come from the slack rows alone, so that strain is zero at slack by construction.
Where rows scatter more than the tape explains, the covariance is widened.

References
----------
.. [1] R. T. Birge, "The calculation of errors by the method of least squares," Phys. Rev., vol.
   40, pp. 207-227, 1932 (the ratio of external to internal consistency).
.. [2] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty
   in measurement," 4.3 (stated errors), 4.2 and G.3 (scatter, Student's t).
.. [3] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from math import sqrt
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.record.arrays import as_positive, as_same_shape
from reduction.record.errors import DataError
from reduction.record.measurement import (
    Floats,
    Integers,
    SpliceMarks,
    read_only_arrays,
)
from reduction.record.notes import Note, note
from reduction.stages.standstills import Standstills
from reduction.stages.strain.tape_and_crosshead import POSITION_TOLERANCE, TAPE_UNCERTAINTY

LEVEL = 0.005
"""Probability that sound marks are judged to scatter too much. [1]"""

_CONFIDENCE = 0.975  # of one side of a 95 % interval


@dataclass(frozen=True)
class _RowScatter:
    """Information in one row of a fit."""

    variance: float
    widening: float = 1.0
    note: Note | None = None


def row_scatter(
    stated: float, residual: ArrayLike, design: ArrayLike, shared: ArrayLike | None = None
) -> _RowScatter:
    r"""Variance of one row: the stated one, unless the residuals refute it.

    .. math:: \chi^2 = z^T V^{-1} z, \quad z = Q^T r, \quad V = \sigma^2 I + Q^T G^T G Q

    Notes
    -----
    The columns of Q span the space that the coefficients cannot follow.  The stated error of the
    tape is better known than what a few residuals show ([2]_).  To take the larger of the two would
    widen too much on average: with one mark to spare by :math:`E \max(1, \chi^2_1) = 1.48`, which
    is 1.22 of the standard uncertainty.  The residuals are therefore tested.  Only where sound
    marks would have residuals that large in one of 200 fits is the variance multiplied by the
    square of the Birge ratio :math:`\chi^2 / \nu` ([1]_).  With one mark to spare this adds 4.4 %
    to the mean variance of sound marks (:math:`P(\chi^2_3 > 7.88) - 0.005`); a test at 1 % would
    add 7.5 %.

    Where nothing is stated, only the scatter is known: its variance by :math:`\nu` degrees of
    freedom, times :math:`(t_\nu / 1.96)^2`, so that 1.96 standard uncertainties hold 95 %.
    Without a spare row nothing is known, and the coefficients count as exact.

    Examples
    --------
    Three marks about a mean, good to 1; then the same marks good to 0.2:

    >>> marks = np.array([1.0, -1.0, 0.0])
    >>> print(row_scatter(1.0, marks, np.ones((1, 3))).variance)
    1.0
    >>> wide = row_scatter(0.04, marks, np.ones((1, 3)))
    >>> print(round(wide.variance, 3), round(wide.widening, 2))
    1.0 5.0
    """
    left, columns = np.asarray(residual, dtype=np.float64), np.atleast_2d(design)
    spare = left.size - columns.shape[0]
    if not stated > 0:
        return _unstated(left, spare)
    if spare <= 0:
        return _RowScatter(stated)
    free = np.linalg.qr(columns.T, mode="complete")[0][:, columns.shape[0] :]
    common = np.zeros((1, left.size)) if shared is None else np.atleast_2d(shared)
    common = common @ free
    away = free.T @ left
    covariance = stated * np.eye(spare) + common.T @ common
    chi_square = float(away @ np.linalg.solve(covariance, away))
    chance = float(scipy.special.chdtrc(spare, chi_square))
    if chance >= LEVEL:
        return _RowScatter(stated)
    ratio = float(np.sqrt(chi_square / spare))
    return _RowScatter(
        stated * ratio**2,
        ratio,
        note("marks-scatter", ratio=ratio, chi_square=chi_square, freedom=spare, chance=chance),
    )


def _unstated(residual: Floats, spare: int) -> _RowScatter:
    if spare <= 0:
        return _RowScatter(0.0, note=note("marks-count-as-exact"))
    factor = float(scipy.special.stdtrit(spare, _CONFIDENCE) / scipy.special.ndtri(_CONFIDENCE))
    return _RowScatter(
        float(residual @ residual) / spare * factor**2,
        note=note("marks-error-from-scatter", freedom=spare),
    )


# free = far toe - near toe; splices = far thimble - far toe + near toe
_OF_READINGS = np.array([[2.0, -2.0], [-2.0, 3.0]])


@dataclass(frozen=True)
@read_only_arrays
class RelaxedLengths:
    """Mean lengths of the slack rows."""

    values: Floats
    covariance: Floats
    note: Note | None = None


def relaxed_lengths(
    free_length: ArrayLike,
    splice_length: ArrayLike,
    *,
    reading_uncertainty: float,
    growth: ArrayLike | None = None,
) -> RelaxedLengths:
    """Mean free and splice length of the slack rows; `growth` as in `SlackGrowth.course`.

    Notes
    -----
    The mean over tests is used, not each test's own row: a reading is good to 0.01 ft
    ([3]_, Table 3), which is 0.12 % of the free length, and that would enter every
    strain and modulus of the test.  Rows that scatter more than the tape explains widen both
    lengths (`reduction.stages.strain.mark_readings.row_scatter`).  A permanent set from test to
    test is no scatter: where the rows show one, they are judged about it.

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
    # made uncorrelated: one tape measured both lengths, and one scatter is judged
    courses = _courses(n_slack, growth)
    apart = np.linalg.solve(np.linalg.cholesky(_OF_READINGS), _about(courses, rows))
    scatter = row_scatter(reading_uncertainty**2, apart.ravel(), np.kron(np.eye(2), courses))
    return RelaxedLengths(mean, scatter.variance * _OF_READINGS / n_slack, scatter.note)


def _courses(n_rows: int, growth: ArrayLike | None) -> Floats:
    """What the lengths of slack rows may follow: a constant and, if there is one, a growth."""
    course = np.array([] if growth is None else growth, dtype=np.float64)
    return np.vstack([np.ones(n_rows), *([course - course.mean()] if course.size else [])])


def _about(courses: Floats, rows: Floats) -> Floats:
    """Residuals of rows about the courses, which are orthogonal."""
    left = rows - rows.mean(axis=1, keepdims=True)
    for course in courses[1:]:
        left = left - np.outer(left @ course / (course @ course), course)
    return np.asarray(left)


# a reading of a stretched or slack tether, where the error of the tape is not stated: five
# thousandths of a foot, with the weight of this many readings beside those of slack rows
_USUAL_TAPE = 0.005 * 0.3048
_USUAL_READINGS = 4.0

_STEP = 4.0  # standard uncertainties: of a growth

_BESIDE = 0.25  # of a growth: a row further off it is misread, or the growth is another

_TREND_CHANCE = 0.01

# fewest slack rows that can show a trend; or a step, if their scatter must tell the error
TREND_ROWS = 4


@dataclass(frozen=True)
@read_only_arrays
class SlackGrowth:
    """Growth of the slack length over the tests: permanent set, or a splice let out.

    Parameters
    ----------
    length : float
        From the first row to the last; 0 where the rows show none. [m]
    course : ndarray, shape (n_slack,) or (0,)
        A step behind the first row, or a trend. [1]
    """

    length: float = 0.0
    course: Floats = field(default_factory=lambda: np.empty(0))


def slack_growth(marks: SpliceMarks) -> SlackGrowth:
    """Growth that the slack rows show.

    Needs a step behind the first row, or a trend, far beyond the error of the tape and clear of a
    single row that is misread; or a trend beyond the scatter of the rows about it.  What a specimen
    keeps of its first stretch makes such a step.
    """
    length = marks.far_thimble[marks.is_slack]
    if length.size < (2 if marks.is_reading_stated else TREND_ROWS) or np.ptp(length) == 0:
        return SlackGrowth()
    row = np.arange(length.size, dtype=np.float64)
    found, surest = SlackGrowth(), _STEP
    for course in (np.minimum(row, 1.0), row):
        about = course - course.mean()
        slope = float(length @ about) / float(about @ about)
        away = np.abs(length - length.mean() - slope * about)
        grown = SlackGrowth(slope * float(course[-1]), course)
        sure = slope * float(np.linalg.norm(about)) / tape_error(marks, course)
        if sure > surest and float(away.max()) < grown.length * _BESIDE:
            found, surest = grown, sure
    if found.length or length.size < TREND_ROWS:
        return found
    correlation = float(np.corrcoef(row, length)[0, 1])
    # probability of a correlation this large in rows without a trend (Student's t, both sides)
    chance = scipy.special.betainc(length.size / 2 - 1, 0.5, max(0.0, 1 - correlation**2))
    return found if correlation <= 0 or chance > _TREND_CHANCE else grown


def tape_error(marks: SpliceMarks, growth: ArrayLike | None = None) -> float:
    """Standard uncertainty of one reading: stated, or the usual one pooled with slack rows.

    Slack rows of one specimen are readings of the same lengths, test after test, but for a growth.
    """
    if marks.is_reading_stated or not marks.is_slack.any():
        return marks.reading_uncertainty
    slack = np.stack([marks.near_toe, marks.far_toe, marks.far_thimble])[:, marks.is_slack]
    scatter = float((_about(_courses(slack.shape[1], growth), slack) ** 2).sum())
    found = (_USUAL_READINGS * _USUAL_TAPE**2 + scatter) / tape_freedom(marks, growth)
    return max(marks.reading_uncertainty, float(np.sqrt(found)))


def tape_freedom(marks: SpliceMarks, growth: ArrayLike | None = None) -> float:
    """Number of readings that the error of the tape rests on; infinite where it is stated."""
    if marks.is_reading_stated:
        return float("inf")
    n_slack = int(marks.is_slack.sum())
    return _USUAL_READINGS + 3.0 * max(n_slack - len(_courses(n_slack, growth)), 0)


MarkReading = Literal["arrival", "start", "end"]

# the tape is read in about this long, or in a third of a shorter hold
_READING_TIME = 10.0

# readings that have the tension of a hold as the crosshead stopped, by noise and by relaxation
_ON_ARRIVAL = 3

# difference of two free lengths has twice the standard uncertainty of one reading (four readings)
_CONTRADICTION = 4 * 2


def check_marks(marks: SpliceMarks, *, tests: Collection[str] | None = None) -> None:
    """Refuse marks of one test that contradict each other.

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
    reduction.record.errors.DataError: marks of 'new' in test T-1 contradict each other: holds ...
    """
    allowance = _CONTRADICTION * max(marks.reading_uncertainty, TAPE_UNCERTAINTY)
    test = np.array(marks.test)
    for name in dict.fromkeys(marks.test) if tests is None else tests:
        # friction makes splices longer on the way down
        rows = np.flatnonzero((test == name) & ~marks.is_unloading)
        rows = rows[np.argsort(marks.far_thimble[rows], kind="stable")]
        growth = np.diff(marks.free_length[rows])
        stroke = np.diff(marks.far_thimble[rows])
        # the free length grows by no more than the stroke, and never shrinks
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
                hint=_which_row(marks, rows),
            )


_PLAIN = 3.0  # times as far from a line with it as without it: a row that is misread


def _which_row(marks: SpliceMarks, rows: Integers) -> str:
    """Which of some contradicting rows to correct, if the others lie about one line without it."""
    if rows.size < TREND_ROWS:
        return "Correct the row in the marks file."
    position, free = marks.far_thimble[rows], marks.free_length[rows]
    left = []
    for one in range(rows.size):
        x, y = np.delete(position, one), np.delete(free, one)
        left.append(root_mean_square(y - np.polyval(np.polyfit(x, y, 1), x)))
    best, second = np.argsort(left)[:2]
    if left[best] * _PLAIN > left[second]:
        return "Correct the row in the marks file."
    row = rows[best]
    where = f", {marks.place[row].file} row {marks.place[row].row}" if marks.place else ""
    return (
        f"Correct the mark at {marks.hold[row]}{where}: without it the other "
        f"{rows.size - 1} rows agree."
    )


def _windows(standstills: Standstills, reading: MarkReading) -> list[slice]:
    """Samples of each standstill in which the tape is taken to be read."""
    duration = standstills.end_time - standstills.start_time
    samples = standstills.last - standstills.first + 1
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.fmin(np.divide(_READING_TIME, duration), 1 / 3)
    length = np.maximum(np.round(share * samples).astype(np.int64), 1)
    if reading == "arrival":
        length = np.minimum(length, _ON_ARRIVAL)
    first = standstills.last + 1 - length if reading == "end" else standstills.first
    return [slice(int(a), int(a + n)) for a, n in zip(first, length, strict=True)]


def _finite_mean(values: Floats) -> float:
    kept = values[np.isfinite(values)]
    return float(kept.mean()) if kept.size else float("nan")


_APPROACH = 5  # samples


def _falls_to(tension: Floats, first: int) -> bool:
    """Whether a hold was approached from a higher tension."""
    before = _finite_mean(tension[max(first - _APPROACH, 0) : first])
    return before > _finite_mean(tension[first : first + _APPROACH])


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
    reading : {"end", "start", "arrival"}
        When in the hold the tape was read; or the first readings of the hold.

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
    A mark belongs to the earliest hold at its position, within 50 mm: the marks of the report
    were read during set-up, before cycling, and the crosshead may
    stand there again at another tension ([3]_, sec. 4.1).  A mark on the way down belongs to the
    earliest hold whose tension was higher just before.

    The rubber relaxes while a hold lasts, by 12 % in the longest one of a test at
    275 %, so it matters when the tape was read; the report does not say.  The
    default is the last 10 s (the last third of a hold under 30 s): the crosshead
    moves on once the readings are written down.  ``start`` is the other bound; ``arrival``, when no
    tape is read yet, has the tension at which friction stops the splices.
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
    ...     marks, test_id="T-1", standstills=hold, tension=np.linspace(400, 300, 100)).round(2))
    [316.16]
    """
    check_marks(marks, tests=[test_id])
    log = np.asarray(tension, dtype=np.float64)
    during = [_finite_mean(log[window]) for window in _windows(standstills, reading)]
    rests = np.flatnonzero(standstills.is_rest)
    slack = during[rests[0]] if rests.size else 0.0
    measured = []
    from_above = np.array([_falls_to(log, first) for first in standstills.first], dtype=bool)
    for test, is_slack, position, is_down in zip(
        marks.test, marks.is_slack, marks.far_thimble, marks.is_unloading, strict=True
    ):
        if test != test_id:
            continue
        distance = np.where(
            standstills.is_rest | (is_down & ~from_above),
            np.inf,
            np.abs(standstills.mean_position - position),
        )
        distance[np.isnan(distance)] = (
            np.inf
        )  # for a hold in which all readings of position are flagged
        nearest = float(distance.min(initial=np.inf))
        if is_slack:
            measured.append(slack)
        elif nearest > POSITION_TOLERANCE:
            measured.append(float("nan"))
        else:
            same = distance <= nearest + standstills.position_tolerance
            measured.append(during[int(np.flatnonzero(same)[0])])
    return np.array(measured)


def root_mean_square(residual: Floats) -> float:
    """Of residuals about zero."""
    return sqrt(float(np.mean(residual**2)))
