"""Recomputation of WHOI-2004-06: equations, and claims on cords, angles and hoses.

The report gives neither the curve of a cord nor the size of a hose, so no load of a hose and no
stretch at a load can be recomputed.
"""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np

from reduction.prediction.cord_curve import CordCurve
from reduction.prediction.hose_geometry import (
    NEUTRAL_ANGLE,
    cord_stretch_ratio,
    current_wrap_angle,
    pick_up_stretch_ratio,
)
from reduction.prediction.hose_product import HoseDesign, HosePrediction
from reduction.prediction.hose_tension import hose_energy, numbers_of, predict_hose
from reduction.prediction.rubber_wall import rubber_tension
from reduction.published.reproduced_item import (
    Answer,
    Answers,
    ReproducedItem,
    items_from,
    log_slope,
)
from reduction.record.measurement import Floats

_ANGLE = np.radians(68.0)

_WRAP, _CORDS_PER_INCH = 3.5, 34.0

_HOSE = HoseDesign(
    wrap_angle=_ANGLE,
    layer_diameter=(_WRAP, _WRAP),
    inner_diameter=2.5,
    outer_diameter=5.0,
    cords_per_length=_CORDS_PER_INCH,
    cord_diameter=0.022,
    rubber_modulus=0.0,
    cord=CordCurve(strain=np.array([0.0, 0.9]), load=np.array([0.0, 30.0])),
)

_STRAIN = np.array([1.2, 1.6, 2.0])

_AXIAL = 1e-4  # rad: a wrap angle at which the second term of (8) is negligible


def _equation_answers() -> Answers:
    """Answers to the factors and the powers of equations (5) to (26)."""
    return _kinematics() | _sheave() | _helix() | _pressure() | _axial_load()


def _kinematics() -> Answers:
    stretch = "exponent of hose stretch ratio"
    ratio = 2.0
    angle = current_wrap_angle(ratio, _ANGLE)
    tangent = float(np.tan(angle) / np.tan(_ANGLE))
    identity = np.degrees(np.arccos(1 / np.sqrt(1 + np.tan(angle) ** 2)))
    squared = cord_stretch_ratio([1.5, 2.0], _AXIAL) ** 2
    count = float(numbers_of(_HOSE).axial_factor / np.cos(_ANGLE))
    around = pi * _WRAP * np.cos(_ANGLE) * _CORDS_PER_INCH
    helix = "slope of a logarithm, of a helix on a cylinder that keeps its volume"
    return {
        ("eq 5", "wrap diameter dw", stretch): Answer(
            log_slope([1, ratio], [1, ratio * tangent]), helix),
        ("eq 7", "tangent of the wrap angle", stretch): Answer(
            log_slope([1, ratio], [1, tangent]), helix),
        ("sec 1.2.1", "identity between (7) and (8)",
         "angle under the cosine at 68 deg and stretch ratio 2"): Answer(
            float(identity), "angle of the stretched helix"),
        ("eq 8", "squared cord stretch ratio, first term", stretch): Answer(
            log_slope([1.5, 2.0], squared), "slope of a logarithm, cords along the hose"),
        ("eq 10", "cut ribbon width wc", "equation number"): Answer(9.0, "the number after (8)"),
        ("eq 11", "number of cords N", "factor"): Answer(
            count / around, "two layers, each with its width of fabric around the hose"),
    }  # fmt: skip


def _sheave() -> Answers:
    """Cord of unit tension on a cylinder: its line load is the inverse radius."""
    node, weight = np.polynomial.legendre.leggauss(24)
    contact = 1.0
    resultant = float(np.sum(contact / 2 * weight * np.cos(contact / 2 * node)))
    whole = float(np.sum(pi * weight))
    diameter, width = 4.0, 0.022
    pressure = 1 / (diameter / 2) / width
    return {
        ("eq 12", "load of a partial wrap", "factor"): Answer(
            resultant / np.sin(contact / 2), "resultant of the line load over the contact"),
        ("eq 12", "load of a partial wrap", "divisor of the contact angle"): Answer(
            contact / float(np.arcsin(resultant / 2)), "resultant of the line load"),
        ("eq 13", "load of a full wrap", "factor of pi Pc"): Answer(
            whole / pi, "sum of the line load; its resultant, which (12) gives, is zero"),
        ("eq 14", "pressure under one cord", "factor"): Answer(
            pressure * diameter * width, "line load over the width of the cord"),
    }  # fmt: skip


