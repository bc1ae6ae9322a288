r"""What a slow pull gives: K_0 at a mean tension, strain at a tension, one pull against another.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4.2, 4.4.3 and App. D.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive
from reduction.cycles.product import Loops
from reduction.errors import DataError
from reduction.line.product import SlowPull
from reduction.record import Bools, Floats

# a pull that ends at a level reads a hair above or below it
_BEYOND = 0.01
# a drift of the mean tension over a run that changes K_0 by more than this is said
_DRIFT_NOTED = 0.05


def _scaled(pull: SlowPull, tension: ArrayLike) -> tuple[Floats, Bools]:
    """Tension as u of the fit, NaN outside the range of use."""
    load = np.asarray(tension, dtype=np.float64)
    margin = _BEYOND * 2 * pull.tension_half_range
    inside = (load >= pull.tension_low - margin) & (load <= pull.tension_high + margin)
    scaled: Floats = np.where(
        inside, (load - pull.tension_centre) / pull.tension_half_range, np.nan
    )
    return scaled, inside


def _spread(rows: Floats, covariance: Floats) -> Floats:
    """Standard uncertainty of rows times coefficients; the rows' last axis has four."""
    spread: Floats = np.sqrt(np.einsum("...i,ij,...j->...", rows, covariance, rows))
    return spread


def quasi_static_spring_constant(pull: SlowPull, tension: ArrayLike) -> tuple[Floats, Floats]:
    r"""Slope of the load-strain curve at a tension.

    .. math:: K_0 = 1 / (B + 2 C T + 3 D T^2), \qquad u(K_0) = K_0^2 \, u(B + 2 C T + 3 D T^2)

    Parameters
    ----------
    pull : SlowPull
        From `reduction.line.pull.fit_pull`.
    tension : array_like, shape (...)
        Mean tension of interest. [N]

    Returns
    -------
    quasi_static_spring_constant, standard_uncertainty : ndarray, shape (...)
        NaN outside the range of use, of which a hundredth of the range may be missing, and
        where the slope is not positive. [N]

    Raises
    ------
    ValueError
        If the tension is not numeric.

    Notes
    -----
    Source: [1]_, sec. 4.4.2: it "must be calculated at the mean load level of interest and
    used for small perturbations around that mean load".  The uncertainty is of the fit, with
    what the cubic misses of the curve.

    Examples
    --------
    >>> from reduction.line.pull import fit_pull
    >>> load = np.linspace(0, 2000.0, 400)
    >>> stretch = 1.389e-4 * load - 3.906e-8 * load**2 + 3.795e-12 * load**3
    >>> pull = fit_pull(np.arange(400.0), stretch, load)
    >>> print(quasi_static_spring_constant(pull, [768.0, 2400.0])[0].round(-1))
    [11680. nan]
    """
    scaled, _ = _scaled(pull, tension)
    nothing = np.zeros_like(scaled)
    rows = np.stack([nothing, nothing + 1, 2 * scaled, 3 * scaled**2], axis=-1)
    rows = rows / pull.tension_half_range
    slope = np.where(np.isnan(scaled), np.nan, rows @ pull.coefficient)
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = np.where(slope > 0, 1 / slope, np.nan)
    spread = np.hypot(_spread(rows, pull.covariance), pull.slope_misfit / pull.tension_half_range)
    return inverse, inverse**2 * spread


def strain_at_tension(pull: SlowPull, tension: ArrayLike) -> tuple[Floats, Floats]:
    """Strain of the slow pull at a tension.

    Parameters
    ----------
    pull : SlowPull
        From `reduction.line.pull.fit_pull`.
    tension : array_like, shape (...)
        Tension. [N]

    Returns
    -------
    strain, standard_uncertainty : ndarray, shape (...)
        By the cubic, from the reference length; NaN outside the range of use. [1]

    Raises
    ------
    ValueError
        If the tension is not numeric.

    Notes
    -----
    Source: [1]_, sec. 4.4.3.

    Examples
    --------
    >>> from reduction.line.pull import fit_pull
    >>> load = np.linspace(0, 2000.0, 400)
    >>> stretch = 1.389e-4 * load - 3.906e-8 * load**2 + 3.795e-12 * load**3
    >>> print(strain_at_tension(fit_pull(np.arange(400.0), stretch, load), 1920.0)[0].round(4))
    0.1496
    """
    scaled, _ = _scaled(pull, tension)
    rows = np.stack([scaled**power for power in range(4)], axis=-1)
    spread = np.hypot(_spread(rows, pull.covariance), pull.strain_misfit)
    return rows @ pull.coefficient, spread


