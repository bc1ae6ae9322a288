r"""Slow pull of a line: load-strain cubic, and the quasi-static spring constant as its slope.

.. math:: \varepsilon = A + B T + C T^2 + D T^3, \qquad
          K_0(T) = \frac{d T}{d\varepsilon} = \frac{1}{B + 2 C T + 3 D T^2}

As printed, and as computed.  [1]_ prints two forms that do not quite agree: cubics of strain
(Tables 8 and 9) and cubics of K_0 (Tables 6 and 7).  Here the strain is fitted and K_0 is its
slope; the cubic of K_0 is then fitted to that slope for those who need it, with its greatest
distance from it.  Table 6 heads its form A + B T^2 + C T^3 + D T^4, times 1e-4; the form that
gives its numbers is Table 7's A + B T + C T^2 + D T^3, times 1e4.  Signs and powers are lost
in Tables 6, 7 and 9 (nylon double braid D 3.26 for 32.6, nylon plaited C, polyester C), and
polyester plaited line has no K_0 row at all.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4.2, 4.4.3, Tables 6-9, App. D.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.cycles.readings import reading_noise
from reduction.errors import DataError, FitError
from reduction.line.cubic import positive_range, printed_form
from reduction.line.loading import find_loading, greatest_fall
from reduction.line.product import SlowPull
from reduction.line.pullblocks import (
    N_BLOCKS,
    block_means,
    covariance_of_blocks,
    misfit_of_cubic,
    rates_of_pull,
)
from reduction.moduli.separable import lag_one_inflation
from reduction.record import Integers

# rms of what a cubic misses, over the strain of the pull: above it the curve is none
MISFIT_NOTED = 0.01

_FEWEST_BLOCKS = 8
_FALL_NOTED = 0.02
_FALL_REFUSED = 0.25
# a range of use below this share of the readings is no load-strain curve
_SHORTEST_RANGE = 0.5
_UNEVEN_RATE = 2.0
# strain at the reference tension, as a share of that of the pull, that is no zero
_OFF_ZERO = 0.05
_NOISE_FACTOR = 6.0


def _remarks(
    *,
    fall: float,
    rates: tuple[float, ...],
    reference_length: float,
    reference_strain: float,
    waiting: bool,
    cut: bool,
    misfit: float,
) -> tuple[str, ...]:
    remarks = []
    if misfit > MISFIT_NOTED:
        remarks.append(
            f"a cubic misses the load-strain curve by {misfit:.1%} of its strain (rms): strain "
            "and K_0 by it are no values to design by"
        )
    if fall > _FALL_NOTED:
        remarks.append(f"tension falls by {fall:.1%} of the rise on the way to the peak")
    if rates[2] > _UNEVEN_RATE * rates[1]:
        remarks.append(
            f"the strain rate is uneven: from {rates[1]:.2g} to {rates[2]:.2g} 1/s over quarters "
            "of the range"
        )
    if not np.isfinite(reference_length):
        remarks.append("the length at which strain is zero is not stated")
    if not np.isnan(reference_strain):
        remarks.append(
            f"strain is {reference_strain:+.2%} at the reference tension, so the reference length "
            "was read elsewhere, or the line has lengthened since"
        )
    if not waiting:
        remarks.append("the time since the last dynamic test is not stated, and K_0 depends on it")
    if cut:
        remarks.append("the range of use ends where the slope of the cubic turns")
    return tuple(remarks)


def fit_pull(
    time: ArrayLike,
    strain: ArrayLike,
    tension: ArrayLike,
    *,
    specimen: str = "",
    reference_tension: float | None = None,
    reference_length: float | None = None,
    waiting_time: float | None = None,
    waiting: str = "",
) -> SlowPull:
    r"""Load-strain cubic of the loading part of a slow pull.

    .. math:: \varepsilon = A + B T + C T^2 + D T^3

    Parameters
    ----------
    time : array_like, shape (n_samples,)
        Elapsed time. [s]
    strain : array_like, shape (n_samples,)
        Nominal strain of the free length; NaN where missing. [1]
    tension : array_like, shape (n_samples,)
        Of one specimen; NaN where missing. [N]
    specimen : str, optional
        Name, kept with the result.
    reference_tension : float, optional
        Tension at which the reference length was read, from which the pull counts; left
        out, the first rise out of slack. [N]
    reference_length : float, optional
        Length at which strain is zero. [m]
    waiting_time : float, optional
        Since the last dynamic test. [s]
    waiting : str, optional
        The same in the laboratory's words.

    Returns
    -------
    pull : SlowPull
        Cubic with covariance, range of use, rates and the conditions. [1], [N], [s-1]

    Raises
    ------
    DataError
        If series do not pair up, have too few readings, tension does not rise, or it falls
        by more than a quarter of its rise on the way.
    FitError
        If fewer than eight steps of tension have a reading, or the slope of the cubic is
        not positive over half of the range.

    Notes
    -----
    Source: [1]_, sec. 4.4.2 and 4.4.3.  Readings are first averaged over a hundredth of the
    tension range each, and the residuals of those means carry the uncertainty, widened by
    their likeness to their neighbours: thousands of readings would hide in a root of their
    number what a cubic leaves.  A curve that is no cubic has another slope than its cubic;
    how much, a polynomial of sixth degree tells, and that is added.  The standard
    uncertainty holds these and no calibration.

    App. D of [1]_ finds 4.22, 6.33 and 7.71e4 lb for K_0 of one line: at 0.071 per minute
    a day after the dynamic test, at 0.23 per minute a day after, and at 0.23 per minute at
    once, that is a factor of 1.5 to 1.8.  The rate and the waiting time stay with the
    number for that reason, and it enters K_1 and tau in full.

    Examples
    --------
    >>> load = np.linspace(0, 2000.0, 400)
    >>> stretch = 1.389e-4 * load - 3.906e-8 * load**2 + 3.795e-12 * load**3
    >>> pull = fit_pull(np.arange(400.0), stretch, load, waiting_time=86400.0)
    >>> print((pull.strain_coefficient[1:] * [1e4, 1e8, 1e12]).round(3))
    [ 1.389 -3.906  3.795]
    """
    clock, stretch, load = as_same_shape(time=time, strain=strain, tension=tension)
    rows: Integers = find_loading(load, stretch, reference_tension=reference_tension)
    rows = rows[np.isfinite(clock[rows])]
    clock, stretch, load = clock[rows], stretch[rows], load[rows]
    low, high = float(load[0]), float(load.max())
    blocks = block_means(clock, stretch, load)
    # falls of single readings are noise
    fall = max(greatest_fall(load) - _NOISE_FACTOR * reading_noise(load), 0.0) / (high - low)
    if fall > _FALL_REFUSED:
        raise DataError(
            f"tension falls by {fall:.0%} of its rise on the way to the peak",
            needed="a loading in one direction",
            hint="Give the slow pull alone, by a step with its own from and to.",
        )
    n_blocks = blocks.strain.size
    if n_blocks < _FEWEST_BLOCKS:
        raise FitError(
            "too few steps of tension for a cubic",
            found=f"{n_blocks} of {N_BLOCKS} with a reading",
            needed=f"{_FEWEST_BLOCKS} or more",
        )
    powers = blocks.powers[:, :4]
    solution, *_ = np.linalg.lstsq(powers, blocks.strain, rcond=None)
    coefficient = solution.astype(np.float64)
    residual = blocks.strain - powers @ coefficient
    covariance = covariance_of_blocks(powers, residual)
    strain_misfit, slope_misfit = misfit_of_cubic(blocks, coefficient, covariance)
    start, stop = positive_range(coefficient)
    if stop - start < 2 * _SHORTEST_RANGE:
        raise FitError(
            "the load-strain cubic does not rise",
            found=f"a positive slope over {(stop - start) / 2:.0%} of the range of tension",
            needed=f"{_SHORTEST_RANGE:.0%} or more",
            hint="Check the signs of strain and tension.",
        )
    centre, half = (low + high) / 2, (high - low) / 2
    use = (centre + half * start, centre + half * stop)
    polynomial, deviation = printed_form(
        coefficient, low=use[0], high=use[1], centre=centre, half=half
    )
    rates = rates_of_pull(blocks)
    length = np.nan if reference_length is None else reference_length
    begins = np.nan
    if reference_tension is not None:
        at = (reference_tension - centre) / half
        strain_there = float(at ** np.arange(4) @ coefficient)
        if abs(strain_there) > _OFF_ZERO * float(blocks.strain[-1] - blocks.strain[0]):
            begins = strain_there
    pull = SlowPull(
        specimen=specimen,
        tension_centre=centre,
        tension_half_range=half,
        coefficient=coefficient,
        covariance=covariance,
        tension_low=use[0],
        tension_high=use[1],
        strain_misfit=strain_misfit,
        slope_misfit=slope_misfit,
        residual_deviation=float(np.sqrt((residual**2).sum() / (n_blocks - 4))),
        variance_inflation=lag_one_inflation(residual),
        n_samples=rows.size,
        n_blocks=n_blocks,
        first_sample=int(rows[0]),
        last_sample=int(rows[-1]),
        strain_rate=rates[0],
        strain_rate_slowest=rates[1],
        strain_rate_fastest=rates[2],
        tension_rate=rates[3],
        waiting_time=np.nan if waiting_time is None else waiting_time,
        waiting=waiting,
        reference_length=length,
        reference_tension=np.nan if reference_tension is None else reference_tension,
        polynomial_coefficient=polynomial,
        polynomial_deviation=deviation,
    )
    return replace(
        pull,
        notes=_remarks(
            misfit=pull.misfit_share,
            fall=fall,
            rates=rates,
            reference_length=length,
            reference_strain=begins,
            waiting=waiting_time is not None or bool(waiting),
            cut=stop - start < 2,
        ),
    )
