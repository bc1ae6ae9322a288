"""Line types from an archive, a look-up, a composite curve, with their spread."""

import json
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from csvrows import csv_rows
from export_lines import line
from export_sources import LEVELS, source
from predicted_hoses import dataset, predicted

from reduction.archive.dataset_builder import SCHEMA_VERSION
from reduction.archive.write import write_archive
from reduction.lines.archive_pieces import Turns
from reduction.lines.composite import (
    CompositeRule,
    CurvePiece,
    PieceSource,
    _composite_curve,
    compose,
)
from reduction.lines.deck_formats import export_line
from reduction.lines.export_line import CurveSpread, curve_from_zero, siblings_of
from reduction.lines.export_sources import (
    _to_turns,
    composite_table,
    line_from_archive,
    line_from_composite,
    line_from_lookup,
    ranges_of,
)
from reduction.lines.export_tables import curve_table
from reduction.lines.lookup_product import LineCurve, LineSource
from reduction.record.contributions import Component
from reduction.record.errors import ArchiveError, DataError, SettingsError

STRAIN = np.linspace(0.1, 1.0, 10)
UP, DOWN = 500 * STRAIN, 500 * STRAIN - 40 * STRAIN * (1 - STRAIN)


@pytest.fixture
def test_archive(tmp_path):
    """A file that looks like a reduced test, with what the curve is made of."""

    def write(up=UP, down=DOWN, **attributes):
        values = np.stack([np.stack([up, down]), np.stack([2 * up, 2 * down])])
        found = xr.Dataset(
            {
                "branch_tension": (("specimen", "branch_name", "strain_bin"), values),
                "diameter": ("specimen", [0.026, np.nan]),
                "rated_break_strength": ("specimen", [np.nan, 5e3]),
                "specimen_material": ("specimen", ["rubber", ""]),
                "specimen_condition": ("specimen", ["new", ""]),
            },
            coords={
                "specimen": ["new", "used"],
                "branch_name": ["ascending", "descending"],
                "strain_bin": STRAIN,
            },
            attrs={
                "schema_version": SCHEMA_VERSION, "id": "c/T-1", "title": "Tests", "source": "a rig",
                "raw_file": "T-1.csv", "raw_file_sha256": "ab", "references": "WHOI-2005-10",
                "synthetic": "no", "test": "T-1", "test_kind": "cyclic",
            }
            | attributes,
        )  # fmt: skip
        path = tmp_path / "T-1.nc"
        found.to_netcdf(path, engine="netcdf4")
        return path

    return write


@pytest.mark.parametrize(
    ("curve", "expected", "words"),
    [
        ("ascending", UP, "ascending branch, mean over"),
        ("descending", DOWN, "descending branch, mean over"),
        ("mean", (UP + DOWN) / 2, "mean of the ascending and descending branches"),
        (None, (UP + DOWN) / 2, "mean of the ascending and descending branches"),
    ],
)
def test_one_stated_curve_of_a_test(test_archive, curve, expected, words):
    found = line_from_archive(test_archive(), curve=curve, specimen="new")
    np.testing.assert_allclose(found.tension, expected)
    assert found.curve.startswith(words)
    assert found.tested == pytest.approx((0.1, 1.0))
    assert found.diameter == 0.026
    assert np.isnan(found.rated_break_strength)
    assert found.sources == (
        "archive c/T-1: Tests", "data: a rig", "raw file T-1.csv, sha256 ab",
        "references: WHOI-2005-10",
    )  # fmt: skip
    assert found.notes[:2] == ("material: rubber", "condition: new")


def test_the_distance_of_the_branches_is_told_with_their_mean(test_archive):
    found = line_from_archive(test_archive(), specimen="used")
    assert "up to 20 N apart" in found.notes[-1]
    assert found.rated_break_strength == 5e3


def test_what_is_stated_counts_and_is_said(test_archive):
    found = line_from_archive(
        test_archive(),
        specimen="new",
        diameter=0.03,
        linear_density=None,
        wet_linear_density=np.nan,
    )
    assert found.diameter == 0.03
    assert found.sources[-1] == "diameter: stated at the export"


