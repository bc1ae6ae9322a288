r"""Load train: effect of mass and compliance between the specimen and the sensors on a log.

The load cell measures the specimen and the inertia of all accelerated parts; the crosshead's scale
measures the specimen and all compliant parts:

.. math:: F = T + m\, \ddot x, \qquad x = X - c\, T

with F and X as logged, T the tension and x the length of the specimen, and m the effective mass
at its moving end.

References
----------
.. [1] J. W. S. Rayleigh, "The Theory of Sound," vol. 1, 2nd ed., Macmillan, London, 1894, sec. 156
   (a third of the mass of a spring counts at its moving end).
.. [2] A. Savitzky and M. J. E. Golay, "Smoothing and differentiation of data by simplified least
   squares procedures," Anal. Chem., vol. 36, no. 8, pp. 1627-1639, 1964.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike

from reduction.record.arrays import as_same_shape
from reduction.record.errors import DataError
from reduction.record.measurement import Floats, LoadTrain, Record, Specimen
from reduction.record.notes import note
from reduction.record.samples import empty_like, take_samples
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.standstills import Standstills, estimate_noise, median_step

_DEGREE = 6

_NOISE_OF_FIT = 52.0  # deviation of the second derivative, times half width^2 and root of points

_FEWEST, _TO_A_SIDE = 9, 3  # points of a fit, and of those on either side of its centre

_POINTS = 81  # of a fit: if there are more they are averaged first

_OF_PERIOD = 0.25  # half width, at most: a sine comes out 0.02 % too small

_OF_CELL_NOISE = 1 / 3  # of the noise of a load cell: allowed noise of the correction

_FEWEST_A_CYCLE = 16

_REACHES = 32  # steps of a difference, in the longest of them

_SURE = 3  # standard errors that a mean acceleration has to exceed

_FITS = 4096  # at a time


def end_mass(
    train: LoadTrain, *, linear_density: float | None, slack_length: float | None
) -> tuple[float, float]:
    r"""Mass whose inertia a load cell adds to the tension of a uniform specimen.

    .. math:: m = m_a + \tfrac13 \mu \ell \;\text{(moving end)}, \qquad
              m = -\tfrac16 \mu \ell \;\text{(fixed end)}

    Parameters
    ----------
    train : LoadTrain
        Load train, with the place of its load cell.
    linear_density : float or None
        Mass per length of the slack specimen. [kg m-1]
    slack_length : float or None
        [m]

    Returns
    -------
    mass : float
        Zero where nothing is stated. [kg]
    length : float
        Factor of the linear density in this mass. [m]

    Notes
    -----
    A specimen of mass M whose displacement is linear from one end to the other has
    T(s) = T(0) + M (s/l)^2 a / 2.  Its tension is the mean along it, which does the
    work on its strain: M a / 6 more than at the fixed end, M a / 3 less than at the moving one,
    the third of [1]_.  This holds far below the first resonance of the specimen.

    Examples
    --------
    5 kg of shackles, 3 m of 0.6 kg/m:

    >>> for place in ("moving", "fixed"):
    ...     mass, length = end_mass(LoadTrain(place, 5.0), linear_density=0.6, slack_length=3.0)
    ...     print(round(mass, 6), length)
    5.6 1.0
    -0.3 -0.5
    """
    if train.load_cell_at is None:
        return 0.0, 0.0
    is_moving = train.load_cell_at == "moving"
    length = (slack_length or 0.0) * (1 / 3 if is_moving else -1 / 6)
    attached = train.attached_mass or 0.0
    return is_moving * attached + length * (linear_density or 0.0), length


def acceleration(time: ArrayLike, position: ArrayLike, *, half_width: float) -> Floats:
    """Second derivative of position, by polynomials of sixth degree in a moving window.

    Parameters
    ----------
    time, position : array_like, shape (n_samples,)
        NaN where not known. [s], [m]
    half_width : float
        Half width of the window. [s]

    Returns
    -------
    acceleration : ndarray, shape (n_samples,)
        NaN where the window holds fewer than nine samples, or fewer than three on one side.
        [m s-2]

    Raises
    ------
    DataError
        If the arrays differ in shape.

    Notes
    -----
    Least squares, [2]_, on the times as logged, which need not be even: a window extends half a
    step beyond its ends, so that times rounded to a millisecond lose no sample.  In a window
    of half a period a sine comes out 0.02 % too small and its third harmonic 7 %; white noise of
    standard deviation s in n samples gives 52 s / (h^2 sqrt n), h the half width.  Where a window
    has more than 81 samples they are averaged in groups first.

    Examples
    --------
    A sine of 0.1 m and 2 Hz, logged 64 times a cycle, at its top:

    >>> t = np.arange(257) / 128
    >>> found = acceleration(t, -0.1 * np.cos(4 * np.pi * t), half_width=0.125)
    >>> print(round(float(found[96] / (-0.1 * (4 * np.pi) ** 2)), 4))
    0.9998
    """
    all_times, all_places = as_same_shape(time=time, position=position)
    known = np.isfinite(all_times) & np.isfinite(all_places)
    t, x = all_times[known], all_places[known]
    if t.size < _FEWEST:
        return np.full(all_times.shape, np.nan)
    group = max(int(2 * half_width / float(np.median(np.diff(t)))) // _POINTS, 1)
    n_whole = t.size // group * group
    t, x = (one[:n_whole].reshape(-1, group).mean(axis=1) for one in (t, x))
    step = float(np.median(np.diff(t))) if t.size > 1 else half_width
    reach = int(np.ceil(half_width / step))
    around = [sliding_window_view(np.pad(one, reach, constant_values=np.nan), 2 * reach + 1)
              for one in (t, x)]  # fmt: skip
    found = np.empty(t.size)
    for begin in range(0, t.size, _FITS):
        part = slice(begin, begin + _FITS)
        found[part] = _bend(
            (around[0][part] - t[part, None]) / half_width,
            around[1][part] - x[part, None],
            1 + step / (2 * half_width),
        )
    return np.asarray(np.interp(all_times, t, found) / half_width**2)


def length_by_stroke(position: Floats, cycles: Cycles, strain_amplitude: ArrayLike) -> float:
    """Stroke of the crosshead over range of strain, where an extensometer measures the strain.

    Parameters
    ----------
    position : ndarray, shape (n_samples,)
        Of the crosshead. [m]
    cycles : Cycles
        Cycles with the turns.
    strain_amplitude : array_like
        Of the test, or of each cycle. [1]

    Returns
    -------
    length : float
        Length that all that stretches between the pins would have at this strain. [m]

    Examples
    --------
    3 m from pin to pin, strained from 0.1 to 0.2:

    >>> none = np.empty(0)
    >>> branch = np.array([[0, 1]])
    >>> cycles = Cycles(np.array([0]), np.array([2]), branch, branch + 1, np.ones((1, 2)),
    ...     none.astype(int), none.astype(int), none > 0, 0.01)
    >>> print(round(length_by_stroke(np.array([3.3, 3.6, 3.3]), cycles, 0.05), 3))
    3.0
    """
    valley, peak = (
        take_samples(position, at[:, 0]) for at in (cycles.branch_first, cycles.branch_last)
    )
    return float(np.nanmedian(peak - valley) / np.nanmedian(2 * np.asarray(strain_amplitude)))


def turn_acceleration(
    time: Floats,
    position: Floats,
    cycles: Cycles,
    *,
    found: Floats | None = None,
    finest: int = 1,
) -> float:
    """Size of the acceleration at the turns, by second differences of the readings there.

    Parameters
    ----------
    time, position : ndarray, shape (n_samples,)
        NaN where not known. [s], [m]
    cycles : Cycles
        Cycles with the turns.
    found : ndarray, shape (n_samples,), or None
        Known part of the acceleration, which is subtracted. [m s-2]
    finest : int
        Number of steps of the shortest differences. [-]

    Returns
    -------
    acceleration : float
        Mean over peaks and valleys; zero where noise hides it. [m s-2]

    Notes
    -----
    At the corner between two ramps a machine turns in an unknown time: a difference
    over few steps shows most of it, but has most noise.  Differences over 1, 2, 4, ... steps,
    at most a sixteenth of a cycle, are taken as far to either side of the turns.  The one with the
    greatest mean over the turns, less three standard errors, is used.

    Examples
    --------
    A sine of 0.1 m and 2 Hz, logged 64 times a cycle, has 15.8 m/s2:

    >>> t = np.arange(257) / 128
    >>> first = np.array([0, 64, 128, 192])
    >>> branch = np.stack([first, first + 32], axis=1)
    >>> none = np.zeros(257)
    >>> cycles = Cycles(first, first + 64, branch, branch + 32, np.ones((4, 2)), none.astype(int),
    ...     none.astype(int), none > 0, 0.01)
    >>> round(turn_acceleration(t, -0.1 * np.cos(4 * np.pi * t), cycles), 1)
    15.8
    """
    longest = max(int(np.median(cycles.last - cycles.first)) // 16, 1)
    sizes = []
    for turns in (cycles.first, cycles.branch_first[:, 1]):
        size, reach = 0.0, finest * max(longest // _REACHES, 1)
        while reach <= longest:
            # near a sharp turn, a smooth acceleration is too large
            for away in range(-longest, longest + 1, reach):
                here = turns + away
                here = here[(here >= reach) & (here < position.size - reach)]
                before, after = time[here] - time[here - reach], time[here + reach] - time[here]
                with np.errstate(divide="ignore", invalid="ignore"):  # readings at one time
                    bend = (
                        (position[here + reach] - position[here]) / after
                        - (position[here] - position[here - reach]) / before
                    ) / (0.5 * (before + after))
                if found is not None:
                    bend = bend - found[here]
                bend = bend[np.isfinite(bend)]
                if bend.size >= _TO_A_SIDE:
                    error = float(np.std(bend, ddof=1)) / np.sqrt(bend.size)
                    size = max(size, abs(float(np.mean(bend))) - _SURE * error)
            reach *= 2
        sizes.append(size)
    return float(np.mean(sizes))


def _bend(away: Floats, moved: Floats, reach: float) -> Floats:
    """Second derivative at the centre of each row; both shape (n_fits, n_points)."""
    inside = np.abs(away) <= reach
    away, moved = np.where(inside, away, 0.0), np.where(inside, moved, 0.0)
    power = np.where(inside[..., None], away[..., None] ** np.arange(_DEGREE + 1), 0.0)
    normal = np.einsum("fpi,fpj->fij", power, power)
    sides = [np.count_nonzero(inside & (way * away > 0), axis=1) for way in (1, -1)]
    is_told = (np.minimum(*sides) >= _TO_A_SIDE) & (inside.sum(axis=1) >= _FEWEST)
    normal[~is_told] = np.eye(_DEGREE + 1)
    solved = np.linalg.solve(normal, np.einsum("fpi,fp->fi", power, moved)[..., None])
    return np.where(is_told, 2 * solved[:, 2, 0], np.nan)


def _half_width(
    record: Record, position: Floats, tension: Floats, mass: Floats, period: float
) -> float:
    """Least width that adds little to the noise of the load cells; at most a quarter period."""
    noise, quantum = estimate_noise(position)
    of_position = float(np.hypot(noise, quantum / np.sqrt(12)))
    step = median_step(record.time)
    widest = _OF_PERIOD * period
    if period < _FEWEST_A_CYCLE * step:
        raise DataError(
            f"test '{record.test_id}': its log has too few samples for the acceleration of the "
            "mass between specimen and load cell",
            found=f"{period / step:.1f} samples per cycle",
            needed=f"{_FEWEST_A_CYCLE} or more",
            hint="Without them the tension cannot be corrected for inertia.",
        )
    worst = 0.0
    for load, own in zip(tension, mass, strict=True):
        of_cell = float(np.hypot(*(np.array(estimate_noise(load)) / (1, np.sqrt(12)))))
        if own and of_cell > 0:
            worst = max(worst, abs(own) * of_position / (_OF_CELL_NOISE * of_cell))
        elif own:
            return widest
    wanted = (_NOISE_OF_FIT * worst * np.sqrt(step / 2)) ** 0.4
    return float(np.clip(wanted, 4 * step, widest))


def _continued(
    time: Floats, position: Floats, cycles: Cycles, half_width: float
) -> tuple[Floats, Floats, slice]:
    """A log that begins or ends within its cycles, extended by part of the adjoining cycle.

    A polynomial gives no second derivative at the end of its data.
    """
    times, places, before = [time], [position], 0
    for is_end, first, last in (
        (False, int(cycles.first[0]), int(cycles.last[0])),
        (True, int(cycles.first[-1]), int(cycles.last[-1])),
    ):
        edge = time[-1] if is_end else time[0]
        if abs(edge - time[last if is_end else first]) > half_width:
            continue
        period = float(time[last] - time[first])
        own = slice(first, last + 1)
        if is_end:
            shifted = time[own] + period
            kept = (shifted > time[-1]) & (shifted <= time[-1] + 2 * half_width)
            times.append(shifted[kept])
            places.append(position[own][kept])
        else:
            shifted = time[own] - period
            kept = (shifted < time[0]) & (shifted >= time[0] - 2 * half_width)
            times.insert(0, shifted[kept])
            places.insert(0, position[own][kept])
            before = int(np.count_nonzero(kept))
    whole = slice(before, before + time.size)
    return np.concatenate(times), np.concatenate(places), whole


def without_load_train(
    record: Record,
    position: Floats,
    tension: Floats,
    *,
    standstills: Standstills,
    cycles: Cycles | None,
    specimens: tuple[Specimen, ...],
    parted: Sequence[int] = (),
) -> tuple[Record, Floats, Floats]:
    """Correct position and tension of a record to those of its specimens.

    Parameters
    ----------
    record : Record
        As logged, with the stated properties of its load train.
    position, tension : ndarray, shapes (n_samples,) and (n_specimens, n_samples)
        NaN where not usable. [m], [N]
    standstills : Standstills
        Used for the length at slack.
    cycles : Cycles or None
        Without them no acceleration is assumed.
    specimens : tuple of Specimen
        Used for their mass; in the order of the record.
    parted : sequence of int, optional
        Sample from which each specimen no longer pulls, -1 if it does to the end; none has parted
        if left out. [1]

    Returns
    -------
    record : Record
        With its own channels corrected too, and a note on the correction; unchanged if nothing is
        stated.
    position, tension : ndarray
        Corrected. [m], [N]

    Raises
    ------
    DataError
        If the log has fewer than 16 samples a cycle, and a mass to be corrected for.

    Notes
    -----
    The crosshead pulls all specimens: compliant parts give by the sum of their tensions.  The
    length of the specimen excludes the compliance at its own tension, which includes inertia:
    the inertia is computed first for the crosshead, then for the specimen.

    Examples
    --------
    >>> held = Record("R-1", ("rope",), np.arange(3.0), np.ones(3), np.full((1, 3), 500.0),
    ...     np.zeros((1, 3), np.uint16), np.zeros(3, np.uint16),
    ...     load_train=LoadTrain(machine_compliance=2e-6))
    >>> none = np.empty(0)
    >>> still = Standstills(none, none, none, none, none, np.empty((1, 0)), none > 0, 0.01, 5.0)
    >>> _, length, _ = without_load_train(held, held.crosshead_position, held.tension,
    ...     standstills=still, cycles=None, specimens=(Specimen("rope", "rope"),))
    >>> print(length)
    [0.999 0.999 0.999]
    """
    train, compliance = record.load_train, record.load_train.machine_compliance or 0.0
    pairs = [
        end_mass(
            train,
            linear_density=one.linear_density,
            slack_length=slack_length(record, position, standstills, one),
        )
        for one in specimens
    ]
    mass = np.array([own for own, _ in pairs])
    is_cycling = cycles is not None and cycles.n_cycles > 0
    moves = is_cycling and bool(mass.any())
    if is_cycling and train.load_cell_at is not None:
        train = replace(
            train, end_mass=tuple(mass.tolist()),
            end_mass_by_density=tuple(length for _, length in pairs),
        )  # fmt: skip
    if not (compliance or moves):
        return replace(record, load_train=train), position, tension
    notes = list(record.notes)
    given, raw = np.zeros(position.shape), record.tension
    if compliance:
        given = compliance * _pull_of_all(tension, parted)
    if moves and cycles is not None:
        periods = take_samples(record.time, cycles.last) - take_samples(record.time, cycles.first)
        # for steps of several frequencies, the fastest one
        period = float(np.percentile(periods, 5))
        width = _half_width(record, position, tension, mass, period)
        cycling = np.asarray(cycles.cycle_number > 0)
        inertia = np.zeros((1, position.size))
        for _ in range(2 if compliance else 1):
            time, place, own = _continued(np.asarray(record.time), position - given, cycles, width)
            found = acceleration(time, place, half_width=width)[own]
            # outside the cycles a log may be too sparse, and nothing moves fast
            inertia = mass[:, None] * np.where(cycling, found, np.nan_to_num(found))
            given = compliance * _pull_of_all(tension - inertia, parted)
        tension, raw = _less(tension, inertia), _less(raw, np.nan_to_num(inertia))
        left = turn_acceleration(np.asarray(record.time), position - given, cycles, found=found)
        train = replace(train, force_left_at_turns=tuple((np.abs(mass) * left).tolist()))
        for place_of, one in enumerate(specimens):
            force = inertia[place_of][cycling]
            notes.append(
                note(
                    "inertia-taken-off", one.name, mass=float(mass[place_of]),
                    force=float(np.nanmax(np.abs(force))), width=2 * width,
                    n_lost=int(np.count_nonzero(np.isnan(force))), cell=train.load_cell_at,
                )
            )  # fmt: skip
    if compliance:
        notes.append(
            note("give-taken-off", compliance=compliance, length=float(np.nanmax(np.abs(given))))
        )
        position = _less(position, given)
    corrected = replace(
        record, tension=raw, load_train=train, notes=tuple(notes),
        crosshead_position=_less(record.crosshead_position, np.nan_to_num(given)),
    )  # fmt: skip
    return corrected, position, tension


def _pull_of_all(tension: Floats, parted: Sequence[int]) -> Floats:
    """Sum of the tensions; a specimen that has parted, whose readings are not usable, has none."""
    pull = np.zeros(tension.shape[1:])
    for row, load in enumerate(tension):
        stop = parted[row] if row < len(parted) and parted[row] > 0 else None
        pull[:stop] += load[:stop]
    return pull


def _less(values: Floats, part: Floats) -> Floats:
    """Difference, stored in the same way as the values."""
    kept = empty_like(values)
    np.subtract(values, part, out=kept)
    return kept


def slack_length(
    record: Record, position: Floats, standstills: Standstills, specimen: Specimen
) -> float | None:
    """Length of a specimen at slack: its first rest, its gauge length, or the least position."""
    rests = standstills.mean_position[standstills.is_rest]
    if record.position_is_length and rests.size:
        return float(rests[0])
    if specimen.gauge_length is not None:
        return specimen.gauge_length
    return float(np.nanmin(position)) if record.position_is_length else None
