"""Tape readings checked against the record, and the tension of each."""

from dataclasses import replace

import numpy as np
import pytest
from refusals import refusals
from scipy import stats

from reduction.record.errors import DataError
from reduction.record.measurement import Specimen, SpliceMarks
from reduction.record.settings import StrainSettings
from reduction.stages.standstills import Standstills
from reduction.stages.strain.mark_readings import (
    LEVEL,
    check_marks,
    measure_mark_tension,
    relaxed_lengths,
    row_scatter,
)
from reduction.stages.strain.strain_fit import fit_strain_model


def marks(position, free, *, hold=None, test=None, reading_uncertainty=0.00124):
    position, free = np.array(position), np.array(free)
    near = (position - free) / 2
    return SpliceMarks(
        specimen="new",
        test=test or ("T-1",) * position.size,
        hold=hold or tuple(f"{i}" for i in range(position.size)),
        near_toe=near,
        far_toe=near + free,
        far_thimble=position,
        reading_uncertainty=reading_uncertainty,
    )


def standstills(holds, rate=10.0):
    """From (start, end, position, is_rest)."""
    start, end, position, rest = (np.array(part) for part in zip(*holds, strict=True))
    return Standstills(
        first=np.round(start * rate).astype(int),
        last=np.round(end * rate).astype(int),
        start_time=start,
        end_time=end,
        mean_position=position,
        mean_tension=np.full((1, len(holds)), np.nan),
        is_rest=rest.astype(bool),
        position_tolerance=0.01,
        slack_tension=5.0,
    )


def measured(rows, holds, tension, **more):
    return measure_mark_tension(
        rows, test_id="T-1", standstills=standstills(holds), tension=tension, **more
    )


HOLDS = [(0.0, 5.0, 3.74, True), (20.0, 80.0, 5.90, False), (90.0, 290.0, 6.63, False)]
RAMP = np.arange(4000) / 10  # a tension that tells the time
TWO = marks([3.74, 5.90, 6.63], [2.55, 4.51, 5.17], hold=("slack", "min", "max"))


def test_a_mark_has_the_tension_of_the_last_ten_seconds_of_its_hold():
    slack, low, high = measured(TWO, HOLDS, RAMP)
    assert low == pytest.approx(80.0 - 5.0, abs=0.06)
    assert high == pytest.approx(290.0 - 5.0, abs=0.06)
    assert slack == pytest.approx(5.0 - 5 / 6, abs=0.06)  # a third of a short hold


def test_a_hold_whose_readings_are_all_flagged_is_the_place_of_no_mark():
    flagged = [*HOLDS, (300.0, 390.0, np.nan, False)]
    assert measured(TWO, flagged, RAMP) == pytest.approx(measured(TWO, HOLDS, RAMP))


def test_the_start_of_the_hold_is_the_other_bound():
    _, low, high = measured(TWO, HOLDS, RAMP, reading="start")
    assert low == pytest.approx(20.0 + 5.0, abs=0.06)
    assert high == pytest.approx(90.0 + 5.0, abs=0.06)


def test_a_later_hold_at_the_same_place_does_not_count():
    holds = [*HOLDS, (300.0, 390.0, 5.901, False)]
    assert measured(TWO, holds, RAMP)[1] == pytest.approx(75.0, abs=0.06)


def test_the_nearest_of_two_close_holds_counts():
    holds = [(0.0, 10.0, 5.86, False), (20.0, 80.0, 5.90, False)]
    assert measured(TWO, holds, RAMP)[1] == pytest.approx(75.0, abs=0.06)


def test_a_mark_without_a_hold_has_no_tension():
    low, high = measured(TWO, HOLDS[:2], RAMP)[1:]
    assert np.isfinite(low)
    assert np.isnan(high)


def test_a_rest_is_no_hold_of_a_stretched_mark():
    assert np.isnan(measured(TWO, [(20.0, 80.0, 5.90, True)], RAMP)[1])


def test_a_slack_row_without_a_rest_has_no_tension_at_all():
    assert measured(TWO, HOLDS[1:], RAMP)[0] == 0.0


def test_rows_of_other_tests_are_left_out():
    rows = marks([5.90, 6.63], [4.51, 5.17], test=("T-2", "T-1"))
    assert measured(rows, HOLDS, RAMP) == pytest.approx([285.0], abs=0.06)


