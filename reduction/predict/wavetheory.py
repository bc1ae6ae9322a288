r"""Which wave theory applies, and how far a wave is from the limits of each.

With the Ursell number Ur = H L^2 / d^3 and the amplitudes a_1, a_2 of the first and second
harmonic of Stokes' surface, a_2 / a_1 goes to 3 Ur / (32 pi^2) over shallow water; where it
passes 1/4, at Ur = 8 pi^2 / 3 = 26.3, the trough has a crest of its own.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015, Table 1 and sec. 5.
.. [2] F. Ursell, "The long-wave paradox in the theory of gravity waves," Proc. Cambridge Phil.
   Soc., vol. 49, 1953, pp. 685-694.
.. [3] R. G. Dean and R. A. Dalrymple, Water Wave Mechanics for Engineers and Scientists.
   Singapore: World Scientific, 1991, ch. 11.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cosh, exp, pi, sinh
from typing import Literal

from reduction.checks import as_positive
from reduction.predict.breaking import breaking_height
from reduction.predict.dispersion import STANDARD_GRAVITY, check_wave_length, wave_number

__all__ = [
    "GREATEST_URSELL_NUMBER",
    "PrintedTheory",
    "WaveTheory",
    "WaveTheoryName",
    "describe_wave",
    "printed_theory",
    "theory_by_depth",
]

WaveTheoryName = Literal["airy", "stokes", "cnoidal or solitary", "beyond the table"]
PrintedTheory = Literal["airy", "stokes", "cnoidal or solitary", "none"]

GREATEST_URSELL_NUMBER = 8 * pi**2 / 3
"""Where Stokes' second order has a secondary crest over shallow water. [1]"""
_SECONDARY_CREST = 0.25
_NEGLIGIBLE = 0.05  # second over first harmonic that the linear theory may leave out
_LENGTH_TOLERANCE = 0.01  # given length against that of the period


@dataclass(frozen=True)
class WaveTheory:
    """What one wave is and which theory it asks for.

    Parameters
    ----------
    theory : {"airy", "stokes", "cnoidal or solitary", "beyond the table"}
        By relative depth, as [1]_ itself reads its Table 1.
    printed : {"airy", "stokes", "cnoidal or solitary", "none"}
        By both columns of Table 1, to the letter.
    wave_length : float
        As given, else by the dispersion relation. [m]
    relative_depth, steepness, height_to_depth : float
        d / L, H / L, H / d. [1]
    breaking_ratio : float
        Height over that at which the wave breaks. [1]
    ursell_number : float
        H L^2 / d^3. [1]
    elevation_ratio, velocity_ratio : float
        Second over first harmonic by Stokes' theory, of the surface and of the horizontal
        velocity at the mean level. [1]
    length_mismatch : float
        Given length over that of the period, less one; 0 where none was given. [1]
    is_breaking : bool
        No theory applies, and none is computed.
    is_computed : bool
        Whether the package has the theory: not the cnoidal and the solitary wave.
    is_beyond_stokes : bool
        Ursell number above 8 pi^2 / 3, or a secondary crest in the trough.
    is_second_order_small : bool
        Second harmonics below 5 % of the first.
    reasons : tuple of str
        What speaks against the theory, in words; empty where nothing does.
    """

    theory: WaveTheoryName
    printed: PrintedTheory
    wave_length: float
    relative_depth: float
    steepness: float
    height_to_depth: float
    breaking_ratio: float
    ursell_number: float
    elevation_ratio: float
    velocity_ratio: float
    length_mismatch: float
    is_breaking: bool
    is_computed: bool
    is_beyond_stokes: bool
    is_second_order_small: bool
    reasons: tuple[str, ...]


def theory_by_depth(relative_depth: float) -> WaveTheoryName:
    """Theory by the relative depth alone.

    Parameters
    ----------
    relative_depth : float
        Depth over wave length. [1]

    Returns
    -------
    theory : {"airy", "stokes", "cnoidal or solitary", "beyond the table"}
        Of a wave that does not break.

    Raises
    ------
    DataError
        If the relative depth is not positive.

    Notes
    -----
    Table 1 of [1]_ leaves d/L = 0.1 to nobody; it is given to Stokes here, as in sec. 5
    ("between 2 and 4 meters" of a 20 m wave).  Its lowest limit, "0.04~0.05", is taken as 0.04.

    Examples
    --------
    The 20 m wave of [1]_ over 6 m, 3 m and 1.5 m of water.

    >>> [theory_by_depth(depth / 20) for depth in (6.0, 3.0, 1.5)]
    ['airy', 'stokes', 'cnoidal or solitary']
    """
    as_positive("relative_depth", relative_depth)
    if relative_depth >= 0.2:
        return "airy"
    if relative_depth >= 0.1:
        return "stokes"
    return "cnoidal or solitary" if relative_depth > 0.04 else "beyond the table"


