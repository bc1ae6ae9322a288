"""Unit tests of reduction.stages.moduli.stepwise_test; the numbers of a real test are in tests/golden."""

import numpy as np
import pytest
from refusals import refusals

from reduction.record.errors import DataError
from reduction.record.measurement import StepReadings
from reduction.record.notes import note
from reduction.stages.moduli.stepwise_test import (
    _find_inconsistent_readings,
    _interval_slopes,
    _recover_gauge_length,
    _step_branches,
    reduce_stepwise,
)

AREA, GAUGE, MODULUS = 5e-4, 0.15, 8e5
WEIGHTS = np.array([100.0, 200.0, 300.0, 400.0, 300.0, 200.0])


def readings(weights=WEIGHTS, *, strain=None, printed=True, uncertainty=0.0005, **more):
    weights = np.asarray(weights, dtype=float)
    strain = weights / AREA / MODULUS if strain is None else np.asarray(strain)
    return StepReadings(
        clock=tuple(f"{900 + 10 * i:04d}" for i in range(weights.size)),
        time=600.0 * np.arange(weights.size),
        tension=weights,
        length=GAUGE * (1 + strain),
        eye_to_eye_length=np.full(weights.size, np.nan),
        printed_strain=strain if printed else np.full(weights.size, np.nan),
        length_standard_uncertainty=uncertainty,
        **more,
    )


def test_a_linear_elastic_sample_gives_its_modulus_everywhere_but_at_the_turn():
    result = reduce_stepwise(readings(), area=AREA)
    expected = [MODULUS, MODULUS, MODULUS, np.nan, MODULUS]
    np.testing.assert_allclose(result.interval_modulus, expected, rtol=1e-9)
    np.testing.assert_allclose(result.secant_modulus, MODULUS, rtol=1e-9)
    assert result.interval_branch.tolist() == [1, 1, 1, 0, 2]


def test_uncertainty_is_that_of_reading_the_tape_at_both_ends():
    result = reduce_stepwise(readings(), area=AREA)
    step = 100.0 / AREA / MODULUS
    relative = np.sqrt(2) * 0.0005 / GAUGE / step
    assert result.interval_modulus_standard_uncertainty[0] == pytest.approx(MODULUS * relative)


def test_uncertainty_of_the_weights_adds_to_it():
    alone = reduce_stepwise(readings(), area=AREA)
    both = reduce_stepwise(readings(tension_standard_uncertainty=2.0), area=AREA)
    added = np.sqrt(2) * 2.0 / AREA / (100.0 / AREA / MODULUS)
    expected = np.hypot(alone.interval_modulus_standard_uncertainty, added)
    np.testing.assert_allclose(both.interval_modulus_standard_uncertainty, expected)


def test_a_secant_modulus_has_the_uncertainty_of_its_reading_and_its_weight():
    result = reduce_stepwise(readings(tension_standard_uncertainty=2.0), area=AREA)
    strain = WEIGHTS / AREA / MODULUS
    relative = np.hypot(0.0005 / GAUGE / strain, 2.0 / WEIGHTS)
    np.testing.assert_allclose(result.secant_modulus_standard_uncertainty, MODULUS * relative)


def test_an_unstated_reading_uncertainty_is_the_scatter_and_a_note_says_so():
    log = readings(uncertainty=float("nan"))
    miss = 0.0006 * np.array([1, -1, 1, -1, 1, -1])
    scattered = StepReadings(
        log.clock, log.time, log.tension, log.length + miss, log.eye_to_eye_length,
        log.printed_strain,
    )  # fmt: skip
    result = reduce_stepwise(scattered, area=AREA)
    assert any(
        "the uncertainty of the lengths is not stated" in note for note in map(str, result.notes)
    )
    assert any("recorded elongation, 0.60 mm" in note for note in map(str, result.notes))


def test_creep_at_one_weight_is_flagged_and_gives_no_modulus():
    result = reduce_stepwise(
        readings([100, 200, 200, 300], strain=[0.25, 0.50, 0.53, 0.75]), area=AREA
    )
    assert result.is_creep.tolist() == [False, False, True, False]
    assert np.isnan(result.interval_modulus).tolist() == [False, True, False]
    (of_creep,) = (one for one in result.notes if one.code == "reading-again")
    assert of_creep.severity == "note"
    assert str(of_creep) == "reading 0920: read again after 10 min under the same weight: +4.5 mm"
    assert result.made[0].startswith("gauge length ")


