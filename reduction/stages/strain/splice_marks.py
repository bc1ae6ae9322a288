"""Tape readings at the splice toes, and the coefficients that they give.

Whether tape readings scatter more than the tape explains, and the variance of a row of them.

Free and splice length of the slack specimen, from the tape.

What the tape readings at the splice toes say, and the tension while they were read.

Coefficients of the strain methods from tape readings, each with its covariance.

A row of marks is three tape readings (near toe, far toe, far thimble) of one
standard uncertainty.  The relaxed lengths come from the slack rows alone
(`reduction.stages.strain.splice_marks`), so that strain is zero at slack by construction; the
stretched rows give the rest.  Where the rows scatter more than the tape explains,
the covariance is widened (`reduction.stages.strain.splice_marks`).

Power law of splice strain on tension, fitted to tape readings.

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

from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike
from scipy.special import chdtrc, ndtri, stdtrit

from reduction.record.arrays import as_finite, as_positive, as_same_shape
from reduction.record.errors import DataError, FitError
from reduction.record.measurement import Floats, SpliceMarks, read_only_arrays
from reduction.record.notes import Note, note
from reduction.stages.standstills import Standstills

LEVEL = 0.005
"""Chance at which sound marks are taken to scatter too much. [1]"""

_CONFIDENCE = 0.975  # of one side of a 95 % interval


@dataclass(frozen=True)
class _RowScatter:
    """What one row of a fit is good for."""

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
    The columns of Q span what the coefficients cannot follow.  What the tape is known to do is
    known better than what a few residuals say ([2]_): the larger of the two would be too large
    in the mean, with one mark to spare by :math:`E \max(1, \chi^2_1) = 1.48`, which is 1.22 of
    the standard uncertainty.  The residuals are therefore tested, and only where sound marks
    would have them that large in one of 200 fits is the variance multiplied by the square of
    the Birge ratio :math:`\chi^2 / \nu` ([1]_).  With one mark to spare that adds 4.4 % to the
    mean variance of sound marks (:math:`P(\chi^2_3 > 7.88) - 0.005`); testing at 1 % would add
    7.5 %.

    Where nothing is stated the scatter is all there is: its variance by :math:`\nu` degrees of
    freedom, times :math:`(t_\nu / 1.96)^2`, so that 1.96 standard uncertainties hold 95 %.
    Without a row to spare nothing is known, and the coefficients count as exact.

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
    if left.ndim != 1 or columns.shape[1:] != left.shape:
        raise DataError(
            "residuals and the design of their fit do not pair up",
            found=f"{left.shape} and {columns.shape}",
            needed="one column of the design for each residual",
        )
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
    chance = float(chdtrc(spare, chi_square))
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
    factor = float(stdtrit(spare, _CONFIDENCE) / ndtri(_CONFIDENCE))
    return _RowScatter(
        float(residual @ residual) / spare * factor**2,
        note=note("marks-error-from-scatter", freedom=spare),
    )


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
    note : Note or None
        What the rows do that the tape does not explain.
    """

    values: Floats
    covariance: Floats
    note: Note | None = None


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
    ([3]_, Table 3), which is 0.12 % of the free length, and that would enter every
    strain and modulus of the test.  Rows that scatter more than the tape explains widen both
    lengths, as `reduction.stages.strain.splice_marks._row_scatter` has it: a permanent set from
    test to test does that, and a tape that is read worse than its last digit.

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
    scatter = _row_scatter(
        reading_uncertainty**2, apart.ravel(), np.kron(np.eye(2), np.ones((1, n_slack)))
    )
    return RelaxedLengths(mean, scatter.variance * _OF_READINGS / n_slack, scatter.note)


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
    stand there again, at another tension ([3]_, sec. 4.1).

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


@dataclass(frozen=True)
@read_only_arrays
class SpliceCalibration:
    """Coefficients of one method.

    Parameters
    ----------
    values : ndarray, shape (n_values,)
        In the order the fitting function names them. [SI]
    covariance : ndarray, shape (n_values, n_values)
        From the stretched rows alone, the relaxed lengths held. [SI]
    relaxed_sensitivity : ndarray, shape (n_values, 2)
        Change of each value with the relaxed free and splice length. [SI m-1]
    residual : ndarray, shape (n_marks,)
        Of the fitted length or strain. [m] or [1]
    note : Note or None
        What the marks do that the tape does not explain.
    """

    values: Floats
    covariance: Floats
    relaxed_sensitivity: Floats
    residual: Floats
    note: Note | None = None


def line_slope(position: ArrayLike, values: ArrayLike) -> float:
    """Least squares slope of a series on position.

    Examples
    --------
    >>> print(line_slope([1.0, 2.0, 3.0], [0.1, 0.3, 0.5]))
    0.2
    """
    at, series = as_same_shape(position=position, values=values)
    centred = at - at.mean()
    return float(centred @ series) / float(centred @ centred)


