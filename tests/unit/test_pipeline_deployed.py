"""A deployed assembly of springs of a known law: 400 e + 80 e^3 N on the free length."""

import numpy as np
import pytest
from assemblies import DRIVEN, RUBBER

from reduction.lines.assembly import SeriesPart, WorkingLevel, deploy
from reduction.lines.composite import (
    CompositeRule,
    CurvePiece,
    MeasuredLoop,
    PieceSource,
    _composite_curve,
    compose,
)
from reduction.lines.cycle_stiffness import LoadedTest, stiffness_of_cycles
from reduction.lines.export_sources import _smaller_cycle
from reduction.record.contributions import Component
from reduction.record.errors import DataError
from reduction.stages.strain.strain_model import StrainModel, position_by_model

CURVE = RUBBER.curve
LEVEL = WorkingLevel("strain", 1.0)


def test_a_strain_a_length_and_a_tension_name_the_same_point():
    by_strain = deploy(CURVE, DRIVEN, n_tethers=4, levels=[LEVEL]).working[0]
    assert float(by_strain.point.mean_tension) == pytest.approx(4 * 480, rel=1e-3)
    assert by_strain.strain == pytest.approx([1.0] * 4)
    length, tension = float(by_strain.point.total_length), float(by_strain.point.mean_tension)
    assert length == pytest.approx(
        float(position_by_model(DRIVEN, strain=1.0, tension=480.0)), rel=1e-3
    )
    for level in (WorkingLevel("total_length", length), WorkingLevel("tension", tension)):
        found = deploy(CURVE, DRIVEN, n_tethers=4, levels=[level]).working[0]
        assert float(found.point.mean_tension) == pytest.approx(tension, rel=1e-9)
        assert float(found.point.total_length) == pytest.approx(length, rel=1e-9)


def test_nothing_is_said_of_the_stiffness_below_the_first_strain_that_was_tested():
    from_line = StrainModel("T", "gauge-length", {"reference_position": 2.0, "gauge_length": 2.0})
    straight = deploy(
        CURVE, from_line, n_tethers=3, parts=[SeriesPart("bridle", 1.0)],
        levels=[WorkingLevel("strain", 0.02)],
    )  # fmt: skip
    low = straight.assembly.tension < 3 * 20
    assert np.isnan(straight.stiffness.spring_constant[low]).all()
    assert not any(name for name, is_low in zip(straight.nearest_test, low, strict=True) if is_low)
    (state,) = straight.working
    assert np.isnan(state.secant_spring_constant) and state.nearest == ""
    assert state.note == ("no test covers 70 % of the cycle, so EA is unknown: no test reaches it")
    assert straight.strain == pytest.approx(straight.assembly.total_length / 3.0 - 1)
    assert not straight.working[0].point.is_tested
    assert straight.free_length == (2.0,) * 3


def test_the_tolerance_moves_loads_about_the_equal_one():
    found = deploy(
        CURVE, DRIVEN, n_tethers=4, levels=[LEVEL], tolerance=0.01, rated_break_strength=4800.0
    ).working[0]
    assert found.sharing.least_load < 480 < found.sharing.greatest_load
    assert found.point.peak_share == pytest.approx([0.1] * 4, rel=1e-3)
    assert deploy(CURVE, DRIVEN, n_tethers=4, levels=[LEVEL]).working[0].sharing is None


def test_lengths_of_their_own_make_unequal_tethers():
    found = deploy(CURVE, DRIVEN, n_tethers=2, free_lengths=(3.0, 3.3), levels=[])
    assert found.free_length == pytest.approx((3.0, 3.3))
    assert np.diff(found.assembly.slack_length) == pytest.approx([0.3], rel=1e-3)


def test_splices_beyond_their_marks_are_told():
    marked = StrainModel("T", "tension-driven", DRIVEN.coefficients, tension_high=500.0)
    notes = deploy(CURVE, marked, n_tethers=2).notes
    assert any("the splices were marked up to 500 N per tether" in note for note in notes)
    # one tether ends at 2250 N, the two of them at twice that
    enough = StrainModel("T", "tension-driven", DRIVEN.coefficients, tension_high=3000.0)
    assert not any("marked up to" in note for note in deploy(CURVE, enough, n_tethers=2).notes)