def printed_theory(relative_depth: float, steepness: float) -> PrintedTheory:
    """Theory by Table 1 to the letter.

    Parameters
    ----------
    relative_depth : float
        Depth over wave length. [1]
    steepness : float
        Height over wave length. [1]

    Returns
    -------
    printed : {"airy", "stokes", "cnoidal or solitary", "none"}
        What the table names.

    Raises
    ------
    DataError
        If a number is not positive.

    Notes
    -----
    Table 1 of [1]_ contradicts itself: its row of Stokes asks for H/L of 0.2 or more, where
    every wave has broken (at most 0.142, and 0.12 at d/L = 0.2), and its row of Airy allows
    up to 0.2.  The second example of the paper, H/L = 0.0625 at d/L = 0.15, is in no row.

    Examples
    --------
    >>> printed_theory(0.3, 0.0625), printed_theory(0.15, 0.0625)
    ('airy', 'none')
    """
    as_positive("relative_depth", relative_depth)
    as_positive("steepness", steepness)
    if relative_depth >= 0.2:
        return "airy" if steepness <= 0.2 else "none"
    if relative_depth > 0.1:
        return "stokes" if steepness >= 0.2 else "none"
    return "cnoidal or solitary" if 0.04 < relative_depth < 0.1 else "none"


def describe_wave(
    *,
    wave_height: float,
    wave_period: float,
    water_depth: float,
    wave_length: float | None = None,
    current_velocity: float = 0.0,
    gravity: float = STANDARD_GRAVITY,
) -> WaveTheory:
    """Theory, limits and doubts of one wave.

    Parameters
    ----------
    wave_height : float
        Trough to crest. [m]
    wave_period : float
        As a fixed point sees it. [s]
    water_depth : float
        Of the still water. [m]
    wave_length : float, optional
        Where one is given beside the period; None: by the dispersion relation. [m]
    current_velocity : float
        On which the wave rides, positive along it. [m s-1]
    gravity : float
        Acceleration of free fall. [m s-2]

    Returns
    -------
    wave : WaveTheory
        A breaking wave is flagged, not refused: a description is no prediction.

    Raises
    ------
    DataError
        If a number is not positive, or the current stops the wave.

    Notes
    -----
    Limits of height: `reduction.predict.breaking`.  Number of [2]_, secondary crest after
    [3]_.  What counts as a small second harmonic (5 %) and as a length that fits its period
    (1 %) is set by this package.

    Examples
    --------
    The second example of [1]_ is at the edge of Stokes' second order.

    >>> wave = describe_wave(wave_height=1.25, wave_period=3.57, water_depth=3.0,
    ...                      wave_length=20.0)
    >>> print(wave.theory, round(wave.ursell_number, 1), round(wave.elevation_ratio, 2),
    ...       round(wave.velocity_ratio, 2), wave.is_beyond_stokes)
    stokes 18.5 0.3 0.26 True
    """
    for name, value in (("wave_height", wave_height), ("wave_period", wave_period)):
        as_positive(name, value)
    if wave_length is None:
        number = float(
            wave_number(
                wave_period, water_depth, current_velocity=current_velocity, gravity=gravity
            )
        )
        length, mismatch = 2 * pi / number, 0.0
    else:
        length, number = wave_length, 2 * pi / wave_length
        mismatch = float(
            check_wave_length(
                length, wave_period, water_depth, current_velocity=current_velocity, gravity=gravity
            ).length_mismatch
        )
    relative_depth, steepness = water_depth / length, wave_height / length
    theory = theory_by_depth(relative_depth)
    surface, velocity = _second_harmonics(number * wave_height, number * water_depth)
    breaking_ratio = wave_height / float(breaking_height(number, water_depth))
    ursell = wave_height * length**2 / water_depth**3
    is_beyond = ursell > GREATEST_URSELL_NUMBER or surface > _SECONDARY_CREST
    is_small = max(surface, velocity) < _NEGLIGIBLE
    doubts = {
        f"the wave breaks: {breaking_ratio:.2f} of the breaking height": breaking_ratio > 1,
        f"cnoidal and solitary waves are not computed, and d/L is {relative_depth:.3f}": (
            theory not in ("airy", "stokes")
        ),
        f"the second harmonic of the surface is {surface:.0%} of the first": (
            theory == "airy" and not is_small
        ),
        f"Stokes' second order is at its end: Ursell number {ursell:.1f} (at most "
        f"{GREATEST_URSELL_NUMBER:.1f}), second harmonic of the surface {surface:.0%} (at most "
        f"{_SECONDARY_CREST:.0%})": is_beyond,
        f"the given length is {mismatch:+.1%} off that of the period": (
            abs(mismatch) > _LENGTH_TOLERANCE
        ),
    }
    return WaveTheory(
        theory=theory,
        printed=printed_theory(relative_depth, steepness),
        wave_length=length,
        relative_depth=relative_depth,
        steepness=steepness,
        height_to_depth=wave_height / water_depth,
        breaking_ratio=breaking_ratio,
        ursell_number=ursell,
        elevation_ratio=surface,
        velocity_ratio=velocity,
        length_mismatch=mismatch,
        is_breaking=breaking_ratio > 1,
        is_computed=theory in ("airy", "stokes"),
        is_beyond_stokes=is_beyond,
        is_second_order_small=is_small,
        reasons=tuple(text for text, is_so in doubts.items() if is_so),
    )


def _second_harmonics(height: float, depth: float) -> tuple[float, float]:
    """Second over first harmonic, from k H and k d, of surface and velocity at the mean level.

    kH/8 cosh kd (2 + cosh 2kd) / sinh^3 kd and 3 kH/8 cosh 2kd / (sinh^3 kd cosh kd).
    """
    if depth > 20:  # all but 1e-17: cosh would overflow later on
        return height / 4, 3 * height * exp(-2 * depth)
    sine, cosine, double = sinh(depth), cosh(depth), cosh(2 * depth)
    surface = height / 8 * cosine * (2 + double) / sine**3
    return surface, 3 * height / 8 * double / (sine**3 * cosine)
