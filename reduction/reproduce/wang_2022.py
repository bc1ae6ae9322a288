"""Wang (2022) again: equations, and what the text says of angles, peaks and errors.

The forces of the paper are finite-element results in figures, and the core radius, on which every
moment depends, is not given.

References
----------
.. [1] H. Wang, Z. Yang, J. Yan, G. Wang, D. Shi, B. Zhou and Y. Li, "Prediction Method and
   Validation Study of Tensile Performance of Reinforced Armor Layer in Marine Flexible
   Pipe/Cables," J. Mar. Sci. Eng., vol. 10, 642, 2022.
"""

from __future__ import annotations

import numpy as np

from reduction.predict.armourerror import theory_errors
from reduction.record import Floats
from reduction.reproduce.answers import Answer, Answers, items_from
from reduction.reproduce.armour_equations import armour, equation_answers, response
from reduction.reproduce.item import Item

_AXIAL, _SHEAR, _BENDING, _TORSION = (
    "axial force T", "shear force N'", "bending moment G'", "torsion moment H",
)  # fmt: skip
_UMBILICAL, _PIPE, _HOSE = "umbilical", "flexible pipe", "cryogenic hose"
_NAMED = {_UMBILICAL: (20.0, 0.36, 50.51), _PIPE: (30.0, 0.62, 67.62), _HOSE: (80.0, 0.72, 8.44)}
"""Angle [deg], increase of the normal stress and decrease of the shear stress [%]."""
_FINE = np.arange(10.0, 80.001, 0.02)


def items() -> list[Item]:
    """One item for every printed number of the paper.

    Returns
    -------
    items : list of Item
        In the order of its cells.
    """
    return items_from("Wang-2022", answers())


def answers() -> Answers:
    """What every printed number ought to be.

    Returns
    -------
    answers : Answers
        By cell.
    """
    return _settings() | _trends() | _errors() | _complementary() | equation_answers()


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
    force = response(degrees, "axial_force")
    squared = float(np.corrcoef(degrees, force)[0, 1] ** 2)
    falls = float(np.sign(force[-1] - force[0]))
    place = "winding_angle of its peak"
    rod = "the rod that agrees with three-dimensional elasticity"
    peaks = {
        name: _peak(response(_FINE, name, theory="conjugate"))
        for name in ("bending_moment", "shear_force", "torsion_moment")
    }
    of_4 = _peak(response(_FINE, "shear_force"))
    return {
        ("sec 5.1", f"{_AXIAL}, numerical",
         "squared correlation with a straight line in the angle"): Answer(
            squared, "(16), a squared cosine, from 10 to 80 deg"),
        ("sec 5.1", f"{_AXIAL}, numerical", "sign of its change with the angle"): Answer(
            falls, "(16), and the first paragraph of the section"),
        ("sec 5.1", f"{_BENDING}, numerical", place): Answer(peaks["bending_moment"], rod),
        ("sec 5.1", f"{_SHEAR}, numerical", place): Answer(
            peaks["shear_force"], f"{rod}; {of_4:.1f} by that of (4)"),
        ("sec 5.1", f"{_TORSION}, numerical", place): Answer(
            peaks["torsion_moment"], f"{rod}; that of (4) has 22.5 and 67.5, and a zero at 45"),
    }  # fmt: skip


def _errors() -> Answers:
    linear = theory_errors(armour(_FINE), 1e-3).error[:2, 0, :, 0]
    missing = "a finite-element result is one side of it, and the core radius is not given"
    shear = "shear stress of intermediate angles"
    zero = float(_FINE[np.argmin(np.abs(response(_FINE, "torsion_moment")))])
    true = response(45.0, "torsion_stress", theory="conjugate")
    wrong = 100 * float(abs(response(45.0, "torsion_stress") / true - 1))
    largest = max(normal for _, normal, _ in _NAMED.values())
    found: Answers = {
        ("sec 5.2", f"{_AXIAL} of small and intermediate angles", "greatest error"): Answer(
            100 * float(np.max(np.abs(linear))),
            "against the rod that both simplify, from 10 to 80 deg; the finite elements are absent",
            bound="below"),
        ("sec 5.3", "normal stress of intermediate angles", "greatest error"): Answer(
            largest, "the greatest of the three that the section names", bound="below"),
        ("sec 5.3", shear, "greatest error"): Answer(
            wrong, "the theory is nothing at 45 deg, and no wire is: "
            "the rod that agrees with three-dimensional elasticity has G J strain / (4 r)"),
        ("sec 5.3", shear, "winding_angle at which it is greatest"): Answer(
            zero, "where the torsion moment of (4) and (15) is nothing, "
            "so that it misses all of any other; near 20 deg it misses more of a small one"),
    }  # fmt: skip
    for row in _NAMED:
        for column in ("increase of the normal stress", "decrease of the shear stress"):
            found["sec 5.3", row, column] = missing
    return found


def _complementary() -> Answers:
    names = {_BENDING: "bending_moment", _SHEAR: "shear_force", _TORSION: "torsion_moment"}
    pair = np.array([20.0, 70.0])
    found: Answers = {}
    for row, name in names.items():
        low, high = response(pair, name)
        found["sec 5.2", row, "at 20 deg over at 70 deg"] = Answer(
            float(low / high), "theory of intermediate angles", meaning=1.0
        )
    return found
