"""Tape readings at the splice toes, and the strain model fitted to them.

**Coefficients of the strain methods from tape readings, each with its covariance.** A row of marks
is three tape readings (near toe, far toe, far thimble) of one standard uncertainty.  The relaxed
lengths come from the slack rows alone, so that strain is
zero at slack by construction; the stretched rows give the rest.  Where the rows scatter more than
the tape explains, the covariance is widened.

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

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field, replace
from math import sqrt
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.record.arrays import as_finite, as_positive, as_same_shape
from reduction.record.contributions import covariance_root
from reduction.record.errors import DataError, FitError
from reduction.record.measurement import (
    Bools,
    Floats,
    Integers,
    Specimen,
    SpliceMarks,
    read_only_arrays,
)
from reduction.record.notes import Note, note
from reduction.record.settings import StrainMethod, StrainSettings
from reduction.stages.standstills import Standstills
from reduction.stages.strain.splice_laws import (
    LAWS,
    OF_TENSION,
    REJECTED,
    FittedLaw,
    SpliceAverage,
    SpliceReadings,
    fit_splice_laws,
)
from reduction.stages.strain.strain_model import (
    StrainModel,
    free_length_fraction,
    position_by_model,
    strain_by_model,
)
from reduction.stages.strain.tape_and_crosshead import POSITION_TOLERANCE, TAPE_UNCERTAINTY
from reduction.stages.strain.zero_strain import ZeroStrain

LEVEL = 0.005

"""Probability that sound marks are judged to scatter too much. [1]"""

# five thousandths of a foot: scatter of a reading of a stretched tether, where the error of the
# tape is not stated
_USUAL_TAPE = 0.005 * 0.3048
_USUAL_READINGS = 4.0  # weight of this value, beside those of slack rows

# creep of the splices between the time of a cycle and that of a mark, as a fraction of their
# extension.  A judgement, as large as that of friction: no measurement of splices is known.
_CREEP = 0.02

_CREEP_TOLD = 0.1  # of their extension: a note states the effect of this creep

_CREEP_NOTICE = 0.005  # of a strain amplitude: smaller effects are not stated

_ANY = 12**0.5  # range over standard deviation of a uniform distribution

_CONFIDENCE = 0.975  # of one side of a 95 % interval


@dataclass(frozen=True)
class _RowScatter:
    """Information in one row of a fit."""

    variance: float
    widening: float = 1.0
    note: Note | None = None


def _row_scatter(
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
    >>> print(_row_scatter(1.0, marks, np.ones((1, 3))).variance)
    1.0
    >>> wide = _row_scatter(0.04, marks, np.ones((1, 3)))
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
class _RelaxedLengths:
    """Mean lengths of the slack rows."""

    values: Floats
    covariance: Floats
    note: Note | None = None


def _relaxed_lengths(
    free_length: ArrayLike, splice_length: ArrayLike, *, reading_uncertainty: float
) -> _RelaxedLengths:
    """Mean free and splice length of the slack rows.

    Notes
    -----
    The mean over tests is used, not each test's own row: a reading is good to 0.01 ft
    ([3]_, Table 3), which is 0.12 % of the free length, and that would enter every
    strain and modulus of the test.  Rows that scatter more than the tape explains widen both
    lengths (`reduction.stages.strain.strain_fit._row_scatter`).  Causes are a permanent set from
    test to test, and a tape that is read less precisely than its last digit.

    Examples
    --------
    Two slack rows read to 1 mm:

    >>> found = _relaxed_lengths([2.553, 2.555], [1.180, 1.179], reading_uncertainty=1e-3)
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
    apart = np.linalg.solve(np.linalg.cholesky(_OF_READINGS), rows - mean[:, None])
    scatter = _row_scatter(
        reading_uncertainty**2, apart.ravel(), np.kron(np.eye(2), np.ones((1, n_slack)))
    )
    return _RelaxedLengths(mean, scatter.variance * _OF_READINGS / n_slack, scatter.note)


MarkReading = Literal["arrival", "start", "end"]

# the tape is read in about this long, or in a third of a shorter hold
_READING_TIME = 10.0

# readings that have the tension of a hold as the crosshead stopped, by noise and by relaxation
_ON_ARRIVAL = 3

# difference of two free lengths has twice the standard uncertainty of one reading (four readings)
_CONTRADICTION = 4 * 2


