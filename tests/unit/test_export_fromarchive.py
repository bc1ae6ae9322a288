import numpy as np
import pytest
import xarray as xr
from predicted_hoses import dataset, predicted

from reduction.archive.dataset_builder import SCHEMA_VERSION
from reduction.archive.write import write_archive
from reduction.lines.archive_pieces import Turns
from reduction.lines.export_sources import _to_turns, line_from_archive
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
