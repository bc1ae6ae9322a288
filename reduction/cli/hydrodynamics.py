"""Drag and added mass as they are stated on the command line, with where they are from."""

from __future__ import annotations

from dataclasses import replace

from reduction.errors import SettingsError
from reduction.export.product import CYLINDER, Hydrodynamics
from reduction.units import parse_quantity

_NEEDED = 'two numbers, "1.6, 0.02": across the line, along it'


def stated_hydrodynamics(
    drag: str | None, added_mass: str | None, source: str | None
) -> dict[str, Hydrodynamics]:
    """Coefficients that stand in place of the assumed cylinder.

    Parameters
    ----------
    drag, added_mass : str or None
        Two numbers, across the line and along it; what is not stated stays assumed. [1]
    source : str or None
        Where they are from; it stands in the header.

    Returns
    -------
    stated : dict of str to Hydrodynamics
        As a field of `ExportLine`; empty where nothing is stated.

    Raises
    ------
    SettingsError
        If there are not two numbers, one is negative, or a source has nothing to speak of.

    Examples
    --------
    >>> stated_hydrodynamics("1.6, 0.02", None, "a towing tank")["hydrodynamics"].axial_drag
    0.02
    """
    if drag is None and added_mass is None:
        if source is not None:
            raise SettingsError(
                "a source of coefficients without coefficients",
                found=f"--hydrodynamics-source {source}",
                needed="--drag or --added-mass with it",
            )
        return {}
    said = f"stated at the export, {source or 'without a source'}"
    found, words = CYLINDER, []
    if drag is not None:
        normal, axial = _pair("--drag", drag)
        found = replace(found, normal_drag=normal, axial_drag=axial)
    if added_mass is not None:
        normal, axial = _pair("--added-mass", added_mass)
        found = replace(found, normal_added_mass=normal, axial_added_mass=axial)
    for what, text in (("drag", drag), ("added mass", added_mass)):
        words.append(f"{what} {CYLINDER.source if text is None else said}")
    both = drag is not None and added_mass is not None
    return {"hydrodynamics": replace(found, source=said if both else "; ".join(words))}


def _pair(option: str, text: str) -> tuple[float, float]:
    parts = [part.strip() for part in text.split(",")]
    if len(parts) != 2:
        raise SettingsError(
            f"{option} is not a pair of coefficients", found=repr(text), needed=_NEEDED
        )
    try:
        normal, axial = (parse_quantity(part, "number") for part in parts)
    except SettingsError as error:
        raise SettingsError(
            f"{option}: {error.problem}", found=error.found, needed=_NEEDED
        ) from error
    if normal < 0 or axial < 0:
        raise SettingsError(f"{option} is negative", found=repr(text), needed="zero or above")
    return normal, axial
