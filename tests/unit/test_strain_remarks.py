"""Sentences on strain, and their absence: of the fit to the marks, and of strain none has."""

from dataclasses import replace

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.record.measurement import Specimen, SpliceMarks
from reduction.stages.strain.impossible_strain import (
    note_on_strain_below_zero,
    refuse_impossible_strain,
)
from reduction.stages.strain.strain_fit import _on_reading_time, _remarks_on, _without_marks
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.strain.zero_strain import ZeroStrain, half_band_of, zero_of_bent

L0 = 2.55
READING = 0.00124  # sqrt(3) of it over 2.55 m is 0.084 points


def marks(slack=(3.74, 3.74, 3.74, 3.74), stretched=6):
    names = tuple(f"T-{i + 1}" for i in range(len(slack))) + ("T-1",) * stretched
    position = np.concatenate([np.array(slack), np.linspace(5.9, 7.3, stretched)])
    free = np.concatenate([np.full(len(slack), L0), np.linspace(4.5, 5.8, stretched)])
    near = (position - free) / 2
    holds = ("slack",) * len(slack) + tuple(str(i) for i in range(stretched))
    return SpliceMarks("new", names, holds, near, near + free, position, READING)


def model(residual=(0.0,) * 6, *, method="marks", ratio=1.0, slack=1, **more):
    """A model with slack rows of no residual before the stretched ones."""
    n = len(residual)
    return StrainModel(
        "new",
        method,
        {"relaxed_free_length": L0, **more.pop("coefficients", {})},
        mark_test=("T-1",) * (slack + n),
        mark_hold=("slack",) * slack + tuple(str(i) for i in range(n)),
        mark_position=np.concatenate([np.full(slack, 3.74), np.linspace(5.9, 7.3, n)]),
        mark_strain=np.concatenate([np.zeros(slack), np.linspace(0.76, 1.28, n)]),
        mark_strain_residual=np.concatenate([np.zeros(slack), residual]),
        mark_tension=np.concatenate([np.zeros(slack), np.linspace(300, 500, n)]),
        strain_slope_ratio=ratio,
        **more,
    )


def stretched(found):
    return np.array([hold != "slack" for hold in found.mark_hold])


def remarks(found, readings):
    return [str(one) for one in _remarks_on(found, readings, stretched(found))]


def test_a_fit_without_fault_says_nothing():
    assert remarks(model(), marks()) == []


def test_constant_fraction_names_its_own_miss():
    # 0.3 of 0.35 per metre is the marks' slope: 16.7 % high
    residual = -0.05 * (np.linspace(5.9, 7.3, 6) - 6.6)
    legacy = model(
        tuple(residual),
        method="constant-fraction",
        coefficients={"free_fraction": 0.3 * L0},
    )
    (note,) = remarks(legacy, marks())
    assert "misses its own marks by -3.5 to +3.5 percentage points" in note
    assert "moduli over the marked range are 16.7 % too high" in note


def test_constant_fraction_that_meets_its_marks_or_has_one_says_nothing():
    coefficients = {"free_fraction": 0.777}
    meets = model(method="constant-fraction", coefficients=coefficients)
    assert remarks(meets, marks()) == []
    one = model((0.02,), method="constant-fraction", coefficients=coefficients)
    assert remarks(one, marks()) == []


def test_scatter_beyond_the_tape_is_named():
    residual = 0.004 * np.array([1, -1, 1, -1, 1, -1])
    (note,) = remarks(model(residual), marks())
    assert (
        "differs from the marks by 0.40 percentage points rms; tape reading explains only 0.08"
        in note
    )


def test_what_an_average_over_laws_is_off_by_is_in_its_interval_and_not_said_of_the_marks():
    residual = 0.004 * np.array([1, -1, 1, -1, 1, -1])
    assert remarks(model(residual, method="mixed"), marks()) == []
    # of splices that slip, marks of other tests are off by what lies between
    of_others = 0.02 * np.array([0, 0, 0, 0, 0.01, 1])
    assert remarks(model(of_others, method="mixed"), marks()) == []


def test_a_misread_mark_is_named_by_test_and_hold():
    notes = tuple(map(str, remarks(model((0.0, 0.0005, -0.0005, 0.02, 0.0, 0.0005)), marks())))
    assert any(
        "the mark of test T-1, hold 3, is an outlier: +2.0 percentage points" in n for n in notes
    )


def test_a_growing_slack_length_is_named_and_a_scattering_one_is_not():
    grown = marks(slack=(3.740, 3.751, 3.759, 3.771))
    (note,) = remarks(model(), grown)
    assert "the slack length grows by 30 mm (0.8 %) from the first test to the last" in note
    assert remarks(model(), marks(slack=(3.740, 3.752, 3.739, 3.750))) == []
    # five times the error of a difference of two readings to 3 mm is 21 mm
    for slack, apart in (
        ((3.771, 3.759, 3.751, 3.740), 31),  # shrinks
        ((3.740, 3.760, 3.780), 40),  # too few to tell a trend
    ):
        (note,) = remarks(model(), marks(slack=slack))
        assert f"the far_thimble of the slack rows differs by {apart} mm" in note


def test_a_set_after_the_first_test_is_named_where_the_error_of_the_tape_is_stated():
    """A rubber that keeps 2 % of its length: a step, and no trend."""
    grown = replace(marks(slack=(3.740, 3.792, 3.790)), is_reading_stated=True)
    (note,) = remarks(model(), grown)
    assert "the slack length grows by 51 mm (1.4 %) from the first test to the last" in note
    level = replace(marks(slack=(3.740, 3.744, 3.742)), is_reading_stated=True)
    assert remarks(model(), level) == []


