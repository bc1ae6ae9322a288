"""Pages of a composite curve and of an assembly: what stands on them, and what is drawn."""

import re

import numpy as np
import pytest
from assemblies import DRIVEN

from reduction.lines.assembly import DeployedLine, SeriesPart, WorkingLevel, deploy
from reduction.lines.composite import CompositeRule, CurvePiece, PieceSource, compose
from reduction.report.single_pages import (
    _draw_assembly,
    _draw_composite,
    _draw_stiffness,
    write_assembly_page,
    write_composite_page,
)
from reduction.stages.strain.strain_model import StrainModel


def piece(name, low, high, kind="cyclic"):
    at = np.linspace(low, high, 21)
    return CurvePiece(name, kind, "mean", at, 400 * at, np.full(21, 2.0))


SOURCE = PieceSource(
    "<b>tether</b>", "mean", (piece("T-1", 0.5, 1.0), piece("T-2", 1.2, 2.0),
    piece("S", 0.2, 0.9, "static")), sources=("archive <a>",),
    notes=("T-2: the splices slipped 2 times, and the strain includes the slip",), is_synthetic=True,
)  # fmt: skip
CURVE = compose(SOURCE, CompositeRule(precedence=("cyclic",)))


LEVELS = (WorkingLevel("strain", 0.8, 300.0), WorkingLevel("strain", 0.3))


def deployed(levels=LEVELS):
    found = deploy(
        CURVE, DRIVEN, n_tethers=3, parts=[SeriesPart("chain", 2.0)], levels=levels,
        tolerance=0.02, rated_break_strength=3200.0,
    )  # fmt: skip
    return DeployedLine(
        "mooring", found, SOURCE, CURVE, "length by tension-driven", (SeriesPart("chain", 2.0),)
    )


def finite(trace):
    return np.array([value for value in trace["y"] if value is not None])


def test_the_composite_is_drawn_over_the_pieces_that_it_is_made_of():
    figure = _draw_composite(SOURCE, CURVE, "si")
    by_name = {trace["name"]: trace for trace in figure.data}
    assert {"T-1, cyclic", "T-2, cyclic", "composite", "gap"} < by_name.keys()
    assert not any("static" in name for name in by_name)  # not named by the rule
    assert max(by_name["composite"]["x"]) == pytest.approx(200)
    assert finite(by_name["composite"]).max() == pytest.approx(800)
    # from zero to 50 %, and from 100 to 120 %
    shown = [x for x, y in zip(by_name["gap"]["x"], by_name["gap"]["y"], strict=True)
             if y is not None]  # fmt: skip
    assert shown == pytest.approx([0, 25, 50, 100, 110, 120])
    assert by_name["gap"]["line"]["dash"] == "dot"
    assert figure.layout["title"]["subtitle"]["text"] == "SYNTHETIC DATA"


def test_an_assembly_is_drawn_with_its_cycles_in_the_units_of_the_reader():
    figure = _draw_assembly(deployed(), "us")
    point = next(trace for trace in figure.data if trace["name"] == "working point 1")
    mean = 3 * 400 * 0.8
    assert point["y"] == pytest.approx(
        np.array([mean - 300, mean, mean + 300]) / 4.4482216, rel=1e-3
    )
    assert "length [ft]" in figure.layout["xaxis"]["title"]["text"]
    dotted = next(trace for trace in figure.data if trace["name"] == "not tested")
    tested = next(trace for trace in figure.data if trace["name"] == "assembly")
    # up to 50 % of strain, and between the windows
    assert 0 < finite(dotted).min() + 1 < 3 * 400 * 0.5
    assert finite(dotted).size + finite(tested).size == len(tested["y"])
    stiffness = _draw_stiffness(deployed(), "si")
    assert finite(stiffness.data[0]).min() > 0


def test_a_page_of_a_composite_stands_alone_and_escapes_names(tmp_path):
    path = tmp_path / "c.html"
    write_composite_page(SOURCE, CURVE, path)
    text = path.read_text(encoding="utf-8")
    assert "SYNTHETIC DATA" in text
    assert "<b>tether</b>" not in re.sub(r"<script.*?</script>", "", text, flags=re.S)
    assert "&lt;b&gt;tether&lt;/b&gt;" in text
    assert ">Warnings<" in text and "No two pieces of one kind overlap" in text
    assert "the splices slipped 2 times" in text
    assert "archive &lt;a&gt;" in text
    assert not re.search(r'<(?:script|link|img)[^>]+(?:src|href)="https?:', text)


