r"""Layers of a hose that are to carry no load: fish-bite protection, conductors.

They follow the hose as its cords do, :math:`\lambda^2 = \lambda_h^2\cos^2\alpha_0 +
\sin^2\alpha_0/\lambda_h`, at any diameter: the wall is incompressible and so is its filling,
and every radius shrinks by the same factor.  The square is convex in the hose stretch, so over
a range from rest the *greatest* strain stands at an end and the *least* at
:math:`\lambda_h^3 = \tan^2\alpha_0 / 2`, where the current angle is 54.7356 degrees.

A layer that is steep enough not to be stretched is therefore compressed on the way, the more
the steeper it is: `least_layer_angle` and `greatest_layer_angle` are the two sides of a window
that closes when the hose stretches far.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   sections 1.2 and 2.0, eq. 8.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite
from reduction.errors import DataError
from reduction.predict.cord import cord_stretch_ratio, slackest_stretch_ratio
from reduction.predict.wrapangle import wrap_angle_for
from reduction.record import Bools, Floats, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class LayerRange:
    """Strain of a helical layer while the hose goes from rest to a strain.

    Arrays have the shape (...) of angles and strains together.

    Parameters
    ----------
    least_strain, greatest_strain : ndarray
        Of the layer. [1]
    strain_at_least, strain_at_greatest : ndarray
        Of the hose, where they occur. [1]
    final_strain : ndarray
        Of the layer at the end of the range. [1]
    is_compressed, is_over_limit : ndarray of bool
        Shorter than at rest somewhere; longer than its limit somewhere.
    """

    least_strain: Floats
    greatest_strain: Floats
    strain_at_least: Floats
    strain_at_greatest: Floats
    final_strain: Floats
    is_compressed: Bools
    is_over_limit: Bools


def layer_range(
    wrap_angle: ArrayLike,
    hose_strain: ArrayLike,
    *,
    strain_limit: ArrayLike = np.inf,
    dead_length_share: ArrayLike = 0.0,
) -> LayerRange:
    """Least and greatest strain of a layer while the hose is stretched from rest.

    Parameters
    ----------
    wrap_angle : array_like, shape (...)
        Of the layer at rest, from the hose axis. [rad]
    hose_strain : array_like, shape (...)
        End of the range, of the whole length: at the working load, or at the break. [1]
    strain_limit : array_like, shape (...)
        Greatest tensile strain that the layer bears. [1]
    dead_length_share : array_like, shape (...)
        Of the hose. [1]

    Returns
    -------
    range : LayerRange
        Strains of the layer, where they occur, and what is exceeded.

    Raises
    ------
    SettingsError
        If an angle is not between 0 and 90 deg.
    DataError
        If a strain, limit or share is outside its range.

    Notes
    -----
    Eq. 8 of [1]_ (module); convex, hence no search.  The report says that a steep layer will
    "not be stretched, just changed in [its] geometry": it is also shortened.

    Examples
    --------
    A layer at 71.1 degrees over a working range of 146 %: not stretched, but 9 % compressed at
    62 %.

    >>> layer = layer_range(np.radians(71.1), 1.46)
    >>> print(layer.greatest_strain, layer.least_strain.round(3), layer.strain_at_least.round(2))
    0.0 -0.09 0.62
    """
    angle = np.asarray(wrap_angle, dtype=np.float64)
    stretch = _stretch(hose_strain, dead_length_share)
    limit = _limit("strain_limit", strain_limit)
    angle, stretch, limit = np.broadcast_arrays(angle, stretch, limit)
    share = np.asarray(dead_length_share, dtype=np.float64)
    shortest = np.minimum(slackest_stretch_ratio(angle), stretch)
    final, least = (
        # at rest nothing is strained, which rounding may not say
        np.where(one > 1, cord_stretch_ratio(one, angle) - 1, 0.0)
        for one in (stretch, shortest)
    )
    return LayerRange(
        least_strain=np.asarray(least),
        greatest_strain=np.asarray(np.maximum(final, 0)),
        strain_at_least=np.asarray((1 - share) * (shortest - 1)),
        strain_at_greatest=np.asarray(np.where(final > 0, (1 - share) * (stretch - 1), 0)),
        final_strain=np.asarray(final),
        is_compressed=np.asarray(least < 0),
        is_over_limit=np.asarray(final > limit),
    )


def least_layer_angle(
    hose_strain: ArrayLike, *, strain_limit: ArrayLike = 0.0, dead_length_share: ArrayLike = 0.0
) -> Floats:
    r"""Smallest wrap angle at which a layer is nowhere stretched beyond its limit.

    Parameters
    ----------
    hose_strain : array_like, shape (...)
        End of the range, of the whole length: at the working load, or at the break. [1]
    strain_limit : array_like, shape (...)
        Greatest tensile strain that the layer bears; 0 where it is not to be stretched. [1]
    dead_length_share : array_like, shape (...)
        Of the hose. [1]

    Returns
    -------
    wrap_angle : ndarray, shape (...)
        From the hose axis; 0 where every angle will do. [rad]

    Raises
    ------
    DataError
        If a strain, limit or share is outside its range.

    Notes
    -----
    The greatest strain stands at the end of the range, so the angle is that of eq. 8 of [1]_
    (module) there; for no stretch at all :math:`\tan^2\alpha_0 = \lambda_h^2 + \lambda_h`.

    Examples
    --------
    A hose that works at 146 %: its protection at 71.1 degrees, or at 69.4 where it bears 5 %.

    >>> print(np.degrees(least_layer_angle(1.46, strain_limit=[0, 0.05])).round(1))
    [71.1 69.4]
    """
    stretch = _stretch(hose_strain, dead_length_share)
    limit = _limit("strain_limit", strain_limit)
    stretch, limit = np.broadcast_arrays(stretch, limit)
    is_free = 1 + limit >= stretch  # even along the hose it is not stretched further
    safe = np.where(is_free, 2.0, stretch)
    angle = wrap_angle_for(safe, np.where(is_free, 1.0, 1 + limit))
    return np.asarray(np.where(is_free, 0.0, angle))


def greatest_layer_angle(
    hose_strain: ArrayLike, *, compression_limit: ArrayLike, dead_length_share: ArrayLike = 0.0
) -> Floats:
    r"""Greatest wrap angle at which a layer is nowhere compressed beyond its limit.

    Parameters
    ----------
    hose_strain : array_like, shape (...)
        End of the range, of the whole length: at the working load, or at the break. [1]
    compression_limit : array_like, shape (...)
        Greatest compressive strain that the layer bears, a positive number below 1. [1]
    dead_length_share : array_like, shape (...)
        Of the hose. [1]

    Returns
    -------
    wrap_angle : ndarray, shape (...)
        From the hose axis; pi/2 where every angle will do. [rad]

    Raises
    ------
    DataError
        If a strain, limit or share is outside its range.

    Notes
    -----
    From eq. 8 of [1]_ (module) the least stretch ratio :math:`\lambda` of a layer obeys
    :math:`\lambda^6 = \tfrac{27}{4} \sin^4\alpha_0 \cos^2\alpha_0`; with :math:`q =
    \cos^2\alpha_0` that is a cubic, and :math:`q = \tfrac23 [1 + \cos(\tfrac23
    \arccos\lambda^3 - \tfrac{4\pi}{3})]`.  Where the range ends before that least ratio, the
    ratio at its end decides.  Below `least_layer_angle` there is no angle that does both.

    Examples
    --------
    A conductor that bears 2 % of compression has to lie below 62.7 degrees, where a hose at
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
    # where the range ends early: the angle that is just so short at its end
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
        raise DataError("dead_length_share is no share", needed="from 0 to below 1")
    return np.asarray(1 + strain / (1 - share))
