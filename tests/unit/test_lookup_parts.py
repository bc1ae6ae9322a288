"""What look-ups of two quantities share is put together by its sign before it is squared."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.lines.line_curve import own_half_width, shared_half_width, shared_of
from reduction.lines.line_lookup import look_up
from reduction.lines.line_search import compare_values
from reduction.lines.line_surface import evaluate_surface
from reduction.lines.lookup_product import LineSource, LineSurface
from reduction.record.contributions import Component
from reduction.record.errors import DataError

EXPONENTS = quadratic_exponents(3)
DESIGN = model_matrix(box_behnken(3).coded, EXPONENTS)
INVERSE = np.linalg.inv(DESIGN.T @ DESIGN)
LOW, HIGH = np.array([0.1, 100.0, 50.0]), np.array([0.5, 300.0, 150.0])
CELL, CLOCK = Component("tension_gain", "cell"), Component("lag", "clock")
AT = {"frequency": [0.2, 0.4], "mean_tension": 150.0, "tension_amplitude": 70.0}


def surface(quantity, coefficient, rows, component, *, sigma=0.0, exponent=1.0):
    return LineSurface(
        quantity, coefficient, EXPONENTS, LOW, HIGH, INVERSE, sigma, 5.0, 0.75, exponent,
        component=component, contribution=rows,
    )  # fmt: skip


def line(*surfaces):
    return LineSource(
        "rope", "a report", "nylon", "braid", "new", 0.0127, 1000.0,
        factor_names=("frequency", "mean_tension", "tension_amplitude"),
        surfaces={one.quantity: one for one in surfaces},
    )  # fmt: skip


B = np.array([1e4, 100.0, -200.0, 50.0, 300.0, 2000.0, -400.0, 20.0, -10.0, 60.0])
NAME = "apparent_spring_constant"


def test_a_gain_of_all_runs_is_that_share_of_the_value_at_every_point():
    found = look_up(line(surface(NAME, B, -0.02 * B[None], (CELL,))), NAME, **AT)
    assert found.component == (CELL,)
    assert found.contribution == pytest.approx(-0.02 * found.value[None])
    assert found.surface_high - found.value == pytest.approx(1.95996 * 0.02 * found.value, rel=1e-5)
    # nothing scatters here: all of it is shared
    assert own_half_width(found, "surface_high") == pytest.approx(0.0, abs=1e-3)


def test_on_a_logarithm_it_is_the_same_share():
    logs = np.append(np.log(1e4), np.full(9, 0.1))
    rows = np.append(np.log1p(0.02), np.zeros(9))[None]
    found = look_up(line(surface(NAME, logs, rows, (CELL,), exponent=0.0)), NAME, **AT)
    # half of 1.02 less 1/1.02: to the second order of the gain
    assert found.contribution == pytest.approx(0.02 * found.value[None], rel=0.011)


def test_what_is_of_a_value_alone_is_the_interval_without_it():
    found = look_up(line(surface(NAME, B, 0.02 * B[None], (CELL,), sigma=150.0)), NAME, **AT)
    alone = look_up(line(surface(NAME, B, np.empty((0, 10)), (), sigma=150.0)), NAME, **AT)
    for end in ("high", "surface_high"):
        expected = getattr(alone, end) - alone.value
        assert own_half_width(found, end) == pytest.approx(expected)
    assert own_half_width(alone, "low") == pytest.approx(alone.value - alone.low)
    assert shared_half_width(found.contribution) == pytest.approx(1.96 * 0.02 * found.value)


def test_a_surface_beside_a_load_cell_has_the_factor_of_all_its_degrees_of_freedom():
    """As large a part of five degrees of freedom as of a load cell: 20 of them, 2.086."""
    # in the middle of the design a third of the variance of a run
    random = 150.0 / np.sqrt(3)
    row = np.append(random, np.zeros(9))[None]
    found = look_up(
        line(surface(NAME, B, row, (CELL,), sigma=150.0)), NAME,
        frequency=0.3, mean_tension=200.0, tension_amplitude=100.0,
    )  # fmt: skip
    half = 2.0859634 * np.sqrt(2) * random
    assert found.surface_high - found.value == pytest.approx(half, rel=1e-7)
    assert found.value - found.surface_low == pytest.approx(half, rel=1e-7)
    # of a run four times the variance: (4 + 1)^2 / (16 / 5) = 7.8125, 2.3161 by the t table between
    t = stats.t.ppf(0.975, 7.8125)
    assert found.high - found.value == pytest.approx(t * np.sqrt(5) * random, rel=1e-9)


def test_a_reading_of_two_degrees_of_freedom_takes_them_into_a_surface():
    diameter = Component("diameter", "line", degrees_of_freedom=2.0)
    found = look_up(line(surface(NAME, B, 0.02 * B[None], (diameter,))), NAME, **AT)
    # Student's t of two
    half = 4.30265 * 0.02 * found.value
    assert found.surface_high - found.value == pytest.approx(half, rel=1e-5)


def test_two_surfaces_under_one_cell_differ_by_what_is_of_each_alone():
    """The load cell falls out; five degrees of freedom each are ten."""
    row = np.append(500.0, np.zeros(9))[None]
    one = look_up(line(surface(NAME, B, row, (CELL,), sigma=150.0)), NAME, **AT)
    found = compare_values(one, one)
    h = np.asarray(
        evaluate_surface(
            surface(NAME, B, row, (CELL,), sigma=150.0), [[0.2, 150.0, 70.0], [0.4, 150.0, 70.0]]
        ).leverage
    )
    assert found.surface_high == pytest.approx(2.2281389 * 150 * np.sqrt(2 * h), rel=1e-6)
    assert found.high == pytest.approx(2.2281389 * 150 * np.sqrt(2 * (1 + h)), rel=1e-6)


def test_what_k_1_gains_and_tau_loses_leaves_their_product():
    spring = surface("dissipation_spring_constant", B, np.stack([0.02 * B, 0.05 * B]), (CELL, CLOCK))  # fmt: skip
    tau = np.append(1.5, np.zeros(9))
    one = line(spring, surface("relaxation_time", tau, -0.05 * tau[None], (CLOCK,)))
    found = look_up(one, "dashpot_coefficient", **AT)
    # the lag moves K_1 up and tau down by 5 %: only the gain is left
    rows = dict(zip(found.component, found.contribution, strict=True))
    assert rows[CELL] == pytest.approx(0.02 * found.value)
    assert rows[CLOCK] == pytest.approx(0.0, abs=1e-9)
    assert found.surface_high - found.value == pytest.approx(1.96 * 0.02 * found.value, rel=1e-4)
    together = shared_of({name: look_up(one, name, **AT) for name in one.surfaces})
    assert together.component == tuple(sorted((CELL, CLOCK)))
    place = together.component.index(CELL)
    assert together.values["relaxation_time"][place].tolist() == [0.0, 0.0]


def test_contributions_without_their_errors_are_refused():
    with pytest.raises(DataError, match="do not pair up.*found 1 rows; needed 0"):
        surface(NAME, B, B[None], ())
    assert replace(surface(NAME, B, B[None], (CELL,)), sigma=1.0).component == (CELL,)