def _check_marks(marks: SpliceMarks, *, tests: Collection[str] | None = None) -> None:
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
    >>> _check_marks(marks)  # doctest: +ELLIPSIS
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
    if rows.size < _TREND_ROWS:
        return "Correct the row in the marks file."
    position, free = marks.far_thimble[rows], marks.free_length[rows]
    left = []
    for one in range(rows.size):
        x, y = np.delete(position, one), np.delete(free, one)
        left.append(_rms(y - np.polyval(np.polyfit(x, y, 1), x)))
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
    ...     marks, test_id="T-1", standstills=hold, tension=np.linspace(400, 300, 100)))
    [316.16]
    """
    _check_marks(marks, tests=[test_id])
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


@dataclass(frozen=True)
@read_only_arrays
class _SpliceCalibration:
    """Fitted coefficients of one method."""

    values: Floats
    covariance: Floats
    relaxed_sensitivity: Floats
    residual: Floats
    note: Note | None = None


def _line_slope(position: ArrayLike, values: ArrayLike) -> float:
    """Least squares slope of a series on position.

    Examples
    --------
    >>> print(_line_slope([1.0, 2.0, 3.0], [0.1, 0.3, 0.5]))
    0.2
    """
    at, series = as_same_shape(position=position, values=values)
    centred = at - at.mean()
    return float(centred @ series) / float(centred @ centred)


def _fit_free_length_line(
    free_length: ArrayLike, position: ArrayLike, *, reading_uncertainty: float
) -> _SpliceCalibration:
    """Least squares line of free length on position.

    Notes
    -----
    A line through three marks leaves 0.1 to 0.2 points of strain in Table 3 of
    [3]_, no more than the tape explains.  Two marks give the line but no residual.

    Examples
    --------
    Table 3 of [3]_, used tether, in feet:

    >>> line = _fit_free_length_line(
    ...     [14.79, 16.96, 19.09], [19.37, 21.75, 24.12], reading_uncertainty=0.004)
    >>> print(line.values.round(4))
    [-2.7399 0.9053]
    """
    free, length = as_same_shape(
        free_length=as_finite("free_length", free_length), position=as_finite("position", position)
    )
    if np.unique(length).size < 2:
        raise DataError(
            "a line needs marks at two positions",
            found=f"{np.unique(length).size}",
            needed="at least two stretched rows at different positions",
            hint="Use strain-ratio or constant-fraction, which need one.",
        )
    centre = length.mean()
    spread = float(np.sum((length - centre) ** 2))
    slope = _line_slope(length, free)
    intercept = float(free.mean()) - slope * centre
    residual = intercept + slope * length - free
    scatter = _row_scatter(
        reading_uncertainty**2 * (2 + slope**2), residual, np.stack([np.ones_like(length), length])
    )
    covariance = scatter.variance * np.array(
        [
            [1 / free.size + centre**2 / spread, -centre / spread],
            [-centre / spread, 1 / spread],
        ]
    )
    return _SpliceCalibration(
        np.array([intercept, slope]), covariance, np.zeros((2, 2)), residual, scatter.note
    )


def _fit_splice_ratio(
    free_length: ArrayLike,
    splice_length: ArrayLike,
    *,
    relaxed_free_length: float,
    relaxed_splice_length: float,
    reading_uncertainty: float,
    relaxed_covariance: ArrayLike = ((0.0, 0.0), (0.0, 0.0)),
) -> _SpliceCalibration:
    r"""Ratio of splice strain to free strain, least squares through the slack point.

    .. math:: \rho = \sum x y / \sum x^2

    with :math:`x` the free strain and :math:`y` the splice strain.

    Notes
    -----
    Errors of the free strain are one fortieth of its value in Table 3 of [3]_, so
    their bias of the ratio is below the digits given.

    Examples
    --------
    Table 3 of [3]_, new tether, in feet:

    >>> ratio = _fit_splice_ratio(
    ...     [14.80, 16.95, 19.03], [4.57, 4.80, 5.09],
    ...     relaxed_free_length=8.38, relaxed_splice_length=3.88, reading_uncertainty=0.004)
    >>> print(ratio.values.round(4))
    [0.2386]
    """
    as_positive("relaxed lengths", [relaxed_free_length, relaxed_splice_length])
    free, splice = as_same_shape(
        free_length=as_positive("free_length", free_length),
        splice_length=as_positive("splice_length", splice_length),
    )
    free_stretch, splice_stretch = free / relaxed_free_length, splice / relaxed_splice_length
    x, y = free_stretch - 1, splice_stretch - 1
    total = float(x @ x)
    if total == 0:
        raise DataError("a strain ratio needs a stretched row", needed="a free length above slack")
    ratio = float(x @ y) / total
    residual = ratio * x - y
    by_x, by_y = (y - 2 * ratio * x) / total, x / total
    # readings of a row: near toe, far toe, far thimble
    by_toe = by_x / relaxed_free_length - by_y / relaxed_splice_length
    variance = reading_uncertainty**2 * float(
        np.sum(2 * by_toe**2 + (by_y / relaxed_splice_length) ** 2)
    )
    of_toe = ratio / relaxed_free_length + 1 / relaxed_splice_length
    slope = np.stack([-ratio * free_stretch / relaxed_free_length,
                      splice_stretch / relaxed_splice_length])  # fmt: skip
    scatter = _row_scatter(
        reading_uncertainty**2 * (2 * of_toe**2 + relaxed_splice_length**-2),
        residual,
        x[None],
        covariance_root(np.asarray(relaxed_covariance, dtype=np.float64)).T @ slope,
    )
    variance = variance * scatter.widening**2 if variance > 0 else scatter.variance / total
    sensitivity = np.array(
        [
            [
                -float(by_x @ free_stretch) / relaxed_free_length,
                -float(by_y @ splice_stretch) / relaxed_splice_length,
            ]
        ]
    )
    return _SpliceCalibration(
        np.array([ratio]), np.array([[variance]]), sensitivity, residual, scatter.note
    )


EXPONENT_BOUNDS = (0.3, 1.9)

"""Bounds of the search for the exponent of a splice law: a friction-locked splice
stiffens with tension (below 1), one that beds in and then slides softens (above 1)."""

HELD_EXPONENT = 1.0

"""Exponent where the marks do not determine one: splices that strain in proportion to tension."""

_POLISHING_STEPS = 30


def _fit_splice_law(
    splice_length: ArrayLike,
    tension: ArrayLike,
    *,
    relaxed_splice_length: float,
    reading_uncertainty: float,
    exponent: float | None = None,
    relaxed_standard_uncertainty: float = 0.0,
) -> _SpliceCalibration:
    r"""Power law of splice strain on tension.

    .. math:: \ell_s (1 + c F^n)

    Notes
    -----
    Rows have equal weight: each splice length is three readings of one tape, and its stated
    error is taken unless the residuals refute it
    (`reduction.stages.strain.strain_fit._row_scatter`).  The
    compliance is linear and solved for.  The exponent is found by a bounded search
    in one dimension, so that there is no starting value to depend on, then refined to
    its last digits.

    Examples
    --------
    Three splices of 1.2 m that strain by 0.002 times the square root of tension:

    >>> force = np.array([100.0, 400.0, 900.0])
    >>> law = _fit_splice_law(1.2 * (1 + 0.002 * np.sqrt(force)), force,
    ...                      relaxed_splice_length=1.2, reading_uncertainty=1e-3)
    >>> print(law.values.round(5))
    [0.002 0.5 ]
    """
    as_positive("relaxed_splice_length", relaxed_splice_length)
    splice, force = as_same_shape(
        splice_length=as_positive("splice_length", splice_length),
        tension=as_positive("tension", tension),
    )
    n_values = 1 if exponent is not None else 2
    if splice.size < n_values:
        raise DataError(
            "a splice law needs more marks",
            found=f"{splice.size} stretched rows with a tension",
            needed=f"at least {n_values}",
        )
    strain = splice / relaxed_splice_length - 1
    # tension is scaled by its geometric mean to decorrelate compliance and exponent in the fit
    reference = float(np.exp(np.mean(np.log(force))))
    relative = force / reference

    def compliance(trial: float) -> tuple[float, Floats]:
        power = relative**trial
        best = float(power @ strain) / float(power @ power)
        return best, best * power - strain

    if exponent is None:
        search = scipy.optimize.minimize_scalar(
            lambda trial: float(np.sum(compliance(trial)[1] ** 2)),
            bounds=EXPONENT_BOUNDS,
            method="bounded",
            options={"xatol": 1e-9},
        )
        exponent = _polished(float(search.x), compliance, relative)
    at_reference, strain_residual = compliance(exponent)
    if at_reference <= 0:
        raise FitError(
            "the splices do not lengthen with tension",
            found=f"mean splice strain {float(strain.mean()):.4f}",
            needed="longer splices under tension than slack",
            n_marks=splice.size,
        )
    if n_values == 2 and min(abs(exponent - bound) for bound in EXPONENT_BOUNDS) < 1e-3:
        raise FitError(
            "the exponent of the splice law runs to the edge of its range",
            found=f"{exponent:.3f}",
            needed="between {} and {}".format(*EXPONENT_BOUNDS),
            hint="The marks do not follow a power law of tension; use marks or strain-ratio.",
            n_marks=splice.size,
        )
    power = relative**exponent
    design = relaxed_splice_length * np.stack([power, at_reference * power * np.log(relative)])
    design = design[:n_values]
    inverse = np.linalg.inv(design @ design.T)
    residual = relaxed_splice_length * strain_residual
    stretch = 1 + at_reference * power
    scatter = _row_scatter(
        3 * reading_uncertainty**2, residual, design, relaxed_standard_uncertainty * stretch
    )
    covariance, sensitivity = np.zeros((2, 2)), np.zeros(2)
    covariance[:n_values, :n_values] = scatter.variance * inverse
    # d(splice length)/d(relaxed splice length) is the stretch of the splice
    sensitivity[:n_values] = -inverse @ design @ stretch
    # from the compliance at the reference tension to that at 1 N
    scale = reference**-exponent
    to_si = np.array([[scale, -at_reference * scale * np.log(reference)], [0.0, 1.0]])
    sensitivity = to_si @ sensitivity
    return _SpliceCalibration(
        np.array([at_reference * scale, exponent]),
        to_si @ covariance @ to_si.T,
        np.stack([np.zeros(2), sensitivity], axis=1),
        residual,
        scatter.note,
    )


def _polished(
    exponent: float, compliance: Callable[[float], tuple[float, Floats]], relative: Floats
) -> float:
    """Gauss-Newton steps while they get shorter.

    A search that compares sums of squares finds only half the digits of the exponent; the rest
    depends on the rounding of the sums, which differs between processors.
    """
    shortest = np.inf
    for _ in range(_POLISHING_STEPS):
        power = relative**exponent
        at_reference, residual = compliance(exponent)
        slope = at_reference * power * np.log(relative)
        slope -= power * float(power @ slope) / float(power @ power)
        size = float(slope @ slope)
        step = -float(slope @ residual) / size if size > 0 else np.inf
        low, high = EXPONENT_BOUNDS
        if not (abs(step) < shortest and low < exponent + step < high):
            break
        exponent, shortest = exponent + step, abs(step)
    return exponent


TENSION_SPAN = 2.0

"""Marks must span this factor in tension before an exponent is fitted to them. [1]"""

# an exponent less certain than this adds nothing to a straight line
_EXPONENT_UNCERTAINTY = 0.25


@dataclass(frozen=True)
class PooledMarks:
    """Marks of one specimen over a campaign, as one test sees them.

    Parameters
    ----------
    marks : SpliceMarks
        All rows.
    tension : ndarray, shape (n_marks,)
        While each row was read; NaN where not known. [N]
    is_own : ndarray of bool, shape (n_marks,)
        Rows read in the test itself.
    tension_at_start : ndarray, shape (n_marks,)
        When each hold began, where the tape may have been read; empty where not known. [N]
    tension_on_arrival : ndarray, shape (n_marks,)
        As the crosshead stopped; empty where not known. [N]
    """

    marks: SpliceMarks
    tension: Floats
    is_own: Bools
    tension_at_start: Floats = field(default_factory=lambda: np.empty(0))
    tension_on_arrival: Floats = field(default_factory=lambda: np.empty(0))

    @property
    def has_own(self) -> bool:
        """Whether the test has stretched rows of its own."""
        return bool(np.any(self.is_own & ~self.marks.is_slack & ~self.marks.is_unloading))

    @property
    def knows_tension(self) -> bool:
        """Whether a law of tension can be fitted to at least two stretched rows."""
        known = ~self.marks.is_slack & ~self.marks.is_unloading
        return bool(np.count_nonzero(known & (np.nan_to_num(self.tension) > 0)) > 1)

    def stretched_rows(self, method: StrainMethod) -> Integers:
        """Rows that fix the coefficients of a method.

        ``tension-driven`` and ``mixed``: all whose tension is known, since splices are the same
        in every test.  Other methods, and ``mixed`` where the tension is known for fewer than two
        rows: the rows of the test, or all where it has none.
        """
        stretched = ~self.marks.is_slack & ~self.marks.is_unloading
        if method == "tension-driven" or (method == "mixed" and self.knows_tension):
            return np.flatnonzero(stretched & (np.nan_to_num(self.tension) > 0))
        return np.flatnonzero(stretched & (self.is_own if self.has_own else np.True_))

    @property
    def tension_span(self) -> float:
        """Greatest over least tension of the stretched rows; 1 where none is known. [1]."""
        force = self.tension[self.stretched_rows("tension-driven")]
        return float(force.max() / force.min()) if force.size else 1.0

    def relaxed(self) -> _RelaxedLengths:
        """Relaxed free and splice length and their covariance. [m], [m2]."""
        slack = self.marks.is_slack
        return _relaxed_lengths(
            self.marks.free_length[slack],
            self.marks.splice_length[slack],
            reading_uncertainty=self.marks.reading_uncertainty,
        )


def _with_relaxed(
    names: tuple[str, ...], relaxed: _RelaxedLengths, fit: _SpliceCalibration
) -> tuple[dict[str, float], Floats]:
    """Coefficients and joint covariance of relaxed lengths and fitted values."""
    both = np.zeros((2 + fit.values.size,) * 2)
    both[:2, :2] = relaxed.covariance
    both[2:, 2:] = fit.covariance
    spread = np.eye(both.shape[0])
    spread[2:, :2] = fit.relaxed_sensitivity
    values = [*relaxed.values.tolist(), *fit.values.tolist()]
    keys = ("relaxed_free_length", "relaxed_splice_length", *names)
    return dict(zip(keys, values, strict=True)), spread @ both @ spread.T


def _scatter_notes(
    marks: SpliceMarks, relaxed: _RelaxedLengths, fit: _SpliceCalibration
) -> tuple[Note, ...]:
    """Scatter of the marks that the tape does not explain."""
    told = {"slack rows": relaxed.note, "stretched marks": fit.note}
    return tuple(
        replace(one, subject=marks.specimen, numbers={"rows": rows, **one.numbers})
        for rows, one in told.items()
        if one
    )


def _fit_marks(readings: PooledMarks) -> StrainModel:
    marks, rows = readings.marks, readings.stretched_rows("marks")
    line = _fit_free_length_line(
        marks.free_length[rows],
        marks.far_thimble[rows],
        reading_uncertainty=marks.reading_uncertainty,
    )
    relaxed = readings.relaxed()
    coefficients, covariance = _with_relaxed(
        ("free_length_intercept", "free_length_slope"), relaxed, line
    )
    # the line does not use a splice length
    del coefficients["relaxed_splice_length"]
    keep = [0, 2, 3]
    return StrainModel(
        marks.specimen, "marks", coefficients, covariance[np.ix_(keep, keep)],
        notes=_scatter_notes(marks, relaxed, line),
    )  # fmt: skip


def _fit_strain_ratio(readings: PooledMarks) -> StrainModel:
    marks, rows = readings.marks, readings.stretched_rows("strain-ratio")
    relaxed = readings.relaxed()
    ratio = _fit_splice_ratio(
        marks.free_length[rows],
        marks.splice_length[rows],
        relaxed_free_length=float(relaxed.values[0]),
        relaxed_splice_length=float(relaxed.values[1]),
        reading_uncertainty=marks.reading_uncertainty,
        relaxed_covariance=relaxed.covariance,
    )
    return StrainModel(
        marks.specimen,
        "strain-ratio",
        *_with_relaxed(("splice_strain_ratio",), relaxed, ratio),
        notes=_scatter_notes(marks, relaxed, ratio),
    )


def _fit_constant_fraction(readings: PooledMarks) -> StrainModel:
    """As in the report: the test's own slack row, the mean share of its stretched rows."""
    marks, rows = readings.marks, readings.stretched_rows("constant-fraction")
    slack = marks.is_slack & readings.is_own
    relaxed = (
        marks.free_length[slack].mean() if slack.any() else float(readings.relaxed().values[0])
    )
    n_slack = max(int(slack.sum()), 1)
    length = marks.far_thimble[rows]
    share = marks.free_length[rows] / length
    # both toes enter, and the far thimble in the denominator
    variance = marks.reading_uncertainty**2 * np.array(
        [np.sum((2 + share**2) / length**2) / rows.size**2, 2 / n_slack]
    )
    coefficients = {
        "free_fraction": free_length_fraction(marks.free_length[rows], length),
        "relaxed_free_length": float(relaxed),
    }
    return StrainModel(marks.specimen, "constant-fraction", coefficients, np.diag(variance))


