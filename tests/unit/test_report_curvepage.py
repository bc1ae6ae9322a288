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


def piece(name, low, high, kind="cyclic"):
    at = np.linspace(low, high, 21)
    return CurvePiece(name, kind, "mean", at, 400 * at, np.full(21, 2.0))


SOURCE = PieceSource(
    "<b>tether</b>", "mean", (piece("T-1", 0.5, 1.0), piece("T-2", 1.2, 2.0),
    piece("S", 0.2, 0.9, "static")), sources=("archive <a>",),
    notes=("T-2: a splice slipped 2 times, and its strains hold the slip",), is_synthetic=True,
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
    assert "Warnings (2)" in text and "No two pieces of one kind overlap" in text
    assert "a splice slipped 2 times" in text
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


def test_a_point_without_a_cycle_has_the_slope_of_the_curve_around_it_and_the_local_one(tmp_path):
    # the pieces fall at a strain of 1: the curve rises there by the rule, as softly as it may
    at = np.linspace(0.5, 2.0, 61)
    falling = 400 * at - 150 * np.exp(-(((at - 1.1) / 0.08) ** 2))
    source = PieceSource(
        "tether", "mean", (CurvePiece("T-1", "cyclic", "mean", at, falling, np.full(61, 2.0)),),
        is_synthetic=True,
    )  # fmt: skip
    curve = compose(source, CompositeRule())
    found = deploy(
        curve, DRIVEN, n_tethers=1,
        levels=(WorkingLevel("strain", 1.05), WorkingLevel("strain", 1.05, 50.0)),
    )  # fmt: skip
    still, cycled = found.working
    assert still.is_moved
    path = tmp_path / "a.html"
    write_assembly_page(DeployedLine("a", found, source, curve, "its own law", ()), path)
    text = path.read_text(encoding="utf-8")
    (body,) = re.findall(r"Working points\..*?<tbody>(.*?)</tbody>", text, re.S)
    rows = [re.findall(r"<t[dh][^>]*>(.*?)</t[dh]>", row, re.S) for row in body.split("</tr>")[:2]]
    (first, second) = ([re.sub(r"<[^>]+>", "", cell) for cell in row] for row in rows)
    assert first[0] == "1, local EA by the rule" and second[0] == "2"
    length, tension = found.assembly.total_length, found.assembly.tension
    at_ends = np.interp(still.point.total_length * np.array([0.95, 1.05]), length, tension)
    step = 0.1 * float(still.point.total_length) / length[0]
    assert float(first[5]) == pytest.approx(np.ptp(at_ends) / step, rel=2e-3)
    assert float(first[6]) == pytest.approx(float(still.point.apparent_spring_constant), rel=1e-3)
    assert float(second[5]) == pytest.approx(cycled.secant_spring_constant, rel=1e-3)
    assert second[6] == first[8]  # nothing: a cycle has one EA, and there is no tolerance
    assert "the tangent stands beside it" in text


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
    assert "DOUBTFUL: up to 2.2" in path.read_text(encoding="utf-8")
    found = deploy(curve, DRIVEN, n_tethers=1)
    write_assembly_page(DeployedLine("a", found, source, curve, "its own law", ()), path)
    assert "DOUBTFUL: up to 2.2" in path.read_text(encoding="utf-8")
