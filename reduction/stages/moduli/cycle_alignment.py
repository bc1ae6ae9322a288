"""Alignment of the cycles of a test by their mean strain.

A rope in load control creeps: each cycle repeats the one before, further along the strain axis.
The mean tension at one strain then comes from different cycles at every strain, and its slope is
not that of any cycle.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 2.2 (modulus of a loop).
"""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers
from reduction.record.samples import empty_like, sample_blocks
from reduction.stages.moduli.modulus_product import ModulusCurves

_NEGLIGIBLE = 0.1  # of the standard uncertainty of the mean

_ALONG = 0.5  # of the shifts: part that mean tension may explain


def strain_shifts(mean_strain: Floats, *, break_in_cycles: int = 0) -> tuple[Floats, Floats]:
    r"""Distance of each cycle along the strain axis from the mean of all of them.

    .. math:: s_i = \bar\varepsilon_i - \varepsilon_0, \qquad
              \varepsilon_0 = \frac{1}{n} \sum_i \bar\varepsilon_i

    Parameters
    ----------
    mean_strain : ndarray, shape (n_specimens, n_cycles)
        Mean strain of each cycle; NaN where a cycle has none. [1]
    break_in_cycles : int
        First cycles, which are excluded from all means and from the reference. [1]

    Returns
    -------
    shift : ndarray, shape (n_specimens, n_cycles)
        For a cycle without a mean strain, interpolated between its neighbours. [1]
    reference : ndarray, shape (n_specimens,)
        Mean strain to which the cycles are aligned; NaN if no cycle has one. [1]

    Raises
    ------
    DataError
        If no cycle is left after break-in.

    Notes
    -----
    With the mean over the same cycles as reference, the curve stays in the middle of the strains of
    the test: it is neither that of the first cycle nor that of the last.

    Examples
    --------
    >>> shift, reference = strain_shifts(np.array([[0.10, np.nan, 0.14]]))
    >>> print(shift.round(3), reference.round(3))
    [[-0.02  0.    0.02]] [0.12]
    """
    strains = np.atleast_2d(np.asarray(mean_strain, dtype=np.float64))
    n_cycles = strains.shape[1]
    if not 0 <= break_in_cycles < n_cycles:
        raise DataError(
            "no cycle is left after break-in",
            found=f"{n_cycles} cycles, {break_in_cycles} of them break-in",
            needed="at least one cycle more than cycles.break_in_cycles",
        )
    shift, reference = np.zeros_like(strains), np.full(strains.shape[0], np.nan)
    number = np.arange(n_cycles)
    for row, one in enumerate(strains):
        known = np.isfinite(one)
        if not known[break_in_cycles:].any():
            continue
        reference[row] = one[break_in_cycles:][known[break_in_cycles:]].mean()
        shift[row] = np.interp(number, number[known], one[known]) - reference[row]
    return shift, reference


def time_with_hidden(time: Floats, number: Integers) -> Floats:
    """Beginning of each cycle, delayed by earlier cycles that were counted and not stored.

    A machine that stores one cycle in hundreds may write a time that counts its rows.

    Examples
    --------
    >>> time_with_hidden(np.array([0.0, 2, 4, 6]), np.array([1, 2, 500, 501])).tolist()
    [0.0, 2.0, 998.0, 1000.0]
    """
    lasts, counted = np.diff(time), np.diff(number)
    if not (counted > 1).any():
        return time
    next_ones = lasts[counted == 1]
    period = float(np.median(next_ones if next_ones.size else lasts))
    lasts = np.where(counted > 1, np.fmax(lasts, counted * period), lasts)
    return np.asarray(time[0] + np.append(0.0, np.cumsum(lasts)))


_JUMP = 5.0  # times the change of the mean in the same time between neighbouring cycles

_BESIDE_JUMP = 10  # changes on each side: the creep of the first cycles may exceed a slip

_JUMP_SEEN = 0.02  # of the amplitude

_AROUND_JUMP = 2  # least number of changes before it, and after it