def _fit_tension_driven(readings: PooledMarks) -> StrainModel:
    marks, rows = readings.marks, readings.stretched_rows("tension-driven")
    relaxed = readings.relaxed()

    def law(exponent: float | None) -> _SpliceCalibration:
        return _fit_splice_law(
            marks.splice_length[rows],
            readings.tension[rows],
            relaxed_splice_length=float(relaxed.values[1]),
            reading_uncertainty=marks.reading_uncertainty,
            exponent=exponent,
            relaxed_standard_uncertainty=float(np.sqrt(relaxed.covariance[1, 1])),
        )

    made: tuple[str, ...] = ()
    wide = readings.tension_span > TENSION_SPAN and rows.size > 2
    fit = law(None) if wide else law(HELD_EXPONENT)
    if not wide:
        made = (
            f"{rows.size} marks over a factor of {readings.tension_span:.2f} in "
            "tension do not fix the exponent of the splice law; it is held at 1",
        )
    elif (uncertainty := float(np.sqrt(fit.covariance[1, 1]))) > _EXPONENT_UNCERTAINTY:
        made = (
            "the marks fix the exponent of the splice law only to "
            f"{fit.values[1]:.2f} +- {uncertainty:.2f}; it is held at 1",
        )
        fit = law(HELD_EXPONENT)
    return StrainModel(
        marks.specimen, "tension-driven",
        *_with_relaxed(("splice_compliance", "splice_exponent"), relaxed, fit),
        notes=_scatter_notes(marks, relaxed, fit), made=made,
    )  # fmt: skip