def test_a_length_that_shrinks_under_more_weight_gives_no_modulus():
    result = reduce_stepwise(readings([100, 200, 300], strain=[0.25, 0.50, 0.49]), area=AREA)
    assert result.is_creep.tolist() == [False, False, True]
    assert np.isnan(result.interval_modulus[1])


def test_a_repeated_reading_is_neither_creep_nor_slope():
    result = reduce_stepwise(readings([100, 200, 200], strain=[0.25, 0.5, 0.5]), area=AREA)
    assert not result.is_creep.any()
    assert np.isnan(result.interval_modulus[1])


def test_a_misread_length_is_kept_with_its_flag():
    strain = WEIGHTS / AREA / MODULUS
    log = readings()
    length = log.length.copy()
    length[2] += 0.02
    misread = StepReadings(
        log.clock, log.time, log.tension, length, log.eye_to_eye_length, log.printed_strain
    )
    result = reduce_stepwise(misread, area=AREA)
    assert result.is_inconsistent.tolist() == [False, False, True, False, False, False]
    assert result.strain[2] == pytest.approx(strain[2] + 0.02 / GAUGE)
    assert np.isnan(result.interval_modulus[1:3]).all()
    assert np.isnan(result.secant_modulus[2])
    (note,) = [text for text in map(str, result.notes) if text.startswith("reading 0920")]
    assert (
        "would agree, and the moduli of the adjacent intervals would be 0.80 and 0.80 MPa" in note
    )


@pytest.mark.parametrize(("eye_follows", "word"), [("length", "length"), ("strain", "elongation")])
def test_the_eye_to_eye_length_says_which_of_two_readings_to_doubt(eye_follows, word):
    log = readings()
    length = log.length.copy()
    length[2] += 0.02
    eye = 1.0 + 6 * (length if eye_follows == "length" else log.length)
    result = reduce_stepwise(
        StepReadings(log.clock, log.time, log.tension, length, eye, log.printed_strain), area=AREA
    )
    assert any(f"supports the {word})" in note for note in map(str, result.notes))


def test_without_recorded_elongations_the_stated_gauge_length_is_used():
    result = reduce_stepwise(readings(printed=False), area=AREA, stated_gauge_length=GAUGE)
    assert result.gauge_length == GAUGE
    assert np.isnan(result.gauge_length_standard_uncertainty)
    np.testing.assert_allclose(result.interval_modulus[:3], MODULUS)


def gent(stretch, *, shear=3.7e5, limit=30.0):
    """Nominal stress of a Gent rubber in tension: stiffens on the way to a limit of its stretch."""
    invariant = stretch**2 + 2 / stretch - 3
    return shear * (stretch - stretch**-2) / (1 - invariant / limit)


def under(weights, law=gent):
    """Strain under weights, by bisection."""
    low, high = np.full(np.shape(weights), 1.0), np.full(np.shape(weights), 4.5)
    for _ in range(60):
        middle = (low + high) / 2
        is_below = law(middle) < np.asarray(weights) / AREA
        low, high = np.where(is_below, middle, low), np.where(is_below, high, middle)
    return low - 1


RISING = np.linspace(200.0, 900.0, 8)


@pytest.mark.parametrize("n_weights", [3, 5, 9, 17])
def test_a_slope_between_readings_is_known_as_the_modulus_at_its_middle(n_weights):
    weights = np.linspace(100.0, 900.0, n_weights)
    result = reduce_stepwise(readings(weights, strain=under(weights)), area=AREA)
    middle, step = 1 + result.interval_strain, 1e-5
    modulus = (gent(middle + step) - gent(middle - step)) / (2 * step)
    error = result.interval_modulus - modulus
    assert np.all(np.abs(error) < 2 * result.interval_modulus_standard_uncertainty)
    # and no wider than ten times that error, or the readings
    alone = np.sqrt(2) * 0.0005 / GAUGE * result.interval_modulus / np.diff(result.strain)
    assert np.all(result.interval_modulus_standard_uncertainty < 10 * np.hypot(error, alone))


def test_one_slope_is_no_modulus_at_a_strain():
    result = reduce_stepwise(readings([100, 800, 100], strain=under([100, 800, 100])), area=AREA)
    assert np.isnan(result.interval_modulus).all()
    assert np.isfinite(result.secant_modulus).all()
    assert [one.code for one in result.notes if one.severity == "refusal"] == [
        "one-slope-of-weights"
    ]


