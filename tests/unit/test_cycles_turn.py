"""Cosine and sine from a table."""

from __future__ import annotations

import numpy as np

from reduction.stages.cycles.loops import _cosine_and_sine


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
