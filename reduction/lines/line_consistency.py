r"""Consistency of K_ap, H, K_0, K_1 and tau of a line, and the consistent values.

A spring K_0 beside a Maxwell element has an apparent spring constant between K_0 and K_0 + K_1,
whatever its relaxation time and the frequency.  The surfaces of a report are fitted one by one,
which does not ensure this.  K_ap and H are measured in every run, K_0 in a slow pull; K_1 and tau
were solved from them.  Solving again, in closed form, gives the K_1 and tau that belong to the
printed K_ap and H, and a quadratic through them gives the coefficients that should be printed:

.. math:: b' = (X^T X)^{-1} X^T g(X b_{K_{ap}}, X b_H, K_0), \qquad
          z_j = \frac{b_j - b'_j}{s \sqrt{[(X^T X)^{-1}]_{jj}}}

with s from the r2 printed with the column.  The report refitted values solved from runs; here they
are solved from fitted K_ap and H.  The scatter of the runs about these is, to first order,
orthogonal to the quadratic, so the two agree better than s says, and z is rather too small.  z is
Student's t with the five degrees of freedom of s; one of ten coefficients exceeds 4.77 in 5 % of
such columns.

For the surfaces of a campaign the runs are known, and so is the interval of each at a point.  Here
K_1 and tau of their own surfaces are compared with those from K_ap, H and K_0, by the interval of
the difference, in which errors common to all enter with their signs.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eqs. 1, 4, 5, sec. 4.3, A-3.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.experiments.designs import box_behnken, model_matrix
from reduction.lines.bent_loops import share_of_slope
from reduction.lines.line_curve import evaluate_curve, half_width_of_parts
from reduction.lines.line_surface import SurfacePoints, evaluate_surface
from reduction.lines.lookup_product import LineSource, LineSurface
from reduction.quantities.digits import plain_number
from reduction.quantities.names import quantity as quantity_of
from reduction.record.contributions import Component, Contributions, merged
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays
from reduction.stages.three_parameter_line.line_model import identify_by_amplitude
from reduction.stages.three_parameter_line.line_product import LineParameters

K_AP, ENERGY, K_0, K_1, TIME, DASHPOT = (
    "apparent_spring_constant", "hysteresis_energy", "quasi_static_spring_constant",
    "dissipation_spring_constant", "relaxation_time", "dashpot_coefficient",
)  # fmt: skip

SOLVED = (K_1, TIME)

_NORMAL = 1.96

_OF_ALL_COEFFICIENTS = 0.05
"""Share of correct columns in which one coefficient is called wrong. [1]"""


@dataclass(frozen=True)
@read_only_arrays
class ConsistentValues:
    """A line at points, as printed and made consistent; arrays have one shape (...).

    Parameters
    ----------
    slow_pull : str
        K_0 that was used, in words.
    of_surfaces : dict of str to ndarray
        K_ap, H, K_1 and tau, where the line has surfaces of them. [N], [J m-1], [s]
    quasi_static_spring_constant : ndarray
        K_0 of that slow pull at the mean tension, or over the cycle where the loops of the runs are
        bent. [N]
    dissipation_spring_constant, relaxation_time : ndarray
        Solved from the K_ap and H of the surfaces; NaN where there is no solution. [N], [s]
    excess : ndarray
        K_ap less K_0 and K_1 of the surfaces: impossible above zero; NaN without K_1. [N]
    excess_uncertainty : ndarray
        Its standard uncertainty, from the surfaces alone. [N]
    half_width : dict of str to ndarray
        95 % half width of the difference between surface and solution, for K_1 and tau; empty for a
        line of which only the coefficients are printed. [N], [s]
    reason : ndarray of int
        Why there is no solution: `reduction.stages.three_parameter_line.line_product.REASONS`.
    """

    slow_pull: str
    of_surfaces: dict[str, Floats]
    quasi_static_spring_constant: Floats
    dissipation_spring_constant: Floats
    relaxation_time: Floats
    excess: Floats
    excess_uncertainty: Floats
    half_width: dict[str, Floats]
    reason: Integers

    @property
    def is_impossible(self) -> Bools:
        """K_ap above the sum of K_0 and K_1 of the surfaces."""
        return np.asarray(self.excess > 0)

    @property
    def is_contradicted(self) -> Bools:
        """The same by more than its 95 % half width; by any amount if that is unknown."""
        half = _NORMAL * np.nan_to_num(self.excess_uncertainty)
        return np.asarray(self.excess > half)

    def is_apart(self, name: str) -> Bools:
        """Whether K_1 or tau of its surface is outside the interval about the solution."""
        if name not in self.half_width:
            return np.zeros(self.reason.shape, dtype=bool)
        return np.asarray(
            np.abs(self.of_surfaces[name] - getattr(self, name)) > self.half_width[name]
        )


@dataclass(frozen=True)
@read_only_arrays
class _RefittedSurface:
    """The coefficients of one column beside those that follow from the other columns.

    Parameters
    ----------
    quantity : str
        K_1 or tau.
    slow_pull : str
        K_0 that was used, in words.
    printed, consistent : ndarray, shape (10,)
        B1 .. B10 as printed, and fitted to the solutions. [SI unit of the quantity]
    z : ndarray, shape (10,)
        Their difference over the standard error from the printed r2; NaN where r2 is open. [1]
    """

    quantity: str
    slow_pull: str
    printed: Floats
    consistent: Floats
    z: Floats

    @property
    def worst(self) -> int:
        """Index of the coefficient with the greatest z."""
        return 0 if np.isnan(self.z).all() else int(np.nanargmax(np.abs(self.z)))

    @property
    def greatest(self) -> float:
        """That greatest z; NaN where r2 is open."""
        return float(abs(self.z[self.worst]))


def is_of_loads(levels: Collection[str]) -> bool:
    """Whether slow pull and loops of a rope are comparable at these levels."""
    return set(levels) == {"frequency", "mean_tension", "tension_amplitude"}


def consistent_values(
    line: LineSource,
    *,
    frequency: ArrayLike,
    mean_tension: ArrayLike,
    tension_amplitude: ArrayLike,
) -> tuple[ConsistentValues, ...]:
    """Values of a line at points by its surfaces, and K_1 and tau consistent with its K_ap and H.

    Parameters
    ----------
    line : LineSource
        With surfaces of K_ap and H for sinusoids and its slow pulls; others give no values.
    frequency, mean_tension, tension_amplitude : array_like, shape (...)
        Broadcast together. [Hz], [N], [N]

    Returns
    -------
    values : tuple of ConsistentValues
        One for each slow pull; for an open coefficient, its first value is used.

    Notes
    -----
    K_1 and tau by `identify_by_amplitude` at the point itself, so that K_ap is between K_0 and
    K_0 + K_1 wherever there is a solution.

    Examples
    --------
    Plaited nylon at 0.3 Hz, 1728 and 489.6 lbf: the printed K_ap is 45,100 lbf; K_1, 25,000 lbf,
    and the 15,592 lbf of the slow pull are too little for it.

    >>> from reduction.lines.published_source import published_sources
    >>> line = published_sources()["nylon-8-strand-plaited-0.5in-new"]
    >>> values, _ = consistent_values(line, frequency=0.3,
    ...     mean_tension=1728 * 4.4482216, tension_amplitude=489.6 * 4.4482216)
    >>> print(round(float(values.excess) / 4.4482216, -1), bool(values.is_impossible))
    4490.0 True
    """
    if line.by_fundamental or not ({K_AP, ENERGY} <= line.surfaces.keys() and line.slow_pulls):
        return ()
    rate, mean, amplitude = np.broadcast_arrays(
        *(np.asarray(one, dtype=np.float64) for one in (frequency, mean_tension, tension_amplitude))
    )
    shape = rate.shape
    levels = {"frequency": rate, "mean_tension": mean, "tension_amplitude": amplitude}
    at = np.stack([levels[name].ravel() for name in line.factor_names], axis=1)
    points = {
        name: evaluate_surface(line.surfaces[name], at)
        for name in (K_AP, ENERGY, *SOLVED)
        if name in line.surfaces
    }
    columns = {name: one.value.reshape(shape) for name, one in points.items()}
    spread = {name: one.random.reshape(shape) for name, one in points.items()}
    nothing = np.full(shape, np.nan)
    found = []
    for label, curve in line.slow_pulls.items():
        pull = evaluate_curve(curve, mean)
        # a printed curve is shown up to the end of its printed range
        rest = pull.value if line.is_printed else np.where(pull.is_inside, pull.value, np.nan)
        share = np.ones(shape)
        if curve.loop_bend:
            share = share_of_slope(
                curve, mean_tension=mean, tension_amplitude=amplitude,
                apparent_spring_constant=columns[K_AP], hysteresis_energy=columns[ENERGY],
            )  # fmt: skip
            rest = share * rest

        def solve(apparent: Floats, energy: Floats, rest: Floats) -> LineParameters:
            return identify_by_amplitude(
                apparent_spring_constant=apparent,
                hysteresis_energy=energy,
                tension_amplitude=amplitude,
                frequency=rate,
                quasi_static_spring_constant=rest,
            )

        inputs = (columns[K_AP], columns[ENERGY], rest)
        solved = solve(*inputs)
        half = {}
        if not line.is_printed:
            parts = [
                _part(line, points, K_AP, shape),
                _part(line, points, ENERGY, shape),
                _Part(
                    curve.component,
                    share * pull.contribution,
                    np.hypot(share * pull.random, curve.loop_bend_misfit * rest),
                    pull.freedom,
                ),
            ]
            half = {
                name: _half_of_difference(
                    [(_slope(solve, name, inputs, place), one) for place, one in enumerate(parts)]
                    + [(np.full(shape, -1.0), _part(line, points, name, shape))]
                )
                for name in SOLVED
                if name in points
            }
        found.append(
            ConsistentValues(
                slow_pull=label,
                of_surfaces=columns,
                quasi_static_spring_constant=rest,
                dissipation_spring_constant=solved.dissipation_spring_constant,
                relaxation_time=solved.relaxation_time,
                excess=columns[K_AP] - rest - columns.get(K_1, nothing),
                excess_uncertainty=np.hypot(spread[K_AP], spread.get(K_1, nothing)),
                half_width=half,
                reason=np.asarray(solved.reason),
            )
        )
    return tuple(found)


class _Part(NamedTuple):
    """Uncertainty of one number at points: errors that it shares with others, and its own."""

    component: tuple[Component, ...]
    contribution: Floats
    random: Floats
    freedom: Floats


def _part(
    line: LineSource, points: Mapping[str, SurfacePoints], name: str, shape: tuple[int, ...]
) -> _Part:
    component, at = line.surfaces[name].component, points[name]
    return _Part(
        component,
        at.contribution.reshape(len(component), *shape),
        at.random.reshape(shape),
        at.random_freedom.reshape(shape),
    )


_STEP = 1e-4


def _slope(
    solve: Callable[..., LineParameters], name: str, inputs: tuple[Floats, ...], place: int
) -> Floats:
    """Derivative of a solved number with respect to one of its inputs."""
    up, down = (
        getattr(solve(*(one * (1 + side * (k == place)) for k, one in enumerate(inputs))), name)
        for side in (_STEP, -_STEP)
    )
    return np.asarray((up - down) / (2 * _STEP * inputs[place]))


def _half_of_difference(parts: Sequence[tuple[Floats, _Part]]) -> Floats:
    """Half width of the 95 % interval of a weighted sum; NaN where a part is unknown."""
    together = merged(
        [
            Contributions(one.component, {str(place): one.contribution})
            for place, (_, one) in enumerate(parts)
        ]
    )
    rows = sum(weight * together.values[str(place)] for place, (weight, _) in enumerate(parts))
    return half_width_of_parts(
        np.stack([np.abs(weight) * one.random for weight, one in parts]),
        np.stack([one.freedom for _, one in parts]),
        rows,
        together.degrees_of_freedom,
    )


def refitted_surfaces(line: LineSource) -> tuple[_RefittedSurface, ...]:
    """Printed K_1 and tau of a line, compared with a quadratic through the solutions.

    One for each slow pull and each of K_1 and tau that is printed; runs without a solution are left
    out, and there is no fit where too few are left.

    Notes
    -----
    See the module docstring for z.

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
    if not (line.is_printed and {K_AP, ENERGY} <= line.surfaces.keys()):
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
                _RefittedSurface(
                    quantity=name,
                    slow_pull=values.slow_pull,
                    printed=surface.coefficient,
                    consistent=refit,
                    z=(surface.coefficient - refit) / error,
                )
            )
    return tuple(found)


