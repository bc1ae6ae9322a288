"""EA of cycles smaller than that of the test, for springs beside a friction or a Maxwell element."""

import numpy as np
import pytest

from reduction.lines.assembly import SeriesPart, WorkingLevel, deploy
from reduction.lines.composite import CompositeRule, CurvePiece, MeasuredLoop, _composite_curve
from reduction.lines.export_sources import _smaller_cycle
from reduction.stages.strain.strain_model import StrainModel

SPRING, FRICTION, LIMIT = 1000.0, 4000.0, 50.0  # N per unit strain, and N
MIDDLE, HALF = 0.5, 0.2  # strain of the tested cycles
MODEL = StrainModel("rope", "gauge-length", {"reference_position": 1.0, "gauge_length": 1.0})


def of_friction(stroke):
    """Rise of tension over a cycle of this stroke: the spring, and a slider that turns twice."""
    return SPRING * stroke + np.minimum(FRICTION * stroke, 2 * LIMIT)


def loop(width=lambda at: np.minimum(FRICTION * at, 2 * LIMIT), rise=None):
    rise = of_friction(2 * HALF) if rise is None else rise
    at = np.linspace(0, 2 * HALF, 81)
    return MeasuredLoop(
        "T", strain=np.array([MIDDLE - HALF, MIDDLE + HALF]),
        tension=SPRING * MIDDLE + rise / 2 * np.array([-1.0, 1.0]), distance=at, width=width(at),
        relative_uncertainty=0.01,
    )  # fmt: skip


def curve(kind="cyclic", name="T", ends=(0.35, 0.65), slope=SPRING):
    """The mean curve of a loop with straight branches is that of its spring."""
    at = np.linspace(*ends, 31)
    piece = CurvePiece(name, kind, "mean", at, slope * at, 0 * at)
    return _composite_curve((piece,), rule=CompositeRule())


def state_of(amplitude, *, drawn=None, n=1, parts=(), of=None):
    level = WorkingLevel("tension", n * SPRING * MIDDLE, amplitude)
    return deploy(
        drawn or curve(), MODEL, n_tethers=n, parts=parts, levels=[level], loops=[of or loop()]
    ).working[0]


def test_the_cycle_of_the_test_has_its_stiffness():
    state = state_of(249.9, drawn=curve(ends=(0.2, 0.8)))
    tested = of_friction(2 * HALF) / (2 * HALF)
    assert (state.used[0].low, state.used[0].high) == pytest.approx((250, 750))
    assert state.least_spring_constant == pytest.approx(tested)
    assert state.greatest_spring_constant == pytest.approx(tested, rel=1e-3)
    rope = state_of(249.9, drawn=curve("static", "Q", (0.01, 0.9)))
    assert rope.nearest == "T cycles"
    assert rope.secant_spring_constant == pytest.approx(tested, rel=1e-3)
    error = 1.96 * 0.01 * tested
    assert rope.greatest_spring_constant - tested == pytest.approx(error, rel=0.02)


@pytest.mark.parametrize("stroke", [0.02, 0.05, 0.1, 0.2])
def test_the_interval_of_a_smaller_cycle_reaches_from_a_loss_in_proportion_to_friction(stroke):
    friction = of_friction(stroke) / stroke
    proportional = of_friction(2 * HALF) / (2 * HALF)
    state = state_of(of_friction(stroke) / 2)
    assert state.least_spring_constant == pytest.approx(proportional)
    assert state.greatest_spring_constant == pytest.approx(friction)
    assert state.secant_spring_constant == pytest.approx((friction + proportional) / 2)


def test_parts_in_line_are_softer_in_every_cycle():
    part = SeriesPart("rope", 1.0, 5000.0)
    rise = 2 * of_friction(0.1)
    state = state_of(rise / 2, n=2, parts=[part])
    friction = 2 * rise / (0.1 + rise / 5000)
    assert state.greatest_spring_constant == pytest.approx(friction, rel=0.02)


def test_an_elastic_line_has_the_chord_of_its_curve():
    elastic = loop(lambda at: 0 * at, SPRING * 2 * HALF)
    state = state_of(50.0, of=elastic)
    assert state.least_spring_constant == pytest.approx(SPRING)
    assert state.greatest_spring_constant == pytest.approx(SPRING)
    assert not state.doubt


def test_the_slope_of_a_slow_pull_is_not_the_stiffness_of_cycles():
    """Cycles without a curve, of a rope without a diameter: the pull alone had been used."""
    state = state_of(249.0, drawn=curve("static", "Q", (0.01, 1.2), 0.7 * SPRING))
    assert "slope of the curve is 0.7" in state.doubt
    assert "the curve is of Q static" in state.doubt
    # 500 N at 1.5 m in the cycles; the pull has 500 / 700 of strain there
    assert "at their mean tension of 500 N T cycles had 1.5 m, and the curve has 1.7143 m" in (
        state.doubt
    )


def test_the_middle_of_a_cycle_follows_the_bend_of_its_test():
    """An elastic T = 1000 e^2: 160 and 640 N are at 40 and 80 % strain, 400 N at 63.2 %."""
    at = np.linspace(0.3, 0.9, 601)
    piece = CurvePiece("T", "cyclic", "mean", at, 1000 * at**2, 0 * at)
    bent = _composite_curve((piece,), rule=CompositeRule())
    level = WorkingLevel("tension", 400.0, 240.0)
    state = deploy(bent, MODEL, n_tethers=1, levels=[level]).working[0]
    assert (state.minimum_length, state.peak_length) == pytest.approx((1.4, 1.8), abs=2e-3)


def test_a_deck_of_one_test_says_what_its_loop_leaves_open_about_smaller_cycles():
    """250 N of rise: 150 mm of stroke of the spring and 100 N of the slider, 1,667 N at most."""
    at = np.linspace(0.35, 0.65, 31)
    ends = np.concatenate([[0.3], at, [0.7]])
    table = np.concatenate([[250.0], SPRING * at, [750.0]])
    (said,) = _smaller_cycle(loop(), at, SPRING * at, ends, table)
    assert "between 1250 and 1670 N, the curve has 1000 N" in said
    elastic = loop(lambda x: 0 * x, SPRING * 2 * HALF)
    assert not _smaller_cycle(elastic, at, SPRING * at, at, SPRING * at)
    assert not _smaller_cycle(None, at, SPRING * at, at, SPRING * at)
