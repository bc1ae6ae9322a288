r"""At which strain of the cable the wires of a layer begin to yield, and what they carry there.

References
----------
.. [1] H. Wang, Z. Yang, J. Yan, G. Wang, D. Shi, B. Zhou and Y. Li, "Prediction Method and
   Validation Study of Tensile Performance of Reinforced Armor Layer in Marine Flexible
   Pipe/Cables," J. Mar. Sci. Eng., vol. 10, 642, 2022, sec. 5.3.
"""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import FitError, SettingsError
from reduction.predict.armourdesign import ArmourDesign, ArmourResponse
from reduction.predict.armourexact import predict_conjugate, predict_exact
from reduction.predict.cord import hose_stretch_ratio
from reduction.record import Floats

YieldCriterion = Literal["axial", "normal", "von-mises"]

_STEPS = 100
_CLOSE = 1e-10  # of the yield stress; strains of the cable are differences from one


def wire_stress(response: ArmourResponse, *, criterion: YieldCriterion = "von-mises") -> Floats:
    r"""Greatest stress on the section of a wire.

    .. math:: |\sigma_T|,\quad |\sigma_T| + |\sigma_{G'}|,\quad
       \sqrt{(|\sigma_T| + |\sigma_{G'}|)^2 + 3\sigma_H^2}

    Parameters
    ----------
    response : ArmourResponse
        Arrays of shape (..., n_strain).
    criterion : {"axial", "normal", "von-mises"}
        Of the axial force; with bending; with torsion too.

    Returns
    -------
    wire_stress : ndarray, shape (..., n_strain)
        To be held against a yield stress. [Pa]

    Raises
    ------
    SettingsError
        If the criterion is unknown.

    Notes
    -----
    Source: [1]_, sec. 5.3 adds axial and bending stress.  The three meet at one point of the
    surface of the wire, where the shear force has no stress.  Neither the stress of laying the
    wires nor that of contact is in it.

    Examples
    --------
    >>> from reduction.predict.armour import predict_armour
    >>> design = ArmourDesign(np.radians(45.0), 2.5e-3, 25e-3, 210e9)
    >>> wire = predict_armour(design, 1e-3, theory="intermediate")
    >>> print((wire_stress(wire, criterion="normal") / 1e6).round(2))
    [114.55]
    """
    _known(criterion)
    axial = np.abs(response.axial_stress)
    if criterion == "axial":
        return axial
    normal = axial + np.abs(response.bending_stress)
    if criterion == "normal":
        return np.asarray(normal)
    return np.asarray(np.hypot(normal, np.sqrt(3.0) * response.torsion_stress))


def yield_strain(
    design: ArmourDesign,
    yield_stress: ArrayLike,
    *,
    criterion: YieldCriterion = "von-mises",
    theory: Literal["exact", "conjugate"] = "conjugate",
) -> Floats:
    """Strain of the cable at which the wires begin to yield in extension.

    Parameters
    ----------
    design : ArmourDesign
        Shape (...).
    yield_stress : array_like, shape (...)
        Of the wires. [Pa]
    criterion : {"axial", "normal", "von-mises"}
        As `wire_stress`.
    theory : {"exact", "conjugate"}
        As `reduction.predict.armour.predict_armour`.

    Returns
    -------
    yield_strain : ndarray, shape (...)
        Of the cable. [1]

    Raises
    ------
    SettingsError
        If a yield stress is not above zero, or criterion or theory are unknown.
    FitError
        If the strain is not found: the yield strain is lost in rounding, or the wires are much
        thicker than their core.

    Notes
    -----
    Strain of the wire and strain of the cable are one in closed form (`reduction.predict.cord`),
    and the stress is all but proportional to the strain of the wire: it is scaled until the
    stress is the yield stress to 1e-10.  [1]_, sec. 5.3, takes the axial stress alone.

    Examples
    --------
    Steel of 800 MPa at 20 and 80 deg: the steeper the wires, the more the cable may stretch

    >>> design = ArmourDesign(np.radians([20.0, 80.0]), 2.5e-3, 25e-3, 210e9)
    >>> strain = yield_strain(design, 800e6, criterion="axial", theory="exact")
    >>> print((100 * strain).round(3))
    [ 0.431 11.944]
    """
    _known(criterion)
    if theory not in ("exact", "conjugate"):
        raise SettingsError(
            "no yield by this theory", found=repr(theory), needed="exact or conjugate"
        )
    limit = np.asarray(yield_stress, dtype=np.float64)
    if not np.all((limit > 0) & np.isfinite(limit)):
        raise SettingsError(
            "yield_stress is not above zero", found=f"{limit.min():g} Pa", needed="above 0 Pa"
        )
    predict = predict_exact if theory == "exact" else predict_conjugate
    shape = np.broadcast_shapes(design.shape, limit.shape)
    angle = np.broadcast_to(np.asarray(design.winding_angle, dtype=np.float64), shape)
    wire_strain = np.broadcast_to(limit / np.asarray(design.elastic_modulus), shape)
    for _ in range(_STEPS):
        strain = hose_stretch_ratio(1 + wire_strain, angle, core="rigid") - 1
        stress = wire_stress(predict(design, strain[..., None]), criterion=criterion)[..., 0]
        if np.all(np.abs(stress - limit) <= _CLOSE * limit):
            return np.asarray(strain)
        wire_strain = wire_strain * limit / stress
    worst = float(np.max(np.abs(stress / limit - 1)))
    raise FitError(
        "the strain at which the wires yield is not found",
        found=f"a stress that is still {100 * worst:.2g} % off",
        needed="a yield stress above 1e-5 of the modulus, and wires no thicker than their core",
    )


def layer_strength(design: ArmourDesign, yield_stress: ArrayLike) -> Floats:
    r"""Tension of the cable that a layer carries where its axial stress is the yield stress.

    .. math:: F = n \sigma_y A \cos\alpha

    Parameters
    ----------
    design : ArmourDesign
        Shape (...).
    yield_stress : array_like, shape (...)
        Of the wires. [Pa]

    Returns
    -------
    layer_strength : ndarray, shape (...)
        All wires together. [N]

    Raises
    ------
    SettingsError
        By the design.

    Notes
    -----
    Source: [1]_, sec. 5.3, which divides by the cosine where the component along the axis is
    to be multiplied by it: at 20 deg 13 % too much, at 80 deg 33 times.  The angle is that at
    rest, and bending, torsion and shear are left out; `yield_strain` has them.

    Examples
    --------
    >>> design = ArmourDesign(np.radians([20.0, 80.0]), 2.5e-3, 25e-3, 210e9, n_wires=30)
    >>> print((layer_strength(design, 800e6) / 1e3).round(1))
    [442.8 81.8]
    """
    along = np.asarray(yield_stress, dtype=np.float64) * design.wire_area
    return np.asarray(np.asarray(design.n_wires) * along * np.cos(design.winding_angle))


def _known(criterion: str) -> None:
    if criterion not in get_args(YieldCriterion):
        raise SettingsError(
            "the yield criterion is not known",
            found=repr(criterion),
            needed=", ".join(get_args(YieldCriterion)),
        )
