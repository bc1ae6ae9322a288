r"""Slow pulls: load-strain curve, its cubic, and quasi-static spring constant.

**Cubic of strain against tension: its slope, range of rise, and the cubic of K_0**:

.. math:: \varepsilon = A + B T + C T^2 + D T^3, \qquad K_0 = 1 / (B + 2 C T + 3 D T^2)

As printed, and as computed.  [1]_ prints two forms that do not quite agree: cubics of strain
(Tables 8 and 9) and cubics of K_0 (Tables 6 and 7).  Both forms are given here beside K_0, which
is the local slope of the readings: a cubic spline with as many pieces as the readings need.  The
cubic of K_0 is fitted to that slope, and its greatest deviation is given.  Table 6 heads its form
A + B T^2 + C T^3 + D T^4, times 1e-4; the form that gives its numbers is Table 7's
A + B T + C T^2 + D T^3, times 1e4.  Signs and powers are lost in Tables 6, 7 and 9 (nylon double
braid D 3.26 for 32.6, nylon plaited C, polyester C), and polyester plaited line has no K_0 row.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4.2 ("a slow uni-directional loading");
   sec. 4.4.3; sec. 4.4.2, 4.4.3, Tables 6-9; sec. 4.4.2, 4.4.3, Tables 6-9, App. D; sec. 4.4.2,
   4.4.3 and App. D.
.. [2] C. de Boor, "A Practical Guide to Splines," Springer, 1978, ch. XII (the slope of a cubic
   spline is off by the third power of the distance of its knots).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.record.arrays import as_positive, as_same_shape
from reduction.record.errors import DataError, FitError
from reduction.record.measurement import Bools, Floats, Integers
from reduction.record.notes import Note, note
from reduction.record.settings import Control, Waveform
from reduction.stages.cycles.cycle_product import Loops
from reduction.stages.cycles.reading_noise import reading_noise
from reduction.stages.moduli.least_squares import lag_one_inflation
from reduction.stages.moduli.local_regression import sums_by_cell
from reduction.stages.three_parameter_line.line_product import SlowPull
from reduction.stages.three_parameter_line.loop_midline import (
    is_bent,
    spring_of_wave,
)

# a rise out of slack exceeds this many standard deviations of a reading
_NOISE_FACTOR = 6.0

# and this fraction of the whole rise: the foot of the curve, where the line straightens
_FOOT = 0.005

# last fraction of the rise before the peak, which shows the trend of the pull, and the ratio to
# that trend above which further strain counts as gained in a hold
_APPROACH, _HELD = 0.05, 1.5

_FEWEST_SAMPLES = 8


def _greatest_fall(tension: ArrayLike) -> float:
    """Largest fall of a series below what it had reached before.

    Examples
    --------
    >>> _greatest_fall([0.0, 3.0, 2.5, 4.0])
    0.5
    """
    series = np.asarray(tension, dtype=np.float64)
    return float((np.maximum.accumulate(series) - series).max())


_MEANS_OF_PULL = 1000


def _fall_beyond_noise(tension: Floats) -> float:
    """Largest fall on the way up that noise does not make.

    Notes
    -----
    The greatest and the least of thousands of readings are further apart than noise parts a few:
    means of readings are compared, so short that a fall within one has no effect on the curve.

    Examples
    --------
    >>> noise = np.random.default_rng(0).normal(0, 1.0, 50_000)
    >>> _fall_beyond_noise(np.linspace(0.0, 70.0, 50_000) + noise)
    0.0
    """
    means = _means_of_pull(tension)
    return max(_greatest_fall(means) - _NOISE_FACTOR * reading_noise(means), 0.0)


def _means_of_pull(series: Floats) -> Floats:
    """Means of consecutive readings."""
    together = max(series.size // _MEANS_OF_PULL, 1)
    whole = series.size // together * together
    return np.asarray(series[:whole].reshape(-1, together).mean(axis=1))


_STANDS = 0.1  # of the rise of tension in a ramp

_CREEPS = 0.5  # of the rise of strain in a ramp: slower than a line that is pulled through its foot

_MEANS_OF_STAND = 5


def _gain_in_holds(tension: Floats, strain: Floats) -> float:
    """Strain gained on the way up while the tension stands and the strain slows down.

    Examples
    --------
    Ten ramps with holds between them, in each of which a linear line creeps by a hundredth:

    >>> load = np.repeat(np.arange(10.0), 200) + np.tile(np.minimum(np.arange(200) / 100, 1), 10)
    >>> hold = np.repeat(np.arange(10), 200) + np.tile(np.clip(np.arange(200) / 100 - 1, 0, 1), 10)
    >>> print(round(_gain_in_holds(load, 0.01 * load + 1e-4 * hold), 4))
    0.001
    """
    load, stretch = (_means_of_pull(one) for one in (tension, strain))
    # so many that a ramp is far above the noise
    step = (load[-1] - load[0]) / load.size
    n = max(_MEANS_OF_STAND, int(2 * _NOISE_FACTOR * reading_noise(load) / step))
    if load.size <= _FEWEST_SAMPLES * n:
        return 0.0
    rise, gain = (one[n:] - one[:-n] for one in (load, stretch))
    fast = (np.quantile(one, 0.95) for one in (rise, gain))
    stands = (rise < _STANDS * next(fast)) & (gain < _CREEPS * next(fast))
    return float(np.maximum(gain[stands], 0.0).sum() / n)


def _find_loading(
    tension: ArrayLike, strain: ArrayLike, *, reference_tension: float | None = None
) -> Integers:
    """Samples of the loading part of a slow pull.

    Notes
    -----
    Loading starts at the last crossing of the start tension before the peak, so that bedding-in
    cycles that return to it are left out.  Without a reference tension the start is the lowest
    reading before the peak plus six standard deviations of a reading, or plus half a percent of
    the rise where that is more.  Samples after the peak (unloading, failure) are left out;
    [1]_, sec. 4.4.2 pulls to failure.  The greatest reading of a hold at the peak lies anywhere in
    it: where strain grows while tension stands, the pull ends where it reaches the hold.

    Examples
    --------
    >>> tension = np.concatenate([np.zeros(5), np.arange(1, 21.0), [3.0, 0.0]])
    >>> print(_find_loading(tension, tension / 100)[[0, -1]])
    [ 4 24]
    """
    load, stretch = as_same_shape(tension=tension, strain=strain)
    rows = np.flatnonzero(np.isfinite(load) & np.isfinite(stretch))
    if load.ndim != 1 or rows.size < _FEWEST_SAMPLES:
        raise DataError(
            "a slow pull has too few readings of tension and strain",
            found=str(rows.size),
            needed=f"{_FEWEST_SAMPLES} or more",
        )
    load = load[rows]
    peak = int(np.argmax(load))
    lowest = float(load[: peak + 1].min())
    rise = float(load[peak]) - lowest
    start = reference_tension
    if start is None:
        start = lowest + max(_NOISE_FACTOR * reading_noise(load[: peak + 1]), _FOOT * rise)
    if not load[peak] > start:
        raise DataError(
            "tension does not rise in the slow pull",
            found=f"a peak of {load[peak]:.4g} N",
            needed=f"more than the {start:.4g} N from which it counts",
        )
    below = np.flatnonzero(load[:peak] <= start)
    first = int(below[-1]) if below.size else 0
    if peak + 1 - first < _FEWEST_SAMPLES:
        raise DataError(
            "the loading part of the slow pull has too few readings",
            found=f"{peak + 1 - first} from {load[first]:.4g} N to the peak of {load[peak]:.4g} N",
            needed=f"{_FEWEST_SAMPLES} or more",
        )
    near = load[peak] - max(_NOISE_FACTOR * reading_noise(load[: peak + 1]), _FOOT * rise)
    rising = first + int(np.argmax(load[first : peak + 1] >= near))
    before = first + int(np.argmax(load[first : peak + 1] >= near - _APPROACH * rise))
    gained = stretch[rows[[before, rising, peak]]]
    as_before = (load[peak] - load[rising]) * (gained[1] - gained[0])
    at_hold = (gained[2] - gained[1]) * (load[rising] - load[before])
    if at_hold > _HELD * as_before and rising + 1 - first >= _FEWEST_SAMPLES:
        return rows[first : rising + 1]
    return rows[first : peak + 1]


BREAK_SHARES = (0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5)
"""Fractions of the rated break strength at which the strain of a pull is given. [1]"""

_GRID_STEPS = 200  # straight lines between them err by a thousandth of the strain of a foot


def tension_grid(pulls: Sequence[SlowPull | None]) -> Floats:
    """One grid of tension for the slow pulls of a test.

    Parameters
    ----------
    pulls : sequence of SlowPull or None
        Slow pulls; None for a specimen without one. [SI]

    Returns
    -------
    tension : ndarray, shape (201,)
        From the lowest to the highest tension of use of any pull. [N]

    Raises
    ------
    DataError
        If there is no pull.

    Notes
    -----
    [1]_, sec. 4.4.3 draws each pull over its own range; one grid makes pulls of a test comparable.

    Examples
    --------
    >>> from reduction.stages.three_parameter_line.slow_pull import fit_pull
    >>> load = np.linspace(0, 2000.0, 400)
    >>> pull = fit_pull(np.arange(400.0), load / 4e4, load)
    >>> grid = tension_grid([pull, None])
    >>> print(grid.size, grid[0] == pull.tension_low, grid[-1] == pull.tension_high)
    201 True True
    """
    given = [one for one in pulls if one is not None]
    if not given:
        raise DataError("there is no slow pull to lay out", found="none", needed="one or more")
    low, high = min(one.tension_low for one in given), max(one.tension_high for one in given)
    return np.linspace(low, high, _GRID_STEPS + 1)


N_BLOCKS = 300
"""Steps of tension between the ends of a pull. [1]."""

# degree of the polynomial by which the cubic is judged, and the number of blocks it needs
_DEGREE_BEYOND = 6

_FEWEST_BLOCKS_BEYOND = 20

# fraction of a residual that a fit leaves free, below which it shows nothing of its noise
_LEAST_FREE = 0.1

# times the mean square due to noise; three more terms exceed it once in thirty
_BEYOND_NOISE = 3.0


@dataclass(frozen=True)
class _PullBlocks:
    """Means over equal steps of tension, shape (n_blocks,) each.

    ``powers`` (n_blocks, 7) are means of the powers of u, the tension scaled to -1 to 1;
    ``scaled`` (n_samples,) is u, and ``first`` the reading with which each block begins.
    """

    time: Floats
    strain: Floats
    tension: Floats
    powers: Floats
    scaled: Floats
    first: Integers


def _block_means(time: Floats, strain: Floats, tension: Floats) -> _PullBlocks:
    """Means over equal steps of the greatest tension so far.

    Notes
    -----
    A hold, or a slow stretch, falls into one block and counts once, however many readings
    it has.  The cubic is fitted to means of powers, so averaging over blocks does not bias it.

    Examples
    --------
    >>> load = np.linspace(0.0, 2000.0, 400)
    >>> blocks = _block_means(np.arange(400.0), 1e-4 * load, load)
    >>> print(blocks.time.size, blocks.tension[[0, -1]].round(1))
    300 [   2.5 1997.5]
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
    return _PullBlocks(mean(time), mean(strain), mean(tension), powers, scaled, first)


