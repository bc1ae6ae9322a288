"""The uncertainty of a line of a test: which propagation is stated, and what is noted."""

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
from reduction.stages.three_parameter_line.line_of_loops import identify_run
from reduction.uncertainty.monte_carlo import with_line_spread

STORED, LOST, RATE = 3e4, 4e3, 0.3
NAMES = ("dissipation_spring_constant", "relaxation_time", "dashpot_coefficient")


def reduced(rest, spread, *, scatter=0.001, contributions=None, n_cycles=8):
    """A test of two specimens whose loops are alike but for K_0."""
    rng = np.random.default_rng(5)
    shape = (2, n_cycles)
    own = {name: np.ones(shape) for name in Loops.__dataclass_fields__ if name != "uncertainty"}
    # no turn lies between two readings
    own |= {name: np.zeros(shape) for name in own if name.endswith("_turn_missed")}
    own |= {
        "storage_spring_constant": STORED * (1 + scatter * rng.normal(size=shape)),
        "loss_spring_constant": LOST * (1 + scatter * rng.normal(size=shape)),
        "frequency": np.full(shape, RATE),
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
        reduced([STORED - LOST, 1.5e4], [600.0, 200.0], scatter=1e-4), CycleSettings()
    )
    assert test.line_spread.method.tolist() == [2, 1]
    assert "linear uncertainty of K_1 is 0.0" in str(test.line_notes[0])
    assert test.line_spread.low[NAMES[0]][0] == pytest.approx(2 * LOST, rel=0.001)


def test_shared_errors_of_a_campaign_are_drawn_too():
    gain = {
        f"test_{name}": 0.03 * value * np.ones((1, 2))
        for name, value in (
            ("storage_spring_constant", STORED), ("loss_spring_constant", LOST),
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
