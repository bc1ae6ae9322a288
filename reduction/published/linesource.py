"""Published lines and tethers as sources of design values.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, Tables 5, 6.
"""

from __future__ import annotations

from functools import cache
from itertools import product

import numpy as np

from reduction.lookup.product import LineCurve, LineSource, LineSurface
from reduction.lookup.surface import sigma_from_r2
from reduction.published.lineproduct import PublishedCubic, PublishedLine, PublishedSurface
from reduction.published.lines import published_lines
from reduction.published.tether import PublishedTether, TetherSegment
from reduction.published.tethers import published_tethers
from reduction.surface.designs import box_behnken
from reduction.surface.terms import model_matrix, quadratic_exponents
from reduction.surface.variance import covariance_factor, variance_factor

__all__ = ["published_sources"]

_FACTORS = ("frequency", "mean_tension", "tension_amplitude")
_FREEDOM = 5.0
_FIRST = "ten cycles"
_OF_CUBIC = {"quasi_static_strain": "strain"}
_DESIGN = box_behnken(3).coded
_EXPONENTS = quadratic_exponents(3)


@cache
def published_sources() -> dict[str, LineSource]:
    """Every published line and tether of which something can be looked up, by name.

    Returns
    -------
    sources : dict of str to LineSource
        Lines of CG-D-39-80, then tethers of WHOI-2005-10, one a test and after 3,000 cycles.
    """
    sources = [_line(one) for one in published_lines()]
    sources += [
        one
        for tether in published_tethers()
        for condition, test in sorted(
            {(segment.name.condition, segment.name.test) for segment in tether.segments},
            key=lambda named: (named[0] != _FIRST, named[1]),
        )
        if (one := _tether(tether, test, condition)) is not None
    ]
    return {one.name: one for one in sources}


def _line(line: PublishedLine) -> LineSource:
    surfaces = {}
    absent = {_OF_CUBIC.get(name, name): why for name, why in line.absent.items()}
    for response, found in line.surfaces.items():
        if any(term.index == 0 for term in found.open_terms):
            (term,) = (one for one in found.open_terms if one.index == 0)
            absent[response] = f"its mean B1 is open ({term.erratum}): {term.note}"
        else:
            surfaces[response] = _surface(found)
    curves = []
    for cubic in (line.stiffness, line.load_strain):
        curve = None if cubic is None else _curve(cubic)
        if curve is not None:
            curves.append(curve)
        elif cubic is not None:
            why = "; ".join(term.note for term in cubic.open_terms) or "the range is"
            absent[_OF_CUBIC.get(cubic.quantity, cubic.quantity)] = f"open: {why}"
    has_stiffness = any(one.quantity == "quasi_static_spring_constant" for one in curves)
    strain = next((one for one in curves if one.quantity == "strain"), None)
    if strain is not None and not has_stiffness:
        curves.append(_slope(strain))
        absent.pop("quasi_static_spring_constant", None)
    return LineSource(
        name=line.name,
        source="CG-D-39-80",
        material=line.material,
        construction=line.construction,
        condition=line.condition,
        diameter=line.diameter,
        rated_break_strength=line.rated_break_strength,
        factor_names=_FACTORS,
        surfaces=surfaces,
        curves=tuple(curves),
        absent=absent,
        kind="rope",
        notes=(*_strengths(line), *_exposed(line)),
    )


def _strengths(line: PublishedLine) -> tuple[str, ...]:
    """What is said of the strength, where the tables do not agree."""
    found = sorted({round(one.value) for one in line.stated_strengths})
    if len(found) < 2:
        return ()
    listed = ", ".join(f"{one.value:.0f} N (Table {one.table})" for one in line.stated_strengths)
    return (
        f"the break strength is printed as {listed}; the tested levels are shares of "
        f"{line.rated_break_strength:.0f} N",
    )


def _exposed(line: PublishedLine) -> tuple[str, ...]:
    """What years in the sea did to the strength, and to how alike the lines are."""
    if line.condition == "new":
        return ()
    notes = [
        "exposed lines differ among each other by about half, new ones by a tenth (sec. 4.4.1); "
        "no interval has that in it"
    ]
    found = line.strength
    if found is not None and np.isfinite(found.tensile_strength):
        share = 100 * found.tensile_strength / line.rated_break_strength
        notes.append(
            f"lines in this condition break at {found.tensile_strength:.0f} N (Table "
            f"{found.table}), {share:.0f} % of the strength that shares and rule refer to"
        )
    return tuple(notes)