def critical_z(surface: LineSurface) -> float:
    """Greatest z that a correct column exceeds in one of twenty cases only.

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
    """Warnings about a value of a line whose columns are inconsistent.

    Points where the printed numbers contradict each other, and columns that are wrong by z.
    """
    if quantity not in (K_AP, K_1, TIME, DASHPOT) or not (line.slow_pulls and is_of_loads(levels)):
        return ()
    if not line.is_printed:
        asked = {DASHPOT: SOLVED, TIME: (TIME,)}.get(quantity, (K_1,))
        values = consistent_values(line, **levels)
        return tuple(text for name in asked for text in _of_surfaces(values, name))
    refits = refitted_surfaces(line)
    found: list[str] = []
    is_contradicted = False
    if quantity != TIME:
        found = [*_of_points(consistent_values(line, **levels))]
        is_contradicted = bool(found)
    asked = {DASHPOT: SOLVED, K_1: (K_1,), TIME: (TIME,)}.get(quantity, ())
    for name in asked or ((K_1,) if is_contradicted else ()):
        found += column_warnings(line, name, refits)
    return tuple(found)


def _of_surfaces(values: tuple[ConsistentValues, ...], name: str) -> tuple[str, ...]:
    """Worst of the points where K_1 or tau differs for every slow pull."""
    if not values:
        return ()
    everywhere = np.all([one.is_apart(name) for one in values], axis=0)
    if not everywhere.any():
        return ()
    first = values[0]
    off = np.abs(first.of_surfaces[name] - getattr(first, name)) / first.half_width[name]
    worst = int(np.argmax(np.where(everywhere, off, -np.inf)))
    unit = quantity_of(name).unit
    solved = " or ".join(
        f"{plain_number(getattr(one, name).ravel()[worst], 4)} {unit} ({one.slow_pull}; the 95 % "
        f"interval about it is +-{plain_number(one.half_width[name].ravel()[worst], 2)} {unit})"
        for one in values
    )
    own = plain_number(first.of_surfaces[name].ravel()[worst], 4)
    return (
        f"the surfaces are inconsistent at {int(everywhere.sum())} of {everywhere.size} "
        f"points: {name} of its own surface is {own} {unit}, and K_ap, H and K_0 give {solved}",
    )


def _of_points(values: tuple[ConsistentValues, ...]) -> tuple[str, ...]:
    """Worst of the points that are contradicted for every slow pull."""
    if not values or not np.all([one.is_contradicted for one in values], axis=0).any():
        return ()
    everywhere = np.all([one.is_contradicted for one in values], axis=0)
    least = np.where(everywhere, np.min([one.excess for one in values], axis=0), -np.inf)
    worst = int(np.argmax(least))

    def of(numbers: Floats) -> str:
        return f"{plain_number(numbers.ravel()[worst], 4)} N"

    def lower_by(one: ConsistentValues) -> str:
        z = float((one.excess / one.excess_uncertainty).ravel()[worst])
        # unknown where the page has no scatter of a surface
        return f"; {_shown(z)} standard errors lower" if np.isfinite(z) else ""

    sums = " or ".join(
        f"{of(one.quasi_static_spring_constant + one.of_surfaces[K_1])} ({one.slow_pull}"
        f"{lower_by(one)})"
        for one in values
    )
    solved = " or ".join(of(one.dissipation_spring_constant) for one in values)
    return (
        f"the printed numbers are inconsistent at {int(everywhere.sum())} of "
        f"{everywhere.size} points: K_ap cannot exceed K_0 + K_1, but is printed as "
        f"{of(values[0].of_surfaces[K_AP])} where K_0 + K_1 is {sums}; K_ap and H need a K_1 of "
        f"{solved}, printed is {of(values[0].of_surfaces[K_1])}",
    )


def column_warnings(
    line: LineSource, name: str, refits: tuple[_RefittedSurface, ...]
) -> tuple[str, ...]:
    """A column that is wrong for every slow pull."""
    own = [one for one in refits if one.quantity == name]
    if not own or not min(one.greatest for one in own) > critical_z(line.surfaces[name]):
        return ()
    worst = own[0].worst
    unit = quantity_of(name).unit
    given = " or ".join(
        f"{plain_number(one.consistent[worst], 4)} {unit} ({one.slow_pull};"
        f" {_shown(abs(one.z[worst]))} standard errors away)"
        for one in own
    )
    return (
        f"{name} as printed does not follow from K_ap, H and K_0: B{worst + 1} is "
        f"{plain_number(own[0].printed[worst], 4)} {unit} on the page, and they give {given}",
    )


def _shown(z: float) -> str:
    return f"{z:.1f}"
