"""Uncertainty of the line of a test: linear where Monte Carlo agrees, else Monte Carlo."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from reduction.cycles.product import Loops
from reduction.line.product import LineParameters
from reduction.line.scatter import covariance_of_means, relative_deviations
from reduction.line.sensitivity import AMPLITUDE_INPUTS, FUNDAMENTAL_INPUTS
from reduction.product import ReducedTest
from reduction.record import Floats
from reduction.settings import CycleSettings
from reduction.uncertainty.combine import (
    combined_standard_uncertainty,
    coverage_factor,
    effective_degrees_of_freedom,
)
from reduction.uncertainty.montecarlo import PARAMETERS, LineDraws, draw_line
from reduction.uncertainty.product import LINE_METHODS, LineSpread


def with_line_spread(test: ReducedTest, cycles: CycleSettings) -> ReducedTest:
    """Put the uncertainty of its line, by the propagation that holds, to a test.

    Parameters
    ----------
    test : ReducedTest
        With the contributions of shared errors, where any are stated.
    cycles : CycleSettings
        Break-in.

    Returns
    -------
    test : ReducedTest
        With ``line_spread`` and notes; as it was where it has no line.
    """
    line, loops = test.line_of_test, test.loops
    if line is None or loops is None or not (line.reason == 0).any():
        return test
    draws, freedom = _drawn(test, line, loops, cycles.break_in_cycles)
    is_given = np.isfinite(draws.standard_uncertainty).all(axis=0)
    method = np.where(draws.is_linear, LINE_METHODS["linear"], LINE_METHODS["monte_carlo"])
    method = np.where(is_given, method, LINE_METHODS["not_given"])
    spreads: dict[str, Floats] = {}
    low: dict[str, Floats] = {}
    high: dict[str, Floats] = {}
    for row, name in enumerate(PARAMETERS):
        random = line.random_uncertainty[name]
        shared = _shared(test, line, name)
        linear = combined_standard_uncertainty(shared, random)
        half = linear * coverage_factor(
            effective_degrees_of_freedom(random, freedom, contribution=shared)
        )
        value = getattr(line, name)
        chosen = [method == LINE_METHODS[one] for one in ("linear", "monte_carlo")]
        for found, pair in (
            (spreads, (linear, draws.standard_uncertainty[row])),
            (low, (value - half, draws.low[row])),
            (high, (value + half, draws.high[row])),
        ):
            found[name] = np.select(chosen, pair, np.nan)
    spread = LineSpread(method, draws.without_solution_share, spreads, low, high)
    notes = [
        _note(test.specimens[place].name, draws, int(place))
        for place in np.flatnonzero(method == LINE_METHODS["monte_carlo"])
    ]
    return replace(test, line_spread=spread, line_notes=(*test.line_notes, *notes))


def _drawn(
    test: ReducedTest, line: LineParameters, loops: Loops, break_in_cycles: int
) -> tuple[LineDraws, Floats]:
    """Draws of each specimen, and the degrees of freedom of what is random in it."""
    reading: Literal["amplitude", "fundamental"] = (
        "fundamental" if line.reading == "fundamental" else "amplitude"
    )
    names = FUNDAMENTAL_INPUTS if reading == "fundamental" else AMPLITUDE_INPUTS
    means, deviations = relative_deviations(loops, names[:-1], break_in_cycles=break_in_cycles)
    of_means, freedom = covariance_of_means(deviations)
    rest = line.quasi_static_spring_constant
    values = dict(zip(names, (*means, rest), strict=True))
    # K_0 is the pull's: nothing of it scatters from cycle to cycle
    covariance = np.pad(of_means, ((0, 0), (0, 1), (0, 1)))
    shared = [
        _shared(test, line, name) / value
        for name, value in values.items()
    ]  # fmt: skip
    n_components = max(len(rows) for rows in shared)
    contribution = np.stack(
        [np.broadcast_to(rows, (n_components, rest.size)) for rows in shared], axis=-1
    )
    draws = draw_line(
        values, reading=reading, covariance=covariance, degrees_of_freedom=freedom,
        contribution=contribution,
    )  # fmt: skip
    return draws, freedom


def _shared(test: ReducedTest, line: LineParameters, name: str) -> Floats:
    """Contributions of shared errors to a quantity of the test, shape (n_components, ...)."""
    stated = test.contributions
    if stated is not None and f"test_{name}" in stated.values:
        return stated.values[f"test_{name}"]
    if stated is None and name in line.shared_uncertainty:
        return line.shared_uncertainty[name][None]
    if stated is None and name == "quasi_static_spring_constant":
        spread = test.quasi_static_standard_uncertainty
        if spread is not None:
            return spread[None]
    return np.zeros((1, line.reason.size))


def _note(specimen: str, draws: LineDraws, place: int) -> str:
    share = draws.without_solution_share[place]
    if share > 0:
        reason = (
            f"{share:.2g} of the draws of loop and slow pull have no K_1 and tau, and the interval "
            "is that of the others"
        )
    else:
        first = draws.linear_standard_uncertainty[:, place]
        with np.errstate(divide="ignore"):
            ratio = draws.standard_uncertainty[:, place] / first
        worst = int(np.argmax(np.abs(np.log(np.maximum(ratio, 1e-300)))))
        words = ("K_1", "tau", "K_1 tau")
        reason = f"the linear one of {words[worst]} is {1 / ratio[worst]:.2f} of it"
    return (
        f"{specimen}: K_1 and tau: uncertainty and 95 % interval are by Monte Carlo, where linear "
        f"propagation does not hold: {reason}"
    )
