"""Tables of predicted hoses: from their archive alone, every number with its unit and its u."""

import numpy as np
import pytest
from csvrows import csv_rows, hold_columns_explained
from predicted_hoses import LAYERS, UNCERTAIN, dataset, pick_up_strain, predicted, working_tension

from reduction.archive.csv_definitions import PREDICTION_TABLES
from reduction.archive.csv_tables import write_tables
from reduction.archive.write import write_archive


@pytest.fixture
def tables(tmp_path):
    def written(*hoses, synthetic="yes"):
        write_archive(dataset(*hoses, synthetic=synthetic), tmp_path / "predictions.nc")
        paths = write_tables((), tmp_path / "tables", predictions=tmp_path / "predictions.nc")
        return {path.stem: csv_rows(path) for path in paths}

    return written


@pytest.fixture
def both(tables):
    """A hose with all there is, and one without uncertainty and layers."""
    return tables(predicted(), predicted("stiff", 50.0, uncertain={}, layers=()))


def test_hoses_fill_every_table_of_theirs(both):
    assert [*both] == [*(table.name for table in PREDICTION_TABLES), "columns"]


def test_every_strain_of_every_hose_is_a_row(both):
    hoses = [predicted(), predicted("stiff", 50.0)]
    assert len(both["predictions"]) == sum(hose.prediction.strain.size for hose in hoses)
    rows = [row for row in both["predictions"] if row["hose"] == "stiff"]
    assert [float(row["strain [1]"]) for row in rows] == hoses[1].prediction.strain.tolist()
    assert [float(row["tension [N]"]) for row in rows] == hoses[1].prediction.tension.tolist()
    assert {row["hose_state"] for row in both["predictions"]} == {"", "slack"}


def test_uncertainties_stand_behind_their_numbers_where_they_are_known(both):
    header = list(both["predictions"][0])
    place = header.index("tension [N]")
    assert header[place + 1] == "tension_standard_uncertainty [N]"
    known = [row["tension_standard_uncertainty [N]"] != "" for row in both["predictions"]]
    assert known == [row["hose"] == "gumby" for row in both["predictions"]]
    hose = next(row for row in both["hoses"] if row["hose"] == "gumby")
    assert float(hose["wrap_angle_standard_uncertainty [rad]"]) == UNCERTAIN["wrap_angle"]
    assert hose["inner_diameter_standard_uncertainty [m]"] == ""


def test_events_have_the_numbers_of_the_closed_forms(both):
    events = {row["hose_event"]: row for row in both["hose_events"] if row["hose"] == "gumby"}
    assert [*events] == ["deepest_slack", "pick_up", "working", "cord_break"]
    assert float(events["pick_up"]["event_strain [1]"]) == pytest.approx(pick_up_strain(68))
    assert float(events["working"]["event_tension [N]"]) == pytest.approx(working_tension(68))
    # the cords are shortest at a stretch of (tan^2 / 2)^(1/3), half a degree is not known
    angle, spread = np.radians(68), np.radians(0.5)
    of_angle = (np.tan(angle) ** 2 / 2) ** (1 / 3) * 2 / 3 / (np.sin(angle) * np.cos(angle))
    found = float(events["deepest_slack"]["event_strain_standard_uncertainty [1]"])
    assert found == pytest.approx(of_angle * spread, rel=1e-6)


def test_cord_layers_and_idle_layers_are_rows_of_their_own(both):
    inner, outer, *_ = both["cord_layers"]
    assert (inner["cord_layer"], outer["cord_layer"]) == ("inner", "outer")
    width = np.pi * 3.4 * 0.0254 * np.cos(np.radians(68))
    assert float(inner["ribbon_width [m]"]) == pytest.approx(width)
    layers = both["hose_layers"]
    assert [(row["hose"], row["hose_layer_name"]) for row in layers] == [
        ("gumby", layer.name) for layer in LAYERS
    ]
    assert layers[1]["hose_layer_compression_limit [1]"] == ""


def test_a_table_that_hoses_do_not_give_is_not_there(tables):
    found = tables(predicted(uncertain={}, layers=()))
    assert "hose_layers" not in found


def test_every_table_says_whether_the_data_are_synthetic(tables):
    for name, rows in tables(predicted()).items():
        assert name == "columns" or {row["synthetic"] for row in rows} == {"yes"}
    assert {row["synthetic"] for row in tables(predicted(), synthetic="")["hoses"]} == {"no"}


def test_every_column_is_explained(both):
    for table, rows in both.items():
        hold_columns_explained(f"{table}.csv", list(rows[0]), both["columns"])


def test_the_same_hoses_give_the_same_bytes(tables, tmp_path):
    def contents():
        tables(predicted())
        return {path.name: path.read_bytes() for path in (tmp_path / "tables").iterdir()}

    assert contents() == contents()
