"""Sentences of an experiment: what a reader is told before he takes a number."""

import re
from dataclasses import replace

import numpy as np
import pytest
from experiment_views import CODED, law_experiment, view_of
from experiments import screening_experiment, surface_experiment

from reduction.report.experiment_tables import (
    block_words,
    confounding_words,
    experiment_findings,
    form_words,
    negative_inside,
    negative_words,
    quality_table,
    quality_words,
    single_time_words,
    stationary_words,
)
from reduction.stages.three_parameter_line.line_model import check_single_time


def falls(frequency, mean, amplitude):
    return np.exp(2.5 * amplitude - 2 * mean - frequency)


def hollow(frequency, mean, amplitude):
    return 100 + 20 * (frequency - 0.5) ** 2 + 30 * mean**2 + 10 * (amplitude + 0.25) ** 2


def warning(result, **more):
    view = view_of(result, **more)
    return negative_words(view, view.surfaces, "hysteresis_energy", negative_inside(view.surfaces))


def test_a_surface_below_zero_points_to_its_logarithm_or_says_how_to_get_one():
    laws = {"hysteresis_energy": falls}
    (with_log,) = warning(law_experiment(laws, transforms=[("hysteresis_energy", "log")]))
    assert "a hysteresis energy cannot be negative" in with_log
    assert "Use the surface of its logarithm" in with_log
    (without,) = warning(law_experiment(laws))
    assert 'transform = { hysteresis_energy = "log" }' in without
    assert warning(law_experiment({"hysteresis_energy": hollow})) == []


def test_quality_has_the_freedom_of_fifteen_runs_and_the_statistic_of_the_report_apart():
    view = view_of(law_experiment({"apparent_spring_constant": hollow}))
    text = quality_words(view, view.surfaces, 0)
    assert "F(9, 5) = " in text
    assert "Lack of fit: F(3, 2) = " in text
    assert "no lack of fit beyond the scatter of repeated runs" in text
    assert "For comparison only: the F that CG-D-39-80 prints" in text


def test_a_large_f_has_four_digits():
    """The lack of fit of a hysteresis energy had F = 2,412,095, of two degrees of freedom."""
    view = view_of(law_experiment({"apparent_spring_constant": hollow}))
    lack = replace(view.surfaces.lack_of_fit, f=np.full(1, 2412095.0))
    surfaces = replace(view.surfaces, lack_of_fit=lack)
    assert "F(3, 2) = 2,412,000, p" in quality_words(view, surfaces, 0)
    table = quality_table(view, surfaces)
    assert table.rows[0][table.columns.index("F of lack of fit")].text == "2,412,000"


def test_without_repeats_there_is_no_test_of_lack_of_fit():
    coded = np.vstack([CODED[:12], [[0.5, 0, 0], [0, 0.5, 0], [0, 0, 0.5]]])
    view = view_of(law_experiment({"apparent_spring_constant": hollow}, coded=coded))
    text = quality_words(view, view.surfaces, 0)
    assert "No test of lack of fit: no run is repeated." in text


def test_a_hollow_inside_the_range_is_said_with_its_place():
    view = view_of(law_experiment({"apparent_spring_constant": hollow}, noise=1e-9))
    text = stationary_words(view, view.surfaces, 0)
    assert re.match(r"Stationary point: a minimum of 100\.0+ N inside the tested range", text)
    # 0.5 of the way from 0.3 to 0.5 Hz
    assert "frequency 0.400 Hz (coded +0.50" in text


def test_a_point_outside_the_range_is_not_given_as_a_place():
    view = view_of(
        law_experiment(
            {"apparent_spring_constant": lambda f, m, a: 100 + m + f**2 + a**2 + m**2 / 8}
        )
    )
    text = stationary_words(view, view.surfaces, 0)
    assert "outside the tested range" in text
    assert "Hz" not in text


@pytest.mark.parametrize(("power", "words"), [(0, "one relaxation time holds"), (1, "follows 1/f")])
def test_the_check_of_one_relaxation_time_is_a_sentence(power, words):
    plain = surface_experiment()
    frequency = plain.runs.frequency
    time = 2 * frequency**-power * (1 + 1e-3 * np.sin(np.arange(frequency.size)))
    check = check_single_time(frequency, time, 1 / time)
    (text,) = single_time_words(view_of(replace(plain, single_time=check)))
    assert words in text
    assert f"n = {float(check.exponent):.4f}" in text
    assert single_time_words(view_of(replace(plain, single_time=None))) == []


def test_stiffness_forms_are_said_in_words_with_their_range():
    sentences = form_words(view_of(surface_experiment()))
    assert sentences[0].startswith("Del Vecchio: stiffness over break strength is a constant")
    assert "log10(T)" in sentences[0]
    assert "Range of use: mean tension" in sentences[-1]
    assert form_words(view_of(screening_experiment())) == []


def test_specimens_as_blocks_are_compared_and_as_a_sample_are_spread():
    fixed = view_of(surface_experiment(specimens=("a", "b")))
    (text,) = block_words(fixed, fixed.surfaces, 0)
    effects = [float(one) for one in re.findall(r"[+-]\d[\d.e+]*", text)]
    assert sum(effects) == pytest.approx(0, abs=1e-2 * max(map(abs, effects)))
    sample = view_of(surface_experiment(specimens=("a", "b"), treatment="random"))
    (text,) = block_words(sample, sample.surfaces, 0)
    assert text.startswith("2 specimens, taken as a sample of others")
    one = view_of(surface_experiment())
    assert block_words(one, one.surfaces, 0) == []


def test_what_is_wrong_with_an_experiment_is_found_before_its_numbers():
    view = view_of(law_experiment({"hysteresis_energy": falls}))
    found = experiment_findings(view)
    warnings = [one.text for one in found if one.severity == "warning"]
    assert any("minimum tension of run 2 reaches zero (R02)" in text for text in warnings)
    assert any("hysteresis energy: this surface falls to" in text for text in warnings)
    assert {one.tests for one in found} == {("experiment half-inch",)}


def test_twelve_runs_hold_a_third_of_six_interactions_in_each_effect():
    (text,) = confounding_words(view_of(screening_experiment()))
    # of five factors, four others give six pairs
    assert "up to 0.33 of 6 interactions" in text
