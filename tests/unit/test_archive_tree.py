"""A processed campaign opens as one tree, and what is no campaign is refused."""

import csv
import shutil
from importlib.util import find_spec
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray as xr

import reduction
from reduction.archive import open as opening
from reduction.archive.open import open_archive
from reduction.archive.product_files import OF_CAMPAIGN, STATUS_NAME, earlier_run_words
from reduction.record.errors import ArchiveError, SettingsError

needs_dask = pytest.mark.skipif(find_spec("dask") is None, reason="Dask is not installed")
DESCRIPTORS = Path("/proc/self/fd")


@pytest.fixture
def folder(archives, tmp_path):
    """Four tests of one campaign, and surfaces.nc."""
    for path in archives:
        shutil.copy(path, tmp_path)
    shutil.copy(archives[0], tmp_path / "surfaces.nc")
    rows = "".join(f"{path.stem},reduced\n" for path in archives)
    (tmp_path / "status.csv").write_text(f"test,status\n{rows}", encoding="utf-8")
    return tmp_path


def campaign_of(path, name):
    with netCDF4.Dataset(path, "a") as file:
        file.campaign = name


def open_files(folder):
    links = (one.resolve() for one in DESCRIPTORS.iterdir())
    return [one for one in links if one.parent == folder]


def test_a_folder_gives_one_node_a_test_and_one_a_product_of_the_campaign(folder, archives):
    with reduction.open_campaign(folder) as campaign:
        assert isinstance(campaign, xr.DataTree)
        assert set(campaign.children) == {path.stem for path in archives} | {"surfaces"}
        for path in archives:
            with open_archive(path) as archive:
                xr.testing.assert_identical(campaign[path.stem].to_dataset(), archive)


def test_an_archive_of_an_earlier_run_is_told(folder, archives):
    shutil.copy(archives[0], folder / "T-0.nc")
    with pytest.warns(UserWarning, match="T-0 has no row in status.csv"):
        reduction.open_campaign(folder).close()
    with pytest.warns(UserWarning, match="T-0 has no row in status.csv"):
        reduction.open_campaign(folder / "T-0.nc").close()


def test_a_table_of_status_with_every_cell_quoted_has_its_rows(folder, archives):
    rows = [["test", "status", "message"], *([path.stem, "reduced", ""] for path in archives)]
    with (folder / STATUS_NAME).open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, quoting=csv.QUOTE_ALL).writerows(rows)
    assert [earlier_run_words(path) for path in archives] == [()] * len(archives)


@pytest.mark.parametrize("name", OF_CAMPAIGN)
def test_each_product_of_a_campaign_has_its_node(name, archives, tmp_path):
    shutil.copy(archives[0], tmp_path / f"{name}.nc")
    with reduction.open_campaign(str(tmp_path)) as campaign:
        assert list(campaign.children) == [name]


def test_what_all_archives_say_alike_stands_on_the_root(folder):
    with reduction.open_campaign(folder) as campaign:
        every = [node.attrs for node in campaign.children.values()]
        assert campaign.attrs["campaign"] == campaign.name == every[0]["campaign"]
        assert campaign.attrs["Conventions"] == "CF-1.11 ACDD-1.3"
        assert all(one.items() >= campaign.attrs.items() for one in every)
        # one of them has no institution
        assert "institution" not in campaign.attrs
        assert not campaign.dims


def test_the_root_of_a_campaign_of_one_archive_is_not_that_test(rich_test, write):
    with reduction.open_campaign(write(rich_test).parent) as campaign:
        assert campaign["T-1"].attrs["test"] == "T-1"
        assert campaign.attrs["institution"] == campaign["T-1"].attrs["institution"]
        assert not {"test", "id", "raw_file_sha256", "settings", "history"} & set(campaign.attrs)


def test_a_file_gives_its_dataset(archives):
    with reduction.open_campaign(archives[-1]) as test, open_archive(archives[-1]) as archive:
        assert isinstance(test, xr.Dataset)
        xr.testing.assert_identical(test, archive)


