"""Table 4 of WHOI-2005-10 (Buoy Technology, Inc., 1997) against this package."""

import csv
from pathlib import Path

import numpy as np
import pytest

from reduction.record.measurement import StepReadings
from reduction.stages.moduli.stepwise_test import reduce_stepwise

HERE = Path(__file__).parent
RAW = HERE.parents[1] / "raw" / "buoy-technology-1997" / "table_4.csv"
INCH, LBF = 0.0254, 4.4482216152605
PSI = LBF / INCH**2
HALF_A_PSI = 0.5

# worked out by hand from the printed rows with a gauge length of 6.125 in and a diameter of 1.00 in
ASCENDING = (87, 114, 120, 126, 150, 153, 179)
ASCENDING_STRAIN = (0.69, 0.99, 1.23, 1.46, 1.66, 1.85, 2.02)
DESCENDING = (686, 536, 343, 252)
BESIDE_1325 = (90, 48)  # with 15.38 in for the printed 16.38 in
SECANT = (125, 110, 111, 112, 114, 118, 121, 126)


def typed(path):
    with open(path, encoding="utf-8") as lines:
        return list(csv.reader(line for line in lines if not line.startswith("#")))[1:]


def reduced(*, diameter=1.00, length_of_1325=16.38, stated_gauge_length=None):
    table = typed(HERE / "whoi_2005_10_table_4.csv")
    clock = tuple(row[0] for row in table)
    weight, length, elongation, eye = (
        np.array([float(row[i]) for row in table]) for i in range(1, 5)
    )
    length[clock.index("1325")] = length_of_1325
    seconds = np.array([3600.0 * int(text[:2]) + 60.0 * int(text[2:]) for text in clock])
    return reduce_stepwise(
        StepReadings(
            clock=clock,
            time=seconds - seconds[0],
            tension=LBF * weight,
            length=INCH * length,
            eye_to_eye_length=INCH * eye,
            printed_strain=elongation / 100,
            length_standard_uncertainty=0.02 * INCH,
        ),
        area=np.pi * (diameter * INCH) ** 2 / 4,
        stated_gauge_length=stated_gauge_length,
    )


def test_the_campaign_and_the_golden_file_were_typed_alike():
    numbers = [[float(cell) for cell in row] for row in typed(HERE / "whoi_2005_10_table_4.csv")]
    assert [[float(cell) for cell in row] for row in typed(RAW)] == numbers


def test_gauge_length_is_six_inches_and_an_eighth():
    result = reduced()
    assert result.gauge_length / INCH == pytest.approx(6.125, abs=0.0005)
    assert result.gauge_length_standard_uncertainty / INCH < 0.005


def test_fourteen_rows_agree_within_six_tenths_of_a_point():
    result = reduced()
    miss = 100 * np.abs(result.strain - result.printed_strain)
    assert np.sum(miss < 0.65) == 14
    assert "14 of 15 rows agree within 0.6 points" in result.made[0]


def test_printed_elongations_come_back_to_the_point():
    result = reduced()
    sound = ~result.is_inconsistent
    # a tape read to a sixteenth of an inch is half a point, rounding the other half
    assert 100 * result.strain[sound] == pytest.approx(100 * result.printed_strain[sound], abs=1.0)


def test_1325_is_flagged_and_1205_is_creep():
    result = reduced()
    assert [c for c, bad in zip(result.clock, result.is_inconsistent, strict=True) if bad] == [
        "1325"
    ]
    assert [c for c, bad in zip(result.clock, result.is_creep, strict=True) if bad] == ["1205"]
    (note,) = [text for text in map(str, result.notes) if text.startswith("reading 1325")]
    assert "390.5 mm would agree (the eye-to-eye length supports the elongation)" in note
    assert "0.62 and 0.33 MPa" in note  # 90 and 48 psi


def test_branches():
    result = reduced()
    assert result.branch.tolist() == [1] * 8 + [2] * 7
    assert result.interval_branch.tolist() == [1] * 7 + [0] + [2] * 6


def test_ascending_moduli():
    result = reduced()
    up = result.interval_branch == 1
    assert result.interval_modulus[up] / PSI == pytest.approx(ASCENDING, abs=HALF_A_PSI)
    assert result.interval_strain[up] == pytest.approx(ASCENDING_STRAIN, abs=0.005)


def test_descending_moduli_stop_at_the_flagged_row():
    result = reduced()
    down = result.interval_modulus[result.interval_branch == 2] / PSI
    assert down[:4] == pytest.approx(DESCENDING, abs=HALF_A_PSI)
    assert np.isnan(down[4:]).all()
    assert np.isnan(result.interval_modulus[7])


def test_descending_moduli_with_the_length_that_the_elongation_implies():
    result = reduced(length_of_1325=15.38)
    assert not result.is_inconsistent.any()
    assert result.interval_modulus[-2:] / PSI == pytest.approx(BESIDE_1325, abs=HALF_A_PSI)


def test_secant_moduli():
    result = reduced()
    assert result.secant_modulus[:8] / PSI == pytest.approx(SECANT, abs=HALF_A_PSI)
    assert np.isnan(result.secant_modulus[list(result.clock).index("1325")])


def test_the_123_psi_of_section_2_is_a_chord_on_a_diameter_of_1_01_inches():
    result = reduced(diameter=1.013)
    rise = (result.tension[7] - result.tension[0]) / (np.pi * (1.013 * INCH) ** 2 / 4)
    chord = rise / (result.strain[7] - result.strain[0])
    assert chord / PSI == pytest.approx(123, abs=HALF_A_PSI)


def test_moduli_go_as_the_inverse_square_of_the_assumed_diameter():
    one, other = reduced(), reduced(diameter=1.10)
    np.testing.assert_allclose(
        other.interval_modulus, one.interval_modulus / 1.1**2, rtol=1e-12, equal_nan=True
    )


def test_eighteen_inches_of_section_4_8_would_make_strains_negative():
    notes = tuple(map(str, reduced(stated_gauge_length=18 * INCH).notes))
    assert any("457.2 mm is not used: it would give strains of -48 to 6 %" in n for n in notes)
