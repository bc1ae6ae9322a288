"""Cosine and sine from a table."""

from __future__ import annotations

import numpy as np

from reduction.stages.cycles.fundamental import _cosine_and_sine
from reduction.stages.cycles.turns import kind_of_turns, missed_by_extreme


def test_it_is_cosine_and_sine_over_several_turns_either_way() -> None:
    phase = np.linspace(-20.0, 20.0, 100_003)
    cosine, sine = _cosine_and_sine(phase)
    np.testing.assert_allclose(cosine, np.cos(phase), rtol=0, atol=5e-15)
    np.testing.assert_allclose(sine, np.sin(phase), rtol=0, atol=5e-15)


def test_within_a_turn_it_is_good_to_the_last_digits() -> None:
    phase = np.random.default_rng(1).uniform(0.0, 2 * np.pi, 100_000)
    cosine, sine = _cosine_and_sine(phase)
    assert max(abs(cosine - np.cos(phase)).max(), abs(sine - np.sin(phase)).max()) < 8e-16


def test_a_missing_angle_has_no_cosine_and_is_left_as_it_was() -> None:
    phase = np.array([np.nan, 1.0])
    cosine, sine = _cosine_and_sine(phase)
    assert np.isnan([cosine[0], sine[0]]).all()
    np.testing.assert_allclose([cosine[1], sine[1]], [np.cos(1.0), np.sin(1.0)], atol=1e-15)
    assert np.isnan(phase[0])
    assert phase[1] == 1.0


def rounded_triangle(up, down, rounding, phase, n=6):
    """Peaks of a triangle with unequal ways, each corner an average over a time; readings, turns."""
    fine = 40  # of a sample
    time = np.arange(int((up + down) * n * fine)) / fine
    share = (time / (up + down)) % 1
    edge = up / (up + down)
    wave = np.where(share < edge, share / edge, (1 - share) / (1 - edge))
    width = max(int(rounding * fine), 1)
    wave = np.convolve(wave, np.full(width, 1 / width), mode="same")
    inner = wave[fine * 4 : -fine * 4]
    logged = inner[int(phase * fine) :: fine]
    tops = np.flatnonzero((logged[1:-1] >= logged[:-2]) & (logged[1:-1] > logged[2:])) + 1
    return logged, tops[(tops > 4) & (tops < logged.size - 5)], float(inner.max())


def test_what_readings_miss_of_a_rounded_turn_is_within_what_is_told() -> None:
    # one phase of the samples in all cycles, so that the mean misses what one turn misses
    rng = np.random.default_rng(8)
    held, told = [], []
    for _ in range(80):
        # whole samples in a period, so that all cycles are alike
        up = float(rng.integers(15, 60))
        down = up + float(rng.integers(0, 80))
        logged, tops, top = rounded_triangle(up, down, rng.uniform(1, 5), rng.uniform(0, 1))
        most = float(np.median(missed_by_extreme(logged, tops, logged[tops], sign=1)))
        lost = top - float(np.median(logged[tops]))
        held.append(lost <= 1.96 * most / 3**0.5 + 1e-9)
        told.append(most / (1 / up))
    assert np.mean(held) > 0.9
    assert np.median(told) < 0.4  # of the step of a sample, by which a corner may be missed


def test_noise_that_hides_the_form_of_a_turn_leaves_it_open() -> None:
    place = np.arange(1000)
    corner = 100.0 - np.abs((place + 10.3) % 40 - 20)
    peaks = np.flatnonzero((corner[1:-1] > corner[:-2]) & (corner[1:-1] >= corner[2:])) + 1
    noisy = corner + np.random.default_rng(2).normal(0, 0.3, place.size)
    assert kind_of_turns(corner, peaks, noise=0.01) == "sharp"
    # 0.2 of a step to be told with 1.25 sqrt(6) 0.3 over the root of 25 turns
    assert kind_of_turns(noisy, peaks, noise=0.3) == "hidden"
