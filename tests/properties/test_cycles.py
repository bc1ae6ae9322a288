"""Laws of reversals and cycles: what does not change when the signal is scaled, shifted, mirrored."""

import numpy as np
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from located_cycles import cycles_of_log

from reduction.record.settings import CycleSettings, PhaseSettings
from reduction.stages.cycles.cycle_search import find_cycles
from reduction.stages.cycles.reversals import find_reversals
from reduction.stages.standstills import find_standstills

# eighths and powers of two: scaling and shifting them rounds nothing
LEVELS = st.integers(-400, 400).map(lambda level: level / 8)
SIGNALS = st.integers(2, 120).flatmap(lambda n: arrays(np.float64, n, elements=LEVELS))
SURE_STANDSTILL = 40  # samples of 0.1 s: the 3 s of a standstill and its edges
HOLDS = st.integers(0, 2 * SURE_STANDSTILL) | st.integers(0, 400)
BANDS = st.integers(1, 400).map(lambda band: band / 8)


@given(SIGNALS, BANDS, st.integers(-8, 8), LEVELS)
def test_scale_and_shift_change_no_reversal(values, band, power, shift):
    scale = 2.0**power
    moved = find_reversals(scale * (values + shift), band=scale * band)
    assert moved.tolist() == find_reversals(values, band=band).tolist()


@given(SIGNALS, BANDS)
def test_a_mirrored_signal_has_the_same_reversals(values, band):
    mirrored = find_reversals(-values, band=band)
    assert mirrored.tolist() == find_reversals(values, band=band).tolist()


@given(SIGNALS, BANDS)
def test_a_signal_read_backwards_has_the_same_levels(values, band):
    forwards = values[find_reversals(values, band=band)]
    backwards = values[::-1][find_reversals(values[::-1], band=band)]
    assert forwards.tolist() == backwards[::-1].tolist()


@given(SIGNALS, BANDS, BANDS)
def test_a_smaller_band_first_changes_nothing(values, one, other):
    first = find_reversals(values, band=min(one, other))
    both = first[find_reversals(values[first], band=max(one, other))]
    assert values[both].tolist() == values[find_reversals(values, band=max(one, other))].tolist()


@given(SIGNALS, BANDS)
def test_a_repeated_sample_changes_no_level(values, band):
    twice = np.repeat(values, 2)
    found = values[find_reversals(values, band=band)]
    assert twice[find_reversals(twice, band=band)].tolist() == found.tolist()


@given(st.integers(1, 30), st.integers(10, 80), st.floats(0.0, 0.45), st.integers(0, 2**32 - 1))
def test_noise_below_the_band_changes_no_count(n_cycles, n_samples, share, seed):
    phase = np.arange(n_cycles * n_samples + 1) / n_samples % 1
    noise = np.random.default_rng(seed).uniform(-share, share, phase.size)
    # at a band of 1 on a stroke of 2.5 neither noise makes a swing nor takes one away
    signal = 2.5 * (1 - np.abs(2 * phase - 1))
    assert find_reversals(signal + noise, band=1.0).size == 2 * n_cycles + 1


@settings(max_examples=examples(30), deadline=None)
@given(
    st.integers(2, 12),
    st.integers(20, 60),
    HOLDS,
    HOLDS,
    st.integers(0, 2**32 - 1),
)
def test_holds_before_and_after_change_no_cycle(n_cycles, n_samples, before, after, seed):
    phase = np.arange(n_cycles * n_samples + 1) / n_samples % 1
    stroke = 4 + (1 - np.abs(2 * phase - 1))
    noise = np.random.default_rng(seed).normal(0, 0.002, before + stroke.size + after)
    time = 0.1 * np.arange(noise.size)
    position = np.concatenate([np.full(before, 4.0), stroke, np.full(after, 4.0)]) + noise
    cycles = cycles_of_log(time, position, [100 * position])
    assert cycles.n_cycles == n_cycles
    valleys = before + n_samples * np.arange(n_cycles + 1)
    early, late = cycles.first - valleys[:-1], cycles.last - valleys[1:]
    assert np.abs(early[1:]).max() <= 2 and np.abs(late[:-1]).max() <= 2
    # a stop too short for a standstill belongs to the half cycle beside it, which then begins
    # or ends at whichever of its equal samples the noise makes the lowest
    assert -2 - (before if before < SURE_STANDSTILL else 0) <= early[0] <= 2
    assert -2 <= late[-1] <= 2 + (after if after < SURE_STANDSTILL else 0)
    assert (cycles.branch_last[:, 1] == cycles.last).all()


@settings(max_examples=examples(25), deadline=None)
@given(st.integers(3, 10), st.floats(0.01, 100), st.floats(-50, 50), st.booleans())
def test_units_and_datum_of_position_change_no_cycle(n_cycles, scale, shift, is_noisy):
    phase = np.arange(n_cycles * 50 + 1) / 50 % 1
    position = np.concatenate([np.zeros(80), 1 - np.abs(2 * phase - 1), np.zeros(80)])
    position += np.random.default_rng(1).normal(0, 0.002 if is_noisy else 1e-6, position.size)
    time = 0.1 * np.arange(position.size)

    def samples(values):
        stand = find_standstills(time, values, [10 + 100 * position], settings=PhaseSettings())
        cycles = find_cycles(time, values, [100 * position], stand, settings=CycleSettings())
        return [*stand.first, *stand.last, *cycles.first, *cycles.last, *cycles.branch_last[:, 0]]

    assert samples(scale * (position + shift)) == samples(position)
