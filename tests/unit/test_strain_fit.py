"""Which method fits a specimen, and on which marks."""

import dataclasses

import numpy as np
import pytest
from refusals import refusals
from scipy import stats

from reduction.record.contributions import InstrumentErrors
from reduction.record.errors import DataError, FitError
from reduction.record.measurement import Specimen, SpliceMarks
from reduction.record.settings import PhaseSettings, StrainSettings
from reduction.stages.standstills import Standstills, find_standstills
from reduction.stages.strain.strain_fit import (
    PooledMarks,
    _without_marks,
    fit_strain_model,
    fit_to_marks,
)
from reduction.stages.strain.strain_model import (
    StrainModel,
    strain_by_model,
    strain_sensitivity_of,
)
from reduction.stages.strain.zero_strain import (
    ZeroStrain,
    zero_at_slack,
    zero_at_start,
    zero_before_a_move,
)
from reduction.uncertainty.error_field import error_field

L0, LS = 2.55, 1.18
COMPLIANCE, EXPONENT = 0.0012, 0.85
READING = 0.00124


def campaign(tests, *, noise=0.0, seed=0, growth=0.0):
    """Marks and tensions of tests given as name -> stretched (strain, tension) pairs."""
    rng = np.random.default_rng(seed)
    names, holds, rows, tension = [], [], [], []
    for number, (name, pairs) in enumerate(tests.items()):
        for hold, (strain, force) in zip(
            ("slack", "min", "centre", "max"), [(0.0, 0.0), *pairs], strict=False
        ):
            near, far, thimble = rng.normal(0, noise, 3)
            free = L0 * (1 + strain) + growth * number
            splice = LS * (1 + COMPLIANCE * force**EXPONENT)
            rows.append((0.54 * splice + near, 0.54 * splice + free + far, free + splice + thimble))
            names.append(name)
            holds.append(hold)
            tension.append(force)
    near, far, thimble = np.array(rows).T
    marks = SpliceMarks("new", tuple(names), tuple(holds), near, far, thimble, READING)
    return marks, np.array(tension)


TESTS = {
    "T-1": [(0.76, 375.0), (1.02, 485.0), (1.28, 590.0)],
    "T-5": [(1.81, 890.0), (2.05, 1100.0), (2.30, 1290.0)],
}
NARROW = {"T-1": TESTS["T-1"]}


def fit(tests=TESTS, *, test_id="T-1", method=None, tension=True, specimen=None, **more):
    marks, force = campaign(tests, **more)
    return fit_strain_model(
        specimen or Specimen("new"),
        test_id=test_id,
        marks=marks,
        mark_tension=force if tension else None,
        settings=StrainSettings(method),
    )


def test_the_default_is_the_average_over_the_laws_that_the_marks_do_not_reject():
    model = fit()
    assert model.method == "mixed"
    assert model.marks_from == "pooled over the campaign"
    np.testing.assert_allclose(model.mark_strain_residual, 0, atol=2e-3)
    # between the marks as well as at them: strains and tensions of a test that was not marked
    strain, force = np.array([1.15, 1.5, 1.7]), np.array([540.0, 730.0, 830.0])
    position = L0 * (1 + strain) + LS * (1 + COMPLIANCE * force**EXPONENT)
    found = strain_by_model(model, position=position, tension=force)
    np.testing.assert_allclose(found, strain, atol=0.005)


def test_marks_without_a_tension_are_judged_by_laws_of_position():
    model = fit(tension=False)
    assert model.method == "mixed"
    assert model.coefficients["splice_compliance"] == 0
    # below its lowest mark a law of position is an extrapolation, and splices bend there
    is_stretched = np.array(model.mark_hold) != "slack"
    np.testing.assert_allclose(model.mark_strain_residual[is_stretched], 0, atol=2e-3)


