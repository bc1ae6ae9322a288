"""Shares of the sources in the variance of the coefficients of a surface, as the page shows them."""

from dataclasses import replace

import numpy as np
import pytest
from experiment_views import law_experiment, view_of
from experiments import surface_experiment

from reduction.report.experiment_tables import coefficient_budget_table, coefficient_budgets
from reduction.report.figures.budget_figures import draw_coefficient_budgets

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