@dataclass(frozen=True)
class _MixedFit:
    """Average over the laws of the splices, and the resulting model of one test."""

    average: SpliceAverage
    model: StrainModel
    rows: Integers


def _splice_readings(readings: PooledMarks, relaxed: _RelaxedLengths) -> SpliceReadings:
    """Strains at every row whose tension is known, or at all rows where hardly one is."""
    marks = readings.marks
    known = marks.is_slack.copy()
    known[readings.stretched_rows("mixed")] = True
    free, splice = (float(one) for one in relaxed.values)
    lengths = np.array([free, splice])
    tests = {name: at for at, name in enumerate(dict.fromkeys(marks.test))}
    return SpliceReadings(
        free=marks.free_length[known] / free - 1,
        splice=marks.splice_length[known] / splice - 1,
        tension=np.where(marks.is_slack, 0.0, readings.tension)[known],
        test=np.array([tests[name] for name in marks.test])[known],
        is_slack=marks.is_slack[known],
        share=splice / free,
        tape=marks.reading_uncertainty / splice,
        relaxed=relaxed.covariance / np.outer(lengths, lengths),
        row=np.flatnonzero(known),
        tension_uncertainty=_tension_uncertainty(readings)[known],
        tape_freedom=_tape_freedom(marks),
    )


def _tension_uncertainty(readings: PooledMarks) -> Floats:
    """Relative uncertainty of tension from the unknown time of reading in its hold. [1]."""
    if not readings.tension_at_start.size:
        return np.zeros(readings.tension.size)
    change = readings.tension_at_start - readings.tension
    is_known = ~readings.marks.is_slack & (np.nan_to_num(readings.tension) > 0) & ~np.isnan(change)
    return (
        np.where(is_known, np.abs(change), 0.0) / np.where(is_known, readings.tension, 1.0) / _ANY
    )


def average_over_laws(readings: PooledMarks) -> SpliceAverage:
    """Average over the laws of the splices that the marks do not reject."""
    marks = readings.marks
    held = replace(readings, marks=replace(marks, reading_uncertainty=_tape_error(marks)))
    given = _splice_readings(held, readings.relaxed())
    names = [f"the mark of test {marks.test[row]} at {marks.hold[row]}" for row in given.row]
    return fit_splice_laws(given, specimen=marks.specimen, names=names)


def _fit_mixed(readings: PooledMarks, average: SpliceAverage | None) -> _MixedFit:
    """Average over the laws of the splices, for one test."""
    marks, relaxed = readings.marks, readings.relaxed()
    given = _splice_readings(readings, relaxed)
    if average is None:
        average = average_over_laws(readings)
    free, splice = (float(one) for one in relaxed.values * (1 + average.values[-2:]))
    tests = list(dict.fromkeys(marks.test))
    # a test whose marks are all set aside has none of its own
    rows = np.delete(given.row, average.set_aside)
    of_test = np.array(marks.test)[rows[readings.is_own[rows]]]
    own = [tests.index(test) for test in dict.fromkeys(of_test)]
    offset, of_marks, of_slip = _own_offset(average, own[0] if own else None)
    names = (
        "relaxed_free_length", "relaxed_splice_length", "splice_offset", "splice_strain_ratio",
        "splice_strain_curvature", "splice_strain_cubic", "splice_compliance", "splice_exponent",
        "splice_limit", "splice_saturation",
    )  # fmt: skip
    law, to_law = _law_in_si(average.values, average.reference)
    values = [free, splice, *law.tolist()]
    values[2] += offset
    to_si = np.zeros((len(names), len(names)))
    to_si[[0, 1], [-2, -1]] = relaxed.values
    to_si[2:, :-2] = to_law
    covariance = to_si @ average.covariance @ to_si.T
    between = to_si @ average.between @ to_si.T
    covariance[2, 2] += of_marks
    if not average.slip:  # strain refers to the mean slack length; a test may lie anywhere about it
        of_slip = _growth_of_slack(marks) / (_ANY * splice)
    between += _of_creep(np.array(values), _mean_splice_strain(given, own))
    model = StrainModel(
        marks.specimen,
        "mixed",
        dict(zip(names, values, strict=True)),
        covariance,
        law_covariance=between if between.any() else np.empty((0, 0)),
        notes=_scatter_notes(marks, relaxed, _NO_FIT),
        splice_slip=of_slip * splice,
    )
    return _MixedFit(average, model, rows)


def _mean_splice_strain(given: SpliceReadings, own: Sequence[int]) -> float:
    """Mean splice strain of the loaded marks of one test, or of all where it has none. [1]."""
    loaded = ~given.is_slack
    of_test = loaded & np.isin(given.test, own)
    return float(given.splice[of_test if of_test.any() else loaded].mean())


def _of_creep(values: Floats, mean: float) -> Floats:
    """Covariance of the coefficients by creep of the splices before a mark is read. [SI].

    In a cycle the splices extend from their mean less than between marks, by a fixed fraction:
    their strain about the mean is that much smaller, whatever drives it.
    """
    change = np.zeros(values.size)
    # offset, powers of the strain, compliance and limit
    change[[2, 3, 4, 5, 6, 8]] = -values[[2, 3, 4, 5, 6, 8]]
    change[2] += mean
    return _CREEP**2 * np.outer(change, change)


def _law_in_si(values: Floats, reference: float) -> tuple[Floats, Floats]:
    """Coefficients of a law from the strains at a reference tension, and their Jacobian.

    The compliance is the strain at one newton, the limit the asymptote of the saturating term.
    """
    law, change = np.array(values[:-2]), np.eye(values.size - 2)
    strained, exponent, limited, saturation = (float(one) for one in law[4:])
    law[4] = compliance = strained * reference**-exponent
    change[4, 4:6] = reference**-exponent, -compliance * np.log(reference)
    law[7] = saturation / reference
    change[7, 7] = 1 / reference
    if limited > 0:
        share = -np.expm1(-saturation)
        law[6] = limited / share
        change[6, 6:8] = 1 / share, -limited * np.exp(-saturation) / share**2
    return law, change