@pytest.mark.parametrize(
    ("level", "told"),
    [
        (WorkingLevel("total_length", 3.0), "working.2: the assembly is slack at this total length"),
        (WorkingLevel("total_length", 2.55 + 1.19), "working.2: the assembly is slack"),
        (WorkingLevel("total_length", 30.0), "working.2: the assembly is beyond its curve"),
        (WorkingLevel("strain", 2.6), "beyond its curve at this strain; found 2.6 of the free"
                                      " length"),
        (WorkingLevel("tension", 1e6), "working.2: the peak tension is beyond the curves"),
        (WorkingLevel("tension", 500.0, 600.0), "working.2: "),
    ],
)  # fmt: skip
def test_a_level_that_is_none_is_named_by_its_place(level, told):
    with pytest.raises(DataError, match=told):
        deploy(CURVE, DRIVEN, n_tethers=4, levels=[LEVEL, level])


def test_the_secant_is_over_five_percent_of_the_length_to_each_side():
    """2 m of it at 4 m: strains 0.9 and 1.1, 418.32 and 546.48 N, so 128.16 N in 0.4 m over 2 m."""
    model = StrainModel("T", "gauge-length", {"reference_position": 2.0, "gauge_length": 2.0})
    found = deploy(CURVE, model, n_tethers=1, levels=[LEVEL, WorkingLevel("strain", 1.0, 50.0)])
    still, cycled = found.working
    assert still.secant_spring_constant == pytest.approx(640.8, rel=2e-3)
    at = np.interp(4.0, found.assembly.total_length, found.stiffness.spring_constant)
    assert at == pytest.approx(640.8, rel=2e-3)
    # the slope at 100 % is 400 + 240 N, and within 50 N it hardly bends
    assert cycled.secant_spring_constant == pytest.approx(640, rel=5e-3)
    assert cycled.peak_length - cycled.minimum_length == pytest.approx(2 * 100 / 640, rel=5e-3)
    assert not found.assembly.is_moved.any() and cycled.doubt == still.doubt == ""


SPRING = StrainModel("T", "gauge-length", {"reference_position": 2.0, "gauge_length": 2.0})


def window(name, low, high, law, kind="cyclic", spread=0.0):
    at = np.linspace(low, high, 41)
    return CurvePiece(name, kind, "mean", at, law(at), np.full(41, spread))


def windows(*pieces):
    return compose(PieceSource("tether", "mean", pieces), CompositeRule())


def soft(at):
    """400 N per unit strain; 200 N at 50 %, 600 N at 150 %."""
    return 400 * at


def stiff(at):
    """800 N per unit strain, 80 % further out; 200 N at 105 %, 640 N at 160 %."""
    return 800 * (at - 0.8)


def test_two_unlike_windows_leave_their_own_stiffness_and_not_that_of_their_join():
    """Chords of straight lines are their slopes, whatever the cycle: 2 x 400 and 2 x 800 N."""
    curve = windows(window("T-1", 0.4, 1.5, soft), window("T-2", 1.0, 1.6, stiff))
    assert np.diff(curve.tension_at([1.0, 1.4]))[0] / 0.4 < 350  # the join is softer than both
    found = deploy(
        curve, SPRING, n_tethers=2, parts=[SeriesPart("chain", 1.0)],
        levels=[WorkingLevel("tension", 800.0, 300.0)],
    )  # fmt: skip
    (state,) = found.working
    # over 3 m at slack, of which 2 m stretch
    assert [one.spring_constant for one in state.used] == pytest.approx([1200, 2400], rel=1e-6)
    assert 1200 < state.secant_spring_constant < 2400
    assert state.least_spring_constant == pytest.approx(1200, rel=1e-6)
    assert state.greatest_spring_constant == pytest.approx(2400, rel=1e-6)
    # T-1 has loads of 320 to 1200 N, T-2 of 320 to 1280 N: 760 +- 440 and 800 +- 480
    apart = np.array([np.hypot(40, 140), np.hypot(0, 180)])
    mean = np.average([1200, 2400], weights=apart**-2)
    assert state.secant_spring_constant == pytest.approx(mean, rel=1e-6)
    assert state.nearest == "T-1 cycles"
    assert state.curve_spring_constant < 0.9 * 1200  # softer than either of them
    assert "of the lowest EA of the tests" in state.doubt
    # the stroke is that of the stated EA, about the mean of the curve
    assert state.peak_length - state.minimum_length == pytest.approx(3 * 600 / mean)
    middle = (state.peak_length + state.minimum_length) / 2
    assert middle == pytest.approx(float(state.point.total_length))
    assert found.assembly.length_at(800.0) == pytest.approx(middle)