def test_gaps_are_joined_and_told_and_half_a_loop_has_no_mean(test_archive):
    up, down = UP.copy(), DOWN.copy()
    up[4], down[9] = np.nan, np.nan
    found = line_from_archive(test_archive(up, down), specimen="new")
    assert found.strain.size == 8
    assert found.tested[1] == pytest.approx(0.9)
    assert "bins without a mean lie within" in found.notes[-1]


def test_noise_is_levelled_and_a_fall_is_refused(test_archive):
    noisy = UP.copy()
    noisy[5] = noisy[4] - 0.1
    found = line_from_archive(test_archive(noisy, DOWN), specimen="new", curve="ascending")
    assert found.tension[5] == found.tension[4]
    noisy[5] = noisy[4] - 10
    path = test_archive(noisy, DOWN)
    with pytest.raises(DataError, match=r"falls as the strain rises.*by 10 N at strain 0.6"):
        line_from_archive(path, specimen="new", curve="ascending")


def test_a_test_without_a_curve_and_a_specimen_that_is_not_there_are_refused(
    test_archive, tmp_path
):
    path = test_archive()
    with pytest.raises(SettingsError, match="which specimen is meant is not stated"):
        line_from_archive(path)
    with pytest.raises(SettingsError, match="there is no specimen 'old'"):
        line_from_archive(path, specimen="old")
    with pytest.raises(ArchiveError, match="there is no archive"):
        line_from_archive(tmp_path / "none.nc")
    nothing = np.full(10, np.nan)
    path = test_archive(nothing, nothing)
    with pytest.raises(DataError, match="has not two points"):
        line_from_archive(path, specimen="new", curve="ascending")
    xr.Dataset(attrs={"schema_version": SCHEMA_VERSION, "test_kind": "creep"}).to_netcdf(
        tmp_path / "creep.nc", engine="netcdf4"
    )
    with pytest.raises(
        DataError, match="no curve of tension over strain; found a test of the kind"
    ):
        line_from_archive(tmp_path / "creep.nc")


def test_a_hose_is_a_prediction_up_to_its_break(tmp_path):
    hoses = predicted("one"), predicted("two", 50.0)
    write_archive(dataset(*hoses), tmp_path / "predictions.nc")
    found = line_from_archive(tmp_path / "predictions.nc", specimen="two")
    prediction = hoses[1].prediction
    whole = ~np.asarray(prediction.is_broken)
    np.testing.assert_allclose(found.strain, prediction.strain[whole])
    np.testing.assert_allclose(found.tension, prediction.tension[whole])
    assert np.isnan(found.tested).all()
    assert found.curve == "predicted from construction, up to the break of the cords"
    with pytest.raises(SettingsError, match="a predicted hose has one curve"):
        line_from_archive(tmp_path / "predictions.nc", specimen="two", curve="mean")


def test_mass_a_length_comes_from_the_archive_and_what_is_stated_goes_before(
    tmp_path, test_archive
):
    with xr.open_dataset(test_archive()) as archive:
        archive.load()
    archive["linear_density"] = ("specimen", [0.6, np.nan])
    archive["wet_linear_density"] = ("specimen", [0.05, np.nan])
    archive.to_netcdf(tmp_path / "mass.nc", engine="netcdf4")
    found = line_from_archive(tmp_path / "mass.nc", specimen="new")
    assert (found.linear_density, found.wet_linear_density) == (0.6, 0.05)
    assert line_from_archive(
        tmp_path / "mass.nc", specimen="new", linear_density=0.7
    ).linear_density == pytest.approx(0.7)
    assert np.isnan(line_from_archive(tmp_path / "mass.nc", specimen="used").linear_density)


@pytest.mark.parametrize("loss_factor", [0.1, 0.3, 0.5])
def test_the_mean_curve_of_a_lossy_cycle_in_load_has_the_stiffness_of_the_cycle(loss_factor):
    """Strain lags the load: branches that are cut at 0.9 of its amplitude share less of the strain."""
    lag, end = np.arctan(loss_factor), np.arcsin(0.9)
    phase = np.linspace(-end, end, 2001)
    rise, fall = np.sin(phase - lag), np.sin(np.pi - phase - lag)
    strain = np.linspace(rise.min(), rise.max(), 400)[20:]
    shared = strain[(strain > fall.min()) & (strain < rise.max())]
    mean = [np.interp(shared, *(one[np.argsort(way)] for one in (way, load)))
            for way, load in ((rise, np.sin(phase)), (fall, np.sin(np.pi - phase)))]  # fmt: skip
    longer, tension, added = _to_turns(
        shared, np.mean(mean, axis=0), Turns((-1.0, 1.0), (-1.0, 1.0))
    )
    assert added.tolist() == [1, 1]
    assert np.ptp(tension) / np.ptp(longer) == pytest.approx(1.0)