def _covariance_of_blocks(powers: Floats, residual: Floats) -> Floats:
    """Covariance of least squares with unequal and correlated errors.

    Notes
    -----
    Noise of tension changes strain by itself over K_0, more at the soft end of the curve.

    Examples
    --------
    The variance of a mean of 100 independent readings.

    >>> residual = np.random.default_rng(0).normal(0, 1.0, 100)
    >>> print(_covariance_of_blocks(np.ones((100, 1)), residual).round(2))
    [[0.01]]
    """
    inverse = np.linalg.inv(powers.T @ powers)
    leverage = ((powers @ inverse) * powers).sum(axis=1)
    own = powers * (residual / np.maximum(1 - leverage, _LEAST_FREE))[:, None]
    covariance: Floats = lag_one_inflation(residual) * inverse @ (own.T @ own) @ inverse
    return covariance


def _misfit_of_cubic(blocks: _PullBlocks, cubic: Floats, covariance: Floats) -> float:
    """Root mean square misfit of a cubic to strain.

    Notes
    -----
    Judged by a polynomial of sixth degree, less the difference between the two due to noise alone.

    Examples
    --------
    A cubic through a cubic has no misfit.

    >>> load = np.linspace(0.0, 2000.0, 400)
    >>> blocks = _block_means(np.arange(400.0), 1e-4 * load, load)
    >>> cubic = np.linalg.lstsq(blocks.powers[:, :4], blocks.strain)[0]
    >>> round(_misfit_of_cubic(blocks, cubic, np.zeros((4, 4))), 9)
    0.0
    """
    if blocks.strain.size < _FEWEST_BLOCKS_BEYOND:
        return 0.0
    beyond, *_ = np.linalg.lstsq(blocks.powers, blocks.strain, rcond=None)
    spread = _covariance_of_blocks(blocks.powers, blocks.strain - blocks.powers @ beyond)
    # a polynomial of high degree is poorly determined at its ends
    rows = np.linspace(-0.9, 0.9, 61)[:, None] ** np.arange(_DEGREE_BEYOND + 1)
    apart = rows @ beyond - rows[:, :4] @ cubic
    known = ((rows[:, :4] @ covariance) * rows[:, :4]).sum(axis=1)
    noise = np.mean(np.maximum(((rows @ spread) * rows).sum(axis=1) - known, 0))
    square = np.mean(apart**2)
    return float(np.sqrt(square - noise)) if square > _BEYOND_NOISE * noise else 0.0