def test_along_the_curve_the_stiffness_never_leaves_that_of_the_tests():
    curve = windows(window("T-1", 0.4, 1.5, soft), window("T-2", 1.0, 1.6, stiff))
    found = deploy(curve, SPRING, n_tethers=1)
    slope = np.gradient(found.assembly.tension, found.assembly.total_length) * 2.0
    known = np.isfinite(found.stiffness.spring_constant)
    assert slope[known].min() < 300
    for one in (
        found.stiffness.spring_constant, found.stiffness.least, found.stiffness.greatest,
    ):  # fmt: skip
        assert (one[known] > 400 * (1 - 1e-6)).all() and (one[known] < 800 * (1 + 1e-6)).all()
    assert set(found.nearest_test) == {"", "T-1 cycles", "T-2 cycles"}


@pytest.mark.parametrize(("high", "has_stiffness"), [(0.86, True), (0.84, False)])
def test_a_test_counts_from_seventy_percent_of_the_cycle(high, has_stiffness):
    """200 to 400 N are asked, and T-1 begins at 200 N: 70 % of them end at 340 N, a strain of 85 %."""
    curve = windows(window("T-1", 0.5, high, soft), window("T-2", 1.2, 1.8, stiff))
    level = WorkingLevel("tension", 300.0, 100.0)
    (state,) = deploy(curve, SPRING, n_tethers=1, levels=[level]).working
    assert state.tests[0].covered == pytest.approx((400 * high - 200) / 200)
    # T-2 begins at 320 N
    assert state.tests[1].covered == pytest.approx(0.4)
    assert np.isfinite(state.secant_spring_constant) == has_stiffness
    if not has_stiffness:
        assert "EA is unknown: nearest are T-1 cycles 68 %, T-2 cycles 40 %" in state.doubt


def test_kinds_behind_that_which_covers_the_cycle_have_no_say():
    pieces = (
        window("S", 0.2, 1.6, lambda at: 380 * at, "static"),
        window("T-1", 0.5, 1.5, soft),
        window("F", 0.1, 1.6, lambda at: 500 * at, "first-loading"),
    )
    level = WorkingLevel("tension", 400.0, 150.0)
    (state,) = deploy(windows(*pieces), SPRING, n_tethers=1, levels=[level]).working
    assert [one.words for one in state.used if one.covered] == ["T-1 cycles"]
    assert state.secant_spring_constant == pytest.approx(400, rel=1e-6)


def test_the_interval_holds_what_the_tests_are_wrong_by_themselves():
    """2 N at each end of 300 N: root 2 times 2 / 300 of 400 N, k = 1.96."""
    curve = windows(window("T-1", 0.4, 1.5, soft, spread=2.0))
    level = WorkingLevel("tension", 400.0, 150.0)
    (state,) = deploy(curve, SPRING, n_tethers=1, levels=[level]).working
    half = 1.96 * np.sqrt(2) * 2 / 300 * 400
    assert state.greatest_spring_constant - 400 == pytest.approx(half, rel=1e-3)
    assert 400 - state.least_spring_constant == pytest.approx(half, rel=1e-3)