def test_strain_over_tension_becomes_tension_over_strain():
    found = line_from_lookup(source())
    np.testing.assert_allclose(
        found.strain, 1e-4 * found.tension - 1e-8 * found.tension**2, atol=1e-15
    )
    assert found.tested == pytest.approx((0.0, 0.24))
    assert found.viscoelasticity is None
    assert found.linear_density == 0.1
    assert "errata that apply to the curve: CG-8" in found.sources
    assert found.notes == ("wet",)


def test_static_and_dynamic_stiffness_are_k_0_and_k_0_with_k_1():
    part = line_from_lookup(source(growth=0.0), levels=LEVELS).viscoelasticity
    assert (part.static_stiffness, part.fast_stiffness) == pytest.approx((2e4, 5e4))
    assert part.dashpot_coefficient == pytest.approx(9e4)
    assert part.dynamic_stiffness_per_mean_tension == 0


def test_growth_with_the_mean_tension_is_its_slope_and_the_value_at_the_mean_is_kept():
    found = line_from_lookup(source(), levels=LEVELS)
    part = found.viscoelasticity
    # 5000 N from 2000 to 3000 N of mean
    assert part.dynamic_stiffness_per_mean_tension == pytest.approx(5.0)
    assert part.dynamic_stiffness == pytest.approx(5e4 - 5 * 2000)
    assert part.fast_stiffness == pytest.approx(5e4)
    assert any("growth of the dynamic stiffness" in text for text in found.notes)
    assert any("errata CG-14" in text for text in found.sources)


def test_what_is_stated_is_taken_and_said():
    found = line_from_lookup(source(), linear_density=0.2, diameter=None)
    assert found.linear_density == 0.2
    assert found.diameter == 0.0127
    assert "linear density: stated at the export" in found.sources


def test_points_of_tension_over_strain_by_branch():
    at = np.array([0.5, 1.0, 2.0])
    curves = tuple(
        LineCurve("tension", "strain", 0.5, 2.0, at=at, value=scale * at, branch=branch)
        for branch, scale in (("ascending", 3.0), ("descending", 2.0))
    )
    found = line_from_lookup(source(curves=curves), branch="descending")
    np.testing.assert_array_equal(found.tension, [1.0, 2.0, 4.0])
    assert found.curve.startswith("tension over strain, descending branch")
    with pytest.raises(SettingsError, match="differs by branch"):
        line_from_lookup(source(curves=curves))


def test_outside_the_box_is_refused_or_flagged():
    levels = LEVELS | {"mean_tension": 3500.0}
    with pytest.raises(DataError, match="outside the tested range"):
        line_from_lookup(source(), levels=levels)
    found = line_from_lookup(source(), levels=levels, extrapolate="flag")
    assert any("OUTSIDE the tested range" in text for text in found.sources)


@pytest.mark.parametrize(
    ("curve", "message"),
    [
        (LineCurve("strain", "tension", 0.0, 1e4, coefficient=np.array([0, 1e-4, -1e-8])), "rise"),
        (
            LineCurve(
                "tension", "strain", 0.1, 1.0, at=np.array([0.1, 1.0]), value=np.array([5.0, 4.0])
            ),
            "rise",
        ),
        (LineCurve("strain", "tension", 0.0, 1e4, coefficient=np.array([0, np.nan])), "open"),
    ],
)
def test_a_curve_that_falls_or_is_open_is_refused(curve, message):
    with pytest.raises(DataError, match=message):
        line_from_lookup(source(curves=(curve,)))


def test_what_was_not_measured_is_named():
    with pytest.raises(SettingsError, match="no curve of tension and strain: the pull is lost"):
        line_from_lookup(source(curves=(), absent={"strain": "the pull is lost"}))
    with pytest.raises(SettingsError, match="need a mean tension"):
        line_from_lookup(source(), levels={"frequency": 0.3})


