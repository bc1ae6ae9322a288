"""Type A uncertainty of a curve over cycles: what varies from strain to strain, and what not.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of
   uncertainty in measurement," sec. 4.2.
.. [2] V. A. Marchenko and L. A. Pastur, "Distribution of eigenvalues for some sets of random
   matrices," Math. USSR Sbornik, vol. 1, 1967 (the largest variance that noise reaches).
"""

from __future__ import annotations

import numpy as np
from scipy.special import ndtri, stdtrit

from reduction.compare.cells import Cells, centre_weights
from reduction.record import Floats

_POOLED_FREEDOM = 10.0  # what the scatter of the whole branch weighs beside that of one bin
_LEAST_SHARE = 0.5  # of the cycles, that have to visit a bin
_CUBIC = 4  # coefficients
_ROUNDING = 1e-12


def bin_noise(cells: Cells, tension: Floats) -> Floats:
    """Variance of the tension of each bin by noise alone.

    The greater of two: the scatter of samples about the line in their bin, as means are moved
    to the centre (half a bin at the end of a branch is moved by a slope of its own), and what
    third differences from bin to bin leave, which sees noise that is slower than the samples.

    Parameters
    ----------
    cells : Cells
        Moments of rows and bins. [SI]
    tension : ndarray, shape (n_rows, n_bins)
        At the bin centres. [N]

    Returns
    -------
    variance : ndarray, shape (n_rows, n_bins)
        NaN where there is no tension. [N2]

    Raises
    ------
    Nothing
        A row without a degree of freedom has no noise inside its bins.

    Notes
    -----
    The third difference of white noise of variance v has the variance 20 v; its median is
    taken, so that a kink does not count.

    Examples
    --------
    Without noise there is none.

    >>> from reduction.compare.cells import fill_cells, tension_at_centres
    >>> place = np.linspace(0, 1, 1001)
    >>> cells, _ = fill_cells(place, 3 * place, row=np.zeros(1001, int), n_rows=1, step=0.1)
    >>> print(bool(np.all(bin_noise(cells, tension_at_centres(cells)) < 1e-9)))
    True
    """
    freedom = cells.freedom.sum()
    inside = cells.residual.sum() / freedom if freedom > 0 else 0.0
    third = np.diff(tension, n=3, axis=1)
    found = np.abs(third[np.isfinite(third)])
    between = (np.median(found) / 0.6745) ** 2 / 20 if found.size else 0.0
    per_sample = np.pad(1 / np.where(cells.count > 0, cells.count, np.inf), ((0, 0), (1, 1)))
    below, own, above = centre_weights(cells) ** 2
    leverage = below * per_sample[:, :-2] + own * per_sample[:, 1:-1] + above * per_sample[:, 2:]
    by_bin = np.maximum(inside * leverage, between)
    return np.where(np.isfinite(tension), by_bin, np.nan)


def branch_scatter(tension: Floats, noise: Floats) -> tuple[Floats, Floats]:
    """Mean over the cycles, and the variance of that mean.

    Parameters
    ----------
    tension : ndarray, shape (n_cycle, n_branch, n_strain)
        Of each cycle; NaN where not visited. [N]
    noise : ndarray, shape (n_cycle, n_branch, n_strain)
        Variance by noise alone. [N2]

    Returns
    -------
    mean : ndarray, shape (n_branch, n_strain)
        NaN where fewer than half of the cycles came. [N]
    variance : ndarray, shape (n_branch, n_strain)
        Of the mean. [N2]

    Raises
    ------
    Nothing
        A bin without a cycle is NaN.

    Notes
    -----
    The scatter of a few cycles at one strain is a poor estimate, and the least of a hundred
    of them is far too small; it is pooled with that of the whole branch, which counts as ten
    degrees of freedom.  It is never below the noise.

    Examples
    --------
    Cycles at 9 and 11 N: scatter 2 N2, of the mean 1 N2.

    >>> mean, variance = branch_scatter(np.array([[[9.0]], [[11.0]]]), np.zeros((2, 1, 1)))
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


def shared_scatter(tension: Floats, mean: Floats) -> tuple[Floats, Floats]:
    r"""What the scatter of the cycles has in common over strain, and what is left of the cycles.

    Deviations from the mean are taken apart into a cubic over strain and the rest; the
    covariance of the coefficients :math:`b` over :math:`n` cycles gives the contributions,

    .. math:: \frac{\mathrm{cov}(b)}{n} - \frac{v}{n} I = \sum_k q_k q_k^T, \qquad c_k = B q_k

    with v the variance of the rest.

    Parameters
    ----------
    tension : ndarray, shape (n_cycle, n_strain)
        Of each cycle; NaN where not visited. [N]
    mean : ndarray, shape (n_strain,)
        Over the cycles; NaN where there is none. [N]

    Returns
    -------
    contribution : ndarray, shape (n_component, n_strain)
        One standard uncertainty of the mean each; none of them for a single cycle. [N]
    rest : ndarray, shape (n_cycle, n_strain)
        The cycles without their common scatter. [N]

    Raises
    ------
    Nothing
        Bins that a cycle did not visit count as its mean.

    Notes
    -----
    A cycle lies high or low as a whole, or turns: the hose softens, warms, or starts from
    another length. The few directions in which it does are those in which numbers of a hose
    are fitted, and there the scatter does not average out over strain.  Directions whose
    variance noise alone would reach are dropped (the edge of [2]_).  The variance of a few
    cycles is itself uncertain: contributions are widened by the ratio of Student's to the
    normal quantile (1.15 for ten cycles, 2.2 for three).

    Examples
    --------
    Eleven cycles that lie apart by 1 N everywhere: scatter 3.3 N, of the mean 1 N, widened 14 %.

    >>> cycles = np.arange(-5.0, 6.0)[:, None] + np.zeros(50)
    >>> parts, rest = shared_scatter(cycles, np.zeros(50))
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