def fit_free_length_line(
    free_length: ArrayLike, position: ArrayLike, *, reading_uncertainty: float
) -> SpliceCalibration:
    """Least squares line of free length on position.

    Parameters
    ----------
    free_length : array_like, shape (n_marks,)
        Of the stretched rows. [m]
    position : array_like, shape (n_marks,)
        Far thimble. [m]
    reading_uncertainty : float
        Standard uncertainty of one tape reading. [m]

    Returns
    -------
    calibration : Calibration
        ``free_length_intercept`` [m] and ``free_length_slope`` [1].

    Raises
    ------
    DataError
        If there are fewer than two positions, or a value is not finite.

    Notes
    -----
    A line through three marks leaves 0.1 to 0.2 points of strain in Table 3 of
    [3]_, no more than the tape explains.  Two marks give the line but no residual.

    Examples
    --------
    Table 3 of [3]_, used tether, in feet:

    >>> line = fit_free_length_line(
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
    slope = line_slope(length, free)
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
    return SpliceCalibration(
        np.array([intercept, slope]), covariance, np.zeros((2, 2)), residual, scatter.note
    )


def fit_splice_ratio(
    free_length: ArrayLike,
    splice_length: ArrayLike,
    *,
    relaxed_free_length: float,
    relaxed_splice_length: float,
    reading_uncertainty: float,
    relaxed_covariance: ArrayLike = ((0.0, 0.0), (0.0, 0.0)),
) -> SpliceCalibration:
    r"""Ratio of splice strain to free strain, least squares through the slack point.

    .. math:: \rho = \sum x y / \sum x^2

    with :math:`x` the free strain and :math:`y` the splice strain.

    Parameters
    ----------
    free_length : array_like, shape (n_marks,)
        Of the stretched rows. [m]
    splice_length : array_like, shape (n_marks,)
        Both splices together, same rows. [m]
    relaxed_free_length : float
        From `relaxed_lengths`. [m]
    relaxed_splice_length : float
        From `relaxed_lengths`. [m]
    reading_uncertainty : float
        Standard uncertainty of one tape reading. [m]
    relaxed_covariance : array_like, shape (2, 2)
        Of the two relaxed lengths, by which residuals are judged; it is not in the covariance
        returned. [m2]

    Returns
    -------
    calibration : Calibration
        ``splice_strain_ratio`` [1]; residual in splice strain [1].

    Raises
    ------
    DataError
        If there is no stretched row, or a length is not positive.

    Notes
    -----
    Errors of the free strain are one fortieth of its value in Table 3 of [3]_, so
    that the ratio is not biased by them to the digits given.

    Examples
    --------
    Table 3 of [3]_, new tether, in feet:

    >>> ratio = fit_splice_ratio(
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
        _root(np.asarray(relaxed_covariance, dtype=np.float64)).T @ slope,
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
    return SpliceCalibration(
        np.array([ratio]), np.array([[variance]]), sensitivity, residual, scatter.note
    )


def _root(covariance: Floats) -> Floats:
    """Matrix whose product with its own transpose is a covariance, which may be singular."""
    variance, direction = np.linalg.eigh(covariance)
    return np.asarray(direction * np.sqrt(np.maximum(variance, 0)))


EXPONENT_BOUNDS = (0.3, 1.9)
"""Exponents between which a splice law is looked for: a friction-locked splice
stiffens with tension (below 1), one that beds in and then slides softens (above 1)."""

HELD_EXPONENT = 1.0
"""Exponent where the marks do not fix one: splices that strain in proportion to tension."""

_POLISHING_STEPS = 30


def fit_splice_law(
    splice_length: ArrayLike,
    tension: ArrayLike,
    *,
    relaxed_splice_length: float,
    reading_uncertainty: float,
    exponent: float | None = None,
    relaxed_standard_uncertainty: float = 0.0,
) -> SpliceCalibration:
    r"""Power law of splice strain on tension.

    .. math:: \ell_s (1 + c F^n)

    Parameters
    ----------
    splice_length : array_like, shape (n_marks,)
        Both splices together, stretched rows. [m]
    tension : array_like, shape (n_marks,)
        While each row was read. [N]
    relaxed_splice_length : float
        From `relaxed_lengths`. [m]
    reading_uncertainty : float
        Standard uncertainty of one tape reading. [m]
    exponent : float, optional
        Held at this value; None: fitted, within `EXPONENT_BOUNDS`. [1]
    relaxed_standard_uncertainty : float
        Of ``relaxed_splice_length``, by which residuals are judged; it is not in the covariance
        returned. [m]

    Returns
    -------
    calibration : Calibration
        ``splice_compliance`` [N**-n] and ``splice_exponent`` [1].

    Raises
    ------
    DataError
        If there are fewer rows than coefficients, or a tension is not positive.
    FitError
        If the splices do not lengthen with tension, or the exponent runs to a bound.

    Notes
    -----
    Rows have equal weight: each splice length is three readings of one tape, and its stated
    error is taken unless the residuals refute it
    (`reduction.stages.strain.splice_marks._row_scatter`).  The
    compliance is linear and solved for; the exponent is found by a bounded search
    in one dimension, so that there is no starting value to depend on, and followed from there to
    its last digits.

    Examples
    --------
    Three splices of 1.2 m that strain by 0.002 times the square root of tension:

    >>> force = np.array([100.0, 400.0, 900.0])
    >>> law = fit_splice_law(1.2 * (1 + 0.002 * np.sqrt(force)), force,
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
    # tension over its geometric mean: keeps compliance and exponent apart in the fit
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
    return SpliceCalibration(
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

    A search that compares sums of squares stops at half the digits of the exponent, at a place
    that the last digits of the sums decide, which are those of a processor.
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
