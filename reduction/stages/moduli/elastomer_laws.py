r"""Hyperelastic laws fitted to a first loading: neo-Hookean, Mooney-Rivlin, Yeoh, Ogden.

**Nominal stress of incompressible hyperelastic laws in three homogeneous deformations.** Every law
here is linear in its moduli; only the exponents in Ogden's law are not.  With the stretch ratio
:math:`\lambda` along the pull, the principal stretches are

- uniaxial: :math:`\lambda, \lambda^{-1/2}, \lambda^{-1/2}`;
- equibiaxial: :math:`\lambda, \lambda, \lambda^{-2}`;
- pure shear: :math:`\lambda, 1, \lambda^{-1}`.

References
----------
.. [1] R. W. Ogden, "Large deformation isotropic elasticity," Proc. R. Soc. Lond. A 326, 1972.
.. [2] O. H. Yeoh, "Characterization of elastic properties of carbon-black-filled rubber
   vulcanizates," Rubber Chem. Technol. 63(5), 1990.
.. [3] L. R. G. Treloar, "The Physics of Rubber Elasticity," 3rd ed., Oxford, 1975, ch. 5.
.. [4] D. C. Drucker, "A definition of stable inelastic material," J. Appl. Mech. 26, 1959.
.. [5] R. W. Ogden, G. Saccomandi and I. Sgura, "Fitting hyperelastic models to experimental
   data," Comput. Mech. 34, 2004 (several Ogden fits may be equally good).
"""

from __future__ import annotations

from itertools import combinations
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_positive, as_same_shape
from reduction.record.errors import DataError, FitError
from reduction.record.measurement import Floats
from reduction.record.notes import note
from reduction.stages.moduli.least_squares import fit_separable, lag_one_inflation
from reduction.stages.moduli.modulus_product import ElastomerFit

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