def test_the_last_of_a_cubic_that_turns_back_is_cut_and_told():
    turning = LineCurve("strain", "tension", 0.0, 5200.0, coefficient=np.array([0, 1e-4, -1e-8]))
    found = line_from_lookup(source(curves=(turning,)))
    assert found.tension[-1] == pytest.approx(5000, rel=0.006)
    assert found.tested[1] == found.strain[-1]
    assert "where the polynomial turns back" in found.notes[-1]


def test_a_constant_below_zero_costs_the_first_points():
    low = LineCurve("strain", "tension", 0.0, 4000.0, coefficient=np.array([-0.002, 1e-4]))
    found = line_from_lookup(source(curves=(low,)))
    assert found.strain[0] >= 0
    assert "has strain below zero up to 20 N" in found.notes[-1]
    assert found.tested[0] == found.strain[0]


def test_a_joint_that_stands_twice_is_one_point_and_one_branch_need_not_be_asked_for():
    twice = LineCurve(
        "branch_tension", "strain", 0.5, 2.0, at=np.array([0.5, 1.0, 1.0, 2.0]),
        value=np.array([3.0, 5.0, 5.0, 9.0]), branch="ascending",
    )  # fmt: skip
    found = line_from_lookup(source(curves=(twice,)))
    np.testing.assert_array_equal(found.strain, [0.5, 1.0, 2.0])
    assert "ascending branch" in found.curve
    with pytest.raises(SettingsError, match="differs by branch"):
        line_from_lookup(source(curves=(twice,)), branch="descending")


@pytest.mark.parametrize(("constant", "join", "doubt"), [(0.004, 40.0, False), (0.04, 200.0, True)])
def test_the_constant_of_a_regression_is_no_slack(constant, join, doubt):
    """Strain of A + 1e-4 T: twice A at A / 1e-4 N, or a twentieth of 4,000 N before that."""
    pull = LineCurve("strain", "tension", 0.0, 4000.0, coefficient=np.array([constant, 1e-4]))
    found = line_from_lookup(source(curves=(pull,)))
    assert found.tension[0] == pytest.approx(join)
    assert found.strain[0] == pytest.approx(constant + 1e-4 * join)
    assert found.tested == pytest.approx((constant + 1e-4 * join, constant + 0.4))
    (said,) = (note for note in found.notes if "constant of the fit" in note)
    assert said.startswith("DOUBTFUL") == doubt
    assert f"{100 * constant:.2g} m in 100 m" in said
    at, load, _ = curve_from_zero(found.strain, found.tension)
    assert load[1] > 0
    assert at[1] == found.strain[0]


def test_a_slack_that_was_measured_stays():
    slack = LineCurve(
        "tension", "strain", 0.0, 1.0, at=np.array([0.1, 0.2, 1.0]), value=np.array([0.0, 3.0, 9.0])
    )
    found = line_from_lookup(source(curves=(slack,)))
    np.testing.assert_array_equal(found.strain, [0.1, 0.2, 1.0])


def test_the_curve_ends_where_its_slope_is_not_trusted():
    pull = LineCurve("strain", "tension", 0.0, 4000.0, coefficient=np.array([0, 1e-4, -1e-8]))
    rest = LineCurve(
        "quasi_static_spring_constant", "mean_tension", 0.0, 2500.0,
        coefficient=pull.coefficient, is_inverse_slope=True, range_note="trusted to 2500 N",
    )  # fmt: skip
    found = line_from_lookup(source(curves=(pull, rest)))
    assert found.tension[-1] == pytest.approx(2500.0)
    assert found.tested[1] == pytest.approx(1e-4 * 2500 - 1e-8 * 2500**2)
    assert "trusted to 2500 N" in found.notes


def test_the_strength_is_that_of_the_line_as_it_is():
    assert line_from_lookup(source()).rated_break_strength == 28e3
    old = replace(source(), tensile_strength=12e3)
    found = line_from_lookup(old)
    assert found.rated_break_strength == 12e3
    assert "rated when new 28000 N" in found.notes[-1]
    assert line_from_lookup(old, rated_break_strength=9e3).rated_break_strength == 9e3
    other = line_from_lookup(replace(source(), strength_of="the 1 in line"))
    assert np.isnan(other.rated_break_strength)
    assert "of the 1 in line" in other.notes[-1]