_FINEST = 64  # greatest number of pieces of a curve

_BLOCKS_OF_PIECE = 4  # at least, in each piece

_SPLIT = 4.0  # times the mean square due to noise: such a piece is halved

_DEGREE = 3

_BLOCK_SAMPLES = 1 << 17  # whose rows are held in memory at once

# of the difference to a curve of pieces twice as long: the error of a smooth one is a seventh of it
# (for errors e' and e = 8 e' the difference is 7 e'), near a kink it is more
_SHARE_OF_COARSER = 1 / 3


def _spline(n_coefficients: int) -> scipy.interpolate.BSpline:
    """Every cubic B-spline over -1 to 1 on equal knots, as one function of u."""
    knots = np.linspace(-1, 1, n_coefficients - _DEGREE + 1)
    ends = np.ones(_DEGREE)
    return scipy.interpolate.BSpline(
        np.concatenate([-ends, knots, ends]), np.eye(n_coefficients), _DEGREE
    )


def _rows_of_strain(scaled: Floats, n_coefficients: int) -> Floats:
    """Rows whose product with the coefficients is strain at u."""
    rows: Floats = _spline(n_coefficients)(scaled)
    return rows


def _rows_of_slope(scaled: Floats, n_coefficients: int) -> Floats:
    """Rows whose product with the coefficients is the slope of strain in u."""
    rows: Floats = _spline(n_coefficients).derivative()(scaled)
    return rows


@dataclass(frozen=True)
class _PulledCurve:
    """Cubic spline through the blocks, with its misfit and that of its slope at `MISFIT_AT`."""

    coefficient: Floats
    covariance: Floats
    misfit: Floats
    slope_misfit: Floats


MISFIT_AT = np.linspace(-1, 1, 81)
"""Points at which the misfit of a curve and of its slope is given, in u."""


@cache
def _to_finest() -> tuple[Floats, Floats]:
    """Points, one per finest spline, and the matrix from values there to coefficients."""
    knots = _spline(_FINEST + _DEGREE).t[1:-1]
    along = np.convolve(knots, np.full(_DEGREE, 1 / _DEGREE), "valid")  # means of knots
    inverse = np.linalg.inv(_rows_of_strain(along, _FINEST + _DEGREE))
    return along, inverse.astype(np.float64)


@dataclass(frozen=True)
class _Pieces:
    """Least squares of one choice of pieces: ``coefficient`` = ``inverse`` @ strain.

    ``insertion`` gives the coefficients on the finest knots, where every choice is exact.
    """

    insertion: Floats
    rows: Floats
    inverse: Floats

    @property
    def to_finest(self) -> Floats:
        """Matrix from strain of the blocks to coefficients on the finest knots."""
        return np.asarray(self.insertion @ self.inverse)


def _rows_of_finest(blocks: _PullBlocks) -> Floats:
    """Mean of every spline of the finest knots over the readings of each block."""
    n_blocks, n_samples = blocks.strain.size, blocks.scaled.size
    count = np.diff(blocks.first, append=n_samples)
    cell = np.repeat(np.arange(n_blocks), count)
    size = _FINEST + _DEGREE
    total = np.zeros((n_blocks, size))
    for start in range(0, n_samples, _BLOCK_SAMPLES):
        part = slice(start, start + _BLOCK_SAMPLES)
        basis = scipy.interpolate.BSpline.design_matrix(
            np.clip(blocks.scaled[part], -1, 1), _spline(size).t, _DEGREE
        )
        total += (sums_by_cell(cell[part], n_blocks) @ basis).toarray()
    return np.asarray(total / count[:, None])


def _fitted(finest: Floats, breaks: Integers) -> _Pieces:
    """Fit of pieces between breaks, which are counted in units of the finest pieces."""
    places = 2 * breaks / _FINEST - 1
    knots = np.concatenate([[-1.0] * _DEGREE, places, [1.0] * _DEGREE])
    coarse = scipy.interpolate.BSpline(knots, np.eye(knots.size - _DEGREE - 1), _DEGREE)
    along, of_finest = _to_finest()
    insertion = of_finest @ coarse(along)
    rows = finest @ insertion
    return _Pieces(insertion, rows, np.linalg.pinv(rows).astype(np.float64))


def _halved(breaks: Integers, number: Floats) -> tuple[Integers, Bools]:
    """Breaks after halving all pieces that have enough blocks, and a mask of these pieces."""
    middle = (breaks[:-1] + breaks[1:]) / 2
    edges = np.append(np.column_stack([breaks[:-1], middle]).ravel(), breaks[-1])
    fewest = np.histogram(number, edges)[0].reshape(-1, 2).min(axis=1)
    may = (np.diff(breaks) > 1) & (fewest >= _BLOCKS_OF_PIECE)
    return np.sort(np.concatenate([breaks, middle[may].astype(np.int64)])), may