def jump_of_mean(
    time: Floats, mean: Floats, other: Floats, slope: Floats, amplitude: Floats
) -> tuple[int, float] | None:
    """Find a step in the mean of one channel between two cycles, which the other does not follow.

    Parameters
    ----------
    time : ndarray, shape (n_cycles,)
        Beginning of each cycle. [s]
    mean, other : ndarray, shape (n_cycles,)
        Mean strain and mean tension of each cycle, or the reverse. [1], [N]
    slope : ndarray, shape (n_cycles,)
        Slope of the other channel over this one. [N]
    amplitude : ndarray, shape (n_cycles,)
        Amplitude of this channel. [1]

    Returns
    -------
    jump : tuple of int and float, or None
        Number of the last cycle before it, from 1, and its size; None where creep or relaxation
        may explain everything. [1]

    Notes
    -----
    Creep and relaxation are fastest at first and slow down, even in a pause between
    blocks of cycles; a jump exceeds the changes in the same time on both sides.  A jump inside
    a cycle is in two changes, and both are taken.

    Examples
    --------
    >>> drift = 0.02 + 0.0004 * np.log10(np.arange(1.0, 13.0))
    >>> slipped = drift + 0.002 * (np.arange(12) >= 6)
    >>> time, steady = np.arange(12.0), (np.full(12, 500.0), np.full(12, 1e4), np.full(12, 0.01))
    >>> [number, size] = jump_of_mean(time, slipped, *steady)
    >>> print(number, round(size, 4), jump_of_mean(time, drift, *steady))
    6 0.002 None
    """
    change, lasts = np.diff(mean), np.diff(time)
    rate = np.abs(change / lasts)
    if change.size <= 2 * _AROUND_JUMP + 1 or not np.isfinite(rate).all():
        return None
    found = [
        _one_jump(place, lasts, rate)
        for place in np.flatnonzero(
            rate == scipy.ndimage.maximum_filter1d(rate, 2 * _BESIDE_JUMP + 1)
        ).tolist()
        if _AROUND_JUMP <= place < rate.size - _AROUND_JUMP
    ]
    if not found:
        return None
    first, last, rest = max(found, key=lambda one: abs(change[one[0] : one[1] + 1].sum()) / one[2])
    size = float(change[first : last + 1].sum())
    least = max(_JUMP * rest, _JUMP_SEEN * float(np.median(amplitude)))
    followed = np.median(other[last + 1 :]) - np.median(other[: first + 1])
    if abs(size) <= least or abs(followed) > _ALONG * abs(size * float(np.median(slope))):
        return None
    return first + 1, size


def _one_jump(place: int, lasts: Floats, rate: Floats) -> tuple[int, int, float]:
    """First and last change of a jump, and the largest expected change beside it. [1]."""
    sides = rate[[place - 1, place + 1]]
    is_split = sides.max() > rate[place] / _JUMP
    first = place - 1 if is_split and sides[0] > sides[1] else place
    last = first + int(is_split)
    beside = np.concatenate([
        rate[max(first - _BESIDE_JUMP, 0) : first], rate[last + 1 : last + 1 + _BESIDE_JUMP]
    ])  # fmt: skip
    rest = float(beside.max() * lasts[first : last + 1].max())
    return first, last, max(rest, float(np.finfo(np.float64).tiny))