def _own_offset(average: SpliceAverage, place: int | None) -> tuple[float, float, float]:
    """Extra length of the splices of one test over the law, its variance, and that of later slip.

    Returns the offset, the variance that the test's own marks leave, and the standard uncertainty
    of slip after they were read.  Marks are read before the cycles: the offset at the start of the
    next test slipped between both, at any moment with equal probability.  After the last test no
    mark shows the slip: it is taken to be as uncertain as it is large, so that the variance of a
    fraction U of S is
    E(U^2) E(S^2) - (S / 2)^2 = 5/12 S^2.
    """
    if not average.slip:
        return 0.0, 0.0, 0.0
    if place is None:
        return 0.0, 0.0, average.slip
    steps = np.diff(average.test_offset)
    if place < steps.size:
        step = float(steps[place])
        spread = abs(step) / _ANY
    else:
        step = float(np.sqrt(np.mean(steps**2))) * float(np.sign(steps.sum()))
        spread = abs(step) * sqrt(5.0) / _ANY
    variance = float(average.test_variance[place])
    return float(average.test_offset[place]) + step / 2, variance, spread


def _tape_error(marks: SpliceMarks) -> float:
    """Standard uncertainty of one reading: stated, or the usual one pooled with slack rows.

    Slack rows of one specimen are readings of the same lengths, test after test.
    """
    if marks.is_reading_stated or not marks.is_slack.any():
        return marks.reading_uncertainty
    slack = np.stack([marks.near_toe, marks.far_toe, marks.far_thimble])[:, marks.is_slack]
    scatter = float(((slack - slack.mean(axis=1, keepdims=True)) ** 2).sum())
    found = (_USUAL_READINGS * _USUAL_TAPE**2 + scatter) / _tape_freedom(marks)
    return max(marks.reading_uncertainty, float(np.sqrt(found)))


def _tape_freedom(marks: SpliceMarks) -> float:
    """Number of readings that the error of the tape rests on; infinite where it is stated."""
    if marks.is_reading_stated:
        return float("inf")
    return _USUAL_READINGS + 3.0 * max(int(marks.is_slack.sum()) - 1, 0)


_NO_FIT = _SpliceCalibration(np.empty(0), np.empty((0, 0)), np.empty((0, 2)), np.empty(0))


def _on_laws(fit: _MixedFit, readings: PooledMarks) -> tuple[Note, ...]:
    """The law used, its certainty, and the effect of another law on a modulus."""
    average, marks = fit.average, readings.marks
    order = np.argsort(-average.weight, kind="stable")
    best, second = average.laws[order[0]], None
    if len(order) > 1 and average.weight[order[1]] > 0:
        second = average.laws[order[1]]
    notes = [
        note(
            "splice-laws",
            marks.specimen,
            law=best.name,
            weight=float(average.weight[order[0]]),
            chance=best.chance,
            second="" if second is None else second.name,
            effect=float("nan")
            if second is None
            else _effect_on_modulus(fit.model, second, average.reference),
        )
    ]
    rows = _splice_readings(readings, readings.relaxed()).row
    notes += [
        note("mark-set-aside", marks.specimen, test=marks.test[row], hold=marks.hold[row])
        for row in rows[list(average.set_aside)]
    ]
    if average.is_checked and any(
        weight > 0 and law.chance < REJECTED
        for law, weight in zip(average.laws, average.weight, strict=True)
    ):
        is_strain = not OF_TENSION & set(LAWS[best.name])
        notes.append(note("splice-side-rejected", marks.specimen, is_strain=is_strain))
    if not average.is_checked:
        carried = [
            law
            for law, weight in zip(average.laws, average.weight, strict=True)
            if weight > 0 and law.freedom > 0 and law is not best
        ]
        effects = [_effect_on_modulus(fit.model, law, average.reference) for law in carried]
        notes.append(
            note(
                "splice-law-unchecked",
                marks.specimen,
                n_marks=int((~marks.is_slack[fit.rows]).sum()),
                carried=", ".join(law.name for law in carried),
                effect=max(effects, key=abs, default=float("nan")),
            )
        )
    if average.slip:
        length = average.slip * fit.model.coefficients["relaxed_splice_length"]
        notes.append(note("splices-slip", marks.specimen, slip=length))
    return tuple(notes)


def _effect_on_modulus(model: StrainModel, law: FittedLaw, reference: float) -> float:
    """Change of a modulus by another law, over the middle of the marked range."""
    other = dict(model.coefficients)
    # the relaxed lengths before these stay
    other |= dict(zip(list(other)[2:], _law_in_si(law.values, reference)[0].tolist(), strict=True))
    middle = (model.position_low + model.position_high) / 2
    force = np.full(2, model.tension_high if np.isfinite(model.tension_high) else 0.0) / 2
    place = np.array([middle, middle + 0.01 * (model.position_high - model.position_low + 1e-9)])
    rises = [
        float(np.diff(strain_by_model(one, position=place, tension=force))[0])
        for one in (model, replace(model, coefficients=other))
    ]
    return rises[0] / rises[1] - 1


_FROM_MARKS: dict[StrainMethod, Callable[[PooledMarks], StrainModel]] = {
    "marks": _fit_marks,
    "strain-ratio": _fit_strain_ratio,
    "tension-driven": _fit_tension_driven,
    "constant-fraction": _fit_constant_fraction,
}


def _slope_ratio(model: StrainModel, readings: PooledMarks) -> float:
    """Strain slope of constant-fraction over that of the model, at the test's own marks."""
    usable = readings.stretched_rows(model.method)
    own = usable[readings.is_own[usable]]
    rows = own if own.size > 1 else usable
    position = readings.marks.far_thimble[rows]
    if np.unique(position).size < 2:
        return float("nan")
    strain = strain_by_model(model, position=position, tension=readings.tension[rows])
    legacy = _fit_constant_fraction(readings).coefficients
    return legacy["free_fraction"] / legacy["relaxed_free_length"] / _line_slope(position, strain)


def fit_to_marks(method: StrainMethod, readings: PooledMarks) -> StrainModel:
    """Fit a method that needs marks, with its residual at each mark it used.

    Examples
    --------
    >>> marks = SpliceMarks("new", 2 * ("T-1",), ("slack", "min"), np.array([0.63, 0.74]),
    ...                     np.array([3.18, 5.25]), np.array([3.74, 5.90]))
    >>> readings = PooledMarks(marks, np.array([0.0, 380.0]), np.array([True, True]))
    >>> print(round(fit_to_marks("strain-ratio", readings).coefficients["splice_strain_ratio"], 3))
    0.219
    """
    marks = readings.marks
    stretched = readings.stretched_rows(method)
    if stretched.size == 0:
        raise DataError(
            f"strain of '{marks.specimen}' by {method} has no mark to rest on",
            needed="a stretched row of this specimen"
            + (" whose hold is found in the log" if method == "tension-driven" else ""),
            hint="tension-driven also needs the tension at the mark; the other methods do not."
            if method == "tension-driven"
            else None,
        )
    return _at_marks(_FROM_MARKS[method](readings), readings, stretched)


