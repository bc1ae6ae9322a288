"""None"""

import numpy as np
import pytest

from reduction.record.errors import DataError, FitError, SettingsError
from reduction.stages.cycles.cycle_product import Loops
from reduction.stages.holds.hold_product import HoldResult
from reduction.stages.standstills import Standstills
from reduction.stages.three_parameter_line.hold_pairs import (
    _static_stiffness,
    creep_of_hold,
    held_pairs,
)
from reduction.stages.three_parameter_line.line_product import mean_of_rows, one_a_specimen
from reduction.stages.three_parameter_line.rope_programme import (
    cycles_to_failure,
    dynamic_stiffness,
    summarise_bedding_in,
)


def loops_with(shape, *, u=0.0, **given):
    fields = {name: np.ones(shape) for name in Loops.__dataclass_fields__ if name != "uncertainty"}
    # no turn lies between two readings
    fields |= {name: np.zeros(shape) for name in fields if name.endswith("_turn_missed")}
    fields |= {name: np.broadcast_to(values, shape).astype(float) for name, values in given.items()}
    return Loops(**fields, uncertainty={name: np.full(shape, u) for name in fields})


class TestBeddingIn:
    def test_permanent_strain_is_at_equal_tension(self):
        # the foot moves by 3 %, of which 50 N over 5,000 N is a valley that was not reached
        loops = loops_with(
            (1, 3), foot_strain=[0.08, 0.10, 0.11],
            valley_tension=[100.0, 100.0, 150.0],
            apparent_spring_constant=[3000.0, 4500.0, 5000.0],
        )  # fmt: skip
        bedding = summarise_bedding_in(loops, rated_break_strength=[2000.0])
        assert bedding.permanent_strain == pytest.approx([0.03 - 50 / 5000])
        assert bedding.stiffening == pytest.approx([5 / 3])
        assert bedding.first_stiffness_over_strength == pytest.approx([1.5])
        assert bedding.last_stiffness_over_strength == pytest.approx([2.5])
        assert bedding.n_cycles == 3

    def test_the_first_secant_is_that_of_the_way_up_with_what_the_rope_gains_on_it(self):
        # from 0 to 6 % and 200 to 8,000 N, of which 1 % is gained; back to 1.5 % and 200 N
        loops = loops_with(
            (1, 3), foot_strain=[0.0, 0.015, 0.02], mean_strain=[0.03, 0.0425, 0.045],
            strain_amplitude=[0.025, 0.025, 0.025], peak_tension=8000.0, valley_tension=200.0,
            apparent_spring_constant=[156e3, 156e3, 160e3],
        )  # fmt: skip
        bedding = summarise_bedding_in(loops, rated_break_strength=1.0, begin_tension=200.0)
        assert bedding.first_stiffness == pytest.approx([7800 / 0.06])
        assert bedding.last_stiffness == pytest.approx([160e3])
        # where the machine sets the position, the rope has relaxed by the end of the cycle
        bedding = summarise_bedding_in(loops, rated_break_strength=1.0, begin_tension=500.0)
        assert bedding.first_stiffness == pytest.approx([7500 / 0.06])

    def test_uncertainties_add_up(self):
        loops = loops_with((2, 5), u=0.001, apparent_spring_constant=2.0)
        bedding = summarise_bedding_in(loops, rated_break_strength=np.nan)
        # two feet, and two valleys over 2 N
        expected = 0.001 * np.sqrt(2 + 2 / 4)
        assert bedding.permanent_strain_standard_uncertainty == pytest.approx([expected] * 2)
        assert np.isnan(bedding.first_stiffness_over_strength).all()

    def test_one_cycle_is_refused(self):
        with pytest.raises(DataError, match="bedding-in needs two cycles; found 1"):
            summarise_bedding_in(loops_with((1, 1)), rated_break_strength=1.0)