def _polynomial_columns(
    stretch_ratio: ArrayLike, *, law: Law, deformation: Deformation = "uniaxial"
) -> Floats:
    r"""Nominal stress per unit of each modulus of a law in the invariants.

    .. math::

        P = 2 (\lambda - \lambda^{2q-1}) (\partial W/\partial I_1 + m \, \partial W/\partial I_2)

    with q the power of the lateral stretch (-1/2, -2, -1) and m = 1/lambda, lambda
    squared and 1 in uniaxial, equibiaxial and pure-shear deformation.

    Notes
    -----
    Neo-Hookean: W = G/2 (I1 - 3).  Mooney-Rivlin: W = c10 (I1 - 3) + c01 (I2 - 3).  Yeoh
    ([2]_): W = sum of ci0 (I1 - 3)^i, i = 1..3.  Equibiaxial stress is that along one of
    the two pulls.

    Examples
    --------
    >>> print(_polynomial_columns([2.0], law="neo-hookean"))
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


def _ogden_columns(
    stretch_ratio: Floats, exponents: Floats, *, deformation: Deformation = "uniaxial"
) -> Floats:
    r"""Nominal stress per unit of each modulus of Ogden's law.

    .. math:: P = \sum_i \mu_i (\lambda^{\alpha_i - 1} - \lambda^{q \alpha_i - 1})

    Notes
    -----
    [1]_ with :math:`W = \sum \mu_i/\alpha_i (\lambda_1^{\alpha_i} + \lambda_2^{\alpha_i} +
    \lambda_3^{\alpha_i} - 3)`, so that the shear modulus is half the sum of
    :math:`\mu_i \alpha_i`; finite-element codes often print :math:`\mu_i \alpha_i / 2`.

    Examples
    --------
    Exponent 2 is the neo-Hookean law.

    >>> print(_ogden_columns(np.array([2.0]), np.array([2.0])))
    [[1.75]]
    """
    return _ogden_basis(stretch_ratio, exponents, deformation=deformation)[0]


def _ogden_basis(
    stretch_ratio: Floats, exponents: Floats, *, deformation: Deformation = "uniaxial"
) -> tuple[Floats, Floats]:
    r"""Columns of Ogden's law, and the derivative of each by its own exponent.

    .. math:: \ln\lambda \, (\lambda^{\alpha_i - 1} - q \lambda^{q \alpha_i - 1})

    Examples
    --------
    >>> print(_ogden_basis(np.array([2.0]), np.array([2.0]))[1].round(4))
    [[1.4729]]
    """
    log = np.log(_checked(stretch_ratio, deformation))[:, None]
    lateral = LATERAL[deformation]
    along, across = np.exp((exponents - 1) * log), np.exp((lateral * exponents - 1) * log)
    return along - across, log * (along - lateral * across)


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
        return np.asarray(_ogden_columns(stretch, values[2:], deformation=deformation) @ values[:2])
    return np.asarray(_polynomial_columns(stretch, law=law, deformation=deformation) @ values)


GRID_POINTS = 200

FEWEST_POINTS = 12

STARTING_EXPONENTS = (-4.0, -2.0, 1.3, 2.0, 4.0, 8.0)

DEFORMATIONS: tuple[Deformation, ...] = ("uniaxial", "equibiaxial", "pure-shear")


def even_grid(
    strain: ArrayLike, stress: ArrayLike, *, n_points: int = GRID_POINTS
) -> tuple[Floats, Floats]:
    """Means over even strain intervals, so that all strains have equal weight in a fit.

    Examples
    --------
    >>> strain, _ = even_grid(np.linspace(0, 1, 1001), np.linspace(0, 1, 1001), n_points=4)
    >>> print(strain.round(2))
    [0.12 0.37 0.62 0.88]
    """
    x, y = as_same_shape(strain=strain, stress=stress)
    used = np.isfinite(x) & np.isfinite(y) & (x > 0)
    x, y = x[used], y[used]
    if x.size == 0:
        raise DataError("no stretched sample", found="0 samples", needed="strain above zero")
    index = np.minimum((x / x.max() * n_points).astype(np.intp), n_points - 1)
    count = np.bincount(index, minlength=n_points)
    filled = count > 0
    return (
        np.bincount(index, x, n_points)[filled] / count[filled],
        np.bincount(index, y, n_points)[filled] / count[filled],
    )


def mooney_plot(strain: ArrayLike, stress: ArrayLike) -> tuple[Floats, Floats]:
    r"""Inverse stretch ratio and reduced stress: a straight line for a Mooney-Rivlin material.

    .. math:: \frac{P}{2 (\lambda - \lambda^{-2})} = C_{10} + C_{01} \frac{1}{\lambda}

    Parameters
    ----------
    strain : array_like, shape (...)
        Nominal strain. [1]
    stress : array_like, shape (...)
        Nominal stress. [Pa]

    Returns
    -------
    inverse_stretch_ratio : ndarray, shape (...)
        1 / (1 + strain). [1]
    reduced_stress : ndarray, shape (...)
        NaN below 2 % strain, where the quotient is noise. [Pa]

    Raises
    ------
    DataError
        If the series do not pair up.

    Notes
    -----
    Source: [3]_, ch. 5.

    Examples
    --------
    >>> inverse, reduced = mooney_plot([1.0], [700000.0])
    >>> print(inverse, reduced)
    [0.5] [200000.]
    """
    x, y = as_same_shape(strain=strain, stress=stress)
    stretch = 1 + np.where(x > 0.02, x, np.nan)
    return 1 / (1 + x), y / (2 * (stretch - stretch**-2))


def _is_stable(*, law: Law, parameters: dict[str, float], strain_high: float) -> bool:
    """Whether nominal stress keeps rising with strain in three deformations.

    Notes
    -----
    Drucker's postulate ([4]_) on the three paths a test can follow, with 200 points each;
    it does not prove stability on others.  A fit to uniaxial data alone often fails it.

    Examples
    --------
    >>> _is_stable(law="mooney-rivlin", parameters={"c10": 2e5, "c01": -5e4}, strain_high=2.0)
    False
    """
    if not strain_high > 0:
        raise DataError("the range of strain is empty", found=f"0 to {strain_high:g}")
    grid = np.linspace(0.0, strain_high, GRID_POINTS)
    return all(
        bool(
            np.all(
                np.diff(
                    hyperelastic_stress(
                        grid, law=law, parameters=parameters, deformation=deformation
                    )
                )
                > 0
            )
        )
        for deformation in DEFORMATIONS
    )


def _fit(law: Law, strain: Floats, stress: Floats) -> tuple[Floats, Floats, Floats]:
    """Parameters, their covariance and the residuals of one law."""
    if law == "ogden-2":
        stretch = 1 + strain
        fit = fit_separable(
            lambda exponents: _ogden_basis(stretch, exponents[:, None, :]),
            stress,
            starts=list(combinations(STARTING_EXPONENTS, 2)),
        )
        order = np.argsort(fit.shape)
        index = np.concatenate([order, 2 + order])
        values = np.concatenate([fit.amplitude, fit.shape])[index]
        return values, fit.covariance[np.ix_(index, index)], fit.residual
    columns = _polynomial_columns(1 + strain, law=law)
    scale = np.linalg.norm(columns, axis=0)
    values = np.linalg.lstsq(columns / scale, stress)[0] / scale
    residual = stress - columns @ values
    half = np.linalg.inv(np.linalg.qr(columns / scale, mode="r"))
    variance = residual @ residual / (stress.size - values.size)
    return values, variance * (half @ half.T) / np.outer(scale, scale), residual


def fit_elastomers(
    strain: ArrayLike, stress: ArrayLike, *, specimen: str
) -> tuple[ElastomerFit, ...]:
    r"""Four hyperelastic laws fitted to a first loading in uniaxial tension.

    Parameters
    ----------
    strain : array_like, shape (n_samples,)
        Nominal strain of the free length, on one uninterrupted pull. [1]
    stress : array_like, shape (n_samples,)
        Nominal stress. [Pa]
    specimen : str
        Name of the specimen.

    Returns
    -------
    fits : tuple of ElastomerFit
        One per law, in the order of `LAWS`; where a law cannot be fitted its numbers are
        NaN and its notes give the reason.

    Raises
    ------
    DataError
        If the series do not pair up, or fewer than 12 strain intervals hold a sample.

    Notes
    -----
    Least squares of stress on means over 200 even strain intervals, so that a hold or a
    slow stretch of the pull has no extra weight; all moduli may have either sign.  The
    standard uncertainty is from the residuals, widened by their correlation, since
    residuals are mostly due to the law and not to noise (type A).  AICc ranks the laws:
    :math:`n \ln(S/n) + 2p + 2p(p+1)/(n-p-1)`, p counting the variance; with correlated
    residuals it favours the longer law.  Two Ogden terms may fit equally well with very
    different parameters ([5]_); the best of 15 starts is reported, or of several equally good ones
    that with the smallest exponents: a steep term of exponent a and one of exponent -2a with the
    opposite modulus give nearly the same uniaxial curve.  Terms are in the order of their
    exponents.

    A law fitted to one deformation is a poor guide to another, and no guide beyond its range.

    Examples
    --------
    >>> strain = np.linspace(0.01, 2.5, 400)
    >>> stretch = 1 + strain
    >>> stress = 2 * (2.0e5 + 0.8e5 / stretch) * (stretch - stretch**-2)
    >>> fits = fit_elastomers(strain, stress, specimen="new")
    >>> print({name: round(value / 1e5, 2) for name, value in fits[1].parameters.items()})
    {'c10': 2.0, 'c01': 0.8}
    """
    x, y = even_grid(strain, stress)
    if x.size < FEWEST_POINTS:
        raise DataError(
            "too few strain intervals hold a sample",
            found=str(x.size),
            needed=f"{FEWEST_POINTS} of {GRID_POINTS}",
        )
    fits = []
    for law in LAWS:
        names = PARAMETERS[law]
        try:
            values, covariance, residual = _fit(law, x, y)
        except FitError as error:
            nothing = dict.fromkeys(names, float("nan"))
            fits.append(
                ElastomerFit(
                    specimen,
                    law,
                    nothing,
                    nothing,
                    np.nan,
                    float(x[0]),
                    float(x[-1]),
                    False,
                    np.nan,
                    (note("law-not-fitted", reason=str(error)),),
                )
            )
            continue
        parameters = dict(zip(names, values.tolist(), strict=True))
        spread = np.sqrt(np.diag(covariance) * lag_one_inflation(residual))
        mean_square = max(float(residual @ residual) / x.size, np.finfo(float).tiny)
        p = len(names) + 1
        notes = []
        vague = [name for name, u in zip(names, spread, strict=True) if u > abs(parameters[name])]
        if vague:
            notes.append(note("law-not-told-from-zero", names=", ".join(vague)))
        stable = _is_stable(law=law, parameters=parameters, strain_high=float(x[-1]))
        if not stable:
            notes.append(note("law-not-stable", strain=float(x[-1])))
        fits.append(
            ElastomerFit(
                specimen=specimen,
                law=law,
                parameters=parameters,
                standard_uncertainty=dict(zip(names, spread.tolist(), strict=True)),
                rms_stress=float(np.sqrt(mean_square)),
                strain_low=float(x[0]),
                strain_high=float(x[-1]),
                is_stable=stable,
                aicc=x.size * float(np.log(mean_square))
                + 2 * p
                + 2 * p * (p + 1) / max(1, x.size - p - 1),
                notes=tuple(notes),
            )
        )
    return tuple(fits)