@pytest.mark.parametrize("place", [2, 3, 4, 5])
def test_a_length_off_the_others_is_named_and_gives_no_modulus(place):
    strain = under(RISING)
    strain[place] += 0.2
    log = readings(RISING, strain=strain, printed=False)
    result = reduce_stepwise(log, area=AREA, stated_gauge_length=GAUGE)
    assert np.flatnonzero(result.is_odd).tolist() == [place]
    assert np.isnan(result.interval_modulus[max(place - 1, 0) : place + 1]).all()
    (said,) = (one for one in result.notes if one.code == "reading-of-odd-length")
    assert said.subject == f"reading {log.clock[place]}"
    off = said.numbers["length"] - said.numbers["expected"]
    assert off == pytest.approx(0.2 * GAUGE, rel=0.2)


@pytest.mark.parametrize("seed", range(20))
def test_lengths_read_to_a_millimetre_are_not_odd(seed):
    weights = np.concatenate([RISING, RISING[-2::-1]])
    strain = under(weights) + np.where(np.arange(15) > 7, 0.03 * np.sin(weights / 300.0), 0.0)
    length = GAUGE * (1 + strain) + np.random.default_rng(seed).normal(0, 1e-3, 15)
    result = reduce_stepwise(
        readings(weights, strain=length / GAUGE - 1, printed=False),
        area=AREA, stated_gauge_length=GAUGE,
    )  # fmt: skip
    assert not result.is_odd.any()


def test_a_weight_with_a_digit_too_many_does_not_turn_the_branch():
    weights = RISING.copy()
    weights[3] *= 10
    log = readings(weights, strain=under(RISING), printed=False)
    result = reduce_stepwise(log, area=AREA, stated_gauge_length=GAUGE)
    assert np.flatnonzero(result.is_odd).tolist() == [3]
    assert set(result.branch.tolist()) == {1}
    sound = reduce_stepwise(
        readings(RISING, strain=under(RISING), printed=False),
        area=AREA, stated_gauge_length=GAUGE,
    )  # fmt: skip
    kept = np.isfinite(result.interval_modulus)
    np.testing.assert_allclose(result.interval_modulus[kept], sound.interval_modulus[kept])
    assert kept.tolist() == [True, True, False, False, True, True, True]


def test_notes_of_the_log_come_first():
    typed = note("laboratory", text="typed")
    assert reduce_stepwise(readings(notes=(typed,)), area=AREA).notes[0] == typed


# unit tests of reduction.stages.moduli.stepwise_test

STRAIN = np.array([0.2, 0.5, 0.9, 1.3, 1.7])


def test_gauge_length_of_exact_readings_is_exact():
    gauge, uncertainty = _recover_gauge_length(0.15 * (1 + STRAIN), STRAIN)
    assert gauge == pytest.approx(0.15)
    assert uncertainty == pytest.approx(0.0, abs=1e-12)


def test_one_misread_row_moves_neither_gauge_length_nor_its_uncertainty():
    length = 0.15 * (1 + STRAIN)
    length[2] *= 1.2
    gauge, uncertainty = _recover_gauge_length(length, STRAIN)
    assert gauge == pytest.approx(0.15)
    assert uncertainty == pytest.approx(0.0, abs=1e-12)


def test_rows_without_a_recorded_elongation_are_left_out():
    printed = np.where(STRAIN > 1, np.nan, STRAIN)
    assert _recover_gauge_length(0.15 * (1 + STRAIN), printed)[0] == pytest.approx(0.15)


def test_the_uncertainty_of_a_gauge_length_is_that_of_the_median():
    rng = np.random.default_rng(6)
    strain = np.linspace(0.1, 2.0, 40)
    found = np.array(
        [
            _recover_gauge_length((0.15 + rng.normal(0, 0.001, 40)) * (1 + strain), strain)
            for _ in range(400)
        ]
    )
    assert np.median(found[:, 1]) == pytest.approx(found[:, 0].std(), rel=0.15)


def test_few_readings_that_agree_by_chance_neither_narrow_the_gauge_length_nor_accuse_the_others():
    """Nine synthetic readings with the stated error: a deviation from their median varies by half."""
    rng, error = np.random.default_rng(8), 0.001
    strain = np.linspace(0.4, 2.0, 9)
    off, accused = [], 0
    for _ in range(400):
        length = 0.15 * (1 + strain) + rng.normal(0, error, 9)
        gauge, uncertainty = _recover_gauge_length(length, strain, length_uncertainty=error)
        off.append((gauge - 0.15) / uncertainty)
        accused += _find_inconsistent_readings(
            length, strain, gauge_length=gauge, length_uncertainty=error
        ).any()
    assert np.std(off) < 1.1
    assert np.mean(np.abs(off) < 1.96) > 0.93
    assert accused == 0


