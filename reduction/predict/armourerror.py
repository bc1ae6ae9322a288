r"""How far the theories of armour are from the rod that they simplify, and where they hold.

References
----------
.. [1] H. Wang, Z. Yang, J. Yan, G. Wang, D. Shi, B. Zhou and Y. Li, "Prediction Method and
   Validation Study of Tensile Performance of Reinforced Armor Layer in Marine Flexible
   Pipe/Cables," J. Mar. Sci. Eng., vol. 10, 642, 2022, sec. 5.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_increasing
from reduction.errors import SettingsError
from reduction.predict.armour import predict_armour
from reduction.predict.armourdesign import ArmourDesign, ArmourResponse, ArmourTheory
from reduction.record import Bools, Floats, read_only_arrays

ARMOUR_QUANTITIES = ("axial_force", "shear_force", "bending_moment", "torsion_moment")
"""The stresses go with the axial force and the moments, and have their errors."""

Reference = Literal["exact", "conjugate"]

_SIMPLER: tuple[ArmourTheory, ...] = ("small", "intermediate", "large")


@dataclass(frozen=True)
@read_only_arrays
class TheoryErrors:
    """Error of each theory.

    Parameters
    ----------
    theory : tuple of str, length n_theories
        Those that are judged.
    quantity : tuple of str, length n_quantities
        `ARMOUR_QUANTITIES`.
    reference : {"exact", "conjugate"}
        What they are held against.
    error : ndarray, shape (n_theories, n_quantities, ..., n_strain)
        Theory minus reference, relative to the reference; of the torsion moment, relative to
        that of the whole change of curvature and torsion.  NaN without strain. [1]
    """

    theory: tuple[ArmourTheory, ...]
    quantity: tuple[str, ...]
    reference: Reference
    error: Floats


def theory_errors(
    design: ArmourDesign, strain: ArrayLike, *, reference: Reference = "exact"
) -> TheoryErrors:
    r"""Error of the theories of small, intermediate and large angles, quantity by quantity.

    Parameters
    ----------
    design : ArmourDesign
        Shape (...).
    strain : array_like, shape (n_strain,)
        Of the cable. [1]
    reference : {"exact", "conjugate"}
        The rod with the moments of the report, which the theories simplify; or the rod with an
        energy, which shows what those moments leave out.

    Returns
    -------
    errors : TheoryErrors
        Array of shape (n_theories, n_quantities, ..., n_strain).

    Raises
    ------
    SettingsError
        If the reference is neither, or by the strain.

    Notes
    -----
    The torsion moment of ``exact`` passes zero near 45 deg, where [1]_, sec. 5.3, finds an error
    of 100 % of a moment that is nothing.  Its error is therefore relative to
    :math:`GJ\sqrt{\Delta\kappa'^2 + \Delta\tau^2}`; of the others, to their own value, which has
    no zero.

    Examples
    --------
    [1]_, sec. 5.2: the axial force of small and intermediate angles, and of a spring

    >>> design = ArmourDesign(np.radians(20.0), 2.5e-3, 25e-3, 210e9)
    >>> for percent in 100 * theory_errors(design, 1e-3).error[:, 0, 0]:
    ...     print(f"{percent:.3f}")
    -0.006
    -0.006
    -99.535
    """
    if reference not in ("exact", "conjugate"):
        raise SettingsError(
            "no theory is held against this", found=repr(reference), needed="exact or conjugate"
        )
    true = predict_armour(design, strain, theory=reference)
    scale = np.abs(_table(true))
    stiffness = np.asarray(design.torsion_stiffness)[..., None]
    scale[-1] = stiffness * np.hypot(true.curvature_change, true.torsion_change)
    each = [_table(predict_armour(design, strain, theory=theory)) for theory in _SIMPLER]
    miss = np.stack(each) - _table(true)
    error = np.divide(miss, scale, out=np.full_like(miss, np.nan), where=scale > 0)
    return TheoryErrors(_SIMPLER, ARMOUR_QUANTITIES, reference, error)


def _table(response: ArmourResponse) -> Floats:
    return np.stack([getattr(response, name) for name in ARMOUR_QUANTITIES])


@dataclass(frozen=True)
@read_only_arrays
class AnglesOfUse:
    """Where each theory holds.

    Parameters
    ----------
    theory, quantity : tuple of str
        As `TheoryErrors`.
    winding_angle : ndarray, shape (n_angles,)
        That were tried. [rad]
    is_within : ndarray of bool, shape (n_theories, n_quantities, n_angles)
        The error is at most the tolerance.
    least_angle, greatest_angle : ndarray, shape (n_theories, n_quantities)
        Ends of the longest run of angles at which it is; NaN where it is nowhere. [rad]
    statement : tuple of str
        One sentence for each theory and quantity.
    """

    theory: tuple[ArmourTheory, ...]
    quantity: tuple[str, ...]
    winding_angle: Floats
    is_within: Bools
    least_angle: Floats
    greatest_angle: Floats
    statement: tuple[str, ...]


def angles_of_use(
    design: ArmourDesign, strain: float, *, tolerance: float, reference: Reference = "exact"
) -> AnglesOfUse:
    """Winding angles at which each theory is within a tolerance, and the statement of it.

    Parameters
    ----------
    design : ArmourDesign
        Of a rising series of winding angles, shape (n_angles,).
    strain : float
        Of the cable, the greatest in use. [1]
    tolerance : float
        Of the error of `theory_errors`. [1]
    reference : {"exact", "conjugate"}
        As `theory_errors`.

    Returns
    -------
    angles : AnglesOfUse
        Among those of the design; no angle between two of them is looked at.

    Raises
    ------
    SettingsError
        If the tolerance is not above zero, or the design is not a series.
    DataError
        If the winding angles do not rise.

    Notes
    -----
    [1]_, sec. 3.2, gives 0-20 and 70-90 deg to the theories of small and large angles without a
    tolerance.

    Examples
    --------
    >>> design = ArmourDesign(np.radians(np.arange(5.0, 86.0)), 2.5e-3, 25e-3, 210e9)
    >>> use = angles_of_use(design, 1e-3, tolerance=0.02)
    >>> print(use.statement[2])
    small angles: bending_moment within 2 % of exact at 5-85 deg
    """
    if not tolerance > 0:
        raise SettingsError("tolerance is not above zero", found=f"{tolerance:g}", needed="above 0")
    angle = as_increasing("winding_angle", design.winding_angle)
    if design.shape != angle.shape:
        raise SettingsError(
            "the design is not a series of winding angles",
            found=f"shape {design.shape} for {angle.size} angles",
            needed="the other numbers alike for all angles, or one for each",
        )
    errors = theory_errors(design, strain, reference=reference)
    is_within = np.abs(errors.error[..., 0]) <= tolerance
    ends = np.full((*is_within.shape[:2], 2), np.nan)
    sentences = []
    for i, theory in enumerate(errors.theory):
        for j, quantity in enumerate(errors.quantity):
            runs = _runs(is_within[i, j])
            if runs.size:
                ends[i, j] = angle[runs[np.argmax(runs[:, 1] - runs[:, 0])]]
            places = ", ".join(_degrees(angle[run]) for run in runs)
            sentences.append(
                f"{theory} angles: {quantity} within {100 * tolerance:g} % of {reference} "
                + (f"at {places} deg" if places else "nowhere")
            )
    return AnglesOfUse(
        theory=errors.theory,
        quantity=errors.quantity,
        winding_angle=angle,
        is_within=is_within,
        least_angle=ends[..., 0],
        greatest_angle=ends[..., 1],
        statement=tuple(sentences),
    )


def _runs(is_within: Bools) -> Floats:
    """First and last index of each run of true values, shape (n_runs, 2)."""
    edge = np.diff(np.concatenate([[0], is_within.astype(np.int8), [0]]))
    return np.column_stack([np.flatnonzero(edge == 1), np.flatnonzero(edge == -1) - 1])


def _degrees(ends: Floats) -> str:
    first, last = np.degrees(ends)
    return f"{first:.4g}" if first == last else f"{first:.4g}-{last:.4g}"


def thinning_loss(design: ArmourDesign) -> Floats:
    r"""Share of its strain that a wire loses because it thins and sinks towards the core.

    .. math:: \frac{\nu (R_2/r)\sin^2\alpha}{1 + \nu (R_2/r)\sin^2\alpha}

    Parameters
    ----------
    design : ArmourDesign
        Shape (...).

    Returns
    -------
    thinning_loss : ndarray, shape (...)
        By which strain, axial force and tension are too high in every theory on a core. [1]

    Raises
    ------
    SettingsError
        By the design.

    Notes
    -----
    The centre of a wire that rests on the core comes :math:`\nu\zeta R_2` closer to the axis.
    To the first order this shortens the helix by :math:`\nu\zeta (R_2/r)\sin^2\alpha`.  It is
    more than what separates the theories at 0.1 % of strain, and about what [1]_, sec. 5.3,
    finds its theory above its numerical results ("because the Poisson effect was considered").
    The pressing of wire and core into each other comes on top, and is not in it.

    Examples
    --------
    >>> design = ArmourDesign(np.radians([20.0, 30.0, 80.0]), 2.5e-3, 25e-3, 210e9)
    >>> print((100 * thinning_loss(design)).round(2))
    [0.32 0.68 2.58]
    """
    slender = np.asarray(design.wire_radius) / design.helix_radius
    shorter = np.asarray(design.poisson_ratio) * slender * np.sin(design.winding_angle) ** 2
    return np.asarray(shorter / (1 + shorter))
