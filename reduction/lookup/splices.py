r"""Splices of a tether that is to be deployed: as they were tested, or as they are stated.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 2.3, Table 3.
"""

from __future__ import annotations

from dataclasses import dataclass

from reduction.checks import as_positive
from reduction.errors import DataError, SettingsError
from reduction.strain.inverse import with_free_length
from reduction.strain.model import StrainModel


@dataclass(frozen=True)
class StatedSplices:
    """Splices of a tether, without a test of their own.

    Parameters
    ----------
    length : float
        Of both together, relaxed; zero where there are none. [m]
    strain_ratio : float or None
        Their strain over that of the free length. [1]
    strain, at_tension : float or None
        Theirs at a tension; rigid where neither this nor a ratio is stated. [1], [N]
    exponent : float
        Of the tension, with ``strain``. [1]
    """

    length: float
    strain_ratio: float | None = None
    strain: float | None = None
    at_tension: float | None = None
    exponent: float = 1.0

    def __post_init__(self) -> None:
        """Refuse splices that are none."""
        checks = (
            ("length", self.length, self.length >= 0, "zero or above"),
            ("strain_ratio", self.strain_ratio, (self.strain_ratio or 0.0) >= 0, "zero or above"),
            ("strain", self.strain, self.strain is None or self.strain > 0, "above zero"),
            (
                "at_tension",
                self.at_tension,
                self.at_tension is None or self.at_tension > 0,
                "above zero",
            ),
            ("exponent", self.exponent, 0 < self.exponent < 2, "above 0, below 2"),
        )
        for name, value, holds, needed in checks:
            if not holds:
                raise SettingsError(
                    f"{name} is no number of a splice", found=f"{value:g}", needed=needed
                )


def stated_model(splices: StatedSplices, free_length: float, *, name: str) -> StrainModel:
    r"""Strain model of a tether with stated splices.

    .. math:: \ell_s(F) = \ell_{s0} (1 + \rho\,\varepsilon) \quad \text{or} \quad
       \ell_{s0} \Big(1 + \varepsilon_1 \big(F / F_1\big)^n\Big)

    Parameters
    ----------
    splices : StatedSplices
        Length and law.
    free_length : float
        Relaxed, splice toe to splice toe. [m]
    name : str
        Of the tether.

    Returns
    -------
    model : StrainModel
        By gauge-length without splices, by strain-ratio or by tension-driven with them.

    Raises
    ------
    DataError
        If the free length is not positive.

    Notes
    -----
    The two laws are those of the strain correction: a splice that strains by a share of what the
    rubber does, or by its tension ([1]_ has the first one from Table 3).

    Examples
    --------
    >>> from reduction.strain.inverse import position_by_model
    >>> splices = StatedSplices(1.2, strain=0.4, at_tension=900.0, exponent=0.85)
    >>> model = stated_model(splices, 2.5, name="T")
    >>> print(position_by_model(model, strain=1.0, tension=900.0).round(6))
    6.68
    """
    free = float(as_positive("free_length", free_length))
    if splices.length == 0:
        return StrainModel(name, "gauge-length", {"reference_position": free, "gauge_length": free})
    lengths = {"relaxed_free_length": free, "relaxed_splice_length": splices.length}
    if splices.strain is not None and splices.at_tension is not None:
        compliance = splices.strain / splices.at_tension**splices.exponent
        law = {"splice_compliance": compliance, "splice_exponent": splices.exponent}
        return StrainModel(name, "tension-driven", lengths | law)
    ratio = splices.strain_ratio or 0.0
    return StrainModel(name, "strain-ratio", lengths | {"splice_strain_ratio": ratio})


def deployed_model(model: StrainModel, free_length: float | None) -> StrainModel:
    """Strain model of a tether that is deployed, from the one that was tested.

    Parameters
    ----------
    model : StrainModel
        Of the test.
    free_length : float or None
        Relaxed, of the deployed tether; None where it is the tested one. [m]

    Returns
    -------
    model : StrainModel
        Whose positions are lengths, thimble to thimble.

    Raises
    ------
    DataError
        If the method says nothing of the length of a tether, or of one of another length.

    Notes
    -----
    By gauge-length a position may be a displacement from anywhere: of a tether without splices
    the free length is the length.  See `reduction.strain.inverse.with_free_length` for the rest;
    a third of a tether of [1]_, Table 3, is splices.

    Examples
    --------
    >>> model = StrainModel("T", "gauge-length", {"reference_position": 0.0, "gauge_length": 2.0})
    >>> deployed_model(model, None).coefficients["reference_position"]
    2.0
    """
    if model.method == "extensometer":
        raise DataError(
            f"strain of '{model.specimen}' is from an extensometer, which knows no splices",
            needed="splices that are stated",
        )
    if model.method == "gauge-length":
        own = model.coefficients["gauge_length"]
        return stated_model(StatedSplices(0.0), free_length or own, name=model.specimen)
    return model if free_length is None else with_free_length(model, free_length)
