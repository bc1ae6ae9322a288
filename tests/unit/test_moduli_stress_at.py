"""Stress where a record first passes stated elongations."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.moduli.first_loading import stress_at_strain

X = np.linspace(0, 1.5, 301)


def test_stress_of_a_cubic_is_read_at_the_level():
    tension = 60 * X + 12 * X**3
    stress, spread, reasons = stress_at_strain(X, tension, area=5e-4, levels=(0.5, 1.0))
    # the line ends at the level: on 0.055 of strain its end is off by E' w^2 / 12
    assert stress == pytest.approx((60 * np.array([0.5, 1.0]) + [1.5, 12]) / 5e-4, rel=1e-3)
    assert (spread < 0.001 * stress).all() and reasons == ("", "")


def test_what_comes_after_the_level_does_not_enter():
    strain = np.concatenate([X[X <= 1.01], np.full(500, 1.01)])
    tension = 100 * strain
    tension[np.count_nonzero(X <= 1.01) :] -= 20
    still = np.arange(strain.size) >= np.count_nonzero(X <= 1.01)
    stress, _, _ = stress_at_strain(
        strain, tension, area=1e-4, levels=(1.0,), is_still=still.__getitem__
    )
    assert stress == pytest.approx([1e6])


def test_a_hold_before_the_level_is_left_out():
    strain = np.concatenate([X[X < 0.95], np.full(100, 0.95), X[X > 0.95]])
    still = strain == 0.95
    tension = 100 * strain - 30 * still
    stress, _, _ = stress_at_strain(
        strain, tension, area=1e-4, levels=(1.0,), is_still=still.__getitem__
    )
    assert stress == pytest.approx([1e6])


@pytest.mark.parametrize(("held", "read", "true"), [(0.997, 1.003, 95), (1.003, 0.997, 100)])
def test_a_hold_at_the_level_may_lie_on_its_other_side(held, read, true):
    """100 N per unit strain, of which the hold takes 5 N; its strain is read 0.6 % off."""
    rise = np.linspace(0, 1.2, 2401)
    strain = np.concatenate([rise[rise < held], np.full(100, held), rise[rise > held]])
    still = strain == held
    tension = 100 * strain - 5 * np.cumsum(still) / 100
    stress, spread, _ = stress_at_strain(
        strain + read - held, tension, area=1e-4, levels=(1.0,), is_still=still.__getitem__
    )
    assert 4e4 < abs(stress[0] - true / 1e-4) < 1.96 * spread[0]


def test_a_level_that_is_not_reached_has_no_number_and_no_reason():
    stress, spread, reasons = stress_at_strain(X, 100 * X, area=1e-4, levels=(2.0, -1.0))
    assert np.isnan(stress).all() and np.isnan(spread).all() and reasons == ("", "")


def test_a_log_too_slow_for_the_level_says_so():
    slow = np.arange(0, 2, 0.1)
    stress, _, reasons = stress_at_strain(slow, 100 * slow, area=1e-4, levels=(1.05,))
    assert np.isnan(stress[0]) and "needed 4" in reasons[0]


def test_noise_moves_the_stress_by_its_stated_uncertainty():
    rng = np.random.default_rng(2)
    found = [
        stress_at_strain(X, 100 * X + rng.normal(0, 1, X.size), area=1e-4, levels=(1.0,))
        for _ in range(500)
    ]
    stress = np.array([entry[0][0] for entry in found])
    stated = np.sqrt(np.mean([entry[1][0] ** 2 for entry in found]))
    assert stress.std(ddof=1) == pytest.approx(stated, rel=0.15)
    assert stress.mean() == pytest.approx(1e6, abs=4 * stated / np.sqrt(500))


def test_series_that_do_not_pair_up_are_refused():
    with pytest.raises(DataError, match="do not pair up"):
        stress_at_strain(X, np.ones(4), area=1.0, levels=(1.0,))
    with pytest.raises(DataError, match="area are not positive"):
        stress_at_strain(X, X, area=0.0, levels=(1.0,))
