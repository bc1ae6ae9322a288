"""`reduction surface` on published experiments, against R 4.2.2 with rsm 2.10.6 and print."""

import csv
import json

import numpy as np
import pytest
from csvrows import csv_rows
from measured_logs import LOGS, needs_measured_logs
from typer.testing import CliRunner

from reduction.cli.main import app

pytestmark = needs_measured_logs
BOX, SCREENING = LOGS / "box-behnken", LOGS / "plackett-burman"
# R prints linear terms, interactions, squares, and ^ and : in the names
SPELT = {"mean": "(Intercept)", "x1*x2": "x1:x2", "x1*x3": "x1:x3", "x2*x3": "x2:x3"}
DIGITS = 1e-8


def rows(name):
    return csv_rows(BOX / name)


def answer(*arguments):
    done = CliRunner().invoke(app, ["surface", *map(str, arguments), "--json"])
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


def close(found, expected):
    np.testing.assert_allclose(
        np.array(found, dtype=float), np.array(expected, dtype=float), rtol=DIGITS
    )


@pytest.fixture(params=["treb_lawson", "myers_montgomery_ex7_5_viscosity"])
def experiment(request):
    return request.param


@pytest.fixture
def surface(experiment):
    return answer(BOX / f"{experiment}.csv")["responses"]["y"]


@pytest.mark.parametrize(
    ("key", "column"),
    [
        ("coefficient", "Estimate"),
        ("standard_error", "Std. Error"),
        ("t", "t value"),
        ("p_value", "Pr(>|t|)"),
    ],
)
def test_every_coefficient_is_that_of_r(experiment, surface, key, column):
    expected = {
        row["term"]: float(row[column]) for row in rows(f"{experiment}_R_rsm_coefficients.csv")
    }
    close(surface[key], [expected[SPELT.get(term, term)] for term in surface["terms"]])
    assert surface["engineering"]["coefficient"] == surface["coefficient"]


def test_every_line_of_the_analysis_of_variance_is_that_of_r(experiment, surface):
    table = rows(f"{experiment}_R_rsm_anova.csv")
    columns = {"df": "Df", "ss": "Sum Sq", "ms": "Mean Sq", "f": "F value", "p": "Pr(>F)"}
    for key, column in columns.items():
        expected = [np.nan if row[column] == "NA" else float(row[column]) for row in table]
        close([line[key] for line in surface["anova"][:6]], expected)
    lack = next(row for row in table if row["source"] == "Lack of fit")
    assert (surface["lack_of_fit"]["df"], surface["lack_of_fit"]["pure_error_df"]) == (3, 2)
    close(surface["lack_of_fit"]["f"], lack["F value"])
    close(surface["lack_of_fit"]["p"], lack["Pr(>F)"])


def test_the_summary_is_that_of_r(experiment, surface):
    (row,) = rows(f"{experiment}_R_rsm_summary.csv")
    close(surface["r2"], row["r2"])
    close(surface["adjusted_r2"], row["adj_r2"])
    close(surface["sigma"], row["sigma"])
    close(surface["stationary_point"]["coded"], [row[f"sp{i}"] for i in (1, 2, 3)])
    close(surface["eigenvalues"], [row[f"ev{i}"] for i in (1, 2, 3)])


def test_the_published_equation_in_units_comes_back(tmp_path):
    spec = tmp_path / "SPEC.toml"
    spec.write_text(
        '[experiment]\nlevels = "coded"\n[factors]\n'
        "x1 = [150, 200]\nx2 = [5, 10]\nx3 = [15, 25]\n[responses]\ny = {}\n"
    )
    found = answer(BOX / "myers_montgomery_ex7_5_viscosity.csv", spec)["responses"]["y"]
    with (BOX / "myers_montgomery_ex7_5_published.csv").open(newline="") as file:
        lines = csv.DictReader(line for line in file if not line.startswith("#"))
        table = {row["source"]: row["ss_or_coef"] for row in lines if row["kind"] == "coef_actual"}
    order = ("intercept", "Temp^2", "Agitation^2", "Rate^2", "Temp", "Agitation", "Rate",
             "Temp*Agitation", "Temp*Rate", "Agitation*Rate")  # fmt: skip
    for term, value in zip(order, found["engineering"]["coefficient"], strict=True):
        half = 0.5 * 10 ** -len(table[term].partition(".")[2])
        assert abs(value - float(table[term])) <= half * (1 + 1e-9), term


def test_cast_fatigue_effects_to_the_printed_digit(tmp_path):
    spec = tmp_path / "SPEC.toml"
    spec.write_text('[experiment]\nkind = "plackett-burman"\n')
    found = answer(SCREENING / "BM93.e2.data.csv", spec)
    printed = [0.32583, 0.29383, -0.24583, -0.51617, 0.14983, 0.91517, 0.18317]
    np.testing.assert_allclose(found["responses"]["y"]["effect"], printed, atol=5e-6)
    assert found["responses"]["y"]["terms"] == list("ABCDEFG")
    # in twelve runs every interaction stands in the effects of the others with a third
    shares = np.abs(list(found["aliases"]["F"].values()))
    np.testing.assert_allclose(shares, 1 / 3, atol=1e-12)
    assert shares.size == 15


def test_two_levels_without_a_spec_are_told_to_be_a_screening():
    done = CliRunner().invoke(app, ["surface", str(SCREENING / "BM93.e2.data.csv")])
    assert done.exit_code == 5 and 'kind = "plackett-burman"' in done.stderr