def jump_at_stop(
    begin: Floats, end: Floats, mean: Floats, is_stop: Bools
) -> tuple[int, float, float] | None:
    """Find the step in mean tension across a stop of the machine that relaxation explains least.

    Parameters
    ----------
    begin, end, mean : ndarray, shape (n_cycles,)
        Times of the ends of each cycle, and its mean tension. [s], [s], [N]
    is_stop : ndarray of bool, shape (n_cycles - 1,)
        Whether the log shows that no cycle ran between a cycle and the next one; otherwise it has
        no readings there. [-]

    Returns
    -------
    jump : tuple of int and float, or None
        Number of the last cycle before it, from 1, its size, and what may be a change of the
        specimen; None where that is as much. [N]

    Notes
    -----
    What relaxes or recovers in a stop passes again in the first cycles behind it.  After as many
    cycles as before it, and as long as the stop, the mean is back where it was, but for what
    it still changes over half of these cycles.  A zero of the load cell that has moved stays.
    In a gap of the log the machine may have run on: what the mean changes in the cycles beside it,
    it may have changed at the same rate in the gap.

    Examples
    --------
    >>> begin, shown = np.append(np.arange(12.0), 20 + np.arange(12.0)), np.full(23, True)
    >>> mean = 500 + 20 * np.exp(-(begin % 20))
    >>> found = jump_at_stop(begin, begin + 1, mean - 10.0 * (begin > 15), shown)
    >>> print(jump_at_stop(begin, begin + 1, mean, shown), found[:2])
    None (12, -10.0)
    """
    waits, period = begin[1:] - end[:-1], end - begin
    ends = [0, *(np.flatnonzero(waits > period[:-1] / 2) + 1).tolist(), begin.size]
    jumps = []
    for first, stop, last in zip(ends, ends[1:], ends[2:], strict=False):
        n = min(stop - first, last - stop)
        is_gap = not is_stop[stop - 1]
        missing = waits[stop - 1] / (n * period[stop]) if n else np.inf
        if n < _AT_STOP or not (is_gap or missing < 1):
            continue
        sides = mean[stop - n : stop], mean[stop : stop + n]
        before, after = (float(np.mean(one[-2:])) for one in sides)
        later = [one[-(n // 2 + 1) :] for one in sides]
        changes = sum(abs(float(np.mean(one[:2]) - np.mean(one[-2:]))) for one in later)
        changes *= 1 + is_gap * missing
        noise = np.sqrt(np.mean([np.mean(np.diff(one, n=2) ** 2) / 6 for one in later]))
        jumps.append((stop, after - before, changes + _BEYOND_NOISE * float(noise)))
    found = max(jumps, key=lambda one: abs(one[1]) - one[2], default=None)
    return found if found is not None and abs(found[1]) > found[2] else None


_AT_STOP = 6  # cycles on each side

_BEYOND_NOISE = 3.0  # of the mean over one cycle

CLEAR_JUMP = 4.0
"""Times what may be a change of the specimen: a step of the mean that none explains."""


def is_shift_of_curve(
    shift: Floats, mean_tension: Floats, spring_constant: Floats
) -> NDArray[np.bool_]:
    r"""Whether the curve itself shifts from cycle to cycle, as it does in creep.

    .. math:: \mathrm{rms}(\bar T_i - \bar T) / K < \mathrm{rms}(s_i) / 2

    Parameters
    ----------
    shift : ndarray, shape (n_specimens, n_cycles)
        From `strain_shifts`, for the cycles in the mean. [1]
    mean_tension, spring_constant : ndarray, same shape
        Mean tension of each cycle, and its apparent spring constant; NaN where missing. [N]

    Returns
    -------
    is_shift : ndarray of bool, shape (n_specimens,)
        False where the mean tension follows the strain, or falls while the crosshead keeps
        the strain: such cycles belong where they were measured. [1]

    Notes
    -----
    In load control the machine returns to the same tensions, and a specimen that creeps reaches
    them at larger strain.  In position control tension relaxes, and changes of strain, as
    splices give way, follow the curve of the specimen: shifting such cycles would move
    them off it.

    Examples
    --------
    >>> shift = np.array([[-0.001, 0.0, 0.001]])
    >>> steady, falling = np.full((1, 3), 500.0), np.array([[520.0, 500.0, 480.0]])
    >>> is_shift_of_curve(shift, steady, np.full((1, 3), 1e4))
    array([ True])
    >>> is_shift_of_curve(shift, falling, np.full((1, 3), 1e4))
    array([False])
    """
    found = np.zeros(shift.shape[0], dtype=bool)
    for row, (apart, load, slope) in enumerate(
        zip(shift, mean_tension, spring_constant, strict=True)
    ):
        known = np.isfinite(load) & np.isfinite(slope)
        if known.any():
            along = np.std(load[known]) / abs(float(np.median(slope[known])))
            found[row] = bool(along < _ALONG * np.sqrt(np.mean(apart[known] ** 2)))
    return found


def alignment_moves(
    curves: ModulusCurves, shift: Floats, half_range: Floats, reference: Floats, *, area: Floats
) -> NDArray[np.bool_]:
    r"""Whether aligned cycles would have a different mean from cycles as measured.

    .. math:: \Delta T = T' (\bar s_b - \bar s) + T'' \overline{s^2} / 2

    Parameters
    ----------
    curves : ModulusCurves
        Over the cycles as measured. [SI]
    shift, half_range : ndarray, shape (n_specimens, n_cycles)
        From `strain_shifts`, and half the range of strain of each cycle; for those in the mean. [1]
    reference : ndarray, shape (n_specimens,)
        From `strain_shifts`. [1]
    area : ndarray, shape (n_specimens,)
        Cross-section at zero tension. [m2]

    Returns
    -------
    moves : ndarray of bool, shape (n_specimens,)
        True where the mean tension of some bin would move by a tenth of its standard uncertainty
        or more; where the cycles are further apart than a bin is wide, so that bins at the ends
        belong to some of them; and where the cycles as measured have no mean. [1]

    Notes
    -----
    A cycle that is further along by :math:`s` has, at a given strain, a tension lower by
    :math:`T' s`.  Over the cycles that reach a bin the mean is :math:`\bar s_b`, which is not zero
    where some do not reach it; the second term is the effect of curvature on cycles on both sides.

    Examples
    --------
    Four cycles of a straight line, 1000 N per unit strain, the first two lower:

    >>> x = np.arange(0.0, 1.0, 0.1) + 0.05
    >>> load = np.broadcast_to(1000 * x, (1, 2, 10))
    >>> blank = dict.fromkeys(ModulusCurves.__dataclass_fields__, np.zeros((1, 2, 10)))
    >>> curves = ModulusCurves(**blank | {
    ...     "strain_bin": x, "strain_bin_bounds": np.column_stack([x - 0.05, x + 0.05]),
    ...     "branch_tension": load, "tangent_modulus": 0 * load + 1e7, "window": 0.3,
    ...     "branch_tension_standard_uncertainty": 0 * load + 1.0,
    ... })
    >>> shift = np.array([[-0.2, -0.2, 0.2, 0.2]])
    >>> lies = {"half_range": np.full((1, 4), 0.3), "reference": np.array([0.5])}
    >>> print(alignment_moves(curves, shift, area=np.array([1e-4]), **lies))
    [ True]
    >>> print(alignment_moves(curves, 1e-5 * shift, area=np.array([1e-4]), **lies))
    [False]
    """
    width = float(np.diff(curves.strain_bin_bounds[0])[0])
    moves = np.zeros(shift.shape[0], dtype=bool)
    for row, (apart, half) in enumerate(zip(shift, half_range, strict=True)):
        if not np.isfinite(reference[row]):
            continue
        tension = curves.branch_tension[row]
        if np.ptp(apart) > width or not np.isfinite(tension).any():
            moves[row] = True
            continue
        middle = reference[row] + apart
        slope = curves.tangent_modulus[row] * area[row]
        bend = np.gradient(slope, curves.strain_bin, axis=-1) if slope.shape[-1] > 1 else 0 * slope
        of_bin = _mean_shift(apart, middle - half, middle + half, curves)
        change = np.abs(slope * of_bin) + np.abs(np.nan_to_num(bend)) * np.mean(apart**2) / 2
        spread = curves.branch_tension_standard_uncertainty[row]
        moves[row] = bool((change >= _NEGLIGIBLE * spread)[np.isfinite(change * spread)].any())
    return moves


def _mean_shift(shift: Floats, low: Floats, high: Floats, curves: ModulusCurves) -> Floats:
    """Mean shift of the cycles that reach each bin, shape (n_bins,); NaN where none does."""
    edges = np.append(curves.strain_bin_bounds[:, 0], curves.strain_bin_bounds[-1, 1])
    n_bins = curves.strain_bin.size
    known = np.isfinite(low) & np.isfinite(high)
    begin = np.clip(np.searchsorted(edges, low[known]), 0, n_bins)
    end = np.clip(np.searchsorted(edges, high[known], side="right") - 1, begin, n_bins)

    def over_bins(weights: Floats) -> Floats:
        entered = np.bincount(begin, weights, n_bins + 1) - np.bincount(end, weights, n_bins + 1)
        return np.asarray(np.cumsum(entered)[:n_bins])

    count = over_bins(np.ones(begin.size))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(count > 0.5, over_bins(shift[known]) / count, np.nan)


def aligned_strain(strain: Floats, shift: Floats, cycle_number: NDArray[np.int32]) -> Floats:
    """Strain with each cycle shifted onto the mean strain of all.

    Parameters
    ----------
    strain : ndarray, shape (n_specimens, n_samples)
        Strain as measured. [1]
    shift : ndarray, shape (n_specimens, n_cycles)
        From `strain_shifts`; zero where there is no shift. [1]
    cycle_number : ndarray of int32, shape (n_samples,)
        From 1; samples outside cycles, 0, are not changed. [1]

    Returns
    -------
    aligned : ndarray, shape (n_specimens, n_samples)
        Stored like ``strain``, in memory or on disk. [1]

    Notes
    -----
    A constant is subtracted within a cycle, so that no slope and no loop changes.

    Examples
    --------
    >>> number = np.array([0, 1, 1, 2, 2], dtype=np.int32)
    >>> strain = np.array([[0.0, 0.1, 0.2, 0.3, 0.4]])
    >>> print(aligned_strain(strain, np.array([[-0.1, 0.1]]), number))
    [[0.  0.2 0.3 0.2 0.3]]
    """
    by_number = np.concatenate([np.zeros((shift.shape[0], 1)), shift], axis=1)
    aligned = empty_like(strain)
    for part in sample_blocks(strain.shape[1], strain, cycle_number, aligned):
        aligned[:, part] = strain[:, part] - by_number[:, cycle_number[part]]
    return np.asarray(aligned)
