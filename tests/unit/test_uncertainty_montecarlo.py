"""Drawn lines against distributions in closed form: tau is normal in K_0, K_1 is not."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy import stats

from reduction.archive.test_variables import spread_of_line_values
from reduction.record.contributions import Component, Contributions
from reduction.record.measurement import Specimen
from reduction.record.settings import CycleSettings
from reduction.stages.cycles.cycle_product import Loops
from reduction.stages.reduced_test import ReducedTest, TestDescription
from reduction.stages.three_parameter_line.line_model import AMPLITUDE_INPUTS, FUNDAMENTAL_INPUTS
from reduction.stages.three_parameter_line.line_of_loops import identify_run
from reduction.uncertainty.monte_carlo import N_DRAWS, _draw_line, with_line_spread

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


# the uncertainty of a line of a test: which propagation is stated, and what is noted

STORED_OF_SHARED_MONTECARLO, LOST_OF_SHARED_MONTECARLO, RATE_OF_SHARED_MONTECARLO = 3e4, 4e3, 0.3
NAMES = ("dissipation_spring_constant", "relaxation_time", "dashpot_coefficient")


def reduced(rest, spread, *, scatter=0.001, contributions=None, n_cycles=8):
    """A test of two specimens whose loops are alike but for K_0."""
    rng = np.random.default_rng(5)
    shape = (2, n_cycles)
    own = {name: np.ones(shape) for name in Loops.__dataclass_fields__ if name != "uncertainty"}
    # no turn lies between two readings
    own |= {name: np.zeros(shape) for name in own if name.endswith("_turn_missed")}
    own |= {
        "storage_spring_constant": STORED_OF_SHARED_MONTECARLO
        * (1 + scatter * rng.normal(size=shape)),
        "loss_spring_constant": LOST_OF_SHARED_MONTECARLO * (1 + scatter * rng.normal(size=shape)),
        "frequency": np.full(shape, RATE_OF_SHARED_MONTECARLO),
    }
    loops = Loops(**own, uncertainty={})
    spread = np.asarray(spread, dtype=float)
    line = identify_run(
        loops, quasi_static_spring_constant=rest, quasi_static_standard_uncertainty=spread,
        reading="fundamental",
    )  # fmt: skip
    return ReducedTest(
        description=TestDescription("c", "T", "cyclic", "load", "triangular", 1, {}),
        specimens=(Specimen("one"), Specimen("two")), record=None, sources=(), stage_lines=(),
        settings_json="{}", notes=(), loops=loops, line_of_test=line,
        quasi_static_standard_uncertainty=spread, contributions=contributions,
    )  # fmt: skip


def test_a_line_well_above_its_pull_is_linear_and_one_near_it_is_not():
    test = with_line_spread(reduced([1.5e4, 2.6e4], [200.0, 2e3]), CycleSettings())
    spread, line = test.line_spread, test.line_of_test
    assert spread.method.tolist() == [1, 2]
    assert spread.without_solution_share[0] == 0
    # E' - K_0 is 2.0 of its own standard uncertainty
    assert spread.without_solution_share[1] == pytest.approx(stats.norm.cdf(-2.0), abs=0.006)
    assert len(test.line_notes) == 1
    assert str(test.line_notes[0]).startswith(
        "two: K_1 and tau: uncertainty and 95 % interval are by"
    )
    assert "of the draws of loop and slow pull has no K_1 and tau" in str(test.line_notes[0])
    for name in NAMES:
        value, u = getattr(line, name)[0], line.uncertainty[name][0]
        assert spread.standard_uncertainty[name][0] == pytest.approx(u)
        assert (spread.low[name] + spread.high[name])[0] / 2 == pytest.approx(value)
    # the scatter of the cycles is small beside K_0
    assert spread.high[NAMES[1]][0] - line.relaxation_time[0] == pytest.approx(
        1.96 * line.uncertainty[NAMES[1]][0], rel=0.02
    )


def test_where_k_1_is_least_first_order_is_said_to_miss():
    test = with_line_spread(
        reduced(
            [STORED_OF_SHARED_MONTECARLO - LOST_OF_SHARED_MONTECARLO, 1.5e4],
            [600.0, 200.0],
            scatter=1e-4,
        ),
        CycleSettings(),
    )
    assert test.line_spread.method.tolist() == [2, 1]
    assert "linear uncertainty of K_1 is 0.0" in str(test.line_notes[0])
    assert test.line_spread.low[NAMES[0]][0] == pytest.approx(
        2 * LOST_OF_SHARED_MONTECARLO, rel=0.001
    )


def test_shared_errors_of_a_campaign_are_drawn_too():
    gain = {
        f"test_{name}": 0.03 * value * np.ones((1, 2))
        for name, value in (
            ("storage_spring_constant", STORED_OF_SHARED_MONTECARLO), ("loss_spring_constant", LOST_OF_SHARED_MONTECARLO),
            ("quasi_static_spring_constant", np.array([1.5e4, 1.6e4])),
        )
    }  # fmt: skip
    plain = reduced([1.5e4, 1.6e4], [0.0, 0.0])
    gain |= {
        f"test_{name}": 0.03 * getattr(plain.line_of_test, name)[None] * scale
        for name, scale in zip(NAMES, (1, 0, 1), strict=True)
    }
    shared = Contributions((Component("tension_gain", "cell"),), gain)
    test = with_line_spread(
        reduced([1.5e4, 1.6e4], [0.0, 0.0], contributions=shared), CycleSettings()
    )
    assert test.line_spread.method.tolist() == [1, 1]
    line = test.line_of_test
    wanted = np.hypot(0.03 * line.dissipation_spring_constant, line.random_uncertainty[NAMES[0]])
    assert test.line_spread.standard_uncertainty[NAMES[0]] == pytest.approx(wanted)
    assert test.line_spread.standard_uncertainty[NAMES[1]] == pytest.approx(
        line.random_uncertainty[NAMES[1]]
    )


def test_two_cycles_say_nothing_of_scatter():
    test = with_line_spread(reduced([1.5e4] * 2, [200.0] * 2, n_cycles=2), CycleSettings())
    assert test.line_spread.method.tolist() == [0, 0]
    assert np.isnan(test.line_spread.low[NAMES[0]]).all()
    assert test.line_notes == ()


def test_a_test_without_a_line_stays_as_it_is():
    test = reduced([4e4, np.nan], [200.0, np.nan])
    assert with_line_spread(test, CycleSettings()) is test


def test_an_archive_states_the_drawn_uncertainty_where_it_is_drawn():
    two = np.array([1.0, 2.0])
    spread = SimpleNamespace(
        method=np.array([1, 2]), without_solution_share=np.zeros(2),
        **{part: dict.fromkeys(NAMES, 10 * two) for part in ("standard_uncertainty", "low", "high")},
    )  # fmt: skip
    found = spread_of_line_values(
        spread, {f"test_{name}_standard_uncertainty": two for name in NAMES}
    )
    assert found["test_relaxation_time_standard_uncertainty"].tolist() == [1.0, 20.0]
    assert found["test_relaxation_time_high"].tolist() == [10.0, 20.0]
    assert found["test_line_uncertainty_method"].tolist() == [1, 2]
