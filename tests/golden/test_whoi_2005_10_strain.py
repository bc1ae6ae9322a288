"""Tables 2 and 3 of WHOI-2005-10 against this package, to the printed digit."""

import csv
from pathlib import Path

import numpy as np
import pytest

from reduction.record.measurement import Specimen, SpliceMarks
from reduction.record.settings import StrainSettings
from reduction.stages.strain.strain_fit import fit_strain_model
from reduction.stages.strain.strain_model import strain_by_model
from reduction.stages.strain.stress import check_constant_volume, constant_volume_diameter

HERE = Path(__file__).parent
INCH, FOOT = 0.0254, 0.3048
HALF_OF_A_TENTH = 0.05  # percentages are printed to a tenth
HALF_OF_A_HUNDREDTH = 0.005  # feet are printed to a hundredth
TETHERS = ("new", "used")
METHODS = ("marks", "strain-ratio", "constant-fraction")

# strain minus the printed actual stretch at 75, 100 and 125 %, in points, worked out by hand
# from the printed marks, with the ratio of strain slopes of constant-fraction to the method
EXPECTED_MISS = {
    ("constant-fraction", "new"): (3.09, -0.48, -3.32),
    ("constant-fraction", "used"): (3.42, -0.39, -3.82),
    ("strain-ratio", "new"): (-0.21, -0.29, 0.36),
    ("strain-ratio", "used"): (0.00, -0.13, 0.11),
    ("marks", "new"): (0.12, -0.24, 0.12),
    ("marks", "used"): (0.06, -0.12, 0.06),
}
LINE = {"new": (-2.4395, 0.89054), "used": (-2.7399, 0.90527)}
SLOPE_RATIO = {"new": 0.873, "used": 0.860}
MODULUS_EXCESS = {"new": "14.5 % too high", "used": "16.3 % too high"}


def rows(number, tether):
    with open(HERE / f"whoi_2005_10_table_{number}.csv", encoding="utf-8") as lines:
        kept = (line for line in lines if not line.startswith("#"))
        return [row for row in csv.DictReader(kept) if row["tether"] == tether]


def column(table, name):
    return np.array([float(row[name]) for row in table])


def marks_of(tether):
    table = rows(3, tether)
    return SpliceMarks(
        specimen=tether,
        test=("T-1",) * 4,
        hold=("slack", "min", "centre", "max"),
        near_toe=FOOT * column(table, "near_toe"),
        far_toe=FOOT * column(table, "far_toe"),
        far_thimble=FOOT * column(table, "far_thimble"),
        reading_uncertainty=0.0041 * FOOT,
    )


def model_of(tether, method):
    return fit_strain_model(
        Specimen(tether), test_id="T-1", marks=marks_of(tether), settings=StrainSettings(method)
    )


def strain_percent(tether, method):
    marks = marks_of(tether)
    position = marks.far_thimble[~marks.is_slack]
    return 100 * strain_by_model(
        model_of(tether, method), position=position, tension=np.full(3, np.nan)
    )


@pytest.mark.parametrize("tether", TETHERS)
def test_table_3_lengths_are_differences_of_the_marks(tether):
    table, marks = rows(3, tether), marks_of(tether)
    assert marks.free_length / FOOT == pytest.approx(column(table, "free_length"), abs=1e-9)
    splices = column(table, "splice1") + column(table, "splice2")
    assert marks.splice_length / FOOT == pytest.approx(splices, abs=1e-9)
    assert marks.near_toe / FOOT == pytest.approx(column(table, "splice1"), abs=1e-9)


@pytest.mark.parametrize("tether", TETHERS)
def test_table_3_percentages_of_total_length(tether):
    table, marks = rows(3, tether), marks_of(tether)
    length = marks.far_thimble
    for name, part in (
        ("splice1_percent", marks.near_toe),
        ("free_percent", marks.free_length),
        ("splice2_percent", marks.splice_length - marks.near_toe),
    ):
        assert 100 * part / length == pytest.approx(column(table, name), abs=HALF_OF_A_TENTH)


