"""Recomputation of Wang (2022): equations, and claims on angles, peaks and errors.

The forces of the paper are finite-element results in figures, and the core radius, on which every
moment depends, is not given.
"""

from __future__ import annotations

from math import pi

import numpy as np

from reduction.prediction.armour import (
    ArmourDesign,
    ArmourTheory,
    layer_strength,
    predict_armour,
    theory_errors,
)
from reduction.published.reproduced_item import (
    Answer,
    Answers,
    ReproducedItem,
    items_from,
    log_slope,
)
from reduction.record.measurement import Floats

ELASTIC_MODULUS, POISSON_RATIO = 210_000e6, 0.3
"""Table 1; the modulus in [Pa]."""

_WIRE, _STRAIN = 2.5e-3, 1e-3  # sections 4.1 and 4.2

_HELIX = 27.5e-3  # assumed

_DEGREES = 20.0

_ANGLE = float(np.radians(_DEGREES))

_SINE, _COSINE, _TANGENT = float(np.sin(_ANGLE)), float(np.cos(_ANGLE)), float(np.tan(_ANGLE))

_BENDING, _TORSION = "bending moment G'", "torsion moment H"


def _armour(degrees: float | Floats, *, wire: float = _WIRE) -> ArmourDesign:
    """Steel wires of the paper on a core of assumed radius."""
    return ArmourDesign(
        np.radians(degrees), wire, _HELIX - wire, ELASTIC_MODULUS, poisson_ratio=POISSON_RATIO
    )


def _response(
    degrees: float | Floats,
    quantity: str,
    *,
    theory: ArmourTheory = "intermediate",
    wire: float = _WIRE,
) -> Floats:
    """One quantity of a wire at the strain of the paper."""
    found = predict_armour(_armour(degrees, wire=wire), _STRAIN, theory=theory)
    return np.asarray(getattr(found, quantity)[..., 0])


def _equation_answers() -> Answers:
    """Answers to the factors and the powers of equations (2) to (29), and of section 5.3."""
    return _geometry() | _stiffness() | _intermediate() | _stresses() | _small() | _spring()


def _at(quantity: str, theory: ArmourTheory = "intermediate", degrees: float = _DEGREES) -> float:
    return float(_response(degrees, quantity, theory=theory))


def _geometry() -> Answers:
    angle = np.radians([30.0, 60.0])
    pitch, curvature = [], []
    for one in angle:
        along = 1 / np.tan(one)
        pitch.append(2 * pi * along)
        first, second = np.array([0.0, 1.0, along]), np.array([-1.0, 0.0, 0.0])
        curvature.append(np.linalg.norm(np.cross(first, second)) / np.linalg.norm(first) ** 3)
    helix = "a helix whose angle is from the axis, as sections 1 and 3 have it"
    change = _at("angle_change", "exact")
    current = _at("current_winding_angle", "exact")
    wire_strain = _at("wire_strain", "exact")
    ratio = float(np.cos(current)) / _COSINE
    second_order = (ratio - (1 + _STRAIN - wire_strain)) / (wire_strain * (wire_strain - _STRAIN))
    return {
        ("sec 2", "thread pitch h", "power of tan(alpha)"): Answer(
            log_slope(np.tan(angle), np.array(pitch)), helix, tolerance=1e-9),
        ("eq 2", "curvature", "power of sin(alpha)"): Answer(
            log_slope(np.sin(angle), np.array(curvature)), helix),
        ("eq 9", "change of the winding angle", "sign of its definition, current less rest"):
            Answer((current - _ANGLE) / change, "exact helix", tolerance=1e-9),
        ("eq 10", "axial and rotation strain", "equations that are linearised, from"): Answer(
            7.0, "strain and rotation are (7) and (8); (9) is a cosine"),
        ("eq 21", "current over rest cosine, small angles",
         "factor of the second order, wire strain x (wire strain - strain)"): Answer(
            second_order, "exact helix at a strain of 0.001", tolerance=10 * _STRAIN),
    }  # fmt: skip