LAW = {"relaxed_splice_length": 1.18, "splice_compliance": 0.001, "splice_exponent": 1.0}


def test_marks_without_a_hold_are_counted():
    driven = model((0.0,) * 4, method="tension-driven", coefficients=LAW, tension_high=500.0)
    (note,) = remarks(driven, marks())
    assert "2 of 6 stretched marks match no hold in the logs and are not used" in note


def test_it_is_said_how_far_the_moment_of_reading_matters():
    driven = model(method="tension-driven", coefficients=LAW, tension_high=500.0)
    softer = {**LAW, "splice_compliance": 0.0009}
    early = model((0.003,) * 6, method="tension-driven", coefficients=softer, tension_high=550.0)
    (note,) = _on_reading_time(driven, stretched(driven), early)
    # 1.18 * (0.001 - 0.0009) * 500 / 2.55
    assert "by 0.00 points of strain rms; read as it begins, 0.30 points" in note
    assert "would be +2.3 points other" in note


def test_a_mark_of_missing_readings_is_told_from_a_wrong_unit():
    strain = np.r_[np.linspace(0, 0.5, 50), -9.99, -9.99]
    with pytest.raises(DataError, match="2 readings have that lowest value.*missing marks"):
        refuse_impossible_strain(strain, specimen="new", test_id="T-1")
    with pytest.raises(DataError, match="Is the unit, the sign or the zero"):
        refuse_impossible_strain(np.linspace(-2, 0.5, 50), specimen="new", test_id="T-1")


@pytest.mark.parametrize(("push", "said"), [(60.0, False), (5.0, True)])
def test_a_specimen_that_was_pushed_pulls_before_it_has_its_length_again(push, said):
    # the way back is 20 N above the way in
    way = np.linspace(-0.1, 0.2, 200)
    strain = np.r_[way[::-1], way]
    tension = np.r_[-push + 100 * way[::-1], 20 + 100 * way]
    found = note_on_strain_below_zero(strain, tension, specimen="h", reference_tension=2.0)
    assert bool(found) is said


@pytest.mark.parametrize(
    ("strain", "tension", "said"),
    [
        # a pull that begins at -25 mm of a gauge of 50 mm and ends at -5 mm
        (np.linspace(-0.5, -0.1, 200), np.linspace(0, 4, 200), True),
        # a spring with a static load, moved about the middle of its stroke
        (np.linspace(-0.1, 0.1, 200), np.linspace(3, 5, 200), False),
        # a pad in compression, its load counted as positive
        (np.linspace(0, -0.4, 200), np.linspace(0, 4, 200), False),
        # a damper
        (np.linspace(-0.5, -0.1, 200), 4 * np.sin(np.arange(200)), False),
    ],
)
def test_what_may_be_pushed_is_not_below_zero_throughout_while_it_pulls(strain, tension, said):
    found = note_on_strain_below_zero(
        strain, tension, specimen="m", reference_tension=0.08, can_push=True
    )
    assert bool(found) is said


@pytest.mark.parametrize(("begins", "zero"), [(0.5, 0.5), (0.45, 0.45)])
def test_a_specimen_that_hangs_bent_at_rest_is_told_from_a_gauge_length_that_is_wrong(begins, zero):
    # soft at first: 0.2 N/mm of 1.6 kN/m at the end
    place = np.r_[np.full(300, 0.45), np.linspace(0.45, 0.8, 700)]
    stretch = np.clip(place - begins, 0, None)
    noise = np.random.default_rng(6).normal(0, 1, (2, place.size))
    load = 200 * stretch + 2000 * stretch**2 + 0.1 * noise[0]
    rest = ZeroStrain(0.45, is_logged=True)
    found = zero_of_bent(rest, place + 1e-5 * noise[1], load, gauge_length=0.5)
    assert found.position == zero
    specimen = Specimen(name="t", kind="rubber tether", gauge_length=0.5)
    said = [one.code for one in _without_marks(specimen, "gauge-length", found, None).notes]
    assert ("bent-at-rest" in said) is (begins == 0.5)


@pytest.mark.parametrize("seed", range(6))
def test_pins_at_the_gauge_length_hang_no_specimen_bent_by_their_noise(seed):
    """The mean of a rest is below the stated length in half of all logs."""
    place = np.r_[np.full(100, 5.0), np.linspace(5.0, 5.3, 3000)]
    noise = np.random.default_rng(seed).normal(0, 1, (2, place.size))
    position, load = place + 1e-5 * noise[0], 1e5 * np.clip(place - 5.0, 0, None) + 10 * noise[1]
    rest = ZeroStrain(float(position[:100].mean()), is_logged=True)
    assert zero_of_bent(rest, position, load, gauge_length=5.0) is rest


@pytest.mark.parametrize(("reference", "half"), [(1000.0, 200.0), (10.0, 30.0)])
def test_a_reading_is_at_the_reference_tension_within_a_fifth_or_its_noise(reference, half):
    """Twelve standard deviations of the noise span its range: six to either side, of 5 N."""
    tension = np.random.default_rng(2).normal(0, 5.0, 5000)
    assert half_band_of(reference, tension) == pytest.approx(half, rel=0.03)
