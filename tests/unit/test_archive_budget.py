"""The budget of one number, read from an archive."""

from math import nan

import numpy as np
import pytest
import xarray as xr

from reduction.archive.uncertainty_budget import (
    all_budgets,
    budget_from_archive,
    cycles_averaged,
    effective_freedom,
    place_name,
    quantities_with_budget,
    random_freedom,
    words_of,
)
from reduction.record.contributions import coverage_factor
from reduction.record.errors import ArchiveError, SettingsError
from reduction.uncertainty.budget import conformity


@pytest.fixture
def archive():
    dims = ("specimen", "branch_name", "segment")
    return xr.Dataset(
        {
            "segment_modulus": (dims, [[[1e6, np.nan], [2e6, 3e6]]], {"units": "Pa"}),
            "segment_modulus_random_standard_uncertainty": (dims, [[[4e3, 1.0], [4e3, 0.0]]]),
            "segment_modulus_uncertainty_contribution": (
                ("uncertainty_component", *dims),
                [
                    [[[3e3, 1.0], [0.0, 3e3]]],
                    [[[0.0, 1.0], [3e3, -4e3]]],
                    [[[0.0, 1.0], [4e3, 0.0]]],
                ],
            ),
            "tangent_modulus": (("specimen", "strain_bin"), [[5.0, 6.0]], {"units": "Pa"}),
            "tangent_modulus_count": (("specimen", "strain_bin"), [[10, 4]]),
            "tangent_modulus_random_standard_uncertainty": (
                ("specimen", "strain_bin"), [[1.0, 1.0]],
            ),
            "tangent_modulus_uncertainty_contribution": (
                ("uncertainty_component", "specimen", "strain_bin"), np.zeros((3, 1, 2)),
            ),
            "uncertainty_source": (
                "uncertainty_component",
                ["tension_gain", "strain_calibration", "strain_calibration"],
            ),
            "uncertainty_source_of": ("uncertainty_component", ["load cell", "new", "new"]),
            "uncertainty_source_number": ("uncertainty_component", [0, 0, 1]),
            "strain_bin_bounds": (("strain_bin", "bound"), [[0.9, 1.0], [1.0, 1.1]]),
            "peak_tension": ("cycle", [1.0, 2.0, 3.0]),
        },
        coords={
            "specimen": ["new"],
            "branch_name": ["ascending", "descending"],
            "segment": [1, 2],
            "strain_bin": [0.95, 1.05],
            "cycle": [1, 2, 3],
        },
    )  # fmt: skip


def test_sources_stand_by_their_share_and_those_of_one_fit_together(archive):
    found = budget_from_archive(
        archive, "segment_modulus", {"branch": "descending", "segment": "1"}
    )
    assert [(row.source, row.of) for row in found.rows] == [
        ("strain_calibration", "new"), ("random", ""),
    ]  # fmt: skip
    # 3 and 4 of one fit are 5; with 4 of scatter the variance is 41
    assert found.rows[0].contribution == pytest.approx(5e3)
    assert found.standard_uncertainty == pytest.approx(np.sqrt(41) * 1e3)
    assert found.rows[0].share == pytest.approx(25 / 41)
    # two degrees of freedom of three cycles, and the shared part: 2 (41/16)^2, 2.16 from tables
    assert found.degrees_of_freedom == 2
    assert found.coverage_factor == pytest.approx(2.16, abs=0.005)


def test_a_single_error_keeps_its_sign(archive):
    found = budget_from_archive(
        archive, "segment_modulus", {"branch": "descending", "segment": "2"}
    )
    assert [row.contribution for row in found.rows] == [-4e3, 3e3, 0.0]


