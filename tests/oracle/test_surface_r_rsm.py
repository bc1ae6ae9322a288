"""Two published Box-Behnken experiments against the fits of R 4.2.2 with rsm 2.10.6."""

import numpy as np
import pytest
from csvrows import csv_rows
from measured_logs import LOGS, needs_measured_logs

from reduction.experiments.response_surfaces import fit_surfaces

DATA = LOGS / "box-behnken"
EXPERIMENTS = ("treb_lawson", "myers_montgomery_ex7_5_viscosity")
# R prints linear terms, interactions, squares; the report squares, linear terms, interactions
R_ORDER = ("(Intercept)", "x1^2", "x2^2", "x3^2", "x1", "x2", "x3", "x1:x2", "x1:x3", "x2:x3")
DIGITS = 1e-8
pytestmark = needs_measured_logs


def rows(name):
    return csv_rows(DATA / name, comment="#")


def numbers(name, column):
    return np.array([float(row[column]) for row in rows(name)])


def runs(experiment):
    name = f"{experiment}.csv"
    return np.stack([numbers(name, f"x{i}") for i in (1, 2, 3)], axis=1), numbers(name, "y")


@pytest.fixture(params=EXPERIMENTS)
def experiment(request):
    return request.param


@pytest.fixture
def surfaces(experiment):
    coded, response = runs(experiment)
    return fit_surfaces(
        coded,
        response[None],
        factor_names=["x1", "x2", "x3"],
        response_names=["y"],
        low=[-1, -1, -1],
        high=[1, 1, 1],
    )


def close(found, expected):
    np.testing.assert_allclose(found, expected, rtol=DIGITS)


@pytest.mark.parametrize(
    ("field", "column"),
    [
        ("coefficient", "Estimate"),
        ("coefficient_standard_uncertainty", "Std. Error"),
        ("t", "t value"),
        ("p_value", "Pr(>|t|)"),
    ],
)
def test_every_coefficient_is_that_of_r(experiment, surfaces, field, column):
    expected = {
        row["term"]: float(row[column]) for row in rows(f"{experiment}_R_rsm_coefficients.csv")
    }
    close(getattr(surfaces, field)[0], [expected[term] for term in R_ORDER])


def test_every_line_of_the_analysis_of_variance_is_that_of_r(experiment, surfaces):
    table = rows(f"{experiment}_R_rsm_anova.csv")
    anova = surfaces.anova
    assert anova.source[:6] == (
        "first order",
        "interactions",
        "squares",
        "residuals",
        "lack of fit",
        "pure error",
    )
    for column, field in (
        ("Df", "degrees_of_freedom"),
        ("Sum Sq", "sum_of_squares"),
        ("Mean Sq", "mean_square"),
        ("F value", "f"),
        ("Pr(>F)", "p_value"),
    ):
        expected = [np.nan if row[column] == "NA" else float(row[column]) for row in table]
        close(getattr(anova, field)[0, :6], expected)


def test_the_summary_is_that_of_r(experiment, surfaces):
    (row,) = rows(f"{experiment}_R_rsm_summary.csv")
    expected = {name: float(value) for name, value in row.items()}
    close(surfaces.r2, expected["r2"])
    close(surfaces.adjusted_r2, expected["adj_r2"])
    close(surfaces.sigma, expected["sigma"])
    canonical = surfaces.canonical
    close(canonical.stationary_point[0], [expected[f"sp{i}"] for i in (1, 2, 3)])
    close(canonical.eigenvalue[0], [expected[f"ev{i}"] for i in (1, 2, 3)])
    assert canonical.kind[0] == 3


def test_lack_of_fit_is_that_of_r(experiment, surfaces):
    line = next(
        row for row in rows(f"{experiment}_R_rsm_anova.csv") if row["source"] == "Lack of fit"
    )
    lack = surfaces.lack_of_fit
    assert (lack.degrees_of_freedom[0], lack.pure_error_degrees_of_freedom[0]) == (3, 2)
    close(lack.f[0], float(line["F value"]))
    close(lack.p_value[0], float(line["Pr(>F)"]))


def published(kind):
    table = rows("myers_montgomery_ex7_5_published.csv")
    return {row["source"]: row for row in table if row["kind"] == kind}


@pytest.fixture
def viscosity():
    coded, response = runs("myers_montgomery_ex7_5_viscosity")
    return fit_surfaces(
        np.array([175, 7.5, 20]) + coded * [25, 2.5, 5],
        response[None],
        factor_names=["Temp", "Agitation", "Rate"],
        response_names=["viscosity"],
        low=[150, 5, 15],
        high=[200, 10, 25],
    )


def test_the_published_engineering_equation_comes_back(viscosity):
    order = ("intercept", "Temp^2", "Agitation^2", "Rate^2", "Temp", "Agitation", "Rate",
             "Temp*Agitation", "Temp*Rate", "Agitation*Rate")  # fmt: skip
    table = published("coef_actual")
    printed = [table[term]["ss_or_coef"] for term in order]
    half = [0.5 * 10 ** -len(text.partition(".")[2]) for text in printed]
    misses = np.abs(viscosity.coefficient_engineering[0] - [float(text) for text in printed])
    assert (misses <= np.array(half) * (1 + 1e-9)).all()


def test_the_published_f_of_each_term_is_its_t_squared_but_for_one_misprint(viscosity):
    table = published("anova")
    names = ("A^2", "B^2", "C^2", "A", "B", "C", "AB", "AC", "BC")
    for name, t in zip(names, viscosity.t[0, 1:], strict=True):
        printed = 1.195 if name == "BC" else float(table[name]["F"])  # BC prints 1.22
        assert t**2 == pytest.approx(printed, abs=0.005)
    assert viscosity.t[0, -1] ** 2 == pytest.approx(12.25 / 10.25, rel=1e-9)


def test_the_published_overall_f_has_nine_and_five_degrees_of_freedom(viscosity):
    line = published("anova")["Model"]
    assert viscosity.overall_f[0] == pytest.approx(float(line["F"]), abs=0.005)
    assert viscosity.overall_p_value[0] == pytest.approx(float(line["p"]), abs=0.00005)
