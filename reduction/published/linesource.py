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

from reduction.lookup.linesurface import LineSurface
from reduction.lookup.product import LineCurve, LineSource
from reduction.lookup.surface import sigma_from_r2
from reduction.published.linecells import POUND
from reduction.published.linecurves import curves_of_line
from reduction.published.lineproduct import PublishedLine, PublishedSurface
from reduction.published.lines import published_lines
from reduction.published.linestrength import (
    is_documentation,
    levels_told,
    line_scatter,
    own_strength,
    scatter_told,
    strength_of,
    strengths_told,
)
from reduction.published.tether import PublishedTether, TetherSegment
from reduction.published.tethers import published_tethers
from reduction.surface.designs import box_behnken
from reduction.surface.terms import model_matrix, quadratic_exponents
from reduction.surface.variance import covariance_factor, variance_factor

_FACTORS = ("frequency", "mean_tension", "tension_amplitude")
_FREEDOM = 5.0
_FIRST = "ten cycles"
_FEWEST = 2.0
"""Lines of a surface, where a table says how many: two to four. [1]"""
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
    curves, absent = curves_of_line(line)
    for response, found in line.surfaces.items():
        if any(term.index == 0 for term in found.open_terms):
            (term,) = (one for one in found.open_terms if one.index == 0)
            absent[response] = f"its mean B1 is open ({term.erratum}): {term.note}"
        else:
            surfaces[response] = _surface(line, found)
    strength, told = own_strength(line)
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
        curves=curves,
        absent=absent,
        kind="rope",
        tensile_strength=strength,
        strength_of=strength_of(line),
        notes=(*strengths_told(line), *told, *scatter_told(line), *levels_told(line)),
    )


def _surface(line: PublishedLine, found: PublishedSurface) -> LineSurface:
    box, *others = found.boxes
    ends = [np.array([one.frequency, one.mean_tension, one.tension_amplitude]).T
            for one in (box, *others)]  # fmt: skip
    # levels are printed in whole pounds
    rounding = np.array([0.0, 0.5, 0.5]) * POUND
    known = np.array(found.coefficient)
    choices = []
    for chosen in product(*(range(len(term.values)) for term in found.open_terms)):
        one = known.copy()
        for term, place in zip(found.open_terms, chosen, strict=True):
            one[term.index] = term.values[place]
        choices.append(one)
    matrix = model_matrix(_DESIGN, _EXPONENTS)
    # a run at the printed level may have been half a pound beyond it
    edge = model_matrix(_DESIGN * (1 + 2 * rounding / (ends[0][1] - ends[0][0])), _EXPONENTS)
    names = tuple(f"B{number}" for number in range(1, len(_EXPONENTS) + 1))
    covariance = covariance_factor(matrix, names=names)
    notes = [
        f"open: B{term.index + 1} of {found.response}: {term.note}; the interval spans them"
        for term in found.open_terms
    ]
    if not np.isfinite(found.r2):
        notes.append("r2 is open: no interval can be given")
    if not found.passes_f_test:
        notes.append("the surface fails its F test at 5 %: it says no more than the mean")
    notes += [
        f"the tested levels are open: shares of {box.rated_break_strength:.0f} N (Table "
        f"{box.table}) or of {other.rated_break_strength:.0f} N (Table {other.table}); the "
        "intervals span both"
        for other in others
    ]
    scatter, n_lines = float("nan"), float(found.n_lines or "nan")
    if found.response == "apparent_spring_constant":
        scatter = line_scatter(line)
    if np.isfinite(n_lines):
        notes.append(f"the surface is of {n_lines:.0f} lines")
    elif np.isfinite(scatter):
        n_lines = _FEWEST
        notes.append(
            f"of how many lines the surface is, is not printed: {_FEWEST:.0f}, the fewest of any, "
            "are taken for the scatter between lines"
        )
    if is_documentation(line):
        notes.append(
            'reported "for documentation purposes but no inference is drawn from it": few lines, '
            "high variability (sec. 4.4.1)"
        )
    return LineSurface(
        quantity=found.response,
        coefficient=choices[0],
        exponents=_EXPONENTS,
        low=ends[0][0],
        high=ends[0][1],
        covariance_factor=covariance,
        sigma=sigma_from_r2(choices[0], found.r2),
        degrees_of_freedom=_FREEDOM,
        greatest_leverage=float(np.max(variance_factor(edge, covariance))),
        alternatives=np.array(choices[1:]).reshape(-1, known.size),
        alternative_boxes=tuple((low, high) for low, high in ends[1:]),
        rounding=rounding,
        line_scatter=scatter,
        n_lines=n_lines,
        errata=found.errata,
        notes=tuple(notes),
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
    notes = tuple(
        dict.fromkeys(f"remark on a printed cell: {note}" for one in rows for note in one.notes)
    )
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
