"""Comparisons in an archive: every number in its place, what is not known absent, CF kept."""

import hashlib
from dataclasses import fields, replace

import numpy as np
import pytest
from compared_hoses import LOOP, NOT_APART, SOURCE, TRUTH, agreeing, dataset, differing, trading
from measured_hoses import INCH
from rulesofcf import hold_against_cf

from reduction.archive.open import open_archive
from reduction.archive.shared_errors import FREEDOM
from reduction.archive.uncertainty_budget import budget_from_archive
from reduction.archive.write import write_archive
from reduction.prediction.comparison_error import EventDifference
from reduction.quantities.names import COMPARISON_SCHEMA

CURVES = ("ascending", "descending", "midline")


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("archive") / "comparisons.nc"
    write_archive(dataset(), path)
    return path


@pytest.fixture
def archive(path):
    with open_archive(path) as data:
        yield data.load()


def renamed(named, name, cell):
    """A comparison under another name, with the errors of one load cell."""
    curve = named.comparison.measured
    whose = replace(curve, component=tuple(replace(one, of=cell) for one in curve.component))
    return replace(named, name=name, comparison=replace(named.comparison, measured=whose))


def of(name):
    """The comparison of this row of the archive."""
    return {"alike": agreeing, "apart": differing, "trade": trading}[name]().comparison


@pytest.mark.parametrize("row", range(3))
def test_curves_and_differences_come_back_at_every_strain(archive, row):
    found = of(str(archive["comparison"].values[row]))
    size = found.measured.strain.size
    on_strains = {
        "strain": found.measured.strain,
        "predicted_tension": found.prediction.tension,
        "predicted_tension_standard_uncertainty": found.validation.input_standard_uncertainty,
        "validation_uncertainty": found.validation.validation_uncertainty,
    }
    for place, curve in enumerate(CURVES):
        missing = np.full(size, np.nan)
        difference = found.differences.get(curve)
        tension, spread, apart = (
            (missing, missing, missing)
            if difference is None
            else (
                found.measured.tension_of(curve),
                np.sqrt(
                    found.measured.standard_uncertainty_of(curve) ** 2
                    + np.sum(found.measured.contribution_of(curve) ** 2, axis=0)
                ),
                difference.difference,
            )
        )
        for name, values in (
            ("measured_tension", tension),
            ("measured_tension_standard_uncertainty", spread),
            ("tension_difference", apart),
        ):
            stored = archive[name].values[row, place]
            np.testing.assert_allclose(stored[:size], values, rtol=1e-15)
            assert np.isnan(stored[size:]).all()
    for name, values in on_strains.items():
        stored = archive[name].values[row]
        np.testing.assert_array_equal(stored[:size], values)
        assert np.isnan(stored[size:]).all()


def test_random_and_shared_parts_stand_beside_the_whole_uncertainty(archive):
    """A load cell that may be 20 N off, and the scatter of a curve."""
    assert archive["uncertainty_source"].values.tolist() == ["tension_offset"]
    rows = archive["measured_tension_uncertainty_contribution"]
    assert rows.dims == ("uncertainty_component", "comparison", "curve", "comparison_point")
    known = np.isfinite(archive["measured_tension"].values)
    assert np.isfinite(rows.values[0][known]).all() and np.isnan(rows.values[0][~known]).all()
    np.testing.assert_allclose(rows.values[0][known], 20.0, rtol=1e-12)
    whole = archive["measured_tension_standard_uncertainty"].values[known]
    random = archive["measured_tension_random_standard_uncertainty"].values[known]
    np.testing.assert_allclose(whole, np.hypot(20.0, random), rtol=1e-12)


def test_tests_under_one_load_cell_name_one_error(tmp_path):
    """Their rows stand in one line of the archive: what is wrong with one is with the other."""
    parts = [
        renamed(differing(), "one", "cell A"), renamed(differing(), "two", "cell A"),
        renamed(differing(), "three", "cell B"),
    ]  # fmt: skip
    data = dataset(*parts)
    assert data["uncertainty_source_of"].values.tolist() == ["cell A", "cell B"]
    rows = np.nanmax(data["measured_tension_uncertainty_contribution"].values, axis=(2, 3))
    np.testing.assert_allclose(rows, [[20.0, 20.0, 0.0], [0.0, 0.0, 20.0]])


def test_budgets_of_the_measured_curve_can_be_asked_for(archive):
    at = {"comparison": "alike", "curve": "midline", "comparison_point": "50"}
    found = budget_from_archive(archive, "measured_tension", at)
    assert [row.source for row in found.rows] == ["tension_offset", "random"]
    # scatter of hundreds of samples
    assert found.coverage_factor == pytest.approx(1.96, abs=0.001)


