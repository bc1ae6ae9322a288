"""Figures as plain dictionaries, safe inside a page."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reduction.report.figure_data import axis, band, line, make_figure, plain_numbers, script_json
from reduction.report.text_style import plot_text, shorten, shown


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