def test_missing_samples_are_left_out_of_the_mean():
    log = RAMP.copy()
    log[750:] = np.nan  # the last five of the ten seconds
    assert measured(TWO, HOLDS, log)[1] == pytest.approx(72.5, abs=0.06)
    assert np.isnan(measured(TWO, HOLDS, np.full(4000, np.nan))[1])


def test_a_hold_of_one_sample_has_its_tension():
    assert measured(TWO, [(20.0, 20.0, 5.90, False)], RAMP)[1] == pytest.approx(20.0)


def test_a_free_length_that_falls_is_refused_by_test_and_hold():
    check_marks(marks([3.74, 5.90, 6.63, 7.35], [2.55, 4.51, 5.17, 5.80]))  # one that rises
    rows = marks([3.74, 5.90, 6.63], [2.55, 4.51, 4.40], hold=("slack", "min", "max"))
    with pytest.raises(
        DataError,
        match=r"marks of 'new' in test T-1 contradict each other: holds min and max; "
        r"found free lengths 4.510 and 4.400 m at positions 5.900 and 6.630 m",
    ):
        check_marks(rows)


def test_one_position_has_one_free_length_but_for_the_error_of_reading():
    check_marks(marks([5.90, 5.90], [4.510, 4.516]))
    with pytest.raises(DataError, match="holds 0 and 1; found free lengths 4.510 and 4.560"):
        check_marks(marks([5.90, 5.90], [4.51, 4.56]))


@pytest.mark.parametrize(("misread", "off"), [(1, 0.7), (2, 0.15), (3, -0.7)])
def test_of_contradicting_rows_the_one_is_named_without_which_the_others_agree(misread, off):
    """A tether whose splices take 15 % of the stroke; the far toe of one mark is off."""
    position = np.array([3.74, 5.90, 6.63, 7.35])
    free = 2.55 + 0.85 * (position - 3.74)
    free[misread] += off
    hold = ("slack", "min", "centre", "max")
    with pytest.raises(DataError, match=f"Correct the mark at {hold[misread]}: without it"):
        check_marks(marks(position, free, hold=hold))


def of_slack_rows(*far_toe):
    """Slack rows of as many tests, and two marks of splices that stretch with the tension."""
    n = len(far_toe)
    free = np.array([far - 0.57 for far in far_toe] + [4.59, 5.10])
    length = np.array([3.62] * n + [2.55 * 1.8 + 1.07 * 1.16, 2.55 * 2.0 + 1.07 * 1.2])
    rows = marks(
        length, free, test=(*(f"T-{at + 1}" for at in range(n)), "T-1", "T-1"),
        hold=(*["slack"] * n, "min", "max"), reading_uncertainty=1e-3,
    )  # fmt: skip
    rows = replace(rows, is_reading_stated=True)
    rows = replace(
        rows, near_toe=np.append(np.full(n, 0.57), rows.near_toe[n:]),
        far_toe=np.append(far_toe, rows.far_toe[n:]),
    )  # fmt: skip
    force = np.array([0.0] * n + [400.0, 500.0])
    model = fit_strain_model(Specimen("new"), test_id="T-1", marks=rows, mark_tension=force)
    return {one.code: one for one in model.notes}


def test_a_slack_row_that_is_misread_is_named():
    found = of_slack_rows(3.120, 3.121, 3.219)["slack-rows-differ"]
    assert found.severity == "warning"
    assert (found.numbers["column"], found.numbers["test"]) == ("far_toe", "T-3")
    assert found.numbers["difference"] == pytest.approx(0.099)
    # of two nothing tells which
    assert of_slack_rows(3.120, 3.219)["slack-rows-differ"].numbers["test"] == "T-1 or T-2"


def test_slack_rows_that_differ_by_the_error_of_the_tape_are_sound():
    assert "slack-rows-differ" not in of_slack_rows(3.120, 3.122, 3.117)


BY_MARKS = StrainSettings(method="marks")

# WHOI-2005-10, Table 3, T-1 new: slack, 75, 100 and 125 % [ft]
PRINTED = np.array([
    (2.06, 10.44, 12.26), (2.42, 17.22, 19.37), (2.53, 19.48, 21.75), (2.69, 21.72, 24.12),
]).T  # fmt: skip