def _stiffness() -> Answers:
    whole = pi * _WIRE**4 * ELASTIC_MODULUS
    design = _armour(_DEGREES)
    round_wire = "stiffness of a round wire"
    return {
        ("eq 4", _BENDING, "divisor of pi R2^4 E"): Answer(
            whole / float(design.bending_stiffness), round_wire + " in bending"),
        ("eq 4", _TORSION, "divisor of pi R2^4 E"): Answer(
            whole / float(design.torsion_stiffness), round_wire + " in torsion, E / (2 (1 + nu))"),
    }  # fmt: skip


def _intermediate() -> Answers:
    how = "theory of intermediate angles of the package"
    pair = np.array([20.0, 50.0])
    tangents = np.tan(np.radians(pair))
    strain = _response(pair, "wire_strain") / _STRAIN
    change = _response(pair, "angle_change") / (_STRAIN * tangents)
    common = _STRAIN * _TANGENT / (1 + _TANGENT**2)
    curvature, torsion = _at("curvature_change") * _HELIX, _at("torsion_change") * _HELIX
    moment = ELASTIC_MODULUS * pi * _WIRE**4 * _STRAIN / _HELIX
    share = moment * _COSINE**2 * _TANGENT**2 / (1 + _TANGENT**2)
    answers: Answers = {
        ("eq 12", "wire strain", "power of tan(alpha)"): Answer(
            log_slope(tangents, 1 / strain - 1), how),
        ("eq 13", "change of the winding angle", "power of tan(alpha) in the divisor"): Answer(
            log_slope(tangents, -1 / change - 1), how),
        ("eq 14", "change of curvature", "factor"): Answer(
            curvature / (_SINE * _COSINE * common), how),
        ("eq 15", "change of torsion", "factor of the squared cosine"): Answer(
            (1 - torsion / common) / _COSINE**2, how),
        ("eq 16", _BENDING, "divisor"): Answer(-share / _at("bending_moment"), how),
    }  # fmt: skip
    for degrees in (20.0, 80.0):
        at = f"at {degrees:g} deg"
        answers["eq 16", _TORSION, f"over E pi R2^4 strain / r, {at}"] = Answer(
            _at("torsion_moment", degrees=degrees) / moment, how
        )
        answers["eq 16", "shear force N'", f"over E pi R2^4 strain / (4 r^2), {at}"] = Answer(
            4 * _HELIX * _at("shear_force", degrees=degrees) / moment, how
        )
    return answers


def _stresses() -> Answers:
    how = "theory of intermediate angles of the package"
    section = pi * _WIRE**3
    size = ELASTIC_MODULUS * _WIRE * _STRAIN / _HELIX
    bending, torsion = _at("bending_stress"), _at("torsion_stress")
    share = _COSINE**2 * _TANGENT**2 / (1 + _TANGENT**2)
    bent, twisted = "stress of the bending moment", "stress of the torsion moment"
    return {
        ("eq 18", bent, "factor of G' / (pi R2^3)"): Answer(
            bending * section / _at("bending_moment"), how),
        ("eq 18", bent, "factor of E R2 strain"): Answer(bending / (size * share), how),
        ("eq 19", twisted, "factor of H / (pi R2^3)"): Answer(
            torsion * section / _at("torsion_moment"), how),
        ("eq 19", twisted, "over E R2 strain / r, at 20 deg"): Answer(torsion / size, how),
    }  # fmt: skip


def _small() -> Answers:
    how = "theory of small angles of the package"
    pair = np.array([10.0, 20.0])
    change = _at("angle_change", "small")
    bending = _at("bending_moment", "small") / (pi / 4 * ELASTIC_MODULUS * _WIRE**4)
    per_change = _at("torsion_change", "small") * _HELIX / change
    wires = np.array([2e-3, 3e-3])
    moments = [_response(_DEGREES, "torsion_moment", theory="small", wire=one) for one in wires]
    return {
        ("eq 20", "wire strain, small angles", "power of cos(alpha)"): Answer(
            log_slope(np.cos(np.radians(pair)), _response(pair, "wire_strain", theory="small")),
            how),
        ("eq 22", _BENDING, "factor"): Answer(bending * _HELIX / (_SINE * _COSINE * change), how),
        ("eq 22", _TORSION, "power of R2"): Answer(log_slope(wires, np.array(moments)), how),
        ("eq 22", _TORSION, "factor of the squared cosine, after 1"): Answer(
            (per_change + 1) / _COSINE**2, how),
    }  # fmt: skip


