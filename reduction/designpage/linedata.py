"""A source of design values as the page keeps it: plain numbers in full precision."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from reduction.lookup.linesurface import LineSurface
from reduction.lookup.product import LineCurve, LineSource
from reduction.uncertainty.product import Component

_TEXTS = ("name", "source", "material", "construction", "condition", "kind", "strength_of")
_NUMBERS = (
    "diameter", "rated_break_strength", "tensile_strength", "linear_density", "wet_linear_density",
)  # fmt: skip


def json_text(data: Any) -> str:
    """JSON that ends no element of a page, whatever stands in it."""
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def numbers(values: ArrayLike) -> Any:
    """Numbers for JSON, nested as they are: null is NaN, the text inf is infinite.

    Examples
    --------
    >>> numbers([1.5, float("nan"), float("inf")])
    [1.5, None, 'inf']
    """
    array = np.asarray(values)
    if array.ndim:
        return [numbers(one) for one in array]
    number = array.item()
    if isinstance(number, float) and not math.isfinite(number):
        return None if math.isnan(number) else "inf" if number > 0 else "-inf"
    return number


def line_data(line: LineSource) -> dict[str, Any]:
    """All that a look-up needs of a line.

    Parameters
    ----------
    line : LineSource
        Published, or of a campaign.

    Returns
    -------
    data : dict
        For JSON, by the names of the fields; a float is given back by its text to the last bit.

    Examples
    --------
    >>> line = LineSource("a", "b", "nylon", "braid", "new", 0.0127, 28e3)
    >>> line_data(line)["rated_break_strength"]
    28000.0
    """
    return (
        {name: getattr(line, name) for name in _TEXTS}
        | {name: numbers(getattr(line, name)) for name in _NUMBERS}
        | {
            "factors": list(line.factor_names),
            "surfaces": {name: _surface(one) for name, one in line.surfaces.items()},
            "curves": [_curve(one) for one in line.curves],
            "absent": dict(line.absent),
            "notes": list(line.notes),
            "rule": line.rule,
            "is_tether": line.is_tether,
            "quantities": list(line.quantities),
            "has_dashpot": line.has_dashpot,
        }
    )


def _surface(surface: LineSurface) -> dict[str, Any]:
    return {
        "quantity": surface.quantity,
        "exponents": surface.exponents.tolist(),
        **{
            name: numbers(getattr(surface, name))
            for name in (
                "coefficient", "low", "high", "covariance_factor", "sigma", "degrees_of_freedom",
                "greatest_leverage", "exponent", "contribution", "alternatives", "rounding",
                "line_scatter", "n_lines",
            )
        },
        "alternative_boxes": [[numbers(end) for end in box] for box in surface.alternative_boxes],
        "component": _components(surface.component),
        "errata": list(surface.errata),
        "notes": list(surface.notes),
    }  # fmt: skip


def _curve(curve: LineCurve) -> dict[str, Any]:
    return {
        "quantity": curve.quantity,
        "variable": curve.variable,
        "branch": curve.branch,
        "spread_of": curve.spread_of,
        "range_note": curve.range_note,
        "is_inverse_slope": curve.is_inverse_slope,
        **{
            name: numbers(getattr(curve, name))
            for name in (
                "low", "high", "coefficient", "at", "value", "standard_uncertainty",
                "degrees_of_freedom", "contribution", "gaps",
            )
        },
        "component": _components(curve.component),
        "errata": list(curve.errata),
        "notes": list(curve.notes),
    }  # fmt: skip


def _components(component: tuple[Component, ...]) -> list[list[Any]]:
    """Of each shared error what tells it from others, and its degrees of freedom."""
    return [[one.source, one.of, one.number, numbers(one.degrees_of_freedom)] for one in component]