def _curve_of_pull(blocks: _PullBlocks) -> _PulledCurve:
    r"""Cubic spline of strain over tension, from which the slope at a tension is read.

    Notes
    -----
    Its pieces are short where the curve bends, at the foot and near kinks, and long elsewhere.
    A piece is halved as long as that, or quarters of it, change the curve on it by more than noise
    does.  Then all are halved once more, so that their misfit is small beside the effect of noise.
    The misfit of strain and slope is a fraction of the change by that last step: its square, less
    the difference of the two curves due to noise, averaged over one piece to both sides.  The
    coefficients are on the finest knots, on which each choice of pieces is exact.

    Examples
    --------
    Strain as the root of tension has the slope :math:`1 / (2 \sqrt{T})`, which no cubic follows:

    >>> load = np.linspace(100.0, 2000.0, 4000)
    >>> blocks = _block_means(np.arange(4000.0), 1e-3 * np.sqrt(load), load)
    >>> found = _curve_of_pull(blocks)
    >>> middle = _rows_of_slope(np.array(0.0), found.coefficient.size) @ found.coefficient / 950
    >>> print((middle * 2 * np.sqrt(1050.0) / 1e-3).round(4))
    1.0
    """
    strain, finest = blocks.strain, _rows_of_finest(blocks)
    # position of each block, in units of the finest pieces
    number = np.clip((blocks.powers[:, 1] + 1) / 2, 0, 1) * _FINEST
    breaks = np.array([0, _FINEST])
    fit = _fitted(finest, breaks)
    # noise is the residual of the finest fit that the blocks allow
    shortest, may = _halved(breaks, number)
    while may.any():
        shortest, may = _halved(shortest, number)
    own, inflation = _own_noise(_fitted(finest, shortest), strain)
    least = (np.finfo(np.float64).eps * float(np.ptp(strain))) ** 2
    while True:
        halves, may = _halved(breaks, number)
        if not may.any():
            finer = fit
            break
        finer = _fitted(finest, halves)
        inside = np.clip(np.searchsorted(breaks, number, side="right") - 1, 0, breaks.size - 2)
        split = np.zeros(breaks.size - 1, dtype=bool)
        # a knot in the middle of an S changes nothing, four pieces do
        for one in (finer, _fitted(finest, _halved(halves, number)[0])):
            apart = one.rows @ one.inverse - fit.rows @ fit.inverse
            noise = inflation * (apart**2 @ own**2) + least
            told, by_noise = (
                np.bincount(inside, each, breaks.size - 1)
                for each in ((apart @ strain) ** 2, noise)
            )
            split |= may & (told > _SPLIT * by_noise)
        if not split.any():
            break
        middle = (breaks[:-1] + breaks[1:]) // 2
        breaks = np.sort(np.concatenate([breaks, middle[split]]))
        fit = _fitted(finest, breaks)
    # one step finer than noise requires, so that the misfit of pieces is small beside noise
    residual = strain - finer.rows @ (finer.inverse @ strain)
    covariance = finer.insertion @ _covariance_of_blocks(finer.rows, residual) @ finer.insertion.T
    # rows of the strain, then of its slope
    rows_at = np.concatenate(
        [one(MISFIT_AT, _FINEST + _DEGREE) for one in (_rows_of_strain, _rows_of_slope)]
    )
    apart = rows_at @ (finer.to_finest - fit.to_finest)
    at = (MISFIT_AT + 1) / 2 * _FINEST
    here = np.clip(np.searchsorted(breaks, at, side="right") - 1, 0, breaks.size - 2)
    if not may.all() and breaks.size > 2:
        # pieces whose blocks do not allow halving are compared with ones twice as long
        width = np.diff(breaks)
        odd = np.array([
            0 < one < _FINEST and one % (2 * width[max(place - 1, 0)]) != 0
            for place, one in enumerate(breaks.tolist())
        ])  # fmt: skip
        is_short = np.tile(~may[here], 2)
        coarser = _fitted(finest, breaks[~odd])
        apart[is_short] = rows_at[is_short] @ (coarser.to_finest - fit.to_finest)
    apart *= _SHARE_OF_COARSER
    missed = (apart @ strain) ** 2 - inflation * (apart**2 @ own**2)
    near = np.abs(at[:, None] - at) <= np.diff(breaks)[here][:, None]
    mean = missed.reshape(2, -1) @ near.T / near.sum(axis=1)
    return _PulledCurve(finer.to_finest @ strain, covariance, *np.sqrt(np.maximum(mean, 0)))


def _own_noise(fit: _Pieces, strain: Floats) -> tuple[Floats, float]:
    """Noise of each block, and the factor by which its correlation increases a variance."""
    residual = strain - fit.rows @ (fit.inverse @ strain)
    leverage = np.einsum("ij,ji->i", fit.rows, fit.inverse)
    return residual / np.maximum(1 - leverage, _LEAST_FREE), lag_one_inflation(residual)