def test_a_gain_that_tests_share_moves_their_stiffness_by_as_much_as_their_tension():
    at = np.linspace(0.4, 1.5, 41)
    gain = Component("tension_gain", "cell")
    piece = CurvePiece(
        "T-1", "cyclic", "mean", at, 400 * at, 0 * at, (gain,), 0.01 * 400 * at[None]
    )  # fmt: skip
    level = WorkingLevel("tension", 400.0, 150.0)
    (state,) = deploy(windows(piece), SPRING, n_tethers=1, levels=[level]).working
    assert state.greatest_spring_constant == pytest.approx(400 * (1 + 0.0196), rel=1e-4)


def test_unequal_tethers_have_the_stiffness_of_their_springs():
    """400 N over 2 m and over 2.2 m, taut both: 200 and 181.8 N/m, over 2 m."""
    curve = windows(window("T-1", 0.2, 1.5, soft))
    level = WorkingLevel("tension", 500.0, 100.0)
    found = deploy(curve, SPRING, n_tethers=2, free_lengths=(2.0, 2.2), levels=[level])
    assert found.working[0].secant_spring_constant == pytest.approx(2 * (200 + 400 / 2.2), rel=1e-5)


def test_a_curve_without_doubt_where_two_windows_agree():
    curve = windows(window("T-1", 0.4, 1.5, soft), window("T-2", 1.0, 1.8, soft))
    level = WorkingLevel("tension", 500.0, 90.0)
    (state,) = deploy(curve, SPRING, n_tethers=1, levels=[level]).working
    assert len(state.used) == 2 and state.doubt == state.note == ""
    assert state.curve_spring_constant == pytest.approx(400, rel=1e-6)


# EA of cycles smaller than that of the test, for springs beside a friction or a Maxwell element

SPRING_OF_LOOPOFCYCLE, FRICTION, LIMIT = 1000.0, 4000.0, 50.0  # N per unit strain, and N
MIDDLE, HALF = 0.5, 0.2  # strain of the tested cycles
MODEL = StrainModel("rope", "gauge-length", {"reference_position": 1.0, "gauge_length": 1.0})


def of_friction(stroke):
    """Rise of tension over a cycle of this stroke: the spring, and a slider that turns twice."""
    return SPRING_OF_LOOPOFCYCLE * stroke + np.minimum(FRICTION * stroke, 2 * LIMIT)


def loop(width=lambda at: np.minimum(FRICTION * at, 2 * LIMIT), rise=None, error=0.0):
    rise = of_friction(2 * HALF) if rise is None else rise
    at = np.linspace(0, 2 * HALF, 81)
    return MeasuredLoop(
        "T", strain=np.array([MIDDLE - HALF, MIDDLE + HALF]),
        tension=SPRING_OF_LOOPOFCYCLE * MIDDLE + rise / 2 * np.array([-1.0, 1.0]), distance=at, width=width(at),
        relative_uncertainty=error,
    )  # fmt: skip


def curve(kind="cyclic", name="T", ends=(0.35, 0.65), slope=SPRING_OF_LOOPOFCYCLE):
    """The mean curve of a loop with straight branches is that of its spring."""
    at = np.linspace(*ends, 31)
    piece = CurvePiece(name, kind, "mean", at, slope * at, 0 * at)
    return _composite_curve((piece,), rule=CompositeRule())


def state_of(amplitude, *, drawn=None, n=1, parts=(), of=None):
    level = WorkingLevel("tension", n * SPRING_OF_LOOPOFCYCLE * MIDDLE, amplitude)
    return deploy(
        drawn or curve(), MODEL, n_tethers=n, parts=parts, levels=[level], loops=[of or loop()]
    ).working[0]


def test_the_cycle_of_the_test_has_its_stiffness():
    state = state_of(249.9, drawn=curve(ends=(0.2, 0.8)))
    tested = of_friction(2 * HALF) / (2 * HALF)
    assert (state.used[0].low, state.used[0].high) == pytest.approx((250, 750))
    assert state.least_spring_constant == pytest.approx(tested)
    assert state.greatest_spring_constant == pytest.approx(tested, rel=1e-3)
    # with a curve or without one
    for drawn in (curve("static", "Q", (0.01, 0.9)), curve(ends=(0.25, 0.75))):
        rope = state_of(249.9, drawn=drawn, of=loop(error=0.01))
        assert rope.nearest == "T cycles"
        assert rope.secant_spring_constant == pytest.approx(tested, rel=1e-3)
        error = 1.96 * 0.01 * tested
        assert rope.greatest_spring_constant - tested == pytest.approx(error, rel=0.02)