def test_the_longest_comparison_gives_the_axis(archive):
    sizes = [of(name).measured.strain.size for name in ("alike", "apart", "trade")]
    assert archive.sizes["comparison_point"] == max(sizes) > min(sizes)
    np.testing.assert_array_equal(archive["comparison_point"], np.arange(1, max(sizes) + 1))


def test_the_midline_of_a_pull_is_absent_and_its_ascending_branch_is_judged(archive):
    assert archive["judged_curve"].values.tolist() == ["midline", "ascending", "midline"]
    bias = archive["tension_bias"].values
    assert np.isfinite(bias[1, 0]) and np.isnan(bias[1, 1:]).all()
    assert np.isfinite(bias[[0, 2]]).all()


def test_a_stiffer_rubber_is_a_difference_of_that_much(archive):
    """5 % of the rubber: 10 psi of A (l - l^-2) / 3."""
    strain = archive["strain"].values[0]
    stretch = 1 + strain
    area = np.pi / 4 * (TRUTH.outer_diameter**2 - TRUTH.inner_diameter**2)
    more = area * 10 * 6894.757293168 / 3 * (stretch - stretch**-2)
    apart = archive["tension_difference"].values[0, 2]
    there = np.flatnonzero(np.isfinite(apart))
    # a bin is rounded where the cords pick up, and has no bend at an end
    smooth = there[1:-1][np.abs(strain[there[1:-1]] - TRUTH.pick_up_strain()) > 0.02]
    np.testing.assert_allclose(apart[smooth], -more[smooth], rtol=0, atol=0.05)
    assert archive["worst_strain"].values[0, 2] == strain[there][-1]
    assert TRUTH.outer_diameter == 5 * INCH


def test_the_loop_has_the_area_that_was_made(archive):
    ends = archive["energy_strain_low"].values, archive["energy_strain_high"].values
    for row in (0, 2):
        assert archive["loop_energy"].values[row] == pytest.approx(
            LOOP * (ends[1][row] - ends[0][row]), rel=1e-6
        )
    assert np.isnan(archive["loop_energy"].values[1])
    assert np.isnan(archive["loop_energy_share"].values[1])


def test_a_hose_that_softens_has_a_bias_that_rises_by_decades(archive):
    """Two percent a decade of the mean tension over the strains."""
    strain = archive["strain"].values[2]
    rise = 0.02 * np.nanmean(TRUTH.tension(strain))
    assert archive["bias_per_decade"].values[2] == pytest.approx(rise, rel=1e-3)
    assert np.isnan(archive["bias_per_decade"].values[1])


def test_cycles_end_in_nothing_where_there_are_fewer(archive):
    numbers = archive["comparison_cycle_number"].values
    assert numbers.tolist() == [[1, 2, 3, *[0] * 7], [1, *[0] * 9], [*range(1, 11)]]
    bias = archive["cycle_bias"].values
    np.testing.assert_array_equal(np.isfinite(bias), numbers > 0)
    np.testing.assert_array_equal(bias[2], of("trade").cycles.cycle_bias)
    np.testing.assert_array_equal(archive["cycle_rms"].values[2], of("trade").cycles.cycle_rms)


def test_judgements_are_those_of_the_comparison(archive):
    names = (
        "coverage_factor", "largest_ratio", "largest_ratio_strain", "chi_square",
        "chi_square_freedom", "uncertainty_share", "chi_square_probability", "agrees",
        "is_informative", "verdict",
    )  # fmt: skip
    for row, name in enumerate(archive["comparison"].values):
        for variable in names:
            assert archive[variable].values[row] == getattr(of(str(name)).validation, variable)
    assert archive["agrees"].values.tolist() == [1, 0, 1]
    assert archive["agrees"].attrs["flag_meanings"] == "no yes"


def test_events_have_both_sides_and_nothing_where_the_test_did_not_go(archive):
    assert archive["hose_event"].values.tolist() == ["pick_up", "working", "break"]
    names = [one.name for one in fields(EventDifference) if one.name != "name"]
    for row, one in enumerate(archive["comparison"].values):
        for place, event in enumerate(of(str(one)).events):
            for name in names:
                stored = archive[f"event_{name}"].values[row, place]
                np.testing.assert_array_equal(stored, getattr(event, name))
    assert np.isnan(archive["event_measured_tension"].values[:, 2]).all()
    # a hose of 64 degrees picks up where its cords have their length again
    pick_up = (np.sqrt(1 + 4 * np.tan(np.radians(64)) ** 2) - 3) / 2
    np.testing.assert_allclose(archive["event_strain"].values[:, 0], pick_up, rtol=1e-9)


