"""Figures as plain dictionaries, safe inside a page."""

import json
import re
from importlib.resources import files
from itertools import combinations
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from reduction.report.figure_data import (
    axis,
    band,
    keep_extremes,
    least_and_greatest,
    line,
    make_figure,
    named_axis,
    plain_numbers,
    script_json,
)
from reduction.report.svg_figure import _axis_of, _round_ticks, can_be_drawn, vector_of
from reduction.report.text_style import COLOURS, DASHES, SYMBOLS, marker, plot_text, shorten, shown


@given(st.text())
def test_text_in_a_script_element_is_the_same_text_again(text):
    document = script_json({"name": text})
    assert json.loads(document) == {"name": text}
    assert not set("<>&\u2028\u2029") & set(document)


@given(st.text())
def test_text_in_a_figure_has_no_markup_and_is_short(text):
    drawn = plot_text(text)
    assert "<" not in drawn
    assert ">" not in drawn
    assert "\n" not in drawn
    # an escaped character is at most five long
    assert len(drawn) <= 5 * 36


def test_a_long_name_ends_with_an_ellipsis():
    assert shorten("x" * 500, 36) == "x" * 35 + "…"


def test_what_is_not_finite_becomes_none():
    assert plain_numbers(np.array([1.0, np.nan, np.inf])) == [1.0, None, None]


_EXTREME = [
    0.0,
    -0.0,
    5e-324,
    -2.2e-308,
    1e-300,
    1.5e-8,
    1e-7,
    1e21,
    9.999996e21,
    1e22,
    1e300,
    -1.7e308,
]


@pytest.mark.parametrize("digits", [4, 6, 9])
def test_numbers_are_those_of_the_format_of_python(digits):
    rng = np.random.default_rng(digits)
    drawn = rng.standard_normal(4000) * 10.0 ** rng.integers(-12, 25, 4000)
    round_ones = np.array([n * 10.0**p for n in (1, -3, 12.5) for p in range(-20, 25)])
    beside = np.nextafter(10.0 ** np.arange(-9, 24), 0)
    numbers = np.concatenate([drawn, round_ones, beside, _EXTREME])
    found = plain_numbers(numbers, digits)
    expected = [float(f"{number:.{digits}g}") for number in numbers.tolist()]
    assert list(map(repr, found)) == list(map(repr, expected))


def test_a_number_in_the_middle_is_one_of_its_neighbours():
    middle = np.array([k + 0.5 for k in range(100000, 100400)]) * 1e-3
    found = np.array(plain_numbers(middle))
    assert np.all(np.abs(found - middle) < 0.5001e-3)
    assert np.all(found == found.round(3))


def test_a_band_is_broken_at_a_gap():
    x = np.arange(5.0)
    trace = band(
        x, np.array([0, 0, np.nan, 0, 0]), np.ones(5), name="u", colour="#0072B2", alpha=0.2
    )
    assert trace["x"] == [0.0, 1.0, 1.0, 0.0, None, 3.0, 4.0, 4.0, 3.0, None]
    assert trace["y"] == [1.0, 1.0, 0.0, 0.0, None, 1.0, 1.0, 0.0, 0.0, None]


def test_a_band_without_a_finite_edge_is_empty():
    nothing = np.full(3, np.nan)
    trace = band(np.arange(3.0), nothing, nothing, name="u", colour="#0072B2", alpha=0.2)
    assert trace["x"] == []
    assert not make_figure("k", "t", "c", [trace], synthetic=False).has_data


def test_synthetic_data_are_called_so_inside_the_figure():
    trace = line(np.arange(2.0), np.arange(2.0), name="a", colour="#0072B2")
    figure = make_figure("k", "t", "c", [trace], synthetic=True, xaxis=axis("strain [%]"))
    assert figure.layout["title"]["subtitle"]["text"] == "SYNTHETIC DATA"
    assert figure.label == "Synthetic data. t. Axes: strain [%]. Lines: a."


