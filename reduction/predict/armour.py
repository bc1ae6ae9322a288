"""Forces in one wire of an armour layer that is stretched with its cable.

References
----------
.. [1] H. Wang, Z. Yang, J. Yan, G. Wang, D. Shi, B. Zhou and Y. Li, "Prediction Method and
   Validation Study of Tensile Performance of Reinforced Armor Layer in Marine Flexible
   Pipe/Cables," J. Mar. Sci. Eng., vol. 10, 642, 2022.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import SettingsError
from reduction.predict.armourangles import predict_intermediate, predict_large, predict_small
from reduction.predict.armourdesign import ArmourDesign, ArmourResponse, ArmourTheory
from reduction.predict.armourexact import predict_conjugate, predict_exact
from reduction.record import Floats

_PREDICT: dict[ArmourTheory, Callable[[ArmourDesign, Floats], ArmourResponse]] = {
    "small": predict_small,
    "intermediate": predict_intermediate,
    "large": predict_large,
    "exact": predict_exact,
    "conjugate": predict_conjugate,
}


def predict_armour(
    design: ArmourDesign, strain: ArrayLike, *, theory: ArmourTheory = "exact"
) -> ArmourResponse:
    """Forces, moments and stresses of one wire at each strain of the cable.

    Parameters
    ----------
    design : ArmourDesign
        Shape (...).
    strain : array_like, shape (n_strain,)
        Of the cable along its axis; a number stands for one. [1]
    theory : {"small", "intermediate", "large", "exact", "conjugate"}
        Three theories of the report; ``exact`` is the rod that the first two simplify,
        ``conjugate`` the one whose forces derive from an energy.

    Returns
    -------
    response : ArmourResponse
        Arrays of shape (..., n_strain).

    Raises
    ------
    SettingsError
        If the theory is unknown, or the strain is not a series of numbers above -1.

    Notes
    -----
    Source: [1]_.  The material is elastic at any stress: `reduction.predict.armouryield` says
    where a wire yields.  The core is rigid; where it gives, or the wire thins on it, the wire is
    strained less (`reduction.predict.armourerror.thinning_loss`).  A strain below zero is
    computed, and flagged: wires under compression leave the core.

    Examples
    --------
    The steel and the strain of [1]_, sec. 4: stress 210 MPa times the squared cosine

    >>> design = ArmourDesign(np.radians([20.0, 30.0, 80.0]), 2.5e-3, 25e-3, 210e9)
    >>> wire = predict_armour(design, 1e-3, theory="intermediate")
    >>> print((wire.axial_stress[:, 0] / 1e6).round(2))
    [185.43 157.5 6.33]
    """
    if theory not in _PREDICT:
        raise SettingsError(
            "the theory of the armour is not known", found=repr(theory), needed=", ".join(_PREDICT)
        )
    series = np.array(strain, dtype=np.float64, ndmin=1)
    if series.ndim != 1 or series.size == 0:
        raise SettingsError(
            "strain is not a series", found=f"shape {series.shape}", needed="(n_strain,)"
        )
    bad = ~(np.isfinite(series) & (series > -1))
    if bad.any():
        raise SettingsError(
            f"{int(bad.sum())} of {series.size} strains are none of a cable, "
            f"first at index {int(np.flatnonzero(bad)[0])}",
            found=f"{series[bad][0]:g}",
            needed="numbers above -1",
        )
    return _PREDICT[theory](design, series)
