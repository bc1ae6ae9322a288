"""Specimens of one test side by side: each against the first, and what makes them unequal."""

from dataclasses import replace

import numpy as np
import pytest

from reduction.pipeline.cyclic_test import _compare_specimens
from reduction.record.measurement import Specimen
from reduction.stages.moduli.modulus_product import ModulusCurves
from reduction.stages.reduced_test import History


def curves(*moduli):
    strain = np.array([1.0, 1.1, 1.2])
    modulus = np.array(moduli)[:, None, None] * np.ones((len(moduli), 2, 3))
    blank = dict.fromkeys(ModulusCurves.__dataclass_fields__, np.zeros(modulus.shape))
    return ModulusCurves(
        **blank
        | {
            "strain_bin": strain,
            "strain_bin_bounds": np.stack([strain - 0.05, strain + 0.05], axis=1),
            "tangent_modulus": modulus,
            "tangent_modulus_count": np.full(modulus.shape, 10),
            "tangent_modulus_standard_uncertainty": 0.01 * modulus,
            "notes": (),
        }
    )


def history(strain, cycles):
    n = len(strain)
    nothing = np.full(n, np.nan)
    return History(
        (("T-0",),) * n,
        np.array(strain),
        nothing,
        np.array(cycles),
        nothing,
        nothing,
        nothing,
        0 * nothing,
    )


def remarks(first, other, past):
    (ratio,) = _compare_specimens(curves(1e6, 1e6), (first, other), past)
    return [note for note in map(str, ratio.notes) if note.startswith("ratio b/a: ")]


def test_three_specimens_give_two_ratios_over_the_first():
    three = tuple(Specimen(name) for name in "abc")
    found = _compare_specimens(curves(1e6, 2e6, 0.5e6), three, history([1.0] * 3, [10.0] * 3))
    assert [(one.numerator, one.denominator) for one in found] == [("b", "a"), ("c", "a")]
    assert [float(one.ratio[0, 0]) for one in found] == pytest.approx([2.0, 0.5])
    assert all(one.notes == () for one in found)


def test_unequal_flexing_is_named_and_softening_is_said_of_rubber_alone():
    past = replace(history([1.0, 1.3], [10.0, 10.0]), earlier_flex_cycles=np.array([1e6, np.nan]))
    hoses = (Specimen("a", kind="stretch hose"), Specimen("b", kind="stretch hose"))
    found = remarks(*hoses, past)
    assert found == [
        "ratio b/a: different test histories: not known against 1000000 earlier flex cycles",
        "ratio b/a: different test histories: maximum earlier strain 130 % against 100 %",
    ]
    assert remarks(Specimen("a"), Specimen("b"), past)[-1].endswith(
        "rubber is softer below what it has seen"
    )
    alike = replace(past, earlier_flex_cycles=np.full(2, np.nan), earlier_maximum_strain=np.ones(2))
    assert remarks(*hoses, alike) == []


def test_one_specimen_is_compared_with_nothing():
    assert _compare_specimens(curves(1e6), (Specimen("a"),), None) == []


def test_equal_histories_leave_nothing_to_say():
    equal = history([1.28, 1.30], [10.0, 10.0])
    assert remarks(Specimen("a"), Specimen("b"), equal) == []
    first = history([np.nan, np.nan], [0.0, 0.0])
    assert remarks(Specimen("a"), Specimen("b"), first) == []


@pytest.mark.parametrize(
    ("past", "told"),
    [
        (history([1.2, 1.2], [10.0, 30.0]), "30 earlier cycles against 10"),
        (history([1.2, 1.8], [10.0, 10.0]), "maximum earlier strain 180 % against 120 %"),
        (history([np.nan, 1.8], [0.0, 0.0]), "maximum earlier strain 180 % against none known"),
        (None, "is not known: no order is given"),
    ],
)
def test_unequal_or_unknown_histories_are_told(past, told):
    (said,) = remarks(Specimen("a"), Specimen("b"), past)
    assert told in said


def test_another_condition_before_the_campaign_is_an_unequal_history():
    equal = history([1.2, 1.2], [10.0, 10.0])
    told = remarks(Specimen("a", condition="new"), Specimen("b", condition="used"), equal)
    assert told[0] == "ratio b/a: the conditions before the campaign differ: 'used' against 'new'"
    told = remarks(Specimen("a"), Specimen("b", condition="used"), equal)
    assert "'used' against not stated" in told[0]