def _at_marks(model: StrainModel, readings: PooledMarks, stretched: Integers) -> StrainModel:
    """Add the residuals of a model at the marks that it used, and the range of these."""
    marks, by_all = readings.marks, model.method in ("tension-driven", "mixed")
    slack = marks.is_slack
    if not by_all and np.any(slack & readings.is_own):
        slack = slack & readings.is_own
    rows = np.sort(np.concatenate([np.flatnonzero(slack), stretched]))
    tension = np.where(slack, np.nan_to_num(readings.tension), readings.tension)
    strain = marks.free_length[rows] / model.coefficients["relaxed_free_length"] - 1
    by_method = strain_by_model(model, position=marks.far_thimble[rows], tension=tension[rows])
    known = readings.tension[stretched]
    if by_all and np.isfinite(known).any():
        model = replace(model, tension_low=0.0, tension_high=float(np.nanmax(known)))
    is_own = readings.has_own and not by_all
    return replace(
        model,
        position_low=float(marks.far_thimble[stretched].min()),
        position_high=float(marks.far_thimble[stretched].max()),
        marks_from="this test" if is_own else "pooled over the campaign",
        mark_test=tuple(marks.test[row] for row in rows),
        mark_hold=tuple(marks.hold[row] for row in rows),
        mark_position=marks.far_thimble[rows],
        mark_strain=strain,
        mark_tension=tension[rows],
        mark_strain_residual=by_method - strain,
        strain_slope_ratio=_slope_ratio(model, readings),
    )


def _average_at_marks(
    readings: PooledMarks, average: SpliceAverage | None
) -> tuple[StrainModel, _MixedFit]:
    """Fit the average over the laws, with its residual at each mark."""
    fit = _fit_mixed(readings, average)
    stretched = fit.rows[~readings.marks.is_slack[fit.rows]]
    model = _at_marks(fit.model, readings, stretched)
    marks = readings.marks
    if fit.average.slip:
        # only its offset is its own: the covariance of each test holds what the tests share
        model = replace(model, marks_from="this test, over those of the campaign")
    friction = _friction(model, readings)
    if friction is not None:
        share, spread = friction
        model = replace(
            model,
            splice_friction=float(np.hypot(share, spread)),
            notes=(*model.notes, note("splice-friction", marks.specimen, share=share,
                                      spread=spread)),
        )  # fmt: skip
    fit = replace(fit, model=model)
    notes = (*model.notes, *_on_laws(fit, readings), *_on_creep(model, marks, stretched))
    return replace(model, notes=notes), fit


def _on_creep(model: StrainModel, marks: SpliceMarks, rows: Integers) -> tuple[Note, ...]:
    """Effect of creep of the splices, which no mark shows, on a strain amplitude."""
    free = marks.free_length[rows]
    if np.ptp(free) < _CREEP_NOTICE * model.coefficients["relaxed_free_length"]:
        return ()
    effect = _CREEP_TOLD * _line_slope(free, marks.splice_length[rows])
    if effect < _CREEP_NOTICE:
        return ()
    return (note("splice-creep-unknown", marks.specimen, effect=effect),)


def _friction(model: StrainModel, readings: PooledMarks) -> tuple[float, float] | None:
    """Relative excess length of splices on the way down over the law, and its uncertainty.

    None without marks on the way down.  Splices that friction holds keep the length that they had
    as the crosshead stopped while the rubber relaxes, up, or recovers, down; others follow the
    tension.  Each is as likely.
    """
    marks = readings.marks
    loaded = np.nan_to_num(readings.tension) > 0
    rows = np.flatnonzero(marks.is_unloading & loaded)
    if not rows.size:
        return None
    known = model.coefficients
    strain = marks.free_length[rows] / known["relaxed_free_length"] - 1
    tension = [readings.tension[rows]]
    up = loaded & ~marks.is_unloading & ~marks.is_slack
    if readings.tension_on_arrival.size:
        # the law has the tensions at the end of the holds on the way up
        relaxed = float(np.nanmean(readings.tension[up] / readings.tension_on_arrival[up]))
        tension.append(readings.tension_on_arrival[rows] * relaxed)
    reading, shares, errors = sqrt(3) * _tape_error(marks), [], []
    for one in tension:
        by_law = position_by_model(model, strain=strain, tension=one) - marks.free_length[rows]
        extension = by_law - known["relaxed_splice_length"]
        size = float(extension @ extension)
        if not size > 0:
            return None
        shares.append(float(extension @ (marks.splice_length[rows] - by_law)) / size)
        errors.append(reading / sqrt(size))
    return float(np.mean(shares)), float(np.hypot(np.mean(errors), np.ptp(shares) / 2))


# a smaller relative difference of the strain slope is not worth a note
_SLOPE_NOTICE = 0.01

# scatter and outliers, in standard uncertainties of a mark
_SCATTER_NOTICE = 2.0

_OUTLIER_NOTICE = 5.0

# fewest slack rows that can show a trend, and the probability that level ones show it
_TREND_ROWS = 4

_TREND_CHANCE = 0.01


def _rms(residual: Floats) -> float:
    return sqrt(float(np.mean(residual**2)))


def _on_constant_fraction(model: StrainModel, is_stretched: Bools) -> tuple[Note, ...]:
    if model.method != "constant-fraction":
        return ()
    position = model.mark_position[is_stretched]
    if np.unique(position).size < 2:
        return ()
    residual = model.mark_strain_residual[is_stretched]
    steepness = model.coefficients["free_fraction"] / model.coefficients["relaxed_free_length"]
    excess = _line_slope(position, residual)
    ratio = steepness / (steepness - excess)
    if abs(ratio - 1) < _SLOPE_NOTICE:
        return ()
    return (
        note(
            "constant-fraction-off",
            model.specimen,
            low=float(residual.min()),
            high=float(residual.max()),
            effect=1 / ratio - 1,
        ),
    )


def _on_scatter(model: StrainModel, is_stretched: Bools, expected: float) -> tuple[Note, ...]:
    """Scatter beyond tape reading, and single marks far off; not for the legacy method.

    An average over laws is also exempt: its laws, with slip, and its single marks are judged one by
    one at the tensions of the marks; the error of their mean is in the interval.
    """
    if model.method in ("constant-fraction", "mixed"):
        return ()
    residual = model.mark_strain_residual[is_stretched]
    rms = _rms(residual)
    notes = []
    if expected > 0 and rms > _SCATTER_NOTICE * expected:
        notes.append(
            note("marks-differ", model.specimen, method=model.method, rms=rms, expected=expected)
        )
    # the median, so that one misread mark does not hide itself
    usual = max(expected, 1.4826 * float(np.median(np.abs(residual))))
    if residual.size > 3 and usual > 0:
        rows = np.flatnonzero(is_stretched)[np.abs(residual) > _OUTLIER_NOTICE * usual]
        notes += [
            note(
                "marks-outlier",
                model.specimen,
                test=model.mark_test[row],
                hold=model.mark_hold[row],
                residual=float(model.mark_strain_residual[row]),
            )
            for row in rows
        ]
    return tuple(notes)