def _helix() -> Answers:
    """Curvature and length of helices on a cylinder of diameter 2, from their derivatives."""
    sine = np.sin(np.radians([50.0, 70.0]))
    radius, length = [], []
    for angle in np.arcsin(sine):
        along = 1 / np.tan(angle)
        first, second = np.array([0.0, 1.0, along]), np.array([-1.0, 0.0, 0.0])
        speed = np.linalg.norm(first)
        radius.append(float(speed**3 / np.linalg.norm(np.cross(first, second))))
        length.append(float(2 * pi * speed))
    slope = -log_slope(sine, radius)
    return {
        ("eq 15", "radius of curvature", "divisor"): Answer(
            float(2 / (radius[0] * sine[0] ** 2)), "curvature of a helix, from its derivatives"),
        ("eq 15", "radius of curvature", "power of the sine"): Answer(
            slope, "curvature of a helix, from its derivatives"),
        ("eq 15", "length of one helical wrap", "power of the sine"): Answer(
            -log_slope(sine, length), "length of one turn of a helix, pi dw / sin"),
    }  # fmt: skip


def _pressure() -> Answers:
    found = predict_hose(_HOSE, _STRAIN)
    stretch, cord = 1 + found.strain, 1 + found.cord_strain
    sine = np.sin(found.current_wrap_angle)
    diameter = _WRAP / np.sqrt(stretch)
    both = found.fill_pressure * diameter * found.cord_spacing / found.cord_tension
    statics = "pressure of the hose, from the energy of its cords"
    rest = found.fill_pressure * stretch * cord * _WRAP / (_CORDS_PER_INCH * found.cord_tension)
    angles = np.radians([62.0, 68.0])
    other = [_spread(predict_hose(replace(_HOSE, wrap_angle=one), [1.8])) for one in angles]
    squared = (np.array([1.5, 2.0]) * cord_stretch_ratio([1.5, 2.0], _AXIAL)) ** 2
    wide = replace(_HOSE, layer_diameter=(4.0, 4.0))
    of_width = [found.fill_pressure[1], predict_hose(wide, _STRAIN).fill_pressure[1]]
    sines = "power of the sine"
    divided = "power of cord stretch ratio in the divisor"
    law = "two logarithms fitted over wrap angle and stretch"
    diameters, sine_powers, of_20 = _powers_over_stretch()
    return {
        ("eq 17", "pressure of one layer", "factor"): Answer(
            float(both[0] / sine[0] ** 2) / 2, statics + ", half of it"),
        ("eq 17", "pressure of one layer", sines): Answer(log_slope(sine, both), statics),
        ("eq 18", "pressure of two layers", "factor"): Answer(
            float(both[0] / sine[0] ** 2), statics),
        ("eq 18", "pressure of two layers", sines): Answer(log_slope(sine, both), statics),
        ("eq 19", "squared sine of the wrap angle",
         "power of wrap diameter over its rest value"): Answer(diameters[1], law),
        ("eq 19", "squared sine of the wrap angle", divided): Answer(-diameters[0], law),
        ("eq 20", "squared wrap diameter over its rest value",
         "exponent of cord stretch ratio"): Answer(of_20, law + "; that of the hose is -1"),
        ("eq 21", "squared sine of the wrap angle", divided): Answer(-sine_powers[0], law),
        ("eq 24", "fill_pressure", "factor"): Answer(
            float(rest[0] / np.sin(_ANGLE) ** 2), statics),
        ("eq 24", "fill_pressure", "power of the sine of the angle at rest"): Answer(
            log_slope(np.sin(angles), other), statics),
        ("eq 25", "fill_pressure", "power of hose stretch ratio under the root, first term"):
            Answer(log_slope([1.5, 2.0], squared), "slope of a logarithm, cords along the hose"),
        ("eq 25", "fill_pressure", "power of wrap diameter and spacing in the divisor"): Answer(
            -log_slope([_WRAP, 4.0], of_width), statics + " at two wrap diameters"),
    }  # fmt: skip


def _spread(found: HosePrediction) -> float:
    """Pressure without the factors of (24) other than the sine and the constant."""
    whole = found.fill_pressure * (1 + found.strain) * (1 + found.cord_strain) / found.cord_tension
    return float(whole[0])


