"""A row of an archive is cut to its own length, whatever kind of value marks its end."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest
import xarray as xr

from reduction.archive.variables import read_notes
from reduction.report.test_view import RowView

DATA = xr.Dataset(
    {
        "name": ("row", ["short", "long"]),
        "value": (("row", "point"), [[1.0, np.nan, np.nan], [1.0, 2.0, 3.0]]),
        "label": (("row", "part"), [["0", ""], ["a", "b"]]),
        "share": (("row", "part"), [[0.5, np.nan], [0.25, 0.75]]),
        "count": (("row", "cycle"), [[3, 0], [3, 4]]),
        "mean": ("row", [7.0, 8.0]),
        "note": ("said", ["first", "second"]),
        "note_row": ("said", ["long", "short"]),
        "note_stage": ("said", ["", ""]),
        "note_code": ("said", ["one", "two"]),
        "note_severity": ("said", ["warning", "note"]),
        "note_effect": ("said", [np.nan, np.nan]),
    },
    attrs={"synthetic": "Yes"},
)


@dataclass(frozen=True)
class Row(RowView):
    """A row of the data above."""

    ENDS_AT: ClassVar[Mapping[str, str]] = {
        "point": "value", "part": "label", "cycle": "count", "gone": "absent",
    }  # fmt: skip


@pytest.mark.parametrize("text_type", ["U5", object])
@pytest.mark.parametrize(
    ("index", "sizes"),
    [(0, {"point": 1, "part": 1, "cycle": 1}), (1, {"point": 3, "part": 2, "cycle": 2})],
)
def test_a_row_ends_at_its_last_number_label_or_count(index, sizes, text_type):
    data = DATA.assign(label=DATA["label"].astype(text_type))
    row = Row("row", data, index)
    assert row.sizes == sizes
    assert row.array("share").tolist() == [[0.5], [0.25, 0.75]][index]


def test_what_an_archive_lacks_is_empty():
    row = Row("row", DATA, 0)
    assert row.array("absent").shape == (0,)
    assert np.isnan(row.scalar("absent")) and np.isnan(row.scalar("share"))
    assert np.isnan(row.array_like("share", np.zeros(2))).all()
    assert row.text("absent") == row.attribute("absent") == ""
    assert read_notes(DATA, of=("note_row", "neither")) == ()
    assert read_notes(DATA.drop_vars("note")) == ()


def test_a_row_has_its_own_values_notes_and_says_that_it_is_synthetic():
    row = Row("row", DATA, 1)
    assert (row.text("name"), row.scalar("mean"), row.is_synthetic) == ("long", 8.0, True)
    (first,) = read_notes(DATA, of=("note_row", row.text("name")))
    assert (str(first), first.severity, first.code) == ("first", "warning", "one")
