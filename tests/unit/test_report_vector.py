"""Figures as SVG: places of the points, ticks, names as text."""

import re
from xml.etree import ElementTree

import numpy as np
import pytest

from reduction.report.figure_data import axis, band, line, make_figure, named_axis
from reduction.report.svg_figure import _axis_of, _round_ticks, can_be_drawn, vector_of

SVG = "{http://www.w3.org/2000/svg}"


def figure(*traces, **layout):
    given = {"xaxis": axis("strain [%]"), "yaxis": axis("stress [MPa]")} | layout
    return make_figure("f", "A title", "A caption.", list(traces), synthetic=False, **given)


def tree(drawn):
    return ElementTree.fromstring(drawn)  # noqa: S314  # drawn here


def texts(drawn):
    return ["".join(one.itertext()) for one in tree(drawn).iter(f"{SVG}text")]


def straight(name="line", **more):
    return line(
        np.array([0.0, 50.0, 100.0]), np.array([0.0, 1.0, 2.0]), name=name, colour="#0072B2", **more
    )


def points(drawn):
    path = next(
        one.get("d")
        for one in tree(drawn).iter(f"{SVG}path")
        if one.get("fill") == "none" and one.get("stroke")
    )
    return [[float(one) for one in pair.split()] for pair in re.split("[ML]", path)[1:]]


def test_a_point_stands_where_the_ticks_beside_it_say():
    drawn = vector_of(
        figure(straight(), xaxis=axis("x", range=[0, 100]), yaxis=axis("y", range=[0, 2])),
        width=465.6, height=278.0,
    )  # fmt: skip
    # 53.6 and 12 beside the axes, 34 above and 44 below: 400 by 200
    assert points(drawn) == [[53.6, 234.0], [253.6, 134.0], [453.6, 34.0]]


def test_ticks_are_round_numbers_inside_the_axis():
    assert _round_ticks(0.0, 2.0, 6) == [0.0, 0.5, 1.0, 1.5, 2.0]
    assert _round_ticks(-1.2e6, 3.1e6, 5) == [-1e6, 0.0, 1e6, 2e6, 3e6]
    assert _round_ticks(0.0011, 0.0032, 5) == [0.0015, 0.002, 0.0025, 0.003]


@pytest.mark.parametrize(
    ("values", "layout", "ends"),
    [
        ([1.0, 2.0], {"rangemode": "tozero"}, (0.0, 2.04)),
        ([1.0, 2.0], {}, (0.96, 2.04)),
        ([3.0, None], {}, (1.5, 4.5)),
        ([], {}, (-0.04, 1.04)),
        ([1.0, 2.0], {"range": [5, 9]}, (5.0, 9.0)),
    ],
)
def test_the_ends_of_an_axis(values, layout, ends):
    found = _axis_of(layout, values, first=0, last=1, most=5)
    assert (found.low, found.high) == pytest.approx(ends)


def test_names_are_text_and_never_markup():
    hostile = "</text><script>alert(1)</script>"
    drawn = vector_of(figure(straight(hostile), straight("other")))
    assert "<script" not in drawn
    assert any("</text><script>" in text for text in texts(drawn))


def test_a_line_is_broken_where_a_value_is_missing():
    gap = line(np.arange(4.0), np.array([0.0, np.nan, 1.0, 2.0]), name="gap", colour="#000000")
    path = re.search(r'fill="none" stroke="#000000".* d="([^"]*)"', vector_of(figure(gap)))
    assert path[1].count("M") == 2


def test_what_a_click_would_show_is_left_out():
    assert "hidden" not in vector_of(figure(straight(), straight("hidden", visible="legendonly")))


def test_synthetic_data_say_so_in_the_drawing():
    one = make_figure("f", "T", "C", [straight()], synthetic=True, xaxis=axis("x"), yaxis=axis("y"))
    assert "SYNTHETIC DATA" in texts(vector_of(one))
    assert "SYNTHETIC DATA" not in texts(vector_of(figure(straight())))


def test_axes_of_names_have_the_names():
    drawn = vector_of(figure(straight(), xaxis=named_axis("run", ["<i>", "b\nc"])))
    assert {"<i>", "b", "c", "run"} <= set(texts(drawn))


def test_a_band_is_filled_and_closed():
    x = np.array([0.0, 1.0, 2.0])
    drawn = vector_of(figure(band(x, x, x + 1, name="b", colour="#0072B2", alpha=0.2)))
    assert re.search(r'fill="rgba\(0,114,178,0.2\)" stroke="none" d="M[^"]*Z"', drawn)


def test_a_logarithmic_axis_goes_by_powers_of_ten_and_leaves_out_zero():
    curve = line(np.array([0.0, 1.0, 10.0, 100.0]), np.arange(4.0), name="c", colour="#000000")
    drawn = vector_of(
        figure(curve, xaxis=axis("t", type="log", range=[0, 2]), yaxis=axis("y", range=[0, 3])),
        width=465.6, height=344.0,
    )  # fmt: skip
    assert [x for x, _ in points(drawn)] == [53.6, 253.6, 453.6]
    assert {"1", "10", "100"} <= set(texts(drawn))


def test_the_axis_has_room_for_its_longest_number():
    wide = figure(straight(), yaxis=axis("y", range=[0, 2e6]))
    assert points(vector_of(wide))[0][0] > points(vector_of(figure(straight())))[0][0] + 25


def test_two_panels_stand_one_above_the_other_over_one_axis():
    drawn = vector_of(
        figure(
            straight("low"), straight("high", yaxis="y2"), xaxis=axis("x", range=[0, 100]),
            yaxis=axis("below", range=[0, 2], domain=[0.0, 0.4]),
            yaxis2=axis("above", range=[0, 2], domain=[0.5, 1.0]),
        ),
        width=465.6, height=278.0,
    )  # fmt: skip
    paths = [
        one.get("d")
        for one in tree(drawn).iter(f"{SVG}path")
        if one.get("fill") == "none" and one.get("stroke-width") == "1.8"
    ]
    # 200 high: the lower takes 80 of it, the upper 100
    assert paths[:2] == [
        "M53.60 234.00L253.60 194.00L453.60 154.00",
        "M53.60 134.00L253.60 84.00L453.60 34.00",
    ]
    assert {"below", "above", "x"} <= set(texts(drawn))
    assert texts(drawn).count("60") == 1


def test_only_lines_and_markers_on_one_pair_of_axes_can_be_drawn():
    assert can_be_drawn(figure(straight()))
    assert can_be_drawn(figure(straight(), yaxis=axis("y", type="log")))
    assert not can_be_drawn(figure(straight(), yaxis=axis("y", type="category")))
    assert not can_be_drawn(figure(straight(), yaxis2=axis("y")))
    halves = {"yaxis": axis("y", domain=[0, 0.5]), "yaxis2": axis("y", domain=[0.5, 1])}
    assert can_be_drawn(figure(straight(), **halves))
    assert not can_be_drawn(figure(straight(), **halves, xaxis2=axis("x")))
    assert not can_be_drawn(figure(straight() | {"type": "bar"}))
    assert not can_be_drawn(figure())