def _powers_over_stretch() -> tuple[Floats, Floats, float]:
    """Exponents: squared sine in lambda_c with dw, then with lambda_h; dw squared in lambda_c."""
    angle, stretch = np.meshgrid(np.radians([40.0, 55.0, 70.0]), [1.2, 1.7, 2.5])
    current = current_wrap_angle(stretch, angle)
    cord = cord_stretch_ratio(stretch, angle).ravel()
    diameter = (stretch * np.tan(current) / np.tan(angle)).ravel()
    sine = ((np.sin(current) / np.sin(angle)) ** 2).ravel()

    def powers(of: Floats, *factors: Floats) -> Floats:
        logs = np.log(np.column_stack(factors))
        return np.asarray(np.linalg.lstsq(logs, np.log(of))[0])

    hose = stretch.ravel()
    return (
        powers(sine, cord, diameter),
        powers(sine, cord, hose),
        float(powers(diameter**2, cord, hose)[0]),
    )


def _axial_load() -> Answers:
    found = predict_hose(_HOSE, [1.6])
    step = 1e-5
    energy = hose_energy(_HOSE, 2.6 + step * np.array([-1.0, 1.0]))
    net = float(energy[1] - energy[0]) / (2 * step)
    stretch, cord = 2.6, float(1 + found.cord_strain[0])
    gross = float(numbers_of(_HOSE).axial_factor * found.cord_tension[0] * stretch / cord)
    area = (gross - net) / float(found.fill_pressure[0])
    rubber = float(rubber_tension(1.0, area=1.0, modulus=1.0, law="neo-hookean"))
    return {
        ("eq 26", "rubber load", "over Ar Er at rest"): Answer(
            rubber, "every law of rubber that starts from rest"),
        ("eq 26", "end cap", "area over that inside the cords, pi dw^2 / 4 of the stretched hose"):
            Answer(
                area / (pi * _WRAP**2 / stretch / 4),
                "first term less the derivative of the energy of the cords, over the pressure",
                tolerance=1e-6,
            ),
    }  # fmt: skip


_FABRIC, _HOSE_CLAIMS = "nylon tire cord fabric", "stretch hose"

_MEDIUM, _HIGH = "medium high stretching hose", "high stretching hose"

_TEST = "sec 3.0"


def items() -> list[ReproducedItem]:
    """One item for every printed number of the report."""
    return items_from("WHOI-2004-06", _answers())


def _answers() -> Answers:
    """Expected value of every printed number."""
    return _equation_answers() | _cords() | _angles() | _tests()


def _cords() -> Answers:
    denier, bundle, cord, metres, per_inch, diameter = 840.0, 0.0933, 0.1867, 9000.0, 34.0, 0.022
    half = 0.5e-4  # of the linear densities
    setting = "a property of the fabric"
    both = "0.1867 over 0.0933 g/m of footnote 1"
    gap = 1 / (per_inch * diameter) - 1
    return {
        ("sec 1.1", _FABRIC, "gap between cords over the cord diameter"): Answer(
            gap, "1 / 34 in less 0.022 in, over 0.022 in; the tolerance is that of 34 and 0.022",
            tolerance=(1 + gap) * (0.5 / per_inch + 0.5e-3 / diameter)),
        ("sec 1.2.2", _FABRIC, "cords_per_length"): setting,
        ("sec 1.2.2", _FABRIC, "cord_diameter"): setting,
        ("sec 1.2.2", _FABRIC, "breaking strength of one cord"): setting,
        ("sec 1.2.2", _FABRIC, "breaking strength of the fabric"): Answer(
            30 * per_inch, "34 cords of about 30 lbf, which has one digit: 5 lbf a cord",
            tolerance=5 * per_inch),
        ("sec 1.2.2", _FABRIC, "cord_denier"): Answer(denier, "printed in footnote 1 too"),
        ("sec 1.2.2", _FABRIC, "number of plies"): Answer(cord / bundle, both),
        ("footnote 1", "denier", "length that is weighed"): Answer(
            denier / bundle, "840 over 0.0933 g/m, which is rounded",
            tolerance=denier / bundle**2 * half),
        ("footnote 1", _FABRIC, "cord_denier"): Answer(
            bundle * metres, "0.0933 g/m times 9000 m, rounded", tolerance=half * metres),
        ("footnote 1", "one fiber bundle of 840 denier", "linear density"): Answer(
            denier / metres, "840 g over 9000 m"),
        ("footnote 1", _FABRIC, "number of plies"): Answer(cord / bundle, both),
        ("footnote 1", _FABRIC, "linear density"): Answer(
            2 * denier / metres, "2 x 840 g over 9000 m"),
    }  # fmt: skip


