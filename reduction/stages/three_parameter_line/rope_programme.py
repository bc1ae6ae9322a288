"""Steps of a rope laboratory's programme: bedding-in, stiffness, failure, tensile tests.

**Programmes of a rope laboratory, from loops: bedding-in and dynamic stiffness.** Each number is
also given divided by the rated break strength.  The requirements of a programme (levels, numbers of
cycles) are the laboratory's; nothing here is taken from a standard.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.3 (break-in and levels); sec. 5 (cycles to
   failure under snap loads, against the peak as a share of the break strength); sec. 6, Tables 10
   and 21 (tensile strength and strain at failure of each pull).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_same_shape
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays
from reduction.record.notes import Note, note
from reduction.record.samples import step_of_codes
from reduction.stages.cycles.cycle_product import Loops
from reduction.stages.cycles.reading_noise import reading_noise
from reduction.stages.moduli.least_squares import lag_one_inflation
from reduction.stages.moduli.secant_modulus import mean_frequency
from reduction.stages.three_parameter_line.hold_pairs import CreepOfHold, HeldPair
from reduction.stages.three_parameter_line.line_product import mean_of_rows, one_a_specimen

_FEWEST_CYCLES = 3


@dataclass(frozen=True)
@read_only_arrays
class BeddingIn:
    """Settlement of a new rope over its first cycles; arrays have shape (n_specimens,).

    Parameters
    ----------
    first_stiffness, last_stiffness : ndarray
        Secant of the first and of the last cycle, force per unit strain. [N]
    first_stiffness_standard_uncertainty, last_stiffness_standard_uncertainty : ndarray
        [N]
    first_stiffness_over_strength, last_stiffness_over_strength : ndarray
        Over the rated break strength. [1]
    stiffening : ndarray
        Last over first stiffness. [1]
    permanent_strain, permanent_strain_standard_uncertainty : ndarray
        Shift of the foot of the loop, at equal tension. [1]
    n_cycles : int
        Cycles in the table.
    """

    first_stiffness: Floats
    first_stiffness_standard_uncertainty: Floats
    last_stiffness: Floats
    last_stiffness_standard_uncertainty: Floats
    first_stiffness_over_strength: Floats
    last_stiffness_over_strength: Floats
    stiffening: Floats
    permanent_strain: Floats
    permanent_strain_standard_uncertainty: Floats
    n_cycles: int


@dataclass(frozen=True)
@read_only_arrays
class DynamicStiffness:
    """Stiffness over the last cycles of each level; arrays have shape (n_specimens, n_levels).

    Parameters
    ----------
    level : ndarray of int, shape (n_levels,)
        Labels, in the order of the cycles.
    n_cycles : ndarray of int
        Number of cycles used.
    dynamic_stiffness, dynamic_stiffness_standard_uncertainty : ndarray
        Mean apparent spring constant, and its standard error with the correlation of
        neighbouring cycles (type A); NaN below three cycles. [N]
    drift_per_cycle, drift_per_cycle_standard_uncertainty : ndarray
        Slope of the stiffness against the cycle over the same cycles. [N]
    frequency, mean_tension, tension_amplitude : ndarray
        Means over the same cycles, each with a standard error, found like that of the stiffness, in
        ``..._standard_uncertainty``. [Hz], [N], [N]
    dynamic_stiffness_over_strength, dynamic_stiffness_over_strength_standard_uncertainty : ndarray
        Over the rated break strength, which counts as exact. [1]
    mean_tension_over_strength, tension_amplitude_over_strength : ndarray
        [1]
    notes : tuple of Note
        Levels with fewer cycles than asked for.
    """

    level: Integers
    n_cycles: Integers
    dynamic_stiffness: Floats
    dynamic_stiffness_standard_uncertainty: Floats
    drift_per_cycle: Floats
    drift_per_cycle_standard_uncertainty: Floats
    frequency: Floats
    mean_tension: Floats
    tension_amplitude: Floats
    dynamic_stiffness_over_strength: Floats
    dynamic_stiffness_over_strength_standard_uncertainty: Floats
    mean_tension_over_strength: Floats
    tension_amplitude_over_strength: Floats
    frequency_standard_uncertainty: Floats
    mean_tension_standard_uncertainty: Floats
    tension_amplitude_standard_uncertainty: Floats
    notes: tuple[Note, ...] = ()


def summarise_bedding_in(
    loops: Loops, *, rated_break_strength: ArrayLike, begin_tension: ArrayLike = np.nan
) -> BeddingIn:
    r"""First and last secant of bedding-in cycles, and the permanent elongation.

    .. math:: \varepsilon_p = (\varepsilon_{v,n} - \varepsilon_{v,1})
              - (T_{v,n} - T_{v,1}) / K_{ap,n}

    Parameters
    ----------
    loops : Loops
        Table of the bedding-in cycles.
    rated_break_strength : array_like, shape (n_specimens,)
        NaN where not stated. [N]
    begin_tension : array_like, shape (n_specimens,), optional
        Reading at the beginning of the first cycle. [N]

    Returns
    -------
    bedding : BeddingIn
        Stiffness, permanent strain and their uncertainties.

    Raises
    ------
    DataError
        If there are fewer than two cycles, or a strength is not positive.

    Notes
    -----
    The permanent strain is that between the feet (v) of the first and the last loop, brought to
    one tension along the last secant; the elongation of the first rise, before the first
    valley, is not in it.  [1]_, sec. 4.3 leaves break-in cycles out and prints none.  The first
    secant is that of the first way up, from begin to peak: the elongation that a new rope gains
    on it is part of its response, whereas loops exclude the drift of steady cycles.

    Examples
    --------
    >>> one = {name: np.full((1, 2), 100.0) for name in Loops.__dataclass_fields__}
    >>> one |= dict(foot_strain=np.array([[0.08, 0.11]]),
    ...     apparent_spring_constant=np.array([[800.0, 1000.0]]), uncertainty=one.copy())
    >>> bedding = summarise_bedding_in(Loops(**one), rated_break_strength=500.0)
    >>> print(bedding.permanent_strain.round(3), bedding.stiffening)
    [0.03] [1.25]
    """
    n_specimens, n_cycles = loops.frequency.shape
    if n_cycles < 2:
        raise DataError("bedding-in needs two cycles", found=str(n_cycles), needed="2 or more")
    strength = one_a_specimen(rated_break_strength, n_specimens)
    secant = loops.apparent_spring_constant[:, [0, -1]].copy()
    foot_tension = np.fmax(one_a_specimen(begin_tension, n_specimens), loops.valley_tension[:, 0])
    way_up = 2 * (loops.mean_strain[:, 0] - loops.foot_strain[:, 0])
    with np.errstate(divide="ignore", invalid="ignore"):
        of_way_up = (loops.peak_tension[:, 0] - foot_tension) / way_up
    secant[:, 0] = np.where(np.isfinite(secant[:, 0]) & (of_way_up > 0), of_way_up, secant[:, 0])
    u_secant = loops.uncertainty["apparent_spring_constant"][:, [0, -1]].copy()
    # by its foot, it is free of the uncertainty of the wave due to creep: noise is as for the
    # others
    by_noise = secant[:, 0] * u_secant[:, 1] / secant[:, 1]
    u_secant[:, 0] = np.fmin(u_secant[:, 0], by_noise)
    foot = loops.foot_strain[:, [0, -1]]
    u_foot = loops.uncertainty["foot_strain"]
    valley = loops.valley_tension[:, [0, -1]]
    u_valley = loops.uncertainty["valley_tension"][:, [0, -1]]
    variance = (u_foot[:, [0, -1]] ** 2 + (u_valley / secant[:, 1:]) ** 2).sum(axis=1)
    return BeddingIn(
        first_stiffness=secant[:, 0],
        first_stiffness_standard_uncertainty=u_secant[:, 0],
        last_stiffness=secant[:, 1],
        last_stiffness_standard_uncertainty=u_secant[:, 1],
        first_stiffness_over_strength=secant[:, 0] / strength,
        last_stiffness_over_strength=secant[:, 1] / strength,
        stiffening=secant[:, 1] / secant[:, 0],
        permanent_strain=foot[:, 1] - foot[:, 0] - (valley[:, 1] - valley[:, 0]) / secant[:, 1],
        permanent_strain_standard_uncertainty=np.sqrt(variance),
        n_cycles=n_cycles,
    )


def _mean_and_drift(series: Floats) -> tuple[float, float, float, float]:
    """Mean and slope a cycle of one series, each with its standard uncertainty."""
    at = np.flatnonzero(np.isfinite(series)).astype(np.float64)
    values = series[np.isfinite(series)]
    mean = float(values.mean()) if values.size else np.nan
    if values.size < _FEWEST_CYCLES:
        return mean, np.nan, np.nan, np.nan
    own = values - mean
    at -= at.mean()
    # sums, not dot products, whose last digits depend on the number of threads
    power = float((at * at).sum())
    slope = float((at * own).sum()) / power
    error = np.sqrt((own * own).sum() / (own.size - 1) / own.size * lag_one_inflation(own))
    left = own - slope * at
    scatter = (left * left).sum() / (own.size - 2) / power * lag_one_inflation(left)
    return mean, float(error), slope, float(np.sqrt(scatter))


def dynamic_stiffness(
    loops: Loops,
    *,
    last_cycles: int,
    rated_break_strength: ArrayLike,
    level: ArrayLike | None = None,
) -> DynamicStiffness:
    """Dynamic stiffness over the last cycles of each level of a programme.

    Parameters
    ----------
    loops : Loops
        Table of loops.
    last_cycles : int
        Number of cycles at the end of each level that are used. [1]
    rated_break_strength : array_like, shape (n_specimens,)
        NaN where not stated. [N]
    level : array_like of int, shape (n_cycles,), optional
        Level of each cycle; by default all cycles are one level. [1]

    Returns
    -------
    stiffness : DynamicStiffness
        Mean, standard error and drift of the apparent spring constant, and the levels.

    Raises
    ------
    SettingsError
        If no cycle is asked for.
    DataError
        If a strength is not positive.

    Notes
    -----
    A drift that is large compared with its uncertainty means that the level has not settled; the
    standard error then includes the drift.  The dynamic stiffness is K_ap of [1]_, sec. 4.3, force
    per unit strain, usually called dynamic EA.

    Examples
    --------
    >>> one = {name: np.full((1, 4), 1.0) for name in Loops.__dataclass_fields__}
    >>> one["apparent_spring_constant"] = np.array([[500.0, 99.0, 100.0, 101.0]])
    >>> one["uncertainty"] = {}
    >>> found = dynamic_stiffness(Loops(**one), last_cycles=3, rated_break_strength=10.0)
    >>> print(found.dynamic_stiffness, found.drift_per_cycle, found.dynamic_stiffness_over_strength)
    [[100.]] [[1.]] [[10.]]
    """
    n_specimens, n_cycles = loops.frequency.shape
    if last_cycles < 1:
        raise SettingsError(
            "no cycle counts towards the stiffness", found=str(last_cycles), needed="1 or more"
        )
    labels = np.zeros(n_cycles, dtype=np.int64) if level is None else np.asarray(level)
    strength = one_a_specimen(rated_break_strength, n_specimens)[:, None]
    names, begins = np.unique(labels, return_index=True)
    names = names[np.argsort(begins)]
    notes = []
    numbers = np.full((4, n_specimens, names.size), np.nan)
    used = np.zeros((n_specimens, names.size), dtype=np.int64)
    means, errors = np.full((2, 3, n_specimens, names.size), np.nan)
    for column, name in enumerate(names):
        cycles = np.flatnonzero(labels == name)
        if cycles.size < last_cycles:
            notes.append(
                note(
                    "level-with-few-cycles",
                    level=str(name),
                    n_cycles=cycles.size,
                    n_asked=last_cycles,
                )
            )
        cycles = cycles[-last_cycles:]
        series = loops.apparent_spring_constant[:, cycles]
        used[:, column] = np.isfinite(series).sum(axis=1)
        numbers[:, :, column] = np.array([_mean_and_drift(row) for row in series]).T
        means[0, :, column], errors[0, :, column] = mean_frequency(loops, cycles)
        for row, quantity in ((1, "mean_tension"), (2, "tension_amplitude")):
            values = getattr(loops, quantity)[:, cycles]
            means[row, :, column] = mean_of_rows(values)
            errors[row, :, column] = [_mean_and_drift(one)[1] for one in values]
        # the error from a turn between two readings is common to all of them
        alike = loops.shared_by_cycles(cycles)
        numbers[1, :, column] = np.hypot(numbers[1, :, column], alike["apparent_spring_constant"])
        # where the readings creep along the cycle, it moves from the first of them to the last
        moves = np.sqrt(2) * alike["apparent_spring_constant"] / np.maximum(used[:, column] - 1, 1)
        numbers[3, :, column] = np.hypot(numbers[3, :, column], moves)
        for row, quantity in ((1, "mean_tension"), (2, "tension_amplitude")):
            errors[row, :, column] = np.hypot(errors[row, :, column], alike[quantity])
    return DynamicStiffness(
        level=names,
        n_cycles=used,
        dynamic_stiffness=numbers[0],
        dynamic_stiffness_standard_uncertainty=numbers[1],
        drift_per_cycle=numbers[2],
        drift_per_cycle_standard_uncertainty=numbers[3],
        frequency=means[0],
        mean_tension=means[1],
        tension_amplitude=means[2],
        dynamic_stiffness_over_strength=numbers[0] / strength,
        dynamic_stiffness_over_strength_standard_uncertainty=numbers[1] / strength,
        mean_tension_over_strength=means[1] / strength,
        tension_amplitude_over_strength=means[2] / strength,
        frequency_standard_uncertainty=errors[0],
        mean_tension_standard_uncertainty=errors[1],
        tension_amplitude_standard_uncertainty=errors[2],
        notes=tuple(notes),
    )


@dataclass(frozen=True)
@read_only_arrays
class CyclesToFailure:
    """Life of a rope in cycles; arrays have shape (n_specimens,).

    Parameters
    ----------
    cycles : ndarray of int
        Whole cycles before failure, or survived. [1]
    failed : ndarray of bool
        False for a run-out.
    peak_tension, valley_tension : ndarray
        Means over those cycles. [N]
    peak_tension_over_strength : ndarray
        Over the rated break strength. [1]
    how : tuple of str, length n_specimens
        Evidence that it failed or not.
    """

    cycles: Integers
    failed: Bools
    peak_tension: Floats
    valley_tension: Floats
    peak_tension_over_strength: Floats
    how: tuple[str, ...]


def cycles_to_failure(
    loops: Loops,
    *,
    rated_break_strength: ArrayLike,
    failed: ArrayLike | None = None,
    cycle_number: ArrayLike | None = None,
    parted_in: ArrayLike | None = None,
    failure_share: float = 0.5,
) -> CyclesToFailure:
    """Cycles that a rope lasted, by the fall of its peak or as the laboratory states.

    Parameters
    ----------
    loops : Loops
        Table of loops.
    rated_break_strength : array_like, shape (n_specimens,)
        NaN where not stated. [N]
    failed : array_like of bool, shape (n_specimens,), optional
        Whether it broke, as the laboratory states; by default the peaks alone decide. [1]
    cycle_number : array_like of int, shape (n_cycles,), optional
        Number of each row, where a machine logs only some cycles or an earlier log began. [1]
    parted_in : array_like of int, shape (n_specimens,), optional
        Index of the cycle in which the record shows that it parted, or the number of cycles
        if it parted after the last; -1 where the record shows nothing. [1]
    failure_share : float, optional
        A peak below this fraction of the median peak before it is a failure. [1]

    Returns
    -------
    lasted : CyclesToFailure
        Cycles, failure or run-out, and the level.

    Raises
    ------
    DataError
        If there is no cycle, a strength is not positive, or arrays do not fit.
    SettingsError
        If the share is not between 0 and 1.

    Notes
    -----
    A rope that parts within a cycle leaves that cycle incomplete, so the last whole cycle
    looks sound: the loops alone cannot distinguish it from a run-out, and the text says so.  A
    cycle in which it parted does not count as lasted, whatever its peak; ``parted_in`` gives it.
    Source of the record: [1]_, sec. 5, cycles against the peak as a fraction of the strength.

    Examples
    --------
    >>> one = {name: np.full((1, 5), 100.0) for name in Loops.__dataclass_fields__}
    >>> one["peak_tension"] = np.array([[100.0, 99.0, 101.0, 100.0, 8.0]])
    >>> lasted = cycles_to_failure(Loops(**one), rated_break_strength=200.0)
    >>> print(lasted.cycles, lasted.failed, lasted.peak_tension_over_strength)
    [4] [ True] [0.5]
    """
    n_specimens, n_cycles = loops.frequency.shape
    if not 0 < failure_share < 1:
        raise SettingsError(
            "the share of the peak that counts as failure is out of range",
            found=f"{failure_share:g}",
            needed="0 to 1",
        )
    strength = one_a_specimen(rated_break_strength, n_specimens)
    number = np.arange(1, n_cycles + 1) if cycle_number is None else np.asarray(cycle_number)
    stated = None if failed is None else np.asarray(failed, dtype=bool)
    seen = np.full(n_specimens, -1) if parted_in is None else np.asarray(parted_in)
    if (
        n_cycles == 0
        or number.shape != (n_cycles,)
        or seen.shape != (n_specimens,)
        or (stated is not None and stated.shape != (n_specimens,))
        or (seen == 0).any()
    ):
        raise DataError(
            "cycles to failure: the arrays do not fit the loops",
            found=f"{n_cycles} cycles, numbers {number.shape}",
            needed="one number a cycle, one word a specimen, and a cycle before the failure",
        )
    lasted, parted = np.zeros(n_specimens, dtype=np.int64), np.zeros(n_specimens, dtype=bool)
    levels = np.full((2, n_specimens), np.nan)
    how = []
    for row, peak in enumerate(loops.peak_tension):
        # a failure lasts to the end of the record; a single low peak before sound ones is not one
        known = np.flatnonzero(np.isfinite(peak))
        limit = failure_share * np.median(peak[known]) if known.size else 0.0
        sound = known[peak[known] >= limit]
        fell = bool(sound.size and known[-1] > sound[-1])
        last = int(sound[-1]) if fell else n_cycles - 1
        shown = seen[row] > 0
        if shown:
            last = min(last, int(seen[row]) - 1)
        parted[row] = fell or shown if stated is None else stated[row]
        lasted[row] = number[last]
        levels[:, row] = mean_of_rows(
            np.stack([peak[: last + 1], loops.valley_tension[row, : last + 1]])
        )
        if shown:
            how.append("slack at a position at which it was taut")
        elif fell:
            how.append(
                f"the peak falls below {100 * failure_share:.0f} % of its median and stays there"
            )
        elif stated is None:
            how.append(
                "no failure in any complete cycle: a run-out, or a failure after the last one"
            )
        else:
            how.append("as stated" + (", after the last whole cycle" if stated[row] else ""))
    return CyclesToFailure(
        cycles=lasted,
        failed=parted,
        peak_tension=levels[0],
        valley_tension=levels[1],
        peak_tension_over_strength=levels[0] / strength,
        how=tuple(how),
    )


# a machine that returns by more than this fraction of its travel has unloaded the line
_GIVEN_BACK = 0.05

_FALLEN = 0.5

_FEWEST_SAMPLES = 3

_HIDES = 2.0  # times the noise of a reading, within which a strain may stand still

_LAST_STEPS = 9

_MAY_BE_GREATEST = 4.0  # times the noise, below the greatest reading: any of these may be greatest

_LEAST_TOP = 4  # readings that show whether a load still rises


@dataclass(frozen=True)
@read_only_arrays
class TensilePull:
    """A pull to the end; arrays have shape (n_specimens,).

    Parameters
    ----------
    peak_tension, peak_tension_standard_uncertainty : ndarray
        Greatest reading; its uncertainty by noise and codes, and by the gain of the line from one
        reading to the next, as it may have parted or turned just before that. [N]
    strain_at_peak, strain_at_peak_standard_uncertainty : ndarray
        Strain at the last reading if the load rises to its end, else at the greatest reading; and
        half the range of the readings that may be the greatest. [1]
    is_break : ndarray of bool
        True where the line broke.
    peak_tension_over_strength, peak_tension_over_strength_standard_uncertainty : ndarray
        Over the rated break strength, which counts as exact. [1]
    how : tuple of str, length n_specimens
        Evidence that it broke or not.
    """

    peak_tension: Floats
    peak_tension_standard_uncertainty: Floats
    strain_at_peak: Floats
    strain_at_peak_standard_uncertainty: Floats
    is_break: Bools
    peak_tension_over_strength: Floats
    peak_tension_over_strength_standard_uncertainty: Floats
    how: tuple[str, ...]


def parting_sample(
    position: ArrayLike, tension: ArrayLike, *, last: int, least_position: float, tension_low: float
) -> int:
    """First sample at which a line is slack at a position at which it was taut before.

    Parameters
    ----------
    position : array_like, shape (n_samples,)
        Crosshead position. [m]
    tension : array_like, shape (n_samples,)
        Tension of one specimen; NaN where missing. [N]
    last : int
        Sample after which the search begins. [1]
    least_position : float
        Position at or beyond which a sound line is taut. [m]
    tension_low : float
        A sound line does not read below this there. [N]

    Returns
    -------
    sample : int
        -1 where fewer than three readings show it. [1]

    Raises
    ------
    DataError
        If the series do not pair up.

    Notes
    -----
    An unloaded line is slack because the crosshead went back, a parted line although
    it did not; [1]_ gives no rule, since a person stood by.

    Examples
    --------
    >>> position = [1.0, 1.1, 1.2, 1.3, 1.3, 1.3, 1.3]
    >>> tension = [10.0, 50.0, 90.0, 0.0, 0.0, 0.0, 0.0]
    >>> parting_sample(position, tension, last=2, least_position=1.1, tension_low=25.0)
    3
    >>> back = [1.0, 1.1, 1.2, 1.0, 1.0, 1.0, 1.0]
    >>> parting_sample(back, tension, last=2, least_position=1.1, tension_low=25.0)
    -1
    """
    place, load = as_same_shape(position=position, tension=tension)
    place, load = place[last + 1 :], load[last + 1 :]
    found = np.flatnonzero((place >= least_position) & (load < tension_low))
    return last + 1 + int(found[0]) if found.size >= _FEWEST_SAMPLES else -1


def tensile_pull(
    position: ArrayLike,
    tension: ArrayLike,
    strain: ArrayLike,
    *,
    rated_break_strength: ArrayLike,
    broke: bool | None = None,
) -> TensilePull:
    """Greatest tension of each specimen, the strain there, and whether it broke.

    Parameters
    ----------
    position : array_like, shape (n_samples,)
        Crosshead position; NaN where missing. [m]
    tension, strain : array_like, shape (n_specimens, n_samples)
        NaN where missing. [N], [1]
    rated_break_strength : array_like, shape (n_specimens,)
        NaN where not stated. [N]
    broke : bool, optional
        As the laboratory states for every specimen; by default the record decides. [1]

    Returns
    -------
    pull : TensilePull
        With type A uncertainties only.

    Raises
    ------
    DataError
        If a specimen has fewer than three readings of tension, or a strength is not positive.

    Notes
    -----
    A break: after its greatest value the tension falls below half of it, for three readings, while
    the crosshead has gone back by less than a twentieth of its travel.  A pull that was
    stopped gives a lower bound.  [1]_ (sec. 6, Tables 10 and 21) prints strength and strain at
    failure of each pull and no uncertainty.  The greatest of noisy readings is biased high: by
    less than the noise of one reading where the record rises by more than that from reading to
    reading, and by up to two and a half times the noise where thousands are nearly as great.

    Examples
    --------
    >>> reach = np.concatenate([np.linspace(0, 1, 101), np.linspace(1, 1.2, 21)])
    >>> load = np.where(np.arange(122) < 101, 5000.0 * reach, 0.0)
    >>> pull = tensile_pull(reach, [load], [reach / 8], rated_break_strength=4000.0)
    >>> print(pull.peak_tension, pull.strain_at_peak, pull.is_break)
    [5000.] [0.125] [ True]
    """
    loads = np.atleast_2d(np.asarray(tension, dtype=np.float64))
    stretches = np.atleast_2d(np.asarray(strain, dtype=np.float64))
    strength = one_a_specimen(rated_break_strength, len(loads))
    numbers = np.full((4, len(loads)), np.nan)
    fell = np.zeros(len(loads), dtype=bool)
    how = []
    for row, (one, stretch) in enumerate(zip(loads, stretches, strict=True)):
        place, load = as_same_shape(position=position, tension=one)
        if np.count_nonzero(np.isfinite(load)) < _FEWEST_SAMPLES:
            raise DataError(
                "a pull has too few readings of tension",
                found=str(int(np.isfinite(load).sum())),
                needed=f"{_FEWEST_SAMPLES} or more",
            )
        peak = int(np.nanargmax(load))
        begin, reached = np.nanmin(place[: peak + 1]), np.nanmax(place[: peak + 1])
        parting = parting_sample(
            place, load, last=peak, least_position=reached - _GIVEN_BACK * (reached - begin),
            tension_low=_FALLEN * load[peak],
        )  # fmt: skip
        fell[row] = parting > 0
        numbers[:, row] = _at_the_top(load, stretch, parting if parting > 0 else load.size)
        if broke is not None:
            how.append("as stated")
        elif fell[row]:
            how.append(
                "tension falls by half after its greatest, and the crosshead does not go back"
            )
        else:
            how.append(
                "tension does not fall by half at the position of its greatest (where the log "
                "ends with the break, as a machine that stops at a part of the fall leaves it, "
                "state failed = true)"
            )
    return TensilePull(
        peak_tension=numbers[0],
        peak_tension_standard_uncertainty=numbers[1],
        strain_at_peak=numbers[2],
        strain_at_peak_standard_uncertainty=numbers[3],
        is_break=fell if broke is None else np.full(len(loads), broke),
        peak_tension_over_strength=numbers[0] / strength,
        peak_tension_over_strength_standard_uncertainty=numbers[1] / strength,
        how=tuple(how),
    )


def _gain(series: Floats) -> float:
    """Gain of a series from reading to reading at its end, smoothed."""
    steps = np.diff(series[np.isfinite(series)][-_LAST_STEPS - 1 :])
    return float(np.abs(np.median(steps))) if steps.size else 0.0


def _at_the_top(load: Floats, stretch: Floats, end: int) -> tuple[float, float, float, float]:
    """Greatest tension, its standard uncertainty, and the same for the strain there.

    Noise may make an early reading the greatest: where the load rises until it ends, the strain is
    the greatest of the candidate readings.  The line may part or turn up to a reading after the
    last one.
    """
    peak = int(np.nanargmax(load))
    rise = stretch[: peak + 1]
    noise, step = reading_noise(load[: peak + 1]), step_of_codes(load[: peak + 1])
    hidden = _MAY_BE_GREATEST * noise + step
    top = np.flatnonzero(load[:end] >= load[peak] - hidden)
    # of many readings that noise may make the greatest, one exceeds the noise of a single reading
    excess = np.sqrt(1 + np.log1p(top.size / _MAY_BE_GREATEST**2))
    spread = np.sqrt((excess * noise) ** 2 + (step**2 + _gain(load[: peak + 1]) ** 2) / 3)
    top = top[np.isfinite(stretch[top])]
    if not top.size or _stands_still(load[: peak + 1], rise, float(stretch[top[-1]])):
        return float(load[peak]), float(spread), np.nan, np.nan
    reached, missed = stretch[top], _gain(rise)
    width = float(np.ptp(reached))
    # while it is sound, the strain grows by no more than one reading further
    rises = np.nanmax(stretch[:end]) <= reached.max() + 2 * missed
    before = np.flatnonzero(np.isfinite(load[: top[-1] + 1] + stretch[: top[-1] + 1]))
    before = before[-max(top.size, _LEAST_TOP) :]
    if rises and np.ptp(stretch[before]) > 0:
        gain = np.polyfit(stretch[before], load[before], 1)[0] * np.ptp(stretch[before])
        rises = bool(gain > hidden / 2)
    by_peak = top[top <= peak]
    # as a laboratory defines it, where its load is greatest
    strain = float(reached.max() if rises else stretch[by_peak[-1] if by_peak.size else top[0]])
    beyond = missed if rises else missed + width / 2
    strain_spread = np.sqrt(
        reading_noise(rise) ** 2 + (step_of_codes(rise) ** 2 / 4 + beyond**2) / 3
    )
    return float(load[peak]), float(spread), strain, float(strain_spread)


_STOOD_STILL = 0.02  # of the greatest load, gained without strain


def _stands_still(load: Floats, rise: Floats, reached: float) -> bool:
    """Whether the load rose on to its peak while the strain did not: an extensometer taken off."""
    # change in the last part of a rise that noise and the steps of a converter may hide
    hidden = _HIDES * reading_noise(rise) + step_of_codes(rise)
    known = np.flatnonzero(np.isfinite(rise) & np.isfinite(load))
    below = np.flatnonzero(rise[known] < reached - hidden)
    if not below.size or not reached > 0:
        return bool(rise[known].max() > reached + hidden)
    since = known[min(below[-1] + 1, known.size - 1)]
    return bool(1 - load[since] / load[-1] > max(_STOOD_STILL, 2 * hidden / reached))


@dataclass(frozen=True)
class RopeStep:
    """One step; parts that it does not have are None, or empty.

    ``name`` describes it in words; ``dynamic`` has one level, the step; ``creep`` has
    one entry a hold, in the order of the holds of the test.
    """

    name: str
    bedding_in: BeddingIn | None = None
    dynamic: DynamicStiffness | None = None
    held: tuple[HeldPair, ...] = ()
    creep: tuple[CreepOfHold, ...] = ()
    lasted: CyclesToFailure | None = None
    tensile: TensilePull | None = None
    notes: tuple[Note, ...] = ()
