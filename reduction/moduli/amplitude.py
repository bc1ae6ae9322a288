"""Dynamic modulus, loss factor and energy of a test as one number each, with its amplitude.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
.. [2] A. R. Payne, "The dynamic properties of carbon black-loaded natural rubber
   vulcanizates," J. Appl. Polym. Sci., vol. 6, 1962.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive
from reduction.cycles.product import Loops
from reduction.cycles.slopes import slope_readings
from reduction.errors import DataError
from reduction.moduli.product import AmplitudeSummary
from reduction.record import Floats

_QUANTITIES = (
    "frequency", "mean_strain", "strain_amplitude", "mean_tension", "tension_amplitude",
    "apparent_spring_constant", "hysteresis_energy", "storage_spring_constant",
    "loss_spring_constant", "loss_factor",
)  # fmt: skip


def _mean_over_cycles(values: Floats, uncertainty: Floats | None) -> tuple[Floats, Floats]:
    """Mean over the last axis without NaN, and its standard uncertainty of type A."""
    known = np.isfinite(values)
    n = known.sum(axis=-1)
    mean = np.where(known, values, 0.0).sum(axis=-1) / np.where(n > 0, n, np.nan)
    squares = np.where(known, (values - mean[:, None]) ** 2, 0.0).sum(axis=-1)
    of_mean = np.sqrt(squares / np.where(n > 1, n * (n - 1.0), np.nan))
    if uncertainty is not None:
        own = np.where(known, uncertainty, 0.0).sum(axis=-1)
        of_mean = np.where(n == 1, own, of_mean)
    return mean, of_mean


def summarise_amplitude(
    loops: Loops, *, area: ArrayLike, break_in_cycles: int = 0
) -> AmplitudeSummary:
    r"""Mean over the cycles of what depends on mean strain and amplitude.

    .. math:: E_{dyn} = K_{ap} / A

    Parameters
    ----------
    loops : Loops
        One row a cycle and specimen. [SI]
    area : array_like, shape (n_specimens,)
        Cross-sectional area at zero tension; NaN for a rope that has none stated. [m2]
    break_in_cycles : int
        First cycles that are left out. [1]

    Returns
    -------
    summary : AmplitudeSummary
        Means, with their standard uncertainty by name. [SI]

    Raises
    ------
    DataError
        If an area is not positive, the areas do not pair up with the loops, or no cycle
        is left.

    Notes
    -----
    Filled rubber is the softer the larger the amplitude ([2]_), so a dynamic modulus
    without its strain amplitude says little: T-1 and T-2, and T-3 and T-4, of [1]_ are
    pairs of one mean and two amplitudes.

    ``slope_reading_spread`` is how far the other two readings of "slope of the loop" lie
    apart, over K_ap (`reduction.cycles.slopes`).

    Uncertainty is type A: scatter over the cycles over the root of their number; of a
    single cycle, its own. Trend over the cycles is in the scatter. Cycles with NaN are
    left out.

    Examples
    --------
    Two cycles of 100 N and 110 N per unit strain on 1 cm2.

    >>> import numpy as np
    >>> one = np.ones((1, 2))
    >>> loops = Loops(
    ...     **{name: one for name in Loops.__dataclass_fields__ if name not in (
    ...         "apparent_spring_constant", "uncertainty")},
    ...     apparent_spring_constant=np.array([[100.0, 110.0]]), uncertainty={},
    ... )
    >>> summary = summarise_amplitude(loops, area=[1e-4])
    >>> print(summary.dynamic_modulus, summary.uncertainty["dynamic_modulus"])
    [1050000.] [50000.]
    """
    areas = np.atleast_1d(np.asarray(area, dtype=np.float64))
    as_positive("area", areas[~np.isnan(areas)])
    n_specimens, n_cycles = loops.frequency.shape
    if areas.shape != (n_specimens,):
        raise DataError(
            "the areas do not pair up with the loops",
            found=f"shape {areas.shape}",
            needed=f"({n_specimens},)",
        )
    if not 0 <= break_in_cycles < n_cycles:
        raise DataError(
            "no cycle is left after break-in",
            found=f"{n_cycles} cycles, {break_in_cycles} of them break-in",
            needed="at least one cycle more than cycles.break_in_cycles",
        )
    means: dict[str, Floats] = {}
    uncertainty: dict[str, Floats] = {}
    for name in _QUANTITIES:
        own = loops.uncertainty.get(name)
        means[name], uncertainty[name] = _mean_over_cycles(
            getattr(loops, name)[:, break_in_cycles:],
            None if own is None else own[:, break_in_cycles:],
        )
    # of a loss angle that noise turns negative there is no ellipse to read slopes from
    tangent = np.where(means["loss_factor"] >= 0, means["loss_factor"], np.nan)
    means["slope_reading_spread"] = slope_readings(
        means["apparent_spring_constant"], tangent
    ).relative_spread
    per_tangent = tangent / np.sqrt(1 + tangent**2) * (1 + 1 / (1 + tangent**2))
    uncertainty["slope_reading_spread"] = per_tangent * uncertainty["loss_factor"]
    means["dynamic_modulus"] = means["apparent_spring_constant"] / areas
    uncertainty["dynamic_modulus"] = uncertainty["apparent_spring_constant"] / areas
    return AmplitudeSummary(**means, uncertainty=uncertainty)
