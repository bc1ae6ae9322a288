import math
import re

import numpy as np
import pytest
from export_lines import line, rubber
from export_readers import CableExpression, cable_material, cable_pairs

from reduction.lines.composite import CompositeRule, compose
from reduction.lines.deck_formats import _whoicable_text
from reduction.lines.export_line import SEA_WATER
from reduction.lines.export_sources import line_from_composite, line_from_lookup
from reduction.lines.published_source import published_piece_sources, published_sources
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


@pytest.mark.parametrize(
    "name", ["polyester-double-braid-0.5in-new", "nylon-8-strand-plaited-0.5in-new", "tethers"]
)
def test_a_curve_rises_everywhere_and_goes_on_straight_beyond_both_ends(name):
    """Cable finds an equilibrium wherever the expression has the tension."""
    if name == "tethers":
        source = published_piece_sources()["rubber-tether-used"]
        one = line_from_composite(
            source, compose(source, CompositeRule()), diameter=0.06, linear_density=2.0
        )
    else:
        one = line_from_lookup(published_sources()[name], linear_density=0.11)
    _, material = cable_material(_whoicable_text(one))
    end = float(one.strain[-1])
    grid = np.linspace(-0.3, 3.0, 3301) * end
    tension = CableExpression(material["T"])(grid)
    assert (np.diff(tension) > 0).all()
    inside = (grid >= 0) & (grid <= end)
    wanted = np.interp(grid[inside], [0, *one.strain], [0, *one.tension])
    np.testing.assert_allclose(tension[inside], wanted, atol=0.02 * wanted[-1])
    for beyond, edge in ((grid > end * (1 + 1e-9), end), (grid < 0, 0.0)):
        slope = np.diff(tension[beyond]) / np.diff(grid[beyond])
        at_edge = CableExpression(material["Te"])(edge)[0]
        np.testing.assert_allclose(slope, at_edge, rtol=1e-6)
        np.testing.assert_allclose(
            CableExpression(material["Te"])(grid[beyond]), at_edge, rtol=1e-6
        )
        assert not CableExpression(material["Tee"])(grid[beyond]).any()


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
