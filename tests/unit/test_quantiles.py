"""Quantiles and tails from scipy.special are those of the distributions of scipy.stats.

The package takes them from scipy.special, which loads in a tenth of the time.
"""

import subprocess
import sys

import numpy as np
import pytest
from scipy import special, stats

FREE = np.array([0.5, 1, 2, 3.7, 10, 99, 1e4, 1e8])[:, None]
SHARE = np.array([1e-12, 1e-6, 0.005, 0.05, 0.3, 0.5, 0.9, 0.95, 0.975, 0.995, 1 - 1e-9])
PLACE = np.array([0.0, 1e-6, 0.1, 0.9, 1.0, 2.5, 10.0, 60.0])


@pytest.mark.parametrize(
    ("found", "expected"),
    [
        (special.stdtrit(FREE, SHARE), stats.t.ppf(SHARE, FREE)),
        (special.stdtr(FREE, -PLACE), stats.t.sf(PLACE, FREE)),
        (special.ndtri(SHARE), stats.norm.ppf(SHARE)),
        (-special.ndtri(SHARE), stats.norm.isf(SHARE)),
        (special.ndtr(-PLACE), stats.norm.sf(PLACE)),
        (special.chdtrc(FREE, PLACE), stats.chi2.sf(PLACE, FREE)),
        (special.chdtri(FREE, SHARE), stats.chi2.isf(SHARE, FREE)),
        (2 * special.gammaincinv(FREE / 2, SHARE), stats.chi2.ppf(SHARE, FREE)),
        (special.fdtrc(3, FREE, PLACE), stats.f.sf(PLACE, 3, FREE)),
        (special.fdtri(3, FREE, 1 - SHARE), stats.f.isf(SHARE, 3, FREE)),
    ],
    ids=[
        "t quantile", "t tail", "normal quantile", "normal quantile of a tail", "normal tail",
        "chi2 tail", "chi2 quantile of a tail", "chi2 quantile", "F tail", "F quantile of a tail",
    ],
)  # fmt: skip
def test_a_function_is_that_of_the_distribution(found, expected):
    np.testing.assert_allclose(found, expected, rtol=1e-12)


@pytest.mark.parametrize("n_values", [4, 9, 40])
def test_the_chance_of_a_correlation_is_that_of_a_regression(n_values):
    x = np.arange(n_values)
    for noise in (0.0, 0.3, 3.0, 30.0):
        y = 0.2 * x + noise * np.random.default_rng(n_values).standard_normal(n_values)
        correlation = np.corrcoef(x, y)[0, 1]
        chance = special.betainc(n_values / 2 - 1, 0.5, max(0.0, 1 - correlation**2))
        # what is left of 1 - r^2 of an exact line is rounding
        assert chance == pytest.approx(stats.linregress(x, y).pvalue, rel=1e-9, abs=1e-7)


def test_a_run_and_a_lookup_do_without_the_distributions():
    # half a second of every command
    program = (
        "import sys, reduction.cli.campaigns, reduction.batch.run_campaign, reduction.report.campaign_page, "
        "reduction.cli.lookup; print('scipy.stats' in sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True, timeout=300
    )
    assert done.stdout.strip() == "False"