def test_tension_driven_finds_the_law():
    model = fit(method="tension-driven")
    assert model.coefficients["splice_compliance"] == pytest.approx(COMPLIANCE, rel=1e-5)
    assert model.coefficients["splice_exponent"] == pytest.approx(EXPONENT, rel=1e-6)
    np.testing.assert_allclose(model.mark_strain_residual, 0, atol=1e-8)


def test_a_stated_method_is_used():
    for method in ("marks", "strain-ratio", "constant-fraction", "tension-driven"):
        assert fit(method=method).method == method


def test_a_test_without_marks_uses_the_pooled_fit():
    own, other = fit(), fit(test_id="T-9")
    assert other.coefficients == own.coefficients
    line = fit(test_id="T-9", method="marks")
    assert line.marks_from == "pooled over the campaign"
    assert set(line.mark_test) == {"T-1", "T-5"}


def test_relaxed_lengths_are_pooled_but_for_constant_fraction():
    marks = fit(growth=0.02, method="marks")
    assert marks.coefficients["relaxed_free_length"] == pytest.approx(L0 + 0.01)
    legacy = fit(growth=0.02, method="constant-fraction", test_id="T-5")
    assert legacy.coefficients["relaxed_free_length"] == pytest.approx(L0 + 0.02)


def test_constant_fraction_without_an_own_slack_row_takes_the_pooled_one():
    model = fit(growth=0.02, method="constant-fraction", test_id="T-9")
    assert model.coefficients["relaxed_free_length"] == pytest.approx(L0 + 0.01)


def test_ranges_are_those_of_the_stretched_marks():
    model = fit()
    assert (model.tension_low, model.tension_high) == (0.0, 1290.0)
    line = fit(method="marks")
    low, high = (L0 * (1 + e) + LS * (1 + COMPLIANCE * f**EXPONENT) for e, f in TESTS["T-1"][::2])
    assert (line.position_low, line.position_high) == pytest.approx((low, high))
    assert np.isnan(line.tension_high)


def test_too_narrow_a_span_holds_the_exponent_at_one():
    model = fit(NARROW, method="tension-driven")
    assert model.coefficients["splice_exponent"] == 1.0
    assert any("factor of 1.57 in tension do not fix the exponent" in line for line in model.made)


def test_two_marks_hold_the_exponent_at_one_though_they_span_enough():
    model = fit({"T-1": [(0.5, 200.0), (1.5, 700.0)]}, method="tension-driven")
    assert model.coefficients["splice_exponent"] == 1.0


def test_a_vague_exponent_is_held_at_one_and_the_history_gives_it():
    tests = {"T-1": [(0.05, 4.0), (0.07, 7.0), (0.10, 10.0)]}
    model = fit(tests, method="tension-driven")
    assert model.coefficients["splice_exponent"] == 1.0
    assert any("only to 0.85 +- " in line for line in model.made)


@pytest.mark.parametrize(
    "count", [10, pytest.param(300, marks=[pytest.mark.nightly, pytest.mark.slow])]
)
def test_joint_covariance_is_that_of_many_campaigns(count):
    """Distances of the coefficients in the stated covariance, squared, are those of chi-square."""
    law = {"method": "tension-driven"}
    model = fit(**law)
    names = list(model.coefficients)
    fitted = [fit(noise=READING, seed=one, **law).coefficients for one in range(count)]
    off = np.array([[one[name] - model.coefficients[name] for name in names] for one in fitted])
    total = np.einsum("kp,pq,kq->", off, np.linalg.inv(model.covariance), off)
    low, high = stats.chi2.ppf([0.001, 0.999], off.size)
    assert low < total < high


def test_a_law_that_was_asked_for_and_does_not_fit_is_refused():
    marks, force = campaign(TESTS)
    marks = SpliceMarks(
        "new", marks.test, marks.hold, marks.near_toe, marks.far_toe,
        marks.free_length + LS * (1 - 0.00001 * force), READING,
    )  # fmt: skip
    with pytest.raises(FitError, match="do not lengthen"):
        fit_strain_model(
            Specimen("new"),
            test_id="T-1",
            marks=marks,
            mark_tension=force,
            settings=StrainSettings("tension-driven"),
        )


