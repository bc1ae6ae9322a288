"""Static slopes beside dynamic curves: one branch, one strain, nothing extrapolated."""

import numpy as np
import pytest

from reduction.tables.envelope import Curve
from reduction.tables.static_dynamic import STATIC_DYNAMIC_COLUMNS, Slope, static_dynamic_rows


def curve(branch="ascending", gap=None):
    strain = np.arange(0.5, 1.55, 0.1)
    modulus = 1e6 * strain
    if gap is not None:
        modulus[gap] = np.nan
    return Curve("T-2", "new", branch, "yes", strain, 0.1, modulus, 0.02 * modulus)


def slope(strain, branch="ascending", modulus=5e5):
    return Slope("static", "short", branch, "no", strain, modulus, 0.01 * modulus)


def rows(slopes, curves):
    names = [column.name for column in STATIC_DYNAMIC_COLUMNS]
    found = static_dynamic_rows(slopes, curves)
    return [dict(zip(names, row, strict=True)) for row in found]


def test_the_ratio_is_static_over_dynamic_at_the_strain_of_the_slope():
    (row,) = rows([slope(0.75)], [curve()])
    assert row["tangent_modulus"] == pytest.approx(7.5e5)
    assert row["static_dynamic_ratio"] == pytest.approx(2 / 3)
    assert row["static_dynamic_ratio_standard_uncertainty"] == pytest.approx(
        2 / 3 * np.hypot(0.01, 0.02)
    )
    assert (row["static_test"], row["test"], row["synthetic"]) == ("static", "T-2", "yes")


def test_slopes_stand_beside_their_own_branch_alone():
    found = rows([slope(0.8), slope(0.9, "descending")], [curve(), curve("descending")])
    assert [(row["branch"], row["interval_strain"]) for row in found] == [
        ("ascending", 0.8), ("descending", 0.9),
    ]  # fmt: skip


def test_outside_the_curve_and_in_a_gap_of_it_there_is_no_row():
    assert rows([slope(0.4), slope(1.6), slope(1.0)], [curve(gap=5)]) == []


def test_without_stepwise_or_cyclic_tests_there_is_no_table():
    assert static_dynamic_rows([], [curve()]) == static_dynamic_rows([slope(1.0)], []) == []


def test_a_slope_without_an_uncertainty_leaves_that_of_the_ratio_empty():
    bare = Slope("static", "short", "ascending", "no", 0.8, 5e5, float("nan"))
    (row,) = rows([bare], [curve()])
    assert row["static_dynamic_ratio"] == pytest.approx(0.625)
    assert row["interval_modulus_standard_uncertainty"] is None
    assert row["static_dynamic_ratio_standard_uncertainty"] is None