class TestDynamicStiffness:
    def test_a_turn_that_is_missed_in_every_cycle_is_in_its_uncertainty(self):
        loops = loops_with((1, 10), strain_turn_missed=0.02)
        found = dynamic_stiffness(loops, last_cycles=10, rated_break_strength=[np.nan])
        # evenly likely at either end: the range over the root of eight
        assert found.dynamic_stiffness_standard_uncertainty[0, 0] == pytest.approx(0.02 / 8**0.5)

    @pytest.mark.parametrize(("missed", "is_drift"), [(0.02, False), (0.0, True)])
    def test_a_missed_turn_that_moves_along_the_cycle_is_no_drift(self, missed, is_drift):
        # readings that creep along the cycle: of a stroke that is 0 to 2 % short
        scatter = 1e-4 * np.random.default_rng(1).standard_normal(10)
        loops = loops_with(
            (1, 10), strain_turn_missed=missed,
            apparent_spring_constant=np.linspace(1.0, 1.02, 10) + scatter,
        )  # fmt: skip
        found = dynamic_stiffness(loops, last_cycles=10, rated_break_strength=[np.nan])
        spread = found.drift_per_cycle_standard_uncertainty
        assert (found.drift_per_cycle > 3 * spread).all() == is_drift

    def test_the_last_cycles_of_each_level_count(self):
        stiffness = [900, 100, 101, 99, 100, 800, 200, 202, 198, 200.0]
        loops = loops_with(
            (1, 10), apparent_spring_constant=stiffness, mean_tension=[20.0] * 5 + [30.0] * 5
        )
        found = dynamic_stiffness(
            loops, last_cycles=4, rated_break_strength=[10.0], level=[7] * 5 + [3] * 5
        )
        assert found.level.tolist() == [7, 3]  # in the order of the test
        assert found.dynamic_stiffness == pytest.approx(np.array([[100.0, 200.0]]))
        assert found.dynamic_stiffness_over_strength == pytest.approx(np.array([[10.0, 20.0]]))
        assert found.mean_tension_over_strength == pytest.approx(np.array([[2.0, 3.0]]))
        # scatter of (100, 101, 99, 100) is root 2/3; neighbours are not alike
        assert found.dynamic_stiffness_standard_uncertainty[0, 0] == pytest.approx(
            np.sqrt(2 / 3) / 2
        )
        assert tuple(map(str, found.notes)) == () and found.n_cycles.tolist() == [[4, 4]]

    def test_the_drift_is_the_slope_of_a_regression(self):
        rng = np.random.default_rng(0)
        series = 1000 + 2.0 * np.arange(200) + rng.normal(0, 5, (300, 200))
        found = dynamic_stiffness(
            loops_with((300, 200), apparent_spring_constant=series),
            last_cycles=100,
            rated_break_strength=1.0,
        )
        drift = found.drift_per_cycle[:, 0]
        assert drift.mean() == pytest.approx(2.0, abs=0.01)
        stated = np.sqrt(np.mean(found.drift_per_cycle_standard_uncertainty**2))
        assert stated == pytest.approx(drift.std(ddof=1), rel=0.2)

    def test_too_few_cycles_are_noted_and_have_no_error(self):
        found = dynamic_stiffness(loops_with((1, 2)), last_cycles=100, rated_break_strength=1.0)
        assert tuple(map(str, found.notes)) == ("level 0 has 2 of the 100 requested cycles",)
        assert found.dynamic_stiffness == 1
        assert np.isnan(found.dynamic_stiffness_standard_uncertainty)

    def test_a_missing_cycle_is_passed_over(self):
        loops = loops_with((1, 4), apparent_spring_constant=[1.0, np.nan, 3.0, 5.0])
        found = dynamic_stiffness(loops, last_cycles=4, rated_break_strength=1.0)
        assert (found.dynamic_stiffness, found.n_cycles) == (3, 3)
        # over cycles 1, 3, 4 the regression of 1, 3, 5 has the slope 18/14
        assert found.drift_per_cycle == pytest.approx(np.array([[18 / 14]]))

    def test_nothing_known_is_nan(self):
        loops = loops_with((1, 4), apparent_spring_constant=np.nan, mean_tension=np.nan)
        found = dynamic_stiffness(loops, last_cycles=4, rated_break_strength=1.0)
        assert np.isnan(found.dynamic_stiffness) and np.isnan(found.mean_tension)

    def test_no_cycle_is_refused(self):
        with pytest.raises(SettingsError, match="no cycle counts towards the stiffness; found 0"):
            dynamic_stiffness(loops_with((1, 2)), last_cycles=0, rated_break_strength=1.0)