def tether(name, at, value, **changed):
    curve = LineCurve(
        "branch_tension", "strain", at[0], at[-1], at=np.array(at), value=np.array(value),
        branch="ascending",
    )  # fmt: skip
    one = LineSource(name, "a report", "rubber", "tether", "new", 0.026, 3e3, curves=(curve,))
    return replace(one, kind="rubber tether", **changed)


def test_the_straight_start_is_held_against_other_tests_of_the_tether():
    """From 0 0 to 552 N at 1.72 it has 192.6 N at 0.6, where another test has 276 N: 30 % less."""
    line = tether("T-5", [1.72, 2.19], [552.0, 800.0])
    others = [
        line,
        tether("T-2", [0.6, 1.2, 1.8], [276.0, 565.0, 600.0]),
        tether("T-3", [1.0, 1.7], [321.0, 546.0]),
        tether("T-4", [1.8, 2.0], [560.0, 700.0]),
        tether("U-2", [0.6, 1.2], [100.0, 200.0], condition="used"),
    ]
    siblings = siblings_of(line, others)
    assert [one.name for one in siblings] == ["T-2", "T-3", "T-4"]
    notes = line_from_lookup(line, siblings=siblings).notes
    assert len(notes) == 2
    # 552 / 1.72 * 1.2 is 385 N
    assert notes[0].startswith("DOUBTFUL: the straight start is off by -32 percent at strain 1.2")
    assert "T-2 has 565 N" in notes[0]
    assert notes[1].startswith("the straight start is off by -0 percent")
    assert siblings_of(source(), others) == ()


def piece(name, low, high, kind="cyclic"):
    at = np.linspace(low, high, 21)
    return CurvePiece(name, kind, "mean", at, 100 * at, np.full(21, 0.5))


SOURCE = PieceSource(
    "tether", "mean", (piece("T-1", 0.5, 1.0), piece("T-2", 0.8, 1.2), piece("T-3", 1.4, 2.0)),
    diameter=0.02, sources=("archive a",), notes=("held is left out",), is_synthetic=True,
)  # fmt: skip
CURVE = compose(SOURCE, CompositeRule())


def test_joins_and_gaps_are_ranges_of_strain():
    gaps = ranges_of(CURVE, CURVE.is_gap)
    assert np.array(gaps) == pytest.approx(np.array([[0.0, 0.5], [1.2, 1.4]]))
    ((low, high),) = ranges_of(CURVE, CURVE.is_join)
    assert 0.8 <= low < 0.82 and 0.98 < high <= 1.0
    assert ranges_of(CURVE, CURVE.is_moved) == []


def test_the_line_says_what_the_curve_is_made_of():
    line = line_from_composite(SOURCE, CURVE, linear_density=0.6, diameter=None)
    assert line.curve == "composite of 3 tests, mean of both branches; one curve, no loop"
    assert line.tested == pytest.approx((0.5, 2.0))
    assert (line.diameter, line.linear_density, line.is_synthetic) == (0.02, 0.6, True)
    assert line.sources == ("archive a", "linear density: stated at the export")
    told = " ".join(line.notes)
    assert "no piece between strain 1.2 and 1.4" in told
    assert "several pieces contribute at strain 0.8" in told
    assert line.notes[-1] == "held is left out"


def test_the_table_flags_the_way_to_each_node():
    columns = {one.name: one.values for one in composite_table(SOURCE, CURVE).columns}
    at = np.array(columns["strain"])
    flagged = at[columns["is_gap"]]
    assert flagged == pytest.approx([0.25, 0.5, 1.3, 1.4])
    assert columns["piece"][0] == "" and columns["piece"][-1] == "T-3 cycles"
    assert columns["tension"] == pytest.approx(100 * at)


