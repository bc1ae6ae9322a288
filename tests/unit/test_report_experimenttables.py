"""Tables of an experiment: what was run, and numbers that a reader can compute with."""

import re
from dataclasses import replace

import numpy as np
import pytest
from experiment_views import CODED, law_experiment, view_of
from experiments import HIGH, LOW, STRENGTH, screening_experiment, surface_experiment
from reportparts import texts

from reduction.report.experiment_tables import (
    anova_table,
    answer_table,
    block_words,
    caution_table,
    coefficient_budget_table,
    coefficient_budgets,
    confounding_words,
    effect_table,
    experiment_findings,
    form_words,
    negative_inside,
    negative_words,
    quality_table,
    quality_words,
    run_table,
    single_time_words,
    stationary_words,
    surface_coefficient_table,
)
from reduction.report.figures.budget_figures import draw_coefficient_budgets
from reduction.report.text_style import NOT_GIVEN, share_text
from reduction.stages.three_parameter_line.line_model import check_single_time

POUND = 4.4482216152605  # exactly, in newton


def law(frequency, mean, amplitude):
    return 1000 + 50 * frequency + 200 * mean - 30 * amplitude + 40 * mean**2 + 9 * mean * amplitude


def column(table, start):
    (place,) = [k for k, name in enumerate(table.columns) if name.startswith(start)]
    return [row[place] for row in table.rows]


def test_runs_stand_as_planned_and_as_reached_with_the_share_of_the_break_strength():
    result = law_experiment({"apparent_spring_constant": law})
    table = run_table(view_of(result), {})
    assert table.columns[:5] == (
        "run", "plan, coded", "frequency [Hz]", "mean tension [N]", "tension amplitude [N]",
    )  # fmt: skip
    peak = result.runs.peak_tension
    assert [float(cell.text) for cell in column(table, "peak [%RBS]")] == pytest.approx(
        100 * peak / STRENGTH, abs=0.05
    )
    assert texts(table)[0][1] == "-1, -1, 0"
    assert "remark" not in table.columns


def test_a_run_that_was_not_made_says_why():
    table = run_table(view_of(surface_experiment(missing=(4,))), {})
    assert column(table, "remark")[4].text == "its test gave no results"
    assert column(table, "apparent spring constant")[4].text == NOT_GIVEN


def test_a_plan_of_a_screening_has_its_factors_and_not_the_dummies():
    table = run_table(view_of(screening_experiment()), {})
    assert {len(text.split(",")) for text in (row[1].text for row in table.rows)} == {5}


def test_cautions_name_their_runs():
    table = caution_table(view_of(surface_experiment()))
    assert [row[:2] for row in texts(table)] == [["slack", "R02"], ["no repeats", "all runs"]]
    assert caution_table(view_of(screening_experiment())) is None


@pytest.mark.parametrize("of_mean", [True, False])
def test_a_load_that_is_a_share_is_shown_in_per_cent_of_what_it_is_a_share_of(of_mean):
    view = view_of(law_experiment({"apparent_spring_constant": law}))
    data = view.data.copy(deep=True)
    data["factor_unit"].values[0, 2] = "1"
    whole = data["run_mean_tension"].values if of_mean else STRENGTH
    data["run_level"].values[..., 2] = data["run_tension_amplitude"].values / whole
    table = run_table(replace(view, data=data), {})
    unit = "% of mean" if of_mean else "%RBS"
    cells = column(table, f"tension amplitude [{unit}]")
    wanted = 100 * data["run_level"].values[0, :, 2]
    assert [float(cell.text) for cell in cells] == pytest.approx(wanted, abs=0.06)
    shown = [cell.text for cell in column(
        surface_coefficient_table(replace(view, data=data), view.surfaces, 0), "its unit"
    )]  # fmt: skip
    assert f"N {unit.split()[0]}⁻²" in shown


