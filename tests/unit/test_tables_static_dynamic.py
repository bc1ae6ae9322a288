"""Static slopes beside dynamic curves: one branch, one strain, nothing extrapolated."""

from dataclasses import replace

import numpy as np
import pytest

from reduction.archive.csv_tables import (
    STATIC_DYNAMIC_COLUMNS,
    _Curve,
    _Slope,
    _static_dynamic_rows,
)
from reduction.record.contributions import Component, Contributions


def curve(branch="ascending", gap=None):
    strain = np.arange(0.5, 1.55, 0.1)
    modulus = 1e6 * strain
    if gap is not None:
        modulus[gap] = np.nan
    return _Curve("T-2", "new", branch, "yes", strain, 0.1, modulus, 0.02 * modulus)


def slope(strain, branch="ascending", modulus=5e5):
    return _Slope("static", "short", branch, "no", strain, modulus, 0.01 * modulus)


def rows_of_table(slopes, curves):
    names = [column.name for column in STATIC_DYNAMIC_COLUMNS]
    found = _static_dynamic_rows(slopes, curves)
    return [dict(zip(names, row, strict=True)) for row in found]


def test_the_ratio_is_static_over_dynamic_at_the_strain_of_the_slope():
    (row,) = rows_of_table([slope(0.75)], [curve()])
    assert row["tangent_modulus"] == pytest.approx(7.5e5)
    assert row["static_dynamic_ratio"] == pytest.approx(2 / 3)
    assert row["static_dynamic_ratio_standard_uncertainty"] == pytest.approx(
        2 / 3 * np.hypot(0.01, 0.02)
    )
    assert (row["static_test"], row["test"], row["synthetic"]) == ("static", "T-2", "yes")


def test_slopes_stand_beside_their_own_branch_alone():
    found = rows_of_table([slope(0.8), slope(0.9, "descending")], [curve(), curve("descending")])
    assert [(row["branch"], row["interval_strain"]) for row in found] == [
        ("ascending", 0.8), ("descending", 0.9),
    ]  # fmt: skip


def test_outside_the_curve_and_in_a_gap_of_it_there_is_no_row():
    assert rows_of_table([slope(0.4), slope(1.6), slope(1.0)], [curve(gap=5)]) == []


def test_without_stepwise_or_cyclic_tests_there_is_no_table():
    assert _static_dynamic_rows([], [curve()]) == _static_dynamic_rows([slope(1.0)], []) == []


CELL, TAPE, DIAMETER = (
    Component("tension_gain", "A"), Component("gauge_length", "short"),
    Component("diameter", "short"),
)  # fmt: skip


def test_what_static_and_dynamic_share_cancels_and_the_rest_does_not():
    """One cell of 5 % in both, one diameter, a tape in the static one, scatter of 1 and 2 %."""
    bare = curve()
    rows = np.array([0.05, -0.02])[:, None] * bare.modulus
    dynamic = replace(
        bare,
        uncertainty=np.sqrt(0.05**2 + 0.02**2 + 0.02**2) * bare.modulus,
        shared=Contributions((CELL, DIAMETER), {"tangent_modulus": rows}),
    )
    static = replace(
        slope(0.75),
        uncertainty=5e5 * np.sqrt(0.05**2 + 0.02**2 + 0.03**2 + 0.01**2),
        shared={CELL: 0.05 * 5e5, DIAMETER: -0.02 * 5e5, TAPE: 0.03 * 5e5},
    )
    (row,) = rows_of_table([static], [dynamic])
    expected = np.sqrt(0.03**2 + 0.01**2 + 0.02**2)
    ratio = row["static_dynamic_ratio"]
    assert row["static_dynamic_ratio_standard_uncertainty"] / ratio == pytest.approx(expected)
    # another cell is another error
    other = replace(static, shared={Component("tension_gain", "B"): 0.05 * 5e5})
    (row,) = rows_of_table([other], [dynamic])
    apart = np.sqrt(0.05**2 + 0.02**2 + 0.02**2 + 0.05**2 + 0.02**2 + 0.03**2 + 0.01**2)
    assert row["static_dynamic_ratio_standard_uncertainty"] / ratio == pytest.approx(apart)


def test_a_slope_without_an_uncertainty_leaves_that_of_the_ratio_empty():
    bare = _Slope("static", "short", "ascending", "no", 0.8, 5e5, float("nan"))
    (row,) = rows_of_table([bare], [curve()])
    assert row["static_dynamic_ratio"] == pytest.approx(0.625)
    assert row["interval_modulus_standard_uncertainty"] is None
    assert row["static_dynamic_ratio_standard_uncertainty"] is None
