"""Drawn lines against distributions in closed form: tau is normal in K_0, K_1 is not."""

import numpy as np
import pytest
from scipy import stats

from reduction.stages.three_parameter_line.line_model import AMPLITUDE_INPUTS, FUNDAMENTAL_INPUTS
from reduction.uncertainty.monte_carlo import N_DRAWS, _draw_line

STORED, LOST, RATE, REST = 3e4, 4e3, 0.3, 2e4
TURN = 2 * np.pi * RATE
FUNDAMENTAL = dict(
    zip(FUNDAMENTAL_INPUTS, ([STORED], [LOST], [RATE], [REST]), strict=True)
)  # fmt: skip
# of a quantile of this many draws, four times its standard deviation over u
QUANTILE = 4 * np.sqrt(0.025 * 0.975 / N_DRAWS) / stats.norm.pdf(1.96)


def drawn(values=FUNDAMENTAL, *, random=None, shared=(), freedom=9.0, reading="fundamental"):
    n_inputs = len(values)
    covariance = np.zeros((1, n_inputs, n_inputs))
    if random is not None:
        covariance[0] = random
    rows = np.array(shared, dtype=float).reshape(-1, 1, n_inputs)
    return _draw_line(
        values, reading=reading, covariance=covariance, degrees_of_freedom=[freedom],
        contribution=rows,
    )  # fmt: skip


def spring(excess):
    return excess + LOST**2 / excess


def test_an_error_of_the_slow_pull_leaves_tau_normal():
    u = 0.05 * REST
    found = drawn(shared=[0, 0, 0, 0.05])
    tau = u / LOST / TURN
    assert found.linear_standard_uncertainty[1] == pytest.approx(tau)
    assert found.standard_uncertainty[1] == pytest.approx(tau, rel=4 / np.sqrt(2 * N_DRAWS))
    centre = (STORED - REST) / LOST / TURN
    for end, way in ((found.low, -1), (found.high, 1)):
        assert end[1] == pytest.approx(centre + way * 1.96 * tau, abs=QUANTILE * tau)


def test_ends_of_k_1_are_those_of_the_excess_where_it_is_monotonic():
    u = 0.05 * REST
    found = drawn(shared=[0, 0, 0, 0.05])
    # A stays above E'' between these ends, and K_1 grows with it
    ends = [spring(STORED - REST + way * 1.96 * u) for way in (-1, 1)]
    assert found.low[0] == pytest.approx(ends[0], abs=QUANTILE * u)
    assert found.high[0] == pytest.approx(ends[1], abs=QUANTILE * u)
    assert found.is_linear.tolist() == [True]


def test_draws_below_the_slow_pull_are_counted_and_not_linear():
    u = 0.2 * REST
    found = drawn(shared=[0, 0, 0, 0.2])
    share = stats.norm.cdf(-(STORED - REST) / u)
    assert found.without_solution_share[0] == pytest.approx(share, abs=4 * np.sqrt(share / N_DRAWS))
    assert found.is_linear.tolist() == [False]
    # of a normal cut off at zero
    cut = stats.truncnorm(-(STORED - REST) / u, np.inf, loc=STORED - REST, scale=u)
    low, high = cut.ppf([0.025, 0.975]) / LOST / TURN
    assert found.low[1] == pytest.approx(low, abs=2 * QUANTILE * u / LOST / TURN)
    assert found.high[1] == pytest.approx(high, abs=2 * QUANTILE * u / LOST / TURN)
    half = np.diff(cut.ppf([0.158655, 0.841345]))[0] / 2 / LOST / TURN
    assert found.standard_uncertainty[1] == pytest.approx(half, rel=0.03)
    # the least that K_1 can be is 2 E''
    assert found.low[0] >= 2 * LOST


def test_a_gain_that_loop_and_pull_share_moves_k_1_and_not_tau():
    found = drawn(shared=[0.01, 0.01, 0, 0.01])
    assert found.standard_uncertainty[0] == pytest.approx(
        0.01 * spring(STORED - REST), rel=4 / np.sqrt(2 * N_DRAWS)
    )
    assert found.standard_uncertainty[1] < 1e-12
    assert found.low[1] == pytest.approx(found.high[1])


def test_few_cycles_widen_the_interval_and_not_the_standard_uncertainty():
    random = np.diag([0.01**2, 0, 0, 0])
    few, many = (drawn(random=random, freedom=freedom) for freedom in (3.0, 1e6))
    u = 0.01 * STORED / LOST / TURN
    assert few.standard_uncertainty[1] == many.standard_uncertainty[1]
    wide, narrow = (one.high[1] - one.low[1] for one in (few, many))
    assert wide == pytest.approx(2 * stats.t.ppf(0.975, 3) * u, rel=0.06)
    assert narrow == pytest.approx(2 * 1.96 * u, rel=0.03)


def test_correlation_of_inputs_counts():
    size = np.array([0.01 * STORED, 0.01 * LOST])
    for correlation in (-0.9, 0.9):
        random = np.zeros((4, 4))
        random[:2, :2] = 1e-4 * np.array([[1, correlation], [correlation, 1]])
        found = drawn(random=random)
        slope = np.array([1 / LOST, -(STORED - REST) / LOST**2]) / TURN * size
        wanted = np.sqrt(slope @ np.array([[1, correlation], [correlation, 1]]) @ slope)
        assert found.linear_standard_uncertainty[1] == pytest.approx(wanted)
        assert found.standard_uncertainty[1] == pytest.approx(wanted, rel=0.03)


def test_amplitude_and_area_are_drawn_too():
    apparent, amplitude = np.hypot(STORED, LOST), 600.0
    area = np.pi * amplitude**2 * LOST / apparent**2
    values = dict(
        zip(AMPLITUDE_INPUTS, ([apparent], [area], [amplitude], [RATE], [REST]), strict=True)
    )
    found = drawn(values, shared=[0, 0.01, 0, 0, 0], reading="amplitude")
    assert found.is_linear.tolist() == [True]
    # tau carries all the error of H, and E''^2/(E' A) of it more
    excess = STORED - REST
    wanted = 0.01 * (1 + LOST**2 / STORED / excess) * excess / LOST / TURN
    assert found.linear_standard_uncertainty[1] == pytest.approx(wanted)
    assert found.standard_uncertainty[1] == pytest.approx(wanted, rel=0.03)


def test_equal_inputs_give_equal_draws_and_specimens_do_not_touch_each_other():
    one = drawn(shared=[0, 0, 0, 0.05])
    two = _draw_line(
        {name: value * 2 for name, value in FUNDAMENTAL.items()}, reading="fundamental",
        covariance=np.zeros((2, 4, 4)), degrees_of_freedom=[9.0, 9.0],
        contribution=np.array([[[0, 0, 0, np.nan], [0, 0, 0, 0.05]]]),
    )  # fmt: skip
    assert two.low[:, 1].tolist() == one.low[:, 0].tolist()
    assert np.isnan(two.low[:, 0]).all() and not two.is_linear[0]


def test_a_line_that_has_no_solution_itself_is_not_drawn():
    found = drawn(FUNDAMENTAL | {"quasi_static_spring_constant": [2 * STORED]}, shared=[0.1] * 4)
    assert np.isnan(found.standard_uncertainty).all()
    assert np.isnan(found.without_solution_share).all()