def _surface(found: PublishedSurface) -> LineSurface:
    box = found.boxes[0]
    known = np.array(found.coefficient)
    choices = []
    for chosen in product(*(range(len(term.values)) for term in found.open_terms)):
        one = known.copy()
        for term, place in zip(found.open_terms, chosen, strict=True):
            one[term.index] = term.values[place]
        choices.append(one)
    matrix = model_matrix(_DESIGN, _EXPONENTS)
    names = tuple(f"B{number}" for number in range(1, len(_EXPONENTS) + 1))
    covariance = covariance_factor(matrix, names=names)
    notes = [f"open: {term.note}; the interval spans them" for term in found.open_terms]
    if not np.isfinite(found.r2):
        notes.append("r2 is open: no interval can be given")
    if not found.passes_f_test:
        notes.append("the surface fails its F test at 5 %: it says no more than the mean")
    if len(found.boxes) > 1:
        other = found.boxes[1]
        notes.append(
            f"the tested levels are open: shares of {box.rated_break_strength:.0f} N (Table "
            f"{box.table}) or of {other.rated_break_strength:.0f} N (Table {other.table})"
        )
    return LineSurface(
        quantity=found.response,
        coefficient=choices[0],
        exponents=_EXPONENTS,
        low=np.array([box.frequency[0], box.mean_tension[0], box.tension_amplitude[0]]),
        high=np.array([box.frequency[1], box.mean_tension[1], box.tension_amplitude[1]]),
        covariance_factor=covariance,
        sigma=sigma_from_r2(choices[0], found.r2),
        degrees_of_freedom=_FREEDOM,
        greatest_leverage=float(np.max(variance_factor(matrix, covariance))),
        alternatives=np.array(choices[1:]).reshape(-1, known.size),
        errata=found.errata,
        notes=tuple(notes),
    )


def _curve(cubic: PublishedCubic) -> LineCurve | None:
    """None where a coefficient or the range is open; a constant that is open moves little."""
    coefficient, notes = np.array(cubic.coefficient), [cubic.note] if cubic.note else []
    if [term.index for term in cubic.open_terms] == [0]:
        (term,) = cubic.open_terms
        coefficient[0] = term.values[0]
        notes.append(f"open: {term.note}; the first is taken")
    if not (np.isfinite(coefficient).all() and np.isfinite(cubic.tension_high)):
        return None
    is_strain = cubic.quantity == "quasi_static_strain"
    return LineCurve(
        quantity=_OF_CUBIC.get(cubic.quantity, cubic.quantity),
        variable="tension" if is_strain else "mean_tension",
        low=0.0,
        high=cubic.tension_high,
        coefficient=coefficient,
        errata=cubic.errata,
        notes=tuple(notes),
    )


def _slope(strain: LineCurve) -> LineCurve:
    """K_0 from the slope of load on strain, for a line without a cubic of its own."""
    return LineCurve(
        quantity="quasi_static_spring_constant",
        variable="mean_tension",
        low=0.0,
        high=strain.high,
        coefficient=np.array(strain.coefficient),
        is_inverse_slope=True,
        errata=strain.errata,
        notes=(*strain.notes, "from the slope of load against strain: no K_0 that can be used"),
    )


def _tether(tether: PublishedTether, test: str, condition: str) -> LineSource | None:
    """Moduli of one test, of which a raw row stands for a consolidated one that is open."""
    for data in ("consolidated", "raw"):
        found = [
            one
            for one in tether.segments
            if one.name.test == test
            and one.name.data == data
            and one.name.condition == condition
            and not one.is_open
            and np.isfinite(one.modulus)
        ]
        if found:
            return _of_segments(tether, test, condition, data, found)
    return None


def _of_segments(
    tether: PublishedTether,
    test: str,
    condition: str,
    data: str,
    found: list[TetherSegment],
) -> LineSource:
    rows = sorted(found, key=lambda one: one.strain_low)
    ends = np.array([[one.strain_low, one.strain_high] for one in rows]).ravel()
    moduli = np.repeat([one.modulus for one in rows], 2)
    tensions = np.array([[one.tension_low, one.tension_high] for one in rows]).ravel()
    errata = tuple(dict.fromkeys(erratum for one in rows for erratum in one.errata))
    notes = tuple(dict.fromkeys(note for one in rows for note in one.notes))
    table = {"consolidated": "6", "raw": "5"}[data]
    keep = np.isfinite(tensions)
    curves = [
        LineCurve(
            "tangent_modulus", "strain", float(ends[0]), float(ends[-1]), at=ends, value=moduli,
            branch="ascending", errata=errata, notes=notes,
        )
    ]  # fmt: skip
    if keep.sum() > 1:
        curves.append(
            LineCurve(
                "branch_tension", "strain", float(ends[keep][0]), float(ends[keep][-1]),
                at=ends[keep], value=tensions[keep], branch="ascending", errata=errata,
                notes=notes,
            )
        )  # fmt: skip
    specimen = tether.specimen
    return LineSource(
        name=f"rubber-tether-{specimen.name}-{test}"
        + ("" if condition == _FIRST else f"-{condition.replace(' ', '-')}"),
        source=f"WHOI-2005-10, Table {table}, {test}, {condition}",
        material="rubber",
        construction="tether",
        condition=specimen.name if condition == _FIRST else f"{specimen.name}, {condition}",
        diameter=float(np.mean(specimen.diameter)),
        rated_break_strength=specimen.rated_break_strength or float("nan"),
        curves=tuple(curves),
        absent={
            "loss_factor": "no descending modulus is tabulated",
        },
        kind=specimen.kind,
        notes=(
            "moduli are chords of straight pieces of the ascending branch, with strain by a "
            "constant fraction of the position",
        ),
    )