def _rates_of_pull(blocks: _PullBlocks) -> tuple[float, float, float, float]:
    """Mean, slowest and fastest strain rate, and the mean rate of tension.

    Examples
    --------
    >>> load = np.linspace(0.0, 2000.0, 401)
    >>> rates = _rates_of_pull(_block_means(np.arange(401.0), 1e-4 * load, load))
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


def slope_of_cubic(tension: ArrayLike, coefficient: ArrayLike) -> Floats:
    r"""Quasi-static spring constant of a load-strain cubic.

    .. math:: K_0 = 1 / (B + 2 C T + 3 D T^2)

    Parameters
    ----------
    tension : array_like, shape (...)
        :math:`T`. [N]
    coefficient : array_like, shape (4,)
        A, B, C, D of strain = A + B T + C T^2 + D T^3. [N-k]

    Returns
    -------
    quasi_static_spring_constant : ndarray, shape (...)
        NaN where the slope of strain is not positive. [N]

    Notes
    -----
    Source: [1]_, sec. 4.4.2, and Tables 8 and 9 for the cubic.

    Examples
    --------
    Nylon double braid, 1/2 in, Table 8 of [1]_, at the mean loads of Table 1, in 1e4 lb:

    >>> slope = slope_of_cubic([768.0, 1344.0, 1920.0], [-4.13e-4, 1.389e-4, -3.906e-8, 3.795e-12])
    >>> print((slope / 1e4).round(3))
    [1.168 1.836 3.238]
    """
    load, terms = np.asarray(tension, dtype=np.float64), np.asarray(coefficient, dtype=np.float64)
    return _inverse_of_positive(terms[1] + load * (2 * terms[2] + load * 3 * terms[3]))


def _inverse_of_positive(slope: Floats) -> Floats:
    """Reciprocal of a slope, NaN where it is not positive."""
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse: Floats = np.where(slope > 0, 1 / slope, np.nan)
    return inverse


def _rising_range(curve: _PulledCurve) -> tuple[float, float]:
    """Longest part of -1 to 1 in which strain does not clearly fall with tension.

    Notes
    -----
    A slope that is not positive has no quasi-static spring constant ([1]_, sec. 4.4.2).  A slope
    that is negative only by noise, where a line is stiff, does not end the range.

    Examples
    --------
    >>> load = np.linspace(0.0, 2000.0, 401)
    >>> turning = np.where(load < 1500.0, load, 3000.0 - load)
    >>> blocks = _block_means(np.arange(401.0), 1e-5 * turning, load)
    >>> print(np.round(_rising_range(_curve_of_pull(blocks)), 1))
    [-1.   0.5]
    """
    along = np.linspace(-1, 1, _STEPS_OF_FORM)
    rows = _rows_of_slope(along, curve.coefficient.size)
    clearly = _CLEARLY * _spread(rows, curve.covariance)
    rises = np.append(rows @ curve.coefficient > -clearly, [False])
    ends = np.flatnonzero(np.diff(np.append([0], rises)))
    if not ends.size:
        return (0.0, 0.0)
    runs = ends.reshape(-1, 2)
    first, last = runs[np.argmax(np.diff(runs, axis=1))] - [0, 1]
    return float(along[first]), float(along[last])


def _printed_form(tension: Floats, constant: Floats, *, centre: float, half: float) -> Floats:
    r"""K_0 as a cubic of tension, by least squares to K_0 at some tensions.

    .. math:: K_0 \approx A + B T + C T^2 + D T^3

    Notes
    -----
    The form of Table 7 of [1]_.  Relative deviations of K_0 have equal weight, since it spans a
    factor of several over the range.

    Examples
    --------
    >>> load = np.linspace(0.0, 2000.0, 201)
    >>> print(_printed_form(load, np.full(201, 4e4), centre=1e3, half=1e3).round(3) + 0.0)
    [40000. 0. 0. 0.]
    """
    # an end of the range where the slope is barely positive would dominate the fit
    kept = np.isfinite(constant)
    exact = constant[kept]
    powers = ((tension[kept] - centre) / half)[:, None] ** np.arange(4)
    fit, *_ = np.linalg.lstsq(powers / exact[:, None], np.ones(exact.size), rcond=None)
    series = np.polynomial.Polynomial(fit, domain=[centre - half, centre + half])
    printed = np.zeros(4)
    converted = series.convert().coef
    printed[: converted.size] = converted
    return printed


# rms misfit over the strain of the pull, above which the curve is not a cubic
_MISFIT_NOTED = 0.01

_FEWEST_BLOCKS = 8

_FALL_NOTED = 0.02

_FALL_REFUSED = 0.25

# a range of use below this fraction of the readings is not a load-strain curve
_SHORTEST_RANGE = 0.5

_UNEVEN_RATE = 2.0

# strain at the reference tension, as a fraction of that of the pull, that counts as nonzero
_OFF_ZERO = 0.05

# tensions to which the printed form of K_0 is fitted
_STEPS_OF_FORM = 201

_CLEARLY = 3.0  # standard uncertainties by which a slope must be below zero to be negative


def _remarks(
    *,
    fall: float,
    held: float,
    rates: tuple[float, ...],
    reference_length: float,
    reference_strain: float,
    waiting: bool,
    cut: bool,
    misfit: float,
) -> tuple[Note, ...]:
    found = (
        (misfit > _MISFIT_NOTED, note("pull-misfit", misfit=misfit)),
        (fall > _FALL_NOTED, note("pull-falls", fall=fall)),
        (held > _FALL_NOTED, note("pull-creeps", share=held)),
        (
            rates[2] > _UNEVEN_RATE * rates[1],
            note("pull-rate-uneven", low=rates[1], high=rates[2]),
        ),
        (not np.isfinite(reference_length), note("pull-length-not-stated")),
        (not np.isnan(reference_strain), note("pull-off-zero", strain=reference_strain)),
        (not waiting, note("pull-waiting-not-stated")),
        (cut, note("pull-cut-at-turn")),
    )
    return tuple(one for is_so, one in found if is_so)


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
        Tension of one specimen; NaN where missing. [N]
    specimen : str, optional
        Name, kept with the result.
    reference_tension : float, optional
        Tension at which the reference length was read and the pull begins; by default the first
        rise out of slack. [N]
    reference_length : float, optional
        Length at which strain is zero. [m]
    waiting_time : float, optional
        Time since the last dynamic test. [s]
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
        If fewer than eight steps of tension have a reading, or the slope of the spline is
        not positive over half of the range.

    Notes
    -----
    Source: [1]_, sec. 4.4.2 and 4.4.3.  Readings are first averaged over 1/300 of the
    tension range each.  The uncertainty follows from the residuals of those means, widened by
    the correlation with their neighbours: averaging over thousands of readings would hide the
    misfit of a curve.  A curve that is not a cubic has another slope than its cubic.  Both K_0, as
    slope, and strain are therefore those of a cubic spline, each with the misfit of the spline
    there.  The standard uncertainty holds these and no calibration.

    App. D of [1]_ finds 4.22, 6.33 and 7.71e4 lb for K_0 of one line: at 0.071 per minute
    a day after the dynamic test, at 0.23 per minute a day after, and at 0.23 per minute at
    once, a factor of 1.5 to 1.8.  For this reason the rate and the waiting time are stored with
    the number, which enters K_1 and tau in full.

    Examples
    --------
    >>> load = np.linspace(0, 2000.0, 400)
    >>> stretch = 1.389e-4 * load - 3.906e-8 * load**2 + 3.795e-12 * load**3
    >>> pull = fit_pull(np.arange(400.0), stretch, load, waiting_time=86400.0)
    >>> print((pull.strain_coefficient[1:] * [1e4, 1e8, 1e12]).round(3))
    [ 1.389 -3.906  3.795]
    """
    clock, stretch, load = as_same_shape(time=time, strain=strain, tension=tension)
    rows: Integers = _find_loading(load, stretch, reference_tension=reference_tension)
    rows = rows[np.isfinite(clock[rows])]
    clock, stretch, load = clock[rows], stretch[rows], load[rows]
    low, high = float(load[0]), float(load.max())
    blocks = _block_means(clock, stretch, load)
    fall = _fall_beyond_noise(load) / (high - low)
    if fall > _FALL_REFUSED:
        raise DataError(
            f"tension falls by {100 * fall:.0f} % of its rise on the way to the peak",
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
    covariance = _covariance_of_blocks(powers, residual)
    strain_misfit = _misfit_of_cubic(blocks, coefficient, covariance)
    curve = _curve_of_pull(blocks)
    start, stop = _rising_range(curve)
    if stop - start < 2 * _SHORTEST_RANGE:
        raise FitError(
            "strain does not rise with tension in the slow pull",
            found=f"a positive slope over {100 * ((stop - start) / 2):.0f} % of the range of"
            " tension",
            needed=f"{100 * _SHORTEST_RANGE:.0f} % or more",
            hint="Check the signs of strain and tension.",
        )
    centre, half = (low + high) / 2, (high - low) / 2
    is_cut = stop - start < 2
    # the pull begins where its readings stay above a level; noise biases this choice of readings
    chosen = _NOISE_FACTOR * reading_noise(load) / half
    if chosen > _FOOT:
        start = max(start, min(chosen + 2 * _BEYOND - 1, stop))
    use = (centre + half * start, centre + half * stop)
    along = np.linspace(start, stop, _STEPS_OF_FORM)
    slope = _rows_of_slope(along, curve.coefficient.size) @ curve.coefficient
    polynomial = _printed_form(
        centre + half * along, half * _inverse_of_positive(slope), centre=centre, half=half
    )
    rates = _rates_of_pull(blocks)
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
        curve_coefficient=curve.coefficient,
        curve_covariance=curve.covariance,
        curve_misfit=curve.misfit,
        slope_misfit=curve.slope_misfit,
        residual_deviation=float(np.sqrt((residual**2).sum() / (n_blocks - 4))),
        n_samples=rows.size,
        n_blocks=n_blocks,
        strain_rate=rates[0],
        strain_rate_slowest=rates[1],
        strain_rate_fastest=rates[2],
        tension_rate=rates[3],
        waiting_time=np.nan if waiting_time is None else waiting_time,
        waiting=waiting,
        reference_length=length,
        reference_tension=np.nan if reference_tension is None else reference_tension,
        polynomial_coefficient=polynomial,
    )
    return replace(
        pull,
        notes=_remarks(
            misfit=pull.misfit_share,
            fall=fall,
            held=_gain_in_holds(load, stretch) / float(blocks.strain[-1] - blocks.strain[0]),
            rates=rates,
            reference_length=length,
            reference_strain=begins,
            waiting=waiting_time is not None or bool(waiting),
            cut=is_cut,
        ),
    )