def _spring() -> Answers:
    how = "close-coiled spring of the package"
    force = _at("tension", "large")
    shear_modulus = ELASTIC_MODULUS / (2 * (1 + POISSON_RATIO))
    constant = force / (_STRAIN * 2 * pi * _HELIX / _TANGENT)
    size = _STRAIN * ELASTIC_MODULUS * _WIRE**4 * pi / (_HELIX**2 * (1 + POISSON_RATIO) * _TANGENT)
    cosines = np.cos(np.radians([20.0, 80.0]))
    strength = layer_strength(_armour(np.array([20.0, 80.0])), 800e6)
    answers: Answers = {
        ("eq 24", "spring constant k", "divisor of G R2^4"): Answer(
            shear_modulus * _WIRE**4 / _HELIX**3 / constant, how),
        ("eq 25", "force of the spring f", "divisor"): Answer(size / force, how),
        ("eq 28", "stress of the axial force of the spring", "divisor"): Answer(
            size * _COSINE / (pi * _WIRE**2) / _at("axial_stress", "large"), how),
        ("sec 5.3", "strength of the layer F", "power of cos(alpha)"): Answer(
            log_slope(cosines, strength), "part of the axial force along the cable",
            tolerance=1e-9),
    }  # fmt: skip
    for degrees in (20.0, 80.0):
        moment = _at("torsion_moment", "large", degrees)
        answers["eq 26", f"{_TORSION} of the spring", f"over f r, at {degrees:g} deg"] = Answer(
            moment / (_at("tension", "large", degrees) * _HELIX), how
        )
    return answers


_AXIAL, _SHEAR, _BENDING_CLAIM, _TORSION_CLAIM = (
    "axial force T", "shear force N'", "bending moment G'", "torsion moment H",
)  # fmt: skip

_UMBILICAL, _PIPE, _HOSE = "umbilical", "flexible pipe", "cryogenic hose"

_NAMED = {_UMBILICAL: (20.0, 0.36, 50.51), _PIPE: (30.0, 0.62, 67.62), _HOSE: (80.0, 0.72, 8.44)}
"""Angle [deg], increase of the normal stress and decrease of the shear stress [%]."""

_FINE = np.arange(10.0, 80.001, 0.02)


def items() -> list[ReproducedItem]:
    """One item for every printed number of the paper."""
    return items_from("Wang-2022", _answers())


def _answers() -> Answers:
    """Expected value of every printed number."""
    return _settings() | _trends() | _errors() | _complementary() | _equation_answers()


def _settings() -> Answers:
    rods, springs = "helices that are taken as rods", "helices that are taken as springs"
    elements, usual = "finite element model", "usual angles, quoted"
    first, last = "winding_angle, from", "winding_angle, to"
    setting = "a setting"
    found: Answers = {
        ("sec 4", "theory used in the offshore engineering industry", "number of its reference"):
            Answer(9.0, "section 1 gives [9] to [11] to Knapp and [8] to Cardou"),
        ("sec 4.1", elements, first): Answer(10.0, "the least of the nine angles of section 5"),
        ("sec 4.1", elements, last): Answer(80.0, "the greatest of the nine angles of section 5"),
        ("sec 4.1", elements, "step of the winding_angle"): Answer(
            10.0, "steps of the nine angles of section 5; 45 deg is between two"),
        ("sec 4.1", elements, "wire_radius"): setting,
        ("sec 4.1", elements, "number of elements along the axis"): setting,
        ("sec 4.2", elements, "axial strain"): setting,
    }  # fmt: skip
    for name in ("elastic_modulus", "poisson_ratio", "density"):
        found["1", "steel of the wires", name] = "a property of the steel"
    for (table, small, large), other in (
        (("sec 1", rods, springs), "sec 3.2"),
        (("sec 3.2", "theory of small angles", "theory of large angles"), "sec 1"),
    ):
        limits = ((small, 0.0, 20.0), (large, 70.0, 90.0))
        for row, low, high in limits:
            found[table, row, first] = Answer(low, f"printed in {other} too")
            found[table, row, last] = Answer(high, f"printed in {other} too")
    for row, (degrees, _, _) in _NAMED.items():
        found["sec 2", row, first] = found["sec 2", row, last] = usual
        found["sec 5.3", row, "winding_angle"] = (
            f"a setting; {degrees:g} deg is among the usual angles of section 2"
        )
    return found