def test_a_strain_is_read_between_bins_as_a_look_up_reads_it(archive):
    found = budget_from_archive(archive, "tangent_modulus", {"strain": "1.02"})
    # 0.7 of the way from 5 to 6
    assert found.value == pytest.approx(5.7)
    assert found.standard_uncertainty == pytest.approx(1.0)
    # means of 10 and of 4 cycles: 1/nu on a straight line
    assert 1 / found.degrees_of_freedom == pytest.approx(0.3 / 9 + 0.7 / 3)
    assert found.place == {"specimen": "new", "strain_bin": "1.02"}
    at_middle = budget_from_archive(archive, "tangent_modulus", {"strain": "1.05"})
    assert (at_middle.value, at_middle.degrees_of_freedom) == (6.0, pytest.approx(3))


def test_what_has_a_budget_is_listed(archive):
    assert quantities_with_budget(archive) == ("segment_modulus", "tangent_modulus")


@pytest.mark.parametrize(
    ("quantity", "at", "error", "words"),
    [
        ("peak_tension", {}, SettingsError, "peak_tension has no shared part.*segment_modulus"),
        ("colour", {}, SettingsError, "colour is not in this archive"),
        ("segment_modulus", {"segment": "1"}, SettingsError, "branch is not stated"),
        ("segment_modulus", {"cycle": "1"}, SettingsError, "does not vary with cycle"),
        ("segment_modulus", {"branch": "up", "segment": "1"}, SettingsError, "no branch 'up'"),
        ("tangent_modulus", {"strain": "3"}, SettingsError, "no bin at 3.*0.95 to 1.05"),
        (
            "segment_modulus", {"branch": "ascending", "segment": "2"}, ArchiveError,
            "no segment_modulus there; found specimen=new, branch=ascending, segment=2; "
            "needed segment 1",
        ),
    ],
)  # fmt: skip
def test_what_is_no_number_of_the_archive_is_refused(archive, quantity, at, error, words):
    with pytest.raises(error, match=words):
        budget_from_archive(archive, quantity, at)


def test_every_number_of_a_quantity_has_its_budget_and_what_is_no_number_has_none(archive):
    found = all_budgets(archive, "segment_modulus")
    assert [one.value for one in found] == [1e6, 2e6, 3e6]
    assert [one.place["segment"] for one in found] == ["1", "1", "2"]
    assert found[1] == budget_from_archive(
        archive, "segment_modulus", {"branch": "descending", "segment": "1"}
    )
    assert all_budgets(archive, "peak_tension") == []
    assert all_budgets(archive, "no_such_quantity") == []


def test_cycles_of_the_break_in_are_not_in_a_mean_and_give_no_degree_of_freedom(archive):
    assert random_freedom(archive, "segment_modulus") == 2
    settings = '{"reduction": {"cycles": {"break_in_cycles": 1}}}'
    assert random_freedom(archive.assign_attrs(settings=settings), "segment_modulus") == 1
    assert random_freedom(archive.drop_dims("cycle"), "segment_modulus") == 1
    assert random_freedom(archive, "tangent_modulus").tolist() == [[9, 3]]


def test_a_line_over_the_cycles_has_lost_two_and_a_regression_on_samples_counts_as_known(archive):
    with_line = archive.assign(dynamic_modulus_per_decade=("specimen", [1.0]))
    assert random_freedom(with_line, "dynamic_modulus_per_decade") == 1
    with_holds = archive.assign(relaxation_drop=("hold", [1.0]))
    assert np.isinf(random_freedom(with_holds, "relaxation_drop"))
    assert np.isinf(random_freedom(archive, "peak_tension"))


def test_every_axis_of_strain_is_asked_for_by_the_word_strain(archive):
    first = archive["tangent_modulus"].dims[1]
    renamed = archive.rename({first: "first_loading_strain_bin"}).rename(
        {"strain_bin_bounds": "first_loading_strain_bin_bounds"}
    )
    found = budget_from_archive(renamed, "tangent_modulus", {"strain": "1.02"})
    assert found.value == pytest.approx(5.7)
    # a single rise: of hundreds of samples, not of cycles
    assert np.isinf(random_freedom(renamed.drop_vars("tangent_modulus_count"), "tangent_modulus"))
    assert place_name("first_loading_strain_bin") == "strain"
    assert place_name("specimen") == "specimen"