# a pull that ends at a level reads slightly above or below it
_BEYOND = 0.01

# a drift of the mean tension over a run that changes K_0 by more than this is noted
_DRIFT_NOTED = 0.05


def _scaled(pull: SlowPull, tension: ArrayLike) -> tuple[Floats, Bools]:
    """Tension as the fit variable u, NaN outside the range of use."""
    load = np.asarray(tension, dtype=np.float64)
    margin = _BEYOND * 2 * pull.tension_half_range
    inside = (load >= pull.tension_low - margin) & (load <= pull.tension_high + margin)
    scaled: Floats = np.where(
        inside, (load - pull.tension_centre) / pull.tension_half_range, np.nan
    )
    return scaled, inside


def _spread(rows: Floats, covariance: Floats) -> Floats:
    """Standard uncertainty of rows times coefficients, which are on the last axis of the rows."""
    spread: Floats = np.sqrt(np.einsum("...i,ij,...j->...", rows, covariance, rows))
    return spread


def quasi_static_spring_constant(pull: SlowPull, tension: ArrayLike) -> tuple[Floats, Floats]:
    r"""Slope of the load-strain curve at a tension.

    .. math:: K_0 = \frac{1}{d\varepsilon / dT}, \qquad u(K_0) = K_0^2 \, u(d\varepsilon / dT)

    Parameters
    ----------
    pull : SlowPull
        From `reduction.stages.three_parameter_line.slow_pull.fit_pull`.
    tension : array_like, shape (...)
        Mean tension of interest. [N]

    Returns
    -------
    quasi_static_spring_constant, standard_uncertainty : ndarray, shape (...)
        NaN outside the range of use, extended by a hundredth of the range, and
        where the slope is not positive. [N]

    Notes
    -----
    Source: [1]_, sec. 4.4.2: it "must be calculated at the mean load level of interest and
    used for small perturbations around that mean load".  The slope is that of the cubic spline
    through the readings; its uncertainty holds that of the fit and the misfit there.

    Examples
    --------
    >>> from reduction.stages.three_parameter_line.slow_pull import fit_pull
    >>> load = np.linspace(0, 2000.0, 400)
    >>> stretch = 1.389e-4 * load - 3.906e-8 * load**2 + 3.795e-12 * load**3
    >>> pull = fit_pull(np.arange(400.0), stretch, load)
    >>> print(quasi_static_spring_constant(pull, [768.0, 2400.0])[0].round(-1))
    [11680. nan]
    """
    scaled, inside = _scaled(pull, tension)
    slope, spread = slope_of_pull(pull, np.where(inside, scaled, 0.0))
    inverse = _inverse_of_positive(np.where(inside, slope, np.nan))
    return inverse, inverse**2 * spread


def slope_of_pull(pull: SlowPull, scaled: ArrayLike) -> tuple[Floats, Floats]:
    """Slope of strain over tension by the curve of a pull at u, with its uncertainty. [N-1]."""
    at = np.asarray(scaled, dtype=np.float64)
    rows = rows_of_slope(pull, at)
    missed = np.interp(at, MISFIT_AT, pull.slope_misfit) / pull.tension_half_range
    return rows @ pull.curve_coefficient, np.hypot(_spread(rows, pull.curve_covariance), missed)


def rows_of_slope(pull: SlowPull, scaled: Floats) -> Floats:
    """Rows whose product with the coefficients of a curve is its slope over tension. [N-1]."""
    rows: Floats = _rows_of_slope(scaled, pull.curve_coefficient.size) / pull.tension_half_range
    return rows


def strain_at_tension(pull: SlowPull, tension: ArrayLike) -> tuple[Floats, Floats]:
    """Strain of the slow pull at a tension.

    Parameters
    ----------
    pull : SlowPull
        From `reduction.stages.three_parameter_line.slow_pull.fit_pull`.
    tension : array_like, shape (...)
        Tension. [N]

    Returns
    -------
    strain, standard_uncertainty : ndarray, shape (...)
        From the spline, relative to the reference length; NaN outside the range of use. [1]

    Notes
    -----
    Source: [1]_, sec. 4.4.3.

    Examples
    --------
    >>> from reduction.stages.three_parameter_line.slow_pull import fit_pull
    >>> load = np.linspace(0, 2000.0, 400)
    >>> stretch = 1.389e-4 * load - 3.906e-8 * load**2 + 3.795e-12 * load**3
    >>> print(strain_at_tension(fit_pull(np.arange(400.0), stretch, load), 1920.0)[0].round(4))
    0.1496
    """
    scaled, inside = _scaled(pull, tension)
    at = np.where(inside, scaled, 0.0)
    rows = _rows_of_strain(at, pull.curve_coefficient.size)
    missed = np.interp(at, MISFIT_AT, pull.curve_misfit)
    spread = np.hypot(_spread(rows, pull.curve_covariance), missed)
    unknown = np.where(inside, 0.0, np.nan)
    return rows @ pull.curve_coefficient + unknown, spread + unknown