class TestFailure:
    def test_a_peak_that_falls_and_stays_down_is_a_failure(self):
        loops = loops_with((1, 6), peak_tension=[90.0, 110, 100, 100, 8, 5], valley_tension=3.0)
        lasted = cycles_to_failure(loops, rated_break_strength=200.0)
        assert (lasted.cycles, lasted.failed) == (4, True)
        assert lasted.peak_tension == 100 and lasted.peak_tension_over_strength == 0.5
        assert lasted.how[0].startswith("the peak falls below 50 % of its median")

    def test_one_low_peak_among_sound_ones_is_no_failure(self):
        loops = loops_with((1, 6), peak_tension=[90.0, 110, 8, 100, 100, 100])
        lasted = cycles_to_failure(loops, rated_break_strength=200.0)
        assert (lasted.cycles, lasted.failed) == (6, False)
        assert "a run-out, or a failure after the last one" in lasted.how[0]

    def test_the_word_of_the_laboratory_decides(self):
        loops = loops_with((2, 5), peak_tension=100.0)
        lasted = cycles_to_failure(
            loops, rated_break_strength=[200.0, np.nan], failed=[True, False],
            cycle_number=[10, 20, 30, 40, 50],
        )  # fmt: skip
        assert lasted.cycles.tolist() == [50, 50] and lasted.failed.tolist() == [True, False]
        assert lasted.how == ("as stated, after the last whole cycle", "as stated")
        assert np.isnan(lasted.peak_tension_over_strength[1])

    def test_cycles_of_a_machine_that_skips_keep_their_numbers(self):
        loops = loops_with((1, 4), peak_tension=[100.0, 100, 100, 1])
        numbers = [1, 1000, 2000, 3000]
        lasted = cycles_to_failure(loops, rated_break_strength=1.0, cycle_number=numbers)
        assert lasted.cycles == 2000

    def test_a_cycle_in_which_it_parts_is_not_one_that_it_lasted(self):
        loops = loops_with((3, 5), peak_tension=[100.0, 100, 100, 100, 60])
        lasted = cycles_to_failure(loops, rated_break_strength=200.0, parted_in=[4, 5, -1])
        assert lasted.cycles.tolist() == [4, 5, 5]
        assert lasted.failed.tolist() == [True, True, False]
        assert lasted.peak_tension.tolist() == [100.0, 92.0, 92.0]
        assert lasted.how[:2] == ("slack at a position at which it was taut",) * 2

    def test_a_specimen_without_any_reading_is_nan(self):
        loops = loops_with((1, 3), peak_tension=np.nan, valley_tension=np.nan)
        assert np.isnan(cycles_to_failure(loops, rated_break_strength=1.0).peak_tension)

    @pytest.mark.parametrize(
        "changed",
        [{"failed": [True, False]}, {"cycle_number": [1]}, {"parted_in": [0]}],
        ids=["words", "numbers", "no cycle before"],
    )
    def test_what_does_not_fit_is_refused(self, changed):
        with pytest.raises(DataError, match="the arrays do not fit the loops; found 3 cycles"):
            cycles_to_failure(loops_with((1, 3)), rated_break_strength=1.0, **changed)

    def test_a_share_of_the_peak_is_a_share(self):
        with pytest.raises(SettingsError, match="that counts as failure is out of range; found 50"):
            cycles_to_failure(loops_with((1, 3)), rated_break_strength=1.0, failure_share=50)


class TestStrength:
    @pytest.mark.parametrize("bad", [[1.0, 2.0, 3.0], [0.0, 1.0], [-1.0, 1.0]])
    def test_a_strength_that_cannot_be_is_refused(self, bad):
        with pytest.raises(DataError, match="the rated break strength does not fit the specimens"):
            one_a_specimen(bad, 2)

    def test_one_for_all_or_one_each(self):
        assert one_a_specimen(5.0, 2).tolist() == one_a_specimen([5.0, 5.0], 2).tolist()
        assert mean_of_rows(np.array([np.nan, 4.0])) == 4


def upper_hold(seed=None, n=3600):
    """One hour at 300 N after 100 N, one reading a second; K = 4000 - 100 log10(t)."""
    t = np.arange(1.0, n + 1)
    strain = 0.05 + 200 / (4000 - 100 * np.log10(t))
    if seed is not None:
        strain = strain + np.random.default_rng(seed).normal(0, 1e-4, n)
    return t, np.full(n, 300.0), strain


LOW = {"low_tension": 100.0, "low_strain": 0.05, "reference_time": 600.0}


