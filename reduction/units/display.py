"""Units that a reader is shown, and units of coefficients."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from typing import Literal

from reduction.errors import SettingsError
from reduction.units.scale import registry

UnitSystem = Literal["si", "us"]
_US = {
    "m": "ft",
    "N": "lbf",
    "Pa": "psi",
    "m2": "in2",
    "J m-1": "ft lbf / ft",
    "m s-1": "ft s-1",
    "N s": "lbf s",
}
_US_PINT = {"in2": "in**2", "ft s-1": "ft/s", "ft lbf / ft": "lbf", "lbf s": "lbf*s"}
_UNIT_AND_POWER = re.compile(r"([^\s\d/-]+)(-?\d+)?")


def combined_unit(unit: str, others: Sequence[str], powers: Sequence[int]) -> str:
    """Unit of a coefficient: that of the response over those of its factors.

    Parameters
    ----------
    unit : str
        Of the response.
    others : sequence of str
        Of the factors.
    powers : sequence of int
        Of the factors in the term.

    Returns
    -------
    combined : str
        As products write units.

    Examples
    --------
    >>> combined_unit("N", ["Hz", "m s-1"], [2, 1])
    'N Hz-2 m-1 s'
    >>> combined_unit("N", ["Hz", "N"], [0, 2])
    'N-1'
    """
    # a unit that is no product of powers stands as it is
    is_product = re.fullmatch(rf"({_UNIT_AND_POWER.pattern}\s*)+", unit) and "(" not in unit
    total: Counter[str] = Counter()
    factors = [(unit, 1)] if is_product else []
    factors += [(other, -power) for other, power in zip(others, powers, strict=True)]
    for one, times in factors:
        for name, own in _UNIT_AND_POWER.findall("" if one == "1" else one):
            total[name] += times * int(own or 1)
    parts = [name if power == 1 else f"{name}{power}" for name, power in total.items() if power]
    if not is_product and unit not in ("1", ""):
        parts.insert(0, f"({unit})" if "/" in unit and parts else unit)
    return " ".join(parts) or "1"


def display_unit(si_unit: str, system: UnitSystem) -> tuple[str, float]:
    """Unit to show and the factor from SI to it.

    Parameters
    ----------
    si_unit : str
        Unit as in `reduction.vocabulary`.
    system : {"si", "us"}
        ``us`` shows psi, lbf and ft.

    Returns
    -------
    unit : str
        What to print.
    factor : float
        Value in SI times this is the value to print.

    Raises
    ------
    SettingsError
        If the system is neither.

    Examples
    --------
    >>> display_unit("N", "us")
    ('lbf', 0.22480894309971)
    """
    if system == "si":
        return si_unit, 1.0
    if system != "us":
        raise SettingsError("unit system is not known", found=repr(system), needed="si or us")
    shown = _US.get(si_unit)
    if shown is None:
        return si_unit, 1.0
    source = {"J m-1": "N", "m2": "m**2", "m s-1": "m/s"}.get(si_unit, si_unit)
    factor = registry().Quantity(1.0, source).to(_US_PINT.get(shown, shown)).magnitude
    return shown, float(factor)