def _angles() -> Answers:
    load = "load over the theoretical breaking strength"
    third = Answer(1 / 3, "printed three times: sec 1.2.4 and, for both hoses, 3.0")
    figure = "wrap_angle in the caption of Figure 11"
    return {
        ("sec 1.2.1", _HOSE_CLAIMS, "neutral wrap angle"): Answer(
            float(np.degrees(NEUTRAL_ANGLE)), "atan(sqrt 2): the slope of (8) is zero at rest"),
        ("sec 1.2.3", "cord around a cylinder", "wrap_angle in the text"): Answer(
            90.0, "(17) is (14) where the sine is one"),
        ("sec 1.2.3", "cord around a cylinder", "wrap_angle in the caption of Figure 9"): Answer(
            90.0, "90 degree in the text above the figure"),
        ("sec 1.2.3", "full wrap", "contact angle"): Answer(
            float(np.degrees(2 * np.pi)), "2 pi, the factor of (13)"),
        ("sec 1.2.4", "Snubber program", "least step of hose elongation"): "a setting",
        ("sec 1.2.4", "Snubber program", "greatest step of hose elongation"): "a setting",
        (
            "sec 1.2.4", _HOSE_CLAIMS, "safe working load over the breaking strength of the cords",
        ): third,
        (_TEST, _MEDIUM, load): third,
        (_TEST, _HIGH, load): third,
        ("sec 1.2.4", _HIGH, figure): Answer(68.0, "680 in sec 3.0, without its degree sign"),
        (_TEST, _HIGH, "wrap_angle"): Answer(68.0, "68 degree in the caption of Figure 11"),
        (_TEST, _MEDIUM, "wrap_angle"):
            "an angle from the axis is below 90 degrees, so that the 0 is a degree sign, as in 680",
        ("sec 2.0", _HOSE_CLAIMS, "temperature of the curing steam"):
            "3000 F melts the steel of the mandrel: the 0 is a degree sign, as in 680",
    }  # fmt: skip


def _tests() -> Answers:
    counted, place = "counted in a test, and printed once", "a fact of a deployment"
    sea = "an estimate for a sea that is not described"
    stretch = "maximum stretch"
    return {
        ("abstract", _HOSE_CLAIMS, "elastic stretch, from"):
            "a range of designs, whose least wrap angle is not given",
        ("abstract", _HOSE_CLAIMS, "elastic stretch, to"): Answer(
            130.0, "130% of the hose of 68 deg, sec 3.0"),
        (_TEST, "Snubber test hose of 1994", "length"): "a setting",
        (_TEST, "Snubber test hose of 1994", "flex cycles"): counted,
        (_TEST, "Snubber test hose of 1994", "tension cycles"): counted,
        (_TEST, "Snubber test hose of 1994", "flex angle"): "a setting",
        (_TEST, _MEDIUM, stretch): _stretch(64.0, 79.0),
        (_TEST, _HIGH, stretch): _stretch(68.0, 130.0),
        (_TEST, _MEDIUM, "cycle of the maximum stretch"): counted,
        (_TEST, _HIGH, "cycle of the maximum stretch"): counted,
        (_TEST, "mooring at sea", "tension cycles in a month"): sea,
        (_TEST, "mooring at sea", "flex cycles in a month"): sea,
        ("sec 4.0", "MOOS mooring of MBARI", "water_depth"): place,
        ("sec 4.0", "fish feed hose of the University of New Hampshire", "time in service"): place,
        ("sec 4.0", "fish feed hose of the University of New Hampshire", "tide"): place,
        ("sec 4.0", "taut surface mooring of 2004", "length"): place,
        ("sec 4.0", "taut surface mooring of 2004", "water_depth"): place,
    }  # fmt: skip


def _stretch(degrees: float, percent: float) -> str:
    """Say that a measured stretch is possible, which is all that can be said."""
    angle = np.radians(degrees)
    cord = 100 * (float(cord_stretch_ratio(1 + percent / 100, angle)) - 1)
    pick_up = 100 * (float(pick_up_stretch_ratio(angle)) - 1)
    return (
        "measured; neither cord curve nor load is given. Possible: (8) has the cords at "
        f"{cord:.2f} % there, beyond their pick-up at {pick_up:.1f} % of stretch and below break. "
        "No one cord strain gives both hoses their stretch: 130 / 79 is 1.65, (8) has 1.40 to 1.51"
    )