class TestStatic:
    def test_a_line_in_the_logarithm_of_time_comes_back(self):
        found = _static_stiffness(*upper_hold(), **LOW, rated_break_strength=1000.0)
        expected = 4000 - 100 * np.log10(600)
        assert found.stiffness_at_reference == pytest.approx(expected, rel=1e-5)
        assert found.slope_per_decade == pytest.approx(-100, rel=1e-3)
        assert found.stiffness_over_strength == pytest.approx(expected / 1000, rel=1e-5)
        assert tuple(map(str, found.notes)) == ()

    def test_stated_uncertainties_are_the_scatter_of_holds_with_noise(self):
        found = [_static_stiffness(*upper_hold(seed), **LOW) for seed in range(200)]
        for value, stated in (
            ("slope_per_decade", "slope_per_decade_standard_uncertainty"),
            ("stiffness_at_reference", "stiffness_at_reference_standard_uncertainty"),
        ):
            scatter = np.std([getattr(one, value) for one in found], ddof=1)
            mean = np.sqrt(np.mean([getattr(one, stated) ** 2 for one in found]))
            # short blocks at the start have few readings, which the weights know in part
            assert 0.7 * scatter < mean < 2 * scatter

    def test_a_few_values_at_stated_times_do_too(self):
        t, load, strain = upper_hold()
        at = np.array([0, 9, 59, 179, 599, 3599])
        tension = np.append(load[at], np.nan)
        found = _static_stiffness(
            np.append(t[at], 7200.0), tension, np.append(strain[at], np.nan), **LOW
        )
        assert found.slope_per_decade == pytest.approx(-100, rel=1e-6)
        assert found.elapsed.size == 6

    def test_the_first_three_ramp_times_are_left_out(self):
        found = _static_stiffness(*upper_hold(), **LOW, ramp_duration=10.0)
        assert found.elapsed[0] >= 30

    def test_a_plateau_of_a_slow_cycle_has_its_secant_at_the_reference_time(self):
        # ten minutes up and twenty held, as in an hour from 10 to 30 % of the strength and back
        t, load, strain = upper_hold(seed=4)
        held = slice(300, 1500)
        found = _static_stiffness(t[held], load[held], strain[held], **LOW, ramp_duration=600.0)
        error = found.stiffness_at_reference - (4000 - 100 * np.log10(600))
        assert abs(error) < 2.5 * found.stiffness_at_reference_standard_uncertainty < 4
        assert np.isnan(found.slope_per_decade)
        own, slope = map(str, found.notes)
        assert "it applies only to a ramp of this length" in own
        assert "span 0.00 decades" in slope
        # of a hold that has no reading at that time there is none
        later = {**LOW, "reference_time": 1600.0}
        with pytest.raises(FitError, match="too short for a line"):
            _static_stiffness(t[held], load[held], strain[held], **later, ramp_duration=600.0)

    def test_a_reference_time_beyond_the_hold_is_noted(self):
        found = _static_stiffness(*upper_hold(), **{**LOW, "reference_time": 1e5})
        assert str(found.notes[0]).startswith("the stiffness at 100000 s is extrapolated")
        assert found.stiffness_at_reference == pytest.approx(3500, rel=1e-3)

    def test_a_short_hold_is_refused(self):
        t, load, strain = upper_hold()
        with pytest.raises(FitError, match="found 3 readings after 3 ramp times"):
            _static_stiffness(t[:3], load[:3], strain[:3], **LOW)
        with pytest.raises(
            FitError, match=r"points over 0\.\d\d decades; needed 4 points over 0.5"
        ):
            _static_stiffness(t[999:2000], load[999:2000], strain[999:2000], **LOW)

    def test_an_upper_hold_that_is_not_above_is_refused(self):
        with pytest.raises(
            DataError, match="the upper hold is not above the lower one; found least"
        ):
            _static_stiffness(*upper_hold(), **{**LOW, "low_tension": 400.0})

    def test_a_reference_time_of_zero_is_refused(self):
        with pytest.raises(SettingsError, match="the reference time is not positive; found 0 s"):
            _static_stiffness(*upper_hold(), **{**LOW, "reference_time": 0.0})


def hold(kind="creep", rate=0.002, refusals=()):
    nothing, nan = np.empty(0), np.nan
    return HoldResult(
        "line 1", kind, 0.0, 3600.0, 0.1, 3010.0, 2990.0, nan, nan, rate, 1e-5, nothing, nothing,
        nothing, nothing, nothing, nothing, nothing, nan, nan, refusals=refusals,
    )  # fmt: skip