def test_the_header_has_the_stiffness_of_the_tests_beside_that_of_the_table():
    """400 N per unit strain, and 800 N per unit strain 80 % further out: the join is softer."""
    low, high = np.linspace(0.4, 1.5, 41), np.linspace(1.0, 1.6, 41)
    pieces = [
        CurvePiece(name, "cyclic", "mean", at, load, 0 * at)
        for name, at, load in (("T-1", low, 400 * low), ("T-2", high, 800 * (high - 0.8)))
    ]
    for used, is_doubtful in ((pieces, True), (pieces[:1], False)):
        source = PieceSource("tether", "mean", tuple(used), sources=("a log",))
        notes = line_from_composite(source, compose(source, CompositeRule())).notes
        (said,) = (note for note in notes if note.startswith("EA of the tests"))
        assert ("table 400 N" in said) == (not is_doubtful)
        assert ("T-1 cycles 400 N (400 to 400), table 400 N, 160 to 600 N" in said) != is_doubtful
        warned = [
            note for note in notes if note.startswith("DOUBTFUL: the table joins unlike tests")
        ]
        assert bool(warned) == is_doubtful


def test_the_header_of_a_table_that_ends_below_the_loads_of_a_test():
    at = np.linspace(0.5, 1.5, 41)
    pieces = [
        CurvePiece(name, "cyclic", "mean", at, slope * at, 0 * at)
        for name, slope in (("T-1", 400), ("T-2", 1600))
    ]
    source = PieceSource("tether", "mean", tuple(pieces), sources=("a log",))
    curve = compose(source, CompositeRule())
    assert curve.tension[-1] < 0.75 * 2400
    (said,) = (
        note
        for note in line_from_composite(source, curve).notes
        if note.startswith("EA of the tests")
    )
    assert "T-2 cycles 1600 N (1600 to 1600)" in said and "nan" not in said


# uncertainty of an exported curve: both parts, and the errors it shares with other curves

STRAIN_OF_SPREAD = np.array([0.1, 0.2, 0.3])
UP_OF_SPREAD, DOWN_OF_SPREAD = 500 * STRAIN_OF_SPREAD, 480 * STRAIN_OF_SPREAD
CELL = Component("tension_gain", "cell")


@pytest.fixture
def archive(tmp_path):
    """Random 3 and 4 N; a cell of +6 and +8 N, a tape of +5 N one way and -5 N the other."""

    def write(*, is_old=False):
        random = np.stack([np.full((2, 1), [[3.0], [4.0]]) * np.ones((2, 3))])
        rows = np.array([[[6.0] * 3, [8.0] * 3], [[5.0] * 3, [-5.0] * 3]])[:, None]
        dims, of = ("specimen", "branch_name", "strain_bin"), "uncertainty_component"
        name = "branch_tension"
        data = {
            name: (dims, np.stack([np.stack([UP_OF_SPREAD, DOWN_OF_SPREAD])])),
            f"{name}_standard_uncertainty": (dims, np.sqrt(random**2 + np.sum(rows**2, axis=0))),
        }
        if not is_old:
            data |= {
                f"{name}_random_standard_uncertainty": (dims, random),
                f"{name}_uncertainty_contribution": ((of, *dims), rows),
                "uncertainty_source": (of, ["tension_gain", "strain_calibration"]),
                "uncertainty_source_of": (of, ["cell", "new"]),
                "uncertainty_source_number": (of, [0, 2]),
            }
        found = xr.Dataset(
            data,
            coords={
                "specimen": ["new"], "branch_name": ["ascending", "descending"],
                "strain_bin": STRAIN_OF_SPREAD,
            },
            attrs={"schema_version": SCHEMA_VERSION, "id": "c/T-1", "title": "Tests"},
        )  # fmt: skip
        path = tmp_path / "T-1.nc"
        found.to_netcdf(path, engine="netcdf4")
        return path

    return write


