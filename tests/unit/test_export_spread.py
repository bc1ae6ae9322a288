"""Uncertainty of an exported curve: both parts, and the errors it shares with other curves."""

import csv
import json

import numpy as np
import pytest
import xarray as xr
from export_lines import line
from predicted_hoses import dataset, predicted

from reduction.archive.dataset_builder import SCHEMA_VERSION
from reduction.archive.write import write_archive
from reduction.lines.composite import CurvePiece, PieceSource, _composite_curve
from reduction.lines.deck_formats import export_line
from reduction.lines.export_line import CurveSpread
from reduction.lines.export_sources import composite_table, line_from_archive, line_from_composite
from reduction.lines.export_tables import curve_table
from reduction.record.contributions import Component
from reduction.record.errors import DataError

STRAIN = np.array([0.1, 0.2, 0.3])
UP, DOWN = 500 * STRAIN, 480 * STRAIN
CELL, TAPE = Component("tension_gain", "cell"), Component("strain_calibration", "new", 2)


@pytest.fixture
def archive(tmp_path):
    """Random 3 and 4 N; a cell of +6 and +8 N, a tape of +5 N one way and -5 N the other."""

    def write(*, is_old=False):
        random = np.stack([np.full((2, 1), [[3.0], [4.0]]) * np.ones((2, 3))])
        rows = np.array([[[6.0] * 3, [8.0] * 3], [[5.0] * 3, [-5.0] * 3]])[:, None]
        dims, of = ("specimen", "branch_name", "strain_bin"), "uncertainty_component"
        name = "branch_tension"
        data = {
            name: (dims, np.stack([np.stack([UP, DOWN])])),
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
                "strain_bin": STRAIN,
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
    with (tmp_path / "csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
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