def strain_at_break_share(
    pull: SlowPull, share: ArrayLike, *, rated_break_strength: float
) -> tuple[Floats, Floats]:
    """Strain of the slow pull at a fraction of the rated break strength.

    Parameters
    ----------
    pull : SlowPull
        From `reduction.stages.three_parameter_line.slow_pull.fit_pull`.
    share : array_like, shape (...)
        0.3 for 30 %RBS. [1]
    rated_break_strength : float
        As stated for the specimen. [N]

    Returns
    -------
    strain, standard_uncertainty : ndarray, shape (...)
        NaN outside the range of use. [1]

    Raises
    ------
    DataError
        If the break strength is not positive.

    Notes
    -----
    Source: [1]_, sec. 4.4.3 ("at 30% of rated breaking strength, nylon double-braided line
    and plaited line stretches approximately 15% and 25%").

    Examples
    --------
    >>> from reduction.stages.three_parameter_line.slow_pull import fit_pull
    >>> load = np.linspace(0, 2000.0, 400)
    >>> stretch = -4.13e-4 + 1.389e-4 * load - 3.906e-8 * load**2 + 3.795e-12 * load**3
    >>> pull = fit_pull(np.arange(400.0), stretch, load)
    >>> print((100 * strain_at_break_share(pull, 0.3, rated_break_strength=6400.0)[0]).round(1))
    14.9
    """
    strength = as_positive("rated break strength", rated_break_strength)
    return strain_at_tension(pull, np.asarray(share, dtype=np.float64) * strength)


def spring_constant_ratio(
    pull: SlowPull, other: SlowPull, tension: ArrayLike
) -> tuple[Floats, Floats]:
    """Quasi-static spring constant of one pull over that of another, at a tension.

    Parameters
    ----------
    pull, other : SlowPull
        For instance pulls of one line at two rates, or after two waiting times.
    tension : array_like, shape (...)
        Tension. [N]

    Returns
    -------
    ratio, standard_uncertainty : ndarray, shape (...)
        NaN where either pull has no K_0. [1]

    Notes
    -----
    Source: [1]_, Table D-1, where it is 1.50 for the rate, 1.22 for the waiting time and
    1.83 for both.

    Examples
    --------
    >>> from reduction.stages.three_parameter_line.slow_pull import fit_pull
    >>> load = np.linspace(0, 2000.0, 400)
    >>> slow, fast = (fit_pull(np.arange(400.0), load / k, load) for k in (4.22e4, 6.33e4))
    >>> print(spring_constant_ratio(fast, slow, 1000.0)[0].round(2))
    1.5
    """
    one, u_one = quasi_static_spring_constant(pull, tension)
    two, u_two = quasi_static_spring_constant(other, tension)
    ratio = one / two
    return ratio, ratio * np.hypot(u_one / one, u_two / two)


_EVEN = 1.5  # fastest over slowest rate of strain of a pull at constant rate of strain

_STEPS_OF_PULL = 400


_SHORT = 10.0  # relaxation times of the loops: a shorter pull is not slow in comparison


def is_short_pull(pull: SlowPull, relaxation_time: float) -> bool:
    """Whether a pull takes less than ten relaxation times of the loops.

    Examples
    --------
    >>> load = np.linspace(0, 2000.0, 400)
    >>> pull = fit_pull(np.arange(400.0), load / 4e4, load)
    >>> is_short_pull(pull, 5.0), is_short_pull(pull, 50.0)
    (False, True)
    """
    duration = (pull.tension_high - pull.tension_low) / pull.tension_rate
    return bool(duration < _SHORT * relaxation_time)


