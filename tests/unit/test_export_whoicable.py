import math
import re

import numpy as np
import pytest
from export_lines import line, rubber
from export_readers import CableExpression, cable_material, cable_pairs

from reduction.lines.deck_formats import _whoicable_text
from reduction.lines.export_line import SEA_WATER
from reduction.record.errors import SettingsError


def test_the_three_expressions_are_the_curve_and_its_derivatives():
    name, material = cable_material(_whoicable_text(line()))
    assert name == "new_tether"
    assert material["type"] == "nonlinear"
    grid = np.linspace(0.01, 1.45, 50)
    top = rubber(1.5)
    np.testing.assert_allclose(CableExpression(material["T"])(grid), rubber(grid), atol=1e-5 * top)
    slope = 900 * (1 - 0.9 * grid + 0.48 * grid**2)
    np.testing.assert_allclose(CableExpression(material["Te"])(grid), slope, rtol=1e-3)
    bend = 900 * (-0.9 + 0.96 * grid)
    np.testing.assert_allclose(CableExpression(material["Tee"])(grid), bend, atol=20)


def test_a_straight_line_has_no_constant_derivative():
    one = line(strain=np.array([0.0, 0.5]), tension=np.array([0.0, 100.0]))
    _, material = cable_material(_whoicable_text(one))
    for name in ("Te", "Tee"):
        assert "e" in re.sub(r"\de[+-]?\d", "", material[name])
    assert CableExpression(material["Te"])(0.3) == pytest.approx(200)
    assert CableExpression(material["Tee"])(0.3) == pytest.approx(0, abs=1e-6)


def test_every_number_has_a_point_since_others_are_integers_of_32_bits():
    one = line(strain=np.array([0.0, 0.5]), tension=np.array([0.0, 5e9]))
    _, material = cable_material(_whoicable_text(one))
    for name, text in material.items():
        if name not in ("type", "comment"):
            numbers = re.findall(r"(?<![\w.])\d[\d.]*(?:e[+-]?\d+)?", text)
            assert all("." in number for number in numbers), name
    assert material["EA"] == "10000000000.0"


def test_a_table_stands_beside_the_slopes():
    _, material = cable_material(_whoicable_text(line(), form="table"))
    strain, tension = cable_pairs(material["T"])
    np.testing.assert_allclose(tension, rubber(strain), atol=1e-6 * rubber(1.5))
    assert strain.size == 100
    assert {"Te", "Tee", "EA"} <= set(material)


def test_weight_in_water_is_newton_a_metre():
    _, material = cable_material(_whoicable_text(line(rated_break_strength=3e3)))
    volume = math.pi / 4 * 0.026**2
    assert float(material["wet"]) == pytest.approx((0.6 - SEA_WATER * volume) * 9.80665)
    assert material["yield"] == "3000.0"


def test_another_form_and_a_line_without_mass_are_refused():
    with pytest.raises(SettingsError, match="form of a Cable material"):
        _whoicable_text(line(), form="spline")
    with pytest.raises(SettingsError, match="linear density"):
        _whoicable_text(line(linear_density=math.nan))
