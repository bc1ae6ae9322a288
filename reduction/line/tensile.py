"""Tensile strength and strain at failure from the log of a pull to the end.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 6, Tables 10 and 21 (tensile
   strength and strain at failure of each pull).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.cycles.readings import reading_noise
from reduction.errors import DataError
from reduction.line.strength import one_a_specimen
from reduction.record import Bools, Floats, read_only_arrays

# a machine that goes back by more than this share of its travel has unloaded the line
_GIVEN_BACK = 0.05
_FALLEN = 0.5
_FEWEST_SAMPLES = 3
# readings within this many standard deviations of the greatest may be the peak
_PEAK_FACTOR = 2.0
_LAST_STEPS = 9


@dataclass(frozen=True)
@read_only_arrays
class TensilePull:
    """A pull to the end; arrays have shape (n_specimens,).

    Parameters
    ----------
    peak_tension, peak_tension_standard_uncertainty : ndarray
        Greatest tension; the noise of one reading and what the line gains between two. [N]
    strain_at_peak, strain_at_peak_standard_uncertainty : ndarray
        The same of strain, and half the range over which the tension is not told from its
        greatest, over root three. [1]
    is_break : ndarray of bool
        True where the line broke.
    peak_tension_over_strength, peak_tension_over_strength_standard_uncertainty : ndarray
        Over the rated break strength, which counts as exact. [1]
    how : tuple of str, length n_specimens
        What says that it broke or not.
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
        Of one specimen; NaN where missing. [N]
    last : int
        Sample after which it is looked for. [1]
    least_position : float
        At or beyond which a sound line is taut. [m]
    tension_low : float
        A reading below it there is no sound line's. [N]

    Returns
    -------
    sample : int
        -1 where fewer than three readings say so. [1]

    Raises
    ------
    DataError
        If the series do not pair up.

    Notes
    -----
    A line that is unloaded is slack because the crosshead went back, a line that has parted
    though it did not; [1]_ gives no rule, since a person stood by.

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
        As the laboratory says, of every specimen; left out, the record decides. [1]

    Returns
    -------
    pull : TensilePull
        With type A uncertainties alone.

    Raises
    ------
    DataError
        If the series do not pair up, a specimen has fewer than three readings of tension, or
        a strength is not positive.

    Notes
    -----
    A break: after its greatest the tension falls below half of it while the crosshead has
    gone back by less than a twentieth of its travel, for three readings.  A pull that was
    stopped gives a lower bound.  [1]_ prints strength and strain at failure of each pull and
    no uncertainty.  The greatest of readings with noise reads high, by less than the noise of
    one reading where the record rises by more than that from reading to reading.

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
    if loads.shape != stretches.shape:
        raise DataError(
            "strain does not fit the tension",
            found=f"{stretches.shape} and {loads.shape}",
            needed="one shape",
        )
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
        noise = reading_noise(load[: peak + 1])
        # it broke somewhere between its greatest reading and the next, which shows it parted
        numbers[:2, row] = load[peak], np.hypot(noise, _gain(load[: peak + 1]) / np.sqrt(12))
        numbers[2:, row] = _strain_there(load, stretch, peak, noise)
        begin, reached = np.nanmin(place[: peak + 1]), np.nanmax(place[: peak + 1])
        parting = parting_sample(
            place, load, last=peak, least_position=reached - _GIVEN_BACK * (reached - begin),
            tension_low=_FALLEN * load[peak],
        )  # fmt: skip
        fell[row] = parting > 0
        if broke is not None:
            how.append("as stated")
        elif fell[row]:
            how.append(
                "tension falls by half after its greatest, and the crosshead does not go back"
            )
        else:
            how.append("tension does not fall by half at the position of its greatest")
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
    """What a series gains from reading to reading at its end, noise evened out."""
    steps = np.diff(series[np.isfinite(series)][-_LAST_STEPS - 1 :])
    return float(np.abs(np.median(steps))) if steps.size else 0.0


def _strain_there(load: Floats, stretch: Floats, peak: int, noise: float) -> tuple[float, float]:
    """Strain at the peak, and what is not known of it where the top of the curve is flat."""
    rise = stretch[: peak + 1]
    top = np.flatnonzero(load[: peak + 1] >= load[peak] - _PEAK_FACTOR * noise)
    there = rise[top][np.isfinite(rise[top])]
    if not there.size:
        return np.nan, np.nan
    flat = (there.max() - there.min()) / 2 / np.sqrt(3)
    spread = np.sqrt(flat**2 + reading_noise(rise) ** 2 + _gain(rise) ** 2 / 12)
    # where the reading at the peak itself is missing, the nearest one before it
    return float(there[-1]), float(spread)