def test_where_there_is_no_number_it_says_at_which_strains_there_is(archive):
    archive["tangent_modulus"][0, 0] = np.nan
    with pytest.raises(
        ArchiveError, match="found specimen=new, strain=0.95; needed strain 1.05 to 1.05"
    ):
        budget_from_archive(archive, "tangent_modulus", {"strain": "0.95"})
    archive["tangent_modulus"][0, 1] = np.nan
    with pytest.raises(ArchiveError, match="needed another place: there is none at any strain"):
        budget_from_archive(archive, "tangent_modulus", {"strain": "0.95"})


def test_bins_need_no_bounds(archive):
    bins = archive.rename(strain_bin="ratio_strain_bin").drop_vars("strain_bin_bounds")
    found = budget_from_archive(bins, "tangent_modulus", {"strain": "1.0"})
    assert found.value == pytest.approx(5.5)


@pytest.fixture
def with_readings(archive):
    component = "uncertainty_component"
    return archive.assign(
        diameter=("specimen", [0.02]),
        diameter_reading=(("specimen", "reading"), [[0.0199, 0.02, 0.0201, np.nan]]),
        diameter_random_standard_uncertainty=("specimen", [0.0]),
        diameter_uncertainty_contribution=((component, "specimen"), [[0.0], [0.0], [1e-4]]),
        uncertainty_source_degrees_of_freedom=(component, [np.inf, np.inf, 2.0]),
    )


def test_a_diameter_of_three_readings_has_two_degrees_of_freedom(with_readings):
    found = budget_from_archive(with_readings, "diameter", {})
    assert found.coverage_factor == pytest.approx(4.303, abs=0.001)  # t of 2 at 97.5 %, tables
    assert effective_freedom(with_readings, "diameter").tolist() == [2.0]
    old = with_readings.drop_vars("diameter_uncertainty_contribution")
    old["diameter_random_standard_uncertainty"] = ("specimen", [1e-4])
    assert effective_freedom(old, "diameter").tolist() == [2.0]


def test_the_few_readings_of_a_diameter_go_on_into_a_modulus(with_readings):
    at = {"branch": "descending", "segment": "1"}
    found = budget_from_archive(with_readings, "segment_modulus", at)
    # 41^2 over (16^2/2 of three cycles, 0, 9^2 and 16^2/2): the third row is of few readings
    assert found.effective_degrees_of_freedom == pytest.approx(41**2 / (16**2 / 2 + 16**2 / 2))
    everywhere = effective_freedom(with_readings, "segment_modulus")
    assert everywhere[0, 1, 0] == pytest.approx(found.effective_degrees_of_freedom)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("bedding_first_stiffness", np.inf), ("pull_peak_tension", np.inf),
        ("permanent_set", np.inf), ("test_quasi_static_spring_constant", np.inf),
        ("dynamic_stiffness", 4), ("dynamic_stiffness_drift", 3), ("test_apparent", 2),
        ("dynamic_modulus_per_decade", 1),
    ],
)  # fmt: skip
def test_a_number_counts_what_it_was_found_from(archive, name, expected):
    with_levels = archive.assign(dynamic_cycles=("specimen", [5]))
    assert np.all(random_freedom(with_levels, name) == expected)


def test_a_mean_of_one_cycle_is_known_by_the_samples_of_it(archive):
    archive["tangent_modulus_count"][0, 1] = 1
    assert random_freedom(archive, "tangent_modulus").tolist() == [[9, np.inf]]


