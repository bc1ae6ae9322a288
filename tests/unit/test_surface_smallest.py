"""The smallest effect that a screening is expected to see."""

import numpy as np
import pytest

from reduction.experiments.designs import plackett_burman
from reduction.experiments.run_sheet import smallest_effect
from reduction.experiments.screening import screening_effects
from reduction.record.errors import DataError


def test_it_is_the_t_of_the_report_times_the_error_of_a_difference_of_means():
    # CG-D-39-80, Table A-2: t(0.10, 6) = 1.943
    assert smallest_effect(plackett_burman(5), sigma=3.0) == pytest.approx(
        1.943 * 3.0 * np.sqrt(1 / 6 + 1 / 6), rel=2e-4
    )


@pytest.mark.parametrize("n_factors", [5, 11])
def test_it_is_what_screenings_of_noise_come_to(n_factors):
    design = plackett_burman(n_factors, n_runs=12)
    noise = np.random.default_rng(1).normal(0.0, 2.0, (20_000, 12))
    found = screening_effects(design, noise)
    expected = smallest_effect(design, sigma=2.0)
    # the error by dummies is unbiased in its square; Lenth's is close in its median
    error = np.sqrt(np.mean(found.effect_standard_error**2))
    ratio = found.minimum_significant_effect[0] / found.effect_standard_error[0]
    assert ratio * error == pytest.approx(float(expected), rel=0.01 if n_factors == 5 else 0.15)


def test_what_is_no_scatter_is_refused():
    with pytest.raises(DataError, match="sigma"):
        smallest_effect(plackett_burman(5), sigma=0.0)
