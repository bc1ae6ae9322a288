"""Means, drifts and trends over cycles: the errors of the cycles go through the same sums."""

from dataclasses import replace

import numpy as np
import pytest

from reduction.record.contributions import InstrumentErrors, merged
from reduction.record.settings import CycleSettings
from reduction.stages.moduli.secant_modulus import fit_peak_trend
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.three_parameter_line.rope_programme import (
    RopeStep,
    dynamic_stiffness,
    summarise_bedding_in,
)
from reduction.uncertainty.errors_of_cycles import trend_and_step_contributions

AREA = 5e-4
MODEL = StrainModel("new", "gauge-length", {"reference_position": 0.0, "gauge_length": 2.0})
TENSIONS = (
    "mean_tension", "tension_amplitude", "peak_tension", "valley_tension",
    "apparent_spring_constant",
)  # fmt: skip
STRENGTH = np.array([9000.0, 9000.0])


def steps_of(test, gain=0.0, strength=STRENGTH):
    loops = test.loops
    # loops that are at one with themselves
    loops = replace(
        loops,
        peak_tension=loops.mean_tension + loops.tension_amplitude,
        valley_tension=loops.mean_tension - loops.tension_amplitude,
        apparent_spring_constant=loops.tension_amplitude / loops.strain_amplitude,
    )
    loops = replace(loops, **{name: getattr(loops, name) * (1 + gain) for name in TENSIONS})
    return replace(
        test,
        loops=loops,
        trend=fit_peak_trend(loops, area=[AREA, AREA]),
        rope_step=RopeStep(
            "bedding-in",
            bedding_in=summarise_bedding_in(loops, rated_break_strength=strength),
            dynamic=dynamic_stiffness(loops, last_cycles=3, rated_break_strength=strength),
        ),
    )


def numbers(test):
    step, dynamic = test.rope_step.bedding_in, test.rope_step.dynamic
    return {
        "peak_tension_per_decade": test.trend.peak_tension_per_decade[0],
        "dynamic_modulus_per_decade": test.trend.dynamic_modulus_per_decade[0],
        "peak_tension_change": test.trend.peak_tension_change[0],
        "dynamic_stiffness": dynamic.dynamic_stiffness[0, 0],
        "dynamic_stiffness_drift": dynamic.drift_per_cycle[0, 0],
        "dynamic_mean_tension": dynamic.mean_tension[0, 0],
        "dynamic_stiffness_over_strength": dynamic.dynamic_stiffness_over_strength[0, 0],
        "dynamic_mean_tension_over_strength": dynamic.mean_tension_over_strength[0, 0],
        "bedding_first_stiffness": step.first_stiffness[0],
        "bedding_last_stiffness_over_strength": step.last_stiffness_over_strength[0],
        "bedding_stiffening": step.stiffening[0],
        "bedding_permanent_strain": step.permanent_strain[0],
    }


def found_by(test, errors):
    parts = trend_and_step_contributions(steps_of(test), 0, errors, MODEL, CycleSettings(), AREA)
    return {name: rows.sum(axis=0) for name, rows in merged(list(parts)).values.items()}


def test_a_gain_goes_through_every_mean_and_slope(rich_test):
    gain = 1e-4
    found = found_by(rich_test, InstrumentErrors("new", tension_gain=gain))
    above, below = (numbers(steps_of(rich_test, way * gain)) for way in (1, -1))
    for name, value in numbers(steps_of(rich_test)).items():
        wanted = (above[name] - below[name]) / 2
        assert found[name] == pytest.approx(wanted, rel=1e-6, abs=1e-9 * abs(value)), name


def test_the_break_strength_is_in_what_is_divided_by_it_alone(rich_test):
    found = found_by(
        rich_test, InstrumentErrors("new", tension_gain=1e-12, rated_break_strength=1e-4)
    )
    above, below = (
        numbers(steps_of(rich_test, strength=STRENGTH * (1 + way * 1e-4))) for way in (1, -1)
    )
    for name, value in numbers(steps_of(rich_test)).items():
        wanted = (above[name] - below[name]) / 2
        assert found[name] == pytest.approx(wanted, rel=1e-5, abs=1e-9 * abs(value)), name


def test_a_diameter_is_in_the_trend_of_the_modulus_twice(rich_test):
    found = found_by(rich_test, InstrumentErrors("new", diameter=1e-5))
    value = numbers(steps_of(rich_test))["dynamic_modulus_per_decade"]
    size = np.sqrt(4 * AREA / np.pi)
    assert found["dynamic_modulus_per_decade"] == pytest.approx(-2 * value * 1e-5 / size)
    assert found["peak_tension_per_decade"] == 0


def test_a_gain_is_in_no_change_and_a_zero_is_in_one_by_what_the_peaks_lose(rich_test):
    assert found_by(rich_test, InstrumentErrors("new", tension_gain=1e-3))[
        "peak_tension_change"
    ] == pytest.approx(0, abs=1e-15)
    found = found_by(rich_test, InstrumentErrors("new", tension_offset=0.5))
    peaks = steps_of(rich_test).loops.peak_tension[0]
    # (last + d) / (first + d) to first order in d
    wanted = 0.5 * (peaks[0] - peaks[-1]) / peaks[0] ** 2
    assert found["peak_tension_change"] == pytest.approx(wanted, rel=1e-9)
