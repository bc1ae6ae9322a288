"""A deployed assembly at work: stiffness, load of each tether, and whether one goes slack.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 2.3.2, 2.3.3.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError, SettingsError
from reduction.lookup.assembly import AssemblyCurve, assemble
from reduction.lookup.loads import cycle_loads
from reduction.lookup.tethers import SeriesPart, Tether, unequal_tethers
from reduction.record import Bools, Floats, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class WorkingPoint:
    """An assembly under a cycle of tension; arrays have the shape (...) of the points.

    Parameters
    ----------
    mean_tension, peak_tension, minimum_tension : ndarray
        Of the assembly. [N]
    total_length, peak_length, minimum_length : ndarray
        At these. [m]
    stiffness : ndarray
        Tension over length, between the ends of the cycle; the tangent where the amplitude is
        zero. [N m-1]
    apparent_spring_constant : ndarray
        EA: stiffness times the length at which the assembly goes slack. [N]
    tether_tension, peak_tether_tension, minimum_tether_tension : ndarray, shape (n_tethers, ...)
        [N]
    load_share : ndarray, shape (n_tethers, ...)
        Of the mean tension. [1]
    peak_share, minimum_share : ndarray, shape (n_tethers, ...)
        Of the rated break strength of a tether; NaN where that is not known. [1]
    is_tested : ndarray of bool
        Both ends of the cycle are at strains that were tested.
    """

    mean_tension: Floats
    peak_tension: Floats
    minimum_tension: Floats
    total_length: Floats
    peak_length: Floats
    minimum_length: Floats
    stiffness: Floats
    apparent_spring_constant: Floats
    tether_tension: Floats
    peak_tether_tension: Floats
    minimum_tether_tension: Floats
    load_share: Floats
    peak_share: Floats
    minimum_share: Floats
    is_tested: Bools


def working_point(
    assembly: AssemblyCurve,
    mean_tension: ArrayLike,
    tension_amplitude: ArrayLike = 0.0,
    *,
    rated_break_strength: float = float("nan"),
) -> WorkingPoint:
    r"""Stiffness and loads of an assembly under cycles of tension.

    .. math:: EA = L_0 \, \frac{2 A}{L(T + A) - L(T - A)}

    Parameters
    ----------
    assembly : AssemblyCurve
        From `assemble`.
    mean_tension, tension_amplitude : array_like, shape (...)
        Of the assembly; the amplitude is half the range. [N]
    rated_break_strength : float, optional
        Of one tether; NaN where not known. [N]

    Returns
    -------
    point : WorkingPoint
        With the load of each tether.

    Raises
    ------
    DataError
        If a tether reaches zero tension, an amplitude is above its mean or negative, or the peak
        is beyond the curves.

    Notes
    -----
    [1]_, sec. 2.3.2: a tether must not be allowed to go slack, since it may then tangle and be
    cut.  The longest does so first, while the assembly is still taut.

    Examples
    --------
    One tether of 100 N per unit strain and 1 m, between 60 and 140 N:

    >>> from reduction.lookup.composite import composite_curve
    >>> from reduction.lookup.pieces import CurvePiece
    >>> from reduction.strain.model import StrainModel
    >>> at = np.linspace(0.1, 2.0, 20)
    >>> curve = composite_curve([CurvePiece("T", "static", "ascending", at, 100 * at, 0 * at)])
    >>> model = StrainModel("T", "gauge-length", {"reference_position": 1.0, "gauge_length": 1.0})
    >>> point = working_point(assemble([Tether(curve, model)]), 100.0, 40.0)
    >>> print(point.total_length.round(6), point.apparent_spring_constant.round(6))
    2.0 100.0
    """
    cycle = cycle_loads(mean_tension, tension_amplitude, rated_break_strength=float("nan"))
    peak, least = cycle.peak_tension, cycle.minimum_tension
    mean = (peak + least) / 2
    if np.any(peak > assembly.tension[-1]):
        raise DataError(
            "the peak tension is beyond the curves of the assembly",
            found=f"{np.max(peak):.4g} N",
            needed=f"at most {assembly.tension[-1]:.4g} N",
        )
    loads, of_peak, of_least = (assembly.loads_at(one) for one in (mean, peak, least))
    slack = np.argwhere(of_least <= 0)
    if slack.size:
        which = tuple(slack[0])
        raise DataError(
            f"tether {which[0] + 1} of {assembly.n_tethers} goes slack",
            found=f"{least[which[1:]]:.4g} N on the assembly at the least",
            needed=f"above {_tension_at_slack(assembly):.4g} N",
            hint="A slack tether tangles and is cut: more stretch, less amplitude, or equal "
            "lengths.",
        )
    long, short = assembly.length_at(peak), assembly.length_at(least)
    tangent = np.interp(
        mean, assembly.tension, np.gradient(assembly.tension, assembly.total_length)
    )
    # a cycle of less than this is a point
    apart = long - short > 1e-6 * long
    stiffness = np.where(apart, (peak - least) / np.where(apart, long - short, 1.0), tangent)
    ends = [
        assembly.is_tested[np.clip(np.searchsorted(assembly.tension, one), 0, None)]
        for one in (peak, least)
    ]
    return WorkingPoint(
        mean_tension=mean,
        peak_tension=peak,
        minimum_tension=least,
        total_length=assembly.length_at(mean),
        peak_length=long,
        minimum_length=short,
        stiffness=stiffness,
        apparent_spring_constant=stiffness * assembly.total_length[0],
        tether_tension=loads,
        peak_tether_tension=of_peak,
        minimum_tether_tension=of_least,
        load_share=loads / mean,
        peak_share=of_peak / rated_break_strength,
        minimum_share=of_least / rated_break_strength,
        is_tested=ends[0] & ends[1],
    )


def _tension_at_slack(assembly: AssemblyCurve) -> float:
    """Tension of the assembly at which its longest tether goes slack."""
    longest = assembly.slack_length.max()
    return float(np.interp(longest, assembly.total_length, assembly.tension))


@dataclass(frozen=True)
@read_only_arrays
class LoadSharing:
    """Worst loads of one tether over a tolerance of lengths; arrays have the shape (...).

    Parameters
    ----------
    tension : ndarray
        Of the assembly. [N]
    equal_load : ndarray
        Of each tether, where the lengths are equal. [N]
    greatest_load : ndarray
        Of one that is short, where all others are long. [N]
    least_load : ndarray
        Of one that is long, where all others are short; zero where it is slack. [N]
    tension_at_slack : float
        Of the assembly, at which that long one goes slack. [N]
    """

    tension: Floats
    equal_load: Floats
    greatest_load: Floats
    least_load: Floats
    tension_at_slack: float


def worst_sharing(
    tether: Tether,
    n_tethers: int,
    tension: ArrayLike,
    *,
    free_length: float,
    tolerance: float,
    parts: Sequence[SeriesPart] = (),
) -> LoadSharing:
    """Greatest and least load of a tether in an assembly whose lengths have a tolerance.

    Parameters
    ----------
    tether : Tether
        As it was tested.
    n_tethers : int
        Two or more. [1]
    tension : array_like, shape (...)
        Of the assembly. [N]
    free_length : float
        Nominal, relaxed. [m]
    tolerance : float
        Of a free length: it is between 1 - tolerance and 1 + tolerance of the nominal. [1]
    parts : sequence of SeriesPart, optional
        In line; they see the sum, and do not change how it is shared.

    Returns
    -------
    sharing : LoadSharing
        At the same tensions.

    Raises
    ------
    SettingsError
        If there is one tether, or the tolerance is not between 0 and 1.
    DataError
        If a tension is not positive, or beyond the curves.

    Notes
    -----
    The load of a tether falls with its own length and rises with that of every other one, so the
    worst case is at a corner: one short and all others long, or the other way round.  [1]_ has
    no tolerance; it says that an assembly that twists does not share (sec. 2.3.2).

    Examples
    --------
    Springs of 100 N per unit strain, 1 m within 1 %, at 100 N each:

    >>> from reduction.lookup.composite import composite_curve
    >>> from reduction.lookup.pieces import CurvePiece
    >>> from reduction.strain.model import StrainModel
    >>> at = np.linspace(0.1, 2.0, 20)
    >>> curve = composite_curve([CurvePiece("T", "static", "ascending", at, 100 * at, 0 * at)])
    >>> model = StrainModel("T", "gauge-length", {"reference_position": 1.0, "gauge_length": 1.0})
    >>> found = worst_sharing(Tether(curve, model), 2, 200.0, free_length=1.0, tolerance=0.01)
    >>> print(found.greatest_load.round(2), found.least_load.round(2))
    102.0 98.0
    """
    if n_tethers < 2:
        raise SettingsError(
            "one tether shares with no other", found=str(n_tethers), needed="2 or more"
        )
    if not 0 <= tolerance < 1:
        raise SettingsError(
            "the tolerance is a share of the length", found=f"{tolerance:g}", needed="0 to 1"
        )
    load = np.asarray(tension, dtype=np.float64)
    if not np.all(load > 0):
        raise DataError(
            "an assembly without tension shares nothing",
            found=f"{np.min(load):.4g} N",
            needed="above zero",
        )
    rows = []
    for sign in (-1.0, 1.0):
        lengths = np.full(n_tethers, free_length * (1 - sign * tolerance))
        lengths[0] = free_length * (1 + sign * tolerance)
        assembly = assemble(unequal_tethers(tether, lengths), parts)
        if np.any(load > assembly.tension[-1]):
            raise DataError(
                "the tension is beyond the curves of the assembly",
                found=f"{np.max(load):.4g} N",
                needed=f"at most {assembly.tension[-1]:.4g} N",
            )
        rows.append(assembly.loads_at(load)[0])
    return LoadSharing(load, load / n_tethers, rows[0], rows[1], _tension_at_slack(assembly))
