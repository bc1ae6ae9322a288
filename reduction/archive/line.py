"""The three-parameter line and the slow pull: their variables, and the values of a product."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import chain

import numpy as np
from numpy.typing import ArrayLike

from reduction.archive.reasons import AXIS, BOUND, MOVEMENT, PART, SETTING, SPREAD, STATED
from reduction.archive.values import Values, texts
from reduction.archive.variable import Variable, count, flag, label, measured, stated
from reduction.line.product import LineParameters, SlowPull
from reduction.line.pullgrid import BREAK_SHARES, tension_grid
from reduction.line.quasistatic import (
    quasi_static_spring_constant,
    strain_at_break_share,
    strain_at_tension,
)
from reduction.record import Floats, Specimen
from reduction.uncertainty.product import LINE_METHODS, LineSpread

LINE_REFUSALS = {
    "given": 0,
    "quasi_static_unknown": 1,
    "quasi_static_not_positive": 2,
    "reading_missing": 3,
    "reading_not_positive": 4,
    "loss_reaches_apparent": 5,
    "storage_not_above_quasi_static": 6,
}
"""Meanings of the codes of `reduction.line.product.REASONS`, as a flag has them."""

_LINE = ("dissipation_spring_constant", "relaxation_time", "dashpot_coefficient")
_S = ("specimen",)
_C = ("specimen", "cycle")
_T = ("specimen", "tension_grid")
_P = ("specimen", "pull_term")

LINE_ROWS: tuple[Variable, ...] = tuple(
    chain(
        chain.from_iterable(measured(name, _C) for name in _LINE),
        flag("line_refusal", _C, LINE_REFUSALS),
        measured("test_quasi_static_spring_constant", _S),
        chain.from_iterable(measured(f"test_{name}", _S) for name in _LINE),
        stated("test_line_conditioning", _S, "a sensitivity"),
        flag("test_line_refusal", _S, LINE_REFUSALS),
        flag("test_line_uncertainty_method", _S, LINE_METHODS),
        stated("test_line_without_solution_share", _S, PART),
        chain.from_iterable(
            stated(f"test_{name}_{end}", _S, BOUND) for name in _LINE for end in ("low", "high")
        ),
        stated("tension_grid", ("tension_grid",), AXIS),
        measured("quasi_static_spring_constant", _T),
        measured("quasi_static_strain", _T),
        count("pull_term", ("pull_term",)),
        measured("pull_strain_coefficient", _P),
        stated("pull_spring_constant_coefficient", _P, "a re-expression of the load-strain cubic"),
        stated("pull_tension_low", _S, BOUND),
        stated("pull_tension_high", _S, BOUND),
        stated("pull_strain_rate", _S, MOVEMENT),
        stated("pull_waiting_time", _S, STATED),
        label("pull_waiting", _S),
        stated("pull_residual", _S, SPREAD),
        stated("pull_reference_tension", _S, STATED),
        stated("break_share", ("break_share",), SETTING),
        measured("strain_at_break_share", ("specimen", "break_share")),
    )
)


def line_values(
    cycles: LineParameters, test: LineParameters, constant_spread: Floats | None
) -> Values:
    """Return parameters of each cycle and of the test, with the uncertainty of its K_0."""
    values: Values = {
        "line_refusal": cycles.reason,
        "test_line_refusal": test.reason,
        "test_line_conditioning": test.conditioning,
        "test_quasi_static_spring_constant": test.quasi_static_spring_constant,
    }
    if constant_spread is not None:
        values["test_quasi_static_spring_constant_standard_uncertainty"] = constant_spread
    for name in _LINE:
        values[name] = getattr(cycles, name)
        values[f"{name}_standard_uncertainty"] = cycles.uncertainty[name]
        values[f"test_{name}"] = getattr(test, name)
        values[f"test_{name}_standard_uncertainty"] = test.uncertainty[name]
    return values


def random_of_line(cycles: LineParameters, test: LineParameters) -> Values:
    """Return what is random in lines of cycles and test: the fit of a slow pull is shared."""
    names = {name: cycles.random_uncertainty[name] for name in _LINE}
    names |= {f"test_{name}": test.random_uncertainty[name] for name in _LINE}
    constant = test.quasi_static_spring_constant
    return names | {"test_quasi_static_spring_constant": np.where(np.isnan(constant), np.nan, 0.0)}


def spread_of_line_values(spread: LineSpread, values: Values) -> Values:
    """Return interval and method of the line of a test, and its uncertainty where drawn."""
    found: Values = {
        "test_line_uncertainty_method": spread.method,
        "test_line_without_solution_share": spread.without_solution_share,
    }
    drawn = spread.method == LINE_METHODS["monte_carlo"]
    for name in _LINE:
        key = f"test_{name}_standard_uncertainty"
        found[key] = np.where(drawn, spread.standard_uncertainty[name], values[key])
        found[f"test_{name}_low"] = spread.low[name]
        found[f"test_{name}_high"] = spread.high[name]
    return found


def pull_values(pulls: tuple[SlowPull | None, ...], specimens: tuple[Specimen, ...]) -> Values:
    """Return the slow pull of each specimen on one grid of tension; NaN where one has none."""
    given = [one for one in pulls if one is not None]
    if not given:
        return {}
    grid = tension_grid(pulls)
    values: Values = {"tension_grid": grid, "pull_term": np.arange(4)}
    values |= _on_axis("quasi_static_spring_constant", pulls, quasi_static_spring_constant, grid)
    values |= _on_axis("quasi_static_strain", pulls, strain_at_tension, grid)
    columns: dict[str, Callable[[SlowPull], ArrayLike]] = {
        "pull_strain_coefficient": lambda one: one.strain_coefficient,
        "pull_strain_coefficient_standard_uncertainty": lambda one: np.sqrt(
            np.diag(one.strain_coefficient_covariance)
        ),
        "pull_spring_constant_coefficient": lambda one: one.polynomial_coefficient,
        "pull_tension_low": lambda one: one.tension_low,
        "pull_tension_high": lambda one: one.tension_high,
        "pull_strain_rate": lambda one: one.strain_rate,
        "pull_waiting_time": lambda one: one.waiting_time,
        "pull_residual": lambda one: one.residual_deviation,
        "pull_reference_tension": lambda one: one.reference_tension,
    }
    for name, column in columns.items():
        missing = np.full(np.shape(column(given[0])), np.nan)
        values[name] = np.array([missing if one is None else column(one) for one in pulls])
    values["pull_waiting"] = texts(["" if one is None else one.waiting for one in pulls])
    strengths = [specimen.rated_break_strength for specimen in specimens]
    if any(strengths):
        shares = np.array(BREAK_SHARES)
        at_share = [
            (np.full(shares.size, np.nan),) * 2
            if one is None or strength is None
            else strain_at_break_share(one, shares, rated_break_strength=strength)
            for one, strength in zip(pulls, strengths, strict=True)
        ]
        values |= _both("strain_at_break_share", at_share) | {"break_share": shares}
    return values


def _on_axis(
    name: str,
    pulls: tuple[SlowPull | None, ...],
    function: Callable[[SlowPull, ArrayLike], tuple[Floats, Floats]],
    axis: Floats,
) -> Values:
    missing = np.full(axis.size, np.nan)
    return _both(
        name, [(missing, missing) if one is None else function(one, axis) for one in pulls]
    )


def _both(name: str, pairs: Sequence[tuple[Floats, ...]]) -> Values:
    return {
        name: np.array([pair[0] for pair in pairs]),
        f"{name}_standard_uncertainty": np.array([pair[1] for pair in pairs]),
    }