def _growth_of_slack(marks: SpliceMarks) -> float:
    """Growth of the slack length over the tests: permanent set, or a splice let out. [m].

    Zero where there is none.  Needs a trend over the rows, since single readings scatter by more
    than their last digit, or a step after the first row, far beyond the stated error of the tape.
    """
    length = marks.far_thimble[marks.is_slack]
    if marks.is_reading_stated and length.size > 1:
        step = float(length[1:].mean() - length[0])
        if step > _OUTLIER_NOTICE * marks.reading_uncertainty * sqrt(1 + 1 / (length.size - 1)):
            return step
    if length.size < _TREND_ROWS or np.ptp(length) == 0:
        return 0.0
    row = np.arange(length.size)
    slope, correlation = _line_slope(row, length), float(np.corrcoef(row, length)[0, 1])
    # probability of a correlation this large in rows without a trend (Student's t, both sides)
    chance = scipy.special.betainc(length.size / 2 - 1, 0.5, max(0.0, 1 - correlation**2))
    return 0.0 if slope <= 0 or chance > _TREND_CHANCE else float(slope * (length.size - 1))


def _on_slack(marks: SpliceMarks) -> tuple[Note, ...]:
    """Say where the slack length grows, or a slack row is misread: strain refers to their mean."""
    growth = _growth_of_slack(marks)
    if growth:
        effect = growth / float(marks.far_thimble[marks.is_slack][0])
        return (note("slack-length-grows", marks.specimen, growth=growth, effect=effect),)
    rows = np.flatnonzero(marks.is_slack)
    if rows.size < 2:
        return ()
    columns = ("near_toe", "far_toe", "far_thimble")
    readings = np.stack([getattr(marks, name)[rows] for name in columns])
    apart = readings - np.median(readings, axis=1, keepdims=True)
    column, at = np.unravel_index(np.argmax(np.abs(apart)), apart.shape)
    reading = marks.reading_uncertainty
    if not marks.is_reading_stated:
        reading = max(reading, TAPE_UNCERTAINTY)
    difference = float(np.ptp(readings[column]))
    if difference <= _OUTLIER_NOTICE * sqrt(2) * reading:
        return ()
    tests = [marks.test[row] for row in rows]
    # of two nothing tells which
    wrong = f"{tests[0]} or {tests[1]}" if rows.size == 2 else tests[at]
    return (
        note(
            "slack-rows-differ",
            marks.specimen,
            column=columns[column],
            difference=difference,
            test=wrong,
        ),
    )


def _on_reading_time(
    model: StrainModel, is_stretched: Bools, at_start: StrainModel
) -> tuple[str, ...]:
    """Effect of the time in a hold at which the tape was read."""
    force = np.array([model.tension_high])
    position = np.array([float(model.mark_position[is_stretched].max())])
    change = float(
        (
            strain_by_model(at_start, position=position, tension=force)
            - strain_by_model(model, position=position, tension=force)
        )[0]
    )
    end, start = (
        100 * _rms(entry.mark_strain_residual[is_stretched]) for entry in (model, at_start)
    )
    return (
        "marks are taken to be read as a hold ends, and then differ from the "
        f"splice law by {end:.2f} points of strain rms; read as it begins, {start:.2f} points, and "
        f"strain at the highest marked tension would be {100 * change:+.1f} points other",
    )


def _on_left_out(
    model: StrainModel, marks: SpliceMarks, n_used: int, failed_tests: Sequence[str]
) -> tuple[Note, ...]:
    """Stretched marks without a tension for the law: their log failed, or shows no hold."""
    rows = np.flatnonzero(~marks.is_slack & ~marks.is_unloading)
    tests = [marks.test[row] for row in rows if marks.test[row] in failed_tests]
    notes = []
    if tests:
        notes.append(
            note(
                "marks-of-failed-tests",
                model.specimen,
                n_marks=len(tests),
                n_stretched=rows.size,
                tests=", ".join(dict.fromkeys(tests)),
            )
        )
    without_hold = rows.size - n_used - len(tests)
    if model.method in ("tension-driven", "mixed") and without_hold > 0:
        notes.append(
            note("marks-without-hold", model.specimen, n_marks=without_hold, n_stretched=rows.size)
        )
    return tuple(notes)


def _remarks_on(
    model: StrainModel,
    marks: SpliceMarks,
    is_stretched: Bools,
    *,
    failed_tests: Sequence[str] = (),
) -> tuple[Note, ...]:
    """Remarks on a model fitted to marks.

    Examples
    --------
    >>> model = StrainModel(
    ...     "new", "marks", {"relaxed_free_length": 2.55}, mark_test=("T-1",), mark_hold=("min",),
    ...     mark_position=np.array([5.9]), mark_strain=np.array([0.766]),
    ...     mark_strain_residual=np.array([0.02]))
    >>> marks = SpliceMarks("new", ("T-1",), ("min",), np.array([0.7]), np.array([5.2]),
    ...                     np.array([5.9]), reading_uncertainty=0.01)
    >>> [remark, *_] = _remarks_on(model, marks, np.array([True]))
    >>> print(remark)  # doctest: +NORMALIZE_WHITESPACE, +ELLIPSIS
    new: strain by marks differs from the marks by 2.00 percentage points rms; tape reading explains
    only 0.68. ...
    """
    expected = sqrt(3) * marks.reading_uncertainty / model.coefficients["relaxed_free_length"]
    return (
        *_on_left_out(model, marks, int(is_stretched.sum()), failed_tests),
        *_on_constant_fraction(model, is_stretched),
        *_on_scatter(model, is_stretched, expected),
        *_on_slack(marks),
    )


_ELSEWHERE = 0.005  # of the gauge length: strain between two zeros that counts as different


def _without_marks(
    specimen: Specimen, method: StrainMethod, zero: ZeroStrain, length: float | None
) -> StrainModel:
    if method == "extensometer":
        return StrainModel(specimen.name, "extensometer")
    gauge = length if specimen.gauge_length is None else specimen.gauge_length
    if gauge is None or zero.position is None:
        raise DataError(
            f"strain of '{specimen.name}' by gauge-length lacks "
            + ("a gauge length" if gauge is None else "a position of zero strain"),
            needed="specimens.NAME.gauge_length or a displacement with reference_length"
            if gauge is None
            else "a rest at slack (no shorter than phases.minimum_duration), a displacement from "
            "slack (its reference_length read without tension), or a reference_tension through "
            "which the log rises",
        )
    spread = specimen.gauge_length_standard_uncertainty
    notes = [note("gauge-length-exact")] if spread is None else []
    if specimen.gauge_length is None:
        notes.append(note("gauge-length-from-reference", specimen.name, length=gauge))
    if zero.bent_at is not None:
        notes.append(note("bent-at-rest", specimen.name, length=zero.bent_at, gauge=gauge))
    if zero.reference_tension:
        notes.append(note("strain-from-tension", specimen.name, tension=zero.reference_tension))
        notes += _on_stated_zero(specimen.name, zero, gauge)
    return StrainModel(
        specimen.name,
        "gauge-length",
        {"reference_position": zero.position, "gauge_length": gauge},
        np.diag([zero.standard_uncertainty**2, 0.0 if spread is None else spread**2]),
        notes=tuple(notes),
        is_zero_logged=zero.is_logged,
        reference_tension=zero.reference_tension,
    )


def _on_stated_zero(name: str, zero: ZeroStrain, gauge: float) -> list[Note]:
    """A position that the layout states for the reference tension, but the log contradicts."""
    if zero.position is None or zero.stated_position is None:
        return []
    if abs(zero.position - zero.stated_position) <= _ELSEWHERE * gauge:
        return []
    return [
        note(
            "reference-tension-elsewhere", name, tension=zero.reference_tension,
            stated=zero.stated_position, found=zero.position,
        )
    ]  # fmt: skip