@pytest.mark.parametrize(
    ("column", "misread", "is_told"),
    [
        (1, 10.44, False),  # as printed: 24 and 25 %
        (1, 10.49, False),  # 15 mm
        (1, 10.84, True),  # digits of 10.48 swapped: the far splice stretches by 60 %
        (0, 2.60, True),
        (2, 12.62, True),
    ],
)
def test_two_splices_of_one_tether_stretch_alike(column, misread, is_told):
    readings = PRINTED.copy()
    readings[column, 0] = misread
    near, far, thimble = 0.3048 * readings
    hold = ("slack", "min", "centre", "max")
    rows = SpliceMarks("new", ("T-1",) * 4, hold, near, far, thimble, reading_uncertainty=1e-3)
    found = fit_strain_model(Specimen("new"), test_id="T-1", marks=rows, settings=BY_MARKS)
    assert ("splices-unlike" in {one.code for one in found.notes}) == is_told


def test_short_splices_that_differ_by_the_errors_of_the_tape_are_sound():
    """Both of 0.6 m and stretched by 4 and 6 %; stretched marks are misread by 4 or 5 mm."""
    true = np.array([(0.600, 3.600, 4.200), (0.624, 5.124, 5.748), (0.636, 6.136, 6.772)])
    near, far_toe, thimble = (true + np.outer([0, 1, 1], [-4e-3, -5e-3, 5e-3])).T
    rows = SpliceMarks("new", ("T-1",) * 3, ("slack", "min", "max"), near, far_toe, thimble)
    found = fit_strain_model(Specimen("new"), test_id="T-1", marks=rows, settings=BY_MARKS)
    assert "splices-unlike" not in {one.code for one in found.notes}


@pytest.mark.parametrize(("of_stretched", "is_told"), [(np.nan, True), (400.0, False)])
def test_marks_without_a_hold_in_any_log_are_told(of_stretched, is_told):
    near, far, thimble = 0.3048 * PRINTED
    rows = SpliceMarks("new", ("T-1",) * 4, ("slack", "min", "centre", "max"), near, far, thimble)
    force = of_stretched * np.array([0.0, 0.8, 1.0, 1.2])
    force[0] = 0.0  # the rest is in the log
    found = fit_strain_model(Specimen("new"), test_id="T-1", marks=rows, mark_tension=force)
    told = {one.code: one for one in found.notes}
    assert ("marks-without-tension" in told) == is_told
    if is_told:
        assert told["marks-without-tension"].numbers["n_marks"] == 3
        assert "marks-without-hold" not in told


def test_a_grip_in_place_of_a_splice_does_not_stretch():
    readings = PRINTED.copy()
    readings[0] = 0.1
    near, far, thimble = 0.3048 * readings
    rows = SpliceMarks("new", ("T-1",) * 4, ("slack", "min", "centre", "max"), near, far, thimble)
    found = fit_strain_model(Specimen("new"), test_id="T-1", marks=rows, settings=BY_MARKS)
    assert "splices-unlike" not in {one.code for one in found.notes}


def test_a_tape_is_not_taken_to_read_better_than_a_hundredth_of_a_foot():
    rows = marks([5.90, 5.90], [4.510, 4.530], reading_uncertainty=0.0)
    check_marks(rows)
    with pytest.raises(DataError, match="contradict each other"):
        check_marks(marks([5.90, 5.90], [4.510, 4.540], reading_uncertainty=0.0))


def test_the_same_position_in_two_tests_is_no_contradiction():
    check_marks(marks([5.90, 5.90], [4.51, 4.60], test=("T-1", "T-2")))
    with pytest.raises(DataError, match="contradict"):
        check_marks(marks([5.90, 5.90], [4.51, 4.60], test=("T-1", "T-1")))


def test_only_the_tests_asked_for_are_looked_at():
    rows = marks([5.90, 5.90], [4.51, 4.60])
    check_marks(rows, tests=["T-2"])
    with pytest.raises(DataError, match="contradict"):
        measured(rows, HOLDS, RAMP)