@pytest.fixture
def properties():
    """Two stiffnesses of a rope, and a strain that it has none of; one error cancels."""
    along, of = "property", "uncertainty_component"
    return xr.Dataset(
        {
            "property_name": (along, ["dynamic stiffness", "dynamic stiffness"]),
            "property_specimen": (along, ["line-1", "line-1"]),
            "property_test": (along, ["R01", "R02"]),
            "property_remark": (along, ["", "there is no bedding-in step"]),
            "property_stiffness": (along, [1e5, np.nan], {"units": "N"}),
            "property_stiffness_random_standard_uncertainty": (along, [10.0, np.nan]),
            "property_stiffness_uncertainty_contribution": (
                (of, along), [[300.0, np.nan], [1e-13, np.nan]],
            ),
            "uncertainty_source": (of, ["tension_gain", "tension_offset"]),
            "uncertainty_source_of": (of, ["cell", "cell"]),
            "uncertainty_source_number": (of, [0, 0]),
        },
        coords={along: [1, 2]},
    )  # fmt: skip


def test_a_place_is_told_by_what_it_is_and_asked_for_by_that(properties):
    found = budget_from_archive(properties, "property_stiffness", {"property": "1"})
    words = "dynamic stiffness, line-1, R01"
    assert found.words == {"property": words}
    same = budget_from_archive(properties, "property_stiffness", {"property": words})
    assert same == found
    with pytest.raises(
        SettingsError, match=r"property is not stated.*2 \(dynamic stiffness, line-1, R02"
    ):
        budget_from_archive(properties, "property_stiffness", {})


def test_the_rounding_of_an_error_that_cancels_is_no_source(properties):
    found = budget_from_archive(properties, "property_stiffness", {"property": "1"})
    assert [row.source for row in found.rows] == ["tension_gain", "random"]


def test_where_there_is_no_number_the_archive_says_why(properties):
    with pytest.raises(ArchiveError, match="The archive says: there is no bedding-in step"):
        budget_from_archive(properties, "property_stiffness", {"property": "2"})


def test_a_slow_pull_is_read_between_its_tensions_and_told_with_the_unit():
    grid, of = "tension_grid", "uncertainty_component"
    name = "quasi_static_strain"
    pull = xr.Dataset(
        {
            name: (grid, [0.01, 0.02, 0.04], {"units": "1"}),
            f"{name}_random_standard_uncertainty": (grid, [0.0, 0.0, 0.0]),
            f"{name}_uncertainty_contribution": ((of, grid), [[1e-4, 2e-4, 4e-4]]),
            "uncertainty_source": (of, ["strain_gain"]),
            "uncertainty_source_of": (of, ["rope"]),
            "uncertainty_source_number": (of, [0]),
        },
        coords={grid: (grid, [100.0, 200.0, 300.0], {"units": "N"})},
    )
    found = budget_from_archive(pull, name, {"tension": "250"})
    assert (found.value, found.standard_uncertainty) == pytest.approx((0.03, 3e-4))
    assert found.words == {grid: "250 N"}
    with pytest.raises(SettingsError, match=r"tension is not stated.*\(100 N to 300 N\)"):
        budget_from_archive(pull, name, {})


def test_a_ratio_says_of_which_two(archive):
    archive = archive.assign(
        ratio_numerator=("comparison", ["used"]), ratio_denominator=("comparison", ["new"])
    )
    assert words_of(archive, "comparison", 0, {}) == "used over new"


@pytest.mark.parametrize("n_cycles", [3, 10, 30])
def test_differences_of_neighbours_are_worth_fewer_than_cycles(n_cycles):
    # drawn: twice the mean over the variance of what they are found from
    drawn = np.random.default_rng(3).normal(size=(200_000, n_cycles))
    variance = (np.diff(drawn, axis=1) ** 2).mean(axis=1) / 2
    expected = 2 * variance.mean() ** 2 / variance.var()
    archive = xr.Dataset({"peak_tension_change": ("specimen", [0.1])}, {"cycle": range(n_cycles)})
    found = random_freedom(archive, "peak_tension_change")
    assert found == pytest.approx(expected, rel=0.015)
    assert found < n_cycles - 1


