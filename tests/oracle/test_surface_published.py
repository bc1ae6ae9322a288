"""A published Box-Behnken experiment against its print; test_surface_command.py has R beside it."""

import numpy as np
import pytest
from csvrows import csv_rows
from measured_logs import LOGS, needs_measured_logs

from reduction.experiments.response_surfaces import fit_surfaces

DATA = LOGS / "box-behnken"
pytestmark = needs_measured_logs


def rows(name):
    return csv_rows(DATA / name, comment="#")


def numbers(name, column):
    return np.array([float(row[column]) for row in rows(name)])


def published(kind):
    table = rows("myers_montgomery_ex7_5_published.csv")
    return {row["source"]: row for row in table if row["kind"] == kind}


@pytest.fixture
def viscosity():
    name = "myers_montgomery_ex7_5_viscosity.csv"
    coded = np.stack([numbers(name, f"x{i}") for i in (1, 2, 3)], axis=1)
    return fit_surfaces(
        np.array([175, 7.5, 20]) + coded * [25, 2.5, 5],
        numbers(name, "y")[None],
        factor_names=["Temp", "Agitation", "Rate"],
        response_names=["viscosity"],
        low=[150, 5, 15],
        high=[200, 10, 25],
    )


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