def test_a_mark_on_the_way_down_belongs_to_the_hold_that_was_reached_from_above():
    holds = [*HOLDS, (300.0, 360.0, 5.90, False)]
    falling = np.where(RAMP < 295.0, RAMP, 600.0 - RAMP)
    rows = marks([3.74, 5.90, 5.90], [2.55, 4.51, 4.45], hold=("slack", "min", "min down"))
    _, up, down = measured(rows, holds, falling)
    assert up == pytest.approx(80.0 - 5.0, abs=0.06)
    assert down == pytest.approx(600.0 - 355.0, abs=0.06)


def test_marks_of_one_pull_that_no_law_of_the_tension_follows_are_named():
    """Splices that stretch by a tenth of the strain, whose tension has an inflection."""
    strain = np.array([0.0, 0.5, 0.9, 1.4, 1.9, 2.4])
    force = 200 * strain + 270 * ((strain - 1.2) ** 3 + 1.2**3)
    splice, free = 1.2 * (1 + 0.1 * strain), 2.5 * (1 + strain)
    rows = marks(
        free + splice, free, hold=("slack", "30 %", "60 %", "min", "centre", "max"),
        reading_uncertainty=1e-3,
    )  # fmt: skip
    rows = replace(rows, is_reading_stated=True)
    model = fit_strain_model(Specimen("new"), test_id="T-1", marks=rows, mark_tension=force)
    (found,) = [one for one in model.notes if one.code == "splice-side-rejected"]
    # both sides are in the interval
    assert found.severity == "note"
    assert found.numbers["is_strain"]


def marks_up_and_down(splice):
    """Exact marks at slack, in three holds on the way up, and in one on the way down."""
    free = 2.5 * (1 + np.array([0.0, 0.6, 1.0, 1.4, 13 / 15]))
    rows = marks(
        free + splice, free, hold=("slack", "min", "centre", "max", "centre down"),
        reading_uncertainty=1e-5,
    )  # fmt: skip
    return replace(rows, is_reading_stated=True)


def test_friction_that_holds_the_splices_while_the_rubber_relaxes_shows_as_the_crosshead_stops():
    """6 % of friction, all within the relaxation of the holds, most of it before a tape is read."""
    arrival = np.array([0.0, 300.0, 450.0, 600.0, 400.0])
    end = arrival * np.array([1.0, 0.96, 0.96, 0.96, 1.03])
    rest = 1.2
    splice = rest + rest * 0.2 * arrival / 450.0 * np.array([1.0, 1.0, 1.0, 1.0, 1.06])
    model = fit_strain_model(
        Specimen("new"), test_id="T-1", marks=marks_up_and_down(splice), mark_tension=end,
        mark_tension_at_start=end + 0.2 * (arrival - end), mark_tension_on_arrival=arrival,
    )  # fmt: skip
    assert 0.06 / 1.96 < model.splice_friction < 0.06


def test_a_hold_has_the_tension_of_its_arrival_before_the_rubber_relaxes():
    """A tension that falls by 63 % of 40 N within the first second of a hold."""
    time = np.arange(0.0, 60.0, 0.1)
    tension = 300.0 + 40.0 * np.exp(-time)
    rows = marks([5.90], [4.51], hold=("min",))
    hold = [(0.0, 59.9, 5.90, False)]
    on_arrival, at_start = (
        float(measured(rows, hold, tension, reading=one)[0]) for one in ("arrival", "start")
    )
    # the mean of the first three readings, and of ten seconds
    assert on_arrival == pytest.approx(300.0 + 40.0 * np.mean(np.exp([0.0, -0.1, -0.2])))
    assert at_start == pytest.approx(300.0 + 4.0, abs=0.3)


def test_marks_on_the_way_down_say_the_friction_of_the_splices():
    """Splices that are 8 % of their extension longer there, by construction."""
    force = np.array([0.0, 300.0, 450.0, 600.0, 400.0])
    rest, by_law = 1.2, 1.2 * 0.2 * force / 450.0
    splice = rest + by_law * np.array([1.0, 1.0, 1.0, 1.0, 1.08])
    rows = marks_up_and_down(splice)
    model = fit_strain_model(Specimen("new"), test_id="T-1", marks=rows, mark_tension=force)
    assert model.splice_friction == pytest.approx(0.08, abs=0.004)
    assert "centre down" not in model.mark_hold


