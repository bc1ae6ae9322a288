"""Stepwise tests: dead weights hung one after another, lengths read with a tape.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import MAD_TO_DEVIATION, as_finite, as_positive, as_same_shape
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers, StepReadings, read_only_arrays
from reduction.record.notes import Note, note

STRAIN_DIGIT = 0.01
"""A recorded elongation is a whole per cent; readings within this agree. [1]"""

_ASCENDING, _DESCENDING = 1, 2

# robust standard deviations beyond which a row disagrees with the others
_INCONSISTENT = 5.0

# steps of weight beyond both neighbours from which a weight was not the one hung
_FAR_BEYOND = 2.0

# a curvature that is extrapolated by half an interval may be larger by this factor
_AT_ENDS = 2.0

# ratio of the slopes at an odd reading to the ratio of the slopes beside them
_ODD_SLOPES = 2.0

_FEWEST = 5  # readings: four slopes

_MEDIAN_TO_MEAN = sqrt(pi / 2)


def _recover_gauge_length(
    length: ArrayLike, printed_strain: ArrayLike, *, length_uncertainty: float = 0.0
) -> tuple[float, float]:
    r"""Gauge length that readings of length and elongation imply.

    .. math:: g = \operatorname{median}\; \ell_i / (1 + \varepsilon_i)

    Its uncertainty is that of the scatter, and at least that of the stated error of a length: few
    readings may agree by chance.

    Notes
    -----
    Table 4 of [1]_ gives 6.125 in, with 14 of 15 rows within 0.6 points of strain;
    section 4.8 states a free length of 18 in, which would make every strain
    negative or nearly so.

    Examples
    --------
    Three rows of Table 4 of [1]_, in inches:

    >>> gauge, _ = _recover_gauge_length([9.31, 12.95, 18.00], [0.52, 1.11, 1.94])
    >>> print(round(gauge, 3))
    6.125
    """
    rows = as_same_shape(length=length, printed_strain=printed_strain)
    known = np.isfinite(rows[1])
    if not known.any():
        raise DataError(
            "no reading has a recorded elongation",
            needed="at least one, or a stated gauge length",
            hint="Give gauge_length of the specimen.",
        )
    stretch = as_positive("1 + printed_strain", 1 + rows[1][known])
    gauge = as_positive("length", rows[0][known]) / stretch
    median = float(np.median(gauge))
    away = np.abs(gauge - median)
    sound = gauge[away <= _INCONSISTENT * MAD_TO_DEVIATION * np.median(away)]
    scatter = float(sound.std(ddof=1)) if sound.size > 1 else 0.0
    deviation = max(scatter, length_uncertainty / float(np.median(stretch)))
    return median, _MEDIAN_TO_MEAN * deviation / sqrt(gauge.size)


def _find_inconsistent_readings(
    length: ArrayLike,
    printed_strain: ArrayLike,
    *,
    gauge_length: float,
    length_uncertainty: float = 0.0,
) -> Bools:
    """Rows whose length and recorded elongation disagree.

    Examples
    --------
    1325 in Table 4 of [1]_: 16.38 in is 167 %, recorded is 151 %.

    >>> print(_find_inconsistent_readings(
    ...     [17.38, 16.38, 11.68], [1.84, 1.51, 0.91], gauge_length=6.125))
    [False  True False]
    """
    as_positive("gauge_length", gauge_length)
    lengths, printed = as_same_shape(length=length, printed_strain=printed_strain)
    difference = np.abs(lengths / gauge_length - 1 - printed)
    known = difference[np.isfinite(difference)]
    usual = MAD_TO_DEVIATION * float(np.median(known)) if known.size else 0.0
    usual = max(usual, length_uncertainty / gauge_length)
    return np.nan_to_num(difference) > max(_INCONSISTENT * usual, STRAIN_DIGIT)


def _step_branches(tension: ArrayLike) -> Integers:
    """Branch of each step of a stepwise test.

    Examples
    --------
    >>> print(_step_branches([51.0, 74.0, 97.0, 97.0, 74.0]))
    [1 1 1 1 2]
    """
    change = np.sign(np.diff(as_finite("tension", tension)))
    moved = np.flatnonzero(change)
    if moved.size == 0:
        raise DataError(
            "the weights of a stepwise test never change",
            found=f"{np.size(tension)} equal weights",
            needed="at least two different weights",
        )
    # last change at or before each interval; before the first one, the first one
    last = np.maximum.accumulate(np.where(change != 0, np.arange(change.size), -1))
    direction = change[np.where(last < 0, moved[0], last)]
    rising = np.concatenate([direction[:1], direction]) > 0
    return np.where(rising, _ASCENDING, _DESCENDING)


def _interval_slopes(
    tension: ArrayLike,
    strain: ArrayLike,
    *,
    area: float,
    tension_uncertainty: float = 0.0,
    strain_uncertainty: float = 0.0,
) -> tuple[Floats, Floats, Floats]:
    r"""Modulus between each reading and the next.

    .. math:: E = \frac{\Delta F}{A\,\Delta\varepsilon}

    Notes
    -----
    Each interval covers 15 to 35 points of strain: tape reading is 1 to 3 % of it, so
    that no smoothing is needed, but neighbours share a reading and their
    errors are opposite.  The modulus is that of slow steps including creep, 10
    to 45 minutes each in [1]_.  NaN in, NaN out.

    Examples
    --------
    0945 to 0955 in Table 4 of [1]_, on a diameter of 1 in: 87 psi.

    >>> _, modulus, _ = _interval_slopes(
    ...     np.array([51, 74]) * 4.4482216, [0.52, 0.858], area=np.pi * 0.0127**2)
    >>> print((modulus / 6894.757).round(0))
    [87.]
    """
    as_positive("area", area)
    force, elongation = as_same_shape(tension=tension, strain=strain)
    stress_step, strain_step = np.diff(force) / area, np.diff(elongation)
    strain_step = np.where(strain_step == 0, np.nan, strain_step)
    modulus = stress_step / strain_step
    uncertainty = sqrt(2) * np.hypot(
        tension_uncertainty / area / strain_step, strain_uncertainty * modulus / strain_step
    )
    return (elongation[:-1] + elongation[1:]) / 2, modulus, uncertainty


def _curvature_error(
    strain: Floats, width: Floats, modulus: Floats, branch: Integers
) -> tuple[Floats, bool]:
    r"""Error of slopes between readings as slopes at the middles, and whether that is known.

    .. math:: E_\mathrm{chord} - E(\bar\varepsilon) = \frac{E''}{24} (\Delta\varepsilon)^2

    Notes
    -----
    The largest :math:`E''` from three consecutive slopes of the branch is used, and twice that
    at its ends; that of the other branch where it has fewer.  Where neither has three,
    :math:`E'' \Delta\varepsilon = 2 E'`: the slope of the modulus changes by twice itself within an
    interval.  A single slope gives no information on a curve.

    Examples
    --------
    Stress as the cube of strain, :math:`E'' = 6`:

    >>> ends = np.array([0.0, 0.2, 0.4, 0.6])
    >>> error, _ = _curvature_error(ends[:-1] + 0.1, np.diff(ends), np.diff(ends**3) / 0.2,
    ...     np.ones(3, dtype=int))
    >>> print(error.round(6))
    [0.02 0.01 0.02]
    """
    second, rough = np.full(strain.shape, np.nan), [0.0]
    is_known = False
    for way in (_ASCENDING, _DESCENDING):
        own = np.flatnonzero((branch == way) & np.isfinite(modulus))
        own = own[np.unique(strain[own], return_index=True)[1]]
        if own.size < 2:
            continue
        is_known = True
        slope = np.diff(modulus[own]) / np.diff(strain[own])
        rough.append(float(np.abs(2 * slope / np.diff(strain[own])).max()))
        bend = 2 * np.abs(np.diff(slope)) / (strain[own[2:]] - strain[own[:-2]])
        for place in range(3):
            of_three = own[place : place + bend.size]
            second[of_three] = np.fmax(second[of_three], bend)
        second[own[[0, -1]]] *= _AT_ENDS
    known = second[np.isfinite(second)]
    of_others = known.max() if known.size else max(rough)
    return np.where(np.isfinite(second), second, of_others) * width**2 / 24, is_known


def _find_odd_weights(tension: Floats, length: Floats) -> Bools:
    """Weights far beyond both neighbours while the length continues as without them.

    Examples
    --------
    1250 in place of 125 lb:

    >>> print(_find_odd_weights(np.array([75.0, 100, 1250, 150]), np.array([1.2, 1.4, 1.6, 1.8])))
    [False False  True False]
    """
    between = np.sort([tension[:-2], tension[2:]], axis=0)
    step, growth = np.diff(between, axis=0)[0], np.diff(length)
    beyond = np.maximum(tension[1:-1] - between[1], between[0] - tension[1:-1])
    goes_on = (growth[1:] * growth[:-1] > 0) & (
        (tension[2:] - tension[:-2]) * (growth[1:] + growth[:-1]) > 0
    )
    return np.concatenate([[False], goes_on & (beyond > _FAR_BEYOND * step), [False]])


def _find_odd_lengths(tension: Floats, length: Floats, branch: Integers) -> Bools:
    """Lengths that make the slope before them lower, and that after them higher, than elsewhere.

    A curve that stiffens or softens has the slopes at a reading between those beside them.

    Examples
    --------
    The fourth length is half a step too long:

    >>> weight, length = np.arange(6.0), np.array([1.0, 1.2, 1.4, 1.7, 1.8, 2.0])
    >>> print(_find_odd_lengths(weight, length, np.ones(6, dtype=int)))
    [False False False  True False False]
    """
    is_odd = np.zeros(length.shape, dtype=bool)
    if length.size < _FEWEST:
        return is_odd
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = np.diff(tension) / np.diff(length)
    four = np.lib.stride_tricks.sliding_window_view(slope, 4)
    outer, inner = np.sort(four[:, [0, 3]]), np.sort(four[:, [1, 2]])
    is_one_branch = np.ptp(np.lib.stride_tricks.sliding_window_view(branch, 5), axis=1) == 0
    is_odd[2:-2] = (
        is_one_branch
        & (np.isfinite(four) & (four > 0)).all(axis=1)
        & (inner[:, 0] < outer[:, 0])
        & (inner[:, 1] > outer[:, 1])
        & (inner[:, 1] * outer[:, 0] > _ODD_SLOPES * outer[:, 1] * inner[:, 0])
    )
    return is_odd


@dataclass(frozen=True)
@read_only_arrays
class StepwiseResult:
    """A stepwise test reduced; per-step arrays have shape (n_steps,).

    Parameters
    ----------
    clock : tuple of str
        The clock text of each reading, as printed.
    time : ndarray
        Elapsed time from the first reading. [s]
    tension : ndarray
        Weight hung. [N]
    length, eye_to_eye_length : ndarray
        Length between the gauge marks; eye to eye. [m]
    printed_strain : ndarray
        Elongation as recorded; NaN where not recorded. [1]
    strain : ndarray
        Length over the recovered gauge length, minus one; for flagged rows too. [1]
    branch : ndarray of int
        1 ascending, 2 descending.
    gauge_length, gauge_length_standard_uncertainty : float
        Recovered from length and recorded elongation (median); its uncertainty is
        common to all strains and moduli. [m]
    is_inconsistent : ndarray of bool
        Recorded elongation and length disagree by more than reading error.
    is_creep : ndarray of bool
        Length grew while tension fell, shrank while it rose, or changed at one weight.
    is_odd : ndarray of bool
        Weight or length is far from the value expected from the readings before and after it.
    interval_strain, interval_modulus, interval_modulus_standard_uncertainty : ndarray, (n_steps-1,)
        Middle of each interval between readings [1] and its slope [Pa]; NaN where
        an end is inconsistent or odd, the length creeps against the weight, the weights
        turn, or the slope is the only one. The uncertainty is that of the readings, one of which
        is shared with each neighbour, and of the slope as the modulus at the middle.
    interval_branch : ndarray of int, shape (n_steps-1,)
        1 ascending, 2 descending, 0 where the weights turn.
    secant_modulus, secant_modulus_standard_uncertainty : ndarray
        Stress over strain; NaN where the reading is inconsistent. The uncertainty is that of the
        reading and of the weight only, as for the intervals. [Pa]
    notes : tuple of Note
    made : tuple of str
        Lines of the history: how it was made, with numbers that are not stored elsewhere.
    length_standard_uncertainty, tension_standard_uncertainty : float
        Of one reading of length, stated or from its scatter, and of one weight as stated; NaN
        where neither is known. [m], [N]
    """

    clock: tuple[str, ...]
    time: Floats
    tension: Floats
    length: Floats
    eye_to_eye_length: Floats
    printed_strain: Floats
    strain: Floats
    branch: Integers
    gauge_length: float
    gauge_length_standard_uncertainty: float
    is_inconsistent: Bools
    is_creep: Bools
    is_odd: Bools
    interval_strain: Floats
    interval_modulus: Floats
    interval_modulus_standard_uncertainty: Floats
    interval_branch: Integers
    secant_modulus: Floats
    secant_modulus_standard_uncertainty: Floats
    notes: tuple[Note, ...] = ()
    made: tuple[str, ...] = ()
    length_standard_uncertainty: float = float("nan")
    tension_standard_uncertainty: float = float("nan")


def _made(gauge: float, readings: StepReadings, is_inconsistent: Bools) -> tuple[str, ...]:
    """Origin of the gauge length, and how well the rows agree with it."""
    known = np.isfinite(readings.printed_strain)
    if not known.any():
        return ()
    difference = readings.length / gauge - 1 - readings.printed_strain
    agreeing = known & ~is_inconsistent
    return (
        f"gauge length {1e3 * gauge:.1f} mm from length and recorded elongation;"
        f" {int(agreeing.sum())} of {int(known.sum())} rows agree within"
        f" {100 * float(np.abs(difference[agreeing]).max(initial=0.0)):.1f} points of strain",
    )


def _gauge_notes(gauge: float, readings: StepReadings, stated: float | None) -> list[Note]:
    is_recorded = np.isfinite(readings.printed_strain).any()
    if not is_recorded or stated is None or abs(stated / gauge - 1) <= STRAIN_DIGIT:
        return []
    low, high = (end / stated - 1 for end in _ends(readings.length))
    return [note("gauge-length-contradicted", stated=stated, low=low, high=high)]


def _ends(values: Floats) -> tuple[float, float]:
    return float(values.min()), float(values.max())


def _inconsistency_note(
    row: int, readings: StepReadings, gauge: float, area: float, is_inconsistent: Bools
) -> Note:
    """Values of a row if its elongation is right and its length is wrong."""
    length, printed = readings.length, readings.printed_strain
    corrected = gauge * (1 + printed[row])
    speaks_for = ""
    eye, sound = readings.eye_to_eye_length, ~is_inconsistent
    sound &= np.isfinite(eye)
    if np.isfinite(eye[row]) and sound.sum() > 2:
        line = np.polynomial.Polynomial.fit(length[sound], eye[sound], 1)
        closer = abs(line(corrected) - eye[row]) < abs(line(length[row]) - eye[row])
        speaks_for = "elongation" if closer else "length"
    strain = np.where(np.arange(length.size) == row, printed[row], length / gauge - 1)
    modulus = _interval_slopes(readings.tension, strain, area=area)[1]
    return note(
        "reading-inconsistent",
        f"reading {readings.clock[row]}",
        length=float(length[row]),
        strain=float(length[row] / gauge - 1),
        recorded=float(printed[row]),
        corrected=float(corrected),
        speaks_for=speaks_for,
        beside=[float(modulus[i]) for i in (row - 1, row) if 0 <= i < modulus.size],
    )


def _odd_readings(
    readings: StepReadings, is_inconsistent: Bools
) -> tuple[Integers, Bools, list[Note]]:
    """Branches of the readings, mask of the odd ones, and notes on them."""
    is_odd = _find_odd_weights(readings.tension, readings.length)
    notes = [
        note(
            "reading-of-odd-weight",
            f"reading {readings.clock[row]}",
            weight=float(readings.tension[row]),
        )
        for row in np.flatnonzero(is_odd)
    ]
    order = np.arange(is_odd.size)
    hung = np.interp(order, order[~is_odd], readings.tension[~is_odd])
    branch = _step_branches(hung)
    sound = np.flatnonzero(~(is_inconsistent | is_odd))
    for row in sound[_find_odd_lengths(hung[sound], readings.length[sound], branch[sound])]:
        is_odd[row] = True
        # by the straight line between the readings on both sides
        beside = sound[np.searchsorted(sound, row) + np.array([-1, 1])]
        order = beside[np.argsort(hung[beside])]
        length = float(np.interp(hung[row], hung[order], readings.length[order]))
        notes.append(
            note(
                "reading-of-odd-length",
                f"reading {readings.clock[row]}",
                length=float(readings.length[row]),
                expected=length,
            )
        )
    return branch, is_odd, notes


def _gauge(readings: StepReadings, stated: float | None) -> tuple[float, float, Bools]:
    """Gauge length, its uncertainty, and the readings that contradict it."""
    of_reading = float(np.nan_to_num(readings.length_standard_uncertainty))
    if np.isfinite(readings.printed_strain).any() or stated is None:
        gauge, uncertainty = _recover_gauge_length(
            readings.length, readings.printed_strain, length_uncertainty=of_reading
        )
    else:
        gauge, uncertainty = stated, float("nan")
    is_inconsistent = _find_inconsistent_readings(
        readings.length,
        readings.printed_strain,
        gauge_length=gauge,
        length_uncertainty=of_reading,
    )
    return gauge, uncertainty, is_inconsistent


def greatest_step_strain(
    readings: StepReadings, *, stated_gauge_length: float | None = None
) -> float:
    """Greatest strain that a stepwise test reached.

    Parameters
    ----------
    readings : StepReadings
        In SI, in the order in which they were taken.
    stated_gauge_length : float, optional
        Used where no elongation was recorded. [m]

    Returns
    -------
    strain : float
        Over the readings that do not contradict the gauge length; NaN where all do. [1]

    Raises
    ------
    DataError
        If a length is impossible, or neither elongation nor gauge length is known.

    Examples
    --------
    Table 4 of [1]_ at 208 lb, and after 45 min of creep; 212 % of 6.125 in are printed:

    >>> inch, none = 0.0254, np.full(2, np.nan)
    >>> round(greatest_step_strain(
    ...     StepReadings(("1120", "1205"), np.array([0.0, 2700.0]), np.array([925.0, 823.0]),
    ...         inch * np.array([19.00, 19.13]), none, none),
    ...     stated_gauge_length=6.125 * inch), 2)
    2.12
    """
    gauge, _, is_inconsistent = _gauge(readings, stated_gauge_length)
    sound = readings.length[~is_inconsistent]
    return float(sound.max() / gauge - 1) if sound.size else float("nan")


def reduce_stepwise(
    readings: StepReadings, *, area: float, stated_gauge_length: float | None = None
) -> StepwiseResult:
    """Reduce a test with weights hung one after another.

    Parameters
    ----------
    readings : StepReadings
        In SI, in the order in which they were taken.
    area : float
        Cross-section at zero tension. [m2]
    stated_gauge_length : float, optional
        Used where no elongation was recorded; otherwise only compared. [m]

    Returns
    -------
    result : StepwiseResult
        Strain, branches, flags, interval and secant moduli, notes. [SI]

    Raises
    ------
    DataError
        If there are fewer than two steps, a length is impossible, the weights never
        change, or neither elongation nor gauge length is known.

    Notes
    -----
    A flagged row is kept as it was read, with its flag.  An inconsistent or odd row
    gives no modulus, and a note gives the value for the case that the recorded elongation is
    right.  Where the length moved against the weight, the interval is creep and
    gives no modulus; its later end is a sound reading, and the next interval is used.

    Examples
    --------
    The last three rows of Table 4 of [1]_, where 1325 is 16.38 in and 151 %:

    >>> inch, none = 0.0254, np.full(3, np.nan)
    >>> result = reduce_stepwise(
    ...     StepReadings(("1310", "1325", "1330"), np.array([0.0, 900.0, 1200.0]),
    ...         4.4482216 * np.array([97.0, 74.0, 51.0]), inch * np.array([17.38, 16.38, 11.68]),
    ...         none, np.array([1.84, 1.51, 0.91])), area=np.pi * (inch / 2) ** 2)
    >>> print(result.is_inconsistent, result.branch)
    [False True False] [2 2 2]
    """
    length = as_positive("length", readings.length)
    if length.size < 2:
        raise DataError(
            "a stepwise test needs two steps", found=f"{length.size}", needed="two or more"
        )
    as_positive("area", area)
    gauge, gauge_uncertainty, is_inconsistent = _gauge(readings, stated_gauge_length)
    notes = _gauge_notes(gauge, readings, stated_gauge_length)
    branch, is_odd, of_odd = _odd_readings(readings, is_inconsistent)
    notes += of_odd
    strain = length / gauge - 1
    growth, weight_change = np.diff(length), np.diff(readings.tension)
    against = (growth * weight_change < 0) | ((weight_change == 0) & (growth != 0))
    is_doubted = is_inconsistent | is_odd
    at_doubted = is_doubted[:-1] | is_doubted[1:]
    is_creep = np.concatenate([[False], against & ~at_doubted])

    reading = readings.length_standard_uncertainty
    if not np.isfinite(reading):
        difference = (length - gauge * (1 + readings.printed_strain))[~is_inconsistent]
        difference = difference[np.isfinite(difference)]
        reading = float(np.sqrt(np.mean(difference**2))) if difference.size else float("nan")
        notes.append(note("length-error-from-scatter", scatter=reading))
    weight = readings.tension_standard_uncertainty
    interval_strain, modulus, uncertainty = _interval_slopes(
        readings.tension,
        strain,
        area=area,
        tension_uncertainty=weight if np.isfinite(weight) else 0.0,
        strain_uncertainty=reading / gauge,
    )
    turns = branch[:-1] != branch[1:]
    interval_branch = np.where(turns, 0, branch[1:])
    modulus[turns | against | (weight_change == 0) | at_doubted] = np.nan
    of_curve, is_known = _curvature_error(
        interval_strain, np.abs(np.diff(strain)), modulus, interval_branch
    )
    if not is_known and np.isfinite(modulus).any():
        modulus[:] = np.nan
        notes.append(note("one-slope-of-weights"))
    uncertainty = np.where(np.isfinite(modulus), np.hypot(uncertainty, of_curve), np.nan)
    for row in np.flatnonzero(is_inconsistent):
        notes.append(_inconsistency_note(int(row), readings, gauge, area, is_inconsistent))
    for row in np.flatnonzero(is_creep):
        notes.append(
            note(
                "reading-of-creep" if weight_change[row - 1] else "reading-again",
                f"reading {readings.clock[row]}",
                elapsed=float(readings.time[row] - readings.time[row - 1]),
                **({"weight": float(weight_change[row - 1])} if weight_change[row - 1] else {}),
                growth=float(growth[row - 1]),
            )
        )
    with np.errstate(divide="ignore", invalid="ignore"):
        secant = np.where(is_doubted | (strain <= 0), np.nan, readings.tension / area / strain)
        of_weight = (weight if np.isfinite(weight) else 0.0) / (area * strain)
        secant_uncertainty = np.where(
            np.isfinite(secant), np.hypot(of_weight, secant * reading / gauge / strain), np.nan
        )
    return StepwiseResult(
        clock=readings.clock,
        time=readings.time,
        tension=readings.tension,
        length=length,
        eye_to_eye_length=readings.eye_to_eye_length,
        printed_strain=readings.printed_strain,
        strain=strain,
        branch=branch,
        gauge_length=gauge,
        gauge_length_standard_uncertainty=gauge_uncertainty,
        is_inconsistent=is_inconsistent,
        is_creep=is_creep,
        is_odd=is_odd,
        interval_strain=interval_strain,
        interval_modulus=modulus,
        interval_modulus_standard_uncertainty=uncertainty,
        interval_branch=interval_branch,
        secant_modulus=secant,
        secant_modulus_standard_uncertainty=secant_uncertainty,
        notes=(*readings.notes, *notes),
        made=_made(gauge, readings, is_inconsistent),
        length_standard_uncertainty=reading,
        tension_standard_uncertainty=weight,
    )