def test_a_page_of_an_assembly_lists_its_working_points(tmp_path):
    path = tmp_path / "a.html"
    write_assembly_page(deployed(), path)
    text = path.read_text(encoding="utf-8")
    assert "3 x &lt;b&gt;tether&lt;/b&gt;, free length 2.55 m, in line with chain 2 m" in text
    assert "Working points." in text and "2, not tested" in text
    assert "length by tension-driven" in text
    write_assembly_page(deployed(levels=()), path, units="us")
    text = path.read_text(encoding="utf-8")
    assert "Working points." not in text and "US customary" in text


def test_a_point_has_the_stiffness_of_its_tests_and_the_nearest_of_them_by_name(tmp_path):
    # two springs without splices, the second one 80 % further out: the join is softer than both
    low, high = np.linspace(0.4, 1.5, 41), np.linspace(1.0, 1.6, 41)
    source = PieceSource(
        "tether", "mean", tuple(
            CurvePiece(name, "cyclic", "mean", at, load, 0 * at)
            for name, at, load in (("T-1", low, 400 * low), ("T-2", high, 800 * (high - 0.8)))
        ),
        is_synthetic=True,
    )  # fmt: skip
    curve = compose(source, CompositeRule())
    model = StrainModel("T", "gauge-length", {"reference_position": 2.0, "gauge_length": 2.0})
    levels = (WorkingLevel("tension", 400.0, 150.0), WorkingLevel("tension", 100.0))
    found = deploy(curve, model, n_tethers=1, levels=levels)
    made = DeployedLine("a", found, source, curve, "its own law", ())
    path = tmp_path / "a.html"
    write_assembly_page(made, path)
    text = path.read_text(encoding="utf-8")
    (body,) = re.findall(r"Working points\..*?<tbody>(.*?)</tbody>", text, re.S)
    rows = [re.findall(r"<t[dh][^>]*>(.*?)</t[dh]>", row, re.S) for row in body.split("</tr>")[:2]]
    (first, second) = ([re.sub(r"<[^>]+>", "", cell) for cell in row] for row in rows)
    assert first[0] == "1, doubtful" and second[0] == "2, not tested"
    assert 400 < float(first[5]) < 800
    assert [float(cell) for cell in first[6:8]] == pytest.approx([400, 800], rel=1e-3)
    assert first[8] == "T-1 cycles"
    assert second[5] == second[6] == second[7]  # nothing: no test is there
    assert "DOUBTFUL: working.1: over the loads of T-1 cycles and T-2 cycles" in text
    drawn = {trace["name"]: trace for trace in _draw_stiffness(made, "si").data}
    for name, slope in (("T-1 cycles", 400), ("T-2 cycles", 800)):
        assert finite(drawn[name]) == pytest.approx(np.full(finite(drawn[name]).size, slope))
    assert drawn["working point 1"]["x"] == [250.0, 550.0]
    assert finite(drawn["working point 1"]) == pytest.approx([float(first[5])] * 2, rel=1e-3)
    band = finite(drawn["working point 1, its tests"])
    assert (band.min(), band.max()) == pytest.approx((400, 800), rel=1e-3)


def test_a_curve_far_from_a_piece_is_doubtful_on_both_pages(tmp_path):
    at = np.linspace(0.5, 1.0, 11)
    source = PieceSource(
        "tether", "ascending", tuple(
            CurvePiece(f"T-{place}", "static", "ascending", at, load * at, 0 * at)
            for place, load in enumerate((*[100.0] * 5, 200.0))
        ),
    )  # fmt: skip
    curve = compose(source, CompositeRule())
    path = tmp_path / "c.html"
    write_composite_page(source, curve, path)
    assert "DOUBTFUL: the curve is up to 2.2" in path.read_text(encoding="utf-8")
    found = deploy(curve, DRIVEN, n_tethers=1)
    write_assembly_page(DeployedLine("a", found, source, curve, "its own law", ()), path)
    assert "DOUBTFUL: the curve is up to 2.2" in path.read_text(encoding="utf-8")