def test_a_last_test_whose_only_mark_has_no_hold_has_no_marks_of_its_own():
    """Splices that slip by some 30 mm from test to test; the last log shows no hold for its mark."""
    test = ("T-1", *(f"T-{1 + at // 2}" for at in range(8)), "T-5")
    strain = np.array([0.0, 0.5, 0.9, 0.7, 1.1, 0.9, 1.3, 1.1, 1.5, 1.2])
    let_out = 0.03 * np.array([0, 0, 0, 1, 1, -1, -1, 2, 2, 0])
    splice, free = 1.2 * (1 + 0.2 * strain) + let_out, 2.5 * (1 + strain)
    rows = marks(
        free + splice, free, test=test, hold=("slack", *["min", "max"] * 4, "centre"),
        reading_uncertainty=5e-4,
    )  # fmt: skip
    rows = replace(rows, is_reading_stated=True)
    model = fit_strain_model(
        Specimen("new"), test_id="T-5", marks=rows,
        mark_tension=np.append(300.0 * strain[:-1], np.nan),
    )  # fmt: skip
    assert "splices-slip" in [one.code for one in model.notes]
    # it may have slipped by as much as the others differ
    assert model.splice_slip == pytest.approx(0.03 * np.std([0, 1, -1, 2]), rel=0.3)


# relaxed lengths of tape readings; covariances against many sets of marks drawn

READING = 0.00124
DRAWS = 4000


def drawn_rows(n_rows, seed):
    """Free and splice lengths of many sets of slack rows."""
    near, far, thimble = np.random.default_rng(seed).normal(0, READING, (3, DRAWS, n_rows))
    return 2.55 + far - near, 1.18 + thimble - far + near


def test_relaxed_lengths_share_their_toe_readings():
    free, splice = drawn_rows(6, 1)
    means = np.stack([free.mean(axis=1), splice.mean(axis=1)])
    found = relaxed_lengths([2.55], [1.18], reading_uncertainty=READING)
    # one row is all the tape says; six rows are a sixth of it
    np.testing.assert_allclose(np.cov(means), found.covariance / 6, rtol=0.1)


def test_scatter_that_the_tape_explains_leaves_its_error_as_stated():
    """The larger of both would be 1.37 times too large in the mean: E max(1, chi^2_2 / 2)."""
    free, splice = drawn_rows(2, 2)
    found = [
        relaxed_lengths(one, other, reading_uncertainty=READING).covariance
        for one, other in zip(free, splice, strict=True)
    ]
    # two rows leave two degrees of freedom; sound ones are widened in one set of 200
    expected = 1 + stats.chi2.sf(stats.chi2.isf(0.005, 2), 4) - 0.005
    assert expected == pytest.approx(1.027, abs=1e-3)
    mean = np.mean(found, axis=0).diagonal() / (np.array([2.0, 3.0]) * READING**2 / 2)
    np.testing.assert_allclose(mean, expected, atol=0.02)


def test_relaxed_lengths_that_differ_are_widened_together():
    found = relaxed_lengths([2.50, 2.60], [1.18, 1.18], reading_uncertainty=READING)
    assert found.values.tolist() == pytest.approx([2.55, 1.18])
    # the inverse of [[2, -2], [-2, 3]] has 3/2 for the free length; two rows, each 0.05 off
    chi_square = 2 * 1.5 * (0.05 / READING) ** 2
    widened = READING**2 * chi_square / 2
    np.testing.assert_allclose(found.covariance, widened * np.array([[2, -2], [-2, 3]]) / 2)
    ratio = np.sqrt(chi_square / 2)
    assert str(found.note).startswith(
        f"the rows scatter {ratio:.1f} times as much as tape reading explains"
    )


def test_rows_without_a_stated_error_take_their_scatter():
    free = np.array([2.54, 2.55, 2.56])
    found = relaxed_lengths(free, 3.73 - free, reading_uncertainty=0.0)
    # free and splices differ by one toe: their scatter is 1 cm each, against one another, and
    # 0.01^2 (3/2 - 2 + 1) in readings; four degrees of freedom, Student's t 2.776 over 1.960
    reading = np.sqrt(2 * 0.01**2 * 0.5 / 4) * 2.776445 / 1.959964
    assert np.sqrt(found.covariance[0, 0]) == pytest.approx(reading * np.sqrt(2 / 3), rel=1e-5)
    assert str(found.note).endswith("it is estimated from their scatter, with 4 degrees of freedom")


