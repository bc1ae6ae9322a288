r"""Search for lines by material, construction, diameter; comparison of two lines.

**Difference and ratio of two lines at the same points, and whether they exceed their intervals.**
The limits of a difference follow from those of the two values, for each side separately, without
the errors that are known by name.  Of these only the difference of the contributions counts, since
one load cell under both moves them together:

.. math:: L = d - \sqrt{(b - l_b)^2 + (u_a - a)^2 + 1.96^2 \textstyle\sum_k (c_{bk} - c_{ak})^2},
          \qquad U = d + \sqrt{(u_b - b)^2 + (a - l_a)^2 +
          1.96^2 \textstyle\sum_k (c_{bk} - c_{ak})^2}, \qquad d = b - a

Where the parts of both are known and both intervals are symmetric, as for a curve or a surface of a
campaign, the interval is Student's t with the degrees of freedom of all parts together.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, Table 2; sec. 4.4.1, Tables 4, 5.
.. [2] G. Y. Zou and A. Donner, "Construction of Confidence Limits about Effect Measures: A General
   Approach," Statistics in Medicine, vol. 27, no. 10, pp. 1693-1702, 2008.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from reduction.lines.line_curve import (
    End,
    half_width_of_parts,
    is_even,
    own_half_width,
    shared_half_width,
    shared_of,
)
from reduction.lines.lookup_product import DesignValues, LineLevels, LineSource
from reduction.quantities.units import parse_quantity
from reduction.record.contributions import within
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Bools, Floats, read_only_arrays

DIAMETER_TOLERANCE = 0.03
"""Share within which two diameters are one size: 13 mm stands for 1/2 in, 2.4 % apart. [1]"""

_ROUNDING = 1e-9

_WORD = re.compile(r"[^\W_]+")


def find_lines(
    lines: Iterable[LineSource],
    *,
    material: str | None = None,
    construction: str | None = None,
    condition: str | None = None,
    diameter: float | None = None,
    tolerance: float = DIAMETER_TOLERANCE,
) -> list[LineSource]:
    """Lines that meet all criteria.

    Notes
    -----
    Sizes are nominal ([1]_, Table 2).  Sizes in inches are 1/16 in or more apart: the default joins
    names of one size in two systems, and separates two sizes up to 2 in.

    Examples
    --------
    >>> rope = LineSource("a", "", "Nylon 6", "double-braid", "new", 0.0127, 28e3)
    >>> [one.name for one in find_lines([rope], material="nylon", diameter=0.013)]
    ['a']
    """
    if diameter is not None and not diameter > 0:
        raise SettingsError(
            "a diameter is not positive", found=f"{diameter:g} m", needed="above zero"
        )
    if not tolerance >= 0:
        raise SettingsError(
            "the tolerance of a diameter is negative", found=f"{tolerance:g}", needed="0 or above"
        )
    known = list(lines)
    asked = {"material": material, "construction": construction, "condition": condition}
    words = {name: text for name, text in asked.items() if text is not None}
    found = [
        one
        for one in known
        if all(_has_words(getattr(one, name), text) for name, text in words.items())
        and (diameter is None or abs(one.diameter - diameter) <= (tolerance + _ROUNDING) * diameter)
    ]
    if not found:
        sizes = [] if diameter is None else [f"diameter {1e3 * diameter:.4g} mm within "
                                             f"{100 * tolerance:.3g} %"]  # fmt: skip
        raise SettingsError(
            "no line matches",
            found="; ".join([*(f"{name} '{text}'" for name, text in words.items()), *sizes]),
            needed=_there_is(known),
        )
    return found


def names_with_words(text: str, names: Iterable[str]) -> list[str]:
    """Names that contain every word of a text.

    Examples
    --------
    >>> names_with_words("Nylon new", ["nylon-double-braid-0.5in-new", "polyester-new"])
    ['nylon-double-braid-0.5in-new']
    """
    words = text.lower().replace("-", " ").split()
    return [name for name in names if all(word in name for word in words)]


def _has_words(text: str, wanted: str) -> bool:
    there = _WORD.findall(text.lower())
    return all(
        any(word == one or (word.isalpha() and one.startswith(word)) for one in there)
        for word in _WORD.findall(wanted.lower())
    )


def _there_is(lines: Sequence[LineSource]) -> str:
    """Choices that exist."""
    parts = []
    for name in ("material", "construction", "condition"):
        texts = dict.fromkeys(getattr(one, name) for one in lines if getattr(one, name))
        if texts:
            parts.append(f"{name} {' or '.join(texts)}")
    sizes = sorted({f"{1e3 * one.diameter:.4g}" for one in lines if one.diameter > 0}, key=float)
    if sizes:
        parts.append(f"diameter {', '.join(sizes)} mm")
    return "; ".join(parts) or "lines of which more is known"


SAME_TEMPERATURE = 2.0
"""Greatest difference of two equal temperatures: the variation in a room. [K]"""


def in_conditions(
    line: LineSource, quantity: str, asked: Mapping[str, str], *, is_flagged: bool = False
) -> LineSource:
    """The part of a line that was tested in the requested conditions.

    Of tests at single levels, those under these conditions remain.

    The line itself where no condition is given.

    Examples
    --------
    >>> rope = LineSource("rope", "", "nylon", "", "new", 0.05, 3e5, conditions={"medium": "wet"})
    >>> in_conditions(rope, "strain", {"medium": "wet"}) is rope
    True
    >>> in_conditions(rope, "strain", {"medium": "dry"}, is_flagged=True).warnings
    ('NOT TESTED at medium dry: the value is of medium wet',)
    """
    if not asked:
        return line
    levels = []
    for one in line.levels:
        rows = [row for row, own in enumerate(one.conditions) if _is_condition(own, asked)]
        levels.append(one if len(rows) == len(one.tests) else _only(one, rows))
    of_levels = next((one for one in levels if one.quantity == quantity), None)
    is_so = bool(of_levels.tests) if of_levels else _is_condition(line.conditions, asked)
    if is_so:
        return replace(line, levels=tuple(levels)) if of_levels else line
    stated = conditions_of(line, quantity)
    found = ", ".join(f"{name} {text}" for name, text in asked.items())
    tested = ", ".join(f"{name} {stated.get(name, 'not stated')}" for name in asked)
    if is_flagged:
        warning = f"NOT TESTED at {found}: the value is of {tested}"
        return replace(line, warnings=(warning, *line.warnings))
    raise DataError(
        f"{quantity} of {line.name} was not tested in these conditions", found=found, needed=tested,
        hint="Stiffness depends on it; --extrapolate flag gives what was tested, flagged.",
    )  # fmt: skip


def _only(levels: LineLevels, rows: list[int]) -> LineLevels:
    """Some of the tests."""
    return replace(
        levels, at=levels.at[rows], value=levels.value[rows],
        random_standard_uncertainty=levels.random_standard_uncertainty[rows],
        degrees_of_freedom=levels.degrees_of_freedom[rows],
        contribution=levels.contribution[:, rows] if levels.component else levels.contribution,
        tests=tuple(levels.tests[row] for row in rows),
        conditions=tuple(levels.conditions[row] for row in rows),
        warnings=tuple(levels.warnings[row] for row in rows if levels.warnings),
    )  # fmt: skip


def _is_condition(own: Mapping[str, str], asked: Mapping[str, str]) -> bool:
    """Whether every test of a line was made under these conditions."""
    media = own.get("medium", "").split(_AND)
    if not all(_has_words(one, asked["medium"]) for one in media if "medium" in asked):
        return False
    if "temperature" not in asked:
        return True
    wanted = parse_quantity(asked["temperature"], "temperature")
    try:
        known = [
            parse_quantity(one, "temperature") for one in own.get("temperature", "").split(_AND)
        ]
    except SettingsError:
        return False  # not stated, or stated in words
    return all(abs(one - wanted) <= SAME_TEMPERATURE + _ROUNDING for one in known)


_AND = "; "


def joined_conditions(every: Iterable[Mapping[str, str]]) -> dict[str, str]:
    """Conditions of several tests; those that differ are listed together.

    Examples
    --------
    >>> joined_conditions([{"medium": "wet", "date": "May"}, {"medium": "wet", "date": "June"}])
    {'medium': 'wet', 'date': 'May; June'}
    """
    tests = list(every)
    names = dict.fromkeys(name for one in tests for name in one)
    return {
        name: _AND.join(dict.fromkeys(one[name] for one in tests if name in one)) for name in names
    }


def conditions_of(line: LineSource, quantity: str) -> dict[str, str]:
    """Conditions in which a quantity of a line was tested."""
    levels = next((one for one in line.levels if one.quantity == quantity), None)
    return joined_conditions(levels.conditions if levels else (line.conditions,))


_RANDOM_OF: dict[tuple[End, End], str] = {
    ("surface_low", "surface_high"): "random_standard_uncertainty",
    ("low", "high"): "run_standard_uncertainty",
}
"""Part of an interval that is not shared with other values, where known."""


@dataclass(frozen=True)
@read_only_arrays
class LineDifference:
    """Values of one quantity of two lines.  Arrays have the shape (...) of the points.

    Parameters
    ----------
    quantity, unit : str
        Of both lines, in SI.
    first, second : DesignValues
        Values as looked up.
    difference : ndarray
        The second less the first. [unit]
    ratio : ndarray
        The second over the first; NaN where that is zero. [1]
    surface_low, surface_high : ndarray
        95 % interval of the difference of the two surfaces; NaN where one has none. [unit]
    low, high : ndarray
        The same for one more run of the same specimens. [unit]
    kind_low, kind_high : ndarray
        The same for the means of all lines of the two kinds, with the scatter between lines. [unit]
    line_low, line_high : ndarray
        The same for another line of each kind. [unit]
    is_known, is_test_known, is_kind_known, is_line_known : ndarray of bool
        Both lines have that interval.
    is_different, is_test_different, is_kind_different, is_line_different : ndarray of bool
        Zero is outside the interval of the surfaces, of one more run, of the kinds, or of another
        line of each.
    notes : tuple of str
        Treatment of shared errors.
    """

    quantity: str
    unit: str
    first: DesignValues
    second: DesignValues
    difference: Floats
    ratio: Floats
    surface_low: Floats
    surface_high: Floats
    low: Floats
    high: Floats
    kind_low: Floats
    kind_high: Floats
    line_low: Floats
    line_high: Floats
    is_known: Bools
    is_test_known: Bools
    is_kind_known: Bools
    is_line_known: Bools
    is_different: Bools
    is_test_different: Bools
    is_kind_different: Bools
    is_line_different: Bools
    notes: tuple[str, ...] = ()

    @property
    def is_inside(self) -> Bools:
        """Inside the tested ranges of both."""
        return np.asarray(self.first.is_inside & self.second.is_inside)


def compare_values(
    first: DesignValues, second: DesignValues, *, campaigns: tuple[str, str] = ("", "")
) -> LineDifference:
    """Difference and ratio of two lines at the points of two look-ups.

    Notes
    -----
    Values of two campaigns share the errors of instruments that both name; those of their specimens
    and of instruments without a name are independent, even where they are called the same.
    Limits by [2]_, which needs only the two intervals and holds where they are not symmetric: a
    surface transformed back from a logarithm, or an open coefficient.  For two normal values with
    the same degrees of freedom the half width is Student's t of these times the root of the summed
    variances, which never covers less than 95 %.  A difference of two surfaces is one of the tested
    lines; only the intervals of the kinds show whether the kinds differ, since they include the
    scatter within a kind ([1]_, sec. 4.4.1: K_ap of new lines by about 10 %, after years in the sea
    by 50 %).

    Examples
    --------
    Table 5 of [1]_: plaited polyester line is 30 % stiffer after four years.

    >>> from reduction.lines.line_lookup import look_up
    >>> from reduction.lines.lookup_product import LineCurve, LineSource
    >>> def line(value):
    ...     at, moduli = np.array([0, 1]), np.full(2, value)
    ...     curve = LineCurve("tangent_modulus", "strain", 0, 1, at=at, value=moduli)
    ...     return LineSource("a", "", "polyester", "", "", 0.0127, 29e3, curves=(curve,))
    >>> values = [look_up(line(one), "tangent_modulus", strain=0.5) for one in (6.317, 8.252)]
    >>> print(compare_values(*values).ratio.round(3))
    1.306
    """
    is_of_two = all(campaigns) and campaigns[0] != campaigns[1]
    if is_of_two:
        first, second = (
            replace(one, component=tuple(within(error, name) for error in one.component))
            for one, name in zip((first, second), campaigns, strict=True)
        )
    difference = second.value - first.value
    shared = shared_of({"first": first, "second": second})
    rows, of = shared.values["second"] - shared.values["first"], shared.degrees_of_freedom
    surface_low, surface_high = _limits(first, second, rows, of, ("surface_low", "surface_high"))
    low, high = _limits(first, second, rows, of, ("low", "high"))
    kind_low, kind_high = _limits(first, second, rows, of, ("kind_low", "kind_high"))
    line_low, line_high = _limits(first, second, rows, of, ("line_low", "line_high"))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(first.value != 0, second.value / first.value, np.nan)
    return LineDifference(
        quantity=first.quantity,
        unit=first.unit,
        first=first,
        second=second,
        difference=np.asarray(difference),
        ratio=np.asarray(ratio),
        surface_low=surface_low,
        surface_high=surface_high,
        low=low,
        high=high,
        kind_low=kind_low,
        kind_high=kind_high,
        line_low=line_low,
        line_high=line_high,
        is_known=_known(surface_low, surface_high),
        is_test_known=_known(low, high),
        is_kind_known=_known(kind_low, kind_high),
        is_line_known=_known(line_low, line_high),
        is_different=_apart(surface_low, surface_high),
        is_test_different=_apart(low, high),
        is_kind_different=_apart(kind_low, kind_high),
        is_line_different=_apart(line_low, line_high),
        notes=_notes(first, second, is_of_two=is_of_two),
    )


def _known(low: Floats, high: Floats) -> Bools:
    return np.asarray(np.isfinite(low) & np.isfinite(high))


def _apart(low: Floats, high: Floats) -> Bools:
    """Whether zero is outside; NaN is neither above nor below."""
    return np.asarray((low > 0) | (high < 0))


def _limits(
    first: DesignValues, second: DesignValues, rows: Floats, of: Floats, ends: tuple[End, End]
) -> tuple[Floats, Floats]:
    """Ends of an interval of the difference: shared errors by their difference, the rest apart."""
    difference = np.asarray(second.value - first.value)
    if ends in _RANDOM_OF and is_even(first) and is_even(second):
        own = [getattr(one, _RANDOM_OF[ends]) for one in (first, second)]
        if all(one.size for one in own):
            few = [one.random_degrees_of_freedom for one in (first, second)]
            half = half_width_of_parts(np.stack(own), np.stack(few), rows, of)
            return difference - half, difference + half
    low, high = ends
    shared = shared_half_width(rows)
    down = _root(own_half_width(second, low), own_half_width(first, high), shared)
    up = _root(own_half_width(second, high), own_half_width(first, low), shared)
    return difference - down, difference + up


def _root(*parts: Floats) -> Floats:
    return np.asarray(np.sqrt(sum(one**2 for one in parts)))


def _notes(first: DesignValues, second: DesignValues, *, is_of_two: bool) -> tuple[str, ...]:
    """Describe the treatment of shared errors, or say that they are not known."""
    without = [one for one in (first, second) if not one.component]
    if len(without) == 2:
        return (
            "it is not known which errors the two share, such as that of a load cell: they are "
            "treated as independent",
        )
    if without:
        which = "first" if without[0] is first else "second"
        return (
            f"it is not known which errors the {which} shares with the other: they are treated as "
            "independent",
        )
    both = set(first.component) & set(second.component)
    if not both:
        said = "the two campaigns name no instrument in common: their errors are independent"
        return (said,) if is_of_two else ()
    names = ", ".join(dict.fromkeys(f"{one.source} of {one.of}" for one in sorted(both)))
    return (f"errors that both share count by their difference: {names}",)