@pytest.mark.parametrize("units", ["si", "us"])
def test_coefficients_in_units_give_the_surface_back(units):
    view = view_of(law_experiment({"apparent_spring_constant": law}, noise=1e-7), units=units)
    table = surface_coefficient_table(view, view.surfaces, 0)
    force = 1.0 if units == "si" else 1 / POUND
    coded = np.array([0.5, -0.25, 0.75])
    levels = ((HIGH + LOW) / 2 + coded * (HIGH - LOW) / 2) * np.array([1.0, force, force])
    value = sum(
        float(re.sub(",", "", cell.text.split(" ± ")[0])) * np.prod(levels**powers)
        for cell, powers in zip(
            column(table, "coefficient, in units"), view.surfaces.exponents, strict=True
        )
    )
    assert value == pytest.approx(law(*coded) * force, rel=1e-4)
    name = "N" if units == "si" else "lbf"
    units_of = [cell.text for cell in column(table, "its unit")]
    assert units_of[0] == name
    assert units_of[1] == f"{name} Hz⁻²"
    assert units_of[2] == f"{name}⁻¹"
    assert texts(table)[2][:2] == ["B3", "mean tension²"]


def test_coefficients_of_a_logarithm_say_of_which_number_whatever_the_page_shows():
    laws = {"hysteresis_energy": lambda f, m, a: np.exp(0.5 * a - 2 * m - f)}
    view = view_of(law_experiment(laws, transforms=[("hysteresis_energy", "log")]), units="us")
    assert "as a number of J m⁻¹" in surface_coefficient_table(view, view.surfaces, 1).remarks[0]
    assert not any(
        "as a number" in text for text in surface_coefficient_table(view, view.surfaces, 0).remarks
    )


def test_a_column_of_squares_has_powers_of_ten_in_every_row_or_in_none():
    small = view_of(law_experiment({"relaxation_time": lambda f, m, a: 5 + f + m}, noise=0.05))
    large = view_of(
        law_experiment({"apparent_spring_constant": lambda f, m, a: 1e6 * (2 + m + 0.001 * a)})
    )
    plain = [row[2] for row in texts(anova_table(small, small.surfaces, 0))]
    raised = [row[2] for row in texts(anova_table(large, large.surfaces, 0))]
    assert not any("e" in text for text in plain)
    assert all("e" in text for text in raised)
    assert "sum of squares [s²]" in anova_table(small, small.surfaces, 0).columns


def test_the_statistic_of_the_report_stands_where_it_can_be_formed_and_nowhere_else():
    view = view_of(surface_experiment())
    table = quality_table(view, view.surfaces)
    assert table.columns[-1] == "F as printed in CG-D-39-80"
    assert "counts the mean" in table.remarks[0]
    surfaces = replace(view.surfaces, printed_f=np.full(view.surfaces.printed_f.shape, np.nan))
    without = quality_table(view, surfaces)
    assert not any("CG-D" in name for name in without.columns)
    assert without.remarks == ()


def test_a_share_of_a_whole_shows_by_how_much_it_misses_it():
    assert share_text(0.97351) == "0.974"
    assert share_text(0.99998082) == "0.99998"
    assert share_text(float("nan")) == NOT_GIVEN
    assert share_text(1.0) == "1.00000000"


def test_the_answer_is_the_value_in_the_middle_and_leaves_out_what_falls_below_zero():
    laws = {
        "hysteresis_energy": lambda f, m, a: np.exp(2.5 * a - 2 * m - f),
        "apparent_spring_constant": law,
    }
    view = view_of(law_experiment(laws, noise=1e-8, transforms=[("hysteresis_energy", "log")]))
    table = answer_table(view, view.surfaces)
    rows = {row[0]: row[1:] for row in texts(table)}
    assert set(rows) == {
        "apparent spring constant [N]", "hysteresis energy, by its logarithm [J/m]",
    }  # fmt: skip
    assert float(rows["apparent spring constant [N]"][0].replace(",", "")) == pytest.approx(1000)
    energy = rows["hysteresis energy, by its logarithm [J/m]"]
    assert float(energy[0]) == pytest.approx(1)
    # corners: exp of -1 less 2 less 2.5, and the other way round
    assert [float(text) for text in energy[2:]] == pytest.approx(
        [np.exp(-5.5), np.exp(5.5)], rel=1e-3
    )
    assert "frequency 0.300 Hz" in table.caption