def _peak(values: Floats) -> float:
    return float(_FINE[np.argmax(np.abs(values))])


def _trends() -> Answers:
    degrees = np.arange(10.0, 80.001, 0.5)
    force = _response(degrees, "axial_force")
    squared = float(np.corrcoef(degrees, force)[0, 1] ** 2)
    falls = float(np.sign(force[-1] - force[0]))
    place = "winding_angle of its peak"
    rod = "the rod that agrees with three-dimensional elasticity"
    peaks = {
        name: _peak(_response(_FINE, name, theory="conjugate"))
        for name in ("bending_moment", "shear_force", "torsion_moment")
    }
    of_4 = _peak(_response(_FINE, "shear_force"))
    return {
        ("sec 5.1", f"{_AXIAL}, numerical",
         "squared correlation with a straight line in the angle"): Answer(
            squared, "(16), a squared cosine, from 10 to 80 deg"),
        ("sec 5.1", f"{_AXIAL}, numerical", "sign of its change with the angle"): Answer(
            falls, "(16), and the first paragraph of the section"),
        ("sec 5.1", f"{_BENDING_CLAIM}, numerical", place): Answer(peaks["bending_moment"], rod),
        ("sec 5.1", f"{_SHEAR}, numerical", place): Answer(
            peaks["shear_force"], f"{rod}; {of_4:.1f} by that of (4)"),
        ("sec 5.1", f"{_TORSION_CLAIM}, numerical", place): Answer(
            peaks["torsion_moment"], f"{rod}; that of (4) has 22.5 and 67.5, and a zero at 45"),
    }  # fmt: skip


def _errors() -> Answers:
    linear = theory_errors(_armour(_FINE), 1e-3)[:2, 0, :, 0]
    missing = "a finite-element result is one side of it, and the core radius is not given"
    shear = "shear stress of intermediate angles"
    zero = float(_FINE[np.argmin(np.abs(_response(_FINE, "torsion_moment")))])
    true = _response(45.0, "torsion_stress", theory="conjugate")
    wrong = 100 * float(abs(_response(45.0, "torsion_stress") / true - 1))
    largest = max(normal for _, normal, _ in _NAMED.values())
    found: Answers = {
        ("sec 5.2", f"{_AXIAL} of small and intermediate angles", "greatest error"): Answer(
            100 * float(np.max(np.abs(linear))),
            "against the rod that both simplify, from 10 to 80 deg; the finite elements are absent",
            bound="below"),
        ("sec 5.3", "normal stress of intermediate angles", "greatest error"): Answer(
            largest, "the greatest of the three that the section names", bound="below"),
        ("sec 5.3", shear, "greatest error"): Answer(
            wrong, "the moment of the theory is zero at 45 deg, that of a wire is not: "
            "the rod that agrees with three-dimensional elasticity has G J strain / (4 r)"),
        ("sec 5.3", shear, "winding_angle at which it is greatest"): Answer(
            zero, "where the torsion moment of (4) and (15) is zero, "
            "so that it misses all of any other; near 20 deg it misses more of a small one"),
    }  # fmt: skip
    for row in _NAMED:
        for column in ("increase of the normal stress", "decrease of the shear stress"):
            found["sec 5.3", row, column] = missing
    return found


def _complementary() -> Answers:
    names = {
        _BENDING_CLAIM: "bending_moment",
        _SHEAR: "shear_force",
        _TORSION_CLAIM: "torsion_moment",
    }
    pair = np.array([20.0, 70.0])
    found: Answers = {}
    for row, name in names.items():
        low, high = _response(pair, name)
        found["sec 5.2", row, "at 20 deg over at 70 deg"] = Answer(
            float(low / high), "theory of intermediate angles", meaning=1.0
        )
    return found