def _default_method(
    specimen: Specimen, readings: PooledMarks | None, has_extensometer: bool
) -> StrainMethod:
    if readings is not None:
        return "mixed"
    if has_extensometer:
        return "extensometer"
    if specimen.gauge_length is not None:
        return "gauge-length"
    raise DataError(
        f"nothing says how position becomes strain of '{specimen.name}'",
        needed="splice marks, a strain channel, or a gauge length where there are no splices",
        hint='Give strain = { marks = "marks.csv" } under [defaults], or gauge_length under each'
        " [specimens.NAME], in campaign.toml.",
    )


def _by_marks(readings: PooledMarks, average: SpliceAverage | None) -> StrainModel | None:
    """Average over the laws of the same splices; None where the marks reject all laws."""
    try:
        return _fit_mixed(readings, average).model
    except DataError:
        return None


def fit_strain_model(
    specimen: Specimen,
    *,
    test_id: str,
    marks: SpliceMarks | None = None,
    mark_tension: ArrayLike | None = None,
    mark_tension_at_start: ArrayLike | None = None,
    mark_tension_on_arrival: ArrayLike | None = None,
    settings: StrainSettings | None = None,
    has_extensometer: bool = False,
    zero: ZeroStrain | None = None,
    reference_length: float | None = None,
    failed_tests: Sequence[str] = (),
    average: SpliceAverage | None = None,
) -> StrainModel:
    """Fit the strain method of one specimen in one test.

    Parameters
    ----------
    specimen : Specimen
        Its ``gauge_length`` with its standard uncertainty is used by that method.
    test_id : str
        Test to which the model will be applied.
    marks : SpliceMarks, optional
        Of this specimen over the whole campaign.
    mark_tension : array_like, shape (n_marks,), optional
        From `reduction.stages.strain.strain_fit.measure_mark_tension`, row by row of ``marks``;
        NaN where no hold was found. [N]
    mark_tension_at_start : array_like, shape (n_marks,), optional
        The same at the start of each hold, where the tape may have been read too. [N]
    mark_tension_on_arrival : array_like, shape (n_marks,), optional
        The same as the crosshead stopped; only the friction of the splices is found with it. [N]
    settings : StrainSettings, optional
        ``method`` None averages: see Notes.
    has_extensometer : bool
        Whether the log has a strain channel.
    zero : ZeroStrain, optional
        Where strain is zero, for ``gauge-length``.
    reference_length : float, optional
        Length of the whole specimen at zero strain, for a ``gauge-length`` that was asked for
        and is not stated. [m]
    failed_tests : sequence of str
        Tests whose log could not be read, so that their marks have no tension. [1]
    average : SpliceAverage, optional
        Average over the laws of the splices, from `average_over_laws`; computed if not given.

    Returns
    -------
    model : StrainModel
        Method, coefficients with covariance, residuals at the marks, notes. [SI]

    Raises
    ------
    DataError
        If the method lacks what it needs, or marks contradict each other.
    FitError
        If ``tension-driven`` was asked for and the marks do not follow such a law.

    Notes
    -----
    Without a stated method: the average over the laws of the splices that the marks do not reject
    (`reduction.stages.strain.splice_laws`); without marks the extensometer, else the gauge length.

    ``mixed`` and ``tension-driven`` use all marks of the specimen, since its splices are the
    same in every test; the others use the test's own marks, or all where the test
    has none.  The relaxed lengths are means over all slack rows; only
    ``constant-fraction`` takes the test's own row, as the report does.

    The covariance holds the errors common to all samples: reading errors of the tape, or the
    stated standard uncertainty of the gauge length; ``law_covariance`` holds the uncertainty of the
    law.  A method that was asked for keeps the average over the laws as ``by_marks``, by which
    its own error is judged.

    Examples
    --------
    Table 3 of [3]_, new tether.  The report's own strain reads its moduli 14.5 % high:

    >>> foot = 0.3048
    >>> marks = SpliceMarks(
    ...     "new", 4 * ("T-1",), ("slack", "min", "centre", "max"),
    ...     near_toe=foot * np.array([2.06, 2.42, 2.53, 2.69]),
    ...     far_toe=foot * np.array([10.44, 17.22, 19.48, 21.72]),
    ...     far_thimble=foot * np.array([12.26, 19.37, 21.75, 24.12]))
    >>> model = fit_strain_model(Specimen("new"), test_id="T-1", marks=marks)
    >>> model.method, bool(abs(model.strain_slope_ratio - 0.873) < 0.005)
    ('mixed', True)
    """
    stated = None if settings is None else settings.method
    readings = None
    if marks is not None:
        tension = np.full(len(marks.test), np.nan) if mark_tension is None else mark_tension
        is_own = np.array([test == test_id for test in marks.test], dtype=bool)
        early, first = (
            np.empty(0) if one is None else np.asarray(one, dtype=np.float64)
            for one in (mark_tension_at_start, mark_tension_on_arrival)
        )
        readings = PooledMarks(
            marks, np.asarray(tension, dtype=np.float64), is_own, early, first
        )  # fmt: skip
        if readings.tension.shape != is_own.shape:
            raise DataError(
                "tensions and marks do not pair up",
                found=f"{readings.tension.size} tensions for {is_own.size} marks",
                needed="one tension a row, NaN where it is not known",
            )
    method = stated or _default_method(specimen, readings, has_extensometer)
    if method in ("extensometer", "gauge-length"):
        return _without_marks(specimen, method, zero or ZeroStrain(), reference_length)
    if readings is None:
        raise DataError(
            f"strain of '{specimen.name}' by {method} needs splice marks",
            found="no marks of this specimen",
            needed="rows of it in the marks file",
        )
    used = readings.stretched_rows(method)
    _check_marks(readings.marks, tests=sorted({readings.marks.test[row] for row in used}))
    if method == "mixed":
        model, fit = _average_at_marks(readings, average)
        is_stretched = np.array([hold != "slack" for hold in model.mark_hold], dtype=bool)
        made: tuple[str, ...] = (_laws_in_words(fit.average),)
    else:
        model = fit_to_marks(method, readings)
        model = replace(model, by_marks=_by_marks(readings, average))
        is_stretched = np.array([hold != "slack" for hold in model.mark_hold], dtype=bool)
        made = model.made
    if model.method == "tension-driven" and mark_tension_at_start is not None:
        at_start = fit_to_marks(
            "tension-driven", replace(readings, tension=readings.tension_at_start)
        )
        made += _on_reading_time(model, is_stretched, at_start)
    # a method that was asked for and needs no tension loses nothing when a log fails
    lost = failed_tests if stated in (None, "tension-driven", "mixed") else ()
    remarks = _remarks_on(model, readings.marks, is_stretched, failed_tests=lost)
    return replace(model, notes=(*model.notes, *remarks), made=made)


def _laws_in_words(average: SpliceAverage) -> str:
    """One line of the history: each law with its misfit and its weight."""
    laws = (
        f"{law.name} (chi-square {law.chi_square:.3g} of {law.freedom}, weight {weight:.2g})"
        for law, weight in zip(average.laws, average.weight, strict=True)
    )
    return f"laws of the splices fitted to the marks: {', '.join(laws)}"
