import numpy as np
import pytest
from measured_hoses import Truth

from reduction.prediction.comparison_error import (
    _strain_at_tension,
    cycle_differences,
    difference_of,
    energy_difference,
    event_differences,
)
from reduction.prediction.measured_curve import constant_errors, measured_curve
from reduction.record.errors import DataError


def cycled(tension_of, *, top=1.0, n_cycles=4, loop=0.0, drift=0.0, **options):
    phase = np.linspace(0, n_cycles, n_cycles * 800, endpoint=False)
    strain = top * (1 - np.abs(2 * (phase % 1) - 1))
    branch, number = np.where(phase % 1 < 0.5, 1, 2), phase.astype(int) + 1
    tension = tension_of(strain) + np.where(branch == 1, loop, -loop) / 2
    tension = tension + drift * np.log10(number)
    return measured_curve(
        strain, tension, loading="static", cycle_number=number, branch=branch, **options
    )


def test_a_prediction_above_the_test_is_a_positive_difference():
    found = difference_of([0, 1], [12.0, 12.0], [10.0, 10.0], curve="ascending")
    assert found.bias == 2 and found.rms == 2 and found.worst_tension_difference == 2
    assert found.relative_rms == pytest.approx(0.2)


def test_rms_and_worst_point_by_hand():
    # errors 1, -3, 2: mean 0, mean square 14/3; measured 10, 20, 30: mean square 1400/3
    found = difference_of([0, 1, 2], [11.0, 17.0, 32.0], [10.0, 20.0, 30.0], curve="midline")
    assert found.bias == pytest.approx(0)
    assert found.rms == pytest.approx(np.sqrt(14 / 3))
    assert found.relative_rms == pytest.approx(0.1)
    assert (found.worst_strain, found.worst_tension_difference) == (1, -3)


def test_strains_that_one_side_does_not_know_are_left_out():
    found = difference_of([0, 1, 2], [np.nan, 5.0, 7.0], [1.0, 4.0, np.nan], curve="midline")
    assert found.n_strain == 1 and found.bias == 1
    assert np.isnan(found.difference[[0, 2]]).all()


def test_no_strain_in_common_is_refused():
    with pytest.raises(DataError, match="no strain in common; found measured at 0 to 0 %, pred"):
        difference_of([0, 1], [np.nan, 1.0], [1.0, np.nan], curve="midline")
    with pytest.raises(DataError, match="predicted at no strain"):
        difference_of([0, 1], [np.nan, np.nan], [1.0, np.nan], curve="midline")
    with pytest.raises(DataError, match="series do not pair up"):
        difference_of([0, 1], [1.0], [1.0, 2.0], curve="midline")


def test_a_test_of_no_tension_has_no_relative_rms():
    assert np.isnan(difference_of([0.0], [1.0], [0.0], curve="midline").relative_rms)


def test_strain_at_a_tension_is_between_its_neighbours():
    assert _strain_at_tension([0, 1, 2], [0.0, 10.0, 40.0], 25.0) == pytest.approx(1.5)
    assert _strain_at_tension([0, 1, 2], [5.0, 10.0, 40.0], 5.0) == 0
    assert np.isnan(_strain_at_tension([0, 1, 2], [5.0, 10.0, 40.0], 4.0))
    assert np.isnan(_strain_at_tension([0, 1, 2], [5.0, 10.0, np.nan], 20.0))


def test_energy_of_a_loop_is_its_width_times_its_length():
    # straight line 1000 e, loop 60 N wide: 500 + 30 J/m taken over strain 0 to 1, 60 in the loop
    test = cycled(lambda e: 1000 * e, loop=60.0)
    energy = energy_difference(1000 * test.strain, test)
    width = energy.energy_strain_high - energy.energy_strain_low
    middle = 500 * (energy.energy_strain_high**2 - energy.energy_strain_low**2)
    assert width > 0.97
    assert energy.loop_energy == pytest.approx(60 * width, rel=1e-3)
    assert energy.measured_energy == pytest.approx(middle + 30 * width, rel=1e-3)
    assert energy.energy_difference == pytest.approx(-30 * width, rel=1e-2)
    share = -30 * width / (middle + 30 * width)
    assert energy.energy_difference_share == pytest.approx(share, rel=1e-2)
    assert energy.loop_energy_share == pytest.approx(energy.loop_energy / energy.measured_energy)


