import math

import numpy as np
import pytest
from export_lines import line

from reduction.lines.export_line import SEA_WATER, guards_of, range_of


def test_the_straight_start_is_said_not_to_be_measured():
    assert range_of(line()) == (
        "tested from strain 0.1 to 1.4; the start, a straight line from zero to strain 0.1, was NOT "
        "measured on this curve"
    )
    assert range_of(line(tested=(0.0, 1.4))) == "tested from strain 0 to 1.4"
    assert range_of(line(tested=(math.nan, math.nan))) == "nothing was tested"
    assert range_of(line(tested=(0.2, 1.3), turns=(0.1, 1.4))) == (
        "tested from strain 0.1 to 1.4 (both branches from 0.2 to 1.3); the start, a straight line"
        " from zero to strain 0.1, was NOT measured on this curve"
    )


def test_a_line_that_floats_or_is_heavier_than_a_rod_of_its_fibre_is_doubtful():
    # 26 mm displace 0.544 kg/m
    assert SEA_WATER * np.pi / 4 * 0.026**2 == pytest.approx(0.5442, abs=5e-5)
    (text,) = (one for one in guards_of(line(linear_density=0.5)) if one.startswith("DOUBTFUL"))
    assert "floats: 0.5 kg/m displaces 0.5442 kg/m" in text
    assert not any(one.startswith("DOUBTFUL") for one in guards_of(line()))
    # who states a wet mass below zero has a line that floats
    floating = guards_of(line(linear_density=0.5, wet_linear_density=-0.04))
    assert not any("floats" in one for one in floating)
    # a solid line whose masses and diameter are rounded, and one whose masses are of another
    assert not any("DOUBTFUL" in one for one in guards_of(line(wet_linear_density=0.054)))
    assert "disagree" in guards_of(line(wet_linear_density=0.03))[-1]
    # a rod of nylon of 26 mm has 1140 * 5.309e-4 m2 = 0.605 kg/m
    heavy = guards_of(line(linear_density=0.61, material="nylon"))
    assert "disagree" in heavy[-1]
    assert "disagree" not in guards_of(line(linear_density=0.6, material="nylon"))[-1]
    # 0.36 of it is 0.218 kg/m
    assert "far below" in guards_of(line(linear_density=0.21, material="nylon"))[-1]
    assert "disagree" not in guards_of(line(linear_density=0.22, material="nylon"))[-1]


def test_without_mass_or_diameter_the_range_alone_is_said():
    assert len(guards_of(line(linear_density=math.nan))) == 1
    assert len(guards_of(line(diameter=math.nan))) == 1
