"""Equations of WHOI-2004-06 against the geometry and the statics of the package.

A power is the slope of a logarithm, a factor the quotient of the whole by what it is a factor of.
Lengths are in inches and loads in pounds; the hose is one of 3.5 in between its cords, which the
report does not give, and no answer here depends on it.
"""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np

from reduction.predict.cord import cord_stretch_ratio
from reduction.predict.cordcurve import CordCurve
from reduction.predict.hose import hose_energy, predict_hose
from reduction.predict.hoseloads import numbers_of
from reduction.predict.product import HoseDesign, HosePrediction
from reduction.predict.rubber import rubber_tension
from reduction.predict.wrapangle import current_wrap_angle
from reduction.record import Floats
from reduction.reproduce.answers import Answer, Answers, log_slope

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
_AXIAL = 1e-4  # rad: a wrap angle at which the second term of (8) is nothing


def equation_answers() -> Answers:
    """Answers to the factors and the powers of equations (5) to (26).

    Returns
    -------
    answers : Answers
        By cell.
    """
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
    """Cord of unit tension on a cylinder: its line load is one over the radius."""
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
            whole / pi, "sum of the line load; its resultant, which (12) gives, is nothing"),
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
    """Pressure, freed of all that (24) has beside the sine and the factor."""
    whole = found.fill_pressure * (1 + found.strain) * (1 + found.cord_strain) / found.cord_tension
    return float(whole[0])


def _powers_over_stretch() -> tuple[Floats, Floats, float]:
    """Of the squared sine in lambda_c with dw, then with lambda_h; of dw squared in lambda_c."""
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