def test_every_kind_of_quantity_is_shown_with_a_unit_in_both_systems():
    kinds = ("time", "length", "small length", "tension", "strain", "stress", "energy", "area")
    assert [shown(kind, "us").unit for kind in kinds] == [
        "s", "ft", "in", "lbf", "%", "psi", "ft lbf / ft", "in²",
    ]  # fmt: skip
    # 1 in is 25.4 mm, 1 psi is 6894.757 Pa
    assert shown("small length", "us").factor == 1 / 0.0254
    assert round(1 / shown("stress", "us").factor, 3) == 6894.757
    assert [shown(kind, "si").unit for kind in kinds] == [
        "s", "m", "mm", "N", "%", "MPa", "J/m", "mm²",
    ]  # fmt: skip


def test_numbers_on_an_axis_are_written_out_unless_it_says_otherwise():
    plain = axis("tension [N]")
    assert plain["exponentformat"] == "none"
    assert plain["separatethousands"] is True
    # no power of ten: of four digits, rounded, in thousands
    assert plain["hoverformat"] == ",.4~r"
    assert axis("cycles [1]", exponentformat="power")["exponentformat"] == "power"


# fewer points, but every extreme and every gap

VALUES = st.floats(-1e6, 1e6) | st.just(float("nan"))
CHANNELS = arrays(np.float64, st.integers(200, 600), elements=VALUES)


@given(CHANNELS, st.integers(10, 150))
def test_least_and_greatest_stay_and_the_limit_holds(channel, limit):
    kept = keep_extremes(np.arange(channel.size, dtype=float), channel, limit=limit)
    assert kept.size <= limit
    assert (np.diff(kept) > 0).all()
    assert kept[0] == 0
    assert kept[-1] == channel.size - 1
    if np.isfinite(channel).any():
        assert np.nanmin(channel[kept]) == np.nanmin(channel)
        assert np.nanmax(channel[kept]) == np.nanmax(channel)
    assert np.isnan(channel[kept]).any() == np.isnan(channel).any()


@given(arrays(np.float64, 400, elements=VALUES), CHANNELS.map(lambda x: np.resize(x, 400)))
def test_a_time_axis_that_runs_backward_or_is_missing_is_no_obstacle(time, channel):
    kept = keep_extremes(time, channel, limit=50)
    assert kept.size <= 50
    if np.isfinite(channel).any():
        assert np.nanmax(channel[kept]) == np.nanmax(channel)


def test_every_interval_keeps_its_own_extremes():
    time = np.arange(100_000) / 10.0
    channel = np.random.default_rng(1).normal(size=time.size)
    kept = keep_extremes(time, channel, limit=2000)
    # 999 intervals fit into 2000 points; ten wider ones each hold whole ones in them
    for part in np.array_split(np.arange(time.size), 10):
        inside = kept[(kept >= part[0]) & (kept <= part[-1])]
        assert channel[inside].max() == channel[part].max()
        assert channel[inside].min() == channel[part].min()


def test_two_channels_keep_the_extremes_of_both():
    time = np.arange(5000.0)
    first, second = np.zeros(5000), np.zeros(5000)
    first[1234], second[4321] = 7.0, -7.0
    kept = keep_extremes(time, first, second, limit=100)
    assert {1234, 4321} <= set(kept.tolist())
    assert kept.size <= 100


def test_a_gap_stays_where_it_is():
    channel = np.ones(10_000)
    channel[5000:5050] = np.nan
    kept = keep_extremes(np.arange(10_000.0), channel, limit=500)
    missing = kept[np.isnan(channel[kept])]
    assert missing.size > 0
    assert missing.min() >= 5000
    assert missing.max() < 5050


def test_a_short_record_is_kept_whole():
    assert keep_extremes(np.arange(5.0), np.ones(5), limit=10).tolist() == [0, 1, 2, 3, 4]


def test_intervals_of_a_logarithmic_axis_favour_its_start():
    time = np.linspace(0.1, 1e4, 100_000)
    kept = keep_extremes(np.log10(time), np.sin(time), limit=200)
    # one sample in a thousand lies there, and two decades of five
    assert (time[kept] < 10).sum() > 200 / 5


def test_a_sample_on_an_edge_belongs_to_the_interval_above():
    channel = np.ones(209)
    channel[60] = 0.0  # where the fifteenth of 52 intervals of four ends
    _, least, _ = least_and_greatest(np.arange(209.0), channel, n_intervals=52)
    assert np.flatnonzero(least == 0).tolist() == [15]