def test_a_pull_has_no_loop_and_one_point_no_energy():
    strain = np.linspace(0, 1, 500)
    pull = measured_curve(strain, 10 * strain, loading="static")
    assert np.isnan(energy_difference(10 * pull.strain, pull).loop_energy)
    nowhere = np.full(pull.strain.size, np.nan)
    assert np.isnan(energy_difference(nowhere, pull).measured_energy)


def test_a_hose_that_softens_has_a_bias_that_rises_with_the_logarithm_of_cycles():
    test = cycled(lambda e: 500 + 1000 * e, n_cycles=30, drift=-25.0)
    found = cycle_differences(500 + 1000 * test.strain, test)
    assert found.bias_per_decade == pytest.approx(25.0, rel=1e-6)
    assert found.bias_per_decade_standard_uncertainty < 1e-6
    assert found.cycle_bias[0] == pytest.approx(0, abs=0.1)
    assert found.cycle_rms[-1] == pytest.approx(25 * np.log10(30), rel=1e-2)


def test_a_cycle_that_went_less_far_has_no_bias_of_its_own_making():
    phase = np.linspace(0, 4, 3200, endpoint=False)
    number = phase.astype(int) + 1
    strain = (1 - np.abs(2 * (phase % 1) - 1)) * np.where(number == 3, 0.5, 1.0)
    test = measured_curve(
        strain, 1000 * strain**2, loading="static", cycle_number=number,
        branch=np.where(phase % 1 < 0.5, 1, 2),
    )  # fmt: skip
    found = cycle_differences(1300 * test.strain**2, test)  # wrong by more at high strain
    assert found.cycle_bias == pytest.approx(np.full(4, found.cycle_bias[0]), abs=0.5)


def test_two_cycles_have_no_trend():
    test = cycled(lambda e: 10 * e, n_cycles=2)
    assert np.isnan(cycle_differences(10 * test.strain, test).bias_per_decade)


def test_events_against_a_test_that_is_higher_by_a_known_tension():
    truth = Truth()
    test = cycled(lambda e: truth.tension(e) + 100, top=1.2)
    pick_up, working, at_break = event_differences(truth.design(), test)
    assert pick_up.name == "pick_up" and at_break.name == "break"
    assert pick_up.strain == pytest.approx(truth.pick_up_strain())
    assert pick_up.tension_difference == pytest.approx(
        -100, abs=6
    )  # the kink is rounded over a bin
    # a third of the break load of a cord, 10 lbf at 10 %; closed form by bisection of the stretch
    low, high = 1.2, 2.5
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if truth.cord_stretch(middle) < 1.10 else (low, middle)
    assert working.strain == pytest.approx(low - 1)
    assert working.tension_difference == pytest.approx(-100, abs=1)
    slope = (truth.tension(low - 0.999) - truth.tension(low - 1.001)) / 0.002
    assert working.strain_difference == pytest.approx(100 / slope, rel=0.02)
    assert np.isnan(at_break.tension_difference) and np.isnan(at_break.strain_difference)


def test_uncertainty_at_an_event_has_both_sides_in_it():
    truth = Truth()
    test = cycled(truth.tension, top=1.2, shared=constant_errors(tension_offset=40.0))
    alone = event_differences(truth.design(), test)[1]
    assert alone.tension_difference_standard_uncertainty == pytest.approx(40, abs=0.5)
    unsure = event_differences(
        truth.design(), test, standard_uncertainty={"wrap_angle": np.radians(0.5)}
    )[1]
    # a hose half a degree off, its event against the same test
    moved = event_differences(truth.but(wrap_angle=np.radians(64.5)).design(), test)[1]
    by_angle = moved.tension_difference - alone.tension_difference
    assert unsure.tension_difference_standard_uncertainty == pytest.approx(
        np.hypot(40, by_angle), rel=0.1
    )
    by_angle = moved.strain_difference - alone.strain_difference
    slope = 40 / alone.strain_difference_standard_uncertainty
    assert unsure.strain_difference_standard_uncertainty == pytest.approx(
        np.hypot(40 / slope, by_angle), rel=0.1
    )