def test_values_are_read_when_they_are_asked_for(folder):
    with reduction.open_campaign(folder) as campaign:
        tension = campaign["T-1/tension"]
        assert "values with dtype" in repr(tension)
        assert np.isfinite(tension[1, 3:5].values).all()
        # a piece was read, not the whole
        assert "values with dtype" in repr(tension)


@pytest.mark.skipif(not DESCRIPTORS.is_dir(), reason="no list of open files")
def test_files_are_closed_with_the_tree_and_after_an_error(folder):
    with reduction.open_campaign(folder) as campaign:
        assert len(open_files(folder)) == len(campaign.children)
    assert open_files(folder) == []
    campaign_of(folder / "surfaces.nc", "other")
    with pytest.raises(ArchiveError):
        reduction.open_campaign(folder)
    assert open_files(folder) == []


def test_a_missing_path_is_named(tmp_path):
    with pytest.raises(
        ArchiveError, match=r"there is no processed campaign .*/none; needed the folder of a camp"
    ):
        reduction.open_campaign(tmp_path / "none")


def test_a_folder_without_archives_is_refused(tmp_path):
    with pytest.raises(
        ArchiveError,
        match=r"no archive in .*; found no .nc file; needed .*<test>.nc. Run the campaign first",
    ):
        reduction.open_campaign(tmp_path)


def test_the_folder_above_names_its_campaigns(archives, tmp_path):
    for name in ("nylon", "hose"):
        (tmp_path / name).mkdir()
        shutil.copy(archives[0], tmp_path / name)
    with pytest.raises(ArchiveError, match=r"found folders of campaigns: hose, nylon; .*Open one"):
        reduction.open_campaign(tmp_path)


def test_a_file_in_the_folder_that_is_no_archive_is_named(folder):
    (folder / "notes.nc").write_text("not netCDF", encoding="utf-8")
    with pytest.raises(
        ArchiveError, match=r"notes.nc cannot be read as a netCDF file; found .*; needed"
    ):
        reduction.open_campaign(folder)


def test_archives_of_two_campaigns_make_no_tree(folder):
    campaign_of(folder / "surfaces.nc", "other")
    with pytest.raises(
        ArchiveError,
        match=r"of more than one campaign; found .*surfaces of other; needed one campaign a folder",
    ):
        reduction.open_campaign(folder)


def test_chunks_without_dask_are_refused_with_the_way_out(archives, monkeypatch):
    monkeypatch.setattr(opening, "find_spec", lambda name: None)
    with pytest.raises(
        SettingsError, match=r"chunks need Dask; found no package .*cluster.*leave chunks out"
    ):
        reduction.open_campaign(archives[-1], chunks={})


@needs_dask
def test_chunks_are_those_of_dask(folder):
    with reduction.open_campaign(folder, chunks={"sample": 7}) as campaign:
        tension = campaign["T-1/tension"]
        assert set(tension.chunksizes["sample"][:-1]) == {7}
        with open_archive(folder / "T-1.nc") as archive:
            assert float(tension.sum()) == pytest.approx(float(archive["tension"].sum()))


@needs_dask
def test_a_dimension_that_no_archive_has_is_refused(folder):
    with pytest.raises(
        SettingsError, match=r"a dimension that no archive has; found samples; needed .*sample"
    ):
        reduction.open_campaign(folder, chunks={"samples": 7})
    with pytest.raises(SettingsError, match=r"found samples"):
        reduction.open_campaign(folder / "T-1.nc", chunks={"samples": 7})


@needs_dask
@pytest.mark.parametrize("chunks", [{"sample": -7}, {"sample": "x"}, -3])
def test_chunks_that_cannot_be_are_refused(archives, chunks):
    with pytest.raises(
        SettingsError, match=r"cannot be cut in these chunks; found .*; needed a number of values"
    ):
        reduction.open_campaign(archives[-1], chunks=chunks)


def test_the_package_has_no_other_late_names():
    with pytest.raises(AttributeError, match=r"module 'reduction' has no attribute 'open_camp'"):
        _ = reduction.open_camp
