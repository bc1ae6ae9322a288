"""Reversals by a hysteresis band: the sequential definition, exact counts, no slow cases."""

from itertools import pairwise

import numpy as np
import pytest
from located_cycles import cycles_of_log

from reduction.record.errors import DataError
from reduction.stages.cycles.reversals import (
    _typical_range,
    find_reversals,
    reversals_of_typical_cycles,
)


def sequential(values, band):
    """The definition, one sample after the other: a reversal is confirmed a band away from it."""
    found, direction, low, high = [], 0, 0, 0
    for i, value in enumerate(values):
        high = i if direction >= 0 and value > values[high] else high
        low = i if direction <= 0 and value < values[low] else low
        if values[high] - values[low] < band and direction == 0:
            continue
        if direction == 0:
            direction = 1 if high > low else -1
            found.append(low if direction > 0 else high)
        elif direction > 0 and values[high] - value >= band:
            found.append(high)
            direction, low = -1, i
        elif direction < 0 and value - values[low] >= band:
            found.append(low)
            direction, high = 1, i
    if direction:
        found.append(high if direction > 0 else low)
    return found


def triangle(n_cycles, n_samples, noise=0.0, seed=1):
    phase = (np.arange(n_cycles * n_samples) + 0.5) / n_samples % 1
    stroke = 1 - np.abs(2 * phase - 1)
    return stroke + np.random.default_rng(seed).normal(0, noise, stroke.size)


@pytest.mark.parametrize("kind", ["white", "walk", "growing", "decaying"])
def test_reversals_are_those_of_the_sequential_definition(kind):
    generator = np.random.default_rng(5)
    for _ in range(200):
        n_samples = int(generator.integers(2, 80))
        values = generator.normal(size=n_samples)
        if kind == "walk":
            values = np.cumsum(values)
        elif kind == "growing":
            values *= np.linspace(0, 3, n_samples)
        elif kind == "decaying":
            values = np.cumsum(values) + np.linspace(2, 0, n_samples) * (-1) ** np.arange(n_samples)
        band = generator.uniform(0.1, 4)
        assert find_reversals(values, band=band).tolist() == sequential(values, band)


def test_levels_are_those_of_the_sequential_definition_where_values_repeat():
    generator = np.random.default_rng(6)
    for _ in range(500):
        values = generator.integers(0, 6, generator.integers(2, 40)).astype(float)
        band = float(generator.integers(1, 5))
        found = find_reversals(values, band=band)
        assert values[found].tolist() == values[sequential(values, band)].tolist()


def test_3000_noisy_cycles_have_exactly_6000_half_cycles():
    values = triangle(3000, 400, noise=0.002)
    reversals = find_reversals(values, band=0.1)
    assert reversals.size - 1 == 6000
    assert reversals_of_typical_cycles(values)[0].size - 1 == 6000


@pytest.mark.parametrize("band", [0.02, 0.1, 0.5, 0.9])
def test_the_count_does_not_depend_on_the_band_between_noise_and_stroke(band):
    assert find_reversals(triangle(50, 400, noise=0.002), band=band).size - 1 == 100


def test_reversals_alternate_and_are_extremes_of_what_lies_between():
    values = triangle(20, 100, noise=0.02)
    reversals = find_reversals(values, band=0.3)
    steps = np.diff(values[reversals])
    assert (steps[1:] * steps[:-1] < 0).all()
    assert (np.abs(steps) >= 0.3).all()
    for before, after in pairwise(reversals):
        inside = values[before : after + 1]
        assert {inside.min(), inside.max()} == {values[before], values[after]}


def test_a_plateau_counts_where_it_begins():
    assert find_reversals([0, 1, 2, 2, 2, 1, 0, 0, 1], band=0.5).tolist() == [0, 2, 6, 8]


