"""A verdict in words, in the unit of who reads it.

References
----------
.. [1] ASME V&V 20-2009, "Standard for Verification and Validation in Computational Fluid
   Dynamics and Heat Transfer," sec. 1-5 and 6.
"""

from __future__ import annotations

import numpy as np

from reduction.compare.product import Validation

LEAST_PROBABILITY = 0.05
"""Below this the shape of a difference is not one that the stated errors make."""
_SMALLEST = 1e-3  # four thousand draws do not tell smaller ones apart


def probability_words(probability: float) -> str:
    """A probability in per cent, as far as draws can tell.

    Parameters
    ----------
    probability : float
        Of 1. [1]

    Returns
    -------
    words : str
        With its sign of per cent.

    Raises
    ------
    Nothing
        Any number has words.

    Examples
    --------
    >>> print(probability_words(0.0153), "and", probability_words(4e-137))
    1.5 % and below 0.1 %
    """
    return "below 0.1 %" if probability < _SMALLEST else f"{100 * probability:.2g} %"


def verdict_words(validation: Validation, *, unit: str = "N", factor: float = 1.0) -> str:
    """What a comparison says, with forces in the unit of the reader.

    Parameters
    ----------
    validation : Validation
        From `reduction.compare.validation.validate_curve`.
    unit : str
        Of force, as it is to stand in the text.
    factor : float
        Of that unit in a newton. [1]

    Returns
    -------
    words : str
        One sentence.

    Raises
    ------
    Nothing
        A comparison without an uncertainty is called not judged.

    Notes
    -----
    Agreement is one of every strain by itself; where the shape of the difference is one that the
    stated errors make in less than 5 % of all cases [1]_, the sentence says so.

    Examples
    --------
    A difference of 44.5 N for a reader in pounds-force.

    >>> from reduction.compare.measured import measured_curve
    >>> from reduction.compare.shared import constant_errors
    >>> from reduction.compare.validation import validate_curve
    >>> stroke = np.linspace(0, 1, 201)
    >>> pull = measured_curve(
    ...     stroke, 100 * stroke + 50, loading="static",
    ...     shared=constant_errors(tension_offset=10.0),
    ... )
    >>> found = validate_curve(
    ...     100 * pull.strain + 94.5, pull, input_error=np.zeros((0, pull.strain.size))
    ... )
    >>> print(verdict_words(found, unit="lbf", factor=1 / 4.4482216).split(" at")[0])
    differs by +10 lbf
    """
    if not np.isfinite(validation.ratio):
        return "not judged: neither the test nor the prediction has an uncertainty"
    if not validation.agrees:
        difference = validation.ratio_difference
        way = "above" if difference > 0 else "below"
        return (
            f"differs by {factor * difference:+.4g} {unit} at strain "
            f"{validation.ratio_strain:.4g}, {validation.ratio:.1f} times its standard "
            f"uncertainty ({validation.coverage_factor:.1f} expected at most): the prediction is "
            f"{way} the test"
        )
    limit = factor * validation.coverage_factor * validation.standard_uncertainty
    size = (
        f"{np.nanmedian(limit):.3g} {unit} or {100 * validation.share:.2g} % of the tension at "
        "the median"
    )
    words = f"agrees within U, {size}"
    if validation.chi_square_probability < LEAST_PROBABILITY:
        chance = probability_words(validation.chi_square_probability)
        words = f"agrees within U point by point, but its shape does not ({chance}); U is {size}"
    return words if validation.is_informative else f"{words}: so wide that agreement says little"