@given(CHANNELS, st.integers(3, 60))
def test_between_least_and_greatest_lies_every_sample_of_an_interval(channel, n_intervals):
    place = np.arange(channel.size, dtype=float)
    middle, least, greatest = least_and_greatest(place, channel, n_intervals=n_intervals)
    assert middle.size == n_intervals
    assert (np.diff(middle) > 0).all()
    own = np.minimum(place * n_intervals // (channel.size - 1), n_intervals - 1).astype(int)
    for interval in range(n_intervals):
        inside = channel[own == interval]
        known = inside[np.isfinite(inside)]
        if known.size:
            assert (least[interval], greatest[interval]) == (known.min(), known.max())
        else:
            assert np.isnan(least[interval]) and np.isnan(greatest[interval])


def test_nothing_has_no_edges():
    assert [one.size for one in least_and_greatest(np.zeros(0), np.zeros(0))] == [0, 0, 0]


# figures as SVG: places of the points, ticks, names as text

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


# the colours of the figures as people with other colour vision see them, on white and on dark

VISIONS = {
    "usual": np.eye(3),
    "protanopia": [
        [0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deuteranopia": [
        [0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "tritanopia": [
        [1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}  # fmt: skip
TO_XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750],
     [0.0193339, 0.1191920, 0.9503041]]
)  # fmt: skip
WHITE = TO_XYZ.sum(axis=1)
LEAST = 12.0


"""Two patches that differ by 2.3 are just told apart side by side; thin lines need several times as
much."""


def on_dark():
    """The colours as the page exchanges them on a dark screen."""
    texts = [one.read_text("utf-8") for one in (files("reduction.report") / "static").iterdir()
             if one.name.endswith(".js")]  # fmt: skip
    (pairs,) = (found for text in texts for found in re.findall(r"ON_DARK = (\[.*\]);", text))
    exchanged = dict(re.findall(r'\["(#\w+)", "(#\w+)"\]', pairs))
    assert set(exchanged) <= set(COLOURS)
    return tuple(exchanged.get(one, one) for one in COLOURS)


def linear(text):
    shares = np.array([int(text[place : place + 2], 16) / 255 for place in (1, 3, 5)])
    return np.where(shares <= 0.04045, shares / 12.92, ((shares + 0.055) / 1.055) ** 2.4)


def lab(text, vision):
    seen = np.clip(np.array(VISIONS[vision]) @ linear(text), 0.0, 1.0)
    x, y, z = (
        np.cbrt(one) if one > 0.008856 else 7.787 * one + 16 / 116 for one in TO_XYZ @ seen / WHITE
    )
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def contrast(one, other):
    low, high = sorted(float(TO_XYZ[1] @ linear(text)) for text in (one, other))
    return (high + 0.05) / (low + 0.05)


def test_black_and_white_are_a_hundred_apart_and_a_colour_nothing_from_itself():
    assert np.linalg.norm(lab("#000000", "usual") - lab("#ffffff", "usual")) == pytest.approx(
        100, abs=0.01
    )
    assert contrast("#000000", "#ffffff") == pytest.approx(21)


@pytest.mark.parametrize("vision", VISIONS)
@pytest.mark.parametrize("page", ["white", "dark"])
def test_any_two_colours_are_told_apart_with_any_colour_vision(vision, page):
    colours = COLOURS if page == "white" else on_dark()
    apart = {
        pair: np.linalg.norm(lab(pair[0], vision) - lab(pair[1], vision))
        for pair in combinations(colours, 2)
    }
    assert min(apart.values()) > LEAST, min(apart, key=apart.get)


def test_colours_stand_out_from_the_page():
    # the lightest two are for lines that have a marker as well; text needs 4.5, and has no colour
    assert min(contrast(one, "#ffffff") for one in COLOURS) > 2.2
    assert min(contrast(one, "#14181c") for one in on_dark()) > 3


def test_what_shares_a_colour_differs_in_its_marker_and_branches_in_their_dash():
    looks = {(marker(k)["color"], marker(k)["symbol"]) for k in range(56)}
    assert len(looks) == 56
    assert len(set(SYMBOLS)) == len(SYMBOLS)
    assert len(set(DASHES.values())) == len(DASHES)
