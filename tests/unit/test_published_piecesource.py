"""Pieces of the published tethers against Table 6, typed a second time."""

import csv
from pathlib import Path

import numpy as np
import pytest

from reduction.lines.composite import CompositeRule, compose
from reduction.lines.published_source import published_piece_sources

TABLE = Path(__file__).parents[1] / "golden" / "whoi_2005_10_table_6.csv"
LBF = 4.4482216152605
# open in Table 6: Table 5 stands in
OPEN = {("T-1", "new")}


def rows():
    with TABLE.open(encoding="utf-8") as lines:
        return list(csv.DictReader(line for line in lines if line[0] != "#"))


@pytest.mark.parametrize("tether", ["new", "used"])
def test_loads_at_the_ends_of_the_segments_are_those_of_table_6(tether):
    pieces = {one.name: one for one in published_piece_sources()[f"rubber-tether-{tether}"].pieces}
    seen = 0
    for row in rows():
        if row["tether"] != tether or (row["test"], tether) in OPEN:
            continue
        one = pieces[row["test"]]
        for end in ("min", "max"):
            load = float(row[f"load_{end}"].rstrip("-"))  # a stray dash, WH5-10
            at = float(row[f"strain_{end}"])
            assert np.interp(at, one.strain, one.tension) / LBF == pytest.approx(load), row
            seen += 1
        assert one.random_standard_uncertainty / LBF == pytest.approx(
            np.full(one.strain.size, 0.288675), rel=1e-4
        )
    assert seen == {"new": 14, "used": 20}[tether]


@pytest.mark.parametrize(
    ("tether", "free", "ratio"), [("new", 8.38, 0.2386), ("used", 8.34, 0.2177)]
)
def test_splices_are_the_least_squares_of_table_3(tether, free, ratio):
    model = published_piece_sources()[f"rubber-tether-{tether}"].model
    assert model.coefficients["relaxed_free_length"] / 0.3048 == pytest.approx(free)
    assert model.coefficients["splice_strain_ratio"] == pytest.approx(ratio, abs=5e-5)


@pytest.mark.parametrize("tether", ["new", "used"])
def test_pieces_stand_in_the_order_of_the_tests_and_name_their_tables(tether):
    source = published_piece_sources()[f"rubber-tether-{tether}"]
    assert [one.name for one in source.pieces][:6] == [f"T-{number}" for number in range(1, 7)]
    assert all(one.kind == "cyclic" and one.branch == "ascending" for one in source.pieces)
    assert all("WHOI-2005-10, Table" in text for text in source.sources[:6])
    assert compose(source, CompositeRule()).strain[-1] == source.pieces[5].strain[-1]
