"""Syrope of the command line: working curves as stated, the rest from the dynamics of the line."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, cast

from reduction.errors import SettingsError
from reduction.export.deck import segment_length
from reduction.export.dynamics import Syrope
from reduction.export.moordyn import fast_damping
from reduction.export.product import ExportLine
from reduction.export.thin import curve_from_zero
from reduction.units import parse_quantity

_ROUNDING = 1e-9
_NEEDED = 'a form and its numbers: "LINEAR, 0.2", "QUADRATIC, 0.2, 0.5" or "EXP, 0.2, 1.5"'


def with_syrope(
    line: ExportLine,
    working_curve: str | None,
    greatest_mean_tension: str | None,
    *,
    form: str | None,
    rated_break_strength: float | None = None,
) -> ExportLine:
    """Give a line with dynamics the working curves of a Syrope model.

    Parameters
    ----------
    line : ExportLine
        Its curve is the original working curve, its dynamics hold at the mean it starts from.
    working_curve : str or None
        Form, k1 and k2; nobody has measured them for the published lines.
    greatest_mean_tension : str or None
        That the line has had before.
    form : str or None
        Of the export: these say nothing to another one than ``syrope``.
    rated_break_strength : float, optional
        That %RBS is a share of, as at the other levels. [N]

    Returns
    -------
    line : ExportLine
        As it was where neither is stated.

    Raises
    ------
    SettingsError
        If one is stated without the other, or the line has no dynamics, or they do not fit.

    Notes
    -----
    alpha and beta are EA_d and its growth, the slow dashpot that of the three parameters in series
    with EA_d; the fast one is numerical.
    """
    if working_curve is None and greatest_mean_tension is None:
        return line
    if form != "syrope":
        raise SettingsError(
            "a working curve is of a Syrope line alone", found=f"--form {form}",
            needed="--form syrope",
        )  # fmt: skip
    if working_curve is None or greatest_mean_tension is None:
        raise SettingsError(
            "half a Syrope line is stated",
            found="--working-curve" if working_curve else "--greatest-mean-tension",
            needed="--working-curve and --greatest-mean-tension",
        )
    part = line.viscoelasticity
    if part is None:
        raise SettingsError(
            f"a Syrope line needs the dynamics of {line.name}",
            needed="a published line with --frequency, --mean-tension and --tension-amplitude",
        )
    shape, k1, k2 = _parts(working_curve)
    greatest = parse_quantity(
        greatest_mean_tension, "force", rated_break_strength=rated_break_strength
    )
    strain, tension, _ = curve_from_zero(line.strain, line.tension)
    # 30 %RBS is the end of many printed curves, but for the last digit of a product
    if math.isclose(greatest, tension[-1], rel_tol=_ROUNDING):
        greatest = float(tension[-1])
    syrope = Syrope(
        strain=strain,
        tension=tension,
        form=cast("Any", shape),
        k1=k1,
        k2=k2,
        dynamic_stiffness=part.dynamic_stiffness,
        dynamic_stiffness_per_mean_tension=part.dynamic_stiffness_per_mean_tension,
        slow_damping=part.slow_dashpot_coefficient,
        fast_damping=fast_damping(
            part.fast_stiffness, line.needed("linear_density"), segment_length(line)
        ),
        greatest_mean_tension=greatest,
        mean_tension=part.mean_tension,
    )
    return replace(
        line,
        syrope=syrope,
        sources=(
            *line.sources,
            f"Syrope: working curve {shape} {k1:g} {k2:g} and greatest mean tension "
            f"{syrope.greatest_mean_tension:.6g} N stated at the export; stiffness and slow "
            "dashpot are those of the three parameters, the fast dashpot is numerical",
        ),
    )


def _parts(text: str) -> tuple[str, float, float]:
    form, *numbers = (part.strip() for part in text.split(","))
    if not 1 <= len(numbers) <= 2:
        raise SettingsError("--working-curve is not understood", found=repr(text), needed=_NEEDED)
    try:
        k1, k2 = (parse_quantity(part, "number") for part in [*numbers, "0"][:2])
    except SettingsError as error:
        raise SettingsError(
            f"--working-curve: {error.problem}", found=error.found, needed=_NEEDED
        ) from error
    return form.upper(), k1, k2
