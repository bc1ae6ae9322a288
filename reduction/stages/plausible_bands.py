"""Bands in which numbers of mooring elements lie, and input errors that would put them there.

A band is wide: a value outside comes from an error in a unit, a factor or a diameter, or from a
specimen of another kind than stated.  docs/plausibility.md gives the basis of each.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005, Tables 5, 6 (moduli of tethers).
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, Tables 1, 2, 7 (sizes, strengths, stiffness).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, nan, pi

_MEGA, _GIGA = 1e6, 1e9


@dataclass(frozen=True)
class Bands:
    """Least and greatest of each number of one kind of specimen.

    Parameters
    ----------
    of : str
        Kind or material, in words.
    modulus : tuple of 2 float
        Greatest nominal stress over greatest strain. [Pa]
    strength : tuple of 2 float
        Rated break strength over the area before stretch. [Pa]
    density : tuple of 2 float
        Mass per length over that area. [kg m-3]
    greatest_strain : float
        At break. [1]
    """

    of: str
    modulus: tuple[float, float]
    strength: tuple[float, float]
    density: tuple[float, float]
    greatest_strain: float


_FIBRES: Mapping[tuple[str, ...], Bands] = {
    ("nylon", "polyamide"): Bands(
        "nylon rope", (50 * _MEGA, 6 * _GIGA), (60 * _MEGA, 600 * _MEGA), (350, 1500), 0.6
    ),
    ("polyester",): Bands(
        "polyester rope", (300 * _MEGA, 15 * _GIGA), (60 * _MEGA, 700 * _MEGA), (400, 1700), 0.3
    ),
    ("polypropylene",): Bands(
        "polypropylene rope", (150 * _MEGA, 8 * _GIGA), (40 * _MEGA, 500 * _MEGA), (300, 1100), 0.4
    ),
    ("hmpe", "dyneema", "spectra", "aramid", "kevlar", "twaron", "vectran", "lcp"): Bands(
        "rope of high-modulus fibre", (4 * _GIGA, 150 * _GIGA), (200 * _MEGA, 2500 * _MEGA),
        (400, 1700), 0.08,
    ),
}  # fmt: skip

_KINDS: Mapping[str, Bands] = {
    "rubber tether": Bands(
        "rubber tether", (0.3 * _MEGA, 3.2 * _MEGA), (1.5 * _MEGA, 40 * _MEGA), (850, 1700), 9.0
    ),
    "elastomer": Bands("elastomer", (0.01 * _MEGA, 100 * _MEGA), (0, inf), (600, 3000), 12.0),
    "stretch hose": Bands("stretch hose", (0.1 * _MEGA, 30 * _MEGA), (0, inf), (0, inf), 4.0),
    "rope": Bands("rope", (20 * _MEGA, 150 * _GIGA), (30 * _MEGA, 2500 * _MEGA), (300, 1900), 0.6),
    "wire": Bands(
        "wire", (20 * _GIGA, 220 * _GIGA), (400 * _MEGA, 2500 * _MEGA), (2000, 9000), 0.1
    ),
}  # fmt: skip


def bands_of(kind: str, material: str) -> Bands | None:
    """Bands of a kind of specimen, and of its material where a rope states a known one.

    Examples
    --------
    >>> bands_of("rope", "Nylon 6.6 (synthetic)").of
    'nylon rope'
    >>> bands_of("rope", "").of
    'rope'
    """
    words = material.lower()
    if kind == "rope":
        for names, bands in _FIBRES.items():
            if any(name in words for name in names):
                return bands
    return _KINDS.get(kind)


_LOAD: Mapping[str, float] = {
    "N": 1.0, "daN": 10.0, "kN": 1000.0, "lbf": 4.4482216152605, "kgf": 9.80665,
    "kip": 4448.2216152605,
}  # fmt: skip

_LENGTH: Mapping[str, float] = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "in": 0.0254, "ft": 0.3048}

_BY_DIAMETER: Mapping[str, float] = {
    "twice that diameter (is a radius stated?)": 1 / 4,
    "half that diameter (was it doubled?)": 4.0,
    "a diameter of a pi-th (is a circumference stated?)": pi**2,
    "ten times that diameter": 1 / 100,
    "a tenth of that diameter": 100.0,
    **{
        f"a diameter in {right}, not {wrong}": (_LENGTH[wrong] / _LENGTH[right]) ** 2
        for wrong in ("mm", "cm", "in")
        for right in ("mm", "cm", "in")
        if wrong != right
    },
}

_BY_GAIN: Mapping[str, float] = {
    "half that load (a gain of 2, or a factor, of the amplifier?)": 0.5,
    "twice that load (a gain or factor of the amplifier?)": 2.0,
    "a tenth of that load (a factor or gain?)": 0.1,
    "ten times that load (a factor or gain?)": 10.0,
    "a hundred times that load (volts without their factor?)": 100.0,
    "a thousandth of that load (a comma read as a mark of thousands?)": 1e-3,
}

_BY_STRAIN: Mapping[str, float] = {
    "a tenth of that strain": 10.0,
    "ten times that strain": 0.1,
    "a hundredth of that strain (per cent read as a fraction?)": 100.0,
    "a length in ft, not in": 12.0,
}


def readings_that_fit(
    value: float,
    band: tuple[float, float],
    *,
    load_unit: str = "",
    of_strength: bool = False,
    strength: float = nan,
) -> str:
    """Readings of the inputs that would put a stress, modulus or strength in its band.

    Parameters
    ----------
    value : float
        Value found. [Pa]
    band : tuple of 2 float
        Where it should lie. [Pa]
    load_unit : str, optional
        As declared; another one is named with it.
    of_strength : bool, optional
        True for a stated strength, to which no log and no strain contribute.
    strength : float, optional
        Rated strength of the specimen: the load may be a share of it. [N]

    Returns
    -------
    readings : str
        In words; empty where nothing fits.

    Notes
    -----
    The bands rest on [1]_ and [2]_ and on the properties of fibres and steels.

    Examples
    --------
    Twice the diameter, for a tether of 1 MPa:

    >>> readings_that_fit(0.25e6, (0.3e6, 3.2e6), load_unit="lbf")[:80]
    'load in daN, not lbf; load in kgf, not lbf; half that diameter (was it doubled?)'

    A load in percent of 4 kN, read as kilonewtons:

    >>> readings_that_fit(25e6, (0.3e6, 3.2e6), load_unit="kN", strength=4000.0)[:37]
    'load in % of the rated_break_strength'
    """
    low, high = band
    factors = {
        f"{'strength' if of_strength else 'load'} in {right}, not {load_unit}":
        _LOAD[right] / _LOAD[load_unit]
        for right in _LOAD
        if load_unit in _LOAD and right != load_unit
    }  # fmt: skip
    if load_unit in _LOAD:
        factors["load in % of the rated_break_strength"] = strength / 100 / _LOAD[load_unit]
    groups = [factors, _BY_DIAMETER]
    if not of_strength:
        groups += [_BY_GAIN, _BY_STRAIN]
    return "; ".join(
        words for group in groups for words, factor in group.items()
        if low <= factor * value <= high
    )  # fmt: skip


_RATIOS: Mapping[str, Mapping[str, float]] = {
    "time": {
        "minutes for seconds": 60.0, "seconds for minutes": 1 / 60,
        "milliseconds for seconds": 1e-3, "seconds for milliseconds": 1e3,
        "hertz for radians a second": 2 * pi, "radians a second for hertz": 1 / (2 * pi),
    },
    "length": {
        "m for ft": 3.2808, "ft for m": 0.3048, "in for ft": 1 / 12, "ft for in": 12.0,
        "in for mm": 25.4, "mm for in": 1 / 25.4,
    },
    "force": {
        "kN for lbf": 224.8, "lbf for N": 4.4482, "N for lbf": 0.2248, "lbf for kgf": 0.4536,
        "kgf for lbf": 2.2046, "kN for N": 1e-3,
    },
    "any": {
        "range for amplitude": 0.5, "a gain of 2": 2.0, "a factor of 10": 10.0,
        "a factor of 0.1": 0.1, "a factor of 100": 100.0, "a factor of 0.01": 0.01,
        "a factor of 1000": 1e3,
    },
}  # fmt: skip

_NEAR = 0.08


def words_of_ratio(ratio: float, *dimensions: str) -> str:
    """What a ratio of found over stated resembles, in words; empty where it resembles nothing.

    ``dimensions`` are those whose units the number is made of: ``time``, ``length``, ``force``; all
    if none is named.

    Examples
    --------
    >>> words_of_ratio(59.0)
    'minutes for seconds'
    >>> words_of_ratio(0.46), words_of_ratio(0.46, "time", "length")
    ('lbf for kgf, range for amplitude', 'range for amplitude')
    >>> words_of_ratio(1.37)
    ''
    """
    return ", ".join(
        words
        for dimension in ((*dimensions, "any") if dimensions else _RATIOS)
        for words, known in _RATIOS[dimension].items()
        if abs(ratio / known - 1) < _NEAR
    )