def test_fitted_numbers_stand_beside_their_units(archive):
    names = archive["parameter_name"].values
    assert names.tolist() == [["wrap_angle", "rubber_modulus"], ["", ""], [*NOT_APART]]
    units = archive["parameter_unit"].values
    assert units.tolist() == [["rad", "Pa"], ["", ""], ["1", "1"]]
    fit = of("alike").calibration
    for variable, field in (
        ("parameter_start", "start"), ("parameter_value", "value"),
        ("parameter_value_standard_uncertainty", "value_standard_uncertainty"),
        ("parameter_low", "low"), ("parameter_high", "high"),
        ("parameter_lower_bound", "lower_bound"), ("parameter_upper_bound", "upper_bound"),
    ):  # fmt: skip
        np.testing.assert_array_equal(archive[variable].values[0], getattr(fit, field))
        assert np.isnan(archive[variable].values[1]).all()
    # made with 64 degrees and 210 psi
    assert np.degrees(archive["parameter_value"].values[0, 0]) == pytest.approx(64, abs=0.01)
    assert archive["parameter_value"].values[0, 1] == pytest.approx(210 * 6894.757293168, rel=1e-3)
    correlation = archive["parameter_correlation"].values
    np.testing.assert_array_equal(correlation[0], fit.correlation)
    assert np.isnan(correlation[1]).all()
    assert archive["parameter_is_at_bound"].values.tolist() == [[0, 0]] * 3


def test_what_was_not_asked_is_neither_yes_nor_no(archive):
    flag = archive["is_identified"]
    assert flag.attrs["flag_meanings"] == "no yes not_asked"
    assert flag.values.tolist() == [1, 2, 0]
    words = archive["identifiability"].values
    assert words[0] == "" and words[1] == "" and all(name in words[2] for name in NOT_APART)
    for name in (
        "calibrated_bias", "calibrated_rms", "calibrated_relative_rms", "collinearity",
        "least_change", "needed_change", "model_error", "effective_points",
    ):  # fmt: skip
        values = archive[name].values
        assert np.isnan(values[1]) and np.isfinite(values[[0, 2]]).all()
    assert np.isnan(archive["calibrated_tension"].values[1]).all()


def test_the_calibrated_curve_is_that_of_the_hose_the_test_was_made_of(archive):
    """To what the fit leaves: a bin in which the cords pick up is rounded."""
    strain = archive["strain"].values[0]
    there = np.isfinite(strain)
    tension = TRUTH.but(rubber_modulus=210 * 6894.757293168).tension(strain[there])
    np.testing.assert_allclose(archive["calibrated_tension"].values[0, there], tension, atol=5)


def test_without_any_calibration_its_variables_are_absent(tmp_path):
    write_archive(dataset(differing()), tmp_path / "comparisons.nc")
    with open_archive(tmp_path / "comparisons.nc") as data:
        assert "parameter" not in data.sizes
        absent = {name for name in COMPARISON_SCHEMA if name not in data}
    assert {
        "parameter_name", "calibrated_tension", "is_identified", "identifiability", "collinearity",
    } <= absent  # fmt: skip


def test_every_number_of_a_comparison_is_found_by_its_name(archive):
    # a row whose name no part of a comparison has would be left out without a word
    assert set(COMPARISON_SCHEMA) - set(archive.variables) <= {FREEDOM}


def test_notes_stand_once_with_the_comparison_they_are_of(archive):
    pairs = list(zip(archive["note_comparison"].values, archive["note"].values, strict=True))
    for named in (agreeing(), differing(), trading()):
        assert [note for name, note in pairs if name == named.name] == list(map(str, named.notes))
    assert len(set(pairs)) == len(pairs)


def test_the_file_keeps_every_rule(path):
    hold_against_cf(path)


def test_attributes_say_where_it_is_from_and_that_it_is_synthetic(archive):
    assert archive.attrs["id"] == "c/comparisons"
    assert archive.attrs["title"] == "Hoses (synthetic data)"
    assert archive.attrs["raw_file_sha256"] == SOURCE.sha256
    assert archive.attrs["history"] == "reduction 1 compare: 3 comparisons"


def test_equal_comparisons_give_equal_bytes(path, tmp_path):
    write_archive(dataset(), tmp_path / "again.nc")
    first, second = (
        hashlib.sha256(one.read_bytes()).hexdigest() for one in (path, tmp_path / "again.nc")
    )
    assert first == second
