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
    # what is promised beyond: on with the slope of the last fiftieth
    near = np.interp(0.98 * end, [0, *one.strain], [0, *one.tension])
    last = (one.tension[-1] - near) / (0.02 * end)
    for beyond, at_edge in (
        (grid > end * (1 + 1e-9), last),
        (grid < 0, CableExpression(material["Te"])(0.0)[0]),
    ):
        slope = np.diff(tension[beyond]) / np.diff(grid[beyond])
        np.testing.assert_allclose(slope, at_edge, rtol=1e-6)
        np.testing.assert_allclose(
            CableExpression(material["Te"])(grid[beyond]), at_edge, rtol=1e-6
        )
        assert not CableExpression(material["Tee"])(grid[beyond]).any()


def test_strain_under_a_tension_is_kept_by_a_curve_of_many_bends():
    """Windows that join in bends, as those of a composite, and a last bend within a fiftieth."""
    slopes = np.array([500, 260, 520, 300, 700, 350, 900, 420, 1100, 500, 1500, 2600.0])
    nodes = np.concatenate([np.linspace(0, 2.6, slopes.size), [2.63]])
    load = np.concatenate([[0], np.cumsum(slopes * np.diff(nodes))])
    strain = np.union1d(np.linspace(0, nodes[-1], 400), nodes)
    one = line(strain=strain, tension=np.interp(strain, nodes, load))
    _, material = cable_material(_whoicable_text(one))
    end = nodes[-1]
    last = (load[-1] - np.interp(0.98 * end, nodes, load)) / (0.02 * end)
    fine = np.linspace(0, 1.6 * end, 20001)
    written = CableExpression(material["T"])(fine)
    wanted = np.array([0.05, 0.2, 0.5, 0.8, 1.0, 1.2]) * load[-1]
    known = np.interp(wanted, load, nodes) + np.maximum(wanted - load[-1], 0) / last
    np.testing.assert_allclose(np.interp(wanted, written, fine), known, rtol=0.01)


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
    np.testing.assert_allclose(tension[:-1], rubber(strain[:-1]), atol=1e-6 * rubber(1.5))
    assert strain.size == 101
    # Cable goes on with the last step of a table: it is that of the last fiftieth of the curve
    slope = (rubber(1.5) - rubber(0.98 * 1.5)) / (0.02 * 1.5)
    assert tension[-1] == pytest.approx(rubber(1.5) + slope * (strain[-1] - 1.5), rel=1e-4)
    assert {"Te", "Tee", "EA"} <= set(material)


def test_weight_in_water_is_newton_a_metre():
    _, material = cable_material(_whoicable_text(line(rated_break_strength=3e3)))
    volume = math.pi / 4 * 0.026**2
    assert float(material["wet"]) == pytest.approx((0.6 - SEA_WATER * volume) * 9.80665)
    assert material["yield"] == "3000.0"


def test_a_line_without_mass_is_refused():
    with pytest.raises(SettingsError, match="linear density"):
        _whoicable_text(line(linear_density=math.nan))
