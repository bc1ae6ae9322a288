"""What wiring adds to contributions: ratios, slips, stepwise tests, channels of a record."""

from dataclasses import replace

import numpy as np
import pytest

from reduction.record.contributions import Component, Contributions, InstrumentErrors
from reduction.stages.moduli.modulus_product import Ratio
from reduction.stages.strain.strain_model import StrainModel
from reduction.uncertainty.errors_of_curves import errors_of_ratios, with_shared_ratios
from reduction.uncertainty.errors_of_cycles import errors_of_slips, with_shared_steps
from reduction.uncertainty.propagation import with_shared_interval

MODEL = StrainModel("new", "gauge-length", {"reference_position": 2.0, "gauge_length": 2.0})
CELL, NEW, USED = (
    Component("tension_gain", "cell"), Component("diameter", "new"), Component("diameter", "used"),
)  # fmt: skip


def ratio(numerator="used", denominator="new", freedom=np.inf):
    one = np.ones((2, 3))
    return Ratio(
        numerator, denominator, np.arange(3.0), 1.1 * one, 0.01 * one, 1.08 * one, 1.12 * one,
        one > 0, notes=("type A",), degrees_of_freedom=np.full((2, 3), freedom),
    )  # fmt: skip


def test_one_load_cell_cancels_in_a_ratio_and_two_diameters_add(rich_test):
    moduli = replace(
        rich_test.curves,
        tangent_modulus=np.array([10.0, 11.0])[:, None, None] * np.ones((2, 2, 3)),
    )
    rows = np.zeros((3, 2, 2, 3))
    rows[0] = 0.01 * moduli.tangent_modulus
    rows[1, 0], rows[2, 1] = 0.2, 0.22
    found = Contributions((CELL, NEW, USED), {"tangent_modulus": rows})
    test = replace(
        rich_test, curves=moduli, ratios=(ratio(), ratio("new, cycles 9", "new, cycles 1"))
    )
    (shared,) = errors_of_ratios(test, found)
    of_ratio = shared.values["modulus_ratio"]
    assert of_ratio[:, 0, 0, 0] == pytest.approx([0.0, -0.022, 0.022])
    # two sets of cycles of one specimen share all of it
    assert not of_ratio[:, 1].any()
    wider, alike = with_shared_ratios(replace(test, contributions=shared)).ratios
    reach = 1.959964 * np.sqrt(0.01**2 + 2 * 0.022**2)
    assert wider.ratio_low[0, 0] == pytest.approx(1.1 - reach)
    assert wider.is_different.all()
    assert alike.ratio_low[0, 0] == 1.08


def test_few_cycles_widen_the_interval_less_where_instruments_dominate():
    few = ratio(freedom=2.0)
    alone = with_shared_interval(few, np.zeros((1, 2, 3)))
    assert alone.ratio_high[0, 0] - 1.1 == pytest.approx(4.302653 * 0.01, rel=1e-5)
    both = with_shared_interval(few, np.full((1, 2, 3), 0.1))
    assert both.ratio_high[0, 0] - 1.1 == pytest.approx(1.96 * np.hypot(0.1, 0.01), rel=1e-3)
    assert not both.is_different.any()


def test_ratios_of_a_test_without_shared_errors_stay_as_they_are(rich_test):
    test = replace(rich_test, contributions=None)
    assert with_shared_ratios(test) is test
    assert errors_of_ratios(replace(rich_test, ratios=()), Contributions(())) == []


def test_a_slip_scales_with_the_cell_and_its_length_with_the_scale_of_position(rich_test):
    errors = [
        InstrumentErrors(name, tension_gain=0.01, tension_offset=5.0, position_gain=0.002)
        for name in ("new", "used")
    ]
    test = replace(rich_test, strain_models=(MODEL, replace(MODEL, specimen="used")))
    (found,) = errors_of_slips(test, errors)
    step = found.values["slip_tension_step"]
    by_source = {one.source: row for row, one in enumerate(found.component)}
    assert step[by_source["tension_gain"]] == pytest.approx(0.01 * test.slips.slip_tension_step)
    assert not step[by_source["tension_offset"]].any()
    length = found.values["slip_length"]
    assert length[by_source["position_gain"]] == pytest.approx(0.002 * test.slips.slip_length)
    assert not length[by_source["tension_gain"]].any()
    assert errors_of_slips(replace(rich_test, slips=None), errors) == []


def test_a_stepwise_test_has_the_gauge_length_and_the_diameter_in_its_moduli(stepwise_test):
    errors = InstrumentErrors("old", diameter=1e-4)
    test = with_shared_steps(stepwise_test, (errors,))
    sources = {one.source for one in test.contributions.component}
    assert sources == {"diameter", "gauge_length"}
    assert test.contributions.values["interval_modulus"].shape == (2, 2)
    assert test.contributions.values["diameter"].max() == 1e-4
    assert test.contributions.values["secant_modulus"].shape == (2, 3)
    assert set(test.shared_uncertainty_of_cycles) == {"tension", "strain"}
    assert with_shared_steps(stepwise_test, ()) is stepwise_test
