"""The scan for steps, against the same written out sample by sample."""

import numpy as np
import pytest

from reduction.stages.moduli import splice_slip as stepscan
from reduction.stages.moduli.splice_slip import (
    _fit_kinks,
    _fit_ramps,
    _ramp_of,
    _strongest_response,
    _without_parabola,
)


@pytest.mark.parametrize("n_samples", [20, 61, 640])
def test_products_and_powers_of_ramps_are_those_of_the_ramps_themselves(n_samples):
    rng = np.random.default_rng(n_samples)
    level = _without_parabola(50 + 3 * rng.standard_normal(n_samples).cumsum())
    onset, extent = (
        grid.ravel()
        for grid in np.meshgrid(np.arange(2, n_samples - 3), [1, 2, 5, 13], indexing="ij")
    )
    inside = onset + extent <= n_samples - 2
    onset, extent = onset[inside], extent[inside]
    ramps = _ramp_of(n_samples, onset=onset, extent=extent)
    product, power = _fit_ramps(level, onset=onset, extent=extent)
    np.testing.assert_allclose(product, ramps @ level, rtol=1e-9, atol=1e-9 * np.ptp(level))
    np.testing.assert_allclose(power, (_without_parabola(ramps) ** 2).sum(axis=1), rtol=1e-8)


@pytest.mark.parametrize("n_samples", [20, 61, 640])
def test_products_and_powers_of_kinks_are_those_of_the_kinks_themselves(n_samples):
    rng = np.random.default_rng(n_samples)
    level = _without_parabola(50 + 3 * rng.standard_normal(n_samples).cumsum())
    onset = np.arange(2, n_samples - 3)
    kinks = np.maximum(0.0, np.arange(n_samples) - onset[:, None])
    product, power = _fit_kinks(level, onset=onset)
    rounding = 1e-11 * n_samples * np.ptp(level)
    np.testing.assert_allclose(product, kinks @ level, rtol=1e-9, atol=rounding)
    # of a kink near the end next to nothing is left beyond the parabola
    np.testing.assert_allclose(power, (_without_parabola(kinks) ** 2).sum(axis=1), rtol=1e-6)


@pytest.mark.parametrize("n_samples", [40, 97, 700, 3001])
def test_the_strongest_response_is_that_of_a_convolution_with_each_kernel(n_samples):
    rng = np.random.default_rng(n_samples)
    values = 0.2 * rng.standard_normal(n_samples)
    values += _ramp_of(n_samples, onset=3 * n_samples // 4, extent=2)
    allowed = rng.random(n_samples) > 0.1
    scores, tried, inflation = {}, 0, 1.0
    for window, extent in stepscan._windows(n_samples):
        ramp = _without_parabola(_ramp_of(2 * window + extent, onset=window, extent=extent))
        size = np.convolve(values, ramp[::-1] / (ramp @ ramp), mode="valid")
        onset = np.arange(size.size) + window
        kept = allowed[onset] & (onset >= max(2 * window, window + stepscan.FIRST_SAMPLE))
        if not kept.any():
            continue
        size, onset = size[kept], onset[kept]
        white = 0.2 / np.sqrt(ramp @ ramp)
        colour = stepscan._colour(size, onset, white, 2 * window + extent)
        inflation = max(inflation, colour or 1.0)
        scores |= {
            (at, window, extent): one / (white * max(1.0, colour or inflation))
            for at, one in zip(onset.tolist(), size.tolist(), strict=True)
        }
        tried += size.size
    strongest = max(scores, key=lambda place: abs(scores[place]))
    found, n_tried = _strongest_response(values, noise=0.2, allowed=allowed)
    assert (found.onset, found.window, found.extent) == strongest
    assert found.score == pytest.approx(scores[strongest], rel=1e-10)
    assert n_tried == tried


def test_a_series_shorter_than_a_window_has_no_response():
    allowed = np.ones(12, dtype=bool)
    assert _strongest_response(np.zeros(12), noise=1.0, allowed=allowed) == (None, 0)
