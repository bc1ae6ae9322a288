"""Global attributes say what the file is and where it came from."""

import math
from dataclasses import replace

import netCDF4
import numpy as np
import pytest
import xarray as xr
from long_records import long_test

from reduction.archive import write as netcdf
from reduction.archive.dataset_builder import build_dataset, global_attributes
from reduction.archive.open import open_archive
from reduction.archive.test_dataset import to_dataset
from reduction.archive.write import _write_netcdf
from reduction.quantities.names import TEST_SCHEMA
from reduction.record.errors import ArchiveError
from reduction.record.measurement import Source
from reduction.record.notes import note
from reduction.record.samples import ColumnWriter, _is_on_disk, empty_like


def attributes(test, **given):
    about = test.description
    about = replace(about, attributes={**about.attributes, **given})
    return global_attributes(
        replace(test, description=about), version="1.2.3", command="reduction run"
    )


def test_provenance_is_complete(rich_test):
    found = attributes(rich_test)
    assert found["Conventions"] == "CF-1.11 ACDD-1.3"
    assert found["raw_file"] == "T-1.csv\nT-1b.csv"
    assert found["raw_file_sha256"] == "\n".join(["ab" * 32, "cd" * 32])
    assert found["raw_file_bytes"] == "12345\n99"
    assert found["raw_metadata"] == '{"operator": "größe"}'
    assert found["settings"] == rich_test.settings_json
    assert found["command"] == "reduction run"
    assert found["software_version"] == "1.2.3"
    assert found["history"].splitlines() == [
        "reduction 1.2.3 ingest: read 61 rows",
        "reduction 1.2.3 cycles: 4 cycles, band 0.02 m",
    ]
    assert found["machine"] == "tether machine"
    assert found["id"] == "tmt/T-1"


def test_how_uncertainty_was_propagated_is_said(rich_test, bare_test):
    plain = "first order (JCGM 100:2008)"
    assert attributes(bare_test)["uncertainty_propagation"] == plain
    assert attributes(rich_test)["uncertainty_propagation"] == (
        f"{plain}; K_1, tau and K_1 tau as test_line_uncertainty_method says (JCGM 101:2008)"
    )


def test_the_root_says_why_a_test_is_to_be_checked(rich_test, bare_test):
    """A reader of `ncdump -h` sees no data, and so no note of the group notes."""
    assert attributes(bare_test)["test_status"] == "reduced"
    notes = (note("no-snap-loads", n_taut=1, n_cycles=2, slack_tension=3.0),
             note("slack-in-cycles", "new", n_slack=1, n_cycles=2, slack_tension=3.0))  # fmt: skip
    found = attributes(replace(bare_test, notes=notes))["test_status"]
    assert found.startswith("check: new: the specimen goes slack in 1 of 2 cycles")


def test_no_attribute_is_a_list_or_empty(any_test):
    found = attributes(any_test)
    assert all(isinstance(text, str) and text for text in found.values())


def test_one_file_reads_the_same_as_several(rich_test):
    one = replace(rich_test, sources=(Source("T-1.csv", "ab" * 32, 7),))
    assert attributes(one)["raw_file_bytes"] == "7"


def test_synthetic_data_are_called_so_in_title_and_source(rich_test, bare_test):
    found = attributes(rich_test)
    assert found["title"] == "Cycle tests of a new and a used tether (synthetic data)"
    assert found["source"] == "synthetic; from a known law"
    assert found["synthetic"] == "yes"
    assert "synthetic" not in attributes(bare_test)["title"]


def test_synthetic_is_not_said_twice(rich_test):
    found = attributes(rich_test, title="Synthetic tests", source="synthetic, from a law")
    assert found["title"] == "Synthetic tests"
    assert found["source"] == "synthetic, from a law"
    assert attributes(rich_test, source="")["source"] == "synthetic"


def test_a_summary_is_written_where_none_is_given(rich_test):
    assert attributes(rich_test)["summary"] == "Reduced cyclic test T-1 of specimen new and used."
    assert attributes(rich_test, summary="Mine.")["summary"] == "Mine."


def test_a_name_of_the_archive_s_own_is_refused(rich_test):
    with pytest.raises(ArchiveError, match=r"keeps for itself; found history, settings\."):
        attributes(rich_test, history="x", settings="y")


def test_a_name_that_cf_does_not_allow_is_refused(rich_test):
    with pytest.raises(ArchiveError, match=r"CF does not allow; found load cell; needed letters"):
        attributes(rich_test, **{"load cell": "x"})


# long variables are stored in chunks of which a reader may take one, and no more of them than
# that needs

# 65,536 doubles are half a megabyte: a few milliseconds to read, and 1,526 chunks in 1e8 samples
LARGEST = 65536