def test_a_method_of_marks_without_marks_is_refused():
    with pytest.raises(DataError, match="by strain-ratio needs splice marks"):
        fit_strain_model(Specimen("new"), test_id="T-1", settings=StrainSettings("strain-ratio"))


def test_tensions_that_do_not_pair_up_are_refused():
    marks, force = campaign(TESTS)
    with pytest.raises(DataError, match="found 7 tensions for 8 marks"):
        fit_strain_model(Specimen("new"), test_id="T-1", marks=marks, mark_tension=force[1:])


def test_contradicting_marks_are_refused_in_the_tests_that_use_them():
    marks, force = campaign(TESTS)
    far = marks.far_toe.copy()
    far[1] += 1.0  # T-1, min
    bad = SpliceMarks(
        "new", marks.test, marks.hold, marks.near_toe, far, marks.far_thimble + (far > 5.2), READING
    )
    with pytest.raises(DataError, match="in test T-1 contradict each other"):
        fit_strain_model(Specimen("new"), test_id="T-1", marks=bad, mark_tension=force)
    # the survey gives the tensions of T-1 up, and T-5 stands on its own marks
    known = np.where(np.array(bad.test) == "T-1", np.nan, force)
    model = fit_strain_model(
        Specimen("new"), test_id="T-5", marks=bad, mark_tension=known,
        settings=StrainSettings("tension-driven"),
    )  # fmt: skip
    assert set(np.array(model.mark_test)[model.mark_strain > 0.1]) == {"T-5"}


def test_the_ratio_of_slopes_is_that_of_the_curves_over_the_own_marks():
    model, legacy = fit(test_id="T-5"), fit(test_id="T-5", method="constant-fraction")
    rows = np.array(model.mark_test) == "T-5"
    rows &= np.array(model.mark_hold) != "slack"
    position, force = model.mark_position[rows], model.mark_tension[rows]
    slopes = [
        np.polyfit(position, strain_by_model(m, position=position, tension=force), 1)[0]
        for m in (legacy, model)
    ]
    assert model.strain_slope_ratio == pytest.approx(slopes[0] / slopes[1])
    assert legacy.strain_slope_ratio == pytest.approx(1.0)


def test_one_stretched_mark_has_no_slope():
    model = fit({"T-1": [(1.0, 480.0)]}, method="strain-ratio")
    assert np.isnan(model.strain_slope_ratio)


def test_without_marks_the_extensometer_comes_before_the_gauge_length():
    rope = Specimen("rope", gauge_length=1.0)
    both = fit_strain_model(rope, test_id="a", has_extensometer=True, zero=ZeroStrain(0.0))
    assert both.method == "extensometer"
    alone = fit_strain_model(rope, test_id="a", zero=ZeroStrain(0.25))
    assert alone.method == "gauge-length"
    assert alone.coefficients == {"reference_position": 0.25, "gauge_length": 1.0}


def test_the_uncertainty_of_a_stated_gauge_length_is_shared_by_all_strains():
    stated = Specimen("hose", gauge_length=2.0, gauge_length_standard_uncertainty=0.01)
    model = fit_strain_model(stated, test_id="a", zero=ZeroStrain(2.0))
    assert tuple(map(str, model.notes)) == () and model.relaxed_length == 2.0
    # at 100 and at 50 %, 0.5 % of the strain
    field = error_field(
        InstrumentErrors("hose"), model, strain=np.array([1.0, 0.5]), tension=np.ones(2)
    )
    assert np.hypot.reduce(field.strain) == pytest.approx([0.005, 0.0025], rel=1e-6)


