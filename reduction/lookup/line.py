"""Look-up of design values of a line: surfaces over frequency and loads, curves over one variable.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import SettingsError
from reduction.lookup.overcurve import values_of_curve
from reduction.lookup.oversurface import values_of_surface
from reduction.lookup.parts import (
    End,
    half_width_of_parts,
    is_even,
    own_half_width,
    shared_half_width,
    shared_of,
)
from reduction.lookup.product import DesignValues, LineCurve, LineSource
from reduction.record import Floats
from reduction.vocabulary import quantity as quantity_of

_DASHPOT = "dashpot_coefficient"
Branch = Literal["ascending", "descending"]


def look_up(
    line: LineSource,
    quantity: str,
    *,
    branch: Branch | None = None,
    extrapolate: Literal["refuse", "flag"] = "refuse",
    **levels: ArrayLike,
) -> DesignValues:
    """Design values of one quantity of a line.

    Parameters
    ----------
    line : LineSource
        Published, or from a campaign.
    quantity : str
        One of its quantities.
    branch : {"ascending", "descending"}, optional
        Of a quantity that differs by it; needed where both are there.
    extrapolate : {"refuse", "flag"}
        What to do outside the tested range.
    **levels : array_like, shape (...)
        By name: the factors of the surface (``frequency``, ``mean_tension``,
        ``tension_amplitude``), or the variable of the curve (``mean_tension``, ``tension``,
        ``strain``). They are broadcast together. [SI]

    Returns
    -------
    values : DesignValues
        With interval, range, source and errata.

    Raises
    ------
    SettingsError
        If the line has no such quantity, a level is missing or not of it, is no finite number or
        does not broadcast, a frequency is not positive, or a branch is asked for where there is
        none.
    DataError
        If a point is outside the tested range and ``extrapolate`` is "refuse", an amplitude is
        above its mean tension, or a tether goes slack.

    Notes
    -----
    [1]_ calls the range of its levels the range of usefulness.  Inside it, the corners of a
    Box-Behnken cube are farther from the runs than any run is: they are flagged as untested.

    Examples
    --------
    >>> line = LineSource(
    ...     "rope", "an example", "nylon", "braid", "new", 0.0127, 28e3,
    ...     curves=(LineCurve("strain", "tension", 0.0, 100.0, coefficient=np.array([0, 0.01])),),
    ... )
    >>> look_up(line, "strain", tension=[10.0, 50.0]).value
    array([0.1, 0.5])
    """
    if quantity == _DASHPOT and quantity not in line.surfaces and line.has_dashpot:
        if branch is not None:
            raise _no_branch(quantity, line, branch)
        return _dashpot(line, extrapolate, levels)
    surface = line.surfaces.get(quantity)
    given = _numbers(levels)
    if surface is not None and set(given) >= set(line.factor_names):
        if branch is not None:
            raise _no_branch(quantity, line, branch)
        return values_of_surface(line, surface, given, extrapolate)
    curves = [one for one in line.curves if one.quantity == quantity]
    if not curves and surface is None:
        why = line.absent.get(quantity)
        raise SettingsError(
            f"{line.name} has no {quantity}" + (f": {why}" if why else ""),
            needed="one of " + ", ".join(line.quantities),
        )
    curves = [one for one in curves if one.variable in given]
    if not curves:
        needed = [", ".join(line.factor_names)] if surface is not None else []
        needed += [one.variable for one in line.curves if one.quantity == quantity]
        raise SettingsError(
            f"{quantity} of {line.name} needs another variable",
            found=", ".join(given) or "none",
            needed=" or ".join(dict.fromkeys(needed)),
        )
    return values_of_curve(line, _of_branch(line, curves, branch), given, extrapolate)


def _numbers(levels: Mapping[str, ArrayLike]) -> dict[str, Floats]:
    """Levels as finite numbers of shapes that broadcast."""
    given = {}
    for name, value in levels.items():
        try:
            found = np.asarray(value)
        except ValueError:
            found = np.array("rows of different lengths")
        if found.dtype.kind not in "iuf":
            raise SettingsError(
                f"{name} is no real number", found=str(found.dtype), needed="numbers, in SI"
            )
        if not np.all(np.isfinite(found)):
            raise SettingsError(f"{name} is not finite", needed="numbers")
        if name == "frequency" and np.any(found <= 0):
            raise SettingsError(
                "a frequency is not positive", found=f"{found.min():.5g} Hz", needed="above zero"
            )
        given[name] = found.astype(np.float64, copy=False)
    try:
        np.broadcast_shapes(*(value.shape for value in given.values()))
    except ValueError:
        raise SettingsError(
            "the levels do not pair up",
            found="; ".join(f"{name} of shape {value.shape}" for name, value in given.items()),
            needed="shapes that broadcast together",
        ) from None
    return given


def _no_branch(quantity: str, line: LineSource, branch: Branch) -> SettingsError:
    return SettingsError(
        f"{quantity} of {line.name} does not differ by branch", found=branch, needed="no branch"
    )


def _dashpot(
    line: LineSource,
    extrapolate: Literal["refuse", "flag"],
    levels: Mapping[str, ArrayLike],
) -> DesignValues:
    """N = K_1 tau: what both share by its sign, what is of each alone as independent."""
    spring, time = (
        look_up(line, name, branch=None, extrapolate=extrapolate, **levels)
        for name in ("dissipation_spring_constant", "relaxation_time")
    )
    value = spring.value * time.value
    shared = shared_of({"spring": spring, "time": time})
    rows = shared.values["spring"] * time.value + shared.values["time"] * spring.value

    parts = _own_parts(spring, time)

    def half(end: End) -> Floats:
        if parts:
            random = parts["random" if end.startswith("surface") else "run"]
            return half_width_of_parts(random, parts["few"], rows, shared.degrees_of_freedom)
        own = (own_half_width(spring, end) * time.value, own_half_width(time, end) * spring.value)
        return np.asarray(np.sqrt(np.square(own).sum(axis=0) + shared_half_width(rows) ** 2))

    return replace(
        spring,
        quantity=_DASHPOT,
        unit=quantity_of(_DASHPOT).unit,
        value=value,
        component=shared.component,
        contribution=rows,
        low=value - half("low"),
        high=value + half("high"),
        surface_low=value - half("surface_low"),
        surface_high=value + half("surface_high"),
        # of two surfaces together: to be read from the intervals
        random_standard_uncertainty=np.empty(0),
        random_degrees_of_freedom=np.empty(0),
        run_standard_uncertainty=np.empty(0),
        errata=tuple(dict.fromkeys((*spring.errata, *time.errata))),
        notes=tuple(
            dict.fromkeys(
                (
                    "N = K_1 tau; the intervals take the scatter of the two as independent, and "
                    "what the runs share as it is",
                    *spring.notes,
                    *time.notes,
                )
            )
        ),
    )


def _of_branch(line: LineSource, curves: list[LineCurve], branch: Branch | None) -> LineCurve:
    if branch is not None and not any(one.branch for one in curves):
        raise _no_branch(curves[0].quantity, line, branch)
    # where one branch alone is known it need not be asked for
    found = [one for one in curves if branch is None or one.branch == branch]
    if len(found) == 1:
        return found[0]
    branches = [one.branch for one in curves if one.branch]
    raise SettingsError(
        f"{curves[0].quantity} of {line.name} differs by branch",
        found=branch or "no branch",
        needed="branch = " + " or ".join(branches),
    )


def _own_parts(spring: DesignValues, time: DesignValues) -> dict[str, Floats]:
    """What the scatter of K_1 and of tau adds to N, a row each; empty where one is not so known."""
    if not (is_even(spring) and is_even(time)):
        return {}
    by = (time.value, spring.value)
    return {
        "random": np.stack(
            [
                one.random_standard_uncertainty * other
                for one, other in zip((spring, time), by, strict=True)
            ]
        ),
        "run": np.stack(
            [
                one.run_standard_uncertainty * other
                for one, other in zip((spring, time), by, strict=True)
            ]
        ),
        "few": np.stack([one.random_degrees_of_freedom for one in (spring, time)]),
    }