def test_the_uncertainty_of_a_single_cycle_is_that_of_its_readings_not_of_a_scatter():
    # one pull and return: nothing scatters, and its readings are as many as those of a slow pull
    archive = xr.Dataset(
        {
            "tension_amplitude": (("specimen", "cycle"), [[100.0]]),
            "test_apparent_spring_constant": ("specimen", [1e6]),
            "test_apparent_spring_constant_standard_uncertainty": ("specimen", [1e4]),
        }
    )
    freedom = effective_freedom(archive, "test_apparent_spring_constant")
    assert coverage_factor(freedom) == pytest.approx([1.96], abs=1e-3)


def test_a_mean_is_of_the_cycles_after_the_break_in_that_have_a_number():
    # of twelve cycles two are break-in, and of the second specimen six more have no tension
    amplitude = np.full((2, 12), 100.0)
    amplitude[1, 4:10] = np.nan
    frequency = np.full(12, 0.1)
    archive = xr.Dataset(
        {
            "tension_amplitude": (("specimen", "cycle"), amplitude),
            "frequency": ("cycle", frequency),
            "test_dynamic_modulus": ("specimen", [1e6, 1e6]),
            "test_frequency": ("specimen", [0.1, 0.1]),
            "segment_modulus": (("specimen", "branch_name", "segment"), np.ones((2, 2, 3))),
            "peak_tension_per_decade": ("specimen", [1.0, 1.0]),
        },
        attrs={"settings": '{"reduction": {"cycles": {"break_in_cycles": 2}}}'},
    )
    assert cycles_averaged(archive, "test_dynamic_modulus").tolist() == [10, 4]
    assert random_freedom(archive, "test_dynamic_modulus").tolist() == [9.0, 3.0]
    assert random_freedom(archive, "segment_modulus")[:, 0, 0].tolist() == [9.0, 3.0]
    assert random_freedom(archive, "peak_tension_per_decade").tolist() == [8.0, 2.0]
    # scatter of four cycles: 3.18 times its standard uncertainty, by the table of Student's t
    spread = archive.assign(
        test_dynamic_modulus_standard_uncertainty=("specimen", [1e4, 1e4]),
    )
    freedom = effective_freedom(spread, "test_dynamic_modulus")
    assert coverage_factor(freedom) == pytest.approx([2.262, 3.182], abs=1e-3)


# decision rules: the cases of JCGM 106:2012, 8.2 and 8.3, one beside the other

# value, interval, lower, upper; simple acceptance, guard band
CASES = [
    (5.0, (4.0, 6.0), 3.0, 7.0, "conforms", "conforms"),
    (5.0, (4.0, 6.0), 4.0, 6.0, "conforms", "conforms"),
    (5.0, (4.0, 6.0), 4.5, 7.0, "conforms", "no statement"),
    (5.0, (4.0, 6.0), 5.0, None, "conforms", "no statement"),
    (5.0, (4.0, 6.0), None, 4.5, "does not conform", "no statement"),
    (5.0, (4.0, 6.0), 6.0, None, "does not conform", "no statement"),
    (5.0, (4.0, 6.0), 6.1, None, "does not conform", "does not conform"),
    (5.0, (4.0, 6.0), None, 3.9, "does not conform", "does not conform"),
    # wider than the tolerance: nothing can be shown to conform
    (5.0, (0.0, 10.0), 4.0, 6.0, "conforms", "no statement"),
    # not even about the value
    (5.0, (4.8, 9.0), 4.5, 8.0, "conforms", "no statement"),
    (5.0, (nan, nan), 4.0, 6.0, "conforms", "no statement"),
    (nan, (nan, nan), 4.0, 6.0, "no statement", "no statement"),
]


@pytest.mark.parametrize(("value", "interval", "lower", "upper", "simple", "guarded"), CASES)
def test_each_rule_decides_as_it_says(value, interval, lower, upper, simple, guarded):
    limits = {"lower": lower, "upper": upper}
    assert conformity(value, interval, rule="simple acceptance", **limits) == simple
    assert conformity(value, interval, rule="guard band", **limits) == guarded