def test_an_impossible_reading_is_refused():
    with pytest.raises(DataError, match="values of length are not positive"):
        _recover_gauge_length([-0.2], [0.1])
    with pytest.raises(DataError, match=r"1 \+ printed_strain"):
        _recover_gauge_length([0.2], [-1.0])


def test_rows_within_the_last_digit_agree_however_exact_the_others():
    length = 0.15 * (1 + STRAIN)
    length[3] += 0.15 * 0.009
    assert not _find_inconsistent_readings(length, STRAIN, gauge_length=0.15).any()
    length[3] += 0.15 * 0.002
    bad = _find_inconsistent_readings(length, STRAIN, gauge_length=0.15)
    assert bad.tolist() == [False, False, False, True, False]


def test_rows_that_scatter_set_their_own_limit():
    miss = np.array([0.02, -0.02, 0.02, -0.02, 0.09])
    assert not _find_inconsistent_readings(1 + STRAIN + miss, STRAIN, gauge_length=1.0).any()


def test_what_was_not_recorded_cannot_disagree():
    assert not _find_inconsistent_readings([0.2, 0.3], [np.nan, np.nan], gauge_length=0.15).any()


@pytest.mark.parametrize(
    ("weights", "branch"),
    [
        ([1, 2, 3, 2, 1], [1, 1, 1, 2, 2]),
        ([3, 2, 1], [2, 2, 2]),
        ([1, 1, 2, 2, 1, 1], [1, 1, 1, 1, 2, 2]),
        ([2, 2, 1], [2, 2, 2]),
        ([1, 2, 1, 2], [1, 1, 2, 1]),
    ],
)
def test_branches_follow_the_weights(weights, branch):
    assert _step_branches(weights).tolist() == branch


@pytest.mark.parametrize("weights", [[5.0, 5.0], [5.0]])
def test_weights_that_never_change_have_no_branch(weights):
    with pytest.raises(DataError, match="never change"):
        _step_branches(weights)


def test_slope_and_uncertainty_of_an_interval():
    middle, modulus, uncertainty = _interval_slopes(
        [100.0, 160.0], [0.5, 0.8], area=2.0, tension_uncertainty=3.0, strain_uncertainty=0.003
    )
    assert middle.tolist() == pytest.approx([0.65])
    assert modulus.tolist() == pytest.approx([100.0])
    # sqrt 2 times 5 % of tension and 1 % of strain, added in quadrature
    assert uncertainty.tolist() == pytest.approx([100.0 * np.sqrt(2 * (0.05**2 + 0.01**2))])


def test_no_change_of_strain_has_no_slope():
    _, modulus, uncertainty = _interval_slopes([1.0, 2.0, 3.0], [0.1, 0.1, 0.2], area=1.0)
    assert np.isnan(modulus).tolist() == [True, False]
    assert np.isnan(uncertainty).tolist() == [True, False]


def test_slopes_need_an_area_and_equal_series():
    with pytest.raises(DataError, match="area are not positive"):
        _interval_slopes([1.0, 2.0], [0.1, 0.2], area=0.0)
    with pytest.raises(DataError, match="series do not pair up"):
        _interval_slopes([1.0, 2.0], [0.1], area=1.0)


REFUSED = {
    "neither elongation nor gauge length is refused": (
        lambda: reduce_stepwise(readings(printed=False), area=AREA),
        DataError,
        "no reading has a recorded elongation",
    ),
    "one step is refused": (
        lambda: reduce_stepwise(readings([100.0]), area=AREA),
        DataError,
        "a stepwise test needs two steps; found 1",
    ),
    "no area is refused": (
        lambda: reduce_stepwise(readings(), area=0.0),
        DataError,
        "area are not positive",
    ),
    "no recorded elongation is refused": (
        lambda: _recover_gauge_length([0.2], [np.nan]),
        DataError,
        "no reading has a recorded elongation",
    ),
    "disagreement needs a gauge length": (
        lambda: _find_inconsistent_readings([0.2], [0.1], gauge_length=0.0),
        DataError,
        "gauge_length are not positive",
    ),
}


test_refusals = refusals(REFUSED)
