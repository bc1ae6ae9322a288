r"""Geometry of a hose: helix angle, cord length, fabric, helical layers.

**Helix on a cylinder at rest: its angle, and the radius as a function of the stretch**:

.. math:: \lambda_r^2 = 1/\lambda_h \text{ (isochoric)}, \qquad \lambda_r = 1 \text{ (rigid)}

**Length of a helix on a cylinder that stretches: cords of a hose, wires of an armour layer**:

.. math:: \lambda_c^2 = \lambda_h^2 \cos^2 a_0 + \lambda_r^2 \sin^2 a_0

:math:`\lambda_h` is the stretch ratio of the cylinder, :math:`\lambda_c` that of the helix,
:math:`a_0` the angle at rest between helix and axis.  The radius follows the stretch as
:math:`\lambda_r^2 = 1/\lambda_h` where wall and filling keep their volume (``isochoric``: the
water-filled hose), or stays constant (``rigid``: wires on a rigid core).

The isochoric form requires that wall and filling are incompressible, that no filling is lost, and
that there is no twist and the ends are far away.  It does not hold for a hose that leaks, holds air
or turns under load.

**Angle of a helix on a cylinder that stretches, and the angle at rest for two given stretches**:

.. math:: \tan a = \tan a_0 \, \lambda_r / \lambda_h

**From cord fabric to cord layers: ribbon width, number of cords, spacing, dead ends.** A layer is
one ribbon of cord fabric, cords along it, butt wrapped: the turns touch.  Rolled out, a turn is a
parallelogram whose side across the hose is :math:`\pi d_w`, so that

.. math:: w_c = \pi d_w \cos\alpha_0, \qquad N = 2 w_c n_c

The width of the ribbon determines the angle: the ribbon is cut, and the angle follows from its
width and the diameter on which it is wrapped.

**Layers of a hose that carry no load: fish-bite protection, conductors.** They follow the hose as
its cords do, :math:`\lambda^2 = \lambda_h^2\cos^2\alpha_0 + \sin^2\alpha_0/\lambda_h`, at any
diameter: wall and filling are incompressible, so every radius shrinks by the same factor.  The
square is convex in the hose stretch, so over a range from rest the *greatest* strain is at an end
and the *least* at :math:`\lambda_h^3 = \tan^2\alpha_0 / 2`, where the current angle is 54.7356
degrees.

A layer that is steep enough not to be stretched is therefore compressed at intermediate stretch,
and more so the steeper it is: `least_layer_angle` and `greatest_layer_angle` are the two sides of a
window that closes for a large stretch of the hose.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical Properties,"
   Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004, sec. 1.2.1; eq. 10, 11,
   22, 23 and section 2.0; eq. 8 and Figure 7; sections 1.2 and 2.0, eq. 8.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, pi, sqrt
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_finite, as_positive
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Floats, read_only_arrays

Core = Literal["isochoric", "rigid"]

NEUTRAL_ANGLE = atan(sqrt(2.0))
"""54.7356 deg: with a larger angle, a cord goes slack as a water-filled hose stretches. [rad]."""


def _squares_of_angle(wrap_angle: ArrayLike) -> tuple[Floats, Floats]:
    """Squares of cosine and sine of the angle between helix and axis.

    Examples
    --------
    >>> cosine2, sine2 = _squares_of_angle(NEUTRAL_ANGLE)
    >>> print(cosine2.round(4), sine2.round(4))
    0.3333 0.6667
    """
    angle = np.asarray(wrap_angle, dtype=np.float64)
    is_angle = (angle > 0) & (angle < pi / 2)
    if not np.all(is_angle):
        bad = np.atleast_1d(angle)[np.atleast_1d(~is_angle)][0]
        raise SettingsError(
            "wrap_angle is not an angle of a helix",
            found=f"{np.degrees(bad):g} deg",
            needed="between 0 and 90 deg from the axis",
        )
    return np.asarray(np.cos(angle) ** 2), np.asarray(np.sin(angle) ** 2)


def _squared_radius_ratio(stretch_ratio: Floats, core: Core) -> Floats:
    """Square of the ratio of the radius to that at rest.

    Examples
    --------
    >>> _squared_radius_ratio(np.array([1.0, 2.0]), "isochoric")
    array([1. , 0.5])
    """
    _check_core(core)
    unit = np.ones_like(stretch_ratio)
    return np.asarray(1 / stretch_ratio if core == "isochoric" else unit)


def _check_core(core: Core) -> None:
    """Refuse an unknown core.

    Examples
    --------
    >>> _check_core("rigid")
    """
    if core not in get_args(Core):
        raise SettingsError("unknown core", found=str(core), needed=" or ".join(get_args(Core)))


def cord_stretch_ratio(
    stretch_ratio: ArrayLike, wrap_angle: ArrayLike, *, core: Core = "isochoric"
) -> Floats:
    r"""Stretch ratio of a helix from that of its cylinder.

    .. math:: \lambda_c = \sqrt{\lambda_h^2 \cos^2 a_0 + \lambda_r^2 \sin^2 a_0}

    Parameters
    ----------
    stretch_ratio : array_like, shape (...)
        :math:`\lambda_h` of the cylinder. [1]
    wrap_angle : array_like, shape (...)
        :math:`a_0` at rest, from the axis. [rad]
    core : {"isochoric", "rigid"}
        Behaviour of the radius.

    Returns
    -------
    cord_stretch_ratio : ndarray, shape (...)
        :math:`\lambda_c`; below one the cord is slack. [1]

    Raises
    ------
    SettingsError
        If an angle is not between 0 and 90 deg, or the core is unknown.
    DataError
        If a stretch ratio is not a positive number.

    Notes
    -----
    Source: [1]_, eq. (8).

    Examples
    --------
    A cord at 64 deg is 2.74 % short where it is slackest, and has its length again at +61.04 %:

    >>> print((100 * cord_stretch_ratio([1.28096, 1.61039], np.radians(64.0)) - 100).round(2))
    [-2.74 0. ]
    """
    stretch, (cosine2, sine2) = (
        as_positive("stretch_ratio", stretch_ratio),
        _squares_of_angle(wrap_angle),
    )
    return np.asarray(np.sqrt(stretch**2 * cosine2 + _squared_radius_ratio(stretch, core) * sine2))


def hose_stretch_ratio(
    cord_stretch_ratio: ArrayLike, wrap_angle: ArrayLike, *, core: Core = "isochoric"
) -> Floats:
    r"""Stretch ratio of the cylinder at which a helix has a given stretch ratio.

    .. math:: \lambda_h = 2\sqrt{p/3}\,
       \cos\left(\tfrac13 \arccos\left(-\tfrac32 \frac{q}{p} \sqrt{3/p}\right)\right),
       \quad p = \lambda_c^2/\cos^2 a_0, \quad q = \tan^2 a_0

    Parameters
    ----------
    cord_stretch_ratio : array_like, shape (...)
        :math:`\lambda_c`. [1]
    wrap_angle : array_like, shape (...)
        :math:`a_0` at rest, from the axis. [rad]
    core : {"isochoric", "rigid"}
        Behaviour of the radius.

    Returns
    -------
    stretch_ratio : ndarray, shape (...)
        :math:`\lambda_h` on the branch where stretch lengthens the helix; NaN where the helix
        never becomes that short. [1]

    Raises
    ------
    SettingsError
        If an angle is not between 0 and 90 deg, or the core is unknown.
    DataError
        If a stretch ratio is not a positive number.

    Notes
    -----
    Source: [1]_, eq. (8), which is the cubic :math:`\lambda_h^3 - p \lambda_h + q = 0`; the
    largest of its three roots in closed form.  With the rigid core the equation is quadratic.
    At an angle below 54.7356 deg a cord that is shorter than at rest gives a ratio below one.

    Examples
    --------
    Cords strained by 3.3 % in a hose with a wrap angle of 64 deg: the 79 % of [1]_, sec. 3.0

    >>> print(hose_stretch_ratio(1.033, np.radians(64.0)).round(4))
    1.7901
    """
    cord, (cosine2, sine2) = (
        as_positive("cord_stretch_ratio", cord_stretch_ratio),
        _squares_of_angle(wrap_angle),
    )
    _check_core(core)
    with np.errstate(invalid="ignore"):
        if core == "rigid":
            return np.asarray(np.sqrt(1 + (cord - 1) * (cord + 1) / cosine2))
        square = cord**2 / cosine2
        cosine3 = -1.5 * (sine2 / cord**2) * np.sqrt(3 / square)
        # the shortest possible helix is at -1, which rounding may miss
        cosine3 = np.where(cosine3 > -1 - 8 * np.finfo(np.float64).eps, cosine3, np.nan)
        cosine3 = np.maximum(cosine3, -1.0)
        return np.asarray(2 * np.sqrt(square / 3) * np.cos(np.arccos(cosine3) / 3))


def pick_up_stretch_ratio(wrap_angle: ArrayLike) -> Floats:
    r"""Stretch ratio of a water-filled hose at which its slack cords reach their rest length again.

    .. math:: \lambda_h^* = \tfrac12\left(\sqrt{1 + 4\tan^2 a_0} - 1\right)

    Parameters
    ----------
    wrap_angle : array_like, shape (...)
        :math:`a_0` at rest, from the axis. [rad]

    Returns
    -------
    stretch_ratio : ndarray, shape (...)
        One where the angle is not above 54.7356 deg: the cords bear load from the start. [1]

    Raises
    ------
    SettingsError
        If an angle is not between 0 and 90 deg.

    Notes
    -----
    Source: [1]_, eq. (8) with :math:`\lambda_c = 1`, divided by its root
    :math:`\lambda_h = 1`: :math:`\lambda_h^2 + \lambda_h - \tan^2 a_0 = 0`.

    Examples
    --------
    >>> print((100 * pick_up_stretch_ratio(np.radians([50.0, 64.0, 68.0])) - 100).round(2))
    [  0.    61.04 102.51]
    """
    cosine2, sine2 = _squares_of_angle(wrap_angle)
    above = np.maximum(sine2 / cosine2 - 2, 0.0)
    return np.asarray(1 + 2 * above / (3 + np.sqrt(9 + 4 * above)))


def slackest_stretch_ratio(wrap_angle: ArrayLike) -> Floats:
    r"""Stretch ratio of a water-filled hose at which its cords are shortest.

    .. math:: \lambda_h = \left(\tfrac12 \tan^2 a_0\right)^{1/3}

    Parameters
    ----------
    wrap_angle : array_like, shape (...)
        :math:`a_0` at rest, from the axis. [rad]

    Returns
    -------
    stretch_ratio : ndarray, shape (...)
        One where the angle is not above 54.7356 deg. [1]

    Raises
    ------
    SettingsError
        If an angle is not between 0 and 90 deg.

    Notes
    -----
    Where the derivative of eq. (8) of [1]_ is zero.  The current angle is then 54.7356 deg at
    any angle at rest, by eq. (7).

    Examples
    --------
    >>> from reduction.prediction.hose_geometry import current_wrap_angle
    >>> slackest = slackest_stretch_ratio(np.radians([64.0, 68.0]))
    >>> print(slackest.round(4))
    [1.281 1.4523]
    >>> print(np.degrees(current_wrap_angle(slackest, np.radians([64.0, 68.0]))).round(4))
    [54.7356 54.7356]
    """
    cosine2, sine2 = _squares_of_angle(wrap_angle)
    return np.asarray(np.maximum(np.cbrt(sine2 / cosine2 / 2), 1.0))


def current_wrap_angle(
    stretch_ratio: ArrayLike, wrap_angle: ArrayLike, *, core: Core = "isochoric"
) -> Floats:
    r"""Angle of the helix on the stretched cylinder.

    .. math:: \tan a = \tan a_0 \, \lambda_r / \lambda_h

    Notes
    -----
    Source: [1]_, eq. (7), :math:`\lambda_r/\lambda_h = \lambda_h^{-3/2}`.

    Examples
    --------
    >>> print(np.degrees(current_wrap_angle(2.3, np.radians(68.0))).round(2))
    35.36
    """
    stretch, (cosine2, sine2) = (
        as_positive("stretch_ratio", stretch_ratio),
        _squares_of_angle(wrap_angle),
    )
    tangent = np.sqrt(_squared_radius_ratio(stretch, core) * sine2 / cosine2) / stretch
    return np.asarray(np.arctan(tangent))


def wrap_angle_for(
    stretch_ratio: ArrayLike, cord_stretch_ratio: ArrayLike, *, core: Core = "isochoric"
) -> Floats:
    r"""Angle at rest for which both stretch ratios occur together.

    .. math:: \cos^2 a_0 = \frac{\lambda_c^2 - \lambda_r^2}{\lambda_h^2 - \lambda_r^2}

    Notes
    -----
    Source: [1]_, eq. (8) solved for the angle.

    Examples
    --------
    Cords strained by 5.65 % at the 130 % of the second hose of [1]_, sec. 3.0:

    >>> print(np.degrees(wrap_angle_for(2.3, 1.0565)).round(2))
    68.0
    """
    stretch = as_positive("stretch_ratio", stretch_ratio)
    cord2 = as_positive("cord_stretch_ratio", cord_stretch_ratio) ** 2
    radius2 = _squared_radius_ratio(stretch, core)
    with np.errstate(invalid="ignore", divide="ignore"):
        tangent2 = (stretch**2 - cord2) / (cord2 - radius2)
        is_angle = (tangent2 > 0) & np.isfinite(tangent2)
        return np.asarray(np.arctan(np.sqrt(np.where(is_angle, tangent2, np.nan))))


def ribbon_width(wrap_diameter: ArrayLike, wrap_angle: ArrayLike) -> Floats:
    r"""Cutting width of the ribbon of one layer.

    Parameters
    ----------
    wrap_diameter : array_like, shape (...)
        Mean diameter of the layer at rest. [m]
    wrap_angle : array_like, shape (...)
        Required angle, from the hose axis, 0 to below pi/2. [rad]

    Returns
    -------
    width : ndarray, shape (...)
        Across the cords, :math:`\pi d_w \cos\alpha_0`. [m]

    Raises
    ------
    DataError
        If a diameter is not positive or an angle is outside its range.

    Notes
    -----
    Eq. 10 of [1]_ (module): :math:`p_c \sin\alpha_0` with the pitch :math:`p_c = \pi d_w /
    \tan\alpha_0` is the same.  Each of two layers needs its own width, since their diameters
    differ.

    Examples
    --------
    A 3.5 in layer at 64 degrees, in inches.

    >>> print(ribbon_width(3.5, np.radians(64)).round(3))
    4.82
    """
    angle = as_finite("wrap_angle", wrap_angle)
    if np.any((angle < 0) | (angle >= pi / 2)):
        raise DataError(
            "wrap_angle is not an angle of a ribbon",
            found=f"{np.degrees(angle).min():g} to {np.degrees(angle).max():g} deg",
            needed="from 0 to below 90 deg",
        )
    return np.asarray(pi * as_positive("wrap_diameter", wrap_diameter) * np.cos(angle))


def number_of_cords(
    wrap_diameter: ArrayLike, wrap_angle: ArrayLike, cords_per_length: ArrayLike
) -> Floats:
    """Number of cords in a cross-section of the hose, both layers together.

    Notes
    -----
    Eq. 11 of [1]_ (module), with eq. 10.

    Examples
    --------
    3.5 in and 34 cords per inch, 64 and 68 degrees.

    >>> print(number_of_cords(3.5, np.radians([64, 68]), 34).round(1))
    [327.8 280.1]
    """
    density = as_positive("cords_per_length", cords_per_length)
    return 2 * ribbon_width(wrap_diameter, wrap_angle) * density


@dataclass(frozen=True)
@read_only_arrays
class _CordStrainChart:
    """Cord strain over hose strain for a family of wrap angles.

    Hose strains refer to the whole relaxed length.
    """

    cord_strain: Floats
    pick_up_strain: Floats


def cord_strain_chart(
    wrap_angle: ArrayLike, strain: ArrayLike, *, dead_length_share: float = 0.0
) -> _CordStrainChart:
    """Cord strain over hose strain for a family of wrap angles: Figure 7.

    Notes
    -----
    Eq. 8 of [1]_ (module).

    Examples
    --------
    >>> chart = cord_strain_chart(np.radians([54.0, 64.0, 68.0]), [0.5, 1.0])
    >>> print(chart.cord_strain.round(3))
    [[ 0.102 0.307]
     [-0.015 0.083]
     [-0.057 -0.004]]
    """
    angle, along = as_finite("wrap_angle", wrap_angle), as_finite("strain", strain)
    free = _free(dead_length_share)
    return _CordStrainChart(
        cord_strain=cord_stretch_ratio(1 + along / free, angle[:, None]) - 1,
        pick_up_strain=free * (pick_up_stretch_ratio(angle) - 1),
    )


def _free(dead_length_share: float) -> float:
    if not 0 <= dead_length_share < 1:
        raise DataError(
            "dead_length_share is not a share",
            found=f"{dead_length_share:g}",
            needed="0 to below 1",
        )
    return 1 - dead_length_share


@dataclass(frozen=True)
@read_only_arrays
class _LayerRange:
    """Strain of a helical layer while the hose goes from rest to a strain.

    Arrays have the joint shape (...) of angles and strains.
    """

    least_strain: Floats
    greatest_strain: Floats


def layer_range(
    wrap_angle: ArrayLike, hose_strain: ArrayLike, *, dead_length_share: ArrayLike = 0.0
) -> _LayerRange:
    """Least and greatest strain of a layer while the hose is stretched from rest.

    Notes
    -----
    Eq. 8 of [1]_ (module); convex, so no search is needed.  The report says that a steep layer will
    "not be stretched, just changed in [its] geometry": it is also shortened.

    Examples
    --------
    A layer at 71.1 degrees over a working range of 146 %: not stretched, but compressed by 9 %.

    >>> layer = layer_range(np.radians(71.1), 1.46)
    >>> print(layer.greatest_strain, layer.least_strain.round(3))
    0.0 -0.09
    """
    angle = np.asarray(wrap_angle, dtype=np.float64)
    stretch = _stretch(hose_strain, dead_length_share)
    angle, stretch = np.broadcast_arrays(angle, stretch)
    shortest = np.minimum(slackest_stretch_ratio(angle), stretch)
    final, least = (
        # at rest nothing is strained, whatever the rounding
        np.where(one > 1, cord_stretch_ratio(one, angle) - 1, 0.0)
        for one in (stretch, shortest)
    )
    return _LayerRange(
        least_strain=np.asarray(least), greatest_strain=np.asarray(np.maximum(final, 0))
    )


def least_layer_angle(
    hose_strain: ArrayLike, *, strain_limit: ArrayLike = 0.0, dead_length_share: ArrayLike = 0.0
) -> Floats:
    r"""Smallest wrap angle at which a layer is nowhere stretched beyond its limit.

    Notes
    -----
    The greatest strain is at the end of the range, so the angle follows from eq. 8 of [1]_
    (module) there; for no stretch at all :math:`\tan^2\alpha_0 = \lambda_h^2 + \lambda_h`.

    Examples
    --------
    A hose that works at 146 %: its protection at 71.1 degrees, or at 69.4 if it withstands 5 %.

    >>> print(np.degrees(least_layer_angle(1.46, strain_limit=[0, 0.05])).round(1))
    [71.1 69.4]
    """
    stretch = _stretch(hose_strain, dead_length_share)
    limit = _limit("strain_limit", strain_limit)
    stretch, limit = np.broadcast_arrays(stretch, limit)
    is_free = 1 + limit >= stretch  # even along the hose it is stretched no further
    safe = np.where(is_free, 2.0, stretch)
    angle = wrap_angle_for(safe, np.where(is_free, 1.0, 1 + limit))
    return np.asarray(np.where(is_free, 0.0, angle))


def greatest_layer_angle(
    hose_strain: ArrayLike, *, compression_limit: ArrayLike, dead_length_share: ArrayLike = 0.0
) -> Floats:
    r"""Greatest wrap angle at which a layer is nowhere compressed beyond its limit.

    Notes
    -----
    From eq. 8 of [1]_ (module) the least stretch ratio :math:`\lambda` of a layer obeys
    :math:`\lambda^6 = \tfrac{27}{4} \sin^4\alpha_0 \cos^2\alpha_0`; with :math:`q =
    \cos^2\alpha_0` that is a cubic, and :math:`q = \tfrac23 [1 + \cos(\tfrac23
    \arccos\lambda^3 - \tfrac{4\pi}{3})]`.  Where the range ends before that least ratio, the
    ratio at its end is used.  Below `least_layer_angle` no angle satisfies both limits.

    Examples
    --------
    A conductor that withstands 2 % of compression has to lie below 62.7 degrees, where a hose at
    146 % stretches it by 26 %: no angle avoids both.

    >>> print(np.degrees(greatest_layer_angle(1.46, compression_limit=0.02)).round(1))
    62.7
    """
    stretch = _stretch(hose_strain, dead_length_share)
    limit = _limit("compression_limit", compression_limit)
    if np.any(limit >= 1):
        raise DataError(
            "compression_limit leaves no length", found=f"{limit.max():g}", needed="below 1"
        )
    stretch, limit = np.broadcast_arrays(stretch, limit)
    ratio = 1 - limit
    along = 2 / 3 * (1 + np.cos(2 / 3 * np.arccos(ratio**3) - 4 * pi / 3))
    inside = np.arccos(np.sqrt(np.clip(along, 0, 1 / 3)))
    # where the range ends early: the angle with that ratio at its end
    is_free = ratio**2 * stretch <= 1
    is_at_rest = stretch == 1
    at_end = wrap_angle_for(
        np.where(is_free | is_at_rest, 2.0, stretch), np.where(is_free | is_at_rest, 1.0, ratio)
    )
    at_end = np.where(is_free | is_at_rest, pi / 2, at_end)
    return np.asarray(np.where(slackest_stretch_ratio(inside) <= stretch, inside, at_end))


def _limit(name: str, limit: ArrayLike) -> Floats:
    value = np.asarray(limit, dtype=np.float64)
    if not np.all(value >= 0):
        raise DataError(f"{name} is negative or missing", needed="zero or more")
    return value


def _stretch(hose_strain: ArrayLike, dead_length_share: ArrayLike) -> Floats:
    strain = as_finite("hose_strain", hose_strain)
    share = as_finite("dead_length_share", dead_length_share)
    if np.any(strain < 0):
        raise DataError("hose_strain is negative", found=f"{strain.min():g}", needed="zero or more")
    if np.any((share < 0) | (share >= 1)):
        raise DataError("dead_length_share is not a share", needed="from 0 to below 1")
    return np.asarray(1 + strain / (1 - share))
