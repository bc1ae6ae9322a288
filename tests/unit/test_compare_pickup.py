import numpy as np
import pytest
from measured_hoses import Truth

from reduction.prediction.comparison_error import measured_pick_up
from reduction.prediction.measured_curve import constant_errors, measured_curve


def pulled(truth, top, *, noise=20.0, seed=0, **shared):
    strain = np.linspace(0, top, 1500)
    tension = truth.tension(strain) + np.random.default_rng(seed).normal(0, noise, strain.size)
    return measured_curve(strain, tension, loading="static", shared=constant_errors(**shared))


@pytest.mark.parametrize(("angle", "top"), [(62.0, 0.9), (64.0, 1.0), (64.0, 1.3), (68.0, 1.5)])
def test_the_bend_lies_where_the_cords_of_the_hose_are_taut(angle, top):
    truth = Truth(wrap_angle=np.radians(angle), dead_length_share=0.04)
    found = measured_pick_up(pulled(truth, top))
    assert abs(found.strain - truth.pick_up_strain()) < 3 * found.standard_uncertainty
    assert found.standard_uncertainty < 0.01 and found.reason == ""


def test_the_bend_is_found_between_two_bins():
    for at in (0.4012, 0.4050, 0.4088):
        strain = np.linspace(0, 1, 3001)
        bent = 900 * strain + 3000 * np.maximum(strain - at, 0)
        found = measured_pick_up(measured_curve(strain, bent, loading="static"))
        assert found.strain == pytest.approx(at, abs=2e-4)


def test_intervals_of_a_bend_hold_it():
    strain = np.linspace(0, 1, 1500)
    hits = []
    for seed in range(20):
        noise = np.random.default_rng(seed).normal(0, 20, strain.size)
        bent = 9000 * strain - 2000 * strain**2 + 9000 * np.maximum(strain - 0.553, 0) + noise
        found = measured_pick_up(measured_curve(strain, bent, loading="static"))
        hits.append(abs(found.strain - 0.553) < 2 * found.standard_uncertainty)
    assert np.sum(hits) >= 16  # 19 expected; less in one of 400 seeds


@pytest.mark.parametrize("toe", [1.1, 1.25])
def test_cords_that_take_load_as_a_power_of_their_strain_do_not_shift_the_bend(toe):
    """Slack cords of a hose at 64 degrees: T = N P (l cos^2 a - sin^2 a / 2 l^2) / (lc cos a)."""
    angle = np.radians(64)
    stretch = 1 + np.linspace(0, 0.98, 1000)
    along, across = stretch * np.cos(angle), np.sin(angle) / np.sqrt(stretch)
    cord = np.hypot(along, across)
    load = 133.4 * (np.maximum(cord - 1, 0) / 0.26) ** toe
    tension = 748 * load * (along**2 - across**2 / 2) / (cord * stretch)
    tension += 4370 * (stretch - stretch**-2)
    taut = (np.sqrt(1 + 4 * np.tan(angle) ** 2) - 3) / 2
    away = []
    for seed in range(4):
        noise = np.random.default_rng(seed).normal(0, 6, stretch.size)
        found = measured_pick_up(measured_curve(stretch - 1, tension + noise, loading="static"))
        away.append((found.strain - taut) / found.standard_uncertainty)
        assert found.standard_uncertainty < 0.006
    assert np.mean(away) < 2 and np.max(np.abs(away)) < 3


def test_what_the_position_may_be_off_by_is_in_it():
    plain = measured_pick_up(pulled(Truth(), 1.0))
    unsure = measured_pick_up(pulled(Truth(), 1.0, strain_offset=0.03, strain_gain=0.02))
    assert unsure.strain == plain.strain
    assert unsure.standard_uncertainty == pytest.approx(
        np.sqrt(plain.standard_uncertainty**2 + 0.03**2 + (0.02 * plain.strain) ** 2)
    )


@pytest.mark.parametrize(
    ("tension", "reason"),
    [
        (lambda x: 5000 * x, "no upward bend that stands out"),
        (lambda x: 5000 * x - 4000 * np.maximum(x - 0.5, 0), "no upward bend that stands out"),
        (lambda x: 5000 * x + 150 * np.maximum(x - 0.5, 0), "by less than a tenth"),
        (lambda x: 5000 * x + 9000 * np.maximum(x - 0.946, 0), "too near to its ends"),
    ],
)
def test_a_curve_that_does_not_show_it_has_none(tension, reason):
    strain = np.linspace(0, 1, 4001)
    noise = np.random.default_rng(2).normal(0, 1e-3 if "tenth" in reason else 3, strain.size)
    found = measured_pick_up(measured_curve(strain, tension(strain) + noise, loading="static"))
    assert np.isnan([found.strain, found.standard_uncertainty]).all()
    assert reason in found.reason


def test_few_strains_show_nothing():
    strain = np.linspace(0, 0.1, 200)
    found = measured_pick_up(measured_curve(strain, strain, loading="static"))
    assert np.isnan(found.strain) and "are too few to show a bend" in found.reason
