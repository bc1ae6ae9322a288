"""Two-sided probability of Student's t in closed form, where that keeps its digits.

References
----------
.. [1] M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions. Washington, DC:
   National Bureau of Standards, 1964, eqs. 26.7.3 and 26.7.4.
"""

from __future__ import annotations

import numpy as np
from scipy.special import betainc

from reduction.record import Floats

_CLOSED = 60
"""Degrees of freedom up to which the closed form of p is the quicker one."""
_KEEPS_DIGITS = 1e-2
"""A p above this is 1 less a sum without loss of digits that count."""


def student_p(t: Floats, nu: float) -> Floats:
    """Two-sided p of one number of degrees of freedom, by the closed form where it keeps digits."""
    exact = np.isfinite(t)
    if nu.is_integer() and nu <= _CLOSED:
        angle = np.arctan2(np.abs(t), np.sqrt(nu))
        cosine, sine = np.cos(angle), np.sin(angle)
        # eqs. 26.7.3 (odd) and 26.7.4 (even)
        odd = int(nu) % 2
        term = cosine if odd else np.ones_like(cosine)
        series = term.copy() if nu > 1 else np.zeros_like(cosine)
        for step in range(1 + odd, int(nu) - 1, 2):
            term = term * cosine**2 * (step / (step + 1))
            series += term
        p_value = 1 - (2 / np.pi * (angle + sine * series) if odd else sine * series)
        exact &= p_value < _KEEPS_DIGITS
    else:
        p_value = np.where(np.isnan(t), np.nan, 0.0)
    p_value[exact] = betainc(nu / 2, 0.5, nu / (nu + t[exact] ** 2))
    return p_value