@pytest.mark.parametrize(
    ("curve", "both", "random", "shared"),
    [
        ("ascending", np.sqrt(9 + 36 + 25), 3.0, np.sqrt(36 + 25)),
        # the cell is in the mean in full, the tape cancels, the scatter is less by the root of 2
        ("mean", np.hypot(2.5, 7.0), 2.5, 7.0),
    ],
)
def test_every_table_of_a_test_has_the_uncertainty_of_its_curve(
    archive, tmp_path, curve, both, random, shared
):
    one = line_from_archive(archive(), curve=curve)
    wanted = {"standard": both, "random_standard": random, "shared_standard": shared}
    for form in ("csv", "json", "netcdf"):
        export_line(one, form, tmp_path / form)
    rows = csv_rows(tmp_path / "csv")
    document = json.loads((tmp_path / "json").read_text())
    with xr.open_dataset(tmp_path / "netcdf") as found:
        for part, value in wanted.items():
            name = f"tension_{part}_uncertainty"
            assert float(rows[1][f"{name} [N]"]) == pytest.approx(value, rel=1e-6)
            # the straight line from 0 0 was not measured
            assert rows[0][f"{name} [N]"] == ""
            assert document["values"][name][1:] == pytest.approx([value] * 3)
            np.testing.assert_allclose(found[name].values[1:], value)


def test_the_signed_errors_are_there_where_a_format_has_a_place_for_them(archive, tmp_path):
    one = line_from_archive(archive(), curve="descending")
    for form in ("json", "netcdf"):
        export_line(one, form, tmp_path / form, units="us")
    told = json.loads((tmp_path / "json").read_text())["tension_uncertainty_contributions"]
    assert told["unit"] == "lbf"
    cell, tape = told["sources"]
    assert (cell["source"], cell["of"]) == ("tension_gain", "cell")
    assert (tape["source"], tape["number"]) == ("strain_calibration", 2)
    assert cell["contribution"][1] == pytest.approx(8.0 / 4.4482216152605)
    with xr.open_dataset(tmp_path / "netcdf") as found:
        rows = found["tension_uncertainty_contribution"]
        assert rows.dims == ("uncertainty_component", "point") and rows.attrs["units"] == "N"
        np.testing.assert_array_equal(rows.values[:, 1:], [[8.0] * 3, [-5.0] * 3])
        assert found["uncertainty_source"].values.tolist() == ["tension_gain", "strain_calibration"]


def test_an_archive_that_keeps_no_parts_gives_the_whole_and_a_note(archive):
    one = line_from_archive(archive(is_old=True), curve="ascending")
    names = [column.name for column in curve_table(one).columns]
    assert names == ["strain", "tension", "tension_standard_uncertainty", "is_tested"]
    np.testing.assert_allclose(one.spread.standard, np.sqrt(70))
    assert "not stored separately" in one.notes[-1]


def test_a_composite_is_exported_with_what_its_table_has():
    at = np.linspace(0.1, 0.5, 5)
    piece = CurvePiece("T-1", "cyclic", "ascending", at, 100 * at, 0.5 * at, (CELL,), 2 * at[None])
    curve = _composite_curve([piece])
    source = PieceSource(
        "new", "ascending", (piece,), None, sources=("made",), piece_sources=("made",)
    )
    table, exported = (
        composite_table(source, curve),
        curve_table(line_from_composite(source, curve)),
    )
    for column in table.columns:
        if "uncertainty" in column.name:
            (same,) = [one for one in exported.columns if one.name == column.name]
            # where the composite moves a node by a rounding nothing else moves
            np.testing.assert_allclose(same.values, column.values, rtol=1e-6)
    assert exported.component == table.component == (CELL,)
    np.testing.assert_allclose(exported.contribution, table.contribution)


def test_a_predicted_hose_is_exported_with_the_uncertainty_of_its_tension(tmp_path):
    path = tmp_path / "predictions.nc"
    write_archive(dataset(predicted()), path)
    with xr.open_dataset(path) as found:
        name = str(found["hose"].values[0])
        spread = found["tension_standard_uncertainty"].values[0]
    one = line_from_archive(path, specimen=name)
    np.testing.assert_array_equal(one.spread.standard, spread[: one.strain.size])
    assert "uncertainty" in curve_table(one).columns[2].name


def test_a_curve_without_uncertainty_has_no_column_of_it():
    assert [column.name for column in curve_table(line()).columns] == [
        "strain", "tension", "is_tested",
    ]  # fmt: skip


def test_parts_of_other_points_are_refused():
    with pytest.raises(DataError, match="not of the same points"):
        CurveSpread(np.ones(3), np.ones(2))
    with pytest.raises(DataError, match="not of the same points"):
        CurveSpread(np.ones(3), component=(CELL,), contribution=np.ones((1, 2)))
