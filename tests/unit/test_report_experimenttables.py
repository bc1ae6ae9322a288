"""Tables of an experiment: what was run, and numbers that a reader can compute with."""

import re
from dataclasses import replace

import numpy as np
import pytest
from experiment_views import law_experiment, view_of
from experiments import HIGH, LOW, STRENGTH, screening_experiment, surface_experiment

from reduction.report.experiment_tables import (
    anova_table,
    answer_table,
    caution_table,
    effect_table,
    quality_table,
    run_table,
    surface_coefficient_table,
)
from reduction.report.text_style import NOT_GIVEN, share_text

POUND = 4.4482216152605  # exactly, in newton


def law(frequency, mean, amplitude):
    return 1000 + 50 * frequency + 200 * mean - 30 * amplitude + 40 * mean**2 + 9 * mean * amplitude


def texts(table):
    return [[cell.text for cell in row] for row in table.rows]


def column(table, start):
    (place,) = [k for k, name in enumerate(table.columns) if name.startswith(start)]
    return [row[place] for row in table.rows]


def test_runs_stand_as_planned_and_as_reached_with_the_share_of_the_break_strength():
    result = law_experiment({"apparent_spring_constant": law})
    table = run_table(view_of(result))
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
    table = run_table(view_of(surface_experiment(missing=(4,))))
    assert column(table, "remark")[4].text == "its test gave no results"
    assert column(table, "apparent spring constant")[4].text == NOT_GIVEN


def test_a_plan_of_a_screening_has_its_factors_and_not_the_dummies():
    table = run_table(view_of(screening_experiment()))
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
    table = run_table(replace(view, data=data))
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
