r"""What the fit of a slow pull leaves open of K_0, with how it goes together along the curve.

.. math:: S(T) = (b_1 + 2 b_2 u + 3 b_3 u^2) / h, \qquad
          \delta K_0 = -K_0^2 \, \sum_j \frac{\partial S}{\partial b_j} \delta b_j

with u = (T - centre)/h.  The coefficients of a cubic go together: K_0 too high at one end of the
pull may be too low at the other, and runs at two mean tensions share that.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2, F.1.2.3.
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4.2 and App. D.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.line.product import SlowPull
from reduction.line.quasistatic import quasi_static_spring_constant
from reduction.uncertainty.product import Component, Contributions

_NEGLIGIBLE = 1e-12  # of the greatest variance


def fit_contributions(pull: SlowPull, tension: ArrayLike, *, of: str) -> Contributions:
    """Contributions of the fit to the quasi-static spring constant at given tensions.

    Parameters
    ----------
    pull : SlowPull
        With the covariance of its coefficients.
    tension : array_like, shape (...)
        [N]
    of : str
        Name of the pull: runs that stand on it share its errors.

    Returns
    -------
    contributions : Contributions
        ``quasi_static_spring_constant``; NaN outside the range of use. [N]

    Raises
    ------
    ValueError
        If the tension is not numeric.

    Notes
    -----
    First order ([1]_, of the slope of [2]_).  The covariance is taken apart into independent
    errors.  What the cubic misses of the curve is one error more, of one sign along the curve: a
    size is known of it, no course.

    Examples
    --------
    The squares add up to the uncertainty of the fit:

    >>> from reduction.line.pull import fit_pull
    >>> load = np.linspace(0, 2000.0, 400)
    >>> stretch = 1.389e-4 * load - 3.906e-8 * load**2 + 3.795e-12 * load**3
    >>> noise = 1e-4 * np.random.default_rng(1).standard_normal(400)
    >>> pull = fit_pull(np.arange(400.0), stretch + noise, load)
    >>> found = fit_contributions(pull, [500.0, 1500.0], of="R, Q01")
    >>> _, spread = quasi_static_spring_constant(pull, [500.0, 1500.0])
    >>> rows = found.values["quasi_static_spring_constant"]
    >>> print(np.allclose(np.linalg.norm(rows, axis=0), spread))
    True
    """
    load = np.asarray(tension, dtype=np.float64)
    constant, _ = quasi_static_spring_constant(pull, load)
    scaled = (load - pull.tension_centre) / pull.tension_half_range
    slope = np.stack([np.zeros(load.shape), np.ones(load.shape), 2 * scaled, 3 * scaled**2])
    variance, direction = np.linalg.eigh(pull.covariance)
    kept = variance > _NEGLIGIBLE * variance.max()
    root = (direction * np.sqrt(np.maximum(variance, 0)))[:, kept]
    of_slope = [*np.tensordot(root.T, slope, axes=1)]
    if pull.slope_misfit:
        of_slope.append(np.full(load.shape, pull.slope_misfit))
    rows = -(constant**2) * np.reshape(of_slope, (-1, *load.shape)) / pull.tension_half_range
    component = tuple(Component("quasi_static_fit", of, number) for number in range(len(rows)))
    return Contributions(component, {"quasi_static_spring_constant": rows})