def test_a_gauge_length_without_one_counts_as_exact_and_says_so():
    model = fit_strain_model(Specimen("a", gauge_length=2.0), test_id="a", zero=ZeroStrain(0.0))
    assert not model.covariance.any()
    (note,) = map(str, model.notes)
    assert note.startswith("the gauge length is treated as exact")


def test_the_relaxed_length_is_that_which_stretches():
    marked = fit({"T-1": [(1.0, 480.0)]}, method="strain-ratio")
    assert marked.relaxed_length == marked.coefficients["relaxed_free_length"]
    assert np.isnan(StrainModel("a", "extensometer").relaxed_length)


def test_gauge_length_names_what_it_lacks():
    gauge = StrainSettings("gauge-length")
    with pytest.raises(DataError, match="by gauge-length lacks a gauge length"):
        fit_strain_model(Specimen("rope"), test_id="a", settings=gauge, zero=ZeroStrain(0.0))
    with pytest.raises(
        DataError, match="lacks a position of zero .*as zero of its.*state reference_t"
    ):
        fit_strain_model(Specimen("rope", gauge_length=1.0), test_id="a", settings=gauge)


def rests(positions, is_rest):
    n = len(positions)
    return Standstills(
        first=np.arange(n), last=np.arange(n), start_time=np.arange(n) * 1.0,
        end_time=np.arange(n) * 1.0, mean_position=np.array(positions, dtype=float),
        mean_tension=np.zeros((1, n)), is_rest=np.array(is_rest, dtype=bool),
        position_tolerance=0.01, slack_tension=5.0,
    )  # fmt: skip


LOAD = np.zeros((1, 32))


def test_zero_strain_is_at_the_first_rest():
    stands = rests([0.5, 0.1, 0.2], [False, True, True])
    place = np.array([0.5, 0.1, 0.2, *np.arange(1.0, 30.0)])
    assert zero_at_slack(stands, place, LOAD, position_is_length=True).position == 0.1


@pytest.mark.parametrize(
    ("rest", "stated", "zero", "said"),
    [(0.13, 0.1, 0.1, False), (0.05, 0.1, 0.05, True), (0.13, None, 0.13, True)],
)
def test_a_rest_behind_the_loading_is_zero_strain_only_without_a_shorter_statement(
    rest, stated, zero, said
):
    # cycled from the first reading on, and let slack at the end with a set
    place = np.array([0.5, 0.7, rest, *np.full(29, rest)])
    load = np.array([[300.0, 500.0, *np.zeros(30)]])
    stands = rests([0.5, 0.7, rest], [False, False, True])
    found = zero_at_slack(stands, place, load, position_is_length=True, length_at_slack=stated)
    assert found.position == zero
    specimen = Specimen("rope", gauge_length=0.1)
    codes = [one.code for one in _without_marks(specimen, "gauge-length", found, None).notes]
    assert ("zero-behind-load" in codes) is said


def test_zero_strain_of_a_coarse_position_is_uncertain_by_a_code():
    stands = dataclasses.replace(rests([0.1], [True]), last=np.array([99]))
    # a position in steps of a millimetre stands anywhere within one: half of it over root three
    coarse = np.round(np.clip(0.0003 * np.arange(1000.0) - 0.03, 0, None), 3) + 0.1
    zero = zero_at_slack(stands, coarse, np.zeros((1, 1000)), position_is_length=True)
    assert zero.position == pytest.approx(0.1)
    assert zero.standard_uncertainty == pytest.approx(0.5e-3 / np.sqrt(3), rel=0.05)