class TestCreep:
    def test_creep_stands_with_its_tension_as_a_share(self):
        creep = creep_of_hold(hold(), rated_break_strength=10_000.0)
        assert (creep.creep_per_decade, creep.tension, creep.tension_over_strength) == (
            0.002,
            3000,
            0.3,
        )
        assert creep.creep_compliance_per_decade == pytest.approx(0.002 / 0.3)
        assert creep.reason == ""

    def test_a_refused_hold_keeps_its_reason(self):
        creep = creep_of_hold(hold(rate=np.nan, refusals=("too short", "no ramp")))
        assert np.isnan(creep.creep_per_decade) and creep.reason == "too short; no ramp"
        assert np.isnan(creep.tension_over_strength)

    def test_relaxation_is_no_creep(self):
        with pytest.raises(DataError, match="a hold of line 1 is no creep; found relaxation"):
            creep_of_hold(hold("relaxation"))

    def test_a_break_strength_must_be_positive(self):
        with pytest.raises(DataError, match="rated break strength are not positive"):
            creep_of_hold(hold(), rated_break_strength=-1.0)


def test_the_first_secant_of_a_bedding_in_has_none_of_what_creep_leaves_open_of_the_wave():
    one = {name: np.full((1, 3), 100.0) for name in Loops.__dataclass_fields__}
    one |= {
        "peak_tension": np.full((1, 3), 300.0),
        "apparent_spring_constant": np.array([[1000.0, 1000, 1000]]),
        "mean_strain": np.array([[0.2, 0.35, 0.35]]),
        "foot_strain": np.array([[0.075, 0.25, 0.25]]),
    }
    errors = {name: np.full((1, 3), 0.01) for name in one}
    errors["apparent_spring_constant"] = np.array([[80.0, 5, 5]])
    bedding = summarise_bedding_in(
        Loops(**(one | {"uncertainty": errors})), rated_break_strength=500.0
    )
    # 200 N over twice .125 of strain
    assert bedding.first_stiffness == pytest.approx(800)
    assert bedding.first_stiffness_standard_uncertainty == pytest.approx(800 * 5 / 1000)


def stands(*intervals, tension, rest=()):
    first, last = np.array(intervals).T
    return Standstills(
        first=first,
        last=last,
        start_time=first.astype(float),
        end_time=last.astype(float),
        mean_position=np.ones(first.size),
        mean_tension=np.array([tension]),
        is_rest=np.isin(np.arange(first.size), rest),
        position_tolerance=1e-3,
        slack_tension=5.0,
        tension_tolerance=1.0,
    )


def record(*, drop=100.0, n=1200):
    """A second a reading: 100 N from 10 to 100 s, 300 N from 110 s on."""
    time = np.arange(float(n))
    load = np.interp(time, [0, 10, 100, 110, n], [0, 100, 100, 300, 300])
    since = np.clip(time - 105, 5, None)
    strain = np.where(
        time <= 100, 0.05 * load / 100, 0.05 + (load - 100) / (4000 - drop * np.log10(since / 100))
    )
    return time, 1 + strain, load, strain


def pairs_of(time, position, load, strain, stand, *, strength=1e4, reference_time=100.0):
    return held_pairs(
        time, position, [load], [strain], stand, specimens=["rope"],
        rated_break_strength=strength, reference_time=reference_time,
    )  # fmt: skip


UP = stands((10, 100), (110, 1199), tension=[100.0, 300.0])


def test_a_hold_after_a_lower_one_has_a_stiffness():
    (pair,) = pairs_of(*record(), UP)
    assert (pair.low_hold, pair.high_hold) == (1, 2)
    assert (pair.low_tension, pair.high_tension) == pytest.approx((100.0, 300.0))
    assert pair.stiffness.stiffness_at_reference == pytest.approx(4000, rel=1e-3)
    assert pair.stiffness.slope_per_decade == pytest.approx(-100, rel=0.01)
    assert pair.stiffness.stiffness_over_strength == pytest.approx(0.4, rel=1e-3)


