"""Comparisons: ratio and interval, grids that differ, cycles."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.moduli.modulus_product import ModulusCurves
from reduction.stages.moduli.secant_modulus import compare_curves, compare_cycles

NAMES = {"numerator_name": "new", "denominator_name": "used"}
FIRST = {"numerator_specimen": 0, "denominator_specimen": 0}


def curves_of(x, modulus, *, relative=0.01, count=10, **fields):
    modulus = np.broadcast_to(np.asarray(modulus, dtype=float), (1, 2, x.size)).copy()
    width = x[1] - x[0]
    blank = dict.fromkeys(ModulusCurves.__dataclass_fields__, np.zeros_like(modulus))
    return ModulusCurves(
        **blank
        | {
            "strain_bin": x,
            "strain_bin_bounds": np.column_stack([x - width / 2, x + width / 2]),
            "tangent_modulus": modulus,
            "tangent_modulus_standard_uncertainty": relative * modulus,
            "tangent_modulus_count": np.full(modulus.shape, count),
        }
        | fields
    )


FINE, COARSE = 0.105 + 0.01 * np.arange(40), 0.11 + 0.02 * np.arange(20)


def test_ratio_stands_on_the_coarser_grid():
    fine, coarse = curves_of(FINE, 2e6 * (1 + FINE)), curves_of(COARSE, 1e6 * (1 + COARSE))
    ratio = compare_curves(fine, coarse, **FIRST, **NAMES)
    assert ratio.strain_bin == pytest.approx(COARSE)
    assert ratio.ratio == pytest.approx(np.full((2, 20), 2.0))
    assert (ratio.numerator, ratio.denominator) == ("new", "used")
    inverse = compare_curves(coarse, fine, **FIRST, **NAMES)
    assert inverse.ratio == pytest.approx(1 / ratio.ratio)


def test_interval_holds_the_ratio_as_often_as_it_says():
    rng = np.random.default_rng(14)
    sides = []
    for level in (1.2e6, 1.0e6):
        cycles = level * (1 + 0.02 * rng.standard_normal((6, 2, 4000)))
        uncertainty = cycles.std(axis=0, ddof=1) / np.sqrt(6)
        x = 0.01 * np.arange(4000)
        sides.append(
            curves_of(
                x, cycles.mean(axis=0)[None], count=6,
                tangent_modulus_standard_uncertainty=uncertainty[None],
            )
        )  # fmt: skip
    ratio = compare_curves(*sides, **FIRST, **NAMES)
    covered = (ratio.ratio_low <= 1.2) & (ratio.ratio_high >= 1.2)
    assert covered.mean() == pytest.approx(0.95, abs=0.015)
    assert ratio.is_different.all()


def test_equal_curves_are_not_different():
    curves = curves_of(FINE, 1e6)
    ratio = compare_curves(curves, curves, **FIRST, **NAMES)
    assert not ratio.is_different.any()
    assert ratio.notes == ()


def test_curves_without_a_common_strain_give_a_note_and_no_ratio():
    ratio = compare_curves(curves_of(FINE, 1e6), curves_of(FINE + 5, 1e6), **FIRST, **NAMES)
    assert np.isnan(ratio.ratio).all()
    assert not ratio.is_different.any()
    assert "new and used have no common strain range" in tuple(map(str, ratio.notes))


def test_ratio_of_curves_without_scatter_has_no_interval():
    curves = curves_of(FINE, 1e6, relative=np.nan, count=1)
    ratio = compare_curves(curves, curves, **FIRST, **NAMES)
    assert ratio.ratio == pytest.approx(1)
    assert np.isnan(ratio.ratio_low).all()
    assert not ratio.is_different.any()


def by_cycle_curves():
    by_cycle = np.array([4.0, 3.0, 2.0, 2.0])[None, :, None, None] * np.full((1, 4, 2, 40), 1e6)
    return curves_of(
        FINE, 1e6, selected_cycle=np.array([1, 2, 2999, 3000]), tangent_modulus_by_cycle=by_cycle,
        tangent_modulus_by_cycle_standard_uncertainty=0.1 * by_cycle,
    )  # fmt: skip


def test_last_cycles_are_set_beside_the_first():
    ratio = compare_cycles(
        by_cycle_curves(), specimen=0, numerator_cycles=[2999, 3000], denominator_cycles=[1, 2]
    )
    assert ratio.ratio == pytest.approx(np.full((2, 40), 2 / 3.5))
    relative = np.hypot(0.1 / np.sqrt(2), 0.1 * np.hypot(4, 3) / 7)
    assert ratio.ratio_standard_uncertainty / ratio.ratio == pytest.approx(
        np.full((2, 40), relative)
    )
    assert ratio.ratio_high == pytest.approx(ratio.ratio * (1 + 1.959964 * relative))
    assert ratio.numerator == "cycles 2999, 3000"


@pytest.mark.parametrize("chosen", [[], [1, 500]])
def test_cycle_whose_curve_was_not_kept_is_refused(chosen):
    with pytest.raises(DataError, match="no curve of its own; found .*; needed cycles among 1, 2"):
        compare_cycles(
            by_cycle_curves(), specimen=0, numerator_cycles=chosen, denominator_cycles=[1]
        )
