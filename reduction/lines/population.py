r"""Specimens of one kind as one line: mean, scatter between specimens, tolerance limits.

.. math:: \bar y \pm t_{n-1} \frac{s}{\sqrt n}, \qquad
          \bar y \pm t_{n-1} s \sqrt{1 + \frac1n}, \qquad
          \bar y - k_1 s - U, \quad \bar y + k_1 s + U, \quad \bar y \mp (k_2 s + U)

for the mean of the kind, for another specimen, and as limits beyond which, with 95 % confidence, at
most a stated share of the population lies ([1]_, [2]_).  s is the standard deviation of the
specimens as tested, so it includes the random error of each test.  An error that all tests share,
such as that of a load cell, moves all specimens together and is not in s: its 95 % half width U is
added to the limits, and enters the intervals by the Welch-Satterthwaite formula.

References
----------
.. [1] NIST/SEMATECH e-Handbook of Statistical Methods, sec. 7.2.6.3, "Tolerance intervals for a
   normal distribution": k_1 by the noncentral t distribution.
.. [2] ISO 16269-6:2014, "Statistical interpretation of data - Part 6: Determination of statistical
   tolerance intervals": exact two-sided factors for unknown mean and standard deviation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from scipy.special import chdtrc, chndtrix, nctdtrit, ndtri

from reduction.lines.line_curve import half_width_of_parts, shared_half_width, shared_of
from reduction.lines.line_levels import INTERPOLATED
from reduction.lines.line_lookup import interval_note
from reduction.lines.line_search import DIAMETER_TOLERANCE
from reduction.lines.lookup_product import DesignValues, LineSource
from reduction.record.contributions import CONFIDENCE
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Floats, read_only_arrays

FEWEST_SPECIMENS = 3
"""With two, the one-sided factor of 95 % is 26 and the two-sided one 37: useless limits."""

_NODES, _FARTHEST = 200, 9.0


def tolerance_factors(n: int, share: float, confidence: float = CONFIDENCE) -> tuple[float, float]:
    r"""One-sided and two-sided factors of a normal tolerance limit.

    Parameters
    ----------
    n : int
        Number of specimens, two or more.
    share : float
        Share of the population within the limits. [1]
    confidence : float
        Confidence of the statement. [1]

    Returns
    -------
    one_sided, two_sided : float
        Multiples of the standard deviation of the specimens. [1]

    Raises
    ------
    SettingsError
        If there are fewer than two, or a share is not between 0 and 1.

    Notes
    -----
    :math:`k_1 = t'_{n-1}(\gamma;\, z_p \sqrt n) / \sqrt n` by the noncentral t distribution
    ([1]_); :math:`k_2` exact ([2]_), the root of

    .. math:: \int \varphi(z)\, P\bigl(\chi^2_{n-1} > (n - 1)\, r^2(z) / k^2\bigr)\, dz = \gamma,
              \qquad \Phi(z/\sqrt n + r) - \Phi(z/\sqrt n - r) = p

    Examples
    --------
    NIST sec. 7.2.6.3: 43 wafers, 90 % of them, 99 % confidence, 1.8740.

    >>> round(tolerance_factors(43, 0.90, 0.99)[0], 4)
    1.874
    """
    if n < 2 or not (0 < share < 1 and 0 < confidence < 1):
        raise SettingsError(
            "a tolerance limit needs two specimens or more, and shares between 0 and 100 %",
            found=f"{n} specimens, share {share:g}, confidence {confidence:g}",
        )
    root, freedom = np.sqrt(n), n - 1
    one = float(nctdtrit(freedom, float(ndtri(share)) * root, confidence) / root)
    node, weight = np.polynomial.legendre.leggauss(_NODES)
    z, weight = _FARTHEST * (node + 1) / 2, _FARTHEST * weight / 2
    density = 2 * weight * np.exp(-(z**2) / 2) / np.sqrt(2 * np.pi)
    # the share within r of a mean that is off by z / sqrt(n)
    square = chndtrix(share, 1.0, z**2 / n)

    def missed(k: float) -> float:
        return float(density @ chdtrc(freedom, freedom * square / k**2)) - confidence

    return one, float(scipy.optimize.brentq(missed, 1e-3, 1e5, xtol=1e-10))


@dataclass(frozen=True)
@read_only_arrays
class PopulationValues:
    """A quantity of several specimens of one kind.  Arrays have the shape (...) of the points.

    Parameters
    ----------
    values : DesignValues
        Mean of the specimens; ``kind_low`` and ``kind_high`` are of the mean of the kind,
        ``line_low`` and ``line_high`` of another specimen.
    specimens : tuple of str
        Specimens used.
    of_specimens : ndarray, shape (n_specimens, ...)
        The value of each. [unit]
    standard_deviation : ndarray
        Between specimens. [unit]
    share, confidence : float
        Share of the population, and the confidence. [1]
    one_sided_factor, two_sided_factor : float
        k_1 and k_2. [1]
    lower, upper : ndarray
        One-sided limits, each on its own. [unit]
    both_low, both_high : ndarray
        Two-sided limits. [unit]
    shared_half_width : ndarray
        U of the errors that the tests share, included in all limits. [unit]
    """

    values: DesignValues
    specimens: tuple[str, ...]
    of_specimens: Floats
    standard_deviation: Floats
    share: float
    confidence: float
    one_sided_factor: float
    two_sided_factor: float
    lower: Floats
    upper: Floats
    both_low: Floats
    both_high: Floats
    shared_half_width: Floats


_ALIKE = ("kind", "material", "construction", "condition")


def specimens_of_kind(
    lines: Sequence[LineSource], quantity: str, name: str | None = None
) -> list[LineSource]:
    """Lines of different specimens of one kind that have a quantity."""
    found = [
        line
        for line in lines
        if quantity in line.quantities and (name is None or line.name.startswith(f"{name} "))
    ]
    names = [one for line in found for one in line.specimens or (line.name,)]
    twice = sorted({one for one in names if names.count(one) > 1})
    if twice:
        raise SettingsError(
            f"{quantity} of one specimen is in several lines: a population has each specimen once",
            found=", ".join(twice), needed="--line with the name of one test",
        )  # fmt: skip
    for what in _ALIKE:
        words = sorted({getattr(line, what) for line in found})
        if len(words) > 1:
            raise SettingsError(
                f"the specimens are not of one kind: they differ in {what}",
                found=", ".join(repr(one) for one in words),
                needed="a search that matches one, such as --material or --condition",
            )
    sizes = np.array([line.diameter for line in found])
    if sizes.size and np.ptp(sizes) > DIAMETER_TOLERANCE * np.mean(sizes):
        raise SettingsError(
            "the specimens are not of one kind: they differ in diameter",
            found=f"{1e3 * sizes.min():.4g} to {1e3 * sizes.max():.4g} mm", needed="--diameter",
        )  # fmt: skip
    if len(found) < FEWEST_SPECIMENS:
        factors = tolerance_factors(2, 0.95)
        raise DataError(
            f"too few specimens have {quantity} for tolerance limits",
            found=", ".join(line.name for line in found) or "none",
            needed=f"{FEWEST_SPECIMENS} or more; with two the factors of 95 % are "
            f"{factors[0]:.1f} and {factors[1]:.1f}",
        )
    return found


def population_values(
    lines: Sequence[LineSource], found: Sequence[DesignValues], share: float
) -> PopulationValues:
    """Mean, scatter and tolerance limits of specimens at the same points.

    Parameters
    ----------
    lines : sequence of LineSource
        As returned by `specimens_of_kind`.
    found : sequence of DesignValues
        Values of each line, at the same points.
    share : float
        Share of the population within the limits. [1]

    Returns
    -------
    values : PopulationValues
        [unit of the quantity]

    Raises
    ------
    SettingsError
        If the share is not between 0 and 1.
    DataError
        If a value is interpolated between two tested levels: its error is in no scatter.
    """
    one, two = tolerance_factors(len(lines), share)
    for line, value in zip(lines, found, strict=True):
        if any(text.startswith(INTERPOLATED) for text in value.notes):
            raise DataError(
                f"{line.name} was not tested at every point", found="a level between two tested",
                needed="levels at which each of the specimens was tested",
            )  # fmt: skip
    n, first = len(lines), found[0]
    of_specimens = np.stack([value.value for value in found])
    mean, scatter = of_specimens.mean(axis=0), of_specimens.std(axis=0, ddof=1)
    shared = shared_of({str(place): value for place, value in enumerate(found)})
    table = np.array([shared.values[str(place)] for place in range(n)])
    # errors of one specimen alone, such as its diameter, are in the scatter
    is_common = (table != 0).any(axis=tuple(range(2, table.ndim))).sum(axis=0) > 1
    rows = table[:, is_common].mean(axis=0)
    component = tuple(
        one for one, kept in zip(shared.component, is_common.tolist(), strict=True) if kept
    )
    few = [one.degrees_of_freedom for one in component]

    def half(spread: Floats) -> Floats:
        freedom = np.full(spread.shape, float(n - 1))
        return half_width_of_parts(spread[None], freedom[None], rows, few)

    of_kind, of_line = half(scatter / np.sqrt(n)), half(scatter * np.sqrt(1 + 1 / n))
    common = shared_half_width(rows)
    nothing = np.full(mean.shape, np.nan)
    names = tuple(name for line in lines for name in line.specimens or (line.name,))
    told = [
        text if all(text in one.notes for one in found) else f"{line.name}: {text}"
        for line, value in zip(lines, found, strict=True)
        for text in value.notes
        if text != interval_note(value.interval_of, value.surface_interval_of)
    ]
    notes = (
        f"{n} specimens: {', '.join(names)}; their scatter is taken as normal",
        f"tolerance limits: {100 * share:g} % of the population with {100 * CONFIDENCE:g} % "
        f"confidence, factor {one:.3f} for one limit alone and {two:.3f} for both together; beyond "
        "that what the tests share",
        *dict.fromkeys(told),
    )
    values = replace(
        first,
        value=mean, low=nothing, high=nothing, surface_low=nothing, surface_high=nothing,
        kind_low=mean - of_kind, kind_high=mean + of_kind,
        line_low=mean - of_line, line_high=mean + of_line,
        component=component, contribution=rows,
        random_standard_uncertainty=np.empty(0), random_degrees_of_freedom=np.empty(0),
        run_standard_uncertainty=np.empty(0), interval_of="", surface_interval_of="",
        is_inside=np.all([value.is_inside for value in found], axis=0),
        is_untested=np.any([value.is_untested for value in found], axis=0),
        source="; ".join(dict.fromkeys(value.source for value in found)),
        warnings=tuple(dict.fromkeys(text for value in found for text in value.warnings)),
        errata=tuple(dict.fromkeys(text for value in found for text in value.errata)),
        notes=notes,
    )  # fmt: skip
    return PopulationValues(
        values=values, specimens=names, of_specimens=of_specimens, standard_deviation=scatter,
        share=share, confidence=CONFIDENCE, one_sided_factor=one, two_sided_factor=two,
        lower=mean - one * scatter - common, upper=mean + one * scatter + common,
        both_low=mean - two * scatter - common, both_high=mean + two * scatter + common,
        shared_half_width=common,
    )  # fmt: skip
