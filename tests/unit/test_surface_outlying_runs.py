"""A run far off the surface of all others is named, and sound runs are not."""

import re

import numpy as np
import pytest

from reduction.experiments.designs import box_behnken
from reduction.experiments.response_surfaces import fit_surfaces
from reduction.experiments.surface_warnings import (
    drift_over_order,
    drifting_responses,
    outlying_runs,
)

CODED = box_behnken(3).coded
RNG = np.random.default_rng(13)
LOW, HIGH = np.array([0.1, 15.0, 4.0]), np.array([0.5, 40.0, 12.0])


def fitted(runs, transform="none", name="K"):
    return fit_surfaces(
        CODED, [runs], factor_names=["f", "m", "a"], response_names=[name], low=LOW, high=HIGH,
        run_names=[f"R{run}" for run in range(1, 16)], units="coded", transforms=transform,
    )  # fmt: skip


def stiffness(scatter):
    """A power law of frequency, mean load and amplitude [kN]."""
    levels = (LOW + HIGH) / 2 + CODED * (HIGH - LOW) / 2
    law = 1200 * np.prod((levels / [0.3, 27.5, 8.0]) ** [0.05, 0.45, -0.12], axis=1)
    return law * (1 + scatter * RNG.normal(size=15))


@pytest.mark.parametrize("transform", ["none", "log"])
def test_a_centre_run_with_a_wrong_load_is_named_with_what_it_is_off(transform):
    runs = stiffness(0.003)
    runs[13] *= 0.8
    (stray,) = outlying_runs(fitted(runs, transform))
    said = r"run R14 \(-(20|21) %\) is off the surface of the other runs in K \(p "
    assert re.match(said, str(stray))
    assert stray.severity == "warning" and "which of" not in str(stray)


def test_of_two_runs_opposite_through_the_centre_the_residuals_do_not_tell_which():
    """R5 is (-1, 0, -1) and R8 is (1, 0, 1); the others know of their difference alone."""
    runs = stiffness(0.0005)
    runs[4] *= 1.2
    (stray,) = outlying_runs(fitted(runs))
    assert str(stray).startswith("run R5 (+20 %) or R8 (-17 %) is off the surface of the other")
    assert str(stray).endswith("the residuals do not show which of the 2 is wrong")


def test_sound_runs_are_not_named():
    """Of a law that is no quadratic, with scatter of 3 % and with next to none."""
    for scatter in [0.03] * 40 + [1e-4] * 40:
        assert outlying_runs(fitted(stiffness(scatter))) == ()


def test_drift_is_given_as_a_share_of_the_response():
    order = np.random.default_rng(1).permutation(15)
    surfaces = fitted(stiffness(1e-5) * (1 + 0.004 * order))
    (drift,) = drifting_responses(surfaces, drift_over_order(surfaces, order))
    assert ", +0.4" in str(drift) and "% of the response (p" in str(drift)
