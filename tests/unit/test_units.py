"""Units at the edge; factors are the international definitions, written out here."""

import math

import pytest
from refusals import refusals

from reduction.quantities.units import (
    _PER_SI,
    _US,
    _USUAL,
    DIMENSIONS,
    _registry,
    _scale_by_pint,
    combined_unit,
    display_unit,
    parse_quantity,
    scale_of_unit,
    scale_to_si,
)
from reduction.record.errors import SettingsError

POUND_FORCE = 0.45359237 * 9.80665


@pytest.mark.parametrize(
    ("unit", "dimension", "factor"),
    [
        ("lbf", "force", POUND_FORCE),
        ("lb", "force", POUND_FORCE),
        ("kip", "force", 1000 * POUND_FORCE),
        ("kN", "force", 1e3),
        ("mN", "force", 1e-3),
        ("ft", "length", 0.3048),
        ("inch", "length", 0.0254),
        ("mm", "length", 1e-3),
        ("psi", "stress", POUND_FORCE / 0.0254**2),
        ("MPa", "stress", 1e6),
        ("N/mm²", "stress", 1e6),
        ("%", "strain", 0.01),
        ("1", "strain", 1.0),
        ("min", "time", 60.0),
        ("Sec", "time", 1.0),
        ("1/min", "frequency", 1 / 60),
        ("deg", "angle", 3.141592653589793 / 180),
    ],
)
def test_factor_to_si_is_the_defined_one(unit, dimension, factor):
    assert scale_to_si(unit, dimension) == (pytest.approx(factor, rel=1e-14), 0.0)


@pytest.mark.parametrize("unit", ["degC", "°C", "\u02daC", "\u00baC", "\u2103"])
def test_temperature_carries_an_offset(unit):
    factor, offset = scale_to_si(unit, "temperature")
    assert factor == pytest.approx(1.0) and offset == pytest.approx(273.15)


@pytest.mark.parametrize("unit", ["te", "t", "kg", "pounds"])
def test_a_mass_for_a_load_is_told_how_the_force_is_written(unit):
    with pytest.raises(SettingsError, match='in tonnes in "tf", in pounds in "lbf"'):
        scale_to_si(unit, "force")
    assert scale_to_si("te", "mass") == (1000.0, 0.0)


@pytest.mark.parametrize("text", ["12", "", "abc", "1.2.3 ft", "nan ft"])
def test_a_text_without_a_number_or_a_unit_is_refused(text):
    with pytest.raises(SettingsError, match="unit"):
        parse_quantity(text, "length")


def test_a_text_that_is_no_strain_is_told_how_one_is_written():
    match = r"""^a value is not a number; found 'ten'; needed 0\.015 or "1\.5 %"$"""
    with pytest.raises(SettingsError, match=match):
        parse_quantity("ten", "strain")


def test_a_bare_number_is_a_strain_or_a_plain_number_only():
    assert parse_quantity(0.75, "strain") == 0.75
    with pytest.raises(SettingsError, match='needed text such as "0.75 m"'):
        parse_quantity(0.75, "length")


def test_share_of_break_strength_needs_a_break_strength():
    assert parse_quantity("12 %RBS", "force", rated_break_strength=500.0) == pytest.approx(60.0)
    assert parse_quantity("12 %MBL", "force", rated_break_strength=500.0) == pytest.approx(60.0)
    with pytest.raises(SettingsError, match="but no break strength"):
        parse_quantity("12 %RBS", "force")


@pytest.mark.parametrize("text", ["3,0 m", "3,000 mm", "1.000,5 m"])
def test_a_comma_in_a_number_is_told_as_such(text):
    with pytest.raises(SettingsError, match="a number has a comma.*needed a decimal point"):
        parse_quantity(text, "length")


@pytest.mark.parametrize(
    ("unit", "shown", "factor"),
    [
        ("Pa", "psi", 0.0254**2 / POUND_FORCE),
        ("m", "ft", 1 / 0.3048),
        ("s", "s", 1.0),
        # an energy over a length: the feet cancel in the number, not in the words
        ("J m-1", "ft lbf / ft", 1 / POUND_FORCE),
        ("N m", "ft lbf", 1 / POUND_FORCE / 0.3048),
    ],
)
def test_us_display_is_the_inverse_of_the_factor(unit, shown, factor):
    assert display_unit(unit, "us") == (shown, pytest.approx(factor, rel=1e-14))
    assert display_unit(unit, "si") == (unit, 1.0)


@pytest.mark.parametrize(
    "unit",
    ["kN/", "kN (raw", "m/0", "9**9**9", "m" * 60, "m**999", "import os", "__class__", "m;s"],
)
def test_a_text_that_is_no_unit_expression_is_refused(unit):
    with pytest.raises(SettingsError, match="unit"):
        scale_to_si(unit, "force")


