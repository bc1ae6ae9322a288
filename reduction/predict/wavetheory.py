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

from reduction.checks import as_positive
from reduction.errors import DataError
from reduction.predict.breaking import breaking_height
from reduction.predict.dispersion import STANDARD_GRAVITY, wave_number
from reduction.predict.harmonics import WaveHarmonics
from reduction.predict.theorytable import (
    PrintedTheory,
    WaveTheoryName,
    printed_theory,
    theory_by_depth,
)
from reduction.predict.wavelength import check_wave_length
from reduction.predict.waves import airy_wave, stokes_wave

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
        as_positive("wave_length", wave_length)
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
        f"the second harmonic of the surface is {100 * surface:.0f} % of the first": (
            theory == "airy" and not is_small
        ),
        f"Stokes' second order is at its end: Ursell number {ursell:.1f} (at most "
        f"{GREATEST_URSELL_NUMBER:.1f}), second harmonic of the surface {100 * surface:.0f} % "
        f"(at most {100 * _SECONDARY_CREST:.0f} %)": is_beyond,
        f"the given length is {100 * mismatch:+.1f} % off that of the period": (
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


def regular_wave(
    wave: WaveTheory,
    *,
    wave_height: float,
    wave_period: float,
    water_depth: float,
    elevation: float,
    theory: WaveTheoryName | None = None,
    current_velocity: float = 0.0,
) -> WaveHarmonics:
    """Motion at one elevation by the theory that applies, or by the one asked for.

    Parameters
    ----------
    wave : WaveTheory
        Of the same wave.
    wave_height : float
        Trough to crest. [m]
    wave_period : float
        As a fixed point sees it. [s]
    water_depth : float
        Of the still water. [m]
    elevation : float
        Of the place above the mean level. [m]
    theory : {"airy", "stokes", "cnoidal or solitary", "beyond the table"}, optional
        None: that of the description.
    current_velocity : float
        On which the wave rides, positive along it. [m s-1]

    Returns
    -------
    wave : WaveHarmonics
        With the wave length of the description.

    Raises
    ------
    DataError
        If the theory is not computed, the wave is beyond breaking, or as `airy_wave`.

    Notes
    -----
    Doubts of the description do not stop a prediction: they go with it.

    Examples
    --------
    The second example of [1]_ has two harmonics.

    >>> sea = dict(wave_height=1.25, wave_period=3.57, water_depth=3.0)
    >>> regular_wave(describe_wave(**sea), **sea, elevation=0.0).elevation.size
    2
    """
    by = theory or wave.theory
    makers = {"airy": airy_wave, "stokes": stokes_wave}
    if by not in makers:
        raise DataError(
            f"the theory of this wave is not computed: {by}",
            found=f"a depth of {wave.relative_depth:.3f} wave lengths",
            needed="0.1 or more, for Airy's or Stokes' theory",
            hint="Ask for one of the two by name to see what it gives outside its range.",
        )
    return makers[by](
        wave_height=wave_height,
        wave_period=wave_period,
        water_depth=water_depth,
        elevation=elevation,
        wave_number=2 * pi / wave.wave_length,
        current_velocity=current_velocity,
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