@pytest.mark.parametrize("retardation", [30.0, 100.0, 400.0])
def test_a_rope_that_creeps_exponentially_has_the_secant_at_the_reference_time(retardation):
    """Synthetic: a fifth of the strain at once, of a step at 50 s and of one at 650 s, follows."""
    time = np.arange(1250.0)
    load = np.interp(time, [49, 51, 649, 651], [0, 100, 100, 300])
    follows = sum(
        size * np.where(time > at, -np.expm1(-np.clip(time - at, 0, None) / retardation), 0.0)
        for size, at in ((100.0, 50.0), (200.0, 650.0))
    )
    strain = (load + 0.2 * follows) / 4000
    at_end, later = (100 + 20 * -np.expm1(-600 / retardation)) / 4000, np.interp(750, time, strain)
    stand = stands((51, 649), (651, 1249), tension=[100.0, 300.0])
    (pair,) = pairs_of(time, 1 + strain, load, strain, stand, reference_time=100.0)
    stiffness = 200 / (later - at_end)
    assert pair.stiffness.stiffness_at_reference == pytest.approx(stiffness, rel=1e-3)


def test_what_is_not_known_of_the_lower_hold_is_in_the_uncertainty():
    time, position, load, strain = record()
    noise = np.where(time < 101, np.random.default_rng(3).normal(0, 1e-3, time.size), 0.0)
    (sure,) = pairs_of(time, position, load, strain, UP)
    (pair,) = pairs_of(time, position, load, strain + noise, UP)
    # the lower strain is the end of a line through four readings, and the secant is over 0.05
    expected = 4000 / 0.05 * 1e-3 * np.sqrt(1 / 4 + 1.5**2 / 5)
    found = pair.stiffness.stiffness_at_reference_standard_uncertainty
    assert found > 10 * sure.stiffness.stiffness_at_reference_standard_uncertainty
    assert found == pytest.approx(expected, rel=0.25)


def test_a_lower_hold_after_it_and_a_rest_between_are_no_pair():
    assert pairs_of(*record(), stands((10, 100), (110, 1199), tension=[100.0, 102.0])) == ()
    assert pairs_of(*record(), stands((10, 100), (110, 1199), tension=[300.0, 100.0])) == ()
    parted = stands((10, 50), (60, 100), (110, 1199), tension=[100.0, 0.0, 300.0], rest=[1])
    assert pairs_of(*record(), parted) == ()


def test_rests_have_no_number():
    begins = stands((0, 5), (10, 100), (110, 1199), tension=[0.0, 100.0, 300.0], rest=[0])
    (pair,) = pairs_of(*record(), begins)
    assert (pair.low_hold, pair.high_hold) == (1, 2)


def test_a_short_hold_has_a_stiffness_at_a_time_within_it_and_no_slope():
    # from 100 to 200 s after the centre of the ramp: 0.3 decades
    time, position, load, strain = record(n=305)
    far = (time >= 110) & (time < 205)
    position, strain = (np.where(far, np.nan, one) for one in (position, strain))
    begins = stands((10, 100), (110, 304), tension=[100.0, 300.0])
    (pair,) = pairs_of(time, position, load, strain, begins, reference_time=150.0)
    true = 4000 - 100 * np.log10(1.5)
    assert pair.stiffness.stiffness_at_reference == pytest.approx(true, rel=1e-3)
    assert np.isnan(pair.stiffness.slope_per_decade)
    assert [one.code for one in pair.stiffness.notes] == ["no-static-slope"]
    (pair,) = pairs_of(time, position, load, strain, begins, reference_time=600.0)
    assert pair.stiffness is None


def test_a_hold_that_is_too_short_is_refused_with_its_levels():
    time, position, load, strain = record(n=120)
    (pair,) = pairs_of(
        time, position, load, strain, stands((10, 100), (110, 119), tension=[100.0, 300.0])
    )
    assert pair.stiffness is None
    assert "too short for a line in the logarithm of time" in pair.reason
    assert pair.high_tension == pytest.approx(300.0)


def test_a_lower_hold_without_strain_is_refused():
    time, position, load, strain = record()
    (pair,) = pairs_of(time, position, load, np.where(time < 101, np.nan, strain), UP)
    assert pair.stiffness is None and "the lower hold has no strain" in pair.reason


def test_an_upper_hold_without_a_ramp_is_refused():
    time, position, load, strain = record()
    load = np.where(time < 111, 300.0, load)
    together = stands((10, 100), (101, 1199), tension=[100.0, 300.0])
    (pair,) = pairs_of(time, position, load, strain, together)
    assert pair.stiffness is None and "does not show the ramp" in pair.reason


def test_a_strength_that_is_not_positive_is_refused():
    with pytest.raises(DataError, match="rated break strength"):
        pairs_of(*record(), UP, strength=-1.0)