@pytest.mark.parametrize(
    ("name", "shape", "chunk"),
    [
        ("crosshead_position", (200_000,), (LARGEST,)),
        ("tension", (2, 200_000), (1, LARGEST)),
        ("tension", (2, 30_000), (2, 30_000)),
        ("hysteresis_energy", (2, 100_000), (1, LARGEST)),
        ("crosshead_rate", (100_000, 2), (LARGEST // 2, 2)),
        ("chord_modulus", (2, 40_000, 2), (1, LARGEST // 2, 2)),
        ("tangent_modulus_by_cycle", (2, 24, 2, 60), (2, 24, 2, 60)),
    ],
)
def test_a_chunk_holds_the_last_dimensions_up_to_half_a_megabyte(name, shape, chunk, tmp_path):
    values = {name: np.zeros(shape)}
    build_dataset(values, TEST_SCHEMA, attributes={}).to_netcdf(
        tmp_path / "long.nc", engine="netcdf4"
    )
    with netCDF4.Dataset(tmp_path / "long.nc") as file:
        stored = file[name]
        sizes = stored.chunking()
        filters = stored.filters()
    # the library keeps a chunk within the variable
    assert tuple(sizes) == tuple(min(one, length) for one, length in zip(chunk, shape, strict=True))
    assert filters["zlib"]
    assert filters["shuffle"]
    assert math.prod(sizes) <= LARGEST


def test_a_short_variable_is_not_cut(tmp_path):
    values = {"crosshead_position": np.zeros(4095)}
    build_dataset(values, TEST_SCHEMA, attributes={}).to_netcdf(
        tmp_path / "short.nc", engine="netcdf4"
    )
    with netCDF4.Dataset(tmp_path / "short.nc") as file:
        assert file["crosshead_position"].chunking() == "contiguous"


@pytest.mark.parametrize("is_quantised", [True, False])
def test_a_quantised_channel_is_stored_without_the_filter_that_would_make_it_larger(
    is_quantised, tmp_path
):
    rng = np.random.default_rng(12)
    tension = 400 + 100 * np.sin(np.arange(150_000) / 60) + rng.normal(0, 1, 150_000)
    if is_quantised:
        tension = np.round(tension / 1.085) * 1.085
    dataset = build_dataset({"tension": np.stack([tension, tension])}, TEST_SCHEMA, attributes={})
    sizes = {}
    for shuffle in (True, False):
        dataset["tension"].encoding["shuffle"] = shuffle
        _write_netcdf(dataset, tmp_path / "tried.nc")
        sizes[shuffle] = (tmp_path / "tried.nc").stat().st_size
    found = build_dataset({"tension": np.stack([tension, tension])}, TEST_SCHEMA, attributes={})
    assert found["tension"].encoding["shuffle"] is (sizes[True] < sizes[False])
    assert found["tension"].encoding["shuffle"] is not is_quantised


# the file is the one that xarray would write, to a reader; long series go in by blocks


def opened(path):
    return xr.open_dataset(path, engine="netcdf4", decode_times=False, decode_timedelta=False)


def test_xarray_reads_the_same_as_from_a_file_of_its_own(any_test, tmp_path):
    dataset = to_dataset(any_test, version="1.2.3", command="reduction run")
    _write_netcdf(dataset, tmp_path / "ours.nc")
    for variable in dataset.variables.values():
        variable.encoding["fletcher32"] = "chunksizes" in variable.encoding
    dataset.to_netcdf(tmp_path / "theirs.nc", format="NETCDF4", engine="netcdf4")
    with open_archive(tmp_path / "ours.nc") as ours, opened(tmp_path / "theirs.nc") as theirs:
        assert len(ours.attrs.pop("values_sha256")) == 64
        xr.testing.assert_identical(ours.load(), theirs.load())
        for name, variable in ours.variables.items():
            for key in (
                "dtype", "_FillValue", "zlib", "shuffle", "fletcher32", "chunksizes", "coordinates",
            ):  # fmt: skip
                assert str(variable.encoding.get(key)) == str(
                    theirs.variables[name].encoding.get(key)
                ), (name, key)


@pytest.mark.parametrize("on_disk", [False, True])
def test_a_series_in_blocks_and_from_disk_is_the_same_bytes(on_disk, tmp_path, monkeypatch):
    dataset = to_dataset(long_test(300), version="1.2.3", command="reduction run")
    _write_netcdf(dataset, tmp_path / "whole.nc")
    if on_disk:
        column = ColumnWriter(tmp_path)
        column.append(np.zeros(1 << 18))
        beside = column.finish()
        for name in ("time", "tension"):
            values = dataset[name].values
            scratch = empty_like(beside, shape=(1 << 18,))[: values.size].reshape(values.shape)
            scratch[...] = values
            assert _is_on_disk(scratch)
            dataset[name].variable.data = scratch
    monkeypatch.setattr(netcdf, "_BLOCK", 1000)
    _write_netcdf(dataset, tmp_path / "blocks.nc")
    with (
        open_archive(tmp_path / "whole.nc") as whole,
        open_archive(tmp_path / "blocks.nc") as blocks,
    ):
        xr.testing.assert_identical(whole.load(), blocks.load())


def test_texts_beyond_ascii_and_empty_ones_come_back(tmp_path):
    labels = xr.Variable(("label",), np.array(["größe", "", "m²"]))
    empty = xr.Variable(("label",), np.array(["", "", ""]))
    _write_netcdf(xr.Dataset({"word": labels, "nothing": empty}), tmp_path / "texts.nc")
    with opened(tmp_path / "texts.nc") as found:
        assert found["word"].values.astype(str).tolist() == ["größe", "", "m²"]
        assert found["nothing"].values.astype(str).tolist() == ["", "", ""]
