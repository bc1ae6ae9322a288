"""Tethers of WHOI-2005-10 in SI."""

import numpy as np
import pytest

from reduction.published.published_lines import (
    _name_of_segment,
    published_static_test,
    published_tethers,
)
from reduction.record.errors import DataError
from reduction.record.settings import StrainSettings
from reduction.stages.moduli.secant_modulus import chord_modulus
from reduction.stages.moduli.stepwise_test import reduce_stepwise
from reduction.stages.strain.strain_fit import fit_strain_model

INCH, FOOT, LBF = 0.0254, 0.3048, 4.4482216152605
PSI = LBF / INCH**2
TETHERS = {one.name: one for one in published_tethers()}


@pytest.mark.parametrize(
    ("name", "diameter", "printed"), [("new", 1.04, 1.01), ("used", 0.94, 0.94)]
)
def test_diameter_is_the_one_that_the_moduli_belong_to(name, diameter, printed):
    tether = TETHERS[name]
    assert tether.specimen.area == pytest.approx(np.pi / 4 * (diameter * INCH) ** 2)
    assert tether.printed_diameter == pytest.approx(printed * INCH)
    assert ("WH5-11" in tether.errata) == (diameter != printed)
    assert "WH5-12" not in tether.errata  # it only says that the number stands
    assert len(tether.specimen.stretched_diameters) == 6
    assert tether.specimen.rated_break_strength == pytest.approx(800 * LBF)


@pytest.mark.parametrize("tether", TETHERS.values(), ids=TETHERS)
def test_every_segment_that_is_not_open_is_a_chord_on_that_area(tether):
    for one in tether.segments:
        if one.is_open:
            continue
        chord = chord_modulus(
            one.strain_low, one.strain_high, one.tension_low, one.tension_high,
            area=tether.specimen.area,
        )  # fmt: skip
        # half a psi, half a unit of the last digit of a corrected limit, and of the diameter
        allowed = 0.5 * PSI + (0.0005 / 0.475 + 2 * 0.005 / 0.94) * chord
        assert one.modulus == pytest.approx(chord, abs=allowed), one.name
        assert one.branch == "ascending"


def test_segments_in_number_and_what_is_open_of_them():
    # Table 5 has 16 rows of the new tether and 13 of the used, Table 6 has 8 and 10
    assert [len(one.segments) for one in TETHERS.values()] == [24, 23]
    is_open = {one.name for tether in TETHERS.values() for one in tether.segments if one.is_open}
    assert {(one.test, one.tether, one.data) for one in is_open} == {
        ("T-6", "used", "raw"), ("T-1", "new", "consolidated"),
    }  # fmt: skip


def segments_of(tether, test, data, condition="ten cycles"):
    wanted = (test, data, condition)
    return [
        one for one in TETHERS[tether].segments
        if (one.name.test, one.name.data, one.name.condition) == wanted
    ]  # fmt: skip


def test_open_numbers_are_not_numbers_and_say_why():
    (segment,) = segments_of("new", "T-1", "consolidated")
    assert np.isnan([segment.modulus, segment.strain_low, segment.strain_high]).all()
    assert segment.tension_low == pytest.approx(80 * LBF)
    assert "WH5-8" in segment.errata and "182 psi" in segment.notes[0]


def test_corrected_numbers_are_used():
    first, *_ = segments_of("new", "T-1", "raw")
    assert first.strain_low == 0.775 and first.errata == ("WH5-1", "WH5-34")
    first, _, last = segments_of("new", "T-3", "raw")
    assert first.tension_low == pytest.approx(103 * LBF)
    assert last.strain_high == 1.725 and last.modulus == pytest.approx(369 * PSI)
    after = segments_of("used", "T-4", "raw", condition="after 3000 cycles")
    assert [round(one.modulus / PSI) for one in after] == [118, 180]


@pytest.mark.parametrize("tether", TETHERS.values(), ids=TETHERS)
def test_segments_of_a_test_meet(tether):
    for before, after in zip(tether.segments, tether.segments[1:], strict=False):
        if after.name.number > 1 and not after.is_open:
            assert (after.strain_low, after.tension_low) == (
                before.strain_high, before.tension_high,
            )  # fmt: skip


def test_the_plan_has_its_eight_tests():
    tests = {one.name: one for one in TETHERS["new"].tests}
    assert list(tests) == [f"T-{i}" for i in range(1, 7)] + ["T-4 Extended", "overnight hold"]
    assert tests["T-4 Extended"].n_cycles == 3000
    assert (tests["T-6"].target_strain_low, tests["T-6"].target_strain_high) == (2.25, 2.75)
    assert tests["overnight hold"].target_strain_low == tests["overnight hold"].target_strain_high


@pytest.mark.parametrize(("name", "ratio"), [("new", 0.873), ("used", 0.860)])
def test_marks_give_the_strain_that_the_report_misses(name, ratio):
    tether = TETHERS[name]
    assert tether.marks.far_thimble[0] == pytest.approx(12.26 * FOOT)
    model = fit_strain_model(
        tether.specimen, test_id="T-1", marks=tether.marks, settings=StrainSettings("marks")
    )
    assert model.strain_slope_ratio == pytest.approx(ratio, abs=0.0005)


def test_the_static_test_is_consistent_as_corrected():
    readings = published_static_test()
    assert readings.time[-1] == 3600 * 3.75  # 0945 to 1330
    reduced = reduce_stepwise(readings, area=np.pi / 4 * INCH**2)
    assert not reduced.is_inconsistent.any() and reduced.is_creep.sum() == 1
    # 90 and 48 psi beside 1325, on 1 in
    assert reduced.interval_modulus[-2:] / PSI == pytest.approx([90, 48], abs=0.5)


def test_a_row_of_another_table_is_no_segment():
    with pytest.raises(DataError, match="a row is not a segment"):
        _name_of_segment("static test, 51 lb")