def test_zero_strain_at_a_rest_is_uncertain_by_its_noise_and_its_drift():
    stands = dataclasses.replace(rests([0.1], [True]), last=np.array([99]))
    for drift, least in ((0.0, 1e-3), (5e-3, 5e-3 / np.sqrt(12))):
        off = []
        for seed in range(200):
            place = 0.1 + np.clip(0.003 * (np.arange(1000.0) - 99), 0, None)
            place[:100] += np.linspace(-0.5, 0.5, 100) * drift
            place += np.random.default_rng(seed).normal(0, 0.01, 1000)
            stand = dataclasses.replace(stands, position_tolerance=0.12)
            zero = zero_at_slack(stand, place, np.zeros((1, 1000)), position_is_length=True)
            off.append([zero.position - 0.1, zero.standard_uncertainty])
        error, spread = np.transpose(off)
        assert 0.5 < np.sqrt(np.mean((error / spread) ** 2)) < 1.2
        assert np.median(spread) == pytest.approx(least, rel=0.3)


@pytest.mark.parametrize("rate", [0.5, 1.0, 2.0])  # deviations of the noise per reading
@pytest.mark.parametrize("standing", [1, 3, 4, 6])
def test_a_slow_ramp_among_the_first_readings_is_in_the_interval_of_their_zero(rate, standing):
    off = []
    for seed in range(100):
        noise = np.random.default_rng(seed).normal(0, 1e-4, 400)
        place = 7 + 1e-4 * rate * np.clip(np.arange(400) - (standing - 1), 0, None) + noise
        zero = zero_at_start(place, 1e4 * (place[None] - 7), slack_tension=1e3)
        if zero is not None:
            off.append((zero.position - 7) / zero.standard_uncertainty)
    assert np.sqrt(np.mean(np.square(off))) < 2.5


@pytest.mark.parametrize("slack", [True, False])
def test_a_rest_whose_noise_an_interpolation_hides_gives_the_zero_of_strain(slack):
    """Synthetic: 5 s at 7 m, read every 0.15 s with a noise of 0.3 mm, logged every 0.05 s."""
    time = np.arange(0, 40, 0.05)
    place = 7 + 0.2 * np.clip(time - 5, 0, None) % 4
    read = place[::3] + np.random.default_rng(1).normal(0, 3e-4, place[::3].size)
    logged = np.interp(time, time[::3], read)
    load = 1e3 * (place - (7 if slack else 6))[None]
    stands = find_standstills(time, logged, load, settings=PhaseSettings())
    assert not stands.is_rest.any()
    zero = zero_before_a_move(
        time, logged, load, slack_tension=stands.slack_tension, minimum_duration=3.0
    )
    if slack:
        assert abs(zero.position - 7) < 2 * zero.standard_uncertainty < 1e-3
    else:
        assert zero is None


def test_noise_of_one_reading_does_not_make_a_log_slack_that_begins_on_its_way():
    moved, zeros = np.linspace(0.015, 0.1, 200), []
    for seed in range(50):
        noise = np.random.default_rng(seed).normal(0, 2.0, moved.size)
        load = 1000 * (moved / 0.1) ** 3 + noise  # an eighth, twice as far
        zeros.append(zero_at_start(moved, load[None], slack_tension=20.0, stated=0.0))
    assert zeros == [None] * 50


@pytest.mark.parametrize(("begins", "said"), [(0.02, True), (0.0004, False)])
def test_a_zero_of_strain_beyond_the_stated_length_at_slack_is_told(begins, said):
    moved = np.linspace(begins, 0.1, 200)
    zero = zero_at_start(moved, 1e4 * (moved - begins)[None], slack_tension=20.0, stated=0.0)
    assert zero.position == begins
    specimen = Specimen("rope", gauge_length=1.0)
    codes = [one.code for one in _without_marks(specimen, "gauge-length", zero, None).notes]
    assert ("slack-beyond-zero" in codes) is said


def test_zero_strain_is_that_of_a_rest_without_the_slow_ramp_after_it():
    # noise hides the first two seconds of a ramp of 9 mm a second
    time = np.arange(0.0, 180.0, 0.35)
    place = 3 + 0.009 * np.clip(time - 8, 0, None)
    place += np.random.default_rng(2).normal(0, 2e-3, time.size)
    stands = find_standstills(time, place, [100 * (place - 3)], settings=PhaseSettings())
    zero = zero_at_slack(stands, place, 100 * (place[None] - 3), position_is_length=True)
    assert zero.position == pytest.approx(3, abs=2 * 2e-3 / np.sqrt(23))