def test_missing_samples_are_passed_over():
    values = triangle(10, 100)
    whole = find_reversals(values, band=0.1)
    values[120:130] = values[333] = np.nan
    assert find_reversals(values, band=0.1).tolist() == whole.tolist()


@pytest.mark.parametrize("values", [[], [1.0], [1.0, 1.0, 1.0], [0.0, 0.4, 0.1], [np.nan] * 5])
def test_a_signal_that_stays_within_the_band_has_no_reversal(values):
    assert find_reversals(values, band=0.5).size == 0


def test_swings_that_grow_steadily_take_few_passes():
    # one pair would go per pass: 100,000 passes of 100,000 points, were groups not merged
    n_samples = 200_000
    growing = np.linspace(0, 0.9, n_samples) * (-1) ** np.arange(n_samples)
    assert find_reversals(growing, band=1.9).size == 0
    assert find_reversals(growing[::-1], band=1.9).size == 0


def test_blocks_of_the_scan_join_without_a_seam():
    values = np.repeat(triangle(2, 100_000), 2)  # plateaus across the seams, too
    assert find_reversals(values, band=0.5).tolist() == find_reversals(values[:], band=0.1).tolist()
    assert find_reversals(values, band=0.5).size == 5


def test_a_band_that_is_not_positive_is_refused():
    with pytest.raises(DataError, match="values of band are not positive.*found 0; needed numbers"):
        find_reversals([0, 1], band=0.0)


def test_typical_range_is_that_of_the_cycles_and_not_of_the_way_to_them():
    assert _typical_range([0, 12, 7, 12, 7, 12, 7, 12, 0]) == 5
    with pytest.raises(DataError, match="no half cycle; found 1 reversals; needed 2 or more"):
        _typical_range([3.0])


def test_band_is_a_tenth_of_the_stroke_above_small_noise_and_the_noise_above_large():
    assert reversals_of_typical_cycles(triangle(30, 400, noise=0.001))[1] == pytest.approx(
        0.1, rel=0.02
    )
    noisy = triangle(30, 400, noise=0.03)
    reversals, band = reversals_of_typical_cycles(noisy)
    assert band == pytest.approx(12 * 0.03, rel=0.1)
    assert reversals.size - 1 == 60


def test_backward_slips_do_not_lower_the_band():
    values = triangle(30, 400) + 0.05 * (np.arange(30 * 400) // 50 % 2)
    reversals, band = reversals_of_typical_cycles(values)
    assert reversals.size - 1 == 60
    assert band == pytest.approx(0.1, rel=0.1)


def test_band_of_a_hold_is_its_noise():
    level = np.random.default_rng(0).normal(5, 0.01, 5000)
    reversals, band = reversals_of_typical_cycles(level)
    assert reversals.size == 0
    assert band == pytest.approx(0.12, rel=0.1)


def test_a_band_needs_samples():
    with pytest.raises(DataError, match="too few samples to tell noise from movement"):
        reversals_of_typical_cycles([1.0, 2.0, np.nan])


@pytest.mark.parametrize(
    ("fast", "top_rest", "is_few"), [(2, 0, True), (8, 0, False), (5, 40, False)]
)
def test_a_stroke_of_a_few_samples_is_told_but_not_where_a_rest_follows_it(fast, top_rest, is_few):
    # a sawtooth of 38 samples up, and a pulse that rises and falls at once and rests at both turns
    corners = [0, fast, fast + top_rest, 2 * fast + top_rest, 2 * (fast + top_rest)]
    if not top_rest:
        corners, levels = [0, 38, 38 + fast], [0, 1, 0]
    else:
        levels = [0, 1, 1, 0, 0]
    time = np.arange(10 * corners[-1], dtype=float)
    wave = 2 + np.interp(time % corners[-1], corners, levels)
    tension = 100 * wave[None]
    cycles = cycles_of_log(time, wave, tension)
    assert ("few-samples-a-stroke" in [one.code for one in cycles.notes]) == is_few
