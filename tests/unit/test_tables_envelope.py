"""The envelope over all tests, on one strain grid."""

import numpy as np
import pytest

from reduction.archive.csv_tables import _Curve, _envelope_rows, _on_grid


def curve(test, strain, modulus, *, specimen="new", width=0.1, synthetic="no"):
    return _Curve(
        test=test,
        specimen=specimen,
        branch="ascending",
        synthetic=synthetic,
        strain=np.asarray(strain),
        width=width,
        modulus=np.asarray(modulus, dtype=float),
        uncertainty=np.full(len(strain), 2.0),
    )


def test_a_straight_line_stays_a_straight_line():
    strain = np.arange(0.05, 1.0, 0.1)
    grid = np.array([0.05, 0.1, 0.33, 0.95])
    modulus, uncertainty = _on_grid(curve("T-1", strain, 3 + 4 * strain), grid)
    np.testing.assert_allclose(modulus, 3 + 4 * grid, rtol=1e-14)
    np.testing.assert_allclose(uncertainty, 2.0)


def test_nothing_is_extrapolated_and_no_gap_is_bridged():
    strain = np.array([0.05, 0.15, 0.25, 0.35, 0.45])
    modulus, _ = _on_grid(
        curve("T-1", strain, [1, 2, np.nan, 4, 5]), np.array([0.0, 0.1, 0.2, 0.3, 0.4, 0.5])
    )
    assert np.isfinite(modulus).tolist() == [False, True, False, False, True, False]


def test_a_bin_centre_that_is_off_by_rounding_keeps_its_value():
    modulus, _ = _on_grid(
        curve("T-1", [0.1, 0.2, 0.3], [1, 2, 3]), np.array([0.1 - 1e-16, 0.3 + 1e-16])
    )
    assert modulus.tolist() == [1.0, 3.0]


def test_a_curve_without_a_number_has_none_on_the_grid():
    modulus, uncertainty = _on_grid(curve("T-1", [0.1, 0.2], [np.nan, np.nan]), np.array([0.1]))
    assert np.isnan(modulus).all()
    assert np.isnan(uncertainty).all()


def test_the_envelope_names_the_tests_that_make_it():
    rows = _envelope_rows(
        [
            curve("T-1", [0.1, 0.2, 0.3], [5, 6, 7]),
            curve("T-2", [0.2, 0.3, 0.4], [9, 1, 2], synthetic="yes"),
            curve("T-1", [0.1], [50], specimen="used"),
        ]
    )
    assert rows == [
        ["new", "ascending", 0.1, 5.0, 2.0, "T-1", 5.0, 2.0, "T-1", 1, "yes"],
        ["new", "ascending", 0.2, 6.0, 2.0, "T-1", 9.0, 2.0, "T-2", 2, "yes"],
        ["new", "ascending", 0.3, 1.0, 2.0, "T-2", 7.0, 2.0, "T-1", 2, "yes"],
        ["new", "ascending", 0.4, 2.0, 2.0, "T-2", 2.0, 2.0, "T-2", 1, "yes"],
        ["used", "ascending", 0.1, 50.0, 2.0, "T-1", 50.0, 2.0, "T-1", 1, "no"],
    ]


def test_the_widest_bins_make_the_grid():
    fine = curve("T-1", np.arange(0.05, 1.0, 0.05), np.arange(19), width=0.05)
    wide = curve("T-2", [0.3, 0.5, 0.7], [1, 1, 1], width=0.2)
    strains = [row[2] for row in _envelope_rows([fine, wide])]
    assert strains == pytest.approx([0.1, 0.3, 0.5, 0.7, 0.9])


def test_a_campaign_without_curves_has_no_envelope():
    assert _envelope_rows([]) == []