def test_without_a_rest_only_a_displacement_has_a_zero():
    stands = rests([0.5], [False])
    assert zero_at_slack(stands, np.arange(9.0), LOAD, position_is_length=False).position == 0.0
    assert zero_at_slack(stands, np.arange(9.0), LOAD, position_is_length=True).position is None
    # the length at displacement zero, read at slack, is that of zero strain
    stated = zero_at_slack(
        stands, np.arange(9.0), LOAD, position_is_length=True, length_at_slack=1.5
    )
    assert stated.position == 1.5


def test_fit_to_marks_is_the_same_model_without_remarks():
    marks, force = campaign(TESTS)
    own = np.array([name == "T-1" for name in marks.test])
    model = fit_to_marks("tension-driven", PooledMarks(marks, force, own))
    assert model.coefficients == fit(method="tension-driven").coefficients
    assert tuple(map(str, model.notes)) == ()


@pytest.mark.parametrize(
    ("creep", "stated"), [(0.03, {}), (0.12, {"splice_creep": 0.08, "is_creep_stated": True})]
)
def test_what_splices_creep_while_a_mark_waits_is_in_the_interval_of_a_stroke(creep, stated):
    """In the cycles they extend from their mean by 3 or 12 % less than from mark to mark."""
    marks, force = campaign(TESTS)
    exact = dataclasses.replace(marks, reading_uncertainty=1e-5, is_reading_stated=True, **stated)
    model = fit_strain_model(Specimen("new"), test_id="T-1", marks=exact, mark_tension=force)
    strain, load = np.array(NARROW["T-1"]).T
    splice = COMPLIANCE * load**EXPONENT
    in_cycles = splice.mean() + (1 - creep) * (splice - splice.mean())
    position = L0 * (1 + strain) + LS * (1 + in_cycles)
    found = strain_by_model(model, position=position, tension=load)
    _, slope = strain_sensitivity_of(model, position=position, tension=load)
    stroke = slope[:, 2] - slope[:, 0]
    spread = np.sqrt(stroke @ (model.covariance + model.law_covariance) @ stroke)
    away = found[2] - found[0] - (strain[2] - strain[0])
    assert away == pytest.approx(-creep * LS / L0 * (splice[2] - splice[0]), rel=0.1)
    assert abs(away) < 1.96 * spread
    assert bool(stated) is ("splice-creep-unknown" not in [one.code for one in model.notes])
    # the middle of the stroke is as sure as the tape
    middle = slope[:, 1]
    assert middle @ model.law_covariance @ middle < (0.1 * away) ** 2


def test_what_creep_of_splices_would_do_to_an_amplitude_is_stated():
    marks, _ = campaign(TESTS)
    (told,) = [one for one in fit().notes if one.code == "splice-creep-unknown"]
    loaded = marks.free_length > 1.01 * L0
    slope = np.polyfit(marks.free_length[loaded], marks.splice_length[loaded], 1)[0]
    assert told.numbers["effect"] == pytest.approx(0.1 * slope)
    assert told.severity == "note"


REFUSED = {
    "tension driven without a tension is refused": (
        lambda: fit(method="tension-driven", tension=False),
        DataError,
        "by tension-driven has no mark to use",
    ),
    "slack rows alone are refused": (
        lambda: fit({"T-1": []}),
        DataError,
        "splices of 'new' have no law",
    ),
    "nothing to go by is refused": (
        lambda: fit_strain_model(Specimen("rope"), test_id="a"),
        DataError,
        "no strain method applies to 'rope'",
    ),
}


test_refusals = refusals(REFUSED)