@pytest.mark.parametrize("tether", TETHERS)
def test_table_3_averages_leave_the_slack_row_out(tether):
    (average,) = rows("3_averages", tether)
    fraction = model_of(tether, "constant-fraction").coefficients["free_fraction"]
    assert 100 * fraction == pytest.approx(float(average["free_percent"]), abs=HALF_OF_A_TENTH)
    marks = marks_of(tether)
    stretched = ~marks.is_slack
    first = np.mean(marks.near_toe[stretched] / marks.far_thimble[stretched])
    assert 100 * first == pytest.approx(float(average["splice1_percent"]), abs=HALF_OF_A_TENTH)
    second = 1 - first - fraction
    assert 100 * second == pytest.approx(float(average["splice2_percent"]), abs=HALF_OF_A_TENTH)


@pytest.mark.parametrize("tether", TETHERS)
def test_table_3_actual_stretch(tether):
    model = model_of(tether, "marks")
    printed = column(rows(3, tether)[1:], "actual_stretch")
    assert 100 * model.mark_strain[1:] == pytest.approx(printed, abs=HALF_OF_A_TENTH)


@pytest.mark.parametrize("tether", TETHERS)
def test_table_3_interpolated_stretch_by_constant_fraction(tether):
    printed = column(rows(3, tether)[1:], "interpolated_stretch")
    assert strain_percent(tether, "constant-fraction") == pytest.approx(
        printed, abs=HALF_OF_A_TENTH
    )


@pytest.mark.parametrize(("method", "tether"), list(EXPECTED_MISS))
def test_each_method_misses_the_marks_of_table_3_by_what_was_worked_out(method, tether):
    model = model_of(tether, method)
    expected = EXPECTED_MISS[method, tether]
    assert 100 * model.mark_strain_residual[1:] == pytest.approx(expected, abs=0.006)


@pytest.mark.parametrize("tether", TETHERS)
def test_line_through_the_marks_of_table_3(tether):
    coefficients = model_of(tether, "marks").coefficients
    intercept, slope = LINE[tether]
    assert coefficients["free_length_intercept"] / FOOT == pytest.approx(intercept, abs=5e-5)
    assert coefficients["free_length_slope"] == pytest.approx(slope, abs=5e-6)


@pytest.mark.parametrize(("tether", "ratio"), [("new", 0.2386), ("used", 0.2177)])
def test_splices_of_table_3_strain_by_a_constant_share(tether, ratio):
    found = model_of(tether, "strain-ratio").coefficients["splice_strain_ratio"]
    assert found == pytest.approx(ratio, abs=5e-5)


@pytest.mark.parametrize("tether", TETHERS)
def test_moduli_by_the_method_of_the_report_are_high_in_t_1_and_its_note_says_so(tether):
    model = model_of(tether, None)
    assert model.method == "mixed"
    # by two laws of position, which differ by as much within the tape
    assert model.strain_slope_ratio == pytest.approx(SLOPE_RATIO[tether], abs=0.01)
    assert any(
        MODULUS_EXCESS[tether] in note
        for note in map(str, model_of(tether, "constant-fraction").notes)
    )


@pytest.mark.parametrize(
    ("tether", "stretch", "implied"),
    [("new", 10, 1.039), ("new", 100, 1.038), ("used", 10, 0.932), ("used", 100, 0.927)],
)
def test_table_2_diameters_before_stretch_at_constant_volume(tether, stretch, implied):
    read = [row for row in rows(2, tether) if row["stretch"] == str(stretch)]
    diameter = constant_volume_diameter(np.full(3, stretch / 100), column(read, "diameter"))
    assert diameter.mean() == pytest.approx(implied, abs=0.0005)


def specimen_of_table_2(tether, diameter):
    stretched = tuple(
        (float(row["stretch"]) / 100, INCH * float(row["diameter"]))
        for row in rows(2, tether)
        if row["stretch"] != "0"
    )
    return Specimen(tether, diameter=(INCH * diameter,), stretched_diameters=stretched)


def test_table_2_contradicts_the_printed_diameter_of_the_new_tether_alone():
    (note,) = map(str, check_constant_volume(specimen_of_table_2("new", 1.01)))
    # 1.038 in implied, 1.01 in printed, moduli (1.01 / 1.0383)**2 - 1 = -5.4 %
    assert "imply 26.37 mm" in note
    assert "25.65 mm is stated" in note
    assert "5.4 % lower" in note
    assert tuple(map(str, check_constant_volume(specimen_of_table_2("new", 1.04)))) == ()
    assert tuple(map(str, check_constant_volume(specimen_of_table_2("used", 0.94)))) == ()