# scatter of tape readings; expected values from printed quantiles and from draws

LINE = np.stack([np.ones(3), np.arange(3.0)])
AWAY = np.array([1.0, -2.0, 1.0]) / np.sqrt(6)  # what no line through three rows can follow


def test_a_stated_error_stands_up_to_the_quantile_and_widens_beyond():
    # 7.879 is the 99.5 % point of chi-square with one degree of freedom
    inside = row_scatter(4.0, 2 * np.sqrt(7.87) * AWAY, LINE)
    assert (inside.variance, inside.widening, inside.note) == (4.0, 1.0, None)
    beyond = row_scatter(4.0, 2 * np.sqrt(7.89) * AWAY, LINE)
    assert beyond.widening == pytest.approx(np.sqrt(7.89))
    assert beyond.variance == pytest.approx(4.0 * 7.89)
    assert str(beyond.note) == (
        "the rows scatter 2.8 times as much as tape reading explains (chi-square 7.89 with 1 "
        "degree of freedom, probability one in 201); their uncertainty is increased by this factor"
    )


def test_an_error_of_what_the_rows_share_explains_residuals_too():
    # the relaxed length moves the rows by twice what one reading does, along what is left over
    found = row_scatter(1.0, 4.0 * AWAY, LINE, 2.0 * AWAY)
    assert found.widening == 1.0  # 16 / (1 + 4) is 3.2
    assert row_scatter(1.0, 4.0 * AWAY, LINE).widening == pytest.approx(4.0)


def test_what_the_coefficients_follow_explains_nothing():
    assert row_scatter(1.0, 4.0 * AWAY, LINE, 5.0 * LINE).widening == pytest.approx(4.0)


def test_the_mean_variance_of_sound_rows_is_the_derived_one():
    rng = np.random.default_rng(3)
    residual = rng.normal(size=(20_000, 1)) * AWAY
    mean = np.mean([row_scatter(1.0, one, LINE).variance for one in residual])
    expected = 1 + stats.chi2.sf(stats.chi2.isf(LEVEL, 1), 3) - LEVEL
    assert expected == pytest.approx(1.0436, abs=1e-4)
    assert mean == pytest.approx(expected, abs=0.015)


def test_without_a_stated_error_an_interval_by_1_96_holds_95_per_cent():
    rng = np.random.default_rng(4)
    rows = rng.normal(size=(4000, 3))
    held = [
        abs(row.mean())
        <= 1.96 * np.sqrt(row_scatter(0.0, row - row.mean(), np.ones((1, 3))).variance / 3)
        for row in rows
    ]
    assert np.mean(held) == pytest.approx(0.95, abs=0.011)


@pytest.mark.parametrize(
    ("size", "note"), [(2, "they are treated as exact"), (3, "1 degree of freedom")]
)
def test_without_a_stated_error_the_note_says_what_is_taken(size, note):
    found = row_scatter(0.0, np.zeros(size), LINE[:, :size])
    assert found.variance == 0.0
    assert str(found.note).startswith("the rows have no stated reading error") and str(
        found.note
    ).endswith(note)


def test_a_row_to_spare_is_needed_to_refute_the_tape():
    assert row_scatter(1.0, np.zeros(2), LINE[:, :2]).variance == 1.0


def test_odds_that_are_too_small_to_print_are_not_printed():
    assert "below one in a million" in str(row_scatter(1.0, 100 * AWAY, LINE).note)


REFUSED = {
    "rows too few to tell which is wrong name none": (
        lambda: check_marks(marks([3.74, 5.90, 6.63], [2.55, 4.51, 4.40])),
        DataError,
        r"Correct the row in the marks file",
    ),
    "splices that shrink under more stretch are refused": (
        lambda: check_marks(marks([5.90, 6.00], [4.51, 4.70])),
        DataError,
        "grows with position, by no more than position does",
    ),
    "no slack row is refused": (
        lambda: relaxed_lengths([], [], reading_uncertainty=READING),
        DataError,
        "the marks have no slack row",
    ),
    "relaxed lengths are positive": (
        lambda: relaxed_lengths([0.0], [1.18], reading_uncertainty=READING),
        DataError,
        "relaxed length are not positive",
    ),
}


test_refusals = refusals(REFUSED)
