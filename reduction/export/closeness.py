"""How close a written curve is to the one that was given, for the screen."""

from __future__ import annotations

from reduction.digits import plain_number
from reduction.export.abaqus import ABAQUS_POINTS
from reduction.export.moordyn import MOST_POINTS
from reduction.export.orcaflex import ORCAFLEX_POINTS
from reduction.export.product import ExportLine
from reduction.export.spline import fit_smooth_curve
from reduction.export.thin import local_words, thin_curve
from reduction.export.whoicable import CABLE_POINTS

_CLOSE = 0.05
_POINTS = {
    "moordyn": MOST_POINTS,
    "openfast": MOST_POINTS,
    "moorpy": MOST_POINTS,
    "whoi-cable": CABLE_POINTS,
    "orcaflex": ORCAFLEX_POINTS,
    "abaqus": ABAQUS_POINTS,
}


def closeness_of(line: ExportLine, to: str, form: str | None) -> tuple[str, ...]:
    """What is said of the errors of a curve in a format.

    Parameters
    ----------
    line : ExportLine
        What is exported.
    to : str
        The format.
    form : str or None
        Of it.

    Returns
    -------
    words : tuple of str
        Empty where every point is written, or no curve is; DOUBTFUL where a tension is off by more
        than a twentieth of itself.

    Raises
    ------
    DataError
        If the curve cannot be exported.
    """
    if to not in _POINTS or form in ("static-dynamic", "load-dependent", "syrope", "library"):
        return ()
    is_table = to != "whoi-cable" or form == "table"
    found = (
        thin_curve(line.strain, line.tension, most=_POINTS[to])
        if is_table
        else fit_smooth_curve(line.strain, line.tension)
    )
    doubt = "DOUBTFUL: " if found.local > _CLOSE else ""
    return (
        f"{doubt}the written curve is off by up to {plain_number(found.error, 3)} N, "
        f"{found.share:.2e} of the "
        f"greatest tension; {local_words(found)}",
    )
