r"""Whether K_ap, H, K_0, K_1 and tau of a published line hold together, and what would.

A spring K_0 beside a Maxwell element has an apparent spring constant between K_0 and K_0 + K_1,
whatever its relaxation time and the frequency.  The surfaces of a report are fitted one by one, so
that nothing keeps them there.  K_ap and H are measured in every run, K_0 in a slow pull; K_1 and
tau were solved from them.  Solving again, in closed form, gives the K_1 and tau that belong to the
K_ap and H of a page, and a quadratic through them the coefficients that the page should have:

.. math:: b' = (X^T X)^{-1} X^T g(X b_{K_{ap}}, X b_H, K_0), \qquad
          z_j = \frac{b_j - b'_j}{s \sqrt{[(X^T X)^{-1}]_{jj}}}

with s of the r2 that is printed with the column.  The report refitted values solved from runs, here
from fitted K_ap and H: what the runs scatter about those is, to first order, orthogonal to the
quadratic, so that the two agree better than s says, and a z is rather too small.  z is Student's t
of the five degrees of freedom of s; of ten coefficients one is beyond 4.77 in 5 % of such columns.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eqs. 1, 4, 5, sec. 4.3, A-3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.experiments.designs import box_behnken, coded_from_engineering, model_matrix
from reduction.experiments.run_sheet import variance_factor
from reduction.lines.line_curve import evaluate_curve
from reduction.lines.lookup_product import LineSource, LineSurface
from reduction.quantities.digits import plain_number
from reduction.quantities.names import quantity as quantity_of
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays
from reduction.stages.three_parameter_line.line_model import identify_by_amplitude

K_AP, ENERGY, K_0, K_1, TIME, DASHPOT = (
    "apparent_spring_constant", "hysteresis_energy", "quasi_static_spring_constant",
    "dissipation_spring_constant", "relaxation_time", "dashpot_coefficient",
)  # fmt: skip

SOLVED = (K_1, TIME)

_OF_ALL_COEFFICIENTS = 0.05
"""Share of good columns of which one coefficient is called wrong. [1]"""


@dataclass(frozen=True)
@read_only_arrays
class ConsistentValues:
    """A line at points, as printed and as it holds together; arrays have one shape (...).

    Parameters
    ----------
    slow_pull : str
        Which K_0 was taken, in words.
    printed : dict of str to ndarray
        K_ap, H, K_1 and tau, as far as the line has surfaces of them. [N], [J m-1], [s]
    quasi_static_spring_constant : ndarray
        K_0 of that slow pull at the mean tension. [N]
    dissipation_spring_constant, relaxation_time : ndarray
        Solved from the printed K_ap and H; NaN where there is no solution. [N], [s]
    excess : ndarray
        Printed K_ap less K_0 and printed K_1: above zero no line is so; NaN without K_1. [N]
    excess_uncertainty : ndarray
        Standard uncertainty of it, of the surfaces alone. [N]
    reason : ndarray of int
        Why there is no solution: `reduction.stages.three_parameter_line.line_product.REASONS`.
    """

    slow_pull: str
    printed: dict[str, Floats]
    quasi_static_spring_constant: Floats
    dissipation_spring_constant: Floats
    relaxation_time: Floats
    excess: Floats
    excess_uncertainty: Floats
    reason: Integers

    @property
    def is_impossible(self) -> Bools:
        """Printed K_ap above the sum of K_0 and printed K_1."""
        return np.asarray(self.excess > 0)


@dataclass(frozen=True)
@read_only_arrays
class RefittedSurface:
    """The coefficients of one column beside those that the other columns ask for.

    Parameters
    ----------
    quantity : str
        K_1 or tau.
    slow_pull : str
        Which K_0 was taken, in words.
    printed, consistent : ndarray, shape (10,)
        B1 .. B10 of the page, and through the solved values. [SI unit of the quantity]
    z : ndarray, shape (10,)
        Their difference over the standard error by the printed r2; NaN where that is open. [1]
    n_solved : int
        Runs of the design that have a solution.
    """

    quantity: str
    slow_pull: str
    printed: Floats
    consistent: Floats
    z: Floats
    n_solved: int

    @property
    def worst(self) -> int:
        """Place of the coefficient that is farthest off."""
        return 0 if np.isnan(self.z).all() else int(np.nanargmax(np.abs(self.z)))

    @property
    def greatest(self) -> float:
        """How far off that one is; NaN where r2 is open."""
        return float(abs(self.z[self.worst]))


def consistent_values(
    line: LineSource,
    *,
    frequency: ArrayLike,
    mean_tension: ArrayLike,
    tension_amplitude: ArrayLike,
) -> tuple[ConsistentValues, ...]:
    """A line at points as printed, and K_1 and tau that hold with its K_ap and H.

    Parameters
    ----------
    line : LineSource
        With surfaces of K_ap and H and its slow pulls; of any other nothing is said.
    frequency, mean_tension, tension_amplitude : array_like, shape (...)
        Broadcast together. [Hz], [N], [N]

    Returns
    -------
    values : tuple of ConsistentValues
        One for each slow pull; of an open coefficient the first of its values.

    Notes
    -----
    K_1 and tau by `identify_by_amplitude` at the point itself, so that K_ap is between K_0 and
    K_0 + K_1 wherever there is a solution.

    Examples
    --------
    Plaited nylon at 0.3 Hz, 1728 and 489.6 lbf: 45,100 lbf printed for K_ap, 25,000 for K_1, which
    with the 15,592 lbf of the slow pull is too little.

    >>> from reduction.lines.published_source import published_sources
    >>> line = published_sources()["nylon-8-strand-plaited-0.5in-new"]
    >>> values, _ = consistent_values(line, frequency=0.3,
    ...     mean_tension=1728 * 4.4482216, tension_amplitude=489.6 * 4.4482216)
    >>> print(round(float(values.excess) / 4.4482216, -1), bool(values.is_impossible))
    4490.0 True
    """
    if not ({K_AP, ENERGY} <= line.surfaces.keys() and line.slow_pulls):
        return ()
    rate, mean, amplitude = np.broadcast_arrays(
        *(np.asarray(one, dtype=np.float64) for one in (frequency, mean_tension, tension_amplitude))
    )
    shape = rate.shape
    at = np.stack([rate.ravel(), mean.ravel(), amplitude.ravel()], axis=1)
    columns, spread = {}, {}
    for name in (K_AP, ENERGY, *SOLVED):
        if name in line.surfaces:
            columns[name], spread[name] = (one.reshape(shape) for one in _at(line, name, at))
    nothing = np.full(shape, np.nan)
    found = []
    for label, curve in line.slow_pulls.items():
        rest = evaluate_curve(curve, mean).value
        solved = identify_by_amplitude(
            apparent_spring_constant=columns[K_AP],
            hysteresis_energy=columns[ENERGY],
            tension_amplitude=amplitude,
            frequency=rate,
            quasi_static_spring_constant=rest,
        )
        found.append(
            ConsistentValues(
                slow_pull=label,
                printed=columns,
                quasi_static_spring_constant=rest,
                dissipation_spring_constant=solved.dissipation_spring_constant,
                relaxation_time=solved.relaxation_time,
                excess=columns[K_AP] - rest - columns.get(K_1, nothing),
                excess_uncertainty=np.hypot(spread[K_AP], spread.get(K_1, nothing)),
                reason=np.asarray(solved.reason),
            )
        )
    return tuple(found)


def _at(line: LineSource, name: str, at: Floats) -> tuple[Floats, Floats]:
    """A printed surface at points (n_points, 3), and one standard uncertainty of it."""
    surface = line.surfaces[name]
    coded = coded_from_engineering(at, low=surface.low, high=surface.high)
    terms = model_matrix(coded, surface.exponents)
    leverage = variance_factor(terms, surface.covariance_factor)
    return terms @ surface.coefficient, surface.sigma * np.sqrt(leverage)


def refitted_surfaces(line: LineSource) -> tuple[RefittedSurface, ...]:
    """Printed K_1 and tau of a line against a quadratic through the solved ones.

    Parameters
    ----------
    line : LineSource
        As `consistent_values`.

    Returns
    -------
    surfaces : tuple of RefittedSurface
        One for each slow pull and each of K_1 and tau that is printed; runs without a solution
        are left out, and nothing is fitted where too few are left.

    Notes
    -----
    See the module for z.

    Examples
    --------
    The linear effect of mean load on K_1 of plaited nylon: 0.756e4 lbf printed.

    >>> from reduction.lines.published_source import published_sources
    >>> line = published_sources()["nylon-8-strand-plaited-0.5in-new"]
    >>> for one in refitted_surfaces(line)[::2]:
    ...     print(one.worst + 1, (one.consistent[5] / 44482.216).round(3), one.z[5].round(1))
    6 1.11 -11.7
    6 1.016 -8.6
    """
    if not ({K_AP, ENERGY} <= line.surfaces.keys()):
        return ()
    known = line.surfaces[K_AP]
    coded = box_behnken(3).coded
    runs = known.low + (coded + 1) / 2 * (known.high - known.low)
    terms = model_matrix(coded, known.exponents)
    found = []
    for values in consistent_values(
        line, frequency=runs[:, 0], mean_tension=runs[:, 1], tension_amplitude=runs[:, 2]
    ):
        for name in SOLVED:
            solved: Floats = getattr(values, name)
            good = np.isfinite(solved)
            if name not in line.surfaces or np.linalg.matrix_rank(terms[good]) < terms.shape[1]:
                continue
            surface = line.surfaces[name]
            refit: Floats = np.asarray(
                np.linalg.lstsq(terms[good], solved[good], rcond=None)[0], dtype=np.float64
            )
            error = surface.sigma * np.sqrt(np.diag(np.linalg.inv(terms.T @ terms)))
            found.append(
                RefittedSurface(
                    quantity=name,
                    slow_pull=values.slow_pull,
                    printed=surface.coefficient,
                    consistent=refit,
                    z=(surface.coefficient - refit) / error,
                    n_solved=int(good.sum()),
                )
            )
    return tuple(found)


def critical_z(surface: LineSurface) -> float:
    """Greatest z of a column whose coefficients are all right, but in one such column of twenty.

    Examples
    --------
    >>> from reduction.lines.published_source import published_sources
    >>> line = published_sources()["nylon-8-strand-plaited-0.5in-new"]
    >>> round(critical_z(line.surfaces["relaxation_time"]), 2)
    4.77
    """
    share = _OF_ALL_COEFFICIENTS / (2 * surface.coefficient.size)
    return float(scipy.special.stdtrit(surface.degrees_of_freedom, 1 - share))


def consistency_warnings(
    line: LineSource, quantity: str, levels: dict[str, Floats]
) -> tuple[str, ...]:
    """What a person has to know before a value of a line whose columns do not hold together.

    Parameters
    ----------
    line : LineSource
        That is looked up.
    quantity : str
        What is looked up.
    levels : dict of str to ndarray
        At which, by name. [SI]

    Returns
    -------
    warnings : tuple of str
        Points where the printed numbers are impossible, columns that are wrong by z.
    """
    if quantity not in (K_AP, K_1, TIME, DASHPOT) or not line.slow_pulls:
        return ()
    refits = refitted_surfaces(line)
    found: list[str] = []
    is_impossible = False
    if quantity != TIME:
        found = [*_of_points(consistent_values(line, **levels))]
        is_impossible = bool(found)
    asked = {DASHPOT: SOLVED, K_1: (K_1,), TIME: (TIME,)}.get(quantity, ())
    for name in asked or ((K_1,) if is_impossible else ()):
        found += column_warnings(line, name, refits)
    return tuple(found)


def _of_points(values: tuple[ConsistentValues, ...]) -> tuple[str, ...]:
    """Of the points that are impossible by every slow pull, the worst."""
    if not values or not np.all([one.is_impossible for one in values], axis=0).any():
        return ()
    everywhere = np.all([one.is_impossible for one in values], axis=0)
    least = np.where(everywhere, np.min([one.excess for one in values], axis=0), -np.inf)
    worst = int(np.argmax(least))

    def of(numbers: Floats) -> str:
        return f"{plain_number(numbers.ravel()[worst], 4)} N"

    sums = " or ".join(
        f"{of(one.quasi_static_spring_constant + one.printed[K_1])} ({one.slow_pull}; "
        f"z {_shown(float((one.excess / one.excess_uncertainty).ravel()[worst]))})"
        for one in values
    )
    solved = " or ".join(of(one.dissipation_spring_constant) for one in values)
    return (
        f"the printed numbers cannot hold together at {int(everywhere.sum())} of "
        f"{everywhere.size} points: K_ap of a line is at most K_0 + K_1, and is "
        f"{of(values[0].printed[K_AP])} where K_0 + K_1 is {sums}; K_ap and H need a K_1 of "
        f"{solved}, printed is {of(values[0].printed[K_1])}",
    )


def column_warnings(
    line: LineSource, name: str, refits: tuple[RefittedSurface, ...]
) -> tuple[str, ...]:
    """A column that is wrong by every slow pull."""
    own = [one for one in refits if one.quantity == name]
    if not own or not min(one.greatest for one in own) > critical_z(line.surfaces[name]):
        return ()
    worst = own[0].worst
    unit = quantity_of(name).unit
    given = " or ".join(
        f"{plain_number(one.consistent[worst], 4)} {unit} ({one.slow_pull}; "
        f"z {_shown(abs(one.z[worst]))})"
        for one in own
    )
    return (
        f"{name} as printed does not follow from K_ap, H and K_0: B{worst + 1} is "
        f"{plain_number(own[0].printed[worst], 4)} {unit} on the page, and they give {given}",
    )


def _shown(z: float) -> str:
    return f"{z:.1f}"
