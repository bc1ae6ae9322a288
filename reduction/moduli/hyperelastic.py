r"""Nominal stress of incompressible hyperelastic laws in three homogeneous deformations.

Every law here is linear in its moduli; only the exponents of Ogden's are not.  With the
stretch ratio :math:`\lambda` along the pull, the principal stretches are

- uniaxial: :math:`\lambda, \lambda^{-1/2}, \lambda^{-1/2}`;
- equibiaxial: :math:`\lambda, \lambda, \lambda^{-2}`;
- pure shear: :math:`\lambda, 1, \lambda^{-1}`.

References
----------
.. [1] R. W. Ogden, "Large deformation isotropic elasticity," Proc. R. Soc. Lond. A 326,
   1972.
.. [2] O. H. Yeoh, "Characterization of elastic properties of carbon-black-filled rubber
   vulcanizates," Rubber Chem. Technol. 63(5), 1990.
.. [3] L. R. G. Treloar, "The Physics of Rubber Elasticity," 3rd ed., Oxford, 1975, ch. 5.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive
from reduction.errors import DataError
from reduction.record import Floats

Law = Literal["neo-hookean", "mooney-rivlin", "yeoh", "ogden-2"]
Deformation = Literal["uniaxial", "equibiaxial", "pure-shear"]
LAWS: tuple[Law, ...] = ("neo-hookean", "mooney-rivlin", "yeoh", "ogden-2")
PARAMETERS: dict[Law, tuple[str, ...]] = {
    "neo-hookean": ("shear_modulus",),
    "mooney-rivlin": ("c10", "c01"),
    "yeoh": ("c10", "c20", "c30"),
    "ogden-2": ("modulus_1", "modulus_2", "exponent_1", "exponent_2"),
}
# The stretch across the pull is the stretch along it to this power.
LATERAL: dict[Deformation, float] = {"uniaxial": -0.5, "equibiaxial": -2.0, "pure-shear": -1.0}


def _checked(stretch_ratio: ArrayLike, deformation: Deformation) -> Floats:
    if deformation not in LATERAL:
        raise DataError(
            "no such deformation", found=str(deformation), needed=", ".join(sorted(LATERAL))
        )
    return as_positive("stretch_ratio", stretch_ratio)


def polynomial_columns(
    stretch_ratio: ArrayLike, *, law: Law, deformation: Deformation = "uniaxial"
) -> Floats:
    r"""Nominal stress per unit of each modulus of a law in the invariants.

    .. math::

        P = 2 (\lambda - \lambda^{2q-1}) (\partial W/\partial I_1 + m \, \partial W/\partial I_2)

    with q the power of the lateral stretch (-1/2, -2, -1) and m = 1/lambda, lambda
    squared and 1 in uniaxial, equibiaxial and pure-shear deformation.

    Parameters
    ----------
    stretch_ratio : array_like, shape (n_samples,)
        1 + strain. [1]
    law : str
        ``neo-hookean``, ``mooney-rivlin`` or ``yeoh``.
    deformation : str, optional
        ``uniaxial``, ``equibiaxial`` or ``pure-shear``.

    Returns
    -------
    columns : ndarray, shape (n_samples, n_parameters)
        In the order of `PARAMETERS`. [1]

    Raises
    ------
    DataError
        If a stretch ratio is not positive, or the law or deformation is unknown.

    Notes
    -----
    Neo-Hookean: W = G/2 (I1 - 3).  Mooney-Rivlin: W = c10 (I1 - 3) + c01 (I2 - 3).  Yeoh
    ([2]_): W = sum of ci0 (I1 - 3)^i, i = 1..3.  Equibiaxial stress is that along one of
    the two pulls.

    Examples
    --------
    >>> print(polynomial_columns([2.0], law="neo-hookean"))
    [[1.75]]
    """
    stretch = _checked(stretch_ratio, deformation)
    lateral = LATERAL[deformation]
    pull = stretch - stretch ** (2 * lateral - 1)
    if law == "neo-hookean":
        return pull[:, None]
    if law == "mooney-rivlin":
        powers: dict[Deformation, float] = {"uniaxial": -1, "equibiaxial": 2, "pure-shear": 0}
        return (
            2 * pull[:, None] * np.stack([np.ones_like(stretch), stretch ** powers[deformation]], 1)
        )
    if law == "yeoh":
        other = {
            "uniaxial": stretch**-1.0,
            "equibiaxial": stretch**2,
            "pure-shear": np.ones_like(stretch),
        }
        excess = stretch**2 + stretch ** (2 * lateral) + other[deformation] - 3
        return 2 * pull[:, None] * np.stack([np.ones_like(stretch), 2 * excess, 3 * excess**2], 1)
    raise DataError("not a law in the invariants", found=str(law), needed="one of the first three")


def ogden_columns(
    stretch_ratio: Floats, exponents: Floats, *, deformation: Deformation = "uniaxial"
) -> Floats:
    r"""Nominal stress per unit of each modulus of Ogden's law.

    .. math:: P = \sum_i \mu_i (\lambda^{\alpha_i - 1} - \lambda^{q \alpha_i - 1})

    Parameters
    ----------
    stretch_ratio : ndarray, shape (n_samples,)
        1 + strain. [1]
    exponents : ndarray, shape (n_terms,) or (..., 1, n_terms)
        :math:`\alpha_i`, or several sets of them. [1]
    deformation : str, optional
        ``uniaxial``, ``equibiaxial`` or ``pure-shear``.

    Returns
    -------
    columns : ndarray, shape (..., n_samples, n_terms)
        One a term. [1]

    Raises
    ------
    DataError
        If a stretch ratio is not positive, or the deformation is unknown.

    Notes
    -----
    [1]_ with :math:`W = \sum \mu_i/\alpha_i (\lambda_1^{\alpha_i} + \lambda_2^{\alpha_i} +
    \lambda_3^{\alpha_i} - 3)`, so that the shear modulus is half the sum of
    :math:`\mu_i \alpha_i`; finite-element codes often print :math:`\mu_i \alpha_i / 2`.

    Examples
    --------
    Exponent 2 is the neo-Hookean law.

    >>> print(ogden_columns(np.array([2.0]), np.array([2.0])))
    [[1.75]]
    """
    log = np.log(_checked(stretch_ratio, deformation))[:, None]
    columns: Floats = np.exp((exponents - 1) * log) - np.exp(
        (LATERAL[deformation] * exponents - 1) * log
    )
    return columns


def ogden_slopes(
    stretch_ratio: Floats, exponents: Floats, *, deformation: Deformation = "uniaxial"
) -> Floats:
    r"""Derivatives of the columns of Ogden's law, each by its own exponent.

    .. math:: \ln\lambda \, (\lambda^{\alpha_i - 1} - q \lambda^{q \alpha_i - 1})

    Parameters
    ----------
    stretch_ratio, exponents, deformation
        As for `ogden_columns`. [1], [1]

    Returns
    -------
    slopes : ndarray, shape (..., n_samples, n_terms)
        One a term. [1]

    Raises
    ------
    DataError
        If a stretch ratio is not positive, or the deformation is unknown.

    Examples
    --------
    >>> print(ogden_slopes(np.array([2.0]), np.array([2.0])).round(4))
    [[1.4729]]
    """
    log = np.log(_checked(stretch_ratio, deformation))[:, None]
    lateral = LATERAL[deformation]
    slopes: Floats = log * (
        np.exp((exponents - 1) * log) - lateral * np.exp((lateral * exponents - 1) * log)
    )
    return slopes


def hyperelastic_stress(
    strain: ArrayLike,
    *,
    law: Law,
    parameters: dict[str, float],
    deformation: Deformation = "uniaxial",
) -> Floats:
    """Nominal stress of a law.

    Parameters
    ----------
    strain : array_like, shape (n_samples,)
        Nominal strain along the pull. [1]
    law : str
        One of `LAWS`.
    parameters : dict of str to float
        By the names of `PARAMETERS`. [Pa], [1]
    deformation : str, optional
        ``uniaxial``, ``equibiaxial`` or ``pure-shear``.

    Returns
    -------
    stress : ndarray, shape (n_samples,)
        Force over the area before stretch. [Pa]

    Raises
    ------
    DataError
        If a strain is -1 or less, or the law or deformation is unknown.

    Examples
    --------
    >>> print(hyperelastic_stress([1.0], law="neo-hookean", parameters={"shear_modulus": 4e5}))
    [700000.]
    """
    stretch = 1 + np.atleast_1d(np.asarray(strain, dtype=np.float64))
    values = np.array([parameters[name] for name in PARAMETERS[law]])
    if law == "ogden-2":
        return np.asarray(ogden_columns(stretch, values[2:], deformation=deformation) @ values[:2])
    return np.asarray(polynomial_columns(stretch, law=law, deformation=deformation) @ values)
