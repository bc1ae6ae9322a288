"""Floating depth of a hose from its weight."""

from decimal import Decimal, localcontext

import numpy as np
import pytest

from reduction.prediction import wave_load as immersion
from reduction.prediction.wave_load import ImmersedSection, _immersion_depth_of, immerse_hose
from reduction.record.errors import DataError, FitError

HOSE = {
    "outer_diameter": 0.114, "wall_thickness": 0.006, "wall_density": 1250.0,
    "content_density": 830.0, "water_density": 1025.0,
}  # fmt: skip


def segment(depth, diameter):
    """Area below a chord, eq. (8) of the paper as printed."""
    r = diameter / 2
    return (np.pi - np.arccos((depth - r) / r)) * r**2 + (depth - r) * np.sqrt(
        r**2 - (depth - r) ** 2
    )


def test_printed_hose():
    hose = immerse_hose(**HOSE)
    # 0.0090994 m2, 95.124 mm, 0.83442, S1/S0 0.89148: worked out beside the paper
    assert float(hose.submerged_section_area) == pytest.approx(0.0090994, abs=5e-8)
    assert 1000 * float(hose.immersion_depth) == pytest.approx(95.124, abs=0.0005)
    assert float(hose.submerged_share) == pytest.approx(0.89148, abs=5e-6)
    assert 1 - float(hose.immersion_depth) / 0.114 == pytest.approx(0.1656, abs=5e-5)
    assert float(hose.section_area) == pytest.approx(np.pi * 0.114**2 / 4)
    assert 1000 * float(hose.centre_elevation) == pytest.approx(-38.1, abs=0.05)
    assert float(hose.emergent_height + hose.immersion_depth) == pytest.approx(0.114)


def test_weight_is_carried():
    for content in (0.0, 400.0, 830.0):
        hose = immerse_hose(**{**HOSE, "content_density": content})
        wall = np.pi * (0.057**2 - 0.051**2) * 1250.0
        weight = wall + np.pi * 0.051**2 * content
        assert 1025.0 * segment(float(hose.immersion_depth), 0.114) == pytest.approx(
            weight, rel=1e-12
        )


def test_an_empty_hose_floats_high_and_meets_the_water_with_its_chord():
    hose = immerse_hose(**{**HOSE, "content_density": 0.0})
    depth = float(hose.immersion_depth)
    assert depth < 0.057 and float(hose.centre_elevation) > 0
    half = np.sqrt(0.057**2 - (0.057 - depth) ** 2)
    assert float(hose.submerged_width) == pytest.approx(2 * half, rel=1e-12)
    assert float(immerse_hose(**HOSE).submerged_width) == 0.114


def sine(angle):
    """Of a Decimal, by its series."""
    term, total, n = angle, angle, 1
    while abs(term) > Decimal(10) ** -58:
        term *= -angle * angle / ((2 * n) * (2 * n + 1))
        total, n = total + term, n + 1
    return total


def test_depth_is_exact_to_the_last_digits_over_twenty_decades_of_area():
    angles = np.concatenate([np.geomspace(1e-6, 1.0, 60), np.linspace(1.0, 6.2, 60)])
    with localcontext() as digits:
        digits.prec = 60
        area, depth = [], []
        for one in map(Decimal, map(float, angles)):
            area.append(float((one - sine(one)) / 8))
            depth.append(float(sine(one / 4) ** 2))
    assert _immersion_depth_of(area, 1.0) == pytest.approx(depth, rel=2e-15)


def test_ends_and_middle():
    area = np.pi / 4 * np.array([0.0, 0.5, 1.0])
    assert _immersion_depth_of(area, 1.0) == pytest.approx([0.0, 0.5, 1.0], abs=1e-15)
    neutral = immerse_hose(**{**HOSE, "wall_density": 1025.0, "content_density": 1025.0})
    assert float(neutral.immersion_depth) == pytest.approx(0.114)
    assert float(neutral.submerged_width) == pytest.approx(0.114)


def test_a_rod_has_no_bore():
    rod = immerse_hose(**{**HOSE, "wall_thickness": 0.057, "wall_density": 600.0})
    assert float(rod.submerged_share) == pytest.approx(600 / 1025)


def test_many_hoses_at_once():
    thickness = np.linspace(0.002, 0.015, 7)[:, None]
    content = np.array([0.0, 500.0, 830.0])
    many = immerse_hose(**{**HOSE, "wall_thickness": thickness, "content_density": content})
    assert many.immersion_depth.shape == (7, 3)
    one = immerse_hose(
        **{**HOSE, "wall_thickness": float(thickness[4, 0]), "content_density": 500.0}
    )
    assert many.immersion_depth[4, 1] == pytest.approx(float(one.immersion_depth), rel=1e-14)
    with pytest.raises(ValueError, match="read-only"):
        many.immersion_depth[0, 0] = 1.0


def test_a_hose_heavier_than_water_is_refused_with_the_densities():
    with pytest.raises(
        DataError,
        match=r"1 of 2 hoses are heavier than water, first at index 1; found 1049\.9 kg/m3 with a "
        r"wall of 1250 and a content of 1000 kg/m3; needed at most 1025 kg/m3",
    ):
        immerse_hose(**{**HOSE, "content_density": [830.0, 1000.0]})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"outer_diameter": -0.1}, "outer_diameter"),
        ({"wall_thickness": 0.0}, "wall_thickness"),
        ({"wall_density": np.nan}, "wall_density"),
        ({"water_density": 0.0}, "water_density"),
        ({"content_density": -1.0}, "content_density is below zero"),
        ({"wall_thickness": 0.06}, "the wall is thicker than half the hose"),
    ],
)
def test_no_hose(change, message):
    with pytest.raises(DataError, match=message):
        immerse_hose(**{**HOSE, **change})


@pytest.mark.parametrize("area", [-1e-6, 0.8])
def test_no_segment(area):
    with pytest.raises(DataError, match="no segment of the circle is this large"):
        _immersion_depth_of(area, 1.0)


def test_a_search_that_does_not_end_says_so(monkeypatch):
    monkeypatch.setattr(immersion, "_MOST_STEPS", 1)
    with pytest.raises(FitError, match="the immersion depth was not found"):
        _immersion_depth_of(0.1, 1.0)


def test_a_section_by_hand_is_read_only():
    section = ImmersedSection(np.array([0.1]), np.array([0.005]), np.array([0.06]))
    assert not section.immersion_depth.flags.writeable
