"""The measured curve of a test on an axis of strain, with its uncertainty.

References
----------
.. [4] V. A. Marchenko and L. A. Pastur, "Distribution of eigenvalues for some sets of random
   matrices," Math. USSR Sbornik, vol. 1, 1967 (the largest variance that noise reaches).
.. [5] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty
   in measurement," F.1.2.3 (correlation by common influence quantities).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ndtri, stdtrit

from reduction.record.arrays import as_same_shape, as_spread
from reduction.record.contributions import Component
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays, require_shapes
from reduction.record.notes import Note, note

Loading = Literal["static", "dynamic"]

CurveName = Literal["ascending", "descending", "midline"]

BRANCHES: tuple[CurveName, CurveName] = ("ascending", "descending")

CURVES: tuple[CurveName, ...] = (*BRANCHES, "midline")

NODES_A_BIN = 40
"""Number of steps between two bin centres at which a prediction is evaluated."""


@dataclass(frozen=True)
@read_only_arrays
class _Reading:
    """How a test reads a curve: weights of the strains between the bin centres.

    Samples lie at some strains of a bin, and their mean is moved to its centre; at a kink this is
    not the tension at the centre.  A prediction that is read in the same way has the same kink.
    """

    node: Floats
    weight: Floats

    def of(self, curve: Floats) -> Floats:
        """A curve at the nodes, shape (..., n_node), as read by the test, (..., n_strain)."""
        windows = np.lib.stride_tricks.sliding_window_view(curve, self.weight.shape[1], axis=-1)
        return np.asarray(np.einsum("...bm,bm->...b", windows[..., ::NODES_A_BIN, :], self.weight))


@dataclass(frozen=True)
@read_only_arrays
class MeasuredCurve:
    """Tension of a test on one axis of strain, cycle by cycle and over the cycles.

    NaN where a branch was not visited.  The *judged* curve, used for the comparison, is the midline
    of the two branches, or the ascending branch of a test that has no other.

    Parameters
    ----------
    strain : ndarray, shape (n_strain,)
        Bin centres, equally spaced, of the whole relaxed length. [1]
    tension : ndarray, shape (n_cycle, 2, n_strain)
        Tension of each cycle, ascending before descending, at the bin centre. [N]
    count : ndarray of int, shape (n_cycle, 2, n_strain)
        Number of samples in the bin. [1]
    cycle_number : ndarray of int, shape (n_cycle,)
        First cycle of each row; a row is one cycle, except in a long test, whose notes say so.
    branch_tension, branch_standard_uncertainty : ndarray, shape (2, n_strain)
        Mean over the cycles after break-in, and its standard uncertainty, type A alone. [N]
    midline_tension, midline_standard_uncertainty : ndarray, shape (n_strain,)
        Half way between the branches, and its standard uncertainty, type A alone. [N]
    scatter_contribution : ndarray, shape (n_component, n_strain)
        Part of the type A standard uncertainty of the judged curve that is correlated over strain,
        as signed contributions: whole cycles lie high or low. [N]
    component : tuple of Component, length n_component
        Errors that all cycles share.
    contribution : ndarray, shape (n_component, 3, n_strain)
        Signed contribution of each to both branches and the midline, for one standard uncertainty;
        zero where there is no curve. [N]
    strain_error : ndarray, shape (n_component, n_strain)
        Error of the strain of the judged curve in that contribution: the part that moves the curve
        along its axis. [1]
    loading : {"static", "dynamic"}
        Kind of loading.
    reading : Reading
        How the judged curve was read from the samples.
    end_strain, end_tension, end_standard_uncertainty : float
        End of the judged curve beyond its last bin centre: mean of the samples between, and its
        type A uncertainty; NaN where there are none. [1], [N], [N]
    notes : tuple of Note
        Remarks for the reader.
    """

    strain: Floats
    tension: Floats
    count: Integers
    cycle_number: Integers
    branch_tension: Floats
    branch_standard_uncertainty: Floats
    midline_tension: Floats
    midline_standard_uncertainty: Floats
    scatter_contribution: Floats
    component: tuple[Component, ...]
    contribution: Floats
    strain_error: Floats
    loading: Loading
    reading: _Reading
    end_strain: float = float("nan")
    end_tension: float = float("nan")
    end_standard_uncertainty: float = float("nan")
    notes: tuple[Note, ...] = ()

    def __post_init__(self) -> None:
        """Check shapes once and make the arrays read-only."""
        n_strain, n_cycle = self.strain.size, self.cycle_number.size
        shapes = {
            "tension": (n_cycle, 2, n_strain),
            "count": (n_cycle, 2, n_strain),
            "branch_tension": (2, n_strain),
            "branch_standard_uncertainty": (2, n_strain),
            "midline_tension": (n_strain,),
            "midline_standard_uncertainty": (n_strain,),
            "scatter_contribution": (self.scatter_contribution.shape[0], n_strain),
            "contribution": (len(self.component), len(CURVES), n_strain),
            "strain_error": (len(self.component), n_strain),
        }
        require_shapes(self, shapes, of="measured curve")

    @property
    def judged(self) -> CurveName:
        """The curve with which the prediction is compared."""
        return "midline" if np.isfinite(self.midline_tension).any() else "ascending"

    def tension_of(self, curve: CurveName) -> Floats:
        """Mean over the cycles, shape (n_strain,). [N]."""
        if curve == "midline":
            return self.midline_tension
        return np.asarray(self.branch_tension[BRANCHES.index(curve)])

    def standard_uncertainty_of(self, curve: CurveName) -> Floats:
        """Type A uncertainty of that mean, shape (n_strain,). [N]."""
        if curve == "midline":
            return self.midline_standard_uncertainty
        return np.asarray(self.branch_standard_uncertainty[BRANCHES.index(curve)])

    def contribution_of(self, curve: CurveName) -> Floats:
        """Signed contributions of the shared errors to that mean, (n_component, n_strain). [N]."""
        return np.asarray(self.contribution[:, CURVES.index(curve)])

    def curves(self) -> tuple[CurveName, ...]:
        """Curves with any measured values."""
        return tuple(name for name in CURVES if np.isfinite(self.tension_of(name)).any())

    def independent_uncertainty(self) -> Floats:
        """Type A of the judged curve without the shared part, shape (n_strain,). [N]."""
        whole = self.standard_uncertainty_of(self.judged) ** 2
        common = np.sum(self.scatter_contribution**2, axis=0)
        return np.asarray(np.sqrt(np.maximum(whole - common, 0.0)))


_LEAST_STEP = 0.01

_SAMPLES_A_BIN = 1.5

_MOST_ROWS = 1000


@dataclass(frozen=True)
@read_only_arrays
class _BranchSamples:
    """Finite samples that belong to a branch."""

    strain: Floats
    tension: Floats
    row: Integers
    cycle_number: Integers
    n_break_in: int
    notes: tuple[Note, ...]

    def least_step(self) -> float:
        """Width of a bin that holds four samples or more, 1, 2 or 5 times a power of ten. [1]."""
        along = np.abs(np.diff(self.strain))[np.diff(self.row) == 0]
        least = _SAMPLES_A_BIN * float(np.median(along)) if along.size else 0.0
        if least <= _LEAST_STEP:
            return _LEAST_STEP
        power = 10.0 ** np.floor(np.log10(least))
        return float(power * next(k for k in (1, 2, 5, 10) if k * power >= least * (1 - 1e-9)))


def _select_samples(
    strain: ArrayLike,
    tension: ArrayLike,
    *,
    cycle_number: ArrayLike | None,
    branch: ArrayLike | None,
    break_in_cycles: int,
) -> _BranchSamples:
    """Finite samples that belong to a branch, each with its cycle and branch.

    Examples
    --------
    >>> pull = _select_samples(
    ...     [0.0, 0.1, 0.2, 0.2], [0.0, 5.0, 9.0, 8.0],
    ...     cycle_number=None, branch=None, break_in_cycles=0,
    ... )
    >>> print(pull.tension)
    [0. 5. 9.]
    """
    strains, tensions = as_same_shape(strain=strain, tension=tension)
    if (cycle_number is None) != (branch is None):
        raise SettingsError(
            "cycle_number and branch go together",
            found="one of them",
            needed="both, or neither for a slow pull",
        )
    is_finite = np.isfinite(strains) & np.isfinite(tensions)
    if cycle_number is None or branch is None:
        number, side = _pull(np.where(is_finite, tensions, -np.inf), break_in_cycles)
    else:
        number, side = np.asarray(cycle_number), np.asarray(branch)
        if not number.shape == side.shape == strains.shape:
            raise DataError(
                "cycle_number and branch do not pair up with the samples",
                found=f"{number.shape} and {side.shape}",
                needed=str(strains.shape),
            )
    use = is_finite & (number > 0) & ((side == 1) | (side == 2))
    if not use.any():
        raise DataError(
            "no sample belongs to a branch",
            found=f"{strains.size} samples, {int(is_finite.sum())} with strain and tension",
            needed="cycles with branches, or a slow pull",
        )
    n_cycles = int(number[use].max())
    if not 0 <= break_in_cycles < n_cycles:
        raise DataError(
            "no cycle is left after break-in",
            found=f"{n_cycles} cycles, {break_in_cycles} of them break-in",
            needed="at least one cycle more than break_in_cycles",
        )
    # a long test has samples of some cycles only: these are counted one by one
    there = np.flatnonzero(np.bincount(number[(number > 0) & (number <= n_cycles)]))
    pooled = -(-there.size // _MOST_ROWS)
    k = np.searchsorted(there, number[use]) // pooled
    n_break_in = int(np.searchsorted(there, break_in_cycles, side="right"))
    return _BranchSamples(
        strain=strains[use],
        tension=tensions[use],
        row=2 * k + side[use] - 1,
        cycle_number=there[::pooled],
        n_break_in=min(-(-n_break_in // pooled), (there.size - 1) // pooled),
        notes=() if pooled == 1 else (note("cycles-pooled", n_cycles=pooled),),
    )


def _pull(tension: Floats, break_in_cycles: int) -> tuple[Integers, Integers]:
    if break_in_cycles:
        raise DataError("a slow pull has no break-in", found=f"{break_in_cycles} cycles")
    ascending = np.zeros(tension.size, dtype=np.int64)
    if tension.size:
        ascending[: tension.size - int(np.argmax(tension[::-1]))] = 1
    return ascending, ascending


# a centre farther than this beyond the last sample would be extrapolated
_BEYOND = 0.05

# share of the range of the samples: the slope between bins differs from that within the last bin
_OUTSIDE = 0.05


@dataclass(frozen=True)
@read_only_arrays
class _Cells:
    """Moments of the samples of each row and bin; arrays have the shape (n_rows, n_bins).

    ``offset`` and ``spread`` are mean and variance of strain from the bin centre, in bins, and
    ``nearest`` and ``furthest`` its least and greatest; ``tension`` the mean [N], ``lowest`` and
    ``highest`` the least and greatest; ``residual`` the sum of squares about the straight line in
    the bin [N2], with ``freedom`` its degrees of freedom.  NaN and zero where there is no sample.
    """

    count: Floats
    offset: Floats
    spread: Floats
    nearest: Floats
    furthest: Floats
    tension: Floats
    lowest: Floats
    highest: Floats
    residual: Floats
    freedom: Floats


def _fill_cells(
    strain: Floats, tension: Floats, *, row: Integers, n_rows: int, step: float
) -> tuple[_Cells, Floats]:
    """Moments of the samples in each bin, and the centres of the bins.

    Examples
    --------
    >>> cells, centre = _fill_cells(
    ...     np.array([0.11, 0.12]), np.array([5.0, 7.0]),
    ...     row=np.array([0, 0]), n_rows=1, step=0.1,
    ... )
    >>> print(centre, cells.count, cells.offset, cells.tension)
    [0.1] [[2.]] [[0.15]] [[6.]]
    """
    place = strain / step
    number = np.rint(place).astype(np.int64)
    inside = number >= 0
    if not inside.all():
        place, number, row, tension = place[inside], number[inside], row[inside], tension[inside]
    if not number.size:
        raise DataError("no sample of a branch has a strain", needed="strains of zero or more")
    first, n_bins = int(number.min()), int(number.max() - number.min()) + 1
    key = row * n_bins + (number - first)
    x = place - number
    reference = float(tension.mean())  # squares keep their digits
    y = tension - reference

    def sums(weights: Floats | None) -> Floats:
        found = np.bincount(key, weights=weights, minlength=n_rows * n_bins)
        return found.reshape(n_rows, n_bins).astype(np.float64)

    count = sums(None)
    n = np.where(count > 0, count, np.nan)
    offset, level = sums(x) / n, sums(y) / n
    spread = np.maximum(sums(x * x) / n - offset**2, 0.0)
    across = sums(x * y) / n - offset * level
    scatter = np.maximum(sums(y * y) / n - level**2, 0.0)
    has_slope = spread > 1e-12
    along = np.where(has_slope, across**2 / np.where(has_slope, spread, 1.0), 0.0)
    freedom = np.where(has_slope, np.maximum(count - 2, 0.0), 0.0)
    residual = np.where(freedom > 0, np.maximum(scatter - along, 0.0) * count, 0.0)
    centre: Floats = np.arange(first, first + n_bins, dtype=np.float64) * step

    def ends(values: Floats) -> tuple[Floats, Floats]:
        least, most = np.full((2, n_rows * n_bins), np.nan)
        np.fmin.at(least, key, values)
        np.fmax.at(most, key, values)
        return least.reshape(n_rows, n_bins), most.reshape(n_rows, n_bins)

    nearest, furthest = ends(x)
    lowest, highest = ends(y + reference)
    cells = _Cells(
        count=count,
        offset=offset,
        spread=spread,
        nearest=nearest,
        furthest=furthest,
        tension=level + reference,
        lowest=lowest,
        highest=highest,
        residual=residual,
        freedom=freedom,
    )
    return cells, centre


def _centre_weights(cells: _Cells) -> Floats:
    """Weights of the means of a bin and its two neighbours in the tension at its centre.

    Notes
    -----
    The means are moved to the centre by slope and curvature, both of which are differences of
    means: the tension at the centre is linear in them.

    Examples
    --------
    Means of three samples that lie at the centres: the middle one is used unchanged.

    >>> cells, _ = _fill_cells(
    ...     np.array([0.1, 0.2, 0.3]), np.zeros(3), row=np.zeros(3, int), n_rows=1, step=0.1
    ... )
    >>> print(np.abs(_centre_weights(cells)[:, 0, 1].round(9)))
    [0. 1. 0.]
    """
    level, offset = cells.tension, cells.offset
    beyond = np.full((level.shape[0], 1), np.nan)
    gap = np.diff(np.arange(level.shape[1]) + offset, axis=1)
    before, after = np.hstack([beyond, gap]), np.hstack([gap, beyond])
    has_before, has_after = np.isfinite(before), np.isfinite(after)
    is_middle = has_before & has_after
    both = before + after
    bend = (offset**2 - cells.spread) / 2
    # of the increase from the bin below to this one, and from this one to the bin above
    of_before = np.where(is_middle, -(offset * after + 2 * bend) / both, -offset)
    of_after = np.where(is_middle, -(offset * before - 2 * bend) / both, -offset)
    of_before = np.where(has_before, of_before / before, 0.0)
    of_after = np.where(has_after & (is_middle | ~has_before), of_after / after, 0.0)
    weight = np.stack([-of_before, 1 + of_before - of_after, of_after])
    is_alone = ~has_before & ~has_after
    lowest = np.where(has_before, -np.inf, cells.nearest)
    highest = np.where(has_after, np.inf, cells.furthest)
    is_beyond = (lowest > _BEYOND) | (highest < -_BEYOND)
    is_read = np.isfinite(level) & ~(is_alone & (np.abs(offset) >= _BEYOND)) & ~is_beyond
    return np.asarray(np.where(is_read, weight, np.nan))


def _tension_at_centres(cells: _Cells) -> Floats:
    """Tension at the bin centres, with slope and curvature from the neighbouring bins.

    Notes
    -----
    In bins that are too wide for the curve the correction could move a mean beyond all samples;
    no test measured that, so the value is limited to their range.

    Examples
    --------
    Samples of a parabola, moved to the centres 0.1, 0.2 and 0.3.

    >>> place = np.linspace(0.0501, 0.3499, 300)
    >>> cells, centre = _fill_cells(place, place**2, row=np.zeros(300, int), n_rows=1, step=0.1)
    >>> print(_tension_at_centres(cells)[0, 1].round(6))
    0.04
    """
    below, own, above = _centre_weights(cells)
    level = cells.tension
    padded = np.pad(np.nan_to_num(level), ((0, 0), (1, 1)))
    moved = below * padded[:, :-2] + own * padded[:, 1:-1] + above * padded[:, 2:]
    low, high = (np.pad(one, ((0, 0), (1, 1)), constant_values=np.nan)
                 for one in (cells.lowest, cells.highest))  # fmt: skip
    least = np.fmin(np.fmin(low[:, :-2], low[:, 1:-1]), low[:, 2:])
    most = np.fmax(np.fmax(high[:, :-2], high[:, 1:-1]), high[:, 2:])
    slack = _OUTSIDE * (most - least)
    return np.asarray(np.clip(moved, least - slack, most + slack))


def _reading_of(
    strain: Floats, *, row: Integers, cells: _Cells, row_weight: Floats, centre: Floats, step: float
) -> _Reading:
    """How a mean of rows was read from the samples, as weights of strains between the centres.

    Examples
    --------
    A straight line is read unchanged.

    >>> place, row = np.linspace(0.0, 0.5, 600), np.zeros(600, int)
    >>> cells, centre = _fill_cells(place, place, row=row, n_rows=1, step=0.1)
    >>> reading = _reading_of(
    ...     place, row=row, cells=cells, row_weight=np.ones((1, 6)), centre=centre, step=0.1
    ... )
    >>> print(reading.of(reading.node).round(9)[1:-1])
    [0.1 0.2 0.3 0.4]
    """
    n_bins, wide = centre.size, 3 * NODES_A_BIN + 1
    number = np.rint(strain / step).astype(np.int64)
    inside = number >= 0
    number, row = number[inside], row[inside]
    of_node = (strain[inside] / step - number + 0.5) * NODES_A_BIN
    place = number - round(float(centre[0]) / step)
    left = np.clip(np.floor(of_node).astype(np.int64), 0, NODES_A_BIN - 1)
    part = of_node - left
    weight = np.zeros(n_bins * wide)
    for side, of_rows in enumerate(_centre_weights(cells)):
        # the bin to whose tension the bin of the sample contributes
        taker = place + 1 - side
        known = (taker >= 0) & (taker < n_bins)
        rows, takers, its = row[known], taker[known], place[known]
        each = np.where(row_weight > 0, np.nan_to_num(of_rows) * row_weight, 0.0)[rows, takers]
        each /= cells.count[rows, its]
        at = takers * wide + side * NODES_A_BIN + left[known]
        for one, share in ((at, 1 - part[known]), (at + 1, part[known])):
            weight += np.bincount(one, weights=each * share, minlength=weight.size)
    node = centre[0] + step * (np.arange((n_bins + 2) * NODES_A_BIN + 1) / NODES_A_BIN - 1.5)
    return _Reading(node, weight.reshape(n_bins, wide))


_POOLED_FREEDOM = 10.0  # weight of the scatter of the whole branch relative to that of one bin

_LEAST_SHARE = 0.5  # of the cycles have to visit a bin

_CUBIC = 4  # coefficients

_ROUNDING = 1e-12


def _bin_noise(cells: _Cells, tension: Floats) -> Floats:
    """Variance of the tension of each bin from noise alone.

    The greater of two: the scatter of samples about the line in their bin, with the weights that
    move means to the centre (at the end of a branch half a bin, with its own slope), and the
    variance from third differences between bins, which includes noise slower than the samples.

    Notes
    -----
    The third difference of white noise of variance v has the variance 20 v; its median is
    used, so that a kink has no effect.

    Examples
    --------
    Without noise the variance is zero.

    >>> from reduction.prediction.measured_curve import _fill_cells, _tension_at_centres
    >>> place = np.linspace(0, 1, 1001)
    >>> cells, _ = _fill_cells(place, 3 * place, row=np.zeros(1001, int), n_rows=1, step=0.1)
    >>> print(bool(np.all(_bin_noise(cells, _tension_at_centres(cells)) < 1e-9)))
    True
    """
    freedom = cells.freedom.sum()
    inside = cells.residual.sum() / freedom if freedom > 0 else 0.0
    third = np.diff(tension, n=3, axis=1)
    found = np.abs(third[np.isfinite(third)])
    between = (np.median(found) / 0.6745) ** 2 / 20 if found.size else 0.0
    per_sample = np.pad(1 / np.where(cells.count > 0, cells.count, np.inf), ((0, 0), (1, 1)))
    below, own, above = _centre_weights(cells) ** 2
    leverage = below * per_sample[:, :-2] + own * per_sample[:, 1:-1] + above * per_sample[:, 2:]
    by_bin = np.maximum(inside * leverage, between)
    return np.where(np.isfinite(tension), by_bin, np.nan)


def _branch_scatter(tension: Floats, noise: Floats) -> tuple[Floats, Floats]:
    """Mean over the cycles, and the variance of that mean.

    Notes
    -----
    The scatter of a few cycles at one strain is a poor estimate, and the least of a hundred such
    estimates is far too small; it is pooled with that of the whole branch, which counts as ten
    degrees of freedom.  It is never below the noise.

    Examples
    --------
    Cycles at 9 and 11 N: variance 2 N2, that of the mean 1 N2.

    >>> mean, variance = _branch_scatter(np.array([[[9.0]], [[11.0]]]), np.zeros((2, 1, 1)))
    >>> print(mean, variance)
    [[10.]] [[1.]]
    """
    is_there = np.isfinite(tension)
    count = is_there.sum(axis=0).astype(np.float64)
    enough = (count > 0) & (count >= _LEAST_SHARE * tension.shape[0])
    n = np.where(enough, count, np.nan)
    mean = np.where(is_there, tension, 0.0).sum(axis=0) / n
    squares = np.where(is_there, (tension - mean) ** 2, 0.0).sum(axis=0)
    squares = np.where(enough, squares, 0.0)
    freedom = np.where(enough, count - 1, 0.0)
    all_freedom = freedom.sum(axis=-1, keepdims=True)
    pooled = squares.sum(axis=-1, keepdims=True) / np.maximum(all_freedom, 1.0)
    own = (squares + _POOLED_FREEDOM * pooled) / np.where(enough, freedom + _POOLED_FREEDOM, 1.0)
    by_noise = np.where(is_there, noise, 0.0).sum(axis=0) / n
    return mean, np.maximum(own, by_noise) / n


def _shared_scatter(tension: Floats, mean: Floats) -> tuple[Floats, Floats]:
    r"""Scatter of the cycles that is correlated over strain, and the rest.

    Deviations from the mean are split into a cubic over strain and the rest; the covariance of
    the coefficients :math:`b` over :math:`n` cycles gives the contributions,

    .. math:: \frac{\mathrm{cov}(b)}{n} - \frac{v}{n} I = \sum_k q_k q_k^T, \qquad c_k = B q_k

    with v the variance of the rest.

    Notes
    -----
    A whole cycle lies high or low, or tilts: the hose softens, warms, or starts from another
    length. The fitted hose parameters respond to these few directions, in which the scatter does
    not average out over strain.  Directions with a variance that noise alone could reach are
    dropped (the edge of [4]_).  The variance of a few cycles is itself uncertain: contributions
    are widened by the ratio of Student's t to the normal quantile (1.15 for ten cycles, 2.2 for
    three).

    Examples
    --------
    Eleven cycles 1 N apart everywhere: scatter 3.3 N, of the mean 1 N, widened by 14 %.

    >>> cycles = np.arange(-5.0, 6.0)[:, None] + np.zeros(50)
    >>> parts, rest = _shared_scatter(cycles, np.zeros(50))
    >>> print(np.abs(parts)[:, 0].round(3), bool(np.abs(rest).max() < 1e-9))
    [1.137] True
    """
    n_cycle = tension.shape[0]
    judged = np.isfinite(mean)
    n_basis = min(_CUBIC, int(judged.sum()) // _CUBIC)
    if n_cycle < 2 or not n_basis:
        return np.zeros((0, mean.size)), tension
    basis = np.zeros((mean.size, n_basis))
    powers = np.vander(np.linspace(-1, 1, mean.size)[judged], n_basis)
    basis[judged] = np.linalg.qr(powers)[0]
    apart = np.where(np.isfinite(tension) & judged, tension - mean, 0.0)
    coefficient = apart @ basis
    rest = apart - coefficient @ basis.T
    variance = float(np.sum(rest**2)) / ((n_cycle - 1) * max(int(judged.sum()) - n_basis, 1))
    size, axes = np.linalg.eigh(coefficient.T @ coefficient / (n_cycle - 1))
    edge = variance * (1 + np.sqrt(n_basis / (n_cycle - 1))) ** 2
    above = size > max(edge, _ROUNDING * size[-1])
    widened = stdtrit(n_cycle - 1, 0.975) / ndtri(0.975)
    spread = np.sqrt(np.maximum(size[above] - variance, 0.0) / n_cycle) * widened
    common = axes[:, above]
    return (spread * (basis @ common)).T, tension - coefficient @ common @ (basis @ common).T


_AT_AN_END = 5  # points of the straight line that is continued beyond an end


class _CurveErrors(NamedTuple):
    """Effect of shared errors at points of two branches, shape (n_component, 2, n_strain).

    ``tension`` at the strain of the point [N], ``strain`` at its tension [1].
    """

    tension: Floats
    strain: Floats


@dataclass(frozen=True)
@read_only_arrays
class SharedErrors:
    """Errors that all samples of a test share, each for plus one standard uncertainty.

    An error of tension is a function of tension, one of strain a function of strain: either can
    be evaluated between and just beyond the points.

    Parameters
    ----------
    component : tuple of Component, length n_component
        Each only once.
    strain : ndarray, shape (n_point,)
        Increasing. [1]
    tension : ndarray, shape (2, n_point)
        Tension of both branches at these strains, NaN where not known. [N]
    tension_error : ndarray, shape (n_component, 2, n_point)
        Logged less true at one strain; NaN where not known. A branch without known errors has those
        of the other. [N]
    strain_error : ndarray, shape (n_component, 2, n_point)
        Logged less true at one tension; likewise. [1]
    """

    component: tuple[Component, ...]
    strain: Floats
    tension: Floats
    tension_error: Floats
    strain_error: Floats

    def __post_init__(self) -> None:
        """Check shapes and make the arrays read-only."""
        n_point = self.strain.size
        rows = (len(self.component), 2, n_point)
        shapes = {"tension": (2, n_point), "tension_error": rows, "strain_error": rows}
        require_shapes(self, shapes, of="shared errors")

    def at(self, strain: Floats, tension: Floats) -> _CurveErrors:
        """Errors at points of both branches, strain (n_strain,) and tension (2, n_strain)."""
        found = np.zeros((2, len(self.component), 2, strain.size))
        for branch in range(2):
            for row in range(len(self.component)):
                of_tension = self._known(self.tension, self.tension_error[row], branch)
                found[0, row, branch] = read_along(tension[branch], *of_tension)
                axis = np.broadcast_to(self.strain, (2, self.strain.size))
                of_strain = self._known(axis, self.strain_error[row], branch)
                found[1, row, branch] = read_along(strain, *of_strain)
        return _CurveErrors(*found)

    @staticmethod
    def _known(at: Floats, error: Floats, branch: int) -> tuple[Floats, Floats]:
        """Points of a branch in rising order; of the other branch where it has none."""
        for own in (branch, 1 - branch):
            there = np.isfinite(at[own]) & np.isfinite(error[own])
            if there.any():
                order = np.argsort(at[own][there], kind="stable")
                return at[own][there][order], error[own][there][order]
        return np.zeros(1), np.zeros(1)


def constant_errors(
    *,
    tension_offset: float = 0.0,
    strain_offset: float = 0.0,
    tension_gain: float = 0.0,
    strain_gain: float = 0.0,
) -> SharedErrors:
    """Zero and scale of the load and of the strain as shared errors.

    Notes
    -----
    Each is a single error ([5]_).

    Examples
    --------
    >>> cell = constant_errors(tension_offset=10.0, tension_gain=0.01)
    >>> print(cell.at(np.array([0.5]), np.array([[2000.0], [1900.0]])).tension[:, :, 0].round(6))
    [[10. 10.]
     [20. 19.]]
    """
    knots = np.array([0.0, 1.0])
    stated = {
        "tension_offset": (tension_offset, np.ones(2), np.zeros(2)),
        "tension_gain": (tension_gain, knots, np.zeros(2)),
        "strain_offset": (strain_offset, np.zeros(2), np.ones(2)),
        "strain_gain": (strain_gain, np.zeros(2), knots),
    }
    kept = {name: row for name, row in stated.items() if as_spread(name, row[0]) > 0}
    errors = np.array([(size * load, size * place) for size, load, place in kept.values()])
    rows = np.broadcast_to(
        errors.reshape(-1, 2, 1, 2).transpose(1, 0, 2, 3), (2, len(kept), 2, 2)
    )  # fmt: skip
    return SharedErrors(
        tuple(Component(name, "") for name in kept),
        strain=knots,
        tension=np.stack([knots, knots]),
        tension_error=rows[0].copy(),
        strain_error=rows[1].copy(),
    )


def pressure_errors(shared: SharedErrors | None, gauge: float) -> SharedErrors:
    """Shared errors of a curve of fill pressure: errors of strain, and the zero of the gauge.

    Examples
    --------
    >>> errors = pressure_errors(constant_errors(strain_gain=0.01, tension_offset=5.0), 2e3)
    >>> found = errors.at(np.array([0.5]), np.array([[1e5], [1e5]]))
    >>> print(found.strain[:, 0, 0].round(6), found.tension[:, 0, 0])
    [0.    0.005 0.   ] [   0.    0. 2000.]
    """
    known = shared or constant_errors()
    row = np.zeros((1, *known.tension.shape))
    return SharedErrors(
        (*known.component, Component("fill_pressure_offset", "")),
        strain=known.strain,
        tension=np.broadcast_to(np.arange(known.strain.size, dtype=float), row.shape[1:]).copy(),
        tension_error=np.concatenate([0 * known.tension_error, row + gauge]),
        strain_error=np.concatenate([known.strain_error, row]),
    )


def error_words(component: Component) -> str:
    """Name of an error in a note.

    Examples
    --------
    >>> print(error_words(Component("tension_gain", "load cell A")))
    tension_gain of load cell A
    """
    number = f" {component.number + 1}" if component.number else ""
    whose = f" of {component.of}" if component.of else ""
    return f"{component.source}{number}{whose}"


def read_along(at: Floats, known: Floats, values: Floats) -> Floats:
    """Linear interpolation between known points, and beyond them the line of the last five.

    Examples
    --------
    >>> print(read_along(np.array([-1.0, 0.5, 4.0]), np.array([0.0, 1.0, 2.0]),
    ...     np.array([1.0, 2.0, 3.0])).round(9))
    [0.  1.5 5. ]
    """
    found = np.interp(at, known, values)
    for outside, end in ((at < known[0], slice(None, _AT_AN_END)),
                         (at > known[-1], slice(-_AT_AN_END, None))):  # fmt: skip
        x, y = known[end], values[end]
        away = x - x.mean()
        if outside.any() and away.any():
            slope = float(away @ y / (away @ away))
            found[outside] = y.mean() + slope * (at[outside] - x.mean())
    return np.asarray(np.where(np.isfinite(at), found, np.nan))


_GREATEST_STRAIN = 10.0  # no hose stretches to eleven times its length


def measured_curve(
    strain: ArrayLike,
    tension: ArrayLike,
    *,
    loading: Loading,
    cycle_number: ArrayLike | None = None,
    branch: ArrayLike | None = None,
    strain_step: float | None = None,
    break_in_cycles: int = 0,
    shared: SharedErrors | None = None,
) -> MeasuredCurve:
    r"""Tension of every cycle and branch at equally spaced strains, and over the cycles.

    With the mean strain :math:`\bar\varepsilon` and tension :math:`\bar T` of the samples in a
    bin, the tension at its centre :math:`\varepsilon_0` is

    .. math:: T = \bar T - T' (\bar\varepsilon - \varepsilon_0)
              + \tfrac{1}{2} T'' [(\bar\varepsilon - \varepsilon_0)^2 - s^2],

    slope and curvature from the means of the two neighbouring bins, :math:`s^2` the variance of
    strain in the bin.

    Notes
    -----
    *Bias.* A mean over a bin is too high by a 24th of its curvature; the third term corrects this,
    so a parabola is reproduced exactly.  Where the cords pick up, the slope jumps and the curve
    is rounded over one bin, as described by ``reading``.  A bin at the end of a branch has one
    neighbour and no curvature.  No value lies beyond the samples from which it is read.

    *End.* The last samples rarely reach the centre of their bin.  Where they do not, the curve
    continues to the last sample, with the mean of those samples and the slope from the bin below.

    *Uncertainty* of the means is type A: scatter over the cycles, and for a single pull the
    noise in the bins and between bins.  Where whole cycles lie high or low, that part is kept as
    signed contributions, since it does not average out over strain.  Errors common to all samples
    are signed contributions too: the error of the curve if the instrument reads one standard
    uncertainty high.  A strain that is read high moves the curve to the right: minus the slope
    times it.  The noise of a reading is not among them: it is in the scatter.

    *NaN.* A sample that is missing in either series is left out; a bin is NaN where a branch
    has no sample, or only samples on one side of its centre with none beyond; a mean is NaN where
    fewer than half of the cycles reached it.  Negative strains are left out, since no hose is
    predicted there.

    More than 1000 cycles are kept as means of consecutive ones.

    Examples
    --------
    Two cycles of a parabola are reproduced exactly, ascending 10 N above descending.

    >>> stroke = np.linspace(0.0, 0.5, 401)
    >>> strain = np.tile(np.concatenate([stroke, stroke[::-1]]), 2)
    >>> branch = np.tile(np.repeat([1, 2], 401), 2)
    >>> tension = 400 * strain**2 + np.where(branch == 1, 5, -5)
    >>> curve = measured_curve(
    ...     strain, tension, loading="static", cycle_number=np.repeat([1, 2], 802), branch=branch
    ... )
    >>> place = np.searchsorted(curve.strain, 0.2999)
    >>> print(curve.tension[:, :, place].round(3), curve.midline_tension[place].round(3))
    [[41. 31.] [41. 31.]] 36.0
    """
    if loading not in ("static", "dynamic"):
        raise SettingsError("loading is unknown", found=str(loading), needed="static or dynamic")
    samples = _select_samples(
        strain, tension, cycle_number=cycle_number, branch=branch, break_in_cycles=break_in_cycles
    )
    step = samples.least_step() if strain_step is None else strain_step
    if not (np.isfinite(step) and step > 0):
        raise SettingsError("strain_step cannot be used", found=f"{step:g}", needed="above zero")
    greatest = float(samples.strain.max())
    if greatest > _GREATEST_STRAIN:
        raise DataError(
            "no hose stretches as far as this test: strain in per cent?",
            found=f"a strain of {greatest:.4g}, {100 * greatest:.4g} %",
            needed=f"strains as a part of the relaxed length, {_GREATEST_STRAIN:g} at most",
        )
    n_cycle = samples.cycle_number.size
    cells, centre = _fill_cells(
        samples.strain, samples.tension, row=samples.row, n_rows=2 * n_cycle, step=step
    )
    by_row = _tension_at_centres(cells)
    by_cycle = by_row.reshape(n_cycle, 2, centre.size)
    kept = by_cycle[samples.n_break_in :]
    noise = _bin_noise(cells, by_row).reshape(by_cycle.shape)[samples.n_break_in :]
    mean, variance = _branch_scatter(kept, noise)
    middle, noise_of_middle = kept.mean(axis=1), noise.mean(axis=1) / 2
    midline = _branch_scatter(middle[:, None], noise_of_middle[:, None])[0][0]
    is_paired = bool(np.isfinite(midline).any())
    judged = midline if is_paired else mean[0]
    cycles, its_noise = (middle, noise_of_middle) if is_paired else (kept[:, 0], noise[:, 0])
    common, rest = _shared_scatter(cycles, judged)
    _, independent = _branch_scatter(rest[:, None], its_noise[:, None])
    type_a = np.sqrt(independent[0] + np.sum(common**2, axis=0))
    of_branch = np.sqrt(variance)
    if not is_paired:
        of_branch[0] = type_a
    known = shared or constant_errors()
    contribution, strain_error = _contributions(centre, mean, known)
    in_mean = np.isfinite(cycles) & np.isfinite(judged)
    row_weight = np.zeros(by_cycle.shape)
    part = in_mean / np.maximum(in_mean.sum(axis=0), 1)
    row_weight[samples.n_break_in :, : 1 + is_paired] = part[:, None] / (1 + is_paired)
    rows = 2 * np.arange(samples.n_break_in, n_cycle)[:, None] + np.arange(1 + is_paired)
    end = _end_of_curve(cells, rows, np.isfinite(judged), type_a)
    return MeasuredCurve(
        strain=centre,
        tension=by_cycle,
        count=cells.count.reshape(by_cycle.shape).astype(np.int64),
        cycle_number=samples.cycle_number,
        branch_tension=mean,
        branch_standard_uncertainty=of_branch,
        midline_tension=midline,
        midline_standard_uncertainty=type_a if is_paired else np.full(centre.size, np.nan),
        scatter_contribution=common,
        component=known.component,
        contribution=contribution,
        strain_error=strain_error.mean(axis=1) if is_paired else strain_error[:, 0],
        loading=loading,
        reading=_reading_of(
            samples.strain,
            row=samples.row,
            cells=cells,
            row_weight=row_weight.reshape(by_row.shape),
            centre=centre,
            step=step,
        ),
        end_strain=centre[0] + step * end[0],
        end_tension=end[1],
        end_standard_uncertainty=end[2],
        notes=samples.notes if is_paired else (*samples.notes, note("one-branch")),
    )


def _end_of_curve(
    cells: _Cells, rows: Integers, is_judged: Bools, type_a: Floats
) -> tuple[float, float, float]:
    """Strain from the first centre in bins, tension and type A where samples end; NaN if earlier.

    ``rows`` has the shape (n_cycle, n_branch).
    """
    nothing = float("nan"), float("nan"), float("nan")
    seen = np.flatnonzero(is_judged)
    last = int(seen[-1]) if seen.size else -1
    if not 0 <= last < is_judged.size - 1:
        return nothing
    gap = 1 + cells.offset[rows, last + 1] - cells.offset[rows, last]
    there = np.isfinite(gap).all(axis=1)
    if 2 * there.sum() < rows.shape[0] or not there.any():
        return nothing
    rows, gap = rows[there], gap[there]
    level, count = cells.tension[rows, last + 1], cells.count[rows, last + 1]
    onward = cells.furthest[rows, last + 1] - cells.offset[rows, last + 1]
    tension = level + (level - cells.tension[rows, last]) / gap * onward
    of_cycle = tension.mean(axis=1)
    noise = cells.residual.sum() / max(cells.freedom.sum(), 1.0)
    leverage = (1 + onward / gap) ** 2 / count + (onward / gap) ** 2 / cells.count[rows, last]
    variance = noise * float(leverage.mean()) / rows.size
    if of_cycle.size > 1:
        variance = max(variance, float(np.var(of_cycle, ddof=1)) / of_cycle.size)
    return (
        last + 1 + float(cells.furthest[rows, last + 1].mean()),
        float(of_cycle.mean()),
        float(np.hypot(type_a[last], np.sqrt(variance))),
    )


def _contributions(strain: Floats, tension: Floats, shared: SharedErrors) -> tuple[Floats, Floats]:
    """Errors in tension of both branches and their middle, and errors in strain of the branches."""
    errors = shared.at(strain, tension)
    slope = np.zeros(tension.shape)
    for branch, curve in zip(slope, tension, strict=True):
        there = np.isfinite(curve)
        if np.count_nonzero(there) > 1:
            branch[there] = np.gradient(curve[there], strain[there])
    of_branch = np.where(np.isfinite(tension), errors.tension - slope * errors.strain, 0.0)
    both = np.isfinite(tension).all(axis=0)
    middle = np.where(both, of_branch.mean(axis=1), 0.0)
    return np.concatenate([of_branch, middle[:, None]], axis=1), errors.strain
