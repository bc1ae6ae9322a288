"""Whether one curve can tell several numbers of a hose apart.

A formal interval answers for the noise alone.  A fit of angle, cord scale and dead length to
one smooth curve gives three narrow intervals, and an error of the model by 1 % of the tension
moves all three by more than any workshop would be off: the question is what the curve
*shows* of a plausible error, not what the noise hides.

References
----------
.. [1] R. Brun, P. Reichert and H. R. Kunsch, "Practical identifiability analysis of large
   environmental simulation models," Water Resour. Res., vol. 37, 2001 (collinearity index).
.. [2] A. Raue et al., "Structural and practical identifiability analysis of partially observed
   dynamical models," Bioinformatics, vol. 25, 2009.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees

import numpy as np
from numpy.typing import ArrayLike

from reduction.compare.product import Identifiability
from reduction.errors import DataError, SettingsError
from reduction.record import Floats

CALIBRATED = (
    "wrap_angle",
    "rubber_modulus",
    "cord_load_scale",
    "cord_strain_scale",
    "dead_length_share",
)
"""Numbers that may be fitted; diameters and the number of cords are measured or counted."""

_ANGLE = np.radians(1.0)
_PART = 0.1
_DEAD_LENGTH = 0.05
_MODEL = 0.01  # of the tension: no smooth error below this is held against a prediction
_LEAST_SEEN = 1e-6  # of the tension: nothing
_NAMED = 0.1  # of the largest part of a direction: less is not named


def plausible_error(name: str, start: float) -> float:
    """How far a number of a hose may be off before it is measured on the hose.

    Parameters
    ----------
    name : str
        One of `CALIBRATED`.
    start : float
        Its value. [SI]

    Returns
    -------
    error : float
        1 degree of wrap angle, a twentieth of the length, a tenth of the others. [SI]

    Raises
    ------
    SettingsError
        If the number is not one to be fitted, or its tenth is nothing.

    Examples
    --------
    >>> print(plausible_error("cord_load_scale", 1.0))
    0.1
    """
    if name not in CALIBRATED:
        raise SettingsError(
            f"'{name}' cannot be calibrated", found=name, needed="one of " + ", ".join(CALIBRATED)
        )
    if name == "wrap_angle":
        return float(_ANGLE)
    if name == "dead_length_share":
        return _DEAD_LENGTH
    if not start > 0:
        raise SettingsError(
            f"{name} has no size to start a calibration from",
            found=f"{start:g}",
            needed="a value above zero",
        )
    return _PART * start


def identify_directions(
    sensitivity: ArrayLike,
    *,
    tension: ArrayLike,
    names: Sequence[str],
    plausible: ArrayLike,
    value: ArrayLike,
    contribution: ArrayLike,
    misfit: float,
) -> Identifiability:
    r"""Find the directions of the fitted numbers that the curve hardly sees.

    With :math:`S` the change of tension for one plausible error of each number and :math:`C`
    what shared errors add, all over :math:`\sqrt n` and the RMS tension, a step of unit length
    along :math:`v` cannot be told from an error of relative size :math:`\delta` where

    .. math:: \min_z \lVert S v + C z \rVert^2 + \delta^2 \lVert z \rVert^2 < \delta^2

    Parameters
    ----------
    sensitivity : array_like, shape (n_strain, n_parameter)
        Derivative of tension by each number. [N a unit]
    tension : array_like, shape (n_strain,)
        Of the fitted hose. [N]
    names : sequence of str, length n_parameter
        Numbers that were fitted.
    plausible : array_like, shape (n_parameter,)
        Of each, from `plausible_error`. [SI]
    value : array_like, shape (n_parameter,)
        Of each. [SI]
    contribution : array_like, shape (n_source, n_strain)
        Errors that were fitted beside them, each within its standard uncertainty. [N]
    misfit : float
        RMS of what the fit left. [N]

    Returns
    -------
    found : Identifiability
        The direction that the curve sees least, and all that it does not see in words.

    Raises
    ------
    DataError
        If the arrays do not pair up.

    Notes
    -----
    :math:`\delta` is 1 %, or the relative misfit where that is greater: an error of the model
    is smooth, so that more strains do not average it out, and a prediction that left 3 %
    somewhere cannot be trusted to 1 % elsewhere.  Along a direction of which a unit step changes
    the curve by less, such an error moves the numbers by :math:`\delta` over that change: more
    than one plausible error, which the noise does not say.  The unit of each number is what it
    may plausibly be off by, so that a number to which the curve does not answer (the scale of
    cords that carry little yet) is found as well as two that trade against each other.  The
    collinearity index of [1]_, which knows only the second kind, is given beside; above 10 to 15
    it is called poor there.

    Examples
    --------
    Two numbers that do the same cannot be told apart, whatever the noise.

    >>> found = identify_directions(
    ...     [[1.0, 1.0], [2.0, 2.0]], tension=[10.0, 20.0],
    ...     names=["cord_load_scale", "cord_strain_scale"], plausible=[0.1, 0.1],
    ...     value=[1.0, 1.0], contribution=np.zeros((0, 2)), misfit=0.0,
    ... )
    >>> print(found.is_identified, found.words)
    False cord_load_scale +7.1 % with cord_strain_scale -7.1 % changes the curve by 0.00 % alone
    """
    slopes = np.asarray(sensitivity, dtype=np.float64)
    level = np.asarray(tension, dtype=np.float64)
    unit = np.asarray(plausible, dtype=np.float64)
    shared = np.asarray(contribution, dtype=np.float64)
    if slopes.shape != (level.size, len(names)) or shared.shape[1:] != level.shape:
        raise DataError(
            "sensitivities do not pair up with the curve",
            found=f"{slopes.shape} and {shared.shape}",
            needed=f"({level.size}, {len(names)}) and (n_source, {level.size})",
        )
    size = float(np.sqrt(np.mean(level**2)))
    scale = np.sqrt(level.size) * size
    s, c = slopes * unit / scale, shared.T / scale
    needed = max(_MODEL, misfit / size)
    seen = s.T @ s
    if c.shape[1]:
        imitated = c.T @ c + needed**2 * np.eye(c.shape[1])
        seen = seen - s.T @ c @ np.linalg.solve(imitated, c.T @ s)
    strength, axes = np.linalg.eigh(seen)
    change = np.sqrt(np.maximum(strength, 0.0))
    axes = axes * np.where(np.take_along_axis(axes, _largest(axes), 0) < 0, -1.0, 1.0)
    least = axes[:, 0] * unit
    words = [
        _words(names, axes[:, k], unit, np.asarray(value, dtype=np.float64), float(change[k]))
        for k in range(len(names))
        if change[k] < needed
    ]
    unseen = change < needed
    reach = needed / np.maximum(change[unseen], _LEAST_SEEN) * axes[:, unseen] * unit[:, None]
    return Identifiability(
        least_change=float(change[0]),
        needed_change=needed,
        direction=least,
        collinearity=_collinearity(s),
        is_identified=not words,
        words="; ".join(words),
        open_covariance=reach @ reach.T,
    )


def _largest(axes: Floats) -> np.ndarray:
    """Row of the first entry of each column that is as large as any, up to rounding."""
    size = np.abs(axes)
    return np.asarray(np.argmax(size > 0.999 * size.max(axis=0), axis=0))[None, :]


def _collinearity(s: Floats) -> float:
    length = np.linalg.norm(s, axis=0)
    if not np.all(length > 0):
        return float("inf")
    least = float(np.linalg.svd(s / length, compute_uv=False)[-1])
    return 1 / least if least > 0 else float("inf")


def _words(
    names: Sequence[str], direction: Floats, unit: Floats, value: Floats, change: float
) -> str:
    size = np.abs(direction)
    parts = [
        _step(names[k], float(direction[k] * unit[k]), float(value[k]))
        for k in range(len(names))
        if size[k] >= _NAMED * size.max()
    ]
    return f"{' with '.join(parts)} changes the curve by {100 * change:.2f} % alone"


def _step(name: str, step: float, value: float) -> str:
    if name == "wrap_angle":
        return f"{name} {degrees(step):+.2f} deg"
    if name == "dead_length_share":
        return f"{name} {100 * step:+.1f} points"
    return f"{name} {100 * step / value:+.1f} %"