def test_the_tested_cycle_goes_beyond_its_branches_to_their_turns():
    tested = of_friction(2 * HALF) / (2 * HALF)
    level = of_friction(2 * HALF) / 2
    assert level == 250
    # the load that is set is reached within 2 %
    drawn = curve(ends=(0.32, 0.68))
    state = state_of(1.01 * level, drawn=drawn)
    assert not state.doubt
    assert state.greatest_spring_constant == pytest.approx(tested, rel=0.01)
    assert state.peak_length == pytest.approx(1 + MIDDLE + 1.01 * HALF, rel=2e-3)
    with pytest.raises(DataError, match="beyond the curves"):
        state_of(1.1 * level, drawn=drawn)


def test_cycles_whose_mean_curve_has_a_hole_are_one_test():
    """Readings in step with the machine leave bins that no window reaches."""
    low, high = (curve(ends=ends).pieces for ends in ((0.32, 0.45), (0.55, 0.68)))
    holed = _composite_curve((*low, *high), rule=CompositeRule())
    tested = of_friction(2 * HALF) / (2 * HALF)
    state = state_of(249.0, drawn=holed)
    assert [one.words for one in state.used if one.covered] == ["T cycles"]
    assert state.least_spring_constant == pytest.approx(tested)


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
    elastic = loop(lambda at: 0 * at, SPRING_OF_LOOPOFCYCLE * 2 * HALF)
    state = state_of(50.0, of=elastic)
    assert state.least_spring_constant == pytest.approx(SPRING_OF_LOOPOFCYCLE)
    assert state.greatest_spring_constant == pytest.approx(SPRING_OF_LOOPOFCYCLE)
    assert not state.doubt


@pytest.mark.parametrize(("ratio", "least", "greatest"), [(1.1, 300, 330), (0.8, 240, 300)])
def test_a_first_loading_where_no_loop_reaches_may_be_as_far_off_as_beside_the_loops(
    ratio, least, greatest
):
    at = np.linspace(1, 4, 301)
    of_kind = {"cyclic": (300 * ratio, 50.0, 200.0), "first loading": (300.0, 0.0, 900.0)}
    tests = [
        LoadedTest("T", kind, at, slope * (at - 1), 0 * at, np.empty((0, 301)), low, high)
        for kind, (slope, low, high) in of_kind.items()
    ]
    found = stiffness_of_cycles(tests, [60.0, 150.0], [190.0, 450.0], slack_length=1.0)
    np.testing.assert_allclose(found.spring_constant, [300 * ratio, 300])
    np.testing.assert_allclose(found.least, [300 * ratio, least])
    np.testing.assert_allclose(found.greatest, [300 * ratio, greatest])


def test_the_slope_of_a_slow_pull_is_not_the_stiffness_of_cycles():
    """Cycles without a curve, of a rope without a diameter: the pull alone had been used."""
    state = state_of(249.0, drawn=curve("static", "Q", (0.01, 1.2), 0.7 * SPRING_OF_LOOPOFCYCLE))
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
    table = np.concatenate([[250.0], SPRING_OF_LOOPOFCYCLE * at, [750.0]])
    (said,) = _smaller_cycle(loop(), at, SPRING_OF_LOOPOFCYCLE * at, ends, table)
    assert "between 1250 and 1670 N, the curve has 1000 N" in said
    elastic = loop(lambda x: 0 * x, SPRING_OF_LOOPOFCYCLE * 2 * HALF)
    assert not _smaller_cycle(
        elastic, at, SPRING_OF_LOOPOFCYCLE * at, at, SPRING_OF_LOOPOFCYCLE * at
    )
    assert not _smaller_cycle(None, at, SPRING_OF_LOOPOFCYCLE * at, at, SPRING_OF_LOOPOFCYCLE * at)
