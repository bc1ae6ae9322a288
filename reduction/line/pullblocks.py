r"""Means of a slow pull over equal steps of tension, and what a polynomial of them is worth.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4.2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.errors import DataError
from reduction.moduli.separable import lag_one_inflation
from reduction.record import Floats

N_BLOCKS = 100
"""Steps of tension between the ends of a pull. [1]."""

# degree that a load-strain curve may ask for beyond the cubic, and blocks that it needs
_DEGREE_BEYOND = 6
_FEWEST_BLOCKS_BEYOND = 20
# times the square that noise makes, which three more terms pass once in thirty
_BEYOND_NOISE = 3.0


@dataclass(frozen=True)
class PullBlocks:
    """Means over equal steps of tension, shape (n_blocks,) each.

    ``powers`` (n_blocks, 7) are means of the powers of u, the tension scaled to -1 to 1.
    """

    time: Floats
    strain: Floats
    tension: Floats
    powers: Floats


def block_means(time: Floats, strain: Floats, tension: Floats) -> PullBlocks:
    """Means over equal steps of the greatest tension so far.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time. [s]
    strain : ndarray, shape (n_samples,)
        [1]
    tension : ndarray, shape (n_samples,)
        Of the loading part; it rises as a whole. [N]

    Returns
    -------
    blocks : PullBlocks
        Steps without a reading are left out.

    Raises
    ------
    IndexError
        If there is no sample.

    Notes
    -----
    A hold, or a slow stretch, falls into one block and counts once, however many readings
    it has; and the cubic is fitted to means of powers, so that blocks cost it nothing.

    Examples
    --------
    >>> load = np.linspace(0.0, 2000.0, 400)
    >>> blocks = block_means(np.arange(400.0), 1e-4 * load, load)
    >>> print(blocks.time.size, blocks.tension[[0, -1]].round(1))
    100 [   7.5 1992.5]
    """
    reached = np.maximum.accumulate(tension)
    low, high = float(tension[0]), float(reached[-1])
    share = np.clip((reached - low) / (high - low), 0, 1)
    number = np.minimum((share * N_BLOCKS).astype(np.intp), N_BLOCKS - 1)
    first = np.flatnonzero(np.diff(number, prepend=-1))
    count = np.diff(first, append=number.size)

    def mean(values: Floats) -> Floats:
        total: Floats = np.add.reduceat(values, first) / count
        return total

    scaled = 2 * (tension - low) / (high - low) - 1
    powers = np.empty((first.size, _DEGREE_BEYOND + 1))
    current = np.ones_like(scaled)
    for power in range(_DEGREE_BEYOND + 1):
        powers[:, power] = mean(current)
        current *= scaled
    return PullBlocks(mean(time), mean(strain), mean(tension), powers)


def covariance_of_blocks(powers: Floats, residual: Floats) -> Floats:
    """Covariance of least squares with unequal and correlated errors.

    Parameters
    ----------
    powers : ndarray, shape (n_blocks, n_coefficients)
        Columns of the fit. [1]
    residual : ndarray, shape (n_blocks,)
        What the fit leaves. [1]

    Returns
    -------
    covariance : ndarray, shape (n_coefficients, n_coefficients)
        Sandwich, leverage taken off, widened by the likeness of neighbours. [1]

    Raises
    ------
    LinAlgError
        If the columns are not independent.

    Notes
    -----
    Noise of tension moves strain by itself over K_0, more at the soft end of the curve.

    Examples
    --------
    The variance of a mean of 100 independent readings.

    >>> residual = np.random.default_rng(0).normal(0, 1.0, 100)
    >>> print(covariance_of_blocks(np.ones((100, 1)), residual).round(2))
    [[0.01]]
    """
    inverse = np.linalg.inv(powers.T @ powers)
    leverage = ((powers @ inverse) * powers).sum(axis=1)
    own = powers * (residual / np.maximum(1 - leverage, 0.1))[:, None]
    covariance: Floats = lag_one_inflation(residual) * inverse @ (own.T @ own) @ inverse
    return covariance


def misfit_of_cubic(blocks: PullBlocks, cubic: Floats, covariance: Floats) -> tuple[float, float]:
    """Root mean square of what a cubic misses of strain and of its slope in u.

    Parameters
    ----------
    blocks : PullBlocks
        To which it was fitted.
    cubic : ndarray, shape (4,)
        Coefficients of 1, u, u^2, u^3. [1]
    covariance : ndarray, shape (4, 4)
        From `covariance_of_blocks`. [1]

    Returns
    -------
    strain_misfit, slope_misfit : float
        0 where noise explains it, or there are too few blocks to tell. [1]

    Raises
    ------
    ValueError
        If the shapes do not fit together.

    Notes
    -----
    Judged by a polynomial of sixth degree, less what noise alone makes the two differ by.

    Examples
    --------
    A cubic through a cubic misses nothing.

    >>> load = np.linspace(0.0, 2000.0, 400)
    >>> blocks = block_means(np.arange(400.0), 1e-4 * load, load)
    >>> cubic = np.linalg.lstsq(blocks.powers[:, :4], blocks.strain)[0]
    >>> strain_misfit, _ = misfit_of_cubic(blocks, cubic, np.zeros((4, 4)))
    >>> round(strain_misfit, 9)
    0.0
    """
    if blocks.strain.size < _FEWEST_BLOCKS_BEYOND:
        return 0.0, 0.0
    beyond, *_ = np.linalg.lstsq(blocks.powers, blocks.strain, rcond=None)
    spread = covariance_of_blocks(blocks.powers, blocks.strain - blocks.powers @ beyond)
    degree = np.arange(_DEGREE_BEYOND + 1)
    # a polynomial of high degree is loose at its ends
    at = np.linspace(-0.9, 0.9, 61)[:, None]
    missed = []
    for rows in (at**degree, degree * at ** np.maximum(degree - 1, 0)):
        apart = rows @ beyond - rows[:, :4] @ cubic
        known = ((rows[:, :4] @ covariance) * rows[:, :4]).sum(axis=1)
        noise = np.mean(np.maximum(((rows @ spread) * rows).sum(axis=1) - known, 0))
        square = np.mean(apart**2)
        missed.append(float(np.sqrt(square - noise)) if square > _BEYOND_NOISE * noise else 0.0)
    return missed[0], missed[1]


def rates_of_pull(blocks: PullBlocks) -> tuple[float, float, float, float]:
    """Mean, slowest and fastest strain rate, and the mean rate of tension.

    Parameters
    ----------
    blocks : PullBlocks
        Of the loading part.

    Returns
    -------
    mean, slowest, fastest : float
        Of strain, over all and over quarters of the tension. [s-1]
    tension_rate : float
        Mean. [N s-1]

    Raises
    ------
    DataError
        If time does not rise.

    Examples
    --------
    >>> load = np.linspace(0.0, 2000.0, 401)
    >>> rates = rates_of_pull(block_means(np.arange(401.0), 1e-4 * load, load))
    >>> print(np.round(rates, 5))
    [5.e-04 5.e-04 5.e-04 5.e+00]
    """
    duration = float(blocks.time[-1] - blocks.time[0])
    if not duration > 0:
        raise DataError(
            "time does not rise over the slow pull", found=f"{duration:g} s", needed="above 0"
        )
    stretch = float(blocks.strain[-1] - blocks.strain[0])
    load = blocks.tension
    at = np.clip(np.searchsorted(load, np.linspace(load[0], load[-1], 5)), 0, load.size - 1)
    ends = np.unique(at)
    with np.errstate(divide="ignore"):
        local = np.diff(blocks.strain[ends]) / np.diff(blocks.time[ends])
    return (
        stretch / duration,
        float(local.min()),
        float(local.max()),
        float(load[-1] - load[0]) / duration,
    )
