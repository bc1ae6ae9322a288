"""The colours of the figures as people with other colour vision see them, on white and on dark.

Simulated with the matrices of Machado, Oliveira and Fernandes, IEEE Trans. Vis. Comput. Graph.
15(6), 2009, table 1, severity 1.0; differences are Euclidean in CIELAB (1976).
"""

import re
from importlib.resources import files
from itertools import combinations

import numpy as np
import pytest

from reduction.report.text_style import COLOURS, DASHES, SYMBOLS, marker

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