def strain_at_break_share(
    pull: SlowPull, share: ArrayLike, *, rated_break_strength: float
) -> tuple[Floats, Floats]:
    """Strain of the slow pull at a share of the rated break strength.

    Parameters
    ----------
    pull : SlowPull
        From `reduction.line.pull.fit_pull`.
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
    >>> from reduction.line.pull import fit_pull
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
        For instance of one line at two rates, or after two waiting times.
    tension : array_like, shape (...)
        Tension. [N]

    Returns
    -------
    ratio, standard_uncertainty : ndarray, shape (...)
        NaN where either pull has no K_0. [1]

    Raises
    ------
    ValueError
        If the tension is not numeric.

    Notes
    -----
    Source: [1]_, Table D-1, where it is 1.50 for the rate, 1.22 for the waiting time and
    1.83 for both.

    Examples
    --------
    >>> from reduction.line.pull import fit_pull
    >>> load = np.linspace(0, 2000.0, 400)
    >>> slow, fast = (fit_pull(np.arange(400.0), load / k, load) for k in (4.22e4, 6.33e4))
    >>> print(spring_constant_ratio(fast, slow, 1000.0)[0].round(2))
    1.5
    """
    one, u_one = quasi_static_spring_constant(pull, tension)
    two, u_two = quasi_static_spring_constant(other, tension)
    ratio = one / two
    return ratio, ratio * np.hypot(u_one / one, u_two / two)


def quasi_static_of_run(
    loops: Loops, pulls: Sequence[SlowPull | None], *, break_in_cycles: int = 0
) -> tuple[Floats, Floats, tuple[str, ...]]:
    """K_0 of each specimen at the mean tension of a run.

    Parameters
    ----------
    loops : Loops
        Table of loops of the run.
    pulls : sequence of SlowPull or None, length n_specimens
        None where a specimen has no slow pull.
    break_in_cycles : int, optional
        Cycles left out of the mean at the start. [1]

    Returns
    -------
    quasi_static_spring_constant, standard_uncertainty : ndarray, shape (n_specimens,)
        NaN without a pull, or with a mean tension outside its range of use. [N]
    notes : tuple of str
        Why a specimen has none, and a drift of the mean tension that matters.

    Raises
    ------
    DataError
        If there is not one entry a specimen, or the break-in leaves no cycle.

    Notes
    -----
    Source: [1]_, sec. 4.4.2.  One K_0 a run, so that all its cycles share its error.

    Examples
    --------
    >>> from reduction.line.pull import fit_pull
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
    notes: list[str] = []
    for row, pull in enumerate(pulls):
        load = loops.mean_tension[row, break_in_cycles:]
        load = load[np.isfinite(load)]
        if pull is None or load.size == 0:
            notes.append(
                f"specimen {row + 1} has no " + ("slow pull" if pull is None else "mean tension")
            )
            continue
        mean = float(load.mean())
        constant[row], uncertainty[row] = quasi_static_spring_constant(pull, mean)
        if np.isnan(constant[row]):
            notes.append(
                f"the mean tension of {mean:.4g} N lies outside the {pull.tension_low:.4g} to "
                f"{pull.tension_high:.4g} N of the slow pull of {pull.specimen or row + 1}"
            )
            continue
        ends, _ = quasi_static_spring_constant(pull, [float(load[0]), float(load[-1])])
        change = float(ends[1] / ends[0]) - 1
        if abs(change) > _DRIFT_NOTED:
            notes.append(
                f"the mean tension drifts from {load[0]:.4g} to {load[-1]:.4g} N over the run, "
                f"which changes K_0 by {change:+.0%}; K_0 is that at {mean:.4g} N"
            )
    return constant, uncertainty, tuple(notes)