@pytest.mark.parametrize(
    "around", ["{}\0", "{} # lbf", "{};", "{}\\", "\0{}", "{}\ufeff", "{}\x01"]
)
def test_what_stands_around_a_unit_is_not_passed_over(around):
    with pytest.raises(SettingsError, match="not one that a test house writes"):
        scale_to_si(around.format("kN"), "force")
    with pytest.raises(SettingsError, match="not one that a test house writes"):
        parse_quantity("2 " + around.format("kN"), "force")


@pytest.mark.parametrize(
    ("unit", "si_unit", "factor", "offset"),
    [
        ("lbf", "N", 4.4482216152605, 0.0),
        ("lb", "N", 4.4482216152605, 0.0),
        ("J m-1", "N", 1.0, 0.0),
        ("lbf ft / ft", "N", 4.4482216152605, 0.0),
        ("cP", "kg m-1 s-1", 1e-3, 0.0),
        ("degC", "K", 1.0, 273.15),
        ("%", "1", 0.01, 0.0),
        ("in2", "m2", 0.0254**2, 0.0),
    ],
)
def test_a_unit_finds_its_own_dimension(unit, si_unit, factor, offset):
    found = scale_of_unit(unit)
    assert found[0] == si_unit
    assert found[1:] == pytest.approx((factor, offset), rel=1e-12)


def test_a_unit_that_nobody_knows_has_no_dimension():
    with pytest.raises(SettingsError, match="unit 'furlongs_x' is not known") as refused:
        scale_of_unit("furlongs_x")
    assert "Without a unit the numbers stay" in str(refused.value)


@pytest.mark.parametrize(
    ("unit", "others", "powers", "combined"),
    [
        ("N", ["Hz", "N"], [1, 2], "N-1 Hz-1"),
        ("N", ["N"], [1], "1"),
        ("", ["m s-1"], [2], "m-2 s2"),
        ("J m-1", ["m"], [2], "J m-3"),
        ("ln(N)", ["N", "1"], [1, 2], "ln(N) N-1"),
        ("ft lbf / ft", ["lbf"], [1], "(ft lbf / ft) lbf-1"),
    ],
)
def test_units_of_a_coefficient_are_multiplied_out(unit, others, powers, combined):
    assert combined_unit(unit, others, powers) == combined


@pytest.mark.parametrize(
    ("unit", "hertz"),
    [
        ("rpm", 1 / 60), ("cpm", 1 / 60), ("cycles/min", 1 / 60), ("rev/min", 1 / 60),
        ("cyc/s", 1.0), ("cycle/s", 1.0), ("1/min", 1 / 60), ("kHz", 1000.0),
        ("rad/s", 0.15915494309189535), ("deg/s", 1 / 360),
    ],
)  # fmt: skip
def test_a_turn_is_one_cycle_in_every_way_of_writing_a_frequency(unit, hertz):
    assert scale_to_si(unit, "frequency") == pytest.approx((hertz, 0.0))


@pytest.mark.parametrize(
    ("unit", "factor"),
    [("cycles", 1.0), ("cycle", 1.0), ("rev", 1.0), ("kcycles", 1000.0), ("Mcycles", 1e6),
     ("counts", 1.0), ("rad", 1.0), ("deg", math.pi / 180)],
)  # fmt: skip
def test_a_number_of_cycles_is_a_count_and_no_angle(unit, factor):
    assert scale_to_si(unit, "number") == pytest.approx((factor, 0.0))


@pytest.mark.parametrize("unit", sorted({unit for unit, _ in _USUAL}))
def test_a_usual_unit_is_what_pint_says_in_every_dimension(unit):
    for dimension in DIMENSIONS:
        if dimension == "information":
            continue
        try:
            by_pint = _scale_by_pint(unit, dimension)
        except SettingsError:
            by_pint = None
        assert _USUAL.get((unit, dimension)) == by_pint


def test_units_that_are_shown_are_those_of_pint():
    sources = {"J m-1": "N", "m2": "m**2", "m s-1": "m/s"}
    targets = {"in2": "in**2", "ft s-1": "ft/s", "ft lbf / ft": "lbf", "lbf s": "lbf*s"}
    for si_unit, shown in _US.items():
        one = _registry().Quantity(1.0, sources.get(si_unit, si_unit))
        assert _PER_SI[shown] == one.to(targets.get(shown, shown)).magnitude


REFUSED = {
    "unknown unit is refused by name": (
        lambda: scale_to_si("furlongs_x", "length"),
        SettingsError,
        r"unit 'furlongs_x' is not known; found 'furlongs_x'",
    ),
    "unit of the wrong dimension is refused": (
        lambda: scale_to_si("ft", "force"),
        SettingsError,
        r"unit 'ft' is not a unit of force.*needed a unit of f",
    ),
    "unknown unit system is refused": (
        lambda: display_unit("m", "imperial"),
        SettingsError,
        "needed si or us",
    ),
}


test_refusals = refusals(REFUSED)