def error_of_pull_rate(
    pull: SlowPull, tension: float, *, spring_constant: float, relaxation_time: float
) -> float:
    r"""Error of K_0 from a pull that is not slow compared with the relaxation of the line. [N].

    The spring and dashpot found from the loops add a tension q to the pull that obeys
    :math:`\dot q + q / \tau = K_1 \dot\varepsilon`.  K_0 is the slope of the pull without q.
    The relative difference of the two slopes, as a root mean square along the pull, is the error at
    any tension, since its sign changes on the way.  Zero where the loops have no K_1 and tau.

    Notes
    -----
    No correction is made: the tau of real lines grows with the period ([1]_, sec. 4.4.2, 4.4.3 and
    App. D), and loops do not show it at the rate of a pull.  The error is an uncertainty of a pull
    that is short in comparison (`is_short_pull`); K_0 of longer ones is that at their stated rate,
    which a note says.  K_1 and tau themselves contain the error that they are to estimate.

    Examples
    --------
    At constant strain rate v a backbone T = 2e4 e + 1e5 e^2 is read K_1 tau v too high:

    >>> time = np.linspace(0, 400.0, 801)
    >>> strain = 2.5e-4 * time
    >>> load = 2e4 * strain + 1e5 * strain**2 + 4e4 * 5 * 2.5e-4 * (1 - np.exp(-time / 5))
    >>> pull = fit_pull(time, strain, load)
    >>> wrong = error_of_pull_rate(pull, 1000.0, spring_constant=4e4, relaxation_time=5.0)
    >>> constant = (2e4**2 + 4e5 * 950) ** 0.5  # at 1000 N, of which 50 N are the dashpot's
    >>> shift = (2e4**2 + 4e5 * 1000) ** 0.5 - constant
    >>> print(bool(0.5 * shift < wrong < 4 * shift), round(wrong / constant, 2))
    True 0.01
    """
    if not spring_constant > 0 or not relaxation_time > 0:
        return 0.0
    load = np.linspace(pull.tension_low, pull.tension_high, _STEPS_OF_PULL)
    size = pull.curve_coefficient.size
    strain = _rows_of_strain(_scaled(pull, load)[0], size) @ pull.curve_coefficient
    constant = float(quasi_static_spring_constant(pull, tension)[0])
    if not np.isfinite(constant) or not np.isfinite(strain).all():
        return 0.0
    is_even = pull.strain_rate_fastest <= _EVEN * pull.strain_rate_slowest
    step = np.diff(strain) / pull.strain_rate if is_even else np.diff(load) / pull.tension_rate
    left = np.exp(-step / relaxation_time)
    gained = spring_constant * relaxation_time * np.diff(strain) / step * (1 - left)
    pulled = np.zeros(load.size)
    for row in range(1, load.size):
        pulled[row] = left[row - 1] * pulled[row - 1] + gained[row - 1]
    alone = np.maximum.accumulate(load - pulled)
    # at the ends of the range a slope has one neighbour only, and the difference is not read there
    rows = slice(load.size // 10, -load.size // 10)
    at = load[rows][load[rows] < alone[-1]]
    of_pull = quasi_static_spring_constant(pull, at)[0]
    of_rest = np.interp(at, alone, np.gradient(alone, strain))
    return constant * float(np.sqrt(np.mean((of_rest / of_pull - 1) ** 2))) if at.size else constant


def _spring_of_loops(
    pull: SlowPull,
    mean: float,
    above: float,
    loops: Loops,
    row: int,
    break_in_cycles: int,
    waveform: Waveform,
    control: Control,
) -> tuple[float, float]:
    """K_0 of the pull over the bent loops of a run, and its uncertainty. [N]."""
    slope, spread = quasi_static_spring_constant(pull, mean - above)
    load, stretch, energy = (
        one[row, break_in_cycles:]
        for one in (loops.tension_amplitude, loops.strain_amplitude, loops.hysteresis_energy)
    )
    sine = energy / (np.pi * load * stretch)
    half = float(np.nanmean(stretch * np.sqrt(np.maximum(1 - sine**2, 0.0))))
    constant = spring_of_wave(
        lambda tension: quasi_static_spring_constant(pull, tension)[0], mean, above, half,
        waveform=waveform, control=control,
    )  # fmt: skip
    return constant, constant / float(slope) * float(spread)


def quasi_static_of_run(
    loops: Loops,
    pulls: Sequence[SlowPull | None],
    *,
    break_in_cycles: int = 0,
    above_midline: Sequence[tuple[float, float]] = (),
    waveform: Waveform = "sinusoidal",
    control: Control = "load",
) -> tuple[Floats, Floats, tuple[Note, ...]]:
    """K_0 of each specimen at the mean tension of a run.

    Parameters
    ----------
    loops : Loops
        Table of loops of the run.
    pulls : sequence of SlowPull or None, length n_specimens
        None where a specimen has no slow pull.
    break_in_cycles : int, optional
        Cycles left out of the mean at the start. [1]
    above_midline : sequence of tuple of float, length n_specimens, optional
        Mean tension of the loops less that of their midline at the mean strain, and its
        standard uncertainty, from `reduction.stages.three_parameter_line.loop_midline`. [N]
    waveform : {"sinusoidal", "triangular", "other"}, optional
        Waveform of the driven channel. [-]
    control : {"load", "position"}, optional
        Driven channel. [-]

    Returns
    -------
    quasi_static_spring_constant, standard_uncertainty : ndarray, shape (n_specimens,)
        NaN without a pull, or with a mean tension outside its range of use. [N]
    notes : tuple of Note
        Reason why a specimen has none, and a drift of the mean tension that matters.

    Raises
    ------
    DataError
        If there is not one entry a specimen, or the break-in leaves no cycle.

    Notes
    -----
    Source: [1]_, sec. 4.4.2.  A run has one K_0, so that all its cycles share its error.

    [1]_, sec. 4.4.2, 4.4.3 and App. D refers to small cycles.  The slow spring of a large cycle is
    curved, and its slope over the cycle differs from that of the pull at the mean tension: 1 % in
    K_0, at a twentieth of a hertz, is 8 % in K_1 and 10 % in tau.  Where the loops themselves are
    curved by more than the uncertainty of K_0, K_0 is the chord of the pull about the tension of
    their midline (`spring_of_wave`), or its slope there where the pull does not reach the ends;
    for straight loops it is the slope at the mean.

    Examples
    --------
    >>> from reduction.stages.three_parameter_line.slow_pull import fit_pull
    >>> one = {name: np.full((1, 2), 1000.0) for name in Loops.__dataclass_fields__}
    >>> load = np.linspace(0, 2000.0, 400)
    >>> pull = fit_pull(np.arange(400.0), load / 4e4, load)
    >>> constant, _, _ = quasi_static_of_run(Loops(**one), [pull])
    >>> print(constant.round())
    [40000.]
    """
    n_specimens, n_cycles = loops.mean_tension.shape
    if len(pulls) != n_specimens or not 0 <= break_in_cycles < n_cycles:
        raise DataError(
            "slow pulls do not fit the run",
            found=f"{len(pulls)} pulls and a break-in of {break_in_cycles} cycles",
            needed=f"{n_specimens} pulls, None where there is none, and a break-in below "
            f"{n_cycles} cycles",
        )
    constant, uncertainty = np.full((2, n_specimens), np.nan)
    notes: list[Note] = []
    for row, pull in enumerate(pulls):
        load = loops.mean_tension[row, break_in_cycles:]
        load = load[np.isfinite(load)]
        if pull is None or load.size == 0:
            lacking = "slow pull" if pull is None else "mean tension"
            notes.append(note("no-slow-pull", place=row + 1, lacking=lacking))
            continue
        mean = float(load.mean())
        constant[row], uncertainty[row] = quasi_static_spring_constant(pull, mean)
        if np.isnan(constant[row]):
            notes.append(
                note(
                    "mean-tension-outside-pull",
                    mean=mean,
                    low=pull.tension_low,
                    high=pull.tension_high,
                    pull=pull.specimen or row + 1,
                )
            )
            continue
        if len(above_midline):
            above, u_above = above_midline[row]
            bent, u_bent = _spring_of_loops(
                pull, mean, above, loops, row, break_in_cycles, waveform, control
            )
            effect = bent / float(constant[row]) - 1
            amplitude = float(np.nanmean(loops.tension_amplitude[row, break_in_cycles:]))
            is_clear = abs(effect) * constant[row] > uncertainty[row]
            if is_clear and is_bent(above, u_above, amplitude):
                constant[row], uncertainty[row] = bent, u_bent
                notes.append(note("bent-loops", mean=mean, at=mean - above, effect=effect))
        ends, _ = quasi_static_spring_constant(pull, [float(load[0]), float(load[-1])])
        change = float(ends[1] / ends[0]) - 1
        if abs(change) > _DRIFT_NOTED:
            notes.append(
                note(
                    "mean-tension-drifts",
                    first=float(load[0]),
                    last=float(load[-1]),
                    effect=change,
                    mean=mean,
                )
            )
    return constant, uncertainty, tuple(notes)