def test_effects_stand_by_size_and_a_dummy_is_not_judged():
    result = screening_experiment()
    table = effect_table(view_of(result), "apparent_spring_constant")
    sizes = [abs(float(cell.value)) for cell in column(table, "effect")]
    assert sizes == sorted(sizes, reverse=True)
    assert {row[-1] for row in texts(table) if row[0].startswith("dummy")} == {NOT_GIVEN}
    assert sum(row[0].startswith("dummy") for row in texts(table)) == 6
    assert effect_table(view_of(surface_experiment()), "apparent_spring_constant") is None


# sentences of an experiment: what a reader is told before he takes a number


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


# shares of the sources in the variance of the coefficients of a surface, as the page shows them

KAP = "apparent_spring_constant"


@pytest.fixture(scope="module")
def view():
    return view_of(surface_experiment())


def test_the_shares_of_every_coefficient_are_those_of_shared_errors_repeats_and_surface(view):
    surfaces = view.surfaces
    index = surfaces.response_names.index(KAP)
    found = coefficient_budgets(view, surfaces, index)
    assert len(found) == len(surfaces.labels)
    random = surfaces.coefficient_standard_uncertainty[index]
    rows = view.array(f"{KAP}_coefficient_uncertainty_contribution")[:, : random.size]
    total = random**2 + np.sum(rows**2, axis=0)
    # three runs at the centre: their variance, of two degrees of freedom, over that of the fit
    centre = surfaces.fitted[index] + surfaces.residual[index]
    centre = centre[(np.abs(surfaces.coded) < 0.1).all(axis=1)]
    repeats = min(np.var(centre, ddof=1) / surfaces.sigma[index] ** 2, 1.0)
    assert centre.size == 3
    for place, one in enumerate(found):
        assert sum(row.share for row in one.budget.rows) == pytest.approx(1)
        assert one.share("tension_gain") == pytest.approx(
            np.sum(rows[:, place] ** 2) / total[place]
        )
        scatter = random[place] ** 2 / total[place]
        assert one.share("run_to_run") == pytest.approx(repeats * scatter)
        assert one.share("regression") == pytest.approx((1 - repeats) * scatter, abs=1e-12)


def test_bars_and_table_have_a_row_a_coefficient(view):
    surfaces = view.surfaces
    found = coefficient_budgets(view, surfaces, 0)
    (figure,) = draw_coefficient_budgets(view, "budget-0", "shares", found)
    assert "synthetic" in str(figure).lower()
    table = coefficient_budget_table(surfaces.response_names[0], found)
    assert len(table.rows) == len(surfaces.labels)
    assert any("Run to run: scatter of runs" in one for one in table.remarks)


def test_only_the_experiment_of_the_page_is_in_its_bars():
    two = surface_experiment("half-inch"), surface_experiment("one-inch", seed=5)
    views = [view_of(*two, index=index) for index in (0, 1)]
    values = [
        [one.budget.value for one in coefficient_budgets(view, view.surfaces, 0)] for view in views
    ]
    for view, found in zip(views, values, strict=True):
        assert found == pytest.approx(view.surfaces.coefficient[0].tolist())


def test_an_archive_that_keeps_nothing_of_what_runs_share_has_no_bars():
    bare = replace(law_experiment({KAP: lambda f, m, a: 10 + m + a**2}), shared=None)
    view = view_of(bare)
    assert coefficient_budgets(view, view.surfaces, 0) == []
    assert draw_coefficient_budgets(view, "budget-0", "shares", []) == []
    assert coefficient_budget_table(KAP, []) is None


def test_runs_without_a_twin_leave_their_scatter_to_the_regression(view):
    surfaces = view.surfaces
    anova = surfaces.anova
    row = anova.source.index("pure error")
    freedom = np.array(anova.degrees_of_freedom)
    freedom[:, row] = 0
    without = replace(surfaces, anova=replace(anova, degrees_of_freedom=freedom))
    (first, *_) = coefficient_budgets(view, without, 0)
    assert {row.source for row in first.budget.rows} == {"regression", "tension_gain"}
